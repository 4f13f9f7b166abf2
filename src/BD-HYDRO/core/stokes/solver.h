// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Fluctuating steady Stokes equations on a staggered grid: the problem, and any solver of it.
#ifndef BDH_STOKES_SOLVER_H
#define BDH_STOKES_SOLVER_H

#include "grid/grid.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace bdh {

/// One set of random stresses: weight * sqrt(2 eta kT/(dt dV)) D~ W with W drawn for `stage`.
struct StressDraw {
  double weight;
  uint32_t stage;
};

/// Stands in for the generator, so that a test can measure M^(1/2) as a matrix.
class NormalSource {
 public:
  virtual ~NormalSource() = default;
  /// Four N(0,1) of the mode `index`.
  virtual void get(uint32_t stage, uint64_t index, double *z) const = 0;
};

/// Right-hand side and scales of one solve.
struct StokesProblem {
  double viscosity = 1.0;     ///< [mass/(length time)]
  double kT_over_dt = 0.0;    ///< [energy/time]; 0: no noise is drawn
  uint32_t seed = 0;
  uint64_t step = 0;
  std::vector<StressDraw> stress;    ///< added up; at most a few
  std::array<double, 3> body_force{
      0.0, 0.0, 0.0};             ///< uniform [force/volume]; has no effect where no wall holds it
  WallVectors wall_velocity{};    ///< of no-slip walls [length/time]; walls of a slit must be at
                                  ///< rest (WallMotion)
  double tolerance = 1e-8;        ///< relative residual, where the solver iterates
  const NormalSource *normals = nullptr;    ///< null: the counter-based generator

  bool noisy() const { return kT_over_dt > 0.0 && !stress.empty(); }
};

/// What a solve has to say.
struct SolveReport {
  int iterations = 0;
  double residual = 0.0;       ///< relative
  WallVectors wall_force{};    ///< on each wall: this rank's part [force], without the random
                               ///< stress, whose mean is 0
};

/// v = L^-1 f / eta + random velocity of covariance 2 kT/(eta dt dV) L^-1 (L^-1 as FIB eq. (29)).
class StokesSolver {
 public:
  virtual ~StokesSolver() = default;
  virtual Slab slab() const = 0;
  /// Doubles that each component's array must have.
  virtual std::size_t allocation() const = 0;
  /// Collective.  field: in f [force/volume], out v [length/time].
  virtual SolveReport solve(const FieldView &field, const StokesProblem &problem) = 0;
  /// Bytes on this rank.
  virtual std::size_t memory() const = 0;
};

}    // namespace bdh
#endif
