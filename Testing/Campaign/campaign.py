#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Random volumes through the command; every surface that it writes is judged. See campaign.sh.

    campaign.py --program volumic --judge JudgeFiles --folder DIR --seeds N [--first SEED]
                [--labels [--voxels N]] [--minutes N]

Prints a line for each seed with an exception or of more than 20 s of processor time, then counts.
Exit code: 0 without exceptions.
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
MOST_EDGES_OUTSIDE = 1e-4  # share of them
FINISHED = "converged", "limit cycle"
STOPPED = "iteration limit", "time limit", "cancelled"


class Outcome:
    """What a seed has come to."""

    def __init__(self, seed, run):
        self.seed, self.run = seed, run
        self.status = None
        self.seconds = 0.
        self.words = ""  # the standard error
        self.surfaces = self.triangles = 0
        self.exceptions = []
        self.told = []  # of labels: what is exceptional, but for a warning about it
        self.wrong = {}  # of labels: numbers of voxels
        # Of labels of 8 voxels or more, and of parts of labels, with the default settings: (voxels,
        # error of the volume, wrong voxels, text); errors in percent.
        self.labels, self.parts = [], []

    def refusal(self):
        """Why there is no surface, without names and numbers."""
        last = self.words.strip().splitlines()[-1:] or ["no word"]
        return re.sub(r"-?\d[\d.e+-]*", "N", last[0])

    def line(self):
        told = self.exceptions + [f"{self.seconds:.1f} s"] * (self.seconds > SLOW_SECONDS)
        size = " x ".join(map(str, self.run.size))
        return f"seed {self.seed} ({self.run.kind}, {size}): {'; '.join(told) or 'nothing wrong'}"


def run_command(program, run, outcome):
    """With its processor time, which is limited, as the clock on the wall counts what others do."""
    def limit():
        resource.setrlimit(resource.RLIMIT_CPU, (MOST_SECONDS, MOST_SECONDS + 5))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))

    error_file = os.path.join(run.folder, "stderr")
    with open(error_file, "wb") as error:
        process = subprocess.Popen([program, *run.words], cwd=run.folder, stderr=error,
                                   stdout=subprocess.DEVNULL, preexec_fn=limit)
    hung = threading.Timer(10 * MOST_SECONDS, process.kill)  # waits for something
    hung.start()
    _, status, usage = os.wait4(process.pid, 0)
    hung.cancel()
    process.returncode = outcome.status = os.waitstatus_to_exitcode(status)
    outcome.seconds = usage.ru_utime + usage.ru_stime
    with open(error_file, encoding="utf-8", errors="replace") as error:
        outcome.words = error.read()
    if outcome.status < 0:
        outcome.exceptions.append(
            f"did not end in {MOST_SECONDS} s" if outcome.seconds > MOST_SECONDS - 1
            else f"ended by signal {-outcome.status}")
    elif outcome.status not in (0, 1, 3):
        outcome.exceptions.append(f"exit status {outcome.status}: {outcome.refusal()}")


def field_data(path):
    """{name: first value, a number or a text}, and all labels"""
    reader = vtkXMLPolyDataReader()
    reader.SetFileName(path)
    reader.Update()
    fields = reader.GetOutput().GetFieldData()
    arrays = (fields.GetAbstractArray(i) for i in range(fields.GetNumberOfArrays()))
    values = {array.GetName(): [array.GetValue(i) for i in range(array.GetNumberOfValues())]
              for array in arrays if array.GetNumberOfValues()}
    return {name: some[0] for name, some in values.items()} | {"Labels": values.get("Label", [])}


def faults(verdict, told):
    """What is wrong with a surface, by what the judge says and what the file tells of itself."""
    # On its way a component may be inside out for some iterations: until it is looked for.
    promises = ("closed", "manifold", "oriented") + ("outward",) * ("StopReason" in told)
    found = [f"not {name}" for name in promises if not verdict[name]]
    found += [f"{verdict[name]} {name}" for name in ("intersections", "flat", "unused")
              if verdict[name]]
    for name, of_judge in (("NumberOfComponents", "components"), ("Genus", "genus"),
                           ("EulerCharacteristic", "euler"), ("Area", "area"),
                           ("Volume", "volume")):
        value = told.get(name, float("nan"))
        scale = verdict["area"] ** 1.5 if name == "Volume" else abs(verdict[of_judge])
        if not abs(value - verdict[of_judge]) <= 1e-6 * scale:
            found.append(f"{name} {value:g}, which is {verdict[of_judge]:g}")
    return found


def faults_of_edges(verdict, told, words):
    """Of a level that has ended, by the deltas of the file, which are lengths in the world."""
    outside = verdict["short"] + verdict["long"]
    if (told.get("StopReason") in FINISHED
            and not {"--metric", "--labels"}.intersection(words)
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
                "--keep" not in outcome.run.words and outcome.status == 0 else {})
    for path, line in zip(files, judged.stdout.splitlines()):
        words = line.split()
        verdict = dict(zip(names, map(float, words)))
        told = field_data(os.path.join(outcome.run.folder, path))
        outcome.surfaces += 1
        outcome.triangles += int(verdict["triangles"])
        if not verdict["triangles"]:
            if told.get("StopReason") not in ("vanished", *STOPPED):
                outcome.exceptions.append(f"{path}: empty, {told.get('StopReason')}")
            continue
        found = [*faults(verdict, told), *faults_of_edges(verdict, told, outcome.run.words)]
        if outcome.run.is_of_labels:
            found += [*faults_of_label(verdict, told, outcome, path),
                      *faults_of_topology(verdict, topology.get(told["Label"]))]
            for label in told["Labels"]:
                outcome.wrong[label] = np.array(words[len(names):], int)
        outcome.exceptions += [f"{path} ({told.get('StopReason', 'on its way')}): {fault}"
                               for fault in found]
    if outcome.run.is_of_labels and verdict["crossing"]:
        outcome.exceptions.append(f"{verdict['crossing']:g} intersections of all surfaces together")


def volumes_of_parts(outcome, path, labels):
    """[(voxels, volume in voxels)] of the parts of a label.

    Each component of the surface is of the part that most of its points are nearest to.
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


def faults_of_label(verdict, told, outcome, path):
    run, label, voxels = outcome.run, told["Label"], told["LabelVoxels"]
    if run.is_default and voxels >= 8:
        outcome.labels.append((voxels, 100 * (told["Volume"] / voxels / run.spacing.prod() - 1),
                               100 * verdict["wrong"] / voxels,
                               f"seed {outcome.seed} ({run.kind}), {label}: {voxels} voxels"))
    if run.is_default:
        outcome.parts += [
            (size, 100 * (volume / size - 1), 0,
             f"seed {outcome.seed} ({run.kind}), {label}: a part of {size} voxels")
            for size, volume in volumes_of_parts(outcome, path, told["Labels"])]
    if abs(verdict["wrong"] - told["WrongVoxels"]) > verdict["on"]:
        yield f"WrongVoxels {told['WrongVoxels']}, which is {verdict['wrong']:g}"


def faults_of_topology(verdict, expected):
    """By that of the voxels."""
    found = (verdict["euler"] / 2, verdict["components"] - verdict["cavities"], verdict["cavities"])
    if expected and found != expected:
        yield ("Euler characteristic, components, cavities: "
               f"{found[0]:g} {found[1]:g} {found[2]:g}, of the voxels {expected}")


def check_labels(outcome):
    """None is lost; parts are reported."""
    labels = outcome.run.labels.ravel()
    part = whole_parts(outcome.run.labels, 1).ravel()
    sizes = np.bincount(part)
    for label in (set(labels) - {0}).intersection(outcome.run.selected or labels):
        if label not in outcome.wrong:
            outcome.exceptions.append(f"there is no surface of label {label}")
            continue
        own = np.flatnonzero(labels == label)
        lost = np.setdiff1d(part[own], part[np.setdiff1d(own, outcome.wrong[label])])
        largest, voxels = sizes[lost].max(initial=0), sizes[part[own]].max()
        if outcome.run.is_default and (largest == voxels > 1 or largest >= 8):
            outcome.told.append(f"all voxels of a part of {largest} of label {label} are on the "
                                f"wrong side; its largest part is of {voxels}")


def check_status(outcome, folder):
    """The exit status agrees with what is written, and with what is said."""
    surface = os.path.join(folder, "surface.vtp")
    if outcome.status not in (0, 3):
        return
    if "error of Volumic" in outcome.words:
        outcome.exceptions.append(outcome.words.strip())
    if re.search("^(?!volumic: )", outcome.words.strip(), re.M):
        outcome.exceptions.append(f"words that are not its own: {outcome.words.strip()[:200]}")
    if outcome.run.is_of_labels:
        return
    reason = field_data(surface).get("StopReason") if os.path.exists(surface) else "no file"
    expected = FINISHED if outcome.status == 0 else STOPPED
    if reason not in expected:
        outcome.exceptions.append(f"exit status {outcome.status}, but {reason}")
    if outcome.status == 3 and f"unfinished ({reason})" not in outcome.words:
        outcome.exceptions.append(f"{reason} is not told")


def try_seed(seed, arguments, names):
    if time.time() > arguments.end:
        return None
    folder = os.path.join(arguments.folder, str(seed))
    shutil.rmtree(folder, ignore_errors=True)
    os.makedirs(folder)
    run = RandomRun(seed, folder, arguments.labels, arguments.voxels)
    outcome = Outcome(seed, run)
    with open(os.path.join(folder, "command"), "w", encoding="utf-8") as file:
        file.write(shlex.join([arguments.program, *run.words]) + "\n")
    run_command(arguments.program, run, outcome)
    check_status(outcome, folder)
    files = sorted(glob.glob("**/*.vtp", root_dir=folder, recursive=True))
    judge(arguments.judge, names, [f for f in files if f != "given.vtp"], outcome)
    if run.is_of_labels and (outcome.status == 0 or "none of the labels" in outcome.words):
        check_labels(outcome)
    if not outcome.exceptions and outcome.seconds <= SLOW_SECONDS and not arguments.keep:
        shutil.rmtree(folder)
    return outcome


def tell_errors(what, found):
    """found: of each (percent, text)."""
    if found:
        found = sorted(found, key=lambda one: -abs(one[0]))
        sizes = np.abs([one[0] for one in found])
        print(f"{what} of {len(found)} by default: {np.median(sizes):.2f} % in the median, 1 in 20 "
              f"more than {np.quantile(sizes, .95):.1f} %, {(sizes > 25).sum()} more than 25 %")
        for one in found[:5]:
            print(f"    {one[0]:.1f} %: {one[1]}")


def tell(outcomes):
    count = collections.Counter(outcome.status for outcome in outcomes)
    print(f"{len(outcomes)} seeds: {count[0]} finished, {count[3]} stopped, {count[1]} refused")
    refusals = collections.Counter(o.refusal() for o in outcomes if o.status == 1)
    for words, times in refusals.most_common():
        print(f"    {times} x {words}")
    for outcome in outcomes:
        if outcome.told:
            print(f"    told by seed {outcome.seed}, {outcome.run.kind}: {'; '.join(outcome.told)}")
    for low, high in ((60, 1e9), (8, 59), (1, 7)):
        for kind in ("labels", "parts"):
            some = [one for o in outcomes for one in getattr(o, kind) if low <= one[0] <= high]
            which = f"{kind} of {low} to {high:g} voxels"
            tell_errors(f"Errors of the volumes of {which}", [(one[1], one[3]) for one in some])
            if kind == "labels":
                tell_errors(f"Wrong voxels of {which}", [one[2:] for one in some])
    slow = [o.seconds for o in outcomes if o.seconds > SLOW_SECONDS]
    print(f"{sum(o.surfaces for o in outcomes)} surfaces of "
          f"{sum(o.triangles for o in outcomes)} triangles judged; processor time "
          f"{sum(o.seconds for o in outcomes):.0f} s, most "
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
                        help="at most, of maps of labels, if all were as short as the shortest one")
    parser.add_argument("--minutes", type=float, default=1e6, help="no seed is begun after these")
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
    tell(outcomes)
    return 1 if any(outcome.exceptions for outcome in outcomes) else 0


if __name__ == "__main__":
    sys.exit(main())
