# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""ParaView's real window on a screen of its own (Xvfb): events are played, then a picture is taken.

The events are those that ParaView's own test recorder writes (Tools > Record Test): an object's path
in the tree of widgets, a command and its arguments.
"""

import os
import select
import subprocess
import tempfile
import time
from xml.sax.saxutils import quoteattr

import numpy
from paraview.vtk.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkIOImage import vtkPNGWriter

from plugin_testing import end_with_parent

WINDOW = "pqClientMainWindow"
PANEL = f"{WINDOW}/propertiesDock/propertiesPanel"


def event(path, command, arguments=""):
    return f"<pqevent object={quoteattr(path)} command={quoteattr(command)} " \
           f"arguments={quoteattr(arguments)}/>"


def check(path, property_, value):
    """Fails the session unless the widget's Qt property has that value."""
    return f"<pqcheck object={quoteattr(path)} property={quoteattr(property_)} " \
           f"arguments={quoteattr(value)}/>"


def pause(milliseconds):
    return event(WINDOW, "pause", str(milliseconds))


def start_screen(xvfb, size, options=()):
    """Start an X server. Returns its process and its name for DISPLAY."""
    read_end, write_end = os.pipe()
    server = subprocess.Popen(
        [xvfb, "-displayfd", str(write_end), "-screen", "0", f"{size[0]}x{size[1]}x24", *options,
         "-nolisten", "tcp",
         # Without a client for a moment, it would be busy with itself when the next one comes.
         "-noreset"],
        pass_fds=[write_end], stderr=subprocess.DEVNULL, stdin=subprocess.DEVNULL,
        preexec_fn=end_with_parent)
    os.close(write_end)
    ready, _, _ = select.select([read_end], [], [], 30)
    with os.fdopen(read_end) as answer:
        number = answer.readline().strip() if ready else ""
    if not number:
        server.kill()
        raise RuntimeError("Xvfb did not start")
    return server, f":{number}"


class Session:
    """Starts Xvfb and paraview; `play` returns when all events have been played or one failed."""

    def __init__(self, paraview, plugin, xvfb, size=(1400, 1000)):
        self._paraview = paraview
        self._plugin = plugin
        self._folder = tempfile.TemporaryDirectory(prefix="volumic-window-")
        self._server, display = start_screen(xvfb, size, ("-fbdir", self._folder.name))
        # A home of its own: neither the user's settings nor a first start's dialogs play a part.
        self._environment = dict(os.environ, DISPLAY=display, QT_QPA_PLATFORM="xcb",
                                 HOME=self._folder.name, XDG_RUNTIME_DIR=self._folder.name,
                                 LIBGL_ALWAYS_SOFTWARE="1", PYTHONUNBUFFERED="1")
        self._window = None
        self.output = ""

    def add_macro(self, name, code):
        """For windows from now on: Python code. Returns the event that runs it, in the window."""
        folder = os.path.join(self._folder.name, ".config/ParaView/Macros")
        os.makedirs(folder, exist_ok=True)
        with open(os.path.join(folder, f"{name}.py"), "w", encoding="utf-8") as file:
            file.write(code)
        return event(f"{WINDOW}/menubar/menu_Macros", "activate", name)

    @property
    def display(self):
        """Name of the screen, as other programs of X want it."""
        return self._environment["DISPLAY"]

    def play(self, events, timeout=240, python=""):
        """Play the events in a new window, which stays open. Returns whether all succeeded.

        python: code that the window's own interpreter runs first; what it prints is in `output`.
        """
        script = os.path.join(self._folder.name, "events.xml")
        with open(script, "w", encoding="utf-8") as file:
            file.write("<?xml version=\"1.0\" ?>\n<pqevents>\n" + "\n".join(events) +
                       "\n</pqevents>\n")
        options = []
        if python:
            path = os.path.join(self._folder.name, "before.py")
            with open(path, "w", encoding="utf-8") as file:
                file.write(python)
            options = [f"--script={path}"]
        self._window = subprocess.Popen(
            [self._paraview, "--dr", f"--plugin-search-paths={os.path.dirname(self._plugin)}",
             "--plugins=Volumic", *options, f"--test-script={script}"],
            env=self._environment, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT, preexec_fn=end_with_parent)
        # It says no more than the latter when an event failed.
        self.output = self._listen((b"Success = ", b"critical: In event"), timeout)
        return "Success =  true" in self.output

    def wait_for(self, text, timeout=60):
        """After the events: wait till the window has printed the text; all it has said since."""
        return self._listen((text.encode(),), timeout)

    def _listen(self, ends, timeout):
        deadline = time.monotonic() + timeout
        said = b""
        while not any(end in said for end in ends) and time.monotonic() < deadline:
            ready, _, _ = select.select([self._window.stdout], [], [], 0.5)
            if ready:
                piece = os.read(self._window.stdout.fileno(), 65536)
                if not piece:
                    break
                said += piece
        return said.decode(errors="replace")

    def pixels(self):
        """Of the window, without the empty rest of the screen."""
        with open(os.path.join(self._folder.name, "Xvfb_screen0"), "rb") as file:
            data = file.read()
        # The format of xwd: a header of big-endian words, a colour map, rows of 4 bytes a pixel.
        words = numpy.frombuffer(data, ">u4", 25)
        header_size, width, height, row, colours = (int(words[i]) for i in (0, 4, 5, 12, 19))
        pixels = numpy.frombuffer(data, numpy.uint8, row * height, header_size + 12 * colours)
        pixels = pixels.reshape(height, row)[:, : 4 * width].reshape(height, width, 4)
        pixels = pixels[..., 2::-1] if words[7] == 0 else pixels[..., 1:]
        lit = pixels.any(axis=2)
        if lit.any():
            pixels = pixels[: lit.any(axis=1).nonzero()[0][-1] + 1,
                            : lit.any(axis=0).nonzero()[0][-1] + 1]
        return pixels

    def wait_for_rest(self, before=None, least=1, timeout=30):
        """Till nothing of the window has changed for a while, some seconds at least, as a window
        that is busy does not change either; if there is a picture of it from before, till it has
        become another one, too."""
        begin = time.monotonic()
        end = begin + timeout
        last, since = before, None if before is not None else time.monotonic()
        while time.monotonic() < end:
            now = self.pixels()
            if last is None or now.shape != last.shape or (now != last).any():
                last, since = now, time.monotonic()
            # A cursor blinks every half second.
            elif since and time.monotonic() - since > 0.4 and time.monotonic() - begin > least:
                return
            time.sleep(0.05)

    def screenshot(self, path):
        """Write the window as PNG; return its pixels."""
        pixels = self.pixels()
        image = vtkImageData()
        image.SetDimensions(pixels.shape[1], pixels.shape[0], 1)
        flipped = numpy.ascontiguousarray(pixels[::-1]).reshape(-1, 3)
        image.GetPointData().SetScalars(numpy_to_vtk(flipped, deep=True))
        writer = vtkPNGWriter()
        writer.SetFileName(path)
        writer.SetInputData(image)
        writer.SetCompressionLevel(9)
        writer.Write()
        return pixels

    def close_window(self):
        if self._window:
            self._window.kill()
            self._window.wait()
            self._window.stdout.close()
            self._window = None

    def close(self):
        self.close_window()
        self._server.terminate()
        self._server.wait()
        self._folder.cleanup()
