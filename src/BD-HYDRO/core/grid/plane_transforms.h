// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// The transforms of a field within the planes of the slow axis.
#ifndef BDH_GRID_PLANE_TRANSFORMS_H
#define BDH_GRID_PLANE_TRANSFORMS_H

#include "base/aligned.h"
#include "grid/fftw.h"
#include "grid/line_transforms.h"
#include "grid/row_transforms.h"
#include "grid/transposition.h"

#include <algorithm>
#include <optional>

namespace bdh {

/// Real transforms along x and, in 3D, complex ones along y, in place in padded rows.
template <class Real> class PlaneTransforms {
 public:
  /// Of `rows` this rank transforms the modes along x.  Of these the first `width` ones may be kept
  /// if it is pruned, otherwise all.  Those of `columns` are transformed along y here.  workers:
  /// how many call the functions below at the same time.
  PlaneTransforms(const Grid &grid, FftEffort effort, bool pruned, long width, const Slab &rows,
                  const Slab &columns, int workers) :
      n_y_(grid.n[1]),
      half_(grid.half()), width_(width), pruned_(pruned), own_rows_(rows), columns_(columns)
  {
    const bool flat = grid.dim == 2;
    // Rows, and planes, may begin at a complex number of any place.
    const long start = half_ * (flat || rows.count < n_y_ ? 1 : n_y_);
    const bool any_start = 2 * sizeof(Real) * start % 16 != 0;
    AlignedArray<Real> scratch(2 * ((flat ? half_ : half_ * n_y_) + 1));
    if (!flat) {
      const LinesAt<Real> plane{scratch.data(), half_, any_start || columns.start % 2 != 0};
      across_ = {int(n_y_), columns.count, plane, plane,
                 planner_flag(effort, n_y_ <= patient_length_in_planes)};
    }
    if (rows.count == 0) return;
    if (!flat && RowTransforms<Real>::pay(grid.n[0])) {
      rows_.emplace(grid.n[0], rows.count, effort, workers);
      return;
    }
    const int n_x = grid.n[0];
    plain_rows_ = real_plans(1, &n_x, rows.count, half_, scratch.data(),
                             planner_flag(effort, n_x <= patient_length_in_planes) |
                                 (any_start ? FFTW_UNALIGNED : 0));
  }

  /// Real rows to modes along x.
  void rows_forward(Real *plane, int worker)
  {
    Real *const first = plane + 2 * half_ * own_rows_.start;
    if (rows_)
      rows_->forward(first, worker);
    else if (plain_rows_.forward)
      Fftw<Real>::execute_r2c(plain_rows_.forward.get(), first, as_fftw_complex(first));
  }
  void rows_backward(Real *plane, int worker)
  {
    if (pruned_)
      for (long y = 0; y < own_rows_.count; ++y) clear(plane, own_rows_.start + y, width_, half_);
    Real *const first = plane + 2 * half_ * own_rows_.start;
    if (rows_)
      rows_->backward(first, worker);
    else if (plain_rows_.backward)
      Fftw<Real>::execute_c2r(plain_rows_.backward.get(), as_fftw_complex(first), first);
  }
  void columns_forward(Real *plane)
  {
    across_.forward(plane + 2 * columns_.start, plane + 2 * columns_.start);
  }
  /// `kept` has parts of the plane in the order of rows, from the first column.  All other modes
  /// are set to zero here, where the plane is needed in the cache anyway.
  void columns_backward(Real *plane, const PartsOfRanks &kept)
  {
    if (pruned_) clear_all_but(kept, plane);
    across_.backward(plane + 2 * columns_.start, plane + 2 * columns_.start);
  }

  std::size_t memory() const { return rows_ ? rows_->memory() : 0; }

 private:
  /// Sets modes first .. last - 1 of row y to zero.
  void clear(Real *plane, long y, long first, long last) const
  {
    std::fill_n(plane + 2 * (y * half_ + first), 2 * (last - first), Real(0));
  }

  void clear_all_but(const PartsOfRanks &kept, Real *plane) const
  {
    const long first = columns_.start, end = first + columns_.count;
    long y = 0;
    for (const auto &parts : kept)
      for (const PlanePart &part : parts) {
        for (; y < part.before / half_; ++y) clear(plane, y, first, end);
        clear(plane, y++, first + part.count, end);
      }
    for (; y < n_y_; ++y) clear(plane, y, first, end);
  }

  long n_y_, half_, width_;
  bool pruned_;
  Slab own_rows_, columns_;
  std::optional<RowTransforms<Real>> rows_;
  FftwPlanPair<Real> plain_rows_;    // without rows_
  LineTransforms<Real> across_;      // along y, in 3D
};

}    // namespace bdh
#endif
