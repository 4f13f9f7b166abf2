#!/usr/bin/python3
"""Flow along a square duct against the series of Boussinesq (1868), and the velocity of colloids against the fluid's."""

import os
import sys

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "common"))
import bdh_examples as ex

WIDTH, DENSITY, VISCOSITY = 16.0, 0.1, 1.0
SECOND_MOMENT = 59 / 60 - np.sqrt(29) / 20      # of the kernel bkp6, in h^2: J adds half of it times the (negative) Laplacian
CELLS = (8, 16, 32, 64)
NEAREST = 3                                     # range of the springs; beyond it the density in a square is uniform


def series(y, z):
    """Velocity at distances y, z from two walls."""
    u = np.zeros(np.broadcast(y, z).shape)
    for n in range(1, 200, 2):
        k = n * np.pi / WIDTH
        x = z - WIDTH / 2
        # cosh(k x)/cosh(k WIDTH/2) without overflow
        ratio = (np.exp(k * (np.abs(x) - WIDTH / 2)) + np.exp(-k * (np.abs(x) + WIDTH / 2))) / (1 + np.exp(-k * WIDTH))
        u += 4 * DENSITY / (VISCOSITY * WIDTH * k**3) * (1 - ratio) * np.sin(k * y)
    return u


def profile(n):
    """y, z and velocity of the fluid: that of the probes, plus what interpolation subtracted."""
    (_, atoms), = ex.read_dump(f"results/profile.{n}.dat")
    h = WIDTH / n
    return atoms["y"], atoms["z"], atoms["vx"] + DENSITY / VISCOSITY * SECOND_MOMENT / 2 * h * h


def compare_grids():
    rows, errors = [], []
    for n in CELLS:
        y, z, u = profile(n)
        inside = (y >= 4) & (z >= 4)            # from there, no kernel reaches a wall on the coarsest grid
        exact = series(y, z)
        errors.append(np.abs(u - exact)[inside].max() / exact.max())
        order = f"{np.log2(errors[-2] / errors[-1]):.3f}" if len(errors) > 1 else ""
        with open(f"results/friction.{n}.dat") as f:
            words = f.read().split()
        friction = sum(map(float, words[1:5])) / float(words[6]) - 1
        rows.append([n, f"{errors[-1]:.2e}", order, f"{friction:+.0e}"])
    ex.print_table(["cells", "largest error/largest velocity", "order", "friction on four walls/driving force - 1"], rows)
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    return np.all(np.abs(orders[1:] - 2) < 0.1), errors


def fluid_in_squares():
    """Mean velocity of particles with this kernel on this grid, square by square: Simpson's rule over the probes."""
    (_, atoms), = ex.read_dump("results/profile.16.dat")
    u = np.zeros((17, 17))
    u[np.round(2 * atoms["y"]).astype(int), np.round(2 * atoms["z"]).astype(int)] = atoms["vx"]
    u = (u + u.T) / 2
    weights = np.array([1, 4, 1]) / 6
    return np.array([[weights @ u[2 * i:2 * i + 3, 2 * j:2 * j + 3] @ weights for j in range(8)] for i in range(8)])


def compare_colloids():
    _, blocks = ex.read_ave_time_vector("results/squares.dat")
    count, velocity = blocks[:, :, -2].reshape(-1, 8, 8), blocks[:, :, -1].reshape(-1, 8, 8)
    expected = fluid_in_squares()
    free = np.arange(8) >= NEAREST
    free = free[:, None] & free[None, :]
    mean = (count * velocity).sum(0) / np.maximum(count.sum(0), 1e-300)
    mean = (mean + mean.T) / 2
    ex.print_table(["distance", "velocity", "fluid", "particles"],
                   [[f"{i + 0.5:.1f} {j + 0.5:.1f}", f"{mean[i, j]:.4f}", f"{expected[i, j]:.4f}", f"{count.mean(0)[i, j]:.2f}"]
                    for i in range(NEAREST, 8) for j in range(NEAREST, i + 1)])
    ratio, error = ex.mean_and_error([(c * v)[free].sum() / (c * expected)[free].sum() for c, v in zip(count, velocity)])
    print(f"colloids over fluid, all squares: {ex.plus_minus(ratio, error)}, {(ratio - 1) / error:+.1f} standard errors from 1")
    friction, spread = ex.mean_and_error(ex.read_fix_print("results/friction.dat")[:, 1:])
    total = DENSITY * WIDTH**3
    print(f"friction on the walls {' + '.join(ex.plus_minus(f, s) for f, s in zip(friction, spread))}, driving force {total:.1f}")
    return abs(ratio - 1) < 3.5 * error and error < 0.01, mean, expected


def draw(errors, mean, expected):
    plt = ex.pyplot()
    figure, (left, right) = plt.subplots(1, 2, figsize=(10, 4))
    line = np.linspace(0, WIDTH / 2, 100)
    left.plot(line, series(line, WIDTH / 2), "k-", label="series, to the middle of a wall")
    left.plot(line, series(line, line), "k--", label="series, to a corner")
    for n, mark in ((8, "s"), (32, "o")):
        y, z, u = profile(n)
        for chosen in (z == WIDTH / 2, y == z):
            left.plot(y[chosen], u[chosen], mark, mfc="none", color=ex.COLORS[n == 8], label=f"{n} x {n} cells" if chosen[-2] else None)
    at = np.arange(NEAREST, 8)
    left.plot(at + 0.5, mean[at, at], "^", color=ex.COLORS[2], label="colloids, to a corner, 16 x 16")
    left.set(xlabel="distance to the wall", ylabel="velocity", title="square duct of width 16")
    left.legend(loc="lower right", fontsize=8)
    h = WIDTH / np.array(CELLS)
    right.loglog(h, errors, "o-", label="largest error")
    right.loglog(h, errors[-1] * (h / h[-1]) ** 2, "k:", label="second order")
    right.set(xlabel="grid spacing", ylabel="error / largest velocity")
    right.set_xticks(h, [f"{v:g}" for v in h])
    right.set_xticks([], minor=True)
    right.legend()
    ex.save(figure, "results/duct.png")


def main():
    converges, errors = compare_grids()
    agrees, mean, expected = compare_colloids()
    print("verdict: " + ("second order against the series, and colloids move with the fluid" if converges and agrees
                         else "NOT as expected"))
    draw(errors, mean, expected)


if __name__ == "__main__":
    main()
