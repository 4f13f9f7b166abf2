#!/usr/bin/python3
"""Particles that are held: the drag on cubic lattices against sedimentation reversed, the reciprocal theorem for posts and
colloids, and the velocity of colloids past posts with and without hydrodynamic interactions."""

import os
import sys

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "common"))
import bdh_examples as ex

TOLERANCE, POSTS_TOLERANCE = 1e-4, 1e-3         # of the decks
FORCE, EDGE = 10.0, 16.0
NAMES = {"yes": "fluid sticks to colloids and posts", "colloids": "fluid flows through the posts", "no": "no hydrodynamic interactions"}
LATTICES = ("sc", "bcc", "fcc")
# Drag on a simple cubic lattice of solid spheres, with everything: Zick and Homsy, J Fluid Mech 115, 13 (1982), table 2
SOLID = np.array([[0.027, 2.008], [0.064, 2.810], [0.125, 4.292], [0.216, 7.442], [0.343, 15.4], [0.45, 28.1]])
MADELUNG = {"sc": 1.760118884, "bcc": 1.791858511, "fcc": 1.791747230}


def drag(lattice, phi):
    """That of Rotne-Prager-Yamakawa spheres, in closed form."""
    return 1 / (1 - MADELUNG[lattice] * phi**(1 / 3) + phi)


# ---- lattices -------------------------------------------------------------------------------------------------------

def compare_lattices():
    """Largest error of the velocity over that of a single sphere, and of the drag, relative; table [number, phi, drag, ...]."""
    reference = ex.read_csv("lattices.csv")
    tables = {s: ex.read_fix_print(f"results/{s}/drag.dat") for s in ("no", "yes")}
    worst, rows = np.zeros(2), []
    for n, name in enumerate(LATTICES, 1):
        for phi in np.unique(reference["phi"]):
            pick = (reference["lattice"] == name) & (reference["phi"] == phi)
            here = [t[(t[:, 0] == n) & np.isclose(t[:, 1], phi)][0] for t in tables.values()]
            velocity = reference["velocity"][pick][0]
            expected = 1 / velocity
            for row in here:
                worst = np.maximum(worst, np.abs([1 / row[2] - velocity, row[2] / expected - 1]))
            rows.append([name, f"{phi:g}", f"{expected:.5f}", f"{here[0][2]:.5f}", f"{here[1][2]:.5f}"])
    print("\ndrag on a sphere of a lattice that is held, over 6 pi viscosity radius velocity")
    ex.print_table(["lattice", "phi", "reference", "bd/pse", "stresslet yes"], rows)
    return worst, tables["no"]


# ---- posts ----------------------------------------------------------------------------------------------------------

def compare_reciprocity():
    one, other = ex.read_fix_print("results/reciprocity.dat")[0]
    print(f"\nreciprocity: force of the fluid on fixed posts times velocity {one:.5f}; force on colloids times their velocity "
          f"if the posts move {other:.5f}")
    return abs(one / other - 1)


def compare_velocities():
    """Mean velocity over that of a single colloid in an endless fluid, and its error, by hydrodynamics."""
    found = {}
    for h in NAMES:
        table = ex.read_fix_print(f"results/posts.{h}.dat")[:, 1:]
        found[h] = ex.mean_and_error(table[:, 0] / FORCE)
        print(f"{NAMES[h]}: velocity of the colloids {ex.plus_minus(*found[h])} of that of a single one")
        if h == "yes":
            print(f"  force of the fluid on the posts {ex.plus_minus(*ex.mean_and_error(table[:, 1] / (24 * FORCE)))} of that on all colloids")
    return found


def tracks(hydrodynamics):
    """Posts [post, xy], and positions [frame, colloid, xyz]; and how far a bead of a post has moved."""
    frames = [columns for _, columns in ex.read_dump(f"results/tracks.{hydrodynamics}")]
    place = np.array([np.stack([f["x"], f["y"], f["z"]], -1) for f in frames])
    posts = frames[0]["type"] == 1
    beads = place[:, posts]
    shift = beads - beads[0]
    shift -= np.round(shift / EDGE) * EDGE
    return np.unique(np.round(beads[0][:, :2], 6), axis=0), place[:, ~posts], np.abs(shift).max()


# ---- figure ---------------------------------------------------------------------------------------------------------

def draw_tracks(axes, plt, posts, colloids, title):
    for k in range(colloids.shape[1]):
        x, y = colloids[:, k, 0] % EDGE, colloids[:, k, 1] % EDGE
        cut = np.flatnonzero(np.hypot(np.diff(x), np.diff(y)) > EDGE / 2) + 1      # through a face of the box
        for piece in np.split(np.arange(len(x)), cut):
            axes.plot(x[piece], y[piece], "-", lw=0.5, alpha=0.7, color=ex.COLORS[k % 5])
    for x, y in posts:
        axes.add_patch(plt.Circle((x, y), 1.0, color="#333333", zorder=3))
    axes.set_title(title, fontsize=10)
    axes.set_xlim(0, EDGE)
    axes.set_ylim(0, EDGE)
    axes.set_aspect("equal")
    axes.grid(False)
    axes.set_xlabel("x / radius")


def plot(table, found):
    plt = ex.pyplot()
    figure, axes = plt.subplots(1, 3, figsize=(13, 3.9), gridspec_kw={"wspace": 0.22, "width_ratios": [1.15, 1, 1]})
    phi = np.geomspace(8e-4, 0.52, 200)
    for n, name in enumerate(LATTICES, 1):
        here = table[table[:, 0] == n]
        axes[0].plot(phi, drag(name, phi), "-", lw=1, color=ex.COLORS[n - 1])
        axes[0].plot(here[:, 1], here[:, 2], "os^"[n - 1], color=ex.COLORS[n - 1], label=f"{name}, held")
    axes[0].plot(*SOLID.T, "x", ms=6, color="#333333", label="sc, solid spheres (Zick, Homsy)")
    axes[0].plot([], [], "-", lw=1, color=ex.COLORS[5], label="sedimentation reversed")
    axes[0].set_ylim(0, 30)
    axes[0].set_xlabel("packing fraction phi")
    axes[0].set_ylabel("drag / 6 pi viscosity radius velocity")
    axes[0].legend(fontsize=8)
    for a, h in zip(axes[1:], ("yes", "no")):
        posts, colloids, _ = tracks(h)
        draw_tracks(a, plt, posts, colloids[:len(colloids) // 3], f"{NAMES[h]}: {found[h][0]:.2f}")
    axes[1].set_ylabel("y / radius")
    ex.save(figure, "results/obstacles.png")


def main():
    if not os.path.exists("results/posts.no.dat"):
        ex.fail("no results: run ./run.sh first")
    worst, table = compare_lattices()
    reciprocity = compare_reciprocity()
    found = compare_velocities()
    moved = tracks("yes")[2]
    plot(table, found)
    print(f"verdict: the drag on lattices {'is' if worst[0] < TOLERANCE else 'is NOT'} that of sedimentation reversed (velocities to "
          f"{worst[0]:.1e} of that of a single sphere, tolerance {TOLERANCE:g}; drag to {worst[1]:.1e}); the reciprocal theorem {'holds' if reciprocity < POSTS_TOLERANCE else 'does NOT hold'} "
          f"({reciprocity:.1e}); posts {'stay' if moved < 1e-4 else 'do NOT stay'} in place (moved by {moved:.0e}); "
          f"colloids move {found['colloids'][0] / found['yes'][0]:.2f} times as fast if the fluid flows through the posts, and "
          f"{found['no'][0] / found['yes'][0]:.2f} times without hydrodynamic interactions")


if __name__ == "__main__":
    main()
