# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""`volumic` looks at the structure of a file before VTK's readers, which may crash, do."""

import itertools
import os
import struct
import unittest
import zlib

import numpy as np
from vtkmodules.vtkIOImage import vtkBMPWriter, vtkTIFFWriter

from command_test_case import (
    ISO, META, SIZE, SPACING, CommandTestCase, ball, dicom_slice, make_image, nrrd_header)

import medical_files

ENTRY = struct.Struct("<HHII")


class StructureTest(CommandTestCase):
    ways = itertools.cycle(((), ("--memory", "200M")))  # read as a whole, and in parts


def tiff(pages, changes):
    """A TIFF file of grey pages of 16 bits, each one strip; tags that are None are left out."""
    content, link = bytearray(b"II*\0\0\0\0\0"), 4
    for page in pages:
        tags = {256: SIZE[0], 257: SIZE[1], 258: 16, 259: 1, 262: 1, 273: len(content), 277: 1,
                278: SIZE[1], 279: len(page), 339: 1, **changes}
        content += page + bytes(len(page) % 2)
        struct.pack_into("<I", content, link, len(content))
        entries = [ENTRY.pack(tag, 4, 1, value) for tag, value in sorted(tags.items())
                   if value is not None]
        content += struct.pack("<H", len(entries)) + b"".join(entries)
        link = len(content)
        content += bytes(4)
    return content


class TiffTest(StructureTest):
    def setUp(self):
        super().setUp()
        writer = vtkTIFFWriter()
        writer.SetCompressionToNoCompression()
        self.write(writer, "a.tif", make_image(ball("u2")))
        self.content = bytearray(self.content("a.tif"))
        self.accepted("a.tif")

    def pages(self):
        """The places of the pages, and of the number that leads to each."""
        link, pages = 4, []
        while True:
            place, = struct.unpack_from("<I", self.content, link)
            if place == 0:
                return pages
            pages.append((place, link))
            count, = struct.unpack_from("<H", self.content, place)
            link = place + 2 + 12 * count

    def entry(self, page, tag):
        """The place of the entry of a tag."""
        place = self.pages()[page][0]
        count, = struct.unpack_from("<H", self.content, place)
        return next(at for at in range(place + 2, place + 2 + 12 * count, 12)
                    if struct.unpack_from("<H", self.content, at)[0] == tag)

    def refused_with(self, page, tag, reason, kind=None, count=None, value=None):
        """The file, if the entry of the tag says something else."""
        at = self.entry(page, tag)
        there = ENTRY.unpack_from(self.content, at)
        content = bytearray(self.content)
        ENTRY.pack_into(content, at, tag, *(old if new is None else new for old, new in
                                            zip(there[1:], (kind, count, value))))
        with self.subTest(tag=tag, page=page):
            self.refused_bytes("b.tif", content, reason)

    def test_numbers_that_make_no_page(self):
        for page, tag, reason, value in (
                (3, 256, "page 4: it is 27 x 22, .* the first page 26 x 22", 27),
                (3, 257, "page 4: it is 26 x 40", 40), (0, 256, "damaged", 0),
                (3, 278, "damaged", 0), (3, 258, "page 4: .* of 12 bits", 12),
                (3, 277, "page 4: .* 2 of 16 bits", 2), (0, 277, "page 2: .* 3 of 16 bits", 3),
                (3, 262, "page 4: .* colours 9", 9), (3, 284, "damaged", 2 ** 15),
                (3, 274, "page 4: .* orientation 4", 4), (3, 273, "cut off", 2 ** 31)):
            self.refused_with(page, tag, reason, value=value)
        self.refused_with(3, 278, "damaged", kind=5, count=1)

    def test_chain_that_ends_early(self):
        """Whichever page is the last, or left out: pixels are in none."""
        for last in (0, 10, 16):
            content = bytearray(self.content)
            struct.pack_into("<I", content, self.pages()[last + 1][1], 0)
            with self.subTest(last=last):
                self.refused_bytes("b.tif", content, "are in none of its pages")
        content = bytearray(self.content)
        struct.pack_into("<I", content, self.pages()[5][1], self.pages()[6][0])
        self.refused_bytes("b.tif", content, "are in none of its pages")

    def test_strips_that_overlap(self):
        at = self.entry(4, 273)
        kind, count, value = ENTRY.unpack_from(self.content, at)[1:]
        place = at + 8 if count == 1 else value
        start, = struct.unpack_from("<I", self.content, place)
        self.assertEqual(kind, 4)
        struct.pack_into("<I", self.content, place, start - 64)
        self.refused_bytes("b.tif", self.content, "two parts of it overlap")

    def test_deflate(self):
        pages = [zlib.compress(page.tobytes()) for page in ball("u2")]
        self.accepted_bytes("c.tif", tiff(pages, {259: 8}))
        pages[8] = pages[8][:20] + bytes([pages[8][20] ^ 1]) + pages[8][21:]
        self.refused_bytes("c.tif", tiff(pages, {259: 8}), "page 9: .* damaged or cut off")
        pages[8] = zlib.compress(ball("u2")[8].tobytes()[:-1])
        self.refused_bytes("c.tif", tiff(pages, {259: 8}), "page 9: .*1144 are needed")

    def test_kinds_of_pixels(self):
        pages = [page.tobytes() for page in ball("u2")]
        for tags, reason in (({259: 32946}, "page 1: .* damaged or cut off"),
                             ({258: 12}, "pixels of this kind"), ({339: 6}, "pixels of this kind"),
                             ({273: None, 322: 16, 323: 16}, "damaged or cut off")):
            with self.subTest(tags):
                self.refused_bytes("c.tif", tiff(pages, tags), reason)
        for voxels, tags in ((ball("f4"), {258: 32, 339: 3}), (ball("i2"), {339: 2}),
                             (ball("f2"), {339: 3}),
                             ((65535 - ball()).astype("u2"), {262: 0})):
            with self.subTest(tags):
                self.accepted_bytes("d.tif", tiff([page.tobytes() for page in voxels], tags))
        colours = np.repeat(ball("u2")[..., np.newaxis], 3, -1)
        self.accepted_bytes("d.tif", tiff([page.tobytes() for page in colours], {262: 2, 277: 3}))

    def test_tiles(self):
        """Of 16 x 16 pixels, which go over the edges, as large as two strips of rows."""
        pages = []
        for plane in ball("u2"):
            wide = np.zeros((32, 32), "u2")
            wide[:SIZE[1], :SIZE[0]] = plane
            pages.append(b"".join(wide[y:y + 16, x:x + 16].tobytes()
                                  for y in (0, 16) for x in (0, 16)))
        content, link = bytearray(b"II*\0\0\0\0\0"), 4
        for page in pages:
            place = len(content)
            content += page + struct.pack("<4I4I", *(place + 512 * n for n in range(4)), *[512] * 4)
            struct.pack_into("<I", content, link, len(content))
            entries = [(256, 4, 1, SIZE[0]), (257, 4, 1, SIZE[1]), (258, 3, 1, 16), (259, 3, 1, 1),
                       (262, 3, 1, 1), (277, 3, 1, 1), (322, 3, 1, 16), (323, 3, 1, 16),
                       (324, 4, 4, place + 2048), (325, 4, 4, place + 2064)]
            content += struct.pack("<H", len(entries))
            content += b"".join(ENTRY.pack(*entry) for entry in entries)
            link = len(content)
            content += bytes(4)
        self.write_bytes("tiles.tif", bytes(content))
        for way in next(self.ways), next(self.ways):
            reports = [self.report(self.path(name), "--iso", ISO, *way)
                       for name in ("tiles.tif", "strips.tif")
                       if self.write_bytes("strips.tif", bytes(tiff(
                           [plane.tobytes() for plane in ball("u2")], {})))]
            self.assertEqual(reports[0]["volume"], reports[1]["volume"])
        self.refused_bytes("e.tif", bytes(content[:-100]), "damaged|cut off")

    def test_pages_in_a_folder(self):
        os.makedirs(self.path("folder"))
        self.write_bytes("folder/a.tif", self.content)
        process = self.run_command(self.path("folder"), self.path("out.stl"), status=1)
        self.assertRegex(process.stderr, r"a\.tif: 18 pages; give it by its name")


class PicturesTest(StructureTest):
    def pictures(self, suffix, contents):
        os.makedirs(self.path(suffix), exist_ok=True)
        for k, content in enumerate(contents):
            self.write_bytes(f"{suffix}/{k:02}.{suffix}", content)

    def test_pgm(self):
        planes = (ball() // 5).astype("u1")
        head = b"P5\n# comment\n26 22\n255\n"
        self.pictures("pgm", [head + plane.tobytes() for plane in planes])
        iso = ("--iso", ISO / 5)
        self.run_command(self.path("pgm"), self.path("a.stl"), *iso)
        self.write_bytes("pgm/08.pgm", b"P5\n# a comment of another length\n26 22\n255\n"
                         + planes[8].tobytes())
        self.run_command(self.path("pgm"), self.path("b.stl"), *iso)
        self.assertEqual(self.content("a.stl"), self.content("b.stl"))
        for content, reason in ((head + b"\7" + planes[8].tobytes(), "too long"),
                                (head.replace(b"26", b"2x") + planes[8].tobytes(), "damaged")):
            self.refused_file("pgm/08.pgm", content, "08.pgm: .*" + reason)

    def test_bmp(self):
        planes = (ball() // 5).astype("u1")
        for k, plane in enumerate(planes):
            os.makedirs(self.path("bmp"), exist_ok=True)
            self.write(vtkBMPWriter(), f"bmp/{k:02}.bmp", make_image(plane[np.newaxis]))
        self.run_command(self.path("bmp"), self.path("a.stl"), "--iso", ISO / 5, "--component", 0)
        content = self.content("bmp/08.bmp")
        for place, form, value in ((28, "<H", 8), (10, "<I", 53), (22, "<i", 21), (2, "<I", 9)):
            damaged = bytearray(content)
            struct.pack_into(form, damaged, place, value)
            with self.subTest(place=place):
                self.refused_file("bmp/08.bmp", damaged, "08.bmp: ")
        self.refused_file("bmp/08.bmp", content[:60] + b"\7" + content[60:],
                          "08.bmp: the file is too long")


class LengthTest(StructureTest):
    """Bytes that are too many move the voxels behind them."""

    def longer(self, name, start, content, companion=None):
        self.write_bytes(companion or name, content)
        self.accepted(name)
        for place, count in ((start, 1), (start + 1000, 16), (len(content), 3)):
            with self.subTest(name, place=place):
                self.write_bytes(companion or name,
                                 content[:place] + b"\x07" * count + content[place:])
                self.refused_volume(name, "too long|more than|more values")

    def test_meta_image(self):
        self.longer("a.mha", len(META), META + ball().tobytes())
        self.write_bytes("b.mhd", META.replace(b"LOCAL", b"b.raw"))
        self.longer("b.mhd", 0, ball().tobytes(), "b.raw")
        for k, plane in enumerate(ball()):
            self.write_bytes(f"{k}.raw", plane.tobytes())
        self.write_bytes("c.mhd", META.replace(b"LOCAL", b"%d.raw 0 17 1"))
        self.longer("c.mhd", 0, ball()[3].tobytes(), "3.raw")

    def test_nrrd(self):
        header = nrrd_header()
        self.longer("a.nrrd", len(header) + 1, header + b"\n" + ball().tobytes())
        header, text = nrrd_header("text"), " ".join(map(str, ball().ravel())).encode()
        self.accepted_bytes("b.nrrd", header + b"\n" + text)
        self.refused_bytes("b.nrrd", header + b"\n5 " + text, "more values")

    def test_nifti(self):
        self.longer("a.nii", 352, medical_files.nifti(ball(), SPACING))

    def test_mrc(self):
        self.longer("a.mrc", 1024, medical_files.mrc(ball(), SPACING))

    def test_dicom(self):
        os.makedirs(self.path("a"))
        for k in range(SIZE[2]):
            content = dicom_slice(k)
            self.write_bytes(f"a/IM{k:02}", content)
        pixels = content.index(struct.pack("<HH", 0x7FE0, 0x10)) + 12
        self.accepted("a")
        more = struct.pack("<HH2sHI", 0xFFFC, 0xFFFC, b"OB", 0, 4) + bytes(4)
        self.write_bytes("a/IM17", content + more)
        self.accepted("a")
        for place, count in ((pixels, 2), (pixels + 500, 8), (len(content), 3)):
            self.refused_file("a/IM17", content[:place] + b"\x07" * count + content[place:],
                              "IM17.* (too long|bytes may be too many)")


class HeaderTest(StructureTest):
    def test_nifti(self):
        content = medical_files.nifti(ball(), SPACING)
        for place, form, value, reason in (
                (40, "<h", 2, "too long"), (40, "<h", 0, "0 dimensions"),
                (40, "<h", 9, "9 dimensions"), (46, "<h", 0, "size of dimension 3 is 0"),
                (44, "<h", -1, "cut off|dimension 2"), (72, "<h", 8, "have 16 bits, not 8"),
                (108, "<f", 0, "within the header"), (108, "<f", -352, "begin at byte -352"),
                (108, "<f", float("nan"), "begin at byte"),
                (344, "<B", 0x6f, "its mark is not n.1"),
                (0, "<i", 349, "not a NIfTI or Analyze file")):
            header = bytearray(content)
            struct.pack_into(form, header, place, value)
            with self.subTest(place=place, value=value):
                self.refused_bytes("a.nii", header, reason)

    def test_nrrd(self):
        content = nrrd_header() + b"\n" + ball().tobytes()
        for old, new, reason in (
                (b"endian: little", b"endian: lattle", "endian 'lattle'"),
                (b"endian:", b"endiao:", "'endiao' is no field of NRRD"),
                (b"kinds:", b"kinds ", "is no field of NRRD"),
                (b"dimension: 3", b"dimension: 4", "dimension '4'")):
            with self.subTest(new):
                self.assertIn(old, content)
                self.refused_bytes("a.nrrd", content.replace(old, new), reason)

    def test_meta_image(self):
        content = META + ball().tobytes()
        for old, new, reason in (
                (b"NDims = 3", b"NDims = 2", "not as many sizes"),
                (b"MET_SHORT", b"MET_SHOST", "ElementType 'MET_SHOST'"),
                (b"MSB = False", b"MSB = Galse", "BinaryDataByteOrderMSB is 'galse'")):
            with self.subTest(new):
                self.assertIn(old, content)
                self.refused_bytes("a.mha", content.replace(old, new), reason)

    def test_mrc(self):
        for place, value in ((64, 7), (68, 1), (0, 0), (28, 0), (8, -18)):
            content = bytearray(medical_files.mrc(ball(), SPACING))
            struct.pack_into("<i", content, place, value)
            with self.subTest(place=place):
                self.refused_bytes("a.mrc", content, "its header is damaged|cut off")

    def test_mrc_of_unsigned_numbers(self):
        """VTK's reader takes each for two."""
        self.write_bytes("a.mrc", medical_files.mrc(ball("u2") + 40000, SPACING, 6))
        process = self.run_command(self.path("a.mrc"), self.path("ok.stl"), "--iso", 40000 + ISO)
        self.assertIn("unsigned short, 40000 to 40861", process.stderr)

    def test_mrc_whose_rows_are_along_another_axis(self):
        self.write_bytes("a.mrc", medical_files.mrc(ball(), SPACING, order=(3, 2, 1)))
        self.run_command(self.path("a.mrc"), "--write-volume", self.path("b.vti"))
        self.assertIn(b'Direction="0 0 1 0 1 0 1 0 0"', self.content("b.vti"))


class DicomFolderTest(StructureTest):
    def series(self, name):
        os.makedirs(self.path("a"), exist_ok=True)
        for k in range(SIZE[2]):
            self.write_bytes("a/" + name(k), dicom_slice(k))

    def test_slices_that_were_cut_to_nothing(self):
        """At an end of the series none is missing between others."""
        for name, k in (("IM{:02}".format, 0), ("s{:02}.dcm".format, 17), ("{:08X}".format, 17)):
            self.series(name)
            self.accepted("a")
            content = self.content("a/" + name(k))
            for damaged in (content[:0], content[:131], content[:130] + b"?" + content[131:]):
                with self.subTest(name(k), bytes=len(damaged)):
                    self.refused_file("a/" + name(k), damaged, f"{name(k)}: no DICOM file")
            for file in os.listdir(self.path("a")):
                os.remove(self.path("a/" + file))

    def test_other_files_are_none_of_the_slices(self):
        self.series("IM{:02}".format)
        for name, content in (("README", b"read me"), ("notes.txt", b""), ("a.json", b"{}")):
            self.write_bytes("a/" + name, content)
        self.accepted("a")


class NoFileTest(StructureTest):
    def test_pipes(self):
        """They would be waited for, without end."""
        self.ball_file()
        volumes = ("a.mha", "a.vti", "a.nii.gz", "a.nrrd", "a.tif", "a.inv3", "a")
        for name in (*volumes, "p.raw", "list.txt", "list.stl"):
            os.mkfifo(self.path(name))
        for name in volumes:
            with self.subTest(name):
                self.refused_volume(name, "a pipe or a device")
        self.write_bytes("b.mhd", META.replace(b"LOCAL", b"p.raw"))
        self.write_bytes("b.nhdr", nrrd_header("gzip") + b"data file: p.raw\n")
        for name in ("b.mhd", "b.nhdr"):
            with self.subTest(name):
                process = self.run_command(self.path(name), self.path("x.stl"), status=1)
                self.assertIn("p.raw: a pipe or a device", process.stderr)
        for option, name in (("--seeds", "list.txt"), ("--attracting-points", "list.txt"),
                             ("--initial-surface", "list.stl"), ("--seeds", "list.stl"),
                             ("--edges", "a.mha")):
            with self.subTest(option, name=name):
                self.refused(f"{name}: a pipe or a device", self.path("ball.vti"),
                             self.path("x.stl"), option, self.path(name))
        self.refused("list.txt.*: a pipe or a device", self.path("ball.vti"), self.path("x.stl"),
                     "--labels", "all", "--label-names", self.path("list.txt"))
        self.refused("a pipe or a device", "/dev/null", self.path("x.stl"))


if __name__ == "__main__":
    unittest.main()
