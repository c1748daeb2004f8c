#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Runs vtkDeformableSurface and what else makes a surface of a volume, one after the other, each in
a process of its own (the program BenchmarkSurface), has all results judged by the same code, and
prints one table and what became of the targets.

Peers get the volume with a voxel of air around it; loading it is not measured, the pyramid is.
Seconds are those of the clock and of the processor, memory is the resident memory of the whole
process at its peak. Lengths and shapes are those of the metric, in which the smallest distance of
two voxels (of the level, where a level is spoken of) is 1; "voxels" and "world" name the other one
or both. Only what was reached counts in voxels, always. Peers that are told how fine to be run after
us-1. CGAL's mesher knows no number of vertices: where it misses ours by more than 5 % it runs again
with a radius that makes up for it, at most twice.

Exit code: 0 all was run (targets may be missed), 1 a run failed, 2 the command line is wrong.
"""

import argparse
import math
import sys

from bench_tables import Figures, print_table, run_program, say, short_text, write_tables
from surface_scaling import measure_growth, measure_model, measure_peaks, measure_threads
from surface_tables import (
    add_derived_figures, level_rows, of_name, print_levels, print_profile, print_runs, run_rows,
    target_rows)

RUNS = {
    "us-1": "vtkDeformableSurface with its pyramid, one thread",
    "us-2": "the same with two threads",
    "us-flat": "the same, one thread, without the pyramid (CoarsestLevel 0)",
    "us-paper": "the same as us-1 with Recovery off (--no-recovery)",
    "flying": "vtkFlyingEdges3D",
    "smoothed": "the same, largest component, vtkWindowedSincPolyDataFilter",
    "decimated": "the same, vtkQuadricDecimation to as many vertices as us-1",
    "remeshed": "smoothed, CGAL isotropic_remeshing to the mean edge of us-1",
    "mesher": "CGAL make_surface_mesh to about as many vertices as us-1",
    "levelset": "ITK threshold segmentation level set from the border inward (--slow, with ITK)"}
FOLLOW_OURS = ("decimated", "remeshed", "mesher")  # are told how fine our surface is
DEFAULT_SIZES = [64, 96, 128, 192, 256, 384, 512]


def number_list(least, most):
    def parse(text):
        numbers = [int(word) for word in text.split(",")]
        if not all(least <= number <= most or number == 0 == least for number in numbers):
            raise ValueError
        return numbers
    parse.__name__ = f"list of whole numbers up to {most}"
    return parse


def parse_options():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter,
        epilog="runs:\n" + "".join(f"  {name:<11}{text}\n" for name, text in RUNS.items())
        + "  us-N       with N threads")
    add = parser.add_argument
    add("--program", required=True, help="BenchmarkSurface")
    add("--volume", metavar="FILE.vti", help="any scalar type, one component")
    add("--iso", type=float, metavar="VALUE",
        help="the isopotential; best one that no voxel equals (226.5, not 226)")
    add("--dark", action="store_true", help="the object is darker than the iso-value")
    add("--scene", metavar="NAME", help="a synthetic volume of the tests instead, such as Torus")
    add("--size", type=int, default=48, help="voxels of it along each axis (48)")
    add("--runs", metavar="LIST", help="only these, with commas between; default: all that are quick")
    add("--slow", action="store_true", help="levelset too")
    add("--no-recovery", action="store_true", help="us-paper too")
    add("--repetitions", type=int, metavar="N",
        help="of each run; the one of median processor time is told (1, of --threads 5)")
    add("--metric", choices=("voxels", "world"), default="world",
        help="which lengths are uniform where voxels are no cubes")
    add("--initialization", type=int, default=0, choices=(0, 1, 2),
        help="0 enclosing icosahedron (default), 1 seeds, 2 iso-surface of the coarsest level")
    add("--coarsest", type=int, metavar="LEVEL",
        help="where us-N starts; default: the coarsest where a voxel of the object is left")
    add("--edge-length", type=float, metavar="X", help="mean edge, voxels, and")
    add("--vertices", type=int, metavar="N",
        help="number of vertices that the peers aim at; default: those of us-1")
    add("--growth", action="store_true",
        help="instead: how cost grows, us-1 on about the voxels of 64^3 ... 512^3, with exponents")
    add("--threads", type=number_list(1, 999), metavar="LIST",
        help="instead: what threads gain, us-N for each N by turns, as 1,2")
    add("--model", action="store_true",
        help="instead: what 2 to 64 threads would gain, chunks of us-1 measured and scheduled")
    add("--memory", action="store_true", help="instead: what memory us-1 takes at 512^3 and 1024^3")
    add("--sizes", type=number_list(0, 1024), metavar="LIST",
        help="for these four, the volume at other sizes; 0: as it is")
    add("--max-size", type=int, metavar="N", help="for --growth: its sizes up to N")
    add("--profile", action="store_true", help="also seconds by phase and level of us-1")
    add("--csv", metavar="FILE.csv", help="all figures; also FILE-levels.csv, FILE-targets.csv and "
        "FILE-exponents.csv")
    add("--output", metavar="FILE.vtp", help="the surface of us-1")
    options = parser.parse_args()
    options.runs = options.runs and options.runs.split(",")
    check(options, parser.error)
    options.sizes = options.sizes or (
        [size for size in DEFAULT_SIZES if size <= (options.max_size or 512)] if options.growth
        else [512, 1024] if options.memory else [0])
    options.repetitions = options.repetitions or (5 if options.threads else 1)
    return options, parser.error


def check(options, error):
    if bool(options.volume) == bool(options.scene):
        error("--volume FILE.vti or --scene NAME is needed, one of the two")
    if options.volume and options.iso is None:
        error("--iso VALUE is needed with --volume")
    for name in options.runs or ():
        if name not in RUNS and not (name.startswith("us-") and name[3:].isdigit()):
            error(f'--runs: no run "{name}"; there are {", ".join(RUNS)}, and us-N')
    modes = options.growth + options.model + bool(options.threads) + options.memory
    if options.growth and 0 in (options.sizes or ()):
        error("--growth has no size 0")
    if modes > 1:
        error("--growth, --model, --threads and --memory each go alone")
    if modes and (options.runs or options.slow or options.no_recovery):
        error("--growth, --model, --threads and --memory run us-N only: they go without --runs, "
              "--slow and --no-recovery")


def run_once(options, name, *arguments, volume=None, iso=None):
    """The figures of a run in a process of its own."""
    iso = options.iso if iso is None else iso
    where = ["--volume", volume or options.volume] if volume or options.volume else [
        "--scene", options.scene, "--size", options.size]
    return run_program(
        options.program, "--run", name, *where, *(["--iso", repr(iso)] if iso is not None else []),
        *(["--dark"] if options.dark else []),
        *(["--coarsest", options.coarsest] if options.coarsest is not None else []),
        "--metric", options.metric, "--initialization", options.initialization, *arguments)


def introduce(options, error):
    """Loads the volume once, for what can be wrong with it to be told once."""
    volume = run_once(options, "volume")
    if volume.failure:
        error(volume.failure)
    low, high, iso = (short_text(volume[name], 6) for name in ("Low", "High", "IsoValue"))
    if not volume["Low"] < volume["IsoValue"] < volume["High"]:
        error(f"the iso-value {iso} is not between the least and the largest voxel, {low} and {high}")
    print(f"{options.scene or options.volume}: {volume.text('Size')} voxels, {volume.text('Type')}, "
          f"{low} to {high}, iso-value {iso}", flush=True)
    return volume


def repeated(options, name, *arguments):
    """The run of median processor time of several."""
    runs = []
    for i in range(options.repetitions):
        say(name + (" again" if i else ""))
        runs.append(run_once(options, name, *arguments))
        if runs[-1].failure:
            say(f"{name} failed: {runs[-1].failure}")
            return runs[-1]
    surfaces = {run.text("Fingerprint") for run in runs}
    runs.sort(key=lambda run: run["ProcessorSeconds"])
    median = runs[(len(runs) - 1) // 2]
    median.update(Repetitions=float(len(runs)), RepetitionsDiffer=float(len(surfaces) > 1))
    return median


def mesher_of_our_size(options, edge_length, vertices):
    radius = None
    for _ in range(3):
        figures = repeated(options, "mesher", "--edge-length", repr(edge_length), "--vertices",
                           vertices, *(["--radius", repr(radius)] if radius else []))
        share = figures["Vertices"] / vertices
        if not share > 0 or abs(share - 1) <= 0.05:
            break
        radius = figures["Radius"] * math.sqrt(share)  # the number goes with the inverse square
    return figures


def run_all(options, names):
    edge_length, vertices = options.edge_length, options.vertices
    runs = []
    for name in names:
        if name in FOLLOW_OURS and not (edge_length and vertices):
            figures = Figures(Failure="not run, as us-1 failed, whose surface it follows")
        elif name == "mesher":
            figures = mesher_of_our_size(options, edge_length, vertices)
        else:
            told = ["--edge-length", repr(edge_length), "--vertices", vertices]
            figures = repeated(
                options, name, *(told if name in FOLLOW_OURS else []),
                *(["--profile"] if options.profile else []),
                *(["--output", options.output] if options.output and name == "us-1" else []))
        if name == "us-1" and not figures.failure:
            edge_length = edge_length or figures["EdgeMean"]
            vertices = vertices or round(figures["Vertices"])
        runs.append((name, figures))
    return runs


def run_side_by_side(options, has_level_set, error):
    names = options.runs or [
        name for name in RUNS
        if (name != "levelset" or (options.slow and has_level_set))
        and (name != "us-paper" or options.no_recovery)]
    for i, name in enumerate(names):
        if name in FOLLOW_OURS and "us-1" not in names[:i] and not (
                options.edge_length and options.vertices):
            error(f"{name} follows the surface of us-1: let that run before, or give both "
                  "--edge-length and --vertices")
    runs = run_all(options, names)
    add_derived_figures(runs)
    print()
    print_runs(runs)
    us = of_name(runs, "us-1")
    if us:
        print("\nBy level (edges and delta in voxels of level 0, distances in those of the level):\n")
        print_levels(us)
        if options.profile:
            print("\nBy phase (seconds of the clock, us-1):\n")
            print_profile(us)
    targets = target_rows(runs)
    print("\nTargets (Q: the worst level of us-1):\n")
    print_table(targets, 2)
    write_tables(options.csv, run_rows(runs), levels=level_rows(us), targets=targets)
    return not any(figures.failure for _, figures in runs)


def main():
    options, error = parse_options()
    volume = introduce(options, error)

    def run_ours(name, size, *arguments, **where):
        """A run of ours on the volume at a size, of which nothing is judged or written."""
        resample = ["--resample", size] if size else []
        return run_once(options, name, "--no-judge", *resample, *arguments, **where)

    measure = (measure_growth if options.growth else measure_model if options.model
               else measure_threads if options.threads else measure_peaks if options.memory else None)
    is_well = (measure(options, run_ours) if measure
               else run_side_by_side(options, volume["HasLevelSet"] > 0, error))
    return 0 if is_well else 1


if __name__ == "__main__":
    sys.exit(main())
