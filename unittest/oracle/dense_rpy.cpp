// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
#include "oracle/dense_rpy.h"

#include "base/constants.h"
#include "base/errors.h"
#include "pse/rpy.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <utility>

namespace bdh {

namespace {

/// Largest allowed truncation error of either sum, in units of 1/(6 pi viscosity a).
constexpr double truncation = 1e-15;

/// A symmetric 3 x 3 block: xx, yy, zz, xy, xz, yz.
using Block = std::array<double, 6>;
constexpr int block_row[6] = {0, 1, 2, 0, 0, 1}, block_column[6] = {0, 1, 2, 1, 2, 2};

void check(const Cell &cell, double radius, double viscosity)
{
  if (!(cell.lx > 0.0 && cell.ly > 0.0 && cell.lz > 0.0))
    throw InvalidOption("volume of the cell", cell.volume(), "must be > 0 along every axis");
  if (!(radius > 0.0)) throw InvalidOption("radius", radius, "must be > 0");
  if (!(viscosity > 0.0)) throw InvalidOption("viscosity", viscosity, "must be > 0");
}

/// Upper bound of the sum over images beyond r.  The density of images is 1/V.  At worst all images
/// in a layer as thick as the longest edge of the cell coincide, which the second term allows for.
double real_space_rest(const Cell &cell, double r, double a, double xi)
{
  const RpyPair m = real_space_exact(r, a, xi);
  const double size = std::fabs(m.transverse) + std::fabs(m.longitudinal);
  const double decay = 1.0 / (2.0 * xi * xi * (r - 2.0 * a));    // |M| ~ exp(-xi^2 (r - 2a)^2)
  const double layer = decay + std::max({cell.edge(0), cell.edge(1), cell.edge(2)});
  return size * (1.0 + 4.0 * pi * r * r * layer / cell.volume());
}

double real_space_cutoff(const Cell &cell, double a, double xi)
{
  double r = 2.0 * a + 4.0 / xi;
  while (real_space_rest(cell, r, a, xi) > truncation) r += 0.1 / xi;
  return r;
}

/// The same bound in wave space, where the density of modes is V/(2 pi)^3.
double wave_space_rest(const Cell &cell, double k, double a, double xi)
{
  const double shape = std::min(1.0, 1.0 / (k * a * k * a));
  const double size = 6.0 * pi * a / cell.volume() * hasimoto_split(k, xi) * shape / (k * k);
  const double decay = 2.0 * xi * xi / k;
  const double layer = decay + 2.0 * pi * std::max({1.0 / cell.lx, 1.0 / cell.ly, 1.0 / cell.lz});
  return size * (1.0 + 4.0 * pi * k * k * layer * cell.volume() / (8.0 * pi * pi * pi));
}

double wave_space_cutoff(const Cell &cell, double a, double xi)
{
  double k = 4.0 * xi;
  while (wave_space_rest(cell, k, a, xi) > truncation) k += 0.1 * xi;
  return k;
}

/// F/(6 pi eta a) (I - r r^T/r^2) + G/(6 pi eta a) r r^T/r^2
Block pair_block(const double *r, double distance, double a, double xi, double free_mobility)
{
  const RpyPair m = real_space_exact(distance, a, xi);
  const double f = free_mobility * m.transverse;
  const double d = distance > 0.0
                       ? free_mobility * (m.longitudinal - m.transverse) / (distance * distance)
                       : 0.0;
  Block b;
  for (int c = 0; c < 6; ++c) b[c] = (c < 3 ? f : 0.0) + d * r[block_row[c]] * r[block_column[c]];
  return b;
}

/// The sum of real-space blocks of one pair over all images with |x - y + image| < r_cut.
Block image_sum(const Cell &cell, const double *x, const double *y, double r_cut, double a,
                double xi, double free_mobility)
{
  Block sum{};
  double sx[3], sy[3], m[3], r[3];
  cell.to_fractional(x, sx);
  cell.to_fractional(y, sy);
  // index + s along an axis is g.r/(2 pi), with the reciprocal vector g of that axis.
  double range[3];
  for (int d = 0; d < 3; ++d) {
    double g[3];
    cell.wave_vector(d == 0, d == 1, d == 2, g);
    range[d] = r_cut * std::sqrt(g[0] * g[0] + g[1] * g[1] + g[2] * g[2]) / (2.0 * pi);
  }
  const double s[3] = {sx[0] - sy[0], sx[1] - sy[1], sx[2] - sy[2]};
  const auto first = [&](int d) { return std::ceil(-range[d] - s[d]); };
  const auto last = [&](int d) { return range[d] - s[d]; };
  for (m[2] = first(2); m[2] <= last(2); m[2] += 1.0)
    for (m[1] = first(1); m[1] <= last(1); m[1] += 1.0)
      for (m[0] = first(0); m[0] <= last(0); m[0] += 1.0) {
        cell.lattice_vector(m, r);
        for (int d = 0; d < 3; ++d) r[d] += x[d] - y[d];
        const double distance2 = r[0] * r[0] + r[1] * r[1] + r[2] * r[2];
        if (distance2 >= r_cut * r_cut) continue;
        const Block b = pair_block(r, std::sqrt(distance2), a, xi, free_mobility);
        for (int c = 0; c < 6; ++c) sum[c] += b[c];
      }
  return sum;
}

/// One wave vector of each pair k, -k with 0 < |k| < k_cut: its index and the contribution of both
/// to M.
struct Mode {
  std::array<int, 3> index;
  Block weight;
};

std::vector<Mode> modes(const Cell &cell, double a, double viscosity, double xi, double k_cut)
{
  std::vector<Mode> all;
  std::array<int, 3> top;
  for (int d = 0; d < 3; ++d) top[d] = static_cast<int>(k_cut * cell.edge(d) / (2.0 * pi));
  for (int n2 = 0; n2 <= top[2]; ++n2)
    for (int n1 = n2 > 0 ? -top[1] : 0; n1 <= top[1]; ++n1)
      for (int n0 = n2 > 0 || n1 > 0 ? -top[0] : 1; n0 <= top[0]; ++n0) {
        double k[3];
        cell.wave_vector(n0, n1, n2, k);
        const double k2 = k[0] * k[0] + k[1] * k[1] + k[2] * k[2], length = std::sqrt(k2);
        if (length >= k_cut) continue;
        const double shape = sinc(length * a);
        const double w =
            2.0 * shape * shape * hasimoto_split(length, xi) / (viscosity * cell.volume() * k2);
        Mode mode{{n0, n1, n2}, {}};
        for (int c = 0; c < 6; ++c)
          mode.weight[c] = (c < 3 ? w : 0.0) - w * k[block_row[c]] * k[block_column[c]] / k2;
        all.push_back(mode);
      }
  // Small terms come first: 1e5 terms of one sign, added in the order of their index, would lose
  // four digits.
  const auto size = [](const Mode &m) { return m.weight[0] + m.weight[1] + m.weight[2]; };
  std::sort(all.begin(), all.end(),
            [&](const Mode &p, const Mode &q) { return size(p) < size(q); });
  return all;
}

/// e^(i k.x) for all particles, from one table per axis.
class Phases {
 public:
  Phases(const Cell &cell, const double *x, long n, const std::vector<Mode> &modes) : n_(n)
  {
    std::array<int, 3> top{};
    for (const Mode &m : modes)
      for (int d = 0; d < 3; ++d) top[d] = std::max(top[d], std::abs(m.index[d]));
    for (int d = 0; d < 3; ++d) {
      cos_[d].resize((top[d] + 1) * n);
      sin_[d].resize(cos_[d].size());
    }
    for (long i = 0; i < n; ++i) {
      double s[3];
      cell.to_fractional(x + 3 * i, s);
      for (int d = 0; d < 3; ++d) {
        s[d] -= std::floor(s[d]);
        for (int m = 0; m <= top[d]; ++m) {
          // Whole turns are dropped before rounding.
          const double turns = m * s[d],
                       rest = turns - std::round(turns) + std::fma(m, s[d], -turns);
          cos_[d][m * n + i] = std::cos(2.0 * pi * rest);
          sin_[d][m * n + i] = std::sin(2.0 * pi * rest);
        }
      }
    }
  }
  /// Sets n cosines and n sines.
  void of(const Mode &mode, double *re, double *im) const
  {
    const double *c[3], *s[3];
    double sign[3];
    for (int d = 0; d < 3; ++d) {
      const std::size_t at = std::abs(mode.index[d]) * n_;
      c[d] = cos_[d].data() + at;
      s[d] = sin_[d].data() + at;
      sign[d] = mode.index[d] < 0 ? -1.0 : 1.0;
    }
    for (long i = 0; i < n_; ++i) {
      const double s0 = sign[0] * s[0][i], s1 = sign[1] * s[1][i], s2 = sign[2] * s[2][i];
      const double p = c[0][i] * c[1][i] - s0 * s1, q = c[0][i] * s1 + s0 * c[1][i];
      re[i] = p * c[2][i] - q * s2;
      im[i] = p * s2 + q * c[2][i];
    }
  }

 private:
  long n_;
  std::array<std::vector<double>, 3> cos_, sin_;
};

double free_mobility(double radius, double viscosity)
{
  return 1.0 / (6.0 * pi * viscosity * radius);
}

/// Writes block (i, j) and its transpose (j, i), which has the same entries.
void put(std::vector<double> &matrix, long n, long i, long j, const Block &b)
{
  for (int c = 0; c < 6; ++c) {
    const long r = block_row[c], s = block_column[c];
    for (const auto &[p, q] : {std::array<long, 2>{r, s}, std::array<long, 2>{s, r}}) {
      matrix[(3 * i + p) * 3 * n + 3 * j + q] = b[c];
      matrix[(3 * j + p) * 3 * n + 3 * i + q] = b[c];
    }
  }
}

std::vector<double> real_matrix(const Cell &cell, const double *x, long n, double radius,
                                double viscosity, double xi)
{
  std::vector<double> matrix(9 * n * n);
  const double r_cut = real_space_cutoff(cell, radius, xi),
               mobility = free_mobility(radius, viscosity);
  const Block self = image_sum(cell, x, x, r_cut, radius, xi, mobility);
  for (long i = 0; i < n; ++i) {
    put(matrix, n, i, i, self);
    for (long j = i + 1; j < n; ++j)
      put(matrix, n, i, j, image_sum(cell, x + 3 * i, x + 3 * j, r_cut, radius, xi, mobility));
  }
  return matrix;
}

std::vector<double> wave_matrix(const Cell &cell, const double *x, long n, double radius,
                                double viscosity, double xi)
{
  const std::vector<Mode> all =
      modes(cell, radius, viscosity, xi, wave_space_cutoff(cell, radius, xi));
  const Phases phases(cell, x, n, all);
  // Takes a few modes at a time, so that their phases and one row of blocks stay in cache.
  const std::size_t batch = 32, row = n;
  std::vector<double> re(batch * row), im(batch * row), sums(6 * row * row, 0.0);
  for (std::size_t begin = 0; begin < all.size(); begin += batch) {
    const std::size_t count = std::min(batch, all.size() - begin);
    for (std::size_t b = 0; b < count; ++b) phases.of(all[begin + b], &re[b * row], &im[b * row]);
    for (std::size_t i = 0; i < row; ++i) {
      double *xx = &sums[6 * row * i], *yy = xx + row, *zz = yy + row, *xy = zz + row,
             *xz = xy + row, *yz = xz + row;
      for (std::size_t b = 0; b < count; ++b) {
        const Block &w = all[begin + b].weight;
        const double *c = &re[b * row], *s = &im[b * row], ci = c[i], si = s[i];
        BDH_INDEPENDENT
        for (std::size_t j = i; j < row; ++j) {
          const double g = ci * c[j] + si * s[j];    // cos k.(x_i - x_j)
          xx[j] += w[0] * g;
          yy[j] += w[1] * g;
          zz[j] += w[2] * g;
          xy[j] += w[3] * g;
          xz[j] += w[4] * g;
          yz[j] += w[5] * g;
        }
      }
    }
  }
  std::vector<double> matrix(9 * row * row);
  for (std::size_t i = 0; i < row; ++i)
    for (std::size_t j = i; j < row; ++j) {
      Block b;
      for (std::size_t c = 0; c < 6; ++c) b[c] = sums[(6 * i + c) * row + j];
      put(matrix, n, i, j, b);
    }
  return matrix;
}

void multiply_add(const Block &b, const double *f, double *u)
{
  u[0] += b[0] * f[0] + b[3] * f[1] + b[4] * f[2];
  u[1] += b[3] * f[0] + b[1] * f[1] + b[5] * f[2];
  u[2] += b[4] * f[0] + b[5] * f[1] + b[2] * f[2];
}

/// With cutoffs near 12 xi and 6/xi a pair needs about 15 xi^3 V modes and 900/(xi^3 V) images.
/// This makes both take equally long when an image costs as much as `image_cost` modes.
double balanced_xi(const Cell &cell, double image_cost)
{
  const double V = cell.volume();
  return std::pow(60.0 * image_cost / (V * V), 1.0 / 6.0);
}

}    // namespace

DenseSplit dense_split(const Cell &cell, const double *x, long n, double radius, double viscosity,
                       double xi)
{
  check(cell, radius, viscosity);
  if (!(xi > 0.0)) throw InvalidOption("xi", xi, "must be > 0");
  if (n == 0) return {};
  return {real_matrix(cell, x, n, radius, viscosity, xi),
          wave_matrix(cell, x, n, radius, viscosity, xi)};
}

std::vector<double> dense_mobility(const Cell &cell, const double *x, long n, double radius,
                                   double viscosity)
{
  check(cell, radius, viscosity);
  DenseSplit split = dense_split(cell, x, n, radius, viscosity, balanced_xi(cell, 300.0));
  for (std::size_t m = 0; m < split.real.size(); ++m) split.real[m] += split.wave[m];
  return std::move(split.real);
}

void dense_apply(const Cell &cell, const double *x, long n, double radius, double viscosity,
                 const double *force, double *velocity)
{
  check(cell, radius, viscosity);
  std::fill(velocity, velocity + 3 * n, 0.0);
  if (n == 0) return;
  // Structure factors are shared, so a mode costs n operations here and not n^2/2.
  const double xi = balanced_xi(cell, 30.0 * n);
  const double r_cut = real_space_cutoff(cell, radius, xi),
               mobility = free_mobility(radius, viscosity);
  const Block self = image_sum(cell, x, x, r_cut, radius, xi, mobility);
  for (long i = 0; i < n; ++i) {
    multiply_add(self, force + 3 * i, velocity + 3 * i);
    for (long j = i + 1; j < n; ++j) {
      const Block b = image_sum(cell, x + 3 * i, x + 3 * j, r_cut, radius, xi, mobility);
      multiply_add(b, force + 3 * j, velocity + 3 * i);
      multiply_add(b, force + 3 * i, velocity + 3 * j);
    }
  }

  const std::vector<Mode> all =
      modes(cell, radius, viscosity, xi, wave_space_cutoff(cell, radius, xi));
  const Phases phases(cell, x, n, all);
  std::vector<double> re(n), im(re.size());
  for (const Mode &mode : all) {
    phases.of(mode, re.data(), im.data());
    double f[6] = {}, u[6] = {};    // f: sum of f_j e^(-i k.x_j), real parts first
    for (long j = 0; j < n; ++j)
      for (int d = 0; d < 3; ++d) {
        f[d] += force[3 * j + d] * re[j];
        f[3 + d] -= force[3 * j + d] * im[j];
      }
    multiply_add(mode.weight, f, u);
    multiply_add(mode.weight, f + 3, u + 3);
    for (long j = 0; j < n; ++j)
      for (int d = 0; d < 3; ++d) velocity[3 * j + d] += u[d] * re[j] - u[3 + d] * im[j];
  }
}

}    // namespace bdh
