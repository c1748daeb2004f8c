# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Cut a closed surface at planes with well-shaped triangles, for tetrahedral meshing: move vertices
near a plane onto it before the cut, then collapse short edges."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

# In edge lengths:
SNAP_DISTANCE = 0.35  # closer vertices are moved onto the plane
MINIMUM_LENGTH = 0.6  # shorter edges at a cap are collapsed
MAXIMUM_LENGTH = 1.5  # longer edges between two caps are split

MINIMUM_COSINE = 0.7  # between normals before and after a collapse
MAXIMUM_ROUNDS = 12


class NotFlat(Exception):
    """The surface cannot be closed by planar caps."""


class Plane(NamedTuple):
    """A plane perpendicular to an axis of the image."""
    face: int         # 1 to 6, as in the cell array BoxFace
    axis: int
    sign: int         # of the outward normal
    position: float   # along the axis

    def distances(self, points: np.ndarray) -> np.ndarray:
        """Return signed distances, positive outside."""
        return self.sign * (points[:, self.axis] - self.position)

    def contains(self, points: np.ndarray) -> np.ndarray:
        """Return whether points lie exactly in the plane."""
        return points[:, self.axis] == self.position


def normals_of(points: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Return normals whose length is twice the area."""
    a, b, c = np.moveaxis(points[triangles], 1, 0)
    return np.cross(b - a, c - a)


def edges_of(triangles: np.ndarray) -> np.ndarray:
    """Return directed edges; edge i of triangle t has index 3 t + i."""
    return np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=-1).reshape(-1, 2)


def unmatched(edges: np.ndarray) -> np.ndarray:
    """Return which directed edges lack the opposite edge. Raise NotFlat if an edge occurs twice."""
    size = edges.max(initial=0) + 1
    keys = edges @ (size, 1)
    if len(np.unique(keys)) < len(keys):
        raise NotFlat
    return ~np.isin(keys, edges @ (1, size))


def _turns_more(old: np.ndarray, new: np.ndarray, minimum: float) -> np.ndarray:
    """Return whether the cosine of the angle between vectors is less than `minimum`."""
    lengths = np.linalg.norm(old, axis=1) * np.linalg.norm(new, axis=1)
    return (old * new).sum(1) < minimum * lengths


class Cutter:
    """A surface to cut, in coordinates along the axes of the image. `loops` holds the directed
    boundary edges of the caps, counter-clockwise seen from outside."""

    def __init__(self, points: np.ndarray, data: np.ndarray, triangles: np.ndarray) -> None:
        self.points, self.data, self.triangles = points.copy(), data, triangles
        self.source = np.arange(len(triangles))
        self.loops, self.faces = np.zeros((0, 2), int), np.zeros(0, int)
        self.planes: list[Plane] = []
        edges = edges_of(triangles)
        lengths = np.linalg.norm(points[edges[:, 0]] - points[edges[:, 1]], axis=1)
        self.length = float(lengths.mean())
        count = np.bincount(edges[:, 0], minlength=len(points))
        # Mean edge length at each point.
        self.sizes = np.bincount(edges[:, 0], lengths, len(points)) / np.maximum(count, 1)

    def add_points(self, one: np.ndarray, other: np.ndarray, fraction: np.ndarray) -> None:
        """Add points with interpolated data between pairs of points."""
        for name in ("points", "data", "sizes"):
            values = getattr(self, name)
            weight = fraction[:, None] if values.ndim == 2 else fraction
            added = values[one] + weight * (values[other] - values[one])
            setattr(self, name, np.concatenate([values, added]))

    def add_loops(self, edges: np.ndarray, faces: np.ndarray) -> None:
        self.loops = np.concatenate([self.loops, edges])
        self.faces = np.concatenate([self.faces, np.broadcast_to(faces, len(edges))])

    # ---- Cuts ----

    def snap(self, plane: Plane) -> None:
        """Move vertices near a plane onto it, along the surface where it is steep, else
        perpendicular to the plane. Vertices that would flip triangles are not moved."""
        distances = plane.distances(self.points)
        near = np.flatnonzero((np.abs(distances) < SNAP_DISTANCE * self.sizes) & (distances != 0))
        old = normals_of(self.points, self.triangles)
        normals = np.zeros_like(self.points)
        np.add.at(normals, self.triangles, old[:, None])
        normals = normals[near] / np.maximum(np.linalg.norm(normals[near], axis=1), 1e-300)[:, None]
        across = normals[:, plane.axis] * plane.sign
        before = self.points[near]
        fraction = distances[near] * across / np.maximum(1 - across ** 2, 0.5)
        after = before + fraction[:, None] * normals
        for other in self.planes:
            after[other.contains(before), other.axis] = other.position
        after[:, plane.axis] = plane.position
        moved = np.zeros(len(self.points), bool)
        moved[near] = True
        for _ in range(MAXIMUM_ROUNDS):
            self.points[near] = np.where(moved[near, None], after, before)
            flat = plane.contains(self.points)[self.triangles].all(axis=1)
            turned = _turns_more(old, normals_of(self.points, self.triangles), 0.3) & ~flat
            if not moved[self.triangles[turned]].any():
                return
            moved[self.triangles[turned]] = False
        self.points[near] = np.where(moved[near, None], after, before)

    def cut(self, plane: Plane) -> None:
        """Remove the part of the surface beyond a plane."""
        distances = plane.distances(self.points)

        def classify(cells: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
            minimum, maximum = distances[cells].min(1), distances[cells].max(1)
            return (minimum < 0) & (maximum <= 0), (minimum < 0) & (maximum > 0)

        kept, split = classify(self.triangles)
        kept_loops, split_loops = classify(self.loops) if len(self.loops) else (self.faces > 0,) * 2
        edges = np.concatenate([edges_of(self.triangles[split]), self.loops[split_loops]])
        crossing = distances[edges].prod(axis=1) < 0
        pairs, numbers = np.unique(np.sort(edges[crossing], axis=1), axis=0, return_inverse=True)
        added = np.full(len(edges), -1)
        added[crossing] = len(self.points) + numbers.ravel()
        one, other = pairs.T
        self.add_points(one, other, distances[one] / (distances[one] - distances[other]))
        self.points[len(distances):, plane.axis] = plane.position
        count = 3 * int(split.sum())
        pieces, owner = self._pieces(self.triangles[split], distances,
                                     added[:count].reshape(-1, 3))
        self.triangles = np.concatenate([self.triangles[kept], pieces])
        self.source = np.concatenate([self.source[kept], self.source[split][owner]])
        halves = np.where(distances[self.loops[split_loops]] < 0, self.loops[split_loops],
                          added[count:, None])
        faces = self.faces[split_loops]
        self.loops, self.faces = self.loops[kept_loops], self.faces[kept_loops]
        self.add_loops(halves, faces)
        for cap in self.planes:
            if cap.axis != plane.axis:
                self._close(cap, plane)
        edges = np.concatenate([edges_of(self.triangles), self.loops])
        loops = edges[unmatched(edges)][:, ::-1]
        if not plane.contains(self.points)[loops].all():
            raise NotFlat
        self.add_loops(loops, plane.face)
        self.planes.append(plane)

    def _pieces(self, triangles: np.ndarray, distances: np.ndarray, added: np.ndarray
                ) -> tuple[np.ndarray, np.ndarray]:
        """Return the parts of triangles inside the plane, and the index of the triangle of each."""
        corners = np.stack([triangles, added], axis=-1).reshape(-1, 6)
        there = np.stack([distances[triangles] <= 0, added >= 0], axis=-1).reshape(-1, 6)
        order = np.argsort(~there, axis=1, kind="stable")[:, :4]
        corners = np.take_along_axis(corners, order, axis=1)
        quads = np.flatnonzero(there.sum(1) == 4)
        single = np.flatnonzero(there.sum(1) == 3)
        corner_points = self.points[corners[quads]]
        turn = (np.linalg.norm(corner_points[:, 0] - corner_points[:, 2], axis=1)
                > np.linalg.norm(corner_points[:, 1] - corner_points[:, 3], axis=1))
        # Split quads along the shorter diagonal.
        of_quads = np.where(turn[:, None], np.roll(corners[quads], -1, axis=1), corners[quads])
        return (np.concatenate([corners[single, :3], of_quads[:, :3], of_quads[:, [0, 2, 3]]]),
                np.concatenate([single, quads, quads]))

    def _close(self, cap: Plane, plane: Plane) -> None:
        """Close the boundary of a cap that a plane has cut, by edges in both planes."""
        loops, size = self.loops[self.faces == cap.face], len(self.points)
        excess = np.bincount(loops[:, 0], minlength=size) - np.bincount(loops[:, 1], minlength=size)
        # Direction with the cap on the left, seen from outside.
        direction = np.cross(cap.sign * np.eye(3)[cap.axis], plane.sign * np.eye(3)[plane.axis])
        heights = self.points @ direction
        ends = np.flatnonzero(excess)
        ends = ends[np.argsort(heights[ends])]
        both = cap.contains(self.points) & plane.contains(self.points)
        if not both[ends].all() or (excess[ends] != np.resize([-1, 1], len(ends))).any():
            raise NotFlat
        used = np.zeros(size, bool)
        used[self.triangles] = True
        used[self.loops] = True
        line = np.flatnonzero(both & used)
        line = line[np.argsort(heights[line])]
        # Intervals from a vertex that lacks an outgoing edge to the next one.
        depth = np.cumsum(-excess[line])
        inner = np.flatnonzero(depth > 0)
        self.add_loops(np.stack([line[inner], line[np.minimum(inner + 1, len(line) - 1)]], 1),
                       cap.face)

    # ---- Triangles at the caps ----

    def split(self, pairs: np.ndarray) -> None:
        """Split edges at their midpoints. No triangle may have two of them."""
        size = len(self.points)
        pairs = np.unique(np.sort(pairs, axis=1), axis=0)
        self.add_points(*pairs.T, np.full(len(pairs), 0.5))
        keys = pairs @ (size, 1)

        def found(edges: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
            own = np.sort(edges, axis=1) @ (size, 1)
            at = np.minimum(np.searchsorted(keys, own), len(keys) - 1)
            which = np.flatnonzero(keys[at] == own)
            return which, size + at[which]

        which, middle = found(edges_of(self.triangles))
        owner, corner = which // 3, which % 3
        added = self.triangles[owner]
        added[np.arange(len(owner)), corner] = middle
        self.triangles[owner, (corner + 1) % 3] = middle
        self.triangles = np.concatenate([self.triangles, added])
        self.source = np.concatenate([self.source, self.source[owner]])
        which, middle = found(self.loops)
        halves = np.stack([middle, self.loops[which, 1]], axis=1)
        self.loops[which, 1] = middle
        self.add_loops(halves, self.faces[which])

    def refine(self) -> None:
        """Split edges in a plane that are not boundary edges, move vertices in a plane that are not
        boundary vertices inward, and split long edges between two caps."""
        for plane in self.planes:
            edges, size = edges_of(self.triangles), len(self.points)
            loops = np.isin(edges @ (size, 1), self.loops @ (1, size))
            chords = edges[plane.contains(self.points)[edges].all(axis=1) & ~loops]
            if len(chords):
                self.split(chords)
            touching = np.zeros(len(self.points), bool)
            touching[self.triangles] = True
            touching[self.loops[self.faces == plane.face]] = False
            touching &= plane.contains(self.points)
            self.points[touching, plane.axis] -= plane.sign * SNAP_DISTANCE * self.sizes[touching]
        while True:
            size, ends = len(self.points), self.points[self.loops]
            chosen = np.isin(self.loops @ (size, 1), self.loops @ (1, size))
            chosen &= np.linalg.norm(ends[:, 0] - ends[:, 1], axis=1) > MAXIMUM_LENGTH * self.length
            if not chosen.any():
                return
            self.split(self.loops[chosen])

    def collapse(self) -> None:
        """Collapse short edges at the boundaries of caps where the shape is preserved."""
        from scipy.sparse import coo_matrix
        rejected, size = np.zeros(0, int), len(self.points)
        for _ in range(MAXIMUM_ROUNDS):
            flags = np.zeros(size, int)  # bit set of the planes of each boundary vertex
            for plane in self.planes:
                own = self.loops[self.faces == plane.face]
                flags[own] |= 1 << plane.face
            near = flags > 0
            for _ in range(2):
                band = near[self.triangles].any(axis=1)
                near[self.triangles[band]] = True
            triangles = self.triangles[band]
            edges, count = np.unique(np.sort(edges_of(triangles), axis=1), axis=0,
                                     return_counts=True)
            lengths = np.linalg.norm(self.points[edges[:, 0]] - self.points[edges[:, 1]], axis=1)
            one, other = flags[edges].T
            both = one & other
            # The vertex in the planes of both is kept. Two boundary vertices need a boundary edge.
            short = ((lengths < MINIMUM_LENGTH * self.sizes[edges].mean(axis=1)) & (one + other > 0)
                     & ((both == one) | (both == other)) & ((count == 1) | (one * other == 0))
                     & ~np.isin(edges @ (size, 1), rejected))
            graph = coo_matrix((np.ones(len(edges)), tuple(edges.T)), (size, size)).tocsr()
            graph = graph + graph.T
            found = np.flatnonzero(short)
            common = graph[edges[found, 0]].multiply(graph[edges[found, 1]]).sum(axis=1)
            found = found[np.asarray(common).ravel() == count[found]]
            if len(found) == 0:
                break
            found = found[np.argsort(lengths[found], kind="stable")]
            ends = edges[found[_apart(edges[found], edges, size)]]
            ends = np.where((np.diff(flags[ends], axis=1) < 0), ends[:, ::-1], ends)
            rejected = np.append(rejected, np.sort(ends[self._merge(*ends.T, triangles, flags)],
                                                   axis=1) @ (size, 1))

    def _merge(self, removed: np.ndarray, kept: np.ndarray, triangles: np.ndarray, flags: np.ndarray
               ) -> np.ndarray:
        """Merge vertices into `kept` unless triangles flip or degenerate; return which are
        rejected."""
        equal = (flags[removed] == flags[kept])[:, None]
        positions = np.where(equal, (self.points[removed] + self.points[kept]) / 2,
                             self.points[kept])
        owner, to, points = np.full(len(flags), -1), np.arange(len(flags)), self.points.copy()
        owner[removed] = owner[kept] = np.arange(len(removed))
        to[removed], points[kept] = kept, positions
        whose = owner[triangles].max(axis=1)
        changed, whose = triangles[whose >= 0], whose[whose >= 0]
        after = to[changed]
        turned = _turns_more(normals_of(self.points, changed), normals_of(points, after),
                             MINIMUM_COSINE)
        minimum = np.full(len(removed), 15.0)
        np.minimum.at(minimum, whose, _minimum_angles(self.points, changed))
        worse = turned | (_minimum_angles(points, after) < minimum[whose])
        rejected = np.zeros(len(removed), bool)
        rejected[whose[worse & (after != np.roll(after, 1, axis=1)).all(axis=1)]] = True
        to[removed[rejected]] = removed[rejected]
        self.points[kept[~rejected]] = positions[~rejected]
        self.triangles, self.loops = to[self.triangles], to[self.loops]
        there = (self.triangles != np.roll(self.triangles, 1, axis=1)).all(axis=1)
        self.triangles, self.source = self.triangles[there], self.source[there]
        # Triangles in a plane become part of its caps. Caps without area vanish.
        for plane in self.planes:
            flat = plane.contains(self.points)[self.triangles].all(axis=1)
            self.add_loops(edges_of(self.triangles[flat]), plane.face)
            self.triangles, self.source = self.triangles[~flat], self.source[~flat]
        keys, back = (self.loops @ key * 8 + self.faces for key in ((len(to), 1), (1, len(to))))
        there = (keys != back) & ~np.isin(keys, back)
        self.loops, self.faces = self.loops[there], self.faces[there]
        return rejected


def _minimum_angles(points: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Return the minimum angle of each triangle in degrees."""
    corners, minimum = points[triangles], np.full(len(triangles), np.inf)
    for i in range(3):
        a, b = corners[:, i - 1] - corners[:, i], corners[:, i - 2] - corners[:, i]
        across = np.linalg.norm(np.cross(a, b), axis=1)
        minimum = np.minimum(minimum, np.arctan2(across, (a * b).sum(1)))
    return np.degrees(minimum)


def _apart(chosen: np.ndarray, edges: np.ndarray, size: int) -> np.ndarray:
    """Return which of the chosen edges have no earlier one within two rings."""
    rank = np.full(size, len(chosen))
    for end in chosen.T:
        np.minimum.at(rank, end, np.arange(len(chosen)))
    for _ in range(2):
        wider = rank.copy()
        for one, other in (edges.T, edges.T[::-1]):
            np.minimum.at(wider, one, rank[other])
        rank = wider
    return (rank[chosen] == np.arange(len(chosen))[:, None]).all(axis=1)
