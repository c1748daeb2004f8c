# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The surface where its object leaves the volume (--ends): cut in planes a voxel within the
outermost voxels, and closed there by flat caps or left open."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from .cutting import Cutter, NotFlat, Plane, edges_of, normals_of, unmatched
from .errors import Failure

TRIES = 24        # cuts that are tried
FURTHER = 0.02    # in edge lengths: how much further inward each next one is
SMOOTHINGS = 3    # of the points within a cap
CLEARANCE = 0.6   # in edge lengths: of these points from the rim


def with_ends(surface: Any, image: Any, ends: str, warnings: list[str]) -> Any:
    """The surface (vtkPolyData) with ends: closed as it is, marked or open.

    Marked, it has the cell arrays `Cap`, the number of the cap from 1 or 0, and `BoxFace`, at
    which side of the image the cap is. Interfaces of labels with flat box faces have their caps
    there, one for each connected part of a label in a side. The surface stays as it is where all
    of it lies about the outermost voxels and where no flat caps close it; the latter is a warning.
    """
    if ends == "closed" or surface.GetNumberOfPolys() == 0:
        return surface
    from .writing.regions import cell_array, triangles_of
    triangles, box = triangles_of(surface), cell_array(surface, "BoxFace")
    if box is not None:
        source, sides = np.arange(len(triangles)), cell_array(surface, "BoundaryLabels")
        if ends == "open":
            made = _made(surface, triangles[box == 0], source[box == 0])
            if sides is None and (box == 0).any():
                from vtkmodules.vtkFiltersCore import vtkCleanPolyData
                clean = vtkCleanPolyData()  # leaves out points that no triangle has
                clean.PointMergingOff()
                clean.SetInputData(made)
                clean.Update()
                made = clean.GetOutput()
                recount(made)
            return made
        kinds = box.astype(int) if sides is None else box + 8 * sides.max(axis=1).astype(int)
        return _made(surface, triangles, source, {"Cap": _numbered(triangles, kinds * (box > 0))})
    found = _ended(surface, triangles, image, ends == "marked")
    sides = np.zeros(len(triangles), int)
    if found is None:
        warnings.append("its ends cannot be made flat: they stay as they are, and are not marked; "
                        "choose another part with --region"
                        + ("" if ends == "open" else ", or --ends open, which leaves them out"))
    elif len(found[0].triangles):
        cutter, triangles, sides = found
        made = _made(surface, triangles, cutter.source, {
            "Cap": _numbered(triangles, sides), "BoxFace": sides.astype(np.uint8)}
            if ends == "marked" else {}, cutter)
        recount(made)
        return made
    if ends == "open":
        return surface
    return _made(surface, triangles, np.arange(len(triangles)), {
        "Cap": sides.astype(np.int32), "BoxFace": sides.astype(np.uint8)})


def _numbered(triangles: np.ndarray, kinds: np.ndarray) -> np.ndarray:
    """A number from 1 for each connected part of triangles of a kind, in the order of the kinds;
    0 where that is 0."""
    chosen, numbers = np.flatnonzero(kinds), np.zeros(len(triangles), np.int32)
    if len(chosen):
        edges = np.sort(edges_of(triangles[chosen]), axis=1)
        kind = np.repeat(kinds[chosen], 3)
        # Triangles and edges of a kind as the two sides of a graph.
        keys = np.unique(np.column_stack([kind, edges]), axis=0, return_inverse=True)[1].ravel()
        part = _parts(np.arange(len(keys)) // 3, len(chosen) + keys)[:len(chosen)]
        order = np.unique(np.column_stack([kinds[chosen], part]), axis=0, return_inverse=True)[1]
        numbers[chosen] = order.ravel() + 1
    return numbers


def _parts(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """The connected part of each node of a graph with these edges."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components
    size = max(one.max(initial=0), other.max(initial=0)) + 1
    graph = coo_matrix((np.ones(len(one), bool), (one, other)), (size, size))
    return connected_components(graph, directed=False)[1]


# ---- Cuts --------------------------------------------------------------------------------------

def _ended(surface: Any, triangles: np.ndarray, image: Any, closed: bool
           ) -> tuple[Cutter, np.ndarray, np.ndarray] | None:
    """The cut surface, its triangles, and the side that each is in, or 0; None if no cut is
    sound. A plane is tried again further inward."""
    from vtkmodules.util.numpy_support import vtk_to_numpy
    matrix = image.GetDirectionMatrix()
    turn = np.array([[matrix.GetElement(i, j) for j in range(3)] for i in range(3)])
    origin = np.array(image.GetOrigin())
    points = (vtk_to_numpy(surface.GetPoints().GetData()) - origin) @ turn
    arrays = surface.GetPointData()
    data = [vtk_to_numpy(arrays.GetArray(i)).reshape(len(points), -1).astype(float)
            for i in range(arrays.GetNumberOfArrays())]
    data = np.concatenate([np.zeros((len(points), 0)), *data], axis=1)
    bounds = np.array(image.GetExtent()) * np.repeat(image.GetSpacing(), 2)
    sides = [(axis, sign, bounds[2 * axis + (sign > 0)]) for axis in range(3) for sign in (-1, 1)]
    sides = [side for side in sides if (side[1] * (points[:, side[0]] - side[2]) > 0).any()]
    for number in range(TRIES):
        cutter = Cutter(points, data, triangles)
        push = number * FURTHER * cutter.length
        try:
            for axis, sign, bound in sides:
                plane = Plane(2 * axis + 1 + (sign > 0), axis, sign,
                              bound - sign * (image.GetSpacing()[axis] + push))
                cutter.snap(plane)
                cutter.cut(plane)
            cutter.collapse()
            cutter.refine()
            made, faces = _closed(cutter) if closed else (
                cutter.triangles, np.zeros(len(cutter.triangles), int))
        except NotFlat:
            continue
        size = len(points)
        same = np.zeros(len(cutter.points), bool)
        same[:size] = (cutter.points[:size] == points).all(axis=1)
        # What lies in a plane cannot cross what lies within it.
        walls = made[faces == 0]
        if not _crosses(cutter.points, walls, ~same[walls].all(axis=1)):
            cutter.points = origin + cutter.points @ turn.T
            cutter.points[:size][same[:size]] = vtk_to_numpy(surface.GetPoints().GetData())[
                same[:size]]
            return cutter, made, faces
    return None


def _closed(cutter: Cutter) -> tuple[np.ndarray, np.ndarray]:
    """All triangles with those of flat caps, and the side that each is in. Edges of rims that a
    Delaunay triangulation lacks are split."""
    from scipy.spatial import cKDTree
    caps: dict[int, tuple[int, _Cap]] = {}  # with the number of edges when it was made
    for _ in range(TRIES):
        missing = [np.zeros((0, 2), int)]
        for plane in cutter.planes:
            rims = cutter.rims[cutter.faces == plane.face]
            if len(rims) and caps.get(plane.face, (0,))[0] != len(rims):
                caps[plane.face] = len(rims), _cap(cutter, plane, rims)
                missing.append(caps[plane.face][1].missing)
        if not any(map(len, missing)):
            break
        cutter.split(np.concatenate(missing))
    else:
        raise NotFlat
    triangles, faces = [cutter.triangles], [np.zeros(len(cutter.triangles), int)]
    for face, (_, cap) in caps.items():
        added = len(cutter.points)
        near = cap.rim[cKDTree(cutter.points[cap.rim]).query(cap.inner)[1]]
        cutter.add_points(near, near, np.zeros(len(near)))
        cutter.points[added:] = cap.inner
        triangles.append(np.append(cap.rim, added + np.arange(len(near)))[cap.triangles])
        faces.append(np.full(len(cap.triangles), face))
        cutter.source = np.append(cutter.source, np.full(len(cap.triangles), -1))
    result = np.concatenate(triangles)
    if unmatched(edges_of(result)).any():
        raise NotFlat
    return result, np.concatenate(faces)


class _Cap(NamedTuple):
    """The caps in a plane, or the edges of their rims that triangles lack."""
    rim: np.ndarray        # numbers of vertices
    inner: np.ndarray      # positions of further points
    triangles: np.ndarray  # of the rim, then the inner points
    missing: np.ndarray


def _cap(cutter: Cutter, plane: Plane, rims: np.ndarray) -> _Cap:
    """Fill rims with triangles that have edges as long as the surface."""
    from scipy.spatial import cKDTree
    across = [(plane.axis + 1) % 3, (plane.axis + 2) % 3][::plane.sign]
    used, edges = np.unique(rims, return_inverse=True)
    edges, rim, step = edges.reshape(-1, 2), cutter.points[used][:, across], cutter.length
    inner = np.zeros((0, 2))
    triangles, missing, inside = _fill(rim, edges, inner)
    if inside:
        (low_x, low_y), (high_x, high_y) = rim.min(0), rim.max(0)
        x, y = np.meshgrid(np.arange(low_x, high_x, step),
                           np.arange(low_y, high_y, step * 0.75 ** 0.5))
        x[1::2] += step / 2
        inner = np.stack([x.ravel(), y.ravel()], axis=1)
        inner = inner[inside(inner)]
        far = cKDTree(np.concatenate([rim, rim[edges].mean(axis=1)])).query(inner)[0]
        inner = inner[far > CLEARANCE * step]
    for smoothing in range(SMOOTHINGS + 1 if len(inner) else 0):
        triangles, missing, inside = _fill(rim, edges, inner)
        if not inside:
            break
        kept = np.unique(triangles)
        kept = kept[kept >= len(rim)]
        numbers = np.append(np.arange(len(rim)), np.zeros(len(inner), int))
        numbers[kept] = len(rim) + np.arange(len(kept))
        triangles, inner = numbers[triangles], inner[kept - len(rim)]
        if smoothing < SMOOTHINGS:
            places, own = np.concatenate([rim, inner]), edges_of(triangles)
            sums = [np.bincount(own[:, 0], values[own[:, 1]]) for values in places.T]
            inner = (np.stack(sums, axis=1) / np.bincount(own[:, 0])[:, None])[len(rim):]
    points = np.full((len(inner), 3), plane.position)
    points[:, across] = inner
    return _Cap(used, points, triangles, rims[missing])


def _fill(rim: np.ndarray, edges: np.ndarray, inner: np.ndarray
          ) -> tuple[np.ndarray, np.ndarray, Callable[[np.ndarray], np.ndarray] | None]:
    """The Delaunay triangles of points within polygons, which lie to the left of their edges; the
    numbers of edges that are missing; and, if none is, a function whether points are inside."""
    from scipy.spatial import Delaunay
    low, high = rim.min(0), rim.max(0)
    turn = np.linspace(0, 2 * np.pi, 16, endpoint=False)
    frame = 2 * np.linalg.norm(high - low) * np.stack([np.cos(turn), np.sin(turn)], 1)
    places = np.concatenate([rim, inner, frame + (low + high) / 2]) - low
    delaunay = Delaunay(places, qhull_options="QJ Qbb Q12")
    triangles, size = delaunay.simplices.astype(int), len(places)
    own = edges_of(triangles)
    keys, back, wanted = own @ (size, 1), own @ (1, size), edges @ (size, 1)
    missing = np.flatnonzero(~np.isin(wanted, keys))
    if len(missing):
        return triangles, missing, None
    of_rim, opposite = np.isin(keys, wanted), np.isin(back, wanted)
    order = np.argsort(keys)
    at = order[np.minimum(np.searchsorted(keys[order], back), len(keys) - 1)]
    free = np.flatnonzero((keys[at] == back) & ~of_rim & ~opposite)
    last = len(triangles) - 1
    part = _parts(np.append(free // 3, last), np.append(at[free] // 3, last))
    chosen = np.isin(part, part[np.flatnonzero(of_rim) // 3])
    if chosen[np.flatnonzero(opposite) // 3].any() or triangles[chosen].max() >= size - len(frame):
        raise NotFlat
    return triangles[chosen], missing, lambda points: chosen[delaunay.find_simplex(points - low)]


def _crosses(points: np.ndarray, triangles: np.ndarray, changed: np.ndarray) -> bool:
    """Whether an edge passes through a triangle where one of the two has changed."""
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

def _made(surface: Any, triangles: np.ndarray, source: np.ndarray,
          marks: dict[str, np.ndarray] | None = None, cutter: Cutter | None = None) -> Any:
    """A surface of triangles, each with the cell data of a polygon of the former one (-1: that of
    its component), and of the points of the cutter that these have. Lines stay."""
    from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
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
        part = _parts(*edges_of(triangles).T)[triangles[:, 0]]
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


def recount(surface: Any) -> None:
    """Set the field and cell data that count and measure the surface: components (the largest area
    first), genus, area, volume, ... An open surface has no volume and what belongs to it."""
    from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
    from .writing.regions import find_regions, triangles_of
    points = vtk_to_numpy(surface.GetPoints().GetData()).astype(float)
    triangles = triangles_of(surface)
    edges = edges_of(triangles)
    part = _parts(*edges.T)
    double = np.linalg.norm(normals_of(points, triangles), axis=1)
    area = np.bincount(part[triangles[:, 0]], double / 2)
    order = np.argsort(-area, kind="stable")
    part = np.argsort(order)[part]
    of, count = part[triangles[:, 0]], len(area)
    rims = edges[unmatched(edges)]
    loops = _parts(*rims.T)
    loops = np.unique(np.stack([part[rims[:, 0]], loops[rims[:, 0]]], 1), axis=0)[:, 0]
    euler = (np.bincount(part, minlength=count) + np.bincount(of)
             - (3 * np.bincount(of) + np.bincount(part[rims[:, 0]], minlength=count)) // 2)
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
    if len(rims) == 0 and (volume < 0).any():
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
    solid = ("Volume", "ComponentVolume", "ComponentOwner", "ComponentCentroid", "ComponentInertia")
    cells = {"Component": of, **{name: np.asarray(whole[name])[of] for name in (
        "ComponentArea", "ComponentVolume", "ComponentGenus")}}
    for data, values in ((surface.GetFieldData(), whole), (surface.GetCellData(), cells)):
        for name, numbers in values.items():
            old = data.GetArray(name)
            if old is not None and len(rims) and name in solid:
                data.RemoveArray(name)
            elif old is not None:
                array = numpy_to_vtk(np.ascontiguousarray(numbers), deep=True,
                                     array_type=old.GetDataType())
                array.SetName(name)
                data.AddArray(array)
