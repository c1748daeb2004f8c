# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Read the volume of an InVesalius project (.inv3): a gzipped tar of raw voxels and a plist.

Only the two members needed are read, in memory: nothing is unpacked to disk, so names in the
archive cannot reach outside it.
"""

import gzip
import plistlib
import posixpath
import tarfile
import zlib
from xml.parsers.expat import ExpatError

import numpy as np

from volume_image import VolumeError, make_image

LARGEST_PLIST = 1 << 20
AXIAL = 1  # InVesalius' number for the orientation of the slices


def read_inv3(path):
    """vtkImageData of the project's matrix, unit mm, origin 0, the axes as they are stored.

    InVesalius stores the rows of axial slices from back to front: the world axes are L, A, S, a
    left-handed frame (its own surfaces have -y instead).
    """
    try:
        check_sum(path)
        with tarfile.open(path, "r:*") as archive:
            plist_member = find_member(archive, "main.plist", path)
            if plist_member.size > LARGEST_PLIST:
                raise VolumeError(f"{path}: main.plist is too large to be a project description")
            project = plistlib.loads(archive.extractfile(plist_member).read())
            dtype, shape, spacing = describe(project, path)
            member = find_member(archive, project["matrix"].get("filename", "matrix.dat"), path)
            expected = int(np.prod(shape, dtype=np.int64)) * dtype.itemsize
            if member.size != expected:
                raise VolumeError(f"{path}: {member.name} has {member.size} bytes, the sizes in"
                                  f" main.plist ask for {expected}")
            voxels = np.frombuffer(archive.extractfile(member).read(), dtype).reshape(shape)
    except (tarfile.TarError, EOFError, zlib.error, OSError) as error:
        raise VolumeError(f"{path}: not a readable InVesalius project ({error})") from error
    except (plistlib.InvalidFileException, ExpatError) as error:
        raise VolumeError(f"{path}: main.plist cannot be parsed ({error})") from error
    axes = "LAS" if project.get("orientation", AXIAL) == AXIAL else None
    return make_image(voxels, spacing, axes=axes)


def check_sum(path):
    """Read a packed file to its end, where its checksum stands: damaged voxels look like others."""
    with open(path, "rb") as file:
        if file.read(2) != b"\x1f\x8b":
            return
    with gzip.open(path) as file:
        while file.read(1 << 20):
            pass


def find_member(archive, name, path):
    """The regular file of that base name; projects keep their files in one folder."""
    for member in archive:
        if member.isreg() and posixpath.basename(member.name) == posixpath.basename(name):
            return member
    raise VolumeError(f"{path}: no {name} in it: not an InVesalius project")


def describe(project, path):
    """Type, shape (z, y, x) and spacing (x, y, z) of the voxels, from the parsed plist."""
    try:
        dtype = np.dtype(project["matrix"]["dtype"]).newbyteorder("<")
        shape = tuple(int(n) for n in project["matrix"]["shape"])
        spacing = tuple(float(s) for s in project["spacing"])
    except (KeyError, TypeError, ValueError) as error:
        raise VolumeError(f"{path}: main.plist lacks or garbles {error}") from error
    if len(shape) != 3 or len(spacing) != 3 or min(shape) < 1:
        raise VolumeError(f"{path}: sizes {shape} and spacing {spacing} are not those of a volume")
    return dtype, shape, spacing
