#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Measures us beside what else there is, and prints the tables of Documentation/measured.md and what
became of the targets. `benchmark.py TABLE --help` tells of each table.

Exit code: 0 all was run (targets may be missed), 1 a run failed, 2 the command line is wrong.
"""

import argparse
import importlib
import sys

TABLES = {
    "pyramid": "vtkImagePyramid and its peer",
    "surface": "vtkDeformableSurface and its peers",
    "command": "volumic with sizes and threads",
    "interfaces": "one mesh of all labels of a map, and its peers"}


def main():
    name = sys.argv[1] if len(sys.argv) > 1 else ""
    if name not in TABLES:
        print(__doc__ + "\nTables:\n" + "".join(f"  {n:<12}{text}\n" for n, text in TABLES.items()))
        return 2
    table = importlib.import_module(name)  # only what is asked for, as each wants other packages
    parser = argparse.ArgumentParser(
        prog=f"benchmark.py {name}", description=table.__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default="Benchmark", help="the program Benchmark")
    parser.add_argument("--csv", metavar="FILE.csv", help="all figures")
    table.add_options(parser)
    options, options.rest = parser.parse_known_args(sys.argv[2:])
    if options.rest and name != "command":
        parser.error("unknown: " + " ".join(options.rest))
    return table.measure(options)


if __name__ == "__main__":
    sys.exit(main())
