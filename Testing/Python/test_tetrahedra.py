# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Examples/Python/tetrahedra.py: gmsh and TetGen fill what `volumic` writes for them, where they are
installed."""

import os
import re
import shutil
import subprocess
import tempfile
import unittest

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

from examples_path import EXAMPLES
from folder_test_case import SharedFolderTestCase
from sample_volumes import run_script, write_volume
from vtk_files import read

PROGRAM = os.path.join(os.environ["VOLUMIC_TEST_INSTALL_PREFIX"], "bin", "volumic")
VOLUMES = os.path.join(EXAMPLES, "..", "volumes.geo")
LABELS = {1: "Label 1", 2: "Label 2", 4: "Label 4"}


def voxels():
    """[z, y, x] A box of 1 that touches one of 2, in which are one of nothing, and one of 1, about
    which gmsh finds the same surfaces as about 2 unless they are told apart; 4 touches both."""
    found = np.zeros((20, 32, 40), "u1")
    found[2:18, 2:18, 2:14] = 1
    found[2:18, 2:18, 14:38] = 2
    found[7:13, 7:13, 17:23] = 0
    found[7:13, 7:13, 28:34] = 1
    found[4:16, 18:30, 8:30] = 4
    return found


@unittest.skipUnless(os.path.exists(PROGRAM), "the program volumic is not built")
class TetrahedraTest(SharedFolderTestCase):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        volume = write_volume(cls.path("map.mha"), voxels(), (1, 1.25, 0.75))
        subprocess.run([PROGRAM, "--quiet", "--labels", "all", volume, cls.path("a.msh"),
                        cls.path("a.smesh"), cls.path("a.poly"), cls.path("a/"),
                        "--shared-interfaces"], check=True)

    def table(self, run):
        """{label: (tetrahedra, volume, worst, mean, name)}"""
        self.assertEqual((run.returncode, run.stderr), (0, ""))
        rows = re.findall(r"^ *(\d+) +(\d+) +(\S+) +(\S+) +(\S+)  (.*)$", run.stdout, re.M)
        return {int(row[0]): (int(row[1]), *map(float, row[2:5]), row[5]) for row in rows}

    def check(self, model):
        output = self.path("tetrahedra.vtu")
        table = self.table(run_script("tetrahedra.py", self.path(model), "--output", output))
        grid = read(output, vtkXMLUnstructuredGridReader())
        found = vtk_to_numpy(grid.GetCellData().GetArray("Label"))
        self.assertEqual({label: row[4] for label, row in table.items()}, LABELS)
        for label, (count, volume, worst, mean, _) in table.items():
            surface = read(self.path(f"a/label-{label}.vtp"))
            expected = surface.GetFieldData().GetArray("Volume").GetValue(0)
            self.assertAlmostEqual(volume / expected, 1, places=4)
            self.assertEqual((found == label).sum(), count)
            self.assertGreater(count, 100)
            self.assertGreater(worst, 0.02)
            self.assertTrue(0.5 < mean < 1)

    @unittest.skipUnless(shutil.which("gmsh"), "gmsh is not installed")
    def test_gmsh(self):
        self.check("a.msh")

    @unittest.skipUnless(shutil.which("gmsh"), "gmsh is not installed")
    def test_a_volume_without_a_node_of_its_own(self):
        """Its tetrahedra have the corners that its triangles have."""
        volume = write_volume(self.path("small.mha"), np.pad(np.ones((2, 2, 2), "u1"), 2))
        subprocess.run([PROGRAM, "--quiet", "--labels", "all", volume, self.path("small.msh"),
                        "--edge-length", "2"], check=True)
        with tempfile.TemporaryDirectory() as folder:
            model = os.path.join(folder, "model.msh")
            subprocess.run(["gmsh", "-3", self.path("small.msh"), VOLUMES, "-o", model, "-format",
                            "msh41"], check=True, capture_output=True)
            with open(model, encoding="utf-8") as file:
                self.assertRegex(file.read(), r"\n3 1 0 0\n\$EndNodes\n")
        self.assertEqual(list(self.table(run_script("tetrahedra.py", self.path("small.msh")))), [1])

    @unittest.skipUnless(shutil.which("tetgen"), "tetgen is not installed")
    def test_tetgen(self):
        for model in ("a.smesh", "a.poly"):
            self.check(model)

    def test_what_is_missing_is_told(self):
        empty = {**os.environ, "PATH": self.folder}
        for model, tool in (("a.msh", "gmsh"), ("a.smesh", "tetgen")):
            run = run_script("tetrahedra.py", self.path(model), env=empty)
            self.assertEqual((run.returncode, run.stderr), (
                1, f"tetrahedra.py: {tool} is not installed (Debian: apt install {tool})\n"))
        for name, reason in (("a.stl", r"\.msh is for gmsh"), ("b.msh", "there is no such file")):
            run = run_script("tetrahedra.py", self.path(name))
            self.assertEqual(run.returncode, 2)
            self.assertRegex(run.stderr, reason)

    @unittest.skipUnless(shutil.which("tetgen"), "tetgen is not installed")
    def test_what_fails_is_told(self):
        with open(self.path("broken.smesh"), "w", encoding="utf-8") as file:
            file.write("nothing\n")
        run = run_script("tetrahedra.py", self.path("broken.smesh"))
        self.assertEqual(run.returncode, 1)
        self.assertRegex(run.stderr, "^tetrahedra.py: tetgen: ")


if __name__ == "__main__":
    unittest.main()
