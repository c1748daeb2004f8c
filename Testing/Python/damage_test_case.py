# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Tests that damage files on purpose."""

import numpy as np

from folder_test_case import FolderTestCase


class DamageTestCase(FolderTestCase):
    """Who derives from it has accepted_file(name, content) and refused_file(..., reason)."""

    def cut(self, name, content, reason, rests=(0.5, -10)):
        """The whole file is taken, but not this share, or all but so many bytes."""
        self.accepted_file(name, content)
        for rest in rests:
            with self.subTest(name, rest=rest):
                count = int(len(content) * rest) if 0 < rest < 1 else rest
                self.refused_file(name, content[:count], reason)

    def flipped(self, name, content, reason, start, times=25):
        """With one bit of the data turned over it is refused, wherever that is."""
        generator = np.random.default_rng(6)
        for _ in range(times):
            damaged = bytearray(content)
            place = int(generator.integers(start, len(content)))
            damaged[place] ^= 1 << int(generator.integers(8))
            with self.subTest(name, place=place):
                self.refused_file(name, bytes(damaged), reason)
