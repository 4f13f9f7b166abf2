#!/usr/bin/env python3
# Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
"""Runs short versions of the examples with two LAMMPS programs and compares all numbers of their thermo output.

    compare_programs.py REFERENCE PROGRAM
    compare_programs.py --save FILE.json PROGRAM     only writes what another run can take as its reference

REFERENCE is a program or such a file.  Exit status 77: there is no PROGRAM.
"""

import json
import os
import re
import shutil
import subprocess
import sys
import tempfile

TOP = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
# Relative to the largest number of a column.  Transforms may add in another order, and particles that collide make
# such differences grow.  Where single precision shows, decks of bd/pse have a tolerance of 1e-5, which it keeps in
# double precision: single precision alone differs by as much between processors.
BOUND = 1e-7

DECKS = [    # folder, deck, variables
    ("cluster", "in.cluster", "trajectories=1 duration=3 mobility=fib"),
    ("cluster", "in.cluster", "trajectories=2 duration=5 mobility=pse tolerance=1e-5"),
    ("cluster", "in.cluster", "trajectories=2 duration=3 mobility=none"),
    ("gel", "in.gel", "N=300 duration=0.05 pictures=0 mobility=pse"),
    ("shear", "in.shear.pair", "time=2"),
    ("shear", "in.shear.single", "time=5"),
    ("cell", "in.cell", "samples=20 blocks=2"),
    ("channel-flow", "in.channel-flow", "steps=20 blocks=2"),
    ("duct", "in.duct", "steps=10 blocks=2"),
    ("slit", "in.mobility", "spacing=8"),
    ("suspension", "in.mobility", "phi=0.3 tolerance=1e-5"),
    ("suspension", "in.suspension", "phi=0.1 steps=20 blocks=2 mobility=pse tolerance=1e-5"),
    ("rollers", "in.rollers", "length=32 width=24 strip=16 duration=0.02 frame=0.004"),
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


def rows_of(program, deck):
    """The thermo output of a program, or what a file has of it."""
    if isinstance(program, dict):
        return program[" ".join(deck)]
    with tempfile.TemporaryDirectory() as scratch:
        return thermo(run(program, *deck, scratch))


def save(path, program):
    with open(path, "w") as file:
        json.dump({" ".join(deck): rows_of(program, deck) for deck in DECKS}, file)


def compare(reference, program):
    """Prints a line for each deck; returns the number of decks that differ."""
    failed, largest = 0, 0.0
    for deck in DECKS:
        rows = rows_of(reference, deck)
        worst = difference(rows, rows_of(program, deck))
        largest = max(largest, worst)
        failed += not worst <= BOUND
        print(f"{deck[0] + '/' + deck[1]:32} {deck[2]:50} {len(rows):4} rows  {worst:.1e}"
              f"{'' if worst <= BOUND else '  DIFFERS'}", flush=True)
    print(f"largest difference: {largest:.1e}")
    print(f"{len(DECKS) - failed} passed, {failed} failed")
    return failed


def main():
    if sys.argv[1] == "--save":
        save(sys.argv[2], os.path.abspath(sys.argv[3]))
        return 0
    reference, program = (os.path.abspath(word) for word in sys.argv[1:3])
    if not os.path.exists(program):
        print(f"SKIPPED: there is no {program}: BDH_LAMMPS=installed cmake/prepare.sh builds it", flush=True)
        return 77
    if reference.endswith(".json"):
        with open(reference) as file:
            reference = json.load(file)
    return 1 if compare(reference, program) else 0


if __name__ == "__main__":
    sys.exit(main())
