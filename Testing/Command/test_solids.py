# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Tests of tetrahedral meshes by TetGen and gmsh: .vtu, .msh, .inp (solved by CalculiX), formats of
meshio."""

import json
import os
import re
import shutil
import unittest
from collections import Counter

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

from test_interfaces import ORIGIN, SPACING, InterfacesTest, period, sections_of
from solid_files import (
    faces_between, inp_mesh, keywords_of, least_angles, msh, tetrahedra_of, volumes)
from vtk_files import points_of, read, triangles_of

try:
    import meshio
except ImportError:
    meshio = None
try:
    import netCDF4
except ImportError:
    netCDF4 = None

MESHERS = [name for name in ("tetgen", "gmsh") if shutil.which(name)]


def voxels():
    """Return [z, y, x]: a box of label 1 adjacent to label 2, which contains a cavity and label 1;
    label 4 touches both."""
    found = np.zeros((20, 32, 40), "u1")
    found[2:18, 2:18, 2:14] = 1
    found[2:18, 2:18, 14:38] = 2
    found[7:13, 7:13, 17:23] = 0
    found[7:13, 7:13, 28:34] = 1
    found[4:16, 18:30, 8:30] = 4
    return found


class SolidsTest(InterfacesTest):
    def solid(self, *files, options=()):
        """Return the report of a run and the first grid."""
        report = self.report(self.map_of(voxels()), *(self.path(file) for file in files),
                             "--labels", "all", "--label-names", self.names_file(), *options)
        return report, read(self.path(files[0]), vtkXMLUnstructuredGridReader())


@unittest.skipUnless(MESHERS, "no mesher is installed")
class MesherTest(SolidsTest):
    def test_tetrahedra_fill_the_interfaces(self):
        for mesher in MESHERS:
            report, grid = self.solid("a.vtu", "a.vtp", options=("--mesher", mesher))
            points, (corners, labels) = points_of(grid), tetrahedra_of(grid)
            sizes = volumes(points, corners)
            self.assertGreater(sizes.min(), 0)
            for row in report["labels"]:
                self.assertAlmostEqual(sizes[labels == row["label"]].sum() / row["volume"], 1, 5)
            # Triangles are bit-identical to those of the surface.
            surface = read(self.path("a.vtp"))
            sides = vtk_to_numpy(surface.GetCellData().GetArray("BoundaryLabels"))
            sides = sides[surface.GetNumberOfLines():]
            at = {tuple(point): i for i, point in enumerate(points.tolist())}
            numbers = np.array([at[tuple(point)] for point in points_of(surface).tolist()])
            faces = faces_between(corners, labels)
            found = {}
            for triangle, side in zip(numbers[triangles_of(surface)].tolist(), sides.tolist()):
                pair = tuple(sorted(side)) if min(side) > 0 else (max(side), 0)
                found.setdefault(pair, set()).add(frozenset(triangle))
            self.assertEqual(found, faces)
            solid = report["solid"]
            angles = least_angles(points, corners)
            self.assertAlmostEqual(solid["least_angle"], angles.min(), 6)
            self.assertAlmostEqual(solid["percent_angle"], np.sort(angles)[len(angles) // 100], 6)
            self.assertEqual((solid["mesher"], solid["nodes"], solid["tetrahedra"]),
                             (mesher, len(points), len(corners)))
            self.assertEqual({row["label"]: row["name"] for row in solid["regions"]},
                             {1: "liver", 2: "left kidney", 4: 'a "b"'})
            names = grid.GetFieldData().GetArray("LabelName")
            self.assertEqual([names.GetComponentName(i) for i in range(3)],
                             ["liver", "left kidney", "a 'b'"])

    def outlets(self):
        """Write two vessels that leave the volume at z-max, with values that increase with z."""
        z, y, x = np.indices((18, 18, 40))
        far = np.minimum(np.hypot(x - 9.3, y - 8.5), np.hypot(x - 29.6, y - 8.5))
        return self.map_of(np.minimum(5.2 - far, z - 3.5).astype("f4"), "outlets.vti")

    def test_each_cap_is_a_set(self):
        """A surface and node set in .inp, a physical surface in .msh, a solid in .stl."""
        for mesher in MESHERS:
            files = map(self.path, ("a.vtp", "a.inp", "a.msh", "a.stl"))
            self.run_command(self.outlets(), *files, "--iso", "0", "--ends", "marked", "--mesher",
                             mesher)
            surface = read(self.path("a.vtp"))
            points, caps = points_of(surface), vtk_to_numpy(surface.GetCellData().GetArray("Cap"))
            faces = {f"cap_{cap}": {frozenset(map(tuple, np.round(points[triangle], 6).tolist()))
                                    for triangle in triangles_of(surface)[caps == cap]}
                     for cap in (1, 2)}
            self.assertGreater(min(map(len, faces.values())), 20)
            mesh = inp_mesh(self.path("a.inp"))
            coordinates = np.array([mesh.nodes[i + 1] for i in range(len(mesh.nodes))])
            for name, found in {**faces, "z_max": faces["cap_1"] | faces["cap_2"]}.items():
                self.assertEqual({frozenset(tuple(np.round(mesh.nodes[i], 6).tolist())
                                            for i in face) for face in mesh.surfaces[name]}, found)
                self.assertEqual(mesh.sets["*NSET", name], set().union(*mesh.surfaces[name]))
            plane = ORIGIN[2] + 16 * SPACING[2]
            self.assertEqual(mesh.sets["*NSET", "z_max"],
                             set((1 + np.flatnonzero(abs(coordinates[:, 2] - plane) < 1e-9)).tolist()))
            _, _, surfaces = msh(self.path("a.msh"))
            self.assertEqual({name: len(found) for name, found in surfaces.items()},
                             {"object_to_outside": np.count_nonzero(caps == 0),
                              **{name: len(found) for name, found in faces.items()}})
            self.assertEqual(re.findall(r"^solid (\w+)", self.content("a.stl").decode(), re.M),
                             ["wall", "cap_1", "cap_2"])

    def test_caps_of_labels(self):
        found = np.zeros((10, 12, 26), "u1")
        found[:, 3:9, 3:9] = found[:, 3:9, 16:22] = 1
        found[:, 3:9, 9:12] = 2
        self.run_command(self.map_of(found), self.path("a.vtp"), self.path("a.inp"), "--labels",
                         "all", "--ends", "marked", "--label-names",
                         self.write_bytes("caps.json", b'{"1": "blood", "2": "cap_1"}'))
        surface = read(self.path("a.vtp"))
        caps, sides, labels = (vtk_to_numpy(surface.GetCellData().GetArray(name))
                               for name in ("Cap", "BoxFace", "BoundaryLabels"))
        entries = set(zip(caps.tolist(), sides.tolist(), labels.max(axis=1).tolist()))
        self.assertEqual(sorted(entry for entry in entries if entry[0]), [
            (1, 5, 1), (2, 5, 1), (3, 6, 1), (4, 6, 1), (5, 5, 2), (6, 6, 2)])
        mesh = inp_mesh(self.path("a.inp"))
        for cap, name in enumerate(["cap_1_2", *(f"cap_{n}" for n in range(2, 7))], 1):
            self.assertEqual(len(mesh.surfaces[name]), np.count_nonzero(caps == cap))

    def test_caps_without_a_mesher(self):
        self.run_command(self.outlets(), self.path("a.msh"), self.path("a.smesh"), "--iso", "0",
                         "--ends", "marked")
        names = "".join(sections_of(self.path("a.msh"))["PhysicalNames"])
        self.assertEqual(re.findall('"(.*)"', names),
                         ["object_to_outside", "cap_1", "cap_2", "object"])
        self.assertIn(b"# facets 3: cap_2\n", self.content("a.smesh"))

    def test_probes_add_values(self):
        z = np.indices((18, 18, 40))[0].astype("f4")
        self.run_command(self.outlets(), self.path("a.vtu"), "--iso", "0", "--ends", "marked",
                         "--probe", self.map_of(z, "density.vti"))
        grid = read(self.path("a.vtu"), vtkXMLUnstructuredGridReader())
        heights = (points_of(grid)[:, 2] - ORIGIN[2]) / SPACING[2]
        np.testing.assert_allclose(vtk_to_numpy(grid.GetPointData().GetArray("density")), heights,
                                   atol=1e-5)
        np.testing.assert_allclose(vtk_to_numpy(grid.GetCellData().GetArray("density")),
                                   heights[tetrahedra_of(grid)[0]].mean(axis=1), atol=1e-5)

    @unittest.skipUnless(meshio, "meshio is not installed")
    def test_meshio_reads_files(self):
        files = ["a.vtu", "a.xdmf", "a.med", "a.bdf", "a.mesh"] + ["a.exo"] * bool(netCDF4)
        report, grid = self.solid(*files)
        points, (corners, labels) = points_of(grid), tetrahedra_of(grid)
        for file in files:
            mesh = meshio.read(self.path(file))
            np.testing.assert_allclose(mesh.points, points, rtol=1e-9)
            cells = np.concatenate([block.data for block in mesh.cells if block.type == "tetra"])
            order = np.argsort(labels, kind="stable") if file == "a.exo" else slice(None)
            np.testing.assert_array_equal(cells, corners[order])
            numbers = next((values[0] for name, values in mesh.cell_data.items()
                            if name in ("Label", "nastran:ref", "medit:ref")), None)
            if numbers is not None:
                np.testing.assert_array_equal(numbers, labels)
        names = meshio.read(self.path("a.med")).cell_tags
        self.assertEqual([names[-label] for label in (1, 2, 4)],
                         [["liver"], ["left kidney"], ['a "b"']])
        self.assertIn(["left kidney_to_outside"], names.values())
        self.assertEqual(len(corners), report["solid"]["tetrahedra"])

    def test_region_without_interior_node(self):
        volume = self.map_of(np.pad(np.ones((2, 2, 2), "u1"), 2), "small.vti")
        for mesher in MESHERS:
            report = self.report(volume, self.path("small.vtu"), "--labels", "all",
                                 "--edge-length", "2", "--mesher", mesher)
            self.assertGreater(report["solid"]["tetrahedra"], 0)

    def test_maximum_volume(self):
        for mesher in MESHERS:
            counts = []
            for limit in (20, 0.1):
                _, grid = self.solid("a.vtu", options=("--mesher", mesher, "--maximum-volume",
                                                       str(limit)))
                # Triangles are kept; gmsh uses the edge length of such a tetrahedron.
                sizes = volumes(points_of(grid), tetrahedra_of(grid)[0])
                self.assertLess(np.median(sizes), 2 * limit)
                counts.append(len(sizes))
            self.assertGreater(counts[1], 1.3 * counts[0])

    def test_box_faces(self):
        """Two labels fill the box; one has the name of a box face."""
        found = np.ones((8, 9, 10), "u1")
        found[:, :, 5:] = 2
        lengths = np.array(found.shape[::-1]) * SPACING
        for mesher in MESHERS:
            self.run_command(self.map_of(found), self.path("a.inp"), self.path("a.msh"), "--labels",
                             "all", "--label-names",
                             self.write_bytes("box.json", b'{"1": "x_min", "2": "b"}'),
                             "--box-faces", "flat", "--mesher", mesher)
            sets = inp_mesh(self.path("a.inp")).sets
            nodes, _, triangles = msh(self.path("a.msh"))
            sides = ["x_min 2", "x_max", "y_min", "y_max", "z_min", "z_max"]
            self.assertEqual(list(triangles), ["x_min_to_b", *sides])
            rows = np.concatenate(list(triangles.values())).tolist()
            self.assertEqual(len(rows), len(set(map(frozenset, rows))))
            for side, name in enumerate(sides):
                axis = side // 2
                plane = ORIGIN[axis] - SPACING[axis] / 2 + side % 2 * lengths[axis]
                there = np.flatnonzero(abs(nodes[:, axis] - plane) < 1e-9)
                self.assertEqual(sets["*NSET", name.replace(" ", "_")], set((there + 1).tolist()))
                self.assertEqual(set(triangles[name].ravel().tolist()), set(there.tolist()))
                a, b, c = np.moveaxis(nodes[triangles[name]], 1, 0)
                self.assertAlmostEqual(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2,
                                       np.delete(lengths, axis).prod(), 6)

    def test_periodic_nodes_match(self):
        for mesher in MESHERS:
            self.run_command(self.map_of(period()), self.path("a.inp"), "--labels", "all",
                             "--box-faces", "periodic", "--mesher", mesher)
            parts = dict(keywords_of(self.path("a.inp")))
            nodes = np.array(parts["*NODE, NSET=Nall"], float)[:, 1:]
            for axis, name in enumerate("xyz"):
                first, last = (np.array([int(word) for row in parts[f"*NSET, NSET={name}_{end}"]
                                         for word in row]) for end in ("min", "max"))
                self.assertTrue((np.diff(first) > 0).all() and (np.diff(last) > 0).all())
                apart = nodes[last - 1] - nodes[first - 1]
                np.testing.assert_array_equal(np.delete(apart, axis, 1), 0)
                np.testing.assert_allclose(apart[:, axis], period().shape[2 - axis] * SPACING[axis])

    def test_msh_of_tetrahedra(self):
        _, grid = self.solid("a.vtu", "a.msh", options=("--mesher", MESHERS[0]))
        corners, labels = tetrahedra_of(grid)
        nodes, cells, triangles = msh(self.path("a.msh"))
        np.testing.assert_array_equal(nodes, points_of(grid))
        np.testing.assert_array_equal(cells, np.column_stack([labels, corners]))
        called = {0: "outside", 1: "liver", 2: "left kidney", 4: "a 'b'"}
        faces = {f"{called[a]}_to_{called[b]}": found
                 for (a, b), found in faces_between(corners, labels).items()}
        self.assertEqual({name: set(map(frozenset, found.tolist()))
                          for name, found in triangles.items()}, faces)

    def run_script(self, script, *options, status=1):
        """Return messages and files of a run with this script as TetGen."""
        for folder in ("bin", "out"):
            os.makedirs(self.path(folder), exist_ok=True)
        self.write_bytes("bin/tetgen", f"#!/bin/sh\n{script}\n".encode())
        os.chmod(self.path("bin/tetgen"), 0o755)
        process = self.run_command(
            self.map_of(voxels()), self.path("out/a.vtu"), self.path("out/a.vtp"), "--labels",
            "all", *options, status=status, env={**os.environ, "PATH": self.path("bin") + ":/bin"})
        return process.stderr, os.listdir(self.path("out"))

    def test_failing_mesher(self):
        """Other files are written, and no temporary files remain."""
        for script, printed in (("echo sorry; exit 3", r"a.vtu: tetgen failed \(exit code 3\): sorry"),
                                ("kill -9 $$", r"a.vtu: tetgen failed \(signal 9\)"),
                                ("echo Tetrahedra 1 1 1 1 1 1 > surface.1.mesh", "full.*: it has no end")):
            messages, files = self.run_script(script)
            self.assertRegex(messages, printed)
            self.assertEqual(files, ["a.vtp"])

    def test_mesher_is_stopped(self):
        """By one signal, by two signals (as timeout sends them), and by the time limit."""
        for script, printed, *options in (
                ("kill -INT $PPID; exec sleep 100", "a.vtu: interrupted while tetgen was running"),
                ("kill -TERM $PPID; kill -TERM $PPID; exec sleep 100",
                 "a.vtu: interrupted while tetgen was running"),
                ("exec sleep 100", "a.vtu: time limit reached while tetgen was running",
                 "--time-limit", 2)):
            messages, files = self.run_script(script, *options)
            self.assertRegex(messages, printed)
            self.assertEqual(files, ["a.vtp"])

    def test_too_many_tetrahedra_fail(self):
        messages, files = self.run_script("exit 9", "--maximum-volume", "1e-300")
        self.assertRegex(messages, "a.vtu: --maximum-volume 1e-300 requires more than 2e.08 tetrahedra; "
                         "set it to at least [1-9]")
        self.assertEqual(files, ["a.vtp"])

    def test_small_angles_warn(self):
        for height, messages in ((0.01, "warning: the minimum dihedral angle .* degrees"), (1, "^$")):
            mesh = "\n".join(["Vertices", "4", "0 0 0 0", "1 0 0 0", "0 1 0 0", f"0 0 {height} 0",
                              "Tetrahedra", "3",
                              *(f"1 2 3 4 {label}" for label in (1, 2, 4)), "End"])
            printed, _ = self.run_script(f"cat > surface.1.mesh <<.\n{mesh}\n.", status=0)
            self.assertRegex("".join(re.findall("warning: the minimum.*", printed)), messages)


class OptionsTest(SolidsTest):
    def test_missing_mesher_fails_before_reading(self):
        environment = {**os.environ, "PATH": self.folder}
        for options, printed in (((), r"require TetGen or gmsh; .* \(Debian: apt install tetgen\)"),
                                 (("--mesher", "gmsh"), r"gmsh is not installed \(Debian: apt")):
            for name in ("a.vtu", "a.inp"):
                self.rejects(printed, self.path("missing.vti"), self.path(name), *options,
                             env=environment)


@unittest.skipUnless(MESHERS, "no mesher is installed")
class SolverTest(SolidsTest):
    def test_sets_of_inp(self):
        _, grid = self.solid("a.vtu", "a.inp")
        corners, labels = tetrahedra_of(grid)
        mesh = inp_mesh(self.path("a.inp"))
        np.testing.assert_allclose(list(mesh.nodes.values()), points_of(grid), atol=1e-9)
        called = {1: "liver", 2: "left_kidney", 4: "a__b_", 0: "outside"}
        for label in (1, 2, 4):
            self.assertEqual(mesh.sets["*ELEMENT", called[label]],
                             set((1 + np.flatnonzero(labels == label)).tolist()))
            self.assertEqual(mesh.sets["*NSET", called[label]],
                             set((1 + corners[labels == label]).ravel().tolist()))
        for number, cell in mesh.cells.items():
            self.assertEqual(cell, (1 + corners[number - 1]).tolist())
        self.assertIn("*ELSET, ELSET=Eall\nliver,\nleft_kidney,\na__b_,\n",
                      self.content("a.inp").decode())
        self.assertEqual(mesh.surfaces, {
            f"{called[a]}_to_{called[b]}": {frozenset(i + 1 for i in face) for face in found}
            for (a, b), found in faces_between(corners, labels).items()})
        for name, found in mesh.surfaces.items():
            self.assertEqual(mesh.sets["*NSET", name], set().union(*found))
        self.assertLess(max(len(word) for line in self.content("a.inp").decode().splitlines()
                            if line[0] != "*" for word in line.split(", ")), 21)

    def test_set_names_are_valid_and_unique(self):
        for given, sets in ((("Liver, left", "liver left", "4th"),
                             ["Liver__left", "liver_left", "L_4th"]),
                            (("Eall", "a b", "a.b"), ["Eall_2", "a_b", "a_b_2"])):
            names = json.dumps(dict(zip("124", given))).encode()
            self.run_command(self.map_of(voxels()), self.path("a.inp"), "--labels", "all",
                             "--label-names", self.write_bytes("words.json", names))
            heads = [head for head, _ in keywords_of(self.path("a.inp"))]
            self.assertEqual([re.search("ELSET=(.*)", head).group(1) for head in heads
                              if "C3D4" in head], sets)
        names = Counter(re.search("NSET=(.*)", head).group(1).lower() for head in heads
                        if head.startswith("*NSET"))
        self.assertEqual(max(names.values()), 1)
