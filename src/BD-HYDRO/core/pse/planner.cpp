// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
#include "pse/planner.h"

#include "base/constants.h"
#include "pse/plan_errors.h"

#include <algorithm>
#include <cmath>

namespace bdh {

namespace {

// What each error may be, as a share of the tolerance.  The estimates are root mean squares over
// configurations and forces: together they stay well below 1 so that single cases do too.
constexpr double real_share = 0.45, wave_share = 0.32, window_share = 0.32;
// The errors of gradients add up in small boxes, whose windows are as wide as they are.
constexpr double window_share_of_torques = 0.16;
// A Kaiser-Bessel splitting leaves no modes out.
constexpr double real_share_alone = 0.55;

// Round-off of transforms and sums in single precision, relative to |U|; measured.  For equal
// forces the sums over pairs cancel: what is left of each pair's rounding adds up, in units of 1/(6
// pi viscosity a).
constexpr double single_rounding = 3e-7, single_rounding_per_neighbor = 1.5e-9;
// Share of the tolerance that the rounding of pairs may take.
constexpr double pair_rounding_share = 0.3;
constexpr double loosest_single = 1e-4;

// Of rigid spheres, velocities are what is left of those by loads and by stresslets, with the
// errors of both.  In the reference cases the errors are then at most 0.55 of the tolerance.
constexpr double share_of_rigid_spheres = 0.35;

// Along the shortest edge, each way.
constexpr double fewest_modes = 3.5;

// Where a sphere's shape in wave space is not its own the near part is positive up to here: 1.0 to
// 1.4, depending on the radii.  Forces on spheres of the least or the greatest radius have their
// own.
constexpr double greatest_splitting_of_two_shapes = 1.1;
// With Kaiser-Bessel weights the near part of forces on equal spheres is positive where they are
// below sinc^2, which they nearly touch, and on others as near_part_of_shell() says; that of
// torques, whose shape they do not have, is positive up to here even where spheres overlap by far.
constexpr double greatest_kaiser_bessel_of_rotation = 0.6;

/// Smallest x in [low, high] with f(x) <= limit, f falling; high if there is none.
template <class Function>
double smallest(double low, double high, double limit, int iterations, Function f)
{
  for (int i = 0; i < iterations; ++i) {
    const double middle = 0.5 * (low + high);
    (f(middle) <= limit ? high : low) = middle;
  }
  return high;
}

}    // namespace

Planner::Planner(const PseScene &scene, const PseConditions &conditions) :
    scene_(scene), conditions_(conditions), around_(scene, conditions.counts), a_(scene.radius),
    estimates_(estimates_for(scene))
{
  single_ = scene.precision == Precision::single_precision ||
            (scene.precision == Precision::automatic && scene.tolerance >= loosest_single);
  // Single configurations of a few particles deviate from the root mean square that is
  // estimated.
  tolerance_ = (scene.stresslets ? share_of_rigid_spheres : 1.0) * scene.tolerance /
               std::sqrt(1.0 + 12.0 / scene.particles);
}

bool Planner::plan(Splitting splitting, double xi, bool few_modes, PsePlan &p) const
{
  p = PsePlan{};
  p.radius = a_;
  p.least_radius = scene_.smallest_radius();
  p.rotation = scene_.rotation;
  p.stresslets = scene_.stresslets;
  p.volume = scene_.volume;
  p.tolerance = p.root_tolerance = scene_.tolerance;
  p.splitting = splitting;
  p.xi = xi / a_;
  const bool possible = splitting == Splitting::kaiser_bessel ? cut_kaiser_bessel(xi, few_modes, p)
                                                              : cut_hasimoto(xi, few_modes, p);
  return possible && choose_precision(p) && choose_window(p);
}

bool Planner::holds(const PsePlan &p) const
{
  const bool positive = p.splitting == Splitting::kaiser_bessel
                            ? may_be_kaiser_bessel(p.r_cut * p.k_cut, p.k_cut * a_)
                            : p.xi * a_ <= (1.0 + 1e-9) * greatest_splitting();
  return positive && has_modes(p) && errors(p).total() <= tolerance_;
}

PseErrors Planner::errors(const PsePlan &p) const
{
  const double xi = p.xi * a_, k = p.k_cut * a_;
  PseErrors e;
  if (p.splitting == Splitting::kaiser_bessel) {
    e.real_space = estimates_->kaiser_bessel(p.r_cut * p.k_cut, k);
  } else {
    e.real_space = estimates_->real_space(xi, std::max(p.r_cut / a_, 1e-3));
    e.wave_space = estimates_->wave_space(xi, k);
  }
  e.window = window_error(p)(p.window, p.spacing / a_);
  e.rounding = rounding(p);
  return e;
}

double Planner::splitting_with_cutoff(double r, double from) const
{
  double low = from, high = std::max(from, greatest_splitting());
  for (int i = 0; i < 30; ++i) {
    const double middle = std::sqrt(low * high);
    (real_space_cutoff(middle) <= r ? high : low) = middle;
  }
  return high;
}

PseLimit Planner::exceeds(const PsePlan &p) const
{
  if (scene_.substeps > 0 && pse_far_share(p) * (scene_.substeps + 1) > 1.0)
    return PseLimit::substeps;
  if (scene_.largest_cutoff > 0.0 && p.r_cut > scene_.largest_cutoff) return PseLimit::cutoff;
  if (p.most_neighbors > conditions_.most_neighbors) return PseLimit::neighbors;
  if (conditions_.memory > 0.0 && p.grid_bytes + p.pair_bytes > conditions_.memory)
    return PseLimit::memory;
  return PseLimit::none;
}

double Planner::greatest_splitting() const
{
  const bool equal = scene_.smallest_radius() == scene_.radius, two = scene_.classes.are_two();
  return !scene_.rotation && (equal || two) ? greatest_splitting_of_one_shape
                                            : greatest_splitting_of_two_shapes;
}

double Planner::share_of_window() const
{
  return scene_.rotation ? window_share_of_torques : window_share;
}

bool Planner::cut_hasimoto(double xi, bool few_modes, PsePlan &p) const
{
  const double r = real_space_cutoff(xi), least = least_k_cut();
  double k = smallest(1e-3 * xi, 16.0 * xi, wave_share * tolerance_, 20,
                      [&](double x) { return estimates_->wave_space(xi, x); });
  if (k < least && !few_modes) return false;
  k = std::max(k, least);
  p.errors.real_space = estimates_->real_space(xi, r);
  p.errors.wave_space = estimates_->wave_space(xi, k);
  p.r_cut = r * a_;
  p.k_cut = k / a_;
  return true;
}

/// The products k_cut r_cut that are considered are multiples of a step: their tails are kept.
bool Planner::cut_kaiser_bessel(double xi, bool few_modes, PsePlan &p) const
{
  constexpr double step = 0.125, most = 72.0;
  const auto k_cut = [xi](double reach) {
    return 2.0 * xi *
           std::sqrt(KaiserBesselSplit::decline(kaiser_bessel_split(1.0, reach, 0.0).beta));
  };
  const auto good = [&](int n) {
    const double reach = n * step, k = k_cut(reach);
    return k >= (few_modes ? least_k_cut() : 0.0) &&
           estimates_->kaiser_bessel(reach, k) <= real_share_alone * tolerance_;
  };
  int low = 2.0 / step, high = most / step;
  while (high - low > 1) {
    const int middle = (low + high) / 2;
    (good(middle) ? high : low) = middle;
  }
  const double reach = high * step, k = k_cut(reach);
  if (k < least_k_cut() || !good(high) || !may_be_kaiser_bessel(reach, k)) return false;
  p.errors.real_space = estimates_->kaiser_bessel(reach, k);
  p.k_cut = k / a_;
  p.r_cut = reach / p.k_cut;
  return true;
}

/// The tail is that beyond contact; both parts must be positive.
bool Planner::may_be_kaiser_bessel(double reach, double k_cut) const
{
  const KaiserBesselSplit split =
      kaiser_bessel_split(k_cut, reach / k_cut, 1.0, estimates_->two_shapes());
  const double xi = 0.5 * k_cut / std::sqrt(KaiserBesselSplit::decline(split.beta));
  const double least = scene_.smallest_radius() / a_;
  return reach >= 2.0 * k_cut && split.weight(k_cut) >= 0.0 && kaiser_bessel_excess(split) <= 0.0 &&
         (least == 1.0 || near_part_of_shell(split, least) >= 0.0) &&
         (!scene_.rotation || xi <= (1.0 + 1e-9) * greatest_kaiser_bessel_of_rotation);
}

PlanEstimates::OfWindow Planner::window_error(const PsePlan &p) const
{
  const double k = p.k_cut * a_;
  return p.splitting == Splitting::kaiser_bessel
             ? estimates_->kaiser_bessel_window(p.r_cut * p.k_cut, k)
             : estimates_->window(p.xi * a_, k);
}

double Planner::least_k_cut() const
{
  return 2.0 * pi * fewest_modes * a_ / *std::min_element(scene_.edge.begin(), scene_.edge.end());
}

double Planner::rounding_of_pairs(double r_cut) const
{
  return single_rounding_per_neighbor * around_.mean(r_cut) / estimates_->least_motion();
}

double Planner::rounding(const PsePlan &p) const
{
  return p.single ? single_rounding / estimates_->least_motion() + rounding_of_pairs(p.r_cut)
                  : 1e-15;
}

double Planner::real_space_cutoff(double xi) const
{
  return smallest(0.0, 4.0 + 8.0 / xi, real_share * tolerance_, 20,
                  [&](double x) { return estimates_->real_space(xi, std::max(x, 1e-3)); });
}

bool Planner::choose_precision(PsePlan &p) const
{
  p.single = single_;
  if (single_ && rounding_of_pairs(p.r_cut) > pair_rounding_share * tolerance_) {
    if (scene_.precision == Precision::single_precision) return false;
    p.single = false;
  }
  p.errors.rounding = rounding(p);
  // Torques are spread with the slopes of the polynomials, which err more than their values.
  const double window = scene_.rotation ? 0.004 : 0.02;
  p.window_error = std::max(window * tolerance_, p.single ? 1e-7 : 1e-14);
  p.table_error = std::max(0.02 * tolerance_, p.single ? 1e-6 : 2e-14);
  return true;
}

bool Planner::choose_window(PsePlan &p) const
{
  const PlanEstimates::OfWindow error = window_error(p);
  const double k = p.k_cut * a_, enough = share_of_window() * tolerance_;
  double best = 1e300;
  price_pairs(scene_, around_, conditions_.skin, p);
  PsePlan candidate = p;
  // A window of W lines gains somewhat less than a digit per line.
  const int usual = std::lround(1.0 - 1.2 * std::log10(scene_.tolerance));
  for (int width = std::max(Window::least, usual - 3);
       width <= std::min(Window::greatest(p.single), usual + 6); ++width) {
    if (!Window::is_width(width, p.single)) continue;
    candidate.window.width = width;
    candidate.window.continuous = scene_.rotation;
    const double h = -smallest(-3.1 / k, -0.6 / k, enough, 10, [&](double minus_h) {
      return best_window(error, -minus_h, candidate.window, enough);
    });
    candidate.errors.window = best_window(error, h, candidate.window);
    if (candidate.errors.window > enough * 1.001) continue;
    candidate.spacing = h * a_;
    candidate.n = pse_grid(candidate, scene_.edge);
    price_grid(scene_, candidate);
    if (candidate.seconds() < best) {
      best = candidate.seconds();
      p = candidate;
    }
    if (width * width * 1e-9 * scene_.particles > best) break;
  }
  return best < 1e299;
}

}    // namespace bdh
