# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Tests of `volumic --probe`."""

import os

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLImageDataWriter

from command_test_case import (
    ORIGIN, SIZE, SPACING, TURNED, CommandTestCase, ball, make_image, medical_files)
from vtk_files import read


class ProbeTest(CommandTestCase):
    def other(self, name="pet.nii.vti", function=lambda world: world @ (3.0, -2.0, 0.5)):
        """Write a linear function of world coordinates on a rotated grid that covers all of the
        ball but a corner."""
        index = np.stack(np.indices((20, 30, 30))[::-1], axis=-1)
        coordinates = np.array([12., 3., 8.]) + (index * (0.8, 0.7, 0.9)) @ np.asarray(TURNED).T
        return self.write(vtkXMLImageDataWriter(), name,
                          make_image(function(coordinates), (0.8, 0.7, 0.9), (12, 3, 8), TURNED))

    def values(self, *options):
        self.run_command(self.ball_file(), self.path("a.vtp"), "--iso", "500.5", *options)
        surface = read(self.path("a.vtp"))
        points = vtk_to_numpy(surface.GetPoints().GetData()).astype(float)
        return surface, points

    def test_values_at_vertices(self):
        surface, points = self.values("--probe", self.other(), "--probe",
                                      self.other("pet.vti", lambda world: world[..., 0]))
        found = vtk_to_numpy(surface.GetPointData().GetArray("pet"))
        inside = ~np.isnan(found)
        self.assertTrue(0.9 < inside.mean() <= 1)
        np.testing.assert_allclose(found[inside], (points @ (3.0, -2.0, 0.5))[inside], atol=2e-4)
        second = vtk_to_numpy(surface.GetPointData().GetArray("pet-2"))
        np.testing.assert_allclose(second[inside], points[inside, 0], atol=2e-4)

    def test_mean_over_depth(self):
        """The mean of a linear function is its value at half the depth."""
        surface, points = self.values("--probe", self.other(), "--probe-depth", "1.5")
        normals = vtk_to_numpy(surface.GetPointData().GetNormals())
        found = vtk_to_numpy(surface.GetPointData().GetArray("pet"))
        expected = (points - 0.75 * normals) @ (3.0, -2.0, 0.5)
        np.testing.assert_allclose(found[~np.isnan(found)], expected[~np.isnan(found)], atol=2e-3)

    def test_points_outside_and_errors(self):
        far = self.write(vtkXMLImageDataWriter(), "far.vti", make_image(ball(), origin=(1e3, 0, 0)))
        printed = self.run_command(self.ball_file(), self.path("a.vtp"), "--iso", "500.5", "--probe",
                                   far).stderr
        self.assertRegex(printed, r"far.vti: (\d+) of \1 vertices are outside this volume")
        surface = read(self.path("a.vtp"))
        self.assertTrue(np.isnan(vtk_to_numpy(surface.GetPointData().GetArray("far"))).all())
        self.rejects("none.vti: no such file", self.ball_file(), self.path("a.vtp"), "--probe",
                     self.path("none.vti"))
        os.symlink(far, self.path("link.vtp"))
        self.rejects("is the input", self.ball_file(), self.path("link.vtp"), "--probe", far)

    def twice_x(self):
        """Write 2 x as integers on the grid of the ball."""
        return np.broadcast_to(np.rint(2 * (ORIGIN[0] + SPACING[0] * np.arange(SIZE[0]))),
                               SIZE[::-1]).astype("<i2")

    def test_other_space_and_unit(self):
        """Files in LPS and in micrometres yield the same values."""
        form = np.column_stack((np.diag(SPACING), ORIGIN))
        ball_file, micro = (bytearray(medical_files.nifti(voxels, factor * SPACING, factor * form))
                            for voxels, factor in ((ball(), 1), (self.twice_x(), 1000)))
        ball_file[123], micro[123] = 2, 3
        self.write_bytes("a.nii", ball_file)
        self.write_bytes("um.nii", micro)
        header = medical_files.nrrd_header(self.twice_x(), SPACING, ORIGIN * (-1, -1, 1),
                                           np.diag((-1., -1, 1)), "raw", "little")
        self.write_bytes("lps.nrrd", header + b"\n" + self.twice_x().tobytes())
        printed = self.run_command(self.path("a.nii"), self.path("a.vtp"), "--iso", "500.5", "--probe",
                                   self.path("lps.nrrd"), "--probe", self.path("um.nii")).stderr
        self.assertNotIn("lie outside", printed)
        surface = read(self.path("a.vtp"))
        points = vtk_to_numpy(surface.GetPoints().GetData())
        for name in ("lps", "um"):
            np.testing.assert_allclose(vtk_to_numpy(surface.GetPointData().GetArray(name)),
                                       2 * points[:, 0], atol=1e-3)

    def test_labels_of_a_probe_are_not_interpolated(self):
        halves = np.where(self.twice_x() < 0, 3, 7).astype("u1")
        image = make_image(halves)
        probe = self.write(vtkXMLImageDataWriter(), "halves.vti", image)
        self.write_bytes("halves.csv", b"label,name\n3,left\n7,right\n")
        surface, _ = self.values("--probe", probe)
        self.assertEqual(set(np.unique(vtk_to_numpy(surface.GetPointData().GetArray("halves")))),
                         {3, 7})

    def test_labels(self):
        labels = self.write(vtkXMLImageDataWriter(), "labels.vti",
                            make_image((ball() > 500).astype("u1")))
        self.run_command(labels, self.path("o/"), "--labels", "all", "--probe", self.other())
        surface = read(self.path("o/label-1.vtp"))
        self.assertTrue(surface.GetPointData().HasArray("pet"))
        self.run_command(labels, self.path("a.vtp"), "--labels", "all", "--probe", self.other(),
                         "--probe-depth", "1")
        halves = self.write(vtkXMLImageDataWriter(), "two.vti",
                            make_image(np.where(self.twice_x() < 0, 3, 7).astype("u1")))
        self.rejects("--probe-depth requires normals, which the mesh of several labels lacks", halves,
                     self.path("a.vtp"), "--labels", "all", "--probe", self.other(),
                     "--probe-depth", "1")
