# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""What the names of files mean on the command line of a label map, and whether they make sense."""

from __future__ import annotations

import os
import re
from argparse import Namespace

from . import writing
from .errors import UsageError
from .options import has_property, makes_tetrahedra
from .segment import inputs_of, other_outputs
from .writing import files
from .writing.tetrahedra import find_mesher


def shares_interfaces(options: Namespace) -> bool:
    """Whether one mesh of all labels is requested, or a file that needs it."""
    return has_property(options, "SharedInterfaces") or (
        not has_property(options, "Merge") and any(map(writing.is_of_solids, options.surfaces)))


def form_of(options: Namespace, name: str) -> str:
    """What a name requests: a `folder` of files, `blocks` or a scene of all surfaces, the
    `interfaces` of all labels as one mesh, or a `file` of one surface."""
    suffix = os.path.splitext(name)[1].lower()
    if name.endswith("/") or not suffix or os.path.isdir(name):
        return "folder"
    if suffix == ".vtm" or writing.is_scene(name):
        return "blocks"
    is_mesh = suffix in (".vtp", ".vtk") or (
        writing.is_of_solids(name) and not has_property(options, "Merge"))
    return "interfaces" if is_mesh and shares_interfaces(options) else "file"


def suffix_in_folder(options: Namespace) -> str:
    """The suffix of the files in a folder, with a dot."""
    return "." + (options.format or "vtp").lstrip(".")


def check_outputs(options: Namespace) -> None:
    """Throw UsageError if surfaces of labels cannot be written to the names of the options."""
    names = options.surfaces
    forms = [form_of(options, name) for name in names]
    for name, form in zip(names, forms):
        is_new = form == "folder" and name[-1] not in "-/" and not os.path.isdir(name)
        if is_new and (len(names) > 1 or re.fullmatch("[+-]?[0-9]+(-[+-]?[0-9]+)?", name)):
            raise UsageError(f"'{name}' is not the name of a file; write a list of labels with "
                             f"commas (--labels {options.labels[-1]},{name}), a folder with a slash "
                             f"({name}/)")
        if name == "-":
            raise UsageError("surfaces of labels are not written to the standard output")
        if form == "folder" and has_property(options, "Merge"):
            raise UsageError(f"{name}: --merge makes one surface; give a file, not a folder")
        if form in ("folder", "file"):
            writing.check_surface_name(
                name if form == "file" else "labels" + suffix_in_folder(options))
    if options.format and names and "folder" not in forms:
        raise UsageError("--format is that of the files in a folder; the format of "
                         f"{names[0]} is its suffix")


def output_of(name: str, form: str) -> files.OutputName:
    """What is known about a file before it is written."""
    kind = "place" if form == "folder" else "blocks" if name.lower().endswith(".vtm") else "file"
    return files.OutputName(name, kind, "")


def check_files(options: Namespace) -> None:
    """Throw Failure or UsageError if something is wrong with the files before the work begins."""
    if options.write_volume:
        writing.check_volume_name(options.write_volume)
    files.check_outputs([output_of(name, form_of(options, name)) for name in options.surfaces]
                        + other_outputs(options), inputs_of(options))
    if makes_tetrahedra(options):
        find_mesher(options.mesher)
