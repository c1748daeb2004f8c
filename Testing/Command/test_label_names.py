# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Tests of label names: files of all kinds, files next to a volume, .seg.nrrd headers, damaged
files."""

import gzip
import json
import os
import shutil
import struct

import numpy as np
from vtkmodules.vtkIOXML import vtkXMLImageDataWriter

from command_test_case import ORIGIN, SPACING, CommandTestCase, make_image

import medical_files
from vtk_files import read
from volumic.errors import Failure
from volumic.reading.tables import names_beside, read_label_names

SEGMENTS = ("Segment0_Name:=liver", "Segment0_LabelValue:=3", "Segment0_Color:=1 0.5 0",
            "Segment0_Layer:=0", "Segment0_ID:=Segment_1",
            "Segmentation_MasterRepresentation:=Binary labelmap", "Segment1_Name:=Left\\nlung",
            "Segment1_LabelValue:=1", "Segment1_Color:=0 0 1", "Segment1_Layer:=0")


def label_voxels():
    """Return cuboids with labels 1, 3 and 4."""
    voxels = np.zeros((14, 14, 22), "u1")
    for label, start in ((1, 2), (3, 8), (4, 14)):
        voxels[3:11, 3:11, start:start + 6] = label
    return voxels


class NamesTest(CommandTestCase):
    def map_file(self, name="map.vti"):
        return self.write(vtkXMLImageDataWriter(), name, make_image(label_voxels()))

    def names_of(self, volume, *options):
        """Return names and colours by label, as the command writes them."""
        self.run_command(volume, "--write-volume", self.path("read.vti"), *options)
        fields = read(self.path("read.vti")).GetFieldData()
        names, colors = fields.GetAbstractArray("LabelNames"), fields.GetArray("LabelColors")
        labels = [int(fields.GetArray("LabelValues").GetValue(i))
                  for i in range(names.GetNumberOfValues())] if names else []
        return ({label: names.GetValue(i) for i, label in enumerate(labels)},
                {label: colors.GetTuple(i) for i, label in enumerate(labels)} if colors else {})

    def labels_in(self, text, name="names.txt"):
        """Return the labels in a file with this text."""
        return read_label_names(self.write_bytes(
            name, text if isinstance(text, bytes) else text.encode()))


class FilesTest(NamesTest):
    colors = {1: (1, 0.5, 0), 3: (0, 0, 1)}

    def check_names(self, texts, name="names.txt", has_colors=False, second="Left lung"):
        for text in texts:
            with self.subTest(text):
                labels = self.labels_in(text, name)
                self.assertEqual({label.value: label.name for label in labels},
                                 {1: "liver", 3: second})
                for label in labels:
                    self.assertEqual(label.color is not None, has_colors)
                    if has_colors:
                        np.testing.assert_allclose(label.color, self.colors[label.value],
                                                   atol=0.005)

    def test_json(self):
        segments = [{"label": 1, "name": "liver", "color": [255, 128, 0]},
                    {"label": 3, "name": "Left lung", "color": "#0000ff"}]
        dcmqi = [[{"labelID": 1, "SegmentLabel": "liver",
                   "recommendedDisplayRGBValue": [255, 128, 0]}],
                 [{"labelID": 3, "SegmentLabel": "Left lung",
                   "recommendedDisplayRGBValue": [0, 0, 255]}]]
        plain = [
            {"1": "liver", "3": "Left lung"}, {"liver": 1, "Left lung": 3},
            {"liver": "1", "Left lung": [3], "both": [1, 3]}, {"liver": 1.0, "Left lung": 3.0},
            {"channel_names": {"0": "CT"}, "labels": {"liver": 1, "Left lung": 3},
             "numTraining": 7, "file_ending": ".nii.gz"},
            {"name": "x", "modality": {"0": "MR"}, "numTest": 3,
             "labels": {"1": "liver", "3": "Left lung"}},
            {"class_map": {"total": {"1": "liver", "3": "Left lung"}}}]
        colored = [
            segments, {"segments": segments}, {"@schema": "x", "segmentAttributes": dcmqi},
            {"1": {"name": "liver", "color": [1, 0.5, 0]},
             "3": {"name": "Left lung", "color": [0, 0, 1]}}]
        self.check_names(map(json.dumps, plain), "n.json")
        self.check_names(map(json.dumps, colored), has_colors=True)

    def test_color_tables(self):
        self.check_names((
            "# ITK-SnAP Label Description File\n# IDX   -R-  -G-  -B-  -A--  VIS MSH  LABEL\n"
            '    1   255  128    0        1  1  1    "liver"\n'
            '    3     0    0  255      0.5  1  0    "Left lung"\n',
            '# Color table file\n1 liver 255 128 0 255\n3 "Left lung" 0 0 255 255\n',
            "#No. Label Name:   R   G   B   A\n\n1   liver    255 128 0   0\n"
            "3   Left lung   0  0  255  0\n",
            "1 liver 255 128 0\n3 Left lung 0 0 255\n", "1 liver 1.0 0.5 0\n3 Left lung 0 0 1\n",
            "1,liver,255,128,0\n3,Left lung,0,0,255\n",
            "index\tname\tcolor\n1\tliver\t#ff8000\n3\tLeft lung\t#0000FF\n",
            "R,G,B,value,name\n255,128,0,1,liver\n0,0,255,3,Left lung\n",
            "LabelValue,Name,Color_R,Color_G,Color_B,Color_A\n1,liver,255,128,0,255\n"
            "3,Left lung,0,0,255,255\n"), has_colors=True)

    def test_tables(self):
        self.check_names((
            "1,liver\n3,Left lung\n", "liver,1\nLeft lung,3\n", "1 liver\r3 Left lung",
            'label,name\n1,liver\n3,"Left lung"\n', "index;label\n1;liver\n3;Left lung\n",
            "Structure Name,ROI\nliver,1\nLeft lung,3\n",
            "label,name\n1.0,liver\n3.0,Left lung\n", 'label , name\n1 , "liver" \n3,Left lung\n',
            "\ufeffLabel Value,Label Name,volume\n1,liver,33.5\n3,Left lung,3\n",
            "# made by me\nid\tregion\n1\tliver\n3\tLeft lung\n"), "a.csv")
        # MRIcron appends a meaningless number to each line.
        self.check_names(("1 liver 2001\r\n3 Left_lung 2002\r\n\r\n",
                          "1\tliver\n3\tLeft_lung\n"), second="Left_lung")

    def test_special_characters(self):
        for text, names in (
                (r'{"1": "R\u00fccken \ud83e\udec1 \"a\" \\ \/ \t b"}',
                 ["R\u00fccken \U0001fac1 \"a\" \\ /   b"]),
                ("\ufeff1 R\u00fccken", ["R\u00fccken"]),
                ("1 R\u00fccken".encode("latin-1"), ["R\u00fccken"]),
                ("1 Vermis 4\n3 Vermis crus 5\n", ["Vermis 4", "Vermis crus 5"]),
                ("1 Lobule 4 255 128 0\n3 Lobule 5 0 0 255\n4 x 1 2 3\n",
                 ["Lobule 4", "Lobule 5", "x"]), ("1 first\n1 second\n", ["first"])):
            with self.subTest(text):
                self.assertEqual([label.name for label in self.labels_in(text)], names)

    def test_invalid_files(self):
        for text, reason in (
                ("", "no label names found"), ("# nothing\n", "no label names found"),
                ("1 2 3\n4 5 6\n", "line 1 lacks .* a name"), ("1 liver\n3\n", "line 2 lacks"),
                ("liver\nspleen\n", "line 2 lacks .* column names such as 'label'"),
                ("label,name\n1,liver\n3\n", "line 3 lacks"), ("1,2\n3,4\n", "line 1 lacks"),
                ("label,name\n1,liver\n2.5,x\n", "line 3 lacks an integer label"),
                ("label,name\n99999999999,x\n", "line 2 lacks"),
                ("1 liver 255 300 0\n", "colours range from 0 to 300; use 0 to 1 or"),
                (b"1\0l\0i\0v\0", "not UTF-8 text"), (bytes(17 << 20), "exceeds 16 MiB"),
                ("1," + "x" * 200000, "field larger than"),
                ('{"1": "liver",\n "3": "lu', "line 2"), ('{"liver": 1e999}', "no label names found"),
                ("[" * 1000000, "(recursion depth|Stack overflow)"),
                ('["liver", "lung"]', "no label names found"),
                ('{"labels": {"liver": 1.5}}', "no label names found"),
                ('{"labels": ' * 60 + "{}" + "}" * 60, "no label names found")):
            with self.subTest(text[:40]):
                with self.assertRaisesRegex(Failure, f"^{self.path('names.txt')}: label names "
                                                     f"cannot be read: .*{reason}"):
                    self.labels_in(text)
        for name in ("none.txt", ""):
            self.rejects("label names cannot be read: (No such file|Is a dir)", self.map_file(),
                         self.path("o/"), "--labels", "1", "--label-names", self.path(name))


class FileNextToVolumeTest(NamesTest):
    def test_file_names(self):
        volume = self.write_bytes("scan.nii.gz", b"")
        self.assertEqual(names_beside(volume), ([], "", []))
        os.makedirs(self.path("sub"))
        shutil.copy(volume, self.path("sub/scan.nii.gz"))
        self.write_bytes("dataset.json", b'{"labels": {"above": 1}}')
        self.assertEqual(names_beside(self.path("sub/scan.nii.gz"))[0][0].name, "above")
        # Each takes precedence over the previous ones.
        for name in ("dataset.json", "scan.tsv", "scan.csv", "scan.json", "scan.ctbl", "scan.txt",
                     "scan.label", "scan.nii.txt"):
            file = self.write_bytes(name, f'{{"1": "from {name}"}}'.encode())
            labels, found, refused = names_beside(volume)
            self.assertEqual((labels[0].name, found, refused), (f"from {name}", file, []))

    def test_file_is_reported_and_used(self):
        self.write_bytes("map.json", b'{"EchoTime": 0.03, "Manufacturer": "x"}')
        self.write_bytes("map.csv", b"label,name\n3,liver\n")
        process = self.run_command(self.map_file(), self.path("o/"), "--labels", "liver")
        self.assertRegex(process.stderr, "warning: .*map.json: label names cannot be read: "
                         "no label names found; .*; the file is ignored")
        self.assertIn("label names are read from " + self.path("map.csv"), process.stderr)
        self.assertEqual(os.listdir(self.path("o")), ["liver.vtp"])
        mine = self.write_bytes("mine.txt", b"3 mine\n")
        process = self.run_command(self.map_file(), self.path("o/"), "--labels", "mine",
                                   "--label-names", mine)
        self.assertNotIn("map.", process.stderr.replace("map.vti", ""))

    def test_reports_are_ignored(self):
        written = ("--report", self.path("map.json"))
        for options in (written, written, ()):
            process = self.run_command(self.map_file(), self.path("o/"), "--labels", "1", *options)
            self.assertNotIn("names", process.stderr)
        # A file found next to the map is not an input if the run writes it.
        self.write_bytes("map.json", b'{"1": "liver"}')
        self.run_command(self.map_file(), self.path("o/"), "--labels", "1", *written)
        self.assertEqual(json.loads(self.content("map.json"))["labels"][0]["name"], "Label 1")


def labelled_nifti(table):
    """Return NIfTI with this text as extension, as TotalSegmentator writes it."""
    content = bytearray(medical_files.nifti(label_voxels().astype("i2"), SPACING))
    size = (len(table) + 8 + 15) // 16 * 16
    struct.pack_into("<f", content, 108, 352 + size)
    content[348] = 1
    content[352:352] = struct.pack("<ii", size, 0) + table.ljust(size - 8, b"\0")
    return bytes(content)


class HeadersTest(NamesTest):
    def test_label_table_of_nifti(self):
        table = (b'<?xml version="1.0"?><CaretExtension><VolumeInformation Index="0"><LabelTable>'
                 b'<Label Key="1" Red="1" Green="0.5" Blue="0" Alpha="1"><![CDATA[a<b]]></Label>\n'
                 b'<Label Key="3" Red="0" Green="0" Blue="1" Alpha="1">x &amp; &lt;y&gt;</Label>'
                 b"</LabelTable> </VolumeInformation></CaretExtension>")
        volume = self.write_bytes("a.nii.gz", gzip.compress(labelled_nifti(table)))
        self.assertEqual(self.names_of(volume), ({1: "a<b", 3: "x & <y>"},
                                                 {1: (1, 0.5, 0), 3: (0, 0, 1)}))
        self.run_command(volume, self.path("o/"), "--labels", "a<b")
        self.assertEqual(os.listdir(self.path("o")), ["a_b.vtp"])

    def nrrd(self, layers, *segments):
        """Return a 3D Slicer file with voxels [z, y, x, layer]."""
        header = medical_files.nrrd_header(layers[..., 0], SPACING, ORIGIN, np.eye(3), "gzip",
                                           "little")
        for old, new in ((b"dimension: 3", b"dimension: 4"), (b"kinds: ", b"kinds: list "),
                         (b"sizes: ", b"sizes: %d " % layers.shape[-1]),
                         (b"space directions: ", b"space directions: none ")):
            header = header.replace(old, new)
        return self.write_bytes("map.seg.nrrd", header + "\n".join([*segments, "", ""]).encode()
                                + gzip.compress(layers.tobytes()))

    def test_segments_of_nrrd(self):
        volume = self.nrrd(label_voxels()[..., None], *SEGMENTS)
        self.assertEqual(self.names_of(volume), ({3: "liver", 1: "Left lung"},
                                                 {3: (1, 0.5, 0), 1: (0, 0, 1)}))
        # --label-names adds and replaces names. Colours are kept if all labels have one.
        mine = self.write_bytes("mine.txt", b"3 mine\n4 more\n")
        self.assertEqual(self.names_of(volume, "--label-names", mine),
                         ({3: "mine", 1: "Left lung", 4: "more"}, {}))
        damaged = self.nrrd(
            label_voxels()[..., None], "Segment0_Name:=a", "Segment0_LabelValue:=x",
            "Segment0_Color:=red", "Segmentx_Name:=b", "Segment_Name:=c", "Segment7_Color:=1 1 1",
            "Segment1_Name:=")
        self.assertEqual(self.names_of(damaged), ({1: "a", 2: ""}, {}))

    def test_layers(self):
        first = label_voxels()
        second = np.where(first == 3, 1, 0).astype("u1")
        second[6:12, 6:12, 1:9] = 2
        layers = np.stack([first, second], axis=-1)
        volume = self.nrrd(layers, *SEGMENTS, "Segment2_Name:=vessel", "Segment2_LabelValue:=2",
                           "Segment2_Color:=0 1 0", "Segment2_Layer:=1", "Segment3_Name:=tumour",
                           "Segment3_LabelValue:=1", "Segment3_Color:=1 1 0", "Segment3_Layer:=1")
        process = self.run_command(volume, self.path("o/"), "--labels", "all", "--report",
                                   self.path("r.json"))
        self.assertIn("5 labels in 2 layers", process.stderr)
        rows = {row["name"]: row for row in json.loads(self.content("r.json"))["labels"]}
        self.assertEqual(
            {name: (row["layer"], row["label"]) for name, row in rows.items()},
            {"Left lung": (0, 1), "liver": (0, 3), "Label 4": (0, 4), "tumour": (1, 1),
             "vessel": (1, 2)})
        self.assertEqual(sorted(os.listdir(self.path("o"))),
                         ["Left_lung.vtp", "label-4.vtp", "liver.vtp", "tumour.vtp", "vessel.vtp"])
        for name, color in (("vessel", [0, 1, 0]), ("Left lung", [0, 0, 1]), ("tumour", [1, 1, 0])):
            row = rows[name]
            centre = np.argwhere(layers[..., row["layer"]] == row["label"]).mean(0)[::-1]
            np.testing.assert_allclose(row["component_features"][0]["centroid"],
                                       centre * SPACING + ORIGIN, atol=0.2)
            self.assertEqual(row["color"], color)
        for options, names in ((("1",), {"Left lung", "tumour"}), (("tumour",), {"tumour"}),
                               (("all", "--component", "1"), {"tumour", "vessel"})):
            report = self.report(volume, "--labels", *options)
            self.assertEqual({row["name"] for row in report["labels"]}, names)
        heading, *lines = self.run_command(volume, "--list-labels").stdout.splitlines()
        self.assertIn("layer", heading.split())
        self.assertEqual([line.split()[3] for line in lines], ["0"] * 3 + ["1"] * 2)
        for name, *more in ("o.stl", "--merge"), ("o.msh",):
            self.rejects("the labels are in several layers .* --component, or give a folder",
                         volume, self.path(name), "--labels", "1", *more)
        self.run_command(volume, self.path("o.stl"), "--labels", "1,2", "--merge", "--component", 1)
        unnamed = self.nrrd(layers)
        for reason, *options in (("2 components; choose the label component with --component",),
                                 ("--component 2 is out of range", "--component", "2")):
            self.rejects(reason, unnamed, self.path("o/"), "--labels", "all", *options)

    def test_layers_of_older_files(self):
        """Each component is a segment without a label value."""
        layers = np.stack([label_voxels() == 1, label_voxels() == 3], axis=-1).astype("u1")
        volume = self.nrrd(layers, "Segment0_Name:=one", "Segment1_Name:=two")
        report = self.report(volume, self.path("o/"), "--labels", "all")
        self.assertEqual([(row["name"], row["layer"], row["label"]) for row in report["labels"]],
                         [("one", 0, 1), ("two", 1, 1)])
        self.assertEqual(sorted(os.listdir(self.path("o"))), ["one.vtp", "two.vtp"])
