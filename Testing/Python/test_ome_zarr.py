# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""volumic.ome_zarr: images, levels and label maps of OME-Zarr, with their coordinates."""

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


def axes(names, unit="micrometer"):
    kinds = {"t": "time", "c": "channel"}
    return [{"name": name, "type": kinds[name]} if name in kinds
            else {"name": name, "type": "space", "unit": unit} for name in names]


def add_array(group, name, voxels):
    create = getattr(group, "create_array", None) or group.create_dataset
    create(name, shape=voxels.shape, chunks=(1,) * (voxels.ndim - 3) + (16, 16, 16),
           dtype=voxels.dtype)[...] = voxels


def describe(group, names, levels, **more):
    group.attrs["multiscales"] = [{
        "version": "0.4", "axes": axes(names), "datasets": [
            {"path": path, "coordinateTransformations": steps} for path, steps in levels], **more}]


def write_labels(path, name, voxels):
    """An image of labels only."""
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

    def test_levels_and_their_coordinates(self):
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

    def test_label_maps_are_the_source_of_jobs(self):
        self.assertEqual(ome_zarr.label_names(self.path("scan.zarr")), ["cells"])
        cells = ome_zarr.open(self.path("scan.zarr"), label="cells")
        cells = pickle.loads(pickle.dumps(cells))  # as workers get it
        row, = tasks.Job(cells, self.path("meshes"), formats=["precomputed"]).run()
        self.assertEqual((row["Label"], row["Voxels"]), (5, np.count_nonzero(ring_voxels() > 125)))

    def test_what_fsspec_opens(self):
        there = fsspec.filesystem("memory")
        there.put(self.path("scan.zarr"), "/scan.zarr", recursive=True)
        self.addCleanup(there.rm, "/scan.zarr", recursive=True)
        cells = ome_zarr.open("memory://scan.zarr", label="cells")
        self.assertEqual(np.unique(cells[:]).tolist(), [0, 5])

    def test_versions_before_and_after(self):
        old = zarr.open_group(self.path("old.zarr"), mode="w")
        add_array(old, "a", ring_voxels())
        old.attrs["multiscales"] = [{"datasets": [{"path": "a"}]}]
        self.assertEqual(ome_zarr.open(self.path("old.zarr")).spacing, (1, 1, 1))
        multiscales = [{"axes": axes("zyx"), "datasets": [
            {"path": "a", "coordinateTransformations": [{"type": "scale", "scale": [3, 2, 1]}]}]}]
        del old.attrs["multiscales"]
        old.attrs["ome"] = {"version": "0.5", "multiscales": multiscales}
        self.assertEqual(ome_zarr.open(self.path("old.zarr")).spacing, (1, 2, 3))

    def test_refused(self):
        path = self.path("scan.zarr")
        for words, call in (
                ("none.zarr: there is no group", lambda: ome_zarr.open(self.path("none.zarr"))),
                ("no level 2; it has 0 to 1", lambda: ome_zarr.open(path, 2)),
                ("no labels nuclei; it has cells", lambda: ome_zarr.open(path, label="nuclei")),
                ("no index 2 along c; it has 0 to 1", lambda: ome_zarr.open(path, channel=2)),
                ("no multiscales; labels: cells", lambda: ome_zarr.open(path + "/labels"))):
            with self.subTest(words), self.assertRaisesRegex(ValueError, words):
                call()
        describe(self.root, "tcxyz", [("0", [])])
        with self.assertRaisesRegex(ValueError, "axes t, c, x, y, z .* must be z, y and x"):
            ome_zarr.open(path)
        describe(self.root, "tczyx", [("0", [{"type": "affine"}])])
        with self.assertRaisesRegex(ValueError, "no coordinates .*affine"):
            ome_zarr.open(path)


class WithoutZarrTest(unittest.TestCase):
    def test_it_tells(self):
        with unittest.mock.patch.dict(sys.modules, zarr=None):
            with self.assertRaisesRegex(ImportError, "Debian: python3-zarr"):
                ome_zarr.open(os.sep)


if __name__ == "__main__":
    unittest.main()
