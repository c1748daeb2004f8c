# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Files of VTK. XML files (.vti, .pvti, .vtr) are read here, as VTK's readers crash on damaged ones,
accept some that are cut off, and need memory for all arrays. Legacy files (.vtk) and .vtkhdf are
read in a worker."""
from __future__ import annotations

import binascii
import dataclasses
import lzma
import mmap
import os
import re
import zlib
from xml.parsers import expat

import numpy as np

from ..errors import VolumeError
from .grid import placed
from .volume import Label, failure_of, unit_of
from .worker import in_worker

_TYPES = {kind + size: (kind[0].lower() if kind != "Float" else "f") + str(int(size) // 8)
          for kind in ("Int", "UInt", "Float") for size in ("8", "16", "32", "64")}
_ADVICE = "; resample it to an image (ParaView's Resample To Image writes a .vti)"
_DEEPEST, _LONGEST = 64, 1 << 16


class XmlFile:
    """The arrays of an XML file of VTK, decoded when they are read."""

    def __init__(self, path):
        self.path = path
        self.root, self.grid, self.pieces, self.arrays, self._open = {}, {}, [], [], []
        with open(path, "rb") as stream:
            if not os.fstat(stream.fileno()).st_size:
                raise VolumeError("the file is empty")
            self.data = mmap.mmap(stream.fileno(), 0, access=mmap.ACCESS_READ)
        head = self.data.find(b"<AppendedData")
        parser = expat.ParserCreate()
        parser.buffer_text, parser.buffer_size = True, 1 << 20
        parser.StartElementHandler, parser.EndElementHandler = self._start, self._end
        parser.CharacterDataHandler = self._text
        parser.EntityDeclHandler = self._refuse_entity
        try:
            parser.Parse(self.data if head < 0 else self.data[:head], head < 0)
        except expat.ExpatError as error:
            raise VolumeError("the file is cut off or damaged: its XML cannot be parsed (%s)"
                              % error) from None
        self.kind = self.root.get("type", "")
        self.order = ">" if self.root.get("byte_order") == "BigEndian" else "<"
        self.header = np.dtype("u8" if self.root.get("header_type") == "UInt64" else "u4")
        self.header = self.header.newbyteorder(self.order)
        if head >= 0:
            self._find_appended(head)

    def _start(self, name, values):
        self._open.append(name)
        if len(self._open) > _DEEPEST:
            raise VolumeError("its header is damaged: it has more than %d elements within elements"
                              % _DEEPEST)
        if name == "VTKFile":
            self.root = values
        elif name == self.root.get("type"):
            self.grid = values
        elif name == "Piece":
            self.pieces.append(values)
        elif name in ("DataArray", "Array"):
            parent = self._open[-2] if len(self._open) > 1 else ""
            self.arrays.append(dict(values, parent=parent, piece=len(self.pieces) - 1, text=[]))
        elif name in ("PointData", "CellData") and self.pieces:
            self.pieces[-1][name] = values.get("Scalars", "")

    def _end(self, _name):
        self._open.pop()

    def _text(self, text):
        if self._open and self._open[-1] in ("DataArray", "Array"):
            self.arrays[-1]["text"].append(text)

    def _refuse_entity(self, *_):
        raise VolumeError("its header is damaged: it declares entities")

    def _find_appended(self, head):
        """Find where the appended data begin and end."""
        mark = self.data.find(b"_", head, head + 4096)
        close = self.data.rfind(b"</AppendedData>")
        if mark < 0 or close < mark or self.data[-_LONGEST:].rstrip()[-10:] != b"</VTKFile>":
            raise VolumeError("the file is cut off: its appended data do not end; copy it again")
        self.is_base64 = b'"base64"' in self.data[head:mark]
        self.span = (mark + 1, close)

    def names(self, parent):
        """Return the names of the arrays of "PointData" or "CellData"."""
        return [a.get("Name", "") for a in self.arrays if a["parent"] == parent and a["piece"] <= 0]

    def read(self, array, count=None):
        """Return the values of an array; VolumeError unless there are `count`."""
        kind = "Int8" if array.get("type") == "String" else array.get("type")
        if kind not in _TYPES:
            raise VolumeError("its array %s has the type %s, which cannot be read"
                              % (array.get("Name"), kind))
        dtype = np.dtype(_TYPES[kind]).newbyteorder(self.order)
        need = None if count is None else count * dtype.itemsize
        try:
            if array.get("format") == "ascii":
                return self._from_ascii(array, dtype, count)
            if array.get("format") == "appended":
                at = int(array["offset"])
                end = min([int(other["offset"]) for other in self.arrays if "offset" in other
                           and int(other["offset"]) > at] + [self.span[1] - self.span[0]])
                data = memoryview(self.data)[self.span[0]:][at:end] if at >= 0 else b""
                code = self.is_base64
            else:
                data, code = "".join(array["text"]).strip().encode("ascii", "replace"), True
            raw, used = self._unpacked(memoryview(data), code, need)
            if len(data) - used > _LONGEST or bytes(data[used:]).strip():
                raise ValueError("%d bytes too many follow it" % (len(data) - used))
        except (EOFError, zlib.error, lzma.LZMAError, binascii.Error, KeyError, AttributeError,
                ValueError, OverflowError) as error:
            text = str(error) or "it ends too early"
            raise VolumeError("the file is cut off or damaged: its array %s cannot be read: %s; copy "
                              "it again" % (array.get("Name"), text)) from None
        return np.frombuffer(raw, dtype)

    @staticmethod
    def _from_ascii(array, dtype, count):
        words = "".join(array["text"]).split()
        values = np.array(words or [0]).astype(dtype)[:len(words)]
        if count is not None and len(values) != count:
            raise VolumeError("the file is cut off or damaged: its array %s has %d numbers, %d are "
                              "needed" % (array.get("Name"), len(values), count))
        return values

    def _unpacked(self, data, is_base64, need):
        """Return the bytes of an array, and how many bytes at the begin of the data encode it."""
        wide = self.header.itemsize
        packed = self.root.get("compressor", "")
        if not packed:
            size, = np.frombuffer(_decoded(data, is_base64, 0, wide), self.header)
            if need is not None and int(size) != need:
                raise ValueError("it has %d bytes, %d are needed" % (size, need))
            end = wide + int(size)
            return _decoded(data, is_base64, wide, end), _encoded(end, is_base64)
        blocks, size, last = map(int, np.frombuffer(_decoded(data, is_base64, 0, 3 * wide),
                                                    self.header))
        whole = (blocks - bool(last)) * size + last
        if blocks and not size or last > size or need is not None and whole != need:
            raise ValueError("it is packed in %d blocks of %d bytes, the last one of %d; %s bytes "
                             "are needed" % (blocks, size, last, need))
        if blocks * wide > len(data):
            raise EOFError
        start = wide * (3 + blocks)
        sizes = np.frombuffer(_decoded(data, is_base64, 0, start), self.header)[3:].astype(int)
        head = _encoded(start, is_base64) if is_base64 else 0  # the sizes are encoded by themselves
        data, start = data[head:], 0 if is_base64 else start
        ends = start + np.cumsum(sizes)
        plain = _decoded(data, is_base64, 0, int(ends[-1]) if blocks else 0)
        result, unpack = bytearray(), _unpacker(packed)
        for number, (end, length) in enumerate(zip(ends, sizes)):
            most = last if last and number == blocks - 1 else size
            block = unpack(plain[end - length:end], most)
            if len(block) != most:
                raise ValueError("a packed block has %d bytes, %d are needed" % (len(block), most))
            result += block
        return result, head + _encoded(int(ends[-1]) if blocks else start, is_base64)


def _encoded(size, is_base64):
    """Return how many bytes encode so many."""
    return -(-size // 3) * 4 if is_base64 else size


def _decoded(data, is_base64, begin, end):
    """Return bytes of data; EOFError if there are too few."""
    if is_base64:
        chars = data[:_encoded(end, True)]
        plain = binascii.a2b_base64(chars)
        if len(chars) % 4 or len(plain) < end or len(plain) != len(chars) // 4 * 3 - bytes(
                chars[-2:]).count(b"="):
            raise EOFError
        return memoryview(plain)[begin:end]
    if len(data) < end:
        raise EOFError
    return data[begin:end]


def _unpacker(name):
    """Return the function that unpacks a block of at most `size` bytes."""
    if name in ("vtkZLibDataCompressor", "vtkLZMADataCompressor"):
        def inflate(data, size):
            machine = zlib.decompressobj() if "ZLib" in name else lzma.LZMADecompressor()
            block = machine.decompress(data, size + 1)
            if not machine.eof:
                raise EOFError
            return block
        return inflate
    if name != "vtkLZ4DataCompressor":
        raise VolumeError("it is packed by %s, which cannot be unpacked" % name)
    from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
    from vtkmodules.vtkIOCore import vtkLZ4DataCompressor

    def unpack(data, size):
        found = vtkLZ4DataCompressor().Uncompress(numpy_to_vtk(np.frombuffer(data, "u1")), size)
        return vtk_to_numpy(found).tobytes() if found else b""
    return unpack


# ---- Images ------------------------------------------------------------------------------------

def read_xml(path, choice):
    """Read .vti, .pvti or .vtr."""
    file = XmlFile(path)
    if file.kind not in ("ImageData", "PImageData", "RectilinearGrid"):
        raise VolumeError("it holds %s, and no image%s" % (file.kind or "no data of VTK", _ADVICE))
    whole = _extent(file.grid, "WholeExtent")
    sizes = whole[1::2] - whole[::2] + 1
    pieces = [file]
    if file.kind == "PImageData":
        pieces = [_piece(path, piece) for piece in file.pieces]
    if not pieces or not file.pieces:
        raise VolumeError("the image is empty")
    names = {parent: pieces[0].names(parent) for parent in ("PointData", "CellData")}
    active = {parent: pieces[0].pieces[0].get(parent, "") for parent in names}
    parent, name = choose_array(names, active, choice.array)
    cells = parent == "CellData"
    last = np.maximum(sizes - cells, 1)
    parts = [part for each in pieces for part in _parts(each, parent, name)]
    array = parts[0][1]
    if len(parts) > 1 or tuple(array.shape[:3]) != tuple(last[::-1]):
        array = _joined(parts, whole, last)
    array = array[..., 0] if array.shape[3] == 1 else np.moveaxis(array, 3, 0)
    numbers = lambda key, default: np.array([float(n) for n in file.grid.get(key, default).split()])
    if file.kind == "RectilinearGrid":
        steps, origin = _regular([file.read(a, int(n)) for a, n in zip(
            [a for a in file.arrays if a["parent"] == "Coordinates"], sizes)])
        origin = origin - steps @ whole[::2]
    else:
        steps = numbers("Direction", "1 0 0 0 1 0 0 0 1").reshape(3, 3) * numbers("Spacing", "1 1 1")
        origin = numbers("Origin", "0 0 0")
    origin = origin + steps @ ((sizes > 1) * .5) if cells else origin
    fields = {a.get("Name"): _field(pieces[0], a) for a in pieces[0].arrays
              if a["parent"] == "FieldData"}
    return _volume(array, steps, origin, fields, choice, name, whole[::2])


def choose_array(names, active, wanted):
    """Return "PointData" or "CellData" and the name of the array that is read."""
    for parent in ("PointData", "CellData"):
        found = [n for n in names[parent] if n != "vtkGhostType"]
        name = wanted or active[parent] or (found[0] if len(found) == 1 else None)
        if name in found:
            return parent, name
        if found and not wanted:
            break
    listed = [n for n in names["PointData"]]
    raise VolumeError("%s; %s" % ("no point array " + wanted if wanted else
                                  "the volume has no active scalars",
                                  "point arrays: %s; choose one with --array" % ", ".join(listed)
                                  if listed else "there are no point arrays"))


def _extent(element, key):
    extent = np.array([int(n) for n in element.get(key, "").split()])
    if len(extent) != 6 or (extent[1::2] < extent[::2]).any() or np.abs(extent).max() >= 1 << 31:
        raise VolumeError("its header is damaged, or the image is empty: its %s is \"%s\""
                          % (key, element.get(key, "")))
    return extent


def _piece(path, piece):
    """Open a piece of .pvti."""
    name = piece.get("Source", "")
    try:
        file = XmlFile(os.path.join(os.path.dirname(path), name))
    except (OSError, VolumeError) as error:
        raise VolumeError("%s: %s" % (name[:200], failure_of(error))) from None
    if file.kind != "ImageData" or not file.pieces:
        raise VolumeError("%s: it is no image" % name[:200])
    return file


def _parts(file, parent, name):
    """Return (extent, values [z, y, x, component]) of an array in each piece of a file."""
    parts = []
    for number, piece in enumerate(file.pieces):
        extent = _extent(piece, "Extent")
        array = next((a for a in file.arrays if a["piece"] == number and a["parent"] == parent
                      and a.get("Name", "") == name), None)
        if array is None:
            raise VolumeError("a piece has no array " + name)
        sizes = extent[1::2] - extent[::2] + 1
        sizes = np.maximum(sizes - 1, 1) if parent == "CellData" else sizes
        count = int(array.get("NumberOfComponents", 1))
        values = file.read(array, int(np.prod(sizes.astype(object))) * count)
        parts.append((extent, values.reshape(*sizes[::-1], count)))
    return parts


def _joined(parts, whole, sizes):
    """Return the values of pieces as one array."""
    count = parts[0][1].shape[3]
    if sum(values.nbytes for _, values in parts) < np.prod(sizes) * count * parts[0][1].itemsize:
        raise VolumeError("its pieces do not cover the whole image")
    result = np.empty((*sizes[::-1], count), parts[0][1].dtype)
    covered = np.zeros(sizes[::-1], bool)
    for extent, values in parts:
        begin = extent[::2] - whole[::2]
        place = tuple(slice(a, a + n) for a, n in zip(begin[::-1], values.shape))
        if (begin < 0).any() or values.shape[3] != count or covered[place].shape != values.shape[:3]:
            raise VolumeError("its header is damaged: a piece is outside the whole image")
        result[place], covered[place] = values, True
    if not covered.all():
        raise VolumeError("its pieces do not cover the whole image")
    return result


def _regular(lines):
    """Return the steps and the origin of a rectilinear grid whose distances are even."""
    steps = [np.diff(line.astype(float)) for line in lines]
    if len(lines) != 3 or any(len(s) and np.ptp(s) > 1e-3 * abs(s.mean()) for s in steps):
        raise VolumeError("it holds a rectilinear grid with uneven distances" + _ADVICE)
    return (np.diag([s.mean() if len(s) else 1. for s in steps]),
            np.array([float(line[0]) for line in lines]))


def _field(file, array):
    """Return the values of an array of field data: texts, or numbers."""
    try:
        values = file.read(array)
    except VolumeError:
        return []
    if array.get("type") == "String":
        return bytes(values.astype("u1")).decode("utf-8", "replace").split("\0")[:-1]
    values = values / 255. if array.get("type") == "UInt8" else values
    return values.reshape(-1, int(array.get("NumberOfComponents", 1)))


def _volume(array, steps, origin, fields, choice, name, start):
    """Return the Volume with the space, unit and labels that our field data give."""
    text = lambda key: (list(map(str, fields.get(key, []))) or [""])[0]
    space = text("Axes")
    labels = []
    values = np.ravel(fields.get("LabelValues", []))
    fits = lambda key: len(fields.get(key, [])) == len(values)
    for number, value in enumerate(values):
        if abs(value) < 1 << 31:
            color = np.ravel(fields["LabelColors"][number]) if fits("LabelColors") else ()
            labels.append(Label(
                int(value), str(fields["LabelNames"][number]) if fits("LabelNames") else "",
                tuple(map(float, color)) if len(color) == 3 else None,
                int(np.ravel(fields["LabelLayers"])[number]) if fits("LabelLayers") else 0))
    return placed(array, steps, origin, space if re.fullmatch("[LRAPSI]{3}", space) else "",
                  unit_of(text("LengthUnit")), choice, labels=labels, name=name or "",
                  components="vector" if array.ndim == 4 else "", start=tuple(map(int, start)))


# ---- Legacy files and HDF5, in a worker --------------------------------------------------------

def read_legacy(path, choice):
    """Read .vtk by VTK, or .vtkhdf by h5py."""
    found = in_worker("volumic.reading.vtkfiles:load", path, dataclasses.replace(choice, tell=None))
    array, steps, origin, fields, name, start = found
    array = array[..., 0] if array.shape[3] == 1 else np.moveaxis(array, 3, 0)
    return _volume(array, steps, origin, fields, choice, name, start)


def load(path, choice):
    """Return what _volume() takes, of a file that is not XML."""
    with open(path, "rb") as stream:
        if stream.read(4) == b"\x89HDF":
            return _load_hdf(path, choice)
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOLegacy import vtkDataSetReader
    reader, messages = vtkDataSetReader(), []
    reader.SetFileName(path)
    image = updated(reader, messages)
    if messages or image is None:
        raise VolumeError("VTK cannot read it: " + (messages or ["it holds no data"])[0])
    kind = image.GetClassName().replace("vtk", "")
    if kind not in ("StructuredPoints", "ImageData", "RectilinearGrid"):
        raise VolumeError("it holds %s, and no image%s" % (kind, _ADVICE))
    data = {"PointData": image.GetPointData(), "CellData": image.GetCellData()}
    names = {parent: [each.GetArrayName(n) or "" for n in range(each.GetNumberOfArrays())]
             for parent, each in data.items()}
    active = {parent: each.GetScalars() and each.GetScalars().GetName()
              for parent, each in data.items()}
    parent, name = choose_array(names, active, choice.array)
    sizes, extent = np.array(image.GetDimensions()), np.array(image.GetExtent())
    shape = np.maximum(sizes - (parent == "CellData"), 1)
    array = vtk_to_numpy(data[parent].GetArray(name)).reshape(*shape[::-1], -1)
    if kind == "RectilinearGrid":
        steps, origin = _regular([vtk_to_numpy(image.GetXCoordinates()),
                                  vtk_to_numpy(image.GetYCoordinates()),
                                  vtk_to_numpy(image.GetZCoordinates())])
        origin = origin - steps @ extent[::2]
    else:
        steps = np.diag(image.GetSpacing())
        origin = np.array(image.GetOrigin())
    origin = origin + steps @ ((sizes > 1) * .5) if parent == "CellData" else origin
    fields, field = {}, image.GetFieldData()
    for number in range(field.GetNumberOfArrays()):
        each = field.GetAbstractArray(number)
        fields[each.GetName()] = ([each.GetValue(n) for n in range(each.GetNumberOfValues())]
                                  if each.IsA("vtkStringArray") else vtk_to_numpy(each).reshape(
                                      -1, each.GetNumberOfComponents()))
    return np.ascontiguousarray(array), steps, origin, fields, name, extent[::2]


def updated(reader, messages):
    """Update a reader of VTK and return its output; add its errors to the messages."""
    def note(_caller, _event, text=""):
        if "InformationKey" not in text:  # a range that is NaN
            messages.append(" ".join(text.split("\n", 1)[-1].split())[-200:])
    note.CallDataType = "string0"
    reader.AddObserver("ErrorEvent", note)
    reader.Update()
    return reader.GetOutputDataObject(0)


def _load_hdf(path, choice):
    import h5py
    with h5py.File(path, "r") as file:
        root = file["VTKHDF"]
        kind = root.attrs.get("Type", b"")
        if bytes(kind if isinstance(kind, bytes) else kind.encode()) != b"ImageData":
            raise VolumeError("it holds %s, and no image%s" % (kind, _ADVICE))
        names = {parent: list(root.get(parent, ())) for parent in ("PointData", "CellData")}
        active = {parent: root[parent].attrs.get("Scalars", b"") if parent in root else b""
                  for parent in names}
        active = {parent: a.decode() if isinstance(a, bytes) else a for parent, a in active.items()}
        parent, name = choose_array(names, active, choice.array)
        whole = np.array(root.attrs["WholeExtent"])
        sizes = whole[1::2] - whole[::2] + 1
        shape = np.maximum(sizes - (parent == "CellData"), 1)
        steps = np.reshape(root.attrs.get("Direction", np.eye(3)), (3, 3)) * root.attrs["Spacing"]
        origin = np.array(root.attrs["Origin"])
        origin = origin + steps @ ((sizes > 1) * .5) if parent == "CellData" else origin
        return root[parent][name][()].reshape(*shape[::-1], -1), steps, origin, {}, name, whole[::2]
