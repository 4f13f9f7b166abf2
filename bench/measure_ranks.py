#!/usr/bin/python3
"""Whole steps of both fixes on 1 and 2 ranks, interleaved: CSV on standard output.

    measure_ranks.py path/to/lmp [path/to/lmp with KOKKOS, for 1 and 2 threads of the /kk styles too]
"""
import os
import sys
from statistics import median

from lammps_timing import lattice_scene, run

TURNS = 5
STEPS = {16: 100, 24: 40, 36: 20}    # by number of spheres along an edge: runs of about a second
SCENES = {
    "pse 1e-3": "fix move all bd/pse 1.0 1.0 5 radius 1.0",
    "fib peskin4": "fix move all bd/fib 1.0 1.0 5 radius 1.0",
}
os.environ["OMP_PROC_BIND"] = "false"    # otherwise runs share a core with other programs
plain, kokkos = sys.argv[1], sys.argv[2] if len(sys.argv) > 2 else None
print("method,N,kind,count,step_seconds,speedup")
for method, fix in SCENES.items():
    for cells, steps in STEPS.items():
        # Threads may share a core for their first tenth of a second, so there are more warm-up steps than the lists need.
        deck = lattice_scene(cells, 0.1) + fix + f"\nrun {steps // 2}\nrun {steps}\n"
        times = {("ranks", 1): [], ("ranks", 2): []}
        if kokkos:
            times |= {("threads", 1): [], ("threads", 2): []}
        for _ in range(TURNS):
            for (kind, count), seconds in times.items():
                if kind == "ranks":
                    result = run(plain, deck, count)
                else:
                    result = run(kokkos, deck, options=("-k", "on", "t", str(count), "-sf", "kk"))
                seconds.append(result.seconds_per_step(steps))
        for (kind, count), seconds in times.items():
            gain = median(times[kind, 1]) / median(seconds)
            print(f"{method},{cells ** 3},{kind},{count},{median(seconds):.4g},{gain:.3g}", flush=True)
