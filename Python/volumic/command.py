# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
# PYTHON_ARGCOMPLETE_OK
"""The command `volumic`. See `volumic --help`."""

from __future__ import annotations

import os
import sys
from argparse import Namespace
from collections.abc import Sequence

from . import messages, options as command_line
from .errors import Failure, UsageError
from .messages import Console, one_line
from .option_tables import PROPERTIES, Filters

DONE, FAILED, WRONG_USAGE = 0, 1, 2


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command with `arguments` (default: those of the process). Return the exit code."""
    arguments = sys.argv[1:] if arguments is None else arguments
    console, code = Console(), FAILED
    try:
        messages.catch_signals()
        _complete()
        options = command_line.parse(arguments)
        console = Console(options.quiet, options.progress)
        code = _run(options, console)
        sys.stdout.flush()
        return code
    except UsageError as error:
        console.error(f"{one_line(str(error))}\nTry 'volumic --help'.")
        return WRONG_USAGE
    except Failure as error:
        text = command_line.with_file_name(str(error), options)
        console.error("\nvolumic: ".join(map(one_line, text.splitlines())))
    except KeyboardInterrupt:
        console.error("interrupted before a surface was computed; no surface was written")
    except MemoryError:
        console.error(f"{arguments[-1] if arguments else ''}: not enough memory; crop the volume "
                      "or resample it to fewer voxels")
    except BrokenPipeError:
        pass
    except OSError as error:
        where = f"{error.filename}: " if error.filename else "the standard output: "
        console.error(one_line(f"{where}{error.strerror or error}"))
    try:
        sys.stdout.flush()
    except OSError:  # Otherwise the flush at exit fails, with another exit code.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    return FAILED


def _run(options: Namespace, console: Console) -> int:
    _use_own_threads(options)
    if options.help or options.version or options.list_properties:
        filters = Filters()
        if options.help:
            print(command_line.make_parser(filters).format_help(), end="")
        elif options.version:
            from vtkmodules.vtkCommonCore import vtkVersion
            from . import __version__
            print(f"volumic {__version__} (VTK {vtkVersion.GetVTKVersion()})")
        else:
            for item in PROPERTIES:
                print(item.cls, item.name, f"--{item.option}", item.get(filters), sep="\t")
        return DONE
    if options.list_files or options.list_series:
        from . import reading
        print(*(reading.list_files(options.volume, options.choice) if options.list_files
                else reading.list_series(options.volume)), sep="\n")
        return DONE
    # vtkVolumeToSurface builds the pyramid that these properties require.
    filters = Filters(bool(options.triangles) or any(
        command_line.has_property(options, name) for name in ("EdgeLength", "UpperValue")))
    command_line.apply(options, filters)
    if options.labels:
        from .segment_labels import segment_labels
        return segment_labels(options, filters, console)
    from .segment import segment_volume
    return segment_volume(options, filters, console)


def _use_own_threads(options: Namespace) -> None:
    """Disable VTK's own threads, which would add to --threads, and VTK's log."""
    for item, text in options.properties:
        if item.name == "NumberOfThreads" and text.isdigit() and int(text) > 0:
            os.environ["VTK_SMP_MAX_THREADS"] = text  # for VTK filters without such a property
    from vtkmodules.vtkCommonCore import (
        vtkLogger, vtkOutputWindow, vtkSMPTools, vtkStringOutputWindow)
    vtkSMPTools.SetBackend("Sequential")
    vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_OFF)
    vtkOutputWindow.SetInstance(vtkStringOutputWindow())


def _complete() -> None:
    """Complete the command line for the shell if argcomplete requests it."""
    if "_ARGCOMPLETE" in os.environ:
        import argcomplete
        argcomplete.autocomplete(command_line.make_parser())


if __name__ == "__main__":
    sys.exit(main())
