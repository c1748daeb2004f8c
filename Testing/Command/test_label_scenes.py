# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""`volumic --labels`: colours and names in .ply, .glb and .3mf, read without what has written them."""

import json
import os
import re
import shutil
import struct
import subprocess
import unittest
import zipfile
from xml.etree import ElementTree

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOGeometry import vtkGLTFReader

from test_labels import BLOBS, NAMES, LabelsTest
from command_test_case import ISO, ball, nrrd_header
from vtk_files import points_of, read, triangles_of

COLORS = {1: (200, 30, 0), 2: (0, 255, 120), 7: (10, 20, 30), -3: (255, 255, 255)}


def enclosed(points, triangles):
    """The volume; negative where triangles turn inward."""
    a, b, c = (points[triangles[:, i]].astype(float) for i in range(3))
    return (a * np.cross(b, c)).sum() / 6


def linear(color):
    share = np.array(color) / 255
    return np.where(share <= 0.04045, share / 12.92, ((share + 0.055) / 1.055) ** 2.4)


class Scene:
    """A .glb by the words of the specification of glTF 2.0."""

    def __init__(self, data):
        magic, version, size, json_size, json_type = struct.unpack("<4sIII4s", data[:20])
        assert (magic, version, size, json_type) == (b"glTF", 2, len(data), b"JSON")
        assert json_size % 4 == 0
        self.text = json.loads(data[20:20 + json_size])
        start = 28 + json_size
        bytes_size, bytes_type = struct.unpack("<I4s", data[start - 8:start])
        assert (bytes_type, start + bytes_size) == (b"BIN\0", len(data)) and bytes_size % 4 == 0
        assert self.text["buffers"] == [{"byteLength": bytes_size}]
        self.bytes = data[start:]
        assert self.text["asset"]["version"] == "2.0"

    def numbers(self, index):
        """Of an accessor, in rows of three."""
        accessor = self.text["accessors"][index]
        view = self.text["bufferViews"][accessor["bufferView"]]
        is_vector = accessor["type"] == "VEC3"
        kind = {5126: "<f4", 5125: "<u4"}[accessor["componentType"]]
        assert view["target"] == (34962 if is_vector else 34963)
        count = accessor["count"] * (3 if is_vector else 1)
        assert accessor["byteOffset"] + 4 * count <= view["byteLength"]
        start = view["byteOffset"] + accessor["byteOffset"]
        assert start % 4 == 0 and view["byteOffset"] + view["byteLength"] <= len(self.bytes)
        rows = np.frombuffer(self.bytes, kind, count, start).reshape(-1, 3)
        if "min" in accessor:
            np.testing.assert_array_equal(rows.min(0), np.array(accessor["min"], "f4"))
            np.testing.assert_array_equal(rows.max(0), np.array(accessor["max"], "f4"))
        return rows

    def nodes(self):
        """{name: (node, mesh)} of those that show something, all below the first node."""
        root, *others = self.text["nodes"]
        assert self.text["scenes"][self.text["scene"]]["nodes"] == [0]
        assert root["children"] == list(range(1, 1 + len(others)))
        return {node["name"]: (node, self.text["meshes"][node["mesh"]]) for node in others}

    def parts(self, mesh):
        """For each primitive: points where the volume is, normals, triangles, material."""
        root = self.text["nodes"][0]
        x, y, z = root["translation"]
        for part in mesh["primitives"]:
            points = self.numbers(part["attributes"]["POSITION"]) + np.array([x, -z, y])
            yield (points, self.numbers(part["attributes"]["NORMAL"]),
                   self.numbers(part["indices"]), self.text["materials"][part["material"]])


class ScenesTest(LabelsTest):
    def colored_names(self):
        lines = [f"{label},{NAMES.get(label, '')},#" + "".join(f"{c:02x}" for c in color)
                 for label, color in COLORS.items()]
        return self.write_bytes("n.csv", ("label,name,color\n" + "\n".join(lines)).encode())

    def scene(self, name):
        return Scene(self.content(name))


class GlbTest(ScenesTest):
    def test_a_node_for_each_label(self):
        volume, names = self.map_file(), self.colored_names()
        self.run_command(volume, self.path("a.glb"), self.path("a/"), "--labels", "all",
                      "--label-names", names)
        scene = self.scene("a.glb")
        self.assertEqual(list(scene.nodes()), ["Label -3", "liver", "Left lung", "spleen/x"])
        for name, (node, mesh) in scene.nodes().items():
            label, = node["extras"]["labels"]
            self.assertEqual((mesh["name"], node["extras"]["stop_reason"]), (name, "converged"))
            file = {"liver": "liver", "Left lung": "Left_lung", "spleen/x": "spleen_x",
                    "Label -3": "label--3"}[name]
            surface = read(self.path(f"a/{file}.vtp"))
            (points, normals, triangles, material), = scene.parts(mesh)
            np.testing.assert_allclose(points, points_of(surface), atol=2e-6)
            np.testing.assert_array_equal(triangles, triangles_of(surface))
            np.testing.assert_array_equal(normals,
                                          vtk_to_numpy(surface.GetPointData().GetNormals()))
            np.testing.assert_allclose(np.linalg.norm(normals, axis=1), 1, atol=1e-5)
            self.assertGreater(enclosed(points, triangles), 0)
            self.assertEqual(material["name"], name)
            color = material["pbrMetallicRoughness"]["baseColorFactor"]
            np.testing.assert_allclose(color, [*linear(COLORS[label]), 1], atol=1e-9)

    def test_vtk_reads_it(self):
        self.run_command(self.map_file(), self.path("a.glb"), "--labels", "all")
        blocks = read(self.path("a.glb"), vtkGLTFReader())
        iterator = blocks.NewIterator()
        bounds = []
        while not iterator.IsDoneWithTraversal():
            bounds.append(iterator.GetCurrentDataObject().GetBounds())
            iterator.GoToNextItem()
        self.assertEqual(len(bounds), 4)
        for label, (x0, x1, y0, y1, z0, z1) in zip((-3, 1, 2, 7), bounds):
            # z upwards is y of glTF, and y is -z.
            np.testing.assert_allclose((x0, x1, -z1, -z0, y0, y1), self.bounds_of(label), atol=.75)

    def test_names(self):
        names = {1: "same", 2: "same", 7: 'a/"b"\\\u00e9\u809d', -3: ""}
        file = self.write_bytes("n.json", json.dumps(names).encode())
        self.run_command(self.map_file(), self.path("a.glb"), "--labels", "all", "--label-names", file)
        told = [node.get("name") for node in self.scene("a.glb").text["nodes"]]
        self.assertEqual(told, [None, "Label -3", "same", "same", names[7]])

    def test_one_surface(self):
        self.run_command(self.map_file(), self.path("o"), "--labels", "1", "--format", "glb",
                      "--label-names", self.names_file())
        self.assertEqual(os.listdir(self.path("o")), ["liver.glb"])
        self.assertEqual(list(self.scene("o/liver.glb").nodes()), ["liver"])
        self.run_command(self.ball_file(), self.path("b.glb"), self.path("b.vtp"), "--iso", ISO)
        scene = self.scene("b.glb")
        (node, mesh), = scene.nodes().values()
        self.assertEqual((node["name"], node["extras"]["labels"]), ("surface", []))
        (points, _, triangles, material), = scene.parts(mesh)
        surface = read(self.path("b.vtp"))
        np.testing.assert_allclose(points, points_of(surface), atol=2e-6)
        np.testing.assert_array_equal(triangles, triangles_of(surface))
        np.testing.assert_allclose(material["pbrMetallicRoughness"]["baseColorFactor"],
                                   [*linear((204, 204, 204)), 1])


class ThreeMfTest(ScenesTest):
    XML = {"m": "http://schemas.microsoft.com/3dmanufacturing/core/2015/02"}

    def model(self, name):
        """The root of the model, and of its only object the name, points, triangles, and for each
        triangle the name and the colour of its material."""
        with zipfile.ZipFile(self.path(name)) as file:
            self.assertIsNone(file.testzip())
            for part in file.namelist():
                ElementTree.fromstring(file.read(part))
            root = ElementTree.fromstring(file.read("3D/3dmodel.model"))
        thing, = root.findall("m:resources/m:object", self.XML)
        item, = root.findall("m:build/m:item", self.XML)
        self.assertEqual(item.get("objectid"), thing.get("id"))
        points = [[float(v.get(axis)) for axis in "xyz"]
                  for v in thing.iterfind(".//m:vertex", self.XML)]
        triangles = list(thing.iterfind(".//m:triangle", self.XML))
        corners = [[int(t.get(v)) for v in ("v1", "v2", "v3")] for t in triangles]
        bases = [(base.get("name"), base.get("displaycolor")) for base in root.findall(
            f"m:resources/m:basematerials[@id='{thing.get('pid')}']/m:base", self.XML)]
        used = [bases[int(t.get("p1", thing.get("pindex")))] for t in triangles]
        return root, thing.get("name"), np.array(points, "f4"), np.array(corners), used

    def parts(self, name):
        """The name and the triangles of each part, as PrusaSlicer has them."""
        with zipfile.ZipFile(self.path(name)) as file:
            root = ElementTree.fromstring(file.read("Metadata/Slic3r_PE_model.config"))
        return [(part.find("metadata[@key='name']").get("value"),
                 slice(int(part.get("firstid")), int(part.get("lastid")) + 1))
                for part in root.iter("volume")]

    def test_one_object_whose_parts_are_the_labels(self):
        self.run_command(self.map_file(), self.path("a.3mf"), self.path("a/"), "--labels", "all",
                      "--label-names", self.colored_names())
        root, name, points, corners, used = self.model("a.3mf")
        self.assertEqual((root.get("unit"), name), ("millimeter", "labels"))
        parts = self.parts("a.3mf")
        self.assertEqual([part for part, _ in parts], ["Label -3", "liver", "Left lung", "spleen/x"])
        first = 0
        for (part, which), file, label in zip(
                parts, ("label--3", "liver", "Left_lung", "spleen_x"), (-3, 1, 2, 7)):
            surface = read(self.path(f"a/{file}.vtp"))
            count = surface.GetNumberOfPoints()
            np.testing.assert_array_equal(points[first:first + count],
                                          points_of(surface).astype("f4"))
            np.testing.assert_array_equal(corners[which] - first, triangles_of(surface))
            self.assertEqual(set(used[which]), {(part, "#%02X%02X%02X" % COLORS[label])})
            first += count
        self.assertEqual((first, parts[-1][1].stop), (len(points), len(corners)))

    def test_merged_labels_keep_their_colours(self):
        self.run_command(self.map_file(), self.path("a.3mf"), "--labels", "1,2", "--merge",
                      "--label-names", self.colored_names())
        self.assertEqual(set(self.model("a.3mf")[4]),
                         {("liver", "#C81E00"), ("Left lung", "#00FF78")})

    def test_names_units_and_one_surface(self):
        names = self.write_bytes("n.json", json.dumps({1: 'a<"&\u00e9>\n'}).encode())
        self.run_command(self.map_file(), self.path("a.3mf"), "--labels", "1", "--label-names", names)
        self.assertEqual(self.model("a.3mf")[1], 'a<"&\u00e9>')
        first = self.content("a.3mf")
        self.run_command(self.map_file(), self.path("a.3mf"), "--labels", "1", "--label-names", names)
        self.assertEqual(self.content("a.3mf"), first)
        self.run_command(self.ball_file(), self.path("b.3mf"), "--iso", ISO)
        self.assertEqual(self.model("b.3mf")[1], "surface")
        volume = self.write_bytes("u.nrrd", nrrd_header().replace(
            b"space: left-posterior-superior", b'space: left-posterior-superior\nspace units: "um" "um" "um"')
            + b"\n" + ball().tobytes())
        self.run_command(volume, self.path("u.3mf"), "--iso", ISO)
        self.assertEqual(self.model("u.3mf")[0].get("unit"), "micron")
        self.refused(r"u.3mf: 3MF has no unit nm; --unit mm converts", volume, self.path("u.3mf"),
                     "--iso", ISO, "--unit", "nm")

    def test_what_a_printer_asks(self):
        said = self.run_command(self.map_file(), self.path("a.3mf"), "--labels", "all").stderr
        low, high = np.transpose([np.reshape(self.bounds_of(label), (3, 2)) for label in BLOBS],
                                 (2, 0, 1))
        size = re.search(r"the print is (\S+) x (\S+) x (\S+) mm; --thin-parts measures", said)
        np.testing.assert_allclose([float(n) for n in size.groups()],
                                   high.max(0) - low.min(0), atol=1.5)
        said = self.run_command(self.ball_file(), self.path("b.3mf"), self.path("b.vtp"), "--iso", ISO,
                             "--thin-parts").stderr
        walls = vtk_to_numpy(read(self.path("b.vtp")).GetPointData().GetArray("Thickness"))
        self.assertAlmostEqual(float(re.search("thinnest wall has (.*)$", said, re.M).group(1)),
                               walls.min(), delta=2e-3 * walls.min())
        self.assertNotIn("the print", self.run_command(self.map_file(), self.path("a.glb"), "--labels",
                                                    "all").stderr)

    @unittest.skipUnless(shutil.which("assimp"), "Assimp is not installed")
    def test_assimp_reads_it(self):
        self.run_command(self.map_file(), self.path("a.3mf"), "--labels", "all")
        said = subprocess.run(["assimp", "info", self.path("a.3mf")], capture_output=True, text=True,
                              check=True).stdout
        self.assertRegex(said, rf"Faces: +{len(self.model('a.3mf')[3])}\n")

    @unittest.skipUnless(shutil.which("prusa-slicer"), "PrusaSlicer is not installed")
    def test_labels_that_touch_are_sliced_together(self):
        """Where they are: labels that are objects of their own would be moved apart, and fail
        where the lowest layer of one is too small."""
        self.run_command(self.map_file(), self.path("a.3mf"), "--labels", "all")
        subprocess.run(["prusa-slicer", "--export-gcode", self.path("a.3mf"), "--gcode-label-objects",
                        "--output", self.path("a.gcode")], capture_output=True, check=True,
                       env={**os.environ, "HOME": self.folder})
        code = self.content("a.gcode").decode()
        self.assertEqual(set(re.findall("; printing object (.*?) id:", code)), {"labels"})
        heights = [float(z) for z in re.findall(r"(?m)^;Z:([0-9.]+)", code)]
        points = self.model("a.3mf")[2]
        self.assertAlmostEqual(max(heights), np.ptp(points[:, 2]), delta=0.5)

class PlyTest(ScenesTest):
    def test_vertices_have_the_colour_of_their_label(self):
        self.run_command(self.map_file(), self.path("o"), "--labels", "all", "--format", "ply",
                      "--label-names", self.colored_names())
        self.run_command(self.map_file(), self.path("p"), "--labels", "all", "--label-names",
                      self.colored_names())
        for file, label in (("liver", 1), ("Left_lung", 2), ("spleen_x", 7), ("label--3", -3)):
            surface = read(self.path(f"o/{file}.ply"))
            colors = vtk_to_numpy(surface.GetPointData().GetArray("RGB"))
            self.assertEqual(len(colors), surface.GetNumberOfPoints())
            self.assertEqual({tuple(color) for color in colors}, {COLORS[label]})
            same = read(self.path(f"p/{file}.vtp"))
            np.testing.assert_array_equal(points_of(surface), points_of(same).astype("f4"))
            np.testing.assert_array_equal(triangles_of(surface), triangles_of(same))


if __name__ == "__main__":
    unittest.main()
