# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""A closed surface that is cut at planes, so that tetrahedra in it have no small angles there:
vertices near a plane are moved onto it before the cut, and short edges at it are collapsed."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

SNAP = 0.35  # in edge lengths: vertices that are nearer to a plane are moved onto it
SHORT = 0.6   # in edge lengths: shorter edges at a cap are collapsed
LONG = 1.5    # in edge lengths: longer edges between two caps are divided
TURNED = 0.7  # least cosine between normals before and after
ROUNDS = 12


class NotFlat(Exception):
    """The surface cannot be closed at these planes."""


class Plane(NamedTuple):
    """A plane across an axis of the image."""
    face: int         # as the cell array BoxFace: 1 to 6
    axis: int
    sign: int         # of the normal, which points out of the image
    position: float   # along the axis

    def distances(self, points: np.ndarray) -> np.ndarray:
        """Positive outside."""
        return self.sign * (points[:, self.axis] - self.position)

    def holds(self, points: np.ndarray) -> np.ndarray:
        """Whether points lie in it exactly."""
        return points[:, self.axis] == self.position


def normals_of(points: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Normals twice as long as the areas."""
    a, b, c = np.moveaxis(points[triangles], 1, 0)
    return np.cross(b - a, c - a)


def edges_of(triangles: np.ndarray) -> np.ndarray:
    """Directed edges; 3 t + i is edge i of triangle t."""
    return np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=-1).reshape(-1, 2)


def unmatched(edges: np.ndarray) -> np.ndarray:
    """Which directed edges lack the opposite one. Throw NotFlat if an edge is there twice."""
    size = edges.max(initial=0) + 1
    keys = edges @ (size, 1)
    if len(np.unique(keys)) < len(keys):
        raise NotFlat
    return ~np.isin(keys, edges @ (1, size))


def _differ(old: np.ndarray, new: np.ndarray, least: float) -> np.ndarray:
    """Whether vectors turn by an angle of a smaller cosine."""
    lengths = np.linalg.norm(old, axis=1) * np.linalg.norm(new, axis=1)
    return (old * new).sum(1) < least * lengths


class Cutter:
    """The surface. Positions are along the axes of the image. Caps are stored as `rims`: the
    directed edges that bound them, counterclockwise seen from outside."""

    def __init__(self, points: np.ndarray, data: np.ndarray, triangles: np.ndarray) -> None:
        self.points, self.data, self.triangles = points.copy(), data, triangles
        self.source = np.arange(len(triangles))
        self.rims, self.faces = np.zeros((0, 2), int), np.zeros(0, int)
        self.planes: list[Plane] = []
        edges = edges_of(triangles)
        lengths = np.linalg.norm(points[edges[:, 0]] - points[edges[:, 1]], axis=1)
        self.length = float(lengths.mean())
        count = np.bincount(edges[:, 0], minlength=len(points))
        # The mean length of edges at each point.
        self.sizes = np.bincount(edges[:, 0], lengths, len(points)) / np.maximum(count, 1)

    def add_points(self, one: np.ndarray, other: np.ndarray, share: np.ndarray) -> None:
        """Add points between others, with what they have."""
        for name in ("points", "data", "sizes"):
            values = getattr(self, name)
            weight = share[:, None] if values.ndim == 2 else share
            added = values[one] + weight * (values[other] - values[one])
            setattr(self, name, np.concatenate([values, added]))

    def add_rims(self, edges: np.ndarray, faces: np.ndarray) -> None:
        """Add edges that bound caps."""
        self.rims = np.concatenate([self.rims, edges])
        self.faces = np.concatenate([self.faces, np.broadcast_to(faces, len(edges))])

    # ---- Cuts ----

    def snap(self, plane: Plane) -> None:
        """Move vertices near the plane onto it: along the surface where that is steep, otherwise
        straight. What turns triangles over stays."""
        distances = plane.distances(self.points)
        near = np.flatnonzero((np.abs(distances) < SNAP * self.sizes) & (distances != 0))
        old = normals_of(self.points, self.triangles)
        normals = np.zeros_like(self.points)
        np.add.at(normals, self.triangles, old[:, None])
        normals = normals[near] / np.maximum(np.linalg.norm(normals[near], axis=1), 1e-300)[:, None]
        across = normals[:, plane.axis] * plane.sign
        before = self.points[near]
        share = distances[near] * across / np.maximum(1 - across ** 2, 0.5)
        after = before + share[:, None] * normals
        for other in self.planes:
            after[other.holds(before), other.axis] = other.position
        after[:, plane.axis] = plane.position
        moved = np.zeros(len(self.points), bool)
        moved[near] = True
        for _ in range(ROUNDS):
            self.points[near] = np.where(moved[near, None], after, before)
            flat = plane.holds(self.points)[self.triangles].all(axis=1)
            turned = _differ(old, normals_of(self.points, self.triangles), 0.3) & ~flat
            if not moved[self.triangles[turned]].any():
                return
            moved[self.triangles[turned]] = False
        self.points[near] = np.where(moved[near, None], after, before)

    def cut(self, plane: Plane) -> None:
        """Remove what lies beyond the plane."""
        distances = plane.distances(self.points)

        def sorted_out(cells: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
            least, most = distances[cells].min(1), distances[cells].max(1)
            return (least < 0) & (most <= 0), (least < 0) & (most > 0)

        kept, split = sorted_out(self.triangles)
        kept_rims, split_rims = sorted_out(self.rims) if len(self.rims) else (self.faces > 0,) * 2
        edges = np.concatenate([edges_of(self.triangles[split]), self.rims[split_rims]])
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
        halves = np.where(distances[self.rims[split_rims]] < 0, self.rims[split_rims],
                          added[count:, None])
        faces = self.faces[split_rims]
        self.rims, self.faces = self.rims[kept_rims], self.faces[kept_rims]
        self.add_rims(halves, faces)
        for cap in self.planes:
            if cap.axis != plane.axis:
                self._close(cap, plane)
        edges = np.concatenate([edges_of(self.triangles), self.rims])
        rims = edges[unmatched(edges)][:, ::-1]
        if not plane.holds(self.points)[rims].all():
            raise NotFlat
        self.add_rims(rims, plane.face)
        self.planes.append(plane)

    def _pieces(self, triangles: np.ndarray, distances: np.ndarray, added: np.ndarray
                ) -> tuple[np.ndarray, np.ndarray]:
        """The parts of triangles within the plane, and of which triangle each is."""
        corners = np.stack([triangles, added], axis=-1).reshape(-1, 6)
        there = np.stack([distances[triangles] <= 0, added >= 0], axis=-1).reshape(-1, 6)
        order = np.argsort(~there, axis=1, kind="stable")[:, :4]
        corners = np.take_along_axis(corners, order, axis=1)
        quads = np.flatnonzero(there.sum(1) == 4)
        single = np.flatnonzero(there.sum(1) == 3)
        ways = self.points[corners[quads]]
        turn = (np.linalg.norm(ways[:, 0] - ways[:, 2], axis=1)
                > np.linalg.norm(ways[:, 1] - ways[:, 3], axis=1))
        # Along the shorter diagonal.
        of_quads = np.where(turn[:, None], np.roll(corners[quads], -1, axis=1), corners[quads])
        return (np.concatenate([corners[single, :3], of_quads[:, :3], of_quads[:, [0, 2, 3]]]),
                np.concatenate([single, quads, quads]))

    def _close(self, cap: Plane, plane: Plane) -> None:
        """Close the boundary of a cap that the plane has cut by edges that lie in both planes."""
        rims, size = self.rims[self.faces == cap.face], len(self.points)
        excess = np.bincount(rims[:, 0], minlength=size) - np.bincount(rims[:, 1], minlength=size)
        # Seen from outside with the cap to the left.
        way = np.cross(cap.sign * np.eye(3)[cap.axis], plane.sign * np.eye(3)[plane.axis])
        heights = self.points @ way
        ends = np.flatnonzero(excess)
        ends = ends[np.argsort(heights[ends])]
        both = cap.holds(self.points) & plane.holds(self.points)
        if not both[ends].all() or (excess[ends] != np.resize([-1, 1], len(ends))).any():
            raise NotFlat
        used = np.zeros(size, bool)
        used[self.triangles] = True
        used[self.rims] = True
        line = np.flatnonzero(both & used)
        line = line[np.argsort(heights[line])]
        # Intervals from an end that lacks an edge out of it to the next one.
        depth = np.cumsum(-excess[line])
        inner = np.flatnonzero(depth > 0)
        self.add_rims(np.stack([line[inner], line[np.minimum(inner + 1, len(line) - 1)]], 1),
                      cap.face)

    # ---- Triangles at the caps ----

    def split(self, pairs: np.ndarray) -> None:
        """Split edges, of which no two are in one triangle, at their midpoints."""
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
        which, middle = found(self.rims)
        halves = np.stack([middle, self.rims[which, 1]], axis=1)
        self.rims[which, 1] = middle
        self.add_rims(halves, self.faces[which])

    def refine(self) -> None:
        """Split edges in a plane that are in no rim, and move what touches the plane without being
        in a rim inward: a cap may lie there. Divide long edges between two caps."""
        for plane in self.planes:
            edges, size = edges_of(self.triangles), len(self.points)
            rims = np.isin(edges @ (size, 1), self.rims @ (1, size))
            chords = edges[plane.holds(self.points)[edges].all(axis=1) & ~rims]
            if len(chords):
                self.split(chords)
            touching = np.zeros(len(self.points), bool)
            touching[self.triangles] = True
            touching[self.rims[self.faces == plane.face]] = False
            touching &= plane.holds(self.points)
            self.points[touching, plane.axis] -= plane.sign * SNAP * self.sizes[touching]
        while True:
            size, ends = len(self.points), self.points[self.rims]
            chosen = np.isin(self.rims @ (size, 1), self.rims @ (1, size))
            chosen &= np.linalg.norm(ends[:, 0] - ends[:, 1], axis=1) > LONG * self.length
            if not chosen.any():
                return
            self.split(self.rims[chosen])

    def collapse(self) -> None:
        """Collapse short edges at the rims where the surface keeps its shape."""
        from scipy.sparse import coo_matrix
        refused, size = np.zeros(0, int), len(self.points)
        for _ in range(ROUNDS):
            flags = np.zeros(size, int)  # the planes of each vertex at a rim
            for plane in self.planes:
                own = self.rims[self.faces == plane.face]
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
            # The vertex that has the planes of both stays. Two of a rim have an edge of it.
            short = ((lengths < SHORT * self.sizes[edges].mean(axis=1)) & (one + other > 0)
                     & ((both == one) | (both == other)) & ((count == 1) | (one * other == 0))
                     & ~np.isin(edges @ (size, 1), refused))
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
            refused = np.append(refused, np.sort(ends[self._merge(*ends.T, triangles, flags)],
                                                 axis=1) @ (size, 1))

    def _merge(self, goes: np.ndarray, kept: np.ndarray, triangles: np.ndarray, flags: np.ndarray
               ) -> np.ndarray:
        """Merge vertices, but not where that turns or flattens triangles: return where."""
        equal = (flags[goes] == flags[kept])[:, None]
        places = np.where(equal, (self.points[goes] + self.points[kept]) / 2, self.points[kept])
        owner, to, points = np.full(len(flags), -1), np.arange(len(flags)), self.points.copy()
        owner[goes] = owner[kept] = np.arange(len(goes))
        to[goes], points[kept] = kept, places
        whose = owner[triangles].max(axis=1)
        changed, whose = triangles[whose >= 0], whose[whose >= 0]
        after = to[changed]
        turned = _differ(normals_of(self.points, changed), normals_of(points, after), TURNED)
        least = np.full(len(goes), 15.0)
        np.minimum.at(least, whose, _least_angles(self.points, changed))
        worse = turned | (_least_angles(points, after) < least[whose])
        refused = np.zeros(len(goes), bool)
        refused[whose[worse & (after != np.roll(after, 1, axis=1)).all(axis=1)]] = True
        to[goes[refused]] = goes[refused]
        self.points[kept[~refused]] = places[~refused]
        self.triangles, self.rims = to[self.triangles], to[self.rims]
        there = (self.triangles != np.roll(self.triangles, 1, axis=1)).all(axis=1)
        self.triangles, self.source = self.triangles[there], self.source[there]
        # Triangles in a plane become part of its caps. A cap as narrow as an edge vanishes.
        for plane in self.planes:
            flat = plane.holds(self.points)[self.triangles].all(axis=1)
            self.add_rims(edges_of(self.triangles[flat]), plane.face)
            self.triangles, self.source = self.triangles[~flat], self.source[~flat]
        keys, back = (self.rims @ way * 8 + self.faces for way in ((len(to), 1), (1, len(to))))
        there = (keys != back) & ~np.isin(keys, back)
        self.rims, self.faces = self.rims[there], self.faces[there]
        return refused


def _least_angles(points: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """The least angle of each triangle, degrees."""
    corners, least = points[triangles], np.full(len(triangles), np.inf)
    for i in range(3):
        a, b = corners[:, i - 1] - corners[:, i], corners[:, i - 2] - corners[:, i]
        across = np.linalg.norm(np.cross(a, b), axis=1)
        least = np.minimum(least, np.arctan2(across, (a * b).sum(1)))
    return np.degrees(least)


def _apart(chosen: np.ndarray, edges: np.ndarray, size: int) -> np.ndarray:
    """Which edges of a list have none before them within two rings."""
    rank = np.full(size, len(chosen))
    for end in chosen.T:
        np.minimum.at(rank, end, np.arange(len(chosen)))
    for _ in range(2):
        wider = rank.copy()
        for one, other in (edges.T, edges.T[::-1]):
            np.minimum.at(wider, one, rank[other])
        rank = wider
    return (rank[chosen] == np.arange(len(chosen))[:, None]).all(axis=1)
