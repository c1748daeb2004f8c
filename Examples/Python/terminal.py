# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Running a VTK filter from a script: a progress bar on the terminal, errors as exceptions, and
Ctrl-C, which lets the filter hand over what it has."""

import contextlib
import os
import re
import shutil
import signal
import sys
import threading
import time

from vtkmodules.util.misc import calldata_type
from vtkmodules.util.vtkConstants import VTK_STRING
from vtkmodules.vtkCommonCore import vtkLogger, vtkOutputWindow, vtkStringOutputWindow

REDRAW_SECONDS = 0.1
BAR_WIDTH = 24  # characters


class FilterError(Exception):
    """What a filter reported through its ErrorEvent."""


class Interrupted(Exception):
    """Ctrl-C stopped the filter; its outputs hold what there was, valid as always."""


class ProgressLine:
    """A line of the terminal that shows a filter's progress: title, bar, percent, its text."""

    def __init__(self, title):
        self.title = title
        self.drawn_at = 0.0
        self.length = 0

    def show(self, algorithm, _event):
        """Observer of ProgressEvent."""
        now = time.monotonic()
        if now - self.drawn_at < REDRAW_SECONDS:
            return
        self.drawn_at = now
        share = min(1.0, max(0.0, algorithm.GetProgress()))
        filled = int(share * BAR_WIDTH)
        bar = "#" * filled + "." * (BAR_WIDTH - filled)
        line = f"{self.title} [{bar}] {100 * share:3.0f} % {algorithm.GetProgressText() or ''}"
        line = line[:shutil.get_terminal_size().columns - 1]  # a longer one would leave its rests
        print("\r" + line.ljust(self.length), end="", flush=True)
        self.length = len(line)

    def finish(self, text):
        """Put the text in the place of the bar."""
        start = "\r" if self.length else ""
        print(f"{start}{text}".ljust(self.length + len(start)), flush=True)


def run_filter(algorithm, title=None):
    """Update the filter; returns the seconds it took, and its warnings.

    With a title, a bar shows on a terminal how far it is, in a log there is one line at the end,
    and warnings are printed below it. Raises FilterError where the filter reports errors, and
    Interrupted after Ctrl-C.
    """
    errors, warnings, echoes = [], [], []
    line = ProgressLine(title)

    @calldata_type(VTK_STRING)
    def keep_error(_caller, _event, text):
        errors.append(plain_message(text))

    @calldata_type(VTK_STRING)
    def keep_warning(_caller, _event, text):
        warnings.append(plain_message(text))

    @calldata_type(VTK_STRING)
    def keep_echo(_caller, _event, text):
        echoes.append(plain_message(text))

    # Python's signal handlers run when Python code does, so some observer has to be called.
    observe = line.show if title and sys.stdout.isatty() else lambda *_: None
    tags = [algorithm.AddObserver("ErrorEvent", keep_error),
            algorithm.AddObserver("WarningEvent", keep_warning),
            algorithm.AddObserver("ProgressEvent", observe)]
    # The executive reports what it finds wrong before the algorithm runs.
    executive_tag = algorithm.GetExecutive().AddObserver("ErrorEvent", keep_echo)
    interrupts = AbortAtInterrupt(algorithm)
    started = time.monotonic()
    try:
        with interrupts:
            algorithm.Update()
    finally:
        for tag in tags:
            algorithm.RemoveObserver(tag)
        algorithm.GetExecutive().RemoveObserver(executive_tag)
    seconds = time.monotonic() - started
    if title:
        line.finish(f"{title}: {seconds:.2f} s{', interrupted' if interrupts.happened else ''}")
        for text in warnings:
            print(f"  Warning: {text}")
    if errors or echoes:
        raise FilterError("; ".join(errors or echoes))
    if interrupts.happened:
        raise Interrupted(f"interrupted after {seconds:.2f} s")
    return seconds, warnings


class AbortAtInterrupt:
    """Within this context Ctrl-C sets the filter's AbortExecute instead of ending the script."""

    def __init__(self, algorithm):
        self.algorithm = algorithm
        self.happened = False
        self.former = None

    def __enter__(self):
        if threading.current_thread() is threading.main_thread():
            self.former = signal.signal(signal.SIGINT, self.abort)
        return self

    def __exit__(self, *_):
        if self.former is not None:
            signal.signal(signal.SIGINT, self.former)

    def abort(self, *_):
        if self.happened:  # a second time: at once, without the filter's consent
            os._exit(3)
        self.happened = True
        self.algorithm.SetAbortExecute(1)


@contextlib.contextmanager
def caught_output():
    """Within this context VTK's messages that nobody observes are kept, not printed.

    Yields a vtkStringOutputWindow.
    """
    window, former = vtkStringOutputWindow(), vtkOutputWindow.GetInstance()
    verbosity = vtkLogger.GetCurrentVerbosityCutoff()
    vtkOutputWindow.SetInstance(window)
    vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_OFF)  # it prints what it hands on
    try:
        yield window
    finally:
        vtkOutputWindow.SetInstance(former)
        vtkLogger.SetStderrVerbosity(verbosity)


@contextlib.contextmanager
def warnings_only():
    """Within this context VTK logs warnings and errors, not that a filter runs, as some tell."""
    verbosity = vtkLogger.GetCurrentVerbosityCutoff()
    vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_WARNING)
    try:
        yield
    finally:
        vtkLogger.SetStderrVerbosity(verbosity)


def plain_message(text):
    """The message of vtkErrorMacro without the place in the source code."""
    text = re.sub(r"^(ERROR|Warning): In .*?\n.*?\): ", "", text, flags=re.DOTALL)
    return re.sub(r"\s+", " ", re.sub("^Generic Warning: In .*\n", "", text)).strip()
