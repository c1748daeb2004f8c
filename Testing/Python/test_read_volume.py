# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Examples/Python/read_volume.py: voxels and place as the command reads them, which is looked for,
and whose errors are VolumeError. What formats and damage there are, the command's own tests show."""

import os
import subprocess
import sys
import unittest
from unittest import mock

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkIOImage import vtkMetaImageWriter
from vtkmodules.vtkIOXML import vtkXMLImageDataWriter

import medical_files
from examples_path import EXAMPLES
from folder_test_case import FolderTestCase

sys.path.insert(0, EXAMPLES)
# pylint: disable=wrong-import-position
from pipeline import SKULL
import volume_command
from read_volume import files_of_volume, read_volume
from volume_image import VolumeError, direction_of, make_image, world_axes

TURNED = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
SPACING, ORIGIN = (0.5, 1.25, 2.0), (-7.0, 8.0, 9.5)


def some_voxels(dtype="i2"):
    """Different values at every voxel of 5 x 4 x 3."""
    return np.arange(60).reshape(3, 4, 5).astype(dtype)


def voxels_of(image):
    return vtk_to_numpy(image.GetPointData().GetScalars()).reshape(image.GetDimensions()[::-1])


class ReadVolumeTest(FolderTestCase):
    def check(self, image, direction, axes, origin=ORIGIN):
        np.testing.assert_array_equal(voxels_of(image), some_voxels())
        self.assertEqual(voxels_of(image).dtype, np.int16)
        np.testing.assert_allclose(image.GetSpacing(), SPACING, rtol=1e-6)
        np.testing.assert_allclose(image.GetOrigin(), origin, rtol=1e-6)
        np.testing.assert_allclose(direction_of(image), direction, atol=1e-6)
        self.assertEqual(world_axes(image), axes)

    def test_axes_of_the_world_are_those_of_the_format(self):
        image = make_image(some_voxels(), SPACING, ORIGIN, TURNED)
        rows = " ".join(f"{number:g}" for number in TURNED.T.ravel())
        sform = np.column_stack([TURNED * SPACING, ORIGIN])
        data = some_voxels().tobytes()
        header = medical_files.meta_header(some_voxels(), SPACING, ORIGIN, rows)
        nrrd = medical_files.nrrd_header(some_voxels(), SPACING, ORIGIN, TURNED, "raw", "little")
        for axes, path in (
                (world_axes(image), self.write(vtkXMLImageDataWriter(), "a.vti", image)),
                ("LPS", self.write_bytes("a.mha", header + data)),
                ("LPS", self.write_bytes("a.nrrd", nrrd + b"\n" + data)),
                ("RAS", self.write_bytes("a.nii", medical_files.nifti(
                    some_voxels(), SPACING, sform=sform)))):
            with self.subTest(path):
                self.check(read_volume(path), TURNED, axes)
        self.check(read_volume(self.write_bytes("a.inv3", medical_files.inv3(
            some_voxels("<i2"), SPACING))), np.eye(3), "LAS", origin=(0, 0, 0))
        os.mkdir(self.path("series"))
        for k in range(3):
            self.write_bytes(f"series/{k}", medical_files.dicom_slice(
                some_voxels()[k], k, SPACING, ORIGIN, TURNED))
        self.check(read_volume(self.path("series")), TURNED, "LPS")

    @unittest.skipUnless(os.path.exists(SKULL), "invesalius-examples is not installed")
    def test_skull_of_invesalius(self):
        image = read_volume(SKULL)
        self.assertEqual(image.GetDimensions(), (256, 256, 108))
        np.testing.assert_allclose(image.GetSpacing(), (0.95703, 0.95703, 1.5), atol=1e-5)
        self.assertEqual(image.GetScalarRange(), (-1024, 2986))

    def test_command_line_converts(self):
        source = self.write(vtkMetaImageWriter(), "a.mha",
                            make_image(some_voxels(), SPACING, ORIGIN))
        script, target = os.path.join(EXAMPLES, "read_volume.py"), self.path("b.vti")
        subprocess.run([sys.executable, script, source, target], check=True, capture_output=True)
        self.check(read_volume(target), np.eye(3), world_axes(read_volume(source)))
        failed = subprocess.run([sys.executable, script, self.path("none.mha"), target],
                                capture_output=True, text=True, check=False)
        self.assertEqual(failed.returncode, 1)
        self.assertIn("no such file", failed.stderr)
        self.assertNotIn("Traceback", failed.stderr)

    def test_refused(self):
        image = make_image(some_voxels(), SPACING)
        colours = numpy_to_vtk(np.zeros((60, 3), "u1"), deep=True)
        image.GetPointData().SetScalars(colours)
        for reason, path in (
                ("no such file", self.path("none.nii")),
                ("not a format", self.write_bytes("a.stl", b"solid")),
                ("3 components per voxel; one is needed",
                 self.write(vtkXMLImageDataWriter(), "a.vti", image))):
            with self.assertRaisesRegex(VolumeError, reason) as caught:
                read_volume(path)
            self.assertIn(os.path.basename(path), str(caught.exception))


class CommandTest(FolderTestCase):
    def setUp(self):
        super().setUp()
        volume_command.find_command.cache_clear()
        self.addCleanup(volume_command.find_command.cache_clear)

    def test_where_it_is_looked_for(self):
        prefix = os.environ["VOLUMIC_TEST_INSTALL_PREFIX"]
        self.assertEqual(volume_command.find_command(), os.path.join(prefix, "bin", "volumic"))
        for found in ("/somewhere/volumic", None):
            volume_command.find_command.cache_clear()
            with mock.patch("importlib.util.find_spec", return_value=None), \
                    mock.patch("shutil.which", return_value=found):
                if found:
                    self.assertEqual(volume_command.find_command(), found)
                else:
                    with self.assertRaisesRegex(VolumeError, "neither beside .* nor on PATH"):
                        read_volume(self.path("a.vti"))

    def test_the_files_of_a_volume(self):
        self.write_bytes("a.raw", b"")
        header = self.write_bytes("a.nhdr", b"NRRD0004\ndata file: a.raw\n")
        self.assertEqual(files_of_volume(header), [header, self.path("a.raw")])


if __name__ == "__main__":
    unittest.main()
