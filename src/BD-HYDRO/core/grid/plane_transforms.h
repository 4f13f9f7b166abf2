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
  /// `width` modes of a row are transformed along y; pruned: fewer than these may be kept.
  /// workers: how many call forward() and backward() at the same time.
  PlaneTransforms(const Grid &grid, FftEffort effort, bool pruned, long width, int workers) :
      n_y_(grid.n[1]), half_(grid.half()), width_(width), pruned_(pruned)
  {
    const bool flat = grid.dim == 2;
    const long modes = flat ? half_ : half_ * n_y_;
    AlignedArray<Real> scratch(2 * (modes + 1));
    if (!flat) {
      const LinesAt<Real> plane{scratch.data(), half_, modes % 2 != 0};
      across_ = {int(n_y_), width, plane, plane, planner_flag(effort, n_y_ <= patient_length)};
    }
    if (!flat && grid.n[0] >= RowTransforms<Real>::least) {
      rows_.emplace(grid.n[0], n_y_, effort, workers);
      return;
    }
    const int n_x = grid.n[0];
    plain_rows_ =
        real_plans(1, &n_x, flat ? 1 : n_y_, half_, scratch.data(),
                   planner_flag(effort, n_x <= patient_length) | (modes % 2 ? FFTW_UNALIGNED : 0));
  }

  void forward(Real *plane, int worker)
  {
    if (rows_)
      rows_->forward(plane, worker);
    else
      Fftw<Real>::execute_r2c(plain_rows_.forward.get(), plane, as_fftw_complex(plane));
    across_.forward(plane, plane);
  }

  /// `kept` has parts of the plane in the order of rows, from x = 0.  All other modes are set to
  /// zero here, where the plane is needed in the cache anyway.
  void backward(Real *plane, const PartsOfRanks &kept, int worker)
  {
    if (pruned_) clear_all_but(kept, plane);
    across_.backward(plane, plane);
    if (pruned_)
      for (long y = 0; y < n_y_; ++y) clear(plane, y, width_, half_);
    if (rows_)
      rows_->backward(plane, worker);
    else
      Fftw<Real>::execute_c2r(plain_rows_.backward.get(), as_fftw_complex(plane), plane);
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
    long y = 0;
    for (const auto &parts : kept)
      for (const PlanePart &part : parts) {
        for (; y < part.before / half_; ++y) clear(plane, y, 0, width_);
        clear(plane, y++, part.count, width_);
      }
    for (; y < n_y_; ++y) clear(plane, y, 0, width_);
  }

  long n_y_, half_, width_;
  bool pruned_;
  std::optional<RowTransforms<Real>> rows_;
  FftwPlanPair<Real> plain_rows_;    // without rows_
  LineTransforms<Real> across_;      // along y, in 3D
};

}    // namespace bdh
#endif
