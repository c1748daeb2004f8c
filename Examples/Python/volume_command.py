# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The command `volumic`, which reads volumes for the scripts of this folder.

There is one reader of all formats, in C++ (Applications/volumic); these scripts have it write what
it has read as .vti, and go on from there.
"""

import functools
import importlib.util
import os
import shutil
import subprocess

from volume_image import VolumeError


@functools.lru_cache(maxsize=None)
def find_command():
    """The program of the same prefix as the Python package `volumic`, or the one on PATH."""
    package = importlib.util.find_spec("volumic")
    folder = os.path.dirname(package.origin) if package and package.origin else os.sep
    while folder != os.path.dirname(folder):
        folder = os.path.dirname(folder)
        program = os.path.join(folder, "bin", "volumic")
        if os.path.isfile(program) and os.access(program, os.X_OK):
            return program
    program = shutil.which("volumic")
    if program is None:
        raise VolumeError("the command volumic, which reads volumes, is found neither beside the"
                          " Python package volumic nor on PATH. Debian's package volumic has it;"
                          " where Volumic was installed into a prefix, set"
                          " PYTHONPATH=<prefix>/lib/python3/dist-packages")
    return program


def environment_of_one():
    """The environment without what mpirun tells its processes: a script on ranks has a command of
    its own on each, which must not take itself for the rank."""
    return {name: value for name, value in os.environ.items()
            if not name.startswith(("OMPI_COMM_", "PMIX_", "PMI_", "MV2_COMM_"))}


def run_command(*arguments):
    """What the command prints on its standard output; VolumeError with its message if it fails."""
    # Signals stay as Python has them: a limit on the sizes of files is an error, not the end.
    process = subprocess.run([find_command(), "--quiet", *arguments], capture_output=True,
                             check=False, text=True, errors="surrogateescape",
                             restore_signals=False, env=environment_of_one())
    if process.returncode != 0:
        message = process.stderr.strip().removeprefix("volumic: ").replace("\nvolumic: ", "; ")
        raise VolumeError(message or f"volumic ended with {process.returncode}")
    return process.stdout
