// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Planes of the slow axis dealt to ranks, and the way of particles to the ranks whose planes they
/// touch.
#ifndef BDH_GRID_SLABS_H
#define BDH_GRID_SLABS_H

#include "base/aligned.h"
#include "base/comm.h"
#include "grid/grid.h"

#include <vector>

namespace bdh {

/// A rank's part of n.  The parts are consecutive and equal, but the last ones are smaller or
/// empty.
Slab equal_part(long n, int rank, int ranks);

enum class Neighbour { before, after };

/// Collective.  to := the plane (`size` doubles) of a periodic field before the first or after the
/// last of this rank's planes.  The `planes` planes are dealt in equal_part()s; a rank without
/// planes gets nothing.
void fetch_plane(const Comm &comm, const Slab &mine, long planes, long size, const double *field,
                 Neighbour which, double *to);

/// Carries particles to the slabs that their kernels touch and sums what comes back.
///
/// A particle belongs to one rank and may touch several slabs.  Everything that is carried has
/// `width` numbers per particle.  After plan(), count() particles are known here, in an order that
/// all calls share.  On one rank these are the particles themselves and nothing is copied, so that
/// the arrays may lie in the memory of a device.
///
///     plan(n, first_plane, reach);      bring(x), bring(force)            to the slabs
///     interpolate(parts(velocity));     take_back(velocity)               and back
class SlabExchange {
 public:
  /// Collective.  `mine` is this rank's part of the `planes` planes of the slow axis.
  SlabExchange(const Comm &comm, const Slab &mine, long planes, int width);

  /// Collective.  first_plane(i) is the lowest plane that particle i touches, any integer
  /// (periodic); the particle touches `reach` planes.  It is not called on one rank.
  template <class FirstPlane> void plan(long particles, FirstPlane first_plane, long reach)
  {
    particles_ = received_ = particles;
    if (comm_.size() == 1) return;
    first_.resize(particles);
    for (long i = 0; i < particles; ++i) first_[i] = first_plane(i);
    deal(reach);
  }
  /// The number of particles that touch this rank's slab.
  long count() const { return received_; }

  /// Collective.  Carries numbers from owners to slabs.  The result stays valid until the next
  /// call.
  const double *bring(const double *mine);
  /// The array into which to write this slab's part of a sum for its count() particles, before
  /// take_back(mine).
  double *parts(double *mine);
  /// Collective.  mine[i] := sum over slabs of their parts for particle i, in the order of ranks.
  void take_back(double *mine);

  std::size_t memory() const;

 private:
  void deal(long reach);
  void exchange(double *from, const std::vector<int> &from_counts, double *to,
                const std::vector<int> &to_counts);

  const Comm comm_;
  int width_;
  std::vector<int> owner_;    // rank that has each plane
  long particles_ = 0, received_ = 0;
  std::vector<long> first_;         // plane of each particle
  std::vector<long> send_index_;    // particle of each send slot, grouped by destination rank
  std::vector<int> send_counts_, receive_counts_;    // particles per rank
  AlignedVector outgoing_, incoming_, parts_;
};

}    // namespace bdh
#endif
