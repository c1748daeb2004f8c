# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""README.md and Documentation/: pictures and links are there, and the code in them runs."""

import os
import re
import shlex
import shutil
import subprocess
import sys
import unittest

import medical_files
import volumic
from examples_path import EXAMPLES
from folder_test_case import FolderTestCase
from sample_volumes import ring_voxels
from vtk_files import read as read_file

sys.path.insert(0, EXAMPLES)
# pylint: disable=wrong-import-position
from figures import LARGEST, SKULL_PICTURES
from pipeline import property_names
from read_volume import read_volume

ROOT = os.path.normpath(os.path.join(EXAMPLES, "..", ".."))
DOCUMENTS = ("README.md", *(f"Documentation/{name}.md"
                            for name in ("tutorial", "install", "paraview", "python", "cluster",
                                         "reference", "measured", "limitations", "differences",
                                         "architecture", "development")))


def read(document):
    with open(os.path.join(ROOT, document), encoding="utf-8") as file:
        return file.read()


def blocks(document, language):
    """The code between fences of that language."""
    return re.findall(rf"^```{language}\n(.*?)^```$", read(document), flags=re.DOTALL | re.MULTILINE)


class LinksTest(unittest.TestCase):
    def test_all_documents_are_looked_at_and_linked_from_the_readme(self):
        there = {f"Documentation/{name}" for name in os.listdir(os.path.join(ROOT, "Documentation"))
                 if name.endswith(".md")}
        self.assertEqual(there | {"README.md"}, set(DOCUMENTS))
        links = re.findall(r"\]\(([^)]+)\)", read("README.md"))
        self.assertLessEqual(there, {link.partition("#")[0] for link in links})

    def pictures(self):
        """(document, path of a picture that it shows)."""
        for document in DOCUMENTS:
            for link in re.findall(r"!\[[^\]]*\]\(([^)]+)\)", read(document)):
                yield document, os.path.normpath(
                    os.path.join(ROOT, os.path.dirname(document), link))

    def test_pictures_are_there_and_small(self):
        shown = list(self.pictures())
        self.assertGreater(len(shown), 5)
        for document, path in shown:
            self.assertTrue(os.path.isfile(path), f"{document}: {path}")
            self.assertLessEqual(os.path.getsize(path), LARGEST, path)

    def test_no_picture_is_left_over_or_without_a_script(self):
        shown = {os.path.basename(path) for _, path in self.pictures()}
        there = {name for name in os.listdir(os.path.join(ROOT, "Documentation"))
                 if name.endswith(".png")}
        self.assertEqual(there, shown)
        scripted = {draw.__name__ + ".png" for draw in SKULL_PICTURES}
        for name in there - scripted:  # a name per scan; windows, which are not pictures of data
            self.assertRegex(name, "^(vessels|graded|labels|interfaces|paraview)")

    def test_links_lead_somewhere(self):
        for document in DOCUMENTS:
            for link in re.findall(r"\]\((?!https?:)([^)]+)\)", read(document)):
                path, _, heading = link.partition("#")
                target = os.path.normpath(os.path.join(os.path.dirname(document), path)) if path \
                    else document
                self.assertTrue(os.path.exists(os.path.join(ROOT, target)), f"{document}: {link}")
                if heading:
                    self.assertIn(heading, self.anchors(target))

    def anchors(self, document):
        """Of the headings, as repositories show them."""
        headings = re.findall(r"^#+ (.*)$", read(document), flags=re.MULTILINE)
        return [re.sub(r"[^\w -]", "", heading).strip().lower().replace(" ", "-")
                for heading in headings]

    def test_files_that_are_named_exist(self):
        for document in DOCUMENTS:
            for path in re.findall(r"\b((?:Examples|Testing|Documentation|CMake)/[\w/.-]+\w)"
                                   r"|`((?:Applications|Filters|Plugin)/[\w/.]+\w)`",
                                   read(document)):
                path = "".join(path)
                self.assertTrue(os.path.exists(os.path.join(ROOT, path)), f"{document}: {path}")

    def test_scripts_that_are_named_exist(self):
        named = re.findall(r"^\| `(\w+\.py)", read("Documentation/python.md"), flags=re.MULTILINE)
        self.assertGreater(len(named), 5)
        for name in named:
            self.assertTrue(os.path.exists(os.path.join(EXAMPLES, name)), name)

    def test_tests_that_are_named_exist(self):
        folder = os.path.join(ROOT, "Testing", "Cxx")
        known = set()
        for name in os.listdir(folder):
            for suite, test in re.findall(r"^TEST(?:_F|_P)?\((\w+), (\w+)\)",
                                          read(os.path.join("Testing", "Cxx", name)), re.MULTILINE):
                known |= {f"{suite}.{test}", f"{suite}.*"}
        named = set(re.findall(r"`([A-Z]\w+\.(?:[A-Z]\w+|\*))`",
                               read("Documentation/differences.md")))
        self.assertGreater(len(named), 20)
        self.assertEqual(sorted(named - known), [])

    def test_comments_cite_what_is_here(self):
        for path, _, names in os.walk(os.path.join(ROOT, "Filters")):
            for name in names:
                document = os.path.relpath(os.path.join(path, name), ROOT)
                for cited in re.findall(r"\b([\w/]+\.md)\b", read(document)):
                    self.assertTrue(os.path.exists(os.path.join(ROOT, cited)),
                                    f"{document}: {cited}")

    def test_properties_on_command_lines_are_known(self):
        names = property_names(volumic.vtkDeformableSurface())
        settings = re.findall(r"--set (\w+)=", "".join(map(read, DOCUMENTS)))
        self.assertTrue(settings)
        self.assertLessEqual(set(settings), set(names))


class CodeTest(FolderTestCase):
    def setUp(self):
        super().setUp()
        self.write_bytes("scan.nii.gz",
                         medical_files.nifti(ring_voxels().astype("i2"), (1, 1, 1.5)))

    def run_here(self, *command, **options):
        run = subprocess.run(command, cwd=self.folder, capture_output=True, text=True, check=False,
                             timeout=250, **options)
        self.assertEqual(run.returncode, 0, f"{shlex.join(command)}\n{run.stdout}\n{run.stderr}")
        return run

    def check_surface(self):
        """surface.stl is the ring."""
        surface = read_file(self.path("surface.stl"))
        self.assertGreater(surface.GetNumberOfPolys(), 500)
        self.assertEqual(2 * surface.GetNumberOfPoints(), surface.GetNumberOfPolys())

    def test_python_of_the_readme(self):
        code, = blocks("README.md", "python")
        self.assertLessEqual(len([line for line in code.splitlines() if line]), 14)
        run = self.run_here(sys.executable, "-c", code)
        self.assertEqual((run.stdout, run.stderr), ("genus 1\n", ""))
        self.check_surface()

    def test_python_of_the_tutorial(self):
        pieces = blocks("Documentation/tutorial.md", "python")
        self.assertTrue(pieces)
        for code in pieces:
            run = self.run_here(sys.executable, "-c", code
                                + "\nprint(surface.GetOutput().GetNumberOfPolys())")
            self.assertEqual(run.stderr, "")
            self.assertGreater(int(run.stdout), 500)

    def test_header_of_the_tutorial(self):
        header = re.search(r"^```\n(ObjectType.*?)^```$", read("Documentation/tutorial.md"),
                           flags=re.DOTALL | re.MULTILINE).group(1)
        header = header.replace("256 256 256", "4 5 6")
        self.write_bytes(re.search(r"ElementDataFile = (.*)", header).group(1), bytes(range(120)))
        image = read_volume(self.write_text("a.mhd", header))
        self.assertEqual(image.GetDimensions(), (4, 5, 6))
        self.assertEqual(image.GetScalarRange(), (0, 119))

    @unittest.skipUnless(shutil.which("cmake") and shutil.which("c++"), "no compiler here")
    def test_cpp_of_the_readme(self):
        source, = blocks("README.md", "cpp")
        project, = blocks("README.md", "cmake")
        self.write_text("example.cxx", source)
        self.write_text("CMakeLists.txt", project)
        prefix = os.environ["VOLUMIC_TEST_INSTALL_PREFIX"]
        self.run_here("cmake", "-S", ".", "-B", "build", f"-DCMAKE_PREFIX_PATH={prefix}",
                      f"-DPython3_EXECUTABLE={sys.executable}")
        self.run_here("cmake", "--build", "build")
        self.run_here(self.path("build/example"))
        self.check_surface()

    def test_citation_is_of_this_version(self):
        version, = re.findall(r"^version: (.*)$", read("CITATION.cff"), flags=re.MULTILINE)
        self.assertEqual(version, volumic.__version__)

    def test_options_of_the_build_are_told(self):
        known = re.findall(r"^option\((\w+)", read("CMake/VolumicOptions.cmake"),
                           flags=re.MULTILINE)
        told = re.findall(r"^\| `([A-Z_]+)` \|", read("Documentation/install.md"),
                          flags=re.MULTILINE)
        self.assertEqual(sorted(told), sorted(known))


if __name__ == "__main__":
    unittest.main()
