# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""What the tests of the benchmarks share: running a script, its tables, its command line."""

import csv
import math
import os
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "Python"))
# pylint: disable=wrong-import-position
from folder_test_case import FolderTestCase, SharedFolderTestCase


def read_csv(path):
    with open(path, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def number(row, column):
    return float(row[column]) if row[column] else math.nan


class Benchmark:
    """A script of this folder, and the program that it runs."""

    def __init__(self, script, program):
        self.program = os.environ[program]
        self._command = [sys.executable, os.path.join(HERE, script), "--program", self.program]

    def run(self, *arguments, **options):
        return subprocess.run([*self._command, *arguments], capture_output=True, text=True,
                              timeout=250, check=False, **options)


class CommandLineTestCase(FolderTestCase):
    benchmark = None

    def check_refusals(self, *cases):
        """Arguments, in a line, and what is said of them."""
        for line, message in cases:
            with self.subTest(line):
                done = self.benchmark.run(*line.split())
                self.assertEqual(done.returncode, 2)
                self.assertIn(message, done.stderr)

    def check_help(self, names):
        done = self.benchmark.run("--help")
        self.assertEqual(done.returncode, 0)
        for name in names:
            self.assertIn(name, done.stdout)
