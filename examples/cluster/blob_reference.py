#!/usr/bin/python3
"""Reference curve with the pair mobility that the blobs of fix bd/fib have, instead of the Rotne-Prager-Yamakawa form.

    blob_reference.py KERNEL SPACING [dt] [trajectories] > reference_blob_KERNEL.csv

Shares no code with the package.  First the Stokes equations are solved on a small MAC grid with numpy's FFT, for
forces at random positions in a cell.  This gives the mean pair mobility I(r) 1 + Q(r) rr/r^2 of two blobs in free space.
Periodic images are removed: -2.837/(6 pi eta L) exactly, the remainder of order 1/L^3 by comparing two box sizes.  Then
the cluster is simulated with dense 39 x 39 matrices, Euler-Maruyama and Cholesky factors.
"""

import os
import sys

import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "common"))

KT, ETA = 12.3, 1.0
EPS, SIGMA = 10.0, 6.4
D = 2 ** (1 / 6) * SIGMA
C = 58.5 * EPS / 3.2**3
PAIRS = np.triu_indices(13, 1)


# ---- pair mobility of two blobs, spacing 1 and viscosity 1 -----------------------------------------------------------

def roma3(r):
    r = np.abs(r)
    inner = (1 + np.sqrt(np.maximum(1 - 3 * r * r, 0))) / 3
    outer = (5 - 3 * r - np.sqrt(np.maximum(1 - 3 * (1 - r) ** 2, 0))) / 6
    return np.where(r < 0.5, inner, np.where(r < 1.5, outer, 0.0))


def peskin4(r):
    r = np.abs(r)
    inner = (3 - 2 * r + np.sqrt(np.maximum(1 + 4 * r - 4 * r * r, 0))) / 8
    outer = (5 - 2 * r - np.sqrt(np.maximum(-7 + 12 * r - 4 * r * r, 0))) / 8
    return np.where(r < 1, inner, np.where(r < 2, outer, 0.0))


KERNELS = {"roma3": roma3, "peskin4": peskin4}


def weights(kernel, x, component, n):
    """Indices and weights [point, 4 or fewer] per axis of the faces of one component around points x."""
    out = []
    for axis in range(3):
        place = x[:, axis] - (0.0 if axis == component else 0.5)
        index = np.floor(place).astype(int)[:, None] + np.arange(-2, 4)
        out.append((index % n, kernel(place[:, None] - index)))
    return out


def velocity_field(kernel, n, source):
    """Fluid velocity [component, n, n, n] of a unit force along x spread at `source`; zero mean."""
    (ix, wx), (iy, wy), (iz, wz) = weights(kernel, source[None], 0, n)
    f = np.zeros((n, n, n))
    np.add.at(f, np.ix_(ix[0], iy[0], iz[0]), np.einsum("i,j,k->ijk", wx[0], wy[0], wz[0]))
    fk = np.fft.rfftn(f)
    k = [2 * np.pi * np.fft.fftfreq(n)[:, None, None], 2 * np.pi * np.fft.fftfreq(n)[None, :, None],
         2 * np.pi * np.fft.rfftfreq(n)[None, None, :]]
    g = [1 - np.exp(-1j * q) for q in k]         # divergence of faces: difference to the next face, up to a phase
    square = sum(abs(q) ** 2 for q in g)
    square[0, 0, 0] = np.inf
    dot = g[0].conj() * fk / square
    u = [((fk if d == 0 else 0) - g[d] * dot) / square for d in range(3)]
    return [np.fft.irfftn(q, s=(n, n, n), axes=(0, 1, 2)) for q in u]


def interpolate(kernel, u, x):
    n = len(u[0])
    out = np.empty((len(x), 3))
    for d in range(3):
        (ix, wx), (iy, wy), (iz, wz) = weights(kernel, x, d, n)
        out[:, d] = np.einsum("pi,pj,pk,pijk->p", wx, wy, wz, u[d][ix[:, :, None, None], iy[:, None, :, None],
                                                                   iz[:, None, None, :]])
    return out


def pair_functions(kernel, n, r, offsets, directions, rng):
    """I(r), Q(r) and the self mobility, averaged over positions in a cell, for a periodic box of n^3 cells."""
    table, self_mobility = np.zeros((len(r), 2)), 0.0
    for _ in range(offsets):
        source = rng.random(3) + n // 2
        u = velocity_field(kernel, n, source)
        self_mobility += interpolate(kernel, u, source[None])[0, 0] / offsets
        for i, distance in enumerate(r):
            e = rng.standard_normal((directions, 3))
            e /= np.linalg.norm(e, axis=1, keepdims=True)
            e = np.concatenate([e, -e])
            v = interpolate(kernel, u, source + distance * e)
            design = np.stack([np.eye(3)[0] + 0 * e, e[:, :1] * e], axis=-1).reshape(-1, 2)
            table[i] += np.linalg.lstsq(design, v.ravel(), rcond=None)[0] / offsets
    return table, self_mobility


def free_space(kernel, r, offsets=40, directions=30):
    """Pair functions without periodic images."""
    found = []
    for n in (32, 64):
        table, own = pair_functions(kernel, n, r, offsets, directions, np.random.default_rng(1))
        hasimoto = 2.837297 / (6 * np.pi * n)
        found.append(np.vstack([table + [hasimoto, 0], [own + hasimoto, 0]]))
    both = found[1] + (found[1] - found[0]) / 7
    return both[:-1], both[-1, 0]


# ---- Brownian dynamics with dense matrices ---------------------------------------------------------------------------

def start():
    with open(os.path.join(HERE, "data.cluster")) as f:
        lines = f.read().split("Atoms # atomic")[1].split("\n")
    return np.array([[float(w) for w in line.split()[2:5]] for line in lines if line.strip()])


def forces(x):
    d = x[:, PAIRS[0]] - x[:, PAIRS[1]]
    r = np.linalg.norm(d, axis=-1)
    s6 = (SIGMA / r) ** 6
    over_r = np.where(r < D, (24 * EPS * (2 * s6 * s6 - s6) / r - C * (D * D - r * r)) / r, 0.0)
    f = np.zeros_like(x)
    for p, (i, j) in enumerate(zip(*PAIRS)):
        f[:, i] += over_r[:, p, None] * d[:, p]
        f[:, j] -= over_r[:, p, None] * d[:, p]
    return f


def mobility(x, r_table, table, own):
    d = x[:, PAIRS[0]] - x[:, PAIRS[1]]
    r = np.linalg.norm(d, axis=-1)
    e = d / r[..., None]
    inside, q = np.interp(r, r_table, table[:, 0]), np.interp(r, r_table, table[:, 1])
    far = r > r_table[-1]                                  # there both functions decay as 1/r
    inside = np.where(far, table[-1, 0] * r_table[-1] / r, inside)
    q = np.where(far, table[-1, 1] * r_table[-1] / r, q)
    block = inside[..., None, None] * np.eye(3) + q[..., None, None] * e[..., :, None] * e[..., None, :]
    m = np.zeros((len(x), 13, 3, 13, 3))
    m[:, PAIRS[0], :, PAIRS[1], :] = np.moveaxis(block, 1, 0)
    m[:, PAIRS[1], :, PAIRS[0], :] = np.moveaxis(block, 1, 0)
    each = np.arange(13)
    m[:, each, :, each, :] = own * np.eye(3)
    return m.reshape(len(x), 39, 39)


def radius_of_gyration(x):
    y = x - x.mean(1, keepdims=True)
    return np.sqrt((y * y).sum((1, 2)) / 13)


def is_one_cluster(x):
    bonded = np.linalg.norm(x[:, None] - x[None], axis=-1) < D
    return (np.linalg.matrix_power(bonded.astype(float), 12) > 0).all()


def simulate(r_table, table, own, dt, trajectories, duration=100.0, seed=1):
    rng = np.random.default_rng(seed)
    x = np.repeat(start()[None], trajectories, 0)
    every = round(0.5 / dt)
    curve = [radius_of_gyration(x)]
    for step in range(1, round(duration / dt) + 1):
        m = mobility(x, r_table, table, own)
        kick = np.linalg.cholesky(m) @ rng.standard_normal((trajectories, 39, 1))
        move = dt * m @ forces(x).reshape(trajectories, 39, 1) + np.sqrt(2 * KT * dt) * kick
        x = x + move.reshape(x.shape)
        if step % every == 0:
            curve.append(radius_of_gyration(x))
            if step % (20 * every) == 0:
                print(f"  t = {step * dt:g}", file=sys.stderr)
    return np.array(curve), np.array([is_one_cluster(q) for q in x])


def main():
    name, h = sys.argv[1], float(sys.argv[2])
    dt = float(sys.argv[3]) if len(sys.argv) > 3 else 0.05
    trajectories = int(sys.argv[4]) if len(sys.argv) > 4 else 512
    r = np.concatenate([np.arange(0, 6, 0.1), np.arange(6, 10.1, 0.5)])
    table, own = free_space(KERNELS[name], r)
    table, own = table / (ETA * h), own / (ETA * h)
    curve, bound = simulate(h * r, table, own, dt, trajectories)
    kept = curve[:, bound]
    print(f"# Radius of gyration of the cluster, pair mobility of blobs with kernel {name}, spacing {h:g}; free space,")
    print(f"# {trajectories} trajectories, dt = {dt:g}, Euler-Maruyama; source: blob_reference.py.")
    print(f"# self mobility {own:.6g}: radius {1 / (6 * np.pi * ETA * own):.4f}; bound: those that end as one cluster")
    print("t,Rg_bound_mean,Rg_bound_se,frac_one_cluster")
    for i, g in enumerate(kept):
        print(f"{0.5 * i:.1f},{g.mean():.6f},{g.std(ddof=1) / np.sqrt(g.size):.6f},{bound.mean():.4f}")


if __name__ == "__main__":
    main()
