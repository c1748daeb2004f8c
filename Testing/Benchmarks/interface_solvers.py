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
            return "facets intersect" if "intersect" in said else failure
        return answer(shape, rows_of(os.path.join(folder, "in.1.node"))[:, 1:4],
                      rows_of(os.path.join(folder, "in.1.ele"))[:, 1:5].astype(int))


# ---- gmsh ----------------------------------------------------------------------------------------

def winding_number(place, points, faces):
    """How often a closed surface is around the place."""
    a, b, c = ((points - place)[faces[:, corner]] for corner in range(3))
    lengths = [np.linalg.norm(corner, axis=1) for corner in (a, b, c)]
    below = (np.prod(lengths, axis=0) + np.einsum("ij,ij->i", a, b) * lengths[2]
             + np.einsum("ij,ij->i", b, c) * lengths[0] + np.einsum("ij,ij->i", c, a) * lengths[1])
    angles = np.arctan2(np.einsum("ij,ij->i", a, np.cross(b, c)), below)
    return angles.sum() / (2 * np.pi)


def shells_of(faces):
    """A number for each triangle, the same of those that are connected."""
    root = np.arange(faces.max() + 1)
    while True:
        roots = root[faces]
        least = roots.min(axis=1)
        if (roots == least[:, None]).all():
            return least
        np.minimum.at(root, roots, least[:, None])
        root = root[root]


def parts_of(points, faces):
    """Of each triangle of a boundary the number of the part that it is of: a shell, and cavities."""
    part = shells_of(faces)
    shells = {shell: faces[part == shell] for shell in np.unique(part)}
    outer = [shell for shell, of_it in shells.items() if volume_of(points, of_it) > 0]
    for shell in set(shells) - set(outer):
        place = points[shells[shell][0, 0]]
        part[part == shell] = max(
            outer, key=lambda around: winding_number(place, points, shells[around]))
    return np.unique(part, return_inverse=True)[1]


def part_sides(shape):
    """As the sides of triangles, numbers of parts of labels, from 1 on; and the label of each."""
    sides, labels = np.zeros_like(shape.sides), []
    for label in shape.labels():
        behind, front = (np.flatnonzero(side == label) for side in shape.sides.T)
        part = parts_of(shape.points, shape.faces_of(label)) + len(labels) + 1
        sides[behind, 0], sides[front, 1] = np.split(part, [len(behind)])
        labels += [label] * (part.max() - len(labels))
    return sides, labels


def write_model(shape, folder):
    """in.msh, of version 2.2, a surface for each pair of parts, and in.geo, a volume for each part:
    one of several parts gmsh would take for a void. Few tetrahedra are asked for, good or not."""
    points, triangles = shape.points, shape.triangles
    sides, labels = part_sides(shape)
    pairs, surface = np.unique(np.sort(sides, axis=1), axis=0, return_inverse=True)
    surface = surface.ravel() + 1
    with open(os.path.join(folder, "in.msh"), "w", encoding="ascii") as file:
        file.write(f"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{len(points)}\n")
        np.savetxt(file, np.column_stack([np.arange(len(points)) + 1, points]),
                   "%d" + " %.17g" * 3)
        file.write(f"$EndNodes\n$Elements\n{len(triangles)}\n")
        np.savetxt(file, np.column_stack([np.arange(len(triangles)) + 1, surface, surface,
                                          triangles + 1]), "%d 2 2" + " %d" * 5)
        file.write("$EndElements\n")
    with open(os.path.join(folder, "in.geo"), "w", encoding="ascii") as file:
        file.write('Merge "in.msh";\nMesh.Optimize = 0;\nMesh.MeshSizeExtendFromBoundary = 0;\n')
        for part in range(1, len(labels) + 1):
            surfaces = ", ".join(map(str, np.flatnonzero((pairs == part).any(axis=1)) + 1))
            file.write(f"Surface Loop({part}) = {{{surfaces}}};\nVolume({part}) = {{{part}}};\n")
        for label in shape.labels():
            parts = ", ".join(str(part) for part, of in enumerate(labels, 1) if of == label)
            file.write(f"Physical Volume({label}) = {{{parts}}};\n")


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
        write_model(shape, folder)
        said, failure = run(folder, "gmsh", "-3", "-nt", "1", "-format", "msh22", "-o", "out.msh",
                            "in.geo")
        if failure:
            errors = [line.split(":", 1)[-1] for line in said.splitlines() if line[:5] == "Error"]
            return ("facets intersect" if "overlap" in said or "intersect" in said
                    else failure + "".join(errors[:1])[:50])
        return answer(shape, *read_tetrahedra(os.path.join(folder, "out.msh")))


def solvers_here():
    """{name: function}; those that are installed."""
    return {name: function for name, function in (("tetgen", tetgen), ("gmsh", gmsh))
            if shutil.which(name)}
