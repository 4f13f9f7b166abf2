#!/usr/bin/python3
"""What a step costs with `stresslet yes`, over one without, interleaved, and the iterations of the constraint: CSV on standard output.

    measure_stresslets.py path/to/lmp [N at most, default 100000]

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
    print("method,phi,N,step_seconds,stresslet_seconds,ratio,iterations")
    for method, fix in FIXES.items():
        for phi in (0.1, 0.2, 0.3):
            for cells in CELLS:
                if cells**3 > most or (method == "bd/fib" and cells > 22):
                    continue
                turns = 5 if cells < 46 else 1
                times, found = {"no": [], "yes": []}, 0.0
                for _ in range(turns):
                    for stresslet, seconds in times.items():
                        column = "f_move[9]" if stresslet == "yes" else "f_move[1]"
                        steps = STEPS[cells]
                        deck = (lattice_scene(cells, phi) + RELAXED + f"{fix} stresslet {stresslet}\nthermo_style custom step {column}\n"
                                f"run 1\nrun {steps}\n")
                        result = run(sys.argv[1], deck)
                        seconds.append(result.processor_seconds / steps)
                        if stresslet == "yes":
                            found = iterations(result.log)
                ratio = median(b / a for a, b in zip(times["no"], times["yes"]))
                print(f"{method},{phi},{cells**3},{median(times['no']):.4g},{median(times['yes']):.4g},{ratio:.3g},{found:.3g}", flush=True)


if __name__ == "__main__":
    os.environ["OMP_NUM_THREADS"] = "1"
    main()
