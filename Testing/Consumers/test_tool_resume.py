# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The program `volumic` killed on its way: with --resume it goes on, to the same files."""

import csv
import json
import os
import random
import re
import shutil
import signal
import subprocess
import time
import unittest

import numpy as np
from vtkmodules.vtkIOXML import vtkXMLImageDataWriter

from limited_files import largest_file
from tool_test_case import ISO, PROGRAM, ToolTestCase, make_image

# What is told of a run, and may differ from one to the next.
OF_THE_RUN = ("Resume", "ScratchDirectory", "MemoryLimit")


def waves(size=48):
    z, y, x = np.mgrid[0:size, 0:size, 0:size] * 36.0 / size
    voxels = 300 * (np.sin(x / 3) + np.sin(y / 3.5) + np.sin(z / 4 + 1))
    voxels[3:6, 3:6, 4:-4] = 900  # a rod that coarse levels lose
    return make_image(voxels.astype("i2"), (1, 1, 1.5))


class ResumeTestCase(ToolTestCase):
    def setUp(self):
        super().setUp()
        self.scratch = self.path("scratch")
        os.mkdir(self.scratch)

    def waves_file(self):
        return self.write(vtkXMLImageDataWriter(), "waves.vti", waves())

    def arguments(self, volume, name, *more):
        return [str(a) for a in (
            volume, self.path(name + ".vtp"), "--iso", 100, "--report", self.path(name + ".json"),
            "--history", self.path(name + ".csv"), "--levels-output", self.path(name + "-levels"),
            "--snapshots", self.path(name + "-snapshots"), *more)]

    def resume(self, volume, name, *more):
        return self.arguments(volume, name, "--scratch", self.scratch, "--resume", *more)

    def contents(self, name):
        """All that a run has written, but for its seconds and the memory that it took."""
        files = {}
        folders = [self.path(name + "-levels"), self.path(name + "-snapshots")]
        for path in [self.path(name + ".vtp")] + [
                os.path.join(folder, file) for folder in folders
                for file in sorted(os.listdir(folder)) if not file.startswith(".")]:
            files[os.path.basename(path).replace(name, "")] = self.content(path)
        with open(self.path(name + ".csv"), encoding="utf-8", newline="") as file:
            rows = [{k: v for k, v in row.items() if "Seconds" not in k}
                    for row in csv.DictReader(file)]
        report = json.loads(self.content(name + ".json"))
        seconds = report.pop("seconds")
        del report["memory"]
        for level in report["levels"]:
            seconds[level["level"]] = level.pop("seconds")
        for property_ in OF_THE_RUN:
            del report["properties"][property_]
        return files, rows, report, seconds

    def expect_same(self, name, other):
        for one, two in zip(self.contents(name)[:3], self.contents(other)[:3]):
            self.assertEqual(one, two)

    def checkpoint_level(self):
        """That of the checkpoint, by its file; None without one."""
        for folder in os.listdir(self.scratch):
            levels = [int(f[6:]) for f in os.listdir(os.path.join(self.scratch, folder))
                      if re.fullmatch(r"level--?\d+", f)]
            return min(levels, default=None)
        return None

    def stopped(self, arguments, level, stop=signal.SIGKILL):
        """What a run says that is stopped as soon as that level has left its checkpoint. One that was
        quicker than that is made again."""
        for _ in range(20):
            with subprocess.Popen([PROGRAM, *arguments], text=True,
                                  stderr=subprocess.PIPE) as process:
                while process.poll() is None:
                    found = self.checkpoint_level()
                    if found is not None and found <= level:
                        process.send_signal(stop)
                        break
                    time.sleep(0.001)
                said = process.stderr.read()
            if process.returncode != 0:
                self.assertEqual(process.returncode, 3 if stop == signal.SIGINT else -stop, said)
                return said
        self.fail("All runs were too quick to be stopped")

    def kill_at_level(self, level, arguments):
        """@return the level of its checkpoint then."""
        self.stopped(arguments, level)
        return self.checkpoint_level()


class KillTest(ResumeTestCase):
    def test_the_same_files_after_a_kill_at_each_level(self):
        volume = self.waves_file()
        self.run_tool(*self.arguments(volume, "whole"))
        self.assertEqual(os.listdir(self.scratch), [])
        for level, *memory in ((2,), (1, "--memory", "2G")):
            with self.subTest(level=level):
                found = self.kill_at_level(level, self.resume(volume, "killed", *memory))
                run = self.run_tool(*self.resume(volume, "killed", *memory))
                told = int(re.search(r"going on from level (-?\d+)", run.stderr).group(1))
                self.assertEqual(told, found)
                self.expect_same("killed", "whole")
                self.assertEqual(os.listdir(self.scratch), [])

    def test_the_same_files_after_kills_at_random(self):
        volume = self.waves_file()
        started = time.monotonic()
        self.run_tool(*self.arguments(volume, "whole"))
        longest = time.monotonic() - started
        chance = random.Random(15)
        kills = 0
        while kills < 4:
            try:
                subprocess.run([PROGRAM, *self.resume(volume, "killed", "--quiet")], check=True,
                               timeout=chance.uniform(0, longest))
            except subprocess.TimeoutExpired:  # It has been killed.
                kills += 1
        self.run_tool(*self.resume(volume, "killed", "--quiet"))
        self.expect_same("killed", "whole")
        self.assertEqual(os.listdir(self.scratch), [])

    def test_interrupted_and_resumed(self):
        volume = self.waves_file()
        self.run_tool(*self.arguments(volume, "whole"))
        said = self.stopped(self.resume(volume, "part"), 2, signal.SIGINT)
        self.assertIn("the same command with --resume goes on", said)
        self.assertFalse(self.contents("part")[2]["finished"])
        self.run_tool(*self.resume(volume, "part"))
        self.expect_same("part", "whole")
        self.assertEqual(os.listdir(self.scratch), [])


class OutputTest(ResumeTestCase):
    def test_what_could_not_be_written_is_not_lost(self):
        """The checkpoints are larger than the file: of coarse levels some fit."""
        volume = self.waves_file()
        whole, part = self.path("whole.stl"), self.path("part.stl")
        self.run_tool(volume, whole, "--iso", 100)
        resume = (volume, part, "--iso", 100, "--scratch", self.scratch, "--resume")
        run = self.run_tool(*resume, status=1,
                            preexec_fn=largest_file(os.path.getsize(whole) * 3 // 4))
        self.assertIn("part.stl: cannot be written", run.stderr)
        self.assertIn("The checkpoint of level 1 could not be left", run.stderr)
        self.assertIn("can be resumed from level 2 only", run.stderr)
        run = self.run_tool(*resume)
        self.assertIn("going on from level 2,", run.stderr)
        self.assertEqual(self.content(whole), self.content(part))
        self.assertEqual(os.listdir(self.scratch), [])


class RefusalTest(ResumeTestCase):
    def test_without_a_checkpoint_it_begins_anew_and_says_so(self):
        run = self.run_tool(self.ball_file(), self.path("a.vtp"), "--iso", ISO, "--resume",
                            "--scratch", self.scratch)
        self.assertIn("there is no checkpoint to resume from: the run begins anew", run.stderr)
        self.refused("--scratch .*none cannot be used", self.ball_file(), self.path("b.vtp"),
                     "--iso", ISO, "--scratch", self.path("none"))
        self.assertFalse(os.path.exists(self.path("b.vtp")))

    def test_what_is_another_is_named(self):
        """By its option. Testing/Python/test_resume_settings.py has all, in the panel's words."""
        volume = self.waves_file()
        self.kill_at_level(1, self.resume(volume, "killed"))
        for option, *value, name in (
                ("iso", "101", "--iso was 100 and is 101"),
                ("friction", "2.5", "--friction was 3 and is 2.5"),
                ("reduction-factor", "1.5", "not the same levels of the pyramid"),
                ("recovery", "none", "not the same --recovery"),
                ("edge-length", "1.7", "--edge-length was 0 and is 1.7"),
                ("tolerance", "0.4", "--tolerance was 0 and is 0.4"),
                ("refuse-nan", "--refuse-nan was not given and is"),
                ("seed-position", "20,20,20",
                 "not the same --initialization; not the same --seed-position"),
                ("edge-attraction", "0.3", "--edges", volume,
                 "--edge-attraction was 0 and is 0.3; not the same --edges")):
            with self.subTest(option):
                run = self.run_tool(*self.resume(volume, "other"), f"--{option}", *value, status=1)
                self.assertRegex(run.stderr, f"--resume: the checkpoint .* is of other settings: "
                                 f"{name}(; --\\S+ was \\S+ and is \\S+)?. Set it as it was, or, to "
                                 "begin anew, leave --resume away or choose another --scratch")
        self.run_tool(*self.resume(volume, "killed", "--threads", 1))

    def test_another_volume_is_told(self):
        self.kill_at_level(1, self.resume(self.waves_file(), "killed"))
        self.refused("is of another volume: not the same size", *self.resume(self.ball_file(), "a"))
        image = waves()
        image.GetPointData().GetScalars().SetComponent(1234, 0, 77)
        other = self.write(vtkXMLImageDataWriter(), "other.vti", image)
        self.refused("is of another volume: not the same voxels", *self.resume(other, "a"))

    def test_a_copy_of_a_checkpoint_is_told(self):
        volume = self.waves_file()
        self.kill_at_level(1, self.resume(volume, "killed"))
        folder = os.path.join(self.scratch, os.listdir(self.scratch)[0])
        os.rename(folder, folder + ".bak")
        self.refused(f"has not their name. Rename it to {folder}, or", *self.resume(volume, "a"))

    def test_what_others_have_planted_is_not_touched(self):
        """The scratch directory may be one that all may write to."""
        volume = self.waves_file()
        self.kill_at_level(1, self.resume(volume, "killed"))
        folder = os.path.join(self.scratch, os.listdir(self.scratch)[0])
        shutil.rmtree(folder)
        aside = self.path("aside")
        os.mkdir(aside)

        def with_files(*names):
            os.mkdir(folder)
            for name in names:
                with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
                    file.write("precious")

        def looped():
            os.mkdir(folder)
            os.symlink("level-1", os.path.join(folder, "level-1"))

        for name, plant in (("link", lambda: os.symlink(aside, folder)),
                            ("loop", lambda: os.symlink(folder, folder)),
                            ("pipe", lambda: os.mkfifo(folder)),
                            ("file", lambda: open(folder, "wb").close()),
                            ("files", lambda: with_files("notes", "level-1")),
                            ("level", lambda: with_files("level-1")),
                            ("lock", lambda: with_files("lock", "notes")), ("looped", looped)):
            plant()
            before = sorted(os.listdir(folder)) if os.path.isdir(folder) else []
            for more in ((), ("--resume",)):
                with self.subTest(name, more=more):
                    run = self.run_tool(*self.arguments(volume, "a", "--scratch", self.scratch,
                                                        *more))
                    self.assertRegex(run.stderr, f"warning: No checkpoint is left, .*{folder}")
                    self.assertEqual("begins anew" in run.stderr, bool(more))
                    self.assertEqual(before, sorted(os.listdir(folder))
                                     if os.path.isdir(folder) else [])
                    self.assertEqual(os.listdir(aside), [])
            os.rename(folder, self.path("planted-" + name))
        self.run_tool(*self.arguments(volume, "a", "--scratch", self.scratch))
        self.assertEqual(os.listdir(self.scratch), [])

    def test_what_is_put_into_a_checkpoint_stays(self):
        volume = self.waves_file()
        self.kill_at_level(1, self.resume(volume, "killed"))
        folder = os.path.join(self.scratch, os.listdir(self.scratch)[0])
        os.makedirs(os.path.join(folder, "precious", "files"))
        self.run_tool(*self.resume(volume, "killed"))
        self.assertEqual(os.listdir(folder), ["precious"])
        self.assertTrue(os.path.isdir(os.path.join(folder, "precious", "files")))

    @unittest.skipUnless(os.geteuid() == 0, "only root can give files to others")
    def test_what_others_have_left_is_not_read(self):
        volume = self.waves_file()
        level = self.kill_at_level(1, self.resume(volume, "killed"))
        folder = os.path.join(self.scratch, os.listdir(self.scratch)[0])
        os.chown(os.path.join(folder, f"level-{level}"), 12345, 12345)
        self.refused(f"--resume: .*level-{level} is no file of yours. Begin anew",
                     *self.resume(volume, "killed"))
        os.chown(folder, 12345, 12345)
        run = self.run_tool(*self.resume(volume, "killed"))
        self.assertIn("there is no checkpoint to resume from: the run begins anew", run.stderr)
        self.assertIn("is no folder of yours. Remove it", run.stderr)
        os.mkdir(os.path.join(self.scratch, "volumic-" + 16 * "a"))
        os.mkfifo(os.path.join(self.scratch, "volumic-" + 16 * "a", "level-1"))
        run = self.run_tool(self.ball_file(), self.path("a.vtp"), "--iso", ISO, "--resume",
                            "--scratch", self.scratch)
        self.assertIn("there is no checkpoint to resume from: the run begins anew", run.stderr)


if __name__ == "__main__":
    unittest.main()
