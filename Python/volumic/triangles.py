# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""--triangles: the tolerance or the edge length with which surfaces have a number of triangles."""

from __future__ import annotations

import math
from collections.abc import Callable

from .errors import Failure
from .messages import Teller, number_text, was_interrupted

TRIES = 12  # runs at most
NEAR = 1.1  # ratio of triangles that is near enough

Make = Callable[[float, float], "tuple[int, float]"]


def find_triangles(make: Make, wanted: int, unit: float, teller: Teller) -> None:
    """Make surfaces until they have about `wanted` triangles: with a tolerance, or, where more are
    wanted than uniform edges have or no tolerance leaves so few, with an edge length.

    `make(edge length, tolerance)`, in world units, makes the surfaces and returns their triangles
    and area; unit is the smallest voxel distance. Throw Failure where no run comes near.
    """
    tried: list[int] = []

    def run(edge_length: float, tolerance: float) -> tuple[int, float]:
        try:
            found = make(edge_length, tolerance)
        except Failure:
            if edge_length == 0.0:
                raise
            found = 0, 0.0  # no pyramid of this image has such edges
        tried.append(found[0])
        if found[0] and not was_interrupted():
            teller.say((f"edge length {number_text(edge_length)}" if edge_length else
                        f"tolerance {number_text(tolerance)}") + f": {found[0]} triangles")
        return found

    def ended() -> bool:
        return was_interrupted() or wanted / NEAR < tried[-1] < NEAR * wanted

    uniform, area = run(0.0, 0.0)
    if ended() or uniform == 0 or (uniform > wanted and _find_tolerance(
            run, ended, uniform, wanted, 0.2 * unit)):
        return
    # The number of triangles goes with the inverse square of the edge length.
    length = math.sqrt(4 * area / (math.sqrt(3) * uniform))
    edge = length * math.sqrt(uniform / wanted)
    for _ in range(TRIES // 2):
        now, _ = run(_rounded(edge), 0.0)
        if ended():
            return
        length, edge = (length, (length + edge) / 2) if now == 0 else (
            edge, edge * math.sqrt(now / wanted))
    nearest = min(filter(None, tried), key=lambda found: abs(math.log(found / wanted)))
    raise Failure(f"--triangles {wanted}: no tolerance and no edge length gives about so many; the "
                  f"nearest surface has {nearest}. Choose a number nearer to that")


def _find_tolerance(run: Make, ended: Callable[[], bool], uniform: int, wanted: int,
                    tolerance: float) -> bool:
    """Search from a tolerance on; return whether the last run ended the search."""
    fine: tuple[float, int] = (0.0, uniform)
    coarse: tuple[float, int] | None = None
    for _ in range(TRIES // 2):
        now, _ = run(0.0, tolerance)
        if ended():
            return True
        if now < wanted:
            coarse = (tolerance, max(now, 1))
        elif now > 0.98 * fine[1]:
            return False  # no tolerance leaves fewer
        else:
            fine = (tolerance, now)
        if coarse is None:
            tolerance *= 2
        else:
            share = math.log(fine[1] / wanted) / math.log(fine[1] / coarse[1])
            least = fine[0] or coarse[0] / 4
            tolerance = _rounded(least * (coarse[0] / least) ** min(max(share, 0.1), 0.9))
    return False


def _rounded(length: float) -> float:
    return float(f"{length:.4g}")
