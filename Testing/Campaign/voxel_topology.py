# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Topology of the labels of a map, computed from its voxels alone.

A label is connected through voxel faces. It is connected across a voxel edge if its two voxels are
opposite and the two others have two different labels, or one label of later rank. Rank: fewest
voxels first, then the lower number; background and the outside of the map last. In a cell ABCDDCBA,
four labels at two opposite corners each, the label of first rank is connected through the corner.
"""

import itertools

import numpy as np

OCTANTS = list(itertools.product((0, 1), repeat=3))  # number 4 z + 2 y + x; axes z, y, x


def ring(axis, high):
    """Return the octants at a side of a cell, in cyclic order."""
    bits = [4, 2, 1]
    own, b, c = bits[axis], *(n for n in bits if n != bits[axis])
    return [high * own + n for n in (0, b, b + c, c)]


def octants_of(voxels):
    """Return [cell, octant]: the eight voxels around each corner."""
    ends = [[slice(o, n - 1 + o) for o, n in zip(octant, voxels.shape)] for octant in OCTANTS]
    return np.stack([voxels[tuple(end)].ravel() for end in ends], -1)


def joined(four, rank):
    """Return for both diagonals of four labels in cyclic order whether they are joined."""
    a, b, c, d = four.T
    first, second = (a == c) & (a != b) & (a != d), (b == d) & (b != a) & (b != c)
    is_first = first & (~second | (rank[a] < rank[b]))
    return is_first, second & ~is_first


def roots_of(count, pairs):
    """Return for each number from 0 the smallest number connected to it."""
    a, b = np.concatenate(pairs, 1)
    root = np.arange(count)
    while True:
        low, high = np.minimum(root[a], root[b]), np.maximum(root[a], root[b])
        if (low == high).all():
            return root
        np.minimum.at(root, high, low)
        while (root != root[root]).any():
            root = root[root]


def parts_without(label, voxels, rank):
    """Return the components of the complement of a label, by the complementary connectivity."""
    cells, number = octants_of(voxels), octants_of(np.arange(voxels.size).reshape(voxels.shape))
    pairs = []
    for axis, high in itertools.product(range(3), (0, 1)):  # inner squares occur twice
        four, ids = cells[:, ring(axis, high)], number[:, ring(axis, high)]
        diagonals = joined(four, rank)
        for n in range(4):
            pairs.append((n, (n + 1) % 4, four, ids, True))
        for n in (0, 1):
            pairs.append((n, n + 2, four, ids, ~diagonals[1 - n]))
    links = []
    for a, b, four, ids, is_open in pairs:
        where = (four[:, a] != label) & (four[:, b] != label) & is_open
        links.append(ids[where][:, [a, b]].T)
    root = roots_of(voxels.size, links)
    return len(np.unique(root[voxels.ravel() != label]))


def topology_of(labels, is_in_box=False):
    """Return {label: (Euler characteristic, components, cavities)} without 0, the background.

    labels: integers [z, y, x]; is_in_box: the map ends at the sides of a box, not at background.
    """
    names, voxels, counts = np.unique(labels, return_inverse=True, return_counts=True)
    voxels, outside = np.pad(voxels.reshape(labels.shape), 1, constant_values=-1), len(names)
    if not is_in_box and 0 in names:
        outside = int(np.flatnonzero(names == 0)[0])
    voxels[voxels < 0] = outside
    counts = np.append(counts.astype(float), np.inf)
    counts[:-1][names == 0] = counts.max(where=counts < np.inf, initial=0) + 1
    rank = np.argsort(np.argsort(counts, kind="stable"))
    cells, number = octants_of(voxels), octants_of(np.arange(voxels.size).reshape(voxels.shape))
    links, joins, squares, faces = [], [], [], []
    edges = [(o, o | bit) for bit in (1, 2, 4) for o in range(8) if not o & bit]
    near = [(a, b, cells[:, a] == cells[:, b]) for a, b in edges]
    for axis, high in itertools.product(range(3), (0, 1)):
        at = ring(axis, high)
        four = cells[:, at]
        for n, where in enumerate(joined(four, rank)):
            near.append((at[n], at[n + 2], where))
            joins += [four[where, n]] * (1 - high)  # each edge is the low side of one cell
        squares += [four[(four == four[:, :1]).all(1), 0]] * (1 - high)
    faces = [cells[where, 0] for a, _, where in near[:12] if a == 0]
    opposite = (cells == cells[:, ::-1]).all(1)
    opposite &= (np.sort(cells[:, :4], 1)[:, 1:] != np.sort(cells[:, :4], 1)[:, :-1]).all(1)
    first = np.argmin(rank[cells[:, :4]], 1)
    near += [(o, 7 - o, opposite & (first == o)) for o in range(4)]
    region, before = np.tile(np.arange(8), (len(cells), 1)), None
    while not np.array_equal(region, before):
        before = region.copy()
        for a, b, where in near:
            region[where, a] = region[where, b] = np.minimum(region[where, a], region[where, b])
    links = [number[where][:, [a, b]].T for a, b, where in near]
    root = roots_of(voxels.size, links)

    def number_of(items):
        return np.bincount(np.concatenate([i.ravel() for i in items]), minlength=len(counts))
    euler = (-7 * number_of([voxels]) + 3 * number_of(faces) + number_of(joins)
             - number_of(squares) + number_of([cells[region == np.arange(8)]]))
    components = number_of([voxels.ravel()[root == np.arange(voxels.size)]])
    result = {}
    for n, name in enumerate(names):
        if name != 0:
            where = np.argwhere(voxels == n)
            box = tuple(slice(a - 1, b + 2) for a, b in zip(where.min(0), where.max(0)))
            cavities = parts_without(n, voxels[box], rank) - 1
            result[int(name)] = (int(euler[n]), int(components[n]), cavities)
    return result
