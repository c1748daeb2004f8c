#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""vtkLabelsToSurfaces and its peers (the program BenchmarkLabels) on digitised shapes, on a label map
(.vti, .nii, .nii.gz), on one made of a scan, or on one of ellipsoids and tubes.

Exit code: 0 all was run (targets may be missed), 1 a run failed, 2 the command line is wrong.
"""

import argparse
import math
import signal
import subprocess
import sys

from bench_tables import (
    TARGET_HEADING, Figures, exact_text, print_table, ratio, short_text, target_row, write_tables)

RUNS = """runs:
  us                       all labels at once
  us-gap                   the same with a Gap of .3 voxel
  us-alone                 each label cut out
  windowed, windowed-more  vtkDiscreteFlyingEdges3D, vtkWindowedSincPolyDataFilter
  nets                     vtkSurfaceNets3D, where VTK has it
  antialiased              ITK, where it was found
  remeshed                 windowed and CGAL"""

# Figures of a table of labels, and what people call them.
SHOWN = {
    "ProcessorSeconds": "s", "Vertices": "vertices", "DistanceAtVertices": "dist v",
    "DistanceAtCentroids": "dist c", "DistanceLargest": "max", "NormalAngle": "normals",
    "VolumeError": "vol %", "VolumeByVoxels": "vox vol %", "VoxelsOutside": "out",
    "VoxelsInside": "in", "ReportedWrong": "told", "DihedralMedian": "dih 50",
    "Dihedral95": "dih 95", "RatioLeast": "q min", "RatioQuantile01": "q p01",
    "RatioMean": "q mean", "SelfIntersections": "x"}
PERCENT = ("VolumeError", "VolumeByVoxels")
CSV_COLUMNS = """Seconds ProcessorSeconds PeakMegabytes LabelVoxels Vertices Triangles Components
    OpenEdges NonManifold MisorientedEdges SelfIntersections EdgeMean EdgesOutside NearPairs RatioLeast
    RatioQuantile01 RatioMean DistanceAtVertices DistanceAtCentroids DistanceLargest NormalAngle
    VolumeError VolumeByVoxels VoxelsOutside VoxelsInside ReportedWrong DihedralMedian Dihedral95
    DihedralLargest OverlapPairs OverlapVertices OverlapMean OverlapLargest
    OverlapIntersections""".split()


def list_of(kind, least, what, most=math.inf):
    def parse(text):
        numbers = [kind(word) for word in text.split(",")]
        if min(numbers) < least or len(numbers) > most:
            raise argparse.ArgumentTypeError(f"needs {what} of at least {least}, not \"{text}\"")
        return text
    parse.__name__ = what
    return parse


def integers(least):
    return list_of(int, least, "whole numbers")


def integer(least):
    return list_of(int, least, "one whole number", 1)


def parse_options():
    parser = argparse.ArgumentParser(description=__doc__, epilog=RUNS,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", required=True, help="BenchmarkLabels")
    parser.add_argument("--csv", metavar="FILE.csv", help="all figures; targets: FILE-targets.csv")
    told = parser.add_argument_group("what is measured, and how")
    told.add_argument("--map", metavar="FILE")
    told.add_argument("--mask", action="store_const", const="1", help="all its labels as one")
    told.add_argument("--scan", metavar="FILE")
    told.add_argument("--thresholds", type=list_of(float, -math.inf, "numbers"), metavar="LIST",
                      help="that make labels of the scan")
    told.add_argument("--body", type=integers(16), metavar="X,Y,Z", help="voxels of a map to be made")
    told.add_argument("--body-labels", type=integer(1), metavar="N")
    told.add_argument("--shapes", metavar="LIST", help="of these shapes (default: all)")
    told.add_argument("--sizes", type=integers(32), metavar="LIST", help="voxels of shapes (64,128)")
    told.add_argument("--stretches", type=list_of(float, 1, "numbers"), metavar="LIST",
                      help="lengths of voxels of shapes (1,3)")
    told.add_argument("--labels", type=integers(-32768), metavar="LIST", help="these (all but 0)")
    told.add_argument("--least", type=integer(1), metavar="N", help="voxels of a label (64)")
    told.add_argument("--runs", metavar="LIST", help="these (all that this build has)")
    told.add_argument("--threads", type=integer(1), metavar="N", help="of us; peers have one (1)")
    told.add_argument("--repetitions", type=integer(1), metavar="N", help="the fastest counts (1)")
    told.add_argument("--finest", type=integer(-8), metavar="LEVEL", help="of us")
    told.add_argument("--smoothing", type=float, metavar="S", help="of us")
    told.add_argument("--voxel-tolerance", type=float, metavar="T", help="of us")
    options = parser.parse_args()
    if sum(map(bool, (options.map, options.scan, options.body))) > 1:
        parser.error("--map, --scan and --body each go alone")
    if bool(options.scan) != bool(options.thresholds):
        parser.error("--scan and --thresholds need each other")
    if options.body and options.body.count(",") != 2:
        parser.error("--body needs three numbers, such as 512,512,400")
    if options.mask and not options.map:
        parser.error("--mask needs --map")
    return options


class Row:
    """A run on one label, or on all of them together."""

    def __init__(self, text):
        self.map, self.label, self.run = text.split("\t")
        self.figures = Figures()

    @property
    def is_of_all(self):
        return self.label == "all"

    @property
    def has_surface(self):
        return not (self.figures.failure or self.is_of_all) and self.figures["Triangles"] > 0

    def faults(self):
        return sum(self.figures[name] for name in ("OpenEdges", "NonManifold", "MisorientedEdges"))

    def wrong(self):
        return self.figures["VoxelsOutside"] + self.figures["VoxelsInside"]


def run(options):
    """The rows that the program tells, and its exit code."""
    arguments = [f"--{name.replace('_', '-')}={value}" for name, value in vars(options).items()
                 if value is not None and name not in ("program", "csv")]
    command = [options.program] + [word for each in arguments for word in each.split("=", 1)]
    rows = []
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        for line in process.stdout:
            kind, _, rest = line.rstrip("\n").partition(" ")
            name, _, value = rest.partition(" ")
            if kind == "@row":
                rows.append(Row(rest))
            elif kind == "@number":
                rows[-1].figures[name] = float(value)
            elif kind == "@text":
                rows[-1].figures[name] = value
            else:
                print(line, end="", flush=True)
    return rows, process.returncode


# ---- Tables --------------------------------------------------------------------------------------

def print_rows(rows):
    table = [["map", "label", "run", *SHOWN.values()]]
    for row in rows:
        texts = [short_text((100 if name in PERCENT else 1) * row.figures[name]) for name in SHOWN]
        if row.figures.failure:
            texts[0] = "failed"
        table.append([row.map, row.label, row.run, *texts])
    print_table(table, 3)


def print_summary(rows):
    """A row per run: sums and the worst over the labels; then the labels that ours is worst at."""
    table = [["run", "labels", "failed", "empty", "s", "vertices", "out", "in", "told",
              "dih 95 median", "dih 95 worst", "q min", "q p01", "q mean", "Q1 faults", "x"]]
    for name in dict.fromkeys(row.run for row in rows):
        labels = [row for row in rows if row.run == name and not row.is_of_all]
        made = [row for row in labels if not row.figures.failure]
        surfaces = [row for row in made if row.has_surface]
        angles = sorted(row.figures["Dihedral95"] for row in surfaces) or [math.nan]

        def total(figure, of):
            return sum(row.figures.get(figure, 0.0) for row in of)

        def least(figure, of):
            return min([1.0] + [row.figures[figure] for row in of])

        table.append([
            name, str(len(made)), str(len(labels) - len(made)), str(len(made) - len(surfaces)),
            *map(short_text, (
                total("ProcessorSeconds", made), total("Vertices", surfaces),
                total("VoxelsOutside", made), total("VoxelsInside", surfaces),
                total("ReportedWrong", surfaces), angles[len(angles) // 2], angles[-1],
                least("RatioLeast", surfaces), least("RatioQuantile01", surfaces),
                least("RatioMean", surfaces), sum(row.faults() for row in surfaces),
                total("SelfIntersections", surfaces)))])
    print_table(table)
    ours = [row for row in rows if row.run == "us" and row.has_surface]
    print("\nThe least smooth of ours:\n")
    print_rows(sorted(ours, key=lambda row: -row.figures["Dihedral95"])[:8])


def print_together(rows):
    print("\nAll labels together:\n")
    columns = {"Seconds": "s of the clock", "ProcessorSeconds": "processor s",
               "PeakMegabytes": "MB", "OverlapPairs": "neighbours",
               "OverlapVertices": "vertices inside", "OverlapMean": "mean depth",
               "OverlapLargest": "largest", "OverlapIntersections": "crossing"}
    print_table([["map", "run", *columns.values()]] + [
        [row.map, row.run, *(short_text(row.figures[name]) for name in columns)]
        for row in rows if row.is_of_all], 2)


# ---- Targets -------------------------------------------------------------------------------------

def worst_of(pairs, relation="<="):
    """Of pairs of a value and a row the worst one, and where it is."""
    known = [(value, row) for value, row in pairs if not math.isnan(value)]
    if not known:
        return math.nan, ""
    value, row = (max if relation == "<=" else min)(known, key=lambda each: each[0])
    return value, f": {row.map} {row.label}"


def target_rows(rows):
    """The worst over all rows, and where that is."""
    targets = [TARGET_HEADING]
    labels = [row for row in rows if row.run == "us" and row.has_surface]

    def add(name, what, pairs, relation, limit):
        worst, where = worst_of(pairs, relation)
        targets.append(target_row(name, what + where, worst, relation, limit))

    def add_of_labels(name, what, figure, relation, limit):
        add(name, what, [(abs(row.figures[figure]), row) for row in labels], relation, limit)

    add_of_labels("truth", "distance at vertices, voxels", "DistanceAtVertices", "<=", 0.1)
    add_of_labels("truth", "distance at centroids, voxels", "DistanceAtCentroids", "<=", 0.1)
    add_of_labels("truth", "angle of normals, degrees", "NormalAngle", "<=", 3)
    add_of_labels("truth", "error of the volume", "VolumeError", "<=", 0.002)
    add_of_labels("smooth", "dihedral angle, 95 %, degrees", "Dihedral95", "<=", 8)
    add("lossless", "wrong voxels that it does not tell",
        [(row.wrong() - row.figures["ReportedWrong"], row) for row in labels], "<=", 0)
    add("lossless", "wrong voxels of all, %",
        [(100 * row.wrong() / row.figures["LabelVoxels"], row) for row in labels], "<=", 0)
    add("Q1", "open, non-manifold, misoriented", [(row.faults(), row) for row in labels], "<=", 0)
    add_of_labels("Q1", "self-intersections", "SelfIntersections", "<=", 0)
    add_of_labels("Q2", "edges outside [delta, 2.5 delta]", "EdgesOutside", "<=", 0)
    add_of_labels("Q2", "pairs too near", "NearPairs", "<=", 0)
    add_of_labels("Q3", "radius ratio mean", "RatioMean", ">=", 0.97)
    add_of_labels("Q3", "radius ratio 1 % quantile", "RatioQuantile01", ">=", 0.80)
    add_of_labels("Q3", "radius ratio minimum", "RatioLeast", ">=", 0.50)
    made = [row for row in rows if not row.figures.failure]
    for what, name, figure, limit in (
            ("mean depth in neighbours, voxels", "us", "OverlapMean", 0.05),
            ("pairs of triangles that cross with Gap of .3 voxel", "us-gap", "OverlapIntersections",
             0)):
        add("overlap", what, [(row.figures[figure], row) for row in made if row.run == name], "<=",
            limit)
    # Of labels that both made: us-alone / the peer.
    alone = {(row.map, row.label): row.figures["ProcessorSeconds"]
             for row in rows if row.run == "us-alone" and row.has_surface}
    both = [(alone[row.map, row.label], row.figures["ProcessorSeconds"], row) for row in rows
            if row.run == "remeshed" and row.has_surface and (row.map, row.label) in alone]
    targets.append(target_row(
        "time", "us-alone / remeshed, processor seconds of all",
        ratio(sum(each[0] for each in both), sum(each[1] for each in both)), "<=", 0.5))
    add("time", "  of a label from 1000 voxels on, the worst",
        [(ratio(mine, other), row) for mine, other, row in both
         if row.figures["LabelVoxels"] >= 1000], "<=", 0.5)
    return targets


def main():
    options = parse_options()
    rows, status = run(options)
    if status == 2:
        return 2
    if status:
        end = signal.strsignal(-status) if status < 0 else f"exit code {status}"
        print(f"{options.program} has failed ({end}); it told {len(rows)} rows", file=sys.stderr)
        if not rows:
            return 1
    if options.map or options.scan or options.body:
        print_summary(rows)
    else:
        print_rows([row for row in rows if not row.is_of_all])
    print_together(rows)
    targets = target_rows(rows)
    print("\nTargets (the worst of us):\n")
    print_table(targets, 2)
    write_tables(options.csv, [["Map", "Label", "Run", *CSV_COLUMNS, "Failure"]] + [
        [row.map, row.label, row.run, *(exact_text(row.figures[name]) for name in CSV_COLUMNS),
         row.figures.failure] for row in rows], targets=targets)
    return 1 if status or any(row.figures.failure for row in rows) else 0


if __name__ == "__main__":
    sys.exit(main())
