# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The volume of the command as vtkImageData: coordinate system, unit, cropping, resampling, and
sampling of other volumes (--probe)."""

from __future__ import annotations

import dataclasses
import math
import os
from argparse import Namespace
from collections.abc import Iterable
from typing import Any

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkStringArray

from . import reading
from .arrays import make_image
from .errors import Failure, VolumeError
from .messages import Console, number_text
from .option_tables import Filters
from .options import has_property, needs_surface
from .reading.volume import METERS, Volume
from .vtkFiltersVolumic import vtkVolumeToSurface
from .writing.meshers import DistinctNames
from .writing.regions import points_of

MINIMUM_SIZE = 8       # voxels along an axis, required by a pyramid level
MAXIMUM_VOXELS = 1e11  # of a resampled image

# ---- Field data --------------------------------------------------------------------------------

def set_field_text(data: Any, name: str, text: str) -> None:
    """Set a string of the field data. An empty text removes it."""
    data.GetFieldData().RemoveArray(name)
    if text:
        array = vtkStringArray()
        array.SetName(name)
        array.InsertNextValue(text)
        data.GetFieldData().AddArray(array)


def field_text(data: Any, name: str) -> str:
    """Return a string of the field data; empty if there is none."""
    array = data.GetFieldData().GetAbstractArray(name)
    return array.GetValue(0) if array and array.GetNumberOfValues() > 0 else ""


def mark_space(data: Any, world: World | Volume) -> None:
    """Set the field data `SPACE`, read by 3D Slicer, and `LengthUnit` of a surface or blocks."""
    if data.IsA("vtkMultiBlockDataSet"):
        for block in filter(None, map(data.GetBlock, range(data.GetNumberOfBlocks()))):
            mark_space(block, world)
        return
    set_field_text(data, "SPACE", world.space)
    set_field_text(data, "LengthUnit", world.unit)


# ---- Space and unit ----------------------------------------------------------------------------

@dataclasses.dataclass
class World:
    """Coordinate system and unit of the outputs and of the file."""
    space: str = ""
    unit: str = ""
    scale: float = 1.0  # factor applied to lengths of the file
    file_space: str = ""
    file_unit: str = ""

    def text(self) -> str:
        """Return text such as "; space RAS, unit mm (of the file: um)"; empty if all is unknown."""
        parts = [(f"{what} {now}" if now else "")
                 + (f" (of the file: {file})" if file not in ("", now) else "")
                 for what, now, file in (("space", self.space, self.file_space),
                                         ("unit", self.unit, self.file_unit))]
        if self.scale != 1:
            parts.append(f"lengths of the file times {number_text(self.scale)}")
        text = ", ".join(filter(None, parts))
        return "; " + text if text else ""


def _axes(space: str) -> np.ndarray:
    """Return the axes of a space such as RAS as rows, in LPS."""
    return np.array([np.eye(3)[i // 2] * (1 - i % 2 * 2) for i in map("LRPASI".index, space)])


def convert_to_world(volume: Volume, options: Namespace) -> World:
    """Transform a volume in place to the coordinate system and unit of the options. Raise Failure
    if the file does not state its own."""
    if options.unit and not volume.unit:
        raise Failure(f"--unit {options.unit}: the file does not state its unit; use --scale "
                      "instead, such as --scale 0.001 from millimetres to metres")
    converts_axes = options.space not in (None, "as-file")
    if converts_axes and not volume.space:
        raise Failure(f"--space {options.space}: the file does not state its coordinate system; "
                      "remove --space")
    scale = _factor(volume.unit, options.unit) if options.unit else options.scale or 1.0
    world = World(options.space if converts_axes else volume.space, next((
        name for name in METERS if volume.unit and _factor(volume.unit, name) == scale), ""),
                  scale, volume.space, volume.unit)
    volume.spacing = tuple(length * scale for length in volume.spacing)
    volume.origin = tuple(length * scale for length in volume.origin)
    if converts_axes:
        rotation = _axes(world.space) @ _axes(volume.space).T
        volume.direction = rotation @ volume.direction + 0.0  # no -0
        volume.origin = tuple((rotation @ volume.origin + 0.0).tolist())
    volume.space, volume.unit = world.space, world.unit
    return world


def _factor(one: str, other: str) -> float:
    """Return the exact ratio of two units, a power of ten."""
    return float(f"1e{round(math.log10(METERS[one] / METERS[other]))}")


# ---- The volume --------------------------------------------------------------------------------

@dataclasses.dataclass
class LoadedVolume:
    image: Any            # vtkImageData with field data; one component unless labels
    volume: Volume        # all components
    world: World
    component: int | None  # selected one of several; -1: magnitude
    range: tuple[float, float]
    text: str             # dimensions, spacing and type


def image_of(volume: Volume, array: np.ndarray) -> Any:
    """Return a vtkImageData of an array [z, y, x] or [component, z, y, x], located as `volume`."""
    image = make_image(array if array.ndim == 3 else np.moveaxis(array, 0, -1), volume.spacing,
                       volume.origin, volume.direction, volume.start, volume.name or "Voxels")
    for name, text in (("Axes", volume.space), ("LengthUnit", volume.unit),
                       ("Resampling", volume.resampling)):
        set_field_text(image, name, text)
    return image


def read(path: str, console: Console, **choice: Any) -> Volume:
    volume = reading.read(path, **choice)
    for text in volume.warnings:
        console.warn(f"{path}: {text}")
    return volume


def load_volume(options: Namespace, filters: Filters, console: Console,
                announce: bool = True) -> LoadedVolume:
    """Read the volume, transform, crop and resample it as requested, and print its properties."""
    path = options.volume
    component = (filters.surface.GetSelectedComponent()
                 if has_property(options, "SelectedComponent") else None)
    volume = read(path, console, **vars(options.choice))
    try:
        world = convert_to_world(volume, options)
        crop(volume, options)
        is_whole = options.labels or (component is None and not needs_surface(options))
        part = dataclasses.replace(
            volume, array=volume.array if is_whole else volume.scalars(component))
        resample(part, options, console)
        image = image_of(part, part.array)
    except Failure as error:
        raise VolumeError(f"{path}: {error}") from None
    count = 1 if volume.array.ndim == 3 else len(volume.array)
    selected = None if count == 1 else -1 if component is None else component
    scalars = image.GetPointData().GetScalars()
    minimum, maximum = scalars.GetRange(0 if scalars.GetNumberOfComponents() == 1 else -1)
    text = f"{describe(part)}, {image.GetScalarTypeAsString()}"
    if announce:
        what = "magnitude" if selected == -1 else f"component {selected}"
        console.info(f"{path}: {text}" + (f", {what} of {count} components (--component)"
                                          if count > 1 else "")
                     + f", {number_text(minimum)} to {number_text(maximum)}{world.text()}")
    return LoadedVolume(image, volume, world, selected, (minimum, maximum), text)


def describe(volume: Volume) -> str:
    """Return a text such as "64 x 64 x 32 voxels of 0.5 x 0.5 x 1"."""
    return (" x ".join(map(str, volume.array.shape[:-4:-1])) + " voxels of "
            + " x ".join(number_text(round(length, 6)) for length in volume.spacing))


def crop(volume: Volume, options: Namespace) -> None:
    """Crop a volume in place to --region or --region-box, without a copy of its voxels."""
    sizes, start = np.array(volume.array.shape[:-4:-1]), np.array(volume.start)
    if options.region:
        limits = np.reshape(options.region, (3, 2)).T
    elif options.region_box:
        corners = np.stack(np.meshgrid(*np.reshape(options.region_box, (3, 2))), -1).reshape(-1, 3)
        # The origin is the position of index 0, also if the extent starts elsewhere.
        indices = (corners - volume.origin) @ volume.direction / volume.spacing
        limits = np.clip([np.floor(indices.min(0) + 1e-6), np.ceil(indices.max(0) - 1e-6)],
                         -1e9, 1e9).astype(int)
    else:
        return
    first, last = np.maximum(limits[0], start), np.minimum(limits[1], start + sizes - 1)
    for axis in np.flatnonzero(first > last):
        raise VolumeError(f"the region is outside the volume, whose index {'ijk'[axis]} ranges "
                          f"from {start[axis]} to {start[axis] + sizes[axis] - 1}")
    x, y, z = map(slice, (first - start).tolist(), (last - start + 1).tolist())
    volume.array, volume.start = volume.array[..., z, y, x], tuple(first.tolist())


def resample(volume: Volume, options: Namespace, console: Console) -> None:
    """Resample a volume in place to --resample, --isotropic or, for a surface, at least 8 voxels
    along each axis, linearly or, for labels, by nearest neighbour. Its bounds do not change."""
    from vtkmodules.vtkImagingCore import vtkImageReslice
    before, sizes = np.array(volume.spacing), np.array(volume.array.shape[:-4:-1])
    after = np.array(options.resample or before, float)
    if options.isotropic:
        after[:] = before.min()
    if not (options.resample or options.labels or options.edges) and needs_surface(options) \
            and options.choice.resampling:
        thin = (sizes > 1) & (np.maximum(sizes, np.rint(sizes * before / after)) < MINIMUM_SIZE)
        after[thin] = (sizes * before / MINIMUM_SIZE)[thin]
    if (after == before).all():
        return
    count = np.prod(np.maximum(1.0, sizes * before / after))
    if not count < MAXIMUM_VOXELS:
        raise VolumeError(f"resampling yields {count:.0f} voxels; increase the voxel spacing")
    text = f"resampled from {describe(volume)}"
    if not options.resample and not options.isotropic:
        text += ": a surface requires 8 voxels along each axis"
    new_sizes = np.maximum(1, np.floor(sizes * before / after + 0.5)).astype(int)
    first = 0.5 * ((sizes - 1) - (new_sizes - 1) * after / before)  # index of the first voxel
    is_plain, reslice = volume.array.ndim == 3, vtkImageReslice()
    reslice.SetInputData(make_image(
        volume.array if is_plain else np.moveaxis(volume.array, 0, -1), before, (0, 0, 0), None))
    reslice.SetOutputSpacing(after.tolist())
    reslice.SetOutputOrigin((first * before).tolist())
    reslice.SetOutputExtent([int(n) for size in new_sizes for n in (0, size - 1)])
    reslice.BorderOn()  # extrapolates to the faces of the outer voxels
    if not options.labels:
        reslice.SetInterpolationModeToLinear()
        reslice.SetOutputScalarType(11 if volume.array.dtype == float else 10)  # double, float
    reslice.Update()
    values = vtk_to_numpy(reslice.GetOutput().GetPointData().GetScalars())
    values = values.reshape(*new_sizes[::-1], -1)
    volume.array = values[..., 0] if is_plain else np.moveaxis(values, -1, 0)
    volume.origin = tuple(volume.origin + volume.direction @ (before * (volume.start + first)))
    volume.spacing, volume.start = tuple(after.tolist()), (0, 0, 0)
    volume.resampling = "; ".join(filter(None, (volume.resampling, text)))
    console.info(f"{options.volume}: {text}")


# ---- Values of other volumes -------------------------------------------------------------------

class Probes:
    """The volumes of --probe, in the coordinate system and unit of the outputs.

    Values are interpolated linearly, and NaN outside. For label maps (with label names, or few
    integer values with steps between neighbours) they are the nearest label, and 0 outside.
    """

    def __init__(self, options: Namespace, world: World, console: Console) -> None:
        self.depth, self.console = options.probe_depth, console
        self.volumes: list[tuple[str, str, Volume, bool]] = []
        names = DistinctNames("-", lambda name: name[:max(name.find("."), 1)]
                              if "." in name else name)
        for path in options.probe:
            volume = read(path, console)
            _convert(path, volume, world, console)
            is_label_map = bool(volume.labels) or (
                volume.array.ndim == 3 and volume.array.dtype.kind in "ui"
                and bool(vtkVolumeToSurface.HintAtLabels(image_of(volume, volume.array))))
            self.volumes.append((names.take(os.path.basename(os.path.normpath(path))), path, volume,
                                 is_label_map))

    def __bool__(self) -> bool:
        return bool(self.volumes)

    def __call__(self, points: np.ndarray) -> dict[str, np.ndarray]:
        """Return the values at points (n x 3): n or n x components for each name."""
        return {name: _values(volume, points, labels)[0]
                for name, _, volume, labels in self.volumes}

    def add_to(self, *surfaces: Any) -> None:
        """Add point arrays with the values to surfaces. Warn of points outside."""
        for name, path, volume, labels in self.volumes:
            outside, count = 0, 0
            for surface in surfaces:
                if surface is None or surface.GetNumberOfPoints() == 0:
                    continue
                points = points_of(surface).astype(float)
                normals = surface.GetPointData().GetNormals()
                values, is_outside = _values(volume, points, labels)
                if self.depth and normals is not None and not labels:
                    steps = math.ceil(self.depth / (0.5 * min(volume.spacing)))
                    inward = vtk_to_numpy(normals).astype(float) * (-self.depth / steps)
                    values = _mean(_values(volume, points + i * inward, labels)[0]
                                   for i in range(steps + 1))
                outside, count = outside + int(is_outside.sum()), count + len(points)
                array = numpy_to_vtk(np.ascontiguousarray(values), deep=True)
                array.SetName(name)
                surface.GetPointData().AddArray(array)
            if outside:
                self.console.warn(f"{path}: {outside} of {count} vertices are outside this volume "
                                  "and get " + ("label 0" if labels else "the value NaN"))


def _mean(parts: Iterable[np.ndarray]) -> np.ndarray:
    """Return the mean of arrays, ignoring NaN."""
    sums, counts = 0.0, 0
    for values in parts:
        known = ~np.isnan(values)
        sums, counts = sums + np.where(known, values, 0), counts + known
    with np.errstate(invalid="ignore"):
        return sums / np.where(counts > 0, counts, np.nan)


def _values(volume: Volume, points: np.ndarray, labels: bool) -> tuple[np.ndarray, np.ndarray]:
    """Return the values at points, and whether the points are outside the volume."""
    from scipy import ndimage
    indices = ((points - volume.origin) @ volume.direction) / volume.spacing - volume.start
    indices, sizes = indices[:, ::-1], np.array(volume.array.shape[-3:])
    outside = ((indices < -0.5 - 1e-9) | (indices > sizes - 0.5 + 1e-9)).any(axis=1)
    parts = volume.array.reshape(-1, *sizes)
    values = np.stack([ndimage.map_coordinates(
        part, indices.T, part.dtype if labels else np.float64, order=0 if labels else 1,
        mode="nearest") for part in parts], -1)
    values[outside] = 0 if labels else np.nan
    return (values[:, 0] if len(parts) == 1 else values), outside


def _convert(path: str, volume: Volume, world: World, console: Console) -> None:
    """Transform a volume in place to the coordinate system and unit of `world`."""
    options = Namespace(unit=None, scale=None, space=None)
    for what in ("unit", "space"):
        own, other = getattr(volume, what), getattr(world, what)
        if own and other:
            setattr(options, what, other)
        elif own != other or (what == "unit" and world.scale != 1):
            console.warn(f"{path}: the {what} of the volume is {own or 'unknown'}, the {what} of "
                         f"the surface is {other or 'unknown'}; coordinates are not converted")
    convert_to_world(volume, options)
