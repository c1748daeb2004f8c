# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Readers and writer of the ParaView plugin, based on the package volumic.

The XML of the plugin names these classes. vtkSIPythonSourceProxy creates them, also in a server.
Requests return 1 after an error, because ParaView would add messages otherwise.
"""

from __future__ import annotations

import dataclasses
import functools
import os
import platform
import re
import sys
import traceback
from typing import Any

try:
    import volumic  # which checks that its VTK is ParaView's
except ImportError as missing:
    sys.stderr.write(f"ERROR: Volumic cannot read or write files on {platform.node()}: {missing}\n")
    raise

from vtkmodules.util.vtkAlgorithm import VTKPythonAlgorithmBase
from vtkmodules.vtkCommonCore import vtkOutputWindow, vtkStringArray
from vtkmodules.vtkCommonDataModel import vtkDataObject, vtkImageData
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline as Pipeline

from volumic.errors import Failure

# Phrases on options in messages of the command, and the same on properties.
PROPERTIES = (("with --series N", "as Series"), ("(--series)", "(Series)"),
              ("with --time N", "as time step"), ("(--time)", "(time step)"),
              ("without --no-resampling they are", "switch Resampling on, and they are"),
              (" unless --unit gives another", ""))


def _name_properties(text: str) -> str:
    for option, property_ in PROPERTIES:
        text = text.replace(option, property_)
    return text


def _reporting(method: Any) -> Any:
    """Return a method that reports exceptions in ParaView's messages and returns 1."""
    @functools.wraps(method)
    def guarded(*arguments: Any) -> Any:
        try:
            return method(*arguments)
        except Failure as failure:
            text = str(failure)
        except ModuleNotFoundError as error:
            name = (error.name or "").split(".")[0]
            text = f"Python lacks the module {name}: install the package python3-{name}"
        except Exception as error:  # pylint: disable=broad-except
            text = f"{type(error).__name__}: {error}\n{traceback.format_exc()}"
        text = _name_properties(text)
        if "install" in text:
            text += f" (on {platform.node()})"
        vtkOutputWindow.GetInstance().DisplayErrorText(f"ERROR: {text}\n\n")
        return 1
    return guarded


class VolumeReader(VTKPythonAlgorithmBase):
    """Reads a volume in world coordinates: a file, a folder, or a series of files in time.

    The reader keeps the last volume, whose memory the output shares.
    """

    def __init__(self) -> None:
        super().__init__(nInputPorts=0, outputType="vtkImageData")
        self._files: list[str] = []
        self._choice: dict[str, Any] = {"series": None, "resampling": True}
        self._key: Any = None  # of the last volume, even if reading failed
        self._volume: Any = None
        self._warnings: set[str] = set()  # already shown

    # ---- Properties ----

    def SetFileName(self, name: str | None) -> None:
        """Set the file; for DICOM one of the slices of the series, or its folder."""
        self._files = [name] if name else []
        self.Modified()

    def AddFileName(self, name: str) -> None:
        """Add a file. Each file is a time step."""
        self._files.append(name)
        self.Modified()

    def RemoveAllFileNames(self) -> None:
        """Remove all files."""
        self._files = []
        self.Modified()

    def GetCurrentFileName(self) -> str:
        """Return the file that was read last."""
        return self._key[0] if self._key else ""

    def SetSeries(self, series: str | None) -> None:
        """Set the DICOM series: a line of GetSeriesList(), its number or its UID. A text in
        parentheses chooses the series of the file."""
        series = (series or "").split(":")[0]
        self._choice["series"] = None if series.startswith("(") else series or None
        self.Modified()

    def SetResampling(self, is_on: int) -> None:
        """Set whether slices that form no regular grid are interpolated, or are an error."""
        self._choice["resampling"] = bool(is_on)
        self.Modified()

    def GetSeriesList(self) -> vtkStringArray:
        """Return the series of the file or folder."""
        from volumic import reading
        lines = vtkStringArray()
        try:
            for line in reading.list_series(self._files[0]):
                lines.InsertNextValue(line)
        except (Failure, IndexError):
            pass  # RequestInformation reports the error
        return lines

    # ---- The pipeline ----

    @_reporting
    def RequestInformation(self, _request: Any, _inputs: Any, outputs: Any) -> int:
        """Read the first volume."""
        volume, information = self._read(0), outputs.GetInformationObject(0)
        information.Remove(Pipeline.TIME_STEPS())
        information.Remove(Pipeline.TIME_RANGE())
        if volume is None:
            return 1
        steps = [float(step) for step in range(len(self._files) * volume.times)]
        if len(steps) > 1:
            information.Set(Pipeline.TIME_STEPS(), steps, len(steps))
            information.Set(Pipeline.TIME_RANGE(), (steps[0], steps[-1]), 2)
        sizes = volume.array.shape[:-4:-1]
        extent = [i for first, size in zip(volume.start, sizes) for i in (first, first + size - 1)]
        information.Set(Pipeline.WHOLE_EXTENT(), extent, 6)
        information.Set(vtkDataObject.ORIGIN(), volume.origin, 3)
        information.Set(vtkDataObject.SPACING(), volume.spacing, 3)
        information.Set(vtkDataObject.DIRECTION(), volume.direction.ravel().tolist(), 9)
        information.Set(self.CAN_PRODUCE_SUB_EXTENT(), 1)
        return 1

    @_reporting
    def RequestData(self, _request: Any, _inputs: Any, outputs: Any) -> int:
        """Output the requested extent of the volume of the requested time."""
        from volumic import geometry, label_map
        information = outputs.GetInformationObject(0)
        step = (round(information.Get(Pipeline.UPDATE_TIME_STEP()))
                if information.Has(Pipeline.UPDATE_TIME_STEP()) else 0)
        volume = self._read(step)
        if volume is None:
            return 1
        extent = information.Get(Pipeline.UPDATE_EXTENT())
        x, y, z = (slice(extent[2 * axis] - volume.start[axis],
                         extent[2 * axis + 1] + 1 - volume.start[axis]) for axis in range(3))
        part = dataclasses.replace(volume, array=volume.array[..., z, y, x], start=extent[::2])
        image = vtkImageData.GetData(outputs, 0)
        image.ShallowCopy(geometry.image_of(part, part.array))
        label_map.set_label_names(image, volume.labels)
        image.GetInformation().Set(vtkDataObject.DATA_TIME_STEP(), float(step))
        return 1

    def _read(self, step: int) -> Any:
        """Return the volume of a time step; None without a file, or if reading failed before."""
        from volumic import reading
        from volumic.reading.tables import names_beside
        if not self._files:
            return None
        times = self._volume.times if self._volume else 1
        step = min(max(step, 0), len(self._files) * times - 1)
        path = self._files[step // times]
        key = path, step % times, *self._choice.values()
        if key != self._key:
            self._key, self._volume = key, None
            volume = reading.read(path, time=step % times, **self._choice)
            for text in volume.warnings:
                self._warn(re.sub(": steps and origin .*", "", text), path)
            volume.labels = volume.labels or names_beside(path)[0]
            self._volume = volume
        return self._volume

    def _warn(self, text: str, path: str) -> None:
        """Show a warning once."""
        text = _name_properties(text)
        text = f"{text[:1].upper()}{text[1:]} ({os.path.basename(path)})"
        if text not in self._warnings:
            self._warnings.add(text)
            vtkOutputWindow.GetInstance().DisplayWarningText(f"{text}\n\n")


class SurfacesWriter(VTKPythonAlgorithmBase):
    """Writes a file for each label, level or component, or a scene with all of them.

    `organs.stl` becomes `organs-liver.stl` and `organs-spleen.stl` for blocks named liver and
    spleen, and `organs-component-0.stl` and so on for one surface with several components, each
    with its cavities. For volume cells, as from Clip and Threshold, the outer surface is written.
    Empty surfaces are omitted. It is an error if all are empty.
    """

    def __init__(self) -> None:
        super().__init__(nInputPorts=1, inputType="vtkDataObject", nOutputPorts=0)
        self._name = ""

    def SetFileName(self, name: str | None) -> None:
        """Set the prefix and suffix of the file names."""
        self._name = name or ""
        self.Modified()

    def Write(self) -> None:
        """Write the files."""
        self.Modified()
        self.Update()

    @_reporting
    def RequestData(self, _request: Any, inputs: Any, _outputs: Any) -> int:
        """Write the files."""
        from vtkmodules.vtkParallelCore import vtkMultiProcessController
        from volumic import writing
        from volumic.label_map import safe_name
        from volumic.writing.meshers import DistinctNames
        data = inputs[0].GetInformationObject(0).Get(vtkDataObject.DATA_OBJECT())
        processes = vtkMultiProcessController.GetGlobalController()
        if (processes and processes.GetNumberOfProcesses() > 1
                and not data.IsA("vtkCompositeDataSet")):
            raise Failure(f"{self._name}: not written by several processes: use File > Save Data")
        writing.check_surface_name(self._name)
        surfaces = _surfaces_of(data)
        if not surfaces:
            raise Failure(f"{self._name}: not written, because there are no triangles")
        if writing.is_scene(self._name):
            writing.write_scene([(name or "surface", surface) for name, surface in surfaces],
                                self._name)
            return 1
        stem, suffix = os.path.splitext(self._name)
        names = DistinctNames("-", lambda name: name and "-" + safe_name(name))
        for name, surface in surfaces:
            writing.write_surface(surface, stem + names.take(name) + suffix)
        return 1


def _surfaces_of(data: Any) -> list[tuple[str, Any]]:
    """Return the names and surfaces of a data object that are not empty. A single surface has the
    name ""."""
    if not data.IsA("vtkCompositeDataSet"):
        surface = _triangles_of(data)
        return _components_of(surface) if surface else []
    surfaces, leaf = [], data.NewIterator()
    leaf.InitTraversal()
    while not leaf.IsDoneWithTraversal():
        surface = _triangles_of(leaf.GetCurrentDataObject())
        name = (leaf.GetCurrentMetaData().Get(data.NAME()) if leaf.HasCurrentMetaData() else None)
        if surface:
            surfaces.append((name or str(leaf.GetCurrentFlatIndex()), surface))
        leaf.GoToNextItem()
    return surfaces


def _triangles_of(data: Any) -> Any:
    """Return the triangles of the outer surface of a data set, None if it has none."""
    from vtkmodules.vtkFiltersCore import vtkTriangleFilter
    from vtkmodules.vtkFiltersGeometry import vtkDataSetSurfaceFilter
    if not data.IsA("vtkPolyData"):
        data = _made_of(vtkDataSetSurfaceFilter(), data)
    if data.GetNumberOfStrips() > 0 or data.GetPolys().GetMaxCellSize() > 3:
        triangulate = vtkTriangleFilter()
        triangulate.PassLinesOff()
        triangulate.PassVertsOff()
        data = _made_of(triangulate, data)
    return data if data.GetNumberOfPolys() > 0 else None


def _components_of(surface: Any) -> list[tuple[str, Any]]:
    """Return the names and surfaces of the components, each with its cavities."""
    import numpy as np
    from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
    from vtkmodules.vtkFiltersCore import vtkThreshold
    components = surface.GetCellData().GetArray("Component")
    if not components:
        return [("", surface)]
    owners = components = vtk_to_numpy(components).astype(int)
    table = surface.GetFieldData().GetArray("ComponentOwner")
    if table and table.GetNumberOfTuples() > 0:
        table = vtk_to_numpy(table).astype(int)
        owners = table[np.clip(components, 0, len(table) - 1)]
        owners = np.where((components >= 0) & (components < len(table)) & (owners >= 0), owners,
                          components)
    found = np.unique(owners).tolist()
    if len(found) < 2:
        return [("", surface)]
    marked = surface.NewInstance()
    marked.ShallowCopy(surface)
    array = numpy_to_vtk(owners, deep=True)
    array.SetName("Owner")
    marked.GetCellData().AddArray(array)
    parts = []
    for number in found:
        threshold = vtkThreshold()
        threshold.SetInputArrayToProcess(0, 0, 0, 1, "Owner")
        threshold.SetLowerThreshold(number)
        threshold.SetUpperThreshold(number)
        part = _triangles_of(_made_of(threshold, marked))
        part.GetCellData().RemoveArray("Owner")
        parts.append((f"component-{number}", part))
    return parts


def _made_of(algorithm: Any, data: Any) -> Any:
    algorithm.SetInputData(data)
    algorithm.Update()
    return algorithm.GetOutput()
