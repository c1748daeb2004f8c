# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Formats with a header and voxels: NRRD, MetaImage, NumPy arrays, raw voxels, and InVesalius
projects. VTK 9.1's readers of NRRD and MetaImage ignore axis directions."""
from __future__ import annotations

import contextlib
import gzip
import math
import os
import plistlib
import re
import tarfile

import numpy as np

from ..errors import VolumeError
from .grid import from_stream, check_size, one_of_times, make_volume, voxels
from .volume import Label, prefix_errors, plain_name, text_of, unit_of

_LARGEST_HEADER = 1 << 20


# ---- Data in other files -----------------------------------------------------------------------

def _header_lines(path):
    """Return the lines of a text header, and a function: line number to offset after the line."""
    with open(path, "rb") as stream:
        data = stream.read(_LARGEST_HEADER)
    lines = data.split(b"\n")
    ends = np.cumsum([len(line) + 1 for line in lines])
    return [line.decode("utf-8", "replace").strip() for line in lines], lambda n: int(ends[n])


def data_files(path, value, following, count):
    """Return the data files in a header: a name, a pattern "%03d.raw FIRST LAST STEP", or LIST with
    the names in the `following` lines. `count` is their number, if several."""
    folder, words = os.path.dirname(path), value.split()
    if not words:
        raise VolumeError("invalid header: the data file is missing")
    if words[0] == "LIST":
        if any(word in ("3", "3D") for word in words[1:2]):
            count = 1
        names = [line for line in following if line]
        if len(names) < count:
            raise VolumeError("the header lists %d files for %d slices" % (len(names), count))
        names = names[:count]
    elif "%" in words[0]:
        first = int(words[1]) if len(words) > 1 else 1
        last = int(words[2]) if len(words) > 2 else first + count - 1
        step = int(words[3]) if len(words) > 3 else 1
        names = list(range(first, last + 1, step or 1))[:count] if last - first < 1 << 20 else []
        if not re.fullmatch(r"[^%]*%0?\d?\d?[diu][^%]*", words[0]) or len(names) != count:
            raise VolumeError("invalid header: the data file \"%s\" does not specify %d files, as "
                              "\"slice%%03d.raw 1 100 1\" specifies 100" % (value[:80], count))
        names = [re.sub(r"(%\d*)[iu]", r"\1d", words[0]) % n for n in names]
    else:
        names = [value]
    return [os.path.join(folder, name) for name in names]


def _values(files, offset, dtype, count, compression, **more):
    """Return `count` values of one file, or of several in equal parts. With a negative offset they
    are at the end. Compression "text": numbers separated by blanks."""
    dtype, parts = np.dtype(dtype), []
    if count * dtype.itemsize > 1 << 62:
        raise VolumeError("invalid header: it requires %d values" % count)
    for file in files:
        share = count // len(files)
        with prefix_errors(os.path.basename(file)) if len(files) > 1 else contextlib.nullcontext():
            last = max(0, os.path.getsize(file) - share * dtype.itemsize)
            start = last if offset < 0 else offset
            parts.append(_from_text(file, start, dtype, share) if compression == "text" else
                         voxels(file, start, dtype, share, compression, exact=True, **more))
    return parts[0] if len(parts) == 1 else np.concatenate(parts)


def _from_text(file, offset, dtype, count):
    """Return the numbers in a text file."""
    with open(file, "rb") as stream:
        stream.seek(offset)
        words = stream.read(min(os.path.getsize(file), 40 * count + 1000)).split()
    values = np.array(words).astype(dtype)
    if len(values) != count:
        raise VolumeError("the file is %s: it has %d values, its header requires %d; copy it again"
                          % ("truncated" if len(values) < count else "damaged", len(values), count))
    return values


# ---- NRRD --------------------------------------------------------------------------------------

_NRRD_TYPES = {name: kind for kind, names in {
    "i1": "signed char,int8,int8_t", "u1": "uchar,unsigned char,uint8,uint8_t",
    "i2": "short,short int,signed short,signed short int,int16,int16_t",
    "u2": "ushort,unsigned short,unsigned short int,uint16,uint16_t",
    "i4": "int,signed int,int32,int32_t", "u4": "uint,unsigned int,uint32,uint32_t",
    "i8": "longlong,long long,long long int,signed long long,int64,int64_t", "f4": "float",
    "u8": "ulonglong,unsigned long long,unsigned long long int,uint64,uint64_t", "f8": "double",
}.items() for name in names.split(",")}
_NRRD_FIELDS = set(
    "dimension,type,blocksize,encoding,endian,content,oldmin,oldmax,min,max,datafile,lineskip,"
    "byteskip,number,sampleunits,sizes,spacings,thicknesses,axismins,axismaxs,centers,centerings,"
    "labels,units,kinds,space,spacedimension,spaceunits,spaceorigin,spacedirections,"
    "measurementframe".split(","))
_COMPRESSIONS = {"raw": None, "gzip": "gzip", "gz": "gzip", "bzip2": "bz2", "bz2": "bz2",
                 "text": "text", "txt": "text", "ascii": "text"}
_SPACES = {"left-posterior-superior": "LPS", "right-anterior-superior": "RAS",
           "left-anterior-superior": "LAS"}


def _read_nrrd_header(path):
    """Return fields, key-value pairs, the following lines, and their offset."""
    lines, offset_after = _header_lines(path)
    if not lines[0].startswith("NRRD000"):
        raise VolumeError("not a NRRD file")
    fields, pairs, at = {}, {}, 0
    for at, line in enumerate(lines[1:], 1):
        name, colon, value = line.partition(":")
        field = name.lower().replace(" ", "")
        if not line:
            break
        if line[0] == "#":
            continue
        if value.startswith("="):
            pairs[name] = value[1:]
        elif colon and field in _NRRD_FIELDS:
            fields[field] = value.strip()
            if field == "datafile" and value.split()[:1] == ["LIST"]:
                break
        else:
            raise VolumeError("invalid header: \"%s\" is not a NRRD field" % plain_name(name[:80]))
    return fields, pairs, lines[at + 1:], offset_after(at)


def _vectors(text):
    """Return the vectors in a text such as "(1,0,0) none (0,1,0)"."""
    return [None if word == "none" else [float(n) for n in word.strip("()").split(",")]
            for word in re.findall(r"none|\([^)]*\)", text)]


def _nrrd_steps(fields, kinds):
    """Return the indices of the spatial axes, and the steps along them."""
    count = len(kinds)
    vectors = _vectors(fields.get("spacedirections", ""))
    if vectors:
        axes = [n for n, vector in enumerate(vectors) if vector]
        if len(vectors) != count or len(axes) != 3 or any(len(vectors[n]) != 3 for n in axes):
            raise VolumeError("invalid header: space directions \"%s\" are not three 3D vectors"
                              % fields["spacedirections"])
        return axes, np.array([vectors[n] for n in axes]).T
    axes = [n for n, kind in enumerate(kinds) if kind in ("domain", "space", "none", "???")][-3:]
    words = fields.get("spacings", "").split() or ["1"] * count
    if len(axes) != 3 or len(words) != count:
        raise VolumeError("%d spatial axes and %d spacings; a volume has three"
                          % (len(axes), len(words)))
    steps = np.array([float(words[n]) for n in axes])
    return axes, np.diag(np.where(np.isnan(steps), 1, steps))


def read_nrrd(path, choice):
    """Read NRRD with attached or detached voxels, and segments of 3D Slicer."""
    fields, pairs, following, start = _read_nrrd_header(path)
    for name in ("type", "sizes", "dimension"):
        if name not in fields:
            raise VolumeError("invalid header: missing field " + name)
    sizes = [int(n) for n in fields["sizes"].split()]
    kind, encoding = fields["type"].lower(), fields.get("encoding", "raw").lower()
    endian = fields.get("endian", "little").lower()
    if kind not in _NRRD_TYPES or encoding not in _COMPRESSIONS or endian not in ("little", "big"):
        raise VolumeError("type \"%s\", encoding \"%s\" and endian \"%s\" are not supported"
                          % (kind, encoding, endian))
    if fields["dimension"] != str(len(sizes)) or not 3 <= len(sizes) <= 4 or min(sizes) < 1:
        raise VolumeError("dimension %s and sizes \"%s\" are not those of a volume, which has "
                          "three axes, or four with components"
                          % (fields["dimension"], fields["sizes"]))
    dtype = np.dtype(_NRRD_TYPES[kind]).newbyteorder(">" if endian == "big" else "<")
    kinds = (fields.get("kinds", "").lower().split() or ["domain"] * len(sizes))
    kinds += ["domain"] * (len(sizes) - len(kinds))
    axes, steps = _nrrd_steps(fields, kinds)
    others = [n for n in range(len(sizes)) if n not in axes]
    files = [path]
    if "datafile" in fields:
        files, start = data_files(path, fields["datafile"], following, sizes[-1]), 0
    compression, count = _COMPRESSIONS[encoding], math.prod(sizes)
    start += _bytes_of_lines(files[0], start, int(fields.get("lineskip", 0)))
    skip = int(fields.get("byteskip", 0))
    more = {"skip": max(skip, 0)} if compression in ("gzip", "bz2") else {}
    start = start if more else -1 if skip < 0 else start + skip
    array = _values(files, start, dtype, count, compression, **more).reshape(sizes[::-1])
    labels = _segments(pairs, sizes[others[0]] if others else 1)
    components = ""
    if others:
        array = np.moveaxis(array, len(sizes) - 1 - others[0], 0)
        components = kinds[others[0]]
        if components in ("list", "time") and others[0] == 3 and not labels:
            array, components = array[one_of_times(len(array), choice)], ""
        elif components not in ("list", "time", "rgba-color", "4-color") or labels:
            components = "color" if "color" in components else "vector"
    origins = _vectors(fields.get("spaceorigin", "")) or [[0, 0, 0]]
    space = fields.get("space", "").lower()
    units = re.findall(r'"([^"]*)"', fields.get("spaceunits", fields.get("units", "")))
    space = _SPACES.get(space, space.upper() if space.upper() in _SPACES.values() else "")
    return make_volume(array, steps, origins[0], space, unit_of(units[-1]) if units else "", choice,
                       labels=labels, components=components)


def _bytes_of_lines(file, start, count):
    """Return the number of bytes of `count` lines from `start`."""
    with open(file, "rb") as stream:
        stream.seek(start)
        return sum(len(stream.readline()) for _ in range(min(count, _LARGEST_HEADER)))


def _segments(pairs, components):
    """Return the labels of 3D Slicer: Segment0_Name, Segment0_LabelValue, Segment0_Layer,
    Segment0_Color. Older files have one component per segment and no value or layer."""
    labels = []
    for number in sorted({int(m[1]) for m in (re.match(r"Segment(\d{1,9})_Name$", k) for k in pairs)
                          if m}):
        def get(name, other, kind=int, start="Segment%d_" % number):
            try:
                return kind(pairs[start + name])
            except (KeyError, ValueError):
                return other
        is_old = components > 1 and get("Layer", None) is None
        color = get("Color", None, lambda text: tuple(float(n) for n in text.split()[:3]))
        name = re.sub(r"\\(.)", lambda m: " " if m[1] == "n" else m[1], get("Name", "", str))
        labels.append(Label(get("LabelValue", 1 if is_old else number + 1), plain_name(name),
                            color if color and len(color) == 3 else None,
                            get("Layer", number if is_old else 0)))
    return labels


# ---- MetaImage ---------------------------------------------------------------------------------

_META_TYPES = {"UCHAR": "u1", "CHAR": "i1", "SHORT": "i2", "USHORT": "u2", "INT": "i4",
               "UINT": "u4", "LONG": "i4", "ULONG": "u4", "LONG_LONG": "i8", "ULONG_LONG": "u8",
               "FLOAT": "f4", "DOUBLE": "f8"}


def read_meta_image(path, choice):
    """Read MetaImage: .mha, or .mhd with detached voxels."""
    lines, offset_after = _header_lines(path)
    fields, at = {}, 0
    for at, line in enumerate(lines):
        name, _, value = line.partition("=" if "=" in line else ":")
        fields.setdefault(name.strip().lower(), value.strip())
        if name.strip().lower() == "elementdatafile":
            break

    def get(*names, default=""):
        return next((fields[name] for name in names if fields.get(name)), default)

    def numbers(default, *names):
        return np.array([float(word) for word in get(*names, default=default).split()])

    def is_true(*names, default="false"):
        value = get(*names, default=default).lower()
        if value not in ("true", "t", "1", "false", "f", "0"):
            raise VolumeError("invalid header: %s is \"%s\"" % (names[0], value))
        return value[0] in "t1"

    sizes = [int(n) for n in get("dimsize").split()]
    count, kind = len(sizes), re.sub("^MET_|_ARRAY$", "", get("elementtype"))
    channels = int(get("elementnumberofchannels", default="1"))
    if get("ndims") != str(count) or not 2 <= count <= 4 or min(sizes) < 1 or channels < 1:
        raise VolumeError("invalid header, or not a volume: NDims is %s, DimSize \"%s\""
                          % (get("ndims"), get("dimsize")))
    if kind not in _META_TYPES:
        raise VolumeError("invalid header: the ElementType \"%s\" is not numeric"
                          % get("elementtype"))
    is_big = is_true("binarydatabyteordermsb", "elementbyteordermsb")
    dtype = np.dtype(_META_TYPES[kind]).newbyteorder(">" if is_big else "<")
    compression = ("text" if not is_true("binarydata", default="true")
                   else "zlib" if is_true("compresseddata") else None)
    data, skip = get("elementdatafile"), 0 if compression else int(get("headersize", default="0"))
    is_here = data.lower() == "local"
    files = [path] if is_here else data_files(path, data, lines[at + 1:], sizes[-1])
    start = -1 if skip < 0 else skip + (offset_after(at) if is_here else 0)
    total = math.prod(sizes) * channels
    array = _values(files, start, dtype, total, compression)
    sizes += [1] * (4 - count)
    array = array.reshape(sizes[::-1] + [channels])[one_of_times(sizes[3], choice)]
    array = np.moveaxis(array, -1, 0) if channels > 1 else array[..., 0]
    matrix = numbers(text_of(np.eye(count).ravel(), " "), "transformmatrix", "rotation",
                     "orientation")
    spacing = numbers("1 " * count, "elementspacing", "elementsize")
    origin = numbers("0 " * count, "offset", "position", "origin")
    if (len(matrix), len(spacing), len(origin)) != (count * count, count, count):
        raise VolumeError("invalid header: directions require %d numbers, spacing and offset %d"
                          % (count * count, count))
    steps, position = np.eye(3), np.zeros(3)
    axes = min(count, 3)
    steps[:axes, :axes] = (matrix.reshape(count, count).T * spacing)[:axes, :axes]
    position[:axes] = origin[:axes]
    sides = get("anatomicalorientation")  # origin of the voxel axes, not of the world axes
    return make_volume(array, steps, position, "LPS" if re.fullmatch("[LRAPSI]{3}", sides) else "",
                       unit_of(get("distanceunits")), choice, name="MetaImage",
                       components="vector" if channels > 1 else "")


# ---- NumPy, raw voxels, InVesalius -------------------------------------------------------------

def read_npy(path, choice):
    """Read an array [z, y, x], or [x, y, z] in Fortran order, of .npy or .npz."""
    array, name = np.load(path, mmap_mode="r", allow_pickle=False), ""
    if isinstance(array, np.ndarray):
        check_size(os.path.getsize(path) - array.offset, array.nbytes, exact=True)
    else:
        with array as file:
            names = [n for n in file.files if choice.array in (None, "", n)]
            if len(names) != 1:
                raise VolumeError("the arrays are %s; choose one with --array"
                                  % ", ".join(file.files))
            array, name = file[names[0]], names[0]
    array = array if array.flags.c_contiguous else array.T
    while array.ndim > 3 and len(array) == 1:  # one time or channel
        array = array[0]
    if array.ndim != 3:
        raise VolumeError("the shape is (%s), but a volume has three axes; save a single channel "
                          "or time" % text_of(array.shape, ", "))
    return make_volume(array, np.eye(3), [0, 0, 0], "", "", choice, name=name)


def read_raw(path, choice):
    """Read voxels without header as --raw describes them, such as 512,512,400,uint16,big."""
    words = [word.strip().lower() for word in choice.raw.split(",")]
    kinds = "int8 int16 int32 int64 float16 float32 float64 float double".split()
    kinds += ["u" + kind for kind in kinds[:4]] + "u1 i1 u2 i2 u4 i4 u8 i8 f2 f4 f8".split()
    if not (4 <= len(words) <= 5 and all(w.isdigit() and int(w) > 0 for w in words[:3])
            and words[3] in kinds and words[4:] in ([], ["little"], ["big"])):
        raise VolumeError("--raw \"%s\" is not three dimensions, a type (uint8 to int64, float16 "
                          "to float64) and the byte order (little or big), such as "
                          "512,512,400,uint16,little" % choice.raw)
    sizes = [int(n) for n in words[2::-1]]
    dtype = np.dtype("float32" if words[3] == "float" else words[3])
    dtype = dtype.newbyteorder(">" if words[4:] == ["big"] else "<")
    return make_volume(_values([path], 0, dtype, math.prod(sizes), None)
                       .reshape(sizes), np.eye(3), [0, 0, 0], "", "", choice)


def read_inv3(path, choice):
    """Read an InVesalius project: a tar archive with main.plist and matrix.dat, in mm."""
    def member(archive, name):
        found = next((m for m in archive if m.name.rsplit("/", 1)[-1] == name), None)
        if not found or not found.isreg() or found.issparse():
            raise VolumeError("not an InVesalius project: %s is missing" % name)
        return found

    with open(path, "rb") as stream:
        opener = gzip.open if stream.read(2) == b"\x1f\x8b" else open
    with opener(path, "rb") as plain, tarfile.open(fileobj=plain, mode="r:") as archive:
        found = member(archive, "main.plist")
        if found.size > _LARGEST_HEADER:
            raise VolumeError("not an InVesalius project: main.plist is too large")
        shape, dtype, steps, name, space = _inv3_header(archive.extractfile(found).read())
        found, count = member(archive, name), math.prod(shape)
        check_size(found.size, count * dtype.itemsize, exact=True)
        array = from_stream(archive.extractfile(found), dtype, count)
        while plain.read(1 << 20):  # verifies the checksum at the end
            pass
    return make_volume(array.reshape(shape), steps, [0, 0, 0], space, "mm", choice)


def _inv3_header(data):
    """Return shape, type, steps, data file and space in main.plist."""
    with prefix_errors("main.plist"):
        if data.count(b"<") > 100000:
            raise ValueError("too many elements")
        project = plistlib.loads(data, fmt=plistlib.FMT_XML)
        matrix, spacing = project["matrix"], [float(s) for s in project["spacing"]]
        shape, dtype = [int(n) for n in matrix["shape"]], str(matrix["dtype"])
        name = os.path.basename(str(matrix.get("filename", "matrix.dat")))
    if len(shape) != 3 or len(spacing) != 3 or min(shape) < 1 or min(spacing) <= 0:
        raise VolumeError("main.plist: dimensions %s and spacing %s are not those of a volume"
                          % (text_of(shape), text_of(spacing)))
    if not re.fullmatch(r"u?int(8|16|32|64)|float(32|64)", dtype):
        raise VolumeError("main.plist: voxels of type \"%s\" are not supported" % dtype)
    # Rows of axial slices are stored from back to front.
    space = "LAS" if str(project.get("orientation", 1)) == "1" else ""
    return shape, np.dtype(dtype).newbyteorder("<"), np.diag(spacing), name, space
