// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
#include "bdh_wall_options.h"

#include "bdh_errors.h"
#include "bdh_options.h"

namespace bdh {

std::string face_name(int axis, int side) { return std::string(1, "xyz"[axis]) + (side ? "hi" : "lo"); }

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

void WallOptions::parse(ArgumentReader &in)
{
  const std::string name = in.word("wall");
  int axis = -1, side = 0;
  for (int d = 0; d < 3; ++d)
    for (int s = 0; s < 2; ++s)
      if (name == face_name(d, s)) {
        axis = d;
        side = s;
      }
  if (axis < 0) throw InvalidOption("wall", name, "the face must be xlo, xhi, ylo, yhi, zlo or zhi");
  const std::string what = "wall " + name, kind = in.word(what);
  Wall &w = face[static_cast<std::size_t>(axis)][static_cast<std::size_t>(side)];
  if (w.kind != Boundary::periodic) throw InvalidOption("wall", name, "this face has a wall already");
  if (kind != "noslip" && kind != "slip") throw InvalidOption(what, kind, "must be noslip or slip");
  w.kind = kind == "noslip" ? Boundary::noslip : Boundary::slip;
  if (!in.number_follows()) return;
  for (int d = 0; d < 3; ++d) w.velocity[static_cast<std::size_t>(d)] = in.number(what + " v" + "xyz"[d]);
  const double normal = w.velocity[static_cast<std::size_t>(axis)];
  if (normal != 0.0)
    throw InvalidOption(what + " v" + "xyz"[axis], normal, "a wall can only move along itself: give 0");
  if (w.kind == Boundary::slip && w.moves())
    throw InvalidOption(what, kind, "a wall without friction cannot drag the fluid: leave its velocity out");
}

std::array<std::array<Boundary, 2>, 3> WallOptions::boundary(int dim, const std::array<bool, 3> &periodic) const
{
  std::array<std::array<Boundary, 2>, 3> b{};
  for (int d = 0; d < 3; ++d) {
    const std::size_t axis = static_cast<std::size_t>(d);
    for (int side = 0; side < 2; ++side) {
      const Wall &wall = face[axis][static_cast<std::size_t>(side)];
      const Boundary kind = wall.kind;
      if (dim == 2 && wall.velocity[2] != 0.0)
        throw InvalidOption("wall " + face_name(d, side) + " vz", wall.velocity[2], "must be 0 in a two-dimensional simulation");
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
      b[axis][static_cast<std::size_t>(side)] = kind;
    }
  }
  return b;
}

}    // namespace bdh
