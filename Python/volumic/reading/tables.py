# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Names and colours of labels from JSON, colour tables, and text tables."""

from __future__ import annotations

import csv
import json
import os
import re
from collections.abc import Iterable, Sequence
from typing import Any

from ..errors import Failure
from .volume import Label, require_file, plain_name

LARGEST_FILE = 16 << 20  # bytes
NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?", re.IGNORECASE | re.ASCII)


def read_label_names(file: str) -> list[Label]:
    """Return the labels in a file, sorted by value. Raise Failure, which names the file.

    - JSON: {"1": "liver"} or {"liver": 1}, also nested (nnU-Net, TotalSegmentator), or a list of
      segments (3D Slicer, dcmqi).
    - Lines of label, name and colour (3D Slicer, FreeSurfer, MRIcron, ITK-SNAP).
    - Tables separated by commas, semicolons or tabs, with or without column names (BIDS).
    """
    require_file(file)
    try:
        text = _text_of(file)
        is_json = file.lower().endswith(".json") or text.lstrip()[:1] in ("{", "[")
        labels = _labels_in(json.loads(text)) if is_json else _labels_in_table(text)
        if not labels:
            raise ValueError("no label names found; write labels as "
                             + ('{"1": "liver"}' if is_json else "'1 liver' or '1,liver'"))
        colors = [part for label in labels for part in label.color or ()]
        if colors and not 0 <= min(colors) <= max(colors) <= 255:
            raise ValueError(f"colours range from {min(colors):g} to {max(colors):g}; use 0 to 1 "
                             "or 0 to 255")
    except (OSError, ValueError, RecursionError, csv.Error) as error:
        raise Failure(f"{file}: label names cannot be read: "
                      f"{getattr(error, 'strerror', None) or error}; correct the file") from None
    scale = 255 if max(colors, default=0) > 1 else 1
    first = {label.value: label for label in reversed(labels)}
    return [Label(value, plain_name(label.name), label.color and tuple(
        part / scale for part in label.color)) for value, label in sorted(first.items())]


def names_beside(volume: str, outputs: Iterable[str] = ()) -> tuple[list[Label], str, list[str]]:
    """Return the labels in a file next to a volume, that file, and reasons why other files were
    ignored.

    For a.nii.gz, the file is a.nii.txt, a.label, a.txt, a.ctbl, a.json, a.csv or a.tsv, or
    dataset.json in the folder or its parent. Reports and `outputs` of this run are ignored.
    """
    refused: list[str] = []
    ignored = {os.path.realpath(name) for name in (volume, *outputs)}
    stems = [os.path.splitext(volume)[0]]
    if volume.lower().endswith((".gz", ".bz2", ".seg.nrrd")):  # a.nii.gz has a.nii and a
        stems.append(os.path.splitext(stems[0])[0])
    files = [stem + suffix for stem in stems
             for suffix in (".label", ".txt", ".ctbl", ".json", ".csv", ".tsv")]
    files += [os.path.join(os.path.dirname(volume), *above, "dataset.json")
              for above in ((), ("..",))]
    for file in files if os.path.isfile(volume) else ():
        if os.path.isfile(file) and os.path.realpath(file) not in ignored and not _is_report(file):
            try:
                return read_label_names(file), file, refused
            except Failure as failure:
                refused.append(str(failure))
    return [], "", refused


def _is_report(file: str) -> bool:
    try:
        return "volumic" in json.loads(_text_of(file))["versions"]
    except (OSError, ValueError, RecursionError, LookupError, TypeError):
        return False


def _text_of(file: str) -> str:
    with open(file, "rb") as stream:
        data = stream.read(LARGEST_FILE + 1)
    if len(data) > LARGEST_FILE:
        raise ValueError("the file exceeds 16 MiB")
    if b"\0" in data:
        raise ValueError("the file is not UTF-8 text")
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError:
        return data.decode("latin-1")


# ---- Segments ------------------------------------------------------------------------------------

# JSON members and table columns, in lower case letters and digits.
LABEL_KEYS = ("labelvalue", "labelid", "labelindex", "value", "label", "index", "id", "idx",
              "number", "no", "key", "roi")
NAME_KEYS = ("name", "labelname", "segmentname", "segmentlabel", "segmentdescription", "structure",
             "structurename", "region", "regionname", "organ", "segment", "label", "text", "class",
             "description")
COLOR_KEYS = ("color", "colour", "rgb", "recommendeddisplayrgbvalue")
RGB_KEYS = ("r", "red", "colorr", "g", "green", "colorg", "b", "blue", "colorb")


def _number(value: Any) -> float | None:
    """Return the number that a text or JSON value denotes, or None."""
    if isinstance(value, str):
        value = float(value) if NUMBER.fullmatch(value) else None
    is_number = isinstance(value, (int, float)) and not isinstance(value, bool)
    return float(value) if is_number and abs(value) < 1e300 else None


def _label(value: Any) -> int | None:
    """Return the label that a text or JSON value denotes, or None: 7, "7" and "7.0" are 7."""
    number = _number(value)
    is_label = number is not None and number.is_integer() and abs(number) < 2 ** 31
    return int(number) if is_label else None


def _labels_of(segments: Sequence[Any]) -> list[Label | None]:
    """Return the label of each segment; None if it lacks a label or a name. The label is under the
    key that most segments have."""
    if not all(isinstance(segment, dict) for segment in segments):
        return []
    plain = [{re.sub("[^a-z0-9]", "", key.lower()): value for key, value in segment.items()}
             for segment in segments]
    key = max(LABEL_KEYS, key=lambda key: sum(_label(each.get(key)) is not None for each in plain))
    return [_label_of(segment, key) for segment in plain]


def _label_of(segment: dict[str, Any], key: str) -> Label | None:
    value = _label(segment.get(key))
    name = next((segment[other] for other in NAME_KEYS
                 if other != key and isinstance(segment.get(other), str)), None)
    color = next((segment[key] for key in COLOR_KEYS if key in segment),
                 [segment[key] for key in RGB_KEYS if key in segment])
    if isinstance(color, str) and re.fullmatch("#([0-9a-fA-F]{2}){3,4}", color):
        color = list(bytes.fromhex(color[1:]))
    parts = tuple(map(_number, color[:3])) if isinstance(color, list) else ()
    return None if value is None or name is None else Label(
        value, name, parts if len(parts) == 3 and None not in parts else None)


# ---- JSON ----------------------------------------------------------------------------------------

COMMON_MEMBERS = ("labels", "label_names", "names", "segments", "segmentattributes", "class_map",
                  "classes", "structures", "organs")


def _labels_in(value: Any) -> list[Label]:
    """Return the first labels in a JSON value: its own, or those of common or other members."""
    forms: list[list[Any]] = []
    if isinstance(value, list):  # [{"label": 1, "name": "liver"}], also nested
        forms = [[segment for group in value
                    for segment in (group if isinstance(group, list) else [group])]]
    elif isinstance(value, dict):  # {"1": "liver"}, {"1": {"name": "liver"}}; {"liver": 1}
        # A region of nnU-Net is a list of several labels.
        lists = {key: each if isinstance(each, list) else [each] for key, each in value.items()}
        forms = [[{**(each if isinstance(each, dict) else {"name": each}), "label value": key}
                    for key, each in value.items()],
                 [{"name": key, "label": each[0]} for key, each in lists.items() if len(each) == 1]]
        value = [value[key] for key in sorted(value,
                                              key=lambda key: key.lower() not in COMMON_MEMBERS)]
    for labels in map(_labels_of, forms):
        if labels and None not in labels:
            return labels
    return next(filter(None, map(_labels_in, value if isinstance(value, list) else ())), [])


# ---- Tables --------------------------------------------------------------------------------------

NAME, COLOR, OTHER = " (?P<name>.+?)", r" (?P<r>[\d.]+) (?P<g>[\d.]+) (?P<b>[\d.]+)", r" [\d.]+"
LINES = [re.compile(r"(?P<label>[+-]?\d+)" + rest) for rest in (
    COLOR + 3 * OTHER + NAME,  # ITK-SNAP
    NAME + COLOR + OTHER, NAME + COLOR, r" (?P<name>\S+)" + OTHER, NAME)]


def _labels_in_table(text: str) -> list[Label]:
    lines = {number: line for number, line in enumerate(text.splitlines(), 1)
             if line.strip() and not line.startswith(("#", "//"))}
    separator = next((separator for separator in "\t;," if 2 * sum(
        separator in line for line in lines.values()) > len(lines)), "")
    rows = [[word.strip() for word in next(csv.reader(
        [line], delimiter=separator, skipinitialspace=True))] if separator
        else line.replace('"', "").split() for line in lines.values()]
    head = rows.pop(0) if rows and not any(_number(word) is not None for word in rows[0]) else []
    if head and separator:
        segments = [dict(zip(head, words)) for words in rows]
    elif separator:  # name first or label first
        segments = [dict(zip(("label", "name", "r", "g", "b"), sorted(
            words[:2], key=lambda word: _label(word) is None) + words[2:])) for words in rows]
    else:  # first pattern that matches all lines; names may contain blanks
        fits = [[pattern.fullmatch(" ".join(words)) for words in rows] for pattern in LINES]
        best = next(filter(all, fits), fits[-1])
        segments = [match.groupdict() if match else {} for match in best]
    labels = _labels_of(segments)
    for number, label in zip(list(lines)[-len(rows):], labels):
        if label is None or (not head and _number(label.name) is not None):
            raise ValueError(f"line {number} lacks an integer label or a name; add a first line "
                             "with column names such as 'label' and 'name'")
    return labels
