# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Figures of runs and text tables of figures."""

import csv
import math
import os
import subprocess
import sys
import tempfile
import time

TARGET_HEADING = ["target", "what", "figure", "limit", "verdict"]


class Figures(dict):
    """Numbers and texts of one run, by name. A missing figure is NaN."""

    def __missing__(self, name):
        return math.nan

    def take(self, line):
        """Read a line "@NAME VALUE" of the program Benchmark."""
        name, _, value = line[1:].rstrip("\n").partition(" ")
        try:
            self[name] = float(value)
        except ValueError:
            self[name] = value


def words_of(named):
    return [f"{name}={value}" for name, value in named.items() if value is not None]


def benchmark(program, **named):
    """Run the program Benchmark in a process of its own and return its figures."""
    process = subprocess.run([program, *words_of(named)], stdout=subprocess.PIPE, text=True,
                             check=False)
    figures = Figures()
    for line in process.stdout.splitlines():
        if line.startswith("@"):
            figures.take(line)
    if process.returncode:
        figures.setdefault("Failure", f"exit code {process.returncode}")
    return figures


def timed(*command):
    """Run a process; return (seconds, processor seconds, peak MB). Raise RuntimeError if it fails."""
    with tempfile.TemporaryFile() as output:
        begin = time.monotonic()
        process = subprocess.Popen([str(word) for word in command], stdout=output,
                                   stderr=subprocess.STDOUT)
        _, status, usage = os.wait4(process.pid, 0)
        seconds = time.monotonic() - begin
        process.returncode = os.waitstatus_to_exitcode(status)
        if process.returncode not in (0, 3):  # 3: finished with a warning
            output.seek(0)
            raise RuntimeError(f"{os.path.basename(command[0])} failed, {process.returncode}: "
                               + output.read().decode(errors="replace")[-300:])
    return seconds, usage.ru_utime + usage.ru_stime, usage.ru_maxrss * 1024e-6


def say(*words):
    """Print progress to the standard error."""
    print(*words, file=sys.stderr, flush=True)


def ratio(a, b):
    return a / b if b else math.nan


def short_text(value, digits=3):
    """Format a number with `digits` significant digits, without exponent up to 1e15; NaN is `-`.
    Return texts unchanged."""
    if isinstance(value, str):
        return value
    if math.isnan(value):
        return "-"
    if math.isinf(value) or (value == round(value) and abs(value) < 1e15):
        return f"{value:.0f}"  # a count: all digits
    magnitude = math.floor(math.log10(abs(value))) + 1
    return f"{value:.{digits}g}" if magnitude < -3 else f"{value:.{max(0, digits - magnitude)}f}"


def print_table(rows, left=1):
    """Print rows, the first one underlined; align the first `left` columns left, the others right."""
    widths = [max(map(len, column)) for column in zip(*rows)]
    for r, row in enumerate(rows):
        print("  ".join(text.ljust(width) if c < left else text.rjust(width)
                        for c, (text, width) in enumerate(zip(row, widths))))
        if r == 0:
            print("-" * (sum(widths) + 2 * len(widths) - 2))
    print(flush=True)


def print_figures(columns, runs, turned=False):
    """Print a row (`turned`: a column) for each (name, figures). columns: {figure: heading}."""
    rows = [["", *columns.values()]] + [
        [name + (" FAILED" if "Failure" in figures else ""),
         *(short_text(figures[column], 4 if column.endswith("Mean") else 3) for column in columns)]
        for name, figures in runs]
    print_table([list(row) for row in zip(*rows)] if turned else rows)


def target_row(name, what, figure, relation, limit):
    """Return a row whose verdict is reached, missed or, for NaN, not run. relation: <= or >=."""
    is_reached = figure <= limit if relation == "<=" else figure >= limit
    return [name, what, short_text(figure), f"{relation} {short_text(limit)}",
            "not run" if math.isnan(figure) else "reached" if is_reached else "missed"]


def print_targets(rows):
    print("Targets:\n")
    print_table([TARGET_HEADING] + [target_row(*row) for row in rows], 2)


def finish(path, runs):
    """Write all figures as CSV if `path` is given. Return the exit code: 1 if a run failed."""
    for name, figures in runs:
        if "Failure" in figures:
            say(f"{name} failed: {figures['Failure']}")
    if path:
        names = sorted({name for _, figures in runs for name in figures})
        with open(path, "w", newline="", encoding="utf-8") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(["Run", *names])
            writer.writerows([run, *(figures.get(name, "") for name in names)]
                             for run, figures in runs)
    return int(any("Failure" in figures for _, figures in runs))
