# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Tests that changing any property of a filter after a run triggers a new run."""

import unittest

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonDataModel import vtkDataObject
from volumic import vtkDeformableSurface, vtkVolumeToSurface

from sample_volumes import make_image

SIZE = 28
# Properties that reuse or resume the last run.
REUSING = {"FinestLevel", "Preview", "TimeLimit", "NumberOfThreads", "MemoryLimit",
           "ScratchDirectory", "Resume", "Profile", "ShowLevels"}
# Values of properties for which another() yields no valid or no different value.
VALUES = {"SamplingRatio": 0.9, "CoarsestLevel": 1, "EdgeLength": 1.2, "Tolerance": .1,
          "MaximumEdgeLength": 5., "Gradation": .1, "SeedRadius": 3., "NumberOfLevels": 2,
          "ReductionFactor": 1.8, "SelectedComponent": 1, "Metric": 0, "Recovery": 0,
          "MinimumLevelSize": 12, "UpperValue": 90.}


def image_of_a_ball():
    z, y, x = np.indices((SIZE,) * 3)
    inside = 9.5 - np.sqrt((x - 13.)**2 + (y - 13.)**2 + (1.3 * (z - 13.5))**2)
    values = np.stack((np.clip(100 * (inside + 0.5), 0, 100), np.clip(80 * inside, 0, 100)), -1)
    image = make_image(values.astype("f4"), (1, 1, 1.3))
    slope = numpy_to_vtk(np.exp(-inside.ravel()**2).astype("f4"), deep=True)
    slope.SetName("slope")
    image.GetPointData().AddArray(slope)
    return image


def properties():
    """Return the names of all properties of both classes."""
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


def filter_that_has_run(image):
    filter_ = vtkVolumeToSurface()
    filter_.SetInputData(image)
    filter_.SetIsoValue(50.)
    filter_.SetSelectedComponent(0)
    filter_.SetMinimumLevelSize(6)
    filter_.SetInputArrayToProcess(1, 0, 0, vtkDataObject.FIELD_ASSOCIATION_POINTS, "slope")
    filter_.SetEdgeAttractionWeight(0.2)
    filter_.Update()
    return filter_


class ChangedSettingsTest(unittest.TestCase):
    def check_reruns(self, filter_):
        texts = []
        filter_.AddObserver("ProgressEvent",
                            lambda caller, _: texts.append(caller.GetProgressText() or ""))
        filter_.Update()
        self.assertEqual(filter_.GetErrorCode(), 0)
        self.assertTrue(any("Building the pyramid" in text for text in texts))

    def test_every_property(self):
        image = image_of_a_ball()
        names = properties()
        self.assertGreater(len(names), 35)
        self.assertEqual(REUSING - set(names), set())
        for name in set(names) - REUSING:
            with self.subTest(name):
                filter_ = filter_that_has_run(image)
                value = getattr(filter_, "Get" + name)()
                getattr(filter_, "Set" + name)(another(name, value))
                self.assertNotEqual(getattr(filter_, "Get" + name)(), value)
                self.check_reruns(filter_)

    def test_attracting_positions(self):
        filter_ = filter_that_has_run(image_of_a_ball())
        filter_.AddAttractingPosition(13., 13., 17.)
        self.check_reruns(filter_)
