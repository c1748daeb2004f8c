#!/usr/bin/env python3
# SPDX-FileCopyrightText: Copyright (c) Volumic contributors
# SPDX-License-Identifier: BSD-3-Clause
"""What a limit of memory costs: one volume without a limit and with some, side by side.

    measure_limit.py --program volumic --memory 1500M,1G VOLUME [OPTION OF VOLUMIC]...

Each run is told with its seconds, what it had resident at its peak, what it read and wrote, and the
hash of its surface, which must be the same in all. Where the kernel's memory controller can be
written to, each run has a group of its own (version 1 or 2): then what is mapped and what is not are
told apart, and with --hard the kernel holds the group, page cache and all, to the limit. Exit code:
0 all is well; 1 a run failed, hashes differ, or a limit was passed.
"""

import argparse
import contextlib
import csv
import hashlib
import os
import re
import subprocess
import sys
import tempfile
import time

COLUMNS = ("limit", "seconds", "processor", "peak", "anonymous", "read", "written", "surface")
HEADINGS = ("limit", "seconds", "processor s", "MB at peak", "MB not mapped", "GB read",
            "GB written", "surface")
MEGABYTE = 1 << 20


class MemoryGroup:
    """A group of the kernel's memory controller for one run; of no use where there is none."""

    def __init__(self, hard_limit=0):
        self.folder = None
        self.is_version_1 = False
        self.peaks = {"resident": 0, "anonymous": 0}
        for parent, limit in self.candidates():
            folder = os.path.join(parent, f"volumic-{os.getpid()}-{time.monotonic_ns()}")
            with contextlib.suppress(OSError):
                os.mkdir(folder)
                self.folder = folder
                self.is_version_1 = limit == "memory.limit_in_bytes"
                if hard_limit:
                    self.write(limit, hard_limit)
                if os.path.exists(os.path.join(folder, "memory.stat")):
                    return
            self.close()

    @staticmethod
    def candidates():
        """Where a group could be made, and how a limit is called there."""
        with contextlib.suppress(OSError), open("/proc/self/cgroup", encoding="utf-8") as file:
            for line in file:
                _, controllers, path = line.rstrip("\n").split(":", 2)
                if "memory" in controllers.split(","):
                    yield "/sys/fs/cgroup/memory" + path, "memory.limit_in_bytes"
                elif not controllers:
                    yield "/sys/fs/cgroup" + path, "memory.max"

    def write(self, name, value):
        with open(os.path.join(self.folder, name), "w", encoding="utf-8") as file:
            file.write(str(value))

    def enter(self):
        """For the process itself, before it becomes the program."""
        if self.folder:
            self.write("cgroup.procs", os.getpid())

    def look(self):
        """Keep the largest of what there is now."""
        if not self.folder:
            return
        with open(os.path.join(self.folder, "memory.stat"), encoding="utf-8") as file:
            stat = {name: int(value) for name, value in (line.split() for line in file)}
        anonymous = stat["rss" if self.is_version_1 else "anon"]
        mapped = stat["mapped_file" if self.is_version_1 else "file_mapped"]
        self.peaks["anonymous"] = max(self.peaks["anonymous"], anonymous)
        self.peaks["resident"] = max(self.peaks["resident"], anonymous + mapped)

    def close(self):
        if self.folder:
            with contextlib.suppress(OSError):
                os.rmdir(self.folder)
        self.folder = None


def to_bytes(text):
    match = re.fullmatch(r"(\d+(?:\.\d+)?)([KMGT])(?:i?B)?", text, re.I)
    if not match:
        raise argparse.ArgumentTypeError(f"'{text}' is no size, such as 1500M or 2G")
    return int(float(match[1]) * 1024 ** " KMGT".index(match[2].upper()))


def limits_of(text):
    return [(word, to_bytes(word)) for word in text.split(",")]


def transferred(process):
    """Bytes that the process has read from disks and written to them so far."""
    with contextlib.suppress(OSError), open(f"/proc/{process}/io", encoding="utf-8") as file:
        values = dict(line.split(": ") for line in file.read().splitlines())
        return int(values["read_bytes"]), int(values["write_bytes"])
    return None


def hash_of(name):
    digest = hashlib.sha256()
    with open(name, "rb") as file:
        for piece in iter(lambda: file.read(MEGABYTE), b""):
            digest.update(piece)
    return digest.hexdigest()[:16]


def run(options, limit, folder):
    """The figures of one run, by COLUMNS; RuntimeError with what it said if it failed."""
    word, limit_bytes = limit
    surface = os.path.join(folder, "surface" + options.suffix)
    command = [options.program, options.volume, surface, "--quiet", *options.arguments]
    if limit_bytes:
        command += ["--memory", word]
        if options.scratch:
            command += ["--scratch", options.scratch]
    group = MemoryGroup(limit_bytes if options.hard else 0)
    if options.hard and not group.folder:
        raise RuntimeError("--hard needs a memory controller that can be written to")
    moved = (0, 0)
    before = time.monotonic()
    with tempfile.TemporaryFile(mode="w+") as said:
        process = subprocess.Popen(  # pylint: disable=consider-using-with,subprocess-popen-preexec-fn
            command, stdout=said, stderr=said, preexec_fn=group.enter)
        try:
            while True:
                pid, status, usage = os.wait4(process.pid, os.WNOHANG)
                if pid:
                    break
                group.look()
                moved = transferred(process.pid) or moved
                time.sleep(0.02)
        except BaseException:
            process.kill()
            process.wait()
            raise
        finally:
            group.close()
        process.returncode = os.waitstatus_to_exitcode(status)
        seconds = time.monotonic() - before
        if process.returncode not in (0, 3):
            said.seek(0)
            raise RuntimeError(f"ended with {process.returncode}: {said.read().strip()}")
    figures = dict(zip(COLUMNS, (word, seconds, usage.ru_utime + usage.ru_stime,
                                 usage.ru_maxrss * 1024 / MEGABYTE, None, moved[0] / 1e9,
                                 moved[1] / 1e9, hash_of(surface))))
    if group.peaks["resident"]:
        figures["anonymous"] = group.peaks["anonymous"] / MEGABYTE
    os.remove(surface)
    return figures


def text_of(value):
    return "-" if value is None else value if isinstance(value, str) else f"{value:.1f}"


def print_row(cells):
    print("  ".join(f"{cell:>14}" for cell in cells), flush=True)


def verdict(rows, limits):
    """What is wrong, a text each; what the limits cost is printed."""
    wrong = []
    free = next((row for row in rows if row["limit"] == "none"), None)
    for row in rows:
        if row["surface"] != rows[0]["surface"]:
            wrong.append(f"the surface with {row['limit']} differs from that with "
                         f"{rows[0]['limit']}")
        limit = dict(limits)[row["limit"]]
        if limit and row["peak"] * MEGABYTE > limit:
            wrong.append(f"{row['peak']:.0f} MB were resident with a limit of {row['limit']}")
        if free and row is not free:
            print(f"{row['limit']}: {row['seconds'] / free['seconds']:.2f} times the seconds, "
                  f"{row['processor'] / free['processor']:.2f} times those of the processor")
    return wrong


def parse():
    parser = argparse.ArgumentParser(
        description=__doc__.split("\n", 1)[0],
        epilog="All other options are volumic's: --iso 226.5 --threads 1 ...")
    parser.add_argument("--program", default="volumic", help="the program volumic")
    parser.add_argument("--memory", type=limits_of, required=True, metavar="LIST",
                        help="limits, with commas between: 1500M,1G")
    parser.add_argument("--only-limited", action="store_true",
                        help="not without a limit: for what does not fit into memory")
    parser.add_argument("--scratch", help="the folder for the files of runs with a limit")
    parser.add_argument("--hard", action="store_true",
                        help="the kernel holds runs to their limit, page cache included")
    parser.add_argument("--suffix", default=".vtp", help="format of the surface (default .vtp)")
    parser.add_argument("--folder", default="/var/tmp",
                        help="where the surfaces are written, and removed (default /var/tmp)")
    parser.add_argument("--csv", help="write the figures to this file too")
    parser.add_argument("volume")
    options, options.arguments = parser.parse_known_args()
    return options


def main():
    options = parse()
    limits = ([] if options.only_limited else [("none", 0)]) + options.memory
    print_row(HEADINGS)
    rows = []
    wrong = []
    with tempfile.TemporaryDirectory(dir=options.folder) as folder:
        for limit in limits:
            try:
                rows.append(run(options, limit, folder))
                print_row([text_of(rows[-1][column]) for column in COLUMNS])
            except (OSError, RuntimeError) as error:
                wrong.append(f"{limit[0]}: {error}")
    if options.csv:
        with open(options.csv, "w", newline="", encoding="utf-8") as file:
            writer = csv.DictWriter(file, COLUMNS)
            writer.writeheader()
            writer.writerows(rows)
    wrong += verdict(rows, limits)
    for text in wrong:
        print("measure_limit: " + text, file=sys.stderr)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
