#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The surfaces of all volumes in a folder, and a table of their sizes and shapes.

    batch.py scans --output surfaces --iso 226.5 --format stl

Every volume in the folder (.vti .mha .mhd .nrrd .nhdr .nii .nii.gz .inv3) is segmented, and every
folder in it as a DICOM series. OUTPUT then holds a surface for each, and results.csv with a line
for each: how it ended, its iso-value, seconds, vertices, components, genus, area and volume (world units), or
the error. A volume that fails does not stop the others.

Ends with 0 if all went well, 1 if some failed, 2 if the command line is wrong or there is no
volume, 3 after Ctrl-C.
"""

import argparse
import csv
import io
import os
import sys
import time

from output_files import check_output, write_text
from pipeline import load_volume, prepare_surface, run_surface
from read_volume import VolumeError, files_of_volume
from segment import INTERRUPTED, add_filter_options, filter_properties
from surface_results import SURFACE_WRITERS, surface_facts, surface_line, write_surface
from terminal import FilterError, Interrupted

SUFFIXES = (".vti", ".mha", ".mhd", ".nrrd", ".nhdr", ".nii", ".nii.gz", ".inv3")
FACTS = ("stop_reason", "vertices", "triangles", "components", "genus", "area", "volume")
COLUMNS = ("volume_file", "status", "iso_value", "seconds", *FACTS, "surface_file", "error")


def find_volumes(folder):
    """Names of the files and folders in the folder that may be volumes, sorted."""
    return sorted(entry.name for entry in os.scandir(folder)
                  if not entry.name.startswith(".")
                  and (entry.is_dir() or entry.name.lower().endswith(SUFFIXES)))


def surface_names(volumes, suffix):
    """For each volume the name of its surface: without the suffix, unless two would be the same."""
    stems = {name: stem_of(name) for name in volumes}
    common = {stem for stem in stems.values() if list(stems.values()).count(stem) > 1}
    return {name: (name if stem in common else stem) + suffix for name, stem in stems.items()}


def stem_of(name):
    """The name without the suffix of a volume."""
    suffixes = [suffix for suffix in SUFFIXES if name.lower().endswith(suffix)]
    return name[:len(name) - max(map(len, suffixes))] if suffixes else name


def segment_one(path, output, iso, properties):
    """Write the surface of one volume; the line of the table about it."""
    check_output(output, files_of_volume(path))
    started = time.monotonic()
    image, iso = load_volume(path, iso)
    surface = prepare_surface(image, iso, properties)
    run_surface(surface)
    facts = surface_facts(surface.GetOutput())
    write_surface(surface.GetOutput(), output)
    print(f"  {surface_line(surface.GetOutput())}")
    return {"status": "ok", "iso_value": iso, "seconds": round(time.monotonic() - started, 3),
            "surface_file": os.path.basename(output), **{name: facts[name] for name in FACTS}}


def run_batch(arguments, properties, table):
    """Segment volume after volume, with a line in the table as soon as one is done.

    Returns how many failed and how many there were.
    """
    volumes = find_volumes(arguments.folder)
    names = surface_names(volumes, "." + arguments.format)
    failed = 0
    for number, name in enumerate(volumes, 1):
        print(f"[{number}/{len(volumes)}] ", end="")
        try:
            line = segment_one(os.path.join(arguments.folder, name),
                               os.path.join(arguments.output, names[name]),
                               arguments.iso, properties)
        except (VolumeError, FilterError, ValueError, OSError, MemoryError) as error:
            failed += 1
            line = {"status": "failed", "error": str(error) or type(error).__name__}
            print(f"  failed: {line['error']}")
        table.add({"volume_file": name, **line})
    return failed, len(volumes)


class Table:
    """A CSV file with a line per volume, whole at any time: each line makes a new one."""

    def __init__(self, path):
        self.path = path
        self.text = io.StringIO(newline="")
        self.writer = csv.DictWriter(self.text, COLUMNS, restval="")
        self.writer.writeheader()
        check_output(path)

    def add(self, line):
        self.writer.writerow(line)
        write_text(self.text.getvalue(), self.path)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", help="folder with volumes")
    parser.add_argument("--output", required=True, metavar="FOLDER", help="for the results")
    parser.add_argument("--format", choices=[s.lstrip(".") for s in SURFACE_WRITERS],
                        default="vtp", help="of the surfaces; default: vtp")
    add_filter_options(parser)
    arguments = parser.parse_args()
    if not os.path.isdir(arguments.folder):
        parser.error(f"{arguments.folder}: no such folder")
    if not find_volumes(arguments.folder):
        parser.error(f"{arguments.folder}: no volume in there ({', '.join(SUFFIXES)} or DICOM"
                     " folders)")
    try:
        properties = filter_properties(arguments)
        os.makedirs(arguments.output, exist_ok=True)
        path = os.path.join(arguments.output, "results.csv")
        failed, total = run_batch(arguments, properties, Table(path))
    except Interrupted as error:
        print(f"batch.py: {error}", file=sys.stderr)
        return INTERRUPTED
    except (FilterError, ValueError, OSError) as error:
        print(f"batch.py: {error}", file=sys.stderr)
        return 1
    print(f"{total - failed} of {total} volumes done{f', {failed} failed' if failed else ''}."
          f" Table: {path}")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
