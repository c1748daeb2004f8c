# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Examples/Python/quickstart.py on a small volume: every file it promises is there and readable."""

import csv
import json
import os
import unittest

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkFiltersCore import vtkFeatureEdges

from folder_test_case import FolderTestCase, SharedFolderTestCase
from sample_volumes import (
    MAJOR, MINOR, RING_SIZE, RING_SPACING, RING_VOLUME, ring_voxels, run_script, write_volume)
from vtk_files import read, read_pixels


class QuickstartTest(SharedFolderTestCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        volume = write_volume(cls.path("ring.mha"), ring_voxels(), RING_SPACING)
        cls.folder = cls.path("a/results")
        cls.run_of_it = run_script("quickstart.py", "--output", cls.folder, "--", volume)

    def test_it_succeeds_and_names_what_it_wrote(self):
        self.assertEqual((self.run_of_it.returncode, self.run_of_it.stderr), (0, ""))
        for name in ("volume.vti", "pyramid.vtm", "pyramid.png", "levels.vtm", "levels.png",
                     "surface.vtp", "surface-views.png", "history.csv", "history.png",
                     "report.json"):
            self.assertIn(self.path(name), self.run_of_it.stdout)
            self.assertTrue(os.path.getsize(self.path(name)) > 0, name)
            if name.endswith(".png"):
                pixels = read_pixels(self.path(name))
                self.assertGreaterEqual(pixels.shape[1], 1200)
                self.assertGreater(pixels.std(), 12)
        self.assertIn("Otsu", self.run_of_it.stdout)

    def test_the_data_can_be_read_again(self):
        image = read(self.path("volume.vti"))
        np.testing.assert_allclose(image.GetSpacing(), RING_SPACING)
        voxels = vtk_to_numpy(image.GetPointData().GetScalars())
        np.testing.assert_array_equal(voxels, ring_voxels().ravel())
        pyramid, levels = read(self.path("pyramid.vtm")), read(self.path("levels.vtm"))
        self.assertEqual([pyramid.GetBlock(h).GetDimensions() for h in range(3)],
                         [(40,) * 3, (23,) * 3, (13,) * 3])
        counts = [levels.GetBlock(h).GetNumberOfPoints() for h in range(3)]
        self.assertEqual(counts, sorted(counts, reverse=True))

    def test_the_surface_is_a_closed_ring_in_world_coordinates(self):
        surface = read(self.path("surface.vtp"))
        edges = vtkFeatureEdges()
        edges.SetInputData(surface)
        edges.FeatureEdgesOff()
        edges.ManifoldEdgesOff()
        edges.Update()
        self.assertEqual(edges.GetOutput().GetNumberOfCells(), 0)
        low, high = np.reshape(surface.GetBounds(), (3, 2)).T
        np.testing.assert_allclose((low + high) / 2, (RING_SIZE - 1) / 2 * np.array(RING_SPACING),
                                   atol=0.5)
        outer = MAJOR + MINOR
        np.testing.assert_allclose(
            high - low, 2 * np.array([outer, outer, MINOR * RING_SPACING[2]]), atol=1.5)

    def test_the_report_and_the_history(self):
        report = json.loads(self.content("report.json"))
        self.assertEqual((report["components"], report["genus"]), (1, 1))
        self.assertAlmostEqual(report["volume"] / RING_VOLUME, 1, delta=0.1)
        self.assertEqual([level["level"] for level in report["levels"]], [2, 1, 0])
        self.assertEqual(report["warnings"], [])
        with open(self.path("history.csv"), encoding="utf-8", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(len(rows), sum(level["iterations"] for level in report["levels"]))


class RefusedTest(FolderTestCase):
    def test_volumes_without_a_surface(self):
        flat = write_volume(self.path("flat.mha"), np.full((20, 20, 20), 3, "u1"))
        for reason, volume in (("no such file", "nowhere.mha"), ("no value separates", flat)):
            run = run_script("quickstart.py", "--output", self.folder, volume)
            self.assertNotEqual(run.returncode, 0)
            self.assertIn(reason, run.stderr)
            self.assertNotIn("Traceback", run.stderr)


if __name__ == "__main__":
    unittest.main()
