// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
#include "stokes/walls.h"

#include "base/errors.h"

namespace bdh {

std::string face_name(int axis, int side)
{
  return std::string(1, "xyz"[axis]) + (side ? "hi" : "lo");
}

bool WallOptions::any() const
{
  for (const auto &axis : face)
    for (const Wall &w : axis)
      if (w.kind != Boundary::periodic) return true;
  return false;
}

bool WallOptions::any_moves() const
{
  for (const auto &axis : face)
    for (const Wall &w : axis)
      if (w.moves()) return true;
  return false;
}

std::array<std::array<Boundary, 2>, 3>
WallOptions::boundary(int dim, const std::array<bool, 3> &periodic) const
{
  std::array<std::array<Boundary, 2>, 3> b{};
  for (int d = 0; d < 3; ++d) {
    const std::size_t axis = d;
    for (int side = 0; side < 2; ++side) {
      const Wall &wall = face[axis][side];
      const Boundary kind = wall.kind;
      if (dim == 2 && wall.velocity[2] != 0.0)
        throw InvalidOption("wall " + face_name(d, side) + " vz", wall.velocity[2],
                            "must be 0 in a two-dimensional simulation");
      const bool given = kind != Boundary::periodic;
      if (given && (periodic[axis] || d >= dim))
        throw InvalidOption("wall", face_name(d, side),
                            std::string("the box is periodic along ") + "xyz"[d] +
                                ": remove the wall, or use boundary f in that direction");
      if (!given && !periodic[axis])
        throw InvalidOption("wall " + face_name(d, side), "(not given)",
                            std::string("the box is not periodic along ") + "xyz"[d] +
                                ", so both faces need a wall: add wall " + face_name(d, side) +
                                " noslip (or slip), or use boundary p");
      b[axis][side] = kind;
    }
  }
  return b;
}

}    // namespace bdh
