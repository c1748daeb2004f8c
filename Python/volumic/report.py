# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Report of a run as JSON. Lengths, areas and volumes are in world units."""

from __future__ import annotations

import json
import math
import os
import resource
from argparse import Namespace
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy

from .geometry import LoadedVolume, field_text
from .option_tables import PROPERTIES, Filters, Property

SURFACE_FIELDS = {
    "components": "NumberOfComponents", "genus": "Genus",
    "euler_characteristic": "EulerCharacteristic", "area": "Area", "volume": "Volume",
    "delta": "Delta", "unit": "Unit", "level": "Level", "iterations": "Iterations",
    "lost_parts": "LostParts", "recovered_parts": "RecoveredParts",
    "lost_cavities": "LostCavities", "recovered_cavities": "RecoveredCavities",
    "missing_parts": "MissingParts", "missing_boundary": "MissingBoundary",
    "wrong_voxels": "WrongVoxels", "volume_error": "VolumeError", "missed_voxels": "MissedVoxels",
    "parts": "Parts", "wrong_parts": "WrongParts"}
INTERFACE_FIELDS = {"small_contacts": "SmallContacts", "worst_angle": "WorstAngle",
                    "worst_angle_position": "WorstAnglePosition"}
COMPONENT_FIELDS = {"area": "ComponentArea", "volume": "ComponentVolume", "genus": "ComponentGenus",
                    "centroid": "ComponentCentroid", "inertia": "ComponentInertia"}


def peak_memory() -> float:
    """Return the peak resident memory of the process in MiB."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024


def number_of(value: float) -> Any:
    """Return a number for JSON: an int if it is an integer, None if it is not finite."""
    return None if not math.isfinite(value) else int(value) if value == int(value) else value


def values_of(data: Any, name: str) -> np.ndarray | None:
    """Return a numeric array of the field data, tuples x components, or None."""
    array = data.GetFieldData().GetArray(name)
    return None if array is None else vtk_to_numpy(array).astype(float).reshape(
        -1, array.GetNumberOfComponents())


def field_values(data: Any, names: dict[str, str]) -> dict[str, Any]:
    """Return values of existing field data. `names` maps report keys to array names."""
    found = {name: values_of(data, array) for name, array in names.items()}
    return {name: number_of(values[0, 0]) if values.shape[1] == 1 else _numbers(values[0])
            for name, values in found.items() if values is not None and values.size}


def input_summary(name: str, loaded: LoadedVolume) -> dict[str, Any]:
    """Return the report entry `input`, the properties of the volume."""
    image, world = loaded.image, loaded.world
    summary = {"name": os.path.basename(os.path.normpath(name)),
               "dimensions": list(image.GetDimensions()), "spacing": _numbers(image.GetSpacing()),
               "origin": _numbers(image.GetOrigin()), "space": world.space, "unit": world.unit,
               "file_space": world.file_space, "file_unit": world.file_unit,
               "scale": number_of(world.scale), "scalar_type": image.GetScalarTypeAsString(),
               "range": _numbers(loaded.range)}
    resampling = field_text(image, "Resampling")
    return {**summary, "resampling": resampling} if resampling else summary


def surface_summary(surface: Any) -> dict[str, Any]:
    """Return the report entries of a surface, from its field data and cells."""
    return {**field_values(surface, SURFACE_FIELDS), "vertices": surface.GetNumberOfPoints(),
            "triangles": surface.GetNumberOfPolys(),
            "stop_reason": field_text(surface, "StopReason")}


def component_features(surface: Any) -> list[dict[str, Any]]:
    """Return the report entry `component_features`, a dict per component, by decreasing area."""
    columns = {name: values_of(surface, array) for name, array in COMPONENT_FIELDS.items()}
    columns = {name: values.squeeze(1) if values.shape[1] == 1 else values
               for name, values in columns.items() if values is not None}
    return [{name: number_of(values[i]) if values.ndim == 1 else _numbers(values[i])
             for name, values in columns.items()} for i in range(len(columns.get("area", ())))]


def tetrahedra_summary(mesh: Any) -> dict[str, Any]:
    """Return the report entry `solid` of a tetrahedral mesh; empty if there is none."""
    if mesh is None or mesh.grid is None:
        return {}
    return {"solid": {
        "mesher": mesh.mesher, "nodes": mesh.grid.GetNumberOfPoints(),
        "tetrahedra": mesh.grid.GetNumberOfCells(), "least_angle": mesh.least_angle,
        "percent_angle": mesh.percent_angle,
        "regions": [{"label": label, "name": mesh.names.get(label, ""), "tetrahedra": count,
                     "volume": number_of(volume)}
                    for label, (count, volume) in mesh.regions.items()]}}


def describe_tetrahedra(mesh: Any) -> str:
    """Return a line about a tetrahedral mesh; empty if there is none."""
    if mesh is None or mesh.grid is None:
        return ""
    return (f"{mesh.grid.GetNumberOfCells()} tetrahedra by {mesh.mesher}; minimum dihedral angle "
            f"{mesh.least_angle:.1f} degrees, below {mesh.percent_angle:.1f} degrees for 1 % of "
            "the tetrahedra")


def property_values(filters: Filters, applies: Callable[[Property], bool]) -> dict[str, str]:
    """Return the report entry `properties`: values of properties for which `applies` is true."""
    return {item.name: item.get(filters) for item in PROPERTIES if applies(item)}


def level_summaries(surface: Any) -> list[dict[str, Any]]:
    """Return the report entry `levels`: the levels of the filter, the coarsest first."""
    rows, blocks, levels = surface.GetHistory().GetRowData(), surface.GetLevels(), []
    has_rows = surface.GetHistory().GetNumberOfRows() > 0
    level, seconds = (vtk_to_numpy(rows.GetArray(name)) if has_rows else np.zeros(0)
                      for name in ("Level", "Seconds"))
    for block in map(blocks.GetBlock, range(blocks.GetNumberOfBlocks())):
        if block is not None:
            summary = surface_summary(block)
            levels.append({**summary, "seconds": float(seconds[level == summary["level"]].sum())})
    return sorted(levels, key=lambda summary: -summary["level"])


def finish(report: dict[str, Any], warnings: Sequence[str]) -> str:
    """Return the report as JSON, with the entries `warnings` and `versions` added."""
    from vtkmodules.vtkCommonCore import vtkVersion
    from . import __version__
    report["warnings"] = list(warnings)
    report["versions"] = {"volumic": __version__, "vtk": vtkVersion.GetVTKVersion()}
    return json.dumps(report, indent=2, ensure_ascii=False, allow_nan=False) + "\n"


def describe_print(options: Namespace, surfaces: Sequence[Any], unit: str) -> str:
    """Return a line with the size of a 3D print and, with --thin-parts, its minimum thickness; empty
    without .3mf. Where no thickness can be measured, the array has its minimum, delta / 2."""
    surfaces = [surface for surface in surfaces if surface.GetNumberOfPoints() > 0]
    names = [*options.surfaces, "." + (options.format or "")]
    if not surfaces or not any(name.lower().endswith(".3mf") for name in names):
        return ""
    bounds = np.array([surface.GetBounds() for surface in surfaces])
    lengths = bounds[:, 1::2].max(axis=0) - bounds[:, ::2].min(axis=0)
    line = f"size of the print: {' x '.join(f'{length:.4g}' for length in lengths)} {unit or 'mm'}"
    for surface in surfaces:
        thickness, delta = surface.GetPointData().GetArray("Thickness"), values_of(surface, "Delta")
        if thickness is not None:
            in_delta = vtk_to_numpy(thickness) / delta[0, 0]
            least = in_delta[in_delta > 0.501].min(initial=8)
            line += (f"; minimum thickness of walls and gaps {'at least ' * bool(least > 7.99)}"
                     f"{least * delta[0, 0]:.4g}")
    return line


def volume_report(volume_name: str, loaded: LoadedVolume, filters: Filters, surface: Any,
                  finished: bool, seconds: tuple[float, float], reader_memory: float, mesh: Any,
                  warnings: Sequence[str]) -> str:
    """Return the report of a surface in JSON. `seconds` are run times of pyramid and surface,
    `reader_memory` is peak_memory() after reading, `mesh` a TetrahedralMesh or None."""
    properties = property_values(filters, lambda item: item.cls != "vtkLabelsToSurfaces")
    return finish({
        "input": input_summary(volume_name, loaded),
        "iso_value": number_of(filters.surface.GetIsoValue()),
        "upper_value": number_of(filters.surface.GetUpperValue()), "finished": finished,
        **surface_summary(surface), "component_features": component_features(surface),
        **tetrahedra_summary(mesh), "levels": level_summaries(filters.surface),
        "seconds": {"pyramid": seconds[0], "surface": seconds[1]},
        "memory": {"reader": reader_memory, "peak": peak_memory()}, "properties": properties},
        warnings)


def _numbers(values: Sequence[float]) -> list[Any]:
    return [number_of(float(value)) for value in values]
