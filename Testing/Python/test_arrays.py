# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Tests of volumic.surface and volumic.labels: results, files and exceptions."""

import os
import pickle
import subprocess
import sys
import unittest
import unittest.mock
import warnings

import numpy as np
import volumic
from vtkmodules.util.numpy_support import vtk_to_numpy
from volumic import arrays
from volumic.reading import Volume

from folder_test_case import FolderTestCase
from sample_volumes import RING_SPACING, RING_VOLUME, ring_voxels
from vtk_files import read as read_file


def volume_of(surface):
    """Return the enclosed volume by the divergence theorem."""
    a, b, c = (np.asarray(surface.points, float)[surface.triangles[:, k]] for k in range(3))
    return (a * np.cross(b, c)).sum() / 6


def two_balls():
    z, y, x = np.indices((20, 24, 40)) - 11.5
    voxels = np.zeros(x.shape, np.uint16)
    voxels[x * x + y * y + z * z < 49] = 3
    voxels[(x - 18) ** 2 + y * y + z * z < 36] = 7
    return voxels


class SurfaceTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.ring = volumic.surface(ring_voxels(), 125.5, spacing=RING_SPACING, origin=(10, 20, 30))

    def test_arrays_and_report(self):
        ring = self.ring
        self.assertEqual(len(ring.triangles), 2 * len(ring.points))
        self.assertEqual(ring.arrays["Normals"].shape, ring.points.shape)
        self.assertEqual(ring.arrays["Component"].shape, (len(ring.triangles),))
        self.assertEqual((ring.report["Genus"], ring.report["StopReason"]), (1, "converged"))
        self.assertAlmostEqual(volume_of(ring), ring.report["Volume"], delta=0.01)
        self.assertAlmostEqual(volume_of(ring) / RING_VOLUME, 1, delta=0.1)

    def test_axis_order(self):
        low, high = self.ring.points.min(axis=0), self.ring.points.max(axis=0)
        middle = np.array((10, 20, 30)) + 19.5 * np.array(RING_SPACING)
        np.testing.assert_allclose((low + high) / 2, middle, atol=0.5)
        self.assertLess(high[2] - low[2], 0.6 * (high[0] - low[0]))  # torus in the xy plane

    def test_result_equals_filter_output(self):
        algorithm = volumic.vtkVolumeToSurface()
        algorithm.SetInputData(arrays.make_image(ring_voxels(), RING_SPACING, (10, 20, 30), None,
                                             (0, 0, 0)))
        algorithm.SetIsoValue(125.5)
        algorithm.Update()
        points = vtk_to_numpy(algorithm.GetOutput().GetPoints().GetData())
        self.assertEqual(points.tobytes(), self.ring.points.tobytes())

    def test_volume_defines_its_position(self):
        volume = Volume(ring_voxels(), RING_SPACING, (10, 20, 30), space="RAS", unit="mm")
        surface = volumic.surface(volume, 125.5)
        self.assertEqual(surface.points.tobytes(), self.ring.points.tobytes())
        self.assertIn(b", SPACE=RAS, unit mm  ", surface.to_bytes(".stl"))
        array, spacing, origin, direction, space, unit, names = volume
        self.assertEqual((array.shape, spacing, unit, space, names),
                         (ring_voxels().shape, tuple(RING_SPACING), "mm", "RAS", {}))
        self.assertEqual((origin, direction.tolist()), ((10, 20, 30), np.eye(3).tolist()))
        with self.assertRaisesRegex(TypeError, "remove spacing"):
            volumic.surface(volume, 125.5, spacing=(1, 1, 1))

    def test_invalid_positions_and_iso_values_raise(self):
        for reason, iso, more in (
                ("iso is nan", np.nan, {}), ("iso is inf", np.inf, {}),
                ("origin nan", 125.5, {"origin": (np.nan, 0, 0)}),
                ("too far away for a spacing of 1", 125.5, {"origin": (1e20, 0, 0)}),
                ("spacing 1 x -1 x 1", 125.5, {"spacing": (1, -1, 1)})):
            with self.assertRaisesRegex(ValueError, reason):
                volumic.surface(ring_voxels(), iso, **more)

    def test_results_can_be_pickled(self):
        again = pickle.loads(pickle.dumps(self.ring))
        self.assertEqual(again.points.tobytes(), self.ring.points.tobytes())
        self.assertEqual((again.report, list(again.arrays)), (self.ring.report, list(self.ring.arrays)))
        balls = volumic.labels(two_balls())
        again = pickle.loads(pickle.dumps(balls))
        self.assertEqual(list(again), [3, 7])
        self.assertEqual(again[7].points.tobytes(), balls[7].points.tobytes())

    def test_dir_and_repr(self):
        self.assertLess({"surface", "labels", "read"}, set(dir(volumic)))
        self.assertRegex(repr(self.ring), rf"{len(self.ring.points)} points, "
                         rf"{len(self.ring.triangles)} triangles, components 1, genus 1, volume \d")

    def test_arrays_outlive_the_filter(self):
        points = volumic.surface(ring_voxels(), 125.5).points
        copy = points.copy()
        volumic.surface(ring_voxels() + 1, 125.5)
        np.testing.assert_array_equal(points, copy)

    def test_start_direction_and_scalar_types(self):
        voxels = ring_voxels()
        whole = volumic.surface(voxels, 125.5, start=(1, 2, 3))
        np.testing.assert_allclose(whole.points.mean(axis=0), 19.5 + np.array((1, 2, 3)), atol=0.5)
        turned = volumic.surface(voxels, 125.5, direction=[[0, -1, 0], [1, 0, 0], [0, 0, 1]])
        self.assertLess(turned.points[:, 0].max(), 0)
        big = volumic.surface(voxels.astype(">f4"), 125.5)
        half = volumic.surface(voxels.astype("f2"), 125.5)
        self.assertEqual(big.points.tobytes(), half.points.tobytes())
        with self.assertWarnsRegex(UserWarning, "label map"):
            mask = volumic.surface(voxels > 125, 0.5)
        self.assertEqual(mask.report["Genus"], 1)

    def test_default_iso_value_is_otsu_with_warning(self):
        with self.assertWarnsRegex(UserWarning, "Otsu"):
            ring = volumic.surface(ring_voxels())
        self.assertIn("Otsu", ring.report["Warnings"][0])
        self.assertEqual(ring.report["Genus"], 1)

    def test_invalid_arguments_raise(self):
        for error, message, call in (
                (TypeError, "no property finestLevel; did you mean FinestLevel",
                 lambda: volumic.surface(ring_voxels(), 125.5, finestLevel=1)),
                (TypeError, "FinestLevel='x': ",
                 lambda: volumic.surface(ring_voxels(), 125.5, FinestLevel="x")),
                (ValueError, "three axes, z, y and x, not 2",
                 lambda: volumic.surface(np.zeros((4, 4)), 1)),
                (ValueError, "complex", lambda: volumic.surface(np.zeros((4, 4, 4), complex), 1)),
                (arrays.FilterError, "^Upper Value is 9, but Iso Value is not set",
                 lambda: volumic.surface(ring_voxels(), UpperValue=9)),
                (arrays.FilterError, "^Iso Value is 7777, outside the range",
                 lambda: volumic.surface(ring_voxels(), 7777))):
            with self.subTest(message):
                with self.assertRaisesRegex(error, message):
                    call()

    def test_nothing_is_printed(self):
        code = ("import numpy, volumic\n"
                "try: volumic.surface(numpy.eye(9)[None].repeat(9, 0), 7)\n"
                "except volumic.arrays.FilterError as error: print(error)")
        process = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True,
                                 check=True)
        self.assertEqual(process.stderr, "")
        self.assertEqual(process.stdout.count("Iso Value"), 1)


class LabelsTest(unittest.TestCase):
    def test_each_label_has_a_surface(self):
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            balls = volumic.labels(two_balls(), spacing=(1, 1, 1))
        self.assertEqual(list(balls), [3, 7])
        self.assertEqual(balls[7].report["LabelVoxels"], np.count_nonzero(two_balls() == 7))
        self.assertEqual(balls.to_vtk().GetNumberOfBlocks(), 2)
        one = volumic.labels(two_balls(), [7])
        self.assertEqual(list(one), [7])
        self.assertEqual(one[7].points.tobytes(), balls[7].points.tobytes())

    def test_merge_returns_one_surface(self):
        merged = volumic.labels(two_balls(), Merge=True)
        self.assertEqual(list(merged), [3])
        self.assertEqual(merged[3].report["Label"], [3, 7])

    def test_invalid_arguments_raise(self):
        with self.assertRaisesRegex(arrays.FilterError, "has no label 5. Select from 0, 3, 7"):
            volumic.labels(two_balls(), [5])
        with self.assertRaisesRegex(TypeError, "mean Smoothing"):
            volumic.labels(two_balls(), Smooting=1)


class FilesTest(FolderTestCase):
    def setUp(self):
        super().setUp()
        self.ball = volumic.labels(two_balls(), [3], spacing=(1, 1, 2))[3]

    def test_formats(self):
        for suffix in (".vtp", ".ply", ".stl"):
            self.ball.save(self.path("ball" + suffix))
            there = read_file(self.path("ball" + suffix))
            self.assertEqual(there.GetNumberOfPolys(), len(self.ball.triangles))
            np.testing.assert_allclose(there.GetBounds(), self.ball.to_vtk().GetBounds(), atol=1e-5)
        with self.assertRaisesRegex(ValueError, "'.off' is not a surface format; use one of .vtp"):
            self.ball.save(self.path("ball.off"))

    def test_failed_write_keeps_existing_file(self):
        path, balls = self.write_text("ball.vtp", "former"), volumic.labels(two_balls())
        for save, name in ((self.ball.save, path), (balls.save, "l.vtm"), (balls.save, "l")):
            with unittest.mock.patch("os.replace", side_effect=OSError("no")):
                with self.assertRaisesRegex(OSError, f"{name}: cannot be written .no.$"):
                    save(self.path(name))
        self.assertEqual((self.content(path), os.listdir(self.folder)), (b"former", ["ball.vtp"]))

    def test_save_all_labels(self):
        for name in ("balls", "balls.vtm"):
            volumic.labels(two_balls()).save(self.path(name))
        self.assertIn("label-7.vtp", os.listdir(self.path("balls")))
