// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Configurations and neighbour lists for benchmarks without LAMMPS.
#ifndef BDH_BENCH_CELL_NEIGHBORS_H
#define BDH_BENCH_CELL_NEIGHBORS_H

#include "base/ssize.h"
#include "pse/real_space.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

namespace bdh_bench {

/// Bins over the cube [-margin, L + margin)^3.
class Bins {
 public:
  Bins(double L, double margin, double least_size)
  {
    lo_ = -margin;
    count_ = std::max(1.0, std::floor(std::min(most, (L + 2.0 * margin) / least_size)));
    inv_size_ = count_ / (L + 2.0 * margin);
    members_.resize(count_ * count_ * count_);
  }
  long axis(double x) const { return std::clamp((x - lo_) * inv_size_, 0.0, count_ - 1.0); }
  std::vector<int> &at(long i, long j, long k) { return members_[(k * count_ + j) * count_ + i]; }
  std::vector<int> &of(const double *x) { return at(axis(x[0]), axis(x[1]), axis(x[2])); }
  long count() const { return count_; }
  double size() const { return 1.0 / inv_size_; }

 private:
  static constexpr double most = 100.0;    // per axis; a large box may be nearly empty
  double lo_, inv_size_;
  long count_;
  std::vector<std::vector<int>> members_;
};

/// n non-overlapping spheres of diameter 2 in a cube of side L, by random sequential addition,
/// which works up to phi of about 0.3.  They are ordered by bins, as LAMMPS sorts its atoms.
inline std::vector<double> hard_spheres(long n, double L, unsigned seed)
{
  Bins bins(L, 0.0, 2.0);
  std::mt19937_64 engine(seed);
  std::uniform_real_distribution<double> uniform(0.0, L);
  std::vector<double> x;
  const long m = bins.count();
  while (bdh::ssize(x) < 3 * n) {
    const double y[3] = {uniform(engine), uniform(engine), uniform(engine)};
    bool free = true;
    const long c[3] = {bins.axis(y[0]), bins.axis(y[1]), bins.axis(y[2])};
    for (long k = -1; k <= 1 && free; ++k)
      for (long j = -1; j <= 1 && free; ++j)
        for (long i = -1; i <= 1 && free; ++i)
          for (int p : bins.at((c[0] + i + m) % m, (c[1] + j + m) % m, (c[2] + k + m) % m)) {
            double r2 = 0.0;
            for (int d = 0; d < 3; ++d) {
              double dx = y[d] - x[3 * p + d];
              dx -= L * std::round(dx / L);
              r2 += dx * dx;
            }
            if (r2 < 4.0) free = false;
          }
    if (!free) continue;
    bins.of(y).push_back(x.size() / 3);
    x.insert(x.end(), y, y + 3);
  }
  std::vector<double> sorted;
  for (long k = 0; k < m; ++k)
    for (long j = 0; j < m; ++j)
      for (long i = 0; i < m; ++i)
        for (int p : bins.at(i, j, k)) sorted.insert(sorted.end(), &x[3 * p], &x[3 * p] + 3);
  return sorted;
}

/// A half neighbor list with newton off and ghosts, for particles in a cube.
class CellNeighbors {
 public:
  CellNeighbors(const std::vector<double> &x, double L, double cutoff) : x_(x)
  {
    const long n = x.size() / 3, range = std::ceil(cutoff / L);
    for (long i = 0; i < n; ++i) particle_.push_back(i);
    for (long a = -range; a <= range; ++a)
      for (long b = -range; b <= range; ++b)
        for (long c = -range; c <= range; ++c) {
          if (!a && !b && !c) continue;
          for (long i = 0; i < n; ++i) {
            const double y[3] = {x[3 * i] + a * L, x[3 * i + 1] + b * L, x[3 * i + 2] + c * L};
            if (*std::min_element(y, y + 3) < -cutoff || *std::max_element(y, y + 3) > L + cutoff)
              continue;
            x_.insert(x_.end(), y, y + 3);
            particle_.push_back(i);
          }
        }
    Bins bins(L, cutoff, 0.5 * cutoff);
    const long all = bdh::ssize(particle_), reach = std::ceil(cutoff / bins.size());
    for (long i = 0; i < all; ++i) bins.of(&x_[3 * i]).push_back(i);
    lists_.resize(n);
    for (long i = 0; i < n; ++i) {
      const double *y = &x_[3 * i];
      const long c[3] = {bins.axis(y[0]), bins.axis(y[1]), bins.axis(y[2])};
      for (long k = std::max(0L, c[2] - reach); k <= std::min(bins.count() - 1, c[2] + reach); ++k)
        for (long j = std::max(0L, c[1] - reach); j <= std::min(bins.count() - 1, c[1] + reach);
             ++j)
          for (long l = std::max(0L, c[0] - reach); l <= std::min(bins.count() - 1, c[0] + reach);
               ++l)
            for (int q : bins.at(l, j, k)) {
              if (q <= i) continue;
              const double *z = &x_[3 * q];
              const double d[3] = {y[0] - z[0], y[1] - z[1], y[2] - z[2]};
              if (d[0] * d[0] + d[1] * d[1] + d[2] * d[2] <= cutoff * cutoff)
                lists_[i].push_back(q);
            }
      rows_.push_back(i);
      count_.push_back(lists_[i].size());
      first_.push_back(lists_[i].data());
    }
  }

  bdh::NeighborView view() const
  {
    bdh::NeighborView v;
    v.rows = bdh::ssize(rows_);
    v.atom = rows_.data();
    v.count = count_.data();
    v.neighbors = first_.data();
    v.local_atoms = rows_.size();
    v.x = x_.data();
    v.particle = particle_.data();
    return v;
  }

 private:
  std::vector<double> x_;
  std::vector<int> particle_, rows_, count_;
  std::vector<std::vector<int>> lists_;
  std::vector<const int *> first_;
};

}    // namespace bdh_bench
#endif
