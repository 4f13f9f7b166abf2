// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
#include "grid/transposition.h"

#include "base/bytes_of.h"
#include "base/phases.h"
#include "grid/parts.h"

#include <algorithm>
#include <complex>

namespace bdh {

namespace {

long total(const std::vector<PlanePart> &parts)
{
  long sum = 0;
  for (const PlanePart &part : parts) sum += part.count;
  return sum;
}

}    // namespace

template <class Element>
Transposition<Element>::Transposition(const Comm &comm, int holders, long planes, long size,
                                      PartsOfRanks parts) :
    comm_(comm),
    holders_(holders), planes_(planes), size_(size),
    slab_(equal_part(planes, comm.rank(), holders)), parcel_sizes_({}, 1), array_sizes_({}, 1)
{
  deal(std::move(parts));
}

template <class Element> void Transposition<Element>::deal(PartsOfRanks parts)
{
  parts_ = std::move(parts);
  const bool alone = comm_.size() == 1;
  pitch_ = alone ? size_ : total(own_parts());
  std::vector<int> elements, planes;    // of a plane, and of the array, that each rank gets or has
  for (int r = 0; r < comm_.size(); ++r) {
    long after = 0;
    for (PlanePart &part : parts_[r]) {
      part.after = alone ? part.before : after;
      after += part.count;
    }
    elements.push_back(after);
    planes.push_back(equal_part(planes_, r, holders_).count);
  }
  parcel_sizes_ = MessageSizes(elements, slab_.count);
  if (!alone) parcel_.resize(parcel_sizes_.total());
  array_sizes_ = MessageSizes(planes, pitch_);
}

/// Calls action(place in an array, number of elements) for everything in the parcel, in its order:
/// by rank, plane and part.
template <class Element> template <class Action>
void Transposition<Element>::for_parcel(Action action) const
{
  for (const std::vector<PlanePart> &theirs : parts_)
    for (long p = 0; p < slab_.count; ++p)
      for (const PlanePart &part : theirs) action(p * size_ + part.before, part.count);
}

template <class Element> void Transposition<Element>::hand_over(Element *array)
{
  if (comm_.size() == 1) return;
  const PhaseScope handing(Phase::communicate);
  Element *to = parcel_.data();
  for_parcel([&](long place, long count) { to = std::copy_n(array + place, count, to); });
  comm_.exchange(parcel_.data(), parcel_sizes_, array, array_sizes_);
}

template <class Element> void Transposition<Element>::hand_back(Element *array)
{
  if (comm_.size() == 1) return;
  const PhaseScope handing(Phase::communicate);
  comm_.exchange(array, array_sizes_, parcel_.data(), parcel_sizes_);
  const Element *from = parcel_.data();
  for_parcel([&](long place, long count) {
    std::copy_n(from, count, array + place);
    from += count;
  });
}

template <class Element> std::size_t Transposition<Element>::memory() const
{
  return bytes_of(parcel_);
}

template class Transposition<double>;
template class Transposition<std::complex<float>>;
template class Transposition<std::complex<double>>;

}    // namespace bdh
