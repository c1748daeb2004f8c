# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Examples/Python/segment.py --labels: what it writes, which labels it takes, errors, Ctrl-C."""

import os
import sys
import unittest

import numpy as np

from examples_path import EXAMPLES
from folder_test_case import FolderTestCase
from sample_volumes import run_script, write_volume
from vtk_files import read

sys.path.insert(0, EXAMPLES)
# pylint: disable=wrong-import-position
from label_surfaces import choose_labels, file_names
from read_volume import read_labels

SPACING = (1, 1, 1.5)
NAMES = b"label,name\n1,liver\n2,Left lung\n"


def label_voxels(count=1):
    """Balls of the labels 1, 2, 5, ... in rows of `count` times 3."""
    z, y, x = np.indices((14, 14 * count, 42))
    labels = np.array([[1, 2, 5]]) + 5 * np.arange(count)[:, None]
    inside = (x % 14 - 6.5) ** 2 + (y % 14 - 6.5) ** 2 + (z - 6.5) ** 2 < 30
    return np.where(inside, labels[y // 14, x // 14], 0).astype("u1")


class LabelsTest(FolderTestCase):
    def setUp(self):
        super().setUp()
        self.map = write_volume(self.path("map.mha"), label_voxels(), SPACING)
        self.names = self.write_bytes("names.csv", NAMES)

    def segment(self, output, *options, volume=None, status=0):
        run = run_script("segment.py", volume or self.map, self.path(output), *options)
        self.assertEqual(run.returncode, status, run.stdout + run.stderr)
        return run

    def refused(self, reason, output, *options, status=1):
        run = self.segment(output, *options, status=status)
        self.assertRegex(run.stderr, reason)
        self.assertNotIn("Traceback", run.stderr)


class OutputsTest(LabelsTest):
    def test_a_folder(self):
        run = self.segment("new/out/", "--labels", "all", "--label-names", self.names)
        self.assertIn("3 labels, 3 chosen", run.stdout)
        self.assertRegex(run.stdout, r"voxel centres on the wrong side: \d+\nWritten: .*, 3 surf")
        self.assertEqual(sorted(os.listdir(self.path("new/out"))),
                         ["Left_lung.vtp", "label-5.vtp", "liver.vtp"])
        fields = read(self.path("new/out/liver.vtp")).GetFieldData()
        self.assertEqual(fields.GetArray("Label").GetValue(0), 1)
        voxels = (label_voxels() == 1).sum() * np.prod(SPACING)
        self.assertAlmostEqual(fields.GetArray("Volume").GetValue(0) / voxels, 1, delta=0.05)

    def test_blocks(self):
        self.segment("all.vtm", "--labels", "all", "--set", "FinestLevel=0")
        self.assertEqual(read(self.path("all.vtm")).GetNumberOfBlocks(), 3)

    def test_merged_and_single(self):
        self.segment("two.stl", "--labels", "1-2", "--merge")
        x = read(self.path("two.stl")).GetBounds()[:2]
        self.segment("one.stl", "--labels", "1")
        self.assertAlmostEqual(x[1] - read(self.path("one.stl")).GetBounds()[1], 14, 0)

    def test_names_as_the_command_reads_them(self):
        fields = read_labels(self.map, self.names).GetFieldData()
        self.assertEqual(fields.GetAbstractArray("LabelNames").GetValue(1), "Left lung")
        self.write_bytes("map.txt", b"5 spleen\n")
        self.segment("s/", "--labels", "spleen")
        self.assertEqual(os.listdir(self.path("s")), ["spleen.vtp"])


class ChoiceTest(unittest.TestCase):
    names = {-3: "Label -3", 0: "Label 0", 1: "liver", 2: "Left lung", 7: "a[1], b"}

    def test_texts(self):
        for text, labels in (
                ("all", [-3, 1, 2, 7]), ("1", [1]), ("7,1,1", [1, 7]), ("2-9", [2, 7]),
                ("-5--1,7", [-3, 7]), ("-3-1", [-3, 1]), ("liver", [1]), ("LIVER, left lung", [1, 2]),
                ("l*", [1, 2]), ("*", [1, 2, 7]), ("Label -3", [-3]), ("0", [0]),
                ("a[1], b", [7]), ("a[*", [7])):
            with self.subTest(text):
                self.assertEqual(choose_labels(text, self.names), labels)
        self.assertEqual(choose_labels("all", self.names, background=1), [-3, 0, 2, 7])

    def test_names_of_files(self):
        names = {1: "../Up", 2: "up", 3: "..", 4: "C:\\con?* \u00e9", 5: "x" * 300}
        self.assertEqual(file_names(names), {1: "Up-1", 2: "up-2", 3: "label-3",
                                             4: "C__con___\u00e9", 5: "x" * 120})


class ErrorsTest(LabelsTest):
    def test_options_that_do_not_fit(self):
        self.refused("--merge needs --labels", "a.stl", "--merge", status=2)
        self.refused("--label-names needs --labels", "a.stl", "--label-names", "n", status=2)
        for reason, output, *options in (
                ("--iso and --labels exclude", "a/", "--iso", "3"),
                ("--dark and --labels exclude", "a/", "--dark"),
                ("no property IsoValue; it has .*Smoothing", "a/", "--set", "IsoValue=3"),
                ("--merge makes one surface", "a/", "--merge"),
                ("--format dwg: it must be one of stl, ply", "a/", "--format", "dwg"),
                ("--format is that of the files", "a.stl", "--format", "stl"),
                ("a.dwg: a folder is wanted", "a.dwg"),
                ("none.csv: names of labels cannot be read", "a/", "--label-names",
                 self.path("none.csv"))):
            with self.subTest(reason):
                self.refused(reason, output, "--labels", "1", *options)
        self.assertFalse(os.path.exists(self.path("a")))

    def test_what_is_not_there(self):
        self.refused("there is no label '9'; there are 0 Label 0, 1 Label 1", "a/", "--labels", "9")
        self.refused("3 labels have as many surfaces", "a.stl", "--labels", "all")
        self.assertFalse(os.path.exists(self.path("a")))

    def test_what_the_filter_refuses(self):
        self.refused("Gap is -1", "a/", "--labels", "1", "--set", "Gap=-1")

    def test_inputs_are_not_replaced(self):
        os.rename(self.map, self.path("label-1.mha"))
        os.symlink(self.path("label-1.mha"), self.path("label-1.vtp"))
        run = run_script("segment.py", self.path("label-1.mha"), self.folder, "--labels", "1")
        self.assertEqual(run.returncode, 1)
        self.assertIn("it would replace the input", run.stderr)


if __name__ == "__main__":
    unittest.main()
