# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Tests of `volumic --write-volume`, of cropping and of resampling."""

import os

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLImageDataWriter

from command_test_case import (
    ORIGIN, SIZE, SPACING, TURNED, CommandTestCase, ball, largest_file, make_image,
    nrrd_header)

from vtk_files import read


def voxels_of(image):
    return vtk_to_numpy(image.GetPointData().GetScalars()).reshape(image.GetDimensions()[::-1])


class WritingTestCase(CommandTestCase):
    def nrrd(self):
        return self.write_bytes("a.nrrd", nrrd_header(direction=TURNED) + b"\n" + ball().tobytes())

    def written(self, volume, *options, messages=""):
        """Return the written volume; check that no other file is written."""
        before = set(os.listdir(self.folder))
        process = self.run_command(volume, "--write-volume", self.path("written.vti"), *options)
        self.assertNotIn("iso-value", process.stderr)
        self.assertIn(messages, process.stderr)
        self.assertEqual(set(os.listdir(self.folder)) - before, {"written.vti"})
        image = read(self.path("written.vti"))
        os.rename(self.path("written.vti"), self.path("last.vti"))
        return image


class WrittenVolumeTest(WritingTestCase):
    def test_voxels_and_positions(self):
        image = self.written(self.nrrd())
        for _ in range(2):
            np.testing.assert_array_equal(voxels_of(image), ball())
            self.assertEqual(voxels_of(image).dtype, np.int16)
            np.testing.assert_allclose(image.GetSpacing(), SPACING)
            np.testing.assert_allclose(image.GetOrigin(), ORIGIN)
            matrix = image.GetDirectionMatrix()
            np.testing.assert_allclose(
                [[matrix.GetElement(r, c) for c in range(3)] for r in range(3)], TURNED)
            self.assertEqual(image.GetFieldData().GetAbstractArray("Axes").GetValue(0), "LPS")
            image = self.written(self.path("last.vti"))  # again, from the written file

    def test_array_and_spacing(self):
        image = make_image(ball())
        other = numpy_to_vtk(ball("f4").ravel(), deep=True)
        other.SetName("other")
        image.GetPointData().AddArray(other)
        written = self.written(self.write(vtkXMLImageDataWriter(), "a.vti", image),
                               "--array", "other", "--spacing", "1,2,3")
        self.assertEqual(written.GetPointData().GetScalars().GetName(), "other")
        self.assertEqual(written.GetSpacing(), (1, 2, 3))

    def test_invalid_outputs(self):
        volume, old = self.ball_file(), self.write_bytes("old.vti", b"older")
        self.rejects("volumes are written as .vti", volume, "--write-volume", "a.mha", status=2)
        self.rejects("old.vti: cannot be written .File too large", volume, "--write-volume", old,
                     preexec_fn=largest_file(1000))
        self.assertEqual(self.content("old.vti"), b"older")


class ResampledVolumeTest(WritingTestCase):
    def test_values_are_linear_between_voxels(self):
        """A linear function is preserved, except in the outer halves of voxels."""
        index, slope = np.indices((7, 12, 9))[::-1], np.array([3.0, -2.0, 0.5])
        world = ORIGIN + np.moveaxis(index, 0, -1) @ (TURNED * SPACING).T
        image = make_image((world @ slope).astype("f4"), direction=TURNED)
        written = self.written(self.write(vtkXMLImageDataWriter(), "a.vti", image), "--resample",
                               "0.31,0.7,0.4", messages="resampled from")
        self.assertEqual(written.GetSpacing(), (0.31, 0.7, 0.4))
        np.testing.assert_allclose(written.GetCenter(), image.GetCenter(), atol=1e-6)
        coordinates = np.array([written.GetPoint(i) for i in range(0, written.GetNumberOfPoints(), 7)])
        low, high = np.reshape(image.GetBounds(), (3, 2)).T
        inside = ((coordinates > low) & (coordinates < high)).all(1)
        self.assertGreater(inside.sum(), 50)
        np.testing.assert_allclose(voxels_of(written).ravel()[::7][inside],
                                   (coordinates @ slope)[inside], atol=2e-4)

    def test_labels_use_nearest_neighbour(self):
        labels = np.random.default_rng(3).integers(0, 9, (6, 12, 14)).astype("u2")
        file = self.write(vtkXMLImageDataWriter(), "a.vti", make_image(labels, (0.5, 0.5, 1.5)))
        written = self.written(file, "--isotropic", "--labels", "all", messages="resampled from")
        np.testing.assert_array_equal(voxels_of(written), labels.repeat(3, axis=0))

    def test_thin_volumes_are_resampled(self):
        z, y, x = np.indices((7, 30, 30))
        cone = (100 - 10 * np.hypot(np.hypot(x - 15, y - 15), 4 * (z - 3))).astype("i2")
        file = self.write(vtkXMLImageDataWriter(), "a.vti", make_image(cone, (1, 1, 4)))
        report = self.report(file, self.path("a.vtp"), "--iso", "0")
        self.assertRegex(report["input"]["resampling"],
                         "resampled from 30 x 30 x 7 voxels of 1 x 1 x 4: a surface requires 8 voxels")
        self.assertEqual(report["genus"], 0)
        self.assertAlmostEqual(report["volume"], 4 / 3 * np.pi * 10 ** 3, delta=300)


class RegionTest(WritingTestCase):
    def test_region_and_region_box(self):
        corners = ORIGIN + SPACING * [[5, 3, 4], [20, 14, 11]] @ TURNED.T
        box = np.sort(corners, axis=0) + [[.1], [-.1]]
        for options in (("--region", "5,20,3,14,4,11"),
                        ("--region-box", ",".join(map(str, box.T.ravel())))):
            image = self.written(self.nrrd(), *options)
            np.testing.assert_array_equal(voxels_of(image), ball()[4:12, 3:15, 5:21])
            np.testing.assert_allclose(image.GetPoint(0), corners[0], atol=1e-6)
        image = self.written(self.nrrd(), "--region", "-5,8,0,10000,3,5")
        self.assertEqual(image.GetDimensions(), (9, SIZE[1], 3))

    def test_invalid_regions(self):
        for reason, *options in (
                ("the region is outside the volume, whose index k ranges from 0 to 17", "--region",
                 "0,5,0,5,18,20"),
                ("resampling yields .* voxels", "--resample", "1e-6,1e-6,1e-6")):
            with self.subTest(reason):
                self.rejects(reason, self.ball_file(), self.path("a.vtp"), *options)
