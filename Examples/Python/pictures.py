#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Draw pictures of a run of the command `volumic` from its output files, as quickstart.sh does.

    pictures.py VOLUME FOLDER

FOLDER contains report.json, levels.vtm, surface.vtp and history.csv. The script writes

    pyramid.vtm, pyramid.png   image pyramid; slices and isosurfaces of its levels
    levels.png                 surface of each level
    surface-views.png          final surface from several sides, cut open, and on slices
    history.png                four curves of the evolution
"""

import json
import os
import sys

import numpy as np
import render
import volumic
from history_chart import history_chart, read_history
from volumic.arrays import make_image
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkIdList, vtkLogger
from vtkmodules.vtkCommonDataModel import vtkPlane, vtkPlaneCollection
from vtkmodules.vtkCommonMath import vtkMatrix4x4
from vtkmodules.vtkCommonTransforms import vtkMatrixToLinearTransform
from vtkmodules.vtkFiltersCore import (
    vtkCleanPolyData, vtkCutter, vtkFlyingEdges3D, vtkPolyDataConnectivityFilter,
    vtkPolyDataNormals)
from vtkmodules.vtkFiltersGeneral import vtkClipClosedSurface, vtkTransformPolyDataFilter
from vtkmodules.vtkIOXML import (
    vtkXMLMultiBlockDataReader, vtkXMLMultiBlockDataWriter, vtkXMLPolyDataReader)

WIDTH = 420  # pixels of a panel
CONTOUR = (1.0, 0.55, 0.16)
THREE_QUARTERS = ("AAAALLS", "S")  # views: direction to the camera, up
OUTSIDE = (("A", "S"), ("L", "S"), ("I", "A"))
INSIDE = (("L", "S"), ("S", "A"))
SLICES = (("I", "A"), ("A", "S"), ("L", "S"))
NAMES = (("From the front", "From the side", "From below"),
         ("Cut open, from the side", "Cut open, from above", "The triangles"),
         ("Axial", "Coronal", "Sagittal"))
NAMES_OF_A_BOX = (("Along y", "Along x", "Along z"),
                  ("Cut open, along x", "Cut open, along z", "The triangles"),
                  ("Across z", "Across y", "Across x"))
EDGES_WIDTH = 36  # width of the close-up in mean edge lengths


class Scan:
    """A volume as vtkImageData, the frames of its axes, and its grey value window."""

    def __init__(self, volume, iso):
        self.image = make_image(volume.scalars(), volume.spacing, volume.origin, volume.direction)
        self.iso, self.has_sides = iso, bool(volume.space)
        self.frame = render.Frame(volume.space)  # of the world
        self.indices = self.frame.of_indices(volume.direction)
        voxels = vtk_to_numpy(self.image.GetPointData().GetScalars())
        black, white = np.percentile(voxels[::max(1, voxels.size // 500000)], (1, 99.7))
        white = max(white, iso + 0.35 * (float(voxels.max()) - iso))
        self.window = black, max(white, black + 1e-6 * max(1, abs(black)))

    def bounds(self):
        """Return the bounds of the voxels in the coordinates of render.slice_actor."""
        size, spacing = self.image.GetDimensions(), self.image.GetSpacing()
        return [(side * size[c] - 0.5) * spacing[c] for c in range(3) for side in (0, 1)]

    def slice(self, image, view, size, lines=None):
        """Return a picture of the central slice across the index axis of a view, optionally with
        lines."""
        towards = self.indices.vector(view[0])
        axis = int(np.argmax(np.abs(towards)))
        actors = [render.slice_actor(image, axis, image.GetDimensions()[axis] // 2, self.window)]
        if lines:
            actors.append(render.line_actor(lines, CONTOUR, 1.6))
            actors[1].SetPosition(towards * image.GetSpacing()[axis])  # in front of the slice
        return render.draw(actors, size, self.indices, *view, self.bounds(), shaded=False)


def number(surface, name):
    """Return a number of the field data."""
    return surface.GetFieldData().GetArray(name).GetTuple1(0)


def blocks_of(data):
    return [data.GetBlock(b) for b in range(data.GetNumberOfBlocks())]


# ---- The pyramid -------------------------------------------------------------------------------

def pyramid_picture(pyramid, scan, title, width=WIDTH):
    """Return central slices and isosurfaces of all levels, the coarsest first."""
    levels = blocks_of(pyramid)[::-1]
    rows = []
    for view in SLICES[::2]:
        size = width, render.fitting_height(width, scan.indices, [view], scan.bounds())
        rows.append([scan.slice(image, view, size) for image in levels])
    surfaces = [iso_surface(image, scan.iso) for image in levels]
    bounds = (surfaces[-1] if surfaces[-1].GetNumberOfPoints() else levels[-1]).GetBounds()
    size = width, render.fitting_height(width, scan.frame, [THREE_QUARTERS], bounds)
    rows.append([render.draw([render.surface_actor(surface)], size, scan.frame, *THREE_QUARTERS,
                             bounds, zoom=1.05) for surface in surfaces])
    captions = [(f"Level {number(image, 'Level'):.0f}",
                 f"{' x '.join(map(str, image.GetDimensions()))} voxels,"
                 f" U = {number(image, 'Unit'):.4g}") for image in levels]
    names = ("Axial slices", "Sagittal slices") if scan.has_sides else ("Slices across z",
                                                                        "Slices across x")
    return render.compose(rows, [[], [], captions], title,
                          [*names, f"Isosurfaces at {scan.iso:g}"])


def iso_surface(image, iso):
    """Return an isosurface, which is open at the border of the image."""
    contour = vtkFlyingEdges3D()
    contour.SetInputData(image)
    contour.SetValue(0, iso)
    contour.Update()
    return contour.GetOutput()


# ---- Surfaces ----------------------------------------------------------------------------------

def visited_levels(levels):
    """Return (level, surface) of non-empty blocks, the coarsest first; the last may be level -1."""
    visited = [(int(number(block, "Level")), block) for block in blocks_of(levels)
               if block is not None and block.GetNumberOfPolys() > 0]
    return sorted(visited, key=lambda entry: -entry[0])


def surface_row(surfaces, frame, bounds, width=WIDTH, zoom=1.1):
    """Return panels and captions of (name, surface) from one camera, for render.compose."""
    size = width, render.fitting_height(width, frame, [THREE_QUARTERS], bounds)
    row = [render.draw([render.surface_actor(surface)], size, frame, *THREE_QUARTERS, bounds,
                       zoom=zoom) for _, surface in surfaces]
    captions = [(name, f"{surface.GetNumberOfPoints():,} vertices",
                 f"components {number(surface, 'NumberOfComponents'):.0f},"
                 f" genus {number(surface, 'Genus'):.0f}") for name, surface in surfaces]
    return row, captions


def levels_picture(levels, frame, title):
    """Return a row with the surface of each level from one camera."""
    surfaces = [(f"Level {level}", surface) for level, surface in visited_levels(levels)]
    row, captions = surface_row(surfaces, frame, surfaces[-1][1].GetBounds())
    return render.compose([row], [captions], title)


def views_picture(surface, scan, title):
    """Return the surface from three sides, cut open, in close-up, and on slices of the image.

    If one component has most of the area, the 3D views show only this component.
    """
    shown, heading = main_component(surface)
    bounds, frame = shown.GetBounds(), scan.frame
    size = WIDTH, render.fitting_height(WIDTH, frame, OUTSIDE, bounds)
    rows = [[render.draw([render.surface_actor(shown)], size, frame, *view, bounds)
             for view in OUTSIDE]]
    size = WIDTH, render.fitting_height(WIDTH, frame, INSIDE, bounds)
    rows.append([render.draw([cut_open(shown, -frame.vector(view[0]))], size, frame, *view, bounds)
                 for view in INSIDE] + [close_view(shown, frame, size)])
    size = WIDTH, render.fitting_height(WIDTH, scan.indices, SLICES, scan.bounds())
    rows.append([contour_on_slice(surface, scan, view, size) for view in SLICES])
    names = NAMES if scan.has_sides else NAMES_OF_A_BOX
    return render.compose(rows, [[(name,) for name in row] for row in names], title,
                          [heading, None, None])


def main_component(surface):
    """Return the component with more than half of the area, otherwise the surface, and a
    description."""
    areas = vtk_to_numpy(surface.GetFieldData().GetArray("ComponentArea"))
    if len(areas) == 1 or areas[0] < 0.5 * areas.sum():
        return surface, f"All of the {len(areas)} components" if len(areas) > 1 else None
    points = vtkIdList()
    component = vtk_to_numpy(surface.GetCellData().GetArray("Component"))
    surface.GetCellPoints(int(np.flatnonzero(component == 0)[0]), points)
    connected = vtkPolyDataConnectivityFilter()
    connected.SetInputData(surface)
    connected.SetExtractionModeToPointSeededRegions()
    connected.AddSeed(points.GetId(0))
    clean = vtkCleanPolyData()
    clean.SetInputConnection(connected.GetOutputPort())
    clean.PointMergingOff()
    clean.Update()
    return clean.GetOutput(), f"The largest of {len(areas)} components"


def plane_at(point, normal):
    plane = vtkPlane()
    plane.SetOrigin(point)
    plane.SetNormal(normal)
    return plane


def cut_open(surface, keep_towards):
    """Return an actor of the half of a surface in a direction, closed by coloured faces."""
    planes = vtkPlaneCollection()
    planes.AddItem(plane_at(np.reshape(surface.GetBounds(), (3, 2)).mean(axis=1), keep_towards))
    clip = vtkClipClosedSurface()
    clip.SetInputData(surface)
    clip.SetClippingPlanes(planes)
    clip.SetScalarModeToColors()
    clip.SetBaseColor(render.BONE)
    clip.SetClipColor(render.CUT_FACE)
    # Recompute normals, which the clip removes, with sharp edges at the cut.
    normals = vtkPolyDataNormals()
    normals.SetInputConnection(clip.GetOutputPort())
    normals.SetFeatureAngle(40)
    normals.ConsistencyOff()
    normals.Update()
    actor = render.surface_actor(normals.GetOutput())
    actor.GetMapper().ScalarVisibilityOn()
    actor.GetMapper().SetScalarModeToUseCellData()
    return actor


def close_view(surface, frame, size, towards="AAAL", at=(.5, .5, .5), delta=None):
    """Return a close-up of triangles with edges. at: position relative to the bounds. delta:
    determines the scale (default: that of the surface)."""
    bounds = surface.GetBounds()
    # The mean edge length is 1.6 delta.
    width = EDGES_WIDTH * 1.6 * (delta or number(surface, "Delta"))
    low, high = np.reshape(bounds, (3, 2)).T
    half_width, half_height = render.projected(*(frame.vector(c) for c in "AS"), bounds)
    whole = 2 * max(half_width, half_height * size[0] / size[1])
    focus = low + np.array(at) * (high - low)
    return render.draw([render.surface_actor(surface, edges=True)], size, frame, towards, "S",
                       bounds, zoom=max(1.0, whole / width), focus=focus)


def contour_on_slice(surface, scan, view, size):
    """Return the central slice with the intersection of the surface."""
    image, towards = scan.image, scan.indices.vector(view[0])
    axis = int(np.argmax(np.abs(towards)))
    # World coordinates to coordinates of render.slice_actor.
    matrix, scale = vtkMatrix4x4(), vtkMatrix4x4()
    for c, spacing in enumerate(image.GetSpacing()):
        scale.SetElement(c, c, spacing)
        scale.SetElement(c, 3, -image.GetExtent()[2 * c] * spacing)
    vtkMatrix4x4.Multiply4x4(scale, image.GetPhysicalToIndexMatrix(), matrix)
    transform = vtkMatrixToLinearTransform()
    transform.SetInput(matrix)
    move = vtkTransformPolyDataFilter()
    move.SetInputData(surface)
    move.SetTransform(transform)
    middle = np.where(np.arange(3) == axis, image.GetDimensions()[axis] // 2, 0)
    cutter = vtkCutter()
    cutter.SetInputConnection(move.GetOutputPort())
    cutter.SetCutFunction(plane_at(middle * image.GetSpacing(), towards))
    cutter.Update()
    return scan.slice(image, view, size, cutter.GetOutput())


# ---- Files -------------------------------------------------------------------------------------

def read(reader, path):
    reader.SetFileName(path)
    reader.Update()
    return reader.GetOutput()


def main(path, folder):
    vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_WARNING)  # VTK 9.3 logs every cut
    def file(name):
        return os.path.join(folder, name)
    with open(file("report.json"), encoding="utf-8") as report:
        scan = Scan(volumic.read(path), json.load(report)["iso_value"])
    name = os.path.basename(os.path.normpath(path))
    title = f"{name}, iso-value {scan.iso:g}"
    pyramid = volumic.vtkImagePyramid()
    pyramid.SetInputData(scan.image)
    writer = vtkXMLMultiBlockDataWriter()
    writer.SetInputConnection(pyramid.GetOutputPort())
    writer.SetFileName(file("pyramid.vtm"))
    writer.Write()
    levels = read(vtkXMLMultiBlockDataReader(), file("levels.vtm"))
    surface = read(vtkXMLPolyDataReader(), file("surface.vtp"))
    for picture, pixels in (
            ("pyramid.png", pyramid_picture(pyramid.GetOutput(), scan, name)),
            ("levels.png", levels_picture(levels, scan.frame, title)),
            ("surface-views.png", views_picture(surface, scan, title)),
            ("history.png", history_chart(read_history(file("history.csv"))))):
        render.write_png(pixels, file(picture))


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])
