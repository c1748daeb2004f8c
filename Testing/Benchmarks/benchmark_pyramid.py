#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""vtkImagePyramid and its peers (the program BenchmarkImagePyramid): times with one thread are those
of the processor, with two the time that passed; medians of all repetitions, which FILE.json has.
"""

import argparse
import collections
import json
import statistics
import subprocess
import sys

WORK = [(levels, threads) for levels in ("one level", "all levels") for threads in (1, 2)]


def parse_options():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", required=True, help="BenchmarkImagePyramid")
    parser.add_argument("--volume", metavar="FILE.vti")
    parser.add_argument("--generate", type=int, metavar="SIZE", default=512)
    parser.add_argument("--repetitions", type=int, default=9)
    parser.add_argument("--json", metavar="FILE.json", required=True)
    return parser.parse_args()


class Times:
    """Milliseconds by who, how many levels and how many threads."""

    def __init__(self, path):
        self.wall = collections.defaultdict(list)
        self.processor = collections.defaultdict(list)
        with open(path, encoding="utf-8") as file:
            told = json.load(file)
        self.machine = told["context"]
        for run in told["benchmarks"]:
            if run["run_type"] == "iteration":
                who, levels, threads = run["name"].split("/")[0].split(", ")
                key = who, levels, int(threads[0])
                self.wall[key].append(run["real_time"])
                self.processor[key].append(run["cpu_time"])

    def contenders(self):
        return list(dict.fromkeys(who for who, _, _ in sorted(self.wall, key=self.order)))

    @staticmethod
    def order(key):
        names = ("copying", "vtkImagePyramid", "VTK", "ITK")
        return [key[0].startswith(name) for name in names].index(True)

    def of(self, *key):
        return statistics.median((self.processor if key[2] == 1 else self.wall)[key])


def print_times(times):
    print(f"\n{'':26} {'one level':36} {'all levels':36}\n{'':26}"
          + "".join(f" {'1 thread' if threads == 1 else '2 threads':17}" for _, threads in WORK))
    for who in times.contenders():
        line = f"{who:26}"
        for levels, threads in WORK:
            if (who, levels, threads) in times.wall:
                median = times.of(who, levels, threads)
                copying = times.of("copying the voxels", "one level", threads)
                line += f" {median:8.2f} ms {median / copying:4.0f} x"
            else:
                line += " " * 18
        print(line)
    print("(x: times copying the voxels with as many threads)\n")


def print_target(what, reached, relation, wanted):
    is_met = reached <= wanted if relation == "<=" else reached >= wanted
    print(f"{what:58} {reached:8.4f}  ({relation} {wanted:g})  {'reached' if is_met else 'MISSED'}")


def print_time_targets(times):
    ours = "vtkImagePyramid"
    one = times.of(ours, "one level", 1)
    for peer, wanted in zip(times.contenders()[2:], (0.05, 0.025)):
        print_target(f"P1 one level, 1 thread, relative to {peer}",
                     one / times.of(peer, "one level", 1), "<=", wanted)
    first, second = (times.wall[ours, "one level", threads] for threads in (1, 2))
    print_target("P1 one level, 2 threads, times faster",
                 statistics.median(first) / statistics.median(second), ">=", 1.7)
    # Two threads need a processor each: where others run too, only this can show what they gain.
    print_target("P1 the same, by the quickest repetition of each", min(first) / min(second),
                 ">=", 1.7)
    print_target("P2 all levels relative to the first", times.of(ours, "all levels", 1) / one,
                 "<=", 1.35)


def print_memory_target(options, volume, threads):
    """In a process of its own, where no memory has been used and freed."""
    process = subprocess.run([options.program, "--peak-memory", str(threads), *volume],
                             stdout=subprocess.PIPE, text=True, check=False)
    if process.returncode:
        print("P3 could not be measured here")
        return
    growth, pyramid, *size = map(int, process.stdout.split())
    plane = 4 * size[0] * size[1]
    print_target(f"P3 peak memory, {threads} threads, relative to pyramid and planes",
                 growth / (pyramid + threads * plane), "<=", 1.0)
    print(f"   grown by {1e-6 * growth:.2f} MB; levels from 1 on take {1e-6 * pyramid:.2f} MB, a plane "
          f"{1e-6 * plane:.2f} MB, level 0 {2e-6 * size[0] * size[1] * size[2]:.2f} MB")


def main():
    options = parse_options()
    volume = (["--volume", options.volume] if options.volume
              else ["--generate", str(options.generate)])
    # Repetitions of all are in random order.
    process = subprocess.run(
        [options.program, *volume, "--repetitions", str(options.repetitions),
         f"--benchmark_out={options.json}", "--benchmark_format=json"],
        stdout=subprocess.PIPE, text=True, check=False)
    if process.returncode:
        return process.returncode
    times = Times(options.json)
    load = " ".join(map(str, times.machine["load_avg"]))
    print(f"{times.machine['num_cpus']} processors of {times.machine['mhz_per_cpu'] / 1000:g} GHz, "
          f"load {load}")
    print("\n" + next(line for line in process.stdout.splitlines() if "int16" in line))
    print_times(times)
    print_time_targets(times)
    for threads in (1, 2):
        print_memory_target(options, volume, threads)
    return 0


if __name__ == "__main__":
    sys.exit(main())
