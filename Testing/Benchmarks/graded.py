# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Graded triangles: the even surface of `volumic`, that with a tolerance (graded), and the even one
after vtkQuadricDecimation to as many vertices; with --thin also that with --thin-parts and --finest
-1. Options that are not known here are volumic's.

Tolerances are in the shortest distance of two voxels. `within` is the share of random points of the
triangles, evenly by area, that are no further from VTK's iso-surface than the tolerance
(vtkFlyingEdges3D of the volume with a voxel of air around it, linearly interpolated on voxels half as
wide). `time` is processor seconds of the whole command, those of the even surface included where it
is made of that, over those of the even surface: one thread, medians."""

import json
import os
import statistics
import tempfile
import time

import numpy as np
from vtkmodules.vtkCommonCore import mutable
from vtkmodules.vtkCommonDataModel import vtkStaticCellLocator
from vtkmodules.vtkFiltersCore import vtkFlyingEdges3D, vtkQuadricDecimation
from vtkmodules.vtkImagingCore import vtkImageCast, vtkImageConstantPad, vtkImageResample
from vtkmodules.vtkIOXML import vtkXMLImageDataReader, vtkXMLPolyDataReader

from complexes import arrays_of, judged, surface_of, write
from tables import Figures, finish, print_figures, print_targets, ratio, say, timed

COLUMNS = {
    "Vertices": "vertices", "Fewer": "even / this", "Within": "within, share", "Largest": "largest",
    "RatioMean": "radius ratio", "Ratio01": "1 %", "RatioLeast": "min",
    "Intersections": "intersections", "Outside": "outside", "Missing": "missing, share",
    "Time": "time"}


def add_options(parser):
    parser.add_argument("volume", help=".vti")
    parser.add_argument("--iso", required=True)
    parser.add_argument("--volumic", default="volumic", metavar="PROGRAM")
    parser.add_argument("--judge", default="JudgeFiles", help="the program JudgeFiles")
    parser.add_argument("--tolerances", default=".1,.2", metavar="LIST", help="(.1,.2)")
    parser.add_argument("--thin", action="store_true")
    parser.add_argument("--points", type=int, default=20000, help="of each surface (20000)")
    parser.add_argument("--repetitions", type=int, default=3, help="(3)")


def read(path, reader):
    reader.SetFileName(path)
    reader.Update()
    return reader.GetOutput()


class IsoSurface:
    """VTK's: that of the voxels themselves cuts corners, on noise by more than a tenth of one."""

    def __init__(self, image, iso):
        pad, cast = vtkImageConstantPad(), vtkImageCast()
        pad.SetInputData(image)
        pad.SetConstant(image.GetScalarRange()[0])
        pad.SetOutputWholeExtent(*(e + (1 if i % 2 else -1)
                                   for i, e in enumerate(image.GetExtent())))
        cast.SetInputConnection(pad.GetOutputPort())
        cast.SetOutputScalarTypeToFloat()
        resample, contour = vtkImageResample(), vtkFlyingEdges3D()
        resample.SetInputConnection(cast.GetOutputPort())
        for axis in range(3):
            resample.SetAxisMagnificationFactor(axis, 2)
        contour.SetInputConnection(resample.GetOutputPort())
        contour.SetValue(0, iso)
        contour.ComputeNormalsOff()
        contour.Update()
        self._locator = vtkStaticCellLocator()
        self._locator.SetDataSet(contour.GetOutput())
        self._locator.BuildLocator()

    def distances(self, surface, number):
        """From random points of the triangles, evenly by area."""
        points, triangles = arrays_of(surface)
        a, b, c = (points[triangles[:, corner]] for corner in range(3))
        areas = np.linalg.norm(np.cross(b - a, c - a), axis=1)
        rng = np.random.default_rng(1)
        chosen = rng.choice(len(areas), number, p=areas / areas.sum())
        u, v = np.sort(rng.random((2, number, 1)), axis=0)
        places = u * a[chosen] + (v - u) * b[chosen] + (1 - v) * c[chosen]
        closest, cell, part, squared = [0.] * 3, mutable(0), mutable(0), mutable(0.)
        found = np.empty(number)
        for i, place in enumerate(places):
            self._locator.FindClosestPoint(place, closest, cell, part, squared)
            found[i] = squared.get()
        return np.sqrt(found)


def decimated(even, path, vertices):
    """Processor seconds."""
    start = time.process_time()
    decimation = vtkQuadricDecimation()
    decimation.SetInputData(surface_of(*arrays_of(even)))
    decimation.SetTargetReduction(1 - vertices / even.GetNumberOfPoints())
    decimation.Update()
    seconds = time.process_time() - start
    write(surface_of(*arrays_of(decimation.GetOutput())), path)
    return seconds


def measure(options):
    image = read(options.volume, vtkXMLImageDataReader())
    unit, reference = min(image.GetSpacing()), IsoSurface(image, float(options.iso))
    tolerances = [float(word) for word in options.tolerances.split(",")]
    asked = {"even": [], **{f"graded {tolerance:g}": ["--tolerance", tolerance * unit]
                            for tolerance in tolerances}}
    if options.thin:
        asked.update({"thin parts": ["--thin-parts"], "level -1": ["--finest", -1]})
    seconds = {name: [] for name in asked}
    runs = {}
    with tempfile.TemporaryDirectory() as folder:
        def path(name, ending="vtp"):
            return os.path.join(folder, f"{name}.{ending}")

        def figures_of(name, tolerance):
            surface = read(path(name), vtkXMLPolyDataReader())
            told = judged(options.judge, path(name))
            distances = reference.distances(surface, options.points) / unit
            return Figures(
                Vertices=told["points"], Largest=distances.max(), RatioMean=told["ratio"],
                Ratio01=told["ratio01"], RatioLeast=told["ratiomin"],
                Intersections=told["intersections"], Outside=told["short"] + told["long"],
                Wrong=3 - told["closed"] - told["manifold"] - told["oriented"],
                Within=(distances <= tolerance).mean())
        for _ in range(options.repetitions):
            for name, words in asked.items():
                say(f"{options.volume}: {name}")
                seconds[name].append(timed(
                    options.volumic, options.volume, path(name), "--iso", options.iso, "--threads",
                    1, "--quiet", "--report", path(name, "json"), *words, *options.rest)[1])
        for name in asked:
            tolerance = float(name.split()[1]) if name.startswith("graded") else tolerances[-1]
            runs[name] = figures_of(name, tolerance)
            runs[name]["Seconds"] = statistics.median(seconds[name])
            with open(path(name, "json"), encoding="utf-8") as file:
                runs[name]["Missing"] = json.load(file).get("missing_boundary") or 0.
        even = read(path("even"), vtkXMLPolyDataReader())
        for tolerance in tolerances:
            name = f"decimated {tolerance:g}"
            spent = decimated(even, path(name), runs[f"graded {tolerance:g}"]["Vertices"])
            runs[name] = figures_of(name, tolerance)
            runs[name]["Seconds"] = runs["even"]["Seconds"] + spent
    for figures in runs.values():
        figures["Fewer"] = ratio(runs["even"]["Vertices"], figures["Vertices"])
        figures["Time"] = ratio(figures["Seconds"], runs["even"]["Seconds"])
    print(f"{options.volume}, iso-value {options.iso}; even within {tolerances[-1]:g}:\n")
    print_figures(COLUMNS, list(runs.items()))
    print_targets([row for tolerance in tolerances for row in target_rows(
        tolerance, runs[f"graded {tolerance:g}"])])
    return finish(options.csv, list(runs.items()))


def target_rows(tolerance, graded):
    return [(f"{tolerance:g}", what, graded[figure], relation, limit)
            for what, figure, relation, limit in (
                ("points within the tolerance", "Within", ">=", .99),
                ("time, graded / even", "Time", "<=", 1.3),
                ("self-intersections", "Intersections", "<=", 0),
                ("open, not manifold, not oriented", "Wrong", "<=", 0),
                ("edges outside [1, 2.5] delta", "Outside", "<=", 0),
                ("radius ratio mean", "RatioMean", ">=", .95))]
