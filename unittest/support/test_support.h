// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Shared parts of the core's tests: grids, whole fields gathered from all ranks, and particles
/// dealt to ranks.
#ifndef BDH_TEST_SUPPORT_H
#define BDH_TEST_SUPPORT_H

#include "base/comm.h"
#include "fib/spread.h"
#include "grid/grid.h"
#include "grid/parts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <random>
#include <string>
#include <vector>

namespace bdh_test {

inline bdh::Comm world() { return bdh::Comm(MPI_COMM_WORLD); }
inline bdh::Comm self() { return bdh::Comm(MPI_COMM_SELF); }

/// Copies between host memory and the arrays of a backend.  A device backend specialises it before
/// it includes a typed_*.h.
template <class Backend> struct Access {
  template <class Vector> static void put(const std::vector<double> &from, Vector &to)
  {
    to.assign(from.begin(), from.end());
  }
  template <class Vector> static std::vector<double> get(const Vector &from)
  {
    return std::vector<double>(from.begin(), from.end());
  }
};

/// n: 2 or 3 numbers of cells; h: as many spacings.  The corner is not at 0, so that a forgotten
/// origin shows.
inline bdh::Grid make_grid(const std::vector<long> &n, std::vector<double> h, double corner = -0.75)
{
  bdh::Grid g;
  g.dim = n.size();
  if (h.size() == 1) h.assign(n.size(), h[0]);
  for (int d = 0; d < g.dim; ++d) {
    g.n[d] = n[d];
    g.length[d] = n[d] * h[d];
    g.lo[d] = corner;
  }
  return g;
}

/// 0, 1, 2, ...
inline std::vector<uint64_t> counted(std::size_t n)
{
  std::vector<uint64_t> v(n);
  std::iota(v.begin(), v.end(), uint64_t(0));
  return v;
}

inline std::string name_of(const bdh::Grid &g)
{
  std::string s = std::to_string(g.n[0]) + "x" + std::to_string(g.n[1]);
  return g.dim == 3 ? s + "x" + std::to_string(g.n[2]) : s;
}

inline long wrap(long i, long n) { return (i % n + n) % n; }

/// A vector field on all faces of the box, without padding; x fastest.
struct Field {
  bdh::Grid grid;
  std::array<std::vector<double>, 3> c;

  explicit Field(const bdh::Grid &g) : grid(g)
  {
    for (int d = 0; d < g.dim; ++d) c[d].assign(g.cells(), 0.0);
  }
  std::size_t place(long i, long j, long k) const
  {
    const auto &n = grid.n;
    return (wrap(k, n[2]) * n[1] + wrap(j, n[1])) * n[0] + wrap(i, n[0]);
  }
  double &at(int d, long i, long j, long k) { return c[d][place(i, j, k)]; }
  double at(int d, long i, long j, long k) const { return c[d][place(i, j, k)]; }
  double norm() const
  {
    double s = 0.0;
    for (int d = 0; d < grid.dim; ++d)
      for (double v : c[d]) s += v * v;
    return std::sqrt(s);
  }
};

inline double distance(const Field &a, const Field &b)
{
  double s = 0.0;
  for (int d = 0; d < a.grid.dim; ++d)
    for (std::size_t i = 0; i < a.c[d].size(); ++i)
      s += (a.c[d][i] - b.c[d][i]) * (a.c[d][i] - b.c[d][i]);
  return std::sqrt(s);
}

inline Field random_field(const bdh::Grid &g, unsigned seed)
{
  Field f(g);
  std::mt19937_64 engine(seed);
  std::normal_distribution<double> normal;
  for (int d = 0; d < g.dim; ++d)
    for (double &v : f.c[d]) v = normal(engine);
  return f;
}

/// Calls action(local index in the padded array, index in Field) for every face of planes with all
/// of their rows, or with some.
template <class Action>
void for_planes(const bdh::Grid &g, const bdh::Slab &planes, const bdh::Slab &rows, Action action)
{
  const long row = 2 * g.half(), all = g.dim == 3 ? g.n[1] : 1;
  for (long p = 0; p < planes.count; ++p)
    for (long j = rows.start; j < rows.start + rows.count; ++j)
      for (long i = 0; i < g.n[0]; ++i)
        action((p * all + j) * row + i, (((planes.start + p) * all + j) * g.n[0] + i));
}
template <class Action> void for_slab(const bdh::Grid &g, const bdh::Slab &slab, Action action)
{
  for_planes(g, slab, {0, g.dim == 3 ? g.n[1] : 1}, action);
}
template <class Action>
void for_part(const bdh::Grid &g, const bdh::GridParts &parts, Action action)
{
  for_planes(g, parts.planes(), parts.rows(), action);
}

/// This rank's part of component d in the padded layout of VectorFft.  All else is NaN, since
/// nothing may read it.
inline std::vector<double> slab_part(const Field &f, int d, const bdh::Slab &slab,
                                     std::size_t allocation)
{
  std::vector<double> local(allocation, NAN);
  for_slab(f.grid, slab, [&](std::size_t to, std::size_t from) { local[to] = f.c[d][from]; });
  return local;
}
inline std::vector<double> own_part(const Field &f, int d, const bdh::GridParts &parts,
                                    std::size_t allocation)
{
  std::vector<double> local(allocation, NAN);
  for_part(f.grid, parts, [&](std::size_t to, std::size_t from) { local[to] = f.c[d][from]; });
  return local;
}

inline void add_slab(const std::vector<double> &local, int d, const bdh::Slab &slab, Field &f)
{
  for_slab(f.grid, slab, [&](std::size_t from, std::size_t to) { f.c[d][to] += local[from]; });
}
inline void add_part(const std::vector<double> &local, int d, const bdh::GridParts &parts, Field &f)
{
  for_part(f.grid, parts, [&](std::size_t from, std::size_t to) { f.c[d][to] += local[from]; });
}

/// Adds up over all ranks, in place.
inline void sum_over_ranks(std::vector<double> &v, const bdh::Comm &comm)
{
  MPI_Allreduce(MPI_IN_PLACE, v.data(), v.size(), MPI_DOUBLE, MPI_SUM, comm.handle());
}
inline void sum_over_ranks(Field &f, const bdh::Comm &comm)
{
  for (int d = 0; d < f.grid.dim; ++d) sum_over_ranks(f.c[d], comm);
}

/// 3 n random coordinates, with factor > 1 also outside the box.  In 2D the third coordinate is
/// random, too, and must not matter.
inline std::vector<double> random_positions(const bdh::Grid &g, long n, unsigned seed,
                                            double factor = 1.0)
{
  std::mt19937_64 engine(seed);
  std::uniform_real_distribution<double> uniform(0.5 - 0.5 * factor, 0.5 + 0.5 * factor);
  std::vector<double> x(3 * n);
  for (long i = 0; i < n; ++i)
    for (int d = 0; d < 3; ++d) x[3 * i + d] = g.lo[d] + uniform(engine) * g.length[d];
  return x;
}

inline std::vector<double> random_numbers(std::size_t n, unsigned seed)
{
  std::mt19937_64 engine(seed);
  std::normal_distribution<double> normal;
  std::vector<double> v(n);
  for (double &a : v) a = normal(engine);
  return v;
}

inline double norm(const std::vector<double> &v)
{
  double s = 0.0;
  for (double a : v) s += a * a;
  return std::sqrt(s);
}

inline double difference(const std::vector<double> &a, const std::vector<double> &b)
{
  double s = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) s += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(s);
}

/// Deals particles round-robin.  `mine` lists the global numbers of this rank's particles.  Arrays
/// have `width` numbers per particle.
struct Deal {
  std::vector<long> mine;
  Deal(long n, const bdh::Comm &comm)
  {
    for (long i = comm.rank(); i < n; i += comm.size()) mine.push_back(i);
  }
  std::vector<double> take(const std::vector<double> &all, long width = 3) const
  {
    std::vector<double> v;
    for (long i : mine) v.insert(v.end(), all.begin() + width * i, all.begin() + width * (i + 1));
    return v;
  }
  std::vector<double> gather(const std::vector<double> &part, long n, const bdh::Comm &comm,
                             long width = 3) const
  {
    std::vector<double> all(width * n, 0.0);
    for (std::size_t m = 0; m < mine.size(); ++m)
      for (long d = 0; d < width; ++d) all[width * mine[m] + d] = part[width * m + d];
    sum_over_ranks(all, comm);
    return all;
  }
};

/// Running mean with its standard error.  The samples must be independent; correlated ones have to
/// be averaged over batches first.
struct Mean {
  double n = 0.0, mean = 0.0, m2 = 0.0;
  void add(double v)
  {
    n += 1.0;
    const double d = v - mean;
    mean += d / n;
    m2 += d * (v - mean);
  }
  double error() const { return std::sqrt(m2 / (n - 1.0) / n); }
  /// Deviation from `expected` in standard errors.
  double z(double expected) const { return (mean - expected) / error(); }
};

}    // namespace bdh_test
#endif
