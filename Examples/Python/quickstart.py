#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""From a volume to a closed surface with the installed package `volumic`; see quickstart.sh.

Reads a volume (by default a CT of a skull from Debian's package invesalius-examples), builds its
pyramid, lets the surface evolve from the coarsest level to the finest, and writes into the output
folder

    skull.vti                  the volume, as ParaView opens it; volume.vti where it is another one,
                               and nothing where it is a .vti already
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
from output_files import check_output
from pipeline import SKULL, build_pyramid, load_volume, prepare_surface, run_surface
from pyramid_picture import pyramid_picture
from read_volume import VolumeError, files_of_volume, write_image
from render import world_frame, write_png
from surface_pictures import levels_picture, views_picture
from surface_results import (
    component_facts, input_facts, level_facts, summary_lines, surface_facts, versions,
    write_blocks, write_history, write_report, write_surface)
from terminal import FilterError, Interrupted


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("volume", nargs="?", default=SKULL,
                        help="volume that read_volume.py can read; default: the skull")
    parser.add_argument("iso", nargs="?", type=float,
                        help="iso-value; default: Otsu's threshold (for the skull 226.5)")
    parser.add_argument("--output", default="quickstart", help="folder for the results")
    return parser.parse_args()


FILES = ("pyramid.vtm", "levels.vtm", "surface.vtp", "history.csv", "report.json", "pyramid.png",
         "levels.png", "history.png", "surface-views.png")


def name_of_volume(path):
    """What the volume is written as; None where ParaView opens it as it is."""
    if path.lower().endswith(".vti"):
        return None
    return "skull.vti" if os.path.basename(path) == os.path.basename(SKULL) else "volume.vti"


class Results:
    """The output folder, and the names of what was written there."""

    def __init__(self, folder, volume):
        os.makedirs(folder, exist_ok=True)
        inputs = files_of_volume(volume)
        for name in filter(None, (name_of_volume(volume), *FILES)):
            check_output(os.path.join(folder, name), inputs)
        self.folder = folder
        self.paths = []

    def write(self, function, content, name):
        """function(content, path) writes the file."""
        path = os.path.join(self.folder, name)
        function(content, path)
        self.paths.append(path)


def run(arguments, results):
    """The whole job, from the volume to the pictures."""
    image, iso = load_volume(arguments.volume, arguments.iso)
    name = os.path.basename(os.path.normpath(arguments.volume))
    if name_of_volume(arguments.volume):
        results.write(write_image, image, name_of_volume(arguments.volume))
    pyramid, pyramid_seconds = build_pyramid(image)
    results.write(write_blocks, pyramid.GetOutput(), "pyramid.vtm")

    surface = prepare_surface(pyramid, iso)
    seconds, warnings = run_surface(surface)
    finest, levels, history = (surface.GetOutputDataObject(port) for port in range(3))
    report = {
        "input": input_facts(image, name),
        "iso_value": iso,
        **surface_facts(finest),
        "component_features": component_facts(finest),
        "levels": level_facts(levels, history),
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
        results = Results(arguments.output, arguments.volume)
        run(arguments, results)
    except (VolumeError, FilterError, Interrupted, ValueError, OSError) as error:
        sys.exit(f"quickstart.py: {error}")
    print("Written:")
    for path in results.paths:
        print(f"  {path}")


if __name__ == "__main__":
    main()
