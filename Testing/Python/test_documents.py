# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Tests of the pages in the root and Documentation/: links are valid, code blocks run."""

import gzip
import importlib.util
import os
import re
import shlex
import shutil
import subprocess
import sys
import unittest

import medical_files
import test_ome_zarr
from folder_test_case import FolderTestCase
from sample_volumes import ROOT, ring_voxels
from vtk_files import read as read_file
from volumic.reading import SUFFIXES

PREFIX = os.environ["VOLUMIC_TEST_INSTALL_PREFIX"]
DOCUMENTS = sorted(f"{folder}{name}" for folder in ("", "Documentation/")
                   for name in os.listdir(os.path.join(ROOT, folder)) if name.endswith(".md"))


def read(document):
    with open(os.path.join(ROOT, document), encoding="utf-8") as file:
        return file.read()


def blocks(document, language):
    """Return the code blocks of a language."""
    return re.findall(rf"^```{language}\n(.*?)^```$", read(document), flags=re.DOTALL | re.MULTILINE)


class LinksTest(unittest.TestCase):
    def test_links_are_valid(self):
        for document in DOCUMENTS:
            for link in re.findall(r"\]\((?!https?:)([^)]+)\)", read(document)):
                path, _, heading = link.partition("#")
                target = os.path.normpath(os.path.join(os.path.dirname(document), path)) if path \
                    else document
                self.assertTrue(os.path.exists(os.path.join(ROOT, target)), f"{document}: {link}")
                if heading:
                    self.assertIn(heading, self.anchors(target))

    def anchors(self, document):
        """Return the anchors of headings, as GitHub creates them."""
        headings = re.findall(r"^#+ (.*)$", read(document), flags=re.MULTILINE)
        return [re.sub(r"[^\w -]", "", heading).strip().lower().replace(" ", "-")
                for heading in headings]

    def test_mentioned_files_exist(self):
        for document in DOCUMENTS:
            for path in re.findall(r"\b((?:Examples|Testing|Documentation|CMake)/[\w/.-]+\w)"
                                   r"|`((?:Python|Filters|Plugin)/[\w/.]+\w)`",
                                   read(document)):
                path = "".join(path)
                self.assertTrue(os.path.exists(os.path.join(ROOT, path)), f"{document}: {path}")

    def test_command_options_exist(self):
        text = subprocess.run([os.path.join(PREFIX, "bin", "volumic"), "--help"], check=True,
                              capture_output=True, text=True).stdout
        known = set(re.findall(r"--[a-z][a-z-]+", text))
        self.assertGreater(len(known), 50)
        for document in DOCUMENTS:
            lines = "".join(blocks(document, "sh")).replace("\\\n", " ").splitlines()
            for line in (line for line in lines if re.match(r"(\S*/)?volumic ", line)):
                self.assertLessEqual(set(re.findall(r" (--[a-z][a-z-]+)", line)), known,
                                     f"{document}: {line}")


class CodeTest(FolderTestCase):
    def setUp(self):
        super().setUp()
        self.write_bytes("scan.nii.gz", gzip.compress(
            medical_files.nifti(ring_voxels().astype("i2"), (1, 1, 1.5))))

    def run_here(self, *command, **options):
        run = subprocess.run(command, cwd=self.folder, capture_output=True, text=True, check=False,
                             timeout=1200, **options)
        self.assertEqual(run.returncode, 0, f"{shlex.join(command)}\n{run.stdout}\n{run.stderr}")
        return run

    def check_surface(self):
        """Check surface.stl, the torus."""
        surface = read_file(self.path("surface.stl"))
        self.assertGreater(surface.GetNumberOfPolys(), 500)
        self.assertEqual(2 * surface.GetNumberOfPoints(), surface.GetNumberOfPolys())

    def test_readme_python(self):
        code, = blocks("README.md", "python")
        self.assertLessEqual(len([line for line in code.splitlines() if line]), 6)
        run = self.run_here(sys.executable, "-c", code)
        self.assertEqual((run.stdout, run.stderr), ("genus 1\n", ""))
        self.check_surface()

    def test_tutorial_python(self):
        pieces = [code for code in blocks("Documentation/tutorial.md", "python")
                  if "ome_zarr" not in code]
        self.assertTrue(pieces)
        for code in pieces:
            run = self.run_here(sys.executable, "-c", code
                                + "\nprint(surface.GetOutput().GetNumberOfPolys())")
            self.assertEqual(run.stderr, "")
            self.assertGreater(int(run.stdout), 500)

    @unittest.skipUnless(test_ome_zarr.zarr and shutil.which("draco_encoder"),
                         "no zarr or no draco (Debian: python3-zarr, draco)")
    def test_tutorial_microscopy(self):
        test_ome_zarr.write_labels(self.path("scan.ome.zarr"), "cells", ring_voxels() > 125)
        code, = (code for code in blocks("Documentation/tutorial.md", "python")
                 if "ome_zarr" in code)
        self.run_here(sys.executable, "-c", code)
        for name in ("label-1.ply", "labels.csv", "precomputed/info", "multilod_draco/1.index"):
            self.assertTrue(os.path.exists(self.path(f"meshes/{name}")), name)

    def test_python_page(self):
        arrays, files = blocks("Documentation/python.md", "python")
        run = self.run_here(sys.executable, "-c", files)
        self.assertEqual(run.stderr, "")
        self.assertIn("genus 1", run.stdout)
        run = self.run_here(sys.executable, "-c", arrays)
        self.assertEqual(run.stderr, "")
        for name in ("ball.ply", "organ.vtp"):
            self.assertTrue(os.path.exists(self.path(name)), name)

    @unittest.skipUnless(test_ome_zarr.zarr, "no zarr (Debian: python3-zarr)")
    def test_cluster_page(self):
        test_ome_zarr.write_labels(self.path("scan.ome.zarr"), "cells", ring_voxels() > 125)
        loop, pool, dask, slurm = blocks("Documentation/cluster.md", "python")[:4]
        scripts = [loop] + [loop.partition("job = ")[0] + code for code in (pool, dask)]
        folders = ["meshes", "meshes-of-a-pool", "meshes-of-dask"]
        if importlib.util.find_spec("distributed") is None:
            del scripts[2], folders[2]
        for script, folder in zip(scripts, folders):
            self.write_text("script.py", script)
            self.run_here(sys.executable, "script.py")
            self.assertTrue(os.path.exists(self.path(folder + "/labels.csv")), script)
        self.write_text("task.py", slurm)
        for arguments in (("count", "0", "2"), ("count", "1", "2"), ("make", "1", "2"),
                          ("make", "0", "2"), ("finish", "0", "1")):
            self.run_here(sys.executable, "task.py", *arguments)
        self.assertTrue(os.path.exists(self.path("meshes-of-slurm/labels.csv")))

    @unittest.skipUnless(shutil.which("cmake") and shutil.which("c++"), "no compiler here")
    def test_readme_cpp(self):
        source, = blocks("README.md", "cpp")
        project, = blocks("README.md", "cmake")
        self.write_text("example.cxx", source)
        self.write_text("CMakeLists.txt", project)
        self.run_here("cmake", "-S", ".", "-B", "build", f"-DCMAKE_PREFIX_PATH={PREFIX}",
                      f"-DPython3_EXECUTABLE={sys.executable}")
        self.run_here("cmake", "--build", "build")
        self.run_here(self.path("build/example"))
        self.check_surface()

    def test_formats_page_lists_all_suffixes(self):
        rows = re.findall(r"^\| (.*?) \|", read("Documentation/formats.md"), flags=re.MULTILINE)
        documented = {name for row in rows for name in re.findall(r"`(\.[a-z0-9.]+)`", row)}
        self.assertEqual(documented - {".zarr"}, set(SUFFIXES))

    def test_install_page_lists_all_build_options(self):
        known = re.findall(r"^option\((\w+)", read("CMake/VolumicOptions.cmake"),
                           flags=re.MULTILINE)
        documented = re.findall(r"^\| `([A-Z_]+)` \|", read("Documentation/install.md"),
                                flags=re.MULTILINE)
        self.assertEqual(sorted(documented), sorted(known))
