// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// The periodic RPY mobility by direct Ewald sums: the reference that the fast operator is tested
/// against.
///
/// M_ij = 1/(viscosity V) sum over k != 0 of e^(i k.(x_i - x_j)) sinc^2(k a)/k^2 (I - k k^T/k^2)
/// [PSE (8)] for any cell, any overlap and positions anywhere.  Both sums of the split form (9),
/// (10) are carried until what is left of them is below 1e-15 of 1/(6 pi viscosity a), in every
/// entry.
#ifndef BDH_ORACLE_DENSE_RPY_H
#define BDH_ORACLE_DENSE_RPY_H

#include "grid/cell_kernel.h"

#include <vector>

namespace bdh {

/// Symmetric 3n x 3n matrices, row-major, x, y, z interleaved   [velocity/force]
struct DenseSplit {
  std::vector<double> real,
      wave;    // M^(r) and M^(w) of PSE (9), (10); each is positive semidefinite
};

/// \param x   3n coordinates [length];  viscosity [mass/(length time)];  xi [1/length]
DenseSplit dense_split(const Cell &cell, const double *x, long n, double radius, double viscosity,
                       double xi);

/// M, which does not depend on xi; it is chosen for speed.  O(n^2) time (a second for n = 500) and
/// memory.
std::vector<double> dense_mobility(const Cell &cell, const double *x, long n, double radius,
                                   double viscosity);

/// velocity := M force, without the matrix: O(n) memory, O(n^2) time.  velocity must not alias
/// force.
void dense_apply(const Cell &cell, const double *x, long n, double radius, double viscosity,
                 const double *force, double *velocity);

}    // namespace bdh
#endif
