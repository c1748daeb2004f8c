# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""What Examples/quickstart.sh does after it has built the project, on a small volume: every file
that it promises is there and can be read."""

import csv
import json
import os
import subprocess
import unittest

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkFiltersCore import vtkFeatureEdges

from folder_test_case import SharedFolderTestCase
from sample_volumes import (
    MAJOR, MINOR, RING_SIZE, RING_SPACING, RING_VOLUME, ring_voxels, run_script, write_volume)
from vtk_files import read, read_pixels


COMMAND = os.path.join(os.environ["VOLUMIC_TEST_INSTALL_PREFIX"], "bin", "volumic")


class QuickstartTest(SharedFolderTestCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        volume = write_volume(cls.path("ring.mha"), ring_voxels(), RING_SPACING)
        subprocess.run([COMMAND, volume, cls.path("surface.vtp"), "--levels-output",
                        cls.path("levels.vtm"), "--history", cls.path("history.csv"), "--report",
                        cls.path("report.json"), "--write-volume", cls.path("volume.vti")],
                       check=True)
        cls.pictures = run_script("Examples/Python/pictures.py", volume, cls.folder)

    def test_pictures(self):
        self.assertEqual((self.pictures.returncode, self.pictures.stderr), (0, ""))
        for name in ("pyramid.png", "levels.png", "surface-views.png", "history.png"):
            pixels = read_pixels(self.path(name))
            self.assertGreaterEqual(pixels.shape[1], 1200, name)
            self.assertGreater(pixels.std(), 12, name)

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


if __name__ == "__main__":
    unittest.main()
