# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""What `volumic` writes takes its place when it is whole, and never that of an input."""

import contextlib
import json
import os
import random
import re
import shutil
import signal
import stat
import subprocess
import time
import unittest
import unittest.mock

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLImageDataReader, vtkXMLImageDataWriter
from volumic import writing
from volumic.errors import Failure
from volumic.writing import files, surfaces

from limited_files import largest_file
from command_test_case import ISO, PROGRAM, CommandTestCase, ball, make_image
from vtk_files import points_of, read, triangles_of

SURFACES = ("vtp", "vtk", "stl", "ply", "obj", "glb", "3mf", "msh", "smesh", "poly")
OLD = b"an older result"


def nobody():
    """A preexec_fn: the rights of nobody, if we have root's, for whom nothing is forbidden."""
    if os.geteuid() == 0:
        os.setgroups([])
        os.setgid(65534)
        os.setuid(65534)


class OutputsTest(CommandTestCase):
    def setUp(self):
        super().setUp()
        self.volume = self.ball_file()

    def segment(self, *arguments, **options):
        return self.run_command(self.volume, "--iso", ISO, "--levels", 2, "-q", *arguments, **options)

    def without_rests(self, *names):
        """No file but these, the volume and those of earlier calls is in the folder."""
        self.assertEqual([n for n in os.listdir(self.folder) if n.startswith(".")], [])
        for name in names:
            self.assertIn(name, os.listdir(self.folder))


class FullDiskTest(OutputsTest):
    def old_survives_limit(self, name, limit, *arguments):
        self.write_bytes(name, OLD)
        process = self.segment(*arguments, status=1, preexec_fn=largest_file(limit))
        self.assertRegex(process.stderr, f"^volumic: .*{name}: cannot be written "
                         r"\(.*(File too large|is the disk full\?)\)")
        self.assertEqual(self.content(name), OLD)
        self.without_rests(name)

    def test_a_surface_that_lacks_its_last_byte(self):
        for suffix in SURFACES:
            name = f"a.{suffix}"
            self.segment(self.path(name))
            with self.subTest(name):
                self.old_survives_limit(name, os.path.getsize(self.path(name)) - 1, self.path(name))

    def test_other_files(self):
        for option, name in (("--history", "h.csv"), ("--report", "r.json"),
                             ("--write-volume", "v.vti"), ("--levels-output", "l.vtm"),
                             ("--snapshots", "s.vtm")):
            self.segment(option, self.path(name))
            whole = os.path.getsize(self.path(name))
            # A limit on the .vtm alone is none on the larger files of its blocks, nor can be.
            for limit in (whole - 100, whole // 2) if not name.endswith("vtm") else (1000,):
                with self.subTest(name, limit=limit):
                    self.old_survives_limit(name, limit, option, self.path(name))

    def test_a_folder(self):
        self.write_bytes("old", b"")
        for kind, *arguments in (("levels", "--levels-output"), ("labels", "--labels", "all")):
            process = self.run_command(self.volume, *arguments[:1], *(
                [self.path("l"), "--iso", ISO] if kind == "levels" else ["all", self.path("l/")]),
                status=1, preexec_fn=largest_file(1000))
            self.assertRegex(process.stderr, r"/l.*: cannot be written \(File too large\)")
            self.assertFalse(os.path.exists(self.path("l")), kind)

    def test_what_fails_does_not_stop_the_others(self):
        said = self.segment(self.path("a.obj"), self.path("b.obj"), "--history", self.path("h.csv"),
                            status=1, preexec_fn=largest_file(20000)).stderr
        self.assertRegex(said, r"^volumic: /.*/a.obj: .*\nvolumic: /.*/b.obj: .*\n$")
        self.without_rests("h.csv")

    @unittest.skipUnless(os.path.exists("/dev/full"), "no /dev/full")
    def test_devices(self):
        for option in ("--history", "--report"):
            process = self.segment(option, "/dev/full", status=1)
            self.assertIn("/dev/full: cannot be written (No space left", process.stderr)
            self.assertTrue(stat.S_ISCHR(os.stat("/dev/full").st_mode), "it was replaced")
        self.assertIn("\"Iteration\",", self.segment("--history", "/dev/stdout").stdout)
        self.segment("--report", "/dev/null")
        self.assertTrue(stat.S_ISCHR(os.stat("/dev/null").st_mode))

    @unittest.skipUnless(os.path.exists("/dev/full"), "no /dev/full")
    def test_standard_output(self):
        for arguments in ([self.volume, "--iso", str(ISO), "--report", "-"], ["--help"],
                          ["--version"], ["--list-properties"]):
            with self.subTest(arguments[-1]), open("/dev/full", "w", encoding="utf-8") as full:
                process = subprocess.run([PROGRAM, *arguments], stdout=full, stderr=subprocess.PIPE,
                                         text=True, check=False)
                self.assertEqual(process.returncode, 1)
                self.assertRegex(process.stderr, "the standard output.*No space left")


class KilledTest(OutputsTest):
    def test_the_old_file_or_the_new_one_is_there(self):
        names = [f"{i}.{end}" for i in range(3) for end in ("obj", "vtp", "stl", "ply", "glb")]
        paths = [self.path(name) for name in names]
        self.segment(*paths)
        new = {name: self.content(name) for name in names}
        random.seed(1)
        were_old = 0
        # Five times, and till one of them was early enough.
        for attempt in range(60):
            if attempt >= 5 and were_old > 0:
                break
            for name in names:
                self.write_bytes(name, OLD)
            with subprocess.Popen([PROGRAM, self.volume, *paths, "--iso", str(ISO), "--levels",
                                   "2", "-q"]) as process:
                # The trial of the folder comes first, then a hidden folder for each file.
                while process.poll() is None and not self.hidden_files():
                    pass
                time.sleep(random.uniform(0, 0.03))
                process.kill()
            for name in names:
                self.assertIn(self.content(name), (OLD, new[name]), name)
                were_old += self.content(name) == OLD
            self.assertEqual({n for n in os.listdir(self.folder) if n[0] != "."},
                             {*names, "ball.vti"})
            for hidden in self.hidden_folders():
                shutil.rmtree(hidden)
        self.assertGreater(were_old, 0, "all were killed after they had written")

    def hidden_folders(self):
        return [self.path(n) for n in os.listdir(self.folder) if n.startswith(".volumic-")]

    def hidden_files(self):
        found = []
        for folder in self.hidden_folders():
            with contextlib.suppress(FileNotFoundError):
                found += os.listdir(folder)
        return found

    def test_runs_at_the_same_time(self):
        command = [PROGRAM, self.volume, self.path("a.obj"), "--iso", str(ISO), "--levels", "2", "-q",
                   "--levels-output", self.path("l.vtm"), "--snapshots", self.path("s")]
        processes = [subprocess.Popen(command) for _ in range(4)]
        self.assertEqual([process.wait() for process in processes], [0] * 4)
        together = self.content("a.obj")
        self.segment(self.path("a.obj"))
        self.assertEqual(self.content("a.obj"), together)
        self.without_rests("l", "l.vtm", "s")


class PlacesTest(OutputsTest):
    """All that is refused is so before the volume, which is no image here, is read."""

    def setUp(self):
        super().setUp()
        self.no_image = self.write_bytes("no image.vti", b"nothing")

    def refused_at_once(self, reason, *arguments, **options):
        process = self.run_command(self.no_image, *arguments, status=1, **options)
        self.assertRegex(process.stderr, reason)
        self.assertNotRegex(process.stderr, "no image.vti: (?!cannot be written)")
        self.without_rests()

    def test_folders_and_missing_folders(self):
        os.mkdir(self.path("b.vtp"))
        os.symlink(self.path("c/a.stl"), self.path("link.stl"))
        os.symlink("nowhere", self.path("loose"))
        for name in ("file", "l"):
            self.write_bytes(name, b"")
        for reason, *option, name in (
                ("b.vtp: cannot be written: it is a folder", "b.vtp"),
                ("b.vtp: cannot be written: it is a folder", "--history", "b.vtp"),
                ("there is no folder .*/c", "c/a.stl"),
                ("there is no folder .*/c", "--history", "c/h.csv"),
                ("there is no folder .*/c", "--levels-output", "c/l.vtm"),
                ("link.stl: there is no folder .*/c", "link.stl"),
                ("file is no folder", "--levels-output", "file/levels"),
                ("is no folder", "--levels-output", "file"),
                ("loose is no folder", "--levels-output", "loose/levels"),
                ("l is no folder", "--levels-output", "l.vtm")):
            with self.subTest(name, option=option):
                self.refused_at_once(reason, *option, self.path(name))

    def as_nobody(self, reason, *arguments):
        os.chmod(self.folder, 0o755)
        if subprocess.run([PROGRAM, "--version"], preexec_fn=nobody, check=False,
                          capture_output=True).returncode != 0:
            self.skipTest("nobody may not run the program")
        self.refused_at_once(reason, *arguments, preexec_fn=nobody)

    def test_folders_that_cannot_be_written_to(self):
        os.mkdir(self.path("locked"), mode=0o555)
        for *option, name in (("locked/a.stl",), ("--report", "locked/r.json"),
                              ("--levels-output", "locked"), ("--snapshots", "locked/new/ones")):
            with self.subTest(name):
                self.as_nobody("cannot be written .the folder .*locked: Permission denied", *option,
                               self.path(name))

    def test_folders_that_cannot_be_looked_into(self):
        os.mkdir(self.path("closed"), mode=0o700)
        os.mkdir(self.path("closed/inner"))
        for *option, name in (("closed/inner/a.stl",), ("--levels-output", "closed/inner/l")):
            with self.subTest(name):
                self.as_nobody("cannot be written: Permission denied", *option, self.path(name))

    def test_files_that_are_write_protected(self):
        os.mkdir(self.path("open"))
        os.chmod(self.path("open"), 0o777)
        os.chmod(self.write_bytes("open/a.stl", OLD), 0o444)
        self.as_nobody("a.stl: cannot be written: Permission denied", self.path("open/a.stl"))
        self.assertEqual(self.content("open/a.stl"), OLD)

    def test_inputs_are_not_replaced(self):
        os.link(self.no_image, self.path("hard.json"))
        os.symlink("no image.vti", self.path("soft.csv"))
        before = self.content("no image.vti")
        for arguments in (["--report", self.no_image], ["--history", self.no_image],
                          ["--report", self.path("hard.json")],
                          ["--history", self.path("soft.csv")]):
            with self.subTest(arguments):
                self.refused_at_once("cannot be written: it is the input .*no image.vti",
                                     *arguments)
        process = self.run_command("no image.vti", "--report", "./no image.vti", status=1,
                                cwd=self.folder)
        self.assertIn("it is the input", process.stderr)
        self.assertEqual(self.content("no image.vti"), before)

    def test_nor_are_other_inputs(self):
        os.mkdir(self.path("levels"))
        replaced = "would be replaced, which is the input"
        for reason, input_option, name, *output in (
                ("input .*start.stl", "--initial-surface", "start.stl", "start.stl"),
                ("input .*seeds.csv", "--seeds", "seeds.csv", "--history", "seeds.csv"),
                ("input .*seeds.csv", "--attracting-points", "seeds.csv", "--history", "seeds.csv"),
                ("input .*edges.vti", "--edges", "edges.vti", "--report", "edges.vti"),
                (f"level-2.vtp {replaced}", "--initial-surface", "levels/level-2.vtp",
                 "--levels-output", "levels"),
                (f"levels_0.vtp {replaced}", "--initial-surface", "levels/levels_0.vtp",
                 "--levels-output", "levels.vtm")):
            with self.subTest(input_option, name=name):
                self.refused_at_once(reason, input_option, self.write_bytes(name, b"1,2,3"),
                                     *output[:-1], self.path(output[-1]))

    def test_the_other_files_of_a_volume(self):
        for header, text, data in (
                ("a.mhd", b"ObjectType = Image\nElementDataFile = a.raw\n", "a.raw"),
                ("b.mhd", b"ElementDataFile = LIST\n b1.raw\nb2.raw\n", "b2.raw"),
                ("c.mhd", b"NDims = 3\nDimSize = 2 2 1\nElementType = MET_UCHAR\n"
                 b"ElementDataFile = c%02d.raw 2 2 1\n", "c02.raw"),
                ("d.nhdr", b"NRRD0004\nData File: d.gz\n", "d.gz"),
                ("e.pvti", b"<VTKFile>\n<Piece Source=\"e_0.vti\"/>", "e_0.vti"),
                ("f.img", b"", "f.hdr"), ("series", None, "series/IM1")):
            with self.subTest(header):
                if text is None:
                    os.mkdir(self.path(header))
                    self.write_bytes(data, bytes(128) + b"DICM")
                else:
                    self.write_bytes(header, text)
                    self.write_bytes(data, OLD)
                before = self.content(data)
                process = self.run_command(self.path(header), "--report", self.path(data), status=1)
                self.assertIn("it is the input", process.stderr)
                self.assertEqual(self.content(data), before)

    def test_outputs_that_are_one_file(self):
        os.symlink("b.vtp", self.path("c.vtp"))
        os.mkdir(self.path("l"))
        for words in (("a.vtp", "a.vtp"), ("b.vtp", "c.vtp"), ("a.vtp", "--history", "./a.vtp"),
                      ("--report", "r", "--history", "r"),
                      ("--levels-output", "l.vtm", "--snapshots", "l.vtm"),
                      ("l/level-0.vtp", "--levels-output", "l"),
                      ("l/l_0.vtp", "--levels-output", "l.vtm")):
            with self.subTest(words):
                self.refused_at_once("would take the same place", *(
                    word if word.startswith("--") else self.path(word) for word in words))


class WrittenTest(OutputsTest):
    def test_writing_shows_its_progress(self):
        names = [self.path("a." + suffix) for suffix in ("vtp", "vtk", "stl")]
        said = self.run_command(self.volume, "--iso", ISO, "--levels", 2, "--progress", *names).stderr
        for name in names:
            self.assertRegex(said, rf"(?m)^Writing {name}:  *\d+ %$")

    def test_values_are_written_or_reported(self):
        said = self.run_command(
            self.volume, "--iso", ISO, "--probe", self.volume, "--thin-parts",
            *(self.path(f"{stem}.{suffix}") for stem, suffix in (
                ("a", "vtp"), ("a", "ply"), ("a", "stl"), ("b", "stl"), ("a", "obj"), ("a", "3mf")))).stderr
        lost = [line for line in said.splitlines() if "has no place" in line]
        self.assertEqual([line.split(": ")[2][-5:] for line in lost], ["a.stl", "a.obj", "a.3mf"])
        for line in lost:
            self.assertIn("values Thickness, ball; .vtp, .vtk and .ply have", line)
        whole = read(self.path("a.vtp")).GetPointData()
        head, body = self.content("a.ply").split(b"end_header\n")
        self.assertIn(b"property float Thickness\nproperty double ball\nelement face", head)
        rows = np.frombuffer(body, [("place", "<f4", 3), ("normal", "<f4", 3), ("Thickness", "<f4"),
                                    ("ball", "<f8")], whole.GetNumberOfTuples())
        for name, array in (("normal", "Normals"), ("Thickness", "Thickness"), ("ball", "ball")):
            np.testing.assert_array_equal(rows[name], vtk_to_numpy(whole.GetArray(array)))

    def test_files_of_an_earlier_run_are_reported(self):
        for output, old in (("l", "/l: files of an earlier run are there: level-1.vtp;"),
                            ("m.vtm", "/m: files of an earlier run are there: m_1.vtp;")):
            arguments = (self.volume, "--iso", ISO, "--levels-output", self.path(output), "--levels")
            self.assertNotIn("earlier run", self.run_command(*arguments, 2).stderr)
            self.assertIn(old, self.run_command(*arguments, 1).stderr)

    def test_caps_are_solids_of_an_stl(self):
        """As OpenFOAM's tools read it: a text with a named solid for each patch."""
        voxels = np.minimum(ball(), 900)
        voxels[:] = voxels[len(voxels) // 2]  # a cylinder, which leaves the volume at both ends
        self.write(vtkXMLImageDataWriter(), "tube.vti", make_image(voxels))
        self.run_command(self.path("tube.vti"), "--iso", ISO, "--ends", "marked",
                         self.path("a.vtp"), self.path("a.stl"))
        whole = read(self.path("a.vtp"))
        caps = vtk_to_numpy(whole.GetCellData().GetArray("Cap"))
        solids = re.findall(r"(?s)solid (\w+)\n(.*?)endsolid \1\n", self.content("a.stl").decode())
        self.assertEqual([name for name, _ in solids], ["wall", "cap_1", "cap_2"])
        for number, (_, text) in enumerate(solids):
            places = np.array([line.split()[1:] for line in text.splitlines() if "vertex" in line], float)
            np.testing.assert_allclose(places.reshape(-1, 3, 3), points_of(whole)[
                triangles_of(whole)[caps == number]], atol=1e-6)
        self.assertIn("a.ply: .ply has no place for the numbers of caps", self.run_command(
            self.path("tube.vti"), "--iso", ISO, "--ends", "marked", self.path("a.ply")).stderr)

    def test_links_are_followed(self):
        os.mkdir(self.path("there"))
        self.write_bytes("there/a.stl", OLD)
        os.symlink("there/a.stl", self.path("link.stl"))
        os.symlink(self.path("there/new.stl"), self.path("loose.stl"))
        self.segment(self.path("link.stl"), self.path("loose.stl"))
        self.assertTrue(os.path.islink(self.path("link.stl")))
        self.assertEqual(self.content("there/a.stl"), self.content("there/new.stl"))
        self.assertEqual(sorted(os.listdir(self.path("there"))), ["a.stl", "new.stl"])

    def test_permissions(self):
        os.chmod(self.write_bytes("old.stl", OLD), 0o640)
        if os.geteuid() == 0:
            os.chown(self.path("old.stl"), 1234, 4321)
        self.segment(self.path("old.stl"), self.path("new.stl"), "--levels-output", self.path("l"),
                     "--report", self.path("r.json"), preexec_fn=lambda: os.umask(0o027))
        modes = {n: stat.S_IMODE(os.stat(self.path(n)).st_mode)
                 for n in ("old.stl", "new.stl", "r.json", "l", "l/level-0.vtp")}
        self.assertEqual(modes, {"old.stl": 0o640, "new.stl": 0o640, "r.json": 0o640, "l": 0o750,
                                 "l/level-0.vtp": 0o640})
        if os.geteuid() == 0:
            facts = os.stat(self.path("old.stl"))
            self.assertEqual((facts.st_uid, facts.st_gid), (1234, 4321))

    def test_a_pipe_gets_the_whole_file(self):
        os.mkfifo(self.path("pipe.stl"))
        with subprocess.Popen(["cat", self.path("pipe.stl")], stdout=subprocess.PIPE) as reader:
            self.segment(self.path("pipe.stl"))
            read = reader.stdout.read()
        self.segment(self.path("a.stl"))
        self.assertEqual(read, self.content("a.stl"))

    def test_a_name_that_is_not_utf_8(self):
        name = os.path.join(os.fsencode(self.folder), b"\xe9t\xe9 \xed\xa0\x80.vti")
        with open(name, "wb") as file:
            file.write(self.content("ball.vti"))
        process = subprocess.run([PROGRAM, name, "--report", "-", "-q"], check=True,
                                 capture_output=True)
        report = json.loads(process.stdout.decode("utf-8"))
        self.assertEqual(report["input"]["name"], "\ufffdt\ufffd \ufffd\ufffd\ufffd.vti")
        os.rename(name, self.path("\u00e9t\u00e9 \U0001f9b4.vti"))
        self.volume = self.path("\u00e9t\u00e9 \U0001f9b4.vti")
        report = json.loads(self.segment("--report", "-").stdout)
        self.assertEqual(report["input"]["name"], "\u00e9t\u00e9 \U0001f9b4.vti")


class PackageTest(CommandTestCase):
    """What the command cannot show."""

    def test_ctrl_c_while_vtk_writes(self):
        old = self.write_bytes("a.vti", OLD)
        with self.assertRaises(KeyboardInterrupt):
            writing.write_volume(make_image(ball()), old,
                                 lambda _: os.kill(os.getpid(), signal.SIGINT))
        self.assertEqual((self.content("a.vti"), os.listdir(self.folder)), (OLD, ["a.vti"]))

    def test_errors_name_the_file_and_no_hidden_folder(self):
        for error, reason in ((lambda path: Failure(f"{path} is full"), "a is full"),
                              (MemoryError, "cannot be written (not enough memory)")):
            with self.assertRaises(Failure) as caught:
                with files.output_file(self.path("a")) as path:
                    raise error(path)
            self.assertEqual(str(caught.exception), f"{self.path('a')}: {reason}")

    def test_large_volumes_are_written_in_slabs(self):
        with unittest.mock.patch.object(surfaces, "SLAB", 3 * 2 * ball()[0].size):
            writing.write_volume(make_image(ball()), self.path("a.vti"))
        self.assertEqual(self.content("a.vti").count(b"<Piece "), 9)
        image = read(self.path("a.vti"), vtkXMLImageDataReader())
        self.assertEqual(image.GetDimensions(), ball().shape[::-1])
        np.testing.assert_array_equal(
            vtk_to_numpy(image.GetPointData().GetScalars()), ball().ravel())


if __name__ == "__main__":
    unittest.main()
