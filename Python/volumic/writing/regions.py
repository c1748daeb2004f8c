# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The connected regions into which triangles divide space, which meshers of tetrahedra need."""

from __future__ import annotations

import dataclasses
from typing import Any, NamedTuple

import numpy as np

from ..errors import Failure

TRIES = 12            # sides of a region from which a point inside it is sought
MOST_PAIRS = 1 << 20  # of rays and triangles at once


class SurfaceLabel(NamedTuple):
    """A label that a surface of vtkLabelsToSurfaces has as field data."""
    number: int
    name: str
    color: tuple[float, ...] = (0.0, 0.0, 0.0)  # 0 to 1, sRGB


@dataclasses.dataclass
class Regions:
    """Region 0 is the unbounded one. Regions of labels come next, in the order of the labels, then
    empty ones."""
    labels: list[SurfaceLabel]
    label: np.ndarray      # of each region, an index of labels; -1: empty
    inside: np.ndarray     # a point in the interior of each region, n x 3
    triangles: np.ndarray  # m x 3, turned so that their normals point out of `behind`
    behind: np.ndarray     # region of each triangle; one of a label
    in_front: np.ndarray   # the other one
    source: np.ndarray     # index of each triangle among the polygons of the surface


# ---- What a surface has ------------------------------------------------------------------------

def surface_labels(surface: Any) -> list[SurfaceLabel]:
    """The labels of the field data; none if the surface is not one of labels."""
    fields = surface.GetFieldData()
    numbers, colors = fields.GetArray("Label"), fields.GetArray("LabelColor")
    names = fields.GetAbstractArray("LabelName")
    if numbers is None or names is None or colors is None:
        return []
    return [SurfaceLabel(int(numbers.GetTuple1(i)), names.GetValue(i), colors.GetTuple(i))
            for i in range(numbers.GetNumberOfTuples())]


def solid_labels(surface: Any) -> list[SurfaceLabel]:
    """The labels of the regions that a surface bounds: several for interfaces, otherwise one. A
    number that is not positive is replaced by one above all others."""
    labels = surface_labels(surface)
    if not surface.GetCellData().HasArray("BoundaryLabels"):
        first = labels[0] if labels else SurfaceLabel(1, "object")
        labels = [first._replace(name=", ".join(label.name for label in labels) or first.name)]
    highest, found = max(0, *(label.number for label in labels), 0), []
    for label in labels:
        highest += label.number <= 0
        found.append(label if label.number > 0 else label._replace(number=highest))
    return found


def triangles_of(surface: Any) -> np.ndarray:
    """The polygons, m x 3. Throw Failure if there are none, or others than triangles."""
    from vtkmodules.util.numpy_support import vtk_to_numpy
    polys = surface.GetPolys()
    count = polys.GetNumberOfCells()
    if count == 0:
        raise Failure("cannot be written (there is no surface)")
    if polys.IsHomogeneous() != 3:
        raise Failure("cannot be written (it has cells that are not triangles)")
    return vtk_to_numpy(polys.GetConnectivityArray()).reshape(-1, 3).astype(np.int64)


def cell_array(surface: Any, name: str) -> np.ndarray | None:
    """The values that polygons have in an array of the cell data; None if there is none."""
    from vtkmodules.util.numpy_support import vtk_to_numpy
    array = surface.GetCellData().GetArray(name)
    before = surface.GetNumberOfVerts() + surface.GetNumberOfLines()
    return None if array is None else vtk_to_numpy(array)[before:]


def _labels_of_sides(surface: Any, count: int) -> np.ndarray:
    """Indices of labels of sides 2 t (behind triangle t) and 2 t + 1 (in front of it)."""
    sides = cell_array(surface, "BoundaryLabels")
    if sides is None:
        return np.tile([0, -1], count)
    index = {label.number: i for i, label in enumerate(surface_labels(surface))}
    numbers, inverse = np.unique(sides, return_inverse=True)
    return np.array([index.get(int(number), -1) for number in numbers])[inverse.ravel()]


# ---- Shells ------------------------------------------------------------------------------------
# Sides that face each other across a wedge of an edge belong to the same region of space. Sides
# joined in this way form a shell: the outer boundary of a region, or that of a cavity in it.

def find_shells(points: np.ndarray, triangles: np.ndarray, labels: np.ndarray) -> np.ndarray:
    """The number of the shell of each side, in the order of their first sides."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components
    one, other = _joined_sides(points, triangles, labels)
    if (labels[one] != labels[other]).any():
        raise Failure("cannot be written (the labels on the sides of its triangles do not agree)")
    count = len(labels)
    graph = coo_matrix((np.ones(len(one), bool), (one, other)), (count, count))
    shells = connected_components(graph, directed=False)[1]
    first, inverse = np.unique(shells, return_index=True, return_inverse=True)[1:]
    return np.argsort(np.argsort(first))[inverse]


def _joined_sides(points: np.ndarray, triangles: np.ndarray, labels: np.ndarray
                  ) -> tuple[np.ndarray, np.ndarray]:
    """Pairs of sides that face each other across a wedge of an edge."""
    start = triangles.ravel()
    end, opposite = (np.roll(triangles, -i, axis=1).ravel() for i in (1, 2))
    owner = np.repeat(np.arange(len(triangles)), 3)
    upwards, low, high = start < end, np.minimum(start, end), np.maximum(start, end)
    order = np.lexsort((owner, high, low))
    new = np.ones(len(order), bool)
    new[1:] = (np.diff(low[order]) != 0) | (np.diff(high[order]) != 0)
    edge, sizes = np.cumsum(new) - 1, np.diff(np.append(np.flatnonzero(new), len(order)))
    if (sizes == 1).any():
        raise Failure("cannot be written (the surface is not closed)")
    # Counterclockwise about an edge, seen from its end, one meets `coming` of a triangle first.
    coming, leaving = (2 * owner + ~upwards)[order], (2 * owner + upwards)[order]
    several = sizes[edge] > 2
    if several.any():
        at = order[several]
        origin = points[low[at]]
        axis, way = points[high[at]] - origin, points[opposite[at]] - origin
        group = np.unique(edge[several], return_index=True, return_inverse=True)[1:]
        y = np.cross(axis, way[group[0]][group[1]])
        x = np.cross(y, axis)
        angle = np.arctan2((way * y).sum(1) * np.linalg.norm(axis, axis=1), (way * x).sum(1))
        turned = np.lexsort((angle, edge[several]))
        coming[several], leaving[several] = coming[several][turned], leaving[several][turned]
    # The next triangle about the same edge, or the first one after the last one.
    following = np.arange(1, len(order) + 1)
    following[np.cumsum(sizes) - 1] = np.flatnonzero(new)
    one, other = leaving, coming[following]
    if several.any():
        # Where each label has two sides at an edge, these face each other: angles, which rounding
        # changes, are not needed.
        sides = np.concatenate([coming[several], leaving[several]])
        edges = np.tile(edge[several], 2)
        by_label = np.lexsort((labels[sides], edges))
        sides, edges = sides[by_label], edges[by_label]
        pairs = labels[sides[::2]] == labels[sides[1::2]]
        pairs[1:] &= (edges[2::2] != edges[:-2:2]) | (labels[sides[2::2]] != labels[sides[:-2:2]])
        plain = np.bincount(edges[::2], ~pairs, len(sizes)) == 0
        kept = ~several | ~plain[edge]
        clear = plain[edges[::2]]
        one = np.concatenate([one[kept], sides[::2][clear]])
        other = np.concatenate([other[kept], sides[1::2][clear]])
    return one, other


# ---- Regions -----------------------------------------------------------------------------------

def solid_angle(corners: np.ndarray, point: np.ndarray) -> float:
    """The solid angle of triangles, m x 3 x 3, at a point: 4 pi inside a closed surface."""
    to = corners - point
    far = np.linalg.norm(to, axis=2)
    a, b, c = to[:, 0], to[:, 1], to[:, 2]
    below = (far.prod(1) + (a * b).sum(1) * far[:, 2] + (b * c).sum(1) * far[:, 0]
             + (c * a).sum(1) * far[:, 1])
    return float(2 * np.arctan2((a * np.cross(b, c)).sum(1), below).sum())


def find_regions(surface: Any) -> Regions:
    """The regions of the output `Interfaces` of vtkLabelsToSurfaces, or, without `BoundaryLabels`,
    of a closed surface.

    Throw Failure, without the name of a file, if the triangles do not divide space.
    """
    from vtkmodules.util.numpy_support import vtk_to_numpy
    points = vtk_to_numpy(surface.GetPoints().GetData()).astype(float)
    triangles, labels = triangles_of(surface), solid_labels(surface)
    of_side = _labels_of_sides(surface, len(triangles))
    shell = find_shells(points, triangles, of_side)
    corners = points[triangles]
    # Side 2 t + 1 sees the corners in the other order.
    sides = np.stack([corners, corners[:, [0, 2, 1]]], axis=1).reshape(-1, 3, 3)
    shells = _Shells(sides, shell, of_side)
    regions = shells.regions(labels)
    region = regions[shell]
    behind, in_front = region[::2], region[1::2]
    label = np.full(1 + int((shells.volumes > 0).sum()), -1)
    label[region] = of_side
    label[0] = -1
    turned = ((label < 0) * len(label) + np.arange(len(label)))[region]
    turned = turned[1::2] < turned[::2]
    behind, in_front = np.where(turned, in_front, behind), np.where(turned, behind, in_front)
    triangles = np.where(turned[:, None], triangles[:, [0, 2, 1]], triangles)
    order = np.argsort(region, kind="stable")
    parts = np.split(order, np.searchsorted(region[order], np.arange(1, len(label))))
    inside = np.array([np.zeros(3)] + [_point_inside(sides[part]) for part in parts[1:]])
    return Regions(labels, label, inside, triangles, behind, in_front, np.arange(len(triangles)))


class _Shells:
    """Shells with their labels, enclosed volumes (negative: a cavity) and boxes."""

    def __init__(self, sides: np.ndarray, shell: np.ndarray, of_side: np.ndarray) -> None:
        self.sides = sides
        order = np.argsort(shell, kind="stable")
        starts = np.searchsorted(shell[order], np.arange(shell.max() + 1))
        self.members = np.split(order, starts[1:])
        origin = sides[order[starts], 0][shell]
        a, b, c = (sides[:, i] - origin for i in range(3))
        self.volumes = np.bincount(shell, (a * np.cross(b, c)).sum(1) / 6)
        self.labels = of_side[order[starts]]
        low, high = sides.min(1)[order], sides.max(1)[order]
        self.low = np.minimum.reduceat(low, starts)
        self.high = np.maximum.reduceat(high, starts)

    def regions(self, labels: list[SurfaceLabel]) -> np.ndarray:
        """The region of each shell: one for each outer shell, which has the cavities in it."""
        regions = np.zeros(len(self.volumes), int)
        outer = np.flatnonzero(self.volumes > 0)
        numbered = outer[np.lexsort((self.labels[outer], self.labels[outer] < 0))]
        regions[numbered] = np.arange(1, len(outer) + 1)
        outer = outer[np.argsort(self.volumes[outer], kind="stable")]
        for cavity in np.flatnonzero(self.volumes <= 0):
            point = self.sides[self.members[cavity][0]].mean(0)
            about = outer[(self.labels[outer] == self.labels[cavity])
                          & (self.volumes[outer] > -self.volumes[cavity])
                          & (self.low[outer] <= self.low[cavity]).all(1)
                          & (self.high[outer] >= self.high[cavity]).all(1)]
            found = next((shell for shell in about
                          if solid_angle(self.sides[self.members[shell]], point) > 2 * np.pi), None)
            if found is None and self.labels[cavity] >= 0:
                raise Failure("cannot be written (its triangles do not enclose "
                              f"{labels[self.labels[cavity]].name})")
            regions[cavity] = 0 if found is None else regions[found]
        return regions


def _point_inside(sides: np.ndarray) -> np.ndarray:
    """A point inside a region: from the centers of some of its sides straight to the next side,
    half of the longest way on which the solid angle confirms the point."""
    tried = sides[::max(len(sides) // TRIES, 1)]
    starts = tried.mean(1)
    inward = np.cross(tried[:, 2] - tried[:, 0], tried[:, 1] - tried[:, 0])
    ways = _free_ways(sides, starts, inward, np.arange(0, len(sides), max(len(sides) // TRIES, 1)))
    lengths = np.where(np.isfinite(ways), ways, -1) * np.linalg.norm(inward, axis=1)
    for i in np.argsort(-lengths, kind="stable"):
        point = starts[i] + inward[i] * (ways[i] / 2)
        if lengths[i] > 0 and abs(solid_angle(sides, point) - 4 * np.pi) < 1e-3:
            return point
    raise Failure("cannot be written (a region of it is too thin for a point in it)")


def _free_ways(sides: np.ndarray, starts: np.ndarray, ways: np.ndarray, own: np.ndarray
               ) -> np.ndarray:
    """How far rays go, in lengths of `ways`, until they meet a triangle that is not their own."""
    border = 1e-9
    a, b = sides[:, 1] - sides[:, 0], sides[:, 2] - sides[:, 0]
    found = np.empty(len(starts))
    step = max(MOST_PAIRS // len(sides), 1)
    for first in range(0, len(starts), step):
        rays = slice(first, first + step)
        way = ways[rays, None]
        across = np.cross(way, b)
        volume = (a * across).sum(-1)
        offset = starts[rays, None] - sides[:, 0]
        turned = np.cross(offset, a)
        with np.errstate(divide="ignore", invalid="ignore"):
            u, v, t = ((one * other).sum(-1) / volume
                       for one, other in ((offset, across), (way, turned), (b, turned)))
            met = (u >= -border) & (v >= -border) & (u + v <= 1 + border) & (t > 0)
        met[np.arange(len(way)), own[rays]] = False
        found[rays] = np.where(met, t, np.inf).min(1)
    return found
