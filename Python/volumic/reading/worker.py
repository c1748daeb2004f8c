# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Run a function in a process of its own: VTK's XML readers, HDF5 and GDCM end the process on some
damaged files.

A new interpreter runs each call, as fork() is unsafe once VTK or BLAS have started threads, and
multiprocessing needs an importable main program, which pvpython and ParaView lack. A call takes
about 0.2 s: pass all files in one call. One nameless temporary file holds the request, then the
result, whose arrays are mapped into memory. The process ends with its caller.
"""
from __future__ import annotations

import ctypes
import importlib
import mmap
import os
import pickle
import shutil
import signal
import struct
import subprocess
import sys
import tempfile

from ..errors import Failure, VolumeError
from .volume import failure_of

_HEAD = 1024  # bytes: offset and size of the answer, then the item that is read
# A package without its __init__.py, which loads VTK and the filters.
_START = ("import sys, types; p = types.ModuleType('volumic'); p.__path__ = [%r]; "
          "sys.modules['volumic'] = p; from volumic.reading import worker; worker.serve(%d, %d)")


def in_worker(function, *arguments):
    """Return the result of a function, named "module:function", that runs in a new process.

    Throw VolumeError if it throws an exception or the process crashes. Arrays of the result must be
    contiguous to be mapped; others are copied."""
    with tempfile.TemporaryFile() as file:
        pickle.dump((function, arguments), file)
        file.flush()
        package = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
        environment = dict(os.environ, PYTHONPATH=os.pathsep.join(p for p in sys.path if p))
        code = _START % (package, file.fileno(), os.getpid())
        nowhere = dict.fromkeys(("stdin", "stdout", "stderr"), subprocess.DEVNULL)
        process = subprocess.Popen([_interpreter(), "-c", code], env=environment,
                                   pass_fds=[file.fileno()], **nowhere)
        try:
            process.wait()
        finally:  # also after an exception that a signal handler throws
            process.kill()
            process.wait()
        head = os.pread(file.fileno(), _HEAD, 0)
        offset, size = struct.unpack("<QQ", head[:16]) if process.returncode == 0 else (0, 0)
        if not size:
            item = head[16:].rstrip(b"\0").decode(errors="replace")
            raise VolumeError(item + (item and ": ") + "the library that reads it crashed: the file"
                              " is damaged; copy it again")
        view = memoryview(mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_COPY))
        result, spans = pickle.loads(view[offset:offset + size])
        result = pickle.loads(result, buffers=[view[a:b] for a, b in spans])
        if isinstance(result, Failure):
            raise result
        return result


def _interpreter():
    """Return the path of a Python interpreter, also in programs that embed Python."""
    name = "python%d.%d" % sys.version_info[:2]
    beside = [os.path.join(folder, each) for each in (name, "python3", "pvpython")
              for folder in (os.path.join(sys.exec_prefix, "bin"), os.path.dirname(sys.executable))]
    paths = [sys.executable] if os.path.basename(sys.executable).startswith("python") else []
    for path in paths + beside + [shutil.which(name), shutil.which("python3")]:
        if path and os.access(path, os.X_OK):
            return path
    raise VolumeError("there is no Python interpreter to read this format; install python3")


# ---- In the worker -----------------------------------------------------------------------------

_file = None
_words = None
_read = [0]  # bytes of _words that said() has returned


def serve(number, caller):
    """Run the function that the file of this descriptor names, and write its result there."""
    global _file, _words
    for each in (signal.SIGINT, signal.SIGTERM):
        signal.signal(each, signal.SIG_IGN)  # the caller ends this process
    ctypes.CDLL(None).prctl(1, signal.SIGKILL)  # PR_SET_PDEATHSIG
    if os.getppid() != caller:
        os._exit(1)  # it has ended meanwhile
    _file = open(number, "r+b")
    _words = tempfile.TemporaryFile()
    os.dup2(_words.fileno(), 1)
    os.dup2(_words.fileno(), 2)
    _file.seek(0)
    function, arguments = pickle.load(_file)
    _file.truncate(0)
    buffers = []
    try:
        module, name = function.split(":")
        result = getattr(importlib.import_module(module), name)(*arguments)
        data = pickle.dumps(result, protocol=5, buffer_callback=buffers.append)
        spans = _write(buffers)
    except Exception as error:  # pylint: disable=broad-except
        data, spans = pickle.dumps(failure_of(error)), []
    answer = pickle.dumps((data, spans))
    offset = _file.seek(0, os.SEEK_END) or _file.seek(_HEAD)
    _file.write(answer)
    _file.flush()
    os.pwrite(_file.fileno(), struct.pack("<QQ", offset, len(answer)), 0)
    os._exit(0)  # without destructors, which crash in some versions of libraries


def _write(buffers):
    """Write buffers to the file; return where each begins and ends."""
    spans, at = [], _HEAD
    for each in buffers:
        raw = each.raw()
        _file.seek(at)
        _file.write(raw)
        spans.append((at, at + raw.nbytes))
        at += -(-raw.nbytes // 64) * 64
    _file.flush()
    return spans


def reading(item):
    """Name the file or slice that the error of a crash names."""
    text = str(item).encode()[:_HEAD - 16]
    os.pwrite(_file.fileno(), text.ljust(_HEAD - 16, b"\0"), 16)


def said():
    """Return what libraries have written to the standard error and output since the last call."""
    sys.stdout.flush()
    text = os.pread(_words.fileno(), 1 << 20, _read[0])
    _read[0] += len(text)
    return text.decode(errors="replace")
