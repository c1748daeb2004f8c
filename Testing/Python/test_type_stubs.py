# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Tests of the type stubs of the installed package."""

import ast
import inspect
import os
import re
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

import volumic

FOLDER = Path(volumic.__file__).parent
CLASSES = {name: value for name, value in vars(volumic).items() if inspect.isclass(value)}
FUNCTIONS = {"labels", "read", "surface"}
TYPED = ("arrays", "tasks", "neuroglancer")  # public modules, checked completely

# A script for mypy. Comments state the expected output of a line: a type or an error code.
SCRIPT = """
import volumic
from volumic import vtkDeformableSurface, vtkImagePyramid, vtkOtsuThreshold, vtkVolumeToSurface
surface = vtkVolumeToSurface()
surface.SetIsoValue(226.5)
surface.SetMetric(surface.World)
surface.AddSeedPosition(1, 2, 3)
surface.AddObserver("ProgressEvent", lambda caller, event: None)
surface.Update()
reveal_type(surface.GetIsoValue())  # "float"
reveal_type(surface.GetNumberOfLevels())  # "int"
reveal_type(surface.GetProgressText())  # "str"
reveal_type(surface.GetSnapToIsoValue())  # "bool"
reveal_type(vtkOtsuThreshold().GetThreshold())  # "float"
reveal_type(vtkImagePyramid().GetReductionFactor())  # "float"
reveal_type(volumic.__version__)  # "str"
ball = volumic.surface([[[1]]], iso=0.5, FinestLevel=1)
reveal_type(ball)  # "volumic.arrays.Surface"
reveal_type(volumic.labels([[[1]]])[1].report)  # "dict[str, Any]"
volumic.labels([[[1]]], origin=3)  # [arg-type]
start: vtkDeformableSurface = surface
surface.SetIsoValue("high")  # [arg-type]
surface.SetIsoValue()  # [call-arg]
surface.GetIsoValue(0)  # [call-arg]
volumic.vtkDeformedSurface()  # [attr-defined]
"""


def definitions(node):
    """Return the definitions in a module or class of a stub by name."""
    found = {}
    for part in node.body:
        if isinstance(part, ast.AnnAssign):
            found.setdefault(part.target.id, []).append(part)
        elif isinstance(part, (ast.ClassDef, ast.FunctionDef)):
            found.setdefault(part.name, []).append(part)
    return found


def parsed(name):
    return ast.parse((FOLDER / name).read_text(encoding="utf-8"))


class StubsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.stubs = {name: part[0] for name, part in
                     definitions(parsed("vtkFiltersVolumic.pyi")).items()}

    def members(self, name):
        """Return the members in the stub of a class and its base classes."""
        node = self.stubs[name]
        base = node.bases[0].id
        return {**(self.members(base) if base in self.stubs else {}), **definitions(node)}

    def test_package_exports_classes(self):
        self.assertTrue((FOLDER / "py.typed").is_file())
        exported = {alias.asname for node in parsed("__init__.pyi").body
                    if isinstance(node, ast.ImportFrom) for alias in node.names}
        self.assertEqual(exported, FUNCTIONS.union(CLASSES))
        self.assertEqual(set(self.stubs), set(CLASSES))

    def test_stubs_list_all_members(self):
        for name, value in CLASSES.items():
            with self.subTest(name):
                there = {member for member in dir(value) if not member.startswith("_")}
                listed = {member for member in self.members(name) if not member.startswith("_")}
                self.assertEqual(listed, there)

    def test_getters_return_stub_types(self):
        for name, value in CLASSES.items():
            an_object = value()
            compared = 0
            for member, parts in self.members(name).items():
                for part in parts:
                    if not isinstance(part, ast.FunctionDef) or not member.startswith("Get"):
                        continue
                    stub_type = ast.unparse(part.returns)
                    if len(part.args.args) != 1 or part.decorator_list:
                        continue
                    result = getattr(an_object, member)()
                    if stub_type in ("int", "float", "bool", "str") and result is not None:
                        self.assertEqual(type(result).__name__, stub_type, f"{name}.{member}")
                        compared += 1
            self.assertGreater(compared, 10, name)

    @unittest.skipUnless(shutil.which("mypy"), "no mypy")
    def test_mypy(self):
        def mypy(*arguments):
            command = ["mypy", "--no-incremental", "--cache-dir=/dev/null", "--no-error-summary",
                       "--follow-imports=silent", "--ignore-missing-imports", *arguments]
            process = subprocess.run(command, cwd=folder, check=False, capture_output=True,
                                     text=True, env=environment)
            return process.stdout + process.stderr

        environment = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
        environment["MYPYPATH"] = "site"
        with tempfile.TemporaryDirectory() as folder:
            site = Path(folder, "site", "volumic")
            shutil.copytree(FOLDER, site)
            (site / "__init__.py").unlink()  # replaced by the stub
            modules = [word for name in TYPED for word in ("-m", f"volumic.{name}")]
            self.assertEqual(mypy(*modules, "--follow-imports=skip"), "")
            Path(folder, "script.py").write_text(SCRIPT, encoding="utf-8")
            output = mypy("script.py").replace("builtins.", "")
            found = {}
            lines = re.findall(r"^script\.py:(\d+): (?:error|note): (.*)$", output, re.M)
            for number, text in lines:
                found.setdefault(int(number), []).append(text)
            for number, line in enumerate(SCRIPT.splitlines(), 1):
                expected = line.partition("  # ")[2]
                reported = found.get(number, [])
                if not expected:
                    self.assertEqual(reported, [], line)
                else:
                    self.assertTrue(any(expected in text for text in reported), f"{line}: {output}")


if __name__ == "__main__":
    unittest.main()
