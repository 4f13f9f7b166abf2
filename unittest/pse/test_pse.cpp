// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// Positively split Ewald compared with independent references and the dense oracle.

#include "base/constants.h"
#include "oracle/dense_operator.h"
#include "oracle/dense_rpy.h"
#include "pse/pse_support.h"
#include "pse/step_kernel.h"
#include "pse/wave_kernel.h"
#include "support/reference_json.h"

#include <Eigen/Dense>
#include <array>
#include <gtest/gtest.h>

using namespace bdh_test;
using bdh::Cell;
using bdh::pi;
using bdh::PseNoise;
using bdh::PsePlan;
using bdh::PseScene;
using bdh::Splitting;

namespace {

using Vector = std::vector<double>;

/// Non-overlapping spheres of diameter 2 in a cube, by random sequential addition.
Vector hard_spheres(long n, double L, unsigned seed)
{
  std::mt19937_64 engine(seed);
  std::uniform_real_distribution<double> uniform(0.0, L);
  Vector x;
  while (bdh::ssize(x) < 3 * n) {
    const double y[3] = {uniform(engine), uniform(engine), uniform(engine)};
    bool free = true;
    for (std::size_t i = 0; i < x.size() && free; i += 3) {
      double r2 = 0.0;
      for (int d = 0; d < 3; ++d) {
        const double dx = y[d] - x[i + d];
        r2 += std::pow(dx - L * std::round(dx / L), 2);
      }
      free = r2 >= 4.0;
    }
    if (free) x.insert(x.end(), y, y + 3);
  }
  return x;
}

double side(long n, double phi) { return std::cbrt(4.0 / 3.0 * pi * n / phi); }

Vector equal_forces(long n)
{
  Vector f(3 * n, 0.0);
  for (long i = 0; i < n; ++i) f[3 * i + 2] = 1.0;
  return f;
}

/// Ratios of achieved to requested errors.  Each must be at most 1, and their mean not so small
/// that work was wasted.
class Ratios {
 public:
  void add(double ratio, const std::string &what)
  {
    EXPECT_LE(ratio, 1.0) << what;
    sum_ += ratio;
    ++count_;
  }
  ~Ratios()
  {
    EXPECT_GE(sum_ / count_, 0.02);
    testing::Test::RecordProperty("mean_ratio", std::to_string(sum_ / count_));
  }

 private:
  double sum_ = 0.0;
  int count_ = 0;
};

/// Relative error of the planned operator, compared with the oracle.
double achieved(const Cell &cell, const Vector &x, const Vector &f, double tolerance,
                const Vector &exact, double radius = 1.0, double viscosity = 1.0)
{
  const PsePlan plan = bdh::plan_pse(scene_of(cell, x.size() / 3, radius, tolerance));
  PseHarness M(cell, x, plan);
  return relative_error(M.apply(f, viscosity), exact) / tolerance;
}

Vector oracle(const Cell &cell, const Vector &x, const Vector &f, double radius = 1.0,
              double viscosity = 1.0)
{
  Vector u(f.size());
  bdh::dense_apply(cell, x.data(), x.size() / 3, radius, viscosity, f.data(), u.data());
  return u;
}

const double tolerances[] = {1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-7, 1e-10};

/// The matrix of an operator on the forces of n particles, column by column.
template <class Operator> Eigen::MatrixXd matrix_of(long n, Operator apply)
{
  Eigen::MatrixXd A(3 * n, 3 * n);
  for (long j = 0; j < 3 * n; ++j) {
    Vector e(3 * n, 0.0);
    e[j] = 1.0;
    const Vector u = apply(e);
    for (long i = 0; i < 3 * n; ++i) A(i, j) = u[i];
  }
  return A;
}

}    // namespace

// The reference comes from an independent program with another splitting and other formulas
// (reference/README.md).
TEST(PseTolerance, ReferenceCases)
{
  const auto cases = json_reference("rpy_periodic.json")["cases"];
  Ratios ratios;
  for (const auto &c : cases) {
    const Cell cell = cell_of(c["box"]);
    for (double tolerance : tolerances)
      ratios.add(achieved(cell, flatten(c["x"]), flatten(c["f"]), tolerance, flatten(c["u"]),
                          c["a"], c["eta"]),
                 std::string(c["id"]) + " at " + std::to_string(tolerance));
  }
}

// Equal forces give the smallest |U|, and contributions from beyond the cutoff add up.
TEST(PseTolerance, SuspensionsUnderEqualAndRandomForces)
{
  Ratios ratios;
  const long n = 120;
  for (double phi : {0.01, 0.1, 0.3}) {
    const Cell cell = cubic_cell(side(n, phi));
    const Vector x = hard_spheres(n, cell.lx, 5);
    const Vector forces[] = {equal_forces(n), random_numbers(3 * n, 3)};
    const Vector exact[] = {oracle(cell, x, forces[0]), oracle(cell, x, forces[1])};
    for (double tolerance : tolerances) {
      PseHarness M(cell, x, bdh::plan_pse(scene_of(cell, n, 1.0, tolerance)));
      for (int k = 0; k < 2; ++k)
        ratios.add(relative_error(M.apply(forces[k], 1.0), exact[k]) / tolerance,
                   "phi " + std::to_string(phi) + " at " + std::to_string(tolerance));
    }
  }
}

// Pairs at contact and overlapping, moving together and apart.  In the latter case |U| is as small
// as 0.19 |F|/(6 pi eta a).
TEST(PseTolerance, Pairs)
{
  Ratios ratios;
  for (double L : {8.0, 30.0})
    for (double tolerance : tolerances) {
      const Cell cell = cubic_cell(L);
      const PsePlan plan = bdh::plan_pse(scene_of(cell, 2, 1.0, tolerance));
      for (double r : {2.0, 1.5, 1.0}) {
        const Vector x = {0.1, 0.2, 0.3, 0.1 + 0.6 * r, 0.2 + 0.8 * r, 0.3};
        PseHarness M(cell, x, plan);
        for (int sign : {1, -1})
          for (const Vector &one : {Vector{0.6, 0.8, 0.0}, Vector{0.8, -0.6, 0.0}}) {
            const Vector f = {one[0], one[1], 0.0, sign * one[0], sign * one[1], 0.0};
            ratios.add(relative_error(M.apply(f, 1.0), oracle(cell, x, f)) / tolerance,
                       "r " + std::to_string(r) + " L " + std::to_string(L) + " at " +
                           std::to_string(tolerance));
          }
      }
    }
}

// In a dense ball in a large box the mean density is no estimate of the number of neighbours.
TEST(PseTolerance, ClusterInAnEmptyBox)
{
  const double spacing = 3.1, R = 14.0;    // fcc, with phi = 0.56 inside
  Vector x;
  for (int i = -9; i <= 9; ++i)
    for (int j = -9; j <= 9; ++j)
      for (int k = -9; k <= 9; ++k) {
        const double y[3] = {0.5 * spacing * i, 0.5 * spacing * j, 0.5 * spacing * k};
        if ((i + j + k) % 2 == 0 && y[0] * y[0] + y[1] * y[1] + y[2] * y[2] < R * R)
          x.insert(x.end(), y, y + 3);
      }
  const Cell cell = cubic_cell(150.0);
  Ratios ratios;
  const Vector forces[] = {random_numbers(x.size(), 3), equal_forces(x.size() / 3)};
  const Vector exact[] = {oracle(cell, x, forces[0]), oracle(cell, x, forces[1])};
  for (bool noise : {false, true})    // noise leads to another splitting
    for (double tolerance : {1e-1, 1e-2, 1e-3}) {
      PseScene scene = scene_of(cell, x.size() / 3, 1.0, tolerance);
      scene.noise = noise;
      PseHarness M(cell, x, bdh::plan_pse(scene));
      for (int k = 0; k < 2; ++k)
        ratios.add(relative_error(M.apply(forces[k], 1.0), exact[k]) / tolerance,
                   "at " + std::to_string(tolerance));
    }
}

// Elongated, flat and sheared boxes, and one that is smaller than the range of the interaction.
TEST(PseTolerance, BoxesOfUnequalSides)
{
  Ratios ratios;
  const double boxes[][6] = {{4, 4, 40, 0, 0, 0},
                             {30, 30, 6, 0, 0, 0},
                             {10, 15, 22, 4.5, -4, 7},
                             {2.5, 2.5, 2.5, 0, 0, 0}};
  for (const auto &b : boxes) {
    Cell cell;
    cell.lx = b[0], cell.ly = b[1], cell.lz = b[2], cell.xy = b[3], cell.xz = b[4], cell.yz = b[5];
    const long n = 24;
    Vector x(3 * n), s = random_numbers(3 * n, 9);
    for (long i = 0; i < n; ++i) cell.lattice_vector(&s[3 * i], &x[3 * i]);
    const Vector f = random_numbers(3 * n, 4), exact = oracle(cell, x, f);
    for (double tolerance : tolerances)
      ratios.add(achieved(cell, x, f, tolerance, exact),
                 "box " + std::to_string(b[0]) + " at " + std::to_string(tolerance));
  }
}

// The self-mobility in a cube is exactly 1 - 2.837297 a/L + (4 pi/3)(a/L)^3 for L >= 2a.
// Each splitting by itself, whichever is cheaper.
TEST(PseTolerance, BothSplittings)
{
  const long n = 60;
  Ratios ratios;
  for (const Cell &cell : {cubic_cell(11.0), cubic_cell(45.0)}) {
    const Vector x = hard_spheres(n, 11.0, 4);
    for (const Vector &f : {equal_forces(n), random_numbers(3 * n, 3)}) {
      const Vector exact = oracle(cell, x, f);
      for (double tolerance : tolerances)
        for (Splitting splitting : {Splitting::hasimoto, Splitting::kaiser_bessel}) {
          PseScene scene = scene_of(cell, n, 1.0, tolerance);
          scene.splitting = splitting;
          const PsePlan plan = bdh::plan_pse(scene);
          ASSERT_EQ(plan.splitting, splitting);
          PseHarness M(cell, x, plan);
          ratios.add(relative_error(M.apply(f, 1.0), exact) / tolerance,
                     std::to_string(cell.lx) + " at " + std::to_string(tolerance));
        }
    }
  }
}

TEST(PsePhysics, SelfMobility)
{
  for (double L : {2.5, 4.0, 10.0, 64.0}) {
    const Vector f = {0.6, 0.0, 0.8}, x = {0.3, 1.1, -0.7};
    const PsePlan plan = bdh::plan_pse(scene_of(cubic_cell(L), 1, 1.0, 1e-10));
    PseHarness M(cubic_cell(L), x, plan);
    const double s = 1.0 / L,
                 exact = (1.0 - 2.837297479480619 * s + 4.0 * pi / 3.0 * s * s * s) / (6.0 * pi);
    EXPECT_NEAR(norm(M.apply(f, 1.0)) / exact, 1.0, 1e-10) << L;
  }
}

// U/U_0 = 1 - c phi^(1/3) + phi for non-overlapping spheres.
TEST(PsePhysics, LatticeSedimentation)
{
  const struct {
    double c;
    std::vector<std::array<double, 3>> basis;
  } lattices[] = {{1.7601188842234627, {{0, 0, 0}}},
                  {1.7918585113635421, {{0, 0, 0}, {0.5, 0.5, 0.5}}},
                  {1.791747230390227, {{0, 0, 0}, {0.5, 0.5, 0}, {0.5, 0, 0.5}, {0, 0.5, 0.5}}}};
  for (const auto &lattice : lattices)
    for (double phi : {0.01, 0.3}) {
      const long per_cell = bdh::ssize(lattice.basis), m = 2, n = per_cell * m * m * m;
      const double L = side(n, phi);
      Vector x;
      for (long i = 0; i < m; ++i)
        for (long j = 0; j < m; ++j)
          for (long k = 0; k < m; ++k)
            for (const auto &b : lattice.basis)
              for (double place : {i + b[0] + 0.13, j + b[1] + 0.4, k + b[2] + 0.77})
                x.push_back(place * L / m);
      PseHarness M(cubic_cell(L), x, bdh::plan_pse(scene_of(cubic_cell(L), n, 1.0, 1e-9)));
      const Vector u = M.apply(equal_forces(n), 1.0);
      for (long i = 0; i < n; ++i)
        EXPECT_NEAR(6.0 * pi * u[3 * i + 2], 1.0 - lattice.c * std::cbrt(phi) + phi, 1e-9)
            << per_cell << " " << phi;
    }
}

TEST(PsePhysics, MeanDoesNotDependOnXi)
{
  const long n = 40;
  const Cell cell = cubic_cell(12.0);
  const Vector x = random_numbers(3 * n, 8), f = random_numbers(3 * n, 4),
               exact = oracle(cell, x, f);
  for (double xi : {0.35, 0.5, 0.8, 1.3, 2.5}) {
    PseScene scene = scene_of(cell, n, 1.0, 1e-8);
    scene.xi = xi;
    PseHarness M(cell, x, bdh::plan_pse(scene));
    EXPECT_LE(relative_error(M.apply(f, 1.0), exact), 1e-8) << xi;
  }
}

// Long cutoffs, where single precision cannot sum the pairs, and short ones within the spheres.
TEST(PseTolerance, SplittingsByHand)
{
  Ratios ratios;
  const long n = 40;
  const Cell cell = cubic_cell(9.0);
  const Vector x = hard_spheres(n, cell.lx, 9);
  for (const Vector &f : {equal_forces(n), random_numbers(3 * n, 3)}) {
    const Vector exact = oracle(cell, x, f);
    for (double xi : {0.06, 0.15, 5.0, 7.0, 8.0, 9.0, 10.0})
      for (double tolerance : {1e-3, 1e-4}) {
        PseScene scene = scene_of(cell, n, 1.0, tolerance);
        scene.xi = xi;
        PseHarness M(cell, x, bdh::plan_pse(scene));
        ratios.add(relative_error(M.apply(f, 1.0), exact) / tolerance,
                   "xi " + std::to_string(xi) + " at " + std::to_string(tolerance));
      }
  }
}

// The fast operator itself is symmetric and positive: its spreading is the adjoint of its
// interpolation, and it has one weight per mode and one block per pair.
TEST(PseOperator, SymmetricAndPositive)
{
  const long n = 24;
  const Cell cell = cubic_cell(9.0);
  for (double spread : {9.0, 1.5}) {    // scattered spheres; a clump of overlapping ones
    Vector x = random_numbers(3 * n, 8);
    for (double &v : x) v *= 0.3 * spread;
    for (double tolerance : {1e-3, 1e-8}) {
      PseScene scene = scene_of(cell, n, 1.0, tolerance);
      scene.precision = bdh::Precision::double_precision;
      PseHarness M(cell, x, bdh::plan_pse(scene));
      const Eigen::MatrixXd A = matrix_of(n, [&](const Vector &f) { return M.apply(f, 1.0); });
      EXPECT_LE((A - A.transpose()).norm(), 1e-13 * A.norm());
      const Eigen::VectorXd lambda =
          Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(A).eigenvalues();
      // The exact matrix is positive, and the truncated one differs by at most the tolerance.
      EXPECT_GE(lambda(0), -tolerance * lambda(3 * n - 1));
    }
  }
}

// Both parts of the Kaiser-Bessel splitting are positive by themselves, whatever the configuration:
// its weights are between 0 and those of spheres.
TEST(PseOperator, KaiserBesselPartsArePositive)
{
  const long n = 24;
  const Cell cell = cubic_cell(9.0);
  for (double spread : {9.0, 1.5})    // scattered spheres; a clump of overlapping ones
    for (double tolerance : {1e-2, 1e-4, 1e-8}) {
      Vector x = random_numbers(3 * n, 8);
      for (double &v : x) v *= 0.3 * spread;
      PseScene scene = scene_of(cell, n, 1.0, tolerance);
      scene.precision = bdh::Precision::double_precision;
      scene.splitting = Splitting::kaiser_bessel;
      const PsePlan plan = bdh::plan_pse(scene);
      const bdh::WaveWeight weight = plan.wave_weight();
      for (double t = 0.001; t <= 1.0; t += 0.001)
        EXPECT_LE(weight.root(t * plan.k_cut, 1.0), std::fabs(bdh::sinc(t * plan.k_cut))) << t;
      PseHarness M(cell, x, plan);
      const Eigen::MatrixXd near = matrix_of(n, [&](const Vector &f) { return M.near(f, 1.0); });
      const Eigen::VectorXd lambda =
          Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(near).eigenvalues();
      EXPECT_GE(lambda(0), -tolerance * lambda(3 * n - 1)) << spread << " " << tolerance;
    }
}

// Compared with the square root from eigenvalues.
TEST(Lanczos, RootOfRealSpacePart)
{
  const long n = 60;
  const Cell cell = cubic_cell(11.0);
  for (unsigned seed : {1u, 2u}) {
    Vector x = random_numbers(3 * n, seed);
    for (double &v : x) v *= seed == 1 ? 4.0 : 1.5;    // scattered or overlapping spheres
    const bdh::DenseSplit M = bdh::dense_split(cell, x.data(), n, 1.0, 1.0 / (6.0 * pi), 0.5);
    const Eigen::MatrixXd A = Eigen::Map<const Eigen::MatrixXd>(M.real.data(), 3 * n, 3 * n);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(A);
    const Eigen::MatrixXd root = eigen.eigenvectors() *
                                 eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal() *
                                 eigen.eigenvectors().transpose();
    const Vector numbers = random_numbers(3 * n, 7);
    const bdh::AlignedVector z(numbers.begin(), numbers.end());
    const Eigen::VectorXd exact = root * Eigen::Map<const Eigen::VectorXd>(z.data(), 3 * n);
    DenseOperator op(A);
    bdh::LanczosRoot<DenseOperator> lanczos;
    bdh::AlignedVector y;
    for (double error : {1e-1, 1e-2, 1e-3, 1e-5, 1e-8}) {
      op.products = 0;
      const bdh::LanczosReport report = lanczos.apply(op, z, {error, 200}, y);
      const double true_error =
          (Eigen::Map<const Eigen::VectorXd>(y.data(), 3 * n) - exact).norm() / norm(numbers);
      EXPECT_LE(true_error, error) << "seed " << seed;
      EXPECT_EQ(op.products, report.iterations);    // one pass over neighbours in each
      // The estimate is within a factor of 20 of the true error unless that is round-off.
      if (true_error > 1e-12) {
        EXPECT_LE(report.error, 20.0 * true_error);
      }
    }
    EXPECT_THROW(lanczos.apply(op, z, {1e-8, 3}, y), bdh::NotConverged);
  }
}

TEST(Lanczos, InvariantSubspaceAndZeroVector)
{
  DenseOperator op(4.0 * Eigen::MatrixXd::Identity(5, 5));
  bdh::LanczosRoot<DenseOperator> lanczos;
  bdh::AlignedVector y, z(5, 1.0);
  EXPECT_EQ(lanczos.apply(op, z, {1e-10, 10}, y).iterations, 1);
  for (double v : y) EXPECT_NEAR(v, 2.0, 1e-14);
  std::fill(z.begin(), z.end(), 0.0);
  lanczos.apply(op, z, {1e-10, 10}, y);
  for (double v : y) EXPECT_EQ(v, 0.0);
}

TEST(Lanczos, RefusesIndefiniteOperators)
{
  DenseOperator op(Eigen::Vector3d(1.0, 2.0, -0.5).asDiagonal().toDenseMatrix());
  bdh::LanczosRoot<DenseOperator> lanczos;
  bdh::AlignedVector y, z(3, 1.0);
  EXPECT_THROW(lanczos.apply(op, z, {1e-3, 10}, y), bdh::NotConverged);
}

// Eigenvalues spread evenly over three decades: changes from one iteration to the next fall slowly,
// and the error that remains is many times the last change.
TEST(Lanczos, StopsInTimeWhereItConvergesSlowly)
{
  const long n = 400;
  Eigen::VectorXd eigenvalues(n);
  for (long i = 0; i < n; ++i) eigenvalues[i] = std::pow(10.0, -3.0 * i / (n - 1.0));
  DenseOperator op(eigenvalues.asDiagonal().toDenseMatrix());
  const bdh::AlignedVector z(n, 1.0);
  bdh::LanczosRoot<DenseOperator> lanczos;
  bdh::AlignedVector y;
  for (double error : {1e-2, 3e-3, 1e-3}) {
    lanczos.apply(op, z, {error, 200}, y);
    const Eigen::VectorXd root = Eigen::Map<const Eigen::VectorXd>(y.data(), n);
    EXPECT_LE((root - eigenvalues.cwiseSqrt()).norm() / std::sqrt(double(n)), error);
  }
}

// Errors of the operator may turn an eigenvalue 0 into a negative one.
TEST(Lanczos, TakesSlightlyNegativeEigenvaluesAsZero)
{
  DenseOperator op(Eigen::Vector3d(1.0, 4.0, -1e-6).asDiagonal().toDenseMatrix());
  bdh::LanczosRoot<DenseOperator> lanczos;
  bdh::AlignedVector y, z(3, 1.0);
  EXPECT_THROW(lanczos.apply(op, z, {1e-9, 10}, y), bdh::NotConverged);
  lanczos.apply(op, z, {1e-9, 10, 1e-5}, y);
  const double root[3] = {1.0, 2.0, 0.0};
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(y[i], root[i], 1e-8);
}

// The error of the square root is found by running Lanczos much further with the same noise.
// (Cutoffs change the noise by the square root of the change in its covariance, M, which the tests
// above check.)
TEST(PseNoise, RootWithinTolerance)
{
  const long n = 100;
  Ratios ratios;
  for (double phi : {0.05, 0.3})
    for (double tolerance : {1e-1, 1e-2, 1e-3, 1e-4, 1e-6, 1e-8}) {
      const Cell cell = cubic_cell(side(n, phi));
      const Vector x = hard_spheres(n, cell.lx, 3);
      PseScene scene = scene_of(cell, n, 1.0, tolerance);
      scene.noise = true;
      scene.precision = bdh::Precision::double_precision;
      PsePlan plan = bdh::plan_pse(scene), further = plan;
      further.root_tolerance = 1e-12;
      PseHarness M(cell, x, plan), exact(cell, x, further);
      const PseNoise noise{2.0, 77, 5};
      const Vector u = M.fluctuate({}, noise, 1.0);
      const double error = relative_error(u, exact.fluctuate({}, noise, 1.0));
      ratios.add(error / tolerance,
                 "phi " + std::to_string(phi) + " at " + std::to_string(tolerance));
      EXPECT_LE(error, M.report.root_error + 1e-14);    // the fix prints an upper bound
    }
}

// Forces and noise in one set of transforms give the sum of the separate results.
TEST(PseNoise, AddsToForces)
{
  const long n = 30;
  const Cell cell = cubic_cell(10.0);
  const Vector x = hard_spheres(n, cell.lx, 3), f = random_numbers(3 * n, 6);
  PseScene scene = scene_of(cell, n, 1.0, 1e-6);
  PseHarness M(cell, x, bdh::plan_pse(scene));
  const PseNoise noise{1.4, 5, 9};
  const Vector both = M.fluctuate(f, noise, 1.3), alone = M.fluctuate({}, noise, 1.3),
               mean = M.apply(f, 1.3);
  Vector sum(both.size());
  for (std::size_t k = 0; k < sum.size(); ++k) sum[k] = alone[k] + mean[k];
  EXPECT_LE(relative_error(both, sum), 1e-13);
  EXPECT_GT(norm(alone), 0.1 * norm(mean));
}

// The far and the near part make up the whole, with forces and with noise.
TEST(PseNoise, FarAndNearAddUp)
{
  const long n = 30;
  const Cell cell = cubic_cell(10.0);
  const Vector x = hard_spheres(n, cell.lx, 3), f = random_numbers(3 * n, 6);
  PseHarness M(cell, x, bdh::plan_pse(scene_of(cell, n, 1.0, 1e-6)));
  const PseNoise noise{1.4, 5, 9};
  EXPECT_LE(relative_error(M.in_parts(f, noise, 1.3), M.fluctuate(f, noise, 1.3)), 1e-14);
}

// Noise is proportional to the root of its variance and of the fluidity.  Without noise only forces
// count, and where none acts nothing moves.
TEST(PseNoise, AmplitudesAndNothing)
{
  const long n = 30;
  const Cell cell = cubic_cell(10.0);
  const Vector x = hard_spheres(n, cell.lx, 3), f = random_numbers(3 * n, 6);
  PseHarness M(cell, x, bdh::plan_pse(scene_of(cell, n, 1.0, 1e-6)));
  Vector unit = M.fluctuate({}, {1.0, 5, 9}, 1.0);
  for (double &u : unit) u *= 1.5;
  EXPECT_LE(relative_error(M.fluctuate({}, {9.0, 5, 9}, 4.0), unit), 1e-14);
  EXPECT_EQ(M.fluctuate(f, {}, 1.3), M.apply(f, 1.3));
  EXPECT_EQ(M.report.iterations, 0);
  EXPECT_EQ(M.fluctuate({}, {}, 1.3), Vector(3 * n, 0.0));
}

// Velocities are real, so a mode and its conjugate have conjugate amplitudes.  The column n_x = 0
// holds both.
TEST(PseNoise, ConjugateModesHaveConjugateVelocities)
{
  Cell cell;
  cell.lx = 5.0, cell.ly = 6.0, cell.lz = 7.0, cell.xy = 1.2, cell.xz = -0.7, cell.yz = 0.9;
  for (const Cell &box : {cubic_cell(6.0), cell}) {
    const auto velocity = [&](long ny, long nz) {
      bdh::Wave wave{{}, bdh::is_conjugate(0, ny, nz) ? -1.0 : 1.0, 0.7};
      box.wave_vector(0.0, ny, nz, wave.k);
      double z[4];
      bdh::normal4(PseNoise{1.0, 3, 4}.counter(bdh::Stream::wave_space), bdh::drawn_wave(0, ny, nz),
                   z[0], z[1], z[2], z[3]);
      double re[3] = {}, im[3] = {};
      bdh::solve_wave(wave, {1.0, 1.0}, z, re, im);
      return std::array<double, 6>{re[0], re[1], re[2], im[0], im[1], im[2]};
    };
    for (long ny = -3; ny <= 3; ++ny)
      for (long nz = -3; nz <= 3; ++nz) {
        if (ny == 0 && nz == 0) continue;
        const std::array<double, 6> here = velocity(ny, nz), there = velocity(-ny, -nz);
        for (std::size_t c = 0; c < 3; ++c) {
          EXPECT_NEAR(here[c], there[c], 1e-14) << ny << " " << nz;
          EXPECT_NEAR(here[3 + c], -there[3 + c], 1e-14) << ny << " " << nz;
        }
      }
  }
}

// The noise of a mode does not depend on how its wave vector is rounded, also where k_z is the
// difference of equal numbers in a sheared box.
TEST(PseNoise, OfAModeIsThatOfItsWaveVectorHoweverRounded)
{
  long level = 0;    // modes with k_z = 0
  for (double tilt : {0.5, 0.4, 0.25, 1.0 / 3.0}) {
    Cell cell = cubic_cell(17.3);
    cell.xz = tilt * cell.lx;
    double dk[3];
    cell.wave_vector(1.0, 0.0, 0.0, dk);
    for (long nx = 1; nx <= 30; ++nx)
      for (long nz = -20; nz <= 20; ++nz)
        for (long from = 0; from < nx; from += 3) {
          bdh::Wave direct{{}, 1.0, 0.7}, added = direct;
          cell.wave_vector(nx, 2, nz, direct.k);
          cell.wave_vector(from, 2, nz, added.k);
          for (int d = 0; d < 3; ++d) added.k[d] += double(nx - from) * dk[d];
          level += std::fabs(direct.k[2]) < 1e-12;
          const double z[4] = {0.3, -0.5, 0.9, 1.1};
          double re[2][3] = {}, im[2][3] = {};
          bdh::solve_wave(direct, {1.0, 1.0}, z, re[0], im[0]);
          bdh::solve_wave(added, {1.0, 1.0}, z, re[1], im[1]);
          for (int d = 0; d < 3; ++d) {
            ASSERT_NEAR(re[0][d], re[1][d], 1e-12) << tilt << " " << nx << " " << nz << " " << from;
            ASSERT_NEAR(im[0][d], im[1][d], 1e-12) << tilt << " " << nx << " " << nz << " " << from;
          }
        }
  }
  EXPECT_GT(level, 100);
}

// A near step of scheme split takes the mean of its noise and the last one, and in the first step
// of a particle its noise alone; rotations likewise.
TEST(PseNoise, NearStepsShareTheirNoise)
{
  const int local[1] = {1};
  const double random[3] = {1.0, -2.0, 4.0}, random_rotation[3] = {0.5, 3.0, -1.0};
  double last[14], displacement[3], rotation[3];
  std::fill_n(last, 14, 7.0);
  last[7 + bdh::dof] = 0.0;    // the second atom has no last noise
  bdh::NearStep step{};
  step.local = local;
  step.stride = 7;
  step.h = 0.1;
  step.amplitude = 10.0;
  step.random = random;
  step.random_rotation = random_rotation;
  step.last = last;
  step.displacement = displacement;
  step.rotation = rotation;
  const auto move = [&](double velocity) {
    std::fill_n(displacement, 3, velocity);
    std::fill_n(rotation, 3, 2.0 * velocity);
    step(0);
  };
  move(2.0);
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(displacement[c], 0.2 + 10.0 * random[c], 1e-14) << c;
    EXPECT_NEAR(rotation[c], 0.4 + 10.0 * random_rotation[c], 1e-14) << c;
  }
  last[7 + 1] = 6.0;
  last[7 + bdh::noise_entries + 1] = -1.0;
  move(3.0);
  EXPECT_NEAR(displacement[0], 0.3 + 10.0 * 1.0, 1e-14);
  EXPECT_NEAR(displacement[1], 0.3 + 10.0 * 2.0, 1e-14);
  EXPECT_NEAR(rotation[1], 0.6 + 10.0 * 1.0, 1e-14);
  for (int k = 0; k < 7; ++k) EXPECT_EQ(last[k], 7.0);    // of another atom
}

// Near steps of different lengths: each noise counts half in two steps, with the amplitude of its
// own.
TEST(PseNoise, NearStepsOfDifferentLengthsShareTheirNoise)
{
  const int local[1] = {0};
  const double random[3] = {1.0, -2.0, 4.0};
  double last[4] = {0.5, 3.0, -1.0, 0.16}, displacement[3] = {0.0, 0.0, 0.0};
  bdh::NearStep step{};
  step.local = local;
  step.stride = 4;
  step.h = 0.01;
  step.amplitude = 0.1;    // so that sqrt(h) is the amplitude of any step
  step.random = random;
  step.last = last;
  step.displacement = displacement;
  step(0);
  const double before[3] = {0.5, 3.0, -1.0};
  for (int c = 0; c < 3; ++c)
    EXPECT_NEAR(displacement[c], 0.5 * (0.4 * before[c] + 0.1 * random[c]), 1e-15) << c;
  EXPECT_EQ(last[bdh::dof], 0.01);
}

// <u u^T> = 2 kT M/dt compared with the dense matrix, for two splittings and a tilted cell.  Every
// entry is a mean over samples; z < 5 for all 2 x 78 entries has a false-alarm rate of 1e-4.
TEST(StatisticsPse, Covariance)
{
  const long n = 4;
  Cell cell;
  cell.lx = 5.0, cell.ly = 6.0, cell.lz = 7.0, cell.xy = 1.2, cell.xz = -0.7, cell.yz = 0.9;
  const Vector x = {0.2, 0.3, 0.1, 1.6, 0.9, 0.4, 3.0, 4.0, 5.0, 2.1, 2.0, 3.3};
  const Vector M = bdh::dense_mobility(cell, x.data(), n, 0.8, 1.4);
  const double variance = 3.4;
  for (double xi : {0.6, 1.1}) {
    PseScene scene = scene_of(cell, n, 0.8, 1e-4);
    scene.xi = xi;
    PseHarness pse(cell, x, bdh::plan_pse(scene));
    std::vector<Mean> entry(144);
    const int samples = 40000;
    for (int s = 0; s < samples; ++s) {
      const Vector u = pse.fluctuate({}, PseNoise{variance, 31, static_cast<uint64_t>(s)}, 1.4);
      for (int i = 0; i < 12; ++i)
        for (int j = 0; j <= i; ++j) entry[12 * i + j].add(u[i] * u[j]);
    }
    for (int i = 0; i < 12; ++i)
      for (int j = 0; j <= i; ++j)
        EXPECT_LT(std::fabs(entry[12 * i + j].z(variance * M[12 * i + j])), 5.0)
            << i << " " << j << " xi " << xi;
  }
}

// The noise of different seeds and of different steps is unrelated.
TEST(StatisticsPse, SeedsAndStepsAreUnrelated)
{
  const long n = 500;
  const Cell cell = cubic_cell(side(n, 0.1));
  const Vector x = hard_spheres(n, cell.lx, 1);
  PseHarness M(cell, x, bdh::plan_pse(scene_of(cell, n, 1.0, 1e-3)));
  const Vector a = M.fluctuate({}, {2.0, 1, 1}, 1.0), b = M.fluctuate({}, {2.0, 2, 1}, 1.0),
               c = M.fluctuate({}, {2.0, 1, 2}, 1.0);
  const auto correlation = [](const Vector &u, const Vector &v) {
    double s = 0.0;
    for (std::size_t k = 0; k < u.size(); ++k) s += u[k] * v[k];
    return s / (norm(u) * norm(v));
  };
  // The 1500 numbers are correlated with each other; 5 standard deviations are below 0.3.
  EXPECT_LT(std::fabs(correlation(a, b)), 0.3);
  EXPECT_LT(std::fabs(correlation(a, c)), 0.3);
}

// A sheared cell and the same lattice after a flip of the box are the same system.
TEST(PseOperator, FlippedBox)
{
  const long n = 30;
  Cell cell = cubic_cell(10.0), flipped = cell;
  cell.xy = 5.2;
  flipped.xy = 5.2 - 10.0;
  const Vector x = hard_spheres(n, 10.0, 2), f = random_numbers(3 * n, 6);
  // As in a run, the plan is made for an upright cell with room for all tilts, which is then
  // tilted.
  PseScene scene = scene_of(cell, n, 1.0, 1e-7);
  const PsePlan plan = bdh::plan_pse(scene);
  PseHarness a(cell, x, plan), b(flipped, x, plan);
  EXPECT_LE(relative_error(a.apply(f, 1.0), oracle(cell, x, f)), 1e-7);
  EXPECT_LE(relative_error(b.apply(f, 1.0), a.apply(f, 1.0)), 2e-7);
}

// A cell that grows beyond the resolution of its grid gets a new grid.
TEST(PseOperator, GridFollowsTheCell)
{
  const long n = 20;
  const Cell small = cubic_cell(8.0), large = cubic_cell(9.5);
  const Vector x = hard_spheres(n, 8.0, 2), f = random_numbers(3 * n, 6);
  const auto M = bdh::make_pse(bdh::plan_pse(scene_of(small, n, 1.0, 1e-6)), 100, {self()});
  EXPECT_FALSE(M->set_cell(small));
  EXPECT_TRUE(M->set_cell(large));
  EXPECT_FALSE(M->set_cell(large));
  BruteNeighbors neighbors(large, x, M->plan().r_cut, Deal(n, self()).mine);
  const std::vector<uint64_t> id = counted(n);
  M->bind({n, x.data(), id.data(), neighbors.view(), n});
  M->set_viscosity(1.0);
  Vector u(3 * n);
  M->apply({f.data(), true}, u.data());
  EXPECT_LE(relative_error(u, oracle(large, x, f)), 1e-6);
}

// Particles that swell a little keep grid, window and cutoffs.  The mobility that is changed equals
// a newly made one.
TEST(PseOperator, RadiusChanges)
{
  const long n = 40;
  const Cell cell = cubic_cell(12.0);
  const Vector x = hard_spheres(n, 12.0, 2), f = random_numbers(3 * n, 6);
  const PseNoise noise{1.4, 4711, 17};
  for (double tolerance : {1e-3, 1e-6}) {
    PsePlan plan = bdh::plan_pse(scene_of(cell, n, 1.0, tolerance));
    PseHarness M(cell, x, plan);
    M.fluctuate(f, noise, 1.0);
    for (double radius : {1.01, 1.03, 0.98}) {
      const PsePlan before = plan;
      ASSERT_TRUE(bdh::change_radius(plan, scene_of(cell, n, radius, tolerance))) << radius;
      EXPECT_TRUE(bdh::same_but_for_radius(plan, before));
      EXPECT_NE(plan.errors.total(), before.errors.total());
      EXPECT_LE(plan.errors.total(), tolerance);
      ASSERT_TRUE(M.mobility().change_radius(plan));
      PseHarness made(cell, x, plan);
      EXPECT_EQ(M.apply(f, 1.3), made.apply(f, 1.3));
      EXPECT_EQ(M.fluctuate(f, noise, 1.3), made.fluctuate(f, noise, 1.3));
      EXPECT_LE(relative_error(M.apply(f, 1.3), oracle(cell, x, f, radius, 1.3)), tolerance);
    }
  }
}

// Small particles need a finer grid with Hasimoto's splitting, and that requires another mobility
// object.
TEST(PseOperator, RadiusChangesTooMuch)
{
  const Cell cell = cubic_cell(12.0);
  PseScene scene = scene_of(cell, 40, 1.0, 1e-4);
  scene.splitting = Splitting::hasimoto;
  PsePlan plan = bdh::plan_pse(scene);
  EXPECT_FALSE(bdh::change_radius(plan, scene_of(cell, 40, 0.5, 1e-4)));
  EXPECT_EQ(plan.radius, 1.0);
  PseScene near = scene_of(cell, 40, 1.01, 1e-4);
  near.largest_cutoff = 0.9 * plan.r_cut;
  EXPECT_FALSE(bdh::change_radius(plan, near));
  EXPECT_EQ(plan.radius, 1.0);
  const auto M = bdh::make_pse(plan, 100, {self()});
  EXPECT_FALSE(M->change_radius(bdh::plan_pse(scene_of(cell, 40, 0.5, 1e-4))));
  EXPECT_EQ(M->plan().radius, 1.0);
}

// Large particles have shapes that fall off before the weights of a Kaiser-Bessel splitting do: its
// near part would not be positive.
TEST(PseOperator, KaiserBesselRadiusChangesTooMuch)
{
  const Cell cell = cubic_cell(30.0);
  PseScene scene = scene_of(cell, 40, 1.0, 1e-4);
  scene.splitting = Splitting::kaiser_bessel;
  PsePlan plan = bdh::plan_pse(scene);
  double radius = 1.0;
  while (bdh::change_radius(plan, scene_of(cell, 40, 1.02 * radius, 1e-4))) {
    radius *= 1.02;
    ASSERT_LT(radius, 0.5 * plan.r_cut);
    const bdh::WaveWeight weight = plan.wave_weight();
    for (double k = 0.01 * plan.k_cut; k <= plan.k_cut; k += 0.01 * plan.k_cut)
      EXPECT_LE(weight.root(k, radius), std::fabs(bdh::sinc(k * radius)));
  }
  EXPECT_GT(radius, 1.0);
  EXPECT_EQ(plan.radius, radius);
}

TEST(PsePlan, RefusesImpossibleScenes)
{
  PseScene scene = scene_of(cubic_cell(20.0), 100, 1.0, 1e-3);
  scene.tolerance = 1e-14;
  EXPECT_THROW(bdh::plan_pse(scene), bdh::InvalidOption);
  scene.tolerance = 1e-8;
  scene.precision = bdh::Precision::single_precision;
  EXPECT_THROW(bdh::plan_pse(scene), bdh::InvalidOption);
  scene.precision = bdh::Precision::automatic;
  scene.xi = 0.05;
  scene.tolerance = 1e-4;
  scene.precision = bdh::Precision::single_precision;
  EXPECT_THROW(bdh::plan_pse(scene), bdh::InvalidOption);
  scene.precision = bdh::Precision::automatic;
  EXPECT_FALSE(bdh::plan_pse(scene).single);
  scene.xi = 0.01;
  EXPECT_THROW(bdh::plan_pse(scene), bdh::InvalidOption);
  scene.xi = 1e5;
  EXPECT_THROW(bdh::plan_pse(scene), bdh::InvalidOption);
}

TEST(PsePlan, DependsOnItsInputOnly)
{
  const PseScene scene = scene_of(cubic_cell(35.0), 1000, 1.0, 1e-4);
  const PsePlan a = bdh::plan_pse(scene), b = bdh::plan_pse(scene);
  EXPECT_EQ(a.xi, b.xi);
  EXPECT_EQ(a.n, b.n);
  EXPECT_TRUE(a.single);
  EXPECT_LE(a.errors.total(), a.tolerance);
}

// The near part is evaluated once per near step and the far part once per step.  The price follows
// from the plan's own times at the splitting of scheme euler, and is compared with that scheme. For
// given substeps the splitting is the cheapest that keeps the far part softer than the near one.
TEST(PsePlan, PriceOfSubsteps)
{
  PseScene scene = scene_of(cubic_cell(24.0), 500, 1.0, 1e-3);
  const PsePlan euler = bdh::plan_pse(scene);
  scene.xi = euler.xi;
  scene.splitting = euler.splitting;
  scene.substeps = 5;
  const PsePlan same = bdh::plan_pse(scene);
  EXPECT_NEAR(same.real_seconds, 5.0 * euler.real_seconds, 1e-9 * same.real_seconds);
  EXPECT_NEAR(same.wave_seconds, euler.wave_seconds, 1e-9 * euler.wave_seconds);
  EXPECT_NEAR(bdh::pse_split_price(same, scene),
              (5.0 * euler.real_seconds + euler.wave_seconds) / (5.0 * euler.seconds()), 1e-9);
  scene.xi = 0.0;
  scene.splitting = Splitting::automatic;
  const PsePlan split = bdh::plan_pse(scene);
  EXPECT_LE(6.0 * bdh::pse_far_share(split), 1.0);
  for (double xi : {0.7, 0.85, 0.95}) {
    scene.xi = xi * split.xi;
    EXPECT_LE(split.seconds(), 1.02 * bdh::plan_pse(scene).seconds()) << xi;
  }
}
