# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The tables of runs side by side: costs and quality, levels, phases, and the targets."""

import math

from bench_tables import (
    LARGE_VOLUME, TARGET_HEADING, Figures, exact_text, print_table, ratio, short_text, target_row)

# Names of figures, and what people call them.
COSTS = {
    "WallSeconds": "seconds", "ProcessorSeconds": "processor seconds",
    "WallRatio": "seconds / us-1", "ProcessorRatio": "processor seconds / us-1",
    "PyramidSeconds": "of these the pyramid", "BaseMegabytes": "MB before",
    "PeakMegabytes": "MB at the peak", "CoarsestLevel": "coarsest level",
    "Iterations": "iterations", "MicrosecondsPerVertexIteration": "us / vertex, iteration"}
LEVEL_COSTS = {
    "Iterations": "iterations", "Seconds": "seconds",
    "VertexIterations": "vertices x iterations",
    "MicrosecondsPerVertexIteration": "us / vertex, iteration", "LostParts": "lost parts",
    "RecoveredParts": "recovered parts", "Delta": "delta"}
FIT = {
    "RatioLeast": "radius ratio min", "RatioQuantile01": "radius ratio p01",
    "RatioMean": "radius ratio mean", "DistanceAtVertices": "distance at vertices",
    "DistanceAtCentroids": "distance at centroids"}
QUALITY = {
    "Vertices": "vertices", "Triangles": "triangles", "Components": "components", "Genus": "genus",
    "GenusOfLargest": "genus of the largest", "OpenEdges": "open edges",
    "NonManifold": "not manifold", "MisorientedEdges": "misoriented edges",
    "SelfIntersections": "self-intersections", "EdgeShortest": "edge min", "EdgeMean": "edge mean",
    "EdgeLongest": "edge max", "EdgesOutside": "edges outside bounds",
    "NearPairs": "pairs too near", **FIT, "Reach": "share reached",
    **{"Voxels" + name: "voxels: " + title for name, title in FIT.items()},
    **{"World" + name: "world: " + title for name, title in FIT.items()}}
FOUR_DIGITS = {"BaseMegabytes", "PeakMegabytes", "RatioMean", "Reach", "VoxelsRatioMean",
               "WorldRatioMean"}
ONLY_IN_CSV = ["Volume", "Outward", "FlatTriangles", "EdgesTooShort", "EdgesTooLong", "Voxels"]
TEXTS = ["StopReason", "Fingerprint", "Failure"]

BETWEEN_ITERATIONS = "DivisionSeconds"  # which the seconds of iterations do not include
PARTS_BETWEEN = ["RecoverySeconds", "RegularisationSeconds"]  # of these


def phases_of(figures):
    """The figures of the phases that add up; none without a profile."""
    return [name for name in figures.text("Phases").split(",") if name]


def without_seconds(phase):
    return phase.removesuffix("Seconds")


def serial_of(phase):
    """The figure that tells what one thread did alone."""
    return without_seconds(phase) + "SerialSeconds"


def of_name(runs, name):
    """The figures of the run that went well; none of another."""
    return next((figures for run, figures in runs if run == name and not figures.failure), Figures())


def add_derived_figures(runs):
    """Ratios to us-1, EdgesOutside, and microseconds per vertex and iteration."""
    us = Figures(of_name(runs, "us-1"))
    for _, figures in runs:
        figures["WallRatio"] = ratio(figures["WallSeconds"], us["WallSeconds"])
        figures["ProcessorRatio"] = ratio(figures["ProcessorSeconds"], us["ProcessorSeconds"])
        for prefix, seconds in [("", "ProcessorSeconds")] + [
                (f"level.{h}.", "Seconds") for h in figures.levels]:
            figures[prefix + "MicrosecondsPerVertexIteration"] = 1e6 * ratio(
                figures[prefix + seconds], figures[prefix + "VertexIterations"])
            figures[prefix + "EdgesOutside"] = (
                figures[prefix + "EdgesTooShort"] + figures[prefix + "EdgesTooLong"])


def figure_rows(heading, titles, columns):
    """A row per figure, a column per run or level."""
    return [heading] + [
        [title] + [short_text(get(name), 4 if name in FOUR_DIGITS else 3) for get in columns]
        for name, title in titles.items()]


def print_runs(runs):
    print_table(figure_rows(
        [""] + [name + (" FAILED" if figures.failure else "") for name, figures in runs],
        {**COSTS, **QUALITY}, [figures.__getitem__ for _, figures in runs]))


def run_rows(runs):
    numbers = [*COSTS, *QUALITY, *ONLY_IN_CSV]
    return [["Run", *numbers, *TEXTS]] + [
        [name, *(exact_text(figures[number]) for number in numbers), *map(figures.text, TEXTS)]
        for name, figures in runs]


def print_levels(us):
    levels = list(reversed(us.levels))
    print_table(figure_rows(
        ["us-1"] + [f"level {h}" for h in levels], {**LEVEL_COSTS, **QUALITY},
        [lambda name, h=h: us.level(h, name) for h in levels]))


def level_rows(us):
    phases = phases_of(us)
    phases += PARTS_BETWEEN if phases else []
    names = [*LEVEL_COSTS, *QUALITY, *phases, *map(serial_of, phases)]
    return [["Level", *names]] + [
        [str(h), *(exact_text(us.level(h, name)) for name in names)] for h in us.levels]


def print_profile(us):
    """Seconds by level and phase, their share of the run, microseconds per vertex and iteration."""
    rows = [["phase", "level", "seconds", "share", "serial", "us / vertex, iteration"]]
    run = us["WallSeconds"]

    def add(phase, level, seconds, serial, vertex_iterations):
        rows.append([
            phase, level, short_text(seconds), short_text(100 * ratio(seconds, run)) + " %", serial,
            short_text(1e6 * seconds / vertex_iterations) if vertex_iterations > 0 else "-"])

    def total(name):
        return sum(us.level(h, name) for h in us.levels)

    phases = phases_of(us)
    shown = [(phase, "") for phase in phases] + [(part, "  of this ") for part in PARTS_BETWEEN]
    inside = [phase for phase in phases if phase != BETWEEN_ITERATIONS]
    for h in reversed(us.levels):
        here = us.level(h, "VertexIterations")
        for phase, what in shown:
            add(what + without_seconds(phase), str(h), us.level(h, phase),
                short_text(us.level(h, serial_of(phase))), here)
        rest = us.level(h, "Seconds") - sum(us.level(h, phase) for phase in inside)
        add("rest of the iterations", str(h), rest, "", here)
    everywhere = us["VertexIterations"]
    for phase, what in shown:
        add(what + without_seconds(phase), "all", total(phase), short_text(total(serial_of(phase))),
            everywhere)
    add("rest of the iterations", "all", total("Seconds") - sum(map(total, inside)), "", everywhere)
    add("pyramid", "all", us["PyramidSeconds"], "", everywhere)
    between = total(BETWEEN_ITERATIONS) if BETWEEN_ITERATIONS in phases else 0.0
    add("voxels, output", "all", run - us["PyramidSeconds"] - total("Seconds") - between, "",
        everywhere)
    print_table(rows)


# ---- Targets -------------------------------------------------------------------------------------

def worst_of_levels(us, names, relation):
    """The worst of a sum of figures over the levels, and where that is."""
    sums = [(sum(us.level(h, name) for name in names), h) for h in us.levels]
    known = [(value, h) for value, h in sums if not math.isnan(value)]
    if not known:
        return math.nan, ""
    worst, h = (max if relation == "<=" else min)(
        known, key=lambda each: (each[0], -each[1] if relation == "<=" else each[1]))
    return worst, f", level {h} (level 0: {short_text(sums[0][0])})" if h > 0 else ""


def distinct_surfaces(runs):
    """How many differ of those that must not: of us-N; unknown with less than two."""
    ours = [(name, figures) for name, figures in runs
            if name.startswith("us-") and name[3:].isdigit() and not figures.failure]
    distinct = {figures.text("Fingerprint") for _, figures in ours}
    distinct |= {name for name, figures in ours if figures["RepetitionsDiffer"] > 0}
    count = sum(figures["Repetitions"] for _, figures in ours)
    return len(distinct) if count >= 2 else math.nan


def target_rows(runs):
    """Speed by processor seconds of one thread, S6 by the clock; quality (Q) is that of us-1, the
    worst of its levels; Q5 compares the bits of all numbers of threads and all repetitions."""
    us = of_name(runs, "us-1")

    def over(name, figure="ProcessorSeconds"):
        return ratio(us[figure], of_name(runs, name)[figure])

    rows = [
        ("S1", "us-1 / remeshed, processor seconds", over("remeshed"), "<=", 0.5),
        ("S2", "us-1 / mesher, processor seconds", over("mesher"), "<=", 0.6),
        ("S3", "us-1 / levelset, processor seconds", over("levelset"), "<=", 0.05),
        ("S4", "us-1, us per vertex and iteration", us["MicrosecondsPerVertexIteration"], "<=", 1),
        ("S5", "us-1 / us-flat, processor seconds", over("us-flat"), "<=", 0.25),
        ("S5", "  to the same result: difference of share reached, %",
         100 * abs(us["Reach"] - of_name(runs, "us-flat")["Reach"]), "<=", 0.5),
        ("S5", "  and of enclosed volume, %", 100 * abs(over("us-flat", "Volume") - 1), "<=", 0.5),
        # Of single runs; the target is one of medians: --threads.
        ("S6", "us-1 / us-2, seconds", over("us-2", "WallSeconds"), ">=",
         1.85 if us["Voxels"] > LARGE_VOLUME else 1.75),
        ("S7", "us-1 / remeshed, MB at the peak", over("remeshed", "PeakMegabytes"), "<=", 0.6)]
    for name, what, figures, relation, limit in (
            ("Q1", "open, non-manifold, misoriented",
             ["OpenEdges", "NonManifold", "MisorientedEdges"], "<=", 0),
            ("Q1", "self-intersections", ["SelfIntersections"], "<=", 0),
            ("Q2", "edges outside [delta, 2.5 delta]", ["EdgesOutside"], "<=", 0),
            ("Q2", "pairs too near", ["NearPairs"], "<=", 0),
            ("Q3", "radius ratio mean", ["RatioMean"], ">=", 0.97),
            ("Q3", "radius ratio 1 % quantile", ["RatioQuantile01"], ">=", 0.80),
            ("Q3", "radius ratio minimum", ["RatioLeast"], ">=", 0.50),
            ("Q4", "distance at vertices", ["DistanceAtVertices"], "<=", 0.02),
            ("Q4", "distance at centroids", ["DistanceAtCentroids"], "<=", 0.09),
            ("Q4", "share of boundary reached", ["Reach"], ">=", 0.98)):
        worst, where = worst_of_levels(us, figures, relation)
        rows.append((name, what + where, worst, relation, limit))
    rows.append(("Q5", "different surfaces over runs and threads", distinct_surfaces(runs), "<=", 1))
    return [TARGET_HEADING] + [target_row(*row) for row in rows]
