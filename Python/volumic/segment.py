# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The command for volumes: read, compute the surface, write. Label maps: segment_labels.py."""

from __future__ import annotations

import dataclasses
import os
import time
from argparse import Namespace
from typing import Any

from . import geometry, messages, report, writing
from . import vtkFiltersVolumic as vtk
from .errors import Failure, Interrupted, UsageError
from .label_map import name_labels
from .messages import Run, Console, number_text
from .option_tables import Filters
from .options import (has_property, with_option_names, writes_tetrahedra, needs_surface)
from .reading import list_files, points
from .triangles import find_triangles
from .writing import files
from .writing.tetrahedra import TetrahedralMesher, find_mesher

DONE, UNFINISHED = 0, 3  # exit codes
NO_RESULT = "a surface was computed; no surface was written"


def inputs_of(options: Namespace) -> list[str]:
    paths = list_files(options.volume, options.choice)
    for path in [options.edges, *options.probe]:
        paths += list_files(path, None) if path and os.path.exists(path) else []
    given = (options.seeds, options.initial_surface, options.attracting_points,
             options.label_names)
    return paths + [path for path in given if path]


def other_outputs(options: Namespace) -> list[files.OutputName]:
    outputs = []
    for name, prefix in ((options.levels_output, "level"), (options.snapshots, "snapshot")):
        if name:
            outputs.append(files.OutputName(
                name, "blocks" if name.lower().endswith(".vtm") else "folder", prefix))
    for name in (options.write_volume, options.history,
                 None if options.report == "-" else options.report):
        if name:
            outputs.append(files.OutputName(name))
    return outputs


def check_files(options: Namespace, outputs: list[files.OutputName]) -> None:
    """Check inputs, outputs and meshers before the run. Raise Failure or UsageError."""
    if options.write_volume and not options.write_volume.lower().endswith(".vti"):
        raise UsageError(f"{options.write_volume}: volumes are written as .vti; change the suffix")
    files.check_outputs(outputs + other_outputs(options), inputs_of(options))
    if writes_tetrahedra(options):
        find_mesher(options.mesher)


def set_initial_data(options: Namespace, surface: Any) -> None:
    """Pass seeds, initial surface and attracting points to the filter."""
    chosen = has_property(options, "Initialization")
    for position in options.seed_position:
        surface.AddSeedPosition(*position)
    for position in options.attracting_position:
        surface.AddAttractingPosition(*position)
    if options.seeds:
        surface.SetInitialSurfaceData(points.read_seeds(options.seeds))
    if options.seeds or options.seed_position:
        if not chosen:
            surface.SetInitializationToSeeds()
    elif options.initial_surface:
        surface.SetInitialSurfaceData(points.read_surface(options.initial_surface))
        if not chosen:
            surface.SetInitializationToInputSurface()
    if options.attracting_points:
        surface.SetAttractingPointsData(points.read_attracting_points(options.attracting_points))


def set_edges(options: Namespace, image: Any, surface: Any, console: Console) -> None:
    """Add the edge map to the image as a second array."""
    if not options.edges:
        return
    if os.path.exists(options.edges):
        edges = geometry.read(options.edges, console)
    else:
        edges = geometry.read(options.volume, Console(quiet=True), array=options.edges)
        if edges.name != options.edges:
            raise Failure(f"{options.edges}: not a file, and not an array of {options.volume}")
    if edges.array.shape[-3:] != tuple(image.GetDimensions()[::-1]):
        raise Failure(f"{options.edges}: its dimensions differ from those of the volume")
    array = geometry.image_of(edges, edges.scalars()).GetPointData().GetScalars()
    array.SetName("Edges" if image.GetPointData().GetScalars().GetName() != "Edges" else "Edges_")
    image.GetPointData().AddArray(array)
    surface.SetInputArrayToProcess(1, 0, 0, 0, array.GetName())
    if not has_property(options, "EdgeAttractionWeight"):
        surface.SetEdgeAttractionWeight(2.0)


def set_otsu_threshold(loaded: geometry.LoadedVolume, surface: Any, console: Console) -> None:
    """Set the iso-value to Otsu's threshold and report it."""
    otsu = vtk.vtkOtsuThreshold()
    otsu.SetInputData(loaded.image)
    messages.run(otsu, "Otsu's threshold", Console(quiet=True), with_option_names)
    surface.SetIsoValue(otsu.GetThreshold())
    minimum = loaded.range[0]
    padding = minimum < -1024 and otsu.GetHistogram().GetValue(0) > minimum
    console.info(f"iso-value {number_text(otsu.GetThreshold())}, estimated by Otsu's method"
                 + (f" without padding voxels of value {number_text(minimum)}" if padding else "")
                 + "; set another value with --iso")


class Segmentation:
    """One run of the filters on a volume."""

    def __init__(self, options: Namespace, filters: Filters, loaded: geometry.LoadedVolume,
                 console: Console) -> None:
        self.options, self.filters, self.loaded, self.console = options, filters, loaded, console
        self.warnings: list[str] = []
        self.seconds = [0.0, 0.0]  # of the pyramid and of the surface

    def run(self, algorithm: Any, title: str) -> Run:
        """Run a filter. Raise Failure with advice if memory is insufficient."""
        try:
            return messages.run(algorithm, title, self.console, with_option_names)
        except (Failure, MemoryError) as error:
            if isinstance(error, MemoryError) or "memory" in str(error):
                raise Failure(
                    f"{self.options.volume}: not enough memory; stop at a coarser level (--finest "
                    "1), or crop or resample the volume") from None
            raise

    def connect_input(self) -> None:
        """Connect the surface filter to a pyramid, or, for vtkVolumeToSurface, to the volume."""
        pyramid, surface = self.filters.pyramid, self.filters.surface
        if surface.IsA("vtkVolumeToSurface"):
            for name in ("NumberOfLevels", "MinimumLevelSize", "ReductionFactor"):
                getattr(surface, "Set" + name)(getattr(pyramid, "Get" + name)())
            surface.SetInputData(self.loaded.image)
            return
        pyramid.SetSelectedComponent(surface.GetSelectedComponent())
        pyramid.SetInputData(self.loaded.image)
        pyramid.ReleaseDataFlagOn()  # levels are released after use
        run = self.run(pyramid, "Building the pyramid")
        self.report_warnings(run)
        self.seconds[0] = run.seconds
        if run.interrupted:
            raise Interrupted("interrupted before " + NO_RESULT)
        surface.SetInputConnection(pyramid.GetOutputPort())

    def report_warnings(self, run: Run) -> None:
        """Print and store the warnings of a run."""
        for text in run.warnings:
            self.console.warn(text)
        self.warnings += run.warnings

    def evolve(self) -> None:
        """Compute the surface. Raise Failure if it is empty."""
        surface = self.filters.surface
        self.connect_input()
        run = (self.find_triangles() if self.options.triangles
               else self.run(surface, "Evolving the surface"))
        self.report_warnings(run)
        self.seconds[1] = run.seconds
        if surface.GetOutput().GetNumberOfPolys() == 0:
            if geometry.field_text(surface.GetOutput(), "StopReason") == "time limit":
                raise Interrupted("time limit reached before " + NO_RESULT)
            if run.interrupted:
                raise Interrupted("interrupted before " + NO_RESULT)
            raise Failure(f"{self.options.volume}: the surface vanished; check that the object has "
                          f"image values {self.object_range()} (--iso, --upper, --dark)")

    def object_range(self) -> str:
        """Return the range of image values of the object, as text."""
        surface = self.filters.surface
        bright, iso = surface.GetObjectIsBright(), number_text(surface.GetIsoValue())
        if has_property(self.options, "UpperValue"):
            return (("between " if bright else "not between ") + iso + " and "
                    + number_text(surface.GetUpperValue()))
        return ("above " if bright else "below ") + iso

    def find_triangles(self) -> Run:
        surface, last, seconds = self.filters.surface, Run(), 0.0

        def make(edge_length: float, tolerance: float) -> tuple[int, float]:
            nonlocal last, seconds
            surface.SetEdgeLength(edge_length)
            surface.SetTolerance(tolerance)
            last = self.run(surface, "Evolving the surface")
            seconds += last.seconds
            output = surface.GetOutput()
            return output.GetNumberOfPolys(), report.values_of(output, "Area")[0, 0]

        find_triangles(make, self.options.triangles, min(self.loaded.image.GetSpacing()),
                       self.console)
        return Run(seconds, last.warnings, last.interrupted)


def write_outputs(run: Segmentation, surface: Any, is_finished: bool, mesher: TetrahedralMesher,
                  reader_memory: float) -> None:
    """Write all outputs. Raise Failure with one line per file that cannot be written."""
    options, console = run.options, run.console
    filter_ = run.filters.surface
    reason = geometry.field_text(filter_.GetOutput(), "StopReason")
    remark = "" if is_finished else f", UNFINISHED: {reason}"
    failures = files.Failures()
    for data in (surface, filter_.GetLevels(), filter_.GetSnapshots()):
        geometry.mark_space(data, run.loaded.world)
    for name in options.surfaces:
        with failures.collect(), console.progress(f"Writing {name}") as progress:
            writing.write_surface(surface, name, remark, mesher, console.warn, progress)
    for name, blocks, prefix in ((options.levels_output, filter_.GetLevels(), "level"),
                                 (options.snapshots, filter_.GetSnapshots(), "snapshot")):
        if name:
            with failures.collect():
                if name.lower().endswith(".vtm"):
                    writing.write_blocks(blocks, name, console.warn)
                else:
                    writing.write_folder(blocks, name, prefix,
                                         level_of if prefix == "level" else None, console.warn)
    if options.history:
        with failures.collect():
            writing.write_table(filter_.GetHistory(), options.history)
    if options.report:
        with failures.collect():
            files.write_text(report.volume_report(
                options.volume, run.loaded, run.filters, surface, is_finished, tuple(run.seconds),
                reader_memory, mesher.last, run.warnings), options.report)
    failures.raise_all()


def level_of(surface: Any) -> int:
    """Return the level of a surface; the last block may be level -1."""
    return int(report.values_of(surface, "Level")[0, 0])


def segment_volume(options: Namespace, filters: Filters, console: Console) -> int:
    """Run the command on a volume. Return the exit code."""
    for name in options.surfaces:
        writing.check_surface_name(name)
    check_files(options, [files.OutputName(name) for name in options.surfaces])
    loaded = geometry.load_volume(options, filters, console)
    reader_memory = report.peak_memory()
    surface = filters.surface
    component = surface.GetSelectedComponent()
    if options.write_volume:
        if loaded.component is not None and component == -1:
            whole = dataclasses.replace(loaded.volume)
            geometry.resample(whole, options, Console(quiet=True))
            image = geometry.image_of(whole, whole.array)
        else:
            image = loaded.image
        name_labels(options, loaded.volume, image, console)
        writing.write_volume(image, options.write_volume)
    if not needs_surface(options):
        return DONE
    probes = geometry.Probes(options, loaded.world, console)
    hint = "" if surface.IsA("vtkVolumeToSurface") else \
        vtk.vtkVolumeToSurface.HintAtLabels(loaded.image)
    if hint:
        console.warn(f"{options.volume}: {hint} (--labels all)")
    surface.SetSelectedComponent(-1)  # the component is extracted already
    set_initial_data(options, surface)
    set_edges(options, loaded.image, surface, console)
    if not has_property(options, "IsoValue") and not has_property(options, "UpperValue"):
        set_otsu_threshold(loaded, surface, console)
    if options.snapshots and not has_property(options, "SnapshotInterval"):
        surface.SetSnapshotInterval(10)
    messages.defer_signals()
    run = Segmentation(options, filters, loaded, console)
    run.evolve()
    surface.SetSelectedComponent(component)
    warnings: list[str] = []
    written = surface.GetOutput()
    if options.ends != "closed":
        from .ends import with_ends
        written = with_ends(written, loaded.image, options.ends, warnings)
    for text in warnings:
        console.warn(f"{options.volume}: {text}")
    run.warnings += warnings
    probes.add_to(written)
    reason = geometry.field_text(surface.GetOutput(), "StopReason")
    is_finished = reason in ("converged", "limit cycle")
    mesher = make_mesher(options, filters, probes, sum(run.seconds))
    write_outputs(run, written, is_finished, mesher, reader_memory)
    _print_summary(run, written, mesher, reason, is_finished)
    return DONE if is_finished else UNFINISHED


def make_mesher(options: Namespace, filters: Filters, probes: geometry.Probes,
                seconds: float) -> TetrahedralMesher:
    """Return the mesher. Its time limit is what --time-limit leaves after `seconds`."""
    limit = filters.surface.GetTimeLimit()
    deadline = time.monotonic() + max(limit - seconds, 0.0) if limit > 0 else None
    return TetrahedralMesher(options.mesher or "", options.maximum_volume or 0.0,
                             messages.was_interrupted, deadline, probes if probes else None)


def _print_summary(run: Segmentation, surface: Any, mesher: TetrahedralMesher, reason: str,
                   is_finished: bool) -> None:
    console = run.console
    iterations = run.filters.surface.GetHistory().GetNumberOfRows()
    console.info(f"{surface.GetNumberOfPoints()} vertices after {iterations} iterations: {reason}")
    console.info(report.describe_print(run.options, [surface], run.loaded.world.unit))
    console.info(report.describe_tetrahedra(mesher.last))
    if not is_finished:
        console.error(f"unfinished ({reason}): the current surface was written")
