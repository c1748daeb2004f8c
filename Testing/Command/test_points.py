# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Text files of seeds and attracting points for `volumic`: no line is dropped without a word."""

import unittest

from command_test_case import CENTRE, ISO, ORIGIN, SPACING, CommandTestCase

SEED = ",".join(map(str, ORIGIN + SPACING * CENTRE)).encode()


class PointsTest(CommandTestCase):
    def seeded(self, content, status=0):
        self.write_bytes("seeds.csv", content)
        return self.run_command(self.ball_file(), "--iso", ISO, "--levels", 1, "--seeds",
                             self.path("seeds.csv"), "--seed-radius", 2, "--report", "-", "-q",
                             status=status)

    def test_headings(self):
        for heading in (b"x,y,z\n", b"X Y Z\n", b'"x","y","z"\r\n', b"# seeds\n\nx, y, z # mm\n",
                        b"\xef\xbb\xbfx,y,z\n", b"\xef\xbb\xbf", b"\n"):
            with self.subTest(heading):
                self.assertIn('"components": 1', self.seeded(heading + SEED).stdout)

    def test_lines_that_are_no_heading(self):
        for content, place in (
                (b"1 2 x\n", "line 1: 'x' is not a number"), (b"1;2;3\n", "line 1: '1;2;3' is not"),
                (b"1.5.2 2 3\n", "line 1: '1.5.2' is not"), (b"1 2\n", "line 1: not three numbers"),
                (b"nan nan nan\n", "line 1: 'nan' is not a number"),
                (b"inf 1 2\n", "line 1: 'inf' is not"), (b"1,5 2,0 3,5\n", "line 1: not three"),
                (b"x,y,z\nx,y,z\n", "line 2: 'x' is not"), (b"x,y,z\n1,2,three\n", "line 2: 'thr")):
            with self.subTest(content):
                error = self.seeded(content + SEED + b"\n", status=1).stderr
                self.assertRegex(error, f"seeds.csv: {place}")

    def test_attracting_points_likewise(self):
        self.write_bytes("points.txt", b"1 2 3 heavy\n")
        self.refused("points.txt: line 1: 'heavy' is not a number", self.ball_file(),
                     self.path("a.stl"), "--attracting-points", self.path("points.txt"))

    def test_a_heading_alone(self):
        self.assertIn("has no points", self.seeded(b"x,y,z\n", status=1).stderr)


if __name__ == "__main__":
    unittest.main()
