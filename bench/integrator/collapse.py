#!/usr/bin/python3
"""Cost and error of the schemes of fix bd/pse on the collapsing cluster: CSV and plot.

    collapse.py plot                  draws collapse.csv again
    collapse.py [trajectories]        default 256 each, interleaved; uses build/lmp and the reference of examples/cluster

There are two errors.  That of the mean radius of gyration of clusters that hold together is the root mean square over
t = 1 ... 20, against independent dense-matrix Brownian dynamics (examples/cluster/reference_Rg.csv).  That of the distances
of bound pairs, t = 5 ... 20, is the sum of the absolute differences of the normalised histogram (0 ... 2) from that of the
last scheme in the list, at a fifth of its near step.  Cost: CPU time of the steps per unit of time.
"""
import os
import re
import shutil
import subprocess
import sys
import tempfile

import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.join(HERE, "..", "..")
sys.path.insert(0, os.path.join(HERE, ".."))
import chart_tables
DURATION, REACH = 20.0, 7.183757109179988
# name, dt, keywords
SCHEMES = [("euler", 0.05, "scheme euler"), ("euler", 0.02, "scheme euler"), ("euler", 0.01, "scheme euler"),
           ("euler", 0.005, "scheme euler"), ("split 4", 0.2, "scheme split substeps 4"),
           ("split 10", 0.5, "scheme split substeps 10"), ("split 20", 1.0, "scheme split substeps 20"),
           ("split 10", 0.1, "scheme split substeps 10")]
TRUTH = len(SCHEMES) - 1      # reference of the histogram: near steps of 0.01, whose variance has no first-order error


def run(scheme, seed, trajectories, folder):
    """CPU seconds of the time steps, without LAMMPS' setup and end of a run."""
    _, dt, keywords = scheme
    log = os.path.join(folder, "log")
    subprocess.run([os.path.join(ROOT, "build", "lmp"), "-in", "in.collapse", "-log", log, "-screen", "none", "-nocite", "-var", "dt",
                    str(dt), "-var", "keywords", "radius 3.2 tolerance 1e-3 fft estimate " + keywords, "-var", "seed", str(seed), "-var", "trajectories",
                    str(trajectories), "-var", "out", folder, "-var", "duration", str(DURATION)], cwd=HERE, check=True,
                   env=dict(os.environ, OMP_NUM_THREADS="1"))
    with open(log) as f:
        text = f.read()
    loops, shares = re.findall(r"Loop time of (\S+)", text), re.findall(r"([\d.]+)% CPU use", text)
    return sum(float(t) * min(1.0, float(p) / 100.0) for t, p in zip(loops, shares))


def is_bound(path):
    with open(path) as f:
        lines = f.read().split("ITEM: ATOMS")[-1].splitlines()[1:]
    x = np.array([[float(v) for v in line.split()[1:4]] for line in lines])
    near = np.linalg.norm(x[:, None] - x[None], axis=-1) < REACH
    reached = near[0]
    for _ in range(len(x)):
        reached = near[reached].any(0)
    return reached.all()


def collect(folder, results):
    for name in sorted(os.listdir(folder)):
        if not name.startswith("rg."):
            continue
        number = name[3:]
        if not is_bound(os.path.join(folder, "final." + number)):
            continue
        curve = np.loadtxt(os.path.join(folder, name))
        with open(os.path.join(folder, "bonds." + number)) as f:
            table = np.array([[float(v) for v in line.split()] for line in f if len(line.split()) == 4])
        results["curve"].append(curve[:, 1])
        results["time"] = curve[:, 0]
        results["r"] = table[:, 1]
        results["bonds"].append(np.diff(table[:, 3], prepend=0.0))    # coordination by shell


def main():
    trajectories, batch = int(sys.argv[1]) if len(sys.argv) > 1 else 256, 16
    data = [dict(curve=[], bonds=[], cpu=[]) for _ in SCHEMES]
    for first in range(0, trajectories, batch):
        for k, scheme in enumerate(SCHEMES):
            folder = tempfile.mkdtemp()
            data[k]["cpu"].append(run(scheme, 100000 * (k + 1) + first, batch, folder) / (batch * DURATION))
            collect(folder, data[k])
            shutil.rmtree(folder)
        print(f"{first + batch} of {trajectories}", flush=True)
        report(data)


def report(data):
    """Table, CSV and plot of the results so far."""
    times = np.arange(1.0, DURATION + 0.5)
    with open(os.path.join(ROOT, "examples", "cluster", "reference_Rg.csv")) as f:
        lines = [line for line in f if not line.startswith("#")]
    names = lines[0].strip().split(",")
    table = np.array([[float(v) for v in line.split(",")] for line in lines[1:]])
    reference = {n: table[:, i] for i, n in enumerate(names)}
    at = [int(np.argmin(abs(reference["t"] - t))) for t in times]
    exact, exact_error = reference["Rg_bound_mean_HI"][at], reference["Rg_bound_se_HI"][at]
    truth = np.mean(data[TRUTH]["bonds"], axis=0)
    truth /= truth.sum()
    rows = []
    for (name, dt, _), d in zip(SCHEMES, data):
        here = [int(np.argmin(abs(d["time"] - t))) for t in times]
        curves = np.array(d["curve"])[:, here]
        mean, error = curves.mean(0), curves.std(0, ddof=1) / np.sqrt(len(curves))
        bonds = np.mean(d["bonds"], axis=0)
        shape = bonds / bonds.sum()
        well = d["r"] < 6.3
        middle = (shape * d["r"])[well].sum() / shape[well].sum()
        variance = (shape * (d["r"] - middle) ** 2)[well].sum() / shape[well].sum()
        rows.append(dict(scheme=name, dt=dt, bound=len(curves), cpu_ms_per_time=1e3 * np.median(d["cpu"]),
                         Rg_error=np.sqrt(np.mean((mean - exact) ** 2)),
                         Rg_standard_error=np.sqrt(np.mean(error ** 2 + exact_error ** 2)),
                         bond_error=abs(shape - truth).sum(), bond_variance=variance))
        print("  ".join(f"{k} {v:.4g}" if isinstance(v, float) else f"{k} {v}" for k, v in rows[-1].items()))
    with open(os.path.join(HERE, "collapse.csv"), "w") as f:
        f.write("# made by bench/integrator/collapse.py\n" + ",".join(rows[0]) + "\n")
        for r in rows:
            f.write(",".join(f"{v:.5g}" if isinstance(v, float) else str(v) for v in r.values()) + "\n")
    plot()


def plot():
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    rows = chart_tables.read(HERE, "collapse")[:TRUTH]
    figure, axes = plt.subplots(1, 2, figsize=(8.6, 3.6))
    for axis, key, label in ((axes[0], "bond_error", "error of the distances of bound pairs"),
                             (axes[1], "Rg_error", "error of the radius of gyration")):
        for kind, marker in (("euler", "o-"), ("split", "s-")):
            some = [r for r in rows if r["scheme"].startswith(kind)]
            axis.plot([r["cpu_ms_per_time"] for r in some], [r[key] for r in some], marker, label="scheme " + kind)
            for r in some:
                text = f"dt {r['dt']:g}" + (f", n = {r['scheme'][6:]}" if kind == "split" else "")
                above = {"split 4": 2, "split 10": 14, "split 20": 26}.get(r["scheme"], 4) if key == "bond_error" else 4    # labels must not overlap
                axis.annotate(text, (r["cpu_ms_per_time"], r[key]), fontsize=7, xytext=(4, above), textcoords="offset points")
        axis.set_xscale("log")
        axis.set_yscale("log")
        axis.set_xlabel("CPU time per unit of time [ms]")
        axis.set_ylabel(label)
        axis.margins(x=0.2, y=0.1)
        chart_tables.label_short_axis(axis.xaxis)
        chart_tables.label_short_axis(axis.yaxis)
        axis.legend(fontsize=8)
    axes[1].axhline(np.mean([r["Rg_standard_error"] for r in rows]), color="gray", ls=":", lw=1)
    figure.tight_layout()
    figure.savefig(os.path.join(HERE, "collapse.png"), dpi=130)


if __name__ == "__main__":
    plot() if sys.argv[1:] == ["plot"] else main()
