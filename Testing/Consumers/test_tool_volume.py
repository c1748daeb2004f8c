# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""`volumic --write-volume` writes the volume as it was read, `--list-files` tells of its files."""

import os
import unittest

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLImageDataWriter

from limited_files import largest_file
from tool_test_case import (
    ORIGIN, SIZE, SPACING, TURNED, ToolTestCase, ball, dicom_slice, make_image, nrrd_header)

from vtk_files import read


class WrittenVolumeTest(ToolTestCase):
    def nrrd(self):
        return self.write_bytes("a.nrrd",
                                nrrd_header(direction=TURNED) + b"\n" + ball().tobytes())

    def written(self, volume, *options):
        """The volume that is written, and that nothing else is."""
        path = self.path("written.vti")
        before = set(os.listdir(self.folder))
        process = self.run_tool(volume, "--write-volume", path, *options)
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


class ListFilesTest(ToolTestCase):
    def files(self, volume):
        return {os.path.basename(line)
                for line in self.run_tool(volume, "--list-files").stdout.splitlines()}

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
