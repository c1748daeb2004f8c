# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Installs the packages with the system's dpkg, uses what they bring, and purges them again.

Skipped, with the reason, where that would change anything else: without root's rights; where a
package of Volumic, or a file that one would replace, is there already; where something that they
depend on is missing (nothing else is installed or removed for the test).
"""

import atexit
import json
import os
import re
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

from debian_packages import FLAVOUR, SKIPPED, made_packages, output_of

ALL_NAMES = ["volumic", "volumic-dev", "python3-volumic", "paraview-volumic"]
PVBATCH = os.environ["VOLUMIC_PVBATCH"]
BALL = """<VTKFile type="ImageData" version="1.0"><ImageData WholeExtent="0 19 0 19 0 19"
Origin="0 0 0" Spacing="1 1 1"><Piece Extent="0 19 0 19 0 19"><PointData Scalars="v">
<DataArray type="Float32" Name="v" format="ascii">{}</DataArray></PointData></Piece></ImageData>
</VTKFile>"""

# The field of ball.vti is 6 less the distance to its middle: a ball of radius 6.
VTK_SCRIPT = """
from vtkmodules.vtkIOXML import vtkXMLImageDataReader
import volumic
assert volumic.__file__.startswith("/usr/lib/python3/dist-packages/"), volumic.__file__
reader = vtkXMLImageDataReader()
reader.SetFileName("ball.vti")
surface = volumic.vtkDeformableSurface()
surface.SetInputConnection(reader.GetOutputPort())
surface.SetIsoValue(0)
surface.Update()
print(surface.GetOutput().GetNumberOfPolys())
"""
PARAVIEW_SCRIPT = """
from paraview.simple import *
LoadDistributedPlugin("Volumic", remote=False, ns=globals())
reader = XMLImageDataReader(FileName=["ball.vti"])
surface = DeformableSurface(Input=reader, IsoValue=0.0)
surface.UpdatePipeline()
print(surface.GetDataInformation().GetNumberOfCells())
"""


def skip(reason):
    print(f"Skipped: {reason}")
    sys.exit(SKIPPED)


def is_installed(name):
    status = subprocess.run(["dpkg-query", "-W", "-f=${db:Status-Status}", name], check=False,
                            capture_output=True, text=True).stdout
    return status not in ("", "not-installed")


def can_be_installed(packages):
    """Whether apt would install these and change nothing else."""
    process = subprocess.run(
        ["apt-get", "install", "-s", "--no-install-recommends", "--no-download",
         *(str(p.file) for p in packages)], check=False, capture_output=True, text=True,
        env={**os.environ, "LC_ALL": "C"})
    changed = set(re.findall(r"^(?:Inst|Remv) (\S+)", process.stdout, re.M))
    return process.returncode == 0 and changed == {p.name for p in packages}


def choose_packages():
    """Those that can be installed here; ends the test if there are none."""
    if os.geteuid() != 0:
        skip("installing packages takes root's rights")
    for name in ALL_NAMES:
        if is_installed(name):
            skip(f"the package {name} is installed already")
    packages = made_packages()
    for package in packages.values():
        for path in package.paths():
            if os.path.lexists(path):
                skip(f"{path} is there already")
    if can_be_installed(packages.values()):
        return packages
    # Without the files for development there.
    alone = {name: package for name, package in packages.items() if name == "volumic"}
    if alone and can_be_installed(alone.values()):
        return alone
    skip(f"what {', '.join(packages)} depend on is not installed")
    return {}


def run_dpkg(*arguments):
    """Its output. Waits while another one is at work."""
    for seconds_left in range(60, -1, -5):
        try:
            return output_of("dpkg", *arguments, stdin=subprocess.DEVNULL)
        except subprocess.CalledProcessError as error:
            if "lock" not in error.stderr or seconds_left == 0:
                raise AssertionError(f"dpkg failed: {error.stdout}{error.stderr}") from error
        time.sleep(5)


class InstallationTest(unittest.TestCase):
    packages = {}

    @classmethod
    def setUpClass(cls):
        cls.addClassCleanup(cls.purge)
        files = [package.file for package in cls.packages.values()]
        print(run_dpkg("-i", *files))
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        values = (6 - sum((n - 9.5) ** 2 for n in (x, y, z)) ** 0.5
                  for z in range(20) for y in range(20) for x in range(20))
        ball = " ".join(f"{value:.4f}" for value in values)
        Path(cls.folder.name, "ball.vti").write_text(BALL.format(ball), encoding="utf-8")

    @classmethod
    def purge(cls):
        """Remove the packages; nothing of theirs may be left."""
        there = [name for name in cls.packages if is_installed(name)]
        paths = {path for name in there for path in output_of("dpkg", "-L", name).split("\n")}
        if there:
            print(run_dpkg("--purge", *there))
        left = [path for path in paths if "olumic" in path and os.path.lexists(path)]
        if left or any(is_installed(name) for name in cls.packages):
            raise AssertionError(f"left behind: {left}")

    def run_in_folder(self, *command, **environment):
        """Its output, run in the folder with the ball; nothing of the build is in its way."""
        clean = {k: v for k, v in os.environ.items()
                 if k not in ("PYTHONPATH", "LD_LIBRARY_PATH", "CMAKE_PREFIX_PATH")}
        # The files that Python would write are the packages' business.
        clean.pop("PYTHONDONTWRITEBYTECODE", None)
        process = subprocess.run([str(w) for w in command], cwd=self.folder.name, check=False,
                                 capture_output=True, text=True, timeout=1200,
                                 env={**clean, **environment})
        self.assertEqual(process.returncode, 0, process.stdout + process.stderr)
        return process.stdout

    def needs(self, name):
        if name not in self.packages:
            self.skipTest(f"{name} is not among the packages that could be installed here")

    def test_program(self):
        self.needs("volumic")
        version = self.packages["volumic"].version.split("-")[0]
        self.assertIn(f"volumic {version} ", self.run_in_folder("volumic", "--version"))
        report = json.loads(self.run_in_folder(
            "volumic", "ball.vti", "ball.stl", "--iso", "0", "--report", "-"))
        self.assertEqual((report["components"], report["genus"]), (1, 0))
        self.assertAlmostEqual(report["volume"], 4 / 3 * 3.14159 * 6 ** 3, delta=60)

    def test_python(self):
        self.needs("volumic")
        output = self.run_in_folder("/usr/bin/python3", "-c", VTK_SCRIPT)
        self.assertGreater(int(output), 100)

    def test_plugin(self):
        self.needs("paraview-volumic")
        if not PVBATCH:
            self.skipTest("no pvbatch that finds ParaView's Python")
        Path(self.folder.name, "plugin.py").write_text(PARAVIEW_SCRIPT, encoding="utf-8")
        plugin = next(path for path in self.packages["paraview-volumic"].paths()
                      if path.endswith("/Volumic.so"))
        output = self.run_in_folder(PVBATCH, "--force-offscreen-rendering", "plugin.py",
                                    PV_PLUGIN_PATH=os.path.dirname(plugin))
        self.assertGreater(int(output.split()[-1]), 100)


if __name__ == "__main__":
    print(f"Packages of the build with {FLAVOUR}")
    InstallationTest.packages = choose_packages()
    atexit.register(InstallationTest.purge)  # also where somebody stops the test
    unittest.main()
