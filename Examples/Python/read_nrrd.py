# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Read NRRD volumes (.nrrd, and .nhdr with a detached data file).

VTK's own vtkNrrdReader keeps neither the directions of the axes nor compressed data, so the format
is read here: https://teem.sourceforge.net/nrrd/format.html. Encodings raw, gzip, bzip2, text.
"""

import bz2
import os
import re

import numpy as np

from check_volume import inflate
from volume_image import VolumeError, make_image

TYPES = {
    "i1": "signed char|int8|int8_t",
    "u1": "uchar|unsigned char|uint8|uint8_t",
    "i2": "short|short int|signed short|signed short int|int16|int16_t",
    "u2": "ushort|unsigned short|unsigned short int|uint16|uint16_t",
    "i4": "int|signed int|int32|int32_t",
    "u4": "uint|unsigned int|uint32|uint32_t",
    "i8": "longlong|long long|long long int|signed long long|signed long long int|int64|int64_t",
    "u8": "ulonglong|unsigned long long|unsigned long long int|uint64|uint64_t",
    "f4": "float",
    "f8": "double",
}
TYPE_CODES = {name: code for code, names in TYPES.items() for name in names.split("|")}
SPACES = {
    "right-anterior-superior": "RAS", "ras": "RAS",
    "left-anterior-superior": "LAS", "las": "LAS",
    "left-posterior-superior": "LPS", "lps": "LPS",
}


def read_nrrd(path):
    """vtkImageData of a three-dimensional scalar NRRD; world coordinates are the file's `space`."""
    with open(path, "rb") as file:
        content = file.read()
    fields, data_start = parse_header(content, path)
    try:
        sizes = [int(n) for n in fields["sizes"].split()]
        dtype = np.dtype(TYPE_CODES[fields["type"].lower()])
    except KeyError as error:
        raise VolumeError(f"{path}: the field or type {error} is missing or not a number type"
                          ) from error
    except ValueError as error:
        raise VolumeError(f"{path}: sizes '{fields['sizes']}' are not numbers") from error
    if len(sizes) != 3 or min(sizes) < 1:
        raise VolumeError(f"{path}: sizes {sizes}; a volume with one scalar component has three")
    if dtype.itemsize > 1 and fields.get("endian", "little").lower() == "big":
        dtype = dtype.newbyteorder(">")
    if "data file" in fields:
        content, data_start = read_data_file(fields["data file"], path), 0
    voxels = decode(content[data_start:], fields, dtype, sizes, path)
    spacing, origin, direction = geometry(fields, path)
    axes = SPACES.get(fields.get("space", "").lower())
    return make_image(voxels, spacing, origin, direction, axes)


def nrrd_files(path):
    """The file that the header names: none if it stands before its data, or there is no header."""
    try:
        with open(path, "rb") as file:
            fields, _ = parse_header(file.read(1 << 16), path)
    except (OSError, VolumeError):
        return []
    name = fields.get("data file")
    return [os.path.join(os.path.dirname(path), name)] if name else []


def parse_header(content, path):
    """Fields by lower-case name, and where the data of an attached file start."""
    if not content.startswith(b"NRRD000"):
        raise VolumeError(f"{path}: does not start as a NRRD file does")
    end = re.search(rb"\r?\n\r?\n", content)
    header = content[: end.start() if end else len(content)].decode("ascii", "replace")
    fields = {}
    for line in header.splitlines()[1:]:
        if line.startswith("#") or ":=" in line or ":" not in line:
            continue
        name, value = line.split(":", 1)
        name = name.strip().lower()
        fields["data file" if name == "datafile" else name] = value.strip()
    return fields, end.end() if end else len(content)


def read_data_file(name, path):
    """Bytes of a detached data file, which lies beside the header or at an absolute path."""
    if name.split()[0] == "LIST" or "%" in name:
        raise VolumeError(f"{path}: data spread over several files are not read")
    data_path = os.path.join(os.path.dirname(os.path.abspath(path)), name)
    try:
        with open(data_path, "rb") as file:
            return file.read()
    except OSError as error:
        raise VolumeError(f"{path}: its data file {data_path} cannot be read ({error})") from error


def decode(data, fields, dtype, sizes, path):
    """The voxels as array [z, y, x]."""
    encoding = fields.get("encoding", "raw").lower()
    skip = int(fields.get("byte skip", "0"))
    for _ in range(int(fields.get("line skip", "0"))):
        data = data[data.index(b"\n") + 1:]
    count = int(np.prod(sizes, dtype=np.int64))
    try:
        if encoding in ("gzip", "gz"):
            data = inflate([data], count * dtype.itemsize + max(skip, 0), path)
        elif encoding in ("bzip2", "bz2"):
            data = bz2.decompress(data)
        elif encoding in ("text", "txt", "ascii"):
            values = np.array(data.split(), dtype=float)
            data = values.astype(dtype).tobytes()
        elif encoding != "raw":
            raise VolumeError(f"{path}: encoding '{encoding}' is not known")
    except (OSError, ValueError) as error:
        raise VolumeError(f"{path}: the {encoding} data are damaged ({error})") from error
    data = data[len(data) - count * dtype.itemsize if skip == -1 else skip:]
    if len(data) < count * dtype.itemsize:
        raise VolumeError(f"{path}: {len(data)} bytes of voxels, {count * dtype.itemsize} needed")
    return np.frombuffer(data, dtype, count).reshape(sizes[::-1])


def geometry(fields, path):
    """Spacing, origin and direction (columns: index axes) in the file's space."""
    def vector(text):
        numbers = [float(n) for n in text.strip("() \t").split(",")]
        if len(numbers) != 3:
            raise ValueError(text)
        return numbers

    try:
        origin = vector(fields["space origin"]) if "space origin" in fields else (0, 0, 0)
        if "space directions" in fields:
            columns = [vector(t) for t in re.findall(r"\([^)]*\)", fields["space directions"])]
            edges = np.array(columns).reshape(3, 3).T
            spacing = np.linalg.norm(edges, axis=0)
            return spacing, origin, edges / np.where(spacing > 0, spacing, 1)
        numbers = [float(s) for s in fields.get("spacings", "1 1 1").split()]
        spacing = [1.0 if np.isnan(s) else s for s in numbers]
        if len(spacing) != 3:
            raise ValueError(fields["spacings"])
    except ValueError as error:
        raise VolumeError(f"{path}: the place of the volume cannot be parsed ({error})") from error
    return spacing, origin, None
