# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The script that makes the documents' pictures, and the example that makes a video of an evolution,
on a small volume. Needs a display."""

import os
import subprocess
import unittest

import numpy as np

from folder_test_case import SharedFolderTestCase
from sample_volumes import RING_ISO, RING_SPACING, ring_voxels, run_script, write_volume
from vtk_files import read_pixels

COMMAND = os.path.join(os.environ["VOLUMIC_TEST_INSTALL_PREFIX"], "bin", "volumic")
FIGURES = "Testing/Benchmarks/figures.py"


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
        of_skull = ["graded", "history", "evolution"]
        run = run_script(FIGURES, "--output", output, "--skull", *self.scan,
                         "--vessels", *self.scan, "--graded", *self.scan, "0.2", "--only",
                         *of_skull, "vessels", "interfaces")
        self.assertEqual((run.returncode, run.stderr), (0, ""))
        names = sorted([*(f"{name}.png" for name in of_skull), "graded-s.png", "interfaces.png",
                        "vessels.png"])
        self.assertEqual(sorted(os.listdir(output)), names)
        for name in names:
            pixels = read_pixels(os.path.join(output, name))
            self.assertGreater(pixels.shape[1], 900, name)
            self.assertGreater(pixels.std(), 8, name)

    def test_refused(self):
        output = ("--output", self.path("none"), "--only")
        self.refused(FIGURES, (2, "invalid choice", *output, "nothing"),
                     (1, "none.vti", *output, "vessels", "--vessels", "none.vti", "3"),
                     (1, "Iso Value", *output, "graded", "--skull", self.ring, "9999"))


class EvolutionTest(ScriptTest):
    def test_pictures_and_a_video(self):
        subprocess.run([COMMAND, self.ring, self.path("ring.vtp"), "--iso", str(RING_ISO),
                        "--finest", "1", "--snapshots", self.path("steps.vtm"),
                        "--snapshot-interval", "20", "--quiet"], check=True)
        for output in ("frames", "ring.ogv"):
            run = run_script("Examples/Python/evolution.py", self.path("steps.vtm"),
                             self.path(output))
            self.assertEqual((run.returncode, run.stderr), (0, ""))
        names = sorted(os.listdir(self.path("frames")))
        first, last = (read_pixels(self.path(f"frames/{names[i]}")) for i in (0, -1))
        self.assertEqual(first.shape, last.shape, "one size for all")
        # Not black, and a body at first that is larger than the ring at last.
        light = [np.count_nonzero(picture.mean(axis=2) > 60) for picture in (first, last)]
        self.assertGreater(light[1], 1000)
        self.assertGreater(light[0], 1.5 * light[1])
        start = self.content("ring.ogv")[:64]
        self.assertTrue(start.startswith(b"OggS"))
        self.assertIn(b"theora", start)


if __name__ == "__main__":
    unittest.main()
