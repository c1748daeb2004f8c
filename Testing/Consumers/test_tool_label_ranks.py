# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""`mpirun -n N volumic --labels`: ranks share the labels; the same files, and no waiting.

See test_tool_ranks.py.
"""

import json
import os
import shutil
import signal
import sys
import unittest

import numpy as np
from vtkmodules.vtkIOXML import vtkXMLImageDataWriter

from test_tool_ranks import MPIRUN, SKIPPED, RanksTestCase
from tool_test_case import make_image


class SameFilesTest(RanksTestCase):
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

    def test_the_same_files(self):
        volume = self.map_file()
        names = self.write_bytes("names.json", b'{"1": "liver", "5": "spleen"}')
        for options in ((), ("--gap", 0.6), ("--finest", 2, "--label-names", names)):
            alone = f"1-{len(options)}"
            one = self.report(volume, self.path(alone), "--labels", "all", *options)
            self.assertGreaterEqual(len(self.files_in(alone)), 4)
            for ranks in (2, 3):
                with self.subTest(ranks=ranks, options=options):
                    folder = f"{ranks}-{len(options)}"
                    self.run_ranks(ranks, volume, self.path(folder), self.path("all.vtm"),
                                   "--labels", "all", "--report", self.path("r.json"), *options)
                    self.assertEqual(self.files_in(folder), self.files_in(alone))
                    report = json.loads(self.content("r.json"))
                    for row, expected in zip(report["labels"], one["labels"]):
                        self.assertGreater(row["seconds"], 0)
                        for name in ("files", "seconds"):
                            row[name] = expected[name]
                        self.assertEqual(row, expected)
                    self.assertEqual(report["warnings"], one["warnings"])

    def test_what_is_said_is_said_once(self):
        volume = self.map_file()
        process = self.run_ranks(3, volume, self.path("o/"), "--labels", "all", "--finest", 2)
        for said in ("map.vti: 24 x 24 x 24", "warning: No surface is left of Label 9",
                     " vertices"):
            self.assertEqual(process.stderr.count(said), 1, process.stderr)
        listed = self.run_ranks(3, volume, "--list-labels").stdout
        self.assertEqual(listed, self.run_tool(volume, "--list-labels").stdout)
        for reason, status, arguments in (
                ("there is no label '7'", 1, [self.path("p/"), "--labels", "7"]),
                ("none of the labels has a surface", 1,
                 [self.path("p/"), "--labels", "9", "--finest", 2]),
                ("--gap is 100", 1, [self.path("p/"), "--labels", "1", "--gap", 100]),
                ("5 labels have as many surfaces", 1, [self.path("p.stl"), "--labels", "all"])):
            with self.subTest(reason):
                self.refused_by_ranks(3, reason, volume, *arguments, status=status)
                self.assertFalse(os.path.exists(self.path("p")))


class StoppedTest(RanksTestCase):
    def running(self, ranks):
        """Of 125 cubes."""
        z, y, x = np.mgrid[0:80, 0:80, 0:80]
        edges = np.minimum(np.minimum(x % 16, y % 16), z % 16)
        labels = np.where(edges > 2, 1 + x // 16 + 5 * (y // 16) + 25 * (z // 16), 0)
        volume = self.write(vtkXMLImageDataWriter(), "cubes.vti",
                            make_image(labels.astype("i2"), (1, 1, 1)))
        return self.running_to(r"Making surfaces: +[3-9]\d %.* of 125, Label", ranks, volume,
                               self.path("cubes/"), "--labels", "all", "--threads", 1)

    def test_cancelled_by_a_signal_to_any_rank(self):
        for rank in (0, 2):
            with self.subTest(rank), self.running(3) as (process, ranks):
                os.kill(ranks[rank], signal.SIGUSR1)
                text = self.finish(process)
                self.assertEqual(process.returncode, 3, text)
                self.assertEqual(text.count("volumic: unfinished (cancelled)"), 1)
                written = os.listdir(self.path("cubes"))
                self.assertGreater(len(written), 5)
                self.assertLess(len(written), 125)
                shutil.rmtree(self.path("cubes"))

    def test_a_rank_that_is_killed_ends_all(self):
        with self.running(2) as (process, ranks):
            os.kill(ranks[1], signal.SIGKILL)
            self.finish(process)
            self.assertNotEqual(process.returncode, 0)
            for number in ranks:
                self.wait_for_end(number)


if __name__ == "__main__":
    if not MPIRUN:
        print("skipped: mpirun or VTK's MPI (VTK::ParallelMPI) is missing")
        sys.exit(SKIPPED)
    unittest.main()
