#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Surfaces of all labels of a generated Zarr map on a LocalCluster whose workers are killed.

    tasks.py map.zarr meshes --size 1024 1024 1024 --labels 200 --workers 2 --kills 10

Writes the map if it does not exist. Prints seconds, the peak memory of a worker, and a hash of all
files, which is the same for any number of workers and kills. Needs python3-distributed, python3-zarr.
"""

import argparse
import functools
import hashlib
import itertools
import os
import random
import resource
import subprocess
import sys
import time

import dask
import distributed
import numpy as np
import zarr
from volumic import tasks
from volumic.writing import files

CHUNK = 128


def blobs(size, count):
    """Return centre and half axes of each label, x, y, z; every second touches the one before it."""
    numbers = np.random.default_rng(1)
    pitch, points = max(size), []
    while len(points) < count / 2:
        pitch *= 0.99
        points = list(itertools.product(*(np.arange(pitch / 2, length - pitch / 4, pitch)
                                          for length in size)))
    made = []
    for point in points:
        axes = numbers.uniform(0.09, 0.2, 3) * pitch
        centre = np.array(point) + numbers.uniform(-0.1, 0.1, 3) * pitch
        made += [(centre, axes), (centre + (1.6 * axes[0], 0, 0), 0.8 * axes)]
    return made[:count]


def chunk_of(made, first):
    """Return the labels [z, y, x] of the chunk that begins at `first`; None if it is empty."""
    voxels, least = None, None
    for label, (centre, axes) in enumerate(made, 1):
        if np.any(centre + 1.3 * axes < first) or np.any(centre - 1.3 * axes > first + CHUNK):
            continue
        x, y, z = ((first[k] + np.arange(CHUNK) - centre[k]) / axes[k] for k in range(3))
        z, y = z[:, None, None], y[None, :, None]
        value = x * x + y * y + z * z + 0.2 * np.sin(5 * x) * np.sin(6 * y) * np.cos(4 * z)
        if voxels is None:
            voxels, least = np.zeros(value.shape, "u4"), np.ones(value.shape)
        voxels[value < least] = label
        np.minimum(value, least, out=least)
    return voxels


def write_map(path, size, count):
    made = blobs(size, count)
    array = zarr.open(path, mode="w", shape=size[::-1], chunks=(CHUNK,) * 3, dtype="u4")
    for first in itertools.product(*(range(0, length, CHUNK) for length in size)):
        voxels = chunk_of(made, np.array(first))
        if voxels is not None:
            x, y, z = first
            part = voxels[:size[2] - z, :size[1] - y, :size[0] - x]
            array[z:z + CHUNK, y:y + CHUNK, x:x + CHUNK] = part


def measured(step, folder, kills, task):
    """Run a step and write the peak memory of this process. The first `kills` processes are killed."""
    for number in range(kills):
        try:
            os.mkdir(os.path.join(folder, f"killed-{number}"))
        except FileExistsError:
            continue
        delay = random.uniform(1, 4)
        subprocess.Popen(["sh", "-c", f"sleep {delay}; kill -KILL {os.getpid()}"])
        break
    step(task)
    files.replace_file(os.path.join(folder, f"peak-{os.getpid()}"),
                       str(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss // 1024).encode())


def hash_of(folder):
    digest = hashlib.sha256()
    for name in sorted(name for name in os.listdir(folder) if name.endswith(".vtp")):
        with open(os.path.join(folder, name), "rb") as file:
            digest.update(file.read())
    return digest.hexdigest()[:16]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("map", help=".zarr, written if it does not exist")
    parser.add_argument("folder", help="folder of the surfaces")
    parser.add_argument("--size", type=int, nargs=3, default=(512, 512, 512))
    parser.add_argument("--labels", type=int, default=100)
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--kills", type=int, default=0)
    arguments = parser.parse_args()
    if not os.path.isdir(arguments.map):
        write_map(arguments.map, arguments.size, arguments.labels)
    kills = arguments.kills
    peaks = arguments.folder.rstrip("/") + "-peaks"
    os.makedirs(peaks, exist_ok=True)
    job = tasks.Job(zarr.open(arguments.map, mode="r"), arguments.folder, NumberOfThreads=1)
    dask.config.set({"distributed.scheduler.allowed-failures": 100})
    with distributed.LocalCluster(arguments.workers, threads_per_worker=1,
                                  dashboard_address=None) as cluster, \
            distributed.Client(cluster) as client:
        # Dask does not restart a worker that is killed while it starts; others replace it.
        cluster.adapt(minimum=arguments.workers, maximum=arguments.workers)

        def gathered(step, these):
            started = time.monotonic()
            client.gather(client.map(
                functools.partial(measured, step, peaks, kills if step == job.make else 0), these))
            print(f"  {step.__name__}: {len(these)} tasks, {time.monotonic() - started:.1f} s")
            return []

        rows = job.run(gathered)
    killed = sum(entry.name.startswith("killed") for entry in os.scandir(peaks))
    most = max(int(open(entry.path, encoding="utf-8").read()) for entry in os.scandir(peaks)
               if entry.name.startswith("peak"))
    left = [name for _, names, _ in os.walk(arguments.folder) for name in names
            if name.startswith(files.HIDDEN)]
    print(f"  {len(rows)} labels, {sum(row['Triangles'] for row in rows):,} triangles, hash"
          f" {hash_of(arguments.folder)}, peak of a worker {most} MiB, killed {killed},"
          f" temporary files left: {left or 'none'}")


if __name__ == "__main__":
    sys.exit(main())
