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
from vtkmodules.vtkIOImage import vtkPNGWriter, vtkTIFFWriter
from vtkmodules.vtkIOXML import vtkXMLImageDataReader, vtkXMLImageDataWriter

from command_test_case import (
    ISO, META, ORIGIN, SIZE, SPACING, CommandTestCase, ball, dicom_slice, make_image, nrrd_header)

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

    def test_dicom_without_pixel_spacing(self):
        for k in range(SIZE[2]):
            content = dicom_slice(k)
            at = content.index(struct.pack("<HH", 0x28, 0x30))
            length, = struct.unpack_from("<H", content, at + 6)
            value = content[at:at + 8 + length]
            content = content[:at] + content[at + 8 + length:]
            before = content.index(struct.pack("<HH", 0x20, 0x32))
            imager = struct.pack("<HH", 0x18, 0x1164) + value[4:]
            for name, more in (("with", imager), ("without", b"")):
                os.makedirs(self.path(name), exist_ok=True)
                self.write_bytes(f"{name}/IM{k:02}", content[:before] + more + content[before:])
        self.assertRegex(self.warning("with"), "Imager Pixel Spacing, 0.75 x 0.5, .* is taken")
        np.testing.assert_allclose(self.report(
            self.path("with"), "--iso", ISO, "-q")["input"]["spacing"], SPACING)
        self.assertRegex(self.warning("without"), "no Pixel Spacing; 1 x 1 is taken")

    def test_far_from_the_origin(self):
        far = make_image(ball(), SPACING * 0.1, (500000, 4000000, 300))
        self.write(vtkXMLImageDataWriter(), "a.vti", far)
        self.assertEqual(self.warning("a.vti", self.path("b.vtk")), "")
        self.assertRegex(self.warning("a.vti", self.path("b.stl")),
                         r"b.stl: coordinates up to 400000\d are rounded there by steps of 0\.4")


class TiffTest(ToldTest):
    def described(self, name, description, resolution=(2, 1), pages=None, isone=False):
        """A volume of pages whose first one, or which as one, has a description and a resolution."""
        pages = ball("u2") if pages is None else pages
        content, link = bytearray(b"II*\0\0\0\0\0"), 4
        for plane in pages[:1] if isone else pages:
            place = len(content)
            content += pages.tobytes() if isone else plane.tobytes()
            texts = len(content)
            content += struct.pack("<II", *resolution) + description + b"\0" * (1 + len(description) % 2)
            entries = [(256, 4, 1, SIZE[0]), (257, 4, 1, SIZE[1]), (258, 3, 1, 16), (259, 3, 1, 1),
                       (262, 3, 1, 1), (270, 2, len(description) + 1, texts + 8), (273, 4, 1, place),
                       (277, 3, 1, 1), (278, 4, 1, SIZE[1]), (279, 4, 1, 2 * SIZE[0] * SIZE[1]),
                       (282, 5, 1, texts), (283, 5, 1, texts)]
            struct.pack_into("<I", content, link, len(content))
            content += struct.pack("<H", len(entries))
            content += b"".join(struct.pack("<HHII", *entry) for entry in entries)
            link = len(content)
            content += bytes(4)
        self.write_bytes(name, bytes(content))

    def spacing(self, name):
        return self.report(self.path(name), "--iso", ISO, "-q")["input"]["spacing"]

    def test_imagej(self):
        self.described("a.tif", b"ImageJ=1.53c\nimages=18\nslices=18\nspacing=2.5\nloop=false\n")
        self.assertEqual(self.spacing("a.tif"), [0.5, 0.5, 2.5])
        self.described("a.tif", b"some program")
        self.assertEqual(self.spacing("a.tif"), [1, 1, 1])
        self.described("b.tif", b"ImageJ=1.53c\nimages=18\nchannels=2\nslices=9\n")
        self.refused_volume("b.tif", "no vector .channels.; choose one with --component N, 0 to 1")
        self.described("c.tif", b"ImageJ=1.53c\nimages=18\nchannels=4\nslices=9\n")
        self.refused_volume("c.tif", "4 channels and 1 times, of which its 18 pages are no multiple")
        self.described("c.tif", b"ImageJ=1.53c\nimages=18\nslices=18\n", pages=ball("u2")[:1])
        self.refused_volume("c.tif", "the file is cut off: 18 images are told of")

    def test_imagej_with_all_images_in_one_page(self):
        twice = np.repeat(ball("u2"), 2, 0)
        for name, text, pages in (("a.tif", b"images=18\nslices=18", ball("u2")),
                                  ("b.tif", b"images=36\nchannels=2\nslices=18", twice)):
            self.described(name, b"ImageJ=1.53c\n" + text + b"\n", pages=pages)
            self.described("c.tif", b"ImageJ=1.53c\n" + text + b"\n", pages=pages, isone=True)
            for way in ((), ("--memory", "200M")):
                options = ("--component", "1", *way) if pages is twice else way
                np.testing.assert_allclose(
                    self.centre("c.tif", *options), self.centre(name, *options), atol=1e-6)

    def test_ome(self):
        head = (b'<?xml version="1.0"?><OME><Image><Pixels DimensionOrder="%s" SizeC="%d" SizeT="%d" '
                b'PhysicalSizeX="0.5" '
                b'PhysicalSizeY="0.25" PhysicalSizeZ="2"/></Image></OME>')
        self.described("a.tif", head % (b"XYZCT", 1, 1))
        self.assertEqual(self.spacing("a.tif"), [0.5, 0.25, 2])
        for order, pages in ((b"XYCZT", np.repeat(ball("u2"), 2, 0)), (b"XYZTC", np.tile(
                ball("u2"), (2, 1, 1)))):
            pages[1 if order == b"XYCZT" else SIZE[2]] += 1
            self.described("b.tif", head % (order, 2, 1), pages=pages)
            self.refused_volume("b.tif", "the 2 numbers of each voxel are no vector .channels.")
            there = self.centre("a.tif")
            np.testing.assert_allclose(self.centre("b.tif", "--component", "0"), there, atol=1e-6)
            np.testing.assert_allclose(
                self.centre("b.tif", "--component", "1", "--memory", "200M"), there, atol=1e-2)
            self.described("c.tif", head % (order.replace(b"C", b"?").replace(b"T", b"C").replace(
                b"?", b"T"), 1, 2), pages=pages)
            self.refused_volume("c.tif", "2 volumes, one behind the other .*; choose one with --time N")
            np.testing.assert_allclose(self.centre("c.tif", "--time", "0"), there, atol=1e-6)

    def test_the_same_stack_in_two_formats(self):
        for name, writer in (("png", vtkPNGWriter()), ("tif", vtkTIFFWriter())):
            os.makedirs(self.path(name))
            for k, plane in enumerate(ball("u2")):
                # VTK's writers write the last row first.
                self.write(writer, f"{name}/{k:02}.{name}", make_image(plane[np.newaxis, ::-1]))
        self.described("a.tif", b"pages")
        there = self.centre("a.tif")
        np.testing.assert_allclose(self.centre("png"), there, atol=1e-6)
        np.testing.assert_allclose(self.centre("tif"), there, atol=1e-6)


class ValuesTest(ToldTest):
    def test_bytes_of_mrc(self):
        self.write_bytes("a.mrc", medical_files.mrc((ball() // 8 - 60).astype("i1"), SPACING, 0))
        said = self.run_command(self.path("a.mrc"), self.path("a.vtp"), "--iso", 2).stderr
        self.assertIn("signed char, -60 to 47", said)
        content = bytearray(medical_files.mrc((ball() // 8).astype("u1"), SPACING, 0))
        struct.pack_into("<II", content, 152, 1146047817, 0)
        self.write_bytes("b.mrc", bytes(content))
        self.assertIn("unsigned char, 0 to 107", self.run_command(
            self.path("b.mrc"), self.path("a.vtp"), "--iso", 60).stderr)
        self.refused_bytes("c.mrc", medical_files.mrc(ball("u1"), SPACING, 101),
                           "mode 101, .* not read; write them as mode 2")

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
