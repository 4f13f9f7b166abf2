// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
#include "grid/parts.h"

#include "base/errors.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace bdh {

Slab equal_part(long n, int rank, int ranks)
{
  const long size = (n + ranks - 1) / ranks, start = std::min(n, rank * size);
  return {start, std::min(size, n - start)};
}

namespace {

// Seconds of a core (bench/README.md, doc/src/howto_ranks.rst): for a point of the grid with its
// part of the particles; for carrying its three components there and back, within a slab, whose
// ranks are neighbours in a node, and between slabs; and for a message.
constexpr double point_seconds = 5e-8;
constexpr double row_seconds = 3e-8;
constexpr double plane_seconds = 1e-7;
constexpr double message_seconds = 1e-6;
// Pencils must be faster than slabs by so much, and many ranks of a slab than few, since they keep
// more in memory.
constexpr double advantage = 0.9;

/// Of the transforms and hand-overs of a solve on the busiest of so many ranks.
double seconds_of_solve(const Grid &grid, int ranks, int share)
{
  const int groups = ranks / share;
  const double points = static_cast<double>(grid.n[0]) * equal_part(grid.n[1], 0, share).count *
                        equal_part(grid.n[2], 0, groups).count;
  const double messages = 6.0 * (share - 1 + groups - 1);
  const double carried = (share > 1 ? row_seconds : 0.0) + (groups > 1 ? plane_seconds : 0.0);
  return points * (point_seconds + carried) + messages * message_seconds;
}

int checked_share(const Grid &grid, const Comm &comm, int share)
{
  if (share == GridParts::automatic) return best_share(grid, comm.size());
  const std::string remedy = ": give 1 for slabs, or the word auto";
  if (share > 1 && grid.dim != 3)
    throw InvalidOption("pencils", share, "a two-dimensional grid has only slabs" + remedy);
  if (share < 1 || share > comm.size())
    throw InvalidOption("pencils", share,
                        "there are not so many processes to share a slab of planes, but " +
                            std::to_string(comm.size()) + remedy);
  return share;
}

}    // namespace

int best_share(const Grid &grid, int ranks)
{
  if (grid.dim != 3) return 1;
  const double slabs = seconds_of_solve(grid, ranks, 1);
  std::vector<std::pair<double, int>> faster;    // seconds, share
  double least = advantage * slabs;
  for (int share = 2; share <= std::min<long>(ranks, grid.n[1]); ++share) {
    // Whole planes are kept, so the planes are dealt first.
    const int groups = ranks / share;
    if (share > groups && groups < grid.n[2]) continue;
    const double seconds = seconds_of_solve(grid, ranks, share);
    if (seconds < advantage * slabs) faster.push_back({seconds, share});
    least = std::min(least, seconds);
  }
  // Of those that take almost as little time, the one that keeps fewest planes, and so least
  // memory.
  int best = 1;
  long fewest = 0;
  for (const auto &[seconds, share] : faster) {
    const long planes = equal_part(grid.n[2], 0, ranks / share).count;
    if (seconds > least / advantage || (best > 1 && planes >= fewest)) continue;
    best = share;
    fewest = planes;
  }
  return best;
}

GridParts::PartOfLine::PartOfLine(long n, int parts) : size_((n + parts - 1) / parts), part_(n)
{
  for (long line = 0; line < n; ++line) part_[line] = line / size_;
}

/// Ranks that are left over count among those with the rows of the first one of each group, which
/// gives them modes to work on.
GridParts::GridParts(const Grid &grid, const Comm &comm, int share) :
    comm_(comm), share_(checked_share(grid, comm, share)), groups_(comm.size() / share_),
    place_(comm.rank() < groups_ * share_ ? comm.rank() % share_ : 0),
    same_planes_(pencils() ? comm.split(comm.rank() / share_) : comm),
    same_rows_(pencils() ? comm.split(place_) : comm), all_planes_(grid.n[grid.slow_axis()]),
    all_rows_(grid.dim == 3 ? grid.n[1] : 1), row_size_(2 * grid.half()),
    group_of_plane_(all_planes_, groups_), place_of_row_(all_rows_, share_),
    planes_(equal_part(all_planes_, comm.rank() / share_, groups_)), rows_{0, all_rows_}
{
  if (!pencils()) return;
  const bool left_over = comm.rank() >= groups_ * share_;
  rows_ = left_over ? Slab{} : equal_part(all_rows_, place_, share_);
}

template <class Real> void GridParts::clear_rows(Real *component, bool own) const
{
  if (rows_.count == 0) return;
  const long others = std::min(margin, all_rows_ - rows_.count);
  const auto clear = [&](Real *plane, long first, long count) {
    for (long i = 0; i < count; ++i)
      std::fill_n(plane + (first + i + all_rows_) % all_rows_ * row_size_, row_size_, Real(0));
  };
  for (long p = 0; p < planes_.count; ++p) {
    Real *const plane = component + p * all_rows_ * row_size_;
    clear(plane, rows_.start - others, others);
    if (own) clear(plane, rows_.start, rows_.count);
    clear(plane, rows_.start + rows_.count, others);
  }
}

template void GridParts::clear_rows(float *, bool) const;
template void GridParts::clear_rows(double *, bool) const;

}    // namespace bdh
