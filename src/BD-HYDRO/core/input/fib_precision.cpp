// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
#include "input/fib_precision.h"

#include "base/errors.h"
#include "stokes/choice.h"

namespace bdh {

namespace {

/// What single precision cannot do; empty if nothing.
std::string obstacle(const FibOptions &options, const Grid &grid, bool device)
{
  if (device) return "the device computes in double only";
  if (!solves_in_single(grid)) return "the iteration for the pressure between walls needs double";
  if (options.give_motions()) return "the iteration for motions that are given needs double";
  if (options.drift == DriftChoice::finite_difference)
    return "drift rfd takes differences that single precision would round away";
  return "";
}

}    // namespace

FibPrecision choose_precision(const FibOptions &options, const Grid &grid, bool device)
{
  const std::string why_not = obstacle(options, grid, device);
  if (options.precision == Precision::single_precision && !why_not.empty())
    throw InvalidOption("precision", "single", why_not + ": use precision auto or double");
  if (options.precision == Precision::single_precision) return {true, "as given"};
  if (options.precision == Precision::double_precision) return {false, "as given or by default"};
  if (!why_not.empty()) return {false, why_not};
  if (100.0 * single_round_off > radius_spread(options.kernel, grid.dim))
    return {false, "round-off of single precision would show beside the spread of the kernel"};
  return {true, "round-off is below 1/100 of the spread of the kernel"};
}

}    // namespace bdh
