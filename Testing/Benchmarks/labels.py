# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""vtkLabelsToSurfaces and its peers on digitised shapes, whose surfaces are known, or on a label map.

Distances are to the true surface, in voxels; angles in degrees. `strict` is ours with a
VoxelTolerance of 0; peers get each label cut out: windowed is vtkDiscreteFlyingEdges3D and
vtkWindowedSincPolyDataFilter, remeshed that and CGAL's remeshing to our mean edge."""

import math
import os
import statistics
import subprocess

from tables import Figures, finish, print_figures, print_targets, ratio, words_of

COLUMNS = {
    "ProcessorSeconds": "processor s", "Vertices": "vertices", "DistanceAtVertices": "dist v",
    "DistanceAtCentroids": "dist c", "NormalAngle": "normals", "VolumeError": "volume, share",
    "Wrong": "wrong voxels", "Dihedral95": "dihedral", "RatioLeast": "q min", "Ratio01": "q 1 %",
    "RatioMean": "q mean", "SelfIntersections": "crossing", "Faults": "faults"}
SUMMARY = {
    "Labels": "labels", "Failed": "without surface", "ProcessorSeconds": "processor s",
    "PeakMegabytes": "MB at the peak", "Vertices": "vertices", "Wrong": "wrong voxels",
    "Dihedral95": "dihedral", "Volume": "volume, share", "VolumeWorst": "worst",
    "SelfIntersections": "self-intersections", "Faults": "faults"}


def add_options(parser):
    parser.add_argument("--map", metavar="FILE", help=".vti, .nii or .nii.gz; default: shapes")
    parser.add_argument("--mask", type=int, help="1: all its labels as one")
    parser.add_argument("--least", type=int, metavar="VOXELS", help="of a label that is measured")
    parser.add_argument("--shapes", metavar="LIST", help="of these (all)")
    parser.add_argument("--size", type=int, help="voxels of shapes along an axis (128)")
    parser.add_argument("--stretch", type=float, help="of their voxels along z")
    parser.add_argument("--runs", metavar="LIST", help="of us, strict, windowed, remeshed (all)")
    parser.add_argument("--threads", type=int, help="of ours; peers have one")
    parser.add_argument("--repetitions", type=int, help="the fastest counts")


def rows_of(options):
    """[(map, label, run, figures)] and the program's exit code."""
    named = {name: getattr(options, name) for name in (
        "map", "mask", "least", "shapes", "size", "stretch", "runs", "threads", "repetitions")}
    rows = []
    with subprocess.Popen([options.program, "labels", *words_of(named)], stdout=subprocess.PIPE,
                          text=True) as process:
        for line in process.stdout:
            if line.startswith("@row "):
                rows.append((*line[5:].rstrip("\n").split("\t"), Figures()))
            elif line.startswith("@") and rows:
                rows[-1][3].take(line)
            elif line.startswith("@"):
                print(line, end="")
    return rows, process.returncode


def summary(rows, run):
    """Sums, and medians over the labels; volumes of those of 1000 voxels or more."""
    of_run = [figures for *_, name, figures in rows if name == run]
    made = [figures for figures in of_run if figures.get("Triangles", 0) > 0]
    errors = [abs(figures["VolumeByVoxels"]) for figures in made if figures["LabelVoxels"] >= 1000]
    angles = [figures["Dihedral95"] for figures in made]
    return Figures({
        **{name: sum(figures[name] for figures in made)
           for name in ("Vertices", "Wrong", "SelfIntersections", "Faults")},
        "ProcessorSeconds": sum(figures["ProcessorSeconds"] for figures in of_run),
        "PeakMegabytes": max((figures["PeakMegabytes"] for figures in of_run), default=math.nan),
        "Labels": len(made), "Failed": len(of_run) - len(made),
        "Dihedral95": statistics.median(angles) if angles else math.nan,
        "Volume": statistics.median(errors) if errors else math.nan,
        "VolumeWorst": max(errors, default=math.nan)})


def target_rows(rows, summaries):
    ours = [(f"{name} {label}", figures) for name, label, run, figures in rows
            if run == "us" and figures.get("Triangles", 0) > 0]

    def worst(target, what, figure, relation, limit, least=0):
        known = [(abs(figures[figure]), where) for where, figures in ours
                 if figure in figures and figures["LabelVoxels"] >= least]
        value, where = (max if relation == "<=" else min)(known, default=(math.nan, ""))
        return target, f"{what}: {where}", value, relation, limit
    us, windowed, remeshed = (
        summaries.get(name, Figures()) for name in ("us", "windowed", "remeshed"))
    return [
        worst("L1", "volume by voxels, share, of labels of 100 or more", "VolumeByVoxels", "<=", .03,
              100),
        ("L1", "dihedral angle, us / remeshed, which has our edges",
         ratio(us["Dihedral95"], remeshed["Dihedral95"]), "<=", 1),
        ("L1", "processor seconds, us / windowed",
         ratio(us["ProcessorSeconds"], windowed["ProcessorSeconds"]), "<=", 5),
        ("L1", "the same, us / remeshed",
         ratio(us["ProcessorSeconds"], remeshed["ProcessorSeconds"]), "<=", .5),
        worst("truth", "distance at vertices, voxels", "DistanceAtVertices", "<=", .1),
        worst("truth", "angle of normals", "NormalAngle", "<=", 3),
        worst("Q1", "open, not manifold, not oriented", "Faults", "<=", 0),
        worst("Q1", "self-intersections", "SelfIntersections", "<=", 0),
        worst("Q3", "radius ratio, mean", "RatioMean", ">=", .97),
        worst("Q3", "radius ratio, 1 %", "Ratio01", ">=", .8)]


def measure(options):
    rows, status = rows_of(options)
    summaries = {run: summary(rows, run) for run in dict.fromkeys(row[2] for row in rows)}
    runs = [(" ".join(row[:3]), row[3]) for row in rows]
    if options.map:
        print(os.path.basename(options.map) + ":\n")
        print_figures(SUMMARY, list(summaries.items()))
    else:
        print_figures(COLUMNS, runs)
    print_targets(target_rows(rows, summaries))
    return finish(options.csv, runs) or int(status != 0)
