# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Run by mpirun with any number of processes: what one process makes, in a piece for each.

All is compared with what the same filters give a process alone. With PROCESSES_OF_SERVER=n the
script is a client, and starts a pvserver of so many processes; else it is run by pvbatch.
"""

import os
import socket
import subprocess
import sys
import threading
import unittest

import numpy

from paraview import simple
from paraview.vtk.util.numpy_support import vtk_to_numpy

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
# Not as `testing`: a programmable filter's script runs among the names of this module, and
# ParaView 5.13 brings those of numpy there before it, `testing` among them.
import label_maps
import plugin_testing
from vtkmodules.vtkImagingCore import vtkRTAnalyticSource
from vtkmodules.vtkParallelCore import vtkMultiProcessController

SERVER = int(os.environ.get("PROCESSES_OF_SERVER", "0"))
EXTENT = [-14, 14] * 3
ISO_VALUE = 160.0


def number_of_processes():
    return SERVER or vtkMultiProcessController.GetGlobalController().GetNumberOfProcesses()


def connect_to_server():
    """A pvserver of several processes, which ends when its client does."""
    with socket.socket() as probe:
        probe.bind(("localhost", 0))
        port = probe.getsockname()[1]
    # Without the variables by which this process itself is one of MPI.
    environment = {name: value for name, value in os.environ.items()
                   if not name.startswith(("OMPI_", "OPAL_", "ORTE_", "PMIX_"))}
    server = subprocess.Popen(
        [os.environ["VOLUMIC_MPIRUN"], "--allow-run-as-root", "--oversubscribe", "-n", str(SERVER),
         plugin_testing.program("pvserver"), f"--server-port={port}", "--force-offscreen-rendering"],
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL, text=True,
        env=environment, preexec_fn=plugin_testing.end_with_parent)
    said = []
    for line in server.stdout:
        said.append(line)
        if "Accepting connection" in line:
            break
    else:
        raise RuntimeError("pvserver ended: " + "".join(said))
    # What it says later, such as errors that tests provoke, is for nobody.
    threading.Thread(target=server.stdout.read, daemon=True).start()
    if not simple.Connect("localhost", port):
        raise RuntimeError("no connection to pvserver")
    return server


def numbers(array):
    return vtk_to_numpy(array)


def triangles(surface):
    return numbers(surface.GetPolys().GetConnectivityArray()).reshape(-1, 3)


def make_surface(**properties):
    return simple.DeformableSurface(simple.Wavelet(WholeExtent=EXTENT), IsoValue=ISO_VALUE,
                                    **properties)


class ParallelTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        plugin_testing.load_plugin()
        if SERVER:
            cls.server = connect_to_server()
            plugin_testing.load_plugin(remote=True)
        cls.count = number_of_processes()
        image = vtkRTAnalyticSource()
        image.SetWholeExtent(*EXTENT)
        alone = plugin_testing.load_package().vtkDeformableSurface()
        alone.SetController(None)
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

    def tearDown(self):
        plugin_testing.delete_sources()

    def check_pieces(self, surface, whole):
        """That what was gathered of the pieces is the whole, bit by bit."""
        ids = surface.GetPointData().GetGlobalIds()
        if self.count == 1:
            self.assertIsNone(ids)
            ids = numpy.arange(surface.GetNumberOfPoints())
        else:
            self.assertEqual(ids.GetName(), "GlobalIds")
            ids = numbers(ids)
        self.assertEqual(set(ids), set(range(whole.GetNumberOfPoints())))
        numpy.testing.assert_array_equal(numbers(surface.GetPoints().GetData()),
                                         numbers(whole.GetPoints().GetData())[ids])
        # Files have a layer of ghosts: ParaView asks for it as it writes them.
        types = surface.GetCellData().GetArray("vtkGhostType")
        own = numbers(types) == 0 if types else slice(None)
        numpy.testing.assert_array_equal(ids[triangles(surface)][own], triangles(whole))
        for data, of, index in ((surface.GetPointData(), whole.GetPointData(), ids),
                                (surface.GetCellData(), whole.GetCellData(), slice(None))):
            for i in range(of.GetNumberOfArrays()):
                name = of.GetArrayName(i)
                found = numbers(data.GetArray(name))
                numpy.testing.assert_array_equal(
                    found[own] if of is whole.GetCellData() else found,
                    numbers(of.GetArray(name))[index], name)

    def test_the_surface_of_a_pyramid(self):
        pyramid = simple.ImagePyramid(simple.Wavelet(WholeExtent=EXTENT))
        surface = simple.DeformableSurface(pyramid, IsoValue=ISO_VALUE)
        fetched = plugin_testing.fetch(surface)
        # ParaView would ask for ghosts of what comes of blocks.
        self.assertFalse(fetched.GetCellData().HasArray("vtkGhostType"))
        self.check_pieces(fetched, self.whole)

    def test_the_pieces_are_the_whole(self):
        surface = make_surface()
        fetched = plugin_testing.fetch(surface)
        self.check_pieces(fetched, self.whole)
        self.assertFalse(fetched.GetCellData().HasArray("vtkGhostType"))
        # One of each: those of all processes are alike.
        for name in ("Area", "EulerCharacteristic"):
            self.assertEqual(plugin_testing.field(fetched, name),
                             plugin_testing.field(self.whole, name))
        self.assertEqual(plugin_testing.fetch(surface, 2).GetNumberOfRows(),
                         self.alone.GetHistory().GetNumberOfRows())

    def test_clean_closes_the_borders(self):
        cleaned = plugin_testing.fetch(simple.Clean(make_surface()))
        self.assertEqual(cleaned.GetNumberOfPoints(), self.whole.GetNumberOfPoints())
        self.assertEqual(cleaned.GetNumberOfCells(), self.whole.GetNumberOfCells())

    def test_saved_files(self):
        pieces = plugin_testing.output_path(f"surface-{self.count}-{SERVER}.pvtp")
        simple.SaveData(pieces, proxy=make_surface())
        self.check_pieces(plugin_testing.fetch(simple.XMLPartitionedPolydataReader(FileName=[pieces])),
                          self.whole)

    def test_levels_in_pieces(self):
        pyramid = simple.ImagePyramid(simple.Wavelet(WholeExtent=EXTENT), NumberOfLevels=2)
        level = simple.ExtractBlock(pyramid, Selectors=["/Root/Level1"])
        contour = simple.Contour(level, ContourBy=["POINTS", "RTData"], Isosurfaces=[ISO_VALUE])
        contour.UpdatePipeline()
        # It would hang here if those that Clean asks for nothing made their pieces anew.
        simple.Clean(contour).UpdatePipeline()
        for proxy, name in ((level, "Volume"), (contour, "Area")):
            sums = plugin_testing.fetch(simple.IntegrateVariables(proxy))
            self.assertGreater(sums.GetCellData().GetArray(name).GetTuple1(0), 0.0)
        bounds = level.GetDataInformation().GetBounds()
        sums = plugin_testing.fetch(simple.IntegrateVariables(level))
        self.assertAlmostEqual(  # Ghost cells do not count.
            sums.GetCellData().GetArray("Volume").GetTuple1(0) /
            numpy.prod([bounds[1] - bounds[0], bounds[3] - bounds[2], bounds[5] - bounds[4]]),
            1.0, places=5)

    @unittest.skipIf(SERVER, "the client's image is another one")
    def test_the_threshold_of_the_whole_image(self):
        filter_ = simple.VolumetoSurface(simple.Wavelet(WholeExtent=EXTENT))
        plugin_testing.fetch(filter_)
        otsu = plugin_testing.load_package().vtkOtsuThreshold()
        otsu.SetController(None)
        otsu.SetInputConnection(self.alone.GetInputConnection(0, 0))
        otsu.Update()
        self.assertEqual(filter_.IsoValue, otsu.GetThreshold())

    def test_surfaces_of_labels(self):
        """The first process has them; the others have the same blocks, or ParaView would hang."""
        path = plugin_testing.write_volume(f"labels-{self.count}-{SERVER}.vti", label_maps.image())
        filter_ = simple.LabelstoSurfaces(simple.XMLImageDataReader(FileName=[path]))
        filter_.UpdatePipeline()
        self.assertGreater(filter_.GetDataInformation().GetNumberOfPoints(), 500)
        saved = plugin_testing.output_path(f"labels-{self.count}-{SERVER}.vtm")
        simple.SaveData(saved, filter_)
        with open(saved, encoding="utf-8") as file:
            text = file.read()
        for label in label_maps.BALLS:
            self.assertEqual(text.count(f'name="Label {label}"'), 1, text)

    def test_an_error_and_then_a_good_run(self):
        surface = make_surface()
        surface.SeedRadius = -1.0
        with plugin_testing.CapturedMessages() as messages:
            surface.UpdatePipeline()
        if not SERVER:
            self.assertIn("Seed Radius is -1", messages.text)
        self.assertEqual(surface.GetDataInformation().GetNumberOfCells(), 0)
        surface.SeedRadius = 0.0
        self.check_pieces(plugin_testing.fetch(surface), self.whole)


plugin_testing.main()
