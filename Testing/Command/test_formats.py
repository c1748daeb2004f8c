# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Tests that `volumic` finds a ball at its position in several volume formats, and that all mesh
formats store the same surface."""

import os

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkIOGeometry import vtkOBJReader, vtkSTLReader
from vtkmodules.vtkIOImage import vtkPNGWriter
from vtkmodules.vtkIOLegacy import vtkPolyDataReader
from vtkmodules.vtkIOPLY import vtkPLYReader
from vtkmodules.vtkIOXML import vtkXMLImageDataWriter, vtkXMLPolyDataReader
from vtkmodules.vtkFiltersCore import vtkCleanPolyData

from command_test_case import (
    CENTRE, ISO, META, ORIGIN, RADIUS, SIZE, SPACING, TURNED, CommandTestCase, ball, dicom_slice,
    make_image)


class VolumesTest(CommandTestCase):
    def check(self, volume, *options, direction=np.eye(3), origin=ORIGIN):
        """Check position and size of the ball in the report."""
        report = self.report(volume, "--iso", ISO, "--quiet", *options)
        self.assertEqual(report["input"]["dimensions"], SIZE.tolist())
        np.testing.assert_allclose(report["input"]["spacing"], SPACING, rtol=1e-9)
        self.assertEqual((report["components"], report["genus"]), (1, 0))
        centre = origin + direction @ (SPACING * CENTRE)
        np.testing.assert_allclose(report["component_features"][0]["centroid"], centre, atol=0.05)
        whole = 4 / 3 * np.pi * RADIUS ** 3
        # Vertices are on the sphere, triangles inside.
        self.assertTrue(0.94 < report["volume"] / whole < 1.0, report["volume"] / whole)
        return report

    def test_folders_and_patterns(self):
        for name in ("dicom", "png", "one"):
            os.makedirs(self.path(name))
        for k in range(SIZE[2]):
            self.write_bytes(f"dicom/{k}", dicom_slice(k, direction=TURNED))
            # VTK writes the last row first.
            self.write(vtkPNGWriter(), f"png/s{k}.png", make_image(ball("u2")[k:k + 1, ::-1]))
        self.write_bytes("one/a.mha", META + ball().tobytes())
        self.write_bytes("one/a.json", b"{}")
        self.check(self.path("dicom"), direction=TURNED)
        for name in ("png", "png/s*.png", "png/s%d.png"):
            self.check(self.path(name), "--spacing", ",".join(map(str, SPACING)), origin=np.zeros(3))
        self.check(self.path("one"))

    def test_component_and_magnitude(self):
        image = make_image(ball())
        vectors = numpy_to_vtk(np.stack([ball() * 0 + 3, ball()], axis=-1).reshape(-1, 2), deep=True)
        vectors.SetName("vectors")
        image.GetPointData().SetScalars(vectors)
        file = self.write(vtkXMLImageDataWriter(), "a.vti", image)
        report = self.check(file, "--component", "1")
        self.assertEqual(report["input"]["range"], [ball().min(), ball().max()])
        self.check(file)
        self.rejects("no point array none; .* --array: vectors", file, self.path("a.stl"),
                     "--array", "none")
        messages = self.run_command(file, self.path("a.stl"), "--iso", ISO).stderr
        self.assertIn("magnitude of 2 components (--component)", messages)
        self.rejects("component 2 is out of range; the volume has 2 components, 0 to 1", file,
                     self.path("b.stl"), "--component", "2", "--iso", ISO)

    def test_nan_voxels(self):
        voxels = ball("f4")
        voxels[:, :, -2:] = np.nan
        file = self.write(vtkXMLImageDataWriter(), "a.vti", make_image(voxels))
        for way in ([], ["--edge-length", "1.2"]):
            messages = self.run_command(file, self.path("a.stl"), "--iso", ISO, *way).stderr
            self.assertEqual(messages.count(f"{np.isnan(voxels).sum()} NaN voxels"), 1, messages)
        self.rejects("NaN voxels", file, self.path("b.stl"), "--refuse-nan", "--iso", ISO)


class ReportedTest(CommandTestCase):
    def test_coordinates_beyond_single_precision(self):
        far = make_image(ball(), SPACING * 0.1, (500000, 4000000, 300))
        volume = self.write(vtkXMLImageDataWriter(), "a.vti", far)
        messages = self.run_command(volume, self.path("b.vtk"), self.path("b.stl"), "--iso", ISO).stderr
        self.assertRegex(messages, r"warning: .*b.stl: coordinates up to 400000\d are rounded to "
                         r"multiples of 0\.4")
        self.assertNotIn("b.vtk: coordinates", messages)

    def test_padding_is_ignored_by_otsu(self):
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
                         "estimated by Otsu's .*without padding voxels of value -3024")

    def test_iso_values_without_surface_fail(self):
        self.write(vtkXMLImageDataWriter(), "flat.vti", make_image(np.full((12, 12, 12), 4, "u1")))
        self.write(vtkXMLImageDataWriter(), "mask.vti", make_image((ball() > ISO).astype("u1")))
        for name, reason, *options in (
                ("flat.vti", "no value (separates|parts)"),
                ("flat.vti", "no value (separates|parts)((?!set it between).)*$", "--iso", 4),
                ("mask.vti", "at an end of the range", "--iso", 1)):
            self.rejects(reason, self.path(name), self.path("a.vtp"), *options)


class SurfacesTest(CommandTestCase):
    READERS = {"vtp": vtkXMLPolyDataReader, "vtk": vtkPolyDataReader, "stl": vtkSTLReader,
               "ply": vtkPLYReader, "obj": vtkOBJReader}

    def test_all_formats_store_the_same_surface(self):
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
