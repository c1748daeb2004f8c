# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The packages hold what they should, where Debian wants it, and depend on what they need."""

import re
import tempfile
import unittest
from pathlib import Path

from debian_packages import BUILD, FLAVOUR, NAMES, SOURCE, made_packages, output_of


# Of the Python package, as patterns: all sources, and what editors use.
MODULES = [re.escape(str(path.relative_to(SOURCE / "Python")))
           for path in sorted((SOURCE / "Python").rglob("*.py"))]
MODULES += [r"volumic/__init__\.py", r"volumic/__init__\.pyi", r"volumic/vtkFiltersVolumic\.pyi",
            r"volumic/py\.typed", r"volumic/vtkFiltersVolumic\..*\.so"]


class ContentsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.packages = made_packages()
        cls.library = "/usr/lib/" + output_of("dpkg-architecture", "-qDEB_HOST_MULTIARCH").strip()

    def unpack(self, package):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        output_of("dpkg-deb", "-x", package.file, folder.name)
        return Path(folder.name)

    def holds(self, name, *patterns):
        """Each pattern fits a path of the package."""
        paths = self.packages[name].paths()
        for pattern in patterns:
            self.assertTrue(any(re.fullmatch(pattern, path) for path in paths),
                            f"{name} has no {pattern}: {sorted(paths)}")

    @unittest.skipUnless(FLAVOUR == "vtk", "packages of the build with VTK")
    def test_files_for_vtk(self):
        lib = re.escape(self.library)
        self.holds("volumic", "/usr/bin/volumic", lib + r"/libvtkFiltersVolumic\.so\.[0-9.]+",
                   *(f"/usr/lib/python3/dist-packages/{name}" for name in MODULES))
        self.holds("volumic-dev", "/usr/include/volumic/vtkDeformableSurface.h",
                   lib + r"/libvtkFiltersVolumic\.so", lib + "/cmake/Volumic/VolumicConfig.cmake",
                   lib + "/cmake/Volumic/Volumic-targets.cmake")

    @unittest.skipUnless(FLAVOUR == "paraview", "packages of the build with ParaView")
    def test_files_for_paraview(self):
        lib = re.escape(self.library)
        self.holds("paraview-volumic", lib + r"/paraview-[0-9.]+/plugins/Volumic/Volumic\.so",
                   lib + r"/libvtkFiltersVolumic-pv[0-9.]+\.so\.[0-9.]+",
                   *(f".*/python3/site-packages/{name}" for name in MODULES))
        for path in self.packages["paraview-volumic"].paths():
            # What the packages of the other flavour have.
            self.assertNotRegex(path, r"^/usr/bin|/include/|/dist-packages/|/cmake/|Volumic\.so\.")

    def test_names_and_places(self):
        self.assertEqual(sorted(self.packages), sorted(NAMES))
        for name, package in self.packages.items():
            self.holds(name, f"/usr/share/doc/{name}/copyright",
                       rf"/usr/share/doc/{name}/changelog\.Debian\.gz")
            for _, owner, path in package.files():
                self.assertTrue(path.startswith("/usr/"), path)
                self.assertEqual(owner, "root/root", path)

    def test_dependencies(self):
        if FLAVOUR == "paraview":
            own = self.packages["paraview-volumic"]
            relations = own.dependencies()["paraview"]
            self.assertTrue(any(r.startswith(">=") for r in relations), relations)
            self.assertTrue(any(r.startswith("<<") for r in relations), relations)
            self.assertNotIn("libvtk9.1", own.dependencies())
            self.assertIn("python3-paraview", own.dependencies("Recommends"))
            self.assertIn("python3-nibabel", own.dependencies("Recommends"))
            return
        package, develop = (self.packages[name] for name in NAMES)
        needed = package.dependencies()
        self.assertTrue(any(name.startswith("libvtk") for name in needed), needed)
        self.assertLessEqual({"libc6", "libstdc++6", "python3-vtk9", "python3-numpy"}, set(needed))
        self.assertEqual([relation[:2] for relation in needed["python3"]], [">=", "<<"])
        self.assertLessEqual({"python3-nibabel", "python3-pydicom", "python3-zarr"},
                             set(package.dependencies("Recommends")))
        self.assertEqual(develop.dependencies()["volumic"], [f"= {package.version}"])
        self.assertIn("libvtk9-dev", develop.dependencies())

    def test_nothing_of_the_build_machine_is_left(self):
        for name, package in self.packages.items():
            folder = self.unpack(package)
            for path in package.paths():
                file = folder / path[1:]
                if file.is_symlink():
                    continue
                content = file.read_bytes()
                for place in (BUILD, SOURCE):
                    self.assertFalse(f"{place}/".encode() in content,
                                     f"{name}: {path} holds the path {place}")
                if content.startswith(b"\x7fELF"):
                    dynamic = output_of("readelf", "-d", file)
                    paths = re.findall(r"(?:RPATH|RUNPATH)\).*\[(.*)\]", dynamic)
                    expected = [["$ORIGIN"]] if "/plugins/" in path else [[]]
                    self.assertIn(paths, expected, f"{name}: {path}")


if __name__ == "__main__":
    unittest.main()
