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
readers = [proxy.GetXMLName() for proxy in simple.GetSources().values()]
print("Readers:", sorted(readers))
"""


# ParaView asks which of the readers for the file it is to take.
DIALOG = f"{gui.WINDOW}/pqSelectReaderDialog"
def choose(row):
    """In the order of the labels Volumic's is behind ParaView's own, of DICOM two."""
    return [gui.event(f"{DIALOG}/listWidget", "mousePress", f"1,1,0,20,9,/{row}:0"),
            gui.event(f"{DIALOG}/listWidget", "mouseRelease", f"1,0,0,20,9,/{row}:0"),
            gui.event(f"{DIALOG}/okButton", "activate"), gui.pause(1000)]


class VolumeReaderWindowTest(window.WindowTestCase):
    def readers(self):
        return re.findall(r"Readers: (\[.*\])", self.session.output)

    def test_a_packed_nifti(self):
        told = self.session.add_code(TELL)
        # Values that are no labels.
        self.play([*opened(files.nifti("ramp.nii.gz", files.ramp())), told,
                   filter_of_the_menu("VolumeToSurface"), APPLY], "reader-nifti")
        self.assertEqual(self.readers(), ["['VolumicVolumeReader']"])

    def test_segments_have_their_names(self):
        told = self.session.add_code(TELL)
        self.play([*opened(files.segmentation(), choose(1)), told,
                   filter_of_the_menu("LabelsToSurfaces"),
                   gui.check(f"{PROPERTIES}/Labels/Note", "text", "3 of 4 labels"), APPLY],
                  "reader-segments")
        self.assertEqual(self.readers(), ["['VolumicVolumeReader']"])

    def test_a_slice_of_dicom_opens_its_series(self):
        told = self.session.add_code(TELL + """
image = list(simple.GetSources().values())[0]
image.UpdatePipeline()
print("Size:", image.GetDataInformation().GetExtent())
""")
        self.play([*opened(os.path.join(files.dicom(), "003.dcm"), choose(2)), told],
                  "reader-dicom")
        self.assertEqual(self.readers(), ["['VolumicDICOMReader']"])
        x, y, z = files.voxels().shape[::-1]
        self.assertIn(f"Size: {(0, x - 1, 0, y - 1, 0, z - 1)}", self.session.output)
