#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Snapshots of an evolution: from the body about the volume, level by level, to the end.

    evolution_snapshots.py skull.vti skull.ogv --iso 226.5 --every 5
    evolution_snapshots.py scan.nii.gz frames/            # a PNG per frame
    evolution_snapshots.py scan.nii.gz evolution.vtp.series

VOLUME is what read_volume.py can read. OUTPUT: an .ogv video, a folder for a PNG series, or a
.vtp.series, which ParaView opens as surfaces in time: press Play there. The surface is kept every
so many iterations (vtkDeformableSurface's SnapshotInterval) and as it came to rest at each level.
Pictures need a display; xvfb-run gives one.
"""

import argparse
import json
import os
import sys

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkIOOggTheora import vtkOggTheoraWriter

import render
from output_files import beside, check_output, write_text
from pipeline import build_pyramid, load_volume, prepare_surface, run_surface
from read_volume import VolumeError, files_of_volume
from surface_pictures import THREE_QUARTERS, field_value, visited_levels
from surface_results import write_surface
from terminal import FilterError, Interrupted

RESTED_FRAMES = 8  # how long the surface of a level is shown at rest


def surfaces_in_time(filter_):
    """(caption, surface, frames that it is shown for) in the order of the evolution."""
    snapshots, in_time = filter_.GetSnapshots(), []
    for level, rested in visited_levels(filter_.GetLevels()):
        for b in range(snapshots.GetNumberOfBlocks()):
            surface = snapshots.GetBlock(b)
            if field_value(surface, "Level") == level:
                in_time.append((snapshots.GetMetaData(b).Get(snapshots.NAME()), surface, 1))
        in_time.append((f"Level {level}, at rest", rested, RESTED_FRAMES))
    return in_time


def frames_of(in_time, frame, width):
    """Pictures, all of one size with even sides, as videos want them."""
    # The first surfaces are about the whole volume.
    every = np.array([surface.GetBounds() for _, surface, _ in in_time])
    bounds = np.where([True, False] * 3, every.min(axis=0), every.max(axis=0))
    height = render.fitting_height(width, frame, *THREE_QUARTERS, bounds)
    for caption, surface, times in in_time:
        panel = render.draw([render.surface_actor(surface)], (width, height), frame,
                            *THREE_QUARTERS, bounds)
        lines = (caption, f"{surface.GetNumberOfPoints():,} vertices")
        picture = render.compose([[panel]], [[lines]])
        for _ in range(times):
            yield picture[:picture.shape[0] & ~1, :picture.shape[1] & ~1]


def write_video(frames, path, rate):
    with beside(path) as written:
        write_frames(frames, written, rate)


def write_frames(frames, path, rate):
    writer = vtkOggTheoraWriter()
    writer.SetFileName(path)
    writer.SetQuality(2)
    writer.SetRate(rate)
    for number, pixels in enumerate(frames):
        image = vtkImageData()
        image.SetDimensions(pixels.shape[1], pixels.shape[0], 1)
        image.GetPointData().SetScalars(
            numpy_to_vtk(np.ascontiguousarray(pixels[::-1]).reshape(-1, 3), deep=True))
        writer.SetInputData(image)
        if number == 0:
            writer.Start()
        writer.Write()
    writer.End()
    if writer.GetErrorCode() or not os.path.exists(path) or not os.path.getsize(path):
        raise OSError("is the disk full?")


def write_pictures(frames, folder):
    os.makedirs(folder, exist_ok=True)
    for number, pixels in enumerate(frames):
        render.write_png(pixels, os.path.join(folder, f"frame{number:04d}.png"))


def write_series(in_time, path):
    """The surfaces beside a list of them, which ParaView opens as one source with time steps."""
    folder, files = path.removesuffix(".vtp.series"), []
    os.makedirs(folder, exist_ok=True)
    for step, (_, surface, _) in enumerate(in_time):
        name = os.path.join(folder, f"{step:04d}.vtp")
        write_surface(surface, name)
        files.append({"name": f"{os.path.basename(folder)}/{step:04d}.vtp", "time": step})
    write_text(json.dumps({"file-series-version": "1.0", "files": files}, indent=1), path)


def write_snapshots(arguments):
    if arguments.output.endswith((".ogv", ".vtp.series")):
        check_output(arguments.output, files_of_volume(arguments.volume))
    image, iso = load_volume(arguments.volume, arguments.iso)
    pyramid, _ = build_pyramid(image)
    filter_ = prepare_surface(pyramid, iso, {
        "SnapshotInterval": arguments.every, "FinestLevel": arguments.finest_level,
        "ObjectIsBright": "off" if arguments.dark else "on"})
    run_surface(filter_)
    in_time = surfaces_in_time(filter_)
    if arguments.output.endswith(".vtp.series"):
        write_series(in_time, arguments.output)
    else:
        frames = frames_of(in_time, render.world_frame(image), arguments.width)
        if arguments.output.endswith(".ogv"):
            write_video(frames, arguments.output, arguments.rate)
        else:
            write_pictures(frames, arguments.output)
    print(f"Written: {arguments.output} ({len(in_time)} surfaces)")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("volume", help="volume that read_volume.py can read")
    parser.add_argument("output", help="NAME.ogv, NAME.vtp.series, or a folder for pictures")
    parser.add_argument("--iso", type=float, help="default: Otsu's threshold, a guess")
    parser.add_argument("--dark", action="store_true",
                        help="the object is darker than its surroundings")
    parser.add_argument("--every", type=int, default=5,
                        help="iterations from frame to frame, each at the end of a sweep of five")
    parser.add_argument("--finest-level", type=int, default=0, help="the level to end at")
    parser.add_argument("--width", type=int, default=640, help="of the pictures, pixels")
    parser.add_argument("--rate", type=int, default=12, help="frames per second")
    arguments = parser.parse_args()
    if arguments.every < 1:
        parser.error("--every must be at least 1")
    try:
        write_snapshots(arguments)
    except Interrupted as error:
        print(f"evolution_snapshots.py: {error}", file=sys.stderr)
        return 3
    except (VolumeError, FilterError, ValueError, OSError) as error:
        print(f"evolution_snapshots.py: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
