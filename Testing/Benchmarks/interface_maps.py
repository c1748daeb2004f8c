# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The label maps of benchmark_interfaces.py: made ones, and those in files."""

import os
import subprocess
import tempfile

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOImage import vtkNIFTIImageReader
from vtkmodules.vtkIOXML import vtkXMLImageDataReader

from interface_figures import LabelVoxels

TEMPLATES = "/usr/share/mricron/templates"


def read(path):
    """A .vti, or a NIfTI file; voxels as they are told, but the first one at 0."""
    reader = vtkXMLImageDataReader() if path.endswith(".vti") else vtkNIFTIImageReader()
    reader.SetFileName(path)
    reader.Update()
    image = reader.GetOutput()
    values = vtk_to_numpy(image.GetPointData().GetScalars())
    return LabelVoxels(values.reshape(image.GetDimensions()[::-1]).astype(np.int16),
                       image.GetSpacing())


def polycrystal(size, grains):
    """Voronoi cells of random places; there is no background."""
    places = np.random.default_rng(34).random((grains, 3)) * (size - 1)
    at = np.arange(size, dtype=float)
    nearest = np.full((size, ) * 3, np.inf)
    values = np.zeros(nearest.shape, np.int16)
    for grain, (x, y, z) in enumerate(places, 1):
        squared = (((at - z) ** 2)[:, None, None] + ((at - y) ** 2)[None, :, None]
                   + ((at - x) ** 2)[None, None, :])
        values[squared < nearest] = grain
        np.minimum(nearest, squared, out=nearest)
    return LabelVoxels(values)


def tooth(size):
    """Pulp (1) in dentin (2), and enamel (3) on the crown; cut open along an oblique plane, so that
    all three meet the background there."""
    z, y, x = np.mgrid[:size, :size, :size] / (size - 1) * 2 - 1
    # Slimmer towards the root, which is down.
    around = np.hypot(x + .03, y - .02) / (.62 + .3 * z)

    def within(half_width, root, crown):
        middle, half_height = (crown + root) / 2, (crown - root) / 2
        return (around / half_width) ** 2 + ((z - middle) / half_height) ** 2 < 1
    values = np.zeros(x.shape, np.int16)
    values[within(.93, -.4, .85) & (z > .02 + .1 * x)] = 3
    values[within(.75, -.88, .7)] = 2
    values[within(.33, -.75, .35)] = 1
    values[y + .1 * x + .07 * z > .06] = 0
    return LabelVoxels(values)


def organs(size, labels, make_volume):
    """By MakeVolume, every second layer of it: ellipsoids and tubes, 1.5 x 1.5 x 3."""
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "body.vti")
        subprocess.run([make_volume, "body", str(size), str(labels), path], check=True)
        body = read(path)
    return LabelVoxels(body.values[::2], body.spacing * (1, 1, 2))


def template(name):
    """Of Debian's mricron-data; None where that is not installed."""
    path = os.path.join(TEMPLATES, f"{name}.nii.gz")
    return read(path) if os.path.exists(path) else None


def named_maps(make_volume):
    """{name: what makes it}"""
    return {
        "polycrystal": lambda: polycrystal(128, 60),
        "tooth": lambda: tooth(128),
        "organs": lambda: organs(240, 40, make_volume),
        "aal": lambda: template("aal"),
        "JHU": lambda: template("JHU-WhiteMatter-labels-1mm"),
        "small": lambda: polycrystal(32, 6)}
