# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Run by mpirun with any number of processes: levels in pieces are, for what ParaView makes of them,
the levels that one process has."""

import os
import sys
import unittest

from paraview import servermanager
from paraview import simple
from vtkmodules.vtkFiltersCore import vtkContourFilter, vtkMassProperties
from vtkmodules.vtkImagingCore import vtkRTAnalyticSource
from vtkmodules.vtkParallelCore import vtkMultiProcessController

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import plugin_testing as testing

LEVELS = 3
ISO = 150.0


def processes():
    return vtkMultiProcessController.GetGlobalController().GetNumberOfProcesses()


def integrated(proxy, name):
    """The sum over all processes, where ghosts don't count."""
    sums = simple.IntegrateVariables(proxy)
    sums.UpdatePipeline()
    return servermanager.Fetch(sums).GetCellData().GetArray(name).GetTuple1(0)


class ParallelPyramidTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        testing.load_plugin()
        package = testing.load_package()
        source = vtkRTAnalyticSource()
        whole = package.vtkImagePyramid()
        whole.SetInputConnection(source.GetOutputPort())
        whole.SetNumberOfLevels(LEVELS)
        whole.Update()
        cls.whole = [whole.GetOutput().GetBlock(h) for h in range(LEVELS)]
        cls.pyramid = simple.ImagePyramid(Input=simple.Wavelet(), NumberOfLevels=LEVELS)
        cls.pyramid.UpdatePipeline()

    def level(self, h):
        block = simple.ExtractBlock(self.pyramid, Selectors=[f"/Root/Level{h}"])
        block.UpdatePipeline()
        return block

    def area_of_contour(self, h):
        contour = vtkContourFilter()
        contour.SetInputData(self.whole[h])
        contour.SetValue(0, ISO)
        measure = vtkMassProperties()
        measure.SetInputConnection(contour.GetOutputPort())
        measure.Update()
        return measure.GetSurfaceArea()

    def test_contours_close_at_the_borders_of_pieces(self):
        for h in range(LEVELS):
            with self.subTest(h):
                contour = simple.Contour(
                    self.level(h), ContourBy=["POINTS", "RTData"], Isosurfaces=[ISO])
                expected = self.area_of_contour(h)
                self.assertAlmostEqual(integrated(contour, "Area") / expected, 1.0, places=5)

    def test_ghost_cells_do_not_count(self):
        for h, whole in enumerate(self.whole):
            with self.subTest(h):
                bounds = whole.GetBounds()
                volume = 1.0
                for axis in range(3):
                    volume *= bounds[2 * axis + 1] - bounds[2 * axis]
                self.assertAlmostEqual(
                    integrated(self.level(h), "Volume") / volume, 1.0, places=5)

    def test_a_filter_that_asks_some_for_nothing_leaves_the_levels_alone(self):
        contour = simple.Contour(self.level(1), ContourBy=["POINTS", "RTData"], Isosurfaces=[ISO])
        contour.UpdatePipeline()
        simple.Clean(contour).UpdatePipeline()
        # It would hang here if the others made their pieces anew.
        self.assertAlmostEqual(
            integrated(contour, "Area") / self.area_of_contour(1), 1.0, places=5)

    def test_saved_levels_are_read_again(self):
        name = testing.output_path(f"levels_of_{processes()}.vtm")
        simple.SaveData(name, proxy=self.pyramid)
        levels = simple.OpenDataFile(name)
        levels.UpdatePipeline()
        volume = integrated(levels, "Volume")
        self.assertAlmostEqual(volume / integrated(self.pyramid, "Volume"), 1.0, places=5)


testing.main()
