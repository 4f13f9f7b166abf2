// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Parameters of positively split Ewald from a tolerance: error estimates, cost model, choice of
/// the splitting.
///
/// The cutoff rule of the paper, r_c = sqrt(-ln tol)/xi, ignores that the real-space part decays
/// from r = 2a on; here cutoffs come from the sums that they leave out. [PSE sec. II C; (25)-(28)]
#ifndef BDH_PSE_PLAN_H
#define BDH_PSE_PLAN_H

#include "base/constants.h"
#include "grid/cell_kernel.h"
#include "pse/layout.h"
#include "pse/pair_counts.h"
#include "pse/radii.h"
#include "pse/rpy.h"
#include "pse/shapes_kernel.h"
#include "pse/splitting_kernel.h"
#include "pse/window.h"

#include <array>
#include <cmath>
#include <string>
#include <tuple>
#include <vector>

namespace bdh {

enum class Precision { automatic, single_precision, double_precision };

/// Throws InvalidOption for an unknown name.
Precision precision_from_name(const std::string &name);

/// What a plan is for.  It keeps the tolerance wherever the particles go.
struct PseScene {
  double volume = 1.0;    ///< [length^3]
  /// Longest edge vectors that the cell will have [length].
  std::array<double, 3> edge{1.0, 1.0, 1.0};
  long particles = 1;
  double radius = 1.0;          ///< the greatest [length]
  double least_radius = 0.0;    ///< [length]; 0: all radii are equal
  double mean_cube = 0.0;       ///< of the radii [length^3]; 0: all radii are equal
  RadiusClasses classes;        ///< of the radii, if they are not equal
  bool rotation = false;        ///< particles also rotate
  bool stresslets = false;      ///< and bear stresslets; with rotation only
  bool noise = true;            ///< Lanczos iterations are part of the cost
  bool hydrodynamics = true;    ///< false: self-mobility alone
  double tolerance = 1e-3;      ///< relative 2-norm error of U = M F and of the noise
  double xi = 0.0;              ///< splitting parameter [1/length]; 0: the cheapest
  /// With a given xi, automatic means Hasimoto's.
  Splitting splitting = Splitting::automatic;
  /// Evaluations of the real-space part per one of wave space; 0: both together.
  int substeps = 0;
  double largest_cutoff = 0.0;    ///< r_cut may not be larger [length]; 0: no limit
  Precision precision = Precision::automatic;

  /// The least radius [length].
  double smallest_radius() const { return least_radius > 0.0 ? least_radius : radius; }
  /// Equal spheres that translate alone.
  bool is_plain() const { return smallest_radius() == radius && !rotation; }

  /// All members, to compare and to store them: an incomplete list does not compile.
  template <class Scene> static auto members(Scene &s)
  {
    auto &[volume, edge, particles, radius, least_radius, mean_cube, classes, rotation, stresslets,
           noise, hydrodynamics, tolerance, xi, splitting, substeps, cutoff, precision] = s;
    return std::tie(volume, edge, particles, radius, least_radius, mean_cube, classes, rotation,
                    stresslets, noise, hydrodynamics, tolerance, xi, splitting, substeps, cutoff,
                    precision);
  }
};

/// What else the choice between plans depends on: not on the number of ranks.
struct PseConditions {
  PairCounts counts;    ///< of the particles where they are now
  double skin = 0.0;    ///< of the neighbor list [length]
  /// For messages: where the limit of the cutoff comes from, and what else helps than another xi.
  std::string cutoff_reason = "the longest that is possible";
  double most_neighbors = 1e6;    ///< no particle may have more within r_cut
  double memory = 0.0;            ///< of all processors together [bytes]; 0: not known
};

/// Estimated errors relative to |U|: of the cutoff in real space, of the cutoff in wave space, of
/// the window, of single precision.
struct PseErrors {
  double real_space = 0.0, wave_space = 0.0, window = 0.0, rounding = 0.0;
  double total() const
  {
    return std::sqrt(real_space * real_space + wave_space * wave_space + window * window +
                     rounding * rounding);
  }
};

/// What kept the choice from a cheaper xi.
enum class PseLimit { none, cutoff, neighbors, memory, substeps };

/// Everything that the operators need to know.
struct PsePlan {
  double radius = 1.0, volume = 1.0;    ///< the greatest one [length], [length^3]
  double least_radius = 1.0;            ///< [length]
  bool rotation = false;
  bool stresslets = false;    ///< with rotation only
  /// False: each particle has its self-mobility alone.  Then there is neither grid nor pair, and
  /// nothing below matters.
  bool hydrodynamics = true;
  double tolerance = 1e-3;
  double root_tolerance = 1e-3;    ///< of Lanczos; that of the plan but for checks of the root
  Splitting splitting = Splitting::hasimoto;    ///< not automatic
  /// [1/length]; of a Kaiser-Bessel splitting: chi = 1 - k^2/(4 xi^2) + ..., as Hasimoto's Gaussian
  double xi = 0.5;
  double r_cut = 5.0;    ///< of the widest pairs [length]
  double k_cut = 3.0;    ///< [1/length]
  /// Largest distance of grid points along an edge that the window allows [length].
  double spacing = 1.0;
  std::array<long, 3> n{16, 16, 16};    ///< grid points along the edges
  Window window;
  double window_error = 1e-4;    ///< of the window's polynomials, relative to 1
  double table_error = 1e-4;     ///< of F and G - F in real space, in 1/(6 pi viscosity a)
  bool single = false;           ///< grid, transforms and pairs in single precision
  PseErrors errors;
  double neighbors = 0.0;         ///< of a particle in real space, on average
  double most_neighbors = 0.0;    ///< the largest number
  double modes = 0.0;             ///< wave vectors inside k_cut
  int iterations = 0;             ///< expected of Lanczos
  /// Expected per step on one core of the machine of the cost model.
  double real_seconds = 0.0, wave_seconds = 0.0;
  double seconds() const { return real_seconds + wave_seconds; }
  double grid_bytes = 0.0, pair_bytes = 0.0;    ///< expected, on all processors together
  PseLimit limit = PseLimit::none;

  /// The shape functions of wave space.
  ShapeBasis basis() const
  {
    return stresslets ? stress_basis(least_radius, radius) : shape_basis(least_radius, radius);
  }
  Moments moments() const { return stresslets ? Moments::stresslet : moments_of(rotation); }
  WaveWeight wave_weight() const;
  /// The near part of spheres of radius a.
  RealSpacePart real_space_part(double a) const;
  RealSpacePart real_space_part() const { return real_space_part(radius); }
  /// Equal spheres that translate alone.
  bool is_plain() const { return basis().single() && !rotation; }
};

/// 1/(6 pi viscosity a)
inline double free_mobility(double radius, double viscosity)
{
  return 1.0 / (6.0 * pi * viscosity * radius);
}

/// M_ii in units of free_mobility(): that of a cubic box of the same volume.
inline double periodic_self_mobility(double radius, double volume)
{
  const double s = radius / std::cbrt(volume);
  return std::fmax(0.1, 1.0 - 2.837297 * s + 4.0 / 3.0 * pi * s * s * s);
}

/// The cheapest plan whose estimated error is at most the tolerance, within the limits.
/// Throws InvalidOption when there is none, or xi or the tolerance are out of range.  The search
/// takes 0.1 s to 1 s; a plan that was made shortly before is found at once.
PsePlan plan_pse(const PseScene &scene, const PseConditions &conditions = {});

/// True if the plan keeps its tolerance in this scene, too, whose particles have the plan's radius:
/// one with more or fewer of them, or with another box.
bool pse_plan_holds(const PsePlan &plan, const PseScene &scene);

/// Gives the plan the radius of this scene, with which particles may have grown or shrunk since it
/// was made; grid, window and cutoffs stay.  False, and no change, if it then no longer keeps the
/// tolerance or the limits of the scene.
bool change_radius(PsePlan &plan, const PseScene &scene);
/// True if two plans differ in nothing but the radius, what is expected with it, and the number of
/// grid points, which depends on the cell.
bool same_but_for_radius(const PsePlan &a, const PsePlan &b);

/// Grid points along the edges of a cell: at most plan.spacing apart, at sizes that transform fast.
std::array<long, 3> pse_grid(const PsePlan &plan, const std::array<double, 3> &edge);

/// The share of wave space in the mobility of two touching spheres, along their line and relative
/// to each other; xi in 1/radius, or of a plain plan.  The far step of scheme split may be longer
/// than a near one by (1 - share)/share before it is the stiffer one.
double pse_far_share(double xi);
double pse_far_share(const PsePlan &plan);

/// How stiff a far step of scheme split is compared with a near one: the ratio of k mu dt for two
/// touching spheres along their line of centers.
double pse_far_stiffness(const PsePlan &plan, int substeps);

/// What a unit of time costs with scheme split, over what it costs with scheme euler whose steps
/// are as long as the near ones and whose splitting is the cheapest: evaluations of the mobility
/// alone, by the cost model.  Forces are not in it; they are computed substeps + 1 times for
/// substeps steps of euler. split: plan of `scene`, whose substeps are at least 1.
double pse_split_price(const PsePlan &split, PseScene scene, const PseConditions &conditions = {});

/// Largest |index| along the edges of a mode with |k| <= k_cut.
std::array<long, 3> pse_largest_index(double k_cut, const std::array<double, 3> &edge);

}    // namespace bdh
#endif
