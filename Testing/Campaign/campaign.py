#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Run the command on random volumes and judge every surface that it writes. See campaign.sh.

    campaign.py --program volumic --judge JudgeFiles --folder DIR --seeds N [--first SEED]
                [--labels]

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
import signal
import subprocess
import sys
import threading

import numpy as np
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

from random_settings import RandomRun

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
        self.found = set()  # label maps: labels with a surface
        self.labels = []  # of 8 or more voxels: (voxels, volume error, misclassified, text); percent

    def refusal(self):
        """Return the error message without numbers."""
        last = self.messages.strip().splitlines()[-1:] or ["no message"]
        return re.sub(r"-?\d[\d.e+-]*", "N", last[0])

    def line(self):
        remarks = self.exceptions + [f"{self.seconds:.1f} s"] * (self.seconds > SLOW_SECONDS)
        size = " x ".join(map(str, self.run.size))
        return f"seed {self.seed} ({self.run.kind}, {size}): {'; '.join(remarks) or 'no exception'}"


def run_command(program, run, outcome, arguments=None, interrupt=None):
    """Run the command with a limit on its processor time, so that other processes do not matter.
    Send SIGINT after `interrupt` seconds."""
    def limit():
        resource.setrlimit(resource.RLIMIT_CPU, (MOST_SECONDS, MOST_SECONDS + 5))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))

    error_file = os.path.join(run.folder, "stderr")
    with open(error_file, "wb") as error:
        process = subprocess.Popen([program, *(arguments or run.arguments)], cwd=run.folder,
                                   stderr=error, stdout=subprocess.DEVNULL, preexec_fn=limit)
    timers = [threading.Timer(10 * MOST_SECONDS, process.kill),  # a run that waits
              threading.Timer(interrupt or 1e5, process.send_signal, [signal.SIGINT])]
    for timer in timers:
        timer.start()
    _, status, usage = os.wait4(process.pid, 0)
    for timer in timers:
        timer.cancel()
    process.returncode = outcome.status = os.waitstatus_to_exitcode(status)
    outcome.seconds = usage.ru_utime + usage.ru_stime
    with open(error_file, encoding="utf-8", errors="replace") as error:
        outcome.messages = error.read()
    if interrupt and outcome.status == -signal.SIGINT:  # while Python starts or ends
        outcome.status, outcome.messages = 1, "interrupted"
    elif outcome.status < 0:
        outcome.exceptions.append(
            f"not finished in {MOST_SECONDS} s" if outcome.seconds > MOST_SECONDS - 1
            else f"ended by signal {-outcome.status}")
    elif outcome.status not in (0, 1, 3) or "Traceback" in outcome.messages:
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
    kind = "--box" if "flat" in outcome.run.arguments else "--map"
    the_map = [kind, "volume.vti"] if outcome.run.is_of_labels else []
    judged = subprocess.run([program, *the_map, *files], cwd=outcome.run.folder,
                            capture_output=True, text=True, check=False)
    if judged.returncode:
        outcome.exceptions.append(f"judge: {judged.stderr.strip()}")
    for path, line in zip(files, judged.stdout.splitlines()):
        verdict = dict(zip(names, map(float, line.split())))
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
            found += faults_of_label(verdict, fields, outcome)
            outcome.found.update(fields["Labels"])
        outcome.exceptions += [f"{path} ({fields.get('StopReason', 'snapshot')}): {fault}"
                               for fault in found]
    if outcome.run.is_of_labels and verdict["crossing"]:
        outcome.exceptions.append(f"{verdict['crossing']:g} intersections of all surfaces together")


def faults_of_label(verdict, fields, outcome):
    run, label, voxels = outcome.run, fields["Label"], fields["LabelVoxels"]
    if run.is_default and voxels >= 8:
        outcome.labels.append((voxels, 100 * (fields["Volume"] / voxels / run.spacing.prod() - 1),
                               100 * verdict["wrong"] / voxels,
                               f"seed {outcome.seed} ({run.kind}), {label}: {voxels} voxels"))
    if abs(verdict["wrong"] - fields["WrongVoxels"]) > verdict["on"]:
        yield f"WrongVoxels {fields['WrongVoxels']}, judged as {verdict['wrong']:g}"
    found = verdict["euler"] / 2, verdict["components"] - verdict["cavities"], verdict["cavities"]
    expected = verdict["solideuler"], verdict["solids"], verdict["hollows"]
    if found != expected and outcome.status == 0 and "--keep" not in run.arguments:
        yield f"Euler characteristic, components, cavities: {found}, expected {expected}"


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


def compare_threads(program, outcome, files):
    """Run again with other numbers of threads; the files must be the same."""
    def contents():
        return [open(os.path.join(outcome.run.folder, file), "rb").read() for file in files]

    first = contents()
    for threads in "1237":
        again = Outcome(outcome.seed, outcome.run)
        run_command(program, again.run, again, [*again.run.arguments[:-1], threads])
        if again.status != outcome.status or contents() != first:
            outcome.exceptions.append(f"{threads} threads make other surfaces")


def try_seed(seed, arguments, names):
    folder = os.path.join(arguments.folder, str(seed))
    shutil.rmtree(folder, ignore_errors=True)
    os.makedirs(folder)
    run = RandomRun(seed, folder, arguments.labels)
    outcome = Outcome(seed, run)
    with open(os.path.join(folder, "command"), "w", encoding="utf-8") as file:
        file.write(shlex.join([arguments.program, *run.arguments]) + "\n")
    interrupt = 10 ** run.rng.uniform(-.5, 1) if seed % 3 == 1 else None
    run_command(arguments.program, run, outcome, interrupt=interrupt)
    check_status(outcome, folder)
    files = sorted(set(glob.glob("**/*.vtp", root_dir=folder, recursive=True)) - {"given.vtp"})
    judge(arguments.judge, names, files, outcome)
    if seed % 3 == 0 and "--time-limit" not in run.arguments:
        compare_threads(arguments.program, outcome, files)
    if run.is_of_labels and (outcome.status == 0 or "all labels are empty" in outcome.messages):
        labels = set(run.labels.flat) - {0}
        outcome.exceptions += [f"label {label} has no surface" for label in
                               labels.intersection(run.selected or labels) - outcome.found]
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
    for low, high in ((60, 1e9), (8, 59)):
        some = [one for o in outcomes for one in o.labels if low <= one[0] <= high]
        which = f"labels of {low} to {high:g} voxels"
        print_errors(f"Volume errors of {which}", [(one[1], one[3]) for one in some])
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
    arguments = parser.parse_args()
    arguments.keep = arguments.seeds == 1
    names = subprocess.run([arguments.judge, "--help"], capture_output=True, text=True,
                           check=True).stdout.split()
    seeds = range(arguments.first, arguments.first + arguments.seeds)
    outcomes = []
    with concurrent.futures.ProcessPoolExecutor(arguments.jobs) as pool:
        tasks = [pool.submit(try_seed, seed, arguments, names) for seed in seeds]
        for task in concurrent.futures.as_completed(tasks):
            outcomes.append(task.result())
            if outcomes[-1].exceptions or outcomes[-1].seconds > SLOW_SECONDS or arguments.keep:
                print(outcomes[-1].line(), flush=True)
    print_summary(outcomes)
    return 1 if any(outcome.exceptions for outcome in outcomes) else 0


if __name__ == "__main__":
    sys.exit(main())
