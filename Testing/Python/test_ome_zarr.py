# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Tests of volumic.ome_zarr: images, levels and label maps, and their coordinates."""

import os
import pickle
import sys
import unittest
import unittest.mock

import numpy as np
import volumic
from volumic import ome_zarr, tasks

from folder_test_case import FolderTestCase
from sample_volumes import ring_voxels

try:
    import fsspec
    import zarr
except ImportError:
    zarr = None


def axes(names, *units):
    kinds, units = {"t": "time", "c": "channel", "a": "angle"}, units or ["micrometer"] * 3
    spatial = dict(zip([name for name in names if name not in kinds], units))
    return [{"name": name, "type": kinds[name]} if name in kinds
            else {"name": name, "type": "space", "unit": spatial[name]} for name in names]


def add_array(group, name, voxels):
    create = getattr(group, "create_array", None) or group.create_dataset
    create(name, shape=voxels.shape, chunks=(1,) * (voxels.ndim - 3) + (16, 16, 16),
           dtype=voxels.dtype)[...] = voxels


def describe(group, names, levels, **more):
    group.attrs["multiscales"] = [{
        "version": "0.4", "axes": axes(names), "datasets": [
            {"path": path, "coordinateTransformations": steps} for path, steps in levels], **more}]


def write_labels(path, name, voxels):
    """Write an image that has only labels."""
    labels = zarr.open_group(path, mode="w").create_group("labels")
    labels.attrs["labels"] = [name]
    group = labels.create_group(name)
    add_array(group, "0", voxels.astype("u2"))
    describe(group, "zyx", [("0", [{"type": "scale", "scale": [1, 1, 1]}])])


@unittest.skipUnless(zarr, "no zarr (Debian: python3-zarr)")
class OmeZarrTest(FolderTestCase):
    def setUp(self):
        super().setUp()
        options = {} if zarr.__version__.startswith("2.") else {"zarr_format": 2}
        self.root = zarr.open_group(self.path("scan.zarr"), mode="w", **options)
        ring = ring_voxels()
        add_array(self.root, "0", np.stack([[0 * ring, ring]]))
        add_array(self.root, "1", np.stack([[0 * ring, ring]])[..., ::2, ::2, ::2])
        describe(self.root, "tczyx", [
            ("0", [{"type": "scale", "scale": [1, 1, 3, 1, 2]},
                   {"type": "translation", "translation": [0, 0, 30, 10, 20]}]),
            ("1", [{"type": "scale", "scale": [1, 1, 6, 2, 4]}])],
                 coordinateTransformations=[{"type": "scale", "scale": [9, 1, 0.5, 0.5, 0.5]}])
        labels = self.root.create_group("labels")
        labels.attrs["labels"] = ["cells"]
        cells = labels.create_group("cells")
        add_array(cells, "0", (ring > 125).astype("u4") * 5)
        describe(cells, "zyx", [("0", [{"type": "scale", "scale": [1, 1, 1]}])])

    def test_levels_and_coordinates(self):
        volume = ome_zarr.open(self.path("scan.zarr"), channel=1)
        self.assertEqual((volume.shape, volume.chunks), ((40, 40, 40), (16, 16, 16)))
        self.assertEqual((volume.spacing, volume.origin), ((1, 0.5, 1.5), (10, 5, 15)))
        self.assertEqual((volume.unit, volume.nanometers), ("micrometer", 1000))
        np.testing.assert_array_equal(volume[3:9, :, 4], ring_voxels()[3:9, :, 4])
        np.testing.assert_array_equal(np.asarray(volume), ring_voxels())
        coarse = ome_zarr.open(self.path("scan.zarr"), 1, channel=1)
        self.assertEqual((coarse.spacing, coarse.origin), ((2, 1, 3), (0, 0, 0)))
        self.assertEqual(ome_zarr.open(self.path("scan.zarr"))[:].max(), 0)
        surface = volumic.surface(volume, 125.5, spacing=volume.spacing, origin=volume.origin)
        np.testing.assert_allclose(surface.points.mean(axis=0), [29.5, 14.75, 44.25], atol=0.5)

    def test_label_map_as_source_of_a_job(self):
        self.assertEqual(ome_zarr.label_names(self.path("scan.zarr")), ["cells"])
        cells = ome_zarr.open(self.path("scan.zarr"), label="cells")
        cells = pickle.loads(pickle.dumps(cells))  # as workers get it
        row, = tasks.Job(cells, self.path("meshes"), formats=["precomputed"]).run()
        self.assertEqual((row["Label"], row["Voxels"]), (5, np.count_nonzero(ring_voxels() > 125)))

    def test_fsspec_urls(self):
        there = fsspec.filesystem("memory")
        there.put(self.path("scan.zarr"), "/scan.zarr", recursive=True)
        self.addCleanup(there.rm, "/scan.zarr", recursive=True)
        cells = ome_zarr.open("memory://scan.zarr", label="cells")
        self.assertEqual(np.unique(cells[:]).tolist(), [0, 5])

    def test_other_versions_of_ome_zarr(self):
        old = zarr.open_group(self.path("old.zarr"), mode="w")
        add_array(old, "a", ring_voxels())
        old.attrs["multiscales"] = [{"datasets": [{"path": "a"}]}]
        self.assertEqual(ome_zarr.open(self.path("old.zarr")).spacing, (1, 1, 1))
        multiscales = [{"axes": axes("zyx"), "datasets": [
            {"path": "a", "coordinateTransformations": [{"type": "scale", "scale": [3, 2, 1]}]}]}]
        del old.attrs["multiscales"]
        old.attrs["ome"] = {"version": "0.5", "multiscales": multiscales}
        self.assertEqual(ome_zarr.open(self.path("old.zarr")).spacing, (1, 2, 3))

    def test_numpy_indexing(self):
        volume = ome_zarr.open(self.path("scan.zarr"), channel=1)
        index = np.s_
        for key in (5, index[3:9], index[..., 5], index[..., 3:9], index[3, ..., 5], index[2:4, ...],
                    (1, 2, 3), ..., (-1, 4), index[:, 4, 1:9:2]):
            with self.subTest(key=key):
                np.testing.assert_array_equal(volume[key], ring_voxels()[key])
        for key in (None, [1, 2], (1, 2, 3, 4), (..., ...), 2.5, True):
            with self.subTest(key=key), self.assertRaisesRegex(IndexError, "use integers, slices"):
                volume[key]  # pylint: disable=pointless-statement

    def test_axes_in_another_order(self):
        turned = zarr.open_group(self.path("turned.zarr"), mode="w")
        add_array(turned, "0", np.stack([np.transpose(ring_voxels())]))
        describe(turned, "cxyz", [("0", [{"type": "scale", "scale": [1, 2, 1, 3]}])])
        volume = ome_zarr.open(self.path("turned.zarr"))
        self.assertEqual((volume.shape, volume.spacing), ((40, 40, 40), (2, 1, 3)))
        np.testing.assert_array_equal(volume[..., 5], ring_voxels()[..., 5])
        np.testing.assert_array_equal(volume[4, 2:], ring_voxels()[4, 2:])

    def test_units(self):
        for units, nanometers, spacing in (
                (("um",) * 3, 1000, (2, 1, 3)), (("µm",) * 3, 1000, (2, 1, 3)),
                (("micron",) * 3, 1000, (2, 1, 3)), (("millimetre",) * 3, 1e6, (2, 1, 3)),
                (("micrometer", "nanometer", "nanometer"), 1, (2, 1, 3000))):
            with self.subTest(units):
                group = self.root.create_group("units", overwrite=True)
                add_array(group, "0", ring_voxels())
                describe(group, "zyx", [("0", [{"type": "scale", "scale": [3, 1, 2]}])])
                scales = group.attrs["multiscales"]
                scales[0]["axes"] = axes("zyx", *units)
                group.attrs["multiscales"] = scales
                volume = ome_zarr.open(self.path("scan.zarr/units"))
                self.assertEqual((volume.nanometers, volume.spacing), (nanometers, spacing))
        scales[0]["axes"] = axes("zyx", *["furlong"] * 3)
        group.attrs["multiscales"] = scales
        with self.assertWarnsRegex(UserWarning, "the unit 'furlong' is unknown"):
            self.assertEqual(ome_zarr.open(self.path("scan.zarr/units")).nanometers, 1)
        scales[0]["axes"] = axes("zyx", "um", "um", "")
        group.attrs["multiscales"] = scales
        with self.assertRaisesRegex(ValueError, "units of the axes cannot be converted"):
            ome_zarr.open(self.path("scan.zarr/units"))

    def test_missing_chunks_are_counted(self):
        volume = ome_zarr.open(self.path("scan.zarr"), channel=1)
        self.assertEqual(volume.missing_chunks(), (0, 27))
        name = "0.1.2.0.1" if os.path.exists(self.path("scan.zarr/0/0.1.2.0.1")) else "0/1/2/0/1"
        os.remove(self.path("scan.zarr/0/" + name))
        self.assertEqual(volume.missing_chunks(), (1, 27))

    def test_invalid_arguments_raise(self):
        path = self.path("scan.zarr")
        for message, call in (
                ("scan.zarr/0 is the array of a level; open the group that contains it, .*scan.zarr$",
                 lambda: ome_zarr.open(path + "/0")),
                ("no index 3 along t; it has no such axis",
                 lambda: ome_zarr.open(path, label="cells", time=3)),
                ("none.zarr: not a Zarr group", lambda: ome_zarr.open(self.path("none.zarr"))),
                ("no level 2; it has 0 to 1", lambda: ome_zarr.open(path, 2)),
                ("no label map nuclei; it has cells", lambda: ome_zarr.open(path, label="nuclei")),
                ("no index 2 along c; it has 0 to 1", lambda: ome_zarr.open(path, channel=2)),
                ("no multiscales; append one of cells", lambda: ome_zarr.open(path + "/labels"))):
            with self.subTest(message), self.assertRaisesRegex(ValueError, message):
                call()
        for names, steps, message in (
                ("tcwyx", [], "axes t, c, w, y, x .* must have z, y and x"),
                ("tazyx", [], "2 images along the unsupported axis a; copy one"),
                ("tczyx", [{"type": "affine"}], "affine'} is not supported"),
                ("tczyx", [{"type": "scale", "scale": [1, 1, 1]}], "with 5 numbers")):
            describe(self.root, names, [("0", steps)])
            with self.subTest(message), self.assertRaisesRegex(ValueError, message):
                ome_zarr.open(path)


class WithoutZarrTest(unittest.TestCase):
    def test_open_raises_import_error(self):
        with unittest.mock.patch.dict(sys.modules, zarr=None):
            with self.assertRaisesRegex(ImportError, "Debian: python3-zarr"):
                ome_zarr.open(os.sep)
