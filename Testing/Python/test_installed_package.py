# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The Python package `volumic` as it is installed: what a user's script relies on."""

import os
import shutil
import subprocess
import sys
import tempfile
import unittest

import numpy as np
import volumic
import vtkmodules
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkImageData, vtkMultiBlockDataSet
from volumic import vtkImagePyramid

PREFIX = os.environ["VOLUMIC_TEST_INSTALL_PREFIX"]


def image_of(voxels, spacing=(1, 1, 1)):
    """vtkImageData with the voxels[z, y, x] as active scalars named `density`."""
    scalars = numpy_to_vtk(voxels.ravel(), deep=True)
    scalars.SetName("density")
    image = vtkImageData()
    image.SetDimensions(voxels.shape[::-1])
    image.SetSpacing(spacing)
    image.GetPointData().SetScalars(scalars)
    return image


def voxels_of(image):
    return vtk_to_numpy(image.GetPointData().GetScalars()).reshape(image.GetDimensions()[::-1])


class PackageTest(unittest.TestCase):
    def test_it_is_the_installed_one(self):
        self.assertTrue(os.path.realpath(volumic.__file__).startswith(os.path.realpath(PREFIX)))

    def test_classes_come_without_importing_vtk_first(self):
        code = "from volumic import vtkImagePyramid; print(vtkImagePyramid().GetClassName())"
        printed = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True)
        self.assertEqual(printed.stdout.decode().strip(), "vtkImagePyramid")

    def refusal(self, *path):
        """How the import ends where Python finds nothing but these folders."""
        code = "import sys; sys.path[:0] = sys.argv[1:]; import volumic"
        package = os.path.dirname(os.path.dirname(volumic.__file__))
        process = subprocess.run([sys.executable, "-I", "-S", "-c", code, *path, package],
                                 check=False, capture_output=True, text=True)
        self.assertEqual(process.returncode, 1, process.stderr)
        return process.stderr.splitlines()[-1]

    def test_without_vtk_the_import_says_so(self):
        self.assertIn("ImportError: volumic needs vtkmodules", self.refusal())

    def test_another_vtk_is_refused(self):
        with tempfile.TemporaryDirectory() as folder:
            os.mkdir(os.path.join(folder, "vtkmodules"))
            for name, text in (("__init__", "__version__ = '8.90.1'"),
                               ("vtkCommonExecutionModel", "")):
                with open(f"{folder}/vtkmodules/{name}.py", "w", encoding="utf-8") as file:
                    file.write(text)
            ours = ".".join(vtkmodules.__version__.split(".")[:2])
            self.assertRegex(self.refusal(folder),
                             rf"built for VTK {ours}, .* VTK 8\.90\.1 in {folder}")

    def test_the_command_finds_the_package_where_the_prefix_was_moved_to(self):
        with tempfile.TemporaryDirectory() as folder:
            moved = os.path.join(folder, "moved")
            shutil.copytree(PREFIX, moved, symlinks=True)
            os.symlink("moved/bin/volumic", os.path.join(folder, "link"))
            for path in ("moved/bin/volumic", "link"):
                printed = subprocess.run([os.path.join(folder, path), "--version"], check=True,
                                         capture_output=True, text=True, env={}).stdout
                self.assertIn(f"volumic {volumic.__version__} ", printed)

    def test_help_of_the_package_names_every_class(self):
        for name in dir(volumic):
            if hasattr(getattr(volumic, name), "GetOutputPort"):
                self.assertIn(name, volumic.__doc__)


class PyramidTest(unittest.TestCase):
    def setUp(self):
        self.pyramid = vtkImagePyramid()

    def output_of(self, voxels, **settings):
        self.pyramid.SetInputData(image_of(voxels))
        for name, value in settings.items():
            getattr(self.pyramid, f"Set{name}")(value)
        self.pyramid.Update()
        return self.pyramid.GetOutput()

    def test_output_is_a_multiblock_before_and_after_update(self):
        self.pyramid.SetInputData(image_of(np.zeros((30, 30, 30), "f4")))
        for update in (self.pyramid.UpdateInformation, self.pyramid.Update):
            update()
            self.assertIsInstance(self.pyramid.GetOutput(), vtkMultiBlockDataSet)
            self.assertIsInstance(self.pyramid.GetOutputDataObject(0), vtkMultiBlockDataSet)

    def test_numpy_goes_in_and_out(self):
        random = np.random.default_rng(4)
        voxels = random.integers(-1000, 1000, (24, 25, 26)).astype("i2")
        output = self.output_of(voxels)
        np.testing.assert_array_equal(voxels_of(output.GetBlock(0)), voxels)
        coarse = voxels_of(output.GetBlock(1))
        self.assertEqual(coarse.dtype, np.float32)
        self.assertEqual(coarse.shape, (13, 14, 15))
        self.assertLess(coarse.std(), voxels.std())
        self.assertGreater(coarse.std(), 0)


if __name__ == "__main__":
    unittest.main()
