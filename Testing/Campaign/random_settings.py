# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Random runs of the command: a volume of random_volumes.py in a folder, and random options."""

import os

import numpy as np
from vtkmodules.vtkFiltersCore import vtkCleanPolyData, vtkTriangleFilter
from vtkmodules.vtkFiltersGeneral import vtkTransformPolyDataFilter
from vtkmodules.vtkFiltersSources import vtkCubeSource, vtkSphereSource
from vtkmodules.vtkCommonTransforms import vtkTransform
from vtkmodules.vtkIOXML import vtkXMLImageDataWriter, vtkXMLPolyDataWriter

import random_volumes
from voxel_topology import topology_of


def write(writer, data, folder, name):
    writer.SetFileName(os.path.join(folder, name))
    writer.SetInputData(data)
    writer.Write()
    return name


class RandomRun:
    """Command-line arguments for files in `folder`, which is the working folder of the run."""

    def __init__(self, seed, folder, only_labels):
        self.rng = np.random.default_rng(seed)
        self.folder = folder
        self.is_default = False  # label maps: default settings
        self.selected = None  # selected labels; None: all
        self.is_of_labels = only_labels or self.chance(.15)
        self.arguments = self.of_labels() if self.is_of_labels else self.of_surface()
        self.arguments = [self.volume, *self.arguments, "--threads", str(self.rng.integers(1, 3))]

    def chance(self, share):
        return self.rng.random() < share

    def number(self, low, high):
        return f"{self.rng.uniform(low, high):.6g}"

    def now_and_then(self, share, option, *value):
        return [option, *value] if self.chance(share) else []

    # ---- Surfaces of labels ----

    def of_labels(self):
        labels, self.spacing, self.kind = random_volumes.random_labels(self.rng)
        self.labels, self.size = labels, np.array(labels.shape[::-1])
        image = random_volumes.make_image(self.rng, labels.astype("u1"), self.spacing)
        self.volume = write(vtkXMLImageDataWriter(), image, self.folder, "volume.vti")
        smallest = self.spacing.min()
        smoothing = self.now_and_then(.4, "--smoothing", self.rng.choice(("0", self.number(.1, 4)),
                                                                         p=(.15, .85)))
        other = [] if self.chance(.5) else [
            *self.now_and_then(.5, "--finest", str(self.rng.choice((-1, 1, 2)))),
            *self.now_and_then(.2, "--edge-length", f"{smallest * self.rng.uniform(.7, 4):.6g}"),
            *self.now_and_then(.3, "--keep", "largest")]
        tolerance = [*self.now_and_then(.3, "--voxel-tolerance", self.number(0, 1)),
                     *(self.tolerance() if other else [])]
        merge = self.chance(.05)
        box = [] if merge else self.now_and_then(.15, "--box-faces", "flat")
        self.is_default = not (other or tolerance or box) and smoothing[1:] != ["0"]
        self.selected = set(np.unique(labels)) - {0}
        chosen = "all"
        if not merge and len(self.selected) > 1 and self.chance(.1):
            some = self.rng.choice(sorted(self.selected), len(self.selected) // 2, replace=False)
            self.selected, chosen = set(some), ",".join(map(str, some))
        return [
            "labels.vtp" if merge else "labels", "--labels", chosen, *["--merge"] * merge,
            *smoothing, *other, *box, *self.now_and_then(.3, "--metric", "voxels"), *tolerance]

    def topology(self):
        """Return the topology of each label by its voxels; of the first one if all are merged."""
        first = self.labels[self.labels > 0].min()
        labels = np.where(self.labels > 0, first, 0) if "--merge" in self.arguments else self.labels
        return topology_of(labels, "flat" in self.arguments)

    # ---- The surface of an object ----

    def of_surface(self):
        most_voxels = 150000 if self.chance(.05) else 25000
        self.size, self.spacing = random_volumes.size_and_spacing(self.rng, most_voxels)
        field, self.kind = random_volumes.random_field(self.rng, self.size, self.spacing)
        voxels = random_volumes.to_type(self.rng, field, self.rng.choice(random_volumes.TYPES))
        image = random_volumes.make_image(self.rng, voxels, self.spacing)
        arguments = ["surface.vtp", "--levels-output", "levels", *self.iso(voxels),
                     *self.start(image, field), *self.pyramid(), *self.stop(), *self.forces()]
        if self.chance(.15):
            random_volumes.add_array(image, "edges", self.rng.random(voxels.shape) ** 4)
            arguments += ["--edges", "edges", "--edge-attraction", self.number(.1, 3)]
        arguments += [*self.now_and_then(.2, "--thin-parts"), *self.tolerance()]
        self.volume = write(vtkXMLImageDataWriter(), image, self.folder, "volume.vti")
        return arguments

    def iso(self, voxels):
        """Return a random iso-value in the range of the voxels, or none (Otsu's method)."""
        low, high = float(voxels.min()), float(voxels.max())
        value = low + (high - low) * self.rng.uniform(.02, .98)
        return [*self.now_and_then(.9, "--iso", f"{value:.9g}"), *self.now_and_then(.2, "--dark")]

    @staticmethod
    def to_world(image, index):
        world = [0., 0., 0.]
        image.TransformContinuousIndexToPhysicalPoint(index, world)
        return world

    def start(self, image, field):
        kind = self.rng.choice(("icosahedron", "seeds", "iso-surface", "input-surface"),
                               p=(.55, .15, .15, .15))
        arguments = ["--initialization", str(kind)]
        if kind == "seeds":
            voxels = np.argwhere(field >= np.quantile(field, .9))  # probably in the object
            for voxel in self.rng.permutation(voxels)[:self.rng.integers(0, 5)]:
                point = self.to_world(image, voxel[::-1].astype(float))
                arguments += ["--seed-position", ",".join(f"{x:.15g}" for x in point)]
            arguments += self.now_and_then(
                .3, "--seed-radius", f"{self.spacing.max() * self.rng.uniform(1, 5):.6g}")
        elif kind == "input-surface":
            arguments += ["--initial-surface", self.initial_surface(image)]
        return arguments

    def initial_surface(self, image):
        """Write a closed ball or box, rotated and stretched, with triangles of any shape."""
        if self.chance(.5):
            source = vtkSphereSource()
            source.SetThetaResolution(int(self.rng.integers(4, 40)))
            source.SetPhiResolution(int(self.rng.integers(4, 40)))
        else:
            source = vtkCubeSource()
        clean, triangles = vtkCleanPolyData(), vtkTriangleFilter()
        clean.SetInputConnection(source.GetOutputPort())
        triangles.SetInputConnection(clean.GetOutputPort())
        low, high = np.reshape(image.GetBounds(), (3, 2)).T
        transform = vtkTransform()
        transform.Translate((low + high) / 2)
        transform.Scale((high - low) * self.rng.uniform(.3, .9))
        transform.RotateWXYZ(self.rng.uniform(0, 360), *self.rng.normal(size=3))
        transform.Scale(self.rng.uniform(.2, 1, 3))
        to_image = vtkTransformPolyDataFilter()
        to_image.SetTransform(transform)
        to_image.SetInputConnection(triangles.GetOutputPort())
        to_image.SetOutputPointsPrecision(1)
        to_image.Update()
        return write(vtkXMLPolyDataWriter(), to_image.GetOutput(), self.folder, "given.vtp")

    def pyramid(self):
        arguments = []
        last = int(np.log(self.size.min() / 8) / np.log(3 ** .5))  # last level of eight voxels
        if self.chance(.25):
            arguments += ["--finest", str(self.rng.integers(-1, min(last, 2) + 1)), "--levels",
                          str(last + 1)]
        elif self.chance(.2):
            level = str(self.rng.integers(0, last + 1))
            arguments += ["--coarsest", level, "--levels", str(last + 1)]
        return [
            *arguments,
            *self.now_and_then(.25, "--metric", "voxels"),
            *self.now_and_then(.15, "--minimum-level-size", str(self.rng.integers(4, 16))),
            *self.now_and_then(.1, "--reduction-factor", self.number(1.2, 1.73)),
            *self.now_and_then(.15, "--sampling-ratio", self.number(.693, 1)),
            *self.now_and_then(.15, "--border", "replicate"),
            *self.now_and_then(.3, "--recovery",
                               str(self.rng.choice(("none", "objects-and-cavities")))),
            *self.now_and_then(.1, "--minimum-part-size", str(self.rng.integers(1, 100))),
            *self.now_and_then(.1, "--keep", "largest")]

    def tolerance(self):
        """Return a random tolerance, from one that cannot be met to several voxels."""
        smallest = self.spacing.min()
        return [] if not self.chance(.3) else [
            "--tolerance", f"{smallest * 10 ** self.rng.uniform(-2, .7):.3g}",
            *self.now_and_then(.3, "--gradation", self.number(.02, .3)),
            *self.now_and_then(.3, "--maximum-edge-length",
                               f"{smallest * self.rng.uniform(1, 12):.3g}")]

    def stop(self):
        kind = self.rng.random()
        arguments = []
        if kind < .35:
            arguments = ["--iterations", str(self.rng.integers(1, 11))]
        elif kind < .55:
            arguments = ["--iterations", str(int(10 ** self.rng.uniform(1, 2.5)))]
        elif kind < .65:
            arguments = ["--time-limit", f"{10 ** self.rng.uniform(-2, .5):.3g}"]
        # A longer interval for long runs.
        interval = int(self.rng.choice((1, 3, 7))) if kind < .35 else int(self.rng.integers(20, 90))
        return arguments + self.now_and_then(.5, "--snapshots", "snapshots", "--snapshot-interval",
                                             str(interval))

    def forces(self):
        return [
            *self.now_and_then(.1, "--tension", self.number(0, 1)),
            *self.now_and_then(.1, "--elasticity", self.number(0, 1)),
            *self.now_and_then(.1, "--isopotential", self.number(.1, 3)),
            *self.now_and_then(.1, "--gradient", self.number(0, 2)),
            *self.now_and_then(.1, "--friction", self.number(.2, 6)),
            *self.now_and_then(.1, "--convergence", f"{10 ** self.rng.uniform(-5, -1):.3g}"),
            *self.now_and_then(.1, "--no-topology-changes"),
            *self.now_and_then(.1, "--no-freeze"),
            *self.now_and_then(.1, "--no-snap")]
