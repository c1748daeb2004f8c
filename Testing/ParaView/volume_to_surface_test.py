# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The Volume to Surface filter of the installed plugin, in scripts of pvbatch and pvpython."""

import numpy
from paraview import simple

import plugin_testing as testing
from plugin_testing import points

SURFACE, LEVELS, HISTORY, SNAPSHOTS = range(4)
FOUR_CURVES = {"Seconds", "KineticEnergy", "MeanEdgeLength", "Vertices"}
SIZE, RADIUS, DARK, BRIGHT = 32, 10.0, 20.0, 220.0


def ball_values():
    """values[z, y, x]: bright in a ball about the middle, over about two voxels dark around it."""
    inside = numpy.clip(0.5 + 0.5 * (RADIUS - testing.distances(SIZE)), 0, 1)
    return (DARK + (BRIGHT - DARK) * inside).astype(numpy.float32)


def ball_of_cells():
    """The same ball in cells, whose centres are where the points are."""
    image = testing.make_image(numpy.zeros((SIZE + 1,) * 3, numpy.float32), origin=(-0.5,) * 3)
    points = testing.make_image(ball_values(), name="density")
    image.GetPointData().Initialize()
    image.GetCellData().AddArray(points.GetPointData().GetArray("density"))
    return image


class VolumeToSurfaceTest(testing.PluginTestCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.ball = cls.kept = testing.produce(testing.make_image(ball_values(), name="density"))

    def check_ball(self, surface, tolerance=0.5):
        self.assertEqual(testing.field(surface, "StopReason"), "converged")
        self.assertEqual(testing.field(surface, "NumberOfComponents"), 1)
        distance = numpy.linalg.norm(points(surface) - (SIZE - 1) / 2, axis=1)
        self.assertLess(numpy.abs(distance - RADIUS).max(), tolerance)

    def test_iso_value_is_preset_and_apply_is_enough(self):
        filter_ = simple.VolumetoSurface(self.ball)
        self.assertGreater(filter_.IsoValue, DARK + 30)
        self.assertLess(filter_.IsoValue, BRIGHT - 30)
        low, high = self.ball.PointData["density"].GetRange()
        self.assertNotAlmostEqual(filter_.IsoValue, (low + high) / 2, places=3)
        self.check_ball(testing.fetch(filter_))

    def test_a_range_of_values(self):
        """Of a ball within a ball the outer one's layer; none is wanted by default."""
        inner = numpy.clip(0.5 + 0.5 * (5 - testing.distances(SIZE)), 0, 1)
        values = (ball_values() + 400 * inner).astype(numpy.float32)
        filter_ = simple.VolumetoSurface(testing.produce(testing.make_image(values)))
        self.assertEqual((filter_.UseUpperValue, filter_.UpperValue), (0, values.max()))
        filter_.IsoValue = (DARK + BRIGHT) / 2
        self.assertEqual(testing.field(testing.fetch(filter_), "NumberOfComponents"), 1)
        filter_.UpperValue = BRIGHT + 200
        filter_.UseUpperValue = 1
        surface = testing.fetch(filter_)
        self.assertEqual(testing.field(surface, "NumberOfComponents"), 2)
        distance = numpy.linalg.norm(points(surface) - (SIZE - 1) / 2, axis=1)
        numpy.testing.assert_allclose((distance.min(), distance.max()), (5, RADIUS), atol=0.7)

    def test_voxels_in_cells(self):
        of_cells = simple.VolumetoSurface(testing.produce(ball_of_cells()))
        self.assertEqual(list(of_cells.Voxels), ["CELLS", "density"])
        of_points = simple.VolumetoSurface(self.ball)
        self.assertEqual(of_cells.IsoValue, of_points.IsoValue)
        self.assertEqual(points(testing.fetch(of_cells)).tobytes(),
                         points(testing.fetch(of_points)).tobytes())

    def test_volume_without_a_boundary(self):
        flat = testing.produce(testing.make_image(numpy.full((16,) * 3, 4.0, numpy.float32)))
        with testing.CapturedMessages() as messages:
            filter_ = simple.VolumetoSurface(flat)
            self.assertEqual(filter_.IsoValue, 4.0)
            surface = testing.fetch(filter_)
        self.assertIn("ranges from 4 to 4", messages.text)
        self.assertIn("all voxels are 4: no value parts an object", messages.text)
        self.assertEqual(surface.GetNumberOfPoints(), 0)

    def test_displays_where_people_write_a_comma(self):
        """The numbers of the plugin's XML have points in every country."""
        with testing.comma_locale() as found:
            if not found:
                self.skipTest("there is no locale with a comma, and localedef makes none")
            view = simple.CreateView("RenderView")
            display = simple.Show(simple.VolumetoSurface(self.ball), view)
            numpy.testing.assert_allclose(display.DiffuseColor, (0.89, 0.85, 0.76))
            self.assertAlmostEqual(display.Specular, 0.15)

    def test_displays(self):
        filter_ = simple.VolumetoSurface(self.ball)
        view = simple.CreateView("RenderView")
        for port in (SURFACE, LEVELS, SNAPSHOTS):
            display = simple.Show(simple.OutputPort(filter_, port), view)
            self.assertEqual(display.Representation, "Surface")
            red, _, blue = display.DiffuseColor
            self.assertGreater(red, blue, "bone")
            self.assertFalse(display.ColorArrayName[1])
        chart = simple.CreateView("VolumicHistoryView")
        display = simple.Show(simple.OutputPort(filter_, HISTORY), chart)
        self.assertEqual(set(display.SeriesVisibility), FOUR_CURVES)
        self.assertEqual(display.XArrayName, "Iteration")
        self.assertFalse(display.UseIndexForXAxis)
        self.assertTrue(chart.LeftAxisLogScale)
        # Where no curve of a run from coarse to fine is.
        self.assertEqual(chart.LegendLocation, "BottomRight")

    def check_abort_and_the_next_apply(self, abort):
        filter_ = simple.VolumetoSurface(self.ball)
        algorithm = filter_.GetClientSideObject()
        tag = testing.stop_after_the_tenth(algorithm, abort)
        surface = testing.fetch(filter_)
        self.assertEqual(testing.field(surface, "StopReason"), "cancelled")
        self.assertGreater(surface.GetNumberOfPolys(), 0)
        algorithm.RemoveObserver(tag)
        # Nobody takes the request back; any change and Apply will do.
        filter_.Friction = 2.9
        self.check_ball(testing.fetch(filter_))

    def test_abort_by_the_button_of_newer_paraviews(self):
        self.check_abort_and_the_next_apply(
            lambda algorithm: algorithm.SetAbortExecuteAndUpdateTime())
