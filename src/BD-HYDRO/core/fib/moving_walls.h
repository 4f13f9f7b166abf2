// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// The flow that moving walls drive.
#ifndef BDH_FIB_MOVING_WALLS_H
#define BDH_FIB_MOVING_WALLS_H

#include "base/strain_kernel.h"
#include "fib/ghost_kernel.h"
#include "fib/kernel_choice.h"
#include "fib/spread.h"
#include "fib/step_kernel.h"
#include "stokes/walls.h"

#include <algorithm>

namespace bdh {

/// A velocity that changes linearly along one axis, in a shear flow or between moving walls.
struct LinearFlow {
  int axis = 1;
  double origin = 0.0;                               ///< coordinate along the axis [length]
  std::array<double, 3> at_origin{0.0, 0.0, 0.0};    ///< [length/time]
  std::array<double, 3> gradient{0.0, 0.0, 0.0};     ///< [1/time]

  bool flows() const;
  /// velocity += this flow at positions x, 3 numbers for each particle.
  AddLinearFlow adder(const double *x, double *velocity) const;
  /// The rate of strain, in its strain_numbers [1/time].
  std::array<double, strain_numbers> strain() const;
  /// omega += half the vorticity of this flow, 3 numbers for each particle.
  AddToEach turner(double *omega) const;
};

/// What moving walls, or shear at an open face, add to the fluid of walls at rest.
///
/// In a slit the flow is known: Couette flow, or the motion of the only no-slip wall and the shear
/// above it.  It is simply
/// added, since kernels leave linear functions as they are, so that the solver would give the same.
/// In ducts and boxes the solver finds it, from the ghost values 2 V - v behind a wall of velocity
/// V.  A particle near the wall then lacks 2 V times its weight behind the wall.  Behind an edge of
/// two no-slip walls the fluid is mirrored twice, and no velocity of the walls is left: so walls
/// that all move together carry the fluid along.
class WallMotion {
 public:
  WallMotion() = default;    ///< walls at rest
  /// shear_rate: in a box with an open face, that of a flow along x [1/time].  It grows with the
  /// distance from the wall, or from the lower to the upper of two open faces.
  WallMotion(const WallOptions &walls, const Grid &grid, IbKernel kernel, double shear_rate = 0.0);

  /// The flow in a slit; zero in all other boxes.
  const LinearFlow &known_flow() const { return flow_; }
  /// Velocities of the walls whose flow is left to the solver [length/time].
  const WallVectors &left_to_solver() const { return velocity_; }
  /// Calls action(adder) for what interpolation of the solver's flow lacks, if anything.  adder(i)
  /// adds it to the velocity (3 per particle) of particle i at x (3 per particle), between the
  /// walls.
  template <class Action> void for_adders(const double *x, double *velocity, Action action) const
  {
    if (flow_.flows()) action(flow_.adder(x, velocity));
    if (!solved_) return;
    with_kernel(kernel_, [&](auto kernel) {
      action(AddGhostVelocity<decltype(kernel)>{ghosts(x, velocity)});
    });
  }

  /// The same for angular velocities, where interpolation lacks half the curl of the ghost values.
  template <class Action> void for_turners(const double *x, double *omega, Action action) const
  {
    if (flow_.flows()) action(flow_.turner(omega));
    if (!solved_) return;
    with_turning_kernel(kernel_, grid_.dim, [&](auto kernel, auto) {
      action(AddGhostRotation<decltype(kernel)>{ghosts(x, omega)});
    });
  }

 private:
  GhostsOfWalls ghosts(const double *x, double *to) const
  {
    GhostsOfWalls g{grid_.dim, {}, {}, x, to};
    for (int axis = 0; axis < 3; ++axis) {
      g.axis[axis] = axis_lines(grid_, axis);
      for (int side = 0; side < 2; ++side)
        std::copy_n(velocity_[axis][side].data(), 3, g.V[axis][side]);
    }
    return g;
  }

  LinearFlow flow_;
  bool solved_ = false;
  WallVectors velocity_{};
  Grid grid_;
  IbKernel kernel_ = IbKernel::peskin4;
};

}    // namespace bdh
#endif
