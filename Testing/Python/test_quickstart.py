# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Examples/Python/quickstart.py on a small volume: every file it promises is there and readable."""

import csv
import json
import os
import subprocess
import sys
import tempfile
import unittest

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkFiltersCore import vtkFeatureEdges
from vtkmodules.vtkIOImage import vtkMetaImageWriter, vtkPNGReader
from vtkmodules.vtkIOXML import vtkXMLMultiBlockDataReader, vtkXMLPolyDataReader

from examples_path import EXAMPLES

sys.path.insert(0, EXAMPLES)
from volume_image import make_image  # pylint: disable=wrong-import-position


RING_SIZE, SPACING = 40, (1, 1, 1.5)


def ring_volume():
    """A bright ring (a torus) in noise; index order z, y, x."""
    z, y, x = np.indices((RING_SIZE,) * 3) - (RING_SIZE - 1) / 2
    inside = (np.hypot(x, y) - 0.27 * RING_SIZE) ** 2 + z ** 2 < (0.12 * RING_SIZE) ** 2
    noise = np.random.default_rng(3).normal(0, 5, inside.shape)
    return (np.where(inside, 200, 50) + noise).astype("u1")


def run_quickstart(*arguments):
    return subprocess.run([sys.executable, os.path.join(EXAMPLES, "quickstart.py"), *arguments],
                          capture_output=True, text=True, check=False, timeout=240)


class QuickstartTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.temporary.cleanup)
        cls.volume = os.path.join(cls.temporary.name, "ring.mha")
        cls.output = os.path.join(cls.temporary.name, "a", "results")
        writer = vtkMetaImageWriter()
        writer.SetFileName(cls.volume)
        writer.SetInputData(make_image(ring_volume(), SPACING))
        writer.Write()
        cls.run_of_it = run_quickstart("--output", cls.output, "--", cls.volume)

    def path(self, name):
        return os.path.join(self.output, name)

    def test_it_succeeds_and_names_what_it_wrote(self):
        self.assertEqual(self.run_of_it.returncode, 0, self.run_of_it.stderr)
        self.assertEqual(self.run_of_it.stderr, "")
        for name in ("pyramid.vtm", "pyramid.png", "levels.vtm", "levels.png", "surface.vtp",
                     "surface-views.png", "history.csv", "history.png", "report.json"):
            self.assertIn(self.path(name), self.run_of_it.stdout)
            self.assertTrue(os.path.getsize(self.path(name)) > 0, name)
        self.assertIn("Otsu", self.run_of_it.stdout)

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
        middle = (RING_SIZE - 1) / 2 * np.array(SPACING)
        low, high = np.reshape(self.read_surface().GetBounds(), (3, 2)).T
        np.testing.assert_allclose((low + high) / 2, middle, atol=0.5)
        outer = (0.27 + 0.12) * RING_SIZE
        np.testing.assert_allclose(high - low, 2 * outer * np.array([1, 1, 0]) + np.array(
            [0, 0, 2 * 0.12 * RING_SIZE * SPACING[2]]), atol=1.5)

    def test_the_report_tells_the_shape(self):
        with open(self.path("report.json"), encoding="utf-8") as file:
            report = json.load(file)
        self.assertEqual((report["components"], report["genus"]), (1, 1))
        self.assertEqual(report["vertices"], self.read_surface().GetNumberOfPoints())
        volume = 2 * np.pi ** 2 * 0.27 * 0.12 ** 2 * RING_SIZE ** 3 * SPACING[2]
        self.assertAlmostEqual(report["volume"] / volume, 1, delta=0.1)
        self.assertEqual([level["level"] for level in report["levels"]], [2, 1, 0])
        for level in report["levels"]:
            self.assertGreater(level["seconds"], 0)
            self.assertGreater(level["iterations"], 0)
        self.assertEqual(report["warnings"], [])

    def test_the_history_has_a_line_per_iteration(self):
        with open(self.path("history.csv"), encoding="utf-8", newline="") as file:
            rows = list(csv.DictReader(file))
        with open(self.path("report.json"), encoding="utf-8") as file:
            iterations = sum(level["iterations"] for level in json.load(file)["levels"])
        self.assertEqual(len(rows), iterations)
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
            run = run_quickstart("--output", folder, *arguments)
        self.assertNotEqual(run.returncode, 0)
        self.assertIn(reason, run.stderr)
        self.assertNotIn("Traceback", run.stderr)

    def test_missing_volume(self):
        self.refused("no such file", "nowhere.mha")

    def test_volume_without_a_surface(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "flat.mha")
            writer = vtkMetaImageWriter()
            writer.SetFileName(path)
            writer.SetInputData(make_image(np.full((20, 20, 20), 3, "u1"), (1, 1, 1)))
            writer.Write()
            self.refused("all voxels are 3", path)


if __name__ == "__main__":
    unittest.main()
