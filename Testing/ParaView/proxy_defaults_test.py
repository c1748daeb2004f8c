# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The properties of every proxy of the plugin hold what a new object of the C++ class holds.

Both are written down once by hand, in the plugin's XML and in the class; nothing else holds them
together.
"""

import glob
import os
import sys
import unittest
import xml.etree.ElementTree as ElementTree

from paraview import servermanager

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import plugin_testing as testing

PLUGIN_SOURCES = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../Plugin/*.xml")

# Properties whose value depends on the data, so that the class has none or another to begin with.
FROM_DATA = {"IsoValue", "SeedRadius"}
VALUE_ELEMENTS = ("IntVectorProperty", "DoubleVectorProperty")


def proxy_elements():
    """(group, element) of every proxy that the plugin's XML describes."""
    for path in glob.glob(PLUGIN_SOURCES):
        for group in ElementTree.parse(path).getroot().iter("ProxyGroup"):
            for element in group:
                yield group.get("name"), element


class ProxyDefaultsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        testing.load_plugin()
        # Python knows an object of ours by its class once the package is imported.
        sys.path.insert(0, os.environ["VOLUMIC_PYTHON"])
        import volumic
        cls.package = volumic
        cls.elements = list(proxy_elements())

    def new_proxy(self, group, name):
        manager = servermanager.ProxyManager().SMProxyManager
        proxy = manager.NewProxy(group, name)
        self.assertIsNotNone(proxy, f"{group}/{name} is not in the plugin")
        proxy.UpdateVTKObjects()
        return proxy

    def test_there_are_proxies(self):
        self.assertIn("ImagePyramid", [element.get("name") for _, element in self.elements])

    def test_values_agree(self):
        compared = 0
        for group, element in self.elements:
            proxy = self.new_proxy(group, element.get("name"))
            # A second object, which the proxy has not touched.
            fresh = proxy.GetClientSideObject().NewInstance()
            for property_ in element.iter():
                command = property_.get("command", "")
                if property_.tag not in VALUE_ELEMENTS or not command.startswith("Set"):
                    continue
                name = property_.get("name")
                if name in FROM_DATA:
                    continue
                with self.subTest(proxy=element.get("name"), property=name):
                    expected = getattr(fresh, "Get" + command[3:])()
                    # Not through the Python proxy, which gives an enumeration's text.
                    self.assertEqual(proxy.GetProperty(name).GetElement(0), expected)
                    compared += 1
        self.assertGreaterEqual(compared, 4)

    def test_values_reach_the_object(self):
        """Client-server wrapping drops a setter that it doesn't understand, without a word."""
        for group, element in self.elements:
            proxy = self.new_proxy(group, element.get("name"))
            for property_ in element.iter():
                command = property_.get("command", "")
                if property_.tag not in VALUE_ELEMENTS or not command.startswith("Set"):
                    continue
                name = property_.get("name")
                with self.subTest(proxy=element.get("name"), property=name):
                    held = proxy.GetProperty(name)
                    other = self.another_value(held.GetElement(0), property_)
                    held.SetElement(0, other)
                    proxy.UpdateVTKObjects()
                    value = getattr(proxy.GetClientSideObject(), "Get" + command[3:])()
                    self.assertEqual(value, other)

    @staticmethod
    def another_value(value, element):
        if element.find("BooleanDomain") is not None:
            return 1 - value
        if element.tag == "IntVectorProperty":
            return value + 1
        return value * 0.9 if value else 0.5

    def test_every_property_is_documented(self):
        for group, element in self.elements:
            for property_ in element.iter():
                if property_.tag.endswith("Property") and property_.get("command"):
                    with self.subTest(proxy=element.get("name"), property=property_.get("name")):
                        text = property_.findtext("Documentation", "").strip()
                        self.assertGreater(len(text), 20)
                        self.assertTrue(text.endswith("."))

    def test_filters_are_in_their_menu(self):
        for group, element in self.elements:
            if group == "filters":
                with self.subTest(proxy=element.get("name")):
                    entry = element.find("Hints/ShowInMenu")
                    self.assertEqual(entry.get("category"), "Volumic")


testing.main()
