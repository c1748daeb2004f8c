# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Tests of colours and names in .ply, .glb and .3mf, read by other programs."""

import json
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
from vtkmodules.vtkIOXML import vtkXMLImageDataWriter

from test_labels import BLOBS, NAMES, LabelsTest
from command_test_case import ISO, ball, make_image, nrrd_header
from vtk_files import points_of, read, triangles_of

COLORS = {-3: (255, 255, 255), 1: (200, 30, 0), 2: (0, 255, 120), 7: (10, 20, 30)}
FILES = {"Label -3": "label--3", "liver": "liver", "Left lung": "Left_lung", "spleen/x": "spleen_x"}
XML = {"m": "http://schemas.microsoft.com/3dmanufacturing/core/2015/02"}


def linear(color):
    share = np.array(color) / 255
    return np.where(share <= 0.04045, share / 12.92, ((share + 0.055) / 1.055) ** 2.4)


class ScenesTest(LabelsTest):
    def colored_names(self):
        lines = [f"{label},{NAMES.get(label, '')},#" + "".join(f"{c:02x}" for c in color)
                 for label, color in COLORS.items()]
        return self.write_bytes("n.csv", ("label,name,color\n" + "\n".join(lines)).encode())

    def glb(self, name):
        """Return the nodes below the root, their base colours, and their surfaces read by VTK."""
        data = self.content(name)
        magic, version, size, json_size, _ = struct.unpack("<4sIII4s", data[:20])
        self.assertEqual((magic, version, size), (b"glTF", 2, len(data)))
        text = json.loads(data[20:20 + json_size])
        root, *nodes = text["nodes"]
        self.assertEqual(root["children"], list(range(1, 1 + len(nodes))))
        parts = [text["meshes"][node["mesh"]]["primitives"] for node in nodes]
        colors = [text["materials"][part["material"]]["pbrMetallicRoughness"]["baseColorFactor"]
                  for part, in parts]
        blocks, surfaces = read(self.path(name), vtkGLTFReader()), []
        iterator = blocks.NewIterator()
        while not iterator.IsDoneWithTraversal():
            surfaces.append(iterator.GetCurrentDataObject())
            iterator.GoToNextItem()
        return nodes, colors, surfaces

    def three_mf(self, name):
        """Return the model root, the object name, points, triangles, material name and colour of
        each triangle, and names and triangles of PrusaSlicer's parts."""
        with zipfile.ZipFile(self.path(name)) as file:
            self.assertIsNone(file.testzip())
            trees = {part: ElementTree.fromstring(file.read(part)) for part in file.namelist()}
        root = trees["3D/3dmodel.model"]
        thing, = root.findall("m:resources/m:object", XML)
        item, = root.findall("m:build/m:item", XML)
        self.assertEqual(item.get("objectid"), thing.get("id"))
        points = [[float(vertex.get(axis)) for axis in "xyz"]
                  for vertex in thing.iterfind(".//m:vertex", XML)]
        triangles = list(thing.iterfind(".//m:triangle", XML))
        corners = [[int(t.get(v)) for v in ("v1", "v2", "v3")] for t in triangles]
        bases = [(base.get("name"), base.get("displaycolor")) for base in root.findall(
            f"m:resources/m:basematerials[@id='{thing.get('pid')}']/m:base", XML)]
        used = [bases[int(t.get("p1", thing.get("pindex")))] for t in triangles]
        parts = [(part.find("metadata[@key='name']").get("value"),
                  slice(int(part.get("firstid")), int(part.get("lastid")) + 1))
                 for part in trees.get("Metadata/Slic3r_PE_model.config", root).iter("volume")]
        return root, thing.get("name"), np.array(points, "f4"), np.array(corners), used, parts

    def test_labels(self):
        options = ("--labels", "all", "--label-names", self.colored_names())
        self.run_command(self.map_file(), self.path("a.glb"), self.path("a.3mf"), self.path("a/"),
                         *options)
        self.run_command(self.map_file(), self.path("o"), "--format", "ply", *options)
        nodes, colors, surfaces = self.glb("a.glb")
        self.assertEqual([node["name"] for node in nodes], list(FILES))
        root, name, points, corners, used, parts = self.three_mf("a.3mf")
        self.assertEqual((root.get("unit"), name), ("millimeter", "labels"))
        self.assertEqual([part for part, _ in parts], list(FILES))
        first = 0
        for i, (label, (name, file)) in enumerate(zip(COLORS, FILES.items())):
            surface, ply = read(self.path(f"a/{file}.vtp")), read(self.path(f"o/{file}.ply"))
            coordinates, triangles = points_of(surface).astype("f4"), triangles_of(surface)
            self.assertEqual(nodes[i]["extras"], {"labels": [label], "stop_reason": "converged"})
            np.testing.assert_allclose(colors[i], [*linear(COLORS[label]), 1], atol=1e-9)
            # z is y in glTF, y is -z.
            np.testing.assert_allclose(points_of(surfaces[i])[:, [0, 2, 1]] * (1, -1, 1), coordinates,
                                       atol=1e-5)
            np.testing.assert_array_equal(triangles_of(surfaces[i]), triangles)
            which = parts[i][1]
            np.testing.assert_array_equal(points[first:first + len(coordinates)], coordinates)
            np.testing.assert_array_equal(corners[which] - first, triangles)
            self.assertEqual(set(used[which]), {(name, "#%02X%02X%02X" % COLORS[label])})
            first += len(coordinates)
            np.testing.assert_array_equal(points_of(ply), coordinates)
            np.testing.assert_array_equal(triangles_of(ply), triangles)
            rgb = vtk_to_numpy(ply.GetPointData().GetArray("RGB"))
            self.assertEqual({tuple(color) for color in rgb}, {COLORS[label]})
        self.assertEqual((first, parts[-1][1].stop), (len(points), len(corners)))

    def test_names(self):
        names = {1: "same", 2: "same", 7: 'a/"b"\\\u00e9\u809d', -3: 'a<"&\u00e9>\n'}
        file = self.write_bytes("n.json", json.dumps(names).encode())
        options = ("--labels", "all", "--label-names", file)
        self.run_command(self.map_file(), self.path("a.glb"), self.path("a.3mf"), *options)
        expected = ['a<"&\u00e9>', "same", "same", names[7]]
        self.assertEqual([node["name"] for node in self.glb("a.glb")[0]], expected)
        self.assertEqual([name for name, _ in self.three_mf("a.3mf")[5]], expected)
        first = self.content("a.3mf")
        self.run_command(self.map_file(), self.path("a.3mf"), *options)
        self.assertEqual(self.content("a.3mf"), first)
        self.run_command(self.map_file(), self.path("a.3mf"), "--labels", "1,2", "--merge",
                         "--label-names", self.colored_names())
        self.assertEqual(set(self.three_mf("a.3mf")[4]),
                         {("liver", "#C81E00"), ("Left lung", "#00FF78")})

    def test_one_surface(self):
        self.run_command(self.map_file(), self.path("o"), "--labels", "1", "--format", "glb",
                         "--label-names", self.names_file())
        self.assertEqual(self.glb("o/liver.glb")[0][0]["name"], "liver")
        header = nrrd_header().replace(b"encoding", b'space units: "um" "um" "um"\nencoding')
        volume = self.write_bytes("u.nrrd", header + b"\n" + ball().tobytes())
        self.run_command(volume, self.path("b.glb"), self.path("b.3mf"), "--iso", ISO)
        (node,), (color,), _ = self.glb("b.glb")
        self.assertEqual((node["name"], node["extras"]["labels"]), ("surface", []))
        np.testing.assert_allclose(color, [*linear((204, 204, 204)), 1])
        root, name, *_ = self.three_mf("b.3mf")
        self.assertEqual((name, root.get("unit")), ("surface", "micron"))
        self.rejects(r"u.3mf: 3MF does not support the unit nm", volume, self.path("u.3mf"),
                     "--iso", ISO, "--unit", "nm")

    def test_units_and_size_for_printing(self):
        printed = self.run_command(self.map_file(), self.path("a.3mf"), "--labels", "all").stderr
        low, high = np.transpose([np.reshape(self.bounds_of(label), (3, 2)) for label in BLOBS],
                                 (2, 0, 1))
        size = re.search(r"size of the print: (\S+) x (\S+) x (\S+) mm\n", printed)
        np.testing.assert_allclose([float(n) for n in size.groups()],
                                   high.max(0) - low.min(0), atol=1.5)
        z, y, x = abs(np.mgrid[:36, :36, :40] - np.reshape([16.6, 17, 20], (3, 1, 1, 1)))
        plate = make_image(np.min([.5 - z, 12 - y, 14 - x], axis=0).astype("f4"), (1, 1, 1))
        volume = self.write(vtkXMLImageDataWriter(), "p.vti", plate)
        printed = self.run_command(volume, self.path("b.3mf"), "--iso", 0, "--thin-parts").stderr
        self.assertAlmostEqual(float(re.search("walls and gaps (.*)$", printed, re.M).group(1)), .57,
                               delta=.06)

    @unittest.skipUnless(shutil.which("assimp"), "Assimp is not installed")
    def test_assimp(self):
        self.run_command(self.map_file(), self.path("a.3mf"), "--labels", "all")
        printed = subprocess.run(["assimp", "info", self.path("a.3mf")], capture_output=True,
                                 text=True, check=True, errors="replace").stdout
        self.assertRegex(printed, rf"Faces: +{len(self.three_mf('a.3mf')[3])}\n")
