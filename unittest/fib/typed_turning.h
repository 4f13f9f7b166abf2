// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// Laws of torques and angular velocities, for any backend: #define TEST_BACKEND before including
// this.
//
// The reference is the definition, edge by edge: the vorticity of the field as it goes on behind
// walls, averaged with the kernel, and the dense operators of fib/confined.h.

#include "fib/moving_walls.h"
#include "fib/typed_moments.h"
#include "support/suspension.h"

#include <gtest/gtest.h>

namespace {

using namespace bdh;
using namespace bdh_test;
using Fluid = FibFluid<Backend>;

std::vector<Grid> turning_grids()
{
  return {make_grid({8, 7, 9}, {0.7, 0.8, 0.6}),
          with_walls(make_grid({7, 8, 6}, {0.7, 0.6, 0.8}), {"p", "p", "nn"}),
          with_walls(make_grid({6, 7, 8}, {0.7, 0.6, 0.8}), {"ns", "p", "p"}),
          with_walls(make_grid({7, 6, 8}, {0.7, 0.6, 0.8}), {"p", "sn", "p"}),
          with_walls(make_grid({7, 6, 6}, {0.7, 0.6, 0.8}), {"p", "nn", "ns"}),
          with_walls(make_grid({6, 6, 6}, {0.7, 0.6, 0.8}), {"nn", "ns", "ss"}),
          with_walls(make_grid({6, 7, 6}, {0.7, 0.6, 0.8}), {"ss", "p", "ss"}),
          make_grid({9, 8}, {0.7, 0.9}),
          with_walls(make_grid({9, 8}, {0.7, 0.9}), {"p", "nn"}),
          with_walls(make_grid({7, 9}, {0.7, 0.9}), {"sn", "p"}),
          with_walls(make_grid({7, 8}, {0.7, 0.9}), {"nn", "sn"})};
}

bool is_used(int dim, long number) { return dim == 3 || number % 6 < 2 || number % 6 == 5; }

/// Particles that turn in a fluid.  Whole arrays, the same on every rank.
class Spinning {
 public:
  Spinning(const Grid &g, IbKernel kernel, const Comm &comm, const std::vector<double> &x) :
      n_(x.size() / 3), comm_(comm), deal_(n_, comm),
      fluid_(g, kernel, FftEffort::estimate, comm, Workers::one(), Moments::torque)
  {
    bind(x);
  }
  void bind(const std::vector<double> &x)
  {
    const std::vector<double> mine = deal_.take(x);
    fluid_.bind(mine.data(), bdh::ssize(deal_.mine));
  }
  Motion motion(const Motion &loads, const StokesProblem &problem, double kT = 0.0)
  {
    fluid_.clear();
    fluid_.spread(deal_.take(part(loads, 0)).data(), kT);
    fluid_.spread_torque(deal_.take(part(loads, 3)).data());
    fluid_.solve(problem);
    return interpolated();
  }
  Motion interpolated()
  {
    std::vector<double> u(3 * deal_.mine.size(), NAN), w = u;
    fluid_.interpolate(u.data());
    fluid_.angular_velocity(w.data());
    u = deal_.gather(u, n_, comm_);
    w = deal_.gather(w, n_, comm_);
    Motion m(6 * n_);
    for (long i = 0; i < n_; ++i)
      for (int d = 0; d < 3; ++d) {
        m[6 * i + d] = u[3 * i + d];
        m[6 * i + 3 + d] = w[3 * i + d];
      }
    return m;
  }
  Fluid &fluid() { return fluid_; }

 private:
  std::vector<double> part(const Motion &m, long first) const
  {
    std::vector<double> v(3 * n_);
    for (long i = 0; i < n_; ++i)
      for (int d = 0; d < 3; ++d) v[3 * i + d] = m[6 * i + first + d];
    return v;
  }

  long n_;
  Comm comm_;
  Deal deal_;
  Fluid fluid_;
};

/// M as a matrix with 6 n rows, those of unused numbers 0.
Eigen::MatrixXd spinning_mobility(const Grid &g, IbKernel kernel, const std::vector<double> &x,
                                  double viscosity)
{
  Spinning s(g, kernel, world(), x);
  const long size = 2 * x.size();
  Eigen::MatrixXd M = Eigen::MatrixXd::Zero(size, size);
  for (long column = 0; column < size; ++column) {
    if (!is_used(g.dim, column)) continue;
    Motion unit(size, 0.0);
    unit[column] = 1.0;
    const Motion m = s.motion(unit, quiet(viscosity, 1e-13));
    for (long row = 0; row < size; ++row)
      if (is_used(g.dim, row)) M(row, column) = m[row];
  }
  return M;
}

}    // namespace

// M of forces and torques equals P L^-1 P^T/(eta dV), with P by definition and L^-1 from the dense
// saddle-point problem.  It is symmetric, and positive definite.
TEST(TypedTurning, MobilityEqualsTheDenseReference)
{
  if (world().size() > 1) GTEST_SKIP() << "a test of its own compares numbers of ranks";
  int number = 0;
  for (const Grid &g : turning_grids()) {
    const IbKernel kernel = all_kernels[number++ % 3];
    SCOPED_TRACE(std::string(kernel_name(kernel)) + " " + wall_names(g));
    const std::vector<double> x = corner_and_middle(g);
    const Definition definition(g, kernel);
    const Eigen::MatrixXd P = definition.matrix(x);
    const Eigen::MatrixXd expected =
        P * definition.dense().stokes_inverse() * P.transpose() / (1.3 * g.cell_volume());
    const Eigen::MatrixXd M = spinning_mobility(g, kernel, x, 1.3);
    EXPECT_LT((M - expected).norm(), 1e-11 * expected.norm());
    EXPECT_LT((M - M.transpose()).norm(), 1e-12 * M.norm());
    std::vector<long> used;
    for (long k = 0; k < M.rows(); ++k)
      if (is_used(g.dim, k)) used.push_back(k);
    const Eigen::MatrixXd there = M(used, used);
    const Eigen::VectorXd e = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(there).eigenvalues();
    EXPECT_GT(e.minCoeff(), 1e-6 * e.maxCoeff());
  }
}

// A torque turns a particle in its own direction, and carries particles around it along.
TEST(TypedTurning, SignsAreRightHanded)
{
  const Grid g = make_grid({16, 16, 16}, {1.0}, 0.0);
  Spinning s(g, IbKernel::peskin4, world(), {8.0, 8.0, 8.0, 11.0, 8.0, 8.0});
  const Motion m = s.motion({0, 0, 0, 0, 0, 1.0, 0, 0, 0, 0, 0, 0}, quiet(1.0));
  EXPECT_GT(m[5], 0.0);
  EXPECT_GT(m[6 + 1], 0.0);    // e_z x e_x = e_y
  EXPECT_LT(m[6 + 5], 0.0);    // the vortex outside is irrotational but for the far field
}

// omega.T = dV sum_faces v.(spread T), to the last bits, also over walls and corners.
TEST(TypedTurning, SpreadingIsTheAdjointOfInterpolation)
{
  for (IbKernel kernel : all_kernels)
    for (const Grid &box : turning_grids()) {
      const Grid g = solver_order(box)(box);
      SCOPED_TRACE(std::string(kernel_name(kernel)) + " " + wall_names(g));
      const Slab all{0, g.n[g.slow_axis()]};
      typename Backend::Spreader spreader(g, all, kernel, Workers::one(), true);
      const std::size_t size = 2 * g.half() * (g.dim == 3 ? g.n[1] * g.n[2] : g.n[1]);
      const Field v = random_field(g, 5);
      typename Backend::Vector field[3], spread[3];
      FieldView from{}, to{};
      for (int d = 0; d < g.dim; ++d) {
        field[d].resize(size);
        spread[d].resize(size);
        Access<Backend>::put(slab_part(v, d, all, size), field[d]);
        Access<Backend>::put(std::vector<double>(size, 0.0), spread[d]);
        from[d] = field[d].data();
        to[d] = spread[d].data();
      }
      const std::vector<double> x = random_positions(g, 40, 3), torque = random_numbers(120, 4);
      std::vector<double> omega(120, NAN);
      spreader.bind(x.data(), 40);
      spreader.spread_torque(torque.data(), to);
      spreader.angular_velocity(from, omega.data());
      double particles = 0.0, faces = 0.0, scale = 0.0;
      for (std::size_t i = 0; i < omega.size(); ++i) {
        if (g.dim == 3 || i % 3 == 2)
          particles += omega[i] * torque[i];
        else
          EXPECT_EQ(omega[i], 0.0);
        scale += std::fabs(omega[i] * torque[i]);
      }
      Field f(g);
      for (int d = 0; d < g.dim; ++d) {
        add_slab(Access<Backend>::get(spread[d]), d, all, f);
        for (std::size_t i = 0; i < v.c[d].size(); ++i)
          faces += g.cell_volume() * v.c[d][i] * f.c[d][i];
      }
      EXPECT_NEAR(particles, faces, 1e-14 * scale);
    }
}

// Motions, with noise and drift, are the same for any number of ranks, also with fewer planes (3)
// than ranks, and for kernels as wide as the grid.
TEST(TypedTurning, DoesNotDependOnTheNumberOfRanks)
{
  std::vector<Grid> grids = turning_grids();
  grids.push_back(make_grid({8, 7, 3}, {0.7}));
  grids.push_back(make_grid({6, 3}, {0.7}));
  for (const Grid &g : grids)
    for (IbKernel kernel : all_kernels) {
      if (kernel_width(kernel) > g.n[g.slow_axis()]) continue;
      SCOPED_TRACE(std::string(kernel_name(kernel)) + " " + wall_names(g));
      const std::vector<double> x = random_positions(g, 9, 5);
      const Motion loads = random_numbers(54, 6);
      StokesProblem p = quiet(1.1, 1e-13);
      p.kT_over_dt = 0.4;
      p.seed = 99;
      p.step = 3;
      p.stress = {{1.0, 0}, {0.5, 1}};
      Spinning together(g, kernel, world(), x), alone(g, kernel, self(), x);
      const Motion expected = alone.motion(loads, p, 0.6), m = together.motion(loads, p, 0.6);
      EXPECT_LT(difference(m, expected), 1e-12 * norm(expected));
    }
}

// Walls that move: the flow that they drive turns particles by half the curl of the field with its
// ghost values, in ducts and boxes from the definition, in slits by half the shear rate.
TEST(TypedTurning, MovingWallsTurnParticles)
{
  if (world().size() > 1) GTEST_SKIP() << "a test of its own compares numbers of ranks";
  for (const Grid &g : turning_grids()) {
    if (g.walled_axes() == 0) continue;
    WallOptions walls;
    WallVectors V{};
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (std::size_t side = 0; side < 2; ++side) {
        WallOptions::Wall &w = walls.face[axis][side];
        w.kind = g.boundary[axis][side];
        for (std::size_t d = 0; d < std::size_t(g.dim); ++d)
          if (d != axis && w.kind == Boundary::noslip)
            w.velocity[d] = V[axis][side][d] =
                0.4 + double(axis) - 0.9 * double(side) + 0.3 * double(d);
      }
    if (!walls.any_moves()) continue;
    const DenseOperators dense(g);
    const Eigen::VectorXd flow = dense.stokes_inverse() * dense.moving_walls(V);
    for (IbKernel kernel : all_kernels) {
      const WallMotion motion(walls, g, kernel);
      SCOPED_TRACE(std::string(kernel_name(kernel)) + " " + wall_names(g));
      const std::vector<double> x = corner_and_middle(g);
      const Definition definition(g, kernel);
      const Motion expected = definition.motion(flow, V, x);
      Spinning s(g, kernel, world(), x);
      StokesProblem p = quiet(1.3, 1e-13);
      p.wall_velocity = motion.left_to_solver();
      const Motion still = s.motion(Motion(12, 0.0), p);
      std::vector<double> omega(6);
      for (std::size_t i = 0; i < 6; ++i) omega[i] = still[6 * (i / 3) + 3 + i % 3];
      motion.for_turners(x.data(), omega.data(), [&](const auto &adder) {
        Backend::Execution().for_each("walls", 2, adder);
      });
      for (std::size_t i = 0; i < 6; ++i) {
        if (g.dim == 3 || i % 3 == 2)
          EXPECT_NEAR(omega[i], expected[6 * (i / 3) + 3 + i % 3], 1e-9) << i;
        else
          EXPECT_EQ(omega[i], 0.0) << i;
      }
    }
  }
}

// An open face is no boundary: the mobility of the same particles, one of them at the face, is that
// in a taller box, for every kernel.
TEST(TypedTurning, OpenFacesMayBeAnywhere)
{
  for (IbKernel kernel : all_kernels)
    for (const char *walls : {"no", "so", "oo"}) {
      SCOPED_TRACE(std::string(kernel_name(kernel)) + " " + walls);
      const auto mobility = [&](long cells) {
        const Grid box =
            with_walls(make_grid({7, 6, cells}, {0.7, 0.8, 0.6}, 0.0), {"p", "p", walls});
        return spinning_mobility(beyond_open_faces(box, rows_beyond(kernel)), kernel,
                                 {1.3, 0.8, 2.4, 2.9, 1.6, 0.9}, 1.3);
      };
      const Eigen::MatrixXd M = mobility(4), expected = mobility(9);
      // Without a no-slip wall only forces drive a uniform flow, which depends on the height.
      Eigen::MatrixXd difference = M - expected;
      for (long i = 0; i < 12 && walls[0] != 'n'; ++i)
        for (long j = 0; j < 12; ++j)
          if (i % 6 < 3 && j % 6 < 3) difference(i, j) = 0.0;
      EXPECT_LT(difference.norm(), 1e-12 * expected.norm());
    }
}

// The mean self-mobility over positions gives the tabulated rotational radius, whose spread is that
// of the component along x over a lattice of positions.  By symmetry 0 .. 1/2 in each direction
// covers all positions.
TEST(TypedTurningRadius, MeanOverPositionsIsTheTabulatedRadius)
{
  for (IbKernel kernel : all_kernels)
    for (int dim : {2, 3}) {
      const long n = 32, points = 4;
      const Grid g = dim == 2 ? make_grid({n, n}, {1.0}, 0.0) : make_grid({n, n, n}, {1.0}, 0.0);
      const double volume = dim == 2 ? n * n : n * n * n;
      Spinning s(g, kernel, world(), {0.0, 0.0, 0.0});
      const auto radius = [&](double mu) {
        return dim == 2 ? std::sqrt(1.0 / (4.0 * M_PI * mu + M_PI / volume))
                        : std::cbrt(1.0 / (8.0 * M_PI * mu + 4.0 * M_PI / 3.0 / volume));
      };
      double sum = 0.0, weights = 0.0, low = 1e9, high = 0.0;
      for (long i = 0; i <= points; ++i)
        for (long j = 0; j <= points; ++j)
          for (long k = 0; k <= (dim == 3 ? points : 0); ++k) {
            s.bind({0.5 * i / points, 0.5 * j / points, 0.5 * k / points});
            const int axis = dim == 2 ? 5 : 3;
            Motion unit(6, 0.0);
            unit[axis] = 1.0;
            const double mu = s.motion(unit, quiet(1.0))[axis];
            const double w = (i % points ? 2.0 : 1.0) * (j % points ? 2.0 : 1.0) *
                             (dim == 3 && k % points ? 2.0 : 1.0);
            sum += w * mu;
            weights += w;
            low = std::min(low, radius(mu));
            high = std::max(high, radius(mu));
          }
      const double a = radius(sum / weights), spread = 0.5 * (high - low) / a;
      SCOPED_TRACE(std::string(kernel_name(kernel)) + " " + std::to_string(dim) + "D " +
                   std::to_string(a) + " " + std::to_string(spread));
      EXPECT_NEAR(a / rotational_radius_over_spacing(kernel, dim), 1.0, 1e-4);
      EXPECT_NEAR(spread, rotational_radius_spread(kernel, dim),
                  0.02 * rotational_radius_spread(kernel, dim) + 1e-12);
    }
}

namespace {

StepPlan turning_plan(Scheme scheme, double dt, double kT)
{
  StepPlan p;
  p.scheme = scheme;
  p.turns = true;
  p.dt = dt;
  p.kT = kT;
  p.viscosity = 1.3;
  p.seed = 77;
  p.tolerance = 1e-10;
  return p;
}

Eigen::Matrix3d rotation_matrix(const double *r)
{
  const Eigen::Map<const Eigen::Vector3d> v(r);
  return v.norm() > 0.0 ? Eigen::AngleAxisd(v.norm(), v.normalized()).toRotationMatrix()
                        : Eigen::Matrix3d(Eigen::Matrix3d::Identity());
}

}    // namespace

// The angular velocity of every scheme is that of the flow at the place where the scheme takes the
// velocity, and the parts of a rotation add up to the rotation vector omega dt.
TEST(TypedTurningStep, RotationsAreThoseOfTheMobility)
{
  const Grid g = with_walls(make_grid({7, 8, 6}, {0.7, 0.6, 0.8}), {"p", "p", "nn"});
  const std::vector<double> x = random_positions(g, 2, 8, 0.6), torque = random_numbers(6, 9);
  Fluid fluid(g, IbKernel::peskin4, FftEffort::estimate, self(), Workers::one(),
              bdh::Moments::torque);
  const Eigen::MatrixXd M = spinning_mobility(g, IbKernel::peskin4, x, 1.3);
  Eigen::VectorXd loads = Eigen::VectorXd::Zero(12);
  for (long i = 0; i < 6; ++i) loads[6 * (i / 3) + 3 + i % 3] = torque[i];
  const Eigen::VectorXd motion = M * loads;
  for (Scheme scheme : {Scheme::midpoint, Scheme::improved, Scheme::euler, Scheme::trapezoidal}) {
    SCOPED_TRACE(scheme_name(scheme));
    Noting p(x, torque);
    BrownianStep<Backend> step(fluid);
    const double dt = 1e-9;    // too short for positions to matter
    step.take(p, turning_plan(scheme, dt, 0.0));
    for (long i = 0; i < 6; ++i)
      EXPECT_NEAR(p.omega[i], motion[6 * (i / 3) + 3 + i % 3], 1e-8 * motion.norm());
    for (std::size_t i = 0; i < 2; ++i) {
      const std::vector<double> whole = {dt * p.omega[3 * i], dt * p.omega[3 * i + 1],
                                         dt * p.omega[3 * i + 2]};
      Eigen::Matrix3d made = rotation_matrix(&p.last_turn[3 * i]);
      if (!p.half_turn.empty()) made = made * rotation_matrix(&p.half_turn[3 * i]);
      EXPECT_LT((made - rotation_matrix(whole.data())).norm(), 1e-15);
    }
    EXPECT_EQ(p.half_turn.empty(), scheme != Scheme::improved);
  }
}

// Nothing of this is done where nothing turns.
TEST(TypedTurningStep, WithoutRotationNothingTurns)
{
  const Grid g = make_grid({7, 8}, {0.7, 0.6});
  const std::vector<double> x = random_positions(g, 2, 8), torque = random_numbers(6, 9);
  Fluid fluid(g, IbKernel::peskin4, FftEffort::estimate, self());
  for (Scheme scheme : {Scheme::midpoint, Scheme::improved}) {
    Noting p(x, torque);
    StepPlan plan = turning_plan(scheme, 0.1, 1.0);
    plan.turns = false;
    BrownianStep<Backend> step(fluid);
    step.take(p, plan);
    EXPECT_TRUE(p.omega.empty() && p.half_turn.empty());
  }
}

TEST(TypedTurningStep, ATorqueThatIsNoNumberIsNamed)
{
  const Grid g = make_grid({7, 8}, {0.7, 0.6});
  Noting p(random_positions(g, 3, 8), {0, 0, 1, 0, 0, NAN, 0, 0, 1});
  Fluid fluid(g, IbKernel::peskin4, FftEffort::estimate, self(), Workers::one(),
              bdh::Moments::torque);
  BrownianStep<Backend> step(fluid);
  try {
    step.take(p, turning_plan(Scheme::midpoint, 0.1, 1.0));
    ADD_FAILURE() << "it was accepted";
  } catch (const BadParticle &e) {
    EXPECT_EQ(e.index, 1);
    EXPECT_NE(std::string(e.what()).find("torque"), std::string::npos);
  }
}

// Covariance of (U, omega) from one draw: 2 kT M/dt for the whole matrix.  An entry of the sample
// covariance has the variance (C_ii C_jj + C_ij^2)/n, so the sum of squares of the scaled errors of
// k(k+1)/2 entries is about their number; twice as much does not happen by chance.
TEST(StatisticsTurning, CovarianceOfVelocityAndAngularVelocityIsTheMobility)
{
  for (const Grid &g : {make_grid({6, 7, 8}, {0.7, 0.8, 0.6}),
                        with_walls(make_grid({6, 7, 6}, {0.7, 0.6, 0.8}), {"p", "p", "nn"}),
                        with_walls(make_grid({7, 8}, {0.7, 0.9}), {"nn", "sn"})}) {
    SCOPED_TRACE(wall_names(g));
    const std::vector<double> x = corner_and_middle(g);
    Spinning s(g, IbKernel::peskin4, world(), x);
    StokesProblem p = quiet(1.3, 1e-8);
    p.kT_over_dt = 0.6;
    p.seed = 5;
    p.stress = {{1.0, 0}};
    const long samples = 4000;
    Eigen::MatrixXd C = Eigen::MatrixXd::Zero(12, 12);
    for (long n = 0; n < samples; ++n) {
      p.step = n;
      const Motion m = s.motion(Motion(12, 0.0), p);
      const Eigen::Map<const Eigen::VectorXd> v(m.data(), 12);
      C += v * v.transpose() / double(samples);
    }
    const Eigen::MatrixXd expected = 2.0 * 0.6 * spinning_mobility(g, IbKernel::peskin4, x, 1.3);
    double sum = 0.0, entries = 0.0;
    for (long i = 0; i < 12; ++i)
      for (long j = 0; j <= i; ++j) {
        if (!is_used(g.dim, i) || !is_used(g.dim, j)) continue;
        const double error = C(i, j) - expected(i, j);
        const double variance = expected(i, i) * expected(j, j) + expected(i, j) * expected(i, j);
        sum += error * error * samples / variance;
        entries += 1.0;
      }
    EXPECT_LT(sum / entries, 2.0);
    EXPECT_GT(sum / entries, 0.3);
  }
}

// The mean angular velocity without torques near a corner of walls is kT div M, the divergence with
// respect to positions in the rows of angular velocities, from differences of the dense reference.
// What the same noise does at the beginning of the step has the mean 0 and is subtracted, which
// leaves a variance that does not grow as dt becomes small.  The steps are so short that the error
// of the schemes, of first order, is far below the statistical one.
TEST(StatisticsTurning, MeanRotationNearACornerIsTheDivergenceOfTheMobility)
{
  const Grid g = with_walls(make_grid({8, 7}, {1.0, 1.0}, 0.0), {"nn", "nn"});
  const double kT = 0.7, step = 1e-4;
  const std::vector<double> x = {1.3, 0.8, 0.0, 2.9, 1.6, 0.0};
  const Definition definition(g, IbKernel::peskin4);
  const Eigen::MatrixXd inverse = definition.dense().stokes_inverse() / (1.3 * g.cell_volume());
  Eigen::VectorXd divergence = Eigen::VectorXd::Zero(12);
  for (long je = 0; je < 6; ++je) {
    if (je % 3 == 2) continue;
    const long column = 6 * (je / 3) + je % 3;
    for (double sign : {1.0, -1.0}) {
      std::vector<double> moved = x;
      moved[je] += sign * step;
      const Eigen::MatrixXd P = definition.matrix(moved);
      divergence += sign / (2.0 * step) * (P * (inverse * P.row(column).transpose()));
    }
  }
  divergence *= kT;
  Fluid fluid(g, IbKernel::peskin4, FftEffort::estimate, self(), Workers::one(),
              bdh::Moments::torque);
  Spinning still(g, IbKernel::peskin4, self(), x);
  for (Scheme scheme : {Scheme::midpoint, Scheme::trapezoidal, Scheme::improved}) {
    SCOPED_TRACE(scheme_name(scheme));
    StepPlan plan = turning_plan(scheme, 1e-6, kT);
    StokesProblem noise = quiet(1.3, 1e-10);
    noise.kT_over_dt = kT / plan.dt;
    noise.seed = plan.seed;
    noise.stress = {{1.0, 0}};
    if (scheme == Scheme::improved)
      noise.stress = {{1.0 / std::sqrt(2.0), 0}, {1.0 / std::sqrt(2.0), 1}};
    Mean mean[2];
    Noting p(x, std::vector<double>(6, 0.0));
    BrownianStep<Backend> stepper(fluid);
    for (long n = 0; n < 12000; ++n) {
      plan.step = noise.step = n;
      stepper.take(p, plan);
      const Motion m = still.motion(Motion(12, 0.0), noise);
      for (std::size_t i = 0; i < 2; ++i) mean[i].add(p.omega[3 * i + 2] - m[6 * i + 5]);
    }
    for (long i = 0; i < 2; ++i) {
      const double expected = divergence[6 * i + 5];
      EXPECT_LT(std::fabs(mean[i].z(expected)), 3.5) << i;
      EXPECT_GT(std::fabs(expected), 6.0 * mean[i].error()) << i;    // it would be seen
    }
  }
}
