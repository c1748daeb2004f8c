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
    """The room of a file of the core, from Filters; None for the layer of VTK."""
    parts = source.split("/")
    return parts[1] if parts[0] == "Core" and len(parts) == 3 else None


class FoldersTest(unittest.TestCase):
    def test_the_folders_are_those_of_the_page(self):
        rows = table_below("Folders")
        self.assertEqual({name for row in rows for name in names_in(row[0])}, folders_in(ROOT))

    def test_the_rooms_are_those_of_the_page(self):
        rows = table_below("Rooms of the core")
        self.assertEqual({name for row in rows for name in names_in(row[0])}, folders_in(CORE))

    def test_files_that_the_page_names_are_there(self):
        folders = "|".join(folders_in(ROOT))
        named = re.findall(rf"`((?:{folders})/[\w/.]+\w)`", read(PAGE))
        self.assertGreater(len(named), 20)
        self.assertEqual([path for path in named if not os.path.exists(os.path.join(ROOT, path))],
                         [])
        known = {name for folder in folders_in(ROOT)
                 for _, _, names in os.walk(os.path.join(ROOT, folder)) for name in names}
        alone = re.findall(r"`(\w+\.\w+)`", read(PAGE))
        self.assertEqual([name for name in alone if name not in known], [])

    def test_classes_that_the_page_names_are_there(self):
        """A name in code that begins as those of units do is a unit, or found in a header."""
        headers = "\n".join(read(os.path.join(FILTERS, s)) for s in sources() if s.endswith(".h"))
        text = re.split(r"^## Rooms", read(PAGE), flags=re.M)[1]
        named = set(re.findall(r"`((?:vtk)?[A-Z]\w+)(?:::(\w+))?`", text))
        self.assertGreater(len(named), 30)
        units = {os.path.splitext(os.path.basename(s))[0] for s in sources()}
        unknown = [name for name, member in named
                   if name not in units | folders_in(CORE)
                   and not re.search(rf"\b(class|struct|using|void\*) {name}\b", headers)
                   or member and not re.search(rf"\b{member}\b", headers)]
        self.assertEqual(unknown, [], "neither units nor classes of Filters")


class IncludesTest(unittest.TestCase):
    def test_rooms_include_those_that_they_may(self):
        may_include = {}
        for room, below, _ in table_below("Rooms of the core"):
            self.assertLessEqual(set(names_in(below)), set(may_include), "only rooms further up")
            may_include[names_in(room)[0]] = set(names_in(below))
        wrong = []
        for source in sources():
            room = room_of(source)
            for included in includes_of(source) if room else ():
                # This also refuses short paths, and files of the layer.
                if room_of(included) not in may_include[room] | {room}:
                    wrong.append(f"{source} includes {included}")
        self.assertEqual(wrong, [])

    def test_what_the_core_includes_is_there(self):
        known = sources()
        self.assertEqual([f"{source} includes {included}" for source in known if room_of(source)
                          for included in includes_of(source) if included not in known], [])

    def test_the_layer_includes_the_core_by_its_rooms(self):
        known = sources()
        in_rooms = {os.path.basename(source) for source in known if room_of(source)}
        for source in known:
            for included in includes_of(source):
                if os.path.basename(included) in in_rooms and included not in known:
                    self.fail(f"{source} includes {included}: not by its path from Filters")

    def test_no_part_of_the_layer_includes_the_filter_that_it_serves(self):
        """What is below a filter's header: enumerations and settings have files of their own."""
        runs_another_filter = {"BuildPyramid.cxx", "EdgeLevels.cxx",
                               "LabelSurface.cxx"}  # vtkImagePyramid
        wrong = [f"{source} includes {included}" for source in sources()
                 if not source.startswith("vtk") and source not in runs_another_filter
                 for included in includes_of(source)
                 if re.match(r"vtk[A-Z]", included) and included in sources()]
        self.assertEqual(wrong, [])

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

    def test_all_sources_of_the_core_are_listed(self):
        text = read(os.path.join(CORE, "CoreSources.cmake"))
        listed = re.findall(r"^  ([A-Z]\w*/\w+\.(?:cxx|h))\b", text, re.M)
        there = {source[len("Core/"):] for source in sources() if source.startswith("Core/")}
        self.assertEqual(len(listed), len(set(listed)), "one is listed twice")
        self.assertEqual(set(listed), there)


if __name__ == "__main__":
    unittest.main()
