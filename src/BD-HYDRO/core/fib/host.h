// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// What differs between host and device in the fluid of the immersed-boundary method.
#ifndef BDH_FIB_HOST_H
#define BDH_FIB_HOST_H

#include "base/execution.h"
#include "fib/spread.h"
#include "grid/grid.h"
#include "grid/slabs.h"
#include "stokes/choice.h"

namespace bdh {

/// Names the execution, the arrays of a grid, the spreading and the solvers.  FibFluid and
/// BrownianStep are templates over it; kokkos/fib/on_device_kokkos.h has the one of a device.
/// Number: the type of the grid's numbers, float or double.
template <class Number> struct FibOnHostIn {
  using Execution = HostExecution;
  using Real = Number;
  using Vector = AlignedArray<Real>;    ///< the array of a grid
  using ParticleVector = Execution::ParticleVector;
  using Spreader = HostSpreader<Real>;
  using Stokes = AnyStokes<Real>;
  using Exchange = ParticleExchange;      ///< carries particles to the parts of other ranks
  using InSingle = FibOnHostIn<float>;    ///< with a grid in single precision; void: there is none

  static constexpr bool sums_in_order = true;    ///< results are the same bit for bit in every run

  /// See bdh::check_positions().
  static void check_positions(const Execution &, const Grid &grid, const double *x, long n,
                              double slack)
  {
    bdh::check_positions(grid, x, n, slack);
  }
};
using FibOnHost = FibOnHostIn<double>;

/// Round-off of M with a grid in single precision, relative to the mobility of one particle: the
/// largest that test_single_host finds, rounded up.
constexpr double single_round_off = 5e-7;

}    // namespace bdh
#endif
