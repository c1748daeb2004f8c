# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""An iso-value for a volume about which nothing is known: Otsu's threshold.

It separates the voxels into two classes of the largest variance between them (N. Otsu, "A threshold
selection method from gray-level histograms", IEEE Trans. SMC 9, 1979). It is a guess: in a CT it
finds the skin rather than the bone.
"""

import math

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy

BINS = 1024


def otsu_iso_value(image):
    """The iso-value for the image's active scalars, equal to no voxel (k + 1/2 for integers).

    ValueError where no value separates the voxels: all equal, NaN or infinite ones.
    """
    voxels = vtk_to_numpy(image.GetPointData().GetScalars())
    smallest, largest = voxels.min(), voxels.max()
    if not (np.isfinite(smallest) and np.isfinite(largest)):
        raise ValueError("the volume has NaN or infinite voxels")
    if smallest == largest:
        raise ValueError(f"all voxels are {smallest:g}: there is no surface in this volume")
    threshold = split_of(*np.histogram(voxels, bins=BINS))
    below = voxels[voxels <= threshold].max(initial=smallest)
    above = voxels[voxels > below].min()
    middle = (float(below) + float(above)) / 2
    return math.floor(middle) + 0.5 if voxels.dtype.kind in "iu" else middle


def split_of(counts, edges):
    """The edge between two bins that gives the largest variance between the classes."""
    weights = counts / counts.sum()
    centres = (edges[:-1] + edges[1:]) / 2
    low = np.cumsum(weights)[:-1]
    mean_low = np.cumsum(weights * centres)[:-1]
    mean = (weights * centres).sum()
    with np.errstate(divide="ignore", invalid="ignore"):
        variance = (mean * low - mean_low) ** 2 / (low * (1 - low))
    variance = np.nan_to_num(variance, nan=-1, posinf=-1)
    best = np.flatnonzero(variance >= variance.max() * (1 - 1e-12))
    return edges[1 + best[len(best) // 2]]  # the middle of a gap between the classes
