// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Neighbours in a grid whose planes are dealt to ranks, and the way of particles to the ranks
/// whose parts of it they touch.
#ifndef BDH_GRID_SLABS_H
#define BDH_GRID_SLABS_H

#include "base/aligned.h"
#include "base/comm.h"
#include "grid/parts.h"

#include <memory>
#include <vector>

namespace bdh {

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

/// Functions of a particle's index: the lowest plane of the slow axis and the lowest row along y
/// that it touches, any integers (periodic).  Slabs do not ask for rows.
template <class Plane, class Row> struct FirstLines {
  Plane plane;
  Row row;
};
template <class Plane, class Row> FirstLines(Plane, Row) -> FirstLines<Plane, Row>;

/// Which particles go to whose part of the grid.
///
/// A particle belongs to one rank and may touch several parts.
class ParticleRoutes {
 public:
  explicit ParticleRoutes(const GridParts &parts);

  const Comm &comm() const { return parts_.comm(); }
  /// True on one rank, where nothing is carried.
  bool alone() const { return comm().size() == 1; }

  /// On one rank: its particles.
  void stay(long particles) { particles_ = received_ = particles; }
  /// True if parts of the grid are pencils, for which deal() must know rows.
  bool ask_for_rows() const { return parts_.pencils(); }
  /// Collective.  Particle i touches `reach` planes from plane[i] on and as many rows from row[i]
  /// on.
  void deal(const std::vector<long> &plane, const std::vector<long> &row, long reach);

  long particles() const { return particles_; }
  /// The number of particles that touch this rank's part.
  long received() const { return received_; }
  /// The particle of each number that is sent, grouped by destination rank.
  const std::vector<long> &sent() const { return sent_; }
  /// Messages of `width` numbers per particle, from owners to parts.
  MessageSizes outgoing(int width) const { return {sent_by_rank_, width}; }
  MessageSizes incoming(int width) const { return {received_by_rank_, width}; }

  std::size_t memory() const;

 private:
  template <class Action> void for_owners(const std::vector<long> &plane,
                                          const std::vector<long> &row, long reach,
                                          const Action &action) const;

  GridParts parts_;
  long particles_ = 0, received_ = 0;
  std::vector<long> sent_;
  std::vector<int> sent_by_rank_, received_by_rank_;    // particles
};

/// Carries particles to the parts that their kernels touch and sums what comes back.
///
/// Everything that is carried has `width` numbers per particle.  After plan(), count() particles
/// are known here, in an order that all calls share.  On one rank these are the particles
/// themselves and nothing is copied.
///
///     plan(n, first_lines, reach);      bring(x), bring(force)            to the parts
///     interpolate(parts(velocity));      take_back(velocity)               and back
class ParticleExchange {
 public:
  ParticleExchange(const GridParts &parts, int width) :
      routes_(std::make_shared<ParticleRoutes>(parts)), width_(width)
  {}
  /// Carries other numbers of the same particles: the other exchange plans for both.
  ParticleExchange(const ParticleExchange &other, int width) : routes_(other.routes_), width_(width)
  {}

  /// Collective.  The functions of FirstLines are not called on one rank.
  template <class First> void plan(long particles, const First &first, long reach)
  {
    if (routes_->alone()) return routes_->stay(particles);
    const auto tabulate = [particles](const auto &function, std::vector<long> &to) {
      to.resize(particles);
      for (long i = 0; i < particles; ++i) to[i] = function(i);
    };
    tabulate(first.plane, planes_);
    if (routes_->ask_for_rows()) tabulate(first.row, rows_);
    routes_->deal(planes_, rows_, reach);
  }
  /// The number of particles that touch this rank's part.
  long count() const { return routes_->received(); }

  /// Collective.  Carries numbers from owners to parts.  The result stays valid until the next
  /// call.
  const double *bring(const double *mine);
  /// The array into which to write this part's share of a sum for its count() particles, before
  /// take_back(mine).
  double *parts(double *mine);
  /// Collective.  mine[i] := sum over parts of their shares for particle i, in the order of ranks.
  void take_back(double *mine);

  /// Bytes; those of shared routes count for the exchange that plans.
  std::size_t memory() const;

 private:
  std::shared_ptr<ParticleRoutes> routes_;
  int width_;
  std::vector<long> planes_, rows_;    // the lowest ones of each particle
  AlignedVector outgoing_, incoming_, parts_;
};

}    // namespace bdh
#endif
