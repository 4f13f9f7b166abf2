// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Symmetric traceless tensors, such as stresslets and rates of strain, as five numbers.
///
/// The numbers are the components along (xy + yx)/sqrt 2, (xz + zx)/sqrt 2, (yz + zy)/sqrt 2,
/// (xx - yy)/sqrt 2, (2 zz - xx - yy)/sqrt 6.  These are orthonormal: the product of two tensors is
/// that of their numbers, and a mobility that is symmetric for tensors is a symmetric matrix.
#ifndef BDH_BASE_STRAIN_KERNEL_H
#define BDH_BASE_STRAIN_KERNEL_H

#include "base/portable.h"

namespace bdh {

constexpr int strain_numbers = 5;
constexpr double sqrt_half = 0.70710678118654752440, sqrt_sixth = 0.40824829046386301637;

/// xx, yy, zz, xy, xz, yz of a tensor.
template <class Real> struct Symmetric {
  Real xx{}, yy{}, zz{}, xy{}, xz{}, yz{};

  /// Component n in this order.
  BDH_FN Real component(int n) const
  {
    return n == 0 ? xx : n == 1 ? yy : n == 2 ? zz : n == 3 ? xy : n == 4 ? xz : yz;
  }
  /// Of the matrix.
  BDH_FN Real at(int row, int column) const
  {
    return component(row == column ? row : row + column + 2);
  }
  /// From five numbers.
  BDH_FN static Symmetric of(const Real *s)
  {
    const Real a = Real(sqrt_half) * s[3], b = Real(sqrt_sixth) * s[4];
    return {a - b,
            -a - b,
            2 * b,
            Real(sqrt_half) * s[0],
            Real(sqrt_half) * s[1],
            Real(sqrt_half) * s[2]};
  }
  /// The five numbers of the tensor without its trace.
  BDH_FN void numbers(Real *s) const
  {
    s[0] = Real(2 * sqrt_half) * xy;
    s[1] = Real(2 * sqrt_half) * xz;
    s[2] = Real(2 * sqrt_half) * yz;
    s[3] = Real(sqrt_half) * (xx - yy);
    s[4] = Real(sqrt_sixth) * (2 * zz - xx - yy);
  }
};

/// The five numbers of the symmetric traceless part of a tensor G, row by row.
template <class Real> BDH_FN void strain_of(const Real (&G)[3][3], Real *s)
{
  const Real half = Real(0.5);
  Symmetric<Real>{G[0][0],
                  G[1][1],
                  G[2][2],
                  half * (G[0][1] + G[1][0]),
                  half * (G[0][2] + G[2][0]),
                  half * (G[1][2] + G[2][1])}
      .numbers(s);
}

/// Half the curl of a velocity with the gradient G, where G[a][b] = d u_a/d x_b.
template <class Real> BDH_FN void half_curl_of(const Real (&G)[3][3], Real *omega)
{
  for (int a = 0; a < 3; ++a) {
    const int b = (a + 1) % 3, c = (a + 2) % 3;
    omega[a] = Real(0.5) * (G[c][b] - G[b][c]);
  }
}

}    // namespace bdh
#endif
