# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Examples/Python/segment.py: what it writes, its bar, its errors and exit codes."""

import os
import re
import subprocess
import sys
import unittest

import numpy as np
from vtkmodules.vtkFiltersCore import vtkCleanPolyData, vtkFeatureEdges, vtkMassProperties

from examples_path import EXAMPLES
from folder_test_case import SharedFolderTestCase, interrupted_on_terminal, run_on_terminal
from sample_volumes import (
    RING_ISO, RING_SPACING, RING_VOLUME, ring_voxels, run_script, write_volume)
from vtk_files import points_of, read


def read_surface(path):
    clean = vtkCleanPolyData()  # an STL file has each corner once per triangle
    clean.SetInputData(read(path))
    clean.SetTolerance(0)
    clean.Update()
    return clean.GetOutput()


def open_edges(surface):
    edges = vtkFeatureEdges()
    edges.SetInputData(surface)
    edges.FeatureEdgesOff()
    edges.ManifoldEdgesOff()
    edges.Update()
    return edges.GetOutput().GetNumberOfCells()


def volume_of(surface):
    mass = vtkMassProperties()
    mass.SetInputData(surface)
    return mass.GetVolume()


class SegmentTest(SharedFolderTestCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.ring = write_volume(cls.path("ring.mha"), ring_voxels(), RING_SPACING)

    def segment(self, output, *options, volume=None, status=0):
        run = run_script("segment.py", volume or self.ring, self.path(output), *options)
        self.assertEqual(run.returncode, status, run.stderr)
        return run


class FormatsTest(SegmentTest):
    def check_format(self, suffix):
        name = "surface." + suffix
        run = self.segment(name, "--iso", str(RING_ISO))
        self.assertEqual(run.stderr, "")
        self.assertIn(self.path(name), run.stdout)
        surface = read_surface(self.path(name))
        self.assertEqual(open_edges(surface), 0)
        self.assertAlmostEqual(volume_of(surface) / RING_VOLUME, 1, delta=0.1)
        # Euler's characteristic of a ring: V - E + F, with 3 edges for 2 triangles.
        self.assertEqual(2 * surface.GetNumberOfPoints(), surface.GetNumberOfPolys())
        return run, surface

    def test_formats_of_meshes(self):
        for suffix in ("stl", "ply", "obj"):
            with self.subTest(suffix):
                self.check_format(suffix)

    def test_vtp_holds_all_that_the_filter_tells(self):
        run, surface = self.check_format("vtp")
        self.assertIn("genus 1", run.stdout)
        self.assertIsNotNone(surface.GetPointData().GetArray("Residual"))
        self.assertEqual(surface.GetFieldData().GetArray("Genus").GetValue(0), 1)


class OptionsTest(SegmentTest):
    def test_otsu_where_no_iso_value_is_given(self):
        run = self.segment("a.stl")
        iso = float(re.search(r"iso-value ([\d.]+) by Otsu", run.stdout).group(1))
        self.assertTrue(70 < iso < 180)

    def test_any_property(self):
        self.segment("a.vtp", "--iso", str(RING_ISO), "--set", "FinestLevel=1", "--set",
                     "TensionWeight=0.3", "--set", "SnapToIsoValue=off")
        fields = read_surface(self.path("a.vtp")).GetFieldData()
        self.assertEqual(fields.GetArray("Level").GetValue(0), 1)

    def test_the_limit_of_the_iterations_is_told(self):
        run = self.segment("a.stl", "--iso", str(RING_ISO), "--set", "MaximumNumberOfIterations=3",
                           status=3)
        self.assertIn("iteration limit", run.stdout)
        self.assertEqual(open_edges(read_surface(self.path("a.stl"))), 0)


class RefusedTest(SegmentTest):
    def refused(self, reason, *arguments, code=1):
        run = run_script("segment.py", *arguments)
        self.assertEqual(run.returncode, code, run.stderr)
        self.assertRegex(run.stderr, reason)
        self.assertNotIn("Traceback", run.stderr)

    def test_what_is_refused(self):
        os.mkdir(self.path("folder.stl"))
        none, output = self.path("none.mha"), self.path("a.stl")
        for reason, *arguments in (
                ("no such file", none, output),
                # These are told before the volume is read.
                (r"\.stl, \.ply", none, self.path("a.dwg")),
                ("no such folder", none, self.path("none/a.stl")),
                ("cannot be written", self.ring, self.path("folder.stl")),
                ("no property Isovalue; it has .*IsoValue", self.ring, output, "--set",
                 "Isovalue=3"),
                ("a whole number, not '0.5'", self.ring, output, "--set", "FinestLevel=0.5"),
                ("on or off, not 'maybe'", self.ring, output, "--set", "SnapToIsoValue=maybe"),
                ("NAME=VALUE", self.ring, output, "--set", "FinestLevel"),
                ("1e\\+?06|1000000", self.ring, output, "--iso", "1e6")):
            with self.subTest(reason):
                self.refused(reason, *arguments)
        self.assertFalse(os.path.exists(output))
        self.refused("usage", self.ring, code=2)

    def test_package_that_is_not_there(self):
        environment = {k: v for k, v in os.environ.items() if k != "PYTHONPATH"}
        code = ("import sys; sys.modules['volumic'] = None; sys.argv = ['segment.py', 'a.mha',"
                f" 'a.stl']; sys.path.insert(0, {EXAMPLES!r}); import segment;"
                " sys.exit(segment.main())")
        run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True,
                             check=False, env=environment)
        self.assertEqual(run.returncode, 1)
        self.assertRegex(run.stderr, "volumic.*PYTHONPATH")
        self.assertNotIn("Traceback", run.stderr)


class TerminalTest(SegmentTest):
    def command(self, volume, output):
        return [sys.executable, os.path.join(EXAMPLES, "segment.py"), volume, self.path(output),
                "--iso", str(RING_ISO)]

    def test_a_bar_grows_and_is_replaced_by_the_time(self):
        shown, code = run_on_terminal(self.command(self.ring, "a.stl"))
        self.assertEqual(code, 0, shown)
        self.assertRegex(shown, r"\rEvolving the surface \[#*\.*\] +\d+ % .*")
        self.assertRegex(shown, r"\rEvolving the surface: \d+\.\d\d s")

    def test_control_c_hands_over_a_closed_surface(self):
        large = write_volume(self.path("l.mha"), np.kron(ring_voxels(), np.ones((4, 4, 4), "u1")))
        shown, code = interrupted_on_terminal(self.command(large, "b.vtp"), r"Level \d, iteration")
        self.assertEqual(code, 3, shown)
        self.assertIn("interrupted", shown)
        self.assertIn("(not finished)", shown)
        surface = read_surface(self.path("b.vtp"))
        reason = surface.GetFieldData().GetAbstractArray("StopReason").GetValue(0)
        self.assertEqual(reason, "cancelled")
        self.assertGreater(surface.GetNumberOfPolys(), 0)
        self.assertEqual(open_edges(surface), 0)
        self.assertTrue(np.isfinite(points_of(surface)).all())


if __name__ == "__main__":
    unittest.main()
