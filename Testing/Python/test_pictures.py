# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Tests of the scripts that draw pictures: quickstart, documentation figures, video of an
evolution. Require a display."""

import os
import subprocess

import numpy as np

from folder_test_case import FolderTestCase
from sample_volumes import RING_ISO, RING_SPACING, ring_voxels, run_script, write_volume
from vtk_files import read, read_pixels

COMMAND = os.path.join(os.environ["VOLUMIC_TEST_INSTALL_PREFIX"], "bin", "volumic")
FIGURES = "Testing/Benchmarks/figures.py"


class QuickstartTest(FolderTestCase):
    def test_pictures(self):
        volume = write_volume(self.path("ring.mha"), ring_voxels(), RING_SPACING)
        subprocess.run([COMMAND, volume, self.path("surface.vtp"), "--levels-output",
                        self.path("levels.vtm"), "--history", self.path("history.csv"), "--report",
                        self.path("report.json")], check=True)
        run = run_script("Examples/Python/pictures.py", volume, self.folder)
        self.assertEqual((run.returncode, run.stderr), (0, ""))
        for name in ("pyramid.png", "levels.png", "surface-views.png", "history.png"):
            pixels = read_pixels(self.path(name))
            self.assertGreaterEqual(pixels.shape[1], 1200, name)
            self.assertGreater(pixels.std(), 12, name)
        pyramid = read(self.path("pyramid.vtm"))
        self.assertEqual([pyramid.GetBlock(h).GetDimensions() for h in range(3)],
                         [(40,) * 3, (23,) * 3, (13,) * 3])


class FiguresTest(FolderTestCase):
    def test_all_pictures(self):
        scan = (write_volume(self.path("s.mha"), ring_voxels(), RING_SPACING), str(RING_ISO))
        output = self.path("pictures")
        # Other pictures are similar, or drawn by pictures.py.
        of_skull = ["graded", "history", "evolution"]
        run = run_script(FIGURES, "--output", output, "--skull", *scan,
                         "--vessels", *scan, "--only", *of_skull, "vessels", "interfaces")
        self.assertEqual((run.returncode, run.stderr), (0, ""))
        names = sorted(f"{name}.png" for name in (*of_skull, "interfaces", "vessels"))
        self.assertEqual(sorted(os.listdir(output)), names)
        for name in names:
            pixels = read_pixels(os.path.join(output, name))
            self.assertGreater(pixels.shape[1], 900, name)
            self.assertGreater(pixels.std(), 8, name)


class EvolutionTest(FolderTestCase):
    def test_pictures_and_a_video(self):
        ring = write_volume(self.path("ring.mha"), ring_voxels(), RING_SPACING)
        subprocess.run([COMMAND, ring, self.path("ring.vtp"), "--iso", str(RING_ISO),
                        "--finest", "1", "--snapshots", self.path("steps.vtm"),
                        "--snapshot-interval", "20", "--quiet"], check=True)
        for output in ("frames", "ring.ogv"):
            run = run_script("Examples/Python/evolution.py", self.path("steps.vtm"),
                             self.path(output))
            self.assertEqual((run.returncode, run.stderr), (0, ""))
        names = sorted(os.listdir(self.path("frames")))
        first, last = (read_pixels(self.path(f"frames/{names[i]}")) for i in (0, -1))
        self.assertEqual(first.shape, last.shape, "one size for all")
        # The initial surface is larger than the final torus.
        light = [np.count_nonzero(picture.mean(axis=2) > 60) for picture in (first, last)]
        self.assertGreater(light[1], 1000)
        self.assertGreater(light[0], 1.5 * light[1])
        start = self.content("ring.ogv")[:64]
        self.assertTrue(start.startswith(b"OggS"))
        self.assertIn(b"theora", start)
