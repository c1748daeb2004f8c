# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Points and surfaces that segmentation starts with, as vtkPolyData."""
from __future__ import annotations

import os
import re

import numpy as np

from ..errors import VolumeError
from .volume import naming, need_file
from .vtkxml import XmlFile
from .worker import in_worker


def read_seeds(path):
    """Return the points of a mesh, or of lines of three numbers, as vertices."""
    return _vertices(path, 3)


def read_attracting_points(path):
    """Return points with their arrays; a text has the columns x, y, z, Weight, Radius."""
    return _vertices(path, 5)


def read_surface(path):
    """Return the polygons of a mesh, whose equal points are merged."""
    from vtkmodules.vtkFiltersCore import vtkCleanPolyData
    clean = vtkCleanPolyData()
    with naming(path):
        clean.SetInputData(_mesh(path))
        clean.SetTolerance(0.)
        clean.Update()
        if not clean.GetOutput().GetNumberOfPolys():
            raise VolumeError("has no polygons")
    return clean.GetOutput()


def _vertices(path, columns):
    """Return the points of a text or a mesh as vertices; with five columns, their arrays, too."""
    from vtkmodules.vtkCommonDataModel import vtkPolyData
    from vtkmodules.vtkFiltersGeneral import vtkVertexGlyphFilter
    is_text = os.path.splitext(path)[1].lower() in (".txt", ".csv", ".xyz")
    with naming(path):
        need_file(path)
        found = _text_points(path, columns) if is_text else _mesh(path)
        if not found.GetNumberOfPoints():
            raise VolumeError("has no points")
    points, vertices = vtkPolyData(), vtkVertexGlyphFilter()
    points.SetPoints(found.GetPoints())
    if columns == 5:
        points.GetPointData().ShallowCopy(found.GetPointData())
    vertices.SetInputData(points)
    vertices.Update()
    return vertices.GetOutput()


def _text_points(path, columns):
    """Return the points of lines of numbers between blanks or commas; # begins a comment."""
    from vtkmodules.util.numpy_support import numpy_to_vtk
    from vtkmodules.vtkCommonCore import vtkPoints
    from vtkmodules.vtkCommonDataModel import vtkPolyData
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
                raise VolumeError("line %d: not three %snumbers"
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
    """Return the vtkPolyData of a file. VTK's readers run in a worker: damaged files crash them."""
    from vtkmodules.util.numpy_support import numpy_to_vtk
    from vtkmodules.vtkCommonDataModel import vtkPolyData
    from vtkmodules.vtkParallelCore import vtkCommunicator
    need_file(path)
    if not os.path.exists(path):
        raise VolumeError("no such file")
    content, mesh = in_worker("volumic.reading.points:load", path), vtkPolyData()
    vtkCommunicator.UnMarshalDataObject(numpy_to_vtk(content, array_type=2), mesh)  # 2: char
    return mesh


def load(path):
    """Return a mesh, which is checked, as VTK serializes it."""
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkCommonCore import vtkCharArray
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
        raise VolumeError("is none of the meshes that are read: " + " ".join(readers))
    reader, count = readers[suffix]
    expected = count(path) if count else None
    mesh = updated(reader(), path)
    points = vtk_to_numpy(mesh.GetPoints().GetData())
    if not np.isfinite(points).all():
        raise VolumeError("is damaged: a point is not finite")
    for cells in (mesh.GetVerts(), mesh.GetLines(), mesh.GetPolys(), mesh.GetStrips()):
        offsets, corners = (vtk_to_numpy(array).astype(np.int64) for array in (
            cells.GetOffsetsArray(), cells.GetConnectivityArray()))
        if len(offsets) and (offsets[-1] != len(corners) or (np.diff(offsets) < 0).any()):
            raise VolumeError("is damaged: its cells overlap in the file")
        if len(corners) and not 0 <= corners.min() <= corners.max() < len(points):
            raise VolumeError("is damaged: a cell has point %d, there are %d" % (
                corners.min() if corners.min() < 0 else corners.max(), len(points)))
    if expected is not None and mesh.GetNumberOfPolys() != expected:
        raise VolumeError("the file is cut off or damaged: it has %d polygons, its header requires "
                          "%d" % (mesh.GetNumberOfPolys(), expected))
    content = vtkCharArray()
    vtkCommunicator.MarshalDataObject(mesh, content)
    return np.array(vtk_to_numpy(content))


def _check_vtp(path):
    """Decode all arrays: VTK's reader makes zeros of those that are too short."""
    file = XmlFile(path)
    if file.kind != "PolyData" or not file.pieces:
        raise VolumeError("it holds %s, and no surface" % (file.kind or "no data of VTK"))
    sizes = {"Points": "NumberOfPoints", "PointData": "NumberOfPoints"}
    for array in file.arrays:
        count = None
        if array["parent"] in sizes and array["piece"] >= 0:
            count = int(file.pieces[array["piece"]][sizes[array["parent"]]])
            count *= int(array.get("NumberOfComponents", 1))
        file.read(array, count)
    return sum(int(piece.get("NumberOfPolys", 0)) for piece in file.pieces)


def _count_stl(path):
    """Return the number of triangles of a binary STL file, or None of a text."""
    size = os.path.getsize(path)
    with open(path, "rb") as stream:
        head = stream.read(84)
    if size < 84 or re.fullmatch(rb"[\x20-\xff\r\n\t]*", head) and head[:5] == b"solid":
        return None
    triangles = int.from_bytes(head[80:], "little")
    if size < 84 + 50 * triangles:
        raise VolumeError("the file is cut off: it has %d bytes, its header requires %d"
                          % (size, 84 + 50 * triangles))
    return triangles


def _count_ply(path):
    """Return the number of faces of a PLY file; VTK's reader does not see that it is cut off."""
    with open(path, "rb") as stream:
        head, end, body = stream.read().partition(b"end_header")
    body = body[body.find(b"\n") + 1:]
    elements = re.findall(rb"(?m)^element +(\w+) +(\d+)", head)
    if not end or [name for name, _ in elements] != [b"vertex", b"face"]:
        raise VolumeError("has no points, or its header is damaged: a surface has the elements "
                          "vertex and face")
    vertices, faces = (int(count) for _, count in elements)
    widths = {b"char": 1, b"int8": 1, b"short": 2, b"int16": 2, b"double": 8, b"float64": 8}
    kinds = re.findall(rb"(?m)^property +u?(?!list)(\w+)", head.partition(b"element face")[0])
    need, have = vertices * sum(widths.get(kind, 4) for kind in kinds) + 13 * faces, len(body)
    if b"format ascii" in head:
        need, have = vertices + faces, len(body.splitlines())
    if have < need:
        raise VolumeError("the file is cut off: %d vertices and %d faces do not fit into it"
                          % (vertices, faces))
    return faces
