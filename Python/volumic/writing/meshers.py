# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Input files of tetrahedral meshers: .msh (gmsh, MSH 4.1), .smesh and .poly (TetGen); names of
sets. References: the manuals of gmsh and TetGen."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable
from typing import Any, NamedTuple

import numpy as np

from ..messages import one_line
from .regions import cell_array, find_regions, points_of, surface_labels

SIDES = ("x_min", "x_max", "y_min", "y_max", "z_min", "z_max")  # BoxFace 1 to 6
OUTSIDE = 0


class DistinctNames:
    """Generates names that are unique regardless of case."""

    def __init__(self, separator: str, plain: Callable[[str], str], reserved: Iterable[str] = ()
                 ) -> None:
        self.separator, self.plain = separator, plain
        self.taken = {name.lower() for name in reserved}

    def take(self, name: str) -> str:
        """Return a name in the characters of the format, with a number appended if it is taken."""
        plain = free = self.plain(name)
        number = 2
        while free.lower() in self.taken:
            free, number = f"{plain}{self.separator}{number}", number + 1
        self.taken.add(free.lower())
        return free


def abaqus_name(name: str) -> str:
    """Return a valid Abaqus set name: ASCII letters, digits and underscores, starting with a
    letter. With two of them and a number, a name has fewer than 80 characters."""
    text = "".join(c if c.isascii() and c.isalnum() else "_" for c in name.encode()[:30].decode(
        "latin-1"))
    return text if text[:1].isalpha() else "L_" + text


def gmsh_name(name: str) -> str:
    return one_line(name, 50).replace('"', "'")


class SetNames(NamedTuple):
    """Names of all sets of a file."""
    labels: dict[int, str]
    pairs: dict[tuple[int, int], str]  # adjacent labels; OUTSIDE is second
    parts: dict[int, str]              # box faces 1 to 6, caps from 7

    @classmethod
    def of(cls, labels: dict[int, str], pairs: Iterable[tuple[int, int]], parts: Iterable[int],
           names: DistinctNames) -> SetNames:
        """Return the names. Labels keep theirs; box faces, caps and pairs of labels avoid them."""
        own = {number: names.take(name) for number, name in labels.items()}
        called = {**own, OUTSIDE: names.take("outside")}
        plain, names.plain = names.plain, str
        pair_names = {(a, b): names.take(f"{called[a]}_to_{called[b]}") for a, b in pairs}
        part_names = {part: names.take(SIDES[part - 1] if part <= 6 else f"cap_{part - 6}")
                      for part in sorted(parts)}
        names.plain = plain
        return cls(own, pair_names, part_names)


def cap_names(surface: Any) -> dict[int, str]:
    """Return unique names of the caps of --ends marked by number, such as `cap_1`."""
    caps = cell_array(surface, "Cap")
    names = DistinctNames("_", str, [label.name for label in surface_labels(surface)])
    return {} if caps is None else {
        cap: names.take(f"cap_{cap}") for cap in np.unique(caps).tolist() if cap > 0}


def parts_of(surface: Any) -> np.ndarray:
    """Return the part of each triangle: 0 (none), box face (1 to 6), or 6 + number of the cap."""
    box, caps = cell_array(surface, "BoxFace"), cell_array(surface, "Cap")
    parts = np.zeros(surface.GetNumberOfPolys(), int) if box is None else box.astype(int)
    return parts if caps is None else np.where(caps > 0, 6 + caps, parts)


def rows(form: str, *columns: Any) -> str:
    """Return one line per row of the columns, which may have several components."""
    lists = [part.tolist() for column in columns for part in np.atleast_2d(np.asarray(column).T)]
    return "".join(map((form + "\n").__mod__, zip(*lists)))


def write_lines(path: str, *parts: str) -> None:
    with open(path, "w", encoding="utf-8", newline="\n") as file:
        for part in parts:
            file.write(part)


def _digits(points: np.ndarray) -> str:
    """Return a format that preserves coordinates exactly."""
    return "%.9g" if points.dtype == np.float32 else "%r"


class _Boundaries:
    """Triangles of a surface in groups of equal adjacent regions and part (0, box face or cap)."""

    def __init__(self, surface: Any) -> None:
        self.points = points_of(surface)
        self.regions = find_regions(surface)
        labels = self.regions.labels
        numbers = np.array([label.number for label in labels] + [OUTSIDE])
        self.number = numbers[self.regions.label]  # label of each region
        self.parts = parts_of(surface)
        keys = np.stack([self.regions.behind, self.regions.in_front, self.parts], axis=1)
        self.groups, self.group = np.unique(keys, axis=0, return_inverse=True)
        self.group = self.group.ravel()
        # One marker per part or pair of adjacent labels.
        ends = self.number[self.groups[:, :2]]
        self.kinds = [(0, 0, part) if part else (a, b, 0)
                      for (a, b), part in zip(ends.tolist(), self.groups[:, 2].tolist())]
        self.marks = {kind: i + 1 for i, kind in enumerate(
            sorted(set(self.kinds), key=lambda kind: (kind[2], kind)))}
        self.names = SetNames.of(
            {label.number: label.name for label in labels},
            [kind[:2] for kind in self.marks if not kind[2]],
            [kind[2] for kind in self.marks if kind[2]], DistinctNames(" ", gmsh_name))

    def name(self, kind: tuple[int, int, int]) -> str:
        return self.names.parts[kind[2]] if kind[2] else self.names.pairs[kind[:2]]


def write_msh(surface: Any, path: str, remark: str = "") -> None:
    """Write the triangles as MSH 4.1. Physical surfaces are parts and pairs of labels, physical
    volumes are labels. Volumes have no elements but refer to their boundary surfaces."""
    mesh = _Boundaries(surface)
    regions, points, count = mesh.regions, mesh.points, len(mesh.groups)
    filled_regions = int((regions.label >= 0).sum())
    filled = np.unique(mesh.number[1:filled_regions + 1]).tolist()
    head = [f"$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Comments\n{remark}\n$EndComments\n"
            f"$PhysicalNames\n{len(mesh.marks) + len(filled)}\n"]
    head += [f'2 {mark} "{mesh.name(kind)}"\n' for kind, mark in mesh.marks.items()]
    head += [f'3 {number} "{mesh.names.labels[number]}"\n' for number in filled]
    head.append(f"$EndPhysicalNames\n$Entities\n0 0 {count} {filled_regions}\n")
    members = [regions.triangles[mesh.group == i] for i in range(count)]
    low, high = (np.array([end(points[m.ravel()].astype(float), axis=0) for m in members])
                 for end in (np.min, np.max))

    def box(which: Any) -> str:
        return " ".join(map(repr, [*low[which].min(0).tolist(), *high[which].max(0).tolist()]))

    for i in range(count):
        head.append(f"{i + 1} {box([i])} 1 {mesh.marks[mesh.kinds[i]]} 0\n")
    for region in range(1, filled_regions + 1):
        # A minus sign marks surfaces whose normals point into the volume.
        bounds = [(i, "" if mesh.groups[i, 0] == region else "-") for i in range(count)
                  if region in mesh.groups[i, :2]]
        head.append(f"{region} {box([i for i, _ in bounds])} 1 {mesh.number[region]} {len(bounds)}"
                    + "".join(f" {sign}{i + 1}" for i, sign in bounds) + "\n")
    # A point belongs to the first surface that uses it.
    owner = np.full(len(points), count)
    np.minimum.at(owner, regions.triangles, mesh.group[:, None])
    order = np.argsort(owner, kind="stable")[:(owner < count).sum()]
    numbers = np.zeros(len(points), int)
    numbers[order] = np.arange(1, len(order) + 1)
    sizes = np.bincount(owner[order], minlength=count)
    text = [f"$EndEntities\n$Nodes\n{(sizes > 0).sum()} {len(order)} 1 {len(order)}\n"]
    for i in np.flatnonzero(sizes):
        own = order[owner[order] == i]
        text += [f"2 {i + 1} 0 {sizes[i]}\n", rows("%d", numbers[own]),
                 rows(" ".join([_digits(points)] * 3), points[own])]
    text.append(f"$EndNodes\n$Elements\n{count} {len(mesh.group)} 1 {len(mesh.group)}\n")
    last = 0
    for i, triangles in enumerate(members):
        text += [f"2 {i + 1} 2 {len(triangles)}\n",
                 rows("%d %d %d %d", last + 1 + np.arange(len(triangles)), numbers[triangles])]
        last += len(triangles)
    write_lines(path, *head, *text, "$EndElements\n")


def write_tetgen(surface: Any, path: str, remark: str = "") -> None:
    """Write a .smesh or .poly file. Facet markers match the physical surfaces of .msh. Each region
    has a point with the label as attribute, each cavity a hole point."""
    mesh = _Boundaries(surface)
    regions, points = mesh.regions, mesh.points
    poly = os.path.splitext(path)[1].lower() == ".poly"
    head = [f"# {remark}\n"]
    head += [f"# region {number}: {name}\n" for number, name in mesh.names.labels.items()]
    head += [f"# facets {mark}: {mesh.name(kind)}\n" for kind, mark in mesh.marks.items()]
    digits = " ".join([_digits(points)] * 3)
    marks = np.array([mesh.marks[kind] for kind in mesh.kinds])[mesh.group]
    facets = (("1 0 %d\n3 %d %d %d", marks, regions.triangles + 1) if poly
              else ("3 %d %d %d %d", regions.triangles + 1, marks))
    holes, filled = (np.flatnonzero(chosen) + 1 for chosen in (regions.label[1:] < 0,
                                                               regions.label[1:] >= 0))
    write_lines(path, *head, f"{len(points)} 3 0 0\n",
           rows("%d " + digits, np.arange(1, len(points) + 1), points),
           f"{len(marks)} 1\n", rows(*facets), f"{len(holes)}\n",
           rows("%d %r %r %r", np.arange(1, len(holes) + 1), regions.inside[holes]),
                f"{len(filled)}\n",
                rows("%d %r %r %r %d", np.arange(1, len(filled) + 1), regions.inside[filled],
                     mesh.number[filled]))
