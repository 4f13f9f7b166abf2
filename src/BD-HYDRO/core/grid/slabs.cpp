// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
#include "grid/slabs.h"

#include "base/bytes_of.h"
#include "base/phases.h"
#include "base/ssize.h"

#include <algorithm>

namespace bdh {

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

ParticleRoutes::ParticleRoutes(const GridParts &parts) :
    parts_(parts), sent_by_rank_(comm().size()), received_by_rank_(comm().size())
{}

/// Calls action(particle, rank) for each particle and the owners of what it touches, each once.
template <class Action> void ParticleRoutes::for_owners(const std::vector<long> &plane,
                                                        const std::vector<long> &row, long reach,
                                                        const Action &action) const
{
  for (long i = 0; i < ssize(plane); ++i)
    parts_.for_ranks(plane[i], ask_for_rows() ? row[i] : 0, reach,
                     [&](int rank) { action(i, rank); });
}

/// Counts first, so that everything has its place.
void ParticleRoutes::deal(const std::vector<long> &plane, const std::vector<long> &row, long reach)
{
  const PhaseScope planning(Phase::communicate);

  particles_ = ssize(plane);
  std::fill(sent_by_rank_.begin(), sent_by_rank_.end(), 0);
  for_owners(plane, row, reach, [this](long, int rank) { ++sent_by_rank_[rank]; });
  std::vector<long> next(sent_by_rank_.size());
  long sum = 0;
  for (std::size_t r = 0; r < next.size(); ++r) {
    next[r] = sum;
    sum += sent_by_rank_[r];
  }
  sent_.resize(sum);
  for_owners(plane, row, reach, [&](long i, int rank) { sent_[next[rank]++] = i; });
  comm().exchange(sent_by_rank_, received_by_rank_);
  received_ = 0;
  for (int c : received_by_rank_) received_ += c;
}

std::size_t ParticleRoutes::memory() const { return bytes_of(sent_); }

const double *ParticleExchange::bring(const double *mine)
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

double *ParticleExchange::parts(double *mine)
{
  if (routes_->alone()) return mine;
  parts_.resize(count() * width_);
  return parts_.data();
}

void ParticleExchange::take_back(double *mine)
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

std::size_t ParticleExchange::memory() const
{
  return (planes_.empty() ? 0 : routes_->memory()) +
         bytes_of(planes_, rows_, outgoing_, incoming_, parts_);
}

}    // namespace bdh
