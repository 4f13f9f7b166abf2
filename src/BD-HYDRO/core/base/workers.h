// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Threads for the loops of the core, which itself knows none.
#ifndef BDH_BASE_WORKERS_H
#define BDH_BASE_WORKERS_H

#include <algorithm>
#include <functional>
#include <vector>

namespace bdh {

/// Does the independent parts of a loop; here on the calling thread.
///
/// What the parts are may depend on the problem, but where sums are taken it does not depend on the
/// number of workers, so that results do not either.  (RealSpace is the exception, and says so.)
class Workers {
 public:
  virtual ~Workers() = default;
  virtual int count() const { return 1; }
  /// task(i, worker) for i = 0 .. tasks - 1, in any order, at the same time on different workers 0
  /// .. count() - 1.  What a task throws comes out here, from the first one that does.
  virtual void run(long tasks, const std::function<void(long, int)> &task) const
  {
    for (long i = 0; i < tasks; ++i) task(i, 0);
  }
  bool alone() const { return count() == 1; }

  /// action(begin, end) for ranges that make up 0 .. n - 1.  cost: of one of them, over that of
  /// adding a number to another.
  template <class Action> void for_ranges(long n, Action action, long cost = 1) const
  {
    const long part = std::max(1L, range / cost);
    if (alone() || n <= part) return action(0L, n);
    run((n + part - 1) / part, [&](long i, int) { action(i * part, std::min(n, (i + 1) * part)); });
  }
  /// Sum of term(begin, end) over ranges, in their order.
  template <class Term> double sum_ranges(long n, Term term) const
  {
    const long ranges = (n + range - 1) / range;
    std::vector<double> part(ranges);
    run(ranges, [&](long i, int) { part[i] = term(i * range, std::min(n, (i + 1) * range)); });
    double sum = 0.0;
    for (double p : part) sum += p;
    return sum;
  }

  /// The calling thread alone.
  static const Workers &one()
  {
    static const Workers w;
    return w;
  }

 private:
  static constexpr long range = 8192;    // numbers: 64 kB, far above what handing out a task costs
};

}    // namespace bdh
#endif
