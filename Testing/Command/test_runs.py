# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Complete runs of the command, also used by Testing/sanitize.sh, without Volumic's Python
package."""

import os
import unittest

import numpy as np
from vtkmodules.vtkIOXML import vtkXMLImageDataWriter

from command_test_case import ISO, CommandTestCase, ball, make_image


class RunsTest(CommandTestCase):
    def test_labels(self):
        """Two halves of a ball, separately and merged."""
        labels = np.where(ball() > ISO, 3, 0)
        labels[:, :, 8:] *= 2
        volume = self.write(vtkXMLImageDataWriter(), "map.vti", make_image(labels.astype("u1")))
        self.run_command(volume, self.path("each/"), "--labels", "all")
        self.assertEqual(sorted(os.listdir(self.path("each"))), ["label-3.vtp", "label-6.vtp"])
        self.run_command(volume, self.path("merged.vtp"), "--labels", "all", "--merge")
        self.assertIn(b'"Label"', self.content("merged.vtp"))


if __name__ == "__main__":
    unittest.main()
