# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The images of these scripts, and the error about a volume that cannot be read.

An image is a vtkImageData with one scalar component per voxel. Its world coordinates are those of
the file. Where the file tells which side of the body the world axes point to, the image carries
the field data `Axes`: three letters of L R, A P, S I (left, right, anterior, posterior, superior,
inferior), one for each of world x, y, z. "LPS" is what DICOM uses, "RAS" what NIfTI uses.
"""

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonDataModel import vtkImageData

ARRAY_NAME = "Intensity"
AXES_NAME = "Axes"
OPPOSITE = dict(zip("LRAPSI", "RLPAIS"))


class VolumeError(Exception):
    """A volume that cannot be read; the text says which file and why."""


def make_image(voxels, spacing, origin=(0, 0, 0), direction=None):
    """vtkImageData of the array voxels[z, y, x]; origin and spacing in world units.

    direction: 3 x 3, its columns the unit vectors of index x, y, z in the world.
    """
    if voxels.ndim != 3:
        raise VolumeError(f"a volume has three dimensions, not {voxels.ndim}")
    if voxels.dtype.kind not in "iuf":
        raise VolumeError(f"voxels of type {voxels.dtype} are not numbers that VTK images can hold")
    if not all(np.isfinite(s) and s > 0 for s in spacing):
        raise VolumeError(f"the voxel spacing must be positive, not {tuple(spacing)}")
    native = np.ascontiguousarray(voxels, dtype=voxels.dtype.newbyteorder("="))
    if native.dtype == np.float16:
        native = native.astype(np.float32)
    scalars = numpy_to_vtk(native.ravel(), deep=True)
    scalars.SetName(ARRAY_NAME)

    image = vtkImageData()
    image.SetDimensions(voxels.shape[::-1])
    image.GetPointData().SetScalars(scalars)
    image.SetSpacing([float(s) for s in spacing])
    image.SetOrigin([float(o) for o in origin])
    if direction is not None:
        image.SetDirectionMatrix(np.ravel(direction))
    return image


def world_axes(image):
    """The letters of world x, y, z, or None where the file did not tell."""
    label = image.GetFieldData().GetAbstractArray(AXES_NAME)
    return label.GetValue(0) if label is not None else None


def direction_of(image):
    """The direction matrix as a 3 x 3 numpy array, columns index x, y, z."""
    matrix = image.GetDirectionMatrix()
    return np.array([[matrix.GetElement(r, c) for c in range(3)] for r in range(3)])
