#!/usr/bin/python3
"""Configurations of hard spheres of radius 1 in equilibrium, by Metropolis Monte Carlo from a simple cubic lattice.

hard_spheres.py EDGE PHI CONFIGURATIONS SEED FOLDER      EDGE^3 spheres at the packing fraction PHI; writes FOLDER/data.1, ...
"""

import sys

import numpy as np

MELT, BETWEEN = 600, 150       # sweeps before the first configuration and between two
HEAD = """hard spheres of radius 1, packing fraction {phi}

{n} atoms
1 atom types
0 {side:.15g} xlo xhi
0 {side:.15g} ylo yhi
0 {side:.15g} zlo zhi
0 0 0 xy xz yz

Masses

1 1

Atoms # atomic

"""


def sweep(x, side, step, random):
    """One trial move per sphere; returns the share that was accepted."""
    accepted = 0
    for i, move in enumerate(random.uniform(-step, step, x.shape)):
        trial = x[i] + move
        d = x - trial
        d -= side * np.round(d / side)
        square = np.einsum("ij,ij->i", d, d)
        square[i] = 4.0
        if square.min() >= 4.0:
            x[i] = trial
            accepted += 1
    return accepted / len(x)


def write(path, x, side, phi):
    with open(path, "w") as f:
        f.write(HEAD.format(phi=phi, n=len(x), side=side))
        for i, (a, b, c) in enumerate(x % side, 1):
            f.write(f"{i} 1 {a:.12f} {b:.12f} {c:.12f}\n")


def main():
    edge, phi, configurations, seed, folder = int(sys.argv[1]), float(sys.argv[2]), int(sys.argv[3]), int(sys.argv[4]), sys.argv[5]
    random = np.random.default_rng([seed, round(1000 * phi)])
    side = (edge**3 * 4 / 3 * np.pi / phi)**(1 / 3)
    grid = (np.arange(edge) + 0.5) * side / edge
    x = np.stack(np.meshgrid(grid, grid, grid, indexing="ij"), -1).reshape(-1, 3)
    step = min(1.0, 1.5 * (side / edge - 2))
    for n in range(1, configurations + 1):
        for s in range(MELT if n == 1 else BETWEEN):
            share = sweep(x, side, step, random)
            if n == 1 and s < MELT // 2:                     # steps of which about a third are accepted
                step = min(0.5 * side, step * (1.1 if share > 0.35 else 0.9))
        write(f"{folder}/data.{n}", x, side, phi)


if __name__ == "__main__":
    main()
