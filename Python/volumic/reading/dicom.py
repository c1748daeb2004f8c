# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""DICOM by pydicom: series of slices, files of many frames, segmentations. A slice is a file or a
frame of one. GDCM unpacks compressed pixels in a worker process, which it may crash."""
from __future__ import annotations

import collections
import os
import re
import types
import warnings

import numpy as np

from . import list_files
from ..errors import VolumeError
from .grid import need_bytes, on_regular_grid, one_of_times
from .microscopy import natural
from .volume import Label, Volume, plain_name, text_of
from .worker import in_worker, reading, said

_NO_SLICE = "; copy it again, or move it to another folder"

# ---- Files -------------------------------------------------------------------------------------


def is_dicom(file):
    """Return whether a file begins as DICOM: with its mark, or, of old ones, with group 2 or 8."""
    with open(file, "rb") as stream:
        head = stream.read(132)
    return head[128:] == b"DICM" or len(head) == 132 and (
        head[:4] in (b"\2\0\0\0", b"\b\0\0\0", b"\b\0\5\0", b"\b\0\b\0", b"\b\0\x16\0")
        and (head[4:6].isupper() or head[5:8] == bytes(3)))


def dicom_files(path):
    """Return the DICOM files among those that belong to a path.

    Throw VolumeError if one beside them looks like a slice that was cut off or damaged."""
    files = list(dict.fromkeys(map(os.path.abspath, list_files(path))))
    slices = sorted((file for file in files if is_dicom(file)), key=natural)
    keys = lambda file: (os.path.splitext(file)[1].lower(), re.sub(r"\d+", "0", file))
    endings, forms = map(set, zip(*map(keys, slices))) if slices else ((), ())
    for folder in sorted({os.path.dirname(file) for file in slices}):
        for entry in sorted(os.scandir(folder), key=lambda entry: entry.name):
            file = os.path.join(folder, entry.name)
            if entry.name.startswith(".") or not entry.is_file() or is_dicom(file):
                continue
            with open(file, "rb") as stream:
                head, (ending, form) = stream.read(136), keys(file)
            if (ending in (".dcm", ".dicom", ".ima") or form in forms or head[132:] == b"\2\0\0\0"
                    or not head.strip(b"\0") and ending in endings):
                raise VolumeError("%s: no DICOM file, though like the slices beside it: it is cut off "
                                  "or damaged%s" % (entry.name, _NO_SLICE))
    return slices


def _read(file, name, **more):
    """Return the data set of a file."""
    import pydicom
    warnings.filterwarnings("ignore", module="pydicom")
    try:
        data = pydicom.dcmread(file, force=True, **more)
    except Exception as error:  # pylint: disable=broad-except
        raise VolumeError("%s: it is cut off, or its header is damaged (%s); copy it again"
                          % (name, error)) from None
    data.syntax = data.file_meta.get("TransferSyntaxUID") or pydicom.uid.ImplicitVRLittleEndian
    return data


# ---- Headers -----------------------------------------------------------------------------------


def _numbers(sets, name, count=1, default=None):
    """Return the `count` numbers of an attribute in the first data set that has it; 1: a number."""
    value = next((v for v in (each.get(name) for each in sets) if v not in (None, "")), None)
    if value is None:
        return default
    values = np.array(value, float).ravel()
    if len(values) < count or not np.isfinite(values).all():
        raise VolumeError("its header is damaged: %s is %s" % (name, value))
    return values[:count] if count > 1 else values[0]


def _slices(data, file, name):
    """Return the slices in a file; none if it is a directory or a report."""
    if not data.get("Rows"):
        kind = data.file_meta.get("MediaStorageSOPClassUID") or data.get("SOPClassUID") or ""
        if getattr(kind, "name", kind) == kind or re.search("Image|Segmentation|Dose", kind.name):
            raise VolumeError("it has no pixels: it is cut off, or no slice" + _NO_SLICE)
        return []
    frames = int(data.get("NumberOfFrames") or 1)
    own = data.get("PerFrameFunctionalGroupsSequence") or []
    if not 1 <= frames <= max(1, os.path.getsize(file) // 8) or own and len(own) != frames:
        raise VolumeError("its header is damaged, or the file is cut off: %d frames, %d descriptions "
                          "of frames" % (frames, len(own)))
    groups = lambda items: [e.value[0] for i in items for e in i if e.VR == "SQ" and len(e.value) == 1]
    common = groups((data.get("SharedFunctionalGroupsSequence") or [])[:1]) + [data]
    bits, padding = int(data.get("BitsAllocated") or 0), data.get("PixelPaddingValue")
    if padding is not None:  # pydicom may take it for bytes, or for a number without a sign
        padding = padding if isinstance(padding, int) else int.from_bytes(padding[:2], "little")
        padding %= 1 << bits
        padding -= (data.get("PixelRepresentation") == 1 and padding >> (bits - 1)) << bits
    slices = []
    for frame in range(frames):
        sets = groups(own[frame:frame + 1]) + common
        number = lambda key, default=0.: _numbers(sets, key, default=default)
        axes, position = (_numbers(sets, "Image%sPatient" % each[0], each[1])
                          for each in (("Orientation", 6), ("Position", 3)))
        slices.append(types.SimpleNamespace(
            file=file, name=name, frame=frame, size=(int(data.Rows), int(data.get("Columns") or 0)),
            axes=None if axes is None else np.array([v / np.linalg.norm(v) for v in (axes[:3], axes[3:])]),
            position=position if own or frames == 1 else None, first=position,
            spacing=_numbers(sets, "PixelSpacing", 2), imager=_numbers(sets, "ImagerPixelSpacing", 2),
            thickness=number("SliceThickness"), segment=int(number("ReferencedSegmentNumber")),
            slope=number("RescaleSlope", 1.), shift=number("RescaleIntercept"), padding=padding,
            distance=max(number("SpacingBetweenSlices"), 0) or number("SliceThickness") or 1.,
            order=[number("TemporalPositionIndex") or number("TemporalPositionIdentifier")]
            + [number(each) for each in ("TriggerTime", "EchoTime", "InstanceNumber")] + [frame],
            copy=(data.get("SOPInstanceUID") or file, str(position), frame),
            is_packed=data.syntax.is_compressed))
    return slices


def _color(lab):
    """Return r, g, b of CIELab as DICOM scales it."""
    if lab is None or len(lab) != 3:
        return None
    l, a, b = np.array(lab, float) / 65535 * (100, 255, 255) - (0, 128, 128)
    f = np.array([a / 500, 0, -b / 200]) + (l + 16) / 116
    xyz = np.where(f > 6 / 29, f ** 3, 3 * (6 / 29) ** 2 * (f - 4 / 29)) * (.9505, 1, 1.089)
    rgb = np.clip(np.array([[3.2406, -1.5372, -.4986], [-.9689, 1.8758, .0415],
                            [.0557, -.204, 1.057]]) @ xyz, 0, 1)
    rgb = np.where(rgb <= .0031308, 12.92 * rgb, 1.055 * rgb ** (1 / 2.4) - .055)
    return tuple(np.round(255 * rgb) / 255)


def _all_series(files):
    """Return the series of files, in the order of their first files."""
    found, root = {}, os.path.commonpath(map(os.path.dirname, files)) if files else ""
    for file in files:
        name = os.path.relpath(file, root or ".")
        data = _read(file, name, stop_before_pixels=True)
        try:
            for each in _slices(data, file, name):
                series = found.setdefault(data.get("SeriesInstanceUID") or "", types.SimpleNamespace(
                    data=data, slices={}, copies=0))
                series.copies += each.copy in series.slices  # of the same instance
                series.slices.setdefault(each.copy, each)
        except Exception as error:  # pylint: disable=broad-except
            text = "" if isinstance(error, VolumeError) else "its header is damaged: "
            raise VolumeError("%s: %s%s" % (name, text, error)) from None
    for number, (uid, series) in enumerate(found.items()):
        series.slices, series.names = list(series.slices.values()), (str(number + 1), uid)
        data, first, count = series.data, series.slices[0], len(series.slices)
        places = collections.Counter(str(each.position) for each in series.slices)
        places = max(places.values()) if first.position is not None else 1
        about = [data.get("SeriesDescription") or "unnamed", data.get("Modality"),
                 data.get("SeriesDate") or data.get("StudyDate")]
        series.text = "%d: %s, %d slice%s of %d x %d%s, from %s" % (
            number + 1, ", ".join(plain_name(str(each)) for each in about if each), count,
            "s" * (count > 1), *first.size[::-1], ", %d at each place (--time)" % places
            if places > 1 and "SegmentSequence" not in data else "", os.path.basename(first.file))
    if not found:
        raise VolumeError("no DICOM image there")
    return list(found.values())


def list_series(path):
    """Return a line for each series of a path: number, description, slices, identifier."""
    return ["%s, %s" % (each.text, each.names[1]) for each in _all_series(dicom_files(path))]


def read_dicom(path, choice):
    """A series of slices or frames; the world is LPS. A file stands for its series."""
    wanted, found = choice.series, None
    if os.path.isfile(path) and os.path.basename(path).lower() != "dicomdir":
        found = _all_series([path])
        wanted = found[0].names[1] if wanted is None else wanted
    if found is None or len(found[0].slices) == 1:
        found = _all_series(dicom_files(path))
    chosen = [each for each in found if wanted is None or str(wanted) in each.names]
    if len(chosen) != 1:
        raise VolumeError("%s: %s" % (
            "no series %s; there are %d" % (wanted, len(found)) if not chosen else
            "%d series, one is needed; choose it with --series N" % len(found),
            "; ".join(each.text for each in found)))
    series = chosen[0]
    notes = ["%d of its files are copies of others" % series.copies] if series.copies else []
    make = _segmentation if series.data.get("Modality") == "SEG" else _volume
    volume = make(series, choice, notes)
    volume.warnings, volume.space, volume.unit = notes + volume.warnings, "LPS", "mm"
    return volume


# ---- Volumes -----------------------------------------------------------------------------------


def _alike(slices, notes):
    """Return the slices that are like most: not a localizer, which lies across."""
    groups = []
    for each in slices:
        group = next((group for group in groups if each.size == group[0].size and all(
            (a is None) == (b is None) and (a is None or np.abs(a - b).max() < most)
            for a, b, most in ((each.spacing, group[0].spacing, 1e-3), (each.axes, group[0].axes, .04),
                               (each.position, group[0].position, np.inf)))), [])
        groups += [] if group else [group]
        group.append(each)
    groups.sort(key=len, reverse=True)
    if len(groups) > 1:
        one, other, left = groups[0][0], groups[1][0], len(slices) - len(groups[0])
        text = "%s: its %s differs from that of %s; " % (
            other.name, "size" if other.size != one.size else
            "position, orientation or pixel spacing", one.name)
        if 4 * left > len(slices):
            raise VolumeError(text + "move files that are no slices of the volume to another folder")
        notes.append(text + "%d of %d slices are left out (a localizer?)" % (left, len(slices)))
    return groups[0]


def _geometry(slices, notes):
    """Return axes (columns), positions, heights along the normal, and distances of pixels; place
    slices that lack positions one behind the other."""
    first = slices[0]
    if first.axes is None and first.position is not None and len(slices) > 1:
        raise VolumeError(first.name + ": it lacks its orientation" + _NO_SLICE)
    across, down = np.eye(3)[:2] if first.axes is None else first.axes
    axes = np.stack([across, down, np.cross(across, down)], 1)
    if first.position is None:
        slices.sort(key=lambda each: (each.order[-2:], each.name))
        if len(slices) > 1:
            notes.append("its %d slices have no positions; they are taken one behind the other, %g mm "
                         "apart" % (len(slices), first.distance))
        for number, each in enumerate(slices):
            each.position = axes[:, 2] * first.distance * number
            each.position += 0. if first.first is None else first.first
    spacing = first.imager if first.spacing is None else first.spacing
    if first.spacing is None:
        notes.append("it has no Pixel Spacing; %s is taken; choose another one with --spacing" % (
            "1 x 1" if spacing is None else "the Imager Pixel Spacing, %g x %g, that of the detector,"
            % tuple(spacing)))
    spacing = np.ones(2) if spacing is None else spacing[::-1]  # that between rows comes first
    positions = np.array([each.position for each in slices])
    return axes, positions, positions @ axes[:, 2], spacing


def _volume(series, choice, notes):
    """Return the slices of one time on a regular grid."""
    slices = _alike(series.slices, notes)
    axes, positions, heights, spacing = _geometry(slices, notes)
    order = np.argsort(heights, kind="stable")
    places = [sorted(place, key=lambda i: slices[i].order)
              for place in np.split(order, np.flatnonzero(np.diff(heights[order]) > 1e-4) + 1)]
    most = max(places, key=len)
    if len(places) * len(most) != len(slices):
        raise VolumeError("%s lies where %s does, and others don't come twice; move what is no slice "
                          "of the volume to another folder" % tuple(slices[i].name for i in most[1::-1]))
    time = one_of_times(len(most), choice)
    order = [place[time] for place in places]
    positions, heights = positions[order], heights[order]
    values, least = _values([slices[i] for i in order])
    gaps = np.diff(heights)
    pitch = gaps.mean() if len(gaps) else slices[0].thickness or 1.
    aside = np.linalg.norm(np.diff(positions, axis=0) - gaps[:, None] * axes[:, 2], axis=1)
    rounded = lambda length: text_of([round(length, 3)])
    if np.abs(gaps - pitch).max(initial=0) > .05 * pitch:
        why = ("slices are %s to %s mm apart: some are missing, or they were taken so"
               % (rounded(gaps.min()), rounded(gaps.max())))
    elif aside.max(initial=0) > .05 * pitch:
        why = ("the gantry was tilted: each slice is shifted by up to %s mm against the one before"
               % rounded(aside.max()))
    else:
        return Volume(values, (*spacing, pitch), tuple(positions[0]), axes)
    return on_regular_grid(values, positions, axes[:, 0], axes[:, 1], spacing, choice, why,
                           0 if choice.labels else least)


def _segmentation(series, _, notes):
    """Return the frames of a segmentation as labels; frames that it leaves out are empty."""
    slices, data = series.slices, series.data
    axes, positions, heights, spacing = _geometry(slices, notes)
    steps = np.diff(np.sort(heights))
    pitch = steps[steps > 1e-4].min() if (steps > 1e-4).any() else max(slices[0].thickness, 1e-3)
    levels = (heights - heights.min()) / pitch
    if levels.max() > 1e5 or np.abs(levels - np.rint(levels)).max() > .05:
        raise VolumeError("its frames lie at uneven distances")
    result, overlap = np.zeros((int(round(levels.max())) + 1, *slices[0].size), np.uint16), 0
    least = (data.get("MaximumFractionalValue") or 0) / 2 * (data.get("SegmentationType") == "FRACTIONAL")
    for i, pixels in _pixels(slices):
        mask, place = pixels > least, result[int(round(levels[i]))]
        overlap += np.count_nonzero(place[mask])
        place[mask] = slices[i].segment or pixels[mask]
    if overlap:
        notes.append("its segments overlap in %d voxels, which get the last one of them" % overlap)
    labels = [Label(int(each.SegmentNumber), plain_name(str(each.get("SegmentLabel") or "")),
                    _color(each.get("RecommendedDisplayCIELabValue")))
              for each in data.get("SegmentSequence") or []]
    return Volume(result, (*spacing, pitch), tuple(positions[heights.argmin()]), axes, labels=labels,
                  name="Labels")


# ---- Pixels ------------------------------------------------------------------------------------


def _values(slices):
    """Return the rescaled values [slice, y, x], and the least, which padding gets."""
    raw = None
    for i, pixels in _pixels(slices):
        raw = np.empty((len(slices), *pixels.shape), pixels.dtype) if raw is None else raw.astype(
            np.promote_types(raw.dtype, pixels.dtype), copy=False)
        raw[i] = pixels
    kept = [plane if s.padding is None else plane[plane != s.padding] for plane, s in zip(raw, slices)]
    ends = [s.slope * float(end) + s.shift for plane, s in zip(kept, slices) if plane.size
            for end in (plane.min(), plane.max())] or [0.]
    factors, dtype = np.array([(s.slope, s.shift) for s in slices]), raw.dtype
    if (factors != (1, 0)).any():
        dtype = np.dtype("f4" if (factors % 1).any() else next((
            t for t in ("i2", "u2", "i4") if np.iinfo(t).min <= min(ends) and max(ends) <= np.iinfo(t).max),
            "f8"))
    result = raw.view(dtype) if dtype.itemsize == raw.itemsize else np.empty(raw.shape, dtype)
    for plane, new, s in zip(raw, result, slices):
        values = plane if (s.slope, s.shift) == (1, 0) else plane * s.slope + s.shift
        new[...] = values if s.padding is None else np.where(plane == s.padding, min(ends), values)
    return result, min(ends)


def _pixels(slices):
    """Generate (number, stored pixels) of each slice, file by file."""
    numbers = collections.defaultdict(list)
    for number, each in enumerate(slices):
        numbers[each.file, each.name].append(number)
    packed = [file for file, those in numbers.items() if slices[those[0]].is_packed]
    unpacked = dict(zip(packed, in_worker("volumic.reading.dicom:unpack", packed) if packed else ()))
    for file, those in numbers.items():
        size, bits = slices[those[0]].size, 8
        area = size[0] * size[1]
        try:
            values, bits = (unpacked.pop(file), 8) if file in unpacked else _plain(*file, area)
        except VolumeError as error:
            raise VolumeError("%s: %s" % (file[1], error)) from None
        for number in those:
            at = slices[number].frame * area
            part = values[at:at + area] if bits > 1 else np.unpackbits(
                values[at // 8:(at + area + 7) // 8], bitorder="little")[at % 8:at % 8 + area]
            if part.size != area:
                raise VolumeError("%s: its pixels are fewer than its sizes require" % file[1])
            yield number, part.reshape(size)


def _plain(file, name, area):
    """Return the values of a file that is not compressed (of 1 bit: its bytes), and their bits."""
    data = _read(file, name)
    bits, samples = int(data.get("BitsAllocated") or 0), int(data.get("SamplesPerPixel") or 1)
    if samples != 1 or bits not in (1, 8, 16, 32):
        raise VolumeError("%d components per pixel of %d bits cannot be read; one of 1, 8, 16 or 32 "
                          "bits can" % (samples, bits))
    tags, end = list(data.keys()), os.path.getsize(file)
    if "PixelData" not in data:
        raise VolumeError("it has no pixels: it is cut off, or no slice" + _NO_SLICE)
    last, behind = data.get_item(tags[-1]), tags[tags.index(0x7FE00010):]
    if hasattr(last, "value_tell") and last.length != 0xFFFFFFFF and not data.syntax.is_deflated:
        end = last.value_tell + last.length
    if behind != sorted(behind) or end != os.path.getsize(file):
        raise VolumeError("it is cut off or damaged: it does not end behind its pixels; copy it again")
    need = (int(data.get("NumberOfFrames") or 1) * area * bits + 7) // 8
    need_bytes(len(data.PixelData), need + need % 2 * (len(data.PixelData) > need), exact=True)
    kind = "%s%s%d" % ("<" if data.syntax.is_little_endian else ">", "i" if bits > 1 and data.get(
        "PixelRepresentation") == 1 else "u", max(1, bits // 8))
    return np.frombuffer(data.PixelData, kind, need * 8 // max(8, bits)), bits


def unpack(files):
    """Return the values of compressed files (path, name): for the worker process.

    pydicom's handler for GDCM ignores its failures, and returns memory that was never written."""
    import gdcm
    gdcm.Trace.ErrorOff()
    gdcm.Trace.WarningOff()
    plain, found = gdcm.TransferSyntax(gdcm.TransferSyntax.ExplicitVRLittleEndian), []
    for file, name in files:
        reading(name)
        said()
        reader, change = gdcm.ImageReader(), gdcm.ImageChangeTransferSyntax()
        reader.SetFileName(file)
        change.SetTransferSyntax(plain)
        done = reader.Read() and not change.SetInput(reader.GetImage()) and change.Change()
        damage = re.search("(?i).*(corrupt|premature|bogus|invalid).*", said())
        if not done or damage:
            raise VolumeError("%s: its pixels cannot be unpacked: they are damaged, or packed in a way "
                              "that GDCM cannot read%s" % (name, " (%s)" % damage[0] if damage else ""))
        image = change.GetOutput()
        kind = image.GetPixelFormat()
        if kind.GetSamplesPerPixel() != 1:
            raise VolumeError("%s: %d components per pixel cannot be read; one can"
                              % (name, kind.GetSamplesPerPixel()))
        found.append(np.frombuffer(image.GetBuffer().encode("utf-8", "surrogateescape"), "%s%d" % (
            "i" if kind.GetPixelRepresentation() else "u", kind.GetBitsAllocated() // 8)))
    return found
