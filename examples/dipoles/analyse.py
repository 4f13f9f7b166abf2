#!/usr/bin/python3
"""A ferrofluid in a field: structure against molecular dynamics, short-time rotation against theory, and how fast dipoles
turn with and without hydrodynamic interactions."""

import glob
import os
import sys

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "common"))
import bdh_examples as ex

D0 = 1 / (8 * np.pi)                 # rotation; kT = viscosity = radius = 1
FRAME = 0.8                          # time between the frames of turn.dump
TOLERANCE = 1e-3                     # of the steps for short-time rotation
BLOCKS = 10
LEVEL = 1e-3
TITLES = {"newton": "molecular dynamics", "none": "without hydrodynamics", "pse": "fix bd/pse"}
NAMES = ("energy of the pairs / N kT", "cos of the angle with the field", "spheres in contact with one")


def structure(name):
    """Means of energy, alignment and contacts in blocks of the run [block, number]."""
    path = f"results/{name}/structure.dat"
    if not os.path.exists(path):
        ex.fail("no results: run ./run.sh first")
    return ex.block_means(ex.read_fix_print(path)[:, 1:], BLOCKS)


def compare_structure():
    """z of all numbers of both Brownian runs."""
    blocks = {name: structure(name) for name in TITLES}
    reference = ex.mean_and_error(blocks["newton"])
    rows, z = [], []
    for k, title in enumerate(NAMES):
        row = [title, ex.plus_minus(reference[0][k], reference[1][k])]
        for name in ("none", "pse"):
            mean, error = ex.mean_and_error(blocks[name])
            z.append((mean[k] - reference[0][k]) / np.hypot(error[k], reference[1][k]))
            row += [ex.plus_minus(mean[k], error[k]), f"{z[-1]:+.1f}"]
        rows.append(row)
    print("\nstructure")
    ex.print_table(["", TITLES["newton"], TITLES["none"], "z", TITLES["pse"], "z"], rows)
    return np.array(z)


def box_side():
    words = [line.split() for line in open("results/newton/start.data")]
    return next(float(w[1]) - float(w[0]) for w in words if w[-2:] == ["xlo", "xhi"])


def compare_short_times():
    """Largest deviation of the rotational diffusion of single steps from theory, over what is allowed."""
    rows, worst = [], 0.0
    for name, theory in (("none", 1.0), ("pse", 1 - 4 * np.pi / 3 / box_side() ** 3)):
        value, error = ex.mean_and_error(ex.read_fix_print(f"results/{name}/rotation.dat")[:, 1] / D0)
        worst = max(worst, abs(value - theory) / np.hypot(error, TOLERANCE * theory))
        rows.append([TITLES[name], ex.plus_minus(value, error), f"{theory:.5f}", f"{(value - theory) / error:+.1f}"])
    print("\nrotational diffusion of single steps, over kT/(8 pi viscosity a^3)")
    ex.print_table(["", "D/D0", "theory", "z"], rows)
    return worst


def directions(name):
    """Unit vectors [time, sphere, 3]"""
    mu = np.array([np.column_stack([t[c] for c in ("mux", "muy", "muz")]) for _, t in
                   ex.read_dump(f"results/{name}/turn.dump")])
    return mu / np.linalg.norm(mu, axis=2, keepdims=True)


def correlation(series, lags):
    """Of the numbers series[time, ...] at several lags, over that at 0."""
    c = [(series[lag:] * series[:len(series) - lag]).mean() for lag in range(lags)]
    return np.array(c) / c[0]


def decay_time(curve):
    """Where a curve crosses 1/e."""
    below = int(np.argmax(curve < np.exp(-1)))
    if below == 0:
        return np.nan
    a, b = np.log(curve[below - 1]), np.log(max(curve[below], 1e-3))
    return FRAME * (below - 1 + (a + 1) / (a - b))


def decay_and_error(curves):
    """Decay time of the mean of curves, and its error from means that leave out one of them each (jackknife)."""
    n = len(curves)
    some = np.array([decay_time(np.delete(curves, k, 0).mean(0)) for k in range(n)])
    return decay_time(curves.mean(0)), np.sqrt((n - 1) / n * ((some - some.mean()) ** 2).sum())


def rotation_times():
    """{run: (time, correlation of spheres, of the whole)}"""
    curves, rows = {}, []
    for name in ("none", "pse"):
        n = directions(name)[:, :, :2]
        blocks = np.array_split(n, BLOCKS)
        lags = min(len(b) for b in blocks) // 2
        each = np.array([correlation(b, lags) for b in blocks])
        whole = np.array([correlation(b.sum(1), lags) for b in blocks])
        curves[name] = (FRAME * np.arange(lags), each.mean(0), whole.mean(0))
        rows.append([TITLES[name]] + [ex.plus_minus(*decay_and_error(q)) for q in (each, whole)])
    print("\ntime in which the part of a dipole across the field falls to 1/e (a sphere alone, without field: "
          f"{1 / (2 * D0):.1f})")
    ex.print_table(["", "one dipole", "sum of all"], rows)
    return curves


def plot(curves):
    plt = ex.pyplot()
    figure, axes = plt.subplots(1, 3, figsize=(11.5, 3.9), gridspec_kw={"wspace": 0.2, "width_ratios": [1, 1, 1.1]})
    for ax, name in zip(axes, ("none", "pse")):
        ax.axis("off")
        ax.imshow(plt.imread(sorted(glob.glob(f"results/{name}/picture.*.png"))[-1]))
        ax.set_title(TITLES[name], fontsize=9)
    for (name, (time, each, whole)), color in zip(curves.items(), ex.COLORS[1::-1]):
        axes[2].plot(time, each, "-", color=color, label=f"one dipole, {TITLES[name]}")
        axes[2].plot(time, whole, "--", color=color, label=f"sum of all, {TITLES[name]}")
    axes[2].set_xlim(0, 20)
    axes[2].set_xlabel("time / (viscosity a$^3$/kT)")
    axes[2].set_ylabel("correlation across the field")
    axes[2].legend(fontsize=8)
    ex.save(figure, "results/dipoles.png")


def main():
    z = compare_structure()
    worst = compare_short_times()
    curves = rotation_times()
    print()
    plot(curves)
    # two-sided, Student's t of two means of BLOCKS blocks
    from scipy import stats
    p = min(1.0, len(z) * 2 * stats.t.sf(np.abs(z).max(), 2 * BLOCKS - 2))
    print(f"structure: largest deviation from molecular dynamics {np.abs(z).max():.1f} standard errors, probability {p:.2g};\n"
          f"short-time rotation within {worst:.1f} of its allowance (standard error and tolerance, added in squares)")
    print("verdict: " + ("chains are those of molecular dynamics" if p > LEVEL else "chains are NOT those of molecular dynamics")
          + ", and " + ("single steps turn as theory says" if worst < 3.3 else "single steps DO NOT turn as theory says"))


if __name__ == "__main__":
    main()
