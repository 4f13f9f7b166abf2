// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// The hand-over between ranks of a grid in the memory of a device: each gives parts of its planes
/// for all planes of its own part.
#ifndef BDH_GRID_TRANSPOSITION_KOKKOS_H
#define BDH_GRID_TRANSPOSITION_KOKKOS_H

#include "base/bytes_of.h"
#include "base/device_kokkos.h"
#include "base/messages_kokkos.h"
#include "grid/slabs.h"

#include <vector>

namespace bdh {

/// Where the numbers of this rank's planes are in its parcel, which is sorted by the rank that gets
/// them.  Ranks get equal parts of a plane.
struct ParcelPlace {
  long planes, size,
      part;    ///< planes of this rank; numbers of a plane and of a rank's part of it
  BDH_FN long operator()(long i) const
  {
    const long plane = i / size, at = i % size, start = at / part * part;
    const long count = start + part <= size ? part : size - start;
    return planes * start + plane * count + at - start;
  }
};
/// Packs a parcel, or unpacks it.  The index is that of a number in the planes.
template <class Real> struct PackParcel {
  ParcelPlace place;
  const Real *planes;
  Real *parcel;
  BDH_FN void operator()(long i) const { parcel[place(i)] = planes[i]; }
};
template <class Real> struct UnpackParcel {
  ParcelPlace place;
  const Real *parcel;
  Real *planes;
  BDH_FN void operator()(long i) const { planes[i] = parcel[place(i)]; }
};

/// The counterpart of Transposition, for planes whose elements are dealt in equal_part()s.  Device
/// pointers.
template <class Real, class Exec> class DeviceTransposition {
 public:
  /// The `planes` planes of `size` elements, each of `numbers` Reals, are dealt in equal_part()s.
  DeviceTransposition(const Comm &comm, long planes, long size, int numbers) :
      messages_(comm), slab_(equal_part(planes, comm.rank(), comm.size())),
      columns_(equal_part(size, comm.rank(), comm.size())),
      alone_(comm.size() == 1), place_{slab_.count, numbers * size,
                                       numbers * equal_part(size, 0, comm.size()).count},
      parcel_sizes_(parcels(comm, size), numbers * slab_.count),
      array_sizes_(parcels(comm, planes), numbers * columns_.count)
  {
    if (!alone_) parcel_.resize(place_.planes * place_.size);
  }

  /// This rank's planes, and its elements of every plane.
  const Slab &slab() const { return slab_; }
  const Slab &columns() const { return columns_; }

  /// Collective.  From planes of this rank's slab to its columns of all planes.
  void hand_over(Real *array)
  {
    if (alone_) return;
    device_for<Exec>("bdh::pack", place_.planes * place_.size,
                     PackParcel<Real>{place_, array, parcel_.data()});
    messages_.exchange(parcel_.data(), parcel_sizes_, array, array_sizes_);
  }
  /// Collective.  Undoes hand_over().
  void hand_back(Real *array)
  {
    if (alone_) return;
    messages_.exchange(array, array_sizes_, parcel_.data(), parcel_sizes_);
    device_for<Exec>("bdh::unpack", place_.planes * place_.size,
                     UnpackParcel<Real>{place_, parcel_.data(), array});
  }
  std::size_t memory() const { return bytes_of(parcel_) + messages_.memory(); }

 private:
  /// The parts of all ranks.
  static std::vector<int> parcels(const Comm &comm, long n)
  {
    std::vector<int> counts;
    for (int r = 0; r < comm.size(); ++r) counts.push_back(equal_part(n, r, comm.size()).count);
    return counts;
  }

  DeviceMessages<Real, Exec> messages_;
  Slab slab_, columns_;
  bool alone_;
  ParcelPlace place_;
  MessageSizes parcel_sizes_, array_sizes_;
  DeviceArray<Real, Exec> parcel_;
};

}    // namespace bdh
#endif
