#!/usr/bin/python3
"""Structure of a small gel and cost of the schemes of fix bd/pse: gel.csv and gel.png.

    bench/integrator/gel.py [seeds]        default 3; uses build/lmp, or the one in the environment variable LMP
    bench/integrator/gel.py plot           draws gel.csv again

Every scheme continues from the same starting configurations, one per seed.  There are two errors, both relative to
REFERENCE, whose near steps are 5 to 20 times shorter.  bond_error, of the distances of bound pairs, is the sum of the
absolute differences of the normalised histogram of r < 2.6 (bins of 0.02).  g_error, of g(r) beyond, is the root mean
square difference over 2.6 ... 5 (bins of 0.1).  The noise of both is measured with a second run of the reference with
other random numbers.  Cost: processor time of the steps per unit of time.
"""
import csv
import os
import re
import subprocess
import sys
import tempfile

import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.join(HERE, "..", "..")
sys.path.insert(0, os.path.join(HERE, ".."))
from chart_tables import label_short_axis
RANGE, BINS, CUTOFF = 2.6, 250, 5.0
DURATION = 20.0
# name, dt, keywords
REFERENCE = ("split 2 reference", 0.004, "scheme split substeps 2")
SCHEMES = [("euler", dt, "scheme euler") for dt in (0.04, 0.02, 0.01, 0.005, 0.0025)]
SCHEMES += [(f"split {n}", n * h, f"scheme split substeps {n}") for n in (1, 2, 4, 10) for h in (0.04, 0.02)]


def lmp(**variables):
    """The log of in.gel."""
    with tempfile.NamedTemporaryFile() as log:
        words = [os.environ.get("LMP", os.path.join(ROOT, "build", "lmp")), "-in", "in.gel", "-log", log.name, "-screen", "none", "-nocite"]
        for name, value in variables.items():
            words += ["-var", name, str(value)]
        done = subprocess.run(words, cwd=HERE, env=dict(os.environ, OMP_NUM_THREADS="1"), check=False)
        with open(log.name) as f:
            text = f.read()
    return text if done.returncode == 0 else None


def run(scheme, start, seed, folder):
    """Number of pairs by distance (any unit), energy per colloid, processor seconds per unit of time; None if the run fails."""
    _, dt, keywords = scheme
    out = os.path.join(folder, "g")
    log = lmp(start=start, dt=dt, keywords=keywords, seed=seed, out=out, duration=DURATION)
    if log is None:
        return None
    with open(out) as f:
        table = np.array([line.split() for line in f if len(line.split()) == 4], float)
    loop, share = re.findall(r"^Loop time of (\S+)", log, re.M)[-1], re.findall(r"^(\S+)% CPU use", log, re.M)[-1]
    return table[:, 1], table[:, 2], np.loadtxt(out + ".energy")[:, 1].mean(), float(loop) * min(1.0, float(share) / 100.0) / DURATION


def errors(r, g, exact):
    near = r < RANGE
    pairs, exact_pairs = g * r**2, exact * r**2
    bonds = abs(pairs[near] / pairs[near].sum() - exact_pairs[near] / exact_pairs[near].sum()).sum()
    far = [v[~near].reshape(-1, 5).mean(1) for v in (g, exact)]
    return bonds, np.sqrt(np.mean((far[0] - far[1]) ** 2))


def moments(r, g):
    """Mean and variance of the distance of bound pairs in the well, r < 2.2."""
    near = r < 2.2
    p = (g * r**2)[near] / (g * r**2)[near].sum()
    mean = (p * r[near]).sum()
    return mean, (p * (r[near] - mean) ** 2).sum()


def main():
    seeds = int(sys.argv[1]) if len(sys.argv) > 1 else 3
    runs = [REFERENCE, ("split 2 other noise", *REFERENCE[1:])] + SCHEMES
    found = [[] for _ in runs]
    with tempfile.TemporaryDirectory() as folder:
        for seed in range(1, seeds + 1):
            start = os.path.join(folder, f"start{seed}")
            lmp(fresh=1, start=start, seed=seed)
            for k, scheme in enumerate(runs):
                found[k].append(run(scheme, start, 1000 * seed + 10 * k + 7, folder))
            report(runs, found)


def report(runs, found):
    r = found[0][0][0]
    exact = np.mean([f[1] for f in found[0]], axis=0)
    rows = []
    for (name, dt, _), f in zip(runs, found):
        if any(one is None for one in f):
            rows.append(dict(scheme=name, dt=dt, runs=len(f), cpu_ms_per_time="failed", bond_error="", g_error="", bond_variance="", energy=""))
            continue
        g = np.mean([one[1] for one in f], axis=0)
        bonds, rest = errors(r, g, exact)
        rows.append(dict(scheme=name, dt=dt, runs=len(f), cpu_ms_per_time=1e3 * float(np.median([one[3] for one in f])), bond_error=bonds,
                         g_error=rest, bond_variance=moments(r, g)[1], energy=float(np.mean([one[2] for one in f]))))
    with open(os.path.join(HERE, "gel.csv"), "w") as out:
        out.write("# made by bench/integrator/gel.py\n" + ",".join(rows[0]) + "\n")
        for row in rows:
            out.write(",".join(f"{v:.4g}" if isinstance(v, float) else str(v) for v in row.values()) + "\n")
            print("  ".join(f"{k} {v:.4g}" if isinstance(v, float) else f"{k} {v}" for k, v in row.items()), flush=True)
    print()
    plot()


def plot():
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    with open(os.path.join(HERE, "gel.csv")) as f:
        rows = [row for row in csv.DictReader(line for line in f if not line.startswith("#")) if row["cpu_ms_per_time"] != "failed"]
    for row in rows:
        for key in ("dt", "cpu_ms_per_time", "bond_error", "g_error"):
            row[key] = float(row[key])
    noise = rows[1]
    figure, axes = plt.subplots(1, 2, figsize=(8.6, 3.8))
    for axis, key, label in ((axes[0], "bond_error", "error of the distances of bound pairs"), (axes[1], "g_error", "error of g(r), 2.6 < r < 5")):
        for kind, marker in (("euler", "o-"), ("split", "s-")):
            some = [row for row in rows[2:] if row["scheme"].startswith(kind)]
            axis.plot([row["cpu_ms_per_time"] for row in some], [row[key] for row in some], marker if kind == "euler" else "s", label="scheme " + kind)
            for row in some:
                text = f"{row['dt']:g}" if kind == "euler" else f"{row['dt']:g}, n = {row['scheme'][6:]}"
                below = key == "bond_error" and text in ("0.08, n = 2", "0.2, n = 10")      # where two labels would overlap
                axis.annotate(text, (row["cpu_ms_per_time"], row[key]), fontsize=7, xytext=(0, -11) if below else (4, 4),
                              ha="center" if below else "left", textcoords="offset points")
        axis.axhline(noise[key], color="gray", ls=":", lw=1, label="two runs of the reference")
        axis.set_xscale("log")
        axis.set_yscale("log")
        axis.set_xlabel("processor time per unit of time [ms]; labels: dt")
        axis.set_ylabel(label)
        axis.margins(x=0.12)
        label_short_axis(axis.xaxis)
        label_short_axis(axis.yaxis)
    axes[0].legend(fontsize=8)
    figure.tight_layout()
    figure.savefig(os.path.join(HERE, "gel.png"), dpi=130)


if __name__ == "__main__":
    plot() if sys.argv[1:] == ["plot"] else main()
