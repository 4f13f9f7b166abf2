// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Weights of the window under a batch of particles, and the stencils that they make.
#ifndef BDH_PSE_WINDOW_WEIGHTS_H
#define BDH_PSE_WINDOW_WEIGHTS_H

#include "base/portable.h"
#include "grid/stencil.h"
#include "pse/window_kernel.h"

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
    start(coefficient, weight);
    for (int k = 1; k <= degree; ++k) {
      const Real *c = coefficient + k * W;
      for (int i = 0; i < W; ++i)
        for (int p = 0; p < batch; ++p) weight[i][p] = weight[i][p] * t[p] + c[i];
    }
  }
  /// The same, and slope := derivatives with respect to the position, in inverse spacings.
  [[gnu::noinline]] void compute(const double *x, const Real *coefficient, int degree,
                                 BatchWeights<Real, W> &slope)
  {
    alignas(64) Real t[batch];
    place(x, t);
    start(coefficient, weight);
    for (int i = 0; i < W; ++i)
      for (int p = 0; p < batch; ++p) slope[i][p] = Real(0);
    for (int k = 1; k <= degree; ++k) {
      const Real *c = coefficient + k * W;
      for (int i = 0; i < W; ++i)
        for (int p = 0; p < batch; ++p) {
          slope[i][p] = slope[i][p] * t[p] + weight[i][p];
          weight[i][p] = weight[i][p] * t[p] + c[i];
        }
    }
    for (int i = 0; i < W; ++i)
      for (int p = 0; p < batch; ++p) slope[i][p] *= window_slope;
  }

 private:
  void place(const double *x, Real *t)
  {
    BDH_INDEPENDENT
    for (int p = 0; p < batch; ++p) {
      double place;
      first[p] = first_window_line(x[p], W, place);
      t[p] = place;
    }
  }
  static void start(const Real *coefficient, BatchWeights<Real, W> &weight)
  {
    for (int i = 0; i < W; ++i)
      for (int p = 0; p < batch; ++p) weight[i][p] = coefficient[i];
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
