# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""What runs in ParaView's window for gui_session.py: code of the tests, as macros of the menu.

The code finds as its own: print(), which tells the test at once; until(), times_told() and lasting().
"""

import ctypes
import os
import time

FOLDER = os.environ.get("VOLUMIC_WINDOW", "")
told = []
kept = []  # Names that observers look up when they are called.
script = int(os.environ.get("VOLUMIC_SCRIPT", "0"))  # the next one
playing = None  # an object for each script


def tell(*words, flush=True):  # pylint: disable=unused-argument
    # Not by Python's print(): newer ParaViews keep what is said till there is much of it.
    told.append(" ".join(map(str, words)))
    os.write(1, (told[-1] + "\n").encode())


def times_told(start):
    """How many lines have begun like that since the events began."""
    return sum(line.startswith(start) for line in told)


def until(is_so):
    """Let the window go on till something is so."""
    process = ctypes.CDLL(None)[
        "_ZN16QCoreApplication13processEventsE6QFlagsIN10QEventLoop17ProcessEventsFlagEE"]
    while not is_so():
        process(0)
        time.sleep(0.01)


def lasting(function):
    """An observer that hears of nothing once these events are played."""
    own = playing
    return lambda *arguments: function(*arguments) if playing is own else None


def begin():
    from paraview import simple  # pylint: disable=import-outside-toplevel
    global script, playing
    script += 1
    playing = object()
    told.clear()
    simple.GetSettingsProxy("GeneralSettings").AutoApply = 0


def wait():
    """For the next script."""
    global playing
    tell("All is played.")
    while not os.path.exists(os.path.join(FOLDER, f"{script}.xml")):
        time.sleep(0.02)
    playing = None


def run(name):
    with open(os.path.join(FOLDER, name), encoding="utf-8") as file:
        code = compile(file.read(), name, "exec")
    kept.append({"__name__": name, "print": tell, "until": until,
                 "times_told": times_told, "lasting": lasting})
    exec(code, kept[-1])
