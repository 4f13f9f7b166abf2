// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// Laws of the depletion kernels, without LAMMPS.

#include "pair/asakura_oosawa_kernel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using namespace bdh;

namespace {

constexpr double PI = 3.14159265358979323846;
constexpr double C = 17.852783203125;
constexpr double D = 7.25;

/// The cubic as written in the literature.  It cancels near r = D.
double textbook_energy(double r)
{
  return C * (D * D * r - r * r * r / 3.0 - 2.0 * D * D * D / 3.0);
}

/// Overlap volume of two spheres of radius R at distance r, by a midpoint rule over discs along the
/// axis.
double overlap_volume(double R, double r)
{
  const int slices = 200000;
  const double h = (2.0 * R + r) / slices;
  double volume = 0.0;
  for (int i = 0; i < slices; i++) {
    const double x = -R + (i + 0.5) * h;
    const double disc = std::min(R * R - x * x, R * R - (x - r) * (x - r));
    volume += PI * std::max(0.0, disc) * h;
  }
  return volume;
}

}    // namespace

// The factored form equals the textbook cubic; the bound is the cancellation of the latter.
TEST(AsakuraOosawaEnergy, EqualsTextbookCubic)
{
  for (double r = 0.0; r < D; r += 0.01)
    EXPECT_NEAR(ao_energy(r, C, D), textbook_energy(r), 1e-15 * 4.0 * C * D * D * D);
}

// U = -n kT V_overlap for spheres of radius D/2.  The error of the midpoint rule is of order h^2,
// about 1e-10 of V(0).
TEST(AsakuraOosawaEnergy, IsOsmoticPressureTimesOverlapVolume)
{
  const double sigma_c = 5.0, sigma_d = 1.5, n = 0.7, kT = 12.3;
  const double range = ao_range(sigma_c, sigma_d);
  const double c = ao_strength_from_density(n, kT);
  const double scale = n * kT * overlap_volume(range / 2.0, 0.0);
  for (double r : {0.0, 0.3, 1.0, 3.0, 5.0, 6.0, 6.4, 6.499, 6.5, 7.0})
    EXPECT_NEAR(ao_energy(r, c, range), -n * kT * overlap_volume(range / 2.0, r), 1e-9 * scale)
        << r;
}

// For a cubic the error of central differences is only h^2 U'''/6 = c h^2/3, plus the round-off of
// U divided by h.
TEST(AsakuraOosawaForce, IsMinusSlopeOfEnergy)
{
  const double h = 1e-4;
  const double bound = C * h * h + 4e-16 * C * D * D * D / h;
  for (double r = 0.05; r < D - h; r += 0.05) {
    const double slope = (ao_energy(r + h, C, D) - ao_energy(r - h, C, D)) / (2.0 * h);
    EXPECT_NEAR(ao_force_over_r(r, C, D) * r, -slope, bound) << r;
  }
}

TEST(AsakuraOosawaForce, AttractsEverywhereInside)
{
  for (double r = 0.01; r < D; r += 0.01) EXPECT_LT(ao_force_over_r(r, C, D), 0.0) << r;
}

TEST(AsakuraOosawaRange, ValueAndSlopeVanishAtD)
{
  EXPECT_EQ(ao_energy(D, C, D), 0.0);
  EXPECT_EQ(ao_force_over_r(D, C, D), 0.0);
  EXPECT_EQ(ao_energy(1.5 * D, C, D), 0.0);
  EXPECT_EQ(ao_force_over_r(1.5 * D, C, D), 0.0);
}

// Just inside, U = -c D gap^2 and F = -2 c D gap to leading order, without cancellation.
TEST(AsakuraOosawaRange, LeadingOrderInsideIsAccurate)
{
  for (double r : {std::nextafter(D, 0.0), D - 1e-12, D - 1e-9}) {
    const double gap = D - r;
    EXPECT_NEAR(ao_energy(r, C, D) / (-C * D * gap * gap), 1.0, 1e-9);
    EXPECT_NEAR(ao_force_over_r(r, C, D) * r / (-2.0 * C * D * gap), 1.0, 1e-9);
  }
}

TEST(AsakuraOosawaContact, HasNoForceAndFiniteEnergy)
{
  EXPECT_EQ(ao_force_over_r(0.0, C, D), 0.0);
  EXPECT_NEAR(ao_energy(0.0, C, D), -2.0 / 3.0 * C * D * D * D, 1e-15 * C * D * D * D);
  EXPECT_TRUE(std::isfinite(ao_force_over_r(1e-160, C, D)));
}

TEST(AsakuraOosawaStrength, ZeroSwitchesOff)
{
  EXPECT_EQ(ao_energy(1.0, 0.0, D), 0.0);
  EXPECT_EQ(ao_force_over_r(1.0, 0.0, D), 0.0);
}

// c = (pi/4) n kT with n = 6 eta_r/(pi sigma_d^3), hence c = 3 eta_r kT/(2 sigma_d^3).
TEST(AsakuraOosawaParameters, FractionGivesDensityGivesStrength)
{
  const double eta_r = 0.35, sigma_d = 0.4, kT = 1.7;
  const double n = ao_density_from_fraction(eta_r, sigma_d);
  EXPECT_NEAR(n, 6.0 * eta_r / (PI * std::pow(sigma_d, 3)), 1e-15 * n);
  const double c = ao_strength_from_density(n, kT);
  EXPECT_NEAR(c, 1.5 * eta_r * kT / std::pow(sigma_d, 3), 1e-14 * c);
}

TEST(AsakuraOosawaParameters, ConversionsInvert)
{
  const double n = 3.1, sigma_d = 0.4, kT = 1.7;
  EXPECT_NEAR(ao_density_from_strength(ao_strength_from_density(n, kT), kT), n, 1e-15 * n);
  EXPECT_NEAR(ao_density_from_fraction(ao_fraction_from_density(n, sigma_d), sigma_d), n,
              1e-15 * n);
}

// The usual form of the depth at contact is -eta_r kT (1 + 3/(2 q)) with q = sigma_d/sigma_c.
TEST(AsakuraOosawaParameters, DepthAtContactOfTheSpheres)
{
  const double sigma_c = 2.0, sigma_d = 0.3, eta_r = 0.35, kT = 1.7;
  const double c = ao_strength_from_density(ao_density_from_fraction(eta_r, sigma_d), kT);
  const double depth = eta_r * kT * (1.0 + 1.5 * sigma_c / sigma_d);
  EXPECT_NEAR(ao_energy(sigma_c, c, ao_range(sigma_c, sigma_d)), -depth, 1e-13 * depth);
}
