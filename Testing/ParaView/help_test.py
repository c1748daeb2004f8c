# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The pages of help that ParaView shows for the plugin's filters name all of their properties,
inherited ones too. VOLUMIC_HELP is the database of Qt's help system that the plugin holds.
"""

import os
import re
import sqlite3
import unittest
import zlib

import plugin_testing as testing
from paraview import servermanager


def pages():
    """{name: text} of the pages of help."""
    connection = sqlite3.connect(os.environ["VOLUMIC_HELP"])
    rows = connection.execute("SELECT FileNameTable.Name, FileDataTable.Data FROM FileNameTable "
                              "JOIN FileDataTable ON FileNameTable.FileId = FileDataTable.Id")
    # Qt puts the length before what it compresses.
    found = {name: zlib.decompress(data[4:]).decode() for name, data in rows if data}
    connection.close()
    return found


@unittest.skipUnless(os.environ["VOLUMIC_HELP"], "this ParaView makes no pages of help")
class HelpTest(unittest.TestCase):
    def test_pages_name_all_properties(self):
        testing.load_plugin()
        texts = pages()
        for name in ("DeformableSurface", "ImagePyramid", "LabelsToSurfaces", "VolumeToSurface"):
            text = next(texts[page] for page in texts if page.endswith(f"filters.{name}.html"))
            described = re.findall(r"<th>([^<]*)</th>", text)[1:]  # after the head
            self.assertEqual(len(described), len(set(described)))
            manager = servermanager.ProxyManager().SMProxyManager
            proxy = manager.NewProxy("filters", name)
            iterator = proxy.NewPropertyIterator()
            iterator.Begin()
            labels = set()
            while not iterator.IsAtEnd():
                property_ = iterator.GetProperty()
                # What holds no value is a command, for scripts.
                if property_.GetCommand() and property_.IsA("vtkSMVectorProperty") \
                        or property_.IsA("vtkSMProxyProperty"):
                    labels.add(property_.GetXMLLabel())
                iterator.Next()
            self.assertEqual(set(described), labels, name)
            self.assertGreater(len(labels), 5)
