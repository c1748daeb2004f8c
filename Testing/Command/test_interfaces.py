# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Tests of the mesh of all labels, and of input files of meshers: .msh, .smesh, .poly."""

import json
import os
import re
from collections import Counter

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOLegacy import vtkPolyDataReader

from test_labels import LabelsTest
from command_test_case import ISO, TURNED, make_image
from vtk_files import points_of, read, read_blocks, triangles_of

SPACING, ORIGIN = np.array([1.0, 1.25, 0.75]), np.array([5.0, -3.0, 40.0])
NAMES = {1: "liver", 2: "left kidney", 4: 'a "b"', 9: "x" * 300}


def sectors():
    """Return a ball [z, y, x] in three sectors that meet in a line, with a hollow core."""
    z, y, x = np.indices((24, 24, 24)) - 11.5
    far = np.sqrt(x ** 2 + y ** 2 + z ** 2)
    return np.select([far < 3.5, far < 6, far > 10.5, x < 0, y < 0],
                     [0, 9, 0, 1, 2], 4).astype("i2")


def nested():
    """Return a box of label 1 that contains label 2 with label 1 and a cavity in it, and a separate
    box."""
    voxels = np.zeros((22, 22, 44), "i2")
    voxels[2:20, 2:20, 2:30] = 1
    voxels[5:17, 5:17, 5:27] = 2
    voxels[8:14, 8:14, 8:14] = 1
    voxels[8:14, 8:14, 18:24] = 0
    voxels[6:14, 6:14, 34:42] = -3
    return voxels


def period():
    """Return the cells of ten points in a periodic map [z, y, x]."""
    shape = np.array((21, 24, 27))
    seeds = np.random.default_rng(5).random((10, 3)) * shape
    way = np.stack(np.indices(shape), axis=-1)[..., None, :] - seeds
    way = SPACING[::-1] * (way - shape * np.round(way / shape))
    return (np.argmin((way ** 2).sum(-1), axis=-1) + 1).astype("u1")


class InterfacesTest(LabelsTest):
    def map_of(self, voxels, name="map.vti"):
        return self.map_file(name, make_image(voxels, SPACING, ORIGIN))

    def names_file(self, name="names.json"):
        return self.write_bytes(name, json.dumps(NAMES).encode())

    def make(self, voxels, *files, options=()):
        self.run_command(self.map_of(voxels), *map(self.path, files), "--labels", "all",
                         "--label-names", self.names_file(), *options)


class OneMeshTest(InterfacesTest):
    def test_each_triangle_is_stored_once(self):
        """C++ tests check the mesh itself."""
        self.make(sectors(), "a.vtp", "a.vtk", "a.vtm", options=["--report", self.path("r.json")])
        mesh = read(self.path("a.vtp"))
        lines = vtk_to_numpy(mesh.GetLines().GetConnectivityArray()).reshape(-1, 2)
        triangles = triangles_of(mesh)
        sides = vtk_to_numpy(mesh.GetCellData().GetArray("BoundaryLabels"))
        self.assertEqual(sides.shape, (len(lines) + len(triangles), 2))
        sides = sides[len(lines):]
        self.assertEqual(set(map(tuple, np.sort(sides, axis=1).tolist())),
                         {(0, 1), (0, 2), (0, 4), (0, 9), (1, 2), (1, 4), (2, 4), (1, 9), (2, 9),
                          (4, 9)})
        legacy = read(self.path("a.vtk"), vtkPolyDataReader())
        np.testing.assert_array_equal(triangles_of(legacy), triangles)
        self.assertEqual(legacy.GetNumberOfLines(), len(lines))
        for label, (name, block) in zip((1, 2, 4, 9), read_blocks(self.path("a.vtm")).items()):
            self.assertEqual(name, NAMES[label])
            self.assertEqual((sides == label).any(1).sum(), block.GetNumberOfPolys())
            numbers = vtk_to_numpy(block.GetPointData().GetArray("GlobalIds"))
            np.testing.assert_allclose(points_of(block), points_of(mesh)[numbers], atol=1e-6)
        report, fields = json.loads(self.content("r.json")), mesh.GetFieldData()
        self.assertEqual(fields.GetArray("WorstAngle").GetTuple1(0), report["worst_angle"])
        self.assertEqual(list(fields.GetArray("WorstAnglePosition").GetTuple3(0)),
                         report["worst_angle_position"])
        self.assertEqual(report["small_contacts"], 0)

    def test_merged(self):
        self.make(sectors(), "a.vtp", "a.smesh", options=["--merge"])
        self.assertIn(b"# region 1: liver, left kidney, a 'b' ... x", self.content("a.smesh"))
        labels = vtk_to_numpy(read(self.path("a.vtp")).GetCellData().GetArray("Label"))
        self.assertEqual(set(labels.tolist()), {1, 2, 4, 9})

    def test_files_of_one_label_and_of_several(self):
        volume = self.map_of(sectors())
        for name, labels in (("a.msh", "1,2"), ("a.vtp", "1"), ("b.vtp", "1,2"), ("o/", "1,2")):
            report = self.report(volume, self.path(name), "--labels", labels,
                                 *["--format", "msh"] * (name == "o/"))
            self.assertEqual(report["labels"][0]["components"], 1)
            self.assertTrue(os.path.getsize(self.path(name)))
        self.assertEqual(sorted(os.listdir(self.path("o"))), ["label-1.msh", "label-2.msh"])
        for name, mesh in (("a.vtp", False), ("b.vtp", True)):
            cells = read(self.path(name)).GetCellData()
            self.assertEqual((cells.HasArray("BoundaryLabels"), cells.HasArray("Label")),
                             (mesh, not mesh))

    def test_box_faces(self):
        file = self.map_file("map.vti", make_image(period(), SPACING, ORIGIN, TURNED))
        self.run_command(file, self.path("a.vtp"), "--labels", "all", "--box-faces", "periodic")
        mesh = read(self.path("a.vtp"))
        points = (points_of(mesh) - ORIGIN) @ np.linalg.inv(TURNED).T / SPACING
        faces = vtk_to_numpy(mesh.GetCellData().GetArray("BoxFace"))[mesh.GetNumberOfLines():]
        self.assertEqual(set(faces), set(range(7)))
        at = points[triangles_of(mesh)[faces == 2]][..., 0]
        self.assertLess(np.abs(at - (period().shape[2] - 0.5)).max(), 1e-12)
        self.rejects(r"not periodic along y: .* differ in \d+ % of the voxels, .* Set --box-faces to "
                     "flat", self.map_of(period()[:, :12]), self.path("o.msh"), "--labels",
                     "all", "--box-faces", "periodic")
        self.run_command(file, self.path("o/"), "--labels", "2,3", "--box-faces", "flat")
        faces = read(self.path("o/label-2.vtp")).GetCellData().GetArray("BoxFace")
        self.assertGreater(faces.GetRange()[1], 0)


def sections_of(path):
    """Return the lines of a text .msh by section."""
    with open(path, encoding="utf-8") as file:
        return {name: lines.splitlines(True) for name, lines in re.findall(
            r"^\$(\w+)\n(.*?)^\$End\1$", file.read(), re.MULTILINE | re.DOTALL)}


class Msh:
    """MSH 4.1: names of groups, groups of surfaces, labels and boundaries of volumes, triangles."""

    def __init__(self, path):
        sections = sections_of(path)
        rows = [line.strip().split(" ", 2) for line in sections["PhysicalNames"][1:]]
        self.names = {(int(row[0]), int(row[1])): row[2] for row in rows}
        (_, _, count, _), *rows = ([float(word) for word in line.split()]
                                   for line in sections["Entities"])
        surfaces, volumes = rows[:int(count)], rows[int(count):]
        self.mark_of = {int(row[0]): int(row[8]) for row in surfaces}
        self.label_of = {int(row[0]): int(row[8]) for row in volumes}
        self.bounds = {int(row[0]): list(map(int, row[10:])) for row in volumes}
        rows = [line.split() for line in sections["Nodes"][1:]]
        self.points = np.array([row for row in rows if len(row) == 3], float)
        self.triangles, rows = {}, [list(map(int, line.split())) for line in sections["Elements"]]
        while len(rows) > 1:
            _, entity, _, count = rows[1]
            self.triangles[entity] = np.array(rows[2:2 + count])[:, 1:] - 1
            rows[1:2 + count] = []

    def volume_of(self, volume):
        """Return the volume enclosed by the boundary, whose normals point outward."""
        triangles = np.concatenate([self.triangles[abs(face)][:, ::1 if face > 0 else -1]
                                    for face in self.bounds[volume]])
        pairs = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
        assert Counter(map(tuple, pairs.tolist())) == Counter(map(tuple, pairs[:, ::-1].tolist()))
        a, b, c = np.moveaxis(self.points[triangles], 1, 0)
        return (a * np.cross(b, c)).sum() / 6


class MeshersTest(InterfacesTest):
    """test_solids.py runs gmsh and TetGen on these files."""

    def regions(self, name):
        """Return names in the header of a TetGen file, facet markers, number of holes, and
        regions."""
        text = self.content(name).decode()
        rows = [line.split() for line in text.splitlines() if not line.startswith("#")]
        parts, is_poly = [], name.endswith(".poly")
        for part in range(4):
            size = int(rows[0][0]) * (1 + (is_poly and part == 1))
            parts.append(rows[1:1 + size])
            rows = rows[1 + size:]
        marks = [row[-1] for row in (parts[1][::2] if is_poly else parts[1])]
        return (re.findall(r"^# (\w+ \d+): (.*)$", text, re.M), set(map(int, marks)),
                len(parts[2]), sorted(int(row[4]) for row in parts[3]))

    def test_one_volume_per_region(self):
        """gmsh requires that no two volumes have the same boundary."""
        for voxels, labels, faces, marks in ((sectors(), [1, 2, 4, 9], [4, 4, 4, 4], 10),
                                             (nested(), [1, 1, 2, 3], [1, 1, 2, 3], 4)):
            report = self.report(self.map_of(voxels), self.path("a.msh"), self.path("a.smesh"),
                                 self.path("a.poly"), "--labels", "all")
            msh, volumes = Msh(self.path("a.msh")), Counter()
            for volume, label in msh.label_of.items():
                volumes[label] += msh.volume_of(volume)
            for row in report["labels"]:  # numbers must be positive and unused
                self.assertAlmostEqual(volumes[abs(row["label"])] / row["volume"], 1, places=5)
            self.assertEqual(sorted(msh.label_of.values()), labels)
            self.assertEqual(sorted(map(len, msh.bounds.values())), faces)
            self.assertEqual(len(set(map(frozenset, msh.bounds.values()))), len(faces))
            self.assertEqual(set(msh.mark_of.values()), set(range(1, marks + 1)))
            for name in ("a.smesh", "a.poly"):
                _, *found = self.regions(name)
                self.assertEqual(found, [set(range(1, marks + 1)), 1, labels])
        self.assertEqual(msh.names[3, 3], '"Label -3"')

    def test_names_are_unique(self):
        names = {"0": "Background", "1": "outside", "2": "x" * 25 + "1" * 9 + "x" * 25,
                 "4": "x" * 25 + "2" * 9 + "x" * 25, "9": "outside_to_outside 2"}
        self.run_command(self.map_of(sectors()), self.path("a.msh"), self.path("a.smesh"),
                         "--labels", "all", "--label-names",
                         self.write_bytes("same.json", json.dumps(names).encode()))
        found = list(Msh(self.path("a.msh")).names.values())
        self.assertEqual(len(found), 4 + 10)
        self.assertEqual(len(set(found)), len(found), found)
        for name in ("outside", "x" * 25 + " ... " + "x" * 25 + " 2", "outside_to_outside 2",
                     "outside_to_outside 2 2"):
            self.assertIn(f'"{name}"', found)
        self.assertEqual(sorted(f'"{name}"' for _, name in self.regions("a.smesh")[0]),
                         sorted(found))

    def test_one_surface(self):
        self.run_command(self.ball_file(), self.path("a.msh"), self.path("a.smesh"),
                         self.path("a.vtp"), "--iso", ISO)
        msh, surface = Msh(self.path("a.msh")), read(self.path("a.vtp"))
        self.assertEqual(msh.names, {(2, 1): '"object_to_outside"', (3, 1): '"object"'})
        np.testing.assert_array_equal(np.sort(msh.points, axis=0),
                                      np.sort(points_of(surface), axis=0))
        self.assertAlmostEqual(msh.volume_of(1),
                               surface.GetFieldData().GetArray("Volume").GetValue(0), 3)
        self.assertEqual(self.regions("a.smesh"), (
            [("region 1", "object"), ("facets 1", "object_to_outside")], {1}, 0, [1]))
