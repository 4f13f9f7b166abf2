// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Whether the grid of fix bd/fib is in single or in double precision, and why.
#ifndef BDH_INPUT_FIB_PRECISION_H
#define BDH_INPUT_FIB_PRECISION_H

#include "fib/host.h"
#include "grid/grid.h"
#include "input/options.h"

#include <string>

namespace bdh {

/// Type of the numbers of a grid, its transforms and its noise.  All of particles is double.
struct FibPrecision {
  bool single = false;
  std::string reason;    ///< for the plan
};

/// `automatic` is single where single_round_off is below 1/100 of the kernel's spread and nothing
/// in the options or in the walls needs double.  device: the fluid is on a device, which has only
/// double.  Throws InvalidOption if single is asked for and impossible.
FibPrecision choose_precision(const FibOptions &options, const Grid &grid, bool device);

}    // namespace bdh
#endif
