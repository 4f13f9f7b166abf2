// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// A Kokkos execution space's answers to "what differs between host and device".
#ifndef BDH_FIB_BACKEND_KOKKOS_H
#define BDH_FIB_BACKEND_KOKKOS_H

#include "base/device_kokkos.h"
#include "base/errors.h"
#include "fib/spread_kokkos.h"
#include "stokes/choice_kokkos.h"

namespace bdh {

/// Terms as Kokkos adds them.
template <class Term> struct SumOf {
  Term term;
  BDH_FN void operator()(long i, double &sum) const { sum += term(i); }
};

/// As HostBackend.  All arrays of FibFluid and BrownianStep are in the memory of Exec; one process.
template <class Exec> struct KokkosBackend {
  using Vector = DeviceArray<double, Exec>;
  using ParticleVector = DeviceArray<double, Exec>;
  using Flags = DeviceArray<char, Exec>;
  using Spreader = DeviceSpreader<Exec>;
  using Stokes = DeviceStokes<Exec>;

  static constexpr bool several_ranks = false;
  static constexpr bool sums_in_order = false;    // atomic additions

  template <class Action> static void for_each(const char *name, long n, const Action &action)
  {
    device_for<Exec>(name, n, action);
  }
  template <class Action> static double sum(const char *name, long n, const Action &action)
  {
    return device_sum<Exec>(name, n, SumOf<Action>{action});
  }
  template <class Condition> static long first(const char *name, long n, const Condition &condition)
  {
    return device_first<Exec>(name, n, condition);
  }
  static ParticleVector from_host(const std::vector<double> &v) { return ParticleVector(v); }
  static std::vector<double> to_host(const ParticleVector &v) { return v.to_host(); }
  static void clear(Flags &flags) { flags.clear_values(); }
  static void clear(Vector &field, const Workers &) { field.clear_values(); }

  static void check_positions(const Grid &grid, const double *x, long n, double slack)
  {
    const long bad = first("bdh::check_positions", n, positions_without_cell(grid, x, slack));
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
