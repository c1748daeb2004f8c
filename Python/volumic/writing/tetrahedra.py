# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Tetrahedral meshes by TetGen or gmsh, which are run as programs because of their licences."""

from __future__ import annotations

import ctypes
import dataclasses
import os
import re
import shutil
import signal
import subprocess
import tempfile
import time
from collections.abc import Callable
from typing import Any

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray

from ..errors import Failure
from .meshers import write_msh, write_tetgen
from .regions import cell_array, labels_of_sides, points_of, region_labels, triangles_of
from .tetrahedral_files import TETRAHEDRAL_SUFFIXES

MESHERS = ("tetgen", "gmsh")
MAXIMUM_TETRAHEDRA = 2e8
MINIMUM_ANGLE = 5.0  # degrees; a warning is given for smaller dihedral angles
CHUNK = 1 << 18      # tetrahedra per chunk
INCOMPLETE = "the output of the mesher is incomplete (is the disk full?):"

# gmsh does not mesh volumes of a file. Each one is replaced by a new volume with the same boundary
# and physical group.
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
    """Return whether a file is a tetrahedral mesh; .msh is one if a mesher is selected."""
    suffix = os.path.splitext(name)[1].lower()
    return suffix in TETRAHEDRAL_SUFFIXES or (suffix == ".msh" and bool(mesher))


def find_mesher(mesher: str = "") -> str:
    """Return the mesher to run. Raise Failure if it is not installed."""
    for program in (mesher,) if mesher else MESHERS:
        if shutil.which(program):
            return program
    if mesher:
        raise Failure(f"{mesher} is not installed (Debian: apt install {mesher})")
    raise Failure("tetrahedral meshes require TetGen or gmsh; install one of them (Debian: apt "
                  "install tetgen)")


@dataclasses.dataclass
class TetrahedralMesh:
    """A mesh whose tetrahedra have one label each. Points of the surface come first."""
    grid: Any                # vtkUnstructuredGrid with cell array Label, field data of the surface
    points: np.ndarray       # n x 3
    cells: np.ndarray        # m x 4, of positive volume
    labels: np.ndarray       # m
    names: dict[int, str]    # by label
    mesher: str
    marked: np.ndarray       # triangles in box faces and caps, k x 3
    marks: np.ndarray        # their BoxFace and Cap, k x 2
    least_angle: float = 0.0    # minimum dihedral angle, degrees
    percent_angle: float = 0.0  # first percentile of the minimum dihedral angle
    regions: dict[int, tuple[int, float]] = dataclasses.field(default_factory=dict)
    point_values: dict[str, np.ndarray] = dataclasses.field(default_factory=dict)
    cell_values: dict[str, np.ndarray] = dataclasses.field(default_factory=dict)


class TetrahedralMesher:
    """Fills surfaces with tetrahedra. Keeps the last mesh for further files of the same surface.
    `maximum_volume` is in cubic world units (0: no limit). The program is stopped if interrupted()
    is true or time.monotonic() exceeds `deadline`. probe(points) returns arrays by name, which are
    added to points and cells."""

    def __init__(self, mesher: str = "", maximum_volume: float = 0.0,
                 interrupted: Callable[[], bool] | None = None, deadline: float | None = None,
                 probe: Callable[[np.ndarray], dict[str, np.ndarray]] | None = None) -> None:
        self.mesher, self.maximum_volume, self.deadline = mesher, maximum_volume, deadline
        self.interrupted = interrupted or (lambda: False)
        self.probe = probe
        self.last: TetrahedralMesh | None = None
        self._surface: Any = None

    def make(self, surface: Any, path: str, progress: Callable[..., None] | None = None,
             warn: Callable[[str], None] | None = None) -> TetrahedralMesh:
        """Return the mesh of a surface. Temporary files are written next to the file `path`. Raise
        Failure, without a file name, if the program fails or is stopped."""
        if self.last is not None and self._surface is surface:
            return self.last
        program = find_mesher(self.mesher)
        self._check_size(surface)
        progress = progress or (lambda *_: None)
        with tempfile.TemporaryDirectory(prefix=".volumic-",
                                         dir=os.path.dirname(os.path.abspath(path))) as folder:
            name = os.path.join(folder, "surface.msh" if program == "gmsh" else "surface.smesh")
            (write_msh if program == "gmsh" else write_tetgen)(surface, name)
            progress(0.1)
            self._run(self._command_line(program, folder), folder)
            progress(0.8)
            made = os.path.join(folder, "surface.mesh" if program == "gmsh" else "surface.1.mesh")
            mesh = _read_mesh(made, surface, program)
        _measure(mesh)
        self._add_values(mesh)
        if warn and mesh.least_angle < MINIMUM_ANGLE:
            warn(f"the minimum dihedral angle is {mesh.least_angle:.2g} degrees, below the "
                 f"{MINIMUM_ANGLE:g} degrees that solvers require, due to thin or sharp parts; "
                 "change --edge-length, --smoothing or --region")
        self.last, self._surface = mesh, surface
        return mesh

    def _check_size(self, surface: Any) -> None:
        """Raise Failure if the maximum volume implies too many tetrahedra."""
        if self.maximum_volume <= 0:
            return
        points, triangles = points_of(surface), triangles_of(surface)
        a, b, c = np.moveaxis(points[triangles] - points.mean(axis=0), 1, 0)
        filled = (labels_of_sides(surface, len(triangles)) >= 0).reshape(-1, 2)
        signs = filled[:, 0].astype(int) - filled[:, 1]
        volume = float((signs * (a * np.cross(b, c)).sum(1)).sum() / 6)
        if volume > MAXIMUM_TETRAHEDRA * self.maximum_volume:
            raise Failure(f"--maximum-volume {self.maximum_volume:g} requires more than "
                          f"{MAXIMUM_TETRAHEDRA:.0e} tetrahedra; set it to at least "
                          f"{volume / MAXIMUM_TETRAHEDRA:.1g}")

    def _command_line(self, program: str, folder: str) -> list[str]:
        limit = self.maximum_volume
        if program == "tetgen":
            # p: mesh a surface, Y: preserve it, A: region attributes, q/8: dihedral angles of at
            # least 8 degrees where the surface allows it.
            return ["tetgen", "-pYAq/8gNEF" + (f"a{limit!r}" if limit > 0 else ""), "surface.smesh"]
        with open(os.path.join(folder, "volumes.geo"), "w", encoding="ascii") as file:
            file.write(OWN_VOLUMES)
        # Edge length of a regular tetrahedron of this volume.
        size = ["-clmax", repr(float(np.cbrt(6 * np.sqrt(2) * limit)))] if limit > 0 else []
        return ["gmsh", "-3", "surface.msh", "volumes.geo", "-o", "surface.mesh", "-format", "mesh",
                "-setnumber", "Mesh.SaveElementTagType", "2", "-v", "2", *size]

    def _run(self, command: list[str], folder: str) -> None:
        """Run a program until it ends, is interrupted or reaches the deadline."""
        log = os.path.join(folder, "log")
        # The surface of an interrupted run is meshed, too.
        can_interrupt, stopped = not self.interrupted(), ""
        prctl = ctypes.CDLL(None).prctl
        try:
            with open(log, "wb") as output:
                process = subprocess.Popen(
                    command, cwd=folder, stdin=subprocess.DEVNULL, stdout=output,
                    stderr=subprocess.STDOUT,  # ends with this process: PR_SET_PDEATHSIG
                    preexec_fn=lambda: prctl(1, signal.SIGKILL))
        except OSError as error:
            raise Failure(f"{command[0]} cannot be run ({error.strerror})") from None
        try:
            while process.poll() is None and not stopped:
                if can_interrupt and self.interrupted():
                    stopped = "interrupted"
                elif self.deadline is not None and time.monotonic() > self.deadline:
                    stopped = "time limit reached"
                else:
                    time.sleep(0.01)
        finally:
            if process.poll() is None:
                process.kill()
            code = process.wait()
        if not stopped and code != 0 and can_interrupt and self.interrupted():
            stopped = "interrupted"  # the program received the signal, too
        if stopped:
            raise Failure(f"{stopped} while {command[0]} was running; the file was not written")
        if code != 0:
            reason = f"exit code {code}" if code > 0 else f"signal {-code}"
            raise Failure(f"{command[0]} failed ({reason}): {_end_of(log)}")

    def _add_values(self, mesh: TetrahedralMesh) -> None:
        """Add values of the probe to points, and to cells their mean at the centroid and four
        points between it and the corners; for labels the value at the centroid."""
        if self.probe is None:
            return
        corners = mesh.points[mesh.cells]
        center = corners.mean(axis=1)
        mesh.point_values = self.probe(mesh.points)
        samples = [self.probe(center)]
        if any(values.dtype.kind == "f" for values in samples[0].values()):
            samples += [self.probe((center + corners[:, i]) / 2) for i in range(4)]
        for name, values in samples[0].items():
            if values.dtype.kind == "f":
                parts = np.stack([sample[name] for sample in samples])
                known = ~np.isnan(parts)
                with np.errstate(invalid="ignore"):
                    values = np.where(known, parts, 0).sum(0) / known.sum(0)
            mesh.cell_values[name] = values
        for data, found in ((mesh.grid.GetPointData(), mesh.point_values),
                            (mesh.grid.GetCellData(), mesh.cell_values)):
            for name, values in found.items():
                array = numpy_to_vtk(np.ascontiguousarray(values), deep=True)
                array.SetName(name)
                data.AddArray(array)


def _end_of(log: str) -> str:
    """Return the last lines of a log, without separators of gmsh."""
    with open(log, encoding="utf-8", errors="replace") as file:
        lines = [line.strip() for line in file if line.strip() and "-----" not in line]
    return "; ".join(lines[-3:])[:400]


def _numbers(text: str, keyword: str, columns: int) -> np.ndarray:
    """Return the rows of a section of a Medit file."""
    found = re.search(rf"^\s*{keyword}\s+(\d+)", text, re.MULTILINE)
    if found is None:
        return np.zeros((0, columns))
    end = re.compile(r"^\s*[A-Za-z#]", re.MULTILINE).search(text, found.end())
    numbers = np.fromstring(text[found.end():end.start() if end else None], sep=" ")
    if len(numbers) != columns * int(found[1]):
        raise Failure(f"{INCOMPLETE} {keyword} are missing")
    return numbers.reshape(-1, columns)


def _read_mesh(path: str, surface: Any, mesher: str) -> TetrahedralMesh:
    """Read a Medit file. Points of the surface come first, with their exact coordinates."""
    from scipy.spatial import cKDTree
    from vtkmodules.vtkCommonCore import vtkPoints
    from vtkmodules.vtkCommonDataModel import VTK_TETRA, vtkCellArray, vtkUnstructuredGrid
    text = ""
    if os.path.exists(path):
        with open(path, encoding="ascii", errors="replace") as file:
            text = file.read()
    nodes, rows = _numbers(text, "Vertices", 4)[:, :3], _numbers(text, "Tetrahedra", 5).astype(int)
    if len(rows) == 0:
        raise Failure("the mesher created no tetrahedra (is the disk full?)")
    if not text.rstrip().endswith("End"):
        raise Failure(f"{INCOMPLETE} it has no end")
    own = points_of(surface).astype(float)
    far, near = cKDTree(own).query(nodes)
    added = far > 1e-12 * np.abs(own).max()  # files have at least 14 digits
    near[added] = len(own) + np.arange(added.sum())
    if rows[:, :4].min() < 1 or rows[:, :4].max() > len(nodes):
        raise Failure(f"{INCOMPLETE} nodes are missing")
    points, cells = np.concatenate([own, nodes[added]]), near[rows[:, :4] - 1].astype(np.int64)
    a, b, c, d = np.moveaxis(points[cells], 1, 0)
    inverted = ((b - a) * np.cross(c - a, d - a)).sum(1) < 0
    cells[inverted, 2:] = cells[inverted, :1:-1]
    grid, vtk_points, array = vtkUnstructuredGrid(), vtkPoints(), vtkCellArray()
    vtk_points.SetData(numpy_to_vtk(points, deep=True))
    array.SetData(4, numpy_to_vtkIdTypeArray(cells.ravel(), deep=True))
    grid.SetPoints(vtk_points)
    grid.SetCells(VTK_TETRA, array)
    labels = numpy_to_vtk(rows[:, 4].astype(np.int32), deep=True)
    labels.SetName("Label")
    grid.GetCellData().SetScalars(labels)
    grid.GetFieldData().ShallowCopy(surface.GetFieldData())
    marks = [cell_array(surface, name) for name in ("BoxFace", "Cap")]
    marks = np.stack([np.zeros(surface.GetNumberOfPolys(), int) if mark is None else mark
                      for mark in marks], axis=1).astype(int)
    marked = marks.any(axis=1)
    mesh = TetrahedralMesh(grid, points, cells, rows[:, 4], {}, mesher,
                           triangles_of(surface)[marked], marks[marked])
    for label in sorted(region_labels(surface)):
        mesh.names[label.number] = label.name
        if not (mesh.labels == label.number).any():
            raise Failure(f"{mesher} created no tetrahedra for {label.name}")
    return mesh


def _measure(mesh: TetrahedralMesh) -> None:
    """Set the angles, and number and volume of the tetrahedra of each label."""
    angles, six = [], []
    for first in range(0, len(mesh.cells), CHUNK):
        p = mesh.points[mesh.cells[first:first + CHUNK]]
        maximum = np.full(len(p), -1.0)  # cosine
        for i, j, a, b in ((0, 1, 2, 3), (0, 2, 1, 3), (0, 3, 1, 2), (1, 2, 0, 3), (1, 3, 0, 2),
                           (2, 3, 0, 1)):
            # The faces at edge a b have the other corners i and j.
            edge = p[:, b] - p[:, a]
            m, n = (np.cross(edge, p[:, end] - p[:, a]) for end in (i, j))
            cosine = (m * n).sum(1) / np.sqrt((m * m).sum(1) * (n * n).sum(1))
            maximum = np.fmax(maximum, cosine)
        angles.append(np.degrees(np.arccos(np.clip(maximum, -1, 1))))
        six.append(((p[:, 1] - p[:, 0]) * np.cross(p[:, 2] - p[:, 0], p[:, 3] - p[:, 0])).sum(1))
    all_angles, volumes = np.sort(np.concatenate(angles)), np.concatenate(six) / 6
    mesh.least_angle = float(all_angles[0])
    mesh.percent_angle = float(all_angles[len(all_angles) // 100])
    for number in np.unique(mesh.labels).tolist():
        own = mesh.labels == number
        mesh.regions[number] = int(own.sum()), float(volumes[own].sum())
