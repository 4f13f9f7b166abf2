#!/usr/bin/python3
"""Steps of JFSD (PyPI, with JAX on the processor) and of fix bd/pse, same spheres, one core: CSV on standard output.

    compare_jfsd.py path/to/lmp path/to/python path/to/jfsd-0.2.2 [N ...]

The second argument is the Python of an environment with JFSD, which is optional; the third is its unpacked source, since the
wheel lacks tables.  bench/README.md says how to get both.
JFSD has two levels.  Its "rpy" has forces, torques and noise; beside it stands bd/pse with rotation.  Its "sd" has stresslets
and lubrication; beside it stands bd/pse with stresslets, which has no lubrication.  Spheres at a packing fraction of 0.1 do not
overlap; kT is 1, the tolerance 1e-3, JFSD in single precision.  Compilation by JAX is not counted.
"""
import os
import subprocess
import sys
import tempfile
from statistics import median

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
from lammps_timing import run

PHI, TURNS, STEPS = 0.1, 3, 10
THEIR_XI = (0.3, 0.5, 0.8)       # of level rpy; its default is 0.5; the fastest counts, for both levels
LEVELS = {"rpy": (1, "rotation yes"), "sd": (2, "stresslet yes")}

THEIRS = """
import os, sys, time, io, contextlib
import numpy as np
os.sched_setaffinity(0, {int(sys.argv[5])})
from jfsd.main import main
x, side = np.load(sys.argv[1]), float(sys.argv[2])
def steps(n):
    start = time.perf_counter()
    with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
        main(n, n, 1e-4, side, side, side, len(x), 0.5, 1.0, 1.0, float(sys.argv[4]), 1e-3, 0.0, 0, 0.0, x, 1, 2, 3, 4, 0.0, 0.0,
             None, False, False, False, np.zeros((len(x), 3)), np.zeros((len(x), 3)), int(sys.argv[3]), 0, 0, 0.0, 0.0)
    return time.perf_counter() - start
n = int(sys.argv[6])
steps(3)                       # compiles
seconds = []
for turn in range(int(sys.argv[7])):
    few = steps(2)
    seconds.append((steps(2 + n) - few) / n)
print(np.median(seconds))
"""


def spheres(N):
    """Positions on a displaced lattice, and the side of the box."""
    edge = round(N**(1 / 3))
    spacing = (4 / 3 * np.pi / PHI)**(1 / 3)
    grid = np.stack(np.meshgrid(*[np.arange(edge)] * 3), -1).reshape(-1, 3) + 0.5
    shift = np.random.default_rng(1).uniform(-0.5, 0.5, grid.shape) * (spacing - 2.05) / np.sqrt(3)
    return spacing * grid + shift, edge * spacing


def theirs(python, source, x, side, level, xi):
    """Seconds per step; None if it stops."""
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "x.npy")
        np.save(path, x - side / 2)
        done = subprocess.run([python, "-c", THEIRS, path, str(side), str(level), str(xi), str(min(os.sched_getaffinity(0))), str(STEPS), str(TURNS)],
                              cwd=source, capture_output=True, text=True, env={**os.environ, "JAX_PLATFORMS": "cpu"})
    if done.returncode:
        print(done.stderr[-500:], file=sys.stderr)
        return None
    return float(done.stdout.split()[-1])


def ours(lmp, x, side, keyword):
    atoms = "\n".join(f"create_atoms 1 single {a:.10g} {b:.10g} {c:.10g} units box" for a, b, c in x)
    deck = f"""units lj
atom_style sphere
region box block 0 {side:.12g} 0 {side:.12g} 0 {side:.12g}
create_box 1 box
{atoms}
set type 1 diameter 2.0
pair_style zero 2.0
pair_coeff * *
timestep 1e-4
fix move all bd/pse 1.0 {1 / (6 * np.pi):.12g} 5 radius 1.0 fft estimate {keyword}
run 3
run {10 * STEPS}
"""
    return run(lmp, deck).seconds_per_step(10 * STEPS)


def main():
    os.environ["OMP_NUM_THREADS"] = "1"
    lmp, python, source = sys.argv[1:4]
    print("level,N,jfsd_xi,jfsd_seconds,bd_pse_seconds,ratio")
    for N in [int(v) for v in sys.argv[4:]] or [125, 1000]:
        x, side = spheres(N)
        their_xi = THEIR_XI
        for name, (level, keyword) in LEVELS.items():
            found = {xi: theirs(python, source, x, side, level, xi) for xi in their_xi}
            found = {xi: seconds for xi, seconds in found.items() if seconds}
            if not found:
                raise SystemExit(f"JFSD stopped for all of {their_xi}, see above")
            xi = min(found, key=found.get)
            their_xi = (xi, )            # compiling the second level takes minutes
            mine = median(ours(lmp, x, side, keyword) for _ in range(TURNS))
            print(f"{name},{len(x)},{xi},{found[xi]:.4g},{mine:.4g},{found[xi] / mine:.3g}", flush=True)


if __name__ == "__main__":
    main()
