# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Whether TetGen and gmsh fill the surfaces of all labels at once, for benchmark_interfaces.py.

Each gets the triangles as they are and has to keep them. An answer is a word for the table: how
many tetrahedra there are, or what was wrong.
"""

import os
import shutil
import subprocess
import tempfile

import numpy as np

from interface_figures import volume_of

TOO_LONG = 600  # seconds


def run(folder, *command):
    """What it says, and what was wrong with it: nothing where it is done."""
    try:
        done = subprocess.run(command, cwd=folder, timeout=TOO_LONG, check=False, text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, errors="replace")
    except subprocess.TimeoutExpired:
        return "", f"over {TOO_LONG} s"
    return done.stdout, f"failed, {done.returncode}" if done.returncode else ""


def volume_of_tetrahedra(points, tetrahedra):
    a, b, c, d = (points[tetrahedra[:, corner]] for corner in range(4))
    return np.abs(np.einsum("ij,ij->i", b - a, np.cross(c - a, d - a))).sum() / 6


def answer(shape, points, tetrahedra):
    """All that is inside must be filled: of labels, and, by TetGen, holes in them."""
    wanted = sum(volume_of(shape.points, shape.faces_of(label)) for label in shape.labels())
    found = volume_of_tetrahedra(points, tetrahedra)
    if found < (1 - 1e-6) * wanted:
        return f"fills {100 * found / wanted:.4g} %"
    return f"{len(tetrahedra)}"


# ---- TetGen --------------------------------------------------------------------------------------

def write_poly(shape, path):
    """Numbers from 0; each facet is a triangle."""
    points, triangles = shape.points, shape.triangles
    with open(path, "w", encoding="ascii") as file:
        file.write(f"{len(points)} 3 0 0\n")
        np.savetxt(file, np.column_stack([np.arange(len(points)), points]), "%d" + " %.17g" * 3)
        file.write(f"{len(triangles)} 0\n")
        np.savetxt(file, triangles, "1\n3 %d %d %d")
        file.write("0\n0\n")


def rows_of(path):
    """Of a file of TetGen: a line of numbers first, comments last."""
    with open(path, encoding="ascii") as file:
        return np.loadtxt(file, skiprows=1, ndmin=2)


def tetgen(shape):
    with tempfile.TemporaryDirectory() as folder:
        write_poly(shape, os.path.join(folder, "in.poly"))
        # Where it gives up it aborts, and what it has said is lost unless it was written at once.
        said, failure = run(folder, "stdbuf", "-o0", "tetgen", "-pY", "in.poly")
        if failure:
            crossing = [line for line in said.splitlines() if "intersect" in line.lower()]
            return "facets intersect" if crossing else failure
        return answer(shape, rows_of(os.path.join(folder, "in.1.node"))[:, 1:4],
                      rows_of(os.path.join(folder, "in.1.ele"))[:, 1:5].astype(int))


# ---- gmsh ----------------------------------------------------------------------------------------

def pairs_of(shape):
    """The pairs of labels that have an interface, and which of them each triangle is of."""
    pairs, number = np.unique(np.sort(shape.sides, axis=1), axis=0, return_inverse=True)
    return pairs, number.ravel()


def write_msh(shape, path):
    """Version 2.2, a surface for each pair of labels, numbered from 1."""
    points, triangles = shape.points, shape.triangles
    surface = pairs_of(shape)[1] + 1
    with open(path, "w", encoding="ascii") as file:
        file.write(f"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{len(points)}\n")
        np.savetxt(file, np.column_stack([np.arange(len(points)) + 1, points]),
                   "%d" + " %.17g" * 3)
        file.write(f"$EndNodes\n$Elements\n{len(triangles)}\n")
        np.savetxt(file, np.column_stack([np.arange(len(triangles)) + 1, surface, surface,
                                          triangles + 1]), "%d 2 2" + " %d" * 5)
        file.write("$EndElements\n")


def write_geo(shape, path):
    """A volume for each label: what all its surfaces enclose. Better tetrahedra are not asked for."""
    pairs = pairs_of(shape)[0]
    with open(path, "w", encoding="ascii") as file:
        file.write('Mesh.Optimize = 0;\nMerge "in.msh";\n')
        for label in shape.labels():
            surfaces = ", ".join(map(str, np.flatnonzero((pairs == label).any(axis=1)) + 1))
            file.write(f"Surface Loop({label}) = {{{surfaces}}};\n"
                       f"Volume({label}) = {{{label}}};\n"
                       f"Physical Volume({label}) = {{{label}}};\n")


def read_tetrahedra(path):
    """Points and tetrahedra of a file of version 2.2."""
    with open(path, encoding="ascii") as file:
        lines = file.read().splitlines()

    def section(title):
        start = lines.index(title) + 2
        return lines[start:start + int(lines[start - 1])]
    nodes = np.array([line.split() for line in section("$Nodes")], float)
    places = np.zeros((int(nodes[:, 0].max()) + 1, 3))
    places[nodes[:, 0].astype(int)] = nodes[:, 1:]
    elements = [line.split() for line in section("$Elements")]
    tetrahedra = [words[-4:] for words in elements if words[1] == "4"]
    return places, np.array(tetrahedra, int).reshape(-1, 4)


def gmsh(shape):
    with tempfile.TemporaryDirectory() as folder:
        write_msh(shape, os.path.join(folder, "in.msh"))
        write_geo(shape, os.path.join(folder, "in.geo"))
        said, failure = run(folder, "gmsh", "-3", "-nt", "1", "-format", "msh22", "-o", "out.msh",
                            "in.geo")
        errors = [line for line in said.splitlines() if line.startswith("Error")]
        if failure or errors:
            crossing = "overlap" in said or "intersect" in said
            return "facets intersect" if crossing else failure or "has errors"
        return answer(shape, *read_tetrahedra(os.path.join(folder, "out.msh")))


def solvers_here():
    """{name: function}; those that are installed."""
    return {name: function for name, function in (("tetgen", tetgen), ("gmsh", gmsh))
            if shutil.which(name)}
