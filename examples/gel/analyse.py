#!/usr/bin/python3
"""Contacts per colloid against time, with and without hydrodynamic interactions, and pictures."""

import glob
import os
import sys

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "common"))
import bdh_examples as ex

DT, TAU = 0.05, 6 * np.pi
RANGE = 2.6                          # range of the attraction: pairs closer than this are in contact
TITLES = {"pse": "with HI (fix bd/pse)", "none": "without (hydrodynamics no)"}
TIMES = np.array([0.03, 0.1, 0.3, 1, 3, 10])


def contacts(folder):
    """Times in tau, contacts per colloid and the standard error of the mean over octants."""
    path = f"{folder}/contacts.dat"
    if not os.path.exists(path):
        ex.fail("no results: run ./run.sh first")
    steps, octants = ex.read_ave_time_vector(path)
    count, mean = octants[:, :, 3], octants[:, :, 4]
    weight = count / count.sum(1, keepdims=True)
    total = (weight * mean).sum(1)
    n = count.shape[1]
    error = np.sqrt((weight**2 * (mean - total[:, None]) ** 2).sum(1) * n / (n - 1))
    return DT * steps / TAU, total, error


def clusters(folder):
    """Times in tau, fraction in the largest cluster and number of axes along which it winds around the box."""
    with open(f"{folder}/snap.dump") as f:
        head = [next(f) for _ in range(6)]
    low, high = (float(w) for w in head[5].split())
    out = []
    for step, table in ex.read_dump(f"{folder}/snap.dump"):
        x = np.column_stack([table[c] for c in "xyz"]) - low
        out.append((DT * step / TAU, *ex.largest_cluster(x, high - low, RANGE)))
    return np.array(out).T


def plot(curves, largest):
    plt = ex.pyplot()
    shots = {name: sorted(glob.glob(f"results/{name}/picture.*.png")) for name in ("none", "pse")}
    columns = max([len(s) for s in shots.values()] + [1])
    figure = plt.figure(figsize=(2.3 * columns, 9.6))
    grid = figure.add_gridspec(3, columns, height_ratios=[1, 1, 1.5], hspace=0.25, wspace=0.02)
    lower = grid[2, :].subgridspec(1, 2, wspace=0.2)
    for row, name in enumerate(("none", "pse")):
        for column, path in enumerate(shots[name]):
            axes = figure.add_subplot(grid[row, column])
            axes.axis("off")
            axes.imshow(plt.imread(path))
            time = DT * int(path.split(".")[-2]) / TAU
            axes.set_title((TITLES[name] + "\n" if column == 0 else "\n") + f"t = {time:.2g} tau", fontsize=9,
                           color=ex.COLORS[0] if name == "pse" else ex.COLORS[1])
    axes, right = figure.add_subplot(lower[0]), figure.add_subplot(lower[1])
    for name, color in (("pse", ex.COLORS[0]), ("none", ex.COLORS[1])):
        time, mean, error = curves[name]
        some = time > 0
        axes.fill_between(time[some], (mean - error)[some], (mean + error)[some], color=color, alpha=0.3, lw=0)
        axes.plot(time[some], mean[some], color=color, label=TITLES[name])
        time, share, winds = largest[name]
        right.plot(time[1:], share[1:], color=color)
        for axis_count, fill in ((0, "white"), (1, "silver"), (2, "gray"), (3, color)):
            some = (winds == axis_count) & (time > 0)
            right.plot(time[some], share[some], "o", ms=5, color=color, mfc=fill)
    for ax in (axes, right):
        ax.set_xscale("log")
        ax.set_xlim(0.02, None)
        ax.set_xlabel("time / tau,   tau = 6 pi viscosity a$^3$/kT")
    axes.set_ylabel("contacts per colloid")
    right.set_ylabel("share of the largest cluster")
    right.set_title("filled: winds around the box along all axes", fontsize=9)
    axes.legend(loc="upper left")
    ex.save(figure, "results/gel.png")


def main():
    curves = {name: contacts(f"results/{name}") for name in ("none", "pse")}
    rows, z = [], []
    for t in TIMES:
        at = {name: int(np.argmin(abs(c[0] - t))) for name, c in curves.items()}
        if abs(curves["pse"][0][at["pse"]] / t - 1) > 0.1:
            continue
        values = [(curves[name][1][at[name]], curves[name][2][at[name]]) for name in ("none", "pse")]
        z.append((values[1][0] - values[0][0]) / np.hypot(values[0][1], values[1][1]))
        rows.append([f"{t:g}", ex.plus_minus(*values[0]), ex.plus_minus(*values[1]), f"{z[-1]:+.1f}"])
    print("\ncontacts per colloid; errors from the octants of the box")
    ex.print_table(["t/tau", "without HI", "with HI", "difference in s.e."], rows)
    largest = {name: clusters(f"results/{name}") for name in ("none", "pse")}
    print("\nlargest cluster: fraction of the colloids, and number of axes along which it winds around the box")
    rows = [[f"{t:.3g}", f"{100 * a:.1f} %", f"{b:.0f}", f"{100 * c:.1f} %", f"{d:.0f}"] for t, a, b, c, d in
            zip(largest["none"][0], *largest["none"][1:], *largest["pse"][1:])]
    ex.print_table(["t/tau", "without HI", "axes", "with HI", "axes"], rows)
    print()
    plot(curves, largest)
    start = abs(curves["pse"][1][0] - curves["none"][1][0]) < 1e-9
    gel = all(q[1][-1] > 0.9 and q[2][-1] == 3 for q in largest.values())
    print("both runs start from the same configuration: " + ("yes" if start else "NO"))
    print("verdict: " + ("both end as a gel, one cluster of more than 90 % that spans the box along all axes" if gel else
                         "NOT both end as one cluster of more than 90 % that spans the box along all axes"))


if __name__ == "__main__":
    main()
