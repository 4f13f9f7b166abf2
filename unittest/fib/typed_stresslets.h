// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// Laws of stresslets, of rigid spheres and of particles that are held, for any backend: #define
// TEST_BACKEND before including this.
//
// References: the definition (fib/typed_moments.h) with the dense operators of fib/confined.h, an
// independent program (fib_stresslet.json), and dense algebra with these matrices.

#include "fib/constrained_step.h"
#include "fib/typed_moments.h"
#include "support/reference_json.h"
#include "support/suspension.h"

#include <gtest/gtest.h>

namespace {

using namespace bdh;
using namespace bdh_test;
using Fluid = FibFluid<Backend>;
using Eigen::MatrixXd;
using Eigen::VectorXd;

std::vector<Grid> straining_grids()
{
  return {make_grid({8, 7, 9}, {0.7, 0.8, 0.6}),
          with_walls(make_grid({7, 8, 6}, {0.7, 0.6, 0.8}), {"p", "p", "nn"}),
          with_walls(make_grid({6, 7, 8}, {0.7, 0.6, 0.8}), {"ns", "p", "p"}),
          with_walls(make_grid({7, 6, 8}, {0.7, 0.6, 0.8}), {"p", "sn", "p"}),
          with_walls(make_grid({7, 6, 6}, {0.7, 0.6, 0.8}), {"p", "nn", "ns"}),
          with_walls(make_grid({6, 6, 6}, {0.7, 0.6, 0.8}), {"nn", "ns", "ss"})};
}

/// Numbers of n particles: all forces, then all torques, then all stresslets; and what belongs to
/// them.
struct Loads {
  long n;
  std::vector<double> linear, angular, strain;
  explicit Loads(long particles) :
      n(particles), linear(3 * n, 0.0), angular(3 * n, 0.0), strain(5 * n, 0.0)
  {}
  double &at(long k)
  {
    return k < 3 * n ? linear[k] : k < 6 * n ? angular[k - 3 * n] : strain[k - 6 * n];
  }
  VectorXd vector()
  {
    VectorXd v(11 * n);
    for (long k = 0; k < 11 * n; ++k) v[k] = at(k);
    return v;
  }
};

/// Particles with all moments in a fluid.  Whole arrays, the same on every rank.
class Straining {
 public:
  Straining(const Grid &g, IbKernel kernel, const Comm &comm, const std::vector<double> &x) :
      n_(x.size() / 3), comm_(comm), deal_(n_, comm),
      fluid_(g, kernel, FftEffort::estimate, comm, Workers::one(), Moments::stresslet)
  {
    bind(x);
  }
  void bind(const std::vector<double> &x)
  {
    const std::vector<double> mine = deal_.take(x);
    fluid_.bind(mine.data(), bdh::ssize(deal_.mine));
  }
  /// Motions at y under loads at x.
  Loads motion_elsewhere(const std::vector<double> &x, const std::vector<double> &y,
                         const Loads &loads, const StokesProblem &problem)
  {
    bind(x);
    fluid_.clear();
    fluid_.spread(deal_.take(loads.linear).data(), 0.0);
    bind(y);
    fluid_.solve(problem);
    return interpolated();
  }
  Loads motion(const Loads &loads, const StokesProblem &problem)
  {
    fluid_.clear();
    fluid_.spread(deal_.take(loads.linear).data(), 0.0);
    fluid_.spread_torque(deal_.take(loads.angular).data());
    fluid_.spread_stresslet(deal_.take(loads.strain, 5).data());
    fluid_.solve(problem);
    return interpolated();
  }
  Loads interpolated()
  {
    std::vector<double> u(3 * deal_.mine.size(), NAN), w = u, curl = u,
                                                       e(5 * deal_.mine.size(), NAN);
    fluid_.interpolate(u.data());
    fluid_.angular_velocity(w.data());
    fluid_.gradient(e.data(), curl.data());
    EXPECT_LE(difference(w, curl), 1e-13 * norm(w));
    Loads m(n_);
    m.linear = deal_.gather(u, n_, comm_);
    m.angular = deal_.gather(w, n_, comm_);
    m.strain = deal_.gather(e, n_, comm_, 5);
    return m;
  }
  Fluid &fluid() { return fluid_; }

 private:
  long n_;
  Comm comm_;
  Deal deal_;
  Fluid fluid_;
};

MatrixXd straining_mobility(const Grid &g, IbKernel kernel, const std::vector<double> &x,
                            double viscosity)
{
  Straining s(g, kernel, world(), x);
  const long n = x.size() / 3;
  MatrixXd M(11 * n, 11 * n);
  for (long column = 0; column < M.cols(); ++column) {
    Loads unit(n);
    unit.at(column) = 1.0;
    M.col(column) = s.motion(unit, quiet(viscosity, 1e-13)).vector();
  }
  return M;
}

/// Motions of which some are given, by dense algebra.
struct DenseConstraint {
  std::vector<bool> given;    // by number
  MatrixXd M, solve;          // solve: unknown loads by what the given motions lack

  DenseConstraint(const MatrixXd &matrix, const std::vector<bool> &which) : given(which), M(matrix)
  {
    MatrixXd cc = MatrixXd::Identity(M.rows(), M.rows());
    for (long i = 0; i < M.rows(); ++i)
      for (long j = 0; j < M.rows(); ++j)
        if (given[i] && given[j]) cc(i, j) = M(i, j);
    solve = cc.inverse();
  }
  VectorXd loads(const VectorXd &motion, const VectorXd &target) const
  {
    VectorXd lacking = target - motion;
    for (long i = 0; i < lacking.size(); ++i)
      if (!given[i]) lacking[i] = 0.0;
    return solve * lacking;
  }
  /// These motions with what the constraint adds, where all given ones are 0.
  VectorXd constrained(const VectorXd &motion) const
  {
    return motion + M * loads(motion, VectorXd::Zero(M.rows()));
  }
  /// The mobility of the free motions; rows and columns of the given ones are 0.
  MatrixXd free() const
  {
    MatrixXd R = MatrixXd::Zero(M.rows(), M.rows());
    for (long j = 0; j < M.rows(); ++j) {
      if (given[j]) continue;
      R.col(j) = constrained(M.col(j));
      for (long i = 0; i < M.rows(); ++i)
        if (given[i]) R(i, j) = 0.0;
    }
    return R;
  }
};

/// Strains are given, and all motions of the particles in `held`.
std::vector<bool> given_motions(long n, const std::vector<char> &held, bool rigid)
{
  std::vector<bool> given(11 * n, false);
  for (long k = 0; k < 11 * n; ++k)
    given[k] = k < 6 * n ? !held.empty() && held[k % (3 * n) / 3] : rigid;
  return given;
}

StepPlan plan_of(double dt, double kT, double viscosity)
{
  StepPlan p;
  p.turns = true;
  p.dt = dt;
  p.kT = kT;
  p.viscosity = viscosity;
  p.seed = 77;
  p.tolerance = 1e-11;
  return p;
}

ConstraintPlan how_to(const Grid &g, double tolerance)
{
  ConstraintPlan how;
  how.moments = Moments::stresslet;
  how.radius = hydrodynamic_radius(IbKernel::peskin4, g);
  how.tolerance = tolerance;
  return how;
}

}    // namespace

// M of forces, torques and stresslets equals P L^-1 P^T/(eta dV), with P by definition and L^-1
// from the dense saddle-point problem.  It is symmetric.  In a periodic box it is positive.
TEST(TypedStresslets, MobilityEqualsTheDenseReference)
{
  if (world().size() > 1) GTEST_SKIP() << "a test of its own compares numbers of ranks";
  int number = 0;
  for (const Grid &g : straining_grids()) {
    const IbKernel kernel = all_kernels[number++ % 3];
    SCOPED_TRACE(std::string(kernel_name(kernel)) + " " + wall_names(g));
    const std::vector<double> x = corner_and_middle(g);
    const Definition definition(g, kernel);
    const MatrixXd six = definition.matrix(x), five = definition.strain_matrix(x);
    MatrixXd P(22, six.cols());
    for (long k = 0; k < 12; ++k) P.row(6 * (k % 6 / 3) + 3 * (k / 6) + k % 3) = six.row(k);
    P.bottomRows(10) = five;
    const MatrixXd expected =
        P * definition.dense().stokes_inverse() * P.transpose() / (1.3 * g.cell_volume());
    const MatrixXd M = straining_mobility(g, kernel, x, 1.3);
    EXPECT_LT((M - expected).norm(), 1e-11 * expected.norm());
    EXPECT_LT((M - M.transpose()).norm(), 1e-12 * M.norm());
    const VectorXd e = Eigen::SelfAdjointEigenSolver<MatrixXd>(M).eigenvalues();
    EXPECT_GT(e.minCoeff(), 1e-6 * e.maxCoeff());
  }
}

TEST(TypedStresslets, DoNotDependOnTheNumberOfRanks)
{
  std::vector<Grid> grids = straining_grids();
  grids.push_back(make_grid({8, 7, 3}, {0.7}));
  for (const Grid &g : grids)
    for (IbKernel kernel : all_kernels) {
      if (kernel_width(kernel) > g.n[g.slow_axis()]) continue;
      SCOPED_TRACE(std::string(kernel_name(kernel)) + " " + wall_names(g));
      const std::vector<double> x = random_positions(g, 9, 5);
      Loads loads(9);
      loads.linear = random_numbers(27, 6);
      loads.angular = random_numbers(27, 7);
      loads.strain = random_numbers(45, 8);
      StokesProblem p = quiet(1.1, 1e-13);
      p.kT_over_dt = 0.4;
      p.seed = 99;
      p.stress = {{1.0, 0}};
      Straining together(g, kernel, world(), x), alone(g, kernel, self(), x);
      const VectorXd expected = alone.motion(loads, p).vector(),
                     m = together.motion(loads, p).vector();
      EXPECT_LT((m - expected).norm(), 1e-12 * expected.norm());
    }
}

namespace {

Grid grid_of(const nlohmann::json &c)
{
  return make_grid({c["n"][0], c["n"][1], c["n"][2]}, {c["h"].get<double>()}, 0.0);
}
IbKernel kernel_of(const nlohmann::json &c)
{
  return c["kernel_J"] == 4 ? IbKernel::peskin4 : IbKernel::roma3;
}
MatrixXd matrix_of(const nlohmann::json &rows)
{
  MatrixXd A(rows.size(), rows[0].size());
  for (long i = 0; i < A.rows(); ++i)
    for (long j = 0; j < A.cols(); ++j) A(i, j) = rows[i][j];
  return A;
}

}    // namespace

// Matrices and Schur complements of an independent program.
TEST(TypedStresslets, ReferenceMatrices)
{
  const auto cases = json_reference("fib_stresslet.json")["cases"];
  EXPECT_EQ(cases.size(), 4U);
  for (const auto &c : cases) {
    SCOPED_TRACE(c["id"].get<std::string>());
    const long n = c["N"];
    const std::vector<double> x = flatten(c["x"]);
    const MatrixXd M = straining_mobility(grid_of(c), kernel_of(c), x, c["eta"]);
    const MatrixXd expected = matrix_of(c["M"]), R = matrix_of(c["R"]);
    EXPECT_LT((M - expected).norm(), 1e-12 * expected.norm());
    const DenseConstraint rigid(M, given_motions(n, {}, true));
    EXPECT_LT((rigid.free().topLeftCorner(6 * n, 6 * n) - R).norm(), 1e-11 * R.norm());
  }
}

// Rigid spheres in a flow, with forces and torques: one step of the scheme against the solution of
// an independent program.
TEST(TypedStresslets, ReferenceSolutions)
{
  const auto cases = json_reference("fib_stresslet.json")["cases"];
  EXPECT_EQ(cases.size(), 4U);
  for (const auto &c : cases)
    for (double tolerance : {1e-3, 1e-9}) {
      SCOPED_TRACE(c["id"].get<std::string>() + " " + std::to_string(tolerance));
      const Grid g = grid_of(c);
      Fluid fluid(g, kernel_of(c), FftEffort::estimate, self(), Workers::one(), Moments::stresslet);
      ConstrainedBrownianStep<Backend> step(fluid);
      Noting p(flatten(c["x"]), flatten(c["torque"]), flatten(c["f"]));
      Constraint flow;
      flow.rigid = true;
      double E[3][3];
      for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b) E[a][b] = c["Einf"][a][b];
      strain_of(E, flow.flow);
      step.take(p, plan_of(1e-9, 0.0, c["eta"]), flow, how_to(g, tolerance));
      const auto error = [](const std::vector<double> &a, const std::vector<double> &b) {
        return difference(a, b) / norm(b);
      };
      EXPECT_LT(error(p.velocity, flatten(c["u_rel"])), tolerance + 1e-8);
      EXPECT_LT(error(p.omega, flatten(c["omega_rel"])), tolerance + 1e-8);
      const std::vector<double> s = step.to_host(step.loads().strain);
      std::vector<double> S, expected;
      for (long i = 0; i < c["N"].get<long>(); ++i)
        for (int a = 0; a < 3; ++a)
          for (int b = 0; b < 3; ++b) {
            S.push_back(Symmetric<double>::of(&s[5 * i]).at(a, b));
            expected.push_back(c["S"][i][a][b]);
          }
      EXPECT_LT(error(S, expected), tolerance + 1e-8);
    }
}

// The mobilities to strain give the tabulated radii, in the mean over positions.
TEST(TypedStresslets, MeanOverPositionsIsTheTabulatedRadius)
{
  for (IbKernel kernel : all_kernels) {
    const long n = 32, points = 3;
    const Grid g = make_grid({n, n, n}, {1.0}, 0.0);
    Straining s(g, kernel, world(), {0.0, 0.0, 0.0});
    double sum[2] = {}, weights = 0.0;
    for (long i = 0; i <= points; ++i)
      for (long j = 0; j <= points; ++j)
        for (long k = 0; k <= points; ++k) {
          s.bind({0.5 * i / points, 0.5 * j / points, 0.5 * k / points});
          const double w =
              (i % points ? 2.0 : 1.0) * (j % points ? 2.0 : 1.0) * (k % points ? 2.0 : 1.0);
          weights += w;
          for (int mode : {0, 3}) {
            Loads unit(1);
            unit.strain[mode] = 1.0;
            sum[mode / 3] += w * s.motion(unit, quiet(1.0)).strain[mode];
          }
        }
    // Image stresslets of a simple cubic lattice: Zuzovsky's b in the first terms of unittest/
    // reference/README.md, a share of 1/(5 eta V).
    constexpr double b = -0.04645;
    const double volume = std::pow(n, 3), share[2] = {1.0 + 40.0 * b, 1.0 - 60.0 * b};
    const auto radius = [&](int of) {
      const double alone = sum[of] / weights + share[of] / (5.0 * volume);
      return std::cbrt(3.0 / (20.0 * M_PI * alone));
    };
    const StressletRadii tabulated = stresslet_radii(kernel, g);
    SCOPED_TRACE(kernel_name(kernel));
    EXPECT_NEAR(radius(0), tabulated.shear, 1e-3 * tabulated.shear);
    EXPECT_NEAR(radius(1), tabulated.stretching, 1e-3 * tabulated.stretching);
  }
}

// Particles that are held, and rigid spheres among them, between walls: velocities and loads
// against the dense Schur complement.
TEST(TypedStresslets, HeldParticles)
{
  if (world().size() > 1) GTEST_SKIP() << "steps are compared elsewhere";
  const Grid g = with_walls(make_grid({9, 10, 8}, {0.7, 0.7, 0.7}), {"p", "p", "nn"});
  const long n = 5;
  const std::vector<double> x = random_positions(g, n, 4, 0.8);
  const std::vector<double> given = random_numbers(3 * n, 5), force = random_numbers(3 * n, 6),
                            torque = random_numbers(3 * n, 7);
  const std::vector<char> held{0, 1, 0, 1, 1};
  const MatrixXd M = straining_mobility(g, IbKernel::peskin4, x, 1.3);
  for (bool rigid : {false, true}) {
    const std::vector<bool> which = given_motions(n, held, rigid);
    Loads known(n), target(n);
    known.linear = force;
    known.angular = torque;
    for (long k = 0; k < 11 * n; ++k)
      if (which[k]) known.at(k) = 0.0;
    for (long k = 0; k < 3 * n; ++k)
      if (held[k / 3]) target.linear[k] = given[k];
    const VectorXd V = M * known.vector();
    const VectorXd unknown = DenseConstraint(M, which).loads(V, target.vector()),
                   motion = V + M * unknown;
    Fluid fluid(g, IbKernel::peskin4, FftEffort::estimate, self(), Workers::one(),
                Moments::stresslet);
    ConstrainedBrownianStep<Backend> step(fluid);
    Noting p(x, torque, force);
    Constraint constraint;
    constraint.rigid = rigid;
    const auto there_held = Backend::Execution::from_host(held);
    const auto there = Backend::Execution::from_host(given);
    constraint.held = there_held.data();
    constraint.velocity = there.data();
    step.take(p, plan_of(1e-9, 0.0, 1.3), constraint, how_to(g, 1e-9));
    for (long k = 0; k < 3 * n; ++k) {
      EXPECT_NEAR(p.velocity[k], motion[k], 1e-7 * motion.norm()) << rigid << " " << k;
      EXPECT_NEAR(p.omega[k], motion[3 * n + k], 1e-7 * motion.norm()) << rigid << " " << k;
      EXPECT_NEAR(step.to_host(step.loads().linear)[k], unknown[k], 1e-6 * unknown.norm());
      if (held[k / 3]) {
        EXPECT_EQ(p.velocity[k], given[k]);
      }
    }
  }
}

namespace {

/// Motions of free particles without forces, [all U; all W], in single steps from one place.
class FreeMotions {
 public:
  FreeMotions(const Grid &g, const std::vector<double> &x, const std::vector<char> &held,
              bool rigid) :
      fluid_(g, IbKernel::peskin4, FftEffort::estimate, self(), Workers::one(), Moments::stresslet),
      step_(fluid_), how_(how_to(g, 1e-8)),
      particles_(x, std::vector<double>(x.size(), 0.0), std::vector<double>(x.size(), 0.0)),
      held_(Backend::Execution::from_host(held)),
      rest_(Backend::Execution::from_host(std::vector<double>(x.size(), 0.0)))
  {
    constraint_.rigid = rigid;
    if (held.empty()) return;
    constraint_.held = held_.data();
    constraint_.velocity = rest_.data();
  }
  VectorXd operator()(const StepPlan &plan)
  {
    step_.take(particles_, plan, constraint_, how_);
    const long n = bdh::ssize(particles_.velocity);
    VectorXd v(2 * n);
    for (long k = 0; k < n; ++k) {
      v[k] = particles_.velocity[k];
      v[n + k] = particles_.omega[k];
    }
    return v;
  }

 private:
  Fluid fluid_;
  ConstrainedBrownianStep<Backend> step_;
  ConstraintPlan how_;
  Noting particles_;
  Backend::Execution::Flags held_;
  Backend::ParticleVector rest_;
  Constraint constraint_;
};

struct ConstrainedScene {
  std::string name;
  Grid grid;
  std::vector<double> x;
  std::vector<char> held;    // empty: none
  bool rigid;
};

/// Near particles, in a box and at a wall.
std::vector<ConstrainedScene> scenes()
{
  const Grid box = make_grid({8, 9, 8}, {1.0}, 0.0),
             slit = with_walls(make_grid({8, 8, 7}, {1.0}, 0.0), {"p", "p", "nn"});
  const std::vector<double> pair = {3.1, 4.2, 1.6, 4.6, 4.9, 2.3},
                            low = {3.1, 4.2, 0.9, 4.6, 4.9, 0.7};
  return {{"rigid", box, pair, {}, true},
          {"rigid at a wall", slit, low, {}, true},
          {"held at a wall", slit, low, {0, 1}, false}};
}

}    // namespace

// The force of the thermal drift is that of the free particles: kT times the divergence of their
// spreading, by differences, in the fluid with its constraint.
TEST(TypedStresslets, DriftsForceIsThatOfFreeParticles)
{
  const double kT = 0.7, shift = 1e-4;
  for (const ConstrainedScene &s : scenes()) {
    SCOPED_TRACE(s.name);
    const std::vector<bool> given = given_motions(2, s.held, s.rigid);
    Straining fluid(s.grid, IbKernel::peskin4, self(), s.x);
    VectorXd motion = VectorXd::Zero(22);
    for (long j = 0; j < 6; ++j)
      for (double sign : {1.0, -1.0}) {
        std::vector<double> moved = s.x;
        moved[j] += sign * shift;
        Loads unit(2);
        unit.linear[j] = 1.0;
        if (!given[j])
          motion += kT * sign / (2.0 * shift) *
                    fluid.motion_elsewhere(moved, s.x, unit, quiet(1.3)).vector();
      }
    const DenseConstraint dense(straining_mobility(s.grid, IbKernel::peskin4, s.x, 1.3), given);
    const VectorXd expected = dense.constrained(motion);
    FreeMotions motions(s.grid, s.x, s.held, s.rigid);
    StepPlan with = plan_of(1e-6, kT, 1.3);
    with.corrector = false;
    StepPlan without = with;
    without.drift = Drift::no;
    const VectorXd v = motions(with) - motions(without);
    for (long i = 0; i < 12; ++i) EXPECT_NEAR(v[i], given[i] ? 0.0 : expected[i], 2e-6) << i;
    EXPECT_GT(expected.head(12).norm(), 1e-4);    // 100 times the bound
  }
}

// Covariance of the free motions: 2 kT/dt times the Schur complement.  Entries as in
// StatisticsTurning.
TEST(StatisticsConstraints, CovarianceOfFreeMotions)
{
  for (const ConstrainedScene &s : scenes()) {
    SCOPED_TRACE(s.name);
    FreeMotions motions(s.grid, s.x, s.held, s.rigid);
    StepPlan plan = plan_of(1e-9, 0.7e-9, 1.3);
    const long samples = 3000;
    MatrixXd C = MatrixXd::Zero(12, 12);
    for (long step = 0; step < samples; ++step) {
      plan.step = step;
      const VectorXd v = motions(plan);
      C += v * v.transpose() / double(samples);
    }
    const DenseConstraint dense(straining_mobility(s.grid, IbKernel::peskin4, s.x, 1.3),
                                given_motions(2, s.held, s.rigid));
    const MatrixXd expected = 2.0 * 0.7 * dense.free().topLeftCorner(12, 12);
    double sum = 0.0, entries = 0.0;
    for (long i = 0; i < 12; ++i)
      for (long j = 0; j <= i; ++j) {
        const double variance = expected(i, i) * expected(j, j) + expected(i, j) * expected(i, j);
        if (variance == 0.0) {
          EXPECT_EQ(C(i, j), 0.0);
          continue;
        }
        const double error = C(i, j) - expected(i, j);
        sum += error * error * samples / variance;
        entries += 1.0;
      }
    EXPECT_LT(sum / entries, 2.0);
    EXPECT_GT(sum / entries, 0.3);
  }
}

// The mean motion without forces is kT times the divergence of the Schur complement with respect to
// the free positions, by differences of dense matrices.  What the same noise does without a
// predictor and without the drift's force has the mean 0 and is subtracted.
TEST(StatisticsConstraints, MeanMotionIsTheDivergenceOfTheSchurComplement)
{
  const double kT = 0.7, shift = 1e-4;
  for (const ConstrainedScene &s : scenes()) {
    SCOPED_TRACE(s.name);
    const std::vector<bool> given = given_motions(2, s.held, s.rigid);
    VectorXd divergence = VectorXd::Zero(12);
    for (long j = 0; j < 6; ++j) {
      if (given[j]) continue;
      for (double sign : {1.0, -1.0}) {
        std::vector<double> moved = s.x;
        moved[j] += sign * shift;
        const DenseConstraint dense(straining_mobility(s.grid, IbKernel::peskin4, moved, 1.3),
                                    given);
        divergence += kT * sign / (2.0 * shift) * dense.free().col(j).head(12);
      }
    }
    FreeMotions motions(s.grid, s.x, s.held, s.rigid), still = {s.grid, s.x, s.held, s.rigid};
    StepPlan plan = plan_of(1e-6, kT, 1.3), without = plan;
    without.corrector = false;
    without.drift = Drift::no;
    std::vector<Mean> mean(12);
    for (long step = 0; step < 6000; ++step) {
      plan.step = without.step = step;
      const VectorXd v = motions(plan) - still(without);
      for (long i = 0; i < 12; ++i) mean[i].add(v[i]);
    }
    double seen = 0.0;
    for (long i = 0; i < 12; ++i) {
      if (given[i]) continue;
      EXPECT_LT(std::fabs(mean[i].z(divergence[i])), 4.0) << i << " " << divergence[i];
      seen = std::max(seen, std::fabs(divergence[i]) / mean[i].error());
    }
    EXPECT_GT(seen, 10.0);    // it would be missed
  }
}
