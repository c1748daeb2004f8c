# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause

"""benchmark_surface.py on small synthetic volumes: its tables are whole and its figures make sense.

Nothing here depends on how fast the machine is. VOLUMIC_BENCHMARK_SURFACE names the program.
"""

import math
import os
import statistics
import unittest

from benchmark_test_case import (
    Benchmark, CommandLineTestCase, FolderTestCase, SharedFolderTestCase, number, read_csv)

BENCHMARK = Benchmark("benchmark_surface.py", "VOLUMIC_BENCHMARK_SURFACE")
OURS = ["us-1", "us-2", "us-flat", "us-paper"]
PEERS = ["flying", "smoothed", "decimated", "remeshed", "mesher"]


class SideBySide(SharedFolderTestCase):
    """One run of everything on a ring, looked at from all sides."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        path = cls.path("ring.csv")
        cls.done = BENCHMARK.run(
            "--scene", "Torus", "--size", "40", "--no-recovery", "--profile", "--repetitions", "2",
            "--csv", path, "--output", cls.path("ring.vtp"))
        if cls.done.returncode != 0:
            raise AssertionError(cls.done.stdout + cls.done.stderr)
        cls.runs = {row["Run"]: row for row in read_csv(path)}
        cls.levels = read_csv(path.replace(".csv", "-levels.csv"))
        cls.targets = read_csv(path.replace(".csv", "-targets.csv"))

    def test_all_runs_have_a_row_in_order(self):
        self.assertEqual(list(self.runs), OURS + PEERS)
        for row in self.runs.values():
            self.assertEqual(row["Failure"], "")

    def test_costs_are_measured(self):
        for name, row in self.runs.items():
            with self.subTest(run=name):
                self.assertGreater(number(row, "WallSeconds"), 0.0)
                self.assertGreater(number(row, "ProcessorSeconds"), 0.0)
                self.assertGreater(number(row, "BaseMegabytes"), 1.0)
                self.assertGreaterEqual(number(row, "PeakMegabytes"), number(row, "BaseMegabytes"))
        self.assertEqual(number(self.runs["us-1"], "WallRatio"), 1.0)
        expected = (number(self.runs["flying"], "ProcessorSeconds")
                    / number(self.runs["us-1"], "ProcessorSeconds"))
        self.assertAlmostEqual(number(self.runs["flying"], "ProcessorRatio") / expected, 1.0, 6)

    def test_all_find_the_ring(self):
        volumes = [number(row, "Volume") for row in self.runs.values()]
        for name, row in self.runs.items():
            with self.subTest(run=name):
                self.assertEqual(row["Components"], "1")
                self.assertEqual(row["Genus"], "1")
                self.assertEqual(row["Outward"], "1")
                self.assertEqual(row["OpenEdges"], "0")
                self.assertAlmostEqual(number(row, "Volume") / volumes[0], 1.0, delta=0.03)
                # A closed surface of genus 1: V - E + F = 0, thus F = 2 V.
                self.assertEqual(number(row, "Triangles"), 2 * number(row, "Vertices"))
                self.assertGreater(number(row, "Reach"), 0.95)

    def test_figures_are_in_order(self):
        for name, row in self.runs.items():
            with self.subTest(run=name):
                for low, high in (("EdgeShortest", "EdgeMean"), ("EdgeMean", "EdgeLongest"),
                                  ("RatioLeast", "RatioQuantile01"),
                                  ("RatioQuantile01", "RatioMean")):
                    self.assertLessEqual(number(row, low), number(row, high))
                self.assertLess(number(row, "RatioMean"), 1.0)
                self.assertLess(number(row, "DistanceAtVertices"), 0.5)

    def test_ours_keep_what_they_promise(self):
        for name in OURS:
            row = self.runs[name]
            with self.subTest(run=name):
                for column in ("SelfIntersections", "OpenEdges", "NonManifold",
                               "MisorientedEdges", "EdgesOutside", "NearPairs"):
                    self.assertEqual(row[column], "0", column)
                self.assertEqual(row["StopReason"], "converged")
                self.assertGreater(number(row, "Iterations"), 10)
                self.assertGreater(number(row, "MicrosecondsPerVertexIteration"), 0.0)
        self.assertEqual(self.runs["us-1"]["Fingerprint"], self.runs["us-2"]["Fingerprint"])
        self.assertNotEqual(self.runs["us-1"]["Fingerprint"], self.runs["us-flat"]["Fingerprint"])

    def test_peers_are_as_fine_as_told(self):
        ours = self.runs["us-1"]
        for name, tolerance in (("decimated", 0.02), ("mesher", 0.15)):
            share = number(self.runs[name], "Vertices") / number(ours, "Vertices")
            self.assertAlmostEqual(share, 1.0, delta=tolerance, msg=name)
        share = number(self.runs["remeshed"], "EdgeMean") / number(ours, "EdgeMean")
        self.assertAlmostEqual(share, 1.0, delta=0.15)
        for name in PEERS:
            self.assertEqual(self.runs[name]["NearPairs"], "")  # a promise of ours alone

    def test_levels_add_up_to_the_run(self):
        ours = self.runs["us-1"]
        self.assertGreater(len(self.levels), 1)
        self.assertEqual([row["Level"] for row in self.levels],
                         [str(h) for h in range(len(self.levels))])
        self.assertEqual(sum(number(row, "Iterations") for row in self.levels),
                         number(ours, "Iterations"))
        for column in ("Vertices", "EdgeMean", "RatioMean", "DistanceAtCentroids"):
            self.assertEqual(self.levels[0][column], ours[column])
        microseconds = number(self.levels[0], "Seconds") / number(self.levels[0], "VertexIterations")
        self.assertAlmostEqual(
            1e6 * microseconds / number(self.levels[0], "MicrosecondsPerVertexIteration"), 1.0, 6)

    def test_phases_fit_into_their_level(self):
        for row in self.levels:
            phases = [name for name in row if name.endswith("Seconds") and name != "Seconds"
                      and not name.endswith("SerialSeconds")]
            self.assertIn("ForcesSeconds", phases)
            self.assertIn("ProximitySeconds", phases)
            between = ("DivisionSeconds", "RecoverySeconds", "RegularisationSeconds")
            self.assertEqual(phases[-3:], list(between))
            inside = sum(number(row, name) for name in phases if name not in between)
            self.assertGreater(inside, 0.0)
            self.assertLessEqual(inside, 1.001 * number(row, "Seconds"))
            parts = sum(number(row, name) for name in between[1:])
            self.assertLess(parts, number(row, between[0]))
            for name in phases:
                serial = number(row, name.replace("Seconds", "SerialSeconds"))
                self.assertLessEqual(serial, number(row, name) + 1e-9)
        self.assertIn("By phase", self.done.stdout)

    def test_targets_follow_from_the_figures(self):
        rows = {}
        for row in self.targets:
            rows.setdefault(row["target"], []).append(row)
        self.assertEqual(sorted(rows), ["Q1", "Q2", "Q3", "Q4", "Q5",
                                        "S1", "S2", "S3", "S4", "S5", "S6", "S7"])
        ratio = (number(self.runs["us-1"], "ProcessorSeconds")
                 / number(self.runs["remeshed"], "ProcessorSeconds"))
        self.assertAlmostEqual(float(rows["S1"][0]["figure"]) / ratio, 1.0, delta=0.01)
        self.assertEqual(rows["S1"][0]["verdict"], "reached" if ratio <= 0.5 else "missed")
        self.assertEqual([rows[name][0]["limit"] for name in ("S1", "S6")], ["<= 0.500", ">= 1.75"])
        self.assertEqual(rows["S3"][0]["verdict"], "not run")  # the level set is slow
        for name in ("Q1", "Q2", "Q5"):
            self.assertEqual({row["verdict"] for row in rows[name]}, {"reached"})

    def test_the_surface_is_written(self):
        self.assertGreater(os.path.getsize(self.path("ring.vtp")), 1000)


class Growth(FolderTestCase):
    def test_exponents_are_those_of_the_rows(self):
        path = self.path("growth.csv")
        done = BENCHMARK.run("--scene", "Sphere", "--size", "40", "--growth", "--sizes", "24,32,48",
                             "--csv", path)
        self.assertEqual(done.returncode, 0, done.stderr)
        rows = read_csv(path)
        exponents = {(row["Figure"], row["Against"]): row
                     for row in read_csv(self.path("growth-exponents.csv"))}
        self.assertEqual([row["Voxels"] for row in rows],
                         [str(size ** 3) for size in (24, 32, 48)])
        for figure, against in (("ProcessorSeconds", "Voxels"), ("PeakMegabytes", "Vertices"),
                                ("Vertices", "Voxels"),
                                ("ProximitySecondsPerFinestIteration", "FinestVertices")):
            x = [math.log(number(row, against)) for row in rows]
            y = [math.log(number(row, figure)) for row in rows]
            mean_x, mean_y = sum(x) / 3, sum(y) / 3
            slope = (sum((a - mean_x) * (b - mean_y) for a, b in zip(x, y))
                     / sum((a - mean_x) ** 2 for a in x))
            told = exponents[figure, against]
            self.assertAlmostEqual(float(told["Exponent"]), slope, delta=0.01 * max(1, abs(slope)))
            self.assertEqual(told["Sizes"], "3")
        # A ball: its surface grows with the power 2/3 of its volume.
        self.assertAlmostEqual(float(exponents["Vertices", "Voxels"]["Exponent"]), 2 / 3, delta=0.1)
        self.assertIn(("ContactAndProximityPerFinestIteration", "FinestVertices"), exponents)


class Scaling(FolderTestCase):
    """What threads gain, and what memory is taken: one size of a ring each."""

    def measure(self, *arguments):
        path = self.path("ring.csv")
        done = BENCHMARK.run("--scene", "Torus", "--size", "40", "--csv", path, *arguments)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done, read_csv(path), read_csv(self.path("ring-targets.csv"))

    def test_threads_take_turns(self):
        done, rows, targets = self.measure("--threads", "1,2", "--repetitions", "3")
        self.assertEqual([row["Threads"] for row in rows], ["1", "2", "2", "1", "1", "2"])
        self.assertEqual([row["Round"] for row in rows], ["1", "1", "2", "2", "3", "3"])
        self.assertEqual(len({row["Fingerprint"] for row in rows}), 1)
        seconds = {threads: [number(row, "WallSeconds") for row in rows
                             if row["Threads"] == threads] for threads in "12"}
        gain = statistics.median(a / b for a, b in zip(seconds["1"], seconds["2"]))
        self.assertEqual([row["target"] for row in targets], ["S6", "Q5"])
        self.assertAlmostEqual(float(targets[0]["figure"]), gain, delta=0.01 * gain)
        self.assertEqual(targets[0]["limit"], ">= 1.75")
        self.assertEqual(targets[0]["verdict"], "reached" if gain >= 1.75 else "missed")
        self.assertEqual(targets[1]["verdict"], "reached")
        self.assertIn("median seconds", done.stdout)

    def test_threads_without_a_pair_have_no_target(self):
        _, rows, targets = self.measure("--threads", "3", "--repetitions", "1", "--sizes", "0,24")
        self.assertEqual([row["Size"] for row in rows], ["0", "24"])
        self.assertNotEqual(rows[0]["Fingerprint"], rows[1]["Fingerprint"])
        self.assertEqual([row["target"] for row in targets], ["Q5", "Q5"])

    def test_the_model_adds_up(self):
        done, rows, targets = self.measure("--model")
        phases, total = rows[:-1], rows[-1]
        self.assertEqual(total["Phase"], "all")
        names = [row["Phase"] for row in phases]
        self.assertEqual(len(set(names)), len(names))
        for name in ("Pyramid", "Voxels", "Visits", "Components", "Division", "Output"):
            self.assertIn(name, names)
        threads = (1, 2, 4, 8, 16, 32, 64)
        for column in ["Serial", "Parallel", "Calls"] + [f"Seconds{p}" for p in threads]:
            self.assertAlmostEqual(sum(number(row, column) for row in phases),
                                   number(total, column), delta=1e-6)
        for row in rows:
            with self.subTest(phase=row["Phase"]):
                serial, parallel = number(row, "Serial"), number(row, "Parallel")
                self.assertAlmostEqual(number(row, "Seconds1"), serial + parallel, delta=1e-8)
                self.assertLessEqual(number(row, "Small"), serial + 1e-8)
                for p in threads[1:]:
                    self.assertGreaterEqual(number(row, f"Seconds{p}") + 1e-8,
                                            serial + parallel / p)
        longest = [number(row, "Seconds16") for row in phases]
        self.assertEqual(longest, sorted(longest, reverse=True))
        gain = number(total, "Seconds1") / number(total, "Seconds16")
        self.assertEqual(len(targets), 1)  # the share that is serial is judged at 512^3
        self.assertAlmostEqual(float(targets[0]["figure"]), gain, delta=0.01 * gain)
        self.assertEqual(targets[0]["limit"], ">= 5")
        for words in ("10 us per For()", "share memory and caches", "speed-up"):
            self.assertIn(words, done.stdout)
        _, threaded, _ = self.measure("--threads", "2", "--repetitions", "1")
        self.assertEqual(threaded[0]["Fingerprint"], total["Fingerprint"])

    def test_memory_is_that_of_image_and_run(self):
        done, rows, targets = self.measure("--memory", "--sizes", "0,64")
        self.assertEqual([row["Voxels"] for row in rows], [str(40 ** 3), str(64 ** 3)])
        for row in rows:
            self.assertEqual(row["BytesOfVoxel"], "4")
            self.assertGreater(number(row, "BaseMegabytes"),
                               1e-6 * number(row, "BytesOfVoxel") * number(row, "Voxels"))
            self.assertGreater(number(row, "PeakMegabytes"), number(row, "BaseMegabytes"))
        self.assertGreater(number(rows[1], "Vertices"), number(rows[0], "Vertices"))
        self.assertEqual(targets, [])  # M1 is about larger ones
        self.assertIn("MB at the peak", done.stdout)

    def test_nothing_is_left_behind(self):
        done = BENCHMARK.run("--scene", "Torus", "--memory", "--sizes", "0",
                             env={**os.environ, "TMPDIR": self.folder})
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(os.listdir(self.folder), [])


class CommandLine(CommandLineTestCase):
    benchmark = BENCHMARK

    def test_coarsest_level(self):
        path = self.path("runs.csv")
        for arguments, expected in (([], "2"), (["--coarsest", "1"], "1")):
            done = BENCHMARK.run("--scene", "Torus", "--size", "40", "--runs", "us-1", "--csv",
                                 path, *arguments)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertEqual(read_csv(path)[0]["CoarsestLevel"], expected)

    def test_what_is_wrong_is_told(self):
        self.check_refusals(
            ("", "--volume FILE.vti or --scene NAME"),
            ("--volume missing.vti --iso 1", "missing.vti"), ("--volume missing.vti", "--iso"),
            ("--scene Cube", "there are Sphere"), ("--scene Torus --iso 9999", "iso-value"),
            ("--scene Torus --runs us-1,nobody", "nobody"),
            ("--scene Torus --runs mesher", "--edge-length"), ("--scene Torus --size many", "many"),
            ("--scene Torus --csv", "expected one argument"),
            ("--scene Torus --threads 1,none", "none"),
            ("--scene Torus --threads 1,2 --model", "alone"),
            ("--scene Torus --memory --slow", "--slow"),
            ("--scene Torus --growth --sizes 0,32", "no size 0"), ("--frobnicate", "--frobnicate"))

    def test_help(self):
        self.check_help(OURS + PEERS)

    def test_a_run_that_fails_is_told_and_others_go_on(self):
        path = self.path("runs.csv")
        done = BENCHMARK.run("--scene", "Torus", "--size", "32", "--runs", "us-1,flying,mesher",
                             "--csv", path, "--output", self.path("missing/ring.vtp"))
        rows = {row["Run"]: row for row in read_csv(path)}
        self.assertEqual(done.returncode, 1)
        self.assertIn("us-1 FAILED", done.stdout)
        self.assertIn("can't be written", rows["us-1"]["Failure"])
        self.assertEqual(rows["flying"]["Failure"], "")
        self.assertIn("us-1", rows["mesher"]["Failure"])  # it can't know how fine to be


if __name__ == "__main__":
    unittest.main()
