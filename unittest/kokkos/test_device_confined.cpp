// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
#include "kokkos/device_backend.h"    // first: it defines TEST_BACKEND

#include "fib/typed_confined.h"
#include "fib/typed_open.h"
#include "stokes/choice.h"

namespace {

/// One problem solved on the devices of all ranks, and on the host of each.
struct Compared {
  SolveReport there, here;
  double off, most;    // largest difference and largest value of the velocity
};

/// Adds up the forces on the walls, of which each rank reports its part.
void sum_over_ranks(SolveReport &r)
{
  for (auto &axis : r.wall_force)
    for (auto &side : axis)
      for (double &f : side) f = world().sum(f);
}

Compared solved_by_both(const Grid &g, const StokesProblem &p)
{
  Backend::Stokes device(g, world(), FftEffort::estimate);
  AnyStokes<double> host(g, self(), FftEffort::estimate);
  const Slab slab = device.slab(), all{0, g.n[g.slow_axis()]};
  Backend::Vector on_device[3];
  AlignedVector on_host[3];
  FieldView there{}, here{};
  for (int d = 0; d < g.dim; ++d) {
    const auto force = [&](std::size_t place) {
      const long q = place, at[3] = {q % g.n[0], q / g.n[0] % g.n[1], q / (g.n[0] * g.n[1])};
      return g.walled(d) && at[d] == 0 ? 0.0 : std::sin(1.0 + 0.7 * place + 3.0 * d);
    };
    std::vector<double> f(device.allocation(), NAN);    // nothing may read the padding of the rows
    for_slab(g, slab, [&](std::size_t local, std::size_t place) { f[local] = force(place); });
    Access<Backend>::put(f, on_device[d]);
    on_host[d].assign(host.allocation(), NAN);
    for_slab(g, all,
             [&](std::size_t local, std::size_t place) { on_host[d][local] = force(place); });
    there[d] = on_device[d].data();
    here[d] = on_host[d].data();
  }
  Compared c{device.solve(there, p), host.solve(here, p), 0.0, 0.0};
  sum_over_ranks(c.there);
  const long plane = 2 * g.half() * (g.dim == 3 ? g.n[1] : 1);
  for (int d = 0; d < g.dim; ++d) {
    const std::vector<double> v = Access<Backend>::get(on_device[d]);
    for_slab(g, all, [&](std::size_t local, std::size_t) {
      c.most = std::max(c.most, std::fabs(on_host[d][local]));
    });
    for_slab(g, slab, [&](std::size_t local, std::size_t) {
      const double off = std::fabs(v[local] - on_host[d][local + slab.start * plane]);
      c.off = off <= c.off ? c.off : off;    // keeps a NaN
    });
  }
  return c;
}

/// A body force, noise from two draws, and all no-slip walls moving within their planes.
StokesProblem busy_problem(const Grid &g, bool noisy)
{
  StokesProblem p = quiet(1.3);
  p.tolerance = 1e-10;
  p.body_force = {0.1, 0.2, -0.3};
  p.kT_over_dt = noisy ? 0.7 : 0.0;
  p.seed = 11;
  p.step = 5;
  p.stress.push_back({1.0, 0});
  p.stress.push_back({0.5, 1});
  for (int axis = 0; axis < g.dim && g.walled_axes() > 1; ++axis)
    for (int side = 0; side < 2; ++side)
      for (int d = 0; d < g.dim; ++d)
        if (d != axis && g.boundary[axis][side] == Boundary::noslip)
          p.wall_velocity[axis][side][d] = 0.3 + axis - 0.7 * side + 0.4 * d;
  return p;
}

/// Normals from a formula, in place of those of the generator.
class GivenNormals : public NormalSource {
 public:
  void get(uint32_t stage, uint64_t index, double *z) const override
  {
    for (int m = 0; m < 4; ++m) z[m] = std::sin(1.0 + 0.37 * index + 2.0 * m + 5.0 * stage);
  }
};

void expect_same(const Grid &g, const StokesProblem &p)
{
  const Compared c = solved_by_both(g, p);
  EXPECT_GT(c.most, 0.0) << wall_names(g);
  EXPECT_LT(c.off, 1e-12 * c.most) << wall_names(g) << (p.noisy() ? " with noise" : "");
  EXPECT_EQ(c.there.iterations, c.here.iterations) << wall_names(g);
  EXPECT_NEAR(c.there.residual, c.here.residual, 1e-3 * p.tolerance) << wall_names(g);
  for (int axis = 0; axis < 3; ++axis)
    for (int side = 0; side < 2; ++side)
      for (int d = 0; d < 3; ++d)
        EXPECT_NEAR(c.there.wall_force[axis][side][d], c.here.wall_force[axis][side][d],
                    1e-11 * g.length[0] * g.length[1] * g.length[2])
            << wall_names(g) << axis << side << d;
}

/// The grids of walled_grids() with other numbers of cells.
std::vector<Grid> larger_grids(const std::array<long, 3> &more)
{
  std::vector<Grid> grids = walled_grids();
  for (Grid &g : grids) {
    g = solver_order(g)(g);
    for (int d = 0; d < g.dim; ++d) g.n[d] += more[d];
  }
  return grids;
}

}    // namespace

// Random numbers, iterations and forces on the walls are exactly those of the host.  The grids have
// rows longer than the host's strips, of odd and even length, and lines whose length is no multiple
// of a transform's block.
TEST(DeviceSolver, SolvesAsTheHost)
{
  for (const std::array<long, 3> &more : {std::array<long, 3>{7, 3, 3}, {30, 3, 5}})
    for (const Grid &g : larger_grids(more))
      for (const bool noisy : {false, true}) expect_same(g, busy_problem(g, noisy));
}

// All components use the numbers that a test supplies.
TEST(DeviceSolver, TakesGivenNumbers)
{
  const GivenNormals given;
  for (const Grid &g : larger_grids({4, 9, 2})) {
    StokesProblem p = busy_problem(g, true);
    p.normals = &given;
    expect_same(g, p);
  }
}
