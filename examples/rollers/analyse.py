#!/usr/bin/python3
"""Microrollers over a plate: one roller against the expansions for a sphere near a plate, the velocities of all rollers of a strip
against the sum of Blake's tensors, and the fingers that the front of the strip grows, whose size the height over the plate selects."""

import glob
import os
import re
import sys

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "common"))
import bdh_examples as ex
import blake

SIDES = (200.0, 192.0)              # of the box, as in in.rollers
FREQUENCY, DT = 60.0, 0.002
NEAR = 12.0                         # radii; nearer rollers are spheres, those farther away points
REACH = 800.0                       # radii; images up to here are summed one by one
PROBES = 24
FRONT = 0.4                         # of the rollers are those that are farthest ahead
GROWN = (1.2, 1.6)                  # times the height: when the fingers are measured
DOUBLED = 3.0                       # growth of the front's waves that counts as fingers
SHORTEST = 14.0                     # wavelength; the longest is the width of the box


# ---- one roller -----------------------------------------------------------------------------------------------------

def compare_single(table):
    """Largest deviations of the velocity and of the angular velocity."""
    H, velocity, spin = table.T
    rolls, turns = 1 / (8 * H**4), 1 - 5 / (16 * H**3)
    spin = spin * turns[-1] / spin[-1]        # the rotational radius is that far from the plate
    print("one roller: velocity over (radius x angular velocity far away), angular velocity over that far away")
    ex.print_table(["height", "rolls", "theory", "turns", "theory"],
                   [[f"{h:g}", f"{v:.4f}", f"{r:.4f}", f"{w:.4f}", f"{t:.4f}"] for h, v, r, w, t in zip(H, velocity, rolls, spin, turns)])
    return np.abs(velocity - rolls).max(), np.abs(spin - turns).max()


# ---- many rollers at the beginning ----------------------------------------------------------------------------------

def expected_velocity(i, x, force, torque):
    """Velocity of roller i: itself, the others and all images as RPY spheres, far away as points; the rest by an integral."""
    here, H = x[i], x[i, 2]
    u = force[i] + blake.rpy(here, here, wall_part_only=True) @ force[i] + blake.rotlet(here, here, wall_part_only=True) @ torque[i]
    sources = np.concatenate([x] + [x + v for v in blake.lattice(SIDES, REACH + SIDES[0])])
    number = np.tile(np.arange(len(x)), len(sources) // len(x))
    distance = np.hypot(*(sources - here)[:, :2].T)
    near = (distance < NEAR) & (distance > 0)
    far = (distance >= NEAR) & (distance < REACH)
    for which, green, turn in ((near, blake.rpy, blake.rotlet), (far, blake.blake, blake.point_rotlet)):
        u = u + np.einsum("nij,nj->i", green(here, sources[which]), force[number[which]])
        u = u + np.einsum("nij,nj->i", turn(here, sources[which]), torque[number[which]])
    # A torque about y is a pair of forces along x: half the derivative of the tail with respect to the height of its source.
    tail = blake.beyond(H, SIDES, REACH)
    total = force.sum(0)[:2] * tail + 0.5 * tail / H * np.array([torque[:, 1].sum(), -torque[:, 0].sum()])
    return u + np.array([total[0], total[1], 0.0])


def compare_start(path):
    """Relative error of the velocities, in the 2-norm over probes, and their mean along x."""
    frame = ex.read_dump(path)[0][1]
    x, v, f, t = (np.stack([frame[n] for n in names], axis=1) for names in
                  (("x", "y", "z"), ("vx", "vy", "vz"), ("fx", "fy", "fz"), ("tqx", "tqy", "tqz")))
    probes = np.linspace(0, len(x) - 1, PROBES).astype(int)
    expected = np.array([expected_velocity(i, x, f, t) for i in probes])
    error = np.linalg.norm(v[probes] - expected) / np.linalg.norm(expected)
    return error, v[:, 0].mean(), expected[:, 0].mean(), v[probes, 0].mean()


# ---- fingers --------------------------------------------------------------------------------------------------------

def front_spectrum(frame, k):
    """|sum_j exp(i k y_j)|^2/n over the rollers ahead."""
    ahead = np.argsort(frame["xu"])[-int(FRONT * len(frame["xu"])):]
    return np.abs(np.exp(1j * np.outer(k, frame["yu"][ahead])).sum(1))**2 / len(ahead)


def waves_of(frames):
    """Times, wave numbers, and the spectrum of the front [time, wave]."""
    k = 2 * np.pi * np.arange(1, int(SIDES[1] / SHORTEST) + 1) / SIDES[1]
    return np.array([step * DT for step, _ in frames]), k, np.array([front_spectrum(frame, k) for _, frame in frames])


def wavelength(time, k, S, H):
    """Mean wavelength of what has grown beyond the waves of the beginning, when rollers are at random places and the mean of S is 1;
    and its standard error, by leaving out one seed at a time.  S: [seed, time, wave]."""
    grown = S[:, (time > (GROWN[0] - 1e-6) * H) & (time < (GROWN[1] + 1e-6) * H)].mean(1) - 1.0

    def of(seeds):
        return 2 * np.pi * seeds.sum() / (seeds @ k).sum()

    without = np.array([of(np.delete(grown, i, axis=0)) for i in range(len(grown))])
    return of(grown), np.sqrt((len(without) - 1) * np.var(without))


def time_of(growth, time, power):
    """When the power first exceeds `growth`, or nan."""
    return time[np.argmax(power > growth)] if (power > growth).any() else float("nan")


def plot(strip, growth, heights, waves):
    plt = ex.pyplot()
    figure = plt.figure(figsize=(9.5, 6.0))
    grid = figure.add_gridspec(2, 5, height_ratios=[1.15, 1.0], hspace=0.1, wspace=0.1)
    for place, index in enumerate(np.linspace(0, len(strip) - 1, 5).astype(int)):
        step, frame = strip[index]
        axis = figure.add_subplot(grid[0, place])
        axis.plot(frame["xu"] % SIDES[0], frame["yu"] % SIDES[1], "o", ms=1.3, color=ex.COLORS[0])
        axis.set(xlim=(0, SIDES[0]), ylim=(0, SIDES[1]), aspect="equal", xticks=(0, 100), title=f"t = {step * DT:g}")
        axis.tick_params(labelleft=place == 0)
        axis.grid(False)
    left, right = figure.add_subplot(grid[1, :2]), figure.add_subplot(grid[1, 3:])
    for (time, power, H), color in zip(growth, ex.COLORS):
        left.semilogy(time, power, color=color, label=f"height {H:g}")
    left.set(xlabel="time [radius$^2$/D$_0$]", ylabel="power of the front's waves", yticks=(1, 2, 5, 10),
             yticklabels=(1, 2, 5, 10))
    left.minorticks_off()
    left.legend()
    mean, error = np.array(waves).T
    right.errorbar(heights, mean, error, fmt="o", color=ex.COLORS[1])
    slope = (mean * heights / error**2).sum() / (np.square(heights) / error**2).sum()
    right.plot([0, 1.1 * heights[-1]], [0, 1.1 * slope * heights[-1]], "-", lw=1, color=ex.COLORS[5], label=f"{slope:.0f} x height")
    right.legend()
    right.set(xlabel="height over the plate [radii]", ylabel="wavelength [radii]", xlim=(0, None), ylim=(0, None))
    ex.save(figure, "results/rollers.png")


def strips(heights, found):
    """Errors of velocities, growth curves and wavelengths for each height."""
    errors, rows, growth, waves = [], [], [], []
    for H in heights:
        error, mean, theory, sample = compare_start(found[H][0].replace("rollers.dump", "start.dump"))
        errors.append(error)
        measured = [waves_of(ex.read_dump(path)) for path in found[H]]
        time, k, S = measured[0][0], measured[0][1], np.array([spectrum for _, _, spectrum in measured])
        S /= S[:, 0].mean()
        power = S.mean((0, 2))
        growth.append((time, power, H))
        waves.append(wavelength(time, k, S, H))
        rows.append([f"{H:g}", f"{mean:.2f}", f"{sample:.2f}", f"{theory:.2f}", f"{error:.3f}", f"{time_of(DOUBLED, time, power):g}",
                     ex.plus_minus(*waves[-1])])
    print("\na strip of rollers: mean velocity along x at the beginning, fingers")
    ex.print_table(["height", "all", f"{PROBES} of them", "Blake, RPY", "error", f"grown {DOUBLED:g}-fold at", "wavelength"], rows)
    return errors, growth, waves


def main():
    runs = sorted(glob.glob("results/*_*/rollers.dump"))
    if not runs:
        ex.fail("no results: run ./run.sh first")
    rolls, turns = compare_single(ex.read_fix_print("results/single.dat"))
    found = {}
    for path in runs:
        found.setdefault(float(re.match(r"results/(.*)_", path)[1]), []).append(path)
    heights = sorted(found)
    errors, growth, waves = strips(heights, found)
    plot(ex.read_dump(found[heights[0]][0]), growth, heights, waves)
    (first, first_error), (last, last_error) = waves[0], waves[-1]
    ratio, spread = last / first, last / first * np.hypot(first_error / first, last_error / last)
    expected = heights[-1] / heights[0]
    proportional = abs(ratio - expected) < 3 * spread and ratio - 1 > 3 * spread
    grows = all((power > DOUBLED).any() for _, power, _ in growth)
    print(f"verdict: one roller {'rolls and turns' if rolls < 0.01 and turns < 0.02 else 'does NOT roll and turn'} as near a plate, to "
          f"{rolls:.3f} and {turns:.3f}; the velocities of the strip {'are' if max(errors) < 0.03 else 'are NOT'} those of RPY spheres, to "
          f"{max(errors):.3f}; the front {'breaks' if grows else 'does NOT break'} up into fingers, whose wavelength "
          f"{'is' if proportional else 'is NOT'} proportional to the height: {ex.plus_minus(ratio, spread)} times for {expected:g} times "
          "the height")


if __name__ == "__main__":
    main()
