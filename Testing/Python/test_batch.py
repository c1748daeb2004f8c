# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Examples/Python/batch.py: a table and surfaces for a folder, whatever is wrong in it."""

import csv
import os
import unittest

import numpy as np

import medical_files
from folder_test_case import FolderTestCase
from sample_volumes import (
    RING_ISO, RING_SPACING, RING_VOLUME, ring_voxels, run_script, write_volume)


class BatchTest(FolderTestCase):
    def setUp(self):
        super().setUp()
        self.output = self.path("a/results")
        self.folder = self.path("scans")
        os.mkdir(self.folder)

    def add_ring(self, name="ring.mha"):
        return write_volume(self.path(name), ring_voxels(), RING_SPACING)

    def batch(self, *options):
        return run_script("batch.py", self.folder, "--output", self.output, *options)

    def table(self):
        with open(os.path.join(self.output, "results.csv"), encoding="utf-8", newline="") as file:
            return {line["volume_file"]: line for line in csv.DictReader(file)}

    def written(self):
        return sorted(os.listdir(self.output))


class ResultsTest(BatchTest):
    def test_the_table_tells_size_and_shape(self):
        self.add_ring()
        run = self.batch("--iso", str(RING_ISO))
        self.assertEqual((run.returncode, run.stderr), (0, ""))
        line = self.table()["ring.mha"]
        self.assertEqual((line["status"], line["stop_reason"], line["error"]),
                         ("ok", "converged", ""))
        self.assertEqual((int(line["components"]), int(line["genus"])), (1, 1))
        self.assertEqual(float(line["iso_value"]), RING_ISO)
        self.assertAlmostEqual(float(line["volume"]) / RING_VOLUME, 1, delta=0.1)
        self.assertEqual(int(line["triangles"]), 2 * int(line["vertices"]))
        self.assertGreater(float(line["seconds"]), 0)
        self.assertEqual(self.written(), ["results.csv", line["surface_file"]])
        self.assertEqual(line["surface_file"], "ring.vtp")

    def test_every_format_and_folder_of_slices(self):
        self.add_ring()
        voxels = np.pad(np.full((12, 12, 12), 90, "i2"), 8)
        self.write_bytes("cube.nii", medical_files.nifti(voxels, (1, 1, 1)))
        os.mkdir(self.path("series"))
        for k, pixels in enumerate(voxels):
            self.write_bytes(f"series/{k}", medical_files.dicom_slice(
                pixels, k, (1, 1, 1), (0, 0, 0), np.eye(3)))
        self.write_bytes("notes.txt", b"not a volume")
        run = self.batch("--format", "stl")
        self.assertEqual(run.returncode, 0, run.stdout)
        self.assertEqual(self.written(), ["cube.stl", "results.csv", "ring.stl", "series.stl"])
        table = self.table()
        self.assertEqual(table["cube.nii"]["volume"], table["series"]["volume"])

    def test_same_names_do_not_overwrite_each_other(self):
        self.add_ring("ring.mha")
        self.add_ring("ring.mhd")  # with ring.zraw or ring.raw beside it
        self.assertEqual(self.batch().returncode, 0)
        self.assertEqual(self.written(), ["results.csv", "ring.mha.vtp", "ring.mhd.vtp"])


class ErrorsTest(BatchTest):
    def test_it_goes_on_after_an_error_and_the_exit_code_tells(self):
        self.write_bytes("a.nrrd", b"junk")
        write_volume(self.path("b.mha"), np.full((20, 20, 20), 3, "u1"))
        self.add_ring("c.mha")
        os.mkdir(self.path("empty"))
        run = self.batch()
        self.assertEqual(run.returncode, 1)
        self.assertIn("1 of 4 volumes done, 3 failed", run.stdout)
        self.assertNotIn("Traceback", run.stderr)
        table = self.table()
        self.assertEqual([table[name]["status"] for name in ("a.nrrd", "b.mha", "c.mha", "empty")],
                         ["failed", "failed", "ok", "failed"])
        for name, reason in (("a.nrrd", "not|NRRD"), ("b.mha", "no value separates"),
                             ("empty", "no DICOM slices")):
            self.assertRegex(table[name]["error"], reason)
            self.assertEqual(table[name]["vertices"], "")
        self.assertEqual(self.written(), ["c.vtp", "results.csv"])

    def test_refused(self):
        for code, reason, volume, *options in (
                (2, "no volume", None), (2, "invalid choice", "ring.mha", "--format", "dwg"),
                (1, "no property Nothing", "ring.mha", "--set", "Nothing=1")):
            with self.subTest(reason):
                if volume:
                    self.add_ring(volume)
                run = self.batch(*options)
                self.assertEqual(run.returncode, code, run.stderr)
                self.assertIn(reason, run.stderr)
        self.assertEqual(self.batch("--iso", "1e6").returncode, 1)
        self.assertRegex(self.table()["ring.mha"]["error"], "1e\\+?06|1000000")
        self.folder = self.path("none")
        self.assertIn("no such folder", self.batch().stderr)


if __name__ == "__main__":
    unittest.main()
