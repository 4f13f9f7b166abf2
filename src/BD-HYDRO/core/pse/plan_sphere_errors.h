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

/// What pairs that are left out add to the errors.
class SpherePairs {
 public:
  explicit SpherePairs(const SphereSuspension &suspension);

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
  /// What wave space makes of two spheres, by pair of shapes.
  using Shapes = std::array<Functions, shape_pairs>;

  Pair at(double r, const Shapes &wave, double ai, double aj) const;
  /// Of the loads on one class; beyond(i): what they and the class i leave out.
  template <class OfClass> double error(const OfClass &beyond) const;

  const SphereSuspension &suspension() const { return suspension_; }
  const ShapeBasis &basis() const { return basis_; }

 private:
  SphereSuspension suspension_;
  ShapeBasis basis_;
};

/// The estimates for one splitting parameter of Hasimoto's splitting.
class SphereErrors {
 public:
  SphereErrors(const SpherePairs &pairs, double xi);
  /// What pairs beyond r contribute.
  double real_space(double r) const;
  /// What modes beyond k contribute.
  double wave_space(double k) const;

 private:
  using Pair = SpherePairs::Pair;
  using Beyond = SpherePairs::Beyond;
  using Shapes = SpherePairs::Shapes;

  void add_classes(const std::vector<Shapes> &wave, double ai, double aj);
  const Beyond &beyond(double r, std::size_t i, std::size_t j) const;
  double of_loads_on(std::size_t j, double r) const;

  const SphereSuspension &suspension() const { return pairs_.suspension(); }

  SpherePairs pairs_;
  double xi_, step_;
  std::vector<std::vector<Beyond>> tail_;    // by pair of classes, at multiples of step_
};

/// What a Kaiser-Bessel splitting leaves beyond its cutoff in real space, as KaiserBesselTail.
class SphereTail {
 public:
  /// reach: k_cut r_cut
  explicit SphereTail(double reach);
  /// k_cut in 1/(greatest radius)
  double operator()(const SpherePairs &pairs, double k_cut) const;

 private:
  static constexpr double step = 0.3;
  static constexpr int half_wave = 10, waves = 3, points = 2 * waves * half_wave + 1, powers = 4;
  /// Integrals over t = k/k_c from 0 to 1 with chi t^(2m), at x = reach + i step: of j_0 - j_1/x,
  /// of 3 j_1/x - j_0, and of -t j_1/2, with the argument t x.
  struct Values {
    std::array<double, powers> transverse{}, difference{}, coupling{};
  };
  SpherePairs::Shapes shapes_at(const Values &values, const ShapeBasis &basis, double k_cut) const;
  SpherePairs::Beyond beyond(const SpherePairs &pairs, const std::vector<SpherePairs::Shapes> &wave,
                             double k_cut, double ai, double aj) const;

  double reach_, decline_;
  std::vector<Values> values_;
};

/// As WindowError.
class SphereWindowError {
 public:
  SphereWindowError(const SphereSuspension &suspension, const WaveWeight &weight, double k_cut);
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
