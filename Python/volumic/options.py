# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The command line: its parser, and which options exclude each other (tables: option_tables.py)."""

from __future__ import annotations

import argparse
import difflib
import re
from collections.abc import Sequence
from typing import Any

from .errors import UsageError
from .option_tables import (
    INPUT, LABELS, OUTPUT, PROPERTIES, Filters, Option, Property, is_of_labels)
from .reading.volume import Choice
from .writing import is_of_solids

# Options of which one excludes the others.
EXCLUSIONS = {
    "edges": ("region", "region-box", "resample", "isotropic"), "region": ("region-box",),
    "resample": ("isotropic",), "scale": ("unit",), "time": ("phase",),
    "seeds": ("initial-surface",), "seed-position": ("initial-surface",),
    "triangles": ("tolerance", "edge-length", "time-limit")}
# Surfaces of labels have no evolution to choose and watch.
NOT_WITH_LABELS = ("seeds", "seed-position", "initial-surface", "attracting-points",
                   "attracting-position", "edges", "history", "levels-output", "snapshots")
NEEDS = {"edge-attraction": "edges", "probe-depth": "probe"}
ENDED = {"resume": "a run is not resumed any more; start it again",
         "memory": "limit the memory by systemd-run -p MemoryMax=, and give --scratch DIR",
         "gap": "labels that touch share their interface",
         "piece-size": "surfaces are not written in pieces any more",
         "profile": "the history has no columns of phases"}


# ---- The command line --------------------------------------------------------------------------

def make_parser(filters: Filters | None = None) -> argparse.ArgumentParser:
    """Return the parser for --help and completion; with filters the help has the defaults of their
    properties."""
    parser = argparse.ArgumentParser(
        prog="volumic", usage="volumic [OPTION]... VOLUME SURFACE...", add_help=False,
        formatter_class=lambda prog: argparse.HelpFormatter(prog, 2, 26, 80),
        description="Finds the surface of an object in a 3D image with a closed, deformable "
        "surface that descends a pyramid of the image from coarse to fine, and writes it.",
        epilog="Exit codes: 0 done; 1 something failed; 2 wrong usage; 3 stopped by Ctrl-C, "
        "--time-limit or --iterations: the surface as it was then is written.")
    parser.add_argument("volume", metavar="VOLUME", nargs="?",
                        help="a file, a folder of DICOM slices, pictures or masks, an OME-Zarr "
                        "group, or a pattern such as 'slice%%03d.png' or '*.tif'")
    parser.add_argument("surfaces", metavar="SURFACE", nargs="*",
                        help=".vtp .vtk .stl .ply .obj .glb .3mf; filled with tetrahedra .vtu "
                        ".inp and what meshio writes; for meshers .msh .smesh .poly; with "
                        "--labels also a folder for a file per label, OUT/, or .vtm; .vtp .vtk "
                        "and those for tetrahedra hold one mesh of several labels")
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
    group.add_argument("-h", "--help", action="store_true", help="print this text")
    group.add_argument("--version", action="store_true",
                       help="print the versions of Volumic and VTK")
    return parser


def parse(words: Sequence[str]) -> argparse.Namespace:
    """Return the options of a command line, with `given`, the names of those that it has,
    `properties`, pairs of a Property and its text, and `choice`, what of the volume is read.

    Throw UsageError if the words are not understood, exclude each other or lack something.
    """
    known = {item.option: item for item in (*INPUT, *PROPERTIES, *OUTPUT)}
    values = {item.option: [] if item.several else None if item.metavar else False
              for item in (*INPUT, *OUTPUT)}
    values.update(help=False, version=False, ends="closed", properties=[])
    values["probe-depth"] = 0.0
    plain, given, rest = [], set(), list(words)
    while rest:
        word = rest.pop(0)
        word = {"-h": "--help", "-q": "--quiet"}.get(word, word)
        if word == "--":
            plain, rest = plain + rest, []
        elif len(word) < 2 or word[0] != "-":
            plain.append(word)
        else:
            name, equals, text = word[2:].partition("=")
            if word[:2] != "--" or name not in {*known, "help", "version"}:
                _unknown(word.partition("=")[0], known)
            given.add(name)
            item = known.get(name)
            takes = item is not None and bool(item.metavar)
            if equals and not takes:
                raise UsageError(f"--{name} takes no argument")
            if takes and not equals and not rest:
                raise UsageError(f"--{name} needs an argument")
            text = rest.pop(0) if takes and not equals else text
            if isinstance(item, Property):
                values["properties"].append((item, text))
            else:
                value = _parsed(item, text) if takes else True
                values[name] = [*values[name], value] if takes and item.several else value
    options = argparse.Namespace(
        **{name.replace("-", "_"): value for name, value in values.items()}, given=given,
        volume="".join(plain[:1]), surfaces=plain[1:])
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


def _unknown(word: str, known: dict[str, Any]) -> None:
    if word[2:] in ENDED:
        raise UsageError(f"{word} is gone: {ENDED[word[2:]]}")
    near = difflib.get_close_matches(word[2:], known, 1)
    raise UsageError(f"unknown option {word}" + (f"; did you mean --{near[0]}?" if near else ""))


def has_property(options: argparse.Namespace, name: str) -> bool:
    """Whether the command line sets a property."""
    return any(item.name == name for item, _ in options.properties)


def apply(options: argparse.Namespace, filters: Filters) -> None:
    """Set the properties of the command line. Throw UsageError if a text is not a value."""
    for item, text in options.properties:
        try:
            item.set(filters, text)
        except (UsageError, OverflowError) as error:
            raise UsageError(f"--{item.option}: {error}") from None
    filters.share()


def wants_surface(options: argparse.Namespace) -> bool:
    """Whether a surface is requested, or a report of it or of the labels."""
    return bool(options.list_labels or options.surfaces or options.levels_output or options.report
                or options.history or options.snapshots)


def makes_tetrahedra(options: argparse.Namespace) -> bool:
    """Whether a file of tetrahedra is requested."""
    from .writing.tetrahedra import needs_mesher
    names = options.surfaces + ([f"in_folder.{options.format}"] if options.format else [])
    return any(needs_mesher(name, options.mesher) for name in names)


# ---- What makes no sense together --------------------------------------------------------------

def exclude(options: argparse.Namespace, option: str, others: Sequence[str]) -> None:
    """Throw UsageError if the option and one of the others are given."""
    for other in others:
        if option in options.given and other in options.given:
            raise UsageError(f"--{option} and --{other} exclude each other")


def check(options: argparse.Namespace) -> None:
    """Throw UsageError if something is missing, or options are given that exclude each other."""
    if options.help or options.version or options.list_properties:
        return
    if not options.volume:
        raise UsageError("no volume is given")
    if options.list_files or options.list_series:
        return
    if not wants_surface(options) and not options.write_volume:
        raise UsageError("no file to write is given")
    (_check_with_labels if options.labels else _check_without_labels)(options)
    for option, others in EXCLUSIONS.items():
        exclude(options, option, others)
    for option, needed in NEEDS.items():
        if option in options.given and needed not in options.given:
            raise UsageError(f"--{option} needs --{needed}")
    for option in ("mesher", "maximum-volume"):
        if option in options.given and not makes_tetrahedra(options):
            raise UsageError(f"--{option} needs a file of tetrahedra: .vtu, .inp, or .msh with "
                             "--mesher")
    if options.ends == "open" and any(map(is_of_solids, options.surfaces)):
        raise UsageError("--ends open and files of solids, which are closed, exclude each other")


def _check_without_labels(options: argparse.Namespace) -> None:
    for item, _ in options.properties:
        if item.cls == LABELS:
            raise UsageError(f"--{item.option} needs --labels")
    if options.format:
        raise UsageError("--format needs --labels")
    if options.label_names and not options.write_volume:
        raise UsageError("--label-names needs --labels, or --write-volume")


def _check_with_labels(options: argparse.Namespace) -> None:
    from .segment_labels import check_outputs
    mode = "list-labels" if options.list_labels else "labels"
    if options.list_labels and options.surfaces:
        raise UsageError(f"{options.surfaces[0]}: --list-labels makes no surfaces; leave out the "
                         "file or the option")
    exclude(options, mode, NOT_WITH_LABELS)
    exclude(options, "list-labels", ("format", "triangles"))
    listed = ("SelectedComponent", "BackgroundLabel", "NumberOfThreads", "ScratchDirectory")
    for item, text in options.properties:
        if not (item.name in listed if options.list_labels else is_of_labels(item)):
            raise UsageError(f"--{item.option} and --{mode} exclude each other"
                             + "; --edge-length makes edges shorter" * (item.name == "ThinParts"))
        if item.name == "KeepComponents" and text in ("at-points", "not-at-seeds"):
            raise UsageError(f"--keep {text} and --labels exclude each other")
    check_outputs(options)


# ---- Messages of filters -----------------------------------------------------------------------

def in_words_of_options(message: str) -> str:
    """Return a message of a filter, which names properties as ParaView's panel does, in the terms
    of the command line: `Iso Value` becomes --iso."""
    return _PHRASES.sub(_in_words, message)


def _in_words(match: re.Match[str]) -> str:
    switch, label, verb, state = match.groups("")
    option, value = _LABELS[label]
    if value is None or (value and not state):
        return match.group().replace(label, option)
    is_given = (state == "on") == value
    if switch:
        word = "give" if is_given else "leave out"
        return f"{word.capitalize() if switch[0] == 'S' else word} {option}"
    return f"{option} is {'' if is_given else 'not '}given" if verb else match.group()


_LABELS = {re.sub(r"(?<=.)(?=[A-Z][a-z])", " ", item.name): (
    f"--{item.option}", None if item.metavar else item.value) for item in PROPERTIES}
_LABELS.update({name: (text, None) for name, text in {
    "Initial Surface (input port 1)": "--initial-surface", "Edge Map": "--edges",
    "Attracting Points (input port 2)": "--attracting-points", "Input port 0": "the volume",
    "Seed Positions": "--seed-position", "Attracting Positions": "--attracting-position"}.items()})
# Neither within a word nor within the name of a file; the longest name first.
_PHRASES = re.compile(r"(?:(?<=^)|(?<=[ (]))([Ss]witch )?(" + "|".join(
    re.escape(name) for name in sorted(_LABELS, key=len, reverse=True))
    + r")(?:( is)? (on|off))?(?=$|[ )]|[.,;:](?:$| ))")
