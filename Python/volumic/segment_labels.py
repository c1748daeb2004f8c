# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The command for label maps: select labels, compute their surfaces, write them."""

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
from .messages import Console
from .option_tables import Filters, applies_to_labels
from .options import has_property, with_option_names, needs_surface
from .reading.volume import Label
from .segment import (
    DONE, NO_RESULT, UNFINISHED, check_files, inputs_of, make_mesher, other_outputs)
from .triangles import find_triangles
from .writing import files

STOPPED = "time limit", "cancelled"  # values of StopReason
MINIMUM_TIME = 1e-3  # seconds for a layer after the time limit

# ---- Names of files ------------------------------------------------------------------------------

def kind_of(name: str) -> str:
    """Return the kind of an output name: `folder` (a file per label), `blocks` (a file with a block
    or object per label), `mesh` (one mesh of all labels) or `file` (one surface)."""
    suffix = os.path.splitext(name)[1].lower()
    if name.endswith("/") or not suffix or os.path.isdir(name):
        return "folder"
    if suffix == ".vtm" or writing.is_scene(name):
        return "blocks"
    return "mesh" if suffix in (".vtp", ".vtk") or writing.holds_volume_mesh(name) else "file"


def makes_mesh(options: Namespace) -> bool:
    return not has_property(options, "Merge") and "mesh" in map(kind_of, options.surfaces)


def suffix_in_folder(options: Namespace) -> str:
    return "." + (options.format or "vtp").lstrip(".")


def check_outputs(options: Namespace) -> None:
    """Raise UsageError if the surfaces cannot be written to the given names."""
    names = options.surfaces
    kinds = [kind_of(name) for name in names]
    for name, kind in zip(names, kinds):
        is_new = kind == "folder" and name[-1] not in "-/" and not os.path.isdir(name)
        if is_new and (len(names) > 1 or re.fullmatch("[+-]?[0-9]+(-[+-]?[0-9]+)?", name)):
            raise UsageError(f"'{name}' is not a file name; separate labels by commas (--labels "
                             f"{options.labels[-1]},{name}) or end a folder with a slash "
                             f"({name}/)")
        if name == "-":
            raise UsageError("surfaces of labels cannot be written to the standard output; give a "
                             "file or folder")
        if kind == "folder" and has_property(options, "Merge"):
            raise UsageError(f"{name}: --merge yields one surface; give a file instead of a folder")
        if kind != "blocks":
            writing.check_surface_name(
                "labels" + suffix_in_folder(options) if kind == "folder" else name)
    if options.format and names and "folder" not in kinds:
        raise UsageError("--format requires a folder as output; the suffix of "
                         f"{names[0]} determines its format")


def output_of(name: str) -> files.OutputName:
    """Return the OutputName of a name, before the labels are known."""
    return files.OutputName(name, "label-folder" if kind_of(name) == "folder" else
                            "blocks" if name.lower().endswith(".vtm") else "file")


# ---- The run -------------------------------------------------------------------------------------

@dataclasses.dataclass
class LabelSurface:
    """Surface of one label, or, with --merge, of several."""
    labels: list[KnownLabel]
    name: str
    surface: Any = dataclasses.field(default_factory=vtkPolyData)
    files: list[str] = dataclasses.field(default_factory=list)  # written for this surface alone

    def __post_init__(self) -> None:
        geometry.set_field_text(self.surface, "StopReason", "cancelled")  # until computed

    @property
    def is_present(self) -> bool:
        return self.surface.GetNumberOfPoints() > 0

    def count(self, name: str, default: int = 0) -> int:
        return report.field_values(self.surface, {name: name}).get(name, default)

    def summary(self) -> dict[str, Any]:
        first, *others = self.labels
        return {
            **({} if others else {"label": first.label}),
            "labels": [label.label for label in self.labels], "name": self.name,
            "color": first.color, "layer": first.layer,
            "voxels": self.count("LabelVoxels", sum(label.voxels for label in self.labels)),
            "files": self.files, **report.surface_summary(self.surface),
            "component_features": report.component_features(self.surface)}


@contextlib.contextmanager
def prefix_failures(path: str) -> Iterator[None]:
    try:
        yield
    except Failure as failure:
        raise type(failure)(f"{path}: {str(failure).removeprefix('the volume: ')}") from None


class LabelRun:
    """One run of the filter on a label map."""

    def __init__(self, options: Namespace, filters: Filters, loaded: geometry.LoadedVolume,
                 names: Sequence[Label], console: Console) -> None:
        self.options, self.loaded, self.console = options, loaded, console
        self.filters, self.filter = filters, filters.labels
        self.surfaces: list[LabelSurface] = []
        self.meshes: list[Any] = []  # of each layer, interfaces stored once
        self.seconds, self.reader_memory = 0.0, report.peak_memory()
        component = (filters.surface.GetSelectedComponent()
                     if has_property(options, "SelectedComponent") else None)
        background = self.filter.GetBackgroundLabel()
        with prefix_failures(options.volume):
            self.layers = layers_of(loaded.image, names, component)
            known, self.warnings = known_labels(self.layers, names, options, console)
            count, layers = sum(label.label != background for label in known), len(self.layers)
            console.info(f"{options.volume}: {loaded.text}, {count} label{'s' * (count != 1)}"
                         + f" in {layers} layers" * (layers > 1) + loaded.world.text())
            self.chosen = choose(options.labels, known, background)

    def warn(self, text: str) -> None:
        self.console.warn(text)
        self.warnings.append(text)

    def list_labels(self) -> None:
        """Print the selected labels and write them to the report."""
        spacing = self.loaded.image.GetSpacing()
        if self.options.report:
            summary = {"input": report.input_summary(self.options.volume, self.loaded),
                       "labels": list_rows(self.chosen, spacing)}
            files.write_text(report.finish(summary, self.warnings), self.options.report)
        if self.options.report != "-":
            sys.stdout.write(table_of(self.chosen, spacing, len(self.layers)))

    def plan(self) -> None:
        """Determine the surfaces. Raise Failure if they cannot be computed or written."""
        chosen, options, outputs = self.chosen, self.options, []
        if not chosen:
            raise Failure(
                f"{options.volume}: the only label is the background, "
                f"{self.filter.GetBackgroundLabel()}; choose another background with --background")
        is_merged = self.filter.GetMerge()
        if (is_merged or makes_mesh(options)) and len({each.layer for each in chosen}) > 1:
            raise Failure("the labels are in several layers of the file, but one mesh requires one "
                          "layer; choose it with --component, or give a folder (OUT/)")
        self.surfaces = [LabelSurface(group, group[0].name) for group in (
            [chosen] if is_merged else [[label] for label in chosen])]
        if "probe-depth" in options.given and makes_mesh(options) and len(chosen) > 1:
            raise Failure("--probe-depth requires normals, which the mesh of several labels "
                          "lacks; give a folder (OUT/)")
        for name in options.surfaces:
            kind, (stem, suffix) = kind_of(name), os.path.splitext(name)
            if kind == "file" and len(self.surfaces) > 1:
                raise Failure(
                    f"{name}: a {suffix} file stores one surface, not {len(self.surfaces)}; give "
                    f"a folder ({stem}/ --format {suffix[1:].lower()}), a file with several "
                    f"surfaces ({stem}.vtm, .glb, .3mf) or with one mesh of all labels "
                    f"({stem}.vtp, .vtk, .vtu, .inp, .msh, .smesh, .poly), or set --merge")
            outputs += [files.OutputName(path) for path in self.paths(name, kind)
                        if kind != "folder" or os.path.isdir(name)]
        files.check_outputs(outputs + other_outputs(options), inputs_of(options))

    def paths(self, name: str, kind: str) -> list[str]:
        """Return the files that are written for an output name."""
        return [name] if kind != "folder" else [
            os.path.join(name, each.labels[0].file_name + suffix_in_folder(self.options))
            for each in self.surfaces]

    def compute(self) -> None:
        """Compute the surfaces. Raise Failure if all are empty."""
        if self.options.triangles:
            find_triangles(self.compute_with, self.options.triangles,
                           min(self.loaded.image.GetSpacing()), self.console)
        else:
            self.compute_layers()
        if not any(each.is_present for each in self.surfaces):
            if self.unfinished:
                raise Interrupted(("time limit reached" if self.unfinished == "time limit"
                                   else "interrupted") + " before " + NO_RESULT)
            raise Failure(f"{self.options.volume}: the surfaces of all labels are empty; check "
                          "--keep and --minimum-component-volume")

    def compute_with(self, edge_length: float, tolerance: float) -> tuple[int, float]:
        """Compute the surfaces. Return the number of triangles to write and the total area."""
        self.filter.SetEdgeLength(edge_length)
        self.filter.SetTolerance(tolerance)
        self.compute_layers()
        whole = self.meshes if self.writes_mesh else [each.surface for each in self.surfaces]
        return (sum(surface.GetNumberOfPolys() for surface in whole),
                sum(each.count("Area") for each in self.surfaces))

    def compute_layers(self) -> None:
        limit, self.meshes = self.filter.GetTimeLimit(), []
        for number, layer in enumerate(self.layers):
            own = [each for each in self.surfaces if each.labels[0].layer == number]
            if not own or messages.was_interrupted():
                continue
            if limit > 0:
                self.filter.SetTimeLimit(max(limit - self.seconds, MINIMUM_TIME))
            self.filter.SetInputData(layer)
            self.filter.ClearLabels()
            for label in (label for each in own for label in each.labels):
                self.filter.AddLabel(label.label)
            with prefix_failures(self.options.volume):
                run = messages.run(self.filter, "Computing surfaces", self.console,
                                   with_option_names)
            self.seconds += run.seconds
            blocks = self.filter.GetOutputDataObject(0)
            missed = with_option_names(geometry.field_text(blocks, "LostLabels"))
            for text in [*run.warnings] + [missed] * (missed not in " ".join(run.warnings)):
                self.warn(text)
            self.meshes.append(vtkPolyData())
            self.meshes[-1].ShallowCopy(self.filter.GetInterfaces())
            for i, each in enumerate(own[:blocks.GetNumberOfBlocks()]):
                each.surface = blocks.GetBlock(i)
                each.name = blocks.GetMetaData(i).Get(blocks.NAME()) or each.name

    def finish(self) -> None:
        """Apply --ends and --probe."""
        from .ends import with_ends
        probes = geometry.Probes(self.options, self.loaded.world, self.console)
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
        self.mesher = make_mesher(self.options, self.filters, probes, self.seconds)

    def write(self) -> None:
        """Write surfaces and report. Raise Failure if a file cannot be written."""
        failures = files.Failures()
        for name in self.options.surfaces:
            kind = kind_of(name)
            with self.console.progress(f"Writing {name}") as progress:
                if kind in ("folder", "file") or (kind == "mesh" and not self.writes_mesh):
                    self.write_files(name, kind, failures, progress)
                    continue
                with failures.collect():
                    self.write_together(name, kind, progress)
        if self.options.report:
            with failures.collect():
                files.write_text(self.report_text(), self.options.report)
        failures.raise_all()

    def write_together(self, name: str, kind: str, progress: messages.Progress) -> None:
        if kind == "mesh":
            writing.write_surface(self.meshes[0], name, self.remark, self.mesher, self.console.warn,
                                  progress)
        elif writing.is_scene(name):
            writing.write_scene([(each.name, each.surface) for each in self.surfaces], name,
                                self.console.warn, progress)
        else:
            blocks = vtkMultiBlockDataSet()
            for i, each in enumerate(self.surfaces):
                blocks.SetBlock(i, each.surface)
                blocks.GetMetaData(i).Set(blocks.NAME(), each.name)
            writing.write_blocks(blocks, name, self.console.warn, progress)

    def write_files(self, name: str, kind: str, failures: files.Failures,
                    progress: messages.Progress) -> None:
        """Write a file per surface. Warn of files of earlier runs in the folder."""
        paths = self.paths(name, kind)
        with files.created_folder(name) if kind == "folder" else contextlib.nullcontext():
            for i, (each, path) in enumerate(zip(self.surfaces, paths)):
                progress(i / len(paths), path)
                if each.is_present:
                    with failures.collect():
                        writing.write_surface(each.surface, path, f"{self.remark}, {each.name}",
                                              self.mesher, self.console.warn)
                        each.files.append(path)
        if kind == "folder":
            written = [os.path.basename(path) for each in self.surfaces for path in each.files]
            writing.warn_obsolete(name, written, self.warn, suffix=suffix_in_folder(self.options))

    def report_text(self) -> str:
        mesh = self.meshes[0] if len(self.meshes) == 1 else vtkPolyData()
        return report.finish({
            "input": report.input_summary(self.options.volume, self.loaded),
            "finished": not self.unfinished, "labels": [each.summary() for each in self.surfaces],
            **report.field_values(mesh, report.INTERFACE_FIELDS),
            **report.tetrahedra_summary(self.tetrahedra),
            "seconds": {"surface": self.seconds},
            "memory": {"reader": self.reader_memory, "peak": report.peak_memory()},
            "properties": report.property_values(self.filters, applies_to_labels)}, self.warnings)

    @property
    def writes_mesh(self) -> bool:
        return makes_mesh(self.options) and len(self.surfaces) > 1

    @property
    def tetrahedra(self) -> Any:
        """The tetrahedral mesh of all labels, or None."""
        return self.mesher.last if "mesh" in map(kind_of, self.options.surfaces) else None

    @property
    def unfinished(self) -> str:
        """Stop reason of an unfinished run, otherwise empty."""
        reasons = [geometry.field_text(each.surface, "StopReason") for each in self.surfaces]
        return next((reason for reason in STOPPED if reason in reasons), "")

    @property
    def remark(self) -> str:
        return f", UNFINISHED: {self.unfinished}" if self.unfinished else ""

    def print_summary(self) -> None:
        there = [each for each in self.surfaces if each.is_present]
        wrong = sum(each.count("WrongVoxels") for each in self.surfaces)
        vertices = sum(each.surface.GetNumberOfPoints() for each in there)
        self.console.info(f"{len(there)} surface{'s' * (len(there) != 1)}, {vertices} vertices"
                          + f"; {wrong} misclassified voxels" * (wrong > 0))
        if self.unfinished:
            self.console.error(f"unfinished ({self.unfinished}): the current surfaces were written")
        self.console.info(report.describe_print(
            self.options, [each.surface for each in there], self.loaded.world.unit))
        self.console.info(report.describe_tetrahedra(self.tetrahedra))


def segment_labels(options: Namespace, filters: Filters, console: Console) -> int:
    """Run the command on a label map. Return the exit code."""
    if options.ends != "closed" and not has_property(options, "BoxFaces"):
        filters.labels.SetBoxFacesToFlat()  # caps are planar
    # Overlapping masks are read to separate layers if each label gets its own surface.
    options.choice.layers = not makes_mesh(options) and not filters.labels.GetMerge()
    check_files(options, [output_of(name) for name in options.surfaces])
    loaded = geometry.load_volume(options, filters, console, announce=False)
    names = name_labels(options, loaded.volume, loaded.image, console)
    if options.write_volume:
        writing.write_volume(loaded.image, options.write_volume)
    if not needs_surface(options):
        return DONE
    run = LabelRun(options, filters, loaded, names, console)
    if options.list_labels:
        run.list_labels()
        return DONE
    run.plan()
    messages.defer_signals()
    run.compute()
    run.finish()
    run.write()
    run.print_summary()
    return UNFINISHED if run.unfinished else DONE
