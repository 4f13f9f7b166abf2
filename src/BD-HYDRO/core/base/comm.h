// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Message passing: the only part of the core that includes mpi.h.
#ifndef BDH_BASE_COMM_H
#define BDH_BASE_COMM_H

#include <mpi.h>

// LAMMPS' stand-in for MPI, used in builds for one process.  It lacks names that this package
// uses, and its arguments are not const.  Nothing is sent, but copies need the number of bytes.
#ifdef MPI_STUBS
#define MPI_C_FLOAT_COMPLEX MPI_DOUBLE
#define MPI_C_DOUBLE_COMPLEX MPI_DOUBLE_INT
#ifndef MPI_BOR
#define MPI_BOR MPI_SUM
#endif
#endif

namespace bdh {

/// A communicator that somebody else owns.  It is not freed here.
class Comm {
 public:
  explicit Comm(MPI_Comm handle);
  MPI_Comm handle() const { return handle_; }
  int rank() const { return rank_; }
  int size() const { return size_; }
  /// Collective.  The sum over ranks, the same on all.
  double sum(double mine) const;
  double greatest(double mine) const;    ///< the same for the greatest number

 private:
  MPI_Comm handle_;
  int rank_, size_;
};

/// Collective.  True if `mine` is true on any rank.
bool any_rank(const Comm &comm, bool mine);

}    // namespace bdh
#endif
