# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Volumes and label maps in OME-Zarr, version 0.4 and, where zarr is 3 or later, 0.5.

    volume = volumic.ome_zarr.open("scan.ome.zarr", level=2)
    cells = volumic.ome_zarr.open("scan.ome.zarr", label="cells")
    volumic.surface(cells[:64], spacing=cells.spacing, origin=cells.origin, iso=0.5)

Paths are folders, or what fsspec opens: https://, s3://. Needs zarr (Debian: python3-zarr).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

NANOMETERS = {"angstrom": 0.1, "nanometer": 1.0, "micrometer": 1e3, "millimeter": 1e6,
              "centimeter": 1e7, "meter": 1e9}


class Volume:
    """Three axes, z, y and x, of an array, of which slices are read when they are asked for.

    Attributes
    ----------
    shape, chunks : tuple of 3 ints
        z, y, x.
    dtype : numpy.dtype
    spacing, origin : tuple of 3 floats
        x, y, z: by the coordinateTransformations; the centre of voxel 0 is at the origin.
    unit : str
        Of these lengths, of all axes alike; empty: not told.
    nanometers : float
        What one of them is in nanometers; 1 where that is not told.
    """

    def __init__(self, array: Any, place: Sequence[int | None], spacing: Sequence[float],
                 origin: Sequence[float], unit: str) -> None:
        self.array = array
        self.place = tuple(place)  # of each axis of the array: an index, None of z, y and x
        kept = [axis for axis, index in enumerate(self.place) if index is None]
        self.shape = tuple(array.shape[axis] for axis in kept)
        self.chunks = tuple(array.chunks[axis] for axis in kept)
        self.dtype = array.dtype
        self.spacing = tuple(spacing)
        self.origin = tuple(origin)
        self.unit = unit
        self.nanometers = NANOMETERS.get(unit, 1.0)

    def __getitem__(self, key: Any) -> Any:
        keys = list(key) if isinstance(key, tuple) else [key]
        keys += [slice(None)] * (3 - len(keys))
        return self.array[tuple(keys.pop(0) if index is None else index for index in self.place)]

    def __array__(self, dtype: Any = None, copy: Any = None) -> Any:
        whole = self[:]
        return whole if dtype is None else whole.astype(dtype)


def open(path: str, level: int = 0, *, label: str | None = None, time: int = 0,  # pylint: disable=redefined-builtin
         channel: int = 0) -> Volume:
    """A level of the image in a group, or of one of its label maps.

    Parameters
    ----------
    path : str
        Of the group that has the `multiscales`.
    level : int, optional
        0 is the finest.
    label : str, optional
        A label map of the image, see `label_names`.
    time, channel : int, optional
        Where the array has such axes.

    Raises
    ------
    ValueError
        Where there is no such image; it tells what there is.
    """
    if label is not None:
        known = label_names(path)
        if label not in known:
            raise ValueError(f"{path} has no labels {label}; it has {', '.join(known) or 'none'}")
        path = f"{path.rstrip('/')}/labels/{label}"
    group = _group(path)
    attributes = _attributes(group)
    scales = attributes.get("multiscales")
    if not scales:
        raise ValueError(f"{path}: no OME-Zarr image, there are no multiscales"
                         + (f"; labels: {', '.join(attributes['labels'])}"
                            if "labels" in attributes else ""))
    datasets = scales[0]["datasets"]
    if not 0 <= level < len(datasets):
        raise ValueError(f"{path} has no level {level}; it has 0 to {len(datasets) - 1}")
    array = group[datasets[level]["path"]]
    axes = [axis if isinstance(axis, dict) else {"name": axis}
            for axis in scales[0].get("axes", "tczyx"[-len(array.shape):])]
    names = [axis["name"] for axis in axes]
    if names[-3:] != ["z", "y", "x"] or len(names) != len(array.shape):
        raise ValueError(f"{path} has the axes {', '.join(names)} for {len(array.shape)} dimensions; "
                         "the last three must be z, y and x")
    scale, translation = [1.0] * len(names), [0.0] * len(names)
    for steps in (datasets[level], scales[0]):
        for step in steps.get("coordinateTransformations", []):
            if step.get("type") not in ("scale", "translation", "identity") or "path" in step:
                raise ValueError(f"{path}: no coordinates are known of the transformation {step}")
            factors = step.get("scale", [1.0] * len(names))
            scale = [a * b for a, b in zip(scale, factors)]
            translation = [a * b + c for a, b, c in zip(
                translation, factors, step.get("translation", [0.0] * len(names)))]
    units = {axis.get("unit", "") for axis in axes[-3:]}
    if len(units) > 1:
        raise ValueError(f"{path}: the axes have different units, {', '.join(sorted(units))}")
    others = {"t": time, "c": channel}
    place = [others.get(name, 0) for name in names[:-3]] + [None] * 3
    for name, index, size in zip(names, place, array.shape):
        if index is not None and not 0 <= index < size:
            raise ValueError(f"{path} has no index {index} along {name}; it has 0 to {size - 1}")
    return Volume(array, place, scale[:-4:-1], translation[:-4:-1], units.pop())


def label_names(path: str) -> list[str]:
    """Of the label maps of the image in a group, for `open`."""
    try:
        group = _group(f"{path.rstrip('/')}/labels")
    except ValueError:
        return []
    return list(_attributes(group).get("labels", []))


def _group(path: str) -> Any:
    try:
        import zarr  # pylint: disable=import-outside-toplevel
    except ImportError as error:
        raise ImportError("OME-Zarr is read by zarr, which is missing (Debian: python3-zarr)"
                          ) from error
    missing: Any = getattr(zarr.errors, "GroupNotFoundError", FileNotFoundError)  # zarr 2's
    try:
        return zarr.open_group(path, mode="r")
    except (FileNotFoundError, missing) as error:
        raise ValueError(f"{path}: there is no group of Zarr") from error


def _attributes(group: Any) -> dict[str, Any]:
    attributes = dict(group.attrs)
    return attributes.get("ome", attributes)
