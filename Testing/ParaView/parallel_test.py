# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Run by mpirun with two processes: pieces of the image are not taken for the image."""

import os
import sys
import unittest

from paraview import simple

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import plugin_testing as testing
from vtkmodules.vtkParallelCore import vtkMultiProcessController


class ParallelTest(unittest.TestCase):
    def test_one_whole_pyramid(self):
        self.assertEqual(vtkMultiProcessController.GetGlobalController().GetNumberOfProcesses(), 2)
        testing.load_plugin()
        pyramid = simple.ImagePyramid(Input=simple.Wavelet(), NumberOfLevels=2)
        pyramid.UpdatePipeline()
        information = pyramid.GetDataInformation()
        self.assertEqual(information.GetNumberOfPoints(), 21**3 + 12**3)
        self.assertEqual(information.GetBounds(), (-10, 10) * 3)


testing.main()
