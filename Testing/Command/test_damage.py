# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""`volumic` refuses a volume that has been cut off or damaged, and names the file."""

import bz2
import gzip
import importlib.util
import itertools
import os
import plistlib
import resource
import struct
import unittest

import numpy as np
from vtkmodules.vtkIOImage import (
    vtkBMPWriter, vtkJPEGWriter, vtkMetaImageWriter, vtkPNGWriter, vtkPNMWriter, vtkTIFFWriter)
from vtkmodules.vtkIOLegacy import vtkStructuredPointsWriter
from vtkmodules.vtkIOXML import (
    vtkXMLImageDataWriter, vtkXMLPolyDataReader, vtkXMLPolyDataWriter)

from command_test_case import (
    ISO, META, SIZE, SPACING, CommandTestCase, ball, dicom_slice, make_image, nrrd_header)

import medical_files


def noisy_ball(dtype="i2"):
    """Noise does not pack well: damage in packed voxels is seldom damage of the packing."""
    noise = np.random.default_rng(5).integers(0, 4, ball().shape)
    return (ball() + noise).astype(dtype)


class DamageTest(CommandTestCase):
    def bytes_of(self, writer, name, image=None):
        """What the writer writes of the image, of a ball if there is none."""
        return super().bytes_of(writer, name, image or make_image(noisy_ball()))

    def cut(self, name, content, reason, rests=(0.5, -10)):
        """The whole file is taken, but not this share, or all but so many bytes."""
        self.accepted_bytes(name, content)
        for rest in rests:
            with self.subTest(name, rest=rest):
                count = int(len(content) * rest) if 0 < rest < 1 else rest
                self.refused_bytes(name, content[:count], reason)

    def flipped(self, name, content, reason, start):
        """With one bit of the data turned over it is refused, wherever that is."""
        generator = np.random.default_rng(6)
        for _ in range(8):
            damaged = bytearray(content)
            place = int(generator.integers(start, len(content)))
            damaged[place] ^= 1 << int(generator.integers(8))
            with self.subTest(name, place=place):
                self.refused_bytes(name, bytes(damaged), reason)


class FilesTest(DamageTest):
    def test_raw_meta_image(self):
        writer = vtkMetaImageWriter()
        writer.SetCompression(False)
        content = self.bytes_of(writer, "a.mha")
        self.cut("a.mha", content, "cut off: it has [0-9]+ bytes of voxels, its header asks for")
        self.cut("b.mha", content.replace(b"ElementSpacing", b"HeaderSize = -1\nElementSpacing"),
                 "cut off", rests=(0.5,))

    def test_packed_meta_image(self):
        content = self.bytes_of(vtkMetaImageWriter(), "a.mha")
        self.assertIn(b"CompressedData = True", content)
        self.cut("a.mha", content, "packed data are cut off", rests=(0.5, -10, -1))
        self.flipped("a.mha", content, "packed data", content.index(b"LOCAL") + 10)

    def test_meta_image_in_two_files(self):
        data = noisy_ball().tobytes()
        self.write_bytes("a.raw", data)
        self.accepted_bytes("a.mhd", META.replace(b"LOCAL", b"a.raw"))
        self.write_bytes("a.raw", data[:-10])
        self.refused_volume("a.mhd", "cut off")
        os.remove(self.path("a.raw"))
        self.refused_volume("a.mhd", "a.raw cannot be opened")

    def test_meta_image_in_a_file_for_each_slice(self):
        for k, plane in enumerate(noisy_ball()):
            self.write_bytes(f"{k + 1}.raw", plane.tobytes())
        names = "".join(f"{k + 1}.raw\n" for k in range(SIZE[2])).encode()
        listed = META.replace(b"LOCAL", b"LIST") + names
        self.refused_bytes("a.mhd", listed[:-8], "lists 17 files for 18 slices")
        self.accepted_bytes("a.mhd", listed)
        self.accepted_bytes("b.mhd", META.replace(b"LOCAL", f"%d.raw 1 {SIZE[2]} 1".encode()))
        self.write_bytes("7.raw", b"half")
        for name in ("a.mhd", "b.mhd"):
            self.refused_volume(name, "7.raw is cut off: it has 4 bytes, 1144 are needed")
        os.remove(self.path("7.raw"))
        for name in ("a.mhd", "b.mhd"):
            self.refused_volume(name, "7.raw cannot be opened")

    def test_meta_image_as_text(self):
        text = " ".join(map(str, ball().ravel())).encode()
        header = META.replace(b"BinaryData = True", b"BinaryData = False")
        self.cut("a.mha", header + text + b"\n", "it has [0-9]+ values, its header asks for 10296")
        self.refused_bytes("b.mha", header + b"0" * 600 + text, "its value 1 is no number")
        for k, plane in enumerate(ball()):
            self.write_bytes(f"{k}.txt", " ".join(map(str, plane.ravel())).encode())
        self.refused_bytes("c.mhd", header.replace(b"LOCAL", b"%%d.txt 0 %d 1" % (SIZE[2] - 1)),
                          "voxels as text in several files are not read")

    def test_legacy_vtk(self):
        for name in ("FileTypeToBinary", "FileTypeToASCII"):
            writer = vtkStructuredPointsWriter()
            getattr(writer, "Set" + name)()
            self.cut("a.vtk", self.bytes_of(writer, "a.vtk"), "Error reading")

    def test_vtk_xml(self):
        content = self.bytes_of(vtkXMLImageDataWriter(), "a.vti")
        self.cut("a.vti", content, "cannot be read|cut off", rests=(0.5, -100))
        # In each encoding: cut off, and with a piece of the data missing or too much.
        for mode, compressor, encodes in itertools.product((0, 1, 2), (0, 2), (0, 1)):
            writer = vtkXMLImageDataWriter()
            writer.SetDataMode(mode)
            writer.SetCompressorType(compressor)
            writer.SetEncodeAppendedData(encodes)
            content = self.bytes_of(writer, "a.vti")
            with self.subTest(mode, compressor=compressor, encodes=encodes):
                self.cut("a.vti", content, "cannot be read|damaged|cut off", rests=(0.7, 0.9))
                at = len(content) * 2 // 3
                piece = 200 if mode == 0 else 12  # of a text parts of numbers may be missing
                for rest in (at + piece, at - piece):
                    self.refused_bytes("a.vti", content[:at] + content[rest:],
                                       "cannot be read|damaged|cut off")

    def test_nrrd(self):
        data = noisy_ball().tobytes()
        for encoding, pack, start in (("gzip", gzip.compress, 11), ("bzip2", bz2.compress, 1)):
            header = nrrd_header(encoding)
            content = header + b"\n" + pack(data)
            self.cut("a.nrrd", content, "packed data are cut off", rests=(0.5, -10, -1))
            self.flipped("a.nrrd", content, "packed data", len(header) + start)
            self.refused_bytes("a.nrrd", header + b"\n" + pack(data + b"more"),
                               "give more than the 20592 bytes")
            self.accepted_bytes("b.nrrd", header + b"\n" + pack(data[:99]) + pack(data[99:]))
        self.cut("c.nrrd", nrrd_header() + b"\n" + data,
                 "bytes of voxels, its header asks for 20592")

    def test_nifti(self):
        content = medical_files.nifti(noisy_ball(), SPACING)
        self.cut("a.nii", content, "cut off: it has [0-9]+ bytes of voxels")
        packed = gzip.compress(content)
        self.cut("a.nii.gz", packed, "packed data are cut off", rests=(0.5, -10, -1))
        self.flipped("a.nii.gz", packed, "packed data|not a NIfTI", 400)
        for kind, order in ((999, "<"), (0, "<"), (1536, "<"), (999, ">")):
            with self.subTest(kind, order=order):
                header = bytearray(content)
                if order == ">":
                    struct.pack_into(">i", header, 0, 348)
                    struct.pack_into(">8h", header, 40, 3, *SIZE, 1, 1, 1, 1)
                struct.pack_into(order + "h", header, 70, kind)
                self.refused_bytes("b.nii", bytes(header), f"the data type {kind} is none of")
                self.refused_bytes("b.nii.gz", gzip.compress(header), f"the data type {kind} is")

    def test_mrc(self):
        self.cut("a.mrc", medical_files.mrc(noisy_ball(), SPACING), "it has [0-9]+ bytes of voxels")
        self.refused_bytes("a.mrc", medical_files.mrc(noisy_ball(), SPACING, 77),
                           "mode 77 is no type")

    def test_invesalius_project(self):
        content = medical_files.inv3(noisy_ball(), SPACING)
        self.cut("a.inv3", content, "cut off|damaged", rests=(0.5, -10, -1, 100))
        flipped = bytearray(content)
        flipped[len(flipped) // 2] ^= 4
        self.refused_bytes("a.inv3", flipped, "cut off|damaged")

    def test_what_is_no_invesalius_project(self):
        voxels = ("matrix.dat", noisy_ball().tobytes())

        def plist(**changes):
            project = {"matrix": {"dtype": "int16", "filename": "matrix.dat",
                                  "shape": list(noisy_ball().shape)},
                       "spacing": SPACING.tolist(), **changes}
            return "main.plist", plistlib.dumps(project)

        shape = [int(n) for n in noisy_ball().shape]
        for files, reason in (
                ([voxels], "no main.plist in it"), ([plist()], "no matrix.dat in it"),
                ([voxels, ("main.plist", b"<plist><dict>")], "main.plist cannot be parsed"),
                ([voxels, ("main.plist", bytes(2 << 20))], "too large"),
                ([voxels, plist(spacing=[1.0, 1.0])], "'spacing' has not three numbers"),
                ([voxels, plist(spacing=[1.0, 1.0, -1.0])], "distance of the voxels is not positive"),
                ([voxels, plist(spacing=["a", "b", "c"])], "'a' is not a number"),
                ([voxels, plist(matrix={"dtype": "int16"})], "lacks 'shape'"),
                ([voxels, plist(matrix={"dtype": "object", "shape": shape})], "'object'"),
                ([voxels, plist(matrix={"dtype": "int16", "shape": [0, 4, 4]})], "0 x 4 x 4"),
                ([voxels, plist(matrix={"dtype": "int16", "shape": [1 << 30] * 3})],
                 "the sizes in main.plist ask for"),
                ([voxels, plist(matrix={"dtype": "int32", "shape": shape})],
                 "the sizes in main.plist ask for")):
            with self.subTest(reason):
                self.refused_bytes("a.inv3", medical_files.archive_of(files), reason)
        self.refused_bytes("a.inv3", b"no archive at all", "is none|cut off")

    @unittest.skipUnless(importlib.util.find_spec("vtkmodules.vtkIOMINC"), "VTK without MINC")
    def test_minc(self):
        from vtkmodules.vtkIOMINC import vtkMINCImageWriter
        content = self.bytes_of(vtkMINCImageWriter(), "a.mnc")
        self.cut("a.mnc", content, "cut off: it has [0-9]+ bytes of voxels|cut off", (0.5, -10, 90))

    def test_pages_in_a_ring(self):
        content = bytearray(self.bytes_of(vtkTIFFWriter(), "a.tif",
                                         make_image(noisy_ball("u2")[:1])))
        page, = struct.unpack_from("<I", content, 4)
        count, = struct.unpack_from("<H", content, page)
        struct.pack_into("<I", content, page + 2 + 12 * count, page)
        self.refused_bytes("a.tif", content, "its pages form no chain")

    def test_pictures(self):
        for writer, suffix in ((vtkPNGWriter, "png"), (vtkTIFFWriter, "tif"), (vtkPNMWriter, "pgm"),
                               (vtkBMPWriter, "bmp"), (vtkJPEGWriter, "jpg")):
            os.makedirs(self.path(suffix))
            for k, plane in enumerate(noisy_ball("u2") if suffix in ("png", "tif")
                                      else (noisy_ball() // 5).astype("u1")):
                content = self.bytes_of(writer(), f"{suffix}/{k:02}.{suffix}",
                                       make_image(plane[np.newaxis]))
            with self.subTest(suffix):
                self.write_bytes(f"{suffix}/17.{suffix}", content[:len(content) * 2 // 3])
                process = self.run_command(self.path(suffix), self.path("out.stl"), "--component", "0",
                                        "--iso", ISO / (1 if suffix in ("png", "tif") else 5),
                                        status=1)
                self.assertRegex(process.stderr, rf"17\.{suffix}")

    def test_too_little_memory_later(self):
        """Each limit ends with a surface or with the name of the volume and what helps."""
        file = self.write_bytes("large.mha", META.replace(b"26 22 18", b"256 256 256"))
        with open(file, "r+b") as stream:
            stream.truncate(len(META) + 3 + (2 << 24))
            stream.seek(len(META) + 3 + (1 << 24))
            stream.write(b"\xe8\x03" * (1 << 22))
        told = set()
        for megabytes in (280, 230):
            limit = megabytes << 20
            process = self.run_command(
                file, self.path("a.stl"), "--iso", "500.5", "--threads", "1", "-q",
                status=None, preexec_fn=lambda size=limit: resource.setrlimit(
                    resource.RLIMIT_AS, (size, size)))
            if process.returncode != 0:
                self.assertRegex(process.stderr, "(?m)^volumic: .*large.mha: not enough memory to "
                                 "(read|segment) it.*(crop|--finest)")
                told.add(process.stderr)
        self.assertGreater(len(told), 0, "all limits were large enough")


class MeshesTest(DamageTest):
    """As surfaces they would be open, as points fewer, and VTK's reader of .ply ends the program."""

    def setUp(self):
        super().setUp()
        names = [self.path(f"a.{suffix}") for suffix in ("vtp", "vtk", "stl", "ply", "obj")]
        self.run_command(self.ball_file(), *names, "--iso", ISO)

    def refused_mesh(self, name, reason):
        for option in ("--initial-surface", "--seeds", "--attracting-points"):
            with self.subTest(name, option=option):
                self.refused(f"{name}.*({reason})", self.path("ball.vti"), "--iso", ISO, option,
                             self.path(name), "--report", os.devnull)

    def test_cut_off(self):
        for suffix, rests in (("vtp", (0.5, -100)), ("vtk", (0.5, -100)), ("ply", (0.2, 0.7, -1)),
                              ("stl", (0.5, -50, -1))):
            content = self.content(f"a.{suffix}")
            for rest in rests:
                self.write_bytes(f"b.{suffix}",
                                 content[:int(len(content) * rest) if rest > 0 else rest])
                self.refused_mesh(f"b.{suffix}", "cannot be read|the file is cut off")

    def test_whole_ones_are_read(self):
        for suffix in ("vtp", "vtk", "stl", "ply", "obj"):
            self.run_command(self.path("ball.vti"), self.path("x.vtp"), "--iso", ISO,
                          "--initial-surface", self.path("a." + suffix))

    def test_polygon_file_as_text(self):
        head = ("ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
                "property float z\nelement face 4\nproperty list uchar int vertex_indices\n"
                "end_header\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n")
        self.write_bytes("c.ply", head.replace("element vertex", "element vertix").encode())
        self.refused_mesh("c.ply", "has no points, or its header is damaged")
        self.write_bytes("c.ply", head.encode())
        self.refused_mesh("c.ply", "the file is cut off: it ends in element 4 of 4")
        # VTK's reader takes each line for one of them.
        self.write_bytes("c.ply", head.replace("1 0 0\n0", "1 0\n0 0").encode() + b"3 0 3 1\n")
        self.refused_mesh("c.ply", "element 2 of 4 is not in one line of its own")
        self.write_bytes("c.ply", head.encode() + b"3 0 3 9\n")
        self.refused_mesh("c.ply", "is damaged: a polygon has point 9, there are 4")
        # There, too.
        self.write_bytes("c.ply", head.encode() + b"3 0 3 1")
        self.refused_mesh("c.ply", "the file is cut off: it ends in element 4 of 4")


    def test_legacy_cells_of_more_points_than_there_are(self):
        for binary in (False, True):
            numbers = [3, 0, 2, 1, 3, 0, 1, 3, 3, 1, 2, 3, 3, 0, 3, 2]
            for place, value in ((4, 1000000), (4, -1), (4, 4), (12, 2), (1, 7)):
                changed = list(numbers)
                changed[place] = value
                points = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], ">f4")
                data = [points.tobytes(), np.array(changed, ">i4").tobytes()] if binary else [
                    " ".join(map(str, points.ravel())).encode(), " ".join(map(str, changed)).encode()]
                self.write_bytes("c.vtk", b"# vtk DataFile Version 3.0\na\n%s\nDATASET POLYDATA\n"
                                 b"POINTS 4 float\n%s\nPOLYGONS 4 16\n%s\n"
                                 % (b"BINARY" if binary else b"ASCII", *data))
                with self.subTest(binary=binary, place=place, value=value):
                    self.refused_mesh("c.vtk", "damaged")

    def test_xml_in_each_encoding(self):
        reader = vtkXMLPolyDataReader()
        reader.SetFileName(self.path("a.vtp"))
        reader.Update()
        for mode, compressor, encodes in itertools.product((0, 1, 2), (0, 2), (0, 1)):
            writer = vtkXMLPolyDataWriter()
            writer.SetDataMode(mode)
            writer.SetCompressorType(compressor)
            writer.SetEncodeAppendedData(encodes)
            content = super().bytes_of(writer, "b.vtp", reader.GetOutput())
            with self.subTest(mode=mode, compressor=compressor, encodes=encodes):
                self.run_command(self.path("ball.vti"), self.path("x.vtp"), "--iso", ISO,
                              "--initial-surface", self.path("b.vtp"))
                at = len(content) * 3 // 4
                self.write_bytes("b.vtp", content[:at] + content[at + (200 if mode == 0 else 12):])
                self.refused_mesh("b.vtp", "cannot be read|damaged|cut off")


class SeriesTest(DamageTest):
    def slice(self, k, **changes):
        return dicom_slice(k, noisy_ball(), **changes)

    def series(self, **changes):
        os.makedirs(self.path("series"), exist_ok=True)
        for k in range(SIZE[2]):
            self.write_bytes(f"series/IM{k:02}", self.slice(k, **changes))

    def refused_slice(self, k, content, reason):
        self.refused_file(f"series/IM{k:02}", content, f"IM{k:02}: {reason}")

    def test_slices_that_are_cut_off(self):
        for syntax in ("explicit", "implicit"):
            self.series(syntax=syntax)
            self.accepted("series")
            content = self.slice(7, syntax=syntax)
            for rest in (-1, -500, -1144, -1150, 300, 200, 140):
                with self.subTest(syntax, rest=rest):
                    self.refused_slice(7, content[:rest], ".*(cut off|header|no pixels)")

    def test_pixels_that_are_fewer_than_the_rows(self):
        self.series()
        content = self.slice(7)
        rows = content.index(struct.pack("<HH", 0x28, 0x10)) + 8
        for k in range(SIZE[2]):
            self.write_bytes(f"series/IM{k:02}", self.slice(k).replace(
                content[rows - 8:rows + 2], content[rows - 8:rows] + struct.pack("<H", 40)))
        self.refused_volume("series", "IM00: the pixels are cut off: 1144 bytes, 2080 needed")
        self.series()
        place = content.index(struct.pack("<HH", 0x7FE0, 0x10)) + 8
        self.refused_slice(7, content[:place] + struct.pack("<I", 572) + content[place + 4:],
                           "is damaged: it does not end behind its pixels")

    def test_two_series_of_one_study(self):
        self.series()
        for k in range(1, SIZE[2], 2):
            self.write_bytes(f"series/IM{k:02}", self.slice(k, series="1.2.4"))
        self.refused_volume("series", r"2 series, one is needed; choose it with --series N: "
                            "1: head, 9 slices of 26 x 22, from IM00; 2: head, 9 slices of .*IM01")
        self.refused_volume("series", "no series 3; there are 1: head", "--series", "3")
        self.accepted("series", "--series", "2")
        self.accepted("series", "--series", "1.2.4")
        self.accepted("series/IM01")
        listed = self.run_command(self.path("series"), "--list-series").stdout.splitlines()
        self.assertEqual(listed[1], "2: head, 9 slices of 26 x 22, from IM01, 1.2.4")

    def test_headers_that_make_no_sense(self):
        self.series()
        for changes, reason in (({"bits": 32}, "the pixels are cut off"), ({"bits": 0}, "0 bits per"),
                                ({"bits": 12}, "12 bits per pixel"),
                                ({"frames": "1A"}, "the number of frames is '1A'"),
                                ({"slope": "1A"}, "slope '1A'"),
                                ({"intercept": "1A"}, "intercept '1A'")):
            with self.subTest(**changes):
                self.refused_slice(3, self.slice(3, **changes), ".*" + reason)
        self.write_bytes("series/IM03", self.slice(3, frames="2"))
        self.refused_volume("series", "IM04 lies where .*IM03 does")

    def test_sequences_without_end(self):
        self.series()
        content = self.slice(3)
        place = content.index(struct.pack("<HH", 0x0008, 0x1140)) + 12
        deep = content[:place] + struct.pack("<HHI", 0xFFFE, 0xE000, 0xFFFFFFFF) * 300000
        self.refused_slice(3, deep, "its header is damaged: (sequences within sequences|an item does not end)")

    def test_packed_slices(self):
        for syntax, reason in (("1.2.840.10008.1.2.1.99", "compressed as a whole"),
                               ("1.2.840.10008.1.2.5", "its pixels cannot be unpacked")):
            self.series()
            self.refused_slice(3, self.slice(3, syntax=syntax), reason)

    def test_reports_and_directories_are_no_slices(self):
        self.series()
        for name, kind in (("DICOMDIR", "1.2.840.10008.1.3.10"),
                           ("SR", "1.2.840.10008.5.1.4.1.1.88.11")):
            content = self.slice(0, kind=kind)
            self.write_bytes(f"series/{name}", content[:content.index(
                struct.pack("<HH", 0x28, 0x02))])
        self.accepted("series")


if __name__ == "__main__":
    unittest.main()
