// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Gauss-Legendre quadrature.
#ifndef BDH_BASE_GAUSS_LEGENDRE_H
#define BDH_BASE_GAUSS_LEGENDRE_H

#include "base/constants.h"

#include <cmath>
#include <vector>

namespace bdh {

/// Points and weights on [0, 1], exact for polynomials of degree 2 n - 1.
struct GaussLegendre {
  std::vector<double> points, weights;

  explicit GaussLegendre(int n)
  {
    for (int i = 0; i < n; ++i) {
      double z = std::cos(pi * (i + 0.75) / (n + 0.5)), slope = 1.0;
      for (int step = 0; step < 8; ++step) {    // Newton's method; it doubles the digits
        double p = 1.0, before = 0.0;
        for (int j = 0; j < n; ++j) {
          const double next = ((2.0 * j + 1.0) * z * p - j * before) / (j + 1.0);
          before = p;
          p = next;
        }
        slope = n * (z * p - before) / (z * z - 1.0);
        z -= p / slope;
      }
      points.push_back(0.5 * (1.0 - z));
      weights.push_back(1.0 / ((1.0 - z * z) * slope * slope));
    }
  }
};

}    // namespace bdh
#endif
