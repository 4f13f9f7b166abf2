// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
#include "pse/near_table.h"

#include "base/chebyshev.h"
#include "base/constants.h"
#include "base/errors.h"
#include "base/gauss_legendre.h"
#include "pse/rpy_kernel.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace bdh {

namespace {

/// The wave numbers of a trapezoidal rule in t = k/(2 xi), as for equal spheres (pse/rpy.cpp).
struct WaveRule {
  double dk;
  int steps;
  WaveRule(double r, double bp, double bq, double xi)
  {
    const double reach = 6.6;    // (1 + t^2) exp(-t^2) = 5e-18
    const double band = 2.0 * xi * (r + bp + bq);
    steps = std::floor(reach * (band + 2.0 * reach) / two_pi) + 1.0;
    dk = 2.0 * xi * reach / steps;
  }
};

/// j_m(x)/x^m for m = 2, 3, 4.
struct BesselRatios {
  double j2, j3, j4;

  explicit BesselRatios(double x)
  {
    const double x2 = x * x;
    if (x < 4.0) {
      j2 = series(2, x2);
      j3 = series(3, x2);
      j4 = series(4, x2);
    } else {
      const double j1 = bessel1_ratio(x);
      j2 = (3.0 * j1 - sinc(x)) / x2;
      j3 = (5.0 * j2 - j1) / x2;
      j4 = (7.0 * j3 - j2) / x2;
    }
  }

 private:
  /// sum_k (-x^2/2)^k/(k! (2m + 2k + 1)!!)
  static double series(int m, double x2)
  {
    double term = 1.0, sum = 0.0;
    for (int k = 1; k <= m; ++k) term /= 2.0 * k + 1.0;
    for (int k = 0; std::fabs(term) > 1e-18; ++k) {
      sum += term;
      term *= -0.5 * x2 / ((k + 1.0) * (2.0 * (m + k) + 3.0));
    }
    return sum;
  }
};

}    // namespace

WaveIntegral::WaveIntegral(const WaveWeight &weight, double r_cut) : weight_(weight)
{
  if (!weight.kaiser_bessel) return;
  // As for equal spheres that translate (pse/rpy.cpp).
  const double k_cut = weight.split.k_cut;
  const GaussLegendre rule(24 + static_cast<int>(k_cut * r_cut));
  for (std::size_t i = 0; i < rule.points.size(); ++i) {
    k_.push_back(k_cut * rule.points[i]);
    dk_.push_back(k_cut * rule.weights[i]);
    common_.push_back(std::pow(weight.common_root(k_.back()), 2));
  }
}

template <class Action>
double WaveIntegral::for_modes(double r, double bp, double bq, const Action &action) const
{
  if (weight_.kaiser_bessel) {
    for (std::size_t i = 0; i < k_.size(); ++i)
      action(k_[i], dk_[i] * (weight_.root(k_[i], bp) * weight_.root(k_[i], bq) + common_[i]));
    return 1.0;
  }
  const WaveRule rule(r, bp, bq, xi());
  action(0.0, 0.5);
  for (int m = 1; m <= rule.steps; ++m) {
    const double k = m * rule.dk;
    action(k, hasimoto_split(k, xi()) * sinc(k * bp) * sinc(k * bq));
  }
  return rule.dk;
}

std::array<double, near_functions<Moments::torque>()> wave_functions(double r, double bp, double bq,
                                                                     const WaveIntegral &integral)
{
  std::array<double, near_functions<Moments::torque>()> sum{};
  const double dk = integral.for_modes(r, bp, bq, [&](double k, double weight) {
    const double x = k * r, k2 = 0.25 * k * k;
    const double j0 = sinc(x), j1 = bessel1_ratio(x), transverse = j0 - j1,
                 difference = 3.0 * j1 - j0;
    sum[0] += weight * transverse;
    sum[1] += weight * difference;
    sum[2] -= 0.5 * weight * k * x * j1;
    sum[3] += weight * k2 * transverse;
    sum[4] += weight * k2 * difference;
  });
  for (double &s : sum) s *= 3.0 / pi * dk;
  return sum;
}

std::array<double, near_functions<Moments::stresslet>()>
wave_derivatives(double r, double bp, double bq, const WaveIntegral &integral)
{
  const auto translation = wave_functions(r, bp, bq, integral);
  double b2 = 0.0, b3 = 0.0, b4 = 0.0;
  const double dk = integral.for_modes(r, bp, bq, [&](double k, double part) {
    const double x = k * r, x2 = x * x, weight = k * k * part;
    const BesselRatios j(x);
    b2 -= weight * j.j2;
    b3 += weight * x2 * j.j3;
    b4 -= weight * x2 * x2 * j.j4;
  });
  const double scale = 3.0 / pi * dk;
  return {translation[0], translation[1], scale * r * b2, scale * r * b3,
          scale * b2,     scale * b3,     scale * b4};
}

namespace {

template <Moments moments>
auto functions_at(double r, double bp, double bq, const WaveIntegral &integral)
{
  if constexpr (moments == Moments::stresslet)
    return wave_derivatives(r, bp, bq, integral);
  else
    return wave_functions(r, bp, bq, integral);
}

/// The values of all functions of all pairs of shapes in the order of a row.
template <Moments moments> std::array<double, table_row<moments>()>
row_at(double r, const ShapeBasis &basis, const WaveIntegral &integral)
{
  constexpr int n = near_functions<moments>();
  std::array<double, table_row<moments>()> row{};
  const double b[shape_pairs][2] = {
      {basis.b1, basis.b1}, {basis.b1, basis.b2}, {basis.b2, basis.b2}};
  for (int p = 0; p < shape_pairs; ++p) {
    const auto w = functions_at<moments>(r, b[p][0], b[p][1], integral);
    std::copy_n(w.begin(), n, row.begin() + p * n);
  }
  return row;
}

/// The factor that scales function k of a row for the largest spheres.
template <Moments moments> double largest_scale(int k, const ShapeBasis &basis)
{
  constexpr int n = near_functions<moments>();
  const double a = basis.b2, force = std::sqrt(a), torque = std::sqrt(4.0 / 3.0 * a * a * a);
  const int which = k % n, coupling = moments == Moments::stresslet ? 3 : 2;
  return which < 2 ? force * force : which <= coupling ? force * torque : torque * torque;
}

/// All functions in one interval, and by how much they miss.
template <Moments moments> struct Piece {
  static constexpr int row = table_row<moments>();
  std::vector<double> c[row];
  double error = 0.0;

  Piece(const ChebyshevFit &rule, double middle, double width, const ShapeBasis &basis,
        const WaveIntegral &integral)
  {
    std::vector<double> values[row];
    for (int j = 0; j < rule.count(); ++j) {
      const auto f = row_at<moments>(middle + width * 0.5 * rule.point(j), basis, integral);
      for (int k = 0; k < row; ++k) values[k].push_back(f[k]);
    }
    for (int k = 0; k < row; ++k) {
      c[k] = rule.coefficients(values[k]);
      // The table's argument u goes from -1/2 to 1/2.
      for (int p = 0; p < rule.count(); ++p) c[k][p] = std::ldexp(c[k][p], p);
    }
    constexpr int used = shape_pairs * near_functions<moments>();
    for (int j = 0; j <= rule.count(); ++j) {
      const double u = 0.5 * rule.between_points(j);
      const auto f = row_at<moments>(middle + width * u, basis, integral);
      for (int k = 0; k < used; ++k)
        error =
            std::max(error, largest_scale<moments>(k, basis) * std::fabs(horner(c[k], u) - f[k]));
    }
  }
};

}    // namespace

template <class Real, Moments moments>
NearTable<Real, moments>::NearTable(const ShapeBasis &basis, const WaveIntegral &integral,
                                    double r_cut, double error)
{
  const double xi = integral.xi();
  if (!(xi > 0.0)) throw InvalidOption("xi", xi, "must be > 0");
  if (!(r_cut > 0.0) || std::isinf(r_cut))
    throw InvalidOption("real-space cutoff", r_cut, "must be > 0 and finite");
  const double target =
      std::max(0.5 * error, 20.0 * static_cast<double>(std::numeric_limits<Real>::epsilon()));
  const ChebyshevFit rule(near_degree);
  constexpr int most = 20000;
  for (int count = std::max(1.0, r_cut * xi);; count += 1 + count / 4) {
    if (count > most)
      throw InvalidOption("real-space cutoff", r_cut, "too long for a table of the pair functions");
    const double width = r_cut / count;
    std::vector<Piece<moments>> pieces;
    for (int i = 0; i < count; ++i) {
      pieces.emplace_back(rule, (i + 0.5) * width, width, basis, integral);
      if (pieces.back().error > target) break;
    }
    if (pieces.back().error > target) continue;
    intervals_ = count;
    inv_width_ = 1.0 / width;
    constexpr int row = table_row<moments>();
    coefficients_.resize(static_cast<std::size_t>(count) * (near_degree + 1) * row);
    Real *c = coefficients_.data();
    for (const auto &piece : pieces)
      for (int power = near_degree; power >= 0; --power)
        for (int k = 0; k < row; ++k) *c++ = piece.c[k][power];
    return;
  }
}

template class NearTable<float, Moments::none>;
template class NearTable<float, Moments::torque>;
template class NearTable<float, Moments::stresslet>;
template class NearTable<double, Moments::none>;
template class NearTable<double, Moments::torque>;
template class NearTable<double, Moments::stresslet>;

}    // namespace bdh
