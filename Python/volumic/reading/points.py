# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Points and surfaces that segmentation starts with, as vtkPolyData."""
from __future__ import annotations

import os
import re

import numpy as np

from ..errors import VolumeError
from .volume import failure_of
from .vtkfiles import updated
from .vtkxml import XmlFile
from .worker import in_worker

_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)(e[+-]?\d{1,2})?", re.I)
_SUFFIXES = (".vtp", ".vtk", ".stl", ".ply", ".obj")


def read_seeds(path):
    """Return the points of a mesh, or of lines of three numbers, as vertices."""
    points, _ = _named(path, lambda: _points_of(path, 3))
    return _poly_data(points, vertices=True)


def read_attracting_points(path):
    """Return points with their arrays; a text has the columns x, y, z, Weight, Radius."""
    return _poly_data(*_named(path, lambda: _points_of(path, 5)), vertices=True)


def read_surface(path):
    """Return the polygons of a mesh, whose equal points are merged."""
    from vtkmodules.vtkFiltersCore import vtkCleanPolyData
    mesh = _named(path, lambda: _mesh(path))
    if not len(mesh["offsets"]):
        raise VolumeError("%s: has no polygons" % path)
    clean = vtkCleanPolyData()
    clean.SetInputData(_poly_data(mesh["points"], {}, mesh))
    clean.SetTolerance(0.)
    clean.Update()
    return clean.GetOutput()


def _named(path, work):
    try:
        return work()
    except Exception as error:  # pylint: disable=broad-except
        raise VolumeError("%s: %s" % (path, failure_of(error))) from None


def _points_of(path, columns):
    """Return the points and arrays of a text or a mesh."""
    if os.path.splitext(path)[1].lower() in (".txt", ".csv", ".xyz"):
        points, arrays = _text_points(path, columns)
    else:
        mesh = _mesh(path)
        points, arrays = mesh["points"], mesh["arrays"]
    if not len(points):
        raise VolumeError("has no points")
    return points, arrays


def _text_points(path, columns):
    """Return the points of lines of numbers between blanks or commas; # begins a comment."""
    rows, is_first = [], True
    with open(path, encoding="utf-8-sig", errors="replace") as lines:
        for number, line in enumerate(lines, 1):
            words = line.partition("#")[0].replace(",", " ").split()
            names = [re.fullmatch(r"\"?(?!nan|inf)[a-z].*", word, re.I) for word in words]
            if not words or is_first and all(names):
                is_first = is_first and not words
                continue
            is_first = False
            try:
                wrong = [word for word in words if not _NUMBER.fullmatch(word)]
                if wrong:
                    raise ValueError("'%s' is not a number" % wrong[0])
                row = [float(word) for word in words]
                if not 3 <= len(row) <= columns:
                    raise ValueError("not three numbers" if columns == 3
                                     else "not three to five numbers")
            except ValueError as error:
                raise VolumeError("line %d: %s" % (number, error)) from None
            rows.append(row + [0, 0, 0, 1, 0][len(row):])
    table = np.array(rows, float).reshape(-1, 5)
    arrays = {"Weight": table[:, 3], "Radius": table[:, 4]} if columns == 5 else {}
    return table[:, :3], arrays


def _mesh(path):
    """Return points, arrays of points, offsets and connectivity of polygons, all checked."""
    suffix = os.path.splitext(path)[1].lower()
    if not os.path.exists(path):
        raise VolumeError("no such file")
    if suffix not in _SUFFIXES:
        raise VolumeError(".vtp, .vtk, .stl, .ply and .obj are read")
    mesh = _xml_mesh(path) if suffix == ".vtp" else in_worker("volumic.reading.points:load", path)
    count, points, offsets = len(mesh["points"]), mesh["connectivity"], mesh["offsets"]
    if not np.isfinite(mesh["points"]).all():
        raise VolumeError("is damaged: a point is not finite")
    if len(offsets) and (offsets[-1] != len(points) or (np.diff(offsets, prepend=0) < 0).any()):
        raise VolumeError("is damaged: its polygons overlap in the file")
    if len(points) and not 0 <= points.min() <= points.max() < count:
        raise VolumeError("is damaged: a polygon has point %d, there are %d"
                          % (points.min() if points.min() < 0 else points.max(), count))
    return mesh


def _xml_mesh(path):
    file = XmlFile(path)
    if file.kind != "PolyData" or len(file.pieces) != 1:
        raise VolumeError("it holds %s of %d pieces, and no surface"
                          % (file.kind or "no data of VTK", len(file.pieces)))
    piece = file.pieces[0]
    count, polygons = int(piece["NumberOfPoints"]), int(piece.get("NumberOfPolys", 0))
    mesh = {"arrays": {}, "offsets": np.zeros(0, int), "connectivity": np.zeros(0, int)}
    for array in file.arrays:
        name, width = array["name"], int(array.get("NumberOfComponents", 1))
        if array["parent"] == "Points":
            mesh["points"] = file.read(array, 3 * count).reshape(-1, 3)
        elif array["parent"] == "PointData" and array.get("type") != "String":
            mesh["arrays"][name] = file.read(array, width * count).reshape(-1, width)
        elif array["parent"] == "Polys" and name in ("offsets", "connectivity") and polygons:
            mesh[name] = file.read(array, polygons if name == "offsets" else None).astype(int)
    return mesh


def load(path):
    """Return what _mesh() does, in a worker: VTK's readers crash on some damaged files."""
    from vtkmodules.util.numpy_support import vtk_to_numpy
    suffix = os.path.splitext(path)[1].lower()
    expected = _count_ply(path) if suffix == ".ply" else _count_stl(path) if suffix == ".stl" else 0
    if suffix == ".vtk":
        from vtkmodules.vtkIOLegacy import vtkPolyDataReader as Reader
    elif suffix == ".ply":
        from vtkmodules.vtkIOPLY import vtkPLYReader as Reader
    elif suffix == ".stl":
        from vtkmodules.vtkIOGeometry import vtkSTLReader as Reader
    else:
        from vtkmodules.vtkIOGeometry import vtkOBJReader as Reader
    mesh = updated(Reader(), path)
    if expected and mesh.GetNumberOfPolys() != expected:
        raise VolumeError("the file is cut off or damaged: it has %d polygons, its header requires "
                          "%d" % (mesh.GetNumberOfPolys(), expected))
    data, polygons = mesh.GetPointData(), mesh.GetPolys()
    arrays = {data.GetArrayName(n) or "": vtk_to_numpy(data.GetArray(n))
              for n in range(data.GetNumberOfArrays()) if data.GetArray(n)}
    return {"points": vtk_to_numpy(mesh.GetPoints().GetData()), "arrays": arrays,
            "offsets": vtk_to_numpy(polygons.GetOffsetsArray()).astype(int)[1:],
            "connectivity": vtk_to_numpy(polygons.GetConnectivityArray()).astype(int)}


def _count_stl(path):
    """Check the size of a binary STL file."""
    size = os.path.getsize(path)
    with open(path, "rb") as stream:
        head = stream.read(256)
    is_text = re.fullmatch(rb"[\x20-\x7f\r\n\t]*", head[:84]) or size < 84
    triangles = 0 if is_text else int.from_bytes(head[80:84], "little")
    if size < 84 + 50 * triangles:
        raise VolumeError("the file is cut off: it has %d bytes, its header requires %d"
                          % (size, 84 + 50 * triangles))
    return triangles


def _count_ply(path):
    """Return the number of faces of a PLY file, whose header and size are checked."""
    with open(path, "rb") as stream:
        data = stream.read()
    head, end, body = data.partition(b"end_header")
    body = body[body.find(b"\n") + 1:]
    elements = re.findall(rb"(?m)^element +(\w+) +(\d+)", head)
    if not end or [name for name, _ in elements] != [b"vertex", b"face"]:
        raise VolumeError("has no points, or its header is damaged: a surface has the elements vertex "
                          "and face")
    vertices, faces = (int(count) for _, count in elements)
    kinds = re.findall(rb"(?m)^property +(?!list)(\w+)", head.partition(b"element face")[0])
    widths = {b"char": 1, b"uchar": 1, b"int8": 1, b"uint8": 1, b"short": 2, b"ushort": 2,
              b"int16": 2, b"uint16": 2, b"double": 8, b"float64": 8}
    need = vertices * sum(widths.get(kind, 4) for kind in kinds) + 13 * faces
    have = len(body)
    if b"format ascii" in head:
        need, have = vertices + faces, body.count(b"\n") + (not body.endswith(b"\n"))
    if have < need:
        raise VolumeError("the file is cut off: %d vertices and %d faces do not fit into it"
                          % (vertices, faces))
    return faces


def _poly_data(points, arrays=None, mesh=None, vertices=False):
    """Return points, their arrays, and polygons or vertices as vtkPolyData."""
    from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
    from vtkmodules.vtkCommonCore import vtkPoints
    from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData

    def cells_of(offsets, connectivity):
        cells = vtkCellArray()
        cells.SetData(*(numpy_to_vtkIdTypeArray(np.ascontiguousarray(a, np.int64), deep=True)
                        for a in (offsets, connectivity)))
        return cells

    result, own = vtkPolyData(), vtkPoints()
    points = np.array(points)
    own.SetData(numpy_to_vtk(points.astype(points.dtype.newbyteorder("=")), deep=True))
    result.SetPoints(own)
    for name, values in (arrays or {}).items():
        array = numpy_to_vtk(np.array(values, values.dtype.newbyteorder("=")), deep=True)
        array.SetName(name)
        result.GetPointData().AddArray(array)
    if vertices:
        result.SetVerts(cells_of(np.arange(len(points) + 1), np.arange(len(points))))
    elif mesh:
        result.SetPolys(cells_of(np.r_[0, mesh["offsets"]], mesh["connectivity"]))
    return result
