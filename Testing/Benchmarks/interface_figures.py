# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""What is measured on the surfaces of all labels of a map together, for benchmark_interfaces.py.

A Complex is any set of triangles between two labels each: the port `Interfaces` of
vtkLabelsToSurfaces, the output of vtkSurfaceNets3D, or surfaces of single labels side by side.
"""

import os
import subprocess
import tempfile

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkImagingStencil import vtkImageStencilToImage, vtkPolyDataToImageStencil

from graded_surfaces import surface_of, write

BACKGROUND = 0


class Complex:
    """Points, triangles, and of each triangle the label behind it and that in front, where its
    normal points to; the lines that the maker tells of, and its `Junction` of points, or None; the
    boundaries that come with it, {label: (points, their numbers in the complex, triangles)}."""

    def __init__(self, points, triangles, sides, lines=None, junction=None, blocks=None):
        self.points = np.asarray(points, float)
        self.triangles = np.asarray(triangles, np.int64).reshape(-1, 3)
        self.sides = np.asarray(sides, int).reshape(-1, 2)
        self.lines = None if lines is None else np.asarray(lines, np.int64).reshape(-1, 2)
        self.junction = junction
        self.blocks = blocks

    def labels(self):
        labels = np.unique(self.sides)
        return labels[labels != BACKGROUND]

    def faces_of(self, label):
        """The label's boundary, turned outwards."""
        behind, front = self.sides.T
        return np.vstack([self.triangles[behind == label],
                          self.triangles[front == label][:, ::-1]])


def complex_of_output(surface, blocks=None):
    """Of a vtkPolyData as that of port 1: lines first, then triangles; `BoundaryLabels`."""
    def cells(array, size):
        return vtk_to_numpy(array.GetConnectivityArray()).reshape(-1, size)
    sides = vtk_to_numpy(surface.GetCellData().GetArray("BoundaryLabels"))
    junction = surface.GetPointData().GetArray("Junction")
    return Complex(vtk_to_numpy(surface.GetPoints().GetData()), cells(surface.GetPolys(), 3),
                   sides[surface.GetNumberOfLines():], cells(surface.GetLines(), 2),
                   None if junction is None else vtk_to_numpy(junction), blocks)


def complex_of_surfaces(surfaces):
    """Of (label, points, triangles) side by side, which share nothing."""
    starts = np.cumsum([0] + [len(points) for _, points, _ in surfaces])
    return Complex(np.vstack([points for _, points, _ in surfaces]),
                   np.vstack([faces + start for (_, _, faces), start in zip(surfaces, starts)]),
                   np.vstack([np.full((len(faces), 2), (label, BACKGROUND))
                              for label, _, faces in surfaces]))


def complex_of_twins(points, triangles, labels):
    """Of triangles of one label each, turned outwards, on common points: two with the same corners
    become one between both labels."""
    corners = np.sort(triangles, axis=1)
    order = np.lexsort((*corners.T, ))
    twins = (corners[order[1:]] == corners[order[:-1]]).all(axis=1)
    twins[1:] &= ~twins[:-1]  # the third of three stays alone
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
    """One number for each pair."""
    return pairs[:, 0] * 2 ** 32 + pairs[:, 1]


def wrong_edges(faces):
    """Those of a boundary that are not run through exactly once in each direction: none of a closed,
    oriented surface whose edges have two triangles."""
    edges = directed_edges(faces)
    undirected, number = np.unique(_keys(np.sort(edges, axis=1)), return_inverse=True)
    is_ahead = edges[:, 0] < edges[:, 1]
    ahead, back = (np.bincount(number[side], minlength=len(undirected))
                   for side in (is_ahead, ~is_ahead))
    return int(((ahead != 1) | (back != 1)).sum())


def pinched_vertices(faces):
    """Of a boundary without wrong edges: fans of triangles beyond the first at its vertices."""
    edges = directed_edges(faces)
    forth, back = _keys(edges), _keys(edges[:, ::-1])
    order = np.argsort(forth)
    # The next triangle at the first corner of an edge is beyond the edge that arrives there.
    arriving = np.arange(len(edges)).reshape(-1, 3)[:, [2, 0, 1]].ravel()
    following = order[np.searchsorted(forth, back[arriving], sorter=order)]
    least = np.arange(len(edges))
    for _ in range(12):  # each doubles how far around a vertex the least number is known
        least = np.minimum(least, least[following])
        following = following[following]
    return len(np.unique(least)) - len(np.unique(faces))


def edges_of_many(shape):
    """Those of three triangles or more."""
    edges, faces = np.unique(np.sort(directed_edges(shape.triangles), axis=1), axis=0,
                             return_counts=True)
    return edges[faces > 2]


def folded_edges(shape):
    """Edges of three triangles or more around which two in a row have another label in front of the
    one than behind the other: what is between them is of both, though nothing crosses."""
    ends = directed_edges(shape.triangles)
    third = shape.triangles[:, [2, 0, 1]].ravel()
    _, edge, faces = np.unique(_keys(np.sort(ends, axis=1)), return_inverse=True,
                               return_counts=True)
    at = np.flatnonzero(faces[edge] > 2)
    if len(at) == 0:
        return 0
    ends, third, edge = ends[at], third[at], edge[at]
    # Angles about the edge from its lesser end to the other: where the normal points they grow.
    is_ahead = ends[:, 0] < ends[:, 1]
    axis = np.diff(shape.points[np.sort(ends, axis=1)], axis=1)[:, 0]
    axis /= np.linalg.norm(axis, axis=1, keepdims=True)
    across = shape.points[third] - shape.points[ends[:, 0]]
    _, first, of_edge = np.unique(edge, return_index=True, return_inverse=True)
    u = np.cross(axis, across)[first][of_edge]
    v = np.cross(axis, u)
    angle = np.arctan2(np.einsum("ij,ij->i", across, u) * np.linalg.norm(v, axis=1),
                       -np.einsum("ij,ij->i", across, v) * np.linalg.norm(u, axis=1))
    below, above = np.where(is_ahead[:, None], shape.sides[at // 3], shape.sides[at // 3][:, ::-1]).T
    order = np.lexsort((angle, of_edge))
    starts = np.searchsorted(of_edge[order], np.arange(len(first)))
    following = np.arange(len(order)) + 1
    following[np.append(starts[1:], len(order)) - 1] = starts
    is_wrong = above[order] != below[order[following]]
    return len(np.unique(of_edge[order][is_wrong]))


def wrong_lines(shape):
    """Edges of three triangles or more that are no line, and lines that are no such edge."""
    lines = np.sort(shape.lines, axis=1)
    repeated = len(lines) - len(np.unique(lines, axis=0))
    return repeated + len(np.setxor1d(_keys(lines), _keys(edges_of_many(shape))))


def wrong_junctions(shape):
    """Points whose `Junction` is not what the lines make of it."""
    valence = np.bincount(shape.lines.ravel(), minlength=len(shape.points))
    expected = np.where(valence == 0, 0, np.where(valence == 2, 1, 2))
    return int((expected != shape.junction).sum())


def _in_one_order(faces):
    """From their least corners on, and sorted."""
    turned = faces[np.arange(len(faces))[:, None], (faces.argmin(axis=1)[:, None] + [0, 1, 2]) % 3]
    return turned[np.lexsort(turned.T[::-1])]


def wrong_blocks(shape):
    """Labels whose boundary by itself has other triangles, or other places but for their rounding."""
    wrong = 0
    for label in shape.labels():
        points, numbers, triangles = shape.blocks.get(label, ([], [], []))
        faces = shape.faces_of(label)
        wrong += not (len(triangles) == len(faces)
                      and (_in_one_order(numbers[triangles]) == _in_one_order(faces)).all()
                      and (points == shape.points[numbers].astype(points.dtype)).all())
    return wrong


# ---- Shapes --------------------------------------------------------------------------------------

def volume_of(points, faces):
    a, b, c = (points[faces[:, corner]] - points.mean(axis=0) for corner in range(3))
    return np.einsum("ij,ij->", a, np.cross(b, c)) / 6


def _side_lengths(shape):
    """Of each triangle, the side opposite to each corner."""
    corners = shape.points[shape.triangles]
    return np.linalg.norm(corners[:, [2, 0, 1]] - corners[:, [1, 2, 0]], axis=2)


def radius_ratios(shape):
    """Twice the incircle's radius by that of the circumcircle: 1 of an equilateral triangle."""
    a, b, c = _side_lengths(shape).T
    product = a * b * c
    return np.maximum(0, np.divide((b + c - a) * (c + a - b) * (a + b - c), product,
                                   out=np.zeros_like(product), where=product > 0))


def least_angles(shape):
    """Of each triangle, degrees."""
    a, b, c = np.sort(_side_lengths(shape), axis=1).T
    product = 2 * b * c
    cosine = np.divide(b * b + c * c - a * a, product, out=np.ones_like(product),
                       where=product > 0)
    return np.degrees(np.arccos(np.clip(cosine, -1, 1)))


def line_angles(points, lines):
    """Between two segments one after the other, degrees: at points where two meet and no more."""
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

    def box_of(self, label, places):
        """(least, largest) numbers x, y, z of a box with the label's voxels and the places in it."""
        inside = self.values == label
        box = [[], []]
        for axis in range(3):
            numbers = np.flatnonzero(inside.any(axis=tuple({0, 1, 2} - {2 - axis})))
            at = np.append(numbers, places[:, axis] / self.spacing[axis])
            box[0].append(max(0, int(np.floor(at.min()))))
            box[1].append(min(self.values.shape[2 - axis] - 1, int(np.ceil(at.max()))))
        return box

    def wrong_centres(self, label, points, faces):
        """Voxels of the label with their centres outside of its boundary, and others' inside."""
        if len(faces) == 0:
            return self.counts[label]
        least, largest = self.box_of(label, points[np.unique(faces)])
        extent = [number for pair in zip(least, largest) for number in pair]
        stencil, to_image = vtkPolyDataToImageStencil(), vtkImageStencilToImage()
        stencil.SetInputData(surface_of(points, faces))
        stencil.SetOutputSpacing(*self.spacing)
        stencil.SetOutputWholeExtent(*extent)
        stencil.SetTolerance(0)
        to_image.SetInputConnection(stencil.GetOutputPort())
        to_image.SetInsideValue(1)
        to_image.SetOutputScalarTypeToUnsignedChar()
        to_image.Update()
        scalars = to_image.GetOutput().GetPointData().GetScalars()
        box = tuple(slice(a, b + 1) for a, b in zip(least[::-1], largest[::-1]))
        of_label = self.values[box] == label
        return int((vtk_to_numpy(scalars).reshape(of_label.shape) != of_label).sum())


# ---- All of it -----------------------------------------------------------------------------------

def intersections(shape, judge):
    """Pairs of triangles that meet elsewhere than in what they share, and triangles without area;
    by the program JudgeFiles, with CGAL's exact predicates. Where boundaries by themselves have places
    that are rounded, with these."""
    points = shape.points
    for places, _, _ in (shape.blocks or {}).values():
        points = points.astype(places.dtype)
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "complex.vtp")
        write(surface_of(points, shape.triangles), path)
        names, figures = (subprocess.run([judge, word], check=True, capture_output=True,
                                         text=True).stdout.split() for word in ("--help", path))
    told = dict(zip(names, map(float, figures)))
    return told["intersections"], told["flat"]


def label_figures(shape, voxels, large):
    """Sums over the labels, and errors of the volumes of those of more than `large` voxels."""
    edges = pinches = wrong = lost = 0
    errors = []
    for label, count in voxels.counts.items():
        faces = shape.faces_of(label)
        of_label = wrong_edges(faces)
        edges += of_label
        pinches += pinched_vertices(faces) if len(faces) and not of_label else 0
        lost += len(faces) == 0
        wrong += voxels.wrong_centres(label, shape.points, faces)
        if count > large:
            errors.append(abs(100 * (volume_of(shape.points, faces) / voxels.voxel / count - 1)))
    return {"WrongEdges": edges, "Pinched": pinches, "WrongVoxels": wrong, "LostLabels": lost,
            "VolumeLargest": max(errors, default=np.nan),
            "VolumeMedian": np.median(errors) if errors else np.nan}


def figures_of(shape, voxels, judge, large=1000):
    """{name: number}; lengths and volumes are of no unit."""
    pairs, flat = intersections(shape, judge)
    lines = edges_of_many(shape)
    angles, least = line_angles(shape.points, lines), least_angles(shape)
    ratios = radius_ratios(shape)
    at_junction = np.zeros(len(shape.points), bool)
    at_junction[lines] = True
    inner = least[~at_junction[shape.triangles].any(axis=1)]
    return {
        "Vertices": len(np.unique(shape.triangles)), "Triangles": len(shape.triangles),
        "Intersections": pairs, "Flat": flat, "Folded": folded_edges(shape), "Lines": len(lines),
        "WrongLines": np.nan if shape.lines is None else wrong_lines(shape),
        "WrongJunctions": np.nan if shape.junction is None else wrong_junctions(shape),
        "WrongBlocks": np.nan if shape.blocks is None else wrong_blocks(shape),
        "RatioMean": ratios.mean(), "Ratio01": np.quantile(ratios, .01), "RatioLeast": ratios.min(),
        "AngleInner": inner.min() if len(inner) else np.nan, "AngleLeast": least.min(),
        "Roughness": np.quantile(angles, .95) if len(angles) else np.nan,
        **label_figures(shape, voxels, large)}
