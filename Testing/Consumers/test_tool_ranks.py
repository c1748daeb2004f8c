# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""`mpirun -n N volumic`: the same files whatever N, and never one rank that waits for another.

VOLUMIC_MPIRUN names mpirun; it is empty where that, or VTK's MPI, is missing.
"""

import contextlib
import json
import os
import re
import resource
import shlex
import signal
import subprocess
import sys
import time
import unittest

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOImage import vtkPNGWriter
from vtkmodules.vtkIOXML import (
    vtkXMLImageDataWriter, vtkXMLPolyDataReader, vtkXMLPPolyDataReader)

from tool_test_case import CENTRE, ISO, ORIGIN, PROGRAM, SPACING, ToolTestCase, ball, make_image

MPIRUN = os.environ.get("VOLUMIC_MPIRUN", "")
SKIPPED = 77  # exit code

# Tells the number of each rank's process.
WRAPPER = """#!/bin/sh
rank=${OMPI_COMM_WORLD_RANK:-$PMI_RANK}
echo $$ > "$1/pid-$rank"
shift
exec "$@"
"""
# What its line `shift` may be instead.
FIRST_IS_LATE = """shift
[ "$rank" != 0 ] || sleep 2"""


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
                                 text=True, timeout=100, check=False)
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
                numbers = []
                for rank in range(ranks):
                    numbers.append(int(self.content(f"pid-{rank}")))
                yield process, numbers
            finally:
                if process.poll() is None:
                    process.kill()

    def finish(self, process):
        started = time.monotonic()
        text = process.communicate(timeout=60)[1]
        self.assertLess(time.monotonic() - started, 55)
        return text

    def wait_for_end(self, number):
        started = time.monotonic()
        while os.path.exists(f"/proc/{number}"):
            self.assertLess(time.monotonic() - started, 30, "a rank waits for one that is gone")
            time.sleep(0.1)


class SameFilesTest(RanksTestCase):
    """Files are the same, byte by byte, whatever the number of ranks."""

    def check_same(self, ranks, volume, *options, suffix="vtp"):
        one, many = self.path("one." + suffix), self.path("many." + suffix)
        self.run_tool(volume, one, *options)
        self.run_ranks(ranks, volume, many, *options)
        self.assertGreater(len(self.content(one)), 1000)
        self.assertEqual(self.content(one), self.content(many))

    def balls_file(self):
        """Two balls: cells have values that differ."""
        voxels = np.maximum(ball(), ball()[:, :, ::-1])
        return self.write(vtkXMLImageDataWriter(), "balls.vti", make_image(voxels))

    def test_by_number_of_ranks(self):
        for ranks in (1, 2, 4):
            with self.subTest(ranks):
                self.check_same(ranks, self.balls_file(), "--iso", 750.5, "--levels", 2)

    def test_more_ranks_than_blocks(self):
        """Most of them have nothing to do."""
        self.check_same(7, self.ball_file(), "--iso", ISO, "--levels", 1, suffix="stl")

    def test_formats_in_parts_and_whole(self):
        voxels = ball()
        header = (f"ObjectType = Image\nNDims = 3\nDimSize = 26 22 18\nElementType = MET_SHORT\n"
                  f"ElementSpacing = {' '.join(map(str, SPACING))}\n"
                  f"Offset = {' '.join(map(str, ORIGIN))}\n")
        raw = voxels.tobytes()
        parts = self.write_bytes("parts.mha", (header + "ElementDataFile = LOCAL\n").encode() + raw)
        head = (f"# vtk DataFile Version 3.0\n\nBINARY\nDATASET STRUCTURED_POINTS\n"
                f"DIMENSIONS 26 22 18\nSPACING {' '.join(map(str, SPACING))}\n"
                f"ORIGIN {' '.join(map(str, ORIGIN))}\nPOINT_DATA {voxels.size}\n"
                f"SCALARS density short\nLOOKUP_TABLE default\n")
        whole = self.write_bytes("whole.vtk", head.encode() + voxels.astype(">i2").tobytes())
        for volume in (parts, whole):
            with self.subTest(volume):
                self.check_same(3, volume, "--iso", ISO)
                self.check_same(4, volume, "--iso", ISO, "--edge-length", 1)
                self.check_same(2, volume)  # Otsu's threshold
                self.check_same(2, volume, "--iso", ISO, "--spacing", "1,1,1")

    def test_levels_that_ranks_share(self):
        """Of over 2^22 voxels, from a file that each reads a part of, and from one that rank 0 reads."""
        size = 170
        x = np.arange(size, dtype="f4") - size / 2
        away = np.sqrt(x[:, None, None] ** 2 + x[:, None] ** 2 + x ** 2)
        raw = np.clip(110 - away, 0, 255).astype("u1").tobytes()
        sizes = f"{size} {size} {size}\n"
        head = f"ObjectType = Image\nNDims = 3\nDimSize = {sizes}ElementType = MET_UCHAR\n"
        parts = self.write_bytes("parts.mha", (head + "ElementDataFile = LOCAL\n").encode() + raw)
        head = (f"# vtk DataFile Version 3.0\n\nBINARY\nDATASET STRUCTURED_POINTS\n"
                f"DIMENSIONS {sizes}SPACING 1 1 1\nORIGIN 0 0 0\nPOINT_DATA {size ** 3}\n"
                f"SCALARS density unsigned_char\nLOOKUP_TABLE default\n")
        whole = self.write_bytes("whole.vtk", head.encode() + raw)
        for volume, *options in ((parts, "--reduction-factor", 1.25), (whole,)):
            with self.subTest(volume):
                self.check_same(2, volume, "--iso", 60.5, "--levels", 3, *options)
        # Voxels and surfaces stay with the ranks for checkpoints, limits and edges of a length.
        for options in (["--scratch", self.folder], ["--memory", "900M"], ["--edge-length", 1.4],
                        ["--finest", -1]):
            with self.subTest(options[0]):
                self.check_same(2, parts, "--iso", 60.5, "--levels", 3, *options)
                process = self.run_ranks(2, parts, self.path("many.vtp"), "--iso", 60.5, *options)
                self.assertNotIn("warning", process.stderr)
        # What brings them to the first one is told once.
        process = self.run_ranks(2, parts, self.path("many.vtp"), "--iso", 60.5, "--levels", 3,
                                 "--reduction-factor", 1.25, "--snapshot-interval", 20)
        self.assertEqual(process.stderr.count("warning"), 2, process.stderr)
        for where, why in (("On level 2", "the surface starts there"),
                           ("From level 1 on", "--snapshot-interval is set")):
            self.assertIn(f"{where} the first process holds all voxels, and finds the surface "
                          f"alone, as {why}.", process.stderr)

    def test_what_is_given_beside_the_volume(self):
        volume = self.ball_file()
        centre = ORIGIN + SPACING * CENTRE
        self.write_bytes("seeds.csv", ",".join(map(str, centre)).encode())
        self.run_tool(volume, self.path("start.stl"), "--iso", ISO + 50)
        slopes = np.gradient(ball("f4"), *SPACING[::-1])
        steepness = np.sqrt(sum(np.square(slope) for slope in slopes))
        edges = self.write(vtkXMLImageDataWriter(), "edges.vti", make_image(steepness))
        for options in (["--seeds", self.path("seeds.csv")],
                        ["--initial-surface", self.path("start.stl")],
                        ["--attracting-points", self.path("seeds.csv")],
                        ["--edges", edges], ["--memory", "500M"]):
            with self.subTest(options[0]):
                self.check_same(2, volume, "--iso", ISO, "--levels", 1, *options)

    def test_report_levels_and_history(self):
        volume = self.balls_file()
        options = ["--iso", 700.5, "--levels", 2]
        reports, histories = [], []
        for name, run in (("one", self.run_tool),
                          ("two", lambda *arguments: self.run_ranks(2, *arguments))):
            output = run(volume, *options, "--report", "-", "--history", self.path(name + ".csv"),
                         "--levels-output", self.path(name)).stdout
            reports.append(json.loads(output))
            histories.append(np.genfromtxt(self.path(name + ".csv"), delimiter=",", names=True))
        one, two = reports
        self.assertEqual(len(two["memory"]["peak_by_rank"]), 2)
        for report in reports:
            for key in ("memory", "seconds"):
                report.pop(key)
            for level in report["levels"]:
                level.pop("seconds")
        self.assertEqual(one, two)
        columns = [name for name in histories[0].dtype.names if "Seconds" not in name]
        np.testing.assert_array_equal(histories[0][columns], histories[1][columns])
        for level in (0, 1):
            name = f"level-{level}.vtp"
            places = [self.read(os.path.join(folder, name)).GetPoints().GetData()
                      for folder in ("one", "two")]
            np.testing.assert_array_equal(*map(vtk_to_numpy, places))

    def read(self, name, reader_class=vtkXMLPolyDataReader):
        reader = reader_class()
        reader.SetFileName(self.path(name))
        reader.Update()
        return reader.GetOutput()

    def test_each_rank_writes_its_pieces(self):
        self.run_ranks(3, self.balls_file(), self.path("a.vtp"), self.path("a.pvtp"),
                       "--iso", 750.5, "--levels", 2, "--piece-size", 300)
        whole = self.read("a.vtp")
        names = os.listdir(self.path("a"))
        self.assertGreaterEqual(len(names), 3)
        self.assertEqual(self.content("a.pvtp").count(b"<Piece "), len(names))
        triangles = []
        for name in names:
            piece = self.read(os.path.join("a", name))
            self.assertLessEqual(piece.GetNumberOfPolys(), 300)
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


class FaultsTest(RanksTestCase):
    def test_refusals_are_said_once(self):
        volume, output = self.ball_file(), self.path("a.stl")
        for reason, status, arguments in (
                ("no such file", 1, [self.path("none.vti"), output]),
                ("unknown option", 2, [volume, output, "--nonsense"]),
                ("no surface format", 2, [volume, self.path("a.xyz")]),
                ("is not a number", 2, [volume, output, "--iso", "x"]),
                ("there is no folder", 1, [volume, self.path("none/a.stl")]),
                ("outside the range", 1, [volume, output, "--iso", 5000])):
            with self.subTest(reason):
                self.refused_by_ranks(3, reason, *arguments, status=status)
                self.assertFalse(os.path.exists(output))

    def refused_of_two(self, reason, first, second, status):
        """
        Two ranks with words of their own, each in a folder of its own, by a script: Debian 13's
        mpirun (Open MPI 5.0.7) ends by SIGSEGV at any `A : B`.
        """
        script = "case ${OMPI_COMM_WORLD_RANK:-$PMI_RANK} in\n"
        for rank, arguments in enumerate((first, second)):
            folder = self.path(f"rank-{rank}")
            os.makedirs(folder, exist_ok=True)
            words = shlex.join([PROGRAM, *map(str, arguments)])
            script += f"{rank}) cd {shlex.quote(folder)} && exec {words} ;;\n"
        self.write_bytes("two.sh", (script + "esac\n").encode())
        process = subprocess.run([MPIRUN, "-n", "2", "sh", self.path("two.sh")],
                                 capture_output=True, text=True, timeout=100, check=False)
        self.assertEqual(process.returncode, status, process.stdout + process.stderr)
        said = [line for line in process.stderr.splitlines() if line.startswith("volumic: ")]
        self.assertEqual(len(said), 1, process.stderr)
        self.assertRegex(said[0], reason)

    def test_ranks_with_other_options(self):
        volume, output = self.ball_file(), self.path("a.stl")
        usual = [volume, output, "--iso", ISO]
        for reason, second in (
                (f"rank 1: has '700' where the first rank has '{ISO}'", [*usual[:3], 700]),
                ("rank 1: has '--quiet' where the first rank has nothing more",
                 [*usual, "--quiet"]),
                ("rank 1: has nothing more where the first rank has '--iso'", usual[:2]),
                ("rank 1: unknown option --nonsense", [*usual, "--nonsense"]),
                ("rank 1: has '--version' where", ["--version"])):
            with self.subTest(reason):
                self.refused_of_two(reason, usual, second, 2)
                self.assertFalse(os.path.exists(output))

    def test_files_that_not_all_ranks_find(self):
        """Also those that the first alone reads, as without it nobody could tell."""
        for name in ("ball.vti", "ball.nrrd"):
            good = self.content(self.ball_file())
            os.makedirs(self.path("rank-0"), exist_ok=True)
            self.write_bytes(f"rank-0/{name}", good)
            words = [name, self.path("a.stl"), "--iso", ISO]
            with self.subTest(name):
                self.refused_of_two(f"rank 1: {name}: no such file", words, words, 1)
            os.makedirs(self.path("rank-1"), exist_ok=True)
            self.write_bytes(f"rank-1/{name}", good + b" ")
            with self.subTest(name + " of another size"):
                self.refused_of_two(f"rank 1: {name}: a file of {len(good) + 1} bytes", words,
                                    words, 1)

    def test_refusals_are_said_by_a_first_rank_that_is_late(self):
        """As on a busy machine: the other ranks do not leave before it has spoken."""
        self.write_bytes("wrapper.sh", WRAPPER.replace("shift", FIRST_IS_LATE).encode())
        self.refused_by_ranks(3, "unknown option", self.ball_file(), self.path("a.stl"),
                              "--nonsense", status=2)

    def test_a_part_that_cannot_be_read(self):
        """The last of the slices: the first rank reads others."""
        os.mkdir(self.path("slices"))
        for z, voxels in enumerate(ball()):
            self.write(vtkPNGWriter(), f"slices/{z:02}.png",
                       make_image(voxels[np.newaxis].astype("u2")))
        good = self.content("slices/17.png")
        self.run_ranks(4, self.path("slices"), self.path("a.stl"), "--iso", ISO)
        os.remove(self.path("a.stl"))
        self.write_bytes("slices/17.png", good[:len(good) // 2])
        self.refused_by_ranks(4, "17.png", self.path("slices"), self.path("a.stl"), "--iso", ISO)
        self.assertFalse(os.path.exists(self.path("a.stl")))


class StoppedTest(RanksTestCase):
    """A run of some seconds that is stopped from outside."""

    def setUp(self):
        super().setUp()
        rng = np.random.default_rng(7)
        values = rng.random((64, 64, 64))
        for axis in (0, 1, 2) * 2:
            values = (np.roll(values, 1, axis) + values + np.roll(values, -1, axis)) / 3
        self.volume = self.write(vtkXMLImageDataWriter(), "foam.vti",
                                 make_image((20000 * values).astype("i2"), (1, 1, 1)))
        self.iso = 20000 * np.median(values)

    def running(self, ranks):
        return self.running_to("Evolving the surface:  10 %", ranks, self.volume,
                               self.path("a.stl"), "--iso", self.iso)

    def test_cancelled_by_a_signal_to_any_rank(self):
        for rank, number in ((0, signal.SIGINT), (2, signal.SIGINT), (1, signal.SIGUSR1)):
            with self.subTest(rank), self.running(3) as (process, ranks):
                os.kill(ranks[rank], number)
                text = self.finish(process)
                self.assertEqual(process.returncode, 3, text)
                self.assertEqual(text.count("volumic: unfinished (cancelled)"), 1)
                self.assertTrue(os.path.exists(self.path("a.stl")))
                os.remove(self.path("a.stl"))

    def test_a_rank_that_gets_no_more_memory(self):
        """It says so and all end; or VTK ends the process, where even words have no room."""
        for rank in (0, 1):
            with self.subTest(rank), self.running(2) as (process, ranks):
                with open(f"/proc/{ranks[rank]}/statm", encoding="ascii") as file:
                    size = int(file.read().split()[0]) * resource.getpagesize() + (1 << 20)
                resource.prlimit(ranks[rank], resource.RLIMIT_AS, (size, size))
                text = self.finish(process)
                # The other ranks may need none but for their pieces at the end.
                is_whole = process.returncode == 0 and rank > 0
                self.assertTrue(is_whole or re.search("memory|bad_alloc|signal 6", text), text)
                self.assertEqual(os.path.exists(self.path("a.stl")), is_whole)
                with contextlib.suppress(FileNotFoundError):
                    os.remove(self.path("a.stl"))

    def test_a_rank_that_is_killed_ends_all(self):
        for rank in (0, 1):
            with self.subTest(rank), self.running(2) as (process, ranks):
                os.kill(ranks[rank], signal.SIGKILL)
                self.finish(process)
                self.assertNotEqual(process.returncode, 0)
                self.assertFalse(os.path.exists(self.path("a.stl")))
                for number in ranks:
                    self.wait_for_end(number)


class WithoutOthersTest(RanksTestCase):
    def test_words_are_said_once(self):
        self.assertEqual(self.run_ranks(3, "--version").stdout.count("volumic"), 1)
        self.assertEqual(self.run_ranks(2, "--help").stdout,
                         self.run_tool("--help").stdout)


if __name__ == "__main__":
    if not MPIRUN:
        print("skipped: mpirun or VTK's MPI (VTK::ParallelMPI) is missing")
        sys.exit(SKIPPED)
    unittest.main()
