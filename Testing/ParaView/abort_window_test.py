# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The abort button in the status bar of ParaView's window stops a run, and nothing else gets through.

By real mouse and keys: while ParaView plays events, it takes none during a run. Where things are is
seen in pictures of the window.
"""

import contextlib
import ctypes
import os
import re
import subprocess
import time
import unittest

import numpy

import gui_session as gui
import plugin_testing as testing
import x_input
from paraview import simple

EXTENT = [-60, 60] * 3  # Preview is of another level.
FOLDER = "FOLDER"

# Runs in the window: shows a volume, tells of each run of a filter, and answers what a file asks,
# as soon as nothing else is done. A run that has begun to iterate does nothing but report while
# there is a file to hold it: the hand has its time, however fast or slow the machine is.
IN_THE_WINDOW = f"""
import os
import time
from paraview import servermanager, simple
from vtkmodules.vtkFiltersCore import vtkFeatureEdges

view = simple.GetActiveViewOrCreate("RenderView")
simple.Show(simple.Wavelet(WholeExtent={EXTENT}))
simple.ResetCamera()
filters = []


def tell(*words):
    # Not by print(): newer ParaViews keep what is said till there is much of it.
    os.write(1, (" ".join(map(str, words)) + "\\n").encode())


def facts(surface):
    reason = surface.GetFieldData().GetAbstractArray("StopReason")
    edges = vtkFeatureEdges()
    edges.SetInputData(surface)
    edges.FeatureEdgesOff()
    edges.Update()
    return (reason.GetValue(0) if reason else None, surface.GetNumberOfPoints(),
            surface.GetNumberOfPolys(), edges.GetOutput().GetNumberOfCells())


def watch(manager, event):
    for proxy in simple.GetSources().values():
        filter_ = proxy.GetClientSideObject()
        if filter_ and filter_.IsA("vtkDeformableSurface") and filter_ not in filters:
            filters.append(filter_)
            told = set()
            def progress(caller, event):
                if ", iteration" in (caller.GetProgressText() or "") and not told:
                    told.add(1)
                    tell("Iterations have begun.")
                    while os.path.exists(os.path.join({FOLDER!r}, "hold")):
                        time.sleep(0.02)
                        caller.UpdateProgress(caller.GetProgress())
                        if caller.GetAbortExecute() and 2 not in told:
                            told.add(2)
                            tell("It is asked to stop.")
            def end(caller, event):
                told.clear()
                tell("Run ended:", facts(caller.GetOutputDataObject(0)))
            filter_.AddObserver("ProgressEvent", progress)
            filter_.AddObserver("EndEvent", end)


def points_in_view():
    return [shown.GetRepresentedDataInformation().GetNumberOfPoints()
            for shown in view.Representations
            if shown.GetXMLName() == "VolumicSurfaceRepresentation"]


def answer(*_):
    path = os.path.join({FOLDER!r}, "ask.py")
    if os.path.exists(path) and not view.SMProxy.GetSession().GetPendingProgress():
        with open(path, encoding="utf-8") as file:
            code = file.read()
        os.remove(path)
        try:
            found = eval(code)
        except Exception as error:  # It would only be shown in the window.
            found = repr(error)
        tell("Answer:", repr(found))

servermanager.ProxyManager().SMProxyManager.AddObserver("RegisterEvent", watch)
interactor = view.GetInteractor()
interactor.AddObserver("TimerEvent", answer)
interactor.CreateRepeatingTimer(100)
tell("Window is ready.")
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

    def shortcut(self, name):
        """With the control key."""
        control = self._x11.XKeysymToKeycode(
            self._display, ctypes.c_ulong(self._x11.XStringToKeysym(b"Control_L")))
        self._xtst.XTestFakeKeyEvent(self._display, control, 1, ctypes.c_ulong(0))
        self.key(name)
        self._xtst.XTestFakeKeyEvent(self._display, control, 0, ctypes.c_ulong(0))
        self._flush()


class LiveSession(gui.Session):
    """A window in which no events are played."""

    def start(self, python):
        folder = self._folder.name
        # A module, since ParaView empties the names of a script at its end.
        with open(os.path.join(folder, "in_the_window.py"), "w", encoding="utf-8") as file:
            file.write(python.replace(FOLDER, folder))
        script = os.path.join(folder, "start.py")
        with open(script, "w", encoding="utf-8") as file:
            file.write(f"import sys\nsys.path.insert(0, {folder!r})\nimport in_the_window\n")
        self._window = subprocess.Popen(
            [self._paraview, "--dr", f"--plugin-search-paths={os.path.dirname(self._plugin)}",
             "--plugins=Volumic", f"--script={script}"],
            env=self._environment, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT, preexec_fn=testing.end_with_parent)
        self.output = ""
        self.line_with("Window is ready")

    def line_with(self, start, timeout=gui.PATIENCE):
        """What the window says after that, to the end of the line: from now on, or lately."""
        end = time.monotonic() + timeout
        while not (found := re.search(f"{start}(.*)\n", self.output)):
            if time.monotonic() > end:
                raise AssertionError(f"The window did not say {start!r}, but:\n{self.output}")
            self.output += self.wait_for("\n", 1)
        self.output = self.output[found.end():]
        return found[1]

    @contextlib.contextmanager
    def run_held(self):
        """The next run stays where its iterations begin till the context is left."""
        path = os.path.join(self._folder.name, "hold")
        with open(path, "w", encoding="utf-8"):
            pass
        try:
            yield
        finally:
            os.remove(path)

    def next_run(self):
        """StopReason, points, triangles and edges that are no good of a run, at its end."""
        return eval(self.line_with("Run ended: "))

    def ask(self, code):
        """The value of an expression in the window, when it is at rest."""
        path = os.path.join(self._folder.name, "ask.py")
        with open(path + ".part", "w", encoding="utf-8") as file:
            file.write(code)
        os.rename(path + ".part", path)
        return eval(self.line_with("Answer: "))


def middle_of(mask, least):
    """Of the pixels that are set: (x, y), or None where there are less than that."""
    rows, columns = mask.nonzero()
    return (int(numpy.median(columns)), int(numpy.median(rows))) if len(rows) >= least else None


def colours(pixels, part):
    return (pixels[part][..., colour].astype(int) for colour in range(3))


def abort_button(pixels):
    """Its red cross, lit up, at the window's lower edge."""
    red, green, blue = colours(pixels, numpy.s_[-40:])
    place = middle_of((red > 150) & (green < 60) & (blue < 60), 20)
    return place and (place[0], place[1] + pixels.shape[0] - 40)


def apply_button(pixels):
    """Lit up: greener than all else in the left third."""
    red, green, blue = colours(pixels, numpy.s_[200:-60, : pixels.shape[1] // 3])
    place = middle_of((green > 120) & (green > red + 20) & (green > blue + 20), 500)
    return place and (place[0], place[1] + 200)


def whole_run():
    """StopReason, points, triangles and bad edges without a stop on the way."""
    testing.load_plugin()
    surface = testing.fetch(simple.VolumetoSurface(simple.Wavelet(WholeExtent=EXTENT)))
    return (testing.field(surface, "StopReason"), surface.GetNumberOfPoints(),
            surface.GetNumberOfPolys(), 0)


@unittest.skipUnless(x_input.Input.is_there(), "libXtst was not found")
class AbortWindowTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.session = LiveSession(testing.program("paraview"), testing.plugin_path(),
                                  os.environ["VOLUMIC_XVFB"], plain=True)
        cls.hand = Hand(cls.session.display)
        cls.whole = whole_run()

    @classmethod
    def tearDownClass(cls):
        cls.session.close()

    def tearDown(self):
        self.session.close_window()

    def picture(self, name):
        return self.session.screenshot(testing.output_path(f"abort-{name}.png"))

    def wait_for(self, find, name, timeout=gui.PATIENCE):
        """The place that `find` finds in the window."""
        end = time.monotonic() + timeout
        while not (place := find(self.picture(name))):
            if time.monotonic() > end:
                self.fail(f"There is no {find.__name__}; see abort-{name}.png")
            time.sleep(0.1)
        return place

    def make_filter(self):
        """By the quick launch, for which no place need be known. Returns where Apply is."""
        self.session.start(IN_THE_WINDOW)
        self.hand.move(700, 500)
        self.hand.focus()
        before = self.session.pixels()
        self.hand.shortcut("space")
        self.session.wait_for_rest(before)
        for letter in "volume to surface":
            self.hand.key({" ": "space"}.get(letter, letter))
        self.session.wait_for_rest()
        self.hand.key("Return")
        self.wait_for(apply_button, "made")
        self.session.wait_for_rest(least=2)
        return self.wait_for(apply_button, "made")

    def test_stops_a_run_and_shows_the_surface_as_it_is(self):
        apply = self.make_filter()
        with self.session.run_held():
            self.hand.press(apply)
            self.session.line_with("Iterations have begun")
            self.hand.press(self.wait_for(abort_button, "during"))
            self.session.line_with("It is asked to stop")
        reason, points, _, bad_edges = self.session.next_run()
        self.assertEqual((reason, bad_edges), ("cancelled", 0))
        self.assertGreater(points, 100)
        self.assertLess(points, self.whole[1])
        self.assertEqual(self.session.ask("points_in_view()"), [points])
        self.assertIsNone(abort_button(self.picture("after")), "grey again")

    def test_nothing_else_gets_through(self):
        x, y = self.make_filter()
        before = self.picture("before")
        with self.session.run_held():
            self.hand.press((x, y))
            self.session.line_with("Iterations have begun")
            # Apply, Reset, Delete and Help; File.
            others = [(x + 82 * n, y) for n in range(4)] + [(20, 8)]
            for place in others:
                self.hand.press(place)
            place = self.wait_for(abort_button, "others")
            self.hand.press((place[0] + 60, place[1]))
            self.hand.press((x, y), times=2)
            self.hand.shortcut("o")
            time.sleep(1)  # Nothing tells of presses that have no effect.
            self.session.output += self.session.wait_for("\n", 0.1)
            self.assertNotIn("Run ended", self.session.output, "all this was during the run")
        self.assertEqual(self.session.next_run(), self.whole)
        self.assertEqual(self.session.ask("(len(simple.GetSources()), points_in_view())"),
                         (2, [self.whole[1]]))
        self.session.wait_for_rest()
        pixels = self.picture("untouched")
        self.assertIsNone(apply_button(pixels), "nothing is to be applied")
        for part in (numpy.s_[:20, :400], numpy.s_[25:50, 10:100]):  # menus; first icons
            self.assertTrue((pixels[part] == before[part]).all(), "neither menu nor dialog")
