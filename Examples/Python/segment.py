#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""One volume to one closed surface, as a file of triangles in world coordinates.

    segment.py scan.nii.gz bone.stl --iso 226.5
    segment.py scan.nii.gz airways.ply --iso -500 --dark --set FinestLevel=1
    segment.py scan.nii.gz bone.stl --iso 226.5 --set EdgeLength=2.5
    segment.py organs.nii.gz organs/ --labels all --format stl
    segment.py organs.nii.gz lungs.stl --labels 'lung_*' --merge --set Smoothing=1

VOLUME is what read_volume.py can read. The suffix of OUTPUT tells its format: .stl (binary), .ply
(binary, with normals), .obj or .vtp (VTK's, with all arrays and field data). A bar shows how far it
is. Ctrl-C ends the evolution early: the surface as it is then is written, closed and free of
self-intersections. With --labels the volume is a label map, and OUTPUT a folder for a surface of
each label, a .vtm, or a file of one surface.

Ends with 0, or 1 after an error, 2 if the command line is wrong, 3 if Ctrl-C or the limit of the
iterations stopped it: then the surface as it was is written.
"""

import argparse
import sys

from label_surfaces import is_folder, segment_labels
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


def add_label_options(parser):
    """The options of label maps."""
    parser.add_argument("--labels", metavar="LIST", help="the volume is a label map: a surface of"
                        " each of these labels, 'all' or such as 1,7-9,liver,lung_*; --set is of"
                        " vtkLabelsToSurfaces then")
    parser.add_argument("--label-names", metavar="FILE",
                        help="names of labels; default: those of the volume or beside it")
    parser.add_argument("--merge", action="store_true", help="one surface about all of the labels")
    parser.add_argument("--format", metavar="SUFFIX",
                        help="what the files in a folder are; default: vtp")


def label_properties(arguments):
    """As filter_properties, of vtkLabelsToSurfaces; ValueError for options that are of others."""
    for option, value in (("--iso", arguments.iso is not None), ("--dark", arguments.dark)):
        if value:
            raise ValueError(f"{option} and --labels exclude each other")
    if arguments.format and not is_folder(arguments.output):
        raise ValueError("--format is that of the files in a folder: give one to write to")
    properties = {"Merge": "on"} if arguments.merge else {}
    properties.update(parse_settings(arguments.properties))
    check_properties(properties, "vtkLabelsToSurfaces")
    return properties


def filter_properties(arguments):
    """Names and values of the properties that add_filter_options asked for."""
    properties = {"ObjectIsBright": "off"} if arguments.dark else {}
    properties.update(parse_settings(arguments.properties))
    check_properties(properties)
    return properties


def parse_settings(settings):
    """{NAME: VALUE} of the texts NAME=VALUE."""
    properties = {}
    for setting in settings:
        name, equals, value = setting.partition("=")
        if not equals:
            raise ValueError(f"--set {setting}: NAME=VALUE is wanted")
        properties[name] = value
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
    parser.add_argument("output", help="file to write; with --labels a folder, or .vtm")
    add_filter_options(parser)
    add_label_options(parser)
    arguments = parser.parse_args()
    for option in ("label_names", "merge", "format"):
        if getattr(arguments, option) and arguments.labels is None:
            parser.error(f"--{option.replace('_', '-')} needs --labels")
    try:
        if arguments.labels is not None:
            is_finished = segment_labels(
                arguments.volume, arguments.output, arguments.labels, label_properties(arguments),
                arguments.label_names, arguments.format or "vtp")
            return 0 if is_finished else INTERRUPTED
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
