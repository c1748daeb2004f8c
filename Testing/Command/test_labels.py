# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""`volumic --labels`: a surface for each label, its files, the choice of labels, errors."""

import gzip
import json
import os
import re
import unittest

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLImageDataWriter

from command_test_case import (
    ISO, ORIGIN, SPACING, TURNED, CommandTestCase, make_image, medical_files)
from vtk_files import read, read_blocks

# Centres and half axes in voxels along x, y, z; 1 and 2 touch each other.
BLOBS = {1: ((8, 8, 8), (6, 5, 5)), 2: ((18, 8, 8), (5, 5, 5)), 7: ((8, 20, 8), (6, 4, 5)),
         -3: ((20, 20, 9), (5, 5, 6))}
NAMES = {1: "liver", 2: "Left lung", 7: "spleen/x"}


def label_voxels(dtype="i2", blobs=None):
    """[z, y, x]"""
    z, y, x = np.mgrid[0:18, 0:28, 0:28]
    voxels = np.zeros(x.shape, dtype)
    for label, (centre, axes) in (blobs or BLOBS).items():
        inside = sum(((n - c) / a) ** 2 for n, c, a in zip((x, y, z), centre, axes)) < 1
        voxels[inside & (voxels == 0)] = label
    return voxels


def label_image(voxels=None, direction=np.eye(3)):
    return make_image(label_voxels() if voxels is None else voxels, SPACING, ORIGIN, direction)


class LabelsTest(CommandTestCase):
    def map_file(self, name="map.vti", image=None):
        return self.write(vtkXMLImageDataWriter(), name, image or label_image())

    def names_file(self, name="names.json"):
        text = json.dumps({str(label): text for label, text in NAMES.items()})
        return self.write_bytes(name, text.encode())

    def rows(self, *arguments, status=0):
        """{label: row of the report}"""
        return {row["label"]: row for row in self.report(*arguments, status=status)["labels"]}

    def no_surfaces(self, reason, volume, *options, **others):
        """Refused, and the folder for them is not there."""
        self.refused(reason, volume, self.path("none/of/"), *options, **others)
        self.assertFalse(os.path.exists(self.path("none")))

    def bounds_of(self, label):
        """Of the voxels' centres, in world coordinates, for the identity as direction."""
        places = np.argwhere(label_voxels() == label)[:, ::-1] * SPACING + ORIGIN
        return np.ravel(list(zip(places.min(0), places.max(0))))


class OutputsTest(LabelsTest):
    def test_a_folder_has_a_file_for_each_label(self):
        out = self.path("new/out/")
        rows = self.rows(self.map_file(), out, "--labels", "all", "--label-names",
                         self.names_file())
        self.assertEqual(sorted(os.listdir(out)),
                         ["Left_lung.vtp", "label--3.vtp", "liver.vtp", "spleen_x.vtp"])
        for label, row in rows.items():
            surface = read(row["files"][0])
            self.assertEqual(row["files"], [os.path.join(out, os.path.basename(row["files"][0]))])
            self.assertEqual(row["name"], NAMES.get(label, f"Label {label}"))
            self.assertEqual(row["voxels"], (label_voxels() == label).sum())
            self.assertEqual(row["triangles"], surface.GetNumberOfPolys())
            self.assertGreater(row["seconds"], 0)
            self.assertEqual(surface.GetFieldData().GetArray("Label").GetValue(0), label)
            # Half a voxel beyond the centres.
            np.testing.assert_allclose(surface.GetBounds(), self.bounds_of(label), atol=0.75)
            self.assertAlmostEqual(row["volume"] / (row["voxels"] * SPACING.prod()), 1, delta=.06)

    def test_formats(self):
        volume, names = self.map_file(), self.names_file()
        for suffix in ("stl", "ply", "obj", "vtk"):
            out = self.path(suffix)  # not there, without a suffix or slash
            self.run_command(volume, out, "--labels", "1,2", "--format",
                          "." * (suffix == "ply") + suffix, "--label-names", names)
            self.assertEqual(sorted(os.listdir(out)), [f"Left_lung.{suffix}", f"liver.{suffix}"])
        self.assertGreater(read(self.path("stl/liver.stl")).GetNumberOfPolys(), 100)
        self.assertIn(b"liver", self.content("stl/liver.stl")[:80])

    def test_files_of_earlier_runs_are_reported(self):
        volume, folder = self.map_file(), self.path("o/")
        self.run_command(volume, folder, "--labels", "1,2,7")
        self.write_bytes("o/notes.txt", b"")
        process = self.run_command(volume, folder, "--labels", "1")
        self.assertRegex(process.stderr, "warning: .*o/: files of an earlier run are there: "
                         "label-2.vtp, label-7.vtp; delete what is old")
        self.assertEqual(len(os.listdir(folder)), 4)
        process = self.run_command(volume, folder, "--labels", "1,2", "--format", "stl")
        self.assertNotIn("warning", process.stderr)

    def test_blocks(self):
        names = self.write_bytes("n.csv", b'label,name\n1,"a<b & ""c"""\n2,two\n')
        self.run_command(self.map_file(), self.path("out.vtm"), "--labels", "1,2", "--label-names",
                      names)
        blocks = read_blocks(self.path("out.vtm"))
        self.assertEqual(list(blocks), ['a<b & "c"', "two"])
        labels = vtk_to_numpy(blocks["two"].GetCellData().GetArray("Label"))
        self.assertEqual(set(labels), {2})

    def test_merged_into_one_file(self):
        volume = self.map_file()
        report = self.report(volume, self.path("both.vtp"), "--labels", "1,2", "--merge")
        row, = report["labels"]
        self.assertEqual((row["labels"], row["name"], row["components"]),
                         ([1, 2], "Labels 1, 2", 1))
        labels = vtk_to_numpy(read(self.path("both.vtp")).GetCellData().GetArray("Label"))
        self.assertEqual(set(labels), {1, 2})
        self.run_command(volume, self.path("both.vtm"), "--labels", "1,2", "--merge")
        self.assertEqual(list(read_blocks(self.path("both.vtm"))), ["Labels 1, 2"])

    def test_one_label_goes_into_one_file(self):
        volume = self.map_file()
        self.run_command(volume, self.path("a.stl"), "--labels", "2")
        self.assertGreater(read(self.path("a.stl")).GetNumberOfPolys(), 100)
        self.refused(r"b.stl: 4 labels have as many surfaces: give a folder \(.*b/ --format stl\) "
                     r"or blocks \(.*b.vtm, .*b.glb, .*b.3mf\), or .*--merge", volume,
                     self.path("b.stl"), "--labels", "all")
        self.assertFalse(os.path.exists(self.path("b.stl")))

    def test_names_of_files_are_safe_and_different(self):
        names = {1: "../Up", 2: "up", 7: "..", -3: "C:\\con?*\u00e9 1"}
        file = self.write_bytes("n.json", json.dumps(names).encode())
        self.run_command(self.map_file(), self.path("o/"), "--labels", "all", "--label-names", file)
        # Of two that differ in nothing but the case of letters each has its number.
        self.assertEqual(sorted(os.listdir(self.path("o"))),
                         ["C__con__\u00e9_1.vtp", "Up-1.vtp",
                          "label-7.vtp", "up-2.vtp"])
        same = self.write_bytes("s.json", json.dumps({n: "x" * 300 for n in BLOBS}).encode())
        self.run_command(self.map_file(), self.path("p/"), "--labels", "1,2", "--label-names", same)
        self.assertEqual(sorted(os.listdir(self.path("p"))),
                         ["x" * 120 + "-1.vtp", "x" * 120 + "-2.vtp"])

    def test_the_inputs_are_not_replaced(self):
        volume = self.map_file("label-1.vti")
        os.rename(volume, self.path("label-1.vtp"))
        for name in (self.folder, self.path("label-1.vtp")):
            self.refused("label-1.vtp", self.path("label-1.vtp"), name, "--labels", "1")
        names = self.names_file()
        self.refused("names.json: cannot be written: it is the input", self.map_file(),
                     "--labels", "1", "--label-names", names, "--report", names)

    def test_a_folder_that_cannot_be_made(self):
        self.write_bytes("file", b"")
        self.refused("file.*is no folder", self.map_file(), self.path("file/out/"), "--labels",
                     "1")
        self.no_surfaces("there is no label '9'", self.map_file(), "--labels", "9")


class ChoiceTest(LabelsTest):
    def chosen(self, *arguments, volume=None):
        return sorted(self.rows(volume or self.map_file(), "--label-names", self.names_file(),
                                "--list-labels", *arguments))

    def test_numbers_ranges_and_names(self):
        for text, labels in (
                ("all", [-3, 1, 2, 7]), ("ALL", [-3, 1, 2, 7]), ("1", [1]), ("7,1,1", [1, 7]),
                ("2-9", [2, 7]), ("-5--1,7", [-3, 7]), ("-3-1", [-3, 1]), ("liver", [1]),
                ("LIVER, left lung", [1, 2]), ("l*", [1, 2]), ("*", [1, 2, 7]),
                ("Label -3", [-3]), ("spleen/x,0", [0, 7])):
            with self.subTest(text):
                self.assertEqual(self.chosen("--labels", text), sorted(labels))
        self.assertEqual(self.chosen("--labels", "1", "--labels", "7"), [1, 7])

    def test_a_name_with_commas_or_brackets(self):
        file = self.write_bytes("n.json", b'{"1": "lung, left", "2": "a[1]", "7": "a1"}')
        for text, label in (("lung, left", 1), ("a[*", 2), ("a[1]", 2)):
            rows = self.rows(self.map_file(), "--list-labels", "--labels", text, "--label-names",
                             file)
            self.assertEqual(list(rows), [label])

    def test_those_that_are_not_there(self):
        volume = self.map_file()
        for text in ("9", "10-20", "1,kidney", "", "k*"):
            with self.subTest(text):
                self.no_surfaces(
                    r"map.vti: there is no label '[^,]*' \(--labels\); there are -3, 0, "
                    "1 liver, 2 Left lung, 7 spleen/x$", volume, "--labels", text,
                    "--label-names", self.names_file())


class WhatIsReadTest(LabelsTest):
    def test_types_of_voxels(self):
        surfaces = {}
        for dtype in ("i2", "i1", "i8", "f4"):
            volume = self.map_file(f"{dtype}.vti", label_image(label_voxels(dtype)))
            process = self.run_command(volume, self.path(dtype), "--labels", "all")
            surfaces[dtype] = self.content(f"{dtype}/label--3.vtp")
            told = re.search("warning: .*integers", process.stderr)
            self.assertEqual(bool(told), dtype[0] == "f", process.stderr)
        self.assertEqual(len(set(surfaces.values())), 1)

    def test_labels_that_were_resampled(self):
        """Whole but for a little, and one is NaN: they are those of before, and that is told."""
        voxels = label_voxels("f4")
        self.run_command(self.map_file("a.vti", label_image(voxels)), self.path("a"), "--labels",
                         "all")
        self.assertEqual(voxels[0, 0, 0], 0)
        voxels[voxels == 7] = 6.995
        voxels[0, 0, 0] = np.nan
        process = self.run_command(self.map_file("b.vti", label_image(voxels)), self.path("b"),
                                "--labels", "all")
        self.assertRegex(process.stderr,
                         r"warning: .*within 0.00\d+ of integers, .*; NaN, at 1 voxel, is")
        self.assertEqual(self.content("a/label-7.vtp"), self.content("b/label-7.vtp"))

    def test_labels_that_no_int_holds(self):
        """They are chosen, and files are named, by the numbers that the volume has."""
        voxels = label_voxels("i8").astype("u4")
        voxels[voxels == 7] = 2 ** 32 - 2
        volume = self.map_file("map.vti", label_image(voxels))
        process = self.run_command(volume, self.path("o"), "--labels", "1,4294967294")
        self.assertEqual(sorted(os.listdir(self.path("o"))), ["4294967294.vtp", "label-1.vtp"])
        self.assertRegex(process.stderr,
                         "warning: .*numbered anew.*: 4294967293 is 3, 4294967294 is 4")
        rows = self.report(volume, "--list-labels")["labels"]
        self.assertEqual([row["name"] for row in rows if row["label"] > 2],
                         ["4294967293", "4294967294"])

    def masks(self, folder, **masks):
        os.mkdir(self.path(folder))
        for name, mask in masks.items():
            self.write_bytes(f"{folder}/{name}.nii.gz", gzip.compress(
                medical_files.nifti(mask.astype("i2"), SPACING, offset=ORIGIN)))
        return self.path(folder)

    def test_a_folder_of_masks(self):
        """As TotalSegmentator writes them; each has the surface of a map of it alone."""
        voxels = label_voxels()
        folder = self.masks("organs", liver=255 * (voxels == 1), lung_left=voxels == 2,
                            kidney=voxels == 7, absent=voxels == 99)
        self.write_bytes("organs/statistics.json", b"{}")
        process = self.run_command(folder, self.path("o/"), "--labels", "all", "--report",
                                self.path("r.json"))
        self.assertEqual(sorted(os.listdir(self.path("o"))),
                         ["kidney.vtp", "liver.vtp", "lung_left.vtp"])
        self.assertIn("masks without a voxel: absent", process.stderr)
        self.assertNotIn("in two masks", process.stderr)
        rows = {row["name"]: row for row in json.loads(self.content("r.json"))["labels"]}
        self.assertEqual({name: row["voxels"] for name, row in rows.items()},
                         {"kidney": (voxels == 7).sum(), "liver": (voxels == 1).sum(),
                          "lung_left": (voxels == 2).sum()})
        written = self.path("w.vti")
        self.run_command(self.path("organs/*.nii.gz"), "--write-volume", written, "--labels", "all")
        listed = self.report(written, "--list-labels")["labels"]
        self.assertEqual([row["name"] for row in listed if row["label"] > 0],
                         ["kidney", "liver", "lung_left"])

    def test_masks_that_overlap(self):
        """Each has its whole surface; in one mesh a voxel belongs to the smallest mask."""
        voxels = label_voxels()
        part = np.zeros_like(voxels)
        part[6:9, 6:9, 6:9] = 1
        count = (voxels == 1).sum()
        folder = self.masks("m", whole=voxels == 1, part=part, zone=(voxels == 1) & (part == 0))
        rows = {row["name"]: row for row in
                self.report(folder, self.path("o/"), "--labels", "all")["labels"]}
        self.assertEqual({name: row["voxels"] for name, row in rows.items()},
                         {"whole": count, "part": 27, "zone": count - 27})
        for row in rows.values():
            self.assertAlmostEqual(row["volume"] / (row["voxels"] * SPACING.prod()), 1, delta=.06)
        listed = self.report(folder, "--list-labels")["labels"]
        self.assertEqual({row["name"]: row["voxels"] for row in listed if row["label"]},
                         {name: row["voxels"] for name, row in rows.items()})
        process = self.run_command(folder, self.path("a.vtp"), "--labels", "all", "--report",
                                   self.path("r.json"), "--shared-interfaces")
        self.assertRegex(process.stderr, r"warning: .*in two masks \(part and whole 27, whole and "
                         rf"zone {count - 27}\): the smaller mask has it")
        self.assertEqual({row["name"]: row["voxels"]
                          for row in json.loads(self.content("r.json"))["labels"]},
                         {"part": 27, "zone": count - 27})

    def test_masks_behind_each_other_in_one_file(self):
        voxels = label_voxels()
        masks = np.stack([voxels == 1, voxels == 2, voxels == 7])
        file = self.write_bytes("onehot.nii", medical_files.nifti(masks.astype("i2"), SPACING))
        process = self.run_command(file, "--list-labels", "--report", self.path("r.json"))
        self.assertIn("3 volumes, one behind the other, are taken for masks of labels 1 to 3",
                      process.stderr)
        sizes = [(row["label"], row["voxels"])
                 for row in json.loads(self.content("r.json"))["labels"] if row["label"]]
        self.assertEqual(sizes, [(n + 1, mask.sum()) for n, mask in enumerate(masks)])
        one = self.report(file, "--list-labels", "--time", "2")["labels"]
        self.assertEqual([row["voxels"] for row in one if row["label"] == 1], [masks[2].sum()])
        self.refused("choose one with --time", file, self.path("a.stl"), "--iso", "0.5")
        file = self.write_bytes("times.nii", medical_files.nifti(
            np.stack([voxels, voxels]).astype("i2"), SPACING))
        self.refused("volume 0: has the values 1 and 2: a mask has 0 and one other value", file,
                     self.path("o/"), "--labels", "all")

    def test_what_is_no_folder_of_masks(self):
        voxels = label_voxels()
        for name, volume, reason in (
                ("a", voxels, "map.nii.gz: has the values .* a mask has 0 and one other"),
                ("b", voxels[1:] == 1, "map.nii.gz: its voxels are not those of .*liver.nii.gz")):
            folder = self.masks(name, liver=voxels == 1, map=volume)
            self.no_surfaces(reason, folder, "--labels", "all")

    def test_values_that_are_no_labels(self):
        voxels = label_voxels("f4")
        voxels[3, 3, 3] = 0.5
        many = np.arange(18 * 28 * 28).reshape(18, 28, 28).astype("i4")
        many[label_voxels() == 7] = 7
        for reason, voxels, labels in (
                ("map.vti: .*0.5; labels must be integers", voxels, "all"),
                ("map.vti: .*more than 4096", many, "all"),
                ("map.vti: .*has no label 99999", many, "7,99999"),
                ("map.vti: it has no label but the background, 0; .*--background",
                 np.zeros((9, 9, 9), "u1"), "all"),
                ("one slice", label_voxels()[8:9], "all")):
            with self.subTest(reason):
                self.no_surfaces(reason, self.map_file(image=label_image(voxels)), "--labels",
                                 labels)
        row = self.rows(self.map_file(image=label_image(many)), self.path("o/"), "--labels",
                        "7")[7]
        self.assertEqual((row["voxels"], os.listdir(self.path("o"))),
                         ((many == 7).sum(), ["label-7.vtp"]))

    def test_directions_and_spacing(self):
        turned = self.map_file("turned.vti", label_image(direction=TURNED))
        self.run_command(turned, self.path("t/"), "--labels", "7")
        self.run_command(self.map_file(), self.path("s/"), "--labels", "7", "--spacing", "1,1.5,2")
        places = np.argwhere(label_voxels() == 7)[:, ::-1] * SPACING
        for path, world in (("t", places @ TURNED.T), ("s", 2 * places)):
            bounds = read(self.path(f"{path}/label-7.vtp")).GetBounds()
            expected = np.ravel(list(zip(world.min(0), world.max(0)))) + np.repeat(ORIGIN, 2)
            np.testing.assert_allclose(bounds, expected, atol=1.5)


class OptionsTest(LabelsTest):
    def test_every_property_of_labels_is_set(self):
        volume = self.map_file()
        before = self.report(volume, "--labels", "2")["properties"]
        groups = (
            {"BackgroundLabel": "--background 1", "Smoothing": "--smoothing 0.5",
             "VoxelTolerance": "--voxel-tolerance 0.25", "Metric": "--metric voxels",
             "Tolerance": "--tolerance 0.1", "Gradation": "--gradation 0.3",
             "MaximumEdgeLength": "--maximum-edge-length 9", "FinestLevel": "--finest 1",
             "KeepComponents": "--keep large", "TimeLimit": "--time-limit 600",
             "MinimumComponentVolume": "--minimum-component-volume 2", "Merge": "--merge",
             "NumberOfThreads": "--threads 1", "ScratchDirectory": f"--scratch {self.folder}",
             "SelectedComponent": "--component 0"},
            {"EdgeLength": "--edge-length 1.2"}, {"ThinParts": "--thin-parts"},
            {"SharedInterfaces": "--shared-interfaces", "BoxFaces": "--box-faces flat"})
        self.assertEqual(set(before), {name for group in groups for name in group})
        for group in groups:
            words = " ".join(group.values()).split()
            after = self.report(volume, "--labels", "2", *words)["properties"]
            self.assertEqual(after, {**before, **{
                name: (text.split() + ["on"])[1] for name, text in group.items()}})

    def test_properties_reach_the_filter(self):
        """What is in common with vtkDeformableSurface is set there first."""
        volume = self.map_file()

        def volume_of(*options):
            return self.rows(volume, "--labels", "1,2", *options)[1]

        plain = volume_of()
        strict = volume_of("--voxel-tolerance", "0")
        self.assertNotEqual(strict["area"], plain["area"])
        self.assertEqual(strict["wrong_voxels"], strict["missed_voxels"])
        self.assertLess(volume_of("--edge-length", "1.2")["vertices"], 0.6 * plain["vertices"])
        voxels = label_voxels(blobs={1: ((8, 8, 8), (6, 5, 5)), 2: ((20, 20, 9), (4, 3, 3))})
        volume = self.map_file("parts.vti", label_image((voxels > 0).astype("u1")))
        parts = self.rows(volume, "--labels", "1")[1]["component_features"]
        between = (parts[0]["volume"] + parts[1]["volume"]) / 2
        for options in (("--keep", "largest"),
                        ("--keep", "large", "--minimum-component-volume", between)):
            self.assertEqual(self.rows(volume, "--labels", "1", *options)[1]["components"], 1)

    def test_what_excludes_what(self):
        for option, *value in (
                ("--iso", "3"), ("--dark",), ("--seeds", "a.txt"), ("--history", "h.csv"),
                ("--seed-position", "1,2,3"), ("--levels", "2"), ("--keep", "at-points"),
                ("--profile",)):
            with self.subTest(option, value=value):
                self.refused(f"(--labels and {option}|{option}( .*)? and --labels) exclude each "
                             "other", "a.vti", "out/", "--labels", "1", option, *value, status=2)
        for option, *value in (
                ("--merge",), ("--box-faces", "flat"), ("--format", "stl"),
                ("--label-names", "n")):
            with self.subTest(option):
                self.refused(f"{option} needs --labels", "a.vti", "out.stl", option, *value,
                             status=2)
        for reason, arguments in (
                ("no surface format", ["o/", "--format", "dwg"]),
                ("'2' is not the name of a file; write a list of labels with commas",
                 ["o.vtp", "2", "3"]),
                ("'2-3' is not the name of a file; write .*--labels 1,2-3.*", ["2-3"]),
                ("'liver' is not the name of a file; .* a folder with a slash", ["o.vtp", "liver"]),
                ("--format is that of the files in a folder", ["o.stl", "--format", "stl"]),
                ("o.v1: no surface format", ["o.v1"]),
                ("the standard output", ["-"]), ("no file to write", []),
                ("--merge makes one surface; give a file", ["o/", "--merge"]),
                ("--smoothing: 'x' is not a number", ["o/", "--smoothing", "x"])):
            with self.subTest(reason):
                self.refused(reason, "a.vti", "--labels", "1", *arguments, status=2)

    def test_what_the_filter_refuses(self):
        for reason, *options in (
                ("map.vti: --smoothing is -1", "--smoothing", "-1"),
                ("--voxel-tolerance is 2 voxels; it must be at most 1", "--voxel-tolerance", "2")):
            with self.subTest(reason):
                self.no_surfaces(reason, self.map_file(), "--labels", "1", *options)

    def test_labels_that_are_lost_are_told(self):
        voxels = label_voxels()
        voxels[2, 2, 26] = 9
        volume = self.map_file("dot.vti", label_image(voxels))
        # Level 0 loses it, -1 does not.
        process = self.run_command(volume, self.path("h/"), "--labels", "1,9")
        self.assertNotIn("warning", process.stderr)
        self.assertEqual(sorted(os.listdir(self.path("h"))), ["label-1.vtp", "label-9.vtp"])
        process = self.run_command(volume, self.path("o/"), "--labels", "1,9", "--finest", "1",
                                "--report", self.path("r.json"))
        self.assertRegex(process.stderr, "warning: .*Label 9")
        self.assertEqual(os.listdir(self.path("o")), ["label-1.vtp"])
        report = json.loads(self.content("r.json"))
        row = [row for row in report["labels"] if row["label"] == 9][0]
        self.assertEqual((row["triangles"], row["files"], row["voxels"]), (0, [], 1))
        self.assertIn("Label 9", report["warnings"][0])
        self.no_surfaces("none of the labels has a surface", volume, "--labels", "9", "--finest",
                         "1")


class RunTest(LabelsTest):
    def test_an_isopotential_of_a_label_map_is_told(self):
        volume = self.map_file()
        for more in ((), ("--edge-length", "1.2")):
            process = self.run_command(volume, self.path("a.stl"), "--iso", "0.5", *more)
            told = re.findall("warning: .*looks like a label map", process.stderr)
            self.assertEqual(len(told), 1, process.stderr)
        process = self.run_command(volume, self.path("o/"), "--labels", "1")
        self.assertNotIn("looks like", process.stderr)
        process = self.run_command(self.ball_file(), self.path("a.stl"), "--iso", ISO)
        self.assertNotIn("looks like", process.stderr)

    def test_interrupt_keeps_what_is_finished(self):
        # Some of 64; fields were the first 10 %.
        rest = self.interrupted(
            r"Making surfaces: +(1[5-9]|[2-9]\d) % +\d+ of 64, Label", self.many_labels(4),
            self.path("o/"), "--labels", "all", "--threads", "1", "--finest", "-1", "--report",
            self.path("r.json"))
        self.assertIn("unfinished (cancelled); what is finished was written", rest)
        self.assertIn("there is no surface of Label ", rest)
        report = json.loads(self.content("r.json"))
        self.assertFalse(report["finished"])
        self.assertEqual(len(report["labels"]), 64)
        done = [row for row in report["labels"] if row["stop_reason"] != "cancelled"]
        self.assertTrue(0 < len(done) < 64)
        written = {name for row in report["labels"] for name in row["files"]}
        self.assertEqual({self.path("o/") + name for name in os.listdir(self.path("o"))}, written)
        self.assertLessEqual({row["files"][0] for row in done}, written)

    def test_a_time_limit(self):
        volume = self.many_labels(4)
        self.no_surfaces("the time limit came before there was a surface", volume, "--labels",
                         "all", "--time-limit", "1e-9")
        seconds, status = 0.1, 1
        while status == 1:  # until some are finished, long before all are
            process = self.run_command(
                volume, self.path("o/"), "--labels", "all", "--finest", "-1", "--threads", "1",
                "--time-limit", seconds, status=None)
            seconds, status = 2 * seconds, process.returncode
        self.assertEqual(status, 3, process.stderr)
        self.assertIn("unfinished (time limit); what is finished was written", process.stderr)
        self.assertTrue(0 < len(os.listdir(self.path("o"))) <= 64)


if __name__ == "__main__":
    unittest.main()
