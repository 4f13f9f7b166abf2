// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Fluctuating steady Stokes equations on a staggered grid: the problem and the solver interface.
#ifndef BDH_STOKES_SOLVER_H
#define BDH_STOKES_SOLVER_H

#include "grid/field.h"
#include "grid/grid.h"
#include "grid/parts.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace bdh {

/// One set of random stresses, weight * sqrt(2 eta kT/(dt dV)) D~ W, with W drawn for `stage`.
struct StressDraw {
  double weight;
  uint32_t stage;
};

/// Replaces the random number generator, so that a test can measure M^(1/2) as a matrix.
class NormalSource {
 public:
  virtual ~NormalSource() = default;
  /// Four N(0,1) numbers for the mode `index`.
  virtual void get(uint32_t stage, uint64_t index, double *z) const = 0;
};

/// Right-hand side and parameters of one solve.
struct StokesProblem {
  double viscosity = 1.0;     ///< [mass/(length time)]
  double kT_over_dt = 0.0;    ///< [energy/time]; 0: no noise is drawn
  uint32_t seed = 0;
  uint64_t step = 0;
  std::vector<StressDraw> stress;    ///< a few sets, which are added up
  /// Uniform [force/volume].  It has no effect unless a wall balances it.
  std::array<double, 3> body_force{0.0, 0.0, 0.0};
  /// Velocities of no-slip walls [length/time].  Walls of a slit must be at rest (see WallMotion).
  WallVectors wall_velocity{};
  double tolerance = 1e-8;                  ///< relative residual for solvers that iterate
  const NormalSource *normals = nullptr;    ///< null: the counter-based generator

  bool noisy() const { return kT_over_dt > 0.0 && !stress.empty(); }
};

/// Outcome of a solve.
struct SolveReport {
  int iterations = 0;
  double residual = 0.0;    ///< relative
  /// This rank's part of the force on each wall [force], without the random stress (mean 0).
  WallVectors wall_force{};
};

/// v = L^-1 f / eta + random velocity of covariance 2 kT/(eta dt dV) L^-1, with the L^-1 of
/// FIB eq. (29).  Real: the type of the grid's numbers.
template <class Real> class StokesSolver {
 public:
  virtual ~StokesSolver() = default;
  /// The part of the grid that each rank has.
  virtual const GridParts &parts() const = 0;
  Slab slab() const { return parts().planes(); }
  /// Length that the array of each component must have.
  virtual std::size_t allocation() const = 0;
  /// Collective.  field: on entry f [force/volume], on return v [length/time]
  virtual SolveReport solve(const FieldOf<Real> &field, const StokesProblem &problem) = 0;
  /// Bytes allocated on this rank.
  virtual std::size_t memory() const = 0;
};

}    // namespace bdh
#endif
