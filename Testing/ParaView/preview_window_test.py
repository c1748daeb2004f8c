# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Preview and Show Levels in ParaView's window, with Apply and Auto Apply."""

import re

import gui_session as gui
import plugin_testing as testing
import window_testing as window
from window_testing import (
    APPLY, SHOW_ADVANCED, filter_of_the_menu, set_box, set_iso_value)
from paraview import simple

EXTENT = [-60, 60] * 3  # 1.8 million voxels: level 1 is the preview
FILTER = filter_of_the_menu("VolumeToSurface")

# Runs in the window: shows a larger volume, and reports the output and the iterated levels of each run of
# the filter.
REPORT_RUNS = """
from paraview import simple
simple.GetSettingsProxy("GeneralSettings").AutoApply = AUTO_APPLY
""" + window.WATCH_FILTERS + """
def attend(proxy, algorithm):
    levels = set()
    def progress(caller, event):
        text = caller.GetProgressText() or ""
        if ", iteration" in text:
            levels.add(int(text.split()[1].strip(",")))
    def end(caller, event):
        surface = caller.GetOutputDataObject(0)
        print("Run: level", surface.GetFieldData().GetArray("Level").GetValue(0), "triangles",
              surface.GetNumberOfPolys(), "iterated", sorted(levels))
    def start(caller, event):
        levels.clear()
        caller.SetProgressText("")
    algorithm.AddObserver("StartEvent", start)
    algorithm.AddObserver("ProgressEvent", progress)
    algorithm.AddObserver("EndEvent", end)
""" + f"""
simple.Show(simple.Wavelet(WholeExtent={EXTENT}))
"""


def triangles_of(iso_value, **properties):
    """Return the number of triangles of a new run."""
    testing.load_plugin()
    filter_ = simple.VolumetoSurface(simple.Wavelet(WholeExtent=EXTENT), IsoValue=iso_value,
                                     **properties)
    return testing.fetch(filter_).GetNumberOfPolys()


class PreviewWindowTest(window.WindowTestCase):
    def run_(self, number):
        """Return the event that waits for the end of that many runs."""
        return self.until_printed("Run:", number)

    def runs(self, events, picture, auto_apply=0):
        """Play the events. Return level, triangles and iterated levels of each run."""
        self.play([gui.pause(300), FILTER, gui.pause(300), *events], picture,
                  python=REPORT_RUNS.replace("AUTO_APPLY", str(auto_apply)))
        found = re.findall(r"Run: level (-?\d+) triangles (\d+) iterated (\[.*\])",
                           self.session.output)
        return [(int(level), int(triangles), levels) for level, triangles, levels in found]

    def test_preview(self):
        runs = self.runs([
            window.shown("Preview", True), window.shown("TimeLimit", False),
            set_iso_value(140), set_box("Preview", True), APPLY, self.run_(1),
            set_iso_value(150), APPLY, self.run_(2),
            set_box("Preview", False), APPLY, self.run_(3),
            set_box("Preview", True), APPLY, self.run_(4),
            SHOW_ADVANCED, gui.pause(300), window.shown("TimeLimit", True)], "preview")
        self.assertEqual([run[0] for run in runs], [1, 1, 0, 1], self.session.output)
        self.assertEqual([run[1] for run in runs],
                         [triangles_of(140.0, Preview=1), triangles_of(150.0, FinestLevel=1),
                          triangles_of(150.0), runs[1][1]])
        self.assertEqual([run[2] for run in runs][2:], ["[0]", "[]"],
                         "resumes, then shows a finished level")

    def test_auto_apply(self):
        runs = self.runs([
            self.run_(1), set_box("Preview", True), self.run_(2), set_iso_value(150),
            self.run_(3), set_box("Preview", False), self.run_(4)], "preview-auto-apply",
            auto_apply=1)
        self.assertEqual(runs[-2][0], 1, self.session.output)
        self.assertEqual(runs[-1], (0, triangles_of(150.0), "[0]"), self.session.output)

    def test_show_levels(self):
        runs = self.runs([
            set_iso_value(150), set_box("ShowLevels", True), APPLY, self.run_(2),
            set_iso_value(140), APPLY, self.run_(4)], "preview-levels")
        self.assertEqual([run[0] for run in runs], [1, 0] * 2, self.session.output)
        self.assertEqual([run[1] for run in runs],
                         [triangles_of(iso, FinestLevel=level)
                          for iso in (150.0, 140.0) for level in (1, 0)])
        self.assertEqual(runs[1][2], "[0]", "it resumes")
