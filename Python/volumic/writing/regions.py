# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The connected regions into which triangles divide space, which meshers of tetrahedra need."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ..errors import Failure

TRIES = 12  # sides of a region from which a point inside it is sought


class SurfaceLabel(NamedTuple):
    """A label that a surface of vtkLabelsToSurfaces has as field data."""
    number: int
    name: str
    color: tuple[float, ...] = (0.0, 0.0, 0.0)  # 0 to 1, sRGB


class Regions(NamedTuple):
    """Region 0 is the unbounded one. Regions of labels come next, in the order of the labels, then
    empty ones."""
    labels: list[SurfaceLabel]
    label: np.ndarray      # of each region, an index of labels; -1: empty
    inside: np.ndarray     # a point in the interior of each region, n x 3
    triangles: np.ndarray  # m x 3, turned so that their normals point out of `behind`
    behind: np.ndarray     # region of each triangle; one of a label
    in_front: np.ndarray   # the other one


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


def labels_of_sides(surface: Any, count: int) -> np.ndarray:
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
    graph = coo_matrix((np.ones(len(one), bool), (one, other)), (len(labels),) * 2)
    shells = connected_components(graph, directed=False)[1]
    first, inverse = np.unique(shells, return_index=True, return_inverse=True)[1:]
    return np.argsort(np.argsort(first))[inverse]


def _joined_sides(points: np.ndarray, triangles: np.ndarray, labels: np.ndarray
                  ) -> tuple[np.ndarray, np.ndarray]:
    """Pairs of sides that face each other across a wedge of an edge."""
    start, end, opposite = (np.roll(triangles, -i, axis=1).ravel() for i in range(3))
    owner = np.repeat(np.arange(len(triangles)), 3)
    upwards, low, high = start < end, np.minimum(start, end), np.maximum(start, end)
    order = np.lexsort((owner, high, low))
    new = np.ones(len(order), bool)
    new[1:] = (np.diff(low[order]) != 0) | (np.diff(high[order]) != 0)
    edge, firsts = np.cumsum(new) - 1, np.flatnonzero(new)
    sizes = np.diff(np.append(firsts, len(order)))
    if (sizes == 1).any():
        raise Failure("cannot be written (the surface is not closed)")
    several = np.flatnonzero(sizes[edge] > 2)
    if len(several):
        # Counterclockwise about the edge, seen from its end.
        at = order[several]
        origin = points[low[at]]
        axis, way = points[high[at]] - origin, points[opposite[at]] - origin
        index, group = np.unique(edge[several], return_index=True, return_inverse=True)[1:]
        y = np.cross(axis, way[index][group])
        x = np.cross(y, axis)
        angle = np.arctan2((way * y).sum(1) * np.linalg.norm(axis, axis=1), (way * x).sum(1))
        order[several] = at[np.lexsort((angle, edge[several]))]
    # Of a triangle one meets the side `coming` first. The next triangle, or the first again:
    following = np.append(np.arange(1, len(order)), 0)
    following[firsts + sizes - 1] = firsts
    coming, leaving = (2 * owner + ~upwards)[order], (2 * owner + upwards)[order]
    one, other = leaving, coming[following]
    if len(several):
        # Where each label has two sides at an edge, these face each other: angles, which depend on
        # rounding, are not needed.
        sides = np.append(coming[several], leaving[several])
        edges = np.tile(edge[several], 2)
        sorting = np.lexsort((labels[sides], edges))
        sides, edges = sides[sorting].reshape(-1, 2), edges[sorting][::2]
        own = labels[sides]
        twice = own[:, 0] == own[:, 1]
        twice[1:] &= (np.diff(edges) != 0) | (np.diff(own[:, 0]) != 0)
        plain = np.bincount(edges, ~twice, len(sizes)) == 0
        kept, paired = (sizes[edge] == 2) | ~plain[edge], sides[plain[edges]]
        one, other = np.append(one[kept], paired[:, 0]), np.append(other[kept], paired[:, 1])
    return one, other


# ---- Regions -----------------------------------------------------------------------------------

def solid_angle(corners: np.ndarray, point: np.ndarray) -> float:
    """The solid angle of triangles, m x 3 x 3, at a point: 4 pi inside a closed surface."""
    to = corners - point
    far = np.linalg.norm(to, axis=2)
    a, b, c = np.moveaxis(to, 1, 0)
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
    of_side = labels_of_sides(surface, len(triangles))
    shell = find_shells(points, triangles, of_side)
    # Side 2 t + 1 sees the corners in the other order.
    sides = points[np.stack([triangles, triangles[:, [0, 2, 1]]], axis=1).reshape(-1, 3)]
    region = _regions_of_shells(sides, shell, of_side, labels)[shell]
    label = np.full(region.max() + 1, -1)
    label[region] = of_side
    label[0] = -1
    rank = np.arange(len(label)) + (label < 0) * len(label)  # those of labels are behind
    turned = rank[region[1::2]] < rank[region[::2]]
    behind, in_front = np.where(turned, region.reshape(-1, 2).T[::-1], region.reshape(-1, 2).T)
    triangles = np.where(turned[:, None], triangles[:, [0, 2, 1]], triangles)
    order = np.argsort(region, kind="stable")
    parts = np.split(order, np.searchsorted(region[order], np.arange(1, len(label))))
    inside = np.array([np.zeros(3)] + [_point_inside(sides[part]) for part in parts[1:]])
    return Regions(labels, label, inside, triangles, behind, in_front)


def _regions_of_shells(sides: np.ndarray, shell: np.ndarray, of_side: np.ndarray,
                       labels: list[SurfaceLabel]) -> np.ndarray:
    """The region of each shell: one for each outer shell, which has the cavities in it."""
    order = np.argsort(shell, kind="stable")
    starts = np.searchsorted(shell[order], np.arange(shell.max() + 1))
    members, label = np.split(sides[order], starts[1:]), of_side[order[starts]]
    a, b, c = np.moveaxis(sides - sides[order[starts], :1][shell], 1, 0)
    volume = np.bincount(shell, (a * np.cross(b, c)).sum(1) / 6)  # negative: a cavity
    low, high = (np.array([end(part, axis=(0, 1)) for part in members]) for end in (np.min, np.max))
    outer, regions = np.flatnonzero(volume > 0), np.zeros(len(volume), int)
    regions[outer[np.lexsort((label[outer], label[outer] < 0))]] = np.arange(1, len(outer) + 1)
    outer = outer[np.argsort(volume[outer], kind="stable")]
    for cavity in np.flatnonzero(volume <= 0):
        point = members[cavity][0].mean(axis=0)
        about = outer[(label[outer] == label[cavity]) & (volume[outer] > -volume[cavity])
                      & (low[outer] <= low[cavity]).all(1) & (high[outer] >= high[cavity]).all(1)]
        found = [number for number in about if solid_angle(members[number], point) > 2 * np.pi][:1]
        if not found and label[cavity] >= 0:
            raise Failure("cannot be written (its triangles do not enclose "
                          f"{labels[label[cavity]].name})")
        regions[cavity] = regions[found[0]] if found else 0
    return regions


def _point_inside(sides: np.ndarray) -> np.ndarray:
    """A point inside a region: from the centers of some of its sides straight to the next side,
    half of the longest way on which the solid angle confirms the point."""
    own = np.arange(0, len(sides), max(len(sides) // TRIES, 1))
    starts = sides[own].mean(axis=1)
    inward = np.cross(sides[own, 2] - sides[own, 0], sides[own, 1] - sides[own, 0])
    ways = np.array([_free_way(sides, *ray) for ray in zip(starts, inward, own)])
    lengths = np.where(np.isfinite(ways), ways, 0) * np.linalg.norm(inward, axis=1)
    for i in np.argsort(-lengths, kind="stable"):
        point = starts[i] + inward[i] * (ways[i] / 2)
        if lengths[i] > 0 and abs(solid_angle(sides, point) - 4 * np.pi) < 1e-3:
            return point
    raise Failure("cannot be written (a region of it is too thin for a point in it)")


def _free_way(sides: np.ndarray, start: np.ndarray, way: np.ndarray, own: int) -> float:
    """How far a ray goes, in lengths of `way`, until it meets a triangle that is not its own."""
    border = 1e-9
    a, b = sides[:, 1] - sides[:, 0], sides[:, 2] - sides[:, 0]
    across, offset = np.cross(way, b), start - sides[:, 0]
    turned = np.cross(offset, a)
    with np.errstate(divide="ignore", invalid="ignore"):
        u, v, t = np.stack([(offset * across).sum(1), turned @ way, (b * turned).sum(1)]
                           ) / (a * across).sum(1)
        met = (u >= -border) & (v >= -border) & (u + v <= 1 + border) & (t > 0)
    met[own] = False
    return float(np.min(t[met], initial=np.inf))
