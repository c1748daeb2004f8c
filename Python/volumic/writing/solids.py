# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Files of tetrahedra: .vtu, .inp (CalculiX, Abaqus), .msh (gmsh, MSH 2.2), and what meshio writes.

References: gmsh's manual (legacy formats); CalculiX's manual (*NODE, *ELEMENT, *ELSET, *NSET,
*SURFACE).
"""

from __future__ import annotations

import contextlib
import io
import os
from typing import Any, NamedTuple

import numpy as np

from ..errors import Failure
from .meshers import OUTSIDE, DistinctNames, SetNames, gmsh_word, inp_word, rows, write_lines
from .meshers import write_msh, write_tetgen

BY_MESHIO = {".xdmf": "xdmf", ".med": "med", ".bdf": "nastran", ".mesh": "medit", ".exo": "exodus"}
TETRAHEDRA = (".vtu", ".inp", *BY_MESHIO)   # files of these hold tetrahedra
FOR_MESHERS = (".msh", ".smesh", ".poly")   # a .msh holds tetrahedra where a mesher is chosen
PLAIN = str.maketrans("\"<>&", "'()+")  # VTK writes names of components as they are into XML
PACKAGES = {"meshio": "python3-meshio", "h5py": "python3-h5py", "netCDF4": "python3-netcdf4"}


# ---- Faces of tetrahedra -----------------------------------------------------------------------

# The corners of a face, counterclockwise seen from outside, by the corner opposite to it, and its
# name in Abaqus: S1 has corners 1 2 3, S2 1 4 2, S3 2 4 3, S4 3 4 1.
CORNERS = np.array([[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]])
ABAQUS = np.array(["S3", "S4", "S2", "S1"])


class Faces(NamedTuple):
    """Faces between two labels, or a label and the outside, sorted by these."""
    tetrahedron: np.ndarray  # that of the smaller label, or the only one
    side: np.ndarray         # of the tetrahedron: opposite to this corner
    corners: np.ndarray      # n x 3, outward
    first: np.ndarray
    second: np.ndarray       # label or OUTSIDE
    box: np.ndarray          # side of a box, 1 to 6, or 0
    cap: np.ndarray          # number of the cap, or 0

    @property
    def pairs(self) -> list[tuple[int, int]]:
        """The pairs of labels that touch."""
        return sorted(set(zip(self.first.tolist(), self.second.tolist())))

    @property
    def part(self) -> np.ndarray:
        """As parts_of()."""
        return np.where(self.cap > 0, 6 + self.cap, self.box)


def faces_of(solid: Any) -> Faces:
    """All faces of a Solid between two labels."""
    count = len(solid.cells)
    corners = solid.cells[:, CORNERS].reshape(-1, 3)
    # Marked triangles of the surface take part as faces behind all others.
    keys = np.sort(np.concatenate([corners, solid.marked]), axis=1)
    order = np.lexsort(keys.T[::-1])
    new = np.ones(len(order), bool)
    new[1:] = (np.diff(keys[order], axis=0) != 0).any(axis=1)
    same = np.empty(len(order), int)
    same[order] = np.cumsum(new) - 1
    labels = np.repeat(solid.labels, 4)
    of_face = same[:4 * count]
    least, most = np.full(same.max() + 1, np.iinfo(int).max), np.zeros(same.max() + 1, int)
    np.minimum.at(least, of_face, labels)
    np.maximum.at(most, of_face, labels)
    uses = np.bincount(of_face, minlength=len(least))
    marks = np.zeros((len(least), 2), int)
    marks[same[4 * count:]] = solid.marks
    chosen = ((uses[of_face] == 1) | (least[of_face] < most[of_face])) & (labels == least[of_face])
    found = np.flatnonzero(chosen)
    second = np.where(uses == 1, OUTSIDE, most)[of_face[found]]
    sort = np.lexsort((found, second, labels[found]))
    found, second = found[sort], second[sort]
    return Faces(found // 4, found % 4, corners[found], labels[found], second,
                 *marks[of_face[found]].T)


def named_sets(faces: Faces, labels: dict[int, str], names: DistinctNames
               ) -> tuple[SetNames, dict[str, np.ndarray]]:
    """The names of a file, and which faces are in the set of each pair of labels, side and cap."""
    own = {part: faces.box == part for part in np.unique(faces.box[faces.box > 0]).tolist()}
    own.update({6 + cap: faces.cap == cap for cap in np.unique(faces.cap[faces.cap > 0]).tolist()})
    called = SetNames.of(labels, faces.pairs, own, names)
    sets = {called.pairs[a, b]: (faces.first == a) & (faces.second == b) for a, b in faces.pairs}
    return called, {**sets, **{called.parts[part]: which for part, which in own.items()}}


# ---- Tetrahedra --------------------------------------------------------------------------------

def write_solid_msh(solid: Any, path: str, remark: str = "") -> None:
    """MSH 2.2, which most importers read. A face is in one physical surface only: in that of its
    cap, otherwise of its side of a box, otherwise of the two labels."""
    faces = faces_of(solid)
    part, plain = faces.part, faces.part == 0
    kinds = np.stack([part, faces.first * plain, faces.second * plain], axis=1)
    found, group = np.unique(kinds, axis=0, return_inverse=True)
    order = np.argsort(group.ravel(), kind="stable")
    marks = 1 + group.ravel()[order]
    names = SetNames.of(solid.names, [(a, b) for p, a, b in found.tolist() if not p],
                        [p for p, _, _ in found.tolist() if p], DistinctNames(" ", gmsh_word))
    called = [names.parts[p] if p else names.pairs[a, b] for p, a, b in found.tolist()]
    groups = [f'2 {i + 1} "{name}"\n' for i, name in enumerate(called)]
    groups += [f'3 {label} "{name}"\n' for label, name in names.labels.items()]
    triangles, cells, labels = faces.corners[order] + 1, solid.cells + 1, solid.labels
    numbers = np.arange(1, len(triangles) + len(cells) + 1)
    write_lines(path, f"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Comments\n{remark}\n$EndComments\n"
           f"$PhysicalNames\n{len(groups)}\n", *groups,
           f"$EndPhysicalNames\n$Nodes\n{len(solid.points)}\n",
           rows("%d %r %r %r", np.arange(1, len(solid.points) + 1), solid.points),
           f"$EndNodes\n$Elements\n{len(numbers)}\n",
           rows("%d 2 2 %d %d %d %d %d", numbers[:len(triangles)], marks, marks, triangles),
           rows("%d 4 2 %d %d %d %d %d %d", numbers[len(triangles):], labels, labels, cells),
           "$EndElements\n")


def _set(head: str, numbers: np.ndarray) -> str:
    """A set of an .inp, of numbers from 1, twelve in a line."""
    words = [str(number) for number in (np.unique(numbers) + 1).tolist()]
    lines = [", ".join(words[i:i + 12]) for i in range(0, len(words), 12)]
    return head + "\n" + ",\n".join(lines) + "\n"


def write_inp(solid: Any, path: str, remark: str = "") -> None:
    """Elements C3D4, a set of elements and of nodes for each label, a surface and a set of nodes
    for two labels that touch, for each side of a box and for each cap."""
    faces = faces_of(solid)
    names, sets = named_sets(faces, solid.names,
                             DistinctNames("_", inp_word, ("Eall", "Nall")))
    # CalculiX reads twenty characters of a number.
    text = [f"** {remark}\n*NODE, NSET=Nall\n",
            rows("%d, %.12g, %.12g, %.12g", np.arange(1, len(solid.points) + 1), solid.points)]
    for label, name in names.labels.items():
        own = np.flatnonzero(solid.labels == label)
        text += [f"*ELEMENT, TYPE=C3D4, ELSET={name}\n",
                 rows("%d, %d, %d, %d, %d", own + 1, solid.cells[own] + 1),
                 _set(f"*NSET, NSET={name}", solid.cells[own])]
    text.append("*ELSET, ELSET=Eall\n" + "".join(f"{name},\n" for name in names.labels.values()))
    for name, which in sets.items():
        text += [f"*SURFACE, NAME={name}, TYPE=ELEMENT\n",
                 rows("%d, %s", faces.tetrahedron[which] + 1, ABAQUS[faces.side[which]]),
                 _set(f"*NSET, NSET={name}", faces.corners[which])]
    write_lines(path, *text)


def write_vtu(solid: Any, path: str, _remark: str = "") -> None:
    """What VTK and meshio read: compressed by zlib, and a text of the field data as the name of a
    component of a numerical array, since meshio refuses arrays of texts."""
    from vtkmodules.vtkCommonCore import vtkIntArray
    from vtkmodules.vtkCommonDataModel import vtkUnstructuredGrid
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridWriter
    from .surfaces import write_pieces, xml_text
    grid = vtkUnstructuredGrid()
    grid.ShallowCopy(solid.grid)
    fields = solid.grid.GetFieldData()
    for i in range(fields.GetNumberOfArrays()):
        array = fields.GetAbstractArray(i)
        if array.IsA("vtkStringArray"):
            texts = [array.GetValue(k) for k in range(array.GetNumberOfValues())]
            numbers = vtkIntArray()
            numbers.SetName(array.GetName())
            numbers.SetNumberOfComponents(max(len(texts), 1))
            numbers.InsertNextTuple(range(len(texts)) if texts else (0,))
            for k, text in enumerate(texts):
                numbers.SetComponentName(k, text.translate(PLAIN))
            grid.GetFieldData().AddArray(numbers)
    writer = vtkXMLUnstructuredGridWriter()
    writer.SetCompressorTypeToZLib()
    writer.SetCompressionLevel(2)
    write_pieces(path, [xml_text(writer, grid)])


# ---- Formats of meshio -------------------------------------------------------------------------

def write_by_meshio(solid: Any, path: str, _remark: str = "") -> None:
    """Tetrahedra and the faces between labels: in .med named groups, in .exo named blocks and sets
    of nodes, in .bdf and .mesh numbers, those of faces above those of labels; .xdmf has the cell
    data, and the tetrahedra alone, as FEniCS reads one type of cells."""
    form, faces = BY_MESHIO[os.path.splitext(path)[1].lower()], faces_of(solid)
    names, sets = named_sets(faces, solid.names, DistinctNames("_", str))
    first = max(solid.names) + 1
    # Faces that are in the same sets have a number.
    kinds, numbers = np.unique(np.stack(list(sets.values()), axis=1), axis=0, return_inverse=True)
    refs = [solid.labels, first + numbers.ravel()]
    try:
        import meshio
        with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
            mesh = meshio.Mesh(solid.points, [("tetra", solid.cells), ("triangle", faces.corners)])
            if form == "nastran":
                # The format has 16 characters for a number.
                with np.errstate(divide="ignore"):
                    scale = 10.0 ** (9 - np.floor(np.log10(np.abs(solid.points))))
                mesh.points = np.where(solid.points == 0, 0, np.rint(solid.points * scale) / scale)
            if form in ("nastran", "medit"):
                mesh.cell_data[f"{form}:ref"] = refs
            if form == "med":
                mesh.point_data = solid.point_values
                mesh.cell_data["cell_tags"] = [-ref for ref in refs]
                mesh.cell_tags = {-(first + i): [name for name, there in zip(sets, kind) if there]
                                  for i, kind in enumerate(kinds)}
                mesh.cell_tags.update({-label: [name] for label, name in names.labels.items()})
            if form == "xdmf":
                values = {"Label": solid.labels, **solid.cell_values}
                mesh = meshio.Mesh(solid.points, [("tetra", solid.cells)], solid.point_values,
                                   {name: [array] for name, array in values.items()})
            if form == "exodus":
                mesh = meshio.Mesh(
                    solid.points, [("tetra", solid.cells[solid.labels == n]) for n in names.labels],
                    solid.point_values, point_sets={
                        name: np.unique(faces.corners[which]) for name, which in sets.items()})
            meshio.write(path, mesh, form, **({"data_format": "XML"} if form == "xdmf" else {}))
            if form == "exodus":
                _name_blocks(path, names.labels)
            if form == "med":  # meshio does not close it, where a full disk would be reported
                import h5py
                h5py.File(path, "r").close()
    except ImportError as error:
        raise Failure(f"cannot be written without {error.name} (Debian: apt install "
                      f"{PACKAGES.get(error.name or '', 'python3-meshio')})") from None
    except Exception as error:  # noqa: BLE001  meshio raises whatever its writers do
        raise Failure(f"cannot be written by meshio ({type(error).__name__}: {error})") from None


def _name_blocks(path: str, labels: dict[int, str]) -> None:
    """Give the blocks of an Exodus file the numbers and names of the labels."""
    import netCDF4
    with netCDF4.Dataset(path, "r+") as file:
        file["eb_prop1"][:] = list(labels)
        names = file.createVariable("eb_names", "S1", ("num_el_blk", "len_string"))
        names[:] = np.array([list(name.encode()[:32].ljust(33, b"\0")) for name in labels.values()],
                            np.uint8).view("S1")


# ---- All formats -------------------------------------------------------------------------------

def write_solid(solid: Any, path: str, remark: str = "") -> None:
    """Write a Solid in the format that the suffix of the path names."""
    suffix = os.path.splitext(path)[1].lower()
    {".vtu": write_vtu, ".inp": write_inp, ".msh": write_solid_msh}.get(suffix, write_by_meshio)(
        solid, path, remark)


def write_boundary(surface: Any, path: str, remark: str = "") -> None:
    """Write a surface for meshers, .msh, .smesh or .poly."""
    (write_msh if path.lower().endswith(".msh") else write_tetgen)(surface, path, remark)
