# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Tests of `volumic --triangles`."""

import os
import re

import numpy as np
from vtkmodules.vtkIOXML import vtkXMLImageDataWriter

from command_test_case import ISO, CommandTestCase, ball, make_image
from vtk_files import read


class TrianglesTest(CommandTestCase):
    def triangles(self, count, volume=None, iso=ISO):
        process = self.run_command(volume or self.ball_file(), self.path("a.vtp"), "--iso", iso,
                                   "--triangles", count)
        return read(self.path("a.vtp")).GetNumberOfPolys(), process.stderr

    def test_number_of_triangles(self):
        whole, printed = self.triangles(4000)
        self.assertTrue(4000 / 1.1 <= whole <= 1.1 * 4000, printed)
        self.assertRegex(printed, rf"edge length [0-9.]+: {whole} triangles")
        uniform = int(re.search("tolerance 0: ([0-9]+) triangles", printed).group(1))
        for share in (1.0, 0.5, 0.1):
            found, printed = self.triangles(int(share * uniform))
            self.assertTrue(share * uniform / 1.1 <= found <= share * uniform * 1.1, printed)
            self.assertIn(f": {found} triangles", printed)

    def test_a_sponge(self):
        """No tolerance yields few triangles."""
        z, y, x = np.mgrid[0:40, 0:40, 0:40] / 4.5
        waves = np.sin(x) * np.cos(y) + np.sin(y) * np.cos(z) + np.sin(z) * np.cos(x)
        sponge = self.write(vtkXMLImageDataWriter(), "sponge.vti",
                            make_image(waves.astype("f4"), (1, 1, 1)))
        found, printed = self.triangles(2500, volume=sponge, iso=0)
        self.assertTrue(2500 / 1.1 <= found <= 2500 * 1.1, printed)

    def test_labels(self):
        """Interfaces are stored once in a mesh and twice in a folder."""
        halves = np.where(ball() > ISO, 3, 0)
        halves[:, :, 8:] *= 2
        volume = self.write(vtkXMLImageDataWriter(), "map.vti", make_image(halves.astype("u1")))
        for output in ("each/", "all.vtp"):
            self.run_command(volume, self.path(output), "--labels", "all", "--triangles", 2000)
            names = ([f"each/{name}" for name in os.listdir(self.path("each"))]
                     if output == "each/" else [output])
            count = sum(read(self.path(name)).GetNumberOfPolys() for name in names)
            self.assertTrue(2000 / 1.1 <= count <= 2000 * 1.1, count)

    def test_unreachable_number_fails(self):
        process = self.run_command(self.ball_file(), self.path("a.vtp"), "--iso", ISO,
                                   "--triangles", 20, status=1)
        self.assertRegex(process.stderr, "no tolerance or edge length yields this number; the nearest")
        self.assertFalse(os.path.exists(self.path("a.vtp")))
