# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Positions of voxels, resampling to regular grids, and voxels of files whose sizes are checked."""
from __future__ import annotations

import bz2
import dataclasses
import gzip
import io
import os
import zlib

import numpy as np

from ..errors import VolumeError
from .volume import Volume, text_of


def placed(array, steps, origin, space, unit, choice, **more):
    """Return the Volume whose voxel (i, j, k) is at origin + steps @ (i, j, k).

    Resample it to a regular grid where the columns of `steps` are not at right angles."""
    steps, origin = np.array(steps, float), np.asarray(origin, float)
    for axis in range(3):
        if not (np.isfinite(steps[:, axis]).all() and np.abs(steps[:, axis]).max() > 0):
            if not choice.spacing:
                raise VolumeError("the distance of the voxels along axis %d is not positive and "
                                  "finite; give --spacing X,Y,Z" % axis)
            steps[:, axis] = np.eye(3)[axis]
    spacing = np.sqrt((steps ** 2).sum(0))
    axes = steps / spacing
    products = [abs(axes[:, a] @ axes[:, (a + 1) % 3]) for a in range(3)]
    if max(products) > 1e-3:
        if abs(np.linalg.det(axes)) < .1 or array.shape[-3] < 2:
            raise VolumeError("the axes of the voxels are not at right angles; correct the header")
        if not np.isfinite(origin).all():
            raise VolumeError("the origin %s is not finite; correct the header" % text_of(origin))
        positions = origin + np.arange(array.shape[-3])[:, None] * steps[:, 2]
        angle = np.degrees(np.arcsin(min(1, max(products))))
        why = "its axes are up to %.15g degrees from right angles" % np.round(angle, 3)
        volume = on_regular_grid(array, positions, axes[:, 0], axes[:, 1], spacing[:2], choice, why)
        more["warnings"] = volume.warnings + more.get("warnings", [])
        return dataclasses.replace(volume, space=space, unit=unit, **more)
    return Volume(array, tuple(spacing), tuple(origin), axes, space, unit, **more)


def on_regular_grid(array, positions, across, down, spacing, choice, why, outside=None):
    """Return slices at irregular positions, resampled to the regular grid that contains them.

    positions: of the first pixel of each slice. across, down: unit vectors along rows and columns.
    Values are interpolated linearly; labels are those of the nearest voxel. outside: value
    where there is no slice (default: the least value; 0 for labels)."""
    if not choice.resampling:
        raise VolumeError(why + "; without --no-resampling they are resampled")
    positions, pitch = np.asarray(positions, float), np.array(spacing, float)
    lean = across @ down
    lean = lean if abs(lean) > 1e-3 else 0.
    upright = np.sqrt(1 - lean * lean)
    down = (down - lean * across) / upright
    normal = np.cross(across, down)
    normal *= np.sign(normal @ (positions[-1] - positions[0])) or 1
    heights = (positions - positions[0]) @ normal
    if not (np.diff(heights) > 0).all():
        raise VolumeError("its slices do not follow each other")
    lean *= pitch[1] / pitch[0]
    pitch[1] *= upright
    gaps = np.diff(heights)
    count = np.ceil(heights[-1] / gaps.min() - .05)
    shifts = (positions - positions[0]) @ np.stack([across, down], 1) / pitch
    leans = lean * (array.shape[-2] - 1)
    before = np.floor(shifts.min(0) + [min(0, leans), 0] + 1e-3)
    wider = np.ceil(shifts.max(0) + [max(0, leans), 0] - 1e-3) - before
    size = np.array(array.shape[:-4:-1], float)
    times = (size[0] + wider[0]) * (size[1] + wider[1]) * (count + 1) / size.prod()
    if not times < 16:
        raise VolumeError("%s; the regular grid that contains its slices, which are %.4g to %.4g "
                          "apart, would have %.0f times as many voxels; take out the slices that "
                          "are too near to others, or too far from them"
                          % (why, gaps.min(), gaps.max(), times))
    shape = (int(count) + 1, array.shape[-2] + int(wider[1]), array.shape[-1] + int(wider[0]))
    if outside is None:
        outside = 0 if choice.labels else array.min()
        outside = outside if np.isfinite(outside) else 0
    result = np.empty(array.shape[:-3] + shape, array.dtype)
    heights_of_grid = heights[-1] * np.arange(shape[0]) / count
    for z, height in enumerate(heights_of_grid):
        upper = int(np.clip(np.searchsorted(heights, height, "right"), 1, len(heights) - 1))
        share = (height - heights[upper - 1]) / gaps[upper - 1]
        near = .5 if choice.labels else 1e-3
        share = 0. if share < near else 1. if share > 1 - near else share
        values, inside = 0., True
        for number, weight in ((upper - 1, 1 - share), (upper, share)):
            if weight:
                part, there = _slice_on(shape[1:], array[..., number, :, :],
                                        before - shifts[number], lean, choice.labels)
                values, inside = values + weight * part, inside & there
        if array.dtype.kind in "ui":
            values = np.trunc(values + np.copysign(.5, values))
        result[..., z, :, :] = np.where(inside, values, outside)
    pitch = (pitch[0], pitch[1], heights[-1] / count)
    origin = positions[0] + across * pitch[0] * before[0] + down * pitch[1] * before[1]
    text = ("%s; resampled from %s to %s voxels of %s"
            % (why, text_of(size), text_of(shape[::-1]), text_of(np.round(pitch, 3))))
    return Volume(result, pitch, tuple(origin), np.stack([across, down, normal], 1),
                  warnings=[text], resampling=text)


def _slice_on(shape, pixels, shift, lean, are_labels):
    """Return the values of a slice at the pixels of the grid, and where it has values."""
    from scipy import ndimage
    y, x = np.mgrid[:shape[0], :shape[1]].astype(float)
    y += shift[1]
    x += shift[0] - lean * y
    places, margin = np.stack([y, x]), 1e-6
    if are_labels:
        places, margin = np.trunc(places + np.copysign(.5, places)), 0.
    last = np.array(pixels.shape[-2:])[:, None, None] - 1
    inside = ((places >= -margin) & (places <= last + margin)).all(0)
    values = [ndimage.map_coordinates(plane.astype(float), places, order=0 if are_labels else 1,
                                      mode="nearest")  # 'constant' excludes 1e-13 beyond the end
              for plane in pixels.reshape(-1, *pixels.shape[-2:])]
    return np.stack(values).reshape(pixels.shape[:-2] + tuple(shape)), inside


def one_of_times(count, choice, what="volumes, one behind the other (times, phases, or masks)"):
    """Return the index of the chosen one of `count` volumes, and store the count in `choice`."""
    choice.times = count
    last = ", but 0 to %d" % (count - 1) if count > 1 else ", but one volume"
    if choice.time is None and count > 1 and not choice.labels:
        raise VolumeError("%d %s; choose one with --time N, 0 to %d" % (count, what, count - 1))
    if not 0 <= (choice.time or 0) < count:
        raise VolumeError("there is no time %d (--time)%s" % (choice.time, last))
    return choice.time or 0


def need_bytes(have, need, exact=False):
    """Throw VolumeError if a file has fewer bytes of voxels than its header requires, or, with
    `exact`, more of them: the check of all formats."""
    if have < need or have > need and exact:
        raise VolumeError("the file is %s: it has %d bytes of voxels, its header requires %d; "
                          "copy it again" % ("cut off" if have < need else "too long",
                                             max(have, 0), need))


def voxels(file, offset, dtype, count, packing=None, skip=0, size=None, exact=False):
    """Return `count` values of a file, mapped into memory unless packed ("gzip", "zlib", "bz2").

    offset: where the data begin. skip: bytes of the plain data before the values. size: bytes of
    all plain data (default: up to the last value). exact: no other bytes may follow these."""
    dtype, count = np.dtype(dtype), int(count)
    size = skip + count * dtype.itemsize if size is None else size
    if not packing:
        need_bytes(os.path.getsize(file) - offset, size, exact)
        return np.memmap(file, dtype, "r", offset + skip, (count,))
    with open(file, "rb") as stream:
        stream.seek(offset)
        return unpacked(stream, packing, dtype, count, skip, size, exact)


def unpacked(stream, packing, dtype, count, skip=0, size=None, exact=False):
    """Return values of a packed stream as voxels() does; checksums are compared."""
    dtype, count = np.dtype(dtype), int(count)
    size = skip + count * dtype.itemsize if size is None else size
    opener = {"bz2": bz2.open, "zlib": _Inflated}.get(packing, gzip.open)
    with opener(stream) as plain:
        behind = size - _skip(plain, skip) - count * dtype.itemsize
        data = from_stream(plain, dtype, count)
        if _skip(plain, behind) == behind and plain.read(1) and exact:
            raise VolumeError("the packed data give more than the %d bytes that the header "
                              "requires; copy the file again" % size)
        while not exact and plain.read(1 << 20):
            pass
    return data


def _skip(stream, count):
    """Read `count` bytes, and return the count."""
    left = count
    while left:
        part = len(stream.read(min(left, 1 << 20)))
        if not part:
            raise EOFError
        left -= part
    return count


class _Inflated(io.BufferedIOBase):
    """The plain bytes of a stream in the format of zlib or gzip."""

    def __init__(self, packed):
        self.packed, self.machine = packed, zlib.decompressobj(47)

    def read(self, count=-1):
        """Return up to `count` bytes; none at the end of the packed data."""
        while not self.machine.eof:
            data = self.machine.unconsumed_tail or self.packed.read(1 << 20)
            part = self.machine.decompress(data, count)
            if part:
                return part
            if not data and not self.machine.eof:
                raise EOFError
        return b""

    def readinto(self, buffer):
        """Read into a buffer."""
        part = self.read(len(buffer))
        buffer[:len(part)] = part
        return len(part)


def from_stream(stream, dtype, count):
    """Return the next `count` values of a stream of bytes."""
    dtype = np.dtype(dtype)
    if count * dtype.itemsize > 1 << 42:
        raise VolumeError("its header is damaged: it requires %d bytes of voxels"
                          % (count * dtype.itemsize))
    data, filled = np.empty(count, dtype), 0
    view = memoryview(data.view(np.uint8))
    while filled < len(view):
        got = stream.readinto(view[filled:filled + (1 << 24)])
        if not got:
            raise EOFError
        filled += got
    return data
