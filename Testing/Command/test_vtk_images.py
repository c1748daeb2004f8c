# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Tests of volumic.read() for images written by VTK: voxels, positions, damaged files."""

import importlib.util
import itertools
import os
import unittest

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonCore import vtkStringArray
from vtkmodules.vtkCommonDataModel import vtkRectilinearGrid
from vtkmodules.vtkIOLegacy import vtkStructuredPointsWriter
from vtkmodules.vtkIOXML import vtkXMLImageDataWriter, vtkXMLRectilinearGridWriter

from command_test_case import ORIGIN, SIZE, SPACING, TURNED, ball, make_image
from reading_test_case import ReadingTestCase, noisy_ball
from volumic import reading


class VtkTest(ReadingTestCase):
    def test_encodings(self):
        """Complete, and with missing or extra data."""
        image = make_image(noisy_ball(), direction=TURNED)
        for mode, compressor, encodes in itertools.product((0, 1, 2), range(4), (0, 1)):
            writer = vtkXMLImageDataWriter()
            writer.SetDataMode(mode)
            writer.SetCompressorType(compressor)
            writer.SetEncodeAppendedData(encodes)
            content = self.bytes_of(writer, "a.vti", image)
            with self.subTest(mode, compressor=compressor, encodes=encodes):
                volume = self.check(self.read("a.vti"), noisy_ball(), TURNED)
                self.assertEqual(volume.name, "density")
                at = len(content) * 2 // 3
                piece = 200 if mode == 0 else 12  # truncated text may end within a number
                for rest in (at + piece, at - piece):
                    self.rejects("a.vti", "damaged|truncated", content[:at] + content[rest:])

    def test_arrays_extents_and_cells(self):
        image = make_image(ball())
        image.SetExtent(3, 28, -2, 19, 5, 22)
        for name, components in (("vectors", 2), ("other", 1)):
            other = numpy_to_vtk(np.stack([ball("f4").ravel()] * components, -1), deep=True)
            other.SetName(name)
            image.GetPointData().AddArray(other)
        self.write(vtkXMLImageDataWriter(), "a.vti", image)
        volume = self.check(self.read("a.vti"))
        self.assertEqual(volume.start, (3, -2, 5))
        np.testing.assert_allclose(tuple(volume)[2], image.GetPoint(0))  # of the first voxel
        volume = self.read("a.vti", array="vectors")
        self.assertEqual((volume.array.shape, volume.components), ((2, *SIZE[::-1]), "vector"))
        self.rejects("a.vti", "no point array none; .* with --array: density, vectors, other",
                     array="none")
        image.GetPointData().SetActiveScalars(None)
        self.write(vtkXMLImageDataWriter(), "a.vti", image)
        self.rejects("a.vti", "no active scalars; .* --array: density, vectors, other")
        cells = make_image(ball())
        cells.SetDimensions(*SIZE + 1)
        cells.GetCellData().SetScalars(cells.GetPointData().GetScalars())
        cells.GetPointData().Initialize()
        self.write(vtkXMLImageDataWriter(), "b.vti", cells)
        self.check(self.read("b.vti"), origin=ORIGIN + SPACING / 2)

    def test_field_data(self):
        image, texts = make_image(ball()), {"Axes": ["RAS"], "LengthUnit": ["mm"],
                                            "LabelNames": ["liver", "spleen é"]}
        for name, values in texts.items():
            array = vtkStringArray()
            array.SetName(name)
            for text in values:
                array.InsertNextValue(text)
            image.GetFieldData().AddArray(array)
        for name, values in (("LabelValues", [1, 7]), ("LabelColors", [[1, 0, 0], [0, .5, 0]]),
                             ("LabelLayers", [0, 1])):
            array = numpy_to_vtk(np.array(values), deep=True)
            array.SetName(name)
            image.GetFieldData().AddArray(array)
        self.write(vtkXMLImageDataWriter(), "a.vti", image)
        volume = self.read("a.vti")
        self.assertEqual((volume.space, volume.unit), ("RAS", "mm"))
        self.assertEqual(volume.labels, [reading.Label(1, "liver", (1., 0., 0.), 0),
                                         reading.Label(7, "spleen é", (0., .5, 0.), 1)])

    def test_pieces(self):
        pieces = [self.path(f"{k}.vti") for k in range(3)]
        for k, name in enumerate(pieces):
            image = make_image(ball()[6 * k:6 * k + 6], direction=TURNED)
            image.SetExtent(0, 25, 0, 21, 6 * k, 6 * k + 5)
            self.write(vtkXMLImageDataWriter(), name, image)
        head = '<VTKFile type="PImageData"><PImageData WholeExtent="0 25 0 21 0 17" Spacing="{}" ' \
            'Origin="{}">'.format(" ".join(map(str, SPACING)), " ".join(map(str, ORIGIN)))
        self.write_text("a.pvti", head + "".join(
            f'<Piece Extent="0 25 0 21 {6 * k} {6 * k + 5}" Source="{k}.vti"/>' for k in range(3))
            + "</PImageData></VTKFile>")
        self.check(self.read("a.pvti"), direction=TURNED)
        self.assertEqual(reading.list_files(self.path("a.pvti"))[1:], pieces)
        self.write_bytes(pieces[1], self.content(pieces[2]))
        self.rejects("a.pvti", "do not cover the image")
        os.remove(pieces[1])
        self.rejects("a.pvti", "No such file")

    def test_legacy(self):
        for binary in (True, False):
            writer = vtkStructuredPointsWriter()
            writer.SetFileType(2 if binary else 1)
            self.write(writer, "a.vtk", make_image(noisy_ball()))
            self.check(self.read("a.vtk"), noisy_ball())
        self.rejects("b.vtk", "has PolyData, not an image", b"# vtk DataFile Version 3.0\na\nASCII\n"
                     b"DATASET POLYDATA\nPOINTS 1 float\n0 0 0\n")

    @unittest.skipUnless(importlib.util.find_spec("h5py") and importlib.util.find_spec(
        "vtkmodules.vtkIOHDF"), "no h5py (Debian: python3-h5py), or VTK without HDF")
    def test_hdf(self):
        import h5py
        with h5py.File(self.path("a.vtkhdf"), "w") as file:
            root = file.create_group("VTKHDF")
            root.attrs.update(Version=[1, 0], Type=np.bytes_("ImageData"), Origin=ORIGIN,
                              Spacing=SPACING, Direction=np.eye(3).ravel(),
                              WholeExtent=np.ravel([np.zeros(3), SIZE - 1], "F").astype(int))
            root.create_dataset("PointData/density", data=ball())
            root["PointData"].attrs["Scalars"] = np.bytes_("density")
        self.check(self.read("a.vtkhdf"))

    def test_rectilinear_grids(self):
        grid = vtkRectilinearGrid()
        grid.SetDimensions(*SIZE)
        grid.GetPointData().SetScalars(make_image(ball()).GetPointData().GetScalars())
        for step in (1, 1.01):
            for axis in range(3):
                line = ORIGIN[axis] + SPACING[axis] * np.arange(SIZE[axis]) ** step
                array = numpy_to_vtk(line, deep=True)
                getattr(grid, f"Set{'XYZ'[axis]}Coordinates")(array)
            self.write(vtkXMLRectilinearGridWriter(), "a.vtr", grid)
            if step == 1:
                self.check(self.read("a.vtr"))
        self.rejects("a.vtr", "of variable spacing, not an image; convert it")
