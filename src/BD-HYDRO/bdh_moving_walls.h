/// The flow that moving walls drive.
#ifndef BDH_MOVING_WALLS_H
#define BDH_MOVING_WALLS_H

#include "bdh_spread.h"
#include "bdh_step_kernel.h"
#include "bdh_wall_options.h"

namespace bdh {

/// Velocity that changes linearly along one axis: of a shear flow, or between moving walls.
struct LinearFlow {
  int axis = 1;
  double origin = 0.0;                                  ///< coordinate along the axis [length]
  std::array<double, 3> at_origin{0.0, 0.0, 0.0};       ///< [length/time]
  std::array<double, 3> gradient{0.0, 0.0, 0.0};        ///< [1/time]

  bool flows() const;
  /// velocity += that at positions x, 3 numbers for each particle.
  AddLinearFlow adder(const double *x, double *velocity) const;
};

/// What moving walls add to the fluid of walls at rest.
///
/// In a slit the flow is known: Couette flow, or the motion of the only no-slip wall.  It is what the solver would give,
/// since kernels leave linear functions as they are, and is simply added.
/// In ducts and boxes the solver finds it, from the ghost values 2 V - v behind a wall of velocity V.  What a particle
/// near the wall lacks then is 2 V times its weight behind the wall.  Behind an edge of two no-slip walls the fluid is
/// mirrored twice, and no velocity of the walls is left: so walls that all move together carry the fluid along.
class WallMotion {
 public:
  WallMotion() = default;    ///< walls at rest
  WallMotion(const WallOptions &walls, const Grid &grid, IbKernel kernel);

  /// Of a slit; zero otherwise.
  const LinearFlow &known_flow() const { return flow_; }
  /// Velocities of the walls whose flow is left to the solver [length/time].
  const WallVectors &left_to_solver() const { return velocity_; }
  /// velocity (3 n) += what the interpolation of the solver's flow lacks at x (3 n), between the walls.
  void add(const double *x, long n, double *velocity) const;

 private:
  template <class Kernel> void add_ghosts(const double *x, long n, double *velocity) const;

  LinearFlow flow_;
  bool solved_ = false;
  WallVectors velocity_{};
  Grid grid_;
  IbKernel kernel_ = IbKernel::peskin4;
};

}    // namespace bdh
#endif
