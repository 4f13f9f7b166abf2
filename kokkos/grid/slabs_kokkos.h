// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Carries particles in the memory of a device to the ranks whose planes they touch.
#ifndef BDH_GRID_SLABS_KOKKOS_H
#define BDH_GRID_SLABS_KOKKOS_H

#include "base/bytes_of.h"
#include "base/device_kokkos.h"
#include "base/messages_kokkos.h"
#include "base/ssize.h"
#include "base/vector_kernel.h"
#include "grid/slabs.h"

#include <memory>

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

/// The counterpart of ParticleExchange, for slabs; all pointers are device pointers.  Sums over
/// slabs come in any order.
template <class Exec> class DeviceSlabExchange {
 public:
  DeviceSlabExchange(const GridParts &slabs, int width) :
      plan_(std::make_shared<Plan>(slabs)), messages_(slabs.comm()), width_(width)
  {}
  DeviceSlabExchange(const DeviceSlabExchange &other, int width) :
      plan_(other.plan_), messages_(other.messages_.comm()), width_(width)
  {}

  /// The function of FirstLines is called on the device.
  template <class Plane, class Row>
  void plan(long particles, const FirstLines<Plane, Row> &first, long reach)
  {
    if (alone()) return plan_->routes.stay(particles);
    first_.resize(particles);
    device_for<Exec>("bdh::first_planes", particles, Tabulate<Plane>{first.plane, first_.data()});
    plan_->routes.deal(first_.to_host(), {}, reach);
    plan_->sent.assign(plan_->routes.sent().data(), plan_->routes.sent().size());
  }
  long count() const { return plan_->routes.received(); }
  bool alone() const { return plan_->routes.alone(); }

  const double *bring(const double *mine)
  {
    if (alone()) return mine;
    outgoing_.resize(plan_->sent.size() * width_);
    incoming_.resize(count() * width_);
    device_for<Exec>("bdh::pack", ssize(outgoing_),
                     PackSent{plan_->sent.data(), width_, mine, outgoing_.data()});
    messages_.exchange(outgoing_.data(), plan_->routes.outgoing(width_), incoming_.data(),
                       plan_->routes.incoming(width_));
    return incoming_.data();
  }
  double *parts(double *mine)
  {
    if (alone()) return mine;
    parts_.resize(count() * width_);
    return parts_.data();
  }
  void take_back(double *mine)
  {
    if (alone()) return;
    outgoing_.resize(plan_->sent.size() * width_);
    messages_.exchange(parts_.data(), plan_->routes.incoming(width_), outgoing_.data(),
                       plan_->routes.outgoing(width_));
    device_for<Exec>("bdh::clear", plan_->routes.particles() * width_, Clear{mine});
    device_for<Exec>("bdh::add_returned", ssize(outgoing_),
                     AddReturned{plan_->sent.data(), width_, outgoing_.data(), mine});
    Exec().fence();
  }

  std::size_t memory() const
  {
    return messages_.memory() + bytes_of(first_, outgoing_, incoming_, parts_) +
           (first_.empty() ? 0 : plan_->routes.memory() + bytes_of(plan_->sent));
  }

 private:
  struct Plan {
    ParticleRoutes routes;
    DeviceArray<long, Exec> sent;    ///< the routes' sent()
    explicit Plan(const GridParts &slabs) : routes(slabs) {}
  };

  std::shared_ptr<Plan> plan_;
  DeviceMessages<double, Exec> messages_;
  int width_;
  DeviceArray<long, Exec> first_;
  DeviceArray<double, Exec> outgoing_, incoming_, parts_;
};

}    // namespace bdh
#endif
