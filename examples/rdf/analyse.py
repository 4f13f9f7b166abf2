#!/usr/bin/python3
"""g(r), energy and pressure of the suspension against Monte Carlo."""

import glob
import os
import re
import sys

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "common"))
import bdh_examples as ex

R_MIN, R_MAX = 1.85, 6.0             # below R_MIN there are too few pairs for Gaussian errors
NAME = re.compile(r"N(\d+)_(\w+)_dt([\d.]+)$")


def reference_scalars(path):
    """(energy per particle / kT, error), (PV/NkT, error): mean of the two samplers in the file's header."""
    found = {"energy": [], "Z": []}
    with open(path) as f:
        for line in f:
            if line.startswith("# MC") or line.startswith("# HMC"):
                for key, value, error in re.findall(r"'(energy|Z)[^']*': \[([\d.]+), ([\d.]+)\]", line):
                    found[key].append((float(value), float(error)))
    means = []
    for key in ("energy", "Z"):
        value, error = np.array(found[key]).T
        weight = 1 / error**2
        means.append((float((weight * value).sum() / weight.sum()), float(weight.sum() ** -0.5)))
    return means


def load_reference(count):
    path = f"reference_N{count}.csv"
    table = ex.read_csv(path)
    weight = [1 / np.maximum(table[c], 1e-9) ** 2 for c in ("g_err", "g_hmc_err")]
    total = weight[0] + weight[1]
    g = (weight[0] * table["g"] + weight[1] * table["g_hmc"]) / total
    return table["r"], g, total ** -0.5, reference_scalars(path)


def analyse(folder):
    count, scheme, dt = NAME.search(folder).groups()
    r_ref, g_ref, e_ref, scalars_ref = load_reference(count)
    _, blocks = ex.read_ave_time_vector(f"{folder}/gr.dat")
    r, g_blocks = blocks[0, :, 0], blocks[:, :, 1]
    g, error = ex.mean_and_error(g_blocks)
    used = (r > R_MIN) & (r < R_MAX)
    reference = np.interp(r, r_ref, g_ref)          # the bins are the same; interp only selects them
    e_reference = np.interp(r, r_ref, e_ref)
    z = ((g - reference) / np.maximum(np.hypot(error, e_reference), 1e-12))[used]
    scalars, scalar_error = ex.mean_and_error(ex.read_fix_print(f"{folder}/scalars.dat")[:, 1:])
    z_scalars = [(v - ref) / np.hypot(e, ref_e) for v, e, (ref, ref_e) in zip(scalars, scalar_error, scalars_ref)]
    return dict(folder=folder, count=int(count), scheme=scheme, dt=float(dt), r=r, g=g, error=error,
                reference=reference, used=used, z=z, blocks=len(g_blocks), g_blocks=g_blocks, scalars=scalars,
                scalar_error=scalar_error, scalars_ref=scalars_ref, z_scalars=z_scalars,
                peak=int(np.argmax(reference)))


def expected_chi2(blocks):
    """Mean of z^2 when the error is estimated from few blocks (Student's t)."""
    return (blocks - 1) / (blocks - 3)


def spread_of_chi2(result):
    """Standard deviation of chi2/bin.  Neighboring bins fluctuate together, which makes it larger: their squared
    correlations are estimated from the blocks, minus what independent bins would give."""
    n, bins = result["blocks"], int(result["used"].sum())
    single = 2 * (n - 1) ** 2 * (n - 2) / ((n - 3) ** 2 * (n - 5))          # variance of F(1, n-1)
    squares = np.corrcoef(result["g_blocks"][:, result["used"]].T) ** 2 - 1 / (n - 1)
    np.fill_diagonal(squares, 0.0)
    return float(np.sqrt(single / bins * (1 + max(0.0, squares.sum() / bins))))


def report(results):
    rows = []
    for q in results:
        k = q["peak"]
        rows.append([q["count"], q["scheme"], f"{q['dt']:g}", f"{np.mean(q['z']**2):.2f}",
                     f"{np.abs(q['z']).max():.1f}",
                     f"{100 * (q['g'][k] / q['reference'][k] - 1):+.2f}({100 * q['error'][k] / q['reference'][k]:.2f})",
                     ex.plus_minus(q["scalars"][0], q["scalar_error"][0]), f"{q['z_scalars'][0]:+.1f}",
                     ex.plus_minus(q["scalars"][1], q["scalar_error"][1]), f"{q['z_scalars'][1]:+.1f}"])
    print()
    ex.print_table(["N", "scheme", "dt", "chi2/bin", "max |z|", "peak of g, %", "energy/kT", "z", "PV/NkT", "z"], rows)
    for count in sorted({q["count"] for q in results}):
        (e, de), (p, dp) = reference_scalars(f"reference_N{count}.csv")
        print(f"  Monte Carlo, N = {count}: energy/kT {ex.plus_minus(e, de)}, PV/NkT {ex.plus_minus(p, dp)}")
    print(f"  chi2/bin: {R_MIN} < r < {R_MAX}, {results[0]['used'].sum()} bins; "
          f"{expected_chi2(results[0]['blocks']):.2f} expected for errors from {results[0]['blocks']} blocks")


def verdict(results):
    """The improved scheme is second-order in the forces, so its bias is far below these error bars."""
    tested = [q for q in results if q["scheme"] == "improved"]
    if not tested:
        return
    sigmas = [(np.mean(q["z"] ** 2) - expected_chi2(q["blocks"])) / spread_of_chi2(q) for q in tested]
    scalars = max(abs(z) for q in tested for z in q["z_scalars"])
    good = max(sigmas) < 3.5 and scalars < 3.3
    print("verdict: improved scheme, chi2/bin " + " and ".join(f"{s:+.1f}" for s in sigmas)
          + " standard deviations from its expectation,\n"
          f"  energy and pressure within {scalars:.1f} standard errors: "
          + ("agrees with Monte Carlo" if good else "DIFFERS from Monte Carlo by more than chance explains")
          + "\n  midpoint is first-order in the forces: its bias is proportional to dt")


def plot(results):
    plt = ex.pyplot()
    counts = sorted({q["count"] for q in results})
    figure, axes = plt.subplots(2, len(counts), figsize=(4.6 * len(counts), 5.6), sharex=True, squeeze=False,
                                gridspec_kw={"height_ratios": [2.2, 1], "hspace": 0.08, "wspace": 0.2})
    for column, count in enumerate(counts):
        top, bottom = axes[:, column]
        mine = [q for q in results if q["count"] == count]
        top.plot(mine[0]["r"], mine[0]["reference"], color="black", lw=1, label="Monte Carlo")
        for q, color, marker in zip(mine, ex.COLORS, "osD^v"):
            label = f"{q['scheme']}, dt = {q['dt']:g}"
            top.plot(q["r"], q["g"], marker, ms=3, color=color, mfc="none", mew=0.8, label=label)
            bottom.errorbar(q["r"], q["g"] - q["reference"], q["error"], fmt=marker, ms=2.5, color=color, mfc="none",
                            mew=0.7, lw=0.6)
        bottom.axhline(0, color="black", lw=1)
        top.set_title(f"N = {count}")
        top.legend()
        bottom.set_xlabel("r")
        bottom.set_xlim(1.6, R_MAX)
    axes[0, 0].set_ylabel("g(r)")
    axes[1, 0].set_ylabel("g - Monte Carlo")
    ex.save(figure, "results/rdf.png")


def main():
    folders = sorted((f for f in glob.glob("results/N*") if NAME.search(f) and os.path.exists(f"{f}/scalars.dat")),
                     key=lambda f: (int(NAME.search(f)[1]), NAME.search(f)[2], float(NAME.search(f)[3])))
    if not folders:
        ex.fail("no results: run ./run.sh first")
    results = [analyse(f) for f in folders]
    report(results)
    plot(results)
    verdict(results)


if __name__ == "__main__":
    main()
