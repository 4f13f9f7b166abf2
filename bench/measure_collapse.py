#!/usr/bin/python3
"""Error of a physical result, the collapse time of the cluster of examples/cluster, and its cost: CSV on standard output.

    measure_collapse.py path/to/lmp path/to/bench_schemes        3 to 5 minutes of processor time

The collapse time is the time at which the mean radius of gyration of all trajectories is halfway from that of the start to
that of the compact cluster.  The reference is dense-matrix Brownian dynamics in free space (dense_collapse.csv, made by
bench_schemes).

Runs with the same time step and splitting share their seeds, and hence their random numbers, except for the modes that a
looser tolerance leaves out.  `change` and its standard error compare trajectory by trajectory with the tightest of these
tolerances, which is more precise than the scatter of the ensemble allows.  If the mean does not get halfway within a run,
`error` is a lower bound.  Cost: processor time of the steps per unit of time.  The standard error of the collapse time is
that of the mean at that time over the slope of the mean.
"""
import os
import re
import resource
import subprocess
import sys
import tempfile

import numpy as np

HERE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "integrator")
COMPACT = 5.197          # mean radius of gyration of the compact cluster, reference_Rg.csv without interactions
PSE = "radius 3.2 fft estimate tolerance {} {}"
FIB = "radius 3.2 fft estimate kernel {}"
TOLERANCES = ("1e-6", "1e-4", "1e-3", "1e-2", "3e-2", "1e-1")
COMMON_XI = "xi 0.1"     # with the same splitting, the noise differs only by the modes that are left out

# method, setting, dt, trajectories, variables of in.collapse
RUNS = [("bd/pse, euler", tolerance, 0.05, 512, dict(keywords=PSE.format(tolerance, COMMON_XI), duration=8)) for tolerance in TOLERANCES]
RUNS += [("bd/pse, euler", "1e-3", 0.01, 512, dict(keywords=PSE.format("1e-3", COMMON_XI), duration=8)),
         ("bd/pse, euler", "1e-3, cheapest xi", 0.05, 512, dict(keywords=PSE.format("1e-3", "xi 0.0508"), duration=8))]
# the splitting parameters that xi auto chooses, given as numbers because planning takes longer than a trajectory
RUNS += [("bd/pse, split", f"1e-3, {n} substeps", 0.05 * n, 512,
          dict(keywords=PSE.format("1e-3", f"xi {xi} scheme split substeps {n}"), duration=8)) for n, xi in ((4, 0.0635), (10, 0.0734), (20, 0.0635))]
# boxes in which the grid has the requested radius
RUNS += [(f"bd/fib, {scheme}", kernel, 0.05, 24, dict(style="bd/fib", keywords=FIB.format(kernel) + f" scheme {scheme}", half=half, duration=20))
         for scheme, kernel, half in (("midpoint", "roma3", 42.35184), ("midpoint", "peskin4", 40.81632653), ("midpoint", "bkp6", 39.2237),
                                      ("improved", "peskin4", 40.81632653))]
RUNS += [("no hydrodynamics", "fix brownian", 0.005, 512, dict(style="brownian", duration=1, interval=0.02))]
DENSE = [(0.05, 1024)]


def half_time(time, mean):
    """When the mean curve is halfway down, and its slope there; nan if it does not get there."""
    level = 0.5 * (mean[0] + COMPACT)
    below = np.nonzero(mean < level)[0]
    if not len(below):
        return np.nan, np.nan
    k = below[0]
    slope = (mean[k] - mean[k - 1]) / (time[k] - time[k - 1])
    return time[k] + (level - mean[k]) / slope, slope


def at_time(curves, time, t):
    """Value of each trajectory at time t."""
    k = min(int(np.searchsorted(time, t)), len(time) - 1)
    share = (t - time[k - 1]) / (time[k] - time[k - 1])
    return (1 - share) * curves[:, k - 1] + share * curves[:, k]


def run(lmp, dt, trajectories, variables):
    """Times, radii of gyration [trajectory, time], processor seconds of the steps per unit of time."""
    with tempfile.TemporaryDirectory() as folder:
        words = [os.path.abspath(lmp), "-in", "in.collapse", "-log", os.path.join(folder, "log"), "-screen", "none", "-nocite"]
        for name, value in dict(dt=dt, trajectories=trajectories, out=folder, bonds_from=1000, **variables).items():
            words += ["-var", name, str(value)]
        subprocess.run(words, cwd=HERE, check=True, env=dict(os.environ, OMP_NUM_THREADS="1"))
        with open(os.path.join(folder, "log")) as f:
            log = f.read()
        curves = [np.loadtxt(os.path.join(folder, name)) for name in sorted(os.listdir(folder)) if name.startswith("rg.")]
    loops, shares = re.findall(r"^Loop time of (\S+)", log, re.M), re.findall(r"^(\S+)% CPU use", log, re.M)
    seconds = sum(float(t) * min(1.0, float(p) / 100.0) for t, p in zip(loops, shares))
    return curves[0][:, 0], np.array([c[:, 1] for c in curves]), seconds / (trajectories * variables["duration"])


def dense_run(program, dt, trajectories):
    """Collapse time and its standard error, and processor seconds per unit of time, for dense matrices."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    text = subprocess.run([program, "em", str(dt), "0.5", str(trajectories), "8"], check=True, capture_output=True, text=True,
                          env=dict(os.environ, OMP_NUM_THREADS="1")).stdout
    seconds = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before
    table = np.array([line.split()[1:] for line in text.splitlines() if line.startswith("A ")], float)
    t, slope = half_time(table[:, 0], table[:, 1])
    return t, at_time(table[None, :, 2], table[:, 0], t)[0] / -slope, seconds / (8 * trajectories)


def truth():
    table = np.loadtxt(os.path.join(HERE, "dense_collapse.csv"), delimiter=",", skiprows=2)
    t, slope = half_time(table[:, 0], table[:, 1])
    return t, at_time(table[None, :, 2], table[:, 0], t)[0] / -slope


def main():
    lmp, dense_program = sys.argv[1:]
    exact, exact_error = truth()
    print("method,setting,dt,trajectories,ms_per_time,collapse_time,standard_error,error,error_se,change,change_se")

    def row(method, setting, dt, trajectories, seconds, t, standard_error, change=("", "")):
        words = [f"> {t:g}", "", f"{t / exact - 1:.4f}", ""]
        if standard_error is not None:
            words = [f"{t:.4f}", f"{standard_error:.4f}", f"{t / exact - 1:.4f}",
                     f"{t / exact * np.hypot(standard_error / t, exact_error / exact):.4f}"]
        print(f'"{method}","{setting}",{dt:g},{trajectories},{1e3 * seconds:.4g},' + ",".join([*words, *change]), flush=True)

    row("dense matrices, reference", "free space", 0.005, "", np.nan, exact, exact_error)
    for dt, trajectories in DENSE:
        t, error, seconds = dense_run(dense_program, dt, trajectories)
        row("dense matrices, euler", "Cholesky", dt, trajectories, seconds, t, error)
    tightest = None
    for method, setting, dt, trajectories, variables in RUNS:
        time, curves, seconds = run(lmp, dt, trajectories, variables)
        t, slope = half_time(time, curves.mean(0))
        if np.isnan(t):
            row(method, setting, dt, trajectories, seconds, time[-1], None)
            continue
        change = ("", "")
        if COMMON_XI in variables.get("keywords", "") and dt == 0.05:
            tightest = curves if tightest is None else tightest
            pairs = at_time(curves, time, t) - at_time(tightest, time, t)
            change = (f"{t / half_time(time, tightest.mean(0))[0] - 1:.4f}", f"{pairs.std(ddof=1) / np.sqrt(len(pairs)) / -slope / t:.4f}")
        row(method, setting, dt, trajectories, seconds, t, at_time(curves, time, t).std(ddof=1) / np.sqrt(len(curves)) / -slope, change)


if __name__ == "__main__":
    main()
