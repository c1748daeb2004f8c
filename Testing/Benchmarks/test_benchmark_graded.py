# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""benchmark_graded.py on a small volume: its rows are whole and its figures make sense.

An mmgs that hands back what it gets stands for that peer. VOLUMIC_PROGRAM, VOLUMIC_JUDGE_FILES and
VOLUMIC_MAKE_VOLUME name the programs, VOLUMIC_ADAPTIVE_REMESH one that may be missing.
"""

import os
import subprocess
import sys
import unittest

import numpy as np

import graded_surfaces
from benchmark_test_case import SharedFolderTestCase, number, read_csv

SCRIPT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "benchmark_graded.py")
ADAPTIVE = os.environ["VOLUMIC_ADAPTIVE_REMESH"]
COPYING = '#!/bin/sh\nwhile [ "$1" != -in ]; do shift; done\ncp "$2" "$4"\n'


class GradedTest(SharedFolderTestCase):
    @classmethod
    def measure(cls, mmgs):
        """With such a script as mmgs; what is said, figures of each run, and of the targets."""
        with open(cls.path("mmgs"), "w", encoding="ascii") as file:
            file.write(mmgs)
        os.chmod(cls.path("mmgs"), 0o755)
        done = subprocess.run(
            [sys.executable, SCRIPT, "--program", os.environ["VOLUMIC_PROGRAM"], "--judge",
             os.environ["VOLUMIC_JUDGE_FILES"], *(["--adaptive", ADAPTIVE] if ADAPTIVE else []),
             "--scan", "foam", cls.path("foam.vti"), "0.5", "--tolerances", "0.3",
             "--points", "2000", "--repetitions", "1", "--csv", cls.path("foam.csv")],
            env={**os.environ, "PATH": cls.folder + ":" + os.environ["PATH"]},
            capture_output=True, text=True, timeout=250, check=False)
        return (done, {row["Run"]: row for row in read_csv(cls.path("foam.csv"))},
                {row["what"]: row for row in read_csv(cls.path("foam-targets.csv"))})

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        subprocess.run([os.environ["VOLUMIC_MAKE_VOLUME"], "foam", "32", cls.path("foam.vti")],
                       check=True)
        cls.done, cls.runs, cls.targets = cls.measure(COPYING)

    def test_all_runs_have_a_row(self):
        self.assertEqual(self.done.returncode, 0, self.done.stderr)
        adaptive = ["CGAL adaptive"] if ADAPTIVE else []
        self.assertEqual(list(self.runs),
                         ["uniform", "graded 0.3", "decimated", *adaptive, "mmgs"])
        self.assertEqual("adaptive remeshing is left out" in self.done.stdout, not ADAPTIVE)

    def test_peers_are_as_fine_as_told(self):
        vertices = {run: number(row, "Vertices") for run, row in self.runs.items()}
        self.assertLess(vertices["graded 0.3"], .8 * vertices["uniform"])
        self.assertAlmostEqual(vertices["decimated"] / vertices["graded 0.3"], 1, delta=.01)
        self.assertEqual(vertices["mmgs"], vertices["uniform"])

    def test_figures_make_sense(self):
        for run, row in self.runs.items():
            with self.subTest(run):
                self.assertTrue(75 < number(row, "Within") <= 100, row)
                self.assertTrue(0 < number(row, "Largest") < 5)
                self.assertTrue(number(row, "RatioLeast") < number(row, "Ratio01")
                                < number(row, "RatioMean") < 1)
                self.assertTrue(75 < number(row, "Alike") <= 100)
        self.assertEqual(self.runs["mmgs"]["Within"], self.runs["uniform"]["Within"])
        for run in ("uniform", "graded 0.3"):
            self.assertEqual(number(self.runs[run], "Outside"), 0)
            self.assertEqual(number(self.runs[run], "Intersections"), 0)
        self.assertEqual(number(self.runs["uniform"], "Time"), 1)
        self.assertGreater(number(self.runs["decimated"], "Time"), 1)

    def test_targets_are_of_the_graded_surface(self):
        self.assertEqual(self.targets["self-intersections"]["verdict"], "reached")
        fewer = number(self.runs["graded 0.3"], "Fewer")
        self.assertAlmostEqual(
            number(self.targets["vertices, uniform / graded"], "figure"), fewer, 2)

    def test_a_peer_that_fails_is_told(self):
        done, runs, _ = self.measure("#!/bin/sh\necho too bad; exit 3\n")
        self.assertEqual(done.returncode, 1)
        self.assertIn("mmgs failed, 3: too bad", done.stderr)
        self.assertEqual(runs["mmgs FAILED"]["Vertices"], "")

    def test_edges_are_alike_within_a_ratio(self):
        triangle = graded_surfaces.surface_of(
            np.array([[0, 0, 0], [3, 0, 0], [0, 4, 0]]), np.array([[0, 1, 2]]))
        self.assertAlmostEqual(graded_surfaces.alike_edges(triangle, 1.5), 2 / 3)


if __name__ == "__main__":
    unittest.main()
