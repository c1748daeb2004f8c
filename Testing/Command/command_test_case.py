# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Common base of the tests of the installed command, whose path is VOLUMIC_PROGRAM."""

import json
import os
import re
import resource
import signal
import subprocess
import sys
import time

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkIOXML import vtkXMLImageDataWriter

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "Python"))
# pylint: disable=wrong-import-position
import medical_files
from folder_test_case import FolderTestCase

PROGRAM = os.environ["VOLUMIC_PROGRAM"]

SIZE = np.array([26, 22, 18])  # voxels along x, y, z
SPACING, ORIGIN = np.array([0.5, 0.75, 1.0]), np.array([-7.0, 8.0, 9.5])
# Rotation by 90 degrees about z: index x is world y, index y is world -x.
TURNED = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
CENTRE, RADIUS = np.array([8.3, 12.6, 7.8]), 4.0  # of the ball; index space, world lengths
ISO = 500.5
PATIENCE = 600  # seconds


def ball(dtype="i2", scale=1):
    """Return voxels [z, y, x] of a ball with the iso-value ISO at its surface. Its centre is off
    the middle, so that it is not symmetric."""
    z, y, x = np.mgrid[0:SIZE[2], 0:SIZE[1], 0:SIZE[0]]
    distance = np.sqrt(sum((s * (n - c)) ** 2 for s, n, c in zip(SPACING, (x, y, z), CENTRE)))
    values = np.clip(ISO + 100 * (RADIUS - distance), 0, 1000)
    return np.round(values * scale).astype(dtype)


META = medical_files.meta_header(ball(), SPACING, ORIGIN, "1 0 0 0 1 0 0 0 1")  # of the ball


def nrrd_header(encoding="raw", endian="little", direction=np.eye(3)):
    """Return a header for the ball, without the empty line at its end."""
    return medical_files.nrrd_header(ball(), SPACING, ORIGIN, direction, encoding, endian)


def dicom_slice(k, voxels=None, direction=np.eye(3), **changes):
    """Return a DICOM file of a slice of the ball or of other voxels [z, y, x]."""
    pixels = (ball() if voxels is None else voxels)[k]
    return medical_files.dicom_slice(pixels, k, SPACING, ORIGIN, direction, **changes)


def make_image(voxels, spacing=SPACING, origin=ORIGIN, direction=np.eye(3)):
    scalars = numpy_to_vtk(np.ascontiguousarray(voxels).ravel(), deep=True)
    scalars.SetName("density")
    image = vtkImageData()
    image.SetDimensions(voxels.shape[::-1])
    image.SetSpacing(spacing)
    image.SetOrigin(origin)
    image.SetDirectionMatrix(np.ravel(direction))
    image.GetPointData().SetScalars(scalars)
    return image


def largest_file(size):
    """Return a preexec_fn of subprocess that limits the file size, to simulate a full disk."""
    def limit():
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))
    return limit


class CommandTestCase(FolderTestCase):
    def ball_file(self):
        return self.write(vtkXMLImageDataWriter(), "ball.vti", make_image(ball()))

    def run_command(self, *arguments, status=0, **options):
        """Return the completed process. Fail unless it ends with this status (None: any)."""
        process = subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True,
                                 timeout=PATIENCE, check=False, **options)
        if status is not None:
            self.assertEqual(process.returncode, status, process.stdout + process.stderr)
        return process

    def interrupted(self, pattern, *arguments, signals=(signal.SIGINT,)):
        """Return the messages after Ctrl-C or these signals, sent when a line matches the pattern.
        Repeat runs that end earlier."""
        command = [PROGRAM, *map(str, arguments), "--progress"]
        for _ in range(20):
            with subprocess.Popen(command, stderr=subprocess.PIPE, text=True) as process:
                for line in process.stderr:
                    if re.match(pattern, line):
                        break
                for number in signals:
                    process.send_signal(number)
                    time.sleep(0.02)
                output = process.stderr.read()
            if process.returncode != 0:
                self.assertEqual(process.returncode, 3, output)
                return output
        self.fail("All runs were too quick to be interrupted")
        return ""

    def many_labels(self, count):
        """Return a file with `count` balls along each axis, each with its own label."""
        z, y, x = np.mgrid[0:15 * count, 0:15 * count, 0:15 * count]
        voxels = 1 + (x // 15) + count * (y // 15) + count ** 2 * (z // 15)
        voxels[((x % 15 - 7) ** 2 + (y % 15 - 7) ** 2 + (z % 15 - 7) ** 2) > 50] = 0
        return self.write(vtkXMLImageDataWriter(), "many.vti",
                          make_image(voxels.astype("u1"), (1, 1, 1)))

    def report(self, *arguments, status=0):
        """Return the parsed report of a run."""
        return json.loads(self.run_command(*arguments, "--report", "-", status=status).stdout)

    def rejects(self, reason, *arguments, status=1, **options):
        """Check that the command ends with this status and one line that matches."""
        process = self.run_command(*arguments, status=status, **options)
        self.assertRegex(process.stderr, reason)
        self.assertRegex(process.stderr.strip().splitlines()[-1 if status == 1 else 0], "^volumic: ")
