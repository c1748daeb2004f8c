# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""File > Open of volumes in ParaView's window, by the readers of Volumic."""

import os
import re

import gui_session as gui
import volume_reader_test as files
import window_testing as window
from window_testing import APPLY, PROPERTIES, filter_of_the_menu, opened

TELL = """
from paraview import simple
reader = simple.GetActiveSource()
print("Reader:", reader.GetXMLName(), reader.GetDataInformation().GetExtent())
"""
# ParaView asks which of the readers for the file it is to take.
DIALOG = f"{gui.WINDOW}/pqSelectReaderDialog"


def choose(row):
    """In the order of the labels Volumic's is behind ParaView's own, of DICOM two."""
    return [gui.event(f"{DIALOG}/listWidget", "mousePress", f"1,1,0,20,9,/{row}:0"),
            gui.event(f"{DIALOG}/listWidget", "mouseRelease", f"1,0,0,20,9,/{row}:0"),
            gui.event(f"{DIALOG}/okButton", "activate"), gui.pause(1000)]


class VolumeReaderWindowTest(window.WindowTestCase):
    def test_files_of_each_kind(self):
        told = self.session.add_code(TELL)
        self.play([
            # Values that are no labels, which only Volumic reads.
            *opened(files.nifti("ramp.nii.gz", files.ramp())), told,
            filter_of_the_menu("VolumeToSurface"), APPLY,
            # Segments have their names.
            *opened(files.segmentation(), choose(1)), told, filter_of_the_menu("LabelsToSurfaces"),
            gui.check(f"{PROPERTIES}/Labels/Note", "text", "3 of 4 labels"), APPLY,
            # A slice opens its series.
            *opened(os.path.join(files.dicom(), "003.dcm"), choose(2)), told], "readers")
        size = tuple(bound for n in files.voxels().shape[::-1] for bound in (0, n - 1))
        found = re.findall(r"Reader: (\w+) (.*)", self.session.output)
        self.assertEqual([name for name, _ in found],
                         ["VolumicVolumeReader", "VolumicVolumeReader", "VolumicDICOMReader"])
        self.assertEqual(found[2][1], str(size))
