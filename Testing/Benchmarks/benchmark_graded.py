#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Graded triangles beside what else makes few triangles of a surface, all judged by the same code.

A table for each scan and tolerance, which is in the shortest distance of two voxels, as all
lengths are. Its rows: the uniform surface of `volumic`, that with the tolerance (graded), and three
made of the uniform one: by vtkQuadricDecimation, with as many vertices as the graded one; by CGAL's
isotropic_remeshing with an Adaptive_sizing_field of that tolerance (CGAL 6); and by mmgs -hausd,
with the bounds of edges and the gradation of the graded one.

`within` is the share of random points of the triangles, evenly by area, that are no further from
VTK's iso-surface than the tolerance (vtkFlyingEdges3D of the volume with a voxel of air around it,
linearly interpolated on voxels half as wide); `largest` is the largest distance of them all.
`intersections` are pairs of triangles, counted by CGAL; `alike` is the share of pairs of edges that
share a vertex of which one is no more than 1.5 times as long as the other; `outside` are edges that
are not in [1, 2.5] of the mean delta of their ends. `time` is processor seconds, those of the
uniform surface included where it is made of that, over those of the uniform surface: one thread,
medians of runs by turns.

Exit code: 0 all was run (targets may be missed), 1 a run failed, 2 the command line is wrong.
"""

import argparse
import os
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

from bench_tables import (
    TARGET_HEADING, Figures, exact_text, print_table, ratio, say, short_text, target_row,
    write_tables)
import graded_surfaces as surfaces

COLUMNS = {
    "Vertices": "vertices", "Fewer": "uniform / this", "Within": "within %", "Largest": "largest",
    "RatioMean": "radius ratio", "Ratio01": "1 %", "RatioLeast": "min",
    "Intersections": "intersections", "Alike": "alike %", "Outside": "outside", "Time": "time"}
# How many times fewer vertices are wanted, by name of the scan, and what time, by tolerance.
WANTED_FEWER = {
    "skull": {.1: 1.7, .2: 2.5}, "engine": {.1: 2., .2: 3.3}, "tooth": {.1: 2.2, .2: 4.3}}
WANTED_TIME = {.1: .8, .2: .6}
GRADATION = .2
LONGEST = 4  # edges of the graded surface grow up to so many times those of the uniform one


def parse_options():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    add = parser.add_argument
    add("--program", required=True, help="volumic")
    add("--judge", required=True, help="JudgeFiles")
    add("--adaptive", help="AdaptiveRemesh, which is built with CGAL 6")
    add("--scan", nargs=3, action="append", required=True, metavar=("NAME", "FILE.vti", "ISO"))
    add("--tolerances", default="0.1,0.2", metavar="LIST", help="default: 0.1,0.2")
    add("--points", type=int, default=20000, metavar="N", help="of each surface (20000)")
    add("--repetitions", type=int, default=3, metavar="N", help="of each run (3)")
    add("--csv", metavar="FILE.csv", help="all figures; also FILE-targets.csv")
    options = parser.parse_args()
    try:
        options.tolerances = [float(word) for word in options.tolerances.split(",")]
        options.scan = [(name, path, float(iso)) for name, path, iso in options.scan]
    except ValueError as error:
        parser.error(str(error))
    return options


def processor_seconds(*command):
    """Of a process that is waited for; RuntimeError where it fails."""
    with tempfile.TemporaryFile() as words:
        process = subprocess.Popen([str(word) for word in command], stdout=words,
                                   stderr=subprocess.STDOUT)
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        if process.returncode:
            words.seek(0)
            raise RuntimeError(f"{os.path.basename(command[0])} failed, {process.returncode}: "
                               + words.read().decode(errors="replace")[-300:])
    return usage.ru_utime + usage.ru_stime


class Scan:
    """The surfaces of a scan in a folder, by name, and what each has cost."""

    def __init__(self, options, folder, name, path, iso):
        self.options, self.name, self.folder = options, name, folder
        self.volume, self.iso = path, iso
        self.reference = surfaces.IsoSurface(path, iso)
        self.unit = self.reference.unit
        self.seconds = {}

    def path(self, name):
        return os.path.join(self.folder, name)

    def segment(self, tolerance):
        """With the command; 0: uniform."""
        name = f"graded {tolerance:g}" if tolerance else "uniform"
        graded = ["--tolerance", repr(tolerance * self.unit)] if tolerance else []
        self.note(name, processor_seconds(
            self.options.program, self.volume, self.path(f"{name}.vtp"), "--iso", repr(self.iso),
            "--threads", 1, "--quiet", *graded))

    def note(self, name, seconds):
        self.seconds.setdefault(name, []).append(seconds)

    def measure_ours(self):
        for _ in range(self.options.repetitions):
            for tolerance in (0, *self.options.tolerances):
                self.segment(tolerance)

    def make_peer(self, name, make):
        """`make` gives a surface and processor seconds; it may be called many times."""
        for _ in range(self.options.repetitions):
            surface, seconds = make()
            self.note(name, seconds)
        surfaces.write(surface, self.path(f"{name}.vtp"))

    def decimated(self, vertices):
        surface = surfaces.read(self.path("uniform.vtp"))
        start = time.process_time()
        surface = surfaces.decimated(surface, vertices)
        return surface, time.process_time() - start

    def edges(self):
        """Bounds of what is wanted, as of the graded surface."""
        mean = surfaces.mean_edge(surfaces.read(self.path("uniform.vtp")))
        return mean, LONGEST * mean

    def remeshed(self, tolerance):
        surfaces.write(surfaces.read(self.path("uniform.vtp")), self.path("in.ply"))
        seconds = processor_seconds(self.options.adaptive, self.path("in.ply"),
                                    self.path("out.ply"), tolerance * self.unit, *self.edges())
        return surfaces.read(self.path("out.ply")), seconds

    def of_mmgs(self, tolerance, program):
        surfaces.write_medit(surfaces.read(self.path("uniform.vtp")), self.path("in.mesh"))
        shortest, longest = self.edges()
        seconds = processor_seconds(
            program, "-v", 0, "-nr", "-in", self.path("in.mesh"), "-out", self.path("out.mesh"),
            "-hausd", tolerance * self.unit, "-hgrad", 1 + GRADATION, "-hmin", shortest,
            "-hmax", longest)
        return surfaces.read_medit(self.path("out.mesh")), seconds

    def peers(self, tolerance):
        """{name: what makes it}"""
        vertices = surfaces.read(self.path(f"graded {tolerance:g}.vtp")).GetNumberOfPoints()
        peers = {"decimated": lambda: self.decimated(vertices)}
        if self.options.adaptive:
            peers["CGAL adaptive"] = lambda: self.remeshed(tolerance)
        mmgs = shutil.which("mmgs") or shutil.which("mmgs_O3")
        if mmgs:
            peers["mmgs"] = lambda: self.of_mmgs(tolerance, mmgs)
        return peers

    def figures(self, name, tolerance):
        """Of a surface that is written, by the judge and here."""
        surface = surfaces.read(self.path(f"{name}.vtp"))
        told = subprocess.run([self.options.judge, self.path(f"{name}.vtp")], check=True,
                              capture_output=True, text=True).stdout.split()
        columns = subprocess.run([self.options.judge, "--help"], check=True, capture_output=True,
                                 text=True).stdout.split()
        judged = dict(zip(columns, map(float, told)))
        distances = self.reference.distances(surface, self.options.points) / self.unit
        seconds = {run: statistics.median(of_run) for run, of_run in self.seconds.items()}
        is_ours = name.split()[0] in ("uniform", "graded")
        return Figures(
            Vertices=judged["points"], Within=100 * (distances <= tolerance).mean(),
            Largest=distances.max(), RatioMean=judged["ratio"], Ratio01=judged["ratio01"],
            RatioLeast=judged["ratiomin"], Intersections=judged["intersections"],
            Wrong=3 - judged["closed"] - judged["manifold"] - judged["oriented"],
            Outside=judged["short"] + judged["long"],
            Alike=100 * surfaces.alike_edges(surface, 1.5),
            Seconds=seconds[name], Time=ratio(
                seconds[name] + (0 if is_ours else seconds["uniform"]), seconds["uniform"]))


def measure(scan, tolerance):
    """[(run, figures)]; a peer that fails is told and has no figures."""
    failed = False
    runs = []
    for name, make in {"uniform": None, f"graded {tolerance:g}": None,
                       **scan.peers(tolerance)}.items():
        say(f"{scan.name}, {tolerance:g}: {name}")
        try:
            full_name = f"{name} {tolerance:g}" if make else name
            if make:
                scan.make_peer(full_name, make)
            runs.append((name, scan.figures(full_name, tolerance)))
        except (RuntimeError, subprocess.CalledProcessError) as error:
            say(str(error))
            runs.append((f"{name} FAILED", Figures()))
            failed = True
    for _, figures in runs:
        figures["Fewer"] = ratio(runs[0][1]["Vertices"], figures["Vertices"])
    return runs, failed


def target_rows(scan, tolerance, runs):
    graded = runs[1][1]
    name = f"{scan}, {tolerance:g}"
    return [target_row(name, what, figure, relation, limit) for what, figure, relation, limit in (
        ("vertices, uniform / graded", graded["Fewer"], ">=",
         WANTED_FEWER.get(scan, {}).get(tolerance, 1)),
        ("points within the tolerance, %", graded["Within"], ">=", 99),
        ("time, graded / uniform", graded["Time"], "<=", WANTED_TIME.get(tolerance, 1)),
        ("self-intersections", graded["Intersections"], "<=", 0),
        ("open, not manifold, not oriented", graded["Wrong"], "<=", 0),
        ("edges outside [1, 2.5] delta", graded["Outside"], "<=", 0),
        ("radius ratio mean", graded["RatioMean"], ">=", .95),
        ("radius ratio 1 % quantile", graded["Ratio01"], ">=", .7),
        ("radius ratio minimum", graded["RatioLeast"], ">=", .4),
        ("edges at a vertex alike, %", graded["Alike"], ">=", 99))]


def main():
    options = parse_options()
    if not options.adaptive:
        print("CGAL's adaptive remeshing is left out: it comes with CGAL 6 (Debian 13).")
    if not (shutil.which("mmgs") or shutil.which("mmgs_O3")):
        print("mmgs is left out: there is no such command.")
    rows, targets, failed = [["Scan", "Tolerance", "Run", *COLUMNS, "Seconds"]], [], False
    for name, path, iso in options.scan:
        with tempfile.TemporaryDirectory() as folder:
            scan = Scan(options, folder, name, path, iso)
            say(f"{name}: uniform and graded, {options.repetitions} times")
            scan.measure_ours()
            for tolerance in options.tolerances:
                runs, has_failed = measure(scan, tolerance)
                failed = failed or has_failed
                print(f"\n{name}, iso-value {iso:g}, tolerance {tolerance:g}:\n")
                print_table([["", *COLUMNS.values()]] + [
                    [run, *(short_text(figures[column]) for column in COLUMNS)]
                    for run, figures in runs])
                rows += [[name, f"{tolerance:g}", run, *(
                    exact_text(figures[column]) for column in (*COLUMNS, "Seconds"))]
                         for run, figures in runs]
                targets += target_rows(name, tolerance, runs)
    targets.insert(0, TARGET_HEADING)
    print("\nTargets:\n")
    print_table(targets, 2)
    write_tables(options.csv, rows, targets=targets)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
