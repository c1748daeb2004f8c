# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Ends of a surface where the object leaves the volume (--ends): cut one voxel inside the outermost
voxels, and closed by planar caps or left open."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy

from .cutting import Cutter, NotFlat, Plane, edges_of, normals_of, unmatched
from .errors import Failure
from .writing.regions import cell_array, find_regions, points_of, triangles_of

MAXIMUM_TRIES = 24
STEP = 0.02          # inward distance between two attempts, in edge lengths
SMOOTHING_STEPS = 3  # for points inside a cap
CLEARANCE = 0.6      # of these points from the boundary, in edge lengths


def with_ends(surface: Any, image: Any, ends: str, warnings: list[str]) -> Any:
    """Return a surface with ends: `closed` (unchanged), `marked` or `open`.

    Marked surfaces have the cell arrays `Cap` (number of the cap from 1, otherwise 0) and `BoxFace`
    (face of the image). Interfaces of labels with flat box faces have their caps there, one for
    each connected part of a label in a face. The surface is returned unchanged if it does not reach
    the outermost voxels, or, with a warning, if no planar caps close it.
    """
    if ends == "closed" or surface.GetNumberOfPolys() == 0:
        return surface
    triangles, box = triangles_of(surface), cell_array(surface, "BoxFace")
    if box is not None:
        source, sides = np.arange(len(triangles)), cell_array(surface, "BoundaryLabels")
        if ends == "open":
            made = _make_surface(surface, triangles[box == 0], source[box == 0])
            if sides is None and (box == 0).any():
                from vtkmodules.vtkFiltersCore import vtkCleanPolyData
                clean = vtkCleanPolyData()  # removes unused points
                clean.PointMergingOff()
                clean.SetInputData(made)
                clean.Update()
                made = clean.GetOutput()
                update_measures(made)
            return made
        kinds = box.astype(int) if sides is None else box + 8 * sides.max(axis=1).astype(int)
        return _make_surface(surface, triangles, source,
                             {"Cap": _number_components(triangles, kinds * (box > 0))})
    found = _cut_ends(surface, triangles, image, ends == "marked")
    sides = np.zeros(len(triangles), int)
    if found is None:
        warnings.append("no planar cut of the ends was found; the ends are unchanged and not "
                        "marked; choose another part with --region"
                        + ("" if ends == "open" else ", or use --ends open"))
    elif len(found[0].triangles):
        cutter, triangles, sides = found
        made = _make_surface(surface, triangles, cutter.source, {
            "Cap": _number_components(triangles, sides), "BoxFace": sides.astype(np.uint8)}
            if ends == "marked" else {}, cutter)
        update_measures(made)
        return made
    if ends == "open":
        return surface
    return _make_surface(surface, triangles, np.arange(len(triangles)), {
        "Cap": sides.astype(np.int32), "BoxFace": sides.astype(np.uint8)})


def _number_components(triangles: np.ndarray, kinds: np.ndarray) -> np.ndarray:
    """Number connected triangles of equal kind from 1, ordered by kind; 0 for kind 0."""
    chosen, numbers = np.flatnonzero(kinds), np.zeros(len(triangles), np.int32)
    if len(chosen):
        edges = np.sort(edges_of(triangles[chosen]), axis=1)
        kind = np.repeat(kinds[chosen], 3)
        # Bipartite graph of triangles and edges of equal kind.
        keys = np.unique(np.column_stack([kind, edges]), axis=0, return_inverse=True)[1].ravel()
        part = _connected_components(np.arange(len(keys)) // 3, len(chosen) + keys)[:len(chosen)]
        order = np.unique(np.column_stack([kinds[chosen], part]), axis=0, return_inverse=True)[1]
        numbers[chosen] = order.ravel() + 1
    return numbers


def _connected_components(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Return the connected component of each node of a graph."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components
    size = max(one.max(initial=0), other.max(initial=0)) + 1
    graph = coo_matrix((np.ones(len(one), bool), (one, other)), (size, size))
    return connected_components(graph, directed=False)[1]


# ---- Cuts --------------------------------------------------------------------------------------

def _cut_ends(surface: Any, triangles: np.ndarray, image: Any, closed: bool
           ) -> tuple[Cutter, np.ndarray, np.ndarray] | None:
    """Return the cut surface, its triangles and the box face of each (0: none), or None if every
    attempt fails. Each attempt moves the planes further inward."""
    matrix = image.GetDirectionMatrix()
    turn = np.array([[matrix.GetElement(i, j) for j in range(3)] for i in range(3)])
    origin = np.array(image.GetOrigin())
    points = (points_of(surface) - origin) @ turn
    arrays = surface.GetPointData()
    data = [vtk_to_numpy(arrays.GetArray(i)).reshape(len(points), -1).astype(float)
            for i in range(arrays.GetNumberOfArrays())]
    data = np.concatenate([np.zeros((len(points), 0)), *data], axis=1)
    bounds = np.array(image.GetExtent()) * np.repeat(image.GetSpacing(), 2)
    sides = [(axis, sign, bounds[2 * axis + (sign > 0)]) for axis in range(3) for sign in (-1, 1)]
    sides = [side for side in sides if (side[1] * (points[:, side[0]] - side[2]) > 0).any()]
    for number in range(MAXIMUM_TRIES):
        cutter = Cutter(points, data, triangles)
        push = number * STEP * cutter.length
        try:
            for axis, sign, bound in sides:
                plane = Plane(2 * axis + 1 + (sign > 0), axis, sign,
                              bound - sign * (image.GetSpacing()[axis] + push))
                cutter.snap(plane)
                cutter.cut(plane)
            cutter.collapse()
            cutter.refine()
            made, faces = _close_caps(cutter) if closed else (
                cutter.triangles, np.zeros(len(cutter.triangles), int))
        except NotFlat:
            continue
        size = len(points)
        same = np.zeros(len(cutter.points), bool)
        same[:size] = (cutter.points[:size] == points).all(axis=1)
        # Caps cannot intersect the rest of the surface.
        walls = made[faces == 0]
        if not _intersects(cutter.points, walls, ~same[walls].all(axis=1)):
            cutter.points = origin + cutter.points @ turn.T
            cutter.points[:size][same[:size]] = points_of(surface)[same[:size]]
            return cutter, made, faces
    return None


def _close_caps(cutter: Cutter) -> tuple[np.ndarray, np.ndarray]:
    """Return all triangles, including planar caps, and the box face of each. Boundary edges missing
    from a Delaunay triangulation are split."""
    from scipy.spatial import cKDTree
    caps: dict[int, tuple[int, _Cap]] = {}  # with its number of edges
    for _ in range(MAXIMUM_TRIES):
        missing = [np.zeros((0, 2), int)]
        for plane in cutter.planes:
            loops = cutter.loops[cutter.faces == plane.face]
            if len(loops) and caps.get(plane.face, (0,))[0] != len(loops):
                caps[plane.face] = len(loops), _triangulate_cap(cutter, plane, loops)
                missing.append(caps[plane.face][1].missing)
        if not any(map(len, missing)):
            break
        cutter.split(np.concatenate(missing))
    else:
        raise NotFlat
    triangles, faces = [cutter.triangles], [np.zeros(len(cutter.triangles), int)]
    for face, (_, cap) in caps.items():
        added = len(cutter.points)
        near = cap.outer[cKDTree(cutter.points[cap.outer]).query(cap.inner)[1]]
        cutter.add_points(near, near, np.zeros(len(near)))
        cutter.points[added:] = cap.inner
        triangles.append(np.append(cap.outer, added + np.arange(len(near)))[cap.triangles])
        faces.append(np.full(len(cap.triangles), face))
        cutter.source = np.append(cutter.source, np.full(len(cap.triangles), -1))
    result = np.concatenate(triangles)
    if unmatched(edges_of(result)).any():
        raise NotFlat
    return result, np.concatenate(faces)


class _Cap(NamedTuple):
    """The caps in a plane, or the boundary edges that are missing from the triangulation."""
    outer: np.ndarray      # vertex indices
    inner: np.ndarray      # coordinates of interior points
    triangles: np.ndarray  # indices of outer, then inner
    missing: np.ndarray


def _triangulate_cap(cutter: Cutter, plane: Plane, loops: np.ndarray) -> _Cap:
    """Triangulate caps with the edge length of the surface."""
    from scipy.spatial import cKDTree
    across = [(plane.axis + 1) % 3, (plane.axis + 2) % 3][::plane.sign]
    used, edges = np.unique(loops, return_inverse=True)
    edges, outer, step = edges.reshape(-1, 2), cutter.points[used][:, across], cutter.length
    inner = np.zeros((0, 2))
    triangles, missing, inside = _triangulate_polygons(outer, edges, inner)
    if inside:
        (low_x, low_y), (high_x, high_y) = outer.min(0), outer.max(0)
        x, y = np.meshgrid(np.arange(low_x, high_x, step),
                           np.arange(low_y, high_y, step * 0.75 ** 0.5))
        x[1::2] += step / 2
        inner = np.stack([x.ravel(), y.ravel()], axis=1)
        inner = inner[inside(inner)]
        far = cKDTree(np.concatenate([outer, outer[edges].mean(axis=1)])).query(inner)[0]
        inner = inner[far > CLEARANCE * step]
    for smoothing in range(SMOOTHING_STEPS + 1 if len(inner) else 0):
        triangles, missing, inside = _triangulate_polygons(outer, edges, inner)
        if not inside:
            break
        kept = np.unique(triangles)
        kept = kept[kept >= len(outer)]
        numbers = np.append(np.arange(len(outer)), np.zeros(len(inner), int))
        numbers[kept] = len(outer) + np.arange(len(kept))
        triangles, inner = numbers[triangles], inner[kept - len(outer)]
        if smoothing < SMOOTHING_STEPS:
            positions, own = np.concatenate([outer, inner]), edges_of(triangles)
            sums = [np.bincount(own[:, 0], values[own[:, 1]]) for values in positions.T]
            inner = (np.stack(sums, axis=1) / np.bincount(own[:, 0])[:, None])[len(outer):]
    points = np.full((len(inner), 3), plane.position)
    points[:, across] = inner
    return _Cap(used, points, triangles, loops[missing])


def _triangulate_polygons(outer: np.ndarray, edges: np.ndarray, inner: np.ndarray
          ) -> tuple[np.ndarray, np.ndarray, Callable[[np.ndarray], np.ndarray] | None]:
    """Return the Delaunay triangles in polygons, which lie to the left of their edges, the indices
    of edges that the triangulation lacks, and, if there are none, a function that returns whether
    points are inside."""
    from scipy.spatial import Delaunay
    low, high = outer.min(0), outer.max(0)
    turn = np.linspace(0, 2 * np.pi, 16, endpoint=False)
    frame = 2 * np.linalg.norm(high - low) * np.stack([np.cos(turn), np.sin(turn)], 1)
    positions = np.concatenate([outer, inner, frame + (low + high) / 2]) - low
    delaunay = Delaunay(positions, qhull_options="QJ Qbb Q12")
    triangles, size = delaunay.simplices.astype(int), len(positions)
    own = edges_of(triangles)
    keys, back, required = own @ (size, 1), own @ (1, size), edges @ (size, 1)
    missing = np.flatnonzero(~np.isin(required, keys))
    if len(missing):
        return triangles, missing, None
    is_boundary, opposite = np.isin(keys, required), np.isin(back, required)
    order = np.argsort(keys)
    at = order[np.minimum(np.searchsorted(keys[order], back), len(keys) - 1)]
    free = np.flatnonzero((keys[at] == back) & ~is_boundary & ~opposite)
    last = len(triangles) - 1
    part = _connected_components(np.append(free // 3, last), np.append(at[free] // 3, last))
    chosen = np.isin(part, part[np.flatnonzero(is_boundary) // 3])
    if chosen[np.flatnonzero(opposite) // 3].any() or triangles[chosen].max() >= size - len(frame):
        raise NotFlat
    return triangles[chosen], missing, lambda points: chosen[delaunay.find_simplex(points - low)]


def _intersects(points: np.ndarray, triangles: np.ndarray, changed: np.ndarray) -> bool:
    """Return whether an edge intersects a triangle and one of the two has changed."""
    from scipy.spatial import cKDTree
    corners = points[triangles]
    center = corners.mean(axis=1)
    far = np.linalg.norm(corners - center[:, None], axis=2).max(axis=1)
    chosen = np.flatnonzero(changed)
    pairs = cKDTree(center[chosen]).sparse_distance_matrix(
        cKDTree(center), far[chosen].max(initial=0) + far.max(initial=0), output_type="ndarray")
    one, other = chosen[pairs["i"]], pairs["j"]
    close = (pairs["v"] < far[one] + far[other]) & (one != other)
    one, other = np.append(one[close], other[close]), np.append(other[close], one[close])

    def volume(*ends: np.ndarray) -> np.ndarray:
        a, b, c, d = ends
        return ((b - a) * np.cross(c - a, d - a)).sum(1)

    for i in range(3):
        a, b = triangles[one, i], triangles[one, (i + 1) % 3]
        apart = ((triangles[other] != a[:, None]) & (triangles[other] != b[:, None])).all(axis=1)
        p, q = points[a[apart]], points[b[apart]]
        x, y, z = np.moveaxis(corners[other[apart]], 1, 0)
        passes = [volume(p, q, x, y) > 0, volume(p, q, y, z) > 0, volume(p, q, z, x) > 0]
        if ((np.all(passes, axis=0) | ~np.any(passes, axis=0))
                & (volume(x, y, z, p) * volume(x, y, z, q) < 0)).any():
            return True
    return False


# ---- Results -----------------------------------------------------------------------------------

def _make_surface(surface: Any, triangles: np.ndarray, source: np.ndarray,
                  marks: dict[str, np.ndarray] | None = None, cutter: Cutter | None = None) -> Any:
    """Return a surface of new triangles. `source` is the polygon whose cell data a triangle gets
    (-1: those of its component). Points are those of the cutter, if any. Lines are kept."""
    from vtkmodules.vtkCommonCore import vtkPoints
    from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
    made, cells, points = vtkPolyData(), vtkCellArray(), vtkPoints()

    def add(data: Any, name: str, values: np.ndarray) -> Any:
        array = numpy_to_vtk(np.ascontiguousarray(values), deep=True)
        array.SetName(name)
        data.AddArray(array)
        return array

    made.GetFieldData().ShallowCopy(surface.GetFieldData())
    if cutter is None:
        made.SetPoints(surface.GetPoints())
        made.SetLines(surface.GetLines())
        made.GetPointData().ShallowCopy(surface.GetPointData())
    else:
        part = _connected_components(*edges_of(triangles).T)[triangles[:, 0]]
        first = np.zeros(part.max() + 1, int)
        first[part[::-1]] = np.where(source < 0, 0, source)[::-1]
        source = np.where(source < 0, first[part], source)
        used, triangles = np.unique(triangles, return_inverse=True)
        points.SetData(numpy_to_vtk(np.ascontiguousarray(cutter.points[used]), deep=True))
        made.SetPoints(points)
        arrays, column = surface.GetPointData(), 0
        for i in range(arrays.GetNumberOfArrays()):
            old = arrays.GetArray(i)
            width, kind = old.GetNumberOfComponents(), vtk_to_numpy(old).dtype
            values = cutter.data[used, column:column + width]
            values = values.astype(kind) if kind.kind == "f" else np.rint(values).astype(kind)
            add(made.GetPointData(), old.GetName(), values[:, 0] if width == 1 else values)
            column += width
        if arrays.GetNormals():
            made.GetPointData().SetActiveNormals(arrays.GetNormals().GetName())
    cells.SetData(3, numpy_to_vtkIdTypeArray(triangles.ravel().astype(np.int64), deep=True))
    made.SetPolys(cells)
    lines = made.GetNumberOfLines()
    rows = np.append(np.arange(lines), lines + source)
    for i in range(surface.GetCellData().GetNumberOfArrays()):
        old = surface.GetCellData().GetArray(i)
        add(made.GetCellData(), old.GetName(), vtk_to_numpy(old)[rows])
    for name, values in (marks or {}).items():
        add(made.GetCellData(), name, np.append(np.zeros(lines, values.dtype), values))
    return made


def update_measures(surface: Any) -> None:
    """Update field and cell data that describe components (largest area first), genus, area and
    volume. An open surface loses its volume and the arrays that depend on it."""
    points = points_of(surface).astype(float)
    triangles = triangles_of(surface)
    edges = edges_of(triangles)
    part = _connected_components(*edges.T)
    double = np.linalg.norm(normals_of(points, triangles), axis=1)
    area = np.bincount(part[triangles[:, 0]], double / 2)
    order = np.argsort(-area, kind="stable")
    part = np.argsort(order)[part]
    of, count = part[triangles[:, 0]], len(area)
    border = edges[unmatched(edges)]
    loops = _connected_components(*border.T)
    loops = np.unique(np.stack([part[border[:, 0]], loops[border[:, 0]]], 1), axis=0)[:, 0]
    euler = (np.bincount(part, minlength=count) + np.bincount(of)
             - (3 * np.bincount(of) + np.bincount(part[border[:, 0]], minlength=count)) // 2)
    genus = (2 - euler - np.bincount(loops, minlength=count)) // 2
    a, b, c = np.moveaxis(points[triangles] - points.mean(0), 1, 0)
    six = (a * np.cross(b, c)).sum(1)
    volume = np.bincount(of, six / 6)
    sums = np.stack([np.bincount(of, six * column / 24) for column in (a + b + c).T], axis=1)
    center = sums / volume[:, None]
    # Second moments about the centroid: xx, yy, zz, xy, yz, xz.
    moments = np.stack([np.bincount(of, six / 120 * sum(
        p[:, i] * p[:, j] for p in (a, b, c, a + b + c))) - volume * center[:, i] * center[:, j]
        for i, j in ((0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2))], axis=1)
    inertia = -moments
    inertia[:, :3] += moments[:, :3].sum(axis=1, keepdims=True)
    owner = np.arange(count)
    if len(border) == 0 and (volume < 0).any():
        try:
            region = np.zeros(count, int)
            region[of] = find_regions(surface).behind
            about = {region[i]: i for i in range(count) if volume[i] > 0}
            owner = np.array([about.get(number, -1) for number in region])
        except Failure:
            owner[volume < 0] = -1
    whole = {"NumberOfComponents": [count], "EulerCharacteristic": [euler.sum()],
             "Genus": [genus.sum()], "Area": [area.sum()], "Volume": [volume.sum()],
             "ComponentArea": area[order], "ComponentVolume": volume, "ComponentGenus": genus,
             "ComponentOwner": owner, "ComponentCentroid": center + points.mean(0),
             "ComponentInertia": inertia}
    closed_only = ("Volume", "ComponentVolume", "ComponentOwner", "ComponentCentroid",
                   "ComponentInertia")
    cells = {"Component": of, **{name: np.asarray(whole[name])[of] for name in (
        "ComponentArea", "ComponentVolume", "ComponentGenus")}}
    for data, values in ((surface.GetFieldData(), whole), (surface.GetCellData(), cells)):
        for name, numbers in values.items():
            old = data.GetArray(name)
            if old is not None and len(border) and name in closed_only:
                data.RemoveArray(name)
            elif old is not None:
                array = numpy_to_vtk(np.ascontiguousarray(numbers), deep=True,
                                     array_type=old.GetDataType())
                array.SetName(name)
                data.AddArray(array)
