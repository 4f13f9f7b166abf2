// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// The rows of a grid above one wall that particles need, so that a tall box costs nothing.
#ifndef BDH_FIB_ACTIVE_ROWS_H
#define BDH_FIB_ACTIVE_ROWS_H

#include "base/comm.h"
#include "grid/sorted_particles.h"

#include <algorithm>
#include <cmath>

namespace bdh {

/// Thrown on all ranks alike, before anything has moved, when a step must interpolate beyond the
/// rows of its grid.  It can be taken again on a grid with more rows.
struct GridTooLow {};

/// Opposite to a no-slip wall, neither velocities nor random numbers depend on where an open grid
/// ends (stokes/slit_kernel.h).  So the grid of a step may have only the rows up to the highest
/// particle.  How many is a function of the positions of all particles, the same on all ranks.
class ActiveRows {
 public:
  static constexpr long quantum = 8;      ///< the number of rows is a multiple of this, or all
  static constexpr double spare = 2.0;    ///< spacings for moves within a step

  /// The axis whose rows follow the particles, or -1.
  static int axis_of(const Grid &grid)
  {
    for (int d = 0; d < grid.dim; ++d)
      if (grid.has(Boundary::open, d) && grid.has(Boundary::noslip, d)) return d;
    return -1;
  }

  /// whole: the grid of the whole box, or of a part of it
  ActiveRows(const Grid &whole, const Comm &comm) :
      whole_(whole), comm_(comm), axis_(axis_of(whole)), rows_(whole.n[axis_])
  {}

  /// Collective.  True if the grid for particles at x (3 n), which must be in the box, is not that
  /// of the last call.
  template <class Execution> bool follow(const Execution &execution, const double *x, long n)
  {
    const long before = made_ ? rows_ : 0;
    const auto enough = [&](long rows) {
      const long above = execution.first("bdh::active_rows", n, BeyondWalls{limits(rows), x});
      return !any_rank(comm_, above >= 0);
    };
    while (rows_ < most() && !enough(rows_)) rows_ = more_rows();
    while (fewer_rows() > 0 && enough(fewer_rows())) rows_ = fewer_rows();
    made_ = true;
    return rows_ != before;
  }
  /// Makes room for a step whose moves are longer than `spare`.
  void grow() { rows_ = std::min(most(), rows_ + std::max(quantum, rows_ / quantum * quantum)); }

  Grid grid() const { return lowest_rows(whole_, axis_, rows_); }

 private:
  long most() const
  {
    const auto &left_out = whole_.left_out[axis_];
    return whole_.n[axis_] + std::lround((left_out[0] + left_out[1]) / whole_.h(axis_));
  }
  long more_rows() const { return std::min(most(), (rows_ / quantum + 1) * quantum); }
  /// The next smaller number, or 0.
  long fewer_rows() const { return (rows_ - 1) / quantum * quantum; }

  /// Where particles may be at the beginning of a step on so many rows.
  WallLimits limits(long rows) const
  {
    const Grid g = lowest_rows(whole_, axis_, rows);
    WallLimits w = fit_limits(g);
    const double less = spare * g.h(axis_);
    w.walled[axis_] = true;
    // The whole grid is enough for all particles in the box.
    if (rows >= most()) return wall_limits(whole_);
    w.lo[axis_] += less;
    w.hi[axis_] -= less;
    return w;
  }

  Grid whole_;
  Comm comm_;
  int axis_;
  long rows_;
  bool made_ = false;
};

}    // namespace bdh
#endif
