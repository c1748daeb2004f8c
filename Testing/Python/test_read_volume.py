# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Examples/Python/read_volume.py: every format keeps voxels and place, bad files are refused."""

import bz2
import gzip
import io
import os
import plistlib
import subprocess
import sys
import tarfile
import unittest
from unittest import mock

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkIOImage import vtkMetaImageWriter, vtkNIFTIImageWriter
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


def corner_values(image):
    """World point of every corner of the image and the value there, whatever the index order."""
    values = {}
    size = image.GetDimensions()
    for corner in np.ndindex(2, 2, 2):
        index = [c * (n - 1) for c, n in zip(corner, size)]
        point = [0.0] * 3
        image.TransformIndexToPhysicalPoint(index, point)
        values[tuple(np.round(point, 3) + 0.0)] = image.GetScalarComponentAsDouble(*index, 0)
    return values


class ReadVolumeTest(FolderTestCase):
    def check(self, image, voxels, direction=np.eye(3), spacing=SPACING, origin=ORIGIN):
        np.testing.assert_array_equal(voxels_of(image), voxels)
        np.testing.assert_allclose(image.GetSpacing(), spacing, rtol=1e-6)
        np.testing.assert_allclose(image.GetOrigin(), origin, rtol=1e-6)
        np.testing.assert_allclose(direction_of(image), direction, atol=1e-6)

    def refused(self, path, reason):
        with self.assertRaisesRegex(VolumeError, reason) as caught:
            read_volume(path)
        self.assertIn(os.path.basename(path), str(caught.exception))


class FormatsTest(ReadVolumeTest):
    def test_vti_keeps_everything(self):
        for dtype in ("i1", "u1", "i2", "u2", "i4", "f4", "f8"):
            with self.subTest(dtype):
                image = make_image(some_voxels(dtype), SPACING, ORIGIN, TURNED)
                read = read_volume(self.write(vtkXMLImageDataWriter(), "a.vti", image))
                self.check(read, some_voxels(dtype), TURNED)
                self.assertEqual(voxels_of(read).dtype, np.dtype(dtype))

    def test_vti_with_one_array_that_is_not_active(self):
        image = vtkImageData()
        image.SetDimensions(5, 4, 3)
        array = numpy_to_vtk(some_voxels().ravel(), deep=True)
        array.SetName("density")
        image.GetPointData().AddArray(array)
        read = read_volume(self.write(vtkXMLImageDataWriter(), "a.vti", image))
        self.assertEqual(read.GetPointData().GetScalars().GetName(), "density")

    def test_metaimage_in_one_and_in_two_files(self):
        image = make_image(some_voxels(), SPACING, ORIGIN)
        self.check(read_volume(self.write(vtkMetaImageWriter(), "a.mha", image)), some_voxels())
        writer = vtkMetaImageWriter()
        writer.SetRAWFileName(self.path("a.raw"))
        self.check(read_volume(self.write(writer, "a.mhd", image)), some_voxels())

    def test_metaimage_direction_is_kept(self):
        rows = " ".join(f"{number:g}" for number in TURNED.T.ravel())
        header = medical_files.meta_header(some_voxels(), SPACING, ORIGIN, rows)
        path = self.write_bytes("a.mha", header + some_voxels().tobytes())
        image = read_volume(path)
        self.check(image, some_voxels(), TURNED)
        self.assertEqual(world_axes(image), "LPS")

    def test_nrrd_encodings_and_byte_orders(self):
        voxels = some_voxels()
        text = " ".join(map(str, voxels.ravel())).encode()
        for encoding, endian, data in (
                ("raw", "little", voxels.astype("<i2").tobytes()),
                ("raw", "big", voxels.astype(">i2").tobytes()),
                ("gzip", "little", gzip.compress(voxels.astype("<i2").tobytes())),
                ("bzip2", "little", bz2.compress(voxels.astype("<i2").tobytes())),
                ("text", "little", text)):
            with self.subTest(encoding=encoding, endian=endian):
                header = medical_files.nrrd_header(voxels, SPACING, ORIGIN, TURNED, encoding,
                                                   endian)
                image = read_volume(self.write_bytes("a.nrrd", header + b"\n" + data))
                self.check(image, voxels, TURNED)
                self.assertEqual(world_axes(image), "LPS")

    def test_nrrd_with_detached_data(self):
        voxels = some_voxels("u1")
        header = medical_files.nrrd_header(voxels, SPACING, ORIGIN, TURNED, "raw", "little")
        self.write_bytes("a.raw", b"12345" + voxels.tobytes())
        extra = b"data file: a.raw\nbyte skip: 5\n"
        self.check(read_volume(self.write_bytes("a.nhdr", header + extra)), voxels, TURNED)

    def test_nifti_of_vtk_with_and_without_compression(self):
        for name in ("a.nii", "a.nii.gz"):
            with self.subTest(name):
                image = make_image(some_voxels(), SPACING, ORIGIN)
                path = self.write(vtkNIFTIImageWriter(), name, image)
                self.check(read_volume(path), some_voxels())

    def test_nifti_places_voxels_by_its_sform(self):
        voxels = some_voxels()
        sform = np.column_stack([TURNED * SPACING, ORIGIN])
        for qfac in (1, -1):  # VTK reverses the slices for the second
            with self.subTest(qfac=qfac):
                content = medical_files.nifti(voxels, SPACING, sform=sform, qfac=qfac)
                image = read_volume(self.write_bytes("a.nii", content))
                expected = make_image(voxels, SPACING, ORIGIN, TURNED)
                self.assertEqual(corner_values(image), corner_values(expected))
                self.assertEqual(world_axes(image), "RAS")

    def test_nifti_falls_back_to_its_qform_where_the_sform_is_sheared(self):
        sheared = np.column_stack([[[1, 1, 0], [0, 1, 0], [0, 0, 1]], ORIGIN])
        content = medical_files.nifti(some_voxels(), SPACING, sform=sheared, offset=(1, 2, 3))
        image = read_volume(self.write_bytes("a.nii", content))
        self.check(image, some_voxels(), origin=(1, 2, 3))

    def test_nifti_values_are_rescaled(self):
        content = medical_files.nifti(some_voxels(), SPACING, slope=0.5, intercept=-3)
        image = read_volume(self.write_bytes("a.nii", content))
        np.testing.assert_allclose(voxels_of(image), some_voxels() * 0.5 - 3)

    def test_invesalius_project(self):
        image = read_volume(self.write_bytes(
            "a.inv3", medical_files.inv3(some_voxels("<i2"), SPACING)))
        self.check(image, some_voxels(), origin=(0, 0, 0))
        self.assertEqual(world_axes(image), "LAS")

    @unittest.skipUnless(os.path.exists(SKULL), "invesalius-examples is not installed")
    def test_skull_of_invesalius(self):
        image = read_volume(SKULL)
        self.assertEqual(image.GetDimensions(), (256, 256, 108))
        np.testing.assert_allclose(image.GetSpacing(), (0.95703, 0.95703, 1.5), atol=1e-5)
        self.assertEqual(voxels_of(image).dtype, np.int16)
        self.assertEqual(image.GetScalarRange(), (-1024, 2986))

    def test_command_line_converts(self):
        source = self.write(vtkMetaImageWriter(), "a.mha", make_image(some_voxels(), SPACING))
        script = os.path.join(EXAMPLES, "read_volume.py")
        target = self.path("b.vti")
        subprocess.run([sys.executable, script, source, target], check=True, capture_output=True)
        self.check(read_volume(target), some_voxels(), origin=(0, 0, 0))
        failed = subprocess.run([sys.executable, script, self.path("none.mha"), target],
                                capture_output=True, text=True, check=False)
        self.assertEqual(failed.returncode, 1)
        self.assertIn("no such file", failed.stderr)
        self.assertNotIn("Traceback", failed.stderr)


class CommandTest(ReadVolumeTest):
    """Reading is left to the command `volumic`, which must be found."""

    def setUp(self):
        super().setUp()
        volume_command.find_command.cache_clear()
        self.addCleanup(volume_command.find_command.cache_clear)

    def test_it_lies_beside_the_package(self):
        prefix = os.environ["VOLUMIC_TEST_INSTALL_PREFIX"]
        self.assertEqual(volume_command.find_command(), os.path.join(prefix, "bin", "volumic"))

    def test_it_may_be_on_the_path_instead(self):
        with mock.patch("importlib.util.find_spec", return_value=None), \
                mock.patch("shutil.which", return_value="/somewhere/volumic"):
            self.assertEqual(volume_command.find_command(), "/somewhere/volumic")

    def test_where_there_is_none(self):
        with mock.patch("importlib.util.find_spec", return_value=None), \
                mock.patch("shutil.which", return_value=None):
            with self.assertRaisesRegex(VolumeError, "neither beside .* nor on PATH"):
                read_volume(self.path("a.vti"))

    def test_the_files_of_a_volume(self):
        self.write_bytes("a.raw", b"")
        header = self.write_bytes("a.nhdr", b"NRRD0004\ndata file: a.raw\n")
        self.assertEqual(files_of_volume(header), [header, self.path("a.raw")])


class DicomTest(ReadVolumeTest):
    def write_series(self, voxels, syntax="explicit", order=None, **changes):
        names = order or range(len(voxels))
        for k, number in enumerate(names):
            content = medical_files.dicom_slice(voxels[k], k, SPACING, ORIGIN, TURNED, syntax,
                                                **changes)
            self.write_bytes(f"IM{number:03}", content)
        return self.folder

    def test_slices_are_ordered_by_position_and_placed(self):
        for syntax in ("explicit", "implicit"):
            with self.subTest(syntax):
                image = read_volume(self.write_series(some_voxels(), syntax, order=(2, 0, 1)))
                self.check(image, some_voxels(), TURNED)
                self.assertEqual(world_axes(image), "LPS")

    def test_values_become_hounsfield_units(self):
        stored = some_voxels("u2") * 60  # up to 3540, as in CT
        image = read_volume(self.write_series(stored, slope="1", intercept="-1024"))
        np.testing.assert_array_equal(voxels_of(image), stored.astype(int) - 1024)
        self.assertEqual(voxels_of(image).dtype, np.int16)

    def test_other_files_in_the_folder_are_skipped(self):
        self.write_bytes("notes.txt", b"not an image")
        self.check(read_volume(self.write_series(some_voxels())), some_voxels(), TURNED)

    def test_empty_folder(self):
        self.refused(self.folder, "no DICOM slices")

    def test_repeated_slice(self):
        self.write_series(some_voxels())
        with open(self.path("IM000"), "rb") as file:
            self.write_bytes("IM009", file.read())
        self.refused(self.folder, "IM009 lies where .*IM000 does")

    def test_slices_without_a_place(self):
        for lacks in ("position", "orientation"):
            with self.subTest(lacks):
                self.write_series(some_voxels())
                self.write_bytes("IM009", medical_files.dicom_slice(
                    some_voxels()[0], 3, SPACING, ORIGIN, TURNED, lacks=(lacks,)))
                self.refused(self.folder, f"IM009: lacks its {lacks}: not a slice of a volume")

    def test_colour_slices(self):
        self.refused(self.write_series(some_voxels(), samples=3), "3 components per pixel")


class RefusedTest(ReadVolumeTest):
    def test_missing_file(self):
        self.refused(self.path("none.nii"), "no such file")

    def test_unknown_suffix(self):
        self.refused(self.write_bytes("a.stl", b"solid"), "not a format")

    def test_several_components(self):
        image = make_image(some_voxels(), SPACING)
        colours = numpy_to_vtk(np.zeros((60, 3), "u1"), deep=True)
        colours.SetName("colours")
        image.GetPointData().SetScalars(colours)
        self.refused(self.write(vtkXMLImageDataWriter(), "a.vti", image), "3 components")
        self.refused(self.write(vtkMetaImageWriter(), "a.mha", image), "3 components")

    def test_no_values(self):
        image = vtkImageData()
        image.SetDimensions(5, 4, 3)
        self.refused(self.write(vtkXMLImageDataWriter(), "a.vti", image),
                     "no active scalars; there are no point arrays")

    def test_contents_that_are_something_else(self):
        for suffix in ("vti", "mha", "nrrd", "nii", "nii.gz", "inv3"):
            with self.subTest(suffix):
                self.refused(self.write_bytes(f"a.{suffix}", b"something else " * 50),
                             "not |archive is damaged")

    def test_nifti_over_time(self):
        content = medical_files.nifti(np.zeros((2, 3, 4, 5), "i2"), SPACING)
        self.refused(self.write_bytes("a.nii", content), "2 time points")

    def test_invesalius_links_are_not_followed(self):
        with tarfile.open(self.path("a.inv3"), "w:gz") as archive:
            plist = plistlib.dumps({"matrix": {"dtype": "int16", "shape": [3, 4, 5],
                                               "filename": "../../matrix.dat"},
                                    "spacing": [1.0, 1.0, 1.0]})
            member = tarfile.TarInfo("p/main.plist")
            member.size = len(plist)
            archive.addfile(member, io.BytesIO(plist))
            link = tarfile.TarInfo("p/matrix.dat")
            link.type, link.linkname = tarfile.SYMTYPE, "/etc/hostname"
            archive.addfile(link)
        self.refused(self.path("a.inv3"), "not an InVesalius project")


if __name__ == "__main__":
    unittest.main()
