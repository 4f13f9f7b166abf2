// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Which part of the mobility is summed in wave space: Hasimoto's function, or one without modes
/// beyond k_c.
#ifndef BDH_PSE_SPLITTING_KERNEL_H
#define BDH_PSE_SPLITTING_KERNEL_H

#include "pse/rpy_kernel.h"

#include <cmath>

namespace bdh {

/// automatic: the cheaper one, where both are possible.
enum class Splitting { automatic, hasimoto, kaiser_bessel };

/// The weight of a mode, for spheres of one radius:
///
///     W(k) = (1 + moment k^2) chi(k/k_c) for k <= k_c, 0 beyond,
///     chi(t) = sinhc(beta (1 - t^2)^(1/2))/sinhc(beta),  sinhc(x) = sinh(x)/x.
///
/// Hasimoto's splitting has W = sinc^2(ka) H(k), PSE (9).  Any W will do that agrees with
/// sinc^2(ka) to order k^2, so that what it leaves to the near part is short-ranged, and for which
/// 0 <= W <= sinc^2(ka), so that both parts are positive.  This one is the transform of a
/// function that ends at beta/k_c but for a part of exp(-beta); Hasimoto's near part ends 2a later
/// than that of points, and its modes go on beyond where they matter.
///
/// Shapes of spheres of different radii b_p and b_q can be added up (pse/shapes_kernel.h) where W
/// is a sum of terms with a factor for each sphere of a pair.  Two terms do:
///
///     W = (1 - k^2 b_p^2/6) (1 - k^2 b_q^2/6) chi + decline (k/k_c)^2 chi,
///
/// chi(t) = 1 - decline t^2 + ...  Of equal spheres that is (1 + moment k^2 + k^4 b^4/36) chi,
/// which reaches hardly farther than the weight above.  (A single factor each, 1 + moment k^2/2,
/// would reach as far only with k_c r_c larger by 4, at a tolerance of 1e-3.)
struct KaiserBesselSplit {
  double k_cut;    ///< [1/length]
  double beta;
  double radius;     ///< [length]
  double moment;     ///< [length^2]
  bool two_terms;    ///< W is that of spheres of several radii

  /// chi for 0 <= t <= 1.
  BDH_FN static double shape(double t, double beta)
  {
    // Without large numbers.  At the end of the range sinhc is 1.
    const double s = beta * std::sqrt(std::fmax(0.0, 1.0 - t * t));
    const double above = s < 1e-6 ? std::exp(-s) : -std::expm1(-2.0 * s) / (2.0 * s),
                 below = -std::expm1(-2.0 * beta) / (2.0 * beta);
    return above / below * std::exp(s - beta);
  }
  /// chi = 1 - decline t^2 + ...
  BDH_FN static double decline(double beta) { return 0.5 * (beta / std::tanh(beta) - 1.0); }

  /// W for 0 <= k <= k_cut.
  BDH_FN double weight(double k) const
  {
    const double e = k * k * radius * radius / 6.0;
    return (1.0 + moment * k * k + (two_terms ? e * e : 0.0)) * shape(k / k_cut, beta);
  }
  /// The factor of a sphere of radius b in the first term; of a single term, b is the radius.
  BDH_FN double root(double k, double b) const
  {
    if (!two_terms) return std::sqrt(weight(k));
    return (1.0 - k * k * b * b / 6.0) * std::sqrt(shape(k / k_cut, beta));
  }
  /// That of any sphere in the second term.
  BDH_FN double common_root(double k) const
  {
    if (!two_terms) return 0.0;
    return k / k_cut * std::sqrt(decline(beta) * shape(k / k_cut, beta));
  }
};

/// The one for a cutoff in real space as well [length], and spheres of a radius [length].  Of all
/// beta this one leaves least beyond r_cut, within 1 % of k_cut, for tolerances of 1e-1 to 1e-9.
BDH_FN KaiserBesselSplit kaiser_bessel_split(double k_cut, double r_cut, double radius,
                                             bool two_terms = false)
{
  const double beta = std::fmax(k_cut * r_cut - 0.45, 0.1);
  return {k_cut, beta, radius,
          KaiserBesselSplit::decline(beta) / (k_cut * k_cut) - radius * radius / 3.0, two_terms};
}

/// What the wave-space part takes of a mode, for spheres of shape sinc(k b), or like it up to k^2:
/// of two of them root(k, b_p) root(k, b_q) + common_root(k)^2.
struct WaveWeight {
  bool kaiser_bessel;
  double xi;                  ///< [1/length]
  KaiserBesselSplit split;    ///< of the greatest radius

  BDH_FN bool two_terms() const { return kaiser_bessel && split.two_terms; }
  /// For 0 < k <= k_cut [1/length].
  BDH_FN double root(double k, double b) const
  {
    return kaiser_bessel ? split.root(k, b) : sinc(k * b) * std::sqrt(hasimoto_split(k, xi));
  }
  BDH_FN double common_root(double k) const { return kaiser_bessel ? split.common_root(k) : 0.0; }
};

}    // namespace bdh
#endif
