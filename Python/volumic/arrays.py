# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""From numpy arrays to surfaces, without VTK's pipeline: volumic.surface and volumic.labels."""

from __future__ import annotations

import difflib
import math
import os
import warnings
from collections.abc import Sequence
from typing import Any

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkCharArray
from vtkmodules.vtkCommonDataModel import vtkImageData, vtkMultiBlockDataSet, vtkPolyData

from . import messages
from . import vtkFiltersVolumic as filters
from .errors import VolumeError
from .reading.volume import Volume, check_positions
from .writing.files import beside, replace_file
from .writing.surfaces import FORMATS, write_vtm


class FilterError(RuntimeError):
    """The error message of a filter."""


class Surface:
    """A closed surface.

    Attributes
    ----------
    points : ndarray, n x 3
        World coordinates x, y, z.
    triangles : ndarray, m x 3
        Indices of points, counter-clockwise seen from outside.
    arrays : dict of ndarray
        Per point (`Normals`, ...) or per triangle (`Component`, ...), by name. All arrays share
        VTK's memory.
    report : dict
        The field data by name: `Area`, `Volume`, `StopReason`, ...; `Warnings` of the filter.
    """

    def __init__(self, polydata: Any, notes: Sequence[str] = ()) -> None:
        self._polydata = polydata
        points = polydata.GetPoints()
        self.points = vtk_to_numpy(points.GetData()) if points else np.zeros((0, 3))
        self.triangles = vtk_to_numpy(polydata.GetPolys().GetConnectivityArray()).reshape(-1, 3)
        self.arrays = {data.GetArrayName(i): vtk_to_numpy(data.GetArray(i))
                       for data in (polydata.GetPointData(), polydata.GetCellData())
                       for i in range(data.GetNumberOfArrays())}
        self.report = _fields(polydata, notes)

    def __repr__(self) -> str:
        facts = {"components": "NumberOfComponents", "genus": "Genus", "volume": "Volume"}
        return (f"<volumic.Surface: {len(self.points)} points, {len(self.triangles)} triangles"
                + "".join(f", {text} {self.report[name]:g}" for text, name in facts.items()
                          if isinstance(self.report.get(name), (int, float))) + ">")

    def __reduce__(self) -> Any:
        return _unpickled, (Surface, _serialized(self._polydata), self.report.get("Warnings", ()))

    def to_vtk(self) -> Any:
        """The vtkPolyData, with all arrays and field data."""
        return self._polydata

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write a .vtp or .vtk (with all arrays), .ply (points, normals, triangles), .stl or .obj.

        The file at `path` is replaced when the new one is whole.
        """
        replace_file(path, self.to_bytes(os.path.splitext(path)[1].lower()))

    def to_bytes(self, suffix: str) -> bytes:
        """What save() writes."""
        if suffix not in FORMATS:
            raise ValueError(f"'{suffix}' is no format of surfaces; there are {', '.join(FORMATS)}")
        return b"".join(FORMATS[suffix](self._polydata, "volumic"))


class Surfaces(dict[int, Surface]):
    """The surface of each label, in the order of their values; `report` is that of the whole."""

    def __init__(self, blocks: Any, notes: Sequence[str] = ()) -> None:
        surfaces = [Surface(blocks.GetBlock(i)) for i in range(blocks.GetNumberOfBlocks())]
        super().__init__((int(np.ravel(surface.report["Label"])[0]), surface)
                         for surface in surfaces)
        self._blocks = blocks
        self.report = _fields(blocks, notes)

    def __reduce__(self) -> Any:
        return _unpickled, (Surfaces, _serialized(self._blocks), self.report.get("Warnings", ()))

    def to_vtk(self) -> Any:
        """The vtkMultiBlockDataSet, a block for each label."""
        return self._blocks

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write them to a .vtm, or each to `label-3.vtp` in a folder, which is made."""
        if os.path.splitext(path)[1].lower() == ".vtm":
            with beside(path) as written:
                write_vtm(self._blocks, written)
            return
        os.makedirs(path, exist_ok=True)
        for label, surface in self.items():
            surface.save(os.path.join(path, f"label-{label}.vtp"))


def _serialized(data: Any) -> bytes:
    """A data object of VTK with its arrays, field data and names as bytes."""
    from vtkmodules.vtkParallelCore import vtkCommunicator
    buffer = vtkCharArray()
    vtkCommunicator.MarshalDataObject(data, buffer)
    return bytes(memoryview(vtk_to_numpy(buffer)))


def _unpickled(kind: Any, content: bytes, notes: Sequence[str]) -> Any:
    from vtkmodules.vtkParallelCore import vtkCommunicator
    buffer = numpy_to_vtk(np.frombuffer(content, np.int8), deep=True, array_type=2)  # char
    data = vtkMultiBlockDataSet() if kind is Surfaces else vtkPolyData()
    vtkCommunicator.UnMarshalDataObject(buffer, data)
    return kind(data, notes)


def surface(array: Any, iso: float | None = None, *, spacing: Sequence[float] | None = None,
            origin: Sequence[float] | None = None, direction: Any = None,
            start: Sequence[int] | None = None, **properties: Any) -> Surface:
    """The closed surface at an iso-value of a volume, by vtkVolumeToSurface.

    Parameters
    ----------
    array : array_like or Volume
        Voxels [z, y, x], or what `volumic.read` returns. What is contiguous is not copied.
    iso : float, optional
        The value on the surface (default: Otsu's threshold, a guess, with a warning).
        With `UpperValue=...` the object has the values between the two.
    spacing, origin : sequence of 3 floats, optional
        x, y, z: voxel distances (default 1), and position of voxel 0 (default 0), in the world.
    direction : array_like, 3 x 3, optional
        Its columns are the unit vectors of index x, y, z in the world.
    start : sequence of 3 ints, optional
        x, y, z: the index of the first voxel, where `array` is a crop: `origin` stays that of the
        whole.
    **properties
        Those of vtkVolumeToSurface, by their names: `FinestLevel=1`.

    Returns
    -------
    Surface

    Raises
    ------
    TypeError
        The filter has no such property.
    FilterError
        The error message of the filter.

    Examples
    --------
    >>> z, y, x = np.indices((24, 24, 24)) - 11.5
    >>> ball = volumic.surface(9 - np.sqrt(x * x + y * y + z * z), iso=0)
    >>> ball.report["Genus"]
    0
    """
    algorithm = filters.vtkVolumeToSurface()
    _set(algorithm, properties)
    if iso is not None and not math.isfinite(iso):
        raise ValueError(f"iso is {iso}; it must be a finite number")
    algorithm.SetInputData(_input(array, spacing, origin, direction, start))
    notes = []
    if iso is None and "UpperValue" not in properties:
        otsu = filters.vtkOtsuThreshold()
        otsu.SetInputDataObject(algorithm.GetInputDataObject(0, 0))
        _run(otsu)
        iso = otsu.GetThreshold()
        notes.append(f"The iso-value is {iso:g}, a guess by Otsu's threshold.")
    if iso is not None:
        algorithm.SetIsoValue(iso)
    notes += _run(algorithm)
    return Surface(algorithm.GetOutput(), _warn(notes))


def labels(array: Any, only: Sequence[int] = (), *, spacing: Sequence[float] | None = None,
           origin: Sequence[float] | None = None, direction: Any = None,
           start: Sequence[int] | None = None, **properties: Any) -> Surfaces:
    """A closed surface around each label of a map, by vtkLabelsToSurfaces; neighbours share it.

    Parameters
    ----------
    array : array_like of integers or Volume
        Labels [z, y, x], or what `volumic.read` returns. What is contiguous is not copied.
    only : sequence of ints, optional
        Labels that get a surface; by default all but BackgroundLabel. A surface does not depend on
        the others.
    spacing, origin, direction, start
        As in `volumic.surface`, which raises the same exceptions.
    **properties
        Those of vtkLabelsToSurfaces, by their names: `Smoothing=1.5`.

    Returns
    -------
    Surfaces
        {label: Surface}. With Merge it is one, by the first label.
    """
    algorithm = filters.vtkLabelsToSurfaces()
    _set(algorithm, properties)
    for label in only:
        algorithm.AddLabel(int(label))
    algorithm.SetInputData(_input(array, spacing, origin, direction, start))
    notes = _run(algorithm)
    return Surfaces(algorithm.GetOutput(), _warn(notes))


def label_boxes(array: Any, start: Sequence[int] = (0, 0, 0)) -> dict[int, list[int]]:
    """{label: [voxels, first x, last x, first y, last y, first z, last z]}, by vtkLabelTable."""
    table = filters.vtkLabelTable()
    table.SetInputData(_input(array, None, None, None, start))
    _run(table)
    numbers, voxels, extents = (vtk_to_numpy(table.GetOutput().GetColumnByName(name)).tolist()
                                for name in ("Label", "Voxels", "Extent"))
    return {number: [count, *extent] for number, count, extent in zip(numbers, voxels, extents)}


def quality(surface: Surface) -> dict[str, Any]:
    """The smallest angle of the triangles in degrees, and the mean of their 4 sqrt(3) area / sum of
    squared sides, which is 1 for an equilateral triangle."""
    corners = np.asarray(surface.points, float)[surface.triangles]
    if len(corners) == 0:
        return {"SmallestAngle": None, "MeanQuality": None}
    sides = np.roll(corners, -1, axis=1) - corners
    squares = (sides * sides).sum(axis=2)
    areas = np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1) / 2
    cosines = (squares.sum(axis=1)[:, None] - 2 * squares) / 2  # times the other two sides
    angles = np.degrees(np.arctan2(2 * areas[:, None], cosines))
    return {"SmallestAngle": float(angles.min()),
            "MeanQuality": float((4 * np.sqrt(3) * areas / squares.sum(axis=1)).mean())}


def check_properties(kind: str, properties: dict[str, Any]) -> None:
    """TypeError where a filter of this class has no such property, or not of that type."""
    _set(getattr(filters, kind)(), properties)


def _set(algorithm: Any, properties: dict[str, Any]) -> None:
    known = {name[3:] for cls in type(algorithm).__mro__ if cls.__module__ == filters.__name__
             for name in vars(cls) if name.startswith("Set") and hasattr(algorithm, "G" + name[1:])}
    for name, value in properties.items():
        if name not in known:
            lower = {other.lower(): other for other in known}
            near = difflib.get_close_matches(name.lower(), lower, 1)
            raise TypeError(f"{algorithm.GetClassName()} has no property {name}"
                            + (f"; did you mean {lower[near[0]]}?" if near else ""))
        try:
            getattr(algorithm, "Set" + name)(value)
        except TypeError as error:
            raise TypeError(f"{name}={value!r}: {error}") from None


def make_image(array: Any, spacing: Sequence[float], origin: Sequence[float], direction: Any,
               start: Sequence[int] = (0, 0, 0), name: str = "Voxels") -> Any:
    """A vtkImageData of an array [z, y, x] or [z, y, x, component]; what is contiguous is not
    copied."""
    voxels = np.asarray(array)
    if voxels.dtype.kind not in "biuf":
        raise ValueError(f"voxels of type {voxels.dtype} are not numbers that VTK's images hold")
    voxels = np.ascontiguousarray(voxels, voxels.dtype.newbyteorder("="))
    if voxels.dtype == bool:
        voxels = voxels.view(np.uint8)
    if voxels.dtype == np.float16:
        voxels = voxels.astype(np.float32)
    image = vtkImageData()
    image.SetExtent([int(index) for first, size in zip(start, voxels.shape[2::-1])
                     for index in (first, first + size - 1)])
    image.SetSpacing([float(length) for length in spacing])
    image.SetOrigin([float(coordinate) for coordinate in origin])
    if direction is not None:
        image.SetDirectionMatrix(np.asarray(direction, float).ravel())
    scalars = numpy_to_vtk(voxels.reshape(-1, *voxels.shape[3:]))  # It holds the array.
    scalars.SetName(name)
    image.GetPointData().SetScalars(scalars)
    return image


def _input(array: Any, spacing: Any, origin: Any, direction: Any, start: Any) -> Any:
    """The image of an array and its position, or of a Volume."""
    given = {"spacing": spacing, "origin": origin, "direction": direction, "start": start}
    given = {name: value for name, value in given.items() if value is not None}
    if isinstance(array, Volume):
        if given:
            raise TypeError(f"a Volume has {', '.join(given)} of its own")
        volume = array
    elif np.ndim(array) != 3:
        raise ValueError(f"the array must have three axes, z, y and x, not {np.ndim(array)}")
    else:
        volume = Volume(np.asarray(array), **given)
    try:
        check_positions(volume)
    except VolumeError as error:
        raise ValueError(str(error)) from None
    return make_image(volume.scalars(), volume.spacing, volume.origin, volume.direction,
                      volume.start, volume.name or "Voxels")


def _run(algorithm: Any) -> list[str]:
    """Update an algorithm, which Ctrl-C stops, and return its warnings."""
    errors, notes = messages.update(algorithm)
    if errors:
        raise FilterError(errors[0])
    return notes


def _warn(notes: list[str]) -> list[str]:
    for text in notes:
        warnings.warn(text, stacklevel=3)
    return notes


def _fields(data: Any, notes: Sequence[str]) -> dict[str, Any]:
    report: dict[str, Any] = {"Warnings": list(notes)} if notes else {}
    fields = data.GetFieldData()
    for array in map(fields.GetAbstractArray, range(fields.GetNumberOfArrays())):
        values = (vtk_to_numpy(array).tolist() if array.IsA("vtkDataArray")
                  else list(map(array.GetValue, range(array.GetNumberOfValues()))))
        report[array.GetName()] = values[0] if len(values) == 1 else values
    return report
