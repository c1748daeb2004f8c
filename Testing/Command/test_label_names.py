# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Names of labels for `volumic --labels`: all kinds of files, those beside a volume, segments in
the headers of .seg.nrrd, and files that are damaged or something else."""

import gzip
import json
import os
import shutil
import struct
import unittest

import numpy as np
from vtkmodules.vtkIOXML import vtkXMLImageDataWriter

from command_test_case import ORIGIN, SPACING, CommandTestCase, make_image

import medical_files
from vtk_files import read

SEGMENTS = ("Segment0_Name:=liver", "Segment0_LabelValue:=3", "Segment0_Color:=1 0.5 0",
            "Segment0_Layer:=0", "Segment0_ID:=Segment_1",
            "Segmentation_MasterRepresentation:=Binary labelmap", "Segment1_Name:=Left\\nlung",
            "Segment1_LabelValue:=1", "Segment1_Color:=0 0 1", "Segment1_Layer:=0")


def label_voxels():
    """Cuboids of the labels 1, 3 and 4."""
    voxels = np.zeros((14, 14, 22), "u1")
    for label, start in ((1, 2), (3, 8), (4, 14)):
        voxels[3:11, 3:11, start:start + 6] = label
    return voxels


class NamesTest(CommandTestCase):
    def map_file(self, name="map.vti"):
        return self.write(vtkXMLImageDataWriter(), name, make_image(label_voxels()))

    def fields_of(self, volume, *options):
        """Field data of the volume as the command writes it."""
        self.run_command(volume, "--write-volume", self.path("read.vti"), *options)
        return read(self.path("read.vti")).GetFieldData()

    def names_of(self, volume, *options):
        """{label: name} and {label: colour} of the volume."""
        fields = self.fields_of(volume, *options)
        values = fields.GetArray("LabelValues")
        if values is None:
            return {}, {}
        labels = [values.GetValue(i) for i in range(values.GetNumberOfTuples())]
        names, colors = fields.GetAbstractArray("LabelNames"), fields.GetArray("LabelColors")
        self.assertEqual(names.GetNumberOfValues(), len(labels))
        return ({label: names.GetValue(i) for i, label in enumerate(labels)},
                {label: colors.GetTuple(i) for i, label in enumerate(labels)} if colors else {})

    def names_file(self, text, name):
        return self.write_bytes(name, text if isinstance(text, bytes) else text.encode())

    def names_in(self, text, name="names.txt"):
        return self.names_of(self.map_file(), "--label-names", self.names_file(text, name))

    def refused_names(self, text, reason, name="names.txt"):
        self.refused(f"^volumic: [^\n]*{name}: names of labels cannot be read: [^\n]*({reason})"
                     "[^\n]*\n$", self.map_file(), self.path("o/"), "--labels", "all",
                     "--label-names", self.names_file(text, name), "-q")


class FilesTest(NamesTest):
    expected = {1: "liver", 3: "Left lung"}
    colors = {1: (1, 0.5, 0), 3: (0, 0, 1)}

    def check_names(self, text, name="names.txt", has_colors=False):
        names, colors = self.names_in(text, name)
        self.assertEqual(names, self.expected)
        self.assertEqual(bool(colors), has_colors)
        for label, color in colors.items():
            np.testing.assert_allclose(color, self.colors[label], atol=0.005)

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
        coloured = [
            segments, {"segments": segments}, {"@schema": "x", "segmentAttributes": dcmqi},
            {"1": {"name": "liver", "color": [1, 0.5, 0]},
             "3": {"name": "Left lung", "color": [0, 0, 1]}}]
        for value, has_colors in [(v, False) for v in plain] + [(v, True) for v in coloured]:
            with self.subTest(value):
                self.check_names(json.dumps(value, indent=1), "n.json", has_colors)
                self.check_names(json.dumps(value, ensure_ascii=False), "n.json", has_colors)

    def test_texts_in_json(self):
        names, _ = self.names_in(r'{"1": "R\u00fccken \ud83e\udec1 \"a\" \\ \/ \t b"}')
        self.assertEqual(names, {1: "R\u00fccken \U0001fac1 \"a\" \\ /   b"})

    def test_itk_snap(self):
        self.check_names("""################################################
# ITK-SnAP Label Description File
# IDX   -R-  -G-  -B-  -A--  VIS MSH  LABEL
################################################
    1   255  128    0        1  1  1    "liver"
    3     0    0  255      0.5  1  0    "Left lung"
""", has_colors=True)

    def test_colour_tables(self):
        for name, text in (
                ("a.ctbl", '# Color table file\n# 2 values\n1 liver 255 128 0 255\n'
                 '3 "Left lung" 0 0 255 255\n'),
                ("a.txt", "#No. Label Name:   R   G   B   A\n\n1   liver    255 128 0   0\n"
                 "3   Left lung   0  0  255  0\n"),
                ("a.txt", "1 liver 255 128 0\n3 Left lung 0 0 255\n"),
                ("a.txt", "1 liver 1.0 0.5 0\n3 Left lung 0 0 1\n")):
            with self.subTest(text):
                self.check_names(text, name, has_colors=True)
        names, _ = self.names_in("1 Lobule 4 255 128 0\n3 Lobule 5 0 0 255\n4 x 1 2 3\n")
        self.assertEqual(names, {1: "Lobule 4", 3: "Lobule 5", 4: "x"})

    def test_lines(self):
        self.expected = {1: "liver", 3: "Left_lung"}
        self.check_names("1 liver 2001\r\n3 Left_lung 2002\r\n\r\n")  # MRIcron
        self.check_names("0\tx\n1\tliver\n3\tLeft_lung\n".replace("0\tx\n", ""))
        self.check_names("1 liver\r3 Left_lung\r")
        names, _ = self.names_in("1 Vermis 4\n3 Vermis crus 5\n")
        self.assertEqual(names, {1: "Vermis 4", 3: "Vermis crus 5"})

    def test_tables(self):
        for text in ("1,liver\n3,Left lung\n", "liver,1\nLeft lung,3\n",
                     'label,name\n1,liver\n3,"Left lung"\n', "index;label\n1;liver\n3;Left lung\n",
                     "Structure Name,ROI\nliver,1\nLeft lung,3\n",
                     "label,name\n1.0,liver\n3.0,Left lung\n",
                     'label , name\n1 , "liver" \n3,Left lung\n',
                     "\ufeffLabel Value,Label Name,volume\n1,liver,33.5\n3,Left lung,3\n",
                     "# made by me\nid\tregion\n1\tliver\n3\tLeft lung\n"):
            with self.subTest(text):
                self.check_names(text, "a.csv")
        for text in ("1,liver,255,128,0\n3,Left lung,0,0,255\n",
                     "index\tname\tcolor\n1\tliver\t#ff8000\n3\tLeft lung\t#0000FF\n",
                     "R,G,B,value,name\n255,128,0,1,liver\n0,0,255,3,Left lung\n",
                     "LabelValue,Name,Color_R,Color_G,Color_B,Color_A\n1,liver,255,128,0,255\n"
                     "3,Left lung,0,0,255,255\n"):
            with self.subTest(text):
                self.check_names(text, "a.csv", True)

    def test_colours_only_where_all_have_one(self):
        names, colors = self.names_in('[{"label": 1, "name": "a", "color": [1, 0, 0]},'
                                      ' {"label": 3, "name": "b"}]')
        self.assertEqual((names, colors), ({1: "a", 3: "b"}, {}))

    def test_encodings(self):
        for text in ("\ufeff1 R\u00fccken", "1 R\u00fccken", "1 R\u00fccken".encode("latin-1")):
            self.assertEqual(self.names_in(text)[0], {1: "R\u00fccken"})


class DamageTest(NamesTest):
    def test_what_is_no_list_of_names(self):
        for text, reason in (
                ("", "it names no label"), ("# nothing\n", "it names no label"),
                ("1 2 3\n4 5 6\n", "line 1: .* is a number, not a name"),
                ("liver\nspleen\n", "line 1: .*, or above them column names such as"),
                ("1 liver\n3\n", "line 2: there must be a label, .*, and a name"),
                ('1 "liver\n', "line 1: a quote does not end"),
                ("label,name\n1,liver\n3\n", "line 3: there must be a label"),
                ("label,name\n1,liver\n2.5,x\n", "line 3: there must be a label, .*an integer"),
                ("label,name\n99999999999,x\n", "line 2: there must be a label"),
                ("1,2\n3,4\n", "line 1: '2' is a number"),
                ("1 liver 255 300 0\n", "the color of label 1 is not between 0 and 255"),
                (b"1\0l\0i\0v\0", "not text in UTF-8")):
            with self.subTest(text):
                self.refused_names(text, reason)

    def test_damaged_json(self):
        for text, reason in (
                ('{"1": "liver",\n "3": "lu', "it is not JSON: .*line 2"),
                ('{"liver": 1e999}', "it names no label"), ("[" * 1000000, "nested too deeply"),
                ('["liver", "lung"]', "it names no label"), ("3", "it names no label"),
                ('{"labels": {"liver": 1.5}}', "it names no label"),
                ('{"labels": ' * 60 + "{}" + "}" * 60, "it names no label")):
            with self.subTest(text):
                self.refused_names(text, reason, "n.json")

    def test_files_that_are_not_there(self):
        self.write_bytes("large.txt", bytes(17 << 20))
        for reason, name in (("none.txt: .*cannot be opened", "none.txt"), ("it is a folder", ""),
                             ("too large", "large.txt")):
            with self.subTest(reason):
                self.refused(reason, self.map_file(), self.path("o/"), "--labels", "1",
                             "--label-names", self.path(name))


class BesideTest(NamesTest):
    def test_usual_names(self):
        voxels = label_voxels().astype("i2")
        volume = self.write_bytes("scan.nii.gz", gzip.compress(
            medical_files.nifti(voxels, SPACING)))
        self.assertEqual(self.names_of(volume), ({}, {}))
        os.makedirs(self.path("sub"))
        shutil.copy(volume, self.path("sub/scan.nii.gz"))
        self.write_bytes("dataset.json", b'{"labels": {"above": 1}}')
        self.assertEqual(self.names_of(self.path("sub/scan.nii.gz"))[0], {1: "above"})
        # Each takes the place of those before it.
        for name in ("dataset.json", "scan.tsv", "scan.csv", "scan.json", "scan.ctbl", "scan.txt",
                     "scan.label", "scan.nii.txt"):
            with self.subTest(name):
                self.write_bytes(name, f'{{"1": "from {name}"}}'.encode())
                self.assertEqual(self.names_of(volume)[0], {1: f"from {name}"})

    def test_it_is_told_and_used(self):
        self.write_bytes("map.txt", b"3 liver\n")
        process = self.run_command(self.map_file(), self.path("o/"), "--labels", "liver")
        self.assertIn("names of labels are those of " + self.path("map.txt"), process.stderr)
        self.assertEqual(os.listdir(self.path("o")), ["liver.vtp"])
        mine = self.write_bytes("mine.txt", b"3 mine\n")
        process = self.run_command(self.map_file(), self.path("o/"), "--labels", "mine",
                                "--label-names", mine)
        self.assertNotIn("map.txt", process.stderr)

    def test_what_cannot_be_read_is_skipped(self):
        self.write_bytes("map.json", b'{"EchoTime": 0.03, "Manufacturer": "x"}')
        process = self.run_command(self.map_file(), self.path("o/"), "--labels", "1")
        self.assertRegex(process.stderr, "warning: .*map.json: names of labels cannot be read: "
                         "it names no label; .*; this file is skipped")
        self.write_bytes("map.csv", b"label,name\n1,liver\n")
        self.run_command(self.map_file(), self.path("o/"), "--labels", "liver")
        process = self.run_command(self.map_file(), "--write-volume", self.path("v.vti"))
        self.assertNotIn("map.json", process.stderr)

    def test_a_report_is_no_table_of_names(self):
        """A second run with the same report is as the first; other runs do not read it."""
        for _ in range(2):
            process = self.run_command(self.map_file(), self.path("o/"), "--labels", "all",
                                       "--report", self.path("map.json"))
            self.assertNotIn("map.json", process.stderr)
        process = self.run_command(self.map_file(), self.path("o/"), "--labels", "all")
        self.assertNotIn("names", process.stderr)
        # What was only found beside the map is no input where the run writes it.
        self.write_bytes("map.json", b'{"1": "liver"}')
        self.run_command(self.map_file(), self.path("o/"), "--labels", "1", "--report",
                         self.path("map.json"))
        self.assertEqual(json.loads(self.content("map.json"))["labels"][0]["name"], "Label 1")


def labelled_nifti(table):
    """NIfTI with this text as an extension, as TotalSegmentator writes it."""
    content = bytearray(medical_files.nifti(label_voxels().astype("i2"), SPACING))
    size = (len(table) + 8 + 15) // 16 * 16
    struct.pack_into("<f", content, 108, 352 + size)
    content[348] = 1
    extension = struct.pack("<ii", size, 0) + table.ljust(size - 8, b"\0")
    return bytes(content[:352]) + extension + bytes(content[352:])


class NiftiTest(NamesTest):
    table = (b'<?xml version="1.0"?> <CaretExtension> <VolumeInformation Index="0"> <LabelTable>'
             b'<Label Key="1" Red="1" Green="0.5" Blue="0" Alpha="1"><![CDATA[a<b]]></Label>\n'
             b'<Label Key="3" Red="0" Green="0" Blue="1" Alpha="1">x &amp; &lt;y&gt;</Label>'
             b"</LabelTable> </VolumeInformation></CaretExtension>")

    def test_label_table(self):
        content = labelled_nifti(self.table)
        for name, data in (("a.nii", content), ("a.nii.gz", gzip.compress(content))):
            names, colors = self.names_of(self.write_bytes(name, data))
            self.assertEqual(names, {1: "a<b", 3: "x & <y>"})
            self.assertEqual(colors, {1: (1, 0.5, 0), 3: (0, 0, 1)})
        self.run_command(self.path("a.nii.gz"), self.path("o/"), "--labels", "a<b")
        self.assertEqual(os.listdir(self.path("o")), ["a_b.vtp"])


class SegmentsTest(NamesTest):
    def nrrd(self, voxels, *segments, name="map.seg.nrrd"):
        """A file of 3D Slicer; voxels of four axes have the layers as their last one."""
        header = medical_files.nrrd_header(voxels[..., 0] if voxels.ndim == 4 else voxels,
                                           SPACING, ORIGIN, np.eye(3), "gzip", "little")
        if voxels.ndim == 4:
            for old, new in ((b"dimension: 3", b"dimension: 4"),
                             (b"sizes: ", b"sizes: %d " % voxels.shape[-1]),
                             (b"kinds: ", b"kinds: list "),
                             (b"space directions: ", b"space directions: none ")):
                header = header.replace(old, new)
        header += "\n".join([*segments, ""]).encode()
        return self.write_bytes(name, header + b"\n" + gzip.compress(voxels.tobytes()))

    def test_names_and_colours(self):
        names, colors = self.names_of(self.nrrd(label_voxels(), *SEGMENTS))
        self.assertEqual(names, {3: "liver", 1: "Left lung"})
        self.assertEqual(colors, {3: (1, 0.5, 0), 1: (0, 0, 1)})
        # A file adds to them, and its names go before theirs.
        mine = self.write_bytes("mine.txt", b"3 mine\n4 more\n")
        names, colors = self.names_of(self.nrrd(label_voxels(), *SEGMENTS), "--label-names", mine)
        self.assertEqual(names, {3: "mine", 1: "Left lung", 4: "more"})
        self.assertEqual(colors, {})

    def layers(self):
        first = label_voxels()
        second = np.where(first == 3, 1, 0).astype("u1")
        second[6:12, 6:12, 1:9] = 2
        return np.stack([first, second], axis=-1)

    def layer_file(self):
        return self.nrrd(self.layers(), *SEGMENTS, "Segment2_Name:=vessel",
                         "Segment2_LabelValue:=2", "Segment2_Color:=0 1 0", "Segment2_Layer:=1",
                         "Segment3_Name:=tumour", "Segment3_LabelValue:=1",
                         "Segment3_Color:=1 1 0", "Segment3_Layer:=1")

    def test_layers(self):
        volume = self.layer_file()
        process = self.run_command(volume, self.path("o/"), "--labels", "all", "--report",
                                self.path("r.json"))
        self.assertIn("5 labels in 2 layers", process.stderr)
        rows = json.loads(self.content("r.json"))["labels"]
        self.assertEqual(
            {(row["layer"], row["label"]): row["name"] for row in rows},
            {(0, 1): "Left lung", (0, 3): "liver", (0, 4): "Label 4", (1, 1): "tumour",
             (1, 2): "vessel"})
        self.assertEqual(sorted(os.listdir(self.path("o"))),
                         ["Left_lung.vtp", "label-4.vtp", "liver.vtp", "tumour.vtp", "vessel.vtp"])
        by_name = {row["name"]: row for row in rows}
        for name, layer, label in (("vessel", 1, 2), ("Left lung", 0, 1), ("tumour", 1, 1)):
            centre = np.argwhere(self.layers()[..., layer] == label).mean(0)[::-1]
            row = by_name[name]
            np.testing.assert_allclose(row["component_features"][0]["centroid"],
                                       centre * SPACING + ORIGIN, atol=0.2)
            self.assertEqual(row["color"], {"vessel": [0, 1, 0], "Left lung": [0, 0, 1],
                                            "tumour": [1, 1, 0]}[name])
        self.run_command(volume, self.path("all.vtm"), "--labels", "all")
        self.assertEqual(len(os.listdir(self.path("all"))), 5)

    def test_choices_in_layers(self):
        volume = self.layer_file()
        for options, names in ((("1",), {"Left lung", "tumour"}), (("tumour",), {"tumour"}),
                               (("1", "--component", "1"), {"tumour"}),
                               (("all", "--component", "1"), {"tumour", "vessel"})):
            report = self.report(volume, "--labels", *options)
            self.assertEqual({row["name"] for row in report["labels"]}, names)
        self.refused("--merge: the labels lie in several layers", volume, self.path("o.stl"),
                     "--labels", "1", "--merge")
        self.run_command(volume, self.path("o.stl"), "--labels", "1,2", "--merge", "--component",
                         "1")

    def test_layers_of_older_files(self):
        """Each component is a segment, and nothing tells its label."""
        layers = np.stack([label_voxels() == 1, label_voxels() == 3], axis=-1).astype("u1")
        volume = self.nrrd(layers, "Segment0_Name:=one", "Segment1_Name:=two")
        report = self.report(volume, self.path("o/"), "--labels", "all")
        self.assertEqual([(row["name"], row["layer"], row["label"]) for row in report["labels"]],
                         [("one", 0, 1), ("two", 1, 1)])
        self.assertEqual(sorted(os.listdir(self.path("o"))), ["one.vtp", "two.vtp"])

    def test_layers_without_names(self):
        self.refused("2 components; choose the one that is a label with --component",
                     self.nrrd(self.layers()), self.path("o/"), "--labels", "all")
        self.refused("there is no component 2", self.path("map.seg.nrrd"), self.path("o/"),
                     "--labels", "all", "--component", "2")

    def test_damaged_segments(self):
        names, colors = self.names_of(self.nrrd(
            label_voxels(), "Segment0_Name:=a", "Segment0_LabelValue:=x", "Segment0_Color:=red",
            "Segmentx_Name:=b", "Segment_Name:=c", "Segment7_Color:=1 1 1", "Segment1_Name:="))
        self.assertEqual((names, colors), ({1: "a", 2: ""}, {}))


if __name__ == "__main__":
    unittest.main()
