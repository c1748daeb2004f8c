# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Surfaces of all labels of a map by vtkLabelsToSurfaces and its peers, for benchmark_interfaces.py.

A run gives processor seconds, of one thread, and a Complex.
"""

import time

import numpy as np
from vtkmodules import vtkFiltersCore
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkFiltersGeneral import vtkDiscreteFlyingEdges3D
from volumic import vtkLabelsToSurfaces

from graded_surfaces import arrays_of
from interface_figures import (
    BACKGROUND, Complex, complex_of_output, complex_of_surfaces, complex_of_twins, volume_of)


def image_of(voxels, margin=0):
    """`margin`: so many layers of background about it."""
    values = np.pad(voxels.values, margin, constant_values=BACKGROUND)
    image = vtkImageData()
    image.SetDimensions(*values.shape[::-1])
    image.SetSpacing(*voxels.spacing)
    image.SetOrigin(*(-margin * voxels.spacing))
    image.GetPointData().SetScalars(numpy_to_vtk(values.ravel(), deep=True))
    return image


def run(image, *filters):
    """One after the other; processor seconds."""
    filters[0].SetInputDataObject(image)
    for first, second in zip(filters, filters[1:]):
        second.SetInputConnection(first.GetOutputPort())
    start = time.process_time()
    filters[-1].Update()
    return time.process_time() - start


def our_surfaces(voxels, is_shared, tolerance=0.):
    """tolerance: in smallest distances of voxels"""
    surfaces = vtkLabelsToSurfaces()
    surfaces.SetTolerance(tolerance * min(voxels.spacing))
    surfaces.SetNumberOfThreads(1)
    if is_shared:
        surfaces.SharedInterfacesOn()
    seconds = run(image_of(voxels), surfaces)
    if surfaces.GetErrorCode():
        raise RuntimeError("vtkLabelsToSurfaces failed, see above")
    return seconds, surfaces


def blocks_of(surfaces):
    """(label, block) of those that have triangles."""
    output = surfaces.GetOutputDataObject(0)
    blocks = [output.GetBlock(number) for number in range(output.GetNumberOfBlocks())]
    return [(int(block.GetFieldData().GetArray("Label").GetTuple1(0)), block)
            for block in blocks if block.GetNumberOfPolys()]


def separate(voxels):
    """A surface for each label by itself."""
    seconds, surfaces = our_surfaces(voxels, False)
    return seconds, complex_of_surfaces(
        [(label, *arrays_of(block)) for label, block in blocks_of(surfaces)])


def shared(voxels, tolerance=0.):
    seconds, surfaces = our_surfaces(voxels, True, tolerance)
    blocks = {label: (vtk_to_numpy(block.GetPoints().GetData()),
                      vtk_to_numpy(block.GetPointData().GetGlobalIds()), arrays_of(block)[1])
              for label, block in blocks_of(surfaces)}
    return seconds, complex_of_output(surfaces.GetOutputDataObject(1), blocks)


def graded(voxels):
    """Shared, with as few triangles as keep a fifth of a voxel."""
    return shared(voxels, .2)


def windowed(voxels):
    """vtkDiscreteFlyingEdges3D of all labels, their points merged, and
    vtkWindowedSincPolyDataFilter with its defaults and what keeps labels together."""
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
    """The labels behind and in front of triangles that are half a side of a voxel each."""
    points, triangles = arrays_of(surface)
    corners = points[triangles] / voxels.spacing
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    across = .5 * normal / np.linalg.norm(normal, axis=1, keepdims=True)
    values = np.pad(voxels.values, 1, constant_values=BACKGROUND)
    both = corners.mean(axis=1)[:, None] + np.stack([-across, across], axis=1)
    x, y, z = np.moveaxis(np.rint(both).astype(int) + 1, 2, 0)
    return values[z, y, x]


def nets(voxels):
    """vtkSurfaceNets3D of all labels, with its smoothing. It does not tell which of a triangle's
    labels is behind it: the same triangles, not smoothed, are between the two voxels."""
    surfaces = vtkFiltersCore.vtkSurfaceNets3D()
    for number, label in enumerate(voxels.counts):
        surfaces.SetValue(number, label)
    surfaces.SetOutputMeshTypeToTriangles()
    seconds = run(image_of(voxels, 1), surfaces)
    points, triangles = arrays_of(surfaces.GetOutput())
    surfaces.SmoothingOff()
    surfaces.Update()
    return seconds, Complex(points, triangles, sides_by_voxels(surfaces.GetOutput(), voxels))


def runs_here():
    """{name: function}; those that this VTK and this vtkLabelsToSurfaces have."""
    return {"separate": separate,
            **({"shared": shared, "graded": graded}
               if hasattr(vtkLabelsToSurfaces, "SharedInterfacesOn") else {}),
            **({"nets": nets} if hasattr(vtkFiltersCore, "vtkSurfaceNets3D") else {}),
            "windowed": windowed}
