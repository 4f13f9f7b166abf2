#!/usr/bin/python3
"""No more work than a simulation needs: processor seconds per step of the automatic plan, compared with overrides of it,
interleaved, for a list of systems.

    measure_skipping.py path/to/lmp

CSV on standard output.  `error` is what keyword check measures (bd/pse).  The first row of a system is the automatic plan;
`ratio` is the time of the automatic plan over that of the row."""
import re
import sys
from statistics import median

from lammps_timing import lattice_scene, run

STEPS, TURNS = 20, 5
PSE, FIB = "fix move all bd/pse {T} 1.0 5 radius 1.0 {words}", "fix move all bd/fib {T} 1.0 5 radius 1.0 {words}"
WALLS = "wall zlo noslip wall zhi noslip"
GRAVITY = "fix gravity all addforce 0 0 -1\n"

# system, what is skipped, deck before the fix, fix, automatic (T, words), overrides: name -> (T, words)
SCENES = [
    ("sedimentation, bd/pse", "noise", lattice_scene(16, 0.1) + GRAVITY, PSE, (0.0, ""), {"noise of temperature 1e-20": (1e-20, "")}),
    ("sedimentation, bd/fib", "noise, drift, second interpolation", lattice_scene(16, 0.1) + GRAVITY, FIB, (0.0, ""),
     {"with the corrector": (0.0, "scheme midpoint"), "noise of temperature 1e-20": (1e-20, "")}),
    ("suspension, bd/fib", "random finite difference", lattice_scene(16, 0.1), FIB, (1.0, ""), {"drift rfd": (1.0, "drift rfd")}),
    ("slit, bd/fib", "random finite difference", lattice_scene(14, 0.1, boundary="p p f"), FIB, (1.0, WALLS),
     {"drift rfd": (1.0, WALLS + " drift rfd")}),
    ("dilute, bd/pse", "double precision; xi by the cost model", lattice_scene(16, 0.01), PSE, (1.0, ""),
     {"double precision": (1.0, "precision double"), "xi 0.15": (1.0, "xi 0.15"), "xi 0.2": (1.0, "xi 0.2"),
      "xi 0.3": (1.0, "xi 0.3"), "xi 0.4": (1.0, "xi 0.4")}),
    ("suspension, bd/pse", "double precision; xi by the cost model", lattice_scene(16, 0.1), PSE, (1.0, ""),
     {"double precision": (1.0, "precision double"), "xi 0.4": (1.0, "xi 0.4"), "xi 0.5": (1.0, "xi 0.5"),
      "xi 0.6": (1.0, "xi 0.6"), "xi 0.75": (1.0, "xi 0.75")}),
    ("dense, bd/pse", "double precision; xi by the cost model", lattice_scene(16, 0.3), PSE, (1.0, ""),
     {"double precision": (1.0, "precision double"), "xi 0.5": (1.0, "xi 0.5"), "xi 0.6": (1.0, "xi 0.6"),
      "xi 0.9": (1.0, "xi 0.9")}),
    ("no forces, bd/pse", "forces", lattice_scene(16, 0.1, "zero 2.0"), PSE, (1.0, ""),
     {"a force of 1e-30": (1.0, "\nfix push all addforce 1e-30 0 0")}),
    ("no forces, bd/fib", "nothing: the drift is spread with the forces", lattice_scene(16, 0.1, "zero 2.0"), FIB, (1.0, ""),
     {"a force of 1e-30": (1.0, "\nfix push all addforce 1e-30 0 0")}),
]

print("scene,skipped,plan,step_seconds,ratio,error")
for scene, skipped, before, fix, automatic, overrides in SCENES:
    variants = {"automatic": automatic, **overrides}
    times, errors = {name: [] for name in variants}, {}
    for turn in range(TURNS):
        for name, (T, words) in variants.items():
            line = fix.format(T=T, words=words)
            result = run(sys.argv[1], before + line + f"\nrun 3\nrun {STEPS}\n")
            times[name].append(result.processor_seconds / STEPS)
            if turn == 0 and fix is PSE:
                checked = run(sys.argv[1], before + line.replace("radius 1.0", "radius 1.0 check yes") + "\nrun 0\n")
                errors[name] = max(float(e) for e in re.findall(r"^  error of .*: +(\S+)", checked.log, re.M))
    best = median(times["automatic"])
    for name in variants:
        t = median(times[name])
        print(f'"{scene}","{skipped}","{name}",{t:.4g},{best / t:.3g},{errors.get(name, "")}', flush=True)
    manual = min(median(times[name]) for name in overrides)
    if best > 1.1 * manual:
        print(f"{scene}: the automatic plan takes {best / manual:.2f} times the time of the best override", file=sys.stderr)
