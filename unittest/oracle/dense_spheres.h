// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// The periodic mobility of spheres of any radii, with rotation, by direct Ewald sums, as a
/// reference for tests of the fast operator.  Every pair has its own shapes: nothing is shared with
/// the two shape functions of pse/shapes_kernel.h.
#ifndef BDH_ORACLE_DENSE_SPHERES_H
#define BDH_ORACLE_DENSE_SPHERES_H

#include "grid/cell_kernel.h"

#include <vector>

namespace bdh {

/// The 6n x 6n matrix, row-major: all velocities (x, y, z of each sphere), then all angular
/// velocities, by all forces, then all torques.  Truncation errors are below 1e-12 of the entries'
/// own scale.  Takes O(n^2) time: 10 s for n = 100.
/// \param x   3n coordinates [length];  radius: n;  viscosity [mass/(length time)]
std::vector<double> dense_spheres(const Cell &cell, const std::vector<double> &x,
                                  const std::vector<double> &radius, double viscosity);

}    // namespace bdh
#endif
