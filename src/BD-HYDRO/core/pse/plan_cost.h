// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// What an evaluation of positively split Ewald costs on one core: a formula, with constants that
/// were fitted to bench_pse_step and bench_pse_scan (bench/README.md).  Only ratios matter for the
/// choice of a plan.
#ifndef BDH_PSE_PLAN_COST_H
#define BDH_PSE_PLAN_COST_H

#include "pse/plan.h"

namespace bdh {

/// Numbers of others around a particle of a scene, as counted, or evenly spread.
class Surroundings {
 public:
  Surroundings(const PseScene &scene, const PairCounts &counts);
  /// Within r [length]: the mean over particles, that of particles with many neighbors, the
  /// largest.
  double mean(double r) const;
  double crowded(double r) const;
  double largest(double r) const;
  /// Ratio of the greatest to the least eigenvalue of a plan's real-space part, roughly.
  /// Spheres of several radii are taken for those of the radius of their mean volume.
  ///
  /// The greatest one belongs to forces that push all particles within about 0.8/xi one way: the
  /// sum of their pair functions as far as it grows.  The least one belongs to two neighbors that
  /// are pushed apart.  Motions of a cluster as a whole, or of large parts of it, are so few that
  /// Lanczos finds them one by one.  They do not count, and so an xi below 0.4 over the radius of a
  /// part with an eighth of all particles is as good as that.
  double condition(const PsePlan &plan) const;

 private:
  /// Distance within which particles with many others have that number of them [radius].
  double distance_with(double others) const;

  const PairCounts &counts_;
  double radius_;      // that of the mean volume
  double density_;     // [1/length^3]
  double nearest_;     // distance of the nearest neighbor [radius]
  double least_xi_;    // of those that make a difference to the condition [1/radius]
};

/// Of the sizes for an axis of n points or more, multiples of 4 without prime factors above 7, the
/// one whose transforms take the least time if the other axes have ordinary sizes.
long cheapest_fft_size(long n);

/// Conjugate gradients that rigid spheres take after a first guess, up to phi = 0.3: 4 to 5 at
/// 1e-2, 8 at 1e-4, 12 at 1e-6.
int expected_constraint_iterations(double tolerance);

/// Lanczos iterations until the estimate is below the tolerance; within about a quarter of what
/// hard spheres, gels and globules of overlapping spheres need.
int expected_iterations(double condition, double tolerance);

/// Sets what the pairs of a plan with cutoffs and a precision cost: neighbors, iterations,
/// real_seconds, pair_bytes.  skin: of the neighbor list [length].
void price_pairs(const PseScene &scene, const Surroundings &around, double skin, PsePlan &plan);
/// Sets what a plan with a grid and a window costs there: modes, wave_seconds, grid_bytes.
void price_grid(const PseScene &scene, PsePlan &plan);

}    // namespace bdh
#endif
