# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Seeds and points known to belong to the object in ParaView's window: pick by P and drag in the view;
add, edit and remove in the list of the panel; undo; states."""

import re
import time
import unittest

import numpy

import gui_session as gui
import plugin_testing as testing
import window_testing as window
import x_input
from window_testing import (
    APPLY, PROPERTIES, SHOW_ADVANCED, choose, edit, filter_of_the_menu, opened)

SEEDS = f"{PROPERTIES}/SeedPositions"
ATTRACTING = f"{PROPERTIES}/AttractingPositions"
REPRESENTATION = f"{gui.WINDOW}/representationToolbar/displayRepresentation/comboBox"
# Pixels from the centre of the view, which shows `two_balls` or `five_balls`.
LEFT_BALL, BETWEEN, CENTRE = (-80, 0), (0, 77), (0, 0)
LOWER_LEFT, LOWER_RIGHT, BESIDE = (-98, 60), (122, 60), (12, 157)

# Runs in the window: reports seeds, components and x range of the surface of each run.
REPORT_RUNS = window.WATCH_FILTERS + """
def attend(proxy, algorithm):
    def end(caller, event):
        surface = caller.GetOutputDataObject(0)
        parts = surface.GetFieldData().GetArray("NumberOfComponents").GetValue(0)
        print("Run:", *proxy.SeedPositions, "parts:", parts,
              "surface:", *surface.GetBounds()[:2], ".")
    algorithm.AddObserver("EndEvent", end)
"""


def two_balls():
    """Return the path of a volume: balls of radius 9 about (14, 20, 20) and (46, 20, 20)."""
    z, y, x = numpy.mgrid[0:41, 0:41, 0:61].astype(float)
    distance = numpy.hypot(numpy.abs(x - 30.0) - 16.0, numpy.hypot(y - 20.0, z - 20.1)) - 9.0
    return testing.write_volume(
        "two-balls.vti", testing.make_image(numpy.clip(50.0 - 50.0 * distance, 0.0, 100.0)))


def five_balls():
    """Return the path of a volume: balls of radius 6, three below two."""
    z, y, x = numpy.mgrid[0:41, 0:41, 0:61].astype(float)
    distance = numpy.min([numpy.hypot(numpy.hypot(x - cx, y - cy), z - 20.1) for cx, cy in
                          ((12, 10), (30, 10), (48, 10), (21, 30), (39, 30))], axis=0) - 6.0
    return testing.write_volume(
        "five-balls.vti", testing.make_image(numpy.clip(50.0 - 50.0 * distance, 0.0, 100.0)))


def a_slice_of(volume):
    return opened(volume) + [gui.event(REPRESENTATION, "set_string", "Slice"), gui.pause(500)]


FROM_SEEDS = [filter_of_the_menu("VolumeToSurface"), SHOW_ADVANCED, gui.pause(500),
              choose("Recovery", "Off"), gui.pause(300), choose("Initialization", "Seeds"),
              gui.pause(500)]
SHOW_LIST = gui.event(f"{gui.PANEL}/scrollArea/qt_scrollarea_vcontainer/1QScrollBar0", "set_int",
                      "500")


def rows(list_, number):
    return gui.check(f"{list_}/Points", "modelRowCount", str(number))


def typed(cell, text):
    """Return the events that type text into a cell of the list of seeds."""
    editor = f"{SEEDS}/Points/qt_scrollarea_viewport/1QExpandingLineEdit0"
    return [gui.event(f"{SEEDS}/Points", "edit", cell), gui.event(editor, "set_string", text),
            gui.event(editor, "key", "16777220")]


class PointsWindowTest(window.WindowTestCase):
    def test_added_edited_and_removed_in_the_panel(self):
        path, save = self.saved_state("points-added.pvsm")
        add, remove = (gui.event(f"{SEEDS}/{name}", "activate") for name in ("Add", "Remove"))
        unsaved, save_unsaved = self.saved_state("points-unapplied.pvsm")
        pixels = self.play(a_slice_of(two_balls()) + [
            filter_of_the_menu("VolumeToSurface"), gui.pause(300),
            window.shown("SeedPositions", False), window.shown("AttractingPositions", False),
            # Without advanced properties.
            choose("KeepComponents", "At Points"), gui.pause(300),
            window.shown("SeedPositions", True), gui.check(f"{SEEDS}/Title", "text", "Points"),
            choose("KeepComponents", "All"),
            gui.pause(300), window.shown("SeedPositions", False),
            SHOW_ADVANCED, choose("Initialization", "Seeds"), gui.pause(300),
            choose("Recovery", "Off"), gui.pause(300),
            window.shown("SeedPositions", True), window.shown("AttractingPositions", True),
            gui.check(f"{SEEDS}/Title", "text", "Seed Positions"),
            gui.check(f"{SEEDS}/ShowPoints", "checked", "true"),
            gui.check(f"{ATTRACTING}/ShowPoints", "checked", "false"),
            gui.check(f"{SEEDS}/Remove", "enabled", "false"),
            add, add, add, rows(SEEDS, 3), SHOW_LIST, gui.pause(300),
            # The last one is current.
            remove, rows(SEEDS, 2), *typed("1.0", "46.5"), gui.pause(500), *save_unsaved],
            "points-added")
        # Before Apply the state has no seeds, but the view shows both, one at its centre.
        self.assertEqual(len(window.open_state(unsaved, "VolumetoSurface1").SeedPositions), 0)
        self.assertTrue(self.is_marked(pixels, CENTRE), "a handle at the centre")
        self.play(a_slice_of(two_balls()) + FROM_SEEDS + [
            add, *typed("0.0", "46.5"), gui.pause(300), APPLY, gui.pause(300), *save,
            remove, rows(SEEDS, 0), APPLY, gui.pause(300),
            edit("actionEditUndo"), gui.pause(500), rows(SEEDS, 1),
            edit("actionEditRedo"), gui.pause(500), rows(SEEDS, 0)], "points-applied")
        filter_ = window.open_state(path, "VolumetoSurface1")
        surface = testing.fetch(filter_)
        self.assertEqual(list(filter_.SeedPositions), [46.5, 20.0, 20.0])
        self.assertEqual(testing.field(surface, "NumberOfComponents"), 1)
        self.assertGreater(surface.GetBounds()[0], 30.0)

    @staticmethod
    def position(pixels, offset):
        """Return the position on the screen: the view is between the blue lines of its frame."""
        row = pixels[600].astype(int)
        lines = numpy.nonzero((row[:, 2] > 200) & (row[:, :2].max(axis=1) < 60))[0]
        left = numpy.diff(lines).argmax()
        return int(lines[left] + lines[left + 1]) // 2 + offset[0], 463 + offset[1]

    def is_marked(self, pixels, offset):
        """Return whether there is a handle, which alone is magenta."""
        x, y = self.position(pixels, offset)
        near = pixels[y - 12:y + 13, x - 12:x + 13].astype(int)
        return bool((near - (255, 0, 255) == 0).all(axis=2).any())

    def picture(self, name):
        return self.session.screenshot(testing.output_path(f"{name}.png"))

    def picture_with_a_mark(self, name, position):
        """Wait for a handle, and return the picture."""
        end = time.monotonic() + gui.PATIENCE
        while not self.is_marked(self.picture(name), position):
            self.assertLess(time.monotonic(), end, f"no handle is drawn; see {name}.png")
            time.sleep(0.2)
        self.session.wait_for_rest()  # for the panel
        return self.picture(name)

    def pick(self, position, name):
        """Pick a point. Return mouse and keys, and the picture with the point."""
        # ParaView ignores real mouse and keys while it plays events.
        hand = x_input.Input(self.session.display)
        hand.move(*self.position(self.session.pixels(), position))
        hand.focus()
        hand.key("p")
        return hand, self.picture_with_a_mark(name, position)

    def applied(self, hand, pixels):
        """Press Apply, at its position in the picture. Return the report of the run."""
        button = window.apply_button(pixels)
        hand.drag(button, button)
        return self.session.wait_for(" .\n")

    @unittest.skipUnless(x_input.Input.is_there(), "libXtst was not found")
    def test_picked_and_dragged_in_the_view(self):
        self.play(a_slice_of(two_balls()) + FROM_SEEDS + [SHOW_LIST, gui.pause(500)],
                  "points-none", python=REPORT_RUNS, live=True)
        hand, picked = self.pick(BETWEEN, "points-picked")
        self.assertFalse(self.is_marked(picked, LEFT_BALL))
        hand.drag(*[self.position(picked, position) for position in (BETWEEN, LEFT_BALL)])
        dragged = self.picture_with_a_mark("points-dragged", LEFT_BALL)
        self.assertFalse(self.is_marked(dragged, BETWEEN))
        printed = self.applied(hand, dragged)
        self.assertIn("Run:", printed, "nothing was applied")
        x, y, z, low, high = [float(n) for n in re.search(
            r"Run: (\S+) (\S+) (\S+) .*surface: (\S+) (\S+)", printed).groups()]
        # On the visible slice, at the end of the drag; the surface grew from there.
        self.assertLess(abs(x - 15.0), 4.0)  # the width of panels depends on the version
        self.assertLess(abs(y - 20.0), 2.0)
        self.assertAlmostEqual(z, 20.0, places=3)
        self.assertLess(low, 8.0)
        self.assertLess(high, 25.0)
        self.picture("points-picked-applied")

    @unittest.skipUnless(x_input.Input.is_there(), "libXtst was not found")
    def test_pick_components(self):
        self.play(opened(five_balls()) + [
            filter_of_the_menu("VolumeToSurface"), APPLY, gui.pause(500),
            choose("KeepComponents", "At Points"), gui.pause(500), APPLY, gui.pause(500)],
            "points-components", python=REPORT_RUNS, live=True)
        self.assertRegex(self.session.output, "Run: parts: 5 [^R]*Run: parts: 5 ", "no points")
        printed = self.applied(*self.pick(LOWER_LEFT, "points-component-picked"))
        self.assertIn(" parts: 1 ", printed)
        self.session.wait_for_rest()
        # Other components are faint, and can be picked.
        hand, picked = self.pick(LOWER_RIGHT, "points-faint-component-picked")
        x, y = self.position(picked, LOWER_RIGHT)
        self.assertGreater(abs(picked[y - 20, x].astype(int) - picked[y + 60, x]).max(), 5)
        printed = self.applied(hand, picked)
        self.assertIn(" parts: 2 ", printed)
        low, high = (float(n) for n in re.search(r"surface: (\S+) (\S+)", printed).groups())
        self.assertLess(low, 10.0)
        self.assertGreater(high, 50.0)
        before = self.picture("points-components-applied")
        hand.move(*self.position(before, BESIDE))
        hand.focus()
        hand.key("p")
        end = time.monotonic() + gui.PATIENCE
        while (self.picture("points-beside")[-25:, :300] == before[-25:, :300]).all():
            self.assertLess(time.monotonic(), end, "the status bar does not report it")
            time.sleep(0.2)
        self.assertFalse(self.is_marked(self.picture("points-beside"), BESIDE))
