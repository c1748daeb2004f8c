# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Full disks, for tests that need no rights: a process whose files may not grow further."""

import resource
import signal


def largest_file(size):
    """A preexec_fn of subprocess: writing beyond the size is an error there, as on a full disk."""
    def limit():
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))
    return limit
