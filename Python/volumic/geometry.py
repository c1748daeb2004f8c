# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The volume of the command line as an image of VTK: its space and unit, the region that is used,
resampling, and the values of other volumes at points (--probe)."""

from __future__ import annotations

import dataclasses
import math
import os
from argparse import Namespace
from typing import Any

import numpy as np

from . import reading
from .arrays import make_image
from .errors import Failure, VolumeError
from .messages import Teller, number_text
from .option_tables import Filters
from .options import has_property, wants_surface
from .reading.volume import METERS, Volume

LEAST_VOXELS = 8    # along an axis, for a pyramid to have a level
MOST_VOXELS = 1e11  # of a resampled image: more is a mistake

# ---- Field data --------------------------------------------------------------------------------


def set_fact(data: Any, name: str, text: str) -> None:
    """Set a text of the field data; an empty one removes it."""
    from vtkmodules.vtkCommonCore import vtkStringArray
    data.GetFieldData().RemoveArray(name)
    if text:
        array = vtkStringArray()
        array.SetName(name)
        array.InsertNextValue(text)
        data.GetFieldData().AddArray(array)


def fact(data: Any, name: str) -> str:
    """A text of the field data; empty if there is none."""
    array = data.GetFieldData().GetAbstractArray(name)
    return array.GetValue(0) if array and array.GetNumberOfValues() > 0 else ""


def mark_space(data: Any, world: World) -> None:
    """Set the field data `SPACE`, as 3D Slicer reads it, and `LengthUnit` of a surface or of all
    blocks."""
    if data.IsA("vtkMultiBlockDataSet"):
        for i in range(data.GetNumberOfBlocks()):
            if data.GetBlock(i) is not None:
                mark_space(data.GetBlock(i), world)
        return
    set_fact(data, "SPACE", world.space)
    set_fact(data, "LengthUnit", world.unit)


# ---- Space and unit ----------------------------------------------------------------------------

@dataclasses.dataclass
class World:
    """Axes and unit of the world coordinates, and what the file has."""
    space: str = ""
    unit: str = ""
    scale: float = 1.0  # by which lengths of the file were multiplied
    file_space: str = ""
    file_unit: str = ""

    def text(self) -> str:
        """"; space RAS, unit mm (of the file: um)", or nothing where nothing is known."""
        def part(what: str, now: str, file: str) -> str:
            return ((what + now if now else "")
                    + (f" (of the file: {file})" if file not in ("", now) else ""))
        parts = [part("space ", self.space, self.file_space),
                 part("unit ", self.unit, self.file_unit),
                 "" if self.scale == 1 else f"lengths of the file times {number_text(self.scale)}"]
        return "".join("; " + text if i == 0 else ", " + text
                       for i, text in enumerate(filter(None, parts)))


def turn_between(one: str, other: str) -> np.ndarray:
    """The matrix that turns coordinates whose axes point to some sides of the body, such as RAS,
    into those of others."""
    sides = "LRAPSI"  # opposite ones stand side by side
    turn = np.zeros((3, 3))
    for row, wanted in enumerate(other):
        for column, there in enumerate(one):
            if sides.index(wanted) // 2 == sides.index(there) // 2:
                turn[row, column] = 1.0 if wanted == there else -1.0
    return turn


def place_in_world(volume: Volume, options: Namespace) -> World:
    """Put a volume into the space and unit of the options, in place.

    Throw Failure where the file does not state what is needed for that.
    """
    world = World(volume.space, volume.unit, 1.0, volume.space, volume.unit)
    if options.unit:
        if not volume.unit:
            raise Failure(f"--unit {options.unit}: the file does not state its unit; give the "
                          "factor by --scale instead, such as --scale 0.001 for a file in "
                          "millimetres whose surface is to be in metres")
        world.scale = _factor(volume.unit, options.unit)
        volume.unit = world.unit = options.unit
    elif options.scale:
        world.scale = options.scale
        after = [name for name in METERS
                 if volume.unit and _factor(volume.unit, name) == world.scale]
        volume.unit = world.unit = volume.unit if world.scale == 1 else (after or [""])[0]
    volume.spacing = tuple(length * world.scale for length in volume.spacing)
    volume.origin = tuple(length * world.scale for length in volume.origin)
    if options.space not in (None, "as-file"):
        if not volume.space:
            raise Failure(f"--space {options.space}: the file does not state which sides of the "
                          "body its axes point to")
        turn = turn_between(volume.space, options.space)
        volume.direction = turn @ volume.direction + 0.0  # no -0
        volume.origin = tuple((turn @ volume.origin + 0.0).tolist())
        volume.space = world.space = options.space
    return world


def _factor(one: str, other: str) -> float:
    """How many of a unit another one is: a power of ten, exactly."""
    return float(f"1e{round(math.log10(METERS[one] / METERS[other]))}")


# ---- The volume --------------------------------------------------------------------------------

@dataclasses.dataclass
class LoadedVolume:
    """The volume of the command line."""
    image: Any            # vtkImageData of one component, with facts and names as field data
    volume: Volume        # with all its components
    world: World
    component: int | None  # that was taken; None: of one, -1: the magnitude
    range: tuple[float, float] = (math.inf, -math.inf)


def image_of(volume: Volume, array: np.ndarray) -> Any:
    """A vtkImageData of an array [z, y, x] or [component, z, y, x] where the volume is."""
    image = make_image(array if array.ndim == 3 else np.moveaxis(array, 0, -1), volume.spacing,
                       volume.origin, volume.direction, volume.start, volume.name or "Voxels")
    for name, text in (("Axes", volume.space), ("LengthUnit", volume.unit),
                       ("Resampling", volume.resampling)):
        set_fact(image, name, text)
    return image


def read(path: str, teller: Teller, **choice: Any) -> Volume:
    """Read a volume and print its warnings."""
    volume = reading.read(path, tell=lambda text: teller.warn(f"{path}: {text}"), **choice)
    for text in volume.warnings:
        teller.warn(f"{path}: {text}")
    return volume


def load_volume(options: Namespace, filters: Filters, teller: Teller,
                announce: bool = True) -> LoadedVolume:
    """Read the volume, put it into its place, crop and resample it as the options request, and
    print what it is."""
    path = options.volume
    component = (filters.surface.GetSelectedComponent()
                 if has_property(options, "SelectedComponent") else None)
    choice = {field.name: getattr(options.choice, field.name)
              for field in dataclasses.fields(options.choice) if field.name not in ("tell", "times")}
    # Masks that overlap stay whole, in layers, where each has a surface of its own.
    volume = read(path, teller, **{**choice, "spacing": options.spacing})
    try:
        world = place_in_world(volume, options)
        crop(volume, options)
        components = 1 if volume.array.ndim == 3 else len(volume.array)
        if options.labels or (component is None and not wants_surface(options)):
            values = volume.array
        else:
            values = volume.scalars(component)
        image = image_of(volume, values)
        image = resample_as_asked(image, options, bool(options.labels), teller)
    except Failure as error:
        raise VolumeError(f"{path}: {error}") from None
    taken = None if components == 1 else -1 if component is None else component
    loaded = LoadedVolume(image, volume, world, taken)
    scalars = image.GetPointData().GetScalars()
    loaded.range = tuple(scalars.GetRange(0 if scalars.GetNumberOfComponents() == 1 else -1))
    if announce:
        teller.say(f"{path}: {describe(image)}, {image.GetScalarTypeAsString()}"
                   + ("" if components == 1 else ", " + ("magnitude" if taken < 0 else
                      f"component {taken}") + f" of {components} components (--component)")
                   + f", {number_text(loaded.range[0])} to {number_text(loaded.range[1])}"
                   + world.text())
    return loaded


def describe(image: Any) -> str:
    """"64 x 64 x 32 voxels of 0.5 x 0.5 x 1"."""
    return (" x ".join(map(str, image.GetDimensions())) + " voxels of "
            + " x ".join(number_text(round(length, 6)) for length in image.GetSpacing()))


def crop(volume: Volume, options: Namespace) -> None:
    """Leave the voxels of --region or --region-box only, in place: no voxel is copied."""
    sizes = np.array(volume.array.shape[:-4:-1])
    start = np.array(volume.start)
    if options.region:
        wanted = np.reshape(options.region, (3, 2)).T
    elif options.region_box:
        corners = np.stack(np.meshgrid(*np.reshape(options.region_box, (3, 2)), indexing="ij"), -1)
        # The origin is the position of index 0, whatever the index of the first voxel.
        indices = ((corners.reshape(-1, 3) - volume.origin) @ volume.direction) / volume.spacing
        wanted = np.clip([np.floor(indices.min(0) + 1e-6), np.ceil(indices.max(0) - 1e-6)],
                         -1e9, 1e9).astype(int)
    else:
        return
    last = start + sizes - 1
    for axis in range(3):
        if wanted[0, axis] > last[axis] or wanted[1, axis] < start[axis]:
            raise VolumeError(f"the region lies beside the volume, which has voxels "
                              f"{'ijk'[axis]} {start[axis]} to {last[axis]}")
    begin, end = np.maximum(wanted[0], start) - start, np.minimum(wanted[1], last) - start + 1
    x, y, z = (slice(int(a), int(b)) for a, b in zip(begin, end))
    volume.array = volume.array[..., z, y, x]
    volume.start = tuple((start + begin).tolist())


def resample_as_asked(image: Any, options: Namespace, labels: bool, teller: Teller) -> Any:
    """Resample to --resample or --isotropic, or, for a surface, to 8 voxels along thin axes."""
    before, sizes = np.array(image.GetSpacing()), np.array(image.GetDimensions())
    wanted = np.array(options.resample or before, float)
    if options.isotropic:
        wanted[:] = before.min()
    if not options.resample and not labels and wants_surface(options) and not options.edges \
            and options.choice.resampling:
        thin = (sizes > 1) & (sizes < LEAST_VOXELS) & (np.rint(sizes * before / wanted)
                                                        < LEAST_VOXELS)
        wanted[thin] = (sizes * before / LEAST_VOXELS)[thin]
    if (wanted == before).all():
        return image
    count = np.prod(np.maximum(1.0, sizes * before / wanted))
    if not count < MOST_VOXELS:
        raise VolumeError(f"resampled it would have {count:.0f} voxels")
    text = f"resampled from {describe(image)}" + (
        "" if options.resample or options.isotropic else ": a surface needs 8 voxels along each axis")
    image = resampled(image, wanted, labels)
    set_fact(image, "Resampling", "; ".join(filter(None, (fact(image, "Resampling"), text))))
    teller.say(f"{options.volume}: {text}")
    return image


def resampled(image: Any, spacing: np.ndarray, labels: bool) -> Any:
    """The image with other voxel distances that fills the same box: linear, or, for labels, the
    nearest voxel."""
    from vtkmodules.vtkCommonDataModel import vtkImageData
    from vtkmodules.vtkImagingCore import vtkImageReslice
    before, sizes = np.array(image.GetSpacing()), np.array(image.GetDimensions())
    new_sizes = np.maximum(1, np.floor(sizes * before / spacing + 0.5)).astype(int)
    first = 0.5 * ((sizes - 1) * before - (new_sizes - 1) * spacing)
    scalars = image.GetPointData().GetScalars()
    plain = vtkImageData()
    plain.SetDimensions(sizes.tolist())
    plain.SetSpacing(before.tolist())
    plain.GetPointData().SetScalars(scalars)
    reslice = vtkImageReslice()
    reslice.SetInputData(plain)
    reslice.SetOutputSpacing(spacing.tolist())
    reslice.SetOutputOrigin(first.tolist())
    reslice.SetOutputExtent([int(n) for size in new_sizes for n in (0, size - 1)])
    reslice.BorderOn()  # values reach out to the faces of the outer voxels
    if labels:
        reslice.SetInterpolationModeToNearestNeighbor()
    else:
        reslice.SetInterpolationModeToLinear()
        reslice.SetOutputScalarType(11 if image.GetScalarType() == 11 else 10)  # double, float
    reslice.Update()
    made = vtkImageData()
    made.ShallowCopy(reslice.GetOutput())
    made.GetPointData().GetScalars().SetName(scalars.GetName())
    origin = [0.0] * 3
    image.TransformContinuousIndexToPhysicalPoint(
        (np.array(image.GetExtent()[::2]) + first / before).tolist(), origin)
    made.SetOrigin(origin)
    made.SetDirectionMatrix(image.GetDirectionMatrix())
    made.GetFieldData().ShallowCopy(image.GetFieldData())
    return made


# ---- Values of other volumes -------------------------------------------------------------------

class Probes:
    """The volumes of --probe, in the space and unit of what is written.

    Values are interpolated linearly, NaN outside. A label map (it has names, or few values of
    whole numbers with steps between neighbours) gives the label of the nearest voxel, 0 outside.
    """

    def __init__(self, options: Namespace, world: World, teller: Teller) -> None:
        self.depth, self.teller = options.probe_depth, teller
        self.volumes: list[tuple[str, str, Volume, bool]] = []
        taken: set[str] = set()
        for path in options.probe:
            volume = read(path, teller)
            _convert(path, volume, world, teller)
            name = os.path.basename(os.path.normpath(path))
            name = free = name[:max(name.find("."), 1)] if "." in name else name
            number = 2
            while free.lower() in taken:
                free, number = f"{name}-{number}", number + 1
            taken.add(free.lower())
            self.volumes.append((free, path, volume, _is_label_map(volume)))

    def __bool__(self) -> bool:
        return bool(self.volumes)

    def __call__(self, points: np.ndarray) -> dict[str, np.ndarray]:
        """{name: values, n or n x components} at points, n x 3."""
        return {name: self._values(volume, points, labels)
                for name, _, volume, labels in self.volumes}

    def add_to(self, *surfaces: Any) -> None:
        """Give the points of surfaces the values, and report how many points lie outside."""
        from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
        for name, path, volume, labels in self.volumes:
            outside, count = 0, 0
            for surface in surfaces:
                if surface is None or surface.GetNumberOfPoints() == 0:
                    continue
                points = vtk_to_numpy(surface.GetPoints().GetData()).astype(float)
                normals = surface.GetPointData().GetNormals()
                inward = vtk_to_numpy(normals).astype(float) * -self.depth if normals else None
                values = self._mean(volume, points, inward, labels)
                outside += int(self._fraction(volume, points)[1].sum())
                count += len(points)
                array = numpy_to_vtk(np.ascontiguousarray(values), deep=True)
                array.SetName(name)
                surface.GetPointData().AddArray(array)
            if outside:
                self.teller.warn(f"{path}: {outside} of {count} vertices lie outside this volume; "
                                 "they have " + ("label 0" if labels else "the value NaN"))

    def _mean(self, volume: Volume, points: np.ndarray, inward: np.ndarray | None,
              labels: bool) -> np.ndarray:
        if not self.depth or inward is None or labels:
            return self._values(volume, points, labels)
        steps = math.ceil(self.depth / (0.5 * min(volume.spacing)))
        sums, counts = 0.0, 0
        for i in range(steps + 1):
            values = self._values(volume, points + inward * (i / steps), False)
            known = ~np.isnan(values)
            sums, counts = sums + np.where(known, values, 0), counts + known
        with np.errstate(invalid="ignore"):
            return sums / np.where(counts > 0, counts, np.nan)

    @staticmethod
    def _fraction(volume: Volume, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Indices z, y, x of points, as 3 x n, and whether they are outside the voxels' faces."""
        indices = ((points - volume.origin) @ volume.direction) / volume.spacing - volume.start
        indices = indices[:, ::-1].T
        sizes = np.array(volume.array.shape[-3:])[:, None]
        outside = ((indices < -0.5 - 1e-9) | (indices > sizes - 0.5 + 1e-9)).any(axis=0)
        return indices, outside

    def _values(self, volume: Volume, points: np.ndarray, labels: bool) -> np.ndarray:
        from scipy import ndimage
        indices, outside = self._fraction(volume, points)
        sizes = np.array(volume.array.shape[-3:])[:, None]
        indices = np.clip(indices, 0, sizes - 1)
        parts = volume.array[None] if volume.array.ndim == 3 else volume.array
        if labels:
            near = tuple(np.rint(indices).astype(int))
            values = np.stack([np.where(outside, 0, part[near]) for part in parts], -1)
        else:
            values = np.stack([ndimage.map_coordinates(
                part, indices, np.float64, order=1, mode="nearest") for part in parts], -1)
            values[outside] = np.nan
        return values[:, 0] if len(parts) == 1 else values


def _is_label_map(volume: Volume) -> bool:
    from .vtkFiltersVolumic import vtkVolumeToSurface
    return bool(volume.labels) or (
        volume.array.ndim == 3 and volume.array.dtype.kind in "ui"
        and bool(vtkVolumeToSurface.HintAtLabels(image_of(volume, volume.array))))


def _convert(path: str, volume: Volume, world: World, teller: Teller) -> None:
    """Put a second volume, which has a space and a unit of its own, into those of the first."""
    asked = Namespace(unit=None, scale=None, space=None)
    if world.unit and volume.unit:
        asked.unit = world.unit
    elif volume.unit != world.unit or (not world.unit and world.scale != 1):
        teller.warn(f"{path}: its unit is {volume.unit or 'not stated'}, that of the surface "
                    f"{world.unit or 'not stated'}: lengths are taken as they are")
    if world.space and volume.space:
        asked.space = world.space
    elif volume.space != world.space:
        teller.warn(f"{path}: its space is {volume.space or 'not stated'}, that of the surface "
                    f"{world.space or 'not stated'}: coordinates are taken as they are")
    place_in_world(volume, asked)
