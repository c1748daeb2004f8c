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

HIDE_ADVANCED = SHOW_ADVANCED.replace('"true"', '"false"')
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


class SurfaceWindowTest(window.WindowTestCase):
    def test_menu_panel_and_apply(self):
        path, save = self.saved_state("pyramid-and-surface.pvsm")
        levels = f"{PROPERTIES}/NumberOfLevels/IntRangeWidget/LineEdit"
        of_pyramid = ("MinimumLevelSize", "ReductionFactor", "NumberOfThreads")
        self.play(source("RTAnalyticSource") + [
            filter_of_the_menu("ImagePyramid"),
            gui.check(f"{PROPERTIES}/SetInputArrayToProcess/ComboBox", "currentText", "RTData"),
            gui.check(levels, "text", "0"), *[window.shown(name, False) for name in of_pyramid],
            SHOW_ADVANCED, gui.pause(500), *[window.shown(name, True) for name in of_pyramid],
            gui.check(f"{PROPERTIES}/MinimumLevelSize/LineEdit0", "text", "10"),
            gui.check(f"{PROPERTIES}/MinimumLevelSize", "enabled", "true"),
            gui.event(levels, "set_string", "4"), APPLY,
            HIDE_ADVANCED, filter_of_the_menu("DeformableSurface"), gui.pause(500),
            gui.check(ISO_VALUE, "text", iso_of_the_wavelet()),
            window.value_range(*range_of_the_wavelet()), window.as_wide_as_the_panel(),
            *[window.shown(name, True) for name in BASIC],
            *[window.shown(name, False) for name in ADVANCED],
            # The reset button.
            set_iso_value(111), gui.pause(300),
            gui.event(f"{PROPERTIES}/IsoValue/Reset", "activate"), gui.pause(300),
            gui.check(ISO_VALUE, "text", iso_of_the_wavelet()),
            set_iso_value(150), APPLY, *save, SHOW_ADVANCED, gui.pause(500),
            *[window.shown(name, True) for name in BASIC + ADVANCED],
            gui.check(f"{PROPERTIES}/Initialization/ComboBox", "currentText", "Enclosing Box"),
            # Only for seeds.
            window.shown("SeedRadius", False),
            choose("Initialization", "Seeds"), gui.pause(300),
            window.shown("SeedRadius", True),
            # Only with edge attraction.
            window.shown("EdgeMap", False),
            gui.event(f"{PROPERTIES}/EdgeAttractionWeight/DoubleRangeWidget/DoubleLineEdit",
                      "set_string", "2"), gui.pause(300),
            window.shown("EdgeMap", True),
            gui.check(f"{PROPERTIES}/Recovery/ComboBox", "currentText", "Objects")], "surface-applied")
        state = window.proxies_of(path)
        # The window shows only the surface: no chart, levels or table.
        self.assertEqual(state.count("VolumicSurfaceRepresentation"), 1)
        for other in ("XYChartView", "VolumicLevelsRepresentation", "SpreadSheetView"):
            self.assertNotIn(other, state)
        filter_ = window.open_state(path, "DeformableSurface1")
        self.assertEqual(filter_.IsoValue, 150.0)
        self.assertEqual(testing.fetch(filter_.Input).GetNumberOfBlocks(), 4)
        self.assertEqual(testing.field(testing.fetch(filter_), "StopReason"), "converged")
        displays = [d for d in simple.GetRepresentations().values() if d.Input == filter_]
        self.assertTrue(any(d.Visibility for d in displays), "the surface is shown")

    def test_component(self):
        """inputs_test.py has the presets of components."""
        arrays = f"{PROPERTIES}/SetInputArrayToProcess/ComboBox"
        self.play([
            gui.pause(300), filter_of_the_menu("VolumeToSurface"), gui.pause(300),
            gui.check(arrays, "currentText", "RTData"), window.shown("SelectedComponent", False),
            gui.event(arrays, "set_string", "vector"), gui.pause(300),
            window.shown("SelectedComponent", True),
            gui.check(f"{PROPERTIES}/SelectedComponent/ComboBox", "currentText", "Magnitude"),
            choose("SelectedComponent", "Y"), gui.pause(300),
            window.value_range(*(4 * value for value in range_of_the_wavelet()))], "component",
            python=VECTOR)
