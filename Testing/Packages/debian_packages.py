# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The packages that cpack made, for the tests; from the environment (see CMakeLists.txt)."""

import os
import re
import subprocess
from pathlib import Path

FLAVOUR = os.environ["VOLUMIC_FLAVOUR"]
FOLDER = Path(os.environ["VOLUMIC_PACKAGES"])
SOURCE = Path(os.environ["VOLUMIC_SOURCE"])
BUILD = Path(os.environ["VOLUMIC_BUILD"])
SKIPPED = 77  # exit code

NAMES = {"vtk": ["volumic", "volumic-dev"],
         "paraview": ["paraview-volumic"]}[FLAVOUR]


def output_of(*command, **options):
    """What the command prints; CalledProcessError with its errors if it fails."""
    return subprocess.run([str(word) for word in command], check=True, text=True,
                          capture_output=True, **options).stdout


class Package:
    """A .deb file."""

    def __init__(self, file):
        self.file = file
        self.name = self.field("Package")
        self.version = self.field("Version")

    def field(self, name):
        return output_of("dpkg-deb", "-f", self.file, name).strip()

    def dependencies(self, field="Depends"):
        """{package: [relations]}; "a (>= 1), a (<< 2)" has two."""
        found = {}
        for part in filter(None, re.split(r",\s*", self.field(field))):
            name, _, relation = part.partition(" ")
            found.setdefault(name, []).append(relation.strip("()"))
        return found

    def files(self):
        """(type and permissions, owner, path) of everything in it; links with their targets."""
        for line in output_of("dpkg-deb", "-c", self.file).splitlines():
            mode, owner, _, _, _, path = line.split(None, 5)
            yield mode, owner, path.removeprefix(".")

    def paths(self):
        """The paths of what is no folder."""
        return {path.split(" -> ")[0] for mode, _, path in self.files() if mode[0] != "d"}


def made_packages():
    """{name: Package} of the packages in the folder."""
    packages = [Package(file) for file in sorted(FOLDER.glob("*.deb"))]
    return {package.name: package for package in packages}
