// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
#include "pse/plan_errors.h"

#include "base/constants.h"
#include "base/gauss_legendre.h"
#include "pse/rpy.h"

#include <algorithm>
#include <cmath>

namespace bdh {

namespace {

/// U/U_0 = 1 - 1.7601 phi^(1/3) + phi of the simple cubic lattice.
double lattice_velocity(double density)
{
  const double phi = std::min(0.5, 4.0 / 3.0 * pi * density);    // beyond it spheres overlap
  return std::max(0.1, 1.0 - 1.7601 * std::cbrt(phi) + phi);
}

}    // namespace

double mode_weight(double k, double xi)
{
  const double s = sinc(k);
  return s * s * hasimoto_split(k, xi);
}

double Suspension::clustered(double at_mean_density, double one) const
{
  return std::max(at_mean_density,
                  std::min(at_mean_density * 0.13 / density, (particles - 1.0) * one));
}

double Suspension::equal_velocity() const { return lattice_velocity(density); }

double Suspension::random_velocity() const { return lattice_velocity(density / particles); }

/// The pair functions fall over 1/xi from r = 0, and once more from the kink at r = 2.
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

KaiserBesselTail::KaiserBesselTail(double reach) : reach_(reach)
{
  const KaiserBesselSplit split = kaiser_bessel_split(1.0, reach, 0.0);
  decline_ = split.decline(split.beta);
  const double end = reach + (points - 1) * step;
  const GaussLegendre rule(24 + static_cast<int>(0.6 * end));
  std::vector<double> weights;
  for (std::size_t i = 0; i < rule.points.size(); ++i)
    weights.push_back(3.0 / pi * rule.weights[i] * split.shape(rule.points[i], split.beta));
  for (int p = 0; p < points; ++p) {
    // Beyond contact (1 - m k^2)/k^2 makes 3/(4r) + 3m/(2r^3), and 3/(2r) - 3m/r^3.
    const double r = reach + p * step, cube = 1.5 / (r * r * r);
    Values v{0.75 / r + decline_ * cube, 0.75 / r - decline_ * cube, -cube, cube};
    for (std::size_t i = 0; i < weights.size(); ++i) {
      const double t = rule.points[i], g = weights[i] * bessel1_ratio(t * r),
                   f = weights[i] * sinc(t * r) - g;
      v.f -= f;
      v.g -= g;
      v.f_moment -= t * t * f;
      v.g_moment -= t * t * g;
    }
    values_.push_back(v);
  }
}

double KaiserBesselTail::operator()(const Suspension &s, double k_cut) const
{
  const double moment = decline_ - k_cut * k_cut / 3.0, shells = 4.0 * pi * s.density;
  double squares = 0.0, last_wave = 0.0, sum = 0.0, one_random = 0.0, one_equal = 0.0;
  for (int p = 0; p < points; ++p) {
    const Values &v = values_[p];
    const double r = (reach_ + p * step) / k_cut, dr = step / k_cut,
                 simpson = (p == 0 || p == points - 1 ? 1.0
                            : p % 2                   ? 4.0
                                                      : 2.0) /
                           3.0;
    const double f = k_cut * (v.f + moment * v.f_moment),
                 g = 2.0 * k_cut * (v.g + moment * v.g_moment);
    const double trace = std::fabs(2.0 * f + g) / 3.0,
                 in_shell = shells * r * r * (2.0 * f * f + g * g) / 3.0;
    squares += simpson * dr * in_shell;
    if (p >= points - 2 * half_wave) last_wave += in_shell / (2 * half_wave);
    if (p <= half_wave) sum += dr * shells * r * r * trace;
    // A single pair, or a shell of neighbours in an ordered suspension.
    one_random = std::max(one_random, std::max(std::fabs(f), std::fabs(g)));
    one_equal = std::max(one_equal, std::max(1.0, 2.0 * pi * r * std::cbrt(s.density)) * trace);
  }
  // From there on like 1/r^2.
  squares += last_wave * (reach_ + (points - 1) * step) / k_cut;
  const double random =
      std::max(std::sqrt(s.clustered(squares, one_random * one_random)), one_random);
  return std::max(random / s.random_velocity(), std::max(sum, one_equal) / s.equal_velocity());
}

double kaiser_bessel_excess(const KaiserBesselSplit &split)
{
  // Both agree to order k^2.
  constexpr int steps = 100;
  double most = -HUGE_VAL;
  for (int i = 1; i <= steps; ++i) {
    const double k = split.k_cut * i / steps, s = sinc(k * split.radius);
    most = std::max(most, (split.weight(k) - s * s) / (k * k * k * k));
  }
  return most;
}

double near_part_of_shell(const KaiserBesselSplit &split, double least)
{
  constexpr double all_modes = 40.0;
  double left = HUGE_VAL;
  for (double R : {0.9, 0.95, 1.0, 1.05, 1.1, 1.15}) {
    const double exact = integral(0.0, all_modes, 400, [&](double k) {
      return std::pow(sinc(k) - sinc(k * least) * sinc(k * R), 2);
    });
    const double waves = integral(0.0, split.k_cut, 60, [&](double k) {
      return std::pow(split.root(k, 1.0) - split.root(k, least) * sinc(k * R), 2) +
             std::pow(split.common_root(k) * (1.0 - sinc(k * R)), 2);
    });
    left = std::min(left, 2.0 / pi * (exact - waves));
  }
  return left;
}

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

WindowError::WindowError(const Suspension &s, double k_cut,
                         const std::function<double(double)> &weight) :
    suspension_(s),
    k_cut_(k_cut)
{
  // Weight of the modes with a given index along one axis: the others integrated over, d^2 k = 2
  // pi k dk.
  const double least = 2.0 * pi * std::cbrt(s.density / s.particles);
  for (int i = 0; i < points; ++i) {
    q_[i] = k_cut * (i + 0.5) / points;
    const double from = std::max(q_[i], least);
    own_[i] = from < k_cut
                  ? 2.0 * pi * integral(from, k_cut, 16, [&](double k) { return weight(k) / k; })
                  : 0.0;
    others_[i] = from < k_cut ? 2.0 * pi *
                                    integral(from, k_cut, 16,
                                             [&](double k) {
                                               const double w = weight(k);
                                               return w * w / (k * k * k);
                                             })
                              : 0.0;
  }
}

double WindowError::operator()(const Window &window, double h) const
{
  AliasSums sums;
  const double dq = k_cut_ / points;
  for (int i = 0; i < points; ++i) {
    const double kappa = q_[i] * h, shape = window.shape(kappa);
    double squares = 0.0;
    for (int m = 1; m <= AliasSums::farthest; ++m) {
      const double below = window.shape(kappa - two_pi * m) / shape,
                   above = window.shape(kappa + two_pi * m) / shape;
      sums.once[m - 1] += dq * own_[i] * (below + above);
      squares += below * below + above * above;
    }
    sums.twice += dq * own_[i] * squares;
    sums.others += dq * others_[i] * 2.0 * squares;
  }
  const auto clustered = [this](double sum, double one) { return suspension_.clustered(sum, one); };
  return sums.error(1.0, suspension_.density, suspension_.particles, clustered) /
         suspension_.equal_velocity();
}

}    // namespace bdh
