# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""`volumic --shared-interfaces`, and files for meshers of solids: .msh, .smesh, .poly."""

import json
import os
import re
import unittest
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
    """[z, y, x] A ball in three sectors, which meet in a line, and a hollow core."""
    z, y, x = np.indices((24, 24, 24)) - 11.5
    far = np.sqrt(x ** 2 + y ** 2 + z ** 2)
    return np.select([far < 3.5, far < 6, far > 10.5, x < 0, y < 0],
                     [0, 9, 0, 1, 2], 4).astype("i2")


def nested():
    """A box of 1 with one of 2 in it, in which are one of 1, and one of nothing; a box apart."""
    voxels = np.zeros((22, 22, 44), "i2")
    voxels[2:20, 2:20, 2:30] = 1
    voxels[5:17, 5:17, 5:27] = 2
    voxels[8:14, 8:14, 8:14] = 1
    voxels[8:14, 8:14, 18:24] = 0
    voxels[6:14, 6:14, 34:42] = -3
    return voxels


def period():
    """[z, y, x] The cells of ten points, which fill all, in a map that repeats."""
    shape = np.array((21, 24, 27))
    seeds = np.random.default_rng(5).random((10, 3)) * shape
    way = np.stack(np.indices(shape), axis=-1)[..., None, :] - seeds
    way = SPACING[::-1] * (way - shape * np.round(way / shape))
    return (np.argmin((way ** 2).sum(-1), axis=-1) + 1).astype("u1")


def edges_of(triangles):
    return Counter(tuple(sorted(pair)) for triangle in triangles.tolist()
                   for pair in zip(triangle, triangle[1:] + triangle[:1]))


def solid_angles(points, triangles, place):
    """Of a closed surface: 4 pi where the place is inside."""
    a, b, c = (points[triangles[:, i]] - place for i in range(3))
    p, q, r = (np.linalg.norm(n, axis=1) for n in (a, b, c))
    below = p * q * r + sum((m * n).sum(1) * o for m, n, o in ((a, b, r), (b, c, p), (c, a, q)))
    return 2 * np.arctan2((a * np.cross(b, c)).sum(1), below).sum()


def enclosed(points, triangles):
    a, b, c = (points[triangles[:, i]] for i in range(3))
    return (a * np.cross(b, c)).sum() / 6


class InterfacesTest(LabelsTest):
    def map_of(self, voxels, name="map.vti"):
        return self.map_file(name, make_image(voxels, SPACING, ORIGIN))

    def names_file(self, name="names.json"):
        return self.write_bytes(name, json.dumps(NAMES).encode())

    def make(self, voxels, *files, options=()):
        self.run_command(self.map_of(voxels), *map(self.path, files), "--labels", "all",
                         "--label-names", self.names_file(), *options)


class OneMeshTest(InterfacesTest):
    def test_each_triangle_is_there_once(self):
        """What is in the files; that the mesh is right is tested with the filter."""
        self.make(sectors(), "a.vtp", "a.vtk", "a.vtm", options=[
            "--shared-interfaces", "--report", self.path("r.json")])
        mesh = read(self.path("a.vtp"))
        lines = vtk_to_numpy(mesh.GetLines().GetConnectivityArray()).reshape(-1, 2)
        self.assertEqual(len(lines), mesh.GetNumberOfLines())
        triangles = triangles_of(mesh)
        sides = vtk_to_numpy(mesh.GetCellData().GetArray("BoundaryLabels"))
        self.assertEqual(sides.shape, (len(lines) + len(triangles), 2))
        sides = sides[len(lines):]
        self.assertEqual(set(map(tuple, np.sort(sides, axis=1).tolist())),
                         {(0, 1), (0, 2), (0, 4), (0, 9), (1, 2), (1, 4), (2, 4), (1, 9), (2, 9),
                          (4, 9)})
        edges = edges_of(triangles)
        self.assertEqual({edge for edge, count in edges.items() if count > 2},
                         {tuple(sorted(line)) for line in lines.tolist()})
        legacy = read(self.path("a.vtk"), vtkPolyDataReader())
        np.testing.assert_array_equal(triangles_of(legacy), triangles)
        self.assertEqual(legacy.GetNumberOfLines(), len(lines))
        for label, (name, block) in zip((1, 2, 4, 9), read_blocks(self.path("a.vtm")).items()):
            self.assertEqual(name, NAMES[label])
            self.assertEqual((sides == label).any(1).sum(), block.GetNumberOfPolys())
            numbers = vtk_to_numpy(block.GetPointData().GetArray("GlobalIds"))
            np.testing.assert_allclose(points_of(block), points_of(mesh)[numbers], atol=1e-6)
        report = json.loads(self.content("r.json"))
        fields = mesh.GetFieldData()
        self.assertEqual(fields.GetArray("WorstAngle").GetTuple1(0), report["worst_angle"])
        self.assertEqual(list(fields.GetArray("WorstAnglePosition").GetTuple3(0)),
                         report["worst_angle_position"])
        self.assertEqual(report["small_contacts"], 0)
        separate = self.report(self.path("map.vti"), "--labels", "all")
        self.assertNotIn("worst_angle", separate)

    def test_merged(self):
        for options in ((), ("--shared-interfaces",)):
            self.make(sectors(), "a.vtp", "a.smesh", options=["--merge", *options])
            self.assertIn(b"# region 1: liver, left kidney, a 'b' ... x", self.content("a.smesh"))
        mesh = read(self.path("a.vtp"))
        self.assertEqual(mesh.GetNumberOfLines(), 0)
        sides = vtk_to_numpy(mesh.GetCellData().GetArray("BoundaryLabels"))
        self.assertEqual(set(map(tuple, sides.tolist())), {(1, 0), (2, 0), (4, 0), (9, 0)})

    def test_without_it_surfaces_are_as_ever(self):
        volume = self.map_of(sectors())
        self.refused(r"a.stl: 4 labels .* --merge, or one mesh of all with --shared-interfaces "
                     r"\(.*a.vtp, .vtk, .vtu, .inp, .msh, .smesh, .poly\)", volume,
                     self.path("a.stl"), "--labels", "all", "--shared-interfaces")
        self.run_command(volume, self.path("a.vtp"), "--labels", "1")
        self.assertFalse(read(self.path("a.vtp")).GetCellData().HasArray("BoundaryLabels"))

    def test_files_of_meshers_imply_it(self):
        volume = self.map_of(sectors())
        for name in ("a.msh", "a.smesh", "a.poly"):
            report = self.report(volume, self.path(name), "--labels", "1,2")
            self.assertEqual(report["properties"]["SharedInterfaces"], "on")
            self.assertTrue(os.path.getsize(self.path(name)))
        # A file for each label is one of a surface.
        report = self.report(volume, self.path("o/"), "--labels", "1,2", "--format", "msh")
        self.assertEqual(report["properties"]["SharedInterfaces"], "off")
        self.assertEqual(sorted(os.listdir(self.path("o"))), ["label-1.msh", "label-2.msh"])

    def test_what_does_not_go_with_it(self):
        self.refused("map.vti: .*--shared-interfaces", self.map_of(sectors()),
                     self.path("a.msh"), "--labels", "all", "--thin-parts")
        layers = "".join(f"Segment{i}_{key}:={value}\n" for i in range(2) for key, value in (
            ("LabelValue", 1), ("Layer", i), ("Name", f"s{i}")))
        head = ("NRRD0004\ntype: uint8\ndimension: 4\nsizes: 2 9 9 9\nkinds: list domain domain "
                "domain\nspace: left-posterior-superior\nspace directions: none (1,0,0) (0,1,0) "
                f"(0,0,1)\nspace origin: (0,0,0)\nencoding: raw\n{layers}\n")
        voxels = np.zeros((9, 9, 9, 2), "u1")
        voxels[2:7, 2:7, 2:7, 0] = voxels[3:8, 3:8, 3:8, 1] = 1
        file = self.write_bytes("two.seg.nrrd", head.encode() + voxels.tobytes())
        self.refused("--shared-interfaces: the labels lie in several layers .* --component", file,
                     self.path("a.msh"), "--labels", "all")
        self.run_command(file, self.path("a.msh"), "--labels", "s1")


class BoxTest(InterfacesTest):
    def test_sides_of_the_box(self):
        """The mesh of a turned image, in its index space."""
        voxels = period()
        file = self.map_file("map.vti", make_image(voxels, SPACING, ORIGIN, TURNED))
        for kind in ("flat", "periodic"):
            self.run_command(file, self.path("a.vtp"), "--labels", "all", "--shared-interfaces",
                             "--box-faces", kind)
            mesh = read(self.path("a.vtp"))
            points = (points_of(mesh) - ORIGIN) @ np.linalg.inv(TURNED).T / SPACING
            faces = vtk_to_numpy(mesh.GetCellData().GetArray("BoxFace"))[mesh.GetNumberOfLines():]
            self.assertEqual(set(faces), set(range(7)))
            for face in range(1, 7):
                axis, last = divmod(face - 1, 2)
                plane = voxels.shape[2 - axis] - 0.5 if last else -0.5
                at = points[triangles_of(mesh)[faces == face]][..., axis]
                self.assertLess(np.abs(at - plane).max(), 1e-12)

    def test_what_is_no_period_is_reported(self):
        for voxels, said in (
                (period()[:, :12], r"not along y: .* differs from it in \d+ % of the voxels, .* "
                 "Set --box-faces to flat"),
                (np.ones((3, 9, 9)), "only 2.25 wide along z: .* shorter --edge-length")):
            self.refused(said, self.map_of(voxels.astype("u1")), self.path("o.msh"), "--labels",
                         "all", "--box-faces", "periodic")
        self.refused("--box-faces are to be flat.*Give --shared-interfaces", self.map_of(period()),
                     self.path("o/"), "--labels", "all", "--box-faces", "flat")


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
    """Of each block: dimension, entity, third number of its head, number of things, which have so
    many lines each, and the first line of these."""
    at, count = 1, int(lines[0].split()[0])
    for _ in range(count):
        dimension, entity, third, number = map(int, lines[at].split())
        yield dimension, entity, third, number, at + 1
        at += 1 + number * each


class Msh:
    """Of MSH 4.1: names of groups, what is in them, what bounds volumes, and triangles."""

    def __init__(self, path):
        sections = sections_of(path)
        assert sections["MeshFormat"] == ["4.1 0 8\n"]
        rows = [line.strip().split(" ", 2) for line in sections["PhysicalNames"][1:]]
        self.names = {(int(row[0]), int(row[1])): row[2] for row in rows}
        entities = [line.split() for line in sections["Entities"]]
        counts = [int(word) for word in entities[0]]
        assert counts[:2] == [0, 0] and len(entities) == 1 + sum(counts)
        rows = entities[1:1 + counts[2]]
        self.mark_of = {int(row[0]): int(row[8]) for row in rows}
        self.boxes = {int(row[0]): np.array(row[1:7], float) for row in rows}
        self.label_of, self.bounds = {}, {}
        for row in entities[1 + counts[2]:]:
            self.label_of[int(row[0])] = int(row[8])
            self.bounds[int(row[0])] = [int(word) for word in row[10:]]
            assert len(row) == 10 + int(row[9])
        self.read_triangles(sections)

    def read_triangles(self, sections):
        places, numbers, self.triangles = [], [], {}
        lines = sections["Nodes"]
        for dimension, entity, parametric, count, at in blocks_of(lines, 2):
            assert (dimension, parametric) == (2, 0) and entity in self.mark_of
            numbers += [int(line) for line in lines[at:at + count]]
            places += [line.split() for line in lines[at + count:at + 2 * count]]
        assert numbers == list(range(1, len(numbers) + 1))
        self.points = np.array(places, float)
        lines = sections["Elements"]
        for dimension, entity, kind, count, at in blocks_of(lines, 1):
            assert (dimension, kind) == (2, 2)
            self.triangles[entity] = np.array([line.split()[1:] for line in lines[at:at + count]],
                                              int) - 1
        all_of = sum(map(len, self.triangles.values()))
        assert lines[0].split() == [str(len(self.mark_of)), str(all_of), "1", str(all_of)]

    def boundary(self, volume):
        """Its triangles, with normals that point out of it."""
        return np.concatenate([self.triangles[abs(face)][:, ::1 if face > 0 else -1]
                               for face in self.bounds[volume]])


class GmshTest(InterfacesTest):
    def check_volumes(self, msh, report):
        """The boundaries of each volume are closed, and it is as large as the surfaces say."""
        volumes = Counter()
        for volume, label in msh.label_of.items():
            boundary = msh.boundary(volume)
            pairs = Counter(tuple(pair) for pair in np.concatenate(
                [boundary[:, [0, 1]], boundary[:, [1, 2]], boundary[:, [2, 0]]]).tolist())
            for (a, b), count in pairs.items():
                self.assertEqual(pairs[b, a], count)
            size = enclosed(msh.points, boundary)
            self.assertGreater(size, 0)
            volumes[label] += size
        for row in report["labels"]:
            number = abs(row["label"])  # -3 is not positive, and 3 is no label
            self.assertAlmostEqual(volumes[number] / row["volume"], 1, places=5)

    def test_a_volume_for_each_region(self):
        report = self.report(self.map_of(sectors()), self.path("a.msh"), "--labels", "all",
                             "--label-names", self.names_file())
        msh = Msh(self.path("a.msh"))
        self.check_volumes(msh, report)
        self.assertEqual(sorted(msh.label_of.values()), [1, 2, 4, 9])
        long_name = "x" * 25 + " ... " + "x" * 25
        self.assertEqual({number: name for (dimension, number), name in msh.names.items()
                          if dimension == 3},
                         {1: '"liver"', 2: '"left kidney"', 4: "\"a 'b'\"", 9: f'"{long_name}"'})
        marks = {name.strip('"'): number for (dimension, number), name in msh.names.items()
                 if dimension == 2}
        self.assertEqual(set(marks.values()), set(range(1, 11)))
        self.assertEqual(set(msh.mark_of.values()), set(marks.values()))
        for name in ("liver_to_outside", "liver_to_left kidney", f"{long_name}_to_outside",
                     f"a 'b'_to_{long_name}"):
            self.assertIn(name, marks)
        for entity, triangles in msh.triangles.items():
            corners = msh.points[triangles.ravel()]
            np.testing.assert_allclose(msh.boxes[entity],
                                       np.concatenate([corners.min(0), corners.max(0)]))

    def test_no_two_things_have_one_name(self):
        """Whatever labels are called, and however much of it the file can tell."""
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
        lines = self.content("a.smesh").decode().splitlines()
        told = [line.split(": ", 1)[1] for line in lines
                if line.startswith(("# region", "# facets"))]
        self.assertEqual(sorted(f'"{name}"' for name in told), sorted(found))

    def test_parts_within_parts(self):
        """gmsh identifies a region by its surfaces: no two regions may have the same."""
        report = self.report(self.map_of(nested()), self.path("a.msh"), "--labels", "all")
        msh = Msh(self.path("a.msh"))
        self.check_volumes(msh, report)
        self.assertEqual(sorted(msh.label_of.values()), [1, 1, 2, 3])
        self.assertEqual(msh.names[3, 3], '"Label -3"')
        faces = [frozenset(map(abs, bounds)) for bounds in msh.bounds.values()]
        self.assertEqual(len(set(faces)), 4)
        self.assertEqual(sorted(map(len, faces)), [1, 1, 2, 3])

    def test_one_surface(self):
        self.run_command(self.ball_file(), self.path("a.msh"), self.path("a.vtp"), "--iso", ISO)
        msh, surface = Msh(self.path("a.msh")), read(self.path("a.vtp"))
        self.assertEqual(msh.names, {(2, 1): '"object_to_outside"', (3, 1): '"object"'})
        np.testing.assert_array_equal(np.sort(msh.points, axis=0),
                                      np.sort(points_of(surface), axis=0))
        self.assertAlmostEqual(enclosed(msh.points, msh.boundary(1)),
                               enclosed(points_of(surface).astype(float), triangles_of(surface)))


class TetgenTest(InterfacesTest):
    def parts(self, name):
        """Names in the head, points, triangles, their marks, cavities, regions."""
        text = self.content(name).decode()
        names = dict(re.findall(r"^# (\w+ \d+): (.*)$", text, re.M))
        rows = [line.split() for line in text.splitlines() if not line.startswith("#")]
        found, at = [], 0
        for part in range(4):
            count = int(rows[at][0])
            size = 2 if part == 1 and name.endswith(".poly") else 1
            found.append(rows[at + 1:at + 1 + size * count])
            at += 1 + size * count
        self.assertEqual(at, len(rows))
        points, facets, holes, regions = found
        if name.endswith(".poly"):
            self.assertTrue(all(head[:2] == ["1", "0"] for head in facets[::2]))
            facets = [row + head[2:] for head, row in zip(facets[::2], facets[1::2])]
        facets = np.array(facets, int)
        self.assertEqual(set(facets[:, 0]), {3})
        for part in (points, holes, regions):
            self.assertEqual([int(row[0]) for row in part], list(range(1, len(part) + 1)))
        return (names, np.array(points, float)[:, 1:], facets[:, 1:4] - 1, facets[:, 4],
                np.array(holes, float).reshape(-1, 4)[:, 1:], np.array(regions, float)[:, 1:])

    def test_a_point_in_each_region(self):
        for voxels, found in ((sectors(), {1: 1, 2: 1, 4: 1, 9: 1}),
                              (nested(), {1: 2, 2: 1, 3: 1})):
            self.make(voxels, "a.smesh", "a.vtm")
            names, _, _, marks, holes, regions = self.parts("a.smesh")
            self.assertEqual(Counter(regions[:, 3]), found)
            labels = [label for label in np.unique(voxels) if label != 0]
            numbers = {label: abs(label) for label in labels}
            blocks = dict(zip(labels, read_blocks(self.path("a.vtm")).values()))
            for place, label in zip(regions[:, :3], regions[:, 3]):
                for other, block in blocks.items():
                    angle = solid_angles(points_of(block), triangles_of(block), place)
                    self.assertAlmostEqual(angle, 4 * np.pi * (numbers[other] == label), places=3)
            for place in holes:
                for block in blocks.values():
                    angle = solid_angles(points_of(block), triangles_of(block), place)
                    self.assertAlmostEqual(angle, 0, places=3)
            self.assertEqual(len(holes), 1)
            self.assertEqual(set(marks), set(range(1, 1 + sum("facets" in n for n in names))))

    def test_a_hollow_surface(self):
        z, y, x = np.indices((30, 30, 30)) - 14.5
        far = np.sqrt(x ** 2 + y ** 2 + z ** 2)
        volume = self.map_of(np.minimum(11 - far, far - 5), "hollow.vti")
        self.run_command(volume, self.path("a.smesh"), "--iso", "0", "--recovery",
                      "objects-and-cavities")
        names, _, _, marks, holes, regions = self.parts("a.smesh")
        self.assertEqual(names, {"region 1": "object", "facets 1": "object_to_outside"})
        self.assertEqual(set(marks), {1})
        middle = ORIGIN + 14.5 * SPACING
        (hole,), (region,) = holes, regions
        self.assertLess(np.linalg.norm((hole - middle) / SPACING), 5.2)
        self.assertTrue(4.8 < np.linalg.norm((region[:3] - middle) / SPACING) < 11.2)
        self.assertEqual(region[3], 1)


if __name__ == "__main__":
    unittest.main()
