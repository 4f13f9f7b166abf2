// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
#include "pse/rpy.h"

#include "base/chebyshev.h"
#include "base/constants.h"
#include "base/errors.h"
#include "base/gauss_legendre.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace bdh {

namespace {

constexpr double root_pi = 1.77245385090551602730;

/// Free space without the wave-space part, PSE (12), (13) with H in place of 1 - H; lengths in a.
/// Trapezoidal rule in t = k/(2 xi): the integrand is even and entire, and its Fourier transform is
/// a Gaussian shifted by at most `band`, so a step that keeps `reach` beyond it leaves
/// exp(-reach^2) of aliasing.
RpyPair real_space_by_quadrature(double r, double xi)
{
  const double reach = 6.6;    // (1 + t^2) exp(-t^2) = 5e-18
  const double band = 2.0 * xi * (r + 2.0);
  const int steps = std::floor(reach * (band + 2.0 * reach) / (2.0 * pi)) + 1.0;
  const double h = reach / steps;
  double f = 1.0 / 3.0, g = 1.0 / 6.0;    // half of the term at t = 0: phi_F = 2/3, phi_G = 1/3
  for (int m = 1; m <= steps; ++m) {
    const double k = 2.0 * xi * m * h, shape = sinc(k),
                 weight = hasimoto_split(k, xi) * shape * shape;
    const double phi = bessel1_ratio(k * r);
    f += weight * (sinc(k * r) - phi);
    g += weight * phi;
  }
  const RpyPair whole = free_space_rpy(r);
  const double scale = 6.0 / pi * xi * h;
  return {whole.transverse - scale * f, whole.longitudinal - 2.0 * scale * g};
}

/// As series in (xi a)^2, of which three terms are kept, for spheres that are small beside 1/xi:
/// sinc^2(k) = 1 - k^2/3 + 2 k^4/45 - ..., whose k^2 are derivatives of the pair functions of
/// points.
RpyPair real_space_of_points(double r, double xi)
{
  const double x2 = r * xi * r * xi, erfc = std::erfc(r * xi) / r,
               gauss = 2.0 / root_pi * xi * std::exp(-x2), r2 = r * r, t2 = xi * xi;
  // Of half the trace of the point functions: first derivative over r, and second derivative; then
  // of its Laplacian.
  const RpyPair point = {0.75 * (erfc - gauss), 1.5 * erfc};
  const double slope = -1.5 * (erfc + gauss * (1.0 - x2)) / r2,
               curvature = 1.5 * (2.0 * erfc + gauss * (2.0 + x2 * (3.0 - 2.0 * x2))) / r2;
  const double slope2 = 1.5 * gauss * t2 * t2 * (-14.0 + 4.0 * x2),
               curvature2 = 1.5 * gauss * t2 * t2 * (-14.0 + x2 * (40.0 - 8.0 * x2));
  return {point.transverse + (slope + curvature) / 3.0 + 2.0 / 45.0 * (slope2 + curvature2),
          point.longitudinal + 2.0 / 3.0 * slope + 4.0 / 45.0 * slope2};
}

// Below it the closed form loses its digits.
constexpr double smallest_closed_form = 0.005;

}    // namespace

RpyPair real_space_exact(double r, double a, double xi)
{
  const double reduced_r = r / a, reduced_xi = xi * a;
  if (reduced_r == 0.0) {
    const double self = real_space_self(reduced_xi);
    return {self, self};
  }
  // From here outwards the closed form errs by at most 6e-16, nearer by up to 1e-9 (and without
  // bound at r = 0). The quadrature errs by up to 1.1e-15 everywhere, but leaves nothing but that
  // error in the tail.
  if (reduced_xi * (reduced_r - 2.0) > 2.0)
    return reduced_xi < smallest_closed_form ? real_space_of_points(reduced_r, reduced_xi)
                                             : real_space_closed_form(reduced_r, reduced_xi);
  return real_space_by_quadrature(reduced_r, reduced_xi);
}

RealSpacePart::RealSpacePart(double a, const KaiserBesselSplit &split, double r_cut) : a_(a)
{
  // The integrand turns k_cut r/pi times, and its growth off the real axis is that of exp(beta).
  const GaussLegendre rule(24 + static_cast<int>(split.k_cut * r_cut));
  for (std::size_t i = 0; i < rule.points.size(); ++i) {
    const double k = split.k_cut * rule.points[i];
    k_.push_back(k * a);
    weight_.push_back(3.0 / pi * split.weight(k) * split.k_cut * a * rule.weights[i]);
  }
}

RpyPair RealSpacePart::operator()(double r) const
{
  if (k_.empty()) return real_space_exact(r, a_, xi_);
  const double reduced_r = r / a_;
  RpyPair wave{};
  for (std::size_t i = 0; i < k_.size(); ++i) {
    const double x = k_[i] * reduced_r, phi = bessel1_ratio(x);
    wave.transverse += weight_[i] * (sinc(x) - phi);
    wave.longitudinal += weight_[i] * 2.0 * phi;
  }
  const RpyPair whole = free_space_rpy(reduced_r);
  return {whole.transverse - wave.transverse, whole.longitudinal - wave.longitudinal};
}

namespace {

/// Values of F and of G - F at one point.
std::array<double, 2> table_functions(const RealSpacePart &part, double r)
{
  const RpyPair m = part(r);
  return {m.transverse, m.longitudinal - m.transverse};
}

/// Both functions on one interval, and by how much they miss.
struct Piece {
  std::array<std::vector<double>, 2> c;
  double error = 0.0;
};

Piece fit(const ChebyshevFit &rule, double middle, double width, const RealSpacePart &part)
{
  std::array<std::vector<double>, 2> values;
  for (int j = 0; j < rule.count(); ++j) {
    const auto f = table_functions(part, middle + width * (0.5 * rule.point(j)));
    for (int q = 0; q < 2; ++q) values[q].push_back(f[q]);
  }
  Piece piece;
  for (int q = 0; q < 2; ++q) {
    piece.c[q] = rule.coefficients(values[q]);
    // The table's argument u goes from -1/2 to 1/2.
    for (int p = 0; p < rule.count(); ++p) piece.c[q][p] = std::ldexp(piece.c[q][p], p);
  }
  for (int j = 0; j <= rule.count(); ++j) {
    const double u = 0.5 * rule.between_points(j);
    const auto f = table_functions(part, middle + width * u);
    for (int q = 0; q < 2; ++q)
      piece.error = std::max(piece.error, std::fabs(horner(piece.c[q], u) - f[q]));
  }
  return piece;
}

/// What a table is of, and how well.
struct PairFunctions {
  const RealSpacePart &part;
  double error, epsilon;
  int degree;
};

/// Part of a table with intervals of one width.
struct Region {
  double begin, end, unit;
};

/// pieces := those of a region; the width of its intervals is unit/per_unit, for the smallest
/// per_unit that keeps the error.  False if they would be more than `most`.
bool fit_region(const Region &region, const PairFunctions &functions, double most,
                std::vector<Piece> &pieces, int &per_unit)
{
  const ChebyshevFit rule(functions.degree);
  const double target = 0.5 * functions.error;
  per_unit = 1;
  for (bool good = false; !good;) {
    const double width = region.unit / per_unit;
    // Rounding in `evaluate` may step over a boundary, also over the last.
    const double count =
        std::floor((region.end - region.begin) / width * (1.0 + 4.0 * functions.epsilon)) + 1.0;
    if (count > most) return false;
    pieces.clear();
    good = true;
    for (int i = 0; i < count && good; ++i) {
      pieces.push_back(fit(rule, region.begin + (i + 0.5) * width, width, functions.part));
      good = pieces.back().error <= target;
    }
    if (!good) {
      const double ratio = std::pow(pieces.back().error / target, 1.0 / rule.count());
      per_unit = std::max<int>(per_unit + 1, per_unit * std::min(ratio, 1.5));
    }
  }
  return true;
}

}    // namespace

/// Hasimoto's part.
static RealSpacePart checked_part(double a, double xi)
{
  if (!(a > 0.0)) throw InvalidOption("radius", a, "must be > 0");
  if (!(xi > 0.0)) throw InvalidOption("xi", xi, "must be > 0");
  return {a, xi};
}

template <class Real>
RealSpaceTable<Real>::RealSpaceTable(double a, double xi, double r_cut, double error) :
    RealSpaceTable(checked_part(a, xi), r_cut, error)
{}

template <class Real>
RealSpaceTable<Real>::RealSpaceTable(const RealSpacePart &part, double r_cut, double error)
{
  if (!(r_cut > 0.0) || std::isinf(r_cut))
    throw InvalidOption("real-space cutoff", r_cut, "must be > 0 and finite");
  if (!(error >= smallest_error())) {
    const char *const rule = sizeof(Real) < sizeof(double) ? "must be >= 5e-7" : "must be >= 1e-14";
    throw InvalidOption("error of the real-space table", error, rule);
  }
  cutoff_ = r_cut;
  // Cubics are cheaper to evaluate, unless their table is too large to stay in a first-level cache
  // among other data. The second limit is far above any need (0.4 MiB at xi a = 0.02 and 1e-14, and
  // 5 MiB at 1e-5): it ends a search that cannot succeed.
  const std::size_t small_table = 12 * 1024, any_table = 8 * 1024 * 1024;
  if (!build(part, error, low_degree, small_table) && !build(part, error, high_degree, any_table))
    throw InvalidOption("real-space cutoff", r_cut, "too long for a table of the pair functions");
}

/// False, with the table as it was, if it would take more than `limit` bytes.
template <class Real> bool RealSpaceTable<Real>::build(const RealSpacePart &part, double error,
                                                       int degree, std::size_t limit)
{
  const double a = part.radius();
  // Far away is beyond 64 radii, for cutoffs of which that is a small part.
  const double near_end = cutoff_ > 512.0 * a ? 64.0 * a : HUGE_VAL;
  const std::size_t per_piece = 2 * (degree + 1), per_line = sizeof(Line) / sizeof(Real);
  const double most = static_cast<double>(limit) / (per_piece * sizeof(Real));
  const PairFunctions functions{part, error, std::numeric_limits<Real>::epsilon(), degree};
  std::vector<Piece> pieces, far_pieces;
  int inside, far_per_unit = 0;    // intervals in [0, 2a], and in the unit far away
  if (!fit_region({0.0, std::min(cutoff_, near_end), 2.0 * a}, functions, most, pieces, inside))
    return false;
  near_intervals_ = pieces.size();
  if (near_end < cutoff_) {
    const double unit = 0.5 * near_end;
    if (!fit_region({near_end, cutoff_, unit}, functions, most - near_intervals_, far_pieces,
                    far_per_unit))
      return false;
    pieces.insert(pieces.end(), far_pieces.begin(), far_pieces.end());
    inv_far_width_ = far_per_unit / unit;
  }
  near_end_ = near_end;
  degree_ = degree;
  intervals_ = pieces.size();
  inv_width_ = inside / (2.0 * a);
  lines_.assign((pieces.size() * per_piece + per_line - 1) / per_line, Line{});
  Real *c = lines_.front().c;
  for (const Piece &piece : pieces)
    for (int power = degree; power >= 0; --power)
      for (int q = 0; q < 2; ++q) *c++ = piece.c[q][power];
  return true;
}

template class RealSpaceTable<float>;
template class RealSpaceTable<double>;

}    // namespace bdh
