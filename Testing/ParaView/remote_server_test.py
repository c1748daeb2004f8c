# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The plugin in a pvserver, and in this script as its client."""

import unittest

from paraview import servermanager
from paraview import simple

import label_maps
import plugin_testing as testing
import volume_reader_test as files


def outputs_of(filter_):
    filter_.UpdatePipeline()
    return [servermanager.Fetch(filter_, idx=port) for port in range(4)]


def wavelet_to_surface():
    source = simple.Wavelet()
    source.UpdatePipeline()
    return simple.VolumetoSurface(source, SnapshotInterval=30)


def labels_to_surfaces(path):
    reader = simple.XMLImageDataReader(FileName=path)
    reader.UpdatePipeline()
    return simple.LabelstoSurfaces(reader, Labels=[3, 7], LabelNames=["7", "kidney"])


class RemoteServerTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        # Expected outputs, by the built-in server.
        testing.load_plugin()
        filter_ = wavelet_to_surface()
        cls.local_iso_value = filter_.IsoValue
        cls.local_outputs = outputs_of(filter_)
        cls.label_map = testing.write_volume("labels-remote.vti", label_maps.image())
        cls.local_labels = testing.fetch(labels_to_surfaces(cls.label_map))
        cls.server = testing.connect_to_server()
        testing.load_plugin(remote=True)

    @classmethod
    def tearDownClass(cls):
        simple.Disconnect()
        # The server ends only after the last Python object of the session. On SIGTERM, the handler of
        # loguru allocates memory, which may deadlock within free().
        cls.server.kill()
        cls.server.wait()
        cls.server.stdout.close()

    def check_same_points(self, surface, expected):
        self.assertEqual(testing.points(surface).tobytes(), testing.points(expected).tobytes())

    def test_same_surface_as_without_a_server(self):
        filter_ = wavelet_to_surface()
        self.assertIsNone(filter_.GetClientSideObject(), "the filter runs on the server")
        # The server computes the preset.
        self.assertEqual(filter_.IsoValue, self.local_iso_value)
        surface, levels, history, snapshots = outputs_of(filter_)
        here = self.local_outputs
        self.assertGreater(surface.GetNumberOfPolys(), 0)
        self.check_same_points(surface, here[0])
        self.assertEqual(levels.GetNumberOfBlocks(), here[1].GetNumberOfBlocks())
        self.assertEqual(history.GetNumberOfRows(), here[2].GetNumberOfRows())
        self.assertEqual(history.GetNumberOfColumns(), here[2].GetNumberOfColumns())
        self.assertEqual(testing.names(snapshots), testing.names(here[3]))
        for there, local in zip(testing.levels(snapshots), testing.levels(here[3])):
            self.check_same_points(there, local)

    def test_histogram_beside_iso_value(self):
        source = simple.Wavelet()
        source.UpdatePipeline()
        helper = servermanager.ProxyManager().SMProxyManager.NewProxy(
            "internal_filters", "OtsuThreshold")
        helper.GetProperty("Input").AddInputConnection(source.SMProxy, 0)
        helper.UpdateVTKObjects()
        helper.UpdatePipeline()
        helper.UpdatePropertyInformation()
        histogram = servermanager.vtkSMPropertyHelper(helper, "Histogram")
        values = [histogram.GetAsDouble(i) for i in range(histogram.GetNumberOfElements())]
        self.assertEqual(tuple(values[:2]), source.PointData["RTData"].GetRange())
        self.assertEqual(sum(values[2:]), 21 ** 3)

    def test_same_labels_as_without_a_server(self):
        filter_ = labels_to_surfaces(self.label_map)
        self.assertIsNone(filter_.GetClientSideObject(), "the filter runs on the server")
        remote = testing.fetch(filter_)
        self.assertEqual(testing.names(remote), ["Label 3", "kidney"])
        for here, there in zip(testing.levels(self.local_labels), testing.levels(remote)):
            self.assertGreater(there.GetNumberOfPolys(), 0)
            self.check_same_points(there, here)
        # The colour map of the client has the names and colours of the server.
        view = simple.CreateView("RenderView")
        display = simple.Show(filter_, view)
        view.Update()
        colors = display.LookupTable
        self.assertEqual(list(colors.Annotations), ["3", "Label 3", "7", "kidney"])
        color = self.local_labels.GetBlock(1).GetFieldData().GetArray("LabelColor").GetTuple(0)
        self.assertEqual(tuple(colors.IndexedColors)[3:], color)

    def test_files_are_read_and_written_by_the_server(self):
        reader = simple.VolumicVolume(FileNames=[files.segmentation()])
        self.assertIsNone(reader.GetClientSideObject(), "the reader runs on the server")
        surfaces = simple.LabelstoSurfaces(reader, FinestLevel=1)
        self.assertEqual(testing.names(testing.fetch(surfaces)), ["liver", "left kidney", "spleen"])
        path = testing.output_path("remote.glb")
        simple.SaveData(path, surfaces)  # as File > Save Data
        with open(path, "rb") as file:
            self.assertIn(b"left kidney", file.read())
