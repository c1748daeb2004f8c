# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Surfaces of all labels of a map that is larger than memory, as tasks on crops.

    job = Job(volumic.ome_zarr.open("brain.zarr", label="cells"), "meshes")
    job.run()                                          # a loop
    job.run(executor.map)                              # concurrent.futures, processes
    job.run(lambda function, of: client.gather(client.map(function, of)))    # dask.distributed

`count` counts the labels of a block of the map, then `make` makes the surfaces of some labels. A
task leaves its result in the folder and returns nothing. A job that was killed resumes there, and a
task that runs twice finds its result.

Labels that lie near each other are a bundle, one task of `make`: a crop of the map with a margin
about the labels, of which one mesh is made, as of a map of its own. All labels in the crop are in
the mesh, so that the surfaces of the bundle fit to their neighbours; those of its own labels are
written. Results are bit-identical for any number of workers, after kills, and whichever labels are
made. Surfaces of different bundles are made of the same voxels, but do not share triangles. How
voxels connect that meet at edges only depends on the labels' numbers of voxels in the crop.
"""

from __future__ import annotations

import csv
import functools
import io
import itertools
import json
import math
import os
import shutil
import warnings
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from . import arrays, neuroglancer
from . import vtkFiltersVolumic as filters
from .arrays import Surface
from .writing.files import HIDDEN, replace_file
from .writing.surfaces import FORMATS

MARGIN = 4, 6  # of crops: so many standard deviations of the smoothing, and edge lengths
MOST = 4096  # labels of a bundle, as vtkLabelsToSurfaces makes at most
BLOCK = 256  # voxels along each axis that are counted at a time, at most
DETAILS = (1, 2, 3)  # FinestLevel of the coarser levels of detail: edges sqrt(3) times as long
PERIODIC = 2  # BoxFaces
Box = list[tuple[int, int]]  # [begin, end) of x, y and z


class Job:
    """The surfaces of the labels of one map, in one folder.

    Parameters
    ----------
    source : array-like
        The map, labels [z, y, x]: `shape`, `dtype` and slices, such as a zarr.Array, a volume of
        volumic.ome_zarr or a numpy.ndarray. Tasks in other processes get it pickled.
    folder : str
        Folder of the results, which all workers see. It is made in a folder that exists.
    spacing, origin : sequence of 3 floats, optional
        As of volumic.surface (default: those of `source`, if it has them).
    direction : array_like, optional
    only : sequence of ints, optional
        Labels to make (default: all but BackgroundLabel).
    formats : sequence of str, optional
        `.vtp`, `.ply`, `.stl`: files label-3.vtp. `precomputed` and `multilod_draco`: folders for
        Neuroglancer, the latter with four levels of detail, compressed.
    nanometers : float, optional
        Length of a world unit, for Neuroglancer (default: that of `source`, or 1).
    bundle : int, optional
        Voxels of a crop up to which labels that lie near each other are one task. Another number
        makes other bundles, and other triangles.
    most : int, optional
        Voxels of the largest crop, which bounds the memory. A label that needs a larger crop is
        refused.
    **properties
        Those of vtkLabelsToSurfaces. Workers with several tasks at a time share the processors by
        NumberOfThreads.
    """

    def __init__(self, source: Any, folder: str | os.PathLike[str], *,
                 spacing: Sequence[float] | None = None, origin: Sequence[float] | None = None,
                 direction: Any = None, only: Sequence[int] = (),
                 formats: Sequence[str] = (".vtp",), nanometers: float | None = None,
                 bundle: int = 1 << 24, most: int = 1 << 29, **properties: Any) -> None:
        arrays.check_properties("vtkLabelsToSurfaces", properties)
        if properties.get("Merge") or properties.get("BoxFaces") == PERIODIC:
            raise ValueError("Merge and periodic BoxFaces couple labels all over the map; apply "
                             "volumic.labels to the whole map")
        if properties.get("TimeLimit"):
            raise ValueError("TimeLimit would leave labels unfinished; end the job and restart it")
        for name in formats:
            if name not in FORMATS and name not in neuroglancer.INFO:
                raise ValueError(f"'{name}' is no format; there are "
                                 + ", ".join([*FORMATS, *neuroglancer.INFO]))
        if "multilod_draco" in formats:
            neuroglancer.draco_encoder()
        if len(source.shape) != 3:
            raise ValueError(f"the map must have three axes, z, y and x, not {len(source.shape)}")

        def given(value: Any, name: str, otherwise: Any) -> Any:
            return getattr(source, name, otherwise) if value is None else value

        self.source, self.folder = source, os.path.abspath(folder)
        self.spacing = [float(length) for length in given(spacing, "spacing", (1, 1, 1))]
        self.origin = [float(position) for position in given(origin, "origin", (0, 0, 0))]
        self.direction = None if direction is None else np.asarray(direction, float).tolist()
        self.only = sorted({int(label) for label in only})
        self.formats = list(formats)
        self.nanometers = float(given(nanometers, "nanometers", 1))
        self.bundle, self.most, self.properties = min(bundle, most), most, properties
        self._begin()

    def _begin(self) -> None:
        """Make the folders. Throw ValueError if they have results of other settings."""
        for folder in (*map(self._path, ("counts", "rows")), *self._viewers()):
            os.makedirs(folder, exist_ok=True)
        free = ("NumberOfThreads", "MemoryLimit", "ScratchDirectory")  # without effect on results
        ours = {"shape": list(self.source.shape), "type": str(self.source.dtype),
                "spacing": self.spacing, "origin": self.origin, "direction": self.direction,
                "formats": self.formats, "nanometers": self.nanometers, "bundle": self.bundle,
                "properties": {name: value for name, value in sorted(self.properties.items())
                               if name not in free}}
        path = self._path("settings.json")
        if not os.path.exists(path):
            replace_file(path, _json(ours))
        there = _read(path)
        for name, value in ours.items():
            if there.get(name) != value:
                raise ValueError(f"{self.folder} is of a job with {name} {there.get(name)}, not "
                                 f"{value}: choose another folder")

    def run(self, mapped: Callable[..., Iterable[Any]] = map) -> list[dict[str, Any]]:
        """Count, make and finish. `mapped(function, tasks)` is what maps: map, executor.map."""
        for step, tasks in ((self.count, self.blocks), (self.make, self.bundles)):
            for _ in mapped(step, tasks()):
                pass
        return self.finish()

    # ---- Counting ------------------------------------------------------------------------------

    def _grid(self) -> list[Box]:
        """Boxes of whole chunks that cover the map, each of two voxels or more along an axis."""
        chunks = getattr(self.source, "chunks", None) or (BLOCK,) * 3
        axes = []
        for size, chunk in zip(self.source.shape, chunks):
            chunk = int(np.max(chunk))
            starts = [start for start in range(0, size, max(chunk, BLOCK // chunk * chunk))
                      if start == 0 or size - start > 1]
            axes.append(list(zip(starts, [*starts[1:], size])))
        return [list(box[::-1]) for box in itertools.product(*axes)]

    def blocks(self, part: int = 0, parts: int = 1) -> list[int]:
        """Return the tasks for `count` that are not done, or the share of one of `parts`."""
        return [number for number in range(part, len(self._grid()), parts)
                if not os.path.exists(self._path("counts", f"{number}.json"))]

    def count(self, block: int) -> None:
        """Count the voxels of the labels in a block, and find their boxes."""
        path = self._path("counts", f"{block}.json")
        if not os.path.exists(path):
            box = self._grid()[block]
            found = arrays.label_boxes(self._read(box), [begin for begin, _ in box])
            replace_file(path, _json(found))

    def boxes(self) -> dict[int, list[int]]:
        """Return {label: [voxels, first x, last x, first y, ..., last z]} of the whole map."""
        path = self._path("boxes.json")
        if not os.path.exists(path):
            blocks = range(len(self._grid()))
            self._check_done(self.blocks(), blocks, "block", "counted")
            whole: dict[str, list[int]] = {}
            for number in blocks:
                for label, found in _read(self._path("counts", f"{number}.json")).items():
                    box = whole.setdefault(label, [0] + found[1:])
                    box[0] += found[0]
                    box[1::2] = map(min, box[1::2], found[1::2])
                    box[2::2] = map(max, box[2::2], found[2::2])
            replace_file(path, _json(sorted((int(label), box) for label, box in whole.items())))
        return _parsed(path, os.stat(path).st_mtime_ns)

    def _check_done(self, due: Sequence[int], tasks: Sequence[int], what: str, done: str) -> None:
        if due:
            raise ValueError(f"{self.folder}: {len(due)} of {len(tasks)} {what}s are not {done} "
                             f"yet, {what} {due[0]} is one")

    # ---- Making --------------------------------------------------------------------------------

    def labels(self) -> list[int]:
        """Return the labels that get a surface."""
        boxes = self.boxes()
        unknown = [label for label in self.only if label not in boxes]
        if unknown:
            raise ValueError(f"the map has no label {unknown[0]}")
        background = self.properties.get("BackgroundLabel", 0)
        return self.only or [label for label in boxes if label != background]

    def is_done(self, label: int) -> bool:
        """Return whether the surface of a label is made."""
        return os.path.exists(self._path("rows", f"{label}.json"))

    def bundles(self, part: int = 0, parts: int = 1) -> list[list[int]]:
        """Return the tasks for `make` that are not done, or the share of one of `parts`. Those with
        the largest crops come first."""
        wanted, due = set(self.labels()), []
        for box, labels in self._plan()[part::parts]:
            labels = [label for label in labels if label in wanted and not self.is_done(label)]
            if labels and _count(box) > self.most:
                size = " x ".join(str(end - begin) for begin, end in box)
                raise ValueError(f"label {labels[0]} and its margin are {size} voxels, more than "
                                 f"most={self.most}: allow more, or exclude the label by `only`")
            due += [labels] * bool(labels)
        return due

    def make(self, labels: Sequence[int]) -> None:
        """Make the surfaces of labels, in the crops of their bundles."""
        wanted = set(labels)
        for box, bundle in self._plan():
            due = [label for label in bundle if label in wanted and not self.is_done(label)]
            if due:
                self._make(due, box, bundle)

    def _make(self, due: Sequence[int], box: Box, bundle: Sequence[int]) -> None:
        voxels = self._read(box)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # rows and field data have them
            made = [arrays.labels(
                voxels, bundle, spacing=self.spacing, origin=self.origin, direction=self.direction,
                start=[begin for begin, _ in box], **{**self.properties, **settings})
                for settings in self._details()]
        for label in due:
            self._write(label, [level[label] for level in made])
            row = _json(self._row(label, made[0][label]))
            replace_file(self._path("rows", f"{label}.json"), row)  # Now it is done.

    def _details(self) -> list[dict[str, Any]]:
        """Properties of each level of detail, the finest first."""
        finest = max(0, self.properties.get("FinestLevel", 0))
        length = self.properties.get("EdgeLength", 0)
        coarser = DETAILS if "multilod_draco" in self.formats else ()
        return [{}, *({"FinestLevel": finest + more, "EdgeLength": length * 3 ** (more / 2)}
                      for more in coarser)]

    def finish(self) -> list[dict[str, Any]]:
        """Write labels.csv and `info` for viewers, and remove what killed workers left. All tasks
        must be done, and none running. Return a dict for each label."""
        labels = self.labels()
        due = [label for label in labels if not self.is_done(label)]
        self._check_done(due, labels, "label", "made")
        rows = [_read(self._path("rows", f"{label}.json")) for label in labels]
        table = io.StringIO()
        if rows:
            writer = csv.DictWriter(table, rows[0], lineterminator="\n")
            writer.writeheader()
            writer.writerows(rows)
        replace_file(os.path.join(self.folder, "labels.csv"), table.getvalue().encode())
        for folder in self._viewers():
            replace_file(os.path.join(folder, "info"),
                         _json(neuroglancer.INFO[os.path.basename(folder)]))
        for left in list(Path(self.folder).rglob(HIDDEN + "*")):
            shutil.rmtree(left)
        return rows

    # ---- Crops ---------------------------------------------------------------------------------

    def _plan(self) -> list[tuple[Box, list[int]]]:
        """Return the crop and the labels of each bundle, the largest crops first, also of labels
        that are not chosen. The background is the last bundle."""
        path = self._path("bundles.json")
        if not os.path.exists(path):
            background, margin = self.properties.get("BackgroundLabel", 0), self._margin()
            bundles: list[tuple[Box, list[int]]] = []
            for label in sorted(self.boxes(), key=lambda label: (
                    label == background, self._order(label))):
                box = self._about(label, margin)
                together = _around(box, bundles[-1][0]) if bundles else box
                if (bundles and label != background and _count(together) <= self.bundle
                        and len(bundles[-1][1]) < MOST):
                    bundles[-1] = (together, bundles[-1][1] + [label])
                else:
                    bundles.append((box, [label]))
            bundles.sort(key=lambda bundle: (bundle[1] == [background], -_count(bundle[0])))
            replace_file(path, _json(list(enumerate(bundles))))
        return list(_parsed(path, os.stat(path).st_mtime_ns).values())

    def _margin(self) -> list[int]:
        """Voxels along each axis beyond which others do not matter to a surface."""
        filter_, smallest = filters.vtkLabelsToSurfaces(), min(self.spacing)
        deviation = max(smallest * self.properties.get("Smoothing", filter_.GetSmoothing()),
                        0.625 * max(self.spacing))
        details = [{**self.properties, **settings} for settings in self._details()]
        edge = max(each.get("EdgeLength", 0) or smallest * 3 ** (each.get("FinestLevel", 0) / 2)
                   for each in details)
        reach = MARGIN[0] * deviation + MARGIN[1] * edge
        return [math.ceil(reach / length) for length in self.spacing]

    def _about(self, label: int, margin: Sequence[int]) -> Box:
        """The voxels of a label, and a margin of them."""
        _, *box = self.boxes()[label]
        return [(max(0, first - more), min(size, last + 1 + more)) for first, last, more, size in
                zip(box[::2], box[1::2], margin, self.source.shape[::-1])]

    def _order(self, label: int) -> int:
        """Morton order of the centers: labels that follow each other lie near each other."""
        _, *box = self.boxes()[label]
        center = [(first + last) // 64 for first, last in zip(box[::2], box[1::2])]
        return sum((center[axis] >> bit & 1) << (3 * bit + axis)
                   for bit in range(26) for axis in range(3))

    def _read(self, box: Box) -> np.ndarray:
        return np.asarray(self.source[tuple(slice(begin, end) for begin, end in box[::-1])])

    # ---- Files ---------------------------------------------------------------------------------

    def _path(self, *names: str) -> str:
        return os.path.join(self.folder, "job", *names)

    def _viewers(self) -> list[str]:
        """The folders for Neuroglancer."""
        return [os.path.join(self.folder, name) for name in self.formats
                if name in neuroglancer.INFO]

    def _write(self, label: int, levels: Sequence[Surface]) -> None:
        """Write the surface of a label, the first of its levels of detail, in all formats."""
        surface, made = levels[0], {}
        for name in self.formats if len(surface.triangles) else ():
            if name == "precomputed":
                made[f"{name}/{label}.mesh"] = neuroglancer.precomputed(surface, self.nanometers)
                made[f"{name}/{label}:0"] = _json({"fragments": [f"{label}.mesh"]})
            elif name == "multilod_draco":
                manifest, fragments = neuroglancer.multilod_draco(
                    [level for level in levels if len(level.triangles)], self.nanometers)
                made.update({f"{name}/{label}": fragments, f"{name}/{label}.index": manifest})
            else:
                made[f"label-{label}{name}"] = surface.to_bytes(name)
        for name, content in made.items():
            replace_file(os.path.join(self.folder, name), content)

    def _row(self, label: int, surface: Surface) -> dict[str, Any]:
        names = ("Voxels", "FirstX", "LastX", "FirstY", "LastY", "FirstZ", "LastZ")
        facts = ("Volume", "Area", "NumberOfComponents", "Genus", "VolumeError", "WrongVoxels",
                 "MissedVoxels", "StopReason")
        return {"Label": label, **dict(zip(names, self.boxes()[label])),
                "Points": len(surface.points), "Triangles": len(surface.triangles),
                **{name: surface.report.get(name) for name in facts}, **arrays.quality(surface)}


def _count(box: Box) -> int:
    return math.prod(end - begin for begin, end in box)


def _around(one: Box, other: Box) -> Box:
    return [(min(a[0], b[0]), max(a[1], b[1])) for a, b in zip(one, other)]


def _json(content: Any) -> bytes:
    return json.dumps(content).encode()


def _read(path: str) -> Any:
    with open(path, encoding="utf-8") as file:
        return json.load(file)


@functools.lru_cache(maxsize=8)
def _parsed(path: str, _time: int) -> dict[int, Any]:
    return dict(_read(path))
