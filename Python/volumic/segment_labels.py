# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The command on a label map: choose labels, make their surfaces, write them."""

from __future__ import annotations

import contextlib
import dataclasses
import os
import sys
from argparse import Namespace
from collections.abc import Iterator, Sequence
from typing import Any

from . import geometry, messages, report, writing
from .errors import Failure, Interrupted
from .label_map import (
    KnownLabel, choose, known_labels, layers_of, list_rows, name_labels, table_of)
from .label_outputs import (
    check_files, form_of, old_files, output_of, shares_interfaces, suffix_in_folder)
from .messages import Teller
from .option_tables import Filters, is_of_labels
from .options import has_property, in_words_of_options, wants_surface
from .segment import DONE, NOTHING, UNFINISHED, inputs_of, make_solids, other_outputs, prints
from .triangles import find_triangles
from .writing import files

LEAST_TIME = 1e-3  # seconds of a layer where the others have used the time limit up


@dataclasses.dataclass
class LabelSurface:
    """A surface of one label, or, with --merge, of several."""
    labels: list[KnownLabel]
    name: str
    surface: Any  # vtkPolyData; without points where there is none
    files: list[str] = dataclasses.field(default_factory=list)  # that were written of it alone
    seconds: float = 0.0

    @property
    def unfinished(self) -> str:
        """What stopped it on its way, or before it began; empty if nothing did."""
        reason = report.stop_reason(self.surface)
        return reason if reason in ("cancelled", "time limit", "iteration limit") else ""

    @property
    def remark(self) -> str:
        """For the heads of files."""
        return f", UNFINISHED: {self.unfinished}" if self.unfinished else ""

    @property
    def is_there(self) -> bool:
        """Whether it has points."""
        return self.surface.GetNumberOfPoints() > 0


@contextlib.contextmanager
def naming(path: str) -> Iterator[None]:
    """Failures name the file."""
    try:
        yield
    except Failure as failure:
        raise type(failure)(f"{path}: {failure}") from None


# ---- The run -------------------------------------------------------------------------------------

class LabelRun:
    """One run: the map, its labels, their surfaces."""

    def __init__(self, options: Namespace, filters: Filters, loaded: geometry.LoadedVolume,
                 teller: Teller) -> None:
        self.options, self.loaded, self.teller = options, loaded, teller
        self.filters, self.filter = filters, filters.labels
        self.surfaces: list[LabelSurface] = []
        self.warnings: list[str] = []
        self.seconds = 0.0
        self.reader_memory = report.peak_memory()
        component = (filters.surface.GetSelectedComponent()
                     if has_property(options, "SelectedComponent") else None)
        names = name_labels(options, loaded.volume, loaded.image, teller)
        self.layers: list[Any] = []
        self.known: list[KnownLabel] = []
        if wants_surface(options):
            with naming(options.volume):
                self.layers = layers_of(loaded.image, names, component)
                self.known, self.warnings = known_labels(self.layers, names, options, teller)

    def announce(self) -> None:
        """Print what the map is."""
        count = sum(label.label != self.filter.GetBackgroundLabel() for label in self.known)
        image, layers = self.loaded.image, len(self.layers)
        self.teller.say(
            f"{self.options.volume}: " + " x ".join(map(str, image.GetDimensions()))
            + f" voxels, {image.GetScalarTypeAsString()}, {count} label{'s' * (count != 1)}"
            + (f" in {layers} layers" if layers > 1 else "") + self.loaded.world.text())

    def chosen(self) -> list[KnownLabel]:
        """The labels of --labels."""
        with naming(self.options.volume):
            return choose(self.options.labels, self.known, self.filter.GetBackgroundLabel())

    def warn(self, text: str) -> None:
        """Print a warning, and keep it for the report."""
        self.teller.warn(text)
        self.warnings.append(text)

    def list_labels(self) -> None:
        """Print the chosen labels, and write them to the report."""
        labels, spacing = self.chosen(), self.loaded.image.GetSpacing()
        if self.options.report:
            facts = {"input": report.input_facts(self.options.volume, self.loaded),
                     "labels": list_rows(labels, spacing)}
            files.write_text(report.ended(facts, self.warnings), self.options.report)
        if self.options.report != "-":
            sys.stdout.write(table_of(labels, spacing, len(self.layers)))

    def plan(self) -> None:
        """List the surfaces to make. Throw Failure if they cannot be made or written."""
        chosen, options = self.chosen(), self.options
        if not chosen:
            raise Failure(
                f"{options.volume}: it has no label but the background, "
                f"{self.filter.GetBackgroundLabel()}; choose another one with --background")
        option = ("--merge" if self.filter.GetMerge() else
                  "--shared-interfaces" if shares_interfaces(options) else "")
        if option and len({label.layer for label in chosen}) > 1:
            raise Failure(f"{option}: the labels lie in several layers of the file; choose one "
                          "layer with --component")
        groups = [chosen] if self.filter.GetMerge() else [[label] for label in chosen]
        self.surfaces = [LabelSurface(group, group[0].name, _no_surface()) for group in groups]

    def check_surfaces(self) -> None:
        """Throw Failure if surfaces cannot be written."""
        options, inputs, outputs = self.options, inputs_of(self.options), []
        for name in options.surfaces:
            form, (stem, suffix) = form_of(options, name), os.path.splitext(name)
            if form == "file" and len(self.surfaces) > 1:
                raise Failure(
                    f"{name}: {len(self.surfaces)} labels have as many surfaces: give a folder "
                    f"({stem}/ --format {suffix[1:].lower()}) or blocks ({stem}.vtm, {stem}.glb, "
                    f"{stem}.3mf), or make one surface of them with --merge, or one mesh of all "
                    f"with --shared-interfaces ({stem}.vtp, .vtk, .vtu, .inp, .msh, .smesh, .poly)")
            outputs += [output_of(path, "file") for path in (
                [name] if form != "folder" else self.paths(name) if os.path.isdir(name) else [])]
        files.check_outputs(outputs + other_outputs(options), inputs)

    def paths(self, folder: str) -> list[str]:
        """The files of the surfaces in a folder."""
        return [os.path.join(folder, each.labels[0].file_name + suffix_in_folder(self.options))
                for each in self.surfaces]

    def make(self) -> None:
        """Make the surfaces. Throw Failure if there is none at the end."""
        if self.options.triangles:
            find_triangles(self.make_with, self.options.triangles,
                           min(self.loaded.image.GetSpacing()), self.teller)
        else:
            self.make_layers()
        if not any(each.is_there for each in self.surfaces):
            reasons = {each.unfinished for each in self.surfaces} - {""}
            if reasons:
                raise Interrupted(("the time limit came" if "time limit" in reasons
                                   else "interrupted") + " before " + NOTHING)
            raise Failure(f"{self.options.volume}: none of the labels has a surface; smaller "
                          "triangles may hold them (--finest, --edge-length)")

    def make_with(self, edge_length: float, tolerance: float) -> tuple[int, float]:
        """Make the surfaces; return their triangles, each of shared ones once, and their area."""
        self.filter.SetEdgeLength(edge_length)
        self.filter.SetTolerance(tolerance)
        self.make_layers()
        areas = [report.values_of(each.surface, "Area") for each in self.surfaces]
        whole = ([self.filter.GetInterfaces()] if self.filter.GetSharedInterfaces()
                 else [each.surface for each in self.surfaces])
        return (sum(surface.GetNumberOfPolys() for surface in whole),
                sum(area[0, 0] for area in areas if area is not None))

    def make_layers(self) -> None:
        """Make the surfaces, layer by layer."""
        limit = self.filter.GetTimeLimit()
        for number, layer in enumerate(self.layers):
            own = [each for each in self.surfaces if each.labels[0].layer == number]
            if own and not messages.was_interrupted():
                if limit > 0:
                    self.filter.SetTimeLimit(max(limit - self.seconds, LEAST_TIME))
                self.filter.SetInputData(layer)
                self.make_own(own)

    def make_own(self, own: Sequence[LabelSurface]) -> None:
        """Make the surfaces of the labels of one layer."""
        self.filter.ClearLabels()
        for each in own:
            for label in each.labels:
                self.filter.AddLabel(label.label)
        with naming(self.options.volume):
            run = messages.run(self.filter, "Making surfaces", self.teller, in_words_of_options)
        self.seconds += run.seconds
        blocks = self.filter.GetOutputDataObject(0)
        lost = in_words_of_options(geometry.fact(blocks, "LostLabels"))
        # A large loss is among the warnings.
        for text in [*run.warnings] + [lost] * (not any(lost in text for text in run.warnings)):
            if text:
                self.warn(text)
        for i, each in enumerate(own[:blocks.GetNumberOfBlocks()]):
            each.seconds, each.surface = self.filter.GetSeconds(i), blocks.GetBlock(i)
            each.name = blocks.GetMetaData(i).Get(blocks.NAME()) or each.name

    def finish(self) -> None:
        """Cut surfaces at the border of the volume (--ends), and probe other volumes (--probe)."""
        from .ends import with_ends
        probes = geometry.Probes(self.options, self.loaded.world, self.teller)
        for each in self.surfaces:
            warnings: list[str] = []
            each.surface = with_ends(each.surface, self.loaded.image, self.options.ends, warnings)
            for text in warnings:
                self.warn(f"{each.name}: {text}")
        interfaces = self.filter.GetInterfaces()
        surfaces = [each.surface for each in self.surfaces]
        probes.add_to(*surfaces, interfaces)
        for surface in [*surfaces, interfaces]:
            geometry.mark_space(surface, self.loaded.world)
        self.solids = make_solids(self.options, self.filters, probes, self.seconds)

    def write(self) -> None:
        """Write surfaces and report. Throw Failure if not all could be written."""
        failures = files.Failures()
        for name in self.options.surfaces:
            form = form_of(self.options, name)
            if form in ("folder", "file"):
                self.write_files(name, form, failures)
            else:
                with failures.collect(), self.teller.progress(f"Writing {name}") as progress:
                    self.write_together(name, form, progress)
        if self.options.report:
            with failures.collect():
                files.write_text(self.report_text(), self.options.report)
        failures.throw()

    def write_together(self, name: str, form: str, progress: messages.Progress) -> None:
        """Write all surfaces to one file."""
        tell = self.teller.warn
        if form == "interfaces":  # All are made at once: they are as finished as the first.
            writing.write_surface(self.filter.GetInterfaces(), name, self.surfaces[0].remark,
                                  self.solids, tell, progress)
        elif writing.is_scene(name):
            writing.write_scene([(each.name, each.surface) for each in self.surfaces], name, tell,
                                progress)
        else:
            from vtkmodules.vtkCommonDataModel import vtkMultiBlockDataSet
            blocks = vtkMultiBlockDataSet()
            for i, each in enumerate(self.surfaces):
                blocks.SetBlock(i, each.surface)
                blocks.GetMetaData(i).Set(blocks.NAME(), each.name)
            writing.write_blocks(blocks, name, tell, progress)

    def write_files(self, name: str, form: str, failures: files.Failures) -> None:
        """Write a file for each surface, and report those of earlier runs in the folder."""
        folder, paths = (name, self.paths(name)) if form == "folder" else (None, [name])
        with files.made_folder(name) if folder else contextlib.nullcontext(), \
                self.teller.progress(f"Writing {name}") as progress:
            for i, (each, path) in enumerate(zip(self.surfaces, paths)):
                progress(i / len(paths), path)
                if each.is_there:
                    with failures.collect():
                        writing.write_surface(each.surface, path, f"{each.remark}, {each.name}",
                                              self.solids, self.teller.warn)
                        each.files.append(path)
        old = folder and old_files(folder, [path for each in self.surfaces for path in each.files],
                                   suffix_in_folder(self.options))
        if old:
            self.warn(old)

    def report_text(self) -> str:
        """The report as JSON, `labels` with an object for each surface."""
        facts = {"input": report.input_facts(self.options.volume, self.loaded),
                 "finished": self.is_finished, "labels": list(map(_facts, self.surfaces))}
        interfaces = self.filter.GetInterfaces()
        angle, position, contacts = (report.values_of(interfaces, name) for name in (
            "WorstAngle", "WorstAnglePosition", "SmallContacts"))
        if angle is not None:
            facts.update(small_contacts=int(contacts[0, 0]), worst_angle=angle[0, 0],
                         worst_angle_position=position[0].tolist())
        if shares_interfaces(self.options):
            facts.update(report.solid_facts(self.solids.last))
        facts["seconds"] = {"surface": self.seconds}
        facts["memory"] = {"reader": self.reader_memory, "peak": report.peak_memory()}
        facts["properties"] = report.property_values(self.filters, is_of_labels)
        return report.ended(facts, self.warnings)

    @property
    def is_finished(self) -> bool:
        """Whether nothing stopped any surface."""
        return not any(each.unfinished for each in self.surfaces)

    def tell_end(self) -> None:
        """Print what was made and what is missing."""
        there = [each for each in self.surfaces if each.is_there]
        wrong = sum(_count(each.surface, "WrongVoxels") for each in self.surfaces)
        vertices = sum(each.surface.GetNumberOfPoints() for each in there)
        self.teller.say(f"{len(there)} surface{'s' * (len(there) != 1)}, {vertices} vertices"
                        + (f"; {wrong} voxel centres are on the wrong side" if wrong else ""))
        stopped = [each for each in self.surfaces if each.unfinished]
        if stopped:
            missing = ", ".join(each.name for each in stopped if not each.is_there)
            partial = ", ".join(each.name for each in stopped if each.is_there)
            self.teller.error(
                f"unfinished ({stopped[-1].unfinished}); what is finished was written"
                + (f"; there is no surface of {missing}" if missing else "")
                + (f"; as they were then, those of {partial}" if partial else ""))
        self.teller.say(report.text_of_print(
            prints(self.options, self.options.surfaces), [each.surface for each in there],
            self.loaded.world.unit))
        if shares_interfaces(self.options):
            self.teller.say(report.text_of_solid(self.solids.last))


def segment_labels(options: Namespace, filters: Filters, teller: Teller) -> int:
    """Do what the command line requests of a label map; return the exit code."""
    shared = shares_interfaces(options)
    filters.labels.SetSharedInterfaces(shared)
    # Masks that overlap stay whole where each has a surface of its own.
    options.choice.layers = not shared and not filters.labels.GetMerge()
    check_files(options)
    loaded = geometry.load_volume(options, filters, teller, announce=False)
    run = LabelRun(options, filters, loaded, teller)
    if options.write_volume:
        writing.write_volume(loaded.image, options.write_volume)
    if not wants_surface(options):
        return DONE
    run.announce()
    if options.list_labels:
        run.list_labels()
        return DONE
    run.plan()
    run.check_surfaces()
    messages.hold_signals()
    run.make()
    run.finish()
    run.write()
    run.tell_end()
    return DONE if run.is_finished else UNFINISHED


def _no_surface() -> Any:
    """Of a label whose turn has not come."""
    from vtkmodules.vtkCommonDataModel import vtkPolyData
    surface = vtkPolyData()
    geometry.set_fact(surface, "StopReason", "cancelled")
    return surface


def _count(surface: Any, name: str, otherwise: int = 0) -> int:
    values = report.values_of(surface, name)
    return otherwise if values is None or not values.size else int(values[0, 0])


def _facts(each: LabelSurface) -> dict[str, Any]:
    """The object of a surface in the report."""
    labels, surface = each.labels, each.surface
    error = report.values_of(surface, "VolumeError")
    return {
        **({"label": labels[0].label} if len(labels) == 1 else {}),
        "labels": [label.label for label in labels], "name": each.name,
        "color": labels[0].color, "layer": labels[0].layer,
        "voxels": _count(surface, "LabelVoxels", sum(label.voxels for label in labels)),
        "files": each.files, "seconds": each.seconds,
        "wrong_voxels": _count(surface, "WrongVoxels"),
        **({} if error is None else {"volume_error": error[0, 0]}),
        "missed_voxels": _count(surface, "MissedVoxels"), **report.surface_facts(surface),
        "component_features": report.component_features(surface)}
