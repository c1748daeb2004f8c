# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Label maps for the tests of Labels to Surfaces: three balls, two of which touch."""

import numpy
import plugin_testing as testing
from vtkmodules.vtkCommonCore import vtkDoubleArray, vtkIntArray, vtkStringArray

SIZE = 32
# Label: centre (x, y, z), radius, in voxels.
BALLS = {3: ((9.0, 10.0, 11.0), 6.3), 7: ((20.0, 10.0, 11.0), 5.4), 12: ((16.0, 22.0, 20.0), 7.2)}
NAMES = {3: "liver", 7: "left kidney", 12: "spleen"}
COLORS = {3: (0.8, 0.2, 0.2), 7: (0.2, 0.8, 0.2), 12: (0.2, 0.2, 0.8)}


def values(kind=numpy.int16, balls=None):
    """Return labels[z, y, x]."""
    z, y, x = numpy.mgrid[0:SIZE, 0:SIZE, 0:SIZE]
    labels = numpy.zeros((SIZE,) * 3, kind)
    for label, ((i, j, k), radius) in (balls or BALLS).items():
        labels[(x - i)**2 + (y - j)**2 + (z - k)**2 <= radius**2] = label
    return labels


def image(kind=numpy.int16, balls=None, **geometry):
    return testing.make_image(values(kind, balls), name="labels", **geometry)


def cells():
    """Return the same as cell data, with cell centres at the positions of the points."""
    data = testing.make_image(numpy.zeros((SIZE + 1,) * 3, numpy.uint8), origin=(-0.5,) * 3)
    data.GetPointData().Initialize()
    data.GetCellData().AddArray(image().GetPointData().GetArray("labels"))
    return data


def add_names(data, names=None, colors=None):
    """Add field data with names and colours, as `volumic --write-volume` does."""
    names, colors = names or NAMES, colors or COLORS
    arrays = (vtkIntArray(), "LabelValues"), (vtkStringArray(), "LabelNames"), \
        (vtkDoubleArray(), "LabelColors")
    for array, name in arrays:
        array.SetName(name)
        data.GetFieldData().AddArray(array)
    arrays[2][0].SetNumberOfComponents(3)
    for label, name in names.items():
        arrays[0][0].InsertNextValue(label)
        arrays[1][0].InsertNextValue(name)
        arrays[2][0].InsertNextTuple(colors[label])
    return data
