#!/usr/bin/env python3
"""Checks the numbers of mol-pair-asakura_oosawa.yaml independently: pairs, images and bonded
neighbours are counted here, forces come from the formula of the paper, and velocity Verlet does the run.

    check_pair_yaml.py YAML DATA_FOURMOL"""
import sys
import numpy as np


def sections(path):
    """Rows of numbers by section of a LAMMPS data file."""
    found, name = {}, ""
    for line in open(path):
        words = line.split("#")[0].split()
        if words and words[0][0].isalpha():
            name = words[0]
            found[name] = []
        elif words:
            found[name].append(words)
    return found


def blocks(path):
    found, name = {}, ""
    for line in open(path):
        if line[0] not in " .-\n" and ":" in line:
            name, value = line.split(":", 1)
            found[name] = [value.split()]
        elif line.startswith(" "):
            found[name].append(line.split())
    return found


def bonded_factors(n, bonds, one_two, one_three, one_four):
    near = np.zeros((n, n), int)
    for _, _, i, j in bonds:
        near[int(i) - 1, int(j) - 1] = near[int(j) - 1, int(i) - 1] = 1
    reach, factor = np.linalg.matrix_power(near + np.eye(n, dtype=int), 3), np.ones((n, n))
    factor[reach > 0] = one_four
    factor[np.linalg.matrix_power(near + np.eye(n, dtype=int), 2) > 0] = one_three
    factor[near > 0] = one_two
    return factor


def forces(x, length, c, D, factor):
    """Energy, forces and virial xx yy zz xy xz yz over all images."""
    n, energy, f, virial = len(x), 0.0, np.zeros_like(x), np.zeros((3, 3))
    for shift in np.ndindex(3, 3, 3):
        image = (np.array(shift) - 1) * length
        r = x[:, None, :] - x[None, :, :] + image
        d = np.linalg.norm(r, axis=2)
        on = (d < D) & (d > 0)
        # LAMMPS applies the factor of bonded atoms only to their nearest images.
        nearest = np.all(np.abs(r) < 0.5 * length, axis=2)
        w = np.where(nearest, factor, 1.0)
        energy += 0.5 * np.sum(np.where(on, -w * c / 3 * (D - d) ** 2 * (d + 2 * D), 0.0))
        pull = np.where(on, -w * c * (D * D - d * d) / np.where(d > 0, d, 1.0), 0.0)[:, :, None] * r
        f += pull.sum(axis=1)
        virial += 0.5 * np.einsum("ija,ijb->ab", r, pull)
    return energy, f, virial[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]]


def main():
    yaml, data = blocks(sys.argv[1]), sections(sys.argv[2])
    bounds = np.array([[float(v) for v in row[:2]] for row in data["LAMMPS"] if len(row) == 4 and row[2].endswith("lo")])
    length = bounds[:, 1] - bounds[:, 0]
    atoms = sorted(data["Atoms"], key=lambda row: int(row[0]))
    kind = np.array([int(row[2]) for row in atoms])
    x = np.array([[float(v) for v in row[4:7]] for row in atoms])
    v = np.array([[float(t) for t in row[1:4]] for row in sorted(data["Velocities"], key=lambda row: int(row[0]))])
    mass = np.array([float(row[1]) for row in data["Masses"]])[kind - 1][:, None]
    boltz, ftm2v = 0.0019872067, 1.0 / 48.88821291 / 48.88821291
    c, D = np.full((6, 6), 0.02), np.full((6, 6), 6.0)
    c[1, 1], D[1, 1] = np.pi / 4 * 0.01 * boltz * 300, 5.5
    c[2, 4] = c[4, 2] = 0.0
    D[2, 4] = D[4, 2] = 1.0
    c[3, 3], D[3, 3] = np.pi / 4 * 0.3 / (np.pi / 6 * 3.5**3) * boltz * 300, 7.5
    c, D = c[np.ix_(kind, kind)], D[np.ix_(kind, kind)]
    factor = bonded_factors(len(x), data["Bonds"], 0.10, 0.25, 0.50)

    def compare(prefix):
        energy, f, virial = forces(x, length, c, D, factor)
        theirs = np.array([[float(t) for t in row[1:]] for row in yaml[prefix + "_forces"][1:]])
        stress = np.array([float(t) for t in yaml[prefix + "_stress"][1]])
        return (abs(float(yaml[prefix + "_vdwl"][0][0]) / energy - 1), np.abs(theirs - f).max() / np.abs(f).max(),
                np.abs(stress - virial).max() / np.abs(virial).max())

    errors = [compare("init")]
    dt = 0.1
    f = forces(x, length, c, D, factor)[1]
    for _ in range(4):
        v += 0.5 * dt * ftm2v * f / mass
        x += dt * v
        f = forces(x, length, c, D, factor)[1]
        v += 0.5 * dt * ftm2v * f / mass
    errors.append(compare("run"))
    print("relative deviations of energy, forces, virial: init %.1e %.1e %.1e, run %.1e %.1e %.1e" % tuple(np.ravel(errors)))
    sys.exit(0 if np.max(errors) < 1e-9 else 1)


main()
