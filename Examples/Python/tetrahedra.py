#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Tetrahedra inside of surfaces, by gmsh or TetGen, and what they are like.

    volumic --labels all organs.nii.gz organs.msh organs.smesh
    tetrahedra.py organs.msh                             # gmsh
    tetrahedra.py organs.smesh --output tetrahedra.vtu   # TetGen

A line for each label tells how many tetrahedra it has, their volume, and the worst and the mean
radius ratio: three times the radius of the inner sphere by that of the outer one, 1 where all edges
are equal. The triangles of the surfaces stay as they are. OUTPUT has a cell array `Label`.

Ends with 1 if the program is not installed (Debian: apt install gmsh tetgen) or fails, or if a label
has no tetrahedra.
"""

import argparse
import os
import shutil
import subprocess
import sys
import tempfile

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import VTK_TETRA, vtkCellArray, vtkUnstructuredGrid
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridWriter

VOLUMES = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "volumes.geo")


class MesherError(Exception):
    """A mesher that is not there, or does not do it."""


def run_mesher(command, folder):
    """Run it in the folder; MesherError with the end of what it says."""
    if shutil.which(command[0]) is None:
        raise MesherError(f"{command[0]} is not installed (Debian: apt install {command[0]})")
    run = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    if run.returncode != 0:
        said = [line for line in (run.stdout + run.stderr).splitlines() if line.strip()]
        errors = [line for line in said if line.startswith("Error   : ") and "---" not in line]
        raise MesherError(f"{command[0]}: " + " ".join((errors or said[-3:])[:3]))


# ---- gmsh ---------------------------------------------------------------------------------------

def gmsh_tetrahedra(model):
    """(points, corners of tetrahedra, label of each, {label: name})"""
    with tempfile.TemporaryDirectory() as folder:
        result = os.path.join(folder, "tetrahedra.msh")
        run_mesher(["gmsh", "-3", os.path.abspath(model), VOLUMES, "-o", result, "-format",
                    "msh41"], folder)
        return read_msh(result)


def sections_of(path):
    """{name: lines} of a .msh that is text."""
    sections = {}
    with open(path, encoding="utf-8") as file:
        for line in file:
            if line.startswith("$End"):
                continue
            if line.startswith("$"):
                lines = sections[line[1:].strip()] = []
            else:
                lines.append(line)
    return sections


def blocks_of(lines, each):
    """(dimension, entity, third number of its head, how many things of so many lines each, the first
    line of these) of each block."""
    at, count = 1, int(lines[0].split()[0])
    for _ in range(count):
        dimension, entity, third, number = map(int, lines[at].split())
        yield dimension, entity, third, number, at + 1
        at += 1 + number * each


def read_msh(path):
    """As gmsh_tetrahedra, of a file of MSH 4.1."""
    sections = sections_of(path)
    names = {}
    for line in sections["PhysicalNames"][1:]:
        dimension, number, name = line.strip().split(" ", 2)
        if dimension == "3":
            names[int(number)] = name.strip('"')
    entities = sections["Entities"]
    counts = [int(word) for word in entities[0].split()]
    label_of = {}  # of each volume
    for line in entities[1 + sum(counts[:3]):1 + sum(counts)]:
        words = line.split()
        label_of[int(words[0])] = int(words[8]) if int(words[7]) > 0 else 0
    lines = sections["Nodes"]
    numbers, points = [], []
    for _, _, _, count, at in blocks_of(lines, 2):
        numbers += [int(line) for line in lines[at:at + count]]
        points += [line.split()[:3] for line in lines[at + count:at + 2 * count]]
    index = np.zeros(max(numbers) + 1, int)
    index[numbers] = np.arange(len(numbers))
    lines = sections["Elements"]
    corners, labels = [], []
    for dimension, entity, kind, count, at in blocks_of(lines, 1):
        if (dimension, kind) == (3, 4):
            corners += [line.split()[1:] for line in lines[at:at + count]]
            labels += [label_of[entity]] * count
    return (np.array(points, float), index[np.array(corners, int).reshape(-1, 4)],
            np.array(labels, int), names)


# ---- TetGen -------------------------------------------------------------------------------------

def tetgen_tetrahedra(model):
    """As gmsh_tetrahedra."""
    with tempfile.TemporaryDirectory() as folder:
        name = "model" + os.path.splitext(model)[1]
        shutil.copy(model, os.path.join(folder, name))
        # p: what the triangles bound, Y: these as they are, A: with the labels, q: well-shaped.
        run_mesher(["tetgen", "-pYAq", name], folder)
        points, rows = (np.loadtxt(os.path.join(folder, "model.1" + suffix), skiprows=1, ndmin=2)
                        for suffix in (".node", ".ele"))
    names = {}
    with open(model, encoding="utf-8") as file:
        for line in file:
            if not line.startswith("#"):
                break
            if line.startswith("# region "):
                number, name = line[len("# region "):].strip().split(": ", 1)
                names[int(number)] = name
    return points[:, 1:4], rows[:, 1:5].astype(int) - 1, rows[:, 5].astype(int), names


# ---- What they are like -------------------------------------------------------------------------

def volumes_and_shapes(points, corners):
    """Of each tetrahedron its volume and radius ratio."""
    a, b, c, d = (points[corners[:, i]] for i in range(4))
    u, v, w = b - a, c - a, d - a
    volume = np.abs(np.einsum("ij,ij->i", u, np.cross(v, w))) / 6
    area = sum(np.linalg.norm(np.cross(p, q), axis=1) / 2
               for p, q in ((u, v), (v, w), (w, u), (v - u, w - u)))
    inner = 3 * volume / area
    # Products of opposite edges are the sides of a triangle of the area 6 V R.
    x, y, z = (np.linalg.norm(p, axis=1) * np.linalg.norm(q, axis=1)
               for p, q in ((u, w - v), (v, w - u), (w, v - u)))
    heron = (x + y + z) * (-x + y + z) * (x - y + z) * (x + y - z)
    outer = np.sqrt(np.maximum(heron, 0)) / (24 * np.maximum(volume, 1e-300))
    return volume, 3 * inner / np.maximum(outer, 1e-300)


def write_grid(path, points, corners, labels):
    """As .vtu."""
    grid, places, cells = vtkUnstructuredGrid(), vtkPoints(), vtkCellArray()
    places.SetData(numpy_to_vtk(points, deep=True))
    cells.SetData(4, numpy_to_vtkIdTypeArray(corners.astype(np.int64).ravel(), deep=True))
    grid.SetPoints(places)
    grid.SetCells(VTK_TETRA, cells)
    array = numpy_to_vtk(labels.astype(np.int32), deep=True)
    array.SetName("Label")
    grid.GetCellData().SetScalars(array)
    writer = vtkXMLUnstructuredGridWriter()
    writer.SetFileName(path)
    writer.SetInputData(grid)
    if not writer.Write():
        raise OSError(f"{path} cannot be written")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("model", help=".msh, .smesh or .poly that volumic has written")
    parser.add_argument("--output", help="write the tetrahedra as .vtu")
    options = parser.parse_args()
    suffix = os.path.splitext(options.model)[1].lower()
    if suffix not in (".msh", ".smesh", ".poly"):
        parser.error(f"{options.model}: .msh is for gmsh, .smesh and .poly are for TetGen")
    if not os.path.isfile(options.model):
        parser.error(f"{options.model}: there is no such file")
    try:
        make = gmsh_tetrahedra if suffix == ".msh" else tetgen_tetrahedra
        points, corners, labels, names = make(options.model)
        if options.output:
            write_grid(options.output, points, corners, labels)
    except (MesherError, OSError) as error:
        print(f"tetrahedra.py: {error}", file=sys.stderr)
        return 1
    volumes, shapes = volumes_and_shapes(points, corners)
    print(f"{'label':>6}  {'tetrahedra':>10}  {'volume':>12}  {'worst':>7}  {'mean':>5}  name")
    for label in sorted(set(names) | set(labels.tolist())):
        own = labels == label
        worst, mean = (shapes[own].min(), shapes[own].mean()) if own.any() else (0, 0)
        print(f"{label:6}  {own.sum():10}  {volumes[own].sum():12.6g}  {worst:7.4f}  {mean:5.3f}  "
              f"{names.get(label, '')}")
    return 0 if set(names) <= set(labels.tolist()) else 1


if __name__ == "__main__":
    sys.exit(main())
