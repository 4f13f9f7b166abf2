// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Messages between ranks from and to arrays of a device.
#ifndef BDH_BASE_MESSAGES_KOKKOS_H
#define BDH_BASE_MESSAGES_KOKKOS_H

#include "base/bytes_of.h"
#include "base/comm.h"
#include "base/device_kokkos.h"
#include "base/phases.h"

#include <vector>

namespace bdh {

/// Whether MPI may be given pointers to the memory of a GPU.  The user tells the KOKKOS package,
/// which tests it; the fixes set it before their first message.
inline bool &mpi_reads_device()
{
  static bool reads = false;
  return reads;
}

/// The numbers go through the host's memory unless MPI reads the device's.
template <class Real, class Exec> class DeviceMessages {
 public:
  explicit DeviceMessages(const Comm &comm) : comm_(comm) {}
  const Comm &comm() const { return comm_; }

  /// Collective.  All ranks send to all.  from, to: device pointers to as many numbers as the sizes
  /// add up to.
  void exchange(const Real *from, const MessageSizes &sizes, Real *to, const MessageSizes &to_sizes)
  {
    deliver(from, sizes.total(), to, to_sizes.total(), [&](const Real *sent, Real *received) {
      comm_.exchange(sent, sizes, received, to_sizes);
    });
  }
  /// Sends `size` numbers to one rank and gets as many from another.
  void shift(const Real *from, int destination, Real *to, int source, long size)
  {
    deliver(from, size, to, size, [&](const Real *sent, Real *received) {
      comm_.shift(sent, destination, received, source, size);
    });
  }

  std::size_t memory() const { return bytes_of(from_, to_); }

 private:
  using Unmanaged = Kokkos::MemoryTraits<Kokkos::Unmanaged>;
  using Host = Kokkos::View<Real *, Kokkos::HostSpace, Unmanaged>;
  using Device = Kokkos::View<Real *, typename Exec::memory_space, Unmanaged>;
  using ConstDevice = Kokkos::View<const Real *, typename Exec::memory_space, Unmanaged>;

  template <class Send>
  void deliver(const Real *from, std::size_t sent, Real *to, std::size_t received, const Send &send)
  {
    Exec().fence();    // the time of kernels before is theirs
    const PhaseScope communicating(Phase::communicate);
    if (host_memory<Exec> || mpi_reads_device()) return send(from, to);
    from_.resize(sent);
    to_.resize(received);
    if (sent) Kokkos::deep_copy(Host(from_.data(), sent), ConstDevice(from, sent));
    send(from_.data(), to_.data());
    if (received) Kokkos::deep_copy(Device(to, received), Host(to_.data(), received));
  }

  Comm comm_;
  std::vector<Real> from_, to_;    // on the host
};

}    // namespace bdh
#endif
