# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Writing files so that an older one is never lost for half of a new one.

    check_output("surface.stl", inputs=["scan.nii.gz"])    # before the work begins
    with beside("surface.stl") as path:                     # the same suffix, in a hidden folder
        write(path)
        check_size(path, 84 + 50 * triangles)

What is written beside its place is moved there when the block ends without an exception; whoever
looks finds the old file or the new one, whenever the script is killed. Most of VTK's writers don't
look whether the disk took what they wrote: hence the checks.
"""

import contextlib
import os
import shutil
import stat
import tempfile

from terminal import caught_output

PIECE = 1 << 20  # bytes at a time
PLY_BYTES = {"char": 1, "uchar": 1, "int8": 1, "uint8": 1, "short": 2, "ushort": 2, "int16": 2,
             "uint16": 2, "double": 8, "float64": 8}  # others have 4


def check_output(path, inputs=()):
    """OSError where the file cannot be written, or is one of the inputs by whatever name."""
    target = os.path.realpath(path)
    folder = os.path.dirname(target)
    if os.path.isdir(target):
        raise OSError(f"{path} cannot be written: it is a folder")
    if not os.path.isdir(folder):
        raise OSError(f"{os.path.dirname(path) or folder}: no such folder")
    if os.path.exists(target) and not os.access(target, os.W_OK):
        raise OSError(f"{path} cannot be written: it is write-protected")
    written = [target, *block_files(target)]
    for name in inputs:
        for old in written:
            if os.path.exists(old) and os.path.exists(name) and os.path.samefile(old, name):
                raise OSError(f"{path} cannot be written: it would replace the input {name}")
    if not is_stream(path):
        os.rmdir(hidden_folder(path, folder))


def block_files(path):
    """The files that are there of a .vtm: beside it, in the folder of its name."""
    stem, suffix = os.path.splitext(path)
    if suffix != ".vtm" or not os.path.isdir(stem):
        return []
    return [entry.path for entry in os.scandir(stem)]


@contextlib.contextmanager
def beside(path):
    """The path to write to; at the end it takes the place of `path`, with what lies beside it.

    A link is followed, and a file that is replaced hands its permissions down. Devices and pipes
    get a copy. OSError names the file.
    """
    target = os.path.realpath(path) if not is_stream(path) else path
    folder = tempfile.gettempdir() if is_stream(path) else os.path.dirname(target)
    hidden = hidden_folder(path, folder)
    try:
        yield os.path.join(hidden, os.path.basename(target))
        if is_stream(path):
            copy_to_stream(os.path.join(hidden, os.path.basename(target)), path)
        else:
            publish(hidden, folder)
    except OSError as error:
        raise OSError(f"{path} cannot be written ({error.strerror or error})") from error
    finally:
        shutil.rmtree(hidden, ignore_errors=True)


def write_with(writer, data, path, check):
    """Have a VTK writer write the data; check(path) looks whether the disk took all of it."""
    failures = []
    # With the data inline: ParaView 5.11's readers, with an expat of 2024 or later, take what is
    # appended for damaged. By way of a string, as VTK's writer ends the program on a full disk then.
    is_inline = writer.IsA("vtkXMLImageDataWriter") or writer.IsA("vtkXMLPolyDataWriter")
    if is_inline:
        writer.SetDataModeToBinary()
        writer.WriteToOutputStringOn()
    writer.AddObserver("ErrorEvent", lambda *_: failures.append(writer.GetErrorCode()))
    writer.SetInputData(data)
    with beside(path) as written, caught_output() as printed:
        writer.SetFileName(written)
        writer.Write()
        if failures or printed.GetOutput() or writer.GetErrorCode():
            raise OSError("is the disk full?")
        if is_inline:
            with open(written, "w", encoding="utf-8", newline="") as file:
                file.write(writer.GetOutputString())
        check(written)


def write_text(text, path):
    with beside(path) as written, open(written, "w", encoding="utf-8", newline="") as file:
        file.write(text)


def hidden_folder(path, folder):
    """Made in the folder, so that moving out of it stays within one file system."""
    try:
        return tempfile.mkdtemp(prefix=".volumic-", dir=folder)
    except OSError as error:
        raise OSError(f"{path} cannot be written (the folder {folder}: {error.strerror})"
                      ) from error


def is_stream(path):
    """Whether this is a device or a pipe, such as /dev/stdout, rather than a file."""
    absolute = os.path.abspath(path)
    return (absolute.startswith(("/dev/", "/proc/")) and not absolute.startswith("/dev/shm/")
            or os.path.exists(path) and not os.path.isfile(path) and not os.path.isdir(path))


def copy_to_stream(path, stream):
    with open(path, "rb") as source, open(stream, "ab") as target:
        shutil.copyfileobj(source, target)


def publish(hidden, folder):
    """Have all files on the disk, then move them, the one that names the others at last."""
    names = [os.path.relpath(os.path.join(place, name), hidden)
             for place, _, files in os.walk(hidden) for name in files]
    for name in names:
        with open(os.path.join(hidden, name), "rb") as file:
            os.fsync(file.fileno())
    for name in sorted(names, key=lambda name: (os.path.dirname(name) == "", name)):
        target = os.path.join(folder, name)
        os.makedirs(os.path.dirname(target), exist_ok=True)
        inherit_permissions(os.path.join(hidden, name), target)
        os.replace(os.path.join(hidden, name), target)
    with contextlib.suppress(OSError):
        descriptor = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(descriptor)
        finally:
            os.close(descriptor)


def inherit_permissions(path, old):
    with contextlib.suppress(FileNotFoundError):
        facts = os.stat(old)
        with contextlib.suppress(OSError):
            os.chown(path, facts.st_uid, facts.st_gid)
        os.chmod(path, stat.S_IMODE(facts.st_mode) & 0o777)


def check_size(path, size):
    """OSError unless the file has this many bytes."""
    there = os.path.getsize(path) if os.path.exists(path) else 0
    if there != size:
        raise OSError(f"{there} of {size} bytes were; is the disk full?")


def check_lines(path, least):
    """OSError unless the file ends with a complete line and has no fewer than this many."""
    lines, last = 0, b""
    with open(path, "rb") as file:
        for piece in iter(lambda: file.read(PIECE), b""):
            lines, last = lines + piece.count(b"\n"), piece[-1:]
    if lines < least or last != b"\n":
        raise OSError(f"{lines} of {least} lines were; is the disk full?")


def check_end(path, end):
    """OSError unless the file, or each one in the folder, ends with these bytes or nearly so."""
    if os.path.isdir(path):
        for entry in os.scandir(path):
            check_end(entry.path, end)
        return
    with open(path, "rb") as file:
        size = file.seek(0, os.SEEK_END)
        file.seek(max(0, size - len(end) - 8))
        if end not in file.read():
            raise OSError(f"only {size} bytes of it were; is the disk full?")


def check_ply(path):
    """OSError unless the binary .ply has all that its head tells of; its lists are triangles."""
    count = size = 0
    with open(path, "rb") as file:
        for line in iter(file.readline, b""):
            words = line.decode("latin-1").split()
            if words[:1] == ["end_header"]:
                break
            if words[:1] == ["element"]:
                count = int(words[2])
            elif words[:2] == ["property", "list"]:
                size += count * (PLY_BYTES.get(words[2], 4) + 3 * PLY_BYTES.get(words[3], 4))
            elif words[:1] == ["property"]:
                size += count * PLY_BYTES.get(words[1], 4)
        check_size(path, file.tell() + size)
