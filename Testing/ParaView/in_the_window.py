# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Runs code of tests in ParaView's window for gui_session.py, as macros of the menu.

The code can call print(), which flushes, until(), count_lines() and lasting().
"""

import ctypes
import os
import time

FOLDER = os.environ.get("VOLUMIC_WINDOW", "")
lines = []
kept = []  # global names of observers
script = int(os.environ.get("VOLUMIC_SCRIPT", "0"))  # the next one
playing = None  # an object for each script


def report(*words, flush=True):  # pylint: disable=unused-argument
    # Not by Python's print(), which newer versions of ParaView buffer.
    lines.append(" ".join(map(str, words)))
    os.write(1, (lines[-1] + "\n").encode())


def count_lines(start):
    """Return the number of printed lines with that start since the events began."""
    return sum(line.startswith(start) for line in lines)


def until(condition):
    """Process events of the window until the condition is true."""
    process = ctypes.CDLL(None)[
        "_ZN16QCoreApplication13processEventsE6QFlagsIN10QEventLoop17ProcessEventsFlagEE"]
    while not condition():
        process(0)
        time.sleep(0.01)


def lasting(function):
    """Return an observer that is inactive once these events are played."""
    own = playing
    return lambda *arguments: function(*arguments) if playing is own else None


def begin():
    from paraview import simple  # pylint: disable=import-outside-toplevel
    global script, playing
    script += 1
    playing = object()
    lines.clear()
    simple.GetSettingsProxy("GeneralSettings").AutoApply = 0


def wait():
    """Wait for the next script."""
    global playing
    report("All events are played.")
    while not os.path.exists(os.path.join(FOLDER, f"{script}.xml")):
        time.sleep(0.02)
    playing = None


def run(name):
    with open(os.path.join(FOLDER, name), encoding="utf-8") as file:
        code = compile(file.read(), name, "exec")
    kept.append({"__name__": name, "print": report, "until": until,
                 "count_lines": count_lines, "lasting": lasting})
    exec(code, kept[-1])
