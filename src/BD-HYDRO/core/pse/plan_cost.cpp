// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
#include "pse/plan_cost.h"

#include "base/constants.h"
#include "grid/fft.h"
#include "pse/near_kernel.h"
#include "pse/rpy.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace bdh {

namespace {

/// Time of transforms of an axis of n points over n log2 n, in relation to that of long axes; of
/// sizes from pse_grid().
double fft_slowness(long n)
{
  // FFTW has codelets for whole lines of these lengths.  Others take several passes, which cost
  // most where they are short.
  for (const long whole : {20, 32, 64, 128})
    if (n <= 16 || n == whole) return 0.7 + 9.0 / n;
  double slowness = 1.0 + 432.0 / (n * n);
  for (; n % 7 == 0; n /= 7) slowness *= 1.1;
  return slowness;
}

}    // namespace

long cheapest_fft_size(long n)
{
  const auto time = [](long size) { return size * (2.0 + fft_slowness(size)); };
  const long smallest = next_fast_size(n, 4);
  long best = smallest;
  // Nothing gains more than this share.
  for (long size = smallest; size < 1.2 * smallest; size = next_fast_size(size + 1, 4))
    if (time(size) < time(best)) best = size;
  return best;
}

int expected_constraint_iterations(double tolerance)
{
  return std::lround(1.0 - 2.0 * std::log10(tolerance));
}

namespace {

/// Seconds.
struct CostModel {
  bool single;
  /// Of what equal spheres cost that translate: two shape functions, or two with rotation.
  double pairs_built = 1.0, pairs_applied = 1.0, vectors = 1.0, spread_factor = 1.0, fields = 1.0;
  /// Of the wave-space part in a step, and products with the real-space part, in evaluations of the
  /// whole mobility.
  double evaluations = 1.0, products = 1.0;

  explicit CostModel(const PsePlan &plan) : single(plan.single)
  {
    if (plan.is_plain()) return;
    fields = plan.basis().single() ? 1.0 : 2.0;
    pairs_built = plan.rotation ? 4.5 : 3.0;
    pairs_applied = plan.rotation ? 2.4 : 1.0;
    vectors = plan.rotation ? 2.0 : 1.0;
    spread_factor = fields * (plan.rotation ? 1.7 : 1.0);
    if (!plan.stresslets) return;
    pairs_built = 9.0;
    pairs_applied = 5.0;
    vectors = 4.0;
    spread_factor = 4.0;
    // Slip, known loads and unknown ones.  Iterations need the strains by stresslets alone, of
    // equal spheres those of one shape.
    const int iterations = expected_constraint_iterations(plan.tolerance);
    evaluations = 3.0 + (plan.least_radius == plan.radius ? 0.5 : 0.9) * iterations;
    products = 3.0 + 0.2 * iterations;
  }
  /// Per evaluation, and per product with the real-space part, whatever the number of particles.
  static constexpr double start = 6e-6, start_product = 0.3e-6;
  /// Per entry of the neighbor list, and more per pair within the cutoff.
  static constexpr double list_entry = 2.5e-9;
  double pair_build() const { return pairs_built * (single ? 6e-9 : 7e-9); }
  double pair_apply() const { return pairs_applied * (single ? 2.5e-9 : 4.5e-9); }
  /// Per particle, and more per product.
  static constexpr double row = 45e-9;
  double vector_work() const { return vectors * (single ? 17e-9 : 20e-9); }
  /// One way, per particle.
  double spread(int width) const
  {
    const int lanes = width <= 4 ? 4 : width <= 8 ? 8 : 16;
    return spread_factor *
           (40e-9 + width * width * 3.0 * ((single ? 0.15e-9 : 0.85e-9) * lanes / 4 + 0.5e-9));
  }
  /// There and back; kept: modes inside k_cut per point.
  double transform(const std::array<long, 3> &n, double kept) const
  {
    double cells = 1.0, steps = 0.0;
    for (const long points : n) {
      cells *= points;
      steps += fft_slowness(points) * std::log2(points + 1.0);
    }
    return fields * (single ? 1.0e-9 : 1.75e-9) * cells * steps * (0.35 + 0.65 * kept);
  }
  /// To clear the grid, and to fetch it again for the particles, per point.
  double fetch() const { return fields * (single ? 2.5e-9 : 5e-9); }
  double mode(bool noise) const
  {
    const double work = single ? 11e-9 : 19e-9, draw = single ? 9e-9 : 8e-9;
    return fields * (work + (noise ? draw : 0.0));
  }
};

}    // namespace

/// That of the mean volume.
static double mean_radius(const PseScene &scene)
{
  const bool unequal = scene.smallest_radius() < scene.radius;
  return unequal && scene.mean_cube > 0.0 ? std::cbrt(scene.mean_cube) : scene.radius;
}

Surroundings::Surroundings(const PseScene &scene, const PairCounts &counts) :
    counts_(counts), radius_(mean_radius(scene)), density_(scene.particles / scene.volume)
{
  // Others within it, on average and as seen by particles with many of them: 1.
  nearest_ = 0.2;
  while (mean(nearest_ * radius_) * crowded(nearest_ * radius_) < 1.0) nearest_ *= 1.01;
  least_xi_ = 0.4 / distance_with(0.125 * scene.particles);
}

double Surroundings::distance_with(double others) const
{
  double r = nearest_;
  while (crowded(r * radius_) < others) r *= 1.01;
  return r;
}

double Surroundings::mean(double r) const
{
  return others_within(counts_, &PairCounts::mean, density_, r);
}

double Surroundings::crowded(double r) const
{
  return others_within(counts_, &PairCounts::crowded, density_, r);
}

double Surroundings::largest(double r) const
{
  return others_within(counts_, &PairCounts::largest, density_, r);
}

double Surroundings::condition(const PsePlan &plan) const
{
  const double xi = std::max(plan.xi * radius_, least_xi_);
  const RealSpacePart part = plan.xi * radius_ >= least_xi_ ? plan.real_space_part(radius_)
                                                            : RealSpacePart(radius_, xi / radius_);
  const double self = part.self();
  double sum = self, greatest = self, inner = 0.0;
  constexpr double step = 1.15, middle = 1.07;
  for (double r = 0.25; (r - 2.0) * xi < 1.2; r *= step) {
    const double within = crowded(r * radius_);
    const RpyPair m = part(r / middle * radius_);
    sum += (within - inner) * (2.0 * m.transverse + m.longitudinal) / 3.0;
    inner = within;
    greatest = std::max(greatest, sum);
  }
  const double pair = part(nearest_ * radius_).longitudinal;
  return greatest / std::max(self - 1.54 * pair, 0.043 * self);
}

int expected_iterations(double condition, double tolerance)
{
  // The theory of conjugate gradients has the power 1/2 of the condition number; that of a few
  // crowded regions counts for less.
  const double root = std::pow(std::max(condition, 1.0 + 1e-6), 0.3);
  const double per_decade = 2.09 / std::log10((root + 1.0) / (root - 1.0));
  return std::max(2L, std::lround(per_decade * (-std::log10(0.7 * tolerance) - 1.1)));
}

/// What particles have on average within reach of each other, by a number of others within a
/// distance; and what those of the greatest radius have.
template <class Within>
static std::pair<double, double> neighbors(const PseScene &scene, const PsePlan &p, Within within)
{
  if (p.is_plain()) return {within(p.r_cut), within(p.r_cut)};
  const ShapeBasis basis = p.basis();
  const NearReach reach(basis, p.wave_weight(), p.r_cut);
  const auto reach_of = [&](double a) { return reach(basis.coefficient(a * a)); };
  double mean = 0.0, of_greatest = 0.0;
  const std::vector<RadiusClass> classes = classes_of(scene.classes, scene.radius);
  for (const RadiusClass &i : classes) {
    of_greatest = 0.0;
    for (const RadiusClass &j : classes)
      of_greatest += j.share * within(reach_of(i.radius) + reach_of(j.radius));
    mean += i.share * of_greatest;
  }
  return {mean, of_greatest};
}

void price_pairs(const PseScene &scene, const Surroundings &around, double skin, PsePlan &p)
{
  const CostModel cost(p);
  const double N = scene.particles, listed = around.mean(p.r_cut + skin);
  p.neighbors = neighbors(scene, p, [&](double r) { return around.mean(r); }).first;
  p.most_neighbors = neighbors(scene, p, [&](double r) { return around.largest(r); }).second;
  p.iterations = scene.noise ? expected_iterations(around.condition(p), scene.tolerance) : 0;
  const double products = cost.products + p.iterations;
  p.real_seconds = std::max(1, scene.substeps) *
                   (N * 0.5 * listed * cost.list_entry +
                    N * 0.5 * p.neighbors * (cost.pair_build() + products * cost.pair_apply()) +
                    N * (cost.row + products * cost.vector_work()) + products * cost.start_product);
  // Of a pair are kept its direction, two functions and the neighbor; the list has the neighbor.
  const double kept = scene.noise ? cost.vectors * (p.single ? 24.0 : 44.0) * 1.25 : 0.0;
  p.pair_bytes = N * 0.5 * (p.neighbors * kept + listed * 4.0);
}

void price_grid(const PseScene &scene, PsePlan &p)
{
  const CostModel cost(p);
  const double N = scene.particles, cells = 1.0 * p.n[0] * p.n[1] * p.n[2];
  p.modes = scene.volume * p.k_cut * p.k_cut * p.k_cut / (6.0 * pi * pi);
  p.wave_seconds = cost.evaluations * (2.0 * N * cost.spread(p.window.width) +
                                       cost.transform(p.n, p.modes / cells) + cells * cost.fetch() +
                                       0.5 * p.modes * cost.mode(false) + cost.start) +
                   0.5 * p.modes * (cost.mode(scene.noise) - cost.mode(false));
  // Three components, and work space for planes and columns.
  p.grid_bytes =
      cost.fields * (p.single ? 1.0 : 2.0) * (14.0 * cells + 400.0 * std::pow(cells, 2.0 / 3.0));
}

}    // namespace bdh
