# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Outputs in views: colours and visible blocks."""

import numpy
from paraview import simple

import plugin_testing as testing
import view_testing as views

SURFACE, LEVELS, HISTORY, SNAPSHOTS = range(4)


def ball(size, radius, centre=0.0):
    distance = testing.distances(size, (centre - 0.3, -0.3, -0.3))
    return numpy.clip(50 + 100 * (radius - distance), 0, 100).astype(numpy.float32)


def two_balls():
    """Return balls of radius 8 and 4."""
    return testing.produce(testing.make_image(
        numpy.maximum(ball(48, 8, 10), ball(48, 4, -12)), name="density"))


class ColoursTest(testing.PluginTestCase):
    def setUp(self):
        self.filter = simple.VolumetoSurface(two_balls(), IsoValue=50.0)
        self.view = views.new_view("RenderView")
        self.display = simple.Show(self.filter, self.view)
        simple.ResetCamera(self.view)

    def coloured_by(self, name, association):
        """Return the colour map, as the list in the window sets it."""
        numbers = {"POINTS": 0, "CELLS": 1}
        self.display.SetScalarColoring(name, numbers[association])
        self.display.RescaleTransferFunctionToDataRange(False, False)
        simple.Render(self.view)
        return self.display.LookupTable

    def test_outputs_are_plain_surfaces_and_a_chart(self):
        for port in (SURFACE, LEVELS, SNAPSHOTS):
            display = simple.Show(simple.OutputPort(self.filter, port), self.view)
            self.assertEqual(display.Representation, "Surface")
            self.assertTrue(display.UseSeparateColorMap)
            self.assertFalse(display.ColorArrayName[1])
        # ParaView's own chart draws the table.
        curves = simple.Show(simple.PlotData(simple.OutputPort(self.filter, HISTORY)),
                             simple.CreateView("XYChartView"))
        self.assertIn("Vertices", curves.SeriesVisibility)

    def test_components_have_a_colour_each(self):
        colours = self.coloured_by("Component", "CELLS")
        self.assertTrue(colours.InterpretValuesAsCategories)
        self.assertEqual(list(colours.Annotations), ["0", "0", "1", "1"])
        pixels = views.picture_of(self.view, "colours-component.png")
        self.filter.KeepComponents = "Largest"
        simple.Render(self.view)
        self.assertEqual(list(colours.Annotations), ["0", "0"])
        self.assertGreater(views.drawn(pixels), 1000)

    def test_more_components_than_colours(self):
        many = numpy.tile(testing.distances(12), (4, 4, 4))
        source = testing.produce(testing.make_image((4 - many).astype(numpy.float32)))
        self.filter.Input = source
        self.filter.Voxels = ["POINTS", "v"]
        self.filter.IsoValue = 0.0
        self.filter.CoarsestLevel = 0
        colours = self.coloured_by("Component", "CELLS")
        self.assertEqual(self.filter.FieldData["NumberOfComponents"].GetRange()[0], 64)
        self.assertEqual(list(colours.Annotations)[0::2], [str(n) for n in range(11)])
        self.assertEqual(list(colours.Annotations)[1::2], [str(n) for n in range(10)] + ["others"])
        self.assertEqual(list(colours.IndexedColors)[-3:], list(colours.NanColor))
        views.picture_of(self.view, "colours-many-components.png")


class BlocksTest(testing.PluginTestCase):
    def shown(self, display):
        return list(display.BlockSelectors)

    def test_levels_show_the_finest(self):
        filter_ = simple.VolumetoSurface(two_balls(), IsoValue=50.0)
        view = views.new_view("RenderView")
        display = simple.Show(simple.OutputPort(filter_, LEVELS), view)
        simple.Render(view)
        self.assertEqual(self.shown(display), ["/Root/*[@label='Level 0']"])
        simple.ResetCamera(view)
        # Same picture as of the surface.
        level = views.picture_of(view, "levels-finest.png")
        simple.Hide(simple.OutputPort(filter_, LEVELS), view)
        simple.Show(filter_, view)
        numpy.testing.assert_allclose(views.picture_of(view, "levels-surface.png"), level, atol=2)
        simple.Hide(filter_, view)
        simple.Show(simple.OutputPort(filter_, LEVELS), view)
        # Another level becomes the finest.
        filter_.FinestLevel = 1
        self.assertGreater(views.drawn(views.picture_of(view, "levels-level-1.png")), 1000)
        self.assertEqual(self.shown(display), ["/Root/*[@label='Level 1']"])
        filter_.FinestLevel = 0
        simple.Render(view)
        self.assertEqual(self.shown(display), ["/Root/*[@label='Level 0']"])
        # A selection by the user remains.
        display.BlockSelectors = ["/"]
        filter_.FinestLevel = 1
        simple.Render(view)
        self.assertEqual(self.shown(display), ["/"])

    def test_snapshots(self):
        filter_ = simple.VolumetoSurface(two_balls(), IsoValue=50.0)
        view = views.new_view("RenderView")
        with testing.CapturedMessages() as messages:
            display = simple.Show(simple.OutputPort(filter_, SNAPSHOTS), view)
            simple.ResetCamera(view)
            self.assertEqual(views.drawn(views.picture_of(view, "snapshots-none.png")), 0)
        self.assertEqual(messages.text, "")
        filter_.SnapshotInterval = 10
        simple.Render(view)
        simple.ResetCamera(view)
        self.assertEqual(len(self.shown(display)), 1)
        self.assertRegex(self.shown(display)[0], r"Level 0, iteration \d+")
        self.assertGreater(views.drawn(views.picture_of(view, "snapshots-last.png")), 1000)
