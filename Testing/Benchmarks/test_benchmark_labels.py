# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause

"""benchmark_labels.py on small shapes and maps: its tables are whole and its figures make sense.

Nothing here depends on how fast the machine is. VOLUMIC_BENCHMARK_LABELS names the program.
"""

import math
import os
import struct
import subprocess
import unittest

from benchmark_test_case import (
    Benchmark, CommandLineTestCase, FolderTestCase, SharedFolderTestCase, number, read_csv)

BENCHMARK = Benchmark("benchmark_labels.py", "VOLUMIC_BENCHMARK_LABELS")
OURS = ["us", "us-gap", "us-alone"]
PEERS = ["windowed", "windowed-more", "remeshed"]  # nets and antialiased are not in all builds


def write_map(path, size, value):
    """A .vti with 16-bit voxels; `value(x, y, z)`."""
    voxels = [value(x, y, z) for z in range(size) for y in range(size) for x in range(size)]
    data = struct.pack(f"<I{len(voxels)}h", 2 * len(voxels), *voxels)
    extent = f"0 {size - 1} " * 3
    with open(path, "wb") as file:
        file.write(f"""<?xml version="1.0"?>
<VTKFile type="ImageData" version="0.1" byte_order="LittleEndian">
<ImageData WholeExtent="{extent}" Origin="0 0 0" Spacing="1 1 1"><Piece Extent="{extent}">
<PointData Scalars="Labels">
<DataArray type="Int16" Name="Labels" format="appended" offset="0"/>
</PointData></Piece></ImageData><AppendedData encoding="raw">
_""".encode())
        file.write(data)
        file.write(b"\n</AppendedData></VTKFile>\n")


class Shapes(SharedFolderTestCase):
    """Two balls that touch, looked at from all sides."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        done = BENCHMARK.run("--shapes", "TouchingBalls", "--sizes", "40", "--stretches", "1",
                             "--csv", cls.path("balls.csv"))
        if done.returncode != 0:
            raise AssertionError(done.stdout + done.stderr)
        cls.rows = read_csv(cls.path("balls.csv"))
        cls.targets = read_csv(cls.path("balls-targets.csv"))

    def of(self, name):
        return [row for row in self.rows if row["Run"] == name and row["Label"] != "all"]

    def test_all_runs_have_a_row_for_each_label(self):
        for name in OURS + PEERS:
            self.assertEqual([row["Label"] for row in self.of(name)], ["1", "2"], name)
        self.assertEqual([row["Failure"] for row in self.rows if row["Failure"]], [])

    def test_all_find_the_balls(self):
        for name in OURS + PEERS:
            for row, radius in zip(self.of(name), (14.1, 10.9)):
                with self.subTest(run=name, label=row["Label"]):
                    # Voxels of the ball, of 64 units along 40 voxels.
                    expected = 4.0 / 3.0 * math.pi * (radius * 40 / 64) ** 3
                    self.assertAlmostEqual(number(row, "LabelVoxels") / expected, 1.0, delta=0.02)
                    self.assertEqual(row["Components"], "1")
                    self.assertEqual(row["OpenEdges"], "0")
                    self.assertLess(number(row, "DistanceAtVertices"), 0.25)
                    self.assertLess(number(row, "NormalAngle"), 15.0)
                    self.assertAlmostEqual(number(row, "VolumeError"), 0.0, delta=0.12)
                    self.assertLessEqual(number(row, "DihedralMedian"), number(row, "Dihedral95"))
                    self.assertLessEqual(number(row, "Dihedral95"), number(row, "DihedralLargest"))

    def test_only_we_have_no_crossings_and_tell_wrong_voxels(self):
        for name in OURS:
            for row in self.of(name):
                self.assertEqual(row["SelfIntersections"], "0")
                if name != "us-alone":
                    wrong = number(row, "VoxelsOutside") + number(row, "VoxelsInside")
                    self.assertEqual(number(row, "ReportedWrong"), wrong)
        for name in PEERS:
            for row in self.of(name):
                self.assertEqual(row["ReportedWrong"], "")

    def test_a_gap_takes_volume(self):
        for plain, drawn_back in zip(self.of("us"), self.of("us-gap")):
            self.assertLess(number(drawn_back, "VolumeError"), number(plain, "VolumeError") - 0.01)

    def test_the_peer_is_remeshed_to_our_edges(self):
        for ours, peer in zip(self.of("us"), self.of("remeshed")):
            self.assertAlmostEqual(
                number(peer, "EdgeMean") / number(ours, "EdgeMean"), 1.0, delta=0.15)

    def test_all_together_have_costs_and_overlaps(self):
        rows = [row for row in self.rows if row["Label"] == "all"]
        self.assertEqual([row["Run"] for row in rows], ["us", "us-gap"])
        for row in rows:
            self.assertGreater(number(row, "ProcessorSeconds"), 0.0)
            self.assertGreater(number(row, "PeakMegabytes"), 1.0)
            self.assertEqual(row["OverlapPairs"], "1")

    def test_targets_are_those_of_the_rows(self):
        rows = {row["what"].split(":")[0]: row for row in self.targets}
        worst = max(number(row, "DistanceAtVertices") for row in self.of("us"))
        found = rows["distance at vertices, voxels"]
        self.assertAlmostEqual(float(found["figure"]), worst, delta=0.01 * worst)
        self.assertEqual(found["verdict"], "reached" if worst <= 0.1 else "missed")
        least = min(number(row, "RatioMean") for row in self.of("us"))
        self.assertAlmostEqual(float(rows["radius ratio mean"]["figure"]), least, delta=0.002)
        ratio = (sum(number(row, "ProcessorSeconds") for row in self.of("us-alone"))
                 / sum(number(row, "ProcessorSeconds") for row in self.of("remeshed")))
        found = rows["us-alone / remeshed, processor seconds of all"]
        self.assertAlmostEqual(float(found["figure"]), ratio, delta=0.01 * ratio)


class Maps(FolderTestCase):
    def setUp(self):
        super().setUp()
        self.map = self.path("map.vti")

    def rows(self, *arguments):
        """Of the table, and what was printed."""
        done = BENCHMARK.run(*arguments, "--csv", self.path("map.csv"))
        self.assertEqual(done.returncode, 0, done.stderr)
        return read_csv(self.path("map.csv")), done.stdout

    @staticmethod
    def boxes(x, y, z):
        """5 and 9 side by side, 7 of a few voxels only."""
        if 4 <= y < 16 and 4 <= z < 16 and 4 <= x < 20:
            return 5 if x < 12 else 9
        return 7 if x < 2 and y < 2 and z < 2 else 0

    def test_labels_of_a_file(self):
        write_map(self.map, 24, self.boxes)
        rows, printed = self.rows("--map", self.map, "--runs", "us,windowed")
        self.assertIn("2 labels; 1 smaller ones left out", printed)
        self.assertEqual([(row["Run"], row["Label"]) for row in rows],
                         [("us", "all"), ("us", "5"), ("us", "9"),
                          ("windowed", "5"), ("windowed", "9")])
        for row in rows[1:]:
            self.assertEqual(row["LabelVoxels"], str(8 * 12 * 12))
            self.assertEqual(row["DistanceAtVertices"], "")  # nobody knows what it was
        self.assertEqual(rows[0]["OverlapPairs"], "1")

    def test_all_as_a_mask(self):
        write_map(self.map, 24, self.boxes)
        rows, _ = self.rows("--map", self.map, "--mask", "--runs", "windowed")
        self.assertEqual([row["LabelVoxels"] for row in rows], [str(16 * 12 * 12 + 8)])

    def test_labels_of_a_scan(self):
        write_map(self.map, 24, lambda *place: 100 * self.boxes(*place))
        rows, _ = self.rows("--scan", self.map, "--thresholds", "450,800", "--runs", "windowed")
        counts = [number(row, "LabelVoxels") for row in rows]
        self.assertEqual(len(counts), 2)  # the corner is too small
        for count in counts:  # the median takes edges away
            self.assertAlmostEqual(count / (8 * 12 * 12), 1.0, delta=0.1)

    def test_a_body(self):
        rows, _ = self.rows("--body", "64,64,48", "--body-labels", "5", "--least", "20", "--runs",
                            "us")
        self.assertGreater(len(rows), 3)

    def test_what_is_no_label_map_is_told(self):
        done = BENCHMARK.run("--map", self.write_bytes("map.vti", b"nonsense"))
        self.assertEqual(done.returncode, 1)
        self.assertIn("not a readable volume", done.stderr)


class CommandLine(CommandLineTestCase):
    benchmark = BENCHMARK

    def test_what_is_wrong_is_told(self):
        self.check_refusals(
            ("--shapes Cube", "there are Sphere"), ("--sizes 8", "at least 32"),
            ("--stretches 0.5", "--stretches"), ("--runs us,nobody", "nobody"),
            ("--scan scan.vti", "--thresholds"), ("--map map.vti --body 64,64,64", "alone"),
            ("--body 64", "three numbers"), ("--mask", "--map"),
            ("--threads 1,2", "one whole number"), ("--csv", "expected one argument"),
            ("--body 48,48,48 --body-labels 2 --labels 77", "none of these labels"),
            ("--frobnicate", "--frobnicate"))

    def test_a_program_that_is_killed_is_told(self):
        program = self.write_text(
            "program", '#!/bin/sh\nprintf "@row a\\t1\\tus\\n@number Triangles 8\\n"\nkill -9 $$\n')
        os.chmod(program, 0o755)
        done = BENCHMARK.run("--program", program, "--csv", self.path("runs.csv"))
        rows = read_csv(self.path("runs.csv"))
        self.assertEqual(done.returncode, 1)
        self.assertIn("has failed (Killed); it told 1 rows", done.stderr)
        self.assertEqual([number(row, "Triangles") for row in rows], [8])

    def test_the_program_names_what_is_no_option(self):
        for arguments in (["--frobnicate", "1"], ["--map"]):
            done = subprocess.run([BENCHMARK.program, *arguments], capture_output=True, text=True,
                                  check=False)
            self.assertEqual(done.returncode, 2)
            self.assertIn(arguments[0], done.stderr)

    def test_help(self):
        self.check_help(OURS + PEERS)

    def test_a_run_that_fails_is_told(self):
        done = BENCHMARK.run("--shapes", "Sphere", "--sizes", "32", "--stretches", "1", "--finest",
                             "-2", "--runs", "us,windowed", "--csv", self.path("runs.csv"))
        rows = read_csv(self.path("runs.csv"))
        self.assertEqual(done.returncode, 1)
        self.assertIn("failed", rows[0]["Failure"])
        self.assertEqual([row["Failure"] for row in rows[1:]], [""])


if __name__ == "__main__":
    unittest.main()
