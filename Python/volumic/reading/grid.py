# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Positions of voxels, resampling to regular grids, and checked reading of voxels from files."""
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


def make_volume(array, steps, origin, space, unit, choice, **more):
    """Return the Volume with voxel (i, j, k) at origin + steps @ (i, j, k), resampled if the
    columns of `steps` are not orthogonal."""
    steps, origin = np.array(steps, float), np.asarray(origin, float)
    for axis in range(3):
        if not (np.isfinite(steps[:, axis]).all() and np.abs(steps[:, axis]).max() > 0):
            if not choice.spacing:
                raise VolumeError("the voxel spacing along axis %d is not positive and finite; "
                                  "set --spacing X,Y,Z" % axis)
            steps[:, axis] = np.eye(3)[axis]
    spacing = np.sqrt((steps ** 2).sum(0))
    axes = steps / spacing
    products = [abs(axes[:, a] @ axes[:, (a + 1) % 3]) for a in range(3)]
    if max(products) > 1e-3:
        if abs(np.linalg.det(axes)) < .1 or array.shape[-3] < 2:
            raise VolumeError("the voxel axes are not orthogonal; correct the header")
        if not np.isfinite(origin).all():
            raise VolumeError("the origin %s is not finite; correct the header" % text_of(origin))
        positions = origin + np.arange(array.shape[-3])[:, None] * steps[:, 2]
        angle = np.degrees(np.arcsin(min(1, max(products))))
        why = "the voxel axes are up to %.15g degrees off orthogonal" % np.round(angle, 3)
        volume = on_regular_grid(array, positions, axes[:, 0], axes[:, 1], spacing[:2], choice, why)
        more["warnings"] = volume.warnings + more.get("warnings", [])
        return dataclasses.replace(volume, space=space, unit=unit, **more)
    return Volume(array, tuple(spacing), tuple(origin), axes, space, unit, **more)


def on_regular_grid(array, positions, across, down, spacing, choice, why, outside=None):
    """Resample slices to the regular grid that contains them, values linearly, labels by nearest
    neighbour. `positions` are those of first pixels, `across` and `down` unit vectors along rows
    and columns, `why` is the reason for the warning. `outside` is the value where there is no slice
    (default: the minimum; 0 for labels)."""
    if not choice.resampling:
        raise VolumeError(why + "; without --no-resampling they are resampled")
    positions, pitch = np.asarray(positions, float), np.array(spacing, float)
    shear = across @ down
    shear = shear if abs(shear) > 1e-3 else 0.
    upright = np.sqrt(1 - shear * shear)
    down = (down - shear * across) / upright
    normal = np.cross(across, down)
    normal *= np.sign(normal @ (positions[-1] - positions[0])) or 1
    heights = (positions - positions[0]) @ normal
    if not (np.diff(heights) > 0).all():
        raise VolumeError("slices are not in order along their normal; correct the header")
    shear *= pitch[1] / pitch[0]
    pitch[1] *= upright
    gaps = np.diff(heights)
    count = np.ceil(heights[-1] / gaps.min() - .05)
    shifts = (positions - positions[0]) @ np.stack([across, down], 1) / pitch
    shear_range = shear * (array.shape[-2] - 1)
    before = np.floor(shifts.min(0) + [min(0, shear_range), 0] + 1e-3)
    wider = np.ceil(shifts.max(0) + [max(0, shear_range), 0] - 1e-3) - before
    size = np.array(array.shape[:-4:-1], float)
    times = (size[0] + wider[0]) * (size[1] + wider[1]) * (count + 1) / size.prod()
    if not times < 16:
        raise VolumeError("%s; a regular grid for slices at distances of %.4g to %.4g requires "
                          "%.0f times as many voxels; remove slices that are too close to or too "
                          "far from others" % (why, gaps.min(), gaps.max(), times))
    shape = (int(count) + 1, array.shape[-2] + int(wider[1]), array.shape[-1] + int(wider[0]))
    if outside is None:
        outside = 0 if choice.labels else array.min()
        outside = outside if np.isfinite(outside) else 0
    result = np.empty(array.shape[:-3] + shape, array.dtype)
    heights_of_grid = heights[-1] * np.arange(shape[0]) / count
    for z, height in enumerate(heights_of_grid):
        upper = int(np.clip(np.searchsorted(heights, height, "right"), 1, len(heights) - 1))
        fraction = (height - heights[upper - 1]) / gaps[upper - 1]
        near = .5 if choice.labels else 1e-3
        fraction = 0. if fraction < near else 1. if fraction > 1 - near else fraction
        values, inside = 0., True
        for number, weight in ((upper - 1, 1 - fraction), (upper, fraction)):
            if weight:
                part, there = _slice_on(shape[1:], array[..., number, :, :],
                                        before - shifts[number], shear, choice.labels)
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


def _slice_on(shape, pixels, shift, shear, are_labels):
    """Return the values of a slice at the pixels of the grid, and where they are defined."""
    from scipy import ndimage
    y, x = np.mgrid[:shape[0], :shape[1]].astype(float)
    y += shift[1]
    x += shift[0] - shear * y
    coordinates, margin = np.stack([y, x]), 1e-6
    if are_labels:
        coordinates, margin = np.trunc(coordinates + np.copysign(.5, coordinates)), 0.
    last = np.array(pixels.shape[-2:])[:, None, None] - 1
    inside = ((coordinates >= -margin) & (coordinates <= last + margin)).all(0)
    values = [ndimage.map_coordinates(plane.astype(float), coordinates,
                                      order=0 if are_labels else 1, mode="nearest")
              for plane in pixels.reshape(-1, *pixels.shape[-2:])]
    return np.stack(values).reshape(pixels.shape[:-2] + tuple(shape)), inside


def one_of_times(count, choice, what="volumes in one file (times, phases or masks)"):
    """Return the index of the requested one of `count` volumes, and store the count in `choice`."""
    choice.times = count
    last = "the file has times 0 to %d" % (count - 1) if count > 1 else "the file has one volume"
    if choice.time is None and count > 1 and not choice.labels:
        raise VolumeError("%d %s; choose one with --time N, 0 to %d" % (count, what, count - 1))
    if not 0 <= (choice.time or 0) < count:
        raise VolumeError("there is no time %d (--time); %s" % (choice.time, last))
    return choice.time or 0


def check_size(have, need, exact=False):
    """Raise VolumeError if a file has too few bytes of voxels or, if `exact`, too many."""
    if have < need or have > need and exact:
        raise VolumeError("the file is %s: it has %d bytes of voxels, but its header requires %d; "
                          "copy it again" % ("truncated" if have < need else "too long",
                                             max(have, 0), need))


def voxels(file, offset, dtype, count, packing=None, skip=0, size=None, exact=False):
    """Return `count` values of a file, memory-mapped unless compressed ("gzip", "zlib", "bz2"). The
    data start at byte `offset`, the values `skip` uncompressed bytes later. `size` is the number of
    all uncompressed bytes (default: up to the last value). With `exact`, more are an error."""
    dtype, count = np.dtype(dtype), int(count)
    size = skip + count * dtype.itemsize if size is None else size
    if not packing:
        check_size(os.path.getsize(file) - offset, size, exact)
        return np.memmap(file, dtype, "r", offset + skip, (count,))
    with open(file, "rb") as stream:
        stream.seek(offset)
        return unpacked(stream, packing, dtype, count, skip, size, exact)


def unpacked(stream, packing, dtype, count, skip=0, size=None, exact=False):
    """Return values of a compressed stream, see voxels(). Checksums are verified."""
    dtype, count = np.dtype(dtype), int(count)
    size = skip + count * dtype.itemsize if size is None else size
    opener = {"bz2": bz2.open, "zlib": _Inflated}.get(packing, gzip.open)
    with opener(stream) as plain:
        remaining = size - _skip(plain, skip) - count * dtype.itemsize
        data = from_stream(plain, dtype, count)
        if _skip(plain, remaining) == remaining and plain.read(1) and exact:
            raise VolumeError("the compressed data exceed the %d bytes that the header requires; "
                              "copy the file again" % size)
        while not exact and plain.read(1 << 20):
            pass
    return data


def _skip(stream, count):
    """Read `count` bytes and return the count."""
    left = count
    while left:
        part = len(stream.read(min(left, 1 << 20)))
        if not part:
            raise EOFError
        left -= part
    return count


class _Inflated(io.BufferedIOBase):
    """The uncompressed bytes of a zlib or gzip stream."""

    def __init__(self, packed):
        self.packed, self.machine = packed, zlib.decompressobj(47)

    def read(self, count=-1):
        """Return up to `count` bytes; none at the end of the stream."""
        while not self.machine.eof:
            data = self.machine.unconsumed_tail or self.packed.read(1 << 20)
            part = self.machine.decompress(data, count)
            if part:
                return part
            if not data and not self.machine.eof:
                raise EOFError
        return b""

    def readinto(self, buffer):
        part = self.read(len(buffer))
        buffer[:len(part)] = part
        return len(part)


def from_stream(stream, dtype, count):
    """Return the next `count` values of a stream."""
    dtype = np.dtype(dtype)
    if count * dtype.itemsize > 1 << 42:
        raise VolumeError("invalid header: it requires %d bytes of voxels"
                          % (count * dtype.itemsize))
    data, filled = np.empty(count, dtype), 0
    view = memoryview(data.view(np.uint8))
    while filled < len(view):
        got = stream.readinto(view[filled:filled + (1 << 24)])
        if not got:
            raise EOFError
        filled += got
    return data
