// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// The periodic cell of LAMMPS, orthogonal or triclinic, and its reciprocal lattice.
#ifndef BDH_GRID_CELL_KERNEL_H
#define BDH_GRID_CELL_KERNEL_H

#include "base/constants.h"
#include "base/portable.h"

#include <cmath>

namespace bdh {

/// Edge vectors a = (lx, 0, 0), b = (xy, ly, 0), c = (xz, yz, lz) from the corner `lo` [length].
struct Cell {
  double lo[3] = {0.0, 0.0, 0.0};
  double lx = 1.0, ly = 1.0, lz = 1.0;
  double xy = 0.0, xz = 0.0, yz = 0.0;

  BDH_FN double volume() const { return lx * ly * lz; }
  /// The length |a|, |b| or |c| of an edge.  A mode with |k| <= k_c has |index along d| <= k_c
  /// edge(d)/(2 pi), whatever the tilt.
  BDH_FN double edge(int d) const
  {
    if (d == 0) return lx;
    return d == 1 ? std::sqrt(xy * xy + ly * ly) : std::sqrt(xz * xz + yz * yz + lz * lz);
  }
  /// Distance of the two faces across axis d.
  BDH_FN double height(int d) const
  {
    if (d == 2) return lz;
    if (d == 1) return ly * lz / std::sqrt(lz * lz + yz * yz);
    const double u = ly * lz, v = xy * lz, w = xy * yz - ly * xz;
    return volume() / std::sqrt(u * u + v * v + w * w);
  }
  /// s := coordinates of x along a, b, c from the corner; [0, 1) inside the cell.
  BDH_FN void to_fractional(const double *x, double *s) const
  {
    const double z = x[2] - lo[2], y = x[1] - lo[1];
    s[2] = z / lz;
    s[1] = (y - yz * s[2]) / ly;
    s[0] = (x[0] - lo[0] - xy * s[1] - xz * s[2]) / lx;
  }
  /// r := m_0 a + m_1 b + m_2 c
  BDH_FN void lattice_vector(const double *m, double *r) const
  {
    r[0] = m[0] * lx + m[1] * xy + m[2] * xz;
    r[1] = m[1] * ly + m[2] * yz;
    r[2] = m[2] * lz;
  }
  /// k with k.a = 2 pi n_0, k.b = 2 pi n_1, k.c = 2 pi n_2   [1/length]
  BDH_FN void wave_vector(double n0, double n1, double n2, double *k) const
  {
    k[0] = two_pi * n0 / lx;
    k[1] = (two_pi * n1 - xy * k[0]) / ly;
    k[2] = (two_pi * n2 - xz * k[0] - yz * k[1]) / lz;
  }
};

/// g := the gradient of the coordinate along one of the cell's edges, in spacings of n points
/// [1/length].
BDH_FN void gradient_of_spacings(const Cell &cell, int edge, long n, double *g)
{
  cell.wave_vector(edge == 0, edge == 1, edge == 2, g);
  for (int c = 0; c < 3; ++c) g[c] *= n / two_pi;
}

}    // namespace bdh
#endif
