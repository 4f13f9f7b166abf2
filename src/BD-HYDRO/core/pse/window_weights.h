// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Weights of the window under a batch of particles, and the stencils that they make.
#ifndef BDH_PSE_WINDOW_WEIGHTS_H
#define BDH_PSE_WINDOW_WEIGHTS_H

#include "base/portable.h"
#include "base/registers.h"
#include "grid/stencil.h"
#include "pse/window_kernel.h"

#include <algorithm>

namespace bdh {

/// Weights of a batch of particles along one axis.  They are computed in functions that are not
/// inlined: the loops that use them are many, and each would be compiled with a copy.
template <class Real, int W> struct WindowWeights {
  alignas(64) BatchWeights<Real, W> weight;
  alignas(64) int first[batch];

  /// x: `batch` positions in spacings.  Coefficients: WindowPolynomials::coefficients().
  [[gnu::noinline]] void compute(const double *x, const Real *coefficient, int degree)
  {
    alignas(64) Real t[batch];
    place(x, t);
    for (int p = 0; p < batch; p += lanes)
      for (int i = 0; i < W; ++i) {
        const Lanes u = lanes_at<Real, lanes>(t + p);
        Lanes w = all(coefficient[i]);
        for (int k = 1; k <= degree; ++k) w = w * u + all(coefficient[k * W + i]);
        put_lanes<Real, lanes>(w, weight[i] + p);
      }
  }
  /// The same, and slope := derivatives with respect to the position, in inverse spacings.
  [[gnu::noinline]] void compute(const double *x, const Real *coefficient, int degree,
                                 BatchWeights<Real, W> &slope)
  {
    alignas(64) Real t[batch];
    place(x, t);
    for (int p = 0; p < batch; p += lanes)
      for (int i = 0; i < W; ++i) {
        const Lanes u = lanes_at<Real, lanes>(t + p);
        Lanes w = all(coefficient[i]), dw{};
        for (int k = 1; k <= degree; ++k) {
          dw = dw * u + w;
          w = w * u + all(coefficient[k * W + i]);
        }
        put_lanes<Real, lanes>(w, weight[i] + p);
        put_lanes<Real, lanes>(Real(window_slope) * dw, slope[i] + p);
      }
  }

 private:
  // Vectors by hand: g++ takes the coefficients for numbers that the weights may overwrite, and at
  // -O2 it does not check whether they do.
  static constexpr int lanes = std::min(batch, lanes_of_register<Real>);
  static_assert(batch % lanes == 0);
  using Lanes = LanesOf<Real, lanes>;

  static Lanes all(Real number) { return number - Lanes{}; }
  void place(const double *x, Real *t)
  {
    BDH_INDEPENDENT
    for (int p = 0; p < batch; ++p) {
      double place;
      first[p] = first_window_line(x[p], W, place);
      t[p] = place;
    }
  }
};

/// The stencil of particle p of a batch.
template <class Real, int W> [[gnu::always_inline]] inline Stencil<Real, W>
window_stencil(const WindowWeights<Real, W> (&axis)[3], int p, const GridLines &lines)
{
  const BatchWeights<Real, W> *const w[3] = {&axis[0].weight, &axis[1].weight, &axis[2].weight};
  const long first[3] = {axis[0].first[p], axis[1].first[p], axis[2].first[p]};
  return make_stencil<Real, W, 3>(p, w, first, lines);
}

}    // namespace bdh
#endif
