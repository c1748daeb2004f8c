#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""From an array of voxels to arrays of points and triangles: numpy in, numpy out.

    numpy_arrays.py                                    two linked rings, made by numpy
    numpy_arrays.py voxels.npy mesh.npz --iso 0.5 --spacing 1 1 2
    numpy_arrays.py --show                             in a window, by pyvista if it is there

mesh.npz holds `points` (n x 3, world coordinates), `triangles` (m x 3, indices of points, counter-
clockwise seen from outside), `normals` (n x 3, outward), `residual` (n: field minus iso-value) and
`component` (m, 0 = largest area).
"""

import argparse
import io
import sys

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy

from output_files import beside, check_output
from pipeline import prepare_surface, run_surface
from surface_results import surface_line
from terminal import FilterError, Interrupted
from volume_image import VolumeError, make_image


def two_rings(size=48):
    """Voxels [z, y, x] of two linked rings: 1 inside, 0 outside, smooth in between."""
    z, y, x = (np.indices((size, size, size)) - (size - 1) / 2) / size
    first = np.hypot(np.hypot(x + 0.12, y) - 0.25, z)
    second = np.hypot(np.hypot(x - 0.12, z) - 0.25, y)
    distance = np.minimum(first, second) - 0.09
    return np.clip(0.5 - size * distance, 0, 1).astype(np.float32)


def surface_of_array(voxels, iso, spacing=(1, 1, 1), origin=(0, 0, 0), properties=None):
    """vtkPolyData: the surface at iso in voxels[z, y, x]; spacing and origin are x, y, z."""
    # In VTK x runs fastest, so it is numpy's last index; make_image copies the voxels.
    surface = prepare_surface(make_image(voxels, spacing, origin), iso, properties)
    run_surface(surface)
    return surface.GetOutput()


def arrays_of_surface(surface):
    """Arrays by name, see above. They share VTK's memory: they hold it as long as they live."""
    points, cells = surface.GetPointData(), surface.GetCellData()
    return {
        "points": vtk_to_numpy(surface.GetPoints().GetData()),
        "triangles": vtk_to_numpy(surface.GetPolys().GetConnectivityArray()).reshape(-1, 3),
        "normals": vtk_to_numpy(points.GetArray("Normals")),
        "residual": vtk_to_numpy(points.GetArray("Residual")),
        "component": vtk_to_numpy(cells.GetArray("Component")),
    }


def show(surface):
    """Open pyvista's window; it takes any output of the filters as it is."""
    try:
        import pyvista  # pylint: disable=import-outside-toplevel
    except ImportError as error:
        raise FilterError("--show needs pyvista, which is not installed") from error
    pyvista.wrap(surface).plot(scalars="Component", smooth_shading=True)


def volume_of(points, triangles):
    """Enclosed volume, by the divergence theorem."""
    a, b, c = (points[triangles[:, corner]] for corner in range(3))
    return (a * np.cross(b, c)).sum() / 6


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("voxels", nargs="?", help=".npy, an array [z, y, x]; default: two rings")
    parser.add_argument("mesh", nargs="?", help=".npz to write")
    parser.add_argument("--iso", type=float, default=0.5, help="value on the surface; default: 0.5")
    parser.add_argument("--spacing", type=float, nargs=3, default=(1, 1, 1), metavar=tuple("XYZ"),
                        help="of the voxels, in world units")
    parser.add_argument("--show", action="store_true", help="in a window, with pyvista")
    arguments = parser.parse_args()
    try:
        if arguments.mesh:
            if not arguments.mesh.endswith(".npz"):
                arguments.mesh += ".npz"
            check_output(arguments.mesh, [arguments.voxels])
        voxels = np.load(arguments.voxels) if arguments.voxels else two_rings()
        surface = surface_of_array(voxels, arguments.iso, arguments.spacing)
        arrays = arrays_of_surface(surface)
        print(f"  {surface_line(surface)}")
        for name, array in arrays.items():
            print(f"  {name}: {' x '.join(map(str, array.shape))} {array.dtype}")
        print(f"  volume of the triangles: {volume_of(arrays['points'], arrays['triangles']):,.1f}")
        if arguments.mesh:
            packed = io.BytesIO()
            np.savez_compressed(packed, **arrays)
            with beside(arguments.mesh) as path, open(path, "wb") as file:
                file.write(packed.getbuffer())
            print(f"Written: {arguments.mesh}")
        if arguments.show:
            show(surface)
    except (FilterError, Interrupted, VolumeError, ValueError, OSError) as error:
        sys.exit(f"numpy_arrays.py: {error}")


if __name__ == "__main__":
    main()
