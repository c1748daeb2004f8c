# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Pixels of DICOM files. GDCM decompresses them in a worker process, as it may crash."""
from __future__ import annotations

import collections
import os
import re
import resource
import warnings

import numpy as np

from ..errors import VolumeError
from .grid import check_size
from .volume import prefix_errors
from .worker import in_worker, set_current_item, captured_output

COPY_OR_MOVE = "; copy it again, or move it to another folder"


def read_file(file, name, is_header=False):
    """Return the data set of a file, or, if `is_header`, its elements before the pixels."""
    import pydicom
    warnings.filterwarnings("ignore", module="pydicom")
    with prefix_errors(name):
        with open(file, "rb") as stream:
            data = pydicom.dcmread(stream, force=True, stop_before_pixels=is_header)
            data.syntax = (data.file_meta.get("TransferSyntaxUID")
                           or pydicom.uid.ImplicitVRLittleEndian)
            data.has_pixels = data.syntax.is_deflated or stream.read(4) in (
                b"\xe0\x7f\x10\0", b"\x7f\xe0\0\x10")  # pydicom stops there
            return data


def values_of(slices):
    """Return the rescaled values [slice, y, x] and their minimum, which replaces padding."""
    raw = None
    for i, pixels in pixels_of(slices):
        raw = np.empty((len(slices), *pixels.shape), pixels.dtype) if raw is None else raw.astype(
            np.promote_types(raw.dtype, pixels.dtype), copy=False)
        raw[i] = pixels
    ends = []
    for plane, s in zip(raw, slices):
        kept = plane if s.padding is None else plane[plane != s.padding]
        if kept.size:
            ends += [s.slope * float(end) + s.shift for end in (kept.min(), kept.max())]
    minimum, maximum = min(ends, default=0.), max(ends, default=0.)
    factors, dtype = np.array([(s.slope, s.shift) for s in slices]), raw.dtype
    if (factors != (1, 0)).any():
        fits = [t for t in ("i2", "u2", "i4") if np.iinfo(t).min <= minimum
                and maximum <= np.iinfo(t).max]
        dtype = np.dtype("f4" if (factors % 1).any() else (fits + ["f8"])[0])
    result = raw.view(dtype) if dtype.itemsize == raw.itemsize else np.empty(raw.shape, dtype)
    for plane, new, s in zip(raw, result, slices):
        values = plane if (s.slope, s.shift) == (1, 0) else plane * s.slope + s.shift
        new[...] = values if s.padding is None else np.where(plane == s.padding, minimum, values)
    return result, minimum


def pixels_of(slices):
    """Yield index and stored pixels of each slice, file by file."""
    numbers = collections.defaultdict(list)
    for number, each in enumerate(slices):
        numbers[each.file, each.name].append(number)
    compressed = [file for file, those in numbers.items() if slices[those[0]].is_packed]
    for file in compressed:
        _complete_file(*file)
    decompressed = dict(zip(compressed, in_worker(
        "volumic.reading.dicom_pixels:decompress", compressed) if compressed else []))
    for file, those in numbers.items():
        size = slices[those[0]].size
        area = size[0] * size[1]
        values, bits = ((decompressed.pop(file), 8) if file in decompressed
                        else _uncompressed(*file, area))
        for number in those:
            at = slices[number].frame * area
            part = values[at:at + area] if bits > 1 else np.unpackbits(
                values[at // 8:(at + area + 7) // 8], bitorder="little")[at % 8:at % 8 + area]
            if part.size != area:
                raise VolumeError("%s: fewer pixels than its dimensions require" % file[1])
            yield number, part.reshape(size)


def _complete_file(file, name):
    """Return the data set of a file. Raise VolumeError if it does not end after its pixels."""
    data = read_file(file, name)
    tags, end = list(data.keys()), os.path.getsize(file)
    if "PixelData" not in data:
        raise VolumeError("%s: no pixels: truncated, or not a slice%s" % (name, COPY_OR_MOVE))
    last, following = data.get_item(tags[-1]), tags[tags.index(0x7FE00010):]
    if hasattr(last, "value_tell") and last.length != 0xFFFFFFFF and not data.syntax.is_deflated:
        end = last.value_tell + last.length
    if following != sorted(following) or end != os.path.getsize(file):
        raise VolumeError("%s: truncated or damaged: the file does not end after its pixels; copy "
                          "the file again" % name)
    return data


def _uncompressed(file, name, area):
    """Return the values of an uncompressed file (bytes for 1 bit) and their number of bits."""
    data = _complete_file(file, name)
    bits, samples = int(data.get("BitsAllocated") or 0), int(data.get("SamplesPerPixel") or 1)
    if samples != 1 or bits not in (1, 8, 16, 32):
        raise VolumeError("%s: %d components per pixel of %d bits are not supported; required is "
                          "one of 1, 8, 16 or 32 bits" % (name, samples, bits))
    required = (int(data.get("NumberOfFrames") or 1) * area * bits + 7) // 8
    available = len(data.PixelData)
    with prefix_errors(name):
        check_size(available, required + required % 2 * (available > required), exact=True)
    kind = "%s%s%d" % ("<" if data.syntax.is_little_endian else ">", "i" if bits > 1 and data.get(
        "PixelRepresentation") == 1 else "u", max(1, bits // 8))
    return np.frombuffer(data.PixelData, kind, required * 8 // max(8, bits)), bits


def decompress(files):
    """Return the values of compressed files (path, name), in the worker. GDCM is called directly,
    as pydicom's handler ignores its failures and returns uninitialized memory."""
    import gdcm
    seconds = 30 + sum(os.path.getsize(file) for file, _ in files) // 1000000
    resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds))  # damaged JPEG 2000 can take hours
    gdcm.Trace.ErrorOff()
    gdcm.Trace.WarningOff()
    plain, found = gdcm.TransferSyntax(gdcm.TransferSyntax.ExplicitVRLittleEndian), []
    for file, name in files:
        set_current_item(name)
        captured_output()
        reader, change = gdcm.ImageReader(), gdcm.ImageChangeTransferSyntax()
        reader.SetFileName(file)
        change.SetTransferSyntax(plain)
        done = reader.Read() and not change.SetInput(reader.GetImage()) and change.Change()
        damage = re.search("(?i).*(corrupt|premature|bogus|invalid).*", captured_output())
        if not done or damage:
            raise VolumeError("%s: pixels cannot be decompressed: damaged, or a compression that "
                              "GDCM does not support%s; try gdcmconv --raw"
                              % (name, " (%s)" % damage[0] if damage else ""))
        image = change.GetOutput()
        kind = image.GetPixelFormat()
        if kind.GetSamplesPerPixel() != 1:
            raise VolumeError("%s: %d components per pixel are not supported; required is one"
                              % (name, kind.GetSamplesPerPixel()))
        found.append(np.frombuffer(image.GetBuffer().encode("utf-8", "surrogateescape"), "%s%d" % (
            "i" if kind.GetPixelRepresentation() else "u", kind.GetBitsAllocated() // 8)))
    return found
