# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Surfaces as .vtp, .vtk, .stl, .ply and .obj, and other data of VTK: .vtm, .vti, .csv.

VTK's writers damage memory or report nothing on a full disk. So they write to memory here, and
Python writes to the disk, which raises OSError there.
"""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterable, Iterator
from typing import Any

import numpy as np

from ..errors import Failure
from .meshers import cap_names
from .regions import cell_array, surface_labels, triangles_of

Show = Callable[[float], Any]  # progress, 0 to 1

CHUNK = 1 << 17       # points or triangles at once
SLAB = 1 << 29        # bytes of a volume at once
LONGEST_HEAD = 255    # bytes of the second line of .vtk
EXACT = (".vtp", ".vtk")  # formats that keep all arrays, and coordinates in double precision
# Point arrays that describe the fit; others are values that the user requested.
OF_FIT = {"Normals", "Residual", "Motionless", "Contact", "EdgeSize", "Junction", "GlobalIds"}
PLY_NAMES = {"x", "y", "z", "nx", "ny", "nz", "red", "green", "blue"}  # of properties that exist


def silent(_share: float) -> None:
    """Progress that nobody sees."""


def chunks(count: int, show: Show, first: float = 0.0, last: float = 1.0) -> Iterator[slice]:
    for start in range(0, count, CHUNK):
        show(first + (last - first) * start / count)
        yield slice(start, min(start + CHUNK, count))


# ---- What a surface has ------------------------------------------------------------------------

def points_of(surface: Any) -> np.ndarray:
    """The points, n x 3."""
    from vtkmodules.util.numpy_support import vtk_to_numpy
    return vtk_to_numpy(surface.GetPoints().GetData())


def normals_of(surface: Any) -> np.ndarray | None:
    """The normals of the points; None if there are none."""
    from vtkmodules.util.numpy_support import vtk_to_numpy
    normals = surface.GetPointData().GetNormals()
    return None if normals is None else vtk_to_numpy(normals)


def bytes_of(color: Any) -> tuple[int, ...]:
    """A color of parts in 0..1 as bytes."""
    return tuple(np.floor(255 * np.clip(color, 0, 1) + 0.5).astype(int).tolist())


def _vertex_colors(surface: Any) -> np.ndarray | None:
    """For each point the color of the label of its first triangle; None without labels."""
    labels = cell_array(surface, "Label")
    colors = {label.number: bytes_of(label.color) for label in surface_labels(surface)}
    if labels is None or not colors:
        return None
    numbers, index = np.unique(labels, return_inverse=True)
    of_label = np.array([colors.get(number, (0, 0, 0)) for number in numbers.tolist()], "u1")
    points, corner = np.unique(triangles_of(surface), return_index=True)
    found = np.zeros((surface.GetNumberOfPoints(), 3), "u1")
    found[points] = of_label[index.ravel()[corner // 3]]
    return found


def _requested_values(surface: Any) -> dict[str, np.ndarray]:
    """Point arrays with results that the user requested (--probe, --thin-parts)."""
    from vtkmodules.util.numpy_support import vtk_to_numpy
    data = surface.GetPointData()
    return {data.GetArrayName(i): vtk_to_numpy(data.GetArray(i))
            for i in range(data.GetNumberOfArrays()) if data.GetArrayName(i) not in OF_FIT}


def losses(surface: Any, suffix: str) -> Iterator[str]:
    """What files with this suffix cannot hold: requested values of points, numbers of caps, and
    coordinates for which single precision is too coarse."""
    if suffix not in FORMATS and suffix not in (".glb", ".3mf") or suffix in EXACT:
        return
    values, caps = _requested_values(surface), cell_array(surface, "Cap")
    if values and suffix != ".ply":
        yield (f"{suffix} has no place for the values {', '.join(sorted(values))}; .vtp, .vtk and "
               ".ply have")
    if caps is not None and caps.any() and suffix != ".stl":
        yield f"{suffix} has no place for the numbers of caps; .vtp, .vtk and .stl have"
    bounds = np.reshape(surface.GetBounds(), (3, 2))
    # About the edges of as many triangles on the faces of the surface's box.
    edge = 2 * np.linalg.norm(np.ptp(bounds, axis=1)) / np.sqrt(surface.GetNumberOfPolys() or 1)
    step = np.abs(bounds).max() * np.finfo(np.float32).eps
    if surface.GetNumberOfPolys() and step > 0.01 * edge:
        yield (f"coordinates up to {np.abs(bounds).max():.0f} are rounded there by steps of "
               f"{step:.4g}, edges are about {edge:.4g} long; .vtp, .vtk and .msh keep them")


# ---- Formats of surfaces -----------------------------------------------------------------------

def vtp(surface: Any, _remark: str = "", show: Show = silent) -> Iterator[bytes]:
    """VTK's XML format, with all arrays."""
    from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter
    writer = vtkXMLPolyDataWriter()
    writer.SetCompressorTypeToLZ4()  # nine times as fast as zlib, at 1.6 times the size
    yield xml_text(writer, surface, show)


def vtk(surface: Any, remark: str = "", show: Show = silent) -> Iterator[bytes]:
    """VTK's legacy format, binary, with all arrays."""
    from vtkmodules.vtkIOLegacy import vtkPolyDataWriter
    writer = vtkPolyDataWriter()
    writer.SetHeader(remark.encode()[:LONGEST_HEAD].decode("utf-8", "ignore"))
    writer.SetFileTypeToBinary()
    writer.WriteToOutputStringOn()
    _write(writer, surface, show)
    yield _as_bytes(writer.GetOutputStdString())


def stl(surface: Any, remark: str = "", show: Show = silent) -> Iterator[bytes]:
    """Binary, or, with caps (--ends marked), a text with a solid `wall` and one for each cap."""
    points, triangles = points_of(surface), triangles_of(surface)
    caps = cell_array(surface, "Cap")
    if caps is not None and caps.any():
        for number, name in {0: "wall", **cap_names(surface)}.items():
            yield from _stl_text(name, points, triangles[caps == number])
        return
    yield remark.encode()[:80].ljust(80) + np.array([len(triangles)], "<u4").tobytes()
    for some in chunks(len(triangles), show):
        corners = points[triangles[some]]
        facets = np.zeros(len(corners), [("normal", "<f4", 3), ("corners", "<f4", (3, 3)),
                                         ("nothing", "<u2")])
        facets["normal"], facets["corners"] = _facet_normals(corners), corners
        yield facets.tobytes()


def _stl_text(name: str, points: np.ndarray, triangles: np.ndarray) -> Iterator[bytes]:
    vertex = "   vertex %.9g %.9g %.9g\n"
    form = f" facet normal %.6g %.6g %.6g\n  outer loop\n{3 * vertex}  endloop\n endfacet\n"
    yield f"solid {name}\n".encode()
    for some in chunks(len(triangles), silent):
        corners = points[triangles[some]]
        yield lines(form, np.hstack([_facet_normals(corners), corners.reshape(-1, 9)]))
    yield f"endsolid {name}\n".encode()


def _facet_normals(corners: np.ndarray) -> np.ndarray:
    """As VTK computes them; 0 for triangles without an area."""
    a, b, c = (corners[:, k].astype(float) for k in range(3))
    normals = np.cross(c - b, a - b)
    length = np.sqrt((normals * normals).sum(axis=1, keepdims=True))
    return np.divide(normals, length, out=normals, where=length > 0)


def ply(surface: Any, remark: str = "", show: Show = silent) -> Iterator[bytes]:
    """Binary, with normals, the color of its label at each vertex, and the values that the user
    requested."""
    triangles = triangles_of(surface)
    columns = _ply_columns(surface)
    words = {"u1": "uchar", "<f4": "float", "<f8": "double"}
    properties = "".join(f"property {words[kind]} {name}\n" for name, kind, _ in columns)
    yield ("ply\nformat binary_little_endian 1.0\ncomment VTK generated PLY File\ncomment "
           f"{remark}\nobj_info vtkPolyData points and polygons: vtk4.0\nelement vertex "
           f"{surface.GetNumberOfPoints()}\n{properties}element face {len(triangles)}\n"
           "property list uchar int vertex_indices\nend_header\n").encode()
    for some in chunks(surface.GetNumberOfPoints(), show, 0, 0.5):
        rows = np.empty(some.stop - some.start, [column[:2] for column in columns])
        for name, _, numbers in columns:
            rows[name] = numbers[some]
        yield rows.tobytes()
    for some in chunks(len(triangles), show, 0.5, 1):
        faces = np.full(some.stop - some.start, 3, [("count", "u1"), ("corners", "<i4", 3)])
        faces["corners"] = triangles[some]
        yield faces.tobytes()


def _ply_columns(surface: Any) -> list[tuple[str, str, np.ndarray]]:
    """Name, type and numbers of the properties of vertices."""
    normals, colors = normals_of(surface), _vertex_colors(surface)
    columns = [(name, "<f4", part) for name, part in zip("xyz", points_of(surface).T)]
    if normals is not None:
        columns += [(f"n{axis}", "<f4", part) for axis, part in zip("xyz", normals.T)]
    if colors is not None:
        columns += [(name, "u1", part) for name, part in zip(("red", "green", "blue"), colors.T)]
    taken = set(PLY_NAMES)
    for array, values in _requested_values(surface).items():
        kind = {"uint8": "u1", "float32": "<f4"}.get(values.dtype.name, "<f8")
        parts = values.reshape(len(values), -1).T
        for k, part in enumerate(parts):
            name = re.sub("[^!-~]", "_", array) + (f"_{k}" if len(parts) > 1 else "")
            while name in taken:
                name += "_"
            taken.add(name)
            columns.append((name, kind, part))
    return columns


def obj(surface: Any, remark: str = "", show: Show = silent) -> Iterator[bytes]:
    """A text: a line for each point, for its normal, and for each triangle."""
    points, normals, triangles = points_of(surface), normals_of(surface), triangles_of(surface)
    yield f"# {remark}\n".encode()
    for some in chunks(len(points), show, 0, 0.3):
        yield lines("v %.9g %.9g %.9g\n", points[some])
    if normals is None:
        form, triangles = "f %d %d %d\n", triangles + 1
    else:
        form, triangles = "f %d//%d %d//%d %d//%d\n", np.repeat(triangles + 1, 2, axis=1)
        for some in chunks(len(normals), show, 0.3, 0.6):
            yield lines("vn %.9g %.9g %.9g\n", normals[some])
    for some in chunks(len(triangles), show, 0.6, 1):
        yield lines(form, triangles[some])


def lines(form: str, rows: np.ndarray) -> bytes:
    """A line of this format for each row."""
    return (form * len(rows) % tuple(rows.ravel().tolist())).encode()


FORMATS = {".vtp": vtp, ".vtk": vtk, ".stl": stl, ".ply": ply, ".obj": obj}


# ---- VTK's writers -----------------------------------------------------------------------------

def xml_text(writer: Any, data: Any, show: Show = silent) -> bytes:
    """What a writer of VTK's XML formats writes."""
    # Inline: readers of ParaView 5.11, with an expat of 2024 or later, refuse appended data.
    writer.SetDataModeToBinary()
    writer.WriteToOutputStringOn()
    _write(writer, data, show)
    return _as_bytes(writer.GetOutputString())


def _as_bytes(text: Any) -> bytes:
    """Strings of VTK that are not UTF-8 are bytes in Python."""
    return text if isinstance(text, bytes) else text.encode()


def _write(writer: Any, data: Any, show: Show) -> None:
    from ..messages import update
    writer.SetInputData(data)
    errors = update(writer, lambda: show(writer.GetProgress()))[0]
    if errors or writer.GetErrorCode():
        raise Failure(f"cannot be written ({errors[0] if errors else 'not enough memory?'})")


def write_pieces(path: str, pieces: Iterable[bytes]) -> None:
    """Write a file."""
    with open(path, "wb") as file:
        for piece in pieces:
            file.write(piece)


def vti(image: Any, show: Show = silent) -> Iterator[bytes]:
    """A volume with all its arrays and field data; a large one in slabs, each a piece."""
    from vtkmodules.vtkIOXML import vtkXMLImageDataWriter
    x0, x1, y0, y1, z0, z1 = image.GetExtent()
    step = max(1, int(SLAB // (1024 * image.GetActualMemorySize() / max(z1 - z0, 1) + 1)))
    for bottom in range(z0, max(z1, z0 + 1), step):
        top = min(bottom + step, z1)
        writer = vtkXMLImageDataWriter()
        writer.SetCompressorTypeToLZ4()
        if (bottom, top) != (z0, z1):
            writer.SetWriteExtent(x0, x1, y0, y1, bottom, top)
        text = xml_text(writer, image, lambda share, at=(bottom - z0) / max(z1 - z0, 1): show(
            at + share * step / max(z1 - z0, step)))
        piece, end = text.index(b"<Piece "), text.rindex(b"</Piece>") + len("</Piece>\n")
        if bottom == z0:
            yield re.sub(rb'WholeExtent="[^"]*"', f'WholeExtent="{x0} {x1} {y0} {y1} {z0} {z1}"'
                         .encode(), text[:piece], count=1)
        yield text[piece:end]
    yield text[end:]


def write_vtm(blocks: Any, path: str, show: Show = silent) -> None:
    """Write blocks that are surfaces, each to a file in a folder beside, and the .vtm that names
    them."""
    folder = os.path.splitext(path)[0]
    stem = os.path.basename(folder)
    os.mkdir(folder)
    text = ('<?xml version="1.0"?>\n<VTKFile type="vtkMultiBlockDataSet" version="1.0">\n'
            "  <vtkMultiBlockDataSet>\n")
    for i in range(blocks.GetNumberOfBlocks()):
        show(i / blocks.GetNumberOfBlocks())
        name = blocks.GetMetaData(i).Get(blocks.NAME()) if blocks.HasMetaData(i) else None
        text += f'    <DataSet index="{i}"' + (f' name="{escaped(name)}"' if name else "")
        if blocks.GetBlock(i) is not None:
            file = f"{stem}_{i}.vtp"
            write_pieces(os.path.join(folder, file), vtp(blocks.GetBlock(i)))
            text += f' file="{escaped(f"{stem}/{file}")}"'
        text += "/>\n"
    text += "  </vtkMultiBlockDataSet>\n</VTKFile>\n"
    write_pieces(path, [text.encode("utf-8", "surrogateescape")])


def csv(table: Any) -> Iterator[bytes]:
    """A table as text, with a line of column names."""
    from vtkmodules.vtkIOCore import vtkDelimitedTextWriter
    writer = vtkDelimitedTextWriter()
    writer.SetFieldDelimiter(",")
    writer.SetWriteToOutputString(True)
    _write(writer, table, silent)
    yield writer.RegisterAndGetOutputString().encode()


def escaped(text: str) -> str:
    """A text as the value of an attribute in XML."""
    text = re.sub(r"[\x00-\x1f]", " ", text)
    for sign, name in (("&", "&amp;"), ("<", "&lt;"), (">", "&gt;"), ('"', "&quot;")):
        text = text.replace(sign, name)
    return text
