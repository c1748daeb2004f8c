# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The scripts of Examples/Python that make the documents' pictures and tables, and a video of an
evolution, on a small volume. Needs a display."""

import json
import os
import sys
import unittest

import numpy as np

from examples_path import EXAMPLES
from folder_test_case import SharedFolderTestCase
from sample_volumes import RING_ISO, RING_SPACING, ring_voxels, run_script, write_volume
from vtk_files import read, read_pixels

sys.path.insert(0, EXAMPLES)
# pylint: disable=wrong-import-position
from figures import ROW_WIDTH, SKULL_PICTURES
from paper_tables import TABLES


def cells_of(markdown):
    return [[cell.strip() for cell in line.strip("|").split("|")]
            for line in markdown.strip().splitlines()]


class ScriptTest(SharedFolderTestCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.ring = write_volume(cls.path("s.mha"), ring_voxels(), RING_SPACING)
        cls.scan = (cls.ring, str(RING_ISO))

    def refused(self, script, *cases):
        """Each case: the exit code, the reason, arguments."""
        for code, reason, *arguments in cases:
            with self.subTest(reason):
                run = run_script(script, *arguments)
                self.assertEqual(run.returncode, code, run.stderr)
                self.assertIn(reason, run.stderr)
                self.assertNotIn("Traceback", run.stderr)


class FiguresTest(ScriptTest):
    def test_every_picture(self):
        output = self.path("pictures")
        # The others are like these, or like those that quickstart.py draws.
        of_skull = [draw.__name__ for draw in SKULL_PICTURES
                    if draw.__name__ in ("graded", "history", "evolution")]
        run = run_script("figures.py", "--output", output, "--skull", *self.scan,
                         "--vessels", *self.scan, "--graded", *self.scan, "0.2", "--only",
                         *of_skull, "vessels", "interfaces")
        self.assertEqual((run.returncode, run.stderr), (0, ""))
        names = sorted([*(f"{name}.png" for name in of_skull), "graded-s.png", "interfaces.png",
                        "vessels.png"])
        self.assertEqual(sorted(os.listdir(output)), names)
        for name in names:
            pixels = read_pixels(os.path.join(output, name))
            self.assertGreater(pixels.shape[1], 0.75 * ROW_WIDTH, name)
            self.assertGreater(pixels.std(), 8, name)

    def test_refused(self):
        output = ("--output", self.path("none"), "--only")
        self.refused("figures.py", (2, "invalid choice", *output, "nothing"),
                     (1, "no such file", *output, "vessels", "--vessels", "none.vti", "3"),
                     (1, "9999", *output, "levels", "--skull", self.ring, "9999"))


class TablesTest(ScriptTest):
    def test_every_table(self):
        run = run_script("paper_tables.py", "--skull", *self.scan, "--scan", *self.scan)
        self.assertEqual(run.returncode, 0, run.stderr)
        tables = [cells_of(text) for text in run.stdout.split("\n\n") if text]
        self.assertEqual(len(tables), len(TABLES))
        for lines in tables:
            self.assertEqual({len(line) for line in lines}, {len(lines[0])})
        levels, vessels, recovery, start, rest, sampling = (lines[2:] for lines in tables)
        for row in levels[1:3]:  # as in the paper, and defaults
            self.assertTrue(all(int(cell) > 0 for cell in row[1:4]), row)
            self.assertEqual(row[-1], "1, 1")
        for cell in vessels[0][1:]:
            count, share = cell.split(", ")
            self.assertGreater(int(count), 0)
            self.assertGreater(float(share.removesuffix(" %")), 95)
        self.assertTrue(recovery[0][-1].endswith(" %, from level 2"), recovery)
        first, outside, iso = map(int, start[0][1:4])
        self.assertEqual(first, 2)
        self.assertLess(iso, outside)
        self.assertGreaterEqual(int(rest[0][2]), 5)
        counts = [int(row[1].replace(",", "")) for row in sampling]
        self.assertEqual(counts, sorted(counts, reverse=True))

    def test_refused(self):
        self.refused("paper_tables.py", (2, "invalid choice", "--only", "nothing"),
                     (1, "no such file", "--skull", "none.vti", "3"))


class SnapshotsTest(ScriptTest):
    def snapshots(self, output, *options):
        return run_script("evolution_snapshots.py", self.ring, self.path(output), "--iso",
                          str(RING_ISO), "--width", "200", "--finest-level", "1", *options)

    def test_pictures_and_a_video(self):
        for output in ("frames", "ring.ogv"):
            run = self.snapshots(output, "--every", "20")
            self.assertEqual(run.returncode, 0, run.stderr)
        names = sorted(os.listdir(self.path("frames")))
        self.assertEqual(names[:2], ["frame0000.png", "frame0001.png"])
        first, last = (read_pixels(self.path(f"frames/{names[i]}")) for i in (0, -1))
        self.assertEqual(first.shape, last.shape, "one size for all")
        # Not black, and a body at first that is larger than the ring at last.
        light = [np.count_nonzero(picture.mean(axis=2) > 60) for picture in (first, last)]
        self.assertGreater(light[1], 1000)
        self.assertGreater(light[0], 1.5 * light[1])
        start = self.content("ring.ogv")[:64]
        self.assertTrue(start.startswith(b"OggS"))
        self.assertIn(b"theora", start)

    def test_surfaces_in_time(self):
        run = self.snapshots("ring.vtp.series", "--every", "20")
        self.assertEqual(run.returncode, 0, run.stderr)
        files = json.loads(self.content("ring.vtp.series"))["files"]
        self.assertEqual([file["time"] for file in files], list(range(len(files))))
        levels = [int(read(self.path(file["name"])).GetFieldData().GetArray("Level").GetTuple1(0))
                  for file in files]
        self.assertEqual(levels, sorted(levels, reverse=True))
        self.assertEqual((levels[0], levels[-1]), (2, 1))

    def test_refused(self):
        self.refused("evolution_snapshots.py", *(
            (code, reason, self.ring, self.path("a.ogv"), *options) for code, reason, *options in (
                (2, "--every", "--every", "0"), (1, "Iso Value", "--iso", "1e6"))))
        self.assertFalse(os.path.exists(self.path("a.ogv")))


if __name__ == "__main__":
    unittest.main()
