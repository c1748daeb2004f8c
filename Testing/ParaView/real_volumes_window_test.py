# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""A newcomer's first minutes in ParaView's window with real volumes: open, Preview, Apply, another
Iso Value, Preview off. No message may open over the view, unless a user must act."""

import os
import re

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
              caller.GetOutputDataObject(0).GetNumberOfPolys())
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
            set_box("Preview", True), APPLY, self.until_told("Run:", 1),
            set_iso_value(iso_value), APPLY, self.until_told("Run:", 2),
            set_box("Preview", False), APPLY, self.until_told("Run:", 3),
            *FROM_THE_FRONT, *eye_of(0, 0, 2)], f"real-{picture}", python=TELL_THE_RUNS)
        self.assertNotIn("WARN|", self.session.output)
        runs = self.runs()
        self.assertEqual([run[0] for run in runs], [*map(str, preview_levels), "0"])
        self.assertIn(runs[-1][1], ("converged", "limit cycle"))
        self.assertGreater(runs[-1][2], 2 * runs[-2][2])

    def test_tooth(self):
        self.first_minutes("tooth_ct_u16.vti", 600.5, (1, 1))

    def test_an_error_then_a_good_run(self):
        self.session.play(self.volume("tooth_ct_u16.vti") + [
            set_box("Preview", True), set_iso_value(5000), APPLY, self.until_told("Run:", 1),
            set_iso_value(300), APPLY, self.until_told("Run:", 2), *FROM_THE_FRONT],
            python=TELL_THE_RUNS)
        self.session.screenshot(testing.output_path("real-tooth-error.png"))
        self.assertIn("Iso Value is 5000, outside the range of the voxels, 0 to 1300",
                      self.session.output)
        self.assertEqual([run[:2] for run in self.runs()],
                         [("none", "error"), ("1", "converged")], self.session.output)
