# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Writing of surfaces, tetrahedra, volumes and tables, each in the format of the suffix.

All files take their places when they are whole, see files.py. All functions throw Failure that
names the file if it cannot be written.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Sequence
from typing import Any

from ..errors import UsageError
from . import files, surfaces
from .regions import surface_labels
from .scenes import glb, three_mf
from .solids import BY_MESHIO, FOR_MESHERS, TETRAHEDRA, write_boundary, write_solid
from .tetrahedra import SolidMaker, needs_mesher

Tell = Callable[[str], Any]
Show = Callable[[float], Any]

SCENES = (".glb", ".3mf")
SUFFIXES = (".vtp", ".vtk", ".stl", ".ply", ".obj", *SCENES, ".vtu", ".inp", *FOR_MESHERS,
            *BY_MESHIO)

_reported: set[str] = set()  # what has been said once, for all files


def suffix_of(name: str) -> str:
    """With a dot, in small letters."""
    return os.path.splitext(name)[1].lower()


def check_surface_name(name: str) -> None:
    """Throw UsageError if no writer has this suffix."""
    if suffix_of(name) not in SUFFIXES:
        raise UsageError(f"{name}: no surface format has this suffix; known are "
                         f"{' '.join(SUFFIXES)}")


def check_volume_name(name: str) -> None:
    """Throw UsageError if the name is not one of a volume."""
    if suffix_of(name) != ".vti":
        raise UsageError(f"{name}: a volume is written as .vti")


def is_scene(name: str) -> bool:
    """Whether a file of this name holds several surfaces with their names and colors."""
    return suffix_of(name) in SCENES


def is_of_solids(name: str) -> bool:
    """Whether a file of this name holds tetrahedra or is for meshers: of labels it needs shared
    interfaces."""
    return suffix_of(name) in (*TETRAHEDRA, *FOR_MESHERS)


def write_surface(surface: Any, name: str, remark: str = "", solids: Any = None,
                  tell: Tell | None = None, progress: Show | None = None) -> None:
    """Write a surface, or interfaces of labels. `remark` is what the head of the file says beside
    our name and the space; `solids` is a SolidMaker for files of tetrahedra."""
    if is_scene(name):
        labels = surface_labels(surface)
        write_scene([(labels[0].name if len(labels) == 1 else "surface", surface)], name, tell,
                    progress)
        return
    show, solids = progress or surfaces.silent, solids or SolidMaker()
    suffix, head = suffix_of(name), _head(surface) + remark
    _report_losses([surface], name, tell)
    if suffix in surfaces.FORMATS:
        _write(name, surfaces.FORMATS[suffix](surface, head, show))
        return
    with files.output_file(name) as path:
        if needs_mesher(name, solids.mesher):
            write_solid(solids.make(surface, path, show, tell), path, head)
        else:
            write_boundary(surface, path, head)


def write_scene(objects: Sequence[tuple[str, Any]], name: str, tell: Tell | None = None,
                progress: Show | None = None) -> None:
    """Write surfaces that are not empty, with their names, to one .glb or .3mf."""
    show = progress or surfaces.silent
    _report_losses([surface for _, surface in objects], name, tell)
    _write(name, (glb if suffix_of(name) == ".glb" else three_mf)(objects, show))


def write_blocks(blocks: Any, name: str, tell: Tell | None = None, progress: Show | None = None
                 ) -> None:
    """Write blocks that are surfaces to a .vtm, with their files in a folder beside it."""
    with files.output_file(name) as path:
        surfaces.write_vtm(blocks, path, progress or surfaces.silent)
    folder = os.path.splitext(os.path.realpath(name))[0]
    stem = os.path.basename(folder)
    _report_old(folder, f"{stem}_", [f"{stem}_{i}.vtp" for i in range(blocks.GetNumberOfBlocks())],
                tell)


def write_folder(blocks: Any, folder: str, prefix: str,
                 number_of: Callable[[Any], int] | None = None, tell: Tell | None = None) -> None:
    """Write each block that is not empty to FOLDER/PREFIX-NUMBER.vtp; `number_of` gives the number
    of a surface, without it that of the block. The folder is made."""
    written = []
    with files.output_folder(folder) as path:
        for i in range(blocks.GetNumberOfBlocks()):
            block = blocks.GetBlock(i)
            if block is not None and block.GetNumberOfPoints() > 0:
                written.append(f"{prefix}-{number_of(block) if number_of else i}.vtp")
                surfaces.write_pieces(os.path.join(path, written[-1]), surfaces.vtp(block))
    _report_old(folder, prefix + "-", written, tell)


def write_volume(image: Any, name: str, progress: Show | None = None) -> None:
    """Write a volume with all its arrays and field data."""
    _write(name, surfaces.vti(image, progress or surfaces.silent))


def write_table(table: Any, name: str) -> None:
    """Write a .csv with a line of column names."""
    _write(name, surfaces.csv(table))


def _write(name: str, pieces: Iterable[bytes]) -> None:
    with files.output_file(name) as path:
        surfaces.write_pieces(path, pieces)


# ---- What is reported --------------------------------------------------------------------------

def _head(surface: Any) -> str:
    """What a file says in its head: our name, the space and the unit."""
    from .. import __version__
    from ..geometry import fact
    space, unit = fact(surface, "SPACE"), fact(surface, "LengthUnit")
    return (f"volumic {__version__}" + (f", SPACE={space}" if space else "")
            + (f", unit {unit}" if unit else ""))


def _report_losses(those: Sequence[Any], name: str, tell: Tell | None) -> None:
    """Report what the format cannot hold: for all files of a suffix once."""
    for text in (text for surface in those if tell for text in surfaces.losses(
            surface, suffix_of(name))):
        if text not in _reported and tell:
            _reported.add(text)
            tell(f"{name}: {text}")


def _report_old(folder: str, start: str, written: Sequence[str], tell: Tell | None) -> None:
    """Report files of an earlier run that have such names."""
    old = sorted(name for name in (os.listdir(folder) if os.path.isdir(folder) else ())
                 if name.startswith(start) and name.endswith(".vtp") and name not in written)
    if old and tell:
        tell(f"{folder}: files of an earlier run are there: {', '.join(old[:5])}"
             f"{', ...' * (len(old) > 5)}; delete what is old")
