# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""`volumic --write-volume` writes the volume as it was read, `--list-files` tells of its files."""

import json
import os
import unittest

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLImageDataWriter

from limited_files import largest_file
from command_test_case import (
    ORIGIN, SIZE, SPACING, TURNED, CommandTestCase, ball, dicom_slice, make_image, nrrd_header)

from vtk_files import read


class WrittenVolumeTest(CommandTestCase):
    def nrrd(self):
        return self.write_bytes("a.nrrd",
                                nrrd_header(direction=TURNED) + b"\n" + ball().tobytes())

    def written(self, volume, *options):
        """The volume that is written, and that nothing else is."""
        path = self.path("written.vti")
        before = set(os.listdir(self.folder))
        process = self.run_command(volume, "--write-volume", path, *options)
        self.assertNotIn("iso-value", process.stderr)
        self.assertEqual(set(os.listdir(self.folder)) - before, {"written.vti"})
        return read(path)

    def test_voxels_and_place_are_those_of_the_file(self):
        image = self.written(self.nrrd())
        voxels = vtk_to_numpy(image.GetPointData().GetScalars())
        np.testing.assert_array_equal(voxels.reshape(SIZE[::-1]), ball())
        self.assertEqual(voxels.dtype, np.int16)
        np.testing.assert_allclose(image.GetSpacing(), SPACING)
        np.testing.assert_allclose(image.GetOrigin(), ORIGIN)
        matrix = image.GetDirectionMatrix()
        np.testing.assert_allclose(
            [[matrix.GetElement(r, c) for c in range(3)] for r in range(3)], TURNED)
        self.assertEqual(image.GetFieldData().GetAbstractArray("Axes").GetValue(0), "LPS")

    def test_all_arrays_are_kept_and_the_chosen_one_is_active(self):
        image = make_image(ball())
        other = numpy_to_vtk(ball("f4").ravel(), deep=True)
        other.SetName("other")
        image.GetPointData().AddArray(other)
        written = self.written(self.write(vtkXMLImageDataWriter(), "a.vti", image),
                               "--array", "other", "--spacing", "1,2,3")
        self.assertEqual(written.GetPointData().GetScalars().GetName(), "other")
        self.assertTrue(written.GetPointData().HasArray("density"))
        self.assertEqual(written.GetSpacing(), (1, 2, 3))

    def test_what_cannot_be_written(self):
        volume = self.ball_file()
        self.refused("a volume is written as .vti", volume, "--write-volume", "a.mha", status=2)
        self.refused("there is no folder", volume, "--write-volume", self.path("none/a.vti"))
        before = self.content("ball.vti")
        self.refused("ball.vti: cannot be written: it is the input", volume, "--write-volume", volume)
        self.write_bytes("old.vti", b"older")
        self.refused("old.vti: cannot be written|old.vti cannot be written", volume,
                     "--write-volume", self.path("old.vti"), preexec_fn=largest_file(1000))
        self.assertEqual((self.content("ball.vti"), self.content("old.vti")), (before, b"older"))


class ResampledVolumeTest(CommandTestCase):
    def resampled(self, image, *options):
        path = self.path("resampled.vti")
        process = self.run_command(self.write(vtkXMLImageDataWriter(), "a.vti", image),
                                "--write-volume", path, *options)
        self.assertIn("resampled from", process.stderr)
        return read(path)

    def test_values_are_linear_between_voxels_wherever_these_lie(self):
        """A linear function of the world stays what it is, but in the outer halves of voxels."""
        z, y, x = np.indices((7, 12, 9))
        steps = np.asarray(TURNED) * SPACING
        world = np.asarray(ORIGIN) + np.stack([x, y, z], axis=-1) @ steps.T
        slope = (3.0, -2.0, 0.5)
        image = make_image((world @ slope).astype("f4"), direction=TURNED)
        written = self.resampled(image, "--resample", "0.31,0.7,0.4")
        self.assertEqual(written.GetSpacing(), (0.31, 0.7, 0.4))
        for axis, size in enumerate((9, 12, 7)):
            length = size * SPACING[axis]
            left = length - written.GetDimensions()[axis] * written.GetSpacing()[axis]
            self.assertLessEqual(abs(left), 0.5 * written.GetSpacing()[axis] + 1e-9)
        np.testing.assert_allclose(written.GetCenter(), image.GetCenter(), atol=1e-6)
        values = vtk_to_numpy(written.GetPointData().GetScalars())
        bounds = np.reshape(image.GetBounds(), (3, 2))
        inside = 0
        for i in range(0, written.GetNumberOfPoints(), 7):
            place = np.array(written.GetPoint(i))
            if np.all(place > bounds[:, 0]) and np.all(place < bounds[:, 1]):
                self.assertAlmostEqual(values[i], place @ slope, delta=2e-4)
                inside += 1
        self.assertGreater(inside, 50)

    def test_labels_are_those_of_the_nearest_voxel(self):
        labels = np.random.default_rng(3).integers(0, 9, (6, 12, 14)).astype("u2")
        image = make_image(labels)
        image.SetSpacing(0.5, 0.5, 1.5)
        written = self.resampled(image, "--isotropic", "--labels", "all")
        self.assertEqual(written.GetDimensions(), (14, 12, 18))
        scalars = vtk_to_numpy(written.GetPointData().GetScalars())
        self.assertEqual(scalars.dtype, labels.dtype)
        np.testing.assert_array_equal(scalars.reshape(18, 12, 14), labels.repeat(3, axis=0))

    def test_a_few_slices_have_a_surface(self):
        z, y, x = np.indices((7, 30, 30))
        image = make_image((100 - 10 * np.hypot(np.hypot(x - 15, y - 15), 4 * (z - 3))).astype("i2"))
        image.SetSpacing(1, 1, 4)
        volume = self.write(vtkXMLImageDataWriter(), "a.vti", image)
        process = self.run_command(
            volume, self.path("a.vtp"), "--iso", "0", "--report", self.path("a.json"))
        self.assertIn("resampled from 30 x 30 x 7 voxels of 1 x 1 x 4: a surface needs 8 voxels",
                      process.stderr)
        report = json.loads(self.content("a.json"))
        self.assertIn("resampled from 30 x 30 x 7 voxels", report["input"]["resampling"])
        self.assertEqual(report["genus"], 0)
        self.assertAlmostEqual(report["volume"], 4 / 3 * np.pi * 10 ** 3, delta=300)

    def test_what_excludes_it(self):
        volume = self.ball_file()
        for reason, *options in (
                ("--memory and --isotropic exclude", "--memory", "300M", "--isotropic"),
                ("--edges and --resample exclude", "--edges", "density", "--resample", "1,1,1"),
                ("--resample and --isotropic exclude", "--resample", "1,1,1", "--isotropic"),
                ("--resample: distances of voxels are more than 0", "--resample", "1,0,1")):
            with self.subTest(reason):
                self.refused(reason, volume, self.path("a.vtp"), *options, status=2)
        self.refused("resampled it would have .* voxels", volume, self.path("a.vtp"),
                     "--resample", "1e-6,1e-6,1e-6")


class RegionTest(WrittenVolumeTest):
    def world(self, *index):
        return ORIGIN + np.asarray(TURNED) @ (SPACING * index)

    def test_these_voxels_at_their_places(self):
        volume, voxels = self.nrrd(), ball()[4:12, 3:15, 5:21]
        corners = np.array([self.world(5, 3, 4), self.world(20, 14, 11)])
        box = np.sort(corners, axis=0) + [[.1], [-.1]]
        for options in (("--region", "5,20,3,14,4,11"),
                        ("--region-box", ",".join(map(str, box.T.ravel())))):
            image = self.written(volume, *options)
            found = vtk_to_numpy(image.GetPointData().GetScalars())
            np.testing.assert_array_equal(found.reshape(voxels.shape), voxels)
            np.testing.assert_allclose(image.GetPoint(0), self.world(5, 3, 4), atol=1e-6)
            os.remove(self.path("written.vti"))

    def test_it_ends_where_the_volume_does(self):
        image = self.written(self.nrrd(), "--region", "-5,8,0,10000,3,5")
        self.assertEqual(image.GetDimensions(), (9, SIZE[1], 3))

    def test_a_surface_closes_at_its_border(self):
        whole = self.report(self.ball_file(), self.path("a.vtp"), "--iso", "500.5")
        half = self.report(self.ball_file(), self.path("a.vtp"), "--iso", "500.5", "--region",
                           "0,100,0,100,0,8")
        self.assertEqual((half["genus"], half["components"]), (0, 1))
        # The ball's centre is at 7.8 slices of 1; the surface ends between the last slice and the next.
        bounds = read(self.path("a.vtp")).GetBounds()
        self.assertTrue(8 + ORIGIN[2] < bounds[5] <= 9 + ORIGIN[2])
        self.assertTrue(0.5 < half["volume"] / whole["volume"] < 0.75)

    def test_what_is_refused(self):
        volume = self.ball_file()
        for reason, status, *options in (
                ("the region lies beside the volume, which has voxels k 0 to 17", 1, "--region",
                 "0,5,0,5,18,20"),
                ("--region: '5,4,0,5,0,5' ends before it begins", 2, "--region", "5,4,0,5,0,5"),
                ("--region: voxels are counted in whole", 2, "--region", "0,4.5,0,5,0,5"),
                ("--region and --region-box exclude", 2, "--region", "0,4,0,5,0,5", "--region-box",
                 "0,1,0,1,0,1"),
                ("--memory and --region exclude", 2, "--region", "0,9,0,9,0,9", "--memory", "1G")):
            with self.subTest(reason):
                self.refused(reason, volume, self.path("a.vtp"), *options, status=status)


class ListFilesTest(CommandTestCase):
    def files(self, volume):
        return {os.path.basename(line)
                for line in self.run_command(volume, "--list-files").stdout.splitlines()}

    def test_a_header_names_its_data(self):
        header = nrrd_header() + b"data file: a.raw\n"
        self.assertEqual(self.files(self.write_bytes("a.nhdr", header)), {"a.nhdr", "a.raw"})
        self.assertEqual(self.files(self.ball_file()), {"ball.vti"})

    def test_a_series_is_its_slices(self):
        for k in range(3):
            self.write_bytes(f"IM{k}", dicom_slice(k))
        self.write_bytes("notes.txt", b"no slice")
        self.assertEqual(self.files(self.folder), {"IM0", "IM1", "IM2"})


if __name__ == "__main__":
    unittest.main()
