# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The labels of a label map: their names, the choice among them, and the list of them."""

from __future__ import annotations

import dataclasses
import math
import re
from argparse import Namespace
from collections import Counter
from collections.abc import Iterable, Sequence
from typing import Any

from .errors import Failure
from .messages import Teller, run
from .reading.tables import names_beside, read_label_names
from .reading.volume import Label, Volume, plain_name

FIELDS = ("LabelValues", "LabelNames", "LabelColors", "LabelLayers")


@dataclasses.dataclass
class KnownLabel:
    """A label that the map has."""
    label: int
    name: str  # `Label 3` where it has none
    voxels: int = 0
    color: tuple[float, ...] = (0.0, 0.0, 0.0)  # 0 to 1
    layer: int = 0  # the image, of those of the map, that has it
    box: tuple[int, ...] = (0, -1, 0, -1, 0, -1)  # first and last voxel along x, y, z
    file_name: str = ""  # without suffix; differs from those of all other labels

    @property
    def is_named(self) -> bool:
        """Whether it has a name, not only a number."""
        return self.name != f"Label {self.label}"


# ---- Names ---------------------------------------------------------------------------------------

def set_label_names(image: Any, labels: Sequence[Label]) -> None:
    """Give an image names of labels, as vtkLabelsToSurfaces reads them, as field data.

    Colors are given only where all labels have one, `LabelLayers` where one is not in the first.
    """
    from vtkmodules.vtkCommonCore import vtkDoubleArray, vtkIntArray, vtkStringArray
    arrays = [vtkIntArray(), vtkStringArray(), vtkDoubleArray(), vtkIntArray()]
    arrays[2].SetNumberOfComponents(3)
    for label in labels:
        arrays[0].InsertNextValue(label.value)
        arrays[1].InsertNextValue(label.name)
        arrays[2].InsertNextTuple(label.color or (0.0, 0.0, 0.0))
        arrays[3].InsertNextValue(label.layer)
    needed = (bool(labels), bool(labels), bool(labels) and all(label.color for label in labels),
              any(label.layer > 0 for label in labels))
    for name, array, is_needed in zip(FIELDS, arrays, needed):
        array.SetName(name)
        image.GetFieldData().RemoveArray(name)
        if is_needed:
            image.GetFieldData().AddArray(array)


def name_labels(options: Namespace, volume: Volume, image: Any, teller: Teller) -> list[Label]:
    """Give the image of a volume the names of its labels, and return them: those of --label-names
    before its own; where it has none, those of a file beside it, which is reported with
    --labels."""
    names = volume.labels
    is_integer = volume.array.dtype.kind in "iu"
    if options.label_names:
        names = _merged(names, read_label_names(options.label_names))
    elif not names and (options.labels or is_integer):
        outputs = filter(None, [*options.surfaces, options.report, options.write_volume])
        names, file, refused = names_beside(options.volume, outputs)
        for reason in refused if options.labels else ():
            teller.warn(f"{reason}; this file is skipped")
        if file and options.labels:
            teller.say(f"names of labels are those of {file}")
    set_label_names(image, names)
    return names


def _merged(names: list[Label], others: list[Label]) -> list[Label]:
    """The names; those of `others` replace those of the same value in all layers."""
    new = {label.value: label for label in others}
    merged = [dataclasses.replace(label, name=new[label.value].name or label.name,
                                  color=new[label.value].color or label.color)
              if label.value in new else label for label in names]
    known = {label.value for label in names}
    return merged + [label for label in others if label.value not in known]


# ---- The labels of a map -------------------------------------------------------------------------

def layers_of(image: Any, names: Sequence[Label], component: int | None) -> list[Any]:
    """Images of one label per voxel with the names of these: the image itself, its component, or
    all components of which labels are named. Throw Failure if it is unclear which."""
    import numpy as np
    from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
    from vtkmodules.vtkCommonDataModel import vtkImageData
    scalars = image.GetPointData().GetScalars()
    count = scalars.GetNumberOfComponents()
    if component is not None and component >= count:
        raise Failure(f"there is no component {component} (--component); voxels have {count}")
    if count == 1:
        set_label_names(image, names)
        return [image]
    chosen = sorted({label.layer for label in names if 0 <= label.layer < count})
    chosen = chosen if component is None else [max(component, 0)]
    if not chosen:
        raise Failure(f"voxels have {count} components; choose the one that is a label with "
                      "--component")
    layers = []
    for layer in chosen:
        one = vtkImageData()
        one.CopyStructure(image)
        values = np.ascontiguousarray(vtk_to_numpy(scalars)[:, layer])
        array = numpy_to_vtk(values, deep=False, array_type=scalars.GetDataType())
        array.SetName(scalars.GetName())
        one.GetPointData().SetScalars(array)  # It holds the values.
        set_label_names(one, [dataclasses.replace(label, layer=0) for label in names
                              if label.layer == layer])
        layers.append(one)
    return layers


def known_labels(layers: Sequence[Any], names: Sequence[Label], options: Namespace,
                 teller: Teller) -> tuple[list[KnownLabel], list[str]]:
    """The labels of the layers, and the warnings about them.

    Where there are too many to list, a few that --labels names by their numbers are returned.
    """
    from . import vtkFiltersVolumic
    from .options import in_words_of_options
    known: list[KnownLabel] = []
    warnings: list[str] = []
    for number, layer in enumerate(layers):
        table = vtkFiltersVolumic.vtkLabelTable()
        table.SetInputData(layer)
        try:
            warnings += run(table, "", Teller(quiet=True), in_words_of_options).warnings
        except Failure:
            known = _numbered(options.labels, names)
            if not known or len(layers) > 1 or options.list_labels:
                raise
            break
        columns = [table.GetOutput().GetColumnByName(name)
                   for name in ("Label", "Name", "Voxels", "Color", "Extent")]
        known += [KnownLabel(*(column.GetValue(row) for column in columns[:3]),
                             columns[3].GetTuple(row), number,
                             tuple(map(int, columns[4].GetTuple(row))))
                  for row in range(table.GetOutput().GetNumberOfRows())]
    for text in warnings:
        teller.warn(f"{options.volume}: {text}")
    _give_file_names(known)
    return known, warnings


def _numbered(texts: Iterable[str], names: Sequence[Label]) -> list[KnownLabel]:
    """The labels of texts that have only numbers."""
    parts = [part.strip() for text in texts for part in text.split(",")]
    if not all(re.fullmatch(r"[+-]?\d{1,9}", part) for part in parts):
        return []
    by_value = {label.value: label.name for label in names if label.name}
    return [KnownLabel(value, by_value.get(value, f"Label {value}"))
            for value in sorted(set(map(int, parts)))]


def _give_file_names(known: Sequence[KnownLabel]) -> None:
    """Give each label the name of a file: its name as file systems take it, or label-3."""
    names = [(safe_name(label.name) if label.is_named else "") or f"label-{label.label}"
             for label in known]
    uses, taken = Counter(name.lower() for name in names), set()
    for label, name in zip(known, names):
        name = free = f"{name}-{label.label}" if uses[name.lower()] > 1 else name
        number = 2
        while free.lower() in taken:
            free, number = f"{name}-{number}", number + 1
        taken.add(free.lower())
        label.file_name = free


def safe_name(name: str) -> str:
    """What of a name may be that of a file on all systems, at most 120 bytes; may be empty."""
    name = re.sub(r"""[\x00- \x7f/\\:*?"<>|'`$&;!%]""", "_", name).lstrip("._-~ ").rstrip("._ ")
    is_device = re.fullmatch("con|prn|aux|nul|(com|lpt)[1-3]", name.lower())
    return name.encode()[:120].decode(errors="ignore") + ("_" if is_device else "")


# ---- The choice ----------------------------------------------------------------------------------

def choose(texts: Iterable[str], known: Sequence[KnownLabel], background: int) -> list[KnownLabel]:
    """The labels that texts of --labels choose: `all`, numbers, ranges as 7-9, and names, in which
    * stands for any text, with commas between. The background is chosen only by its number or its
    whole name. Throw Failure if a text, except `all`, chooses none."""
    chosen: set[int] = set()
    for text in texts:
        # A name may have commas.
        parts = [text] if _named(text, known, background) else text.split(",")
        for part in map(str.strip, parts):
            found = _found(part, known, background)
            if not found and part.lower() != "all":
                raise Failure(f"there is no label '{part}' (--labels); there are {_list(known)}")
            chosen.update(map(id, found))
    return [label for label in known if id(label) in chosen]


def _found(text: str, known: Sequence[KnownLabel], background: int) -> list[KnownLabel]:
    is_number = re.fullmatch(r"[+-]?\d+", text)
    found = [label for label in known if is_number and label.label == int(text)] or _named(
        text, known, background)
    if found:
        return found
    bounds = re.fullmatch(r"([+-]?\d+)-([+-]?\d+)", text)  # also of negative numbers: -9--7
    return [label for label in known if label.label != background and (
        text.lower() == "all" or (bounds and int(bounds[1]) <= label.label <= int(bounds[2])))]


def _named(text: str, known: Sequence[KnownLabel], background: int) -> list[KnownLabel]:
    """By the name, of other case if there is none of this; else by the names that match."""
    lower = text.lower()
    same = ([label for label in known if label.name == text]
            or [label for label in known if label.name.lower() == lower])
    if same or "*" not in text:
        return same
    pattern = re.compile(".*".join(map(re.escape, lower.split("*"))), re.DOTALL)
    return [label for label in known if label.is_named and label.label != background
            and pattern.fullmatch(label.name.lower())]


def _list(known: Sequence[KnownLabel], most: int = 20) -> str:
    texts = [f"{label.label} {label.name}" if label.is_named else str(label.label)
             for label in known[:most]]
    more = len(known) - most
    return (", ".join(texts) or "none") + (f" and {more} more" if more > 0 else "")


# ---- The list ------------------------------------------------------------------------------------

def list_rows(labels: Iterable[KnownLabel], spacing: Sequence[float]) -> list[dict[str, Any]]:
    """What --list-labels reports of labels as JSON; volumes are in world units cubed."""
    return [{"label": label.label, "name": label.name, "color": label.color, "layer": label.layer,
             "voxels": label.voxels, "volume": label.voxels * math.prod(spacing),
             "box": label.box} for label in labels]


def table_of(labels: Iterable[KnownLabel], spacing: Sequence[float], layers: int) -> str:
    """What --list-labels prints: a heading and a line per label."""
    columns = ["label", "voxels", "volume"] + ["layer"] * (layers > 1) + ["box", "name"]
    lines = [[*columns[:-2], "box (first..last voxel along i, j, k)", "name"]]
    for row in list_rows(labels, spacing):
        volume, box = row["volume"], row["box"]
        digits = 5 - math.floor(math.log10(volume)) if volume > 0 else 0
        row.update(volume=f"{volume:.{min(max(digits, 0), 30)}f}", name=plain_name(row["name"]),
                   box=" ".join(f"{box[i]}..{box[i + 1]}" for i in (0, 2, 4)))
        lines.append([str(row[column]) for column in columns])
    widths = [max(map(len, cells)) for cells in zip(*lines)]
    return "".join("  ".join([*map(str.rjust, line[:-2], widths), line[-2].ljust(widths[-2]),
                              line[-1]]) + "\n" for line in lines)
