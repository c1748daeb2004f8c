# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The scripts keep an older file until the new one is whole, and never replace what they read."""

import os
import stat
import sys
import unittest


from examples_path import EXAMPLES
from folder_test_case import FolderTestCase
from sample_volumes import RING_ISO, RING_SPACING, ring_voxels, run_script, write_volume

sys.path.insert(0, EXAMPLES)
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "Consumers"))
# pylint: disable=wrong-import-position
from limited_files import largest_file
from output_files import beside, check_output

OLD = b"an older result"


class OutputFilesTest(FolderTestCase):
    def without_rests(self):
        self.assertEqual([n for n in os.listdir(self.folder) if n.startswith(".")], [])


class BesideTest(OutputFilesTest):
    def test_an_exception_leaves_the_old_file(self):
        path = self.write_bytes("a.stl", OLD)
        with self.assertRaises(KeyError):
            with beside(path) as written:
                with open(written, "wb") as file:
                    file.write(b"half")
                raise KeyError
        self.assertEqual(self.content("a.stl"), OLD)
        self.without_rests()

    def test_links_and_permissions(self):
        os.mkdir(self.path("there"))
        os.chmod(self.write_bytes("there/a", OLD), 0o640)
        os.symlink("there/a", self.path("link"))
        with beside(self.path("link")) as written, open(written, "wb") as file:
            file.write(b"new")
        self.assertTrue(os.path.islink(self.path("link")))
        self.assertEqual(self.content("there/a"), b"new")
        self.assertEqual(stat.S_IMODE(os.stat(self.path("there/a")).st_mode), 0o640)
        mask = os.umask(0o027)
        try:
            with beside(self.path("new")) as written, open(written, "wb") as file:
                file.write(b"new")
        finally:
            os.umask(mask)
        self.assertEqual(stat.S_IMODE(os.stat(self.path("new")).st_mode), 0o640)

    @unittest.skipUnless(os.path.exists("/dev/full"), "no /dev/full")
    def test_devices_are_not_replaced(self):
        with self.assertRaisesRegex(OSError, "/dev/full cannot be written .No space left"):
            with beside("/dev/full") as written, open(written, "wb") as file:
                file.write(b"new")
        self.assertTrue(stat.S_ISCHR(os.stat("/dev/full").st_mode))

    def test_inputs(self):
        scan = self.write_bytes("scan", OLD)
        os.link(scan, self.path("hard"))
        os.symlink(scan, self.path("soft"))
        for name in (scan, self.path("hard"), self.path("soft")):
            with self.assertRaisesRegex(OSError, "it would replace the input .*scan"):
                check_output(name, [scan])
        os.mkdir(self.path("levels"))
        block = self.write_bytes("levels/levels_0.vti", OLD)
        with self.assertRaisesRegex(OSError, "it would replace the input .*levels_0.vti"):
            check_output(self.path("levels.vtm"), [block])


class ScriptsTest(OutputFilesTest):
    def setUp(self):
        super().setUp()
        self.ring = write_volume(self.path("ring.mha"), ring_voxels()[::2, ::2, ::2], RING_SPACING)

    def refused(self, reason, run):
        self.assertEqual(run.returncode, 1, run.stderr)
        self.assertRegex(run.stderr + run.stdout, reason)
        self.assertNotIn("Traceback", run.stderr)
        self.without_rests()

    def segment(self, output, *options, **settings):
        return run_script("segment.py", self.ring, output, "--iso", str(RING_ISO), *options,
                          **settings)

    def test_a_full_disk(self):
        for suffix in ("stl", "ply", "obj", "vtp"):
            path = self.path(f"a.{suffix}")
            self.assertEqual(self.segment(path).returncode, 0)
            limit = os.path.getsize(path) - 1
            self.write_bytes(f"a.{suffix}", OLD)
            with self.subTest(suffix):
                self.refused(f"a.{suffix} cannot be written",
                             self.segment(path, preexec_fn=largest_file(limit)))
                self.assertEqual(self.content(f"a.{suffix}"), OLD)

    def test_the_scan_itself(self):
        scan = self.content("ring.mha")
        os.link(self.ring, self.path("surface.stl"))
        self.refused("it would replace the input", self.segment(self.path("surface.stl")))
        self.assertEqual(self.content("ring.mha"), scan)

    def test_a_volume_is_not_converted_into_itself(self):
        volume = self.path("a.vti")
        self.assertEqual(run_script("read_volume.py", self.ring, volume).returncode, 0)
        before = self.content("a.vti")
        self.refused("it is the input", run_script("read_volume.py", volume, volume))
        self.assertEqual(self.content("a.vti"), before)
        self.refused("a.vti: cannot be written", run_script(
            "read_volume.py", self.ring, volume, preexec_fn=largest_file(len(before) // 2)))
        self.assertEqual(self.content("a.vti"), before)

    def batch(self, **settings):
        os.makedirs(self.path("scans"), exist_ok=True)
        write_volume(self.path("scans/ring.mha"), ring_voxels()[::2, ::2, ::2], RING_SPACING)
        return run_script("batch.py", self.path("scans"), "--output", self.path("out"), "--iso",
                          str(RING_ISO), "--format", "stl", **settings)

    def test_a_table(self):
        self.assertEqual(self.batch().returncode, 0)
        table, surface = self.content("out/results.csv"), self.content("out/ring.stl")
        self.refused("ring.stl cannot be written", self.batch(
            preexec_fn=largest_file(len(surface) - 1)))
        self.assertEqual(self.content("out/ring.stl"), surface)
        self.assertIn(b"ring.mha,failed", self.content("out/results.csv"))
        self.write_bytes("out/results.csv", table)
        self.refused("results.csv cannot be written", self.batch(preexec_fn=largest_file(50)))
        self.assertEqual(self.content("out/results.csv"), table)


if __name__ == "__main__":
    unittest.main()
