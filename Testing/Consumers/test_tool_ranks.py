# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""`mpirun -n N volumic`: the same files whatever N, and never one rank that waits for another.

VOLUMIC_MPIRUN names mpirun; it is empty where that, or VTK's MPI, is missing.
"""

import contextlib
import json
import os
import re
import signal
import subprocess
import sys
import time
import unittest

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import (
    vtkXMLImageDataWriter, vtkXMLPolyDataReader, vtkXMLPPolyDataReader)

from tool_test_case import ISO, PROGRAM, ToolTestCase, make_image

MPIRUN = os.environ.get("VOLUMIC_MPIRUN", "")
SKIPPED = 77  # exit code

# Tells the number of each rank's process.
WRAPPER = """#!/bin/sh
rank=${OMPI_COMM_WORLD_RANK:-$PMI_RANK}
echo $$ > "$1/pid-$rank"
shift
exec "$@"
"""


class RanksTestCase(ToolTestCase):
    def setUp(self):
        super().setUp()
        self.write_bytes("wrapper.sh", WRAPPER.encode())

    def command(self, ranks, *arguments):
        return [MPIRUN, "-n", str(ranks), "sh", self.path("wrapper.sh"), self.folder, PROGRAM,
                *map(str, arguments)]

    def run_ranks(self, ranks, *arguments, status=0):
        """The finished process; a test failure if it does not end, or with another status."""
        process = subprocess.run(self.command(ranks, *arguments), capture_output=True,
                                 text=True, timeout=900, check=False)
        self.assertEqual(process.returncode, status, process.stdout + process.stderr)
        return process

    def refused_by_ranks(self, ranks, reason, *arguments, status=1):
        """All ranks end with this status, and one of them says why, in one line."""
        process = self.run_ranks(ranks, *arguments, status=status)
        said = [line for line in process.stderr.splitlines()
                if re.match(f"volumic: .*(?:{reason})", line)]
        self.assertEqual(len(said), 1, process.stderr)
        self.assertNotIn("MPI_ABORT", process.stderr)

    @contextlib.contextmanager
    def running_to(self, begin, ranks, *arguments):
        """The process, and the numbers of its ranks, once a line begins like the pattern."""
        process = subprocess.Popen(
            self.command(ranks, *arguments, "--progress"),
            stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        with process:
            try:
                for line in process.stderr:
                    if re.match(begin, line):
                        break
                else:
                    self.fail(f"no line begins like {begin}")
                numbers = []
                for rank in range(ranks):
                    numbers.append(int(self.content(f"pid-{rank}")))
                yield process, numbers
            finally:
                if process.poll() is None:
                    process.kill()

    def finish(self, process):
        return process.communicate(timeout=600)[1]

    def wait_for_end(self, number):
        started = time.monotonic()
        while os.path.exists(f"/proc/{number}"):
            self.assertLess(time.monotonic() - started, 300, "a rank waits for one that is gone")
            time.sleep(0.1)


class SameFilesTest(RanksTestCase):
    def read(self, name, reader_class=vtkXMLPolyDataReader):
        reader = reader_class()
        reader.SetFileName(self.path(name))
        reader.Update()
        return reader.GetOutput()

    def test_the_same_files_and_a_piece_for_each_rank(self):
        volume = self.ball_file()
        options = ["--iso", ISO, "--levels", 2, "--report", "-"]
        one = json.loads(self.run_tool(volume, self.path("one.vtp"), *options).stdout)
        process = self.run_ranks(3, volume, self.path("a.vtp"), self.path("a.pvtp"), *options)
        many = json.loads(process.stdout)
        self.assertEqual(self.content("one.vtp"), self.content("a.vtp"))
        for report in (one, many):
            for key in ("memory", "seconds"):
                report.pop(key)
            for level in report["levels"]:
                level.pop("seconds")
        self.assertEqual(one, many)
        whole = self.read("a.vtp")
        names = os.listdir(self.path("a"))
        self.assertEqual(len(names), 3)
        triangles = []
        for name in names:
            piece = self.read(os.path.join("a", name))
            ids = vtk_to_numpy(piece.GetPointData().GetGlobalIds())
            np.testing.assert_array_equal(
                vtk_to_numpy(piece.GetPoints().GetData()),
                vtk_to_numpy(whole.GetPoints().GetData())[ids])
            triangles.append(ids[vtk_to_numpy(piece.GetPolys().GetConnectivityArray())])
        expected = vtk_to_numpy(whole.GetPolys().GetConnectivityArray())
        self.assertEqual(sorted(map(tuple, np.concatenate(triangles).reshape(-1, 3))),
                         sorted(map(tuple, expected.reshape(-1, 3))))
        joined = self.read("a.pvtp", vtkXMLPPolyDataReader)
        self.assertEqual(joined.GetNumberOfPolys(), whole.GetNumberOfPolys())

    def test_words_are_said_once(self):
        self.assertEqual(self.run_ranks(3, "--version").stdout.count("volumic"), 1)
        volume, output = self.ball_file(), self.path("b.stl")
        for reason, status, arguments in (
                ("no such file", 1, [self.path("none.vti"), output]),
                ("unknown option", 2, [volume, output, "--nonsense"]),
                ("outside the range", 1, [volume, output, "--iso", 5000])):
            with self.subTest(reason):
                self.refused_by_ranks(3, reason, *arguments, status=status)
                self.assertFalse(os.path.exists(output))


class StoppedTest(RanksTestCase):
    """A run of some seconds that is stopped from outside."""

    def running(self, ranks):
        rng = np.random.default_rng(7)
        values = rng.random((64, 64, 64))
        for axis in (0, 1, 2) * 2:
            values = (np.roll(values, 1, axis) + values + np.roll(values, -1, axis)) / 3
        volume = self.write(vtkXMLImageDataWriter(), "foam.vti",
                            make_image((20000 * values).astype("i2"), (1, 1, 1)))
        return self.running_to("Evolving the surface:  10 %", ranks, volume,
                               self.path("a.stl"), "--iso", 20000 * np.median(values))

    def test_cancelled_by_a_signal_to_any_rank(self):
        for rank, number in ((0, signal.SIGINT), (2, signal.SIGUSR1)):
            with self.subTest(rank), self.running(3) as (process, ranks):
                os.kill(ranks[rank], number)
                text = self.finish(process)
                self.assertEqual(process.returncode, 3, text)
                self.assertEqual(text.count("volumic: unfinished (cancelled)"), 1)
                self.assertTrue(os.path.exists(self.path("a.stl")))
                os.remove(self.path("a.stl"))

    def test_a_rank_that_is_killed_ends_all(self):
        for rank in (0, 1):
            with self.subTest(rank), self.running(2) as (process, ranks):
                os.kill(ranks[rank], signal.SIGKILL)
                self.finish(process)
                self.assertNotEqual(process.returncode, 0)
                # mpirun asks the first one to end, which may write what there is.
                self.assertTrue(rank == 1 or not os.path.exists(self.path("a.stl")))
                for number in ranks:
                    self.wait_for_end(number)


if __name__ == "__main__":
    if not MPIRUN:
        print("skipped: mpirun or VTK's MPI (VTK::ParallelMPI) is missing")
        sys.exit(SKIPPED)
    unittest.main()
