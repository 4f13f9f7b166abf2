// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
#include "grid/slabs.h"

#include "base/bytes_of.h"
#include "base/phases.h"
#include "base/ssize.h"

#include <algorithm>

namespace bdh {

namespace {

/// Counts of doubles from counts of particles, and where each rank's part begins.
///
/// The running sum is a scalar on purpose.  If it is written as offset[r] = offset[r-1] +
/// count[r-1] for both directions in one loop, g++ 12.2 -O3 (loop distribution) leaves zeros in the
/// second array.
std::vector<int> in_doubles(const std::vector<int> &particles, int width, std::vector<int> &offsets)
{
  std::vector<int> counts;
  offsets.clear();
  int sum = 0;
  for (int n : particles) {
    counts.push_back(n * width);
    offsets.push_back(sum);
    sum += n * width;
  }
  return counts;
}

/// The rank that owns each plane of the slow axis.
std::vector<int> plane_owners(const Comm &comm, const Slab &mine, long planes)
{
  std::vector<int> owners(planes, 0);
  if (comm.size() == 1) return owners;
  std::vector<int> claim(owners.size(), 0);
  std::fill_n(claim.begin() + mine.start, mine.count, comm.rank());
  MPI_Allreduce(claim.data(), owners.data(), planes, MPI_INT, MPI_SUM, comm.handle());
  return owners;
}

}    // namespace

Slab equal_part(long n, int rank, int ranks)
{
  const long size = (n + ranks - 1) / ranks, start = std::min(n, rank * size);
  return {start, std::min(size, n - start)};
}

void fetch_plane(const Comm &comm, const Slab &mine, long planes, long size, const double *field,
                 Neighbour which, double *to)
{
  if (mine.count == 0) return;
  const long most = equal_part(planes, 0, comm.size()).count;
  const int below = (mine.start + planes - 1) % planes / most;
  const int above = (mine.start + mine.count) % planes / most;
  const double *first = field, *last = field + (mine.count - 1) * size;
  const bool before = which == Neighbour::before;
  if (below == comm.rank()) {
    std::copy_n(before ? last : first, size, to);
    return;
  }
  MPI_Sendrecv(before ? last : first, size, MPI_DOUBLE, before ? above : below, 0, to, size,
               MPI_DOUBLE, before ? below : above, 0, comm.handle(), MPI_STATUS_IGNORE);
}

SlabExchange::SlabExchange(const Comm &comm, const Slab &mine, long planes, int width) :
    comm_(comm), width_(width), owner_(plane_owners(comm, mine, planes)), send_counts_(comm.size()),
    receive_counts_(comm.size())
{}

/// Assigns each particle to the owners of the planes that it touches.
void SlabExchange::deal(long reach)
{
  const PhaseScope planning(Phase::communicate);

  const long planes = ssize(owner_);
  std::vector<std::vector<long>> to(comm_.size());
  for (long i = 0; i < particles_; ++i)
    for (long k = 0; k < reach; ++k) {
      const long plane = ((first_[i] + k) % planes + planes) % planes;
      auto &list = to[owner_[plane]];
      if (list.empty() || list.back() != i) list.push_back(i);
    }
  send_index_.clear();
  for (std::size_t r = 0; r < to.size(); ++r) {
    send_counts_[r] = to[r].size();
    send_index_.insert(send_index_.end(), to[r].begin(), to[r].end());
  }
  MPI_Alltoall(send_counts_.data(), 1, MPI_INT, receive_counts_.data(), 1, MPI_INT, comm_.handle());
  received_ = 0;
  for (int c : receive_counts_) received_ += c;
}

void SlabExchange::exchange(double *from, const std::vector<int> &from_counts, double *to,
                            const std::vector<int> &to_counts)
{
  const PhaseScope exchanging(Phase::communicate);
  std::vector<int> from_offsets, to_offsets;
  std::vector<int> send = in_doubles(from_counts, width_, from_offsets);
  std::vector<int> receive = in_doubles(to_counts, width_, to_offsets);
  MPI_Alltoallv(from, send.data(), from_offsets.data(), MPI_DOUBLE, to, receive.data(),
                to_offsets.data(), MPI_DOUBLE, comm_.handle());
}

const double *SlabExchange::bring(const double *mine)
{
  if (comm_.size() == 1) return mine;
  outgoing_.resize(send_index_.size() * width_);
  incoming_.resize(received_ * width_);
  for (std::size_t s = 0; s < send_index_.size(); ++s)
    std::copy_n(mine + send_index_[s] * width_, width_, outgoing_.data() + s * width_);
  exchange(outgoing_.data(), send_counts_, incoming_.data(), receive_counts_);
  return incoming_.data();
}

double *SlabExchange::parts(double *mine)
{
  if (comm_.size() == 1) return mine;
  parts_.resize(received_ * width_);
  return parts_.data();
}

void SlabExchange::take_back(double *mine)
{
  if (comm_.size() == 1) return;
  outgoing_.resize(send_index_.size() * width_);
  exchange(parts_.data(), receive_counts_, outgoing_.data(), send_counts_);
  std::fill_n(mine, particles_ * width_, 0.0);
  for (std::size_t s = 0; s < send_index_.size(); ++s)
    for (int w = 0; w < width_; ++w) mine[send_index_[s] * width_ + w] += outgoing_[s * width_ + w];
}

std::size_t SlabExchange::memory() const
{
  return bytes_of(owner_, first_, send_index_, outgoing_, incoming_, parts_);
}

}    // namespace bdh
