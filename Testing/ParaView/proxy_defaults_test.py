# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The defaults of all properties in the XML of the plugin are those of the C++ classes."""

import glob
import os
import unittest
import xml.etree.ElementTree as ElementTree

from paraview import servermanager, simple

import plugin_testing as testing

PLUGIN_SOURCES = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../Plugin/*.xml")
FILTER_GROUPS = ("filters", "internal_filters")

# Properties that are preset from the data, so that the default of the class differs.
FROM_DATA = {"IsoValue", "UpperValue", "UseUpperValue"}


def proxy_elements():
    """Yield (group, element) of all filters in the XML of the plugin."""
    for path in glob.glob(PLUGIN_SOURCES):
        for group in ElementTree.parse(path).getroot().iter("ProxyGroup"):
            for element in group:
                if group.get("name") in FILTER_GROUPS:
                    yield group.get("name"), element


def properties_of(proxy):
    """Yield (name, property) of a proxy, with inherited ones."""
    iterator = proxy.NewPropertyIterator()
    iterator.Begin()
    while not iterator.IsAtEnd():
        yield iterator.GetKey(), iterator.GetProperty()
        iterator.Next()


def values_of(proxy):
    """Yield (name, property, setter) of properties with a number."""
    for name, property_ in properties_of(proxy):
        command = property_.GetCommand() or ""
        if property_.IsA("vtkSMVectorProperty") and command.startswith("Set") \
                and not property_.IsA("vtkSMStringVectorProperty") \
                and not property_.GetInformationOnly() and not property_.GetRepeatable():
            yield name, property_, command


class ProxyDefaultsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        testing.load_plugin()
        cls.package = testing.load_package()
        cls.elements = list(proxy_elements())

    def new_proxy(self, group, name):
        manager = servermanager.ProxyManager().SMProxyManager
        proxy = manager.NewProxy(group, name)
        self.assertIsNotNone(proxy, f"{group}/{name} is not in the plugin")
        proxy.UpdateVTKObjects()
        return proxy

    def test_defaults_of_properties(self):
        compared = set()
        for group, element in self.elements:
            proxy = self.new_proxy(group, element.get("name"))
            # An object without changes by the proxy.
            fresh = proxy.GetClientSideObject().NewInstance()
            for name, held, command in values_of(proxy):
                if name in FROM_DATA:
                    continue
                with self.subTest(proxy=element.get("name"), property=name):
                    expected = getattr(fresh, "Get" + command[3:])()
                    # Not by the Python proxy, which returns the text of an enumeration.
                    self.assertEqual(held.GetElement(0), expected)
                    compared.add((element.get("name"), name))
        # Inherited properties, too.
        for name in ("Friction", "SnapshotInterval", "FinestLevel", "ReductionFactor", "Recovery",
                     "MinimumPartSize", "KeepComponents", "MinimumComponentVolume",
                     "PointAttractionWeight", "EdgeAttractionWeight"):
            self.assertIn(("VolumeToSurface", name), compared)
        self.assertGreater(len(compared), 50)

    def test_every_setter_of_the_class_has_its_property(self):
        for group, element in self.elements:
            proxy = self.new_proxy(group, element.get("name"))
            offered = {property_.GetCommand() for _, property_ in properties_of(proxy)}
            class_ = type(proxy.GetClientSideObject())
            # Setters with a getter in classes of the plugin.
            for base in class_.__mro__:
                if not base.__module__.startswith("volumic"):
                    continue
                for setter in (name for name in vars(base) if name.startswith("Set")):
                    if hasattr(class_, "Get" + setter[3:]):
                        with self.subTest(proxy=element.get("name"), setter=setter):
                            self.assertIn(setter, offered)

    def test_values_reach_the_object(self):
        """Client-server wrapping silently skips unsupported setters."""
        for group, element in self.elements:
            proxy = self.new_proxy(group, element.get("name"))
            for name, held, command in values_of(proxy):
                with self.subTest(proxy=element.get("name"), property=name):
                    other = self.another_value(held)
                    held.SetElement(0, other)
                    proxy.UpdateVTKObjects()
                    value = getattr(proxy.GetClientSideObject(), "Get" + command[3:])()
                    self.assertEqual(value, other)

    @staticmethod
    def another_value(property_):
        value = property_.GetElement(0)
        if property_.FindDomain("vtkSMBooleanDomain"):
            return 1 - value
        if property_.IsA("vtkSMIntVectorProperty"):
            return value + 1
        return value * 0.9 if value else 0.5

    def test_panels_are_short(self):
        """Number of rows without and with advanced properties, for default values."""
        rows = {}
        for name in ("VolumeToSurface", "LabelsToSurfaces"):
            shown = [property_.GetPanelVisibility()
                     for key, property_ in properties_of(self.new_proxy("filters", name))
                     if not property_.IsA("vtkSMInputProperty") and key != "Result"
                     and not self.is_hidden_at_first(property_)]
            rows[name] = shown.count("default"), len(shown) - shown.count("never")
        self.assertEqual(rows, {"VolumeToSurface": (7, 24), "LabelsToSurfaces": (6, 17)})

    @staticmethod
    def is_hidden_at_first(property_):
        hints = property_.GetHints()
        return hints is not None and any(
            hints.GetNestedElement(i).GetAttribute("mode") == "visibility"
            or hints.GetNestedElement(i).FindNestedElementByName("Expression") is not None
            and hints.GetNestedElement(i).GetNestedElement(0).GetNestedElement(0)
            .GetAttribute("mode") == "visibility"
            for i in range(hints.GetNumberOfNestedElements()))

    def test_tooltips_are_short(self):
        """At most 30 words in the documentation of a property."""
        long = {(element.get("name"), key): words
                for group, element in self.elements
                for key, property_ in properties_of(self.new_proxy(group, element.get("name")))
                if property_.GetDocumentation()
                for words in [len(property_.GetDocumentation().GetDescription().split())]
                if words > 30}
        self.assertEqual(long, {})

    def test_enumerations(self):
        chosen = set()
        for group, element in self.elements:
            proxy = self.new_proxy(group, element.get("name"))
            class_ = type(proxy.GetClientSideObject())
            for name, held, command in values_of(proxy):
                kind = getattr(class_, command[3:] + "Type", None)
                if kind is None:
                    continue
                with self.subTest(proxy=element.get("name"), property=name):
                    constants = [getattr(class_, constant) for constant in dir(class_)]
                    choices = {int(value) for value in constants if type(value) is kind}
                    domain = held.FindDomain("vtkSMEnumerationDomain")
                    entries = range(domain.GetNumberOfEntries())
                    self.assertEqual({domain.GetEntryValue(i) for i in entries}, choices)
                    self.assertGreater(len(choices), 1)
                    chosen.add(name)
        self.assertEqual(chosen, {"BorderValue", "BoxFaces", "Initialization", "KeepComponents",
                                  "Metric", "Recovery"})

    def test_arrays_of_given_input(self):
        """Not of the active source, which paraview.simple connects first."""
        volume = simple.Wavelet()
        active = simple.Elevation(simple.Sphere())
        active.UpdatePipeline()
        for name in ("DeformableSurface", "ImagePyramid", "LabelstoSurfaces", "VolumetoSurface"):
            simple.SetActiveSource(active)
            filter_ = getattr(simple, name)(Input=volume)
            for property_ in ("SetInputArrayToProcess", "EdgeMap"):
                held = filter_.SMProxy.GetProperty(property_)
                with self.subTest(filter=name, property=property_):
                    self.assertEqual(held.GetElement(4) if held else "RTData", "RTData")
        testing.delete_sources()

    def set_list(self, proxy, name, values):
        held = proxy.GetProperty(name)
        held.SetNumberOfElements(len(values))
        for i, value in enumerate(values):
            held.SetElement(i, value)
        proxy.UpdateVTKObjects()

    def test_lists_of_positions_reach_the_object(self):
        for name in ("DeformableSurface", "VolumeToSurface"):
            proxy = self.new_proxy("filters", name)
            object_ = proxy.GetClientSideObject()
            for list_ in ("SeedPosition", "AttractingPosition"):
                for numbers in ([1.5, 2, -3, 4, 5, 6e9], [7, 8, 9], []):
                    with self.subTest(proxy=name, property=list_, numbers=numbers):
                        self.set_list(proxy, list_ + "s", numbers)
                        found = []
                        for i in range(getattr(object_, f"GetNumberOf{list_}s")()):
                            position = [0.0, 0.0, 0.0]
                            getattr(object_, f"Get{list_}")(i, position)
                            found += position
                        self.assertEqual(found, numbers)

    def test_the_scratch_directory_reaches_the_object(self):
        for name in ("DeformableSurface", "ImagePyramid", "VolumeToSurface"):
            proxy = self.new_proxy("filters", name)
            for folder in ("", "/some/folder"):
                self.set_list(proxy, "ScratchDirectory", [folder])
                self.assertEqual(proxy.GetClientSideObject().GetScratchDirectory(), folder)

    def test_lists_of_labels_reach_the_object(self):
        proxy = self.new_proxy("filters", "LabelsToSurfaces")
        object_ = proxy.GetClientSideObject()
        for labels in ([3, -1, 70000], [5], []):
            self.set_list(proxy, "Labels", labels)
            found = {object_.GetLabel(i) for i in range(object_.GetNumberOfLabels())}
            self.assertEqual(found, set(labels))
        for given in (["3", "liver", "-1", "a b"], []):
            self.set_list(proxy, "LabelNames", given)
            found = [object_.GetLabelName(label) or "" for label in (3, -1)]
            self.assertEqual(found, given[1::2] or ["", ""])
