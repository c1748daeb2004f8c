# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Labels of a label map: names, selection, list."""

from __future__ import annotations

import dataclasses
import math
import re
from argparse import Namespace
from collections import Counter
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np

from .errors import Failure
from .messages import Console, run
from .reading.tables import names_beside, read_label_names
from .reading.volume import Label, Volume, plain_name


@dataclasses.dataclass
class KnownLabel:
    """A label of the map."""
    label: int
    name: str  # `Label 3` if it has none
    voxels: int = 0
    color: tuple[float, ...] = (0.0, 0.0, 0.0)  # 0 to 1
    layer: int = 0  # index of its image
    box: tuple[int, ...] = (0, -1, 0, -1, 0, -1)  # first and last voxel along x, y, z
    file_name: str = ""  # unique, without suffix

    @property
    def is_named(self) -> bool:
        """Whether the label has a name besides its number."""
        return self.name != f"Label {self.label}"


# ---- Names ---------------------------------------------------------------------------------------

def set_label_names(image: Any, labels: Sequence[Label]) -> None:
    """Set the field data that vtkLabelsToSurfaces reads: label values and names, colours if all
    labels have one, layers if listed are several."""
    from vtkmodules.vtkCommonCore import vtkDoubleArray, vtkIntArray, vtkStringArray
    values, names, colors, layers = zip(*map(dataclasses.astuple, labels)) if labels else [()] * 4
    fields = image.GetFieldData()
    for name, array, items in (
            ("LabelValues", vtkIntArray(), values), ("LabelNames", vtkStringArray(), names),
            ("LabelColors", vtkDoubleArray(), np.ravel(colors) if all(colors) else ()),
            ("LabelLayers", vtkIntArray(), layers if any(layers) else ())):
        fields.RemoveArray(name)
        array.SetName(name)
        array.SetNumberOfComponents(3 if name == "LabelColors" else 1)
        for item in items:
            array.InsertNextValue(item)
        if len(items):
            fields.AddArray(array)


def name_labels(options: Namespace, volume: Volume, image: Any, console: Console) -> list[Label]:
    """Set the label names of an image and return them. Names of --label-names take precedence over
    those of the volume. If the volume has none, they are read from a file next to it."""
    names = volume.labels
    if options.label_names:
        new = {label.value: label for label in read_label_names(options.label_names)}
        names = [dataclasses.replace(label, name=new[label.value].name or label.name,
                                     color=new[label.value].color or label.color)
                 if label.value in new else label for label in names]
        names += [new[value] for value in sorted(new.keys() - {label.value for label in names})]
    elif not names and (options.labels or volume.array.dtype.kind in "iu"):
        outputs = filter(None, [*options.surfaces, options.report, options.write_volume])
        names, file, refused = names_beside(options.volume, outputs)
        if options.labels:
            for reason in refused:
                console.warn(f"{reason}; the file is ignored")
            console.info(f"label names are read from {file}" if file else "")
    set_label_names(image, names)
    return names


# ---- The labels of a map -------------------------------------------------------------------------

def layers_of(image: Any, names: Sequence[Label], component: int | None) -> list[Any]:
    """Return one image per layer, with label names: the image, its component, or all components
    with named labels. Raise Failure if listed is none."""
    from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
    from vtkmodules.vtkCommonDataModel import vtkImageData
    scalars = image.GetPointData().GetScalars()
    count = scalars.GetNumberOfComponents()
    if component is not None and component >= count:
        raise Failure(f"--component {component} is out of range; voxels have {count} components")
    if count == 1:
        set_label_names(image, names)
        return [image]
    chosen = sorted({label.layer for label in names if label.layer < count})
    chosen = chosen if component is None else [max(component, 0)]
    if not chosen:
        raise Failure(f"voxels have {count} components; choose the label component with "
                      "--component")
    layers = []
    for layer in chosen:
        one = vtkImageData()
        one.CopyStructure(image)
        array = numpy_to_vtk(np.ascontiguousarray(vtk_to_numpy(scalars)[:, layer]))
        array.SetName(scalars.GetName())
        one.GetPointData().SetScalars(array)
        set_label_names(one, [dataclasses.replace(label, layer=0) for label in names
                              if label.layer == layer])
        layers.append(one)
    return layers


def known_labels(layers: Sequence[Any], names: Sequence[Label], options: Namespace,
                 console: Console) -> tuple[list[KnownLabel], list[str]]:
    """Return the labels of the layers, and warnings. If a layer has too many labels, they are the
    numbers in --labels."""
    from . import vtkFiltersVolumic
    from .options import with_option_names
    from .writing.meshers import DistinctNames
    known: list[KnownLabel] = []
    warnings: list[str] = []
    for number, layer in enumerate(layers):
        table = vtkFiltersVolumic.vtkLabelTable()
        table.SetInputData(layer)
        try:
            warnings += run(table, "", Console(quiet=True), with_option_names).warnings
        except Failure:
            parts = ",".join(options.labels).split(",")
            if len(layers) > 1 or options.list_labels or not all(
                    re.fullmatch(r" *[+-]?\d{1,9} *", part) for part in parts):
                raise
            texts = {label.value: label.name for label in names if label.name}
            known = [KnownLabel(value, texts.get(value, f"Label {value}"))
                     for value in sorted(set(map(int, parts)))]
            break
        labels, texts, voxels, colors, boxes = map(table.GetOutput().GetColumnByName, (
            "Label", "Name", "Voxels", "Color", "Extent"))
        known += [KnownLabel(labels.GetValue(row), texts.GetValue(row), voxels.GetValue(row),
                             colors.GetTuple(row), number, tuple(map(int, boxes.GetTuple(row))))
                  for row in range(table.GetOutput().GetNumberOfRows())]
    for text in warnings:
        console.warn(f"{options.volume}: {text}")
    files = [(safe_name(label.name) if label.is_named else "") or f"label-{label.label}"
             for label in known]
    uses, distinct = Counter(map(str.lower, files)), DistinctNames("-", str)
    for label, name in zip(known, files):
        label.file_name = distinct.take(
            f"{name}-{label.label}" if uses[name.lower()] > 1 else name)
    return known, warnings


def safe_name(name: str) -> str:
    """Return a name reduced to 120 bytes of characters that are valid in all file systems."""
    name = re.sub(r"""[\x00- \x7f/\\:*?"<>|'`$&;!%]""", "_", name).lstrip("._-~ ").rstrip("._ ")
    is_device = re.fullmatch("con|prn|aux|nul|(com|lpt)[1-3]", name.lower())
    return name.encode()[:120].decode(errors="ignore") + ("_" if is_device else "")


# ---- The choice ----------------------------------------------------------------------------------

def choose(texts: Iterable[str], known: Sequence[KnownLabel], background: int) -> list[KnownLabel]:
    """Return the labels selected by --labels: `all`, numbers, ranges such as 7-9, and names with
    the wildcard *, separated by commas. The background is selected only by its number or full name.
    Raise Failure if a text other than `all` selects none."""
    chosen: set[int] = set()
    for text in texts:
        # A name may contain commas.
        parts = [text] if _found(text, known, background) else text.split(",")
        for part in map(str.strip, parts):
            found = _found(part, known, background)
            if not found and part.lower() != "all":
                listed = [f"{label.label} {label.name}" if label.is_named else str(label.label)
                          for label in known]
                raise Failure(f"no label matches '{part}' (--labels); the labels are "
                              + (", ".join(listed) or "none"))
            chosen.update(map(id, found))
    return [label for label in known if id(label) in chosen]


def _found(text: str, known: Sequence[KnownLabel], background: int) -> list[KnownLabel]:
    """Return the labels that match a text: by number, name, name in any case, or range and pattern;
    the first of these that matches any."""
    numbers = re.fullmatch(r"([+-]?\d+)(?:-([+-]?\d+))?", text)  # also -9--7
    first, last = (int(numbers[1]), int(numbers[2] or numbers[1])) if numbers else (1, 0)
    name = re.compile(".*".join(map(re.escape, text.split("*"))), re.DOTALL | re.IGNORECASE)
    criteria = (lambda label: first == last == label.label, lambda label: label.name == text,
                lambda label: label.name.lower() == text.lower(),
                lambda label: label.label != background and (
                text.lower() == "all" or first <= label.label <= last
                or ("*" in text and label.is_named and name.fullmatch(label.name))))
    return next(filter(None, (list(filter(criterion, known)) for criterion in criteria)), [])


# ---- The list ------------------------------------------------------------------------------------

def list_rows(labels: Iterable[KnownLabel], spacing: Sequence[float]) -> list[dict[str, Any]]:
    """Return the entries of --list-labels in the report; volumes are in cubic world units."""
    return [{"label": label.label, "name": label.name, "color": label.color, "layer": label.layer,
             "voxels": label.voxels, "volume": label.voxels * math.prod(spacing),
             "box": label.box} for label in labels]


def table_of(labels: Iterable[KnownLabel], spacing: Sequence[float], layers: int) -> str:
    """Return the table that --list-labels prints."""
    line = ("{label:>10}  {voxels:>11}  {volume:>13}  " + "{layer:>5}  " * (layers > 1)
            + "{box:<37}  {name}\n")
    heading = {name: name for name in ("label", "voxels", "volume", "layer", "name")}
    text = line.format(**heading, box="box (first..last voxel along i, j, k)")
    for row in list_rows(labels, spacing):
        row["volume"] = np.format_float_positional(row["volume"], 6, fractional=False, trim="-")
        row["box"] = " ".join("{}..{}".format(*row["box"][i:i + 2]) for i in (0, 2, 4))
        text += line.format(**{**row, "name": plain_name(row["name"])})
    return text
