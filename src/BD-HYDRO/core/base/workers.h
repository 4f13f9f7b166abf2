// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Threads for the loops of the core, which itself knows none.
#ifndef BDH_BASE_WORKERS_H
#define BDH_BASE_WORKERS_H

#include <algorithm>
#include <functional>
#include <vector>

namespace bdh {

/// Does the independent parts of a loop.  This class does them on the calling thread.
///
/// How a loop is divided may depend on the problem.  Where sums are taken it does not depend on the
/// number of workers, so that results do not either.  (RealSpace is the exception, and says so.)
class Workers {
 public:
  virtual ~Workers() = default;
  virtual int count() const { return 1; }
  /// Calls task(i, worker) for i = 0 .. tasks - 1, in any order, at the same time on different
  /// workers 0 .. count() - 1.  If tasks throw, this throws the exception of the first of them.
  virtual void run(long tasks, const std::function<void(long, int)> &task) const
  {
    for (long i = 0; i < tasks; ++i) task(i, 0);
  }
  bool alone() const { return count() == 1; }

  /// Calls action(begin, end) for ranges that make up 0 .. n - 1.  `cost` is that of one item,
  /// relative to that of adding a number to another.
  template <class Action> void for_ranges(long n, Action action, long cost = 1) const
  {
    const long part = std::max(1L, range / cost);
    if (alone() || n <= part) return action(0L, n);
    run((n + part - 1) / part, [&](long i, int) { action(i * part, std::min(n, (i + 1) * part)); });
  }
  /// Returns the sum of term(begin, end) over ranges, in their order.
  template <class Term> double sum_ranges(long n, Term term) const
  {
    const long ranges = (n + range - 1) / range;
    std::vector<double> part(ranges);
    run(ranges, [&](long i, int) { part[i] = term(i * range, std::min(n, (i + 1) * range)); });
    double sum = 0.0;
    for (double p : part) sum += p;
    return sum;
  }

  /// Workers that are the calling thread alone.
  static const Workers &one()
  {
    static const Workers w;
    return w;
  }

 private:
  // Numbers in a range.  Adding up 64 kB costs far more than handing out a task.
  static constexpr long range = 8192;
};

}    // namespace bdh
#endif
