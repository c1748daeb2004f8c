#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""From a volume to its pyramid with the installed package `volumic`; see quickstart.sh.

Reads a volume (by default a CT of a skull from Debian's package invesalius-examples), builds the
pyramid and writes into the output folder

    pyramid.vtm   the levels, one image each (ParaView opens it)
    pyramid.png   slices and iso-surfaces of every level
"""

import argparse
import os
import sys

from vtkmodules.vtkIOXML import vtkXMLMultiBlockDataWriter

from otsu import otsu_iso_value
from pyramid_picture import level_unit, pyramid_levels, pyramid_picture
from read_volume import VolumeError, read_volume
from render import write_png
from terminal import FilterError, run_filter

SKULL = "/usr/share/doc/invesalius-examples/examples/Cranium.inv3"
SKULL_ISO = 226.5  # bone; between two integers, so that no voxel equals it


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("volume", nargs="?", default=SKULL,
                        help="volume that read_volume.py can read; default: the skull")
    parser.add_argument("iso", nargs="?", type=float,
                        help="iso-value; default: Otsu's threshold (for the skull 226.5)")
    parser.add_argument("--output", default="quickstart", help="folder for the results")
    return parser.parse_args()


def load(arguments):
    """The volume and the iso-value."""
    print(f"Reading {arguments.volume}")
    image = read_volume(arguments.volume)
    scalars = image.GetPointData().GetScalars()
    print(f"  {' x '.join(map(str, image.GetDimensions()))} voxels of"
          f" {' x '.join(f'{s:.4g}' for s in image.GetSpacing())}, {scalars.GetDataTypeAsString()},"
          f" values {scalars.GetRange()[0]:g} to {scalars.GetRange()[1]:g}")
    if arguments.iso is not None:
        print(f"  iso-value {arguments.iso:g}")
        return image, arguments.iso
    if os.path.basename(arguments.volume) == os.path.basename(SKULL):
        print(f"  iso-value {SKULL_ISO:g} (bone)")
        return image, SKULL_ISO
    iso = otsu_iso_value(image)
    print(f"  iso-value {iso:g} by Otsu's threshold; give another one after the volume's name")
    return image, iso


def build_pyramid(image):
    """The vtkMultiBlockDataSet of the levels."""
    from volumic import vtkImagePyramid  # pylint: disable=import-outside-toplevel
    pyramid = vtkImagePyramid()
    pyramid.SetInputData(image)
    run_filter(pyramid, "Building the pyramid")
    for number, level in enumerate(pyramid_levels(pyramid.GetOutput())):
        print(f"  level {number}: {' x '.join(map(str, level.GetDimensions()))} voxels,"
              f" unit {level_unit(level):.4g}")
    return pyramid.GetOutput()


def write_blocks(blocks, path):
    """A .vtm file and, in a folder beside it, a file for each block."""
    writer = vtkXMLMultiBlockDataWriter()
    writer.SetFileName(path)
    writer.SetInputData(blocks)
    if not writer.Write():
        raise OSError(f"{path} cannot be written")
    return path


def main():
    arguments = parse_arguments()
    os.makedirs(arguments.output, exist_ok=True)
    written = []

    def target(name):
        written.append(os.path.join(arguments.output, name))
        return written[-1]

    try:
        image, iso = load(arguments)
        title = os.path.basename(os.path.normpath(arguments.volume))
        pyramid = build_pyramid(image)
        write_blocks(pyramid, target("pyramid.vtm"))
        print("Drawing")
        write_png(pyramid_picture(pyramid, iso, title), target("pyramid.png"))
    except (VolumeError, FilterError, ValueError, OSError) as error:
        sys.exit(f"quickstart.py: {error}")
    print("Written:")
    for path in written:
        print(f"  {path}")


if __name__ == "__main__":
    main()
