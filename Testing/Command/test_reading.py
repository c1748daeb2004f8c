# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""volumic.read() of NIfTI, MGH, MINC, NRRD, MetaImage, NumPy, InVesalius and files of VTK: voxels
and positions are those of the file, and damaged files are refused in one line."""

import base64
import bz2
import contextlib
import gzip
import io
import itertools
import os
import plistlib
import signal
import struct
import subprocess
import sys
import tarfile
import time
import unittest
import zlib

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonCore import vtkStringArray
from vtkmodules.vtkCommonDataModel import vtkRectilinearGrid
from vtkmodules.vtkIOLegacy import vtkStructuredPointsWriter
from vtkmodules.vtkIOXML import vtkXMLImageDataWriter, vtkXMLRectilinearGridWriter

from command_test_case import META, ORIGIN, SIZE, SPACING, TURNED, ball, make_image, nrrd_header
from reading_test_case import ReadingTestCase
from volumic import reading
from volumic.errors import Failure
from volumic.reading.tables import read_label_names

import medical_files


def noisy_ball(dtype="i2"):
    """Noise does not pack well: damage in packed voxels is seldom damage of the packing."""
    noise = np.random.default_rng(5).integers(0, 4, ball().shape)
    return (ball() + noise).astype(dtype)


def packed_meta(data):
    return META.replace(b"CompressedData = False", b"CompressedData = True") + zlib.compress(data)


class MetaImageTest(ReadingTestCase):
    def test_positions_and_types(self):
        header = META.replace(b"1 0 0 0 1 0 0 0 1", b"0 1 0 -1 0 0 0 0 1")
        volume = self.check(self.read("a.mha", header + ball().tobytes()), direction=TURNED)
        self.assertEqual((volume.space, volume.unit), ("LPS", ""))
        self.assertIsInstance(volume.array, np.memmap)
        long = header.replace(b"MET_SHORT", b"MET_LONG")  # of four bytes, whatever C has
        self.check(self.read("b.mha", long + ball("i4").tobytes()), ball("i4"), TURNED)
        self.check(self.read("c.mha", packed_meta(ball().tobytes())))
        longer = META.replace(b"1 0 0 0 1 0 0 0 1", b"2 0 0 0 2 0 0 0 2")
        longer = longer.replace(b"0.5 0.75 1.0", b"0.25 0.375 0.5")
        self.check(self.read("d.mha", longer + ball().tobytes()))
        flat = META.replace(b"NDims = 3", b"NDims = 2").replace(b"26 22 18", b"26 22").replace(
            b"1 0 0 0 1 0 0 0 1", b"1 0 0 1").replace(b"0.5 0.75 1.0", b"0.5 0.75").replace(
                b" 9.5", b"")
        self.assertEqual(self.read("e.mha", flat + ball()[8].tobytes()).array.shape, (1, 22, 26))

    def test_files_of_slices(self):
        for k, plane in enumerate(noisy_ball()):
            self.write_bytes(f"{k + 1}.raw", plane.tobytes())
        names = "".join(f"{k + 1}.raw\n" for k in range(SIZE[2])).encode()
        listed = META.replace(b"LOCAL", b"LIST") + names
        for content in (listed, META.replace(b"LOCAL", b"%d.raw 1 18 1"),
                        META.replace(b"LOCAL", b"%d.raw")):
            self.check(self.read("a.mhd", content), noisy_ball())
            self.assertEqual(len(reading.list_files(self.path("a.mhd"))), 19)
        self.refused("a.mhd", "lists 17 files for 18 slices", listed[:-8])
        self.write_bytes("7.raw", b"half")
        self.refused("a.mhd", "7.raw: the file is cut off", listed)
        os.remove(self.path("7.raw"))
        self.refused("a.mhd", "No such file.*7.raw", listed)
        for words in ("%s.raw 1 18 1", "%d%d.raw 1 18 1", "%d.raw 1 5 1", "%d.raw 18 1 -1", "%",
                      "%09999999999d.raw 1 18 1", "%d" + "a" * 60000):
            self.refused("b.mhd", "gives no 18 files|name too long", META.replace(b"LOCAL", words.encode()))

    def test_damage(self):
        content = META + noisy_ball().tobytes()
        self.cut("a.mha", content, rests=(0.5, -10, -1))
        self.refused("a.mha", "too long: it has 20595 bytes", content + b"123")
        packed = packed_meta(noisy_ball().tobytes())
        self.cut("b.mha", packed, "packed data are|cut off", rests=(0.5, -10, -1))
        self.flipped("b.mha", packed, packed.index(b"LOCAL") + 10)
        self.refused_with("a.mha", content, (
            (b"NDims = 3", b"NDims = 2", "NDims is 2"), (b"SHORT", b"SHOST", "MET_SHOST"),
            (b"MSB = False", b"MSB = Galse", "is \"galse\""), (b"26 22 18", b"26 22 0 ", "DimSize"),
            (b"26 22 18", b"65536 65536 4294967296", "cut off|damaged"),
            (b"0.5 0.75 1.0", b"0.5 0.75", "does not have 9 numbers"),
            (b"0.5 0.75 1.0", b"0.5 0.75 0", "is not positive"),
            (b"-7.0", b"nan", "the origin nan x 8 x 9.5 is not finite"),
            (b"-7.0", b"1e20", "the origin 1e[+]20 x 8 x 9.5 is too far away"),
            (b"LOCAL", b"", "names no data file")))

    def test_text(self):
        header = META.replace(b"BinaryData = True", b"BinaryData = False")
        text = " ".join(map(str, ball().ravel())).encode()
        self.check(self.read("a.mha", header + text))
        self.cut("a.mha", header + text, "it has [0-9]+ values, its header requires 10296",
                 rests=(0.5,))
        self.refused("a.mha", "damaged", header + b"5 " + text)
        self.refused("a.mha", "no number", header + b"5x " + text[2:])


class NrrdTest(ReadingTestCase):
    def test_encodings(self):
        text = " ".join(map(str, ball().ravel())).encode()
        for encoding, code in (("raw", bytes), ("gzip", gzip.compress), ("bzip2", bz2.compress),
                               ("ascii", lambda _: text)):
            for endian, order in (("little", "<"), ("big", ">")):
                with self.subTest(encoding=encoding, endian=endian):
                    data = code(ball().astype(order + "i2").tobytes())
                    volume = self.read("a.nrrd", nrrd_header(encoding, endian, TURNED) + b"\n" + data)
                    self.check(volume, direction=TURNED)
                    self.assertEqual(volume.space, "LPS")
        data = ball().tobytes()
        content = nrrd_header("gzip") + b"\n" + gzip.compress(data[:99]) + gzip.compress(data[99:])
        self.check(self.read("b.nrrd", content))

    def test_other_files(self):
        self.write_bytes("a.raw", b"a line\n1234" + ball().tobytes())
        header = nrrd_header(direction=TURNED) + b"line skip: 1\nbyte skip: 4\ndata file: a.raw\n"
        self.check(self.read("a.nhdr", header), direction=TURNED)
        self.check(self.read("b.nhdr", nrrd_header() + b"byte skip: -1\ndata file: a.raw\n"))
        self.assertEqual(reading.list_files(self.path("a.nhdr")),
                         [self.path("a.nhdr"), self.path("a.raw")])
        for k, plane in enumerate(ball()):
            self.write_bytes(f"{k:02}.raw", plane.tobytes())
        names = "".join(f"{k:02}.raw\n" for k in range(SIZE[2])).encode()
        self.check(self.read("c.nhdr", nrrd_header() + b"data file: %02d.raw 0 17 1\n"))
        self.check(self.read("c.nhdr", nrrd_header() + b"data file: LIST\n" + names))

    def test_axes(self):
        head = ("NRRD0004\ntype: short\ndimension: 4\nsizes: {0}\nkinds: {1}\nencoding: raw\n"
                "endian: little\nspace: RAS\nspace directions: {2}\n\n")
        vectors = "(2,0,0) (0,3,0) (0,0,4)"
        both = np.stack([ball(), ball() + 1])
        first = np.ascontiguousarray(np.moveaxis(both, 0, -1)).tobytes()
        sizes = "26 22 18"
        content = head.format("2 " + sizes, "list domain domain domain", "none " + vectors).encode()
        volume = self.read("a.nrrd", content + first)
        self.check(volume, both, spacing=(2, 3, 4), origin=(0, 0, 0))
        with self.assertRaisesRegex(reading.VolumeError, "no vector .list.; .* --component N, 0 to 1"):
            volume.scalars()
        self.assertEqual(self.read("a.nrrd", content.replace(b"list", b"vector") + first).components,
                         "vector")
        self.check(self.read("a.nrrd", component=1), both[1], spacing=(2, 3, 4), origin=(0, 0, 0))
        self.refused("a.nrrd", "there is no component 2", component=2)
        content = head.format(sizes + " 2", "domain domain domain list", vectors + " none").encode()
        self.refused("b.nrrd", "2 volumes, .*choose one with --time", content + both.tobytes())
        volume = self.read("b.nrrd", time=1)
        self.check(volume, both[1], spacing=(2, 3, 4), origin=(0, 0, 0))
        self.assertEqual(volume.times, 2)

    def test_leaning_axes(self):
        header = nrrd_header(direction=np.array([[1, 0.5, 0], [0, 1, 0], [0, 0, 1]]))
        volume = self.read("a.nrrd", header + b"\n" + ball().tobytes())
        self.assertIn("26.565 degrees from right angles; resampled from 26 x 22 x 18 to 42 x 22 x 18",
                      volume.resampling)
        self.assertEqual(volume.warnings, [volume.resampling])
        self.refused("a.nrrd", "right angles; without --no-resampling", resampling=False)
        labels = self.read("a.nrrd", labels=True)
        self.assertLessEqual(set(np.unique(labels.array)), set(np.unique(ball())) | {0})

    def test_damage(self):
        data = noisy_ball().tobytes()
        self.cut("a.nrrd", nrrd_header() + b"\n" + data)
        self.refused("a.nrrd", "too long", nrrd_header() + b"\n1" + data)
        for encoding, pack, start in (("gzip", gzip.compress, 11), ("bzip2", bz2.compress, 1)):
            header = nrrd_header(encoding)
            content = header + b"\n" + pack(data)
            self.cut("b.nrrd", content)
            self.flipped("b.nrrd", content, len(header) + start)
            self.refused("b.nrrd", "more than the 20592 bytes", header + b"\n" + pack(data + b"more"))
        self.refused_with("a.nrrd", nrrd_header() + b"\n" + data, (
            (b"endian: little", b"endian: lattle", "lattle"), (b"sizes: 26", b"sizes: 0", "sizes"),
            (b"endian:", b"endiao:", "\"endiao\" is no field of NRRD"), (b"NRRD", b"NRRT", "begin"),
            (b"dimension: 3", b"dimension: 4", "dimension 4"), (b"short", b"shirt", "shirt"),
            (b"(0.5", b"(nan", "is not positive"), (b"(0.5,0", b"(0.5 0", "directions|convert")))


class NiftiTest(ReadingTestCase):
    matrix = np.column_stack([TURNED * SPACING, ORIGIN])

    def test_forms_and_scale(self):
        volume = self.read("a.nii", medical_files.nifti(ball(), SPACING, self.matrix))
        self.check(volume, direction=TURNED)
        self.assertEqual((volume.space, volume.unit, volume.times), ("RAS", "", 1))
        self.assertRegex(volume.warnings[0], "sform, which is used, and its qform differ")
        content = medical_files.nifti(ball(), SPACING, offset=ORIGIN, slope=0.5, intercept=-100)
        scaled = (ball() * np.float32(0.5) - 100).astype("f4")
        self.check(self.read("b.nii.gz", gzip.compress(content)), scaled)
        self.check(self.read("b.nii.bz2", bz2.compress(content)), scaled)
        flat = np.array(self.matrix)
        flat[:, 0] = flat[:, 1]
        volume = self.read("c.nii", medical_files.nifti(ball(), SPACING, flat, offset=ORIGIN))
        self.check(volume)
        self.assertIn("parallel or zero", volume.warnings[0])

    def test_times(self):
        both = np.stack([ball(), ball() + 1])
        content = medical_files.nifti(both, SPACING, self.matrix)
        for name, packed in (("a.nii", content), ("a.nii.gz", gzip.compress(content))):
            self.refused(name, "2 volumes, one behind the other", packed)
            self.check(self.read(name, time=1), both[1], TURNED)
            self.refused(name, "there is no time 2 .--time., but 0 to 1", time=2)

    def test_masks_of_one_file(self):
        masks = np.stack([ball() > 500, ball() < 0, ball() > 700]).astype("i2")
        volume = self.read("a.nii", medical_files.nifti(masks, SPACING, self.matrix), labels=True)
        np.testing.assert_array_equal(volume.array, np.where(masks[2], 3, masks[0]))
        self.assertRegex(" ".join(volume.warnings), "in two masks.*without a voxel: volume 1")

    def test_masks_of_a_folder(self):
        os.mkdir(self.path("a"))
        organ, part = ball() > 300, ball() > 700
        for name, mask in (("organ", organ), ("part", part), ("none", part * 0)):
            self.write_bytes(f"a/{name}.nii", medical_files.nifti(mask.astype("i2"), SPACING))
        volume = self.read("a", labels=True)
        np.testing.assert_array_equal(volume.array, np.where(part, 3, organ * 2))
        self.assertEqual(volume.names, {1: "none", 2: "organ", 3: "part"})
        self.assertRegex(" ".join(volume.warnings), f"{part.sum()} times a voxel is in two masks "
                         ".organ and part.*masks without a voxel: none")
        volume = self.read("a", labels=True, layers=True)
        np.testing.assert_array_equal(volume.array, [organ * 2, part * 3])
        self.assertEqual([(label.value, label.layer) for label in volume.labels],
                         [(1, 0), (2, 0), (3, 1)])
        self.write_bytes("a/other.nii", medical_files.nifti(organ[1:].astype("i2"), SPACING))
        self.refused("a", "other.nii: its voxels are not those of none.nii", labels=True)
        self.write_bytes("a/other.nii", medical_files.nifti(ball(), SPACING))
        self.refused("a", "other.nii: has the values .* a mask has 0 and one other", labels=True)

    def test_damage(self):
        content = medical_files.nifti(noisy_ball(), SPACING)
        self.cut("a.nii", content)
        self.refused("a.nii", "too long", content + b"1")
        packed = gzip.compress(content)
        self.cut("a.nii.gz", packed)
        self.flipped("a.nii.gz", packed, 400)
        self.refused_with("b.nii", content, (
            (70, struct.pack("<h", 999), "999"), (70, struct.pack("<h", 0), "cannot be read|not supp"),
            (40, struct.pack("<h", 9), "."), (46, struct.pack("<h", 0), "sizes 26 x 22 x 0"),
            (44, struct.pack("<h", -1), "."), (108, struct.pack("<f", float("nan")), "."),
            (344, b"no", "."), (40, struct.pack("<h", 2), "too long"),
            (108, struct.pack("<f", 1e8), "cut off"),
            (268, struct.pack("<f", float("nan")), "origin nan x 0 x 0 is not finite"),
            (268, struct.pack("<f", 1e20), "origin .* too far away for a spacing of 0.5")))


class OtherFormatsTest(ReadingTestCase):
    def test_mgh(self):
        head = struct.pack(">7ih3f", 1, *SIZE, 1, 4, 0, 1, *SPACING)
        head += struct.pack(">12f", *TURNED.T.ravel(), *ORIGIN + TURNED @ (SPACING * SIZE / 2))
        content = head.ljust(284, b"\0") + ball(">i2").tobytes()
        for name, packed in (("a.mgh", content), ("a.mgz", gzip.compress(content))):
            volume = self.check(self.read(name, packed), direction=TURNED)
            self.assertEqual((volume.space, volume.unit), ("RAS", "mm"))
            self.cut(name, packed)
        self.read("b.mgh", content + b"what FreeSurfer writes behind the voxels")

    def test_minc(self):
        from scipy.io import netcdf_file
        with netcdf_file(self.path("a.mnc"), "w") as file:
            names = ("zspace", "yspace", "xspace")
            for axis, name in enumerate(names):
                file.createDimension(name, int(SIZE[2 - axis]))
                one = file.createVariable(name, "d", ())
                one.step, one.start = float(SPACING[2 - axis]), float(ORIGIN[2 - axis])
                one.spacing, one.direction_cosines = b"regular__", np.eye(3)[2 - axis].tolist()
            image = file.createVariable("image", "h", names)
            image[:] = ball()
            image.signtype, image.valid_range = b"signed__", [-32768., 32767.]
            for name, value in (("image-min", -32768.), ("image-max", 32767.)):
                file.createVariable(name, "d", ()).assignValue(value)
        self.check(self.read("a.mnc"), ball("f4"))
        self.cut("a.mnc", self.content("a.mnc"), ".", rests=(0.5, 90))
        self.refused("b.mnc", "crashed|cannot be read", b"\x89HDF\r\n\x1a\n" + bytes(range(256)) * 9)

    def test_numpy(self):
        voxels = ball("f4")
        for name, array in (("a", voxels), ("b", np.asfortranarray(voxels.T)), ("c", voxels[None])):
            np.save(self.path(name + ".npy"), array)
            self.check(self.read(name + ".npy"), voxels, spacing=(1, 1, 1), origin=(0, 0, 0))
        np.savez(self.path("d.npz"), x=voxels, y=voxels + 1)
        self.refused("d.npz", "its arrays are x, y; choose one with --array")
        self.check(self.read("d.npz", array="y"), voxels + 1, spacing=(1, 1, 1), origin=(0, 0, 0))
        self.cut("a.npy", self.content("a.npy"), ".")
        np.save(self.path("e.npy"), np.array([None]), allow_pickle=True)
        self.refused("e.npy", "cannot be read")
        np.save(self.path("f.npy"), voxels[0])
        self.refused("f.npy", "its shape is .22, 26.; a volume has three axes")

    def test_raw(self):
        for words, dtype in (("int16", "<i2"), ("float32,big", ">f4"), ("uint16,little", "<u2")):
            self.check(self.read("a.raw", ball(dtype).tobytes(), raw="26,22,18," + words),
                       ball(dtype.replace(">", "=")), spacing=(1, 1, 1), origin=(0, 0, 0))
        self.refused("a.raw", "cut off", bytes(9), raw="26,22,18,int16")
        for words in ("26,22,int16", "26,22,0,int16", "26,22,18,int", "26,22,18,int16,middle"):
            self.refused("a.raw", "is not three sizes", raw=words)

    def test_invesalius(self):
        for dtype in ("int16", "uint8", "float32"):
            voxels = ball(dtype, 0.2 if dtype == "uint8" else 1)
            volume = self.read("a.inv3", medical_files.inv3(voxels, SPACING, dtype=dtype))
            self.check(volume, voxels, origin=(0, 0, 0))
            self.assertEqual((volume.space, volume.unit), ("LAS", "mm"))
        content = medical_files.inv3(noisy_ball(), SPACING)
        self.cut("a.inv3", content, "cut off|damaged|cannot be read")
        self.flipped("a.inv3", content, 100)
        voxels = ("matrix.dat", noisy_ball().tobytes())

        def plist(**changes):
            project = {"matrix": {"dtype": "int16", "shape": list(noisy_ball().shape)},
                       "spacing": SPACING.tolist(), **changes}
            return "main.plist", plistlib.dumps(project)

        shape = list(noisy_ball().shape)
        for files, reason in (
                ([voxels], "no main.plist in it"), ([plist()], "no matrix.dat in it"),
                ([voxels, ("main.plist", b"<plist><dict>")], "damaged"),
                ([voxels, ("main.plist", b"<plist>" + b"<array>" * 140000)], "damaged"),
                ([voxels, ("main.plist", bytes(2 << 20))], "too large"),
                ([voxels, plist(spacing=[1.0, 1.0])], "not those of a volume"),
                ([voxels, plist(spacing=[1.0, 1.0, -1.0])], "1 x 1 x -1"),
                ([voxels, plist(spacing=["a", "b", "c"])], "damaged"),
                ([voxels, plist(matrix={"dtype": "object", "shape": shape})], "\"object\""),
                ([voxels, plist(matrix={"dtype": "int16", "shape": [0, 4, 4]})], "0 x 4 x 4"),
                ([voxels, plist(matrix={"dtype": "int16", "shape": [1 << 30] * 3})], "cut off"),
                ([voxels, plist(matrix={"dtype": "uint8", "shape": shape})], "too long")):
            with self.subTest(reason):
                self.refused("b.inv3", reason, medical_files.archive_of(files))

    def test_unknown_names(self):
        self.check(self.read("a.1", META + ball().tobytes()))
        self.refused("b.nii_old", "let its name end", gzip.compress(medical_files.nifti(
            ball(), SPACING)))
        self.refused("a.xyz", "not a format that is read", b"?")
        self.refused("missing.vti", "no such file or folder")
        os.mkfifo(self.path("a.nii"))
        self.refused("a.nii", "a pipe or a device")


class VtkTest(ReadingTestCase):
    def test_each_encoding_whole_and_damaged(self):
        """Cut off, and with a piece of the data missing or too much."""
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
                self.cut("a.vti", content, rests=(0.2, 0.7, 0.9, -60, -12))
                at = len(content) * 2 // 3
                piece = 200 if mode == 0 else 12  # of a text parts of numbers may be missing
                for rest in (at + piece, at - piece):
                    self.refused("a.vti", "damaged|cut off", content[:at] + content[rest:])

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
        self.refused("a.vti", "no point array none; point arrays: density, vectors, other",
                     array="none")
        image.GetPointData().SetActiveScalars(None)
        self.write(vtkXMLImageDataWriter(), "a.vti", image)
        self.refused("a.vti", "no active scalars; point arrays: density, vectors, other")
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
        content = self.content(pieces[1])
        self.write_bytes(pieces[1], content[:-99])
        self.refused("a.pvti", "cut off")
        self.write_bytes(pieces[1], self.content(pieces[2]))
        self.refused("a.pvti", "do not cover the whole image")
        os.remove(pieces[1])
        self.refused("a.pvti", "No such file")

    def test_legacy(self):
        for binary in (True, False):
            writer = vtkStructuredPointsWriter()
            writer.SetFileType(2 if binary else 1)
            content = self.bytes_of(writer, "a.vtk", make_image(noisy_ball()))
            self.check(self.read("a.vtk"), noisy_ball())
            self.cut("a.vtk", content, "VTK cannot read it", rests=(0.5, -10))
        self.refused("b.vtk", "holds PolyData, and no image", b"# vtk DataFile Version 3.0\na\nASCII\n"
                     b"DATASET POLYDATA\nPOINTS 1 float\n0 0 0\n")

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
        self.refused("a.vtr", "uneven distances, and no image; resample it")

    def test_headers_that_require_too_much(self):
        head = (b'<VTKFile type="ImageData" version="1.0" byte_order="LittleEndian" header_type='
                b'"UInt32" compressor="vtkZLibDataCompressor"><ImageData WholeExtent="0 1 0 1 0 1" '
                b'Origin="0 0 0" Spacing="1 1 1"><Piece Extent="0 1 0 1 0 1"><PointData Scalars="a">'
                b'<DataArray type="UInt8" Name="a" format="%s"%s</PointData></Piece></ImageData>')
        for blocks, size, last in ((0xFFFFFFF0, 8, 0), (1 << 30, 8, 0), (1, 0, 0), (0, 0, 5),
                                   (0, 8, 5), (1, 8, 9)):
            words = struct.pack("<4I", blocks, size, last, 16) + bytes(20)
            self.refused("a.vti", f"packed in {blocks} blocks of {size} bytes, the last one of {last}",
                         head % (b"binary", b">" + base64.b64encode(words) + b"</DataArray>")
                         + b"</VTKFile>")
            self.refused("a.vti", "damaged|cut off", head % (b"appended", b' offset="0"/>') +
                         b'<AppendedData encoding="raw">_' + words + b"</AppendedData></VTKFile>")
        self.refused("a.vti", "too many elements within elements",
                     b'<VTKFile type="ImageData">' + b"<a>" * 140000)
        self.refused("a.pvti", "File name too long", b'<VTKFile type="PImageData"><PImageData '
                     b'WholeExtent="0 1 0 1 0 1"><Piece Extent="0 1 0 1 0 1" Source="' + b"a" * 900000
                     + b'"/></PImageData></VTKFile>')


class HostileTest(ReadingTestCase):
    """Small files whose headers require much, or that unpack to much."""

    def setUp(self):
        super().setUp()
        self.little_memory()

    def test_nrrd(self):
        head = "NRRD0004\ntype: short\ndimension: 3\nsizes: {}\nencoding: {}\nendian: little\n{}\n"
        for sizes in ("4096 4096 4096", "2147483647 2147483647 2147483647", "4194304 4194304 1048576"):
            for encoding in ("raw", "gzip", "bzip2", "text"):
                self.refused("a.nrrd", "cut off|not enough memory|damaged|requires",
                             head.format(sizes, encoding, "").encode() + bytes(3000))
        bomb = gzip.compress(bytes(100 << 20), 9)
        packed = head.format("8 8 8", "gzip", "").encode()
        self.refused("a.nrrd", "more than the 1024 bytes", packed + bomb)
        self.read("a.nrrd", packed.replace(b"\n\n", b"\nbyte skip: 104856576\n\n") + bomb)
        self.refused("a.nrrd", "too long", head.format("8 8 8", "raw", "line skip: 2147483647\n")
                     .encode() + b"\n" * (6 << 20))
        twice = bz2.compress(bz2.compress(bz2.compress(b"") * 200000) * 20000)
        self.refused("a.nrrd", "more than the 1024 bytes",
                     head.format("8 8 8", "bzip2", "").encode() + twice)

    def test_nifti_and_meta_image(self):
        head = bytearray(medical_files.nifti(np.zeros((8, 8, 8), "i2"), SPACING))
        bomb = gzip.compress(bytes(100 << 20), 9)
        self.refused("a.nii.gz", "more than the 1376 bytes", gzip.compress(head) + bomb)
        for mark in (b"<Label ", b'<Label Key="1">', b'<Label Key="1">&lt;', b"<![CDATA["):
            text = (mark * (4 << 20))[:(4 << 20) - 16]
            content = bytearray(head[:352])
            struct.pack_into("<f", content, 108, 352 + (4 << 20))
            content[348] = 1
            content += struct.pack("<ii", 4 << 20, 0) + text.ljust((4 << 20) - 8, b"\0") + head[352:]
            self.read("a.nii", content)
        packed = packed_meta(bytes(100 << 20))
        self.refused("a.mha", "more than the 20592 bytes", packed)
        self.refused("a.mha", ".", packed.replace(b"26 22 18", b"65536 65536 4294967296"))

    def test_archives(self):
        def archive(member, data):
            content = io.BytesIO()
            plist = plistlib.dumps({"matrix": {"dtype": "int16", "shape": [4096, 4096, 2048]},
                                    "spacing": SPACING.tolist()})
            with tarfile.open(fileobj=content, mode="w", format=tarfile.PAX_FORMAT) as file:
                head = tarfile.TarInfo("main.plist")
                head.size = len(plist)
                file.addfile(head, io.BytesIO(plist))
                content.write(member.tobuf(tarfile.PAX_FORMAT) + data)
            return content.getvalue()

        large = tarfile.TarInfo("matrix.dat")
        large.size = 2 * 4096 * 4096 * 2048
        self.refused("a.inv3", "cut off|not enough memory|cannot be read", archive(large, b""))
        holes = tarfile.TarInfo("matrix.dat")
        holes.size = 1024
        holes.pax_headers = {"GNU.sparse.major": "1", "GNU.sparse.minor": "0",
                             "GNU.sparse.name": "matrix.dat", "GNU.sparse.realsize": str(large.size)}
        self.refused("a.inv3", "no matrix.dat|cut off", archive(
            holes, b"1\n0\n512\n".ljust(1024, b"\0")))


    def test_tables_of_names(self):
        most = 4 << 20
        for content in (b"\r\n" * (most // 2), b"1 " + b"a" * most, b"a,b\n" + b" " * most,
                        b'1,"' + b" " * most + b'"\n', b"1 a\r\n" * (most // 5),
                        b"\n".join(b"%d a" % k for k in range(most // 10)), b"[" * most,
                        b'{"a":' * (most // 5), b"[1," * (most // 10),
                        b"{" + b",".join(b'"%d":1' % k for k in range(300000)) + b"}"):
            used, name = time.process_time(), self.write_bytes("names.txt", content)
            with self.subTest(content[:10]), contextlib.suppress(Failure):
                read_label_names(name)
            self.assertLess(time.process_time() - used, 20)


class RandomDamageTest(ReadingTestCase):
    def test_files_are_read_or_refused(self):
        image = make_image(noisy_ball())
        contents = {
            "a.mha": META + noisy_ball().tobytes(), "b.mha": packed_meta(noisy_ball().tobytes()),
            "a.nrrd": nrrd_header("gzip") + b"\n" + gzip.compress(noisy_ball().tobytes()),
            "b.nrrd": nrrd_header() + b"\n" + noisy_ball().tobytes(),
            "a.nii": medical_files.nifti(noisy_ball(), SPACING, NiftiTest.matrix),
            "a.vti": self.bytes_of(vtkXMLImageDataWriter(), "a.vti", image),
            "a.inv3": medical_files.inv3(noisy_ball(), SPACING)}
        generator = np.random.default_rng(7)
        for name, content in contents.items():
            for number in range(40):
                damaged = bytearray(content)
                places = generator.integers(0, len(content) if number % 2 else 600, 4)
                for place in places:
                    damaged[place] = generator.integers(256)
                if number % 3 == 0:
                    del damaged[places[0]:places[0] + 7]
                with self.subTest(name, number=number):
                    try:
                        self.read(name, damaged)
                    except reading.VolumeError as error:
                        self.assertNotIn("\n", str(error))


class WorkerTest(unittest.TestCase):
    def test_what_a_worker_returns(self):
        from volumic.reading.worker import in_worker
        array = in_worker("numpy:arange", 1000000)
        np.testing.assert_array_equal(array, np.arange(1000000))
        self.assertIsNotNone(array.base)  # mapped
        for function, reason in (("os:abort", "crashed: the file is damaged"),
                                 ("nowhere:abort", "install the Python package nowhere"),
                                 ("numpy:reshape", "cannot be read: ")):
            with self.assertRaisesRegex(reading.VolumeError, reason):
                in_worker(function)
        with self.assertRaises(ChildProcessError):
            os.waitpid(-1, os.WNOHANG)  # no zombie

    def test_it_ends_with_its_caller(self):
        code = "from volumic.reading.worker import in_worker; in_worker('time:sleep', 60)"
        for number in (signal.SIGINT, signal.SIGKILL):
            with subprocess.Popen([sys.executable, "-c", code], stderr=subprocess.DEVNULL,
                                  start_new_session=True) as process:
                deadline = time.monotonic() + 60
                while len(self.group(process.pid)) < 2 and time.monotonic() < deadline:
                    time.sleep(0.1)
                (os.killpg if number == signal.SIGINT else os.kill)(process.pid, number)
                process.wait(60)
            while self.group(process.pid) and time.monotonic() < deadline:
                time.sleep(0.1)
            self.assertEqual(self.group(process.pid), [])

    @staticmethod
    def group(number):
        """The running processes of a group."""
        found = []
        for name in filter(str.isdigit, os.listdir("/proc")):
            with contextlib.suppress(OSError), open(f"/proc/{name}/stat", encoding="ascii") as file:
                state, _, group = file.read().rpartition(")")[2].split()[:3]
                found += [name] if int(group) == number and state != "Z" else []
        return found


if __name__ == "__main__":
    unittest.main()
