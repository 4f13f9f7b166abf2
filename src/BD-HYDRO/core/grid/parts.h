// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// The part of a grid that each rank has: a slab of planes or, with more ranks, a pencil along x.
#ifndef BDH_GRID_PARTS_H
#define BDH_GRID_PARTS_H

#include "base/comm.h"
#include "base/ssize.h"
#include "grid/grid.h"

#include <vector>

namespace bdh {

/// A rank's part of n.  The parts are consecutive and equal, but the last ones are smaller or
/// empty.
Slab equal_part(long n, int rank, int ranks);

/// Ranks that should share each slab, so that a solve on the busiest one takes least time: 1 for
/// slabs, and in 2D always.  A model of transforms and messages decides (parts.cpp).
int best_share(const Grid &grid, int ranks);

/// Planes of the slow axis are dealt to groups of `share` ranks, and within a group the rows along
/// y: with several, a rank's part is a pencil along x.  Groups are of consecutive ranks.  Ranks
/// that are left over have no part.
class GridParts {
 public:
  /// The setting of `share` that takes best_share().
  static constexpr int automatic = 0;
  /// Rows on either side of a rank's own ones that its particles may touch: as many as the widest
  /// kernel has.
  static constexpr long margin = 16;

  /// Collective.  Throws InvalidOption, as of keyword pencils, where so many ranks cannot share a
  /// slab.
  GridParts(const Grid &grid, const Comm &comm, int share);

  const Comm &comm() const { return comm_; }
  /// Ranks that have the same planes; only for pencils.
  const Comm &same_planes() const { return same_planes_; }
  /// Ranks that have the same rows.  All, if these are slabs.
  const Comm &same_rows() const { return same_rows_; }
  bool pencils() const { return share_ > 1; }
  int share() const { return share_; }
  int groups() const { return groups_; }
  /// Number of this rank in its group, from 0; that of ranks without a part is 0.
  int place() const { return place_; }
  long all_rows() const { return all_rows_; }
  /// This rank's planes of the slow axis and, in 3D, rows along y.
  const Slab &planes() const { return planes_; }
  const Slab &rows() const { return rows_; }
  /// The ranks that have any of the `reach` planes from `plane` on, and of the `reach` rows from
  /// `row` on: both around their periodic axis.  `row` is arbitrary for slabs.
  template <class Action>
  void for_ranks(long plane, long row, long reach, const Action &action) const
  {
    group_of_plane_.for_parts(plane, reach, [&](int group) {
      if (!pencils()) return action(group);
      place_of_row_.for_parts(row, reach, [&](int place) { action(group * share_ + place); });
    });
  }

  /// Sets to zero what spreading to a component of a field in the layout of VectorFft may touch.
  template <class Real> void clear(Real *component) const { clear_rows(component, true); }
  /// Sets to zero what interpolation may read in rows of other ranks.
  template <class Real> void clear_others(Real *component) const { clear_rows(component, false); }

 private:
  /// The part of a periodic axis that has each of its n lines.  A table, since divisions for every
  /// particle would take as long as interpolation.
  class PartOfLine {
   public:
    PartOfLine(long n, int parts);
    /// Calls action(part) for the parts that have any of the `reach` lines from `first` on, each
    /// once.
    template <class Action> void for_parts(long first, long reach, const Action &action) const
    {
      const long n = bdh::ssize(part_),
                 begin = first >= 0 && first < n ? first : (first % n + n) % n;
      int part = part_[begin];
      const int first_part = part;
      long at = begin;
      for (long left = reach < n ? reach : n; left > 0;) {
        action(part);
        const long next = n < (part + 1) * size_ ? n : (part + 1) * size_;
        left -= next - at;
        at = next < n ? next : 0;
        part = part_[at];
        if (part == first_part) return;
      }
    }

   private:
    long size_;    // lines of each part but the last ones
    std::vector<int> part_;
  };
  template <class Real> void clear_rows(Real *component, bool own) const;

  Comm comm_;
  int share_, groups_, place_;
  Comm same_planes_, same_rows_;
  long all_planes_, all_rows_, row_size_;
  PartOfLine group_of_plane_, place_of_row_;
  Slab planes_, rows_;
};

}    // namespace bdh
#endif
