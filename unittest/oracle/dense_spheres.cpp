// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
#include "oracle/dense_spheres.h"

#include "base/constants.h"
#include "pse/sphere_pair_kernel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>

namespace bdh {

namespace {

/// Hasimoto's function; without its polynomial the real-space part would fall off like 1/r^3 only.
double split(double k, double xi)
{
  const double t2 = k * k / (4.0 * xi * xi);
  return (1.0 + t2) * std::exp(-t2);
}

double force_shape(double x) { return x < 1e-4 ? 1.0 - x * x / 6.0 : std::sin(x) / x; }
double torque_shape(double x)
{
  return x < 1e-2 ? 1.0 - x * x / 10.0 + x * x * x * x / 280.0
                  : 3.0 * (std::sin(x) - x * std::cos(x)) / (x * x * x);
}

/// One 6 x 6 block: U and W of i by F and T of j.
using Block = std::array<std::array<double, 6>, 6>;

/// Scalar functions of a pair: transverse and longitudinal part of the translation, coefficient of
/// e x F and of e x T, transverse and longitudinal part of the rotation.  In 1/(6 pi viscosity).
struct Scalars {
  double tt, tl, rf, ut, rt, rl;
};

/// Of the wave-space part, by Simpson's rule in k.
Scalars wave_scalars(double r, double ai, double aj, double xi)
{
  const double top = 13.5 * xi;
  const int n = 2 * static_cast<int>(200 + top * (r + ai + aj));
  const double h = top / n;
  Scalars s{};
  for (int m = 0; m <= n; ++m) {
    const double k = m * h, x = k * r,
                 weight = (m == 0 || m == n ? 1.0
                           : m % 2          ? 4.0
                                            : 2.0) *
                          h / 3.0 * split(k, xi);
    const double j0 = force_shape(x), j1 = torque_shape(x) / 3.0;    // sin x/x, j_1/x
    const double ti = force_shape(k * ai), tj = force_shape(k * aj), ri = torque_shape(k * ai),
                 rj = torque_shape(k * aj);
    s.tt += weight * ti * tj * (j0 - j1);
    s.tl += weight * ti * tj * 2.0 * j1;
    s.rf -= 0.5 * weight * ri * tj * k * x * j1;
    s.ut -= 0.5 * weight * ti * rj * k * x * j1;
    s.rt += 0.25 * weight * ri * rj * k * k * (j0 - j1);
    s.rl += 0.25 * weight * ri * rj * k * k * 2.0 * j1;
  }
  const double scale = 3.0 / pi;
  return {scale * s.tt, scale * s.tl, scale * s.rf, scale * s.ut, scale * s.rt, scale * s.rl};
}

/// The real-space part; at r = 0 that of a sphere by itself.
Scalars real_scalars(double r, double ai, double aj, double xi)
{
  Scalars s = wave_scalars(r, ai, aj, xi);
  const PairBlock t = sphere_translation(r, ai, aj), q = sphere_rotation(r, ai, aj);
  const double near = std::max(r, 1e-12);
  return {t.transverse - s.tt,
          t.transverse + t.difference - s.tl,
          sphere_coupling(near, ai, aj) - s.rf,
          sphere_coupling(near, aj, ai) - s.ut,
          q.transverse - s.rt,
          q.transverse + q.difference - s.rl};
}

void add_scalars(const Scalars &s, const double *e, double factor, Block &b)
{
  const double cross[3][3] = {{0, -e[2], e[1]}, {e[2], 0, -e[0]}, {-e[1], e[0], 0}};
  for (int p = 0; p < 3; ++p)
    for (int q = 0; q < 3; ++q) {
      const double along = e[p] * e[q], across = (p == q) - along;
      b[p][q] += factor * (s.tt * across + s.tl * along);
      b[p][3 + q] += factor * s.ut * cross[p][q];
      b[3 + p][q] += factor * s.rf * cross[p][q];
      b[3 + p][3 + q] += factor * (s.rt * across + s.rl * along);
    }
}

/// Calls action(index vector) for all integers up to the limits.
template <class Action> void for_indices(const std::array<long, 3> &top, const Action &action)
{
  for (long a = -top[0]; a <= top[0]; ++a)
    for (long b = -top[1]; b <= top[1]; ++b)
      for (long c = -top[2]; c <= top[2]; ++c) action(a, b, c);
}

struct Sum {
  const Cell &cell;
  double xi, k_cut, r_cut, viscosity;

  void add_images(const double *x, const double *y, double ai, double aj, Block &block) const
  {
    std::array<long, 3> top;
    for (int d = 0; d < 3; ++d) {
      double g[3];
      cell.wave_vector(d == 0, d == 1, d == 2, g);
      top[d] = 2 + r_cut * std::sqrt(g[0] * g[0] + g[1] * g[1] + g[2] * g[2]) / two_pi;
    }
    double sx[3], sy[3];
    cell.to_fractional(x, sx);
    cell.to_fractional(y, sy);
    for_indices(top, [&](long a, long b, long c) {
      double s[3] = {double(a), double(b), double(c)}, r[3];
      for (int d = 0; d < 3; ++d) s[d] += sx[d] - sy[d] - std::round(sx[d] - sy[d]);
      cell.lattice_vector(s, r);
      const double distance = std::sqrt(r[0] * r[0] + r[1] * r[1] + r[2] * r[2]);
      if (distance > r_cut) return;
      double e[3] = {0.0, 0.0, 1.0};
      if (distance > 0.0)
        for (int d = 0; d < 3; ++d) e[d] = r[d] / distance;
      Scalars m = real_scalars(distance, ai, aj, xi);
      if (distance == 0.0) m = {m.tt, m.tt, 0.0, 0.0, m.rt, m.rt};
      add_scalars(m, e, 1.0 / (6.0 * pi * viscosity), block);
    });
  }

  void add_waves(const double *x, const double *y, double ai, double aj, Block &block) const
  {
    std::array<long, 3> top;
    for (int d = 0; d < 3; ++d) top[d] = 1 + k_cut * cell.edge(d) / two_pi;
    for_indices(top, [&](long a, long b, long c) {
      if (a == 0 && b == 0 && c == 0) return;
      double k[3];
      cell.wave_vector(a, b, c, k);
      const double k2 = k[0] * k[0] + k[1] * k[1] + k[2] * k[2], length = std::sqrt(k2);
      if (length > k_cut) return;
      double phase = 0.0;
      for (int d = 0; d < 3; ++d) phase += k[d] * (x[d] - y[d]);
      const double w = split(length, xi) / (viscosity * cell.volume() * k2);
      const double ti = force_shape(length * ai), tj = force_shape(length * aj),
                   ri = torque_shape(length * ai), rj = torque_shape(length * aj);
      // A torque has the force density (i/2) k x T; so has the answer.
      const double cross[3][3] = {{0, -k[2], k[1]}, {k[2], 0, -k[0]}, {-k[1], k[0], 0}};
      const double even = w * std::cos(phase), odd = -0.5 * w * std::sin(phase);
      for (int p = 0; p < 3; ++p)
        for (int q = 0; q < 3; ++q) {
          const double across = (p == q) - k[p] * k[q] / k2;
          block[p][q] += even * ti * tj * across;
          block[p][3 + q] += odd * ti * rj * cross[p][q];
          block[3 + p][q] += odd * ri * tj * cross[p][q];
          block[3 + p][3 + q] += 0.25 * k2 * even * ri * rj * across;
        }
    });
  }
};

}    // namespace

std::vector<double> dense_spheres(const Cell &cell, const std::vector<double> &x,
                                  const std::vector<double> &radius, double viscosity)
{
  const std::size_t n = radius.size();
  const double largest = *std::max_element(radius.begin(), radius.end());
  const double xi = 2.6 / std::cbrt(cell.volume());
  const Sum sum{cell, xi, 12.5 * xi, 2.0 * largest + 6.2 / xi, viscosity};
  std::vector<double> matrix(36 * n * n);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i; j < n; ++j) {
      Block block{};
      sum.add_images(&x[3 * i], &x[3 * j], radius[i], radius[j], block);
      sum.add_waves(&x[3 * i], &x[3 * j], radius[i], radius[j], block);
      for (std::size_t p = 0; p < 6; ++p)
        for (std::size_t q = 0; q < 6; ++q) {
          const std::size_t row = 3 * i + p % 3 + (p / 3) * 3 * n,
                            column = 3 * j + q % 3 + (q / 3) * 3 * n;
          matrix[row * 6 * n + column] = matrix[column * 6 * n + row] = block[p][q];
        }
    }
  return matrix;
}

}    // namespace bdh
