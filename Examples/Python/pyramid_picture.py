# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The picture of a pyramid: middle slices and iso-surface of every level, coarsest first."""

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkFiltersCore import vtkFlyingEdges3D

import render
from pipeline import level_unit, pyramid_levels
from volume_image import world_axes

PANEL_WIDTH = 400
# Heading (where it is known how the body lies, and where not), camera and upper side of the slices
# of each kind; axial ones as radiologists look at them, from the feet.
SLICES = (("Axial slices", "Slices across z", "I", "A"),
          ("Sagittal slices", "Slices across x", "L", "S"))
THREE_QUARTERS = ("AAAALLS", "S")


def iso_surface(image, iso):
    """Iso-surface of the active scalars, for a picture only: open at the image's border."""
    contour = vtkFlyingEdges3D()
    contour.SetInputData(image)
    contour.SetValue(0, iso)
    contour.ComputeNormalsOn()
    contour.Update()
    return contour.GetOutput()


def world_bounds(image):
    """Bounds of all places of the image, its direction included."""
    bounds = [0.0] * 6
    image.GetBounds(bounds)
    return bounds


def index_bounds(image):
    """Bounds of the whole voxels in the coordinates of render.slice_actor."""
    size, spacing = image.GetDimensions(), image.GetSpacing()
    return [(side * size[c] - 0.5) * spacing[c] for c in range(3) for side in (0, 1)]


def grey_window(image, iso):
    """Values to be shown black and white: nearly all voxels and the iso-value lie between."""
    voxels = vtk_to_numpy(image.GetPointData().GetScalars())
    sample = voxels[:: max(1, voxels.size // 500000)]
    black, white = np.percentile(sample, (1, 99.7))
    white = max(white, iso + 0.35 * (voxels.max() - iso))
    return black, max(white, black + 1e-6 * max(1, abs(black)))


def middle_slice(image, frame, look_from, up, window, size, bounds):
    """The middle slice across the index axis that leads to the camera."""
    axis = int(np.argmax(np.abs(frame.vector(look_from))))
    actor = render.slice_actor(image, axis, image.GetDimensions()[axis] // 2, window)
    return render.draw([actor], size, frame, look_from, up, bounds, shaded=False)


def pyramid_picture(pyramid, iso, title, width=PANEL_WIDTH):
    """Array of pixels; see render.py. A row for each kind of slice and one of iso-surfaces."""
    levels = pyramid_levels(pyramid)[::-1]
    finest = levels[-1]
    frame, window = render.index_frame(finest), grey_window(finest, iso)
    bounds = index_bounds(finest)
    rows = []
    for _, _, look_from, up in SLICES:
        size = width, render.fitting_height(width, frame, look_from, up, bounds)
        rows.append([middle_slice(image, frame, look_from, up, window, size, bounds)
                     for image in levels])

    surfaces = [iso_surface(image, iso) for image in levels]
    frame = render.world_frame(finest)
    box = surfaces[-1].GetBounds() if surfaces[-1].GetNumberOfPoints() else world_bounds(finest)
    size = width, render.fitting_height(width, frame, *THREE_QUARTERS, box)
    rows.append([render.draw([render.surface_actor(surface)], size, frame, *THREE_QUARTERS, box,
                             zoom=1.05) for surface in surfaces])

    captions = [(f"Level {len(levels) - 1 - column}",
                 f"{' x '.join(map(str, image.GetDimensions()))} voxels,"
                 f" U = {level_unit(image):.4g}")
                for column, image in enumerate(levels)]
    headings = [entry[world_axes(finest) is None] for entry in SLICES]
    headings.append(f"Iso-surfaces at {iso:g}")
    return render.compose(rows, [[], [], captions], title, headings)
