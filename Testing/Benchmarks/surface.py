# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""vtkDeformableSurface and other surface generators, each run in a process of its own, all judged by
the same code.

Peers get the volume with a border of one background voxel. The time includes the pyramid but not
loading the volume. Lengths are those of the metric, in units of the smallest voxel distance (in rows
of a level: that of the level). Peers with a resolution parameter follow our mean edge length. CGAL's
mesher has no parameter for the number of vertices: if it differs from ours by more than 5 % it runs
again with another radius, at most twice. Vertex updates are vertices times iterations in which they
were active, edits are splits, collapses and flips. Both are independent of the machine."""

import math

from tables import (
    Figures, benchmark, finish, print_figures, print_targets, ratio, say)

RUNS = {
    "us": "vtkDeformableSurface with pyramid, one thread",
    "us-2": "the same with two threads",
    "flat": "vtkDeformableSurface without pyramid, one thread",
    "flying": "vtkFlyingEdges3D",
    "smoothed": "flying, largest component, vtkWindowedSincPolyDataFilter",
    "remeshed": "smoothed, CGAL isotropic_remeshing to our mean edge",
    "mesher": "CGAL make_surface_mesh to about as many vertices as ours"}
COLUMNS = {
    "Seconds": "seconds", "ProcessorSeconds": "processor seconds", "PeakMegabytes": "MB at the peak",
    "Vertices": "vertices", "Components": "components", "Genus": "genus",
    "Faults": "open, not manifold, not oriented", "SelfIntersections": "self-intersections",
    "EdgeShortest": "edge min", "EdgeMean": "edge mean", "EdgeLongest": "edge max",
    "EdgesOutside": "edges outside bounds", "NearPairs": "pairs too close",
    **{metric + name: metric.lower() + ": " + title for metric in ("World", "Voxels")
       for name, title in {
           "RatioLeast": "radius ratio min", "Ratio01": "radius ratio 1 %",
           "RatioMean": "radius ratio mean", "DistanceAtVertices": "distance at vertices",
           "DistanceAtCentroids": "distance at centroids"}.items()},
    "Reach": "share reached"}
EFFORTS = {
    "Iterations": "iterations", "UpdatesOfVertex": "updates per vertex",
    "EditsOfVertex": "edits per vertex", "Joins": "merges and cuts"}


def add_options(parser):
    parser.add_argument("volume", help=".vti")
    parser.add_argument("--iso", required=True, help="one that no voxel has, such as 226.5")
    parser.add_argument("--metric", type=int, choices=(0, 1), default=1, help="0 voxels, 1 world")
    parser.add_argument("--runs", metavar="LIST", help="comma-separated (default: all): " + ", ".join(
        RUNS) + "; us-N runs with N threads")
    parser.add_argument("--repetitions", type=int, default=1, help="of each run; the fastest counts")


def run(options, name, **named):
    say(f"{options.volume}: {name}")
    ours, _, threads = name.partition("-")
    figures = benchmark(
        options.program, run=ours, threads=threads or None, volume=options.volume,
        iso=options.iso, metric=options.metric, repetitions=options.repetitions, **named)
    if "Levels" in figures:
        figures.update({name: figures[f"level.0.{name}"] for name in COLUMNS
                        if f"level.0.{name}" in figures})
    return figures


def like(options, name, us):
    """Run a peer with a resolution that follows ours."""
    figures = run(options, name, edge=us["EdgeMean"])
    radius = .8 * us["EdgeMean"]
    for _ in range(2 if name == "mesher" else 0):
        share = figures["Vertices"] / us["Vertices"]
        if not .5 < share < 2 or abs(share - 1) <= .05:
            break  # with far fewer vertices it has found a part of the object only
        radius *= math.sqrt(share)  # the number of vertices is proportional to 1/radius^2
        figures = run(options, name, radius=radius)
    return figures


def worst_of_levels(us, name, relation):
    """Return the worst figure of our levels and a text that names the level."""
    known = [(us[f"level.{h}.{name}"], h) for h in range(int(us.get("Levels", 0)))
             if not math.isnan(us[f"level.{h}.{name}"])]
    worst, h = (max if relation == "<=" else min)(known, default=(math.nan, 0))
    return worst, f", level {h} (level 0: {us[f'level.0.{name}']:.3g})" if h else ""


def target_rows(runs, metric):
    us = runs.get("us", Figures())

    def over(name, figure="ProcessorSeconds"):
        return ratio(us[figure], runs.get(name, Figures())[figure])
    rows = [
        ("S1", "us / remeshed, processor seconds", over("remeshed"), "<=", .5),
        ("S2", "us / mesher", over("mesher"), "<=", .6),
        ("S4", "seconds per million vertices",
         1e6 * ratio(us["ProcessorSeconds"], us["Vertices"]), "<=", 12),
        ("S4", "updates per vertex on level 0",
         ratio(us["level.0.Updates"], us["level.0.Vertices"]), "<=", 6),
        ("S5", "us / flat", over("flat"), "<=", .25),
        ("S6", "seconds, us / us-2", over("us-2", "Seconds"), ">=", 1.85),
        ("S7", "MB at the peak, us / remeshed", over("remeshed", "PeakMegabytes"), "<=", .6)]
    prefix = "World" if metric else "Voxels"
    for target, name, relation, limit in (
            ("Q1", "Faults", "<=", 0), ("Q1", "SelfIntersections", "<=", 0),
            ("Q2", "EdgesOutside", "<=", 0), ("Q2", "NearPairs", "<=", 0),
            ("Q3", prefix + "RatioMean", ">=", .97), ("Q3", prefix + "Ratio01", ">=", .8),
            ("Q3", prefix + "RatioLeast", ">=", .5),
            ("Q4", prefix + "DistanceAtVertices", "<=", .02),
            ("Q4", prefix + "DistanceAtCentroids", "<=", .09), ("Q4", "Reach", ">=", .98)):
        worst, where = worst_of_levels(us, name, relation)
        rows.append((target, COLUMNS[name] + where, worst, relation, limit))
    return rows


def measure(options):
    names = options.runs.split(",") if options.runs else list(RUNS)
    runs = {}
    for name in names:
        us = runs.get("us", Figures())
        if name in ("remeshed", "mesher") and "EdgeMean" not in us:
            runs[name] = Figures(Failure="requires the run us")
        elif name in ("remeshed", "mesher"):
            runs[name] = like(options, name, us)
        else:
            runs[name] = run(options, name)
    print(f"{options.volume}, iso-value {options.iso}:\n")
    print_figures(COLUMNS, list(runs.items()), turned=True)
    if "us" in runs:
        us = runs["us"]
        levels = []
        for h in reversed(range(int(us.get("Levels", 0)))):
            level = Figures({name: us[f"level.{h}.{name}"] for name in (
                *COLUMNS, *EFFORTS, "Updates", "Edits") if f"level.{h}.{name}" in us})
            for effort in ("Updates", "Edits"):
                level[effort + "OfVertex"] = ratio(level[effort], level["Vertices"])
            levels.append((f"level {h}", level))
        print("Levels of the run us:\n")
        print_figures({**EFFORTS, **{name: title for name, title in COLUMNS.items()
                                     if "econds" not in name and "Mega" not in name}},
                      levels, turned=True)
    print_targets(target_rows(runs, options.metric))
    return finish(options.csv, list(runs.items()))
