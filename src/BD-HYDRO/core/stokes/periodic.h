// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Fluctuating steady Stokes equations in a periodic box.
#ifndef BDH_STOKES_PERIODIC_H
#define BDH_STOKES_PERIODIC_H

#include "grid/fft.h"
#include "stokes/modes_kernel.h"
#include "stokes/solver.h"

#include <vector>

namespace bdh {

/// The symbols of one axis, one array for each part, so that strips along the axis load them with
/// unit stride.
template <class Real> struct AxisTable {
  AlignedArray<Real> s, cos_half, sin_half;
  AxisSymbolOf<Real> operator[](long i) const { return {s[i], cos_half[i], sin_half[i]}; }
};

/// All directions are periodic, and the mean velocity is zero.
///
/// Fourier modes diagonalise everything, so the random velocity is drawn there: two complex normals
/// per mode (one in 2D) have the covariance of the divergence of a stochastic stress,
/// FIB eq. (28), (30).  Grid, transforms, modes and random numbers are in Real.
template <class Real> class PeriodicStokes : public StokesSolver<Real> {
 public:
  /// Collective.
  PeriodicStokes(const Grid &grid, const Comm &comm, const FftSetup &setup,
                 const Workers &workers = Workers::one());
  const GridParts &parts() const override { return fft_.parts(); }
  std::size_t allocation() const override { return fft_.allocation(); }
  SolveReport solve(const FieldOf<Real> &field, const StokesProblem &problem) override;
  std::size_t memory() const override { return fft_.memory(); }

 private:
  struct Modes;

  Grid grid_;
  VectorFft<Real> fft_;
  std::array<AxisTable<Real>, 3> symbol_;
};

extern template class PeriodicStokes<float>;
extern template class PeriodicStokes<double>;

}    // namespace bdh
#endif
