#!/usr/bin/python3
"""M F of this package compared with FINUFFT, one core, one run (optional: pip install finufft).

usage: compare_finufft.py [N=100000] [phi=0.1] [bench_pse_paper=build/bench/bench_pse_paper]

FINUFFT gets the same points, its own tolerance 1e-3, single precision, and the mode grid that fix bd/pse chose: three
type-1 and three type-2 transforms, including the setting of the points.  Ours is the whole of M F: wave space and
pairs.  Nine interleaved runs each; medians.
"""
import json
import os
import subprocess
import sys
import tempfile
import time

os.environ["OMP_NUM_THREADS"] = "1"
import finufft
import numpy as np

N = int(sys.argv[1]) if len(sys.argv) > 1 else 100000
phi = sys.argv[2] if len(sys.argv) > 2 else "0.1"
program = sys.argv[3] if len(sys.argv) > 3 else "build/bench/bench_pse_paper"

with tempfile.NamedTemporaryFile() as f:
    plan = json.loads(subprocess.check_output([program, "points", str(N), phi, f.name]))
    x = np.fromfile(f.name).reshape(-1, 3)
points = [np.ascontiguousarray((2 * np.pi * x[:, d] / plan["L"] - np.pi).astype(np.float32)) for d in range(3)]
modes = (plan["modes"],) * 3
rng = np.random.default_rng(1)
strength = (rng.normal(size=(3, N)) + 0j).astype(np.complex64)
options = dict(n_trans=3, eps=1e-3, dtype="complex64", nthreads=1)
forward = finufft.Plan(1, modes, isign=-1, **options)
backward = finufft.Plan(2, modes, isign=1, **options)


def theirs():
    start = time.perf_counter()
    forward.setpts(*points)
    backward.setpts(*points)
    backward.execute(forward.execute(strength))
    return time.perf_counter() - start


theirs()
finu, ours = [], []
for turn in range(3):
    finu += [theirs() for _ in range(3)]
    lines = subprocess.check_output([program, "apply", str(N), phi], text=True).split("\n")[:-1]
    ours += [tuple(map(float, line.split())) for line in lines[2:5]]
F, (whole, wave) = np.median(finu), np.median(np.array(ours), axis=0)
print(f"N {N}, phi {phi}, xi a {plan['xi']:.3g}, modes {plan['modes']}^3, our grid {plan['grid']}^3, FINUFFT {finufft.__version__}")
print(f"FINUFFT, 3 type 1 + 3 type 2   {F:.4f} s")
print(f"ours, wave space               {wave:.4f} s   {wave / F:.2f} of FINUFFT's time")
print(f"ours, M F with pairs           {whole:.4f} s   {whole / F:.2f} of FINUFFT's time")
