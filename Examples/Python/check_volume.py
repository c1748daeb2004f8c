# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Looks at files before VTK reads them.

VTK's readers of MetaImage and NIfTI give what memory holds where a file has been cut off or
damaged, or end the program. So the sizes and the checksums are compared here; VolumeError tells.
"""

import contextlib
import gzip
import os
import struct
import zlib

from volume_image import VolumeError

PIECE = 1 << 20  # bytes at a time
META_BYTES = {"MET_CHAR": 1, "MET_UCHAR": 1, "MET_SHORT": 2, "MET_USHORT": 2, "MET_INT": 4,
              "MET_UINT": 4, "MET_LONG": 4, "MET_ULONG": 4, "MET_LONG_LONG": 8,
              "MET_ULONG_LONG": 8, "MET_FLOAT": 4, "MET_DOUBLE": 8}
NIFTI_TYPES = {2, 4, 8, 16, 32, 64, 128, 256, 512, 768, 1024, 1280, 1792, 2304}


def inflate(pieces, size, path, keep=True):
    """What zlib or gzip data unpack to, which must be `size` bytes; `pieces` yields the data.

    They are unpacked to their end: the checksum stands there. Not kept, they are only checked.
    """
    unpacked, done, packed = [], 0, b""
    unpacker = zlib.decompressobj(wbits=47)  # zlib or gzip, by its head
    pieces = iter(pieces)
    try:
        while not unpacker.eof or done < size:
            if unpacker.eof:  # several members, one behind the other, are one gzip file
                packed = unpacker.unused_data or next(pieces, b"")
                unpacker = zlib.decompressobj(wbits=47)
            packed = packed or unpacker.unconsumed_tail or next(pieces, b"")
            if not packed:
                raise VolumeError(f"{path}: the packed data are cut off: they give {done} of"
                                  f" {size} bytes")
            piece = unpacker.decompress(packed, PIECE)
            packed, done = b"", done + len(piece)
            if done > size:
                raise VolumeError(f"{path}: the packed data give more than the {size} bytes that"
                                  " the header tells of")
            if keep:
                unpacked.append(piece)
    except zlib.error as error:
        raise VolumeError(f"{path}: the packed data are damaged ({error})") from error
    return b"".join(unpacked)


def need_bytes(there, needed, path):
    if there < needed:
        raise VolumeError(f"{path}: the file is cut off: it has {there} bytes of voxels, its header"
                          f" asks for {needed}; copy it again")


def meta_fields(path):
    """Names and values of a MetaImage's header; "start" is where it ends."""
    fields = {}
    with open(path, "rb") as file:
        for line in iter(file.readline, b""):
            name, _, value = line.decode("latin-1").partition("=")
            fields[name.strip()] = value.strip()
            if name.strip() == "ElementDataFile":
                break
        fields["start"] = file.tell()
    return fields


def meta_files(path):
    """The files that the header names: none if it stands before its data."""
    try:
        fields = meta_fields(path)
        words = fields.get("ElementDataFile", "LOCAL").split() or ["LOCAL"]
        folder = os.path.dirname(path)
        if words[0].upper() == "LOCAL":
            return []
        if words[0] == "LIST":
            with open(path, "rb") as file:
                file.seek(fields["start"])
                names = file.read().decode("latin-1").splitlines()
            return [os.path.join(folder, name.strip()) for name in names if name.strip()]
        if "%" in words[0]:
            first, last, step = (int(n) for n in (*words[1:], "1")[:3])
            return [os.path.join(folder, words[0] % n) for n in range(first, last + 1, step)]
        return [os.path.join(folder, fields["ElementDataFile"])]
    except (OSError, ValueError, TypeError):
        return []  # a file that cannot be read, which the reader tells


def check_meta(path):
    """A VolumeError where a MetaImage's data are shorter than its header says, or damaged."""
    fields = meta_fields(path)
    try:
        values = int(fields.get("ElementNumberOfChannels", 1))
        for size in fields["DimSize"].split():
            values *= int(size)
        skip = int(fields.get("HeaderSize", 0))
    except (KeyError, ValueError) as error:
        raise VolumeError(f"{path}: its header is damaged ({error})") from error
    needed = values * META_BYTES.get(fields.get("ElementType"), 1)
    files = meta_files(path)
    start = 0 if files else fields["start"]
    files = files or [path]
    for name in files:
        if not os.path.isfile(name):
            raise VolumeError(f"{path}: its data file {name} is missing")
    is_true = {key: fields.get(key, default).lower() in ("true", "1")
               for key, default in (("CompressedData", "false"), ("BinaryData", "true"))}
    if len(files) > 1:
        if not is_true["CompressedData"]:
            need_bytes(sum(map(os.path.getsize, files)), needed, path)
        return
    with open(files[0], "rb") as file:
        file.seek(start)
        if not is_true["BinaryData"]:
            count = len(file.read().split())
            if count < values:
                raise VolumeError(f"{path}: the file is cut off: it has {count} values, its header"
                                  f" asks for {values}")
        elif is_true["CompressedData"]:
            inflate(iter(lambda: file.read(PIECE), b""), needed, path, keep=False)
        else:
            need_bytes(os.path.getsize(files[0]) - start - max(skip, 0), needed, path)


def check_nifti(path):
    """A VolumeError where a NIfTI file has voxels of no known type, or packed data are damaged."""
    with contextlib.ExitStack() as stack:
        file = stack.enter_context(open(path, "rb"))
        is_packed = file.read(2) == b"\x1f\x8b"
        file.seek(0)
        if is_packed:
            file = stack.enter_context(gzip.open(file))
        try:
            header = file.read(540)
            while is_packed and file.read(PIECE):
                pass  # the checksum stands at the end
        except (EOFError, OSError, zlib.error) as error:
            raise VolumeError(f"{path}: the packed data are damaged or cut off ({error})"
                              ) from error
    for order in "<>":
        size = struct.unpack_from(order + "i", header)[0] if len(header) >= 76 else 0
        if size in (348, 540):
            kind = struct.unpack_from(order + "H", header, 70 if size == 348 else 12)[0]
            if kind not in NIFTI_TYPES:
                raise VolumeError(f"{path}: its header is damaged: the data type {kind} is none of"
                                  " NIfTI's types of numbers")
