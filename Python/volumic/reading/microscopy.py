# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""MRC by mrcfile, TIFF by tifffile, pictures by Pillow, OME-Zarr by zarr."""
from __future__ import annotations

import bz2
import collections
import gzip
import logging
import os
import re
import struct
import tempfile
import warnings

import numpy as np

from ..errors import VolumeError
from .grid import from_stream, make_volume, one_of_times, voxels
from .volume import METERS, Choice, prefix_errors, unit_of

_PICTURE_SUFFIXES = (".png", ".tif", ".tiff", ".bmp", ".jpg", ".jpeg", ".pgm", ".ppm", ".pnm")
_COLORS = {1: "", 2: "gray and alpha", 3: "color", 4: "color and alpha"}  # by components
_MODES = {0: "i1", 1: "i2", 2: "f4", 3: "(2,)i2", 4: "c8", 6: "u2", 12: "f2", 16: "(3,)u1"}


def read_mrc(path, choice):
    """Read MRC2014, also compressed. Readers of mrcfile ignore the axis order and the cell angles,
    and allocate up to 2 GiB for a damaged header."""
    from mrcfile.dtypes import HEADER_DTYPE
    with open(path, "rb") as stream:
        compression = {b"\x1f\x8b": "gzip", b"BZ": "bz2"}.get(stream.read(2))
    with {"gzip": gzip.open, "bz2": bz2.open}.get(compression, open)(path, "rb") as stream:
        stored = from_stream(stream, HEADER_DTYPE, 1)
    headers = [stored.view(HEADER_DTYPE.newbyteorder(order))[0]
               for order in ("><" if stored["machst"][0, 0] == 17 else "<>")]  # machine stamp
    header = next((each for each in headers if int(each["mode"]) in _MODES), headers[0])
    numbers = lambda *names: np.array([int(header[name]) for name in names])
    mode, sizes, extended = int(header["mode"]), numbers("nz", "ny", "nx"), int(header["nsymbt"])
    if mode not in _MODES:
        raise VolumeError("mode %d is not supported; convert it to mode 2 (IMOD: newstack -mode "
                          "2)" % mode)
    order, cells = numbers("mapc", "mapr", "maps") - 1, numbers("mx", "my", "mz")
    order = order if order.max() >= 0 else np.arange(3)
    angles = [float(angle) or 90. for angle in header["cellb"].tolist()]
    ca, cb, cg = [0. if abs(angle - 90) < .01 else np.cos(np.radians(angle)) for angle in angles]
    sine = np.sqrt(1 - cg * cg)
    y = (ca - cb * cg) / sine if sine > 0 else 1.
    if (sorted(order) != [0, 1, 2] or min(*sizes, *cells, extended + 1) < 1
            or not cb * cb + y * y < 1):
        raise VolumeError("invalid header: %d x %d x %d voxels along the axes %s, %d x %d x %d "
                          "cells with the angles %g, %g, %g, %d bytes of extended header"
                          % (*sizes[::-1], order + 1, *cells, *angles, extended))
    kind, extra = _MODES[mode], header["extra2"].tobytes()[40:48]  # bytes 152 to 159
    if mode == 0 and extra[:4] in (b"IMOD", b"DOMI") and not extra[4 if extra[0] == 73 else 7] & 1:
        kind = "u1"  # IMOD has a flag for signed bytes
    dtype = np.dtype(kind).newbyteorder(header.dtype["nx"].byteorder)
    array = voxels(path, 0, dtype, np.prod(sizes, dtype=object), compression,
                   1024 + extended, exact=True).reshape(*sizes, *dtype.shape)
    array = np.moveaxis(array, -1, 0) if dtype.shape else array
    if header["ispg"] >= 401 and sizes[0] > cells[2] and sizes[0] % cells[2] == 0:  # volumes
        array = array.reshape(-1, cells[2], *sizes[1:])[one_of_times(sizes[0] // cells[2], choice)]
    axes = np.array([[1, cg, cb], [0, sine, y], [0, 0, np.sqrt(1 - cb * cb - y * y)]])
    steps = axes * (np.array(header["cella"].tolist()) / cells)  # columns: along x, y and z
    origin = header["origin"].tolist() + steps[:, order] @ numbers("nxstart", "nystart", "nzstart")
    return make_volume(array, steps[:, order], origin, "", "A", choice,
                       components={3: "complex", 16: "color"}.get(mode, ""))


# ---- TIFF --------------------------------------------------------------------------------------

def read_tiff(path, choice):
    """Read TIFF, BigTIFF, OME-TIFF, ImageJ and LSM by tifffile, some compressions by Pillow."""
    import tifffile
    logged, handler = [], logging.Handler(logging.WARNING)
    handler.emit = lambda record: logged.append(record.getMessage().split("> ")[-1].strip("')"))
    logging.getLogger("tifffile").addHandler(handler)
    try:
        with tifffile.TiffFile(path) as file:
            _check_chain(file.filehandle, file.tiff)
            is_plain = not (file.is_ome or file.is_imagej or file.is_lsm)
            kinds = [page.hash for page in file.pages if not page.is_reduced] if is_plain else []
            series = file.series[0]
            damage = [text for text in logged
                      if re.search("invalid|corrupt|damage|missing|circular|failed", text)]
            damage += ["pages are missing"] * any(page is None for page in series.pages)
            if damage or len(set(kinds)) > 1:
                raise IndexError((damage or ["pages differ in size or pixel type"])[0])
            _check_pages(file, series, is_plain)
            return _tiff_volume(path, file, series, choice)
    finally:
        logging.getLogger("tifffile").removeHandler(handler)


def _check_chain(handle, form):
    """Raise IndexError if the page directories form a cycle, in which tifffile hangs."""
    at, seen = form.offsetsize if form.offsetsize == 8 else 4, set()
    while True:
        handle.seek(at)
        offset, = struct.unpack(form.offsetformat, handle.read(form.offsetsize))
        if not offset:
            return
        if offset in seen:
            raise IndexError("page directories form a cycle")
        seen.add(offset)
        handle.seek(offset)
        tags, = struct.unpack(form.tagnoformat, handle.read(form.tagnosize))
        at = offset + form.tagnosize + tags * form.tagsize


def _check_pages(file, series, is_plain):
    """Raise IndexError if pixels are outside the file, or bytes of the file belong to no page."""
    length, key, first = file.filehandle.size, series.keyframe, file.pages[0]
    for number, page in enumerate(series.pages):
        counts = page.databytecounts
        end = max(map(sum, zip(page.dataoffsets, counts)), default=0)
        if not counts or end > length or min(counts) <= 0 or (
                key.compression == 1 and key.bitspersample >= 8 and sum(counts) < key.nbytes):
            raise IndexError("page %d: %d bytes of pixels end at byte %d, the file at byte %d"
                             % (number + 1, sum(counts), end, length))
    if not is_plain or first.subifds:
        return
    entry, inner = (20, 8) if file.is_bigtiff else (12, 4)  # bytes of the first directory
    values = [tag.valuebytecount for tag in first.tags]
    other = 2 * inner + sum(entry + value * (value > inner) for value in values)
    data = sum(sum(page.databytecounts) for page in file.pages) / len(file.pages)
    if length - len(file.pages) * (data + other) >= max(data, 32 * len(file.pages)):
        raise IndexError("%d bytes belong to none of the %d pages; copy the file by tiffcp"
                         % (length - len(file.pages) * data, len(file.pages)))


def _tiff_volume(path, file, series, choice):
    """Return the volume of the first series of pages."""
    axes, first, more = series.axes, file.pages[0], {}
    is_white_0 = first.photometric == 0
    if series.dataoffset is not None:
        array = voxels(path, series.dataoffset, series.dtype.newbyteorder(file.byteorder),
                       np.prod(series.shape, dtype=object))
    else:
        try:
            array = series.asarray()
        except (ValueError, KeyError):
            if first.compression == 1:
                raise
            array, is_white_0 = _pages_by_pillow(path, series), False
    array = array.reshape(series.shape)
    if is_white_0 and array.dtype.kind in "ub":
        array = ((1 << first.bitspersample) - 1 - array).astype(array.dtype)
    for letter in [letter for letter in axes if letter not in "ZYXCS"]:  # T, I, Q, R ...
        if letter in "IQ" and "Z" not in axes:
            axes = axes.replace(letter, "Z", 1)
            continue
        at = axes.index(letter)
        array = np.moveaxis(array, at, 0)[one_of_times(array.shape[at], choice)]
        axes = axes.replace(letter, "", 1)
    axes, array = (axes, array) if "Z" in axes else ("Z" + axes, array[None])
    order = [axes.index(letter) for letter in axes if letter in "CS"]
    array = array.transpose(order + [axes.index(letter) for letter in "ZYX"])
    if order:
        array = array.reshape(-1, *array.shape[-3:])
        more["components"] = "channels" if "C" in axes else _COLORS.get(len(array), "channels")
    pixel, unit = _tiff_spacing(file, first)
    return make_volume(array, np.diag(pixel), [0, 0, 0], "", unit, choice, **more)


def _tiff_spacing(file, first):
    """Return the spacing along x, y and z, and its unit."""
    if file.is_lsm:
        return [file.lsm_metadata["VoxelSize" + c] * 1e6 or 1. for c in "XYZ"], "um"
    if file.is_ome:
        pixels = re.search(r"<(?:\w+:)?Pixels\b[^>]*>", file.ome_metadata)
        found = dict(re.findall(r'\b(PhysicalSize[XYZ](?:Unit)?)="([^"]*)"', pixels[0]))
        units = [unit_of(found.get("PhysicalSize%sUnit" % c, "um")) for c in "XYZ"]
        factors = [METERS[u] / METERS[units[0]] if all(units) else 1. for u in units]
        unit = units[0] if "PhysicalSizeX" in found and all(units) else ""
        return [float(found.get("PhysicalSize" + c, 1)) * f for c, f in zip("XYZ", factors)], unit
    if not file.is_imagej:
        return [1., 1., 1.], ""
    density = [first.tags[tag].value if tag in first.tags else (1, 1)
               for tag in ("XResolution", "YResolution")]
    data = file.imagej_metadata
    return ([d[1] / d[0] if d[0] else 1. for d in density] + [abs(float(data.get("spacing") or 1))],
            unit_of(data.get("unit")))


def _pages_by_pillow(path, series):
    """Return the pages of compressions that tifffile lacks without imagecodecs, such as LZW."""
    from PIL import Image, ImageSequence
    Image.MAX_IMAGE_PIXELS = 1 << 30
    with tempfile.TemporaryFile() as log:  # libtiff writes to the standard error
        saved = os.dup(2)
        os.dup2(log.fileno(), 2)
        try:
            with Image.open(path) as image:
                pages = [np.array(page) for page in ImageSequence.Iterator(image)]
        except OSError:
            raise VolumeError("the compressed pixels are truncated or damaged; copy the file again"
                              ) from None
        finally:
            os.dup2(saved, 2)
            os.close(saved)
    pages = pages[:len(series.pages)]
    if {page.shape for page in pages} != {series.keyframe.shape} or len(pages) < len(series.pages):
        raise VolumeError("the compression is not supported; install imagecodecs, or convert the "
                          "file by tiffcp -c none")
    pages = np.stack(pages)
    return (pages > 0 if series.keyframe.bitspersample == 1 else pages).astype(series.dtype)


# ---- Pictures ----------------------------------------------------------------------------------

def natural(name):
    """Return a sort key that orders names by the numbers in them."""
    return [(0, int(text), text) if text.isdigit() else (1, 0, text)
            for text in re.split(r"(\d+)", name) if text]


def names_of_pattern(path):
    """Return the folder and, in natural order, the names that match a pattern such as '*.tif' or
    'slice%03d.png'; for a folder all names."""
    folder, name = (path, "*") if os.path.isdir(path) else os.path.split(path)
    parts = re.split(r"(\*|%\d*[diu])", name)  # wildcards are at odd indices
    pattern = "".join((".*" if part == "*" else r"\d+") if i % 2 else re.escape(part)
                      for i, part in enumerate(parts))
    names = [each for each in os.listdir(folder or ".") if re.fullmatch(pattern, each, re.DOTALL)
             and not each.startswith(".") and os.path.isfile(os.path.join(folder, each))]
    return folder, sorted(names, key=natural)


def read_pictures(path, choice):
    """Read one slice per picture of a folder or pattern, in natural order. Pictures whose name
    pattern or size differs from that of most are ignored."""
    folder, names = names_of_pattern(path)
    form = {name: re.sub(r"\d+", "#", name) for name in names
            if name.lower().endswith(_PICTURE_SUFFIXES)}
    forms = collections.Counter(form.values()).most_common() or [("", 0)]
    kept = [name for name in form if form[name] == forms[0][0] or forms[0][1] == 1]
    if 4 * len(kept) < 3 * len(form) or not form:
        raise VolumeError("no pictures or DICOM slices found; give their folder" if not form else
                          "pictures with several name patterns: %s; choose one with a pattern such "
                          "as '%s'" % (", ".join("%s (%d)" % each for each in forms[:3]),
                                       forms[-1][0].replace("#", "*")))
    notes, slices = [], []
    for name in kept:
        with prefix_errors(name):
            slices.append(_picture(os.path.join(folder, name), choice.labels, notes))
    kinds = [(pixels.shape, pixels.dtype) for pixels in slices]
    most = collections.Counter(kinds).most_common(1)[0][0]
    slices = {name: pixels for name, pixels, kind in zip(kept, slices, kinds) if kind == most}
    if 4 * len(slices) < 3 * len(kept):
        raise VolumeError("%s: size or pixel type differs from that of %s; choose files with a "
                          "pattern" % (next(n for n in kept if n not in slices), [*slices][0]))
    others, numbers = [name for name in names if name not in slices], _gaps(list(slices))
    if others:
        notes.append("files with names or sizes unlike those of the slices are ignored: "
                     + ", ".join(others[:5]) + ", ... (%d)" % len(others) * (len(others) > 5))
    if numbers:
        notes.append("slice numbers have gaps (%s): slices are missing" % numbers)
    array = np.empty((len(slices), *most[0]), most[1])
    for target, name in zip(array, list(slices)):
        target[...] = slices.pop(name)  # released to save memory
    array = np.moveaxis(array, -1, 0) if array.ndim == 4 else array
    return make_volume(array, np.eye(3), [0, 0, 0], "", "", choice,
                       warnings=list(dict.fromkeys(notes)),
                       components=_COLORS.get(len(array), "channels") if array.ndim == 4 else "")


def _gaps(names):
    """Return the missing numbers in sorted names that differ in one number."""
    numbers = [[int(number) for number in re.findall(r"\d+", name)] for name in names]
    varying = [column for column in zip(*numbers) if len(set(column)) > 1]
    if len(varying) != 1 or len({len(each) for each in numbers}) > 1:
        return ""
    step = min(b - a for a, b in zip(varying[0], varying[0][1:]))
    gaps = ["%d" % (a + step) if b - a == 2 * step else "%d to %d" % (a + step, b - step)
            for a, b in zip(varying[0], varying[0][1:]) if b - a > step > 0]
    return ", ".join(gaps[:5]) + ", ..." * (len(gaps) > 5)


def _picture(file, are_labels, notes):
    """Return the pixels [y, x] or [y, x, component] of a picture."""
    if file.lower().endswith((".tif", ".tiff")):
        pages = read_tiff(file, Choice()).array
        if pages.shape[-3] > 1:
            raise VolumeError("%d pages, a volume; give the name of this file" % pages.shape[-3])
        pixels = pages[..., 0, :, :] if pages.ndim == 3 else np.moveaxis(pages[:, 0], 0, -1)
        return pixels.astype(pixels.dtype.newbyteorder("="))
    from PIL import Image
    Image.MAX_IMAGE_PIXELS = 1 << 30
    with Image.open(file) as image:
        if image.mode in ("P", "PA") and not are_labels:
            notes.append("palette colours are read; use --labels to read palette indices")
        mode = {"1": "L", "PA": "P", "CMYK": "RGB", "YCbCr": "RGB"}.get(image.mode, image.mode)
        mode = "RGB" if mode == "P" and not are_labels else mode
        pixels = np.array(image if mode == image.mode else image.convert(mode))
        return pixels.astype(np.uint16) if mode == "I" and image.format == "PNG" else pixels


# ---- OME-Zarr ----------------------------------------------------------------------------------

def read_ome_zarr(path, choice):
    """Read the finest level of an OME-Zarr image, chunk by chunk."""
    from .. import ome_zarr
    notes = []
    with warnings.catch_warnings(record=True) as recorded:
        warnings.simplefilter("always")
        try:
            image = ome_zarr.open(path)
            time = one_of_times(image.others.get("t", 1), choice)
            channels = range(image.others.get("c", 1))
            channels = [choice.component] if choice.component in channels else channels
            array = np.empty((len(channels), *image.shape), image.dtype)
            for values, channel in zip(array, channels):
                image = ome_zarr.open(path, time=time, channel=channel)
                missing, count = image.missing_chunks()
                if missing:
                    notes.append("%d of %d chunks have no file; their voxels get the fill value %s"
                                 % (missing, count, image.array.fill_value))
                values[...] = image[...]
        except (ValueError, RuntimeError, KeyError) as error:
            text = re.sub("^%s(:? |/)" % re.escape(path), "", str(error))
            raise VolumeError(text if text != str(error) else "chunks or metadata are damaged or "
                              "truncated (%s)" % text) from None
    notes += sorted({str(each.message).replace(path + ": ", "") for each in recorded})
    return make_volume(array, np.diag(image.spacing), image.origin, "", unit_of(image.unit), choice,
                       warnings=notes, components="channels" if len(channels) > 1 else "")
