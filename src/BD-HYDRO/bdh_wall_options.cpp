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
  int walled = 0;
  for (int d = 0; d < 3; ++d) {
    const std::size_t axis = static_cast<std::size_t>(d);
    if (!periodic[axis]) ++walled;
    for (int side = 0; side < 2; ++side) {
      const Boundary kind = face[axis][static_cast<std::size_t>(side)].kind;
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
  if (walled > 1 && any_moves())
    throw InvalidOption("wall velocities", "not zero",
                        "walls may move only where the other directions are periodic: leave the velocities out");
  return b;
}

bool LinearFlow::flows() const
{
  for (std::size_t d = 0; d < 3; ++d)
    if (at_origin[d] != 0.0 || gradient[d] != 0.0) return true;
  return false;
}

void LinearFlow::add(const double *x, long n, double *velocity) const
{
  if (!flows()) return;
  for (long i = 0; i < n; ++i)
    for (int d = 0; d < 3; ++d) {
      const std::size_t c = static_cast<std::size_t>(d);
      velocity[3 * i + d] += at_origin[c] + gradient[c] * (x[3 * i + axis] - origin);
    }
}

LinearFlow wall_flow(const WallOptions &walls, const Grid &grid)
{
  LinearFlow flow;
  for (int d = 0; d < grid.dim; ++d) {
    if (!grid.walled(d) || !walls.any_moves()) continue;
    const WallOptions::Wall &lower = walls.face[static_cast<std::size_t>(d)][0];
    const WallOptions::Wall &upper = walls.face[static_cast<std::size_t>(d)][1];
    flow.axis = d;
    flow.origin = grid.lo[d];
    flow.at_origin = lower.kind == Boundary::noslip ? lower.velocity : upper.velocity;
    if (lower.kind == Boundary::noslip && upper.kind == Boundary::noslip)
      for (std::size_t c = 0; c < 3; ++c) flow.gradient[c] = (upper.velocity[c] - lower.velocity[c]) / grid.length[d];
  }
  return flow;
}

}    // namespace bdh
