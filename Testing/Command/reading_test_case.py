# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Tests of volumic.reading in this process: each file is read, or refused in one line that names
it, in a few seconds."""

import os
import sys
import time
import warnings

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "Python"))
# pylint: disable=wrong-import-position
from command_test_case import ORIGIN, SPACING, ball
from folder_test_case import FolderTestCase
from volumic import reading

SECONDS = 20  # of the processor


def noisy_ball(dtype="i2"):
    """Noise does not pack well: damage in packed voxels is seldom damage of the packing."""
    noise = np.random.default_rng(5).integers(0, 4, ball().shape)
    return (ball() + noise).astype(dtype)


class ReadingTestCase(FolderTestCase):
    def read(self, name, content=None, **choice):
        """The volume of a file in the folder of the test, that is written first if it has content."""
        if content is not None:
            self.write_bytes(name, bytes(content))
        return reading.read(self.path(name), **choice)

    def check(self, volume, voxels=None, direction=np.eye(3), spacing=SPACING, origin=ORIGIN):
        """The volume has these voxels at these positions."""
        voxels = ball() if voxels is None else voxels
        np.testing.assert_array_equal(volume.array, voxels)
        self.assertEqual(volume.array.dtype, voxels.dtype)
        np.testing.assert_allclose(volume.spacing, spacing, rtol=1e-6)
        np.testing.assert_allclose(volume.origin, origin, atol=1e-6)
        np.testing.assert_allclose(volume.direction, direction, atol=1e-6)
        return volume

    def refused(self, name, reason, content=None, **choice):
        """The file is refused for this reason."""
        used = time.process_time()
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            with self.assertRaises(reading.VolumeError) as caught:
                self.read(name, content, **choice)
        text = str(caught.exception)
        self.assertTrue(text.startswith(self.path(name)) and "\n" not in text, text)
        self.assertRegex(text[len(self.path(name)):], reason)
        self.assertLess(time.process_time() - used, SECONDS)

    def refused_with(self, name, content, changes):
        """The content is read, but not with each of these changes: (old bytes, new bytes, reason)
        or (place, new bytes, reason)."""
        self.read(name, content)
        for old, new, reason in changes:
            place = content.index(old) if isinstance(old, bytes) else old
            length = len(old) if isinstance(old, bytes) else len(new)
            with self.subTest(name, old=old, new=new[:30]):
                self.refused(name, reason, content[:place] + new + content[place + length:])

    def cut(self, name, content, reason="truncated|damaged", rests=(0.1, 0.5, 0.9, -10, -1)):
        """The whole file is read, but not this share of it, or all but so many bytes."""
        self.read(name, content)
        for rest in rests:
            with self.subTest(name, rest=rest):
                count = int(len(content) * rest) if 0 < rest < 1 else rest
                self.refused(name, reason, content[:count])

    def flipped(self, name, content, start):
        """With any one bit of packed data turned over it is refused."""
        generator = np.random.default_rng(6)
        for place in generator.integers(start, len(content), 30):
            damaged = bytearray(content)
            damaged[place] ^= 1 << int(generator.integers(8))
            with self.subTest(name, place=place):
                self.refused(name, "damaged|truncated|exceed|too long|missing", damaged)
