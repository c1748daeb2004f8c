# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""`volumic --list-labels`: the labels of a volume as a table and as JSON, and no surfaces."""

import unittest

import numpy as np

from test_labels import BLOBS, NAMES, SPACING, LabelsTest, label_image, label_voxels
from command_test_case import make_image


def box_of(voxels, label):
    """First and last index along x, y, z."""
    places = np.argwhere(voxels == label)[:, ::-1]
    return np.ravel(list(zip(places.min(0), places.max(0)))).tolist()


class ListTest(LabelsTest):
    def table(self, *arguments):
        """The lines of the table, split, below its heading."""
        lines = self.run_command("--list-labels", *arguments).stdout.splitlines()
        self.assertRegex(lines[0], r"^ *label +voxels +volume +.*box \(first\.\.last voxel along "
                                   r"i, j, k\) +name$")
        return [line.split() for line in lines[1:]]

    def listed(self, *arguments):
        return self.report("--list-labels", *arguments)["labels"]

    def test_a_table(self):
        lines = self.table(self.map_file(), "--label-names", self.names_file())
        voxels = label_voxels()
        self.assertEqual([int(line[0]) for line in lines], sorted(BLOBS))
        for line in lines:
            label = int(line[0])
            name = NAMES.get(label, f"Label {label}")
            count = (voxels == label).sum()
            box = box_of(voxels, label)
            self.assertEqual(int(line[1]), count)
            self.assertAlmostEqual(float(line[2]), count * SPACING.prod(), delta=1e-3)
            self.assertEqual(line[3:6], [f"{box[i]}..{box[i + 1]}" for i in (0, 2, 4)])
            self.assertEqual(" ".join(line[6:]), name)

    def test_as_json(self):
        voxels = label_voxels()
        rows = self.listed(self.map_file(), "--label-names", self.names_file())
        self.assertEqual([row["label"] for row in rows], sorted(BLOBS))
        for row in rows:
            self.assertEqual(list(row), ["label", "name", "color", "layer", "voxels", "volume",
                                         "box"])
            self.assertEqual(row["name"], NAMES.get(row["label"], f"Label {row['label']}"))
            self.assertEqual(row["box"], box_of(voxels, row["label"]))
            self.assertEqual(row["layer"], 0)
        surfaces = self.rows(self.map_file(), "--labels", "all")
        for row in rows:
            for name in ("voxels", "color", "layer"):
                self.assertEqual(row[name], surfaces[row["label"]][name])

    def test_choice(self):
        volume, names = self.map_file(), self.names_file()
        for options, labels in ((["--labels", "l*"], [1, 2]), (["--labels", "0,7"], [0, 7]),
                                (["--background", "1"], [-3, 0, 2, 7])):
            rows = self.listed(volume, "--label-names", names, *options)
            self.assertEqual([row["label"] for row in rows], labels)
        self.refused("map.vti: there is no label 'kidney'", volume, "--list-labels", "--labels",
                     "kidney")

    def test_floating_point_and_spacing(self):
        volume = self.map_file("f.vti", label_image(label_voxels("f4")))
        report = self.report(volume, "--list-labels", "--labels", "7", "--spacing", "1,1,3")
        row, = report["labels"]
        self.assertEqual(row["volume"], 3 * row["voxels"])
        self.assertEqual(report["labels"][0]["box"], box_of(label_voxels(), 7))
        half = self.map_file("h.vti", make_image(np.full((9, 9, 9), 0.5)))
        self.refused("h.vti: .*labels must be integers", half, "--list-labels")
        many = np.arange(18 * 28 * 28).reshape(18, 28, 28).astype("i4")
        self.refused("more than 4096", self.map_file("many.vti", label_image(many)),
                     "--list-labels", "--labels", "7")


if __name__ == "__main__":
    unittest.main()
