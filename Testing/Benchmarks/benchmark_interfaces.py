#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Surfaces of labels that touch: those of vtkLabelsToSurfaces that share their interfaces beside
those that do not, vtkSurfaceNets3D (VTK 9.3) and vtkDiscreteFlyingEdges3D with
vtkWindowedSincPolyDataFilter, all judged by the same code, all labels of a map together. `graded` are
shared ones with a Tolerance of a fifth of a voxel.

`s` is processor seconds, of one thread, the median of the repetitions, by turns; `time` is that over
the separate surfaces'. `crossing` are pairs of triangles that meet elsewhere than in corners and edges
that they share, counted by CGAL. `open` are edges where the boundary of a label is not closed,
oriented and manifold, summed over the labels, `folded` those of three triangles or more around which
labels overlap, and `pinched` the vertices where it touches itself.
`lines` are edges of three triangles or more that are told to be no line, and lines that are no such
edge. `vol %` is the largest error of a label's volume against its voxels, of labels of over 1000, and
the median. `q` is the radius ratio of triangles; `angle` the least one, degrees, of triangles that have
no vertex on a junction line, and of all. `rough` is the angle between two segments of a junction line,
95 % of them; `wrong` are voxels whose centres are on the wrong side of a label's surface, summed over
the labels. TetGen (-pY) and gmsh get all triangles at once, where none cross and none are missing:
tetrahedra, or why there are none.

Exit code: 0 all was run (targets may be missed), 1 a run failed, 2 the command line is wrong.
"""

import argparse
import math
import statistics
import sys

from bench_tables import (
    TARGET_HEADING, Figures, exact_text, print_table, ratio, say, short_text, target_row,
    write_tables)
from interface_figures import figures_of
from interface_maps import named_maps
from interface_runs import runs_here
from interface_solvers import solvers_here

COLUMNS = {
    "Seconds": "s", "Time": "time", "Vertices": "vertices", "Intersections": "crossing",
    "WrongEdges": "open", "Folded": "folded", "Pinched": "pinched", "WrongLines": "lines", "LostLabels": "lost",
    "VolumeLargest": "vol %", "VolumeMedian": "50 %", "RatioMean": "q", "Ratio01": "q 1 %",
    "AngleInner": "angle", "AngleLeast": "of all", "Roughness": "rough", "WrongVoxels": "wrong",
    "tetgen": "TetGen", "gmsh": "gmsh"}
CSV_COLUMNS = (*COLUMNS, "Triangles", "Lines", "Flat", "WrongJunctions", "WrongBlocks",
               "RatioLeast", "Failure")
# For those who asked for the maps of the issue, all of them.
USUAL_MAPS = ("polycrystal", "tooth", "organs", "aal", "JHU")


def parse_options(maps):
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    add = parser.add_argument
    add("--judge", required=True, help="JudgeFiles")
    add("--make-volume", required=True, help="MakeVolume")
    add("--maps", default=",".join(USUAL_MAPS), metavar="LIST",
        help="of " + ", ".join(maps(None)))
    add("--runs", metavar="LIST", help="of " + ", ".join(runs_here()) + "; default: all")
    add("--no-solvers", action="store_true", help="leave TetGen and gmsh out")
    add("--repetitions", type=int, default=1, metavar="N", help="of each run (1)")
    add("--csv", metavar="FILE.csv", help="all figures; also FILE-targets.csv")
    options = parser.parse_args()
    options.maps = options.maps.split(",")
    options.runs = options.runs.split(",") if options.runs else list(runs_here())
    for what, asked, known in (("map", options.maps, maps(None)), ("run", options.runs, runs_here())):
        for name in asked:
            if name not in known:
                parser.error(f"no {what} \"{name}\"; there are {', '.join(known)}")
    return options


def figure_text(value):
    return value if isinstance(value, str) else short_text(value)


# ---- Runs ----------------------------------------------------------------------------------------

def timed_runs(options, voxels):
    """{name: (seconds, Complex)}, by turns; of one that fails what it says."""
    made, failed = {}, {}
    for _ in range(options.repetitions):
        for name in options.runs:
            if name in failed:
                continue
            try:
                seconds, shape = runs_here()[name](voxels)
                made[name] = (made.get(name, ([], ))[0] + [seconds], shape)
            except RuntimeError as error:
                failed[name] = str(error)
                made.pop(name, None)
    return {name: (statistics.median(seconds), shape)
            for name, (seconds, shape) in made.items()}, failed


def measure(options, name, voxels):
    """{run: figures} of a map."""
    say(f"{name}: {', '.join(options.runs)}")
    made, failed = timed_runs(options, voxels)
    measured = {}
    for run in options.runs:
        if run in failed:
            say(f"{name}, {run} failed: {failed[run]}")
            measured[run] = Figures(Failure=failed[run])
            continue
        seconds, shape = made[run]
        say(f"{name}, {run}: figures")
        figures = Figures(Seconds=seconds, **figures_of(shape, voxels, options.judge))
        if not options.no_solvers:
            for solver, answer in solvers_here().items():
                say(f"{name}, {run}: {solver}")
                figures[solver] = ("not tried" if figures["Intersections"] + figures["WrongEdges"]
                                   else answer(shape))
        measured[run] = figures
    for figures in measured.values():
        figures["Time"] = ratio(figures["Seconds"],
                                measured.get("separate", Figures())["Seconds"])
    return measured


# ---- Targets -------------------------------------------------------------------------------------

def is_filled(answer):
    """1 or 0; NaN where the solver was not run."""
    return float(answer.isdigit()) if isinstance(answer, str) else math.nan


def target_rows(name, measured):
    shared, separate, nets = (measured.get(run, Figures()) for run in ("shared", "separate", "nets"))
    rows = [
        ("pairs of triangles that cross", shared["Intersections"], "<=", 0),
        ("triangles without area", shared["Flat"], "<=", 0),
        ("edges where a label is not closed", shared["WrongEdges"], "<=", 0),
        ("edges at which labels overlap", shared["Folded"], "<=", 0),
        ("vertices where a label touches itself", shared["Pinched"], "<=", 0),
        ("edges of three triangles that are no line, or lines that are none", shared["WrongLines"],
         "<=", 0),
        ("points whose Junction is wrong", shared["WrongJunctions"], "<=", 0),
        ("blocks that are not made of the same triangles", shared["WrongBlocks"], "<=", 0),
        ("labels without a surface, as separate", shared["LostLabels"], "<=", separate["LostLabels"]),
        ("error of the volume, %", shared["VolumeLargest"], "<=", .2),
        ("radius ratio mean", shared["RatioMean"], ">=", .94),
        ("least angle off junctions, degrees", shared["AngleInner"], ">=", 25),
        ("wrong voxels, as separate", shared["WrongVoxels"], "<=", separate["WrongVoxels"]),
        ("filled by TetGen -pY", is_filled(shared["tetgen"]), ">=", 1),
        ("filled by gmsh", is_filled(shared["gmsh"]), ">=", 1),
        ("time, shared / separate", shared["Time"], "<=", 1 if name == "polycrystal" else 2)]
    if name == "polycrystal":
        rows.append(("angle on junction lines, 95 %, as SurfaceNets3D", shared["Roughness"], "<=",
                     nets["Roughness"]))
    return [target_row(name, what, math.nan if math.isnan(limit) else figure, relation, limit)
            for what, figure, relation, limit in rows]


def main():
    options = parse_options(named_maps)
    if "nets" not in runs_here():
        print("vtkSurfaceNets3D is left out: it comes with VTK 9.3 (Debian 13).")
    if "shared" not in runs_here():
        print("Shared interfaces are left out: this vtkLabelsToSurfaces has none.")
    rows, targets, failed = [["Map", "Run", *CSV_COLUMNS]], [TARGET_HEADING], False
    for name in options.maps:
        voxels = named_maps(options.make_volume)[name]()
        if voxels is None:
            print(f"{name} is left out: mricron-data is not installed.")
            continue
        measured = measure(options, name, voxels)
        print(f"\n{name}: {' x '.join(map(str, voxels.values.shape[::-1]))} voxels, "
              f"{len(voxels.counts)} labels:\n")
        print_table([["", *COLUMNS.values()]] + [
            [run + (" FAILED" if figures.failure else ""),
             *(figure_text(figures[column]) for column in COLUMNS)]
            for run, figures in measured.items()])
        failed = failed or any(figures.failure for figures in measured.values())
        rows += [[name, run, *(exact_text(figures[column]) for column in CSV_COLUMNS)]
                 for run, figures in measured.items()]
        targets += target_rows(name, measured)
    print("\nTargets:\n")
    print_table(targets, 2)
    write_tables(options.csv, rows, targets=targets)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
