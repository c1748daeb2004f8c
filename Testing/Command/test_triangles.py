# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""`volumic --triangles`: a tolerance for a number of triangles."""

import unittest

from command_test_case import ISO, CommandTestCase
from vtk_files import read


class TrianglesTest(CommandTestCase):
    def triangles(self, count, *options):
        process = self.run_command(self.ball_file(), self.path("a.vtp"), "--iso", ISO, "--triangles",
                                count, *options)
        return read(self.path("a.vtp")).GetNumberOfPolys(), process.stderr

    def test_about_so_many(self):
        whole, said = self.triangles(10 ** 6)
        self.assertIn(f"without a tolerance it has no more than {whole} triangles", said)
        for share in (0.8, 0.5):
            found, said = self.triangles(int(share * whole))
            self.assertTrue(share * whole / 1.1 <= found <= share * whole * 1.1, said)
            self.assertIn(f": {found} triangles", said)
        found, said = self.triangles(20)
        self.assertIn(f"warning: no tolerance was found; this one leaves {found} triangles", said)
        self.assertLess(found, 0.5 * whole)

    def test_what_is_refused(self):
        for reason, *options in (
                ("--triangles and --tolerance exclude each other", "9999", "--tolerance", ".1"),
                ("--triangles and --labels exclude each other", "9999", "--labels", "all"),
                ("--triangles: a surface has 20 triangles at least", "19")):
            self.refused(reason, self.ball_file(), self.path("a.vtp"), "--triangles", *options,
                         status=2)


if __name__ == "__main__":
    unittest.main()
