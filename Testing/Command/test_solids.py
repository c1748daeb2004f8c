# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Files of tetrahedra, by TetGen and gmsh where they are installed: .vtu, .msh, .inp, which CalculiX
solves where it is installed."""

import os
import re
import shutil
import subprocess
import unittest
from collections import Counter

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

from test_tool_interfaces import ORIGIN, SPACING, InterfacesTest, period, sections_of
from command_test_case import ISO
from vtk_files import points_of, read, triangles_of

MESHERS = [name for name in ("tetgen", "gmsh") if shutil.which(name)]


def voxels():
    """[z, y, x] A box of 1 that touches one of 2, in which are one of nothing, and one of 1, about
    which gmsh finds the same surfaces as about 2 unless they are told apart; 4 touches both."""
    found = np.zeros((20, 32, 40), "u1")
    found[2:18, 2:18, 2:14] = 1
    found[2:18, 2:18, 14:38] = 2
    found[7:13, 7:13, 17:23] = 0
    found[7:13, 7:13, 28:34] = 1
    found[4:16, 18:30, 8:30] = 4
    return found


def tetrahedra_of(grid):
    corners = vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(-1, 4)
    return corners, vtk_to_numpy(grid.GetCellData().GetArray("Label"))


def volumes(points, corners):
    a, b, c, d = (points[corners[:, i]] for i in range(4))
    return np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a) / 6


def least_angles(points, corners):
    """Between two faces, degrees: of each tetrahedron the least."""
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
    """{(label, label): set of faces, each its corners in order}; 0 is the outside."""
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
    """(keyword with its parameters, rows of words) of each part of an .inp."""
    parts = []
    with open(path, encoding="utf-8") as file:
        for line in file:
            if line.startswith("*") and not line.startswith("**"):
                parts.append((line.strip(), []))
            elif parts:
                parts[-1][1].append(line.strip().strip(",").split(", "))
    return parts


class SolidsTest(InterfacesTest):
    def solid(self, *files, options=()):
        """The report of a run that makes them, and the grid of the first one."""
        report = self.report(self.map_of(voxels()), *(self.path(file) for file in files),
                             "--labels", "all", "--label-names", self.names_file(), *options)
        return report, read(self.path(files[0]), vtkXMLUnstructuredGridReader())


@unittest.skipUnless(MESHERS, "no mesher is installed")
class MesherTest(SolidsTest):
    def test_tetrahedra_fill_the_interfaces(self):
        for mesher in MESHERS:
            report, grid = self.solid("a.vtu", "a.vtp", options=("--mesher", mesher))
            points, (corners, labels) = points_of(grid), tetrahedra_of(grid)
            sizes = volumes(points, corners)
            self.assertGreater(sizes.min(), 0)
            for row in report["labels"]:
                self.assertAlmostEqual(sizes[labels == row["label"]].sum() / row["volume"], 1, 5)
            # The triangles are those of the surface, to the last bit.
            surface = read(self.path("a.vtp"))
            sides = vtk_to_numpy(surface.GetCellData().GetArray("BoundaryLabels"))
            sides = sides[surface.GetNumberOfLines():]
            at = {tuple(place): i for i, place in enumerate(points.tolist())}
            numbers = np.array([at[tuple(place)] for place in points_of(surface).tolist()])
            faces = faces_between(corners, labels)
            found = {}
            for triangle, side in zip(numbers[triangles_of(surface)].tolist(), sides.tolist()):
                pair = tuple(sorted(side)) if min(side) > 0 else (max(side), 0)
                found.setdefault(pair, set()).add(frozenset(triangle))
            self.assertEqual(found, faces)
            solid = report["solid"]
            angles = least_angles(points, corners)
            self.assertAlmostEqual(solid["least_angle"], angles.min(), 6)
            self.assertAlmostEqual(solid["percent_angle"], np.sort(angles)[len(angles) // 100], 6)
            self.assertEqual((solid["mesher"], solid["nodes"], solid["tetrahedra"]),
                             (mesher, len(points), len(corners)))
            self.assertEqual({row["label"]: row["name"] for row in solid["regions"]},
                             {1: "liver", 2: "left kidney", 4: 'a "b"'})
            names = grid.GetFieldData().GetAbstractArray("LabelName")
            self.assertEqual([names.GetValue(i) for i in range(3)],
                             ["liver", "left kidney", 'a "b"'])

    def test_a_surface_of_a_scan(self):
        for mesher in MESHERS:
            self.run_command(self.ball_file(), self.path("ball.vtu"), self.path("ball.vtp"), "--iso",
                          ISO, "--mesher", mesher)
            grid = read(self.path("ball.vtu"), vtkXMLUnstructuredGridReader())
            volume = read(self.path("ball.vtp")).GetFieldData().GetArray("Volume").GetValue(0)
            corners, labels = tetrahedra_of(grid)
            self.assertAlmostEqual(volumes(points_of(grid), corners).sum() / volume, 1, 5)
            self.assertEqual(set(labels.tolist()), {1})

    def test_flat_ends_have_nodes_and_sides(self):
        z, y, x = np.indices((16, 18, 18))
        volume = self.map_of((5 - np.hypot(x - 8.5, y - 8.5)).astype("f4"), "rod.vti")
        for mesher in MESHERS:
            self.run_command(volume, self.path("rod.inp"), self.path("rod.msh"), "--iso", "0", "--ends",
                          "marked", "--mesher", mesher)
            parts = dict(keywords_of(self.path("rod.inp")))
            nodes = np.array(parts["*NODE, NSET=Nall"], float)[:, 1:]
            for name, voxel in (("z_min", 1), ("z_max", 14)):
                numbers = [int(word) for row in parts[f"*NSET, NSET={name}"] for word in row]
                plane = ORIGIN[2] + voxel * SPACING[2]
                self.assertEqual({n - 1 for n in numbers},
                                 set(np.flatnonzero(abs(nodes[:, 2] - plane) < 1e-9).tolist()))
            names = "".join(sections_of(self.path("rod.msh"))["PhysicalNames"])
            self.assertIn('"z_min"', names)

    def test_a_volume_without_a_node_of_its_own(self):
        """Its tetrahedra have the corners that its triangles have."""
        volume = self.map_of(np.pad(np.ones((2, 2, 2), "u1"), 2), "small.vti")
        for mesher in MESHERS:
            report = self.report(volume, self.path("small.vtu"), "--labels", "all",
                                 "--edge-length", "2", "--mesher", mesher)
            self.assertGreater(report["solid"]["tetrahedra"], 0)

    def test_tetrahedra_are_about_as_small_as_asked(self):
        for mesher in MESHERS:
            counts = []
            for limit in (20, 0.1):
                _, grid = self.solid("a.vtu", options=("--mesher", mesher, "--maximum-volume",
                                                       str(limit)))
                # Triangles stay, and gmsh takes the length of edges that such a tetrahedron has.
                sizes = volumes(points_of(grid), tetrahedra_of(grid)[0])
                self.assertLess(np.median(sizes), 2 * limit)
                counts.append(len(sizes))
            self.assertGreater(counts[1], 1.3 * counts[0])

    def test_a_file_for_each_label(self):
        self.run_command(self.map_of(voxels()), self.path("all/"), "--labels", "all", "--format", "vtu")
        self.assertEqual(sorted(os.listdir(self.path("all"))),
                         ["label-1.vtu", "label-2.vtu", "label-4.vtu"])

    def test_nodes_of_a_box(self):
        """Two labels fill it, one of which has the name that a face of it wants."""
        found = np.ones((8, 9, 10), "u1")
        found[:, :, 5:] = 2
        for mesher in MESHERS:
            self.run_command(self.map_of(found), self.path("a.inp"), "--labels", "all", "--label-names",
                          self.write_bytes("box.json", b'{"1": "x min", "2": "b"}'), "--box-faces",
                          "flat", "--mesher", mesher)
            parts = dict(keywords_of(self.path("a.inp")))
            nodes = np.array(parts["*NODE, NSET=Nall"], float)[:, 1:]
            places = (nodes - ORIGIN) / SPACING
            for name, axis, plane in (("x_min_2", 0, -0.5), ("x_max", 0, 9.5), ("y_min", 1, -0.5),
                                      ("y_max", 1, 8.5), ("z_min", 2, -0.5), ("z_max", 2, 7.5)):
                numbers = np.array([int(word) for row in parts[f"*NSET, NSET={name}"] for word in row])
                at = np.abs(places[:, axis] - plane) < 1e-9
                self.assertEqual(set((numbers - 1).tolist()), set(np.flatnonzero(at).tolist()))

    def test_nodes_of_a_period_match(self):
        """Those of opposite sides, in the order of their numbers."""
        for mesher in MESHERS:
            self.run_command(self.map_of(period()), self.path("a.inp"), "--labels", "all", "--box-faces",
                          "periodic", "--mesher", mesher)
            parts = dict(keywords_of(self.path("a.inp")))
            nodes = np.array(parts["*NODE, NSET=Nall"], float)[:, 1:]
            for axis, name in enumerate("xyz"):
                first, last = (np.array([int(word) for row in parts[f"*NSET, NSET={name}_{end}"]
                                         for word in row]) for end in ("min", "max"))
                self.assertTrue((np.diff(first) > 0).all() and (np.diff(last) > 0).all())
                apart = nodes[last - 1] - nodes[first - 1]
                np.testing.assert_array_equal(np.delete(apart, axis, 1), 0)
                np.testing.assert_allclose(apart[:, axis], period().shape[2 - axis] * SPACING[axis])

    def test_sides_of_a_box_in_msh(self):
        found = np.ones((8, 9, 10), "u1")
        found[:, :, 5:] = 2
        self.run_command(self.map_of(found), self.path("a.msh"), "--labels", "all", "--label-names",
                      self.write_bytes("box.json", b'{"1": "x_min", "2": "b"}'), "--box-faces", "flat",
                      "--mesher", MESHERS[0])
        sections = sections_of(self.path("a.msh"))
        nodes = np.array([line.split()[1:] for line in sections["Nodes"][1:]], float)
        rows = [list(map(int, line.split())) for line in sections["Elements"][1:]]
        triangles = np.array([row[3:4] + row[5:] for row in rows if row[1] == 2])
        self.assertEqual(len(triangles), len(set(map(frozenset, triangles[:, 1:].tolist()))))
        names = {name: int(number) for number, name in re.findall(
            r'^2 (\d+) "(.*)"$', "".join(sections["PhysicalNames"]), re.M)}
        sides = ["x_min 2", "x_max", "y_min", "y_max", "z_min", "z_max"]
        self.assertEqual(list(names), ["x_min_to_b", *sides])
        lengths = np.array(found.shape[::-1]) * SPACING
        for side, name in enumerate(sides):
            a, b, c = (nodes[triangles[triangles[:, 0] == names[name], i] - 1] for i in (1, 2, 3))
            plane = ORIGIN[side // 2] - SPACING[side // 2] / 2 + side % 2 * lengths[side // 2]
            np.testing.assert_allclose(np.stack([a, b, c])[..., side // 2], plane, atol=1e-12)
            self.assertAlmostEqual(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2,
                                   np.delete(lengths, side // 2).prod(), 6)

    def test_msh_of_tetrahedra(self):
        _, grid = self.solid("a.vtu", "a.msh", options=("--mesher", MESHERS[0]))
        corners, labels = tetrahedra_of(grid)
        sections = sections_of(self.path("a.msh"))
        nodes = np.array([line.split()[1:] for line in sections["Nodes"][1:]], float)
        np.testing.assert_array_equal(nodes, points_of(grid))
        rows = [list(map(int, line.split())) for line in sections["Elements"][1:]]
        cells = np.array([row for row in rows if row[1] == 4])
        np.testing.assert_array_equal(cells[:, 5:] - 1, corners)
        np.testing.assert_array_equal(cells[:, 3], labels)
        names = dict(re.findall(r'^2 (\d+) "(.*)"$', "".join(sections["PhysicalNames"]), re.M))
        faces = {}
        for row in rows:
            if row[1] == 2:
                faces.setdefault(names[str(row[3])], set()).add(frozenset(i - 1 for i in row[5:]))
        called = {0: "outside", 1: "liver", 2: "left kidney", 4: "a 'b'"}
        self.assertEqual(faces, {f"{called[a]}_to_{called[b]}": found for (a, b), found in
                                 faces_between(corners, labels).items()})

    @unittest.skipUnless("gmsh" in MESHERS, "gmsh is not installed")
    def test_gmsh_reads_its_msh(self):
        report, _ = self.solid("a.vtu", "a.msh", options=("--mesher", "gmsh"))
        said = subprocess.run(["gmsh", self.path("a.msh"), "-parse_and_exit", "-check", "-"],
                              capture_output=True, text=True, check=True).stdout
        self.assertIn(f"{report['solid']['nodes']} nodes", said)

    def run_script(self, script, status=1):
        """What is said of a run whose TetGen is this script, and the files that it leaves."""
        for folder in ("bin", "out"):
            os.makedirs(self.path(folder), exist_ok=True)
        self.write_bytes("bin/tetgen", f"#!/bin/sh\n{script}\n".encode())
        os.chmod(self.path("bin/tetgen"), 0o755)
        process = self.run_command(self.map_of(voxels()), self.path("out/a.vtu"), self.path("out/a.vtp"),
                                "--labels", "all", status=status,
                                env={**os.environ, "PATH": self.path("bin") + ":/bin"})
        return process.stderr, os.listdir(self.path("out"))

    def test_what_fails_is_told(self):
        """A program that is no mesher, and one that is killed: other files are written all the same,
        and nothing else is left behind."""
        for script, said in (("echo sorry; exit 3", r"a.vtu: tetgen fails \(exit code 3\): sorry"),
                             ("kill -9 $$", r"a.vtu: tetgen fails \(signal 9\)"),
                             ("exit 0", "a.vtu: the mesher has made no tetrahedra")):
            told, files = self.run_script(script)
            self.assertRegex(told, said)
            self.assertEqual(files, ["a.vtp"])

    def test_it_can_be_stopped(self):
        told, files = self.run_script("kill -INT $PPID\nsleep 100")
        self.assertRegex(told, "a.vtu: interrupted while tetgen made tetrahedra")
        self.assertEqual(files, ["a.vtp"])

    def test_what_there_is_after_an_interrupt_is_filled(self):
        rest = self.interrupted(r"Making surfaces: +[78]\d %", self.many_labels(4),
                                self.path("many.vtu"), "--labels", "all")
        self.assertIn("unfinished", rest)
        grid = read(self.path("many.vtu"), vtkXMLUnstructuredGridReader())
        self.assertGreater(grid.GetNumberOfCells(), 100)


class OptionsTest(SolidsTest):
    def test_what_is_missing_is_told_before_the_work(self):
        environment = {**os.environ, "PATH": self.folder}
        for options, said in (((), r"none of which is installed \(Debian: apt install tetgen\)"),
                              (("--mesher", "gmsh"), r"gmsh is not installed \(Debian: apt")):
            for name in ("a.vtu", "a.inp"):
                self.refused(said, self.path("missing.vti"), self.path(name), *options,
                             env=environment)

    def test_options_that_mean_nothing(self):
        for options, said in ((("--mesher", "netgen"), "'netgen' is none of tetgen, gmsh"),
                              (("--mesher", "gmsh"), "--mesher needs a file of tetrahedra"),
                              (("--maximum-volume", "2"), "needs a file of tetrahedra"),
                              (("--maximum-volume", "0"), "a volume is more than 0")):
            self.refused(said, self.path("missing.vti"), self.path("a.stl"), *options, status=2)


@unittest.skipUnless(MESHERS, "no mesher is installed")
class SolverTest(SolidsTest):
    def sets(self, path):
        """{(keyword, name): rows}"""
        found = {}
        for head, rows in keywords_of(path):
            name = re.search(r"(ELSET|NSET|NAME)=(\w+)", head)
            found[head.split(",")[0], name.group(2)] = rows
        return found

    def test_sets_of_inp(self):
        _, grid = self.solid("a.vtu", "a.inp")
        corners, labels = tetrahedra_of(grid)
        sets = self.sets(self.path("a.inp"))
        nodes = np.array(sets["*NODE", "Nall"], float)
        np.testing.assert_allclose(nodes[:, 1:], points_of(grid), atol=1e-9)
        called = {1: "liver", 2: "left_kidney", 4: "a__b_"}
        numbers = {name: {int(i) for row in rows for i in row}
                   for (keyword, name), rows in sets.items() if keyword == "*NSET"}
        for label, name in called.items():
            rows = np.array(sets["*ELEMENT", name], int)
            np.testing.assert_array_equal(rows[:, 0] - 1, np.flatnonzero(labels == label))
            np.testing.assert_array_equal(rows[:, 1:] - 1, corners[labels == label])
            self.assertEqual(numbers[name], set(rows[:, 1:].ravel().tolist()))
        self.assertEqual([row[0] for row in sets["*ELSET", "Eall"]], list(called.values()))
        # The corners of faces in Abaqus, from 1.
        sides = {"S1": (1, 2, 3), "S2": (1, 4, 2), "S3": (2, 4, 3), "S4": (3, 4, 1)}
        surfaces = {}
        for (keyword, name), rows in sets.items():
            if keyword == "*SURFACE":
                found = {frozenset(corners[int(cell) - 1][np.array(sides[side]) - 1].tolist())
                         for cell, side in rows}
                surfaces[name] = found
                self.assertEqual(numbers[name], {i + 1 for face in found for i in face})
        called[0] = "outside"
        self.assertEqual(surfaces, {f"{called[a]}_to_{called[b]}": found for (a, b), found in
                                    faces_between(corners, labels).items()})
        text = self.content("a.inp").decode()
        self.assertLess(max(len(word) for line in text.splitlines() if line[0] != "*"
                            for word in line.split(", ")), 21)

    def test_names_of_sets_are_words_and_differ(self):
        names = b'{"1": "Liver, left", "2": "liver left", "4": "4th"}'
        self.run_command(self.map_of(voxels()), self.path("a.inp"), "--labels", "all", "--label-names",
                      self.write_bytes("words.json", names))
        heads = [head for head, _ in keywords_of(self.path("a.inp"))]
        elements = [re.search("ELSET=(.*)", head).group(1) for head in heads if "C3D4" in head]
        self.assertEqual(elements, ["Liver__left", "liver_left", "L_4th"])
        names = Counter(re.search("NSET=(.*)", head).group(1).lower() for head in heads
                        if head.startswith("*NSET"))
        self.assertEqual(max(names.values()), 1)

    @unittest.skipUnless(shutil.which("ccx"), "CalculiX is not installed")
    def test_calculix_solves_it(self):
        """The force of a pressure is that of the supports; volumes are those of the surfaces."""
        report, grid = self.solid("a.vtu", "a.inp")
        self.write_bytes("job.inp", b"""*INCLUDE, INPUT=a.inp
*MATERIAL, NAME=M
*ELASTIC
1000., .3
*SOLID SECTION, ELSET=Eall, MATERIAL=M
*BOUNDARY
liver_to_outside, 1, 3
*STEP
*STATIC
*DSLOAD
a__b__to_outside, P, 2.
*NODE PRINT, NSET=liver_to_outside, TOTALS=ONLY
RF
*EL PRINT, ELSET=left_kidney, TOTALS=ONLY
EVOL
*END STEP
""")
        subprocess.run(["ccx", "job"], cwd=self.folder, check=True, capture_output=True)
        numbers = [list(map(float, line.split())) for line in
                   self.content("job.dat").decode().splitlines()
                   if re.match(r"^[-+ .0-9E]+$", line) and line.strip()]
        force, volume = np.array(numbers[0]), numbers[1][0]
        expected = next(row for row in report["labels"] if row["label"] == 2)["volume"]
        self.assertAlmostEqual(volume / expected, 1, 4)
        # The pressure on the outer face of label 4, against the normals. A third of that of a face
        # acts on each corner; what acts on nodes that are held is in what is printed of these.
        points, (corners, labels) = points_of(grid), tetrahedra_of(grid)
        faces = faces_between(corners, labels)
        held = set().union(*faces[1, 0])
        total = np.zeros(3)
        for cell in corners[labels == 4]:
            for i in range(4):
                face = np.delete(cell, i)
                if frozenset(face.tolist()) in faces[4, 0]:
                    a, b, c = points[face]
                    normal = np.cross(b - a, c - a) / 2
                    share = 1 - len(held.intersection(face.tolist())) / 3
                    total += share * normal * (1 if np.dot(normal, a - points[cell[i]]) > 0 else -1)
        np.testing.assert_allclose(force, 2 * total, atol=1e-4 * np.abs(total).max())


if __name__ == "__main__":
    unittest.main()
