# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Examples/Python/figures.py on a small volume: every picture that it promises."""

import contextlib
import io
import os
import sys
import tempfile
import unittest

import numpy as np
from vtkmodules.vtkChartsCore import vtkAxis
from vtkmodules.vtkCommonDataModel import vtkVector2i

from examples_path import EXAMPLES
from folder_test_case import SharedFolderTestCase
from sample_volumes import RING_ISO, RING_SPACING, ring_voxels, run_script, write_volume
from vtk_files import read_pixels

sys.path.insert(0, EXAMPLES)
# pylint: disable=wrong-import-position
from figures import ROW_WIDTH, SKULL_PICTURES, stages_by_level
from history_chart import CURVES, chart_matrix
from scan_runs import Scan


class FiguresTest(SharedFolderTestCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.output = cls.path("pictures")
        large = np.kron(ring_voxels(), np.ones((2, 2, 2), "u1"))
        cls.ring = write_volume(cls.path("r.mha"), large, RING_SPACING)
        cls.small = write_volume(cls.path("s.mha"), ring_voxels(), RING_SPACING)

    def figures(self, *arguments):
        return run_script("figures.py", "--output", self.output, "--skull", self.ring,
                          str(RING_ISO), *arguments)

    def test_every_picture(self):
        run = self.figures("--vessels", self.small, str(RING_ISO),
                           "--vessels", self.small, str(RING_ISO),
                           "--graded", self.small, str(RING_ISO), "0.2")
        self.assertEqual((run.returncode, run.stderr), (0, ""))
        names = sorted([draw.__name__ + ".png" for draw in SKULL_PICTURES]
                       + ["vessels.png", "vessels-s.png", "graded-s.png", "interfaces.png"])
        self.assertEqual(sorted(os.listdir(self.output)), names)
        for name in names:
            pixels = read_pixels(os.path.join(self.output, name))
            self.assertGreater(pixels.shape[1], 0.75 * ROW_WIDTH, name)
            self.assertGreater(pixels.std(), 8, name)
        # One run serves all pictures of the same properties: default and without the pyramid.
        self.assertEqual(run.stdout.count("default properties"), 2)  # of two scans
        self.assertEqual(run.stdout.count("SnapshotInterval"), 1)
        self.assertEqual(run.stdout.count("Recovery 0, Metric 0, CoarsestLevel 3\n"), 1)
        self.assertEqual(run.stdout.count("Recovery 0, Metric 0, CoarsestLevel 2\n"), 2)  # both vessels

    def test_one_picture_alone(self):
        run = self.figures("--only", "pyramid", "--output", self.path("alone"))
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertEqual(os.listdir(self.path("alone")), ["pyramid.png"])
        self.assertNotIn("Evolving", run.stdout)
        self.assertNotIn("No --graded", run.stdout)

    def test_tells_which_pictures_stay(self):
        run = self.figures("--only", "graded", "vessels", "--output", self.path("some"))
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertEqual(os.listdir(self.path("some")), ["graded.png"])
        self.assertIn("No --vessels", run.stdout)
        self.assertIn("No --graded", run.stdout)

    def test_refused(self):
        for arguments, code, reason in (
                (("--only", "nothing"), 2, "invalid choice"),
                (("--only", "vessels", "--vessels", "none.vti", "3"), 1, "no such file"),
                (("--only", "levels", "--skull", self.ring, "9999"), 1, "9999")):
            with self.subTest(reason):
                run = self.figures(*arguments)
                self.assertEqual(run.returncode, code)
                self.assertIn(reason, run.stderr)
                self.assertNotIn("Traceback", run.stderr)


class EvolutionTest(unittest.TestCase):
    def test_stages_are_the_start_and_each_level_at_rest(self):
        with tempfile.TemporaryDirectory() as folder, contextlib.redirect_stdout(io.StringIO()):
            path = write_volume(os.path.join(folder, "r.mha"), ring_voxels(), RING_SPACING)
            surface = Scan(path, RING_ISO).run()
        rows = surface.GetHistory().GetNumberOfRows()
        names = [name for name, _ in stages_by_level(surface)]
        self.assertEqual(len(names), 4)
        self.assertEqual(names[0], "Level 2, iteration 0")
        self.assertEqual(names[-1], f"Level 0, iteration {rows}")
        sizes = [stage.GetNumberOfPoints() for _, stage in stages_by_level(surface)]
        self.assertLess(sizes[1], sizes[0])  # the start encloses the image
        self.assertLess(sizes[1], sizes[2])


class ChartTest(unittest.TestCase):
    def test_two_evolutions_have_the_same_scale(self):
        rows = np.arange(1.0, 41)
        small = {"Level": 1 + rows * 0, **{curve[0]: rows for curve in CURVES}}
        large = {name: np.tile(column, 2) * 3 for name, column in small.items()}
        cells = [(column, row, curve, columns) for column, columns in enumerate((small, large))
                 for row, curve in enumerate(CURVES)]
        matrix = chart_matrix(cells, small, 1)
        for row, (name, _, factor, logarithmic) in enumerate(CURVES):
            for place in (vtkAxis.BOTTOM, vtkAxis.LEFT):
                ends = []
                for column in range(2):
                    chart = matrix.GetChart(vtkVector2i(column, len(CURVES) - 1 - row))
                    axis = chart.GetAxis(place)
                    ends.append((axis.GetUnscaledMinimum(), axis.GetUnscaledMaximum()))
                self.assertEqual(ends[0], ends[1], name)
                least = 80 if place == vtkAxis.BOTTOM else 120 * factor
                self.assertGreaterEqual(ends[0][1], least, name)
            self.assertEqual(axis.GetLogScale(), logarithmic, name)


if __name__ == "__main__":
    unittest.main()
