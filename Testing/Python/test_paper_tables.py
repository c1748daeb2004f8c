# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Examples/Python/paper_tables.py on a small volume, and what it counts with."""

import contextlib
import io
import os
import sys
import tempfile
import unittest

import numpy as np
from vtkmodules.vtkFiltersSources import vtkSphereSource

from examples_path import EXAMPLES
from folder_test_case import SharedFolderTestCase
from sample_volumes import RING_ISO, RING_SPACING, ring_voxels, run_script, write_volume

sys.path.insert(0, EXAMPLES)
# pylint: disable=wrong-import-position
from paper_tables import TABLES
from scan_runs import Scan, closed_iso_surface, in_voxels, iterations, share_within, starts
from volume_image import make_image


def sphere(radius, centre=(0, 0, 0)):
    source = vtkSphereSource()
    source.SetRadius(radius)
    source.SetCenter(centre)
    source.SetThetaResolution(40)
    source.SetPhiResolution(40)
    source.Update()
    return source.GetOutput()


def cells_of(markdown):
    return [[cell.strip() for cell in line.strip("|").split("|")]
            for line in markdown.strip().splitlines()]


class TablesTest(SharedFolderTestCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.large = write_volume(cls.path("large.mha"),
                                 np.kron(ring_voxels(), np.ones((2, 2, 2), "u1")), RING_SPACING)
        cls.small = write_volume(cls.path("small.mha"), ring_voxels(), RING_SPACING)
        run = run_script("paper_tables.py", "--skull", cls.large, str(RING_ISO), "--scan",
                         cls.small, str(RING_ISO))
        cls.code, cls.messages = run.returncode, run.stderr
        cls.tables = [cells_of(text) for text in run.stdout.split("\n\n") if text]

    def test_all_are_made_and_nothing_else_is_printed(self):
        self.assertEqual(self.code, 0, self.messages)
        self.assertEqual(len(self.tables), len(TABLES))
        for lines in self.tables:
            self.assertEqual({len(line) for line in lines}, {len(lines[0])})

    def test_levels_are_those_of_the_paper_and_ours(self):
        head, _, paper, as_paper, defaults, papers_direct, direct = self.tables[0]
        self.assertEqual(head[1:5], ["level 3", "level 2", "level 1", "level 0"])
        self.assertEqual(paper[1:5], ["225", "108", "128", "not stated"])
        for row in (as_paper, defaults):
            self.assertTrue(all(int(cell) > 0 for cell in row[1:5]), row)
            self.assertEqual(row[-1], "1, 1")
        self.assertEqual(papers_direct[4], "more than 400")
        self.assertEqual(direct[1:4], ["", "", ""])
        self.assertGreater(int(direct[4]), 50)

    def test_a_thick_object_is_there_on_every_level(self):
        head, _, *rows = self.tables[1]
        self.assertEqual(head[1:], ["level 3", "level 2", "level 1", "level 0"])
        self.assertEqual([row[0] for row in rows], [f"{name}, {RING_ISO}"
                                                    for name in ("large", "small")])
        self.assertEqual(rows[1][1], "")  # has three levels only
        for cell in (*rows[0][1:], *rows[1][2:]):
            count, share = cell.split(", ")
            self.assertGreater(int(count), 0)
            self.assertGreater(float(share.removesuffix(" %")), 95)

    def test_recovery_tells_where_the_run_without_it_began(self):
        self.assertTrue(self.tables[2][2][-1].endswith(" %, from level 3"), self.tables[2])
        self.assertTrue(self.tables[2][3][-1].endswith(" %, from level 2"), self.tables[2])

    def test_the_start_is_that_of_the_first_level(self):
        for row in self.tables[3][2:]:
            first, outside, iso, all_outside, all_iso = map(int, row[1:6])
            self.assertEqual(first, 3 if row[0].startswith("large") else 2)
            self.assertLess(iso, outside)
            self.assertLess(outside, all_outside)
            self.assertLess(iso, all_iso)

    def test_rest_compares_with_the_skull(self):
        (_, _, row), = (self.tables[4],)
        self.assertEqual(row[0], f"small, {RING_ISO}")
        self.assertGreaterEqual(int(row[2]), 20)
        if row[1] != "never":
            self.assertLessEqual(int(row[1]), int(row[2]))

    def test_a_finer_sampling_has_more_vertices(self):
        rows = self.tables[5][2:]
        self.assertEqual([row[0] for row in rows], ["0.7", "0.85", "1.0"])
        counts = [int(row[1].replace(",", "")) for row in rows]
        self.assertEqual(counts, sorted(counts, reverse=True))
        self.assertEqual(rows[1][3], "1.00")

    def test_refused(self):
        for arguments, code, reason in ((("--only", "nothing"), 2, "invalid choice"),
                                        (("--skull", "none.vti", "3"), 1, "no such file"),
                                        (("--skull", self.small, "9999"), 1, "9999")):
            with self.subTest(reason):
                run = run_script("paper_tables.py", *arguments)
                self.assertEqual(run.returncode, code)
                self.assertIn(reason, run.stderr)
                self.assertNotIn("Traceback", run.stderr)


class ShareTest(unittest.TestCase):
    def test_counts_area_within_the_distance(self):
        ball = sphere(10)
        self.assertEqual(share_within(ball, sphere(10.8), 1), 1)
        self.assertEqual(share_within(ball, sphere(11.2), 1), 0)
        # Of a ball moved by 2, what lies within 1 of the first: the zone |cos angle| < 1/2.
        self.assertAlmostEqual(share_within(ball, sphere(10, (0, 0, 2)), 1), 0.5, delta=0.03)

    def test_the_iso_surface_is_closed_at_the_border_and_without_specks(self):
        voxels = np.zeros((20, 20, 20), "u1")
        voxels[:12, 4:16, 4:16] = 100
        voxels[18, 2, 2] = 100
        image = make_image(voxels, (2, 3, 4), (7, 8, 9))
        surface = closed_iso_surface(image, 50)
        self.assertEqual(surface.GetBounds(), (3.5, 15.5, 3.5, 15.5, -0.5, 11.5))
        self.assertEqual(surface.GetNumberOfPolys(), 2 * surface.GetNumberOfPoints() - 4)

    def test_surfaces_come_to_voxels(self):
        image = make_image(np.zeros((4, 4, 4), "u1"), (2, 3, 4), (7, 8, 9))
        moved = in_voxels(sphere(1, (9, 14, 9)), image)
        np.testing.assert_allclose(np.reshape(moved.GetBounds(), (3, 2)).mean(axis=1), (1, 2, 0),
                                   atol=1e-3)


class RunsTest(unittest.TestCase):
    def test_iterations_and_starts_are_those_of_the_history(self):
        with tempfile.TemporaryDirectory() as folder, contextlib.redirect_stdout(io.StringIO()):
            path = write_volume(os.path.join(folder, "r.mha"), ring_voxels(), RING_SPACING)
            surface = Scan(path, RING_ISO).run(SnapshotInterval=10)
        levels = iterations(surface)
        self.assertEqual([level for level, _, _ in levels], [2, 1, 0])
        self.assertEqual(sum(count for _, count, _ in levels),
                         surface.GetHistory().GetNumberOfRows())
        first = starts(surface)[2].GetBounds()
        self.assertLess(first[0], 0)  # about the whole image
        self.assertGreater(first[1], 39)


if __name__ == "__main__":
    unittest.main()
