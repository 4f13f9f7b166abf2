#!/usr/bin/python3
"""Stress and contacts of gels against strain: modulus, peak and flow, with pictures of one of them."""

import glob
import os
import sys

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "common"))
import bdh_examples as ex

PECLET = (1, 10, 30)
RANGE, DEPTH = 0.6, 7.8             # of the attraction, in a and kT; pairs closer than 2 + RANGE are in contact
ELASTIC = 0.025                     # strain up to which the modulus is taken
AROUND = 0.15, 0.8                  # strains around the peak, through which a cubic is fitted
HIGH = 0.3, 0.6                     # strains at which they have their peak
FLOW = 1.0                          # strain from which on they flow
LEVEL = 3                           # standard errors, above which there is a peak
ROWS = (0.025, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.75, 1, 1.5, 2)


# ---- numbers --------------------------------------------------------------------------------------------------------

def gels(peclet):
    """Strain, and stress and contacts [gel, strain]: the means of a run forth and one back from each gel.

    Stress that a gel keeps from its formation is the same in both, and cancels."""
    folders = sorted(glob.glob("results/yield/*/"), key=lambda name: int(name.split("/")[-2]))
    tables = np.array([[ex.read_fix_print(f"{folder}yield.{sign}{peclet}.dat") for sign in ("", "-")] for folder in folders])
    stress = (tables[:, 0, :, 2] - tables[:, 1, :, 2]) / 2
    return tables[0, 0, :, 1], stress, tables[:, :, :, 3].mean(1)


def read_gel(path):
    """Positions and side of the box of a data file."""
    with open(path) as f:
        lines = f.read().splitlines()
    low, high = next([float(w) for w in line.split()[:2]] for line in lines if line.endswith("xlo xhi"))
    number = next(int(line.split()[0]) for line in lines if line.endswith("atoms"))
    first = next(i for i, line in enumerate(lines) if line.startswith("Atoms")) + 2
    return np.array([line.split()[2:5] for line in lines[first:first + number]], float) - low, high - low


def without_one(measure, strain, samples):
    """measure(strain, mean of the samples), and its standard error by leaving out one sample at a time."""
    n = len(samples)
    left = np.array([measure(strain, np.delete(samples, i, 0).mean(0)) for i in range(n)])
    return measure(strain, samples.mean(0)), np.sqrt((n - 1) * left.var(0))


def modulus(strain, stress):
    some = strain < ELASTIC
    return strain[some] @ stress[some] / (strain[some] @ strain[some])


def top(strain, stress):
    """Strain and stress at the top of a cubic through the stresses at strains of AROUND: noise alone would choose a block."""
    some = (strain > AROUND[0]) & (strain < AROUND[1])
    fine = np.linspace(*AROUND, 651)
    cubic = np.polyval(np.polyfit(strain[some], stress[some], 3), fine)
    return fine[np.argmax(cubic)], cubic.max()


def yield_strain(strain, stress):
    return top(strain, stress)[0]


def peak(strain, stress):
    return top(strain, stress)[1]


def flow(strain, stress):
    return stress[strain > FLOW].mean()


def overshoot(strain, stress):
    """Mean stress at strains of HIGH less that of the flow: the greatest stress would exceed it by its noise alone."""
    return stress[(strain > HIGH[0]) & (strain < HIGH[1])].mean() - flow(strain, stress)


MEASURES = {"modulus": modulus, "flow": flow, "overshoot": overshoot, "peak": peak, "yield strain": yield_strain}


def has_peak(numbers):
    return numbers["overshoot"][0] > LEVEL * numbers["overshoot"][1]


# ---- tables ---------------------------------------------------------------------------------------------------------

def table_against_strain(curves):
    rows = []
    for gamma in ROWS:
        row = [f"{gamma:g}"]
        for strain, stress, contacts in curves.values():
            some = np.argsort(np.abs(strain - gamma))[:2]            # the block before and the one after
            row += [ex.plus_minus(*ex.mean_and_error(v[:, some].mean(1))) for v in (stress, contacts)]
        rows.append(row)
    print("\nstress of the bonds, kT/a^3, and contacts per colloid")
    ex.print_table(["strain"] + [word for peclet in curves for word in (f"Peclet {peclet}: stress", "contacts")], rows)


def table_of_measures(curves):
    """{Peclet number: {name: (value, error)}}."""
    found = {peclet: {name: without_one(f, strain, stress) for name, f in MEASURES.items()}
             for peclet, (strain, stress, _) in curves.items()}
    rows = [[f"{peclet}", f"{peclet * RANGE / DEPTH:.2f}"] +
            [ex.plus_minus(*v) if has_peak(numbers) or name not in ("peak", "yield strain") else "-" for name, v in numbers.items()]
            for peclet, numbers in found.items()]
    print(f"\nmodulus up to a strain of {ELASTIC:g}, flow from a strain of {FLOW:g} on, overshoot at strains of {HIGH[0]} to {HIGH[1]}, peak: kT/a^3")
    ex.print_table(["Peclet", "of bonds", *MEASURES], rows)
    return found


# ---- figure ---------------------------------------------------------------------------------------------------------

def strip(plt, figure, grid, shots):
    """Pictures in a row, with the strain of each."""
    steps = ex.read_fix_print(f"results/yield/1/yield.{PECLET[1]}.dat")
    per_step = (steps[-1, 1] - steps[0, 1]) / (steps[-1, 0] - steps[0, 0])
    row = grid.subgridspec(1, len(shots), wspace=0.02)
    for k, path in enumerate(shots):
        axes = figure.add_subplot(row[k])
        axes.axis("off")
        axes.imshow(plt.imread(path))
        axes.set_title(f"strain {per_step * int(path.split('.')[-2]):.2g}", fontsize=9)


def plot(curves, found):
    plt = ex.pyplot()
    shots = sorted(glob.glob("results/yield/1/picture.*.png"))
    shots = [path for k, path in enumerate(shots) if k in (0, 1, 3, 5)]      # the box has flipped in the others
    figure = plt.figure(figsize=(9.6, 5.8 if shots else 3.8))
    grid = figure.add_gridspec(2, 1, height_ratios=[1, 1.8], hspace=0.1) if shots else figure.add_gridspec(1, 1)
    if shots:
        strip(plt, figure, grid[0], shots)
    lower = grid[len(shots) > 0].subgridspec(1, 2, wspace=0.2)
    left, right = figure.add_subplot(lower[0]), figure.add_subplot(lower[1])
    for (peclet, (strain, stress, contacts)), color in zip(curves.items(), ex.COLORS):
        for axes, samples in ((left, stress), (right, contacts)):
            mean, error = ex.mean_and_error(samples)
            axes.fill_between(strain, mean - error, mean + error, color=color, alpha=0.3, lw=0)
            axes.plot(strain, mean, color=color, lw=1, label=f"Peclet number {peclet}")
        top, at = found[peclet]["peak"], found[peclet]["yield strain"]
        if has_peak(found[peclet]):
            left.errorbar(at[0], top[0], top[1], at[1], fmt="o", color=color, mec="black", mew=0.7, zorder=3)
        left.plot([0, top[0] / found[peclet]["modulus"][0]], [0, top[0]], ":", color=color)
    left.set_ylim(0, None)
    left.set_ylabel("stress of the bonds, kT/a$^3$")
    right.set_ylabel("contacts per colloid")
    for axes in (left, right):
        axes.set_xlim(0, None)
        axes.set_xlabel("strain")
    right.legend()
    ex.save(figure, "results/yield.png")


def main():
    if not os.path.exists(f"results/yield/2/yield.-{PECLET[-1]}.dat"):
        ex.fail("no results of two gels or more: run YIELD=yes ./run.sh first")
    curves = {peclet: gels(peclet) for peclet in PECLET}
    print("\ngels before they are sheared: share of the largest cluster, and number of axes along which it winds around the box")
    for path in sorted(glob.glob("results/yield/*/gel.data")):
        share, axes = ex.largest_cluster(*read_gel(path), 2 + RANGE)
        print(f"  {path}: {100 * share:.0f} %, {axes}")
    table_against_strain(curves)
    found = table_of_measures(curves)
    plot(curves, found)
    words = []
    for peclet, numbers in found.items():
        value, error = numbers["overshoot"]
        words.append(f"{'a peak' if has_peak(numbers) else 'no peak'} at Peclet number {peclet} ({value / error:+.1f} standard errors)")
    print("verdict: before the gels flow, the stress has " + ", ".join(words))


if __name__ == "__main__":
    main()
