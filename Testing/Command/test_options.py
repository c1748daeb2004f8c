# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Tests of the options of the command, exit codes and interruption."""

import csv
import json
import os
import re
import signal
import subprocess

import numpy as np
from vtkmodules.vtkCommonExecutionModel import (
    vtkImageAlgorithm, vtkMultiBlockDataSetAlgorithm, vtkPolyDataAlgorithm)
from vtkmodules.vtkIOXML import vtkXMLImageDataWriter

from command_test_case import (
    CENTRE, ISO, ORIGIN, PROGRAM, SPACING, CommandTestCase, ball, make_image)
from volumic import (
    options, report, vtkDeformableSurface, vtkImagePyramid, vtkLabelsToSurfaces)
from volumic.errors import UsageError
from volumic.option_tables import PROPERTIES, Filters
from vtk_files import read

# Properties without an option: inputs, and properties set elsewhere.
NOT_OPTIONS = {"vtkDeformableSurface": {"InitialSurfaceConnection", "InitialSurfaceData",
                                        "AttractingPointsConnection", "AttractingPointsData",
                                        "ShowLevels", "UseUpperValue", "MemoryLimit",
                                        "Resume", "Profile"},
               "vtkLabelsToSurfaces": {"LabelColor", "LabelName", "MemoryLimit"},
               "vtkImagePyramid": {"MemoryLimit"}}


def properties_of(filter_class, base_class):
    """Return names of the class's own Set methods, without those of enumeration values."""
    names = {name[3:] for name in dir(filter_class)
             if name.startswith("Set") and not hasattr(base_class, name)}
    return {n for n in names if not any(n.startswith(m + "To") for m in names)}


class OptionTableTest(CommandTestCase):
    def test_every_property_has_an_option(self):
        for filter_class, base in ((vtkDeformableSurface, vtkPolyDataAlgorithm),
                                   (vtkLabelsToSurfaces, vtkMultiBlockDataSetAlgorithm),
                                   (vtkImagePyramid, vtkImageAlgorithm)):
            name = filter_class.__name__
            in_table = [item.name for item in PROPERTIES if item.cls == name]
            self.assertEqual(len(in_table), len(set(in_table)), "a property has two options")
            # Properties shared with vtkDeformableSurface have one option.
            common = {item.name for item in PROPERTIES
                      if item.cls == "vtkDeformableSurface" and item.cls != name}
            self.assertEqual(set(in_table),
                             properties_of(filter_class, base) - NOT_OPTIONS[name] - common)

    def test_every_option_sets_only_its_property(self):
        values = {
            "iso": "400", "upper": "900", "reduction-factor": "1.5", "sampling-ratio": "0.9",
            "levels": "2", "coarsest": "0", "finest": "2", "minimum-level-size": "12",
            "iterations": "400", "threads": "1", "minimum-part-size": "7",
            "snapshot-interval": "50", "component": "0", "scratch": self.folder, "background": "3"}
        before = report.property_values(Filters(), lambda item: True)
        table = self.run_command("--list-properties").stdout.splitlines()
        self.assertEqual(table, ["\t".join([item.cls, item.name, "--" + item.option,
                                            before[item.name]]) for item in PROPERTIES])
        for item in PROPERTIES:
            words = [word for word in item.metavar.split("|") if word != before[item.name]]
            text = words[0] if "|" in item.metavar else values.get(item.option, "0.3")
            line = ["a.vti", "a.vtp", f"--{item.option}", *[text] * bool(item.metavar)]
            line += ["--labels", "1"] * (item.cls == "vtkLabelsToSurfaces")
            line += ["--edges", "e"] * (item.option == "edge-attraction")
            with self.subTest(line):
                filters = Filters()
                options.apply(options.parse(line), filters)
                after = report.property_values(filters, lambda item: True)
                self.assertEqual({n for n in after if after[n] != before[n]},
                                 {item.name} - {"SharedInterfaces"})  # always on
                if item.metavar:
                    self.assertEqual(after[item.name], text)

    def test_usage_errors(self):
        for reason, line in (
                ("VOLUME is missing", ""), ("no output is given", "a.vti"),
                ("unknown option --isoo", "--isoo 3"), ("unknown option -z", "-z"),
                ("--iso requires an argument", "a b.stl --iso"),
                ("--iso: 'x' is not a number", "a b.stl --iso x"),
                ("--levels: '2.5' is not an integer", "a b.stl --levels=2.5"),
                ("--dark takes no", "a b.stl --dark=on"),
                (r"--recovery: 'all' is not one of none\|objects", "a b.stl --recovery all"),
                ("--spacing: .* has 2 numbers instead of 3", "a b.stl --spacing 1,2"),
                ("--memory is not supported: .*--scratch", "a b.stl --memory 2G"),
                ("--resume is not supported", "a b.stl --resume"),
                ("--profile is not supported", "a b.stl --profile"),
                ("did you mean --iso", "a b.stl --ios 3"),
                ("--time: -1 is less than 0", "a b.stl --time -1"),
                ("--threads: '-1' is out of range", "a b.stl --threads -1"),
                ("--time and --phase are mutually exclusive", "a b.stl --time 1 --phase 1"),
                ("--edge-attraction requires --edges", "a b.stl --edge-attraction 1"),
                ("are mutually exclusive", "a b.stl --seeds c --initial-surface d"),
                ("--seed-position: .* has 2 numbers", "a b.stl --seed-position 1,2"),
                ("are mutually exclusive", "a b.stl --seed-position 1,2,3 --initial-surface d"),
                ("out.stl: --list-labels writes no surfaces", "a --list-labels out.stl"),
                ("--merge and --list-labels are mutually exclusive", "a --list-labels --merge"),
                ("--list-labels and --format are mutually exclusive", "a --list-labels --format stl"),
                ("--iso and --list-labels are mutually exclusive", "a --list-labels --iso 3"),
                ("--list-labels and --seeds are mutually exclusive", "a --list-labels --seeds a.txt"),
                ("VOLUME is missing", "--list-labels"),
                ("--scale: 0 is not greater than 0", "a b.stl --scale 0"),
                ("--unit: 'inch' is not one of m, cm, mm", "a b.stl --unit inch"),
                ("--space: 'XYZ' is not one of LPS, RAS, as-file", "a b.stl --space XYZ"),
                ("--scale and --unit are mutually exclusive", "a b.stl --scale 2 --unit mm"),
                ("'none' is not one of closed, marked, open", "a b.vtp --ends none"),
                ("b.smesh: tetrahedral meshers require a closed surface", "a b.smesh --ends open"),
                ("'netgen' is not one of tetgen, gmsh", "a b.stl --mesher netgen"),
                ("--mesher requires a tetrahedral mesh", "a b.stl --mesher gmsh"),
                ("requires a tetrahedral mesh as output", "a b.stl --maximum-volume 2"),
                ("--triangles and --tolerance are mutually exclusive",
                 "a b.vtp --triangles 999 --tolerance .1"),
                ("--triangles: 19 is less than 20", "a b.vtp --triangles 19"),
                ("--region: .* a minimum exceeds its maximum", "a b.vtp --region 5,4,0,5,0,5"),
                ("--region: '4.5' is not an integer", "a b.vtp --region 0,4.5,0,5,0,5"),
                ("--region and --region-box are mutually exclusive",
                 "a b.vtp --region 0,4,0,5,0,5 --region-box 0,1,0,1,0,1"),
                ("--edges and --resample are mutually exclusive",
                 "a b.vtp --edges a --resample 1,1,1"),
                ("--resample and --isotropic are mutually exclusive",
                 "a b.vtp --resample 1,1,1 --isotropic"),
                ("--resample: 0 is not greater than 0", "a b.vtp --resample 1,0,1"),
                ("--probe-depth requires --probe", "a b.vtp --probe-depth 1")):
            with self.subTest(line), self.assertRaisesRegex(UsageError, reason):
                options.apply(options.parse(line.split()), Filters())
        self.rejects("unknown suffix of a surface format", "a", "b.xyz", status=2)

    def test_invalid_property_values(self):
        for reason, *options in (
                ("--upper is 300, but --iso is 500.5. Set --upper to more", "--upper", "300"),
                ("no voxel is between --iso, 500.5, and --upper, 500.6", "--upper", "500.6"),
                ("--friction is -1, it must lie in", "--friction", "-1"),
                ("--edge-length is 0.01, but edges of this image can have mean lengths of",
                 "--edge-length", "0.01"),
                ("--tolerance is 1, but --no-snap is given, so the surface", "--tolerance", "1",
                 "--no-snap"),
                ("--thin-parts is given and --edge-length is 1, .* Set --edge-length to 0",
                 "--thin-parts", "--edge-length", "1")):
            self.rejects(reason, self.ball_file(), self.path("a.stl"), "--iso", ISO, *options)


class HelpTest(CommandTestCase):
    def test_help_and_version(self):
        self.assertRegex(self.run_command("--version").stdout, r"^volumic [0-9.]+ \(VTK [0-9.]+")
        text = self.run_command("-h").stdout
        self.assertGreater(len(re.findall("^  (?:-q, )?--([a-z-]+)", text, re.M)), 85)
        self.assertLessEqual(max(map(len, text.splitlines())), 80)
        self.assertRegex(re.sub(r"\s+", " ", text), r"--reduction-factor T .*\(default: 1.732")

    def test_closed_pipe(self):
        done = subprocess.run(["sh", "-c", f"'{PROGRAM}' --help | head -1"], capture_output=True,
                              text=True, check=True)
        self.assertEqual((done.stderr, done.stdout[:6]), ("", "usage:"))


class RunTest(CommandTestCase):
    def test_all_outputs(self):
        self.run_command(self.ball_file(), self.path("a.vtp"), "--iso", ISO,
                      "--history", self.path("h.csv"), "--report", self.path("r.json"),
                      "--levels-output", self.path("l.vtm"), "--snapshots", self.path("s"),
                      "--snapshot-interval", "5", "--levels", "2")
        report = json.loads(self.content("r.json"))
        self.assertTrue(report["finished"])
        self.assertEqual([level["level"] for level in report["levels"]], [1, 0])
        self.assertEqual([(level["missing_parts"], level["missing_boundary"])
                          for level in report["levels"]], [(0, 0)] * 2)
        with open(self.path("h.csv"), encoding="utf-8", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(sum(level["iterations"] for level in report["levels"]), len(rows))
        for level in report["levels"]:
            own = [row for row in rows if int(row["Level"]) == level["level"]]
            self.assertAlmostEqual(
                sum(float(row["Seconds"]) for row in own) / level["seconds"], 1, 3)
        self.assertLessEqual(sum(level["seconds"] for level in report["levels"]),
                             report["seconds"]["surface"])
        self.assertEqual(read(self.path("l.vtm")).GetBlock(1).GetNumberOfPoints(),
                         report["levels"][0]["vertices"])
        self.assertGreater(len(os.listdir(self.path("s"))), 2)
        self.run_command(self.ball_file(), "--levels-output", self.path("levels"), "--iso", ISO,
                      "--levels", "2")
        self.assertEqual(sorted(os.listdir(self.path("levels"))), ["level-0.vtp", "level-1.vtp"])

    def test_warnings_name_options(self):
        """Many missed parts: sheets of one voxel next to a ball."""
        z, y, x = np.mgrid[0:64, 0:64, 0:64]
        distance = np.sqrt((x - 32) ** 2 + (y - 32) ** 2 + (z - 32) ** 2)
        voxels = np.clip(ISO + 100 * (16 - distance), 0, 1000).astype("i2")
        voxels[10:54, 10:54, 4:9:4] = 620
        volume = self.write(vtkXMLImageDataWriter(), "sheets.vti", make_image(voxels, [1] * 3))
        process = self.run_command(volume, self.path("a.vtp"), "--iso", ISO)
        self.assertRegex(process.stderr, "warning: .*of the object's boundary.* Set --finest to -1")

    def test_seeds_and_initial_surface(self):
        centre = ORIGIN + SPACING * CENTRE
        self.write_bytes("seeds.csv", b"x,y,z\n" + ",".join(map(str, centre)).encode() + b"\n")
        options = ("--iso", ISO, "--levels", "1", "--recovery", "none", "--seed-radius", "2")
        seeded = self.report(self.ball_file(), self.path("a.stl"), *options,
                             "--seeds", self.path("seeds.csv"))
        self.assertEqual(seeded["properties"]["Initialization"], "seeds")
        again = self.report(self.ball_file(), *options, "--initial-surface", self.path("a.stl"))
        self.assertEqual(again["properties"]["Initialization"], "input-surface")
        self.assertAlmostEqual(again["volume"] / seeded["volume"], 1.0, delta=0.01)
        self.assertLess(again["iterations"], seeded["iterations"])

    def test_attracting_points(self):
        point, radius = ORIGIN + SPACING * [20, 5, 13], 2.0
        self.write_bytes("points.txt", " ".join(map(str, [*point, 1, radius])).encode())
        options = (self.ball_file(), "--iso", ISO, "--levels", "1", "--minimum-part-size", "5",
                   "--attracting-points", self.path("points.txt"))
        report = self.report(*options)
        self.assertEqual(report["components"], 2)
        kept = self.report(*options, "--keep", "at-points")
        found = report["component_features"][1]
        self.assertEqual(kept["component_features"], [found])
        np.testing.assert_allclose(found["centroid"], point, atol=0.3)
        whole = 4 / 3 * np.pi * radius ** 3
        self.assertTrue(0.8 < found["volume"] / whole < 1.1, found)

    def test_edge_map_as_array_or_file(self):
        image = make_image(ball("f4"))
        magnitude = np.sqrt(sum(np.square(g) for g in np.gradient(ball("f4"), *SPACING[::-1])))
        edges = make_image(magnitude.astype("f4"))
        array = edges.GetPointData().GetScalars()
        array.SetName("gradient")
        file = self.write(vtkXMLImageDataWriter(), "edges.vti", edges)
        plain = self.report(self.ball_file(), "--iso", ISO)
        from_file = self.report(self.ball_file(), "--iso", ISO, "--edges", file)
        self.assertEqual(from_file["properties"]["EdgeAttractionWeight"], "2")
        self.assertNotEqual(from_file["volume"], plain["volume"])
        image.GetPointData().AddArray(array)
        both = self.write(vtkXMLImageDataWriter(), "both.vti", image)
        from_array = self.report(both, "--iso", ISO, "--edges", "gradient")
        self.assertAlmostEqual(from_array["volume"] / from_file["volume"], 1.0, delta=0.02)
        small = self.write(vtkXMLImageDataWriter(), "small.vti", make_image(ball()[1:]))
        self.rejects("its dimensions differ", self.ball_file(), self.path("a.stl"), "--edges", small)

    def test_time_limit(self):
        volume = self.waves_file()
        for limit in (0.6, 3, 15, 75, 375):  # A busy machine needs more time.
            run = self.run_command(volume, self.path("limited.stl"), "--iso", "0", "--convergence",
                                "0", "--time-limit", limit, status=None)
            if run.returncode == 3:
                break
        self.assertIn("unfinished (time limit): the current surface was written", run.stderr)
        self.assertIn(b"UNFINISHED: time limit", self.content("limited.stl")[:80])
        self.rejects("time limit reached before a surface was computed", volume, self.path("none.stl"),
                     "--iso", "0", "--time-limit", "1e-9")
        self.assertFalse(os.path.exists(self.path("none.stl")))

    def waves_file(self):
        """Return a large noisy volume with a long run time."""
        noise = np.random.default_rng(2).normal(0, 120, (100, 100, 100))
        z, y, x = np.mgrid[0:100, 0:100, 0:100] - 49.5
        waves = 300 * (np.sin(x / 4) + np.sin(y / 4) + np.sin(z / 4)) + noise
        return self.write(vtkXMLImageDataWriter(), "waves.vti",
                          make_image(waves.astype("f4"), (1, 1, 1)))

    def test_two_signals_at_once_are_one(self):
        """`timeout` signals the process and its group."""
        self.interrupted("Evolving.*iteration", self.waves_file(), self.path("a.vtp"), "--iso", "0",
                         "--convergence", "0", signals=[signal.SIGTERM] * 2)
        self.assertGreater(read(self.path("a.vtp")).GetNumberOfPolys(), 0)

    def test_interrupted_run_writes_surface(self):
        output = self.interrupted(
            "Evolving.*iteration", self.waves_file(), self.path("a.vtp"), "--iso", "0",
            "--convergence", "0", "--report", self.path("r.json"))
        self.assertIn("unfinished (cancelled)", output)
        report = json.loads(self.content("r.json"))
        self.assertEqual((report["finished"], report["stop_reason"]), (False, "cancelled"))
        surface = read(self.path("a.vtp"))
        self.assertEqual(surface.GetNumberOfPolys(), report["triangles"])
        self.assertEqual(surface.GetFieldData().GetAbstractArray("StopReason").GetValue(0),
                         "cancelled")
