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

import volumic
import vtkmodules
from vtkmodules.vtkCommonDataModel import vtkMultiBlockDataSet
from volumic import vtkDeformableSurface, vtkImagePyramid, vtkVolumeToSurface

from sample_volumes import make_image, ring_voxels

PREFIX = os.environ["VOLUMIC_TEST_INSTALL_PREFIX"]


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

    def test_every_property_has_a_docstring(self):
        for kind in (vtkDeformableSurface, vtkImagePyramid, vtkVolumeToSurface):
            names = [name for name in vars(kind)
                     if name.startswith("Set") and hasattr(kind, "Get" + name[3:])]
            self.assertGreater(len(names), 2)
            names += [n for n in vars(kind) if re.match("Set(InitialSurface|AttractingPoints)", n)]
            for name in names:
                signature, _, explanation = getattr(kind, name).__doc__.partition("\n\n")
                self.assertTrue(explanation.strip(), signature)

    def test_output_is_a_multiblock_before_and_after_update(self):
        pyramid = vtkImagePyramid()
        pyramid.SetInputData(make_image(ring_voxels()))
        for update in (pyramid.UpdateInformation, pyramid.Update):
            update()
            self.assertIsInstance(pyramid.GetOutput(), vtkMultiBlockDataSet)
            self.assertIsInstance(pyramid.GetOutputDataObject(0), vtkMultiBlockDataSet)
