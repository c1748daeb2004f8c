# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Writers of surfaces (.vtp, .vtk, .stl, .ply, .obj) and of other VTK data (.vtm, .vti, .csv).

On a full disk, VTK's writers corrupt memory or fail silently. Here they write to memory, and Python
writes to the disk, which raises OSError.
"""

from __future__ import annotations

import html
import os
import re
from collections.abc import Callable, Iterable, Iterator
from typing import Any

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy

from ..errors import Failure
from ..messages import update
from .meshers import DistinctNames, cap_names
from .regions import cell_array, points_of, surface_labels, triangles_of

Show = Callable[[float], Any]         # progress, 0 to 1
Pack = Callable[[np.ndarray], bytes]  # from rows

CHUNK = 1 << 17  # points or triangles per chunk
SLAB = 1 << 29   # bytes of a volume per piece
# Point arrays that describe the fit. Others were requested by the user.
FIT_ARRAYS = {"Normals", "Residual", "Motionless", "Contact", "EdgeSize", "Junction", "GlobalIds"}
PLY_NAMES = ("x", "y", "z", "nx", "ny", "nz", "red", "green", "blue")  # reserved for properties


def silent(_: Any) -> None:
    """Ignore progress or a message."""


def packed(show: Show, *parts: tuple[Pack, np.ndarray]) -> Iterator[bytes]:
    """Yield the bytes of rows, one chunk at a time."""
    total, done = sum(len(rows) for _, rows in parts), 0
    for pack, rows in parts:
        for first in range(0, len(rows), CHUNK):
            show((done + first) / total)
            yield pack(rows[first:first + CHUNK])
        done += len(rows)


def lines(form: str) -> Pack:
    """Return a function that formats each row as a line."""
    return lambda rows: (form * len(rows) % tuple(rows.ravel().tolist())).encode()


# ---- Data of a surface -------------------------------------------------------------------------

def file_header(surface: Any, remark: str = "") -> str:
    """Return version, coordinate system, unit and `remark`, for the header of a file."""
    from .. import __version__
    from ..geometry import field_text
    space, unit = field_text(surface, "SPACE"), field_text(surface, "LengthUnit")
    return (f"volumic {__version__}" + f", SPACE={space}" * bool(space)
            + f", unit {unit}" * bool(unit) + remark)


def numbers(array: Any) -> Any:
    """Return the values of a VTK array, or None."""
    return None if array is None else vtk_to_numpy(array)


def bytes_of(color: Any) -> tuple[int, ...]:
    """Return a colour with components in 0..1 as bytes."""
    return tuple(np.floor(255 * np.clip(color, 0, 1) + 0.5).astype(int).tolist())


def _vertex_colors(surface: Any) -> np.ndarray | None:
    """Return the colour of the label of the first triangle of each point; None without labels."""
    labels = cell_array(surface, "Label")
    colors = {label.number: bytes_of(label.color) for label in surface_labels(surface)}
    if labels is None or not colors:
        return None
    values, index = np.unique(labels, return_inverse=True)
    palette = np.array([colors.get(value, (0, 0, 0)) for value in values.tolist()], "u1")
    found = np.zeros((surface.GetNumberOfPoints(), 3), "u1")
    # Reversed, so that the first triangle of a point is assigned last.
    found[triangles_of(surface)[::-1]] = palette[index.ravel()][::-1, None]
    return found


def _requested_values(surface: Any) -> dict[str, np.ndarray]:
    """Return the point arrays requested by the user (--probe, --thin-parts)."""
    data = surface.GetPointData()
    return {data.GetArrayName(i): numbers(data.GetArray(i))
            for i in range(data.GetNumberOfArrays()) if data.GetArrayName(i) not in FIT_ARRAYS}


def unsupported_data(surface: Any, suffix: str) -> Iterator[str]:
    """Yield descriptions of data that the format does not support: requested point arrays, numbers
    of caps, and coordinates that exceed single precision."""
    if suffix not in (".stl", ".ply", ".obj", ".glb", ".3mf"):
        return
    values, caps = _requested_values(surface), cell_array(surface, "Cap")
    if values and suffix != ".ply":
        yield (f"{suffix} does not support the point arrays {', '.join(sorted(values))}; use .vtp, "
               ".vtk or .ply")
    if caps is not None and caps.any() and suffix != ".stl":
        yield f"{suffix} does not support numbers of caps; use .vtp, .vtk or .stl"
    count, largest = surface.GetNumberOfPolys(), np.abs(surface.GetBounds()).max()
    # Edge length of this number of triangles on the bounding box.
    edge = 2 * surface.GetLength() / np.sqrt(count or 1)
    step = largest * np.finfo(np.float32).eps
    if count and step > 0.01 * edge:
        yield (f"coordinates up to {largest:.0f} are rounded to multiples of {step:.4g}, while "
               f"edges are about {edge:.4g} long; use .vtp, .vtk or .msh")


def vtp(surface: Any, _remark: str = "", show: Show = silent) -> Iterator[bytes]:
    """Yield VTK's XML format, with all arrays."""
    from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter
    writer = vtkXMLPolyDataWriter()
    writer.SetCompressorTypeToLZ4()  # 9 times as fast as zlib, 1.6 times the size
    yield xml_text(writer, surface, show)


def vtk(surface: Any, remark: str = "", show: Show = silent) -> Iterator[bytes]:
    """Yield VTK's legacy format, binary, with all arrays."""
    from vtkmodules.vtkIOLegacy import vtkPolyDataWriter
    writer = vtkPolyDataWriter()
    writer.SetHeader(remark.encode()[:255].decode("utf-8", "ignore"))  # maximum length
    writer.SetFileTypeToBinary()
    yield _text(writer, surface, show, "GetOutputStdString")


def stl(surface: Any, remark: str = "", show: Show = silent) -> Iterator[bytes]:
    """Yield binary STL, or with caps (--ends marked) text with a solid `wall` and one per cap."""
    triangles, points, caps = triangles_of(surface), points_of(surface), cell_array(surface, "Cap")

    def facets(some: np.ndarray) -> np.ndarray:
        """Return normals as VTK computes them (0 for degenerate triangles) and corners."""
        a, b, c = np.moveaxis(points[some].astype(float), 1, 0)
        normals = np.cross(c - b, a - b)
        length = np.linalg.norm(normals, axis=1, keepdims=True)
        return np.hstack([np.divide(normals, length, out=normals, where=length > 0), a, b, c])

    if caps is None or not caps.any():
        yield remark.encode()[:80].ljust(80) + np.array([len(triangles)], "<u4").tobytes()
        yield from packed(show, (lambda some: np.pad(
            facets(some).astype("<f4").view("u1"), ((0, 0), (0, 2))).tobytes(), triangles))
        return
    vertex = "   vertex %.9g %.9g %.9g\n"
    form = f" facet normal %.6g %.6g %.6g\n  outer loop\n{3 * vertex}  endloop\n endfacet\n"
    for number, name in {0: "wall", **cap_names(surface)}.items():
        yield f"solid {name}\n".encode()
        yield from packed(show, (lambda some: lines(form)(facets(some)), triangles[caps == number]))
        yield f"endsolid {name}\n".encode()


def ply(surface: Any, remark: str = "", show: Show = silent) -> Iterator[bytes]:
    """Yield binary PLY with normals, label colours and requested values of the vertices."""
    triangles, columns = triangles_of(surface), _ply_columns(surface)
    attributes = {"|u1": "uchar", "<f4": "float", "<f8": "double"}
    properties = "".join(f"property {attributes[column.dtype.str]} {name}\n"
                         for name, column in columns.items())
    yield ("ply\nformat binary_little_endian 1.0\ncomment VTK generated PLY File\ncomment "
           f"{remark}\nobj_info vtkPolyData points and polygons: vtk4.0\nelement vertex "
           f"{surface.GetNumberOfPoints()}\n{properties}element face {len(triangles)}\n"
           "property list uchar int vertex_indices\nend_header\n").encode()
    vertices = np.rec.fromarrays(
        list(columns.values()), [(name, column.dtype) for name, column in columns.items()])
    yield from packed(show, (np.ndarray.tobytes, vertices), (ply_faces, triangles))


def ply_faces(triangles: np.ndarray) -> bytes:
    """Return the faces as PLY: the number of corners as a byte, then the corners."""
    corners = np.ascontiguousarray(triangles, "<i4").view("u1")
    return np.insert(corners, 0, 3, axis=1).tobytes()


def _ply_columns(surface: Any) -> dict[str, np.ndarray]:
    normals, colors = numbers(surface.GetPointData().GetNormals()), _vertex_colors(surface)
    columns = dict(zip("xyz", points_of(surface).T.astype("<f4")))
    if normals is not None:
        columns.update(zip(("nx", "ny", "nz"), normals.T.astype("<f4")))
    if colors is not None:
        columns.update(zip(("red", "green", "blue"), colors.T))
    names = DistinctNames("_", lambda name: re.sub("[^!-~]", "_", name), PLY_NAMES)
    for array, values in _requested_values(surface).items():
        kind = {"uint8": "u1", "float32": "<f4"}.get(values.dtype.name, "<f8")
        parts = values.reshape(len(values), -1).T.astype(kind)
        for k, part in enumerate(parts):
            columns[names.take(f"{array}_{k}" if len(parts) > 1 else array)] = part
    return columns


def obj(surface: Any, remark: str = "", show: Show = silent) -> Iterator[bytes]:
    """Yield OBJ text."""
    corners, normals = triangles_of(surface) + 1, numbers(surface.GetPointData().GetNormals())
    parts = [(lines("v %.9g %.9g %.9g\n"), points_of(surface))]
    if normals is None:
        parts += [(lines("f %d %d %d\n"), corners)]
    else:
        parts += [(lines("vn %.9g %.9g %.9g\n"), normals),
                  (lines("f %d//%d %d//%d %d//%d\n"), np.repeat(corners, 2, axis=1))]
    yield f"# {remark}\n".encode()
    yield from packed(show, *parts)


FORMATS = {".vtp": vtp, ".vtk": vtk, ".stl": stl, ".ply": ply, ".obj": obj}


def xml_text(writer: Any, data: Any, show: Show = silent) -> bytes:
    """Return the output of a VTK XML writer."""
    # Inline: ParaView 5.11 with expat of 2024 or later cannot read appended data.
    writer.SetDataModeToBinary()
    return _text(writer, data, show)


def _text(writer: Any, data: Any, show: Show = silent, get: str = "GetOutputString") -> bytes:
    writer.SetInputData(data)
    writer.SetWriteToOutputString(True)
    errors = update(writer, lambda: show(writer.GetProgress()))[0]
    if errors or writer.GetErrorCode():
        raise Failure(f"cannot be written ({errors[0] if errors else 'not enough memory?'})")
    text = getattr(writer, get)()
    return text if isinstance(text, bytes) else text.encode()  # bytes if not UTF-8


def write_pieces(path: str, pieces: Iterable[bytes]) -> None:
    with open(path, "wb") as file:
        file.writelines(pieces)


def vti(image: Any, show: Show = silent) -> Iterator[bytes]:
    """Yield a volume with all arrays and field data; a large one in slabs, one piece each."""
    from vtkmodules.vtkIOXML import vtkXMLImageDataWriter
    *extent, z0, z1 = image.GetExtent()
    depth = max(z1 - z0, 1)
    step = max(1, int(SLAB // (1024 * image.GetActualMemorySize() / depth + 1)))
    for bottom in range(z0, z0 + depth, step):
        writer = vtkXMLImageDataWriter()
        writer.SetCompressorTypeToLZ4()
        writer.SetWriteExtent(*extent, bottom, min(bottom + step, z1))
        text = xml_text(writer, image, lambda share, done=bottom - z0: show(
            (done + share * step) / depth))
        piece, end = text.index(b"<Piece "), text.rindex(b"</Piece>") + len("</Piece>\n")
        if bottom == z0:
            whole = " ".join(map(str, image.GetExtent()))
            yield re.sub(rb'WholeExtent="[^"]*"', f'WholeExtent="{whole}"'.encode(), text[:piece])
        yield text[piece:end]
    yield text[end:]


def write_vtm(blocks: Any, path: str, show: Show = silent) -> None:
    """Write surfaces in blocks to files in a folder, and the .vtm file that refers to them."""
    parent, stem = os.path.split(os.path.splitext(path)[0])
    os.mkdir(os.path.join(parent, stem))
    text = ('<?xml version="1.0"?>\n<VTKFile type="vtkMultiBlockDataSet" version="1.0">\n'
            "  <vtkMultiBlockDataSet>\n")
    for i in range(blocks.GetNumberOfBlocks()):
        show(i / blocks.GetNumberOfBlocks())
        fields = {"index": str(i), "name": blocks.HasMetaData(i) and blocks.GetMetaData(i).Get(
            blocks.NAME())}
        if blocks.GetBlock(i) is not None:
            fields["file"] = f"{stem}/{stem}_{i}.vtp"
            write_pieces(os.path.join(parent, fields["file"]), vtp(blocks.GetBlock(i)))
        attributes = (f' {key}="{escaped(value)}"' for key, value in fields.items() if value)
        text += f"    <DataSet{''.join(attributes)}/>\n"
    text += "  </vtkMultiBlockDataSet>\n</VTKFile>\n"
    write_pieces(path, [text.encode("utf-8", "surrogateescape")])


def csv(table: Any) -> Iterator[bytes]:
    """Yield a table as text with column names."""
    from vtkmodules.vtkIOCore import vtkDelimitedTextWriter
    writer = vtkDelimitedTextWriter()
    writer.SetFieldDelimiter(",")
    yield _text(writer, table, get="RegisterAndGetOutputString")


def escaped(text: str) -> str:
    """Return a text escaped as an XML attribute."""
    return html.escape(re.sub(r"[\x00-\x1f]", " ", text), quote=False).replace('"', "&quot;")
