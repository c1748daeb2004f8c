# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""What a file says `volumic` follows, or tells in one line, with both values, that it does not."""

import json
import os
import re
import struct
import unittest

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLImageDataReader, vtkXMLImageDataWriter

from command_test_case import (
    ISO, META, ORIGIN, SPACING, CommandTestCase, ball, make_image, nrrd_header)

import medical_files

SFORM = np.column_stack([np.diag(SPACING), ORIGIN])


class ToldTest(CommandTestCase):
    def centre(self, volume, *options, iso=ISO):
        """Of the ball."""
        report = self.report(self.path(volume), "--iso", iso, "--quiet", *options)
        return np.array(report["component_features"][0]["centroid"])

    def warning(self, volume, *options, iso=ISO):
        """The one that there is; empty if there is none."""
        said = self.run_command(self.path(volume), self.path("a.vtp"), "--iso", iso, *options).stderr
        return "".join(re.findall("volumic: warning: .*", said))


class PlacesTest(ToldTest):
    def test_a_spacing_against_its_axis(self):
        self.write_bytes("a.mha", META + ball().tobytes())
        spacing = " ".join(map(str, SPACING)).encode()
        self.write_bytes("b.mha", META.replace(spacing, spacing.replace(b" 1", b" -1"))
                         + ball().tobytes())
        there = self.centre("a.mha")
        there[2] = 2 * ORIGIN[2] - there[2]
        np.testing.assert_allclose(self.centre("b.mha"), there, atol=1e-3)

    def test_signs_of_pixdim(self):
        content = bytearray(medical_files.nifti(ball(), SPACING * (1, -1, 1), offset=ORIGIN))
        struct.pack_into("<h", content, 252, 0)
        self.write_bytes("a.nii", content)
        self.assertRegex(self.warning("a.nii"), "told as 0.5, -0.75, 1; .* without signs")

    def test_forms_that_differ(self):
        self.write_bytes("a.nii", medical_files.nifti(ball(), SPACING, SFORM, offset=ORIGIN))
        self.assertEqual(self.warning("a.nii"), "")
        self.write_bytes("b.nii", medical_files.nifti(ball(), SPACING, SFORM, offset=(50, 60, 70)))
        self.assertRegex(self.warning("b.nii"), "sform, which is taken, and its qform differ: "
                         ".*-7 8 9.5; .*50 60 70$")
        self.write_bytes("c.nii", medical_files.nifti(ball(), SPACING, 0 * SFORM, offset=ORIGIN))
        self.assertRegex(self.warning("c.nii"), "its sform has axes that .*; its qform is taken$")

    def test_units(self):
        content = bytearray(medical_files.nifti(ball(), SPACING, SFORM, offset=ORIGIN))
        content[123] = 3
        self.write_bytes("a.nii", content)
        self.assertIn("unless --unit asks for another, is micrometres, not", self.warning("a.nii"))

    def test_far_from_the_origin(self):
        far = make_image(ball(), SPACING * 0.1, (500000, 4000000, 300))
        self.write(vtkXMLImageDataWriter(), "a.vti", far)
        self.assertEqual(self.warning("a.vti", self.path("b.vtk")), "")
        self.assertRegex(self.warning("a.vti", self.path("b.stl")),
                         r"b.stl: coordinates up to 400000\d are rounded there by steps of 0\.4")


class ValuesTest(ToldTest):
    def test_halves_of_floats(self):
        voxels = (ball("f4") - 300.25).astype("f2")
        voxels[0, 0, :4] = np.nan, 6e-8, -0.0, 65504
        self.write_bytes("a.mrc", medical_files.mrc(voxels, SPACING, 12))
        self.write_bytes("b.raw", voxels.astype(">f2").tobytes())
        np.save(self.path("c.npy"), voxels)
        for name, more in (("a.mrc", ()), ("b.raw", ("--raw", "26,22,18,float16,big")), ("c.npy", ())):
            self.run_command(self.path(name), *more, "--write-volume", self.path("a.vti"))
            reader = vtkXMLImageDataReader()
            reader.SetFileName(self.path("a.vti"))
            reader.Update()
            values = vtk_to_numpy(reader.GetOutput().GetPointData().GetScalars())
            self.assertEqual(values.dtype, "f4")
            np.testing.assert_array_equal(values, voxels.astype("f4").ravel())

    def test_numbers_that_are_no_vector(self):
        for kind, asks in (("list", True), ("RGBA-color", True), ("RGB-color", False),
                           ("vector", False)):
            count = 4 if "A" in kind else 3
            header = nrrd_header().replace(b"dimension: 3", b"dimension: 4").replace(
                b"sizes:", b"sizes: %d" % count).replace(b"space directions:",
                                                         b"space directions: none")
            header += f"kinds: {kind} domain domain domain\n\n".encode()
            self.write_bytes("a.nrrd", header + np.repeat(ball()[..., np.newaxis], count, -1).tobytes())
            with self.subTest(kind):
                self.accepted("a.nrrd", "--component", "1")
                if asks:
                    self.refused_volume("a.nrrd", f"the {count} numbers of each voxel are no vector "
                                        f".*; choose one with --component N, 0 to {count - 1}")
                    os.remove(self.path("ok.stl"))
                else:
                    self.accepted("a.nrrd")

    def test_a_slope_that_is_no_number(self):
        nan = float("nan")
        self.write_bytes("a.nii", medical_files.nifti(
            ball(), SPACING, SFORM, offset=ORIGIN, slope=nan, intercept=nan))
        self.assertIn("short, 0 to 8", self.run_command(
            self.path("a.nii"), self.path("a.vtp"), "--iso", ISO).stderr)

    def test_padding_of_a_ct(self):
        z, y, x = np.mgrid[0:24, 0:48, 0:48]
        noise = np.random.default_rng(2).normal(0, 12, x.shape)
        voxels = np.full(x.shape, -1000.0)
        voxels[((x - 24) ** 2 + (y - 24) ** 2) / 169 + ((z - 12) / 9) ** 2 < 1] = 40
        voxels += noise
        voxels[(x - 23.5) ** 2 + (y - 23.5) ** 2 > 576] = -3024
        self.write(vtkXMLImageDataWriter(), "a.vti", make_image(voxels.astype("i2"), (1, 1, 1)))
        process = self.run_command(self.path("a.vti"), self.path("a.vtp"), "--report", self.path("r"))
        self.assertRegex(process.stderr, "iso-value -4.*, a guess by Otsu's .*voxels of -3024 are padding")
        report = json.loads(self.content("r"))
        self.assertLess(report["volume"], 4 / 3 * np.pi * 13 * 13 * 9, "it is the head")

    def test_false_advice(self):
        self.write(vtkXMLImageDataWriter(), "flat.vti", make_image(np.full((12, 12, 12), 4, "u1")))
        for options in ((), ("--iso", 4), ("--iso", 5)):
            said = self.run_command(
                self.path("flat.vti"), self.path("a.vtp"), *options, status=1).stderr
            self.assertRegex(said, "no value (separates|parts)")
            self.assertNotIn("set it between", said)
        self.write(vtkXMLImageDataWriter(), "mask.vti", make_image((ball() > ISO).astype("u1")))
        self.refused("at an end of the range", self.path("mask.vti"), self.path("a.vtp"), "--iso", 1)

    def test_what_is_no_picture(self):
        for suffix, kind in (("vtr", "a rectilinear grid"), ("vtu", "an unstructured grid"),
                             ("pvts", "a curvilinear grid")):
            self.refused_bytes("a." + suffix, b"<VTKFile/>", kind + ", and no image: resample it")


if __name__ == "__main__":
    unittest.main()
