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
    INPUT, OUTPUT, PROPERTIES, Filters, Property, is_of_labels, is_of_labels_only)
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
         "piece-size": "surfaces are not written in pieces any more"}


# ---- The command line --------------------------------------------------------------------------

class Parser(argparse.ArgumentParser):
    """Throws UsageError."""

    def error(self, message: str) -> Any:
        raise UsageError(message)


def make_parser(filters: Filters | None = None) -> Parser:
    """The parser; with filters the help has the defaults of their properties."""
    parser = Parser(
        prog="volumic", usage="volumic [OPTION]... VOLUME SURFACE...", add_help=False,
        allow_abbrev=False, formatter_class=lambda prog: argparse.HelpFormatter(prog, 2, 26, 80),
        description="Finds the surface of an object in a 3D image with a closed, deformable "
        "surface that descends a pyramid of the image from coarse to fine, and writes it.",
        epilog="Exit codes: 0 done; 1 something failed; 2 wrong usage; 3 stopped by Ctrl-C, "
        "--time-limit or --iterations: the surface as it was then is written.")
    parser.add_argument("volume", metavar="VOLUME", nargs="?", default="",
                        help="a file, a folder of DICOM slices, pictures or masks, an OME-Zarr "
                        "group, or a pattern such as 'slice%%03d.png' or '*.tif'")
    parser.add_argument("surfaces", metavar="SURFACE", nargs="*",
                        help=".vtp .vtk .stl .ply .obj .glb .3mf; filled with tetrahedra .vtu "
                        ".inp and what meshio writes; for meshers .msh .smesh .poly; with "
                        "--labels also a folder for a file per label, OUT/, or .vtm")

    def add(group: Any, item: Any, text: str, **more: Any) -> None:
        names = [f"--{item.option}"] + {"quiet": ["-q"]}.get(item.option, [])
        more = more if item.metavar else {**more, "nargs": 0}
        group.add_argument(*names, metavar=item.metavar or None,
                           help=text.replace("%", "%%"), **more)

    for title, options in (("Input", INPUT), ("Segmentation", PROPERTIES), ("Output", OUTPUT)):
        group = parser.add_argument_group(title)
        for item in options:
            if isinstance(item, Property):
                default = item.get(filters) if filters and item.metavar else ""
                text = item.help + (f" (default: {default})" if default not in ("", "nan", "inf") else "")
                add(group, item, text, action=_Keep, const=item, dest="properties", default=[])
            else:
                add(group, item, item.help, action=_Store, const=item,
                    default=[] if item.several else None if item.metavar else False)
    group.add_argument("-h", "--help", action="store_true", help="print this text")
    group.add_argument("--version", action="store_true",
                       help="print the versions of Volumic and VTK")
    return parser


class _Keep(argparse.Action):
    """Keeps a property and its text."""

    def __call__(self, parser: Any, namespace: Any, values: Any, option: str | None = None) -> None:
        namespace.properties = [*namespace.properties, (self.const, values or "")]


class _Store(argparse.Action):
    """Parses the value of an option."""

    def __call__(self, parser: Any, namespace: Any, values: Any, option: str | None = None) -> None:
        try:
            value = self.const.parse(values) if self.const.metavar else True
        except UsageError as error:
            raise UsageError(f"--{self.const.option}: {error}") from None
        if self.const.several:
            value = [*getattr(namespace, self.dest), value]
        setattr(namespace, self.dest, value)


def parse(words: Sequence[str]) -> argparse.Namespace:
    """The options of a command line, with `given`, the names of those that it has, `properties`,
    pairs of a Property and its text, and `choice`, what of the volume is read.

    Throw UsageError if the words are not understood, exclude each other or lack something.
    """
    arguments, plain, given = [], [], []
    known = {item.option: item for item in (*INPUT, *PROPERTIES, *OUTPUT)}
    short = {"-h": "--help", "-q": "--quiet"}
    rest = list(words)
    while rest:
        word = rest.pop(0)
        word = short.get(word, word)
        if word == "--":
            plain += rest
            break
        if len(word) < 2 or word[0] != "-":
            plain.append(word)
            continue
        name, equals, text = word[2:].partition("=")
        if word[:2] != "--" or name not in {*known, "help", "version"}:
            _unknown(word.partition("=")[0], known)
        takes = name in known and known[name].metavar
        if equals and not takes:
            raise UsageError(f"--{name} takes no argument")
        if takes and not equals:
            if not rest:
                raise UsageError(f"--{name} needs an argument")
            text = rest.pop(0)
        arguments.append(f"--{name}={text}" if takes else word)
        given.append(name)
    options = make_parser().parse_args([*arguments, "--", *plain])
    options.given = set(given)
    options.probe_depth = options.probe_depth or 0.0
    options.ends = options.ends or "closed"
    if options.list_labels and not options.labels:
        options.labels = ["all"]
    options.choice = Choice(
        series=options.series, time=options.phase if options.time is None else options.time,
        spacing=options.spacing, raw=options.raw, labels=bool(options.labels),
        resampling=not options.no_resampling, array=options.array)
    check(options)
    return options


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
        if is_of_labels_only(item):
            raise UsageError(f"--{item.option} needs --labels")
    if options.format:
        raise UsageError("--format needs --labels")
    if options.label_names and not options.write_volume:
        raise UsageError("--label-names needs --labels, or --write-volume")


def _check_with_labels(options: argparse.Namespace) -> None:
    from .label_outputs import check_outputs, shares_interfaces
    asked = "list-labels" if options.list_labels else "labels"
    if options.list_labels and options.surfaces:
        raise UsageError(f"{options.surfaces[0]}: --list-labels makes no surfaces; leave out the "
                         "file or the option")
    exclude(options, asked, NOT_WITH_LABELS)
    exclude(options, "list-labels", ("format", "triangles"))
    listed = ("SelectedComponent", "BackgroundLabel", "NumberOfThreads", "ScratchDirectory")
    for item, text in options.properties:
        if not (item.name in listed if options.list_labels else is_of_labels(item)):
            raise UsageError(f"--{item.option} and --{asked} exclude each other")
        if item.name == "KeepComponents" and text in ("at-points", "not-at-seeds"):
            raise UsageError(f"--keep {text} and --labels exclude each other")
    if shares_interfaces(options):
        for option, why in (("probe-depth", ", which have no normals,"), ("ends", "")):
            if option in options.given:
                raise UsageError(f"--{option} and shared interfaces{why} exclude each other")
    check_outputs(options)


def in_words_of_options(message: str) -> str:
    """A message of a filter, which names properties as ParaView's panel does, in the words of the
    command line: `Iso Value` becomes --iso."""
    return _PHRASES.sub(lambda match: _TEXTS[match.group()], message)


def _label(name: str) -> str:
    return re.sub(r"(?<=.)(?=[A-Z][a-z])", " ", name)


def _phrases() -> dict[str, str]:
    texts = {"Initial Surface (input port 1)": "--initial-surface", "Edge Map": "--edges",
             "Attracting Points (input port 2)": "--attracting-points",
             "Input port 0": "the volume", "Seed Positions": "--seed-position",
             "Attracting Positions": "--attracting-position"}
    for item in PROPERTIES:
        label, name = _label(item.name), f"--{item.option}"
        if item.metavar:
            texts[label] = name
            continue
        given, absent = ("on", "off") if item.value else ("off", "on")
        texts.update({f"{label} was {absent} and is {given}": f"{name} was not given and is",
                      f"{label} was {given} and is {absent}": f"{name} was given and is not",
                      f"{label} is {given}": f"{name} is given",
                      f"{label} is {absent}": f"{name} is not given"})
        for change, leave, give in (("switch", "leave", "give"), ("Switch", "Leave", "Give")):
            texts[f"{change} {label} {absent}"] = f"{leave} {name} away"
            texts[f"{change} {label} {given}"] = f"{give} {name}"
        if item.value:
            texts[label] = name
    return texts


_TEXTS = _phrases()
# Neither within a word nor within the name of a file; the longest phrase first.
_PHRASES = re.compile(r"(?:(?<=^)|(?<=[ (]))(?:" + "|".join(
    re.escape(text) for text in sorted(_TEXTS, key=len, reverse=True))
    + r")(?=$|[ )]|[.,;:](?:$| ))")
