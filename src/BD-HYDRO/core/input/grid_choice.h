// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// The grid of fix bd/fib for a box: as the user gives it, or for the radius of the particles.
#ifndef BDH_INPUT_GRID_CHOICE_H
#define BDH_INPUT_GRID_CHOICE_H

#include "grid/grid.h"
#include "input/options.h"

#include <array>

namespace bdh {

/// Returns the grid of a box: the one that the options give, or one with the spacing that gives the
/// requested radius.  It has walls where the box is not periodic.  Throws InvalidOption when the
/// kernel does not fit, or a wall is missing or out of place.
Grid choose_grid(const FibOptions &options, int dim, const std::array<double, 3> &lo,
                 const std::array<double, 3> &length, const std::array<bool, 3> &periodic);

/// Largest ratio of two spacings, minus 1: 0 for cubic cells.
double anisotropy(const Grid &grid);

}    // namespace bdh
#endif
