# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Tests of damaged pictures, slices, maps and meshes, in readers and command. Other formats:
test_reading.py."""

import contextlib
import gzip
import os
import resource
import signal
import struct
import subprocess
import sys
import time
import unittest

import numpy as np
from vtkmodules.vtkIOImage import (
    vtkBMPWriter, vtkJPEGWriter, vtkPNGWriter, vtkPNMWriter, vtkTIFFWriter)

from command_test_case import (
    ISO, META, SPACING, CommandTestCase, ball, make_image, nrrd_header)
from reading_test_case import ReadingTestCase, noisy_ball
from volumic.reading import VolumeError, points
from volumic.reading.worker import in_worker

import medical_files


class SlicesTest(ReadingTestCase):
    def test_pictures(self):
        for writer, suffix in ((vtkPNGWriter, "png"), (vtkTIFFWriter, "tif"), (vtkPNMWriter, "pgm"),
                               (vtkBMPWriter, "bmp"), (vtkJPEGWriter, "jpg")):
            os.makedirs(self.path(suffix))
            for k, plane in enumerate(noisy_ball("u2") if suffix in ("png", "tif")
                                      else (noisy_ball() // 5).astype("u1")):
                content = self.bytes_of(writer(), f"{suffix}/{k:02}.{suffix}",
                                        make_image(plane[np.newaxis]))
            with self.subTest(suffix):
                self.read(suffix)
                self.write_bytes(f"{suffix}/17.{suffix}", content[:len(content) * 2 // 3])
                self.rejects(suffix, rf"17\.{suffix}")

    def test_maps(self):
        content = medical_files.mrc(noisy_ball(), SPACING)
        for name, packed in (("a.mrc", content), ("a.map.gz", gzip.compress(content))):
            self.check(self.read(name, packed), noisy_ball(), origin=(0, 0, 0))
            self.rejects_truncated(name, packed)
        self.rejects_with("a.mrc", content, [(offset, struct.pack("<i", value), ".") for offset, value in (
            (12, 77), (64, 7), (68, 1), (0, 0), (28, 0), (8, -18))])


class MeshesTest(ReadingTestCase):
    PLY = (b"ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
           b"property float z\nelement face 4\nproperty list uchar int vertex_indices\n"
           b"end_header\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n")

    def rejects_mesh(self, name, content, reason="."):
        self.write_bytes(name, content)
        for read in (points.read_surface, points.read_seeds, points.read_attracting_points):
            if read == points.read_surface and name.endswith(".csv"):
                continue
            with self.assertRaisesRegex(VolumeError, f"{name}: .*({reason})"):
                read(self.path(name))

    def test_truncated_meshes(self):
        from volumic.arrays import surface
        mesh = surface(ball("f4"), iso=ISO)
        for suffix, sizes in (("vtp", (0.5, -100)), ("vtk", (0.5, -100)), ("ply", (0.2, 0.7, -1)),
                              ("stl", (0.5, -50, -1)), ("obj", ())):
            name = self.path(f"a.{suffix}")
            mesh.save(name)
            read = points.read_surface(name)
            self.assertEqual((read.GetNumberOfPoints(), read.GetNumberOfPolys()),
                             (len(mesh.points), len(mesh.triangles)))
            content = self.content(name)
            for size in sizes:
                with self.subTest(suffix, size=size):
                    self.rejects_mesh(name, content[:int(len(content) * size) if 0 < size else size],
                                      "truncated|damaged|cannot read")

    def test_polygons(self):
        self.write_bytes("a.ply", self.PLY)
        self.assertEqual(points.read_surface(self.path("a.ply")).GetNumberOfPolys(), 4)
        for old, new in ((b"element vertex", b"element vertix"), (b"element face 4", b"element face 9"),
                         (b"vertex 4", b"vertex 4000000000"), (b"3 1 2 3", b"3 1 2 4"),
                         (b"end_header", b"end_heater"), (b"0 0 1\n", b"0 0 nan\n")):
            with self.subTest(new):
                self.rejects_mesh("b.ply", self.PLY.replace(old, new))
        for word in (b"solid", b"binary"):
            self.rejects_mesh("a.stl", word.ljust(80, b"\0") + struct.pack("<I", 1 << 31) + bytes(500),
                              "truncated: it has 584 bytes")
        for line in (b"f 1 2 4", b"f 1 2 x", b"f 1 2 0"):
            self.rejects_mesh("a.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\n" + line + b"\n")
        self.rejects_mesh("a.xyz2", b"", "unknown mesh format")
        self.rejects_mesh("a.vtp", b"<VTKFile/>")

    def test_texts(self):
        for heading in (b"x,y,z\n", b"X Y Z\n", b'"x","y","z"\r\n', b"# seeds\n\nx, y, z # mm\n",
                        b"\xef\xbb\xbfx,y,z\n", b"\xef\xbb\xbf", b"\n"):
            self.write_bytes("a.csv", heading + b"1.5,2,-3\n")
            self.assertEqual(points.read_seeds(self.path("a.csv")).GetPoint(0), (1.5, 2, -3))
        for text, reason in (
                (b"x,y,z\n1,2,3\n1,2\n", "line 3: expected three"), (b"# none\n", "no points"),
                (b"1 2 nan\n", "line 1: 'nan' is not a number"), (b"inf 1 2\n", "line 1: 'inf'"),
                (b"1 2 x\n1 2 3\n", "line 1: 'x' is not a number"), (b"x,y,z\n", "no points"),
                (b"1;2;3\n1 2 3\n", "line 1: '1;2;3' is not"), (b"1.5.2 2 3\n", "line 1: '1.5.2' is"),
                (b"1,5 2,0 3,5\n1 2 3\n", "line 1: expected three"),
                (b"x,y,z\nx,y,z\n1 2 3\n", "line 2: 'x' is not"),
                (b"x,y,z\n1,2,three\n", "line 2: 'three'")):
            with self.subTest(text):
                self.rejects_mesh("a.csv", text, reason)
        self.write_bytes("a.csv", b"\xef\xbb\xbfx,y,z,Weight,Radius\n1,2,3\n4,5,6,7,8 # a\n")
        found = points.read_attracting_points(self.path("a.csv"))
        self.assertEqual(found.GetPoint(1), (4, 5, 6))
        self.assertEqual([found.GetPointData().GetArray(n).GetTuple1(1) for n in ("Weight", "Radius")],
                         [7, 8])


class WorkerTest(unittest.TestCase):
    def test_results_of_workers(self):
        array = in_worker("numpy:arange", 1000000)
        np.testing.assert_array_equal(array, np.arange(1000000))
        self.assertIsNotNone(array.base)  # mapped
        for function, reason in (("os:abort", "crashed: the file is damaged"),
                                 ("nowhere:abort", "install the Python package nowhere"),
                                 ("numpy:reshape", "cannot be read: ")):
            with self.assertRaisesRegex(VolumeError, reason):
                in_worker(function)
        with self.assertRaises(ChildProcessError):
            os.waitpid(-1, os.WNOHANG)  # no zombie

    def test_worker_ends_with_its_caller(self):
        code = "from volumic.reading.worker import in_worker; in_worker('time:sleep', 60)"
        for number in (signal.SIGINT, signal.SIGKILL):
            with subprocess.Popen([sys.executable, "-c", code], stderr=subprocess.DEVNULL,
                                  start_new_session=True) as process:
                deadline = time.monotonic() + 60
                while len(self.group(process.pid)) < 2 and time.monotonic() < deadline:
                    time.sleep(0.1)
                (os.killpg if number == signal.SIGINT else os.kill)(process.pid, number)
                process.wait(60)
            while self.group(process.pid) and time.monotonic() < deadline:
                time.sleep(0.1)
            self.assertEqual(self.group(process.pid), [])

    @staticmethod
    def group(number):
        """Return the running processes of a group."""
        found = []
        for name in filter(str.isdigit, os.listdir("/proc")):
            with contextlib.suppress(OSError), open(f"/proc/{name}/stat", encoding="ascii") as file:
                state, _, group = file.read().rpartition(")")[2].split()[:3]
                found += [name] if int(group) == number and state != "Z" else []
        return found


class CommandTest(CommandTestCase):
    def test_damaged_volumes_fail_in_one_line(self):
        self.write_bytes("a.mha", META + ball().tobytes()[:-10])
        self.write_bytes("b.nrrd", nrrd_header("gzip") + b"\nnothing but this text")
        content = medical_files.nifti(ball(), SPACING)
        self.write_bytes("c.nii", content[:268] + struct.pack("<f", float("nan")) + content[272:])
        self.write_bytes("d.mnc", b"\x89HDF\r\n\x1a\n" + bytes(range(256)) * 9)
        for name, reason in (("a.mha", "truncated"), ("b.nrrd", "damaged"), ("c.nii", "the origin nan"),
                             ("d.mnc", "cannot be read|crashed"), ("e.vti", "no such file")):
            self.rejects_volume(name, reason)

    def test_invalid_time_and_series(self):
        for option, value in (("--time", 99), ("--phase", 1), ("--series", 9)):
            with self.subTest(option):
                self.rejects(f"ball.vti: there is no {'series' if value == 9 else 'time'} {value}",
                             self.ball_file(), self.path("a.vtp"), option, value)

    def test_pipes_are_rejected(self):
        self.ball_file()
        for name in ("a.mha", "p.raw", "list.txt", "list.stl"):
            os.mkfifo(self.path(name))
        self.write_bytes("b.mhd", META.replace(b"LOCAL", b"p.raw"))
        self.write_bytes("b.nhdr", nrrd_header("gzip") + b"data file: p.raw\n")
        for name in ("a.mha", "b.mhd", "b.nhdr"):
            self.rejects("a pipe or a device", self.path(name), self.path("x.stl"))
        for option, name in (("--seeds", "list.txt"), ("--attracting-points", "list.txt"),
                             ("--initial-surface", "list.stl"), ("--edges", "a.mha"),
                             ("--label-names", "list.txt")):
            with self.subTest(option):
                self.rejects(f"{name}.*: a pipe or a device", self.path("ball.vti"),
                             self.path("x.stl"), option, self.path(name),
                             *(["--labels", "all"] if option == "--label-names" else []))
        self.rejects("a pipe or a device", "/dev/null", self.path("x.stl"))

    def test_insufficient_memory(self):
        file = self.write_bytes("large.mha", META.replace(b"26 22 18", b"1024 1024 1024"))
        os.truncate(file, os.path.getsize(file) + (2 << 30))
        process = self.run_command(file, self.path("a.stl"), "--iso", "500.5", status=1,
                                   preexec_fn=lambda: resource.setrlimit(
                                       resource.RLIMIT_AS, (1500 << 20, 1500 << 20)))
        self.assertRegex(process.stderr, "large.mha: not enough memory to read the volume; crop")


if __name__ == "__main__":
    unittest.main()
