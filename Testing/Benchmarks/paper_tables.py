#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Makes the tables of the paper's experiments in Documentation/, as Markdown on standard output:

    /usr/bin/python3 Testing/Benchmarks/paper_tables.py --scan aneurism.mhd 100.5 --scan ...

    levels    iterations per level on the skull, beside those that the paper states
    vessels   without recovery, as in the paper: iterations, and how much is there at each level
    recovery  how much of the object is there in the end, with each value of Recovery
    start     iterations of the first level from outside (0), and from the iso-surface (2)
    rest      when every --scan falls below the mean kinetic energy at which the skull rests
    sampling  what delta / U costs and gives, on the skull

The first and the last table are of the skull alone, the others of the skull and of every --scan.
What is going on is told on standard error.
"""

import argparse
import contextlib
import os
import sys
from time import process_time

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy

from scan_runs import SKULL, SKULL_ISO, Scan, field, iterations
from volumic.errors import Failure

# Lachaud and Montanvert (1996), section 6 and figure 4: the divisions came after 225, 333 and 461
# iterations. How many there were on level 0 is not stated.
PAPERS_ITERATIONS = {3: 225, 2: 333 - 225, 1: 461 - 333}
PAPERS_RESULT = "1, 23"
PAPERS_DIRECT = "more than 400"


def table(head, rows):
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join(f"| {' | '.join(map(str, line))} |" for line in lines)


def levels(scans):
    skull = scans[0]
    ours, start = skull.run_as_paper()
    runs = [(f"as in the paper: from level {start}, `Recovery` 0", ours),
            ("defaults", skull.run())]
    numbers = range(max(level for _, run in runs for level, _, _ in iterations(run)), -1, -1)
    rows = [["the paper's skull", *(PAPERS_ITERATIONS.get(n, "not stated" if n == 0 else "")
                                    for n in numbers), "", PAPERS_RESULT]]
    for name, run in runs:
        counts = {level: count for level, count, _ in iterations(run)}
        rows.append([name, *(counts.get(n, "") for n in numbers), *size_of(run.GetOutput())])
    direct = skull.run(CoarsestLevel=0)
    blank = [""] * (len(numbers) - 1)
    rows += [["the paper's without the pyramid", *blank, PAPERS_DIRECT, "", ""],
             ["without the pyramid", *blank, iterations(direct)[0][1],
              *size_of(direct.GetOutput())]]
    return table(["", *(f"level {n}" for n in numbers), "vertices", "components, genus"], rows)


def size_of(surface):
    return (f"{surface.GetNumberOfPoints():,}",
            f"{field(surface, 'NumberOfComponents')}, {field(surface, 'Genus')}")


def vessels(scans):
    rows, most = [], 0
    for scan in scans:
        run, start = scan.run_as_paper()
        cells = []
        for level, count, _ in iterations(run):
            surface = run.GetLevels().GetBlock(level)
            unit = field_of(surface, "Unit") / field_of(run.GetOutput(), "Unit")
            cells.append(f"{count}, {percent(scan.share_found(surface, unit))}")
        most = max(most, start)
        rows.append((scan, start, cells))
    return table(["scan, iso-value", *(f"level {n}" for n in range(most, -1, -1))],
                 [[scan_name(scan), *[""] * (most - start), *cells]
                  for scan, start, cells in rows])


def recovery(scans):
    rows = []
    for scan in scans:
        shares = [percent(scan.share_found(scan.run(**properties).GetOutput()))
                  for properties in ({"Recovery": 2}, {})]
        run, start = scan.run_as_paper()
        shares.append(f"{percent(scan.share_found(run.GetOutput()))}, from level {start}")
        rows.append([scan_name(scan), *shares])
    return table(["scan, iso-value", "2", "1", "0"], rows)


def start(scans):
    rows = []
    for scan in scans:
        (outside, outside_time), (iso, iso_time) = (
            timed(scan, NumberOfThreads=1, Initialization=n) for n in (0, 2))
        outside, iso = iterations(outside), iterations(iso)
        first = outside[0][0]
        counts = {level: count for level, count, _ in iso}
        share = outside[0][2] / sum(seconds for _, _, seconds in outside)
        rows.append([scan_name(scan), first, outside[0][1], counts.get(first, "none"),
                     sum(c for _, c, _ in outside), sum(counts.values()), percent(share),
                     f"{iso_time / outside_time:.2f}"])
    return table(["scan, iso-value", "first level", "iterations there: 0", "2",
                  "on all levels: 0", "2", "time of the first level: 0",
                  "processor time of all: 2 to 0"], rows)


def rest(scans):
    skull, *others = (scan.run_as_paper()[0] for scan in scans)
    bound = energies(skull)[-10:].mean()
    rows = []
    for scan, run in zip(scans[1:], others):
        energy, vertices = energies(run), column(run, "Vertices")
        below = np.flatnonzero(energy < bound)
        rows.append([scan_name(scan), *((below[0] + 1, len(energy), f"{vertices[below[0]]:,.0f}")
                                        if len(below) else ("never", len(energy), "")),
                     f"{vertices[-1]:,.0f}"])
    return table([f"scan, iso-value; under {bound:.1e} delta^2", "iteration", "of",
                  "vertices then", "in the end"], rows)


def energies(run):
    """The mean kinetic energy of the iterations on the finest level, lengths in its delta."""
    surface = run.GetOutput()
    scale = field_of(surface, "Unit") / field_of(surface, "Delta")
    return column(run, "KineticEnergy") * scale ** 2


def column(run, name):
    """A column of the history, its rows of level 0."""
    levels, values = (vtk_to_numpy(run.GetHistory().GetColumnByName(n)) for n in ("Level", name))
    return values[levels == 0].astype(float)


def sampling(scans):
    runs = {ratio: timed(scans[0], NumberOfThreads=1, SamplingRatio=ratio)
            for ratio in (0.7, 0.85, 1.0)}
    return table(["delta / U", "vertices", "iso-surface within a voxel", "processor time"],
                 [[ratio, f"{run.GetOutput().GetNumberOfPoints():,}",
                   percent(scans[0].share_found(run.GetOutput())), f"{time / runs[0.85][1]:.2f}"]
                  for ratio, (run, time) in runs.items()])


def timed(scan, **properties):
    """A run of its own, and the seconds of the processor that it took."""
    scan.pyramid.Update()
    started = process_time()
    run = scan.run(**properties)
    return run, process_time() - started


def field_of(surface, name):
    return surface.GetFieldData().GetArray(name).GetTuple1(0)


def percent(share):
    return f"{100 * share:.1f} %"


def scan_name(scan):
    return f"{os.path.basename(scan.path).partition('.')[0]}, {scan.iso:g}"


TABLES = (levels, vessels, recovery, start, rest, sampling)


def main():
    names = [make.__name__ for make in TABLES]
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--only", nargs="+", choices=names, default=names, metavar="TABLE",
                        help=", ".join(names))
    parser.add_argument("--scan", nargs=2, metavar=("VOLUME", "ISO"), action="append", default=[],
                        help="may be repeated")
    parser.add_argument("--skull", nargs=2, metavar=("VOLUME", "ISO"), default=(SKULL, SKULL_ISO),
                        help="another volume in the place of the skull")
    arguments = parser.parse_args()
    try:
        scans = [Scan(path, float(iso)) for path, iso in (arguments.skull, *arguments.scan)]
        for make in TABLES:
            if make.__name__ in arguments.only:
                with contextlib.redirect_stdout(sys.stderr):
                    text = make(scans)
                print(f"{text}\n", flush=True)
    except (Failure, ValueError, OSError) as error:
        sys.exit(f"paper_tables.py: {error}")


if __name__ == "__main__":
    main()
