#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Run the command on random volumes and judge every surface that it writes. See campaign.sh.

    campaign.py --program volumic --judge JudgeFiles --folder DIR --seeds N [--first SEED]
                [--labels [--voxels N]] [--minutes N]

Prints a line for each seed with an exception or more than 20 s of processor time, then a summary.
Exit code: 0 if there are no exceptions.
"""

import argparse
import collections
import concurrent.futures
import glob
import os
import re
import resource
import shlex
import shutil
import subprocess
import sys
import threading
import time

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkFiltersCore import vtkPolyDataConnectivityFilter
from vtkmodules.vtkIOXML import vtkXMLImageDataReader, vtkXMLPolyDataReader

from random_settings import RandomRun
from voxel_topology import whole_parts

SLOW_SECONDS, MOST_SECONDS = 20, 150  # of processor time
MOST_EDGES_OUTSIDE = 1e-4  # fraction of all edges
FINISHED = "converged", "limit cycle"
STOPPED = "iteration limit", "time limit", "cancelled"


class Outcome:
    """The result of a seed."""

    def __init__(self, seed, run):
        self.seed, self.run = seed, run
        self.status = None
        self.seconds = 0.
        self.messages = ""  # the standard error
        self.surfaces = self.triangles = 0
        self.exceptions = []
        self.warned = []  # label maps: problems covered by a warning
        self.wrong = {}  # label maps: indices of misclassified voxels
        # Labels of 8 or more voxels and parts: (voxels, volume error, misclassified, text); percent.
        self.labels, self.parts = [], []

    def refusal(self):
        """Return the error message without numbers."""
        last = self.messages.strip().splitlines()[-1:] or ["no message"]
        return re.sub(r"-?\d[\d.e+-]*", "N", last[0])

    def line(self):
        remarks = self.exceptions + [f"{self.seconds:.1f} s"] * (self.seconds > SLOW_SECONDS)
        size = " x ".join(map(str, self.run.size))
        return f"seed {self.seed} ({self.run.kind}, {size}): {'; '.join(remarks) or 'no exception'}"


def run_command(program, run, outcome):
    """Run the command with a limit on its processor time, so that other processes do not matter."""
    def limit():
        resource.setrlimit(resource.RLIMIT_CPU, (MOST_SECONDS, MOST_SECONDS + 5))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))

    error_file = os.path.join(run.folder, "stderr")
    with open(error_file, "wb") as error:
        process = subprocess.Popen([program, *run.arguments], cwd=run.folder, stderr=error,
                                   stdout=subprocess.DEVNULL, preexec_fn=limit)
    hung = threading.Timer(10 * MOST_SECONDS, process.kill)  # a run that waits
    hung.start()
    _, status, usage = os.wait4(process.pid, 0)
    hung.cancel()
    process.returncode = outcome.status = os.waitstatus_to_exitcode(status)
    outcome.seconds = usage.ru_utime + usage.ru_stime
    with open(error_file, encoding="utf-8", errors="replace") as error:
        outcome.messages = error.read()
    if outcome.status < 0:
        outcome.exceptions.append(
            f"not finished in {MOST_SECONDS} s" if outcome.seconds > MOST_SECONDS - 1
            else f"ended by signal {-outcome.status}")
    elif outcome.status not in (0, 1, 3):
        outcome.exceptions.append(f"exit status {outcome.status}: {outcome.refusal()}")


def field_data(path):
    """Return {name: first value, a number or a text} and `Labels`, all values of `Label`."""
    reader = vtkXMLPolyDataReader()
    reader.SetFileName(path)
    reader.Update()
    fields = reader.GetOutput().GetFieldData()
    arrays = (fields.GetAbstractArray(i) for i in range(fields.GetNumberOfArrays()))
    values = {array.GetName(): [array.GetValue(i) for i in range(array.GetNumberOfValues())]
              for array in arrays if array.GetNumberOfValues()}
    return {name: some[0] for name, some in values.items()} | {"Labels": values.get("Label", [])}


def faults(verdict, fields):
    """Return the faults of a surface: topology, and figures that differ from the field data."""
    # In a snapshot a component may be inverted, until the next test for such components.
    promises = ("closed", "manifold", "oriented") + ("outward",) * ("StopReason" in fields)
    found = [f"not {name}" for name in promises if not verdict[name]]
    found += [f"{verdict[name]} {name}" for name in ("intersections", "flat", "unused")
              if verdict[name]]
    for name, of_judge in (("NumberOfComponents", "components"), ("Genus", "genus"),
                           ("EulerCharacteristic", "euler"), ("Area", "area"),
                           ("Volume", "volume")):
        value = fields.get(name, float("nan"))
        scale = verdict["area"] ** 1.5 if name == "Volume" else abs(verdict[of_judge])
        if not abs(value - verdict[of_judge]) <= 1e-6 * scale:
            found.append(f"{name} {value:g}, judged as {verdict[of_judge]:g}")
    return found


def faults_of_edges(verdict, fields, arguments):
    """Judge the edges of a finished level by the deltas of the file, which are world lengths."""
    outside = verdict["short"] + verdict["long"]
    if (fields.get("StopReason") in FINISHED
            and not {"--metric", "--labels", "--no-topology-changes"}.intersection(arguments)
            and outside > MOST_EDGES_OUTSIDE * verdict["edges"]):
        yield f"{outside:g} of {verdict['edges']:g} edges are too short or too long"


def judge(program, names, files, outcome):
    if not files:
        return
    the_map = ["--map", "volume.vti"] if outcome.run.is_of_labels else []
    judged = subprocess.run([program, *the_map, *files], cwd=outcome.run.folder,
                            capture_output=True, text=True, check=False)
    if judged.returncode:
        outcome.exceptions.append(f"judge: {judged.stderr.strip()}")
    topology = (outcome.run.topology() if outcome.run.is_of_labels and
                "--keep" not in outcome.run.arguments and outcome.status == 0 else {})
    for path, line in zip(files, judged.stdout.splitlines()):
        words = line.split()
        verdict = dict(zip(names, map(float, words)))
        fields = field_data(os.path.join(outcome.run.folder, path))
        outcome.surfaces += 1
        outcome.triangles += int(verdict["triangles"])
        if not verdict["triangles"]:
            if fields.get("StopReason") not in ("vanished", *STOPPED):
                outcome.exceptions.append(f"{path}: empty, {fields.get('StopReason')}")
            continue
        run = outcome.run
        found = [*faults(verdict, fields), *faults_of_edges(verdict, fields, run.arguments)]
        if outcome.run.is_of_labels:
            found += [*faults_of_label(verdict, fields, outcome, path),
                      *faults_of_topology(verdict, topology.get(fields["Label"]))]
            for label in fields["Labels"]:
                outcome.wrong[label] = np.array(words[len(names):], int)
        outcome.exceptions += [f"{path} ({fields.get('StopReason', 'snapshot')}): {fault}"
                               for fault in found]
    if outcome.run.is_of_labels and verdict["crossing"]:
        outcome.exceptions.append(f"{verdict['crossing']:g} intersections of all surfaces together")


def volumes_of_parts(outcome, path, labels):
    """Return [(voxels, volume in voxels)] of the parts of a label.

    A component of the surface belongs to the part to which most of its points are nearest.
    """
    reader, connected = vtkXMLPolyDataReader(), vtkPolyDataConnectivityFilter()
    reader.SetFileName(os.path.join(outcome.run.folder, path))
    connected.SetInputConnection(reader.GetOutputPort())
    connected.SetExtractionModeToAllRegions()
    connected.ColorRegionsOn()
    connected.Update()
    surface = connected.GetOutput()
    images = vtkXMLImageDataReader()
    images.SetFileName(os.path.join(outcome.run.folder, "volume.vti"))
    images.Update()
    to_index = images.GetOutput().GetPhysicalToIndexMatrix()
    matrix = np.array([[to_index.GetElement(r, c) for c in range(4)] for r in range(3)])
    points = vtk_to_numpy(surface.GetPoints().GetData()).astype(float) @ matrix[:, :3].T
    points += matrix[:, 3]
    corners = vtk_to_numpy(surface.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    region = vtk_to_numpy(surface.GetPointData().GetArray("RegionId"))
    a, b, c = (points[corners[:, n]] for n in range(3))
    sixfold = np.einsum("ij,ij->i", np.cross(a, b), c) * np.sign(np.linalg.det(matrix[:, :3]))
    volume = np.bincount(region[corners[:, 0]], sixfold / 6)
    where = np.isin(outcome.run.labels, labels)
    part = whole_parts(np.where(where, 1, 0))
    voxels = np.argwhere(where)[:, ::-1]
    part_of_voxel = np.unique(part[where], return_inverse=True)[1]
    total = np.zeros(part_of_voxel.max() + 1)
    scale = outcome.run.spacing / outcome.run.spacing.min()
    for n, one in enumerate(volume):
        some = points[region == n][:50] * scale
        nearest = (((some[:, None] - voxels * scale) ** 2).sum(-1)).argmin(1)
        total[np.bincount(part_of_voxel[nearest]).argmax()] += one
    return list(zip(np.bincount(part_of_voxel), total))


def faults_of_label(verdict, fields, outcome, path):
    run, label, voxels = outcome.run, fields["Label"], fields["LabelVoxels"]
    if run.is_default and voxels >= 8:
        outcome.labels.append((voxels, 100 * (fields["Volume"] / voxels / run.spacing.prod() - 1),
                               100 * verdict["wrong"] / voxels,
                               f"seed {outcome.seed} ({run.kind}), {label}: {voxels} voxels"))
    if run.is_default:
        outcome.parts += [
            (size, 100 * (volume / size - 1), 0,
             f"seed {outcome.seed} ({run.kind}), {label}: a part of {size} voxels")
            for size, volume in volumes_of_parts(outcome, path, fields["Labels"])]
    if abs(verdict["wrong"] - fields["WrongVoxels"]) > verdict["on"]:
        yield f"WrongVoxels {fields['WrongVoxels']}, judged as {verdict['wrong']:g}"


def faults_of_topology(verdict, expected):
    """Compare the topology of a surface with that of its voxels."""
    found = (verdict["euler"] / 2, verdict["components"] - verdict["cavities"], verdict["cavities"])
    if expected and found != expected:
        yield ("Euler characteristic, components, cavities: "
               f"{found[0]:g} {found[1]:g} {found[2]:g}, expected {expected}")


def check_labels(outcome):
    """Report labels without a surface and parts with no voxel inside."""
    labels = outcome.run.labels.ravel()
    part = whole_parts(outcome.run.labels, 1).ravel()
    sizes = np.bincount(part)
    for label in (set(labels) - {0}).intersection(outcome.run.selected or labels):
        if label not in outcome.wrong:
            outcome.exceptions.append(f"label {label} has no surface")
            continue
        own = np.flatnonzero(labels == label)
        missed = np.setdiff1d(part[own], part[np.setdiff1d(own, outcome.wrong[label])])
        largest, voxels = sizes[missed].max(initial=0), sizes[part[own]].max()
        if outcome.run.is_default and (largest == voxels > 1 or largest >= 8):
            outcome.warned.append(f"all {largest} voxels of a part of label {label} are "
                                  f"misclassified; its largest part has {voxels}")


def check_status(outcome, folder):
    """Compare the exit status with the written files and the messages."""
    surface = os.path.join(folder, "surface.vtp")
    if outcome.status not in (0, 3):
        return
    if "error of Volumic" in outcome.messages:
        outcome.exceptions.append(outcome.messages.strip())
    if re.search("^(?!volumic: )", outcome.messages.strip(), re.M):
        outcome.exceptions.append(f"messages of other software: {outcome.messages.strip()[:200]}")
    if outcome.run.is_of_labels:
        return
    reason = field_data(surface).get("StopReason") if os.path.exists(surface) else "no file"
    expected = FINISHED if outcome.status == 0 else STOPPED
    if reason not in expected:
        outcome.exceptions.append(f"exit status {outcome.status}, but {reason}")
    if outcome.status == 3 and f"unfinished ({reason})" not in outcome.messages:
        outcome.exceptions.append(f"no message for {reason}")


def try_seed(seed, arguments, names):
    if time.time() > arguments.end:
        return None
    folder = os.path.join(arguments.folder, str(seed))
    shutil.rmtree(folder, ignore_errors=True)
    os.makedirs(folder)
    run = RandomRun(seed, folder, arguments.labels, arguments.voxels)
    outcome = Outcome(seed, run)
    with open(os.path.join(folder, "command"), "w", encoding="utf-8") as file:
        file.write(shlex.join([arguments.program, *run.arguments]) + "\n")
    run_command(arguments.program, run, outcome)
    check_status(outcome, folder)
    files = sorted(glob.glob("**/*.vtp", root_dir=folder, recursive=True))
    judge(arguments.judge, names, [f for f in files if f != "given.vtp"], outcome)
    if run.is_of_labels and (outcome.status == 0 or "all labels are empty" in outcome.messages):
        check_labels(outcome)
    if not outcome.exceptions and outcome.seconds <= SLOW_SECONDS and not arguments.keep:
        shutil.rmtree(folder)
    return outcome


def print_errors(title, found):
    """found: list of (percent, text)."""
    if found:
        found = sorted(found, key=lambda one: -abs(one[0]))
        sizes = np.abs([one[0] for one in found])
        print(f"{title}, {len(found)} by default: median {np.median(sizes):.2f} %, 95 % quantile "
              f"{np.quantile(sizes, .95):.1f} %, {(sizes > 25).sum()} above 25 %")
        for one in found[:5]:
            print(f"    {one[0]:.1f} %: {one[1]}")


def print_summary(outcomes):
    count = collections.Counter(outcome.status for outcome in outcomes)
    print(f"{len(outcomes)} seeds: {count[0]} finished, {count[3]} stopped, {count[1]} failed")
    refusals = collections.Counter(o.refusal() for o in outcomes if o.status == 1)
    for message, times in refusals.most_common():
        print(f"    {times} x {message}")
    for outcome in outcomes:
        if outcome.warned:
            print(f"    seed {outcome.seed}, {outcome.run.kind}: {'; '.join(outcome.warned)}")
    for low, high in ((60, 1e9), (8, 59), (1, 7)):
        for kind in ("labels", "parts"):
            some = [one for o in outcomes for one in getattr(o, kind) if low <= one[0] <= high]
            which = f"{kind} of {low} to {high:g} voxels"
            print_errors(f"Volume errors of {which}", [(one[1], one[3]) for one in some])
            if kind == "labels":
                print_errors(f"Misclassified voxels of {which}", [one[2:] for one in some])
    slow = [o.seconds for o in outcomes if o.seconds > SLOW_SECONDS]
    print(f"{sum(o.surfaces for o in outcomes)} surfaces of "
          f"{sum(o.triangles for o in outcomes)} triangles judged; processor time "
          f"{sum(o.seconds for o in outcomes):.0f} s, largest "
          f"{max(o.seconds for o in outcomes):.1f} s, {len(slow)} seeds over {SLOW_SECONDS} s")
    print(f"{sum(bool(o.exceptions) for o in outcomes)} seeds with exceptions")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    for name in ("program", "judge", "folder"):
        parser.add_argument(f"--{name}", required=True, type=os.path.abspath)
    parser.add_argument("--seeds", type=int, required=True)
    parser.add_argument("--first", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--labels", action="store_true")
    parser.add_argument("--voxels", type=float, default=1e5,
                        help="limit on the size of label maps, at the smallest voxel distance")
    parser.add_argument("--minutes", type=float, default=1e6, help="start no seed after this time")
    arguments = parser.parse_args()
    arguments.end = time.time() + 60 * arguments.minutes
    arguments.keep = arguments.seeds == 1
    names = subprocess.run([arguments.judge, "--help"], capture_output=True, text=True,
                           check=True).stdout.split()
    seeds = range(arguments.first, arguments.first + arguments.seeds)
    outcomes = []
    with concurrent.futures.ProcessPoolExecutor(arguments.jobs) as pool:
        tasks = [pool.submit(try_seed, seed, arguments, names) for seed in seeds]
        for task in concurrent.futures.as_completed(tasks):
            if task.result() is None:
                continue
            outcomes.append(task.result())
            if outcomes[-1].exceptions or outcomes[-1].seconds > SLOW_SECONDS or arguments.keep:
                print(outcomes[-1].line(), flush=True)
    print_summary(outcomes)
    return 1 if any(outcome.exceptions for outcome in outcomes) else 0


if __name__ == "__main__":
    sys.exit(main())
