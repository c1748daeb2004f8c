# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Parsers of the values of options. Each throws UsageError that names the text."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from typing import Any

from .errors import UsageError

Parse = Callable[[str], Any]


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


def at_least(least: int, parse: Parse = whole) -> Parse:
    """A number that is not less than a bound."""
    def parse_limited(text: str) -> Any:
        if parse(text) < least:
            raise UsageError(f"{text} is less than {least}")
        return parse(text)
    return parse_limited


def more_than_0(text: str) -> float:
    """A positive number."""
    if number(text) <= 0:
        raise UsageError(f"{text} must be more than 0")
    return number(text)


def numbers(count: int, parse: Parse = number) -> Callable[[str], tuple[Any, ...]]:
    """So many numbers with commas between."""
    def parse_all(text: str) -> tuple[Any, ...]:
        parts = text.split(",")
        if len(parts) != count:
            raise UsageError(f"'{text}' are {len(parts)} numbers, not {count}")
        return tuple(parse(part.strip()) for part in parts)
    return parse_all


def box(parse: Parse) -> Callable[[str], tuple[Any, ...]]:
    """From and to along each axis."""
    def parse_box(text: str) -> tuple[Any, ...]:
        found = numbers(6, parse)(text)
        if any(found[i] > found[i + 1] for i in (0, 2, 4)):
            raise UsageError(f"'{text}' ends before it begins")
        return found
    return parse_box


def one_of(*words: str, separator: str = ", ") -> Callable[[str], str]:
    """One of the words."""
    def parse(text: str) -> str:
        if text not in words:
            raise UsageError(f"'{text}' is none of {separator.join(words)}")
        return text
    return parse


def unit(text: str) -> str:
    """A unit of length."""
    from .reading.volume import METERS, unit_of
    return unit_of(text) or one_of(*METERS)(text)
