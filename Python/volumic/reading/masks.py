# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Label maps from masks: one file per label, or the volumes of one file."""
from __future__ import annotations

import dataclasses
import os

import numpy as np

from ..errors import VolumeError
from .volume import Label, prefix_errors, plain_name

_SUFFIXES = (".nii.gz", ".nii", ".seg.nrrd", ".nrrd", ".nhdr", ".mha", ".mhd", ".vti", ".mgz")
_TOLERANCE = .01  # of label values


def masks_among(files):
    """Return the files that have a format of masks, sorted."""
    return sorted(file for file in files if file.lower().endswith(_SUFFIXES))


def read_masks(files, choice, read_one):
    """Read one mask per file with read_one(path, choice)."""
    inner = dataclasses.replace(choice, labels=True, time=0, series=None, raw=None, component=None)

    def opened():
        for file in files:
            name = os.path.basename(file)
            suffix = next(s for s in _SUFFIXES if name.lower().endswith(s))
            yield name, plain_name(name[:-len(suffix)]), lambda f=file: read_one(f, inner)
    return _merged(opened(), choice)


def read_times(path, count, choice, read_one):
    """Read one mask per volume of a file."""
    volume = _merged([("volume %d" % t, "", lambda t=t: read_one(path, dataclasses.replace(
        choice, time=t))) for t in range(count)], choice)
    volume.warnings.append("%d volumes in one file are read as masks of labels 1 to %d; choose one "
                           "of them with --time" % (count, count))
    return volume


def _merged(masks, choice):
    """Return the label map of masks, each a location, a name and a function that reads it. Where
    masks overlap, the smaller one has the voxel; with choice.layers, overlapping masks are in
    different components of the array."""
    whole, layers, counts, names, shared, several = None, [], [0], [""], {}, False
    for number, (location, name, load) in enumerate(masks, 1):
        with prefix_errors(location):
            mask = load()
            if whole is None:
                first = location
                whole = dataclasses.replace(mask, labels=[], warnings=[], components="",
                                            name="Labels")
                layers = [np.zeros(mask.array.shape[-3:], np.uint16)]
            if not _has_same_grid(whole, mask):
                raise VolumeError("the grid differs from that of %s" % first)
            inside = _inside(mask.array)
        whole.warnings += [text for text in mask.warnings if text not in whole.warnings]
        counts.append(int(inside.sum()))
        names.append(name or location)
        if number > 65535:
            raise VolumeError("more than 65535 masks")
        at = 0
        if choice.layers:
            at = next((i for i, layer in enumerate(layers) if not layer[inside].any()), len(layers))
            if at == len(layers):
                layers.append(np.zeros_like(layers[0]))
        else:
            others = layers[0][inside]
            several |= inside & (layers[0] > 0)
            for other, voxels in zip(*np.unique(others[others > 0], return_counts=True)):
                shared[int(other), number] = int(voxels)
            inside[inside] = (others == 0) | (np.array(counts)[others] > counts[number])
        layers[at][inside] = number
        if name or choice.layers:
            whole.labels.append(Label(number, name, layer=at))
    whole.warnings += _warnings(shared, np.count_nonzero(several), counts, names)
    dtype = np.uint8 if len(counts) <= 256 else np.uint16
    whole.array = np.stack(layers).astype(dtype) if len(layers) > 1 else layers[0].astype(dtype)
    return whole


def _has_same_grid(a, b):
    if a.array.shape[-3:] != b.array.shape[-3:]:
        return False
    matrices = [np.column_stack([v.origin, v.direction * v.spacing]) for v in (a, b)]
    sizes = np.array([1, *np.array(a.array.shape[:-4:-1]) - 1])
    return (np.abs(matrices[0] - matrices[1]) @ sizes < .1 * min(a.spacing)).all()


def _inside(values):
    """Return where a mask is not 0. Raise VolumeError unless it has one other value."""
    if values.ndim != 3:
        raise VolumeError("voxels of a mask have one component, not %d" % len(values))
    # NaN is outside.
    inside = values != 0 if values.dtype.kind in "ui" else np.abs(values) > _TOLERANCE
    found = values[inside]
    differs = np.abs(found - found[:1].astype(float)) > _TOLERANCE
    other = found[np.argmax(differs)] if len(found) else 0
    if len(found) and abs(float(other) - float(found[0])) > _TOLERANCE:
        raise VolumeError(
            "has the values %g and %g, but a mask has 0 and one other value. Volumes of a folder "
            "or file are read as masks, one per label; give the name of a single volume or label "
            "map, or choose one volume of the file with --time" % (found[0], other))
    return inside


def _warnings(shared, several, counts, names):
    """Return warnings about masks that overlap or are empty."""
    warnings = []
    if shared:
        pairs = ["%s and %s %d" % (names[a], names[b], n) for (a, b), n in sorted(shared.items())]
        warnings.append("%d overlapping voxels (%s) are assigned to the smaller mask; give a "
                        "folder (OUT/) for complete masks"
                        % (several, ", ".join(pairs[:5]) + ", ..." * (len(pairs) > 5)))
    empty = [name for name, count in zip(names[1:], counts[1:]) if not count]
    return warnings + ["empty masks: " + ", ".join(empty)] * bool(empty)
