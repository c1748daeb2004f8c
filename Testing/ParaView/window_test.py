# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Image Pyramid in ParaView's window, by its menu and its panel as a user does."""

import gui_session as gui
import plugin_testing as testing
import window_testing as window
from window_testing import APPLY, PROPERTIES, SHOW_ADVANCED, filter_of_the_menu, source


class WindowTest(window.WindowTestCase):
    def test_menu_panel_and_apply(self):
        path, save = self.saved_state("window.pvsm")
        levels = f"{PROPERTIES}/NumberOfLevels/IntRangeWidget/LineEdit"
        advanced = ("MinimumLevelSize", "ReductionFactor", "NumberOfThreads")
        pixels = self.play(source("RTAnalyticSource") + [
            filter_of_the_menu("ImagePyramid"),
            gui.check(f"{PROPERTIES}/SetInputArrayToProcess/ComboBox", "currentText", "RTData"),
            gui.check(levels, "text", "0"), *[window.shown(name, False) for name in advanced],
            SHOW_ADVANCED, gui.pause(500), *[window.shown(name, True) for name in advanced],
            gui.check(f"{PROPERTIES}/MinimumLevelSize/LineEdit0", "text", "10"),
            gui.check(f"{PROPERTIES}/MinimumLevelSize", "enabled", "true"),
            gui.event(levels, "set_string", "3"), APPLY, *save], "applied")
        self.assertGreater(pixels.std(), 10, "the window is drawn")
        self.assertIn("ImagePyramid", window.proxies_of(path))
        # A saved state opens in a script, and gives what the window showed.
        pyramid = testing.fetch(window.open_state(path, "ImagePyramid1"))
        self.assertEqual(pyramid.GetNumberOfBlocks(), 3)
        self.assertEqual(pyramid.GetBlock(2).GetDimensions(), (6, 6, 6))
