# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The writer behind Export Surfaces: a file for each label, level or component."""

import os
import shutil

import numpy
from paraview import servermanager
from paraview import simple
from vtkmodules.vtkIOGeometry import vtkSTLReader
from vtkmodules.vtkIOPLY import vtkPLYReader

import label_maps
import plugin_testing as testing

READERS = {".stl": vtkSTLReader, ".ply": vtkPLYReader}


def triangles_in(path):
    reader = READERS[os.path.splitext(path)[1]]()
    reader.SetFileName(path)
    reader.Update()
    return reader.GetOutput().GetNumberOfPolys()


class ExportTest(testing.PluginTestCase):
    def setUp(self):
        self.folder = testing.output_path("exported")
        shutil.rmtree(self.folder, ignore_errors=True)
        os.mkdir(self.folder)

    def export(self, name, source):
        """Return {name: triangles} of the files."""
        servermanager.writers.ExportSurfaces(
            Input=source, FileName=os.path.join(self.folder, name)).UpdatePipeline()
        return {file: triangles_in(os.path.join(self.folder, file))
                for file in sorted(os.listdir(self.folder))}

    def labels(self):
        image = label_maps.add_names(label_maps.image())
        return simple.LabelstoSurfaces(testing.produce(image), FinestLevel=1)

    def test_interfaces_for_tetrahedral_meshers(self):
        path = os.path.join(self.folder, "organs.msh")
        servermanager.writers.ExportSurfaces(
            Input=servermanager.OutputPort(self.labels(), 1), FileName=path).UpdatePipeline()
        with open(path, encoding="utf-8") as file:
            text = file.read()
        for name in label_maps.NAMES.values():
            self.assertRegex(text, f'\n3 \\d+ "{name}"\n')

    def test_a_file_for_each_label(self):
        source = self.labels()
        blocks = testing.fetch(source)
        expected = {f"organs-{name.replace(' ', '_')}": blocks.GetBlock(i).GetNumberOfPolys()
                    for i, name in enumerate(label_maps.NAMES.values())}
        for suffix in READERS:
            with self.subTest(suffix=suffix):
                self.setUp()
                self.assertEqual(self.export("organs" + suffix, source),
                                 {name + suffix: count for name, count in expected.items()})

    def test_a_component_has_its_cavities(self):
        """A hollow ball, a ball in its cavity and a ball elsewhere are three files."""
        z, y, x = numpy.mgrid[0:32, 0:32, 0:32]
        far = numpy.sqrt((x - 12.0)**2 + (y - 15.0)**2 + (z - 15.0)**2)
        beside = numpy.sqrt((x - 27.0)**2 + (y - 15.0)**2 + (z - 15.0)**2)
        field = numpy.maximum.reduce([numpy.minimum(10 - far, far - 7), 4 - far, 3 - beside])
        source = simple.VolumetoSurface(testing.produce(testing.make_image(field)), IsoValue=0.0,
                                        Recovery=2, MinimumPartSize=2)
        surface = testing.fetch(source)
        array = surface.GetCellData().GetArray("Component")
        found = [int(array.GetValue(i)) for i in range(array.GetNumberOfTuples())]
        self.assertEqual(set(found), {0, 1, 2, 3})
        volumes, owners = (surface.GetFieldData().GetArray(name)
                           for name in ("ComponentVolume", "ComponentOwner"))
        self.assertLess(volumes.GetValue(1), 0)
        self.assertEqual([owners.GetValue(i) for i in range(4)], [0, 0, 2, 3])
        expected = {"w-component-0.stl": found.count(0) + found.count(1),
                    "w-component-2.stl": found.count(2), "w-component-3.stl": found.count(3)}
        self.assertEqual(self.export("w.stl", source), expected)
        # Half of the surface, too.
        self.setUp()
        clip = simple.Clip(source, ClipType="Plane", Scalars=["POINTS", ""])
        clip.ClipType.Origin, clip.ClipType.Normal = (12, 15, 15), (0, 0, 1)
        self.assertEqual(list(self.export("w.stl", clip)), list(expected))

    def test_outputs_of_clip_and_threshold(self):
        source = self.labels()
        clip = simple.Clip(source, ClipType="Plane", Scalars=["POINTS", ""])
        clip.ClipType.Origin, clip.ClipType.Normal = (14, 16, 16), (1, 0, 0)
        whole = self.export("w.stl", source)
        self.setUp()
        found = self.export("w.stl", clip)
        self.assertEqual(list(found), ["w-liver.stl", "w-spleen.stl"])
        self.assertLess(found["w-spleen.stl"], whole["w-spleen.stl"])
        surface = simple.VolumetoSurface(testing.produce(label_maps.image()), IsoValue=1.5)
        threshold = simple.Threshold(surface, Scalars=["CELLS", "Component"], LowerThreshold=1,
                                     UpperThreshold=1)
        count = testing.fetch(threshold).GetNumberOfCells()
        self.setUp()
        self.assertEqual(self.export("one.ply", threshold), {"one.ply": count})
        self.assertGreater(count, 0)

    def test_empty_surface_is_an_error(self):
        threshold = simple.Threshold(self.labels(), Scalars=["POINTS", "Residual"],
                                     LowerThreshold=1e9, UpperThreshold=2e9)
        with testing.CapturedMessages() as messages:
            self.assertEqual(self.export("w.stl", threshold), {})
        self.assertIn("w.stl: not written, because there are no triangles", messages.text)
