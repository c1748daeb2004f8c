# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Seeds and points known to belong to the object, set in ParaView's window: picked by P in the view,
dragged there, added, edited and removed in the panel's list, undone, and kept by states."""

import os
import re
import sys
import time
import unittest

import numpy

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import gui_session as gui
import plugin_testing as testing
import window_testing as window
import x_input
from paraview import simple
from window_testing import APPLY, PROPERTIES, SHOW_ADVANCED, filter_of_the_menu

SEEDS = f"{PROPERTIES}/SeedPositions"
ATTRACTING = f"{PROPERTIES}/AttractingPositions"
INITIALIZATION = f"{PROPERTIES}/Initialization/ComboBox"
REPRESENTATION = f"{gui.WINDOW}/representationToolbar/displayRepresentation/comboBox"
# Places of the screen in the picture of `two_balls`, whose centre is that of the view.
LEFT_BALL, BETWEEN, CENTRE = (645, 463), (725, 540), (725, 463)

# Runs in the window: tells each run's seeds, and between which x its surface lies.
TELL_OF_RUNS = window.WATCH_FILTERS + """
def attend(proxy, algorithm):
    def end(caller, event):
        bounds = caller.GetOutputDataObject(0).GetBounds()
        print("Run:", *proxy.SeedPositions, "surface:", *bounds[:2], ".", flush=True)
    algorithm.AddObserver("EndEvent", end)
"""


def two_balls():
    """Path of a volume: balls of radius 9 about (14, 20, 20) and (46, 20, 20)."""
    z, y, x = numpy.mgrid[0:41, 0:41, 0:61].astype(float)
    distance = numpy.hypot(numpy.abs(x - 30.0) - 16.0, numpy.hypot(y - 20.0, z - 20.1)) - 9.0
    return testing.write_volume(
        "two-balls.vti", testing.make_image(numpy.clip(50.0 - 50.0 * distance, 0.0, 100.0)))


def a_slice_of(volume):
    return [gui.event(f"{gui.WINDOW}/menubar/menu_File", "activate", "actionFileOpen"),
            gui.event(f"{gui.WINDOW}/FileOpenDialog", "filesSelected", volume), APPLY,
            gui.pause(1000), gui.event(REPRESENTATION, "set_string", "Slice"), gui.pause(1500)]


FROM_SEEDS = [filter_of_the_menu("VolumeToSurface"), SHOW_ADVANCED, gui.pause(500),
              gui.event(f"{PROPERTIES}/Recovery/ComboBox", "set_string", "Off"), gui.pause(300),
              gui.event(INITIALIZATION, "set_string", "Seeds"), gui.pause(500)]
SHOW_LIST = gui.event(f"{gui.PANEL}/scrollArea/qt_scrollarea_vcontainer/1QScrollBar0", "set_int",
                      "500")


def edit(action):
    return gui.event(f"{gui.WINDOW}/menubar/menu_Edit", "activate", action)


def rows(list_, number):
    return gui.check(f"{list_}/Points", "modelRowCount", str(number))


class PointsWindowTest(window.WindowTestCase):
    def saved(self, path, name="VolumetoSurface1"):
        """The filter of a state, and what it gives."""
        filter_ = window.open_state(path, name)
        return filter_, testing.fetch(filter_)

    def components(self, surface):
        return surface.GetFieldData().GetArray("NumberOfComponents").GetValue(0)

    def test_list_appears_where_it_is_of_use(self):
        self.play(a_slice_of(two_balls()) + [
            filter_of_the_menu("VolumeToSurface"), gui.pause(500),
            window.shown("SeedPositions", False), window.shown("AttractingPositions", False),
            # Of use without advanced properties as well.
            gui.event(f"{PROPERTIES}/KeepComponents/ComboBox", "set_string", "At Points"),
            gui.pause(500), window.shown("SeedPositions", True),
            gui.event(f"{PROPERTIES}/KeepComponents/ComboBox", "set_string", "All"),
            gui.pause(500), window.shown("SeedPositions", False),
            SHOW_ADVANCED, gui.event(INITIALIZATION, "set_string", "Seeds"), gui.pause(500),
            window.shown("SeedPositions", True), window.shown("AttractingPositions", True),
            gui.check(f"{SEEDS}/ShowPoints", "checked", "true"),
            gui.check(f"{ATTRACTING}/ShowPoints", "checked", "false")], "points-panel")

    def test_added_edited_and_removed_in_the_panel(self):
        path, save = self.saved_state("points-added.pvsm")
        add, remove = (gui.event(f"{SEEDS}/{name}", "activate") for name in ("Add", "Remove"))
        pixels = self.play(a_slice_of(two_balls()) + FROM_SEEDS + [
            gui.check(f"{SEEDS}/Remove", "enabled", "false"),
            add, add, add, rows(SEEDS, 3), SHOW_LIST, gui.pause(300),
            # The last is the current one.
            remove, rows(SEEDS, 2),
            gui.event(f"{SEEDS}/Points", "edit", "1.0"),
            gui.event(f"{SEEDS}/Points/qt_scrollarea_viewport/1QExpandingLineEdit0", "set_string",
                      "46.5"),
            gui.event(f"{SEEDS}/Points/qt_scrollarea_viewport/1QExpandingLineEdit0", "key",
                      "16777220"),
            gui.pause(1000), *save, gui.pause(1000)], "points-added")
        # Not applied: the state has none; the view shows both, one in its middle.
        self.assertEqual(len(window.open_state(path, "VolumetoSurface1").SeedPositions), 0)
        self.assertTrue(self.is_marked(pixels, *CENTRE), "a handle in the middle")
        self.session.close_window()
        self.play(a_slice_of(two_balls()) + FROM_SEEDS + [
            add, gui.event(f"{SEEDS}/Points", "edit", "0.0"),
            gui.event(f"{SEEDS}/Points/qt_scrollarea_viewport/1QExpandingLineEdit0", "set_string",
                      "46.5"),
            gui.event(f"{SEEDS}/Points/qt_scrollarea_viewport/1QExpandingLineEdit0", "key",
                      "16777220"),
            gui.pause(500), APPLY, gui.pause(500), *save,
            gui.event(f"{SEEDS}/RemoveAll", "activate"), rows(SEEDS, 0), APPLY, gui.pause(500),
            edit("actionEditUndo"), gui.pause(1000), rows(SEEDS, 1),
            edit("actionEditRedo"), gui.pause(1000), rows(SEEDS, 0)], "points-applied")
        filter_, surface = self.saved(path)
        self.assertEqual(list(filter_.SeedPositions), [46.5, 20.0, 20.0])
        self.assertEqual(self.components(surface), 1)
        self.assertGreater(surface.GetBounds()[0], 30.0)

    @staticmethod
    def is_marked(pixels, x, y):
        """Whether a handle is drawn there: nothing else is magenta."""
        near = pixels[y - 12:y + 13, x - 12:x + 13].astype(int)
        return bool((near - (255, 0, 255) == 0).all(axis=2).any())

    @staticmethod
    def apply_button(pixels):
        """Its middle: there is something to apply, so that it is green, as nothing else near."""
        red, green, blue = numpy.moveaxis(pixels[380:480, :290].astype(int), 2, 0)
        rows, columns = numpy.nonzero((green > red + 20) & (green > blue + 20))
        return int(numpy.median(columns)), 380 + int(numpy.median(rows))

    @unittest.skipUnless(x_input.Input.is_there(), "libXtst was not found")
    def test_picked_and_dragged_in_the_view(self):
        self.play(a_slice_of(two_balls()) + FROM_SEEDS + [SHOW_LIST, gui.pause(500)],
                  "points-none", python=TELL_OF_RUNS)
        # ParaView leaves real mouse and keys aside while it plays events.
        hand = x_input.Input(self.session.display)
        hand.move(*BETWEEN)
        hand.focus()
        hand.key("p")
        picked = self.picture("points-picked")
        self.assertTrue(self.is_marked(picked, *BETWEEN))
        self.assertFalse(self.is_marked(picked, *LEFT_BALL))
        hand.drag(BETWEEN, LEFT_BALL)
        dragged = self.picture("points-dragged")
        self.assertTrue(self.is_marked(dragged, *LEFT_BALL))
        self.assertFalse(self.is_marked(dragged, *BETWEEN))
        button = self.apply_button(dragged)
        hand.drag(button, button)
        told = self.session.wait_for(" .\n", timeout=180)
        self.assertIn("Run:", told, "nothing was applied")
        x, y, z, low, high = [float(n) for n in
                              re.search(r"Run: (\S+) (\S+) (\S+) surface: (\S+) (\S+)", told).groups()]
        # On the slice that was shown, where it was dragged to; the surface grew from there.
        self.assertLess(abs(x - 15.0), 4.0)  # panels are as wide as the version has them
        self.assertLess(abs(y - 20.0), 2.0)
        self.assertAlmostEqual(z, 20.0, places=3)
        self.assertLess(low, 8.0)
        self.assertLess(high, 25.0)
        self.picture("points-picked-applied")

    @unittest.skipUnless(x_input.Input.is_there(), "libXtst was not found")
    def test_a_component_is_kept_or_dropped_in_the_view(self):
        for choice, name in (("At Points", "kept"), ("Not At Seeds", "dropped")):
            with self.subTest(choice):
                low, high = self.bounds_of_chosen(choice, name)
                self.assertEqual(low < 8.0, name == "kept")
                self.assertEqual(high < 25.0, name == "kept", "the other ball is left out")
            self.session.close_window()

    def bounds_of_chosen(self, choice, name):
        """Of what there is along x when the left ball has been pointed at."""
        self.play(a_slice_of(two_balls()) + [
            filter_of_the_menu("VolumeToSurface"), APPLY, gui.pause(1500),
            gui.event(f"{PROPERTIES}/KeepComponents/ComboBox", "set_string", choice),
            gui.pause(1000)], "points-components", python=TELL_OF_RUNS)
        hand = x_input.Input(self.session.display)
        hand.move(*LEFT_BALL)
        hand.focus()
        hand.key("p")
        picked = self.picture("points-component-picked")
        button = self.apply_button(picked)
        hand.drag(button, button)
        told = self.session.wait_for(" .\n", timeout=180)
        self.picture(f"points-component-{name}")
        return [float(n) for n in re.search(r"surface: (\S+) (\S+)", told).groups()]

    def picture(self, name):
        time.sleep(1.5)
        return self.session.screenshot(testing.output_path(f"{name}.png"))

    def test_known_points(self):
        path, save = self.saved_state("points-known.pvsm")
        pixels = self.play(a_slice_of(two_balls()) + [
            filter_of_the_menu("VolumeToSurface"), SHOW_ADVANCED, gui.pause(500),
            gui.event(f"{ATTRACTING}/Add", "activate"), gui.pause(1000), rows(ATTRACTING, 1),
            APPLY, gui.pause(500), *save], "points-known")
        self.assertFalse(self.is_marked(pixels, *CENTRE), "handles only where they are asked for")
        filter_, surface = self.saved(path)
        self.assertEqual(list(filter_.AttractingPositions), [30.0, 20.0, 20.0])
        # A ball of its own about the point between the two.
        self.assertEqual(self.components(surface), 3)


class PointsInScriptsTest(unittest.TestCase):
    def test_python_sets_them_and_states_keep_them(self):
        testing.load_plugin()
        volume = simple.XMLImageDataReader(FileName=[two_balls()])
        filter_ = simple.VolumetoSurface(registrationName="points", Input=volume, IsoValue=50,
                                         Recovery="Off", Initialization="Seeds",
                                         SeedPositions=[14, 20, 20])
        self.assertLess(testing.fetch(filter_).GetBounds()[1], 30.0)
        filter_.SeedPositions = [46, 20, 20, 14, 20, 20]
        self.assertGreater(testing.fetch(filter_).GetBounds()[1], 30.0)
        # None again; and a ball of its own about a point between the two.
        filter_.SeedPositions = []
        filter_.Initialization = "Enclosing Icosahedron"
        filter_.Recovery = "Objects"
        filter_.AttractingPositions = [30, 20, 20]
        number = testing.fetch(filter_).GetFieldData().GetArray("NumberOfComponents").GetValue(0)
        self.assertEqual(number, 3)
        self.assertEqual(list(filter_.SeedPositions), [])
        filter_.SeedPositions = [46, 20, 20, 0.1, 20, 20]
        path = testing.output_path("points-script.pvsm")
        simple.SaveState(path)
        again = window.open_state(path, "points")
        self.assertEqual(list(again.SeedPositions), [46, 20, 20, 0.1, 20, 20])
        self.assertEqual(list(again.AttractingPositions), [30, 20, 20])


window.main()
