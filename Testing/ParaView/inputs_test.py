# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Valid and invalid inputs of the filters, in scripts of pvbatch and pvpython: sources that were never
updated, types that are not images, components, NaN."""

import numpy
from paraview import simple
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonDataModel import (vtkDataObject, vtkMultiBlockDataSet, vtkPartitionedDataSet,
                                           vtkPartitionedDataSetCollection, vtkRectilinearGrid)

import plugin_testing as testing

SIZE, RADIUS = 32, 10.0
FILTERS = ("ImagePyramid", "DeformableSurface", "VolumetoSurface")
SURFACES = FILTERS[1:]


def ball(low=20.0, high=220.0):
    """Return values[z, y, x]: a bright ball at the centre."""
    inside = numpy.clip(0.5 + 0.5 * (RADIUS - testing.distances(SIZE)), 0, 1)
    return (low + (high - low) * inside).astype(numpy.float32)


def image(**arrays):
    data = testing.make_image(numpy.zeros((SIZE,) * 3, numpy.float32))
    data.GetPointData().Initialize()
    for name, values in arrays.items():
        array = numpy_to_vtk(values.reshape(SIZE**3, -1), deep=True)
        array.SetName(name)
        data.GetPointData().AddArray(array)
        data.GetPointData().SetActiveScalars(name)
    return data


def coloured():
    """Return an image with three components; the ball is in the second one."""
    values = ball()
    data = image(colour=numpy.stack([values * 0 + 7, values, values * 0 - 9], axis=-1))
    array = data.GetPointData().GetArray("colour")
    for i, name in enumerate(("Red", "Green", "Blue")):
        array.SetComponentName(i, name)
    return data


def is_offered(name, source):
    """Return whether the entry of the menu is enabled for the source."""
    filter_ = getattr(simple, name)(source)
    try:
        return bool(filter_.SMProxy.GetProperty("Input").IsInDomains())
    finally:
        simple.Delete(filter_)


class InputsTest(testing.PluginTestCase):
    def check_ball(self, filter_):
        surface = testing.fetch(filter_)
        self.assertGreater(surface.GetNumberOfPoints(), 500)
        for axis in range(3):
            low, high = surface.GetBounds()[2 * axis:2 * axis + 2]
            self.assertAlmostEqual(high - low, 2 * RADIUS, delta=1.5)

    def test_source_without_update(self):
        expected = None
        for name in SURFACES:
            for source in (simple.Wavelet(), simple.ImagePyramid(simple.Wavelet())):
                with self.subTest(filter=name, source=source.GetXMLName()):
                    filter_ = getattr(simple, name)(source)
                    expected = expected or filter_.IsoValue
                    self.assertEqual(filter_.IsoValue, expected)
                    self.assertEqual(list(filter_.Voxels), ["POINTS", "RTData"])
                    self.assertGreater(testing.fetch(filter_).GetNumberOfPoints(), 500)
        self.assertTrue(100.0 < expected < 200.0, expected)

    def test_preset_of_iso_value(self):
        first = testing.produce(image(density=ball()))
        second = testing.produce(image(other=ball(1000, 2000), density=ball(0, 10)))
        for name in SURFACES:
            with self.subTest(filter=name):
                filter_ = getattr(simple, name)(first)
                self.assertTrue(20 < filter_.IsoValue < 220)
                self.assertEqual((filter_.UseUpperValue, filter_.UpperValue), (0, 220))
                filter_.Input = second
                self.assertTrue(0 < filter_.IsoValue < 10, filter_.IsoValue)
                self.check_ball(filter_)
                filter_.Voxels = ["POINTS", "other"]
                self.assertTrue(1000 < filter_.IsoValue < 2000, filter_.IsoValue)
                self.check_ball(filter_)
                filter_.IsoValue = 5.0
                filter_.Voxels = ["POINTS", "density"]
                self.assertEqual(filter_.IsoValue, 5.0)
                filter_.Input = first
                self.assertEqual(filter_.IsoValue, 5.0)

    def test_accepted_inputs(self):
        volume = image(density=ball())
        nested, partitions = vtkMultiBlockDataSet(), vtkPartitionedDataSet()
        nested.SetBlock(0, volume)
        partitions.SetPartition(0, volume)
        collection = vtkPartitionedDataSetCollection()
        collection.SetPartitionedDataSet(0, partitions)
        rectilinear = vtkRectilinearGrid()
        rectilinear.SetDimensions(4, 4, 4)
        for name in FILTERS:
            for data, expected in ((volume, True), (nested, True), (partitions, True),
                                   (collection, True), (image(), False), (coloured(), True),
                                   (rectilinear, False)):
                with self.subTest(filter=name, data=data.GetClassName()):
                    self.assertEqual(is_offered(name, testing.produce(data)), expected)

    def test_voxels_in_cells(self):
        of_points = simple.VolumetoSurface(testing.produce(image(density=ball())))
        cells = testing.make_image(numpy.zeros((SIZE + 1,) * 3, numpy.float32), origin=(-0.5,) * 3)
        cells.GetPointData().Initialize()
        cells.GetCellData().AddArray(image(density=ball()).GetPointData().GetArray("density"))
        of_cells = simple.VolumetoSurface(testing.produce(cells))
        self.assertEqual(list(of_cells.Voxels), ["CELLS", "density"])
        self.assertEqual(of_cells.IsoValue, of_points.IsoValue)
        self.check_ball(of_cells)

    def test_other_inputs_reach_the_filter(self):
        source = testing.produce(image(density=ball(), edges=ball()))
        for name in SURFACES:
            with self.subTest(filter=name):
                filter_ = getattr(simple, name)(source, InitialSurface=simple.Sphere(),
                                                AttractingPoints=simple.PointSource())
                filter_.EdgeMap = ["POINTS", "edges"]
                filter_.UpdateVTKObjects()
                inner = filter_.GetClientSideObject()
                self.assertEqual([inner.GetNumberOfInputConnections(i) for i in (1, 2)], [1, 1])
                array = inner.GetInputArrayInformation(1).Get(vtkDataObject.FIELD_NAME())
                self.assertEqual(array, "edges")

    def test_components(self):
        for name in SURFACES:
            with self.subTest(filter=name):
                filter_ = getattr(simple, name)(testing.produce(coloured()))
                self.assertEqual(filter_.SelectedComponent, "Magnitude")
                self.assertEqual(filter_.GetProperty("SelectedComponent").Available,
                                 ["Red", "Green", "Blue", "Magnitude"])
                self.check_ball(filter_)
                magnitude = filter_.IsoValue
                filter_.SelectedComponent = "Green"
                of_green = simple.VolumetoSurface(testing.produce(image(green=ball())))
                self.assertEqual(filter_.IsoValue, of_green.IsoValue)
                self.assertNotEqual(filter_.IsoValue, magnitude)
                self.check_ball(filter_)
                # The range of the slider in the panel.
                domain = filter_.SMProxy.GetProperty("IsoValue").GetDomain("range")
                self.assertEqual((domain.GetMinimum(0), domain.GetMaximum(0)), (20.0, 220.0))
                filter_.SelectedComponent = "Magnitude"
                self.assertEqual(filter_.IsoValue, magnitude)
                self.assertGreater(domain.GetMaximum(0), 220.0)

    def test_nan_voxels(self):
        values = ball()
        x = numpy.arange(SIZE) - (SIZE - 1) / 2
        values[:, numpy.hypot(x[None, :], x[:, None]) > 14.0] = numpy.nan
        for name in SURFACES:
            with self.subTest(filter=name):
                with testing.CapturedMessages() as messages:
                    filter_ = getattr(simple, name)(testing.produce(image(density=values)))
                self.assertEqual(messages.text, "")
                self.assertTrue(20 < filter_.IsoValue < 220, filter_.IsoValue)
                domain = filter_.SMProxy.GetProperty("IsoValue").GetDomain("range")
                self.assertEqual((domain.GetMinimum(0), domain.GetMaximum(0)), (20.0, 220.0))
