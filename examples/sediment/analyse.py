#!/usr/bin/python3
"""Spheres above one plate: mobilities against Rotne-Prager-Yamakawa spheres above a plate (Blake's tensor), the distribution
of heights against Boltzmann's, and diffusion along the plate against the mobility at each height."""

import os
import sys

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "common"))
import bdh_examples as ex
import blake

SIDE, WEIGHT, STIFFNESS, RANGE = 32.0, 0.5, 40.0, 1.5       # of the decks
LOWEST = 1.25                       # radii; nearer to the plate the kernel itself reaches the wall
ALONG, ACROSS, PAIR = 0.01, 0.025, 0.01        # accuracy of the kernel (fix_bd_fib.rst), in units of the mobility far away
LEVEL = 1e-3
EDGES = np.array([1.0, 1.5, 1.75, 2.0, 2.5, 3.0, 3.5, 4.0, 5.0, 6.0, 8.0, 20.0])
BIN = 0.25


# ---- comparison -----------------------------------------------------------------------------------------------------

def compare_self(table):
    rows, worst = [], np.zeros(2)
    theory = np.array([blake.self_mobility(H, SIDE)[0] for H in table[:, 0]])
    for (H, along, across), (t_along, t_across) in zip(table, theory):
        rows.append([f"{H:g}", f"{along:.4f}", f"{t_along:.4f}", f"{along - t_along:+.4f}",
                     f"{across:.4f}", f"{t_across:.4f}", f"{across - t_across:+.4f}"])
        if H >= LOWEST:
            worst = np.maximum(worst, np.abs([along - t_along, across - t_across]))
    print("\none sphere: mobility over that far from the plate")
    ex.print_table(["height", "along", "RPY, Blake", "", "across", "RPY, Blake", ""], rows)
    closed = max(abs(blake.self_mobility(H, SIDE)[1][k] - blake.expansions(H)[k]) for H in (1.5, 4.0) for k in (0, 1))
    print(f"  (this theory without images equals the expansions in a/H to {closed:.0e})")
    return worst, theory


def compare_pairs(table):
    rows, worst, theory = [], 0.0, []
    for H, r, *found in table:
        a, b = np.array([0.0, 0.0, H]), np.array([r, 0.0, H])
        t = np.diag(blake.rpy(b, a) + blake.images(b, a, SIDE))
        theory.append(t)
        worst = max(worst, np.abs(np.array(found) - t).max())
        rows.append([f"{H:g}", f"{r:g}"] + [f"{v:.4f}" for pair in zip(found, t) for v in pair])
    print("\ntwo spheres at the same height: velocity of one under a force on the other")
    ex.print_table(["height", "distance", "line", "RPY", "along", "RPY", "across", "RPY"], rows)
    return worst, np.array(theory)


def boltzmann_shares():
    def weight(a, b):
        z = np.linspace(a, b, 2001)[:-1] + (b - a) / 4000
        return np.exp(-WEIGHT * z - 0.5 * STIFFNESS * np.maximum(RANGE - z, 0)**2).mean() * (b - a)
    p = np.array([weight(a, b) for a, b in zip(EDGES[:-1], EDGES[1:])])
    return p / (p.sum() + weight(0.0, EDGES[0]) + weight(EDGES[-1], 60.0))


def measured_layers():
    """Shares and diffusion by block [block, bin]; and the mean height in each bin."""
    _, blocks = ex.read_ave_time_vector("results/height.dat")
    # columns: coordinate, particles in the bin, density, diffusion
    z, count, diffusion = blocks[0, :, 0], blocks[:, :, 1], blocks[:, :, 3]
    first = np.round(EDGES[:-1] / BIN).astype(int)      # bins of in.sediment
    last = round(EDGES[-1] / BIN)
    total = count.sum(1)
    share = np.add.reduceat(count[:, :last], first, axis=1)
    motion = np.add.reduceat((count * diffusion)[:, :last], first, axis=1)
    height = np.add.reduceat((count.sum(0) * z)[:last], first) / share.sum(0)
    return share / total[:, None], motion / np.maximum(share, 1e-300), height


def compare_layers(table):
    share, diffusion, height = measured_layers()
    law = boltzmann_shares()
    # the last bin is determined by the others, except for what lies outside all
    chi2, count, p_heights = ex.joint_test(share[:, :-1], law[:-1])
    expected = np.interp(height, table[:, 0], table[:, 1])
    good = EDGES[:-1] >= 1.5
    mean, error = ex.mean_and_error(diffusion)
    share_mean, share_error = ex.mean_and_error(share)
    rows = [[f"{a:g} - {b:g}", ex.plus_minus(s, e), f"{l:.4f}", ex.plus_minus(m, d), f"{x:.3f}"]
            for a, b, s, e, l, m, d, x in zip(EDGES[:-1], EDGES[1:], share_mean, share_error, law, mean, error, expected)]
    print("\ncolloids of finite weight: share at each height, and diffusion along the plate over that far away")
    ex.print_table(["height", "share", "Boltzmann", "D/D0", "mobility"], rows)
    off = np.abs(mean - expected)[good]
    print(f"  heights: T2 {chi2:.1f} for {count} bins, probability {p_heights:.2g}; diffusion: at most {off.max():.3f} off")
    return p_heights, bool(np.all(off < ALONG + 4 * error[good])), (height, mean, error)


def plot(single, theory, pairs, pair_theory, layers):
    plt = ex.pyplot()
    figure, axes = plt.subplots(1, 2, figsize=(9.5, 3.8), gridspec_kw={"wspace": 0.24})
    for k, (name, color) in enumerate((("along", ex.COLORS[0]), ("across", ex.COLORS[1]))):
        axes[0].plot(single[:, 0], single[:, 1 + k], "o", color=color, label=f"{name} the plate")
        axes[0].plot(single[:, 0], theory[:, k], "-", lw=1, color=color)
    height, mean, error = layers
    axes[0].errorbar(height, mean, 2 * error, fmt="s", ms=3, color=ex.COLORS[2], label="diffusion along, colloids with weight")
    axes[0].set_xlabel("height / radius")
    axes[0].set_ylabel("mobility, D/D$_0$")
    axes[0].set_xlim(0.8, 12.5)
    axes[0].legend(loc="lower right")
    for H, color in zip(np.unique(pairs[:, 0]), ex.COLORS):
        here = pairs[:, 0] == H
        for k, marker in ((0, "o"), (2, "^")):
            axes[1].plot(pairs[here, 1], pairs[here, 2 + k], marker, ms=4, color=color,
                         label=f"height {H:g}" if k == 0 else None)
            axes[1].plot(pairs[here, 1], pair_theory[here, k], "-", lw=1, color=color)
    axes[1].set_xlabel("distance / radius")
    axes[1].set_ylabel("pair mobility: line of centers (o), across (^)")
    axes[1].legend()
    ex.save(figure, "results/sediment.png")


def main():
    if not os.path.exists("results/height.dat"):
        ex.fail("no results: run ./run.sh first")
    single, pairs = ex.read_fix_print("results/self.dat"), ex.read_fix_print("results/pair.dat")
    worst, theory = compare_self(single)
    pair_worst, pair_theory = compare_pairs(pairs)
    p_heights, diffuses, layers = compare_layers(single)
    plot(single, theory, pairs, pair_theory, layers)
    accurate = worst[0] < ALONG and worst[1] < ACROSS and pair_worst < PAIR
    print(f"verdict: {'the mobilities are' if accurate else 'the mobilities are NOT'} those of RPY spheres above a plate, to "
          f"{worst[0]:.3f} along and {worst[1]:.3f} across, pairs {pair_worst:.3f}; the heights "
          + ("have" if p_heights > LEVEL else "do NOT have") + f" Boltzmann's distribution (probability {p_heights:.2g}); diffusion "
          + ("follows" if diffuses else "does NOT follow") + " the mobility at each height")


if __name__ == "__main__":
    main()
