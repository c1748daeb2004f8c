# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Run by mpirun with any number of processes: the surface of one, in a piece for each.

All is compared with what the same filters give a process alone. With PROCESSES_OF_SERVER=n the
script is a client, and starts a pvserver of so many processes; else it is run by pvbatch.
"""

import json
import os
import shutil
import socket
import subprocess
import sys
import threading
import unittest

import numpy

from paraview import servermanager
from paraview import simple
from paraview.vtk.util.numpy_support import vtk_to_numpy

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
# Not as `testing`: a programmable filter's script runs among the names of this module, and
# ParaView 5.13 brings those of numpy there before it, `testing` among them.
import plugin_testing
from vtkmodules.vtkFiltersCore import vtkMassProperties
from vtkmodules.vtkIOGeometry import vtkSTLReader
from vtkmodules.vtkImagingCore import vtkRTAnalyticSource
from vtkmodules.vtkParallelCore import vtkMultiProcessController

SERVER = int(os.environ.get("PROCESSES_OF_SERVER", "0"))
EXTENT = [-14, 14] * 3
ISO_VALUE = 160.0
INTERVAL = 30  # of snapshots
# Whether it is there and what it has, as each process sees it.
TELL = """
import json, os
from vtkmodules.vtkParallelCore import vtkMultiProcessController
rank = vtkMultiProcessController.GetGlobalController().GetLocalProcessId()

def arrays(data):
    return {name: data.GetAbstractArray(name).GetNumberOfTuples() for name in
            map(data.GetArrayName, range(data.GetNumberOfArrays()))}

def fields(data):
    return {name: [str(data.GetAbstractArray(name).GetVariantValue(i)) for i in range(count)]
            for name, count in arrays(data).items()}

def tell(data):
    if data is None:
        return None
    if data.IsA("vtkMultiBlockDataSet"):
        return [[data.GetMetaData(b).Get(data.NAME()), tell(data.GetBlock(b))]
                for b in range(data.GetNumberOfBlocks())]
    if data.IsA("vtkTable"):
        return arrays(data.GetRowData())
    return {"cells": data.GetNumberOfCells(), "points": data.GetNumberOfPoints(),
            "of points": arrays(data.GetPointData()), "of cells": arrays(data.GetCellData()),
            "fields": fields(data.GetFieldData())}

with open(os.path.join(FOLDER, f"{rank}.json"), "w") as file:
    json.dump(tell(self.GetInputDataObject(0, 0)), file)
"""


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


def volume_of(surface):
    masses = vtkMassProperties()
    masses.SetInputData(surface)
    masses.Update()
    return masses.GetVolume()


def make_surface(**properties):
    return simple.DeformableSurface(simple.Wavelet(WholeExtent=EXTENT), IsoValue=ISO_VALUE,
                                    **properties)


class ParallelSurfaceTest(unittest.TestCase):
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
        alone.SetSnapshotInterval(INTERVAL)
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

    def fetch(self, proxy, port=0):
        return plugin_testing.fetch(proxy, port)

    def told(self, proxy, port=0):
        """What each process has of an output."""
        folder = plugin_testing.output_path(f"processes-{self.count}-{SERVER}")
        shutil.rmtree(folder, ignore_errors=True)
        os.makedirs(folder)
        programmable = simple.ProgrammableFilter(
            Input=servermanager.OutputPort(proxy, port), Script=f"FOLDER = {folder!r}\n{TELL}",
            OutputDataSetType="vtkTable")
        programmable.UpdatePipeline()
        told = []
        for rank in range(self.count):
            with open(os.path.join(folder, f"{rank}.json"), encoding="utf-8") as file:
                told.append(json.load(file))
        return told

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

    def test_the_pieces_are_the_whole(self):
        self.check_pieces(self.fetch(make_surface()), self.whole)

    def test_the_surface_of_a_pyramid(self):
        pyramid = simple.ImagePyramid(simple.Wavelet(WholeExtent=EXTENT))
        surface = simple.DeformableSurface(pyramid, IsoValue=ISO_VALUE)
        fetched = self.fetch(surface)
        # ParaView would ask for ghosts of what comes of blocks.
        self.assertFalse(fetched.GetCellData().HasArray("vtkGhostType"))
        self.check_pieces(fetched, self.whole)

    def test_each_process_has_its_piece_and_all_facts(self):
        told = self.told(make_surface())
        self.assertEqual(numpy.sum([one["cells"] for one in told]), self.whole.GetNumberOfCells())
        self.assertLessEqual(numpy.ptp([one["cells"] for one in told]), 1)
        area = self.whole.GetFieldData().GetArray("Area").GetVariantValue(0)
        for one in told:
            self.assertEqual(one["fields"], told[0]["fields"])
            self.assertEqual(one["fields"]["Area"], [str(area)])
            self.assertEqual(one["of points"]["Residual"], one["points"])
            self.assertEqual(one["of cells"]["Component"], one["cells"])
            self.assertNotIn("vtkGhostType", one["of cells"])

    def test_blocks_and_history(self):
        filter_ = make_surface(SnapshotInterval=INTERVAL)
        for port, alone in ((1, self.alone.GetLevels()), (3, self.alone.GetSnapshots())):
            told = self.told(filter_, port)
            for one in told:
                self.assertEqual([name for name, _ in one], plugin_testing.names(alone))
            for block in range(alone.GetNumberOfBlocks()):
                whole = alone.GetBlock(block)
                here = [one[block][1] for one in told if one[block][1]]
                self.assertEqual(len(here), self.count if whole else 0)
                if whole:
                    self.assertEqual(numpy.sum([one["cells"] for one in here]),
                                     whole.GetNumberOfCells())
        told = self.told(filter_, 2)
        rows = self.alone.GetHistory().GetNumberOfRows()
        self.assertEqual(set(told[0].values()), {rows})
        for one in told[1:]:
            self.assertEqual(list(one), list(told[0]))
            self.assertEqual(set(one.values()), {0})
        self.assertEqual(self.fetch(filter_, 2).GetNumberOfRows(), rows)

    def test_connectivity_finds_the_components(self):
        # Four separate balls, cut by planes between the processes.
        balls = plugin_testing.write_volume(f"balls-{self.count}-{SERVER}.vti", self.balls())
        volume = simple.XMLImageDataReader(FileName=[balls])
        surface = simple.DeformableSurface(volume, IsoValue=0.5)
        regions = self.fetch(simple.Connectivity(surface))
        self.assertEqual(plugin_testing.field(self.fetch(surface), "NumberOfComponents"), 4)
        found = numbers(regions.GetCellData().GetArray("RegionId"))
        component = numbers(regions.GetCellData().GetArray("Component"))
        self.assertEqual(len(set(zip(found, component))), 4)
        self.assertEqual(len(set(found)), 4)

    @staticmethod
    def balls():
        z, y, x = numpy.mgrid[0:40, 0:40, 0:40].astype(numpy.float32)
        inside = numpy.zeros_like(x)
        balls = ((10, 10, 10, 6), (28, 12, 20, 7), (12, 28, 26, 8), (30, 30, 9, 5))
        for cx, cy, cz, radius in balls:
            far = numpy.sqrt((x - cx)**2 + (y - cy)**2 + (z - cz)**2)
            inside = numpy.maximum(inside, numpy.clip(0.5 + 0.4 * (radius - far), 0, 1))
        return plugin_testing.make_image(inside)

    def test_clean_closes_the_borders(self):
        cleaned = self.fetch(simple.Clean(make_surface()))
        self.assertEqual(cleaned.GetNumberOfPoints(), self.whole.GetNumberOfPoints())
        self.assertEqual(cleaned.GetNumberOfCells(), self.whole.GetNumberOfCells())

    def test_saved_files(self):
        pieces = plugin_testing.output_path(f"surface-{self.count}-{SERVER}.pvtp")
        simple.SaveData(pieces, proxy=make_surface())
        self.check_pieces(self.fetch(simple.XMLPartitionedPolydataReader(FileName=[pieces])),
                          self.whole)
        triangles_only = plugin_testing.output_path(f"surface-{self.count}-{SERVER}.stl")
        simple.SaveData(triangles_only, proxy=make_surface())
        reader = vtkSTLReader()
        reader.SetFileName(triangles_only)
        reader.Update()
        read = reader.GetOutput()
        self.assertEqual(read.GetNumberOfCells(), self.whole.GetNumberOfCells())
        self.assertEqual(read.GetNumberOfPoints(), self.whole.GetNumberOfPoints())
        self.assertAlmostEqual(volume_of(read), volume_of(self.whole), delta=0.1)

    def test_an_error_and_then_a_good_run(self):
        surface = make_surface()
        surface.SeedRadius = -1.0
        with plugin_testing.CapturedMessages() as messages:
            surface.UpdatePipeline()
        if not SERVER:
            self.assertIn("Seed Radius is -1", messages.text)
        self.assertEqual(surface.GetDataInformation().GetNumberOfCells(), 0)
        surface.SeedRadius = 0.0
        self.check_pieces(self.fetch(surface), self.whole)



plugin_testing.main()
