# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Running a VTK filter from a script: progress on the terminal, errors as exceptions."""

import re
import sys
import time

from vtkmodules.util.misc import calldata_type
from vtkmodules.util.vtkConstants import VTK_STRING

REDRAW_SECONDS = 0.1


class FilterError(Exception):
    """What a filter reported through its ErrorEvent."""


def run_filter(algorithm, title):
    """Update the filter; returns the seconds it took, and its warnings.

    On a terminal the line shows the progress and the filter's progress text as it goes; in a log
    there is one line at the end. Warnings are printed below it.
    """
    errors, warnings, echoes = [], [], []
    drawn = [0.0, 0]  # when, and how many characters

    @calldata_type(VTK_STRING)
    def keep_error(_caller, _event, text):
        errors.append(plain_message(text))

    @calldata_type(VTK_STRING)
    def keep_warning(_caller, _event, text):
        warnings.append(plain_message(text))

    def show(caller, _event):
        now = time.monotonic()
        if now - drawn[0] > REDRAW_SECONDS:
            line = f"{title}: {100 * caller.GetProgress():3.0f} % {caller.GetProgressText() or ''}"
            print("\r" + line.ljust(drawn[1]), end="", flush=True)
            drawn[:] = now, len(line)

    @calldata_type(VTK_STRING)
    def keep_echo(_caller, _event, text):
        echoes.append(plain_message(text))

    tags = [algorithm.AddObserver("ErrorEvent", keep_error),
            algorithm.AddObserver("WarningEvent", keep_warning)]
    # The executive reports a second time that its algorithm failed, or alone what it found wrong.
    executive_tag = algorithm.GetExecutive().AddObserver("ErrorEvent", keep_echo)
    if sys.stdout.isatty():
        tags.append(algorithm.AddObserver("ProgressEvent", show))
    started = time.monotonic()
    try:
        algorithm.Update()
    finally:
        for tag in tags:
            algorithm.RemoveObserver(tag)
        algorithm.GetExecutive().RemoveObserver(executive_tag)
    seconds = time.monotonic() - started
    start_of_line = "\r" if drawn[1] else ""
    print(f"{start_of_line}{title}: {seconds:.2f} s".ljust(drawn[1] + 1), flush=True)
    for text in warnings:
        print(f"  Warning: {text}")
    if errors or echoes:
        raise FilterError("; ".join(errors or echoes))
    return seconds, warnings


def plain_message(text):
    """The message of vtkErrorMacro without the place in the source code."""
    return re.sub(r"\s+", " ", re.sub(r"^(ERROR|Warning): In .*?\n.*?\): ", "", text,
                                      flags=re.DOTALL)).strip()
