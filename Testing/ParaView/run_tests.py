# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Run the tests of several scripts in one process, because starting ParaView takes long:

    pvpython run_tests.py [--screen] SCRIPT[.CLASS[.TEST]] ...

Scripts are named without .py. With --screen the tests need an X server, and are skipped without one.
"""

import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import plugin_testing as testing


def main(*names):
    if names[0] == "--screen":
        import view_testing  # pylint: disable=import-outside-toplevel
        view_testing.open_screen()
        names = names[1:]
    testing.main(*names)


main(*sys.argv[1:])
