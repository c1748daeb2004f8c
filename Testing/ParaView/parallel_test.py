# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Run by mpirun with two processes: pieces are not taken for the whole, nor made twice."""

import os
import sys

from paraview import servermanager
from paraview import simple
from paraview.vtk.util.numpy_support import vtk_to_numpy

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import label_maps
import plugin_testing as testing
from vtkmodules.vtkImagingCore import vtkRTAnalyticSource
from vtkmodules.vtkParallelCore import vtkMultiProcessController


class ParallelTest(testing.PluginTestCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.package = testing.load_package()

    def test_there_are_two_processes(self):
        self.assertEqual(vtkMultiProcessController.GetGlobalController().GetNumberOfProcesses(), 2)

    def test_each_process_asks_for_its_piece_of_the_image(self):
        for make in (simple.ImagePyramid, simple.DeformableSurface, simple.VolumetoSurface):
            with self.subTest(make.__name__):
                wavelet = simple.Wavelet()
                # Without a value the image would be asked for Otsu's threshold first.
                given = {} if make is simple.ImagePyramid else {"IsoValue": 150.0}
                make(wavelet, **given).UpdatePipeline()
                # The sum over the processes, which share a layer.
                layers = wavelet.GetDataInformation().GetNumberOfPoints() / 21**2
                self.assertEqual(layers, 22)

    def check_one_whole_surface(self, source, make=None, **properties):
        source.UpdatePipeline()
        filter_ = (make or simple.DeformableSurface)(source, **properties)
        filter_.UpdatePipeline()
        # Fields and history of one surface: twice as many if both processes had made it.
        surface = servermanager.Fetch(filter_)
        self.assertEqual(surface.GetFieldData().GetArray("Area").GetNumberOfTuples(), 1)
        characteristic = surface.GetFieldData().GetArray("EulerCharacteristic").GetTuple1(0)
        information = filter_.GetDataInformation()
        # Closed triangles: V - E + F with 2 E = 3 F. Points at borders of pieces are there twice.
        points = len(set(vtk_to_numpy(surface.GetPointData().GetGlobalIds())))
        cells = information.GetNumberOfCells()
        # Of a pyramid ParaView asks for ghosts, too.
        ghosts = surface.GetCellData().GetArray("vtkGhostType")
        cells -= int((vtk_to_numpy(ghosts) != 0).sum()) if ghosts else 0
        self.assertEqual(2 * points - cells, 2 * characteristic)
        self.assertEqual(surface.GetNumberOfPoints(), information.GetNumberOfPoints())
        history = servermanager.Fetch(filter_, idx=2)
        iterations = [history.GetColumnByName("Iteration").GetTuple1(row)
                      for row in range(history.GetNumberOfRows())]
        self.assertEqual(iterations, list(range(1, len(iterations) + 1)))
        return filter_

    def test_one_whole_surface_of_an_image(self):
        self.check_one_whole_surface(simple.Wavelet())

    def test_one_whole_surface_at_the_threshold_of_the_whole_image(self):
        filter_ = self.check_one_whole_surface(simple.Wavelet(), simple.VolumetoSurface)
        otsu = self.package.vtkOtsuThreshold()
        # What simple.Wavelet gives a single process.
        whole = vtkRTAnalyticSource()
        otsu.SetInputConnection(whole.GetOutputPort())
        otsu.Update()
        self.assertEqual(filter_.IsoValue, otsu.GetThreshold())

    def test_one_whole_surface_of_a_pyramid(self):
        wavelet = simple.Wavelet()
        wavelet.UpdatePipeline()
        self.check_one_whole_surface(simple.ImagePyramid(wavelet))

    def test_one_whole_surface_from_one_that_each_process_holds_a_part_of(self):
        sphere = simple.Sphere(Radius=14.0, ThetaResolution=12, PhiResolution=12)
        self.check_one_whole_surface(simple.Wavelet(), InitialSurface=sphere,
                                     Initialization="Input Surface")

    def test_surfaces_of_labels(self):
        """The first process makes them; the others have the same blocks, or ParaView would hang."""
        path = testing.write_volume("labels-parallel.vti", label_maps.image())
        filter_ = simple.LabelstoSurfaces(simple.XMLImageDataReader(FileName=path))
        filter_.Labels = [3, 99]
        with testing.CapturedMessages() as messages:
            filter_.UpdatePipeline()
        self.assertEqual(messages.text.count("ERROR: "), 1, messages.text)
        filter_.Labels = []
        filter_.UpdatePipeline()
        information = filter_.GetDataInformation()
        count = information.GetNumberOfPoints()
        self.assertGreater(count, 500)
        saved = testing.output_path("labels-parallel.vtm")
        simple.SaveData(saved, filter_)
        with open(saved, encoding="utf-8") as file:
            text = file.read()
        for label in label_maps.BALLS:
            self.assertEqual(text.count(f'name="Label {label}"'), 1, text)
        again = simple.XMLMultiBlockDataReader(FileName=saved)
        again.UpdatePipeline()
        self.assertEqual(again.GetDataInformation().GetNumberOfPoints(), count)


testing.main()
