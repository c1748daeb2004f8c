# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""What the tests in ParaView's window share: menus, the panel, and a case that plays and checks.

Pictures of the window at each stage go to VOLUMIC_TEST_OUTPUT, to be looked at.
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
# For a picture of what lies at the front of the volume.
FROM_THE_FRONT = [gui.event(f"{gui.WINDOW}/cameraToolbar/actionNegativeY", "activate"),
                  gui.pause(1500)]

# Runs in the window, before a script that defines attend(proxy, algorithm): that is called for each
# filter that finds a surface, once, as soon as it is made, whoever makes it.
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

# Runs in the window: what its File > Change File calls, for the input of a filter.
CHANGE_FILE = """
from paraview import simple
filter_ = simple.FindSource({name!r})
simple.ReplaceReaderFileName(filter_.Input, [{path!r}], "FileName")
"""


def open_menu(name):
    """Newer ParaViews fill a menu when it is opened."""
    return gui.event(f"{gui.WINDOW}/menubar", "activate", name)


def open_menu_of_volumic():
    """Events that open Filters > Volumic by keys, for a picture: it is the last of the categories,
    from ParaView 5.12 on the last but one."""
    key_up, key_right = "6,16777235,0,,0,1", "6,16777236,0,,0,1"
    manager = servermanager.vtkSMProxyManager
    version = manager.GetVersionMajor(), manager.GetVersionMinor()
    return [open_menu("menuFilters"), gui.pause(1000),
            *[gui.event(FILTERS, "keyEvent", key_up)] * (1 if version < (5, 12) else 2),
            gui.pause(500), gui.event(FILTERS, "keyEvent", key_right)]


def source(name):
    """Events that make a source of the Sources menu and apply it."""
    return [open_menu("menuSources"),
            gui.event(f"{gui.WINDOW}/menubar/menuSources/Alphabetical", "activate", name), APPLY]


def opened(path, answer=()):
    """Events that open a file and apply its reader; answer: those for a question on the way."""
    return [gui.event(f"{gui.WINDOW}/menubar/menu_File", "activate", "actionFileOpen"),
            gui.event(f"{gui.WINDOW}/FileOpenDialog", "filesSelected", path), gui.pause(500),
            *answer, APPLY, gui.pause(1000)]


def filter_of_the_menu(name, category="Volumic"):
    return "\n".join([open_menu("menuFilters"), gui.pause(500),
                      gui.event(f"{FILTERS}/{category}", "activate", name)])


def edit(action):
    """Undo or redo."""
    return gui.event(f"{gui.WINDOW}/menubar/menu_Edit", "activate", action)


def set_iso_value(value):
    return gui.event(ISO_VALUE, "set_string", str(value))


def choose(property_, choice):
    """Of those that the panel offers."""
    return gui.event(f"{PROPERTIES}/{property_}/ComboBox", "set_string", choice)


def set_box(property_, on):
    return gui.event(f"{PROPERTIES}/{property_}/CheckBox", "set_boolean", "true" if on else "false")


def in_the_pipeline(*places):
    """Select an entry of the pipeline browser: the place in the list of sources, of filters..."""
    path = "".join(f"/{place}" for place in (0, *places))
    return gui.event(f"{gui.WINDOW}/pipelineBrowserDock/pipelineBrowser", "currentChanged",
                     f"{path}|0")


def shown(property_, yes):
    """Fails the session unless the panel shows the property, or doesn't."""
    return gui.check(f"{PROPERTIES}/{property_}", "visible", "true" if yes else "false")


def value_range(low, high):
    """Fails the session unless this is the range below Iso Value."""
    return gui.check(f"{PROPERTIES}/IsoValue/ValueRange", "text",
                     f"<b>Value Range:</b> [{low:g}, {high:g}]")


def as_wide_as_the_panel():
    """Fails the session if the panel needs a scroll bar to show all of its width."""
    return gui.check(f"{gui.PANEL}/scrollArea/qt_scrollarea_hcontainer", "visible", "false")


def range_of_the_wavelet(**properties):
    wavelet = simple.Wavelet(**properties)
    wavelet.UpdatePipeline()
    return wavelet.PointData["RTData"].GetRange()


def iso_of_the_wavelet():
    """What the panel of Iso Value says for the source RTAnalyticSource."""
    testing.load_plugin()
    return repr(simple.VolumetoSurface(simple.Wavelet()).IsoValue)


def open_state(path, name):
    """The filter of that name in a saved state, which a script opens."""
    testing.load_plugin()
    # What an earlier state has left has the same names.
    for other in simple.GetSources().values():
        simple.Delete(other)
    simple.LoadState(path)
    return simple.FindSource(name)


def proxies_of(state):
    """Names of the proxies in a saved state."""
    return [proxy.get("type") for proxy in ElementTree.parse(state).iter("Proxy")]


def middle_of(mask, least):
    """Of the pixels that are set: (x, y), or None where there are less than that."""
    rows, columns = mask.nonzero()
    return (int(numpy.median(columns)), int(numpy.median(rows))) if len(rows) >= least else None


def colours(pixels, part):
    return (pixels[part][..., colour].astype(int) for colour in range(3))


def apply_button(pixels):
    """Lit up: greener than all else in the left third."""
    red, green, blue = colours(pixels, numpy.s_[200:-60, : pixels.shape[1] // 3])
    place = middle_of((green > 120) & (green > red + 20) & (green > blue + 20), 500)
    return place and (place[0], place[1] + 200)


@functools.cache
def the_session():
    """That of all tests of the process."""
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
        """Play the events in the window, and take its picture, also if an event failed.

        options: of Session.play
        """
        succeeded = self.session.play(events, **options)
        pixels = self.session.screenshot(testing.output_path(f"{picture}.png"))
        self.assertTrue(succeeded, self.session.output)
        # A warning opens a box over the window, and is none that the plugin's hints may cause.
        for word in ("ERR|", "critical:", "warning:"):
            self.assertNotIn(word, self.session.output)
        return pixels

    def changes_of_file(self, filter_, files):
        """{name: events} for {name: path}: the file takes the place of that of a filter of this
        name, which is the only one, and both are applied."""
        return {name: [
            # Change File is in a menu that the recorder doesn't reach.
            self.session.add_code(CHANGE_FILE.format(name=filter_, path=path)),
            gui.pause(500), in_the_pipeline(0), gui.pause(300), APPLY, in_the_pipeline(0, 0),
            gui.pause(500)] for name, path in files.items()}

    def until_told(self, start, times):
        """An event that lets the window go on till so many lines have begun like that."""
        return self.session.add_code(f"until(lambda: times_told({start!r}) >= {times})")

    def saved_state(self, name):
        """Path of a state, and the events that save it from the window."""
        path = testing.output_path(name)
        if os.path.exists(path):
            os.remove(path)
        return path, [
            gui.event(f"{gui.WINDOW}/menubar/menu_File", "activate", "actionFileSaveServerState"),
            gui.event(f"{gui.WINDOW}/FileSaveServerStateDialog", "filesSelected", path)]
