# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Examples/Python/numpy_arrays.py: arrays in and out, and the outputs as pyvista takes them."""

import contextlib
import io
import sys
import unittest
from unittest import mock

import numpy as np

from examples_path import EXAMPLES
from folder_test_case import FolderTestCase
from sample_volumes import RING_SPACING, RING_VOLUME, ring_voxels, run_script

sys.path.insert(0, EXAMPLES)
# pylint: disable=wrong-import-position
import numpy_arrays


def quietly(function, *arguments):
    with contextlib.redirect_stdout(io.StringIO()):
        return function(*arguments)


class ArraysTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.surface = quietly(numpy_arrays.surface_of_array, ring_voxels(), 125.5, RING_SPACING,
                              (10, 20, 30))
        cls.arrays = numpy_arrays.arrays_of_surface(cls.surface)

    def test_shapes(self):
        points, triangles = len(self.arrays["points"]), len(self.arrays["triangles"])
        shapes = {name: array.shape for name, array in self.arrays.items()}
        self.assertEqual(shapes, {"points": (points, 3), "normals": (points, 3),
                                  "residual": (points,), "triangles": (triangles, 3),
                                  "component": (triangles,)})
        self.assertEqual(triangles, 2 * points)  # a ring's

    def test_triangles_enclose_the_ring_outward(self):
        volume = numpy_arrays.volume_of(self.arrays["points"], self.arrays["triangles"])
        self.assertAlmostEqual(volume / RING_VOLUME, 1, delta=0.1)

    def test_axes_are_in_their_order(self):
        low, high = self.arrays["points"].min(axis=0), self.arrays["points"].max(axis=0)
        middle = np.array((10, 20, 30)) + 19.5 * np.array(RING_SPACING)
        np.testing.assert_allclose((low + high) / 2, middle, atol=0.5)
        self.assertLess(high[2] - low[2], 0.6 * (high[0] - low[0]))  # the ring lies across z


class ScriptTest(FolderTestCase):
    def test_two_linked_rings(self):
        run = run_script("numpy_arrays.py")
        self.assertEqual((run.returncode, run.stderr), (0, ""))
        self.assertIn("components 2, genus 2", run.stdout)

    def test_files_in_and_out(self):
        voxels, mesh = self.path("v.npy"), self.path("m.npz")
        np.save(voxels, ring_voxels().astype("f8"))
        run = run_script("numpy_arrays.py", voxels, mesh, "--iso", "125.5", "--spacing", "1", "1",
                         "1.5")
        self.assertEqual(run.returncode, 0, run.stderr)
        with np.load(mesh) as arrays:
            volume = numpy_arrays.volume_of(arrays["points"], arrays["triangles"])
        self.assertAlmostEqual(volume / RING_VOLUME, 1, delta=0.1)

    def test_refused(self):
        flat = self.path("flat.npy")
        np.save(flat, np.zeros((9, 9)))
        for arguments, reason in (([flat], "three dimensions"), (["none.npy"], "none.npy"),
                                  (["--iso", "7"], "7")):
            with self.subTest(reason):
                run = run_script("numpy_arrays.py", *arguments)
                self.assertEqual(run.returncode, 1)
                self.assertIn(reason, run.stderr)
                self.assertNotIn("Traceback", run.stderr)

    def test_without_pyvista_the_script_tells(self):
        with mock.patch.dict(sys.modules, pyvista=None):
            with self.assertRaisesRegex(numpy_arrays.FilterError, "needs pyvista"):
                numpy_arrays.show(None)


if __name__ == "__main__":
    unittest.main()
