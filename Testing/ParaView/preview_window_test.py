# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Choosing an iso-value by seeing it, in ParaView's window: Preview on and off, with Apply and with
Auto Apply; and Show Levels."""

import os
import re
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import gui_session as gui
import plugin_testing as testing
import window_testing as window
from window_testing import (
    APPLY, PROPERTIES, SHOW_ADVANCED, choose, filter_of_the_menu, set_box, set_iso_value, source)
from paraview import simple

EXTENT = [-60, 60] * 3  # 1.8 million voxels: level 1 is the preview
FILTER = filter_of_the_menu("VolumeToSurface")

# Runs in the window: makes the volume larger, and tells of each run of the filter what it gave and
# which levels have iterated for it.
TELL_THE_RUNS = """
from paraview import servermanager, simple
simple.GetSettingsProxy("GeneralSettings").AutoApply = AUTO_APPLY
watched = []

def watch(manager, event):
    for proxy in simple.GetSources().values():
        if proxy.GetXMLName() == "RTAnalyticSource" and proxy not in watched:
            watched.append(proxy)
            proxy.WholeExtent = EXTENT
        algorithm = proxy.GetClientSideObject()
        if algorithm and algorithm.IsA("vtkDeformableSurface") and algorithm not in watched:
            watched.append(algorithm)
            levels = set()
            def progress(caller, event, levels=levels):
                text = caller.GetProgressText() or ""
                if ", iteration" in text:
                    levels.add(int(text.split()[1].strip(",")))
            def end(caller, event):
                surface = caller.GetOutputDataObject(0)
                print("Run: level", surface.GetFieldData().GetArray("Level").GetValue(0), "triangles",
                      surface.GetNumberOfPolys(), "iterated", sorted(levels), flush=True)
            def start(caller, event):
                levels.clear()
                caller.SetProgressText("")
            algorithm.AddObserver("StartEvent", start)
            algorithm.AddObserver("ProgressEvent", progress)
            algorithm.AddObserver("EndEvent", end)

servermanager.ProxyManager().SMProxyManager.AddObserver("RegisterEvent", watch)
"""


def triangles_of(iso_value, extent=None, **properties):
    """Of a run from the start."""
    testing.load_plugin()
    volume = simple.Wavelet(WholeExtent=extent or EXTENT)
    filter_ = simple.VolumetoSurface(volume, IsoValue=iso_value, **properties)
    return testing.fetch(filter_).GetNumberOfPolys()


class PreviewWindowTest(window.WindowTestCase):
    def runs(self, events, picture, auto_apply=0, extent=None):
        """Level, triangles and levels that iterated of each run, while the events are played."""
        self.play(source("RTAnalyticSource") + [FILTER, gui.pause(500), *events], picture,
                  python=TELL_THE_RUNS.replace("AUTO_APPLY", str(auto_apply)).replace(
                      "EXTENT", str(extent or EXTENT)))
        found = re.findall(r"Run: level (-?\d+) triangles (\d+) iterated (\[.*\])",
                           self.session.output)
        return [(int(level), int(triangles), levels) for level, triangles, levels in found]

    def test_on_and_off(self):
        runs = self.runs([
            window.shown("Preview", True), window.shown("TimeLimit", False),
            set_iso_value(140), set_box("Preview", True), APPLY, gui.pause(2000),
            set_iso_value(150), APPLY, gui.pause(1000),
            set_box("Preview", False), APPLY, gui.pause(2000),
            set_box("Preview", True), APPLY, gui.pause(1000),
            SHOW_ADVANCED, gui.pause(500), window.shown("TimeLimit", True)], "preview")
        self.assertEqual([run[0] for run in runs], [1, 1, 0, 1], self.session.output)
        self.assertEqual([run[1] for run in runs],
                         [triangles_of(140.0, Preview=1), triangles_of(150.0, FinestLevel=1),
                          triangles_of(150.0), runs[1][1]])
        self.assertEqual([run[2] for run in runs][2:], ["[0]", "[]"], "goes on, and shows at once")

    def test_other_components_without_another_run(self):
        runs = self.runs([
            set_iso_value(180), APPLY, gui.pause(2000),
            choose("KeepComponents", "Largest"), APPLY, gui.pause(1000),
            choose("KeepComponents", "All"), APPLY, gui.pause(1000)], "preview-components")
        all_, largest = triangles_of(180.0), triangles_of(180.0, KeepComponents="Largest")
        self.assertLess(largest, all_)
        self.assertEqual([run[1] for run in runs], [all_, largest, all_], self.session.output)
        self.assertNotEqual(runs[0][2], "[]")
        self.assertEqual([run[2] for run in runs[1:]], ["[]"] * 2, "no level iterates")

    def test_auto_apply(self):
        runs = self.runs([
            gui.pause(4000), set_box("Preview", True), gui.pause(2000), set_iso_value(150),
            gui.pause(3000), set_box("Preview", False), gui.pause(4000)], "preview-auto-apply",
            auto_apply=1)
        self.assertEqual(runs[-2][0], 1, self.session.output)
        self.assertEqual(runs[-1], (0, triangles_of(150.0), "[0]"), self.session.output)

    def test_each_level_is_shown_as_soon_as_it_rests(self):
        extent = [-90, 90] * 3
        runs = self.runs([
            set_iso_value(150), set_box("ShowLevels", True), APPLY, gui.pause(6000),
            set_iso_value(140), APPLY, gui.pause(6000)], "preview-levels", extent=extent)
        self.assertEqual([run[0] for run in runs], [2, 1, 0] * 2, self.session.output)
        self.assertEqual([run[1] for run in runs],
                         [triangles_of(iso, extent, FinestLevel=level)
                          for iso in (150.0, 140.0) for level in (2, 1, 0)])
        self.assertEqual([run[2] for run in runs][1:3], ["[1]", "[0]"], "each goes on")

    def test_levels_are_shown_down_to_one_finer_than_the_volume(self):
        extent = [-20, 20] * 3
        runs = self.runs([
            set_iso_value(150),
            gui.event(f"{PROPERTIES}/FinestLevel/IntRangeWidget/LineEdit", "set_string", "-1"),
            set_box("ShowLevels", True), APPLY, gui.pause(6000)], "preview-levels-finer",
            extent=extent)
        # The preview is level 0 itself.
        self.assertEqual([run[:2] for run in runs],
                         [(level, triangles_of(150.0, extent, FinestLevel=level))
                          for level in (0, -1)], self.session.output)

    def test_levels_are_not_shown_where_nobody_watches(self):
        self.assertEqual(triangles_of(150.0, ShowLevels=1), triangles_of(150.0))


window.main()
