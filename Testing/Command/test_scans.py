# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Scans as scanners, networks and programs write them: what is no regular grid is resampled, of what
is several volumes one is chosen, and all is told."""

import gzip
import os
import re
import struct
import unittest

import numpy as np

from command_test_case import (
    CENTRE, ISO, META, ORIGIN, RADIUS, SIZE, SPACING, CommandTestCase, ball, dicom_slice)

import medical_files

BALL = 4 / 3 * np.pi * RADIUS ** 3


def item(content):
    return struct.pack("<HHI", 0xFFFE, 0xE000, len(content)) + content


def sequence(*items):
    """Of undefined length, as medical_files.element has it."""
    return b"".join(map(item, items)) + struct.pack("<HHI", 0xFFFE, 0xE0DD, 0)


def element(group, number, kind, value):
    return medical_files.element(group, number, kind, value, True)


def run_lengths(pixels):
    """As DICOM packs them: high and low bytes apart, all literal."""
    parts = []
    for high in (1, 0):
        data = pixels.astype("<u2").tobytes()[high::2]
        runs = b"".join(bytes([len(data[at:at + 128]) - 1]) + data[at:at + 128]
                        for at in range(0, len(data), 128))
        parts.append(runs + bytes(len(runs) % 2))
    return struct.pack("<16I", 2, 64, 64 + len(parts[0]), *[0] * 13) + b"".join(parts)


class ScanTest(CommandTestCase):
    def series(self, numbers=range(SIZE[2]), name="IM{:02}", **changes):
        for k in numbers:
            self.write_bytes("a/" + name.format(k), dicom_slice(k, **changes))

    def write_bytes(self, name, content):
        os.makedirs(os.path.dirname(self.path(name)), exist_ok=True)
        return super().write_bytes(name, content)

    def check(self, name, *options, centre=None, told="", shrink=0.94):
        """The ball is found where it is, with this warning alone."""
        report = self.report(self.path(name), "--iso", ISO, *options)
        centre = ORIGIN + SPACING * CENTRE if centre is None else centre
        np.testing.assert_allclose(report["component_features"][0]["centroid"], centre, atol=0.1)
        self.assertTrue(shrink < report["volume"] / BALL < 1.02, report["volume"] / BALL)
        said = self.run_command(self.path(name), self.path("o.vtp"), "--iso", ISO, *options).stderr
        warnings = re.findall("volumic: warning: (.*)", said)
        self.assertRegex("; ".join(warnings), told if told else "^$")
        return report


class ShearTest(ScanTest):
    LEANING = np.array([[1, 0.2, -0.1], [0, 1, 0.15], [0.02, 0, 1]]) * SPACING  # columns: steps

    def seen(self, steps):
        """A ball in the middle as voxels with these steps have it, and the place of that."""
        index = np.moveaxis(np.indices(tuple(SIZE[::-1])), 0, -1)[..., ::-1] - (SIZE - 1) / 2
        distance = np.linalg.norm(index @ steps.T, axis=-1)
        voxels = np.clip(ISO + 100 * (RADIUS - distance), 0, 1000).round().astype("i2")
        return voxels, ORIGIN + steps @ (SIZE - 1) / 2

    def test_of_each_axis(self):
        for form in (self.LEANING, self.LEANING[:, [1, 0, 2]], self.LEANING @ np.diag([1, 1, -1])):
            voxels, centre = self.seen(form)
            self.write_bytes("a/a.nii", medical_files.nifti(
                voxels, SPACING, np.column_stack([form, ORIGIN]), offset=(50, 60, 70)))
            self.write_bytes("a/b.nii.gz", gzip.compress(self.content("a/a.nii")))
            for name, way in (("a/a.nii", ()), ("a/b.nii.gz", ()), ("a/a.nii", ("--memory", "200M"))):
                self.check(name, *way, centre=centre, told="sform, which is taken.*its axes are "
                           "up to 11.* degrees from right angles; resampled from 26 x 22 x 18 to")
        self.refused_volume("a/a.nii", "without --no-resampling they are resampled", "--no-resampling")

    def test_labels_are_not_mixed(self):
        labels = np.where(self.seen(self.LEANING)[0] > ISO, 9, 0)
        self.write_bytes("a.nii", medical_files.nifti(
            labels, SPACING, np.column_stack([self.LEANING, ORIGIN])))
        said = self.run_command(self.path("a.nii"), "--list-labels").stdout
        self.assertEqual(re.findall(r"(?m)^ *(\d+) ", said), ["9"], said)

    def test_cells_of_mrc(self):
        lean = np.radians(80)
        steps = np.array([[1, 0, np.cos(lean)], [0, 1, 0], [0, 0, np.sin(lean)]]) * SPACING
        voxels, centre = self.seen(steps)
        content = bytearray(medical_files.mrc(voxels, SPACING))
        struct.pack_into("<f", content, 56, 80)
        self.write_bytes("a.mrc", content)
        self.check("a.mrc", centre=centre - ORIGIN, told="its axes are up to 10 degrees")
        self.refused_volume("a.mrc", "right angles; without", "--no-resampling")
        struct.pack_into("<fff", content, 52, 10, 80, 120)
        self.refused_bytes("a.mrc", bytes(content), "have no such angles")


class SlicesTest(ScanTest):
    def test_a_missing_slice(self):
        self.series([k for k in range(SIZE[2]) if k != 9])
        for way in ((), ("--memory", "200M")):
            report = self.check("a", *way, shrink=0.9,
                                told="1 to 2 mm apart: .*resampled from 26 x 22 x 17 to 26 x 22 x 18")
            self.assertEqual(report["input"]["dimensions"], SIZE.tolist())
        self.assertIn("resampled from", self.check("a", told="apart")["input"]["resampling"])
        self.refused_volume("a", "some are missing.*without --no-resampling", "--no-resampling")

    def test_uneven_distances(self):
        for k, z in enumerate(np.linspace(0, 17, 18) + np.tile([0, 0.3], 9)):
            position = medical_files.decimal(ORIGIN + [0, 0, z])
            self.write_bytes(f"a/IM{k}", dicom_slice(k, lacks=("position",), more=(
                (0x20, 0x32, "DS", position),)))
        report = self.check("a", told="slices are 0.7 to 1.3 mm apart",
                            centre=ORIGIN + SPACING * CENTRE + [0, 0, 0.15])
        self.assertAlmostEqual(report["input"]["spacing"][2], 17.3 / 25)

    def test_a_tilted_gantry(self):
        for k in range(SIZE[2]):
            # What lies at an even place is seen so much further up by each slice.
            shifted = np.roll(ball(), -(k // 3), axis=1)
            self.write_bytes(f"a/IM{k}", dicom_slice(k, shifted, lacks=("position",), more=(
                (0x20, 0x32, "DS", medical_files.decimal(
                    ORIGIN + [0, 0.75 * (k // 3), k])),)))
        report = self.check("a", told="gantry was tilted: .* up to 0.75 mm")
        self.assertEqual(report["input"]["dimensions"], [26, 22 + 5, 18])
        self.refused_volume("a", "gantry was tilted", "--no-resampling")

    def test_labels_of_tilted_slices_are_not_mixed(self):
        for k in range(SIZE[2]):
            self.write_bytes(f"a/IM{k}", dicom_slice(k, np.where(ball() > ISO, 9, 0).astype("i2"),
                lacks=("position",), more=((0x20, 0x32, "DS", medical_files.decimal(
                    ORIGIN + [0, 0.2 * k, k])),)))
        said = self.run_command(self.path("a"), "--list-labels", "--labels", "all").stdout
        self.assertEqual(re.findall(r"(?m)^ *(\d+) ", said), ["9"], said)

    def test_a_localizer_among_them(self):
        self.series()
        across = np.array([[0, 0, 1], [1, 0, 0], [0, 1, 0]])
        self.write_bytes("a/scout", dicom_slice(3, direction=across))
        self.check("a", told="scout: its place, .*1 of 19 slices are left out")

    def test_folders_within_folders(self):
        for k in range(SIZE[2]):
            self.write_bytes(f"a/patient/study{k % 2}/IM{k}", dicom_slice(k))
        self.check("a")
        self.write_bytes("a/DICOMDIR", bytes(128) + b"DICM" + element(
            2, 2, "UI", "1.2.840.10008.1.3.10") + element(2, 0x10, "UI", medical_files.EXPLICIT)
            + element(4, 0x1130, "CS", "SET"))
        self.check("a")
        self.assertEqual(len(self.run_command(
            self.path("a"), "--list-files").stdout.splitlines()), SIZE[2] + 1)

    def test_several_times(self):
        self.series(more=((0x20, 0x13, "IS", "1"),))
        self.series(name="T{:02}", voxels=1000 - ball(), more=((0x20, 0x13, "IS", "2"),))
        self.refused_volume("a", "2 volumes, .*choose one with --time N, 0 to 1")
        self.check("a", "--time", "0")
        self.assertEqual(self.report(self.path("a"), "--iso", ISO, "--dark", "--phase", "1")["genus"], 0)
        said = self.run_command(self.path("a"), "--list-series").stdout
        self.assertIn("36 slices of 26 x 22, 2 at each place (--time)", said)
        self.refused_volume("a", "there is no time 2", "--time", "2")

    def test_padding(self):
        voxels = ball().copy()
        voxels[:, :3, :] = -2000
        self.series(voxels=voxels, more=((0x28, 0x120, "US", struct.pack("<h", -2000)),))
        self.assertEqual(self.check("a")["input"]["range"], [0, 861])


class PixelsTest(ScanTest):
    def test_packed_by_run_lengths(self):
        fragments = [struct.pack("<HHI", 0xFFFE, 0xE000, 0)]
        for k in range(SIZE[2]):
            pixels = b"".join(fragments) + item(run_lengths(ball()[k])) + struct.pack(
                "<HHI", 0xFFFE, 0xE0DD, 0)
            content = dicom_slice(k, syntax="1.2.840.10008.1.2.5", data=pixels)
            at = content.rindex(struct.pack("<HH", 0x7FE0, 0x10)) + 8
            self.write_bytes(f"a/IM{k}", content[:at] + b"\xff" * 4 + content[at + 4:])
        self.check("a")
        damaged = bytearray(content)
        damaged[at + 4 + 8 + 8 + 4] = 0xff  # where its second part begins
        self.write_bytes("a/IM17", bytes(damaged))
        self.refused_volume("a", "IM17: (its pixels cannot be unpacked|the file is too long)")

    def frames(self, more=(), shared=(), own=None, voxels=None, **changes):
        """A file of several frames with functional groups."""
        voxels = ball() if voxels is None else voxels
        groups = [(0x5200, 0x9229, "SQ", sequence(b"".join(shared)))] if shared else []
        if own:
            groups.append((0x5200, 0x9230, "SQ", sequence(*own)))
        content = dicom_slice(0, frames=str(len(own or voxels)), data=voxels.astype("<u2").tobytes(),
                              more=[*more, *groups], **changes)
        self.write_bytes("a/many.dcm", content)

    @staticmethod
    def place(k):
        position = element(0x20, 0x32, "DS", medical_files.decimal(ORIGIN + [0, 0, k]))
        return element(0x20, 0x9113, "SQ", sequence(position))

    def test_enhanced(self):
        shared = [
            element(0x20, 0x9116, "SQ", sequence(element(0x20, 0x37, "DS", "1\\0\\0\\0\\1\\0"))),
            element(0x28, 0x9110, "SQ", sequence(element(0x28, 0x30, "DS", "0.75\\0.5"))),
            element(0x28, 0x9145, "SQ", sequence(element(0x28, 0x1052, "DS", "-100") +
                                                 element(0x28, 0x1053, "DS", "1")))]
        order = np.random.default_rng(1).permutation(SIZE[2])
        self.frames(shared=shared, own=[self.place(k) for k in order], voxels=(ball() + 100)[order],
                    lacks=("position", "orientation"))
        self.check("a")
        self.check("a/many.dcm")
        self.check("a", "--memory", "200M")
        self.frames(shared=shared, own=[self.place(k) for k in order[1:]], voxels=(ball() + 100)[order])
        self.refused_volume("a", "many.dcm: the file is too long|resampled|lies where")

    def test_frames_without_places(self):
        self.frames(more=((0x18, 0x88, "DS", "1"),))
        self.check("a", told="18 frames tell no places; .* 1 mm apart")

    def test_a_segmentation(self):
        names = sequence(*(element(0x62, 4, "US", number) + element(0x62, 5, "LO", name)
                           for number, name in ((1, "liver"), (2, "spleen"))))
        own = [self.place(k) + element(0x62, 0x0A, "SQ", sequence(element(0x62, 0x0B, "US", segment)))
               for segment in (1, 2) for k in range(SIZE[2])]
        object_ = ball() > ISO
        left = np.arange(SIZE[0]) < 8
        voxels = np.concatenate([object_ & left, object_ & ~left])
        bits = np.packbits(voxels.ravel(), bitorder="little").tobytes()
        self.frames(own=own, more=((8, 0x60, "CS", "SEG"), (0x62, 2, "SQ", names)), bits=1)
        content = self.content("a/many.dcm")
        at = content.rindex(struct.pack("<HH", 0x7FE0, 0x10)) + 8
        self.write_bytes("a/many.dcm", content[:at] + struct.pack("<I", len(bits)) + bits)
        listed = self.run_command(self.path("a"), "--list-labels").stdout
        self.assertRegex(listed, rf"(?m)^ *1\s+{(object_ & left).sum()} .*liver$")
        self.assertRegex(listed, "(?m)^ *2 .*spleen$")


class OtherFilesTest(ScanTest):
    def test_several_volumes_in_one_file(self):
        both = np.stack([ball(), 0 * ball(), ball()])
        self.write_bytes("a/a.nii", medical_files.nifti(both, SPACING, offset=ORIGIN))
        self.write_bytes("a/b.nii.gz", gzip.compress(self.content("a/a.nii")))
        header = META.replace(b"NDims = 3", b"NDims = 4").replace(b"26 22 18", b"26 22 18 3")
        self.write_bytes("a/c.mha", header + both.tobytes())
        for name in ("a.nii", "b.nii.gz", "c.mha"):
            with self.subTest(name):
                self.refused_volume("a/" + name, "3 volumes, .*--time N, 0 to 2")
                for way in ((), ("--memory", "200M")):
                    self.check("a/" + name, "--time", "0", *way)
                    self.check("a/" + name, "--time", "2", *way)
        self.write_bytes("a/d.mha", header + both.tobytes()[:-10])
        self.refused_volume("a/d.mha", "cut off", "--time", "0")

    def test_analyze(self):
        content = medical_files.nifti(ball(), SPACING, offset=ORIGIN)
        self.write_bytes("a/a.hdr", content[:344] + b"ni1\0")
        self.write_bytes("a/a.img", bytes(352) + content[352:])
        for name in ("a.hdr", "a.img"):
            self.check("a/" + name)

    def test_numpy(self):
        for name, voxels in (("a", ball()), ("b", np.asfortranarray(ball().transpose())),
                             ("c", ball(">f8"))):
            np.save(self.path(name + ".npy"), voxels)
            self.check(name + ".npy", "--spacing", "0.5,0.75,1", centre=SPACING * CENTRE)
        np.save(self.path("d.npy"), ball()[0])
        self.refused_volume("d.npy", "its shape is .22, 26.; a volume has three")
        self.write_bytes("e.npy", self.content("a.npy")[:-1])
        self.refused_volume("e.npy", "cut off")

    def test_raw(self):
        self.write_bytes("a.raw", ball(">i2").tobytes())
        self.check("a.raw", "--raw", "26,22,18,int16,big", "--spacing", "0.5,0.75,1",
                   centre=SPACING * CENTRE)
        self.refused_volume("a.raw", "give its sizes and type with --raw")
        self.refused_volume("a.raw", "cut off", "--raw", "26,22,19,int16")
        self.refused_volume("a.raw", "'int17' are not read", "--raw", "26,22,18,int17")

    def test_freesurfer(self):
        header = struct.pack(">7i", 1, *map(int, SIZE), 1, 4, 0) + struct.pack(
            ">h15f", 1, *SPACING, 1, 0, 0, 0, 1, 0, 0, 0, 1, *(ORIGIN + SPACING * SIZE / 2))
        content = header.ljust(284, b"\0") + ball(">i2").tobytes() + bytes(20)
        self.write_bytes("a.mgz", gzip.compress(content))
        self.write_bytes("b.mgh", content)
        for name in ("a.mgz", "b.mgh"):
            for way in ((), ("--memory", "200M")):
                self.check(name, *way)
        self.write_bytes("c.mgz", gzip.compress(content[:5000]))
        self.refused_volume("c.mgz", "cut off")


if __name__ == "__main__":
    unittest.main()
