// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Depletion attraction of two equal hard spheres in a bath of ideal depletants (Asakura, Oosawa).
///
/// A sphere of diameter sigma_c excludes the centres of depletants of diameter sigma_d from a zone
/// of diameter D = sigma_c + sigma_d.  Where two zones overlap, the depletants gain volume:
///     U(r) = -n kT V_overlap(r) = c (D^2 r - r^3/3 - 2 D^3/3) for r < D, 0 beyond;
///     c = (pi/4) n kT.
/// Any consistent set of units will do.

#ifndef BDH_PAIR_ASAKURA_OOSAWA_KERNEL_H
#define BDH_PAIR_ASAKURA_OOSAWA_KERNEL_H

#include "base/portable.h"

namespace bdh {

/// pi/4 and pi/6: the numbers that relate the three parametrisations.
constexpr double AO_QUARTER_PI = 0.78539816339744830962;
constexpr double AO_SIXTH_PI = 0.52359877559829887308;

/// U(r) = -(c/3) (D - r)^2 (r + 2 D); this factored form does not cancel near r = D.
/// \param r  distance between the centres, >= 0 [length]
/// \param c  strength [energy/length^3]
/// \param D  range [length]
/// \return   [energy]; 0 for r >= D, and -(2/3) c D^3 at r = 0
BDH_FN double ao_energy(double r, double c, double D)
{
  if (r >= D) return 0.0;
  const double gap = D - r;
  return -c / 3.0 * gap * gap * (r + 2.0 * D);
}

/// F(r)/r with F = -dU/dr = -c (D - r) (D + r); negative because the force attracts.
/// \return [energy/length^2]; 0 for r >= D, and 0 at r = 0, where the force has no direction
BDH_FN double ao_force_over_r(double r, double c, double D)
{
  if (r >= D || r == 0.0) return 0.0;
  return -c * (D - r) * (D + r) / r;
}

/// D = sigma_c + sigma_d [length]: the distance at which the depletion zones separate.
BDH_FN double ao_range(double sigma_c, double sigma_d) { return sigma_c + sigma_d; }

/// c = (pi/4) n kT [energy/length^3].
/// \param n   number density of depletants in the reservoir [1/length^3]
/// \param kT  thermal energy [energy]
BDH_FN double ao_strength_from_density(double n, double kT) { return AO_QUARTER_PI * n * kT; }

/// n = c / ((pi/4) kT) [1/length^3]: inverse of ao_strength_from_density.
BDH_FN double ao_density_from_strength(double c, double kT) { return c / (AO_QUARTER_PI * kT); }

/// n = eta_r / ((pi/6) sigma_d^3) [1/length^3].
/// \param eta_r    volume fraction of depletants in the reservoir; may exceed 1, since they overlap
/// \param sigma_d  diameter of a depletant [length]
BDH_FN double ao_density_from_fraction(double eta_r, double sigma_d)
{
  return eta_r / (AO_SIXTH_PI * sigma_d * sigma_d * sigma_d);
}

/// eta_r = (pi/6) n sigma_d^3: inverse of ao_density_from_fraction.
BDH_FN double ao_fraction_from_density(double n, double sigma_d)
{
  return AO_SIXTH_PI * n * sigma_d * sigma_d * sigma_d;
}

}    // namespace bdh

#endif
