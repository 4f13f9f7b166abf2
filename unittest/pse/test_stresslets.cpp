// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Laws of positively split Ewald with stresslets, against numbers of independent programs.
#include "oracle/dense_spheres.h"
#include "pse/sphere_support.h"
#include "support/reference_json.h"

#include <Eigen/Dense>
#include <gtest/gtest.h>

using namespace bdh_test;
using bdh::pi;
using bdh::PseNoise;
using bdh::strain_numbers;

namespace {

using Vector = std::vector<double>;
using Matrix = Eigen::MatrixXd;

Spheres spheres_of(const nlohmann::json &c)
{
  const long n = bdh::ssize(c["x"]);
  const Vector radius =
      c.contains("radius") ? c["radius"].get<Vector>() : Vector(n, c["a"].get<double>());
  bdh::Cell cell = c.contains("box") ? cell_of(c["box"]) : cubic_cell(c["L"]);
  return {cell, flatten(c["x"]), radius, true, true};
}

/// Number k of all velocities, all angular velocities, all rates of strain.
double &number(Motions &m, long n, long k)
{
  if (k < 3 * n) return m.linear[k];
  if (k < 6 * n) return m.angular[k - 3 * n];
  return m.strain[k - 6 * n];
}

Motions zeros(long n)
{
  return {Vector(3 * n, 0.0), Vector(3 * n, 0.0), Vector(strain_numbers * n, 0.0)};
}

/// The roots of the free mobilities at viscosity 1.
Vector free_roots(const Spheres &s)
{
  const long n = s.count();
  Vector roots;
  for (long k = 0; k < 11 * n; ++k) {
    const double a = s.radius[k < 6 * n ? k % (3 * n) / 3 : (k - 6 * n) / strain_numbers],
                 cube = a * a * a;
    roots.push_back(std::sqrt(k < 3 * n   ? 1.0 / (6.0 * pi * a)
                              : k < 6 * n ? 1.0 / (8.0 * pi * cube)
                                          : 3.0 / (20.0 * pi * cube)));
  }
  return roots;
}

/// A linear function of loads as a matrix.
template <class Action> Matrix matrix(long n, const Action &action)
{
  Matrix A(11 * n, 11 * n);
  for (long j = 0; j < 11 * n; ++j) {
    Motions load = zeros(n);
    number(load, n, j) = 1.0;
    Motions u = action(load);
    for (long i = 0; i < 11 * n; ++i) A(i, j) = number(u, n, i);
  }
  return A;
}

Matrix scaled(Matrix A, const Vector &roots)
{
  for (long i = 0; i < A.rows(); ++i)
    for (long j = 0; j < A.cols(); ++j) A(i, j) /= roots[i] * roots[j];
  return A;
}

}    // namespace

TEST(Stresslets, MatrixOfPairs)
{
  const auto cases = json_reference("fts_pairs.json")["cases"];
  for (const auto &c : cases) {
    const Spheres s = spheres_of(c);
    const Vector roots = free_roots(s);
    const double eta = c["eta"];
    Matrix exact(22, 22);
    for (int i = 0; i < 22; ++i)
      for (int j = 0; j < 22; ++j) exact(i, j) = c["M"][i][j].get<double>() * eta;
    for (double tolerance : {1e-3, 1e-8}) {
      SphereHarness M(s, bdh::plan_pse(s.scene(tolerance)));
      const Matrix fast = matrix(2, [&](const Motions &load) { return M.apply(load, 1.0); });
      const Matrix error = scaled(fast - exact, roots);
      EXPECT_LE(error.cwiseAbs().maxCoeff(), 0.5 * tolerance) << c["id"];
      EXPECT_LE(scaled(fast - fast.transpose(), roots).cwiseAbs().maxCoeff(),
                tolerance < 1e-6 ? 1e-13 : 1e-5)
          << c["id"];
    }
  }
}

namespace {

/// Five numbers of a tensor's symmetric traceless part.
void five_of(const nlohmann::json &tensor, double *five)
{
  double G[3][3];
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) G[a][b] = tensor[a][b];
  bdh::strain_of(G, five);
}

/// Rigid spheres in a flow.
struct Rigid {
  Motions motion, unknown;
  int iterations;
  Rigid(const Spheres &s, const Motions &loads, const bdh::Constraint &constraint, double viscosity,
        double tolerance)
  {
    SphereHarness M(s, bdh::plan_pse(s.scene(tolerance)));
    motion =
        M.constrained(loads, constraint, viscosity, bdh::constraint_share * tolerance, unknown);
    iterations = M.report.constraint_iterations;
  }
};

bdh::Constraint rigid_in(const nlohmann::json &flow)
{
  bdh::Constraint c;
  c.rigid = true;
  five_of(flow, c.flow);
  return c;
}

Vector fives_of(const nlohmann::json &tensors)
{
  Vector all;
  for (const auto &t : tensors) {
    double five[strain_numbers];
    five_of(t, five);
    all.insert(all.end(), five, five + strain_numbers);
  }
  return all;
}

}    // namespace

TEST(Stresslets, RigidSpheresInShear)
{
  const auto cases = json_reference("fts_rigid.json")["cases"];
  for (const auto &c : cases) {
    const Spheres s = spheres_of(c);
    for (double tolerance : {1e-2, 1e-4, 1e-6, 1e-8}) {
      const Rigid r(s, {flatten(c["f"]), flatten(c["torque"])}, rigid_in(c["Einf"]), c["eta"],
                    tolerance);
      const double u = relative_error(r.motion.linear, flatten(c["u_rel"])),
                   w = relative_error(r.motion.angular, flatten(c["omega_rel"])),
                   S = relative_error(r.unknown.strain, fives_of(c["S"]));
      EXPECT_LE(u, tolerance) << c["id"];
      EXPECT_LE(w, tolerance) << c["id"];
      EXPECT_LE(S, tolerance) << c["id"];
    }
  }
}

TEST(Stresslets, HardSpheres)
{
  const auto cases = json_reference("fts_hard_spheres.json")["cases"];
  for (const auto &c : cases) {
    const Spheres s = spheres_of(c);
    const Vector S5 = flatten(c["S5"]);
    for (double tolerance : {1e-2, 1e-4, 1e-6, 1e-8}) {
      const Rigid r(s, {flatten(c["f"]), flatten(c["torque"])}, rigid_in(c["Einf"]), c["eta"],
                    tolerance);
      const double u = relative_error(r.motion.linear, flatten(c["u_rel"])),
                   w = relative_error(r.motion.angular, flatten(c["omega_rel"])),
                   S = relative_error(r.unknown.strain, S5);
      EXPECT_LE(u, tolerance) << c["id"];
      EXPECT_LE(w, tolerance) << c["id"];
      EXPECT_LE(S, tolerance) << c["id"];
    }
  }
}

// Lattices have closed forms: one sphere in a cube, strained along and off the axes.
TEST(Stresslets, ViscosityOfASimpleCubicLattice)
{
  const double phi = 0.1, L = std::cbrt(4.0 / 3.0 * pi / phi),
               relative[strain_numbers] = {1.2411773063017446, 1.2411773063017446,
                                           1.2411773063017446, 1.359646335197423,
                                           1.359646335197423};
  const Spheres s{cubic_cell(L), {0.3, 0.1, -0.2}, {1.0}, true, true};
  for (int mode = 0; mode < strain_numbers; ++mode) {
    bdh::Constraint flow;
    flow.rigid = true;
    flow.flow[mode] = 1.0;
    const Rigid r(s, {Vector(3, 0.0), Vector(3, 0.0)}, flow, 1.0, 1e-7);
    EXPECT_NEAR(1.0 - r.unknown.strain[mode] / (2.0 * L * L * L), relative[mode], 1e-7) << mode;
  }
}

// Loads on held spheres, against the dense Schur complement: velocities of the others and forces.
TEST(Stresslets, HeldSpheres)
{
  const long n = 12;
  Spheres s{cubic_cell(7.0), random_numbers(3 * n, 5), Vector(n, 1.0), true};
  for (double &x : s.x) x *= 7.0;
  for (long i = 0; i < n; ++i) s.radius[i] = 0.5 + 0.04 * i;
  const Vector M = bdh::dense_spheres(s.cell, s.x, s.radius, 1.2), some = random_numbers(6 * n, 8);
  std::vector<char> held(n, 0);
  for (long i = 0; i < n; i += 3) held[i] = 1;
  const auto is_held = [&](long k) { return held[k % (3 * n) / 3] != 0; };
  Vector given(3 * n, 0.0), turning(3 * n, 0.0);
  Eigen::VectorXd target = Eigen::VectorXd::Zero(6 * n), load = target;
  for (long k = 0; k < 6 * n; ++k) {
    if (is_held(k)) {
      target[k] = 0.1 * some[k];
      (k < 3 * n ? given[k] : turning[k - 3 * n]) = target[k];
    } else {
      load[k] = some[k];
    }
  }
  Matrix A(6 * n, 6 * n), constrained;
  for (long i = 0; i < 6 * n; ++i)
    for (long j = 0; j < 6 * n; ++j) A(i, j) = M[i * 6 * n + j];
  Matrix cc = Matrix::Identity(6 * n, 6 * n);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(6 * n), V = A * load;
  for (long i = 0; i < 6 * n; ++i)
    if (is_held(i)) {
      right[i] = target[i] - V[i];
      for (long j = 0; j < 6 * n; ++j) cc(i, j) = is_held(j) ? A(i, j) : 0.0;
    }
  const Eigen::VectorXd unknown = cc.partialPivLu().solve(right);
  V += A * unknown;
  for (double tolerance : {1e-3, 1e-7}) {
    SphereHarness fast(s, bdh::plan_pse(s.scene(tolerance)));
    bdh::Constraint constraint;
    constraint.held = held.data();
    constraint.velocity = given.data();
    constraint.angular = turning.data();
    Motions loads{Vector(load.data(), load.data() + 3 * n),
                  Vector(load.data() + 3 * n, load.data() + 6 * n)},
        found;
    for (const bool guess : {false, true}) {
      const Motions u =
          fast.constrained(loads, constraint, 1.2, bdh::constraint_share * tolerance, found, guess);
      EXPECT_LE(relative_error(u.linear, Vector(V.data(), V.data() + 3 * n)), tolerance);
      EXPECT_LE(relative_error(u.angular, Vector(V.data() + 3 * n, V.data() + 6 * n)), tolerance);
      EXPECT_LE(relative_error(found.linear, Vector(unknown.data(), unknown.data() + 3 * n)),
                2.0 * tolerance);
      EXPECT_LE(
          relative_error(found.angular, Vector(unknown.data() + 3 * n, unknown.data() + 6 * n)),
          2.0 * tolerance);
    }
  }
}

// What spheres that are alone would need is a guess worth an iteration, in any unit of viscosity.
TEST(Stresslets, AGuessSavesAnIteration)
{
  const Spheres s = spheres_of(json_reference("fts_rigid.json")["cases"][0]);
  bdh::Constraint flow;
  flow.rigid = true;
  flow.flow[1] = 0.7;
  const Motions none{Vector(3 * s.radius.size(), 0.0), {}};
  for (const double viscosity : {1.0, 30.0}) {
    SphereHarness M(s, bdh::plan_pse(s.scene(1e-6)));
    Motions unknown, with_guess;
    M.constrained(none, flow, viscosity, 1e-7, unknown);
    const int without = M.report.constraint_iterations;
    M.constrained(none, flow, viscosity, 1e-7, with_guess, true);
    EXPECT_LT(M.report.constraint_iterations, without) << viscosity;
    EXPECT_LT(relative_error(with_guess.strain, unknown.strain), 1e-6);
  }
}

// Coincident spheres have one strain and two stresslets: an error, not an endless loop.
TEST(Stresslets, SpheresAtOnePlaceAreAnError)
{
  const Spheres s{cubic_cell(8.0), {1, 1, 1, 1, 1, 1}, {1.0, 1.0}, true, true};
  bdh::Constraint flow;
  flow.rigid = true;
  flow.flow[0] = 1.0;
  SphereHarness M(s, bdh::plan_pse(s.scene(1e-6)));
  Motions unknown;
  // Equal strains have a solution, which conjugate gradients find.
  EXPECT_NO_THROW(M.constrained({Vector(6, 0.0), {}}, flow, 1.0, 1e-6, unknown));
  const std::vector<char> held{1, 1};
  const Vector apart{1, 0, 0, -1, 0, 0};
  flow.held = held.data();
  flow.velocity = apart.data();
  EXPECT_THROW(M.constrained({Vector(6, 0.0), {}}, flow, 1.0, 1e-6, unknown), bdh::NotConverged);
}

// The slip of all 22 motions of two unequal spheres that overlap, in 20000 draws within 5 standard
// errors of 2 kT M/dt: 253 entries would exceed that once in 7000 seeds.
TEST(StatisticsStresslets, CovarianceOfTheSlip)
{
  const auto cases = json_reference("fts_pairs.json")["cases"];
  for (const auto &c : cases) {
    if (c["id"] != "shear-poly-overlapping") continue;
    const Spheres s = spheres_of(c);
    bdh::PseScene scene = s.scene(1e-4);
    scene.xi = 0.7 / scene.radius;
    SphereHarness pse(s, bdh::plan_pse(scene));
    const double variance = 3.4;
    std::vector<Mean> entry(22 * 22);
    for (int step = 0; step < 20000; ++step) {
      Motions u = pse.random(PseNoise{variance, 31, static_cast<uint64_t>(step)}, c["eta"]);
      for (long i = 0; i < 22; ++i)
        for (long j = 0; j <= i; ++j) entry[22 * i + j].add(number(u, 2, i) * number(u, 2, j));
    }
    for (long i = 0; i < 22; ++i)
      for (long j = 0; j <= i; ++j)
        EXPECT_LT(std::fabs(entry[22 * i + j].z(variance * c["M"][i][j].get<double>())), 5.0)
            << i << " " << j;
  }
}
