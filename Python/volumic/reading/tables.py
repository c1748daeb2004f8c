# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Names and colors of labels, from the files in which programs and people keep them."""

from __future__ import annotations

import csv
import json
import os
import re
from collections.abc import Iterable, Sequence
from typing import Any, NamedTuple

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


# ---- JSON ----------------------------------------------------------------------------------------

LABEL_KEYS = ("labelvalue", "labelid", "label_value", "label_id", "value", "label", "index", "id",
              "number", "key")
NAME_KEYS = ("name", "labelname", "segmentlabel", "segmentdescription", "structure", "label",
             "text", "description")
COLOR_KEYS = ("color", "colour", "rgb", "recommendeddisplayrgbvalue")
USUAL_KEYS = ("labels", "label_names", "names", "segments", "segmentattributes", "class_map",
              "classes", "structures", "organs")


def _names_in_json(text: str) -> list[Label]:
    try:
        return _find_names(json.loads(text))
    except RecursionError:
        raise Failure("it is JSON that is nested too deeply") from None
    except ValueError as error:
        raise Failure(f"it is not JSON: {error}") from None


def _find_names(value: Any) -> list[Label]:
    """The first names in a value: its own, those in members with a usual key, those in others."""
    if isinstance(value, dict):
        names = _names_by_label(value) or _labels_by_name(value)
        value = [value[key] for key in sorted(value, key=lambda key: key.lower() not in USUAL_KEYS)]
    else:
        names = _names_in_list(value) if isinstance(value, list) else []
    members = value if isinstance(value, list) else []
    return names or next(filter(None, map(_find_names, members)), [])


def _names_by_label(value: dict[str, Any]) -> list[Label]:
    """{"1": "liver"} or {"1": {"name": "liver"}}; nothing where any member is something else."""
    names = [(_label(key), each if isinstance(each, str) else _member(each, NAME_KEYS, str),
              _color_of(each)) for key, each in value.items()]
    return [] if any(None in name[:2] for name in names) else [Label(*name) for name in names]


def _labels_by_name(value: dict[str, Any]) -> list[Label]:
    """{"liver": 1}; nothing where any member is something else. Several labels under a name
    (regions of nnU-Net) name none of them."""
    names = []
    for name, each in value.items():
        is_region = isinstance(each, list) and each and None not in map(_number, each)
        label = _label(each[0] if is_region and len(each) == 1 else each)
        if label is not None:
            names.append(Label(label, name))
        elif not is_region:
            return []
    return names


def _names_in_list(value: list[Any]) -> list[Label]:
    """[{"label": 1, "name": "liver"}, ...], also in lists within; nothing where any member is
    something else."""
    segments = [each for group in value for each in (group if isinstance(group, list) else [group])]
    names = [(_label(_member(each, LABEL_KEYS, (int, float, str), _label)),
              _member(each, NAME_KEYS, str), _color_of(each)) for each in segments]
    return [] if any(None in name[:2] for name in names) else [Label(*name) for name in names]


def _member(value: Any, keys: Sequence[str], types: Any, passes: Any = bool) -> Any:
    """The first member with one of the keys, in any case, that is of a type and passes."""
    members = {key.lower(): each for key, each in value.items()} if isinstance(value, dict) else {}
    return next((members[key] for key in keys if isinstance(members.get(key), types)
                 and passes(members[key]) is not None), None)


def _color_of(segment: Any) -> tuple[float, ...] | None:
    color = _member(segment, COLOR_KEYS, (str, list))
    if isinstance(color, list):
        parts = tuple(map(_number, color[:3]))
        return parts if len(parts) == 3 and None not in parts else None
    return _hex_color(color) if color else None


# ---- Tables --------------------------------------------------------------------------------------

NAME_COLUMNS = ("name", "labelname", "segmentname", "structure", "structurename", "region",
                "regionname", "organ", "segment", "description")
LABEL_COLUMNS = ("labelvalue", "value", "index", "labelid", "labelindex", "id", "idx", "number",
                 "no", "key", "roi", "label")
COLOR_COLUMNS = (("r", "red", "colorr", "color", "colour"), ("g", "green", "colorg"),
                 ("b", "blue", "colorb"))


class _Row(NamedTuple):
    line: int  # counted from 1
    words: list[str]

    def failure(self, reason: str) -> Failure:
        return Failure(f"line {self.line}: {reason}")

    def word(self, column: int | None) -> str:
        return self.words[column] if column is not None and column < len(self.words) else ""

    def numbers(self) -> list[bool]:
        """Which words are numbers."""
        return [_number(word) is not None for word in self.words]


def _names_in_table(text: str) -> list[Label]:
    rows, separator = _rows_of(text)
    if not rows:
        return []
    if all(row.numbers() == [True] * 7 + [False] for row in rows):  # ITK-SNAP
        return _names_in_columns(rows, 0, 7, (1, 2, 3))
    if not any(rows[0].numbers()):
        return _names_below(rows[0], rows[1:])
    if separator == " ":
        return _names_between_numbers(rows)
    label = 1 if any(_label(row.word(0)) is None for row in rows) and all(
        _label(row.word(1)) is not None for row in rows) else 0
    for row in rows:
        if _number(row.word(1 - label)) is not None:
            raise row.failure(f"'{row.word(1 - label)}' is a number, not a name")
    return _names_in_columns(rows, label, 1 - label, (2, 3, 4))


def _rows_of(text: str) -> tuple[list[_Row], str]:
    """The rows of a table, and what separates words: that is in the first line and most others."""
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
        rows.append(_Row(number, [word.strip() for word in words]))
    return rows, separator


def _names_below(head: _Row, rows: list[_Row]) -> list[Label]:
    """The rows below column names."""
    keys = [re.sub("[^a-z0-9]", "", word.lower()) for word in head.words]

    def column(names: Sequence[str], other: int | None = None) -> int | None:
        return next((place for name in names for place, key in enumerate(keys)
                     if key == name and place != other), None)

    name = column(NAME_COLUMNS)
    label = column(LABEL_COLUMNS, name)
    if name is None:
        name = column(("label", "text", "class"), label)
    if label is None or name is None:
        raise head.failure("there are neither a label and its name, nor column names such as "
                           "'label' and 'name'")
    return _names_in_columns(rows, label, name, [column(names) for names in COLOR_COLUMNS])


def _names_in_columns(rows: list[_Row], label: int, name: int,
                      colors: Sequence[int | None]) -> list[Label]:
    names = []
    for row in rows:
        if len(row.words) <= max(label, name):
            raise row.failure("it has too few columns for a label and a name")
        value = _label(row.words[label])
        if value is None:
            raise row.failure(f"'{row.words[label][:40]}' is not a label; labels are integers")
        names.append(Label(value, row.words[name], _row_color(row, colors)))
    return names


def _row_color(row: _Row, columns: Sequence[int | None]) -> tuple[float, ...] | None:
    parts = tuple(_number(row.word(column)) for column in columns)
    return parts if None not in parts else _hex_color(row.word(columns[0]))


def _names_between_numbers(rows: list[_Row]) -> list[Label]:
    """Rows of a label, words of a name, and numbers."""
    at_end = [(row.numbers()[:1:-1] + [False]).index(False) for row in rows]
    numbers = min(min(at_end), 4)
    # A number at the end of some names is a part of them.
    if numbers < 3 and not (numbers == 1 and all(len(row.words) == 3 for row in rows)):
        numbers = 0
    names = []
    for row in rows:
        label, end = _label(row.word(0)), len(row.words) - numbers
        if label is None or len(row.words) < 2:
            raise row.failure("there must be a label, which is an integer, and a name")
        name = " ".join(row.words[1:end])
        if _number(name) is not None:
            raise row.failure(f"'{name}' is a number, not a name")
        names.append(Label(label, name, _row_color(row, (end, end + 1, end + 2))))
    return names
