# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Examples/Python/read_volume.py refuses what has been cut off or damaged, and names the file."""

import bz2
import gzip
import os
import struct
import sys
import unittest

import numpy as np
from vtkmodules.vtkIOImage import vtkMetaImageWriter
from vtkmodules.vtkIOXML import vtkXMLImageDataWriter

import medical_files
from damage_test_case import DamageTestCase
from examples_path import EXAMPLES

sys.path.insert(0, EXAMPLES)
# pylint: disable=wrong-import-position
from read_volume import read_volume
from volume_image import VolumeError, make_image

SPACING, ORIGIN = (0.5, 1.25, 2.0), (-7.0, 8.0, 9.5)
VOXELS = np.random.default_rng(7).integers(0, 700, (9, 12, 15)).astype("i2")
BYTES = VOXELS.size * 2


class DamagedTest(DamageTestCase):
    def bytes_of(self, writer, name):
        """What the writer writes of the volume."""
        self.write(writer, name, make_image(VOXELS, SPACING))
        return self.content(name)

    def accepted_file(self, name, content):
        read_volume(self.write_bytes(name, content))

    def refused_file(self, name, content, reason):
        path = self.write_bytes(name, content)
        with self.assertRaisesRegex(VolumeError, reason) as caught:
            read_volume(path)
        self.assertIn(path, str(caught.exception))


class FilesTest(DamagedTest):
    def test_raw_meta_image(self):
        writer = vtkMetaImageWriter()
        writer.SetCompression(False)
        self.cut("a.mha", self.bytes_of(writer, "a.mha"), "cut off: it has .* its header asks for")

    def test_packed_meta_image(self):
        content = self.bytes_of(vtkMetaImageWriter(), "a.mha")
        self.cut("a.mha", content, "packed data are cut off", rests=(0.5, -10, -1))
        self.flipped("a.mha", content, "packed data", content.index(b"LOCAL") + 10)

    def test_meta_image_in_several_files(self):
        header = medical_files.meta_header(VOXELS, SPACING, ORIGIN, "1 0 0 0 1 0 0 0 1")
        for k, plane in enumerate(VOXELS):
            self.write_bytes(f"{k + 1}.raw", plane.tobytes())
        names = "".join(f"{k + 1}.raw\n" for k in range(len(VOXELS))).encode()
        headers = {"a.mhd": header.replace(b"LOCAL", b"LIST") + names,
                   "b.mhd": header.replace(b"LOCAL", b"%d.raw 1 9 1")}
        for name, content in headers.items():
            read_volume(self.write_bytes(name, content))
        self.write_bytes("7.raw", b"half")
        for name, content in headers.items():
            self.refused_file(name, content, "7.raw is cut off")
        os.remove(os.path.join(self.folder, "7.raw"))
        for name, content in headers.items():
            self.refused_file(name, content, "7.raw cannot be opened")

    def test_meta_image_as_text(self):
        header = medical_files.meta_header(VOXELS, SPACING, ORIGIN, "1 0 0 0 1 0 0 0 1")
        # VTK 9.6 wants something behind the last value.
        text = " ".join(map(str, VOXELS.ravel())).encode() + b"\n"
        self.cut("a.mha", header.replace(b"BinaryData = True", b"BinaryData = False") + text,
                 "values, its header asks for 1620")

    def test_vtk_xml(self):
        content = self.bytes_of(vtkXMLImageDataWriter(), "a.vti")
        self.cut("a.vti", content, "cannot be read", rests=(0.5, -100))

    def test_nrrd(self):
        header = medical_files.nrrd_header(VOXELS, SPACING, ORIGIN, np.eye(3), "gzip", "little")
        content = header + b"\n" + gzip.compress(VOXELS.tobytes())
        self.cut("a.nrrd", content, "packed data are cut off", rests=(0.5, -10, -1))
        self.flipped("a.nrrd", content, "packed data", len(header) + 11)
        more = header + b"\n" + gzip.compress(VOXELS.tobytes() + b"more")
        self.refused_file("a.nrrd", more, f"give more than the {BYTES} bytes")
        bomb = header + b"\n" + gzip.compress(bytes(100 << 20))
        self.refused_file("a.nrrd", bomb, f"give more than the {BYTES} bytes")
        halves = gzip.compress(VOXELS.tobytes()[:99]) + gzip.compress(VOXELS.tobytes()[99:])
        read_volume(self.write_bytes("b.nrrd", header + b"\n" + halves))

    def test_nrrd_of_bzip2(self):
        header = medical_files.nrrd_header(VOXELS, SPACING, ORIGIN, np.eye(3), "bzip2", "little")
        content = header + b"\n" + bz2.compress(VOXELS.tobytes())
        self.cut("a.nrrd", content, "packed data are cut off", rests=(0.5, -10, -1))
        self.flipped("a.nrrd", content, "packed data", len(header) + 1)
        more = header + b"\n" + bz2.compress(VOXELS.tobytes() + b"more")
        self.refused_file("a.nrrd", more, f"give more than the {BYTES} bytes")
        halves = bz2.compress(VOXELS.tobytes()[:99]) + bz2.compress(VOXELS.tobytes()[99:])
        self.accepted_file("b.nrrd", header + b"\n" + halves)

    def test_nifti(self):
        content = medical_files.nifti(VOXELS, SPACING)
        self.cut("a.nii", content, "the file is cut off")
        packed = gzip.compress(content)
        self.cut("a.nii.gz", packed, "packed data are cut off", rests=(0.5, -10, -1))
        self.flipped("a.nii.gz", packed, "packed data|not a NIfTI", 400)
        for kind in (999, 0, 1536):
            header = bytearray(content)
            struct.pack_into("<h", header, 70, kind)
            for name, data in (("a.nii", header), ("a.nii.gz", gzip.compress(header))):
                with self.subTest(name, kind=kind):
                    self.refused_file(name, data, f"the data type {kind} is none")

    def test_invesalius_project(self):
        path = os.path.join(self.folder, "a.inv3")
        medical_files.write_inv3(path, VOXELS, SPACING)
        with open(path, "rb") as file:
            content = file.read()
        self.cut("a.inv3", content, "packed data are damaged or cut off", rests=(0.5, -10, -1))
        self.flipped("a.inv3", content, "packed data are damaged or cut off|archive is damaged", 100)


class SeriesTest(DamagedTest):
    def setUp(self):
        super().setUp()
        for k in range(len(VOXELS)):
            self.write_bytes(f"IM{k}", self.slice(k))

    def slice(self, k, **changes):
        return medical_files.dicom_slice(VOXELS[k], k, SPACING, ORIGIN, np.eye(3), **changes)

    def refused_series(self, reason):
        with self.assertRaisesRegex(VolumeError, reason):
            read_volume(self.folder)

    def test_slices_that_are_cut_off(self):
        for syntax in ("explicit", "implicit"):
            content = self.slice(8, syntax=syntax)
            size = VOXELS[0].size * 2
            for rest in (-1, -100, -size, -size - 6, 300, 200, 140):
                with self.subTest(syntax, rest=rest):
                    self.write_bytes("IM8", content[:rest])
                    self.refused_series("IM8: .*(cut off|header|no pixels)")

    def test_the_last_slice_ends_between_two_elements(self):
        content = self.slice(8)
        self.write_bytes("IM8", content[:content.index(struct.pack("<HH", 0x28, 0x10))])
        self.refused_series("IM8: has no pixels: it is cut off, or no slice")

    def test_pixels_that_are_fewer_than_the_rows(self):
        content = self.slice(3)
        place = content.index(struct.pack("<HH", 0x7FE0, 0x10)) + 8
        short = struct.pack("<I", VOXELS[0].size)
        self.write_bytes("IM3", content[:place] + short + content[place + 4:])
        self.refused_series("IM3: is damaged: it does not end behind its pixels")

    def test_numbers_that_are_none(self):
        for name in ("frames", "slope", "intercept"):
            self.write_bytes("IM3", self.slice(3, **{name: "1A"}))
            self.refused_series(f"IM3: its header is damaged: .*{name}.* '1A'")

    def test_sequences_without_end(self):
        content = self.slice(3)
        place = content.index(struct.pack("<HH", 0x0008, 0x1140)) + 12
        self.write_bytes("IM3", content[:place] + struct.pack(
            "<HHI", 0xFFFE, 0xE000, 0xFFFFFFFF) * 3000)
        self.refused_series("IM3: its header is damaged: sequences within sequences without end")

    def test_reports_and_directories_are_no_slices(self):
        for name, kind in (("DICOMDIR", "1.2.840.10008.1.3.10"),
                           ("SR", "1.2.840.10008.5.1.4.1.1.88.11")):
            content = self.slice(0, kind=kind)
            self.write_bytes(name, content[:content.index(struct.pack("<HH", 0x28, 0x02))])
        self.assertEqual(read_volume(self.folder).GetDimensions(), (15, 12, 9))


if __name__ == "__main__":
    unittest.main()
