#!/usr/bin/env python3
"""Runs a few steps of all examples, plain and with the KOKKOS package; the thermo output must agree.

    check_examples.py LMP EXAMPLES [--threads 2] [--steps 5] [--plain] [deck ...]

Every `run N` becomes a run of a few steps, in which round-off of 1e-16 grows little.  A difference of
more than 1e-6 of the largest number in its column is an error.  With "device" the fixes of this
package are named .../kk/device.  --plain only checks that an input script runs, and that an lmp built
with sanitizers reports nothing.
"""
import argparse
import concurrent.futures
import glob
import os
import re
import shutil
import subprocess
import sys
import tempfile

# With its long steps, round-off grows tenfold in twenty of them.  The first steps of gels have hundreds of pieces.
FURTHER_OPTIONS = {"diffusion/in.diffusion": ["-var", "blocks", "4"], "gel/in.gel": ["-var", "N", "300"],
                   "rheology/in.yield": ["-var", "N", "200"]}
# In double precision: what a constraint takes is solved for, which enlarges the rounding of single precision.
FURTHER_OPTIONS |= {deck: ["-var", "tolerance", "5e-5"]
                    for deck in ("obstacles/in.posts", "rheology/in.fluctuations", "rheology/in.shear")}
# Repeated with forces within the step.
SCHEMES = {"cluster/in.cluster": [["-var", "scheme", "improved"],
                                  ["-var", "mobility", "pse", "-var", "pse_scheme", "scheme euler", "-var", "dt", "0.01"]],
           "slit/in.slit": [["-var", "scheme", "improved"]],
           "shear/in.shear.single": [["-var", "scheme", "improved"]]}
# The error for decks whose atom style the KOKKOS package does not have: dipoles before 2025.
NEEDS_ATOM_STYLE = "KOKKOS package requires a kokkos enabled atom_style"
# These divide by a mobility that they average over a separate run, which keeps its length.
UNCHANGED_RUNS = {"diffusion/in.diffusion": "1600", "shear/in.shear.single": "1600"}

# These go on, with other options, from the file that a plain run of theirs leaves.  With KOKKOS, the fixes of LAMMPS in that run
# would draw other random numbers.
CONTINUED = {deck: ["-var", "motion", "pse"] for deck in ("dipoles/in.dipoles", "mixture/in.mixture")}


def shortened(text, steps, kept):
    """The script with short runs, except those of `kept` steps, short minimizations, in which round-off grows as well, and
    thermo output at every step."""
    text = re.sub(r"(?m)^([^#\n]*\bminimize\s+\S+\s+\S+)\s+\d+", r"\1 20", text)
    text = re.sub(r"(?m)^(\s*)run\s+(\S+)", lambda m: f"{m.group(1)}run {m.group(2) if m.group(2) in ('0', kept) else steps}", text)
    return re.sub(r"(?m)^thermo\s+\S+", "thermo 1", text)


def thermo(log):
    """Tables of a log file: [names, rows] for each run."""
    tables, open_table = [], False
    for line in log.splitlines():
        words = line.split()
        if words[:1] == ["Step"]:
            tables.append((words, []))
            open_table = True
        elif open_table and re.match(r"[-+.\d]", line.strip()) and len(words) == len(tables[-1][0]):
            tables[-1][1].append([float(w) for w in words])
        elif "WARNING" not in line:
            open_table = False
    return tables


def run(lmp, examples, name, steps, options, device=False):
    """Thermo tables of an input script, or the error that ended it."""
    with tempfile.TemporaryDirectory() as work:
        copy = os.path.join(work, "examples", os.path.dirname(name))
        shutil.copytree(os.path.join(examples, os.path.dirname(name)), copy)
        os.symlink(os.path.join(os.path.dirname(examples), "potentials"), os.path.join(work, "potentials"))
        deck = os.path.basename(name)
        path = os.path.join(copy, deck)
        with open(path) as f:
            text = shortened(f.read(), steps, UNCHANGED_RUNS.get(name, "0"))
        if device:
            text = re.sub(r"\b(bd/fib|bd/pse)\b", r"\1/kk/device", text)
        with open(path, "w") as f:
            f.write(text)

        def start(arguments):
            return subprocess.run([lmp, "-in", deck, "-log", "log.check"] + arguments, cwd=copy, capture_output=True, text=True, timeout=600)

        log_file = os.path.join(copy, "log.check")
        results = []
        if name in CONTINUED:
            results.append(start([]))
            if os.path.exists(log_file):
                os.remove(log_file)
        results.append(start(options + FURTHER_OPTIONS.get(name, []) + CONTINUED.get(name, [])))
        log = ""
        if os.path.exists(log_file):
            with open(log_file) as f:
                log = f.read()
    error = re.search(r"ERROR.*|.*runtime error:.*", log + "".join(r.stdout + r.stderr for r in results))
    status = [r.returncode for r in results if r.returncode]
    return thermo(log), error.group(0) if error else f"exit status {status[0]}" if status else None


def largest_difference(one, two):
    """Difference of two sets of tables, relative to the largest number of each column."""
    if [t[0] for t in one] != [t[0] for t in two] or [len(t[1]) for t in one] != [len(t[1]) for t in two]:
        return float("inf")
    worst = 0.0
    for (names, a), (_, b) in zip(one, two):
        for c, name in enumerate(names):
            if name.lower() in ("cpu", "elapsed", "tpcpu", "spcpu"):
                continue
            scale = max([abs(row[c]) for row in a] + [1e-12])
            worst = max([worst] + [abs(x[c] - y[c]) / scale for x, y in zip(a, b)])
    return worst


def faults(lmp, examples, name, args, options):
    """Number of runs of an input script with Kokkos that fail or differ from the plain one, and a report."""
    plain, error = run(lmp, examples, name, args.steps, options)
    if error or not plain:
        return 1, f"{name:30s} plain run failed: {error}"
    if args.plain:
        return 0, f"{name:30s} plain {len(plain)} runs {' '.join(options)}"
    failed, report = 0, []
    for device in (False, True):
        kokkos, error = run(lmp, examples, name, args.steps, ["-k", "on", "t", args.threads, "-sf", "kk"] + options, device)
        if error and NEEDS_ATOM_STYLE in error:
            report.append(f"{name:30s} {'device' if device else 'kk':8s} SKIPPED: the KOKKOS package of this LAMMPS does not have the atom style")
            continue
        difference = largest_difference(plain, kokkos)
        good = error is None and difference < 1e-6
        report.append(f"{name:30s} {'device' if device else 'kk':8s} {len(plain)} runs, difference {difference:.1e} "
                      f"{'' if good else '  FAULT ' + (error or '')} {' '.join(options)}")
        failed += not good
    return failed, "\n".join(report)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("lmp")
    parser.add_argument("examples")
    parser.add_argument("decks", nargs="*")
    parser.add_argument("--threads", default="2")
    parser.add_argument("--steps", default="5")
    parser.add_argument("--plain", action="store_true")
    args = parser.parse_args()
    lmp, examples = os.path.abspath(args.lmp), os.path.abspath(args.examples)
    names = [os.path.relpath(path, examples) for path in sorted(glob.glob(os.path.join(examples, "*", "in.*")))]
    cases = [(name, scheme) for name in names if not args.decks or name in args.decks for scheme in [[]] + SCHEMES.get(name, [])]
    failed = 0
    # Much of a run is on one thread, so that two at a time keep two cores busy.
    with concurrent.futures.ThreadPoolExecutor(max_workers=2) as pool:
        for count, report in pool.map(lambda case: faults(lmp, examples, case[0], args, case[1]), cases):
            failed += count
            print(report, flush=True)
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
