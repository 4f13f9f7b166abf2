#!/usr/bin/python3
"""Rigid spheres in shear: the viscosity of hard spheres at high frequency against an independent program, and the viscosity of
a Brownian suspension against the Peclet number, with and without stresslets."""

import os
import sys

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "common"))
import bdh_examples as ex

PECLET = (1, 3, 10, 30, 100)
SPHERES, PHI, DT, STRAIN = 64, 0.4, 0.0005, 0.005       # of in.shear
OMEGA = (0.5, 1.5, 5)
DUMBBELLS, PHI_DUMBBELLS, DT_DUMBBELLS = 16, 0.04, 0.02          # of in.moduli
LEVEL = 3.5                                             # standard errors


def ladd(phi):
    """Viscosity of hard spheres at high frequency, with lubrication: Ladd, J Chem Phys 93, 3484 (1990), a fit."""
    s = phi * (1 + phi - 0.189 * phi**2)
    return (1 + 1.5 * s) / (1 - s)


def experiments(phi):
    """Viscosity of hard-sphere colloids at low and at high rates: de Kruif et al., J Chem Phys 83, 4717 (1985), fits."""
    return (1 - phi / 0.63)**-2, (1 - phi / 0.71)**-2


# ---- hard spheres ---------------------------------------------------------------------------------------------------

def compare_hard_spheres():
    """phi, mean, standard error, z."""
    table = ex.read_fix_print("results/viscosity.dat")
    reference = ex.read_csv("reference.csv")
    found, rows = [], []
    for phi, theirs, error in zip(reference["phi"], reference["viscosity"], reference["viscosity_se"]):
        mine = table[np.isclose(table[:, 0], phi), 1:4].mean(1)       # by configuration
        mean, own = ex.mean_and_error(mine)
        z = (mean - theirs) / np.hypot(own, error)
        found.append((phi, mean, own, z))
        rows.append([f"{phi:g}", ex.plus_minus(mean, own), ex.plus_minus(theirs, error), f"{z:+.1f}", f"{ladd(phi):.3f}"])
    print("\nrelative viscosity of 64 hard spheres at high frequency")
    ex.print_table(["phi", "here", "reference", "z", "with lubrication"], rows)
    return np.array(found), reference


def compare_fluctuations():
    """z of the viscosity of one configuration from the variance of the stress without flow, against that in shear."""
    shear = ex.read_fix_print("results/0.4/viscosity.dat")[-1, 1:4]
    steps, *noise = ex.read_fix_print("results/0.4/fluctuations.dat")[-1]
    noise = np.array(noise)
    error = np.sqrt(2 / steps) * (shear - 1)                # of the variance of independent normal numbers
    print("\none configuration at phi = 0.4: relative viscosity in shear, and from the fluctuations of the stress at rest")
    rows = [[plane, f"{s:.4f}", ex.plus_minus(n, e), f"{(n - s) / e:+.1f}"]
            for plane, s, n, e in zip(("xy", "xz", "yz"), shear, noise, error)]
    ex.print_table(["plane", "shear", "fluctuations", "z"], rows)
    return (noise - shear) / error


# ---- steady shear ---------------------------------------------------------------------------------------------------

def blocks(stresslet, peclet):
    return ex.read_fix_print(f"results/shear.{stresslet}.{peclet}.dat")[:, 1:]


def noise_of_stress(peclet, hydrodynamic, steps):
    """Standard deviation of the average of a relative viscosity over these steps: that of the stresslets' white noise."""
    volume = SPHERES * 4 / 3 * np.pi / PHI
    time = steps * min(DT, STRAIN / peclet)
    return np.sqrt(2 * hydrodynamic * 6 * np.pi / (volume * time)) / peclet


def compare_thinning():
    """Rows of Peclet number, then mean and standard error of: fluid, repulsion, both; repulsion without stresslets."""
    found, rows, ratios = [], [], []
    for peclet in PECLET:
        rigid, soft = blocks("yes", peclet), blocks("no", peclet)[:, 1]
        numbers = [ex.mean_and_error(v) for v in (rigid[:, 0], rigid[:, 1], 1 + rigid.sum(1), 1 + soft)]
        steps = np.diff(ex.read_fix_print(f"results/shear.yes.{peclet}.dat")[:, 0])[0]
        ratios.append(rigid[:, 0].std(ddof=1) / noise_of_stress(peclet, numbers[0][0], steps))
        found.append([peclet] + [v for pair in numbers for v in pair])
        rows.append([f"{peclet}"] + [ex.plus_minus(*pair) for pair in numbers] + [f"{ratios[-1]:.2f}"])
    print(f"\nsteady shear of {SPHERES} spheres at phi = {PHI}: relative viscosity and its parts")
    ex.print_table(["Peclet", "fluid", "repulsion", "viscosity", "without stresslets", "scatter/noise"], rows)
    print("colloids in experiments, with lubrication: {:.2f} at low and {:.2f} at high rates".format(*experiments(PHI)))
    return np.array(found), np.array(ratios)


# ---- moduli ---------------------------------------------------------------------------------------------------------

def moduli_from_fluctuations():
    """Storage and loss modulus of the particles [block, frequency]."""
    _, table = ex.read_ave_time_vector("results/correlation.dat")
    table = table[table[:, 0, 1] > 0]
    G = DUMBBELLS / PHI_DUMBBELLS * 8 / 3 * np.pi * table[:, :, 2:].mean(2)      # V/kT times the mean of three components
    t = table[0, :, 0] * DT_DUMBBELLS
    start = G[:, 1]                                         # without the white noise; an extrapolation would be noisier
    white = 0.5 * DT_DUMBBELLS * (G[:, 0] - start)          # the viscosity at high frequency, without that of the fluid
    G[:, 0] = start
    weight = np.full(len(t), DT_DUMBBELLS)
    weight[[0, -1]] /= 2
    storage = [w * G @ (weight * np.sin(w * t)) for w in OMEGA]
    loss = [w * G @ (weight * np.cos(w * t)) + w * white for w in OMEGA]
    return np.array(storage).T, np.array(loss).T


def compare_moduli():
    """z of all moduli, and the numbers for the figure [frequency, ...]."""
    rest = [ex.mean_and_error(m) for m in moduli_from_fluctuations()]
    rows, found = [], []
    for i, w in enumerate(OMEGA):
        flow = ex.mean_and_error(ex.read_fix_print(f"results/moduli.{w:g}.dat")[:, 1:])
        for k, name in enumerate(("G'", "G\"")):
            a, da, b, db = rest[k][0][i], rest[k][1][i], flow[0][k], flow[1][k]
            found.append((w, k, a, da, b, db, (b - a) / np.hypot(da, db)))
            rows.append([f"{w:g}", name] + [ex.plus_minus(1e3 * v, 1e3 * e) for v, e in ((b, db), (a, da))] + [f"{found[-1][-1]:+.1f}"])
    print("\nmoduli of dumbbells, kT/(1000 a^3), without the fluid's")
    ex.print_table(["frequency", "", "oscillations", "fluctuations", "z"], rows)
    return np.array(found)


def fall(found, column):
    """Decrease of a number from the second to the last Peclet number, in standard errors."""
    first, last = found[1], found[-1]
    return (first[column] - last[column]) / np.hypot(first[column + 1], last[column + 1])


def plot_moduli(axes, moduli):
    for k, (name, color) in enumerate((("G'", ex.COLORS[0]), ("G\"", ex.COLORS[1]))):
        w, _, rest, rest_error, flow, flow_error, _ = moduli[moduli[:, 1] == k].T
        axes.errorbar(w * 0.97, flow, 2 * flow_error, fmt="o", color=color, label=f"{name}, oscillations")
        axes.errorbar(w * 1.03, rest, 2 * rest_error, fmt="s", mfc="none", color=color, label=f"{name}, fluctuations at rest")
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlim(0.3, 9)
    axes.set_ylim(4e-4, 0.06)
    axes.set_xlabel("frequency a$^2$/D$_0$")
    axes.set_ylabel("moduli of dumbbells, a$^3$/kT")
    axes.legend(fontsize=8, loc="upper left")


def plot(spheres, reference, found, moduli):
    plt = ex.pyplot()
    panels = 2 if moduli is None else 3
    figure, axes = plt.subplots(1, panels, figsize=(4.75 * panels, 3.8), gridspec_kw={"wspace": 0.24})
    phi = np.linspace(0, 0.32, 100)
    axes[0].plot(phi, 1 + 2.5 * phi, ":", color=ex.COLORS[5], label="Einstein, 1 + 2.5 phi")
    axes[0].plot(phi, ladd(phi), "--", color=ex.COLORS[3], label="with lubrication (fit of Ladd)")
    axes[0].plot(reference["phi"], reference["viscosity"], "s", ms=8, mfc="none", color=ex.COLORS[1], label="independent program")
    axes[0].errorbar(spheres[:, 0], spheres[:, 1], 2 * spheres[:, 2], fmt="o", color=ex.COLORS[0], label="fix bd/pse, stresslet yes")
    axes[0].set_ylim(0.95, 3.4)
    axes[0].set_xlabel("packing fraction phi")
    axes[0].set_ylabel("relative viscosity at high frequency")
    axes[0].legend()
    curves = ((5, "rigid spheres", "o-"), (1, "   of this stresslets, with Brownian stress", "^:"), (3, "   of this repulsion", "v:"),
              (7, "without stresslets", "s-"))
    for (column, label, style), color in zip(curves, (ex.COLORS[0], ex.COLORS[2], ex.COLORS[3], ex.COLORS[1])):
        axes[1].errorbar(found[:, 0], found[:, column], 2 * found[:, column + 1], fmt=style, color=color, label=label)
    axes[1].set_xscale("log")
    for y, marker, label in zip(experiments(PHI), "<>", ("low", "high")):
        axes[1].plot([0.7 if marker == "<" else 140], [y], marker, color=ex.COLORS[5], ms=8,
                     label=f"experiments, {label} rates (fit of de Kruif)")
    axes[1].set_ylim(0, 10.5)
    axes[1].set_xlabel("Peclet number")
    axes[1].set_ylabel("relative viscosity, and its parts")
    axes[1].legend(fontsize=8)
    if moduli is not None:
        plot_moduli(axes[2], moduli)
    ex.save(figure, "results/rheology.png")


def verdict_on_moduli(moduli):
    if moduli is None:
        return ""
    z = moduli[:, -1]
    return (f"; oscillations and fluctuations {'give' if np.abs(z).max() < LEVEL else 'do NOT give'} the same moduli "
            f"(z from {z.min():.1f} to {z.max():.1f})")


def main():
    if not os.path.exists(f"results/shear.no.{PECLET[-1]}.dat"):
        ex.fail("no results: run ./run.sh first")
    spheres, reference = compare_hard_spheres()
    noise_z = compare_fluctuations()
    found, ratios = compare_thinning()
    moduli = compare_moduli() if os.path.exists(f"results/moduli.{OMEGA[-1]:g}.dat") else None
    plot(spheres, reference, found, moduli)
    z = spheres[:, 3]
    right = np.abs(z).max() < LEVEL
    falls = [fall(found, 5), fall(found, 7)]
    print(f"verdict: the viscosity of hard spheres {'equals' if right else 'does NOT equal'} the reference (z from {z.min():.1f} to "
          f"{z.max():.1f}); fluctuations of the stress {'give' if np.abs(noise_z).max() < LEVEL else 'do NOT give'} the viscosity of shear "
          f"(z from {noise_z.min():.1f} to {noise_z.max():.1f}); from Peclet number {PECLET[1]} to {PECLET[-1]} the suspension "
          + ("thins" if min(falls) > LEVEL else "does NOT thin significantly")
          + f" with stresslets ({falls[0]:.1f} standard errors) and without ({falls[1]:.1f}); the stress scatters "
          f"{ratios.min():.2f} to {ratios.max():.2f} times as much as the white noise that the control variate takes out"
          + verdict_on_moduli(moduli))


if __name__ == "__main__":
    main()
