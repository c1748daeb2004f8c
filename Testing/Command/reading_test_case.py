# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Tests of volumic.reading in this process: each file is read, or rejected in one line that names
it."""

import time
import warnings

import numpy as np

from command_test_case import ORIGIN, SPACING, ball
from folder_test_case import FolderTestCase
from volumic import reading

SECONDS = 20  # of the processor


def noisy_ball(dtype="i2"):
    """Return a ball with noise, which compresses badly, so that damage mostly affects voxels."""
    noise = np.random.default_rng(5).integers(0, 4, ball().shape)
    return (ball() + noise).astype(dtype)


class ReadingTestCase(FolderTestCase):
    def read(self, name, content=None, **choice):
        """Return the volume of a file, which is first written if content is given."""
        if content is not None:
            self.write_bytes(name, bytes(content))
        return reading.read(self.path(name), **choice)

    def check(self, volume, voxels=None, direction=np.eye(3), spacing=SPACING, origin=ORIGIN):
        """Check voxels and positions of a volume."""
        voxels = ball() if voxels is None else voxels
        np.testing.assert_array_equal(volume.array, voxels)
        self.assertEqual(volume.array.dtype, voxels.dtype)
        np.testing.assert_allclose(volume.spacing, spacing, rtol=1e-6)
        np.testing.assert_allclose(volume.origin, origin, atol=1e-6)
        np.testing.assert_allclose(volume.direction, direction, atol=1e-6)
        return volume

    def rejects(self, name, reason, content=None, **choice):
        """Check that a file is rejected for this reason."""
        used = time.process_time()
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            with self.assertRaises(reading.VolumeError) as caught:
                self.read(name, content, **choice)
        text = str(caught.exception)
        self.assertTrue(text.startswith(self.path(name)) and "\n" not in text, text)
        self.assertRegex(text[len(self.path(name)):], reason)
        self.assertLess(time.process_time() - used, SECONDS)
