// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// How many numbers a particle, a pair and a grid point have in the arrays of positively split
/// Ewald; kernels may use them on a device.
#ifndef BDH_PSE_LAYOUT_H
#define BDH_PSE_LAYOUT_H

#include "base/moments_kernel.h"
#include "base/portable.h"

namespace bdh {

/// Components of a vector in space: of a position, of the direction of a pair, of a field on the
/// grid.
constexpr int dim = 3;

/// The numbers of a particle's force, of its velocity and of its noise, which follow each other in
/// an array.  Torques and angular velocities have arrays of their own, with as many.
constexpr int dof = dim;

/// Vectors of the real-space part hold the numbers of a particle in quads: three numbers and a
/// fourth, which is 0, so that a quad fills a vector register.  The first quad translates, the
/// second one, if there is one, rotates.
constexpr int quad = 4;
constexpr int slots = quad;
static_assert(slots > dof && slots > dim, "a pair needs the last slot, a particle its padding");

/// Slots of a particle with a stresslet: force, torque and the five numbers of the stresslet follow
/// each other, and the last slot holds 0.
constexpr int strain_slots = 3 * quad;

/// Where the numbers of a particle begin in a vector of the real-space part, and its coordinates in
/// an array of positions.
BDH_FN long first_slot(long particle) { return slots * particle; }
BDH_FN long first_coordinate(long particle) { return dim * particle; }

/// Numbers that scheme split keeps by atom of the last near noise: the noise, and the length of its
/// near step, or 0 if there is none.
constexpr int noise_entries = dof + 1;
/// Of the force where the last near step began: the force, and 1 if there is one.
constexpr int force_entries = dof + 1;

}    // namespace bdh
#endif
