# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Time and memory of the command `volumic` on one volume, for each size and number of threads.
Reading and writing are included. The files of the surfaces must be identical for any number of
threads. Unknown options are passed to volumic."""

import csv
import hashlib
import json
import os
import statistics
import tempfile

from vtkmodules.vtkImagingCore import vtkImageResize
from vtkmodules.vtkIOXML import vtkXMLImageDataReader, vtkXMLImageDataWriter

from tables import Figures, finish, print_figures, print_targets, ratio, say, timed

COLUMNS = {
    "Seconds": "seconds", "ProcessorSeconds": "processor s", "PeakMegabytes": "MB at the peak",
    "Vertices": "vertices", "MillionSeconds": "s / million", "Updates": "updates, level 0",
    "Edits": "edits, level 0", "Gain": "speed-up", "Same": "same file"}


def add_options(parser):
    parser.add_argument("volume", help="volume that volumic reads; .vti if --sizes resamples it")
    parser.add_argument("--volumic", default="volumic", metavar="PROGRAM")
    parser.add_argument("--sizes", default="0", metavar="LIST",
                        help="resample to N^3 voxels; 0: original size (default: 0)")
    parser.add_argument("--threads", default="1,2", metavar="LIST", help="(default: 1,2)")
    parser.add_argument("--repetitions", type=int, default=1, help="in turns; medians are reported")


def resample(volume, size, output):
    """Resample linearly, keep the positions of border voxels, and write without compression."""
    reader, resize, writer = vtkXMLImageDataReader(), vtkImageResize(), vtkXMLImageDataWriter()
    reader.SetFileName(volume)
    reader.Update()
    dimensions = reader.GetOutput().GetDimensions()
    factor = size / (dimensions[0] * dimensions[1] * dimensions[2]) ** (1 / 3)
    resize.SetInputConnection(reader.GetOutputPort())
    resize.SetResizeMethodToOutputDimensions()
    resize.SetOutputDimensions(*(max(8, round(factor * n)) for n in dimensions))
    writer.SetInputConnection(resize.GetOutputPort())
    writer.SetFileName(output)
    writer.SetDataModeToAppended()
    writer.EncodeAppendedDataOff()
    writer.SetCompressorTypeToNone()
    writer.SetHeaderTypeToUInt64()
    if not writer.Write():
        raise RuntimeError(f"{output} can't be written")


def run(options, folder, volume, threads):
    surface, history, report = (os.path.join(folder, name) for name in (
        "surface.vtp", "history.csv", "report.json"))
    seconds, processor, peak = timed(
        options.volumic, volume, surface, "--quiet", "--threads", threads, "--report", report,
        "--history", history, *options.rest)
    with open(report, encoding="utf-8") as file:
        vertices = json.load(file)["vertices"]
    with open(history, encoding="utf-8") as file:
        rows = [row for row in csv.DictReader(file) if row["Level"] == "0"]
    with open(surface, "rb") as file:
        digest = hashlib.sha256(file.read()).hexdigest()[:16]

    def of_vertex(*columns):
        return sum(float(row[column]) for row in rows for column in columns) / vertices
    return Figures(
        Seconds=seconds, ProcessorSeconds=processor, PeakMegabytes=peak, Vertices=vertices,
        MillionSeconds=1e6 * processor / vertices, Updates=of_vertex("ActiveVertices"),
        Edits=of_vertex("Splits", "Collapses", "Flips"), Surface=digest)


def measure_size(options, folder, size):
    """Return {threads: figures}."""
    volume = options.volume if size == "0" else os.path.join(folder, "volume.vti")
    if size != "0":
        resample(options.volume, int(size), volume)
    runs = {threads: [] for threads in options.threads.split(",")}
    for _ in range(options.repetitions):
        for threads, figures in runs.items():
            say(f"size {size}, {threads} thread(s)")
            try:
                figures.append(run(options, folder, volume, threads))
            except RuntimeError as error:
                figures.append(Figures(Failure=str(error)))
    medians = {}
    for threads, repetitions in runs.items():
        medians[threads] = Figures(repetitions[-1])
        for column in ("Seconds", "ProcessorSeconds", "PeakMegabytes", "MillionSeconds"):
            medians[threads][column] = statistics.median(each[column] for each in repetitions)
    first = next(iter(medians.values()))
    for figures in medians.values():
        figures["Gain"] = ratio(first["Seconds"], figures["Seconds"])
        figures["Same"] = "yes" if figures["Surface"] == first["Surface"] else "no"
    return medians


def target_rows(size, medians):
    rows = [("Q5", f"{size}: different surfaces",
             len({f["Surface"] for f in medians.values() if "Surface" in f}), "<=", 1)]
    for threads, figures in medians.items():
        required = {"2": 1.85, "16": 10 if int(size) >= 512 else 7}.get(threads)
        if required and "1" in medians:
            rows.append(("S6", f"{size}: speed-up of {threads} threads", figures["Gain"], ">=",
                         required))
        if size in ("512", "1024"):
            rows.append(("M1", f"{size}^3: MB, {threads} thread(s)", figures["PeakMegabytes"], "<=",
                         800 if size == "512" else 4200))
    return rows


def measure(options):
    runs, targets = [], []
    for size in options.sizes.split(","):
        with tempfile.TemporaryDirectory(dir="/var/tmp", prefix="volumic-") as folder:
            medians = measure_size(options, folder, size)
        runs += [(f"{size}^3, " * bool(int(size)) + f"{threads} thread(s)", figures)
                 for threads, figures in medians.items()]
        targets += target_rows(size, medians)
    print(f"{options.volume}: speed-up is relative to the first number of threads\n")
    print_figures(COLUMNS, runs)
    print_targets(targets)
    return finish(options.csv, runs)
