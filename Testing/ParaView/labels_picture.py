# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The documents' picture of Labels to Surfaces in ParaView's window.

    VOLUMIC_PLUGIN=.../Volumic.so VOLUMIC_PARAVIEW_BIN=.../bin VOLUMIC_XVFB=/usr/bin/Xvfb \\
      pvpython labels_picture.py LABEL_MAP FOLDER

LABEL_MAP is a file that ParaView opens, with names, such as Debian's atlas of the brain written anew:
`volumic /usr/share/mricron/templates/aal.nii.gz --write-volume aal.vti`.
"""

import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import gui_session as gui
import plugin_testing as testing
from window_testing import APPLY, filter_of_the_menu, opened


def main(label_map, folder):
    session = gui.Session(testing.program("paraview"), testing.plugin_path(),
                          os.environ["VOLUMIC_XVFB"], size=(1180, 800))
    camera = f"{gui.WINDOW}/cameraToolbar"
    succeeded = session.play([
        *opened(label_map), filter_of_the_menu("LabelsToSurfaces"), gui.pause(500), APPLY,
        gui.pause(1000), gui.event(f"{camera}/actionNegativeX", "activate"), gui.pause(1000),
        gui.event(f"{camera}/actionZoomToData", "activate"), gui.pause(1500)], timeout=600)
    path = os.path.join(folder, "paraview-labels.png")
    session.screenshot(path)
    if not succeeded:
        sys.exit(session.output)
    print(f"Written: {path}")
    session.close()


main(*sys.argv[1:])
