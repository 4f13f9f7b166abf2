// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// The host's answers to "what differs between host and device".
#ifndef BDH_FIB_HOST_H
#define BDH_FIB_HOST_H

#include "base/comm.h"
#include "base/portable.h"
#include "base/ssize.h"
#include "fib/spread.h"
#include "grid/grid.h"
#include "stokes/choice.h"

#include <algorithm>
#include <vector>

namespace bdh {

/// A backend names its arrays, its spreading, its solvers, and how it does loops.  Algorithms are
/// templates over it.
struct HostBackend {
  using Vector = AlignedVector;                  ///< of a grid
  using ParticleVector = std::vector<double>;    ///< of particles
  using Flags = std::vector<char>;
  using Spreader = HostSpreader;
  using Stokes = AnyStokes;

  static constexpr bool several_ranks = true;    ///< a field may be dealt to ranks in slabs
  static constexpr bool sums_in_order = true;    ///< results are the same bit for bit in every run

  /// action(i) for i = 0 .. n - 1, in any order.  The names are for profilers of devices.
  template <class Action> static void for_each(const char *, long n, const Action &action)
  {
    BDH_INDEPENDENT
    for (long i = 0; i < n; ++i) action(i);
  }
  template <class Action> static double sum(const char *, long n, const Action &action)
  {
    double sum = 0.0;
    for (long i = 0; i < n; ++i) sum += action(i);
    return sum;
  }
  /// Smallest i in 0 .. n - 1 with condition(i), or -1.
  template <class Condition> static long first(const char *, long n, const Condition &condition)
  {
    for (long i = 0; i < n; ++i)
      if (condition(i)) return i;
    return -1;
  }
  /// Copies between particles' arrays here and those of the host.
  static ParticleVector from_host(const std::vector<double> &v) { return v; }
  static std::vector<double> to_host(const ParticleVector &v) { return v; }
  static void clear(Flags &flags) { std::fill(flags.begin(), flags.end(), 0); }
  static void clear(Vector &field, const Workers &workers)
  {
    double *f = field.data();
    workers.for_ranges(ssize(field),
                       [f](long begin, long end) { std::fill(f + begin, f + end, 0.0); });
  }
  /// As bdh::check_positions().
  static void check_positions(const Grid &grid, const double *x, long n, double slack)
  {
    bdh::check_positions(grid, x, n, slack);
  }
};

}    // namespace bdh
#endif
