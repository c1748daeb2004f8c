# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Whole runs of the program that go through most of it: also what Testing/sanitize.sh watches, so
that they do without Volumic's Python package."""

import os
import unittest

import numpy as np
from vtkmodules.vtkIOXML import vtkXMLImageDataWriter

from tool_test_case import ISO, ToolTestCase, ball, make_image

SMALLEST_IN_SWEEPS = (407, 407, 407)  # voxels: more than 2^26


class RunsTest(ToolTestCase):
    def content(self, name):
        with open(self.path(name), "rb") as file:
            return file.read()

    def test_a_limit_of_memory(self):
        volume = self.ball_file()
        self.run_tool(volume, self.path("a.ply"), "--iso", ISO)
        self.run_tool(volume, self.path("b.ply"), "--iso", ISO, "--memory", "500M", "--scratch",
                      self.folder)
        self.assertGreater(len(self.content("a.ply")), 1000)
        self.assertEqual(self.content("a.ply"), self.content("b.ply"))

    def test_labels(self):
        """Two halves of a ball, each by itself and in one surface."""
        labels = np.where(ball() > ISO, 3, 0)
        labels[:, :, 8:] *= 2
        volume = self.write(vtkXMLImageDataWriter(), "map.vti", make_image(labels.astype("u1")))
        self.run_tool(volume, self.path("each/"), "--labels", "all", "--memory", "500M")
        self.assertEqual(sorted(os.listdir(self.path("each"))), ["label-3.vtp", "label-6.vtp"])
        self.run_tool(volume, self.path("merged.vtp"), "--labels", "all", "--merge")
        self.assertIn(b'"Label"', self.content("merged.vtp"))

    def test_a_level_in_sweeps(self):
        """By its size alone; the ball is small, as it is what takes time."""
        x, y, z = SMALLEST_IN_SWEEPS
        with open(self.path("large.raw"), "wb") as file:
            file.truncate(x * y * z)
        voxels = np.memmap(self.path("large.raw"), "u1", "r+", shape=(z, y, x))
        k, j, i = np.mgrid[-9:10, -9:10, -9:10]
        voxels[191:210, 191:210, 191:210] = np.clip(
            100 + 20 * (6 - np.sqrt(i * i + j * j + k * k)), 0, 200)
        voxels.flush()
        self.write_bytes("large.mhd", b"ObjectType = Image\nNDims = 3\nDimSize = %d %d %d\n"
                         b"ElementType = MET_UCHAR\nElementDataFile = large.raw\n" % (x, y, z))
        told = self.run_tool(self.path("large.mhd"), self.path("a.stl"), "--iso", "100.5",
                             "--levels", "1", "--seed-position", "200,200,200",
                             "--progress").stderr
        self.assertIn("sweep", told)
        self.assertGreater(len(self.content("a.stl")), 1000)


if __name__ == "__main__":
    unittest.main()
