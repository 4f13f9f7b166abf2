// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
#include "pse/near_table.h"

#include "base/chebyshev.h"
#include "base/constants.h"
#include "base/errors.h"
#include "pse/rpy_kernel.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace bdh {

/// Trapezoidal rule in t = k/(2 xi), as for equal spheres (pse/rpy.cpp).
std::array<double, all_functions> wave_functions(double r, double bp, double bq, double xi)
{
  const double reach = 6.6;    // (1 + t^2) exp(-t^2) = 5e-18
  const double band = 2.0 * xi * (r + bp + bq);
  const int steps = std::floor(reach * (band + 2.0 * reach) / two_pi) + 1.0;
  const double dk = 2.0 * xi * reach / steps;
  // Half of the term at k = 0, where j_1/x = 1/3.
  std::array<double, all_functions> sum{0.5 * 2.0 / 3.0, 0.0, 0.0, 0.0, 0.0};
  for (int m = 1; m <= steps; ++m) {
    const double k = m * dk, x = k * r, k2 = 0.25 * k * k;
    const double weight = hasimoto_split(k, xi) * sinc(k * bp) * sinc(k * bq);
    const double j0 = sinc(x), j1 = bessel1_ratio(x), transverse = j0 - j1,
                 difference = 3.0 * j1 - j0;
    sum[0] += weight * transverse;
    sum[1] += weight * difference;
    sum[2] -= 0.5 * weight * k * x * j1;
    sum[3] += weight * k2 * transverse;
    sum[4] += weight * k2 * difference;
  }
  for (double &s : sum) s *= 3.0 / pi * dk;
  return sum;
}

namespace {

/// The values of all functions of all pairs of shapes in the order of a row.
template <bool rotation>
std::array<double, table_row<rotation>()> row_at(double r, const ShapeBasis &basis, double xi)
{
  constexpr int n = rotation ? all_functions : translation_functions;
  std::array<double, table_row<rotation>()> row{};
  const double b[shape_pairs][2] = {
      {basis.b1, basis.b1}, {basis.b1, basis.b2}, {basis.b2, basis.b2}};
  for (int p = 0; p < shape_pairs; ++p) {
    const auto w = wave_functions(r, b[p][0], b[p][1], xi);
    std::copy_n(w.begin(), n, row.begin() + p * n);
  }
  return row;
}

/// The factor that scales function k of a row for the largest spheres.
template <bool rotation> double largest_scale(int k, const ShapeBasis &basis)
{
  constexpr int n = rotation ? all_functions : translation_functions;
  const double a = basis.b2, force = std::sqrt(a), torque = std::sqrt(4.0 / 3.0 * a * a * a);
  const double scale[] = {force * force, force * force, force * torque, torque * torque,
                          torque * torque};
  return scale[k % n];
}

/// All functions in one interval, and by how much they miss.
template <bool rotation> struct Piece {
  static constexpr int row = table_row<rotation>();
  std::vector<double> c[row];
  double error = 0.0;

  Piece(const ChebyshevFit &rule, double middle, double width, const ShapeBasis &basis, double xi)
  {
    std::vector<double> values[row];
    for (int j = 0; j < rule.count(); ++j) {
      const auto f = row_at<rotation>(middle + width * 0.5 * rule.point(j), basis, xi);
      for (int k = 0; k < row; ++k) values[k].push_back(f[k]);
    }
    for (int k = 0; k < row; ++k) {
      c[k] = rule.coefficients(values[k]);
      // The table's argument u goes from -1/2 to 1/2.
      for (int p = 0; p < rule.count(); ++p) c[k][p] = std::ldexp(c[k][p], p);
    }
    constexpr int used = shape_pairs * (rotation ? all_functions : translation_functions);
    for (int j = 0; j <= rule.count(); ++j) {
      const double u = 0.5 * rule.between_points(j);
      const auto f = row_at<rotation>(middle + width * u, basis, xi);
      for (int k = 0; k < used; ++k)
        error =
            std::max(error, largest_scale<rotation>(k, basis) * std::fabs(horner(c[k], u) - f[k]));
    }
  }
};

}    // namespace

template <class Real, bool rotation>
NearTable<Real, rotation>::NearTable(const ShapeBasis &basis, double xi, double r_cut, double error)
{
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
    std::vector<Piece<rotation>> pieces;
    for (int i = 0; i < count; ++i) {
      pieces.emplace_back(rule, (i + 0.5) * width, width, basis, xi);
      if (pieces.back().error > target) break;
    }
    if (pieces.back().error > target) continue;
    intervals_ = count;
    inv_width_ = 1.0 / width;
    constexpr int row = table_row<rotation>();
    coefficients_.resize(static_cast<std::size_t>(count) * (near_degree + 1) * row);
    Real *c = coefficients_.data();
    for (const auto &piece : pieces)
      for (int power = near_degree; power >= 0; --power)
        for (int k = 0; k < row; ++k) *c++ = piece.c[k][power];
    return;
  }
}

template class NearTable<float, false>;
template class NearTable<float, true>;
template class NearTable<double, false>;
template class NearTable<double, true>;

}    // namespace bdh
