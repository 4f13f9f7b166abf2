// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
#include "pse/plan_sphere_errors.h"

#include "base/constants.h"
#include "base/gauss_legendre.h"
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

/// The radii whose loads the waves are estimated for.
std::vector<double> loaded_radii(const SphereSuspension &s)
{
  std::vector<double> radii{s.least};
  for (const RadiusClass &c : s.classes) radii.push_back(c.radius);
  return radii;
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

double SphereSuspension::clustered(double at_mean_density, double one, double greatest) const
{
  // In a dense cluster the others fill phi = 0.55.
  constexpr double dense = 0.55, volume = 4.0 / 3.0 * pi;
  const auto at_most = [one](double sum, double others) { return std::min(sum, others * one); };
  return std::max({at_mean_density,
                   at_most(at_mean_density * std::max(1.0, dense / phi), particles - 1.0),
                   at_most(dense / volume * greatest, particles * classes.back().share - 1.0)});
}

SpherePairs::SpherePairs(const SphereSuspension &suspension) :
    suspension_(suspension), basis_(suspension.basis())
{}

SpherePairs::Pair SpherePairs::at(double r, const Shapes &wave, double ai, double aj) const
{
  const auto sum = [&wave](int f, double ci, double cj) {
    return sum_of_shapes(ci, cj, wave[0][f], wave[1][f], wave[2][f]);
  };
  const auto c = [this](double e) { return basis_.coefficient(e); };
  const double ti = c(ai * ai), tj = c(aj * aj), ri = c(basis_.moment * ai * ai),
               rj = c(basis_.moment * aj * aj);
  PairBlock t = sphere_translation(r, ai, aj);
  t = {t.transverse - sum(0, ti, tj), t.difference - sum(1, ti, tj)};
  const double equal = aj * std::fabs(t.transverse + t.difference / 3.0);
  if (!suspension_.rotation) return {aj * aj * square(t), 0.0, 0.0, equal};
  PairBlock q = sphere_rotation(r, ai, aj);
  q = {q.transverse - sum(3, ri, rj), q.difference - sum(4, ri, rj)};
  const double turned = sphere_coupling(r, ai, aj) - sum(2, ri, tj), torque = aj * aj * aj / 0.75,
               unit = 0.75 * suspension_.coupled();
  return {aj * aj * square(t), torque * torque * square(q),
          turned * turned * (2.0 / 3.0) / (unit * unit), equal};
}

template <class OfClass> double SpherePairs::error(const OfClass &beyond) const
{
  Pair sum{}, one{}, greatest{};
  for (std::size_t i = 0; i < suspension_.classes.size(); ++i) {
    const Beyond b = beyond(i);
    const double density = suspension_.density * suspension_.classes[i].share;
    for (double Pair::*what :
         {&Pair::translation, &Pair::rotation, &Pair::coupling, &Pair::equal}) {
      sum.*what += density * (b.sum.*what);
      one.*what = std::max(one.*what, b.one.*what);
    }
    greatest = b.sum;
  }
  const auto whole = [&](double Pair::*what) {
    return std::sqrt(
        std::max(suspension_.clustered(sum.*what, one.*what, greatest.*what), one.*what));
  };
  return std::max({whole(&Pair::translation) / suspension_.random_velocity(),
                   whole(&Pair::rotation), whole(&Pair::coupling),
                   std::max(sum.equal, one.equal) / suspension_.equal_velocity()});
}

SphereErrors::SphereErrors(const SpherePairs &pairs, double xi) :
    pairs_(pairs), xi_(xi), step_(std::min(0.1 / xi, 0.1))
{
  const ShapeBasis &basis = pairs_.basis();
  // Beyond the contact of two spheres the near part falls off like exp(-xi^2 (r - 2)^2).
  const double reach = 2.0 + 6.5 / xi;
  while (step_ * 400 < reach) step_ *= 1.1;
  std::vector<Shapes> wave;
  for (double r = 0.0; r < reach; r += step_) {
    const double at = std::max(r, 1e-3);
    wave.push_back({wave_functions(at, basis.b1, basis.b1, xi_),
                    wave_functions(at, basis.b1, basis.b2, xi_),
                    wave_functions(at, basis.b2, basis.b2, xi_)});
  }
  for (const RadiusClass &i : suspension().classes)
    for (const RadiusClass &j : suspension().classes) add_classes(wave, i.radius, j.radius);
}

/// Sums from the farthest pairs to the nearest ones.
void SphereErrors::add_classes(const std::vector<Shapes> &wave, double ai, double aj)
{
  std::vector<Beyond> tail(wave.size() + 1);
  const double crowd = 2.0 * pi * std::cbrt(suspension().density);
  for (std::size_t k = wave.size(); k-- > 0;) {
    const double r = std::max(k * step_, 1e-3), shell = 4.0 * pi * r * r * step_;
    const Pair p = pairs_.at(r, wave[k], ai, aj);
    tail[k] = tail[k + 1];
    const auto add = [&](double Pair::*what, double single) {
      tail[k].sum.*what += shell * (p.*what);
      tail[k].one.*what = std::max(tail[k].one.*what, single * (p.*what));
    };
    add(&Pair::translation, 1.0);
    add(&Pair::rotation, 1.0);
    add(&Pair::coupling, 1.0);
    // A single pair, or a shell of neighbors in an ordered suspension.
    add(&Pair::equal, std::max(1.0, crowd * r));
  }
  tail_.push_back(std::move(tail));
}

const SpherePairs::Beyond &SphereErrors::beyond(double r, std::size_t i, std::size_t j) const
{
  const std::vector<Beyond> &tail = tail_[i * suspension().classes.size() + j];
  const double place = std::clamp(std::ceil(r / step_ - 1.0), 0.0, tail.size() - 1.0);
  return tail[static_cast<std::size_t>(place)];
}

/// Each pair is left out from where it ends in a plan with the cutoff r.
double SphereErrors::of_loads_on(std::size_t j, double r) const
{
  const NearReach reach(pairs_.basis(), xi_, r);
  const auto reach_of = [&](std::size_t k) {
    const double a = suspension().classes[k].radius;
    return reach(pairs_.basis().coefficient(a * a));
  };
  return pairs_.error([&](std::size_t i) { return beyond(reach_of(i) + reach_of(j), i, j); });
}

double SphereErrors::real_space(double r) const
{
  double largest = 0.0;
  for (std::size_t j = 0; j < suspension().classes.size(); ++j)
    largest = std::max(largest, of_loads_on(j, r));
  return largest;
}

double SphereErrors::wave_space(double k) const
{
  const double far = k + 8.0 * xi_;
  const double unit = 0.75 * suspension().coupled();
  const auto H = [this](double q) { return hasimoto_split(q, xi_); };
  const auto force = [this](double a, double q) { return shape(pairs_.basis(), a * a, q); };
  const auto torque = [this](double a, double q) {
    return shape(pairs_.basis(), pairs_.basis().moment * a * a, q);
  };
  // The motions of all spheres by a mode, as squares.
  const auto moved = [&](double q) {
    double sum = 0.0;
    for (const RadiusClass &c : suspension().classes)
      sum += c.share * std::pow(force(c.radius, q), 2);
    return suspension().density * sum;
  };
  double own_t = 0.0, own_r = 0.0, others_t = 0.0, others_r = 0.0, others_c = 0.0;
  for (double a : loaded_radii(suspension())) {
    own_t = std::max(own_t, 2.0 / pi * a * integral(k, far, 64, [&](double q) {
                              return std::pow(force(a, q), 2) * H(q);
                            }));
    // The waves of loads on spheres of this radius.
    others_t = std::max(others_t, 12.0 * a * a * integral(k, far, 64, [&](double q) {
                                    return std::pow(force(a, q) * H(q) / q, 2) * moved(q);
                                  }));
    if (!suspension().rotation) continue;
    const double free = a * a * a / 0.75;
    own_r = std::max(own_r, free / (2.0 * pi) * integral(k, far, 64, [&](double q) {
                              return std::pow(torque(a, q) * q, 2) * H(q);
                            }));
    others_r = std::max(others_r, 0.75 * free * free * integral(k, far, 64, [&](double q) {
                                    return std::pow(torque(a, q) * H(q) * q, 2) * moved(q);
                                  }));
    others_c = std::max(others_c, 3.0 / (unit * unit) * integral(k, far, 64, [&](double q) {
                                    return std::pow(force(a, q) * H(q), 2) * moved(q);
                                  }));
  }
  const auto whole = [this](double own, double others) {
    return std::sqrt(own * own + suspension().clustered(others, own * own, 0.0));
  };
  return std::max(
      {whole(own_t, others_t) / suspension().equal_velocity(), whole(own_r, others_r),
       std::sqrt(suspension().clustered(others_c, own_r * own_r / (unit * unit), 0.0))});
}

SphereTail::SphereTail(double reach) : reach_(reach)
{
  const KaiserBesselSplit split = kaiser_bessel_split(1.0, reach, 0.0);
  decline_ = split.decline(split.beta);
  const GaussLegendre rule(24 + static_cast<int>(0.6 * (reach + (points - 1) * step)));
  for (int p = 0; p < points; ++p) {
    const double x = reach + p * step;
    Values v;
    for (std::size_t i = 0; i < rule.points.size(); ++i) {
      const double t = rule.points[i], j0 = sinc(t * x), j1 = bessel1_ratio(t * x);
      double weight = rule.weights[i] * split.shape(t, split.beta);
      for (int m = 0; m < powers; ++m, weight *= t * t) {
        v.transverse[m] += weight * (j0 - j1);
        v.difference[m] += weight * (3.0 * j1 - j0);
        v.coupling[m] -= 0.5 * weight * t * t * x * j1;
      }
    }
    values_.push_back(v);
  }
}

/// As wave_functions(), from the powers of k that weights have beside chi.
SpherePairs::Shapes SphereTail::shapes_at(const Values &values, const ShapeBasis &basis,
                                          double k_cut) const
{
  const auto own = [&](double b) { return k_cut * k_cut * b * b / 6.0; };
  const double scale = 3.0 / pi * k_cut;
  const double b[shape_pairs][2] = {
      {basis.b1, basis.b1}, {basis.b1, basis.b2}, {basis.b2, basis.b2}};
  SpherePairs::Shapes shapes;
  for (int p = 0; p < shape_pairs; ++p) {
    const double ep = own(b[p][0]), eq = own(b[p][1]), product = basis.single() ? 0.0 : ep * eq;
    const auto sum = [&](const std::array<double, powers> &v, int m) {
      return v[m] + (decline_ - ep - eq) * v[m + 1] + product * v[m + 2];
    };
    shapes[p] = {scale * sum(values.transverse, 0), scale * sum(values.difference, 0),
                 scale * k_cut * sum(values.coupling, 0),
                 0.25 * scale * k_cut * k_cut * sum(values.transverse, 1),
                 0.25 * scale * k_cut * k_cut * sum(values.difference, 1)};
  }
  return shapes;
}

SpherePairs::Beyond SphereTail::beyond(const SpherePairs &pairs,
                                       const std::vector<SpherePairs::Shapes> &wave, double k_cut,
                                       double ai, double aj) const
{
  using Pair = SpherePairs::Pair;
  SpherePairs::Beyond all;
  Pair last_wave{};
  const double crowd = 2.0 * pi * std::cbrt(pairs.suspension().density);
  for (int p = 0; p < points; ++p) {
    const double r = (reach_ + p * step) / k_cut, dr = step / k_cut, shell = 4.0 * pi * r * r,
                 simpson = (p == 0 || p == points - 1 ? 1.0
                            : p % 2                   ? 4.0
                                                      : 2.0) /
                           3.0;
    const Pair pair = pairs.at(r, wave[p], ai, aj);
    for (double Pair::*what : {&Pair::translation, &Pair::rotation, &Pair::coupling}) {
      all.sum.*what += simpson * dr * shell * (pair.*what);
      all.one.*what = std::max(all.one.*what, pair.*what);
      if (p >= points - 2 * half_wave) last_wave.*what += shell * (pair.*what) / (2 * half_wave);
    }
    // A single pair, or a shell of neighbors in an ordered suspension.
    all.one.equal = std::max(all.one.equal, std::max(1.0, crowd * r) * pair.equal);
    if (p <= half_wave) all.sum.equal += dr * shell * pair.equal;
  }
  // From there on like 1/r^2.
  for (double Pair::*what : {&Pair::translation, &Pair::rotation, &Pair::coupling})
    all.sum.*what += last_wave.*what * (reach_ + (points - 1) * step) / k_cut;
  return all;
}

double SphereTail::operator()(const SpherePairs &pairs, double k_cut) const
{
  std::vector<SpherePairs::Shapes> wave;
  for (const Values &values : values_) wave.push_back(shapes_at(values, pairs.basis(), k_cut));
  double largest = 0.0;
  for (const RadiusClass &j : pairs.suspension().classes)
    largest = std::max(largest, pairs.error([&](std::size_t i) {
      const double ai = pairs.suspension().classes[i].radius;
      return beyond(pairs, wave, k_cut, ai, j.radius);
    }));
  return largest;
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

SphereWindowError::SphereWindowError(const SphereSuspension &s, const WaveWeight &weight,
                                     double k_cut) :
    suspension_(s),
    k_cut_(k_cut)
{
  const ShapeBasis basis = s.basis();
  const double longest = two_pi * std::cbrt(s.density / s.particles);
  for (int i = 0; i < points; ++i) q_[i] = k_cut * (i + 0.5) / points;
  const auto add = [&](double unit, int slopes, double e_one, double e_two) {
    const auto root = [&](double e, double k) {
      const double c = basis.coefficient(e);
      return c * weight.root(k, basis.b1) + (1.0 - c) * weight.root(k, basis.b2);
    };
    const auto w = [&](double k) {
      return std::fabs(root(e_one, k) * root(e_two, k) + std::pow(weight.common_root(k), 2));
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
  Images at;
  for (int i = 0; i < points; ++i) {
    const double kappa = q_[i] * h, shape = window.shape(kappa);
    for (int m = 0; m < images; ++m) {
      const double turns = (m / 2 + 1) * (m % 2 ? two_pi : -two_pi), image = kappa + turns;
      at[i][m] = {window.shape(image) / shape, std::fabs(image) / h};
    }
  }
  double largest = 0.0;
  for (const Kind &kind : kinds_) largest = std::max(largest, error(kind, at));
  return largest;
}

/// A window that is a gradient has the wavenumber of the image in place of that of the mode.
double SphereWindowError::error(const Kind &kind, const Images &at) const
{
  AliasSums sums;
  const double dq = k_cut_ / points;
  for (int i = 0; i < points; ++i)
    for (int m = 0; m < images; ++m) {
      const double ratio = at[i][m].ratio, k = at[i][m].wavenumber;
      const double square = ratio * ratio, slope = kind.own_slope[i] * k;
      switch (kind.slopes) {
      case 0:
        sums.once[m / 2] += dq * ratio * kind.own[i];
        sums.twice += dq * square * kind.own[i];
        sums.others += dq * 2.0 * square * kind.others[i];
        break;
      case 1:    // either of the two windows meets the image
        sums.once[m / 2] += dq * ratio * 0.5 * (kind.own[i] + slope);
        sums.twice += dq * square * slope;
        sums.others += dq * square * (kind.others[i] + kind.others_slopes[i] * k * k);
        break;
      default:
        sums.once[m / 2] += dq * ratio * slope;
        sums.twice += dq * square * kind.own_slopes[i] * k * k;
        sums.others += dq * 2.0 * square * kind.others_slopes[i] * k * k;
      }
    }
  const auto clustered = [this](double sum, double one) {
    return suspension_.clustered(sum, one, 0.0);
  };
  const double whole = sums.error(kind.unit, suspension_.density, suspension_.particles, clustered);
  return kind.slopes == 0 ? whole / suspension_.equal_velocity() : whole;
}

}    // namespace bdh
