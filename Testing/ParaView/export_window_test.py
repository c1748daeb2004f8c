# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""File > Export Surfaces... in ParaView's window: what is shown of the labels, a file each."""

import os
import shutil

import gui_session as gui
import label_maps
import plugin_testing as testing
import window_testing as window
from window_testing import APPLY, filter_of_the_menu, opened

HIDE = """
from paraview import simple
display = simple.GetDisplayProperties(simple.GetActiveSource(), simple.GetActiveView())
display.BlockSelectors = ["/Root/*[@label='liver']", "/Root/*[@label='spleen']"]
simple.Render()
"""
WRITTEN = "import os\nuntil(lambda: len(os.listdir({folder!r})) > 1)"
ENTRY = f"{gui.WINDOW}/menubar/menu_File"


class ExportWindowTest(window.WindowTestCase):
    def test_what_is_shown_of_the_labels(self):
        folder = testing.output_path("window-exported")
        shutil.rmtree(folder, ignore_errors=True)
        os.mkdir(folder)
        path = testing.write_volume("export.vti", label_maps.add_names(label_maps.image()))
        hide = self.session.add_code(HIDE)
        self.play(opened(path) + [
            filter_of_the_menu("LabelsToSurfaces"), APPLY, hide,
            gui.event(ENTRY, "activate", "actionExportSurfaces"),
            gui.event(f"{gui.WINDOW}/ExportSurfacesDialog", "filesSelected",
                      os.path.join(folder, "organs.stl")),
            self.session.add_code(WRITTEN.format(folder=folder))], "export-labels")
        self.assertEqual(sorted(os.listdir(folder)), ["organs-liver.stl", "organs-spleen.stl"])
