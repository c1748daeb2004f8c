# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Connected regions of space bounded by triangles, as required by tetrahedral meshers."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy

from ..errors import Failure

MAXIMUM_TRIES = 12  # sides from which an interior point is sought


class SurfaceLabel(NamedTuple):
    """A label in the field data of a surface of vtkLabelsToSurfaces."""
    number: int
    name: str
    color: tuple[float, ...] = (0.0, 0.0, 0.0)  # 0 to 1, sRGB


class Regions(NamedTuple):
    """Regions of space. Region 0 is the unbounded one, followed by the regions of labels in the
    order of the labels, then cavities."""
    labels: list[SurfaceLabel]
    label: np.ndarray      # index of the label of each region; -1: none
    inside: np.ndarray     # an interior point of each region, n x 3
    triangles: np.ndarray  # m x 3, oriented so that normals point out of `behind`
    behind: np.ndarray     # region behind each triangle, which has a label
    in_front: np.ndarray   # region in front of each triangle


# ---- Data of a surface -------------------------------------------------------------------------

def surface_labels(surface: Any) -> list[SurfaceLabel]:
    """Return the labels in the field data; empty if there are none."""
    fields = surface.GetFieldData()
    numbers, colors = fields.GetArray("Label"), fields.GetArray("LabelColor")
    names = fields.GetAbstractArray("LabelName")
    if numbers is None or names is None or colors is None:
        return []
    return [SurfaceLabel(int(numbers.GetTuple1(i)), names.GetValue(i), colors.GetTuple(i))
            for i in range(numbers.GetNumberOfTuples())]


def region_labels(surface: Any) -> list[SurfaceLabel]:
    """Return the labels of the regions that a surface bounds: several for interfaces, otherwise
    one. Numbers that are not positive are replaced by unused ones."""
    labels = surface_labels(surface)
    if not surface.GetCellData().HasArray("BoundaryLabels"):
        first = labels[0] if labels else SurfaceLabel(1, "object")
        labels = [first._replace(name=", ".join(label.name for label in labels) or first.name)]
    highest, found = max(0, *(label.number for label in labels), 0), []
    for label in labels:
        highest += label.number <= 0
        found.append(label if label.number > 0 else label._replace(number=highest))
    return found


def points_of(surface: Any) -> np.ndarray:
    """Return the points, n x 3, in VTK's memory."""
    return vtk_to_numpy(surface.GetPoints().GetData())


def triangles_of(surface: Any) -> np.ndarray:
    """Return the triangles, m x 3. Raise Failure if there are none, or other polygons."""
    polys = surface.GetPolys()
    count = polys.GetNumberOfCells()
    if count == 0:
        raise Failure("cannot be written (the surface is empty)")
    if polys.IsHomogeneous() != 3:
        raise Failure("cannot be written (the surface has polygons other than triangles)")
    return vtk_to_numpy(polys.GetConnectivityArray()).reshape(-1, 3).astype(np.int64)


def cell_array(surface: Any, name: str) -> np.ndarray | None:
    """Return the values of a cell array for the polygons, or None."""
    array = surface.GetCellData().GetArray(name)
    before = surface.GetNumberOfVerts() + surface.GetNumberOfLines()
    return None if array is None else vtk_to_numpy(array)[before:]


def labels_of_sides(surface: Any, count: int) -> np.ndarray:
    """Return the label index (-1: none) of sides 2 t (behind triangle t) and 2 t + 1 (in front)."""
    sides = cell_array(surface, "BoundaryLabels")
    if sides is None:
        return np.tile([0, -1], count)
    index = {label.number: i for i, label in enumerate(surface_labels(surface))}
    numbers, inverse = np.unique(sides, return_inverse=True)
    return np.array([index.get(int(number), -1) for number in numbers])[inverse.ravel()]


# ---- Shells ------------------------------------------------------------------------------------
# Sides that face each other across a wedge of an edge belong to the same region. Such sides form a
# shell: the outer boundary of a region, or the boundary of a cavity in it.

def find_shells(points: np.ndarray, triangles: np.ndarray, labels: np.ndarray) -> np.ndarray:
    """Return the shell of each side, numbered in the order of first sides."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components
    one, other = _joined_sides(points, triangles, labels)
    if (labels[one] != labels[other]).any():
        raise Failure("cannot be written (BoundaryLabels are inconsistent)")
    graph = coo_matrix((np.ones(len(one), bool), (one, other)), (len(labels),) * 2)
    shells = connected_components(graph, directed=False)[1]
    first, inverse = np.unique(shells, return_index=True, return_inverse=True)[1:]
    return np.argsort(np.argsort(first))[inverse]


def _joined_sides(points: np.ndarray, triangles: np.ndarray, labels: np.ndarray
                  ) -> tuple[np.ndarray, np.ndarray]:
    """Return pairs of sides that face each other across a wedge of an edge."""
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
        axis, spoke = points[high[at]] - origin, points[opposite[at]] - origin
        index, group = np.unique(edge[several], return_index=True, return_inverse=True)[1:]
        y = np.cross(axis, spoke[index][group])
        x = np.cross(y, axis)
        angle = np.arctan2((spoke * y).sum(1) * np.linalg.norm(axis, axis=1), (spoke * x).sum(1))
        order[several] = at[np.lexsort((angle, edge[several]))]
    # Around the edge, side `coming` of a triangle precedes side `leaving`.
    following = np.append(np.arange(1, len(order)), 0)
    following[firsts + sizes - 1] = firsts
    coming, leaving = (2 * owner + ~upwards)[order], (2 * owner + upwards)[order]
    one, other = leaving, coming[following]
    if len(several):
        # Two sides with the same label at an edge face each other. Angles, which are subject to
        # rounding errors, are then not required.
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
    """Return the solid angle of triangles (m x 3 x 3) at a point: 4 pi inside a closed surface."""
    to = corners - point
    distances = np.linalg.norm(to, axis=2)
    a, b, c = np.moveaxis(to, 1, 0)
    below = (distances.prod(1) + (a * b).sum(1) * distances[:, 2] + (b * c).sum(1) * distances[:, 0]
             + (c * a).sum(1) * distances[:, 1])
    return float(2 * np.arctan2((a * np.cross(b, c)).sum(1), below).sum())


def find_regions(surface: Any) -> Regions:
    """Return the regions of the output `Interfaces` of vtkLabelsToSurfaces, or of a closed surface.
    Raise Failure, without a file name, if the triangles do not separate regions."""
    points = points_of(surface).astype(float)
    triangles, labels = triangles_of(surface), region_labels(surface)
    of_side = labels_of_sides(surface, len(triangles))
    shell = find_shells(points, triangles, of_side)
    # Side 2 t + 1 has the reversed order of corners.
    sides = points[np.stack([triangles, triangles[:, [0, 2, 1]]], axis=1).reshape(-1, 3)]
    region = _regions_of_shells(sides, shell, of_side, labels)[shell]
    label = np.full(region.max() + 1, -1)
    label[region] = of_side
    label[0] = -1
    rank = np.arange(len(label)) + (label < 0) * len(label)  # labels first
    turned = rank[region[1::2]] < rank[region[::2]]
    behind, in_front = np.where(turned, region.reshape(-1, 2).T[::-1], region.reshape(-1, 2).T)
    triangles = np.where(turned[:, None], triangles[:, [0, 2, 1]], triangles)
    order = np.argsort(region, kind="stable")
    parts = np.split(order, np.searchsorted(region[order], np.arange(1, len(label))))
    inside = np.array([np.zeros(3)] + [_point_inside(sides[part]) for part in parts[1:]])
    return Regions(labels, label, inside, triangles, behind, in_front)


def _regions_of_shells(sides: np.ndarray, shell: np.ndarray, of_side: np.ndarray,
                       labels: list[SurfaceLabel]) -> np.ndarray:
    """Return the region of each shell. Cavities belong to the region of their outer shell."""
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
            raise Failure("cannot be written (the triangles do not enclose "
                          f"{labels[label[cavity]].name})")
        regions[cavity] = regions[found[0]] if found else 0
    return regions


def _point_inside(sides: np.ndarray) -> np.ndarray:
    """Return an interior point of a region: the midpoint of a long ray from the centre of a side to
    the next side, verified by the solid angle."""
    own = np.arange(0, len(sides), max(len(sides) // MAXIMUM_TRIES, 1))
    starts = sides[own].mean(axis=1)
    inward = np.cross(sides[own, 2] - sides[own, 0], sides[own, 1] - sides[own, 0])
    rays = np.array([_ray_length(sides, *ray) for ray in zip(starts, inward, own)])
    lengths = np.where(np.isfinite(rays), rays, 0) * np.linalg.norm(inward, axis=1)
    for i in np.argsort(-lengths, kind="stable"):
        point = starts[i] + inward[i] * (rays[i] / 2)
        if lengths[i] > 0 and abs(solid_angle(sides, point) - 4 * np.pi) < 1e-3:
            return point
    raise Failure("cannot be written (a region is too thin to place a point in it)")


def _ray_length(sides: np.ndarray, start: np.ndarray, direction: np.ndarray, own: int) -> float:
    """Return the distance along a ray to the first other triangle, in lengths of `direction`."""
    border = 1e-9
    a, b = sides[:, 1] - sides[:, 0], sides[:, 2] - sides[:, 0]
    across, offset = np.cross(direction, b), start - sides[:, 0]
    turned = np.cross(offset, a)
    with np.errstate(divide="ignore", invalid="ignore"):
        u, v, t = np.stack([(offset * across).sum(1), turned @ direction, (b * turned).sum(1)]
                           ) / (a * across).sum(1)
        met = (u >= -border) & (v >= -border) & (u + v <= 1 + border) & (t > 0)
    met[own] = False
    return float(np.min(t[met], initial=np.inf))
