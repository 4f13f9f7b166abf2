#include "bdh_moving_walls.h"

#include "bdh_ib_kernel.h"

namespace bdh {

bool LinearFlow::flows() const
{
  for (std::size_t d = 0; d < 3; ++d)
    if (at_origin[d] != 0.0 || gradient[d] != 0.0) return true;
  return false;
}

AddLinearFlow LinearFlow::adder(const double *x, double *velocity) const
{
  return {axis, origin, {at_origin[0], at_origin[1], at_origin[2]}, {gradient[0], gradient[1], gradient[2]}, x, velocity};
}

namespace {

/// Of the only walls of a slit.
LinearFlow slit_flow(const WallOptions &walls, const Grid &grid)
{
  LinearFlow flow;
  for (int d = 0; d < grid.dim; ++d) {
    if (!grid.walled(d)) continue;
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

/// Sum over the lines under a particle of weight times share(line).  shift: 0 for faces, 1/2 for centres.
template <class Kernel, class Share> double weigh(double x, double shift, Share share)
{
  double r, w[Kernel::width], sum = 0.0;
  const long first = static_cast<long>(Kernel::first(x - shift, r));
  Kernel::weights(r, w);
  for (int i = 0; i < Kernel::width; ++i) sum += w[i] * share(first + i);
  return sum;
}

}    // namespace

WallMotion::WallMotion(const WallOptions &walls, const Grid &grid, IbKernel kernel) : grid_(grid), kernel_(kernel)
{
  if (!walls.any_moves()) return;
  solved_ = grid.walled_axes() > 1;
  if (!solved_) {
    flow_ = slit_flow(walls, grid);
    return;
  }
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (std::size_t side = 0; side < 2; ++side) velocity_[axis][side] = walls.face[axis][side].velocity;
}

template <class Kernel> void WallMotion::add_ghosts(const double *x, long n, double *velocity) const
{
  const auto place = [&](long i, int axis) { return (x[3 * i + axis] - grid_.lo[axis]) / grid_.h(axis); };
  // Weight where the ghost values of component d hold the velocity of a wall across another axis.
  const auto along = [&](long i, int axis, int d) {
    if (!grid_.walled(axis)) return 1.0;
    const long last = grid_.n[axis];
    const auto &wall = grid_.boundary[axis];
    const double below = wall[0] == Boundary::noslip ? 0.0 : 1.0, above = wall[1] == Boundary::noslip ? 0.0 : 1.0;
    if (d != axis)
      return weigh<Kernel>(place(i, axis), 0.5, [&](long l) { return l < 0 ? below : l >= last ? above : 1.0; });
    return weigh<Kernel>(place(i, axis), 0.0,
                         [&](long l) { return l == 0 || l == last ? 0.0 : l < 0 ? -below : l > last ? -above : 1.0; });
  };
  for (int axis = 0; axis < grid_.dim; ++axis)
    for (int side = 0; side < 2; ++side) {
      const std::array<double, 3> &V = velocity_[static_cast<std::size_t>(axis)][static_cast<std::size_t>(side)];
      if (V == std::array<double, 3>{}) continue;
      for (long i = 0; i < n; ++i) {
        const double y = place(i, axis), distance = side ? static_cast<double>(grid_.n[axis]) - y : y;
        if (distance > 0.5 * Kernel::width) continue;
        const double behind = weigh<Kernel>(
            y, 0.5, [&](long l) { return (side ? l >= grid_.n[axis] : l < 0) ? 1.0 : 0.0; });
        for (int d = 0; d < grid_.dim; ++d) {
          double ghost = 2.0 * V[static_cast<std::size_t>(d)] * behind;
          if (ghost == 0.0) continue;
          for (int other = 0; other < grid_.dim; ++other)
            if (other != axis) ghost *= along(i, other, d);
          velocity[3 * i + d] += ghost;
        }
      }
    }
}

void WallMotion::add(const double *x, long n, double *velocity) const
{
  if (flow_.flows()) {
    const AddLinearFlow flow = flow_.adder(x, velocity);
    for (long i = 0; i < n; ++i) flow(i);
  }
  if (!solved_) return;
  switch (kernel_) {
    case IbKernel::roma3: return add_ghosts<Roma3>(x, n, velocity);
    case IbKernel::peskin4: return add_ghosts<Peskin4>(x, n, velocity);
    case IbKernel::bkp6: return add_ghosts<BaoKayePeskin6>(x, n, velocity);
  }
}

}    // namespace bdh
