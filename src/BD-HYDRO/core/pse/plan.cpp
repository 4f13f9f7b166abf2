// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
#include "pse/plan.h"

#include "base/constants.h"
#include "base/errors.h"
#include "grid/fft.h"
#include "pse/plan_cost.h"
#include "pse/plan_errors.h"
#include "pse/plan_estimates.h"
#include "pse/rpy.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <sstream>
#include <tuple>
#include <utility>

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
// Of rigid spheres, velocities are what is left of those by loads and by stresslets, with the
// errors of both.  In the reference cases the errors are then at most 0.55 of the tolerance.
constexpr double share_of_rigid_spheres = 0.35;
// Share of the tolerance that the latter may take.
constexpr double pair_rounding_share = 0.3;
constexpr double loosest_single = 1e-4;

// Along the shortest edge, each way.
constexpr double fewest_modes = 3.5;

// In 1/radius.
constexpr double least_splitting = 1e-6, greatest_splitting_of_one_shape = 20.0;
// Where a sphere's shape in wave space is not its own the near part is positive up to here: 1.0 to
// 1.4, depending on the radii.  Forces on spheres of the least or the greatest radius have their
// own.
constexpr double greatest_splitting_of_two_shapes = 1.1;

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

double least_radius(const PseScene &scene)
{
  return scene.least_radius > 0.0 ? scene.least_radius : scene.radius;
}

bool is_plain(const PseScene &scene)
{
  return !scene.rotation && least_radius(scene) == scene.radius;
}

double greatest_splitting(const PseScene &scene)
{
  const bool equal = least_radius(scene) == scene.radius, two = scene.classes.are_two();
  return !scene.rotation && (equal || two) ? greatest_splitting_of_one_shape
                                           : greatest_splitting_of_two_shapes;
}

/// Plans for given splittings of a scene; xi is in units of 1/a here.
class Planner {
 public:
  Planner(const PseScene &scene, const PseConditions &conditions) :
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

  /// few_modes: plans with fewer modes than the estimates need are filled up to them.  False if no
  /// grid reaches the tolerance, or this splitting is not for the scene.
  bool plan(Splitting splitting, double xi, bool few_modes, PsePlan &p) const
  {
    p = PsePlan{};
    p.radius = a_;
    p.least_radius = least_radius(scene_);
    p.rotation = scene_.rotation;
    p.stresslets = scene_.stresslets;
    p.volume = scene_.volume;
    p.tolerance = p.root_tolerance = scene_.tolerance;
    p.splitting = splitting;
    p.xi = xi / a_;
    const bool possible = splitting == Splitting::kaiser_bessel
                              ? cut_kaiser_bessel(xi, few_modes, p)
                              : cut_hasimoto(xi, few_modes, p);
    return possible && choose_precision(p) && choose_window(p);
  }

  /// See pse_plan_holds().
  bool holds(const PsePlan &p) const
  {
    const bool positive = p.splitting == Splitting::kaiser_bessel
                              ? may_be_kaiser_bessel(p.r_cut * p.k_cut, p.k_cut * a_)
                              : p.xi * a_ <= (1.0 + 1e-9) * greatest_splitting();
    return positive && has_modes(p) && errors(p).total() <= tolerance_;
  }

  /// Estimates for a plan that was made for another scene.
  PseErrors errors(const PsePlan &p) const
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

  /// The largest xi up to `from` whose cutoff is r [a] or longer: from there on shorter ones.
  double splitting_with_cutoff(double r, double from) const
  {
    double low = from, high = std::max(from, greatest_splitting());
    for (int i = 0; i < 30; ++i) {
      const double middle = std::sqrt(low * high);
      (real_space_cutoff(middle) <= r ? high : low) = middle;
    }
    return high;
  }

  /// What of the scene's limits a plan exceeds.
  PseLimit exceeds(const PsePlan &p) const
  {
    if (scene_.substeps > 0 && pse_far_share(p) * (scene_.substeps + 1) > 1.0)
      return PseLimit::substeps;
    if (scene_.largest_cutoff > 0.0 && p.r_cut > scene_.largest_cutoff) return PseLimit::cutoff;
    if (p.most_neighbors > conditions_.most_neighbors) return PseLimit::neighbors;
    if (conditions_.memory > 0.0 && p.grid_bytes + p.pair_bytes > conditions_.memory)
      return PseLimit::memory;
    return PseLimit::none;
  }

  const PseConditions &conditions() const { return conditions_; }
  double greatest_splitting() const { return bdh::greatest_splitting(scene_); }

 private:
  double share_of_window() const
  {
    return scene_.rotation ? window_share_of_torques : window_share;
  }

  bool cut_hasimoto(double xi, bool few_modes, PsePlan &p) const
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
  bool cut_kaiser_bessel(double xi, bool few_modes, PsePlan &p) const
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
  bool may_be_kaiser_bessel(double reach, double k_cut) const
  {
    return is_plain(scene_) && reach >= 2.0 * k_cut &&
           kaiser_bessel_split(k_cut, reach / k_cut, 1.0).weight(k_cut) >= 0.0 &&
           kaiser_bessel_excess(reach, k_cut) <= 0.0;
  }

  PlanEstimates::OfWindow window_error(const PsePlan &p) const
  {
    const double k = p.k_cut * a_;
    return p.splitting == Splitting::kaiser_bessel
               ? estimates_->kaiser_bessel_window(p.r_cut * p.k_cut, k)
               : estimates_->window(p.xi * a_, k);
  }

  bool has_modes(const PsePlan &p) const { return p.k_cut * a_ >= (1.0 - 1e-9) * least_k_cut(); }

  /// The estimates are integrals over modes: a small box has too few for them, and costs little
  /// anyway.
  double least_k_cut() const
  {
    return 2.0 * pi * fewest_modes * a_ / *std::min_element(scene_.edge.begin(), scene_.edge.end());
  }

  double rounding_of_pairs(double r_cut) const
  {
    return single_rounding_per_neighbor * around_.mean(r_cut) / estimates_->least_motion();
  }

  double rounding(const PsePlan &p) const
  {
    return p.single ? single_rounding / estimates_->least_motion() + rounding_of_pairs(p.r_cut)
                    : 1e-15;
  }

  double real_space_cutoff(double xi) const
  {
    return smallest(0.0, 4.0 + 8.0 / xi, real_share * tolerance_, 20,
                    [&](double x) { return estimates_->real_space(xi, std::max(x, 1e-3)); });
  }

  /// False if the scene's precision is too low.
  bool choose_precision(PsePlan &p) const
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

  /// Window, grid and price.  False if no window reaches the tolerance.
  bool choose_window(PsePlan &p) const
  {
    const PlanEstimates::OfWindow error = window_error(p);
    const double k = p.k_cut * a_, enough = share_of_window() * tolerance_;
    double best = 1e300;
    price_pairs(scene_, around_, conditions_.skin, p);
    PsePlan candidate = p;
    // A window of W lines gains somewhat less than a digit per line.
    const int usual = std::lround(1.0 - 1.2 * std::log10(scene_.tolerance));
    for (int width = std::max(Window::least, usual - 3);
         width <= std::min(Window::greatest, usual + 6); ++width) {
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

  const PseScene &scene_;
  const PseConditions &conditions_;
  Surroundings around_;
  double a_, tolerance_;
  std::unique_ptr<PlanEstimates> estimates_;
  bool single_;
};

void require(bool good, const std::string &what, double value, const std::string &rule)
{
  if (!good) throw InvalidOption(what, value, rule);
}

/// A number for messages.
std::string text(double value)
{
  std::ostringstream out;
  out.precision(3);
  out << value;
  return out.str();
}

std::string box_text(const PseScene &scene)
{
  return "a box of " + text(scene.edge[0]) + " x " + text(scene.edge[1]) + " x " +
         text(scene.edge[2]);
}

/// What a plan takes of the memory.
std::string memory_text(const PseScene &scene, const PsePlan &p, double memory)
{
  const auto gigabytes = [](double bytes) { return text(std::max(0.01, bytes / 1e9)) + " GB"; };
  return "its grid of " + std::to_string(p.n[0]) + " x " + std::to_string(p.n[1]) + " x " +
         std::to_string(p.n[2]) + " points in " + box_text(scene) + " takes " +
         gigabytes(p.grid_bytes) + " and its pairs " + gigabytes(p.pair_bytes) +
         " of memory, but there are " + gigabytes(memory);
}

/// Refuses a user's xi.
void refuse(const PseScene &scene, const Planner &planner, const PsePlan &p, PseLimit limit)
{
  const std::string cutoff = "its cutoff of " + text(p.r_cut);
  if (limit == PseLimit::cutoff)
    throw InvalidOption("xi", scene.xi,
                        cutoff + " exceeds " + text(scene.largest_cutoff) + ", " +
                            planner.conditions().cutoff_reason +
                            "; or xi auto, or an xi of at least " +
                            text(1.005 *
                                 planner.splitting_with_cutoff(scene.largest_cutoff / scene.radius,
                                                               scene.xi * scene.radius) /
                                 scene.radius));
  if (limit == PseLimit::neighbors)
    throw InvalidOption("xi", scene.xi,
                        cutoff + " makes up to " + text(p.most_neighbors) +
                            " neighbors per particle in " + box_text(scene) + ", more than " +
                            text(planner.conditions().most_neighbors) +
                            ": use a larger one, or xi auto");
  if (limit == PseLimit::memory)
    throw InvalidOption("xi", scene.xi,
                        memory_text(scene, p, planner.conditions().memory) + ": use a " +
                            (p.grid_bytes > p.pair_bytes ? "smaller" : "larger") +
                            " one, or xi auto");
}

PsePlan plan_given(const PseScene &scene, const Planner &planner)
{
  const double xi = scene.xi * scene.radius;
  require(xi >= least_splitting && xi <= greatest_splitting_of_one_shape, "xi", scene.xi,
          "must be from 1e-6/radius to 20/radius");
  require(
      xi <= planner.greatest_splitting(), "xi", scene.xi,
      "is too large for rotation or more than two radii, whose near part would not be positive: it "
      "must be at most 1.1/(greatest radius)");
  PsePlan plan;
  const Splitting splitting =
      scene.splitting == Splitting::automatic ? Splitting::hasimoto : scene.splitting;
  if (!planner.plan(splitting, xi, true, plan))
    throw InvalidOption("xi", scene.xi,
                        scene.precision == Precision::single_precision
                            ? "precision single does not reach the tolerance with it: use "
                              "precision double, another xi, or xi auto"
                            : "no grid reaches the tolerance with it: use another, or xi auto");
  refuse(scene, planner, plan, planner.exceeds(plan));
  return plan;
}

/// The cheapest plan of a scene.
class Search {
 public:
  Search(const PseScene &scene, const Planner &planner) : scene_(scene), planner_(planner) {}

  PsePlan run()
  {
    // A splitting of 1/L leaves next to nothing to the modes of a box of side L.
    const double edge = *std::max_element(scene_.edge.begin(), scene_.edge.end()) / scene_.radius,
                 lowest = std::max(least_splitting, std::min(0.08, 0.5 / edge));
    for (bool few_modes : {false, true}) {
      for (Splitting splitting : {Splitting::hasimoto, Splitting::kaiser_bessel})
        if (scene_.splitting == Splitting::automatic || scene_.splitting == splitting)
          scan(splitting, lowest, few_modes);
      if (found()) break;
    }
    if (!found()) refuse_all();
    if (excluded_.xi > 0.0 && excluded_.seconds() < best_.seconds())
      best_.limit = planner_.exceeds(excluded_);
    return best_;
  }

 private:
  void scan(Splitting splitting, double lowest, bool few_modes)
  {
    if (splitting == Splitting::kaiser_bessel && !is_plain(scene_)) return;
    const PsePlan other = std::exchange(best_, none());
    // The grid grows with xi: what it takes alone ends the scan.
    bool useful = true;
    for (double xi = lowest; xi < planner_.greatest_splitting() && useful; xi *= 1.25)
      useful = consider(splitting, xi, few_modes);
    if (found()) refine(best_.xi, splitting, few_modes);
    // Limits count only if they exclude something that costs less than what they allow.
    if (found() && excluded_.xi > 0.0 && excluded_.splitting == splitting)
      refine(excluded_.xi, splitting, few_modes);
    if (other.xi > 0.0 && !(found() && best_.seconds() < other.seconds())) best_ = other;
  }

  void refine(double coarse, Splitting splitting, bool few_modes)
  {
    for (int i = -4; i <= 4; ++i)
      consider(splitting,
               std::min(coarse * scene_.radius * std::pow(1.04, i), planner_.greatest_splitting()),
               few_modes);
  }

  /// False if the grid takes longer than the best plan as a whole.
  bool consider(Splitting splitting, double xi, bool few_modes)
  {
    PsePlan p;
    if (!planner_.plan(splitting, xi, few_modes, p)) return true;
    const bool allowed = planner_.exceeds(p) == PseLimit::none;
    PsePlan &best = allowed ? best_ : excluded_;
    if (best.xi == 0.0 || p.seconds() < best.seconds()) best = p;
    return !found() || p.wave_seconds < 2.0 * best_.seconds();
  }

  [[noreturn]] void refuse_all() const
  {
    const PseLimit limit = excluded_.xi > 0.0 ? planner_.exceeds(excluded_) : PseLimit::none;
    if (limit == PseLimit::substeps)
      throw InvalidOption("substeps", scene_.substeps,
                          "no splitting keeps the far part soft enough in this box: use fewer");
    if (limit == PseLimit::memory)
      throw InvalidOption("xi", "auto",
                          "the cheapest is " + text(excluded_.xi) + ", and " +
                              memory_text(scene_, excluded_, planner_.conditions().memory) +
                              ": use a smaller box, a looser tolerance or more machines");
    if (limit == PseLimit::neighbors)
      throw InvalidOption("xi", "auto",
                          "with the cheapest, " + text(excluded_.xi) + ", a particle has " +
                              text(excluded_.most_neighbors) + " neighbors in " + box_text(scene_) +
                              ": use a smaller radius or a looser tolerance, or set xi");
    if (limit == PseLimit::cutoff)
      throw InvalidOption("xi", "auto",
                          "no cutoff reaches the tolerance within " + text(scene_.largest_cutoff) +
                              ", " + planner_.conditions().cutoff_reason);
    throw InvalidOption("tolerance", scene_.tolerance,
                        "no parameters reach it in " + box_text(scene_) + ": use a looser one");
  }

  const PseScene &scene_;
  const Planner &planner_;
  PsePlan best_ = none(), excluded_ = none();    // xi = 0: none yet

  bool found() const { return best_.xi > 0.0; }
  static PsePlan none()
  {
    PsePlan p;
    p.xi = 0.0;
    return p;
  }
};

}    // namespace

Precision precision_from_name(const std::string &name)
{
  if (name == "auto") return Precision::automatic;
  if (name == "single") return Precision::single_precision;
  if (name == "double") return Precision::double_precision;
  throw InvalidOption("precision", name, "must be auto, single or double");
}

double pse_far_share(const RealSpacePart &near)
{
  const double whole = 1.0 - free_space_rpy(2.0).longitudinal;
  return 1.0 - (near.self() - near(2.0 * near.radius()).longitudinal) / whole;
}

double pse_far_share(double xi) { return pse_far_share(RealSpacePart(1.0, xi)); }

double pse_far_share(const PsePlan &plan)
{
  return plan.is_plain() ? pse_far_share(plan.real_space_part())
                         : pse_far_share(plan.xi * plan.radius);
}

double pse_far_stiffness(const PsePlan &plan, int substeps)
{
  const double share = pse_far_share(plan);
  return substeps * share / (1.0 - share);
}

WaveWeight PsePlan::wave_weight() const
{
  return {splitting == Splitting::kaiser_bessel, xi, kaiser_bessel_split(k_cut, r_cut, radius)};
}

RealSpacePart PsePlan::real_space_part() const
{
  if (splitting == Splitting::kaiser_bessel)
    return {radius, kaiser_bessel_split(k_cut, r_cut, radius), r_cut};
  return {radius, xi};
}

std::array<long, 3> pse_largest_index(double k_cut, const std::array<double, 3> &edge)
{
  std::array<long, 3> n;
  for (int d = 0; d < 3; ++d) n[d] = std::floor(k_cut * edge[d] / (2.0 * pi) * (1.0 + 1e-12));
  return n;
}

std::array<long, 3> pse_grid(const PsePlan &plan, const std::array<double, 3> &edge)
{
  const std::array<long, 3> most = pse_largest_index(plan.k_cut, edge);
  std::array<long, 3> n;
  for (int d = 0; d < 3; ++d) {
    const long fine = std::ceil(edge[d] / plan.spacing * (1.0 - 1e-12));
    const long least = std::max<long>({fine, 2 * most[d] + 1, plan.window.width});
    // Sizes that are not multiples of 4 take 1.4 to 1.9 times as long per point.
    n[d] = least > 16 ? cheapest_fft_size(least) : next_fast_size(least, 2);
  }
  return n;
}

namespace {

PsePlan plan_without_hydrodynamics(const PseScene &scene)
{
  PsePlan plan;
  plan.hydrodynamics = false;
  plan.radius = scene.radius;
  plan.least_radius = least_radius(scene);
  plan.rotation = scene.rotation;
  plan.stresslets = scene.stresslets;
  plan.volume = scene.volume;
  plan.tolerance = scene.tolerance;
  plan.r_cut = plan.k_cut = 0.0;
  return plan;
}

}    // namespace

PsePlan plan_pse(const PseScene &scene, const PseConditions &conditions)
{
  if (!scene.hydrodynamics) return plan_without_hydrodynamics(scene);
  require(scene.tolerance >= 1e-12 && scene.tolerance <= 0.5, "tolerance", scene.tolerance,
          "must be from 1e-12 to 0.5");
  require(scene.precision != Precision::single_precision || scene.tolerance >= 1e-5, "tolerance",
          scene.tolerance, "precision single reaches only 1e-5: use precision auto or double");
  const auto edge = std::minmax_element(scene.edge.begin(), scene.edge.end());
  // The mobility exists for spheres that overlap their own images, too.
  require(scene.radius <= *edge.first, "radius", scene.radius,
          "a sphere must not be twice as wide as the box: use a smaller radius, or a box of more "
          "than " +
              std::to_string(scene.radius) + " along each edge");
  require(*edge.second <= 1e6 * scene.radius, "radius", scene.radius,
          "the box is more than a million radii long: use a larger radius or a smaller box");
  const Planner planner(scene, conditions);
  return scene.xi > 0.0 ? plan_given(scene, planner) : Search(scene, planner).run();
}

bool pse_plan_holds(const PsePlan &plan, const PseScene &scene)
{
  const PseConditions none;
  if (scene.hydrodynamics != plan.hydrodynamics) return false;
  if (scene.radius != plan.radius || least_radius(scene) != plan.least_radius ||
      scene.rotation != plan.rotation || scene.stresslets != plan.stresslets)
    return false;
  return !plan.hydrodynamics || Planner(scene, none).holds(plan);
}

bool change_radius(PsePlan &plan, const PseScene &scene)
{
  if (scene.hydrodynamics != plan.hydrodynamics) return false;
  if (scene.rotation != plan.rotation || scene.stresslets != plan.stresslets) return false;
  PsePlan changed = plan;
  changed.radius = scene.radius;
  changed.least_radius = least_radius(scene);
  // One shape function or two take different grids.
  if (changed.basis().single() != plan.basis().single()) return false;
  if (plan.hydrodynamics) {
    const PseConditions none;
    const Planner planner(scene, none);
    if (!planner.holds(changed) || planner.exceeds(changed) != PseLimit::none) return false;
    changed.errors = planner.errors(changed);
  }
  plan = changed;
  return true;
}

bool same_but_for_radius(const PsePlan &a, const PsePlan &b)
{
  const auto words = [](const PsePlan &p) {
    return std::make_tuple(p.hydrodynamics, p.rotation, p.stresslets, p.basis().single(),
                           p.tolerance, p.root_tolerance, p.splitting, p.xi, p.r_cut, p.k_cut,
                           p.spacing, p.window.width, p.window.beta, p.window.continuous,
                           p.window_error, p.table_error, p.single);
  };
  return words(a) == words(b);
}

double pse_split_price(const PsePlan &split, PseScene scene, const PseConditions &conditions)
{
  if (!split.hydrodynamics) return 1.0;
  const int substeps = scene.substeps;
  scene.substeps = 0;
  scene.xi = 0.0;
  return split.seconds() / (substeps * plan_pse(scene, conditions).seconds());
}

}    // namespace bdh
