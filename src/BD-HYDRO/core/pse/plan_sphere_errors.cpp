// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
#include "pse/plan_sphere_errors.h"

#include "base/constants.h"
#include "pse/near_table.h"
#include "pse/rpy_kernel.h"
#include "pse/sphere_pair_kernel.h"

#include <algorithm>
#include <cmath>

namespace bdh {

namespace {

/// The shape of a force or of a torque in wave space; k in units of the greatest radius.
double shape(const ShapeBasis &basis, double e, double k)
{
  const double c = basis.coefficient(e);
  return c * sinc(k * basis.b1) + (1.0 - c) * sinc(k * basis.b2);
}

/// Mean square of the entries of a block over directions.
double square(const PairBlock &m)
{
  const double along = m.transverse + m.difference;
  return (2.0 * m.transverse * m.transverse + along * along) / 3.0;
}

}    // namespace

double SphereSuspension::equal_velocity() const
{
  return Suspension{phi / (4.0 / 3.0 * pi), particles}.equal_velocity();
}

double SphereSuspension::random_velocity() const
{
  return Suspension{phi / (4.0 / 3.0 * pi), particles}.random_velocity();
}

/// n int (3/4 r^2)^2 2/3 4 pi r^2 dr from the distance of the nearest neighbor.  The factor makes
/// the errors of forces alone at most 0.3 of the tolerance (0.2 without it), in suspensions of
/// radii 1 to 1/4 at densities 5e-4 to 0.1.
double SphereSuspension::coupled() const
{
  const double nearest = std::max(0.55 / std::cbrt(density), 0.5), factor = 2.0;
  return std::min(1.0, factor * std::sqrt(1.5 * pi * density / nearest) / 0.75);
}

double SphereSuspension::clustered(double at_mean_density, double one) const
{
  // In a dense cluster the others fill phi = 0.55.
  return std::max(at_mean_density,
                  std::min(at_mean_density * std::max(1.0, 0.55 / phi), (particles - 1.0) * one));
}

SphereErrors::SphereErrors(const SphereSuspension &suspension, double xi) :
    suspension_(suspension), xi_(xi), step_(std::min(0.1 / xi, 0.1))
{
  // Beyond the contact of two spheres the near part falls off like exp(-xi^2 (r - 2)^2).
  const double reach = 2.0 + 6.5 / xi;
  while (step_ * 400 < reach) step_ *= 1.1;
  for (double r = 0.0; r < reach; r += step_) tail_.push_back(tail_at(std::max(r, 1e-3)));
}

/// The largest over pairs of the least and the greatest spheres, each relative to the motion of the
/// sphere that the load acts on.
SphereErrors::Tail SphereErrors::tail_at(double r) const
{
  const ShapeBasis basis = suspension_.basis();
  std::array<double, near_functions<Moments::torque>()> w[shape_pairs] = {
      wave_functions(r, basis.b1, basis.b1, xi_), wave_functions(r, basis.b1, basis.b2, xi_),
      wave_functions(r, basis.b2, basis.b2, xi_)};
  const auto sum = [&w](int f, double ci, double cj) {
    return sum_of_shapes(ci, cj, w[0][f], w[1][f], w[2][f]);
  };
  Tail tail{r, 0.0, 0.0, 0.0, 0.0};
  const double unit = 0.75 * suspension_.coupled();
  for (double ai : {suspension_.least, 1.0})
    for (double aj : {suspension_.least, 1.0}) {
      const double ti = basis.coefficient(ai * ai), tj = basis.coefficient(aj * aj),
                   ri = basis.coefficient(basis.moment * ai * ai),
                   rj = basis.coefficient(basis.moment * aj * aj);
      PairBlock t = sphere_translation(r, ai, aj), q = sphere_rotation(r, ai, aj);
      t = {t.transverse - sum(0, ti, tj), t.difference - sum(1, ti, tj)};
      q = {q.transverse - sum(3, ri, rj), q.difference - sum(4, ri, rj)};
      const double c = sphere_coupling(r, ai, aj) - sum(2, ri, tj), torque = aj * aj * aj / 0.75;
      tail.translation = std::max(tail.translation, aj * aj * square(t));
      tail.equal = std::max(tail.equal, aj * std::fabs(t.transverse + t.difference / 3.0));
      if (!suspension_.rotation) continue;
      tail.rotation = std::max(tail.rotation, torque * torque * square(q));
      tail.coupling = std::max(tail.coupling, c * c * (2.0 / 3.0) / (unit * unit));
    }
  return tail;
}

double SphereErrors::real_space(double r) const
{
  double translation = 0.0, rotation = 0.0, coupling = 0.0, sum = 0.0;
  double one_t = 0.0, one_r = 0.0, one_c = 0.0, one_equal = 0.0;
  for (const Tail &t : tail_) {
    if (t.r + step_ < r) continue;
    const double shell = suspension_.density * 4.0 * pi * t.r * t.r * step_;
    translation += shell * t.translation;
    rotation += shell * t.rotation;
    coupling += shell * t.coupling;
    sum += shell * t.equal;
    one_t = std::max(one_t, t.translation);
    one_r = std::max(one_r, t.rotation);
    one_c = std::max(one_c, t.coupling);
    one_equal = std::max(one_equal,
                         std::max(1.0, 2.0 * pi * t.r * std::cbrt(suspension_.density)) * t.equal);
  }
  const auto whole = [this](double many, double one) {
    return std::sqrt(std::max(suspension_.clustered(many, one), one));
  };
  return std::max({whole(translation, one_t) / suspension_.random_velocity(),
                   whole(rotation, one_r), whole(coupling, one_c),
                   std::max(sum, one_equal) / suspension_.equal_velocity()});
}

double SphereErrors::wave_space(double k) const
{
  const ShapeBasis basis = suspension_.basis();
  const double far = k + 8.0 * xi_, n = suspension_.density;
  const double mean = std::sqrt(suspension_.least);
  double own_t = 0.0, own_r = 0.0, others_t = 0.0, others_r = 0.0, others_c = 0.0;
  const double unit = 0.75 * suspension_.coupled();
  for (double a : {suspension_.least, mean, 1.0}) {
    const double e = a * a;
    const auto t = [&](double q) { return shape(basis, e, q); };
    const auto s = [&](double q) { return shape(basis, basis.moment * e, q); };
    const auto H = [this](double q) { return hasimoto_split(q, xi_); };
    own_t = std::max(own_t, 2.0 / pi * a *
                                integral(k, far, 64, [&](double q) { return t(q) * t(q) * H(q); }));
    // The loads act on spheres of this radius, whose waves move the least ones most.
    const auto t0 = [&](double q) {
      return std::max(std::fabs(t(q)), std::fabs(shape(basis, basis.b1 * basis.b1, q)));
    };
    others_t = std::max(others_t, 12.0 * n * a * a * integral(k, far, 64, [&](double q) {
                                    const double w = t(q) * t0(q) * H(q);
                                    return w * w / (q * q);
                                  }));
    if (!suspension_.rotation) continue;
    const double torque = a * a * a / 0.75;
    own_r = std::max(own_r, torque / (2.0 * pi) * integral(k, far, 64, [&](double q) {
                              return s(q) * s(q) * H(q) * q * q;
                            }));
    others_r = std::max(others_r, 0.75 * n * torque * torque * integral(k, far, 64, [&](double q) {
                                    const double w = s(q) * t0(q) * H(q) * q;
                                    return w * w;
                                  }));
    others_c = std::max(others_c, 3.0 * n / (unit * unit) * integral(k, far, 64, [&](double q) {
                                    const double w = t0(q) * t0(q) * H(q);
                                    return w * w;
                                  }));
  }
  const auto whole = [this](double own, double others) {
    return std::sqrt(own * own + suspension_.clustered(others, own * own));
  };
  return std::max({whole(own_t, others_t) / suspension_.equal_velocity(), whole(own_r, others_r),
                   std::sqrt(suspension_.clustered(others_c, own_r * own_r / (unit * unit)))});
}

namespace {

/// Integrals of weight k^power/k over the modes of index q along an axis, d^2k = 2 pi k dk.
template <class Weight>
double modes_of_index(double from, double k_cut, double power, const Weight &weight)
{
  if (!(from < k_cut)) return 0.0;
  return two_pi *
         integral(from, k_cut, 16, [&](double k) { return weight(k) * std::pow(k, power); });
}

}    // namespace

SphereWindowError::SphereWindowError(const SphereSuspension &s, double xi, double k_cut) :
    suspension_(s), k_cut_(k_cut)
{
  const ShapeBasis basis = s.basis();
  const double longest = two_pi * std::cbrt(s.density / s.particles);
  for (int i = 0; i < points; ++i) q_[i] = k_cut * (i + 0.5) / points;
  const auto add = [&](double unit, int slopes, double e_one, double e_two) {
    const auto w = [&](double k) {
      return std::fabs(shape(basis, e_one, k) * shape(basis, e_two, k)) * hasimoto_split(k, xi);
    };
    const auto w2 = [&](double k) { return w(k) * w(k); };
    Kind kind{unit, slopes, {}, {}, {}, {}, {}};
    const double factor = slopes == 2 ? 0.25 : slopes == 1 ? 0.5 : 1.0;
    for (int i = 0; i < points; ++i) {
      const double from = std::max(q_[i], longest);
      // Of the blocks w k^slopes/k^2: with the image's wavenumber in place of none, one or two k.
      kind.own[i] = factor * modes_of_index(from, k_cut, slopes - 1.0, w);
      kind.own_slope[i] = slopes > 0 ? factor * modes_of_index(from, k_cut, slopes - 2.0, w) : 0.0;
      kind.own_slopes[i] = slopes > 1 ? factor * modes_of_index(from, k_cut, slopes - 3.0, w) : 0.0;
      kind.others[i] = factor * factor * modes_of_index(from, k_cut, 2.0 * slopes - 3.0, w2);
      kind.others_slopes[i] =
          slopes > 0 ? factor * factor * modes_of_index(from, k_cut, 2.0 * slopes - 5.0, w2) : 0.0;
    }
    kinds_.push_back(kind);
  };
  for (double a : {s.least, 1.0}) {
    add(1.0 / a, 0, a * a, a * a);
    if (s.least == 1.0 && a == s.least && !s.rotation) break;
    if (!s.rotation) continue;
    add(0.75 / (a * a * a), 2, basis.moment * a * a, basis.moment * a * a);
  }
  if (s.rotation) add(0.75 * s.coupled(), 1, basis.moment * s.least * s.least, s.least * s.least);
}

double SphereWindowError::operator()(const Window &window, double h) const
{
  Images images;
  for (int i = 0; i < points; ++i) {
    const double kappa = q_[i] * h, at = window.shape(kappa);
    for (int m = 0; m < 2 * farthest; ++m) {
      const double turns = (m / 2 + 1) * (m % 2 ? two_pi : -two_pi), image = kappa + turns;
      images[i][m] = {window.shape(image) / at, std::fabs(image) / h};
    }
  }
  double largest = 0.0;
  for (const Kind &kind : kinds_) largest = std::max(largest, error(kind, images));
  return largest;
}

/// A window that is a gradient has the wavenumber of the image in place of that of the mode.
double SphereWindowError::error(const Kind &kind, const Images &images) const
{
  double once[farthest] = {}, twice = 0.0, others = 0.0;
  const double dq = k_cut_ / points;
  for (int i = 0; i < points; ++i)
    for (int m = 0; m < 2 * farthest; ++m) {
      const double ratio = images[i][m].ratio, k = images[i][m].wavenumber;
      const double square = ratio * ratio, slope = kind.own_slope[i] * k;
      switch (kind.slopes) {
      case 0:
        once[m / 2] += dq * ratio * kind.own[i];
        twice += dq * square * kind.own[i];
        others += dq * 2.0 * square * kind.others[i];
        break;
      case 1:    // either of the two windows meets the image
        once[m / 2] += dq * ratio * 0.5 * (kind.own[i] + slope);
        twice += dq * square * slope;
        others += dq * square * (kind.others[i] + kind.others_slopes[i] * k * k);
        break;
      default:
        once[m / 2] += dq * ratio * slope;
        twice += dq * square * kind.own_slopes[i] * k * k;
        others += dq * 2.0 * square * kind.others_slopes[i] * k * k;
      }
    }
  const double scale = 6.0 * pi / (8.0 * pi * pi * pi) * 2.0 / 3.0 / kind.unit;
  double squares = 0.0, sum = 0.0;
  for (double o : once) {
    squares += std::pow(4.0 * scale * o, 2);
    sum += std::fabs(4.0 * scale * o);
  }
  twice *= 2.0 * 3.0 * scale;
  others *= 6.0 * pi * scale / kind.unit * suspension_.density * 2.0 * 3.0;
  const double mean = 1.5 * squares + twice * twice, worst = std::pow(3.0 * sum + twice, 2);
  const double own = mean + (worst - mean) * std::min(1.0, 4.0 / suspension_.particles);
  const double whole = std::sqrt(own + suspension_.clustered(others, worst));
  return kind.slopes == 0 ? whole / suspension_.equal_velocity() : whole;
}

}    // namespace bdh
