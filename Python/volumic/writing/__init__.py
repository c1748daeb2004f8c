# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Writing of surfaces, tetrahedra, volumes and tables, each in the format of the suffix.

A file replaces the old one when it is complete, see files.py. All functions throw Failure that
names the file if it cannot be written.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Sequence
from typing import Any

from ..errors import Failure, UsageError
from . import files, surfaces
from .regions import surface_labels
from .scenes import glb, three_mf
from .solids import BY_MESHIO, FOR_MESHERS, TETRAHEDRA, write_boundary, write_solid
from .surfaces import Show, silent
from .tetrahedra import SolidMaker, needs_mesher

Tell = Callable[[str], Any]

SCENES = {".glb": glb, ".3mf": three_mf}
SUFFIXES = (*surfaces.FORMATS, *SCENES, ".vtu", ".inp", *FOR_MESHERS, *BY_MESHIO)

_reported: set[str] = set()  # reported once for all files


def suffix_of(name: str) -> str:
    """Return the suffix with a dot, in lower case."""
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
    """Return whether a file of this name holds several surfaces with their names and colors."""
    return suffix_of(name) in SCENES


def is_of_solids(name: str) -> bool:
    """Return whether a file of this name holds tetrahedra or is for meshers: of several labels it
    holds one mesh."""
    return suffix_of(name) in (*TETRAHEDRA, *FOR_MESHERS)


def write_surface(surface: Any, name: str, remark: str = "", solids: SolidMaker | None = None,
                  tell: Tell = silent, progress: Show = silent) -> None:
    """Write a surface, or interfaces of labels. The head of the file has our name, the space, the
    unit and the `remark`. `solids` makes tetrahedra."""
    from .. import __version__
    from ..geometry import fact
    if is_scene(name):
        labels = surface_labels(surface)
        write_scene([(labels[0].name if len(labels) == 1 else "surface", surface)], name, tell,
                    progress)
        return
    space, unit = fact(surface, "SPACE"), fact(surface, "LengthUnit")
    head = (f"volumic {__version__}" + f", SPACE={space}" * bool(space)
            + f", unit {unit}" * bool(unit) + remark)
    solids = solids or SolidMaker()
    _report_losses([surface], name, tell)
    with files.output_file(name) as path:
        if suffix_of(name) in surfaces.FORMATS:
            surfaces.write_pieces(path, surfaces.FORMATS[suffix_of(name)](surface, head, progress))
        elif needs_mesher(name, solids.mesher):
            write_solid(solids.make(surface, path, progress, tell), path, head)
        else:
            write_boundary(surface, path, head)


def write_scene(objects: Sequence[tuple[str, Any]], name: str, tell: Tell = silent,
                progress: Show = silent) -> None:
    """Write surfaces that are not empty, with their names, to one .glb or .3mf."""
    objects = [item for item in objects if item[1].GetNumberOfPoints() > 0]
    if not objects:
        raise Failure(f"{name}: cannot be written (there is no surface)")
    _report_losses([surface for _, surface in objects], name, tell)
    _write(name, SCENES[suffix_of(name)](objects, progress))


def write_blocks(blocks: Any, name: str, tell: Tell = silent, progress: Show = silent) -> None:
    """Write blocks that are surfaces to a .vtm, with their files in a folder beside it."""
    with files.output_file(name) as path:
        surfaces.write_vtm(blocks, path, progress)
    folder = os.path.splitext(os.path.realpath(name))[0]
    start = os.path.basename(folder) + "_"
    report_old(folder, [f"{start}{i}.vtp" for i in range(blocks.GetNumberOfBlocks())], tell, start)


def write_folder(blocks: Any, folder: str, prefix: str,
                 number_of: Callable[[Any], int] | None = None, tell: Tell = silent) -> None:
    """Write each block that is not empty to FOLDER/PREFIX-NUMBER.vtp; `number_of` gives the number
    of a surface (default: that of the block). The folder is made."""
    written = []
    with files.output_folder(folder) as path:
        for i in range(blocks.GetNumberOfBlocks()):
            block = blocks.GetBlock(i)
            if block is not None and block.GetNumberOfPoints() > 0:
                written.append(f"{prefix}-{number_of(block) if number_of else i}.vtp")
                surfaces.write_pieces(os.path.join(path, written[-1]), surfaces.vtp(block))
    report_old(folder, written, tell, prefix + "-")


def write_volume(image: Any, name: str, progress: Show = silent) -> None:
    """Write a volume with all its arrays and field data."""
    _write(name, surfaces.vti(image, progress))


def write_table(table: Any, name: str) -> None:
    """Write a .csv with a line of column names."""
    _write(name, surfaces.csv(table))


def _write(name: str, pieces: Iterable[bytes]) -> None:
    with files.output_file(name) as path:
        surfaces.write_pieces(path, pieces)


def _report_losses(those: Sequence[Any], name: str, tell: Tell) -> None:
    """Report what the format cannot hold: once for all files of a suffix."""
    for text in (text for each in those for text in surfaces.losses(each, suffix_of(name))):
        if text not in _reported:
            _reported.add(text)
            tell(f"{name}: {text}")


def report_old(folder: str, written: Sequence[str], tell: Tell, start: str = "",
               suffix: str = ".vtp") -> None:
    """Report files of an earlier run: those with such names that are not among the written ones."""
    old = sorted(name for name in (os.listdir(folder) if os.path.isdir(folder) else ())
                 if name.startswith(start) and name.endswith(suffix) and name not in written)
    if old:
        tell(f"{folder}: files of an earlier run are there: {', '.join(old[:5])}"
             f"{', ...' * (len(old) > 5)}; delete what is old")
