# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Files that were made to do harm: `volumic` refuses them in seconds, without memory or disk.

Each of them once crashed the program, hung, or filled the memory or the disk.
"""

import base64
import bz2
import gzip
import importlib.util
import io
import itertools
import plistlib
import re
import resource
import signal
import struct
import subprocess
import tarfile
import unittest
import zlib

import numpy as np
from vtkmodules.vtkIOXML import vtkXMLImageDataWriter

from command_test_case import ISO, META, PROGRAM, SIZE, SPACING, CommandTestCase, ball, make_image

import medical_files
from test_tool_label_names import labelled_nifti
from test_tool_structure import tiff

# Seconds of the processor, memory and disk that a run may take; the clock of a busy machine may go on.
SECONDS, MEMORY, DISK = 20, 2 << 30, 64 << 20
PATIENCE = 10 * SECONDS


def limit():
    """Of time, of memory, of the size of a file, and of what a crash leaves."""
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    resource.setrlimit(resource.RLIMIT_FSIZE, (DISK, DISK))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    resource.setrlimit(resource.RLIMIT_CPU, (SECONDS, SECONDS))


class HostileTest(CommandTestCase):
    def run_limited(self, *arguments):
        """The finished process; a failure if it hangs."""
        command = [PROGRAM, *map(str, arguments)]
        try:
            process = subprocess.run(command, capture_output=True, text=True, errors="replace",
                                     timeout=PATIENCE, check=False, preexec_fn=limit)
        except subprocess.TimeoutExpired:
            self.fail(f"{command} hangs")
        self.assertNotIn(process.returncode, (-signal.SIGKILL, -signal.SIGXCPU),
                         f"{command} takes too long")
        return process

    ways = itertools.cycle(((), ("--memory", "300M")))

    def refused(self, name, reason, *options):
        """By its name, for this reason, read as a whole or, every other time, in parts."""
        memory = next(self.ways)
        with self.subTest(name, reason=reason, memory=memory):
            process = self.run_limited(self.path(name), self.path("x.stl"), "--iso", ISO,
                                       "--scratch", self.folder, *memory, *options)
            self.assertEqual(process.returncode, 1, process.stderr[-500:])
            self.assertRegex(process.stderr, f"volumic: .*{re.escape(name)}.*({reason})")
            self.assertLess(len(process.stderr), 2000)

    def refused_bytes(self, name, content, reason, **options):
        self.write_bytes(name, content)
        self.refused(name, reason, **options)


class HeaderTest(HostileTest):
    def nrrd(self, sizes, encoding="raw", extra="", kinds="domain domain domain"):
        return (f"NRRD0004\ntype: short\ndimension: {len(sizes.split())}\nsizes: {sizes}\n"
                f"kinds: {kinds}\nendian: little\nencoding: {encoding}\n{extra}\n").encode()

    def test_products_of_sizes(self):
        """They pass 32 or 64 bits, with a rest that is small."""
        for sizes in ("180336 174974 134839", "174974 134839 781863032", "65536 65536 65536",
                      "2147483647 2147483647 2147483647", "4194304 4194304 1048576"):
            for encoding in ("raw", "gzip", "bzip2", "text"):
                self.refused_bytes("a.nrrd", self.nrrd(sizes, encoding) + bytes(3000), "cut off")
        self.refused_bytes("a.nrrd", self.nrrd("4096 180336 174974 134839", kinds="list x x x"),
                           "cut off")

    def test_bytes_before_packed_voxels(self):
        """They are a part of what the disk would have to hold."""
        bomb = gzip.compress(bytes(100 << 20), 9)
        self.refused_bytes("a.nrrd", self.nrrd("8 8 8", "gzip", "byte skip: 104856576\n") + bomb,
                           "begin at byte 104856576")
        self.refused_bytes("a.nrrd", self.nrrd("8 8 8", "gzip") + bomb, "more than the 1024 bytes")

    def test_lines_before_voxels(self):
        self.refused_bytes("a.nrrd", self.nrrd("8 8 8", "raw", "line skip: 2147483647\n")
                           + b"\n" * (6 << 20), "cut off")

    def test_nifti_bombs(self):
        """A few MB that declare 8 x 8 x 8 voxels, and unpack to more than the disk has."""
        head = bytearray(medical_files.nifti(np.zeros((8, 8, 8), "i2"), SPACING))
        bomb = gzip.compress(bytes(100 << 20), 9)
        self.refused_bytes("a.nii.gz", gzip.compress(head) + bomb, "more than the 1376 bytes")
        struct.pack_into("<f", head, 108, 100e6)
        self.refused_bytes("a.nii.gz", gzip.compress(head) + bomb, "begin at byte 100000000")
        self.refused_bytes("a.nii", gzip.compress(head) + bomb, "begin at byte 100000000")

    def test_meta_image_without_voxels(self):
        head = META.replace(b"CompressedData = False", b"CompressedData = True")
        bomb = zlib.compress(bytes(100 << 20), 9)
        self.refused_bytes("a.mha", head + bomb, "more than the 20592 bytes")
        for sizes in (b"0 0 0", b"26 22 0", b"26 22 18446744073709551615",
                      b"65536 65536 4294967296"):
            self.refused_bytes("b.mha", head.replace(b"26 22 18", sizes) + bomb, ".")

    def test_names_of_the_files_of_a_meta_image(self):
        """MetaIO prints numbers by the word that it finds, and divides by the step."""
        for k in range(20):
            self.write_bytes(f"{k}.raw", ball()[0].tobytes())
        for words in ("%s.raw 1 18 1", "%n.raw 1 18 1", "%d%d.raw 1 18 1", "%d.raw 1 18",
                      "%d.raw 1 18 0", "%d.raw 18 1 -1", "%d.raw 1 5 1", "%09999999999d.raw 1 18 1",
                      "%0999999999d.raw 1 18 1", "%", "%d.raw 1 18 1 1", "%d" + "a" * 60000):
            content = META.replace(b"LOCAL", words.encode())
            with self.subTest(words[:30]):
                self.refused_bytes("a.mhd", content, "gives no 18 files|cannot be opened")
        for words in ("%d.raw", "%d.raw 1", "%d.raw 1 18 1", "%01d.raw 1 19 1"):
            self.write_bytes("a.mhd", META.replace(b"LOCAL", words.encode()))
            with self.subTest(words):
                self.run_command(self.path("a.mhd"), "--write-volume", self.path("a.vti"))
        self.refused_bytes("a.mhd", META.replace(b"LOCAL", b"%d.raw 1 x 1"), "not a whole number")
        for word in (b"a" * 60000, b"a" * 60000 + b" 1 18 1", b"*" * 60000 + b"%d.raw 1 18 1",
                     b"%d*" * 20000):
            self.refused_bytes("a.mhd", META.replace(b"LOCAL", word),
                               "gives no 18 files|cannot be opened")

    def test_sizes_that_are_not_those_of_the_files(self):
        listed = META.replace(b"LOCAL", b"%d.raw 0 17 1")
        for k in range(18):
            self.write_bytes(f"{k}.raw", bytes(2))
        for content in (META + ball().tobytes(), listed):
            self.refused_bytes("b.mhd", content.replace(
                b"ElementType", b"ElementNumberOfChannels = 0\nElementType"), "header is damaged")
        self.refused_bytes("c.mha", META.replace(b"DimSize", b"dimsize"), "cut off: it has 0 bytes")

    def test_more_slices_than_a_list_has(self):
        listed = META.replace(b"26 22 18", b"26 22 18446744073709551615")
        self.refused_bytes("a.mhd", listed.replace(b"LOCAL", b"LIST") + b"a.raw\n", "lists 1 files")
        many = META.replace(b"26 22 18", b"1 " * 40).replace(b"NDims = 3", b"NDims = 40")
        self.refused_bytes("b.mhd", many, "no NDims, or not as many sizes")

    def test_pages_that_share_their_values(self):
        """Each would have them read, or unpacked, once more."""
        page = zlib.compress(bytes(2 * SIZE[0] * SIZE[1]), 9)
        bomb = zlib.compress(bytes(100 << 20), 9)
        # Of what is packed only as much is unpacked as a page has.
        self.refused_bytes("a.tif", bytes(tiff([page, bomb], {259: 8})), "26 x 22 x 2 voxels")
        content = bytearray(tiff([page], {259: 8}))
        values = len(content)
        content += bytes(2 << 20)
        link = content.index(struct.pack("<HHII", 339, 4, 1, 1)) + 12
        first, = struct.unpack_from("<I", content, 4)
        tags = content[first + 2:link]
        for _ in range(3000):
            struct.pack_into("<I", content, link, len(content))
            content += struct.pack("<H", 11) + tags
            content += struct.pack("<HHII", 60000, 4, 1 << 19, values)
            link = len(content)
            content += bytes(4)
        self.refused_bytes("b.tif", bytes(content), "more values than it has bytes")


class NestingTest(HostileTest):
    DEEP = 140000

    def hidden(self):
        """Elements within elements, and what hides them from who only looks for signs."""
        for element in (b"<a>", b'<a b="/>">', b"<a><!-- </a> -->", b"<AppendedData/><a>",
                        b"<a><![CDATA[</a>]]>", b"<a\n>"):
            yield element * self.DEEP

    def test_elements_within_elements(self):
        for elements in self.hidden():
            plist = (b"<plist>" + elements)[:1 << 20]
            self.refused_bytes("a.inv3", medical_files.archive_of([("main.plist", plist)]),
                               "elements within elements|cannot be parsed")
        image = b'<VTKFile type="ImageData"><ImageData WholeExtent="0 1 0 1 0 1">'
        for elements in self.hidden():
            if b"Appended" not in elements:
                self.refused_bytes("a.vti", image + elements, "elements within elements")
                self.write_bytes("b.pvti", b'<VTKFile type="PImageData"><PImageData '
                                 b'WholeExtent="0 1 0 1 0 1"><Piece Extent="0 1 0 1 0 1" '
                                 b'Source="a.vti"/></PImageData></VTKFile>')
                self.refused("b.pvti", "elements within elements")

    def test_archives_that_tell_of_more_than_they_have(self):
        sides = [4096, 4096, 2048]
        project = {"matrix": {"dtype": "int16", "filename": "matrix.dat", "shape": sides},
                   "spacing": SPACING.tolist()}
        plist = plistlib.dumps(project)
        voxels = tarfile.TarInfo("matrix.dat")
        voxels.size = 2 * int(np.prod(sides))
        holes = tarfile.TarInfo("matrix.dat")
        holes.pax_headers = {"GNU.sparse.major": "1", "GNU.sparse.minor": "0",
                             "GNU.sparse.name": "matrix.dat", "GNU.sparse.realsize": str(voxels.size)}
        for member, data, reason in ((voxels, b"", "cut off"),
                                     (holes, b"1\n0\n512\n".ljust(1024, b"\0"), "no matrix.dat")):
            content = io.BytesIO()
            with tarfile.open(fileobj=content, mode="w", format=tarfile.PAX_FORMAT) as archive:
                head = tarfile.TarInfo("main.plist")
                head.size = len(plist)
                archive.addfile(head, io.BytesIO(plist))
                member.size = member.size or len(data)
                # Not by addfile(), which wants all that the head tells of.
                content.write(member.tobuf(tarfile.PAX_FORMAT) + data)
            with self.subTest(reason):
                self.refused_bytes("a.inv3", content.getvalue(), reason)

    def test_a_hole_beyond_the_end_of_an_archive_s_member(self):
        # libarchive forgets of such a hole, and gives zeros.
        side, real = 8, 2 * 8**3
        plist = plistlib.dumps({"matrix": {"dtype": "int16", "filename": "matrix.dat",
                                           "shape": [side] * 3}, "spacing": [1., 1., 1.]})
        content = (self.old_head("main.plist", len(plist), b"0")
                   + plist.ljust(-len(plist) % 512 + len(plist), b"\0")
                   + self.old_head("matrix.dat", 512, b"S", hole=(real + 100, 512, real))
                   + b"A" * 512 + bytes(1024))
        self.refused_bytes("a.inv3", content, "holes")

    @staticmethod
    def old_head(name, size, kind, hole=None):
        """Of a member of a tar archive of old GNU tar."""
        head = bytearray(512)
        for place, text in ((0, name.encode()), (100, b"0000644\0"), (124, b"%011o\0" % size),
                            (156, kind), (257, b"ustar  \0"), (148, b" " * 8)):
            head[place:place + len(text)] = text
        for place, value in zip((386, 398, 483), hole or ()):
            head[place:place + 12] = b"%011o\0" % value
        head[148:156] = b"%06o\0 " % sum(head)
        return bytes(head)

    def test_packed_again_and_again(self):
        empty = bz2.compress(b"")
        twice = bz2.compress(bz2.compress(empty * 200000) * 20000)
        head = b"NRRD0004\ntype: uchar\ndimension: 3\nsizes: 4 4 4\nencoding: bzip2\n\n"
        for content in (twice, bz2.compress(bz2.compress(bytes(range(64))))):
            self.refused_bytes("a.nrrd", head + content, "more than the 64 bytes")

    def test_long_names_of_pieces(self):
        self.refused_bytes("a.pvti", b'<VTKFile type="PImageData"><PImageData WholeExtent="0 1 0 1'
                           b' 0 1"><Piece Extent="0 1 0 1 0 1" Source="' + b"a" * 900000 + b'"/>'
                           b"</PImageData></VTKFile>", "cannot be read|File name too long")


class VtkTest(HostileTest):
    """What crashes VTK's readers, or has them go on without end."""

    def test_pictures(self):
        def tga(kind, width, rows, data, bits=24):
            return struct.pack("<12B2H2B", 0, 0, kind, *[0] * 9, width, rows, bits, 0) + data

        for content, reason in ((tga(2, 32767, 32767, bytes(100)), "cut off"),
                                (tga(2, 65535, 65535, bytes(100)), "damaged"),
                                (tga(10, 2, 2, b"\xff123" * 9), "packed pixels are not as many"),
                                (tga(10, 99, 99, b"\xff123"), "packed pixels are not as many")):
            self.refused_bytes("a.tga", content, reason)
        self.refused_bytes("a.pgm", b"P5\n0 4\n2\n", "header is damaged")
        for content in (b"P3\n26 22\n", b"P1\n#", b"P2" + bytes(20),
                        b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 99 +X 99\n"):
            self.refused_bytes("a.pic", content, "not read|not a format")

    def test_blocks_of_packed_arrays(self):
        """Their number is that of the memory that is taken for their sizes."""
        head = (b'<VTKFile type="ImageData" version="1.0" byte_order="LittleEndian" header_type='
                b'"UInt32" compressor="vtkZLibDataCompressor"><ImageData WholeExtent="0 1 0 1 0 1" '
                b'Origin="0 0 0" Spacing="1 1 1"><Piece Extent="0 1 0 1 0 1"><PointData Scalars="a">'
                b'<DataArray type="UInt8" Name="a" format="%s"%s</PointData></Piece></ImageData>')
        for blocks, size, last in ((0xFFFFFFF0, 8, 0), (1 << 30, 8, 0), (1, 0, 0), (0, 0, 5),
                                   (0, 8, 5), (1, 8, 9)):
            words = struct.pack("<4I", blocks, size, last, 16) + bytes(20)
            inline = head % (b"binary", b">" + base64.b64encode(words) + b"</DataArray>")
            appended = head % (b"appended", b' offset="0"/>')
            other = head % (b"any", b' offset="0"/><DataArray offset="9223372036854775807"/>')
            for content in (
                    inline, other + b'<AppendedData encoding="raw">_' + words,
                    appended + b'<AppendedData encoding="raw">_' + words,
                    appended + b'<AppendedData encoding="base64">_' + base64.b64encode(words)):
                self.refused_bytes("a.vti", content, f"packed in {blocks} blocks of {size} "
                                   f"bytes, the last one of {last}")

        cut = (b'<AppendedData encoding="base64">_' + base64.b64encode(b"\xf0\xff\xff\xff")
               + b"A" * 99)
        self.refused_bytes("a.vti", head % (b"appended", b' offset="0"/>') + cut,
                           "packed in 4294967280 blocks")

    def mesh(self, name, content, option="--initial-surface"):
        """The run that is given this mesh."""
        return self.run_limited(self.ball_file(), self.path("x.stl"), option,
                                self.write_bytes(name, content))

    def test_polygons(self):
        points = b"element vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
        faces = b"element face 1\nproperty list uchar int vertex_indices\n"
        for lines, reason in (
                (b"property float x\n" + points + faces, "a property of no element"),
                (points.replace(b"float y", b"float") + faces, "has no name"),
                (points.replace(b"float y", b"float w") + faces, "not those of a surface"),
                (points + faces.replace(b"vertex_i", b"i"), "not those of a surface"),
                (points + faces + faces, "it is there twice"),
                (points + faces.replace(b"int v", b"float v"), "not those of a surface"),
                (points + faces + b"element other 0\n", "not those of a surface"),
                (faces + points, "'face' comes before"),
                (points + faces.replace(b"face", b"edge") + faces, "'edge' comes before"),
                (points + b"prperty float w\n" + faces, "it has a line 'prperty'"),
                (points.replace(b"3", b"") + faces, "no number of elements 'vertex'"),
                (points.replace(b"3", b"-1") + faces, "no number of elements 'vertex'"),
                (points + b"comment \0" + faces, "header does not end"),
                (points + faces + b"comment " + b"a" * 9000 + b"\n", "header does not end")):
            for form in (b"ascii", b"binary_little_endian"):
                process = self.mesh("a.ply", b"ply\nformat " + form + b" 1.0\n" + lines
                                    + b"end_header\n" + b"0 0 0 " * 99)
                self.assertRegex(process.stderr, f"volumic: .*a.ply: .*{reason}")
        few = points.replace(b"3", b"300") + faces
        for old, corners in ((b"uchar int", b"\xff" + bytes(1020)), (b"uchar int", b"\3" + bytes(11)
                             + b"\xff"), (b"uchar int", b"\1\xff\xff\xff\xff")):
            for new in (b"char int", b"uchar char"):
                process = self.mesh(
                    "a.ply", b"ply\nformat binary_little_endian 1.0\n" + few.replace(old, new)
                    + b"end_header\n" + bytes(3600) + corners)
                self.assertEqual(process.returncode, 1, process.stderr)
        process = self.mesh("a.ply", b"ply\nformat packed 1.0\n" + points + faces
                            + b"end_header\n")
        self.assertIn("the format 'packed' is none", process.stderr)

    def test_triangles(self):
        """More than there are, whatever the first word is."""
        for word in (b"solid", b"binary"):
            process = self.mesh("a.stl", word.ljust(80, b"\0") + struct.pack("<I", 1 << 31)
                                + bytes(500))
            self.assertRegex(process.stderr, "a.stl: the file is cut off: it has 584 bytes")
        text = "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n"
        text = "solid k\u00f6rper\n" + 4 * (text + "endfacet\n") + "endsolid\n"
        process = self.mesh("b.stl", text.encode(), "--seeds")
        self.assertIn("Seed 0 lies outside the image", process.stderr)  # It has been read.

    def test_corners(self):
        """Of points, textures and normals that are not there."""
        start = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\n"
        for line, reason in (
                (b"f 1 2 4", "corner '4', which is none of the 3 points"),
                (b"f 1 2 -4", "corner '-4'"), (b"f 1 2 0", "corner '0'"),
                (b"f 1 2 x", "corner 'x'"),
                (b"f 1/1 2/1 3/2", "corner '3/2'"), (b"f 1//1 2//1 3//-2", "corner '3//-2'"),
                (b"f 1/ 2/ 3/", "corner '1/'"), (b"f 1/1/1/1 2 3", "corner '1/1/1/1'"),
                (b"f 1 2 \\\n 4", "corner '4'"), (b"f 1//1 2/1 3", "corners of 3 kinds"),
                (b"f", "corners of 0 kinds"),
                (b"# " + b"a" * 2000, "too long, or no text"), (b"#\0", "too long, or no text")):
            process = self.mesh("a.obj", start + line + b"\nf 1/1/1 2/1/1 3/1/1\n")
            with self.subTest(line[:20]):
                self.assertRegex(process.stderr, f"a.obj: is damaged: line [67] .*{reason}")

    @unittest.skipUnless(importlib.util.find_spec("vtkmodules.vtkIOMINC"), "VTK without MINC")
    def test_minc(self):
        def netcdf(name, dimensions, size):
            return (b"CDF\1" + struct.pack(">4I", 0, 10, 1, 1) + b"x\0\0\0"
                    + struct.pack(">5I", size, 0, 0, 11, 1) + struct.pack(">I", len(name))
                    + name.ljust((len(name) + 3) // 4 * 4, b"\0") + struct.pack(">I", dimensions)
                    + bytes(4 * dimensions) + struct.pack(">5I", 0, 0, 3, 8, 0) + bytes(4000))

        for name, dimensions, size, reason in (
                (b"other", 3, 2, "it has no image"), (b"image", 9, 2, "9 dimensions"),
                (b"image", 0, 2, "0 dimensions"), (b"image", 3, 0, "and 0 values")):
            self.refused_bytes("a.mnc", netcdf(name, dimensions, size), reason)


class NamesTest(HostileTest):
    def names(self, name, content):
        """The run that reads the names, which are refused or taken."""
        self.write_bytes(name, content)
        volume = np.zeros((8, 8, 8), "u1")
        volume[2:6, 2:6, 2:6] = 1
        self.write(vtkXMLImageDataWriter(), "map.vti", make_image(volume))
        return self.run_limited(self.path("map.vti"), "--list-labels", "--label-names",
                                self.path(name))

    def test_tables(self):
        most = 4 << 20
        for content in (b"\r\n" * (most // 2), b"1 " + b"a" * most, b"a,b\n" + b" " * most,
                        b'1,"' + b" " * most + b'"\n', b"1 a\r\n" * (most // 5),
                        b"\n".join(b"%d a" % k for k in range(most // 10)), b"[" * most,
                        b'{"a":' * (most // 5), b"[1," * (most // 10)):
            with self.subTest(content[:10]):
                self.assertIn(self.names("names.txt", content).returncode, (0, 1))

    def test_members_and_names_of_json(self):
        """Each member is looked for among all others; the names that were found, copied for each."""
        members = b"{" + b",".join(b'"%d":1' % k for k in range(300000)) + b"}"
        process = self.names("names.json", members)
        self.assertRegex(process.stderr, "volumic: .*names.json: .*more than 30000 members")
        names = b",".join([b'{"label":1,"name":"a"}'] * 10000)
        process = self.names("names.json", b"[[" + names + b"]" + b",0" * (2 << 20) + b"]")
        self.assertIn(process.returncode, (0, 1))

    def test_many_names_twice(self):
        """Those of the map and those of the file are put together."""
        count = 250000
        labels = b"".join(b'<Label Key="%d">a</Label>' % k for k in range(count))
        self.write_bytes("map.nii", labelled_nifti(labels))
        self.write_bytes("names.txt", b"\n".join(b"%d b" % -k for k in range(1, count)))
        process = self.run_limited(self.path("map.nii"), "--list-labels", "--label-names",
                                   self.path("names.txt"))
        self.assertEqual(process.returncode, 0, process.stderr[-500:])

    def test_extensions_of_nifti(self):
        most = 4 << 20
        for content in (b"<Label " * (most // 7) + b"></Label>",
                        b'<Label Key="1">' + b"&lt;" * (most // 4) + b"</Label>",
                        b'<Label Key="1">' + b"<![CDATA[" * (most // 9) + b"</Label>",
                        b"<Label >" * (most // 8) + b"</Label>"):
            with self.subTest(content[:20]):
                self.write_bytes("map.nii", labelled_nifti(content))
                process = self.run_limited(self.path("map.nii"), "--list-labels")
                self.assertEqual(process.returncode, 0, process.stderr[-500:])


if __name__ == "__main__":
    unittest.main()
