// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// What differs between host and device in the fluid of the immersed-boundary method: the device.
#ifndef BDH_FIB_ON_DEVICE_KOKKOS_H
#define BDH_FIB_ON_DEVICE_KOKKOS_H

#include "base/errors.h"
#include "base/execution_kokkos.h"
#include "fib/spread_kokkos.h"
#include "grid/slabs_kokkos.h"
#include "stokes/choice_kokkos.h"

namespace bdh {

/// The members mean the same as those of FibOnHost.  All arrays of FibFluid and BrownianStep are in
/// the memory of Exec.
template <class Exec> struct FibOnDevice {
  using Execution = DeviceExecution<Exec>;
  using Real = double;
  using Vector = DeviceArray<Real, Exec>;
  using ParticleVector = typename Execution::ParticleVector;
  using Spreader = DeviceSpreader<Exec>;
  using Stokes = DeviceStokes<Exec>;
  using Exchange = DeviceSlabExchange<Exec>;
  using InSingle = void;

  static constexpr bool sums_in_order = false;    // atomic additions come in any order

  static void check_positions(const Execution &execution, const Grid &grid, const double *x, long n,
                              double slack)
  {
    const long bad =
        execution.first("bdh::check_positions", n, positions_without_cell(grid, x, slack));
    if (bad < 0) return;
    double q[3];
    Kokkos::View<const double *, typename Exec::memory_space,
                 Kokkos::MemoryTraits<Kokkos::Unmanaged>>
        there(x + 3 * bad, 3);
    Kokkos::deep_copy(
        Kokkos::View<double *, Kokkos::HostSpace, Kokkos::MemoryTraits<Kokkos::Unmanaged>>(q, 3),
        there);
    try {
      bdh::check_positions(grid, q, 1, slack);
    } catch (const BadParticle &e) {
      throw BadParticle(bad, e.what());
    }
  }
};

}    // namespace bdh
#endif
