# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The Deformable Surface filter of the installed plugin, in scripts of pvbatch and pvpython."""

import numpy
from paraview import simple
from paraview.vtk.util.numpy_support import vtk_to_numpy

import plugin_testing as testing
from plugin_testing import points, triangles

SURFACE, LEVELS, HISTORY = range(3)

# The ball of the tests: its image falls by 1 from voxel to voxel, away from the centre.
CENTRE, RADIUS = (6.0, -2.0, 10.0), 11.0


def distances(place=(0.0, 0.0, 0.0)):
    return testing.distances(37, place)


def image_of(values):
    """An image whose middle voxel is at CENTRE."""
    return testing.make_image(values.astype(numpy.float32), origin=CENTRE, start=(-18,) * 3)


def ball_image():
    """0 on the sphere about CENTRE and more inside."""
    return image_of(RADIUS - distances())


def surface_of(source, **properties):
    """The filter on a source, not applied yet."""
    source.UpdatePipeline()
    # Not Input=source: ParaView would look for the array in the active source first.
    return simple.DeformableSurface(source, **properties)


class DeformableSurfaceTest(testing.PluginTestCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.ball = cls.kept = testing.produce(ball_image())

    def check_valid(self, surface):
        """Closed, oriented, triangles only: each edge is passed once in each direction."""
        self.assertEqual(surface.GetClassName(), "vtkPolyData")
        self.assertGreater(surface.GetNumberOfPolys(), 0)
        corners = triangles(surface)
        self.assertEqual(len(corners), surface.GetNumberOfCells())
        ways = {(int(a), int(b)) for t in corners for a, b in zip(t, numpy.roll(t, -1))}
        self.assertEqual(len(ways), 3 * len(corners))
        self.assertEqual(ways, {(b, a) for a, b in ways})
        characteristic = surface.GetNumberOfPoints() - len(ways) // 2 + len(corners)
        self.assertEqual(testing.field(surface, "EulerCharacteristic"), characteristic)

    def check_ball(self, surface, tolerance):
        self.check_valid(surface)
        self.assertEqual(testing.field(surface, "StopReason"), "converged")
        self.assertEqual(testing.field(surface, "NumberOfComponents"), 1)
        self.assertEqual(testing.field(surface, "Genus"), 0)
        distance = numpy.linalg.norm(points(surface) - CENTRE, axis=1)
        self.assertLess(numpy.abs(distance - RADIUS).max(), tolerance)

    def test_levels_and_history(self):
        filter_ = surface_of(simple.Wavelet())
        surface, blocks, table = (testing.fetch(filter_, port)
                                  for port in (SURFACE, LEVELS, HISTORY))
        self.assertEqual(blocks.GetClassName(), "vtkMultiBlockDataSet")
        self.assertEqual(testing.names(blocks), ["Level 0", "Level 1"])
        self.assertEqual(blocks.GetNumberOfBlocks(), 2)
        for h, level in enumerate(testing.levels(blocks)):
            self.check_valid(level)
            self.assertEqual(testing.field(level, "Level"), h)
        numpy.testing.assert_array_equal(points(blocks.GetBlock(0)), points(surface))

        self.assertEqual(table.GetClassName(), "vtkTable")
        column = {name: vtk_to_numpy(table.GetColumnByName(name))
                  for name in ("Iteration", "Level", "Vertices")}
        rows = sum(testing.field(level, "Iterations") for level in testing.levels(blocks))
        numpy.testing.assert_array_equal(column["Iteration"], 1 + numpy.arange(rows))
        self.assertTrue((numpy.diff(column["Level"]) <= 0).all(), "from coarse to fine")
        self.assertEqual(column["Vertices"][-1], surface.GetNumberOfPoints())

    def test_initial_surface(self):
        sphere = simple.Sphere(Center=CENTRE, Radius=15.0, ThetaResolution=16, PhiResolution=16)
        surface = testing.fetch(surface_of(self.ball, IsoValue=0.0, InitialSurface=sphere,
                                    Initialization="Input Surface"))
        self.check_ball(surface, 0.2)

    def test_initial_surface_that_is_open(self):
        plane = simple.Plane(XResolution=4, YResolution=4)
        self.check_error(["port 1"], self.ball, IsoValue=0.0, InitialSurface=plane,
                         Initialization="Input Surface")

    def test_attracting_points(self):
        place = (CENTRE[0] + RADIUS + 3.0, CENTRE[1], CENTRE[2])
        known = simple.PointSource(Center=place, NumberOfPoints=1, Radius=0.0)
        for weight, passed in ((1.0, True), (0.0, False)):
            surface = testing.fetch(surface_of(self.ball, IsoValue=0.0, AttractingPoints=known,
                                        PointAttractionWeight=weight))
            self.check_valid(surface)
            self.assertEqual(surface.GetBounds()[1] > place[0], passed)

    def test_edge_map(self):
        image = ball_image()
        testing.add_array(image, numpy.exp(-(distances() - 9.0)**2).astype(numpy.float32), "edges")
        source = testing.produce(image)
        # Alone, the value would lead the surface over the edges to the radius 5.
        for weight, radius in ((0.0, 5.0), (2.0, 9.0)):
            filter_ = surface_of(source, IsoValue=RADIUS - 5.0, EdgeAttractionWeight=weight)
            filter_.Voxels, filter_.EdgeMap = ["POINTS", "v"], ["POINTS", "edges"]
            surface = testing.fetch(filter_)
            self.check_valid(surface)
            away = numpy.linalg.norm(points(surface) - CENTRE, axis=1)
            self.assertAlmostEqual(away.mean(), radius, delta=0.3)

    def check_error(self, expected, source, **properties):
        """The message that a bad input gives, and that there is no output afterwards."""
        filter_ = surface_of(source, **properties)
        with testing.CapturedMessages() as messages:
            surface = testing.fetch(filter_)
        self.assertIn("vtkDeformableSurface", messages.text)
        for word in expected:
            self.assertIn(word, messages.text)
        self.assertEqual(surface.GetNumberOfPoints(), 0)
        return filter_

    def test_error_for_an_iso_value_out_of_range_and_the_way_out(self):
        filter_ = self.check_error(["Iso Value", "1000", "range"], self.ball, IsoValue=1000.0)
        filter_.IsoValue = 0.0
        self.check_ball(testing.fetch(filter_), 0.2)

    def test_abort_leaves_what_there_is(self):
        filter_ = surface_of(self.ball, IsoValue=0.0)
        algorithm = filter_.GetClientSideObject()
        executions = []
        algorithm.AddObserver("StartEvent", lambda *_: executions.append(1))
        tag = testing.stop_after_the_tenth(algorithm)
        surface = testing.fetch(filter_)
        self.check_valid(surface)
        self.assertEqual(testing.field(surface, "StopReason"), "cancelled")
        self.assertGreater(testing.fetch(filter_, HISTORY).GetNumberOfRows(), 0)
        # A sweep of five iterations reports once at least.
        self.assertLessEqual(testing.fetch(filter_, HISTORY).GetNumberOfRows(), 50)
        # ParaView keeps it, also for the filters after it, and does not start again by itself.
        self.assertEqual(testing.fetch(simple.Elevation(filter_)).GetNumberOfPoints(),
                         surface.GetNumberOfPoints())
        self.assertEqual(len(executions), 1)
        # The request is forgotten: any reason to execute will do.
        algorithm.RemoveObserver(tag)
        self.assertEqual(algorithm.GetAbortExecute(), 0)
        algorithm.Modified()
        self.check_ball(testing.fetch(filter_), 0.2)
        self.assertEqual(len(executions), 2)
