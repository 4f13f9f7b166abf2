// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Rotne-Prager-Yamakawa mobility of two equal spheres, in free space and with Hasimoto splitting.
///
/// Lengths are in units of the radius a, xi in 1/a, mobilities in 1/(6 pi viscosity a).  The block
/// of a pair is transverse (I - r r^T/r^2) + longitudinal r r^T/r^2.
/// PSE stands for Fiore et al., J. Chem. Phys. 146 (2017).
#ifndef BDH_PSE_RPY_KERNEL_H
#define BDH_PSE_RPY_KERNEL_H

#include "base/portable.h"

#include <cmath>

namespace bdh {

struct RpyPair {
  double transverse;      // F of PSE (A1)
  double longitudinal;    // G
};

/// sin(x)/x, 1 at x = 0: the shape factor of the surface of a sphere.
BDH_FN double sinc(double x) { return x == 0.0 ? 1.0 : std::sin(x) / x; }

/// j_1(x)/x = (sin x - x cos x)/x^3, 1/3 at x = 0.  The series replaces it below 1, where the
/// difference would cancel.
BDH_FN double bessel1_ratio(double x)
{
  const double x2 = x * x;
  if (x2 > 1.0) return (std::sin(x) - x * std::cos(x)) / (x2 * x);
  double s = 1.0;
  for (int n = 9; n > 0; --n) s = 1.0 - s * x2 / (2.0 * n * (2.0 * n + 3.0));
  return s / 3.0;
}

/// H of PSE (11): the fraction of a mode that is summed in wave space; 1 at k = 0.
BDH_FN double hasimoto_split(double k, double xi)
{
  const double t = k / (2.0 * xi), t2 = t * t;
  return (1.0 + t2) * std::exp(-t2);
}

/// PSE (4) for r >= 0; 1 at r = 0.
BDH_FN RpyPair free_space_rpy(double r)
{
  if (r <= 2.0) return {1.0 - 9.0 / 32.0 * r, 1.0 - 6.0 / 32.0 * r};
  const double inv_r = 1.0 / r, inv_r3 = inv_r * inv_r * inv_r;
  return {0.75 * inv_r + 0.5 * inv_r3, 1.5 * inv_r - inv_r3};
}

/// PSE (A4): the real-space part at r = 0.
BDH_FN double real_space_self(double xi)
{
  const double root_pi = 1.77245385090551602730;
  return -std::expm1(-4.0 * xi * xi) / (4.0 * root_pi * xi) + std::erfc(2.0 * xi);
}

/// PSE (A2), (A3) for r > 0.  The terms cancel when r or xi r is small; real_space_exact() of
/// pse/rpy.h has no such loss.  At large r, where all terms are small, the relative error is about
/// 1e-12.
BDH_FN RpyPair real_space_closed_form(double r, double xi)
{
  const double root_pi = 1.77245385090551602730;
  const double r2 = r * r, r3 = r2 * r, x2 = xi * xi, x4 = x2 * x2, below = r - 2.0,
               above = r + 2.0;
  const double p = 4.0 + 4.0 * r + 9.0 * r2, q = 4.0 - 4.0 * r + 9.0 * r2, s = 2.0 + 3.0 * r,
               t = 2.0 - 3.0 * r;
  const double below2 = below * below, above2 = above * above;
  const double e1 = std::exp(-r2 * x2), e2 = std::exp(-below2 * x2), e3 = std::exp(-above2 * x2);
  const double c4 = std::erfc(r * xi), c5 = std::erfc(below * xi), c6 = std::erfc(above * xi);
  const double gauss = 1.0 / (128.0 * root_pi * r3 * x2 * xi), error = 1.0 / (256.0 * r3 * x4);

  const double f1 = 2.0 * r * (18.0 * r2 * x2 + 3.0);
  const double f2 = -2.0 * x2 * below * p - s;
  const double f3 = -2.0 * x2 * above * q + t;
  const double f4 = 6.0 - 72.0 * r2 * r2 * x4;
  const double f5 = 4.0 * x4 * below2 * p - 3.0;
  const double f6 = 4.0 * x4 * above2 * q - 3.0;

  const double g1 = 4.0 * r * (6.0 * r2 * x2 - 3.0);
  const double g2 = 2.0 * s * (1.0 - 2.0 * x2 * below2);
  const double g3 = -2.0 * t * (1.0 - 2.0 * x2 * above2);
  const double g4 = -12.0 * (4.0 * r2 * r2 * x4 + 1.0);
  const double g5 = 2.0 * (3.0 + 4.0 * x4 * below2 * below * s);
  const double g6 = 2.0 * (3.0 - 4.0 * x4 * above2 * above * t);

  RpyPair m = {(f1 * e1 + f2 * e2 + f3 * e3) * gauss + (f4 * c4 + f5 * c5 + f6 * c6) * error,
               (g1 * e1 + g2 * e2 + g3 * e3) * gauss + (g4 * c4 + g5 * c5 + g6 * c6) * error};
  if (r < 2.0) {    // f_0 and g_0, the only difference between the two cases of App. A
    m.transverse -= below2 * p / (32.0 * r3);
    m.longitudinal -= below2 * below * s / (16.0 * r3);
  }
  return m;
}

}    // namespace bdh
#endif
