# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Pictures of the surfaces from vtkDeformableSurface: a row of levels, and views of the finest."""

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkIdList
from vtkmodules.vtkCommonDataModel import vtkPlane, vtkPlaneCollection
from vtkmodules.vtkCommonMath import vtkMatrix4x4
from vtkmodules.vtkCommonTransforms import vtkMatrixToLinearTransform
from vtkmodules.vtkFiltersCore import (
    vtkCleanPolyData, vtkCutter, vtkPolyDataConnectivityFilter, vtkPolyDataNormals)
from vtkmodules.vtkFiltersGeneral import vtkClipClosedSurface, vtkTransformPolyDataFilter

import render
from pyramid_picture import THREE_QUARTERS, grey_window, index_bounds
from terminal import warnings_only
from volume_image import world_axes

LEVEL_WIDTH, VIEW_WIDTH = 400, 480
CONTOUR = (1.0, 0.55, 0.16)
VIEWS_OF_A_BODY = (("From the front", "From the side", "From below"),
                   ("Cut open, from the side", "Cut open, from above", "The triangles"),
                   ("Axial", "Coronal", "Sagittal"))
VIEWS_OF_A_BOX = (("Along y", "Along x", "Along z"),
                  ("Cut open, along x", "Cut open, along z", "The triangles"),
                  ("Across z", "Across y", "Across x"))
MAIN_SHARE = 0.5  # of the area
EDGES_WIDTH = 36  # mean edges across the close view of the mesh


def field_value(surface, name):
    """A number of the surface's field data."""
    return surface.GetFieldData().GetArray(name).GetTuple1(0)


def plural(count, noun):
    return f"{count:,.0f} {noun}{'' if count == 1 else 's'}"


def visited_levels(levels):
    """(number, surface) of the blocks that hold a surface, coarsest first; the last may be -1."""
    blocks = [levels.GetBlock(b) for b in range(levels.GetNumberOfBlocks())]
    visited = [(int(field_value(block, "Level")), block) for block in blocks
               if block is not None and block.GetNumberOfPolys() > 0]
    return sorted(visited, key=lambda entry: -entry[0])


def levels_picture(levels, frame, title):
    """A row with the surface of every visited level from one camera; see render.py for frames."""
    surfaces = visited_levels(levels)
    row, captions = surface_row([(f"Level {number}", surface) for number, surface in surfaces],
                                frame, surfaces[-1][1].GetBounds())
    return render.compose([row], [captions], title)


def surface_row(surfaces, frame, bounds, width=LEVEL_WIDTH, zoom=1.1):
    """Panels and captions, for render.compose, of (name, surface) from one camera.

    With a zoom of 1 the corners of the bounds are in the picture; bodies don't reach them.
    """
    height = render.fitting_height(width, frame, *THREE_QUARTERS, bounds)
    row, captions = [], []
    for name, surface in surfaces:
        row.append(render.draw([render.surface_actor(surface)], (width, height), frame,
                               *THREE_QUARTERS, bounds, zoom=zoom))
        captions.append((name, f"{surface.GetNumberOfPoints():,} vertices",
                         f"{plural(field_value(surface, 'NumberOfComponents'), 'component')},"
                         f" genus {field_value(surface, 'Genus'):.0f}"))
    return row, captions


def views_picture(surface, image, iso, title):
    """The finest surface from three sides, cut open, close by, and on slices of the image.

    Where one component makes up most of the surface, such as a skull beside the head rest, the
    views in space show it alone.
    """
    frame = render.world_frame(image)
    shown, heading = main_component(surface)
    rows = [outside_views(shown, frame), inside_views(shown, frame),
            slices_with_contour(surface, image, iso)]
    names = VIEWS_OF_A_BOX if world_axes(image) is None else VIEWS_OF_A_BODY
    captions = [[(name,) for name in row] for row in names]
    return render.compose(rows, captions, title, [heading, None, None])


def main_component(surface):
    """The component of more than half the area, or else the surface; and what to call it."""
    count = int(field_value(surface, "NumberOfComponents"))
    areas = vtk_to_numpy(surface.GetFieldData().GetArray("ComponentArea"))
    if count == 1 or areas[0] < MAIN_SHARE * areas.sum():
        return surface, f"All of the {count} components" if count > 1 else None
    points = vtkIdList()
    first = int(np.flatnonzero(
        vtk_to_numpy(surface.GetCellData().GetArray("Component")) == 0)[0])
    surface.GetCellPoints(first, points)
    connected = vtkPolyDataConnectivityFilter()
    connected.SetInputData(surface)
    connected.SetExtractionModeToPointSeededRegions()
    connected.AddSeed(points.GetId(0))
    clean = vtkCleanPolyData()
    clean.SetInputConnection(connected.GetOutputPort())
    clean.PointMergingOff()
    clean.Update()
    return clean.GetOutput(), f"The largest of {count} components"


def common_height(frame, views, bounds, width=VIEW_WIDTH):
    """Height of the panels of a row, in which every view fits."""
    return max(render.fitting_height(width, frame, look_from, up, bounds)
               for look_from, up in views)


def outside_views(surface, frame):
    views = (("A", "S"), ("L", "S"), ("I", "A"))
    bounds = surface.GetBounds()
    size = VIEW_WIDTH, common_height(frame, views, bounds)
    actor = render.surface_actor(surface)
    return [render.draw([actor], size, frame, *view, bounds) for view in views]


def inside_views(surface, frame):
    """Right half from inside, lower half from above, and some triangles of the front."""
    views = (("L", "S"), ("S", "A"))
    bounds = surface.GetBounds()
    centre = np.reshape(bounds, (3, 2)).mean(axis=1)
    size = VIEW_WIDTH, common_height(frame, views, bounds)
    panels = []
    for look_from, up in views:
        actor = cut_open(surface, centre, -frame.vector(look_from))
        panels.append(render.draw([actor], size, frame, look_from, up, bounds))
    panels.append(close_view(surface, frame, size))
    return panels


def cut_open(surface, point, keep_towards):
    """Actor of what lies beyond the point in that direction, closed by coloured faces."""
    plane = vtkPlane()
    plane.SetOrigin(point)
    plane.SetNormal(keep_towards)
    planes = vtkPlaneCollection()
    planes.AddItem(plane)
    clip = vtkClipClosedSurface()
    clip.SetInputData(surface)
    clip.SetClippingPlanes(planes)
    clip.SetScalarModeToColors()
    clip.SetBaseColor(render.BONE)
    clip.SetClipColor(render.CUT_FACE)
    # The clip drops the normals; smooth ones, but not across the rims of the cut.
    normals = vtkPolyDataNormals()
    normals.SetInputConnection(clip.GetOutputPort())
    normals.SetFeatureAngle(40)
    normals.ConsistencyOff()
    normals.Update()
    actor = render.surface_actor(normals.GetOutput())
    actor.GetMapper().ScalarVisibilityOn()
    actor.GetMapper().SetScalarModeToUseCellData()
    return actor


def close_view(surface, frame, size, towards="AAAL", place=(.5, .5, .5), delta=None):
    """The triangles at a place, by its share of the bounds along each axis, with their edges.

    So many as fit of an even surface with that delta, by default its own."""
    bounds = surface.GetBounds()
    # A legal mesh's edges are 1 to 2.5 delta long, and 1.6 delta in the mean.
    width = EDGES_WIDTH * 1.6 * (delta or field_value(surface, "Delta"))
    low, high = np.reshape(bounds, (3, 2)).T
    centre = low + np.array(place) * (high - low)
    half_width, half_height = render.projected(*(frame.vector(c) for c in "AS"), bounds)
    whole = 2 * max(half_width, half_height * size[0] / size[1])
    return render.draw([render.surface_actor(surface, edges=True)], size, frame, towards, "S",
                       bounds, zoom=max(1.0, whole / width), focus=centre)


def slices_with_contour(surface, image, iso):
    """The middle slices across the three axes with the line where the surface cuts them."""
    frame, bounds = render.index_frame(image), index_bounds(image)
    window = grey_window(image, iso)
    flat = to_index_space(surface, image)
    views = (("I", "A"), ("A", "S"), ("L", "S"))
    size = VIEW_WIDTH, common_height(frame, views, bounds)
    return [slice_with_contour(flat, image, frame, view, window, size, bounds) for view in views]


def slice_with_contour(flat, image, frame, view, window, size, bounds):
    towards = frame.vector(view[0])
    axis = int(np.argmax(np.abs(towards)))
    index = image.GetDimensions()[axis] // 2
    plane = vtkPlane()
    plane.SetNormal(towards)
    place = np.zeros(3)
    place[axis] = index * image.GetSpacing()[axis]
    plane.SetOrigin(place)
    cutter = vtkCutter()
    cutter.SetInputData(flat)
    cutter.SetCutFunction(plane)
    with warnings_only():  # VTK 9.3's tells of each run
        cutter.Update()
    lines = render.line_actor(cutter.GetOutput(), CONTOUR, 1.6)
    lines.SetPosition(towards * image.GetSpacing()[axis])  # in front of the slice
    actors = [render.slice_actor(image, axis, index, window), lines]
    return render.draw(actors, size, frame, *view, bounds, shaded=False)


def to_index_space(surface, image):
    """The surface in the coordinates of render.slice_actor."""
    matrix = vtkMatrix4x4()
    matrix.DeepCopy(image.GetPhysicalToIndexMatrix())
    scale = vtkMatrix4x4()
    for axis in range(3):
        spacing = image.GetSpacing()[axis]
        scale.SetElement(axis, axis, spacing)
        scale.SetElement(axis, 3, -image.GetExtent()[2 * axis] * spacing)
    vtkMatrix4x4.Multiply4x4(scale, matrix, matrix)
    transform = vtkMatrixToLinearTransform()
    transform.SetInput(matrix)
    move = vtkTransformPolyDataFilter()
    move.SetInputData(surface)
    move.SetTransform(transform)
    move.Update()
    return move.GetOutput()
