/// The walls that the user asks for, and their flow.
#ifndef BDH_WALL_OPTIONS_H
#define BDH_WALL_OPTIONS_H

#include "bdh_types.h"

#include <array>
#include <string>

namespace bdh {

class ArgumentReader;

/// Keyword wall, once per face.
struct WallOptions {
  struct Wall {
    Boundary kind = Boundary::periodic;                 ///< periodic: not given
    std::array<double, 3> velocity{0.0, 0.0, 0.0};      ///< [length/time], along the wall
    bool moves() const { return velocity[0] != 0.0 || velocity[1] != 0.0 || velocity[2] != 0.0; }
  };
  std::array<std::array<Wall, 2>, 3> face;              ///< [axis][lower, upper]

  bool any() const;
  bool any_moves() const;
  /// Reads FACE noslip|slip [vx vy vz].  Throws InvalidOption.
  void parse(ArgumentReader &in);
  /// The boundary of a box whose directions are periodic or not.  Throws InvalidOption for walls that are missing, stand
  /// in a periodic direction, or move where the flow of moving walls is not known in closed form.
  std::array<std::array<Boundary, 2>, 3> boundary(int dim, const std::array<bool, 3> &periodic) const;
};

/// "xlo" .. "zhi"
std::string face_name(int axis, int side);

/// Velocity that changes linearly along one axis: of a shear flow, or between moving walls.
struct LinearFlow {
  int axis = 1;
  double origin = 0.0;                                  ///< coordinate along the axis [length]
  std::array<double, 3> at_origin{0.0, 0.0, 0.0};       ///< [length/time]
  std::array<double, 3> gradient{0.0, 0.0, 0.0};        ///< [1/time]

  bool flows() const;
  /// velocity += that at positions x; n particles, 3 numbers each.
  void add(const double *x, long n, double *velocity) const;
};

/// Couette flow between the walls of a slit, or the motion of its only no-slip wall.  It is what the solver would give:
/// kernels leave linear functions as they are, with the ghost values behind a moving wall too.
LinearFlow wall_flow(const WallOptions &walls, const Grid &grid);

}    // namespace bdh
#endif
