# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""States saved by the window in scripts; and the macro Examples/ParaView/compare_levels.py."""

import os
import re
import subprocess
import xml.etree.ElementTree as ElementTree

from paraview import simple
from paraview import smtrace

import gui_session as gui
import plugin_testing as testing
import window_testing as window

# Documentation/paraview.md: the line to add below the import.
IMPORT = "from paraview.simple import *"
LOAD = f"LoadPlugin({testing.plugin_path()!r}, ns=globals())"
REPORT = """
filter_ = FindSource("Saved")
filter_.UpdatePipeline()
print("Points:", filter_.GetDataInformation().GetNumberOfPoints(),
      "views:", sorted(view.GetXMLName() for view in GetViews()),
      "colour:", GetRepresentation(filter_, GetViews()[0]).ColorArrayName[1])
"""

# Runs in the window. File > Save State also calls get_state().
SAVE_FROM_THE_WINDOW = """
from paraview import simple, smstate
source = simple.Wavelet(registrationName="Volume")
source.UpdatePipeline()
filter_ = simple.VolumetoSurface(source, registrationName="Saved", IsoValue=140.0)
view = simple.GetActiveViewOrCreate("RenderView")
display = simple.Show(filter_, view)
simple.ColorBy(display, ("POINTS", "Residual"), separate=True)
simple.Render(view)
with open({path!r}, "w") as file:
    file.write(smstate.get_state())
print("Saved with points:", filter_.GetDataInformation().GetNumberOfPoints())
"""

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


class StatesOfTheWindowTest(window.WindowTestCase):
    def test_python_state_in_pvpython_and_pvbatch(self):
        path = testing.output_path("from-the-window.py")
        self.play([gui.pause(300)], "states-saved",
                  python=SAVE_FROM_THE_WINDOW.format(path=path))
        points = re.search(r"Saved with points: (\d+)", self.session.output).group(1)
        with open(path, encoding="utf-8") as file:
            state = file.read()
        self.assertEqual(state.count(IMPORT), 1)
        loaded = testing.output_path("from-the-window-loaded.py")
        with open(loaded, "w", encoding="utf-8") as file:
            file.write(state.replace(IMPORT, f"{IMPORT}\n{LOAD}") + REPORT)
        for program in (["pvpython"], ["pvbatch", "--force-offscreen-rendering"]):
            run = subprocess.run([testing.program(program[0]), *program[1:], loaded],
                                 stdin=subprocess.DEVNULL, capture_output=True, text=True,
                                 timeout=gui.PATIENCE, check=False)
            self.assertEqual(run.returncode, 0, run.stderr)
            self.assertIn(f"Points: {points} views: ['RenderView'] "
                          "colour: Residual", run.stdout)
            self.assertNotIn("ERR|", run.stderr)


class TraceTest(testing.PluginTestCase):
    def test_trace(self):
        source = simple.Wavelet(registrationName="Traced volume")
        source.UpdatePipeline()
        smtrace.start_trace()
        filter_ = simple.VolumetoSurface(source, registrationName="Traced")
        view = simple.CreateView("RenderView")
        simple.AssignViewToLayout(view)
        simple.Show(filter_, view)
        text = smtrace.stop_trace()
        self.tearDown()
        simple.Wavelet(registrationName="Traced volume")
        exec(compile(text, "trace", "exec"), {})
        self.assertEqual([view.GetXMLName() for view in simple.GetViews()], ["RenderView"], text)
        self.assertGreater(testing.fetch(simple.FindSource("Traced")).GetNumberOfPoints(), 0)


class CompareLevelsTest(window.WindowTestCase):
    def test_a_view_per_level(self):
        path, save = self.saved_state("levels.pvsm")
        self.play([gui.pause(300), *save], "levels-side-by-side",
                  python=APPLIED_AND_MACRO.format(path=os.path.abspath(MACRO)))
        self.assertNotIn("Traceback", self.session.output)
        state = window.proxies_of(path)
        # A view with the name of each level, in addition to the first view.
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
