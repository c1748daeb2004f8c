# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The mesh of all labels of a map: vtkLabelsToSurfaces (us), vtkSurfaceNets3D (nets, VTK 9.3) and
vtkDiscreteFlyingEdges3D with vtkWindowedSincPolyDataFilter (windowed). `graded` is vtkLabelsToSurfaces
with a Tolerance of a fifth of a voxel. Requires Volumic's Python package.

s         processor seconds of one thread, median
time      s relative to windowed
crossing  pairs of triangles that intersect outside their common corners and edges
open      edges where the boundary of a label is not closed, oriented and manifold
vol %     largest volume error of a label of more than 1000 voxels
q, angle  mean radius ratio; least angle of a triangle, degrees
distance  mean distance of triangles to the true planes between grains, voxels
rough     angle between consecutive segments of a junction line, 95 % quantile"""

import math
import os
import statistics
import time

import numpy as np
from vtkmodules import vtkFiltersCore
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkFiltersGeneral import vtkDiscreteFlyingEdges3D
from vtkmodules.vtkIOImage import vtkNIFTIImageReader
from vtkmodules.vtkIOXML import vtkXMLImageDataReader
from volumic import vtkLabelsToSurfaces

from complexes import (
    BACKGROUND, Complex, LabelVoxels, arrays_of, complex_of_output, complex_of_twins, figures_of,
    volume_of)
from tables import Figures, finish, print_figures, print_targets, ratio, say

COLUMNS = {
    "Seconds": "s", "Time": "time", "Vertices": "vertices", "PerSecond": "triangles / s",
    "Intersections": "crossing", "WrongEdges": "open",
    "LostLabels": "no surface", "VolumeLargest": "vol %", "RatioMean": "q", "AngleLeast": "angle",
    "Truth": "distance", "Roughness": "rough"}
TEMPLATES = "/usr/share/mricron/templates"


def add_options(parser):
    parser.add_argument("--judge", default="JudgeFiles", help="path of the program JudgeFiles")
    parser.add_argument("--maps", default="polycrystal,tooth,slices,aal,JHU", metavar="LIST",
                        help="polycrystal, tooth, slices, aal, JHU (Debian's mricron-data)")
    parser.add_argument("--runs", default=",".join(runs_here()), metavar="LIST", help="(%(default)s)")
    parser.add_argument("--threads", type=int, default=1, help="of us; from 2 on `s` is elapsed time")
    parser.add_argument("--repetitions", type=int, default=1)


# ---- Maps ----------------------------------------------------------------------------------------

def read(path):
    """Read a .vti or NIfTI file with its voxel distances; the first voxel is at 0."""
    reader = vtkXMLImageDataReader() if path.endswith(".vti") else vtkNIFTIImageReader()
    reader.SetFileName(path)
    reader.Update()
    image = reader.GetOutput()
    values = vtk_to_numpy(image.GetPointData().GetScalars())
    return LabelVoxels(values.reshape(image.GetDimensions()[::-1]).astype(np.int16),
                       image.GetSpacing())


def polycrystal(size, grains):
    """Return the Voronoi cells of random points; there is no background."""
    centers = np.random.default_rng(34).random((grains, 3)) * (size - 1)
    at = np.arange(size, dtype=float)
    nearest = np.full((size, ) * 3, np.inf)
    values = np.zeros(nearest.shape, np.int16)
    for grain, (x, y, z) in enumerate(centers, 1):
        squared = (((at - z) ** 2)[:, None, None] + ((at - y) ** 2)[None, :, None]
                   + ((at - x) ** 2)[None, None, :])
        values[squared < nearest] = grain
        np.minimum(nearest, squared, out=nearest)
    voxels = LabelVoxels(values)
    voxels.centers = centers
    return voxels


def distance_to_truth(shape, voxels):
    """Return the mean distance of triangle centres to the planes between grains."""
    if not hasattr(voxels, "centers"):
        return math.nan
    inner = (shape.sides != BACKGROUND).all(axis=1)
    middles = shape.points[shape.triangles[inner]].mean(axis=1)
    first, second = (voxels.centers[shape.sides[inner, side] - 1] for side in (0, 1))
    differences = ((middles - first) ** 2).sum(axis=1) - ((middles - second) ** 2).sum(axis=1)
    return np.mean(np.abs(differences) / (2 * np.linalg.norm(first - second, axis=1)))


def tooth(size, step=1):
    """Return pulp (1) in dentin (2) and enamel (3) on the crown, cut by an oblique plane, so that all
    three meet the background there. step: keep one of so many slices."""
    z, y, x = np.mgrid[:size, :size, :size] / (size - 1) * 2 - 1
    # Narrower towards the root, which is at the bottom.
    around = np.hypot(x + .03, y - .02) / (.62 + .3 * z)

    def within(half_width, root, crown):
        middle, half_height = (crown + root) / 2, (crown - root) / 2
        return (around / half_width) ** 2 + ((z - middle) / half_height) ** 2 < 1
    values = np.zeros(x.shape, np.int16)
    values[within(.93, -.4, .85) & (z > .02 + .1 * x)] = 3
    values[within(.75, -.88, .7)] = 2
    values[within(.33, -.75, .35)] = 1
    values[y + .1 * x + .07 * z > .06] = 0
    return LabelVoxels(values[::step], (1, 1, step))


def template(name):
    """Return a map of Debian's mricron-data; None if that is not installed."""
    path = os.path.join(TEMPLATES, f"{name}.nii.gz")
    return read(path) if os.path.exists(path) else None


def named_maps():
    """Return {name: function that makes the map}."""
    return {
        "polycrystal": lambda: polycrystal(128, 60),
        "tooth": lambda: tooth(128),
        "slices": lambda: tooth(128, 2),
        "aal": lambda: template("aal"),
        "JHU": lambda: template("JHU-WhiteMatter-labels-1mm")}


# ---- Runs ----------------------------------------------------------------------------------------

def image_of(voxels, margin=0):
    """Return a vtkImageData with `margin` layers of background around it."""
    values = np.pad(voxels.values, margin, constant_values=BACKGROUND)
    image = vtkImageData()
    image.SetDimensions(*values.shape[::-1])
    image.SetSpacing(*voxels.spacing)
    image.SetOrigin(*(-margin * voxels.spacing))
    image.GetPointData().SetScalars(numpy_to_vtk(values.ravel(), deep=True))
    return image


def run(image, *filters, threads=1):
    """Run a pipeline; return processor seconds for one thread, else elapsed seconds."""
    filters[0].SetInputDataObject(image)
    for first, second in zip(filters, filters[1:]):
        second.SetInputConnection(first.GetOutputPort())
    clock = time.process_time if threads == 1 else time.perf_counter
    start = clock()
    filters[-1].Update()
    return clock() - start


def ours(voxels, threads, tolerance=0.):
    """tolerance: in units of the smallest voxel distance"""
    surfaces = vtkLabelsToSurfaces()
    surfaces.SetTolerance(tolerance * min(voxels.spacing))
    surfaces.SetNumberOfThreads(threads)
    seconds = run(image_of(voxels), surfaces, threads=threads)
    if surfaces.GetErrorCode():
        raise RuntimeError("vtkLabelsToSurfaces failed; see its error message above")
    return seconds, complex_of_output(surfaces.GetOutputDataObject(1))


def windowed(voxels):
    """Run vtkDiscreteFlyingEdges3D on all labels, merge points, and smooth with the defaults of
    vtkWindowedSincPolyDataFilter, except those that would separate labels."""
    edges, merge = vtkDiscreteFlyingEdges3D(), vtkFiltersCore.vtkCleanPolyData()
    smooth = vtkFiltersCore.vtkWindowedSincPolyDataFilter()
    for number, label in enumerate(voxels.counts):
        edges.SetValue(number, label)
    edges.ComputeNormalsOff()
    smooth.BoundarySmoothingOff()
    smooth.FeatureEdgeSmoothingOff()
    smooth.NonManifoldSmoothingOn()
    smooth.NormalizeCoordinatesOn()
    seconds = run(image_of(voxels, 1), edges, merge, smooth)
    points, triangles = arrays_of(smooth.GetOutput())
    label_of_point = vtk_to_numpy(edges.GetOutput().GetPointData().GetScalars())
    labels = label_of_point[arrays_of(edges.GetOutput())[1][:, 0]].astype(int)
    if volume_of(points, triangles) < 0:
        triangles = triangles[:, ::-1]
    return seconds, complex_of_twins(points, triangles, labels)


def sides_by_voxels(surface, voxels):
    """Return the labels behind and in front of triangles, each of which is half of a voxel face."""
    points, triangles = arrays_of(surface)
    corners = points[triangles] / voxels.spacing
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    across = .5 * normal / np.linalg.norm(normal, axis=1, keepdims=True)
    values = np.pad(voxels.values, 1, constant_values=BACKGROUND)
    both = corners.mean(axis=1)[:, None] + np.stack([-across, across], axis=1)
    x, y, z = np.moveaxis(np.rint(both).astype(int) + 1, 2, 0)
    return values[z, y, x]


def nets(voxels):
    """Run vtkSurfaceNets3D on all labels, with its smoothing. Its output does not state which label is
    behind a triangle; this is found from the voxels, with the triangles before smoothing."""
    surfaces = vtkFiltersCore.vtkSurfaceNets3D()
    for number, label in enumerate(voxels.counts):
        surfaces.SetValue(number, label)
    surfaces.SetOutputMeshTypeToTriangles()
    seconds = run(image_of(voxels, 1), surfaces)
    points, triangles = arrays_of(surfaces.GetOutput())
    surfaces.SmoothingOff()
    surfaces.Update()
    return seconds, Complex(points, triangles, sides_by_voxels(surfaces.GetOutput(), voxels))


def runs_here(threads=1):
    """Return {name: function} of the filters that this VTK has."""
    return {"us": lambda voxels: ours(voxels, threads),
            "graded": lambda voxels: ours(voxels, threads, .2),
            **({"nets": nets} if hasattr(vtkFiltersCore, "vtkSurfaceNets3D") else {}),
            "windowed": windowed}


def measure_map(options, name, voxels):
    """Return {run: figures}; repetitions are made in turns."""
    runs = {run: runs_here(options.threads)[run] for run in options.runs.split(",")}
    made = {run: [] for run in runs}
    for _ in range(options.repetitions):
        for run_name, function in runs.items():
            say(f"{name}: {run_name}")
            try:
                made[run_name].append(function(voxels))
            except RuntimeError as error:
                made[run_name] = None
                say(str(error))
    measured = {}
    for run_name, repetitions in made.items():
        measured[run_name] = Figures(Failure="see the error message above")
        if repetitions:
            seconds = statistics.median(each[0] for each in repetitions)
            figures = Figures(figures_of(repetitions[-1][1], voxels, options.judge), Seconds=seconds)
            figures["PerSecond"] = figures["Triangles"] / seconds
            figures["Truth"] = distance_to_truth(repetitions[-1][1], voxels)
            measured[run_name] = figures
    for figures in measured.values():
        figures["Time"] = ratio(figures["Seconds"], measured.get("windowed", Figures())["Seconds"])
    return measured


def target_rows(name, measured):
    us, nets = (measured.get(run, Figures()) for run in ("us", "nets"))
    return [(name, COLUMNS.get(figure, figure), us[figure], relation, limit)
            for figure, relation, limit in (
                ("Intersections", "<=", 0), ("Flat", "<=", 0), ("WrongEdges", "<=", 0),
                ("LostLabels", "<=", 0), ("VolumeLargest", "<=", .2), ("RatioMean", ">=", .94),
                ("AngleLeast", ">=", 20), ("PerSecond", ">=", 60000), ("Roughness", "<=", nets["Roughness"]))
            if not math.isnan(limit)]


def measure(options):
    if "nets" not in runs_here():
        print("vtkSurfaceNets3D is skipped: it requires VTK 9.3 (Debian 13).")
    all_runs, targets = [], []
    for name in options.maps.split(","):
        voxels = named_maps()[name]()
        if voxels is None:
            print(f"{name} is skipped: install Debian's package mricron-data.")
            continue
        measured = measure_map(options, name, voxels)
        print(f"\n{name}: {' x '.join(map(str, voxels.values.shape[::-1]))} voxels, "
              f"{len(voxels.counts)} labels:\n")
        print_figures(COLUMNS, list(measured.items()))
        all_runs += [(f"{name}, {run_name}", figures) for run_name, figures in measured.items()]
        targets += target_rows(name, measured)
    print_targets(targets)
    return finish(options.csv, all_runs)
