# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Mouse and keyboard for the screen of gui_session.py, by the X extension XTEST (libXtst).

Played events do not trigger shortcuts, and have no mouse position.
"""

import ctypes
import ctypes.util
import time


class Input:
    def __init__(self, display):
        names = [ctypes.util.find_library(name) for name in ("X11", "Xtst")]
        if None in names:
            raise FileNotFoundError("libX11 or libXtst was not found")
        self._x11, self._xtst = (ctypes.CDLL(name) for name in names)
        self._x11.XOpenDisplay.restype = ctypes.c_void_p
        self._x11.XStringToKeysym.restype = ctypes.c_ulong
        self._x11.XDefaultRootWindow.restype = ctypes.c_ulong
        self._display = ctypes.c_void_p(self._x11.XOpenDisplay(display.encode()))

    @staticmethod
    def is_there():
        return all(ctypes.util.find_library(name) for name in ("X11", "Xtst"))

    def _flush(self):
        self._x11.XSync(self._display, 0)
        time.sleep(0.1)

    def move(self, x, y):
        """Move to a position on the screen, from another position, so that an event occurs."""
        for position in ((x + 9, y + 9), (x, y)):
            self._xtst.XTestFakeMotionEvent(self._display, -1, *position, ctypes.c_ulong(0))
            self._flush()

    def focus(self):
        """Set the keyboard focus to the window under the mouse; there is no window manager."""
        root = self._x11.XDefaultRootWindow(self._display)
        window, child = ctypes.c_ulong(), ctypes.c_ulong()
        x, y, z = ctypes.c_int(), ctypes.c_int(), ctypes.c_uint()
        self._x11.XQueryPointer(self._display, ctypes.c_ulong(root), ctypes.byref(window),
                                ctypes.byref(child), *(ctypes.byref(n) for n in (x, y, x, y)),
                                ctypes.byref(z))
        self._x11.XSetInputFocus(self._display, child, 2, ctypes.c_ulong(0))
        self._flush()
        time.sleep(1)

    def key(self, *names):
        """Press keys together."""
        codes = [self._x11.XKeysymToKeycode(
            self._display, ctypes.c_ulong(self._x11.XStringToKeysym(name.encode())))
            for name in names]
        for code, down in [(code, 1) for code in codes] + [(code, 0) for code in codes[::-1]]:
            self._xtst.XTestFakeKeyEvent(self._display, code, down, ctypes.c_ulong(0))
            self._flush()

    def drag(self, start, end):
        """Drag with the left button in several steps."""
        self.move(*start)
        self._xtst.XTestFakeButtonEvent(self._display, 1, 1, ctypes.c_ulong(0))
        self._flush()
        for step in range(1, 6):
            position = [round(a + (b - a) * step / 5) for a, b in zip(start, end)]
            self._xtst.XTestFakeMotionEvent(self._display, -1, *position, ctypes.c_ulong(0))
            self._flush()
        self._xtst.XTestFakeButtonEvent(self._display, 1, 0, ctypes.c_ulong(0))
        self._flush()
