# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""NIfTI-1/2, Analyze, MGH/MGZ and MINC 1/2 by nibabel, with world coordinates in RAS."""
from __future__ import annotations

import bz2
import contextlib
import gzip
import html
import logging
import math
import re

import numpy as np

from ..errors import VolumeError
from .grid import one_of_times, make_volume, voxels
from .volume import Label, plain_name, text_of
from .worker import in_worker


@contextlib.contextmanager
def log_of(name):
    """Collect the messages of a logger instead of printing them."""
    logger, lines = logging.getLogger(name), []
    kept, propagates, handler = logger.handlers[:], logger.propagate, logging.Handler()
    handler.emit = lambda record: lines.append(record.getMessage())
    logger.handlers[:], logger.propagate = [handler], False
    try:
        yield lines
    finally:
        logger.handlers[:], logger.propagate = kept, propagates


def read_nifti(path, choice):
    import nibabel
    with log_of("nibabel.global") as lines:
        image = nibabel.load(path)
        affine, space, unit, warnings = _world_of(image)
    warnings += ["corrected header: " + line for line in lines if "SPM" not in line]
    array, labels = _read_voxels(image, choice)
    components = ""
    if array.dtype.fields:  # colours
        array = np.moveaxis(array.view("u1").reshape(*array.shape, -1), -1, 0)
        components = "color"
    elif array.ndim == 4:
        components = "vector"
    return make_volume(array, affine[:3, :3], affine[:3, 3], space, unit, choice, labels=labels,
                       warnings=warnings, components=components)


def _world_of(image):
    """Return matrix, space and unit of an image, and warnings."""
    import nibabel
    header, name = image.header, type(image).__name__
    if name.startswith("MGH"):
        return image.affine, "RAS", "mm", []
    zooms = np.abs(np.array(header["pixdim"][1:4], float))
    zooms[[n + 1 > header["dim"][0] for n in range(3)]] = 1
    plain = np.diag([*zooms, 1])
    if not isinstance(image, nibabel.Nifti1Pair):  # Analyze
        return plain, "", "", []
    warnings = []
    unit = {"meter": "m", "mm": "mm", "micron": "um"}.get(header.get_xyzt_units()[0], "")
    if unit in ("m", "um"):
        warnings.append("the unit is %s, not mm; outputs and options use it unless --unit gives "
                        "another" % unit)
    sform, code = header.get_sform(coded=True)
    sform = sform if code else None
    try:
        qform, code = header.get_qform(coded=True)
        qform = qform if code else None
    except ValueError as error:  # invalid quaternion; without sform, nibabel rejects the file
        qform = None
        warnings.append("the qform is not a rotation (%s); the sform is used" % error)
    if sform is not None and qform is not None and not _is_invertible(sform):
        warnings.append("the sform has axes that are parallel or zero (%s); the qform is used"
                        % _matrix_text(sform))
        sform = None
    if sform is not None and qform is not None:
        sizes = np.array([1] + list(image.shape[:3]) + [1] * (3 - len(image.shape[:3])))
        apart = np.abs(sform - qform)[:3, [3, 0, 1, 2]] @ (sizes - [0, 1, 1, 1])
        if not (apart < .1 * zooms.min()).all():
            warnings.append("sform and qform differ and the sform is used: %s; %s"
                            % (_matrix_text(sform), _matrix_text(qform)))
    form = sform if sform is not None else qform
    return (plain, "", unit, warnings) if form is None else (form, "RAS", unit, warnings)


def _is_invertible(matrix):
    lengths = np.sqrt((matrix[:3, :3] ** 2).sum(0))
    return (np.isfinite(matrix).all() and lengths.min() > 0
            and abs(np.linalg.det(matrix[:3, :3] / lengths)) > .1)


def _matrix_text(matrix):
    return "steps and origin " + text_of(np.round(matrix[:3, :4].T.ravel(), 4) + 0., " ")


def _read_voxels(image, choice):
    """Return the voxels of an image as [z, y, x] or [component, z, y, x], scaled as the header
    says, and its labels."""
    proxy = image.dataobj
    shape = list(image.shape) + [1] * (5 - len(image.shape))
    if len(shape) > 5 and max(shape[5:]) > 1 or min(shape) < 1:
        raise VolumeError("dimensions %s are not those of a volume" % text_of(image.shape))
    file = image.file_map["image"].filename
    with open(file, "rb") as stream:
        start = stream.read(3)
    compression = "gzip" if start[:2] == b"\x1f\x8b" else "bz2" if start == b"BZh" else None
    dtype, size = proxy.dtype, math.prod(shape[:3]) * proxy.dtype.itemsize
    time, head = one_of_times(shape[3], choice), proxy.offset
    offset, head = (0, head) if compression else (head, 0)
    parts = [voxels(file, offset, dtype, size // dtype.itemsize, compression,
                    head + size * (time + shape[3] * part), head + size * shape[3] * shape[4],
                    exact=not type(image).__name__.startswith("MGH")).reshape(shape[2::-1])
             for part in range(shape[4])]
    array = np.stack(parts) if len(parts) > 1 else parts[0]
    slope, shift = proxy.slope, proxy.inter
    if np.isfinite([slope, shift]).all() and slope != 0 and (slope, shift) != (1, 0):
        real = np.float32 if array.dtype.itemsize < 4 or array.dtype.str[1:] == "f4" else np.float64
        array = array * real(slope) + real(shift)
    return array, _labels_before(file, compression, proxy.offset)


def _labels_before(file, compression, offset):
    """Return the labels in the table that TotalSegmentator and Connectome Workbench write between
    header and voxels: <Label Key="1" Red="1" Green="0" Blue="0">spleen</Label>."""
    labels = []
    opener = gzip.open if compression == "gzip" else bz2.open if compression else open
    with opener(file, "rb") as stream:
        text = stream.read(min(offset, 1 << 22)).decode("utf-8", "replace")
    for element in text.split("<Label ")[1:]:
        head, _, body = element.partition(">")
        body, closed, _ = body.partition("</Label>")
        found = dict(re.findall(r'(\w+)="([^"]*)"', head))
        try:
            value = float(found["Key"])
            color = tuple(float(found[name]) for name in ("Red", "Green", "Blue") if name in found)
        except (KeyError, ValueError):
            continue
        if closed and value == int(value):
            _, cdata, name = body.partition("<![CDATA[")
            name = name.partition("]]>")[0] if cdata else html.unescape(body)
            labels.append(Label(int(value), plain_name(name), color if len(color) == 3 else None))
    return labels


def read_minc(path, choice):
    """Read MINC 1 or 2 in a worker process, as HDF5 crashes on some damaged files."""
    array, affine, choice.times = in_worker("volumic.reading.neuro:load_minc", path, choice)
    return make_volume(array, affine[:3, 2::-1], affine[:3, 3], "RAS", "mm", choice)


def load_minc(path, choice):
    """Return the real values [z, y, x] of a MINC file, its matrix, and the number of times."""
    import nibabel
    image = nibabel.load(path)
    shape = image.shape
    if not 3 <= len(shape) <= 4:
        raise VolumeError("dimensions %s are not those of a volume" % text_of(shape))
    time = one_of_times(shape[0] if len(shape) == 4 else 1, choice)
    array = image.dataobj[time] if len(shape) == 4 else image.dataobj
    return np.ascontiguousarray(array, dtype=np.float32), image.affine, choice.times
