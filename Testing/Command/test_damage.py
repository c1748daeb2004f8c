# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Tests of damaged files in the command: random damages of all files that the tests of the readers
read, meshes, worker processes, pipes, memory. VOLUMIC_DAMAGES is the number of random damages per
file (default 1)."""

import bz2
import contextlib
import gzip
import importlib
import json
import os
import re
import resource
import shutil
import signal
import struct
import subprocess
import sys
import time
import traceback
import unittest
import unittest.mock
import warnings

import numpy as np

from command_test_case import ISO, META, SPACING, CommandTestCase, ball, nrrd_header
from reading_test_case import ReadingTestCase
from volumic import command, reading
from volumic.arrays import surface
from volumic.reading import VolumeError, points, tables
from volumic.reading.worker import in_worker

import medical_files
import vtk_files

TESTS = ("test_reading", "test_vtk_images", "test_microscopy", "test_dicom")
MODULES = ("volumic.segment", "nibabel", "pydicom", "tifffile", "mrcfile.dtypes", "zarr", "scipy.ndimage")
POINTS = {"read_surface": "--initial-surface", "read_seeds": "--seeds",
          "read_attracting_points": "--attracting-points"}
OPTIONS = ("time", "component", "series", "raw", "array")  # with the name of a choice
SECONDS, MEMORY = 30, 1 << 20  # of the processor; KiB
NUMBERS = (0, 1, 7, 255, 32767, 1 << 16, (1 << 31) - 1, 1 << 31, (1 << 32) - 1, 1 << 63)
WORDS = (*NUMBERS, "-1", "nan", "-inf", "1e308", "1e-320", "", "x", "-0.0", "3.5", "%d", "..")
BOMB = b'<!DOCTYPE a [<!ENTITY a0 "boom">' + b"".join(
    b'<!ENTITY a%d "%s">' % (n, b"&a%d;" % (n - 1) * 50) for n in range(1, 9)) + b"]><a>&a8;</a>"


def forked(function, log):
    """Return the exit code that a function returns in a fork, all output, and its memory in KiB."""
    sys.stdout.flush()
    process = os.fork()
    if process == 0:
        code = 70
        try:
            with open(log, "wb") as file:
                os.dup2(file.fileno(), 1)
                os.dup2(file.fileno(), 2)
            resource.setrlimit(resource.RLIMIT_CPU, (SECONDS, SECONDS))
            resource.setrlimit(resource.RLIMIT_AS, (MEMORY << 12, MEMORY << 12))
            signal.alarm(600)
            for kind in (DeprecationWarning, ImportWarning, ResourceWarning):  # not by default
                warnings.simplefilter("ignore", kind)
            code = function()
            sys.stdout.flush()
        except BaseException:  # pylint: disable=broad-except
            traceback.print_exc()
        finally:
            os._exit(code)
    _, status, usage = os.wait4(process, 0)
    with open(log, encoding="utf-8", errors="replace") as file:
        return os.waitstatus_to_exitcode(status), file.read(), usage.ru_maxrss


def collect(root):
    """Run the tests of the readers, copy each file that they read to a folder below `root`, and
    write a list of functions, copies and choices."""
    found = {}

    def watch(module, function):
        read = getattr(module, function)

        def watched(path, **choice):
            result = read(path, **choice)
            files = [file for file in reading.list_files(path) if os.path.isfile(file)]
            with open(files[0], "rb") as file:
                key = function, str(choice), os.path.splitext(path)[1], file.read()
            if key not in found and os.path.exists(path):
                folder, target = os.path.dirname(path), os.path.join(root, str(len(found)))
                found[key] = function, os.path.join(target, os.path.basename(path)), choice
                for file in files:
                    copy = os.path.join(target, os.path.relpath(file, folder))
                    os.makedirs(os.path.dirname(copy), exist_ok=True)
                    shutil.copy(file, copy)
            return result
        setattr(module, function, watched)

    for module, function in [(reading, "read"), *((points, name) for name in POINTS)]:
        watch(module, function)
    CommandTestCase.run_command = unittest.mock.Mock(side_effect=unittest.SkipTest)
    tests = unittest.defaultTestLoader.loadTestsFromNames(TESTS)
    tests.addTests(map(MeshesTest, ("test_formats", "test_texts")))
    tests.run(unittest.TestResult())
    with open(os.path.join(root, "list"), "w", encoding="utf-8") as file:
        json.dump(list(found.values()), file)
    return 0


def damaged(content, random, others):
    """Return damaged content, the damage, and whether the voxels must not change, as data are
    missing or have a checksum."""
    pick = lambda items: items[int(random.integers(len(items)))]
    packed = content.startswith((b"\x1f\x8b", b"BZh"))
    if packed and random.integers(2):
        module = gzip if content[0] == 31 else bz2
        content, damage, _ = damaged(module.decompress(content), random, others)
        return module.compress(content), "inner " + damage, damage.startswith("cut")
    size, kind = len(content), int(random.integers(6))
    at, to = random.integers(min(size, pick((24, 128, 352, 1024))) or 1, size=2).tolist()
    anywhere, end = int(random.integers(size or 1)), at + int(random.integers(1, 60))
    if kind < 2 or not size:
        end = max(0, pick((0, at, anywhere, size - 1, size - end % 40,
                           content.rfind(b"\n", 0, anywhere))))
        return content[:end], f"cut to {end} of {size} bytes", True
    if kind == 2:
        return pick(others), "another format", False
    word, count = struct.pack(pick("<>") + "Q", pick(NUMBERS)), pick((2, 4, 8))
    spans = [(anywhere, anywhere + 4, random.bytes(4)),
             (at, at + 1, bytes([content[at] ^ 1 << pick(range(8))])),
             (at, end, content[to:to + end - at]), (at, end, b""), (at, at, content[at:end]),
             (at // 2 * 2, at // 2 * 2 + count, word[-count:] if word[0] == 0 else word[:count])]
    if content[:200].isascii() and kind > 3:
        number = pick(list(re.finditer(rb"[-+]?[\d.]+|$", content[:2000])))
        spans = [(*number.span(), str(pick(WORDS)).encode())] * 4 + [(at, end, b"\xff\xfe\x80\xc3")]
        spans += [(content.find(b"<"), size, BOMB)] * (b"<" in content[:100])
    begin, end, new = pick(spans)
    return (content[:begin] + new + content[end:], f"bytes {begin} to {end} become {new[:30]}",
            begin > 9 and packed)


def damage_folder(folder, random, others):
    """Damage a file of a folder. Return the damage, and whether the voxels must not change."""
    files = sorted(os.path.join(top, name) for top, _, names in os.walk(folder) for name in names)
    file, other = (files[int(i)] for i in random.integers(len(files), size=2))
    name, kind = os.path.relpath(file, folder), int(random.integers(9))
    if kind == 0 and file != other:
        os.remove(file)
        return name + " removed", False
    if kind < 3 and file != other:
        shutil.copy(file, other if kind == 1 else "b".join(os.path.splitext(file)))
        return f"{name} copied, {kind}", False
    with open(file, "r+b") as stream:
        content, damage, is_same = damaged(stream.read(), random, others)
        stream.seek(0)
        stream.write(content)
        stream.truncate()
    return f"{name}: {damage}", is_same


def data_of(function, path, choice):
    """Return the voxels, or points and triangles, of a file."""
    if function == "read":
        return reading.read(path, **choice).array
    mesh = points.read_surface(path)
    return np.append(vtk_files.points_of(mesh), vtk_files.triangles_of(mesh))


class DamageTest(CommandTestCase):
    def test_random_damages(self):
        for name in MODULES:  # once, not in each fork
            with contextlib.suppress(ImportError):
                importlib.import_module(name)
        self.write_bytes("ball.mha", META + ball().tobytes())
        code, output, _ = forked(lambda: collect(self.folder), self.path("log"))
        self.assertEqual(code, 0, output)
        samples = json.loads(self.content("list"))
        self.assertGreater(len(samples), 100)
        others = [self.content(path) for _, path, _ in samples if os.path.isfile(path)]
        for seed in range(int(os.environ.get("VOLUMIC_DAMAGES", "1")) * len(samples)):
            function, good, choice = samples[seed % len(samples)]
            shutil.copytree(os.path.dirname(good), self.path("case"))
            os.mkdir(self.path("out"))
            damage, is_same = damage_folder(self.path("case"), np.random.default_rng(seed), others)
            with self.subTest(seed=seed, file=good, damage=damage, **choice):
                self.judge(function, good, choice, is_same)
            shutil.rmtree(self.path("case"))
            shutil.rmtree(self.path("out"))

    def test_sizes_in_headers_are_not_allocated(self):
        content = bytearray(medical_files.mrc(ball(), SPACING))
        struct.pack_into("<i", content, 92, (1 << 31) - 1)  # extended header
        file = self.write_bytes("a.map.gz", gzip.compress(content))
        code, output, memory = forked(lambda: command.main([file, self.path("a.stl")]),
                                      self.path("log"))
        self.assertEqual((code, output), (1, f"volumic: {file}: the file is truncated; copy it again\n"))
        self.assertLess(memory, MEMORY)

    def test_an_initial_surface_is_named(self):
        mesh = "v -3 18 17\nv 3 18 17\nv 0 23 17\nf 1 2 3\n"
        self.rejects("a.obj: The initial surface is not closed: 3 edges", self.ball_file(),
                     self.path("a.stl"), "--initial-surface", self.write_text("a.obj", mesh))

    def judge(self, function, good, choice, is_same):
        """The command reads the damaged file, or rejects it in one line with its name and advice."""
        name = os.path.basename(good)
        path, output_file = self.path("case/" + name), self.path("out/a.vti")
        options = [word for key in OPTIONS if key in choice for word in ("--" + key, str(choice[key]))]
        options += ["--list-labels"] if choice.get("labels") else ["--write-volume", output_file]
        if function != "read":
            path, options = self.path("ball.mha"), [self.path("out/a.stl"), POINTS[function], path]

        def run():
            code = command.main([path, *options])
            if code or not is_same or function not in ("read", "read_surface"):
                return code
            return 0 if np.array_equal(*(data_of(function, file, choice)
                                         for file in (self.path("case/" + name), good))) else 99

        code, output, memory = forked(run, self.path("log"))
        lines = output.splitlines()
        self.assertIn(code, (0, 1), output)
        self.assertLess(memory, MEMORY, output)
        if code or not choice.get("labels"):
            self.assertRegex(output, r"\A(volumic: .*\n){,8}\Z")
        if code:
            self.assertRegex(lines[-1], f"^volumic: .*{re.escape(name)}.*(; |[.] |lies )[A-Za-z]")
            self.assertEqual(os.listdir(self.path("out")), [])


class MeshesTest(ReadingTestCase):
    PLY = (b"ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
           b"property float z\nelement face 4\nproperty list uchar int vertex_indices\n"
           b"end_header\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n")

    def rejects_mesh(self, name, content, reason="."):
        self.write_bytes(name, content)
        read = points.read_seeds if name.endswith(".csv") else points.read_surface
        with self.assertRaisesRegex(VolumeError, f"{name}: .*({reason})"):
            read(self.path(name))

    def test_formats(self):
        mesh = surface(ball("f4"), iso=ISO)
        for suffix in ("vtp", "vtk", "ply", "stl", "obj"):
            name = self.path(f"a.{suffix}")
            mesh.save(name)
            read = points.read_surface(name)
            self.assertEqual((read.GetNumberOfPoints(), read.GetNumberOfPolys()),
                             (len(mesh.points), len(mesh.triangles)))

    def test_polygons(self):
        self.write_bytes("a.ply", self.PLY)
        self.assertEqual(points.read_surface(self.path("a.ply")).GetNumberOfPolys(), 4)
        for old, new in ((b"3 1 2 3", b"3 1 2 4"), (b"0 0 1\n", b"0 0 nan\n")):
            self.rejects_mesh("b.ply", self.PLY.replace(old, new), "the file is damaged: a (cell|point)")
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
                (b"1;2;3\n1 2 3\n", "line 1: '1;2;3' is not"), (b"1.5.2 2 3\n", "line 1: '1.5.2' is"),
                (b"1,5 2,0 3,5\n1 2 3\n", "line 1: expected three"),
                (b"x,y,z\nx,y,z\n1 2 3\n", "line 2: 'x' is not")):
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


class InputsTest(CommandTestCase):
    def test_phase_is_a_synonym_of_time(self):
        self.rejects("ball.vti: there is no time 1", self.ball_file(), self.path("a.vtp"), "--phase", 1)

    def test_pipes_are_rejected(self):
        for name in ("a.mha", "p.raw", "list.txt", "list.stl"):
            os.mkfifo(self.path(name))
        self.write_bytes("b.mhd", META.replace(b"LOCAL", b"p.raw"))
        self.write_bytes("b.nhdr", nrrd_header("gzip") + b"data file: p.raw\n")
        for read, names in ((reading.read, ("a.mha", "b.mhd", "b.nhdr", "/dev/null")),
                            (points.read_seeds, ("list.txt",)), (points.read_surface, ("list.stl",)),
                            (points.read_attracting_points, ("list.txt",)),
                            (tables.read_label_names, ("list.txt",))):
            for name in names:
                with self.assertRaisesRegex(VolumeError, f"{name}.*: a pipe or a device"):
                    read(self.path(name))
        self.rejects("a pipe or a device", self.ball_file(), self.path("x.stl"), "--edges",
                     self.path("a.mha"))

    def test_insufficient_memory(self):
        file = self.write_bytes("large.mha", META.replace(b"26 22 18", b"1024 1024 1024"))
        os.truncate(file, os.path.getsize(file) + (2 << 30))
        process = self.run_command(file, self.path("a.stl"), "--iso", "500.5", status=1,
                                   preexec_fn=lambda: resource.setrlimit(
                                       resource.RLIMIT_AS, (1500 << 20, 1500 << 20)))
        self.assertRegex(process.stderr, "large.mha: not enough memory to read the volume; crop")
