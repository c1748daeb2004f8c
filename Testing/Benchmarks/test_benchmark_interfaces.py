# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""interface_figures.py and interface_solvers.py on two cubes side by side, of which all is known, and
benchmark_interfaces.py on a small map.

VOLUMIC_JUDGE_FILES and VOLUMIC_MAKE_VOLUME name the programs; volumic is installed.
"""

import os
import subprocess
import sys
import unittest

import numpy as np

import interface_figures as figures
import interface_solvers
from benchmark_test_case import SharedFolderTestCase, number, read_csv
from interface_runs import runs_here

SCRIPT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "benchmark_interfaces.py")
JUDGE = os.environ["VOLUMIC_JUDGE_FILES"]


def cubes():
    """Labels 1 and 2, side by side along x, with edges of 1; the points are (x, y, z)."""
    points = np.array([[x, y, z] for x in range(3) for y in range(2) for z in range(2)], float)
    triangles, sides = [], []

    def add(behind, front, *square):
        a, b, c, d = (4 * x + 2 * y + z for x, y, z in square)
        triangles.extend([(a, b, c), (a, c, d)])
        sides.extend([(behind, front)] * 2)
    for x, behind, front in ((0, 0, 1), (1, 1, 2), (2, 2, 0)):
        add(behind, front, (x, 0, 0), (x, 1, 0), (x, 1, 1), (x, 0, 1))
    for x, label in ((0, 1), (1, 2)):
        for at, behind, front in ((0, 0, label), (1, label, 0)):
            add(front, behind, (x, at, 0), (x + 1, at, 0), (x + 1, at, 1), (x, at, 1))
            add(behind, front, (x, 0, at), (x + 1, 0, at), (x + 1, 1, at), (x, 1, at))
    lines = [(4, 5), (5, 7), (7, 6), (6, 4)]
    return figures.Complex(points, triangles, sides, lines, np.repeat([0, 1, 0], 4))


def with_triangles(shape, triangles, sides, points=()):
    return figures.Complex(np.vstack([shape.points, *points]),
                           np.vstack([shape.triangles, triangles]),
                           np.vstack([shape.sides, sides]), shape.lines, shape.junction)


class TopologyTest(unittest.TestCase):
    def test_two_cubes_are_whole(self):
        shape = cubes()
        self.assertEqual(list(shape.labels()), [1, 2])
        for label in (1, 2):
            faces = shape.faces_of(label)
            self.assertEqual(figures.wrong_edges(faces), 0)
            self.assertEqual(figures.pinched_vertices(faces), 0)
            self.assertAlmostEqual(figures.volume_of(shape.points, faces), 1)
        self.assertEqual(figures.wrong_lines(shape), 0)
        self.assertEqual(figures.wrong_junctions(shape), 0)
        self.assertEqual(figures.intersections(shape, JUDGE), (0, 0))

    def test_a_hole_opens_what_is_behind_and_in_front(self):
        shape = cubes()
        interface = np.flatnonzero((shape.sides == (1, 2)).all(axis=1))[0]
        kept = np.arange(len(shape.triangles)) != interface
        shape = figures.Complex(shape.points, shape.triangles[kept], shape.sides[kept], shape.lines)
        self.assertEqual([figures.wrong_edges(shape.faces_of(label)) for label in (1, 2)], [3, 3])
        self.assertEqual(figures.wrong_lines(shape), 2)

    def test_a_triangle_turned_over_is_an_error(self):
        shape = cubes()
        shape.triangles[0] = shape.triangles[0, ::-1]
        self.assertEqual([figures.wrong_edges(shape.faces_of(label)) for label in (1, 2)], [3, 0])

    def test_what_is_there_twice_is_an_error(self):
        faces = cubes().faces_of(1)
        self.assertEqual(figures.wrong_edges(np.vstack([faces, faces])), 18)

    def test_labels_that_overlap_at_a_line_are_told(self):
        for lean in (-.2, 0, .2):  # the interface's upper edge
            shape = cubes()
            shape.points[[5, 7], 0] += lean
            self.assertEqual(figures.folded_edges(shape), 0)
        below = cubes()
        below.points[[5, 7], 2] = -1
        self.assertGreater(figures.folded_edges(below), 0)
        is_interface = (shape.sides == (1, 2)).all(axis=1)
        shape.sides[is_interface] = 2, 1
        self.assertEqual(figures.folded_edges(shape), 4)

    def test_a_vertex_of_two_fans_is_pinched(self):
        one, other = cubes(), cubes()
        faces = np.vstack([one.faces_of(1), np.where(other.faces_of(2) == 11, 0,
                                                     other.faces_of(2) + 20)])
        self.assertEqual(figures.wrong_edges(faces), 0)
        self.assertEqual(figures.pinched_vertices(faces), 1)

    def test_lines_are_compared_with_edges(self):
        shape = cubes()
        shape.lines = np.array([(5, 4), (5, 7), (7, 6), (0, 1), (0, 1)])
        self.assertEqual(figures.wrong_lines(shape), 3)  # one is missing, one wrong, and twice
        self.assertEqual(figures.wrong_junctions(shape), 4)

    def test_blocks_are_compared_with_what_they_are_of(self):
        shape = cubes()
        faces = {label: shape.faces_of(label) for label in (1, 2)}
        places = shape.points.astype(np.float32)

        def wrong(**others):
            """With so many blocks as they should be, but for what is told of the first."""
            block = {"points": places, "numbers": np.arange(12), "faces": faces[1][::-1, [1, 2, 0]]}
            shape.blocks = {1: tuple({**block, **others}.values()),
                            2: (places[4:], np.arange(4, 12), faces[2] - 4)}
            return figures.wrong_blocks(shape)
        self.assertEqual(wrong(), 0)
        self.assertEqual(wrong(points=places + np.float32(1e-6)), 1)
        self.assertEqual(wrong(faces=faces[1][1:]), 1)
        self.assertEqual(wrong(faces=faces[1][:, ::-1]), 1)
        del shape.blocks[1]
        self.assertEqual(figures.wrong_blocks(shape), 1)

    def test_twins_become_one(self):
        shape = cubes()
        labels = np.repeat((1, 2), (len(shape.faces_of(1)), len(shape.faces_of(2))))
        joined = figures.complex_of_twins(
            shape.points, np.vstack([shape.faces_of(1), shape.faces_of(2)]), labels)
        self.assertEqual(len(joined.triangles), len(shape.triangles))
        self.assertEqual((joined.sides == (1, 2)).all(axis=1).sum(), 2)
        self.assertEqual([figures.wrong_edges(joined.faces_of(label)) for label in (1, 2)], [0, 0])

    def test_of_three_triangles_two_are_twins(self):
        joined = figures.complex_of_twins(
            np.eye(3), np.array([(0, 1, 2), (2, 1, 0), (1, 2, 0)]), np.array([1, 2, 3]))
        self.assertEqual([tuple(sides) for sides in joined.sides], [(1, 2), (3, 0)])

    def test_surfaces_side_by_side_share_nothing(self):
        shape = cubes()
        apart = figures.complex_of_surfaces(
            [(label, shape.points, shape.faces_of(label)) for label in (1, 2)])
        self.assertEqual(len(figures.edges_of_many(apart)), 0)
        # At least each half of the square with both halves of the other square in its place.
        self.assertGreater(figures.intersections(apart, JUDGE)[0], 4)


class IntersectionTest(unittest.TestCase):
    def pairs(self, *places, corners):
        """Of the cubes with one more triangle."""
        return figures.intersections(with_triangles(
            cubes(), [corners], [(1, 0)], [np.array(places, float).reshape(-1, 3)]), JUDGE)

    def test_a_triangle_across_an_interface(self):
        self.assertEqual(self.pairs((.5, .6, .5), (1.5, .6, .5), (1.5, .7, .6),
                                    corners=(12, 13, 14)), (1, 0))

    def test_a_triangle_that_leaves_a_common_corner(self):
        """From the corner (1, 0, 0) through the top of the first cube; or within it."""
        self.assertEqual(self.pairs((.4, .5, 1.5), (.4, .6, 1.5), corners=(4, 12, 13)), (1, 0))
        self.assertEqual(self.pairs((.4, .5, .5), (.4, .6, .5), corners=(4, 12, 13)), (0, 0))

    def test_a_triangle_folded_onto_another_at_a_common_edge(self):
        self.assertEqual(self.pairs((1, .9, .5), corners=(4, 5, 12))[0], 2)
        self.assertEqual(self.pairs((1, -.5, .5), corners=(4, 5, 12))[0], 0)

    def test_places_are_rounded_as_those_of_the_blocks(self):
        shape = with_triangles(cubes(), [(12, 13, 14)], [(2, 2)], [
            np.array([(1 + 1e-9, .5, .7), (1 + 1e-9, .6, .7), (1 + 1e-9, .6, .8)])])
        self.assertEqual(figures.intersections(shape, JUDGE), (0, 0))
        shape.blocks = {1: (shape.points[:8].astype(np.float32), np.arange(8), cubes().faces_of(1))}
        self.assertEqual(figures.intersections(shape, JUDGE), (1, 0))

    def test_a_triangle_without_area(self):
        self.assertEqual(self.pairs((5, 5, 5), (6, 6, 6), (7, 7, 7), corners=(12, 13, 14)), (0, 1))


class ShapeTest(unittest.TestCase):
    def test_triangles(self):
        shape = figures.Complex(
            [(0, 0, 0), (1, 0, 0), (.5, .75 ** .5, 0), (0, 1, 0), (2, 0, 0)],
            [(0, 1, 2), (0, 1, 3), (0, 1, 4)], [(1, 0)] * 3)
        np.testing.assert_allclose(figures.radius_ratios(shape), (1, 2 * 2 ** .5 - 2, 0), atol=1e-12)
        np.testing.assert_allclose(figures.least_angles(shape), (60, 45, 0), atol=1e-6)

    def test_lines_turn_where_two_meet(self):
        points = np.array([(0, 0, 0), (1, 0, 0), (2, 0, 0), (2, 1, 0), (3, 1, 0), (2, 2, 0)], float)
        lines = np.array([(0, 1), (2, 1), (2, 3), (3, 4), (3, 5)])
        np.testing.assert_allclose(np.sort(figures.line_angles(points, lines)), (0, 90), atol=1e-12)

    def test_voxels(self):
        """Cubes of 4 x 4 x 4 voxels, twice as high as wide, in a surface that is two layers short
        at the end of the second one, and a layer short at the top."""
        values = np.zeros((4, 4, 8), np.int16)
        values[:, :, :4], values[:, :, 4:] = 1, 2
        voxels = figures.LabelVoxels(values, (1, 1, 2))
        shape = cubes()
        shape.points = (shape.points * (4, 4, 3) - .5) * (1, 1, 2)
        shape.points[8:, 0] -= 2
        told = figures.label_figures(shape, voxels, 10)
        self.assertEqual(told["WrongVoxels"], 16 + (64 - 2 * 4 * 3))
        self.assertAlmostEqual(told["VolumeLargest"], 100 * (1 - 24 / 64))
        self.assertAlmostEqual(told["VolumeMedian"], (25 + told["VolumeLargest"]) / 2)
        self.assertEqual((told["WrongEdges"], told["Pinched"], told["LostLabels"]), (0, 0, 0))
        self.assertTrue(np.isnan(figures.label_figures(shape, voxels, 64)["VolumeLargest"]))

    def test_a_label_without_a_surface_is_lost(self):
        shape = cubes()
        shape.points -= .5
        told = figures.label_figures(shape, figures.LabelVoxels([[[1, 2, 7, 7]]]), 10)
        self.assertEqual((told["LostLabels"], told["WrongVoxels"]), (1, 2))

    def test_triangles_at_junctions_are_told_apart(self):
        shape = cubes()
        shape.points[4] = .9, -.5, -.4
        told = figures.figures_of(shape, figures.LabelVoxels([[[1, 2]]]), JUDGE)
        self.assertAlmostEqual(told["AngleInner"], 45)
        self.assertLess(told["AngleLeast"], 44)
        self.assertEqual((told["Vertices"], told["Triangles"], told["Lines"]), (12, 22, 4))
        self.assertTrue(np.isnan(told["WrongBlocks"]))


@unittest.skipUnless(interface_solvers.solvers_here(), "neither TetGen nor gmsh is installed")
class SolverTest(unittest.TestCase):
    def test_cubes_are_filled(self):
        for name, solver in interface_solvers.solvers_here().items():
            with self.subTest(name):
                self.assertEqual(solver(cubes()), "12")

    def test_parts_of_labels_are_volumes(self):
        """Label 1 in two parts, the second one with a cavity, in which label 2 is."""
        one = cubes()
        box = one.faces_of(1)
        places = [one.points + (5, 0, 0), one.points * 5 - 2.1, one.points]
        triangles = np.vstack([box, box + 12, one.faces_of(2) + 24])
        sides = np.repeat([(1, 0), (1, 0), (2, 1)], len(box), axis=0)
        shape = figures.Complex(np.vstack(places), triangles, sides)
        parts, labels = interface_solvers.part_sides(shape)
        self.assertEqual(labels, [1, 1, 2])
        second = parts[len(box), 0]
        np.testing.assert_array_equal(
            parts, np.repeat([(3 - second, 0), (second, 0), (3, second)], len(box), axis=0))

    def test_what_crosses_is_not(self):
        shape = with_triangles(cubes(), [(12, 13, 14)], [(1, 2)],
                               [np.array([(.5, .6, .5), (1.5, .6, .5), (1.5, .7, .6)])])
        for name, solver in interface_solvers.solvers_here().items():
            with self.subTest(name):
                self.assertEqual(solver(shape), "facets intersect")

    def test_what_is_open_is_not(self):
        shape = cubes()
        shape.triangles, shape.sides = shape.triangles[1:], shape.sides[1:]
        for name, solver in interface_solvers.solvers_here().items():
            with self.subTest(name):
                self.assertFalse(solver(shape).isdigit())


class BenchmarkTest(SharedFolderTestCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.done = cls.benchmark("--maps", "small", "--csv", cls.path("small.csv"))
        cls.rows = {row["Run"]: row for row in read_csv(cls.path("small.csv"))}
        cls.targets = {row["what"]: row for row in read_csv(cls.path("small-targets.csv"))}

    @classmethod
    def benchmark(cls, *words):
        return subprocess.run(
            [sys.executable, SCRIPT, "--judge", JUDGE, "--make-volume",
             os.environ["VOLUMIC_MAKE_VOLUME"], *words], capture_output=True, text=True,
            timeout=250, check=False)

    def test_all_runs_have_a_row(self):
        self.assertEqual(self.done.returncode, 0, self.done.stderr)
        self.assertEqual(list(self.rows), list(runs_here()))

    def test_separate_surfaces_overlap_and_are_closed(self):
        row = self.rows["separate"]
        self.assertGreater(number(row, "Intersections"), 1000)
        self.assertEqual(number(row, "WrongEdges") + number(row, "Pinched"), 0)
        self.assertEqual(number(row, "Time"), 1)
        self.assertEqual(row["WrongLines"], "")
        self.assertTrue(0 < number(row, "VolumeMedian") < number(row, "VolumeLargest") < 5)
        self.assertTrue(20 < number(row, "AngleLeast") <= number(row, "AngleInner") < 60)

    def test_graded_interfaces_are_coarser_and_as_sound(self):
        if "graded" not in runs_here():
            self.skipTest("this vtkLabelsToSurfaces has no shared interfaces")
        row = self.rows["graded"]
        self.assertLess(number(row, "Vertices"), .6 * number(self.rows["shared"], "Vertices"))
        for what in ("Intersections", "WrongEdges", "Folded", "Pinched", "WrongLines", "WrongBlocks"):
            self.assertEqual(number(row, what), 0, what)

    def test_a_peer_has_junctions_and_no_lines(self):
        row = self.rows["windowed"]
        self.assertGreater(number(row, "Lines"), 100)
        self.assertEqual(row["WrongLines"], "")
        self.assertTrue(0 < number(row, "Roughness") < 180)

    def test_targets_are_of_the_shared_interfaces(self):
        is_here = "shared" in runs_here()
        solver_of = {"filled by TetGen -pY": "tetgen", "filled by gmsh": "gmsh"}
        for what, row in self.targets.items():
            can_run = is_here and (
                what not in solver_of or solver_of[what] in interface_solvers.solvers_here())
            self.assertEqual(row["verdict"] == "not run", not can_run, row)

    def test_names_that_there_are_not(self):
        for words in (("--maps", "small,moon"), ("--runs", "separate,moon")):
            done = self.benchmark(*words)
            self.assertEqual(done.returncode, 2)
            self.assertIn('"moon"', done.stderr)


if __name__ == "__main__":
    unittest.main()
