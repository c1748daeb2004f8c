# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Image Pyramid and Deformable Surface in ParaView's window, by menu and panel."""

import gui_session as gui
import plugin_testing as testing
import window_testing as window
from paraview import simple
from window_testing import (
    APPLY, ISO_VALUE, PROPERTIES, SHOW_ADVANCED, choose, filter_of_the_menu, iso_of_the_wavelet,
    range_of_the_wavelet, set_iso_value, source)

VOLUME = source("RTAnalyticSource")
SURFACE = filter_of_the_menu("DeformableSurface")
BASIC = ("SetInputArrayToProcess", "IsoValue", "UseUpperValue", "Preview", "KeepComponents",
         "Initialization", "EdgeLength", "Result")
ADVANCED = ("ObjectIsBright", "CoarsestLevel", "FinestLevel", "Recovery", "Tolerance", "ThinParts",
            "SamplingRatio", "TensionWeight", "ElasticityWeight", "IsopotentialWeight",
            "GradientWeight", "PointAttractionWeight", "EdgeAttractionWeight", "Friction",
            "BorderValue", "TopologyChanges", "SnapToIsoValue", "AttractingPositions",
            "MaximumNumberOfIterations", "ConvergenceTolerance", "NumberOfThreads", "TimeLimit",
            "ScratchDirectory", "SnapshotInterval")


# Runs in the window: an image whose second array has several components.
VECTOR = """
from paraview import simple
vector = simple.Calculator(simple.Wavelet())
vector.ResultArrayName = "vector"
vector.Function = "3*RTData*iHat + 4*RTData*jHat"
simple.Show(vector)
simple.SetActiveSource(vector)
"""


def iso_values():
    """Return the preset of the first array, and of the magnitude and Y of the second."""
    testing.load_plugin()
    played = {}
    exec(compile(VECTOR, "vector", "exec"), played)
    filter_ = simple.VolumetoSurface(played["vector"])
    values = [filter_.IsoValue]
    filter_.Voxels = ["POINTS", "vector"]
    for component in ("Magnitude", "Y"):
        filter_.SelectedComponent = component
        values.append(filter_.IsoValue)
    return [repr(value) for value in values]


class PyramidWindowTest(window.WindowTestCase):
    def test_menu_panel_and_apply(self):
        path, save = self.saved_state("pyramid.pvsm")
        levels = f"{PROPERTIES}/NumberOfLevels/IntRangeWidget/LineEdit"
        advanced = ("MinimumLevelSize", "ReductionFactor", "NumberOfThreads")
        pixels = self.play(source("RTAnalyticSource") + [
            filter_of_the_menu("ImagePyramid"),
            gui.check(f"{PROPERTIES}/SetInputArrayToProcess/ComboBox", "currentText", "RTData"),
            gui.check(levels, "text", "0"), *[window.shown(name, False) for name in advanced],
            SHOW_ADVANCED, gui.pause(500), *[window.shown(name, True) for name in advanced],
            gui.check(f"{PROPERTIES}/MinimumLevelSize/LineEdit0", "text", "10"),
            gui.check(f"{PROPERTIES}/MinimumLevelSize", "enabled", "true"),
            gui.event(levels, "set_string", "3"), APPLY, *save], "pyramid-applied")
        self.assertGreater(pixels.std(), 10, "the window is drawn")
        self.assertIn("ImagePyramid", window.proxies_of(path))
        # The saved state gives the same output in a script.
        pyramid = testing.fetch(window.open_state(path, "ImagePyramid1"))
        self.assertEqual(pyramid.GetNumberOfBlocks(), 3)
        self.assertEqual(pyramid.GetBlock(2).GetDimensions(), (6, 6, 6))


class SurfaceWindowTest(window.WindowTestCase):
    def test_menu_panel_and_apply(self):
        path, save = self.saved_state("surface.pvsm")
        self.play(VOLUME + [
            SURFACE, gui.pause(300),
            gui.check(f"{PROPERTIES}/SetInputArrayToProcess/ComboBox", "currentText", "RTData"),
            gui.check(ISO_VALUE, "text", iso_of_the_wavelet()),
            *[window.shown(name, True) for name in BASIC],
            *[window.shown(name, False) for name in ADVANCED],
            window.as_wide_as_the_panel(), window.value_range(*range_of_the_wavelet()),
            # The reset button.
            set_iso_value(111), gui.pause(300),
            gui.event(f"{PROPERTIES}/IsoValue/Reset", "activate"), gui.pause(300),
            gui.check(ISO_VALUE, "text", iso_of_the_wavelet()),
            set_iso_value(150), APPLY, *save], "surface-applied")
        state = window.proxies_of(path)
        self.assertIn("DeformableSurface", state)
        # The window shows only the surface: no chart, levels or table.
        self.assertEqual(state.count("VolumicSurfaceRepresentation"), 1)
        for other in ("XYChartView", "VolumicLevelsRepresentation", "SpreadSheetView"):
            self.assertNotIn(other, state)

        filter_ = window.open_state(path, "DeformableSurface1")
        self.assertEqual(filter_.IsoValue, 150.0)
        self.assertEqual(testing.field(testing.fetch(filter_), "StopReason"), "converged")
        displays = [d for d in simple.GetRepresentations().values() if d.Input == filter_]
        self.assertTrue(any(d.Visibility for d in displays), "the surface is shown")

    def test_advanced_panel_after_image_pyramid(self):
        path, save = self.saved_state("pyramid-and-surface.pvsm")
        self.play(VOLUME + [
            filter_of_the_menu("ImagePyramid"),
            gui.event(f"{PROPERTIES}/NumberOfLevels/IntRangeWidget/LineEdit", "set_string", "4"),
            APPLY, SURFACE, SHOW_ADVANCED, gui.pause(500),
            *[window.shown(name, True) for name in BASIC + ADVANCED],
            gui.check(f"{PROPERTIES}/Initialization/ComboBox", "currentText", "Enclosing Box"),
            window.value_range(*range_of_the_wavelet()),
            gui.check(ISO_VALUE, "text", iso_of_the_wavelet()), APPLY, *save,
            # Only for seeds.
            window.shown("SeedRadius", False),
            choose("Initialization", "Seeds"), gui.pause(300),
            window.shown("SeedRadius", True),
            # Only with edge attraction.
            window.shown("EdgeMap", False),
            gui.event(f"{PROPERTIES}/EdgeAttractionWeight/DoubleRangeWidget/DoubleLineEdit",
                      "set_string", "2"), gui.pause(300),
            window.shown("EdgeMap", True),
            gui.check(f"{PROPERTIES}/Recovery/ComboBox", "currentText", "Objects"),
            # Only for components of that volume.
            window.shown("MinimumComponentVolume", False),
            choose("KeepComponents", "Large Ones"), gui.pause(300),
            window.shown("MinimumComponentVolume", True)], "surface-advanced")
        filter_ = window.open_state(path, "DeformableSurface1")
        self.assertEqual(filter_.Input.GetXMLName(), "ImagePyramid")
        self.assertGreater(testing.fetch(filter_).GetNumberOfCells(), 0)

    def test_component(self):
        of_scalar, of_magnitude, of_y = iso_values()
        self.assertEqual(len({of_scalar, of_magnitude, of_y}), 3)
        arrays = f"{PROPERTIES}/SetInputArrayToProcess/ComboBox"
        for filter_ in ("VolumeToSurface", "DeformableSurface"):
            with self.subTest(filter=filter_):
                path, save = self.saved_state("component.pvsm")
                self.play([
                    gui.pause(300), filter_of_the_menu(filter_), gui.pause(300),
                    gui.check(arrays, "currentText", "RTData"),
                    window.shown("SelectedComponent", False),
                    gui.check(ISO_VALUE, "text", of_scalar),
                    gui.event(arrays, "set_string", "vector"), gui.pause(300),
                    window.shown("SelectedComponent", True),
                    gui.check(f"{PROPERTIES}/SelectedComponent/ComboBox", "currentText",
                              "Magnitude"),
                    # The preset follows until the user types a value.
                    gui.check(ISO_VALUE, "text", of_magnitude),
                    choose("SelectedComponent", "Y"), gui.pause(300),
                    gui.check(ISO_VALUE, "text", of_y), APPLY, *save],
                    f"component-{filter_}", python=VECTOR)
                made = window.open_state(path, f"{filter_.replace('To', 'to')}1")
                made.UpdatePipeline()
                self.assertEqual(made.SelectedComponent, "Y")
                self.assertGreater(made.GetDataInformation().GetNumberOfPoints(), 500)
