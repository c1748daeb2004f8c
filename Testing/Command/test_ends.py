# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Tests of `volumic --ends`."""

import shutil
from collections import Counter

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkFiltersCore import vtkPolyDataConnectivityFilter
from vtkmodules.vtkIOXML import vtkXMLImageDataWriter

from command_test_case import TURNED, CommandTestCase, make_image
from vtk_files import points_of, read, triangles_of


class EndsTest(CommandTestCase):
    """A tube of radius 5 along z through an image with rotated axes and spacing .5, .5, 1."""
    SPACING, ORIGIN = np.array([.5, .5, 1.]), np.array([3., 4., 5.])

    def tube(self, name="tube.vti", level=0):
        z, y, x = np.indices((14, 40, 40))
        far = np.hypot(.5 * (x - 19.5), .5 * (y - 19.5))
        values = (5 - far) if level == 0 else (far < 5).astype("u1")
        return self.write(vtkXMLImageDataWriter(), name,
                          make_image(values.astype("f4" if level == 0 else "u1"), self.SPACING,
                                     self.ORIGIN, TURNED))

    def surface(self, *options, volume=None):
        self.run_command(volume or self.tube(), self.path("a.vtp"), *options)
        surface = read(self.path("a.vtp"))
        return surface, points_of(surface).astype(float), triangles_of(surface)

    def check_open(self, surface, points, triangles, planes):
        """Check that the boundary is a circle in each plane."""
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
        self.assertIsNone(surface.GetFieldData().GetArray("Volume"))

    def test_open(self):
        self.check_open(*self.surface("--iso", "0", "--ends", "open"), (6, 17))
        self.check_open(*self.surface("--iso", "0", "--ends", "open", "--region", "0,40,0,40,0,9"),
                        (6, 13))
        self.check_open(*self.surface("--labels", "1", "--ends", "open",
                                      volume=self.tube("labels.vti", 1)), (4.5, 18.5))

    def test_marked(self):
        surface, points, triangles = self.surface("--iso", "0", "--ends", "marked")
        caps, faces = self.check_caps(surface, points, triangles)
        self.assertEqual(sorted(set(zip(caps.tolist(), faces.tolist()))), [(0, 0), (1, 5), (2, 6)])
        heights = points[triangles, 2]
        a, b, c = (points[triangles[:, i]] for i in range(3))
        areas = np.cross(b - a, c - a)[:, 2] / 2
        for cap, height, out in ((1, 6, -1), (2, 17, 1)):
            self.assertLess(abs(heights[caps == cap] - height).max(), 1e-12)
            self.assertGreater((areas[caps == cap] * out).min(), 0)
            self.assertTrue(0.95 < areas[caps == cap].sum() * out / (np.pi * 25) < 1.02)
        # Caps have interior points at distances of the edge length.
        sides = np.linalg.norm(np.concatenate([b - a, c - b, a - c]), axis=1).reshape(3, -1).max(0)
        self.assertLess(sides[caps > 0].max(), 1.3 * sides[caps == 0].max())

    def check_caps(self, surface, points, triangles):
        """Check that the surface is closed with planar caps; return the caps and their box
        faces."""
        edges = Counter((a, b) for triangle in triangles.tolist()
                        for a, b in zip(triangle, triangle[1:] + triangle[:1]))
        self.assertEqual(set(edges.values()), {1})
        self.assertTrue(all((b, a) in edges for a, b in edges))
        self.assertEqual(len(np.unique(triangles)), len(points))
        caps, faces = (vtk_to_numpy(surface.GetCellData().GetArray(name))
                       for name in ("Cap", "BoxFace"))
        np.testing.assert_array_equal(caps > 0, faces > 0)
        self.assertEqual(set(caps.tolist()), set(range(caps.max() + 1)))
        for side in set(faces.tolist()) - {0}:
            corners = points[triangles[faces == side]]
            across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
            normal = across.sum(0) / np.linalg.norm(across.sum(0))
            self.assertGreater((across @ normal).min(), 0)
            self.assertLess(np.ptp(corners @ normal), 1e-9)
        return caps, faces

    def test_caps_that_meet(self):
        """A ball around a corner of the volume, and objects that leave it on all sides, with
        holes."""
        z, y, x = np.indices((20, 22, 24)).astype("f4")
        for values, sides in ((7 - np.sqrt(x ** 2 + y ** 2 + z ** 2), {0, 1, 3, 5}),
                              (2 - abs(4 - np.hypot(x - 12, y - 11)), {0, 5, 6}),
                              (np.cos(x / 3) * np.sin(y / 3) + np.cos(y / 3) * np.sin(z / 3)
                               + np.cos(z / 3) * np.sin(x / 3), set(range(7)))):
            volume = self.write(vtkXMLImageDataWriter(), "leaving.vti",
                                make_image(values, (1, 1, 1), (0, 0, 0)))
            surface, points, triangles = self.surface("--iso", "0", "--ends", "marked",
                                                      volume=volume)
            _, faces = self.check_caps(surface, points, triangles)
            self.assertEqual(set(faces.tolist()), sides)
            for side in sides - {0}:
                axis, last = divmod(side - 1, 2)
                plane = values.shape[2 - axis] - 2 if last else 1
                coordinates = points[triangles[faces == side]][..., axis]
                self.assertLess(abs(coordinates - plane).max(), 1e-12)

    def sponge(self):
        """Return smooth noise."""
        values = np.random.default_rng(0).standard_normal((30, 30, 30))
        for axis in (0, 1, 2, 0, 1, 2):
            values = (np.roll(values, 1, axis) + values + np.roll(values, -1, axis)) / 3
        return self.write(vtkXMLImageDataWriter(), "sponge.vti",
                          make_image((values / values.std()).astype("f4"), (1, 1, 1), (0, 0, 0)))

    def test_caps_with_many_holes(self):
        """Measurements match the file, and tetrahedra at caps are as good as elsewhere."""
        files = [self.path("a.vtp")] + [self.path("a.vtu")] * bool(shutil.which("tetgen"))
        report = self.report(self.sponge(), *files, "--iso", "0", "--ends", "marked")
        surface = read(self.path("a.vtp"))
        points, triangles = points_of(surface), triangles_of(surface)
        _, faces = self.check_caps(surface, points, triangles)
        self.assertEqual(set(faces.tolist()), set(range(7)))
        self.check_counts(report, surface, points, triangles)
        a, b, c = np.moveaxis(points[triangles], 1, 0)
        self.assertAlmostEqual(report["volume"], (a * np.cross(b, c)).sum() / 6, 6)
        self.assertAlmostEqual(sum(part["volume"] for part in report["component_features"]),
                               report["volume"], 6)
        if len(files) == 2:
            self.assertGreater(report["solid"]["least_angle"], 1.9)  # of TetGen 1.6; 1.5: 6.8

    def check_counts(self, report, surface, points, triangles):
        a, b, c = np.moveaxis(points[triangles], 1, 0)
        connect = vtkPolyDataConnectivityFilter()
        connect.SetInputData(surface)
        connect.SetExtractionModeToAllRegions()
        connect.Update()
        self.assertEqual((report["vertices"], report["triangles"], report["components"]),
                         (len(points), len(triangles), connect.GetNumberOfExtractedRegions()))
        double = np.linalg.norm(np.cross(b - a, c - a), axis=1).sum()
        self.assertAlmostEqual(report["area"], double / 2, 6)
        fields = surface.GetFieldData()
        self.assertEqual(fields.GetArray("NumberOfComponents").GetValue(0), report["components"])
        self.assertEqual(fields.GetArray("Area").GetValue(0), report["area"])

    def test_measurements_of_open_surfaces(self):
        report = self.report(self.sponge(), self.path("a.vtp"), "--iso", "0", "--ends", "open")
        surface = read(self.path("a.vtp"))
        self.check_counts(report, surface, points_of(surface), triangles_of(surface))
        self.assertNotIn("volume", report)

    def test_object_at_the_border_is_kept(self):
        values = 1.2 - np.indices((20, 22, 24))[0].astype("f4")
        volume = self.write(vtkXMLImageDataWriter(), "sheet.vti",
                            make_image(values, (1, 1, 1), (0, 0, 0)))
        whole, _, _ = self.surface("--iso", "0", volume=volume)
        for ends in ("open", "marked"):
            surface, _, _ = self.surface("--iso", "0", "--ends", ends, volume=volume)
            np.testing.assert_array_equal(triangles_of(surface), triangles_of(whole))
