# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The command on a label map: choose labels, make their surfaces, write them."""

from __future__ import annotations

import contextlib
import dataclasses
import os
import re
import sys
from argparse import Namespace
from collections.abc import Iterator, Sequence
from typing import Any

from vtkmodules.vtkCommonDataModel import vtkMultiBlockDataSet, vtkPolyData

from . import geometry, messages, report, writing
from .errors import Failure, Interrupted, UsageError
from .label_map import (
    KnownLabel, choose, known_labels, layers_of, list_rows, name_labels, table_of)
from .messages import Teller
from .option_tables import Filters, is_of_labels
from .options import has_property, in_words_of_options, wants_surface
from .reading.volume import Label
from .segment import (
    DONE, NOTHING, UNFINISHED, check_files, inputs_of, make_solids, other_outputs, prints)
from .triangles import find_triangles
from .writing import files

STOPPED = "time limit", "cancelled"  # values of StopReason
LEAST_TIME = 1e-3  # seconds of a layer where the others have used the time limit up

# ---- Names of files ------------------------------------------------------------------------------

def form_of(name: str) -> str:
    """What a name requests: a `folder` of files, `blocks` or a scene of all surfaces, a `mesh` of
    all labels, or a `file` of one surface."""
    suffix = os.path.splitext(name)[1].lower()
    if name.endswith("/") or not suffix or os.path.isdir(name):
        return "folder"
    if suffix == ".vtm" or writing.is_scene(name):
        return "blocks"
    return "mesh" if suffix in (".vtp", ".vtk") or writing.is_of_solids(name) else "file"


def makes_mesh(options: Namespace) -> bool:
    """Whether a file of the mesh of all labels is requested."""
    return not has_property(options, "Merge") and "mesh" in map(form_of, options.surfaces)


def suffix_in_folder(options: Namespace) -> str:
    """The suffix of the files in a folder, with a dot."""
    return "." + (options.format or "vtp").lstrip(".")


def check_outputs(options: Namespace) -> None:
    """Throw UsageError if surfaces of labels cannot be written to the names of the options."""
    names = options.surfaces
    forms = [form_of(name) for name in names]
    for name, form in zip(names, forms):
        is_new = form == "folder" and name[-1] not in "-/" and not os.path.isdir(name)
        if is_new and (len(names) > 1 or re.fullmatch("[+-]?[0-9]+(-[+-]?[0-9]+)?", name)):
            raise UsageError(f"'{name}' is not the name of a file; write a list of labels with "
                             f"commas (--labels {options.labels[-1]},{name}), a folder with a "
                             f"slash ({name}/)")
        if name == "-":
            raise UsageError("surfaces of labels are not written to the standard output")
        if form == "folder" and has_property(options, "Merge"):
            raise UsageError(f"{name}: --merge makes one surface; give a file, not a folder")
        if form != "blocks":
            writing.check_surface_name(
                "labels" + suffix_in_folder(options) if form == "folder" else name)
    if options.format and names and "folder" not in forms:
        raise UsageError("--format is that of the files in a folder; the format of "
                         f"{names[0]} is its suffix")


def output_of(name: str) -> files.OutputName:
    """What is known about an output before the volume is read."""
    return files.OutputName(name, "place" if form_of(name) == "folder" else
                            "blocks" if name.lower().endswith(".vtm") else "file")


# ---- The run -------------------------------------------------------------------------------------

@dataclasses.dataclass
class LabelSurface:
    """A surface of one label, or, with --merge, of several."""
    labels: list[KnownLabel]
    name: str
    surface: Any = dataclasses.field(default_factory=vtkPolyData)  # empty: there is none
    files: list[str] = dataclasses.field(default_factory=list)  # that were written of it alone

    def __post_init__(self) -> None:
        geometry.set_fact(self.surface, "StopReason", "cancelled")  # until its turn comes

    @property
    def is_there(self) -> bool:
        """Whether it has points."""
        return self.surface.GetNumberOfPoints() > 0

    def count(self, name: str, otherwise: int = 0) -> int:
        """A number of the field data."""
        return report.facts_of(self.surface, {name: name}).get(name, otherwise)

    def facts(self) -> dict[str, Any]:
        """The object of the surface in the report."""
        first, *others = self.labels
        return {
            **({} if others else {"label": first.label}),
            "labels": [label.label for label in self.labels], "name": self.name,
            "color": first.color, "layer": first.layer,
            "voxels": self.count("LabelVoxels", sum(label.voxels for label in self.labels)),
            "files": self.files, **report.surface_facts(self.surface),
            "component_features": report.component_features(self.surface)}


@contextlib.contextmanager
def naming(path: str) -> Iterator[None]:
    """Failures name the file."""
    try:
        yield
    except Failure as failure:
        raise type(failure)(f"{path}: {failure}") from None


class LabelRun:
    """One run: the map, its labels, their surfaces."""

    def __init__(self, options: Namespace, filters: Filters, loaded: geometry.LoadedVolume,
                 names: Sequence[Label], teller: Teller) -> None:
        self.options, self.loaded, self.teller = options, loaded, teller
        self.filters, self.filter = filters, filters.labels
        self.surfaces: list[LabelSurface] = []
        self.meshes: list[Any] = []  # of the labels of each layer, with interfaces once
        self.seconds, self.reader_memory = 0.0, report.peak_memory()
        component = (filters.surface.GetSelectedComponent()
                     if has_property(options, "SelectedComponent") else None)
        background = self.filter.GetBackgroundLabel()
        with naming(options.volume):
            self.layers = layers_of(loaded.image, names, component)
            known, self.warnings = known_labels(self.layers, names, options, teller)
            count, layers = sum(label.label != background for label in known), len(self.layers)
            teller.say(f"{options.volume}: {loaded.text}, {count} label{'s' * (count != 1)}"
                       + f" in {layers} layers" * (layers > 1) + loaded.world.text())
            self.chosen = choose(options.labels, known, background)

    def warn(self, text: str) -> None:
        """Print a warning, and keep it for the report."""
        self.teller.warn(text)
        self.warnings.append(text)

    def list_labels(self) -> None:
        """Print the chosen labels, and write them to the report."""
        spacing = self.loaded.image.GetSpacing()
        if self.options.report:
            facts = {"input": report.input_facts(self.options.volume, self.loaded),
                     "labels": list_rows(self.chosen, spacing)}
            files.write_text(report.ended(facts, self.warnings), self.options.report)
        if self.options.report != "-":
            sys.stdout.write(table_of(self.chosen, spacing, len(self.layers)))

    def plan(self) -> None:
        """List the surfaces to make. Throw Failure if they cannot be made or written."""
        chosen, options, outputs = self.chosen, self.options, []
        if not chosen:
            raise Failure(
                f"{options.volume}: it has no label but the background, "
                f"{self.filter.GetBackgroundLabel()}; choose another one with --background")
        is_merged = self.filter.GetMerge()
        if (is_merged or makes_mesh(options)) and len({each.layer for each in chosen}) > 1:
            raise Failure("the labels lie in several layers of the file, which one mesh cannot "
                          "hold; choose one layer with --component, or give a folder (OUT/)")
        self.surfaces = [LabelSurface(group, group[0].name) for group in (
            [chosen] if is_merged else [[label] for label in chosen])]
        if "probe-depth" in options.given and makes_mesh(options) and len(chosen) > 1:
            raise Failure("--probe-depth: the mesh of several labels has no normals; give a "
                          "folder (OUT/)")
        for name in options.surfaces:
            form, (stem, suffix) = form_of(name), os.path.splitext(name)
            if form == "file" and len(self.surfaces) > 1:
                raise Failure(
                    f"{name}: {len(self.surfaces)} labels have as many surfaces: give a folder "
                    f"({stem}/ --format {suffix[1:].lower()}) or blocks ({stem}.vtm, {stem}.glb, "
                    f"{stem}.3mf), one mesh of all ({stem}.vtp, .vtk, .vtu, .inp, .msh, .smesh, "
                    ".poly), or one surface around all with --merge")
            outputs += [files.OutputName(path) for path in self.paths(name, form)
                        if form != "folder" or os.path.isdir(name)]
        files.check_outputs(outputs + other_outputs(options), inputs_of(options))

    def paths(self, name: str, form: str) -> list[str]:
        """The files that are written to a name."""
        return [name] if form != "folder" else [
            os.path.join(name, each.labels[0].file_name + suffix_in_folder(self.options))
            for each in self.surfaces]

    def make(self) -> None:
        """Make the surfaces. Throw Failure if there is none at the end."""
        if self.options.triangles:
            find_triangles(self.make_with, self.options.triangles,
                           min(self.loaded.image.GetSpacing()), self.teller)
        else:
            self.make_layers()
        if not any(each.is_there for each in self.surfaces):
            if self.unfinished:
                raise Interrupted(("the time limit came" if self.unfinished == "time limit"
                                   else "interrupted") + " before " + NOTHING)
            raise Failure(f"{self.options.volume}: none of the labels has a surface "
                          "(--keep, --minimum-component-volume)")

    def make_with(self, edge_length: float, tolerance: float) -> tuple[int, float]:
        """Make the surfaces; return the triangles of the files to write, and their area."""
        self.filter.SetEdgeLength(edge_length)
        self.filter.SetTolerance(tolerance)
        self.make_layers()
        whole = self.meshes if self.writes_mesh else [each.surface for each in self.surfaces]
        return (sum(surface.GetNumberOfPolys() for surface in whole),
                sum(each.count("Area") for each in self.surfaces))

    def make_layers(self) -> None:
        """Make the surfaces, layer by layer."""
        limit, self.meshes = self.filter.GetTimeLimit(), []
        for number, layer in enumerate(self.layers):
            own = [each for each in self.surfaces if each.labels[0].layer == number]
            if not own or messages.was_interrupted():
                continue
            if limit > 0:
                self.filter.SetTimeLimit(max(limit - self.seconds, LEAST_TIME))
            self.filter.SetInputData(layer)
            self.filter.ClearLabels()
            for label in (label for each in own for label in each.labels):
                self.filter.AddLabel(label.label)
            with naming(self.options.volume):
                run = messages.run(self.filter, "Making surfaces", self.teller, in_words_of_options)
            self.seconds += run.seconds
            blocks = self.filter.GetOutputDataObject(0)
            lost = in_words_of_options(geometry.fact(blocks, "LostLabels"))
            for text in [*run.warnings] + [lost] * (lost not in " ".join(run.warnings)):
                self.warn(text)
            self.meshes.append(vtkPolyData())
            self.meshes[-1].ShallowCopy(self.filter.GetInterfaces())
            for i, each in enumerate(own[:blocks.GetNumberOfBlocks()]):
                each.surface = blocks.GetBlock(i)
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
        surfaces = [each.surface for each in self.surfaces]
        if self.writes_mesh:
            self.meshes = [with_ends(mesh, self.loaded.image, self.options.ends, [])
                           for mesh in self.meshes]
            surfaces += self.meshes
        probes.add_to(*surfaces)
        for surface in surfaces:
            geometry.mark_space(surface, self.loaded.world)
        self.solids = make_solids(self.options, self.filters, probes, self.seconds)

    def write(self) -> None:
        """Write surfaces and report. Throw Failure if not all could be written."""
        failures = files.Failures()
        for name in self.options.surfaces:
            form = form_of(name)
            with self.teller.progress(f"Writing {name}") as progress:
                if form in ("folder", "file") or (form == "mesh" and not self.writes_mesh):
                    self.write_files(name, form, failures, progress)
                    continue
                with failures.collect():
                    self.write_together(name, form, progress)
        if self.options.report:
            with failures.collect():
                files.write_text(self.report_text(), self.options.report)
        failures.throw()

    def write_together(self, name: str, form: str, progress: messages.Progress) -> None:
        """Write all surfaces to one file."""
        if form == "mesh":
            writing.write_surface(self.meshes[0], name, self.remark, self.solids, self.teller.warn,
                                  progress)
        elif writing.is_scene(name):
            writing.write_scene([(each.name, each.surface) for each in self.surfaces], name,
                                self.teller.warn, progress)
        else:
            blocks = vtkMultiBlockDataSet()
            for i, each in enumerate(self.surfaces):
                blocks.SetBlock(i, each.surface)
                blocks.GetMetaData(i).Set(blocks.NAME(), each.name)
            writing.write_blocks(blocks, name, self.teller.warn, progress)

    def write_files(self, name: str, form: str, failures: files.Failures,
                    progress: messages.Progress) -> None:
        """Write a file for each surface, and report those of earlier runs in the folder."""
        paths = self.paths(name, form)
        with files.made_folder(name) if form == "folder" else contextlib.nullcontext():
            for i, (each, path) in enumerate(zip(self.surfaces, paths)):
                progress(i / len(paths), path)
                if each.is_there:
                    with failures.collect():
                        writing.write_surface(each.surface, path, f"{self.remark}, {each.name}",
                                              self.solids, self.teller.warn)
                        each.files.append(path)
        if form == "folder":
            written = [os.path.basename(path) for each in self.surfaces for path in each.files]
            writing.report_old(name, written, self.warn, suffix=suffix_in_folder(self.options))

    def report_text(self) -> str:
        """The report as JSON, `labels` with an object for each surface."""
        mesh = self.meshes[0] if len(self.meshes) == 1 else vtkPolyData()
        return report.ended({
            "input": report.input_facts(self.options.volume, self.loaded),
            "finished": not self.unfinished, "labels": [each.facts() for each in self.surfaces],
            **report.facts_of(mesh, report.INTERFACE_FACTS),
            **report.solid_facts(self.solid),
            "seconds": {"surface": self.seconds},
            "memory": {"reader": self.reader_memory, "peak": report.peak_memory()},
            "properties": report.property_values(self.filters, is_of_labels)}, self.warnings)

    @property
    def writes_mesh(self) -> bool:
        """Whether a file gets the mesh of several labels."""
        return makes_mesh(self.options) and len(self.surfaces) > 1

    @property
    def solid(self) -> Any:
        """The tetrahedra of a file of their own, if there are any."""
        return self.solids.last if "mesh" in map(form_of, self.options.surfaces) else None

    @property
    def unfinished(self) -> str:
        """What stopped the run; empty if nothing did."""
        reasons = [report.stop_reason(each.surface) for each in self.surfaces]
        return next((reason for reason in STOPPED if reason in reasons), "")

    @property
    def remark(self) -> str:
        """For the heads of files."""
        return f", UNFINISHED: {self.unfinished}" if self.unfinished else ""

    def print_end(self) -> None:
        """Print what was made."""
        there = [each for each in self.surfaces if each.is_there]
        wrong = sum(each.count("WrongVoxels") for each in self.surfaces)
        vertices = sum(each.surface.GetNumberOfPoints() for each in there)
        self.teller.say(f"{len(there)} surface{'s' * (len(there) != 1)}, {vertices} vertices"
                        + f"; {wrong} misclassified voxels" * (wrong > 0))
        if self.unfinished:
            self.teller.error(f"unfinished ({self.unfinished}); the surfaces as they are were "
                              "written")
        self.teller.say(report.text_of_print(
            prints(self.options, self.options.surfaces), [each.surface for each in there],
            self.loaded.world.unit))
        self.teller.say(report.text_of_solid(self.solid))


def segment_labels(options: Namespace, filters: Filters, teller: Teller) -> int:
    """Do what the command line requests of a label map; return the exit code."""
    if options.ends != "closed" and not has_property(options, "BoxFaces"):
        filters.labels.SetBoxFacesToFlat()  # the planes of the caps
    # Masks that overlap stay whole where each has a surface of its own.
    options.choice.layers = not makes_mesh(options) and not filters.labels.GetMerge()
    check_files(options, [output_of(name) for name in options.surfaces])
    loaded = geometry.load_volume(options, filters, teller, announce=False)
    names = name_labels(options, loaded.volume, loaded.image, teller)
    if options.write_volume:
        writing.write_volume(loaded.image, options.write_volume)
    if not wants_surface(options):
        return DONE
    run = LabelRun(options, filters, loaded, names, teller)
    if options.list_labels:
        run.list_labels()
        return DONE
    run.plan()
    messages.hold_signals()
    run.make()
    run.finish()
    run.write()
    run.print_end()
    return UNFINISHED if run.unfinished else DONE
