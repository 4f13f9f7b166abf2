"""Mobility of one particle in a two-dimensional channel with no-slip walls at y = 0 and y = HEIGHT, from the discrete Stokes
equations by a sparse LU factorization: the mobility of in.slit, computed without any of its code.  Units: h = eta = 1.

    python3 channel.py        compares with reference_channel.csv, the channel of 8 x 64 cells of Table I
"""

import numpy as np
from scipy import sparse
from scipy.sparse import linalg


def peskin4(x):
    """4-point kernel of Peskin, Acta Numerica 11, 479 (2002), eq. (6.27)."""
    x = np.abs(x)
    near = (3 - 2 * x + np.sqrt(np.maximum(1 + 4 * x - 4 * x**2, 0))) / 8
    far = (5 - 2 * x - np.sqrt(np.maximum(-7 + 12 * x - 4 * x**2, 0))) / 8
    return np.where(x < 1, near, np.where(x < 2, far, 0.0))


def mobilities(height, H, offset, width=8):
    """Mobility along and across the walls at distances H from one of them, `offset` from a corner of a cell along them.

    Staggered grid: u at (i, j + 1/2), v at (i + 1/2, j), v = 0 in the walls; beyond a wall u changes sign.  Near a wall the
    kernel is folded back with its sign changed.  No mean pressure gradient.
    """
    wide, high = sparse.identity(width), sparse.identity(height)
    ring = sparse.csr_matrix(np.roll(np.eye(width), 1, axis=1))                       # ring f = f(i + 1)
    laplace_x = ring + ring.T - 2 * wide
    diagonal = np.full(height, -2.0)
    diagonal[[0, -1]] = -3.0
    laplace_u = sparse.diags([1.0, diagonal, 1.0], [-1, 0, 1], shape=(height, height))
    laplace_v = sparse.diags([1.0, -2.0, 1.0], [-1, 0, 1], shape=(height - 1, height - 1))
    L_u = sparse.kron(laplace_x, high) + sparse.kron(wide, laplace_u)
    L_v = sparse.kron(laplace_x, sparse.identity(height - 1)) + sparse.kron(wide, laplace_v)
    D_u = sparse.kron(ring - wide, high)                                              # to cell centers (i + 1/2, j + 1/2)
    D_v = sparse.kron(wide, sparse.diags([1.0, -1.0], [0, -1], shape=(height, height - 1)))
    matrix = sparse.bmat([[-L_u, None, -D_u.T], [None, -L_v, -D_v.T], [D_u, D_v, None]]).tolil()
    pressure = L_u.shape[0] + L_v.shape[0]
    matrix[pressure, :] = 0                                                           # the mean pressure is free
    matrix[pressure, pressure] = 1
    solve = linalg.splu(matrix.tocsc()).solve

    def along(x):
        distance = x - np.arange(width)
        return peskin4(distance - width * np.round(distance / width))

    def across(y, nodes):
        return peskin4(nodes - y) - peskin4(nodes + y) - peskin4(2 * height - nodes - y)

    result = []
    for y in np.atleast_1d(H):
        weights = (np.kron(along(offset), across(y, np.arange(height) + 0.5)),
                   np.kron(along(offset - 0.5), across(y, np.arange(1.0, height))))
        u = np.zeros(matrix.shape[0])
        u[:len(weights[0])] = weights[0]
        v = np.zeros(matrix.shape[0])
        v[len(weights[0]):pressure] = weights[1]
        result.append((u @ solve(u), v @ solve(v)))
    return np.array(result)


def mean_mobilities(height, H):
    """Means of the mobilities over positions in a cell, from the three points 0, 1/4 and 1/2 of its period."""
    return 0.25 * mobilities(height, H, 0.0) + 0.5 * mobilities(height, H, 0.25) + 0.25 * mobilities(height, H, 0.5)


if __name__ == "__main__":
    import os
    import sys
    here = os.path.dirname(os.path.abspath(__file__))
    sys.path.insert(0, os.path.join(here, "..", "common"))
    import bdh_examples as ex
    table = ex.read_csv(os.path.join(here, "reference_channel.csv"))
    table = {name: column[table["kernel"] == 4] for name, column in table.items()}
    mine = sum(mobilities(64, table["H"], offset) for offset in (0.0, 0.25, 0.5)) / 3       # the mean of that table
    print("largest relative differences, along and across the walls:",
          *(f"{abs(m / table[name] - 1).max():.1e}" for m, name in zip(mine.T, ("mu_par", "mu_perp"))))
