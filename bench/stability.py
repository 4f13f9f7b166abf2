#!/usr/bin/python3
"""Largest stable time step and bias of the schemes of fix bd/fib and fix bd/pse: bench/stability/*.csv and *.png.

    bench/stability.py [steps_wall] [steps_wca] [bias] [crossing] [slip] [steps_cluster] [bias_cluster]
                       [split_bonds] [shear] [shear_pse] [adapted] [plot]
                                                    no argument: all, about half an hour on one core

steps_wall   the channel of in.stability_wall: largest step with which a run finishes
steps_wca    the suspension of in.stability_wca: largest step with which a run finishes, and with which the energy is right to 5 %
bias         P(H) against the Boltzmann law and against Euler's (47), for time steps beta = 2 kT mu dt/h^2
steps_cluster   depletion attraction of in.stability_cluster: largest step with which the cluster of 13 holds together
bias_cluster    lengths of the bonds of separate pairs with that attraction against the Boltzmann law
shear        trapped particle of in.stability_shear: largest step, and second moments against their values for continuous time
shear_pse    the same with fix bd/pse in a deforming box, three dimensions (in.stability_shear_pse)
crossing     P(H) without springs, which must be uniform, with `crossing reflect` and `redraw`
slip         density at a free-slip wall, which must be the same as elsewhere (in.stability_slip)
split_bonds  energy of stiff bonds with scheme split of fix bd/pse, by number of substeps (in.stability_split)
adapted      walls, pairs and traps with keyword `adapt` and steps far beyond the largest fixed one, whose tables it reads; the
             suspension is in integrator/adapt.py
Environment: LMP=file uses another executable.
"""
import csv
import functools
import itertools
import os
import re
import subprocess
import sys
import tempfile

import numpy as np
from scipy import stats

BENCH = os.path.dirname(os.path.abspath(__file__))
OUT = os.path.join(BENCH, "stability")
LMP = os.path.realpath(os.environ.get("LMP", os.path.join(BENCH, "..", "build", "lmp")))
WORK = tempfile.mkdtemp(prefix="bdh_stability_")
SCHEMES = ("midpoint", "improved", "euler", "trapezoidal")
BETAS = (0.05, 0.1, 0.2, 0.3, 0.45)

HEIGHT, RANGE, STIFFNESS, BINS = 12.0, 3.0, 6.0, 60
MU_PARALLEL = 0.34705                  # at mid-channel, mean over a cell, kernel peskin4; the perpendicular one is smaller
MONTE_CARLO = {1000: 0.08185, 3300: 0.84179}     # energy per particle over kT, unittest/test_lammps_rdf.cpp
ENERGY_ERROR = 0.05


def lmp(deck, **variables):
    """Runs a deck.  Returns its output, or None if it ended with an error."""
    words = [LMP, "-in", os.path.join(BENCH, deck), "-log", "none"]
    for name, value in variables.items():
        words += ["-var", name, repr(value) if isinstance(value, float) else str(value)]
    done = subprocess.run(words, cwd=WORK, capture_output=True, text=True, check=False)
    return done.stdout if done.returncode == 0 else None


def table(name):
    """Averages written by fix ave/time: values [block]."""
    return np.loadtxt(os.path.join(WORK, name), ndmin=2)[:, 1]


def histograms(name):
    """Fractions in the bins of the distance to the nearer wall [block, bin]."""
    blocks = []
    with open(os.path.join(WORK, name)) as f:
        lines = (line.split() for line in f if not line.startswith("#"))
        for head in lines:
            blocks.append([float(next(lines)[2]) for _ in range(int(head[1]))])
    blocks = np.array(blocks)
    return blocks / blocks.sum(1, keepdims=True)


def save(name, head, rows):
    os.makedirs(OUT, exist_ok=True)
    with open(os.path.join(OUT, name + ".csv"), "w", newline="") as f:
        csv.writer(f).writerows([head] + rows)
    print(f"\n{name}")
    for row in [head] + rows:
        print("  " + "  ".join(f"{v:.4g}" if isinstance(v, float) else str(v) for v in row), flush=True)


# ---- the laws -------------------------------------------------------------------------------------------------------

def boltzmann(H, k=STIFFNESS):
    return np.exp(-0.5 * k * np.maximum(RANGE - H, 0) ** 2)


def perpendicular_mobility():
    """H and mu of one particle, averaged over positions along the channel, from steps at temperature 0."""
    deck = os.path.join(WORK, "in.mobility")
    with open(deck, "w") as f:
        f.write(f"""
units lj
dimension 2
boundary p f p
atom_style atomic
atom_modify map array
region box block 0 8 0 {HEIGHT:g} -0.5 0.5
create_box 1 box
create_atoms 1 single 0 6 0
mass 1 1.0
neigh_modify every 1 delay 0 check yes
comm_modify cutoff 2.0
fix push all addforce 0.0 1.0 0.0
fix move all bd/fib 0.0 1.0 1 grid 8 {HEIGHT:g} 1 fft estimate wall ylo noslip wall yhi noslip
timestep 1e-9
variable u equal vy[1]
variable place index 0 0.25 0.5
label next_place
variable i loop {int(4 * HEIGHT)}
label next_height
variable H equal v_i*0.125
set atom 1 x ${{place}} y $H
run 1
print "MU ${{H}} ${{u}}"
next i
jump SELF next_height
next place
jump SELF next_place
""")
    found = {}
    for line in lmp(deck).splitlines():
        if line.startswith("MU "):
            H, mu = map(float, line.split()[1:])
            found.setdefault(H, []).append(mu)
    H = np.array(sorted(found))
    mu = np.array([np.dot(found[h], (0.25, 0.5, 0.25)) for h in H])
    return np.append(0.0, H), np.append(0.0, mu)


def shares(density):
    """Fraction in each bin."""
    p = np.array([density(np.linspace(b, b + 1, 41)[:-1] * 0.1 + 0.00125).mean() for b in range(BINS)])
    return p / p.sum()


# ---- largest steps --------------------------------------------------------------------------------------------------

def largest(good, start):
    """Largest step with good(step), to 6 %, by bisection of the logarithm, starting from a factor of two around `start`."""
    low = start
    while not good(low):
        low /= 2
        if low < start / 100:
            return float("nan")
    high = 2 * low
    while good(high):
        low, high = high, 2 * high
        if high > 1000 * start:
            return float("inf")
    for _ in range(4):
        middle = float(np.sqrt(low * high))
        low, high = (middle, high) if good(middle) else (low, middle)
    return low


def limits(energy_at, expected, start):
    """Largest step that runs (to the end, with less than twice the energy), and the largest step whose energy is right to
    ENERGY_ERROR.  energy_at(step) is None for a run that failed."""
    known = {}

    def energy(step):
        if step not in known:
            known[step] = energy_at(step)
        return known[step]

    def runs(step):
        return energy(step) is not None and energy(step) < 2 * expected

    def right(step):
        return runs(step) and abs(energy(step) / expected - 1) < ENERGY_ERROR

    return largest(runs, start), largest(right, start), known


def steps_wall():
    """Largest step with which 100 particles take 10 000 steps and none crosses a wall."""
    rows = []
    for k in (6.0, 60.0):
        for scheme in SCHEMES:
            runs = largest(lambda dt: lmp("in.stability_wall", scheme=scheme, k=k, dt=dt, time=10000 * dt, out="wall") is not None, 0.2)
            rows.append([k, scheme, runs, runs * 2 * MU_PARALLEL])
    save("largest_step_wall", ["k h^2/kT", "scheme", "dt runs", "beta"], rows)


def steps_wca():
    rows = []
    for n, expected in MONTE_CARLO.items():
        lmp("in.stability_wca", fresh=1, N=n, out=f"begin{n}")
        for scheme in SCHEMES:

            def energy(dt):
                ok = lmp("in.stability_wca", start=f"begin{n}.data", N=n, scheme=scheme, dt=dt, steps=800, out="wca")
                return float(table("wca.energy").mean()) if ok else None

            runs, right, known = limits(energy, expected, 25.0)
            rows.append([n, scheme, runs, right])
            print(f"{n} {scheme}: " + ", ".join(f"{dt:.3g}: {e / expected - 1:+.1%}" if e else f"{dt:.3g}: failed"
                                                for dt, e in sorted(known.items())), flush=True)
    save("largest_step_wca", ["N", "scheme", "dt runs", "dt energy right to 5 %"], rows)


# ---- bias -----------------------------------------------------------------------------------------------------------

EDGES = np.array([0, 20, 22, 24, 26, 28, 30, 34, 38, 43, 48, 54])        # bins of 0.1 h, as merged for the test


def t2_test(blocks, expected):
    """Hotelling's T^2 of the mean of blocks, without the last bin, which the others determine; and its probability."""
    blocks = np.add.reduceat(blocks, EDGES, axis=1)
    expected = np.add.reduceat(expected, EDGES)
    n, count = len(blocks), len(expected) - 1
    d = (blocks.mean(0) - expected)[:-1]
    t2 = float(d @ np.linalg.solve(np.cov(blocks[:, :-1].T) / n, d))
    return t2, float(stats.f.sf(t2 * (n - count) / (count * (n - 1)), count, n - count))


def near_share(blocks, expected, width=3.0):
    """Fraction within `width` of the walls over the expected fraction, minus 1, and its standard error."""
    bins = int(round(10 * width))
    share = blocks[:, :bins].sum(1) / expected[:bins].sum() - 1
    return float(share.mean()), float(share.std(ddof=1) / np.sqrt(len(share)))


def bias():
    H, mu = perpendicular_mobility()
    right = shares(boltzmann)
    euler = shares(lambda h: np.where(h > 0.5, boltzmann(h) / np.maximum(np.interp(h, H, mu), 1e-9), 0))
    predicted = float(euler[:30].sum() / right[:30].sum() - 1)
    rows = []
    for scheme, particles, time in (("midpoint", 100, 10000.0), ("improved", 100, 10000.0), ("euler", 1, 60000.0)):
        for beta in BETAS:
            ok = lmp("in.stability_wall", scheme=scheme, particles=particles, dt=0.5 * beta / MU_PARALLEL, time=time, out="bias")
            if not ok:
                rows.append([scheme, beta] + [float("nan")] * 8)
                continue
            blocks = histograms("bias.count")
            share, error = near_share(blocks, right)
            a, b = t2_test(blocks, right), t2_test(blocks, euler)
            rows.append([scheme, beta, share, error, share / error, (share - predicted) / error, *a, *b])
    save("wall_bias", ["scheme", "beta", "bias of the share within 3 h", "s.e.", "bias/s.e.", "from (47)/s.e.", "T2 Boltzmann (11 bins)",
                       "probability", "T2 law (47)", "probability"], rows)
    print(f"law (47): bias {predicted:.4f}")
    return predicted


def crossing():
    """Without springs the density is uniform.  Near a wall it takes hundreds of time units to become so; hence the long
    blocks.  The channel is longer, since a step of more than half the box is an error."""
    uniform = np.full(BINS, 1 / BINS)
    rows = []
    for scheme, kernel, dt, way in itertools.product(("midpoint", "trapezoidal"), ("peskin4", "roma3"), (1.0, 2.0, 4.0),
                                                     ("reflect", "redraw")):
        text = lmp("in.stability_wall", **{"from": 0.01}, width=32, scheme=scheme, kernel=kernel, crossing=way, k=0, dt=dt, time=20000.0,
                   blocks=20, out="crossing")
        if not text:
            rows.append([scheme, kernel, dt, way] + [float("nan")] * 8)
            continue
        words = next(line for line in text.splitlines() if line.startswith("COUNT")).split()
        blocks = histograms("crossing.count")
        numbers = [v for width in (0.5, 1.0, 3.0) for v in near_share(blocks, uniform, width)]
        tries = float(words[4]) * (100 if way == "reflect" else 1)
        rows.append([scheme, kernel, dt, way, int(float(words[1])), float(words[1]) / tries] + numbers)
    save("crossing", ["scheme", "kernel", "dt", "crossing", "crossings", "per step (reflect: and particle)", "excess within 0.5 h", "s.e.", "within 1 h", "s.e.",
                      "within 3 h", "s.e."], rows)


def slip():
    rows = []
    for dt, scheme in itertools.product((0.5, 0.1), ("midpoint", "improved")):
        text = lmp("in.stability_slip", scheme=scheme, dt=dt, time=20000.0 * dt / 0.5, out="slip")
        excess = 16 * histograms("slip.count")[:, -1] - 1
        crossings = int(float(next(line for line in text.splitlines() if line.startswith("COUNT")).split()[1]))
        rows.append([scheme, dt, float(excess.mean()), standard_error(excess), crossings])
    save("slip_wall", ["scheme", "dt", "excess within 0.5 h of the slip wall", "s.e.", "crossings"], rows)


def split_bonds():
    r = np.linspace(1.5, 4.5, 20001)
    weight = r**2 * np.exp(-50.0 * (r - 3.0) ** 2)
    exact = float((50.0 * (r - 3.0) ** 2 * weight).sum() / weight.sum())
    rows = []
    for substeps in (1, 2, 4):
        lmp("in.stability_split", substeps=substeps, out="split")
        energy = table("split.energy") / exact - 1
        rows.append([substeps, float(energy.mean()), standard_error(energy)])
    save("split_bonds", ["substeps", "excess of the energy of a bond", "s.e."], rows)


# ---- cluster --------------------------------------------------------------------------------------------------------

ROOT = os.path.dirname(BENCH)
POTENTIAL = os.path.join(ROOT, "potentials", "Delong2014.asakura_oosawa")
KT, RANGE_OF_BOND = 12.3, 7.183757109179988
FIB = "bd/fib 12.3 1.0 {seed} grid {cells} {cells} {cells} kernel peskin4 fft estimate scheme "      # spacing 2.551: radius 3.2
PSE = "bd/pse 12.3 1.0 {seed} radius 3.2 tolerance 1e-3 fft estimate scheme "
# fix and its arguments, number of near steps in one step
MOVES = {**{f"bd/fib {s}": (FIB + s, 1) for s in SCHEMES}, "bd/pse euler": (PSE + "euler", 1),
         **{f"bd/pse split, {n} substeps": (PSE + f"split substeps {n}", n) for n in (4, 10, 20)}}


def data_file(name, side, positions):
    with open(os.path.join(WORK, name), "w") as f:
        f.write(f"\n\n{len(positions)} atoms\n1 atom types\n" + "".join(f"{-side / 2} {side / 2} {d}lo {d}hi\n" for d in "xyz"))
        f.write("\nMasses\n\n1 1.0\n\nAtoms # atomic\n\n")
        f.writelines(f"{i + 1} 1 {x:.12g} {y:.12g} {z:.12g}\n" for i, (x, y, z) in enumerate(positions))


@functools.cache
def bond_law():
    """Most probable distance, mean and variance of the distance of a bound pair: r^2 exp(-U/kT)."""
    deck = os.path.join(WORK, "in.bond")
    with open(deck, "w") as f:
        f.write(f"""
region box block 0 50 0 50 0 50
create_box 1 box
mass 1 1
pair_style hybrid/overlay lj/cut {RANGE_OF_BOND} asakura/oosawa
pair_coeff 1 1 lj/cut 10.0 6.4
pair_coeff 1 1 asakura/oosawa file {POTENTIAL} cluster
pair_modify pair lj/cut shift yes
pair_write 1 1 4000 r 4.5 {RANGE_OF_BOND} bond.table pair
""")
    lmp(deck)
    r, U = np.loadtxt(os.path.join(WORK, "bond.table"), skiprows=5)[:, 1:3].T
    p = r**2 * np.exp(-(U - U.min()) / KT)
    mean = (p * r).sum() / p.sum()
    return r[p.argmax()], mean, (p * (r - mean) ** 2).sum() / p.sum()


def steps_cluster():
    h = 2.5510204
    ball = [(0, 0, 0)] + [p for a in (3.6, -3.6) for b in (5.8249223595, -5.8249223595) for p in ((0, a, b), (b, 0, a), (a, b, 0))]
    data_file("ball", 16 * h, ball)

    def holds(move, dt):
        """Three clusters of 13 for a time of 25, at least 125 steps: none ends with an error or falls apart."""
        for seed in (1, 2, 3):
            text = lmp("in.stability_cluster", data="ball", potential=POTENTIAL, move=move.format(seed=seed, cells=16), dt=dt,
                       steps=max(100, round(20 / dt)))
            if not text or float(re.findall(r"^RG (\S+)", text, re.M)[-1]) > 9.0:
                return False
        return True

    rows = []
    for name, (move, substeps) in MOVES.items():
        step = largest(lambda dt: holds(move, dt), 0.05 * substeps)
        rows.append([name, step, step / substeps])
    save("largest_step_cluster", ["scheme", "dt holds", "per substep"], rows)


def write_pairs(distance):
    """27 pairs far apart: the data file `pairs`."""
    side = 32 * 2.5510204
    places = (np.arange(3) - 1) * side / 3
    data_file("pairs", side, [(x + s * distance / 2, y, z) for x, y, z in itertools.product(places, places, places) for s in (-1, 1)])


def bias_cluster():
    best, mean, variance = bond_law()
    print(f"bound pair: r = {best:.4g} most probable, mean {mean:.6g}, variance {variance:.4g}")
    write_pairs(best)
    rows = []
    for name, (move, substeps) in MOVES.items():
        if substeps in (4, 20):
            continue
        for near in (0.0125, 0.025, 0.05):
            # Four runs of at most 75 time units, in which pairs do not meet
            blocks = []
            for seed in (4, 5, 6, 7):
                if not lmp("in.stability_cluster", data="pairs", potential=POTENTIAL, move=move.format(seed=seed, cells=32),
                           dt=near * substeps, steps=1200 // substeps, out="pairs"):
                    raise SystemExit(f"pairs, {name}, near step {near}: the run failed")
                blocks.append(np.loadtxt(os.path.join(WORK, "pairs.contacts"), ndmin=2)[:, 1:4])
            total, m, square = np.vstack(blocks).T
            v = square - 2 * mean * m + mean**2
            rows.append([name, near * substeps, float((total / m).mean() / 27), float(m.mean() / mean - 1),
                         float(standard_error(m) / mean), float(v.mean() / variance - 1), float(standard_error(v) / variance)])
    save("cluster_bias", ["scheme", "dt", "share of pairs bound", "bias of the length of the bond", "s.e.",
                          "bias of <(r - mean)^2>", "s.e."], rows)


def standard_error(blocks):
    return blocks.std(ddof=1) / np.sqrt(len(blocks))


# ---- shear ----------------------------------------------------------------------------------------------------------

def shear():
    """Second moments in continuous time at Wi = 1, with constant mobility: <x^2> = 1 + Wi^2/2, <x y> = Wi/2, <y^2> = 1 (kT/k)."""
    def moments(scheme, step, steps):
        ok = lmp("in.stability_shear", scheme=scheme, step=step, steps=steps, out="shear")
        return np.loadtxt(os.path.join(WORK, "shear.moments"), ndmin=2)[:, 1:4] if ok else None

    rows = [[scheme, largest(lambda step: moments(scheme, step, 2000) is not None, 0.5)] for scheme in SCHEMES]
    save("largest_step_shear", ["scheme", "dt/tau runs"], rows)
    exact = np.array([1.5, 0.5, 1.0])
    rows = []
    for scheme, step in itertools.product(SCHEMES, (0.1, 0.2, 0.4, 0.8)):
        m = moments(scheme, step, max(20000, round(10000 / step)))
        if m is None:
            rows.append([scheme, step] + [float("nan")] * 6)
            continue
        m = m / exact - 1
        rows.append([scheme, step] + [float(v) for i in range(3) for v in (m[:, i].mean(), standard_error(m[:, i]))])
    save("shear_bias", ["scheme", "dt/tau", "bias of <x^2>", "s.e.", "<x y>", "s.e.", "<y^2>", "s.e."], rows)


PSE_SHEAR = ("euler", "split substeps 1", "split substeps 4", "split substeps 10")


def shear_pse():
    """As shear(); <z^2> = 1 too."""
    def moments(scheme, step, steps):
        ok = lmp("in.stability_shear_pse", scheme=scheme, step=step, steps=steps, out="shear_pse")
        return np.loadtxt(os.path.join(WORK, "shear_pse.moments"), ndmin=2)[:, 1:] if ok else None

    rows = [[scheme, largest(lambda step: moments(scheme, step, 2000) is not None, 0.5)] for scheme in PSE_SHEAR]
    save("largest_step_shear_pse", ["scheme", "dt/tau runs"], rows)
    exact = np.array([1.5, 0.5, 1.0, 1.0])
    rows = []
    for scheme, step in itertools.product(PSE_SHEAR, (0.1, 0.2, 0.4, 0.8)):
        m = moments(scheme, step, max(20000, round(10000 / step)))
        if m is None:
            rows.append([scheme, step] + [float("nan")] * 8)
            continue
        m = m / exact - 1
        rows.append([scheme, step] + [float(v) for i in range(4) for v in (m[:, i].mean(), standard_error(m[:, i]))])
    save("shear_bias_pse", ["scheme", "dt/tau", "bias of <x^2>", "s.e.", "<x y>", "s.e.", "<y^2>", "s.e.", "<z^2>", "s.e."], rows)


# ---- steps that choose themselves -------------------------------------------------------------------------------------

def fixed_limit(name, **wanted):
    """Largest fixed step in a table that has been saved."""
    with open(os.path.join(OUT, name + ".csv")) as f:
        for row in csv.DictReader(f):
            if all(row[key] == value for key, value in wanted.items()):
                return float(next(row[key] for key in row if key.startswith("dt")))
    raise SystemExit(f"{name}.csv has no row {wanted}")


def adapted_wall(k, words, dt):
    text = lmp("in.stability_wall", k=k, scheme=words, dt=dt, time=2000.0, out="adapted")
    return text, text and near_share(histograms("adapted.count"), shares(lambda H: boltzmann(H, k)))


def adapted_pairs(move, words, dt):
    """Variance of the bonds of separate pairs, as in bias_cluster()."""
    squares, text = [], None
    best, mean, variance = bond_law()
    write_pairs(best)
    for seed in (4, 5, 6, 7):
        text = lmp("in.stability_cluster", data="pairs", potential=POTENTIAL, move=move.format(seed=seed, cells=32) + words, dt=dt,
                   steps=round(60 / dt), out="pairs")
        if not text:
            return None, None
        m, square = np.loadtxt(os.path.join(WORK, "pairs.contacts"), ndmin=2)[:, 2:4].T
        squares.append(square - 2 * mean * m + mean**2)
    v = np.concatenate(squares)
    return text, (float(v.mean() / variance - 1), float(standard_error(v) / variance))


def adapted_trap(deck, words, step):
    """<y^2> in shear flow, whose value for continuous time is 1."""
    text = lmp(deck, scheme=words, step=step, steps=max(200, round(1300 / step)), out="trap")
    y2 = text and np.loadtxt(os.path.join(WORK, "trap.moments"), ndmin=2)[:, 3] - 1
    return text, text and (float(y2.mean()), standard_error(y2))


def adapted():
    """Steps of several times the largest fixed one, which all end with fixed steps."""
    limit = fixed_limit
    cases = [(f"wall, k = {k:g}", scheme, limit("largest_step_wall", **{"k h^2/kT": str(k), "scheme": scheme}), factor,
              lambda words, dt, k=k: adapted_wall(k, words, dt), (0.05, 0.02))
             for k, factor in ((6.0, 4), (60.0, 20)) for scheme in ("midpoint", "improved")]
    cases += [(f"pairs that stick, {name.split()[0]}", name.split()[1], limit("largest_step_cluster", scheme=name), 10,
               lambda words, dt, move=MOVES[name][0].rsplit(" scheme", 1)[0] + " scheme ": adapted_pairs(move, words, dt), (0.05, 0.02))
              for name in ("bd/fib midpoint", "bd/fib improved", "bd/pse euler")]
    cases += [("trap in shear, bd/fib", scheme, limit("largest_step_shear", scheme=scheme), 4,
               lambda words, dt: adapted_trap("in.stability_shear", words, dt), (0.2, 0.05)) for scheme in ("midpoint", "improved")]
    cases += [("trap in shear, bd/pse", "euler", limit("largest_step_shear_pse", scheme="euler"), 4,
               lambda words, dt: adapted_trap("in.stability_shear_pse", words, dt), (0.2, 0.05))]
    rows = []
    for scene, scheme, largest_fixed, factor, run, tolerances in cases:
        dt = float(f"{factor * largest_fixed:.2g}")
        fails = run(scheme, dt)[0] is None
        for tolerance in tolerances:
            text, found = run(f"{scheme} adapt {tolerance}", dt)
            pieces = float(re.findall(r"adapt: (\S+) (?:pieces|near steps) a step", text)[-1]) if text else float("nan")
            back = re.search(r"(\d+) pieces were halved again", text or "")
            rows.append([scene, scheme, largest_fixed, dt, "fails" if fails else "runs", tolerance, pieces, int(back.group(1)) if back else 0,
                         *(found or (float("nan"),) * 2)])
            print(rows[-1], flush=True)
    save("adapted", ["scene", "scheme", "largest fixed dt", "dt", "with a fixed step", "adapt", "pieces per step", "taken back", "bias", "s.e."], rows)


# ---- figure ---------------------------------------------------------------------------------------------------------

def plot():
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    with open(os.path.join(OUT, "wall_bias.csv")) as f:
        rows = list(csv.reader(f))[1:]
    H, mu = perpendicular_mobility()
    right = shares(boltzmann)
    euler = shares(lambda h: np.where(h > 0.5, boltzmann(h) / np.maximum(np.interp(h, H, mu), 1e-9), 0))
    plt.rcParams.update({"figure.figsize": (6, 4.2), "axes.grid": True, "grid.alpha": 0.3, "savefig.dpi": 130, "font.size": 9})
    for scheme, mark in (("midpoint", "o"), ("improved", "s"), ("euler", "^")):
        mine = np.array([row[1:4] for row in rows if row[0] == scheme], float)
        plt.errorbar(mine[:, 0], 100 * mine[:, 1], yerr=200 * mine[:, 2], fmt=mark + "-", ms=4, lw=1, capsize=3, label=scheme)
    plt.axhline(0, color="k", lw=1, label="Boltzmann")
    plt.axhline(100 * (euler[:30].sum() / right[:30].sum() - 1), color="k", ls="--", lw=1, label="Euler's law (47)")
    plt.xlabel("beta = 2 kT mu dt / h$^2$")
    plt.ylabel("particles within 3 h of the walls, excess [%]")
    plt.title("stiff walls, channel of 12 h; bars: two standard errors", fontsize=9)
    plt.legend(fontsize=8)
    plt.tight_layout()
    plt.savefig(os.path.join(OUT, "wall_bias.png"))
    print("drawn: bench/stability/wall_bias.png")


if __name__ == "__main__":
    parts = {"bias": bias, "crossing": crossing, "steps_cluster": steps_cluster, "bias_cluster": bias_cluster, "shear": shear, "shear_pse": shear_pse,
             "steps_wall": steps_wall, "steps_wca": steps_wca, "slip": slip, "split_bonds": split_bonds, "adapted": adapted,
             "plot": plot}
    for wanted in sys.argv[1:] or parts:
        parts[wanted]()
