# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Make the pictures of ParaView's window in the documents.

    VOLUMIC_PLUGIN=.../Volumic.so VOLUMIC_PARAVIEW_BIN=.../bin VOLUMIC_XVFB=/usr/bin/Xvfb \\
      pvpython readme_pictures.py VOLUME ISO_VALUE LABEL_MAP FOLDER [X,Y ...]

VOLUME is a file that ParaView opens, such as skull.vti of the quickstart. LABEL_MAP is a label map with
names, such as Debian's atlas of the brain:
`volumic /usr/share/mricron/templates/aal.nii.gz --write-volume aal.vti`. X,Y are positions on the screen
where seeds are picked on the middle slice, such as 733,598 645,480 for the skull.
"""

import os
import sys
import time

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import gui_session as gui
import plugin_testing as testing
import x_input
from window_testing import (
    APPLY, FROM_THE_FRONT, choose, filter_of_the_menu,
    open_menu_of_volumic, opened, set_iso_value)

CAMERA = f"{gui.WINDOW}/cameraToolbar"
MACRO = os.path.abspath(os.path.join(os.path.dirname(os.path.abspath(__file__)),
                                     "../../Examples/ParaView/compare_levels.py"))


def on_a_slice(volume, iso_value):
    """Return the events up to the pick of seeds, with their list visible."""
    representation = f"{gui.WINDOW}/representationToolbar/displayRepresentation/comboBox"
    return opened(volume) + [
        gui.event(representation, "set_string", "Slice"), gui.pause(1500),
        filter_of_the_menu("VolumeToSurface"), gui.pause(500),
        set_iso_value(iso_value), choose("Initialization", "Seeds"), gui.pause(500),
        gui.event(f"{gui.PANEL}/scrollArea/qt_scrollarea_vcontainer/1QScrollBar0", "set_int",
                  "250"), gui.pause(500)]


def pick(session, positions):
    hand = x_input.Input(session.display)
    for position in positions:
        hand.move(*map(int, position.split(",")))
        hand.focus()
        hand.key("p")
        time.sleep(1)


def main(volume, iso_value, label_map, folder, *seeds):
    session = gui.Session(testing.program("paraview"), testing.plugin_path(),
                          os.environ["VOLUMIC_XVFB"], size=(1180, 800), plain=True)
    start = opened(volume)
    macro = f"""
from paraview import simple
volume = simple.OpenDataFile({volume!r})
volume.UpdatePipeline()
surface = simple.VolumetoSurface(volume, IsoValue={iso_value})
simple.SetActiveSource(surface)
exec(compile(open({MACRO!r}).read(), "macro", "exec"), {{"__name__": "__main__"}})
"""
    pictures = {
        # Step two: the menu.
        "paraview-menu.png": ("", start + open_menu_of_volumic() + [gui.pause(1500)]),
        # Step four: the surface.
        "paraview-volume-to-surface.png": ("", start + [
            filter_of_the_menu("VolumeToSurface"), set_iso_value(iso_value), APPLY,
            gui.pause(1000), *FROM_THE_FRONT]),
        "paraview-seeds.png": ("", on_a_slice(volume, iso_value)),
        "paraview-labels.png": ("", opened(label_map) + [
            filter_of_the_menu("LabelsToSurfaces"), gui.pause(500), APPLY, gui.pause(1000),
            gui.event(f"{CAMERA}/actionNegativeX", "activate"), gui.pause(1000),
            gui.event(f"{CAMERA}/actionZoomToData", "activate"), gui.pause(1500)]),
        # The macro.
        "paraview-levels.png": (macro, [gui.pause(1000), *FROM_THE_FRONT]),
    }
    for name, (python, events) in pictures.items():
        succeeded = session.play(events, python=python)
        if "seeds" in name:
            pick(session, seeds)
        session.screenshot(os.path.join(folder, name))
        if not succeeded:
            sys.exit(session.output)
        print(f"Written: {os.path.join(folder, name)}")
    session.close()


main(*sys.argv[1:])
