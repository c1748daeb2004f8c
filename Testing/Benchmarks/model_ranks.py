#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""How long one surface would take on more ranks than there are, and how much memory.

    python3 model_ranks.py scan.vti --iso 226.5 --size 2048

The object of the scan stands for one of the same shape in an image of that size: where its boundary
is tells how many vertices each block of a level has. Blocks go to ranks as RankBlocks does it, and
the visits of a sweep are scheduled as there: those that others wait for first, colour by colour, and
others while a rank waits. What a vertex costs was measured, on one thread, and so were the bytes that
ranks send and what is done on ranks only (see Constants).

Left out: reading and reducing the image (each rank does its part), writing, differences between the
work of vertices, and that ranks of one machine share its memory.
"""

import argparse
import dataclasses
import itertools

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLImageDataReader

REDUCTION = 3.0 ** 0.5
COLOURS = 8
EXCHANGES = 8  # a sweep: after each colour


@dataclasses.dataclass
class Constants:
    """Measured with `volumic skull512.vti --iso 226.5 --threads 1 --metric voxels` (512^3, one
    thread): by level, coarser ones as the last; and what is assumed."""

    vertices: float = 927530 / 512 ** 2  # of level 0, for each square of the image's side
    iterating: tuple = (7.4e-6, 17.5e-6, 40.5e-6, 20.2e-6, 22.0e-6, 78.7e-6)  # s a vertex
    around: tuple = (8.7e-6, 11.2e-6, 11.1e-6, 11.1e-6, 12.6e-6, 23.4e-6)  # s, before and after
    visits: tuple = (5, 10, 7, 13, 14, 21)  # of a block, of 5 iterations each
    block_side: float = 24 * 0.85  # voxels
    sweeps_from: float = 64.0  # voxels, the side of the smallest level that ranks share
    halo: float = 14.2 * 0.85  # voxels
    bytes_of_voxel: float = 2.0  # of the image
    bytes_of_coarse_voxel: float = 2.0
    bytes_of_vertex: float = 350.0  # in memory, with room to grow
    # `mpirun -n 4 volumic skull512.vti --iso 226.5 --metric voxels --profile`, SentBytes: 19.9 MB in
    # a sweep that visits all, of 36,011 vertices that sent_bytes() counts there, before ranks told
    # only of what has changed: then the first sweep of level 0 went from 9.3 MB a row to 6.1.
    bytes_sent: float = 360.0  # a sweep, of a vertex near a border, for each rank beyond
    voxels_sent: float = 0.75  # the same, the first row: of those of a piece, at each shared level
    other_sweeps: int = 5  # of a level: three regularise, one polishes, one splits edges
    collectives: int = 8  # a sweep: to rank 0 and back, along a tree; 11 where some are inside out
    bytes_of_block: float = 60.0  # a sweep, to rank 0: seven sums and a number
    bytes_of_rows: float = 360.0  # a sweep, of a rank to all: its five rows
    # On ranks only, s a vertex that a rank has, `mpirun -n 2`: numbers, messages and lists of a
    # division, blocks that move; and of a result that is dealt out.
    dividing: float = 0.8e-6
    balancing: float = 0.7e-6
    dealing: float = 0.8e-6
    latency: float = 20e-6  # assumed: s a message
    bandwidth: float = 1e9  # assumed: bytes a second of a rank


def boundary(path, iso):
    """Voxels [n, 3] (x, y, z, as shares of the image's sides) of the object beside others."""
    reader = vtkXMLImageDataReader()
    reader.SetFileName(path)
    reader.Update()
    image = reader.GetOutput()
    voxels = vtk_to_numpy(image.GetPointData().GetScalars())
    inside = voxels.reshape(image.GetDimensions()[::-1]) > iso
    near = np.zeros_like(inside)
    for axis in range(3):
        differs = np.diff(inside, axis=axis)
        first = [slice(None)] * 3
        first[axis] = slice(0, -1)
        near[tuple(first)] |= differs
    places = np.argwhere(near & inside)[:, ::-1]
    return (places + 0.5) / np.array(image.GetDimensions())


def vertices_of_blocks(places, side, count, constants):
    """[z, y, x] of a level of side^3 voxels with so many vertices."""
    blocks = max(1, round(side / constants.block_side))
    index = np.minimum((places * blocks).astype(int), blocks - 1)
    found = np.zeros((blocks,) * 3)
    np.add.at(found, (index[:, 2], index[:, 1], index[:, 0]), count / len(places))
    return found


def choose_owners(vertices, ranks):
    """As RankBlocks::ChooseOwners: rows of blocks, halved again and again. [z, y]"""
    rows = vertices.sum(axis=2)
    owners = np.zeros(rows.shape, int)

    def cut(box, first, count):
        if count == 1:
            owners[box] = first
            return
        lower = count // 2
        wanted = rows[box].sum() * lower / count
        best = None
        for axis in (0, 1):
            along = rows[box].sum(axis=1 - axis)
            for at, summed in enumerate(np.cumsum(along)[:-1], 1):
                if best is None or abs(summed - wanted) < best[0]:
                    best = (abs(summed - wanted), axis, at)
        if best is None:
            owners[box] = first  # a row alone
            return
        _, axis, at = best
        parts = []
        for begin, end in ((0, at), (at, box[axis].stop - box[axis].start)):
            part = list(box)
            part[axis] = slice(box[axis].start + begin, box[axis].start + end)
            parts.append(tuple(part))
        cut(parts[0], first, lower)
        cut(parts[1], first + lower, count - lower)

    cut((slice(0, rows.shape[0]), slice(0, rows.shape[1])), 0, ranks)
    return owners


def balance(vertices, owners, ranks):
    """As RankBlocks::BalancedOwners: halves along the axis that keeps most owners. [z, y, x]; -1
    where there is nothing."""
    blocks = np.argwhere(vertices > 0)  # z, y, x
    weight = vertices[tuple(blocks.T)]
    before = owners[blocks[:, 0], blocks[:, 1]]
    balanced = np.full(vertices.shape, -1)

    def cut(which, first, count):
        if count == 1:
            balanced[tuple(blocks[which].T)] = first
            return
        lower = count // 2
        best = None
        for axis in (0, 1, 2):
            others = [a for a in (2, 1, 0) if a != axis]
            order = which[np.lexsort([blocks[which, a] for a in others] + [blocks[which, axis]])]
            at = int(np.searchsorted(np.cumsum(weight[order]), weight[order].sum() * lower / count))
            own = before[order]
            stays = (np.count_nonzero((own[:at] >= first) & (own[:at] < first + lower))
                     + np.count_nonzero((own[at:] >= first + lower) & (own[at:] < first + count)))
            if best is None or stays > best[0]:
                best = (stays, order, at)
        _, order, at = best
        cut(order[:at], first, lower)
        cut(order[at:], first + lower, count - lower)

    cut(np.arange(len(blocks)), 0, ranks)
    return balanced


def shifted(array, step, outside):
    """What lies a step further, of each block."""
    result = np.full(array.shape, outside, array.dtype)
    to = tuple(slice(max(0, -s), n - max(0, s)) for s, n in zip(step, array.shape))
    source = tuple(slice(max(0, s), n - max(0, -s)) for s, n in zip(step, array.shape))
    result[to] = array[source]
    return result


STEPS = [step for step in itertools.product((-1, 0, 1), repeat=3) if step != (0, 0, 0)]


def colours(shape):
    z, y, x = np.indices(shape) % 2
    return (z * 2 + y) * 2 + x


def awaited(owners):
    """Blocks that others wait for, as RankBlocks::IsAwaited."""
    found = np.zeros(owners.shape, bool)
    for step in STEPS:
        other = shifted(owners, step, -1)
        found |= (owners >= 0) & (other >= 0) & (other != owners)
    colour = colours(owners.shape)
    for c in range(COLOURS - 1, 0, -1):
        for step in STEPS:
            later = shifted(found & (colour == c), step, False)
            found |= later & (colour < c) & (shifted(owners, step, -1) == owners) & (owners >= 0)
    return found


def partners_of(owners):
    pairs = set()
    for step in STEPS:
        other = shifted(owners, step, -1)
        at = (owners >= 0) & (other >= 0) & (other != owners)
        pairs |= set(zip(owners[at].tolist(), other[at].tolist()))
    return pairs


def sent_bytes(vertices, owners, ranks, constants, block_voxels):
    """By rank: what it tells others in a sweep. A face takes a share of a block's vertices."""
    share = min(1.0, constants.halo / block_voxels)
    sent = np.zeros(ranks)
    own = owners >= 0
    near = np.zeros(owners.shape)  # Other ranks about a block.
    seen = []
    for step in STEPS:
        other = shifted(owners, step, -1)
        new = own & (other >= 0) & (other != owners)
        for earlier in seen:
            new &= earlier != other
        near += new
        seen.append(other)
    told = np.minimum(1.0, share * near) * vertices * constants.bytes_sent
    np.add.at(sent, owners[own], told[own])
    return sent


def sweep(vertices, owners, first, pairs, ranks, seconds):
    """Seconds of the visits of a sweep, of `seconds` for a vertex."""
    work = vertices * seconds
    colour = colours(owners.shape)
    done = np.zeros(ranks)
    left = np.zeros(ranks)  # Of others, of the colours so far.

    def visit(which):
        ofRanks = np.zeros(ranks)
        np.add.at(ofRanks, owners[which], work[which])
        return ofRanks

    for c in range(COLOURS):
        done += visit(first & (colour == c))
        left += visit(~first & (colour == c) & (owners >= 0))
        told = done.copy()
        for rank, other in pairs:
            done[rank] = max(done[rank], told[other])
        left -= np.minimum(left, done - told)  # While it would wait.
    return (done + left).max()


def model(places, size, ranks, constants, shared=1.0):
    """Seconds by kind of work. `shared`: the part of what is done before and after a level's
    iterations that the ranks share."""
    seconds = {"sweeps": 0.0, "messages": 0.0, "collectives": 0.0, "around": 0.0,
               "first rank": 0.0}
    bytes_of_level = []
    side, count, level = float(size), constants.vertices * size ** 2, 0
    while side >= 10 and count >= 50:
        at = min(level, len(constants.visits) - 1)
        iterating, around = constants.iterating[at], constants.around[at]
        if side <= constants.sweeps_from:
            seconds["first rank"] += count * (iterating + around)
        else:
            vertices = vertices_of_blocks(places, side, count, constants)
            used = min(ranks, vertices[:, :, 0].size)
            owners = balance(vertices, choose_owners(vertices, used), used)
            visits = constants.visits[at]
            pairs = partners_of(owners)
            seconds["sweeps"] += visits * sweep(
                vertices, owners, awaited(owners), pairs, used, iterating / visits)
            if ranks > 1:
                sent = sent_bytes(vertices, owners, used, constants, constants.block_side)
                partners = np.bincount([rank for rank, _ in pairs], minlength=used)
                sweeps = visits + constants.other_sweeps
                seconds["messages"] += sweeps * float(np.max(
                    EXCHANGES * partners * constants.latency + sent / constants.bandwidth))
                seconds["messages"] += (side ** 3 * constants.voxels_sent / ranks
                                        * constants.bytes_of_coarse_voxel / constants.bandwidth)
                bytes_of_level.append(float(sent.max()))
                steps = np.ceil(np.log2(ranks))
                gathered = (np.count_nonzero(vertices) * constants.bytes_of_block
                            + ranks * constants.bytes_of_rows * steps)
                seconds["collectives"] += sweeps * float(
                    2 * steps * constants.collectives * constants.latency
                    + gathered / constants.bandwidth)
                around += constants.dividing + constants.balancing + constants.dealing
            of_rank = np.bincount(owners[owners >= 0], vertices[owners >= 0]).max()
            seconds["around"] += around * (shared * of_rank + (1 - shared) * count)
        side, count, level = side / REDUCTION, count / 3, level + 1
    return seconds, bytes_of_level


def memory(places, size, ranks, constants):
    """Bytes of the rank that has the most: image, coarser levels, its vertices."""
    vertices = vertices_of_blocks(places, size, constants.vertices * size ** 2, constants)
    used = min(ranks, vertices[:, :, 0].size)
    owners = balance(vertices, choose_owners(vertices, used), used)
    largest = np.bincount(owners[owners >= 0], vertices[owners >= 0]).max()
    voxels = size ** 3 * (constants.bytes_of_voxel + constants.bytes_of_coarse_voxel / 4.2)
    return voxels / ranks + largest * constants.bytes_of_vertex


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("volume", help="a scan (.vti) of the object's shape")
    parser.add_argument("--iso", type=float, required=True)
    parser.add_argument("--size", type=int, nargs="+", default=[2048, 4096])
    parser.add_argument("--ranks", type=int, nargs="+", default=[1, 4, 16, 64])
    parser.add_argument("--shared", type=float, default=1.0,
                        help="part of the work around iterations that ranks share (default: 1)")
    parser.add_argument("--sweeps-from", type=float, default=Constants.sweeps_from,
                        help="side of the smallest level whose blocks the ranks share, voxels")
    parser.add_argument("--block-side", type=float, default=Constants.block_side,
                        help="of a block, voxels")
    options = parser.parse_args()
    constants = Constants(sweeps_from=options.sweeps_from, block_side=options.block_side)
    places = boundary(options.volume, options.iso)
    print("| image | ranks | seconds | of these on the first rank | exchanges | collectives | speed-up"
          " | efficiency | most memory of a rank | a rank sends in a sweep |")
    print("|---|---|---|---|---|---|---|---|---|---|")
    for size in options.size:
        one = None
        for ranks in options.ranks:
            seconds, sent = model(places, size, ranks, constants, options.shared)
            total = sum(seconds.values())
            one = one or total
            first = ranks if ranks == options.ranks[0] else ranks / options.ranks[0]
            print(f"| {size}^3 | {ranks} | {total:.0f} | {seconds['first rank']:.1f} |"
                  f" {seconds['messages']:.1f} | {seconds['collectives']:.1f} | {one / total:.1f} | {one / total / first:.0%} |"
                  f" {memory(places, size, ranks, constants) / 2 ** 30:.1f} GiB |"
                  f" {max(sent, default=0) / 1e6:.1f} MB |")


if __name__ == "__main__":
    main()
