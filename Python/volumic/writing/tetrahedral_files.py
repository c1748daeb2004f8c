# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Writers of tetrahedral meshes: .vtu, .inp (CalculiX, Abaqus), .msh (gmsh, MSH 2.2), meshio.

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
from .meshers import (
    OUTSIDE, DistinctNames, SetNames, abaqus_name, gmsh_name, rows, write_lines, write_msh,
    write_tetgen)

MESHIO_FORMATS = {
    ".xdmf": "xdmf", ".med": "med", ".bdf": "nastran", ".mesh": "medit", ".exo": "exodus"}
TETRAHEDRAL_SUFFIXES = (".vtu", ".inp", *MESHIO_FORMATS)
MESHER_SUFFIXES = (".msh", ".smesh", ".poly")  # .msh is a tetrahedral mesh with --mesher
PLAIN = str.maketrans("\"<>&", "'()+")  # VTK does not escape component names in XML
PACKAGES = {"meshio": "python3-meshio", "h5py": "python3-h5py", "netCDF4": "python3-netcdf4"}


# Corners of the face opposite to each corner, counter-clockwise seen from outside, and its name in
# Abaqus: S1 has corners 1 2 3, S2 1 4 2, S3 2 4 3, S4 3 4 1.
CORNERS = np.array([[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]])
ABAQUS = np.array(["S3", "S4", "S2", "S1"])


class Faces(NamedTuple):
    """Faces between two labels, or a label and the outside, sorted by labels."""
    tetrahedron: np.ndarray  # that of the smaller label
    side: np.ndarray         # opposite corner of the tetrahedron
    corners: np.ndarray      # n x 3, outward
    first: np.ndarray
    second: np.ndarray       # label or OUTSIDE
    box: np.ndarray          # box face, 1 to 6, or 0
    cap: np.ndarray          # number of the cap, or 0

    @property
    def pairs(self) -> list[tuple[int, int]]:
        """Pairs of adjacent labels."""
        return sorted(set(zip(self.first.tolist(), self.second.tolist())))

    @property
    def part(self) -> np.ndarray:
        """Part of each face, see parts_of()."""
        return np.where(self.cap > 0, 6 + self.cap, self.box)


def faces_of(mesh: Any) -> Faces:
    """Return all faces of a TetrahedralMesh between two labels."""
    count = len(mesh.cells)
    corners = mesh.cells[:, CORNERS].reshape(-1, 3)
    # Marked triangles of the surface are appended to the faces.
    keys = np.sort(np.concatenate([corners, mesh.marked]), axis=1)
    order = np.lexsort(keys.T[::-1])
    new = np.ones(len(order), bool)
    new[1:] = (np.diff(keys[order], axis=0) != 0).any(axis=1)
    same = np.empty(len(order), int)
    same[order] = np.cumsum(new) - 1
    labels = np.repeat(mesh.labels, 4)
    of_face = same[:4 * count]
    minimum, maximum = np.full(same.max() + 1, np.iinfo(int).max), np.zeros(same.max() + 1, int)
    np.minimum.at(minimum, of_face, labels)
    np.maximum.at(maximum, of_face, labels)
    uses = np.bincount(of_face, minlength=len(minimum))
    marks = np.zeros((len(minimum), 2), int)
    marks[same[4 * count:]] = mesh.marks
    chosen = (uses[of_face] == 1) | (minimum[of_face] < maximum[of_face])
    chosen &= labels == minimum[of_face]
    found = np.flatnonzero(chosen)
    second = np.where(uses == 1, OUTSIDE, maximum)[of_face[found]]
    sort = np.lexsort((found, second, labels[found]))
    found, second = found[sort], second[sort]
    return Faces(found // 4, found % 4, corners[found], labels[found], second,
                 *marks[of_face[found]].T)


def named_sets(faces: Faces, labels: dict[int, str], names: DistinctNames
               ) -> tuple[SetNames, dict[str, np.ndarray]]:
    """Return names, and which faces are in the set of each pair of labels, box face and cap."""
    own = {part: faces.box == part for part in np.unique(faces.box[faces.box > 0]).tolist()}
    own.update({6 + cap: faces.cap == cap for cap in np.unique(faces.cap[faces.cap > 0]).tolist()})
    set_names = SetNames.of(labels, faces.pairs, own, names)
    sets = {set_names.pairs[a, b]: (faces.first == a) & (faces.second == b) for a, b in faces.pairs}
    return set_names, {**sets, **{set_names.parts[part]: which for part, which in own.items()}}


def write_tetrahedra_msh(mesh: Any, path: str, remark: str = "") -> None:
    """Write MSH 2.2, which most programs import. A face is in one physical surface: of its cap,
    otherwise its box face, otherwise its two labels."""
    faces = faces_of(mesh)
    part, plain = faces.part, faces.part == 0
    kinds = np.stack([part, faces.first * plain, faces.second * plain], axis=1)
    found, group = np.unique(kinds, axis=0, return_inverse=True)
    order = np.argsort(group.ravel(), kind="stable")
    marks = 1 + group.ravel()[order]
    names = SetNames.of(mesh.names, [(a, b) for p, a, b in found.tolist() if not p],
                        [p for p, _, _ in found.tolist() if p], DistinctNames(" ", gmsh_name))
    set_names = [names.parts[p] if p else names.pairs[a, b] for p, a, b in found.tolist()]
    groups = [f'2 {i + 1} "{name}"\n' for i, name in enumerate(set_names)]
    groups += [f'3 {label} "{name}"\n' for label, name in names.labels.items()]
    triangles, cells, labels = faces.corners[order] + 1, mesh.cells + 1, mesh.labels
    numbers = np.arange(1, len(triangles) + len(cells) + 1)
    write_lines(path, f"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Comments\n{remark}\n$EndComments\n"
                f"$PhysicalNames\n{len(groups)}\n", *groups,
                f"$EndPhysicalNames\n$Nodes\n{len(mesh.points)}\n",
                rows("%d %r %r %r", np.arange(1, len(mesh.points) + 1), mesh.points),
                f"$EndNodes\n$Elements\n{len(numbers)}\n",
                rows("%d 2 2 %d %d %d %d %d", numbers[:len(triangles)], marks, marks, triangles),
                rows("%d 4 2 %d %d %d %d %d %d", numbers[len(triangles):], labels, labels, cells),
                "$EndElements\n")


def _set(head: str, numbers: np.ndarray) -> str:
    """Return an .inp set of numbers from 1, twelve per line."""
    texts = [str(number) for number in (np.unique(numbers) + 1).tolist()]
    lines = [", ".join(texts[i:i + 12]) for i in range(0, len(texts), 12)]
    return head + "\n" + ",\n".join(lines) + "\n"


def write_inp(mesh: Any, path: str, remark: str = "") -> None:
    """Write C3D4 elements; an element set and a node set for each label; a surface and a node set
    for each pair of adjacent labels, box face and cap."""
    faces = faces_of(mesh)
    names, sets = named_sets(faces, mesh.names,
                             DistinctNames("_", abaqus_name, ("Eall", "Nall")))
    # CalculiX reads at most 20 characters of a number.
    text = [f"** {remark}\n*NODE, NSET=Nall\n",
            rows("%d, %.12g, %.12g, %.12g", np.arange(1, len(mesh.points) + 1), mesh.points)]
    for label, name in names.labels.items():
        own = np.flatnonzero(mesh.labels == label)
        text += [f"*ELEMENT, TYPE=C3D4, ELSET={name}\n",
                 rows("%d, %d, %d, %d, %d", own + 1, mesh.cells[own] + 1),
                 _set(f"*NSET, NSET={name}", mesh.cells[own])]
    text.append("*ELSET, ELSET=Eall\n" + "".join(f"{name},\n" for name in names.labels.values()))
    for name, which in sets.items():
        text += [f"*SURFACE, NAME={name}, TYPE=ELEMENT\n",
                 rows("%d, %s", faces.tetrahedron[which] + 1, ABAQUS[faces.side[which]]),
                 _set(f"*NSET, NSET={name}", faces.corners[which])]
    write_lines(path, *text)


def write_vtu(mesh: Any, path: str, _remark: str = "") -> None:
    """Write a .vtu file for VTK and meshio. It is compressed by zlib. String arrays of the field
    data become component names of a numeric array, as meshio does not support string arrays."""
    from vtkmodules.vtkCommonCore import vtkIntArray
    from vtkmodules.vtkCommonDataModel import vtkUnstructuredGrid
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridWriter
    from .surfaces import write_pieces, xml_text
    grid = vtkUnstructuredGrid()
    grid.ShallowCopy(mesh.grid)
    fields = mesh.grid.GetFieldData()
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


def write_by_meshio(tetrahedra: Any, path: str, _remark: str = "") -> None:
    """Write tetrahedra and the faces between labels by meshio: .med has named groups, .exo named
    blocks and node sets, .bdf and .mesh numbers, where those of faces are above those of labels.
    .xdmf has cell data and only tetrahedra, as FEniCS reads a single cell type."""
    points, cells = tetrahedra.points, tetrahedra.cells
    form, faces = MESHIO_FORMATS[os.path.splitext(path)[1].lower()], faces_of(tetrahedra)
    names, sets = named_sets(faces, tetrahedra.names, DistinctNames("_", str))
    first = max(tetrahedra.names) + 1
    # Faces in the same sets share a number.
    kinds, numbers = np.unique(np.stack(list(sets.values()), axis=1), axis=0, return_inverse=True)
    refs = [tetrahedra.labels, first + numbers.ravel()]
    try:
        import meshio
        with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
            mesh = meshio.Mesh(points, [("tetra", cells), ("triangle", faces.corners)])
            if form == "nastran":
                # Numbers have 16 characters.
                with np.errstate(divide="ignore"):
                    scale = 10.0 ** (9 - np.floor(np.log10(np.abs(points))))
                mesh.points = np.where(points == 0, 0, np.rint(points * scale) / scale)
            if form in ("nastran", "medit"):
                mesh.cell_data[f"{form}:ref"] = refs
            if form == "med":
                mesh.point_data = tetrahedra.point_values
                mesh.cell_data["cell_tags"] = [-ref for ref in refs]
                mesh.cell_tags = {-(first + i): [name for name, there in zip(sets, kind) if there]
                                  for i, kind in enumerate(kinds)}
                mesh.cell_tags.update({-label: [name] for label, name in names.labels.items()})
            if form == "xdmf":
                values = {"Label": tetrahedra.labels, **tetrahedra.cell_values}
                mesh = meshio.Mesh(points, [("tetra", cells)], tetrahedra.point_values,
                                   {name: [array] for name, array in values.items()})
            if form == "exodus":
                mesh = meshio.Mesh(
                    points, [("tetra", cells[tetrahedra.labels == n]) for n in names.labels],
                    tetrahedra.point_values, point_sets={
                        name: np.unique(faces.corners[which]) for name, which in sets.items()})
            meshio.write(path, mesh, form, **({"data_format": "XML"} if form == "xdmf" else {}))
            if form == "exodus":
                _name_blocks(path, names.labels)
            if form == "med":  # meshio does not close it, and a full disk would go unnoticed
                import h5py
                h5py.File(path, "r").close()
    except ImportError as error:
        raise Failure(f"cannot be written; install {error.name} (Debian: apt install "
                      f"{PACKAGES.get(error.name or '', 'python3-meshio')})") from None
    except Exception as error:  # noqa: BLE001  meshio raises whatever its writers do
        raise Failure(f"cannot be written by meshio ({type(error).__name__}: {error})") from None


def _name_blocks(path: str, labels: dict[int, str]) -> None:
    """Set numbers and names of the blocks of an Exodus file to those of the labels."""
    import netCDF4
    with netCDF4.Dataset(path, "r+") as file:
        file["eb_prop1"][:] = list(labels)
        names = file.createVariable("eb_names", "S1", ("num_el_blk", "len_string"))
        names[:] = np.array([list(name.encode()[:32].ljust(33, b"\0")) for name in labels.values()],
                            np.uint8).view("S1")


def write_tetrahedra(mesh: Any, path: str, remark: str = "") -> None:
    """Write a TetrahedralMesh in the format of the suffix."""
    writers = {".vtu": write_vtu, ".inp": write_inp, ".msh": write_tetrahedra_msh}
    suffix = os.path.splitext(path)[1].lower()
    writers.get(suffix, write_by_meshio)(mesh, path, remark)


def write_boundary(surface: Any, path: str, remark: str = "") -> None:
    """Write a surface as input of meshers: .msh, .smesh or .poly."""
    (write_msh if path.lower().endswith(".msh") else write_tetgen)(surface, path, remark)
