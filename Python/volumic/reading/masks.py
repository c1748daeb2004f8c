# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Label maps of masks: a file for each label, or the volumes of one file."""
from __future__ import annotations

import dataclasses
import os

import numpy as np

from ..errors import VolumeError
from .volume import Label, naming, plain_name

_SUFFIXES = (".nii.gz", ".nii", ".seg.nrrd", ".nrrd", ".nhdr", ".mha", ".mhd", ".vti", ".mgz")
_NEAR = .01  # as labels are rounded


def masks_among(files):
    """Return the files that have the format of a mask, sorted."""
    return sorted(file for file in files if file.lower().endswith(_SUFFIXES))


def read_masks(files, choice, read_one):
    """Read a mask for each file. read_one: the function (path, choice) -> Volume."""
    inner = dataclasses.replace(choice, labels=True, time=0, series=None, raw=None, component=None)

    def opened():
        for file in files:
            name = os.path.basename(file)
            suffix = next(s for s in _SUFFIXES if name.lower().endswith(s))
            yield name, plain_name(name[:-len(suffix)]), lambda f=file: read_one(f, inner)
    return _merged(opened(), choice)


def read_times(path, count, choice, read_one):
    """Read a mask for each of the volumes of one file."""
    volume = _merged([("volume %d" % t, "", lambda t=t: read_one(path, dataclasses.replace(
        choice, time=t))) for t in range(count)], choice)
    volume.warnings.append("%d volumes, one behind the other, are taken for masks of labels 1 to "
                           "%d; --time chooses one of them" % (count, count))
    return volume


def _merged(masks, choice):
    """Return the label map of masks, each a place, a name, and a function that reads it.

    Where masks overlap, the smaller one has the voxel; with choice.layers each mask is whole: those
    that overlap are in different components of the array."""
    whole, layers, counts, called, shared = None, [], [0], [""], {}
    for number, (place, name, load) in enumerate(masks, 1):
        with naming(place):
            mask = load()
            if whole is None:
                first = place
                whole = dataclasses.replace(mask, labels=[], warnings=[], components="",
                                            name="Labels")
                layers = [np.zeros(mask.array.shape[-3:], np.uint16)]
            if not _alike(whole, mask):
                raise VolumeError("its voxels are not those of %s, in number or position" % first)
            inside = _inside(mask.array)
        whole.warnings += [text for text in mask.warnings if text not in whole.warnings]
        counts.append(int(inside.sum()))
        called.append(name or place)
        if number > 65535:
            raise VolumeError("there are too many masks")
        at = 0
        if choice.layers:
            at = next((i for i, layer in enumerate(layers) if not layer[inside].any()), len(layers))
            if at == len(layers):
                layers.append(np.zeros_like(layers[0]))
        else:
            others = layers[0][inside]
            for other, voxels in zip(*np.unique(others[others > 0], return_counts=True)):
                shared[int(other), number] = int(voxels)
            inside[inside] = (others == 0) | (np.array(counts)[others] > counts[number])
        layers[at][inside] = number
        if name or choice.layers:
            whole.labels.append(Label(number, name, layer=at))
    whole.warnings += _warnings(shared, counts, called)
    dtype = np.uint8 if len(counts) <= 256 else np.uint16
    whole.array = np.stack(layers).astype(dtype) if len(layers) > 1 else layers[0].astype(dtype)
    return whole


def _alike(a, b):
    """Return whether two volumes have the same voxels."""
    if a.array.shape[-3:] != b.array.shape[-3:]:
        return False
    matrices = [np.column_stack([v.origin, v.direction * v.spacing]) for v in (a, b)]
    sizes = np.array([1, *np.array(a.array.shape[:-4:-1]) - 1])
    return (np.abs(matrices[0] - matrices[1]) @ sizes < .1 * min(a.spacing)).all()


def _inside(values):
    """Return where a mask is not 0; VolumeError unless it has one other value."""
    if values.ndim != 3:
        raise VolumeError("voxels of a mask have one number, not %d" % len(values))
    inside = values != 0 if values.dtype.kind in "ui" else np.abs(values) > _NEAR  # NaN is not
    found = values[inside]
    other = found[np.argmax(np.abs(found - found[0].astype(float)) > _NEAR)] if len(found) else 0
    if len(found) and abs(float(other) - float(found[0])) > _NEAR:
        raise VolumeError(
            "has the values %g and %g: a mask has 0 and one other value. Volumes of a folder, or "
            "of a file, are read as masks, one for each label; give a volume, or a label map, by its "
            "own name, or choose one of the file's with --time" % (found[0], other))
    return inside


def _warnings(shared, counts, called):
    """Return warnings about masks that overlap or are empty."""
    warnings = []
    if shared:
        pairs = ["%s and %s %d" % (called[a], called[b], n) for (a, b), n in sorted(shared.items())]
        warnings.append("%d times a voxel is in two masks (%s): the smaller mask has it; a folder "
                        "(OUT/) has a file for each mask as a whole"
                        % (sum(shared.values()), ", ".join(pairs[:5]) + ", ..." * (len(pairs) > 5)))
    empty = [name for name, count in zip(called[1:], counts[1:]) if not count]
    return warnings + ["masks without a voxel: " + ", ".join(empty)] * bool(empty)
