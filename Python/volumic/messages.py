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
    """Of the process: when the first signal came, and whether work goes on after one."""
    interrupted_at: float | None = None
    holds = False


def _interrupt(number: int, _frame: Any) -> None:
    now = time.monotonic()
    if _State.interrupted_at is not None:
        if now - _State.interrupted_at > SAME_SIGNAL:
            signal.signal(number, signal.SIG_DFL)
            os.kill(os.getpid(), number)
        return
    _State.interrupted_at = now
    if not _State.holds:
        raise KeyboardInterrupt


def catch_signals() -> None:
    """Handle SIGINT and SIGTERM: the first one raises KeyboardInterrupt, or, after
    hold_signals(), is remembered for was_interrupted(); one that comes a second later ends the
    process."""
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
        try:
            print(f"volumic: {text}", file=sys.stderr, flush=True)
        except OSError:
            pass  # nobody reads it

    def progress(self, title: str) -> Progress:
        """The progress of one piece of work, for `with`."""
        return Progress(title, self.style)


class Progress:
    """Shows which share of a piece of work is done: on a terminal one line that is redrawn and
    vanishes at the end, else, where asked for, a line for each tenth."""

    def __init__(self, title: str, style: str) -> None:
        self.title, self.style = title, style
        self.drawn_at = 0.0
        self.next_share = 0.0

    def __enter__(self) -> Progress:
        return self

    def __exit__(self, *_: Any) -> None:
        if self.drawn_at:
            self._print("\r" + " " * (self._width() - 1) + "\r")

    def __call__(self, share: float, text: str = "") -> None:
        """`share` of the work is done, 0 to 1."""
        share = min(max(share, 0.0), 1.0)
        if self.style == "line" and time.monotonic() - self.drawn_at > 0.1:
            self.drawn_at = time.monotonic()
            filled = int(24 * share)
            line = f"{self.title} [{'#' * filled:.<24}] {100 * share:3.0f} % {text}"
            self._print("\r" + line[:self._width() - 1].ljust(self._width() - 1))
        elif self.style == "lines" and share >= self.next_share:
            self._print(f"{self.title}: {100 * share:3.0f} %{'  ' + text if text else ''}\n")
            self.next_share = share + 0.1

    @staticmethod
    def _width() -> int:
        return max(shutil.get_terminal_size().columns, 20)

    @staticmethod
    def _print(text: str) -> None:
        try:
            sys.stderr.write(text)
            sys.stderr.flush()
        except OSError:
            pass


# ---- Algorithms --------------------------------------------------------------------------------

class Run(NamedTuple):
    """What a run of an algorithm was like."""
    seconds: float = 0.0
    warnings: tuple[str, ...] = ()
    interrupted: bool = False


def plain_message(text: str) -> str:
    """A message of VTK without the place in the source code, on one line."""
    text = re.sub(r"^(ERROR|Warning): In .*?\n.*?\): ", "", text, flags=re.DOTALL)
    text = re.sub(r"^Generic Warning: In .*?\n", "", text, flags=re.DOTALL)
    return re.sub(r"\s+", " ", text).strip()


def update(algorithm: Any, on_progress: Callable[[], None] | None = None
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
        text = plain_message(text)
        # The executive repeats that its algorithm failed, which has said why.
        if event == "WarningEvent":
            warnings.append(text)
        elif not errors or "returned failure for request" not in text:
            errors.append(text)

    def follow(*_: Any) -> None:
        time.sleep(0)
        if on_progress:
            on_progress()

    tags = [(algorithm, algorithm.AddObserver("ProgressEvent", follow))]
    for source in (algorithm, algorithm.GetExecutive()):
        for event in ("ErrorEvent", "WarningEvent"):
            tags.append((source, source.AddObserver(event, keep)))
    try:
        with _signals_deferred(algorithm):
            (algorithm.Write if hasattr(algorithm, "Write") else algorithm.Update)()
    finally:
        for source, tag in tags:
            source.RemoveObserver(tag)
    return errors, warnings


@contextlib.contextmanager
def _signals_deferred(algorithm: Any) -> Iterator[None]:
    """A signal stops the algorithm, and its handler is called afterwards: VTK ends the process where
    one raises KeyboardInterrupt at an event."""
    came: list[int] = []
    handlers: dict[int, Any] = {}

    def keep(number: int, _frame: Any) -> None:
        came.append(number)
        algorithm.SetAbortExecute(1)

    if not _State.holds and threading.current_thread() is threading.main_thread():
        handlers = {number: signal.signal(number, keep) for number in (signal.SIGINT, signal.SIGTERM)
                    if callable(signal.getsignal(number))}
    try:
        yield
    finally:
        for number, handler in handlers.items():
            signal.signal(number, handler)
    for number in came[:1]:
        handlers[number](number, None)


def run(algorithm: Any, title: str, teller: Teller, words: Callable[[str], str] = str) -> Run:
    """Update an algorithm, show its progress, and stop it after a signal.

    `words` puts the algorithm's messages into the words of the command line. Throw Failure with
    its first error.
    """
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
