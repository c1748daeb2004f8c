# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Parser of the command line and checks of its options. Tables: option_tables.py."""

from __future__ import annotations

import argparse
import difflib
import re
from collections.abc import Sequence
from typing import Any

from .errors import UsageError
from .option_tables import (
    INPUT, LABELS, OUTPUT, PROPERTIES, Filters, Option, Property, applies_to_labels)
from .reading.volume import Choice
from .writing import holds_volume_mesh

# Mutually exclusive options.
EXCLUSIONS = {
    "edges": ("region", "region-box", "resample", "isotropic"), "region": ("region-box",),
    "resample": ("isotropic",), "scale": ("unit",), "time": ("phase",),
    "seeds": ("initial-surface",), "seed-position": ("initial-surface",),
    "triangles": ("tolerance", "edge-length", "time-limit")}
# Options of the evolution, which label maps do not have.
NOT_WITH_LABELS = ("seeds", "seed-position", "initial-surface", "attracting-points",
                   "attracting-position", "edges", "history", "levels-output", "snapshots")
REQUIRES = {"edge-attraction": "edges", "probe-depth": "probe"}
REMOVED = {"resume": "runs cannot be resumed; start the run again",
           "memory": "limit the memory with systemd-run -p MemoryMax=SIZE and set --scratch DIR",
           "gap": "adjacent labels share their interface",
           "piece-size": "each surface is written as one piece",
           "profile": "the history has no timings of phases"}


# ---- The command line --------------------------------------------------------------------------

def make_parser(filters: Filters | None = None) -> argparse.ArgumentParser:
    """Return the parser for --help and completion. With `filters`, the help shows the defaults of
    their properties."""
    parser = argparse.ArgumentParser(
        prog="volumic", usage="volumic [OPTION]... VOLUME SURFACE...", add_help=False,
        formatter_class=lambda prog: argparse.HelpFormatter(prog, 2, 26, 80),
        description="Compute the closed triangulated surface of an object in a 3D image, or of "
        "each label of a label map (--labels). A deformable surface is fitted to an image pyramid "
        "from coarse to fine.",
        epilog="Exit codes: 0 success; 1 failure; 2 wrong usage; 3 stopped by --time-limit, "
        "--iterations or Ctrl-C: the current surface is written.")
    parser.add_argument("volume", metavar="VOLUME", nargs="?",
                        help="image file, folder of DICOM slices, pictures or masks, OME-Zarr "
                        "group, or file name pattern such as 'slice%%03d.png' or '*.tif'")
    parser.add_argument("surfaces", metavar="SURFACE", nargs="*",
                        help="output file. Surface: .vtp .vtk .stl .ply .obj .glb .3mf; "
                        "tetrahedral mesh: .vtu .inp .xdmf .med .bdf .mesh .exo; input of meshers: "
                        ".msh .smesh .poly. With --labels also a folder (OUT/, a file per label) "
                        "or .vtm; .vtp, .vtk, tetrahedral meshes and input of meshers store one "
                        "mesh of all labels")
    for title, options in (("Input", INPUT), ("Segmentation", PROPERTIES), ("Output", OUTPUT)):
        group = parser.add_argument_group(title)
        for item in options:
            text, default = item.help, item.get(filters) if (
                filters and isinstance(item, Property) and item.metavar) else ""
            if default not in ("", "nan", "inf"):
                text += f" (default: {default})"
            names = (["-q"] if item.option == "quiet" else []) + [f"--{item.option}"]
            group.add_argument(*names, help=text.replace("%", "%%"), **(
                {"metavar": item.metavar} if item.metavar else {"action": "store_true"}))
    group.add_argument("-h", "--help", action="store_true", help="print this help")
    group.add_argument("--version", action="store_true",
                       help="print the versions of Volumic and VTK")
    return parser


def parse(arguments: Sequence[str]) -> argparse.Namespace:
    """Parse a command line.

    Returns
    -------
    argparse.Namespace
        The options, and `given` (names of the options present), `properties` (pairs of a Property
        and its text) and `choice` (a reading.Choice).

    Raises
    ------
    UsageError
        An option is unknown, incomplete or incompatible with another one.
    """
    known = {item.option: item for item in (*INPUT, *PROPERTIES, *OUTPUT)}
    values = {item.option: [] if item.repeatable else None if item.metavar else False
              for item in (*INPUT, *OUTPUT)}
    values.update(help=False, version=False, ends="closed", properties=[])
    values["probe-depth"] = 0.0
    positional, given, remaining = [], set(), list(arguments)
    while remaining:
        argument = remaining.pop(0)
        argument = {"-h": "--help", "-q": "--quiet"}.get(argument, argument)
        if argument == "--":
            positional, remaining = positional + remaining, []
        elif len(argument) < 2 or argument[0] != "-":
            positional.append(argument)
        else:
            name, equals, text = argument[2:].partition("=")
            if argument[:2] != "--" or name not in {*known, "help", "version"}:
                _unknown(argument.partition("=")[0], known)
            given.add(name)
            item = known.get(name)
            takes_argument = item is not None and bool(item.metavar)
            if equals and not takes_argument:
                raise UsageError(f"--{name} takes no argument")
            if takes_argument and not equals and not remaining:
                raise UsageError(f"--{name} requires an argument")
            text = remaining.pop(0) if takes_argument and not equals else text
            if isinstance(item, Property):
                values["properties"].append((item, text))
            else:
                value = _parsed(item, text) if takes_argument else True
                is_list = takes_argument and item.repeatable
                values[name] = [*values[name], value] if is_list else value
    options = argparse.Namespace(
        **{name.replace("-", "_"): value for name, value in values.items()}, given=given,
        volume="".join(positional[:1]), surfaces=positional[1:])
    if options.list_labels and not options.labels:
        options.labels = ["all"]
    options.choice = Choice(
        series=options.series, time=options.phase if options.time is None else options.time,
        spacing=options.spacing, raw=options.raw, labels=bool(options.labels),
        resampling=not options.no_resampling, array=options.array)
    check(options)
    return options


def _parsed(item: Option, text: str) -> Any:
    try:
        return item.parse(text)
    except UsageError as error:
        raise UsageError(f"--{item.option}: {error}") from None


def _unknown(argument: str, known: dict[str, Any]) -> None:
    if argument[2:] in REMOVED:
        raise UsageError(f"{argument} is not supported: {REMOVED[argument[2:]]}")
    near = difflib.get_close_matches(argument[2:], known, 1)
    hint = f"; did you mean --{near[0]}?" if near else ""
    raise UsageError(f"unknown option {argument}{hint}")


def has_property(options: argparse.Namespace, name: str) -> bool:
    return any(item.name == name for item, _ in options.properties)


def apply(options: argparse.Namespace, filters: Filters) -> None:
    """Set the properties of the command line. Raise UsageError if a value is invalid."""
    for item, text in options.properties:
        try:
            item.set(filters, text)
        except (UsageError, OverflowError) as error:
            raise UsageError(f"--{item.option}: {error}") from None
    filters.copy_common_properties()


def needs_surface(options: argparse.Namespace) -> bool:
    """Return whether an output needs the surface, or the labels."""
    return bool(options.list_labels or options.surfaces or options.levels_output or options.report
                or options.history or options.snapshots)


def writes_tetrahedra(options: argparse.Namespace) -> bool:
    from .writing.tetrahedra import needs_mesher
    names = options.surfaces + ([f"in_folder.{options.format}"] if options.format else [])
    return any(needs_mesher(name, options.mesher) for name in names)


# ---- Incompatible options ----------------------------------------------------------------------

def exclude(options: argparse.Namespace, option: str, others: Sequence[str]) -> None:
    """Raise UsageError if `option` and one of `others` are given."""
    for other in others:
        if option in options.given and other in options.given:
            raise UsageError(f"--{option} and --{other} are mutually exclusive")


def check(options: argparse.Namespace) -> None:
    """Raise UsageError if an argument is missing or options are incompatible."""
    if options.help or options.version or options.list_properties:
        return
    if not options.volume:
        raise UsageError("VOLUME is missing")
    if options.list_files or options.list_series:
        return
    if not needs_surface(options) and not options.write_volume:
        raise UsageError("no output is given; give SURFACE or an output option")
    (_check_with_labels if options.labels else _check_without_labels)(options)
    for option, others in EXCLUSIONS.items():
        exclude(options, option, others)
    for option, required in REQUIRES.items():
        if option in options.given and required not in options.given:
            raise UsageError(f"--{option} requires --{required}")
    for option in ("mesher", "maximum-volume"):
        if option in options.given and not writes_tetrahedra(options):
            raise UsageError(f"--{option} requires a tetrahedral mesh as output: .vtu, .inp, or "
                             ".msh with --mesher")
    if options.ends == "open":
        for name in filter(holds_volume_mesh, options.surfaces):
            raise UsageError(f"{name}: tetrahedral meshers require a closed surface; use --ends "
                             "marked instead of --ends open")


def _check_without_labels(options: argparse.Namespace) -> None:
    for item, _ in options.properties:
        if item.cls == LABELS:
            raise UsageError(f"--{item.option} requires --labels")
    if options.format:
        raise UsageError("--format requires --labels")
    if options.label_names and not options.write_volume:
        raise UsageError("--label-names requires --labels or --write-volume")


def _check_with_labels(options: argparse.Namespace) -> None:
    from .segment_labels import check_outputs
    mode = "list-labels" if options.list_labels else "labels"
    if options.list_labels and options.surfaces:
        raise UsageError(f"{options.surfaces[0]}: --list-labels writes no surfaces; remove the "
                         "file name or the option")
    exclude(options, mode, NOT_WITH_LABELS)
    exclude(options, "list-labels", ("format", "triangles"))
    listed = ("SelectedComponent", "BackgroundLabel", "NumberOfThreads", "ScratchDirectory")
    for item, text in options.properties:
        if not (item.name in listed if options.list_labels else applies_to_labels(item)):
            raise UsageError(f"--{item.option} and --{mode} are mutually exclusive"
                             + "; use --edge-length" * (item.name == "ThinParts"))
        if item.name == "KeepComponents" and text in ("at-points", "not-at-seeds"):
            raise UsageError(f"--keep {text} and --labels are mutually exclusive")
    check_outputs(options)


# ---- Messages of filters -----------------------------------------------------------------------

def with_option_names(message: str) -> str:
    """Replace property labels by options in a message of a filter: `Iso Value` becomes --iso."""
    return _PHRASES.sub(_option_name, message)


def with_file_name(message: str, options: argparse.Namespace) -> str:
    """Replace the input at the start of an error of a filter by its file."""
    name, colon, rest = message.partition(": ")
    file = {"the volume": options.volume, "--attracting-points": options.attracting_points,
            "--initial-surface": options.seeds or options.initial_surface}.get(name)
    return f"{file or name}{colon}{rest}"


def _option_name(match: re.Match[str]) -> str:
    switch, label, verb, state = match.groups("")
    option, value = _LABELS[label]
    if value is None or not state:
        return match.group().replace(label, option)
    is_given = (state == "on") == value
    if switch:
        action = "give" if is_given else "remove"
        return f"{action.capitalize() if switch[0] == 'S' else action} {option}"
    return f"{option} is {'' if is_given else 'not '}given" if verb else match.group()


_LABELS = {re.sub(r"(?<=.)(?=[A-Z][a-z])", " ", item.name): (
    f"--{item.option}", None if item.metavar else item.value) for item in PROPERTIES}
_LABELS.update({name: (text, None) for name, text in {
    "Input port 1 (Initial Surface)": "--initial-surface", "Edge Map": "--edges",
    "Input port 2 (Attracting Points)": "--attracting-points", "Input port 0": "the volume",
    "Seed Positions": "--seed-position", "Attracting Positions": "--attracting-position"}.items()})
# Not within a word or a file name. Longer names first.
_PHRASES = re.compile(r"(?:(?<=^)|(?<=[ (]))([Ss]witch )?(" + "|".join(
    re.escape(name) for name in sorted(_LABELS, key=len, reverse=True))
    + r")(?:( is)? (on|off))?(?=$|[ )]|[.,;:](?:$| ))")
