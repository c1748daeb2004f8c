# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The abort button in the status bar of ParaView's window stops a run, and so does quitting. The window
rejects all other input, with a small overhead.

By real mouse and keys, because a window that plays events ignores them during a run. Positions are found
in pictures of the window.
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

# Runs in the window: reports each run of a filter, and the content of the view when the window is idle.
# While the file HOLD exists, a run only reports progress once it has begun to iterate, so that the test
# does not depend on the speed of the machine.
REPORT_RUNS = window.WATCH_FILTERS + f"""
import os
import time
from paraview import simple
from vtkmodules.vtkFiltersCore import vtkFeatureEdges

view = simple.GetActiveViewOrCreate("RenderView")
simple.Show(simple.Wavelet(WholeExtent={EXTENT}))
simple.ResetCamera()
shown = []

def attend(proxy, algorithm):
    reported = set()
    def progress(caller, event):
        if ", iteration" in (caller.GetProgressText() or "") and not reported:
            reported.add(1)
            print("Iterations have begun.")
            while os.path.exists(HOLD):
                time.sleep(0.02)
                caller.UpdateProgress(caller.GetProgress())
                if caller.GetAbortExecute() and 2 not in reported:
                    reported.add(2)
                    print("Stop is requested.")
    def end(caller, event):
        reported.clear()
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

def report_view(*_):
    if view.SMProxy.GetSession().GetPendingProgress():
        return
    now = [display.GetRepresentedDataInformation().GetNumberOfPoints()
           for display in view.Representations
           if display.GetXMLName() == "VolumicSurfaceRepresentation"]
    if now and now != shown:
        shown[:] = now
        print("View:", (len(simple.GetSources()), *now))

view.GetInteractor().AddObserver("TimerEvent", report_view)
view.GetInteractor().CreateRepeatingTimer(100)
print("Window is ready.")
"""

# Runs in the window: reports the processor time of previews that are no source of the pipeline, and of
# the same previews that are.
MEASURE = """
import os
from paraview import servermanager
from paraview import simple

volume = simple.Wavelet(WholeExtent=[-60, 60] * 3)
simple.Show(volume)
simple.Render()
handler = servermanager.ActiveConnection.Session.GetProgressHandler()
seen = simple.VolumetoSurface(volume, Preview=1)
unseen = servermanager.filters.VolumetoSurface(Input=volume, Preview=1)
used = [], []
for run in range(6):
    for proxy, interval, times in ((unseen, 30, used[1]), (seen, 0.1, used[0])):
        handler.SetProgressInterval(interval)
        proxy.IsoValue = 150 + run
        begin = sum(os.times()[:2])
        proxy.UpdatePipeline()
        times.append(sum(os.times()[:2]) - begin)
print("Used:", used)
"""


class Hand(x_input.Input):
    """Quicker than a user."""

    def press(self, position, times=1):
        self._xtst.XTestFakeMotionEvent(self._display, -1, *position, ctypes.c_ulong(0))
        for down in (1, 0) * times:
            self._x11.XSync(self._display, 0)
            time.sleep(0.03)
            self._xtst.XTestFakeButtonEvent(self._display, 1, down, ctypes.c_ulong(0))
        self._x11.XSync(self._display, 0)


def abort_button(pixels):
    """Return the position of the enabled red cross at the lower edge of the window, or None."""
    red, green, blue = window.colours(pixels, numpy.s_[-40:])
    position = window.middle_of((red > 150) & (green < 60) & (blue < 60), 20)
    return position and (position[0], position[1] + pixels.shape[0] - 40)


@unittest.skipUnless(x_input.Input.is_there(), "libXtst was not found")
class AbortWindowTest(window.WindowTestCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.hold = testing.output_path("hold")
        testing.load_plugin()
        surface = testing.fetch(simple.VolumetoSurface(simple.Wavelet(WholeExtent=EXTENT)))
        # Stop reason, points, triangles and bad edges without a stop.
        cls.whole = (testing.field(surface, "StopReason"), surface.GetNumberOfPoints(),
                     surface.GetNumberOfPolys(), 0)

    def picture(self, name):
        return self.session.screenshot(testing.output_path(f"abort-{name}.png"))

    def wait_for(self, find, name):
        """Wait for a position that `find` finds in the window, and return it."""
        end = time.monotonic() + gui.PATIENCE
        while not (position := find(self.picture(name))):
            if time.monotonic() > end:
                self.fail(f"There is no {find.__name__}; see abort-{name}.png")
            time.sleep(0.1)
        return position

    def line_with(self, start):
        """Wait for the next line with that start, and return its rest."""
        end = time.monotonic() + gui.PATIENCE
        while not (found := re.search(f"{start}(.*)\n", self.printed)):
            if time.monotonic() > end:
                self.fail(f"The window did not print {start!r}, but:\n{self.printed}")
            self.printed += self.session.wait_for("\n", 1)
        self.printed = self.printed[found.end():]
        return found[1]

    def values(self, start):
        return ast.literal_eval(self.line_with(start))

    @contextlib.contextmanager
    def run_held(self):
        """Hold the next run at its first iteration until the context ends."""
        os.close(os.open(self.hold, os.O_CREAT))
        try:
            yield
        finally:
            os.remove(self.hold)

    def make_filter(self):
        """Make a filter by the quick launch, which needs no position. Return the position of Apply."""
        self.printed = ""
        self.session.start(REPORT_RUNS.replace("HOLD", repr(self.hold)))
        self.line_with("Window is ready")
        self.hand = Hand(self.session.display)
        self.hand.move(700, 500)
        self.hand.focus()
        before = self.session.pixels()
        self.hand.key("Control_L", "space")
        self.session.wait_for_rest(before)
        for letter in "to surface volume":  # a busy machine may lose the first letters
            self.hand.key({" ": "space"}.get(letter, letter))
        self.session.wait_for_rest()
        self.hand.key("Return")
        self.wait_for(window.apply_button, "made")
        self.session.wait_for_rest(least=2)
        return self.wait_for(window.apply_button, "made")

    def test_stop_shows_current_surface(self):
        apply = self.make_filter()
        with self.run_held():
            self.hand.press(apply)
            self.line_with("Iterations have begun")
            self.hand.press(cross := self.wait_for(abort_button, "during"))
            self.line_with("Stop is requested")
        reason, points, _, bad_edges = self.values("Run ended: ")
        self.assertEqual((reason, bad_edges), ("cancelled", 0))
        self.assertTrue(100 < points < self.whole[1])
        self.assertEqual(self.values("View: "), (2, points))
        self.assertIsNone(abort_button(self.picture("after")), "disabled again")
        near = tuple(slice(c - 12, c + 12) for c in cross[::-1])
        cursor = self.session.pixels()[near]
        for position in apply, cross:
            self.hand.move(*position)
        self.assertTrue((self.session.pixels()[near] == cursor).all(), "the cursor is not busy")
        self.session.wait_for_rest()
        with self.run_held():
            self.hand.press(self.wait_for(window.apply_button, "after"))
            self.line_with("Iterations have begun")
            self.hand.key("Control_L", "q")
            self.line_with("Stop is requested")
        self.assertTrue(self.session.has_quit(), "The window closes after the run")

    def test_other_input_is_rejected(self):
        x, y = self.make_filter()
        before = self.picture("before")
        with self.run_held():
            self.hand.press((x, y))
            self.line_with("Iterations have begun")
            # Apply, Reset, Delete and Help; File.
            for position in [(x + 82 * n, y) for n in range(4)] + [(20, 8)]:
                self.hand.press(position)
            position = self.wait_for(abort_button, "others")
            self.hand.press((position[0] + 60, position[1]))
            self.hand.press((x, y), times=2)
            self.hand.key("Control_L", "o")
            time.sleep(1)  # presses without an effect are not reported
            self.printed += self.session.wait_for("\n", 0.1)
            self.assertNotIn("Run ended", self.printed, "all this was during the run")
            edge = numpy.s_[-20:, :250]
            self.assertTrue((self.picture("message")[edge] != before[edge]).any(),
                            "the status bar says that a filter is running")
        self.assertEqual(self.values("Run ended: "), self.whole)
        self.assertEqual(self.values("View: "), (2, self.whole[1]))
        self.session.wait_for_rest()
        pixels = self.picture("untouched")
        self.assertIsNone(window.apply_button(pixels), "nothing is to be applied")
        for part in (numpy.s_[:20, :400], numpy.s_[25:50, 10:100]):  # menus; first icons
            self.assertTrue((pixels[part] == before[part]).all(), "neither menu nor dialog")

    def test_overhead_of_progress(self):
        self.printed = ""
        self.session.start(MEASURE)
        # The first runs prepare the window and the filter.
        seen, unseen = (sum(times[1:]) for times in self.values("Used: "))
        self.assertLess(seen, 1.3 * unseen)
