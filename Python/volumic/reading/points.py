# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Points and surfaces as inputs of the segmentation, as vtkPolyData."""
from __future__ import annotations

import os
import re

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkCharArray, vtkPoints
from vtkmodules.vtkCommonDataModel import vtkPolyData

from ..errors import VolumeError
from .volume import prefix_errors, require_file
from .vtkxml import XmlFile
from .worker import in_worker


def read_seeds(path):
    """Return the points of a mesh, or of lines of three numbers, as vertices."""
    return _vertices(path, 3)


def read_attracting_points(path):
    """Return points with arrays Weight and Radius. A text has columns x, y, z, weight, radius."""
    return _vertices(path, 5)


def read_surface(path):
    """Return the polygons of a mesh, with equal points merged."""
    from vtkmodules.vtkFiltersCore import vtkCleanPolyData
    clean = vtkCleanPolyData()
    with prefix_errors(path):
        clean.SetInputData(_mesh(path))
        clean.SetTolerance(0.)
        clean.Update()
        if not clean.GetOutput().GetNumberOfPolys():
            raise VolumeError("the file has no polygons")
    return clean.GetOutput()


def _vertices(path, columns):
    """Return the points of a text or mesh as vertices; with five columns also their arrays."""
    from vtkmodules.vtkFiltersGeneral import vtkVertexGlyphFilter
    is_text = os.path.splitext(path)[1].lower() in (".txt", ".csv", ".xyz")
    with prefix_errors(path):
        require_file(path)
        found = _text_points(path, columns) if is_text else _mesh(path)
        if not found.GetNumberOfPoints():
            raise VolumeError("the file has no points")
    points, vertices = vtkPolyData(), vtkVertexGlyphFilter()
    points.SetPoints(found.GetPoints())
    if columns == 5:
        points.GetPointData().ShallowCopy(found.GetPointData())
    vertices.SetInputData(points)
    vertices.Update()
    return vertices.GetOutput()


def _text_points(path, columns):
    """Return points from lines of numbers separated by blanks or commas; # starts a comment."""
    rows, is_first = [], True
    with open(path, encoding="utf-8-sig", errors="replace") as lines:
        for number, line in enumerate(lines, 1):
            words = line.partition("#")[0].replace(",", " ").split()
            is_heading = is_first and all(re.match(r"\"?(?!nan|inf)[a-z]", w, re.I) for w in words)
            is_first = is_first and not words
            if is_heading or not words:
                continue
            row = []
            for word in words:
                try:
                    row.append(float(word))
                except ValueError:
                    row.append(np.nan)
                if not np.isfinite(row[-1]):
                    raise VolumeError("line %d: '%s' is not a number" % (number, word))
            if not 3 <= len(row) <= columns:
                raise VolumeError("line %d: expected three %snumbers"
                                  % (number, "" if columns == 3 else "to five "))
            rows.append(row + [0, 0, 0, 1, 0][len(row):])
    table, result, points = np.array(rows, float).reshape(-1, 5), vtkPolyData(), vtkPoints()
    points.SetData(numpy_to_vtk(np.ascontiguousarray(table[:, :3]), deep=True))
    result.SetPoints(points)
    for column, name in ((3, "Weight"), (4, "Radius")):
        array = numpy_to_vtk(np.ascontiguousarray(table[:, column]), deep=True)
        array.SetName(name)
        result.GetPointData().AddArray(array)
    return result


def _mesh(path):
    """Return the vtkPolyData of a file, read in a worker, as VTK crashes on damaged files."""
    from vtkmodules.vtkParallelCore import vtkCommunicator
    require_file(path)
    if not os.path.exists(path):
        raise VolumeError("no such file; check its name")
    content, mesh = in_worker("volumic.reading.points:load", path), vtkPolyData()
    vtkCommunicator.UnMarshalDataObject(numpy_to_vtk(content, array_type=2), mesh)  # 2: char
    return mesh


def load(path):
    """Return a validated mesh, serialized by VTK, in the worker."""
    from vtkmodules.vtkIOLegacy import vtkPolyDataReader
    from vtkmodules.vtkIOGeometry import vtkOBJReader, vtkSTLReader
    from vtkmodules.vtkIOPLY import vtkPLYReader
    from vtkmodules.vtkIOXML import vtkXMLPolyDataReader
    from vtkmodules.vtkParallelCore import vtkCommunicator
    from .vtkfiles import updated
    readers = {".vtp": (vtkXMLPolyDataReader, _check_vtp), ".stl": (vtkSTLReader, _count_stl),
               ".ply": (vtkPLYReader, _count_ply), ".obj": (vtkOBJReader, None),
               ".vtk": (vtkPolyDataReader, None)}
    suffix = os.path.splitext(path)[1].lower()
    if suffix not in readers:
        raise VolumeError("unknown mesh format; use one of " + " ".join(readers))
    reader, count = readers[suffix]
    expected = count(path) if count else None
    mesh = updated(reader(), path)
    points = vtk_to_numpy(mesh.GetPoints().GetData())
    if not np.isfinite(points).all():
        raise VolumeError("the file is damaged: a point is not finite")
    for cells in (mesh.GetVerts(), mesh.GetLines(), mesh.GetPolys(), mesh.GetStrips()):
        offsets, corners = (vtk_to_numpy(array).astype(np.int64) for array in (
            cells.GetOffsetsArray(), cells.GetConnectivityArray()))
        if len(offsets) and (offsets[-1] != len(corners) or (np.diff(offsets) < 0).any()):
            raise VolumeError("the file is damaged: cell offsets are inconsistent")
        if len(corners) and not 0 <= corners.min() <= corners.max() < len(points):
            raise VolumeError("the file is damaged: a cell has point %d of %d points" % (
                corners.min() if corners.min() < 0 else corners.max(), len(points)))
    if expected is not None and mesh.GetNumberOfPolys() != expected:
        raise VolumeError("the file is truncated or damaged: it has %d polygons, its header "
                          "requires %d" % (mesh.GetNumberOfPolys(), expected))
    content = vtkCharArray()
    vtkCommunicator.MarshalDataObject(mesh, content)
    return np.array(vtk_to_numpy(content))


def _check_vtp(path):
    """Decode all arrays, as VTK fills truncated ones with zeros. Return the number of polygons."""
    file = XmlFile(path)
    if file.kind != "PolyData" or not file.pieces:
        raise VolumeError("the file has %s, not a surface" % (file.kind or "no VTK data"))
    sizes = {"Points": "NumberOfPoints", "PointData": "NumberOfPoints"}
    for array in file.arrays:
        count = None
        if array["parent"] in sizes and array["piece"] >= 0:
            count = int(file.pieces[array["piece"]][sizes[array["parent"]]])
            count *= int(array.get("NumberOfComponents", 1))
        file.read(array, count)
    return sum(int(piece.get("NumberOfPolys", 0)) for piece in file.pieces)


def _count_stl(path):
    """Return the number of triangles of a binary STL file; None for text."""
    size = os.path.getsize(path)
    with open(path, "rb") as stream:
        head = stream.read(84)
    if size < 84 or re.fullmatch(rb"[\x20-\xff\r\n\t]*", head) and head[:5] == b"solid":
        return None
    triangles = int.from_bytes(head[80:], "little")
    if size < 84 + 50 * triangles:
        raise VolumeError("the file is truncated: it has %d bytes, its header requires %d"
                          % (size, 84 + 50 * triangles))
    return triangles


def _count_ply(path):
    """Return the number of faces of a PLY file. VTK's reader does not detect truncated files."""
    with open(path, "rb") as stream:
        head, end, body = stream.read().partition(b"end_header")
    body = body[body.find(b"\n") + 1:]
    elements = re.findall(rb"(?m)^element +(\w+) +(\d+)", head)
    if not end or [name for name, _ in elements] != [b"vertex", b"face"]:
        raise VolumeError("no points, or invalid header: a surface has the elements vertex and "
                          "face")
    vertices, faces = (int(count) for _, count in elements)
    widths = {b"char": 1, b"int8": 1, b"short": 2, b"int16": 2, b"double": 8, b"float64": 8}
    kinds = re.findall(rb"(?m)^property +u?(?!list)(\w+)", head.partition(b"element face")[0])
    need, have = vertices * sum(widths.get(kind, 4) for kind in kinds) + 13 * faces, len(body)
    if b"format ascii" in head:
        need, have = vertices + faces, len(body.splitlines())
    if have < need:
        raise VolumeError("the file is truncated: it is too short for %d vertices and %d faces"
                          % (vertices, faces))
    return faces
