# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The picture of a label map: all surfaces, and some of them beside what else VTK makes."""

import numpy as np
from vtkmodules.vtkFiltersCore import vtkWindowedSincPolyDataFilter
from vtkmodules.vtkFiltersGeneral import vtkDiscreteFlyingEdges3D
from volumic import vtkLabelsToSurfaces

import render
from read_volume import read_volume
from terminal import warnings_only

CLOSE_LABELS = (1, 3, 4, 5)  # of the atlas of white matter: corpus callosum and middle peduncle


def surfaces_of(image, labels=()):
    """(surface, colour) of each label that has a surface."""
    surfaces = vtkLabelsToSurfaces()
    surfaces.SetInputData(image)
    for label in labels:
        surfaces.AddLabel(label)
    with warnings_only():
        surfaces.Update()
    blocks = [surfaces.GetOutput().GetBlock(b)
              for b in range(surfaces.GetOutput().GetNumberOfBlocks())]
    return [(block, block.GetFieldData().GetArray("LabelColor").GetTuple3(0))
            for block in blocks if block.GetNumberOfPolys() > 0]


def stairs_of(image, label, smoothed):
    """What vtkDiscreteFlyingEdges3D makes of a label, smoothed with VTK's defaults or not."""
    contour = vtkDiscreteFlyingEdges3D()
    contour.SetInputData(image)
    contour.SetValue(0, label)
    contour.Update()
    if not smoothed:
        return contour.GetOutput()
    smooth = vtkWindowedSincPolyDataFilter()
    smooth.SetInputData(contour.GetOutput())
    smooth.Update()
    return smooth.GetOutput()


def label_picture(path, width, close_labels=CLOSE_LABELS):
    """Four panels, each so many pixels wide."""
    image = read_volume(path)
    frame = render.world_frame(image)
    everything = surfaces_of(image)
    near = surfaces_of(image, close_labels)
    colors = [color for _, color in near]
    rows = [everything,
            [(stairs_of(image, label, False), color)
             for label, color in zip(close_labels, colors)],
            [(stairs_of(image, label, True), color)
             for label, color in zip(close_labels, colors)],
            near]
    panels = []
    for number, surfaces in enumerate(rows):
        shown = surfaces if number == 0 else near
        bounds = np.array([surface.GetBounds() for surface, _ in shown])
        bounds = np.ravel([bounds[:, ::2].min(axis=0), bounds[:, 1::2].max(axis=0)], order="F")
        actors = [render.surface_actor(surface, color) for surface, color in surfaces]
        for actor in actors:
            actor.GetProperty().SetInterpolationToFlat()  # Triangles as they are.
        panels.append(render.draw(actors, (width, width), frame, "LLAS", "S", bounds, zoom=1.05))
    captions = [(f"All {len(everything)} labels", "vtkLabelsToSurfaces"),
                ("Four of them", "vtkDiscreteFlyingEdges3D"),
                ("smoothed", "vtkWindowedSincPolyDataFilter"), ("and here", "vtkLabelsToSurfaces")]
    return render.compose([panels], [captions])
