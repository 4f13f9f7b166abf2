// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
#include "base/comm.h"

#include "base/phases.h"
#include "base/traffic.h"

#include <algorithm>
#include <complex>
#include <cstdint>
#include <limits>
#include <stdexcept>

namespace bdh {

Comm::Comm(MPI_Comm handle) : handle_(handle)
{
  MPI_Comm_rank(handle, &rank_);
  MPI_Comm_size(handle, &size_);
}

Comm Comm::split(int color) const
{
  MPI_Comm handle;
  MPI_Comm_split(handle_, color, rank_, &handle);
  Comm part(handle);
  part.owned_ =
      std::shared_ptr<void>(nullptr, [handle](void *) mutable { MPI_Comm_free(&handle); });
  return part;
}

namespace {

MPI_Datatype mpi_type(int) { return MPI_INT; }
MPI_Datatype mpi_type(int64_t) { return MPI_LONG_LONG; }
MPI_Datatype mpi_type(float) { return MPI_FLOAT; }
MPI_Datatype mpi_type(double) { return MPI_DOUBLE; }
MPI_Datatype mpi_type(std::complex<float>) { return MPI_C_FLOAT_COMPLEX; }
MPI_Datatype mpi_type(std::complex<double>) { return MPI_C_DOUBLE_COMPLEX; }

/// all[i] := mine[i] of all ranks put together by `operation`, for i < n.
template <class Number>
void reduce(MPI_Comm handle, const Number *mine, Number *all, int n, MPI_Op operation)
{
  const PhaseScope reducing(Phase::communicate);
  ++Traffic::mine().sums;
  // LAMMPS' stand-in takes no const.
  MPI_Allreduce(const_cast<Number *>(mine), all, n, mpi_type(Number()), operation, handle);
}

}    // namespace

template <class Number> void Comm::sum(const Number *mine, Number *all, int n) const
{
  if (size_ == 1)
    std::copy_n(mine, n, all);
  else
    reduce(handle_, mine, all, n, MPI_SUM);
}

double Comm::sum(double mine) const
{
  double all = 0.0;
  sum(&mine, &all, 1);
  return all;
}

double Comm::greatest(double mine) const
{
  if (size_ == 1) return mine;
  double all = 0.0;
  reduce(handle_, &mine, &all, 1, MPI_MAX);
  return all;
}

bool any_rank(const Comm &comm, bool mine)
{
  if (comm.size() == 1) return mine;
  int flag = mine, any = 0;
  reduce(comm.handle(), &flag, &any, 1, MPI_MAX);
  return any != 0;
}

/// Nothing is sent to this rank itself, nor where there are no numbers.
template <class Number> void Comm::count_message(int rank, long numbers) const
{
  if (rank != rank_ && numbers > 0) Traffic::mine().add_message(numbers * sizeof(Number));
}

template <class Number> void Comm::exchange(const Number *from, const MessageSizes &sizes,
                                            Number *to, const MessageSizes &to_sizes) const
{
  const PhaseScope exchanging(Phase::communicate);
  for (int r = 0; r < size_; ++r) count_message<Number>(r, sizes.count[r]);
  MPI_Alltoallv(const_cast<Number *>(from), const_cast<int *>(sizes.count.data()),
                const_cast<int *>(sizes.offset.data()), mpi_type(Number()), to,
                const_cast<int *>(to_sizes.count.data()), const_cast<int *>(to_sizes.offset.data()),
                mpi_type(Number()), handle_);
}

void Comm::exchange(const std::vector<int> &from, std::vector<int> &to) const
{
  const PhaseScope exchanging(Phase::communicate);
  for (int r = 0; r < size_; ++r) count_message<int>(r, 1);
  MPI_Alltoall(const_cast<int *>(from.data()), 1, MPI_INT, to.data(), 1, MPI_INT, handle_);
}

template <class Number>
void Comm::shift(const Number *from, int destination, Number *to, int source, long size) const
{
  const PhaseScope shifting(Phase::communicate);
  count_message<Number>(destination, size);
  MPI_Sendrecv(from, size, mpi_type(Number()), destination, 0, to, size, mpi_type(Number()), source,
               0, handle_, MPI_STATUS_IGNORE);
}

/// The running sum is a scalar on purpose.  If it is written as offset[r] = offset[r-1] +
/// count[r-1] for both directions in one loop, g++ 12.2 -O3 (loop distribution) leaves zeros in the
/// second array.
MessageSizes::MessageSizes(const std::vector<int> &items, long width)
{
  long sum = 0;
  for (int n : items) {
    count.push_back(n * width);
    offset.push_back(sum);
    sum += n * width;
  }
  if (sum > std::numeric_limits<int>::max())
    throw std::length_error(
        "a process has more than 2^31 numbers of a grid or of particles to send: "
        "MPI cannot count them, so take more processes");
}

template void Comm::sum(const int *, int *, int) const;
template void Comm::sum(const int64_t *, int64_t *, int) const;
template void Comm::sum(const double *, double *, int) const;

template void Comm::exchange(const float *, const MessageSizes &, float *,
                             const MessageSizes &) const;
template void Comm::exchange(const double *, const MessageSizes &, double *,
                             const MessageSizes &) const;
template void Comm::exchange(const std::complex<float> *, const MessageSizes &,
                             std::complex<float> *, const MessageSizes &) const;
template void Comm::exchange(const std::complex<double> *, const MessageSizes &,
                             std::complex<double> *, const MessageSizes &) const;
template void Comm::shift(const float *, int, float *, int, long) const;
template void Comm::shift(const double *, int, double *, int, long) const;

}    // namespace bdh
