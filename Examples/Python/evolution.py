#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Make a video of an evolution, or one picture per step, from snapshots of the command:

    volumic skull.vti skull.vtp --iso 226.5 --snapshots steps.vtm --snapshot-interval 5
    xvfb-run -a /usr/bin/python3 evolution.py steps.vtm evolution.ogv

The output is an .ogv video or a folder of pictures. With --snapshots DIR the command writes files
that ParaView opens as a time series.
"""

import os
import sys

import numpy as np
import render
from pictures import THREE_QUARTERS, blocks_of, number, read
from vtkmodules.vtkIOOggTheora import vtkOggTheoraWriter
from vtkmodules.vtkIOXML import vtkXMLMultiBlockDataReader

WIDTH = 640  # pixels
FRAME_RATE = 12
LAST_FRAMES = FRAME_RATE  # frames of the last step


def frames_of(steps):
    """Yield a picture of each step, of equal even size, as required by videos."""
    space = steps[0].GetFieldData().GetAbstractArray("SPACE")
    frame = render.Frame(space.GetValue(0) if space else "")
    # Common bounds: the first surfaces enclose the whole volume.
    every = np.array([surface.GetBounds() for surface in steps])
    bounds = np.where([True, False] * 3, every.min(axis=0), every.max(axis=0))
    size = WIDTH, render.fitting_height(WIDTH, frame, [THREE_QUARTERS], bounds)
    for surface in steps:
        panel = render.draw([render.surface_actor(surface)], size, frame, *THREE_QUARTERS, bounds)
        picture = render.compose([[panel]], [[(
            f"Level {number(surface, 'Level'):.0f}, iteration {number(surface, 'Iterations'):.0f}",
            f"{surface.GetNumberOfPoints():,} vertices")]])
        yield picture[:picture.shape[0] & ~1, :picture.shape[1] & ~1]


def main(snapshots, output):
    steps = [surface for surface in blocks_of(read(vtkXMLMultiBlockDataReader(), snapshots))
             if surface is not None and surface.GetNumberOfPolys() > 0]
    if not output.endswith(".ogv"):
        os.makedirs(output, exist_ok=True)
        for step, pixels in enumerate(frames_of(steps)):
            render.write_png(pixels, os.path.join(output, f"frame{step:04d}.png"))
        return
    writer = vtkOggTheoraWriter()
    writer.SetFileName(output)
    writer.SetRate(FRAME_RATE)
    for step, pixels in enumerate(frames_of(steps)):
        writer.SetInputData(render.image_of(pixels))
        if step == 0:
            writer.Start()
        for _ in range(LAST_FRAMES if step == len(steps) - 1 else 1):
            writer.Write()
    writer.End()


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])
