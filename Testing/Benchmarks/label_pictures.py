# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Pictures of labels: surfaces of an atlas by Volumic and by VTK, one mesh of grains, and a
tetrahedral mesh cut open."""

import numpy as np
import render
import volumic
from interfaces import image_of, polycrystal
from pictures import blocks_of
from volumic.arrays import make_image
from vtkmodules.vtkCommonDataModel import vtkPlane, vtkPolyData
from vtkmodules.vtkFiltersCore import vtkThreshold, vtkWindowedSincPolyDataFilter
from vtkmodules.vtkFiltersExtraction import vtkExtractGeometry
from vtkmodules.vtkFiltersGeneral import vtkDiscreteFlyingEdges3D
from vtkmodules.vtkFiltersGeometry import vtkGeometryFilter
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

CLOSE_LABELS = (1, 3, 4, 5)  # white matter atlas: corpus callosum, middle cerebellar peduncle
SIZE = 32  # voxels along each axis
GRAINS = 20
REMOVED = 6  # grains nearest to the camera
LINES = 0.1, 0.1, 0.1


def surfaces_of(image, labels=()):
    """Return (surface, colour) of each label that has a surface."""
    surfaces = volumic.vtkLabelsToSurfaces()
    surfaces.SetInputData(image)
    for label in labels:
        surfaces.AddLabel(label)
    surfaces.Update()
    return [(block, color_of(block)) for block in blocks_of(surfaces.GetOutput())
            if block.GetNumberOfPolys() > 0]


def color_of(block):
    return block.GetFieldData().GetArray("LabelColor").GetTuple3(0)


def stairs_of(image, label, smoothed):
    """Run vtkDiscreteFlyingEdges3D on a label; smooth the surface with VTK's defaults if requested."""
    contour = vtkDiscreteFlyingEdges3D()
    contour.SetInputData(image)
    contour.SetValue(0, label)
    last = contour
    if smoothed:
        last = vtkWindowedSincPolyDataFilter()
        last.SetInputConnection(contour.GetOutputPort())
    last.Update()
    return last.GetOutput()


def label_picture(path, width):
    """Draw four panels of this width: all surfaces, and a few labels by three filters."""
    volume = volumic.read(path)
    image = make_image(volume.array, volume.spacing, volume.origin, volume.direction)
    frame = render.Frame(volume.space)
    everything, near = surfaces_of(image), surfaces_of(image, CLOSE_LABELS)
    stairs = [[(stairs_of(image, label, smoothed), color)
               for label, (_, color) in zip(CLOSE_LABELS, near)] for smoothed in (False, True)]
    panels = []
    for surfaces, shown in ((everything, everything), *((row, near) for row in (*stairs, near))):
        bounds = np.array([surface.GetBounds() for surface, _ in shown])
        bounds = np.where([True, False] * 3, bounds.min(axis=0), bounds.max(axis=0))
        actors = [render.surface_actor(surface, color) for surface, color in surfaces]
        for actor in actors:
            actor.GetProperty().SetInterpolationToFlat()  # shows the triangles
        panels.append(render.draw(actors, (width, width), frame, "LLAS", "S", bounds, zoom=1.05))
    captions = [(f"All {len(everything)} labels", "vtkLabelsToSurfaces"),
                ("Four of them", "vtkDiscreteFlyingEdges3D"),
                ("smoothed", "vtkWindowedSincPolyDataFilter"), ("the same", "vtkLabelsToSurfaces")]
    return render.compose([panels], [captions])


def interface_picture(width):
    """Draw two panels of this width: all grains, and all but the nearest ones."""
    surfaces = volumic.vtkLabelsToSurfaces()
    surfaces.SetInputData(image_of(polycrystal(SIZE, GRAINS)))
    surfaces.SetBoxFacesToFlat()
    surfaces.Update()
    frame, mesh = render.Frame(), surfaces.GetInterfaces()
    towards = frame.vector("LLAS")
    blocks = sorted(blocks_of(surfaces.GetOutput()),
                    key=lambda block: np.dot(block.GetCenter(), towards))
    lines = vtkPolyData()  # junction lines
    lines.SetPoints(mesh.GetPoints())
    lines.SetLines(mesh.GetLines())
    panels = [render.draw([*(render.surface_actor(block, color_of(block), edges=True)
                             for block in shown), render.line_actor(lines, LINES, 2.5)],
                          (width, width * 3 // 4), frame, "LLAS", "S", mesh.GetBounds())
              for shown in (blocks, blocks[:-REMOVED])]
    return render.compose([panels], [[
        (f"{GRAINS} labels, one mesh of {mesh.GetNumberOfPolys()} triangles",),
        ("without the front grains: each interface exists once",)]])


def tetrahedra_picture(path, width):
    """Two panels of a .vtu with its labels: the whole mesh, and its tetrahedra behind a plane."""
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(path)
    reader.Update()
    grid, frame = reader.GetOutput(), render.Frame("RAS")
    colors = colors_of(grid)
    half = vtkExtractGeometry()
    half.SetInputData(grid)
    plane = vtkPlane()
    plane.SetOrigin(grid.GetCenter())
    plane.SetNormal(frame.vector("L"))
    half.SetImplicitFunction(plane)
    half.Update()
    panels = []
    for shown in (grid, half.GetOutput()):
        actors = [render.surface_actor(skin_of(shown, label), color, edges=True)
                  for label, color in colors.items()]
        panels.append(render.draw(actors, (width, width * 3 // 4), frame, "LLLAS", "S",
                                  grid.GetBounds(), zoom=1.12))
    return render.compose([panels], [[
        (f"{len(colors)} labels, {grid.GetNumberOfCells()} tetrahedra",), ("cut open",)]])


def colors_of(grid):
    """{label: colour} of the field data."""
    fields = grid.GetFieldData()
    labels, colors = (fields.GetArray(name) for name in ("Label", "LabelColor"))
    return {int(labels.GetTuple1(i)): colors.GetTuple3(i)
            for i in range(labels.GetNumberOfTuples())}


def skin_of(grid, label):
    """The outer faces of the tetrahedra of a label."""
    chosen = vtkThreshold()
    chosen.SetInputData(grid)
    chosen.SetInputArrayToProcess(0, 0, 0, 1, "Label")
    chosen.SetLowerThreshold(label)
    chosen.SetUpperThreshold(label)
    skin = vtkGeometryFilter()
    skin.SetInputConnection(chosen.GetOutputPort())
    skin.Update()
    return skin.GetOutput()
