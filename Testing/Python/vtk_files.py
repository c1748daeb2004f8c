# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Readers of VTK files for tests."""

from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkCompositeDataSet
from vtkmodules.vtkIOGeometry import vtkOBJReader, vtkSTLReader
from vtkmodules.vtkIOImage import vtkPNGReader
from vtkmodules.vtkIOPLY import vtkPLYReader
from vtkmodules.vtkIOXML import (
    vtkXMLImageDataReader, vtkXMLMultiBlockDataReader, vtkXMLPolyDataReader)

READERS = {"stl": vtkSTLReader, "ply": vtkPLYReader, "obj": vtkOBJReader,
           "vtp": vtkXMLPolyDataReader, "vti": vtkXMLImageDataReader,
           "vtm": vtkXMLMultiBlockDataReader, "png": vtkPNGReader}


def read(path, reader=None):
    """Return the data of a file, read by its suffix or by the given reader."""
    reader = reader or READERS[path.rpartition(".")[2]]()
    reader.SetFileName(path)
    reader.Update()
    return reader.GetOutput()


def read_blocks(path):
    """Return surfaces by block name."""
    blocks = read(path)
    return {blocks.GetMetaData(i).Get(vtkCompositeDataSet.NAME()): blocks.GetBlock(i)
            for i in range(blocks.GetNumberOfBlocks())}


def read_pixels(path):
    """Return the pixels [row, column, colour] of a picture."""
    image = read(path)
    width, height, _ = image.GetDimensions()
    return vtk_to_numpy(image.GetPointData().GetScalars()).reshape(height, width, -1)


def points_of(surface):
    return vtk_to_numpy(surface.GetPoints().GetData())


def triangles_of(surface):
    return vtk_to_numpy(surface.GetPolys().GetConnectivityArray()).reshape(-1, 3)
