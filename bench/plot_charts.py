#!/usr/bin/python3
"""Draws doc/charts/*.csv, which are measured by charts.sh.

    bench/plot_charts.py [accuracy] [spheres] [size] [split] [lanczos] [delta] [wall] [ranks] [skipping] [collapse_time]     default: all
"""
import os
import sys

import matplotlib
import numpy as np

matplotlib.use("Agg")
import matplotlib.pyplot as plt

import chart_tables
from chart_tables import groups

TOP = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..")
sys.path.insert(0, os.path.join(TOP, "examples", "common"))
import blake

FOLDER = os.path.join(TOP, "doc", "charts")
plt.rcParams.update({"axes.grid": True, "grid.alpha": 0.3, "savefig.dpi": 110, "font.size": 9})


def read(name):
    return chart_tables.read(FOLDER, name)


def save(figure, name):
    figure.tight_layout()
    figure.savefig(os.path.join(FOLDER, name + ".png"))
    plt.close(figure)


MARKS = {"dense": ("k*", 11), "pse single": ("bo-", 4), "pse double": ("rs-", 4), "fib": ("g^", 7)}


def front(rows, error, cost):
    """The rows that no other row beats in both error and cost, sorted by cost."""
    best = sorted((r for r in rows if not any(o[error] < r[error] and o[cost] <= r[cost] for o in rows)), key=lambda r: r[cost])
    return best


def slit_points():
    """bd/fib in a slit: root mean square error of the mobility over heights, and seconds per step, for each kernel."""
    found = []
    for kernel, r in groups(read("slit"), "kernel"):
        errors = [(row[m] / row[m + "_exact"] - 1.0) ** 2 for row in r for m in ("par", "perp")]
        found.append((kernel, (sum(errors) / len(errors)) ** 0.5, r[0]["step_seconds"] / 500.0))
    return found


def name_kernel(axis, kernel, x, y):
    """Puts the name of a kernel next to its point, clear of the other names."""
    below = kernel == "peskin4"
    axis.annotate(kernel, (x, y), fontsize=7, xytext=(0, -5 if below else 5), textcoords="offset points", ha="center",
                  va="top" if below else "bottom")


def accuracy():
    rows = read("accuracy")
    if not rows:
        return
    for error, label, name in (("error_U", "relative error of U = M F", "error_of_velocity"),
                               ("error_noise", "relative error of the random velocity", "error_of_noise"),
                               ("error_D", "relative error of the short-time diffusion coefficient", "error_of_diffusion")):
        figure, axes = plt.subplots(1, 4, figsize=(13, 3.8), sharey=True)
        for axis, (scene, r) in zip(axes, groups(rows, "scene")):
            for row in r:
                row["us"] = 1e6 * row["step_seconds"] / row["N"]
            best = [row for row in front(r, error, "us") if row[error] > 1e-13]
            axis.plot([row["us"] for row in best], [row[error] for row in best], "-", color="0.8", lw=8, zorder=0,
                      label="nothing is better in both")
            for method, m in groups(r, "method"):
                mark, size = MARKS[method]
                m = m if method != "dense" else [dict(row, **{error: 1e-12}) for row in m]
                axis.loglog([row["us"] for row in m], [row[error] for row in m], mark, ms=size, lw=1,
                            label={"dense": "dense matrix, Cholesky: round-off", "fib": "bd/fib"}.get(method, "bd/" + method))
                if method == "fib":
                    for row in m:
                        name_kernel(axis, row["setting"], row["us"], row[error])
            axis.set_title(f"{scene}, {r[0]['N']:.0f} spheres")
            axis.set_xlabel("microseconds per particle and step")
        axis = axes[3]
        if error != "error_U":
            axis.axis("off")
        else:
            for kernel, value, seconds in slit_points():
                axis.loglog([1e6 * seconds], [value], "g^", ms=7)
                name_kernel(axis, kernel, 1e6 * seconds, value)
            axis.set_xlim(0.5, 50.0)
            axis.set_title("slit, 8 radii wide")
            axis.set_xlabel("microseconds per particle and step")
        axes[0].set_ylabel(label)
        axes[0].set_ylim(top=1.0)
        axis.legend(*axes[0].get_legend_handles_labels(), fontsize=7, loc="lower left")
        save(figure, name)


def spheres():
    rows, costs = read("spheres"), read("sphere_costs")
    if not rows or not costs:
        return
    figure, axes = plt.subplots(1, 2, figsize=(11, 4))
    colors = {("equal", "no"): "k", ("1:4", "no"): "b", ("equal", "yes"): "g", ("1:4", "yes"): "r"}
    for case, r in groups(rows, "radii", "rotation"):
        us = [1e6 * row["step_seconds"] / row["N"] for row in r]
        label = f"{case[0]} radii, forces" + (" and torques" if case[1] == "yes" else "")
        axes[0].loglog(us, [row["error_U"] for row in r], colors[case] + "o-", ms=4, lw=1, label=label + ": velocity")
        if case[1] == "yes":
            axes[0].loglog(us, [row["error_omega"] for row in r], colors[case] + "^--", ms=4, lw=1, label=label + ": angular velocity")
    chart_tables.label_short_axis(axes[0].xaxis)
    axes[0].set_xlabel("microseconds per particle and step")
    axes[0].set_ylabel("relative error")
    axes[0].set_title(f"{rows[0]['N']:.0f} spheres, tolerances 1e-1 to 1e-8", fontsize=9)
    axes[0].legend(fontsize=7)
    names = []
    for noise, mark in (("no", "bo"), ("yes", "rs")):
        r = [row for row in costs if row["noise"] == noise]
        names = [f"1:{row['ratio']:g}, {row['classes']:g} classes" if row["classes"] > 1 else "equal" for row in r]
        names = [name + (", torques" if row["rotation"] == "yes" else "") for name, row in zip(names, r)]
        axes[1].plot([row["over_equal"] for row in r], [-i for i in range(len(r))], mark, ms=5, label="M F + noise" if noise == "yes" else "M F")
    axes[1].axvline(2.0, color="k", lw=0.8, ls="--", label="goal")
    axes[1].set_yticks([-i for i in range(len(names))])
    axes[1].set_yticklabels(names, fontsize=7)
    axes[1].set_xlim(left=0.0)
    axes[1].set_xlabel("time of a step / of equal spheres under forces")
    axes[1].set_title("4000 spheres, packing fraction at most 0.1, tolerance 1e-3", fontsize=9)
    axes[1].legend(fontsize=7)
    save(figure, "spheres")


def size():
    rows = read("size")
    if not rows:
        return
    figure, axes = plt.subplots(1, 2, figsize=(9, 3.8), sharey=True)
    for axis, key, title in ((axes[0], "MF_seconds", "M F"), (axes[1], "step_seconds", "M F + noise")):
        for method, r in groups(rows, "method"):
            axis.loglog([row["N"] for row in r], [row[key] for row in r], "o-", ms=3, label=method)
        axis.set_title(title + ", one core, packing fraction 0.1")
        axis.set_xlabel("particles")
    axes[0].set_ylabel("seconds")
    axes[0].legend(fontsize=7)
    save(figure, "cost_against_size")


def split():
    rows = read("split")
    if not rows:
        return
    figure, axis = plt.subplots(figsize=(5.5, 4))
    x = [row["xi_a"] for row in rows]
    for key, mark in (("classical_near", "ko-"), ("classical_far", "ks--"), ("positive_near", "ro-"), ("positive_far", "rs--"), ("kaiser_near", "go-"), ("kaiser_far", "gs--")):
        axis.plot(x, [row[key] for row in rows], mark, ms=4, label=key.replace("_", " split, ") + " part")
    axis.set_yscale("symlog", linthresh=0.01)
    axis.axhline(0.0, color="b", lw=0.8)
    axis.set_xlabel("xi a")
    axis.set_ylabel("smallest eigenvalue [1/(6 pi eta a)]")
    axis.set_title("30 hard spheres, packing fraction 0.2: no square root below the line", fontsize=9)
    axis.legend(fontsize=7)
    save(figure, "ewald_split")


def lanczos():
    rows = read("lanczos")
    if not rows:
        return
    scenes = list(groups([dict(r, name=f"{r['scene']}, phi {r['phi']:g}") for r in rows], "name"))
    figure, axes = plt.subplots(1, len(scenes), figsize=(3 * len(scenes), 3.3), sharey=True)
    for axis, (name, r) in zip(axes, scenes):
        for tolerance, t in groups(r, "tolerance"):
            axis.loglog([row["xi_a"] for row in t], [row["iterations"] for row in t], "o-", ms=3, label=f"{tolerance:g}")
        axis.set_title(name, fontsize=9)
        axis.set_xlabel("xi a")
        chart_tables.label_short_axis(axis.xaxis)
    chart_tables.label_short_axis(axes[0].yaxis)
    axes[0].set_ylabel("Lanczos iterations")
    axes[0].legend(fontsize=7, title="error")
    save(figure, "lanczos_iterations")


def delta():
    rows = read("delta")
    if not rows:
        return
    figure, axis = plt.subplots(figsize=(5.5, 4))
    for (scene, r), dash in zip(groups(rows, "scene"), ("-", "--")):
        for kernel, k in groups(r, "kernel"):
            k = [row for row in k if row["error"] > 0.0]
            axis.loglog([row["delta"] for row in k], [row["error"] for row in k], "o" + dash, ms=3, label=f"{kernel}, {scene}")
    axis.axvline(1e-6, color="k", lw=0.8)
    axis.set_xlabel("delta/h   (line: default)")
    axis.set_ylabel("error of the thermal drift, relative to delta = 1e-4 h")
    axis.set_title("random finite difference: rounding on the left, truncation on the right", fontsize=9)
    axis.legend(fontsize=7)
    save(figure, "finite_difference_step")


def wall():
    rows = read("wall")
    if not rows:
        return
    exact = [row for row in read("slit") if row["kernel"] == "peskin4"]
    figure, axes = plt.subplots(2, 2, figsize=(9, 7.4))
    for axis, key in zip(axes[0], ("par", "perp")):
        for kernel, r in groups(rows, "kernel"):
            axis.plot([row["H"] for row in r], [row[key] for row in r], label=kernel)
        axis.plot([row["H"] for row in exact if row["H"] <= 3], [row[key + "_exact"] for row in exact if row["H"] <= 3], "ko", ms=4,
                  label="RPY sphere between walls")
        axis.set_xlabel("height over the wall / a")
        axis.set_title({"par": "along the wall", "perp": "away from the wall"}[key] + ", slit of 8 a")
    axes[0, 0].set_ylabel("mobility [1/(6 pi eta a)]")
    axes[0, 0].legend(fontsize=7)
    open_wall(axes[1])
    save(figure, "kernels_near_a_wall")


OPEN_WIDTH = 64.0        # of the walls of open_wall.csv, in radii


def open_wall(axes):
    """Self- and pair mobility above one wall; theory: RPY spheres with Blake's tensor and their periodic images."""
    rows = read("open_wall")
    single = [row for row in rows if row["r"] == 0]
    heights = sorted({row["H"] for row in single if row["H"] >= 1.2})
    theory = np.array([blake.self_mobility(H, OPEN_WIDTH)[0] for H in heights])
    for (kernel, r), color in zip(groups(single, "kernel"), ("C0", "C1", "C2")):
        axes[0].plot([row["H"] for row in r], [row["line"] for row in r], "-", color=color, lw=1, label=kernel)
        axes[0].plot([row["H"] for row in r], [row["across"] for row in r], "-", color=color, lw=1)
    axes[0].plot(heights, theory, "k.", ms=4, label=["RPY sphere above one wall", None])
    axes[0].set_xlabel("height over the wall / a")
    axes[0].set_ylabel("mobility [1/(6 pi eta a)]")
    axes[0].set_title("under fluid without end: along (upper), away from the wall (lower)", fontsize=9)
    axes[0].legend(fontsize=7)
    pairs = [row for row in rows if row["r"] > 0 and row["kernel"] == "peskin4"]
    for (H, r), dash in zip(groups(pairs, "H"), ("-", "--")):
        spheres = [(np.array([0.0, 0.0, H]), np.array([row["r"], 0.0, H])) for row in r]
        exact = np.array([np.diag(blake.rpy(b, a) + blake.images(b, a, OPEN_WIDTH)) for a, b in spheres])
        for d, (key, color) in enumerate((("line", "C0"), ("along", "C1"), ("across", "C2"))):
            axes[1].semilogx([row["r"] for row in r], exact[:, d], dash, color=color, lw=1)
            axes[1].semilogx([row["r"] for row in r], [row[key] for row in r], "o", ms=4, color=color, mfc=color if dash == "-" else "none",
                             label={"line": "along the line of centers", "along": "across it, along the wall", "across": "away from the wall"}[key]
                             if dash == "-" else None)
    chart_tables.label_short_axis(axes[1].xaxis)
    axes[1].set_xlabel("distance of two spheres / a")
    axes[1].set_title("the other of two spheres (peskin4; lines: RPY), heights 1.5 and 3 (open)", fontsize=9)
    axes[1].legend(fontsize=7)


def ranks():
    rows = read("ranks")
    if not rows:
        return
    figure, axis = plt.subplots(figsize=(5.5, 4))
    for method, of_method in groups([row for row in rows if row["count"] == 2], "method"):
        for kind, r in groups(of_method, "kind"):
            axis.semilogx([row["N"] for row in r], [row["speedup"] for row in r], "o-" if kind == "ranks" else "s--", ms=4,
                          color="C0" if method.startswith("pse") else "C1", label=f"{method}, {kind}")
    chart_tables.label_short_axis(axis.xaxis)
    axis.set_ylim(0.8, 2.1)
    axis.set_xlabel("particles")
    axis.set_ylabel("time on 1 / time on 2")
    axis.legend(fontsize=7)
    save(figure, "cost_against_ranks")


def skipping():
    rows = read("skipping")
    if not rows:
        return
    scenes = list(groups(rows, "scene"))
    figure, axis = plt.subplots(figsize=(8, 5))
    for place, (scene, r) in enumerate(scenes):
        automatic = r[0]["step_seconds"]
        others = sorted(r[1:], key=lambda row: row["step_seconds"])
        axis.plot([row["step_seconds"] / automatic for row in others], [-place] * len(others), "bo", ms=5)
        for i, row in enumerate(others):
            axis.annotate(row["plan"], (row["step_seconds"] / automatic, -place), fontsize=6.5, xytext=(0, 5 if i % 2 else -10), ha="center",
                          textcoords="offset points")
    axis.axvline(1.0, color="k", lw=1, label="the automatic plan")
    axis.axvline(1.0 / 1.1, color="k", lw=0.8, ls="--", label="1.1 times as fast as that")
    axis.set_yticks([-i for i in range(len(scenes))])
    axis.set_yticklabels([name for name, _ in scenes])
    axis.set_xscale("log")
    axis.set_xticks([0.8, 1, 1.5, 2, 3])
    axis.set_xticklabels(["0.8", "1", "1.5", "2", "3"])
    axis.minorticks_off()
    axis.set_xlabel("time of a step with this override / of the automatic plan")
    axis.legend(fontsize=7)
    save(figure, "skipping")


def collapse_time():
    rows = [row for row in read("collapse_time") if row["trajectories"] != ""]
    if not rows:
        return
    marks = {"dense": "k*", "bd/pse, euler": "bo", "bd/pse, split": "rs", "bd/fib": "g^", "no": "mx"}
    figure, axes = plt.subplots(1, 2, figsize=(11, 4.4))
    for method, r in groups(rows, "method"):
        mark = next(marks[start] for start in marks if method.startswith(start))
        for row in r:
            place, limit = (row["ms_per_time"], abs(row["error"])), row["error_se"] == ""
            bar = [[0.0], [0.3 * place[1]]] if limit else [[min(row["error_se"], 0.9 * place[1])], [row["error_se"]]]
            axes[0].errorbar(*place, yerr=bar, lolims=limit, fmt=mark, mfc="none" if method.endswith("improved") else None, ms=5, lw=0.8, capsize=2,
                             label=method if row is r[0] else None)
            label = row["setting"] if not isinstance(row["setting"], float) else f"{row['setting']:.0e}".replace("e-0", "e-")
            if method == "bd/pse, euler" and row["dt"] != 0.05:
                label += f", dt {row['dt']:g}"
            if not method.startswith(("no", "dense")):
                # moves labels apart that would overlap
                label = label.replace("1e-3, ", "")
                left = {"10 substeps": 7, "20 substeps": -5, "4 substeps": -14, "cheapest xi": -11, "roma3": -2}
                below = method.endswith("improved")
                axes[0].annotate(label, place, fontsize=6.5, xytext=(0, -11) if below else (-5, left[label]) if label in left else (4, -2 if limit else 3),
                                 ha="center" if below else "right" if label in left else "left", textcoords="offset points")
    level = max(row["error_se"] for row in rows if row["method"].startswith("bd/pse"))
    axes[0].axhspan(1e-4, level, color="0.92", zorder=0)
    axes[0].text(0.98, 1.1e-3, "gray: below one standard error", fontsize=7, ha="right", va="bottom", transform=axes[0].get_yaxis_transform())
    axes[0].set_yscale("log")
    axes[0].set_ylim(1e-3, 6)
    axes[0].set_xlim(0.1, 150)
    axes[0].set_ylabel("relative error of the collapse time")
    axes[0].set_title("cluster of 13 colloids; arrows: not collapsed within the run, error larger", fontsize=9)
    axes[0].legend(fontsize=7, loc="center right", bbox_to_anchor=(1.0, 0.66))
    same = [row for row in rows if row["change"] not in ("", 0.0)]
    axes[1].errorbar([row["ms_per_time"] for row in same], [100 * row["change"] for row in same], yerr=[100 * row["change_se"] for row in same],
                     fmt="bo", ms=4, lw=0.8, capsize=2)
    for row in same:
        axes[1].annotate(f"{row['setting']:.0e}".replace("e-0", "e-"), (row["ms_per_time"], 100 * row["change"]), fontsize=7, xytext=(5, 3),
                         textcoords="offset points")
    axes[1].axhline(0.0, color="k", lw=0.8)
    axes[1].set_xlim(0.9, 5)
    axes[1].set_xticks([1, 2, 3, 4])
    axes[1].set_ylabel("change of the collapse time [%]")
    axes[1].set_title("bd/pse, euler: change relative to tolerance 1e-6, same random numbers", fontsize=9)
    axes[0].set_xscale("log")
    for axis in axes:
        axis.set_xlabel("processor time per unit of time [ms]")
    save(figure, "collapse_time")


for draw in [d for d in (accuracy, spheres, size, split, lanczos, delta, wall, ranks, skipping, collapse_time) if d.__name__ in sys.argv[1:] or not sys.argv[1:]]:
    draw()
