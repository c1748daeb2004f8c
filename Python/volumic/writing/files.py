# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Atomic writing of files. All functions raise OutputError, which names the file.

    with output_file("surface.stl") as path:     # in a hidden folder next to it
        write(path)

If the process is killed, either the old or the new file exists, never a part. Only then the hidden
folder .volumic-XXXXXX remains.
"""

from __future__ import annotations

import contextlib
import errno
import fnmatch
import glob
import os
import re
import shutil
import sys
import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

from ..errors import Failure, OutputError

HIDDEN = ".volumic-"  # prefix of the hidden folders


class Failures(list[str]):
    """Collects failures, so that the other files are still written."""

    @contextlib.contextmanager
    def collect(self) -> Iterator[None]:
        """Store a Failure raised in the block."""
        try:
            yield
        except Failure as failure:
            self.append(str(failure))

    def raise_all(self) -> None:
        """Raise Failure with one line per stored failure, if any."""
        if self:
            raise Failure("\n".join(self))


@contextlib.contextmanager
def output_folder(folder: str | os.PathLike[str]) -> Iterator[str]:
    """Return a folder whose files are moved to `folder` at the end."""
    with created_folder(folder), _prefix_errors(folder), _hidden_folder(folder) as hidden:
        yield hidden
        _publish(hidden, folder)


@contextlib.contextmanager
def output_file(name: str | os.PathLike[str]) -> Iterator[str]:
    """Return the path to write a file to. The name is prepended to a Failure of the block. Links
    are followed. Devices and pipes get the complete file at the end. Files in a subfolder next to
    the path are moved, too."""
    stream = is_stream(name)
    folder, base = os.path.split(name if stream else os.path.realpath(name))
    with _prefix_errors(name), \
            _hidden_folder(tempfile.gettempdir() if stream else folder) as hidden:
        path = os.path.join(hidden, base)
        yield path
        os.stat(path)  # another process may have removed it
        if not stream:
            _publish(hidden, folder)
        else:
            with open(path, "rb") as source, open(name, "ab") as target:
                shutil.copyfileobj(source, target)


def replace_file(name: str | os.PathLike[str], content: bytes) -> None:
    """Write a file. Try again if tasks.Job.finish() of another process removed the hidden folder."""
    for is_last in (False, True):
        try:
            with output_file(name) as path:
                Path(path).write_bytes(content)
            return
        except OutputError as error:
            if is_last or error.errno != errno.ENOENT:
                raise


def write_text(text: str, name: str) -> None:
    """Write a text; `-` is the standard output. Bytes of file names that are not UTF-8 become the
    replacement character."""
    content = text.encode("utf-8", "surrogateescape").decode("utf-8", "replace").encode()
    if name != "-":
        replace_file(name, content)
        return
    with _prefix_errors("the standard output"):
        sys.stdout.buffer.write(content)
        sys.stdout.flush()


@contextlib.contextmanager
def created_folder(name: str | os.PathLike[str]) -> Iterator[None]:
    """Create a folder and its parents. At the end, remove those created here that are empty."""
    created = [path for path in _with_parents(name) if not os.path.lexists(path)]
    try:
        with _prefix_errors(name):
            os.makedirs(name, exist_ok=True)
        yield
    finally:
        with contextlib.suppress(OSError):
            for folder in created:
                folder.rmdir()


def _with_parents(name: str | os.PathLike[str]) -> list[Path]:
    folder = Path(os.path.abspath(name))
    return [folder, *folder.parents]


@contextlib.contextmanager
def _prefix_errors(name: str | os.PathLike[str]) -> Iterator[None]:
    """Convert errors to a one-line OutputError that begins with the name, without the hidden
    folder."""
    try:
        yield
    except (OSError, MemoryError, Failure) as error:
        text = re.sub(rf"\S*{re.escape(HIDDEN)}[^/]*/", "", str(error))
        if not isinstance(error, Failure):
            reason = getattr(error, "strerror", "not enough memory") or text
            text = f"cannot be written ({reason})"
        failure = OutputError(f"{os.fspath(name)}: {' '.join(text.split())}")
        failure.errno = getattr(error, "errno", None)
        raise failure from error


@contextlib.contextmanager
def _hidden_folder(folder: str | os.PathLike[str]) -> Iterator[str]:
    """Return a temporary folder in `folder`, so that files can be moved within one file system."""
    try:
        hidden = tempfile.mkdtemp(prefix=HIDDEN, dir=folder)
    except (FileNotFoundError, NotADirectoryError) as error:
        raise OSError(error.errno, f"there is no folder {folder}") from None
    except OSError as error:
        raise OSError(error.errno, f"the folder {folder}: {error.strerror}") from None
    try:
        yield hidden
    finally:
        shutil.rmtree(hidden, ignore_errors=True)


def _publish(hidden: str, folder: str | os.PathLike[str]) -> None:
    """Move all files to `folder` after fsync. Subfolders come first, as the other files refer to
    them. Owner and permissions of replaced files are kept if possible."""
    created = [path for path in Path(hidden).rglob("*") if path.is_file()]
    for path in created:
        with open(path, "rb") as file:
            os.fsync(file)
    for path in sorted(created, key=lambda path: path.parent == Path(hidden)):
        target = folder / path.relative_to(hidden)
        with contextlib.suppress(OSError):
            old = target.stat()
            path.chmod(old.st_mode & 0o777)
            os.chown(path, old.st_uid, old.st_gid)
        with created_folder(target.parent):
            os.replace(path, target)


def is_stream(name: str | os.PathLike[str]) -> bool:
    """Return whether a path is a device or a pipe, such as /dev/stdout."""
    path = os.path.abspath(name)
    return bool(re.match("/(proc|dev(?!/shm/))/", path)) or (
        os.path.exists(path) and not os.path.isfile(path) and not os.path.isdir(path))


class OutputName(NamedTuple):
    """An output of the command line."""
    name: str
    # `file`; `blocks`: a .vtm and the files STEM/STEM_*; `folder`: files PREFIX-*.vtp;
    # `label-folder`: files with names that are not known yet
    kind: str = "file"
    prefix: str = ""

    @property
    def file(self) -> str:
        """Path of the file; empty for folders."""
        return os.path.realpath(self.name) if self.kind in ("file", "blocks") else ""

    @property
    def folder(self) -> str:
        """Folder of an output with several files, otherwise empty."""
        return {"file": "", "blocks": os.path.splitext(self.file)[0]}.get(self.kind, self.name)

    def replaces(self, names: Sequence[str]) -> list[str]:
        """Return the files that would be replaced: the file itself, and files in the folder that
        exist or are among `names`."""
        found = [self.file] if self.file else []
        if self.folder:
            folder = os.path.realpath(self.folder)
            start = os.path.basename(folder) + "_" if self.file else self.prefix + "-"
            pattern = glob.escape(os.path.join(folder, start)) + "*.vtp"
            found += [*glob.glob(pattern), *fnmatch.filter(names, pattern)]
            found += [folder] * (folder in names)
        return found


def check_outputs(outputs: Sequence[OutputName], inputs: Sequence[str]) -> None:
    """Raise Failure, which names the output, if a folder or file is not writable, or a file is also
    an input or another output."""
    taken = {_identity(name): f"the input {name}" for name in inputs}
    names = [output.file for output in outputs]
    tried: set[str] = set()
    for output in outputs:
        if is_stream(output.name):
            continue
        with _prefix_errors(output.name):
            replaced = {_identity(path): path for path in output.replaces(names)}
            for file in filter(taken.get, replaced):
                which = "it" if replaced[file] == output.file else replaced[file]
                raise Failure(f"cannot be written: {which} is {taken[file]}")
            taken.update(dict.fromkeys(replaced, f"also the output {output.name}"))
            folders = {os.path.dirname(output.file)} if output.file else set()
            if output.folder:
                folders.add(str(next(filter(os.path.lexists, _with_parents(output.folder)))))
            for folder in folders - tried:
                with _hidden_folder(folder):
                    tried.add(folder)
            with contextlib.suppress(FileNotFoundError):  # other errors: rights, long names
                os.close(os.open(output.file, os.O_WRONLY))


def _identity(path: str) -> object:
    """Return a value that is equal for all names of a file."""
    try:
        return os.stat(path)[1:3]  # inode and device
    except OSError:
        return os.path.realpath(path)
