// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Particles sorted for walks through a grid, and the grid's lines: what every spreading needs.
#ifndef BDH_GRID_SORTED_PARTICLES_H
#define BDH_GRID_SORTED_PARTICLES_H

#include "base/aligned.h"
#include "base/ssize.h"
#include "base/workers.h"
#include "grid/grid.h"
#include "grid/lines_kernel.h"
#include "grid/position_kernel.h"

#include <vector>

namespace bdh {

/// An axis of a grid in the form that pointwise formulas take.
AxisLines axis_lines(const Grid &grid, int axis);
/// Where the walls of a grid let its particles be.
WallLimits wall_limits(const Grid &grid);
/// Where particles of a grid may be: up to `slack` spacings beyond walls, and up to half a spacing
/// of these beyond open faces.
WallLimits box_limits(const Grid &grid, double slack = 0.0);
/// Where kernels fit into a grid that leaves out a part of the box; no limits elsewhere.
WallLimits fit_limits(const Grid &grid);
/// What check_positions() refuses.
HasNoCell positions_without_cell(const Grid &grid, const double *x, double slack);

/// Throws BadParticle for the first position (of 3 n) that is not finite, too far away to have a
/// cell, or outside box_limits(grid, slack), with `slack` at most 1: what a finite difference
/// needs.
void check_positions(const Grid &grid, const double *x, long n, double slack = 0.0);

/// The lines of an axis: those through the faces that are normal to it, or those through the cell
/// centres, half a spacing further.
enum class LineSet { centres, faces };

/// Where the grid lines of each axis begin in this rank's arrays, also for lines that are periodic
/// or mirror images.
class GridLines {
 public:
  GridLines(const Grid &grid, const Slab &slab);
  /// Offsets of line i and of those after it.  An offset is -1 if the line is not in this slab.  A
  /// line beyond a wall has the offset of the line that it is the mirror image of.  Face n, a wall,
  /// is not stored and has the offset of face 0.
  const long *at(int axis, long i, LineSet set = LineSet::centres) const
  {
    return offset_[static_cast<int>(set)][axis].data() + i + margin;
  }
  long columns() const { return columns_; }
  /// Elements from one row to the next, and from one plane to the next.  In 2D a plane of the slow
  /// axis is one row.
  long row() const { return row_; }
  long plane() const { return plane_; }

  /// Number of lines beyond either end of an axis: as many as the widest kernel, shifted by half a
  /// spacing, may touch.
  static constexpr long margin = 16;

 private:
  std::vector<long> offset_[2][3];
  long columns_, row_, plane_;
};

/// Particles sorted into tiles of rows, plane after plane, so that a loop over them walks through
/// the grid once with the planes under the kernel in the second-level cache.
class GridParticles {
 public:
  /// `width` is the number of lines under a kernel, `element_bytes` the size of a number of the
  /// field.
  GridParticles(const Grid &grid, const Slab &slab, int width, int element_bytes,
                const Workers &workers);

  /// Copies and sorts the positions x (3 n), which may be anywhere in space along a periodic axis.
  /// Requires check_positions().
  void bind(const double *x, long n);
  long size() const { return ssize(original_); }
  /// Coordinates along axis d in sorted order, in units of the spacing from the lower corner,
  /// within the box.  At least `read_whole` numbers follow the last one, so that batches may be
  /// read whole.
  const double *x(int d) const { return x_[d].data(); }
  /// Place in the caller's arrays of particle p of the sorted order.
  long original(long p) const { return original_[p]; }
  const GridLines &lines() const { return lines_; }
  const Workers &workers() const { return workers_; }

  /// The number of layers into which the slow axis is cut.  They are at least as thick as the
  /// kernel is wide.  If there are several, their number is even, so that particles of every other
  /// layer touch no plane in common, around the periodic axis too.  From four on it is a multiple
  /// of four, so that two workers, who take every other layer at a time, get equal shares.  It does
  /// not depend on the number of workers, so that sums are the same for any number from two on.
  long layers() const { return layers_; }
  long tiles() const { return tiles_; }
  /// The particles of a layer in one tile, as the first place in the sorted order and the one after
  /// the last.
  std::array<long, 2> range(long layer, long tile) const;

  const Grid &grid() const { return grid_; }
  std::size_t memory() const;

  static constexpr long read_whole = 16;

  /// Reads the rows ahead of the particles in the order of memory.  The particles of a row lie at
  /// random, and cache lines that are fetched in random order arrive at a quarter of the rate (5
  /// instead of 22 GB/s on an EPYC, with or without prefetch instructions).  They arrive even more
  /// slowly when a vector lies across two of them.
  template <class Real> class ReadAhead {
   public:
    /// component: arrays of the field; they must outlive this.
    ReadAhead(const GridParticles &particles, Real *const *component, int components);
    /// Reads up to the last plane that particle p, in sorted order, may touch.
    void until(long p);

   private:
    void read(long plane, long begin, long end) const;

    const GridParticles &particles_;
    Real *const *component_;
    int components_;
    bool worthwhile_;
    long tile_ = -1, next_plane_ = 0;
  };

 private:
  void scale(const double *x, long n);
  void count_keys(long n);

  const Workers &workers_;
  Grid grid_;
  Slab slab_;
  int width_;
  GridLines lines_;
  long tile_rows_, tiles_, layers_;
  AlignedVector scaled_[3];    // as x_, but in the caller's order
  AlignedVector x_[3];
  std::vector<int> original_;
  std::vector<int> key_, bin_;    // work space of the sort
};

}    // namespace bdh
#endif
