# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Tests of volumic.read() for NIfTI, MGH, MINC, NRRD, MetaImage, NumPy and InVesalius: voxels,
positions, damaged files."""

import bz2
import gzip
import os
import struct
import zlib

import numpy as np

from command_test_case import META, ORIGIN, SIZE, SPACING, TURNED, ball, nrrd_header
from reading_test_case import ReadingTestCase, noisy_ball
from volumic import reading

import medical_files


def packed_meta(data):
    return META.replace(b"CompressedData = False", b"CompressedData = True") + zlib.compress(data)


class MetaImageTest(ReadingTestCase):
    def test_positions_and_types(self):
        header = META.replace(b"1 0 0 0 1 0 0 0 1", b"0 1 0 -1 0 0 0 0 1")
        volume = self.check(self.read("a.mha", header + ball().tobytes()), direction=TURNED)
        self.assertEqual((volume.space, volume.unit), ("LPS", ""))
        self.assertIsInstance(volume.array, np.memmap)
        long = header.replace(b"MET_SHORT", b"MET_LONG")  # four bytes on all systems
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
        self.rejects("a.mhd", "lists 17 files for 18 slices", listed[:-8])
        self.write_bytes("7.raw", b"half")
        self.rejects("a.mhd", "7.raw: the file is truncated", listed)
        os.remove(self.path("7.raw"))
        self.rejects("a.mhd", "No such file.*7.raw", listed)
        for words in ("%s.raw 1 18 1", "%d%d.raw 1 18 1", "%d.raw 1 5 1", "%d.raw 18 1 -1", "%",
                      "%09999999999d.raw 1 18 1", "%d" + "a" * 60000):
            self.rejects("b.mhd", "not specify 18|name too long", META.replace(b"LOCAL", words.encode()))

    def test_damage(self):
        content = META + noisy_ball().tobytes()
        self.rejects("a.mha", "too long: it has 20595 bytes", content + b"123")
        packed = packed_meta(noisy_ball().tobytes())
        for offset in np.random.default_rng(6).integers(len(META) + 1, len(packed), 30):
            flipped = bytearray(packed)
            flipped[offset] ^= 16
            self.rejects("b.mha", "damaged|truncated|exceed", flipped)
        for old, new, reason in (
                (b"26 22 18", b"65536 65536 4294967296", "truncated|invalid"),
                (b"0.5 0.75 1.0", b"0.5 0.75 0", "is not positive"),
                (b"0.5 0.75 1.0", b"0.5 0.75 600", "factor of 1000 .* set --spacing"),
                (b"-7.0", b"nan", "the origin nan x 8 x 9.5 is not finite"),
                (b"-7.0", b"1e20", "the origin 1e[+]20 x 8 x 9.5 is too far away")):
            self.rejects("a.mha", reason, content.replace(old, new))
        self.rejects("a.mha", "there is no time 99", content, time=99)
        self.rejects("a.mha", "there is no series 9", series=9)

    def test_text(self):
        header = META.replace(b"BinaryData = True", b"BinaryData = False")
        text = " ".join(map(str, ball().ravel())).encode()
        self.check(self.read("a.mha", header + text))
        self.rejects("a.mha", "it has 10297 values, its header requires 10296", header + b"5 " + text)
        self.rejects("a.mha", "damaged or invalid .*5x", header + b"5x " + text[2:])

    def test_negative_spacing(self):
        spacing = " ".join(map(str, SPACING)).encode()
        volume = self.read("b.mha", META.replace(spacing, spacing.replace(b" 1", b" -1"))
                           + ball().tobytes())
        last = volume.origin + volume.direction @ (np.array(volume.spacing) * (SIZE - 1))
        np.testing.assert_allclose(last, ORIGIN + SPACING * (SIZE - 1) * (1, 1, -1))


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
        with self.assertRaisesRegex(reading.VolumeError, "2 components .list. .* --component N, 0 to 1"):
            volume.scalars()
        self.assertEqual(self.read("a.nrrd", content.replace(b"list", b"vector") + first).components,
                         "vector")
        self.check(self.read("a.nrrd", component=1), both[1], spacing=(2, 3, 4), origin=(0, 0, 0))
        self.rejects("a.nrrd", "component 2 is out of range", component=2)
        content = head.format(sizes + " 2", "domain domain domain list", vectors + " none").encode()
        self.rejects("b.nrrd", "2 volumes .*choose one with --time", content + both.tobytes())
        volume = self.read("b.nrrd", time=1)
        self.check(volume, both[1], spacing=(2, 3, 4), origin=(0, 0, 0))
        self.assertEqual(volume.times, 2)

    def test_oblique_axes(self):
        header = nrrd_header(direction=np.array([[1, 0.5, 0], [0, 1, 0], [0, 0, 1]]))
        volume = self.read("a.nrrd", header + b"\n" + ball().tobytes())
        self.assertIn("26.565 degrees off orthogonal; resampled from 26 x 22 x 18 to 42 x 22 x 18",
                      volume.resampling)
        self.assertEqual(volume.warnings, [volume.resampling])
        self.rejects("a.nrrd", "off orthogonal; without --no-resampling", resampling=False)
        labels = self.read("a.nrrd", labels=True)
        self.assertLessEqual(set(np.unique(labels.array)), set(np.unique(ball())) | {0})

    def test_damage(self):
        data = noisy_ball().tobytes()
        self.rejects("a.nrrd", "too long", nrrd_header() + b"\n1" + data)
        for encoding, pack in (("gzip", gzip.compress), ("bzip2", bz2.compress)):
            self.rejects("b.nrrd", "exceed the 20592 bytes",
                         nrrd_header(encoding) + b"\n" + pack(data + b"more"))
        self.rejects("a.nrrd", "\"endiao\" is not a NRRD field",
                     nrrd_header().replace(b"endian", b"endiao") + b"\n" + data)


class NiftiTest(ReadingTestCase):
    matrix = np.column_stack([TURNED * SPACING, ORIGIN])

    def test_forms_and_scale(self):
        volume = self.read("a.nii", medical_files.nifti(ball(), SPACING, self.matrix))
        self.check(volume, direction=TURNED)
        self.assertEqual((volume.space, volume.unit, volume.times), ("RAS", "", 1))
        self.assertRegex(volume.warnings[0], "sform and qform differ and the sform is used")
        content = medical_files.nifti(ball(), SPACING, offset=ORIGIN, slope=0.5, intercept=-100)
        scaled = (ball() * np.float32(0.5) - 100).astype("f4")
        self.check(self.read("b.nii.gz", gzip.compress(content)), scaled)
        self.check(self.read("b.nii.bz2", bz2.compress(content)), scaled)
        content = bytearray(medical_files.nifti(ball(), SPACING, self.matrix))
        struct.pack_into("<f", content, 256, 2)  # a quaternion of length 2
        volume = self.check(self.read("d.nii", content), direction=TURNED)
        self.assertRegex(volume.warnings[0], "qform is not a rotation .*; the sform is used")
        struct.pack_into("<h", content, 254, 0)
        self.rejects("d.nii", "damaged or invalid .w2 should be positive", content)
        flat = np.array(self.matrix)
        flat[:, 0] = flat[:, 1]
        volume = self.read("c.nii", medical_files.nifti(ball(), SPACING, flat, offset=ORIGIN))
        self.check(volume)
        self.assertIn("parallel or zero", volume.warnings[0])

    def test_times(self):
        both = np.stack([ball(), ball() + 1])
        content = medical_files.nifti(both, SPACING, self.matrix)
        for name, packed in (("a.nii", content), ("a.nii.gz", gzip.compress(content))):
            self.rejects(name, "2 volumes in one file", packed)
            self.check(self.read(name, time=1), both[1], TURNED)
            self.rejects(name, "there is no time 2 .--time.; the file has times 0 to 1", time=2)

    def test_masks_of_one_file(self):
        masks = np.stack([ball() > 500, ball() < 0, ball() > 700]).astype("i2")
        volume = self.read("a.nii", medical_files.nifti(masks, SPACING, self.matrix), labels=True)
        np.testing.assert_array_equal(volume.array, np.where(masks[2], 3, masks[0]))
        self.assertRegex(" ".join(volume.warnings), "assigned to the smaller mask.*empty masks: volume 1")

    def test_masks_of_a_folder(self):
        os.mkdir(self.path("a"))
        organ, part, core = (ball() > value for value in (300, 700, 800))
        for name, mask in (("organ", organ), ("part", part), ("none", part * 0), ("core", core)):
            self.write_bytes(f"a/{name}.nii", medical_files.nifti(mask.astype("i2"), SPACING))
        volume = self.read("a", labels=True)
        np.testing.assert_array_equal(volume.array, np.where(core, 1, np.where(part, 4, organ * 3)))
        self.assertEqual(volume.names, {1: "core", 2: "none", 3: "organ", 4: "part"})
        self.assertRegex(" ".join(volume.warnings), f"{part.sum()} overlapping voxels "
                         ".core and organ .*, organ and part.*empty masks: none")
        volume = self.read("a", labels=True, layers=True)
        np.testing.assert_array_equal(volume.array, [core * 1, organ * 3, part * 4])
        self.assertEqual([(label.value, label.layer) for label in volume.labels],
                         [(1, 0), (2, 0), (3, 1), (4, 2)])
        self.write_bytes("a/other.nii", medical_files.nifti(organ[1:].astype("i2"), SPACING))
        self.rejects("a", "other.nii: the grid differs from that of core.nii", labels=True)
        self.write_bytes("a/other.nii", medical_files.nifti(ball(), SPACING))
        self.rejects("a", "other.nii: has the values .* but a mask has 0 and one other", labels=True)

    def test_damage(self):
        content = medical_files.nifti(noisy_ball(), SPACING)
        self.rejects("a.nii", "too long", content + b"1")
        for offset, value, reason in ((46, struct.pack("<h", 0), "dimensions 26 x 22 x 0"),
                                      (40, struct.pack("<h", 2), "too long"),
                                      (108, struct.pack("<f", 1e8), "truncated")):
            self.rejects("b.nii", reason, content[:offset] + value + content[offset + len(value):])

    def test_misleading_headers(self):
        nan = float("nan")
        signs = bytearray(medical_files.nifti(ball(), SPACING * (1, -1, 1), offset=ORIGIN))
        struct.pack_into("<h", signs, 252, 0)
        unit = bytearray(medical_files.nifti(ball(), SPACING, offset=ORIGIN))
        unit[123] = 3
        for content, warning in (
                (signs, r"corrected header: pixdim\[1,2,3\] should be positive"),
                (unit, "the unit is um, not mm; outputs and options use it unless --unit gives another"),
                (medical_files.nifti(ball(), SPACING, slope=nan, intercept=nan), "^$")):
            volume = self.read("a.nii", content)
            self.assertRegex(" ".join(volume.warnings), warning)
            np.testing.assert_array_equal(volume.array, ball())
            np.testing.assert_allclose(volume.spacing, SPACING)


class OtherFormatsTest(ReadingTestCase):
    def test_mgh(self):
        head = struct.pack(">7ih3f", 1, *SIZE, 1, 4, 0, 1, *SPACING)
        head += struct.pack(">12f", *TURNED.T.ravel(), *ORIGIN + TURNED @ (SPACING * SIZE / 2))
        content = head.ljust(284, b"\0") + ball(">i2").tobytes()
        for name, packed in (("a.mgh", content), ("a.mgz", gzip.compress(content))):
            volume = self.check(self.read(name, packed), direction=TURNED)
            self.assertEqual((volume.space, volume.unit), ("RAS", "mm"))
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
                file.createVariable(name, "d", ()).data[...] = value
        self.check(self.read("a.mnc"), ball("f4"))
        self.rejects("b.mnc", "crashed|cannot be read", b"\x89HDF\r\n\x1a\n" + bytes(range(256)) * 9)

    def test_numpy(self):
        voxels = ball("f4")
        for name, array in (("a", voxels), ("b", np.asfortranarray(voxels.T)), ("c", voxels[None])):
            np.save(self.path(name + ".npy"), array)
            self.check(self.read(name + ".npy"), voxels, spacing=(1, 1, 1), origin=(0, 0, 0))
        np.savez(self.path("d.npz"), x=voxels, y=voxels + 1)
        self.rejects("d.npz", "the arrays are x, y; choose one with --array")
        self.check(self.read("d.npz", array="y"), voxels + 1, spacing=(1, 1, 1), origin=(0, 0, 0))
        np.save(self.path("e.npy"), np.array([None]), allow_pickle=True)
        self.rejects("e.npy", "cannot be read")
        np.save(self.path("f.npy"), voxels[0])
        self.rejects("f.npy", "the shape is .22, 26., but a volume has three axes")

    def test_raw(self):
        for words, dtype in (("int16", "<i2"), ("float32,big", ">f4"), ("uint16,little", "<u2")):
            self.check(self.read("a.raw", ball(dtype).tobytes(), raw="26,22,18," + words),
                       ball(dtype.replace(">", "=")), spacing=(1, 1, 1), origin=(0, 0, 0))
        self.rejects("a.raw", "truncated", bytes(9), raw="26,22,18,int16")
        for words in ("26,22,int16", "26,22,0,int16", "26,22,18,int", "26,22,18,int16,middle"):
            self.rejects("a.raw", "is not three dimensions", raw=words)

    def test_invesalius(self):
        for dtype in ("int16", "uint8", "float32"):
            voxels = ball(dtype, 0.2 if dtype == "uint8" else 1)
            volume = self.read("a.inv3", medical_files.inv3(voxels, SPACING, dtype=dtype))
            self.check(volume, voxels, origin=(0, 0, 0))
            self.assertEqual((volume.space, volume.unit), ("LAS", "mm"))
        voxels = ("matrix.dat", noisy_ball().tobytes())
        for files, reason in (([voxels], "main.plist is missing"),
                              ([voxels, ("main.plist", b"<plist><dict>")], "damaged"),
                              ([voxels, ("main.plist", bytes(2 << 20))], "too large")):
            self.rejects("b.inv3", reason, medical_files.archive_of(files))

    def test_unknown_suffixes(self):
        self.check(self.read("a.1", META + ball().tobytes()))
        self.rejects("b.nii_old", "change its suffix", gzip.compress(medical_files.nifti(
            ball(), SPACING)))
        self.rejects("a.xyz", "unknown format", b"?")
        self.rejects("missing.vti", "no such file or folder")
