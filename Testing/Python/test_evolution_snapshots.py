# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Examples/Python/evolution_snapshots.py: a video, pictures, and surfaces in time. Needs a display."""

import json
import os
import unittest

import numpy as np

from folder_test_case import FolderTestCase
from sample_volumes import RING_ISO, RING_SPACING, ring_voxels, run_script, write_volume
from vtk_files import read, read_pixels


class EvolutionSnapshotsTest(FolderTestCase):
    def setUp(self):
        super().setUp()
        self.ring = write_volume(self.path("ring.mha"), ring_voxels(), RING_SPACING)

    def snapshots(self, output, *options):
        return run_script("evolution_snapshots.py", self.ring, self.path(output), "--iso",
                          str(RING_ISO), "--width", "200", *options)

    def test_pictures(self):
        run = self.snapshots("frames", "--every", "20")
        self.assertEqual(run.returncode, 0, run.stderr)
        names = sorted(os.listdir(self.path("frames")))
        self.assertGreater(len(names), 20)
        self.assertEqual(names[:2], ["frame0000.png", "frame0001.png"])
        first, last = (read_pixels(self.path(f"frames/{names[i]}")) for i in (0, -1))
        self.assertEqual(first.shape, last.shape, "one size for all")
        # Not black, and a body at first that is larger than the ring at last.
        light = [np.count_nonzero(picture.mean(axis=2) > 60) for picture in (first, last)]
        self.assertGreater(light[1], 1000)
        self.assertGreater(light[0], 1.5 * light[1])

    def test_video(self):
        run = self.snapshots("ring.ogv", "--every", "40")
        self.assertEqual(run.returncode, 0, run.stderr)
        start = self.content("ring.ogv")[:64]
        self.assertTrue(start.startswith(b"OggS"))
        self.assertIn(b"theora", start)

    def test_surfaces_in_time(self):
        run = self.snapshots("ring.vtp.series", "--every", "10", "--finest-level", "1")
        self.assertEqual(run.returncode, 0, run.stderr)
        files = json.loads(self.content("ring.vtp.series"))["files"]
        self.assertEqual([file["time"] for file in files], list(range(len(files))))
        levels = []
        for file in files:
            surface = read(self.path(file["name"]))
            self.assertGreater(surface.GetNumberOfPolys(), 0)
            levels.append(int(surface.GetFieldData().GetArray("Level").GetTuple1(0)))
        self.assertEqual(levels, sorted(levels, reverse=True))
        self.assertEqual(levels[-1], 1)
        # The last is at rest: it says why the evolution stopped.
        self.assertTrue(surface.GetFieldData().GetAbstractArray("StopReason"))

    def test_refusals(self):
        self.assertEqual(self.snapshots("a.ogv", "--every", "0").returncode, 2)
        run = self.snapshots("a.ogv", "--iso", "1e6")
        self.assertEqual(run.returncode, 1)
        self.assertIn("Iso Value", run.stderr)
        self.assertFalse(os.path.exists(self.path("a.ogv")))


if __name__ == "__main__":
    unittest.main()
