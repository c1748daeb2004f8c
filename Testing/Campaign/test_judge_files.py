# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""JudgeFiles on an icosahedron with edges of 2: what it makes of the deltas in the file.

VOLUMIC_JUDGE_FILES names the program.
"""

import os
import subprocess
import tempfile
import unittest

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkFiltersSources import vtkPlatonicSolidSource
from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter

PROGRAM = os.environ["VOLUMIC_JUDGE_FILES"]


def judged(**arrays):
    """{column: number} of the icosahedron with these arrays, of its points or its field data."""
    source = vtkPlatonicSolidSource()
    source.SetSolidTypeToIcosahedron()
    source.Update()
    solid = source.GetOutput()
    first, second, _ = (np.array(solid.GetPoint(solid.GetCell(0).GetPointId(i))) for i in range(3))
    for p in range(12):
        solid.GetPoints().SetPoint(
            p, 2 / np.linalg.norm(first - second) * np.array(solid.GetPoint(p)))
    for name, values in arrays.items():
        array = numpy_to_vtk(np.array(values, float), deep=True)
        array.SetName(name)
        (solid.GetPointData() if len(values) == 12 else solid.GetFieldData()).AddArray(array)
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "solid.vtp")
        writer = vtkXMLPolyDataWriter()
        writer.SetFileName(path)
        writer.SetInputData(solid)
        writer.Write()
        names, line = (subprocess.run([PROGRAM, word], capture_output=True, text=True,
                                      check=True).stdout.split() for word in ("--help", path))
    return dict(zip(names, map(float, line)))


class JudgeFilesTest(unittest.TestCase):
    def check(self, short, long, **arrays):
        verdict = judged(**arrays)
        self.assertEqual([verdict[name] for name in ("edges", "short", "long")], [30, short, long])

    def test_edges_are_judged_by_one_delta(self):
        self.check(0, 0, Delta=[1.])
        self.check(30, 0, Delta=[2.1])
        self.check(0, 30, Delta=[.7])

    def test_edges_of_a_graded_surface_are_judged_by_the_mean_of_both_ends(self):
        """EdgeSize is what is wanted: 5/8 to 25/16 of it are legal, whatever the least delta."""
        even = [2.] * 11
        self.check(0, 0, Delta=[.1], EdgeSize=even + [2.])
        self.check(0, 5, Delta=[.1], EdgeSize=even + [.5])
        self.check(5, 0, Delta=[.1], EdgeSize=even + [4.5])

    def test_shapes_are_told_of_any_surface_and_lengths_where_there_is_a_delta(self):
        verdict = judged()
        self.assertAlmostEqual(verdict["ratio"], 1., 5)
        self.assertAlmostEqual(verdict["ratiomin"], 1., 5)
        self.assertTrue(np.isnan(verdict["long"]))
        self.assertEqual(verdict["intersections"], 0)


if __name__ == "__main__":
    unittest.main()
