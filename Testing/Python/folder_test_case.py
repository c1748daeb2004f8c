# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Test cases with a temporary folder."""

import os
import tempfile
import unittest


class FolderTestCase(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def path(self, name):
        return os.path.join(self.folder, name)

    def write(self, writer, name, image):
        """Write an image with a VTK writer; return the path."""
        writer.SetFileName(self.path(name))
        writer.SetInputData(image)
        writer.Write()
        return self.path(name)

    def bytes_of(self, writer, name, image):
        """Return the content that a VTK writer writes for an image."""
        self.write(writer, name, image)
        return self.content(name)

    def write_bytes(self, name, content):
        with open(self.path(name), "wb") as file:
            file.write(content)
        return self.path(name)

    def write_text(self, name, text):
        return self.write_bytes(name, text.encode())

    def content(self, name):
        with open(self.path(name), "rb") as file:
            return file.read()


class SharedFolderTestCase(FolderTestCase):
    """A test case with one temporary folder for all tests of the class."""

    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = folder.name

    def setUp(self):
        """Do not create a folder per test."""

    @classmethod
    def path(cls, name):
        return os.path.join(cls.folder, name)
