// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// The walls and open faces that the user asks for.
#ifndef BDH_STOKES_WALLS_H
#define BDH_STOKES_WALLS_H

#include "grid/grid.h"

#include <array>
#include <string>

namespace bdh {

/// The keyword `wall`, which appears once for each face.
struct WallOptions {
  struct Wall {
    Boundary kind = Boundary::periodic;               ///< periodic: no wall given
    std::array<double, 3> velocity{0.0, 0.0, 0.0};    ///< [length/time], along the wall
    bool moves() const { return velocity[0] != 0.0 || velocity[1] != 0.0 || velocity[2] != 0.0; }
  };
  std::array<std::array<Wall, 2>, 3> face;    ///< [axis][lower, upper]

  bool any() const;
  bool any_moves() const;
  bool any_open() const;
  /// Boundary conditions of a box that is periodic in some directions.  Throws InvalidOption if a
  /// wall is missing or belongs to a periodic direction, or if there are open faces and more than
  /// one direction is not periodic.
  std::array<std::array<Boundary, 2>, 3> boundary(int dim,
                                                  const std::array<bool, 3> &periodic) const;
};

/// "xlo" .. "zhi"
std::string face_name(int axis, int side);

}    // namespace bdh
#endif
