#!/usr/bin/python3
"""Diffusion of the centers of chains against Kirkwood's short-time formula and against Rouse's D = kT/(N zeta)."""

import os
import sys

import numpy as np
from scipy.special import erfc

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "common"))
import bdh_examples as ex

BEADS, RADIUS, DT = 16, 0.6, 0.001   # kT = friction of a bead = 1, so D = 1 for a single bead
ROUSE = 1 / BEADS
TOLERANCE = 1e-3


# ---- theory ----------------------------------------------------------------------------------------------------------

def green(x, side):
    """Periodic Green's function of minus the Laplacian, with zero mean, x [..., 3]; at x = 0 without its 1/(4 pi r)."""
    split = 3.0 / side                               # erfc and exp are below 1e-8 beyond the images and modes that are summed
    images = np.array(np.meshgrid(*[np.arange(-1, 2)] * 3)).reshape(3, -1).T * side
    x = x - side * np.round(x / side)
    total = np.full(x.shape[:-1], -1 / (4 * split**2 * side**3))
    for image in images:
        r = np.linalg.norm(x + image, axis=-1)
        far = np.maximum(r, 1e-12)
        total += np.where(r > 1e-9, erfc(split * far) / (4 * np.pi * far), -split / (2 * np.pi**1.5))
    modes = np.array(np.meshgrid(*[np.arange(-5, 6)] * 3)).reshape(3, -1).T
    for m in modes[modes @ [121, 11, 1] > 0]:          # one of each pair k, -k
        k = 2 * np.pi * m / side
        k2 = k @ k
        total += 2 * np.exp(-k2 / (4 * split**2)) / (k2 * side**3) * np.cos(x @ k)
    return total


def trace_third(d, side):
    """A third of the trace of the periodic Rotne-Prager-Yamakawa pair mobility at separations d [..., 3], in units of
    that of one bead.  It solves a Laplace problem: 4 pi a (G + a^2/(3 V)), in which 1 - r/4a replaces a/r for
    overlapping spheres."""
    r = np.linalg.norm(d, axis=-1)
    zero = r < 1e-9
    far = np.maximum(r, 1e-12)
    smooth = green(d, side) - np.where(zero, 0.0, 1 / (4 * np.pi * far))
    own = np.where(r < 2 * RADIUS, 1 - r / (4 * RADIUS), RADIUS / far)
    return own + 4 * np.pi * RADIUS * (smooth + RADIUS**2 / (3 * side**3))


def kirkwood(x, side):
    """Short-time diffusion coefficient of the center of each chain, x [chain, bead, 3]."""
    d = x[:, :, None] - x[:, None]
    return trace_third(d, side).mean((1, 2))


# ---- measured --------------------------------------------------------------------------------------------------------

def beads(folder):
    """Positions [frame, chain, bead, 3], side of the box."""
    with open(f"{folder}/beads.dump") as f:
        head = [next(f) for _ in range(6)]
    low, high = (float(w) for w in head[5].split())
    frames = ex.read_dump(f"{folder}/beads.dump")
    x = np.array([np.column_stack([t[c] for c in ("xu", "yu", "zu")]) for _, t in frames])
    return x.reshape(len(x), -1, BEADS, 3), high - low


def one_step(folder):
    """Diffusion coefficient of the centers from single noise displacements, by blocks in time."""
    _, kick = ex.read_ave_time_vector(f"{folder}/kick.dat")
    square = ((kick / BEADS) ** 2).sum(2).mean(1) / (6 * DT)
    return ex.mean_and_error(ex.block_means(square, 50))


def centers(folder):
    steps, com = ex.read_ave_time_vector(f"{folder}/com.dat")
    return DT * (steps - steps[0]), com


def diffusion_at(com, lag):
    """Mean over chains and origins of |dX|^2/6, and its error from pieces of at least two lags."""
    d = com[lag:] - com[:-lag]
    square = (d**2).sum(2).mean(1) / 6
    pieces = min(20, len(square) // (2 * lag))
    return ex.mean_and_error(ex.block_means(square, pieces)) if pieces >= 4 else None


def analyse(name):
    folder = f"results/{name}"
    if not os.path.exists(f"{folder}/com.dat"):
        ex.fail("no results: run ./run.sh first")
    x, side = beads(folder)
    x = x[:: max(1, len(x) // 60)]
    short = np.array([kirkwood(q, side).mean() for q in x]) if name == "pse" else None
    y = x - x.mean(2, keepdims=True)
    gyration = np.sqrt((y**2).sum(3).mean((1, 2)))
    bond = np.linalg.norm(x[:, :, 1:] - x[:, :, :-1], axis=3)
    time, com = centers(folder)
    if len(time) < 40:
        ex.fail("too few steps for diffusion: at least STEPS=2000")
    lags = np.unique(np.round(np.geomspace(1, len(time) // 9, 22)).astype(int))
    points = [(time[lag], *r) for lag in lags if (r := diffusion_at(com, lag)) is not None]
    t, msd, error = np.array(points).T
    return dict(name=name, chains=x.shape[1], side=side, kirkwood=None if short is None else ex.mean_and_error(
        ex.block_means(short, 10)), gyration=ex.mean_and_error(ex.block_means(gyration, 10)), bond=bond.mean(),
        time=t, D=msd / t, error=error / t, one=one_step(folder) if name == "pse" else None)


def at(result, time):
    k = int(np.argmin(abs(np.log(result["time"] / time))))
    return result["time"][k], result["D"][k], result["error"][k]


def plot(pse, none):
    plt = ex.pyplot()
    figure, axes = plt.subplots(figsize=(6.2, 4.2))
    for q, color, title in ((pse, ex.COLORS[0], "with HI (fix bd/pse)"), (none, ex.COLORS[1], "without (hydrodynamics no)")):
        axes.errorbar(q["time"], q["D"], q["error"], fmt="o-", color=color, lw=0.8, label=title)
    axes.errorbar([DT], [pse["one"][0]], [pse["one"][1]], fmt="D", color=ex.COLORS[0], mfc="white",
                  label="noise of single steps")
    axes.axhline(pse["kirkwood"][0], color="black", lw=0.9, ls="--", label="Kirkwood, short times")
    axes.axhline(ROUSE, color="black", lw=0.9, ls=":", label="Rouse, kT/(N zeta)")
    axes.set_xscale("log")
    axes.set_ylim(0, None)
    axes.set_xlabel("time")
    axes.set_ylabel("|center displacement|$^2$ / 6 t")
    axes.legend(fontsize=8)
    ex.save(figure, "results/polymer.png")


def main():
    pse, none = analyse("pse"), analyse("none")
    rows = []
    for q in (none, pse):
        t, value, error = at(q, 0.1)
        late, value_late, error_late = at(q, 3.0)
        rows.append([q["name"], q["chains"], f"{q['side']:.4g}", f"{q['bond']:.4f}", ex.plus_minus(*q["gyration"]),
                     ex.plus_minus(*q["one"]) if q["one"] else "-", f"{ex.plus_minus(value, error)} at {t:.2g}",
                     f"{ex.plus_minus(value_late, error_late)} at {late:.2g}"])
    print(f"\nchains of {BEADS} beads; D of the center from the noise of single steps, and from displacements over a time")
    ex.print_table(["mobility", "chains", "box", "bond", "R_g", "D, one step", "D", "D"], rows)
    (value, error), (theory, theory_error) = pse["one"], pse["kirkwood"]
    allowed = np.sqrt(error**2 + theory_error**2 + (TOLERANCE * theory) ** 2)
    z_short = (value - theory) / np.hypot(error, theory_error)
    k = int(np.argmin(none["error"]))
    z_rouse = (none["D"][k] - ROUSE) / none["error"][k]
    t, middle, middle_error = at(pse, 3.0)
    print(f"Kirkwood, periodic, from the configurations: {ex.plus_minus(theory, theory_error)}; single steps "
          f"{ex.plus_minus(value, error)}: {z_short:+.1f} standard errors, {100 * (value / theory - 1):+.2f} %")
    print(f"Rouse, kT/(N zeta) = {ROUSE:.5f}; without hydrodynamic interactions "
          f"{ex.plus_minus(none['D'][k], none['error'][k])} at t = {none['time'][k]:.3g}: {z_rouse:+.1f} standard errors")
    print(f"hydrodynamic interactions make the chains {theory / ROUSE:.2f} times as fast at short times; over t = {t:.2g} "
          f"the\ncenters diffuse with {100 * middle / theory:.1f}({100 * middle_error / theory:.1f}) % of Kirkwood's value, "
          "which is an upper bound")
    plot(pse, none)
    good = abs(value - theory) < 3.3 * allowed and abs(z_rouse) < 3.3 and middle < theory + 3.3 * middle_error
    print("verdict: " + ("Kirkwood's short-time diffusion with hydrodynamics, and Rouse's without" if good else
                         "DIFFERS from theory by more than chance explains"))


if __name__ == "__main__":
    main()
