# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Writers of surfaces, tetrahedral meshes, volumes and tables. The suffix determines the format.

A file replaces an existing one once it is complete, see files.py. All functions raise Failure,
which names the file, if it cannot be written.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Sequence
from typing import Any

from ..errors import Failure, UsageError
from . import files, surfaces
from .regions import surface_labels
from .scenes import glb, three_mf
from .surfaces import Show, silent
from .tetrahedra import TetrahedralMesher, needs_mesher
from .tetrahedral_files import (
    MESHER_SUFFIXES, MESHIO_FORMATS, TETRAHEDRAL_SUFFIXES, write_boundary, write_tetrahedra)

Warn = Callable[[str], Any]

SCENES = {".glb": glb, ".3mf": three_mf}
SUFFIXES = (*surfaces.FORMATS, *SCENES, ".vtu", ".inp", *MESHER_SUFFIXES, *MESHIO_FORMATS)

_warned: set[str] = set()  # warnings given once


def suffix_of(name: str) -> str:
    return os.path.splitext(name)[1].lower()


def check_surface_name(name: str) -> None:
    """Raise UsageError if no writer has this suffix."""
    if suffix_of(name) not in SUFFIXES:
        raise UsageError(f"{name}: unknown suffix of a surface format; use one of "
                         f"{' '.join(SUFFIXES)}")


def is_scene(name: str) -> bool:
    """Return whether a format stores several surfaces with names and colours."""
    return suffix_of(name) in SCENES


def holds_volume_mesh(name: str) -> bool:
    """Return whether a format is for tetrahedral meshes or input of meshers. Its files store one
    mesh of all labels."""
    return suffix_of(name) in (*TETRAHEDRAL_SUFFIXES, *MESHER_SUFFIXES)


def write_surface(surface: Any, name: str, remark: str = "",
                  mesher: TetrahedralMesher | None = None, warn: Warn = silent,
                  progress: Show = silent) -> None:
    """Write a surface, interfaces of labels, or a tetrahedral mesh of them by `mesher`. The file
    header states version, coordinate system, unit and `remark`."""
    if is_scene(name):
        labels = surface_labels(surface)
        write_scene([(labels[0].name if len(labels) == 1 else "surface", surface)], name, warn,
                    progress)
        return
    head, mesher = surfaces.file_header(surface, remark), mesher or TetrahedralMesher()
    _warn_unsupported([surface], name, warn)
    with files.output_file(name) as path:
        if suffix_of(name) in surfaces.FORMATS:
            surfaces.write_pieces(path, surfaces.FORMATS[suffix_of(name)](surface, head, progress))
        elif needs_mesher(name, mesher.mesher):
            write_tetrahedra(mesher.make(surface, path, progress, warn), path, head)
        else:
            write_boundary(surface, path, head)


def write_scene(objects: Sequence[tuple[str, Any]], name: str, warn: Warn = silent,
                progress: Show = silent) -> None:
    """Write non-empty surfaces with their names to a .glb or .3mf file."""
    objects = [item for item in objects if item[1].GetNumberOfPoints() > 0]
    if not objects:
        raise Failure(f"{name}: cannot be written (all surfaces are empty)")
    _warn_unsupported([surface for _, surface in objects], name, warn)
    _write(name, SCENES[suffix_of(name)](objects, progress))


def write_blocks(blocks: Any, name: str, warn: Warn = silent, progress: Show = silent) -> None:
    """Write surfaces in blocks to a .vtm file and a folder next to it."""
    with files.output_file(name) as path:
        surfaces.write_vtm(blocks, path, progress)
    folder = os.path.splitext(os.path.realpath(name))[0]
    start = os.path.basename(folder) + "_"
    written = [f"{start}{i}.vtp" for i in range(blocks.GetNumberOfBlocks())]
    warn_obsolete(folder, written, warn, start)


def write_folder(blocks: Any, folder: str, prefix: str,
                 number_of: Callable[[Any], int] | None = None, warn: Warn = silent) -> None:
    """Write each non-empty block to FOLDER/PREFIX-NUMBER.vtp. The folder is created. `number_of`
    returns the number of a surface (default: that of the block)."""
    written = []
    with files.output_folder(folder) as path:
        for i in range(blocks.GetNumberOfBlocks()):
            block = blocks.GetBlock(i)
            if block is not None and block.GetNumberOfPoints() > 0:
                written.append(f"{prefix}-{number_of(block) if number_of else i}.vtp")
                surfaces.write_pieces(os.path.join(path, written[-1]), surfaces.vtp(block))
    warn_obsolete(folder, written, warn, prefix + "-")


def write_volume(image: Any, name: str, progress: Show = silent) -> None:
    """Write a volume with all arrays and field data."""
    _write(name, surfaces.vti(image, progress))


def write_table(table: Any, name: str) -> None:
    _write(name, surfaces.csv(table))


def _write(name: str, pieces: Iterable[bytes]) -> None:
    with files.output_file(name) as path:
        surfaces.write_pieces(path, pieces)


def _warn_unsupported(written: Sequence[Any], name: str, warn: Warn) -> None:
    """Warn once per format of data that it does not support."""
    for surface in written:
        for text in surfaces.unsupported_data(surface, suffix_of(name)):
            if text not in _warned:
                _warned.add(text)
                warn(f"{name}: {text}")


def warn_obsolete(folder: str, written: Sequence[str], warn: Warn, start: str = "",
                  suffix: str = ".vtp") -> None:
    """Warn of files with matching names that are not written by this run."""
    old = sorted(name for name in (os.listdir(folder) if os.path.isdir(folder) else ())
                 if name.startswith(start) and name.endswith(suffix) and name not in written)
    if old:
        warn(f"{folder}: files of an earlier run exist: {', '.join(old[:5])}"
             f"{', ...' * (len(old) > 5)}; delete them if they are obsolete")
