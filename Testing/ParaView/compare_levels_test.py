# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Examples/ParaView/compare_levels.py, as a macro runs in ParaView's window."""

import os
import xml.etree.ElementTree as ElementTree

import gui_session as gui
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
        self.play([gui.pause(300), *save], "levels-side-by-side",
                  python=APPLIED_AND_MACRO.format(path=os.path.abspath(MACRO)))
        self.assertNotIn("Traceback", self.session.output)
        state = window.proxies_of(path)
        # The two levels, each in a view with its name, beside the view that was there.
        self.assertEqual(state.count("RenderView"), 3)
        self.assertEqual(state.count("VolumicSurfaceRepresentation"), 1)
        self.assertEqual(state.count("VolumicLevelsRepresentation"), 2)
        self.assertEqual(state.count("TextSource"), 2)
        elements = ElementTree.parse(path).iter()
        chosen = {element.get("value") for property_ in elements
                  if property_.get("name") == "BlockSelectors"
                  for element in property_.iter("Element")}
        for level in range(2):
            self.assertIn(f"/Root/*[@label='Level {level}']", chosen)
        links = {element.get("name") for element in ElementTree.parse(path).iter("CameraLink")}
        self.assertEqual(len(links), 1)
