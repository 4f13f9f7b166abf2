// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Laws of positively split Ewald with stresslets, against numbers of independent programs.
#include "pse/sphere_support.h"
#include "support/reference_json.h"

#include <Eigen/Dense>
#include <gtest/gtest.h>

using namespace bdh_test;
using bdh::pi;
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
