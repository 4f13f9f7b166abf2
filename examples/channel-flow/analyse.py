#!/usr/bin/python3
"""Velocity of colloids across a channel against the parabola of the fluid, and the friction on the walls."""

import os
import sys

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "common"))
import bdh_examples as ex

HEIGHT, VISCOSITY, DENSITY, AREA = 24.0, 1.0, 0.05, 256.0
SECOND_MOMENT = 59 / 60 - np.sqrt(29) / 20      # of the kernel bkp6: interpolation adds half of it times the Laplacian
SPRINGS = 3.0                                   # range of the springs, within which the density in a layer is not uniform


def parabola(z):
    """Fluid velocity as the particles see it; the spacing is 1."""
    return DENSITY / (2 * VISCOSITY) * (z * (HEIGHT - z) + 0.25 - SECOND_MOMENT)


def profile(folder):
    """Layers beyond the springs: their midpoints, and the velocity by block [block, layer]."""
    _, blocks = ex.read_ave_time_vector(f"results/{folder}/profile.dat")
    z, velocity = blocks[0, :, 0], blocks[:, :, 2]
    free = (z > SPRINGS) & (z < HEIGHT - SPRINGS)
    return z[free], velocity[:, free]


def main():
    z, velocity = profile("free")
    # The mean of the parabola over a layer of height 1 is its value at the middle minus 1/12 of half the curvature.
    expected = parabola(z) - DENSITY / (2 * VISCOSITY) / 12
    mean, error = ex.mean_and_error(velocity)
    ex.print_table(["z", "velocity", "parabola", "deviation/s.e."],
                   [[f"{a:.1f}", ex.plus_minus(m, e), f"{p:.4f}", f"{(m - p) / e:+.1f}"] for a, m, e, p in zip(z, mean, error, expected)])
    ratio, spread = ex.mean_and_error(velocity.sum(1) / expected.sum())
    print(f"without repulsion: velocity over parabola {ex.plus_minus(ratio, spread)}, {(ratio - 1) / spread:+.1f} standard errors from 1")
    z_wca, slow = profile("wca")
    ratio, spread = ex.mean_and_error(slow.sum(1) / parabola(z_wca).sum())
    print(f"with repulsion: {ex.plus_minus(ratio, spread)}: stress between colloids slows the flow")
    for folder in ("free", "wca"):
        friction = ex.read_fix_print(f"results/{folder}/walls.dat")[:, 1:].mean(0)
        print(f"friction on the walls {friction[0]:.4f} + {friction[1]:.4f}, driving force {DENSITY * AREA * HEIGHT:.4f}")
    draw(z, mean, error, z_wca, *ex.mean_and_error(slow))


def draw(z, mean, error, z_wca, slow, slow_error):
    import matplotlib.pyplot as plt
    line = np.linspace(0, HEIGHT, 200)
    plt.figure(figsize=(5, 4))
    plt.plot(parabola(line), line, "k-", label="fluid without colloids")
    plt.errorbar(mean, z, xerr=error, fmt="o", label="free particles")
    plt.errorbar(slow, z_wca, xerr=slow_error, fmt="s", label="repulsive colloids")
    plt.xlabel("velocity")
    plt.ylabel("z/h")
    plt.legend()
    plt.tight_layout()
    plt.savefig("results/channel-flow.png", dpi=120)
    print("drawn: results/channel-flow.png")


if __name__ == "__main__":
    main()
