# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""vtkDeformableSurface of the installed package `volumic`: what a user's script relies on."""

import re
import unittest

import numpy as np
from vtkmodules.util.misc import calldata_type
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.util.vtkConstants import VTK_STRING
from vtkmodules.vtkCommonDataModel import (
    vtkImageData, vtkMultiBlockDataSet, vtkPolyData, vtkTable)
from vtkmodules.vtkCommonMisc import vtkErrorCode
from volumic import vtkDeformableSurface, vtkImagePyramid, vtkVolumeToSurface

from vtk_files import points_of

SIZE, RADIUS, ISO = 32, 9.0, 100.5


def ball(bright=200, dark=0, centre=(SIZE - 1) / 2):
    """Image of a ball with a smooth border; its surface at ISO has the radius RADIUS."""
    z, y, x = np.indices((SIZE,) * 3) - centre
    inside = np.clip(RADIUS - np.sqrt(x * x + y * y + z * z) + 0.5, 0, 1)
    scalars = numpy_to_vtk((dark + (bright - dark) * inside).astype("f4").ravel(), deep=True)
    scalars.SetName("density")
    image = vtkImageData()
    image.SetDimensions(SIZE, SIZE, SIZE)
    image.GetPointData().SetScalars(scalars)
    return image


def field(surface, name):
    return surface.GetFieldData().GetArray(name).GetValue(0)


class SurfaceTest(unittest.TestCase):
    def setUp(self):
        self.surface = vtkDeformableSurface()
        self.errors = []

        @calldata_type(VTK_STRING)
        def keep(_caller, _event, text):
            self.errors.append(text)

        self.surface.AddObserver("ErrorEvent", keep)
        self.surface.GetExecutive().AddObserver("ErrorEvent", keep)  # which has nothing to add

    def run_on(self, image, iso=ISO):
        self.surface.SetInputData(image)
        if iso is not None:
            self.surface.SetIsoValue(iso)
        self.surface.Update()
        return self.surface.GetOutput()


class OutputsTest(SurfaceTest):
    @classmethod
    def setUpClass(cls):
        cls.run_once = vtkDeformableSurface()
        pyramid = vtkImagePyramid()
        pyramid.SetInputData(ball())
        cls.run_once.SetInputConnection(pyramid.GetOutputPort())
        cls.run_once.SetIsoValue(ISO)
        cls.run_once.Update()

    def test_types_of_the_three_outputs(self):
        self.assertIsInstance(self.run_once.GetOutput(), vtkPolyData)
        self.assertIsInstance(self.run_once.GetLevels(), vtkMultiBlockDataSet)
        self.assertIsInstance(self.run_once.GetHistory(), vtkTable)
        self.assertIs(self.run_once.GetOutputDataObject(1), self.run_once.GetLevels())
        self.assertIs(self.run_once.GetOutputDataObject(2), self.run_once.GetHistory())

    def test_numpy_sees_a_ball(self):
        points = points_of(self.run_once.GetOutput())
        radii = np.linalg.norm(points - (SIZE - 1) / 2, axis=1)
        np.testing.assert_allclose(radii, RADIUS, atol=0.2)
        normals = vtk_to_numpy(self.run_once.GetOutput().GetPointData().GetNormals())
        outward = (points - (SIZE - 1) / 2) / radii[:, None]
        self.assertGreater((normals * outward).sum(axis=1).min(), 0.8)


class UseTest(SurfaceTest):
    def test_help_explains_every_property(self):
        for kind in (vtkDeformableSurface, vtkImagePyramid, vtkVolumeToSurface):
            names = [name for name in vars(kind)
                     if name.startswith("Set") and hasattr(kind, "Get" + name[3:])]
            self.assertGreater(len(names), 2)
            names += [n for n in vars(kind) if re.match("Set(InitialSurface|AttractingPoints)", n)]
            for name in names:
                signature, _, explanation = getattr(kind, name).__doc__.partition("\n\n")
                self.assertTrue(explanation.strip(), signature)

    def test_positions(self):
        middle = [(SIZE - 1) / 2] * 3
        self.surface.SetInitializationToSeeds()
        self.surface.AddSeedPosition(*middle)
        place = [0.0] * 3
        self.surface.GetSeedPosition(0, place)
        self.assertEqual(place, middle)
        area = field(self.run_on(ball()), "Area")
        self.assertAlmostEqual(area / (4 * np.pi * RADIUS ** 2), 1, delta=0.05)
        # Just outside the ball: the surface comes out to it.
        self.surface.AddAttractingPosition(middle[0] + RADIUS + 1.5, *middle[1:])
        self.surface.Update()
        self.assertEqual(self.surface.GetNumberOfAttractingPositions(), 1)
        self.assertGreater(self.surface.GetOutput().GetBounds()[1], middle[0] + RADIUS + 1.0)
        self.surface.ClearAttractingPositions()
        self.surface.Update()
        self.assertEqual(field(self.surface.GetOutput(), "Area"), area)
        self.assertEqual(self.errors, [])
        self.surface.AddSeedPosition(-50, 0, 0)
        self.surface.Update()
        self.assertIn("Seed Positions: point 1 (-50, 0, 0) lies outside", self.errors[0])

    def test_the_error_code_is_that_of_the_last_run(self):
        image = ball()
        for iso, code, blocks in ((ISO, 0, 3), (1000, vtkErrorCode.UserError, 0), (ISO, 0, 3)):
            output = self.run_on(image, iso=iso)
            self.assertEqual(self.surface.GetErrorCode(), code)
            self.assertEqual(output.GetNumberOfPoints() > 0, code == 0)
            self.assertEqual(self.surface.GetLevels().GetNumberOfBlocks(), blocks)
            self.assertEqual(self.surface.GetHistory().GetNumberOfRows() > 0, code == 0)
        self.assertEqual(len(self.errors), 1, self.errors)

if __name__ == "__main__":
    unittest.main()
