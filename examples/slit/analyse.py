#!/usr/bin/python3
"""Distance to the nearer wall of a channel: midpoint against Gibbs-Boltzmann, Euler-Maruyama against its biased law;
and the mobility across the slit of Fig. 1 of Delong et al. 2014 against an independent solution of the same equations."""

import os
import sys

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "common"))
import bdh_examples as ex
import channel

STIFFNESS, RANGE = 6.0, 3.0
ARTIFACT = 0.0061               # relative half range of the mobility of peskin4 over all positions in a cell of a periodic grid
RADIUS = 1.255                  # of the kernel peskin4, in units of the grid spacing, as in the paper
FAXEN = (("L/2", 16.0, (-1.004, 0, 0.418, 0.21, -0.169)), ("L/4", 8.0, (-0.6526, 0, 0.1475, -0.131, -0.0644)))
BINS_PER_H = 4                  # of in.slit
EDGES = np.array([0, 1.75, 2, 2.25, 2.5, 2.75, 3, 3.5, 4, 4.5, 5, 6, 8, 11, 15, 20, 26, 32])      # as far as the channel is wide
LEVEL = 1e-3


def boltzmann(H):
    return np.exp(-0.5 * STIFFNESS * np.maximum(RANGE - H, 0) ** 2)


def biased_law(height):
    """Eq. (47) as a function of the distance: the Boltzmann factor over the perpendicular mobility."""
    H = np.arange(1, 4 * height + 1) / 8
    mu = np.append(0, channel.mean_mobilities(height, H)[:, 1])
    return lambda h: np.where(h > 0.5, boltzmann(h), 0) / np.maximum(np.interp(h, np.append(0, H), mu), 1e-12)


def shares(density, edges):
    """Fraction in each bin, for a given density of the distance."""
    points = [np.linspace(a, b, 401)[:-1] + (b - a) / 800 for a, b in zip(edges[:-1], edges[1:])]
    p = np.array([density(H).mean() * (b - a) for H, a, b in zip(points, edges[:-1], edges[1:])])
    return p / p.sum()


def measured(scheme):
    """Edges of the bins, and fractions by block [block, bin]."""
    _, blocks = ex.read_ave_time_vector(f"results/{scheme}/count.dat")
    counts = blocks[:, :, 0]
    middle = counts.shape[1] // BINS_PER_H
    edges = np.append(EDGES[EDGES < middle], middle)
    binned = np.add.reduceat(counts, np.round(BINS_PER_H * edges[:-1]).astype(int), axis=1)
    return edges, binned / binned.sum(axis=1, keepdims=True)


def correlation(blocks):
    """Correlation coefficient of successive blocks, mean over the bins."""
    d = blocks - blocks.mean(0)
    return float(np.mean((d[1:] * d[:-1]).sum(0) / (d * d).sum(0)))


def compare_distribution():
    """Fig. 4: the distance to the nearer wall against both laws, without the last bin, which the others determine."""
    found = {scheme: measured(scheme) for scheme in ("midpoint", "euler")}
    edges = found["midpoint"][0]
    laws = {"Gibbs-Boltzmann": shares(boltzmann, edges), "biased law (47)": shares(biased_law(int(2 * edges[-1])), edges)}
    rows, probabilities, correlations = [], {}, []
    for scheme, (_, blocks) in found.items():
        correlations.append(correlation(blocks) * np.sqrt(len(blocks)))
        for law, expected in laws.items():
            t2, count, probabilities[scheme, law] = ex.joint_test(blocks[:, :-1], expected[:-1])
            rows.append([scheme, law, f"{t2:.1f}", count, f"{probabilities[scheme, law]:.2g}"])
    ex.print_table(["scheme", "law", "T2", "bins", "probability"], rows)
    print("correlation of successive blocks, in standard errors: " + ", ".join(f"{c:+.1f}" for c in correlations))
    right, wrong = laws
    good = [probabilities["midpoint", right], probabilities["euler", wrong]]
    bad = [probabilities["midpoint", wrong], probabilities["euler", right]]
    if max(correlations) > 2:
        print("verdict: NOT as expected: blocks are not independent, so the probabilities are meaningless; use a longer `time`")
    else:
        print("verdict: " + ex.verdict(good + [float(p < LEVEL) for p in bad], LEVEL,
                                       "midpoint has the Gibbs-Boltzmann distribution, Euler-Maruyama the biased one",
                                       "NOT as expected: the wrong law, or too few samples to tell the laws apart"))
    return found, laws


def main():
    found, laws = compare_distribution()
    draw(compare_mobility(), found, laws)


def faxen():
    """Faxen's series for the parallel mobility of a sphere, relative to that without walls."""
    return [1 + sum(c * (RADIUS / h) ** (n + 1) for n, c in enumerate(series)) for _, h, series in FAXEN]


def compare_mobility():
    """Fig. 1: against the same equations solved by another program, Faxen's exact values and the approximations."""
    table = np.loadtxt("results/mobility.dat")
    reference = ex.read_csv("reference_slit.csv")
    known = {(x, y, h): (p, a) for k, x, y, h, p, a in zip(*(reference[c] for c in
             ("kernel", "x_offset", "y_offset", "H", "mu_xx", "mu_zz"))) if k == 4}
    worst = max(abs(mine / other - 1) for row in table for mine, other in zip(row[3:], known[tuple(row[:3])]))
    print(f"\nmobility at {len(table)} positions: largest relative difference from the independent solution of the same "
          f"equations {worst:.1e}")

    H = np.unique(table[:, 2])
    by_place = 6 * np.pi * RADIUS * np.array([table[table[:, 2] == h, 3:] for h in H])      # [height, place, direction]
    mu, artifact = by_place.mean(1), np.ptp(by_place, axis=1) / 2 / by_place.mean(1)
    curves = {"mcsa": ex.read_csv("reference_mcsa.csv"), "rpy": ex.read_csv("reference_rpy.csv")}
    rows, off = [], []
    for (name, h, _), exact in zip(FAXEN, faxen()):
        at = int(np.flatnonzero(H == h)[0])
        rpy = curves["rpy"]
        image = np.interp(h / RADIUS, rpy["H_over_a"], rpy["par_4L"] / rpy["par_inf"]) - 1
        rows.append([name, f"{mu[at, 0]:.4f}", f"{exact:.4f}", f"{mu[at, 0] / exact - 1:+.2%}", f"{image:+.2%}"])
        off.append(mu[at, 0] / exact - 1 - image)
    ex.print_table(["H", "parallel mobility", "Faxen", "deviation", "of which by periodic images"], rows)
    print(f"artifact of the grid: +-{ARTIFACT:.2%}")

    far = H / RADIUS >= 2
    rows = []
    for name, parallel, across in (("mcsa", "mcsa_par40", "mcsa_perp40"), ("mcsa", "mcsa_par42", "mcsa_perp41"),
                                   ("rpy", "par_4L", "perp_4L")):
        curve = curves[name]
        for d, column in enumerate((parallel, across)):
            deviation = mu[far, d] / np.interp(H[far] / RADIUS, curve["H_over_a"], curve[column]) - 1
            label = "exact, RPY sphere, periodic" if name == "rpy" else "MCSA, " + ("blob" if column.endswith("40") else "hard sphere")
            rows.append([label, "perpendicular" if d else "parallel", f"{np.mean(deviation):+.2%}", f"{np.abs(deviation).max():.2%}",
                         f"{artifact[far, d].max():.2%}"])
    ex.print_table(["H >= 2 a", "direction", "mean deviation", "largest", "range over a cell, +-"], rows)
    print("verdict: " + ("equal to the discrete equations to round-off, and to Faxen's values within the artifact of the grid"
                         if worst < 1e-10 and max(map(abs, off)) < ARTIFACT else "NOT as expected"))
    return H, by_place, curves


def draw(mobility, found, laws):
    H, by_place, curves = mobility
    plt = ex.pyplot()
    figure, (left, right) = plt.subplots(1, 2, figsize=(11, 4.2))
    for d, (name, color) in enumerate((("parallel", ex.COLORS[0]), ("perpendicular", ex.COLORS[2]))):
        left.errorbar(H / RADIUS, by_place[:, :, d].mean(1), yerr=np.ptp(by_place[:, :, d], axis=1) / 2, fmt=".", color=color,
                      label=f"{name}; bars: places in a cell")
        for columns, style in ((("mcsa_par40", "mcsa_perp40"), "--"), (("mcsa_par42", "mcsa_perp41"), ":")):
            left.plot(curves["mcsa"]["H_over_a"], curves["mcsa"][columns[d]], style, color=color)
    left.plot([], [], "k--", label="MCSA, blob")
    left.plot([], [], "k:", label="MCSA, hard sphere")
    left.plot([h / RADIUS for _, h, _ in FAXEN], faxen(), "kD", mfc="none", ms=8, label="Faxen")
    left.set(xlabel="H/a", ylabel="$\\mu/\\mu_0$", xlim=(0, 13.2), ylim=(0, 1), title="slit of 32 h")
    left.legend(loc="lower right")
    edges = found["midpoint"][0]
    middle, width = 0.5 * (edges[:-1] + edges[1:]), np.diff(edges)
    for law, style in zip(laws, ("k-", "r--")):
        right.stairs(laws[law] / width, edges, color=style[0], ls=style[1:], lw=1.4, baseline=None, label=law)
    for scheme, mark in (("midpoint", "ko"), ("euler", "rs")):
        mean, error = ex.mean_and_error(found[scheme][1])
        right.errorbar(middle, mean / width, error / width, fmt=mark, label=scheme)
    right.set(xlabel="H/h", ylabel="P(H)", xlim=(1, min(16, edges[-1])), title=f"channel of {2 * edges[-1]:g} h, springs within 3 h of the walls")
    right.legend(loc="lower right")
    ex.save(figure, "results/slit.png")


if __name__ == "__main__":
    main()
