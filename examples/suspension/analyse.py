#!/usr/bin/python3
"""Velocities of hard spheres against a dense mobility matrix, and diffusion from short to long times against theory."""

import glob
import os
import re
import sys

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "common"))
import bdh_examples as ex

PHI = ("0.1", "0.3")
D0 = 1 / (6 * np.pi)                 # kT = viscosity = radius = 1
TOLERANCE = 1e-3                     # of the diffusion runs
GOAL = 1.0                           # largest error / tolerance


# ---- velocities under given forces -----------------------------------------------------------------------------------

def reference(phi):
    """Velocities under the forces in the data file, U/U0 under equal forces, side of the box."""
    path = f"reference_phi{phi}.csv"
    table = ex.read_csv(path)
    text = open(path).read()
    equal = [float(w) for w in re.search(r"along x, y, z = (.*)", text)[1].split()]
    return np.column_stack([table[c] for c in ("ux", "uy", "uz")]), np.array(equal), float(re.search(r"box (\S+)", text)[1])


def errors(phi, folder):
    """Relative errors of the velocities under random forces and of the mean velocity under equal ones."""
    u_ref, equal_ref, _ = reference(phi)
    last = ex.read_dump(f"{folder}/velocities")[-1][1]
    u = np.column_stack([last[c] for c in ("vx", "vy", "vz")])
    equal = ex.read_fix_print(f"{folder}/sedimentation")[:, 1]
    return (np.linalg.norm(u - u_ref) / np.linalg.norm(u_ref),
            np.linalg.norm(equal - equal_ref) / np.linalg.norm(equal_ref), equal)


def velocities():
    """Prints the table; returns {phi: [tolerance, error random, error equal]}."""
    found, rows = {}, []
    for phi in PHI:
        folders = glob.glob(f"results/mobility_phi{phi}_*")
        if not folders:
            ex.fail("no results: run ./run.sh first")
        table = []
        for folder in sorted(folders, key=lambda f: -float(f.rsplit("_", 1)[1])):
            asked = float(folder.rsplit("_", 1)[1])
            random, same, equal = errors(phi, folder)
            table.append((asked, random, same))
            rows.append([phi, f"{asked:g}", f"{random:.2e}", f"{random / asked:.2f}", f"{same:.2e}", f"{same / asked:.3f}",
                         f"{equal.mean():.9f}"])
        found[phi] = np.array(table)
    print("\nvelocities of 500 hard spheres, relative error against the dense matrix")
    ex.print_table(["phi", "tolerance", "random forces", "/tolerance", "equal forces", "/tolerance", "U/U0"], rows)
    for phi in PHI:
        print(f"  reference, phi = {phi}: U/U0 = {reference(phi)[1].mean():.9f}")
    return found


# ---- diffusion -------------------------------------------------------------------------------------------------------

def series(length):
    """Self mobility of a Rotne-Prager-Yamakawa sphere of radius 1 in a periodic cube, in units of that of a single sphere."""
    return 1 - 2.837297479480619 / length + 4 * np.pi / 3 / length**3


def path(folder):
    """Times and unwrapped positions [frame, particle, 3]; side of the box."""
    with open(f"{folder}/path.dump") as f:
        head = [next(f) for _ in range(6)]
    low, high = (float(w) for w in head[5].split())
    frames = ex.read_dump(f"{folder}/path.dump")
    x = np.array([np.column_stack([t[c] for c in ("xu", "yu", "zu")]) for _, t in frames])
    return 0.01 * np.array([step - frames[0][0] for step, _ in frames]), x, high - low


def diffusion_at(x, lag):
    """Mean of |dx|^2/6 over particles and origins, without the motion of the center, and its standard error.

    Origins are grouped into segments of at least three lags; at most 20 segments."""
    d = x[lag:] - x[:-lag]
    square = ((d - d.mean(1, keepdims=True)) ** 2).sum(2).mean(1) * x.shape[1] / (x.shape[1] - 1) / 6
    pieces = min(20, len(square) // (3 * lag))
    if pieces < 3:
        return None
    return ex.mean_and_error(ex.block_means(square, pieces))


def diffusion():
    found = {}
    for phi in PHI:
        for mobility in ("pse", "none"):
            folder = f"results/path_phi{phi}_{mobility}"
            time, x, length = path(folder)
            if len(time) < 40:
                ex.fail("too few steps for diffusion: at least STEPS=1000")
            lags = np.unique(np.round(np.geomspace(1, len(time) // 9, 24)).astype(int))
            points = [(time[lag], *r) for lag in lags if (r := diffusion_at(x, lag)) is not None]
            t, msd, error = np.array(points).T
            one = None
            if mobility == "pse":
                one = ex.mean_and_error(ex.read_fix_print(f"{folder}/one_step.dat")[:, 1])
            found[phi, mobility] = dict(time=t, ratio=msd / t / D0, error=error / t / D0, one=one, length=length,
                                        count=x.shape[1])
    rows, worst = [], 0.0
    for phi in PHI:
        q = found[phi, "pse"]
        (value, error), theory = q["one"], series(q["length"])
        z = (value - theory) / error
        allowed = np.hypot(error, TOLERANCE * theory)
        worst = max(worst, abs(value - theory) / allowed)
        late = [found[phi, m] for m in ("pse", "none")]
        at = [int(np.argmin(abs(r["time"] - 0.5 / D0))) for r in late]
        rows.append([phi, q["count"], ex.plus_minus(value, error), f"{theory:.5f}", f"{z:+.1f}",
                     f"{100 * (value / theory - 1):+.3f}"]
                    + [ex.plus_minus(r["ratio"][k], r["error"][k]) for r, k in zip(late, at)])
    print("\ndiffusion, D/D0: from the noise of single steps against theory, and from displacements over a time of 3 pi")
    ex.print_table(["phi", "N", "one step", "theory", "z", "%", "t = 3 pi, with HI", "t = 3 pi, without"], rows)
    return found, worst


def plot(errors_found, found):
    plt = ex.pyplot()
    figure, (left, right) = plt.subplots(1, 2, figsize=(10, 3.9), gridspec_kw={"wspace": 0.26})
    for phi, marker, color in zip(PHI, "os", ex.COLORS):
        table = errors_found[phi]
        left.loglog(table[:, 0], table[:, 1], marker + "-", color=color, label=f"phi = {phi}, random forces")
        left.loglog(table[:, 0], table[:, 2], marker + ":", color=color, mfc="white", label=f"phi = {phi}, equal forces")
    ends = np.array([1e-9, 1e-1])
    left.loglog(ends, ends, color="black", lw=0.8, label="as asked for")
    left.set_xlabel("tolerance")
    left.set_ylabel("relative error of the velocities")
    left.legend(fontsize=8)
    for phi, color in zip(PHI, ex.COLORS):
        for mobility, fill, title in (("pse", color, "with HI"), ("none", "white", "without")):
            q = found[phi, mobility]
            right.errorbar(q["time"] * D0, q["ratio"], q["error"], fmt="o", ms=3.5, color=color, mfc=fill,
                           ls="-" if mobility == "pse" else ":", lw=0.8, label=f"phi = {phi}, {title}")
        right.axhline(series(found[phi, "pse"]["length"]), color=color, lw=0.8, ls="--")
    right.axhline(1, color="black", lw=0.8, ls="--")
    right.set_xscale("log")
    right.set_xlabel("time / (6 pi viscosity a^3/kT)")
    right.set_ylabel("mean square displacement / 6 D0 t")
    right.legend(fontsize=8)
    ex.save(figure, "results/suspension.png")


def main():
    errors_found = velocities()
    found, worst = diffusion()
    print()
    plot(errors_found, found)
    ratio = max((t[:, 1:] / t[:, :1]).max() for t in errors_found.values())
    print(f"largest error of a velocity: {ratio:.2f} of the tolerance; short-time diffusion within {worst:.1f} of its\n"
          f"allowance (standard error and tolerance, added in squares)")
    good = ratio <= GOAL and worst < 3.3
    print("verdict: " + ("the tolerance holds, and short-time diffusion agrees with theory" if good else
                         "DIFFERS from the reference by more than the tolerance and chance explain"))


if __name__ == "__main__":
    main()
