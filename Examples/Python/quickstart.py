#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""From a volume to a closed surface with the installed package `volumic`; see quickstart.sh.

Reads a volume (by default a CT of a skull from Debian's package invesalius-examples), builds its
pyramid, lets the surface evolve from the coarsest level to the finest, and writes into the output
folder

    pyramid.vtm, pyramid.png   the images of all levels; their slices and iso-surfaces
    levels.vtm, levels.png     the surface at the end of each level
    surface.vtp                the surface of the finest level
    surface-views.png          that surface from several sides, cut open, and on the slices
    history.csv, history.png   what happened at each iteration; the four curves of the paper
    report.json                components, genus, area, volume, seconds per level and more
"""

import argparse
import os
import sys

from history_chart import history_chart
from otsu import otsu_iso_value
from pyramid_picture import level_unit, pyramid_levels, pyramid_picture
from read_volume import VolumeError, read_volume
from render import world_frame, write_png
from surface_pictures import levels_picture, views_picture, visited_levels
from surface_results import (
    component_facts, input_facts, level_facts, summary_lines, surface_facts, versions,
    write_blocks, write_history, write_report, write_surface)
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
    """The filter with the levels, and the seconds it took."""
    from volumic import vtkImagePyramid  # pylint: disable=import-outside-toplevel
    pyramid = vtkImagePyramid()
    pyramid.SetInputData(image)
    seconds, _ = run_filter(pyramid, "Building the pyramid")
    for number, level in enumerate(pyramid_levels(pyramid.GetOutput())):
        print(f"  level {number}: {' x '.join(map(str, level.GetDimensions()))} voxels,"
              f" unit {level_unit(level):.4g}")
    return pyramid, seconds


def build_surface(pyramid, iso):
    """The filter with the surfaces, the seconds it took, and its warnings."""
    from volumic import vtkDeformableSurface  # pylint: disable=import-outside-toplevel
    surface = vtkDeformableSurface()
    surface.SetInputConnection(pyramid.GetOutputPort())
    surface.SetIsoValue(iso)
    seconds, warnings = run_filter(surface, "Evolving the surface")
    return surface, seconds, warnings


class Results:
    """The output folder, and the names of what was written there."""

    def __init__(self, folder):
        os.makedirs(folder, exist_ok=True)
        self.folder = folder
        self.paths = []

    def write(self, function, content, name):
        """function(content, path) writes the file."""
        path = os.path.join(self.folder, name)
        function(content, path)
        self.paths.append(path)


def run(arguments, results):
    """The whole job, from the volume to the pictures."""
    image, iso = load(arguments)
    name = os.path.basename(os.path.normpath(arguments.volume))
    pyramid, pyramid_seconds = build_pyramid(image)
    results.write(write_blocks, pyramid.GetOutput(), "pyramid.vtm")

    surface, seconds, warnings = build_surface(pyramid, iso)
    finest, levels, history = (surface.GetOutputDataObject(port) for port in range(3))
    if finest.GetNumberOfPolys() == 0:
        raise FilterError("the surface vanished: is the object brighter than its surroundings, and"
                          f" is {iso:g} between the two?")
    report = {
        "input": input_facts(image, name),
        "iso_value": iso,
        **surface_facts(finest),
        "component_features": component_facts(finest),
        "levels": level_facts(visited_levels(levels), history),
        "seconds": {"pyramid": pyramid_seconds, "surface": seconds},
        "warnings": warnings,
        "versions": versions(),
    }
    print("\n".join(summary_lines(report)))
    results.write(write_blocks, levels, "levels.vtm")
    results.write(write_surface, finest, "surface.vtp")
    results.write(write_history, history, "history.csv")
    results.write(write_report, report, "report.json")

    title = f"{name}, iso-value {iso:g}"
    for picture, draw in (
            ("pyramid.png", lambda: pyramid_picture(pyramid.GetOutput(), iso, name)),
            ("levels.png", lambda: levels_picture(levels, world_frame(image), title)),
            ("history.png", lambda: history_chart(history)),
            ("surface-views.png", lambda: views_picture(finest, image, iso, title))):
        print(f"Drawing {picture}", flush=True)
        results.write(write_png, draw(), picture)


def main():
    arguments = parse_arguments()
    try:
        results = Results(arguments.output)
        run(arguments, results)
    except (VolumeError, FilterError, ValueError, OSError) as error:
        sys.exit(f"quickstart.py: {error}")
    print("Written:")
    for path in results.paths:
        print(f"  {path}")


if __name__ == "__main__":
    main()
