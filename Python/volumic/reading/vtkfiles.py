# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""VTK images: .vti, .pvti and .vtr; .vtk and .vtkhdf by VTK's readers in a worker process."""
from __future__ import annotations

import math
import os
import re

import numpy as np

from ..errors import VolumeError
from .grid import make_volume
from .volume import Label, prefix_errors, unit_of
from .vtkxml import XmlFile
from .worker import in_worker

_ADVICE = ", not an image; convert it, for example by ParaView's filter Resample To Image"


def read_xml(path, choice):
    file = XmlFile(path)
    if file.kind not in ("ImageData", "PImageData", "RectilinearGrid"):
        raise VolumeError("the file has %s%s" % (file.kind or "no VTK data", _ADVICE))
    whole = _extent(file.grid, "WholeExtent")
    sizes = whole[1::2] - whole[::2] + 1
    files = [_piece(path, piece) for piece in file.pieces] if file.kind[0] == "P" else [file]
    if not files or not file.pieces:
        raise VolumeError("the image is empty")
    parent, name = choose_array(
        {p: [a["name"] for a in files[0].arrays if a["parent"] == p and a["piece"] == 0]
         for p in ("PointData", "CellData")}, files[0].pieces[0], choice.array)
    parts = [part for each in files for part in _parts(each, parent, name)]
    array = parts[0][1]
    if len(parts) > 1 or array.shape[:3] != _shape(sizes, parent):
        array = _joined(parts, whole, _shape(sizes, parent))
    if file.kind == "RectilinearGrid":
        lines = [a for a in file.arrays if a["parent"] == "Coordinates"]
        steps, origin = _regular([file.read(a, int(n)) for a, n in zip(lines, sizes)], whole)
    else:
        grid = {**files[0].grid, **file.grid}  # VTK 9.1 writes Direction to pieces only
        spacing, origin, axes = ([float(n) for n in grid.get(key, default).split()]
                                 for key, default in (("Spacing", "1 1 1"), ("Origin", "0 0 0"),
                                                      ("Direction", "1 0 0 0 1 0 0 0 1")))
        steps = np.reshape(axes, (3, 3)) * spacing
    fields = {}
    for each in files[0].arrays:
        if each["parent"] == "FieldData":
            values = files[0].read(each)
            fields[each["name"]] = (
                bytes(values.view("u1")).decode("utf-8", "replace").split("\0")
                if each["type"] == "String" else
                values.reshape(-1, int(each.get("NumberOfComponents", 1))))
    return _volume(array, parent, steps, origin, fields, choice, name, whole)


def choose_array(names, active, requested):
    """Return "PointData" or "CellData", and the name of the array to read."""
    for parent in ("PointData", "CellData"):
        found = [name for name in names[parent] if name != "vtkGhostType"]
        name = requested or active.get(parent) or (found[0] if len(found) == 1 else None)
        if name in found:
            return parent, name
        if found and not requested:
            break
    listed = ", ".join(names["PointData"])
    text = "no point array " + requested if requested else "the volume has no active scalars"
    raise VolumeError("%s; choose one of the point arrays with --array: %s" % (text, listed)
                      if listed else "the volume has no point arrays")


def _shape(sizes, parent):
    """Return the shape [z, y, x] of values of points or cells."""
    return tuple(int(n) for n in np.maximum(sizes - (parent == "CellData"), 1)[::-1])


def _extent(element, key):
    extent = np.array([int(n) for n in element.get(key, "").split()])
    if len(extent) != 6 or (extent[1::2] < extent[::2]).any() or np.abs(extent).max() >= 1 << 31:
        raise VolumeError("invalid header or empty image: %s is \"%s\""
                          % (key, element.get(key, "")))
    return extent


def _piece(path, piece):
    name = piece.get("Source", "")
    with prefix_errors(name[:200]):
        file = XmlFile(os.path.join(os.path.dirname(path), name))
        if file.kind != "ImageData" or not file.pieces:
            raise VolumeError("not an image")
        return file


def _parts(file, parent, name):
    """Return extent and values [z, y, x, component] of an array in each piece of a file."""
    parts = []
    for number, piece in enumerate(file.pieces):
        extent = _extent(piece, "Extent")
        array = next((a for a in file.arrays if a["piece"] == number and a["parent"] == parent
                      and a["name"] == name), None)
        if array is None:
            raise VolumeError("a piece has no array " + name)
        shape = _shape(extent[1::2] - extent[::2] + 1, parent)
        count = int(array.get("NumberOfComponents", 1))
        values = file.read(array, math.prod(shape) * count)
        parts.append((extent, values.reshape(*shape, count)))
    return parts


def _joined(parts, whole, shape):
    """Return the values of all pieces as one array."""
    count = parts[0][1].shape[3]
    if sum(values.size for _, values in parts) < math.prod(shape) * count:
        raise VolumeError("the pieces do not cover the image")
    result, covered = np.empty((*shape, count), parts[0][1].dtype), np.zeros(shape, bool)
    for extent, values in parts:
        begin = (extent[::2] - whole[::2])[::-1]
        region = tuple(slice(a, a + n) for a, n in zip(begin, values.shape))
        if (begin < 0).any() or (*covered[region].shape, count) != values.shape:
            raise VolumeError("invalid header: a piece is outside the image")
        result[region], covered[region] = values, True
    if not covered.all():
        raise VolumeError("the pieces do not cover the image")
    return result


def _regular(lines, whole):
    """Return steps and origin of a rectilinear grid with uniform spacing."""
    gaps = [np.diff(line.astype(float)) for line in lines]
    if len(lines) != 3 or any(len(gap) and np.ptp(gap) > 1e-3 * abs(gap.mean()) for gap in gaps):
        raise VolumeError("the file has a rectilinear grid of variable spacing" + _ADVICE)
    steps = [gap.mean() if len(gap) else 1. for gap in gaps]
    return np.diag(steps), [line[0] - s * n for line, s, n in zip(lines, steps, whole[::2])]


def _volume(array, parent, steps, origin, fields, choice, name, whole):
    """Return the Volume. Space, unit and labels are in field data written by the command."""
    cells = .5 * (whole[1::2] > whole[::2]) * (parent == "CellData")
    space, unit = (str(fields[key][0]) if len(fields.get(key, ())) else "" for key in
                   ("Axes", "LengthUnit"))
    values = np.ravel(fields.get("LabelValues", ()))
    names, colors, layers = (
        fields[key] if key in fields and len(fields[key]) >= len(values) else None
        for key in ("LabelNames", "LabelColors", "LabelLayers"))
    if colors is not None and colors.dtype == np.uint8:
        colors = colors / 255.
    labels = [Label(int(value), "" if names is None else str(names[i]),
                    None if colors is None else tuple(map(float, colors[i])),
                    0 if layers is None else int(layers[i][0]))
              for i, value in enumerate(values) if abs(value) < 1 << 31]
    array = array[..., 0] if array.shape[3] == 1 else np.moveaxis(array, 3, 0)
    return make_volume(array, steps, np.array(origin) + steps @ cells,
                       space if re.fullmatch("[LRAPSI]{3}", space) else "", unit_of(unit), choice,
                       labels=labels, name=name, components="vector" if array.ndim == 4 else "",
                       start=tuple(whole[::2].tolist()))


def read_by_vtk(path, choice):
    found = in_worker("volumic.reading.vtkfiles:load", path, choice.array)
    array, parent, steps, origin, fields, name, whole = found
    return _volume(array, parent, steps, origin, fields, choice, name, whole)


def load(path, requested):
    """Return the arguments of _volume(), read by VTK, in the worker."""
    from vtkmodules.util.numpy_support import vtk_to_numpy
    with open(path, "rb") as stream:
        if stream.read(4) == b"\x89HDF":
            from vtkmodules.vtkIOHDF import vtkHDFReader as Reader
        else:
            from vtkmodules.vtkIOLegacy import vtkDataSetReader as Reader
    image = updated(Reader(), path)
    kind = image.GetClassName()[3:]
    if kind not in ("StructuredPoints", "ImageData", "RectilinearGrid"):
        raise VolumeError("the file has %s%s" % (kind, _ADVICE))
    data = {"PointData": image.GetPointData(), "CellData": image.GetCellData()}
    parent, name = choose_array(
        {p: [each.GetArrayName(n) or "" for n in range(each.GetNumberOfArrays())]
         for p, each in data.items()},
        {p: each.GetScalars().GetName() for p, each in data.items() if each.GetScalars()},
        requested)
    whole = np.array(image.GetExtent())
    array = vtk_to_numpy(data[parent].GetArray(name)).reshape(
        *_shape(np.array(image.GetDimensions()), parent), -1)
    if kind == "RectilinearGrid":
        steps, origin = _regular([vtk_to_numpy(line) for line in (
            image.GetXCoordinates(), image.GetYCoordinates(), image.GetZCoordinates())], whole)
    else:
        matrix = image.GetDirectionMatrix()
        steps = np.array([[matrix.GetElement(r, c) for c in range(3)] for r in range(3)])
        steps, origin = steps * image.GetSpacing(), image.GetOrigin()
    fields, field = {}, image.GetFieldData()
    for each in (field.GetAbstractArray(n) for n in range(field.GetNumberOfArrays())):
        fields[each.GetName()] = ([each.GetValue(n) for n in range(each.GetNumberOfValues())]
                                  if each.IsA("vtkStringArray") else vtk_to_numpy(each).reshape(
                                      -1, each.GetNumberOfComponents()))
    return np.ascontiguousarray(array), parent, steps, origin, fields, name, whole


def updated(reader, path):
    """Return the output of a VTK reader. Raise VolumeError if the reader reports an error."""
    from vtkmodules.vtkCommonCore import vtkOutputWindow, vtkStringOutputWindow
    window = vtkStringOutputWindow()
    vtkOutputWindow.SetInstance(window)
    reader.SetFileName(path)
    reader.Update()
    output = reader.GetOutputDataObject(0)
    errors = [" ".join(re.sub(r"^[^\n]*\n(\w+ \(0x\w+\): )?", "", text).split()) for text in
              re.split("(?m)^(?=ERROR|Warning|Generic)", window.GetOutput())
              if text[:7] in ("ERROR: ", "Generic") and "InformationKey" not in text]  # NaN ranges
    if errors or output is None or not output.GetNumberOfPoints():
        reasons = [e for e in errors if not re.search("returned failure|did not create output", e)]
        raise VolumeError("VTK cannot read the file: " + (reasons or ["no data"])[0][-200:])
    return output
