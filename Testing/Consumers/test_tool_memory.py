# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""With --memory the program reads volumes slab by slab: the same voxels, bit for bit, in little
memory."""

import bz2
import gzip
import json
import os
import unittest
import zlib

import numpy as np
from vtkmodules.vtkIOImage import vtkPNGWriter, vtkTIFFWriter
from vtkmodules.vtkIOLegacy import vtkStructuredPointsWriter
from vtkmodules.vtkIOXML import vtkXMLImageDataWriter

from tool_test_case import ORIGIN, SPACING, TURNED, ToolTestCase, make_image

import medical_files

# Slabs are a 64th of it, so that the volumes below come in several.
LIMIT = "200M"
SIZE = (100, 130, 170)  # slices, rows, columns


def large_ball(dtype="i2"):
    z, y, x = np.ogrid[0:SIZE[0], 0:SIZE[1], 0:SIZE[2]]
    distance = np.sqrt((z - 45.0) ** 2 + (y - 61) ** 2 + (x - 91) ** 2)
    return (1000 - 15 * distance + (3 * x + 5 * y + 7 * z) % 11).astype(dtype)


@unittest.skipUnless(os.path.exists("/proc/self/fd"), "memory is limited on Linux only")
class MemoryTest(ToolTestCase):
    def check(self, volume, *options):
        """The volume is the same file, with a limit and without. Returns what was told."""
        self.run_tool(volume, "-q", "--write-volume", self.path("whole.vti"), *options)
        told = self.run_tool(volume, "--write-volume", self.path("slabs.vti"), *options,
                             "--memory", LIMIT, "--scratch", self.folder_of_scratch()).stderr
        self.assertEqual(self.content("whole.vti"), self.content("slabs.vti"))
        self.assertEqual(os.listdir(self.folder_of_scratch()), [])
        return told

    def folder_of_scratch(self):
        folder = self.path("scratch")
        os.makedirs(folder, exist_ok=True)
        return folder

    def test_vtk_xml(self):
        image = make_image(large_ball(), direction=TURNED)
        for way in ("SetDataModeToAppended", "SetDataModeToBinary"):
            writer = vtkXMLImageDataWriter()
            getattr(writer, way)()
            writer.SetEncodeAppendedData(False)
            self.assertNotIn("whole", self.check(self.write(writer, "a.vti", image)))

    def test_meta_image(self):
        header = medical_files.meta_header(large_ball(), SPACING, ORIGIN, "0 1 0 -1 0 0 0 0 1")
        self.check(self.write_bytes("a.mha", header + large_ball().tobytes()))
        big = header.replace(b"MSB = False", b"MSB = True").replace(b"LOCAL", b"a.raw")
        self.write_bytes("a.raw", large_ball(">i2").tobytes())
        self.check(self.write_bytes("b.mhd", big))
        for k, plane in enumerate(large_ball()):
            self.write_bytes(f"{k}.raw", b"skip" + plane.tobytes())
        several = header.replace(b"ElementDataFile = LOCAL", b"HeaderSize = 4\nElementDataFile = "
                                 b"%%d.raw 0 %d 1" % (SIZE[0] - 1))
        self.assertNotIn("whole", self.check(self.write_bytes("d.mhd", several)))
        voxels = self.content("slabs.vti")
        self.check(self.path("a.mha"))
        self.assertEqual(self.content("slabs.vti"), voxels)
        packed = zlib.compress(large_ball().tobytes(), 1)
        zipped = header.replace(b"CompressedData = False", b"CompressedData = True\n"
                                b"CompressedDataSize = %d" % len(packed))
        self.check(self.write_bytes("c.mha", zipped + packed))
        for k, plane in enumerate(large_ball()):
            self.write_bytes(f"{k}.zraw", zlib.compress(plane.tobytes(), 1))
        zipped = header.replace(b"CompressedData = False", b"CompressedData = True")
        names = "".join(f"{k}.zraw\n" for k in range(SIZE[0])).encode()
        for data in (b"%%d.zraw 0 %d 1" % (SIZE[0] - 1), b"LIST\n" + names):
            self.check(self.write_bytes("e.mhd", zipped.replace(b"LOCAL", data)))
            self.assertEqual(self.content("slabs.vti"), voxels)

    def test_nrrd(self):
        for encoding, code in (("raw", bytes), ("gzip", lambda data: gzip.compress(data, 1)),
                               ("bzip2", lambda data: bz2.compress(data, 1))):
            header = medical_files.nrrd_header(
                large_ball(), SPACING, ORIGIN, TURNED, encoding, "big")
            self.assertNotIn("whole", self.check(self.write_bytes(
                "a.nrrd", header + b"\n" + code(large_ball(">i2").tobytes()))))

    def test_nifti(self):
        for qfac in (1, -1):
            content = medical_files.nifti(
                large_ball(), SPACING, qfac=qfac, offset=ORIGIN, slope=0.5, intercept=-100)
            self.check(self.write_bytes("a.nii", content))
        self.check(self.write_bytes("b.nii.gz", gzip.compress(content, 1)))

    def test_dicom_series(self):
        voxels = large_ball("u2")
        for k, name in enumerate(np.random.default_rng(1).permutation(SIZE[0])):
            self.write_bytes(f"IM{name:03}.dcm", medical_files.dicom_slice(
                voxels[k], k, SPACING, ORIGIN, TURNED, slope="1", intercept="-24"))
        self.check(self.path("IM*.dcm"))

    def test_pictures(self):
        voxels = large_ball("u2")
        for k, plane in enumerate(voxels):
            self.write(vtkPNGWriter(), f"slice{k}.png", make_image(plane[np.newaxis]))
        self.check(self.path("*.png"), "--spacing", "1,1,2")
        self.check(self.write(vtkTIFFWriter(), "pages.tif", make_image(voxels)))

    def test_a_disk_that_has_not_kept_the_room_that_it_promised(self):
        volume = self.write(vtkXMLImageDataWriter(), "a.vti", make_image(large_ball()))
        environment = {**os.environ, "LD_PRELOAD": os.environ["VOLUMIC_NO_ROOM"]}
        process = self.run_tool(volume, self.path("x.stl"), "--memory", LIMIT, "--scratch",
                                self.folder_of_scratch(), "--iso", 100, status=1, env=environment)
        self.assertRegex(process.stderr, "volumic: the scratch directory .*scratch can't keep what "
                         "was put there: its disk is full, or fails.*--scratch")

    def test_what_is_read_as_a_whole_is_told(self):
        file = self.write(vtkStructuredPointsWriter(), "a.vtk", make_image(large_ball()))
        self.assertRegex(self.check(file), r"a\.vtk: volumes of this kind \(\.vtk\) are read as a "
                         "whole, whatever --memory says")

    def test_the_surface_and_the_report(self):
        """Otsu's threshold, a map of edges and another spacing included."""
        volume = self.write(vtkXMLImageDataWriter(), "a.vti", make_image(large_ball("f8")))
        edges = self.write(vtkXMLImageDataWriter(), "e.vti", make_image(large_ball("u1")))
        options = ("--finest", "2", "--spacing", "1,1,1.5", "--edges", edges,
                   "--edge-attraction", "0.1")
        reports = []
        for name, limit in (("whole", []), ("slabs", ["--memory", LIMIT])):
            self.run_tool(volume, self.path(name + ".ply"), "--report", self.path(name + ".json"),
                          *options, *limit)
            reports.append(json.loads(self.content(name + ".json")))
        self.assertEqual(self.content("whole.ply"), self.content("slabs.ply"))
        memory = [report["memory"] for report in reports]
        for report in reports:
            for changing in ("seconds", "levels", "properties", "memory"):
                del report[changing]
        self.assertEqual(*reports)
        self.assertGreater(memory[0]["reader"], 150)
        self.assertLess(memory[1]["reader"], 768)
        for each in memory:
            self.assertLessEqual(each["reader"], each["peak"])


if __name__ == "__main__":
    unittest.main()
