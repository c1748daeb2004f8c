# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Files that take their place when they are whole.

    with output_file("surface.stl") as path:     # in a hidden folder beside it
        write(path)

The old file or the new one is there, never a part of one, whenever the process is killed. A killed
process leaves the hidden folder (.volumic-XXXXXX); everything else cleans up.
"""

from __future__ import annotations

import contextlib
import errno
import os
import re
import shutil
import sys
import tempfile
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from ..errors import Failure

HIDDEN = ".volumic-"  # hidden folders begin so


class Failures:
    """Collects what fails, so that one file that cannot be written does not stop the others."""

    def __init__(self) -> None:
        self.texts: list[str] = []

    @contextlib.contextmanager
    def collect(self) -> Iterator[None]:
        try:
            yield
        except Failure as failure:
            self.texts.append(str(failure))

    def throw(self) -> None:
        """Throw Failure with a line for each failure, if there is one."""
        if self.texts:
            raise Failure("\n".join(self.texts))


# ---- Writing -----------------------------------------------------------------------------------

@contextlib.contextmanager
def output_file(name: str) -> Iterator[str]:
    """The path to write a file to. Throw Failure that names the file if it cannot be written; a
    Failure of the block gets the name in front."""
    with _naming(name), beside(name) as path:
        yield path


@contextlib.contextmanager
def output_folder(folder: str) -> Iterator[str]:
    """The folder to write files to that take their places in `folder` together. It is made, and
    removed if nothing comes into it. Throw Failure that names the folder."""
    with made_folder(folder), _naming(folder), _hidden_folder(folder) as hidden:
        yield hidden
        _publish(hidden, folder)


@contextlib.contextmanager
def beside(name: str | os.PathLike[str]) -> Iterator[str]:
    """As output_file(), with OSError as it comes. A link is followed; a file that is replaced hands
    down its permissions; devices and pipes get the whole file at the end. What the block puts into
    a folder beside the path is moved, too."""
    target = name = os.fspath(name)
    folder = tempfile.gettempdir()
    if not is_stream(name):
        target = os.path.realpath(name)
        folder = os.path.dirname(target)
    with _hidden_folder(folder) as hidden:
        path = os.path.join(hidden, os.path.basename(target))
        yield path
        if not is_stream(name):
            _publish(hidden, folder)
            return
        with open(path, "rb") as source, open(name, "ab") as stream:
            shutil.copyfileobj(source, stream)


def replace_file(name: str | os.PathLike[str], content: bytes) -> None:
    """Write a file. Throw OSError if it cannot be written."""
    with beside(name) as path, open(path, "wb") as file:
        file.write(content)


def write_text(text: str, name: str) -> None:
    """Write a text; `-` is the standard output. Bytes of file names that are not UTF-8 become the
    replacement character."""
    content = text.encode("utf-8", "surrogateescape").decode("utf-8", "replace").encode()
    with _naming("the standard output" if name == "-" else name):
        if name != "-":
            replace_file(name, content)
        else:
            sys.stdout.flush()
            sys.stdout.buffer.write(content)
            sys.stdout.flush()


@contextlib.contextmanager
def made_folder(name: str) -> Iterator[None]:
    """Make a folder and those above it; at the end remove those made here that are empty. Throw
    Failure that names the folder if it cannot be made."""
    made, folder = [], os.path.abspath(name)
    while not os.path.lexists(folder):
        made.append(folder)
        folder = os.path.dirname(folder)
    try:
        with _naming(name):
            os.makedirs(name, exist_ok=True)
        yield
    finally:
        with contextlib.suppress(OSError):
            for folder in made:
                os.rmdir(folder)


@contextlib.contextmanager
def _naming(name: str) -> Iterator[None]:
    """Errors become a Failure on one line that begins with the name, without the hidden folder."""
    try:
        yield
    except OSError as error:
        raise Failure(f"{name}: cannot be written ({error.strerror or error})") from error
    except MemoryError as error:
        raise Failure(f"{name}: cannot be written (not enough memory)") from error
    except Failure as failure:
        if type(failure) is not Failure:
            raise
        text = re.sub(r"\S*" + re.escape(HIDDEN) + "[^/]*/", "", str(failure))
        raise Failure(f"{name}: {' '.join(text.split())}") from failure


@contextlib.contextmanager
def _hidden_folder(folder: str) -> Iterator[str]:
    """A folder in `folder`: moving files out of it stays within one file system."""
    try:
        hidden = tempfile.mkdtemp(prefix=HIDDEN, dir=folder)
    except OSError as error:
        raise OSError(error.errno, f"the folder {folder}: {error.strerror}") from None
    try:
        yield hidden
    finally:
        shutil.rmtree(hidden, ignore_errors=True)


def _publish(hidden: str, folder: str) -> None:
    """Have all files on the disk, then move each to its place: the one that names the others comes
    last. Each gets the owner and the permissions of the file that it replaces, as far as is
    allowed."""
    names = [os.path.relpath(os.path.join(place, name), hidden)
             for place, _, files in os.walk(hidden) for name in files]
    for name in names:
        _flush(os.path.join(hidden, name))
    for name in sorted(names, key=lambda name: (os.path.dirname(name) == "", name)):
        made, target = os.path.join(hidden, name), os.path.join(folder, name)
        os.makedirs(os.path.dirname(target), exist_ok=True)
        with contextlib.suppress(OSError):
            facts, mask = os.stat(target), 0o777
            with contextlib.suppress(OSError):
                os.chown(made, facts.st_uid, facts.st_gid)
                mask = 0o7777
            os.chmod(made, facts.st_mode & mask)
        try:
            os.replace(made, target)
        except OSError as error:
            raise OSError(error.errno, f"{target}: {error.strerror}") from None
    with contextlib.suppress(OSError):
        _flush(folder)


def _flush(path: str) -> None:
    descriptor = os.open(path, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


def is_stream(name: str) -> bool:
    """Whether the name is that of a device or a pipe, such as /dev/stdout."""
    path = os.path.abspath(name)
    return bool(re.match("/(proc|dev(?!/shm/))/", path)) or (
        os.path.exists(path) and not os.path.isfile(path) and not os.path.isdir(path))


# ---- Before the work begins --------------------------------------------------------------------

class OutputName(NamedTuple):
    """What is to be written, as the command line names it."""
    name: str
    form: str = "file"  # `blocks`: a .vtm, and STEM/STEM_... beside it; `folder`: of files
    prefix: str = ""    # PREFIX-....vtp; `place`: a folder of files that are not known yet

    @property
    def folder(self) -> str:
        """Of an output of several files; empty for others."""
        return ("" if self.form == "file" else self.name if self.form != "blocks" else
                os.path.splitext(os.path.realpath(self.name))[0])

    def may_write(self, path: str) -> bool:
        """Whether this path may be one of several files."""
        start = {"folder": self.prefix + "-", "blocks": os.path.basename(self.folder) + "_"}
        return (self.form in start and os.path.basename(path).startswith(start[self.form])
                and os.path.realpath(self.folder) == os.path.realpath(os.path.dirname(path)))


def check_outputs(outputs: Sequence[OutputName], inputs: Sequence[str]) -> None:
    """Throw Failure, which names the output, unless all outputs can be written: their folders are
    there, and files can be made in them; no file is a folder or write-protected, and none is one of
    the inputs or another output, by whatever name or link."""
    taken: dict[object, str] = {}
    for name in inputs:
        with contextlib.suppress(OSError):
            taken.setdefault(_identity(name), name)
    taken.pop(None, None)
    tried: set[str] = set()
    before: dict[object, OutputName] = {}
    for output in outputs:
        try:
            if output.form in ("file", "blocks"):
                _check_file(output.name, taken, tried)
            if output.form != "file":
                _check_folder(output, taken, tried)
            _check_others(output, before)
        except OSError as error:
            raise Failure(f"{output.name}: cannot be written: {error.strerror}") from None
        except Failure as failure:
            raise Failure(f"{output.name}: {failure}") from None


def _check_file(name: str, taken: dict[object, str], tried: set[str]) -> None:
    path = name if is_stream(name) else os.path.realpath(name)
    identity = _identity(path)
    if os.path.isdir(path):
        raise Failure("cannot be written: it is a folder")
    if identity and not os.access(path, os.W_OK):
        raise PermissionError(errno.EACCES, os.strerror(errno.EACCES))
    if identity in taken:
        raise Failure(f"cannot be written: it is the input {taken[identity]}")
    if not is_stream(name):
        if not os.path.isdir(os.path.dirname(path)):
            raise Failure(f"there is no folder {os.path.dirname(path)}")
        _try_folder(os.path.dirname(path), tried)


def _check_folder(output: OutputName, taken: dict[object, str], tried: set[str]) -> None:
    folder = output.folder
    # A link to nothing is no folder, either.
    while folder and not _identity(folder) and not os.path.islink(folder):
        folder = os.path.dirname(folder)
    _try_folder(folder or ".", tried)
    for name in os.listdir(output.folder) if os.path.isdir(output.folder) else ():
        path = os.path.join(output.folder, name)
        if output.may_write(path) and _identity(path) in taken:
            raise Failure(f"cannot be written: {path} would be replaced, which is the input "
                          f"{taken[_identity(path)]}")


def _try_folder(folder: str, tried: set[str]) -> None:
    """Throw Failure unless files can be made in the folder, which only a trial shows."""
    if folder not in tried:
        if not os.path.isdir(folder):
            raise Failure(f"cannot be written: {folder} is no folder")
        try:
            with _hidden_folder(folder):
                tried.add(folder)
        except OSError as error:
            raise Failure(f"cannot be written ({error.strerror})") from None


def _check_others(output: OutputName, before: dict[object, OutputName]) -> None:
    """Throw Failure if one of the outputs before this one would write the same file."""
    if not is_stream(output.name):
        path = os.path.realpath(output.name)
        keys = [path, _identity(path) or path]
        # Two folders of surfaces may be one: the names of their files begin differently.
        same = [before[key] for key in keys if key in before
                and not output.form == before[key].form == "folder"]
        same += [other for other in before.values() if (other.folder and other.may_write(path))
                 or (output.folder and output.may_write(os.path.realpath(other.name)))]
        if same:
            raise Failure(f"cannot be written: {same[0].name} would take the same place")
        before.update(dict.fromkeys(keys, output))


def _identity(path: str) -> tuple[int, int] | None:
    """The same for all names of a file; None if there is none."""
    try:
        facts = os.stat(path)
    except (FileNotFoundError, NotADirectoryError):
        return None
    return facts.st_dev, facts.st_ino
