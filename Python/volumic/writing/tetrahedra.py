# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Tetrahedra that fill a surface, or the interfaces of labels, by TetGen or gmsh. These run as
programs, since their licences differ from ours."""

from __future__ import annotations

import dataclasses
import os
import re
import shutil
import subprocess
import tempfile
import time
from collections.abc import Callable
from typing import Any

import numpy as np

from ..errors import Failure
from .meshers import write_msh, write_tetgen
from .regions import cell_array, labels_of_sides, solid_labels, triangles_of
from .solids import TETRAHEDRA

MESHERS = ("tetgen", "gmsh")
MOST_TETRAHEDRA = 2e8
LEAST_ANGLE = 5.0  # degrees; smaller dihedral angles are reported
CHUNK = 1 << 18    # tetrahedra at once

# gmsh regards volumes of a file as meshed, with or without elements. Each one is replaced by a
# volume of gmsh's own with the same boundary and physical group.
OWN_VOLUMES = """p() = Physical Volume{:};
For k In {0 : #p() - 1}
  v() = Physical Volume{p(k)};
  For i In {0 : #v() - 1}
    b() = Boundary{ Volume{v(i)}; };
    Delete{ Volume{v(i)}; }
    Surface Loop(v(i)) = b();
    Volume(v(i)) = {v(i)};
  EndFor
  Physical Volume(p(k)) = v();
EndFor
"""


def needs_mesher(name: str, mesher: str = "") -> bool:
    """Whether a file of this name holds tetrahedra; .msh does where a mesher is chosen."""
    suffix = os.path.splitext(name)[1].lower()
    return suffix in TETRAHEDRA or (suffix == ".msh" and bool(mesher))


def find_mesher(mesher: str = "") -> str:
    """The program that will run. Throw Failure that says what to install if there is none."""
    for program in (mesher,) if mesher else MESHERS:
        if shutil.which(program):
            return program
    if mesher:
        raise Failure(f"{mesher} is not installed (Debian: apt install {mesher})")
    raise Failure("tetrahedra are made by TetGen or gmsh, none of which is installed (Debian: apt "
                  "install tetgen)")


@dataclasses.dataclass
class Solid:
    """Tetrahedra, each within one label. The first points are those of the surface."""
    grid: Any                # vtkUnstructuredGrid; cell array Label, field data of the surface
    points: np.ndarray       # n x 3
    cells: np.ndarray        # m x 4, of positive volume
    labels: np.ndarray       # of the tetrahedra
    names: dict[int, str]    # of the labels
    mesher: str
    marked: np.ndarray       # triangles in sides of a box and in caps, k x 3
    marks: np.ndarray        # their BoxFace and Cap, k x 2
    least_angle: float = 0.0    # between two faces of a tetrahedron, degrees
    percent_angle: float = 0.0  # 1 % of the tetrahedra have a smaller one
    regions: dict[int, tuple[int, float]] = dataclasses.field(default_factory=dict)
    point_values: dict[str, np.ndarray] = dataclasses.field(default_factory=dict)
    cell_values: dict[str, np.ndarray] = dataclasses.field(default_factory=dict)


class SolidMaker:
    """Fills surfaces with tetrahedra and keeps the last result, for the next file of the same
    surface.

    maximum_volume limits tetrahedra (0: no limit). The program ends when interrupted() becomes
    true or time.monotonic() exceeds the deadline. probe(points) gives values, {name: array}, which
    the solid gets at its points and cells.
    """

    def __init__(self, mesher: str = "", maximum_volume: float = 0.0,
                 interrupted: Callable[[], bool] | None = None, deadline: float | None = None,
                 probe: Callable[[np.ndarray], dict[str, np.ndarray]] | None = None) -> None:
        self.mesher, self.maximum_volume, self.deadline = mesher, maximum_volume, deadline
        self.interrupted = interrupted or (lambda: False)
        self.probe = probe
        self.last: Solid | None = None
        self._surface: Any = None

    def make(self, surface: Any, beside: str, progress: Callable[..., None] | None = None,
             tell: Callable[[str], None] | None = None) -> Solid:
        """Fill a surface. While the program runs it has a folder beside the file `beside`.

        Throw Failure without the name of a file: what the program says if it fails, or that it was
        interrupted.
        """
        if self.last is not None and self._surface is surface:
            return self.last
        program = find_mesher(self.mesher)
        self._check_size(surface)
        progress = progress or (lambda *_: None)
        with tempfile.TemporaryDirectory(prefix=".volumic-",
                                         dir=os.path.dirname(os.path.abspath(beside))) as folder:
            name = os.path.join(folder, "solid.msh" if program == "gmsh" else "solid.smesh")
            (write_msh if program == "gmsh" else write_tetgen)(surface, name)
            progress(0.1)
            self._run(self._words(program, folder), folder)
            progress(0.8)
            made = os.path.join(folder, "solid.mesh" if program == "gmsh" else "solid.1.mesh")
            solid = _solid_of(made, surface, program)
        _measure(solid)
        self._add_values(solid)
        if tell and solid.least_angle < LEAST_ANGLE:
            tell(f"the least dihedral angle of the tetrahedra is {solid.least_angle:.2g} degrees, "
                 f"less than the {LEAST_ANGLE:g} that solvers need: the surface has thin or sharp "
                 "parts; try another --edge-length, --smoothing or --region")
        self.last, self._surface = solid, surface
        return solid

    def _check_size(self, surface: Any) -> None:
        """Throw Failure if the limit of the volume means tetrahedra without number."""
        from vtkmodules.util.numpy_support import vtk_to_numpy
        if self.maximum_volume <= 0:
            return
        points, triangles = vtk_to_numpy(surface.GetPoints().GetData()), triangles_of(surface)
        a, b, c = np.moveaxis(points[triangles] - points.mean(axis=0), 1, 0)
        filled = (labels_of_sides(surface, len(triangles)) >= 0).reshape(-1, 2)
        ways = filled[:, 0].astype(int) - filled[:, 1]
        volume = float((ways * (a * np.cross(b, c)).sum(1)).sum() / 6)
        if volume > MOST_TETRAHEDRA * self.maximum_volume:
            raise Failure(f"--maximum-volume {self.maximum_volume:g} means more than "
                          f"{MOST_TETRAHEDRA:.0e} tetrahedra; choose at least "
                          f"{volume / MOST_TETRAHEDRA:.1g}")

    def _words(self, program: str, folder: str) -> list[str]:
        limit = self.maximum_volume
        if program == "tetgen":
            # p: fill the triangles, Y: keep these, A: with labels, q: dihedral angles of 8 degrees
            # where the triangles allow that.
            return ["tetgen", "-pYAq/8gNEF" + (f"a{limit!r}" if limit > 0 else ""), "solid.smesh"]
        with open(os.path.join(folder, "volumes.geo"), "w", encoding="ascii") as file:
            file.write(OWN_VOLUMES)
        # The edge length of a regular tetrahedron of this volume.
        size = ["-clmax", repr(float(np.cbrt(6 * np.sqrt(2) * limit)))] if limit > 0 else []
        return ["gmsh", "-3", "solid.msh", "volumes.geo", "-o", "solid.mesh", "-format", "mesh",
                "-setnumber", "Mesh.SaveElementTagType", "2", "-v", "2", *size]

    def _run(self, words: list[str], folder: str) -> None:
        """Run a program until it ends, is interrupted or the time is over."""
        log = os.path.join(folder, "log")
        # The result of an interrupted run is filled, too, and can then not be interrupted again.
        may_stop, stopped = not self.interrupted(), ""
        try:
            with open(log, "wb") as output:
                process = subprocess.Popen(words, cwd=folder, stdin=subprocess.DEVNULL,
                                           stdout=output, stderr=subprocess.STDOUT)
        except OSError as error:
            raise Failure(f"{words[0]} cannot be run ({error.strerror})") from None
        try:
            while process.poll() is None and not stopped:
                if may_stop and self.interrupted():
                    stopped = "interrupted"
                elif self.deadline is not None and time.monotonic() > self.deadline:
                    stopped = "the time limit came"
                else:
                    time.sleep(0.01)
        finally:
            if process.poll() is None:
                process.kill()
            code = process.wait()
        if not stopped and code != 0 and may_stop and self.interrupted():
            stopped = "interrupted"  # the signal reached the program, too
        if stopped:
            raise Failure(f"{stopped} while {words[0]} made tetrahedra; not written")
        if code != 0:
            reason = f"exit code {code}" if code > 0 else f"signal {-code}"
            raise Failure(f"{words[0]} fails ({reason}): {_end_of(log)}")

    def _add_values(self, solid: Solid) -> None:
        """Give the solid the values of the probe: at its points, and the means within its cells
        (centroid and four points half-way to the corners). Labels are those at the centroids."""
        if self.probe is None:
            return
        from vtkmodules.util.numpy_support import numpy_to_vtk
        corners = solid.points[solid.cells]
        center = corners.mean(axis=1)
        solid.point_values = self.probe(solid.points)
        samples = [self.probe(center)]
        if any(values.dtype.kind == "f" for values in samples[0].values()):
            samples += [self.probe((center + corners[:, i]) / 2) for i in range(4)]
        for name, values in samples[0].items():
            if values.dtype.kind == "f":
                parts = np.stack([sample[name] for sample in samples])
                known = ~np.isnan(parts)
                with np.errstate(invalid="ignore"):
                    values = np.where(known, parts, 0).sum(0) / known.sum(0)
            solid.cell_values[name] = values
        for data, found in ((solid.grid.GetPointData(), solid.point_values),
                            (solid.grid.GetCellData(), solid.cell_values)):
            for name, values in found.items():
                array = numpy_to_vtk(np.ascontiguousarray(values), deep=True)
                array.SetName(name)
                data.AddArray(array)


# ---- What a program has made -------------------------------------------------------------------

def _end_of(log: str) -> str:
    """The last lines that a program printed, without the dashes of gmsh."""
    with open(log, encoding="utf-8", errors="replace") as file:
        lines = [line.strip() for line in file if line.strip() and "-----" not in line]
    return "; ".join(lines[-3:])[:400]


def _numbers(text: str, keyword: str, columns: int) -> np.ndarray:
    """The rows of a section of a Medit file."""
    found = re.search(rf"^\s*{keyword}\s+(\d+)", text, re.MULTILINE)
    if found is None:
        return np.zeros((0, columns))
    end = re.compile(r"^\s*[A-Za-z#]", re.MULTILINE).search(text, found.end())
    numbers = np.fromstring(text[found.end():end.start() if end else None], sep=" ")
    if len(numbers) != columns * int(found[1]):
        raise Failure(f"the mesher's file is damaged: {keyword} are missing")
    return numbers.reshape(-1, columns)


def _solid_of(path: str, surface: Any, mesher: str) -> Solid:
    """Read a Medit file. The surface's points come first, in their order and with all digits."""
    from scipy.spatial import cKDTree
    from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
    from vtkmodules.vtkCommonCore import vtkPoints
    from vtkmodules.vtkCommonDataModel import VTK_TETRA, vtkCellArray, vtkUnstructuredGrid
    text = ""
    if os.path.exists(path):
        with open(path, encoding="ascii", errors="replace") as file:
            text = file.read()
    nodes, rows = _numbers(text, "Vertices", 4)[:, :3], _numbers(text, "Tetrahedra", 5).astype(int)
    if len(rows) == 0:
        raise Failure("the mesher has made no tetrahedra")
    own = vtk_to_numpy(surface.GetPoints().GetData()).astype(float)
    far, near = cKDTree(own).query(nodes)
    added = far > 1e-12 * np.abs(own).max()  # files have 14 digits at least
    near[added] = len(own) + np.arange(added.sum())
    if rows[:, :4].min() < 1 or rows[:, :4].max() > len(nodes):
        raise Failure("the mesher's file is damaged: it lacks nodes")
    points, cells = np.concatenate([own, nodes[added]]), near[rows[:, :4] - 1].astype(np.int64)
    a, b, c, d = np.moveaxis(points[cells], 1, 0)
    inverted = ((b - a) * np.cross(c - a, d - a)).sum(1) < 0
    cells[inverted, 2:] = cells[inverted, :1:-1]
    grid, places, array = vtkUnstructuredGrid(), vtkPoints(), vtkCellArray()
    places.SetData(numpy_to_vtk(points, deep=True))
    array.SetData(4, numpy_to_vtkIdTypeArray(cells.ravel(), deep=True))
    grid.SetPoints(places)
    grid.SetCells(VTK_TETRA, array)
    labels = numpy_to_vtk(rows[:, 4].astype(np.int32), deep=True)
    labels.SetName("Label")
    grid.GetCellData().SetScalars(labels)
    grid.GetFieldData().ShallowCopy(surface.GetFieldData())
    marks = [cell_array(surface, name) for name in ("BoxFace", "Cap")]
    marks = np.stack([np.zeros(surface.GetNumberOfPolys(), int) if mark is None else mark
                      for mark in marks], axis=1).astype(int)
    marked = marks.any(axis=1)
    solid = Solid(grid, points, cells, rows[:, 4], {}, mesher,
                  triangles_of(surface)[marked], marks[marked])
    for label in sorted(solid_labels(surface)):
        solid.names[label.number] = label.name
        if not (solid.labels == label.number).any():
            raise Failure(f"{mesher} has left out {label.name}")
    return solid


def _measure(solid: Solid) -> None:
    """Set the angles, and the number and volume of the tetrahedra of each label."""
    angles, six = [], []
    for first in range(0, len(solid.cells), CHUNK):
        p = solid.points[solid.cells[first:first + CHUNK]]
        most = np.full(len(p), -1.0)  # cosine
        for i, j, a, b in ((0, 1, 2, 3), (0, 2, 1, 3), (0, 3, 1, 2), (1, 2, 0, 3), (1, 3, 0, 2),
                           (2, 3, 0, 1)):
            # The faces that meet at edge a b lead to i and j.
            edge = p[:, b] - p[:, a]
            m, n = (np.cross(edge, p[:, end] - p[:, a]) for end in (i, j))
            cosine = (m * n).sum(1) / np.sqrt((m * m).sum(1) * (n * n).sum(1))
            most = np.fmax(most, cosine)
        angles.append(np.degrees(np.arccos(np.clip(most, -1, 1))))
        six.append(((p[:, 1] - p[:, 0]) * np.cross(p[:, 2] - p[:, 0], p[:, 3] - p[:, 0])).sum(1))
    all_angles, volumes = np.sort(np.concatenate(angles)), np.concatenate(six) / 6
    solid.least_angle = float(all_angles[0])
    solid.percent_angle = float(all_angles[len(all_angles) // 100])
    for number in np.unique(solid.labels).tolist():
        own = solid.labels == number
        solid.regions[number] = int(own.sum()), float(volumes[own].sum())
