# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The report of a run as JSON: the volume, the surface, its components and levels, times, memory,
properties, warnings, versions. Lengths, areas and volumes are in world units."""

from __future__ import annotations

import json
import math
import os
import resource
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy

from .geometry import LoadedVolume, fact
from .option_tables import PROPERTIES, Filters, Property

SURFACE_FACTS = {
    "components": "NumberOfComponents", "genus": "Genus",
    "euler_characteristic": "EulerCharacteristic", "area": "Area", "volume": "Volume",
    "delta": "Delta", "unit": "Unit", "level": "Level", "iterations": "Iterations",
    "lost_parts": "LostParts", "recovered_parts": "RecoveredParts",
    "lost_cavities": "LostCavities", "recovered_cavities": "RecoveredCavities",
    "missing_parts": "MissingParts", "missing_boundary": "MissingBoundary",
    "wrong_voxels": "WrongVoxels", "volume_error": "VolumeError", "missed_voxels": "MissedVoxels",
    "parts": "Parts", "wrong_parts": "WrongParts"}
INTERFACE_FACTS = {"small_contacts": "SmallContacts", "worst_angle": "WorstAngle",
                   "worst_angle_position": "WorstAnglePosition"}
COMPONENT_FACTS = {"area": "ComponentArea", "volume": "ComponentVolume", "genus": "ComponentGenus",
                   "centroid": "ComponentCentroid", "inertia": "ComponentInertia"}


def peak_memory() -> float:
    """The most memory that was resident so far, MiB."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024


def number_of(value: float) -> Any:
    """A number as JSON has it: whole ones without a dot, null where it is none."""
    return None if not math.isfinite(value) else int(value) if value == int(value) else value


def values_of(data: Any, name: str) -> np.ndarray | None:
    """The numbers of an array of the field data, tuples x components; None if there is none."""
    array = data.GetFieldData().GetArray(name)
    return None if array is None else vtk_to_numpy(array).astype(float).reshape(
        -1, array.GetNumberOfComponents())


def facts_of(data: Any, names: dict[str, str]) -> dict[str, Any]:
    """Members for arrays of the field data, {member: name of the array}, if there are any."""
    found = {name: values_of(data, array) for name, array in names.items()}
    return {name: number_of(values[0, 0]) if values.shape[1] == 1 else _numbers(values[0])
            for name, values in found.items() if values is not None and values.size}


def stop_reason(surface: Any) -> str:
    """The field data `StopReason`."""
    return fact(surface, "StopReason")


def input_facts(name: str, loaded: LoadedVolume) -> dict[str, Any]:
    """The member `input`: what the volume is."""
    image, world = loaded.image, loaded.world
    facts = {"name": os.path.basename(os.path.normpath(name)),
             "dimensions": list(image.GetDimensions()), "spacing": _numbers(image.GetSpacing()),
             "origin": _numbers(image.GetOrigin()), "space": world.space, "unit": world.unit,
             "file_space": world.file_space, "file_unit": world.file_unit,
             "scale": number_of(world.scale), "scalar_type": image.GetScalarTypeAsString(),
             "range": _numbers(loaded.range)}
    resampling = fact(image, "Resampling")
    return {**facts, "resampling": resampling} if resampling else facts


def surface_facts(surface: Any) -> dict[str, Any]:
    """Members of the size and shape of a surface, from its field data and its cells."""
    return {**facts_of(surface, SURFACE_FACTS), "vertices": surface.GetNumberOfPoints(),
            "triangles": surface.GetNumberOfPolys(), "stop_reason": stop_reason(surface)}


def component_features(surface: Any) -> list[dict[str, Any]]:
    """The member `component_features`: an object per component, the largest area first."""
    columns = {name: values_of(surface, array) for name, array in COMPONENT_FACTS.items()}
    columns = {name: values.squeeze(1) if values.shape[1] == 1 else values
               for name, values in columns.items() if values is not None}
    return [{name: number_of(values[i]) if values.ndim == 1 else _numbers(values[i])
             for name, values in columns.items()} for i in range(len(columns.get("area", ())))]


def solid_facts(solid: Any) -> dict[str, Any]:
    """The member `solid`, where tetrahedra were made."""
    if solid is None or solid.grid is None:
        return {}
    return {"solid": {
        "mesher": solid.mesher, "nodes": solid.grid.GetNumberOfPoints(),
        "tetrahedra": solid.grid.GetNumberOfCells(), "least_angle": solid.least_angle,
        "percent_angle": solid.percent_angle,
        "regions": [{"label": label, "name": solid.names.get(label, ""), "tetrahedra": count,
                     "volume": number_of(volume)}
                    for label, (count, volume) in solid.regions.items()]}}


def text_of_solid(solid: Any) -> str:
    """What tetrahedra are like, in a line; empty where there are none."""
    if solid is None or solid.grid is None:
        return ""
    return (f"{solid.grid.GetNumberOfCells()} tetrahedra by {solid.mesher}; least dihedral angle "
            f"{solid.least_angle:.1f} degrees, 1 % of the tetrahedra have less than "
            f"{solid.percent_angle:.1f}")


def property_values(filters: Filters, applies: Callable[[Property], bool]) -> dict[str, str]:
    """The member `properties`: the values of those that apply."""
    return {item.name: item.get(filters) for item in PROPERTIES if applies(item)}


def level_facts(surface: Any) -> list[dict[str, Any]]:
    """The member `levels`: the visited levels of the filter, from the coarsest to the finest."""
    rows, blocks, levels = surface.GetHistory().GetRowData(), surface.GetLevels(), []
    has_rows = surface.GetHistory().GetNumberOfRows() > 0
    level, seconds = (vtk_to_numpy(rows.GetArray(name)) if has_rows else np.zeros(0)
                      for name in ("Level", "Seconds"))
    for block in map(blocks.GetBlock, range(blocks.GetNumberOfBlocks())):
        if block is not None:
            facts = surface_facts(block)
            levels.append({**facts, "seconds": float(seconds[level == facts["level"]].sum())})
    return sorted(levels, key=lambda facts: -facts["level"])


def ended(report: dict[str, Any], warnings: Sequence[str]) -> str:
    """The report with the members `warnings` and `versions`, as text."""
    from vtkmodules.vtkCommonCore import vtkVersion
    from . import __version__
    report["warnings"] = list(warnings)
    report["versions"] = {"volumic": __version__, "vtk": vtkVersion.GetVTKVersion()}
    return json.dumps(report, indent=2, ensure_ascii=False, allow_nan=False) + "\n"


def text_of_print(printed: bool, surfaces: Sequence[Any], unit: str) -> str:
    """For .3mf: the size of the print, and its thinnest wall if --thin-parts measured it."""
    surfaces = [surface for surface in surfaces if surface.GetNumberOfPoints() > 0]
    if not printed or not surfaces:
        return ""
    bounds = np.array([surface.GetBounds() for surface in surfaces])
    lengths = bounds[:, 1::2].max(axis=0) - bounds[:, ::2].min(axis=0)
    walls = [surface.GetPointData().GetArray("Thickness") for surface in surfaces]
    walls = [wall.GetRange()[0] for wall in walls if wall is not None]
    return ("the print is " + " x ".join(f"{length:.4g}" for length in lengths)
            + f" {unit or 'mm'}" + (f"; its thinnest wall has {min(walls):.4g}" if walls else ""))


def of_volume(volume_name: str, loaded: LoadedVolume, filters: Filters, surface: Any,
              finished: bool, seconds: tuple[float, float], reader_memory: float, solid: Any,
              warnings: Sequence[str]) -> str:
    """The report of a surface. `surface` is as it is written, seconds are those of the pyramid and
    of the surface, reader_memory is peak_memory() when the volume had been read."""
    properties = property_values(filters, lambda item: item.cls != "vtkLabelsToSurfaces")
    return ended({
        "input": input_facts(volume_name, loaded),
        "iso_value": number_of(filters.surface.GetIsoValue()),
        "upper_value": number_of(filters.surface.GetUpperValue()), "finished": finished,
        **surface_facts(surface), "component_features": component_features(surface),
        **solid_facts(solid), "levels": level_facts(filters.surface),
        "seconds": {"pyramid": seconds[0], "surface": seconds[1]},
        "memory": {"reader": reader_memory, "peak": peak_memory()}, "properties": properties},
        warnings)


def _numbers(values: Sequence[float]) -> list[Any]:
    return [number_of(float(value)) for value in values]
