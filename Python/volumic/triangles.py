# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""--triangles: search for the tolerance or edge length that yields a number of triangles."""

from __future__ import annotations

import math
from collections.abc import Callable

from .errors import Failure
from .messages import Console, number_text, was_interrupted

MAXIMUM_RUNS = 12
MAXIMUM_RATIO = 1.1  # between the numbers of triangles, found and target

Make = Callable[[float, float], "tuple[int, float]"]


def find_triangles(make: Make, target: int, unit: float, console: Console) -> None:
    """Compute surfaces with about `target` triangles. Search for a tolerance, or, if uniform edges
    yield too few triangles or no tolerance yields so few, for an edge length. make(edge length,
    tolerance) returns the number of triangles and their area, in world units; `unit` is the
    smallest voxel spacing. Raise Failure if the search fails."""
    tried: list[int] = []

    def run(edge_length: float, tolerance: float) -> tuple[int, float]:
        try:
            found = make(edge_length, tolerance)
        except Failure:
            if edge_length == 0.0:
                raise
            found = 0, 0.0  # the image allows no such edges
        tried.append(found[0])
        if found[0] and not was_interrupted():
            console.info((f"edge length {number_text(edge_length)}" if edge_length else
                          f"tolerance {number_text(tolerance)}") + f": {found[0]} triangles")
        return found

    def is_done() -> bool:
        return was_interrupted() or target / MAXIMUM_RATIO < tried[-1] < MAXIMUM_RATIO * target

    uniform, area = run(0.0, 0.0)
    if is_done() or uniform == 0 or (uniform > target and _find_tolerance(
            run, is_done, uniform, target, 0.2 * unit)):
        return
    # The number of triangles is proportional to the inverse square of the edge length.
    length = math.sqrt(4 * area / (math.sqrt(3) * uniform))
    edge = length * math.sqrt(uniform / target)
    for _ in range(MAXIMUM_RUNS // 2):
        now, _ = run(_rounded(edge), 0.0)
        if is_done():
            return
        length, edge = (length, (length + edge) / 2) if now == 0 else (
            edge, edge * math.sqrt(now / target))
    nearest = min(filter(None, tried), key=lambda found: abs(math.log(found / target)))
    raise Failure(f"--triangles {target}: no tolerance or edge length yields this number; the "
                  f"nearest is {nearest}. Choose a number closer to it")


def _find_tolerance(run: Make, is_done: Callable[[], bool], uniform: int, target: int,
                    tolerance: float) -> bool:
    """Search for a tolerance. Return whether the last run met the target or was interrupted."""
    fine: tuple[float, int] = (0.0, uniform)
    coarse: tuple[float, int] | None = None
    for _ in range(MAXIMUM_RUNS // 2):
        now, _ = run(0.0, tolerance)
        if is_done():
            return True
        if now < target:
            coarse = (tolerance, max(now, 1))
        elif now > 0.98 * fine[1]:
            return False  # larger tolerances hardly reduce the number
        else:
            fine = (tolerance, now)
        if coarse is None:
            tolerance *= 2
        else:
            fraction = math.log(fine[1] / target) / math.log(fine[1] / coarse[1])
            lowest = fine[0] or coarse[0] / 4
            tolerance = _rounded(lowest * (coarse[0] / lowest) ** min(max(fraction, 0.1), 0.9))
    return False


def _rounded(length: float) -> float:
    return float(f"{length:.4g}")
