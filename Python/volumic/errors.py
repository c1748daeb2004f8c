# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Errors that the command reports in one line."""


class Failure(Exception):
    """An operation failed. The message is one line that names the file or value at fault and says
    how to fix it. The command prints it and exits with code 1."""


class UsageError(Failure):
    """Wrong command line. The command prints the message and exits with code 2."""


class VolumeError(Failure):
    """A volume, or a file that belongs to it, cannot be read."""


class OutputError(Failure, OSError):
    """A file cannot be written. The message names it."""


class Interrupted(Failure):
    """Ctrl-C, SIGTERM or the time limit stopped the run before it had a result."""
