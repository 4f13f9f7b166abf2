// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Where loops and arrays are: here on the host.  kokkos/base/execution_kokkos.h has the same for a
/// device.
///
/// Algorithms are templates over an execution and hold one.  It provides loops over independent
/// items, sums, searches, and the vector operations of iterations.
#ifndef BDH_BASE_EXECUTION_H
#define BDH_BASE_EXECUTION_H

#include "base/aligned.h"
#include "base/normal_strip.h"
#include "base/portable.h"
#include "base/ssize.h"
#include "base/workers.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace bdh {

/// The host with its workers.  Results do not depend on their number: items of a loop are
/// independent, and sums have a fixed order.
class HostExecution {
 public:
  using ParticleVector = std::vector<double>;
  using Flags = std::vector<char>;

  explicit HostExecution(const Workers &workers = Workers::one()) : workers_(&workers) {}
  const Workers &workers() const { return *workers_; }

  /// Calls action(i) for i = 0 .. n - 1, in any order.  The name is for profilers of devices.
  template <class Action> void for_each(const char *, long n, const Action &action) const
  {
    workers_->for_ranges(n, [action](long begin, long end) {
      BDH_INDEPENDENT
      for (long i = begin; i < end; ++i) action(i);
    });
  }
  /// Calls action(i, z) with the normals z[0] .. z[3] of draw index[i], for i = 0 .. n - 1 in any
  /// order.
  template <class Action> void for_draws(const char *, long n, const NoiseCounter &counter,
                                         const uint64_t *index, const Action &action) const
  {
    workers_->for_ranges(
        n, [=](long begin, long end) { for_draws_in(begin, end, counter, index, action); });
  }
  /// Returns the sum of term(i) over i = 0 .. n - 1, in this order.
  template <class Term> double sum(const char *, long n, const Term &term) const
  {
    double sum = 0.0;
    for (long i = 0; i < n; ++i) sum += term(i);
    return sum;
  }
  /// Returns the greatest term(i) over i = 0 .. n - 1, and 0 if all are less.
  template <class Term> double greatest(const char *, long n, const Term &term) const
  {
    double greatest = 0.0;
    for (long i = 0; i < n; ++i) greatest = std::max(greatest, term(i));
    return greatest;
  }
  /// Returns the smallest i in 0 .. n - 1 with condition(i), or -1.
  template <class Condition> long first(const char *, long n, const Condition &condition) const
  {
    for (long i = 0; i < n; ++i)
      if (condition(i)) return i;
    return -1;
  }
  /// Waits until all loops have ended.
  void fence() const {}

  /// Every number of an array := 0.
  template <class Array> void clear(Array &array) const
  {
    auto *v = array.data();
    workers_->for_ranges(ssize(array),
                         [v](long begin, long end) { std::fill(v + begin, v + end, 0); });
  }
  /// Copies between arrays of particles here and on the host.
  static ParticleVector from_host(const std::vector<double> &v) { return v; }
  static Flags from_host(const std::vector<char> &v) { return v; }
  static std::vector<double> to_host(const ParticleVector &v) { return v; }

  /// The dot product.  Sums of blocks are added up in double: single precision would lose digits
  /// over millions of entries.
  template <class Real> double dot(const Real *x, const Real *y, long size) const
  {
    return workers_->sum_ranges(size, [=](long begin, long stop) {
      double sum = 0.0;
      for (long first = begin; first < stop; first += 512) {
        const long end = first + 512 < stop ? first + 512 : stop;
        Real part[16] = {};
        long i = first;
        for (; i + 16 <= end; i += 16)
          for (int l = 0; l < 16; ++l) part[l] += x[i + l] * y[i + l];
        for (; i < end; ++i) part[0] += x[i] * y[i];
        for (Real p : part) sum += p;
      }
      return sum;
    });
  }
  /// y := f x
  template <class Real> void scale(Real f, const Real *x, Real *y, long size) const
  {
    workers_->for_ranges(size, [=](long begin, long end) {
      for (long i = begin; i < end; ++i) y[i] = f * x[i];
    });
  }
  /// w -= a v + b u
  template <class Real>
  void subtract(Real a, const Real *v, Real b, const Real *u, Real *w, long size) const
  {
    workers_->for_ranges(size, [=](long begin, long end) {
      for (long i = begin; i < end; ++i) w[i] -= a * v[i] + b * u[i];
    });
  }
  /// y := sum of factor[m] * vector[m]
  template <class Vector, class Real> void combine(const std::vector<double> &factor,
                                                   const std::vector<Vector> &vector, Real *y,
                                                   long size) const
  {
    workers_->for_ranges(size, [&](long begin, long end) {
      std::fill(y + begin, y + end, Real(0));
      for (std::size_t m = 0; m < factor.size(); ++m) {
        const Real f = factor[m];
        const Real *x = vector[m].data();
        for (long i = begin; i < end; ++i) y[i] += f * x[i];
      }
    });
  }

 private:
  const Workers *workers_;
};

}    // namespace bdh
#endif
