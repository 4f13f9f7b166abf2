#!/usr/bin/python3
"""Distribution of free particles inside a grid cell: uniform, or biased as predicted for Euler-Maruyama without drift.

Without the drift the density P obeys d_i d_j (M_ij P) = 0 instead of d_i (M_ij d_j P) = 0, whose solution is uniform.
This equation is solved here with Fourier series, with the mobility measured by in.mobility."""

import os
import sys

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "common"))
import bdh_examples as ex

BINS = 12


def measured(scheme):
    """Density by block [block, bin x, bin y], mean 1."""
    _, blocks = ex.read_ave_time_vector(f"results/{scheme}/count.dat")
    counts = blocks[:, :, 0].reshape(len(blocks), BINS, BINS).transpose(0, 2, 1)      # bin number = 1 + ix + 12 iy
    return counts / counts.mean(axis=(1, 2), keepdims=True)


def mobility():
    """M_xx and M_xy [ix, iy] at bin centers; M_yy(x, y) = M_xx(y, x)."""
    table = np.loadtxt("results/mobility.dat")
    return table[:, 2].reshape(BINS, BINS), table[:, 3].reshape(BINS, BINS)


def euler_density():
    """Mean 1 over the cell; solves d_i d_j (M_ij P) = 0."""
    xx, xy = mobility()
    k = 2 * np.pi * np.fft.fftfreq(BINS, 1.0 / BINS)
    kx, ky = k[:, None], k[None, :]

    def apply(p):
        terms = kx * kx * np.fft.fft2(xx * p) + ky * ky * np.fft.fft2(xx.T * p) + 2 * kx * ky * np.fft.fft2(xy * p)
        return np.fft.ifft2(terms).real.ravel()

    size = BINS * BINS
    matrix = np.array([apply(e.reshape(BINS, BINS)) for e in np.eye(size)]).T
    matrix = np.vstack([matrix, np.full(size, np.abs(matrix).max())])          # last row: the mean
    right = np.zeros(size + 1)
    right[-1] = matrix[-1].sum()
    return np.linalg.lstsq(matrix, right, rcond=None)[0].reshape(BINS, BINS)


def symmetrise(q):
    """Mean over the eight symmetries of the square cell; q [..., x, y]."""
    images = [q, q[..., ::-1, :], q[..., :, ::-1], q[..., ::-1, ::-1]]
    images += [np.swapaxes(i, -1, -2) for i in images]
    return sum(images) / 8


def independent_bins():
    """One index pair for each set of bins equivalent by symmetry, and the number of bins in the set."""
    half = BINS // 2
    return [((i, j), 4 if i == j else 8) for i in range(half) for j in range(i + 1)]


def test(blocks, expected):
    """chi2 of the symmetrised density in the bins that are independent under symmetry, without the last (their sum is
    fixed)."""
    folded, target = symmetrise(blocks), symmetrise(expected)
    chosen = [b for b, _ in independent_bins()][:-1]
    samples = np.array([[block[b] for b in chosen] for block in folded])
    return ex.joint_test(samples, [target[b] for b in chosen])


def plot(results, predicted):
    plt = ex.pyplot()
    panels = [("euler", results["euler"].mean(0)), ("midpoint", results["midpoint"].mean(0)),
              ("euler, predicted", predicted)]
    figure, axes = plt.subplots(1, 3, figsize=(11, 3.4), gridspec_kw={"wspace": 0.22})
    for ax, (title, density) in zip(axes, panels):
        image = ax.imshow(density.T, origin="lower", extent=(0, 1, 0, 1), vmin=0.985, vmax=1.015, cmap="RdBu_r")
        ax.set_title(title)
        ax.set_xlabel("x / h")
        ax.grid(False)
    axes[0].set_ylabel("y / h")
    figure.colorbar(image, ax=axes, label="density", shrink=0.9, pad=0.02)
    ex.save(figure, "results/cell.png")


def main():
    predicted = euler_density()
    xx, _ = mobility()
    low, high = xx.min() / xx.mean() - 1, xx.max() / xx.mean() - 1
    print(f"\nmobility in a cell: mean {xx.mean():.5f}, from {low:+.2%} to {high:+.2%}; "
          f"predicted density of Euler: {predicted.min() - 1:+.2%} to {predicted.max() - 1:+.2%}")
    results, rows, probabilities = {}, [], {}
    uniform = np.ones((BINS, BINS))
    for scheme in ("euler", "midpoint"):
        if not os.path.exists(f"results/{scheme}/count.dat"):
            ex.fail("no results: run ./run.sh first")
        blocks = results[scheme] = measured(scheme)
        mean, error = ex.mean_and_error(symmetrise(blocks))
        for name, expected in (("uniform", uniform), ("predicted bias", predicted)):
            chi2, dof, p = test(blocks, expected)
            probabilities[scheme, name] = p
            # amplitude: 1 if the density deviates from uniform as predicted for Euler, 0 if it does not
            shape = symmetrise(predicted) - 1
            amplitudes = ((symmetrise(blocks) - 1) * shape).sum((1, 2)) / (shape**2).sum()
            rows.append([scheme, name, len(blocks), f"{chi2:.1f}", dof, f"{p:.2g}",
                         ex.plus_minus(*ex.mean_and_error(amplitudes))])
        print(f"{scheme}: densities {mean.min() - 1:+.2%} to {mean.max() - 1:+.2%}, error {error.mean():.2%}")
    ex.print_table(["scheme", "tested against", "blocks", "chi2", "bins", "probability", "amplitude of Euler's bias"],
                   rows)
    plot(results, predicted)
    good = (probabilities["midpoint", "uniform"] > 0.002 and probabilities["euler", "uniform"] < 1e-4
            and probabilities["euler", "predicted bias"] > 0.002)
    print("verdict: " + ("midpoint is uniform, Euler has the bias predicted from the mobility" if good else
                         "NOT as expected: midpoint must be uniform and Euler biased as predicted"))


if __name__ == "__main__":
    main()
