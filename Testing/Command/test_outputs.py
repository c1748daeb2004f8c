# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Tests that written files are complete and never replace an input."""

import json
import os
import re
import shutil
import signal
import stat
import subprocess
import unittest
import unittest.mock

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLImageDataWriter
from volumic import writing
from volumic.errors import Failure
from volumic.writing import files, surfaces

from command_test_case import (
    ISO, PROGRAM, CommandTestCase, ball, largest_file, make_image)
from vtk_files import points_of, read, triangles_of

SURFACES = ("vtk", "vtp", "stl", "ply", "obj", "glb", "3mf", "msh", "smesh", "poly")
OLD = b"an older result"


class OutputsTest(CommandTestCase):
    def setUp(self):
        super().setUp()
        self.volume = self.ball_file()
        self.words = [self.volume, "--iso", str(ISO), "--levels", "2", "-q"]

    def segment(self, *arguments, **options):
        return self.run_command(*self.words, *arguments, **options)

    def hidden_files(self):
        return [name for name in os.listdir(self.folder) if name.startswith(".")]


class FullDiskTest(OutputsTest):
    def test_existing_file_is_kept(self):
        options = {"v.vti": ["--write-volume"], "h.csv": ["--history"], "r.json": ["--report"],
                   "l.vtm": ["--levels-output"], **{f"a.{suffix}": [] for suffix in SURFACES}}
        self.segment(*(word for name in options for word in (*options[name], self.path(name))))
        for name, option in options.items():
            # Seconds in tables and reports have more or fewer digits. A limit on the .vtm alone
            # would be none on the larger files of its blocks.
            missing = {"h.csv": 100, "r.json": 100, "l.vtm": -20000}.get(name, 1)
            limit = os.path.getsize(self.path(name)) - missing
            self.write_bytes(name, OLD)
            with self.subTest(name):
                process = self.segment(*option, self.path(name), status=1,
                                       preexec_fn=largest_file(limit))
                self.assertRegex(process.stderr, f"^volumic: .*{name}: cannot be written "
                                 r"\(.*(File too large|is the disk full\?)\)")
                self.assertEqual((self.content(name), self.hidden_files()), (OLD, []))

    def test_empty_folder_is_removed(self):
        labels = self.write(vtkXMLImageDataWriter(), "labels.vti",
                            make_image((ball() > ISO).astype("u1")))
        for arguments in ([self.volume, "--levels-output", self.path("l"), "--iso", ISO],
                          [labels, "--labels", "all", self.path("l/")]):
            process = self.run_command(*arguments, status=1, preexec_fn=largest_file(1000))
            self.assertRegex(process.stderr, r"/l.*: cannot be written \(File too large\)")
            self.assertFalse(os.path.exists(self.path("l")), arguments)

    def test_other_files_are_written(self):
        printed = self.segment(self.path("a.obj"), self.path("b.obj"), "--history", self.path("h.csv"),
                               status=1, preexec_fn=largest_file(20000)).stderr
        self.assertRegex(printed, r"^volumic: /.*/a.obj: .*\nvolumic: /.*/b.obj: .*\n$")
        self.assertEqual(sorted(os.listdir(self.folder)), ["ball.vti", "h.csv"])

    @unittest.skipUnless(os.path.exists("/dev/full"), "no /dev/full")
    def test_devices(self):
        for option in ("--history", "--report"):
            process = self.segment(option, "/dev/full", status=1)
            self.assertIn("/dev/full: cannot be written (No space left", process.stderr)
            self.assertTrue(stat.S_ISCHR(os.stat("/dev/full").st_mode), "it was replaced")
        self.assertIn("\"Iteration\",", self.segment("--history", "/dev/stdout").stdout)
        for option in (["--report", "-"], ["--help"], ["--version"], ["--list-properties"]):
            with self.subTest(option), open("/dev/full", "w", encoding="utf-8") as full:
                process = subprocess.run([PROGRAM, *self.words, *option], stdout=full, check=False,
                                         stderr=subprocess.PIPE, text=True)
                self.assertEqual(process.returncode, 1)
                self.assertRegex(process.stderr, "the standard output.*No space left")


class ManyTest(OutputsTest):

    def test_concurrent_runs(self):
        words = [PROGRAM, *self.words, self.path("a.obj"), "--levels-output", self.path("l.vtm"),
                 "--snapshots", self.path("s")]
        processes = [subprocess.Popen(words) for _ in range(4)]
        self.assertEqual([process.wait() for process in processes], [0] * 4)
        together = self.content("a.obj")
        self.segment(self.path("a.obj"))
        self.assertEqual(self.content("a.obj"), together)
        self.assertEqual(set(os.listdir(self.folder)), {"a.obj", "ball.vti", "l", "l.vtm", "s"})


class InvalidNamesTest(OutputsTest):
    """Output names are checked before the volume, which is invalid here, is read."""

    def setUp(self):
        super().setUp()
        self.no_image = self.write_bytes("no.vti", b"nothing")

    def rejects_at_once(self, reason, *lines):
        """Check that the command fails. Arguments other than options are names in the folder."""
        for line in lines:
            with self.subTest(line):
                process = self.run_command(self.no_image, *(
                    word if word.startswith("--") else self.path(word) for word in line.split()),
                    status=1)
                self.assertRegex(process.stderr, f"cannot be written: .* {reason} ")
                self.assertEqual((self.hidden_files(), self.content("no.vti")), ([], b"nothing"))

    def test_inputs_are_not_replaced(self):
        os.link(self.no_image, self.path("hard.json"))
        os.symlink("no.vti", self.path("soft.csv"))
        os.mkdir(self.path("levels"))
        for name in ("a.stl", "b.csv", "c.vti", "levels/level-2.vtp", "levels/levels_0.vtp"):
            self.write_bytes(name, b"1,2,3")
        self.rejects_at_once(
            "is the input", "--report no.vti", "--report hard.json", "--history soft.csv",
            "--initial-surface a.stl a.stl", "--seeds b.csv --history b.csv",
            "--attracting-points b.csv --history ./b.csv", "--edges c.vti --report c.vti",
            "--initial-surface levels/level-2.vtp --levels-output levels",
            "--initial-surface levels/levels_0.vtp --levels-output levels.vtm")

    def test_companion_files_are_not_replaced(self):
        os.mkdir(self.path("series"))
        self.write_bytes("a.mhd", b"ElementDataFile = LIST\n a1.raw\na2.raw\n")
        self.write_bytes("b.img", b"")
        for volume, data in (("a.mhd", "a2.raw"), ("b.img", "b.hdr"), ("series", "series/IM1")):
            self.write_bytes(data, bytes(128) + b"DICM")
            self.rejects("it is the input", self.path(volume), "--report", self.path(data))
            self.assertEqual(self.content(data), bytes(128) + b"DICM")

    def test_equal_outputs(self):
        os.symlink("b.vtp", self.path("c.vtp"))
        os.mkdir(self.path("l"))
        self.rejects_at_once(
            "is also the output", "a.vtp a.vtp", "b.vtp c.vtp", "a.vtp --history ./a.vtp",
            "--levels-output r --report r", "--levels-output l.vtm --snapshots l.vtm",
            "l/level-0.vtp --levels-output l", "--levels-output l --report l/level-0.vtp",
            "l/l_0.vtp --levels-output l.vtm")


class WrittenTest(OutputsTest):
    def test_progress_of_writing(self):
        names = [self.path("a." + suffix) for suffix in ("vtp", "vtk", "stl")]
        printed = self.run_command(*self.words[:-1], "--progress", *names).stderr
        for name in names:
            self.assertRegex(printed, rf"(?m)^Writing {name}:  *\d+ %$")

    def test_point_arrays_are_written_or_reported(self):
        names = ("a.vtp", "a.ply", "a.stl", "b.stl", "a.obj", "a.3mf")
        printed = self.run_command(self.volume, "--iso", ISO, "--probe", self.volume, "--thin-parts",
                                   *map(self.path, names)).stderr
        reported = re.findall(r"(.\.\w+): \.\w+ does not support the point arrays Thickness, ball; use "
                              r"\.vtp, \.vtk or \.ply", printed)
        self.assertEqual(reported, ["a.stl", "a.obj", "a.3mf"])
        whole = read(self.path("a.vtp")).GetPointData()
        head, body = self.content("a.ply").split(b"end_header\n")
        self.assertIn(b"property float Thickness\nproperty double ball\nelement face", head)
        rows = np.frombuffer(body, [("x", "<f4", 3), ("Normals", "<f4", 3), ("Thickness", "<f4"),
                                    ("ball", "<f8")], whole.GetNumberOfTuples())
        for name in ("Normals", "Thickness", "ball"):
            np.testing.assert_array_equal(rows[name], vtk_to_numpy(whole.GetArray(name)))

    def test_files_of_an_earlier_run_are_reported(self):
        for output, old in (("l", "/l: files of an earlier run exist: level-1.vtp;"),
                            ("m.vtm", "/m: files of an earlier run exist: m_1.vtp;")):
            words = (self.volume, "--iso", ISO, "--levels-output", self.path(output), "--levels")
            self.assertNotIn("earlier run", self.run_command(*words, 2).stderr)
            self.assertIn(old, self.run_command(*words, 1).stderr)

    def test_caps_are_solids_of_an_stl(self):
        """OpenFOAM reads text with a named solid per patch."""
        voxels = np.minimum(ball(), 900)
        voxels[:] = voxels[len(voxels) // 2]  # a cylinder, which leaves the volume at both ends
        self.write(vtkXMLImageDataWriter(), "tube.vti", make_image(voxels))
        printed = self.run_command(self.path("tube.vti"), "--iso", ISO, "--ends", "marked", *map(
            self.path, ("a.vtp", "a.stl", "a.ply"))).stderr
        self.assertIn("a.ply: .ply does not support numbers of caps", printed)
        whole = read(self.path("a.vtp"))
        caps = vtk_to_numpy(whole.GetCellData().GetArray("Cap"))
        solids = re.findall(r"(?s)solid (\w+)\n(.*?)endsolid \1\n", self.content("a.stl").decode())
        self.assertEqual([name for name, _ in solids], ["wall", "cap_1", "cap_2"])
        for number, (_, text) in enumerate(solids):
            corners = np.array(re.findall(r"vertex (\S+) (\S+) (\S+)", text), float)
            np.testing.assert_allclose(corners.reshape(-1, 3, 3), points_of(whole)[
                triangles_of(whole)[caps == number]], atol=1e-6)

    def test_file_name_that_is_not_utf_8(self):
        for name, text in ((b"\xe9t\xe9 \xed\xa0\x80.vti", "\ufffdt\ufffd \ufffd\ufffd\ufffd.vti"),
                           (os.fsencode("\u00e9 \U0001f9b4.vti"), "\u00e9 \U0001f9b4.vti")):
            path = os.path.join(os.fsencode(self.folder), name)
            shutil.copy(self.volume, path)
            process = subprocess.run([PROGRAM, path, "--report", "-", "-q"], check=True,
                                     stdout=subprocess.PIPE)
            self.assertEqual(json.loads(process.stdout.decode("utf-8"))["input"]["name"], text)


class PackageTest(CommandTestCase):
    """Tests of the package without the command."""

    def rejects_names(self, reason, **names):
        """Check that output names of each kind, separated by blanks, are rejected."""
        for form, name in ((form, name) for form in names for name in names[form].split()):
            with self.subTest(name, form=form), self.assertRaisesRegex(
                    Failure, rf"{name}: cannot be written \({reason}"):
                files.check_outputs([files.OutputName(self.path(name), form)], [])

    def test_folders_and_rights(self):
        os.chmod(self.folder, 0o777)
        os.mkdir(self.path("b.vtp"))
        os.symlink(self.path("c/a.stl"), self.path("link.stl"))
        os.symlink("nowhere", self.path("loose"))
        self.write_bytes("l", b"")
        os.chmod(self.write_bytes("a.stl", OLD), 0o444)
        os.mkdir(self.path("locked"), 0o555)
        os.makedirs(self.path("closed/inner"))
        os.chmod(self.path("closed"), 0)
        if os.geteuid() == 0:  # root has all permissions
            self.addCleanup(os.seteuid, 0)
            os.seteuid(65534)
        self.rejects_names("Is a directory", file="b.vtp")
        self.rejects_names("there is no folder .*/c", file="c/a.stl link.stl", blocks="c/l.vtm")
        self.rejects_names("there is no folder .*/l", folder="l l/levels loose/m", blocks="l.vtm")
        self.rejects_names("Permission denied", file="a.stl")
        self.rejects_names("the folder .*locked: Permission denied", file="locked/a.stl",
                           folder="locked locked/new/ones")
        self.rejects_names("the folder .*closed.*: Permission denied", file="closed/inner/a.stl",
                           folder="closed/inner/l")

    def test_links_and_pipes(self):
        os.mkdir(self.path("there"))
        os.symlink("there/a", self.path("link"))
        for content in (OLD, b"new"):
            files.replace_file(self.path("link"), content)
            self.assertTrue(os.path.islink(self.path("link")))
            self.assertEqual((self.content("there/a"), os.listdir(self.path("there"))),
                             (content, ["a"]))
        os.mkfifo(self.path("pipe"))
        with subprocess.Popen(["cat", self.path("pipe")], stdout=subprocess.PIPE) as reader:
            files.replace_file(self.path("pipe"), OLD)
            self.assertEqual(reader.stdout.read(), OLD)

    def test_permissions(self):
        owner = (1234, 4321) if os.geteuid() == 0 else (os.getuid(), os.getgid())
        os.chmod(self.write_bytes("old", OLD), 0o600)
        os.chown(self.path("old"), *owner)
        self.addCleanup(os.umask, os.umask(0o027))
        files.replace_file(self.path("old"), b"new")
        with files.output_folder(self.path("l/m")) as folder:
            files.replace_file(os.path.join(folder, "new"), b"new")
        facts = [os.stat(self.path(name)) for name in ("old", "l/m", "l/m/new")]
        self.assertEqual([stat.S_IMODE(each.st_mode) for each in facts], [0o600, 0o750, 0o640])
        self.assertEqual((facts[0].st_uid, facts[0].st_gid), owner)

    def test_ctrl_c_while_vtk_writes(self):
        old = self.write_bytes("a.vti", OLD)
        with self.assertRaises(KeyboardInterrupt):
            writing.write_volume(make_image(ball()), old,
                                 lambda _: os.kill(os.getpid(), signal.SIGINT))
        self.assertEqual((self.content("a.vti"), os.listdir(self.folder)), (OLD, ["a.vti"]))

    def test_errors_name_the_file(self):
        for error, reason in ((lambda path: Failure(f"{path} is full"), "a is full"),
                              (MemoryError, "cannot be written (not enough memory)")):
            with self.assertRaises(Failure) as caught:
                with files.output_file(self.path("a")) as path:
                    raise error(path)
            self.assertEqual(str(caught.exception), f"{self.path('a')}: {reason}")

    def test_large_volumes_are_written_in_pieces(self):
        with unittest.mock.patch.object(surfaces, "SLAB", 3 * 2 * ball()[0].size):
            writing.write_volume(make_image(ball()), self.path("a.vti"))
        self.assertEqual(self.content("a.vti").count(b"<Piece "), 9)
        voxels = vtk_to_numpy(read(self.path("a.vti")).GetPointData().GetScalars())
        np.testing.assert_array_equal(voxels.reshape(ball().shape), ball())


if __name__ == "__main__":
    unittest.main()
