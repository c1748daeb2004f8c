# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Documentation/architecture.md tells the folders that are there, and includes keep to its rooms.

Needs no build, and no VTK.
"""

import os
import re
import unittest

ROOT = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
FILTERS = os.path.join(ROOT, "Filters")
CORE = os.path.join(FILTERS, "Core")
PAGE = os.path.join(ROOT, "Documentation", "architecture.md")


def read(path):
    with open(path, encoding="utf-8") as file:
        return file.read()


def table_below(heading):
    """The cells of the rows of the first table below a heading of the page."""
    section = re.split(r"^## .*$", read(PAGE).split(f"## {heading}\n", 1)[1], flags=re.M)[0]
    rows = re.findall(r"^\|(.*)\|$", section, flags=re.M)
    return [[cell.strip() for cell in row.split("|")] for row in rows[2:]]


def names_in(cell):
    return re.findall(r"`([^`]+)`", cell)


def folders_in(path):
    """Those of the sources: hidden ones, builds and Python's caches are none."""
    return {entry.name for entry in os.scandir(path) if entry.is_dir()
            and not entry.name.startswith((".", "build", "__pycache__"))}


def sources():
    """Sources and headers by their path from Filters."""
    return {os.path.relpath(os.path.join(folder, name), FILTERS)
            for folder, _, names in os.walk(FILTERS) for name in names
            if name.endswith((".h", ".cxx"))}


def includes_of(source):
    return re.findall(r'^\s*#\s*include\s*"([^"]+)"', read(os.path.join(FILTERS, source)), re.M)


def room_of(source):
    """The room of a file by its path from Filters, as `Input` or `Core/Image`; none: a filter's."""
    return os.path.dirname(source)


def rooms_of_the_page():
    """What the rooms may include, in the order of the page: those of the core, then the others."""
    may_include = {}
    for room, below, _ in table_below("Rooms of the core"):
        may_include["Core/" + names_in(room)[0]] = {"Core/" + name for name in names_in(below)}
    for room, below, core, _ in table_below("Rooms of the layer"):
        may_include[names_in(room)[0]] = (set(names_in(below))
                                          | {"Core/" + name for name in names_in(core)})
    return may_include


class FoldersTest(unittest.TestCase):
    def test_the_folders_are_those_of_the_page(self):
        rows = table_below("Folders")
        self.assertEqual({name for row in rows for name in names_in(row[0])}, folders_in(ROOT))

    def test_the_rooms_are_those_of_the_page(self):
        there = {"Core/" + room for room in folders_in(CORE)} | folders_in(FILTERS) - {"Core"}
        self.assertEqual(set(rooms_of_the_page()), there)
        self.assertEqual([source for source in sources() if room_of(source) not in there
                          and not source.startswith("vtk")], [], "only filters are in no room")


class IncludesTest(unittest.TestCase):
    def test_rooms_include_those_that_they_may(self):
        """And nothing else of the project: no file by a shorter path, and no filter."""
        made_by_cmake = "vtkFiltersVolumicModule.h"
        may_include = rooms_of_the_page()
        further_up = set()
        for room, below in may_include.items():
            self.assertLessEqual(below, further_up, f"{room} includes only rooms further up")
            further_up.add(room)
        wrong = [f"{source} includes {included}" for source in sources() if room_of(source)
                 for included in includes_of(source) if included != made_by_cmake
                 and room_of(included) not in may_include[room_of(source)] | {room_of(source)}]
        self.assertEqual(wrong, [])

    def test_what_is_included_is_there(self):
        """By its path from Filters; VTK's own headers and made ones have no folder."""
        known = sources()
        in_rooms = {os.path.basename(source) for source in known if room_of(source)}
        self.assertEqual([f"{source} includes {included}" for source in known
                          for included in includes_of(source) if included not in known
                          and (room_of(included) or included in in_rooms)], [])

    def test_every_header_has_a_guard_of_its_own(self):
        """Also among those of the command and the plugin, as one source may include several."""
        guards = {}
        for top in ("Filters", "Applications", "Plugin"):
            for folder, _, names in os.walk(os.path.join(ROOT, top)):
                for name in names if "build" not in folder else ():
                    if name.endswith(".h"):
                        path = os.path.join(folder, name)
                        guard = re.search(r"^#ifndef (\w+)\n#define \1$", read(path), re.M)
                        self.assertIsNotNone(guard, path)
                        guards.setdefault(guard.group(1), []).append(path)
        self.assertEqual([paths for paths in guards.values() if len(paths) > 1], [])

    def test_no_circles(self):
        known = sources()
        includes = {source: [i for i in includes_of(source) if i in known] for source in known}
        done = set()

        def follow(source, way):
            self.assertNotIn(source, way, "a circle: " + " -> ".join([*way, source]))
            if source not in done:
                for included in includes[source]:
                    follow(included, [*way, source])
                done.add(source)

        for source in sorted(known):
            follow(source, [])

    def test_all_sources_are_listed(self):
        core = read(os.path.join(CORE, "CoreSources.cmake"))
        layer = read(os.path.join(FILTERS, "CMakeLists.txt"))
        listed = re.findall(r"^ +(\w+/\w+\.(?:cxx|h))\b", layer, re.M)
        listed += ["Core/" + name
                   for name in re.findall(r"^  ([A-Z]\w*/\w+\.(?:cxx|h))\b", core, re.M)]
        self.assertEqual(len(listed), len(set(listed)), "one is listed twice")
        self.assertEqual(set(listed), {source for source in sources() if room_of(source)})


if __name__ == "__main__":
    unittest.main()
