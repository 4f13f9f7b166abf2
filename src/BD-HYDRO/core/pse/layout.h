// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// How many numbers a particle, a pair and a grid point have in the arrays of positively split
/// Ewald; kernels may use them on a device.
#ifndef BDH_PSE_LAYOUT_H
#define BDH_PSE_LAYOUT_H

#include "base/portable.h"

namespace bdh {

/// Components of a vector in space: of a position, of the direction of a pair, of a field on the
/// grid.
constexpr int dim = 3;

/// Degrees of freedom of a particle: the numbers of its force, its velocity and its noise, which
/// follow each other in an array.  Particles translate; torques would add dim more.
constexpr int dof = dim;

/// Entries of a particle in vectors of the real-space part: its degrees of freedom and padding,
/// which is 0, so that a particle fills a vector register.  A pair stores its direction and one
/// more number in as many entries.
constexpr int slots = 4;
static_assert(slots > dof && slots > dim, "a pair needs the last slot, a particle its padding");

/// Where the numbers of a particle begin in a vector of the real-space part, and its coordinates in
/// an array of positions.
BDH_FN long first_slot(long particle) { return slots * particle; }
BDH_FN long first_coordinate(long particle) { return dim * particle; }

/// Numbers that scheme split keeps by atom of the last near noise: the noise, and 1 if there is
/// one.
constexpr int noise_entries = dof + 1;

}    // namespace bdh
#endif
