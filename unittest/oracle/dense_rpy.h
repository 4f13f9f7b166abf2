// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// The periodic RPY mobility by direct Ewald sums, as a reference for tests of the fast operator:
///     M_ij = 1/(viscosity V) sum over k != 0 of e^(i k.(x_i - x_j)) sinc^2(k a)/k^2 (I - k
///     k^T/k^2),
/// PSE (8), for any cell, any overlap and positions anywhere.  Both sums of the split form (9),
/// (10) continue until the truncation error of every entry is below 1e-15 of 1/(6 pi viscosity a).
#ifndef BDH_ORACLE_DENSE_RPY_H
#define BDH_ORACLE_DENSE_RPY_H

#include "grid/cell_kernel.h"

#include <vector>

namespace bdh {

/// Symmetric 3n x 3n matrices, row-major, x, y, z interleaved [velocity/force].
struct DenseSplit {
  std::vector<double> real;    // M^(r) of PSE (9)
  std::vector<double> wave;    // M^(w) of PSE (10); both are positive semidefinite
};

/// \param x   3n coordinates [length];  viscosity [mass/(length time)];  xi [1/length]
DenseSplit dense_split(const Cell &cell, const double *x, long n, double radius, double viscosity,
                       double xi);

/// M, which does not depend on xi; xi is chosen for speed.  Takes O(n^2) time (a second for
/// n = 500) and memory.
std::vector<double> dense_mobility(const Cell &cell, const double *x, long n, double radius,
                                   double viscosity);

/// velocity := M force without the matrix, in O(n) memory and O(n^2) time.  velocity must not alias
/// force.
void dense_apply(const Cell &cell, const double *x, long n, double radius, double viscosity,
                 const double *force, double *velocity);

}    // namespace bdh
#endif
