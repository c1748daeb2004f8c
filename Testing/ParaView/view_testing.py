# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Views of scripts: a screen, and checks of pictures."""

import os
import sys

import gui_session as gui
import numpy
import plugin_testing as testing
from paraview import simple
from paraview.vtk.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOImage import vtkPNGReader


def open_screen():
    """Open a screen for this process. Skip the test without an X server."""
    if not os.environ["VOLUMIC_XVFB"]:
        print("Skipped: Xvfb was not found")
        sys.exit(77)
    # The server ends with this process: newer versions of VTK use it until the last view is closed.
    _, display = gui.start_screen(os.environ["VOLUMIC_XVFB"], (900, 700))
    os.environ.update(DISPLAY=display, LIBGL_ALWAYS_SOFTWARE="1")


def new_view(kind, size=(500, 400)):
    view = simple.CreateView(kind)
    view.ViewSize = size
    if kind == "RenderView":
        view.OrientationAxesVisibility = 0
    return view


def picture_of(view, name):
    """Return the pixels [y, x, colour] of a view, and save the picture in VOLUMIC_TEST_OUTPUT."""
    path = testing.output_path(name)
    simple.SaveScreenshot(path, view)
    reader = vtkPNGReader()
    reader.SetFileName(path)
    reader.Update()
    image = reader.GetOutput()
    width, height, _ = image.GetDimensions()
    return vtk_to_numpy(image.GetPointData().GetScalars()).reshape(height, width, -1)[..., :3]


def drawn(pixels):
    """Return the number of pixels that differ from the background (a corner)."""
    return int((numpy.abs(pixels.astype(int) - pixels[0, 0]).max(axis=2) > 8).sum())
