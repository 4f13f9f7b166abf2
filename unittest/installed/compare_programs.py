#!/usr/bin/env python3
# Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
"""Runs short versions of the examples with two LAMMPS programs and compares all numbers of their thermo output.

    compare_programs.py PROGRAM PROGRAM [--table]

The first program is the reference.  Exit status 77: the second one does not exist.
"""

import os
import re
import shutil
import subprocess
import sys
import tempfile

TOP = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
# Relative to the largest number of a column.  Transforms may add in another order, and particles that collide make
# such differences grow.
BOUND = 1e-7

DECKS = [    # folder, deck, variables
    ("cluster", "in.cluster", "trajectories=1 duration=3 mobility=fib"),
    ("cluster", "in.cluster", "trajectories=2 duration=2 mobility=pse dt=0.01"),
    ("cluster", "in.cluster", "trajectories=2 duration=3 mobility=none dt=0.005"),
    ("gel", "in.gel", "N=300 duration=0.05 pictures=0 mobility=pse"),
    ("shear", "in.shear.pair", "time=2"),
    ("shear", "in.shear.single", "time=5"),
    ("cell", "in.cell", "samples=20 blocks=2"),
    ("channel-flow", "in.channel-flow", "steps=20 blocks=2"),
    ("duct", "in.duct", "steps=10 blocks=2"),
    ("slit", "in.mobility", "spacing=8"),
    ("suspension", "in.mobility", "phi=0.3 tolerance=1e-4"),
    ("suspension", "in.suspension", "phi=0.1 steps=20 blocks=2 mobility=pse"),
    ("tutorial", "in.3_pair", ""),
    ("tutorial", "in.4_wall", ""),
]


def run(program, folder, deck, variables, scratch):
    """Runs a deck in a copy of its folder, since loops over runs keep their state in a file; returns its log."""
    log = os.path.join(scratch, "log")
    here = os.path.join(scratch, "examples", folder)
    shutil.copytree(os.path.join(TOP, "examples", folder), here, ignore=shutil.ignore_patterns("results", "tmp.*"))
    os.symlink(os.path.join(TOP, "potentials"), os.path.join(scratch, "potentials"))
    words = [program, "-in", deck, "-log", log, "-screen", "none", "-var", "out", scratch]
    for pair in variables.split():
        words += ["-var", *pair.split("=")]
    done = subprocess.run(words, cwd=here, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          text=True)
    with open(log) as file:
        text = file.read()
    if done.returncode:
        sys.exit(f"{program} failed with {folder}/{deck} {variables}:\n{done.stdout}\n{text[-1500:]}")
    return text


def thermo(log):
    """Rows of numbers between the head of a thermo table and the end of its run."""
    rows, inside = [], False
    for line in log.splitlines():
        if re.match(r"\s*Step\s", line):
            inside = True
        elif line.startswith("Loop time"):
            inside = False
        elif inside:
            try:
                rows.append([float(word) for word in line.split()])
            except ValueError:
                pass    # a warning, or the output of another command
    return rows


def difference(a, b):
    """The largest difference of two tables, relative to the largest number of its column."""
    if not a or [len(row) for row in a] != [len(row) for row in b]:
        return float("inf")
    worst = 0.0
    width = max(len(row) for row in a)
    for k in range(width):
        pairs = [(x[k], y[k]) for x, y in zip(a, b) if len(x) > k]
        scale = max(abs(x) for x, _ in pairs)
        worst = max(worst, max(abs(x - y) for x, y in pairs) / scale if scale else 0.0)
    return worst


def main():
    programs = [os.path.abspath(word) for word in sys.argv[1:3]]
    if not os.path.exists(programs[1]):
        print(f"SKIPPED: there is no {programs[1]}: BDH_LAMMPS=installed cmake/prepare.sh builds it", flush=True)
        return 77
    failed = 0
    for folder, deck, variables in DECKS:
        tables = []
        for program in programs:
            with tempfile.TemporaryDirectory() as scratch:
                tables.append(thermo(run(program, folder, deck, variables, scratch)))
        worst = difference(*tables)
        failed += not worst <= BOUND
        print(f"{folder + '/' + deck:32} {variables:50} {len(tables[0]):4} rows  {worst:.1e}"
              f"{'' if worst <= BOUND else '  DIFFERS'}", flush=True)
    print(f"{len(DECKS) - failed} passed, {failed} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
