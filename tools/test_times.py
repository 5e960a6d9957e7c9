#!/usr/bin/env python3
# SPDX-License-Identifier: MIT OR Apache-2.0
"""Runs all tests, one topic after the other, and prints how long each takes: test_times.py [TOPIC...]

A topic is a module of a crate's suite, or the unit tests of a crate. CPU seconds count those of Verilator, compilers and
provers too. Run it on a machine that has nothing else to do: `make test` runs topics beside each other.
"""

import json
import os
import pathlib
import resource
import subprocess
import sys
import time

CARGO = os.environ.get("CARGO", "cargo")
SLOWEST = 10


def executables():
    """Crate, folder, whether it is the suite, and program of everything that `cargo test` runs."""
    build = [CARGO, "test", "--workspace", "--no-run", "--message-format", "json-render-diagnostics"]
    said = subprocess.run(build, stdout=subprocess.PIPE, text=True, check=True).stdout
    for line in said.splitlines():
        message = json.loads(line)
        if message["reason"] == "compiler-artifact" and message["profile"]["test"] and message["executable"]:
            folder = pathlib.Path(message["manifest_path"]).parent
            yield folder.name, folder, message["target"]["kind"] == ["test"], message["executable"]


def topics(program, folder):
    """The modules of a suite, in order."""
    listed = subprocess.run([program, "--list"], cwd=folder, stdout=subprocess.PIPE, text=True, check=True).stdout
    return sorted({line.split("::")[0] for line in listed.splitlines() if line.endswith(": test")})


def run(command, folder):
    """CPU and wall seconds of a run, and what it said if it failed."""

    def cpu():
        usage = resource.getrusage(resource.RUSAGE_CHILDREN)
        return usage.ru_utime + usage.ru_stime

    begin, used = time.monotonic(), cpu()
    ran = subprocess.run(command, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    return cpu() - used, time.monotonic() - begin, ran.stdout if ran.returncode else None


def show(name, used, wall):
    print(f"{name:<32}{used:>10.1f}{wall:>10.1f}", flush=True)


def main():
    wanted, times, failed = set(sys.argv[1:]), [], []
    print(f"{'topic':<32}{'CPU s':>10}{'s':>10}")
    for crate, folder, is_suite, program in executables():
        for topic in topics(program, folder) if is_suite else [""]:
            if wanted and topic not in wanted:
                continue
            name = f"{crate}, {topic or pathlib.Path(program).name.rsplit('-', 1)[0] + ' unit tests'}"
            used, wall, complaint = run([program, *([f"{topic}::"] if topic else [])], folder)
            show(name, used, wall)
            times.append((used, wall, name))
            if complaint is not None:
                failed.append(name)
                print(complaint)
    print(f"\nthe slowest {min(SLOWEST, len(times))} of {len(times)}")
    for used, wall, name in sorted(times, reverse=True)[:SLOWEST]:
        show(name, used, wall)
    show("all", sum(used for used, _, _ in times), sum(wall for _, wall, _ in times))
    sys.exit(f"failed: {'; '.join(failed)}" if failed else 0)


main()
