# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Tests of `volumic --labels`: surfaces, files, selection of labels, errors, `--list-labels`."""

import gzip
import json
import os
import unittest

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLImageDataWriter

from command_test_case import (
    ISO, ORIGIN, SPACING, CommandTestCase, make_image, medical_files)
from volumic import options
from volumic.errors import Failure, UsageError
from volumic.label_map import KnownLabel, choose
from volumic.option_tables import SHARED_WITH_LABELS, Filters
from vtk_files import read, read_blocks

# Centres and half axes in voxels along x, y, z; labels 1 and 2 are adjacent.
BLOBS = {1: ((8, 8, 8), (6, 5, 5)), 2: ((18, 8, 8), (5, 5, 5)), 7: ((8, 20, 8), (6, 4, 5)),
         -3: ((20, 20, 9), (5, 5, 6))}
NAMES = {1: "liver", 2: "Left lung", 7: "spleen/x"}


def label_voxels(dtype="i2", blobs=None):
    """Return a label map [z, y, x]."""
    z, y, x = np.mgrid[0:18, 0:28, 0:28]
    voxels = np.zeros(x.shape, dtype)
    for label, (centre, axes) in (blobs or BLOBS).items():
        inside = sum(((n - c) / a) ** 2 for n, c, a in zip((x, y, z), centre, axes)) < 1
        voxels[inside & (voxels == 0)] = label
    return voxels


def box_of(voxels, label):
    """Return first and last index along x, y, z."""
    coordinates = np.argwhere(voxels == label)[:, ::-1]
    return np.ravel(list(zip(coordinates.min(0), coordinates.max(0)))).tolist()


class LabelsTest(CommandTestCase):
    def map_file(self, name="map.vti", image=None):
        return self.write(vtkXMLImageDataWriter(), name, image or make_image(label_voxels()))

    def names_file(self, name="names.json"):
        text = json.dumps({str(label): text for label, text in NAMES.items()})
        return self.write_bytes(name, text.encode())

    def rows(self, *arguments, status=0):
        """Return report entries by label."""
        return {row["label"]: row for row in self.report(*arguments, status=status)["labels"]}

    def no_surfaces(self, reason, volume, *options, **others):
        """Check that the command fails and creates no folder."""
        self.rejects(reason, volume, self.path("none/of/"), *options, **others)
        self.assertFalse(os.path.exists(self.path("none")))

    def bounds_of(self, label):
        """Return the bounds of voxel centres of a label in world coordinates."""
        coordinates = np.argwhere(label_voxels() == label)[:, ::-1] * SPACING + ORIGIN
        return np.ravel(list(zip(coordinates.min(0), coordinates.max(0))))


class OutputsTest(LabelsTest):
    def test_folder_with_one_file_per_label(self):
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
            self.assertEqual(surface.GetFieldData().GetArray("Label").GetValue(0), label)
            np.testing.assert_allclose(surface.GetBounds(), self.bounds_of(label), atol=0.75)
            self.assertAlmostEqual(row["volume"] / (row["voxels"] * SPACING.prod()), 1, delta=.01)
            self.assertEqual((row["parts"], row["wrong_parts"]), (1, 0))

    def test_formats_and_files_of_earlier_runs(self):
        volume, names, folder = self.map_file(), self.names_file(), self.path("o")
        # A new folder without suffix and slash.
        options_ = ("--labels", "1,2,7", "--label-names", names)
        self.run_command(volume, folder, "--format", "stl", *options_)
        self.assertGreater(read(self.path("o/liver.stl")).GetNumberOfPolys(), 100)
        self.assertIn(b"liver", self.content("o/liver.stl")[:80])
        self.write_bytes("o/notes.txt", b"")
        for suffix, warning in (("stl", "warning: .*o: files of an earlier run exist: "
                                 "label-2.stl; delete them"), (".ply", "^((?!warning).)*$")):
            os.rename(self.path("o/liver.stl"), self.path("o/label-2.stl"))
            process = self.run_command(volume, folder, "--format", suffix, *options_)
            self.assertRegex(process.stderr.replace("\n", " "), warning)
            self.assertEqual({name.partition(".")[0] for name in os.listdir(folder)},
                             {"Left_lung", "label-2", "liver", "notes", "spleen_x"})

    def test_blocks_and_merged_surfaces(self):
        names = self.write_bytes("n.csv", b'label,name\n1,"a<b & ""c"""\n2,two\n')
        for options_, labels in (((), {'a<b & "c"': {1}, "two": {2}}),
                                 (("--merge",), {"Labels 1, 2": {1, 2}})):
            report = self.report(self.map_file(), self.path("out.vtm"), "--labels", "1,2",
                                 "--label-names", names, *options_)
            blocks = read_blocks(self.path("out.vtm"))
            self.assertEqual({name: set(vtk_to_numpy(block.GetCellData().GetArray("Label")))
                              for name, block in blocks.items()}, labels)
        row, = report["labels"]
        self.assertEqual((row["labels"], row["components"]), ([1, 2], 1))

    def test_single_label_in_a_file(self):
        volume = self.map_file()
        self.run_command(volume, self.path("a.stl"), "--labels", "2")
        self.assertGreater(read(self.path("a.stl")).GetNumberOfPolys(), 100)
        self.rejects(r"b.stl: a .stl file stores one surface, not 4; give a folder "
                     r"\(.*b/ --format stl\), a file with several surfaces \(.*b.vtm, .glb, "
                     r".3mf\) or with one mesh of all labels \(.*b.vtp, .vtk, .vtu, .inp, .msh, "
                     r".smesh, .poly\), or set --merge", volume,
                     self.path("b.stl"), "--labels", "all")
        self.assertFalse(os.path.exists(self.path("b.stl")))

    def test_file_names_are_safe_and_unique(self):
        # Names that differ only in case get numbers.
        for folder, names, files in (
                ("o/", {1: "../Up", 2: "up", 7: "..", -3: "C:\\con?*\u00e9 1"},
                 ["C__con__\u00e9_1.vtp", "Up-1.vtp", "label-7.vtp", "up-2.vtp"]),
                ("p/", {1: "x" * 300, 2: "x" * 300, 7: "con", -3: "x-1"},
                 ["con_.vtp", "x" * 120 + "-1.vtp", "x" * 120 + "-2.vtp", "x-1.vtp"])):
            file = self.write_bytes("n.json", json.dumps(names).encode())
            self.run_command(self.map_file(), self.path(folder), "--labels", "all",
                             "--label-names", file)
            self.assertEqual(sorted(os.listdir(self.path(folder))), sorted(files))

    def test_invalid_outputs(self):
        volume = self.map_file("label-1.vti")
        os.rename(volume, self.path("label-1.vtp"))
        for name in (self.folder, self.path("label-1.vtp")):
            self.rejects("label-1.vtp", self.path("label-1.vtp"), name, "--labels", "1")
        names = self.names_file()
        self.rejects("names.json: cannot be written: it is the input", self.map_file(),
                     "--labels", "1", "--label-names", names, "--report", names)
        self.rejects("names.json.*is no folder", self.map_file(), self.path("names.json/out/"),
                     "--labels", "1")


class ChoiceTest(unittest.TestCase):
    known = [KnownLabel(-3, "Label -3"), KnownLabel(0, "Label 0"), KnownLabel(1, "liver"),
             KnownLabel(2, "Left lung"), KnownLabel(7, "spleen/x"), KnownLabel(8, "a, b"),
             KnownLabel(9, "a[1]")]

    def test_numbers_ranges_and_names(self):
        for text, labels in (
                ("all", [-3, 1, 2, 7, 8, 9]), ("ALL", [-3, 1, 2, 7, 8, 9]), ("1", [1]),
                ("7,1,1", [1, 7]), ("2-8", [2, 7, 8]), ("-5--1,7", [-3, 7]), ("-3-1", [-3, 1]),
                ("liver", [1]), ("LIVER, left lung", [1, 2]), ("l*", [1, 2]),
                ("*", [1, 2, 7, 8, 9]), ("Label -3", [-3]), ("spleen/x,0", [0, 7]),
                ("a, b", [8]), ("a[*", [9]), ("a[1],0", [0, 9])):
            with self.subTest(text):
                self.assertEqual([label.label for label in choose([text], self.known, 0)], labels)
        self.assertEqual(len(choose(["1", "7"], self.known, 0)), 2)

    def test_unknown_labels_fail(self):
        for text in ("99", "10-20", "1,kidney", "", "k*"):
            with self.subTest(text), self.assertRaisesRegex(Failure, (
                    r"no label matches '[^,]*' \(--labels\); the labels are -3, 0, 1 liver, "
                    "2 Left lung, 7 spleen/x")):
                choose([text], self.known, 0)


class InputTest(LabelsTest):
    def test_scalar_types(self):
        resampled = label_voxels("f4")
        resampled[resampled == 7], resampled[0, 0, 0] = 6.995, np.nan
        surfaces = set()
        for name, voxels, warning in (
                ("i8", label_voxels("i8"), "^((?!warning).)*$"),
                ("f4", label_voxels("f4"), "warning: .*integers"),
                ("near", resampled, r"within 0.00\d+ of integers, .*; 1 NaN voxel is")):
            process = self.run_command(self.map_file(image=make_image(voxels)), self.path(name),
                                       "--labels", "7")
            self.assertRegex(process.stderr.replace("\n", " "), warning)
            surfaces.add(self.content(f"{name}/label-7.vtp"))
        self.assertEqual(len(surfaces), 1)

    def test_labels_beyond_int(self):
        """Labels are selected, and files named, by the values in the file."""
        voxels = label_voxels("i8").astype("u4")
        voxels[voxels == 7] = 2 ** 32 - 2
        volume = self.map_file("map.vti", make_image(voxels))
        process = self.run_command(volume, self.path("o"), "--labels", "1,4294967294")
        self.assertEqual(sorted(os.listdir(self.path("o"))), ["4294967294.vtp", "label-1.vtp"])
        self.assertRegex(process.stderr,
                         "warning: .*renumbered.*: 4294967293 is 3, 4294967294 is 4")

    def test_folder_of_masks(self):
        """As written by TotalSegmentator."""
        voxels = label_voxels()
        part = np.zeros_like(voxels)
        part[6:9, 6:9, 6:9] = 1
        masks = {"liver": 255 * (voxels == 1), "lung_left": voxels == 2, "part": part,
                 "absent": voxels == 99}
        os.mkdir(self.path("organs"))
        for name, mask in masks.items():
            self.write_bytes(f"organs/{name}.nii.gz", gzip.compress(
                medical_files.nifti(mask.astype("i2"), SPACING, offset=ORIGIN)))
        self.write_bytes("organs/statistics.json", b"{}")
        voxels_of = {name: np.count_nonzero(mask) for name, mask in masks.items() if mask.any()}
        rows = self.report(self.path("organs"), self.path("o/"), "--labels", "all")["labels"]
        self.assertEqual({row["name"]: row["voxels"] for row in rows}, voxels_of)
        self.assertEqual(sorted(os.listdir(self.path("o"))),
                         ["liver.vtp", "lung_left.vtp", "part.vtp"])

    def test_invalid_label_maps(self):
        voxels = label_voxels("f4")
        voxels[3, 3, 3] = 0.5
        many = np.arange(18 * 28 * 28).reshape(18, 28, 28).astype("i4")
        for reason, voxels, labels in (
                ("map.vti: .*0.5; labels must be integers", voxels, "all"),
                ("map.vti: .*more than 4096", many, "all"),
                ("map.vti: .*has no label 99999", many, "7,99999"),
                ("map.vti: the only label is the background, 0; .*--background",
                 np.zeros((9, 9, 9), "u1"), "all"),
                ("map.vti: no label matches '9'", label_voxels(), "9"),
                ("single slice", label_voxels()[8:9], "all")):
            with self.subTest(reason):
                self.no_surfaces(reason, self.map_file(image=make_image(voxels)), "--labels",
                                 labels)


class OptionsTest(LabelsTest):
    def test_every_property_reaches_the_filter(self):
        words = {
            "BackgroundLabel": "--background 1", "Smoothing": "--smoothing 0.5",
            "VoxelTolerance": "--voxel-tolerance 0.25", "Metric": "--metric voxels",
            "Tolerance": "--tolerance 0.1", "Gradation": "--gradation 0.25",
            "MaximumEdgeLength": "--maximum-edge-length 9", "FinestLevel": "--finest 1",
            "KeepComponents": "--keep large", "TimeLimit": "--time-limit 600",
            "MinimumComponentVolume": "--minimum-component-volume 2", "Merge": "--merge",
            "NumberOfThreads": "--threads 1", "ScratchDirectory": f"--scratch {self.folder}",
            "SelectedComponent": "--component 0", "EdgeLength": "--edge-length 1.2",
            "SharedInterfaces": "--shared-interfaces", "BoxFaces": "--box-faces flat"}
        report = self.report(self.map_file(), "--labels", "2", *words["Smoothing"].split())
        self.assertEqual(set(report["properties"]), set(words))
        self.assertEqual(report["properties"]["Smoothing"], "0.5")
        for name, text in words.items():
            filters, before = Filters(), Filters()
            options.apply(options.parse(["a.vti", "o.vtp", "--labels", "1", *text.split()]),
                          filters)
            changed = {each for each in {*SHARED_WITH_LABELS, *words} - {"SelectedComponent"}
                       if getattr(filters.labels, "Get" + each)()
                       != getattr(before.labels, "Get" + each)()}
            self.assertEqual(changed, {name} - {"SelectedComponent", "SharedInterfaces"})

    def test_incompatible_options(self):
        cases = [(f"(--labels and {option}|{option}( .*)? and --labels) are mutually exclusive",
                  "out/ --labels 1", option, *value) for option, *value in (
                        ("--iso", "3"), ("--dark",), ("--seeds", "a.txt"), ("--history", "h.csv"),
                        ("--seed-position", "1,2,3"), ("--levels", "2"), ("--keep", "at-points"))]
        cases += [(f"{option} requires --labels", "out.stl", option, *value) for option, *value in (
            ("--merge",), ("--box-faces", "flat"), ("--format", "stl"), ("--label-names", "n"))]
        for reason, line in (
                ("unknown suffix", "o/ --format dwg"), ("o.v1: unknown suffix", "o.v1"),
                ("'2' is not a file name; separate labels by commas", "o.vtp 2 3"),
                ("'2-3' is not a file name; .*--labels 1,2-3.*", "2-3"),
                ("'liver' is not a file name; .* end a folder with a slash", "o.vtp liver"),
                ("--format requires a folder as output", "o.stl --format stl"),
                ("the standard output", "-"), ("no output is given", ""),
                ("--thin-parts and --labels .* use --edge-length", "o/ --thin-parts"),
                ("--gap is not supported: adjacent labels share", "o/ --gap 1"),
                ("--merge yields one surface; give a file", "o/ --merge")):
            cases.append((reason, "--labels 1 " + line))
        for reason, line, *more in cases:
            with self.subTest(line, more=more), self.assertRaisesRegex(UsageError, reason):
                options.parse(["a.vti", *line.split(), *more])

    def test_small_labels(self):
        voxels = label_voxels()
        voxels[2, 2, 26] = 9
        volume = self.map_file("dot.vti", make_image(voxels))
        for number, more in enumerate(((), ("--finest", "1"))):
            self.run_command(volume, self.path(f"o{number}/"), "--labels", "1,9", *more)
            self.assertEqual(sorted(os.listdir(self.path(f"o{number}"))),
                             ["label-1.vtp", "label-9.vtp"])
        for reason, *more in (
                ("the surfaces of all labels are empty", "--keep", "large",
                 "--minimum-component-volume", "99"),
                ("dot.vti: --smoothing is -1", "--smoothing", "-1")):
            self.no_surfaces(reason, volume, "--labels", "9", *more)


class RunTest(LabelsTest):
    def test_isosurface_of_a_label_map_warns(self):
        for count, volume, *more in (
                (1, self.map_file(), self.path("a.stl"), "--iso", "0.5"),
                (1, self.map_file(), self.path("a.stl"), "--iso", "0.5", "--edge-length", "1.2"),
                (0, self.map_file(), self.path("o/"), "--labels", "1"),
                (0, self.ball_file(), self.path("a.stl"), "--iso", ISO)):
            process = self.run_command(volume, *more)
            self.assertEqual(process.stderr.count("looks like a label map"), count, process.stderr)

    def test_interrupted_run_writes_surfaces(self):
        output = self.interrupted(
            r"Computing surfaces: +[5-8]\d %", self.many_labels(4), self.path("o/"), "--labels",
            "all", "--threads", "1", "--finest", "-1", "--report", self.path("r.json"))
        self.assertIn("unfinished (cancelled): the current surfaces were written", output)
        report = json.loads(self.content("r.json"))
        self.assertFalse(report["finished"])
        self.assertEqual(len(report["labels"]), 64)
        self.assertEqual({row["stop_reason"] for row in report["labels"]}, {"cancelled"})
        written = {name for row in report["labels"] for name in row["files"]}
        self.assertEqual({self.path("o/") + name for name in os.listdir(self.path("o"))}, written)

    def test_time_limit(self):
        self.no_surfaces("time limit reached before a surface was computed", self.many_labels(4),
                         "--labels", "all", "--time-limit", "1e-9")


class ListTest(LabelsTest):
    def table(self, *arguments):
        """Return the split rows of the printed table."""
        lines = self.run_command("--list-labels", *arguments).stdout.splitlines()
        self.assertRegex(lines[0], r"^ *label +voxels +volume +.*box \(first\.\.last voxel along "
                                   r"i, j, k\) +name$")
        return [line.split() for line in lines[1:]]

    def listed(self, *arguments):
        return self.report("--list-labels", *arguments)["labels"]

    def test_table_and_json(self):
        voxels, options = label_voxels(), (self.map_file(), "--label-names", self.names_file())
        lines, rows = self.table(*options), self.listed(*options)
        surfaces = self.rows(self.map_file(), "--labels", "all")
        self.assertEqual([row["label"] for row in rows], sorted(BLOBS))
        for line, row in zip(lines, rows):
            label, count, box = row["label"], row["voxels"], row["box"]
            self.assertEqual(list(row), ["label", "name", "color", "layer", "voxels", "volume",
                                         "box"])
            self.assertEqual(row["name"], NAMES.get(label, f"Label {label}"))
            self.assertEqual((count, box, row["layer"]),
                             ((voxels == label).sum(), box_of(voxels, label), 0))
            self.assertEqual((int(line[0]), int(line[1]), " ".join(line[6:])),
                             (label, count, row["name"]))
            self.assertAlmostEqual(float(line[2]), count * SPACING.prod(), delta=1e-3)
            self.assertEqual(line[3:6], [f"{box[i]}..{box[i + 1]}" for i in (0, 2, 4)])
            for name in ("voxels", "color", "layer"):
                self.assertEqual(row[name], surfaces[label][name])

    def test_selected_labels(self):
        volume, names = self.map_file(), self.names_file()
        for options, labels in ((["--labels", "l*"], [1, 2]), (["--labels", "0,7"], [0, 7]),
                                (["--background", "1"], [-3, 0, 2, 7])):
            rows = self.listed(volume, "--label-names", names, *options)
            self.assertEqual([row["label"] for row in rows], labels)
        self.rejects("map.vti: no label matches 'kidney'", volume, "--list-labels", "--labels",
                     "kidney")

    def test_floating_point_and_spacing(self):
        volume = self.map_file("f.vti", make_image(label_voxels("f4")))
        report = self.report(volume, "--list-labels", "--labels", "7", "--spacing", "1,1,3")
        row, = report["labels"]
        self.assertEqual(row["volume"], 3 * row["voxels"])
        self.assertEqual(report["labels"][0]["box"], box_of(label_voxels(), 7))
        half = self.map_file("h.vti", make_image(np.full((9, 9, 9), 0.5)))
        self.rejects("h.vti: .*labels must be integers", half, "--list-labels")
        many = np.arange(18 * 28 * 28).reshape(18, 28, 28).astype("i4")
        self.rejects("more than 4096", self.map_file("many.vti", make_image(many)),
                     "--list-labels", "--labels", "7")
