# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Image Pyramid, Deformable Surface and Volume to Surface of the installed plugin, in scripts of
pvbatch and pvpython."""

import numpy
from paraview import simple

import plugin_testing as testing
from plugin_testing import points

SURFACE, LEVELS, HISTORY, SNAPSHOTS = range(4)
SIZE, RADIUS, DARK, BRIGHT = 32, 10.0, 20.0, 220.0
CENTRE = numpy.full(3, (SIZE - 1) / 2)


def ball_values():
    """Return values[z, y, x]: a bright ball at the centre with a blurred boundary."""
    inside = numpy.clip(0.5 + 0.5 * (RADIUS - testing.distances(SIZE)), 0, 1)
    return (DARK + (BRIGHT - DARK) * inside).astype(numpy.float32)


def ball_of_cells():
    """Return the same ball as cell data, with cell centres at the positions of the points."""
    image = testing.make_image(numpy.zeros((SIZE + 1,) * 3, numpy.float32), origin=(-0.5,) * 3)
    points = testing.make_image(ball_values(), name="density")
    image.GetPointData().Initialize()
    image.GetCellData().AddArray(points.GetPointData().GetArray("density"))
    return image


class ImagePyramidTest(testing.PluginTestCase):
    def test_levels_and_factor(self):
        source = simple.Wavelet()
        source.UpdatePipeline()
        # 21 voxels, floor(21 / sqrt 3) = 12; the next level would have 6, fewer than 10.
        for properties, factor, sizes in (({}, 3**0.5, [21, 12]), (
                {"NumberOfLevels": 4, "ReductionFactor": 1.5}, 1.5, [21, 14, 9, 6])):
            pyramid = testing.fetch(simple.ImagePyramid(Input=source, **properties))
            self.assertEqual(testing.names(pyramid), [f"Level {h}" for h in range(len(sizes))])
            for h, (image, size) in enumerate(zip(testing.levels(pyramid), sizes)):
                self.assertEqual(image.GetDimensions(), (size,) * 3)
                self.assertEqual(testing.field(image, "Level"), h)
                self.assertAlmostEqual(testing.field(image, "Unit"), factor**h, places=12)
                self.assertIsNotNone(image.GetPointData().GetArray("RTData"))


class SurfaceTest(testing.PluginTestCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.ball = cls.kept = testing.produce(testing.make_image(ball_values(), name="density"))

    def check_ball(self, surface, tolerance=0.5):
        self.assertEqual(testing.field(surface, "StopReason"), "converged")
        self.assertEqual(testing.field(surface, "NumberOfComponents"), 1)
        distance = numpy.linalg.norm(points(surface) - CENTRE, axis=1)
        self.assertLess(numpy.abs(distance - RADIUS).max(), tolerance)

    def test_default_iso_value(self):
        filter_ = simple.VolumetoSurface(self.ball)
        self.assertGreater(filter_.IsoValue, DARK + 30)
        self.assertLess(filter_.IsoValue, BRIGHT - 30)
        low, high = self.ball.PointData["density"].GetRange()
        self.assertNotAlmostEqual(filter_.IsoValue, (low + high) / 2, places=3)
        self.check_ball(testing.fetch(filter_))

    def test_upper_value(self):
        """A ball within a ball: with the upper value only the outer layer. Default: unused."""
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
        distance = numpy.linalg.norm(points(surface) - CENTRE, axis=1)
        numpy.testing.assert_allclose((distance.min(), distance.max()), (5, RADIUS), atol=0.7)

    def test_voxels_in_cells(self):
        of_cells = simple.VolumetoSurface(testing.produce(ball_of_cells()))
        self.assertEqual(list(of_cells.Voxels), ["CELLS", "density"])
        of_points = simple.VolumetoSurface(self.ball)
        self.assertEqual(of_cells.IsoValue, of_points.IsoValue)
        self.assertEqual(points(testing.fetch(of_cells)).tobytes(),
                         points(testing.fetch(of_points)).tobytes())

    def test_displays(self):
        filter_ = simple.VolumetoSurface(self.ball)
        view = simple.CreateView("RenderView")
        for port in (SURFACE, LEVELS, SNAPSHOTS):
            display = simple.Show(simple.OutputPort(filter_, port), view)
            self.assertEqual(display.Representation, "Surface")
            self.assertTrue(display.UseSeparateColorMap)
            self.assertFalse(display.ColorArrayName[1])
        # ParaView's own chart draws the table.
        curves = simple.Show(simple.PlotData(simple.OutputPort(filter_, HISTORY)),
                             simple.CreateView("XYChartView"))
        self.assertIn("Vertices", curves.SeriesVisibility)

    def test_abort_and_next_apply(self):
        """By the button of newer versions of ParaView."""
        filter_ = simple.VolumetoSurface(self.ball)
        algorithm = filter_.GetClientSideObject()
        executions = []
        algorithm.AddObserver("StartEvent", lambda *_: executions.append(1))
        tag = testing.stop_after_the_tenth(algorithm)
        surface = testing.fetch(filter_)
        self.assertEqual(testing.field(surface, "StopReason"), "cancelled")
        self.assertGreater(surface.GetNumberOfPolys(), 0)
        # A sweep of five iterations reports at least once.
        self.assertTrue(0 < testing.fetch(filter_, HISTORY).GetNumberOfRows() <= 50)
        # ParaView keeps the output, also for downstream filters, and does not restart the filter.
        self.assertEqual(testing.fetch(simple.Elevation(filter_)).GetNumberOfPoints(),
                         surface.GetNumberOfPoints())
        self.assertEqual(len(executions), 1)
        algorithm.RemoveObserver(tag)
        # A change and Apply restart the filter.
        filter_.Friction = 2.9
        self.check_ball(testing.fetch(filter_))
        self.assertEqual(len(executions), 2)

    def test_initial_surface(self):
        sphere = simple.Sphere(Center=CENTRE, Radius=14.0, ThetaResolution=16, PhiResolution=16)
        self.check_ball(testing.fetch(simple.DeformableSurface(
            self.ball, IsoValue=120.0, InitialSurface=sphere, Initialization="Input Surface")))

    def test_attracting_points(self):
        position = CENTRE + (RADIUS + 3.0, 0.0, 0.0)
        known = simple.PointSource(Center=position, NumberOfPoints=1, Radius=0.0)
        for weight, passed in ((1.0, True), (0.0, False)):
            surface = testing.fetch(simple.DeformableSurface(
                self.ball, IsoValue=120.0, AttractingPoints=known, PointAttractionWeight=weight))
            self.assertEqual(surface.GetBounds()[1] > position[0], passed)

    def test_edge_map(self):
        distance = testing.distances(SIZE)
        image = testing.make_image((RADIUS - distance).astype(numpy.float32))
        testing.add_array(image, numpy.exp(-(distance - 9.0)**2).astype(numpy.float32), "edges")
        source = testing.produce(image)
        # Without edges the surface moves to the radius 5.
        for weight, radius in ((0.0, 5.0), (2.0, 9.0)):
            filter_ = simple.DeformableSurface(source, IsoValue=RADIUS - 5.0,
                                               EdgeAttractionWeight=weight)
            filter_.Voxels, filter_.EdgeMap = ["POINTS", "v"], ["POINTS", "edges"]
            away = numpy.linalg.norm(points(testing.fetch(filter_)) - CENTRE, axis=1)
            self.assertAlmostEqual(away.mean(), radius, delta=0.3)
