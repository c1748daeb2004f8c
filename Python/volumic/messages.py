# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""What the command prints on the standard error, and how it runs algorithms of VTK: messages,
progress, Ctrl-C."""

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

SAME_SIGNAL = 1.0  # seconds within which a second signal is the same one: `timeout` sends it twice


class _State:
    interrupted_at: float | None = None  # when the first signal came
    holds = False  # whether work continues after a signal


def _interrupt(number: int, _frame: Any) -> None:
    now = time.monotonic()
    if _State.interrupted_at is None:
        _State.interrupted_at = now
        if not _State.holds:
            raise KeyboardInterrupt
    elif now - _State.interrupted_at > SAME_SIGNAL:
        signal.signal(number, signal.SIG_DFL)
        os.kill(os.getpid(), number)


def catch_signals() -> None:
    """Handle SIGINT and SIGTERM. The first signal raises KeyboardInterrupt, or, after
    hold_signals(), sets was_interrupted(). One that comes a second later ends the process."""
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, _interrupt)


def hold_signals() -> None:
    """From now on a signal stops the running algorithm, and what it has made is written."""
    _State.holds = True


def was_interrupted() -> bool:
    """Whether a signal has come."""
    return _State.interrupted_at is not None


# ---- Texts -------------------------------------------------------------------------------------

def number_text(value: float) -> str:
    """The shortest text that is read back as the same number: `3`, `0.5`."""
    return str(value) if isinstance(value, int) else repr(float(value)).removesuffix(".0")


def one_line(text: str, most: int = 1500) -> str:
    """A text without line ends and control characters; the middle of a long one is left out."""
    text = " ".join("".join(c if c.isprintable() else " " for c in text).split())
    return text if len(text) <= most else f"{text[:most // 2]} ... {text[-most // 2:]}"


def _write(text: str) -> None:
    try:
        sys.stderr.write(text)
        sys.stderr.flush()
    except OSError:
        pass  # nobody reads it


class Teller:
    """Prints messages and progress on the standard error; with `quiet` nothing but errors."""

    def __init__(self, quiet: bool = False, progress: bool = False) -> None:
        self.quiet = quiet
        self.style = ("none" if quiet else "line" if sys.stderr.isatty()
                      else "lines" if progress else "none")

    def say(self, text: str) -> None:
        """Print a message, unless it is empty."""
        if text and not self.quiet:
            self.error(text)

    def warn(self, text: str) -> None:
        """Print a warning."""
        self.say(f"warning: {text}")

    def error(self, text: str) -> None:
        """Print a message even with --quiet."""
        _write(f"volumic: {text}\n")

    def progress(self, title: str) -> Progress:
        """The progress of one piece of work, for `with`."""
        return Progress(title, self.style)


class Progress:
    """Shows the finished share of a piece of work: on a terminal in one line that is redrawn and
    erased at the end, else, with --progress, in a line for each tenth."""

    def __init__(self, title: str, style: str) -> None:
        self.title, self.style = title, style
        self.drawn_at = self.next_share = 0.0

    def __enter__(self) -> Progress:
        return self

    def __exit__(self, *_: Any) -> None:
        if self.drawn_at:
            _write("\r\x1b[K")  # erases the line

    def __call__(self, share: float, text: str = "") -> None:
        """`share` of the work is done, 0 to 1."""
        share = min(max(share, 0.0), 1.0)
        if self.style == "line" and time.monotonic() - self.drawn_at > 0.1:
            self.drawn_at = time.monotonic()
            line = f"{self.title} [{'#' * int(24 * share):.<24}] {100 * share:3.0f} % {text}"
            _write("\r\x1b[K" + line[:max(shutil.get_terminal_size().columns, 20) - 1])
        elif self.style == "lines" and share >= self.next_share:
            _write(f"{self.title}: {100 * share:3.0f} %{'  ' + text if text else ''}\n")
            self.next_share = share + 0.1


# ---- Algorithms --------------------------------------------------------------------------------

class Run(NamedTuple):
    """What a run of an algorithm was like."""
    seconds: float = 0.0
    warnings: tuple[str, ...] = ()
    interrupted: bool = False


def update(algorithm: Any, on_progress: Callable[[], None] = lambda: None
           ) -> tuple[list[str], list[str]]:
    """Update an algorithm, or have a writer write; return its errors and its warnings.

    `on_progress` is called at each ProgressEvent. VTK holds Python's lock while it works: at these
    events handlers of signals run and other threads get the lock.
    """
    from vtkmodules.util.misc import calldata_type
    from vtkmodules.util.vtkConstants import VTK_STRING
    errors: list[str] = []
    warnings: list[str] = []

    @calldata_type(VTK_STRING)
    def keep(_caller: Any, event: str, text: str) -> None:
        # Without the position in VTK's source code.
        text = re.sub(r"^(ERROR|Warning): In .*?\n.*?\): |^Generic Warning: In .*?\n", "", text,
                      flags=re.DOTALL)
        # The executive repeats that its algorithm failed, which has stated the reason.
        if event == "WarningEvent":
            warnings.append(" ".join(text.split()))
        elif not errors or "returned failure for request" not in text:
            errors.append(" ".join(text.split()))

    followed_at = 0.0

    def follow(*_: Any) -> None:
        nonlocal followed_at
        if time.monotonic() - followed_at > 0.02:  # there are 21,000 events of a skull
            followed_at = time.monotonic()
            time.sleep(0)
            on_progress()

    tags = [(algorithm, algorithm.AddObserver("ProgressEvent", follow))]
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
    """A signal stops the algorithm, and its handler is called afterwards: VTK ends the process if
    a handler raises KeyboardInterrupt at an event."""
    came: list[int] = []

    def keep(number: int, _frame: Any) -> None:
        came.append(number)
        algorithm.SetAbortExecute(1)

    is_main = threading.current_thread() is threading.main_thread()
    handlers = {number: signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)
                if is_main and not _State.holds and callable(signal.getsignal(number))}
    try:
        for number in handlers:
            signal.signal(number, keep)
        yield
    finally:
        for number, handler in handlers.items():
            signal.signal(number, handler)
    for number in came[:1]:
        signal.raise_signal(number)


def run(algorithm: Any, title: str, teller: Teller, words: Callable[[str], str] = str) -> Run:
    """Update an algorithm, show its progress, and stop it after a signal. Throw Failure with its
    first error. `words` puts messages into the terms of the command line."""
    started = time.monotonic()
    with teller.progress(title) as progress:
        def follow() -> None:
            if was_interrupted():
                algorithm.SetAbortExecute(1)
            progress(algorithm.GetProgress(), algorithm.GetProgressText() or "")

        errors, warnings = update(algorithm, follow)
    if errors:
        raise Failure(words(errors[0]))
    return Run(time.monotonic() - started, tuple(map(words, warnings)), was_interrupted())
