# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Examples/ParaView/compare_levels.py, as a macro runs in ParaView's window."""

import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import gui_session as gui
import plugin_testing as testing
import window_testing as window

MACRO = os.path.join(os.path.dirname(os.path.abspath(__file__)),
                     "../../Examples/ParaView/compare_levels.py")
APPLIED_AND_MACRO = """
from paraview import simple
wavelet = simple.Wavelet()
simple.Show(wavelet)
surface = simple.VolumetoSurface(wavelet)
simple.Show(surface)
simple.SetActiveSource(surface)
exec(compile(open({path!r}).read(), "macro", "exec"), {{"__name__": "__main__"}})
"""


class CompareLevelsTest(window.WindowTestCase):
    def test_a_view_per_level(self):
        path, save = self.saved_state("levels.pvsm")
        self.play([gui.pause(1000), *save, gui.pause(1000)], "levels-side-by-side",
                  python=APPLIED_AND_MACRO.format(path=os.path.abspath(MACRO)))
        self.assertNotIn("Traceback", self.session.output)
        state = window.proxies_of(path)
        # The two levels, each in a view with its name, beside the view that was there.
        self.assertEqual(state.count("RenderView"), 3)
        self.assertEqual(state.count("VolumicSurfaceRepresentation"), 3)
        self.assertEqual(state.count("TextSource"), 2)
        with open(path, encoding="utf-8") as file:
            text = file.read()
        for level in range(2):
            self.assertIn(f"/Root/Level{level}", text)
        self.assertIn("CameraLink", text)


window.main()
