# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""A scan with the runs on it that figures.py draws and paper_tables.py counts."""

import functools
import os
import sys

import numpy as np
import volumic
from volumic.errors import Failure
from volumic.messages import update
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import reference
from vtkmodules.vtkCommonDataModel import vtkGenericCell, vtkStaticCellLocator
from vtkmodules.vtkCommonTransforms import vtkMatrixToLinearTransform
from vtkmodules.vtkFiltersCore import (
    vtkCleanPolyData, vtkFlyingEdges3D, vtkPolyDataConnectivityFilter)
from vtkmodules.vtkFiltersGeneral import vtkTransformFilter
from vtkmodules.vtkImagingCore import vtkImageConstantPad

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "Examples",
                                "Python"))
import pictures  # pylint: disable=wrong-import-position

SKULL = os.environ.get(
    "VOLUMIC_CRANIUM", "/usr/share/doc/invesalius-examples/examples/Cranium.inv3")
SKULL_ISO = 226.5
PAPERS_COARSEST = 3  # the paper starts at G3, the fourth of its levels
STARTS_ONLY = 10 ** 6  # iterations between snapshots: none but the one at each level's start
LEAST_TRIANGLES = 200  # of a component of the iso-surface that counts as a part of the object


class Scan(pictures.Scan):
    """A volume, its pyramid and the runs on it, each made when it is first used."""

    def __init__(self, path, iso):
        super().__init__(volumic.read(path), iso)
        self.path = path
        self.pyramid = volumic.vtkImagePyramid()
        self.pyramid.SetInputData(self.image)

    @functools.cache
    def run(self, **properties):
        """The filter after its run, with the properties that differ from their defaults.

        Its snapshots hold at least the start of every level.
        """
        print(f"  {', '.join(f'{n} {v}' for n, v in properties.items()) or 'default properties'}")
        surface = volumic.vtkDeformableSurface()
        surface.SetInputConnection(self.pyramid.GetOutputPort())
        surface.SetIsoValue(self.iso)
        for name, value in {"SnapshotInterval": STARTS_ONLY, **properties}.items():
            getattr(surface, "Set" + name)(value)
        errors, _ = update(surface)
        if errors or surface.GetOutput().GetNumberOfPolys() == 0:
            raise Failure(errors[0] if errors else f"no surface at the iso-value {self.iso:g}")
        return surface

    def coarsest(self):
        """The coarsest level where a voxel is above the iso-value."""
        self.pyramid.Update()
        return max(h for h, image in enumerate(pictures.blocks_of(self.pyramid.GetOutput()))
                   if image.GetScalarRange()[1] > self.iso)

    @functools.cache
    def run_as_paper(self):
        """Without recovery, from level 3 or else the first at which something is left; that level.
        """
        for level in range(min(PAPERS_COARSEST, self.coarsest()), 0, -1):
            try:
                return self.run(Recovery=0, Metric=0, CoarsestLevel=level), level
            except Failure as error:
                print(f"  from level {level}: {error}")
        return self.run(Recovery=0, Metric=0, CoarsestLevel=0), 0

    @functools.cached_property
    def iso_surface(self):
        """Of the image, in voxels, closed at the border; only components of some size."""
        return closed_iso_surface(self.image, self.iso)

    def share_found(self, surface, voxels=1.0):
        """The share of the iso-surface, by area, within so many voxels of the surface."""
        return share_within(self.iso_surface, in_voxels(surface, self.image), voxels)


def iterations(surface):
    """(level, number of iterations, seconds of the level) of a run, in the order of the levels."""
    history = surface.GetHistory()
    levels, seconds = (vtk_to_numpy(history.GetColumnByName(name))
                       for name in ("Level", "Seconds"))
    return [(int(level), int((levels == level).sum()), float(seconds[levels == level].sum()))
            for level in dict.fromkeys(levels.tolist())]


def starts(surface):
    """The surface before the first iteration of each level, by level."""
    return {field(block, "Level"): block for block in pictures.blocks_of(surface.GetSnapshots())
            if field(block, "Iterations") == 0}


def field(surface, name):
    return int(pictures.number(surface, name))


def closed_iso_surface(image, iso):
    """vtkFlyingEdges3D on the image padded by background, in voxels: components of some size."""
    low, high = image.GetScalarRange()
    plain = image.NewInstance()
    plain.ShallowCopy(image)
    plain.SetOrigin(0, 0, 0)
    plain.SetSpacing(1, 1, 1)
    plain.SetDirectionMatrix(1, 0, 0, 0, 1, 0, 0, 0, 1)
    pad = vtkImageConstantPad()
    pad.SetInputData(plain)
    pad.SetOutputWholeExtent([e + (1 if i % 2 else -1) for i, e in enumerate(image.GetExtent())])
    pad.SetConstant(low if iso > low else high)
    contour = vtkFlyingEdges3D()
    contour.SetInputConnection(pad.GetOutputPort())
    contour.SetValue(0, iso)
    contour.ComputeNormalsOff()
    contour.ComputeScalarsOff()
    parts = vtkPolyDataConnectivityFilter()
    parts.SetInputConnection(contour.GetOutputPort())
    parts.SetExtractionModeToSpecifiedRegions()
    parts.Update()  # finds the regions and their sizes
    for region in range(parts.GetNumberOfExtractedRegions()):
        if parts.GetRegionSizes().GetValue(region) >= LEAST_TRIANGLES:
            parts.AddSpecifiedRegion(region)
    clean = vtkCleanPolyData()  # of the points of the others
    clean.SetInputConnection(parts.GetOutputPort())
    clean.PointMergingOff()
    clean.Update()
    return clean.GetOutput()


def in_voxels(surface, image):
    """The surface in the index coordinates of the image."""
    transform = vtkMatrixToLinearTransform()
    transform.SetInput(image.GetPhysicalToIndexMatrix())
    move = vtkTransformFilter()
    move.SetInputData(surface)
    move.SetTransform(transform)
    move.Update()
    return move.GetOutput()


def share_within(object_surface, surface, distance):
    """The share of an area whose triangles have their centre within a distance of the surface."""
    corners = vtk_to_numpy(object_surface.GetPoints().GetData()).astype(float)[
        vtk_to_numpy(object_surface.GetPolys().GetConnectivityArray()).reshape(-1, 3)]
    areas = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]),
                           axis=1)
    locator = vtkStaticCellLocator()
    locator.SetDataSet(surface)
    locator.BuildLocator()
    cell, number, part, squared = vtkGenericCell(), reference(0), reference(0), reference(0.0)
    place = [0.0, 0.0, 0.0]
    near = [locator.FindClosestPointWithinRadius(centre, distance, place, cell, number, part,
                                                 squared)
            for centre in corners.mean(axis=1).tolist()]
    return float(areas[np.array(near, bool)].sum() / areas.sum())
