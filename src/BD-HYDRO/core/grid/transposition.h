// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// The hand-over of a grid between ranks that have different planes: each gives parts of its planes
/// for all planes of its own part.
#ifndef BDH_GRID_TRANSPOSITION_H
#define BDH_GRID_TRANSPOSITION_H

#include "base/aligned.h"
#include "base/comm.h"
#include "grid/grid.h"

#include <vector>

namespace bdh {

/// Consecutive elements of every plane that one rank gets.
struct PlanePart {
  long before, count;
  long after = 0;    ///< place in a plane of the rank's own parts; set by Transposition
};

/// The parts that each rank gets; the same on all ranks.
using PartsOfRanks = std::vector<std::vector<PlanePart>>;

/// Moves one array at a time, in place.
///
/// Before the hand-over an array is [planes of this rank's slab][elements of a plane], after it
/// [all planes][parts of this rank, `pitch` elements].  On one rank nothing moves, and parts stay
/// where they were.  FFTW's own transposition would rearrange within a rank as well; here the slow
/// axis may keep its stride, so there is no need for that.
///
/// Element: double, std::complex<float> or std::complex<double>.
template <class Element> class Transposition {
 public:
  /// comm: the ranks of one hand-over, of which the first ones have planes of `size` elements, in
  /// equal_part()s of `planes` for `holders` ranks.
  Transposition(const Comm &comm, int holders, long planes, long size, PartsOfRanks parts);
  /// Deals the elements in other parts.
  void deal(PartsOfRanks parts);

  const Slab &slab() const { return slab_; }
  long planes() const { return planes_; }
  long plane_size() const { return size_; }
  const PartsOfRanks &parts() const { return parts_; }
  const std::vector<PlanePart> &own_parts() const { return parts_[comm_.rank()]; }
  /// Elements from plane to plane after the hand-over.
  long pitch() const { return pitch_; }

  /// Collective.  From planes of this rank's slab to parts of all planes.
  void hand_over(Element *array);
  /// Collective.  Undoes hand_over().  Elements in no part keep their values.
  void hand_back(Element *array);
  std::size_t memory() const;

 private:
  template <class Action> void for_parcel(Action action) const;

  Comm comm_;
  int holders_;
  long planes_, size_, pitch_;
  Slab slab_;
  PartsOfRanks parts_;
  AlignedArray<Element> parcel_;               // an array sorted by the rank that gets it
  MessageSizes parcel_sizes_, array_sizes_;    // array: after the hand-over
};

}    // namespace bdh
#endif
