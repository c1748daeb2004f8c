# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Random volumes for the campaign: shapes, grids, types of voxels and transforms.

Shapes are fields [z, y, x] that are about 1 in objects and 0 elsewhere.
"""

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonDataModel import vtkImageData

TYPES = ("u1", "i1", "u2", "i2", "u4", "i4", "i8", "f4", "f8")


def size_and_spacing(rng, most_voxels):
    """Return voxels and voxel distances (up to 1 : 20) along x, y, z."""
    while True:
        size = np.exp(rng.uniform(np.log(8), np.log(80), 3)).astype(int)
        if size.prod() <= most_voxels:
            break
    spacing = np.exp(rng.uniform(0, np.log(20), 3)) if rng.random() < .7 else np.ones(3)
    if rng.random() < .3:  # slices of a scanner: two distances are equal
        spacing[1] = spacing[0]
    return size, spacing * 10 ** rng.uniform(-2, 1)


def direction(rng):
    """Return a direction matrix: identity, permuted and mirrored axes, or any orthogonal matrix."""
    kind = rng.random()
    if kind < .4:
        return np.eye(3)
    if kind < .6:
        return np.eye(3)[rng.permutation(3)] * rng.choice((-1, 1), 3)
    turned, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    return turned


def smoothed(field, sigma):
    """Return a periodic Gaussian filter of the field. sigma: voxels along z, y, x."""
    spectrum = np.fft.rfftn(field)
    frequencies = np.meshgrid(*map(np.fft.fftfreq, field.shape[:2]),
                              np.fft.rfftfreq(field.shape[2]), indexing="ij")
    exponent = sum((2 * np.pi * f * s) ** 2 for f, s in zip(frequencies, sigma))
    return np.fft.irfftn(spectrum * np.exp(-exponent / 2), field.shape)


def scaled(field):
    low, high = field.min(), field.max()
    return (field - low) / (high - low) if high > low else np.full(field.shape, .5)


class Shapes:
    """Fields on one grid. Lengths are in voxels, or in world units with `in_world`."""

    def __init__(self, rng, size, spacing, in_world):
        self.rng = rng
        self.shape = tuple(size[::-1])
        steps = spacing[::-1] / spacing.min() if in_world else np.ones(3)
        self.steps = steps
        self.extent = np.array(self.shape) * steps
        self.positions = np.stack([n * s for n, s in zip(np.indices(self.shape), steps)], -1)

    def noise(self):
        return self.rng.random(self.shape)

    def smooth_noise(self):
        return scaled(smoothed(self.noise(), self.rng.uniform(.5, 5) / self.steps))

    def blobs(self):
        field = np.zeros(self.shape)
        for _ in range(self.rng.integers(1, 9)):
            centre = self.rng.random(3) * self.extent
            axes = self.extent.min() * self.rng.uniform(.1, .7, 3)
            distance = np.sqrt((((self.positions - centre) / axes) ** 2).sum(-1))
            field = np.maximum(field, np.clip(.5 + axes.min() * (1 - distance), 0, 1))
        return field

    def tubes(self):
        """Bent tubes that may cross."""
        field = np.zeros(self.shape)
        for _ in range(self.rng.integers(1, 5)):
            radius = self.rng.uniform(.5, 4)
            points = self.rng.random((self.rng.integers(2, 5), 3)) * self.extent
            for a, b in zip(points[:-1], points[1:]):
                along = (self.positions - a) @ (b - a) / max(1e-9, (b - a) @ (b - a))
                nearest = a + np.clip(along, 0, 1)[..., None] * (b - a)
                distance = np.linalg.norm(self.positions - nearest, axis=-1)
                field = np.maximum(field, np.clip(.5 + radius - distance, 0, 1))
        return field

    def sheets(self):
        """Plates as thin as half a voxel, at any angle."""
        field = np.zeros(self.shape)
        for _ in range(self.rng.integers(1, 5)):
            normal = self.rng.normal(size=3)
            normal /= np.linalg.norm(normal)
            height = np.abs((self.positions - self.rng.random(3) * self.extent) @ normal)
            field = np.maximum(field, np.clip(.5 + self.rng.uniform(.25, 3) - height, 0, 1))
        return field

    def gyroid(self):
        x, y, z = np.moveaxis(self.positions * 2 * np.pi / self.rng.uniform(6, 40), -1, 0)
        field = np.sin(x) * np.cos(y) + np.sin(y) * np.cos(z) + np.sin(z) * np.cos(x)
        return scaled(np.abs(field) if self.rng.random() < .3 else field)

    def shell(self):
        """A hollow ball, or several in each other, with holes."""
        radius = np.linalg.norm((self.positions / self.extent - .5) * 2, axis=-1)
        wall = np.sin(radius * np.pi * self.rng.uniform(1, 6))
        holes = self.tubes() if self.rng.random() < .5 else 0
        return np.clip(scaled(wall * (radius < 1)) - holes, 0, 1)

    def checkers(self):
        side = self.rng.integers(1, 12, 3)
        odd = sum(n // s for n, s in zip(np.indices(self.shape), side)) % 2
        return odd.astype(float)

    def thin(self):
        """Single voxels, rows and planes."""
        field = np.zeros(self.shape)
        for _ in range(self.rng.integers(1, 20)):
            where = [int(self.rng.integers(n)) for n in self.shape]
            for axis in self.rng.permutation(3)[:self.rng.integers(0, 3)]:
                where[axis] = slice(None)
            field[tuple(where)] = 1
        return field

    def box(self):
        """A box with sharp edges, up to the border or not."""
        ends = [sorted(self.rng.integers(-2, n + 3, 2)) for n in self.shape]
        inside = [(n >= low) & (n < high) for n, (low, high) in zip(np.indices(self.shape), ends)]
        return np.logical_and.reduce(inside).astype(float)

    def ramp(self):
        return scaled(self.positions @ self.rng.normal(size=3))

    def constant(self):
        return np.full(self.shape, float(self.rng.integers(2)))

    def any(self):
        kinds = {"noise": 1, "smooth_noise": 6, "blobs": 6, "tubes": 6, "sheets": 5, "gyroid": 4,
                 "shell": 5, "checkers": 2, "thin": 3, "box": 2, "ramp": 1, "constant": 1}
        weights = np.array(list(kinds.values()), float)
        return str(self.rng.choice(list(kinds), p=weights / weights.sum()))


def random_field(rng, size, spacing):
    """Return the field, about 0 to 1, and its name."""
    shapes = Shapes(rng, size, spacing, rng.random() < .5)
    names = [shapes.any()]
    field = getattr(shapes, names[0])()
    if rng.random() < .3:
        names.append(shapes.any())
        combine = rng.choice((np.maximum, np.minimum, np.subtract))
        field = combine(field, getattr(shapes, names[1])())
    if rng.random() < .2:
        names.append("smoothed")
        field = smoothed(field, rng.uniform(.3, 2) / shapes.steps)
    if rng.random() < .4:
        names.append("noisy")
        field = field + rng.normal(0, 10 ** rng.uniform(-3, -.5), field.shape)
    return field, "+".join(names)


class LabelMaps(Shapes):
    """Small maps of up to 40 labels: integers [z, y, x]; 0 is the background."""

    def __init__(self, rng, size, spacing):
        super().__init__(rng, size, spacing, rng.random() < .5)
        self.labels = np.zeros(self.shape, int)
        self.count = int(rng.integers(10, 41) if rng.random() < .2 else rng.integers(1, 10))
        self.centers = rng.random((self.count, 3)) * self.extent

    def shapes(self):
        """Any shapes over each other."""
        for label in range(1, min(self.count, 6) + 1):
            field = scaled(getattr(self, self.any())())
            self.labels[field > self.rng.uniform(.3, .9)] = label

    def touching_blobs(self):
        for label, centre in enumerate(self.centers, 1):
            axes = self.extent.min() * self.rng.uniform(.1, .5, 3)
            self.labels[(((self.positions - centre) / axes) ** 2).sum(-1) < 1] = label

    def grains(self):
        """Voronoi cells, some of them background."""
        distances = [np.linalg.norm(self.positions - p, axis=-1) for p in self.centers]
        self.labels = np.argmin(distances, 0) + self.rng.integers(0, 2)

    def layers(self):
        """Layers around each other, such as skin and bone, from half a voxel thick."""
        axes = self.rng.uniform(.5, 1.5, 3) * np.sign(self.rng.random(3) - .2).clip(0)
        height = np.linalg.norm((self.positions - self.extent / 2) * axes, axis=-1)
        height += self.rng.choice((0, 0, 2)) * (self.smooth_noise() - .5)
        ends = np.cumsum(self.rng.uniform(.5, 4, self.count + 1))
        self.labels = np.digitize(height, ends) % (self.count + 1)

    def plates(self):
        for label, center in enumerate(self.centers, 1):
            normal = direction(self.rng)[0]
            height = np.abs((self.positions - center) @ normal)
            self.labels[height < self.rng.uniform(.5, 1.5)] = label

    def mixture(self):
        """A mixture of any grain size, from single voxels to smooth parts."""
        sigma = 10 ** self.rng.uniform(-1, .6) / self.steps
        fields = [smoothed(self.rng.random(self.shape), sigma) for _ in range(self.count + 1)]
        self.labels = np.argmax(fields, 0)

    def slices(self):
        """Stacks of plates with a few or no empty slices between them."""
        axis, ends = self.rng.integers(3), np.cumsum(self.rng.integers(0, 4, 2 * self.count + 1))
        part = np.digitize(np.arange(self.shape[axis]), ends)
        label = np.where(part % 2 == 1, (part + 1) // 2, 0) % (self.count + 1)
        steps = [n // step for n, step in zip(np.indices(self.shape), self.rng.integers(2, 40, 3))]
        steps[axis] = np.indices(self.shape)[axis]
        self.labels = label[sum(steps) % self.shape[axis]]

    def rods(self):
        """Rods of one or two voxels along axes and diagonals; voxels may touch at corners only."""
        for label in range(1, self.count + 1):
            voxel, step = self.rng.integers(0, self.shape), self.rng.integers(-1, 2, 3)
            wide = self.rng.integers(1, 3)
            for _ in range(self.rng.integers(1, max(self.shape))):
                where = tuple(slice(max(a, 0), max(a + wide, 0)) for a in voxel)
                self.labels[where] = label
                voxel = voxel + step

    def isolated_voxels(self):
        """Random voxels, few or nearly all."""
        some = self.rng.random(self.shape) < 10 ** self.rng.uniform(-3, 0)
        self.labels[some] = self.rng.integers(1, self.count + 1, some.sum())

    def nested(self):
        low, high = np.zeros(3, int), np.array(self.shape)
        for label in range(1, self.count + 1):
            low, high = low + self.rng.integers(0, 3, 3), high - self.rng.integers(0, 3, 3)
            self.labels[tuple(map(slice, low.clip(0), high.clip(0)))] = label


def random_labels(rng):
    """Return a small map, its voxel distances (up to 1 : 20) and its name."""
    size = np.exp(rng.uniform(np.log(8), np.log(36), 3)).astype(int)
    spacing = np.exp(rng.uniform(0, np.log(20), 3)) if rng.random() < .5 else np.ones(3)
    long = (spacing / spacing.min()).prod()  # the number of triangles grows by this factor
    size = np.maximum(size * min(1, 1e5 / (long * size.prod())) ** (1 / 3), 5).astype(int)
    factor = 1 + int(rng.random() < .15)
    maps, names = LabelMaps(rng, -(-size // factor), spacing), []
    kinds = {"touching_blobs": .1, "grains": .15, "layers": .1, "plates": .1, "slices": .1,
             "rods": .1, "isolated_voxels": .1, "mixture": .15, "nested": .05, "shapes": .05}
    while not maps.labels.any() or rng.random() < .25:
        before, names = maps.labels, names + [str(rng.choice(list(kinds), p=list(kinds.values())))]
        getattr(maps, names[-1])()
        if rng.random() < .5:
            maps.labels = np.where(maps.labels, maps.labels, before)
    labels = np.kron(maps.labels, np.ones((factor,) * 3, int))
    return labels, spacing * 10 ** rng.uniform(-2, 1), "+".join(names + ["twice"] * (factor - 1))


def to_type(rng, field, name):
    """Convert to a type, in all or a part of its range."""
    kind = np.dtype(name)
    if kind.kind == "f":
        return (field * 10 ** rng.uniform(-3, 6) + rng.normal() * 100).astype(kind)
    information = np.iinfo(kind)
    top = min(information.max, int(10 ** rng.uniform(.5, 6)))
    low = max(information.min, int(rng.choice((0, -top))))
    return np.round(np.clip(low + field * (top - low), information.min,
                            information.max)).astype(kind)


def make_image(rng, voxels, spacing):
    image = vtkImageData()
    image.SetDimensions(voxels.shape[::-1])
    image.SetSpacing(spacing)
    far = rng.choice((0, 1, 1000, 30000))  # in voxel distances
    image.SetOrigin(rng.normal(size=3) * far * spacing)
    image.SetDirectionMatrix(direction(rng).ravel())
    add_array(image, "density", voxels)
    image.GetPointData().SetActiveScalars("density")
    return image


def add_array(image, name, voxels):
    array = numpy_to_vtk(np.ascontiguousarray(voxels).ravel(), deep=True)
    array.SetName(name)
    image.GetPointData().AddArray(array)
