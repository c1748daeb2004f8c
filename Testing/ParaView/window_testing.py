# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Functions of the tests in ParaView's window: menus, the panel, and a test case that plays events.

Pictures of the window are saved in VOLUMIC_TEST_OUTPUT.
"""

import atexit
import functools
import os
import unittest
import xml.etree.ElementTree as ElementTree

import numpy

import gui_session as gui
import plugin_testing as testing
from paraview import servermanager
from paraview import simple

FILTERS = f"{gui.WINDOW}/menubar/menuFilters"
PROPERTIES = f"{gui.PANEL}/scrollArea/qt_scrollarea_viewport/scrollAreaWidgetContents/" \
             "PropertiesFrame/ProxyPanel"
APPLY = gui.event(f"{gui.PANEL}/Accept", "activate")
SHOW_ADVANCED = gui.event(f"{gui.PANEL}/SearchBox/AdvancedButton", "set_boolean", "true")
ISO_VALUE = f"{PROPERTIES}/IsoValue/DoubleRangeWidget/DoubleLineEdit"
# For pictures from the front of the volume.
FROM_THE_FRONT = [gui.event(f"{gui.WINDOW}/cameraToolbar/actionNegativeY", "activate"),
                  gui.pause(1500)]

# Runs in the window before a script that defines attend(proxy, algorithm), which is called for each new
# filter that finds a surface.
WATCH_FILTERS = """
from paraview import servermanager
watched = []

def watch(manager, event):
    from paraview import simple
    for proxy in simple.GetSources().values():
        algorithm = proxy.GetClientSideObject()
        if algorithm and algorithm.IsA("vtkDeformableSurface") and algorithm not in watched:
            watched.append(algorithm)
            attend(proxy, algorithm)

servermanager.ProxyManager().SMProxyManager.AddObserver("RegisterEvent", lasting(watch))
"""

# Runs in the window: File > Change File for the input of a filter.
CHANGE_FILE = """
from paraview import simple
filter_ = simple.FindSource({name!r})
simple.ReplaceReaderFileName(filter_.Input, [{path!r}], "FileName")
"""


def open_menu(name):
    """Return the event that opens a menu, which newer versions of ParaView fill then."""
    return gui.event(f"{gui.WINDOW}/menubar", "activate", name)


def open_menu_of_volumic():
    """Return the events that open Filters > Volumic by keys. It is the last category, since ParaView 5.12
    the last but one."""
    key_up, key_right = "6,16777235,0,,0,1", "6,16777236,0,,0,1"
    manager = servermanager.vtkSMProxyManager
    version = manager.GetVersionMajor(), manager.GetVersionMinor()
    return [open_menu("menuFilters"), gui.pause(1000),
            *[gui.event(FILTERS, "keyEvent", key_up)] * (1 if version < (5, 12) else 2),
            gui.pause(500), gui.event(FILTERS, "keyEvent", key_right)]


def source(name):
    """Return the events that make a source of the Sources menu and apply it."""
    return [open_menu("menuSources"),
            gui.event(f"{gui.WINDOW}/menubar/menuSources/Alphabetical", "activate", name), APPLY]


def opened(path, answer=()):
    """Return the events that open a file and apply its reader. answer: events for a dialog."""
    return [gui.event(f"{gui.WINDOW}/menubar/menu_File", "activate", "actionFileOpen"),
            gui.event(f"{gui.WINDOW}/FileOpenDialog", "filesSelected", path), gui.pause(500),
            *answer, APPLY, gui.pause(1000)]


def filter_of_the_menu(name, category="Volumic"):
    return "\n".join([open_menu("menuFilters"), gui.pause(500),
                      gui.event(f"{FILTERS}/{category}", "activate", name)])


def edit(action):
    """Return the event of undo or redo."""
    return gui.event(f"{gui.WINDOW}/menubar/menu_Edit", "activate", action)


def set_iso_value(value):
    return gui.event(ISO_VALUE, "set_string", str(value))


def choose(property_, choice):
    """Return the event that chooses an entry of a combo box."""
    return gui.event(f"{PROPERTIES}/{property_}/ComboBox", "set_string", choice)


def set_box(property_, on):
    return gui.event(f"{PROPERTIES}/{property_}/CheckBox", "set_boolean", "true" if on else "false")


def in_the_pipeline(*positions):
    """Return the event that selects an entry of the pipeline browser, by its index at each depth."""
    path = "".join(f"/{position}" for position in (0, *positions))
    return gui.event(f"{gui.WINDOW}/pipelineBrowserDock/pipelineBrowser", "currentChanged",
                     f"{path}|0")


def shown(property_, yes):
    """Return the event that fails unless the property is visible, or is not."""
    return gui.check(f"{PROPERTIES}/{property_}", "visible", "true" if yes else "false")


def value_range(low, high):
    """Return the event that fails unless this is the range below Iso Value."""
    return gui.check(f"{PROPERTIES}/IsoValue/ValueRange", "text",
                     f"<b>Value Range:</b> [{low:g}, {high:g}]")


def as_wide_as_the_panel():
    """Return the event that fails if the panel has a horizontal scroll bar."""
    return gui.check(f"{gui.PANEL}/scrollArea/qt_scrollarea_hcontainer", "visible", "false")


def range_of_the_wavelet(**properties):
    wavelet = simple.Wavelet(**properties)
    wavelet.UpdatePipeline()
    return wavelet.PointData["RTData"].GetRange()


def iso_of_the_wavelet():
    """Return the text of Iso Value for the source RTAnalyticSource."""
    testing.load_plugin()
    return repr(simple.VolumetoSurface(simple.Wavelet()).IsoValue)


def open_state(path, name):
    """Open a state in this process, and return the filter of that name."""
    testing.load_plugin()
    # Sources of an earlier state have the same names.
    for other in simple.GetSources().values():
        simple.Delete(other)
    simple.LoadState(path)
    return simple.FindSource(name)


def proxies_of(state):
    """Return the names of the proxies in a saved state."""
    return [proxy.get("type") for proxy in ElementTree.parse(state).iter("Proxy")]


def middle_of(mask, least):
    """Return the median (x, y) of the set pixels, or None if they are fewer than `least`."""
    rows, columns = mask.nonzero()
    return (int(numpy.median(columns)), int(numpy.median(rows))) if len(rows) >= least else None


def colours(pixels, part):
    return (pixels[part][..., colour].astype(int) for colour in range(3))


def apply_button(pixels):
    """Return the position of the enabled Apply button (green, in the left third), or None."""
    red, green, blue = colours(pixels, numpy.s_[200:-60, : pixels.shape[1] // 3])
    position = middle_of((green > 120) & (green > red + 20) & (green > blue + 20), 500)
    return position and (position[0], position[1] + 200)


@functools.cache
def the_session():
    """Return the session of all tests of the process."""
    session = gui.Session(testing.program("paraview"), testing.plugin_path(),
                          os.environ["VOLUMIC_XVFB"])
    atexit.register(session.close)
    return session


class WindowTestCase(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.session = the_session()

    def setUp(self):
        self.session.forget_codes()

    def play(self, events, picture, **options):
        """Play the events in the window, and save its picture.

        options: of Session.play
        """
        succeeded = self.session.play(events, **options)
        pixels = self.session.screenshot(testing.output_path(f"{picture}.png"))
        self.assertTrue(succeeded, self.session.output)
        # Warnings open a box over the window.
        for word in ("ERR|", "critical:", "warning:"):
            self.assertNotIn(word, self.session.output)
        return pixels

    def changes_of_file(self, filter_, files):
        """Return {name: events} for {name: path}: replace the file of the only filter, of this name, and
        apply both."""
        return {name: [
            # The test recorder does not support the menu of Change File.
            self.session.add_code(CHANGE_FILE.format(name=filter_, path=path)),
            gui.pause(500), in_the_pipeline(0), gui.pause(300), APPLY, in_the_pipeline(0, 0),
            gui.pause(500)] for name, path in files.items()}

    def until_printed(self, start, times):
        """Return the event that waits for that many printed lines with that start."""
        return self.session.add_code(f"until(lambda: count_lines({start!r}) >= {times})")

    def saved_state(self, name):
        """Return the path of a state, and the events that save it from the window."""
        path = testing.output_path(name)
        if os.path.exists(path):
            os.remove(path)
        return path, [
            gui.event(f"{gui.WINDOW}/menubar/menu_File", "activate", "actionFileSaveServerState"),
            gui.event(f"{gui.WINDOW}/FileSaveServerStateDialog", "filesSelected", path)]
