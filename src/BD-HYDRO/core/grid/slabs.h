// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Planes of the slow axis dealt to ranks, and the way of particles to the ranks whose planes they
/// touch.
#ifndef BDH_GRID_SLABS_H
#define BDH_GRID_SLABS_H

#include "base/comm.h"
#include "grid/grid.h"

#include <vector>

namespace bdh {

/// Consecutive parts of n, equal but for the last ones, which may be empty.
Slab equal_part(long n, int rank, int ranks);

enum class Neighbour { before, after };

/// Collective.  to := the plane (`size` doubles) before the first or after the last of this rank's
/// planes of a field, periodic.  The `planes` planes are dealt in equal_part()s; a rank without
/// planes gets nothing.
void fetch_plane(const Comm &comm, const Slab &mine, long planes, long size, const double *field,
                 Neighbour which, double *to);

/// Which rank owns each plane of the slow axis.
std::vector<int> plane_owners(const Comm &comm, const Slab &mine, long planes);

/// Carries particles to the slabs that their kernels touch and sums what comes back.
///
/// A particle belongs to one rank and may touch several slabs.  After plan() `received()` particles
/// are known here, in an order that forward() and reverse_sum() share.  On one rank the exchange is
/// the identity and forward() copies nothing.
class SlabExchange {
 public:
  SlabExchange(const Comm &comm, std::vector<int> owner_of_plane);

  /// Collective.  first[i]: lowest plane that particle i touches, any integer (periodic); it
  /// touches `reach` planes.
  void plan(const std::vector<long> &first, long reach);
  long received() const { return received_; }

  /// Collective.  width doubles per particle, from owners to slabs.  The result stays valid until
  /// the next call.
  const double *forward(const double *mine, int width);
  /// Collective.  sum[i] := sum over slabs of their value for particle i, in the order of ranks.
  void reverse_sum(const double *theirs, int width, double *sum);

  std::size_t memory() const;

 private:
  void exchange(const double *from, const std::vector<int> &from_counts, double *to,
                const std::vector<int> &to_counts, int width);

  const Comm comm_;
  std::vector<int> owner_;
  long particles_ = 0, received_ = 0;
  std::vector<long> send_index_;    // particle of each send slot, grouped by destination rank
  std::vector<int> send_counts_, receive_counts_;    // particles per rank
  std::vector<double> outgoing_, incoming_;
};

}    // namespace bdh
#endif
