// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Error estimates of positively split Ewald, relative to |U|.
///
/// Lengths are in units of the radius, xi and k in its inverse, mobilities in
/// 1/(6 pi viscosity a).
#ifndef BDH_PSE_PLAN_ERRORS_H
#define BDH_PSE_PLAN_ERRORS_H

#include "base/constants.h"
#include "pse/splitting_kernel.h"
#include "pse/window.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

namespace bdh {

/// Integral of f by Simpson's rule.
template <class Function> double integral(double from, double to, int intervals, Function f)
{
  const double h = (to - from) / intervals;
  double sum = f(from) + f(to);
  for (int i = 1; i < intervals; ++i) sum += (i % 2 ? 4.0 : 2.0) * f(from + i * h);
  return sum * h / 3.0;
}

/// What the estimates need to know of the particles: not where they are, since they move.
struct Suspension {
  double density;    ///< particles per a^3
  double particles;

  /// A sum of squares over neighbours, given at the mean density and for one neighbour: particles
  /// may also sit in a dense cluster (phi = 0.55) in an otherwise empty box, though no more of them
  /// than there are.
  double clustered(double at_mean_density, double one) const;
  /// |U|/|F| of equal forces is smaller than that of random ones.  The lower limit of both is that
  /// of the simple cubic lattice: of all particles, or of one and its images.
  double equal_velocity() const;
  double random_velocity() const;
};

/// What pairs beyond r contribute to U, relative to |U|: for random forces, and for equal ones,
/// whose contributions add.  At any xi > 0.
double real_space_error(const Suspension &s, double xi, double r);

/// What a Kaiser-Bessel splitting leaves beyond its cutoff in real space.
///
/// The tail falls off like cos(k_c r)/r^2 only, since W ends with a step at k_c: its squares are
/// summed to infinity, but equal forces feel no more than half a wave of it.
class KaiserBesselTail {
 public:
  /// reach: k_cut r_cut
  explicit KaiserBesselTail(double reach);
  /// Relative to |U|, as real_space_error(); k_cut in 1/radius.
  double operator()(const Suspension &s, double k_cut) const;
  double reach() const { return reach_; }

 private:
  static constexpr double step = 0.3;
  static constexpr int half_wave = 10, waves = 6, points = 2 * waves * half_wave + 1;
  double reach_, decline_;
  /// F and G/2 at k_cut r = reach + i step, in units of k_cut: with chi, and with t^2 chi.
  struct Values {
    double f, g, f_moment, g_moment;
  };
  std::vector<Values> values_;
};

/// The largest of (W(k) - sinc^2(ka))/k^4: the near part of forces is positive for any
/// configuration where this is not.
double kaiser_bessel_excess(const KaiserBesselSplit &split);

/// The least that the near part has of a force on the greatest sphere, of radius 1, which a smooth
/// shell of the least ones around it takes back, in units of the free mobility.  The exact mobility
/// of these loads almost vanishes; shells of touching spheres have 0.04 of their radius more.
/// two_terms is set.  least: radius of the small spheres
double near_part_of_shell(const KaiserBesselSplit &split, double least);

/// What modes beyond k contribute, relative to |U|: a particle's own part (27) and that of the
/// others, whose phases are random.
double wave_space_error(const Suspension &s, double xi, double k);

/// sinc^2(k) H(k): k^2 times the weight of a mode.
double mode_weight(double k, double xi);

/// Sums over the modes of the aliases of a window, at the images up to the farthest along an axis.
///
/// Aliases of spreading or of interpolation alone may cancel among the modes, those of each image
/// by itself: what is left of the nearest ones may then be less than what is left of the others.
struct AliasSums {
  static constexpr int farthest = 3;
  double once[farthest] = {};    ///< of spreading or of interpolation, by image
  double twice = 0.0;            ///< of both
  double others = 0.0;           ///< squares of those that other particles feel

  /// The error of a motion, in `unit`s.  clustered(sum, one): a sum of squares over neighbors of
  /// which one has so much, as Suspension::clustered().
  template <class Clustered>
  double error(double unit, double density, double particles, const Clustered &clustered) const
  {
    // 6 pi a/V sum_k -> integral, trace of I - k k
    const double scale = 6.0 * pi / (8.0 * pi * pi * pi) * 2.0 / 3.0 / unit;
    double squares = 0.0, sum = 0.0;
    for (double o : once) {
      squares += std::pow(4.0 * scale * o, 2);
      sum += std::fabs(4.0 * scale * o);
    }
    const double both = twice * (2.0 * 3.0 * scale),
                 of_others = others * (6.0 * pi * scale / unit * density * 2.0 * 3.0);
    // Root mean square over places in the grid; a few particles may all be at the worst, and so are
    // those of a cluster that is smaller than the spacing.
    const double mean = 1.5 * squares + both * both, worst = std::pow(3.0 * sum + both, 2);
    const double own = mean + (worst - mean) * std::min(1.0, 4.0 / particles);
    return std::sqrt(own + clustered(of_others, worst));
  }
};

/// Error by aliases of the window.  A particle's own part depends on its place within the grid as
/// cos(2 pi m x/h) along each axis; the others' have random phases.
class WindowError {
 public:
  /// weight: of the mode k, in 1/radius; sinc^2 H of Hasimoto's splitting.
  WindowError(const Suspension &s, double k_cut, const std::function<double(double)> &weight);
  /// h: spacing of the grid.
  double operator()(const Window &window, double h) const;

 private:
  static constexpr int points = 14;
  Suspension suspension_;
  double k_cut_;
  double q_[points], own_[points], others_[points];
};

/// Sets beta of the window so that it errs least at spacing h, and returns the error.  Ends with
/// the first beta that errs by no more than `enough`.
template <class Error>
double best_window(const Error &error, double h, Window &window, double enough = 0.0)
{
  double at = window.beta = 2.1 * window.width, best = error(window, h);
  for (double step : {0.3, 0.1, 0.03}) {
    const double middle = at;
    for (int i : {-3, -2, -1, 1, 2, 3}) {
      if (best <= enough) break;
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

}    // namespace bdh
#endif
