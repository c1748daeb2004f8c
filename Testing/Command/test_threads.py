# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Tests of the number of threads of the command. C++ tests have VTK's settings."""

import glob
import os
import statistics
import subprocess
import time

import numpy as np
from vtkmodules.vtkIOXML import vtkXMLImageDataWriter
from command_test_case import PROGRAM, CommandTestCase, make_image


def runnable_threads(process):
    """Return the number of threads of a process that run or wait for a processor."""
    runnable = 0
    for file in glob.glob(f"/proc/{process.pid}/task/*/stat"):
        try:
            with open(file, encoding="utf-8") as stat:
                runnable += stat.read().rpartition(")")[2].split()[0] == "R"
        except OSError:
            continue  # ended
    return runnable


class ThreadsTest(CommandTestCase):
    def threads_at_work(self, *arguments):
        """Return the most frequent number of runnable threads in the parallel part of a run. TBB
        limits the threads that work, but may wake one while another one goes to sleep."""
        command = [PROGRAM, *map(str, arguments)]
        samples = []
        with subprocess.Popen(command, stderr=subprocess.PIPE, text=True) as process:
            while process.poll() is None:
                samples.append(runnable_threads(process))
                time.sleep(0.005)
            self.assertEqual(process.returncode, 0, process.stderr.read())
        parallel = [number for number in samples if number > 1]
        return statistics.mode(parallel) if len(parallel) > len(samples) / 10 else 1

    def test_threads_of_a_surface_and_of_labels(self):
        z, y, x = np.mgrid[0:60, 0:60, 0:60] - 29.5
        waves = np.sin(x / 4) + np.sin(y / 4) + np.sin(z / 4)
        volume = self.write(vtkXMLImageDataWriter(), "waves.vti",
                            make_image(waves.astype("f4"), (1, 1, 1)))
        labels = self.many_labels(3)
        for asked in 1, 2:
            expected = min(asked, len(os.sched_getaffinity(0)))
            self.assertEqual(
                self.threads_at_work(volume, self.path("a.stl"), "--threads", asked), expected)
            # One more thread reports progress.
            at_work = self.threads_at_work(labels, self.path(f"labels{asked}"), "--labels", "all",
                                           "--threads", asked)
            self.assertIn(at_work, (expected, expected + 1))
