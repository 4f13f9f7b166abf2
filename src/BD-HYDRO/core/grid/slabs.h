// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Planes of the slow axis dealt to ranks, and the way of particles to the ranks whose planes they
/// touch.
#ifndef BDH_GRID_SLABS_H
#define BDH_GRID_SLABS_H

#include "base/aligned.h"
#include "base/comm.h"
#include "grid/grid.h"

#include <memory>
#include <vector>

namespace bdh {

/// A rank's part of n.  The parts are consecutive and equal, but the last ones are smaller or
/// empty.
Slab equal_part(long n, int rank, int ranks);

/// The ranks that have the planes before and after those of a rank, around the periodic axis.
struct NeighbourRanks {
  int below, above;
  /// `planes` planes are dealt in equal_part()s to `ranks` ranks, and this one has some.
  NeighbourRanks(const Slab &mine, long planes, int ranks);
};

enum class Neighbour { before, after };

/// Collective.  to := the plane (`size` doubles) of a periodic field before the first or after the
/// last of this rank's planes.  The `planes` planes are dealt in equal_part()s; a rank without
/// planes gets nothing.
void fetch_plane(const Comm &comm, const Slab &mine, long planes, long size, const double *field,
                 Neighbour which, double *to);

/// Which particles go to whose slab.
///
/// A particle belongs to one rank and may touch several slabs.
class SlabRoutes {
 public:
  /// The `planes` planes of the slow axis are dealt in equal_part()s.
  SlabRoutes(const Comm &comm, long planes);

  const Comm &comm() const { return comm_; }
  /// True on one rank, where nothing is carried.
  bool alone() const { return comm_.size() == 1; }

  /// On one rank: its particles.
  void stay(long particles) { particles_ = received_ = particles; }
  /// Collective.  first_plane[i] is the lowest plane that particle i touches, any integer
  /// (periodic); the particle touches `reach` planes.
  void deal(const std::vector<long> &first_plane, long reach);

  long particles() const { return particles_; }
  /// The number of particles that touch this rank's slab.
  long received() const { return received_; }
  /// The particle of each number that is sent, grouped by destination rank.
  const std::vector<long> &sent() const { return sent_; }
  /// Messages of `width` numbers per particle, from owners to slabs.
  MessageSizes outgoing(int width) const { return {sent_by_rank_, width}; }
  MessageSizes incoming(int width) const { return {received_by_rank_, width}; }

  std::size_t memory() const;

 private:
  template <class Action>
  void for_owners(const std::vector<long> &first_plane, long reach, const Action &action) const;

  Comm comm_;
  long planes_;
  long particles_ = 0, received_ = 0;
  std::vector<long> sent_;
  std::vector<int> sent_by_rank_, received_by_rank_;    // particles
};

/// Carries particles to the slabs that their kernels touch and sums what comes back.
///
/// Everything that is carried has `width` numbers per particle.  After plan(), count() particles
/// are known here, in an order that all calls share.  On one rank these are the particles
/// themselves and nothing is copied.
///
///     plan(n, first_plane, reach);      bring(x), bring(force)            to the slabs
///     interpolate(parts(velocity));     take_back(velocity)               and back
class SlabExchange {
 public:
  /// The `planes` planes of the slow axis are dealt in equal_part()s.
  SlabExchange(const Comm &comm, long planes, int width) :
      routes_(std::make_shared<SlabRoutes>(comm, planes)), width_(width)
  {}
  /// Carries other numbers of the same particles: the other exchange plans for both.
  SlabExchange(const SlabExchange &other, int width) : routes_(other.routes_), width_(width) {}

  /// Collective.  For first_plane(i) and reach see SlabRoutes::deal(); it is not called on one
  /// rank.
  template <class FirstPlane> void plan(long particles, FirstPlane first_plane, long reach)
  {
    if (routes_->alone()) return routes_->stay(particles);
    first_.resize(particles);
    for (long i = 0; i < particles; ++i) first_[i] = first_plane(i);
    routes_->deal(first_, reach);
  }
  /// The number of particles that touch this rank's slab.
  long count() const { return routes_->received(); }

  /// Collective.  Carries numbers from owners to slabs.  The result stays valid until the next
  /// call.
  const double *bring(const double *mine);
  /// The array into which to write this slab's part of a sum for its count() particles, before
  /// take_back(mine).
  double *parts(double *mine);
  /// Collective.  mine[i] := sum over slabs of their parts for particle i, in the order of ranks.
  void take_back(double *mine);

  /// Bytes; those of shared routes count for the exchange that plans.
  std::size_t memory() const;

 private:
  std::shared_ptr<SlabRoutes> routes_;
  int width_;
  std::vector<long> first_;    // plane of each particle
  AlignedVector outgoing_, incoming_, parts_;
};

}    // namespace bdh
#endif
