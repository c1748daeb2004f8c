# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""VTK XML files. VTK's readers crash on damaged files, accept some truncated ones, and load all
arrays. Here arrays are checked, and memory-mapped unless compressed."""
from __future__ import annotations

import binascii
import lzma
import mmap
import zlib
from xml.parsers import expat

import numpy as np

from ..errors import VolumeError
from .volume import prefix_errors

_TYPES = {"String": "i1", **{kind + str(8 * size): kind[0].lower() + str(size)
                             for kind in ("Int", "UInt", "Float") for size in (1, 2, 4, 8)}}


class XmlFile:
    """The pieces and arrays of a file with their attributes. read() decodes an array."""

    def __init__(self, path):
        with open(path, "rb") as stream:
            self.data = mmap.mmap(stream.fileno(), 0, access=mmap.ACCESS_READ)
        self.root, self.grid, self.pieces, self.arrays, self._open = {}, {}, [], [], []
        parser = expat.ParserCreate()
        parser.buffer_text, parser.buffer_size = True, 1 << 20
        parser.StartElementHandler, parser.CharacterDataHandler = self._start, self._text
        parser.EndElementHandler = lambda _: self._open.pop()
        head = self.data.find(b"<AppendedData")
        parser.Parse(self.data if head < 0 else self.data[:head], head < 0)
        self.kind = self.root.get("type", "")
        self.order = ">" if self.root.get("byte_order") == "BigEndian" else "<"
        self.header = self.order + ("u8" if self.root.get("header_type") == "UInt64" else "u4")
        if head >= 0:
            begin = self.data.find(b"_", head, head + 4096) + 1
            end = self.data.rfind(b"</AppendedData>")
            if not 0 < begin <= end or self.data[-4096:].rstrip()[-10:] != b"</VTKFile>":
                raise VolumeError("the file is truncated: the appended data are incomplete; copy "
                                  "it again")
            self.is_base64 = b'"base64"' in self.data[head:begin]
            self.appended = memoryview(self.data)[begin:end]
            self.offsets = sorted({int(a["offset"]) for a in self.arrays if "offset" in a})

    def _start(self, name, values):
        self._open.append(name)
        if len(self._open) > 64:
            raise VolumeError("invalid header: elements are nested too deeply")
        if name == "VTKFile":
            self.root = values
        elif name == self.root.get("type"):
            self.grid = values
        elif name == "Piece":
            self.pieces.append(values)
        elif name in ("PointData", "CellData") and self.pieces:
            self.pieces[-1][name] = values.get("Scalars", "")
        elif name in ("DataArray", "Array") and len(self._open) > 1:
            self.arrays.append(dict(values, parent=self._open[-2], piece=len(self.pieces) - 1,
                                    name=values.get("Name", ""), text=[]))

    def _text(self, text):
        if self._open[-1] in ("DataArray", "Array"):
            self.arrays[-1]["text"].append(text)

    def read(self, array, count=None):
        """Return the values of an array. Raise VolumeError unless there are `count`."""
        with prefix_errors("array " + array["name"]):
            dtype = np.dtype(self.order + _TYPES[array["type"]])
            need = None if count is None else count * dtype.itemsize
            if array["format"] == "ascii":
                words = "".join(array["text"]).split()
                values = np.array(words or [0]).astype(dtype)[:len(words)]
                if count is not None and len(values) != count:
                    raise ValueError("%d numbers instead of %d" % (len(values), count))
                return values
            if array["format"] == "appended":
                at = int(array["offset"])
                data = self.appended[at:min([o for o in self.offsets if o > at] or [None])]
                raw, used = self._decompressed(data, self.is_base64, need)
            else:
                data = memoryview("".join(array["text"]).strip().encode("ascii"))
                raw, used = self._decompressed(data, True, need)
            if len(data) - used > 4096 or bytes(data[used:]).strip():
                raise ValueError("%d extra bytes follow" % (len(data) - used))
            return np.frombuffer(raw, dtype)

    def _decompressed(self, data, is_base64, need):
        """Return the bytes of an array, and how many bytes of the data encode it."""
        wide = np.dtype(self.header).itemsize
        compressor = self.root.get("compressor", "")
        if not compressor:
            size = int(np.frombuffer(_decoded(data, is_base64, wide), self.header)[0])
            if need not in (None, size):
                raise ValueError("%d bytes instead of %d" % (size, need))
            return _decoded(data, is_base64, wide + size)[wide:], _encoded(wide + size, is_base64)
        head = np.frombuffer(_decoded(data, is_base64, 3 * wide), self.header)
        blocks, size, last = head.tolist()
        whole = (blocks - bool(last)) * size + last
        if blocks and not size or last > size or need not in (None, whole):
            raise ValueError("%d compressed blocks of %d bytes, the last one of %d, instead of %s "
                             "bytes" % (blocks, size, last, need))
        start = wide * (3 + blocks)
        sizes = np.frombuffer(_decoded(data, is_base64, start), self.header)[3:].tolist()
        head = _encoded(start, is_base64)  # in base64, sizes and blocks are encoded separately
        plain = _decoded(data[head:], is_base64, sum(sizes))
        result, at = bytearray(), 0
        for length, expected in zip(sizes, [size] * (blocks - 1) + [last or size]):
            block = _decompress(compressor, plain[at:at + length], expected)
            if len(block) != expected:
                raise ValueError("a block of %d bytes has %d" % (expected, len(block)))
            result += block
            at += length
        return result, head + _encoded(at, is_base64)


def _encoded(size, is_base64):
    """Return the number of bytes that encode `size` bytes."""
    return -(-size // 3) * 4 if is_base64 else size


def _decoded(data, is_base64, size):
    """Return the first `size` encoded bytes. Raise EOFError if there are fewer."""
    data = data[:_encoded(size, is_base64)]
    plain = memoryview(binascii.a2b_base64(data)) if is_base64 else data
    padding = bytes(data[-2:]).count(b"=") if is_base64 else 0
    if len(plain) < size or is_base64 and len(plain) != len(data) // 4 * 3 - padding:
        raise EOFError
    return plain[:size]


def _decompress(name, data, size):
    """Return at most `size` bytes of a compressed block."""
    if name == "vtkLZ4DataCompressor":
        from vtkmodules.vtkIOCore import vtkLZ4DataCompressor
        machine = vtkLZ4DataCompressor()
        machine.AddObserver("ErrorEvent", lambda *_: None)  # suppresses its output
        array = machine.Uncompress(bytes(data), len(data), size)  # bytes are fastest
        if array is None:
            raise EOFError
        block = bytes(array)
        array.Initialize()  # VTK 9.1 leaks the array; this releases its memory
        return block
    machine = {"vtkZLibDataCompressor": zlib.decompressobj,
               "vtkLZMADataCompressor": lzma.LZMADecompressor}[name]()
    block = machine.decompress(data, size + 1)
    if not machine.eof:
        raise EOFError
    return block
