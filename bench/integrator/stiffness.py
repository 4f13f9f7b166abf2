#!/usr/bin/python3
"""Stiffness of a forming gel for scheme euler: the largest eigenvalue of M K, where M is the Rotne-Prager-Yamakawa mobility
and K the second derivatives of the energy.  Steps longer than 2 over this are unstable.  CSV on standard output.

    bench/integrator/stiffness.py [path/to/lmp]        15 seconds

500 colloids with the forces of in.gel_forces, quenched from a relaxed fluid of repulsive colloids.
"""
import os
import subprocess
import sys
import tempfile

import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
LMP = os.path.abspath(sys.argv[1] if len(sys.argv) > 1 else os.path.join(HERE, "..", "..", "build", "lmp"))
TIMES = (0.0, 0.2, 1.0, 2.0, 5.0, 10.0, 20.0)
DECK = """
units lj
atom_style atomic
boundary p p p
neighbor 1.0 bin
neigh_modify every 1 delay 0 check yes
variable side equal (500*4*PI/3/0.15)^(1/3)
region box block 0 ${side} 0 ${side} 0 ${side}
create_box 1 box
create_atoms 1 random 500 5 NULL
mass 1 1.0
pair_style soft 2.0
pair_coeff 1 1 20.0
minimize 0.0 1.0e-3 1000 10000
pair_style lj/cut 2.0
pair_coeff 1 1 10.0 1.7817974362806785
pair_modify shift yes
fix move all brownian 1.0 1 gamma_t 1.0 rng gaussian
timestep $(0.005/6/PI)
run 2000
unfix move
reset_timestep 0
include in.gel_forces
pair_write 1 1 4001 r 1.6 2.6 %s/pair.table pair
fix move all bd/pse 1.0 1.0 7 radius 1.0 fft estimate
timestep 0.005
dump d all custom 40 %s/gel.dump id x y z
dump_modify d sort id format float %%.10g first yes
run 4000
"""


def mobility(R, e):
    """Mobility of spheres of radius 1 at distances R along e; nearest images only."""
    touching = R <= 2.0
    along_all = np.where(touching, 1 - 9 * R / 32, 0.75 / R + 0.5 / R**3)
    along_line = np.where(touching, 3 * R / 32, 0.75 / R - 1.5 / R**3)
    M = along_all[..., None, None] * np.eye(3) + along_line[..., None, None] * e[..., :, None] * e[..., None, :]
    n = len(R)
    M[range(n), range(n)] = np.eye(3)
    return M.transpose(0, 2, 1, 3).reshape(3 * n, 3 * n) / (6 * np.pi)


def second_derivatives(R, e, r, force):
    n, slope = len(R), np.gradient(-force, r)
    K = np.zeros((n, 3, n, 3))
    for i, j in zip(*np.nonzero(R < r[-1])):
        line = np.outer(e[i, j], e[i, j])
        block = np.interp(R[i, j], r, slope) * line - np.interp(R[i, j], r, force) / R[i, j] * (np.eye(3) - line)
        K[i, :, j, :] -= block
        K[i, :, i, :] += block
    return K.reshape(3 * n, 3 * n)


def largest_eigenvalue(M, K):
    v = np.random.default_rng(1).normal(size=len(K))
    for _ in range(100):
        v = M @ (K @ v)
        size = np.linalg.norm(v)
        v /= size
    return size


def main():
    with tempfile.TemporaryDirectory() as folder:
        deck = os.path.join(folder, "in.stiffness")
        with open(deck, "w") as f:
            f.write(DECK % (folder, folder))
        subprocess.run([LMP, "-in", deck, "-log", "none", "-screen", "none"], cwd=HERE, check=True, env=dict(os.environ, OMP_NUM_THREADS="1"))
        r, _, force = np.loadtxt(os.path.join(folder, "pair.table"), skiprows=5)[:, 1:4].T
        with open(os.path.join(folder, "gel.dump")) as f:
            frames = f.read().split("ITEM: TIMESTEP\n")[1:]
    print("time,contacts,largest_eigenvalue,largest_euler_step")
    for frame in frames:
        lines = frame.splitlines()
        time = 0.005 * int(lines[0])
        if time not in TIMES:
            continue
        low, high = np.array([line.split() for line in lines[4:7]], float).T
        x = np.array([line.split()[1:4] for line in lines[8:]], float)
        d = x[:, None] - x[None]
        d -= (high - low) * np.round(d / (high - low))
        R = np.linalg.norm(d, axis=-1)
        np.fill_diagonal(R, 1e9)
        e = d / R[..., None]
        largest = largest_eigenvalue(mobility(R, e), second_derivatives(R, e, r, force))
        print(f"{time:g},{(R < r[-1]).sum() / len(R):.2f},{largest:.3g},{2 / largest:.3g}", flush=True)


if __name__ == "__main__":
    main()
