// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// The transforms of a field along the slow axis, in blocks of columns that stay in the cache.
#ifndef BDH_GRID_SLOW_AXIS_H
#define BDH_GRID_SLOW_AXIS_H

#include "base/aligned.h"
#include "base/bytes_of.h"
#include "base/workers.h"
#include "grid/line_transforms.h"

#include <algorithm>
#include <type_traits>
#include <vector>

namespace bdh {

/// What the blocks are cut from.
struct Columns {
  long longest;    ///< most columns of one part
  long pitch;      ///< complex numbers from plane to plane
  bool pruned;     ///< kept columns only
  bool fixed;      ///< pitch never changes
  int components;
};

/// Transforms from the field to a block and back: by FFTW's plans between both, or through tiles.
/// For these, rows are copied to the block, and from there a few columns at a time to the tile.
/// With kept columns of a long axis that takes as little as two thirds of the time of FFTW's plans
/// on the field (180^3), whose radix passes jump from page to page.  See is_direct().
template <class Real> class SlowAxis {
 public:
  // Kept columns are rounded up to a multiple of this: a vector register of complex floats, two of
  // complex doubles.  The slow axis is transformed for as many columns at once, in a tile that fits
  // into the first-level cache.  One plan then serves blocks of any width.
  static constexpr long batch = 4;
  static long whole_batches(long columns) { return (columns + batch - 1) / batch * batch; }

  /// `field_size` is the number of reals in a component's array.
  SlowAxis(const Grid &grid, FftEffort effort, const Columns &columns, std::size_t field_size,
           const Workers &workers) :
      n_(grid.n[grid.slow_axis()]),
      walled_(grid.walled(grid.slow_axis())), direct_(is_direct(n_, columns) && !walled_),
      chunk_(choose_chunk(columns.longest, 2 * sizeof(Real) * columns.components * n_)),
      scratch_(workers.count())
  {
    for (Scratch &s : scratch_) s.block.resize(columns.components * block_size(chunk_));
    const unsigned how = planner_flag(effort, n_ <= patient_length);
    if (direct_) make_plans(columns, field_size, how);
    if (direct_ || walled_) return;    // columns between walls are only copied
    for (Scratch &s : scratch_) s.tile.assign(2 * batch * n_, Real(0));
    tiles_ = strided_plans(n_, batch, batch, scratch_[0].tile.data(), how);
  }

  /// Columns per block, except in the last one of a part.
  long chunk() const { return chunk_; }
  /// Room for the modes of one block: the components follow each other at block_size(columns).
  Real *block(int worker) { return scratch_[worker].block.data(); }
  /// Reals of a component, so that the next one begins on a cache line.
  long block_size(long columns) const
  {
    constexpr long line = 64 / sizeof(Real);
    return (2 * columns * n_ + line - 1) / line * line;
  }

  /// modes [n][columns] := transforms of columns of the field, which has `pitch` complex numbers
  /// from plane to plane.  Between walls they are only copied.
  void forward(Real *field, long pitch, Real *modes, long columns, int worker)
  {
    if (direct_) return plans_[columns].forward(field, modes);
    for (long s = 0; s < n_; ++s)
      std::copy_n(field + 2 * s * pitch, 2 * columns, modes + 2 * s * columns);
    transform(modes, columns, tiles_.forward, scratch_[worker].tile);
  }

  /// Transforms back into the field.  The modes are overwritten.
  void backward(Real *modes, Real *field, long pitch, long columns, int worker)
  {
    if (direct_) return plans_[columns].backward(modes, field);
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
  // Kept columns of axes up to this length have a plan for each number of columns; those of longer
  // ones would take too long to make.
  static constexpr long direct_length = 64;

  struct Scratch {
    AlignedArray<Real> block, tile;
  };

  /// Whether FFTW's plans go between field and block, which is 15 % faster for all modes at 96^3.
  static bool is_direct(long n, const Columns &columns)
  {
    return !columns.pruned || (columns.fixed && n <= direct_length);
  }

  /// Plans for all numbers of columns that a block may have.
  void make_plans(const Columns &columns, std::size_t field_size, unsigned how)
  {
    AlignedArray<Real> field(columns.longest ? field_size + 2 : 0);
    const LinesAt<Real> outside{field.data(), columns.pitch, true};
    const long most = std::min(chunk_, columns.longest), rest = columns.longest % chunk_;
    plans_.resize(most + 1);
    for (long many = 1; many <= most; ++many) {
      if (many != most && many != rest && !(columns.pruned && many % batch == 0)) continue;
      const LinesAt<Real> inside{scratch_[0].block.data(), many};
      plans_[many] = LineTransforms<Real>(n_, many, outside, inside, how);
    }
  }

  /// Columns per block, so that a part with `longest` columns, each of which takes `bytes`, is cut
  /// into equal blocks.
  long choose_chunk(long longest, long bytes) const
  {
    long chunk = std::max(1L, std::min(longest, block_bytes / bytes));
    const long blocks = std::max(1L, (longest + chunk - 1) / chunk);
    chunk = std::max(1L, (longest + blocks - 1) / blocks);
    return chunk < longest ? whole_batches(chunk) : chunk;
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
  bool direct_;    // FFTW's plans go between field and block
  long chunk_;
  std::vector<LineTransforms<Real>> plans_;    // if direct, by the columns of a block
  FftwPlanPair<Real> tiles_;                   // otherwise of a tile [n][batch]
  std::vector<Scratch> scratch_;               // one for each worker
};

}    // namespace bdh
#endif
