#!/usr/bin/python3
"""Time-dependent diffusion coefficient of free particles against kT x mobility."""

import glob
import os
import sys

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "common"))
import bdh_examples as ex

TOLERANCE = 0.005                    # the midpoint scheme is 0.3 % low at beta = 1.43


class Run:
    """chi/(kT mu) by block [block, lag] of one folder."""

    def __init__(self, folder):
        self.scheme, beta = os.path.basename(folder).split("_")
        self.beta = float(beta)
        with open(f"{folder}/beta_mu_dt") as f:
            _, self.mu, self.dt = (float(w) for w in f.read().split())
        table = ex.read_fix_print(f"{folder}/chi.dat")
        table = table[table[:, 1] > 0]
        blocks = int(table[:, 0].max())
        self.time = table[table[:, 0] == 1][:, 1]
        self.chi = table[:, 2].reshape(blocks, -1)
        self.chi[:, 0] = table[:, 3].reshape(blocks, -1).mean(1)          # single steps: all those of the block
        self.mean, self.error = ex.mean_and_error(self.chi)

    def test(self):
        """Hotelling's test of chi = kT mu for a few lags together."""
        lags = [0, 1, 3, 7, len(self.time) - 1]
        return ex.joint_test(self.chi[:, lags], np.ones(len(lags)))


def report(runs):
    rows, worst = [], 1.0
    for r in runs:
        chi2, dof, p = r.test()
        if r.scheme == "midpoint":
            worst = min(worst, p)
        rows.append([r.scheme, f"{r.beta:g}", ex.plus_minus(r.mean[0], r.error[0]),
                     f"{(r.mean[0] - 1) / r.error[0]:+.1f}", ex.plus_minus(r.mean[-1], r.error[-1]),
                     f"{(r.mean[-1] - 1) / r.error[-1]:+.1f}", f"{chi2:.1f}", f"{p:.2g}"])
    lags = len(runs[0].time)
    print("\nchi(s)/(kT mu): 1 is exact")
    ex.print_table(["scheme", "beta", "after 1 step", "z", f"after {lags} steps", "z", "chi2 (5 lags)", "probability"],
                   rows)
    return worst


def plot(runs):
    plt = ex.pyplot()
    schemes = ["midpoint", "trapezoidal"]
    figure, axes = plt.subplots(1, 2, figsize=(9, 3.6), sharey=True, gridspec_kw={"wspace": 0.06})
    for ax, scheme in zip(axes, schemes):
        for r, color, marker in zip([r for r in runs if r.scheme == scheme], ex.COLORS, "os^D"):
            ax.errorbar(2 * r.time * r.mu, r.mean, 2 * r.error, fmt=marker + "-", ms=3, lw=0.8, color=color,
                        label=f"beta = {r.beta:g}")
        ax.axhline(1, color="black", lw=1)
        ax.set_xscale("log")
        ax.set_xlabel("2 kT mu s / h$^2$")
        ax.set_title(scheme)
    axes[0].set_ylabel("chi(s) / (kT mu)")
    axes[0].legend()
    ex.save(figure, "results/diffusion.png")


def main():
    runs = [Run(f) for f in glob.glob("results/*_*") if os.path.exists(f"{f}/chi.dat")]
    if not runs:
        ex.fail("no results: run ./run.sh first")
    runs.sort(key=lambda r: (r.scheme, r.beta))
    worst = report(runs)
    plot(runs)
    off = [(abs(r.mean[lag] - 1), r.error[lag]) for r in runs if r.scheme == "midpoint" for lag in (0, -1)]
    low = 1 - min(r.mean[0] for r in runs if r.scheme == "trapezoidal")
    good = all(d < TOLERANCE + 3.5 * e for d, e in off)
    print(f"verdict: midpoint (smallest probability {worst:.2g}) "
          + (f"keeps kT mu within errors of {100 * runs[0].error[0]:.2g} %" if good else "DIFFERS from kT mu")
          + f", trapezoidal is up to {100 * low:.0f} % low")


if __name__ == "__main__":
    main()
