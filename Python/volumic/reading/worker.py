# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Run a function in a separate process, as VTK's XML readers, HDF5 and GDCM crash on some damaged
files.

Each call starts a new interpreter: fork() is unsafe once VTK or BLAS have started threads, and
multiprocessing requires an importable main program, which pvpython and ParaView lack. A call takes
about 0.2 s, so pass all files in one call. An unnamed temporary file holds the request and then the
result, whose arrays are memory-mapped. The process ends with its caller.
"""
from __future__ import annotations

import ctypes
import errno
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

_HEAD = 1024  # bytes: offset and size of the result, then the current item
# The package without its __init__.py, which loads VTK and the filters.
_START = ("import sys, types; p = types.ModuleType('volumic'); p.__path__ = [%r]; "
          "sys.modules['volumic'] = p; from volumic.reading import worker; worker.serve(%d, %d)")


def in_worker(function, *arguments):
    """Return the result of a function "module:function" that runs in a new process. Raise
    VolumeError if it raises an exception or crashes. Contiguous arrays of the result are
    memory-mapped."""
    with tempfile.TemporaryFile() as file:
        pickle.dump((function, arguments), file)
        file.flush()
        package = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
        environment = dict(os.environ, PYTHONPATH=os.pathsep.join(p for p in sys.path if p))
        code = _START % (package, file.fileno(), os.getpid())
        streams = dict.fromkeys(("stdin", "stdout", "stderr"), subprocess.DEVNULL)
        process = subprocess.Popen([_interpreter(), "-c", code], env=environment,
                                   pass_fds=[file.fileno()], **streams)
        try:
            process.wait()
        finally:  # also after an exception of a signal handler
            process.kill()
            process.wait()
        head = os.pread(file.fileno(), _HEAD, 0)
        offset, size = struct.unpack("<QQ", head[:16]) if process.returncode == 0 else (0, 0)
        if not size:
            item = head[16:].rstrip(b"\0").decode(errors="replace")
            raise VolumeError(item + (item and ": ") + "the library that reads this file crashed: "
                              "the file is damaged; copy it again")
        view = memoryview(mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_COPY))
        result, spans = pickle.loads(view[offset:offset + size])
        result = pickle.loads(result, buffers=[view[a:b] for a, b in spans])
        if isinstance(result, Failure):
            raise result
        return result


def _interpreter():
    """Return the path of a Python interpreter, also in programs that embed Python."""
    name = "python%d.%d" % sys.version_info[:2]
    others = [os.path.join(folder, each) for each in (name, "python3", "pvpython")
              for folder in (os.path.join(sys.exec_prefix, "bin"), os.path.dirname(sys.executable))]
    paths = [sys.executable] if os.path.basename(sys.executable).startswith("python") else []
    for path in paths + others + [shutil.which(name), shutil.which("python3")]:
        if path and os.access(path, os.X_OK):
            return path
    raise VolumeError("this format requires a Python interpreter; install python3")


# ---- In the worker -----------------------------------------------------------------------------

_file = None
_output = None
_read = [0]  # number of bytes of _output that were returned


def serve(number, caller):
    """Run the function that the file of this descriptor specifies, and write its result there."""
    global _file, _output
    for each in (signal.SIGINT, signal.SIGTERM):
        signal.signal(each, signal.SIG_IGN)  # the caller ends this process
    ctypes.CDLL(None).prctl(1, signal.SIGKILL)  # PR_SET_PDEATHSIG
    if os.getppid() != caller:
        os._exit(1)  # the caller has ended
    _file = open(number, "r+b")
    _output = tempfile.TemporaryFile()
    os.dup2(_output.fileno(), 1)
    os.dup2(_output.fileno(), 2)
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
        os.ftruncate(number, _HEAD)
        failed, _file = _file, open(number, "r+b", closefd=False)  # its end would write the rest
        if getattr(error, "errno", 0) in (errno.ENOSPC, errno.EDQUOT, errno.EFBIG):
            error.filename = tempfile.gettempdir()
        data, spans = pickle.dumps(failure_of(error)), []
    result_data = pickle.dumps((data, spans))
    offset = _file.seek(0, os.SEEK_END) or _file.seek(_HEAD)
    _file.write(result_data)
    _file.flush()
    os.pwrite(_file.fileno(), struct.pack("<QQ", offset, len(result_data)), 0)
    os._exit(0)  # skips destructors, which crash in some versions of libraries


def _write(buffers):
    """Write buffers to the file and return their ranges."""
    spans, at = [], _HEAD
    for each in buffers:
        raw = each.raw()
        _file.seek(at)
        _file.write(raw)
        spans.append((at, at + raw.nbytes))
        at += -(-raw.nbytes // 64) * 64
    _file.flush()
    return spans


def set_current_item(item):
    """Set the file or slice that is reported after a crash."""
    os.pwrite(_file.fileno(), str(item).encode()[:_HEAD - 16].ljust(_HEAD - 16, b"\0"), 16)


def captured_output():
    """Return the output of libraries on stdout and stderr since the last call."""
    sys.stdout.flush()
    text = os.pread(_output.fileno(), 1 << 20, _read[0])
    _read[0] += len(text)
    return text.decode(errors="replace")
