# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Read a folder with one series of uncompressed DICOM slices.

vtkDICOMImageReader takes the distance of the slices from their thickness, drops their orientation
and mixes series; a surface in world coordinates needs better, so the few elements that place the
voxels are parsed here (DICOM PS3.5, sections 7.1 and A.4; PS3.3, C.7.6.2).
"""

import os
import struct

import numpy as np

from volume_image import VolumeError, make_image

EXPLICIT_LITTLE, IMPLICIT_LITTLE = "1.2.840.10008.1.2.1", "1.2.840.10008.1.2"
LONG_FORMS = {b"OB", b"OD", b"OF", b"OL", b"OV", b"OW", b"SQ", b"SV", b"UC", b"UN", b"UR", b"UT",
              b"UV"}
UNDEFINED = 0xFFFFFFFF
ITEM, ITEM_END, SEQUENCE_END = (0xFFFE, 0xE000), (0xFFFE, 0xE00D), (0xFFFE, 0xE0DD)
PIXEL_DATA = (0x7FE0, 0x0010)
TAGS = {
    (0x0002, 0x0002): "class", (0x0002, 0x0010): "syntax", (0x0008, 0x0016): "class",
    (0x0008, 0x103E): "description", (0x0020, 0x000E): "series",
    (0x0020, 0x0032): "position", (0x0020, 0x0037): "orientation", (0x0028, 0x0002): "samples",
    (0x0028, 0x0008): "frames", (0x0028, 0x0010): "rows", (0x0028, 0x0011): "columns",
    (0x0028, 0x0030): "spacing", (0x0028, 0x0100): "bits", (0x0028, 0x0103): "signed",
    (0x0018, 0x0050): "thickness", (0x0028, 0x1052): "intercept", (0x0028, 0x1053): "slope",
}
# What has no pixels by its nature (PS3.4, B.5): directories, waveforms, presentation states, raw
# data, surfaces, reports, documents, plans.
OTHERS = ("1.2.840.10008.1.3.10", *(f"1.2.840.10008.5.1.4.1.1.{end}" for end in (
    "9.", "11.", "66", "67", "68", "88.", "104.", "481.")))
NUMBERS = {"samples", "rows", "columns", "bits", "signed"}  # binary 16-bit values; others are text
UNEVEN = 0.05  # tolerated deviation of the distance of two slices from their mean


def read_dicom(folder):
    """vtkImageData in DICOM's patient coordinates (LPS, mm), slices in order of position."""
    slices = [s for name in sorted(os.listdir(folder))
              if (s := read_header(os.path.join(folder, name))) is not None]
    if not slices:
        raise VolumeError(f"{folder}: no DICOM image in this folder")
    check_single_series(slices, folder)
    for part in slices:
        check_slice(part, slices[0])

    across, down = slices[0]["orientation"][:3], slices[0]["orientation"][3:]
    normal = np.cross(across, down)
    slices.sort(key=lambda part: float(part["position"] @ normal))
    step = slice_distance(slices, normal, folder)
    voxels = np.stack([read_pixels(part) for part in slices])
    row_distance, column_distance = slices[0]["spacing"]
    return make_image(rescale(voxels, slices), (column_distance, row_distance, step),
                      slices[0]["position"], np.array([across, down, normal]).T, "LPS")


def read_header(path):
    """The elements of TAGS and where the pixels lie; None for a file that is no DICOM image."""
    if not is_dicom(path):
        return None
    with open(path, "rb") as file:
        data = file.read()
    found = {"path": path}
    try:
        parse_elements(data, 132, found)
    except (struct.error, IndexError, RecursionError) as error:
        raise VolumeError(f"{path}: the DICOM header is damaged ({error})") from error
    if "pixels" in found:
        return found
    if found.get("class", "").startswith(OTHERS):
        return None
    raise VolumeError(f"{path}: has no pixels: it is cut off, or no slice; replace it, or take it"
                      " out of the folder")


def is_dicom(path):
    if not os.path.isfile(path):
        return False
    with open(path, "rb") as file:
        return file.read(132)[128:] == b"DICM"


def parse_elements(data, at, found):
    """Walk through the top-level elements up to the pixels, keeping those of TAGS."""
    while at < len(data):
        group = struct.unpack_from("<H", data, at)[0]
        syntax = EXPLICIT_LITTLE if group == 2 else found.get("syntax", EXPLICIT_LITTLE)
        if syntax != IMPLICIT_LITTLE and syntax != EXPLICIT_LITTLE:
            raise VolumeError(
                f"{found['path']}: compressed or unusual transfer syntax {syntax}; uncompress the"
                " series first, for example with gdcmconv --raw")
        tag, length, at = element_head(data, at, syntax == EXPLICIT_LITTLE)
        if tag == PIXEL_DATA:
            if length == UNDEFINED:
                raise VolumeError(f"{found['path']}: compressed, against its transfer syntax")
            found["pixels"], found["length"] = at, length
            return
        if length == UNDEFINED:
            # Of an unknown kind: its items are implicit (PS3.5, 6.2.2).
            is_unknown = data[at - 8:at - 6] == b"UN" and syntax == EXPLICIT_LITTLE
            at = skip_items(data, at, syntax == EXPLICIT_LITTLE and not is_unknown)
            continue
        if at + length > len(data):
            raise IndexError("the file is cut off")
        if tag in TAGS:
            name, value = TAGS[tag], data[at:at + length]
            found[name] = (struct.unpack("<H", value[:2])[0] if name in NUMBERS
                           else value.decode("latin-1").strip(" \0"))
        at += length


def element_head(data, at, explicit):
    """Tag, length of the value and where it starts."""
    tag = struct.unpack_from("<HH", data, at)
    if not explicit or tag[0] == 0xFFFE:
        return tag, struct.unpack_from("<I", data, at + 4)[0], at + 8
    if data[at + 4:at + 6] in LONG_FORMS:
        return tag, struct.unpack_from("<I", data, at + 8)[0], at + 12
    return tag, struct.unpack_from("<H", data, at + 6)[0], at + 8


def skip_items(data, at, explicit):
    """The end of a sequence or item of undefined length that starts here."""
    while at + 8 <= len(data):
        tag, length, at = element_head(data, at, explicit)
        if tag in (SEQUENCE_END, ITEM_END):
            return at
        at = skip_items(data, at, explicit) if length == UNDEFINED else at + length
    raise IndexError("a sequence does not end")


def check_single_series(slices, folder):
    """Stop with a list of what is there when the folder holds several series."""
    series = {}
    for part in slices:
        series.setdefault(part.get("series", "?"), []).append(part)
    if len(series) > 1:
        names = "; ".join(f"{parts[0].get('description', 'unnamed')}: {len(parts)} files,"
                          f" from {os.path.basename(parts[0]['path'])}"
                          for parts in series.values())
        raise VolumeError(f"{folder}: {len(series)} series, one per folder is needed ({names})")


def check_slice(part, first):
    """Turn the text values into numbers; stop where a slice does not fit the first one."""
    path = part["path"]
    missing = [name for name in ("rows", "columns", "bits", "position", "orientation", "spacing")
               if name not in part]
    if missing:
        raise VolumeError(f"{path}: lacks {', '.join(missing)}: not a slice of a volume")
    if part.get("samples", 1) != 1:
        raise VolumeError(f"{path}: {part['samples']} components per pixel; one is needed")
    for name, default in (("frames", 1), ("slope", 1), ("intercept", 0), ("thickness", 1)):
        try:
            part[name] = float(part.get(name) or default)
        except ValueError as error:
            raise VolumeError(f"{path}: its header is damaged: {name} '{part[name]}'") from error
    if part["frames"] != 1:
        raise VolumeError(f"{path}: multi-frame files are not read")
    if part["bits"] not in (8, 16, 32):
        raise VolumeError(f"{path}: {part['bits']} bits per pixel are not read")
    for name, count in (("position", 3), ("orientation", 6), ("spacing", 2)):
        try:
            part[name] = np.array([float(n) for n in part[name].split("\\")])
        except ValueError as error:
            raise VolumeError(f"{path}: the {name} cannot be parsed ({error})") from error
        if part[name].size != count:
            raise VolumeError(f"{path}: {part[name].size} numbers for the {name}, not {count}")
    for name in ("rows", "columns", "bits", "signed", "orientation", "spacing"):
        if not np.allclose(part.get(name, 0), first.get(name, 0), atol=1e-3):
            raise VolumeError(f"{path}: {name} {part.get(name)} differs from the first slice's"
                              f" {first.get(name)}")


def slice_distance(slices, normal, folder):
    """Distance of neighbouring slices; an error for missing, repeated and sheared ones."""
    if len(slices) == 1:
        return slices[0]["thickness"] or 1.0
    steps = np.diff([part["position"] for part in slices], axis=0)
    along = steps @ normal
    mean = along.mean()
    if along.min() <= 1e-4:
        raise VolumeError(f"{folder}: several slices at one position")
    if np.abs(along - mean).max() > UNEVEN * mean:
        raise VolumeError(f"{folder}: slices are {along.min():.4g} to {along.max():.4g} mm apart:"
                          " some are missing, or the volume must be resampled")
    if np.linalg.norm(steps - np.outer(along, normal), axis=1).max() > UNEVEN * mean:
        raise VolumeError(f"{folder}: the gantry was tilted; the volume must be resampled first")
    return float(mean)


def read_pixels(part):
    """The stored values of a slice, array [row, column]."""
    dtype = np.dtype(f"<{'i' if part.get('signed') else 'u'}{part['bits'] // 8}")
    count = part["rows"] * part["columns"]
    with open(part["path"], "rb") as file:
        file.seek(part["pixels"])
        data = file.read(count * dtype.itemsize)
    length = min(part["length"], len(data))
    if length < count * dtype.itemsize:
        raise VolumeError(f"{part['path']}: the pixels are cut off: {length} bytes,"
                          f" {count * dtype.itemsize} needed; copy the file again")
    return np.frombuffer(data, dtype).reshape(part["rows"], part["columns"])


def rescale(voxels, slices):
    """Stored values to physical ones (Hounsfield units for CT), as integers where they are."""
    slopes = np.array([part["slope"] for part in slices])
    shifts = np.array([part["intercept"] for part in slices])
    if (slopes == 1).all() and (shifts == 0).all():
        return voxels
    if (slopes == slopes[0]).all() and np.all(np.mod([slopes, shifts], 1) == 0):
        values = voxels.astype(np.int64) * int(slopes[0]) + shifts.astype(int)[:, None, None]
        fitting = [dtype for dtype in (np.int16, np.int32) if np.iinfo(dtype).min <= values.min()
                   and values.max() <= np.iinfo(dtype).max]
        return values.astype(fitting[0]) if fitting else values
    return (voxels * slopes[:, None, None] + shifts[:, None, None]).astype(np.float32)
