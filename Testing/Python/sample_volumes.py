# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""A small volume with a known surface, and a function that runs scripts."""

import os
import subprocess
import sys

import numpy as np
from volumic import arrays
from vtkmodules.vtkIOImage import vtkMetaImageWriter

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
RING_SIZE, RING_SPACING, RING_ISO = 40, (1, 1, 1.5), 125.5
MAJOR, MINOR = 0.27 * RING_SIZE, 0.12 * RING_SIZE  # radii in voxels
RING_VOLUME = 2 * np.pi ** 2 * MAJOR * MINOR ** 2 * np.prod(RING_SPACING)  # world units


def ring_voxels(bright=200, dark=50):
    """Return a noisy torus of genus 1, uint8 [z, y, x]."""
    z, y, x = np.indices((RING_SIZE,) * 3) - (RING_SIZE - 1) / 2
    inside = (np.hypot(x, y) - MAJOR) ** 2 + z ** 2 < MINOR ** 2
    noise = np.random.default_rng(3).normal(0, 5, inside.shape)
    return (np.where(inside, bright, dark) + noise).astype("u1")


def make_image(voxels, spacing=(1, 1, 1)):
    return arrays.make_image(voxels, spacing, (0, 0, 0), None)


def write_volume(path, voxels, spacing=(1, 1, 1)):
    """Write a MetaImage; return the path."""
    writer = vtkMetaImageWriter()
    writer.SetFileName(path)
    writer.SetInputData(make_image(voxels, spacing))
    writer.Write()
    return path


def run_script(name, *arguments, **options):
    """Run a script of the project and return the completed process."""
    return subprocess.run([sys.executable, os.path.join(ROOT, name), *arguments],
                          capture_output=True, text=True, check=False, timeout=1200, **options)
