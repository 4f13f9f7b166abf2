// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// The transforms of a field along the slow axis, in blocks of columns that stay in the cache.
#ifndef BDH_GRID_SLOW_AXIS_H
#define BDH_GRID_SLOW_AXIS_H

#include "base/aligned.h"
#include "base/bytes_of.h"
#include "base/workers.h"
#include "grid/fftw.h"

#include <algorithm>
#include <type_traits>
#include <vector>

namespace bdh {

/// What the blocks are cut from.
struct Columns {
  long longest;    ///< most columns of one part
  long pitch;      ///< complex numbers from plane to plane
  bool pruned;     ///< kept columns only, and pitch may change
  int components;
};

/// Transforms from the field to a block and back.  The slow axis goes through tiles: rows are
/// copied to the block, and from there a few columns at a time to the tile.  With kept columns that
/// takes as little as two thirds of the time of FFTW's plans on the field (180^3), whose radix
/// passes jump from page to page.  For some fields FFTW's plans between field and block are faster:
/// see direct_.
template <class Real> class SlowAxis {
 public:
  // Kept columns are rounded up to a multiple of this: a vector register of complex floats, two of
  // complex doubles.  The slow axis is transformed for as many columns at once, in a tile that fits
  // into the first-level cache.  One plan then serves blocks of any width, so it can be a patient
  // one.
  static constexpr long batch = 4;
  static long whole_batches(long columns) { return (columns + batch - 1) / batch * batch; }

  /// `field_size` is the number of reals in a component's array.
  SlowAxis(const Grid &grid, FftEffort effort, const Columns &columns, std::size_t field_size,
           const Workers &workers) :
      n_(grid.n[grid.slow_axis()]),
      walled_(grid.walled(grid.slow_axis())),
      direct_(!columns.pruned && sizeof(Real) == sizeof(double) && !walled_),
      chunk_(choose_chunk(columns.longest, 2 * sizeof(Real) * columns.components * n_)),
      scratch_(workers.count())
  {
    for (Scratch &s : scratch_) s.block.resize(2 * columns.components * chunk_ * n_);
    if (direct_) {
      const unsigned how = planner_flag(effort, grid.n[0] * grid.n[1] <= patient_points);
      AlignedArray<Real> field(columns.longest ? field_size : 0);
      Real *const block = scratch_[0].block.data();
      const auto plans = [&](long many) {
        return block_plans(n_, many, columns.pitch, field.data(), block, how);
      };
      full_ = plans(std::min(chunk_, columns.longest));
      rest_ = plans(columns.longest % chunk_);
      return;
    }
    if (walled_) return;    // its columns are only copied
    for (Scratch &s : scratch_) s.tile.assign(2 * batch * n_, Real(0));
    tiles_ = strided_plans(n_, batch, batch, scratch_[0].tile.data(),
                           planner_flag(effort, n_ <= patient_length));
  }

  /// Columns per block, except in the last one of a part.
  long chunk() const { return chunk_; }
  /// Room for the modes of one block, all components.
  Real *block(int worker) { return scratch_[worker].block.data(); }

  /// modes [n][columns] := transforms of columns of the field, which has `pitch` complex numbers
  /// from plane to plane.  Between walls they are only copied.
  void forward(Real *field, long pitch, Real *modes, long columns, int worker)
  {
    if (direct_) return execute(plans_of(columns).forward, field, modes);
    for (long s = 0; s < n_; ++s)
      std::copy_n(field + 2 * s * pitch, 2 * columns, modes + 2 * s * columns);
    transform(modes, columns, tiles_.forward, scratch_[worker].tile);
  }

  /// Transforms back into the field.  The modes are overwritten.
  void backward(Real *modes, Real *field, long pitch, long columns, int worker)
  {
    if (direct_) return execute(plans_of(columns).backward, modes, field);
    transform(modes, columns, tiles_.backward, scratch_[worker].tile);
    for (long s = 0; s < n_; ++s)
      std::copy_n(modes + 2 * s * columns, 2 * columns, field + 2 * s * pitch);
  }

  std::size_t memory() const
  {
    std::size_t bytes = 0;
    for (const Scratch &s : scratch_) bytes += bytes_of(s.block, s.tile);
    return bytes;
  }

 private:
  // Most bytes of a block with all components.  Larger ones fall out of a 1 MiB second-level cache.
  static constexpr long block_bytes = 1 << 19;

  struct Scratch {
    AlignedArray<Real> block, tile;
  };

  /// Columns per block, so that a part with `longest` columns, each of which takes `bytes`, is cut
  /// into equal blocks.
  long choose_chunk(long longest, long bytes) const
  {
    long chunk = std::max(1L, std::min(longest, block_bytes / bytes));
    const long blocks = std::max(1L, (longest + chunk - 1) / chunk);
    chunk = std::max(1L, (longest + blocks - 1) / blocks);
    return chunk < longest && !direct_ ? whole_batches(chunk) : chunk;
  }

  const FftwPlanPair<Real> &plans_of(long columns) const
  {
    return columns == chunk_ ? full_ : rest_;
  }

  static void execute(const FftwPlan<Real> &plan, Real *from, Real *to)
  {
    Fftw<Real>::execute(plan.get(), as_fftw_complex(from), as_fftw_complex(to));
  }

  /// Transforms in place, `batch` columns at a time.  The last tile may be filled up with zeros.
  void transform(Real *modes, long columns, const FftwPlan<Real> &plan, AlignedArray<Real> &tile)
  {
    if (walled_) return;
    const long row = 2 * columns, step = 2 * batch;
    Real *const t = tile.data();
    const auto through_tile = [&](Real *f, auto width) {
      const long count = width;
      for (long s = 0; s < n_; ++s) std::copy_n(f + s * row, count, t + s * step);
      execute(plan, t, t);
      for (long s = 0; s < n_; ++s) std::copy_n(t + s * step, count, f + s * row);
    };
    long first = 0;
    for (; first + step <= row; first += step)
      // With a constant width the compiler copies by vector moves instead of calls.
      through_tile(modes + first, std::integral_constant<long, step>{});
    if (first == row) return;
    // Old numbers in the rest of the tile would grow with every transform, to infinity.
    std::fill(tile.begin(), tile.end(), Real(0));
    through_tile(modes + first, row - first);
  }

  long n_;
  bool walled_;
  // If true, FFTW's plans go between field and block, which is 15 % faster for all modes at 96^3.
  // It is false in float, where rows of the field may miss the alignment of 16 bytes that FFTW
  // requires.
  bool direct_;
  long chunk_;
  FftwPlanPair<Real> full_, rest_;    // if direct, of a whole block and of the last one of a part
  FftwPlanPair<Real> tiles_;          // otherwise of a tile [n][batch]
  std::vector<Scratch> scratch_;      // one for each worker
};

}    // namespace bdh
#endif
