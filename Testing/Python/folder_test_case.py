# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""A test with a folder of its own, for files that it writes; a program on a terminal."""

import os
import pty
import re
import signal
import subprocess
import tempfile
import unittest


def run_on_terminal(command, interrupt_at=None):
    """All that a terminal shows, and the exit code; Ctrl-C when the text has come."""
    leader, follower = pty.openpty()
    with subprocess.Popen(command, stdout=follower, stderr=follower) as process:
        os.close(follower)
        shown = ""
        while True:
            try:
                piece = os.read(leader, 4096)
            except OSError:  # Linux's way to say that the other end is closed
                piece = b""
            if not piece:
                break
            shown += piece.decode()
            if interrupt_at and re.search(interrupt_at, shown):
                process.send_signal(signal.SIGINT)
                interrupt_at = None
        os.close(leader)
    return shown, process.returncode


def interrupted_on_terminal(command, at):
    """The same of a run that gets its Ctrl-C: one that was quicker than that is made again."""
    for _ in range(20):
        shown, code = run_on_terminal(command, at)
        if code != 0:
            break
    return shown, code


class FolderTestCase(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def path(self, name):
        return os.path.join(self.folder, name)

    def write(self, writer, name, image):
        """Have a writer of VTK write the image; returns the path."""
        writer.SetFileName(self.path(name))
        writer.SetInputData(image)
        writer.Write()
        return self.path(name)

    def bytes_of(self, writer, name, image):
        """What a writer of VTK writes of the image."""
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
    """A folder for all tests of the class, whose files take long to make."""

    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = folder.name

    def setUp(self):
        """It has none of its own."""

    @classmethod
    def path(cls, name):
        return os.path.join(cls.folder, name)
