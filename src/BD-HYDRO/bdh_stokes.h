/// Fluctuating steady Stokes equations on a fully periodic staggered grid.
#ifndef BDH_STOKES_H
#define BDH_STOKES_H

#include "bdh_fft.h"
#include "bdh_rng_kernel.h"
#include "bdh_spread.h"
#include "bdh_stokes_kernel.h"

#include <vector>

namespace bdh {

/// One set of random stresses: weight * sqrt(2 eta kT/(dt dV)) D~ W with W drawn for `stage`.
struct StressDraw {
  double weight;
  uint32_t stage;
};

/// Right-hand side and scales of one solve.
struct StokesProblem {
  double viscosity = 1.0;           ///< [mass/(length time)]
  double kT_over_dt = 0.0;          ///< [energy/time]; 0: no noise is drawn
  uint32_t seed = 0;
  uint64_t step = 0;
  std::vector<StressDraw> stress;   ///< added up; at most a few

  bool noisy() const { return kT_over_dt > 0.0 && !stress.empty(); }
};

/// Symbols of one axis, each part on its own: strips along the axis load them with unit stride.
struct AxisTable {
  AlignedVector s, cos_half, sin_half;
  AxisSymbol operator[](long i) const { return {s[i], cos_half[i], sin_half[i]}; }
};

/// v = L^-1 f / eta + random velocity of covariance 2 kT/(eta dt dV) L^-1 (L^-1 as FIB eq. (29), zero mean velocity).
///
/// Fourier modes diagonalise everything, and the random velocity is drawn there: two complex normals per mode (one in
/// 2D) have the same covariance as the divergence of a stochastic stress, FIB eq. (28), (30).
class PeriodicStokes {
 public:
  /// Collective.
  PeriodicStokes(const Grid &grid, const Comm &comm, FftEffort effort);
  Slab slab() const { return fft_.slab(); }
  std::size_t allocation() const { return fft_.allocation(); }
  /// Collective.  field: in f [force/volume], out v [length/time].
  void solve(const FieldView &field, const StokesProblem &problem);
  std::size_t memory() const { return fft_.memory(); }

 private:
  struct Modes;

  Grid grid_;
  VectorFft<double> fft_;
  std::array<AxisTable, 3> symbol_;
};

}    // namespace bdh
#endif
