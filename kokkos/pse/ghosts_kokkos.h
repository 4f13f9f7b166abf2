// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Entries of other ranks' particles in vectors in the memory of a device.
#ifndef BDH_PSE_GHOSTS_KOKKOS_H
#define BDH_PSE_GHOSTS_KOKKOS_H

#include "base/device_kokkos.h"
#include "base/phases.h"
#include "base/vector_kernel.h"
#include "pse/layout.h"
#include "pse/real_space.h"

#include <memory>

namespace bdh {

/// Collective.  Fills the entries from `owned` to `all` of v, `quads` quads each, with those of the
/// ranks that own them.  They travel through the host's memory, where LAMMPS sends them.
template <class Exec, class Real>
void fill_ghosts(GhostExchange &exchange, Real *v, int quads, long owned, long all)
{
  Exec().fence();
  const PhaseScope communicating(Phase::communicate);
  if constexpr (host_memory<Exec>) {
    exchange.forward(v, quads);
  } else {
    using Unmanaged = Kokkos::MemoryTraits<Kokkos::Unmanaged>;
    using Device = Kokkos::View<Real *, typename Exec::memory_space, Unmanaged>;
    using Host = Kokkos::View<Real *, Kokkos::HostSpace, Unmanaged>;
    const long width = static_cast<long>(quad) * quads, mine = width * owned,
               ghosts = width * all - mine;
    const std::unique_ptr<Real[]> host(new Real[width * all]);
    if (mine > 0) Kokkos::deep_copy(Host(host.get(), mine), Device(v, mine));
    exchange.forward(host.get(), quads);
    if (ghosts > 0) Kokkos::deep_copy(Device(v + mine, ghosts), Host(host.get() + mine, ghosts));
  }
}

}    // namespace bdh
#endif
