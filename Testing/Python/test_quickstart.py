# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Examples/Python/quickstart.py on a small volume: every file it promises is there and readable."""

import csv
import json
import os
import sys
import tempfile
import unittest

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkFiltersCore import vtkFeatureEdges
from vtkmodules.vtkIOImage import vtkPNGReader
from vtkmodules.vtkIOXML import (
    vtkXMLImageDataReader, vtkXMLMultiBlockDataReader, vtkXMLPolyDataReader)

from examples_path import EXAMPLES
from sample_volumes import (
    MAJOR, MINOR, RING_SIZE, RING_SPACING, RING_VOLUME, ring_voxels, run_script, write_volume)

sys.path.insert(0, EXAMPLES)
# pylint: disable=wrong-import-position
from quickstart import name_of_volume


class QuickstartTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.temporary.cleanup)
        cls.output = os.path.join(cls.temporary.name, "a", "results")
        cls.volume = write_volume(os.path.join(cls.temporary.name, "ring.mha"), ring_voxels(),
                                  RING_SPACING)
        cls.run_of_it = run_script("quickstart.py", "--output", cls.output, "--", cls.volume)

    def path(self, name):
        return os.path.join(self.output, name)

    def test_it_succeeds_and_names_what_it_wrote(self):
        self.assertEqual(self.run_of_it.returncode, 0, self.run_of_it.stderr)
        self.assertEqual(self.run_of_it.stderr, "")
        for name in ("volume.vti", "pyramid.vtm", "pyramid.png", "levels.vtm", "levels.png", "surface.vtp",
                     "surface-views.png", "history.csv", "history.png", "report.json"):
            self.assertIn(self.path(name), self.run_of_it.stdout)
            self.assertTrue(os.path.getsize(self.path(name)) > 0, name)
        self.assertIn("Otsu", self.run_of_it.stdout)

    def test_the_volume_is_there_for_paraview(self):
        reader = vtkXMLImageDataReader()
        reader.SetFileName(self.path("volume.vti"))
        reader.Update()
        image = reader.GetOutput()
        self.assertEqual(image.GetDimensions(), (RING_SIZE,) * 3)
        np.testing.assert_allclose(image.GetSpacing(), RING_SPACING)
        voxels = vtk_to_numpy(image.GetPointData().GetScalars())
        np.testing.assert_array_equal(voxels, ring_voxels().ravel())

    def test_names_of_the_volume(self):
        names = {"/a/Cranium.inv3": "skull.vti", "scan.nii.gz": "volume.vti", "series": "volume.vti",
                 "skull.vti": None, "SCAN.VTI": None}
        for path, name in names.items():
            self.assertEqual(name_of_volume(path), name)

    def test_the_pyramid_can_be_read_again(self):
        reader = vtkXMLMultiBlockDataReader()
        reader.SetFileName(self.path("pyramid.vtm"))
        reader.Update()
        sizes = [reader.GetOutput().GetBlock(h).GetDimensions()
                 for h in range(reader.GetOutput().GetNumberOfBlocks())]
        self.assertEqual(sizes, [(40,) * 3, (23,) * 3, (13,) * 3])

    def test_the_surfaces_can_be_read_again(self):
        reader = vtkXMLMultiBlockDataReader()
        reader.SetFileName(self.path("levels.vtm"))
        reader.Update()
        blocks = [reader.GetOutput().GetBlock(h) for h in range(3)]
        counts = [block.GetNumberOfPoints() for block in blocks]
        self.assertEqual(counts, sorted(counts, reverse=True))
        finest = self.read_surface()
        self.assertEqual(finest.GetNumberOfPoints(), counts[0])
        self.assertEqual(finest.GetPointData().GetNormals().GetName(), "Normals")

    def test_the_surface_is_a_closed_ring_in_world_coordinates(self):
        edges = vtkFeatureEdges()
        edges.SetInputData(self.read_surface())
        edges.FeatureEdgesOff()
        edges.ManifoldEdgesOff()
        edges.Update()
        self.assertEqual(edges.GetOutput().GetNumberOfCells(), 0)
        middle = (RING_SIZE - 1) / 2 * np.array(RING_SPACING)
        low, high = np.reshape(self.read_surface().GetBounds(), (3, 2)).T
        np.testing.assert_allclose((low + high) / 2, middle, atol=0.5)
        outer = MAJOR + MINOR
        size = 2 * np.array([outer, outer, MINOR * RING_SPACING[2]])
        np.testing.assert_allclose(high - low, size, atol=1.5)

    def test_the_report_tells_the_shape(self):
        with open(self.path("report.json"), encoding="utf-8") as file:
            report = json.load(file)
        self.assertEqual((report["components"], report["genus"]), (1, 1))
        self.assertEqual(report["vertices"], self.read_surface().GetNumberOfPoints())
        self.assertAlmostEqual(report["volume"] / RING_VOLUME, 1, delta=0.1)
        self.assertEqual([level["level"] for level in report["levels"]], [2, 1, 0])
        for level in report["levels"]:
            self.assertGreater(level["seconds"], 0)
            self.assertGreater(level["iterations"], 0)
        # All of the run but the look at its inputs and the handing over: no threshold of time.
        seconds = sum(level["seconds"] for level in report["levels"])
        self.assertLessEqual(seconds, report["seconds"]["surface"])
        self.assertEqual(report["warnings"], [])

    def test_the_history_has_a_line_per_iteration(self):
        with open(self.path("history.csv"), encoding="utf-8", newline="") as file:
            rows = list(csv.DictReader(file))
        with open(self.path("report.json"), encoding="utf-8") as file:
            iterations = sum(level["iterations"] for level in json.load(file)["levels"])
        self.assertEqual(len(rows), iterations)
        with open(self.path("report.json"), encoding="utf-8") as file:
            for level in json.load(file)["levels"]:
                own = [row for row in rows if int(row["Level"]) == level["level"]]
                seconds = sum(float(row[name]) for row in own
                              for name in ("SecondsBefore", "Seconds", "SecondsAfter"))
                self.assertAlmostEqual(seconds / level["seconds"], 1, 3)
        for name in ("Level", "KineticEnergy", "Seconds"):
            self.assertTrue(all(float(row[name]) >= 0 for row in rows), name)
        for name in ("Iteration", "Vertices", "MeanEdgeLength"):
            self.assertTrue(all(float(row[name]) > 0 for row in rows), name)

    def test_the_pictures_show_something(self):
        self.check_picture("pyramid.png", least_width=1200)
        self.check_picture("levels.png", least_width=1200)
        self.check_picture("history.png", least_width=1400)
        self.check_picture("surface-views.png", least_width=1400)

    def read_surface(self):
        reader = vtkXMLPolyDataReader()
        reader.SetFileName(self.path("surface.vtp"))
        reader.Update()
        return reader.GetOutput()

    def check_picture(self, name, least_width):
        reader = vtkPNGReader()
        reader.SetFileName(self.path(name))
        reader.Update()
        self.assertGreaterEqual(reader.GetOutput().GetDimensions()[0], least_width)
        pixels = vtk_to_numpy(reader.GetOutput().GetPointData().GetScalars())
        self.assertGreater(pixels.std(), 12)


class RefusedTest(unittest.TestCase):
    def refused(self, reason, *arguments):
        with tempfile.TemporaryDirectory() as folder:
            run = run_script("quickstart.py", "--output", folder, *arguments)
        self.assertNotEqual(run.returncode, 0)
        self.assertIn(reason, run.stderr)
        self.assertNotIn("Traceback", run.stderr)

    def test_missing_volume(self):
        self.refused("no such file", "nowhere.mha")

    def test_volume_without_a_surface(self):
        with tempfile.TemporaryDirectory() as folder:
            path = write_volume(os.path.join(folder, "flat.mha"), np.full((20, 20, 20), 3, "u1"))
            self.refused("no value separates", path)


if __name__ == "__main__":
    unittest.main()
