# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The errors that the command reports in one line."""


class Failure(Exception):
    """Something cannot be done. The message is one line that names the file or value at fault and
    says what to do; the command prints it and exits with code 1."""


class UsageError(Failure):
    """The command line is wrong. The command prints the message and exits with code 2."""


class VolumeError(Failure):
    """A volume, or a file that belongs to one, cannot be read."""


class Interrupted(Failure):
    """Ctrl-C, SIGTERM or the time limit ended the work before there was a result."""
