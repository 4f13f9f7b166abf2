#!/usr/bin/python3
"""Draws bench/pse/*.csv, measured by pse_figures.sh, in the form of the corresponding figures of the paper."""
import os

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

import chart_tables
from chart_tables import groups

FOLDER = os.path.join(os.path.dirname(os.path.abspath(__file__)), "pse")
plt.rcParams.update({"figure.figsize": (6, 4.2), "axes.grid": True, "grid.alpha": 0.3, "savefig.dpi": 130, "font.size": 9})


def read(name):
    return chart_tables.read(FOLDER, name)


def column(rows, key):
    return [row[key] for row in rows]


def finish(name, x, y, title):
    plt.xlabel(x)
    plt.ylabel(y)
    plt.title(title, fontsize=9)
    plt.legend(fontsize=7)
    plt.tight_layout()
    plt.savefig(os.path.join(FOLDER, name + ".png"))
    plt.close()


def condition():
    rows = read("condition")
    if not rows:
        return
    for (phi, n), r in groups(rows, "phi", "N"):
        plt.loglog(column(r, "xi_a"), column(r, "condition"), "o-" if phi < 0.2 else "s--", ms=3, label=f"phi {phi:g}, N {n:g}")
    finish("fig1_condition", "xi a", "condition number of M_r", "hard spheres (paper: Fig. 1)")


def tolerance():
    rows = read("tolerance")
    if not rows:
        return
    for xi, r in groups(rows, "xi_a"):
        line, = plt.loglog(column(r, "tolerance"), column(r, "random_forces"), "o-", ms=3, label=f"xi a {xi}, random forces")
        plt.loglog(column(r, "tolerance"), column(r, "equal_forces"), "s--", ms=3, color=line.get_color(), label=f"xi a {xi}, equal forces")
    ends = [1e-8, 1e-1]
    plt.loglog(ends, ends, "k-", lw=0.8, label="error = tolerance")
    finish("fig2_tolerance", "tolerance", "error of M F", "5000 hard spheres, phi = 0.2 (paper: Fig. 2)")


def iterations():
    rows = [r for r in read("iterations") if r["xi_a"] in (0.2, 0.5, 1.2)]
    if not rows:
        return
    for (phi, xi), r in groups(rows, "phi", "xi_a"):
        plt.semilogy(column(r, "iterations"), column(r, "error_true"), "o-", ms=3, label=f"phi {phi:g}, xi a {xi:g}")
    finish("iterations", "Lanczos iterations", "error of M_r^(1/2) z", "hard spheres; phi 0.41: overlapping")


def splitting():
    rows = read("splitting_phi0.1")
    if not rows:
        return
    for t, r in groups(rows, "tolerance"):
        chosen = [row for row in r if row["auto"]]
        r = sorted((row for row in r if not row["auto"]), key=lambda row: row["xi_a"])
        for key, style, label in (("MF_seconds", "r", "M F"), ("noise_seconds", "b", "M F + noise")):
            dash = "o-" if t > 1e-4 else "s--"
            plt.loglog(column(r, "xi_a"), column(r, key), style + dash, ms=3, label=f"{label}, tolerance {t:g}")
        plt.loglog(column(chosen, "xi_a"), column(chosen, "noise_seconds"), "k*", ms=10,
                   label="chosen" if t > 1e-4 else None)
    finish("fig4_splitting", "xi a", "seconds on one core", f"{rows[0]['N']:g} hard spheres, phi = 0.1 (paper: Fig. 4)")


def volume_fractions():
    for phi in ("0.02", "0.1", "0.3"):
        r = [row for row in read("splitting_phi" + phi) if row["tolerance"] == 1e-3 and not row["auto"]]
        r.sort(key=lambda row: row["xi_a"])
        if r:
            plt.loglog(column(r, "xi_a"), [1e-6 * row["N"] / row["noise_seconds"] for row in r], "o-", ms=3, label=f"phi {phi}")
    finish("fig7_volume_fraction", "xi a", "million particle steps per second", "M F + noise, tolerance 1e-3, one core (paper: Fig. 7)")


def gel():
    for name, dash in (("splitting_gel", "-"), ("splitting_like_gel", "--")):
        r = [row for row in read(name) if row["tolerance"] == 1e-3 and not row["auto"]]
        r.sort(key=lambda row: row["xi_a"])
        if not r:
            continue
        what = "gel" if dash == "-" else "hard spheres"
        plt.loglog(column(r, "xi_a"), [row["pairs"] + row["lanczos"] for row in r], "ro" + dash, ms=3, label=f"real space, {what}")
        plt.loglog(column(r, "xi_a"), [row["spread_interpolate"] + row["transform"] for row in r], "bs" + dash, ms=3,
                   label=f"wave space, {what}")
    if plt.gca().lines:
        finish("fig8_gel", "xi a", "seconds on one core", "M F + noise, tolerance 1e-3 (paper: Fig. 8)")
    plt.close()


def root():
    rows = read("root")
    if not rows:
        return
    for t, r in groups(rows, "tolerance"):
        plt.loglog(column(r, "N"), [row["pse_noise_seconds"] / row["MF_seconds"] for row in r], "bo-" if t > 1e-4 else "bs--",
                   ms=3, label=f"PSE: (M F + noise)/M F, tolerance {t:g}")
        plt.loglog(column(r, "N"), [row["lanczos_noise_seconds"] / row["pse_noise_seconds"] for row in r],
                   "ko-" if t > 1e-4 else "ks--", ms=3, label=f"Lanczos on the whole M / PSE, tolerance {t:g}")
    finish("fig5_fig6_root", "N", "ratio of times", "hard spheres, phi = 0.1 (paper: Figs. 5 and 6)")


def throughput():
    rows = read("throughput")
    if not rows:
        return
    # The printed table has nine values for eight sizes; in the text the sizes go up to 4 million.
    paper = {16: (5.2, 0.9), 32: (5.5, 1.0), 64: (6.1, 1.4), 128: (5.6, 1.6), 256: (5.9, 2.2), 512: (6.2, 2.8),
             1024: (6.2, 3.3), 2048: (5.3, 3.2), 4096: (4.8, 3.0)}
    n = [1000 * k for k in paper]
    plt.loglog(column(rows, "N"), column(rows, "MF_million_per_second"), "ro-", ms=3, label="M F, one core")
    plt.loglog(column(rows, "N"), column(rows, "noise_million_per_second"), "bo-", ms=3, label="M F + noise, one core")
    plt.loglog(n, [v[0] for v in paper.values()], "r--", label="paper, K40: M F")
    plt.loglog(n, [v[1] for v in paper.values()], "b--", label="paper, K40: noise")
    finish("table1_throughput", "N", "million particle steps per second", "hard spheres, phi = 0.1, tolerance 1e-3 (paper: Table I)")


for draw in (condition, tolerance, iterations, splitting, volume_fractions, gel, root, throughput):
    draw()
