// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// The core gives the same results with several threads as with one.  The threads are plain ones, so
// that this test needs no Kokkos and ThreadSanitizer can check it (cmake -DBDH_SANITIZE=thread).

#include "base/errors.h"
#include "fib/confined.h"
#include "fib/fluid.h"
#include "fib/spread.h"
#include "pse/pse_support.h"
#include "stokes/choice.h"
#include "support/test_support.h"
#include "support/thread_workers.h"

#include <gtest/gtest.h>

#include <vector>

namespace {

using namespace bdh;
using namespace bdh_test;

constexpr int counts[] = {2, 3, 4};

/// Periodic, walled and two-dimensional grids; with many layers of planes, an odd number, and one.
std::vector<Grid> grids()
{
  return {make_grid({10, 40, 44}, {0.7}),
          make_grid({9, 11, 31}, {0.5, 0.8, 1.1}),
          make_grid({8, 9, 7}, {0.7}),
          make_grid({30, 50}, {1.3}),
          with_walls(make_grid({10, 12, 26}, {0.7}), {"p", "p", "ns"}),
          with_walls(make_grid({10, 12, 26}, {0.7}), {"ns", "p", "nn"}),
          with_walls(make_grid({30, 50}, {1.3}), {"nn", "ss"})};
}

/// Positions anywhere in space along periodic axes, and on the faces of the box.
std::vector<double> scattered(const Grid &g, long n)
{
  std::vector<double> x = random_positions(g, n, 5);
  for (long i = 0; i < n / 8; ++i)
    for (int d = 0; d < g.dim; ++d) {
      const double end = i % 2 ? g.lo[d] : g.lo[d] + g.length[d];
      if ((i + d) % 3 == 0) x[3 * i + d] = g.walled(d) ? end : std::nextafter(end, end - 1.0);
    }
  return x;
}

struct Result {
  std::vector<double> field, velocity;
};

Result spread_and_interpolate(const Grid &g, IbKernel kernel, const Workers &workers)
{
  const long n = 500;
  const std::vector<double> x = scattered(g, n), force = random_numbers(x.size(), 6);
  const std::size_t size = 2 * g.half() * (g.dim == 3 ? g.n[1] : 1) * g.n[g.slow_axis()];
  HostSpreader<double> spreader(g, {0, g.n[g.slow_axis()]}, kernel, workers);
  spreader.bind(x.data(), n);
  std::vector<double> field(3 * size, 0.0), velocity(x.size());
  const FieldView view{field.data(), field.data() + size, field.data() + 2 * size};
  spreader.spread(force.data(), 0.3, view);
  spreader.interpolate(view, velocity.data());
  return {field, velocity};
}

}    // namespace

TEST(Workers, SpreadAndInterpolate)
{
  for (const Grid &g : grids())
    for (IbKernel kernel : {IbKernel::roma3, IbKernel::peskin4, IbKernel::bkp6}) {
      const Result one = spread_and_interpolate(g, kernel, Workers::one());
      const Result two = spread_and_interpolate(g, kernel, ThreadWorkers(2));
      // The bound allows for sums of up to 500 numbers in another order.
      EXPECT_LT(difference(two.field, one.field), 1e-14 * norm(one.field)) << wall_names(g);
      EXPECT_LT(difference(two.velocity, one.velocity), 1e-14 * norm(one.velocity))
          << wall_names(g);
      for (int count : counts) {
        const Result many = spread_and_interpolate(g, kernel, ThreadWorkers(count));
        EXPECT_EQ(many.field, two.field) << wall_names(g) << ", " << count << " workers";
        EXPECT_EQ(many.velocity, two.velocity) << wall_names(g) << ", " << count << " workers";
      }
    }
}

TEST(Workers, FluidWithNoise)
{
  for (const Grid &g : grids()) {
    const long n = 40;
    const std::vector<double> x = scattered(g, n), force = random_numbers(x.size(), 6);
    StokesProblem problem;
    problem.kT_over_dt = 0.7;
    problem.seed = 3;
    problem.stress = {{1.0, 0}};
    problem.tolerance = 1e-13;
    const auto velocity = [&](const Workers &workers) {
      FibFluid<FibOnHost> fluid(g, IbKernel::peskin4, FftEffort::estimate, self(), workers);
      fluid.bind(x.data(), n);
      fluid.clear();
      fluid.spread(force.data(), 0.4);
      fluid.solve(problem);
      std::vector<double> u(x.size());
      fluid.interpolate(u.data());
      return u;
    };
    const std::vector<double> one = velocity(Workers::one()), two = velocity(ThreadWorkers(2));
    EXPECT_LT(difference(two, one), 1e-12 * norm(one)) << wall_names(g);
    for (int count : counts)
      EXPECT_EQ(velocity(ThreadWorkers(count)), two)
          << wall_names(g) << ", " << count << " workers";
  }
}

// For every solver the fields, the iterations and the forces on walls equal those of one worker bit
// for bit.
TEST(Workers, SolversDoNotDependOnTheirNumber)
{
  const Grid space = make_grid({30, 27, 35}, {0.7, 0.8, 0.9}),
             plane = make_grid({90, 120}, {1.3, 0.9});
  std::vector<Grid> boxes = {space, plane,
                             with_walls(make_grid({5, 4, 3}, {1.0}), {"nn", "nn", "ns"})};
  for (const std::vector<std::string> &walls : {std::vector<std::string>{"p", "p", "ns"},
                                                {"nn", "p", "ns"},
                                                {"p", "nn", "nn"},
                                                {"nn", "ns", "nn"},
                                                {"ss", "ss", "ss"},
                                                {"ss", "p", "nn"}})
    boxes.push_back(with_walls(space, walls));
  for (const std::vector<std::string> &walls :
       {std::vector<std::string>{"p", "nn"}, {"nn", "sn"}, {"ss", "ss"}})
    boxes.push_back(with_walls(plane, walls));
  for (const Grid &g : boxes) {
    StokesProblem problem;
    problem.viscosity = 1.3;
    problem.kT_over_dt = 0.7;
    problem.seed = 3;
    problem.stress = {{1.0, 0}, {-0.5, 1}};
    problem.body_force = {0.1, 0.2, g.dim == 3 ? 0.3 : 0.0};
    if (g.walled_axes() > 1)
      for (int d = 0; d < g.dim; ++d)
        if (d != g.slow_axis()) problem.wall_velocity[g.slow_axis()][1][d] = 0.2 + d;
    struct Answer {
      std::vector<double> field;
      SolveReport report;
    };
    const auto solve = [&](const Workers &workers) {
      AnyStokes<double> solver(g, self(), FftEffort::estimate, workers);
      const long row = 2 * g.half(), rows = g.cells() / g.n[0];
      std::vector<AlignedVector> field(3, AlignedVector(solver.allocation(), 0.0));
      for (int d = 0; d < g.dim; ++d) {
        const std::vector<double> force = random_numbers(g.cells(), 6 + d);
        for (long r = 0; r < rows; ++r)
          std::copy_n(force.data() + r * g.n[0], g.n[0], field[d].data() + r * row);
      }
      Answer a;
      a.report = solver.solve({field[0].data(), field[1].data(), field[2].data()}, problem);
      for (int d = 0; d < g.dim; ++d)
        for (long r = 0; r < rows; ++r)
          a.field.insert(a.field.end(), field[d].begin() + r * row,
                         field[d].begin() + r * row + g.n[0]);
      return a;
    };
    const Answer one = solve(Workers::one());
    EXPECT_GT(norm(one.field), 0.0);
    for (int count : counts) {
      const Answer many = solve(ThreadWorkers(count));
      EXPECT_TRUE(many.field == one.field)
          << wall_names(g) << ", " << count << " workers, difference "
          << difference(many.field, one.field) / norm(one.field);
      EXPECT_EQ(many.report.iterations, one.report.iterations) << wall_names(g);
      EXPECT_EQ(many.report.residual, one.report.residual) << wall_names(g);
      EXPECT_EQ(many.report.wall_force, one.report.wall_force) << wall_names(g);
    }
  }
}

TEST(Workers, PositivelySplitEwald)
{
  const long n = 150;
  Cell leaning = cubic_cell(9.0);
  leaning.ly = 14.0;
  leaning.xy = 2.5;
  leaning.yz = -3.0;
  for (const Cell &cell : {cubic_cell(16.0), leaning})
    for (const double tolerance : {1e-3, 1e-8}) {
      std::vector<double> x = random_numbers(3 * n, 8);
      for (double &a : x) a *= 6.0;
      const std::vector<double> force = random_numbers(x.size(), 9);
      PseScene scene = scene_of(cell, n, 1.0, tolerance);
      scene.noise = true;
      scene.xi = 0.6;
      const PsePlan plan = plan_pse(scene);
      const auto velocities = [&](const Workers &workers) {
        PseHarness M(cell, x, plan, self(), 200, workers);
        std::vector<double> u = M.apply(force, 1.0), v = M.fluctuate(force, {1.0, 7, 11}, 1.0);
        u.insert(u.end(), v.begin(), v.end());
        return u;
      };
      const std::vector<double> one = velocities(Workers::one());
      // The rounding error of the sums over neighbours and modes is about that of one operation.
      const double bound = plan.single ? 1e-6 : 1e-14;
      for (int count : counts) {
        const ThreadWorkers workers(count);
        const std::vector<double> many = velocities(workers);
        EXPECT_LT(difference(many, one), bound * norm(one))
            << count << " workers, tolerance " << tolerance;
        EXPECT_EQ(velocities(workers), many) << count << " workers, tolerance " << tolerance;
      }
    }
}

// Each pair is found exactly once, by any of the workers.
TEST(Workers, PairsAreCountedOnce)
{
  const Cell cell = cubic_cell(12.0);
  std::vector<double> x = random_numbers(3 * 200, 8);
  for (double &a : x) a *= 5.0;
  PseScene scene = scene_of(cell, 200, 1.0, 1e-6);
  scene.noise = true;
  scene.xi = 0.8;
  const PsePlan plan = plan_pse(scene);
  const auto pairs = [&](const Workers &workers) {
    PseHarness M(cell, x, plan, self(), 200, workers);
    M.fluctuate({}, {1.0, 7, 11}, 1.0);
    return M.mobility().pairs();
  };
  for (int count : counts) EXPECT_EQ(pairs(ThreadWorkers(count)), pairs(Workers::one()));
}

TEST(Workers, ErrorsReachTheCaller)
{
  const ThreadWorkers workers(3);
  EXPECT_THROW(workers.run(10,
                           [](long i, int) {
                             if (i == 7) throw BadParticle(i, "lost");
                           }),
               BadParticle);
  const Cell cell = cubic_cell(12.0);
  std::vector<double> x = random_numbers(3 * 50, 8);
  PseScene scene = scene_of(cell, 50, 1.0, 1e-3);
  const PsePlan plan = plan_pse(scene);
  RealSpace<double, EqualSpheres<double>> pairs(plan, workers);
  const std::vector<long> mine = Deal(50, self()).mine;
  BruteNeighbors neighbors(cell, x, plan.r_cut, mine);
  NeighborView view = neighbors.view();
  std::vector<double> broken(view.x, view.x + 3 * neighbors.atoms());
  broken[3 * 20 + 1] = NAN;
  view.x = broken.data();
  EXPECT_THROW(pairs.bind({50, nullptr, nullptr, view, neighbors.all()}), BadParticle);
}
