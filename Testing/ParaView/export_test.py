# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The writer behind Export Surfaces: a file for each label, level or component."""

import json
import os
import shutil
import struct
import sys

import numpy
from paraview import servermanager
from paraview import simple
from paraview.vtk.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
from vtkmodules.vtkCommonCore import vtkPoints, vtkStringArray
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkIOGeometry import vtkOBJReader, vtkSTLReader
from vtkmodules.vtkIOPLY import vtkPLYReader
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../Examples/Python"))
import label_maps
import plugin_testing as testing
from tetrahedra import blocks_of, sections_of

READERS = {".stl": vtkSTLReader, ".ply": vtkPLYReader, ".obj": vtkOBJReader,
           ".vtp": vtkXMLPolyDataReader}


def triangles_in(path):
    reader = READERS[os.path.splitext(path)[1]]()
    reader.SetFileName(path)
    reader.Update()
    return reader.GetOutput().GetNumberOfPolys()


def named(array, name):
    array.SetName(name)
    return array


def faces_of_voxels(labels, random):
    """The faces between voxels of different labels, 0 outside, as interfaces: two triangles each,
    turned to either side."""
    labels = numpy.pad(labels, 1)
    corners, sides = [], []
    for axis in range(3):
        along, u, v = numpy.roll(numpy.eye(3, dtype=int), -axis, axis=0)
        count = labels.shape[axis] - 1
        low, high = (labels.take(range(i, i + count), axis) for i in (0, 1))
        for place in numpy.argwhere(low != high):
            square = place + along + numpy.array([0 * u, u, u + v, v])
            pair = [low[tuple(place)], high[tuple(place)]]
            if random.random() < 0.5:
                pair, square = pair[::-1], square[::-1]
            corners += [square[[0, 1, 2]], square[[0, 2, 3]]]
            sides += [pair, pair]
    points, numbers = numpy.unique(numpy.concatenate(corners), axis=0, return_inverse=True)
    surface, places, cells, names = vtkPolyData(), vtkPoints(), vtkCellArray(), vtkStringArray()
    places.SetData(numpy_to_vtk(points.astype(float), deep=True))
    cells.SetData(3, numpy_to_vtkIdTypeArray(numbers.ravel().astype(numpy.int64), deep=True))
    surface.SetPoints(places)
    surface.SetPolys(cells)
    surface.GetCellData().AddArray(
        named(numpy_to_vtk(numpy.array(sides, numpy.int32), deep=True), "BoundaryLabels"))
    known = numpy.unique(labels[labels > 0]).astype(numpy.int32)
    for label in known:
        names.InsertNextValue(f"L{label}")
    for array, name in ((numpy_to_vtk(known, deep=True), "Label"), (names, "LabelName"),
                        (numpy_to_vtk(numpy.zeros((len(known), 3)), deep=True), "LabelColor")):
        surface.GetFieldData().AddArray(named(array, name))
    return surface


def parts_of(labels):
    """[(label, voxels)] of those that are connected by faces, also of nothing, but the outermost."""
    labels = numpy.pad(labels, 1)
    free, found = set(map(tuple, numpy.argwhere(labels >= 0))), []
    while free:
        front = [min(free)]
        free.discard(front[0])
        label, size = labels[front[0]], 0
        while front:
            place = front.pop()
            size += 1
            for axis in range(3):
                for step in (-1, 1):
                    other = tuple(n + step * (i == axis) for i, n in enumerate(place))
                    if other in free and labels[other] == label:
                        free.discard(other)
                        front.append(other)
        found.append((int(label), size))
    return sorted(found[1:])


class ExportTest(testing.PluginTestCase):
    def setUp(self):
        self.folder = testing.output_path("exported")
        shutil.rmtree(self.folder, ignore_errors=True)
        os.mkdir(self.folder)

    def export(self, name, source, port=0):
        """{name: triangles} of the files that it makes."""
        writer = servermanager.writers.ExportSurfaces(
            Input=servermanager.OutputPort(source, port), FileName=os.path.join(self.folder, name))
        writer.UpdatePipeline()
        return {file: triangles_in(os.path.join(self.folder, file))
                for file in sorted(os.listdir(self.folder)) if not file.endswith(".glb")}

    def labels(self, **names):
        image = label_maps.add_names(label_maps.image(), **names)
        return simple.LabelstoSurfaces(testing.produce(image), FinestLevel=1)

    def test_interfaces_for_meshers_of_solids(self):
        source = self.labels()
        source.SharedInterfaces = 1
        interfaces = testing.fetch(source, 1)
        for suffix in ("msh", "smesh"):
            writer = servermanager.writers.ExportSurfaces(
                Input=servermanager.OutputPort(source, 1),
                FileName=os.path.join(self.folder, "organs." + suffix))
            writer.UpdatePipeline()
        with open(os.path.join(self.folder, "organs.msh"), encoding="utf-8") as file:
            text = file.read()
        for name in label_maps.NAMES.values():
            self.assertRegex(text, f'\n3 \\d+ "{name}"\n')
        with open(os.path.join(self.folder, "organs.smesh"), encoding="utf-8") as file:
            text = file.read()
        self.assertEqual(len([line for line in text.splitlines() if line.startswith("3 ")
                              and len(line.split()) == 5]), interfaces.GetNumberOfPolys())

    def test_regions_of_any_voxels(self):
        """That touch each other in edges and corners, with cavities and parts in them."""
        random = numpy.random.default_rng(5)
        cavities = 0
        for run in range(12):
            labels = random.integers(0, 3, (6, 5, 5)) * (random.random((6, 5, 5)) < 0.4 + 0.05 * run)
            source = testing.produce(faces_of_voxels(labels, random))
            path = os.path.join(self.folder, "voxels.")
            for suffix in ("msh", "smesh"):
                servermanager.writers.ExportSurfaces(
                    Input=source, FileName=path + suffix).UpdatePipeline()
            volumes = self.volumes_of(sections_of(path + "msh"))
            wanted = parts_of(labels)
            self.assertEqual(sorted(volumes), [part for part in wanted if part[0] > 0])
            with open(path + "smesh", encoding="utf-8") as file:
                rows = [line.split() for line in file if not line.startswith("#")]
            rows = rows[1 + int(rows[0][0]):]
            rows = rows[1 + int(rows[0][0]):]
            holes, regions = rows[1:1 + int(rows[0][0])], rows[2 + int(rows[0][0]):]
            told = [(int(row[4]) if len(row) > 4 else 0, tuple(map(float, row[1:4])))
                    for row in holes + regions]
            # Voxels are from their number to the next one, and one further by the margin.
            for label, place in told:
                voxel = tuple(int(n) for n in numpy.floor(place))
                self.assertEqual(numpy.pad(labels, 1)[voxel], label)
            self.assertEqual(sorted(label for label, _ in told), [label for label, _ in wanted])
            cavities += len(holes)
        self.assertGreater(cavities, 3)

    @staticmethod
    def volumes_of(sections):
        """[(label, volume)] of the volumes of a .msh, by the surfaces that bound them."""
        lines, points = sections["Nodes"], []
        for *_, count, at in blocks_of(lines):
            points += [line.split() for line in lines[at + count:at + 2 * count]]
        points = numpy.array(points, float)
        lines, below = sections["Elements"], {}
        for _, entity, _, count, at in blocks_of(lines):
            corners = points[numpy.array([row.split()[1:] for row in lines[at:at + count]], int) - 1]
            below[entity] = numpy.linalg.det(corners).sum() / 6
        rows = [line.split() for line in sections["Entities"]]
        return [(int(row[8]), int(round(sum(numpy.sign(int(face)) * below[abs(int(face))]
                                            for face in row[10:]))))
                for row in rows[1 + int(rows[0][2]):]]

    def test_a_file_for_each_label(self):
        source = self.labels()
        blocks = testing.fetch(source)
        wanted = {f"organs-{name.replace(' ', '_')}": blocks.GetBlock(i).GetNumberOfPolys()
                  for i, name in enumerate(label_maps.NAMES.values())}
        for suffix in READERS:
            with self.subTest(suffix=suffix):
                self.setUp()
                self.assertEqual(self.export("organs" + suffix, source),
                                 {name + suffix: count for name, count in wanted.items()})

    def test_names_that_files_cannot_have(self):
        source = self.labels(names={3: "a/b", 7: "A:b", 12: ".."})
        self.assertEqual(list(self.export("x.stl", source)), ["x-.stl", "x-A_b-2.stl", "x-a_b.stl"])

    def test_levels(self):
        source = simple.VolumetoSurface(simple.Wavelet(), IsoValue=150.0)
        blocks = testing.fetch(source, 1)
        self.assertEqual(self.export("w.vtp", source, 1), {
            f"w-Level_{i}.vtp": blocks.GetBlock(i).GetNumberOfPolys() for i in range(2)})

    def test_components(self):
        source = simple.VolumetoSurface(testing.produce(label_maps.image()), IsoValue=1.5)
        surface = testing.fetch(source)
        array = surface.GetCellData().GetArray("Component")
        found = [int(array.GetValue(i)) for i in range(array.GetNumberOfTuples())]
        self.assertGreater(max(found), 0)
        self.assertEqual(self.export("w.stl", source), {
            f"w-component-{i}.stl": found.count(i) for i in set(found)})

    def test_one_surface_is_one_file(self):
        source = simple.VolumetoSurface(simple.Wavelet(), IsoValue=150.0)
        self.assertEqual(self.export("w.ply", source),
                         {"w.ply": testing.fetch(source).GetNumberOfPolys()})

    def test_a_scene_with_names_and_colours(self):
        self.export("organs.glb", self.labels())
        self.assertEqual(os.listdir(self.folder), ["organs.glb"])
        with open(os.path.join(self.folder, "organs.glb"), "rb") as file:
            size = struct.unpack("<5I", file.read(20))[3]
            scene = json.loads(file.read(size))
        names = {mesh["name"] for mesh in scene["meshes"]}
        self.assertEqual(names, set(label_maps.NAMES.values()))
        self.assertEqual(len(scene["materials"]), 3)

    def test_a_folder_that_is_not_there(self):
        with testing.CapturedMessages() as messages:
            self.export("none/organs.stl", self.labels())
        self.assertIn("none/organs", messages.text)
