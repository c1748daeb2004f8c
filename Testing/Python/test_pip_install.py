# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Tests of `pip install` into a virtual environment.

Skipped, with the reason, if a requirement is missing. Requires no network.
"""

import importlib.util
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

from sample_volumes import RING_ISO, ring_voxels, write_volume

SKIPPED = 77  # exit code
SOURCE = Path(os.environ["VOLUMIC_SOURCE"])
VTK_PACKAGES = os.environ["VOLUMIC_VTK_PACKAGES"]  # the folder of vtkmodules
INSTALLED = Path(os.environ["VOLUMIC_TEST_INSTALL_PREFIX"])
# Hide the build from the installed package.
ENVIRONMENT = {name: value for name, value in os.environ.items()
               if name not in ("PYTHONPATH", "LD_LIBRARY_PATH", "PYTHONDONTWRITEBYTECODE")}
ENVIRONMENT.update(CXX=os.environ["VOLUMIC_COMPILER"], PIP_NO_INDEX="1",
                   PIP_DISABLE_PIP_VERSION_CHECK="1")


def run(*command, check=True, **options):
    """Return the output of a command. Raise AssertionError with the output if it fails (with
    check)."""
    process = subprocess.run([str(word) for word in command], check=False, text=True,
                             stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                             stdin=subprocess.DEVNULL, **{"env": ENVIRONMENT, **options})
    if check and process.returncode != 0:
        raise AssertionError(f"{command} failed: {process.stdout}")
    return process.stdout


def skip_reason():
    """Return why the test cannot run, or None."""
    for module, package in (("scikit_build_core", "python3-scikit-build-core"),
                            ("pip", "python3-pip"), ("ensurepip", "python3-venv")):
        if importlib.util.find_spec(module) is None:
            return f"no {module} (Debian: {package}, which Debian 12 may not have)"
    code = "import vtkmodules; print(vtkmodules.__path__[0])"
    found = run(sys.executable, "-c", code, check=False)
    if not os.path.realpath(found.strip()).startswith(os.path.realpath(VTK_PACKAGES)):
        return f"{sys.executable} finds another VTK by itself, or none: {found.strip()}"
    return None


def setUpModule():
    if reason := skip_reason():
        print(f"Skipped: {reason}")
        sys.exit(SKIPPED)


class PipInstallTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.folder = Path(temporary.name)
        run(sys.executable, "-m", "venv", "--system-site-packages", cls.folder / "env")
        cls.bin = cls.folder / "env" / "bin"
        cls.addClassCleanup(cls.uninstall)
        # The build folder is reused by later runs.
        print(cls.install(os.environ["VOLUMIC_PIP_BUILD"]))
        write_volume(str(cls.folder / "ring.mha"), ring_voxels())

    @classmethod
    def install(cls, build, *arguments, check=True):
        return run(cls.bin / "pip", "install", "--no-build-isolation", *arguments,
                   f"--config-settings=build-dir={build}",
                   f"--config-settings=cmake.define.VTK_DIR={os.environ['VOLUMIC_VTK_DIR']}",
                   SOURCE, check=check)

    @classmethod
    def uninstall(cls):
        """Uninstall, and check that no file remains."""
        run(cls.bin / "pip", "uninstall", "-y", "volumic")
        left = list((cls.folder / "env").rglob("*olumic*"))
        if left:
            raise AssertionError(f"left behind: {left}")

    def test_import_and_version(self):
        output = run(self.bin / "python", "-c", "import importlib.metadata as m, volumic\n"
                     "print(volumic.__version__, m.version('volumic'), volumic.__file__)",
                     cwd=self.folder)
        version, distribution, file = output.split()
        self.assertEqual(version, os.environ["VOLUMIC_VERSION"])
        self.assertEqual(distribution, version)
        self.assertTrue(file.startswith(str(self.folder)), file)

    def test_requires_its_vtk(self):
        """By pip if pip lists VTK, and always on import."""
        output = run(self.bin / "python", "-c", """if True:
            import importlib.metadata as m, vtkmodules
            known = [d.version for d in m.distributions(name="vtk")]
            print(vtkmodules.__version__, *known, sep="\\n")
            print(*[r for r in m.requires("volumic") if "extra" not in r], sep="\\n")""")
        version, *rest = output.split()
        self.assertIn(rest, ([], [version, f"vtk=={version}"]))
        for other in (version, version + "1"):  # found first, even of the same version
            with tempfile.TemporaryDirectory() as folder:
                Path(folder, "vtkmodules").mkdir()
                Path(folder, "vtkmodules", "__init__.py").write_text(f"__version__ = '{other}'\n",
                                                                     encoding="utf-8")
                output = run(self.bin / "python", "-c", "import volumic", check=False,
                             env={**ENVIRONMENT, "PYTHONPATH": folder})
                self.assertRegex(output, f"built for VTK {version} in /.* finds VTK {other} in "
                                         f"{folder}")

    def test_record_matches_files(self):
        run(self.bin / "python", "-c", """if True:
            import base64, hashlib, importlib.metadata as m
            for file in m.files("volumic"):
                if file.hash and file.hash.mode == "sha256":
                    digest = base64.urlsafe_b64encode(hashlib.sha256(file.read_binary()).digest())
                    assert digest.rstrip(b"=").decode() == file.hash.value, file""")

    def test_command_and_bit_identical_surface(self):
        self.assertIn(f"volumic {os.environ['VOLUMIC_VERSION']} ",
                      run(self.bin / "volumic", "--version"))
        surfaces = []
        for program in (self.bin / "volumic", INSTALLED / "bin" / "volumic"):
            run(program, "ring.mha", "ring.stl", "--iso", str(RING_ISO), cwd=self.folder)
            surfaces.append((self.folder / "ring.stl").read_bytes())
        self.assertEqual(surfaces[0], surfaces[1])
