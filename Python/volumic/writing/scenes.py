# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Files with several named and coloured surfaces: .glb (Khronos Group: glTF 2.0) and .3mf (3MF
Consortium: Core Specification 1.3)."""

from __future__ import annotations

import io
import json
import struct
import zipfile
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from ..errors import Failure
from .regions import SurfaceLabel, cell_array, points_of, surface_labels, triangles_of
from .surfaces import Show, bytes_of, escaped, lines, numbers, packed, silent

Objects = Sequence[tuple[str, Any]]  # names and non-empty surfaces

FLOAT, UNSIGNED, VERTICES, CORNERS = 5126, 5125, 34962, 34963  # OpenGL constants
GRAY, LIGHT_GRAY = (0.8, 0.8, 0.8), (0.9, 0.9, 0.9)  # colours of surfaces without labels


# ---- .glb --------------------------------------------------------------------------------------

def glb(objects: Objects, show: Show = silent) -> Iterator[bytes]:
    """Yield a glTF scene: a node and a mesh per surface, a material per label, normals.

    VTK's glTF writers omit names or require a window. Vertices are relative to the centre of the
    scene, in single precision, so that shared vertices stay equal. The root node translates them
    back and rotates z to y, which is up in glTF.
    """
    from .. import __version__
    bounds = np.reshape([surface.GetBounds() for _, surface in objects], (-1, 3, 2))
    center = (bounds[:, :, 0].min(axis=0) + bounds[:, :, 1].max(axis=0)) / 2
    x, y, z = center.tolist()
    half = float(np.sqrt(0.5))  # quaternion of a rotation by -90 degrees about x
    scene: dict[str, Any] = {
        "asset": {"version": "2.0", "generator": f"volumic {__version__}"}, "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"children": list(range(1, len(objects) + 1)),
                   "rotation": [-half, 0.0, 0.0, half], "translation": [x, z, -y]}],
        "meshes": [], "materials": [], "accessors": [], "bufferViews": [],
        "buffers": [{"byteLength": 0}]}
    arrays: list[np.ndarray] = []
    for i, (name, surface) in enumerate(objects):
        show(i / len(objects))
        _add_surface(scene, arrays, name, surface, center)
    text = (json.dumps(scene, separators=(",", ":"), ensure_ascii=False) + "\n").encode()
    text += b" " * (-len(text) % 4)
    size = scene["buffers"][0]["byteLength"]
    if 28 + len(text) + size >= 1 << 32:
        raise Failure("cannot be written (.glb is limited to 4 GiB; write fewer or coarser "
                      "surfaces, or .vtp)")
    yield struct.pack("<4sIII4s", b"glTF", 2, 28 + len(text) + size, len(text), b"JSON") + text
    yield struct.pack("<I4s", size, b"BIN\0")
    yield from (array.tobytes() for array in arrays)


def _add_surface(scene: dict[str, Any], arrays: list[np.ndarray], name: str, surface: Any,
                 center: np.ndarray) -> None:
    """Add a node and a mesh, with the materials and arrays that they refer to."""
    from ..geometry import field_text

    def add(array: np.ndarray, target: int, kind: int, **limits: Any) -> int:
        buffer = scene["buffers"][0]
        scene["accessors"].append({
            "bufferView": len(arrays), "byteOffset": 0, "componentType": kind, "count": len(array),
            "type": "VEC3" if array.ndim == 2 else "SCALAR", **limits})
        scene["bufferViews"].append({"buffer": 0, "byteOffset": buffer["byteLength"],
                                     "byteLength": array.nbytes, "target": target})
        buffer["byteLength"] += array.nbytes
        arrays.append(array)
        return len(arrays) - 1

    labels = surface_labels(surface)
    extras = {key: field_text(surface, key) for key in ("SPACE", "LengthUnit")}
    extras = {key: text for key, text in extras.items() if text}
    scene["nodes"].append({"name": name, "mesh": len(scene["meshes"]), "extras": {
        "labels": [label.number for label in labels],
        "stop_reason": field_text(surface, "StopReason"), **extras}})
    points = (points_of(surface) - center).astype("<f4")
    attributes = {"POSITION": add(points, VERTICES, FLOAT, min=points.min(axis=0).tolist(),
                                  max=points.max(axis=0).tolist())}
    normals, parts = numbers(surface.GetPointData().GetNormals()), []
    if normals is not None:
        attributes["NORMAL"] = add(normals.astype("<f4"), VERTICES, FLOAT)
    known = {label.number: label for label in labels}
    triangles, of_label = triangles_of(surface).astype("<u4"), cell_array(surface, "Label")
    of_label = np.zeros(len(triangles)) if of_label is None else of_label
    for number in np.unique(of_label).tolist():
        corners = triangles[of_label == number].ravel()
        parts.append({"attributes": attributes, "indices": add(corners, CORNERS, UNSIGNED),
                      "material": len(scene["materials"])})
        label = known.get(number, SurfaceLabel(0, name, GRAY))
        linear = [part / 12.92 if part <= 0.04045 else ((part + 0.055) / 1.055) ** 2.4
                  for part in label.color]  # from sRGB
        scene["materials"].append({"name": label.name, "pbrMetallicRoughness": {
            "baseColorFactor": [*linear, 1.0], "metallicFactor": 0, "roughnessFactor": 0.6}})
    scene["meshes"].append({"name": name, "primitives": parts})


# ---- .3mf --------------------------------------------------------------------------------------
# All surfaces form one object, since slicers move objects separately, which would separate adjacent
# labels. PrusaSlicer ignores 3MF components and reads the parts of an object from its own file in
# the .3mf. For other programs, the triangles of each label have a material with its name.

XML = '<?xml version="1.0" encoding="UTF-8"?>\n'
PACKAGE = "http://schemas.openxmlformats.org/package/2006/"
TYPES = (f'{XML}<Types xmlns="{PACKAGE}content-types"><Default Extension="rels" ContentType="'
         'application/vnd.openxmlformats-package.relationships+xml"/><Default Extension="model" '
         'ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/><Default '
         'Extension="config" ContentType="text/xml"/></Types>\n')
RELATIONS = (f'{XML}<Relationships xmlns="{PACKAGE}relationships"><Relationship Id="model" '
             'Target="/3D/3dmodel.model" Type="http://schemas.microsoft.com/3dmanufacturing/2013/'
             '01/3dmodel"/></Relationships>\n')
MODEL = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02"
UNITS = {"": "millimeter", "mm": "millimeter", "cm": "centimeter", "m": "meter", "um": "micron"}
PART = ('<volume firstid="{0}" lastid="{1}"><metadata type="volume" key="name" value="{2}"/>'
        '<metadata type="volume" key="volume_type" value="ModelPart"/></volume>\n')


def three_mf(objects: Objects, show: Show = silent) -> Iterator[bytes]:
    """Yield a model for 3D printing, with a material per label."""
    from .. import __version__
    from ..geometry import field_text
    unit = field_text(objects[0][1], "LengthUnit")
    if unit not in UNITS:
        raise Failure(f"3MF does not support the unit {unit}; use --unit mm")
    labels = [surface_labels(surface) or [SurfaceLabel(0, name, LIGHT_GRAY)]
              for name, surface in objects]
    materials = [label for own in labels for label in own]
    bases = "".join(f'<base name="{escaped(label.name)}" displaycolor="#%02X%02X%02X"/>'
                    % bytes_of(label.color) for label in materials)
    name = escaped(objects[0][0] if len(objects) == 1 else "labels")
    vertices, triangles, parts = [], [], ""
    points = polygons = first_material = 0
    for (part, surface), own in zip(objects, labels):
        vertices.append((lines('<vertex x="%.9g" y="%.9g" z="%.9g"/>\n'),
                         points_of(surface).astype(np.float32)))
        rows, of_label = triangles_of(surface) + points, cell_array(surface, "Label")
        form = '<triangle v1="%d" v2="%d" v3="%d"/>\n'
        if len(materials) > 1:
            material = np.full(len(rows), first_material)
            for k, label in enumerate(own if of_label is not None else ()):
                material[of_label == label.number] += k
            form, rows = form.replace("/", ' p1="%d"/'), np.column_stack([rows, material])
        triangles.append((lines(form), rows))
        parts += PART.format(polygons, polygons + len(rows) - 1, escaped(part))
        points += surface.GetNumberOfPoints()
        polygons += len(rows)
        first_material += len(own)
    content = io.BytesIO()
    with zipfile.ZipFile(content, "w", zipfile.ZIP_DEFLATED, compresslevel=6) as package:
        package.writestr(_entry("[Content_Types].xml"), TYPES)
        package.writestr(_entry("_rels/.rels"), RELATIONS)
        with package.open(_entry("3D/3dmodel.model"), "w") as model:
            model.write((
                f'{XML}<model unit="{UNITS[unit]}" xmlns="{MODEL}">\n<metadata name="Application">'
                f'volumic {__version__}</metadata>\n<resources>\n<basematerials id="1">{bases}'
                f'</basematerials>\n<object id="2" type="model" name="{name}" pid="1" pindex="0">'
                "<mesh><vertices>\n").encode())
            model.writelines(packed(lambda share: show(share / 2), *vertices))
            model.write(b"</vertices><triangles>\n")
            model.writelines(packed(lambda share: show((1 + share) / 2), *triangles))
            model.write(b'</triangles></mesh></object>\n</resources>\n<build><item objectid="2"/>'
                        b"</build>\n</model>\n")
        if len(objects) > 1:  # triangle ranges for PrusaSlicer
            package.writestr(_entry("Metadata/Slic3r_PE_model.config"), (
                f'{XML}<config>\n<object id="2"><metadata type="object" key="name" value="{name}"/>'
                f"\n{parts}</object>\n</config>\n"))
    yield content.getvalue()


def _entry(name: str) -> zipfile.ZipInfo:
    """Return an archive entry with a fixed date, so that files are reproducible."""
    entry = zipfile.ZipInfo(name)
    entry.compress_type, entry.external_attr = zipfile.ZIP_DEFLATED, 0o100644 << 16
    return entry
