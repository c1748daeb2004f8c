# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Readers of tetrahedral mesh files for test_solids.py."""

import re
from typing import NamedTuple

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy

from test_interfaces import sections_of


def tetrahedra_of(grid):
    corners = vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(-1, 4)
    return corners, vtk_to_numpy(grid.GetCellData().GetArray("Label"))


def volumes(points, corners):
    a, b, c, d = (points[corners[:, i]] for i in range(4))
    return np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a) / 6


def least_angles(points, corners):
    """Return the minimum dihedral angle of each tetrahedron, degrees."""
    normals = []
    for i in range(4):
        a, b, c = (points[corners[:, k]] for k in range(4) if k != i)
        normal = np.cross(b - a, c - a)
        outward = np.einsum("ij,ij->i", normal, points[corners[:, i]] - a) < 0
        normal[~outward] *= -1
        normals.append(normal / np.linalg.norm(normal, axis=1)[:, None])
    cosines = [-np.einsum("ij,ij->i", m, n) for k, m in enumerate(normals) for n in normals[:k]]
    return np.degrees(np.arccos(np.max(cosines, axis=0)))


def faces_between(corners, labels):
    """Return sets of faces by pair of labels, each face with its corners in order; 0 is the
    outside."""
    labels_at = {}
    for cell, label in zip(corners, labels):
        for i in range(4):
            labels_at.setdefault(frozenset(np.delete(cell, i).tolist()), []).append(int(label))
    faces = {}
    for face, beside in labels_at.items():
        pair = tuple(sorted(beside)) if len(beside) == 2 else (beside[0], 0)
        if pair[0] != pair[1]:
            faces.setdefault(pair, set()).add(face)
    return faces


def keywords_of(path):
    """Return keyword with parameters, and rows, of each part of an .inp."""
    parts = []
    with open(path, encoding="utf-8") as file:
        for line in file:
            if line.startswith("*") and not line.startswith("**"):
                parts.append((line.strip(), []))
            elif parts:
                parts[-1][1].append(line.strip().strip(",").split(", "))
    return parts


class InpMesh(NamedTuple):
    nodes: dict     # {number: position}
    cells: dict     # {number: numbers of nodes}
    sets: dict      # {(keyword, name): set of numbers}
    surfaces: dict  # {name: set of faces, each the numbers of its nodes}


def inp_mesh(path):
    """Return the content of an .inp, without sets of names."""
    sides = {"S1": (1, 2, 3), "S2": (1, 4, 2), "S3": (2, 4, 3), "S4": (3, 4, 1)}  # of Abaqus
    mesh = InpMesh({}, {}, {}, {})
    for head, rows in keywords_of(path):
        keyword, name = head.split(",")[0], re.search(r"(ELSET|NSET|NAME)=(\w+)", head).group(2)
        if keyword == "*NODE":
            mesh.nodes.update((int(row[0]), [float(word) for word in row[1:]]) for row in rows)
        elif keyword == "*ELEMENT":
            mesh.cells.update((int(row[0]), [int(word) for word in row[1:]]) for row in rows)
            mesh.sets[keyword, name] = {int(row[0]) for row in rows}
        elif keyword == "*SURFACE":
            mesh.surfaces[name] = {frozenset(mesh.cells[int(cell)][i - 1] for i in sides[side])
                                   for cell, side in rows}
        elif keyword == "*NSET":
            mesh.sets[keyword, name] = {int(word) for row in rows for word in row}
    return mesh


def msh(path):
    """Return nodes, rows of label and corners of tetrahedra, and corners of triangles by name, of
    MSH 2.2; indices from 0."""
    sections = sections_of(path)
    nodes = np.array([line.split()[1:] for line in sections["Nodes"][1:]], float)
    rows = [list(map(int, line.split())) for line in sections["Elements"][1:]]
    cells, triangles = (np.array([row[3:4] + row[5:] for row in rows if row[1] == kind])
                        for kind in (4, 2))
    cells[:, 1:] -= 1
    names = re.findall(r'^2 (\d+) "(.*)"$', "".join(sections["PhysicalNames"]), re.M)
    return nodes, cells, {name: triangles[triangles[:, 0] == int(number), 1:] - 1
                          for number, name in names}
