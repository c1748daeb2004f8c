# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Tests that written files are complete and never replace an input."""

import json
import os
import random
import re
import shutil
import signal
import stat
import subprocess
import unittest
import unittest.mock

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkIOLegacy import vtkStructuredPointsWriter
from vtkmodules.vtkIOXML import vtkXMLImageDataWriter
from volumic import writing
from volumic.errors import Failure
from volumic.writing import files, surfaces

from command_test_case import (
    ISO, PROGRAM, CommandTestCase, ball, largest_file, make_image)
from vtk_files import points_of, read, triangles_of

OLD = b"an older result"


class OutputsTest(CommandTestCase):
    def setUp(self):
        super().setUp()
        self.volume = self.ball_file()
        self.words = [self.volume, "--iso", str(ISO), "--levels", "2", "-q"]


class AllKindsTest(OutputsTest):
    """Runs write files of all kinds. Each file is whole and from one run, or the old one."""

    def setUp(self):
        super().setUp()
        labels = self.write(vtkXMLImageDataWriter(), "map.vti", make_image((ball() > ISO).astype("u1")))
        suffixes = "vtk vtp stl ply obj glb 3mf msh smesh poly" + " vtu inp" * bool(shutil.which("tetgen"))
        names = [self.path(f"out/a.{suffix}") for suffix in suffixes.split()]
        names += [f"--{option}=" + self.path(f"out/{name}") for option, name in (
            ("write-volume", "v.vti"), ("history", "h.csv"), ("report", "r.json"),
            ("levels-output", "l.vtm"), ("snapshots", "s"))]
        self.pairs = [  # of runs with the same outputs
            [[PROGRAM, *self.words[:2], str(iso), *self.words[3:], *names] for iso in (ISO, 450)],
            [[PROGRAM, labels, "-q", "--labels", "all", "--smoothing", size, *(self.path(
                f"out/{name}") for name in ("m/", "n.vtm", "o.glb", "p.vtp"))] for size in "12"]]

    def files(self):  # without seconds and memory, which differ between runs
        found = [os.path.join(folder, name) for folder, _, names in os.walk(self.path("out"))
                 for name in names if ".volumic-" not in folder]
        return {name: re.sub(rb"\d[\d.e+-]*", b"0", self.content(name)) if name.endswith(
            (".csv", ".json")) else self.content(name) for name in found}

    def files_of(self, words, is_new=True, **options):  # in a new folder, or with old files
        old = {} if is_new else self.files()
        shutil.rmtree(self.path("out"), ignore_errors=is_new)
        for folder in {self.path("out"), *map(os.path.dirname, old)}:
            os.makedirs(folder, exist_ok=True)
        for name in old:
            self.write_bytes(name, OLD)
        printed = subprocess.run(words, check=False, stderr=subprocess.PIPE, text=True, **options).stderr
        return self.files(), printed

    @unittest.skipUnless(os.path.exists("/dev/full"), "no /dev/full")
    def test_devices(self):
        process = self.run_command(*self.words, "--report", "/dev/full", status=1)
        self.assertIn("/dev/full: cannot be written (No space left", process.stderr)
        self.assertTrue(stat.S_ISCHR(os.stat("/dev/full").st_mode), "it was replaced")
        process = self.run_command(*self.words, "--history", "/dev/stdout")
        self.assertIn("\"Iteration\",", process.stdout)
        for option in (["--report", "-"], ["--help"], ["--version"], ["--list-properties"]):
            with self.subTest(option), open("/dev/full", "w", encoding="utf-8") as full:
                process = subprocess.run([PROGRAM, *self.words, *option], stdout=full, check=False,
                                         stderr=subprocess.PIPE, text=True)
                self.assertEqual(process.returncode, 1)
                self.assertRegex(process.stderr, "the standard output.*No space left")

    def test_full_disk(self):
        """Files that fit are written. Of others the old one is kept, or nothing remains."""
        for (words, _), is_new in zip(2 * self.pairs, (False, False, True, True)):
            words[2:] = [word for word in words[2:] if word[-4:] not in (".vti", ".vtu", ".inp")]
            whole, _ = self.files_of(words)
            limit = sorted(map(os.path.getsize, whole))[len(whole) // 3]
            found, printed = self.files_of(words, is_new, preexec_fn=largest_file(limit))
            written = {name for name in whole if found.get(name) == whole[name]}
            self.assertTrue(0 < len(written) < len(whole))
            self.assertEqual({found[name] for name in found.keys() - written}, set() if is_new else {OLD})
            for output in re.findall(self.path(r"out/[\w.]+"), " ".join(words)):
                folder = os.path.splitext(output)[0] + "/"
                parts = {name for name in whole if name == output or name.startswith(folder)}
                if not parts <= written:
                    self.assertRegex(printed, f"volumic: {output}.*: cannot be written .File too large")
                    self.assertTrue(parts.isdisjoint(written))
                    self.assertFalse(is_new and os.path.exists(folder))

    def test_full_temporary_folder(self):
        volume = self.write(vtkStructuredPointsWriter(), "a.vtk", make_image(ball()))
        self.rejects("a.vtk: File too large: /", volume, "--report", "-", preexec_fn=largest_file(9999))

    def test_killed_runs(self):
        words, numbers = self.pairs[0][0], random.Random(74)
        whole, _ = self.files_of(words)
        for kind in 2 * (signal.SIGKILL, signal.SIGTERM, signal.SIGINT):
            for name in whole:
                self.write_bytes(name, OLD)
            last, seen = numbers.randrange(4, 16), set()
            with subprocess.Popen(words) as process:
                while process.poll() is None and (len(seen) < last or numbers.random() < .998):
                    seen.update(name for name in os.listdir(self.path("out")) if name[0] == ".")
                process.send_signal(kind)
            code = process.returncode  # 1: TetGen was stopped, 3: the evolution was
            self.assertIn(code, (0, 1, 3, -signal.SIGKILL), kind)
            if code == 3:
                self.assertEqual(1, len({len(triangles_of(read(name))) for name in whole if re.search(
                    r"/a\.(vtp|stl|ply|obj)$", name)}))
            self.assertEqual({name for name, content in self.files().items() if content in (
                OLD, whole[name]) or code == 3 or (code == 1 and "json" in name)}, set(whole))

    def test_two_runs_at_once(self):
        for pair in self.pairs:
            wholes = [self.files_of(words)[0] for words in pair]
            processes = [subprocess.Popen(words) for words in pair]
            self.assertEqual([process.wait() for process in processes], [0, 0])
            for name, content in self.files().items():
                self.assertTrue(any(content == whole.get(name) for whole in wholes), name)


class InvalidNamesTest(OutputsTest):
    """Output names are checked before the volume, which is invalid here, is read."""

    def setUp(self):
        super().setUp()
        self.no_image = self.write_bytes("no.vti", b"nothing")

    def rejects_at_once(self, reason, *lines):
        for line in lines:
            with self.subTest(line):
                process = self.run_command(self.no_image, *(
                    word if word.startswith("--") else self.path(word) for word in line.split()),
                    status=1)
                self.assertRegex(process.stderr, f"cannot be written: .* {reason} ")
                self.assertEqual(self.content("no.vti"), b"nothing")

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
    def test_point_arrays_are_written_or_reported(self):
        names = ("a.vtp", "a.ply", "a.stl", "b.stl", "a.obj", "a.3mf")
        printed = self.run_command(self.volume, "--iso", ISO, "--probe", self.volume, "--thin-parts",
                                   "--progress", *map(self.path, names)).stderr
        self.assertRegex(printed, r"(?m)^Writing .*/a.vtp:  *\d+ %$")
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

    def test_all_components_are_resampled(self):
        image = make_image(ball())
        image.GetPointData().SetScalars(numpy_to_vtk(np.repeat(ball("f4").reshape(-1, 1), 3, 1), True))
        self.run_command(self.write(vtkXMLImageDataWriter(), "a.vti", image), self.path("a.stl"),
                         "--iso", ISO, "--resample", "1,1,1", "--write-volume", self.path("b.vti"))
        image = read(self.path("b.vti"))
        self.assertEqual((image.GetSpacing(), image.GetNumberOfScalarComponents()), ((1, 1, 1), 3))

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
    def rejects_names(self, reason, **names):
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
        self.rejects_names("File name too long", file="n" * 252 + ".stl")
        self.rejects_names("the folder .*locked: Permission denied", file="locked/a.stl",
                           folder="locked locked/new/ones")
        self.rejects_names("the folder .*closed.*: Permission denied", file="closed/inner/a.stl",
                           folder="closed/inner/l")

    def test_links(self):
        os.mkdir(self.path("there"))
        os.symlink("there/a", self.path("link"))
        for content in (OLD, b"new"):
            files.replace_file(self.path("link"), content)
            self.assertTrue(os.path.islink(self.path("link")))
            self.assertEqual((self.content("there/a"), os.listdir(self.path("there"))),
                             (content, ["a"]))

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
        with self.assertRaises(KeyboardInterrupt):
            writing.write_volume(make_image(ball()), self.path("a.vti"),
                                 lambda _: os.kill(os.getpid(), signal.SIGINT))
        self.assertEqual(os.listdir(self.folder), [])

    def test_errors_name_the_file(self):
        for error, reason in ((lambda path: Failure(f"{path} is full"), "a is full"),
                              (MemoryError, "cannot be written .not enough memory.")):
            with self.assertRaisesRegex(OSError, f"^{self.path('a')}: {reason}$"):
                with files.output_file(self.path("a")) as path:
                    raise error(path)

    def test_hidden_folder_is_removed_by_another_process(self):
        with self.assertRaisesRegex(OSError, "a: cannot be written .No such file"):
            with files.output_file(self.path("a")) as path:
                shutil.rmtree(os.path.dirname(path))
        error = FileNotFoundError(2, "removed")
        with unittest.mock.patch.object(files, "_publish", side_effect=[error, None]) as publish:
            files.replace_file(self.path("a"), b"new")
        self.assertEqual(publish.call_count, 2)

    def test_large_volumes_are_written_in_pieces(self):
        with unittest.mock.patch.object(surfaces, "SLAB", 3 * 2 * ball()[0].size):
            writing.write_volume(make_image(ball()), self.path("a.vti"))
        voxels = vtk_to_numpy(read(self.path("a.vti")).GetPointData().GetScalars())
        self.assertEqual((self.content("a.vti").count(b"<Piece "), voxels.tolist()),
                         (9, ball().ravel().tolist()))


if __name__ == "__main__":
    unittest.main()
