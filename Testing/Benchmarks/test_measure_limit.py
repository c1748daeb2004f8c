# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""MakeVolume makes the volumes that it tells of; measure_limit.py sees what runs with limits do.

VOLUMIC_PROGRAM and VOLUMIC_MAKE_VOLUME name the programs.
"""

import json
import os
import re
import struct
import subprocess
import sys
import unittest

from benchmark_test_case import FolderTestCase, read_csv

PROGRAM = os.environ["VOLUMIC_PROGRAM"]
MAKE_VOLUME = os.environ["VOLUMIC_MAKE_VOLUME"]
SCRIPT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "measure_limit.py")


class LimitTest(FolderTestCase):
    def run_program(self, *arguments, status=0):
        process = subprocess.run([str(a) for a in arguments], capture_output=True, text=True,
                                 timeout=250, check=False)
        self.assertEqual(process.returncode, status, process.stdout + process.stderr)
        return process

    def foam(self, size):
        self.run_program(MAKE_VOLUME, "foam", size, self.path(f"foam{size}.vti"))
        return self.path(f"foam{size}.vti")

    def measure(self, *arguments, program=PROGRAM, status=0):
        return self.run_program(sys.executable, SCRIPT, "--program", program, "--folder",
                                self.folder, *arguments, status=status)


class MakeVolumeTest(LimitTest):
    def voxels(self, name, size):
        content = self.content(name)
        end = content.rindex(b"\n  </AppendedData>")
        start = end - 2 * size ** 3
        self.assertEqual(content[start - 9:start], b"_" + struct.pack("=Q", 2 * size ** 3))
        return struct.unpack(f"={size ** 3}h", content[start:end])

    def test_the_foam_has_a_tenth_of_a_vertex_a_voxel(self):
        size = 48
        voxels = self.voxels(self.foam(size), size)
        self.assertAlmostEqual(sum(voxel > 0 for voxel in voxels) / size ** 3, 0.5, delta=0.05)
        report = json.loads(self.run_program(
            PROGRAM, self.path(f"foam{size}.vti"), "--iso", 0.5, "--report", "-", "-q").stdout)
        self.assertTrue(0.08 < report["vertices"] / size ** 3 < 0.16, report["vertices"])
        self.assertGreater(report["genus"], 20)

    def test_a_resampled_volume_keeps_its_corners_and_its_size_in_the_world(self):
        old = self.voxels(self.foam(24), 24)
        self.run_program(MAKE_VOLUME, "resample", 47, self.path("foam24.vti"),
                         self.path("new.vti"))
        new = self.voxels(self.path("new.vti"), 47)
        # Every second voxel is an old one: 2 * 24 - 1 = 47.
        self.assertEqual([new[i * 2 * (1 + 47 + 47 ** 2)] for i in range(24)],
                         [old[i * (1 + 24 + 24 ** 2)] for i in range(24)])
        head = self.content("new.vti")[:1000].decode("latin-1")
        self.assertIn('WholeExtent="0 46 0 46 0 46"', head)
        self.assertIn('Spacing="0.5 0.5 0.5"', head)

    def test_what_cannot_be_is_told(self):
        for arguments in ([], ["foam"], ["foam", "x", "a"], ["foam", 1, "a"],
                          ["resample", 8, "a"]):
            self.assertIn("Usage", self.run_program(MAKE_VOLUME, *arguments, status=2).stderr)
        for arguments, reason in ((["resample", 8, "none.vti", self.path("a.vti")], "readable"),
                                  (["foam", 8, self.path("none/a.vti")], "can't be written")):
            self.assertIn(reason, self.run_program(MAKE_VOLUME, *arguments, status=1).stderr)


class MeasureLimitTest(LimitTest):
    def test_surfaces_are_the_same(self):
        process = self.measure("--memory", "2G,3G", "--csv", self.path("limit.csv"), self.foam(32),
                               "--iso", 0.5)
        rows = read_csv(self.path("limit.csv"))
        self.assertEqual([row["limit"] for row in rows], ["none", "2G", "3G"])
        self.assertEqual(len({row["surface"] for row in rows}), 1)
        for row in rows:
            self.assertGreater(float(row["peak"]), 5.0)
            self.assertGreater(float(row["processor"]), 0.0)
            self.assertRegex(row["surface"], "^[0-9a-f]{16}$")
        self.assertEqual(len(re.findall("times the seconds", process.stdout)), 2)
        self.assertEqual(os.listdir(self.folder).count("foam32.vti"), 1)
        self.assertEqual(len(os.listdir(self.folder)), 2)

    def test_what_is_wrong_is_told(self):
        volume = self.foam(16)
        process = self.measure("--memory", "1K", volume, "--iso", 0.5, status=1)
        self.assertRegex(process.stderr, "1K: ended with 1: volumic: ")
        self.assertIn("no size", self.measure("--memory", "12", volume, status=2).stderr)
        # Programs that do not keep to what volumic promises.
        for reason, script in (
                ("the surface with 9G differs from that with none",
                 'echo "$*" > "$2"'),
                ("MB were resident with a limit of 1M",
                 'echo same > "$2"; exec "$PYTHON" -c "x = bytearray(50 << 20)"')):
            program = self.write_text("program",
                                      f"#!/bin/sh\nPYTHON={sys.executable}\n{script}\n")
            os.chmod(program, 0o755)
            limit = "1M" if "1M" in reason else "9G"
            process = self.measure("--memory", limit, volume, program=program, status=1)
            self.assertIn(reason, process.stderr)


if __name__ == "__main__":
    unittest.main()
