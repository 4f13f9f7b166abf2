// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
#include "grid/row_transposition.h"

#include "base/bytes_of.h"
#include "base/phases.h"

#include <algorithm>
#include <complex>

namespace bdh {

template <class Element>
RowTransposition<Element>::RowTransposition(const GridParts &parts, long row, long width) :
    comm_(parts.same_planes()), planes_(parts.planes().count), all_rows_(parts.all_rows()),
    row_(row), columns_(equal_part(width, parts.place(), parts.share()))
{
  for (int r = 0; r < comm_.size(); ++r) {
    before_.push_back({parts.rows(), equal_part(width, r, parts.share())});
    after_.push_back({equal_part(all_rows_, r, parts.share()), columns_});
  }
  out_.resize(std::max(sizes(before_).total(), sizes(after_).total()));
  in_.resize(out_.size());
}

template <class Element>
MessageSizes RowTransposition<Element>::sizes(const std::vector<Parcel> &parcels) const
{
  std::vector<int> rows_or_columns;
  for (const Parcel &p : parcels) rows_or_columns.push_back(p.rows.count * p.columns.count);
  return {rows_or_columns, planes_};
}

/// Calls action(place in an array, number of elements) for everything in the parcels, in their
/// order: by rank, plane and row.
template <class Element> template <class Action>
void RowTransposition<Element>::for_places(const std::vector<Parcel> &parcels,
                                           const Action &action) const
{
  for (const Parcel &parcel : parcels)
    for (long p = 0; p < planes_; ++p)
      for (long y = 0; y < parcel.rows.count; ++y)
        action((p * all_rows_ + parcel.rows.start + y) * row_ + parcel.columns.start,
               parcel.columns.count);
}

template <class Element> void RowTransposition<Element>::move(Element *array,
                                                              const std::vector<Parcel> &from,
                                                              const std::vector<Parcel> &to)
{
  const PhaseScope handing(Phase::communicate);
  Element *packed = out_.data();
  for_places(from,
             [&](long place, long count) { packed = std::copy_n(array + place, count, packed); });
  comm_.exchange(out_.data(), sizes(from), in_.data(), sizes(to));
  const Element *arrived = in_.data();
  for_places(to, [&](long place, long count) {
    std::copy_n(arrived, count, array + place);
    arrived += count;
  });
}

template <class Element> void RowTransposition<Element>::hand_over(Element *array)
{
  move(array, before_, after_);
}

template <class Element> void RowTransposition<Element>::hand_back(Element *array)
{
  move(array, after_, before_);
}

template <class Element> std::size_t RowTransposition<Element>::memory() const
{
  return bytes_of(out_, in_);
}

template class RowTransposition<std::complex<float>>;
template class RowTransposition<std::complex<double>>;

}    // namespace bdh
