# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Surfaces for benchmark_graded.py: files, what VTK makes of them, and what is measured on them."""

import numpy as np
from vtkmodules.util.numpy_support import (
    numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy)
from vtkmodules.vtkCommonCore import mutable, vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData, vtkStaticCellLocator
from vtkmodules.vtkFiltersCore import vtkFlyingEdges3D, vtkQuadricDecimation
from vtkmodules.vtkIOPLY import vtkPLYReader, vtkPLYWriter
from vtkmodules.vtkImagingCore import vtkImageCast, vtkImageConstantPad, vtkImageResample
from vtkmodules.vtkIOXML import (
    vtkXMLImageDataReader, vtkXMLPolyDataReader, vtkXMLPolyDataWriter)


def read(path):
    reader = vtkPLYReader() if path.endswith(".ply") else vtkXMLPolyDataReader()
    reader.SetFileName(path)
    reader.Update()
    return reader.GetOutput()


def write(surface, path):
    writer = vtkPLYWriter() if path.endswith(".ply") else vtkXMLPolyDataWriter()
    writer.SetFileName(path)
    writer.SetInputData(surface)
    writer.Write()


def arrays_of(surface):
    """Points and the corners of triangles."""
    corners = vtk_to_numpy(surface.GetPolys().GetConnectivityArray())
    return vtk_to_numpy(surface.GetPoints().GetData()).astype(float), corners.reshape(-1, 3)


def surface_of(points, triangles):
    surface, places, cells = vtkPolyData(), vtkPoints(), vtkCellArray()
    places.SetData(numpy_to_vtk(points.astype(float), deep=True))
    cells.SetData(3, numpy_to_vtkIdTypeArray(triangles.astype(np.int64).ravel(), deep=True))
    surface.SetPoints(places)
    surface.SetPolys(cells)
    return surface


def write_medit(surface, path):
    points, triangles = arrays_of(surface)
    with open(path, "w", encoding="ascii") as file:
        file.write("MeshVersionFormatted 2\nDimension 3\n")
        for title, rows, form in (("Vertices", points, "%.9g"), ("Triangles", triangles + 1, "%d")):
            file.write(f"{title}\n{len(rows)}\n")
            np.savetxt(file, rows, f"{form} {form} {form} 0")  # which part it is of
        file.write("End\n")


def read_medit(path):
    with open(path, encoding="ascii") as file:
        words = file.read().split()

    def section(title):
        start = words.index(title) + 2
        return np.array(words[start:start + 4 * int(words[start - 1])], float).reshape(-1, 4)[:, :3]
    return surface_of(section("Vertices"), section("Triangles") - 1)


def decimated(surface, vertices):
    """Triangles and nothing else; two for each vertex."""
    decimation = vtkQuadricDecimation()
    decimation.SetInputData(surface_of(*arrays_of(surface)))
    decimation.SetTargetReduction(1 - vertices / surface.GetNumberOfPoints())
    decimation.Update()
    return surface_of(*arrays_of(decimation.GetOutput()))


def edges_of(surface):
    """(first, second) vertices of each edge, and lengths."""
    points, triangles = arrays_of(surface)
    pairs = np.sort(triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    pairs = np.unique(pairs, axis=0)
    return pairs, np.linalg.norm(points[pairs[:, 0]] - points[pairs[:, 1]], axis=1)


def mean_edge(surface):
    return edges_of(surface)[1].mean()


def alike_edges(surface, most):
    """Share of the pairs of edges at a vertex that are no more than so many times as long."""
    pairs, lengths = edges_of(surface)
    vertex, length = pairs.T.ravel(), np.tile(lengths, 2)
    order = np.lexsort((length, vertex))
    length, valences = length[order], np.bincount(vertex)
    starts = np.cumsum(valences) - valences
    alike = pairs_of_all = 0
    for valence in np.unique(valences[valences > 1]):
        rows = length[starts[valences == valence, None] + np.arange(valence)]
        for shorter, longer in zip(*np.triu_indices(valence, 1)):
            alike += (rows[:, longer] <= most * rows[:, shorter]).sum()
            pairs_of_all += len(rows)
    return alike / pairs_of_all


class IsoSurface:
    """VTK's, of a volume with a voxel of air around it, interpolated on voxels half as wide: that
    of the voxels themselves cuts corners, on noise by more than a tenth of a voxel."""

    def __init__(self, path, iso):
        reader, pad, cast = vtkXMLImageDataReader(), vtkImageConstantPad(), vtkImageCast()
        reader.SetFileName(path)
        reader.Update()
        image = reader.GetOutput()
        self.unit = min(image.GetSpacing())
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
