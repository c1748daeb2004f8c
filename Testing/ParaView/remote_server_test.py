# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The plugin on both sides of a connection: a pvserver of our own, and this script as its client."""

import os
import socket
import subprocess
import sys
import time
import unittest

from paraview import simple

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import plugin_testing as testing


def free_port():
    with socket.socket() as probe:
        probe.bind(("localhost", 0))
        return probe.getsockname()[1]


def start_server(port):
    """A pvserver that waits for a client on that port."""
    server = subprocess.Popen(
        [testing.program("pvserver"), f"--server-port={port}", "--force-offscreen-rendering"],
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL, text=True,
        preexec_fn=testing.end_with_parent)
    said = []
    for line in server.stdout:
        said.append(line)
        if "Accepting connection" in line:
            return server
    raise RuntimeError("pvserver ended: " + "".join(said))


def wavelet_pyramid():
    source = simple.Wavelet()
    source.UpdatePipeline()
    return simple.ImagePyramid(Input=source, NumberOfLevels=3)


class RemoteServerTest(unittest.TestCase):
    def setUp(self):
        # What the built-in server gives is what the remote one has to give.
        testing.load_plugin()
        self.local = testing.fetch(wavelet_pyramid())
        port = free_port()
        self.server = start_server(port)
        deadline = time.monotonic() + 30
        while not simple.Connect("localhost", port):
            self.assertLess(time.monotonic(), deadline, "no connection to pvserver")
            time.sleep(0.2)

    def tearDown(self):
        simple.Disconnect()
        # It ends by itself only once the last Python object of the session is gone.
        self.server.terminate()
        self.server.wait()
        self.server.stdout.close()

    def test_same_pyramid_as_without_a_server(self):
        testing.load_plugin(remote=True)
        filter_ = wavelet_pyramid()
        self.assertIsNone(filter_.GetClientSideObject(), "the filter runs on the server")
        remote = testing.fetch(filter_)
        self.assertEqual(remote.GetNumberOfBlocks(), 3)
        for here, there in zip(testing.levels(self.local), testing.levels(remote)):
            # ParaView's way to the client renumbers extents from 0, and moves the origin with it.
            self.assertEqual(here.GetDimensions(), there.GetDimensions())
            self.assertEqual(here.GetBounds(), there.GetBounds())
            for name in ("Level", "Unit"):
                self.assertEqual(here.GetFieldData().GetArray(name).GetTuple1(0),
                                 there.GetFieldData().GetArray(name).GetTuple1(0))
            self.assertEqual(testing.voxels(here, "RTData").tobytes(),
                             testing.voxels(there, "RTData").tobytes())
        information = filter_.GetDataInformation()
        self.assertEqual(information.GetCompositeDataClassName(), "vtkMultiBlockDataSet")


testing.main()
