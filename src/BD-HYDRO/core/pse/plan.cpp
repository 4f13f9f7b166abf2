// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
#include "pse/plan.h"

#include "base/constants.h"
#include "base/errors.h"
#include "grid/fft.h"
#include "pse/rpy.h"

#include <algorithm>
#include <cmath>

namespace bdh {

namespace {

// What each error may be, as a share of the tolerance.  The estimates are root mean squares over
// configurations and forces: together they stay well below 1 so that single cases do too.
constexpr double real_share = 0.45, wave_share = 0.32, window_share = 0.32;

// Round-off of transforms and sums in single precision, relative to |U|; measured.  For equal
// forces the sums over pairs cancel: what is left of each pair's rounding adds up, in units of 1/(6
// pi viscosity a).
constexpr double single_rounding = 3e-7, single_rounding_per_neighbor = 1.5e-9;
// Share of the tolerance that the latter may take.
constexpr double pair_rounding_share = 0.3;
constexpr double loosest_single = 1e-4;

// Along the shortest edge, each way.
constexpr double fewest_modes = 3.5;

/// Lengths in units of the radius, mobilities in 1/(6 pi viscosity a).
struct Suspension {
  double density;    // particles per a^3
  double particles;
  /// |U|/|F| of equal forces is smaller than that of random ones.  The lower limit of both is that
  /// of the simple cubic lattice, U/U_0 = 1 - 1.7601 phi^(1/3) + phi: of all particles, or of one
  /// and its images.
  static double lattice_velocity(double density)
  {
    const double phi = std::min(0.5, 4.0 / 3.0 * pi * density);    // beyond it spheres overlap
    return std::max(0.1, 1.0 - 1.7601 * std::cbrt(phi) + phi);
  }
  /// A sum of squares over neighbours, given at the mean density and for one neighbour: particles
  /// may also sit in a dense cluster (phi = 0.55) in an otherwise empty box, though no more of them
  /// than there are.
  double clustered(double at_mean_density, double one) const
  {
    return std::max(at_mean_density,
                    std::min(at_mean_density * 0.13 / density, (particles - 1.0) * one));
  }
  double equal_velocity() const { return lattice_velocity(density); }
  double random_velocity() const { return lattice_velocity(density / particles); }
};

/// Integral of f by Simpson's rule.
template <class Function> double integral(double from, double to, int intervals, Function f)
{
  const double h = (to - from) / intervals;
  double sum = f(from) + f(to);
  for (int i = 1; i < intervals; ++i) sum += (i % 2 ? 4.0 : 2.0) * f(from + i * h);
  return sum * h / 3.0;
}

/// What pairs beyond r contribute to U, relative to |U|: for random forces, and for equal ones,
/// whose contributions add. The pair functions fall over 1/xi from r = 0, and once more from the
/// kink at r = 2.
double real_space_error(const Suspension &s, double xi, double r)
{
  constexpr int intervals = 24;
  double squares = 0.0, sum = 0.0, one_random = 0.0, one_equal = 0.0;
  const auto add_range = [&](double from, double to) {
    const double h = (to - from) / intervals;
    for (int i = 0; i <= intervals; ++i) {
      const double x = from + i * h, shell = s.density * 4.0 * pi * x * x;
      const double simpson = h / 3.0 * (i == 0 || i == intervals ? 1.0 : i % 2 ? 4.0 : 2.0);
      const RpyPair m = real_space_exact(x, 1.0, xi);
      const double trace = std::fabs(2.0 * m.transverse + m.longitudinal) / 3.0;
      squares += simpson * shell *
                 (2.0 * m.transverse * m.transverse + m.longitudinal * m.longitudinal) / 3.0;
      sum += simpson * shell * trace;
      // A single pair, or a shell of neighbours in an ordered suspension.
      one_random =
          std::max(one_random, std::max(std::fabs(m.transverse), std::fabs(m.longitudinal)));
      one_equal = std::max(one_equal, std::max(1.0, 2.0 * pi * x * std::cbrt(s.density)) * trace);
    }
  };
  const double reach = 5.0 / xi, kink = 2.0;
  if (r < kink) {
    const double middle = std::min(r + reach, kink);
    add_range(r, middle);
    if (middle < kink) add_range(middle, kink);
  }
  add_range(std::max(r, kink), std::max(r, kink) + reach);
  const double random =
      std::max(std::sqrt(s.clustered(squares, one_random * one_random)), one_random);
  return std::max(random / s.random_velocity(), std::max(sum, one_equal) / s.equal_velocity());
}

/// sinc^2(k) H(k): k^2 times the weight of a mode.
double mode_weight(double k, double xi)
{
  const double s = sinc(k);
  return s * s * hasimoto_split(k, xi);
}

/// What modes beyond k contribute, relative to |U|: a particle's own part (27) and that of the
/// others, whose phases are random.
double wave_space_error(const Suspension &s, double xi, double k)
{
  const double far = k + 8.0 * xi;
  const double self = 2.0 / pi * integral(k, far, 64, [&](double q) { return mode_weight(q, xi); });
  const double others = 12.0 * s.density * integral(k, far, 64, [&](double q) {
                          const double w = mode_weight(q, xi);
                          return w * w / (q * q);
                        });
  return std::sqrt(self * self + s.clustered(others, self * self)) / s.equal_velocity();
}

/// Error by aliases of the window.  A particle's own part depends on its place within the grid as
/// cos(2 pi x/h) along each axis; the others' have random phases.
class WindowError {
 public:
  WindowError(const Suspension &s, double xi, double k_cut) : suspension_(s), k_cut_(k_cut)
  {
    // Weight of the modes with a given index along one axis: the others integrated over, d^2 k = 2
    // pi k dk.
    const double least = std::max(1e-3, 2.0 * pi * std::cbrt(s.density / s.particles));
    for (int i = 0; i < points; ++i) {
      q_[i] = k_cut * (i + 0.5) / points;
      const double from = std::max(q_[i], least);
      own_[i] = from < k_cut ? 2.0 * pi *
                                   integral(from, k_cut, 16,
                                            [&](double k) { return mode_weight(k, xi) / k; })
                             : 0.0;
      others_[i] = from < k_cut ? 2.0 * pi *
                                      integral(from, k_cut, 16,
                                               [&](double k) {
                                                 const double w = mode_weight(k, xi);
                                                 return w * w / (k * k * k);
                                               })
                                : 0.0;
    }
  }

  /// h: spacing of the grid.
  double operator()(const Window &window, double h) const
  {
    double own = 0.0, others = 0.0;
    const double dq = k_cut_ / points;
    for (int i = 0; i < points; ++i) {
      const double kappa = q_[i] * h, near = window.alias(kappa, -1), far = window.alias(kappa, 1);
      own += dq * own_[i] * (near + far);
      others += dq * others_[i] * 2.0 * (near * near + far * far);
    }
    const double scale = 6.0 * pi / (8.0 * pi * pi * pi) * 2.0 /
                         3.0;    // 6 pi a/V sum_k -> integral, trace of I - k k
    own *= 4.0 * scale;
    others *= 6.0 * pi * scale * suspension_.density * 2.0 * 3.0;
    others = suspension_.clustered(others, own * own);
    // Root mean square over places in the grid; a few particles may all be at the worst.
    const double worst = std::min(6.0, 1.0 + 20.0 / suspension_.particles);
    return std::sqrt(1.5 * worst * own * own + others) / suspension_.equal_velocity();
  }

 private:
  static constexpr int points = 14;
  Suspension suspension_;
  double k_cut_;
  double q_[points], own_[points], others_[points];
};

/// The window of a width that errs least at spacing h: beta by a coarse scan and two finer ones.
double best_window(const WindowError &error, double h, Window &window)
{
  double best = 1e300, at = 2.1 * window.width;
  for (double step : {0.3, 0.1, 0.03}) {
    const double middle = at;
    for (int i = -3; i <= 3; ++i) {
      window.beta = middle + i * step * window.width;
      const double e = error(window, h);
      if (e >= best) continue;
      best = e;
      at = window.beta;
    }
  }
  window.beta = at;
  return best;
}

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

/// Seconds per step on one core, fitted to bench_pse_step (bench/README.md): only their ratios
/// matter.
struct CostModel {
  bool single;
  double pair_build() const { return single ? 11e-9 : 14e-9; }
  double pair_apply() const { return single ? 4.5e-9 : 8.5e-9; }
  /// per particle and iteration
  double vector_work() const { return single ? 25e-9 : 40e-9; }
  /// One way, per particle.
  double spread(int width) const
  {
    const int lanes = width <= 4 ? 4 : width <= 8 ? 8 : 16;
    const double row = (single ? 0.35e-9 : 0.6e-9) * lanes / 4 + 0.5e-9;
    return 70e-9 + width * width * 3.0 * row;
  }
  /// There and back; kept: modes inside k_cut per point.
  double transform(double cells, double kept) const
  {
    return (single ? 1.35e-9 : 2.4e-9) * cells * std::log2(cells + 2.0) * (0.35 + 0.65 * kept);
  }
  double mode(bool noise) const { return noise ? 11e-9 : 4e-9; }
};

/// Lanczos iterations until the estimate is below the tolerance; a fit to bench_pse_paper
/// iterations, which it meets within one iteration up to phi = 0.4.
int expected_iterations(double xi, double density, double tolerance)
{
  const double phi = std::clamp(4.0 / 3.0 * pi * density, 1e-3, 0.6);
  const double per_decade = 0.84 * std::pow(phi / 0.1, 0.25) * std::pow(xi, -0.7);
  return std::max(2L, std::lround(-per_decade * std::log10(0.7 * tolerance)));
}

class Planner {
 public:
  explicit Planner(const PseScene &scene) :
      scene_(scene),
      a_(scene.radius), suspension_{1.0 * scene.particles * a_ * a_ * a_ / scene.volume,
                                    1.0 * scene.particles}
  {
    single_ = scene.precision == Precision::single_precision ||
              (scene.precision == Precision::automatic && scene.tolerance >= loosest_single);
  }

  /// xi: here in units of 1/a.  few_modes: plans with fewer modes than the estimates need are
  /// filled up to them. False if no grid reaches the tolerance.
  bool plan(double xi, bool few_modes, PsePlan &p) const
  {
    const double tol = scene_.tolerance * few_particles();
    p = PsePlan{};
    p.radius = a_;
    p.volume = scene_.volume;
    p.tolerance = p.root_tolerance = scene_.tolerance;
    p.xi = xi / a_;
    p.single = single_;
    const double r = smallest(0.0, 4.0 + 8.0 / xi, real_share * tol, 20, [&](double x) {
      return real_space_error(suspension_, xi, std::max(x, 1e-3));
    });
    const double least = least_k_cut();
    double k = smallest(1e-3, 16.0 * xi, wave_share * tol, 20,
                        [&](double x) { return wave_space_error(suspension_, xi, x); });
    if (k < least && !few_modes) return false;
    k = std::max(k, least);
    p.errors.real_space = real_space_error(suspension_, xi, r);
    p.errors.wave_space = wave_space_error(suspension_, xi, k);
    p.r_cut = r * a_;
    p.k_cut = k / a_;
    p.neighbors = suspension_.density * 4.0 / 3.0 * pi * r * r * r;
    const double pair_rounding = rounding_of_pairs(p.neighbors);
    if (single_ && pair_rounding > pair_rounding_share * tol) {
      if (scene_.precision == Precision::single_precision) return false;
      p.single = false;
    }
    p.errors.rounding = rounding(p.single, p.neighbors);
    p.modes = scene_.volume * p.k_cut * p.k_cut * p.k_cut / (6.0 * pi * pi);
    p.iterations = scene_.noise ? expected_iterations(xi, suspension_.density, tol) : 0;
    p.window_error = std::max(0.02 * tol, p.single ? 1e-7 : 1e-14);
    p.table_error = std::max(0.02 * tol, 2e-14);
    if (p.single) p.table_error = std::max(p.table_error, 1e-6);
    return choose_window(xi, k, p);
  }

  /// See pse_plan_holds().
  bool holds(const PsePlan &p) const
  {
    const double xi = p.xi * a_, r = p.r_cut / a_, k = p.k_cut * a_;
    if (k < (1.0 - 1e-9) * least_k_cut()) return false;
    PseErrors e;
    e.real_space = real_space_error(suspension_, xi, std::max(r, 1e-3));
    e.wave_space = wave_space_error(suspension_, xi, k);
    e.window = WindowError(suspension_, xi, k)(p.window, p.spacing / a_);
    e.rounding = rounding(p.single, suspension_.density * 4.0 / 3.0 * pi * r * r * r);
    return e.total() <= p.tolerance * few_particles();
  }

 private:
  /// The estimates are integrals over modes: a small box has too few for them, and costs little
  /// anyway.
  double least_k_cut() const
  {
    return 2.0 * pi * fewest_modes * a_ / *std::min_element(scene_.edge.begin(), scene_.edge.end());
  }
  double rounding_of_pairs(double neighbors) const
  {
    return single_rounding_per_neighbor * neighbors / suspension_.equal_velocity();
  }
  double rounding(bool single, double neighbors) const
  {
    return single ? single_rounding / suspension_.equal_velocity() + rounding_of_pairs(neighbors)
                  : 1e-15;
  }

  /// Single configurations of a few particles deviate from the root mean square that is estimated.
  double few_particles() const { return 1.0 / std::sqrt(1.0 + 12.0 / suspension_.particles); }

  bool choose_window(double xi, double k, PsePlan &p) const
  {
    const WindowError error(suspension_, xi, k);
    const CostModel cost{p.single};
    double best = 1e300;
    PsePlan candidate = p;
    // A window of W lines gains somewhat less than a digit per line.
    const int usual = std::lround(1.0 - 1.2 * std::log10(scene_.tolerance));
    for (int width = std::max(Window::least, usual - 3);
         width <= std::min(Window::greatest, usual + 6); ++width) {
      candidate.window.width = width;
      const double h =
          -smallest(-3.1 / k, -0.6 / k, window_share * scene_.tolerance * few_particles(), 10,
                    [&](double minus_h) { return best_window(error, -minus_h, candidate.window); });
      candidate.errors.window = best_window(error, h, candidate.window);
      if (candidate.errors.window > window_share * scene_.tolerance * few_particles() * 1.001)
        continue;
      candidate.spacing = h * a_;
      candidate.n = pse_grid(candidate, scene_.edge);
      const double seconds = price(cost, candidate);
      if (seconds < best) {
        best = seconds;
        p = candidate;
      }
      if (width * width * 1e-9 * scene_.particles > best) break;
    }
    return best < 1e299;
  }

  /// Sets the times of the plan.
  double price(const CostModel &cost, PsePlan &p) const
  {
    const double N = scene_.particles, pairs = 0.5 * p.neighbors;
    p.real_seconds = std::max(1, scene_.substeps) * N *
                     (pairs * (cost.pair_build() + (1 + p.iterations) * cost.pair_apply()) +
                      (1 + p.iterations) * cost.vector_work());
    const double cells = 1.0 * p.n[0] * p.n[1] * p.n[2];
    p.wave_seconds = 2.0 * N * cost.spread(p.window.width) +
                     cost.transform(cells, p.modes / cells) +
                     0.5 * p.modes * cost.mode(scene_.noise);
    return p.seconds();
  }

  PseScene scene_;
  double a_;
  Suspension suspension_;
  bool single_;
};

void require(bool good, const std::string &what, double value, const std::string &rule)
{
  if (!good) throw InvalidOption(what, value, rule);
}

}    // namespace

Precision precision_from_name(const std::string &name)
{
  if (name == "auto") return Precision::automatic;
  if (name == "single") return Precision::single_precision;
  if (name == "double") return Precision::double_precision;
  throw InvalidOption("precision", name, "must be auto, single or double");
}

double pse_far_share(double xi)
{
  const double whole = 1.0 - free_space_rpy(2.0).longitudinal;
  return 1.0 - (real_space_self(xi) - real_space_exact(2.0, 1.0, xi).longitudinal) / whole;
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
    // Transforms of sizes that are not multiples of 4 take up to three times as long per point.
    n[d] = next_fast_size(least, least > 16 ? 4 : 2);
  }
  return n;
}

PsePlan plan_pse(const PseScene &scene)
{
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
  const Planner planner(scene);
  PsePlan best, p;
  if (scene.xi > 0.0) {
    const double xi = scene.xi * scene.radius;
    require(xi >= 0.01 && xi <= 10.0, "xi", scene.xi, "must be between 0.01/radius and 10/radius");
    if (!planner.plan(xi, true, best))
      throw InvalidOption("xi", scene.xi,
                          scene.precision == Precision::single_precision
                              ? "precision single does not reach the tolerance with it: use "
                                "precision double, another xi, or xi auto"
                              : "no grid reaches the tolerance with it: use another, or xi auto");
    require(best.neighbors <= 1e6, "xi", scene.xi,
            "its cutoff of " + std::to_string(best.r_cut / scene.radius) +
                " radii makes more than a million neighbors per particle: use a larger one, or xi "
                "auto");
    require(scene.largest_cutoff == 0.0 || best.r_cut <= scene.largest_cutoff, "xi", scene.xi,
            "its cutoff is too long here: use a larger one");
    return best;
  }
  bool found = false;
  const auto consider = [&](double xi, bool few_modes) {
    if (scene.substeps > 0 && pse_far_share(xi) * (scene.substeps + 1) > 1.0) return;
    if (!planner.plan(xi, few_modes, p) ||
        (scene.largest_cutoff > 0.0 && p.r_cut > scene.largest_cutoff))
      return;
    if (!found || p.seconds() < best.seconds()) best = p;
    found = true;
  };
  for (bool few_modes : {false, true}) {
    for (double xi = 0.08; xi < 20.0; xi *= 1.25) consider(xi, few_modes);
    const double coarse = best.xi * scene.radius;
    for (int i = -4; i <= 4 && found; ++i) consider(coarse * std::pow(1.04, i), few_modes);
    if (found) break;
  }
  if (!found && scene.substeps > 0)
    throw InvalidOption("substeps", scene.substeps,
                        "no splitting keeps the far part soft enough in this box: use fewer");
  if (!found)
    throw InvalidOption("tolerance", scene.tolerance,
                        "no parameters reach it in this box: use a looser one");
  return best;
}

bool pse_plan_holds(const PsePlan &plan, const PseScene &scene)
{
  return scene.radius == plan.radius && Planner(scene).holds(plan);
}

double pse_split_price(const PsePlan &split, PseScene scene)
{
  const int substeps = scene.substeps;
  scene.substeps = 0;
  scene.xi = 0.0;
  return split.seconds() / (substeps * plan_pse(scene).seconds());
}

}    // namespace bdh
