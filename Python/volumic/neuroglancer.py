# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Meshes in Neuroglancer's "precomputed" format: a folder with `info` and the files of each label.

https://neuroglancer-docs.web.app/datasource/precomputed/mesh.html
"""

from __future__ import annotations

import shutil
import struct
import subprocess
import tempfile
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from .arrays import Surface
from .writing.surfaces import ply_faces

BITS = 16  # per coordinate in multilod_draco
INFO = {"precomputed": {"@type": "neuroglancer_legacy_mesh"},
        "multilod_draco": {"@type": "neuroglancer_multilod_draco", "vertex_quantization_bits": BITS,
                           "transform": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0],
                           "lod_scale_multiplier": 1}}


def precomputed(surface: Surface, nanometers: float = 1.0) -> bytes:
    """Return a fragment of a legacy mesh. `nanometers` is the length of a world unit."""
    return (np.array([len(surface.points)], "<u4").tobytes()
            + (np.asarray(surface.points, float) * nanometers).astype("<f4").tobytes()
            + surface.triangles.astype("<u4").tobytes())


def multilod_draco(levels: Sequence[Surface], nanometers: float = 1.0) -> tuple[bytes, bytes]:
    """Return manifest and fragments of a mesh with several levels of detail, the finest first.

    Each level is a single fragment and thus closed. The octree node of each level is twice as large
    as that of the level before, and the mesh is in its first octant. Coordinates are rounded to
    1/65535 of the node.
    """
    points = [np.asarray(surface.points, float) * nanometers for surface in levels]
    together = np.concatenate(points)
    origin = np.nextafter(together.min(axis=0).astype("<f4"), np.float32(-np.inf))
    extent = together.max(axis=0) - origin
    shape = np.nextafter(np.maximum(extent, 1e-6 * extent.max()).astype("<f4"), np.float32(np.inf))
    fragments, scales = [], []
    for level, (surface, positions) in enumerate(zip(levels, points)):
        steps = (positions - origin) / (shape.astype(float) * 2 ** level) * (2 ** BITS - 1)
        fragments.append(_draco(np.rint(steps).astype("<i4"), surface.triangles))
        scales.append(nanometers * _mean_edge(surface))
    count = len(levels)
    manifest = struct.pack(f"<6fI{4 * count}f{count}I", *shape, *origin, count, *scales,
                           *[0.0] * (3 * count), *[1] * count)
    nodes = [struct.pack("<4I", 0, 0, 0, len(fragment)) for fragment in fragments]
    return manifest + b"".join(nodes), b"".join(fragments)


def draco_encoder() -> str:
    """Return the path of Draco's encoder. Raise RuntimeError if it is not installed."""
    program = shutil.which("draco_encoder")
    if program is None:
        raise RuntimeError("multilod_draco requires the program draco_encoder; install it (Debian: "
                           "apt install draco)")
    return program


def _draco(positions: np.ndarray, triangles: np.ndarray) -> bytes:
    columns = "".join(f"property int {name}\n" for name in "xyz")
    head = (f"ply\nformat binary_little_endian 1.0\nelement vertex {len(positions)}\n{columns}"
            f"element face {len(triangles)}\nproperty list uchar int vertex_indices\nend_header\n")
    with tempfile.TemporaryDirectory(prefix="volumic-") as folder:
        ply, drc = Path(folder, "mesh.ply"), Path(folder, "mesh.drc")
        ply.write_bytes(head.encode() + positions.tobytes() + ply_faces(triangles))
        done = subprocess.run([draco_encoder(), "-i", ply, "-o", drc], check=False,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        if done.returncode != 0 or not drc.exists():
            raise RuntimeError(f"draco_encoder: {done.stdout.decode(errors='replace').strip()}")
        return drc.read_bytes()


def _mean_edge(surface: Surface) -> float:
    corners = np.asarray(surface.points, float)[surface.triangles]
    return float(np.linalg.norm(np.roll(corners, -1, axis=1) - corners, axis=2).mean())
