#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""One volume to one closed surface, as a file of triangles in world coordinates.

    segment.py scan.nii.gz bone.stl --iso 226.5
    segment.py scan.nii.gz airways.ply --iso -500 --dark --set FinestLevel=1
    segment.py scan.nii.gz bone.stl --iso 226.5 --set EdgeLength=2.5

VOLUME is what read_volume.py can read. The suffix of OUTPUT tells its format: .stl (binary), .ply
(binary, with normals), .obj or .vtp (VTK's, with all arrays and field data). A bar shows how far it
is. Ctrl-C ends the evolution early: the surface as it is then is written, closed and free of
self-intersections.

Ends with 0, or 1 after an error, 2 if the command line is wrong, 3 if Ctrl-C or the limit of the
iterations stopped it: then the surface as it was is written.
"""

import argparse
import sys

from output_files import check_output
from pipeline import (
    build_pyramid, check_properties, load_volume, prepare_surface, run_surface)
from read_volume import VolumeError, files_of_volume
from surface_results import SURFACE_WRITERS, surface_facts, surface_line, write_surface
from terminal import FilterError, Interrupted

INTERRUPTED = 3  # as the command volumic has it


def add_filter_options(parser):
    """The options of segment.py and batch.py that are about the surface."""
    parser.add_argument("--iso", type=float, metavar="VALUE",
                        help="value of the image on the surface; default: Otsu's threshold, a guess"
                        " that in a CT finds the skin rather than the bone")
    parser.add_argument("--dark", action="store_true",
                        help="the object is darker than its surroundings")
    parser.add_argument("--set", action="append", default=[], metavar="NAME=VALUE",
                        dest="properties", help="any property of vtkDeformableSurface, such as"
                        " FinestLevel=1 or Recovery=0; may be given several times")


def filter_properties(arguments):
    """Names and values of the properties that add_filter_options asked for."""
    properties = {"ObjectIsBright": "off"} if arguments.dark else {}
    for setting in arguments.properties:
        name, equals, value = setting.partition("=")
        if not equals:
            raise ValueError(f"--set {setting}: NAME=VALUE is wanted")
        properties[name] = value
    check_properties(properties)
    return properties


def check_surface_output(path, volume):
    """An error where the surface could not be written, before it is made."""
    if not path.lower().endswith(tuple(SURFACE_WRITERS)):
        raise ValueError(f"{path}: the suffix must be one of {', '.join(SURFACE_WRITERS)}")
    check_output(path, files_of_volume(volume))


def segment(volume, output, iso, properties):
    """Read, segment, write; returns the exit code. Prints what it does."""
    check_surface_output(output, volume)
    image, iso = load_volume(volume, iso)
    # The length of the edges decides on the pyramid, which is made by the filter then.
    source = image if "EdgeLength" in properties else build_pyramid(image)[0]
    surface = prepare_surface(source, iso, properties)
    try:
        run_surface(surface)
    except Interrupted:
        if surface.GetOutput().GetNumberOfPolys() == 0:
            raise
    write_surface(surface.GetOutput(), output)
    finished = surface_facts(surface.GetOutput())["stop_reason"] in ("converged", "limit cycle")
    print(f"  {surface_line(surface.GetOutput())}")
    print(f"Written: {output}{'' if finished else ' (not finished)'}")
    return 0 if finished else INTERRUPTED


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0],
                                     epilog=f"Formats: {', '.join(SURFACE_WRITERS)}.")
    parser.add_argument("volume", help="volume that read_volume.py can read")
    parser.add_argument("output", help="file to write")
    add_filter_options(parser)
    arguments = parser.parse_args()
    try:
        return segment(arguments.volume, arguments.output, arguments.iso,
                       filter_properties(arguments))
    except Interrupted as error:
        print(f"segment.py: {error}", file=sys.stderr)
        return INTERRUPTED
    except MemoryError:
        print(f"segment.py: {arguments.volume}: not enough memory; crop it, or resample it to fewer"
              " voxels", file=sys.stderr)
        return 1
    except (VolumeError, FilterError, ValueError, OSError) as error:
        print(f"segment.py: {error}", file=sys.stderr)
        return 1


if __name__ == "__main__":
    sys.exit(main())
