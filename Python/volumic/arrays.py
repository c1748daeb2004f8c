# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Surfaces of NumPy arrays without a VTK pipeline: volumic.surface and volumic.labels."""

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
from .writing.files import output_file, output_folder, replace_file
from .writing.surfaces import FORMATS, file_header, write_pieces, write_vtm


class FilterError(RuntimeError):
    """A filter reported an error."""


class Surface:
    """A closed triangulated surface.

    Attributes
    ----------
    points : ndarray, n x 3
        World coordinates x, y, z.
    triangles : ndarray, m x 3
        Point indices, counter-clockwise seen from outside.
    arrays : dict of ndarray
        Point arrays (`Normals`, ...) and cell arrays (`Component`, ...) by name, in VTK's memory.
    report : dict
        Field data by name (`Area`, `Volume`, `StopReason`, ...), and `Warnings` of the filter.
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
        fields = {"components": "NumberOfComponents", "genus": "Genus", "volume": "Volume"}
        return (f"<volumic.Surface: {len(self.points)} points, {len(self.triangles)} triangles"
                + "".join(f", {text} {self.report[name]:g}" for text, name in fields.items()
                          if isinstance(self.report.get(name), (int, float))) + ">")

    def __reduce__(self) -> Any:
        return _unpickled, (Surface, _serialized(self._polydata), self.report.get("Warnings", ()))

    def to_vtk(self) -> Any:
        """Return the vtkPolyData, with all arrays and field data."""
        return self._polydata

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write a .vtp or .vtk (all arrays), .ply (points, normals, triangles), .stl or .obj file.
        It replaces an existing file once complete. Raise ValueError if the suffix is unknown."""
        replace_file(path, self.to_bytes(os.path.splitext(path)[1].lower()))

    def to_bytes(self, suffix: str) -> bytes:
        """Return the content of a file with this suffix, see save()."""
        if suffix not in FORMATS:
            raise ValueError(f"'{suffix}' is not a surface format; use one of {', '.join(FORMATS)}")
        return b"".join(FORMATS[suffix](self._polydata, file_header(self._polydata)))


class Surfaces(dict[int, Surface]):
    """Surfaces by label value, in increasing order. `report` has the field data of all."""

    def __init__(self, blocks: Any, notes: Sequence[str] = ()) -> None:
        surfaces = [Surface(blocks.GetBlock(i)) for i in range(blocks.GetNumberOfBlocks())]
        super().__init__((int(np.ravel(surface.report["Label"])[0]), surface)
                         for surface in surfaces)
        self._blocks = blocks
        self.report = _fields(blocks, notes)

    def __reduce__(self) -> Any:
        return _unpickled, (Surfaces, _serialized(self._blocks), self.report.get("Warnings", ()))

    def to_vtk(self) -> Any:
        """Return the vtkMultiBlockDataSet, one block per label."""
        return self._blocks

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write a .vtm file, or one file `label-3.vtp` per label to a folder, which is created."""
        if os.path.splitext(path)[1].lower() == ".vtm":
            with output_file(path) as written:
                write_vtm(self._blocks, written)
            return
        with output_folder(path) as folder:
            for label, surface in self.items():
                write_pieces(os.path.join(folder, f"label-{label}.vtp"), [surface.to_bytes(".vtp")])


def _serialized(data: Any) -> bytes:
    """Return a VTK data object as bytes."""
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
    """Compute the closed surface of an object in a volume, by vtkVolumeToSurface.

    Parameters
    ----------
    array : array_like or Volume
        Voxels [z, y, x], or the result of `volumic.read`. Contiguous arrays are not copied.
    iso : float, optional
        Image value at the surface (default: Otsu's threshold, with a warning). With
        `UpperValue=...` the object has values between the two.
    spacing, origin : sequence of 3 floats, optional
        Voxel spacing (default 1) and position of voxel 0 (default 0) along x, y, z, in world units.
    direction : array_like, 3 x 3, optional
        Columns are the unit vectors of the index axes x, y, z in world coordinates.
    start : sequence of 3 ints, optional
        Index x, y, z of the first voxel if `array` is a crop. `origin` is that of the whole volume.
    **properties
        Properties of vtkVolumeToSurface, such as `FinestLevel=1`; see its help.

    Returns
    -------
    Surface

    Raises
    ------
    TypeError
        The filter has no such property, or the type of its value is wrong.
    ValueError
        The array, its position or `iso` is invalid.
    FilterError
        The filter reported an error.

    Warns
    -----
    UserWarning
        For each warning of the filter.

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
        notes.append(f"No iso-value is given; Otsu's threshold {iso:g} is used.")
    if iso is not None:
        algorithm.SetIsoValue(iso)
    notes += _run(algorithm)
    return Surface(_marked(algorithm.GetOutput(), array), _warn(notes))


def labels(array: Any, only: Sequence[int] = (), *, spacing: Sequence[float] | None = None,
           origin: Sequence[float] | None = None, direction: Any = None,
           start: Sequence[int] | None = None, **properties: Any) -> Surfaces:
    """Compute a closed surface around each label of a label map, by vtkLabelsToSurfaces.

    Adjacent labels share their interface.

    Parameters
    ----------
    array : array_like of integers or Volume
        Labels [z, y, x], or the result of `volumic.read`. Contiguous arrays are not copied.
    only : sequence of ints, optional
        Labels to compute (default: all but BackgroundLabel). The surface of a label does not depend
        on this selection.
    spacing, origin, direction, start
        See `volumic.surface`.
    **properties
        Properties of vtkLabelsToSurfaces, such as `Smoothing=1.5`; see its help.

    Returns
    -------
    Surfaces
        Surface by label. With Merge, one surface under the first label.

    Raises
    ------
    TypeError, ValueError, FilterError
        See `volumic.surface`.
    """
    algorithm = filters.vtkLabelsToSurfaces()
    _set(algorithm, properties)
    for label in only:
        algorithm.AddLabel(int(label))
    algorithm.SetInputData(_input(array, spacing, origin, direction, start))
    notes = _run(algorithm)
    return Surfaces(_marked(algorithm.GetOutput(), array), _warn(notes))


def label_boxes(array: Any, start: Sequence[int] = (0, 0, 0)) -> dict[int, list[int]]:
    """Return [voxels, first x, last x, first y, ..., last z] by label, see vtkLabelTable."""
    table = filters.vtkLabelTable()
    table.SetInputData(_input(array, None, None, None, start))
    _run(table)
    numbers, voxels, extents = (vtk_to_numpy(table.GetOutput().GetColumnByName(name)).tolist()
                                for name in ("Label", "Voxels", "Extent"))
    return {number: [count, *extent] for number, count, extent in zip(numbers, voxels, extents)}


def quality(surface: Surface) -> dict[str, Any]:
    """Return the minimum angle of the triangles in degrees and their mean quality, 4 sqrt(3) area /
    sum of squared edge lengths (1 for an equilateral triangle)."""
    corners = np.asarray(surface.points, float)[surface.triangles]
    if len(corners) == 0:
        return {"SmallestAngle": None, "MeanQuality": None}
    sides = np.roll(corners, -1, axis=1) - corners
    squares = (sides * sides).sum(axis=2)
    areas = np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1) / 2
    cosines = (squares.sum(axis=1)[:, None] - 2 * squares) / 2  # times the lengths of two sides
    angles = np.degrees(np.arctan2(2 * areas[:, None], cosines))
    return {"SmallestAngle": float(angles.min()),
            "MeanQuality": float((4 * np.sqrt(3) * areas / squares.sum(axis=1)).mean())}


def check_properties(kind: str, properties: dict[str, Any]) -> None:
    """Raise TypeError if a filter class lacks a property or its type is wrong."""
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
    """Return a vtkImageData of [z, y, x] or [z, y, x, component], without a copy if contiguous."""
    voxels = np.asarray(array)
    if voxels.dtype.kind not in "biuf":
        raise ValueError(f"voxels of type {voxels.dtype} are not supported; convert them to "
                         "integers or floats")
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
    scalars = numpy_to_vtk(voxels.reshape(-1, *voxels.shape[3:]))  # keeps a reference to the array
    scalars.SetName(name)
    image.GetPointData().SetScalars(scalars)
    return image


def _input(array: Any, spacing: Any, origin: Any, direction: Any, start: Any) -> Any:
    """Return the vtkImageData of an array and its position, or of a Volume."""
    given = {"spacing": spacing, "origin": origin, "direction": direction, "start": start}
    given = {name: value for name, value in given.items() if value is not None}
    if isinstance(array, Volume):
        if given:
            raise TypeError(f"remove {', '.join(given)}: the Volume defines its own")
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


def _marked(data: Any, array: Any) -> Any:
    """Set the coordinate system and the unit of surfaces if `array` is a Volume."""
    from .geometry import mark_space
    if isinstance(array, Volume):
        mark_space(data, array)
    return data


def _run(algorithm: Any) -> list[str]:
    """Update an algorithm and return its warnings. Ctrl-C aborts it."""
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
