# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Build backend of pyproject.toml: scikit-build-core, and the requirement of a VTK version.

Which VTK a wheel is compiled for is known after CMake has run. VolumicWheel.cmake then writes the
requirement, and this module adds it to the metadata of the wheel. There is no hook that prepares
metadata, so that pip reads them from the finished wheel.
"""

import base64
import hashlib
import os
import tempfile
import zipfile
from pathlib import Path

from scikit_build_core import build as backend
from scikit_build_core.build import (build_sdist, get_requires_for_build_editable,
                                     get_requires_for_build_sdist, get_requires_for_build_wheel)

__all__ = ["build_editable", "build_sdist", "build_wheel", "get_requires_for_build_editable",
           "get_requires_for_build_sdist", "get_requires_for_build_wheel"]


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    """Build the wheel. Return its file name."""
    return _build(backend.build_wheel, wheel_directory, config_settings, metadata_directory)


def build_editable(wheel_directory, config_settings=None, metadata_directory=None):
    """Build the wheel that `pip install -e` installs. Return its file name."""
    return _build(backend.build_editable, wheel_directory, config_settings, metadata_directory)


def _build(build, wheel_directory, config_settings, metadata_directory):
    with tempfile.TemporaryDirectory() as folder:
        requirement = Path(folder, "requirement")
        os.environ["VOLUMIC_WHEEL_REQUIREMENT"] = str(requirement)
        name = build(wheel_directory, config_settings, metadata_directory)
        if requirement.exists():
            _add_requirement(Path(wheel_directory, name), requirement.read_text(encoding="utf-8"))
    return name


def _add_requirement(wheel, requirement):
    """Add a Requires-Dist field to METADATA, and its new hash and size to RECORD."""
    with zipfile.ZipFile(wheel) as archive:
        entries = [(entry, archive.read(entry)) for entry in archive.infolist()]
    contents = {entry.filename: content for entry, content in entries}
    name = next(name for name in contents if name.endswith(".dist-info/METADATA"))
    record = name.replace("METADATA", "RECORD")
    fields, separator, description = contents[name].partition(b"\n\n")
    contents[name] = b"".join([fields, f"\nRequires-Dist: {requirement}".encode(), separator,
                               description])
    digest = base64.urlsafe_b64encode(hashlib.sha256(contents[name]).digest()).rstrip(b"=").decode()
    lines = contents[record].decode().splitlines()
    contents[record] = "".join(
        (f"{name},sha256={digest},{len(contents[name])}" if line.startswith(f"{name},") else line)
        + "\n" for line in lines).encode()
    with zipfile.ZipFile(wheel, "w", zipfile.ZIP_DEFLATED) as archive:
        for entry, _ in entries:
            archive.writestr(entry, contents[entry.filename])
