# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Filters in any number of processes under mpirun: the first process makes the output of one process.

With PROCESSES_OF_SERVER=n the script is a client, and starts a pvserver with n processes. Otherwise
pvbatch runs it.
"""

import faulthandler
import os
import sys
import unittest

import numpy

from paraview import simple
from paraview.vtk.util.numpy_support import vtk_to_numpy

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
# Not imported as `testing`: in ParaView 5.13 the script of a programmable filter imports the names of
# numpy, such as `testing`, into this module.
import label_maps
import plugin_testing
from vtkmodules.vtkImagingCore import vtkRTAnalyticSource
from vtkmodules.vtkParallelCore import vtkMultiProcessController

SERVER = int(os.environ.get("PROCESSES_OF_SERVER", "0"))
EXTENT = [-14, 14] * 3
ISO_VALUE = 160.0
SECONDS = 600  # limit of a test, to report deadlocks of processes


def triangles(surface):
    return vtk_to_numpy(surface.GetPolys().GetConnectivityArray()).reshape(-1, 3)


def make_surface(**properties):
    return simple.DeformableSurface(simple.Wavelet(WholeExtent=EXTENT), IsoValue=ISO_VALUE,
                                    **properties)


class ParallelTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        plugin_testing.load_plugin()
        if SERVER:
            # Without the variables of MPI of this process.
            environment = {name: value for name, value in os.environ.items()
                           if not name.startswith(("OMPI_", "OPAL_", "ORTE_", "PMIX_"))}
            cls.server = plugin_testing.connect_to_server(
                os.environ["VOLUMIC_MPIRUN"], "--allow-run-as-root", "--oversubscribe", "-n",
                str(SERVER), env=environment)
            plugin_testing.load_plugin(remote=True)
        cls.count = (SERVER or
                     vtkMultiProcessController.GetGlobalController().GetNumberOfProcesses())
        image = vtkRTAnalyticSource()
        image.SetWholeExtent(*EXTENT)
        alone = plugin_testing.load_package().vtkDeformableSurface()
        alone.SetInputConnection(image.GetOutputPort())
        alone.SetIsoValue(ISO_VALUE)
        alone.Update()
        cls.alone = alone
        cls.whole = alone.GetOutput()

    @classmethod
    def tearDownClass(cls):
        if SERVER:
            simple.Disconnect()
            cls.server.terminate()
            cls.server.wait(30)

    def setUp(self):
        faulthandler.dump_traceback_later(SECONDS, exit=True, file=sys.__stderr__)

    def tearDown(self):
        plugin_testing.delete_sources()
        faulthandler.cancel_dump_traceback_later()

    def check_surface(self, surface):
        """Check that the surface is bit-identical to that of one process."""
        numpy.testing.assert_array_equal(plugin_testing.points(surface),
                                         plugin_testing.points(self.whole))
        numpy.testing.assert_array_equal(triangles(surface), triangles(self.whole))
        for data, of in ((surface.GetPointData(), self.whole.GetPointData()),
                         (surface.GetCellData(), self.whole.GetCellData())):
            for i in range(of.GetNumberOfArrays()):
                name = of.GetArrayName(i)
                numpy.testing.assert_array_equal(vtk_to_numpy(data.GetArray(name)),
                                                 vtk_to_numpy(of.GetArray(name)), name)
            self.assertFalse(data.HasArray("vtkGhostType"))

    def check_blocks(self, output, names):
        """Check that all processes have these blocks. Otherwise views and files hang."""
        with plugin_testing.CapturedMessages() as messages:
            view = simple.CreateView("RenderView")
            simple.Show(output, view)
            if "DISPLAY" in os.environ:
                simple.Render(view)
            simple.Delete(view)
            path = plugin_testing.output_path("blocks.vtm")
            simple.SaveData(path, output)
        self.assertEqual(messages.text, "")
        with open(path, encoding="utf-8") as file:
            text = file.read()
        for name in names:
            self.assertEqual(text.count(f'name="{name}"'), 1, text)

    def test_the_surface_of_an_image(self):
        surface = make_surface()
        fetched = plugin_testing.fetch(surface)
        self.check_surface(fetched)
        # Values in the panel.
        data = surface.GetDataInformation()
        self.assertEqual(data.GetNumberOfPoints(), self.whole.GetNumberOfPoints())
        for name in ("Area", "EulerCharacteristic"):
            self.assertEqual(plugin_testing.field(fetched, name),
                             plugin_testing.field(self.whole, name))
        self.assertEqual(plugin_testing.fetch(surface, 2).GetNumberOfRows(),
                         self.alone.GetHistory().GetNumberOfRows())

    def test_downstream_filters(self):
        cleaned = plugin_testing.fetch(simple.Clean(make_surface()))
        self.assertEqual(cleaned.GetNumberOfPoints(), self.whole.GetNumberOfPoints())
        self.assertEqual(cleaned.GetNumberOfCells(), self.whole.GetNumberOfCells())
        pyramid = simple.ImagePyramid(simple.Wavelet(WholeExtent=EXTENT), NumberOfLevels=2)
        level = simple.ExtractBlock(pyramid, Selectors=["/Root/Level1"])
        contour = simple.Contour(level, ContourBy=["POINTS", "RTData"], Isosurfaces=[ISO_VALUE])
        sums = plugin_testing.fetch(simple.IntegrateVariables(simple.Clean(contour)))
        self.assertGreater(sums.GetCellData().GetArray("Area").GetTuple1(0), 0.0)

    def test_saved_files(self):
        path = plugin_testing.output_path("surface.pvtp")
        simple.SaveData(path, proxy=make_surface())
        read = plugin_testing.fetch(simple.XMLPartitionedPolydataReader(FileName=[path]))
        numpy.testing.assert_array_equal(triangles(read), triangles(self.whole))

    @unittest.skipIf(SERVER, "the client's image is another one")
    def test_the_threshold_of_the_whole_image(self):
        filter_ = simple.VolumetoSurface(simple.Wavelet(WholeExtent=EXTENT))
        plugin_testing.fetch(filter_)
        otsu = plugin_testing.load_package().vtkOtsuThreshold()
        otsu.SetInputConnection(self.alone.GetInputConnection(0, 0))
        otsu.Update()
        self.assertEqual(filter_.IsoValue, otsu.GetThreshold())

    def test_surfaces_of_labels(self):
        path = plugin_testing.write_volume("labels.vti", label_maps.image())
        filter_ = simple.LabelstoSurfaces(simple.XMLImageDataReader(FileName=[path]))
        filter_.UpdatePipeline()
        self.assertGreater(filter_.GetDataInformation().GetNumberOfPoints(), 500)
        self.check_blocks(filter_, [f"Label {label}" for label in label_maps.BALLS])

    def test_levels(self):
        names = [f"Level {level}" for level in range(self.alone.GetLevels().GetNumberOfBlocks())]
        for filter_, finer in (
                (make_surface(), []), (make_surface(FinestLevel=-1), ["Level -1"]),
                (simple.DeformableSurface(simple.ImagePyramid(simple.Wavelet(WholeExtent=EXTENT)),
                                          IsoValue=ISO_VALUE), [])):
            filter_.UpdatePipeline()
            self.check_blocks(simple.OutputPort(filter_, 1), names + finer)

    def test_a_distributed_image(self):
        image = simple.ResampleToImage(simple.Wavelet(WholeExtent=EXTENT),
                                       SamplingDimensions=[29] * 3)
        surface = simple.DeformableSurface(image, IsoValue=ISO_VALUE)
        with plugin_testing.CapturedMessages() as messages:
            surface.UpdatePipeline()
        if self.count == 1:
            self.assertEqual(messages.text, "")
        elif not SERVER:
            self.assertIn("Save the distributed image as .pvti", messages.text)
        if self.count > 1:
            self.assertEqual(surface.GetDataInformation().GetNumberOfCells(), 0)
        path = plugin_testing.output_path("image.pvti")
        simple.SaveData(path, image)
        surface = simple.DeformableSurface(simple.XMLPartitionedImageDataReader(FileName=[path]),
                                           IsoValue=ISO_VALUE)
        surface.UpdatePipeline()
        self.assertGreater(surface.GetDataInformation().GetNumberOfCells(), 1000)


plugin_testing.main()
