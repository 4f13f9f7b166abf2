// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// The transforms of a field within the planes of the slow axis.
#ifndef BDH_GRID_PLANE_TRANSFORMS_H
#define BDH_GRID_PLANE_TRANSFORMS_H

#include "base/aligned.h"
#include "grid/fftw.h"
#include "grid/transposition.h"

#include <algorithm>

namespace bdh {

/// Real transforms along x and, in 3D, complex ones along y, in place in padded rows.
template <class Real> class PlaneTransforms {
 public:
  /// `width` modes of a row are transformed along y; grid.half() means all of them.  `pruned`
  /// chooses plans that can transform a part of them; the other plans take whole planes at once.
  PlaneTransforms(const Grid &grid, FftEffort effort, bool pruned, long width) :
      n_y_(grid.n[1]), half_(grid.half()), width_(width), pruned_(pruned)
  {
    const long modes = grid.dim == 3 ? half_ * n_y_ : half_;
    AlignedArray<Real> scratch(2 * modes);
    const int n[2] = {int(n_y_), int(grid.n[0])};
    // FFTW's vector code requires an alignment of 16 bytes, which planes of complex floats may
    // miss.
    const bool aligned = modes * 2 * sizeof(Real) % 16 == 0;
    const unsigned unaligned = aligned ? 0u : FFTW_UNALIGNED;
    const unsigned how = planner_flag(effort, grid.n[0] * n_y_ <= patient_points) | unaligned;
    if (pruned) {
      planes_ = real_plans(1, n + 1, n_y_, half_, scratch.data(), how);
      across_ = strided_plans(n_y_, width, half_, scratch.data(),
                              planner_flag(effort, n_y_ <= patient_length) | unaligned);
    } else {
      planes_ = real_plans(grid.dim - 1, grid.dim == 3 ? n : n + 1, 1, modes, scratch.data(), how);
    }
  }

  void forward(Real *plane) const
  {
    Fftw<Real>::execute_r2c(planes_.forward.get(), plane, as_fftw_complex(plane));
    if (pruned_) across(plane, across_.forward);
  }

  /// `kept` has parts of the plane in the order of rows, from x = 0.  All other modes are set to
  /// zero here, where the plane is needed in the cache anyway.
  void backward(Real *plane, const PartsOfRanks &kept) const
  {
    if (pruned_) {
      clear_all_but(kept, plane);
      across(plane, across_.backward);
      for (long y = 0; y < n_y_; ++y) clear(plane, y, width_, half_);
    }
    Fftw<Real>::execute_c2r(planes_.backward.get(), as_fftw_complex(plane), plane);
  }

 private:
  void across(Real *plane, const FftwPlan<Real> &plan) const
  {
    Fftw<Real>::execute(plan.get(), as_fftw_complex(plane), as_fftw_complex(plane));
  }

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
  FftwPlanPair<Real> planes_;    // of a whole plane, or if pruned of its rows
  FftwPlanPair<Real> across_;    // along y, only if pruned
};

}    // namespace bdh
#endif
