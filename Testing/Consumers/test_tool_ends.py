# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""`volumic --ends`: what becomes of a surface where its object leaves the volume."""

import unittest
from collections import Counter

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLImageDataWriter

from tool_test_case import ISO, TURNED, ToolTestCase, make_image
from vtk_files import points_of, read, triangles_of


class EndsTest(ToolTestCase):
    """A tube of radius 5 through the image along z, whose axes are turned, with voxels of .5, .5, 1."""
    SPACING, ORIGIN = np.array([.5, .5, 1.]), np.array([3., 4., 5.])

    def tube(self, name="tube.vti", level=0):
        z, y, x = np.indices((14, 40, 40))
        far = np.hypot(.5 * (x - 19.5), .5 * (y - 19.5))
        values = (5 - far) if level == 0 else (far < 5).astype("u1")
        return self.write(vtkXMLImageDataWriter(), name,
                          make_image(values.astype("f4" if level == 0 else "u1"), self.SPACING,
                                     self.ORIGIN, TURNED))

    def surface(self, *options, volume=None):
        self.run_tool(volume or self.tube(), self.path("a.vtp"), *options)
        surface = read(self.path("a.vtp"))
        return surface, points_of(surface).astype(float), triangles_of(surface)

    def check_open(self, surface, points, triangles, planes):
        """Its border is a circle in each of the planes."""
        edges = Counter()
        for triangle in triangles.tolist():
            for pair in zip(triangle, triangle[1:] + triangle[:1]):
                edges[tuple(sorted(pair))] += 1
        border = [edge for edge, count in edges.items() if count == 1]
        self.assertEqual(set(edges.values()), {1, 2})
        ends = Counter(i for edge in border for i in edge)
        self.assertEqual(set(ends.values()), {2})
        heights = points[list(ends), 2]
        self.assertEqual(set(np.round(heights, 4).tolist()), set(planes))
        radii = np.hypot(*(points[list(ends), :2] - points[list(ends), :2].mean(0)).T)
        self.assertTrue((abs(radii - 5) < 0.4).all())
        self.assertTrue(surface.GetPointData().GetNormals())
        self.assertGreater(surface.GetFieldData().GetArray("Volume").GetValue(0), 0)

    def test_open(self):
        self.check_open(*self.surface("--iso", "0", "--ends", "open"), (6, 17))
        self.check_open(*self.surface("--iso", "0", "--ends", "open", "--region", "0,40,0,40,0,9"),
                        (6, 13))
        self.check_open(*self.surface("--labels", "1", "--ends", "open",
                                      volume=self.tube("labels.vti", 1)), (6, 17))

    def test_marked(self):
        surface, points, triangles = self.surface("--iso", "0", "--ends", "marked")
        whole, _, _ = self.surface("--iso", "0")
        self.assertEqual(surface.GetNumberOfPolys(), whole.GetNumberOfPolys())
        caps = vtk_to_numpy(surface.GetCellData().GetArray("Cap"))
        self.assertEqual(set(caps.tolist()), {0, 1, 2})
        heights = points[triangles, 2]
        a, b, c = (points[triangles[:, i]] for i in range(3))
        areas = np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2
        for cap, beyond in ((1, heights.max(1) < 6), (2, heights.min(1) > 17)):
            self.assertTrue(beyond[caps == cap].all())
            self.assertTrue(0.7 < areas[caps == cap].sum() / (np.pi * 25) < 1.1)

    def test_an_object_within_the_image_has_none(self):
        volume = self.ball_file()
        whole, _, _ = self.surface("--iso", ISO, volume=volume)
        for ends in ("open", "marked"):
            surface, _, _ = self.surface("--iso", ISO, "--ends", ends, volume=volume)
            np.testing.assert_array_equal(points_of(surface), points_of(whole))
            np.testing.assert_array_equal(triangles_of(surface), triangles_of(whole))
        self.assertFalse(vtk_to_numpy(surface.GetCellData().GetArray("Cap")).any())

    def test_what_is_refused(self):
        volume = self.ball_file()
        for reason, name, *options in (
                ("'none' is none of closed, marked, open", "a.vtp", "--ends", "none"),
                ("--ends open and files of solids, which are closed", "a.smesh", "--ends", "open"),
                ("--ends and shared interfaces exclude", "a.vtp", "--ends", "open", "--labels", "all",
                 "--shared-interfaces")):
            self.refused(reason, volume, self.path(name), *options, status=2)


if __name__ == "__main__":
    unittest.main()
