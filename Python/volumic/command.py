# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
# PYTHON_ARGCOMPLETE_OK
"""The command `volumic`: from a volume to a closed surface. See `volumic --help`."""

from __future__ import annotations

import os
import sys
from argparse import Namespace
from collections.abc import Sequence

from . import messages, options as command_line
from .errors import Failure, UsageError
from .messages import Teller, one_line
from .option_tables import PROPERTIES, Filters

DONE, FAILED, WRONG_USAGE = 0, 1, 2


def main(words: Sequence[str] | None = None) -> int:
    """Do what a command line requests (default: that of the process); return the exit code."""
    words = sys.argv[1:] if words is None else words
    _complete()
    messages.catch_signals()
    teller, code = Teller(), FAILED
    try:
        options = command_line.parse(words)
        teller = Teller(options.quiet, options.progress)
        code = _run(options, teller)
        sys.stdout.flush()
        return code
    except UsageError as error:
        teller.error(f"{one_line(str(error))}\nTry 'volumic --help'.")
        return WRONG_USAGE
    except Failure as error:
        teller.error("\nvolumic: ".join(one_line(line) for line in str(error).splitlines()))
    except KeyboardInterrupt:
        teller.error("interrupted before there was a surface; nothing is written")
    except MemoryError:
        teller.error(f"{words[-1] if words else ''}: not enough memory; crop the volume, or "
                     "resample it to fewer voxels")
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())  # for the flush at the end
    except OSError as error:
        where = f"{error.filename}: " if error.filename else "the standard output: "
        teller.error(one_line(f"{where}{error.strerror or error}"))
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    return FAILED


def _run(options: Namespace, teller: Teller) -> int:
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
    # These properties decide on the levels of the pyramid.
    filters = Filters(bool(options.triangles) or any(
        command_line.has_property(options, name) for name in ("EdgeLength", "UpperValue")))
    command_line.apply(options, filters)
    if options.labels:
        from .segment_labels import segment_labels
        return segment_labels(options, filters, teller)
    from .segment import segment_volume
    return segment_volume(options, filters, teller)


def _use_own_threads(options: Namespace) -> None:
    """The threads are Volumic's own: VTK's would come on top of --threads. What VTK prints for
    objects that nobody observes goes nowhere."""
    for item, text in options.properties:
        if item.name == "NumberOfThreads" and text.isdigit() and int(text) > 0:
            os.environ["VTK_SMP_MAX_THREADS"] = text  # also for what has no such property
    from vtkmodules.vtkCommonCore import (
        vtkLogger, vtkOutputWindow, vtkSMPTools, vtkStringOutputWindow)
    vtkSMPTools.SetBackend("Sequential")
    vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_OFF)
    vtkOutputWindow.SetInstance(vtkStringOutputWindow())


def _complete() -> None:
    """Completion by the shell, where argcomplete is installed and asks for it."""
    if "_ARGCOMPLETE" in os.environ:
        import argcomplete
        argcomplete.autocomplete(command_line.make_parser())


if __name__ == "__main__":
    sys.exit(main())
