"""Reference values for the methods: the periodic RPY mobility, and exact mobilities of two rigid spheres.

Lengths in radii, mobilities in units of 1/(6 pi eta a)."""
import json
import os

import numpy as np

HASIMOTO = 2.837297479480619
REFERENCE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "unittest", "reference", "rpy_periodic.json")


def erfc(x):
    """Complementary error function for x >= 0, relative error below 1.2e-7 (Chebyshev fit of Press et al.)."""
    t = 1 / (1 + 0.5 * x)
    c = (-1.26551223, 1.00002368, 0.37409196, 0.09678418, -0.18628806, 0.27886807, -1.13520398, 1.48851587, -0.82215223,
         0.17087277)
    return t * np.exp(-x * x + np.polynomial.polynomial.polyval(t, c))


class PeriodicRpy:
    """Mobility of Rotne, Prager and Yamakawa in a periodic cube by Ewald sums [Beenakker, J. Chem. Phys. 85, 1581 (1986)],
    k = 0 left out; overlapping pairs use the formula for overlaps.  Radius 1."""

    def __init__(self, side, accuracy=1e-6):
        self.side = side
        self.xi = xi = 3.0 / np.sqrt(side)
        reach = np.sqrt(-np.log(accuracy)) + 1.5
        self.cutoff, k_max = reach / xi, 2 * xi * reach
        n = int(np.ceil(self.cutoff / side + 0.5))
        self.images = side * np.stack(np.meshgrid(*[np.arange(-n, n + 1)] * 3, indexing="ij"), -1).reshape(-1, 3)
        n = int(np.ceil(k_max * side / (2 * np.pi)))
        k = 2 * np.pi / side * np.stack(np.meshgrid(*[np.arange(-n, n + 1)] * 3, indexing="ij"), -1).reshape(-1, 3)
        k2 = (k**2).sum(1)
        half = (k2 > 0) & (k2 < k_max**2) & ((k[:, 0] > 0) | ((k[:, 0] == 0) & ((k[:, 1] > 0) | ((k[:, 1] == 0) & (k[:, 2] > 0)))))
        self.k, k2 = k[half], k2[half]
        weight = 2 * 6 * np.pi / side**3 / k2 * (1 - k2 / 3) * (1 + k2 / (4 * xi**2) + k2**2 / (8 * xi**4)) * np.exp(-k2 / (4 * xi**2))
        kk = self.k[:, :, None] * self.k[:, None, :] / k2[:, None, None]
        self.modes = weight[:, None, None] * (np.eye(3) - kk)

    def _real(self, d):
        """Real-space block for separations d [m, 3]."""
        xi = self.xi
        r2 = (d**2).sum(1)
        r = np.sqrt(r2)
        e, g = erfc(xi * r), np.exp(-xi**2 * r2) / np.sqrt(np.pi)
        one = (0.75 / r + 0.5 / r**3) * e + (4 * xi**7 * r2**2 + 3 * xi**3 * r2 - 20 * xi**5 * r2 - 4.5 * xi + 14 * xi**3 + xi / r2) * g
        rr = (0.75 / r - 1.5 / r**3) * e + (-4 * xi**7 * r2**2 - 3 * xi**3 * r2 + 16 * xi**5 * r2 + 1.5 * xi - 2 * xi**3 - 3 * xi / r2) * g
        near = r < 2
        one = one + np.where(near, 1 - 9 * r / 32 - 0.75 / r - 0.5 / r**3, 0)
        rr = rr + np.where(near, 3 * r / 32 - 0.75 / r + 1.5 / r**3, 0)
        return one[:, None, None] * np.eye(3) + (rr / r2)[:, None, None] * d[:, :, None] * d[:, None, :]

    def matrix(self, x):
        """M [3n, 3n] of spheres at x [n, 3]."""
        n = len(x)
        i, j = np.triu_indices(n, 1)
        d = x[i] - x[j]
        d -= self.side * np.round(d / self.side)
        phase = x @ self.k.T
        c, s = np.cos(phase), np.sin(phase)
        flat = self.modes.reshape(len(self.k), 9)
        wave = np.empty((n, n, 9))
        for a in range(9):
            wave[:, :, a] = (c * flat[:, a]) @ c.T + (s * flat[:, a]) @ s.T
        m = wave.reshape(n, n, 3, 3)
        pairs = np.zeros((len(i), 3, 3))
        for image in self.images:
            shifted = d + image
            close = (shifted**2).sum(1) < self.cutoff**2
            if close.any():
                pairs[close] += self._real(shifted[close])
        m[i, j] += pairs
        m[j, i] += pairs
        own = self.images[((self.images**2).sum(1) > 0) & ((self.images**2).sum(1) < self.cutoff**2)]
        self_block = np.eye(3) * (1 + (-6 * self.xi + 40 / 3 * self.xi**3) / np.sqrt(np.pi))
        if len(own):
            self_block = self_block + self._real(own).sum(0)
        m[np.arange(n), np.arange(n)] += self_block
        return m.transpose(0, 2, 1, 3).reshape(3 * n, 3 * n)


def free_rpy(r):
    """RPY pair mobilities (along, across) the line of centers in an unbounded fluid, r >= 2."""
    return 1.5 / r - 1 / r**3, 0.75 / r + 0.5 / r**3


def two_spheres_along(r):
    """Exact mobilities of two rigid no-slip spheres along their line of centers, unbounded fluid: (self, pair).

    From the drag at equal velocities [Stimson & Jeffery, Proc. R. Soc. A 111, 110 (1926)] and at opposite velocities [Brenner,
    Chem. Eng. Sci. 16, 242 (1961)]."""
    alpha = np.arccosh(r / 2)
    n = np.arange(1, 2 + int(40 / alpha) + 40, dtype=np.longdouble)
    u = (2 * n + 1) * alpha
    keep = u < 5000
    n, u = n[keep], u[keep]
    front = 4 / 3 * np.sinh(alpha) * n * (n + 1) / ((2 * n - 1) * (2 * n + 3))
    m2 = (2 * n + 1)**2 * np.sinh(alpha)**2
    same = (front * (1 - (4 * np.sinh(u / 2)**2 - m2) / (2 * np.sinh(u) + (2 * n + 1) * np.sinh(2 * alpha)))).sum()
    opposite = (front * ((4 * np.cosh(u / 2)**2 + m2) / (2 * np.sinh(u) - (2 * n + 1) * np.sinh(2 * alpha)) - 1)).sum()
    return float((1 / same + 1 / opposite) / 2), float((1 / same - 1 / opposite) / 2)


def check():
    """Raises AssertionError if a formula above does not reproduce known numbers."""
    for side in (5.0, 16.0):
        own = PeriodicRpy(side).matrix(np.array([[0.3, 0.2, 0.1]]))[0, 0]
        assert abs(own - (1 - HASIMOTO / side + 4 * np.pi / 3 / side**3)) < 1e-5, own
    with open(REFERENCE) as f:
        cases = json.load(f)["cases"]
    for case in cases:
        if case["shape"] == "cubic" and case["N"] <= 10:
            side, a = case["box"]["Lx"] / case["a"], case["a"]
            u = PeriodicRpy(side).matrix(np.array(case["x"]) / a) @ np.array(case["f"]).ravel() / (6 * np.pi * case["eta"] * a)
            error = np.linalg.norm(u - np.array(case["u"]).ravel()) / np.linalg.norm(u)
            assert error < 1e-5, (case["id"], error)
    own, pair = two_spheres_along(60.0)
    assert abs(pair - free_rpy(60.0)[0]) < 1e-6 and abs(own - 1) < 1e-5
    own, pair = two_spheres_along(2.02)          # lubrication: 1/(own - pair) = 1/(2 h) + 9/20 ln(1/h) + O(1)
    assert abs(1 / (own - pair) - 25 - 0.45 * np.log(50)) < 1.5


if __name__ == "__main__":
    check()
    for r in (2.01, 2.1, 3.0, 6.0):
        print(r, *two_spheres_along(r), *free_rpy(r))
