# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""From numpy arrays to surfaces, without VTK's pipeline: volumic.surface and volumic.labels."""

from __future__ import annotations

import difflib
import os
import re
import signal
import threading
import time
import uuid
import warnings
from collections.abc import Sequence
from typing import Any

import numpy as np
from vtkmodules.util.misc import calldata_type
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.util.vtkConstants import VTK_STRING
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkIOXML import vtkXMLMultiBlockDataWriter, vtkXMLPolyDataWriter

from . import vtkFiltersVolumic as filters


class FilterError(RuntimeError):
    """What a filter refused, in its words."""


class Surface:
    """A closed surface.

    Attributes
    ----------
    points : ndarray, n x 3
        World coordinates x, y, z.
    triangles : ndarray, m x 3
        Indices of points, counter-clockwise seen from outside.
    arrays : dict of ndarray
        Per point (`Normals`, ...) or per triangle (`Component`, ...), by name. As the two above they
        share VTK's memory.
    report : dict
        The field data, by name: `Area`, `Volume`, `StopReason`, ...; `Warnings`: those of the filter.
    """

    def __init__(self, polydata: Any, told: Sequence[str] = ()) -> None:
        self._polydata = polydata
        has_points = polydata.GetPoints() is not None
        self.points = (vtk_to_numpy(polydata.GetPoints().GetData()) if has_points
                       else np.zeros((0, 3)))
        self.triangles = vtk_to_numpy(polydata.GetPolys().GetConnectivityArray()).reshape(-1, 3)
        self.arrays: dict[str, np.ndarray] = {}
        for data in (polydata.GetPointData(), polydata.GetCellData()):
            for i in range(data.GetNumberOfArrays()):
                self.arrays[data.GetArrayName(i)] = vtk_to_numpy(data.GetArray(i))
        self.report = _fields(polydata, told)

    def to_vtk(self) -> Any:
        """The vtkPolyData, with all arrays and field data."""
        return self._polydata

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write it to .vtp (all of it), .ply (points, normals, triangles) or .stl.

        Whoever reads `path` meanwhile finds the former file, or the new one, never half of it.
        """
        replace_file(path, self.to_bytes(os.path.splitext(path)[1].lower()))

    def to_bytes(self, suffix: str) -> bytes:
        """What save() writes."""
        if suffix not in WRITERS:
            raise ValueError(f"'{suffix}' is no format of surfaces; there are {', '.join(WRITERS)}")
        return WRITERS[suffix](self)


class Surfaces(dict[int, Surface]):
    """The surface of each label, in the order of their values; `report` is that of the whole."""

    def __init__(self, blocks: Any, told: Sequence[str] = ()) -> None:
        surfaces = [Surface(blocks.GetBlock(i)) for i in range(blocks.GetNumberOfBlocks())]
        super().__init__((surface.report["Label"] if isinstance(surface.report["Label"], int)
                          else surface.report["Label"][0], surface) for surface in surfaces)
        self._blocks = blocks
        self.report = _fields(blocks, told)

    def to_vtk(self) -> Any:
        """The vtkMultiBlockDataSet, a block for each label."""
        return self._blocks

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write them to a .vtm, or each to `label-3.vtp` in a folder, which is made."""
        if os.path.splitext(path)[1].lower() == ".vtm":
            writer = vtkXMLMultiBlockDataWriter()
            writer.SetFileName(os.fspath(path))
            writer.SetInputData(self._blocks)
            _run(writer)
            return
        os.makedirs(path, exist_ok=True)
        for label, surface in self.items():
            surface.save(os.path.join(path, f"label-{label}.vtp"))


def surface(array: Any, iso: float | None = None, *, spacing: Sequence[float] = (1, 1, 1),
            origin: Sequence[float] = (0, 0, 0), direction: Any = None,
            start: Sequence[int] = (0, 0, 0), **properties: Any) -> Surface:
    """The closed surface at an iso-value of a volume, by vtkVolumeToSurface.

    Parameters
    ----------
    array : array_like
        Voxels [z, y, x]. What is contiguous is not copied.
    iso : float, optional
        The value on the surface; by default Otsu's threshold, a guess, which the warnings tell.
        With `UpperValue=...` the object has the values between the two.
    spacing, origin : sequence of 3 floats, optional
        x, y, z: distances of the voxels, and where voxel 0 is, in the world.
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
        A property that there is not.
    FilterError
        What the filter refuses, in its words.

    Examples
    --------
    >>> z, y, x = np.indices((24, 24, 24)) - 11.5
    >>> ball = volumic.surface(9 - np.sqrt(x * x + y * y + z * z), iso=0)
    >>> ball.report["Genus"]
    0
    """
    algorithm = filters.vtkVolumeToSurface()
    _set(algorithm, properties)
    algorithm.SetInputData(_image(array, spacing, origin, direction, start))
    told = []
    if iso is None and "UpperValue" not in properties:
        otsu = filters.vtkOtsuThreshold()
        otsu.SetInputDataObject(algorithm.GetInputDataObject(0, 0))
        _run(otsu)
        iso = otsu.GetThreshold()
        told.append(f"The iso-value is {iso:g}, a guess by Otsu's threshold.")
    if iso is not None:
        algorithm.SetIsoValue(iso)
    told += _run(algorithm)
    return Surface(algorithm.GetOutput(), _warn(told))


def labels(array: Any, only: Sequence[int] = (), *, spacing: Sequence[float] = (1, 1, 1),
           origin: Sequence[float] = (0, 0, 0), direction: Any = None,
           start: Sequence[int] = (0, 0, 0), **properties: Any) -> Surfaces:
    """A smooth closed surface about each label of a label map, by vtkLabelsToSurfaces.

    Parameters
    ----------
    array : array_like of integers
        Labels [z, y, x]. What is contiguous is not copied.
    only : sequence of ints, optional
        Labels that get a surface; by default all but BackgroundLabel.
    spacing, origin, direction, start
        As of `volumic.surface`.
    **properties
        Those of vtkLabelsToSurfaces, by their names: `Smoothing=1.5`.

    Returns
    -------
    Surfaces
        {label: Surface}. With Merge it is one, by the first label.

    Raises
    ------
    TypeError
        A property that there is not.
    FilterError
        What the filter refuses, in its words.
    """
    algorithm = filters.vtkLabelsToSurfaces()
    _set(algorithm, properties)
    for label in only:
        algorithm.AddLabel(int(label))
    algorithm.SetInputData(_image(array, spacing, origin, direction, start))
    told = _run(algorithm)
    return Surfaces(algorithm.GetOutput(), _warn(told))


def label_boxes(array: Any, start: Sequence[int] = (0, 0, 0)) -> dict[int, list[int]]:
    """{label: [voxels, first x, last x, first y, last y, first z, last z]}, by vtkLabelTable."""
    table = filters.vtkLabelTable()
    table.SetInputData(_image(array, (1, 1, 1), (0, 0, 0), None, start))
    _run(table)
    numbers, voxels, extents = (vtk_to_numpy(table.GetOutput().GetColumnByName(name)).tolist()
                                for name in ("Label", "Voxels", "Extent"))
    return {number: [count, *extent] for number, count, extent in zip(numbers, voxels, extents)}


def quality(surface: Surface) -> dict[str, Any]:
    """Of the triangles: the smallest angle, degrees, and the mean of 4 sqrt(3) area / sum of squared
    sides, which is 1 for an equilateral one."""
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


def _image(array: Any, spacing: Sequence[float], origin: Sequence[float], direction: Any,
           start: Sequence[int]) -> Any:
    voxels = np.asarray(array)
    if voxels.ndim != 3:
        raise ValueError(f"the array must have three axes, z, y and x, not {voxels.ndim}")
    if voxels.dtype.kind not in "biuf":
        raise ValueError(f"voxels of type {voxels.dtype} are not numbers that VTK's images hold")
    voxels = np.ascontiguousarray(voxels, voxels.dtype.newbyteorder("="))
    if voxels.dtype == bool:
        voxels = voxels.view(np.uint8)
    if voxels.dtype == np.float16:
        voxels = voxels.astype(np.float32)
    image = vtkImageData()
    image.SetExtent([int(place) for first, size in zip(start, voxels.shape[::-1])
                     for place in (first, first + size - 1)])
    image.SetSpacing([float(length) for length in spacing])
    image.SetOrigin([float(place) for place in origin])
    if direction is not None:
        image.SetDirectionMatrix(np.asarray(direction, float).ravel())
    scalars = numpy_to_vtk(voxels.ravel())  # It holds the array.
    scalars.SetName("Voxels")
    image.GetPointData().SetScalars(scalars)
    return image


def _run(algorithm: Any) -> list[str]:
    """Update it; returns the warnings. Ctrl-C stops it, and is raised then."""
    errors: list[str] = []
    told: list[str] = []
    interrupts: list[int] = []

    @calldata_type(VTK_STRING)
    def keep(_caller: Any, event: str, text: str) -> None:
        (errors if event == "ErrorEvent" else told).append(_plain(text))

    def interrupt(*_: Any) -> None:
        interrupts.append(1)
        algorithm.SetAbortExecute(1)

    # VTK holds Python's lock while it works: here other threads get it, such as those by which a
    # worker of Dask tells that it is alive; and Python's handlers of signals run.
    tags = [(algorithm, algorithm.AddObserver("ProgressEvent", lambda *_: time.sleep(0)))]
    for source in (algorithm, algorithm.GetExecutive()):
        for event in ("ErrorEvent", "WarningEvent"):
            tags.append((source, source.AddObserver(event, keep)))
    former = None
    if threading.current_thread() is threading.main_thread():
        former = signal.signal(signal.SIGINT, interrupt)
    try:
        (algorithm.Write if algorithm.IsA("vtkXMLWriter") else algorithm.Update)()
    finally:
        if former is not None:
            signal.signal(signal.SIGINT, former)
        for source, tag in tags:
            source.RemoveObserver(tag)
    if errors:
        raise FilterError(errors[0])
    if interrupts:
        raise KeyboardInterrupt
    return told


def _warn(told: list[str]) -> list[str]:
    for text in told:
        warnings.warn(text, stacklevel=3)
    return told


def _plain(text: str) -> str:
    """A message without the place in the source code."""
    text = re.sub(r"^(ERROR|Warning): In .*?\n.*?\): ", "", text, flags=re.DOTALL)
    return re.sub(r"\s+", " ", text).strip()


def _fields(data: Any, told: Sequence[str]) -> dict[str, Any]:
    report: dict[str, Any] = {}
    fields = data.GetFieldData()
    for i in range(fields.GetNumberOfArrays()):
        array = fields.GetAbstractArray(i)
        values = (vtk_to_numpy(array).tolist() if array.IsA("vtkDataArray")
                  else [array.GetValue(k) for k in range(array.GetNumberOfValues())])
        report[array.GetName()] = values[0] if len(values) == 1 else values
    if told:
        report["Warnings"] = list(told)
    return report


def _vtp(of: Surface) -> bytes:
    writer = vtkXMLPolyDataWriter()
    # By way of a string: VTK's writer ends the program on a full disk.
    writer.WriteToOutputStringOn()
    writer.SetDataModeToBinary()
    writer.SetInputData(of.to_vtk())
    _run(writer)
    return writer.GetOutputString().encode()


def _ply(of: Surface) -> bytes:
    columns = "".join(f"property float {name}\n" for name in ("x", "y", "z", "nx", "ny", "nz"))
    faces = np.zeros(len(of.triangles), [("count", "u1"), ("corners", "<i4", 3)])
    faces["count"], faces["corners"] = 3, of.triangles
    normals = of.arrays.get("Normals", np.zeros((0, 3)))
    return (f"ply\nformat binary_little_endian 1.0\nelement vertex {len(of.points)}\n{columns}"
            f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n"
            ).encode() + np.hstack([of.points, normals]).astype("<f4").tobytes() + faces.tobytes()


def _stl(of: Surface) -> bytes:
    facets = np.zeros(len(of.triangles),
                      [("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("word", "<u2")])
    corners = np.asarray(of.points, float)[of.triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    facets["normal"] = np.divide(normals, lengths, out=np.zeros_like(normals), where=lengths > 0)
    facets["corners"] = corners
    return (b"Volumic: closed surface in world coordinates".ljust(80)
            + np.array([len(facets)], "<u4").tobytes() + facets.tobytes())


WRITERS = {".vtp": _vtp, ".ply": _ply, ".stl": _stl}
HIDDEN = ".volumic-"  # What a killed process left behind begins so.


def replace_file(path: str | os.PathLike[str], content: bytes) -> None:
    """Write the file beside its place, have it on the disk, and put it there."""
    folder, name = os.path.split(os.path.abspath(path))
    hidden = os.path.join(folder, f"{HIDDEN}{uuid.uuid4().hex}-{name}")
    try:
        with open(hidden, "wb") as file:
            file.write(content)
            file.flush()
            os.fsync(file.fileno())
        os.replace(hidden, path)
    except BaseException:
        if os.path.exists(hidden):
            os.remove(hidden)
        raise
