# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The choice of an array and of its component in ParaView's window."""

import gui_session as gui
import plugin_testing as testing
import window_testing as window
from paraview import simple
from window_testing import APPLY, ISO_VALUE, PROPERTIES, choose, filter_of_the_menu

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
    """What the panel says of the first array, and of the magnitude and of Y of the second."""
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


class InputsWindowTest(window.WindowTestCase):

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
                    # The preset follows, as nobody has typed another value.
                    gui.check(ISO_VALUE, "text", of_magnitude),
                    choose("SelectedComponent", "Y"), gui.pause(300),
                    gui.check(ISO_VALUE, "text", of_y), APPLY, *save],
                    f"component-{filter_}", python=VECTOR)
                made = window.open_state(path, f"{filter_.replace('To', 'to')}1")
                made.UpdatePipeline()
                self.assertEqual(made.SelectedComponent, "Y")
                self.assertGreater(made.GetDataInformation().GetNumberOfPoints(), 500)
