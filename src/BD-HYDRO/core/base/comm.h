// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Message passing: the only part of the core that includes mpi.h.
#ifndef BDH_BASE_COMM_H
#define BDH_BASE_COMM_H

#include <memory>
#include <mpi.h>
#include <vector>

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

/// How much a rank sends to, or gets from, each of them, as MPI takes it.
struct MessageSizes {
  std::vector<int> count, offset;
  /// items: of each rank, `width` numbers each.  Throws std::length_error if all together are too
  /// many for MPI.
  MessageSizes(const std::vector<int> &items, long width);
  std::size_t total() const { return count.empty() ? 0 : offset.back() + count.back(); }
};

/// A communicator that somebody else owns, or one from split(), which is freed with its last copy.
///
/// What is sent is counted (base/traffic.h).  Sums are of int, int64_t or double; messages are of
/// float, double or complex numbers of them, in the memory of a device if MPI reads that.
class Comm {
 public:
  explicit Comm(MPI_Comm handle);
  MPI_Comm handle() const { return handle_; }
  int rank() const { return rank_; }
  int size() const { return size_; }
  /// Collective.  The ranks that give the same color, in the same order.
  Comm split(int color) const;
  /// Collective.  The sum over ranks, the same on all.
  double sum(double mine) const;
  double greatest(double mine) const;    ///< the same for the greatest number
  /// Collective.  all[i] := the sum of mine[i] over ranks, for i < n.
  template <class Number> void sum(const Number *mine, Number *all, int n) const;

  /// Collective.  All ranks send to all.  from, to: as many numbers as the sizes add up to.
  template <class Number> void exchange(const Number *from, const MessageSizes &sizes, Number *to,
                                        const MessageSizes &to_sizes) const;
  /// Collective.  to[r] := the number that rank r has for this one, from[r] being that for rank r.
  void exchange(const std::vector<int> &from, std::vector<int> &to) const;
  /// Sends `size` numbers to one rank and gets as many from another.
  template <class Number>
  void shift(const Number *from, int destination, Number *to, int source, long size) const;

 private:
  template <class Number> void count_message(int rank, long numbers) const;

  MPI_Comm handle_;
  int rank_, size_;
  std::shared_ptr<void> owned_;    // frees the handle
};

/// Collective.  True if `mine` is true on any rank.
bool any_rank(const Comm &comm, bool mine);

}    // namespace bdh
#endif
