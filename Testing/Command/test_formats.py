# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The program `volumic` finds a ball where it is, whatever the format of the volume; and what it
writes in each mesh format is what VTK reads from there."""

import gzip
import importlib.util
import os
import re
import unittest

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkIOGeometry import vtkOBJReader, vtkSTLReader
from vtkmodules.vtkIOImage import vtkMetaImageWriter
from vtkmodules.vtkIOLegacy import vtkPolyDataReader, vtkStructuredPointsWriter
from vtkmodules.vtkIOPLY import vtkPLYReader
from vtkmodules.vtkIOXML import vtkXMLImageDataWriter, vtkXMLPolyDataReader
from vtkmodules.vtkFiltersCore import vtkCleanPolyData

from command_test_case import (
    CENTRE, ISO, META, ORIGIN, RADIUS, SIZE, SPACING, TURNED, CommandTestCase, ball, make_image,
    nrrd_header)

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

    def test_a_folder_with_one_volume(self):
        os.makedirs(self.path("a"))
        self.write_bytes("a/a.mha", META + ball().tobytes())
        self.write_bytes("a/a.json", b"{}")
        self.check(self.path("a"))

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
