#!/usr/bin/env python3
"""Whole steps of both fixes on 1 and 2 ranks, in turns: CSV on standard output.   measure_ranks.py path/to/lmp"""
import sys
from statistics import median

from lammps_timing import lattice_scene, run

STEPS, TURNS = 20, 3
SCENES = {
    "pse 1e-3": "fix move all bd/pse 1.0 1.0 5 radius 1.0",
    "fib peskin4": "fix move all bd/fib 1.0 1.0 5 radius 1.0",
}
print("method,N,ranks,step_seconds,speedup")
for method, fix in SCENES.items():
    for cells in (16, 24, 36):
        deck = lattice_scene(cells, 0.1) + fix + f"\nrun 3\nrun {STEPS}\n"
        times = {1: [], 2: []}
        for _ in range(TURNS):
            for ranks in times:
                times[ranks].append(run(sys.argv[1], deck, ranks).seconds_per_step(STEPS))
        for ranks in times:
            print(f"{method},{cells ** 3},{ranks},{median(times[ranks]):.4g},{median(times[1]) / median(times[ranks]):.3g}",
                  flush=True)
