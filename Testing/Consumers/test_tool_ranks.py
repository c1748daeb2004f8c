# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""`mpirun -n N volumic`: the same files whatever N, and never one rank that waits for another.

VOLUMIC_MPIRUN names mpirun; it is empty where that, or VTK's MPI, is missing.
"""

import contextlib
import json
import os
import re
import shutil
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

    def refused_by_ranks(self, reason, status, *arguments):
        """All ranks end with this status, and one of them says why, in one line."""
        process = self.run_ranks(3, *arguments, status=status)
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
                yield process, [int(self.content(f"pid-{rank}")) for rank in range(ranks)]
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


class SurfaceTest(RanksTestCase):
    def read(self, name, reader_class=vtkXMLPolyDataReader):
        reader = reader_class()
        reader.SetFileName(self.path(name))
        reader.Update()
        return reader.GetOutput()

    def test_the_same_files_and_a_piece_for_each_rank(self):
        volume = self.ball_file()
        options = ["--iso", ISO, "--levels", 2]
        self.run_tool(volume, self.path("one.vtp"), *options)
        self.run_ranks(3, volume, self.path("a.vtp"), self.path("a.pvtp"), *options)
        self.assertEqual(self.content("one.vtp"), self.content("a.vtp"))
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
                ("unknown option", 2, [volume, output, "--nonsense"]),
                ("outside the range", 1, [volume, output, "--iso", 5000])):
            with self.subTest(reason):
                self.refused_by_ranks(reason, status, *arguments)
                self.assertFalse(os.path.exists(output))

    def running(self, ranks):
        """Of some seconds."""
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
                for number in ranks:
                    self.wait_for_end(number)


class LabelsTest(RanksTestCase):
    def map_file(self):
        """Of four quarters of a ball that meet, of 1, 2, 4 and 5, and of crumbs of 9."""
        z, y, x = np.mgrid[0:24, 0:24, 0:24]
        voxels = np.where((x - 12) ** 2 + (y - 12) ** 2 + (z - 12) ** 2 < 100,
                          1 + (x > 13) + 3 * (y > 10), 0)
        voxels[1, 1, 1] = 9
        return self.write(vtkXMLImageDataWriter(), "map.vti", make_image(voxels.astype("i2")))

    def files_in(self, folder):
        return {name: self.content(os.path.join(folder, name))
                for name in sorted(os.listdir(self.path(folder)))}

    def test_the_same_files_and_words_said_once(self):
        volume = self.map_file()
        names = self.write_bytes("names.json", b'{"1": "liver", "5": "spleen"}')
        options = ("--labels", "all", "--finest", 2, "--gap", 0.6, "--label-names", names)
        one = self.report(volume, self.path("1/"), *options)
        self.assertGreaterEqual(len(self.files_in("1")), 4)
        process = self.run_ranks(3, volume, self.path("3/"), self.path("all.vtm"), "--report",
                                 self.path("r.json"), *options)
        self.assertEqual(self.files_in("3"), self.files_in("1"))
        report = json.loads(self.content("r.json"))
        for row, expected in zip(report["labels"], one["labels"]):
            self.assertGreater(row["seconds"], 0)
            row["files"], row["seconds"] = expected["files"], expected["seconds"]
            self.assertEqual(row, expected)
        self.assertEqual(report["warnings"], one["warnings"])
        for said in ("map.vti: 24 x 24 x 24", "warning: No surface is left of Label 9",
                     " vertices"):
            self.assertEqual(process.stderr.count(said), 1, process.stderr)
        listed = self.run_ranks(3, volume, "--list-labels").stdout
        self.assertEqual(listed, self.run_tool(volume, "--list-labels").stdout)
        for reason, arguments in (("there is no label '7'", ["--labels", "7"]),
                                  ("--gap is 100", ["--labels", "1", "--gap", 100])):
            with self.subTest(reason):
                self.refused_by_ranks(reason, 1, volume, self.path("p/"), *arguments)
                self.assertFalse(os.path.exists(self.path("p")))

    def test_cancelled_by_a_signal_to_any_rank(self):
        # Of 64 cubes.
        z, y, x = np.mgrid[0:64, 0:64, 0:64]
        edges = np.minimum(np.minimum(x % 16, y % 16), z % 16)
        labels = np.where(edges > 2, 1 + x // 16 + 4 * (y // 16) + 16 * (z // 16), 0)
        volume = self.write(vtkXMLImageDataWriter(), "cubes.vti",
                            make_image(labels.astype("i2"), (1, 1, 1)))
        for rank in (0, 2):
            with self.subTest(rank), self.running_to(
                    r"Making surfaces: +[3-9]\d %.* of 64, Label", 3, volume,
                    self.path("cubes/"), "--labels", "all", "--threads", 1) as (process, ranks):
                os.kill(ranks[rank], signal.SIGUSR1)
                text = self.finish(process)
                self.assertEqual(process.returncode, 3, text)
                self.assertEqual(text.count("volumic: unfinished (cancelled)"), 1)
                written = os.listdir(self.path("cubes"))
                self.assertGreater(len(written), 5)
                self.assertLess(len(written), 64)
                shutil.rmtree(self.path("cubes"))


if __name__ == "__main__":
    if not MPIRUN:
        print("skipped: mpirun or VTK's MPI (VTK::ParallelMPI) is missing")
        sys.exit(SKIPPED)
    unittest.main()
