# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Names and colors of labels, from the files in which programs and people keep them."""

from __future__ import annotations

import csv
import json
import os
import re
from collections.abc import Iterable, Sequence
from typing import Any

from ..errors import Failure
from .volume import Label

LARGEST_FILE = 16 << 20  # bytes
LARGEST_LABEL = 2 ** 31 - 1
NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?", re.IGNORECASE | re.ASCII)


def read_label_names(file: str) -> list[Label]:
    """The labels that a file names, by their values. Its content tells what kind it is of:

    - JSON: {"1": "liver"} or {"liver": 1}, alone or within other members (nnU-Net's `labels`,
      TotalSegmentator's classes), or a list of segments (3D Slicer, dcmqi);
    - label descriptions of ITK-SNAP;
    - lines of a label, a name and a color (3D Slicer's .ctbl, FreeSurfer), or of a label, a name
      and a number without meaning here (MRIcron);
    - tables with commas, semicolons or tabs, with or without column names (BIDS).

    Throw Failure that names the file, and the line where there is one.
    """
    try:
        text = _text_of(file)
        if file.lower().endswith(".json") or text.lstrip()[:1] in ("{", "["):
            names, example = _names_in_json(text), '{"1": "liver"} or {"liver": 1}'
        else:
            names, example = _names_in_table(text), "'1 liver' or '1,liver'"
        if not names:
            raise Failure(f"it names no label; labels are written as {example}")
        _scale_colors(names)
    except Failure as failure:
        raise Failure(f"{file}: names of labels cannot be read: {failure}") from None
    first = {label.value: label for label in reversed(names)}
    for label in first.values():
        label.name = plain_name(label.name)
    return [first[value] for value in sorted(first)]


def names_beside(volume: str, outputs: Iterable[str] = ()) -> tuple[list[Label], str, list[str]]:
    """The labels that a file beside a volume names, that file, and why others were not read.

    For a.nii.gz the file is a.nii.txt, a.label, a.txt, a.ctbl, a.json, a.csv or a.tsv, or
    nnU-Net's dataset.json in the folder or the one above. A report of this program and a file
    that is among the `outputs` of this run are no such files.
    """
    refused: list[str] = []
    written = {os.path.realpath(name) for name in outputs}
    for file in _files_beside(volume):
        if os.path.realpath(file) not in written and not _is_report(file):
            try:
                return read_label_names(file), file, refused
            except Failure as failure:
                refused.append(str(failure))
    return [], "", refused


def plain_name(text: str) -> str:
    """A name on one line, which UTF-8 can hold."""
    text = re.sub(r"[\x00-\x1f\x7f]", " ", text).strip()
    return text.encode("utf-8", "replace").decode()


def _files_beside(volume: str) -> list[str]:
    if not os.path.isfile(volume):
        return []
    stem, stems = volume, []  # a.nii.gz has a.nii and a; a.seg.nrrd has a.seg and a
    for ending in (".gz", "", ".seg"):
        shorter, suffix = os.path.splitext(stem)
        if suffix and ending in ("", suffix.lower()):
            stem = shorter
            stems.append(stem)
    folder = os.path.dirname(volume)
    files = [stem + suffix for stem in stems
             for suffix in (".label", ".txt", ".ctbl", ".json", ".csv", ".tsv")]
    files += [os.path.join(folder, *above, "dataset.json") for above in ((), ("..",))]
    return [file for file in files if os.path.isfile(file) and not os.path.samefile(file, volume)]


def _is_report(file: str) -> bool:
    """Whether a file is a report that this program wrote."""
    try:
        report = json.loads(_text_of(file)) if file.lower().endswith(".json") else None
    except (Failure, ValueError, RecursionError):
        return False
    versions = report.get("versions") if isinstance(report, dict) else None
    return isinstance(versions, dict) and "volumic" in versions


def _text_of(file: str) -> str:
    try:
        with open(file, "rb") as stream:
            data = stream.read(LARGEST_FILE + 1)
    except IsADirectoryError:
        raise Failure("it is a folder; give a file") from None
    except OSError as error:
        raise Failure(f"it cannot be opened ({error.strerror})") from None
    if len(data) > LARGEST_FILE:
        raise Failure("it is too large for a list of names (16 MiB)")
    if b"\0" in data:
        raise Failure("it is not text in UTF-8")
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError:
        return data.decode("latin-1")


# ---- Values --------------------------------------------------------------------------------------

def _number(value: Any) -> float | None:
    """The number that a text or a value of JSON is; None where it is none."""
    if isinstance(value, str):
        value = float(value) if NUMBER.fullmatch(value) else None
    is_number = isinstance(value, (int, float)) and not isinstance(value, bool)
    return float(value) if is_number and abs(value) < 1e300 else None


def _label(value: Any) -> int | None:
    """The label that a text or a value of JSON is: 7, "7" and "7.0" are 7."""
    number = _number(value)
    is_label = number is not None and number.is_integer() and abs(number) <= LARGEST_LABEL
    return int(number) if number is not None and is_label else None


def _hex_color(text: str) -> tuple[float, ...] | None:
    """The color "#ff8000", from 0 to 255."""
    is_color = re.fullmatch("#([0-9a-fA-F]{6})([0-9a-fA-F]{2})?", text)
    return tuple(map(float, bytes.fromhex(is_color[1]))) if is_color else None


def _scale_colors(names: list[Label]) -> None:
    """Have all colors from 0 to 1, which may be from 0 to 255."""
    for label in names:
        if not all(0 <= part <= 255 for part in label.color or ()):
            raise Failure(f"the color of label {label.value} is not between 0 and 255")
    if any(max(label.color or (0,)) > 1 for label in names):
        for label in names:
            label.color = label.color and tuple(part / 255 for part in label.color)


# ---- Segments ------------------------------------------------------------------------------------

# Members of objects of JSON and columns of tables, in small letters and digits.
LABEL_KEYS = ("labelvalue", "labelid", "labelindex", "value", "label", "index", "id", "idx",
              "number", "no", "key", "roi")
NAME_KEYS = ("name", "labelname", "segmentname", "segmentlabel", "segmentdescription", "structure",
             "structurename", "region", "regionname", "organ", "segment", "label", "text", "class",
             "description")
COLOR_KEYS = ("color", "colour", "rgb", "recommendeddisplayrgbvalue")
RGB_KEYS = (("r", "red", "colorr"), ("g", "green", "colorg"), ("b", "blue", "colorb"))


def _labels_of(segments: Iterable[Any]) -> list[Label | None]:
    """The label of each segment; None where it has no label or no name."""
    plain = [{re.sub("[^a-z0-9]", "", key.lower()): value for key, value in segment.items()}
             if isinstance(segment, dict) else {} for segment in segments]
    usual = [key for key in LABEL_KEYS if all(_label(each.get(key)) is not None for each in plain)]
    return [_label_of(segment, usual[:1] or LABEL_KEYS) for segment in plain]


def _label_of(segment: dict[str, Any], keys: Sequence[str]) -> Label | None:
    key = next((key for key in keys if _label(segment.get(key)) is not None), "")
    name = next((segment[other] for other in NAME_KEYS
                 if other != key and isinstance(segment.get(other), str)), None)
    label = _label(segment.get(key))
    return None if label is None or name is None else Label(label, name, _color_of(segment))


def _color_of(segment: dict[str, Any]) -> tuple[float, ...] | None:
    color = next((segment[key] for key in COLOR_KEYS if key in segment), None)
    if isinstance(color, str):
        return _hex_color(color)
    values = color if isinstance(color, list) else [
        segment.get(key) for keys in RGB_KEYS for key in keys if key in segment]
    parts = tuple(map(_number, values[:3]))
    return parts if len(parts) == 3 and None not in parts else None


# ---- JSON ----------------------------------------------------------------------------------------

USUAL_MEMBERS = ("labels", "label_names", "names", "segments", "segmentattributes", "class_map",
                 "classes", "structures", "organs")


def _names_in_json(text: str) -> list[Label]:
    try:
        return _find_names(json.loads(text))
    except RecursionError:
        raise Failure("it is JSON that is nested too deeply") from None
    except ValueError as error:
        raise Failure(f"it is not JSON: {error}") from None


def _find_names(value: Any) -> list[Label]:
    """The first names in a value: its own, those in usual members, those in others."""
    found: list[Label | None] = []
    if isinstance(value, dict):  # {"1": "liver"} or {"1": {"name": "liver"}} or {"liver": 1}
        found = _labels_of({**(each if isinstance(each, dict) else {"name": each}),
                            "label value": key} for key, each in value.items())
        found = _labels_by_name(value) if None in found else found
        value = [value[key] for key in sorted(value,
                                              key=lambda key: key.lower() not in USUAL_MEMBERS)]
    elif isinstance(value, list):  # [{"label": 1, "name": "liver"}], also in lists within
        found = _labels_of(segment for group in value
                           for segment in (group if isinstance(group, list) else [group]))
    if found and None not in found:
        return [label for label in found if label is not None]
    members = value if isinstance(value, list) else []
    return next(filter(None, map(_find_names, members)), [])


def _labels_by_name(value: dict[str, Any]) -> list[Label | None]:
    """{"liver": 1}; several labels under a name (regions of nnU-Net) name none of them."""
    names: list[Label | None] = []
    for name, each in value.items():
        is_region = isinstance(each, list) and each and None not in map(_number, each)
        label = _label(each[0] if is_region and len(each) == 1 else each)
        if label is not None or not is_region:
            names.append(None if label is None else Label(label, name))
    return names


# ---- Tables --------------------------------------------------------------------------------------

def _names_in_table(text: str) -> list[Label]:
    rows, separator = _rows_of(text)
    if not rows:
        return []
    numbers = [[_number(word) is not None for word in words] for _, words in rows]
    keys, first, has_head = ["label", "name", "r", "g", "b"], rows[0][0], not any(numbers[0])
    if all(row == [True] * 7 + [False] for row in numbers):  # ITK-SNAP
        keys = ["label", "r", "g", "b", "alpha", "visible", "mesh", "name"]
    elif has_head:
        keys, rows = rows[0][1], rows[1:]
    elif separator == " ":
        rows = _joined(rows, numbers)
    elif any(_label(words[0]) is None for _, words in rows) and all(
            _label(words[len(words) > 1]) is not None for _, words in rows):
        keys[:2] = ["name", "label"]
    segments = [dict(zip(keys, words)) for _, words in rows]
    names = []
    for (line, _), label, segment in zip(rows, _labels_of(segments), segments):
        name = segment.get("name", "")
        if not has_head and _number(name) is not None:
            raise Failure(f"line {line}: '{name}' is a number, not a name")
        if label is None:
            line = line if any(key.lower() in LABEL_KEYS for key in keys) else first
            raise Failure(f"line {line}: there must be a label, which is an integer, and a name, "
                          "or above them column names such as 'label' and 'name'")
        names.append(label)
    return names


def _rows_of(text: str) -> tuple[list[tuple[int, list[str]]], str]:
    """Numbers and words of lines, and what separates words: that is in the first line and most."""
    lines = [(number, line) for number, line in enumerate(re.split("\r\n?|\n", text), 1)
             if line.strip() and not line.startswith(("#", "//"))]
    separator = next((sign for sign in "\t;," if lines and sign in lines[0][1]
                      and 2 * sum(sign in line for _, line in lines) >= len(lines)), " ")
    rows = []
    for number, line in lines:
        line = " ".join(line.split()) if separator == " " else re.sub(
            f'" +(?={separator}|$)', '"', line)
        try:
            words, = csv.reader([line], delimiter=separator, strict=True,
                                skipinitialspace=separator != " ")
        except csv.Error:
            raise Failure(f"line {number}: a quote does not end, or a cell is too long") from None
        rows.append((number, [word.strip() for word in words]))
    return rows, separator


def _joined(rows: list[tuple[int, list[str]]], numbers: list[list[bool]]
            ) -> list[tuple[int, list[str]]]:
    """Rows of a label, words of a name, and numbers; the words become one."""
    at_end = min((row[:1:-1] + [False]).index(False) for row in numbers)
    # A number at the end of some names is a part of them.
    count = min(at_end, 4) if at_end >= 3 or (
        at_end == 1 and all(len(row) == 3 for row in numbers)) else 0
    return [(line, [words[0], " ".join(words[1:len(words) - count]), *words[len(words) - count:]]
             if len(words) > 1 else words) for line, words in rows]
