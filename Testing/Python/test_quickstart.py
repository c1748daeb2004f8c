# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Examples/Python/quickstart.py on a small volume: every file it promises is there and readable."""

import os
import subprocess
import sys
import tempfile
import unittest

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOImage import vtkMetaImageWriter, vtkPNGReader
from vtkmodules.vtkIOXML import vtkXMLMultiBlockDataReader

from examples_path import EXAMPLES

sys.path.insert(0, EXAMPLES)
from volume_image import make_image  # pylint: disable=wrong-import-position


def ring_volume(size=40):
    """A bright ring (a torus) in noise; index order z, y, x."""
    z, y, x = np.indices((size,) * 3) - (size - 1) / 2
    inside = (np.hypot(x, y) - 0.27 * size) ** 2 + z ** 2 < (0.12 * size) ** 2
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
        writer.SetInputData(make_image(ring_volume(), (1, 1, 1.5)))
        writer.Write()
        cls.run_of_it = run_quickstart("--output", cls.output, "--", cls.volume)

    def path(self, name):
        return os.path.join(self.output, name)

    def test_it_succeeds_and_names_what_it_wrote(self):
        self.assertEqual(self.run_of_it.returncode, 0, self.run_of_it.stderr)
        self.assertEqual(self.run_of_it.stderr, "")
        for name in ("pyramid.vtm", "pyramid.png"):
            self.assertIn(self.path(name), self.run_of_it.stdout)
        self.assertIn("Otsu", self.run_of_it.stdout)

    def test_the_pyramid_can_be_read_again(self):
        reader = vtkXMLMultiBlockDataReader()
        reader.SetFileName(self.path("pyramid.vtm"))
        reader.Update()
        sizes = [reader.GetOutput().GetBlock(h).GetDimensions()
                 for h in range(reader.GetOutput().GetNumberOfBlocks())]
        self.assertEqual(sizes, [(40,) * 3, (23,) * 3, (13,) * 3])

    def test_the_picture_shows_something(self):
        self.check_picture("pyramid.png", least_width=1200)

    def check_picture(self, name, least_width):
        reader = vtkPNGReader()
        reader.SetFileName(self.path(name))
        reader.Update()
        self.assertGreaterEqual(reader.GetOutput().GetDimensions()[0], least_width)
        pixels = vtk_to_numpy(reader.GetOutput().GetPointData().GetScalars())
        self.assertGreater(pixels.std(), 20)


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
