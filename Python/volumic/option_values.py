# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Parsers of the values of options. Each throws UsageError that names the text."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from typing import Any

from .errors import UsageError

def number(text: str) -> float:
    """A finite number."""
    if not re.fullmatch(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?", text) \
            or not math.isfinite(float(text)):
        raise UsageError(f"'{text}' is not a number")
    return float(text)


def whole(text: str) -> int:
    """A whole number that an int of C holds."""
    if not re.fullmatch(r"[+-]?\d+", text) or abs(int(text)) >= 2 ** 31:
        raise UsageError(f"'{text}' is not a whole number")
    return int(text)


def numbers(count: int) -> Callable[[str], tuple[float, ...]]:
    """So many numbers with commas between."""
    def parse(text: str) -> tuple[float, ...]:
        found = tuple(number(part.strip()) for part in text.split(","))
        if len(found) != count:
            raise UsageError(f"'{text}' are {len(found)} numbers, not {count}")
        return found
    return parse


def more_than_0(text: str) -> float:
    """A positive number."""
    if number(text) <= 0:
        raise UsageError(f"{text} must be more than 0")
    return number(text)


def depth(text: str) -> float:
    """A length of 0 or more."""
    if number(text) < 0:
        raise UsageError("a depth is not less than 0")
    return number(text)


def index(text: str) -> int:
    """A whole number from 0."""
    if whole(text) < 0:
        raise UsageError(f"{text} is less than 0; the first one is 0")
    return whole(text)


def one_of(*words: str, separator: str = ", ") -> Callable[[str], str]:
    """One of the words."""
    def parse(text: str) -> str:
        if text not in words:
            raise UsageError(f"'{text}' is none of {separator.join(words)}")
        return text
    return parse


def spacing(text: str) -> tuple[float, ...]:
    """Three positive lengths."""
    found = numbers(3)(text)
    if min(found) <= 0:
        raise UsageError("voxel distances must be more than 0")
    return found


def box(kind: Callable[[str], Any]) -> Callable[[str], tuple[Any, ...]]:
    """From and to along each axis."""
    def parse(text: str) -> tuple[Any, ...]:
        found = numbers(6)(text)
        if kind is whole and any(value != int(value) for value in found):
            raise UsageError("voxels are counted in whole numbers")
        if any(found[i] > found[i + 1] for i in (0, 2, 4)):
            raise UsageError(f"'{text}' ends before it begins")
        return tuple(int(value) for value in found) if kind is whole else found
    return parse


def unit(text: str) -> str:
    """A unit of length."""
    from .reading.volume import unit_of
    if not unit_of(text):
        raise UsageError(f"'{text}' is none of m, cm, mm, um, nm, A")
    return unit_of(text)


def triangles(text: str) -> int:
    """A number of triangles."""
    if whole(text) < 20:
        raise UsageError("a surface has 20 triangles at least")
    return whole(text)
