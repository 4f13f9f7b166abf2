#!/usr/bin/python3
"""Mean radius of gyration of the collapsing cluster against reference curves (512 trajectories each).

    analyse.py [kernel]        kernel of fix bd/fib: selects reference_blob_KERNEL.csv
"""

import glob
import os
import sys

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "common"))
import bdh_examples as ex

TIMES = np.array([1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0])
BOND = 2 ** (1 / 6) * 6.4            # range of the attraction: a shorter distance is a bond
REFERENCE_SIZE = 512
TITLES = {"fib": "with hydrodynamic interactions (fix bd/fib)",
          "pse": "with hydrodynamic interactions (fix bd/pse)",
          "none": "without hydrodynamic interactions"}


# Trajectories for the joint test.  R_g is skewed: a few clusters collapse late, and fewer samples may have none of these.
ENOUGH = 80


class Reference:
    """Mean curve of the trajectories that ended as one cluster, and its standard error."""

    def __init__(self, title, path, column=""):
        table = ex.read_csv(path)
        self.title = title
        self.time = table["t"]
        self.mean, self.error = table[f"Rg_bound_mean{column}"], table[f"Rg_bound_se{column}"]
        self.fraction = table[f"frac_one_cluster{column}"][-1]

    def at(self, times):
        index = [int(np.argmin(abs(self.time - t))) for t in times]
        return self.mean[index], self.error[index]


def references(kernel):
    """References by name of the run; the first is the one that matches the run in every respect."""
    free = "reference_Rg.csv"
    blobs, rpy = Reference("blobs", f"reference_blob_{kernel}.csv"), Reference("RPY", free, "_HI")
    return {"none": [Reference("no interactions", free, "_noHI")], "fib": [blobs, rpy], "pse": [rpy, blobs]}


def is_one_cluster(x):
    """Whether bonds connect all particles."""
    bonded = np.linalg.norm(x[:, None] - x[None], axis=-1) < BOND
    reached = np.zeros(len(x), bool)
    reached[0] = True
    for _ in range(len(x)):
        reached = bonded[reached].any(0)
    return bool(reached.all())


def load(folder):
    """Times, R_g [trajectory, time] and which trajectories ended as one cluster."""
    curves, bound = [], []
    for path in sorted(glob.glob(f"{folder}/rg.*")):
        last = ex.read_dump(path.replace("/rg.", "/final."))[-1][1]
        table = ex.read_fix_print(path)
        curves.append(table[:, 1])
        bound.append(is_one_cluster(np.column_stack([last[c] for c in ("xu", "yu", "zu")])))
    if len(curves) < 2:
        ex.fail(f"no results in {folder}: run ./run.sh first")
    return table[:, 0], np.array(curves), np.array(bound)


def compare(name, against):
    """Prints the table; returns what the plot and the verdict need."""
    time, curves, bound = load(f"results/{name}")
    curves = curves[bound]
    n = len(curves)
    mean, error = ex.mean_and_error(curves)
    at = np.array([np.argmin(abs(time - t)) for t in TIMES])

    print(f"\n{TITLES[name]}: {n} trajectories of {len(bound)} ended as one cluster (reference: "
          f"{100 * against[0].fraction:.1f} %)")
    head = ["time", "Rg here", "+-"]
    columns = [[f"{t:g}" for t in TIMES], [f"{v:.4f}" for v in mean[at]], [f"{v:.4f}" for v in error[at]]]
    tests = []
    for reference in against:
        ref, ref_error = reference.at(TIMES)
        z = (mean[at] - ref) / np.hypot(error[at], ref_error)
        head += [f"{reference.title}, reference", "+-", "difference in s.e."]
        columns += [[f"{v:.4f}" for v in ref], [f"{v:.4f}" for v in ref_error], [f"{v:+.1f}" for v in z]]
        # values of one trajectory at different times are correlated: test all times together with their covariance
        chi2, _, p = ex.joint_test(curves[:, at], ref, REFERENCE_SIZE)
        tests.append(dict(title=reference.title, rms=ex.rms(z), chi2=chi2, p=p))
    ex.print_table(head, list(zip(*columns)))
    return dict(time=time, mean=mean, error=error, n=n, tests=tests)


def plot(results, known):
    plt = ex.pyplot()
    shots = [("none", 5), ("none", 100), ("fib", 5), ("fib", 20), ("fib", 100)]
    files = [("both", 0, glob.glob("results/fib/picture.000000.png"))]
    for name, t in shots:
        frames = sorted(glob.glob(f"results/{name}/picture.*.png"))    # one every 5 time units
        files.append((name, t, frames[t // 5:t // 5 + 1]))
    figure = plt.figure(figsize=(8.6, 6.6))
    grid = figure.add_gridspec(2, len(files), height_ratios=[1, 2.9], hspace=0.06, wspace=0.0)
    for column, (name, t, found) in enumerate(files):
        axes = figure.add_subplot(grid[0, column])
        axes.axis("off")
        if found:
            axes.imshow(plt.imread(found[0]))
        label = {"both": "start", "none": "without HI", "fib": "with HI"}[name]
        axes.set_title(label + (f"\nt = {t}" if t else "\nt = 0"), fontsize=9,
                       color={"both": "black", "none": ex.COLORS[1], "fib": ex.COLORS[0]}[name])
    axes = figure.add_subplot(grid[1, :])
    for name, color in (("fib", ex.COLORS[0]), ("pse", ex.COLORS[2]), ("none", ex.COLORS[1])):
        r = results[name]
        late = r["time"] > 0
        axes.fill_between(r["time"][late], (r["mean"] - r["error"])[late], (r["mean"] + r["error"])[late], color=color,
                          alpha=0.3, lw=0)
        axes.plot(r["time"][late], r["mean"][late], color=color, label=f"{TITLES[name]}, {r['n']} trajectories")
    marks = [(known["fib"][0], "o", "dense matrices, pair mobility of the blobs"),
             (known["fib"][1], "^", "dense matrices, Rotne-Prager-Yamakawa"),
             (known["none"][0], "s", "no interactions, independent program")]
    for reference, marker, label in marks:
        some = np.unique(np.round(np.geomspace(1, len(reference.time) - 1, 22)).astype(int))
        axes.errorbar(reference.time[some], reference.mean[some], reference.error[some], fmt=marker, ms=3.5,
                      color="black", mfc="white", mew=0.8, lw=0.8, label=label)
    axes.set_xscale("log")
    axes.set_xlabel("time")
    axes.set_ylabel("mean radius of gyration")
    axes.legend(fontsize=8, ncol=2, loc="upper center", bbox_to_anchor=(0.5, -0.12))
    ex.save(figure, "results/cluster.png")


def main():
    kernel = sys.argv[1] if len(sys.argv) > 1 else "peskin4"
    known = references(kernel)
    results = {name: compare(name, known[name]) for name in ("none", "fib", "pse")}
    print()
    plot(results, known)
    quick = min(r["n"] for r in results.values()) < ENOUGH
    for name, r in results.items():
        for t in r["tests"]:
            together = "" if quick else (f"; all times together chi2 = {t['chi2']:.1f} for {len(TIMES)} numbers, "
                                         f"probability {t['p']:.2g}")
            print(f"{TITLES[name]} against {t['title']}: rms difference {t['rms']:.2f} standard errors{together}")
    print("The two references differ because the pair mobility of touching blobs on a grid is 2 % larger than that of RPY\n"
          "spheres along the line of centers and 2 % smaller across it.  A cluster can shrink through an incompressible\n"
          "fluid only through small differences between the motions of neighbors.  The mobility of fix bd/pse is RPY.")
    if quick:
        ok = all(r["tests"][0]["rms"] < 3 for r in results.values())
        print(f"verdict: a quick look {'agrees with' if ok else 'DIFFERS from'} the reference of each method, by rms "
              f"differences {'below' if ok else 'of more than'} 3 standard errors; {ENOUGH} trajectories allow a strict test")
        return
    print("verdict: " + ex.verdict([r["tests"][0]["p"] for r in results.values()], 0.005,
                                   "agrees with dense-matrix Brownian dynamics of the same blobs, of RPY "
                                   "spheres, and of free particles, within statistics",
                                   "DIFFERS from the reference by more than chance explains"))


if __name__ == "__main__":
    main()
