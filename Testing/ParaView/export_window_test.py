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
CLIP = """
from paraview import simple
clip = simple.Clip(simple.GetActiveSource(), ClipType="Plane", Scalars=["POINTS", ""])
clip.ClipType.Origin, clip.ClipType.Normal = (14, 16, 16), (1, 0, 0)
simple.Show(clip)
simple.SetActiveSource(clip)
simple.Render()
"""
WRITTEN = "import os\nuntil(lambda: len(os.listdir({folder!r})) >= {count})"
ENTRY = f"{gui.WINDOW}/menubar/menu_File"


class ExportWindowTest(window.WindowTestCase):
    def test_what_is_shown_of_the_labels(self):
        folder = testing.output_path("window-exported")
        shutil.rmtree(folder, ignore_errors=True)
        os.mkdir(folder)
        path = testing.write_volume("export.vti", label_maps.add_names(label_maps.image()))
        hide = self.session.add_code(HIDE)
        half = os.path.join(folder, "half")
        os.mkdir(half)
        self.play(opened(path) + [
            filter_of_the_menu("LabelsToSurfaces"), APPLY, hide,
            *self.exported(os.path.join(folder, "organs.stl"), 3),
            self.session.add_code(CLIP), gui.pause(1000),
            *self.exported(os.path.join(half, "half.stl"), 2)], "export-labels")
        self.assertEqual(sorted(os.listdir(folder)),
                         ["half", "organs-liver.stl", "organs-spleen.stl"])
        self.assertEqual(sorted(os.listdir(half)), ["half-liver.stl", "half-spleen.stl"])

    def exported(self, file, count):
        """Events that export to the file, till there are so many in its folder."""
        return [gui.event(ENTRY, "activate", "actionExportSurfaces"),
                gui.event(f"{gui.WINDOW}/ExportSurfacesDialog", "filesSelected", file),
                self.session.add_code(WRITTEN.format(folder=os.path.dirname(file), count=count))]
