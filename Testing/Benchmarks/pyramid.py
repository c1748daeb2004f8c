# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""vtkImagePyramid, VTK's Gaussian and resize, ITK's Gaussian and resampling: milliseconds with one
thread are those of the processor, with two the time that passed; medians."""

import collections
import statistics
import subprocess

from tables import benchmark, print_table, print_targets, ratio, short_text

WORK = [(levels, threads) for levels in ("one level", "all levels") for threads in ("1", "2")]


def add_options(parser):
    parser.add_argument("volume", help=".vti, of values that fit into 16 bits")
    parser.add_argument("--repetitions", type=int, default=15)


def times_of(options):
    """{(who, levels, threads): seconds}"""
    process = subprocess.run(
        [options.program, "pyramid", f"volume={options.volume}",
         f"repetitions={options.repetitions}"], stdout=subprocess.PIPE, text=True, check=True)
    times = collections.defaultdict(list)
    lines = process.stdout.splitlines()
    for line, seconds in zip(lines, lines[1:]):
        if line.startswith("@time "):
            times[tuple(line[6:].split("\t"))].append(float(seconds))
    return times


def measure(options):
    times = times_of(options)
    medians = {key: statistics.median(seconds) for key, seconds in times.items()}
    table = [["ms", *(f"{levels}, {threads} thread(s)" for levels, threads in WORK)]]
    for who in dict.fromkeys(key[0] for key in times):
        table.append([who, *(short_text(1e3 * medians.get((who, *work), float("nan")))
                             for work in WORK)])
    print_table(table)
    ours = "vtkImagePyramid"
    one = medians[ours, "one level", "1"]
    rows = [("P1", f"one level, one thread, to {peer}",
             ratio(one, medians.get((peer, "one level", "1"), float("nan"))), "<=", wanted)
            for peer, wanted in (("VTK Gaussian, resize", .05), ("ITK Gaussian, resample", .025))]
    both = [[1e3 * second for second in times[ours, "one level", threads]] for threads in "12"]
    # Where others run too, only the quickest can show what a second thread gains.
    rows += [("P1", "one thread to two, quickest", min(both[0]) / min(both[1]), ">=", 1.7),
             ("P2", "all levels to the first", medians[ours, "all levels", "1"] / one, "<=", 1.35)]
    for threads in (1, 2):
        peak = benchmark(options.program, "pyramid", volume=options.volume, peak=threads)
        rows.append(("P3", f"peak memory, {threads} thread(s), to pyramid and planes",
                     ratio(peak["GrownBytes"], peak["Pyramid"] + threads * peak["Plane"]), "<=", 1))
    print_targets(rows)
    return 0
