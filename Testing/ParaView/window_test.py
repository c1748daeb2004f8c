# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The plugin in ParaView's window, by its menu and its panel as a user does.

Pictures of the window at each stage go to VOLUMIC_TEST_OUTPUT, to be looked at.
"""

import os
import sys
import unittest
import xml.etree.ElementTree as ElementTree

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import gui_session as gui
import plugin_testing as testing
from paraview import simple

FILTERS = f"{gui.WINDOW}/menubar/menuFilters"
PROPERTIES = f"{gui.PANEL}/scrollArea/qt_scrollarea_viewport/scrollAreaWidgetContents/" \
             "PropertiesFrame/ProxyPanel"
APPLY = gui.event(f"{gui.PANEL}/Accept", "activate")
SHOW_ADVANCED = gui.event(f"{gui.PANEL}/SearchBox/AdvancedButton", "set_boolean", "true")
KEY_UP, KEY_RIGHT = ("6,16777235,0,,0,1", "6,16777236,0,,0,1")


def source(name):
    """Events that make a source of the Sources menu and apply it."""
    return [gui.event(f"{gui.WINDOW}/menubar/menuSources/Alphabetical", "activate", name), APPLY]


def filter_of_the_menu(name):
    return gui.event(f"{FILTERS}/Volumic", "activate", name)


class WindowTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.session = gui.Session(testing.program("paraview"), testing.plugin_path(),
                                  os.environ["VOLUMIC_XVFB"])

    @classmethod
    def tearDownClass(cls):
        cls.session.close()

    def tearDown(self):
        self.session.close_window()

    def play(self, events, picture):
        """Play the events in a new window, and take its picture, also if an event failed."""
        succeeded = self.session.play(events)
        pixels = self.session.screenshot(testing.output_path(f"{picture}.png"))
        self.assertTrue(succeeded, self.session.output)
        for word in ("ERR|", "critical:"):
            self.assertNotIn(word, self.session.output)
        return pixels

    def saved_state(self, name):
        """Path of a state, and the events that save it from the window."""
        path = testing.output_path(name)
        if os.path.exists(path):
            os.remove(path)
        return path, [
            gui.event(f"{gui.WINDOW}/menubar/menu_File", "activate", "actionFileSaveServerState"),
            gui.event(f"{gui.WINDOW}/FileSaveServerStateDialog", "filesSelected", path)]

    def test_the_open_menu(self):
        # Volumic is the last of the categories: one up from the first entry.
        pixels = self.play(source("RTAnalyticSource") + [
            gui.event(f"{gui.WINDOW}/menubar", "activate", "menuFilters"), gui.pause(1000),
            gui.event(FILTERS, "keyEvent", KEY_UP), gui.pause(500),
            gui.event(FILTERS, "keyEvent", KEY_RIGHT), gui.pause(2000)], "menu")
        self.assertGreater(pixels.std(), 10, "the window is drawn")

    def test_menu_panel_and_apply(self):
        path, save = self.saved_state("window.pvsm")
        levels = f"{PROPERTIES}/NumberOfLevels/IntRangeWidget/LineEdit"
        self.play(source("RTAnalyticSource") + [
            filter_of_the_menu("ImagePyramid"),
            gui.check(f"{PROPERTIES}/SetInputArrayToProcess/ComboBox", "currentText", "RTData"),
            gui.check(levels, "text", "0"),
            gui.check(f"{PROPERTIES}/MinimumLevelSize", "visible", "false"),
            gui.check(f"{PROPERTIES}/ReductionFactor", "visible", "false"),
            gui.check(f"{PROPERTIES}/NumberOfThreads", "visible", "false"),
            gui.event(levels, "set_string", "3"), APPLY, *save, gui.pause(1500)], "applied")

        state = ElementTree.parse(path).getroot()
        proxies = [proxy.get("type") for proxy in state.iter("Proxy")]
        self.assertIn("ImagePyramid", proxies)
        # A saved state opens in a script, and gives what the window showed.
        testing.load_plugin()
        simple.LoadState(path)
        pyramid = testing.fetch(simple.FindSource("ImagePyramid1"))
        self.assertEqual(pyramid.GetNumberOfBlocks(), 3)
        self.assertEqual(pyramid.GetBlock(2).GetDimensions(), (6, 6, 6))

    def test_advanced_panel(self):
        self.play(source("RTAnalyticSource") + [
            filter_of_the_menu("ImagePyramid"), SHOW_ADVANCED, gui.pause(1000),
            gui.check(f"{PROPERTIES}/MinimumLevelSize/LineEdit0", "text", "10"),
            gui.check(f"{PROPERTIES}/MinimumLevelSize", "visible", "true"),
            gui.check(f"{PROPERTIES}/MinimumLevelSize", "enabled", "true"),
            gui.check(f"{PROPERTIES}/ReductionFactor", "visible", "true"),
            gui.check(f"{PROPERTIES}/NumberOfThreads", "visible", "true")], "advanced")

    def test_not_offered_for_what_is_no_volume(self):
        path, save = self.saved_state("sphere.pvsm")
        # The menu's entry is there, but greyed out, and does nothing.
        self.session.play(source("SphereSource") + [filter_of_the_menu("ImagePyramid"), *save])
        proxies = [proxy.get("type") for proxy in ElementTree.parse(path).iter("Proxy")]
        self.assertIn("SphereSource", proxies)
        self.assertNotIn("ImagePyramid", proxies)


if not os.environ["VOLUMIC_XVFB"]:
    print("Skipped: Xvfb was not found")
    sys.exit(77)
testing.main()
