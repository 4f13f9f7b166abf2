#!/usr/bin/python3
"""Time correlations of trapped particles in shear flow against linear theory, continuous and discrete in time."""

import glob
import json
import os
import sys

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "common"))
import bdh_examples as ex

BLOCK = 10.0                         # length of the blocks for error bars [tau]
RANGE = 3.0                          # longest plotted lag [tau]
TESTED = {"single": (0.0, 0.65, 1.5), "pair": (0.0, 1.5)}      # tested lags [tau]
SCHEME_IN_CSV = {"midpoint": "simple", "improved": "improved"}


# ---- simulations -----------------------------------------------------------------------------------------------------

class Simulation:
    """Paths [copy][time, coordinate] of one folder, and the correlations of blocks of them."""

    def __init__(self, folder):
        self.kind, self.scheme, self.step = os.path.basename(folder).split("_")
        self.step = float(self.step)
        with open(sorted(glob.glob(f"{folder}/step_every_tau.*"))[0]) as f:
            _, every, self.tau = (float(w) for w in f.read().split())
        self.spacing = self.step * every                    # of the samples [tau]
        self.paths = [ex.read_fix_print(p) for p in sorted(glob.glob(f"{folder}/path.*"))]
        self.lags = np.arange(round(RANGE / self.spacing) + 1)
        self.time = self.lags * self.spacing

    def correlation(self, a, b):
        """<a(t+lag) b(t)> by block [block, lag]; a, b: coordinates."""
        blocks = []
        for path in self.paths:
            usable = len(path) - self.lags[-1]
            count = int(usable * self.spacing / BLOCK)
            if count < 1:
                ex.fail(f"the run is too short: it must be longer than {RANGE + BLOCK:g} tau on each core")
            products = np.stack([path[lag:lag + usable, a] * path[:usable, b] for lag in self.lags], axis=1)
            blocks.append(ex.block_means(products, count))
        return np.concatenate(blocks)

    def tested_lags(self):
        return [int(np.argmin(abs(self.time - t))) for t in TESTED[self.kind]]


# ---- linear theory, discrete in time ---------------------------------------------------------------------------------

def discrete_correlations(scheme, mobility, k, shear, kT, dt, lags):
    """<q(lag) q(0)^T> [lag, i, j] of q' = -k M q + G q + noise under a scheme of the package."""
    size = len(mobility)
    one = np.eye(size)
    root = np.linalg.cholesky(mobility)
    if scheme == "midpoint":         # (33)-(35): v = -k M q + noise; q1 = q + dt (v + G (q + dt/2 (v + G q)))
        gain = one + 0.5 * dt * shear
        step = one + dt * gain @ (shear - k * mobility)
        noise = np.sqrt(2 * kT * dt) * gain @ root
    else:                            # (38): all at q1/2 = q + dt/2 (v + G q); noise of the two halves
        drift = shear - k * mobility
        half = one + 0.5 * dt * drift
        step = one + dt * drift @ half
        first = np.sqrt(kT * dt) * (one + dt * drift) @ root
        noise = np.hstack([first, np.sqrt(kT * dt) * root])
    flat = np.linalg.solve(np.eye(size**2) - np.kron(step, step), (noise @ noise.T).ravel())
    covariance = flat.reshape(size, size)
    powers = [covariance]
    for _ in range(int(max(lags))):
        powers.append(step @ powers[-1])
    return np.array([powers[int(lag)] for lag in lags])


# ---- comparison ------------------------------------------------------------------------------------------------------

def test(simulation, blocks, theory):
    """chi2 of all tested numbers together, its degrees of freedom and probability; blocks, theory: by name."""
    at = simulation.tested_lags()
    columns, expected = [], []
    for name in blocks:
        for lag in at:
            if lag == at[0] and name in ("Cyx", "y1_x1", "y2_x1"):
                continue                                    # the same number as Cxy(0), x1_y1(0), x1_y2(0)
            columns.append(blocks[name][:, lag])
            expected.append(theory[name][lag])
    columns = np.array(columns).T
    z = (columns.mean(0) - expected) / (columns.std(0, ddof=1) / np.sqrt(len(columns)))
    chi2, dof, p = ex.joint_test(columns, expected)
    return dict(chi2=chi2, dof=dof, p=p, rms=ex.rms(z))


def test_row(simulation, blocks, discrete, continuous):
    first = next(iter(blocks.values()))
    d, c = test(simulation, blocks, discrete), test(simulation, blocks, continuous)
    return [simulation.scheme, f"{simulation.step:g}", len(first), d["dof"], f"{d['rms']:.2f}", f"{d['chi2']:.1f}",
            f"{d['p']:.2g}", f"{c['rms']:.2f}", f"{c['chi2']:.1f}", f"{c['p']:.2g}"], d["p"]


HEAD = ["scheme", "dt/tau", "blocks", "numbers", "rms z", "chi2", "prob.", "rms z", "chi2", "prob."]
GROUPS = "  (first three: exact expectation of the scheme at this time step; last three: continuous time)"


def value_rows(simulation, blocks, discrete, continuous):
    rows = []
    for name in blocks:
        mean, error = ex.mean_and_error(blocks[name])
        for lag in simulation.tested_lags():
            rows.append([simulation.scheme, f"{simulation.step:g}", name, f"{simulation.time[lag]:.2f}",
                         ex.plus_minus(mean[lag], error[lag]), f"{discrete[name][lag]:.4f}",
                         f"{(mean[lag] - discrete[name][lag]) / error[lag]:+.1f}", f"{continuous[name][lag]:.4f}"])
    return rows


VALUE_HEAD = ["scheme", "dt/tau", "", "t/tau", "here", "scheme, exact", "z", "continuous"]


def load(kind):
    order = {"midpoint": 0, "improved": 1}
    found = [Simulation(f) for f in glob.glob(f"results/{kind}_*") if glob.glob(f"{f}/path.*")]
    return sorted(found, key=lambda s: (order.get(s.scheme, 2), -s.step))


def single():
    names = {"Cxx": (0, 0), "Cxy": (0, 1), "Cyy": (1, 1), "Cyx": (1, 0)}
    table = ex.read_csv("reference_shear_single_discrete.csv")
    continuous_csv = ex.read_csv("reference_shear_single.csv")
    rows, values, drawn, probabilities = [], [], [], []
    for s in load("single"):
        mine = (table["scheme"] == SCHEME_IN_CSV[s.scheme]) & (abs(table["dt_over_tau"] - s.step) < 1e-9)
        discrete = {n: np.interp(s.time, table["t_over_tau"][mine], table[n][mine]) for n in names}
        t = continuous_csv["t_over_tau"]
        continuous = {n: np.interp(s.time, t, continuous_csv[n]) for n in ("Cxx", "Cxy", "Cyy")}
        continuous["Cyx"] = np.interp(-s.time, t, continuous_csv["Cxy"])
        blocks = {n: s.correlation(*c) for n, c in names.items()}
        row, p = test_row(s, blocks, discrete, continuous)
        rows.append(row)
        probabilities.append(p)
        values += value_rows(s, {n: blocks[n] for n in ("Cxx", "Cxy")}, discrete, continuous)
        drawn.append((s, blocks, discrete, continuous))
    print("\none particle in 2D (Table III), units kT/k")
    ex.print_table(VALUE_HEAD, values)
    print()
    ex.print_table(HEAD, rows)
    print(GROUPS)
    return drawn, probabilities


def pair():
    names = {"x1x1": (0, 0), "x1x2": (0, 2), "y1y1": (1, 1), "y1y2": (1, 3), "x1_y1": (0, 1), "x1_y2": (0, 3),
             "y1_x1": (1, 0), "y2_x1": (3, 0)}
    with open("reference_shear_pair_mobility.json") as f:
        data = json.load(f)
    inplane = [0, 1, 3, 4]
    mobility = np.array(data["M"])[np.ix_(inplane, inplane)]
    shear = np.zeros((4, 4))
    shear[0, 1] = shear[2, 3] = data["gdot"]
    csv = ex.read_csv("reference_shear_pair.csv")
    fib = csv["mobility"] == "fib4"
    rows, values, drawn, probabilities = [], [], [], []
    for s in load("pair"):
        c = discrete_correlations(s.scheme, mobility, data["k"], shear, data["kT"], s.step * data["tau"],
                                  s.lags * round(s.spacing / s.step))
        discrete = {n: c[:, i, j] for n, (i, j) in names.items()}
        continuous = {n: np.interp(s.time, csv["t_over_tau"][fib], csv[n][fib]) for n in names}
        # the two particles are equivalent: <p2 q1> = <p1 q2> by symmetry
        swap = {0: 2, 1: 3, 2: 0, 3: 1}
        blocks = {n: 0.5 * (s.correlation(i, j) + s.correlation(swap[i], swap[j])) for n, (i, j) in names.items()}
        row, p = test_row(s, blocks, discrete, continuous)
        rows.append(row)
        probabilities.append(p)
        values += value_rows(s, {n: blocks[n] for n in ("x1x1", "x1x2", "y1y2")}, discrete, continuous)
        drawn.append((s, blocks, discrete, continuous))
    print("\ntwo particles in 3D (Table IV), units h^2")
    ex.print_table(VALUE_HEAD, values)
    print()
    ex.print_table(HEAD, rows)
    print(GROUPS)
    return drawn, probabilities


def check_linear_theory():
    """The discrete theory used for the pair, applied to one particle, must agree with the reference."""
    table = ex.read_csv("reference_shear_single_discrete.csv")
    worst = 0.0
    for scheme, name in SCHEME_IN_CSV.items():
        for dt in (0.22, 0.11, 0.02):
            mine = (table["scheme"] == name) & (abs(table["dt_over_tau"] - dt) < 1e-9)
            c = discrete_correlations(scheme, np.eye(2), 1.0, np.array([[0, 1.0], [0, 0]]), 1.0, dt,
                                      np.arange(mine.sum()))
            for n, (i, j) in {"Cxx": (0, 0), "Cxy": (0, 1), "Cyy": (1, 1), "Cyx": (1, 0)}.items():
                worst = max(worst, abs(c[:, i, j] - table[n][mine]).max())
    return worst


def panel(axes, drawn, name, title):
    for (s, blocks, discrete, _), color, marker in zip(drawn, ex.COLORS, "os^Dv<"):
        mean, error = ex.mean_and_error(blocks[name])
        some = slice(None, None, max(1, len(s.time) // 14))
        axes.errorbar(s.time[some], mean[some], 2 * error[some], fmt=marker, color=color, ms=3.5, lw=0.8,
                      mfc="none" if s.scheme == "midpoint" else color, label=f"{s.scheme}, dt = {s.step:g} tau")
        axes.plot(s.time, discrete[name], color=color, lw=0.8, ls=":")
    fine = min(drawn, key=lambda d: d[0].spacing)
    axes.plot(fine[0].time, fine[3][name], color="black", lw=1.2, label="continuous time")
    axes.set_title(title, fontsize=10)
    axes.set_xlabel("t / tau")


# Function, its title in the plot, and where the paper shows it.
SHOWN = (("Cxx", "one particle, <x(t) x(0)>", "Fig. 6"), ("Cxy", "one particle, <x(t) y(0)>", "Fig. 6"),
         ("Cyy", "one particle, <y(t) y(0)>", ""),
         ("x1x1", "two particles, <x1(t) x1(0)>", "Fig. 7"), ("x1x2", "two particles, <x1(t) x2(0)>", "Fig. 7"),
         ("y1y1", "two particles, <y1(t) y1(0)>", "Fig. 8"), ("y1y2", "two particles, <y1(t) y2(0)>", "Fig. 8"),
         ("y2_x1", "two particles, <y2(t) x1(0)>", "Fig. 9"), ("x1_y2", "two particles, <x1(t) y2(0)>", "Fig. 9"))


def print_figures(drawn):
    """Deviation of each function from the exact expectation of the scheme, and from continuous time, in standard errors,
    over the tested lags of all runs of a scheme."""
    rows = []
    for name, title, figure in SHOWN:
        for scheme in SCHEME_IN_CSV:
            z = ([], [])
            for s, blocks, discrete, continuous in drawn:
                if s.scheme == scheme and name in blocks:
                    mean, error = ex.mean_and_error(blocks[name])
                    for theory, deviations in zip((discrete, continuous), z):
                        deviations += [(mean[lag] - theory[name][lag]) / error[lag] for lag in s.tested_lags()]
            if z[0]:
                rows.append([figure, title, scheme, len(z[0]), f"{ex.rms(z[0]):.2f}", f"{np.abs(z[0]).max():.1f}", f"{ex.rms(z[1]):.2f}"])
    print()
    ex.print_table(["figure", "function", "scheme", "numbers", "rms z", "largest", "rms z, continuous time"], rows)


def plot(drawn_single, drawn_pair):
    plt = ex.pyplot()
    figure, axes = plt.subplots(3, 3, figsize=(11, 9.8), gridspec_kw={"hspace": 0.4, "wspace": 0.25})
    for ax, (name, title, shown) in zip(axes.flat, SHOWN):
        panel(ax, drawn_single if name[0] == "C" else drawn_pair, name, title + (f" ({shown})" if shown else ""))
    axes[0, 0].legend(fontsize=7)
    axes[1, 0].legend(fontsize=7)
    axes[0, 0].set_ylabel("kT/k")
    for ax in axes[1:, 0]:
        ax.set_ylabel("h$^2$")
    figure.text(0.5, 0.93, "points: fix bd/fib with 2 standard errors; dotted: exact expectation of the scheme",
                ha="center", fontsize=9)
    ex.save(figure, "results/shear.png")


def main():
    drawn_single, p_single = single()
    drawn_pair, p_pair = pair()
    print(f"\ncheck of the discrete theory against the reference: {check_linear_theory():.1e}")
    if drawn_single and drawn_pair:
        print_figures(drawn_single + drawn_pair)
        plot(drawn_single, drawn_pair)
    probabilities = p_single + p_pair
    print(f"verdict: smallest of {len(probabilities)} probabilities against the exact expectation of the schemes is "
          f"{np.nanmin(probabilities):.2g}: "
          + ex.verdict(probabilities, 0.001, "agrees", "DIFFERS by more than chance explains"))


if __name__ == "__main__":
    main()
