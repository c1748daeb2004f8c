# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Tests of coordinate systems and units: those of files, --unit, --scale, --space, and those of
outputs."""

import json
import os

import numpy as np

from command_test_case import (
    CENTRE, ISO, ORIGIN, SIZE, SPACING, CommandTestCase, ball, dicom_slice, medical_files,
    nrrd_header)
from vtk_files import points_of, read

SFORM = np.column_stack((np.diag(SPACING), ORIGIN))
MIDDLE = ORIGIN + SPACING * CENTRE


class SpaceTest(CommandTestCase):
    def nifti(self, unit):
        content = bytearray(medical_files.nifti(ball(), SPACING, SFORM, offset=ORIGIN))
        content[123] = unit
        self.write_bytes("a.nii", bytes(content))
        return self.path("a.nii")

    def nrrd(self, more=b""):
        name = "b.nrrd" if more else "a.nrrd"
        self.write_bytes(name, nrrd_header() + more + b"\n" + ball().tobytes())
        return self.path(name)

    def run_to(self, suffix, volume, *options, status=0):
        """Return messages and report of a run to this format."""
        process = self.run_command(volume, self.path("a." + suffix), "--iso", ISO, "--levels", 1,
                                "--report", self.path("r.json"), *options, status=status)
        return process.stderr, json.loads(self.content("r.json"))

    def middle(self):
        points = points_of(read(self.path("a.vtp")))
        return (points.min(axis=0) + points.max(axis=0)) / 2

    def fields(self):
        fields = read(self.path("a.vtp")).GetFieldData()
        arrays = [fields.GetAbstractArray(name) for name in ("SPACE", "LengthUnit")]
        return [array.GetValue(0) if array else None for array in arrays]

    def test_space_and_unit_of_files(self):
        os.mkdir(self.path("dicom"))
        for i in range(SIZE[2]):
            self.write_bytes(f"dicom/{i}.dcm", dicom_slice(i))
        self.write_bytes("a.mrc", medical_files.mrc(ball(), SPACING))
        for volume, space, unit in (
                (self.nifti(2), "RAS", "mm"), (self.nifti(3), "RAS", "um"),
                (self.nifti(0), "RAS", ""), (self.nrrd(), "LPS", ""),
                (self.nrrd(b'space units: "mm" "mm" "mm"\n'), "LPS", "mm"),
                (self.path("dicom"), "LPS", "mm"), (self.path("a.mrc"), "", "A"),
                (self.ball_file(), "", "")):
            if "nii" in volume:
                volume = self.nifti({"mm": 2, "um": 3, "": 0}[unit])
            with self.subTest(volume, unit=unit):
                printed, report = self.run_to("vtp", volume)
                facts = report["input"]
                self.assertEqual((facts["space"], facts["unit"]), (space, unit))
                self.assertEqual((facts["file_space"], facts["file_unit"]), (space, unit))
                self.assertEqual(self.fields(), [space or None, unit or None])
                text = ", ".join(f"{what} {is_}" for what, is_ in
                                 (("space", space), ("unit", unit)) if is_)
                self.assertIn(f"{'; ' if text else ''}{text}\n", printed)

    def test_space(self):
        volume = self.nifti(2)
        self.run_to("vtp", volume)
        np.testing.assert_allclose(self.middle(), MIDDLE, atol=0.1)
        printed, report = self.run_to("vtp", volume, "--space", "LPS", "--write-volume",
                                      self.path("w.vti"))
        self.assertIn("space LPS (of the file: RAS), unit mm\n", printed)
        self.assertEqual(report["input"]["file_space"], "RAS")
        np.testing.assert_allclose(self.middle(), MIDDLE * [-1, -1, 1], atol=0.1)
        self.assertEqual(self.fields(), ["LPS", "mm"])
        again = self.run_to("vtp", self.path("w.vti"))[1]
        self.assertEqual(again["volume"], report["volume"])
        np.testing.assert_allclose(self.middle(), MIDDLE * [-1, -1, 1], atol=0.1)
        self.run_to("vtp", self.path("w.vti"), "--space", "RAS")
        np.testing.assert_allclose(self.middle(), MIDDLE, atol=0.1)
        self.run_to("vtp", volume, "--space", "as-file")
        np.testing.assert_allclose(self.middle(), MIDDLE, atol=0.1)
        self.rejects("ball.vti: --space LPS: the file does not state its coordinate", self.ball_file(),
                     self.path("a.stl"), "--iso", ISO, "--space", "LPS")

    def test_unit_and_scale(self):
        volume = self.nifti(3)
        plain = self.run_to("vtp", volume)[1]
        printed, report = self.run_to("vtp", volume, "--unit", "mm")
        self.assertIn("unit mm (of the file: um), lengths of the file times 0.001\n", printed)
        self.assertAlmostEqual(report["area"] / plain["area"], 1e-6, delta=1e-11)
        np.testing.assert_allclose(self.middle(), MIDDLE / 1000, atol=1e-4)
        np.testing.assert_allclose(report["input"]["spacing"], SPACING / 1000)
        self.assertEqual(self.fields(), ["RAS", "mm"])
        printed, scaled = self.run_to("vtp", volume, "--scale", "0.001")
        self.assertEqual((scaled["area"], scaled["input"]["unit"]), (report["area"], "mm"))
        printed, scaled = self.run_to("vtp", volume, "--scale", "3")
        self.assertEqual((scaled["input"]["unit"], self.fields()), ("", ["RAS", None]))
        self.rejects("--unit mm: the file does not state its unit; use --scale", self.ball_file(),
                     self.path("a.stl"), "--iso", ISO, "--unit", "mm")

    def test_labels(self):
        voxels = (ball() > ISO).astype("u1")
        content = bytearray(medical_files.nifti(voxels, SPACING, SFORM, offset=ORIGIN))
        content[123] = 2
        self.write_bytes("l.nii", bytes(content))
        report = self.report(self.path("l.nii"), self.path("a.vtp"), "--labels", "1", "--unit",
                             "um", "--space", "LPS")
        self.assertEqual((report["input"]["unit"], report["input"]["scale"]), ("um", 1000))
        np.testing.assert_allclose(self.middle(), MIDDLE * [-1e3, -1e3, 1e3], atol=400)
        self.assertEqual(self.fields(), ["LPS", "um"])
        listed = self.report(self.path("l.nii"), "--list-labels", "--unit", "m")
        self.assertAlmostEqual(
            listed["labels"][0]["volume"], voxels.sum() * np.prod(SPACING) * 1e-9, delta=1e-12)

    def test_file_headers(self):
        """3D Slicer reads them; meshes without are in LPS."""
        for suffix, end in (("stl", 80), ("ply", 300), ("obj", 80), ("vtk", 300)):
            self.run_to(suffix, self.nifti(2))
            self.assertIn(b"SPACE=RAS, unit mm", self.content("a." + suffix)[:end], suffix)
            self.run_to(suffix, self.ball_file())
            self.assertNotIn(b"SPACE", self.content("a." + suffix)[:end], suffix)
        self.run_to("stl", self.nifti(2), "--iterations", "5", status=3)
        self.assertRegex(self.content("a.stl")[:80],
                         rb"^volumic [0-9.]+, SPACE=RAS, unit mm, UNFINISHED: iteration limit ")

    def test_scenes(self):
        self.run_to("glb", self.nifti(2))
        content = self.content("a.glb")
        length = int.from_bytes(content[12:16], "little")
        extras = json.loads(content[20:20 + length])["nodes"][1]["extras"]
        self.assertEqual((extras["SPACE"], extras["LengthUnit"]), ("RAS", "mm"))
