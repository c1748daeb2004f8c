# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Small files of medical formats for tests of the readers, written byte by byte.

No code of the readers is used, so that the tests are independent. Voxels are arrays [z, y, x]; the
columns of directions are the index axes.
"""

import io
import plistlib
import struct
import tarfile

import numpy as np

NRRD_TYPES = {"i2": "short", "u1": "uchar"}
EXPLICIT, IMPLICIT = "1.2.840.10008.1.2.1", "1.2.840.10008.1.2"


def meta_header(voxels, spacing, origin, directions):
    """Return the header of a MetaImage with attached voxels (short)."""
    return "\n".join([
        "ObjectType = Image", "NDims = 3", "BinaryData = True", "BinaryDataByteOrderMSB = False",
        "CompressedData = False", f"TransformMatrix = {directions}",
        "Offset = " + " ".join(map(str, origin)), "AnatomicalOrientation = RAI",
        "ElementSpacing = " + " ".join(map(str, spacing)),
        "DimSize = " + " ".join(map(str, voxels.shape[::-1])),
        "ElementType = MET_SHORT", "ElementDataFile = LOCAL", ""]).encode()


def nrrd_header(voxels, spacing, origin, direction, encoding, endian):
    """Return the header of a NRRD file, without the empty line at its end."""
    columns = (np.asarray(direction) * spacing).T
    return "\n".join([
        "NRRD0004", "# made by hand", f"type: {NRRD_TYPES[voxels.dtype.str[1:]]}", "dimension: 3",
        "space: left-posterior-superior", "sizes: " + " ".join(map(str, voxels.shape[::-1])),
        "space directions: " + " ".join("(" + ",".join(map(str, c)) + ")" for c in columns),
        "space origin: (" + ",".join(map(str, origin)) + ")", "kinds: domain domain domain",
        f"endian: {endian}", f"encoding: {encoding}", "key:=value", ""]).encode()


def nifti(voxels, spacing, sform=None, qfac=1, offset=(0, 0, 0), slope=1, intercept=0):
    """Return a NIfTI-1 file of short voxels. The qform is the identity with an offset."""
    header = bytearray(352)
    sizes = voxels.shape[::-1]
    struct.pack_into("<i", header, 0, 348)
    struct.pack_into("<8h", header, 40, len(sizes), *sizes, *[1] * (7 - len(sizes)))
    struct.pack_into("<hh", header, 70, 4, 16)
    struct.pack_into("<8f", header, 76, qfac, *spacing, 0, 0, 0, 0)
    struct.pack_into("<fff", header, 108, 352, slope, intercept)
    struct.pack_into("<hh", header, 252, 1, 0 if sform is None else 1)
    struct.pack_into("<6f", header, 256, 0, 0, 0, *offset)
    if sform is not None:
        struct.pack_into("<12f", header, 280, *np.ravel(sform))
    header[344:348] = b"n+1\0"
    return bytes(header) + voxels.astype("<i2").tobytes()


def mrc(voxels, spacing, mode=1, order=(1, 2, 3)):
    header = bytearray(1024)
    sizes = voxels.shape[::-1]
    struct.pack_into("<10i", header, 0, *sizes, mode, 0, 0, 0, *sizes)
    struct.pack_into("<6f", header, 40, *(n * s for n, s in zip(sizes, spacing)), 90, 90, 90)
    struct.pack_into("<3i", header, 64, *order)
    header[208:214] = b"MAP \x44\x44"
    return bytes(header) + voxels.tobytes()


def archive_of(files):
    """Return a .tar.gz with files (name, bytes) in a folder, as InVesalius writes it."""
    packed = io.BytesIO()
    with tarfile.open(fileobj=packed, mode="w:gz") as archive:
        for name, data in files:
            member = tarfile.TarInfo("folder/" + name)
            member.size = len(data)
            archive.addfile(member, io.BytesIO(data))
    return packed.getvalue()


def inv3(voxels, spacing, **changes):
    """Return an InVesalius project with only a volume; `changes` applies to its matrix."""
    project = {"matrix": {"dtype": "int16", "filename": "matrix.dat",
                          "shape": list(voxels.shape), **changes},
               "spacing": [float(s) for s in spacing], "orientation": 1}
    return archive_of([("matrix.dat", voxels.tobytes()), ("main.plist", plistlib.dumps(project))])


def dicom_slice(pixels, number, spacing, origin, direction, syntax="explicit", **changes):
    """Return a DICOM file with one slice. syntax: explicit, implicit or a UID."""
    identifier = {"explicit": EXPLICIT, "implicit": IMPLICIT}.get(syntax, syntax)
    direction = np.asarray(direction)
    values = {"series": "1.2.3", "description": "head", "samples": 1, "slope": None,
              "intercept": None, "frames": None, "kind": None,
              "bits": 16, "lacks": (), "more": (), "data": None, **changes}
    position = np.asarray(origin) + direction[:, 2] * spacing[2] * number
    elements = [
        (0x0008, 0x0016, "UI", values["kind"]),
        (0x0008, 0x103E, "LO", values["description"]),
        # Nested sequence of undefined length, which the reader must skip.
        (0x0008, 0x1140, "SQ", struct.pack("<HHI", 0xFFFE, 0xE000, 0xFFFFFFFF)
         + element(0x0020, 0x000E, "UI", "9.9.9", syntax != "implicit")
         + struct.pack("<HHI", 0xFFFE, 0xE00D, 0) + struct.pack("<HHI", 0xFFFE, 0xE0DD, 0)),
        (0x0020, 0x000E, "UI", values["series"]),
        (0x0020, 0x0032, "DS", None if "position" in values["lacks"] else decimal(position)),
        (0x0020, 0x0037, "DS", None if "orientation" in values["lacks"]
         else decimal([*direction[:, 0], *direction[:, 1]])),
        (0x0028, 0x0002, "US", values["samples"]),
        (0x0028, 0x0008, "IS", values["frames"]),
        (0x0028, 0x0010, "US", pixels.shape[0]),
        (0x0028, 0x0011, "US", pixels.shape[1]),
        (0x0028, 0x0030, "DS", decimal([spacing[1], spacing[0]])),
        (0x0028, 0x0100, "US", values["bits"]),
        (0x0028, 0x0103, "US", 1 if pixels.dtype.kind == "i" else 0),
        (0x0028, 0x1052, "DS", values["intercept"]),
        (0x0028, 0x1053, "DS", values["slope"]),
        *values["more"],
        (0x7FE0, 0x0010, "OW", pixels.astype("<u2").tobytes()
         if values["data"] is None else values["data"]),
    ]
    elements.sort(key=lambda entry: entry[:2])
    body = b"".join(element(*entry, syntax != "implicit") for entry in elements
                    if entry[3] is not None)
    return bytes(128) + b"DICM" + element(2, 0x10, "UI", identifier, True) + body


def decimal(numbers):
    """Return numbers as a DICOM decimal string."""
    return "\\".join(f"{n:g}" for n in numbers)


def element(group, number, kind, value, explicit):
    """Return a data element; kind is its value representation."""
    if isinstance(value, int):
        value = struct.pack("<H", value)
    elif isinstance(value, str):
        value = value.encode() + (b"" if len(value) % 2 == 0 else b"\0" if kind == "UI" else b" ")
    length = 0xFFFFFFFF if kind == "SQ" else len(value)
    head = struct.pack("<HH", group, number)
    if not explicit:
        return head + struct.pack("<I", length) + value
    if kind in ("SQ", "OW"):
        return head + kind.encode() + struct.pack("<HI", 0, length) + value
    return head + kind.encode() + struct.pack("<H", length) + value
