# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""How the cost of us-1 grows with the volume, what threads gain, by the clock and by a model, and
what memory a volume takes. Each prints its tables, writes its CSV and returns whether all went well.
"""

import collections
import math
import os
import statistics
import tempfile

from bench_tables import (
    LARGE_VOLUME, TARGET_HEADING, exact_text, has_failed, print_table, ratio, say, short_text,
    target_row, write_tables)
from surface_tables import BETWEEN_ITERATIONS, add_derived_figures, phases_of


def name_of_size(size):
    return f"{size}^3" if size else "as it is"


def finish(options, table, rows, targets):
    print()
    print_table(table)
    print("\nTargets:\n")
    print_table([TARGET_HEADING] + targets, 2)
    write_tables(options.csv, rows, targets=[TARGET_HEADING] + targets)


# ---- Growth --------------------------------------------------------------------------------------

GROWTH_COLUMNS = [
    "Size", "Voxels", "WallSeconds", "ProcessorSeconds", "PyramidSeconds", "BaseMegabytes",
    "PeakMegabytes", "GrownMegabytes", "Vertices", "Iterations", "VertexIterations",
    "MicrosecondsPerVertexIteration", "FinestIterations", "FinestSeconds", "FinestVertices"]
SEARCHES = "ContactAndProximity"


def per_iteration(phase):
    return phase + "PerFinestIteration"


def add_growth_figures(figures):
    """What the tables tell beyond the figures of the run."""
    iterations = figures.level(0, "Iterations")
    figures["GrownMegabytes"] = figures["PeakMegabytes"] - figures["BaseMegabytes"]
    figures["FinestIterations"] = iterations
    figures["FinestSeconds"] = figures.level(0, "Seconds")
    figures["FinestVertices"] = ratio(figures.level(0, "VertexIterations"), iterations)
    figures[per_iteration("Finest")] = ratio(figures["FinestSeconds"], iterations)
    for phase in phases_of(figures):
        figures[phase] = sum(figures.level(h, phase) for h in figures.levels)
        figures[per_iteration(phase)] = ratio(figures.level(0, phase), iterations)
    # Both search for vertices that are near: one figure for what the paper calls O(n log n).
    figures[per_iteration(SEARCHES)] = (figures[per_iteration("ContactSeconds")]
                                        + figures[per_iteration("ProximitySeconds")])


def fit_power_law(x, y):
    """Exponent, R^2 of the logarithms and number of the pairs that are positive and finite."""
    pairs = [(math.log(a), math.log(b)) for a, b in zip(x, y) if 0 < a < math.inf and 0 < b < math.inf]
    u, v = ([pair[i] for pair in pairs] for i in (0, 1))
    if len(pairs) < 2 or len(set(u)) < 2:
        return math.nan, math.nan, len(pairs)
    mean_u, mean_v = statistics.fmean(u), statistics.fmean(v)
    uu = sum((a - mean_u) ** 2 for a in u)
    vv = sum((b - mean_v) ** 2 for b in v)
    uv = sum((a - mean_u) * (b - mean_v) for a, b in pairs)
    return uv / uu, ratio(uv * uv, uu * vv), len(pairs)


def exponent_rows(runs, phases):
    pairs = [(figure, against) for against in ("Voxels", "Vertices")
             for figure in ("WallSeconds", "ProcessorSeconds", "PyramidSeconds", "PeakMegabytes",
                            "GrownMegabytes")]
    pairs += [("Vertices", "Voxels"), (per_iteration("Finest"), "FinestVertices")]
    # What happens between iterations has no share of one.
    pairs += [(phase, "Vertices") if phase == BETWEEN_ITERATIONS
              else (per_iteration(phase), "FinestVertices") for phase in phases]
    pairs += [(per_iteration(SEARCHES), "FinestVertices")] if phases else []
    rows = [["Figure", "Against", "Exponent", "R2", "Sizes"]]
    for figure, against in pairs:
        exponent, determination, count = fit_power_law(
            [run[against] for run in runs], [run[figure] for run in runs])
        rows.append([figure, against, short_text(exponent), short_text(determination), str(count)])
    return rows


def measure_growth(options, run_ours):
    runs = []
    for size in options.sizes:
        say(f"{size}^3")
        figures = run_ours("us-1", size, "--profile")
        if not has_failed(f"{size}^3", figures):
            figures["Size"] = size
            add_growth_figures(figures)
            runs.append(figures)
    if not runs:
        return False
    add_derived_figures([("us-1", figures) for figures in runs])
    phases = phases_of(runs[0])
    names = GROWTH_COLUMNS + phases
    print("\nHow cost grows: us-1; Finest is what concerns level 0 alone, FinestVertices the mean over "
          "its iterations; GrownMegabytes is the peak less what was there before.\n")
    print_table([[name] + [short_text(run[name], 4) for run in runs] for name in names])
    exponents = exponent_rows(runs, phases)
    print("\nFitted exponents, least squares of the logarithms:\n")
    print_table(exponents, 2)
    names = names + [per_iteration(phase) for phase in phases if phase != BETWEEN_ITERATIONS]
    names += [per_iteration(SEARCHES), per_iteration("Finest")]
    write_tables(options.csv, [names] + [[exact_text(run[name]) for name in names] for run in runs],
                 exponents=exponents)
    return len(runs) == len(options.sizes)


# ---- Threads -------------------------------------------------------------------------------------

def run_rounds(options, run_ours, size, rows):
    """The figures of each number of threads, round by round; None if a run failed."""
    rounds = collections.defaultdict(list)
    for number in range(options.repetitions):
        # To and fro, so that a machine that gets slower favours none.
        for threads in options.threads if number % 2 == 0 else reversed(options.threads):
            say(f"us-{threads}, {name_of_size(size)}, round {number + 1}")
            figures = run_ours(f"us-{threads}", size)
            if has_failed(f"us-{threads}", figures):
                return None
            rounds[threads].append(figures)
            rows.append([str(size), str(threads), str(number + 1), *(
                exact_text(figures[name])
                for name in ("WallSeconds", "ProcessorSeconds", "Fingerprint"))])
    return rounds


def measure_threads(options, run_ours):
    """The gain is the median over the rounds of the first one's seconds over the other's."""
    first = options.threads[0]
    rows = [["Size", "Threads", "Round", "WallSeconds", "ProcessorSeconds", "Fingerprint"]]
    table = [["volume", "threads", "rounds", "median seconds", "least", "most", "gain"]]
    targets = []
    are_well = True
    for size in options.sizes:
        rounds = run_rounds(options, run_ours, size, rows)
        if not rounds:
            are_well = False
            continue
        for threads in sorted(rounds):
            seconds = [figures["WallSeconds"] for figures in rounds[threads]]
            gain = statistics.median_low(
                a["WallSeconds"] / b["WallSeconds"] for a, b in zip(rounds[first], rounds[threads]))
            table.append([name_of_size(size), str(threads), str(len(seconds)), *map(short_text, (
                statistics.median_low(seconds), min(seconds), max(seconds), gain))])
            if (first, threads) == (1, 2):
                is_large = rounds[first][0]["Voxels"] > LARGE_VOLUME
                targets.append(target_row(
                    "S6", f"{name_of_size(size)}, seconds of 1 thread / of 2", gain, ">=",
                    1.85 if is_large else 1.75))
        surfaces = {figures["Fingerprint"] for each in rounds.values() for figures in each}
        targets.append(target_row("Q5", f"{name_of_size(size)}, surfaces that differ",
                                  float(len(surfaces) > 1), "<=", 0))
    print("\nSeconds of the clock, pyramid included; gain: median over the rounds of the seconds with "
          f"{first} over those in the same round.")
    finish(options, table, rows, targets)
    return are_well


# ---- The model of more threads than there are ----------------------------------------------------

MODELLED_THREADS = (2, 4, 8, 16, 32, 64)
TARGET_THREADS = 16
PARTS = ("Serial", "Small", "Parallel", "Calls", "Chunks")
ASSUMPTIONS = """\
us-1 ran on one thread. Each For() was cut into the chunks that StandardThreads makes for 64
threads, 8 per thread, none smaller than its grain; each chunk's time is that of the processor, less
what reading the clock takes. For fewer threads neighbouring chunks are put together. Threads take
chunks in order, each when it is free. Added: {0:g} us per For(), {1:g} us per chunk. All between the
calls, and a For() of no more than its grain ("small"), is serial and added as it is. Left out: that
processors share memory and caches, and slow down when all of them work. A phase holds what happens
up to its end since the one before has ended, in iterations and regularisations of all levels.
Seconds by phase on 1, 2 ... 64 threads; what is longest on {2} of them is first."""


def phases_of_model(figures):
    """By name: its PARTS, and Seconds1 to Seconds64; the longest first, "all" last."""
    phases = []
    for i in range(int(figures["ModelPhases"])):
        def get(name, i=i):
            return figures[f"model.{i}.{name}"]
        phase = {name: get(name) for name in PARTS}
        phase["Seconds1"] = phase["Serial"] + phase["Parallel"]
        for threads in MODELLED_THREADS:
            phase[f"Seconds{threads}"] = phase["Serial"] + get(f"Scheduled{threads}")
        phases.append((get("Name"), phase))
    phases.sort(key=lambda each: -each[1][f"Seconds{TARGET_THREADS}"])
    names = phases[0][1] if phases else {}
    return phases + [("all", {name: sum(phase[name] for _, phase in phases) for name in names})]


def measure_model(options, run_ours):
    seconds = [f"Seconds{threads}" for threads in (1, *MODELLED_THREADS)]
    rows = [["Size", "Phase", *PARTS, *seconds, "Fingerprint"]]
    targets = []
    are_well = True
    is_told = False
    for size in options.sizes:
        volume = name_of_size(size)
        say(f"us-1, {volume}")
        figures = run_ours("us-1", size, "--model")
        if has_failed(volume, figures):
            are_well = False
            continue
        if not is_told:
            print("\n" + ASSUMPTIONS.format(1e6 * figures["ModelSecondsOfCall"],
                                            1e6 * figures["ModelSecondsOfChunk"], TARGET_THREADS))
            is_told = True
        phases = phases_of_model(figures)
        whole = phases[-1][1]
        table = [["phase", "serial", "% of all", "small", "parallel", "calls",
                  *(name.removeprefix("Seconds") for name in seconds)]]
        for name, phase in phases:
            share = 100 * ratio(phase["Serial"], whole["Seconds1"])
            table.append([name, *map(short_text, (
                phase["Serial"], share, phase["Small"], phase["Parallel"], phase["Calls"],
                *(phase[column] for column in seconds)))])
            rows.append([str(size), name, *(exact_text(phase[column]) for column in PARTS),
                         *(exact_text(phase[column]) for column in seconds), figures["Fingerprint"]])
        table.append(["speed-up", "", "", "", "", "", *(
            short_text(whole["Seconds1"] / whole[column]) for column in seconds)])
        print(f"\nThe volume {volume}:\n")
        print_table(table)
        is_large = figures["Voxels"] > LARGE_VOLUME
        targets.append(target_row(
            "S6", f"{volume}, modelled speed-up on {TARGET_THREADS} threads",
            whole["Seconds1"] / whole[f"Seconds{TARGET_THREADS}"], ">=", 8 if is_large else 5))
        if is_large:
            targets.append(target_row("S6", f"{volume}, serial share, %",
                                      100 * whole["Serial"] / whole["Seconds1"], "<=", 5))
    print("\nTargets:\n")
    print_table([TARGET_HEADING] + targets, 2)
    write_tables(options.csv, rows, targets=[TARGET_HEADING] + targets)
    return are_well


# ---- Memory --------------------------------------------------------------------------------------

PEAK_LIMITS = {512: 800, 1024: 5000}  # MB, of two bytes a voxel
PEAK_COLUMNS = ["Voxels", "BytesOfVoxel", "BaseMegabytes", "PeakMegabytes", "WallSeconds",
                "ProcessorSeconds", "Vertices"]


def measure_peaks(options, run_ours):
    """The volume is written to a file by another process, so that nothing but the image and the run
    is in the memory that is measured."""
    rows = [["Size", *PEAK_COLUMNS]]
    table = [["volume", "voxels", "MB of them", "MB before", "MB at the peak", "vertices"]]
    targets = []
    are_well = True
    for size in options.sizes:
        volume = name_of_size(size)
        say(f"us-1, {volume}")
        with tempfile.TemporaryDirectory(prefix="volumic-") as folder:
            path = os.path.join(folder, "volume.vti")
            written = figures = run_ours("us-1", size, "--write-volume", path)
            if not written.failure:
                figures = run_ours("us-1", 0, volume=path, iso=written["IsoValue"])
        if has_failed(volume, figures):
            are_well = False
            continue
        figures["BytesOfVoxel"] = written["BytesOfVoxel"]
        megabytes = 1e-6 * figures["BytesOfVoxel"] * figures["Voxels"]
        table.append([volume, short_text(figures["Voxels"]), short_text(megabytes, 4),
                      short_text(figures["BaseMegabytes"], 4),
                      short_text(figures["PeakMegabytes"], 4), short_text(figures["Vertices"])])
        rows.append([str(size)] + [exact_text(figures[name]) for name in PEAK_COLUMNS])
        if size in PEAK_LIMITS and figures["BytesOfVoxel"] == 2:
            targets.append(target_row("M1", f"{volume} of int16, MB at the peak",
                                      figures["PeakMegabytes"], "<=", PEAK_LIMITS[size]))
    print("\nResident memory of the whole process: libraries, image and run.")
    finish(options, table, rows, targets)
    return are_well
