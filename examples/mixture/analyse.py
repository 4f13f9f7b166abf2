#!/usr/bin/python3
"""A mixture of spheres 1:4: velocities under given forces against an independent Ewald sum, short-time self-diffusion of both
species against the same sum, and depletion of the large ones against molecular dynamics."""

import glob
import os
import sys

import numpy as np
from scipy.special import erfc

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "common"))
import bdh_examples as ex

RADII = {"large": 1.0, "small": 0.25}
TOLERANCE = 1e-3                     # of the diffusion run
CONTACT = 2.0                        # large spheres in touch: closer than two radii, where their repulsion begins
BLOCKS = 16


# ---- theory: Rotne-Prager-Yamakawa spheres of any radii in a periodic cube, viscosity 1 ---------------------------------
#
# The flow of a point force is J = (I Laplacian - grad grad) r/(8 pi); that of two spheres is (1 + c Laplacian) J with
# c = (a^2 + b^2)/6.  Beenakker (J. Chem. Phys. 85, 1581, 1986) splits r = r erfc(alpha r) + r erf(alpha r).

def near_pair(r, c, alpha):
    """Transverse and longitudinal mobility by r erfc(alpha r); alpha = 0: the whole, in an unbounded fluid."""
    s, e, f = (alpha * r) ** 2, np.exp(-(alpha * r) ** 2), erfc(alpha * r)
    g = 4 * alpha / np.sqrt(np.pi)
    slope, bend = f - g / 2 * r * e, -g * e + g * alpha**2 * r**2 * e
    # the same of the Laplacian
    slope = slope + c * (-2 * f / r**2 - g * e / r + 2 * g * alpha**2 * r * e * (3 - s))
    bend = bend + c * (4 * f / r**3 + 2 * g * e / r**2 + 2 * g * alpha**2 * e * (4 - 9 * s + 2 * s**2))
    return (bend + slope / r) / (8 * np.pi), 2 * slope / r / (8 * np.pi)


def overlap(r, a, b):
    """What the mobility of two spheres that overlap, but do not contain each other, has more than near_pair(r, c, 0)
    (Zuk et al., J. Fluid Mech. 741, R5, 2014)."""
    unit = 1 / (6 * np.pi * a * b)
    transverse = unit * (16 * r**3 * (a + b) - ((a - b) ** 2 + 3 * r**2) ** 2) / (32 * r**3)
    longitudinal = transverse + unit * 3 * ((a - b) ** 2 - r**2) ** 2 / (32 * r**3)
    t, l = near_pair(r, (a**2 + b**2) / 6, 0.0)
    return np.where(r < a + b, transverse - t, 0), np.where(r < a + b, longitudinal - l, 0)


def wave_vectors(length, k_max):
    n = int(k_max * length / (2 * np.pi))
    axis = np.arange(-n, n + 1) * 2 * np.pi / length
    k = np.stack(np.meshgrid(axis, axis, axis, indexing="ij"), -1).reshape(-1, 3)
    k = k[len(k) // 2 + 1:]          # one of each pair k, -k
    return k[(k**2).sum(1) <= k_max**2]


def velocities(x, a, force, length):
    """Velocities of spheres at x with radii a under forces, exact to about 1e-9."""
    alpha = 9.2 / length
    u = force / (6 * np.pi * a[:, None])
    u *= (1 - 6 * alpha * a / np.sqrt(np.pi) + 40 * (alpha * a) ** 3 / (3 * np.sqrt(np.pi)))[:, None]
    for i in range(len(x)):
        d = x[i] - np.delete(x, i, 0)
        d -= length * np.round(d / length)
        r = np.linalg.norm(d, axis=1)
        close = r < length / 2
        d, r, b, f = d[close] / r[close, None], r[close], np.delete(a, i)[close], np.delete(force, i, 0)[close]
        (t, l), (more_t, more_l) = near_pair(r, (a[i] ** 2 + b**2) / 6, alpha), overlap(r, a[i], b)
        t, l = t + more_t, l + more_l
        u[i] += (t[:, None] * f + ((l - t) * (d * f).sum(1))[:, None] * d).sum(0)
    size = (a**2 / 6)[:, None]
    for k in np.array_split(wave_vectors(length, 9.2 * alpha), 40):
        k2 = (k**2).sum(1)[:, None]
        phase = np.exp(1j * x @ k.T)
        plain, sized = phase.conj().T @ force, phase.conj().T @ (size * force)
        # (1 - (a^2 + b^2) k^2/6), without the product of both
        s = k2 / (4 * alpha**2)
        weight = 2 / (length**3 * k2) * (1 + s + 2 * s**2) * np.exp(-s)
        across = lambda v: v - k * (k * v).sum(1)[:, None] / k2
        f, g = across(weight * (plain - k2 * sized)), across(weight * k2 * plain)
        u += (phase @ f - size * (phase @ g)).real
    return u


def self_mobility(name, length):
    """Over that of a single sphere: the diagonal of the dense matrix, which does not depend on where the spheres are."""
    a = RADII[name]
    return velocities(np.zeros((1, 3)), np.array([a]), np.array([[1.0, 0.0, 0.0]]), length)[0, 0] * 6 * np.pi * a


# ---- comparison ---------------------------------------------------------------------------------------------------------

def box_side(path):
    with open(path) as f:
        head = [next(f) for _ in range(6)]
    low, high = (float(w) for w in head[5].split())
    return high - low


def compare_velocities():
    """Largest error over the tolerance; side of the box."""
    rows, worst, exact = [], 0.0, None
    for path in sorted(glob.glob("results/velocities_*"), key=lambda p: -float(p.split("_")[1])):
        asked, length = float(path.split("_")[1]), box_side(path)
        t = ex.read_dump(path)[-1][1]
        x, u = (np.column_stack([t[c] for c in names]) for names in (("x", "y", "z"), ("vx", "vy", "vz")))
        if exact is None:
            i2 = t["id"] ** 2
            force = np.column_stack([np.sin(1.1 * i2), np.sin(1.7 * i2 + 1), np.sin(2.3 * i2 + 2)])
            exact = velocities(x, t["radius"], force, length)
        error = np.linalg.norm(u - exact) / np.linalg.norm(exact)
        of = [np.linalg.norm((u - exact)[t["type"] == k]) / np.linalg.norm(exact[t["type"] == k]) for k in (1, 2)]
        worst = max(worst, error / asked)
        rows.append([f"{asked:g}", f"{error:.1e}", f"{error / asked:.3f}", f"{of[0]:.1e}", f"{of[1]:.1e}"])
    print(f"\nvelocities of {len(x)} spheres under given forces: relative error against an Ewald sum")
    ex.print_table(["tolerance", "error", "/tolerance", "large", "small"], rows)
    return worst, length


def compare_diffusion(length):
    table, rows, worst = ex.read_fix_print("results/diffusion.dat"), [], 0.0
    for column, name in ((1, "large"), (2, "small")):
        D0 = 1 / (6 * np.pi * RADII[name])
        value, error = ex.mean_and_error(table[:, column] / D0)
        theory = self_mobility(name, length)
        worst = max(worst, abs(value - theory) / np.hypot(error, TOLERANCE * theory))
        rows.append([name, ex.plus_minus(value, error), f"{theory:.5f}", f"{(value - theory) / error:+.1f}"])
    print("\nshort-time self-diffusion, D/D0, from the noise of single steps")
    ex.print_table(["spheres", "D/D0", "Ewald sum", "z"], rows)
    return worst


def large_spheres(name):
    """Distances of all pairs of large spheres [configuration, pair]; side of the box."""
    path = f"results/{name}/large.dump"
    length = box_side(path)
    x = np.array([np.column_stack([t[c] for c in "xyz"]) for _, t in ex.read_dump(path)])
    i, j = np.triu_indices(x.shape[1], 1)
    d = x[:, i] - x[:, j]
    return np.linalg.norm(d - length * np.round(d / length), axis=2), length


def compare_depletion():
    """{run: (contacts per large sphere, error)}, {run: (r, g, error)}"""
    contacts, curves, rows = {}, {}, []
    edges = np.arange(1.5, 3.61, 0.1)
    for name in ("pse", "newton", "alone"):
        r, length = large_spheres(name)
        count = (1 + np.sqrt(1 + 8 * r.shape[1])) / 2
        near = ex.block_means((r < CONTACT).sum(1) * 2 / count, BLOCKS)
        contacts[name] = ex.mean_and_error(near)
        h = np.array([(r >= a) & (r < b) for a, b in zip(edges[:-1], edges[1:])]).sum(2).T
        shells = 4 / 3 * np.pi * np.diff(edges**3) / length**3 * r.shape[1]
        curves[name] = ((edges[1:] + edges[:-1]) / 2, *ex.mean_and_error(ex.block_means(h / shells, BLOCKS)))
        rows.append([TITLES[name], len(r), ex.plus_minus(*contacts[name])])
    print(f"\nlarge spheres in touch with a large one")
    ex.print_table(["run", "configurations", "in touch"], rows)
    return contacts, curves


TITLES = {"pse": "with small ones, fix bd/pse", "newton": "with small ones, molecular dynamics", "alone": "without small ones"}


def plot(curves):
    plt = ex.pyplot()
    figure, (left, right) = plt.subplots(1, 2, figsize=(9.5, 4.2), gridspec_kw={"wspace": 0.2, "width_ratios": [1, 1.1]})
    left.axis("off")
    left.imshow(plt.imread(sorted(glob.glob("results/pse/picture.*.png"))[-1]))
    for (name, (r, g, error)), color in zip(curves.items(), ex.COLORS):
        right.errorbar(r, g, error, fmt="o-" if name == "pse" else "-", ms=3.5, lw=0.9, color=color, label=TITLES[name])
    right.axvline(CONTACT, color="gray", lw=0.8, ls=":")
    right.set_xlabel("distance of two large spheres / radius")
    right.set_ylabel("g(r)")
    right.legend(fontsize=8)
    ex.save(figure, "results/mixture.png")


def main():
    if not os.path.exists("results/diffusion.dat"):
        ex.fail("no results: run ./run.sh first")
    worst, length = compare_velocities()
    diffusion = compare_diffusion(length)
    contacts, curves = compare_depletion()
    z = [(contacts["pse"][0] - contacts[n][0]) / np.hypot(contacts["pse"][1], contacts[n][1]) for n in ("newton", "alone")]
    print(f"\nlargest error {worst:.2f} of the tolerance; self-diffusion within {diffusion:.1f} of its allowance (standard error\n"
          f"and tolerance, added in squares); in touch: z = {z[0]:+.1f} from molecular dynamics, {z[1]:+.1f} from without small ones")
    plot(curves)
    moves = worst <= 1 and diffusion < 3.3
    depleted = abs(z[0]) < 3.3 and z[1] > 3.3
    motions = "the motions are those of the Ewald sum" if moves else "the motions DIFFER from the Ewald sum"
    structure = ("small spheres drive the large ones together as in molecular dynamics" if depleted else
                 "the depletion of the large ones is NOT that of molecular dynamics, or not visible")
    print(f"verdict: {motions}, and {structure}")


if __name__ == "__main__":
    main()
