# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Tests of MRC, TIFF, pictures and OME-Zarr: voxels, positions, units, ignored and missing
files."""

import os
import struct
import unittest

import numpy as np

from command_test_case import ISO, SIZE, SPACING, CommandTestCase, ball
from reading_test_case import ReadingTestCase

import medical_files
import test_ome_zarr
from test_ome_zarr import zarr

BALL = ball("u2")
BYTES = ball("u1", scale=0.2)
try:
    import tifffile
except ImportError:
    tifffile = None
try:
    from PIL import Image
except ImportError:
    Image = None


class MicroscopyTestCase(ReadingTestCase):
    def check(self, volume, voxels=None, direction=np.eye(3), spacing=(1, 1, 1), origin=(0, 0, 0)):
        return super().check(volume, BALL if voxels is None else voxels, direction, spacing, origin)


class MrcTest(MicroscopyTestCase):
    def test_modes(self):
        for mode, voxels in ((0, (ball() // 8 - 60).astype("i1")), (1, ball()), (2, ball("f4")),
                             (6, BALL + 40000)):
            volume = self.read("a.mrc", medical_files.mrc(voxels, SPACING, mode))
            self.check(volume, voxels, spacing=SPACING)
            self.assertEqual((volume.space, volume.unit), ("", "A"))
        content = bytearray(medical_files.mrc(BYTES, SPACING, 0))
        struct.pack_into("<II", content, 152, 1146047817, 0)  # IMOD: unsigned bytes
        self.check(self.read("a.mrc", content), BYTES, spacing=SPACING)
        colors = np.stack([BYTES, BYTES // 2, BYTES // 3], -1)
        volume = self.read("a.mrc", medical_files.mrc(BYTES, SPACING, 16)[:1024] + colors.tobytes())
        self.check(volume, np.moveaxis(colors, -1, 0), spacing=SPACING)
        self.assertEqual(volume.components, "color")
        for mode, reason in ((101, "mode 101 .*convert it to mode 2"), (77, "mode 77")):
            self.rejects("b.mrc", reason, medical_files.mrc(ball(), SPACING, mode))

    def test_axes_and_origin(self):
        content = bytearray(medical_files.mrc(ball(), SPACING, order=(3, 2, 1)))
        struct.pack_into("<3f", content, 196, 9, 8, 7)
        volume = self.read("a.mrc", content)
        self.check(volume, ball(), np.eye(3)[:, ::-1], SPACING[::-1], (9, 8, 7))
        struct.pack_into("<3i", content, 16, 2, 0, 0)  # the first column is the second one along z
        self.assertEqual(self.read("a.mrc", content).origin, (9, 8, 7 + 2 * SPACING[2]))

    def test_oblique_cells(self):
        content = bytearray(medical_files.mrc(ball(), SPACING))
        struct.pack_into("<f", content, 56, 80)
        volume = self.read("a.mrc", content)
        self.assertRegex(volume.resampling, "axes are up to 10 degrees off orthogonal")
        np.testing.assert_allclose(volume.spacing[2], np.sin(np.radians(80)), rtol=1e-6)
        self.rejects("a.mrc", "off orthogonal; without", resampling=False)
        struct.pack_into("<fff", content, 52, 10, 80, 120)
        self.rejects("a.mrc", "invalid header: .*angles 10, 80, 120", content)

    def test_several_volumes(self):
        content = bytearray(medical_files.mrc(np.concatenate([ball(), ball() + 1]), SPACING))
        struct.pack_into("<i", content, 36, SIZE[2])
        struct.pack_into("<ff", content, 48, SIZE[2], 90)
        struct.pack_into("<i", content, 88, 401)
        self.rejects("a.mrc", "2 volumes", content)
        self.check(self.read("a.mrc", time=1), ball() + 1, spacing=SPACING)


@unittest.skipUnless(tifffile, "no tifffile (Debian: python3-tifffile)")
class TiffTest(MicroscopyTestCase):
    def written(self, voxels=BALL, name="a.tif", choice=None, **options):
        tifffile.imwrite(self.path(name), voxels, **options)
        return self.read(name, **(choice or {}))

    def test_pixel_types(self):
        self.check(self.written(metadata=None, bigtiff=True, byteorder=">", compression="zlib"))
        for voxels in (ball("f4"), ball("f8"), ball(), BYTES):
            self.check(self.written(voxels, metadata=None), voxels)
        self.check(self.written(ball("f2"), metadata=None), ball("f4"))
        self.check(self.written(65535 - BALL, metadata=None, photometric="miniswhite"))
        self.check(self.written(ball() > ISO, metadata=None, photometric="minisblack"),
                   (ball() > ISO).astype("u1"))
        volume = self.written(np.stack([BYTES] * 3, -1), metadata=None, photometric="rgb")
        self.check(volume, np.stack([BYTES] * 3))
        self.assertEqual(volume.components, "color")

    def test_cyclic_pages(self):
        self.written(metadata=None)
        with tifffile.TiffFile(self.path("a.tif")) as file:
            first, last = file.pages[0].offset, file.pages[-1].offset
        content = bytearray(self.content("a.tif"))
        tags, = struct.unpack_from("<H", content, last)
        struct.pack_into("<I", content, last + 2 + 12 * tags, first)
        self.rejects("a.tif", "page directories form a cycle", bytes(content))

    def test_imagej(self):
        volume = self.written(imagej=True, resolution=(2, 2),
                              metadata={"axes": "ZYX", "spacing": 2.5, "unit": "um"})
        self.check(volume, spacing=(0.5, 0.5, 2.5))
        self.assertEqual(volume.unit, "um")
        both = {"imagej": True, "metadata": {"axes": "ZCYX"}}
        volume = self.written(np.stack([BALL, BALL + 1], 1), **both)
        self.check(volume, np.stack([BALL, BALL + 1]))
        self.assertEqual(volume.components, "channels")
        self.check(self.read("a.tif", component=1), BALL + 1)
        times = {"imagej": True, "metadata": {"axes": "TZYX"}}
        self.check(self.written(np.stack([BALL, BALL + 1]), choice={"time": 1}, **times), BALL + 1)
        self.rejects("a.tif", "2 volumes .*choose one with --time N, 0 to 1")

    def test_ome(self):
        metadata = {"axes": "CZYX", "PhysicalSizeX": 0.5, "PhysicalSizeY": 250, "PhysicalSizeZ": 2,
                    "PhysicalSizeYUnit": "nm"}
        volume = self.written(np.stack([BALL, BALL + 1]), "a.ome.tif", ome=True, metadata=metadata)
        self.check(volume, np.stack([BALL, BALL + 1]), spacing=(0.5, 0.25, 2))
        self.assertEqual((volume.unit, volume.components), ("um", "channels"))
        for axes in ("TZCYX", "CTZYX"):
            voxels = np.stack([BALL, BALL + 1, BALL + 2, BALL + 3]).reshape(2, 2, *BALL.shape)
            self.written(np.moveaxis(voxels, 1, 2) if axes[0] == "T" else voxels.swapaxes(0, 1),
                         "b.ome.tif", {"time": 1}, ome=True, metadata={"axes": axes})
            self.check(self.read("b.ome.tif", time=1), voxels[1])

    def test_zeiss(self):
        info = struct.pack("<10i6d", 67127628, 500, *map(int, SIZE), 1, 1, 2, 8, 8,
                           5e-7, 5e-7, 2e-6, 0, 0, 0).ljust(500, b"\0")
        with tifffile.TiffWriter(self.path("a.lsm")) as file:
            for k, plane in enumerate(BALL):
                file.write(plane, metadata=None, photometric="minisblack",
                           extratags=[(34412, 1, 500, info, True)] if k == 0 else [])
                file.write(plane[:8, :8], metadata=None, photometric="minisblack", subfiletype=1)
        volume = self.check(self.read("a.lsm"), spacing=(0.5, 0.5, 2))
        self.assertEqual(volume.unit, "um")

    def test_reduced_pages_are_ignored(self):
        with tifffile.TiffWriter(self.path("a.tif")) as file:
            file.write(BALL, metadata=None, photometric="minisblack")
            file.write(BALL[0, :8, :8], metadata=None, photometric="minisblack", subfiletype=1)
        self.check(self.read("a.tif"))
        with tifffile.TiffWriter(self.path("a.ome.tif")) as file:
            file.write(BALL, subifds=1, metadata={"axes": "ZYX"})
            file.write(BALL[:, ::2, ::2], subfiletype=1)
        self.check(self.read("a.ome.tif"))


@unittest.skipUnless(Image, "no Pillow (Debian: python3-pil)")
class PicturesTest(MicroscopyTestCase):
    def pictures(self, folder="a", name="slice{}.png", voxels=BALL, **options):
        os.makedirs(self.path(folder), exist_ok=True)
        for k, plane in enumerate(voxels):
            Image.fromarray(plane).save(self.path(f"{folder}/{name.format(k)}"), **options)

    def test_a_folder_or_a_pattern(self):
        self.pictures()  # slice9 precedes slice10
        self.check(self.read("a"))
        self.pictures(name="slice{}.tif")
        self.rejects("a", r"several name patterns: .*'slice\*\.tif'")
        for pattern in ("slice*.tif", "slice%d.tif", "*.png"):
            self.check(self.read("a/" + pattern))
        for suffix in ("bmp", "pgm"):
            self.pictures(suffix, "{:03}." + suffix, BYTES)
            self.check(self.read(suffix), BYTES)
        self.pictures("jpg", "{:03}.jpg", BYTES, quality=95)
        self.assertLess(np.abs(self.read("jpg").array.astype(int) - BYTES).max(), 30)
        colors = np.stack([BYTES] * 3, -1)
        self.pictures("rgb", "{}.png", colors)
        self.assertEqual(self.read("rgb").components, "color")
        self.pictures("rgba", "{}.png", np.stack([BYTES] * 4, -1))
        self.assertEqual(self.read("rgba").components, "color and alpha")

    def test_other_files_are_ignored(self):
        for stranger, plane in (("sample_rec_spr.png", BALL[9]), ("overview.png", BALL[9]),
                                ("preview.png", BALL[0, :9]), ("sample_rec0100.png", BALL[0, :9])):
            with self.subTest(stranger):
                folder = stranger[:-4]
                self.pictures(folder, "sample_rec{:04}.png")
                self.write_text(folder + "/log.txt", "bright")
                Image.fromarray(plane).save(self.path(f"{folder}/{stranger}"))
                volume = self.check(self.read(folder))
                self.assertRegex(volume.warnings[0], "are ignored: .*" + stranger)
                self.assertIn("log.txt", volume.warnings[0])
                self.assertEqual(len(volume.warnings), 1)

    def test_gaps_in_numbers_are_reported(self):
        self.pictures()
        for k in (3, 7, 8, 9, 17):
            os.remove(self.path(f"a/slice{k}.png"))
        volume = self.read("a")
        self.check(volume, np.delete(BALL, (3, 7, 8, 9, 17), 0))
        self.assertRegex(volume.warnings[0], r"gaps \(3, 7 to 9\): slices are missing")
        self.pictures("b", "{}.png", np.repeat(BALL, 2, 0))
        for k in range(0, 36, 2):
            os.remove(self.path(f"b/{k}.png"))  # a constant step has no gaps
        self.assertEqual(self.check(self.read("b")).warnings, [])

    def test_mixed_sizes_fail(self):
        self.pictures()
        self.pictures(name="slice{:03}.png", voxels=BALL[:9, :9])
        self.rejects("a", "slice000.png: size or pixel type differs from that of slice0.p")

    def test_palettes(self):
        labels = (ball() > ISO).astype("u1")
        labels[:8] *= 3
        for suffix in ("png", "bmp"):
            os.makedirs(self.path(suffix))
            for k, plane in enumerate(labels):
                image = Image.fromarray(plane, "P")
                image.putpalette([0, 0, 0, 250, 0, 0, 0, 0, 0, 250, 0, 0] + [7] * 756)
                image.save(self.path(f"{suffix}/{k}.{suffix}"))
            self.check(self.read(suffix, labels=True), labels)
            volume = self.read(suffix)
            self.assertRegex(volume.warnings[0], "palette colours are read; use --labels")
            np.testing.assert_array_equal(volume.array[0], np.where(labels, 250, 0))

    @unittest.skipUnless(tifffile, "no tifffile (Debian: python3-tifffile)")
    def test_pages_in_a_folder(self):
        os.makedirs(self.path("a"))
        tifffile.imwrite(self.path("a/a.tif"), BALL, metadata=None)
        self.rejects("a", "a.tif: 18 pages, a volume; give the name")


@unittest.skipUnless(zarr, "no zarr (Debian: python3-zarr)")
class OmeZarrTest(MicroscopyTestCase, CommandTestCase):
    """See also ../Python/test_ome_zarr.py."""

    def image(self, voxels=BALL, names="zyx"):
        """Write an OME-Zarr image with one level."""
        options = {} if zarr.__version__.startswith("2.") else {"zarr_format": 2}
        group = zarr.open_group(self.path("a.ome.zarr"), mode="w", **options)
        test_ome_zarr.add_array(group, "0", voxels)
        steps = {"z": 2, "y": 0.75, "x": 0.5}
        test_ome_zarr.describe(group, names, [("0", [
            {"type": "scale", "scale": [steps.get(name, 1) for name in names]}])])

    def test_channels_and_times(self):
        voxels = np.stack([BALL, BALL + 1, BALL + 2, BALL + 3]).reshape(2, 2, *BALL.shape)
        self.image(voxels, "tczyx")
        self.rejects("a.ome.zarr", "2 volumes .*--time N, 0 to 1")
        volume = self.check(self.read("a.ome.zarr", time=1), voxels[1], spacing=(0.5, 0.75, 2))
        self.assertEqual((volume.components, volume.unit), ("channels", "um"))
        self.check(self.read("a.ome.zarr", time=0, component=1), voxels[0, 1],
                   spacing=(0.5, 0.75, 2))

    def test_by_the_command(self):
        self.image()
        report = self.report(self.path("a.ome.zarr"), "--iso", ISO)
        self.assertEqual((report["components"], report["input"]["dimensions"]), (1, SIZE.tolist()))
        printed = self.run_command(self.path("a.ome.zarr/0"), self.path("o.stl"), status=1).stderr
        self.assertRegex(printed, "the array of a level; open the group that contains it, .*a.ome.zarr\n")

    def test_missing_and_truncated_chunks(self):
        self.image(np.random.default_rng(3).integers(1, 9999, BALL.shape).astype("u2"))
        chunk = self.path("a.ome.zarr/0/1.1.1")
        if not os.path.exists(chunk):
            chunk = self.path("a.ome.zarr/0/1/1/1")
        with open(chunk, "rb") as file:
            content = file.read()
        for size in (0, 20, len(content) - 40):
            with open(chunk, "wb") as file:
                file.write(content[:size])
            self.rejects("a.ome.zarr", "truncated|damaged")
        os.remove(chunk)
        volume = self.read("a.ome.zarr")
        self.assertRegex(volume.warnings[0], "1 of 8 chunks have no file; .* fill value 0")
        self.assertEqual(np.count_nonzero(volume.array == 0), 2 * 6 * 10)
