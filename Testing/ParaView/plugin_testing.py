# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Functions of the tests of the plugin: load it, make images, and read outputs."""

import ctypes
import importlib
import os
import signal
import socket
import subprocess
import sys
import threading
import unittest

import numpy
from paraview import servermanager
from paraview import simple
from paraview.vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkOutputWindow, vtkStringOutputWindow
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkIOXML import vtkXMLImageDataWriter


def plugin_path():
    return os.environ["VOLUMIC_PLUGIN"]


def program(name):
    """Return the path of one of ParaView's programs."""
    return os.path.join(os.environ["VOLUMIC_PARAVIEW_BIN"], name)


def end_with_parent():
    """For preexec_fn of Popen: let the program end with the test, also if ctest kills the test."""
    PR_SET_PDEATHSIG = 1
    ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGKILL)


def connect_to_server(*launcher, **options):
    """Connect to a new pvserver, and return it. launcher: command that starts it; options: of Popen."""
    with socket.socket() as probe:
        probe.bind(("localhost", 0))
        port = probe.getsockname()[1]
    server = subprocess.Popen(
        [*launcher, program("pvserver"), f"--server-port={port}", "--force-offscreen-rendering"],
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL, text=True,
        preexec_fn=end_with_parent, **options)
    printed = []
    for line in server.stdout:
        printed.append(line)
        if "Accepting connection" in line:
            break
    else:
        raise RuntimeError("pvserver ended: " + "".join(printed))
    # Ignore its later output.
    threading.Thread(target=server.stdout.read, daemon=True).start()
    if not simple.Connect("localhost", port):
        raise RuntimeError("no connection to pvserver")
    return server


def output_path(name):
    """Return the path of a file that a test writes."""
    return os.path.join(os.environ["VOLUMIC_TEST_OUTPUT"], name)


def load_plugin(remote=False):
    simple.LoadPlugin(plugin_path(), remote=remote, ns=simple.__dict__)


def load_package():
    """Return the Python package. After its import, objects of the plugin have their classes."""
    sys.path.insert(0, os.environ["VOLUMIC_PYTHON"])
    return importlib.import_module("volumic")


def distances(size, position=(0.0, 0.0, 0.0)):
    """Return distances of the voxels [z, y, x] of a cube to a position relative to its centre."""
    x, y, z = (numpy.arange(size) - (size - 1) / 2 - c for c in position)
    return numpy.sqrt(x[None, None, :]**2 + y[None, :, None]**2 + z[:, None, None]**2)


def make_image(values, spacing=(1.0, 1.0, 1.0), origin=(0.0, 0.0, 0.0), start=(0, 0, 0), name="v"):
    """Return a vtkImageData of values[z, y, x] whose extent begins at `start`."""
    image = vtkImageData()
    size = values.shape[::-1]
    image.SetExtent(*[bound for s, n in zip(start, size) for bound in (s, s + n - 1)])
    image.SetSpacing(spacing)
    image.SetOrigin(origin)
    add_array(image, values, name)
    image.GetPointData().SetActiveScalars(name)
    return image


def add_array(image, values, name):
    array = numpy_to_vtk(values.ravel(), deep=True)
    array.SetName(name)
    image.GetPointData().AddArray(array)


def produce(data):
    """Return a source whose output is the data object (not with a remote server)."""
    source = simple.TrivialProducer(registrationName="data")
    source.GetClientSideObject().SetOutput(data)
    source.UpdatePipeline()
    return source


def write_volume(file_name, image):
    """Write a .vti file, and return its path."""
    path = output_path(file_name)
    writer = vtkXMLImageDataWriter()
    writer.SetDataModeToBinary()  # see volumic.writing.surfaces
    writer.SetFileName(path)
    writer.SetInputData(image)
    writer.Write()
    return path


def fetch(proxy, port=0):
    """Return an output of a filter on the client."""
    proxy.UpdatePipeline()
    return servermanager.Fetch(proxy, idx=port)


def field(surface, name):
    """Return the first value of an array of field data."""
    return surface.GetFieldData().GetAbstractArray(name).GetValue(0)


def points(surface):
    return vtk_to_numpy(surface.GetPoints().GetData())


def delete_sources():
    """Delete all sources, downstream ones first."""
    for source in reversed(list(simple.GetSources().values())):
        simple.Delete(source)


def levels(pyramid):
    return [pyramid.GetBlock(h) for h in range(pyramid.GetNumberOfBlocks())]


def names(blocks):
    """Return the names of the blocks of a fetched dataset, without the prefix of ParaView 6.1."""
    given = [blocks.GetMetaData(b).Get(blocks.NAME()) for b in range(blocks.GetNumberOfBlocks())]
    return [name.removeprefix("Block 0_") for name in given]


def voxels(image, name):
    """Return the values of a point array as [z, y, x]."""
    return vtk_to_numpy(image.GetPointData().GetArray(name)).reshape(image.GetDimensions()[::-1])


class CapturedMessages:
    """Context in which errors and warnings of VTK go to `text` instead of the console."""

    def __enter__(self):
        self._previous = vtkOutputWindow.GetInstance()
        self._window = vtkStringOutputWindow()
        vtkOutputWindow.SetInstance(self._window)
        return self

    def __exit__(self, *unused):
        vtkOutputWindow.SetInstance(self._previous)

    @property
    def text(self):
        return self._window.GetOutput()


class PluginTestCase(unittest.TestCase):
    """Loads the plugin. Deletes views and sources after each test."""

    @classmethod
    def setUpClass(cls):
        load_plugin()

    def tearDown(self):
        for view in simple.GetViews():
            simple.Delete(view)
        delete_sources()


def main(*names):
    """Run the tests of these modules (default: of the script). Exit with 1 if one fails."""
    result = unittest.main(module=None if names else "__main__", argv=["test", *names], exit=False,
                           verbosity=2).result
    # No sys.exit(0) on success: mpirun would report a crash of pvbatch.
    if not result.wasSuccessful() or result.testsRun == 0:
        sys.exit(1)
