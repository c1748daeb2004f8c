# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The program `volumic` finds a ball where it is, whatever the format of the volume; and what it
writes in each mesh format is what VTK reads from there."""

import gzip
import importlib.util
import os
import re
import struct
import unittest
import zlib

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkIOGeometry import vtkOBJReader, vtkSTLReader
from vtkmodules.vtkIOImage import (
    vtkBMPWriter, vtkJPEGWriter, vtkMetaImageWriter, vtkPNGWriter, vtkTIFFWriter)
from vtkmodules.vtkIOLegacy import vtkPolyDataReader, vtkStructuredPointsWriter
from vtkmodules.vtkIOPLY import vtkPLYReader
from vtkmodules.vtkIOXML import vtkXMLImageDataWriter, vtkXMLPolyDataReader
from vtkmodules.vtkFiltersCore import vtkCleanPolyData

from command_test_case import (
    CENTRE, ISO, META, ORIGIN, RADIUS, SIZE, SPACING, TURNED, CommandTestCase, ball, dicom_slice,
    make_image, nrrd_header)

import medical_files


class VolumesTest(CommandTestCase):
    def check(self, volume, *options, direction=np.eye(3), spacing=SPACING, origin=ORIGIN, iso=ISO):
        """The ball of the report lies where the file's geometry puts it, and has its size."""
        report = self.report(volume, "--iso", iso, "--quiet", *options)
        self.assertEqual(report["input"]["dimensions"], SIZE.tolist())
        np.testing.assert_allclose(report["input"]["spacing"], spacing, rtol=1e-9)
        self.assertEqual((report["components"], report["genus"]), (1, 0))
        centre = origin + direction @ (spacing * CENTRE)
        np.testing.assert_allclose(report["component_features"][0]["centroid"], centre, atol=0.05)
        whole = 4 / 3 * np.pi * RADIUS ** 3 * np.prod(spacing / SPACING)
        # Its vertices lie on the sphere, its triangles inside.
        self.assertTrue(0.94 < report["volume"] / whole < 1.0, report["volume"] / whole)
        return report

    def test_vtk_xml(self):
        image = make_image(ball(), direction=TURNED)
        self.check(self.write(vtkXMLImageDataWriter(), "a.vti", image), direction=TURNED)

    def test_vtk_legacy(self):
        self.check(self.write(vtkStructuredPointsWriter(), "a.vtk", make_image(ball())))

    def test_meta_image(self):
        self.check(self.write(vtkMetaImageWriter(), "a.mha", make_image(ball())))
        header = META.replace(b"1 0 0 0 1 0 0 0 1", b"0 1 0 -1 0 0 0 0 1")
        self.check(self.write_bytes("b.mha", header + ball().tobytes()), direction=TURNED)
        # Of four bytes, whatever VTK takes for long.
        header = header.replace(b"MET_SHORT", b"MET_LONG")
        self.check(self.write_bytes("c.mha", header + ball("i4").tobytes()), direction=TURNED)

    def test_nrrd(self):
        for encoding, code in (("raw", bytes), ("gzip", gzip.compress)):
            for endian, order in (("little", "<"), ("big", ">")):
                with self.subTest(encoding=encoding, endian=endian):
                    header = nrrd_header(encoding, endian, TURNED)
                    data = code(ball().astype(order + "i2").tobytes())
                    self.check(self.write_bytes("a.nrrd", header + b"\n" + data), direction=TURNED)

    def test_nrrd_in_two_files_and_as_text(self):
        header = nrrd_header(direction=TURNED)
        self.write_bytes("a.raw", ball().tobytes())
        self.check(self.write_bytes("a.nhdr", header + b"data file: a.raw\n"), direction=TURNED)
        header = nrrd_header("ascii", direction=TURNED)
        text = " ".join(map(str, ball().ravel())).encode()
        self.check(self.write_bytes("b.nrrd", header + b"\n" + text), direction=TURNED)

    def test_nifti_with_its_matrix_and_scale(self):
        matrix = np.column_stack([TURNED * SPACING, ORIGIN])
        content = medical_files.nifti(ball(), SPACING, matrix)
        self.check(self.write_bytes("a.nii", content), direction=TURNED)
        content = medical_files.nifti(ball(), SPACING, offset=ORIGIN, slope=0.5, intercept=-100)
        report = self.check(self.write_bytes("b.nii.gz", gzip.compress(content)),
                            iso=ISO / 2 - 100)
        self.assertEqual(report["input"]["range"],
                         [ball().min() / 2 - 100, ball().max() / 2 - 100])

    def test_invesalius_project(self):
        for dtype in ("int16", "uint8", "float32"):
            with self.subTest(dtype):
                scale = 0.2 if dtype == "uint8" else 1
                voxels = ball(dtype, scale)
                file = self.write_bytes("a.inv3", medical_files.inv3(voxels, SPACING, dtype=dtype))
                report = self.check(file, origin=np.zeros(3), iso=ISO * scale)
                self.assertEqual(report["input"]["range"], [voxels.min(), voxels.max()])
                # The same surface, bit for bit, as of VTK's own format.
                self.run_command(file, self.path("a.ply"), "--iso", ISO * scale)
                self.write(vtkXMLImageDataWriter(), "b.vti", make_image(voxels, origin=np.zeros(3)))
                self.run_command(self.path("b.vti"), self.path("b.ply"), "--iso", ISO * scale)
                surfaces = [self.content(name).split(b"end_header")[1] for name in ("a.ply", "b.ply")]
                self.assertEqual(*surfaces)

    @unittest.skipUnless(importlib.util.find_spec("vtkmodules.vtkIOMINC"), "VTK without MINC")
    def test_minc(self):
        from vtkmodules.vtkIOMINC import vtkMINCImageWriter
        self.check(self.write(vtkMINCImageWriter(), "a.mnc", make_image(ball())))

    def test_dicom_series_in_any_order(self):
        voxels = ball("u2") + 24
        for k, name in enumerate(np.random.default_rng(1).permutation(SIZE[2])):
            self.write_bytes(f"IM{name:03}.dcm", dicom_slice(k, voxels, TURNED, slope="1",
                                                             intercept="-24"))
        report = self.check(self.folder, direction=TURNED)
        self.assertEqual(report["input"]["range"], [ball().min(), ball().max()])
        self.check(self.path("IM000.dcm"), direction=TURNED)
        self.check(self.path("IM*.dcm"), direction=TURNED)

    def write_pictures(self, writer, suffix, voxels):
        for k, plane in enumerate(voxels):
            image = make_image(plane[np.newaxis])
            self.write(writer, f"slice{k}.{suffix}", image)  # slice9 comes before slice10

    def test_pictures_in_a_folder_or_of_a_pattern(self):
        place = {"origin": np.zeros(3), "iso": ISO}
        options = ("--spacing", ",".join(map(str, SPACING)))
        turned = ball("u2")[:, ::-1]  # VTK's writers write the last row first
        self.write_pictures(vtkPNGWriter(), "png", turned)
        self.check(self.folder, *options, **place)
        self.write_pictures(vtkTIFFWriter(), "tif", turned)
        self.refused(r"several kinds.*'\*\.tif'", self.folder, self.path("a.vtp"))
        for pattern in ("slice*.tif", "slice%d.tif", "*.png"):
            with self.subTest(pattern):
                self.check(self.path(pattern), *options, **place)
        self.write_pictures(vtkJPEGWriter(), "jpg", ball("u1", scale=0.2)[:, ::-1])
        self.write_pictures(vtkBMPWriter(), "bmp", ball("u1", scale=0.2)[:, ::-1])
        self.check(self.path("*.jpg"), *options, origin=np.zeros(3), iso=ISO / 5)
        self.check(self.path("*.bmp"), "--component", "0", *options, origin=np.zeros(3), iso=ISO / 5)

    def test_a_folder_with_one_volume(self):
        os.makedirs(self.path("a"))
        self.write_bytes("a/a.mha", META + ball().tobytes())
        self.write_bytes("a/a.json", b"{}")
        self.check(self.path("a"))

    def test_what_lies_beside_pictures(self):
        os.makedirs(self.path("a"))
        for k, plane in enumerate(ball("u2")):
            self.write(vtkPNGWriter(), f"a/{k:02}.png", make_image(plane[np.newaxis]))
        self.write_bytes("a/log.txt", b"bright")
        self.write_bytes("a/Thumbs.db", b"?")
        said = self.run_command(self.path("a"), self.path("a.vtp"), "--iso", ISO).stderr
        self.assertIn("2 files that are not named as pictures are left out", said)

    def test_names_that_end_otherwise(self):
        self.write_bytes("a.1", META + ball().tobytes())
        self.refused("begins like a .mha file: let its name end in .mha", self.path("a.1"),
                     self.path("a.stl"))
        nifti = medical_files.nifti(ball(), SPACING)
        self.write_bytes("b.nii_old", gzip.compress(nifti))
        self.refused("like a .nii file: let its name end in .nii.gz", self.path("b.nii_old"),
                     self.path("a.stl"))
        self.write_bytes("c.nrrd.gz", gzip.compress(nrrd_header() + b"\n" + ball().tobytes()))
        self.refused("packed by gzip: unpack it", self.path("c.nrrd.gz"), self.path("a.stl"))

    def test_what_may_not_be_read(self):
        self.write_bytes("a.mha", META + ball().tobytes())
        os.chmod(self.path("a.mha"), 0)
        os.chmod(self.folder, 0o755)
        user = {"user": 65534} if os.geteuid() == 0 else {}
        self.refused("a.mha: cannot be read: Permission denied", self.path("a.mha"), "--list-labels",
                     **user)

    def test_a_slice_is_no_volume(self):
        header = META.replace(b"NDims = 3", b"NDims = 2").replace(b"26 22 18", b"26 22")
        self.refused("the volume: the image is 2D .26 x 22 x 1", self.write_bytes(
            "a.mha", header + ball()[8].tobytes()), self.path("a.stl"), "--iso", ISO)

    def test_directions_that_are_longer(self):
        self.write_bytes("a.mha", META + ball().tobytes())
        self.write_bytes("b.mha", META.replace(
            b"1 0 0 0 1 0 0 0 1", b"2 0 0 0 2 0 0 0 2").replace(b"0.5 0.75 1.0", b"0.25 0.375 0.5")
            + ball().tobytes())
        reports = [self.report(self.path(name), "--iso", ISO) for name in ("a.mha", "b.mha")]
        self.assertEqual(*(report["volume"] for report in reports))

    def test_packed_maps(self):
        content = medical_files.mrc(ball(), SPACING)
        self.write_bytes("a.map", content)
        self.write_bytes("a.map.gz", gzip.compress(content))
        volumes = [self.report(self.path(name), "--iso", ISO, *way)["volume"] for name, way in (
            ("a.map", ()), ("a.map.gz", ()), ("a.map.gz", ("--memory", "200M")))]
        self.assertEqual(volumes[0], volumes[1])
        self.assertAlmostEqual(volumes[0], volumes[2], delta=0.1)
        self.refused("packed data give 21607 bytes", self.write_bytes("b.map.gz", gzip.compress(content[:-9])),
                     self.path("a.stl"))

    def test_a_picture_with_pages(self):
        # VTK writes the slices of a volume from the last to the first page.
        file = self.write(vtkTIFFWriter(), "a.tif", make_image(ball("u2")))
        report = self.report(file, "--iso", ISO, "--quiet")
        self.assertEqual(report["input"]["dimensions"], SIZE.tolist())
        self.assertEqual((report["components"], report["genus"]), (1, 0))

    def test_a_component_or_the_magnitude(self):
        image = make_image(ball())
        vectors = numpy_to_vtk(np.stack([ball() * 0 + 3, ball()], axis=-1).reshape(-1, 2), deep=True)
        vectors.SetName("vectors")
        image.GetPointData().SetScalars(vectors)
        file = self.write(vtkXMLImageDataWriter(), "a.vti", image)
        report = self.check(file, "--component", "1")
        self.assertEqual(report["input"]["range"], [ball().min(), ball().max()])
        self.check(file)
        self.refused("no point array none; point arrays: vectors", file, self.path("a.stl"),
                     "--array", "none")
        told = self.run_command(file, self.path("a.stl"), "--iso", ISO).stderr
        self.assertIn("magnitude of 2 components (--component)", told)
        told = self.run_command(file, self.path("b.stl"), "--component", "2", "--iso", ISO, status=1)
        self.assertIn("--component is 2, but array 'vectors' has 2 components", told.stderr)
        self.assertIn("component 2 of 2 components (--component)\n", told.stderr)  # and no range

    def test_nan_voxels_are_told_or_refused(self):
        voxels = ball("f4")
        voxels[:, :, -2:] = np.nan
        file = self.write(vtkXMLImageDataWriter(), "a.vti", make_image(voxels))
        self.check(file)
        for way in ([], ["--edge-length", "1.2"]):
            told = self.run_command(file, self.path("a.stl"), "--iso", ISO, *way).stderr
            self.assertEqual(told.count(f"{np.isnan(voxels).sum()} NaN voxels"), 1, told)
        self.refused("NaN voxels", file, self.path("b.stl"), "--refuse-nan", "--iso", ISO)

    def test_bad_volumes(self):
        self.refused("no such file", self.path("missing.vti"), self.path("a.stl"))
        self.refused("suffix", self.write_bytes("a.vti", b"not an image"), self.path("a.stl"))
        self.refused("a.xyz.*not a format", self.write_bytes("a.xyz", b"?"), self.path("a.stl"))
        said = self.run_command(self.path("a.xyz"), self.path("a.stl"), status=1).stderr
        self.assertEqual(len(said.splitlines()), 1, "readers that were asked complain: " + said)
        content = nrrd_header("gzip") + b"\nnothing but this text"
        self.refused("damaged", self.write_bytes("a.nrrd", content), self.path("a.stl"))
        header = nrrd_header(direction=np.array([[1, 0.5, 0], [0, 1, 0], [0, 0, 1]]))
        self.refused("right angles", self.write_bytes("b.nrrd", header + b"\n" + ball().tobytes()),
                     self.path("a.stl"), "--no-resampling")
        self.refused("no value separates", self.write(
            vtkXMLImageDataWriter(), "flat.vti", make_image(0 * ball())), self.path("a.stl"))
        self.assertFalse(os.path.exists(self.path("a.stl")))

    def test_bad_series(self):
        for k in (0, 1, 2, 5, 6):
            self.write_bytes(f"IM{k}", dicom_slice(k, direction=TURNED))
        self.refused("some are missing", self.folder, self.path("a.stl"), "--no-resampling")
        self.write_bytes("IM5", medical_files.dicom_slice(ball()[0], 1, SPACING, ORIGIN, TURNED))
        self.refused("lies where .* does", self.folder, self.path("a.stl"))


class PalettesTest(CommandTestCase):
    COLOURS = bytes([0, 0, 0, 250, 0, 0, 0, 0, 0, 250, 0, 0])  # the same one twice

    def png(self, plane, bits):
        def chunk(kind, data):
            return struct.pack(">I", len(data)) + kind + data + struct.pack(
                ">I", zlib.crc32(kind + data))

        rows = plane if bits == 8 else plane[:, ::2] << 4 | plane[:, 1::2]
        rows = b"".join(b"\0" + row.astype("u1").tobytes() for row in rows)
        return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(
            ">IIBBBBB", *plane.shape[::-1], bits, 3, 0, 0, 0)) + chunk(b"PLTE", self.COLOURS) + chunk(
                b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")

    def bmp(self, plane, isgrey=False):
        padded = np.pad(plane[::-1], ((0, 0), (0, -plane.shape[1] % 4)))
        start, colours = 54 + 1024, bytearray(1024)
        colours[4:16] = 0, 0, 250, 0, 0, 0, 0, 0, 0, 0, 250, 0
        colours = np.arange(256, dtype="<u4") * 0x10101 if isgrey else colours
        return b"BM" + struct.pack(
            "<IHHIIiiHHIIiiII", start + padded.size, 0, 0, start, 40, *plane.shape[::-1], 1, 8, 0, 0,
            0, 0, 0, 0) + bytes(colours) + padded.astype("u1").tobytes()

    def test_grey_values(self):
        os.makedirs(self.path("a"))
        for k, plane in enumerate(ball() // 4):
            self.write_bytes(f"a/{k:02}.bmp", self.bmp(plane, isgrey=True))
        said = self.run_command(self.path("a"), self.path("a.vtp"), "--iso", "125").stderr
        self.assertIn("x 1, unsigned char, 0 to 215", said)

    def test_labels_are_the_numbers_of_the_palette(self):
        labels = (ball() > ISO).astype("u1")
        labels[:8] *= 3
        for kind, suffix, write in (("png", "png", lambda plane: self.png(plane, 8)),
                                    ("half", "png", lambda plane: self.png(plane, 4)),
                                    ("bmp", "bmp", self.bmp)):
            os.makedirs(self.path(kind))
            for k, plane in enumerate(labels):
                self.write_bytes(f"{kind}/{k:02}.{suffix}", write(plane))
            said = self.run_command(self.path(kind), "--list-labels").stdout
            counts = re.findall(r"(?m)^ *(\d+) +(\d+) ", said)
            self.assertEqual(counts, [(str(n), str((labels == n).sum())) for n in (1, 3)], kind)
        said = self.run_command(self.path("png"), self.path("a.vtp"), "--iso", "60").stderr
        self.assertIn("the colours of its palette are taken; --labels takes the numbers", said)


class TableTest(unittest.TestCase):
    def test_documented_suffixes_are_those_of_the_reader_and_of_the_manual(self):
        root = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")

        def text(*path):
            with open(os.path.join(root, *path), encoding="utf-8") as file:
                return file.read()

        # Chosen by content: TIFF and pictures.
        code = text("Applications", "volumic", "ReadVolume.cxx").split("> openers = {")[1]
        read = set(re.findall(r'"(\.[a-z0-9.]+)"', code[:code.index("  };")]))
        rows = re.findall(r"(?m)^\| (.*?) \|", text("Documentation", "formats.md"))
        documented = {name for row in rows for name in re.findall(r"`(\.[a-z0-9.]+)`", row)}
        self.assertEqual(documented - {".tif", ".tiff", ".lsm", ".png", ".jpg", ".bmp", ".pgm"}, read)
        manual = text("Applications", "volumic", "volumic.1")
        listed = " ".join(re.findall(r"(?m)^\.It (\..*)", manual)).replace(",", "").split()
        self.assertEqual(read - set(listed), set())


class SurfacesTest(CommandTestCase):
    READERS = {"vtp": vtkXMLPolyDataReader, "vtk": vtkPolyDataReader, "stl": vtkSTLReader,
               "ply": vtkPLYReader, "obj": vtkOBJReader}

    def test_each_format_holds_the_same_surface(self):
        names = [self.path(f"a.{suffix}") for suffix in self.READERS]
        report = self.report(self.ball_file(), "--iso", ISO, *names)
        for suffix, reader_class in self.READERS.items():
            with self.subTest(suffix):
                reader = reader_class()
                reader.SetFileName(self.path(f"a.{suffix}"))
                clean = vtkCleanPolyData()  # STL has the points of each triangle
                clean.SetInputConnection(reader.GetOutputPort())
                clean.SetTolerance(0.0)
                clean.Update()
                surface = clean.GetOutput()
                self.assertEqual(surface.GetNumberOfPolys(), report["triangles"])
                self.assertEqual(surface.GetNumberOfPoints(), report["vertices"])
                centre = np.array(surface.GetCenter())
                np.testing.assert_allclose(centre, ORIGIN + SPACING * CENTRE, atol=0.1)


if __name__ == "__main__":
    unittest.main()
