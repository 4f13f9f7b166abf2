// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Carries particles in the memory of a device to the ranks whose planes they touch.
#ifndef BDH_GRID_SLABS_KOKKOS_H
#define BDH_GRID_SLABS_KOKKOS_H

#include "base/bytes_of.h"
#include "base/device_kokkos.h"
#include "base/messages_kokkos.h"
#include "base/ssize.h"
#include "grid/slabs.h"

#include <vector>

namespace bdh {

/// The counterpart of fetch_plane(), with device pointers; for several ranks.
template <class Exec> void fetch_plane(DeviceMessages<double, Exec> &messages, const Slab &mine,
                                       long planes, long size, const double *field, Neighbour which,
                                       double *to)
{
  if (mine.count == 0) return;
  const NeighbourRanks ranks(mine, planes, messages.comm().size());
  if (which == Neighbour::before)
    messages.shift(field + (mine.count - 1) * size, ranks.above, to, ranks.below, size);
  else
    messages.shift(field, ranks.below, to, ranks.above, size);
}

/// to[i] := function(i)
template <class Function> struct Tabulate {
  Function function;
  long *to;
  BDH_FN void operator()(long i) const { to[i] = function(i); }
};
/// Numbers of particles in the order in which they are sent.  The index is that of a number.
struct PackSent {
  const long *sent;
  int width;
  const double *from;
  double *to;
  BDH_FN void operator()(long i) const { to[i] = from[sent[i / width] * width + i % width]; }
};
/// Adds what comes back to the particles' sums.
struct AddReturned {
  const long *sent;
  int width;
  const double *from;
  double *to;
  BDH_FN void operator()(long i) const
  {
    Kokkos::atomic_add(to + sent[i / width] * width + i % width, from[i]);
  }
};
struct ClearNumber {
  double *to;
  BDH_FN void operator()(long i) const { to[i] = 0.0; }
};

/// The counterpart of SlabExchange; all pointers are device pointers.  Sums over slabs come in any
/// order.
template <class Exec> class DeviceSlabExchange {
 public:
  DeviceSlabExchange(const Comm &comm, const Slab &mine, long planes, int width) :
      routes_(comm, mine, planes), messages_(comm), width_(width)
  {}

  /// FirstPlane is called on the device.
  template <class FirstPlane> void plan(long particles, const FirstPlane &first_plane, long reach)
  {
    if (routes_.alone()) return routes_.stay(particles);
    first_.resize(particles);
    device_for<Exec>("bdh::first_planes", particles,
                     Tabulate<FirstPlane>{first_plane, first_.data()});
    routes_.deal(first_.to_host(), reach);
    sent_.assign(routes_.sent().data(), routes_.sent().size());
    own_plan_ = true;
  }
  /// Takes the plan of another exchange between the same slabs.
  void plan_like(const DeviceSlabExchange &other)
  {
    routes_ = other.routes_;
    sent_ = other.sent_;    // the same array
    own_plan_ = false;
  }
  long count() const { return routes_.received(); }

  const double *bring(const double *mine)
  {
    if (routes_.alone()) return mine;
    outgoing_.resize(sent_.size() * width_);
    incoming_.resize(count() * width_);
    device_for<Exec>("bdh::pack", ssize(outgoing_),
                     PackSent{sent_.data(), width_, mine, outgoing_.data()});
    messages_.exchange(outgoing_.data(), routes_.outgoing(width_), incoming_.data(),
                       routes_.incoming(width_));
    return incoming_.data();
  }
  double *parts(double *mine)
  {
    if (routes_.alone()) return mine;
    parts_.resize(count() * width_);
    return parts_.data();
  }
  void take_back(double *mine)
  {
    if (routes_.alone()) return;
    outgoing_.resize(sent_.size() * width_);
    messages_.exchange(parts_.data(), routes_.incoming(width_), outgoing_.data(),
                       routes_.outgoing(width_));
    device_for<Exec>("bdh::clear", routes_.particles() * width_, ClearNumber{mine});
    device_for<Exec>("bdh::add_returned", ssize(outgoing_),
                     AddReturned{sent_.data(), width_, outgoing_.data(), mine});
    Exec().fence();
  }

  std::size_t memory() const
  {
    return routes_.memory() + messages_.memory() + (own_plan_ ? bytes_of(sent_) : 0) +
           bytes_of(first_, outgoing_, incoming_, parts_);
  }

 private:
  SlabRoutes routes_;
  DeviceMessages<double, Exec> messages_;
  int width_;
  bool own_plan_ = false;
  DeviceArray<long, Exec> first_, sent_;
  DeviceArray<double, Exec> outgoing_, incoming_, parts_;
};

}    // namespace bdh
#endif
