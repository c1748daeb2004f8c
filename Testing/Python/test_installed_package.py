# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Tests of the installed Python package `volumic`."""

import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

import numpy as np
import volumic
import vtkmodules
from vtkmodules.util.misc import calldata_type
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.util.vtkConstants import VTK_STRING
from vtkmodules.vtkCommonDataModel import vtkImageData, vtkMultiBlockDataSet
from vtkmodules.vtkCommonMisc import vtkErrorCode
from volumic import vtkDeformableSurface, vtkImagePyramid, vtkVolumeToSurface

PREFIX = os.environ["VOLUMIC_TEST_INSTALL_PREFIX"]


def image_of(voxels, spacing=(1, 1, 1)):
    """Return a vtkImageData with voxels [z, y, x] as active scalars `density`."""
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
    def test_installed_package_is_imported(self):
        self.assertTrue(os.path.realpath(volumic.__file__).startswith(os.path.realpath(PREFIX)))

    def test_import_without_importing_vtk_first(self):
        code = "from volumic import vtkImagePyramid; print(vtkImagePyramid().GetClassName())"
        printed = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True)
        self.assertEqual(printed.stdout.decode().strip(), "vtkImagePyramid")

    def import_error(self, *path):
        """Return the last line of the error of an import with only these folders in the path."""
        code = "import sys; sys.path[:0] = sys.argv[1:]; import volumic"
        package = os.path.dirname(os.path.dirname(volumic.__file__))
        process = subprocess.run([sys.executable, "-I", "-S", "-c", code, *path, package],
                                 check=False, capture_output=True, text=True)
        self.assertEqual(process.returncode, 1, process.stderr)
        return process.stderr.splitlines()[-1]

    def test_import_without_vtk_raises(self):
        self.assertIn("ImportError: volumic needs vtkmodules", self.import_error())

    def test_import_with_other_vtk_version_raises(self):
        with tempfile.TemporaryDirectory() as folder:
            os.mkdir(os.path.join(folder, "vtkmodules"))
            for name, text in (("__init__", "__version__ = '8.90.1'"),
                               ("vtkCommonExecutionModel", "")):
                with open(f"{folder}/vtkmodules/{name}.py", "w", encoding="utf-8") as file:
                    file.write(text)
            ours = ".".join(vtkmodules.__version__.split(".")[:2])
            self.assertRegex(self.import_error(folder),
                             rf"built for VTK {ours}, .* VTK 8\.90\.1 in {folder}")

    def test_command_works_after_moving_the_prefix(self):
        with tempfile.TemporaryDirectory() as folder:
            moved = os.path.join(folder, "moved")
            shutil.copytree(PREFIX, moved, symlinks=True)
            os.symlink("moved/bin/volumic", os.path.join(folder, "link"))
            for path in ("moved/bin/volumic", "link"):
                printed = subprocess.run([os.path.join(folder, path), "--version"], check=True,
                                         capture_output=True, text=True, env={}).stdout
                self.assertIn(f"volumic {volumic.__version__} ", printed)

    def test_docstring_lists_every_class(self):
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

    def test_numpy_input_and_output(self):
        random = np.random.default_rng(4)
        voxels = random.integers(-1000, 1000, (24, 25, 26)).astype("i2")
        output = self.output_of(voxels)
        np.testing.assert_array_equal(voxels_of(output.GetBlock(0)), voxels)
        coarse = voxels_of(output.GetBlock(1))
        self.assertEqual(coarse.dtype, np.float32)
        self.assertEqual(coarse.shape, (13, 14, 15))
        self.assertLess(coarse.std(), voxels.std())
        self.assertGreater(coarse.std(), 0)


class SurfaceTest(unittest.TestCase):
    SIZE, RADIUS, ISO = 32, 9.0, 100.5

    def setUp(self):
        self.surface = vtkDeformableSurface()
        self.errors = []

        @calldata_type(VTK_STRING)
        def keep(_caller, _event, text):
            self.errors.append(text)

        self.surface.AddObserver("ErrorEvent", keep)
        self.surface.GetExecutive().AddObserver("ErrorEvent", keep)  # adds no message
        z, y, x = np.indices((self.SIZE,) * 3) - (self.SIZE - 1) / 2
        inside = np.clip(self.RADIUS - np.sqrt(x * x + y * y + z * z) + 0.5, 0, 1)
        self.surface.SetInputData(image_of((200 * inside).astype("f4")))
        self.surface.SetIsoValue(self.ISO)

    def area(self):
        self.surface.Update()
        return self.surface.GetOutput().GetFieldData().GetArray("Area").GetValue(0)

    def test_every_property_has_a_docstring(self):
        for kind in (vtkDeformableSurface, vtkImagePyramid, vtkVolumeToSurface):
            names = [name for name in vars(kind)
                     if name.startswith("Set") and hasattr(kind, "Get" + name[3:])]
            self.assertGreater(len(names), 2)
            names += [n for n in vars(kind) if re.match("Set(InitialSurface|AttractingPoints)", n)]
            for name in names:
                signature, _, explanation = getattr(kind, name).__doc__.partition("\n\n")
                self.assertTrue(explanation.strip(), signature)

    def test_seed_and_attracting_positions(self):
        middle = [(self.SIZE - 1) / 2] * 3
        self.surface.SetInitializationToSeeds()
        self.surface.AddSeedPosition(*middle)
        position = [0.0] * 3
        self.surface.GetSeedPosition(0, position)
        self.assertEqual(position, middle)
        area = self.area()
        self.assertAlmostEqual(area / (4 * np.pi * self.RADIUS ** 2), 1, delta=0.05)
        # A point outside the ball attracts the surface.
        self.surface.AddAttractingPosition(middle[0] + self.RADIUS + 1.5, *middle[1:])
        self.surface.Update()
        self.assertEqual(self.surface.GetNumberOfAttractingPositions(), 1)
        self.assertGreater(self.surface.GetOutput().GetBounds()[1], middle[0] + self.RADIUS + 1.0)
        self.surface.ClearAttractingPositions()
        self.assertEqual(self.area(), area)
        self.assertEqual(self.errors, [])
        self.surface.AddSeedPosition(-50, 0, 0)
        self.surface.Update()
        self.assertIn("Seed Positions: point 1 (-50, 0, 0) is outside", self.errors[0])

    def test_error_code_is_reset_by_each_run(self):
        for iso, code, blocks in ((self.ISO, 0, 3), (1000, vtkErrorCode.UserError, 0),
                                  (self.ISO, 0, 3)):
            self.surface.SetIsoValue(iso)
            self.surface.Update()
            self.assertEqual(self.surface.GetErrorCode(), code)
            self.assertEqual(self.surface.GetOutput().GetNumberOfPoints() > 0, code == 0)
            self.assertEqual(self.surface.GetLevels().GetNumberOfBlocks(), blocks)
            self.assertEqual(self.surface.GetHistory().GetNumberOfRows() > 0, code == 0)
        self.assertEqual(len(self.errors), 1, self.errors)


if __name__ == "__main__":
    unittest.main()
