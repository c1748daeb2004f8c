# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""DICOM by pydicom: series of slices, segmentations. A slice is a single-frame file or a frame."""
from __future__ import annotations

import collections
import os
import re
import types

import numpy as np

from . import list_files
from ..errors import VolumeError
from .dicom_pixels import COPY_OR_MOVE, pixels_of, read_file, values_of
from .grid import on_regular_grid, one_of_times
from .microscopy import natural
from .volume import Label, Volume, plain_name, prefix_errors, text_of


def is_dicom(file):
    """Return whether a file is DICOM: by its signature, or, without preamble, by group 2 or 8."""
    with open(file, "rb") as stream:
        head = stream.read(132)
    return head[128:] == b"DICM" or len(head) == 132 and head[0] in (2, 8) and not (
        head[1] or head[3]) and (head[4:6].isupper() or head[5:8] == bytes(3))


def dicom_files(path):
    """Return the DICOM files of a path. Raise VolumeError if a similar file is no valid DICOM."""
    slices = [file for file in map(os.path.abspath, list_files(path)) if is_dicom(file)]
    keys = lambda file: (os.path.splitext(file)[1].lower(), re.sub(r"\d+", "0", file))
    endings, forms = map(set, zip(*map(keys, slices))) if slices else ((), ())
    folders = sorted({os.path.dirname(file) for file in slices})
    for file in [os.path.join(folder, name) for folder in folders for name in os.listdir(folder)]:
        name, (ending, form) = os.path.basename(file), keys(file)
        if name.startswith(".") or not os.path.isfile(file):
            continue
        if is_dicom(file):
            slices += [file] * os.path.exists(path)  # without preamble
            continue
        with open(file, "rb") as stream:
            head = stream.read(136)
        if (ending in (".dcm", ".dicom", ".ima") or form in forms or head[132:] == b"\2\0\0\0"
                or not head.strip(b"\0") and ending in endings):
            raise VolumeError("%s: not a DICOM file, unlike similar files next to it: truncated or "
                              "damaged%s" % (name, COPY_OR_MOVE))
    return sorted(set(slices), key=natural)


# ---- Headers -----------------------------------------------------------------------------------

def _numbers(sets, name, count=1, default=None):
    """Return the first `count` numbers (1: scalar) of an attribute in the first set that has it."""
    value = next((v for v in (each.get(name) for each in sets) if v not in (None, "")), None)
    if value is None:
        return default
    values = np.array(value, float).ravel()
    if len(values) < count or not np.isfinite(values).all():
        raise VolumeError("invalid header: %s is %s" % (name, value))
    return values[:count] if count > 1 else values[0]


def _slices(data, file, name):
    """Return the slices in a file; empty for directories and reports."""
    if not data.get("Rows") or not data.has_pixels:
        kind = data.file_meta.get("MediaStorageSOPClassUID") or data.get("SOPClassUID") or ""
        if getattr(kind, "name", kind) == kind or re.search(
                "Image|Segmentation|Dose", kind.name) or data.get("Rows"):
            raise VolumeError("no pixels: truncated, or not a slice" + COPY_OR_MOVE)
        return []
    frames = int(data.get("NumberOfFrames") or 1)
    own = data.get("PerFrameFunctionalGroupsSequence") or []
    if not 1 <= frames <= max(1, os.path.getsize(file) // 8) or own and len(own) != frames:
        raise VolumeError("invalid header or truncated file: %d frames, %d of them with "
                          "attributes" % (frames, len(own)))
    groups = lambda items: [element.value[0] for item in items for element in item
                            if element.VR == "SQ" and len(element.value) == 1]
    common = groups((data.get("SharedFunctionalGroupsSequence") or [])[:1]) + [data]
    bits, padding = int(data.get("BitsAllocated") or 0), data.get("PixelPaddingValue")
    if padding is not None:  # pydicom may return bytes or an unsigned number
        padding = padding if isinstance(padding, int) else int.from_bytes(padding[:2], "little")
        padding %= 1 << bits
        padding -= (data.get("PixelRepresentation") == 1 and padding >> (bits - 1)) << bits
    slices = []
    for frame in range(frames):
        sets = groups(own[frame:frame + 1]) + common
        number = lambda key, default=0.: _numbers(sets, key, default=default)
        axes = _numbers(sets, "ImageOrientationPatient", 6)
        if axes is not None:
            axes = np.stack([axis / np.linalg.norm(axis) for axis in np.split(axes, 2)])
        position = _numbers(sets, "ImagePositionPatient", 3)
        slices.append(types.SimpleNamespace(
            file=file, name=name, frame=frame, size=(int(data.Rows), int(data.get("Columns") or 0)),
            position=position if own or frames == 1 else None, base=position, axes=axes,
            spacing=_numbers(sets, "PixelSpacing", 2), thickness=number("SliceThickness"),
            imager=_numbers(sets, "ImagerPixelSpacing", 2),
            distance=max(number("SpacingBetweenSlices"), 0) or number("SliceThickness") or 1.,
            slope=number("RescaleSlope", 1.), shift=number("RescaleIntercept"), padding=padding,
            segment=int(number("ReferencedSegmentNumber")),
            order=[number("TemporalPositionIndex") or number("TemporalPositionIdentifier"), *map(
                number, ("TriggerTime", "EchoTime", "InstanceNumber")), frame],
            copy=(data.get("SOPInstanceUID") or file, str(position), frame),
            is_packed=data.syntax.is_compressed))
    return slices


class _Series:
    """The distinct slices of a series, in the order of their files."""

    def __init__(self, number, uid, data):
        self.number, self.uid, self.data, self.slices, self.copies = number, uid, data, {}, 0

    def text(self):
        """Return a one-line description."""
        slices, data = list(self.slices.values()), self.data
        positions = collections.Counter(str(s.position) for s in slices if s.position is not None)
        times = max(positions.values(), default=1) if "SegmentSequence" not in data else 1
        about = [data.get("SeriesDescription") or "unnamed", data.get("Modality"),
                 data.get("SeriesDate") or data.get("StudyDate")]
        return "%d: %s, %d slice%s of %d x %d%s, from %s" % (
            self.number, ", ".join(plain_name(str(each)) for each in about if each), len(slices),
            "s" * (len(slices) > 1), *slices[0].size[::-1], ", %d at each position (--time)" % times
            if times > 1 else "", os.path.basename(slices[0].file))


def _all_series(files):
    """Return the series of files, in the order of their first files."""
    found, root = {}, os.path.commonpath([os.path.dirname(file) for file in files] or ["."])
    for file in [file for file in files if os.path.basename(file).lower() != "dicomdir"]:
        name = os.path.relpath(file, root)
        data = read_file(file, name, True)
        with prefix_errors(name):
            slices = {each.copy: each for each in _slices(data, file, name)}
            uid = str(data.get("SeriesInstanceUID") or "")
        if slices:
            series = found.setdefault(uid, _Series(len(found) + 1, uid, data))
            series.copies += any(key in series.slices for key in slices)
            for key, each in slices.items():
                series.slices.setdefault(key, each)
    if not found:
        raise VolumeError("no DICOM image found; give a file or folder of images")
    return list(found.values())


def list_series(path):
    """Return one line per series of a path: number, description, slices, UID."""
    return ["%s, %s" % (each.text(), each.uid) for each in _all_series(dicom_files(path))]


def read_dicom(path, choice):
    """Read a series of slices or frames, in LPS. A file stands for its series."""
    requested, found = choice.series, None
    if os.path.isfile(path) and os.path.basename(path).lower() != "dicomdir":
        found = _all_series([os.path.abspath(path)])
        requested = found[0].uid if requested is None else requested
    if found is None or len(found[0].slices) == 1:
        found = _all_series(dicom_files(path))
    chosen = [s for s in found if requested is None or str(requested) in (str(s.number), s.uid)]
    if len(chosen) != 1:
        texts = "; ".join(each.text() for each in found)
        raise VolumeError("%d series; choose one with --series N: %s"
                          % (len(found), texts) if chosen else
                          "no series %s; choose one of %s" % (requested, texts))
    series, notes = chosen[0], []
    if series.copies:
        notes.append("%d files are copies of others and are ignored" % series.copies)
    read = _segmentation if series.data.get("Modality") == "SEG" else _volume
    volume = read(series, list(series.slices.values()), choice, notes)
    volume.warnings, volume.space, volume.unit = notes + volume.warnings, "LPS", "mm"
    return volume


# ---- Volumes -----------------------------------------------------------------------------------

def _is_similar(one, other):
    """Return whether two slices may belong to one volume; localizers do not."""
    return one.size == other.size and all((a is None) == (b is None) and (
        a is None or np.abs(a - b).max() < limit) for a, b, limit in (
            (one.spacing, other.spacing, 1e-3), (one.axes, other.axes, .04),
            (one.position, other.position, np.inf)))


def _largest_group(slices, notes):
    groups = []
    for each in slices:
        group = next((group for group in groups if _is_similar(each, group[0])), None)
        if group is None:
            groups.append([each])
        else:
            group.append(each)
    groups.sort(key=len, reverse=True)
    if len(groups) > 1:
        one, other, ignored = groups[0][0], groups[1][0], len(slices) - len(groups[0])
        what = "size" if other.size != one.size else "position, orientation or pixel spacing"
        text = "the %s of %s differs from that of %s; " % (what, other.name, one.name)
        if 4 * ignored > len(slices):
            raise VolumeError(text + "move files of other volumes to another folder")
        notes.append(text + "%d of %d slices are ignored (localizer?)" % (ignored, len(slices)))
    return groups[0]


def _geometry(slices, notes):
    """Return axes (columns), positions, heights along the normal, and pixel spacing. Slices without
    positions are stacked."""
    first = slices[0]
    if first.axes is None and first.position is not None and len(slices) > 1:
        raise VolumeError(first.name + ": the orientation is missing" + COPY_OR_MOVE)
    across, down = np.eye(3)[:2] if first.axes is None else first.axes
    axes = np.stack([across, down, np.cross(across, down)], 1)
    if first.position is None:
        slices.sort(key=lambda each: (each.order[-2:], each.name))
        for number, each in enumerate(slices):
            each.position = axes[:, 2] * first.distance * number
            each.position += 0. if first.base is None else first.base
        if len(slices) > 1:
            notes.append("%d slices have no positions; they are stacked at a distance of %g mm"
                         % (len(slices), first.distance))
    spacing = first.imager if first.spacing is None else first.spacing
    if first.spacing is None:
        notes.append("no Pixel Spacing; %s is used; change it with --spacing" % (
            "1 x 1" if spacing is None else "the Imager Pixel Spacing of the detector, %g x %g,"
            % tuple(spacing)))
    spacing = np.ones(2) if spacing is None else spacing[::-1]  # row spacing is first
    positions = np.array([each.position for each in slices])
    return axes, positions, positions @ axes[:, 2], spacing


def _volume(_, slices, choice, notes):
    """Return the slices of one time as a volume on a regular grid."""
    slices = _largest_group(slices, notes)
    axes, positions, heights, spacing = _geometry(slices, notes)
    order = np.argsort(heights, kind="stable")
    stacks = [sorted(stack, key=lambda i: slices[i].order)
              for stack in np.split(order, np.flatnonzero(np.diff(heights[order]) > 1e-4) + 1)]
    largest = max(stacks, key=len)
    if len(stacks) * len(largest) != len(slices):
        raise VolumeError("%s and %s have the same position, but not all slices occur twice; move "
                          "files of other volumes to another folder"
                          % (slices[largest[1]].name, slices[largest[0]].name))
    time = one_of_times(len(largest), choice)
    order = [stack[time] for stack in stacks]
    positions, heights = positions[order], heights[order]
    values, least = values_of([slices[i] for i in order])
    gaps = np.diff(heights)
    pitch = gaps.mean() if len(gaps) else slices[0].thickness or 1.
    aside = np.linalg.norm(np.diff(positions, axis=0) - gaps[:, None] * axes[:, 2], axis=1)
    if np.abs(gaps - pitch).max(initial=0) > .05 * pitch:
        why = ("slice distances vary from %s mm: missing slices, or irregular acquisition"
               % text_of(np.round([gaps.min(), gaps.max()], 3), " to "))
    elif aside.max(initial=0) > .05 * pitch:
        why = ("gantry tilt: slices are shifted by up to %s mm against the previous one"
               % text_of([round(aside.max(), 3)]))
    else:
        return Volume(values, (*spacing, pitch), tuple(positions[0]), axes)
    return on_regular_grid(values, positions, axes[:, 0], axes[:, 1], spacing, choice, why,
                           0 if choice.labels else least)


def _segmentation(series, slices, choice, notes):
    """Return the frames of a segmentation as labels. Omitted frames are empty."""
    axes, positions, heights, spacing = _geometry(slices, notes)
    steps = np.diff(np.sort(heights))
    pitch = steps[steps > 1e-4].min() if (steps > 1e-4).any() else max(slices[0].thickness, 1e-3)
    levels = (heights - heights.min()) / pitch
    if levels.max() > 1e5 or np.abs(levels - np.rint(levels)).max() > .05:
        raise VolumeError("frames are not equally spaced")
    levels, size, least = np.rint(levels).astype(int), slices[0].size, 0
    if series.data.get("SegmentationType") == "FRACTIONAL":
        least = (series.data.get("MaximumFractionalValue") or 255) / 2
    frames = collections.defaultdict(list)  # by segment, packed to save memory
    for i, pixels in pixels_of(slices):
        segment = slices[i].segment
        frames[segment].append((levels[i], segment or pixels, np.packbits(pixels > least)))
    mask = lambda bits: np.unpackbits(bits, count=size[0] * size[1]).reshape(size).view(bool)
    layers, at, overlap = [np.zeros((levels.max() + 1, *size), np.uint16)], {}, 0
    for segment, parts in frames.items():
        for number, layer in enumerate(layers):
            hits = sum(np.count_nonzero(layer[level][mask(bits)]) for level, _, bits in parts)
            if not hits or not choice.layers:
                break
        else:
            number, hits = len(layers), 0
            layers.append(np.zeros_like(layers[0]))
        at[segment], overlap = number, overlap + hits
        for level, values, bits in parts:
            np.copyto(layers[number][level], values, "unsafe", mask(bits))
    if overlap:
        notes.append("segments overlap in %d voxels, which get the last segment" % overlap)
    labels = [Label(int(each.SegmentNumber), plain_name(str(each.get("SegmentLabel") or "")),
                    _color(each.get("RecommendedDisplayCIELabValue")),
                    at.get(each.SegmentNumber, 0))
              for each in series.data.get("SegmentSequence") or []]
    return Volume(np.stack(layers) if len(layers) > 1 else layers[0], (*spacing, pitch),
                  tuple(positions[heights.argmin()]), axes, labels=labels, name="Labels")


def _color(lab):
    """Return the RGB colour of a CIELab value as scaled by DICOM."""
    if lab is None or len(lab) != 3:
        return None
    l, a, b = np.array(lab, float) / 65535 * (100, 255, 255) - (0, 128, 128)
    f = np.array([a / 500, 0, -b / 200]) + (l + 16) / 116
    xyz = np.where(f > 6 / 29, f ** 3, 3 * (6 / 29) ** 2 * (f - 4 / 29)) * (.9505, 1, 1.089)
    rgb = np.clip(np.array([[3.2406, -1.5372, -.4986], [-.9689, 1.8758, .0415],
                            [.0557, -.204, 1.057]]) @ xyz, 0, 1)
    rgb = np.where(rgb <= .0031308, 12.92 * rgb, 1.055 * rgb ** (1 / 2.4) - .055)
    return tuple(np.round(255 * rgb) / 255)
