// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
#include "stokes/walls.h"

#include "base/errors.h"

namespace bdh {

std::string face_name(int axis, int side)
{
  return std::string(1, "xyz"[axis]) + (side ? "hi" : "lo");
}

namespace {

template <class Property> bool any_of(const WallOptions &walls, Property property)
{
  for (const auto &axis : walls.face)
    for (const WallOptions::Wall &w : axis)
      if (property(w)) return true;
  return false;
}

/// An open face needs Fourier modes in all other directions.
void refuse_open_beside_walls(const std::array<std::array<Boundary, 2>, 3> &b)
{
  for (std::size_t d = 0; d < 3; ++d)
    for (std::size_t side = 0; side < 2; ++side)
      for (std::size_t other = 0; other < 3; ++other)
        if (b[d][side] == Boundary::open && other != d && b[other][0] != Boundary::periodic)
          throw InvalidOption(
              "wall " + face_name(d, side), "open",
              std::string("the box is not periodic along ") + "xyz"[other] +
                  ", and behind an open face the fluid is known only for boxes that "
                  "are periodic in all other directions: use boundary p there, or "
                  "put a wall far away in place of the open face");
}

}    // namespace

bool WallOptions::any() const
{
  return any_of(*this, [](const Wall &w) { return w.kind != Boundary::periodic; });
}

bool WallOptions::any_moves() const
{
  return any_of(*this, [](const Wall &w) { return w.moves(); });
}

bool WallOptions::any_open() const
{
  return any_of(*this, [](const Wall &w) { return w.kind == Boundary::open; });
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
                                " noslip (or slip, or open), or use boundary p");
      b[axis][side] = kind;
    }
  }
  refuse_open_beside_walls(b);
  return b;
}

}    // namespace bdh
