# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The command on a volume: read it, find the surface of the object, write what the options
request. Label maps: segment_labels.py."""

from __future__ import annotations

import os
import time
from argparse import Namespace
from collections.abc import Sequence
from typing import Any

from . import geometry, messages, report, writing
from . import vtkFiltersVolumic as vtk
from .errors import Failure, Interrupted
from .label_map import name_labels
from .messages import Run, Teller, number_text
from .option_tables import Filters
from .options import (
    has_property, in_words_of_options, makes_tetrahedra, wants_surface)
from .reading import list_files, points
from .triangles import find_triangles
from .writing import files
from .writing.tetrahedra import SolidMaker, find_mesher

DONE, UNFINISHED = 0, 3  # exit codes
NOTHING = "there was a surface; nothing is written"


# ---- Files -------------------------------------------------------------------------------------

def inputs_of(options: Namespace) -> list[str]:
    """All files that a run reads."""
    paths = list_files(options.volume, options.choice)
    for path in [options.edges, *options.probe]:
        paths += list_files(path, None) if path and os.path.exists(path) else []
    given = (options.seeds, options.initial_surface, options.attracting_points,
             options.label_names)
    return paths + [path for path in given if path]


def other_outputs(options: Namespace) -> list[files.OutputName]:
    """What is written beside the surfaces."""
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
    """Throw Failure or UsageError if something is wrong with the files before the work begins."""
    if options.write_volume:
        writing.check_volume_name(options.write_volume)
    files.check_outputs(outputs + other_outputs(options), inputs_of(options))
    if makes_tetrahedra(options):
        find_mesher(options.mesher)


# ---- Before the run ----------------------------------------------------------------------------

def set_start(options: Namespace, surface: Any) -> None:
    """Give the filter the seeds, the initial surface and the attracting points."""
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


def set_edges(options: Namespace, image: Any, surface: Any, teller: Teller) -> None:
    """Give the image the map of edges as a second array."""
    if not options.edges:
        return
    if os.path.exists(options.edges):
        edges = geometry.read(options.edges, teller)
    else:
        edges = geometry.read(options.volume, Teller(quiet=True), array=options.edges)
        if edges.name != options.edges:
            raise Failure(f"{options.edges}: neither a file nor an array of {options.volume}")
    if edges.array.shape[-3:] != tuple(image.GetDimensions()[::-1]):
        raise Failure(f"{options.edges}: its size differs from the volume's")
    array = geometry.image_of(edges, edges.scalars()).GetPointData().GetScalars()
    array.SetName("Edges" if image.GetPointData().GetScalars().GetName() != "Edges" else "Edges_")
    image.GetPointData().AddArray(array)
    surface.SetInputArrayToProcess(1, 0, 0, 0, array.GetName())
    if not has_property(options, "EdgeAttractionWeight"):
        surface.SetEdgeAttractionWeight(2.0)


def take_otsu_threshold(loaded: geometry.LoadedVolume, surface: Any, teller: Teller) -> None:
    """Set the iso-value where the options have none, and report it."""
    otsu = vtk.vtkOtsuThreshold()
    otsu.SetInputData(loaded.image)
    messages.run(otsu, "Otsu's threshold", Teller(quiet=True), in_words_of_options)
    surface.SetIsoValue(otsu.GetThreshold())
    least = loaded.range[0]
    padding = least < -1024 and otsu.GetHistogram().GetValue(0) > least
    teller.say(f"iso-value {number_text(otsu.GetThreshold())}, a guess by Otsu's threshold"
               + (f", for which voxels of {number_text(least)} are padding" if padding else "")
               + "; choose another one with --iso")


# ---- The run -----------------------------------------------------------------------------------

class Segmentation:
    """One run: the volume, the filters, and what came of them."""

    def __init__(self, options: Namespace, filters: Filters, loaded: geometry.LoadedVolume,
                 teller: Teller) -> None:
        self.options, self.filters, self.loaded, self.teller = options, filters, loaded, teller
        self.warnings: list[str] = []
        self.seconds = [0.0, 0.0]  # of the pyramid and of the surface

    def run(self, algorithm: Any, title: str) -> Run:
        """Run a filter. Failures for want of memory name the volume and say what helps."""
        try:
            return messages.run(algorithm, title, self.teller, in_words_of_options)
        except (Failure, MemoryError) as error:
            if isinstance(error, MemoryError) or "memory" in str(error):
                raise Failure(
                    f"{self.options.volume}: not enough memory to segment it; a coarser level "
                    "(--finest 1), or the volume cropped or resampled, needs less") from None
            raise

    def give_levels(self) -> None:
        """Give the surface's filter its levels: those of a pyramid that is built here, or, where a
        property decides on them, the volume."""
        pyramid, surface = self.filters.pyramid, self.filters.surface
        if surface.IsA("vtkVolumeToSurface"):
            for name in ("NumberOfLevels", "MinimumLevelSize", "ReductionFactor"):
                getattr(surface, "Set" + name)(getattr(pyramid, "Get" + name)())
            surface.SetInputData(self.loaded.image)
            return
        pyramid.SetSelectedComponent(surface.GetSelectedComponent())
        pyramid.SetInputData(self.loaded.image)
        pyramid.ReleaseDataFlagOn()  # the surface leaves one level after the other
        run = self.run(pyramid, "Building the pyramid")
        self.keep(run)
        self.seconds[0] = run.seconds
        if run.interrupted:
            raise Interrupted("interrupted before " + NOTHING)
        surface.SetInputConnection(pyramid.GetOutputPort())

    def keep(self, run: Run) -> None:
        """Print the warnings of a run."""
        for text in run.warnings:
            self.teller.warn(text)
        self.warnings += run.warnings

    def evolve(self) -> None:
        """Run the filter of the surface. Throw Failure where there is none at the end."""
        surface = self.filters.surface
        self.give_levels()
        run = (self.find_triangles() if self.options.triangles
               else self.run(surface, "Evolving the surface"))
        self.keep(run)
        self.seconds[1] = run.seconds
        if surface.GetOutput().GetNumberOfPolys() == 0:
            if report.stop_reason(surface.GetOutput()) == "time limit":
                raise Interrupted("the time limit came before " + NOTHING)
            if run.interrupted:
                raise Interrupted("interrupted before " + NOTHING)
            raise Failure(f"the surface vanished: is the object where the image is "
                          f"{self.place_of_object()}? (--iso, --upper, --dark)")

    def place_of_object(self) -> str:
        """Where the image is ..."""
        surface = self.filters.surface
        bright, iso = surface.GetObjectIsBright(), number_text(surface.GetIsoValue())
        if has_property(self.options, "UpperValue"):
            return (("between " if bright else "not between ") + iso + " and "
                    + number_text(surface.GetUpperValue()))
        return ("above " if bright else "below ") + iso

    def find_triangles(self) -> Run:
        """Run the filter until the surface has about --triangles triangles."""
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
                       self.teller)
        return Run(seconds, last.warnings, last.interrupted)


# ---- The end of the run ------------------------------------------------------------------------

def write_outputs(run: Segmentation, surface: Any, finished: bool, solids: SolidMaker,
                  reader_memory: float) -> None:
    """Write all that the options request. Throw Failure, with a line for each file, if not all
    could be written; those that can be are."""
    options, teller = run.options, run.teller
    filter_ = run.filters.surface
    reason = report.stop_reason(filter_.GetOutput())
    remark = "" if finished else f", UNFINISHED: {reason}"
    failures = files.Failures()
    for data in (surface, filter_.GetLevels(), filter_.GetSnapshots()):
        geometry.mark_space(data, run.loaded.world)
    for name in options.surfaces:
        with failures.collect(), teller.progress(f"Writing {name}") as progress:
            writing.write_surface(surface, name, remark, solids, teller.warn, progress)
    for name, blocks, prefix in ((options.levels_output, filter_.GetLevels(), "level"),
                                 (options.snapshots, filter_.GetSnapshots(), "snapshot")):
        if name:
            with failures.collect():
                if name.lower().endswith(".vtm"):
                    writing.write_blocks(blocks, name, teller.warn)
                else:
                    writing.write_folder(blocks, name, prefix,
                                         level_of if prefix == "level" else None, teller.warn)
    if options.history:
        with failures.collect():
            writing.write_table(filter_.GetHistory(), options.history)
    if options.report:
        with failures.collect():
            files.write_text(report.of_volume(
                options.volume, run.loaded, run.filters, surface, finished, tuple(run.seconds),
                reader_memory, solids.last, run.warnings), options.report)
    failures.throw()


def level_of(surface: Any) -> int:
    """The level of a surface; the last block may be that of level -1."""
    return int(report.values_of(surface, "Level")[0, 0])


def segment_volume(options: Namespace, filters: Filters, teller: Teller) -> int:
    """Do what the command line requests; return the exit code."""
    for name in options.surfaces:
        writing.check_surface_name(name)
    check_files(options, [files.OutputName(name) for name in options.surfaces])
    loaded = geometry.load_volume(options, filters, teller)
    reader_memory = report.peak_memory()
    surface = filters.surface
    component = surface.GetSelectedComponent()
    if options.write_volume:
        image = geometry.image_of(loaded.volume, loaded.volume.array) \
            if loaded.component is not None and component == -1 else loaded.image
        name_labels(options, loaded.volume, image, teller)
        writing.write_volume(image, options.write_volume)
    if not wants_surface(options):
        return DONE
    probes = geometry.Probes(options, loaded.world, teller)
    hint = "" if surface.IsA("vtkVolumeToSurface") else \
        vtk.vtkVolumeToSurface.HintAtLabels(loaded.image)
    if hint:
        teller.warn(f"{options.volume}: {hint} (--labels all)")
    surface.SetSelectedComponent(-1)  # the image has one
    set_start(options, surface)
    set_edges(options, loaded.image, surface, teller)
    if not has_property(options, "IsoValue") and not has_property(options, "UpperValue"):
        take_otsu_threshold(loaded, surface, teller)
    if options.snapshots and not has_property(options, "SnapshotInterval"):
        surface.SetSnapshotInterval(10)
    messages.hold_signals()
    run = Segmentation(options, filters, loaded, teller)
    run.evolve()
    surface.SetSelectedComponent(component)
    ended: list[str] = []
    written = surface.GetOutput()
    if options.ends != "closed":
        from .ends import with_ends
        written = with_ends(written, loaded.image, options.ends, ended)
    for text in ended:
        teller.warn(f"{options.volume}: {text}")
    run.warnings += ended
    probes.add_to(written)
    reason = report.stop_reason(surface.GetOutput())
    finished = reason in ("converged", "limit cycle")
    solids = make_solids(options, filters, probes, sum(run.seconds))
    write_outputs(run, written, finished, solids, reader_memory)
    _tell_end(run, written, solids, reason, finished)
    return DONE if finished else UNFINISHED


def make_solids(options: Namespace, filters: Filters, probes: geometry.Probes,
                seconds: float) -> SolidMaker:
    """What makes tetrahedra of surfaces, in the time that --time-limit leaves after `seconds`."""
    limit = filters.surface.GetTimeLimit()
    deadline = time.monotonic() + max(limit - seconds, 0.0) if limit > 0 else None
    return SolidMaker(options.mesher or "", options.maximum_volume or 0.0,
                      messages.was_interrupted, deadline, probes if probes else None)


def prints(options: Namespace, names: Sequence[str]) -> bool:
    """Whether something is written for printers."""
    return any(name.lower().endswith(".3mf") for name in names) \
        or (options.format or "").lower() in ("3mf", ".3mf")


def _tell_end(run: Segmentation, surface: Any, solids: SolidMaker, reason: str,
              finished: bool) -> None:
    teller = run.teller
    iterations = run.filters.surface.GetHistory().GetNumberOfRows()
    teller.say(f"{surface.GetNumberOfPoints()} vertices after {iterations} iterations: {reason}")
    teller.say(report.text_of_print(prints(run.options, run.options.surfaces), [surface],
                                    run.loaded.world.unit))
    teller.say(report.text_of_solid(solids.last))
    if not finished:
        teller.error(f"unfinished ({reason}); the surface as it is was written")
