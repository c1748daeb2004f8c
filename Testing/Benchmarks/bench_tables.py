# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""What the benchmarks share: figures of a run, tables for people and as CSV, and targets."""

import csv
import math
import os
import subprocess
import sys

TARGET_HEADING = ["target", "what", "figure", "limit", "verdict"]
LARGE_VOLUME = 0.95 * 512 ** 3  # voxels from which targets are those of 512^3; sizes are rounded


class Figures(dict):
    """Numbers and texts by name, of one run; NaN is a number that there is none of."""

    def __missing__(self, name):
        return math.nan

    def text(self, name):
        return self.get(name, "")

    @property
    def failure(self):
        return self.text("Failure")

    def level(self, h, name):
        return self[f"level.{h}.{name}"]

    @property
    def levels(self):
        """Their numbers, finest first."""
        return range(int(self.get("Levels", 0)))


def run_program(program, *arguments):
    """What a process of a benchmark's program tells in its lines "@number NAME VALUE"."""
    process = subprocess.run([program, *map(str, arguments)], stdout=subprocess.PIPE, text=True,
                             check=False)
    figures = Figures()
    for line in process.stdout.splitlines():
        kind, _, rest = line.partition(" ")
        name, _, value = rest.partition(" ")
        if kind in ("@number", "@text"):
            figures[name] = float(value) if kind == "@number" else value
    if process.returncode and not figures.failure:  # else it has told why itself
        figures["Failure"] = (f"killed by signal {-process.returncode}" if process.returncode < 0
                              else f"exit code {process.returncode}")
    return figures


def say(*words):
    """To people, while they wait."""
    print(*words, file=sys.stderr, flush=True)


def has_failed(what, figures):
    if figures.failure:
        say(f"{what} failed: {figures.failure}")
    return bool(figures.failure)


def short_text(value, digits=3):
    """For people: so many significant digits, no exponent up to 1e15, `-` for NaN."""
    if math.isnan(value):
        return "-"
    if math.isinf(value) or value == 0:
        return f"{value:.0f}"
    magnitude = math.floor(math.log10(abs(value))) + 1
    if value == round(value) and abs(value) < 1e15:
        return f"{value:.0f}"  # a number of things: all of it
    if magnitude < -3:
        return f"{value:.{digits}g}"
    return f"{value:.{max(0, digits - magnitude)}f}"


def exact_text(value):
    """For CSV: as many digits as tell two values apart, empty for NaN; texts as they are."""
    return value if isinstance(value, str) else "" if math.isnan(value) else f"{value:.10g}"


def print_table(rows, left=1):
    """The first row underlined; the first columns to the left, all others to the right."""
    widths = [max(map(len, column)) for column in zip(*rows)]
    for r, row in enumerate(rows):
        line = "  ".join(text.ljust(width) if c < left else text.rjust(width)
                         for c, (text, width) in enumerate(zip(row, widths)))
        print(line)
        if r == 0:
            print("-" * len(line))
    sys.stdout.flush()


def write_csv(path, rows):
    with open(path, "w", newline="", encoding="utf-8") as file:
        csv.writer(file, lineterminator="\n").writerows(rows)


def write_tables(path, rows, **others):
    """FILE.csv, and FILE-what.csv of the others; none without a path."""
    if path:
        write_csv(path, rows)
        stem, ending = os.path.splitext(path)
        for what, table in others.items():
            write_csv(f"{stem}-{what}{ending or '.csv'}", table)


def target_row(name, what, figure, relation, limit):
    """`relation`: <= or >=. What became of it: reached, missed or, for NaN, not run."""
    is_reached = figure <= limit if relation == "<=" else figure >= limit
    return [name, what, short_text(figure), f"{relation} {short_text(limit)}",
            "not run" if math.isnan(figure) else "reached" if is_reached else "missed"]


def ratio(a, b):
    return a / b if b else math.nan
