// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// The hand-over within planes that several ranks share: each gives parts of its rows for all rows
/// of its own part.
#ifndef BDH_GRID_ROW_TRANSPOSITION_H
#define BDH_GRID_ROW_TRANSPOSITION_H

#include "base/aligned.h"
#include "grid/parts.h"

namespace bdh {

/// Moves one array at a time, in place: elements keep their places in whole planes, of which a rank
/// has its rows before the hand-over and its columns after it.
///
/// Element: std::complex<float> or std::complex<double>.
template <class Element> class RowTransposition {
 public:
  /// The planes have rows of `row` elements, whose first `width` ones are dealt in equal_part()s.
  /// parts: pencils.
  RowTransposition(const GridParts &parts, long row, long width);

  /// This rank's elements of a row after the hand-over.
  const Slab &columns() const { return columns_; }

  /// Collective.  From rows of this rank to columns of all rows.
  void hand_over(Element *array);
  /// Collective.  Undoes hand_over(), for the elements that are dealt.
  void hand_back(Element *array);
  std::size_t memory() const;

 private:
  /// Places that one rank sends to another, which has elements of each of the rows.
  struct Parcel {
    Slab rows, columns;
  };
  MessageSizes sizes(const std::vector<Parcel> &parcels) const;
  template <class Action>
  void for_places(const std::vector<Parcel> &parcels, const Action &action) const;
  void move(Element *array, const std::vector<Parcel> &from, const std::vector<Parcel> &to);

  Comm comm_;
  long planes_, all_rows_, row_;
  Slab columns_;
  std::vector<Parcel> before_, after_;    // by rank: of this rank's rows, and of its columns
  AlignedArray<Element> out_, in_;        // sorted by the rank that gets or sends it
};

}    // namespace bdh
#endif
