# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Surfaces of all labels of a map that is larger than memory, as tasks on crops.

    job = Job(volumic.ome_zarr.open("brain.zarr", label="cells"), "meshes")
    job.run()                                          # a loop
    job.run(executor.map)                              # concurrent.futures, processes
    job.run(lambda function, of: client.gather(client.map(function, of)))    # dask.distributed

First all blocks of the map are counted (`count`), then labels are made (`make`), both by whatever
maps. A task leaves its result in the folder and returns next to nothing. What is done is in the
folder: a job that was killed goes on, and a task that runs twice finds it done.

Surfaces are the bits that vtkLabelsToSurfaces makes of the whole map. What it makes of a label
depends on the voxels in the bricks of 4 x 4 x 4 voxels, from voxel 0 of the map on, that have some
of it, and in those up to three further. Labels with voxels in bricks up to two further may claim
places where three meet; so these labels are in the crop, each all of it. Settings by which labels
depend on labels beyond that are refused: Gap, Merge, SharedInterfaces.
"""

from __future__ import annotations

import csv
import functools
import io
import itertools
import json
import os
import shutil
import warnings
from collections.abc import Callable, Iterable, Sequence
from typing import Any

import numpy as np

from . import arrays, neuroglancer
from .arrays import Surface
from .writing.files import HIDDEN, replace_file
from .writing.surfaces import FORMATS

BRICK = 4  # voxels, LabelBricks::Side
MARGIN = 3  # bricks: those beside the label's, and what is within LabelBricks' reach of them
CLAIMS = 2  # bricks: about those beside the label's that others' fields may be in
BLOCK = 256  # voxels along each axis that are counted at a time, at most
DETAILS = (1, 2, 3)  # FinestLevel of the coarser levels of detail: edges sqrt(3) times as long
Box = list[tuple[int, int]]  # [begin, end) of x, y and z


class Job:
    """The surfaces of the labels of one map, in one folder.

    Parameters
    ----------
    source : array-like
        The map, labels [z, y, x]: `shape`, `dtype` and slices, such as a zarr.Array, a volume of
        volumic.ome_zarr or a numpy.ndarray. Whatever runs tasks in other processes pickles it.
    folder : str
        For the results. It is made; the parent is there. Seen by all workers.
    spacing, origin : sequence of 3 floats, optional
        As of volumic.surface; by default those of `source`, where it has such.
    direction : array_like, optional
    only : sequence of ints, optional
        Labels to make; by default all but BackgroundLabel.
    formats : sequence of str, optional
        `.vtp`, `.ply`, `.stl`: label-3.vtp. For Neuroglancer, folders of these names: `precomputed`
        and, with four levels of detail, compressed, `multilod_draco`.
    nanometers : float, optional
        Of one world unit, for Neuroglancer; by default that of `source`, or 1.
    bundle : int, optional
        Voxels of a crop up to which labels that lie near each other are one task.
    most : int, optional
        Voxels of the largest crop; a label that needs a larger one is refused. With that memory is
        bounded: a worker takes about 20 bytes for each voxel of a crop, plus its surfaces.
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
        for name in ("Gap", "Merge", "SharedInterfaces"):
            if properties.get(name):
                raise ValueError(f"{name}={properties[name]} couples labels all over the map: there "
                                 "are no tasks of their own. Apply volumic.labels to the whole map.")
        if properties.get("TimeLimit"):
            raise ValueError("TimeLimit would leave labels unfinished: end the job, and start it again")
        for name in formats:
            if name not in FORMATS and name not in neuroglancer.INFO:
                raise ValueError(f"'{name}' is no format; there are "
                                 + ", ".join([*FORMATS, *neuroglancer.INFO]))
        if "multilod_draco" in formats:
            neuroglancer.draco_encoder()
        if len(source.shape) != 3:
            raise ValueError(f"the map must have three axes, z, y and x, not {len(source.shape)}")
        self.source = source
        self.folder = os.path.abspath(folder)
        self.spacing = _floats(getattr(source, "spacing", (1, 1, 1)) if spacing is None else spacing)
        self.origin = _floats(getattr(source, "origin", (0, 0, 0)) if origin is None else origin)
        self.direction = None if direction is None else np.asarray(direction, float).tolist()
        self.only = sorted({int(label) for label in only})
        self.formats = list(formats)
        self.nanometers = float(getattr(source, "nanometers", 1) if nanometers is None else nanometers)
        self.bundle = bundle
        self.most = most
        self.properties = properties
        self._begin()

    def _begin(self) -> None:
        """Makes the folders. Results of other settings are not mixed with these."""
        for folder in (*map(self._path, ("counts", "rows")), *self._viewers()):
            os.makedirs(folder, exist_ok=True)
        free = ("NumberOfThreads", "MemoryLimit", "ScratchDirectory")  # no bit depends on them
        ours = {"shape": list(self.source.shape), "type": str(self.source.dtype),
                "spacing": self.spacing, "origin": self.origin, "direction": self.direction,
                "formats": self.formats, "nanometers": self.nanometers,
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
        for size, chunk in zip(self.source.shape[::-1], tuple(chunks)[::-1]):
            chunk = chunk if isinstance(chunk, int) else max(chunk)
            ends = list(range(0, size, max(chunk, BLOCK // chunk * chunk)))[1:] + [size]
            if len(ends) > 1 and size - ends[-2] < 2:
                del ends[-2]
            axes.append(list(zip([0, *ends[:-1]], ends)))
        return [[x, y, z] for z, y, x in itertools.product(*axes[::-1])]

    def blocks(self, part: int = 0, parts: int = 1) -> list[int]:
        """The tasks for `count` that are not done, or the share of them that one of `parts` does."""
        return [number for number in range(part, len(self._grid()), parts)
                if not os.path.exists(self._path("counts", f"{number}.json"))]

    def count(self, block: int) -> None:
        """The boxes and numbers of voxels of the labels in a block."""
        path = self._path("counts", f"{block}.json")
        if not os.path.exists(path):
            box = self._grid()[block]
            replace_file(path, _json(arrays.label_boxes(self._read(box), _starts(box))))

    def boxes(self) -> dict[int, list[int]]:
        """{label: [voxels, first x, last x, first y, ..., last z]} of the whole map."""
        path = self._path("boxes.json")
        if not os.path.exists(path):
            missing = self.blocks()
            if missing:
                raise ValueError(f"{self.folder}: {len(missing)} of {len(self._grid())} blocks are not "
                                 f"counted yet, block {missing[0]} is one")
            whole: dict[str, list[int]] = {}
            for number in range(len(self._grid())):
                for label, found in _read(self._path("counts", f"{number}.json")).items():
                    box = whole.setdefault(label, [0] + found[1:])
                    box[0] += found[0]
                    box[1::2] = map(min, box[1::2], found[1::2])
                    box[2::2] = map(max, box[2::2], found[2::2])
            replace_file(path, _json(dict(sorted(whole.items(), key=lambda item: int(item[0])))))
        return _boxes(path, os.stat(path).st_mtime_ns)

    # ---- Making --------------------------------------------------------------------------------

    def labels(self) -> list[int]:
        """Those that get a surface."""
        boxes = self.boxes()
        unknown = [label for label in self.only if label not in boxes]
        if unknown:
            raise ValueError(f"the map has no label {unknown[0]}")
        background = self.properties.get("BackgroundLabel", 0)
        return self.only or [label for label in boxes if label != background]

    def is_done(self, label: int) -> bool:
        return os.path.exists(self._path("rows", f"{label}.json"))

    def bundles(self, part: int = 0, parts: int = 1) -> list[list[int]]:
        """The tasks for `make` that are not done, those with the largest crops first; or the share of
        them that one of `parts` does.
        """
        bundles: list[tuple[Box, list[int]]] = []
        for label in sorted(self.labels(), key=self._order):
            box = self._about([label])
            together = _around(box, bundles[-1][0]) if bundles else box
            if bundles and _count(together) <= self.bundle:
                bundles[-1] = (together, bundles[-1][1] + [label])
            else:
                bundles.append((box, [label]))
        bundles.sort(key=lambda bundle: -_count(bundle[0]))
        due = [[label for label in labels if not self.is_done(label)]
               for _, labels in bundles[part::parts]]
        for label in itertools.chain(*due):
            self._check([label], self._about([label]))
        return [labels for labels in due if labels]

    def make(self, labels: Sequence[int]) -> None:
        """Surfaces of labels, in a crop that has what they depend on."""
        due = [label for label in labels if not self.is_done(label)]
        if not due:
            return
        box = self._about(due)
        voxels = self._read(box)
        whole = self._with_claimants(due, box, voxels)
        if len(due) > 1 and _count(whole) > max(self.bundle, 2 * _count(box)):
            del voxels
            self.make(due[:len(due) // 2])
            self.make(due[len(due) // 2:])
            return
        if whole != box:
            self._check(due, whole)
            voxels = self._read(whole)
        made = [self._surfaces(voxels, due, whole, **settings) for settings in self._details()]
        for label, surface in made[0].items():
            self._write(label, surface, [level[label] for level in made])
            row = self._row(label, surface)
            replace_file(self._path("rows", f"{label}.json"), _json(row))  # Now it is done.

    def _details(self) -> list[dict[str, Any]]:
        """Properties of each level of detail, the finest first."""
        details: list[dict[str, Any]] = [{}]
        finest = max(0, self.properties.get("FinestLevel", 0))
        length = self.properties.get("EdgeLength", 0)
        for more in DETAILS if "multilod_draco" in self.formats else ():
            details.append({"FinestLevel": finest + more, "EdgeLength": length * 3 ** (more / 2)})
        return details

    def _surfaces(self, voxels: np.ndarray, labels: Sequence[int], box: Box,
                  **settings: Any) -> arrays.Surfaces:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # Rows and field data have what they tell.
            return arrays.labels(voxels, labels, spacing=self.spacing, origin=self.origin,
                                 direction=self.direction, start=_starts(box),
                                 **{**self.properties, **settings})

    def finish(self) -> list[dict[str, Any]]:
        """Writes labels.csv, and what viewers want; takes away what killed workers left. All tasks
        must be done, and none at work. Returns a dict for each label.
        """
        labels = self.labels()
        missing = [label for label in labels if not self.is_done(label)]
        if missing:
            raise ValueError(f"{self.folder}: {len(missing)} of {len(labels)} labels are not made yet, "
                             f"label {missing[0]} is one")
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
        for folder, names, _ in os.walk(self.folder):
            for name in names:
                if name.startswith(HIDDEN):
                    shutil.rmtree(os.path.join(folder, name))
        return rows

    # ---- Crops ---------------------------------------------------------------------------------

    def _about(self, labels: Sequence[int]) -> Box:
        """Of the bricks that labels are in, and MARGIN more."""
        return self._in_bricks(labels, MARGIN)

    def _in_bricks(self, labels: Iterable[int], margin: int) -> Box:
        found = [self.boxes()[label] for label in labels]
        return [(max(0, (min(box[1 + 2 * axis] for box in found) // BRICK - margin) * BRICK),
                 min(size, (max(box[2 + 2 * axis] for box in found) // BRICK + 1 + margin) * BRICK))
                for axis, size in enumerate(self.source.shape[::-1])]

    def _with_claimants(self, labels: Sequence[int], box: Box, voxels: np.ndarray) -> Box:
        """The box, grown by all of the other labels that may claim places about these."""
        sizes = [-(-size // BRICK) for size in voxels.shape]
        padded = np.zeros([size * BRICK for size in sizes], bool)
        padded[tuple(slice(size) for size in voxels.shape)] = np.isin(voxels, labels)
        near = padded.reshape(sizes[0], BRICK, sizes[1], BRICK, sizes[2], BRICK).any(axis=(1, 3, 5))
        for axis in range(3):
            spread = near.copy()
            for step in range(1, CLAIMS + 1):
                ahead, behind = [slice(None)] * 3, [slice(None)] * 3
                ahead[axis], behind[axis] = slice(step, None), slice(None, -step)
                spread[tuple(ahead)] |= near[tuple(behind)]
                spread[tuple(behind)] |= near[tuple(ahead)]
            near = spread
        for axis, size in enumerate(voxels.shape):
            near = near.repeat(BRICK, axis).take(np.arange(size), axis)
        found = voxels[near]
        others = set(np.unique(found[np.flatnonzero(np.diff(found, prepend=~found[:1]))]).tolist())
        others -= {self.properties.get("BackgroundLabel", 0), *labels}
        if not others:
            return box
        return _around(box, self._in_bricks([int(label) for label in others], 0))

    def _check(self, labels: Sequence[int], box: Box) -> None:
        if _count(box) > self.most:
            size = " x ".join(str(end - begin) for begin, end in box)
            raise ValueError(
                f"label {labels[0]} and what it depends on are in {size} voxels, more than most="
                f"{self.most}: allow more, make others `only`, or, where a label about it is nothing "
                "that matters, choose that one as BackgroundLabel")

    def _order(self, label: int) -> int:
        """So that labels in this order are near each other: bits of the places in turn."""
        box = self.boxes()[label]
        places = [(box[1 + 2 * axis] + box[2 + 2 * axis]) // 64 for axis in range(3)]
        return sum((places[axis] >> bit & 1) << (3 * bit + axis)
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

    def _write(self, label: int, surface: Surface, details: Sequence[Surface]) -> None:
        for name in self.formats if len(surface.triangles) else ():
            folder = os.path.join(self.folder, name)
            if name == "precomputed":
                replace_file(os.path.join(folder, f"{label}.mesh"),
                             neuroglancer.precomputed(surface, self.nanometers))
                replace_file(os.path.join(folder, f"{label}:0"),
                             _json({"fragments": [f"{label}.mesh"]}))
            elif name == "multilod_draco":
                manifest, fragments = neuroglancer.multilod_draco(
                    [level for level in details if len(level.triangles)], self.nanometers)
                replace_file(os.path.join(folder, str(label)), fragments)
                replace_file(os.path.join(folder, f"{label}.index"), manifest)
            else:
                replace_file(os.path.join(self.folder, f"label-{label}{name}"), surface.to_bytes(name))

    def _row(self, label: int, surface: Surface) -> dict[str, Any]:
        report = surface.report
        row: dict[str, Any] = {"Label": label}
        row.update(zip(("Voxels", "FirstX", "LastX", "FirstY", "LastY", "FirstZ", "LastZ"),
                       self.boxes()[label]))
        row.update({"Points": len(surface.points), "Triangles": len(surface.triangles)})
        row.update({name: report.get(name) for name in (
            "Volume", "Area", "NumberOfComponents", "Genus", "VolumeError", "WrongVoxels",
            "MissedVoxels", "Level", "StopReason")})
        return row | arrays.quality(surface)


def _floats(values: Any) -> list[float]:
    return [float(value) for value in values]


def _count(box: Box) -> int:
    x, y, z = (end - begin for begin, end in box)
    return x * y * z


def _around(one: Box, other: Box) -> Box:
    return [(min(a[0], b[0]), max(a[1], b[1])) for a, b in zip(one, other)]


def _starts(box: Box) -> list[int]:
    return [begin for begin, _ in box]


def _json(content: Any) -> bytes:
    return json.dumps(content).encode()


def _read(path: str) -> Any:
    with open(path, encoding="utf-8") as file:
        return json.load(file)


@functools.lru_cache(maxsize=4)
def _boxes(path: str, _time: int) -> dict[int, list[int]]:
    return {int(label): box for label, box in _read(path).items()}
