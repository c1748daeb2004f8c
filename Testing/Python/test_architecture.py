# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Tests that includes, terms and sizes of folders are those of Documentation/architecture.md. Requires
no build and no VTK."""

import os
import re
import unittest

ROOT = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
FILTERS = os.path.join(ROOT, "Filters")
PAGE = os.path.join(ROOT, "Documentation", "architecture.md")
MADE_BY_CMAKE = "vtkFiltersVolumicModule.h"
COUNTED = (".h", ".cxx", ".c", ".cmake", ".txt", ".py", ".sh", ".xml")


def read(path):
    with open(path, encoding="utf-8") as file:
        return file.read()


def table_below(heading):
    """Return the names in the cells of the first table below a heading of the page."""
    section = re.split(r"^## .*$", read(PAGE).split(f"## {heading}\n", 1)[1], flags=re.M)[0]
    rows = re.findall(r"^\|(.*)\|$", section, flags=re.M)
    return [[re.findall(r"`([^`]+)`", cell) for cell in row.split("|")] for row in rows[2:]]


def rooms_of_the_page():
    """Return the rooms that each room may include, in the order of the page."""
    may_include = {}
    for room, below, *_ in table_below("Rooms of the core"):
        may_include["Core/" + room[0]] = {"Core/" + name for name in below}
    for room, below, core, *_ in table_below("Rooms of the layer"):
        may_include[room[0]] = set(below) | {"Core/" + name for name in core}
    return may_include


class RoomsTest(unittest.TestCase):
    def test_includes_are_allowed(self):
        may_include = rooms_of_the_page()
        sources = {os.path.relpath(os.path.join(folder, name), FILTERS)
                   for folder, _, names in os.walk(FILTERS) for name in names
                   if name.endswith((".h", ".cxx"))}
        self.assertEqual({os.path.dirname(source) for source in sources} - {""}, set(may_include))
        further_up = set()
        for room, below in may_include.items():
            self.assertLessEqual(below, further_up, f"{room} includes only rooms further up")
            further_up.add(room)
        wrong = []
        for source in sources:
            room = os.path.dirname(source)
            included = re.findall(r'^\s*#\s*include\s*"([^"]+)"',
                                  read(os.path.join(FILTERS, source)), re.M)
            wrong += [f"{source} includes {name}" for name in included
                      if room and name != MADE_BY_CMAKE
                      and os.path.dirname(name) not in may_include[room] | {room}]
        self.assertEqual(wrong, [])


class TermsTest(unittest.TestCase):
    def test_words_that_terms_replace_are_not_used(self):
        """In no text file but the page that lists them and the changelog, which names old ones."""
        words = [word for row in table_below("Terms") for word in row[-1]]
        self.assertGreater(len(words), 20)
        pattern = re.compile("|".join(rf"\b{word}\b" for word in words).replace(" ", r"[\s*/#]+"))
        texts = [os.path.join(top, name) for top, folders, names in os.walk(ROOT)
                 for name in names if name.endswith((*COUNTED, ".md", ".yml", ".toml", ".ui"))
                 if not re.search(r"/(build|\.\w+)(/|$)", top[len(ROOT):])]
        texts = [path for path in texts if path != PAGE and os.path.basename(path) != "CHANGELOG.md"]
        found = [f"{os.path.relpath(path, ROOT)}: {match.group(0)}"
                 for path in sorted(texts) for match in pattern.finditer(read(path))]
        self.assertEqual(found, [], "use the term in the first column of the table")


class SizesTest(unittest.TestCase):
    def sizes_of(self, folder):
        """Return the lines of all counted files, and the statements of C++ (semicolons outside
        comments)."""
        texts = [(name, read(os.path.join(top, name)))
                 for top, _, names in os.walk(os.path.join(ROOT, folder)) for name in names
                 if name.endswith(COUNTED)]
        statements = sum(re.sub(r"/\*(?s:.*?)\*/|//.*", "", text).count(";")
                         for name, text in texts if name.endswith((".h", ".cxx")))
        return sum(text.count("\n") for _, text in texts), statements

    def test_folders_respect_size_limits(self):
        section = read(PAGE).split("## Sizes\n", 1)[1]
        rows = re.findall(r"^\| `([\w/]+)` \| ([\d,]+) \| ([\d,]+) \|", section, flags=re.M)
        limits = {folder: tuple(int(number.replace(",", "")) for number in numbers)
                  for folder, *numbers in rows}
        folders = {name for name in os.listdir(ROOT)
                   if name[0] != "." and name != "build" and self.sizes_of(name)[0]}
        rooms = {"Filters/" + room for room in rooms_of_the_page()}
        self.assertEqual(folders | rooms, {folder for folder in limits
                                           if "/" not in folder or folder.startswith("Filters")})
        too_large = {folder: sizes for folder, limit in limits.items()
                     for sizes in [self.sizes_of(folder)]
                     if sizes[0] > limit[0] or sizes[1] > limit[1]}
        self.assertEqual(too_large, {}, "remove as much as you add; limits only go down")


if __name__ == "__main__":
    unittest.main()
