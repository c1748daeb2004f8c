# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Tests of `volumic --list-labels`."""

import numpy as np

from test_labels import BLOBS, NAMES, SPACING, LabelsTest, label_voxels
from command_test_case import make_image


def box_of(voxels, label):
    """Return first and last index along x, y, z."""
    coordinates = np.argwhere(voxels == label)[:, ::-1]
    return np.ravel(list(zip(coordinates.min(0), coordinates.max(0)))).tolist()


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
