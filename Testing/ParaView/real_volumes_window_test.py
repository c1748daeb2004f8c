# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""A newcomer's first minutes in ParaView's window with real volumes: open, Preview, Apply, another
Iso Value, Preview off. No message may open over the view, unless a user must act."""

import os
import re
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import gui_session as gui
import plugin_testing as testing
import window_testing as window
from vtkmodules.vtkIOXML import vtkXMLImageDataReader
from window_testing import (
    APPLY, FROM_THE_FRONT, eye_of, filter_of_the_menu, opened, set_box, set_iso_value)

# Runs in the window: tells what each run of the filter gave.
TELL_THE_RUNS = window.WATCH_FILTERS + """
def attend(proxy, algorithm):
    def end(caller, event):
        facts = caller.GetOutputDataObject(0).GetFieldData()
        reason = facts.GetAbstractArray("StopReason")
        print("Run: level", facts.GetArray("Level").GetValue(0) if reason else "none", ";",
              reason.GetValue(0) if reason else "error", ";",
              caller.GetOutputDataObject(0).GetNumberOfPolys(), flush=True)
    algorithm.AddObserver("EndEvent", end)
"""


class RealVolumesTest(window.WindowTestCase):
    def volume(self, name):
        """Events that open it."""
        path = os.path.join(os.environ["VOLUMIC_SHARED_DATA"], name)
        if not os.path.exists(path):
            self.skipTest(f"{path} is missing")
        reader = vtkXMLImageDataReader()
        reader.SetFileName(path)
        with testing.CapturedMessages():
            reader.Update()
        if reader.GetOutput().GetNumberOfPoints() == 0:
            self.skipTest(f"this ParaView takes {path} for damaged: see output_files.py")
        return opened(path) + [filter_of_the_menu("VolumeToSurface"), gui.pause(500)]

    def runs(self):
        found = re.findall(r"Run: level (\S+) ; ([a-z ]+) ; (\d+)", self.session.output)
        return [(level, reason, int(triangles)) for level, reason, triangles in found]

    def first_minutes(self, name, iso_value, preview_levels):
        """Preview at Otsu's threshold, at the iso-value, then the surface; and its chart."""
        picture = name.split("_")[0]
        self.play(self.volume(name) + [
            set_box("Preview", True), APPLY, gui.pause(1500),
            set_iso_value(iso_value), APPLY, gui.pause(1500), *FROM_THE_FRONT],
            f"real-{picture}-preview", python=TELL_THE_RUNS, timeout=600)
        self.assertNotIn("WARN|", self.session.output)
        self.assertEqual([run[0] for run in self.runs()], [str(level) for level in preview_levels])
        seen = self.runs()[-1]
        self.session.close_window()

        self.play(self.volume(name) + [
            set_box("Preview", True), set_iso_value(iso_value), APPLY, gui.pause(1000),
            set_box("Preview", False), APPLY, gui.pause(1500), *FROM_THE_FRONT, *eye_of(0, 0, 2)],
            f"real-{picture}", python=TELL_THE_RUNS, timeout=600)
        runs = self.runs()
        self.assertEqual(runs[0], seen)
        self.assertEqual([run[:2] for run in runs], [seen[:2], ("0", runs[1][1])])
        self.assertIn(runs[1][1], ("converged", "limit cycle"))
        self.assertGreater(runs[1][2], 2 * seen[2])
        self.assertNotIn("WARN|", self.session.output)

    def test_tooth(self):
        self.first_minutes("tooth_ct_u16.vti", 600.5, (1, 1))

    def test_engine(self):
        self.first_minutes("engine_ct_u8.vti", 75.5, (2, 2))

    def test_head(self):
        self.first_minutes("vismale_head_ct_u8.vti", 95.5, (2, 2))

    def test_vessels_of_which_a_few_per_cent_stay_lost(self):
        # At level 2 more than 5 % of what there is at 100.5 are missing: Preview goes on.
        self.first_minutes("aneurism_u8.vti", 100.5, (2, 1))

    def test_an_error_then_a_good_run(self):
        self.session.play(self.volume("tooth_ct_u16.vti") + [
            set_box("Preview", True), set_iso_value(5000), APPLY, gui.pause(1000),
            set_iso_value(300), APPLY, gui.pause(1500), *FROM_THE_FRONT], python=TELL_THE_RUNS)
        self.session.screenshot(testing.output_path("real-tooth-error.png"))
        self.assertIn("Iso Value is 5000, outside the range of the voxels, 0 to 1300",
                      self.session.output)
        self.assertEqual([run[:2] for run in self.runs()],
                         [("none", "error"), ("1", "converged")], self.session.output)


window.main()
