# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Headers that contradict themselves or mislead: the positions and values that are used, and the
warnings of readers, of the iso-value and of writers."""

import struct
import unittest

import numpy as np
from vtkmodules.vtkIOXML import vtkXMLImageDataWriter

from command_test_case import (
    ISO, META, ORIGIN, SIZE, SPACING, CommandTestCase, ball, make_image, medical_files)
from reading_test_case import ReadingTestCase


class HeadersTest(ReadingTestCase):
    def test_a_spacing_against_its_axis(self):
        spacing = " ".join(map(str, SPACING)).encode()
        volume = self.read("b.mha", META.replace(spacing, spacing.replace(b" 1", b" -1"))
                           + ball().tobytes())
        last = volume.origin + volume.direction @ (np.array(volume.spacing) * (SIZE - 1))
        np.testing.assert_allclose(last, ORIGIN + SPACING * (SIZE - 1) * (1, 1, -1))

    def test_nifti(self):
        nan = float("nan")
        signs = bytearray(medical_files.nifti(ball(), SPACING * (1, -1, 1), offset=ORIGIN))
        struct.pack_into("<h", signs, 252, 0)
        unit = bytearray(medical_files.nifti(ball(), SPACING, offset=ORIGIN))
        unit[123] = 3
        for content, warning in (
                (signs, r"its header is corrected: pixdim\[1,2,3\] should be positive"),
                (unit, "its unit is um, not mm; so is that of surfaces and lengths unless --unit "
                 "gives another"),
                (medical_files.nifti(ball(), SPACING, slope=nan, intercept=nan), "^$")):
            volume = self.read("a.nii", content)
            self.assertRegex(" ".join(volume.warnings), warning)
            np.testing.assert_array_equal(volume.array, ball())
            np.testing.assert_allclose(volume.spacing, SPACING)


class ReportedTest(CommandTestCase):
    def test_far_from_the_origin(self):
        far = make_image(ball(), SPACING * 0.1, (500000, 4000000, 300))
        volume = self.write(vtkXMLImageDataWriter(), "a.vti", far)
        told = self.run_command(volume, self.path("b.vtk"), self.path("b.stl"), "--iso", ISO).stderr
        self.assertRegex(told, r"warning: .*b.stl: coordinates up to 400000\d are rounded there by "
                         r"steps of 0\.4")
        self.assertNotIn("b.vtk: coordinates", told)

    def test_padding_of_a_ct(self):
        z, y, x = np.mgrid[0:24, 0:48, 0:48]
        voxels = np.full(x.shape, -1000.0)
        voxels[((x - 24) ** 2 + (y - 24) ** 2) / 169 + ((z - 12) / 9) ** 2 < 1] = 40
        voxels += np.random.default_rng(2).normal(0, 12, x.shape)
        voxels[(x - 23.5) ** 2 + (y - 23.5) ** 2 > 576] = -3024
        self.write(vtkXMLImageDataWriter(), "a.vti", make_image(voxels.astype("i2"), (1, 1, 1)))
        report = self.report(self.path("a.vti"))
        self.assertTrue(-600 < report["iso_value"] < -300, report["iso_value"])
        self.assertLess(report["volume"], 4 / 3 * np.pi * 13 * 13 * 9, "it is the head")
        self.assertRegex(self.run_command(self.path("a.vti"), self.path("a.vtp")).stderr,
                         "a guess by Otsu's .*voxels of -3024 are padding")

    def test_values_that_no_surface_has(self):
        self.write(vtkXMLImageDataWriter(), "flat.vti", make_image(np.full((12, 12, 12), 4, "u1")))
        self.write(vtkXMLImageDataWriter(), "mask.vti", make_image((ball() > ISO).astype("u1")))
        for name, reason, *options in (
                ("flat.vti", "no value (separates|parts)"),
                ("flat.vti", "no value (separates|parts)((?!set it between).)*$", "--iso", 4),
                ("mask.vti", "at an end of the range", "--iso", 1)):
            self.refused(reason, self.path(name), self.path("a.vtp"), *options)


if __name__ == "__main__":
    unittest.main()
