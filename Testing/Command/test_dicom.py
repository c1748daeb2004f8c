# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Tests of DICOM files of scanners and programs: irregular slices, several volumes, ignored and
truncated slices."""

import os
import struct

import numpy as np
from volumic import reading

from command_test_case import ISO, ORIGIN, SIZE, SPACING, TURNED, CommandTestCase, ball, dicom_slice

import medical_files

PIXELS = struct.pack("<HH", 0x7FE0, 0x10)


def item(content):
    return struct.pack("<HHI", 0xFFFE, 0xE000, len(content)) + content


def sequence(*items):
    """Return a sequence of undefined length."""
    return b"".join(map(item, items)) + struct.pack("<HHI", 0xFFFE, 0xE0DD, 0)


def element(group, number, kind, value):
    return medical_files.element(group, number, kind, value, True)


def position(k, aside=0.0):
    return (0x20, 0x32, "DS", medical_files.decimal(ORIGIN + [0, aside, k]))


class DicomTest(CommandTestCase):
    def series(self, numbers=range(SIZE[2]), name="IM{:02}", **changes):
        for k in numbers:
            self.write_bytes("a/" + name.format(k), dicom_slice(k, **changes))

    def write_bytes(self, name, content):
        os.makedirs(os.path.dirname(self.path(name)), exist_ok=True)
        return super().write_bytes(name, content)

    def read(self, name="a", **choice):
        return reading.read(self.path(name), **choice)

    def check(self, name="a", voxels=None, direction=np.eye(3), warning="^$", **choice):
        """Check that the ball is read at its position, with only this warning."""
        volume = self.read(name, **choice)
        np.testing.assert_array_equal(volume.array, ball() if voxels is None else voxels)
        np.testing.assert_allclose(volume.spacing, SPACING)
        np.testing.assert_allclose(volume.origin, ORIGIN)
        np.testing.assert_allclose(volume.direction, direction, atol=1e-9)
        self.assertEqual((volume.space, volume.unit), ("LPS", "mm"))
        self.assertRegex("; ".join(volume.warnings), warning)

    def rejects(self, reason, name="a", **choice):
        with self.assertRaises(reading.VolumeError) as caught:
            self.read(name, **choice)
        self.assertRegex(str(caught.exception), f"^{self.path(name)}: [^\n]*({reason})[^\n]*$")

    def rejects_slice(self, k, content, reason):
        self.write_bytes(f"a/IM{k:02}", content)
        self.rejects(f"IM{k:02}: .*({reason})")
        self.write_bytes(f"a/IM{k:02}", dicom_slice(k))


class SlicesTest(DicomTest):
    def test_slice_order(self):
        voxels = ball("u2") + 24
        for k, name in enumerate(np.random.default_rng(1).permutation(SIZE[2])):
            self.write_bytes(f"a/IM{name:03}.dcm", dicom_slice(k, voxels, TURNED, slope="1",
                                                               intercept="-24"))
        for name in ("a", "a/IM000.dcm", "a/IM*.dcm"):
            self.check(name, direction=TURNED)
        report = self.report(self.path("a"), "--iso", ISO)
        self.assertEqual((report["components"], report["input"]["range"]), (1, [0, 861]))
        self.assertTrue(0.94 < report["volume"] / (4 / 3 * np.pi * 4 ** 3) < 1)

    def test_a_missing_slice(self):
        self.series([k for k in range(SIZE[2]) if k != 9])
        volume = self.read()
        expected = ball().astype(float)
        expected[9] = (expected[8] + expected[10]) / 2
        np.testing.assert_allclose(volume.array, expected, atol=0.5)
        self.assertRegex(volume.warnings[0], "vary from 1 to 2 mm: missing slices.*resampled from "
                         "26 x 22 x 17 to 26 x 22 x 18")
        self.rejects("missing slices.*without --no-resampling", resampling=False)
        report = self.report(self.path("a"), "--iso", ISO)
        self.assertIn("resampled from", report["input"]["resampling"])

    def test_irregular_slice_distances(self):
        heights = np.linspace(0, 17, 18) + np.tile([0, 0.3], 9)
        for k, z in enumerate(heights):
            self.write_bytes(f"a/IM{k}", dicom_slice(k, lacks=("position",), more=(position(z),)))
        volume = self.read()
        self.assertEqual(volume.array.shape[0], 26)
        self.assertAlmostEqual(volume.spacing[2], 17.3 / 25)
        self.assertRegex(volume.warnings[0], "slice distances vary from 0.7 to 1.3 mm")
        middle = np.array([np.interp(17.3 / 25 * np.arange(26), heights, ball()[:, 12, x])
                           for x in range(SIZE[0])]).T
        np.testing.assert_allclose(volume.array[:, 12], middle, atol=0.51)

    def test_gantry_tilt(self):
        for k in range(SIZE[2]):
            # An object at a fixed position is shifted in each slice.
            shifted = np.roll(ball(), -(k // 3), axis=1)
            self.write_bytes(f"a/IM{k}", dicom_slice(k, shifted, lacks=("position",), more=(
                position(k, 0.75 * (k // 3)),)))
        volume = self.read()
        np.testing.assert_array_equal(volume.array[:, 5:17], ball()[:, 5:17])
        self.assertEqual(volume.array.shape, (18, 22 + 5, 26))
        self.assertRegex(volume.warnings[0], "gantry tilt: .* up to 0.75 mm")
        self.rejects("gantry tilt", resampling=False)

    def test_labels_of_tilted_slices_are_not_interpolated(self):
        for k in range(SIZE[2]):
            self.write_bytes(f"a/IM{k}", dicom_slice(k, np.where(ball() > ISO, 9, 0).astype("i2"),
                             lacks=("position",), more=(position(k, 0.2 * k),)))
        self.assertEqual(np.unique(self.read(labels=True).array).tolist(), [0, 9])

    def test_localizer_is_ignored(self):
        self.series()
        across = np.array([[0, 0, 1], [1, 0, 0], [0, 1, 0]])
        self.write_bytes("a/scout", dicom_slice(3, direction=across))
        self.check(warning="the position, .*of scout differs.*1 of 19 slices are ignored")
        for k in range(8):
            self.write_bytes(f"a/scout{k}", dicom_slice(k, direction=across))
        self.rejects("position, .*of scout differs from that of IM00; move")

    def test_nested_folders(self):
        for k in range(SIZE[2]):
            self.write_bytes(f"a/patient/study{k % 2}/IM{k}", dicom_slice(k))
        self.check()
        self.write_bytes("a/DICOMDIR", bytes(128) + b"DICM" + element(
            2, 2, "UI", "1.2.840.10008.1.3.10") + element(2, 0x10, "UI", medical_files.EXPLICIT)
            + element(4, 0x1130, "CS", "SET"))
        self.check()
        self.check("a/DICOMDIR")
        self.assertEqual(len(self.run_command(
            self.path("a"), "--list-files").stdout.splitlines()), SIZE[2] + 1)

    def test_several_times(self):
        self.series(more=((0x20, 0x13, "IS", "1"),))
        self.series(name="T{:02}", voxels=1000 - ball(), more=((0x20, 0x13, "IS", "2"),))
        self.rejects("2 volumes .*choose one with --time N, 0 to 1")
        self.check(time=0)
        self.check(time=1, voxels=1000 - ball())
        self.rejects("there is no time 2", time=2)
        printed = self.run_command(self.path("a"), "--list-series").stdout
        self.assertIn("36 slices of 26 x 22, 2 at each position (--time)", printed)

    def test_two_series_of_one_study(self):
        self.series(range(0, 18, 2))
        self.series(range(1, 18, 2), series="1.2.4")
        self.rejects(r"2 series; choose one with --series N: "
                     "1: head, 9 slices of 26 x 22, from IM00; 2: head, 9 slices of .*IM01")
        self.rejects("no series 3; choose one of 1: head", series=3)
        for name, series in (("a", "2"), ("a", "1.2.4"), ("a/IM01", None)):
            np.testing.assert_array_equal(self.read(name, series=series).array, ball()[1::2])
        listed = self.run_command(self.path("a"), "--list-series").stdout.splitlines()
        self.assertEqual(listed[1], "2: head, 9 slices of 26 x 22, from IM01, 1.2.4")

    def test_padding(self):
        voxels = ball().copy()
        voxels[:, :3, :] = -2000
        self.series(voxels=voxels, more=((0x28, 0x120, "US", struct.pack("<h", -2000)),))
        self.check(voxels=np.maximum(voxels, 0))
        self.series(voxels=voxels, intercept="-1024", more=(
            (0x28, 0x120, "US", struct.pack("<h", -2000)),))
        self.check(voxels=np.maximum(voxels, 0) - 1024)

    def test_copies_are_ignored(self):
        for k in range(SIZE[2]):
            content = dicom_slice(k, more=((8, 0x18, "UI", f"1.2.3.{k}"),))
            self.write_bytes(f"a/IM{k:02}", content)
            self.write_bytes(f"a/copies/IM{k:02}", content)
        self.check(warning="18 files are copies of others")

    def test_without_preamble(self):
        self.series()
        for k in range(SIZE[2]):
            self.write_bytes(f"a/IM{k:02}", dicom_slice(k)[132:])
            if k in (0, 17):
                self.check()

    def test_without_positions(self):
        for k in range(SIZE[2]):
            self.write_bytes(f"a/{k * 7 % 18:02}", dicom_slice(
                k, lacks=("position",), more=((0x20, 0x13, "IS", str(k)), (0x18, 0x50, "DS", "1"))))
        volume = self.read()
        np.testing.assert_array_equal(volume.array, ball())
        self.assertRegex(volume.warnings[0], "18 slices have no positions; .* distance of 1 mm")

    def test_without_pixel_spacing(self):
        for k in range(SIZE[2]):
            content = dicom_slice(k)
            at = content.index(struct.pack("<HH", 0x28, 0x30))
            value = content[at:at + 8 + content[at + 6]]
            content = content.replace(value, b"")
            before = content.index(struct.pack("<HH", 0x20, 0x32))
            imager = struct.pack("<HH", 0x18, 0x1164) + value[4:]
            self.write_bytes(f"a/IM{k:02}", content[:before] + imager + content[before:])
            self.write_bytes(f"b/IM{k:02}", content)
        self.check(warning="Imager Pixel Spacing of the detector, 0.75 x 0.5, is used")
        volume = self.read("b")
        self.assertEqual(volume.spacing, (1, 1, 1))
        self.assertRegex(volume.warnings[0], "no Pixel Spacing; 1 x 1 is used")


class FramesTest(DicomTest):
    def frames(self, more=(), shared=(), own=None, voxels=None, **changes):
        """Return a multi-frame file with functional groups."""
        voxels = ball() if voxels is None else voxels
        groups = [(0x5200, 0x9229, "SQ", sequence(b"".join(shared)))] if shared else []
        if own:
            groups.append((0x5200, 0x9230, "SQ", sequence(*own)))
        self.write_bytes("a/many.dcm", dicom_slice(
            0, frames=str(len(own or voxels)), data=voxels.astype("<u2").tobytes(),
            more=[*more, *groups], **changes))

    @staticmethod
    def plane_position(k):
        return element(0x20, 0x9113, "SQ", sequence(element(*position(k))))

    def test_enhanced(self):
        shared = [
            element(0x20, 0x9116, "SQ", sequence(element(0x20, 0x37, "DS", "1\\0\\0\\0\\1\\0"))),
            element(0x28, 0x9110, "SQ", sequence(element(0x28, 0x30, "DS", "0.75\\0.5"))),
            element(0x28, 0x9145, "SQ", sequence(element(0x28, 0x1052, "DS", "-100") +
                                                 element(0x28, 0x1053, "DS", "1")))]
        order = np.random.default_rng(1).permutation(SIZE[2])
        own = [self.plane_position(k) for k in order]
        self.frames(shared=shared, own=own, voxels=(ball() + 100)[order],
                    lacks=("position", "orientation"))
        self.check()
        self.check("a/many.dcm")
        self.frames(shared=shared, own=own[1:], voxels=(ball() + 100)[order])
        self.rejects("many.dcm: the file is too long")

    def segmentation(self, masks):
        """Return a file with a binary frame for each slice of two masks."""
        red = struct.pack("<3H", 34885, 53485, 50171)  # CIELab
        names = sequence(*(element(0x62, 4, "US", number) + element(0x62, 5, "LO", name) + (
            element(0x62, 0xD, "US", red) if number == 1 else b"")
                           for number, name in ((1, "liver"), (2, "spleen"))))
        own = [self.plane_position(k)
               + element(0x62, 0xA, "SQ", sequence(element(0x62, 0xB, "US", segment)))
               for segment in (1, 2) for k in range(SIZE[2])]
        self.frames(own=own, more=((8, 0x60, "CS", "SEG"), (0x62, 2, "SQ", names)), bits=1)
        bits = np.packbits(np.ravel(masks), bitorder="little").tobytes()
        content = self.content("a/many.dcm")
        at = content.rindex(PIXELS) + 8
        self.write_bytes("a/many.dcm", content[:at] + struct.pack("<I", len(bits)) + bits)

    def test_a_segmentation(self):
        whole, left = ball() > ISO, np.arange(SIZE[0]) < 8
        self.segmentation([whole & left, whole & ~left])
        self.check(voxels=np.where(whole, np.where(left, 1, 2), 0))
        listed = self.run_command(self.path("a"), "--list-labels").stdout
        self.assertRegex(listed, rf"(?m)^ *1\s+{(whole & left).sum()} .*liver$")
        self.assertRegex(listed, "(?m)^ *2 .*spleen$")
        np.testing.assert_allclose(self.read().labels[0].color, [1, 0, 0], atol=0.01)

    def test_overlapping_segments(self):
        masks = [ball() > 100, ball() > ISO]
        self.segmentation(masks)
        self.check(voxels=masks[0] + 1 * masks[1],
                   warning=f"overlap in {masks[1].sum()} voxels, which get the last")
        volume = self.read(layers=True)
        for label, mask in zip(volume.labels, masks):
            np.testing.assert_array_equal(volume.array[label.layer] == label.value, mask)


class DamageTest(DicomTest):
    def test_empty_slice_files(self):
        for name, k in (("IM{:02}", 0), ("s{:02}.dcm", 17), ("{:08X}", 17)):
            self.series(name=name)
            content, file = dicom_slice(k), name.format(k)
            for damaged in (content[:0], content[:131], content[:130] + b"?" + content[131:]):
                with self.subTest(file, bytes=len(damaged)):
                    self.write_bytes("a/" + file, damaged)
                    self.rejects(f"{file}: not a DICOM file")
            for file in os.listdir(self.path("a")):
                os.remove(self.path("a/" + file))

    def test_other_files_are_ignored(self):
        self.series()
        for name, content in (("README", b"read me"), ("notes.txt", b""), ("a.json", b"{}")):
            self.write_bytes("a/" + name, content)
        for name, kind in (("DICOMDIR", "1.2.840.10008.1.3.10"),
                           ("SR", "1.2.840.10008.5.1.4.1.1.88.11")):
            content = dicom_slice(0, kind=kind)
            self.write_bytes("a/" + name, content[:content.index(struct.pack("<HH", 0x28, 0x02))])
        self.check()

    def test_trailing_bytes(self):
        self.series()
        content = dicom_slice(17)
        pixels = content.index(PIXELS) + 12
        more = struct.pack("<HH2sHI", 0xFFFC, 0xFFFC, b"OB", 0, 4) + bytes(4)
        self.write_bytes("a/IM17", content + more)
        self.check()
        for offset, count in ((pixels, 2), (pixels + 500, 8), (len(content), 3)):
            self.rejects_slice(17, content[:offset] + b"\x07" * count + content[offset:],
                               "does not end after its pixels")
        self.rejects_slice(17, content[:pixels - 4] + struct.pack("<I", 572) + content[pixels:],
                           "does not end after its pixels")

    def test_invalid_headers(self):
        self.series()
        content = dicom_slice(3)
        rows = struct.pack("<HH2sH", 0x28, 0x10, b"US", 2)
        self.write_bytes("b/IM00", content.replace(rows + b"\x16", rows + b"\x28"))
        self.rejects("IM00: the file is truncated: it has 1144 bytes of voxels, .* 2080", "b")
        at = content.index(struct.pack("<HH", 0x0008, 0x1140)) + 12
        deep = content[:at] + struct.pack("<HHI", 0xFFFE, 0xE000, 0xFFFFFFFF) * 3000
        self.rejects_slice(3, deep, "truncated|damaged")
        for changes, reason in (({"bits": 32}, "the file is truncated"), ({"bits": 0}, "of 0 bits"),
                                ({"bits": 12}, "of 12 bits"), ({"samples": 3}, "3 components"),
                                ({"frames": "1A"}, "damaged or invalid .*1A"),
                                ({"slope": "1A"}, "damaged or invalid .*1A"),
                                ({"intercept": "1A"}, "damaged or invalid .*1A"),
                                ({"frames": "9999999"}, "9999999 frames")):
            with self.subTest(**changes):
                self.rejects_slice(3, dicom_slice(3, **changes), reason)
