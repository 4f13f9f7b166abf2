// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
#include "grid/slabs.h"

#include "base/bytes_of.h"
#include "base/phases.h"
#include "base/ssize.h"

#include <algorithm>

namespace bdh {

Slab equal_part(long n, int rank, int ranks)
{
  const long size = (n + ranks - 1) / ranks, start = std::min(n, rank * size);
  return {start, std::min(size, n - start)};
}

NeighbourRanks::NeighbourRanks(const Slab &mine, long planes, int ranks)
{
  const long most = equal_part(planes, 0, ranks).count;
  below = (mine.start + planes - 1) % planes / most;
  above = (mine.start + mine.count) % planes / most;
}

void fetch_plane(const Comm &comm, const Slab &mine, long planes, long size, const double *field,
                 Neighbour which, double *to)
{
  if (mine.count == 0) return;
  const NeighbourRanks ranks(mine, planes, comm.size());
  const double *first = field, *last = field + (mine.count - 1) * size;
  const bool before = which == Neighbour::before;
  if (ranks.below == comm.rank()) {
    std::copy_n(before ? last : first, size, to);
    return;
  }
  comm.shift(before ? last : first, before ? ranks.above : ranks.below, to,
             before ? ranks.below : ranks.above, size);
}

SlabRoutes::SlabRoutes(const Comm &comm, long planes) :
    comm_(comm), planes_(planes), sent_by_rank_(comm.size()), received_by_rank_(comm.size())
{}

/// Calls action(particle, rank) for each particle and the owners of the planes that it touches,
/// each once.
template <class Action> void SlabRoutes::for_owners(const std::vector<long> &first_plane,
                                                    long reach, const Action &action) const
{
  const long slab = equal_part(planes_, 0, comm_.size()).count;
  std::vector<long> last(comm_.size(), -1);    // particle that went to a rank
  for (long i = 0; i < ssize(first_plane); ++i) {
    long plane = (first_plane[i] % planes_ + planes_) % planes_;
    for (long left = std::min(reach, planes_); left > 0;) {
      const int rank = plane / slab;
      if (last[rank] != i) action(i, rank);
      last[rank] = i;
      const long next = std::min(planes_, (rank + 1) * slab);
      left -= next - plane;
      plane = next % planes_;
    }
  }
}

/// Counts first, so that everything has its place.
void SlabRoutes::deal(const std::vector<long> &first_plane, long reach)
{
  const PhaseScope planning(Phase::communicate);

  particles_ = ssize(first_plane);
  std::fill(sent_by_rank_.begin(), sent_by_rank_.end(), 0);
  for_owners(first_plane, reach, [this](long, int rank) { ++sent_by_rank_[rank]; });
  std::vector<long> next(sent_by_rank_.size());
  long sum = 0;
  for (std::size_t r = 0; r < next.size(); ++r) {
    next[r] = sum;
    sum += sent_by_rank_[r];
  }
  sent_.resize(sum);
  for_owners(first_plane, reach, [&](long i, int rank) { sent_[next[rank]++] = i; });
  comm_.exchange(sent_by_rank_, received_by_rank_);
  received_ = 0;
  for (int c : received_by_rank_) received_ += c;
}

std::size_t SlabRoutes::memory() const { return bytes_of(sent_); }

const double *SlabExchange::bring(const double *mine)
{
  if (routes_->alone()) return mine;
  const std::vector<long> &sent = routes_->sent();
  outgoing_.resize(sent.size() * width_);
  incoming_.resize(count() * width_);
  for (std::size_t s = 0; s < sent.size(); ++s)
    std::copy_n(mine + sent[s] * width_, width_, outgoing_.data() + s * width_);
  routes_->comm().exchange(outgoing_.data(), routes_->outgoing(width_), incoming_.data(),
                           routes_->incoming(width_));
  return incoming_.data();
}

double *SlabExchange::parts(double *mine)
{
  if (routes_->alone()) return mine;
  parts_.resize(count() * width_);
  return parts_.data();
}

void SlabExchange::take_back(double *mine)
{
  if (routes_->alone()) return;
  const std::vector<long> &sent = routes_->sent();
  outgoing_.resize(sent.size() * width_);
  routes_->comm().exchange(parts_.data(), routes_->incoming(width_), outgoing_.data(),
                           routes_->outgoing(width_));
  std::fill_n(mine, routes_->particles() * width_, 0.0);
  for (std::size_t s = 0; s < sent.size(); ++s)
    for (int w = 0; w < width_; ++w) mine[sent[s] * width_ + w] += outgoing_[s * width_ + w];
}

std::size_t SlabExchange::memory() const
{
  return (first_.empty() ? 0 : routes_->memory()) + bytes_of(first_, outgoing_, incoming_, parts_);
}

}    // namespace bdh
