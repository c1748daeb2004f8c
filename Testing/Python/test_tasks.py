# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Tests of volumic.tasks: surfaces of labels from crops, in processes, on dask, with killed
workers."""

import concurrent.futures
import csv
import functools
import json
import multiprocessing
import os
import shutil
import signal
import struct
import subprocess
import tempfile
import unittest
import unittest.mock

import numpy as np
import volumic
from scipy.spatial import cKDTree
from volumic import arrays, tasks
from volumic.writing.files import HIDDEN

from folder_test_case import FolderTestCase, SharedFolderTestCase
from vtk_files import points_of, read

try:
    import distributed
except ImportError:
    distributed = None

SPACING, ORIGIN = (0.3, 0.31, 0.4), (10.1, -5.2, 3.3)


class Chunked:
    """A map with chunks that records the largest part read."""

    chunks = (32, 32, 16)

    def __init__(self, voxels):
        self.voxels, self.shape, self.dtype, self.largest = voxels, voxels.shape, voxels.dtype, 0

    def __getitem__(self, key):
        part = self.voxels[key]
        self.largest = max(self.largest, part.size)
        return part


@functools.lru_cache()
def cells():
    """Return adjacent labels in a ball, with junctions of three and four labels, on different axis
    sizes."""
    z, y, x = np.indices((46, 41, 49)).astype("f4")
    centres = np.random.default_rng(5).uniform(4, 42, (12, 3))
    squares = np.stack([(x - a) ** 2 + (y - b) ** 2 + (z - c) ** 2 for a, b, c in centres])
    voxels = (squares.argmin(axis=0) + 1).astype("u4")
    voxels[squares.min(axis=0) > 150] = 0
    return voxels


def balls(count=8, size=96):
    """Return labels that are far apart."""
    z, y, x = np.indices((size, size, size)).astype("f4")
    voxels = np.zeros(x.shape, "u2")
    for label, (a, b, c) in enumerate(np.ndindex(2, 2, 2), 1):
        if label <= count:
            position = [24.3 + 48 * p for p in (a, b, c)]
            distance = np.hypot(np.hypot(x - position[0], y - position[1]), z - position[2])
            voxels[distance < 6 + label] = label
    return voxels


def job_of(voxels, folder, **settings):
    return tasks.Job(voxels, folder, **{"spacing": SPACING, "origin": ORIGIN, **settings})


def bundle_of(job, voxels, label, **settings):
    """Return the surfaces of the bundle of a label, computed separately."""
    box, labels = next(bundle for bundle in job._plan() if label in bundle[1])
    x, y, z = (slice(*ends) for ends in box)
    return volumic.labels(voxels[z, y, x], labels, spacing=SPACING, origin=ORIGIN,
                          start=[begin for begin, _ in box], **settings)


def kill_once(folder, job, labels):
    """Compute labels, but kill the process the first time label 3 is requested."""
    if 3 in labels:
        try:
            os.mkdir(os.path.join(folder, "died"))
        except FileExistsError:
            pass
        else:
            os.mkdir(os.path.join(job.folder, HIDDEN + "half"))
            os.kill(os.getpid(), signal.SIGKILL)
    with open(os.path.join(folder, "made"), "a", encoding="utf-8") as file:
        file.write("".join(f"{label}\n" for label in labels if not job.is_done(label)))
    job.make(labels)


class Meshes(list):
    scales = ()


def multilod_meshes(folder, label):
    """Return points and triangles of each level of detail, as Neuroglancer specifies the format."""
    with open(os.path.join(folder, f"{label}.index"), "rb") as file:
        manifest = file.read()
    with open(os.path.join(folder, str(label)), "rb") as file:
        fragments = file.read()
    shape, origin = np.frombuffer(manifest, "<f4", 6).reshape(2, 3)
    count, = struct.unpack_from("<I", manifest, 24)
    meshes = Meshes()
    meshes.scales = np.frombuffer(manifest, "<f4", count, 28)
    offsets = np.frombuffer(manifest, "<f4", 3 * count, 28 + 4 * count).reshape(-1, 3)
    numbers = np.frombuffer(manifest, "<u4", -1, 28 + 16 * count)
    assert (numbers[:count] == 1).all() and len(numbers) == 5 * count
    first = 0
    for level, (*node, size) in enumerate(numbers[count:].reshape(-1, 4)):
        with tempfile.TemporaryDirectory() as scratch:
            drc, ply = os.path.join(scratch, "a.drc"), os.path.join(scratch, "a.ply")
            with open(drc, "wb") as file:
                file.write(fragments[first:first + size])
            subprocess.run(["draco_decoder", "-i", drc, "-o", ply], check=True,
                           stdout=subprocess.DEVNULL)
            with open(ply, "rb") as file:
                header, content = file.read().split(b"end_header\n", 1)
        first += size
        vertices = int(header.split(b"element vertex ")[1].split()[0])
        assert b"property int x" in header  # no quantization by Draco
        coordinates = np.frombuffer(content, "<i4", 3 * vertices).reshape(-1, 3)
        assert coordinates.min() >= 0 and coordinates.max() <= (65535 if level == 0 else 32768)
        faces = np.frombuffer(content, [("n", "u1"), ("corners", "<i4", 3)], -1, 12 * vertices)
        meshes.append((origin + offsets[level] + shape * 2.0 ** level * (node + coordinates / 65535.0),
                       faces["corners"]))
    assert first == len(fragments)
    return meshes


class BitIdenticalTest(SharedFolderTestCase):
    """Results are bit-identical to those of a serial job with bundles of some labels."""

    BUNDLE = 40 ** 3

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.job = job_of(Chunked(cells()), cls.path("reference"), bundle=cls.BUNDLE)
        cls.job.run()

    def check_files(self, folder):
        for label in self.job.labels():
            name = f"label-{label}.vtp"
            self.assertTrue(self.content(os.path.join(folder, name))
                            == self.content(f"reference/{name}"), name)

    def test_bundle_equals_mesh_of_its_crop(self):
        plan = self.job._plan()
        self.assertGreater(len(plan), 2)
        self.assertEqual(sorted(sum((labels for _, labels in plan), [])),
                         [0, *self.job.labels()])
        for _, labels in plan[:-1]:
            for label, surface in bundle_of(self.job, cells(), labels[0]).items():
                self.assertEqual(self.content(f"reference/label-{label}.vtp"),
                                 surface.to_bytes(".vtp"))
                self.assertEqual(surface.report["LabelVoxels"], (cells() == label).sum())

    def test_single_bundle_equals_whole_map(self):
        job_of(cells(), self.path("whole")).run()
        for label, surface in volumic.labels(cells(), spacing=SPACING, origin=ORIGIN).items():
            self.assertTrue(self.content(f"whole/label-{label}.vtp") == surface.to_bytes(".vtp"))
            # Surfaces of other bundles are close, so that there are no gaps.
            points = points_of(read(self.path(f"reference/label-{label}.vtp")))
            self.assertLess(cKDTree(points).query(surface.points)[0].max(), max(SPACING))

    def test_selected_labels_and_resumed_bundle(self):
        job = job_of(cells(), self.path("some"), only=[5], bundle=self.BUNDLE)
        self.assertEqual([row["Label"] for row in job.run()], [5])
        job_of(cells(), self.path("some"), bundle=self.BUNDLE).run()
        self.check_files("some")

    def test_distant_labels_use_small_crops(self):
        source = Chunked(balls())
        job = job_of(source, self.path("balls"), bundle=1)
        for block in job.blocks():
            job.count(block)
        source.largest = 0
        job.run()
        self.assertLess(source.largest, 0.25 * source.voxels.size)

    def test_process_pool(self):
        context = multiprocessing.get_context("spawn")
        with concurrent.futures.ProcessPoolExecutor(2, context) as executor:
            job_of(cells(), self.path("pool"), bundle=self.BUNDLE,
                   NumberOfThreads=1).run(executor.map)
        self.check_files("pool")

    @unittest.skipUnless(distributed, "no distributed (Debian: python3-distributed)")
    def test_dask_with_a_killed_worker(self):
        job = job_of(cells(), self.path("dask"), bundle=self.BUNDLE, NumberOfThreads=1)
        with distributed.LocalCluster(2, threads_per_worker=1, dashboard_address=None,
                                      host="127.0.0.1") as cluster, \
                distributed.Client(cluster) as client:
            client.run(os.chdir, self.folder)
            client.gather(client.map(job.count, job.blocks()))
            make = functools.partial(kill_once, self.folder, job)
            client.gather(client.map(make, job.bundles()))
        self.assertTrue(os.path.isdir(self.path("died")))
        self.assertTrue(os.path.exists(os.path.join(job.folder, HIDDEN + "half")))
        job.finish()
        self.check_files("dask")
        left = [name for _, names, _ in os.walk(job.folder) for name in names
                if name.startswith(HIDDEN)]
        self.assertEqual(left, [])
        with open(self.path("made"), encoding="utf-8") as file:
            made = [int(line) for line in file]
        self.assertEqual(sorted(made), self.job.labels())  # each once


class JobTest(FolderTestCase):
    def job(self, **settings):
        return job_of(Chunked(balls(3)), self.path("meshes"), **settings)

    def test_job_resumes(self):
        job = self.job(bundle=1)
        for block in job.blocks()[1:]:
            job.count(block)
        self.assertEqual(len(job.blocks()), 1)
        with self.assertRaisesRegex(ValueError, "1 of [0-9]+ blocks are not counted"):
            job.bundles()
        job.count(0)
        job.make(job.bundles()[0])
        with self.assertRaisesRegex(ValueError, "2 of 3 labels are not computed"):
            job.finish()
        self.assertEqual([len(job.bundles(part, 2)) for part in (0, 1)], [1, 1])
        again = self.job(bundle=1, NumberOfThreads=1)
        self.assertEqual((len(again.blocks()), len(again.bundles())), (0, 2))
        before = os.stat(self.path("meshes/label-3.vtp")).st_mtime_ns
        again.run()
        again.make([3])
        self.assertEqual(os.stat(self.path("meshes/label-3.vtp")).st_mtime_ns, before)
        self.assertEqual(self.job(bundle=1).bundles(), [])

    def test_extents_do_not_depend_on_blocks(self):
        for shape in ((96, 96, 96), (33, 65, 17)):
            voxels = balls(8)[:shape[0], :shape[1], :shape[2]]
            source = Chunked(voxels)
            job = tasks.Job(source, self.path(f"meshes{shape[0]}"))
            with unittest.mock.patch.object(tasks, "BLOCK", 32):
                self.assertGreater(len(job._grid()), 1)
                for block in job.blocks():
                    job.count(block)
                boxes = job.boxes()
            self.assertEqual(boxes, arrays.label_boxes(voxels))

    def test_invalid_arguments_raise(self):
        for message, settings in (
                ("no property smoothing; did you mean Smoothing", {"smoothing": 1}),
                ("Merge and periodic BoxFaces are not supported", {"Merge": True}),
                ("Merge and periodic BoxFaces are not supported", {"BoxFaces": 2}),
                ("TimeLimit is not supported for jobs", {"TimeLimit": 3}),
                ("'.off' is not a format; use one of .vtp.*multilod_draco", {"formats": [".off"]})):
            with self.subTest(message), self.assertRaisesRegex((TypeError, ValueError), message):
                self.job(**settings)
        with self.assertRaisesRegex(ValueError, "the map has no label 9"):
            self.job(only=[9]).run()
        with self.assertRaisesRegex(ValueError, "label 3 requires a crop of 46 x 46 x 40"):
            job_of(balls(3), self.path("small"), most=1000).run()
        with self.assertRaisesRegex(ValueError, "results for properties {} instead of .*Smoothing"):
            self.job(Smoothing=1)
        with self.assertRaisesRegex(arrays.FilterError, "Smoothing is 99"):
            tasks.Job(balls(1), self.path("other"), Smoothing=99).run()

    def test_margins_of_crops(self):
        job = tasks.Job(balls(), self.path("meshes"), spacing=(1, 1, 2), bundle=1, Smoothing=0.5)
        self.assertEqual(job._margin(), [11, 11, 6])  # 4 x 5/8 x 2 + 6 x 1
        job.count(0)
        box = next(box for box, labels in job._plan() if labels == [1])
        self.assertEqual(box, [[7, 43], [7, 43], [12, 38]])  # 18 to 31
        for margin, settings in ((14, {}), (22, {"FinestLevel": 2, "Smoothing": 1}),
                                 (28, {"EdgeLength": 4, "Smoothing": 1})):
            self.assertEqual(tasks.Job(balls(), self.path(f"m{margin}"), **settings)._margin(),
                             [margin] * 3)

    def test_table_and_precomputed_meshes(self):
        job = self.job(formats=["precomputed", ".stl"], nanometers=1000)
        rows = job.run()
        surface = bundle_of(job, balls(3), 2)[2]
        with open(self.path("meshes/labels.csv"), encoding="utf-8", newline="") as file:
            table = list(csv.DictReader(file))
        self.assertEqual([row["Label"] for row in table], ["1", "2", "3"])
        self.assertEqual(int(table[1]["Voxels"]), np.count_nonzero(balls(3) == 2))
        self.assertEqual([int(table[0][name]) for name in ("FirstX", "LastX")], [18, 31])
        self.assertAlmostEqual(float(table[0]["Volume"]), rows[0]["Volume"])
        self.assertGreater(float(table[0]["SmallestAngle"]), 15)
        self.assertGreater(float(table[0]["MeanQuality"]), 0.85)
        self.assertLess(float(table[0]["MeanQuality"]), 1)
        with open(self.path("meshes/precomputed/info"), encoding="utf-8") as file:
            self.assertEqual(json.load(file), {"@type": "neuroglancer_legacy_mesh"})
        with open(self.path("meshes/precomputed/2:0"), encoding="utf-8") as file:
            fragment, = json.load(file)["fragments"]
        content = self.content(f"meshes/precomputed/{fragment}")
        count, = struct.unpack_from("<I", content)
        points = np.frombuffer(content, "<f4", 3 * count, 4).reshape(-1, 3)
        triangles = np.frombuffer(content, "<u4", -1, 4 + 12 * count).reshape(-1, 3)
        np.testing.assert_allclose(points, 1000 * surface.points, rtol=1e-6)
        np.testing.assert_array_equal(triangles, surface.triangles)

    @unittest.skipUnless(shutil.which("draco_encoder"), "no draco_encoder (Debian: draco)")
    def test_multilod_draco_meshes(self):
        job = job_of(balls(), self.path("meshes"), only=[8], formats=["multilod_draco"],
                     nanometers=1000, bundle=1)
        job.run()
        with open(self.path("meshes/multilod_draco/info"), encoding="utf-8") as file:
            self.assertEqual(json.load(file)["@type"], "neuroglancer_multilod_draco")
        meshes = multilod_meshes(self.path("meshes/multilod_draco"), 8)
        self.assertEqual(len(meshes), 4)
        for scale, level, (points, triangles) in zip(meshes.scales, range(4), meshes):
            with self.subTest(level=level):
                surface = bundle_of(job, balls(), 8, FinestLevel=level)[8]
                self.assertEqual(len(triangles), len(surface.triangles))
                # Closed and oriented.
                edges = triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
                self.assertEqual(len(set(map(tuple, edges))), len(edges))
                self.assertEqual(set(map(tuple, edges)), set(map(tuple, edges[:, ::-1])))
                step = 2 * 2 ** level * np.ptp(1000 * surface.points, axis=0).max() / 65535
                for position in points:
                    nearest = np.abs(1000 * surface.points - position).max(axis=1).min()
                    self.assertLess(nearest, step)
                self.assertTrue(300 < scale / 3 ** (level / 2) < 600, scale)  # voxels: 300 to 400
        with unittest.mock.patch.object(shutil, "which", return_value=None), \
                self.assertRaisesRegex(RuntimeError, "requires the program draco_encoder"):
            self.job(formats=["multilod_draco"])

    def test_quality_of_an_equilateral_triangle(self):
        class Triangle:
            points = np.array([(0, 0, 0), (1, 0, 0), (0.5, 0.75 ** 0.5, 0)])
            triangles = np.array([(0, 1, 2)])
        found = arrays.quality(Triangle)
        self.assertAlmostEqual(found["SmallestAngle"], 60)
        self.assertAlmostEqual(found["MeanQuality"], 1)
