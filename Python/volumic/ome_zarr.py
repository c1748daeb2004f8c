# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""OME-Zarr images and label maps, version 0.4, and version 0.5 with zarr 3 or later.

    volume = volumic.ome_zarr.open("scan.ome.zarr", level=2)
    cells = volumic.ome_zarr.open("scan.ome.zarr", label="cells")
    volumic.labels(cells[:64], spacing=cells.spacing, origin=cells.origin)

Paths are folders or fsspec URLs (https://, s3://). Requires zarr (Debian: python3-zarr).
"""

from __future__ import annotations

import io
import itertools
import os
import re
import warnings
from collections.abc import Sequence
from typing import Any

import numpy as np

from .reading.volume import METERS, unit_of


class Volume:
    """Three axes z, y, x of a Zarr array. Slices are read on demand.

    Attributes
    ----------
    shape, chunks : tuple of 3 ints
        z, y, x.
    dtype : numpy.dtype
    spacing, origin : tuple of 3 floats
        x, y, z, from the coordinateTransformations; `origin` is the centre of voxel 0.
    unit : str
        Unit of length, common to all axes; empty if the file states none.
    nanometers : float
        Length of a unit in nanometers; 1 if the unit is missing or unknown.
    others : dict
        Size of each other axis, such as "t" and "c".
    """

    def __init__(self, array: Any, indices: Sequence[int | None], order: Sequence[int],
                 others: dict[str, int] | None = None, folder: str = "") -> None:
        self.array = array
        self.indices = tuple(indices)  # for each axis of the array; None: z, y or x
        self.order = tuple(order)  # array axes of z, y and x
        self.shape = tuple(array.shape[axis] for axis in order)
        self.chunks = tuple(array.chunks[axis] for axis in order)
        self.dtype = array.dtype
        self.spacing = self.origin = (1.0, 1.0, 1.0)
        self.unit, self.nanometers, self.others, self.folder = "", 1.0, others or {}, folder

    def __getitem__(self, key: Any) -> Any:
        keys = list(key) if isinstance(key, tuple) else [key]
        for at in [at for at, index in enumerate(keys) if index is Ellipsis][:1]:
            keys[at:at + 1] = [slice(None)] * (4 - len(keys))
        keys += [slice(None)] * (3 - len(keys))
        if len(keys) > 3 or not all(isinstance(index, (int, np.integer, slice))
                                    and not isinstance(index, bool) for index in keys):
            raise IndexError(f"{key} is no index of z, y, x; use integers, slices and one ellipsis")
        picks = list(self.indices)
        for axis, index in zip(self.order, keys):
            picks[axis] = index
        kept = [axis for axis, index in zip(self.order, keys) if isinstance(index, slice)]
        return np.transpose(self.array[tuple(picks)], [sorted(kept).index(axis) for axis in kept])

    def __array__(self, dtype: Any = None, copy: Any = None) -> Any:
        whole = self[:]
        return whole if dtype is None else whole.astype(dtype)

    def missing_chunks(self) -> tuple[int, int]:
        """Return the numbers of missing chunk files, whose voxels zarr reads as the fill value, and
        of all chunks; (0, 0) if the array is not a local folder. Raise ValueError if a file is
        truncated, which Blosc does not detect."""
        shards = getattr(self.array, "shards", None)
        needed = set(itertools.product(*(
            range(-(-length // size)) if index is None else [index // size] for length, size, index
            in zip(self.array.shape, shards or self.array.chunks, self.indices))))
        files = {tuple(map(int, re.findall(r"\d+", os.path.relpath(path, self.folder)))): path
                 for folder, _, names in os.walk(self.folder)
                 for path in (os.path.join(folder, name) for name in names)}
        name = "compressors" if hasattr(self.array, "compressors") else "compressor"  # in zarr 2
        is_blosc = "blosc" in repr(getattr(self.array, name)).lower() and not shards
        for path in [files[key] for key in needed & files.keys() if is_blosc]:
            with io.open(path, "rb") as file:
                if int.from_bytes(file.read(16)[12:], "little") > os.path.getsize(path):
                    raise ValueError(f"{path} is truncated; copy the file again")
        return (len(needed - files.keys()), len(needed)) if os.path.isdir(self.folder) else (0, 0)


# pylint: disable-next=redefined-builtin
def open(path: str, level: int = 0, *, label: str | None = None, time: int = 0,
         channel: int = 0) -> Volume:
    """Return a level of an image, or of one of its label maps.

    Parameters
    ----------
    path : str
        The group with the `multiscales`.
    level : int, optional
        Resolution level; 0 is the finest.
    label : str, optional
        Name of a label map of the image, see `label_names`.
    time, channel : int, optional
        Indices along these axes; 0 if the array lacks the axis.

    Returns
    -------
    Volume

    Raises
    ------
    ValueError
        There is no such image. The message lists the content of the group.
    ImportError
        zarr is not installed.
    """
    if label is not None:
        known = label_names(path)
        if label not in known:
            names = ", ".join(known) or "none"
            raise ValueError(f"{path} has no label map {label}; it has {names}")
        path = f"{path.rstrip('/')}/labels/{label}"
    group = _group(path)
    attributes = _attributes(group)
    scales = attributes.get("multiscales")
    if not scales:
        there = attributes.get("labels") or sorted(name for name, _ in group.groups())
        raise ValueError(f"{path}: not an OME-Zarr image, as it has no multiscales"
                         + (f"; append one of {', '.join(there)} to the path" if there else ""))
    datasets = scales[0]["datasets"]
    if not 0 <= level < len(datasets):
        raise ValueError(f"{path} has no level {level}; it has 0 to {len(datasets) - 1}")
    array = group[datasets[level]["path"]]
    axes = [axis if isinstance(axis, dict) else {"name": axis}
            for axis in scales[0].get("axes", "tczyx"[-len(array.shape):])]
    names = [axis["name"] for axis in axes]
    if not {*"zyx"} <= {*names} or not len({*names}) == len(names) == len(array.shape):
        raise ValueError(f"{path} has the axes {', '.join(names)} for {len(array.shape)} "
                         "dimensions; it must have z, y and x")
    sizes = {name: size for name, size in zip(names, array.shape) if name not in tuple("zyx")}
    chosen = {"t": time, "c": channel}
    for name, index in chosen.items():
        if not 0 <= index < sizes.get(name, 1):
            raise ValueError(f"{path} has no index {index} along {name}; it has "
                             + (f"0 to {sizes[name] - 1}" if name in sizes else "no such axis"))
    for name in [name for name in sizes if name not in chosen and sizes[name] > 1]:
        raise ValueError(f"{path} has {sizes[name]} images along the unsupported axis {name}; "
                         "copy one of them to a separate image")
    indices = [chosen.get(name, 0) if name in sizes else None for name in names]
    volume = Volume(array, indices, [names.index(name) for name in "zyx"], sizes,
                    os.path.join(path, str(datasets[level]["path"])))
    _set_coordinates(volume, path, [datasets[level], scales[0]],
                     [str(axes[axis].get("unit") or "") for axis in volume.order[::-1]])
    return volume


def _set_coordinates(volume: Volume, path: str, sources: list[Any], units: list[str]) -> None:
    """Set spacing, origin and unit, that of x. `units` are those of x, y and z."""
    count = len(volume.indices)
    scale, translation = np.ones(count), np.zeros(count)
    for step in [s for source in sources for s in source.get("coordinateTransformations", [])]:
        given = [np.asarray(step.get(name, default * np.ones(count)), dtype=float)
                 for name, default in (("scale", 1), ("translation", 0))]
        if step.get("type") not in ("scale", "translation", "identity") or "path" in step or any(
                numbers.shape != (count,) or not np.isfinite(numbers).all() for numbers in given):
            raise ValueError(f"{path}: the transformation {step} is not supported; use scale or "
                             f"translation with {count} numbers")
        scale, translation = scale * given[0], translation * given[0] + given[1]
    lengths = [round(1e9 * METERS.get(unit_of(unit), 0.0), 6) for unit in units]  # in nanometers
    if 0.0 in lengths and len(set(units)) > 1:
        raise ValueError(f"{path}: the units of the axes cannot be converted: {', '.join(units)}")
    factors = [length / lengths[0] if lengths[0] else 1.0 for length in lengths]
    volume.spacing, volume.origin = (tuple(float(values[axis] * factor) for axis, factor in zip(
        volume.order[::-1], factors)) for values in (scale, translation))
    volume.unit, volume.nanometers = units[0], lengths[0] or 1.0
    if units[0] and not lengths[0]:
        warnings.warn(f"{path}: the unit '{units[0]}' is unknown; lengths have no unit",
                      stacklevel=3)


def label_names(path: str) -> list[str]:
    """Return the names of the label maps of an image."""
    try:
        return list(_attributes(_group(f"{path.rstrip('/')}/labels")).get("labels", []))
    except ValueError:
        return []


def _group(path: str) -> Any:
    try:
        import zarr  # pylint: disable=import-outside-toplevel
    except ImportError as error:
        raise ImportError("zarr is missing; install it to read OME-Zarr (Debian: python3-zarr)"
                          ) from error
    errors = zarr.errors
    missing = (FileNotFoundError, *(getattr(errors, name) for name in (
        "GroupNotFoundError", "ContainsArrayError", "NodeTypeValidationError")
        if hasattr(errors, name)))  # of zarr 2 and 3
    try:
        return zarr.open_group(path, mode="r")
    except missing as error:
        try:
            zarr.open_array(path, mode="r")
        except Exception:  # pylint: disable=broad-except
            new = os.path.exists(os.path.join(path, "zarr.json")) and zarr.__version__ < "3"
            raise ValueError(f"{path}: not a Zarr group" + (
                " 2; install zarr 3 to read Zarr 3" if new else "")) from error
        raise ValueError(f"{path} is the array of a level; open the group that contains it, "
                         f"{os.path.dirname(path.rstrip('/'))}") from error


def _attributes(group: Any) -> dict[str, Any]:
    attributes = dict(group.attrs)
    return attributes.get("ome", attributes)
