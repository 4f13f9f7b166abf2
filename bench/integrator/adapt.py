#!/usr/bin/python3
"""Steps that choose themselves against fixed ones: error and cost.  adapt.csv and adapt.png.

    bench/integrator/adapt.py gel [seeds]      bonds of a gel (in.gel), default 2 seeds
    bench/integrator/adapt.py random           a gel from random positions: pieces a step while it forms (adapt_random.csv)
    bench/integrator/adapt.py wca              energy, and g(r) at contact, of the suspension of ../in.stability_wca, N = 1000
    bench/integrator/adapt.py cluster [n]      bonds and half time of the collapsing cluster (in.collapse), default 384 trajectories
    bench/integrator/adapt.py order            where tolerances lead on one Brownian path (in.adapt_order): adapt_order.csv
    bench/integrator/adapt.py plot             draws adapt.csv again

Each part replaces its own rows of adapt.csv.  Cost: processor time of the steps per unit of time, and pieces per unit of
time, which do not depend on the machine.  Environment: LMP=file uses another executable.
"""
import csv
import os
import re
import resource
import subprocess
import sys
import tempfile

import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.join(HERE, "..", "..")
sys.path[:0] = [HERE, os.path.join(HERE, "..")]
import collapse
import gel
from chart_tables import label_short_axis

LMP = os.path.realpath(os.environ.get("LMP", os.path.join(ROOT, "build", "lmp")))
FIELDS = ("scene", "kind", "dt", "adapt", "pieces_per_time", "cpu_ms_per_time", "error", "standard_error")
MONTE_CARLO = 0.08185      # energy of a particle over kT, N = 1000
GROUPS = 16                # of trajectories, for standard errors
HALF_WAY = 6.006           # radius of gyration of the cluster between its beginning and t = 100
EXACT_VARIANCE = 0.0283    # of the cluster's bonds, see bench/README.md
# kind, time step, keywords, tolerance of adapt
GEL = ([("euler", dt, "", "") for dt in (0.02, 0.01, 0.005)] + [("split", dt, "scheme split substeps 1", "") for dt in (0.04, 0.02)]
       + [("euler", 0.1, "", a) for a in (0.05, 0.02)] + [("split", 0.1, "scheme split substeps 1", a) for a in (0.2, 0.1, 0.05)])
CLUSTER = ([("euler", 0.05, "", ""), ("euler", 0.01, "", "")] + [("split 10", dt, "scheme split substeps 10", "") for dt in (0.5, 0.25)]
           + [("euler", 0.5, "", a) for a in (0.05, 0.02)] + [("split auto", 0.5, "scheme split substeps auto", a) for a in (0.2, 0.1, 0.05)])
WCA = [("midpoint", dt, "", "") for dt in (100, 50, 25)] + [("midpoint", 400, "", a) for a in (0.2, 0.1, 0.05, 0.02)]


def run(deck, folder, **variables):
    """The log of a deck, and processor seconds.  None for a run that failed."""
    log = os.path.join(folder, "log")
    words = [LMP, "-in", os.path.basename(deck), "-log", log, "-screen", "none", "-nocite"]
    for name, value in variables.items():
        words += ["-var", name, str(value)]
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    done = subprocess.run(words, cwd=os.path.dirname(deck), env=dict(os.environ, OMP_NUM_THREADS="1"), check=False)
    with open(log) as f:
        text = f.read()
    return (text if done.returncode == 0 else None), resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before


def keywords(words, adapt):
    return (words or "scheme euler") + (f" adapt {adapt}" if adapt else "")


def pieces(log):
    """Pieces a step in the last run of a log."""
    found = re.findall(r"adapt: (\S+) (?:pieces|near steps) a step", log)
    return float(found[-1]) if found else 1.0


def row(scene, kind, dt, adapt, found, cpu, error, standard_error):
    return dict(zip(FIELDS, (scene, kind, dt, adapt, found / dt, 1e3 * cpu, error, standard_error)))


def gel_rows(seeds):
    """Errors of the bonds, as in gel.py."""
    deck, rows = os.path.join(HERE, "in.gel"), []
    with tempfile.TemporaryDirectory() as folder:
        out = os.path.join(folder, "g")

        def once(seed, kind, dt, words, adapt):
            start = os.path.join(folder, f"start{seed}")
            if not os.path.exists(start):
                run(deck, folder, fresh=1, start=start, seed=seed)
            log, cpu = run(deck, folder, start=start, dt=dt, keywords=keywords(words, adapt), seed=1000 * seed + 7, out=out, duration=gel.DURATION)
            if log is None:
                return None
            with open(out) as f:
                table = np.array([line.split() for line in f if len(line.split()) == 4], float)
            return table[:, 1], table[:, 2], pieces(log), cpu / gel.DURATION

        reference = [once(s, *gel.REFERENCE[:2], gel.REFERENCE[2], "") for s in range(1, seeds + 1)]
        r, exact = reference[0][0], np.mean([one[1] for one in reference], axis=0)
        for case in GEL:
            kind, dt, _, adapt = case
            some = [once(s, *case) for s in range(1, seeds + 1)]
            if None in some:
                rows.append(row("gel", kind, dt, adapt, 1.0, float("nan"), float("nan"), float("nan")))
                continue
            error = gel.errors(r, np.mean([one[1] for one in some], axis=0), exact)[0]
            rows.append(row("gel", kind, dt, adapt, np.mean([one[2] for one in some]), np.mean([one[3] for one in some]), error, 0.010))
            print(rows[-1], flush=True)
    return rows


def reference_table(*path):
    """The columns of a reference file, by name."""
    with open(os.path.join(ROOT, *path)) as f:
        return np.genfromtxt((line for line in f if not line.startswith("#")), delimiter=",", names=True)


def mean_and_error(values, exact):
    """Relative difference of the mean of independent values from the exact one, and its standard error."""
    return np.mean(values) / exact - 1, np.std(values) / np.sqrt(len(values) - 1) / exact


def at_contact(r, g):
    """Pairs near contact, 1.88 to 2.12, up to a factor."""
    near = (r > 1.88) & (r < 2.12)
    return (g * r**2)[..., near].sum(-1)


def wca_rows():
    """Against Monte Carlo."""
    deck, rows, contacts = os.path.join(HERE, "..", "in.stability_wca"), [], []
    table = reference_table("unittest", "reference", "rdf_wca_N1000.csv")
    exact = at_contact(table["r"], table["g"])
    with tempfile.TemporaryDirectory() as folder:
        begin, out = os.path.join(folder, "begin"), os.path.join(folder, "wca")
        run(deck, folder, fresh=1, N=1000, out=begin)
        for kind, dt, _, adapt in WCA:
            steps = 160000 // dt
            log, cpu = run(deck, folder, start=begin + ".data", N=1000, scheme=kind, dt=dt, steps=steps, adapt=adapt or "no", contact=1, out=out)
            if log is None:
                rows.append(row("wca", kind, dt, adapt, 1.0, float("nan"), float("nan"), float("nan")))
                continue
            cost = pieces(log), cpu / ((1.25 * steps + 100) * dt)
            rows.append(row("wca", kind, dt, adapt, *cost, *mean_and_error(np.loadtxt(out + ".energy", ndmin=2)[:, 1], MONTE_CARLO)))
            with open(out + ".gr") as f:
                blocks = np.array([line.split() for line in f if len(line.split()) == 4], float).reshape(-1, 60, 4)
            contacts.append(row("contact", kind, dt, adapt, *cost, *mean_and_error(at_contact(blocks[0, :, 1], blocks[:, :, 2]), exact)))
            print(rows[-1], contacts[-1], flush=True)
    return rows + contacts


def half_time(time, radius):
    """Time at which the radius of gyration has first gone half its way."""
    k = np.argmax(radius < HALF_WAY)
    return time[k - 1] + (time[k] - time[k - 1]) * (radius[k - 1] - HALF_WAY) / (radius[k - 1] - radius[k])


def half_time_rows(cost, time, curves):
    """Error of the half time of the mean curve against the reference, whose own error is 3 %.  Standard error: jackknife over groups."""
    table = reference_table("examples", "cluster", "reference_Rg.csv")
    exact, curves = half_time(table["t"], table["Rg_bound_mean_HI"]), np.array(curves)
    without = np.array([half_time(time, np.delete(curves, part, axis=0).mean(0)) for part in np.array_split(np.arange(len(curves)), GROUPS)])
    error = np.sqrt((GROUPS - 1) * np.var(without))
    return [row("half time", *cost, half_time(time, curves.mean(0)) / exact - 1, error / exact)]


def cluster_rows(trajectories):
    """Excess of the variance of bonds.  Processor times would be those of the setups."""
    deck, rows, half_times = os.path.join(HERE, "in.collapse"), [], []
    for kind, dt, words, adapt in CLUSTER:
        with tempfile.TemporaryDirectory() as folder:
            log, _ = run(deck, folder, dt=dt, keywords="radius 3.2 tolerance 1e-3 fft estimate " + keywords(words, adapt), seed=5000,
                           trajectories=trajectories, out=folder)
            data = dict(bonds=[], curve=[])
            collapse.collect(folder, data)
        variances = []
        for part in np.array_split(np.array(data["bonds"]), 8):
            shape, well = part.sum(0), data["r"] < 6.3
            middle = (shape * data["r"])[well].sum() / shape[well].sum()
            variances.append((shape * (data["r"] - middle) ** 2)[well].sum() / shape[well].sum() / EXACT_VARIANCE - 1)
        found = np.mean([float(v) for v in re.findall(r"adapt: (\S+) ", log)]) if adapt else float(kind.split()[-1]) if "split" in kind else 1.0
        cost = kind, dt, adapt, found, float("nan")
        rows.append(row("cluster", *cost, np.mean(variances), np.std(variances) / np.sqrt(7)))
        half_times += half_time_rows(cost, data["time"], data["curve"])
        print(rows[-1], half_times[-1], flush=True)
    return rows + half_times


def random_start():
    """Pieces a step as a gel forms from random positions."""
    with tempfile.TemporaryDirectory() as folder:
        log, _ = run(os.path.join(HERE, "in.gel_random"), folder)
    rows = re.findall(r"^ *(\d+) +(\S+) +(\S+) +(\S+) *$", log, re.M)
    with open(os.path.join(HERE, "adapt_random.csv"), "w") as f:
        f.write("# made by bench/integrator/adapt.py random\ntime,energy,pieces,taken_back\n")
        f.writelines(f"{int(step) * 0.1:.4g},{energy},{number},{back}\n" for step, energy, number, back in rows)


def order():
    """Distances, in radii, between the ends of runs on one Brownian path."""
    ends = {}
    with tempfile.TemporaryDirectory() as folder:
        begin, out = os.path.join(folder, "begin"), os.path.join(folder, "end")
        run(os.path.join(HERE, "..", "in.stability_wca"), folder, fresh=1, N=1000, out=begin)
        for tolerance in (0.4, 0.2, 0.1, 0.05, 0.02, 0.001):
            log, _ = run(os.path.join(HERE, "in.adapt_order"), folder, start=begin + ".data", adapt=tolerance, out=out)
            ends[tolerance] = pieces(log), np.loadtxt(out, skiprows=9)[:, 1:]
    finest = ends.pop(min(ends))
    with open(os.path.join(HERE, "adapt_order.csv"), "w") as f:
        f.write("# made by bench/integrator/adapt.py order\ntolerance,pieces_per_step,rms_distance_from_finest\n")
        for tolerance, (number, x) in ends.items():
            f.write(f"{tolerance},{number:.4g},{np.sqrt(((x - finest[1]) ** 2).sum(1).mean()):.3g}\n")


def read():
    path = os.path.join(HERE, "adapt.csv")
    if not os.path.exists(path):
        return []
    with open(path) as f:
        return list(csv.DictReader(line for line in f if not line.startswith("#")))


def write(rows):
    with open(os.path.join(HERE, "adapt.csv"), "w") as f:
        f.write("# made by bench/integrator/adapt.py\n" + ",".join(FIELDS) + "\n")
        for one in rows:
            f.write(",".join(f"{v:.4g}" if isinstance(v, float) else str(v) for v in (one[k] for k in FIELDS)) + "\n")


def plot():
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    titles = {"wca": "WCA: energy", "contact": "WCA: g(r) at contact", "gel": "gel: distances of bound pairs",
              "cluster": "cluster: variance of bonds", "half time": "cluster: half time of the collapse"}
    figure, axes = plt.subplots(2, 3, figsize=(11.5, 7.2))
    axes[1, 2].set_visible(False)
    for axis, (scene, title) in zip(axes.flat, titles.items()):
        rows = [r for r in read() if r["scene"] == scene and r["error"] != "nan"]
        for kind in sorted({r["kind"] for r in rows}):
            for adapt, marker in ((False, "o-"), (True, "s--")):
                some = [r for r in rows if r["kind"] == kind and bool(r["adapt"]) == adapt]
                if not some:
                    continue
                cost = [float(r["pieces_per_time"]) for r in some]
                axis.errorbar(cost, [abs(float(r["error"])) for r in some], [float(r["standard_error"]) for r in some], fmt=marker, lw=1, ms=4,
                              capsize=2, label=kind + (", adapt" if adapt else ""))
                for c, r in zip(cost, some):
                    axis.annotate(r["adapt"] or r["dt"], (c, abs(float(r["error"]))), fontsize=7, xytext=(3, 4), textcoords="offset points")
        axis.set_xscale("log")
        axis.set_ylim(bottom=0)
        axis.set_title(title, fontsize=9)
        axis.set_xlabel("steps, near steps or pieces per unit of time", fontsize=8)
        label_short_axis(axis.xaxis)
        axis.legend(fontsize=7)
    for row_of_axes in axes:
        row_of_axes[0].set_ylabel("error")
    figure.suptitle("labels: time step, or tolerance of adapt; bars: one standard error", fontsize=9)
    figure.tight_layout()
    figure.savefig(os.path.join(HERE, "adapt.png"), dpi=130)


def main():
    part, number = sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else None
    if part in ("random", "order"):
        (order if part == "order" else random_start)()
    elif part != "plot":
        rows = {"gel": lambda: gel_rows(number or 2), "wca": wca_rows, "cluster": lambda: cluster_rows(number or 384)}[part]()
        write([r for r in read() if r["scene"] not in {new["scene"] for new in rows}] + rows)
    if part not in ("random", "order"):
        plot()


if __name__ == "__main__":
    main()
