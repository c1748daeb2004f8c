#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Run Volumic and its peers and print the tables of Documentation/measured.md and the targets.
`benchmark.py TABLE --help` describes each table.

Exit code: 0 if all runs succeeded (targets may be missed), 1 if a run failed, 2 for wrong options.
"""

import argparse
import importlib
import sys

TABLES = {
    "pyramid": "vtkImagePyramid and its peer",
    "surface": "vtkDeformableSurface and its peers",
    "command": "the command volumic, with image sizes and threads",
    "interfaces": "one mesh of all labels of a map, and its peers"}


def main():
    name = sys.argv[1] if len(sys.argv) > 1 else ""
    if name not in TABLES:
        print(__doc__ + "\nTables:\n" + "".join(f"  {n:<12}{text}\n" for n, text in TABLES.items()))
        return 2
    table = importlib.import_module(name)  # imported on demand: each needs other packages
    parser = argparse.ArgumentParser(
        prog=f"benchmark.py {name}", description=table.__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default="Benchmark", help="path of the program Benchmark")
    parser.add_argument("--csv", metavar="FILE.csv", help="write all figures to this file")
    table.add_options(parser)
    options, options.rest = parser.parse_known_args(sys.argv[2:])
    if options.rest and name != "command":
        parser.error("unknown arguments: " + " ".join(options.rest))
    return table.measure(options)


if __name__ == "__main__":
    sys.exit(main())
