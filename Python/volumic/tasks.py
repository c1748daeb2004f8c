# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Surfaces of all labels of a label map larger than memory, computed by parallel tasks on crops.

    job = Job(volumic.ome_zarr.open("brain.zarr", label="cells"), "meshes")
    job.run()                                          # serial
    job.run(executor.map)                              # concurrent.futures, processes
    job.run(lambda function, tasks: client.gather(client.map(function, tasks)))     # dask

Tasks of `count` determine the extents of labels in blocks of the map. Tasks of `make` compute the
surfaces of a bundle of labels. Tasks write their results to the folder of the job and return
nothing. An interrupted job resumes, and a repeated task reuses its result.

A bundle is a group of nearby labels. Its task crops the map with a margin around them, computes one
mesh of all labels in the crop, and writes the surfaces of the labels of the bundle. Within a bundle
adjacent labels share their triangles, across bundles they do not. Results are bit-identical for any
number of workers, any selection of labels, and after interruptions. The connectivity of voxels that
share only edges depends on the numbers of voxels of their labels in the crop.
"""

from __future__ import annotations

import csv
import functools
import glob
import io
import itertools
import json
import math
import os
import shutil
import warnings
from collections.abc import Callable, Iterable, Sequence
from typing import Any

import numpy as np

from . import arrays, neuroglancer
from . import vtkFiltersVolumic as filters
from .arrays import Surface
from .writing.files import HIDDEN, replace_file
from .writing.surfaces import FORMATS

MARGIN = 4, 6  # of crops, in standard deviations of the smoothing and in edge lengths
MAXIMUM_LABELS = 4096  # of a bundle, the limit of vtkLabelsToSurfaces
BLOCK = 256  # maximum size of blocks in voxels
DETAILS = (1, 2, 3)  # FinestLevel of coarser levels of detail; each has sqrt(3) times longer edges
PERIODIC = 2  # BoxFaces
Box = list[tuple[int, int]]  # [begin, end) of x, y and z


class Job:
    """Computation of the surfaces of the labels of one map, with its results in one folder.

    Parameters
    ----------
    source : array-like
        Label map [z, y, x] with `shape`, `dtype` and slicing, such as a zarr.Array, a
        volumic.ome_zarr.Volume or a numpy.ndarray. It is pickled for other processes.
    folder : str
        Folder of the results, shared by all workers. Its parent must exist.
    spacing, origin : sequence of 3 floats, optional
        See volumic.surface (default: those of `source`, if any).
    direction : array_like, optional
        See volumic.surface.
    only : sequence of ints, optional
        Labels to compute (default: all but BackgroundLabel).
    formats : sequence of str, optional
        `.vtp`, `.ply` or `.stl`: files such as label-3.vtp. `precomputed` or `multilod_draco`:
        folders for Neuroglancer, the latter compressed and with four levels of detail.
    nanometers : float, optional
        Length of a world unit, for Neuroglancer (default: that of `source`, or 1).
    bundle : int, optional
        Maximum number of voxels of the crop of a bundle of several labels. Triangles depend on it.
    most : int, optional
        Maximum number of voxels of a crop, which bounds memory. A label with a larger crop is an
        error.
    **properties
        Properties of vtkLabelsToSurfaces. Set NumberOfThreads if workers share a machine.

    Raises
    ------
    TypeError
        The filter has no such property.
    ValueError
        A parameter is invalid, or the folder has results of other settings.
    """

    def __init__(self, source: Any, folder: str | os.PathLike[str], *,
                 spacing: Sequence[float] | None = None, origin: Sequence[float] | None = None,
                 direction: Any = None, only: Sequence[int] = (),
                 formats: Sequence[str] = (".vtp",), nanometers: float | None = None,
                 bundle: int = 1 << 24, most: int = 1 << 29, **properties: Any) -> None:
        arrays.check_properties("vtkLabelsToSurfaces", properties)
        if properties.get("Merge") or properties.get("BoxFaces") == PERIODIC:
            raise ValueError("Merge and periodic BoxFaces are not supported for crops; use "
                             "volumic.labels for the whole map")
        if properties.get("TimeLimit"):
            raise ValueError("TimeLimit is not supported for jobs; stop the job and run it again")
        for name in formats:
            if name not in FORMATS and name not in neuroglancer.INFO:
                raise ValueError(f"'{name}' is not a format; use one of "
                                 + ", ".join([*FORMATS, *neuroglancer.INFO]))
        if "multilod_draco" in formats:
            neuroglancer.draco_encoder()
        if len(source.shape) != 3:
            raise ValueError(f"the map must have three axes, z, y and x, not {len(source.shape)}")

        def value_of(value: Any, name: str, otherwise: Any) -> Any:
            return getattr(source, name, otherwise) if value is None else value

        self.source, self.folder = source, os.path.abspath(folder)
        self.spacing = [float(length) for length in value_of(spacing, "spacing", (1, 1, 1))]
        self.origin = [float(position) for position in value_of(origin, "origin", (0, 0, 0))]
        self.direction = None if direction is None else np.asarray(direction, float).tolist()
        self.only = sorted({int(label) for label in only})
        self.formats = list(formats)
        self.nanometers = float(value_of(nanometers, "nanometers", 1))
        self.bundle, self.most, self.properties = min(bundle, most), most, properties
        self._create_folders()

    def _create_folders(self) -> None:
        """Create the folders. Raise ValueError if they have results of other settings."""
        for folder in (*map(self._path, ("counts", "rows")), *self._viewers()):
            os.makedirs(folder, exist_ok=True)
        free = ("NumberOfThreads", "MemoryLimit", "ScratchDirectory")  # no effect on results
        settings = {"shape": list(self.source.shape), "type": str(self.source.dtype),
                    "spacing": self.spacing, "origin": self.origin, "direction": self.direction,
                    "formats": self.formats, "nanometers": self.nanometers, "bundle": self.bundle,
                    "properties": {name: value for name, value in sorted(self.properties.items())
                                   if name not in free}}
        path = self._path("settings.json")
        if not os.path.exists(path):
            replace_file(path, _json(settings))
        stored = _read(path)
        for name, value in settings.items():
            if stored.get(name) != value:
                raise ValueError(f"{self.folder} has results for {name} {stored.get(name)} "
                                 f"instead of {value}; choose another folder")

    def run(self, mapped: Callable[..., Iterable[Any]] = map) -> list[dict[str, Any]]:
        """Run all tasks of count and make, then finish.

        Parameters
        ----------
        mapped : callable, optional
            mapped(function, tasks), such as map or executor.map.

        Returns
        -------
        list of dict
            See finish().
        """
        for step, tasks in ((self.count, self.blocks), (self.make, self.bundles)):
            for _ in mapped(step, tasks()):
                pass
        return self.finish()

    # ---- Counting ------------------------------------------------------------------------------

    def _grid(self) -> list[Box]:
        """Return boxes of whole chunks that cover the map, at least two voxels along each axis."""
        chunks = getattr(self.source, "chunks", None) or (BLOCK,) * 3
        axes = []
        for size, chunk in zip(self.source.shape, chunks):
            chunk = int(np.max(chunk))
            starts = [start for start in range(0, size, max(chunk, BLOCK // chunk * chunk))
                      if start == 0 or size - start > 1]
            axes.append(list(zip(starts, [*starts[1:], size])))
        return [list(box[::-1]) for box in itertools.product(*axes)]

    def blocks(self, part: int = 0, parts: int = 1) -> list[int]:
        """Return the pending tasks of `count`, or subset `part` of `parts`."""
        return [number for number in range(part, len(self._grid()), parts)
                if not os.path.exists(self._path("counts", f"{number}.json"))]

    def count(self, block: int) -> None:
        """Count the voxels of the labels in a block, and determine their extents."""
        path = self._path("counts", f"{block}.json")
        if not os.path.exists(path):
            box = self._grid()[block]
            found = arrays.label_boxes(self._read(box), [begin for begin, _ in box])
            replace_file(path, _json(found))

    def boxes(self) -> dict[int, list[int]]:
        """Return [voxels, first x, last x, first y, ..., last z] by label, for the whole map."""
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

    def _check_done(self, pending: Sequence[int], tasks: Sequence[int], what: str, done: str
                    ) -> None:
        if pending:
            raise ValueError(f"{self.folder}: {len(pending)} of {len(tasks)} {what}s are not "
                             f"{done}, such as {what} {pending[0]}; run all tasks first")

    # ---- Making --------------------------------------------------------------------------------

    def labels(self) -> list[int]:
        """Return the labels to compute."""
        boxes = self.boxes()
        unknown = [label for label in self.only if label not in boxes]
        if unknown:
            raise ValueError(f"the map has no label {unknown[0]}")
        background = self.properties.get("BackgroundLabel", 0)
        return self.only or [label for label in boxes if label != background]

    def is_done(self, label: int) -> bool:
        """Return whether the surface of a label has been computed."""
        return os.path.exists(self._path("rows", f"{label}.json"))

    def bundles(self, part: int = 0, parts: int = 1) -> list[list[int]]:
        """Return the pending tasks of `make`, or subset `part` of `parts`, largest crops first."""
        requested, pending = set(self.labels()), []
        for box, labels in self._plan()[part::parts]:
            labels = [label for label in labels if label in requested and not self.is_done(label)]
            if labels and _count(box) > self.most:
                size = " x ".join(str(end - begin) for begin, end in box)
                raise ValueError(f"label {labels[0]} requires a crop of {size} voxels, more than "
                                 f"most={self.most}; increase most, or exclude the label by `only`")
            pending += [labels] * bool(labels)
        return pending

    def make(self, labels: Sequence[int]) -> None:
        """Compute the surfaces of labels in the crops of their bundles."""
        requested = set(labels)
        for box, bundle in self._plan():
            pending = [label for label in bundle if label in requested and not self.is_done(label)]
            if pending:
                self._make(pending, box, bundle)

    def _make(self, pending: Sequence[int], box: Box, bundle: Sequence[int]) -> None:
        voxels = self._read(box)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # stored in rows and field data
            made = [arrays.labels(
                voxels, bundle, spacing=self.spacing, origin=self.origin, direction=self.direction,
                start=[begin for begin, _ in box], **{**self.properties, **settings})
                for settings in self._details()]
        for label in pending:
            self._write(label, [level[label] for level in made])
            row = _json(self._row(label, made[0][label]))
            replace_file(self._path("rows", f"{label}.json"), row)  # marks it as done

    def _details(self) -> list[dict[str, Any]]:
        """Return the properties of each level of detail, the finest first."""
        finest = max(0, self.properties.get("FinestLevel", 0))
        length = self.properties.get("EdgeLength", 0)
        coarser = DETAILS if "multilod_draco" in self.formats else ()
        return [{}, *({"FinestLevel": finest + more, "EdgeLength": length * 3 ** (more / 2)}
                      for more in coarser)]

    def finish(self) -> list[dict[str, Any]]:
        """Write labels.csv and the `info` files of viewers, and remove temporary files. All tasks
        must be done. Return one dict per label."""
        labels = self.labels()
        pending = [label for label in labels if not self.is_done(label)]
        self._check_done(pending, labels, "label", "computed")
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
        for left in glob.glob(os.path.join(glob.escape(self.folder), "**", HIDDEN + "*"),
                              recursive=True):
            shutil.rmtree(left, ignore_errors=True)
        return rows

    # ---- Crops ---------------------------------------------------------------------------------

    def _plan(self) -> list[tuple[Box, list[int]]]:
        """Return crop and labels of each bundle, largest crops first. The background is last."""
        path = self._path("bundles.json")
        if not os.path.exists(path):
            background, margin = self.properties.get("BackgroundLabel", 0), self._margin()
            bundles: list[tuple[Box, list[int]]] = []
            for label in sorted(self.boxes(), key=lambda label: (
                    label == background, self._order(label))):
                box = self._extent(label, margin)
                together = _union(box, bundles[-1][0]) if bundles else box
                if (bundles and label != background and _count(together) <= self.bundle
                    and len(bundles[-1][1]) < MAXIMUM_LABELS):
                    bundles[-1] = (together, bundles[-1][1] + [label])
                else:
                    bundles.append((box, [label]))
            bundles.sort(key=lambda bundle: (bundle[1] == [background], -_count(bundle[0])))
            replace_file(path, _json(list(enumerate(bundles))))
        return list(_parsed(path, os.stat(path).st_mtime_ns).values())

    def _margin(self) -> list[int]:
        """Return the margin of crops along each axis, in voxels."""
        filter_, smallest = filters.vtkLabelsToSurfaces(), min(self.spacing)
        deviation = max(smallest * self.properties.get("Smoothing", filter_.GetSmoothing()),
                        0.625 * max(self.spacing))
        details = [{**self.properties, **settings} for settings in self._details()]
        edge = max(each.get("EdgeLength", 0) or smallest * 3 ** (each.get("FinestLevel", 0) / 2)
                   for each in details)
        reach = MARGIN[0] * deviation + MARGIN[1] * edge
        return [math.ceil(reach / length) for length in self.spacing]

    def _extent(self, label: int, margin: Sequence[int]) -> Box:
        """Return the extent of a label with a margin."""
        _, *box = self.boxes()[label]
        return [(max(0, first - more), min(size, last + 1 + more)) for first, last, more, size in
                zip(box[::2], box[1::2], margin, self.source.shape[::-1])]

    def _order(self, label: int) -> int:
        """Return the Morton order of the centre of a label, by which nearby labels are grouped."""
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
        return [os.path.join(self.folder, name) for name in self.formats
                if name in neuroglancer.INFO]

    def _write(self, label: int, levels: Sequence[Surface]) -> None:
        """Write the surface of a label in all formats. `levels` are its levels of detail."""
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
        fields = ("Volume", "Area", "NumberOfComponents", "Genus", "VolumeError", "WrongVoxels",
                  "MissedVoxels", "StopReason")
        return {"Label": label, **dict(zip(names, self.boxes()[label])),
                "Points": len(surface.points), "Triangles": len(surface.triangles),
                **{name: surface.report.get(name) for name in fields}, **arrays.quality(surface)}


def _count(box: Box) -> int:
    return math.prod(end - begin for begin, end in box)


def _union(one: Box, other: Box) -> Box:
    return [(min(a[0], b[0]), max(a[1], b[1])) for a, b in zip(one, other)]


def _json(content: Any) -> bytes:
    return json.dumps(content).encode()


def _read(path: str) -> Any:
    with open(path, encoding="utf-8") as file:
        return json.load(file)


@functools.lru_cache(maxsize=8)
def _parsed(path: str, _time: int) -> dict[int, Any]:
    return dict(_read(path))
