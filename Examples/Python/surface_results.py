# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The files and the report of a run of vtkDeformableSurface, all from the filter's outputs."""

import json
import os

from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkVersion
from vtkmodules.vtkIOCore import vtkDelimitedTextWriter
from vtkmodules.vtkIOGeometry import vtkOBJWriter, vtkSTLWriter
from vtkmodules.vtkIOPLY import vtkPLYWriter
from vtkmodules.vtkIOXML import vtkXMLMultiBlockDataWriter, vtkXMLPolyDataWriter

from output_files import (
    check_end, check_lines, check_ply, check_size, write_text, write_with)

# Names in the report and in the field data of a surface.
FACTS = {
    "components": "NumberOfComponents", "genus": "Genus",
    "euler_characteristic": "EulerCharacteristic", "area": "Area", "volume": "Volume",
    "delta": "Delta", "unit": "Unit",
    "level": "Level", "iterations": "Iterations", "lost_parts": "LostParts",
    "recovered_parts": "RecoveredParts", "missing_parts": "MissingParts",
    "missing_boundary": "MissingBoundary", "lost_cavities": "LostCavities",
    "recovered_cavities": "RecoveredCavities", "remaining_contacts": "RemainingContacts",
    "contact_vertices": "ContactVertices",
}
COMPONENT_FACTS = {
    "area": "ComponentArea", "volume": "ComponentVolume", "genus": "ComponentGenus",
    "centroid": "ComponentCentroid", "inertia": "ComponentInertia",
}


def check_xml(path):
    """Whether VTK's XML file is whole, and those of its blocks, in the folder of its name."""
    check_end(path, b"</VTKFile>")
    pieces = os.path.splitext(path)[0]
    if os.path.isdir(pieces):
        check_end(pieces, b"</VTKFile>")


def write_blocks(blocks, path):
    """A .vtm file and, in a folder beside it, a file for each block."""
    write_with(vtkXMLMultiBlockDataWriter(), blocks, path, check_xml)


def stl_writer():
    writer = vtkSTLWriter()
    writer.SetFileTypeToBinary()
    writer.SetHeader("Volumic: closed surface in world coordinates".ljust(80))
    return writer


# Suffix of a file of triangles, and what writes it.
SURFACE_WRITERS = {".stl": stl_writer, ".ply": vtkPLYWriter, ".obj": vtkOBJWriter,
                   ".vtp": vtkXMLPolyDataWriter}


def check_surface(surface, path):
    """Whether the file has all that the surface is made of."""
    points, triangles = surface.GetNumberOfPoints(), surface.GetNumberOfPolys()
    normals = points if surface.GetPointData().GetNormals() else 0
    {".stl": lambda: check_size(path, 84 + 50 * triangles),
     ".ply": lambda: check_ply(path),
     ".obj": lambda: check_lines(path, 1 + points + normals + triangles),
     ".vtp": lambda: check_xml(path)}[os.path.splitext(path)[1].lower()]()


def write_surface(surface, path):
    """In the format that the suffix tells, one of SURFACE_WRITERS."""
    write_with(SURFACE_WRITERS[os.path.splitext(path)[1].lower()](), surface, path,
               lambda written: check_surface(surface, written))


def write_history(history, path):
    """A .csv file with a line per iteration."""
    writer = vtkDelimitedTextWriter()
    writer.SetFieldDelimiter(",")
    write_with(writer, history, path,
               lambda written: check_lines(written, 1 + history.GetNumberOfRows()))


def write_report(report, path):
    write_text(json.dumps(report, indent=2, allow_nan=False) + "\n", path)


def plain(value):
    """A number, or a list of them, as JSON shows it best: whole ones without a point."""
    if isinstance(value, (list, tuple)):
        return [plain(v) for v in value]
    return int(value) if float(value).is_integer() else float(value)


def input_facts(image, name):
    """What the surface was made from."""
    return {
        "name": name,
        "dimensions": list(image.GetDimensions()),
        "spacing": list(image.GetSpacing()),
        "origin": list(image.GetOrigin()),
        "scalar_type": image.GetPointData().GetScalars().GetDataTypeAsString(),
        "range": plain(image.GetScalarRange()),
    }


def surface_facts(surface):
    """Size and shape of a surface from its field data, in world units (mm, mm^2, mm^3 in medicine).
    """
    fields = surface.GetFieldData()
    facts = {name: plain(fields.GetArray(array).GetTuple1(0)) for name, array in FACTS.items()}
    return {
        **facts,
        "vertices": surface.GetNumberOfPoints(),
        "triangles": surface.GetNumberOfPolys(),
        "stop_reason": fields.GetAbstractArray("StopReason").GetValue(0),
    }


def surface_line(surface):
    """Size and shape in a line for the terminal."""
    facts = surface_facts(surface)
    return (f"level {facts['level']}, {facts['stop_reason']}: {facts['vertices']:,} vertices,"
            f" components {facts['components']}, genus {facts['genus']}, area {facts['area']:,.1f},"
            f" volume {facts['volume']:,.1f}")


def component_facts(surface):
    """One entry for each component, the one of the largest area first.

    The inertia is xx, yy, zz, xy, yz, xz about the centroid; a cavity has a negative volume.
    """
    arrays = {name: vtk_to_numpy(surface.GetFieldData().GetArray(array))
              for name, array in COMPONENT_FACTS.items()}
    return [{name: plain(values[c].tolist()) for name, values in arrays.items()}
            for c in range(len(arrays["area"]))]


def level_facts(levels, history):
    """One entry for each visited level, coarsest first, also where nothing was left of the surface.

    The seconds that the levels took, as the history tells them, add up to those of the run.
    """
    blocks = [levels.GetBlock(b) for b in range(levels.GetNumberOfBlocks())]
    number = vtk_to_numpy(history.GetColumnByName("Level"))
    seconds = sum(vtk_to_numpy(history.GetColumnByName(name))
                  for name in ("SecondsBefore", "Seconds", "SecondsAfter"))
    facts = [surface_facts(surface) for surface in blocks if surface is not None]
    for level in facts:
        level["seconds"] = float(seconds[number == level["level"]].sum())
    return sorted(facts, key=lambda level: -level["level"])


def versions():
    from volumic import __version__  # pylint: disable=import-outside-toplevel
    return {"volumic": __version__, "vtk": vtkVersion.GetVTKVersion()}


def summary_lines(report):
    """The report in a few lines for the terminal."""
    lines = [f"  {'level':>5} {'vertices':>9} {'components':>10} {'genus':>5} {'iterations':>10}"
             f" {'seconds':>8}  stopped"]
    for level in report["levels"]:
        lines.append(f"  {level['level']:>5} {level['vertices']:>9,} {level['components']:>10}"
                     f" {level['genus']:>5} {level['iterations']:>10} {level['seconds']:>8.2f}"
                     f"  {level['stop_reason']}")
    lines.append(f"  area {report['area']:,.1f}, enclosed volume {report['volume']:,.1f}, delta"
                 f" {report['delta']:.3g} (world units)")
    return lines
