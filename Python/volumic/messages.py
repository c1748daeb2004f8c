# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Messages, progress and signals of the command, and runs of VTK algorithms."""

from __future__ import annotations

import contextlib
import os
import re
import shutil
import signal
import sys
import threading
import time
from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

from .errors import Failure

# ---- Signals -----------------------------------------------------------------------------------

SAME_SIGNAL = 1.0  # seconds; a second signal within this time is ignored: `timeout` sends two


class _State:
    interrupted_at: float | None = None  # time of the first signal
    deferred = False  # set by defer_signals()


def _interrupt(number: int, _frame: Any) -> None:
    now = time.monotonic()
    if _State.interrupted_at is None:
        _State.interrupted_at = now
        if not _State.deferred:
            raise KeyboardInterrupt
    elif now - _State.interrupted_at > SAME_SIGNAL:
        signal.signal(number, signal.SIG_DFL)
        os.kill(os.getpid(), number)


def catch_signals() -> None:
    """Handle SIGINT and SIGTERM. The first one raises KeyboardInterrupt, or, after defer_signals(),
    sets was_interrupted(). Another one more than SAME_SIGNAL seconds later ends the process."""
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, _interrupt)


def defer_signals() -> None:
    """From now on, let a signal stop the running algorithm, and keep its result."""
    _State.deferred = True


def was_interrupted() -> bool:
    """Return whether a signal was received."""
    return _State.interrupted_at is not None


# ---- Texts -------------------------------------------------------------------------------------

def number_text(value: float) -> str:
    """Return the shortest text that parses to the same number: `3`, `0.5`."""
    return str(value) if isinstance(value, int) else repr(float(value)).removesuffix(".0")


def one_line(text: str, maximum: int = 1500) -> str:
    """Return a text as one printable line, shortened in the middle to `maximum` characters."""
    text = " ".join("".join(c if c.isprintable() else " " for c in text).split())
    return text if len(text) <= maximum else f"{text[:maximum // 2]} ... {text[-maximum // 2:]}"


def _write(text: str) -> None:
    try:
        sys.stderr.write(text)
        sys.stderr.flush()
    except OSError:
        pass  # closed


class Console:
    """Prints messages and progress on the standard error; only errors if `quiet`."""

    def __init__(self, quiet: bool = False, progress: bool = False) -> None:
        self.quiet = quiet
        self.style = ("none" if quiet else "line" if sys.stderr.isatty()
                      else "lines" if progress else "none")

    def info(self, text: str) -> None:
        """Print a message unless it is empty."""
        if text and not self.quiet:
            self.error(text)

    def warn(self, text: str) -> None:
        self.info(f"warning: {text}")

    def error(self, text: str) -> None:
        """Print a message, also if quiet."""
        _write(f"volumic: {text}\n")

    def progress(self, title: str) -> Progress:
        """Return a context manager that shows the progress of an operation."""
        return Progress(title, self.style)


class Progress:
    """Shows the progress of an operation: in a terminal in one line, erased at the end; otherwise,
    with --progress, in one line per 10 %."""

    def __init__(self, title: str, style: str) -> None:
        self.title, self.style = title, style
        self.drawn_at = self.next_fraction = 0.0

    def __enter__(self) -> Progress:
        return self

    def __exit__(self, *_: Any) -> None:
        if self.drawn_at:
            _write("\r\x1b[K")  # erase the line

    def __call__(self, fraction: float, text: str = "") -> None:
        """Show that `fraction` (0 to 1) of the operation is done."""
        fraction = min(max(fraction, 0.0), 1.0)
        if self.style == "line" and time.monotonic() - self.drawn_at > 0.1:
            self.drawn_at = time.monotonic()
            line = f"{self.title} [{'#' * int(24 * fraction):.<24}] {100 * fraction:3.0f} % {text}"
            _write("\r\x1b[K" + line[:max(shutil.get_terminal_size().columns, 20) - 1])
        elif self.style == "lines" and fraction >= self.next_fraction:
            _write(f"{self.title}: {100 * fraction:3.0f} %{'  ' + text if text else ''}\n")
            self.next_fraction = fraction + 0.1


# ---- Algorithms --------------------------------------------------------------------------------

class Run(NamedTuple):
    seconds: float = 0.0
    warnings: tuple[str, ...] = ()
    interrupted: bool = False


def update(algorithm: Any, on_progress: Callable[[], None] = lambda: None
           ) -> tuple[list[str], list[str]]:
    """Update an algorithm, or call Write() of a writer. Return errors and warnings. `on_progress`
    is called at each ProgressEvent. VTK holds Python's interpreter lock while it runs; at these
    events, signal handlers are called and other threads can run."""
    from vtkmodules.util.misc import calldata_type
    from vtkmodules.util.vtkConstants import VTK_STRING
    errors: list[str] = []
    warnings: list[str] = []

    @calldata_type(VTK_STRING)
    def keep(_caller: Any, event: str, text: str) -> None:
        # Remove the position in VTK's source code.
        text = re.sub(r"^(ERROR|Warning): In .*?\n.*?\): |^Generic Warning: In .*?\n", "", text,
                      flags=re.DOTALL)
        # The executive repeats the failure without its reason.
        if event == "WarningEvent":
            warnings.append(" ".join(text.split()))
        elif not errors or "returned failure for request" not in text:
            errors.append(" ".join(text.split()))

    called_at = 0.0

    def show_progress(*_: Any) -> None:
        nonlocal called_at
        if time.monotonic() - called_at > 0.02:
            called_at = time.monotonic()
            time.sleep(0)  # lets other threads run
            on_progress()

    tags = [(algorithm, algorithm.AddObserver("ProgressEvent", show_progress))]
    tags += [(source, source.AddObserver(event, keep))
             for source in (algorithm, algorithm.GetExecutive())
             for event in ("ErrorEvent", "WarningEvent")]
    try:
        with _signals_deferred(algorithm):
            (algorithm.Write if hasattr(algorithm, "Write") else algorithm.Update)()
    finally:
        for source, tag in tags:
            source.RemoveObserver(tag)
    return errors, warnings


@contextlib.contextmanager
def _signals_deferred(algorithm: Any) -> Iterator[None]:
    """Let a signal abort the algorithm and call its handler afterwards. VTK ends the process if a
    handler raises KeyboardInterrupt in an observer."""
    received: list[int] = []

    def keep(number: int, _frame: Any) -> None:
        received.append(number)
        algorithm.SetAbortExecute(1)

    is_main = threading.current_thread() is threading.main_thread()
    handlers = {number: signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)
                if is_main and not _State.deferred and callable(signal.getsignal(number))}
    try:
        for number in handlers:
            signal.signal(number, keep)
        yield
    finally:
        for number, handler in handlers.items():
            signal.signal(number, handler)
    for number in received[:1]:
        signal.raise_signal(number)


def run(algorithm: Any, title: str, console: Console, translate: Callable[[str], str] = str) -> Run:
    """Update an algorithm, show its progress, and abort it after a signal. Raise Failure with its
    first error. `translate` converts messages to the terms of the command line."""
    started = time.monotonic()
    with console.progress(title) as progress:
        def show_progress() -> None:
            if was_interrupted():
                algorithm.SetAbortExecute(1)
            progress(algorithm.GetProgress(), algorithm.GetProgressText() or "")

        errors, warnings = update(algorithm, show_progress)
    if errors:
        raise Failure(translate(errors[0]))
    return Run(time.monotonic() - started, tuple(map(translate, warnings)), was_interrupted())
