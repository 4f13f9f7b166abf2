// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Error estimates of positively split Ewald for spheres of several radii, or with rotation.
///
/// As in pse/plan_errors.h, with the greatest radius as the unit of length.  Three kinds of blocks
/// err by themselves: velocities by forces, angular velocities by torques, and the coupling of
/// both.  An estimate is the largest of the three, each relative to the motions that it adds to.
#ifndef BDH_PSE_PLAN_SPHERE_ERRORS_H
#define BDH_PSE_PLAN_SPHERE_ERRORS_H

#include "pse/near_kernel.h"
#include "pse/plan_errors.h"
#include "pse/radii.h"
#include "pse/shapes_kernel.h"

#include <array>
#include <vector>

namespace bdh {

/// What the estimates need to know of the spheres.
struct SphereSuspension {
  double density;    ///< spheres per cubed greatest radius
  double particles;
  double least;                        ///< the least radius over the greatest
  double phi;                          ///< volume fraction
  std::vector<RadiusClass> classes;    ///< in units of the greatest radius, which the last one has
  bool rotation;
  bool stresslets = false;

  double equal_velocity() const;
  double random_velocity() const;
  /// The angular velocities that forces alone cause, over that of a sphere by a torque of one; and
  /// likewise velocities by torques.
  double coupled() const;
  /// A sum of squares over neighbors, given at the mean density, for one neighbor, and for a
  /// greatest sphere per volume: as Suspension::clustered(), and the greatest may be together.
  double clustered(double at_mean_density, double one, double greatest) const;
  ShapeBasis basis() const
  {
    return stresslets ? stress_basis(least, 1.0) : shape_basis(least, 1.0);
  }
};

/// The estimates for one splitting parameter.
class SphereErrors {
 public:
  SphereErrors(const SphereSuspension &suspension, double xi);
  /// What pairs beyond r contribute.
  double real_space(double r) const;
  /// What modes beyond k contribute.
  double wave_space(double k) const;

 private:
  /// What the pairs of two classes leave out: the velocity of i by a load on j, relative to the
  /// motion of j.
  struct Pair {
    double translation, rotation, coupling, equal;
  };
  /// The same of all pairs beyond a distance, at a density of 1: sums of squares, or of values
  /// (equal), and the largest of a single pair.
  struct Beyond {
    Pair sum{}, one{};
  };
  using Functions = std::array<double, near_functions<Moments::torque>()>;
  using Shapes = std::array<Functions, shape_pairs>;

  void add_classes(const std::vector<Shapes> &wave, double ai, double aj);
  Pair pair_at(double r, const Shapes &wave, double ai, double aj) const;
  const Beyond &beyond(double r, std::size_t i, std::size_t j) const;
  double of_loads_on(std::size_t j, double r) const;

  SphereSuspension suspension_;
  ShapeBasis basis_;
  double xi_, step_;
  std::vector<std::vector<Beyond>> tail_;    // by pair of classes, at multiples of step_
};

/// As WindowError.
class SphereWindowError {
 public:
  SphereWindowError(const SphereSuspension &suspension, double xi, double k_cut);
  double operator()(const Window &window, double h) const;

 private:
  static constexpr int points = 14, images = 2 * AliasSums::farthest;
  /// The share of one kind of block: weights of the modes with a given index along an axis.
  struct Kind {
    double unit;    // what the errors are relative to
    int slopes;     // how many of the two windows are gradients
    std::array<double, points> own, own_slope, own_slopes, others, others_slopes;
  };
  /// The transform of the window at an image of a mode, relative to that at the mode.
  struct Image {
    double ratio, wavenumber;
  };
  using Images = std::array<std::array<Image, images>, points>;
  double error(const Kind &kind, const Images &at) const;

  SphereSuspension suspension_;
  double k_cut_;
  std::array<double, points> q_;
  std::vector<Kind> kinds_;
};

}    // namespace bdh
#endif
