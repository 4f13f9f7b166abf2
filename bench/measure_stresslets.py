#!/usr/bin/python3
"""What a step costs with `stresslet yes` over one without, and with `control_variate yes` over one with `stresslet yes`, interleaved,
and the iterations of the constraint: CSV on standard output.

    measure_stresslets.py path/to/lmp [N at most, default 100000 [N at least]]

Soft spheres at kT = 1, with noise and drift, one core, tolerance 1e-3; bd/fib with its default kernel.  The last configuration
of a run without hydrodynamic interactions is what all steps are taken from.
"""
import os
import re
import sys
from statistics import mean, median

from lammps_timing import lattice_scene, run

FIXES = {"bd/pse": "fix move all bd/pse 1.0 1.0 5 radius 1.0 fft estimate", "bd/fib": "fix move all bd/fib 1.0 1.0 5 radius 1.0 fft estimate"}
CELLS = (5, 10, 22, 46)     # spheres along an edge
ITERATIONS = {"bd/pse": 9, "bd/fib": 28}     # of the fix's vector
KEYWORDS = ("stresslet no", "stresslet yes", "stresslet yes control_variate yes")
STEPS = {5: 200, 10: 40, 22: 6, 46: 2}
RELAXED = """
fix move all bd/pse 1.0 1.0 6 radius 1.0 hydrodynamics no adapt 0.05
timestep 0.02
run 200
unfix move
timestep 0.0005
thermo 1
"""


def iterations(log):
    """Mean over the steps of the last run, without the first."""
    table = log[log.rindex("Step"):]
    return mean([float(v) for v in re.findall(r"^ +\d+ +(\S+) *$", table, re.M)][1:])


def main():
    most = int(sys.argv[2]) if len(sys.argv) > 2 else 100000
    least = int(sys.argv[3]) if len(sys.argv) > 3 else 1
    print("method,phi,N,step_seconds,stresslet_seconds,ratio,iterations,variate_seconds,variate_ratio,variate_iterations")
    for method, fix in FIXES.items():
        for phi in (0.1, 0.2, 0.3):
            for cells in CELLS:
                if not least <= cells**3 <= most or (method == "bd/fib" and cells > 22):
                    continue
                turns = 5 if cells < 46 else 1
                times, found = {k: [] for k in KEYWORDS}, {}
                for _ in range(turns):
                    for keywords, seconds in times.items():
                        column = 1 if keywords == "stresslet no" else ITERATIONS[method]
                        steps = STEPS[cells]
                        deck = (lattice_scene(cells, phi) + RELAXED + f"{fix} {keywords}\nthermo_style custom step f_move[{column}]\n"
                                f"run 1\nrun {steps}\n")
                        result = run(sys.argv[1], deck)
                        seconds.append(result.processor_seconds / steps)
                        found[keywords] = iterations(result.log)
                row = f"{method},{phi},{cells**3},{median(times[KEYWORDS[0]]):.4g}"
                for before, keywords in zip(KEYWORDS, KEYWORDS[1:]):
                    ratio = median(b / a for a, b in zip(times[before], times[keywords]))
                    row += f",{median(times[keywords]):.4g},{ratio:.3g},{found[keywords]:.3g}"
                print(row, flush=True)


if __name__ == "__main__":
    os.environ["OMP_NUM_THREADS"] = "1"
    main()
