# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Surfaces as Neuroglancer's "precomputed" meshes: a folder with `info`, and files of each label.

https://neuroglancer-docs.web.app/datasource/precomputed/mesh.html
"""

from __future__ import annotations

import os
import shutil
import subprocess
import tempfile
from collections.abc import Sequence

import numpy as np

from .arrays import Surface

BITS = 16  # of a coordinate in multilod_draco
INFO = {"precomputed": {"@type": "neuroglancer_legacy_mesh"},
        "multilod_draco": {"@type": "neuroglancer_multilod_draco", "vertex_quantization_bits": BITS,
                           "transform": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0],
                           "lod_scale_multiplier": 1}}


def precomputed(surface: Surface, nanometers: float = 1.0) -> bytes:
    """A fragment of a legacy single-resolution mesh; world units are so many nanometers."""
    return (np.array([len(surface.points)], "<u4").tobytes()
            + (np.asarray(surface.points, float) * nanometers).astype("<f4").tobytes()
            + surface.triangles.astype("<u4").tobytes())


def multilod_draco(levels: Sequence[Surface], nanometers: float = 1.0) -> tuple[bytes, bytes]:
    """A mesh of several levels of detail, the finest first: its manifest, and its fragments.

    Each level is one fragment, so that it stays closed: the format would have it cut along an octree.
    A level's node is twice as large as the one before, of which the mesh then fills the first octant.
    So coordinates are rounded to 1/65535 of the box, in each level after it to twice as much.
    """
    points = [np.asarray(surface.points, float) * nanometers for surface in levels]
    lowest = np.min([each.min(axis=0) for each in points], axis=0)
    origin = np.nextafter(lowest.astype("<f4"), np.float32(-np.inf))
    extent = np.max([each.max(axis=0) for each in points], axis=0) - origin
    shape = np.nextafter(np.maximum(extent, 1e-6 * extent.max()).astype("<f4"), np.float32(np.inf))
    fragments = []
    for level, (surface, places) in enumerate(zip(levels, points)):
        steps = (places - origin) / (shape.astype(float) * 2 ** level) * (2 ** BITS - 1)
        fragments.append(_draco(np.rint(steps).astype("<i4"), surface.triangles))
    count = len(levels)
    scales = np.array([nanometers * _mean_edge(surface) for surface in levels], "<f4")
    manifest = [shape, origin, np.array([count], "<u4"), scales, np.zeros((count, 3), "<f4"),
                np.ones(count, "<u4")]
    for fragment in fragments:
        manifest += [np.zeros(3, "<u4"), np.array([len(fragment)], "<u4")]
    return b"".join(part.tobytes() for part in manifest), b"".join(fragments)


def draco_encoder() -> str:
    """The path of Draco's program, which compresses."""
    program = shutil.which("draco_encoder")
    if program is None:
        raise RuntimeError("multilod_draco is written by the program draco_encoder, which is missing "
                           "(Debian: draco)")
    return program


def _draco(places: np.ndarray, triangles: np.ndarray) -> bytes:
    faces = np.zeros(len(triangles), [("count", "u1"), ("corners", "<i4", 3)])
    faces["count"], faces["corners"] = 3, triangles
    columns = "".join(f"property int {name}\n" for name in "xyz")
    header = (f"ply\nformat binary_little_endian 1.0\nelement vertex {len(places)}\n{columns}"
              f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n")
    with tempfile.TemporaryDirectory(prefix="volumic-") as folder:
        ply, drc = (os.path.join(folder, "mesh" + suffix) for suffix in (".ply", ".drc"))
        with open(ply, "wb") as file:
            file.write(header.encode() + places.tobytes() + faces.tobytes())
        done = subprocess.run([draco_encoder(), "-i", ply, "-o", drc], check=False,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        if done.returncode != 0 or not os.path.exists(drc):
            raise RuntimeError(f"draco_encoder: {done.stdout.decode(errors='replace').strip()}")
        with open(drc, "rb") as file:
            return file.read()


def _mean_edge(surface: Surface) -> float:
    corners = np.asarray(surface.points, float)[surface.triangles]
    return float(np.linalg.norm(np.roll(corners, -1, axis=1) - corners, axis=2).mean())
