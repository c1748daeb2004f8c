# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Examples/Python/figures.py on a small volume: every picture that it promises."""

import os
import sys
import tempfile
import unittest

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOImage import vtkPNGReader

from examples_path import EXAMPLES
from sample_volumes import RING_ISO, RING_SPACING, ring_voxels, run_script, write_volume

sys.path.insert(0, EXAMPLES)
from figures import ROW_WIDTH, SKULL_PICTURES  # pylint: disable=wrong-import-position


def pixels_of(path):
    reader = vtkPNGReader()
    reader.SetFileName(path)
    reader.Update()
    width, height, _ = reader.GetOutput().GetDimensions()
    return vtk_to_numpy(reader.GetOutput().GetPointData().GetScalars()).reshape(height, width, -1)


class FiguresTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.temporary.cleanup)
        cls.output = os.path.join(cls.temporary.name, "pictures")
        large = np.kron(ring_voxels(), np.ones((2, 2, 2), "u1"))
        cls.ring = write_volume(os.path.join(cls.temporary.name, "r.mha"), large, RING_SPACING)

    def figures(self, *arguments):
        return run_script("figures.py", "--output", self.output, "--skull", self.ring,
                          str(RING_ISO), *arguments)

    def test_every_picture(self):
        run = self.figures("--vessels", self.ring, str(RING_ISO),
                           "--vessels", self.ring, str(RING_ISO))
        self.assertEqual((run.returncode, run.stderr), (0, ""))
        names = sorted([draw.__name__ + ".png" for draw in SKULL_PICTURES]
                       + ["vessels.png", "vessels-r.png"])
        self.assertEqual(sorted(os.listdir(self.output)), names)
        for name in names:
            pixels = pixels_of(os.path.join(self.output, name))
            self.assertGreater(pixels.shape[1], 0.75 * ROW_WIDTH, name)
            self.assertGreater(pixels.std(), 8, name)
        # One run serves all pictures of the same properties: default and without the pyramid.
        self.assertEqual(run.stdout.count("default properties"), 1)
        self.assertEqual(run.stdout.count("SnapshotInterval"), 1)

    def test_one_picture_alone(self):
        with tempfile.TemporaryDirectory() as folder:
            run = self.figures("--only", "pyramid", "--output", folder)
            self.assertEqual(run.returncode, 0, run.stderr)
            self.assertEqual(os.listdir(folder), ["pyramid.png"])
            self.assertNotIn("Evolving", run.stdout)

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


if __name__ == "__main__":
    unittest.main()
