# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The abort button in the status bar of ParaView's window stops a run, and so does quitting. The window
rejects all other input, and takes little of the time.

By real mouse and keys: a window that plays events takes none during a run. Where things are is seen in
pictures of the window.
"""

import ast
import contextlib
import ctypes
import os
import re
import time
import unittest

import numpy

import gui_session as gui
import plugin_testing as testing
import window_testing as window
import x_input
from paraview import simple

EXTENT = [-30, 30] * 3

# Runs in the window: tells of each run of a filter, and what the view shows when nothing else is
# done. A run that has begun to iterate does nothing but report while there is the file HOLD: the hand
# has its time, however fast or slow the machine is.
TELL_OF_RUNS = window.WATCH_FILTERS + f"""
import os
import time
from paraview import simple
from vtkmodules.vtkFiltersCore import vtkFeatureEdges

view = simple.GetActiveViewOrCreate("RenderView")
simple.Show(simple.Wavelet(WholeExtent={EXTENT}))
simple.ResetCamera()
shown = []

def attend(proxy, algorithm):
    told = set()
    def progress(caller, event):
        if ", iteration" in (caller.GetProgressText() or "") and not told:
            told.add(1)
            print("Iterations have begun.")
            while os.path.exists(HOLD):
                time.sleep(0.02)
                caller.UpdateProgress(caller.GetProgress())
                if caller.GetAbortExecute() and 2 not in told:
                    told.add(2)
                    print("It is asked to stop.")
    def end(caller, event):
        told.clear()
        caller.SetProgressText("")
        surface = caller.GetOutputDataObject(0)
        reason = surface.GetFieldData().GetAbstractArray("StopReason")
        edges = vtkFeatureEdges()
        edges.SetInputData(surface)
        edges.FeatureEdgesOff()
        edges.Update()
        print("Run ended:", (reason.GetValue(0) if reason else None, surface.GetNumberOfPoints(),
                             surface.GetNumberOfPolys(), edges.GetOutput().GetNumberOfCells()))
    algorithm.AddObserver("ProgressEvent", progress)
    algorithm.AddObserver("EndEvent", end)

def tell_of_the_view(*_):
    if view.SMProxy.GetSession().GetPendingProgress():
        return
    now = [display.GetRepresentedDataInformation().GetNumberOfPoints()
           for display in view.Representations
           if display.GetXMLName() == "VolumicSurfaceRepresentation"]
    if now and now != shown:
        shown[:] = now
        print("View:", (len(simple.GetSources()), *now))

view.GetInteractor().AddObserver("TimerEvent", tell_of_the_view)
view.GetInteractor().CreateRepeatingTimer(100)
print("Window is ready.")
"""


# Runs in the window: reports the processor time of previews that the window does not notice, and of
# the same ones that it shows.
MEASURE = """
import os
from paraview import servermanager
from paraview import simple

volume = simple.Wavelet(WholeExtent=[-60, 60] * 3)
simple.Show(volume)
simple.Render()
handler = servermanager.ActiveConnection.Session.GetProgressHandler()
seen = simple.VolumetoSurface(volume, Preview=1)
unseen = servermanager.filters.VolumetoSurface(Input=volume, Preview=1)  # no source of the pipeline
used = {}

def attend(proxy):
    begin = []
    def start(*_):
        begin[:] = os.times()[:2]
    def end(*_):
        used.setdefault(proxy, []).append(sum(os.times()[:2]) - sum(begin))
    proxy.GetClientSideObject().AddObserver("StartEvent", start)
    proxy.GetClientSideObject().AddObserver("EndEvent", end)

for proxy in (seen, unseen):
    attend(proxy)
for run in range(6):
    for proxy, interval in ((unseen, 30), (seen, 0.1)):
        handler.SetProgressInterval(interval)
        proxy.IsoValue = 150 + run
        proxy.UpdatePipeline()
print("Used:", [used[proxy] for proxy in (seen, unseen)])
"""


class Hand(x_input.Input):
    """Quicker than a user."""

    def press(self, place, times=1):
        self._xtst.XTestFakeMotionEvent(self._display, -1, *place, ctypes.c_ulong(0))
        for down in (1, 0) * times:
            self._x11.XSync(self._display, 0)
            time.sleep(0.03)
            self._xtst.XTestFakeButtonEvent(self._display, 1, down, ctypes.c_ulong(0))
        self._x11.XSync(self._display, 0)


def abort_button(pixels):
    """Its red cross, lit up, at the window's lower edge."""
    red, green, blue = window.colours(pixels, numpy.s_[-40:])
    place = window.middle_of((red > 150) & (green < 60) & (blue < 60), 20)
    return place and (place[0], place[1] + pixels.shape[0] - 40)


@unittest.skipUnless(x_input.Input.is_there(), "libXtst was not found")
class AbortWindowTest(window.WindowTestCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.hold = testing.output_path("hold")
        testing.load_plugin()
        surface = testing.fetch(simple.VolumetoSurface(simple.Wavelet(WholeExtent=EXTENT)))
        # Stop reason, points, triangles and bad edges without a stop on the way.
        cls.whole = (testing.field(surface, "StopReason"), surface.GetNumberOfPoints(),
                     surface.GetNumberOfPolys(), 0)

    def picture(self, name):
        return self.session.screenshot(testing.output_path(f"abort-{name}.png"))

    def wait_for(self, find, name):
        """The place that `find` finds in the window."""
        end = time.monotonic() + gui.PATIENCE
        while not (place := find(self.picture(name))):
            if time.monotonic() > end:
                self.fail(f"There is no {find.__name__}; see abort-{name}.png")
            time.sleep(0.1)
        return place

    def line_with(self, start):
        """What the window says after that, to the end of the line: from now on, or lately."""
        end = time.monotonic() + gui.PATIENCE
        while not (found := re.search(f"{start}(.*)\n", self.said)):
            if time.monotonic() > end:
                self.fail(f"The window did not say {start!r}, but:\n{self.said}")
            self.said += self.session.wait_for("\n", 1)
        self.said = self.said[found.end():]
        return found[1]

    def facts(self, start):
        return ast.literal_eval(self.line_with(start))

    @contextlib.contextmanager
    def run_held(self):
        """The next run stays where its iterations begin till the context is left."""
        with open(self.hold, "w", encoding="utf-8"):
            pass
        try:
            yield
        finally:
            os.remove(self.hold)

    def make_filter(self):
        """By the quick launch, for which no place need be known. Returns where Apply is."""
        self.said = ""
        self.session.start(TELL_OF_RUNS.replace("HOLD", repr(self.hold)))
        self.line_with("Window is ready")
        self.hand = Hand(self.session.display)
        self.hand.move(700, 500)
        self.hand.focus()
        before = self.session.pixels()
        self.hand.key("Control_L", "space")
        self.session.wait_for_rest(before)
        for letter in "volume to surface":
            self.hand.key({" ": "space"}.get(letter, letter))
        self.session.wait_for_rest()
        self.hand.key("Return")
        self.wait_for(window.apply_button, "made")
        self.session.wait_for_rest(least=2)
        return self.wait_for(window.apply_button, "made")

    def test_stops_a_run_and_shows_the_surface_as_it_is(self):
        apply = self.make_filter()
        with self.run_held():
            self.hand.press(apply)
            self.line_with("Iterations have begun")
            self.hand.press(self.wait_for(abort_button, "during"))
            self.line_with("It is asked to stop")
        reason, points, _, bad_edges = self.facts("Run ended: ")
        self.assertEqual((reason, bad_edges), ("cancelled", 0))
        self.assertTrue(100 < points < self.whole[1])
        self.assertEqual(self.facts("View: "), (2, points))
        self.assertIsNone(abort_button(self.picture("after")), "grey again")
        self.session.wait_for_rest()
        with self.run_held():
            self.hand.press(self.wait_for(window.apply_button, "after"))
            self.line_with("Iterations have begun")
            self.hand.key("Control_L", "q")
            self.line_with("It is asked to stop")
        self.assertTrue(self.session.has_quit(), "The window closes after the run")

    def test_nothing_else_gets_through(self):
        x, y = self.make_filter()
        before = self.picture("before")
        with self.run_held():
            self.hand.press((x, y))
            self.line_with("Iterations have begun")
            # Apply, Reset, Delete and Help; File.
            for place in [(x + 82 * n, y) for n in range(4)] + [(20, 8)]:
                self.hand.press(place)
            place = self.wait_for(abort_button, "others")
            self.hand.press((place[0] + 60, place[1]))
            self.hand.press((x, y), times=2)
            self.hand.key("Control_L", "o")
            time.sleep(1)  # Nothing tells of presses that have no effect.
            self.said += self.session.wait_for("\n", 0.1)
            self.assertNotIn("Run ended", self.said, "all this was during the run")
            edge = numpy.s_[-20:, :250]
            self.assertTrue((self.picture("message")[edge] != before[edge]).any(),
                            "the status bar says that a filter is running")
        self.assertEqual(self.facts("Run ended: "), self.whole)
        self.assertEqual(self.facts("View: "), (2, self.whole[1]))
        self.session.wait_for_rest()
        pixels = self.picture("untouched")
        self.assertIsNone(window.apply_button(pixels), "nothing is to be applied")
        for part in (numpy.s_[:20, :400], numpy.s_[25:50, 10:100]):  # menus; first icons
            self.assertTrue((pixels[part] == before[part]).all(), "neither menu nor dialog")

    def test_the_window_takes_little_of_the_time(self):
        self.said = ""
        self.session.start(MEASURE)
        # The first runs prepare the window and the filter.
        seen, unseen = (sum(times[1:]) for times in self.facts("Used: "))
        self.assertLess(seen, 1.3 * unseen)
