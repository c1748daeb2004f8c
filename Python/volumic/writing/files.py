# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Files that are complete or not there.

    with output_file("surface.stl") as path:     # in a hidden folder beside it
        write(path)

Whenever the process is killed, the old file or the new one is there, never a part of one. A killed
process leaves the hidden folder (.volumic-XXXXXX). In all other cases the folder is removed.
"""

from __future__ import annotations

import contextlib
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

from ..errors import Failure

HIDDEN = ".volumic-"  # prefix of the hidden folders


class Failures(list[str]):
    """Collects failures, so that one file that cannot be written does not stop the others."""

    @contextlib.contextmanager
    def collect(self) -> Iterator[None]:
        """Keep the Failure of the block."""
        try:
            yield
        except Failure as failure:
            self.append(str(failure))

    def throw(self) -> None:
        """Throw Failure with a line for each failure, if there is one."""
        if self:
            raise Failure("\n".join(self))


# ---- Writing -----------------------------------------------------------------------------------

@contextlib.contextmanager
def output_file(name: str) -> Iterator[str]:
    """Return the path to write a file to. Throw Failure that names the file if it cannot be
    written. A Failure of the block gets the name in front."""
    with _naming(name), beside(name) as path:
        yield path


@contextlib.contextmanager
def output_folder(folder: str) -> Iterator[str]:
    """Return the folder to write files to that are moved to `folder` together, see made_folder().
    Throw Failure that names the folder."""
    with made_folder(folder), _naming(folder), _hidden_folder(folder) as hidden:
        yield hidden
        _publish(hidden, folder)


@contextlib.contextmanager
def beside(name: str | os.PathLike[str]) -> Iterator[str]:
    """Like output_file(), but OSError is not replaced. A link is followed. Devices and pipes get
    the whole file at the end. Files in a folder beside the path are moved, too."""
    stream = is_stream(name)
    folder, base = os.path.split(name if stream else os.path.realpath(name))
    with _hidden_folder(tempfile.gettempdir() if stream else folder) as hidden:
        path = os.path.join(hidden, base)
        yield path
        if not stream:
            _publish(hidden, folder)
        else:
            with open(path, "rb") as source, open(name, "ab") as target:
                shutil.copyfileobj(source, target)


def replace_file(name: str | os.PathLike[str], content: bytes) -> None:
    """Write a file. Throw OSError if it cannot be written."""
    with beside(name) as path:
        Path(path).write_bytes(content)


def write_text(text: str, name: str) -> None:
    """Write a text; `-` is the standard output. Bytes of file names that are not UTF-8 become the
    replacement character."""
    content = text.encode("utf-8", "surrogateescape").decode("utf-8", "replace").encode()
    with _naming("the standard output" if name == "-" else name):
        if name != "-":
            replace_file(name, content)
        else:
            sys.stdout.buffer.write(content)
            sys.stdout.flush()


@contextlib.contextmanager
def made_folder(name: str) -> Iterator[None]:
    """Make a folder and its parents. At the end remove those made here that are empty. Throw
    Failure that names the folder if it cannot be made."""
    made = [path for path in _with_parents(name) if not os.path.lexists(path)]
    try:
        with _naming(name):
            os.makedirs(name, exist_ok=True)
        yield
    finally:
        with contextlib.suppress(OSError):
            for folder in made:
                folder.rmdir()


def _with_parents(name: str) -> list[Path]:
    folder = Path(os.path.abspath(name))
    return [folder, *folder.parents]


@contextlib.contextmanager
def _naming(name: str) -> Iterator[None]:
    """Errors become a Failure on one line that begins with the name, without the hidden folder."""
    try:
        yield
    except (OSError, MemoryError, Failure) as error:
        text = re.sub(rf"\S*{re.escape(HIDDEN)}[^/]*/", "", str(error))
        if not isinstance(error, Failure):
            reason = getattr(error, "strerror", "not enough memory") or text
            text = f"cannot be written ({reason})"
        raise Failure(f"{name}: {' '.join(text.split())}") from error


@contextlib.contextmanager
def _hidden_folder(folder: str) -> Iterator[str]:
    """A folder in `folder`: moving files out of it stays within one file system."""
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


def _publish(hidden: str, folder: str) -> None:
    """Move all files to `folder` once they are on the disk. Those in subfolders come first, because
    the others name them. Files that are replaced pass on their owner and permissions, as far as
    allowed."""
    made = [path for path in Path(hidden).rglob("*") if path.is_file()]
    for path in made:
        with open(path, "rb") as file:
            os.fsync(file)
    for path in sorted(made, key=lambda path: path.parent == Path(hidden)):
        target = folder / path.relative_to(hidden)
        target.parent.mkdir(exist_ok=True)
        with contextlib.suppress(OSError):
            old = target.stat()
            path.chmod(old.st_mode & 0o777)
            os.chown(path, old.st_uid, old.st_gid)
        os.replace(path, target)


def is_stream(name: str | os.PathLike[str]) -> bool:
    """Return whether this is a device or a pipe, such as /dev/stdout."""
    path = os.path.abspath(name)
    return bool(re.match("/(proc|dev(?!/shm/))/", path)) or (
        os.path.exists(path) and not os.path.isfile(path) and not os.path.isdir(path))


# ---- Before the work begins --------------------------------------------------------------------

class OutputName(NamedTuple):
    """An output, as the command line names it."""
    name: str
    form: str = "file"  # `blocks`: a .vtm, and STEM/STEM_... beside it; `folder`: of files
    prefix: str = ""    # PREFIX-....vtp; `place`: a folder of files that are not known yet

    @property
    def file(self) -> str:
        """The path of the file of this name; empty for folders."""
        return os.path.realpath(self.name) if self.form in ("file", "blocks") else ""

    @property
    def folder(self) -> str:
        """The folder of an output of several files; empty for others."""
        return {"file": "", "blocks": os.path.splitext(self.file)[0]}.get(self.form, self.name)

    def replaces(self, names: Sequence[str]) -> list[str]:
        """Return the files that would be replaced: its own, and in the folder those that exist or
        are among `names`."""
        found = [self.file] if self.file else []
        if self.folder:
            folder = os.path.realpath(self.folder)
            start = os.path.basename(folder) + "_" if self.file else self.prefix + "-"
            pattern = glob.escape(os.path.join(folder, start)) + "*.vtp"
            found += [*glob.glob(pattern), *fnmatch.filter(names, pattern)]
            found += [folder] * (folder in names)
        return found


def check_outputs(outputs: Sequence[OutputName], inputs: Sequence[str]) -> None:
    """Throw Failure that names the output unless files can be made in all folders, no file is
    write-protected or a folder, and none is an input or another output, by whatever link."""
    taken = {_identity(name): f"the input {name}" for name in inputs}
    names = [output.file for output in outputs]
    tried: set[str] = set()
    for output in outputs:
        if is_stream(output.name):
            continue
        with _naming(output.name):
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
            if os.path.exists(output.file):
                open(output.file, "ab").close()


def _identity(path: str) -> object:
    """The same for all names of a file."""
    try:
        return os.stat(path)[1:3]  # inode and device
    except OSError:
        return os.path.realpath(path)
