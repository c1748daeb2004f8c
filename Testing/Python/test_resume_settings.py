# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Resume goes on only with the settings of the run that was stopped: every property is changed in
turn, those to come, too, as the wrapped classes tell which there are."""

import os
import shutil
import unittest

import numpy as np
from vtkmodules.util.misc import calldata_type
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.util.vtkConstants import VTK_STRING
from vtkmodules.vtkCommonDataModel import vtkDataObject, vtkImageData
from vtkmodules.vtkFiltersSources import vtkPointSource, vtkSphereSource
from volumic import vtkDeformableSurface, vtkVolumeToSurface

from folder_test_case import FolderTestCase

SIZE = 28
# What a run may go on with, and why.
MAY_CHANGE = {
    "FinestLevel": "where it ends", "Preview": "where it ends", "TimeLimit": "when it ends",
    "NumberOfThreads": "the same bits", "MemoryLimit": "the same bits",
    "ScratchDirectory": "where the checkpoint is", "Resume": "asks for it",
    "ShowLevels": "what is shown of it", "Profile": "columns of seconds"}
# Where half as much again, or the next number, is no legal value, or none that is another one.
VALUES = {"SamplingRatio": 0.9, "CoarsestLevel": 1, "EdgeLength": 1.2, "Tolerance": .1,
          "MaximumEdgeLength": 5., "Gradation": .1, "SeedRadius": 3., "NumberOfLevels": 2,
          "ReductionFactor": 1.8, "SelectedComponent": 1, "Metric": 0, "Recovery": 0,
          "MinimumLevelSize": 12, "UpperValue": 90.}


def image_of_a_ball():
    z, y, x = np.indices((SIZE,) * 3)
    # Voxels of 1 : 1.3, so that the metric counts.
    inside = 9.5 - np.sqrt((x - 13.)**2 + (y - 13.)**2 + (1.3 * (z - 13.5))**2)
    values = np.stack((np.clip(100 * (inside + 0.5), 0, 100), np.clip(80 * inside, 0, 100)), -1)
    voxels = numpy_to_vtk(values.reshape(-1, 2).astype("f4"), deep=True)
    voxels.SetName("density")
    image = vtkImageData()
    image.SetDimensions(SIZE, SIZE, SIZE)
    image.SetSpacing(1., 1., 1.3)
    image.GetPointData().SetScalars(voxels)
    for name, width in (("slope", 1.), ("other slope", 2.)):
        slope = numpy_to_vtk(np.exp(-(inside.ravel() / width)**2).astype("f4"), deep=True)
        slope.SetName(name)
        image.GetPointData().AddArray(slope)
    return image


def properties():
    """Names of all that both classes set and get themselves."""
    return sorted(
        name[3:] for class_ in (vtkVolumeToSurface, vtkDeformableSurface)
        for name in vars(class_)
        if name.startswith("Set") and "Get" + name[3:] in dir(class_))


def another(name, value):
    if name in VALUES:
        return VALUES[name]
    if isinstance(value, float):
        return 60. if name == "IsoValue" else 1.5 * value or 0.5
    return not value if isinstance(value, bool) else value + 1 if value != 1 else 0


class ResumeSettingsTest(FolderTestCase):
    @classmethod
    def setUpClass(cls):
        cls.image = image_of_a_ball()

    def new_filter(self):
        filter_ = vtkVolumeToSurface()
        filter_.SetInputData(self.image)
        filter_.SetIsoValue(50.)
        filter_.SetSelectedComponent(0)
        filter_.SetMinimumLevelSize(6)
        filter_.SetInputArrayToProcess(1, 0, 0, vtkDataObject.FIELD_ASSOCIATION_POINTS, "slope")
        filter_.SetEdgeAttractionWeight(0.2)
        filter_.SetScratchDirectory(self.folder)
        return filter_

    def errors_of_resuming(self, filter_):
        errors = []

        @calldata_type(VTK_STRING)
        def keep(_caller, _event, text):
            errors.append(text)

        filter_.AddObserver("ErrorEvent", keep)
        filter_.ResumeOn()
        filter_.Update()
        return "".join(errors)

    def setUp(self):
        super().setUp()
        filter_ = self.new_filter()

        def stop(caller, _):
            if (caller.GetProgressText() or "").startswith("Level 0, iteration 5"):
                caller.SetAbortExecute(1)

        filter_.AddObserver("ProgressEvent", stop)
        filter_.Update()
        self.left = self.folder
        self.assertEqual(len(os.listdir(self.left)), 1)

    def check_refused(self, name, change):
        self.folder = os.path.join(self.left, "copy")
        shutil.copytree(self.left, self.folder)  # A run that goes on to its end removes it.
        with self.subTest(name):
            filter_ = self.new_filter()
            change(filter_)
            errors = self.errors_of_resuming(filter_)
            self.assertEqual(filter_.GetOutput().GetNumberOfPoints(), 0)
            self.assertRegex(errors, r" was .* and is |not the same ", name)
        shutil.rmtree(self.folder)
        self.folder = self.left

    def test_it_goes_on_without_a_change(self):
        filter_ = self.new_filter()
        self.assertEqual(self.errors_of_resuming(filter_), "")
        self.assertGreater(filter_.GetResumedLevel(), -1)
        self.assertGreater(filter_.GetOutput().GetNumberOfPoints(), 0)

    def test_no_property_may_be_another(self):
        names = properties()
        self.assertGreater(len(names), 35)
        self.assertEqual(set(MAY_CHANGE) - set(names), set())
        for name in names:
            if name in MAY_CHANGE:
                continue
            value = another(name, getattr(self.new_filter(), "Get" + name)())
            with self.subTest(name):
                filter_ = self.new_filter()
                getattr(filter_, "Set" + name)(value)
                self.assertNotEqual(getattr(filter_, "Get" + name)(),
                                    getattr(self.new_filter(), "Get" + name)())
            self.check_refused(name, lambda filter_, name=name, value=value:
                               getattr(filter_, "Set" + name)(value))

    def test_no_input_may_be_another(self):
        points, sphere = vtkPointSource(), vtkSphereSource()
        sphere.SetCenter(13., 13., 17.)
        sphere.SetRadius(12.)
        points.SetCenter(13., 13., 17.)
        points.SetRadius(1.)
        self.check_refused(
            "seeds", lambda filter_: filter_.AddSeedPosition(13., 13., 17.))
        self.check_refused("attracting positions",
                           lambda filter_: filter_.AddAttractingPosition(13., 13., 17.))
        self.check_refused("start", lambda filter_: filter_.SetInitialSurfaceConnection(
            sphere.GetOutputPort()))
        self.check_refused("attracting points", lambda filter_:
                           filter_.SetAttractingPointsConnection(points.GetOutputPort()))
        self.check_refused("edges", lambda filter_: filter_.SetInputArrayToProcess(
            1, 0, 0, vtkDataObject.FIELD_ASSOCIATION_POINTS, "other slope"))


if __name__ == "__main__":
    unittest.main()
