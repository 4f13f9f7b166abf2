// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Tables of the wave-space part in real space, for two shape functions (pse/near_kernel.h).
#ifndef BDH_PSE_NEAR_TABLE_H
#define BDH_PSE_NEAR_TABLE_H

#include "base/aligned.h"
#include "pse/near_kernel.h"

#include <array>
#include <cstddef>
#include <vector>

namespace bdh {

/// A splitting, and a rule for integrals over its modes.
class WaveIntegral {
 public:
  /// Hasimoto's; xi [1/length]
  WaveIntegral(double xi) : weight_{false, xi, {}} {}
  /// For distances up to r_cut [length].
  WaveIntegral(const WaveWeight &weight, double r_cut);

  double xi() const { return weight_.xi; }
  /// Calls action(k, part) at wave numbers, part times the returned number being the weight of two
  /// spheres of shapes sinc(k b_p) and sinc(k b_q), or like them, times dk.
  template <class Action>
  double for_modes(double r, double bp, double bq, const Action &action) const;

 private:
  WaveWeight weight_;
  std::vector<double> k_, dk_, common_;    // of Kaiser-Bessel weights
};

/// What wave space makes of two spheres of shapes sinc(k b_p) and sinc(k b_q) at distance r, in
/// units of 1/(6 pi viscosity); see NearFunctions for the order.
///
///     U = (3/pi) int H s_p s_q [(j_0 - j_1/x) (I - e e^T) + 2 j_1/x e e^T] dk F,   x = k r,
///     W = -(3/2pi) int H s_p s_q k j_1 dk e x F;   W by torques as U by forces, with k^2/4
///
/// H s_p s_q: the weight, as it is with Hasimoto's splitting.  r >= 0 [length]
/// Errors: about 1e-15 of the value at r = 0.
std::array<double, near_functions<Moments::torque>()> wave_functions(double r, double bp, double bq,
                                                                     const WaveIntegral &integral);

/// What stresslets need: the translation as above, and the derivatives of the function B of
/// pse/strain_pair_kernel.h,
///
///     b_m = -(3/pi) (-1)^m int H s_p s_q k^(2m - 2) j_m(x)/x^m dk,
///
/// in the order r b_2, r^3 b_3 of a force and a moment, b_2, r^2 b_3, r^4 b_4 of two moments.
std::array<double, near_functions<Moments::stresslet>()>
wave_derivatives(double r, double bp, double bq, const WaveIntegral &integral);

template <class Real, Moments moments> class NearTable {
 public:
  /// r_cut: end of the table [length].  error: largest error of a scaled function of any pair of
  /// spheres whose radii the basis covers.  Throws InvalidOption for a table that would be too
  /// long.
  NearTable(const ShapeBasis &basis, const WaveIntegral &integral, double r_cut, double error);

  NearFunctions<Real, moments> functions() const
  {
    return {coefficients_.data(), inv_width_, intervals_};
  }
  std::size_t coefficient_count() const { return coefficients_.size(); }
  std::size_t memory() const { return coefficients_.size() * sizeof(Real); }

 private:
  AlignedArray<Real> coefficients_;
  Real inv_width_ = 0;
  int intervals_ = 0;
};

}    // namespace bdh
#endif
