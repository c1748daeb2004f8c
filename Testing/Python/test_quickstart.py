# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Examples/Python/quickstart.py on a small volume: every file it promises is there and readable."""

import csv
import json
import os
import sys
import unittest

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkFiltersCore import vtkFeatureEdges

from examples_path import EXAMPLES
from folder_test_case import FolderTestCase, SharedFolderTestCase
from sample_volumes import (
    MAJOR, MINOR, RING_SIZE, RING_SPACING, RING_VOLUME, ring_voxels, run_script, write_volume)
from vtk_files import read, read_pixels

sys.path.insert(0, EXAMPLES)
# pylint: disable=wrong-import-position
from quickstart import name_of_volume


class QuickstartTest(SharedFolderTestCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        volume = write_volume(cls.path("ring.mha"), ring_voxels(), RING_SPACING)
        cls.folder = cls.path("a/results")
        cls.run_of_it = run_script("quickstart.py", "--output", cls.folder, "--", volume)
        cls.surface = read(cls.path("surface.vtp"))

    def report(self):
        return json.loads(self.content("report.json"))

    def test_it_succeeds_and_names_what_it_wrote(self):
        self.assertEqual(self.run_of_it.returncode, 0, self.run_of_it.stderr)
        self.assertEqual(self.run_of_it.stderr, "")
        for name in ("volume.vti", "pyramid.vtm", "pyramid.png", "levels.vtm", "levels.png",
                     "surface.vtp", "surface-views.png", "history.csv", "history.png",
                     "report.json"):
            self.assertIn(self.path(name), self.run_of_it.stdout)
            self.assertTrue(os.path.getsize(self.path(name)) > 0, name)
        self.assertIn("Otsu", self.run_of_it.stdout)

    def test_the_volume_is_there_for_paraview(self):
        image = read(self.path("volume.vti"))
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
        pyramid = read(self.path("pyramid.vtm"))
        sizes = [pyramid.GetBlock(h).GetDimensions() for h in range(pyramid.GetNumberOfBlocks())]
        self.assertEqual(sizes, [(40,) * 3, (23,) * 3, (13,) * 3])

    def test_the_surfaces_can_be_read_again(self):
        levels = read(self.path("levels.vtm"))
        counts = [levels.GetBlock(h).GetNumberOfPoints() for h in range(3)]
        self.assertEqual(counts, sorted(counts, reverse=True))
        self.assertEqual(self.surface.GetNumberOfPoints(), counts[0])
        self.assertEqual(self.surface.GetPointData().GetNormals().GetName(), "Normals")

    def test_the_surface_is_a_closed_ring_in_world_coordinates(self):
        edges = vtkFeatureEdges()
        edges.SetInputData(self.surface)
        edges.FeatureEdgesOff()
        edges.ManifoldEdgesOff()
        edges.Update()
        self.assertEqual(edges.GetOutput().GetNumberOfCells(), 0)
        middle = (RING_SIZE - 1) / 2 * np.array(RING_SPACING)
        low, high = np.reshape(self.surface.GetBounds(), (3, 2)).T
        np.testing.assert_allclose((low + high) / 2, middle, atol=0.5)
        outer = MAJOR + MINOR
        size = 2 * np.array([outer, outer, MINOR * RING_SPACING[2]])
        np.testing.assert_allclose(high - low, size, atol=1.5)

    def test_the_report_tells_the_shape(self):
        report = self.report()
        self.assertEqual((report["components"], report["genus"]), (1, 1))
        self.assertEqual(report["vertices"], self.surface.GetNumberOfPoints())
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
        levels = self.report()["levels"]
        self.assertEqual(len(rows), sum(level["iterations"] for level in levels))
        for level in levels:
            own = [row for row in rows if int(row["Level"]) == level["level"]]
            seconds = sum(float(row[name]) for row in own
                          for name in ("SecondsBefore", "Seconds", "SecondsAfter"))
            self.assertAlmostEqual(seconds / level["seconds"], 1, 3)
        for name in ("Level", "KineticEnergy", "Seconds"):
            self.assertTrue(all(float(row[name]) >= 0 for row in rows), name)
        for name in ("Iteration", "Vertices", "MeanEdgeLength"):
            self.assertTrue(all(float(row[name]) > 0 for row in rows), name)

    def test_the_pictures_show_something(self):
        for name, least_width in (("pyramid.png", 1200), ("levels.png", 1200),
                                  ("history.png", 1400), ("surface-views.png", 1400)):
            with self.subTest(name):
                pixels = read_pixels(self.path(name))
                self.assertGreaterEqual(pixels.shape[1], least_width)
                self.assertGreater(pixels.std(), 12)


class RefusedTest(FolderTestCase):
    def refused(self, reason, *arguments):
        run = run_script("quickstart.py", "--output", self.folder, *arguments)
        self.assertNotEqual(run.returncode, 0)
        self.assertIn(reason, run.stderr)
        self.assertNotIn("Traceback", run.stderr)

    def test_missing_volume(self):
        self.refused("no such file", "nowhere.mha")

    def test_volume_without_a_surface(self):
        self.refused("no value separates", write_volume(
            self.path("flat.mha"), np.full((20, 20, 20), 3, "u1")))


if __name__ == "__main__":
    unittest.main()
