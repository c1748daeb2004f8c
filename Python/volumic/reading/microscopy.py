# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""MRC by mrcfile, TIFF by tifffile, pictures by Pillow, OME-Zarr by zarr."""
from __future__ import annotations

import collections
import logging
import os
import re
import warnings

import numpy as np

from ..errors import VolumeError
from .grid import one_of_times, placed, voxels
from .volume import METERS, Choice, failure_of, unit_of

PICTURES = (".png", ".tif", ".tiff", ".bmp", ".jpg", ".jpeg", ".pgm", ".ppm", ".pnm")

# ---- MRC ---------------------------------------------------------------------------------------

_MODES = {0: "i1", 1: "i2", 2: "f4", 3: "(2)i2", 4: "c8", 6: "u2", 12: "f2", 16: "(3)u1"}


def read_mrc(path, choice):
    """MRC2014, also packed. mrcfile leaves the order of the axes and the angles of the cell to us."""
    import mrcfile
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        with mrcfile.open(path, permissive=True, header_only=True) as file:
            header = file.header
    mode, sizes = int(header.mode), [int(header[n]) for n in ("nz", "ny", "nx")]
    if mode not in _MODES:
        raise VolumeError("voxels of mode %d cannot be read; write them as mode 2 (IMOD: newstack "
                          "-mode 2)" % mode if mode == 101 else
                          "its header is damaged: mode %d is unknown" % mode)
    order = [int(header[n]) or i + 1 for i, n in enumerate(("mapc", "mapr", "maps"))]
    grid = np.array([int(header[n]) for n in ("mx", "my", "mz")])
    if sorted(order) != [1, 2, 3] or min(sizes) < 1 or min(grid) < 1:
        raise VolumeError("its header is damaged: %d x %d x %d voxels in %d x %d x %d cells along "
                          "the axes %s" % (*sizes[::-1], *grid, order))
    kind = "u1" if mode == 0 and _is_unsigned(header) else _MODES[mode]
    dtype = np.dtype(kind).newbyteorder(header.dtype["nx"].byteorder)
    with open(path, "rb") as stream:
        packing = {b"\x1f\x8b": "gzip", b"BZ": "bz2"}.get(stream.read(2))
    array = voxels(path, 0, dtype, np.prod(sizes, dtype=object), packing,
                   1024 + int(header.nsymbt), exact=True)
    array = array.reshape(*sizes, *dtype.shape)
    array = np.moveaxis(array, -1, 0) if dtype.shape else array
    depth = int(grid[2])
    if header.ispg >= 401 and sizes[0] > depth and sizes[0] % depth == 0:  # a stack of volumes
        array = array.reshape(-1, depth, *array.shape[1:])[one_of_times(sizes[0] // depth, choice)]
    steps = _cell_axes(header) * (np.array(header.cella.tolist()) / grid)  # columns: x, y, z
    start = np.zeros(3)
    start[[o - 1 for o in order]] = [int(header[n]) for n in ("nxstart", "nystart", "nzstart")]
    origin = np.array(header.origin.tolist(), float) + steps @ start
    return placed(array, steps[:, [o - 1 for o in order]], origin, "", "A", choice,
                  components={3: "complex", 16: "color"}.get(mode, ""))


def _is_unsigned(header):
    """Return whether IMOD wrote bytes 0 to 255: its stamp at byte 152, no flag of signed bytes."""
    extra = header["extra2"].tobytes()[40:48]  # bytes 152 to 159
    return extra[:4] in (b"IMOD", b"DOMI") and not extra[4 if extra[:4] == b"IMOD" else 7] & 1


def _cell_axes(header):
    """Return the unit vectors along the axes of the cell as columns."""
    angles = [float(angle) or 90. for angle in header.cellb.tolist()]
    ca, cb, cg = [0. if abs(angle - 90) < .01 else np.cos(np.radians(angle)) for angle in angles]
    sine = np.sqrt(1 - cg * cg)
    y = (ca - cb * cg) / sine if sine > 0 else 1.
    if not 1 - cb * cb - y * y > 0:
        raise VolumeError("its header is damaged: its cells have no such angles: %g, %g, %g"
                          % tuple(angles))
    return np.array([[1, cg, cb], [0, sine, y], [0, 0, np.sqrt(1 - cb * cb - y * y)]])


# ---- TIFF --------------------------------------------------------------------------------------


def read_tiff(path, choice):
    """TIFF, BigTIFF, OME-TIFF, ImageJ and LSM by tifffile; packings that it lacks by Pillow."""
    import tifffile
    logged, handler = [], logging.Handler(logging.WARNING)
    handler.emit = lambda record: logged.append(record.getMessage())
    logger = logging.getLogger("tifffile")
    logger.addHandler(handler)
    try:
        with tifffile.TiffFile(path) as file:
            series, pages = file.series[0], list(file.series[0].pages)
            damage = [text for text in logged if re.search("invalid|corrupt|damage|missing|circular|"
                                                           "failed", text)]
            if damage or not pages or any(page is None for page in pages):
                raise VolumeError("the file is cut off or damaged: "
                                  + (damage or ["pages are missing"])[0].split("> ")[-1])
            _check_pages(file, series)
            return _tiff_volume(path, file, series, choice)
    finally:
        logger.removeHandler(handler)


def _check_pages(file, series):
    """Throw VolumeError if pixels are not in the file, or many bytes of the file in no page."""
    length, pages, key = file.filehandle.size, list(series.pages), series.keyframe
    for number, page in enumerate(pages):
        counts = page.databytecounts
        end = max(map(sum, zip(page.dataoffsets, counts)), default=0)
        if not counts or end > length or min(counts) <= 0 or (
                key.compression == 1 and not key.is_tiled and sum(counts) < key.nbytes):
            raise VolumeError("page %d: the file is cut off or damaged: its pixels, %d bytes, end at "
                              "byte %d, the file at byte %d" % (number + 1, sum(counts), end, length))
    used = sum(sum(page.databytecounts) for page in file.pages) + 1024 * (len(file.pages) + 8)
    if len(file.series) == 1 and not (file.is_ome or file.is_imagej or file.is_lsm) and (
            length > used + key.nbytes):
        raise VolumeError("the file is damaged: %d bytes belong to none of its %d pages"
                          % (length - used, len(pages)))


def _tiff_volume(path, file, series, choice):
    """Return the volume of the first series of pages."""
    axes, first, more = series.axes, file.pages[0], {}
    if series.dataoffset is not None:
        array = voxels(path, series.dataoffset, series.dtype.newbyteorder(file.byteorder),
                       np.prod(series.shape, dtype=object))
    else:
        try:
            array = series.asarray()
        except (ValueError, KeyError) as error:  # 'requires the imagecodecs package'
            if first.compression == 1 or "imagecodecs" not in str(error):
                raise
            array = _pages_by_pillow(path, series)
    array = array.reshape(series.shape)
    if first.photometric == 0 and array.dtype.kind in "ub":  # MINISWHITE
        array = ((1 << first.bitspersample) - 1 - array).astype(array.dtype)
    for letter in [letter for letter in axes if letter not in "ZYXCS"]:  # T, I, Q, R ...
        if letter in "IQ" and "Z" not in axes:
            axes = axes.replace(letter, "Z", 1)
            continue
        at = axes.index(letter)
        array = np.moveaxis(array, at, 0)[one_of_times(array.shape[at], choice)]
        axes = axes.replace(letter, "", 1)
    if "Z" not in axes:
        axes, array = "Z" + axes, array[None]
    order = [axes.index(letter) for letter in axes if letter in "CS"]
    array = array.transpose(order + [axes.index(letter) for letter in "ZYX"])
    if order:
        array = array.reshape(-1, *array.shape[-3:])
        more["components"] = "channels" if "C" in axes else _kind_of_colors(len(array))
    pixel, unit = _tiff_spacing(file, first)
    if len(file.series) > 1 and not file.is_ome:
        more["warnings"] = ["the first of its %d series of pages is read" % len(file.series)]
    return placed(array, np.diag(pixel), [0, 0, 0], "", unit, choice, **more)


def _kind_of_colors(count):
    """Return what the components of colors are."""
    return {1: "", 2: "gray and alpha", 4: "color and alpha"}.get(count, "color")


def _tiff_spacing(file, first):
    """Return the distances along x, y and z, and their unit."""
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
    density = [first.tags[t].value if t in first.tags else (1, 1)
               for t in ("XResolution", "YResolution")]
    data = file.imagej_metadata
    return ([d[1] / d[0] if d[0] else 1. for d in density] + [abs(float(data.get("spacing") or 1))],
            unit_of(data.get("unit")))


def _pages_by_pillow(path, series):
    """Return the pages of a packing that tifffile reads with imagecodecs only, such as LZW."""
    from PIL import Image, ImageSequence
    Image.MAX_IMAGE_PIXELS = 1 << 30
    with Image.open(path) as image:
        pages = [np.array(page) for page, _ in zip(ImageSequence.Iterator(image), series.pages)]
    if {page.shape for page in pages} != {series.keyframe.shape} or len(pages) != len(series.pages):
        raise VolumeError("its packing cannot be read; install imagecodecs, or convert it by "
                          "tiffcp -c none")
    return np.stack(pages).astype(series.dtype, copy=False)


# ---- Pictures ----------------------------------------------------------------------------------


def natural(name):
    """Return a key that sorts names by the numbers in them."""
    return [(0, int(text), text) if text.isdigit() else (1, 0, text)
            for text in re.split(r"(\d+)", name) if text]


def names_of_pattern(path):
    """Return a folder and the names there, in natural order, that match a pattern such as '*.tif'
    or 'slice%03d.png'; of a folder all names."""
    folder, name = (path, "*") if os.path.isdir(path) else os.path.split(path)
    parts = re.split(r"(\*|%\d*[diu])", name)  # at odd places: what stands for other text
    pattern = "".join((".*" if part == "*" else r"\d+") if i % 2 else re.escape(part)
                      for i, part in enumerate(parts))
    names = [each for each in os.listdir(folder or ".") if re.fullmatch(pattern, each, re.DOTALL)
             and not each.startswith(".") and os.path.isfile(os.path.join(folder, each))]
    return folder, sorted(names, key=natural)


def pictures_of(path):
    """Return a folder, the names of its slices, and those of other files there.

    Slices are the pictures that have the name of most, but for its numbers."""
    folder, names = names_of_pattern(path)
    form = {name: re.sub(r"\d+", "#", name) for name in names if name.lower().endswith(PICTURES)}
    forms = collections.Counter(form.values()).most_common()
    if not forms:
        raise VolumeError("no pictures and no DICOM slices there")
    kept = [name for name in form if form[name] == forms[0][0] or forms[0][1] == 1]
    if 4 * (len(form) - len(kept)) > len(form):
        raise VolumeError("pictures with several kinds of names: %s; choose with a pattern, such as "
                          "'%s'" % (", ".join("%s (%d)" % each for each in forms[:3]),
                                    forms[-1][0].replace("#", "*")))
    return folder, kept, [name for name in names if name not in kept]


def read_pictures(path, choice):
    """A slice for each picture of a folder or pattern, in natural order. Pictures whose name or
    size differs from that of most are left out."""
    folder, names, others = pictures_of(path)
    notes, slices = [], []
    for name in names:
        try:
            slices.append(_picture(os.path.join(folder, name), choice.labels, notes))
        except Exception as error:  # pylint: disable=broad-except
            raise VolumeError("%s: %s" % (name, failure_of(error))) from None
    kinds = [(pixels.shape, pixels.dtype) for pixels in slices]
    kind = collections.Counter(kinds).most_common(1)[0][0]
    kept = [i for i, each in enumerate(kinds) if each == kind]
    strangers = [name for name, each in zip(names, kinds) if each != kind]
    if 4 * len(strangers) > len(names):
        raise VolumeError("%s: its size or kind of values differs from that of %s; choose with a "
                          "pattern" % (strangers[0], names[kept[0]]))
    array = np.empty((len(kept), *kind[0]), kind[1])
    for i, number in enumerate(kept):
        array[i], slices[number] = slices[number], None  # both together would need twice the memory
    others = strangers + others
    if others:
        notes.append("%d files are left out, whose names or sizes differ from those of the slices: "
                     % len(others) + ", ".join(others[:5]) + ", ..." * (len(others) > 5))
    notes += _gaps([names[i] for i in kept])
    array = np.moveaxis(array, -1, 0) if array.ndim == 4 else array
    return placed(array, np.eye(3), [0, 0, 0], "", "", choice, warnings=sorted(set(notes)),
                  components=_kind_of_colors(len(array)) if array.ndim == 4 else "")


def _gaps(names):
    """Return a warning if the numbers in names of slices have gaps, in a list."""
    numbers = np.array([[int(n) for n in re.findall(r"\d+", name)] for name in names], object)
    if numbers.ndim != 2 or len(numbers) < 3:
        return []
    varying = [column for column in numbers.T if len(set(column)) > 1]
    steps = np.diff(varying[0]) if len(varying) == 1 else np.ones(1, int)
    ends = [(a + steps.min(), b - steps.min()) for a, b in zip(varying[0], varying[0][1:])
            if b - a > steps.min()] if steps.min() > 0 else []
    texts = ["%d" % a if a == b else "%d to %d" % (a, b) for a, b in ends[:5]]
    return ["the numbers of its slices have gaps (%s): slices are missing" % (
        ", ".join(texts) + ", ..." * (len(ends) > 5))] if ends else []


def _picture(file, are_labels, notes):
    """Return the pixels [y, x] or [y, x, component] of a picture."""
    if file.lower().endswith((".tif", ".tiff")):
        pages = read_tiff(file, Choice()).array
        if pages.shape[-3] > 1:
            raise VolumeError("%d pages; give it by its name, it is a volume" % pages.shape[-3])
        pixels = pages[..., 0, :, :]
        pixels = np.moveaxis(pixels, 0, -1) if pixels.ndim == 3 else pixels
        return pixels.astype(pixels.dtype.newbyteorder("="))
    from PIL import Image
    Image.MAX_IMAGE_PIXELS = 1 << 30
    with Image.open(file) as image:
        if image.mode in ("P", "PA") and not are_labels:
            notes.append("the colors of its palette are read; --labels reads the numbers")
        mode = {"1": "L", "PA": "P"}.get(image.mode, image.mode)
        mode = "RGB" if mode in ("CMYK", "YCbCr") or mode == "P" and not are_labels else mode
        pixels = np.array(image if mode == image.mode else image.convert(mode))
        return pixels.astype(np.uint16) if mode == "I" and image.format == "PNG" else pixels


# ---- OME-Zarr ----------------------------------------------------------------------------------


def read_ome_zarr(path, choice):
    """The finest level of an OME-Zarr image, whose chunks are read one by one."""
    from .. import ome_zarr
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        try:
            image = ome_zarr.open(path)
            time = one_of_times(image.others.get("t", 1), choice)
            channels = range(image.others.get("c", 1))
            if choice.component is not None and choice.component in channels:
                channels = [choice.component]
            images = [ome_zarr.open(path, time=time, channel=channel) for channel in channels]
        except ValueError as error:
            raise VolumeError(re.sub("^%s:? " % re.escape(path), "", str(error))) from None
    notes = sorted({str(each.message).replace(path + ": ", "") for each in told})
    array = np.empty((len(images), *image.shape), image.dtype)
    for values, part in zip(array, images):
        values[...] = part[...]
        missing, count = part.missing_chunks()
        if missing:
            notes.append("%d of %d chunks have no file; their voxels are %s, the fill value"
                         % (missing, count, image.array.fill_value))
    return placed(array, np.diag(image.spacing), image.origin, "", unit_of(image.unit), choice,
                  warnings=notes, components="channels" if len(images) > 1 else "")
