# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""ParaView's window on a separate screen (Xvfb): play events, then take a picture.

Events are those of ParaView's test recorder (Tools > Record Test): the path of an object in the tree of
widgets, a command and its arguments.
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
HERE = os.path.dirname(os.path.abspath(__file__))


def event(path, command, arguments=""):
    return f"<pqevent object={quoteattr(path)} command={quoteattr(command)} " \
           f"arguments={quoteattr(arguments)}/>"


def check(path, property_, value):
    """Return the event that fails unless the Qt property of the widget has this value."""
    return f"<pqcheck object={quoteattr(path)} property={quoteattr(property_)} " \
           f"arguments={quoteattr(value)}/>"


def pause(milliseconds):
    return event(WINDOW, "pause", str(milliseconds))


def start_screen(xvfb, size, options=()):
    """Start an X server. Return its process and the value of DISPLAY."""
    read_end, write_end = os.pipe()
    server = subprocess.Popen(
        [xvfb, "-displayfd", str(write_end), "-screen", "0", f"{size[0]}x{size[1]}x24", *options,
         "-nolisten", "tcp",
         # A server that resets after its last client refuses the next one during that time.
         "-noreset"],
        pass_fds=[write_end], stderr=subprocess.DEVNULL, stdin=subprocess.DEVNULL,
        preexec_fn=end_with_parent)
    os.close(write_end)
    ready, _, _ = select.select([read_end], [], [], PATIENCE)
    with os.fdopen(read_end) as answer:
        number = answer.readline().strip() if ready else ""
    if not number:
        server.kill()
        raise RuntimeError("Xvfb did not start")
    return server, f":{number}"


CODES = 12  # macros of the menu
SCRIPTS = 500  # maximum number of scripts per window
PATIENCE = 900  # seconds, for a busy machine


class Session:
    """Starts Xvfb and paraview. play() returns when all events have been played or one has failed.

    Starting a window takes long, so one window plays all scripts, and resets its state between them.

    plain: for pictures; a window for each script, without macros in the toolbars and add_code().
    """

    def __init__(self, paraview, plugin, xvfb, size=(1400, 1000), plain=False):
        self._paraview = paraview
        self._plugin = plugin
        self._folder = tempfile.TemporaryDirectory(prefix="volumic-window-")
        self._server, display = start_screen(xvfb, size, ("-fbdir", self._folder.name))
        # A separate home, without settings of the user.
        self._environment = dict(os.environ, DISPLAY=display, QT_QPA_PLATFORM="xcb",
                                 HOME=self._folder.name, XDG_RUNTIME_DIR=self._folder.name,
                                 LIBGL_ALWAYS_SOFTWARE="1", PYTHONUNBUFFERED="1",
                                 VOLUMIC_WINDOW=self._folder.name)
        self._window = None
        self._script = 0
        self._is_spent = False
        self._codes = []
        self.output = ""
        self._plain = plain
        calls = {name: f"{name}()" for name in ("begin", "wait")}
        calls.update((f"code{i}", f"run('code{i}')") for i in range(CODES))
        for name, call in calls.items() if not plain else ():
            self._write(f".config/ParaView/Macros/{name}.py",
                        f"import sys\nsys.path.insert(0, {HERE!r})\n"
                        f"import in_the_window\nin_the_window.{call}\n")

    def _write(self, name, text):
        """Write a file in the folder atomically, and return its path."""
        path = os.path.join(self._folder.name, name)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path + ".part", "w", encoding="utf-8") as file:
            file.write(text)
        os.rename(path + ".part", path)
        return path

    def add_code(self, code):
        """Return the event that runs Python code in the window, until forget_codes()."""
        name = f"code{self._codes.index(code) if code in self._codes else len(self._codes)}"
        if code not in self._codes:
            self._codes.append(code)
            self._write(name, code)
        return self._macro(name)

    @staticmethod
    def _macro(name):
        return event(f"{WINDOW}/menubar/menu_Macros", "activate", name)

    def forget_codes(self):
        self._codes.clear()

    @property
    def display(self):
        """Value of DISPLAY for other programs."""
        return self._environment["DISPLAY"]

    def play(self, events, timeout=PATIENCE, python="", live=False):
        """Play the events in a window in its initial state. Return whether all succeeded.

        python: code that runs first; `output` has its printed lines.
        live: in a separate window, which accepts real mouse and keys afterwards.
        """
        live = live or self._plain
        if live or self._is_spent:
            self.close_window()
        script, following = f"{self._script}.xml", self._script + 1
        played = events if self._plain else [
            self._macro("begin"), event(f"{PANEL}/SearchBox/AdvancedButton", "set_boolean", "false"),
            *([self.add_code(python)] if python else []), *events,
            *([] if live else [self._macro("wait")])]
        self._write(script, "<?xml version=\"1.0\" ?>\n<pqevents>\n" + "\n".join(played)
                    + "\n</pqevents>\n")
        if not self._window:
            scripts = [f"--test-script={self._folder.name}/{number}.xml" for number in
                       range(self._script, following if live else self._script + SCRIPTS)]
            if python and self._plain:
                scripts.append(f"--script={self._write('before.py', python)}")
            self._environment["VOLUMIC_SCRIPT"] = str(self._script)
            self._start(*scripts)
        self._script = following
        # The second text is the last output if an event failed.
        self.output = self._listen((b"Success = " if live else b"All events are played.",
                                    b"critical: In event"), timeout)
        # Ignore output between two scripts.
        self.output = self.output.rpartition(f"/{script}\n")[2] or self.output
        succeeded = ("Success =  true" if live else "All events are played.") in self.output
        # After a failure the window plays no more events, and a box with messages stays open.
        self._is_spent = live or not succeeded or any(
            word in self.output for word in ("ERR|", "WARN|", "critical:", "warning:"))
        return succeeded

    def start(self, python):
        """Start a window that plays no events, for real mouse and keys, and run the code in it."""
        self.close_window()
        self._write("started", python)
        self._start("--script=" + self._write("start.py", f"import sys\nsys.path.insert(0, {HERE!r})\n"
                                              "import in_the_window\nin_the_window.run('started')\n"))

    def _start(self, *options):
        self._window = subprocess.Popen(
            [self._paraview, "--dr", f"--plugin-search-paths={os.path.dirname(self._plugin)}",
             "--plugins=Volumic", *options],
            env=self._environment, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT, preexec_fn=end_with_parent)

    def wait_for(self, text, timeout=PATIENCE):
        """After the events: wait until the window prints the text. Return its output since then."""
        return self._listen((text.encode(),), timeout)

    def _listen(self, ends, timeout):
        deadline = time.monotonic() + timeout
        printed = b""
        while not any(end in printed for end in ends) and time.monotonic() < deadline:
            ready, _, _ = select.select([self._window.stdout], [], [], 0.5)
            if ready:
                piece = os.read(self._window.stdout.fileno(), 65536)
                if not piece:
                    break
                printed += piece
        return printed.decode(errors="replace")

    def pixels(self):
        """Return the pixels of the window, without the empty part of the screen."""
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

    def wait_for_rest(self, before=None, least=1, timeout=PATIENCE):
        """Wait until the window does not change for a while, at least `least` seconds. With a picture
        from before, wait until the window differs from it, too."""
        begin = time.monotonic()
        end = begin + timeout
        last, since = before, None if before is not None else time.monotonic()
        while time.monotonic() < end:
            now = self.pixels()
            if last is None or now.shape != last.shape or (now != last).any():
                last, since = now, time.monotonic()
            # A text cursor blinks every half second.
            elif since and time.monotonic() - since > 0.4 and time.monotonic() - begin > least:
                return
            time.sleep(0.05)

    def screenshot(self, path):
        """Write the window as PNG. Return its pixels."""
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

    def has_quit(self):
        """Wait for the end of the window. Return whether it ended without an error."""
        self.wait_for("\0")  # to the end of its output
        succeeded = self._window.wait(PATIENCE) == 0
        self.close_window()
        return succeeded

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
