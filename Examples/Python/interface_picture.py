# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The picture of labels that share their interfaces: grains of a made crystal."""

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonDataModel import vtkImageData, vtkPolyData
from volumic import vtkLabelsToSurfaces

import render

SIZE = 32  # voxels along each axis
GRAINS = 20
TAKEN_AWAY = 6  # those nearest to who looks
LINES = 0.1, 0.1, 0.1


def grains():
    """A label map: each voxel is of the nearest of some points by chance."""
    points = np.random.default_rng(3).random((GRAINS, 3)) * SIZE
    places = np.moveaxis(np.indices((SIZE, SIZE, SIZE)), 0, -1)[..., np.newaxis, :]
    labels = 1 + ((places - points) ** 2).sum(axis=-1).argmin(axis=-1)
    image = vtkImageData()
    image.SetDimensions(SIZE, SIZE, SIZE)
    array = numpy_to_vtk(labels.astype(np.int32).ravel(), deep=True)
    array.SetName("Labels")
    image.GetPointData().SetScalars(array)
    return image


def lines_of(mesh):
    """Where three labels and more meet."""
    lines = vtkPolyData()
    lines.SetPoints(mesh.GetPoints())
    lines.SetLines(mesh.GetLines())
    return lines


def interface_picture(width):
    """Two panels, each so many pixels wide: all grains, and what those in front have hidden."""
    image = grains()
    frame = render.world_frame(image)
    surfaces = vtkLabelsToSurfaces()
    surfaces.SetInputData(image)
    surfaces.SharedInterfacesOn()
    surfaces.Update()
    blocks = [surfaces.GetOutput().GetBlock(block)
              for block in range(surfaces.GetOutput().GetNumberOfBlocks())]
    towards = frame.vector("LLAS")
    blocks.sort(key=lambda block: np.dot(block.GetCenter(), towards))
    mesh = surfaces.GetInterfaces()
    panels = []
    for shown in (blocks, blocks[:-TAKEN_AWAY]):
        actors = [render.surface_actor(
            block, block.GetFieldData().GetArray("LabelColor").GetTuple3(0), edges=True)
            for block in shown]
        actors.append(render.line_actor(lines_of(mesh), LINES, 2.5))
        panels.append(render.draw(actors, (width, width * 3 // 4), frame, "LLAS", "S",
                                  mesh.GetBounds()))
    return render.compose([panels], [[
        (f"{GRAINS} labels, one mesh of {mesh.GetNumberOfPolys()} triangles",),
        ("without those in front: each interface is there once",)]])
