# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Figures of surfaces and of label complexes, computed with NumPy, VTK and JudgeFiles.

A Complex is a set of triangles, each between two labels: the port `Interfaces` of
vtkLabelsToSurfaces, or the output of vtkSurfaceNets3D.
"""

import os
import subprocess
import tempfile

import numpy as np
from vtkmodules.util.numpy_support import (
    numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy)
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter

BACKGROUND = 0


def arrays_of(surface):
    """Return the points and the triangles as arrays."""
    corners = vtk_to_numpy(surface.GetPolys().GetConnectivityArray())
    return vtk_to_numpy(surface.GetPoints().GetData()).astype(float), corners.reshape(-1, 3)


def surface_of(points, triangles):
    surface, vtk_points, cells = vtkPolyData(), vtkPoints(), vtkCellArray()
    vtk_points.SetData(numpy_to_vtk(np.ascontiguousarray(points), deep=True))
    cells.SetData(3, numpy_to_vtkIdTypeArray(triangles.astype(np.int64).ravel(), deep=True))
    surface.SetPoints(vtk_points)
    surface.SetPolys(cells)
    return surface


def write(surface, path):
    writer = vtkXMLPolyDataWriter()
    writer.SetFileName(path)
    writer.SetInputData(surface)
    writer.Write()


def judged(judge, path):
    """Run the program JudgeFiles; return {name: figure}."""
    names, figures = (subprocess.run([judge, word], check=True, capture_output=True,
                                     text=True).stdout.split() for word in ("--help", path))
    return dict(zip(names, map(float, figures)))


class Complex:
    """Points, triangles, and the labels behind and in front of each triangle. Normals point to the
    front. rounded: judge the points as floats, as the surfaces of single labels store them."""

    def __init__(self, points, triangles, sides, rounded=False):
        self.points = np.asarray(points, float)
        self.triangles = np.asarray(triangles, np.int64).reshape(-1, 3)
        self.sides = np.asarray(sides, int).reshape(-1, 2)
        self.rounded = rounded

    def faces_of(self, label):
        """Return the boundary of the label, oriented outwards."""
        behind, front = self.sides.T
        return np.vstack([self.triangles[behind == label],
                          self.triangles[front == label][:, ::-1]])


def complex_of_output(surface):
    """Convert the vtkPolyData of port 1: lines first, then triangles, with `BoundaryLabels`."""
    sides = vtk_to_numpy(surface.GetCellData().GetArray("BoundaryLabels"))
    return Complex(*arrays_of(surface), sides[surface.GetNumberOfLines():], True)


def complex_of_twins(points, triangles, labels):
    """Merge triangles of one label each, oriented outwards, on common points: two with the same
    corners become one between both labels."""
    corners = np.sort(triangles, axis=1)
    order = np.lexsort((*corners.T, ))
    twins = (corners[order[1:]] == corners[order[:-1]]).all(axis=1)
    twins[1:] &= ~twins[:-1]  # the third of three stays single
    first = order[:-1][twins]
    front = np.full(len(triangles), BACKGROUND)
    front[first] = labels[order[1:][twins]]
    kept = np.ones(len(triangles), bool)
    kept[order[1:][twins]] = False
    return Complex(points, triangles[kept], np.column_stack([labels, front])[kept])


# ---- Topology ------------------------------------------------------------------------------------

def directed_edges(triangles):
    return triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)


def _keys(pairs):
    """Return one number for each pair."""
    return pairs[:, 0] * 2 ** 32 + pairs[:, 1]


def wrong_edges(faces):
    """Count the edges of a boundary that do not occur exactly once in each direction. A closed,
    oriented manifold has none."""
    edges = directed_edges(faces)
    undirected, number = np.unique(_keys(np.sort(edges, axis=1)), return_inverse=True)
    is_ahead = edges[:, 0] < edges[:, 1]
    ahead, back = (np.bincount(number[side], minlength=len(undirected))
                   for side in (is_ahead, ~is_ahead))
    return int(((ahead != 1) | (back != 1)).sum())


def edges_of_many(shape):
    """Return the edges of three or more triangles."""
    edges, faces = np.unique(np.sort(directed_edges(shape.triangles), axis=1), axis=0,
                             return_counts=True)
    return edges[faces > 2]


# ---- Shapes --------------------------------------------------------------------------------------

def volume_of(points, faces):
    a, b, c = (points[faces[:, corner]] - points.mean(axis=0) for corner in range(3))
    return np.einsum("ij,ij->", a, np.cross(b, c)) / 6


def _side_lengths(shape):
    """Return the length of the side opposite to each corner of each triangle."""
    corners = shape.points[shape.triangles]
    return np.linalg.norm(corners[:, [2, 0, 1]] - corners[:, [1, 2, 0]], axis=2)


def least_angles(shape):
    """Return the least angle of each triangle, degrees."""
    a, b, c = np.sort(_side_lengths(shape), axis=1).T
    product = 2 * b * c
    cosine = np.divide(b * b + c * c - a * a, product, out=np.ones_like(product),
                       where=product > 0)
    return np.degrees(np.arccos(np.clip(cosine, -1, 1)))


def line_angles(points, lines):
    """Return the angles between consecutive segments, degrees, at points of exactly two segments."""
    ends = np.vstack([lines, lines[:, ::-1]])
    ends = ends[np.argsort(ends[:, 0], kind="stable")]
    vertex, start, valence = np.unique(ends[:, 0], return_index=True, return_counts=True)
    start, vertex = start[valence == 2], vertex[valence == 2]
    before = points[vertex] - points[ends[start, 1]]
    behind = points[ends[start + 1, 1]] - points[vertex]
    return np.degrees(np.arctan2(np.linalg.norm(np.cross(before, behind), axis=1),
                                 np.einsum("ij,ij->i", before, behind)))


# ---- Voxels --------------------------------------------------------------------------------------

class LabelVoxels:
    """A label map: values[z, y, x], the first voxel's centre at 0."""

    def __init__(self, values, spacing=(1, 1, 1)):
        self.values, self.spacing = np.asarray(values), np.asarray(spacing, float)
        labels, counts = np.unique(self.values, return_counts=True)
        self.counts = {int(label): int(count) for label, count in zip(labels, counts)
                       if label != BACKGROUND}
        self.voxel = self.spacing.prod()


# ---- Figures -------------------------------------------------------------------------------------

def label_figures(shape, voxels, large):
    """Return sums over the labels and the largest volume error of labels of over `large` voxels."""
    edges = lost = 0
    errors = []
    for label, count in voxels.counts.items():
        faces = shape.faces_of(label)
        edges += wrong_edges(faces)
        lost += len(faces) == 0
        if count > large:
            errors.append(abs(100 * (volume_of(shape.points, faces) / voxels.voxel / count - 1)))
    return {"WrongEdges": edges, "LostLabels": lost,
            "VolumeLargest": max(errors, default=np.nan)}


def figures_of(shape, voxels, judge, large=1000):
    """Return {name: number}. JudgeFiles finds intersecting pairs and triangles without area with CGAL's
    exact predicates."""
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "complex.vtp")
        write(surface_of(shape.points.astype(np.float32 if shape.rounded else float),
                         shape.triangles), path)
        verdict = judged(judge, path)
    lines = edges_of_many(shape)
    angles = line_angles(shape.points, lines)
    return {
        "Vertices": len(np.unique(shape.triangles)), "Triangles": len(shape.triangles),
        "Intersections": verdict["intersections"], "Flat": verdict["flat"],
        "RatioMean": verdict["ratio"], "AngleLeast": least_angles(shape).min(),
        "Roughness": np.quantile(angles, .95) if len(angles) else np.nan,
        **label_figures(shape, voxels, large)}
