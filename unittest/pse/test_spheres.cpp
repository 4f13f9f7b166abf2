// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// Positively split Ewald for spheres of any radii, with and without rotation, compared with
// independent references.

#include "base/constants.h"
#include "oracle/dense_spheres.h"
#include "pse/near_table.h"
#include "pse/sphere_support.h"
#include "support/reference_json.h"

#include <Eigen/Dense>
#include <gtest/gtest.h>

using namespace bdh_test;
using bdh::Cell;
using bdh::pi;
using bdh::PseNoise;
using bdh::PsePlan;
using bdh::PseScene;

namespace {

using Vector = std::vector<double>;

const double tolerances[] = {1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-7, 1e-10};

Spheres spheres_of(const nlohmann::json &c, bool rotation)
{
  return {cell_of(c["box"]), flatten(c["x"]), c["radius"].get<Vector>(), rotation};
}

Cell triclinic(double L)
{
  Cell c = cubic_cell(L);
  c.ly = 1.1 * L, c.xy = 0.2 * L, c.xz = -0.3 * L, c.yz = 0.15 * L;
  return c;
}

/// Spheres anywhere in a box, with radii from 1/ratio to 1 that are evenly spread in the logarithm.
Spheres random_spheres(long n, double L, double ratio, bool rotation, unsigned seed)
{
  Spheres s{triclinic(L), random_numbers(3 * n, seed), {}, rotation};
  for (double &c : s.x) c *= L;
  for (double c : random_numbers(n, seed + 1)) s.radius.push_back(std::pow(ratio, -std::fabs(c)));
  s.radius[0] = 1.0;
  s.radius[n - 1] = 1.0 / ratio;
  return s;
}

/// A small sphere within a large one, two nearly coincident ones, and pairs in touch.
Spheres nested_spheres(double ratio, bool rotation)
{
  const double a = 1.0 / ratio;
  return {triclinic(9.0),
          {0, 0, 0, 0.3, 0.2, -0.1, 2.0, 0, 0, 2.05, 0.02, 0.0, 2.0 + 1.0 + a, 0, 0, 5, 5, 5},
          {1.0, a, 1.0, 0.97, a, 2.0 * a},
          rotation};
}

/// The same random spheres, with no other radii than 1 and 1/ratio.
Spheres two_sizes(long n, double L, double ratio, bool rotation, unsigned seed)
{
  Spheres s = random_spheres(n, L, ratio, rotation, seed);
  for (long i = 0; i < n; ++i) s.radius[i] = i % 3 ? 1.0 / ratio : 1.0;
  return s;
}

/// The matrix of a linear function of loads, scaled by the free mobilities.
template <class Action> Eigen::MatrixXd scaled_matrix(const Spheres &s, const Action &action)
{
  const long n = s.count(), size = s.rotation ? 6 * n : 3 * n;
  const auto root = [&](long k) {
    const double a = s.radius[k % (3 * n) / 3];
    return k < 3 * n ? std::sqrt(6.0 * pi * a) : std::sqrt(8.0 * pi * a * a * a);
  };
  Eigen::MatrixXd A(size, size);
  for (long j = 0; j < size; ++j) {
    Motions load{Vector(3 * n, 0.0), s.rotation ? Vector(3 * n, 0.0) : Vector()};
    (j < 3 * n ? load.linear[j] : load.angular[j - 3 * n]) = root(j);
    const Motions u = action(load);
    for (long i = 0; i < size; ++i)
      A(i, j) = root(i) * (i < 3 * n ? u.linear[i] : u.angular[i - 3 * n]);
  }
  return A;
}

Eigen::MatrixXd whole_matrix(const Spheres &s, const PsePlan &plan)
{
  SphereHarness M(s, plan);
  return scaled_matrix(s, [&](const Motions &load) { return M.apply(load, 1.0); });
}

Eigen::MatrixXd oracle(const Spheres &s)
{
  const long n = s.count(), size = s.rotation ? 6 * n : 3 * n;
  const Vector M = bdh::dense_spheres(s.cell, s.x, s.radius, 1.0);
  return scaled_matrix(s, [&](const Motions &load) {
    Motions u{Vector(3 * n, 0.0), Vector(3 * n, 0.0)};
    for (long i = 0; i < size; ++i)
      for (long j = 0; j < size; ++j)
        (i < 3 * n ? u.linear[i] : u.angular[i - 3 * n]) +=
            M[i * 6 * n + j] * (j < 3 * n ? load.linear[j] : load.angular[j - 3 * n]);
    return u;
  });
}

double least_eigenvalue(const Eigen::MatrixXd &A)
{
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(A).eigenvalues()(0);
}

double asymmetry(const Eigen::MatrixXd &A) { return (A - A.transpose()).cwiseAbs().maxCoeff(); }

std::vector<Spheres> scenes()
{
  std::vector<Spheres> all;
  for (bool rotation : {false, true})
    for (double ratio : {1.0, 2.0, 4.0, 10.0}) {
      if (ratio == 1.0 && !rotation) continue;
      all.push_back(random_spheres(12, 6.0, ratio, rotation, 3));
      all.push_back(nested_spheres(ratio, rotation));
      if (ratio > 1.0) all.push_back(two_sizes(12, 6.0, ratio, rotation, 7));
    }
  return all;
}

std::string name(const Spheres &s)
{
  return (s.rotation ? "rotating, n " : "n ") + std::to_string(s.count()) + ", least radius " +
         std::to_string(*std::min_element(s.radius.begin(), s.radius.end()));
}

}    // namespace

TEST(Spheres, ReferenceCasesOfUnequalRadii)
{
  const auto cases = json_reference("rpy_periodic_poly.json")["cases"];
  for (const auto &c : cases) {
    const Spheres s = spheres_of(c, false);
    for (double tolerance : tolerances) {
      SphereHarness M(s, bdh::plan_pse(s.scene(tolerance)));
      const Motions u = M.apply({flatten(c["f"]), {}}, c["eta"]);
      EXPECT_LE(relative_error(u.linear, flatten(c["u"])), tolerance) << c["id"];
    }
  }
}

TEST(Spheres, ReferenceCasesOfRotation)
{
  const auto cases = json_reference("rpy_periodic_rot.json")["cases"];
  for (const auto &c : cases) {
    const Spheres s = spheres_of(c, true);
    for (double tolerance : tolerances) {
      SphereHarness M(s, bdh::plan_pse(s.scene(tolerance)));
      const Motions u = M.apply({flatten(c["f"]), flatten(c["torque"])}, c["eta"]);
      EXPECT_LE(relative_error(u.linear, flatten(c["u"])), tolerance) << c["id"];
      EXPECT_LE(relative_error(u.angular, flatten(c["omega"])), tolerance) << c["id"];
    }
  }
}

// The dense oracle itself, against the independent program.
TEST(Spheres, OracleAgreesWithReference)
{
  const auto cases = json_reference("rpy_periodic_rot.json")["cases"];
  for (const auto &c : cases) {
    const Spheres s = spheres_of(c, true);
    if (s.count() > 10) continue;
    const std::size_t n = s.count();
    const Vector M = bdh::dense_spheres(s.cell, s.x, s.radius, c["eta"]);
    const Vector f = flatten(c["f"]), t = flatten(c["torque"]), u = flatten(c["u"]),
                 w = flatten(c["omega"]);
    Vector linear(3 * n, 0.0), angular = linear;
    for (std::size_t i = 0; i < 6 * n; ++i)
      for (std::size_t j = 0; j < 6 * n; ++j)
        (i < 3 * n ? linear[i] : angular[i - 3 * n]) +=
            M[i * 6 * n + j] * (j < 3 * n ? f[j] : t[j - 3 * n]);
    EXPECT_LE(relative_error(linear, u), 1e-11) << c["id"];
    EXPECT_LE(relative_error(angular, w), 1e-11) << c["id"];
  }
}

// Ratios up to 10, nested spheres and those that nearly coincide, in units of the free mobilities.
TEST(Spheres, MatrixIsThatOfTheOracle)
{
  for (const Spheres &s : scenes()) {
    const Eigen::MatrixXd exact = oracle(s), fast = whole_matrix(s, bdh::plan_pse(s.scene(1e-8)));
    EXPECT_LE((fast - exact).cwiseAbs().maxCoeff(), 1e-7) << name(s);
    EXPECT_LE(asymmetry(fast), 1e-13) << name(s);
  }
}

// Forces alone and torques alone keep the tolerance in what they cause, velocities and angular
// velocities each by itself.
TEST(Spheres, ForcesAloneAndTorquesAlone)
{
  for (double ratio : {1.0, 4.0})
    for (double L : {7.0, 20.0}) {
      Spheres s = random_spheres(24, L, ratio, true, 9);
      const std::size_t n = s.count();
      const Vector M = bdh::dense_spheres(s.cell, s.x, s.radius, 1.0),
                   some = random_numbers(3 * n, 4), none(3 * n, 0.0);
      for (bool torques : {false, true}) {
        const Motions load{torques ? none : some, torques ? some : none};
        Vector linear(none), angular(none);
        for (std::size_t i = 0; i < 6 * n; ++i)
          for (std::size_t j = 0; j < 3 * n; ++j)
            (i < 3 * n ? linear[i] : angular[i - 3 * n]) +=
                M[i * 6 * n + j + (torques ? 3 * n : 0)] * some[j];
        for (double tolerance : {1e-2, 1e-3, 1e-5}) {
          SphereHarness fast(s, bdh::plan_pse(s.scene(tolerance)));
          const Motions u = fast.apply(load, 1.0);
          EXPECT_LE(relative_error(u.linear, linear), tolerance)
              << name(s) << " torques " << torques;
          EXPECT_LE(relative_error(u.angular, angular), tolerance)
              << name(s) << " torques " << torques;
        }
      }
    }
}

// Noise needs a root of either part.
TEST(Spheres, BothPartsArePositive)
{
  for (const Spheres &s : scenes())
    for (double xi : {0.3, 0.6, 1.1}) {    // in the inverse of the greatest radius
      PseScene scene = s.scene(1e-6);
      scene.xi = xi / scene.radius;
      SphereHarness M(s, bdh::plan_pse(scene));
      const auto far = scaled_matrix(s, [&](const Motions &l) { return M.far(l, {}); });
      const auto near = scaled_matrix(s, [&](const Motions &l) { return M.near(l); });
      EXPECT_GE(least_eigenvalue(far), -1e-12) << name(s) << " xi " << xi;
      // Coincident spheres leave an eigenvalue of 0.
      EXPECT_GE(least_eigenvalue(near), -1e-6) << name(s) << " xi " << xi;
      RecordProperty(name(s) + " xi " + std::to_string(xi), std::to_string(least_eigenvalue(near)));
    }
}

namespace {

/// The plan with a Kaiser-Bessel splitting in double precision; false if this xi has none.
bool kaiser_bessel_plan(PseScene scene, double xi, PsePlan &plan)
{
  scene.precision = bdh::Precision::double_precision;
  scene.splitting = bdh::Splitting::kaiser_bessel;
  scene.xi = xi;
  try {
    plan = bdh::plan_pse(scene);
  } catch (const bdh::InvalidOption &) {
    return false;
  }
  return true;
}

/// The same suspension, where cutoffs are not limited by the box.
PseScene in_larger_box(PseScene scene)
{
  scene.particles *= 1000;
  scene.volume *= 1000.0;
  for (double &edge : scene.edge) edge *= 10.0;
  return scene;
}

}    // namespace

// As far as plans have such splittings: their cutoffs are longer than two radii.
TEST(Spheres, BothPartsOfKaiserBesselSplittingsArePositive)
{
  double greatest[2] = {0.0, 0.0};    // xi, without and with rotation
  for (const Spheres &s : scenes())
    for (double tolerance : {1e-1, 1e-2, 1e-3, 1e-5})
      for (double xi = 0.3; xi < 0.95; xi += 0.05) {
        PsePlan plan;
        if (!kaiser_bessel_plan(s.scene(tolerance), xi, plan)) continue;
        greatest[s.rotation] = std::max(greatest[s.rotation], xi);
        SphereHarness M(s, plan);
        const auto far = scaled_matrix(s, [&](const Motions &l) { return M.far(l, {}); });
        const auto near = scaled_matrix(s, [&](const Motions &l) { return M.near(l); });
        EXPECT_GE(least_eigenvalue(far), -1e-12) << name(s) << " xi " << xi;
        // What the cutoff leaves out may be negative.
        EXPECT_GE(least_eigenvalue(near), -0.1 * tolerance)
            << name(s) << " xi " << xi << " tolerance " << tolerance;
      }
  EXPECT_GE(greatest[0], 0.63);
  EXPECT_GE(greatest[1], 0.58);
}

// Torques do not have the shape that wave space gives them, which shows where spheres overlap by
// far: here their volume is three times that of the box.  The plans are for larger boxes of that
// density.
TEST(Spheres, NearPartOfKaiserBesselSplittingsIsPositiveInACrowd)
{
  int plans = 0;
  for (double ratio : {1.0, 1.03}) {
    const Spheres s = random_spheres(20, 2.9, ratio, true, 3);
    for (double tolerance : {1e-1, 1e-2, 1e-3})
      for (double xi = 0.4; xi < 0.95; xi += 0.05) {
        PsePlan plan;
        if (!kaiser_bessel_plan(in_larger_box(s.scene(tolerance)), xi, plan)) continue;
        ++plans;
        SphereHarness M(s, plan);
        const auto near = scaled_matrix(s, [&](const Motions &l) { return M.near(l); });
        // 0.05 up to the greatest xi, 0.02 soon after it.
        EXPECT_GE(least_eigenvalue(near), 0.045) << xi << " " << tolerance;
      }
  }
  EXPECT_GE(plans, 20);
}

// Two terms for spheres of several radii do not have the shapes of spheres either.
TEST(Spheres, NearPartIsPositiveInACrowdOfTwoSizes)
{
  int plans = 0;
  for (double ratio : {2.0, 10.0}) {
    const Spheres s = two_sizes(24, 2.9, ratio, false, 3);
    for (double tolerance : {1e-1, 1e-2, 1e-3})
      for (double xi = 0.3; xi < 0.95; xi += 0.05) {
        PsePlan plan;
        if (!kaiser_bessel_plan(in_larger_box(s.scene(tolerance)), xi, plan)) continue;
        ++plans;
        SphereHarness M(s, plan);
        const auto near = scaled_matrix(s, [&](const Motions &l) { return M.near(l); });
        EXPECT_GE(least_eigenvalue(near), 0.02) << ratio << " " << xi << " " << tolerance;
      }
  }
  EXPECT_GE(plans, 20);
}

namespace {

/// A sphere within a shell of touching small ones, all `distance` from its centre.
Spheres sphere_in_shell(double least, double distance, double L)
{
  Spheres s{triclinic(L), {0.0, 0.0, 0.0}, {1.0}, false};
  const long n = 0.8 * 4.0 * distance * distance / (least * least);
  for (long i = 0; i < n; ++i) {    // a spiral
    const double z = 1.0 - (2.0 * i + 1.0) / n, rho = std::sqrt(1.0 - z * z),
                 angle = 2.39996323 * i;
    for (double c : {rho * std::cos(angle), rho * std::sin(angle), z}) s.x.push_back(distance * c);
    s.radius.push_back(least);
  }
  return s;
}

/// The least eigenvalue of the near part among forces on the first sphere and on all others alike.
double least_of_shell(const Spheres &s, SphereHarness &M)
{
  const long n = s.count();
  Eigen::Matrix2d A;
  for (int of : {0, 1}) {
    Motions load{Vector(3 * n, 0.0), Vector()};
    for (long i = of; i < (of == 0 ? 1 : n); ++i)
      load.linear[3 * i] = of == 0 ? 1.0 : 1.0 / (n - 1);
    const Motions u = M.near(load);
    double shell = 0.0;
    for (long i = 1; i < n; ++i) shell += u.linear[3 * i] / (n - 1);
    A(0, of) = 6.0 * pi * u.linear[0];
    A(1, of) = 6.0 * pi * shell;
  }
  return least_eigenvalue(A);
}

}    // namespace

// The mobility of a force that a shell of small spheres takes back almost vanishes.
TEST(Spheres, NearPartIsPositiveForASphereInAShell)
{
  for (double least : {0.5, 0.2, 0.1, 0.05})
    for (double distance : {1.0, 1.0 + least}) {
      const Spheres s = sphere_in_shell(least, distance, 20.0);
      for (double tolerance : {1e-1, 1e-2, 1e-4}) {
        PsePlan plan;
        double xi = 0.8;    // the greatest one that plans allow
        while (!kaiser_bessel_plan(in_larger_box(s.scene(tolerance)), xi, plan) && xi > 0.2)
          xi *= 0.98;
        ASSERT_GT(xi, 0.25);
        SphereHarness M(s, plan);
        EXPECT_GE(least_of_shell(s, M), 0.02 * least)
            << "least " << least << ", distance " << distance << ", xi " << xi << ", tolerance "
            << tolerance;
      }
    }
}

TEST(Spheres, KaiserBesselMatrixIsThatOfTheOracle)
{
  int plans = 0;
  for (const Spheres &s : scenes()) {
    const Eigen::MatrixXd exact = oracle(s);
    for (double tolerance : {1e-2, 1e-4, 1e-7})
      for (double xi : {0.3, 0.4}) {
        PsePlan plan;
        if (!kaiser_bessel_plan(s.scene(tolerance), xi, plan)) continue;
        ++plans;
        const Eigen::MatrixXd M = whole_matrix(s, plan);
        EXPECT_LE((M - exact).norm(), tolerance * exact.norm())
            << name(s) << " xi " << xi << " tolerance " << tolerance;
        EXPECT_LE(asymmetry(M), tolerance) << name(s);
      }
  }
  EXPECT_GE(plans, 60);
}

TEST(Spheres, DoNotDependOnTheSplitting)
{
  for (const Spheres &s : scenes()) {
    PseScene scene = s.scene(1e-9);
    scene.xi = 0.4 / scene.radius;
    const Eigen::MatrixXd one = whole_matrix(s, bdh::plan_pse(scene));
    scene.xi = 0.9 / scene.radius;
    EXPECT_LE((one - whole_matrix(s, bdh::plan_pse(scene))).cwiseAbs().maxCoeff(), 2e-8) << name(s);
  }
}

// A longer splitting parameter would make the near part negative, unless all shapes are exact.
TEST(Spheres, RefuseALargeSplitting)
{
  for (const Spheres &s : {nested_spheres(4.0, true), two_sizes(12, 6.0, 4.0, true, 7),
                           random_spheres(12, 6.0, 4.0, false, 7)}) {
    PseScene scene = s.scene(1e-3);
    scene.xi = 1.3;
    EXPECT_THROW(bdh::plan_pse(scene), bdh::InvalidOption) << name(s);
  }
}

// Forces on spheres of two radii have their own shapes in wave space: both parts are positive for
// any splitting, and a plan for many small spheres takes one that suits them.
TEST(Spheres, TwoRadiiTakeAnySplitting)
{
  const Spheres s = two_sizes(12, 5.0, 4.0, false, 7);
  for (double xi : {2.0, 4.0}) {
    PseScene scene = s.scene(1e-6);
    scene.xi = xi;
    SphereHarness M(s, bdh::plan_pse(scene));
    const auto near = scaled_matrix(s, [&](const Motions &l) { return M.near(l); });
    EXPECT_GE(least_eigenvalue(near), -1e-6) << xi;
    EXPECT_LE((whole_matrix(s, bdh::plan_pse(scene)) - oracle(s)).cwiseAbs().maxCoeff(), 2e-6);
  }
  const PsePlan plan = bdh::plan_pse(two_sizes(3000, 14.0, 4.0, false, 7).scene(1e-3));
  EXPECT_GT(plan.xi, 1.2);
  PseScene between = two_sizes(3000, 14.0, 4.0, false, 7).scene(1e-3);
  between.classes.between = 1.0;
  EXPECT_FALSE(bdh::pse_plan_holds(plan, between));
}

namespace {

/// The largest entry of what is left out of a pair of spheres that ends at a distance.
double left_out(double from, double ai, double aj, const bdh::ShapeBasis &basis, double xi)
{
  const double ci = basis.coefficient(ai * ai), cj = basis.coefficient(aj * aj);
  double largest = 0.0;
  for (double r = from; r < from + 3.0 / xi; r += 0.1 / xi) {
    const auto w11 = bdh::wave_functions(r, basis.b1, basis.b1, xi),
               w12 = bdh::wave_functions(r, basis.b1, basis.b2, xi),
               w22 = bdh::wave_functions(r, basis.b2, basis.b2, xi);
    const bdh::PairBlock exact = bdh::sphere_translation(r, ai, aj);
    const auto rest = [&](double value, int f) {
      return std::fabs(value - bdh::sum_of_shapes(ci, cj, w11[f], w12[f], w22[f]));
    };
    largest = std::max({largest, rest(exact.transverse, 0), rest(exact.difference, 1)});
  }
  return largest;
}

}    // namespace

// What pairs of any radii leave out is at most 1.6 times what the widest ones do, and they end
// sooner.
TEST(Spheres, SmallSpheresReachLessFar)
{
  for (double least : {0.1, 0.25, 0.5})
    for (double xi : {0.15, 0.3, 0.6, 1.1, 3.0})
      for (double beyond : {2.0, 3.0, 4.5}) {
        const bdh::ShapeBasis basis = bdh::shape_basis(least, 1.0);
        const double r_cut = 2.0 + beyond / xi;
        const bdh::NearReach reach(basis, xi, r_cut);
        const double most = left_out(r_cut, 1.0, 1.0, basis, xi);
        for (double ai : {least, 1.2 * least, 0.7, 1.0})
          for (double aj : {least, 0.8, 0.97}) {
            const double end =
                reach(basis.coefficient(ai * ai)) + reach(basis.coefficient(aj * aj));
            EXPECT_LE(left_out(end, ai, aj, basis, xi), 1.6 * most)
                << least << " xi " << xi << " r " << r_cut << ": " << ai << " " << aj;
            EXPECT_LT(end, r_cut);
          }
        EXPECT_GT(2.0 * reach(1.0), r_cut - 2.0 * (1.0 - least));
        EXPECT_NEAR(2.0 * reach(0.0), r_cut, 1e-12);
        // They do not end much sooner than need be.
        EXPECT_GT(left_out(2.0 * reach(1.0), least, least, basis, xi), 0.5 * most);
      }
}

// Spheres of one radius that rotate have one field, others two: neither plan becomes the other.
TEST(Spheres, ChangesBetweenEqualAndUnequalRadiiTakeAnotherPlan)
{
  Spheres s = random_spheres(20, 9.0, 1.0, true, 5);
  PsePlan plan = bdh::plan_pse(s.scene(1e-3));
  EXPECT_TRUE(plan.basis().single());
  s.radius[3] = 0.9;
  const PseScene unequal = s.scene(1e-3);
  EXPECT_FALSE(bdh::change_radius(plan, unequal));
  EXPECT_FALSE(bdh::same_but_for_radius(plan, bdh::plan_pse(unequal)));
  for (double &a : s.radius) a = 0.95;
  EXPECT_TRUE(bdh::change_radius(plan, s.scene(1e-3)));
}

// Spheres of equal radius in the general form are those of the form for equal spheres.
TEST(Spheres, EqualSpheresInTheGeneralForm)
{
  Spheres s = random_spheres(20, 9.0, 1.0, true, 5);
  const Vector f = random_numbers(60, 1);
  PseHarness plain(s.cell, s.x, bdh::plan_pse(scene_of(s.cell, 20, 1.0, 1e-9)));
  SphereHarness general(s, bdh::plan_pse(s.scene(1e-9)));
  EXPECT_LE(relative_error(general.apply({f, {}}, 1.0).linear, plain.apply(f, 1.0)), 2e-9);
}

// Two spheres of radii 1 and 1/4 in a growing box: the flow of the images moves both alike, but for
// its second derivative, which falls off like L^-3.
TEST(Spheres, TwoInAGrowingBox)
{
  for (double r : {0.5, 1.1, 1.25, 3.0}) {
    const auto relative = [r](double L) {
      const Spheres s{cubic_cell(L), {0, 0, 0, r, 0, 0}, {1.0, 0.25}, true};
      SphereHarness M(s, bdh::plan_pse(s.scene(1e-8)));
      const Motions u = M.apply({{1, 0, 0, 0, 0, 0}, Vector(6, 0.0)}, 1.0 / (6.0 * pi));
      return u.linear[0] - u.linear[3];
    };
    const bdh::PairBlock pair = bdh::sphere_translation(r, 1.0, 0.25);
    const double free = 1.0 - pair.transverse - pair.difference;
    const double error = relative(16.0) - free, further = relative(32.0) - free;
    EXPECT_LE(std::fabs(error), 5.0 * (1.0 + r * r) / std::pow(16.0, 3)) << r;
    EXPECT_NEAR(further, error / 8.0, 0.1 * std::fabs(error) / 8.0 + 1e-6) << r;
  }
}

TEST(Spheres, NoiseDoesNotDependOnTheSplittingInMean)
{
  Spheres s = random_spheres(30, 8.0, 4.0, true, 2);
  PseScene scene = s.scene(1e-4);
  scene.noise = true;
  const PsePlan plan = bdh::plan_pse(scene);
  PsePlan further = plan;
  further.root_tolerance = 1e-10;
  const PseNoise noise{2.0, 77, 5};
  SphereHarness M(s, plan), exact(s, further);
  const Motions u = M.random(noise, 1.0), v = exact.random(noise, 1.0);
  EXPECT_LE(relative_error(u.linear, v.linear), 1e-4);
  EXPECT_LE(relative_error(u.angular, v.angular), 1e-4);
}

// Every product of two random motions, in 20000 draws, within 5 standard errors of 2 kT M/dt: 400
// entries would exceed that once in 4000 seeds.
class StatisticsSpheres : public ::testing::TestWithParam<bdh::Splitting> {};

TEST_P(StatisticsSpheres, Covariance)
{
  const Spheres s{triclinic(5.0), {0, 0, 0, 0.9, 0.3, 0.2, 2.5, 2.0, 1.0}, {1.0, 0.25, 0.6}, true};
  const Vector M = bdh::dense_spheres(s.cell, s.x, s.radius, 1.4);
  const double variance = 3.4;
  PseScene scene = s.scene(1e-4);
  scene.splitting = GetParam();
  scene.xi = GetParam() == bdh::Splitting::hasimoto ? 0.7 : 0.45;
  SphereHarness pse(s, bdh::plan_pse(scene));
  const std::size_t size = 18;
  std::vector<Mean> entry(size * size);
  for (int step = 0; step < 20000; ++step) {
    const Motions u = pse.random(PseNoise{variance, 31, static_cast<uint64_t>(step)}, 1.4);
    Vector all = u.linear;
    all.insert(all.end(), u.angular.begin(), u.angular.end());
    for (std::size_t i = 0; i < size; ++i)
      for (std::size_t j = 0; j <= i; ++j) entry[size * i + j].add(all[i] * all[j]);
  }
  for (std::size_t i = 0; i < size; ++i)
    for (std::size_t j = 0; j <= i; ++j)
      EXPECT_LT(std::fabs(entry[size * i + j].z(variance * M[size * i + j])), 5.0) << i << " " << j;
}

INSTANTIATE_TEST_SUITE_P(EachSplitting, StatisticsSpheres,
                         ::testing::Values(bdh::Splitting::hasimoto, bdh::Splitting::kaiser_bessel),
                         [](const auto &info) {
                           return info.param == bdh::Splitting::hasimoto ? "Hasimoto"
                                                                         : "KaiserBessel";
                         });
