// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Counts what this process sends with MPI's profiling interface, which is below the package's own
/// counters and shares nothing with them.  One source of a program includes this.
#ifndef BDH_TEST_MPI_TRAFFIC_H
#define BDH_TEST_MPI_TRAFFIC_H

#include "base/traffic.h"

#include <gtest/gtest.h>
#include <mpi.h>
#include <string>

namespace bdh_test {

/// What MPI has been asked to send, in the units of the package's counters.
struct SeenByMpi {
  bdh::Traffic traffic;
  bool paused = false;    ///< does not count what belongs to a test itself

  void message(int numbers, MPI_Datatype type, int to, MPI_Comm comm)
  {
    int me = 0, size = 0;
    PMPI_Comm_rank(comm, &me);
    PMPI_Type_size(type, &size);
    if (paused || to == me || numbers == 0) return;
    ++traffic.messages;
    traffic.bytes += static_cast<int64_t>(numbers) * size;
  }
  void sum(MPI_Comm comm)
  {
    if (!paused && ranks(comm) > 1) ++traffic.sums;
  }
  static int ranks(MPI_Comm comm)
  {
    int size = 0;
    PMPI_Comm_size(comm, &size);
    return size;
  }
};

inline SeenByMpi &seen_by_mpi()
{
  static SeenByMpi seen;
  return seen;
}

/// What `action` sends by the package's counters, which must be what MPI is asked to send.
template <class Action> bdh::Traffic sent_by(const std::string &what, Action action)
{
  const bdh::Traffic before = bdh::Traffic::mine(), seen_before = seen_by_mpi().traffic;
  action();
  const bdh::Traffic counted = bdh::Traffic::mine().since(before),
                     seen = seen_by_mpi().traffic.since(seen_before);
  EXPECT_EQ(counted.messages, seen.messages) << what;
  EXPECT_EQ(counted.bytes, seen.bytes) << what;
  EXPECT_EQ(counted.sums, seen.sums) << what;
  return counted;
}

}    // namespace bdh_test

extern "C" {

int MPI_Alltoallv(const void *from, const int *counts, const int *offsets, MPI_Datatype type,
                  void *to, const int *to_counts, const int *to_offsets, MPI_Datatype to_type,
                  MPI_Comm comm)
{
  for (int r = 0; r < bdh_test::SeenByMpi::ranks(comm); ++r)
    bdh_test::seen_by_mpi().message(counts[r], type, r, comm);
  return PMPI_Alltoallv(from, counts, offsets, type, to, to_counts, to_offsets, to_type, comm);
}

int MPI_Alltoall(const void *from, int count, MPI_Datatype type, void *to, int to_count,
                 MPI_Datatype to_type, MPI_Comm comm)
{
  for (int r = 0; r < bdh_test::SeenByMpi::ranks(comm); ++r)
    bdh_test::seen_by_mpi().message(count, type, r, comm);
  return PMPI_Alltoall(from, count, type, to, to_count, to_type, comm);
}

int MPI_Sendrecv(const void *from, int count, MPI_Datatype type, int destination, int tag, void *to,
                 int to_count, MPI_Datatype to_type, int source, int to_tag, MPI_Comm comm,
                 MPI_Status *status)
{
  bdh_test::seen_by_mpi().message(count, type, destination, comm);
  return PMPI_Sendrecv(from, count, type, destination, tag, to, to_count, to_type, source, to_tag,
                       comm, status);
}

int MPI_Send(const void *from, int count, MPI_Datatype type, int destination, int tag,
             MPI_Comm comm)
{
  bdh_test::seen_by_mpi().message(count, type, destination, comm);
  return PMPI_Send(from, count, type, destination, tag, comm);
}

int MPI_Allreduce(const void *mine, void *all, int count, MPI_Datatype type, MPI_Op operation,
                  MPI_Comm comm)
{
  bdh_test::seen_by_mpi().sum(comm);
  return PMPI_Allreduce(mine, all, count, type, operation, comm);
}

}    // extern "C"

#endif
