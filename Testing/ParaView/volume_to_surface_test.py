# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The Volume to Surface filter of the installed plugin, in scripts of pvbatch and pvpython."""


import numpy
from paraview import simple
from paraview import smtrace

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


def levels_told_by(algorithm):
    """The levels that iterate from now on, and the observer that tells of them."""
    levels = set()

    def progress(caller, _):
        words = (caller.GetProgressText() or "").split()
        if "iteration" in words:
            levels.add(int(words[1].strip(",")))
    return levels, algorithm.AddObserver("ProgressEvent", progress)


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

    def test_iso_value_is_reset_to_the_data(self):
        values = ball_values()
        image = testing.make_image(values, name="density")
        testing.add_array(image, values * 10 - 7, "other")
        filter_ = simple.VolumetoSurface(testing.produce(image))
        self.assertEqual(filter_.Voxels[1], "density")
        preset = filter_.IsoValue
        filter_.IsoValue = 99.0
        filter_.Voxels = ["POINTS", "other"]
        self.assertEqual(filter_.IsoValue, 99.0)
        testing.reset_iso_value(filter_)
        self.assertAlmostEqual(filter_.IsoValue, preset * 10 - 7, delta=0.01)
        self.check_ball(testing.fetch(filter_))

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
        self.assertIn("Iso Value is 4, outside the range", messages.text)
        self.assertEqual(surface.GetNumberOfPoints(), 0)

    def test_preview_goes_on_where_much_is_missing(self):
        # More than a million voxels: a ball, and rods that level 1 shows but cannot hold.
        z, y, x = numpy.mgrid[0:112, 0:112, 0:112].astype(numpy.float32)
        distance = numpy.sqrt((x - 20)**2 + (y - 56)**2 + (z - 56)**2) - 12
        levels = []
        for rods in (0, 5):
            for i in range(rods):
                rod = numpy.sqrt((y - 20 - 18 * i)**2 + (z - 56)**2) - 1.5
                distance = numpy.minimum(distance, numpy.maximum(rod, numpy.abs(x - 60) - 40))
            image = testing.make_image(numpy.clip(50 - 50 * distance, 0, 100), name="density")
            surface = testing.fetch(simple.VolumetoSurface(testing.produce(image), IsoValue=50.0,
                                                           Preview=1))
            levels.append(testing.field(surface, "Level"))
            self.assertLessEqual(testing.field(surface, "MissingBoundary"), 0.05)
        self.assertEqual(levels, [1, 0])

    def test_a_box_of_a_turned_volume(self):
        image = testing.make_image(ball_values(), spacing=(1, 2, 3), origin=(5, 6, 7),
                                   name="density")
        image.SetDirectionMatrix(0, -1, 0, 1, 0, 0, 0, 0, 1)
        source = testing.produce(image)
        whole = testing.fetch(simple.VolumetoSurface(source, IsoValue=120.0))
        box = simple.ExtractSubset(source, VOI=[3, 28, 3, 28, 3, 28])
        numpy.testing.assert_allclose(
            testing.fetch(simple.VolumetoSurface(box, IsoValue=120.0)).GetBounds(),
            whole.GetBounds(), atol=0.3)

    def test_pyramid_inside(self):
        filter_ = simple.VolumetoSurface(self.ball, NumberOfLevels=2, FinestLevel=1)
        self.assertEqual(testing.field(testing.fetch(filter_), "Level"), 1)
        self.assertEqual(testing.fetch(filter_, LEVELS).GetNumberOfBlocks(), 2)

    def test_goes_on_from_the_last_level(self):
        """By ParaView's own way of setting properties and updating."""
        filter_ = simple.VolumetoSurface(self.ball, FinestLevel=2)
        algorithm = filter_.GetClientSideObject()
        self.assertEqual(testing.field(testing.fetch(filter_), "Level"), 2)
        levels, _ = levels_told_by(algorithm)
        filter_.FinestLevel = 0
        finest = testing.fetch(filter_)
        self.assertEqual(testing.field(finest, "Level"), 0)
        self.assertEqual(levels, {0, 1}, "not anew")
        fresh = testing.fetch(simple.VolumetoSurface(self.ball))
        self.assertEqual(points(finest).tobytes(), points(fresh).tobytes())
        levels.clear()
        algorithm.SetProgressText("")
        filter_.FinestLevel = 1
        self.assertEqual(testing.field(testing.fetch(filter_), "Level"), 1)
        self.assertEqual(levels, set(), "at once")
        filter_.IsoValue = filter_.IsoValue * 0.9
        testing.fetch(filter_)
        self.assertEqual(levels, {1, 2}, "anew")

    def test_goes_on_after_a_stop(self):
        """By the command behind Apply: from the last level at which the surface rested."""
        filter_ = simple.VolumetoSurface(self.ball)
        algorithm = filter_.GetClientSideObject()

        def stop(caller, _):
            caller.SetAbortExecute(int("Level 0, iteration" in (caller.GetProgressText() or "")))
        whole = testing.fetch(simple.VolumetoSurface(self.ball))
        for goes_on in (True, False):
            tag = algorithm.AddObserver("ProgressEvent", stop)
            stopped = testing.fetch(filter_)
            self.assertEqual(testing.field(stopped, "StopReason"), "cancelled")
            self.assertEqual(testing.field(stopped, "Level"), 0)
            algorithm.RemoveObserver(tag)
            filter_.SMProxy.InvokeCommand("GoOn")
            if not goes_on:
                filter_.Friction = 2.9
            levels, tag = levels_told_by(algorithm)
            surface = testing.fetch(filter_)
            algorithm.RemoveObserver(tag)
            self.assertEqual(levels, {0} if goes_on else {0, 1, 2})
            self.assertEqual(testing.field(surface, "StopReason"), "converged")
            if goes_on:
                self.assertEqual(points(surface).tobytes(), points(whole).tobytes())
            filter_.Friction = 3.1

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
        # Also with the columns of the profile.
        filter_.Profile = 1
        filter_.UpdatePipeline()
        self.assertEqual(set(display.SeriesVisibility), FOUR_CURVES)

    def test_trace(self):
        source = simple.Wavelet(registrationName="TracedWavelet")
        source.UpdatePipeline()
        config = smtrace.start_trace()
        config.SetFullyTraceSupplementalProxies(False)
        filter_ = simple.VolumetoSurface(registrationName="Traced", Input=source, FinestLevel=1)
        filter_.UpdatePipeline()
        iso, wanted = filter_.IsoValue, points(testing.fetch(filter_)).tobytes()
        text = smtrace.stop_trace()
        self.assertIn("VolumetoSurface(", text)
        self.assertRegex(text, "FinestLevel ?= ?1")
        self.assertIn("IsoValue", text)
        simple.Delete(filter_)
        played = {}
        exec(compile(text, "trace", "exec"), played)
        again = simple.FindSource("Traced")
        self.assertIsNotNone(again, text)
        self.assertAlmostEqual(again.IsoValue, iso, places=9)
        self.assertEqual(points(testing.fetch(again)).tobytes(), wanted)

    def test_state(self):
        source = simple.Wavelet(registrationName="SavedWavelet")
        source.UpdatePipeline()
        filter_ = simple.VolumetoSurface(
            source, registrationName="Saved", IsoValue=140.0, SnapshotInterval=25)
        wanted = points(testing.fetch(filter_)).tobytes()
        # Python states: see states_test.py.
        path = testing.output_path("volume-to-surface.pvsm")
        simple.SaveState(path)
        simple.Delete(simple.FindSource("Saved"))
        simple.Delete(simple.FindSource("SavedWavelet"))
        simple.LoadState(path)
        again = simple.FindSource("Saved")
        self.assertEqual(again.IsoValue, 140.0)
        self.assertEqual(again.SnapshotInterval, 25)
        self.assertEqual(points(testing.fetch(again)).tobytes(), wanted)

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

    def test_abort_and_the_next_apply(self):
        self.check_abort_and_the_next_apply(lambda algorithm: algorithm.SetAbortExecute(1))

    def test_abort_by_the_button_of_newer_paraviews(self):
        self.check_abort_and_the_next_apply(
            lambda algorithm: algorithm.SetAbortExecuteAndUpdateTime())
