#!/usr/bin/env python3
"""Distance to the nearer wall of a channel: midpoint against Gibbs-Boltzmann, Euler-Maruyama against its biased law;
and the mobility across the slit of Fig. 1 of Delong et al. 2014 against an independent solution of the same equations."""

import os
import sys

import numpy as np
from scipy import stats

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "common"))
import bdh_examples as ex

STIFFNESS, RANGE = 6.0, 3.0
EDGES = np.array([0, 2, 2.5, 3, 3.5, 4, 5, 6, 8, 11, 15, 20, 26, 32.0])        # multiples of the bins of in.slit


def boltzmann(H):
    return np.exp(-0.5 * STIFFNESS * np.maximum(RANGE - H, 0) ** 2)


def biased(H, table):
    """Eq. (47): the Boltzmann factor over the perpendicular mobility."""
    mu = np.interp(H, np.append(0, table["H"]), np.append(0, table["mu_perp"]))
    return np.where(H > 0.5, boltzmann(H), 0) / np.maximum(mu, 1e-12)


def shares(density):
    """Share of each bin for a density of the distance."""
    points = [np.linspace(a, b, 401)[:-1] + (b - a) / 800 for a, b in zip(EDGES[:-1], EDGES[1:])]
    p = np.array([density(H).mean() * (b - a) for H, a, b in zip(points, EDGES[:-1], EDGES[1:])])
    return p / p.sum()


def measured(scheme):
    """Shares by block [block, bin]."""
    _, blocks = ex.read_ave_time_vector(f"results/{scheme}/count.dat")
    counts = blocks[:, :, 0]
    starts = np.round(2 * EDGES[:-1]).astype(int)
    binned = np.add.reduceat(counts, starts, axis=1)
    return binned / binned.sum(axis=1, keepdims=True)


def chi2(blocks, expected):
    """Hotelling's T^2 of the mean of the blocks, without the last bin, which the others fix; and its probability."""
    runs, bins = len(blocks), len(expected) - 1
    d = (blocks.mean(0) - expected)[:-1]
    covariance = np.cov(blocks[:, :-1].T) / runs
    t2 = d @ np.linalg.solve(covariance, d)
    return t2, stats.f.sf(t2 * (runs - bins) / (bins * (runs - 1)), bins, runs - bins)


def main():
    table = ex.read_csv("reference_channel.csv")
    table = {name: column[table["kernel"] == 4] for name, column in table.items()}
    laws = {"Gibbs-Boltzmann": shares(boltzmann), "biased law": shares(lambda H: biased(H, table))}
    rows = []
    for scheme in ("midpoint", "euler"):
        blocks = measured(scheme)
        for law, expected in laws.items():
            t2, probability = chi2(blocks, expected)
            rows.append([scheme, law, f"{t2:.1f}", len(expected) - 1, f"{probability:.2g}"])
    ex.print_table(["scheme", "law", "T2", "bins", "probability"], rows)

    H, parallel, across = np.loadtxt("results/mobility.dat").T
    slit = ex.read_csv("reference_slit.csv")
    worst = 0.0
    for h, p, a in zip(H, parallel, across):
        row = np.flatnonzero((slit["kernel"] == 4) & (slit["x_offset"] == 0.25) & (slit["y_offset"] == 0.25) & (slit["H"] == h))
        if len(row):
            worst = max(worst, abs(p / slit["mu_xx"][row[0]] - 1), abs(a / slit["mu_zz"][row[0]] - 1))
    print(f"mobility across the slit: largest relative difference from the reference {worst:.1e}")
    draw(H, parallel, across, laws)


def draw(H, parallel, across, laws):
    import matplotlib.pyplot as plt
    figure, (left, right) = plt.subplots(1, 2, figsize=(10, 4))
    mu0 = 1 / (6 * np.pi * 1.2544)
    left.plot(H, parallel / mu0, "o-", label="parallel")
    left.plot(H, across / mu0, "s-", label="perpendicular")
    left.set(xlabel="H/h", ylabel="mobility / $\\mu_0$", title="slit of 32 h")
    left.legend()
    middle, width = 0.5 * (EDGES[:-1] + EDGES[1:]), np.diff(EDGES)
    for law, style in zip(laws, ("k-", "r--")):
        right.step(middle, laws[law] / width, style, where="mid", label=law)
    for scheme, mark in (("midpoint", "ko"), ("euler", "rs")):
        mean, error = ex.mean_and_error(measured(scheme))
        right.errorbar(middle, mean / width, error / width, fmt=mark, label=scheme)
    right.set(xlabel="H/h", ylabel="P(H)", xlim=(0, 16), title="channel, springs within 3 h of the walls")
    right.legend()
    figure.tight_layout()
    figure.savefig("results/slit.png", dpi=120)
    print("drawn: results/slit.png")


if __name__ == "__main__":
    main()
