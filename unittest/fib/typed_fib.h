// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// Laws of the immersed-boundary mobility, for any backend: #define TEST_BACKEND before including
// this.
//
// The tests run on any number of ranks.  Particles are dealt round-robin, and results are gathered.

#include "base/errors.h"
#include "fib/reference_kernel.h"
#include "support/reference_json.h"
#include "support/suspension.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <vector>

namespace {

using namespace bdh;
using namespace bdh_test;
using Backend = TEST_BACKEND;
using Fluid = FibFluid<Backend>;
using Scene = Suspension<Backend>;
using Json = nlohmann::json;

struct ReferenceCase {
  Grid grid;
  IbKernel kernel;
  double viscosity;
  std::vector<double> x;
};

ReferenceCase reference_case(const Json &c)
{
  std::vector<double> h;
  if (c["h"].is_array())
    h = c["h"].get<std::vector<double>>();
  else
    h.push_back(c["h"]);
  return {make_grid(c["n"].get<std::vector<long>>(), h, 0.0),
          c["kernel"] == 3 ? IbKernel::roma3 : IbKernel::peskin4, c["eta"], flatten_to_3d(c["x"])};
}

bool is_periodic(const Json &c)
{
  for (const Json &b : c["bc"])
    if (b != "p") return false;
  return true;
}

/// Radius of a sphere with this self-mobility in a cubic (2D: square) periodic box, by the series
/// named in fib/spread.h.
double radius_from_mobility(double mu, int dim, double L)
{
  if (dim == 2) return L / 3.708 * std::exp(-4.0 * M_PI * mu);
  double a = 0.0;
  for (int i = 0; i < 100; ++i) {
    const double r = a / L;
    a = (1.0 - 2.8373 * r + 4.19 * r * r * r - 27.4 * std::pow(r, 6)) / (6.0 * M_PI * mu);
  }
  return a;
}

/// M_xx of one particle at an offset within its cell, for h = eta = 1.
class SelfMobility {
 public:
  SelfMobility(IbKernel kernel, int dim, long n) :
      grid_(make_grid(std::vector<long>(dim, n), {1.0}, 0.0)),
      suspension_(grid_, kernel, world(), {0.0, 0.0, 0.0})
  {}
  double operator()(double ox, double oy, double oz)
  {
    const double middle = grid_.n[0] / 2;
    suspension_.bind({middle + ox, middle + oy, middle + oz});
    return suspension_.velocity({1.0, 0.0, 0.0}, quiet(1.0))[0];
  }

 private:
  Grid grid_;
  Scene suspension_;
};

}    // namespace

// The bound is 1e-12 of the norm of the velocity, 100 times the largest difference between the two
// routes of the reference.
TEST(TypedFibMobility, EqualsTheReferenceOnAllPeriodicCases)
{
  int cases = 0;
  const Json file = json_reference("fib_periodic.json");
  for (const Json &c : file["cases"]) {
    const ReferenceCase r = reference_case(c);
    SCOPED_TRACE(c["id"].get<std::string>());
    Scene s(r.grid, r.kernel, world(), r.x);
    const std::vector<double> expected = flatten_to_3d(c["u"]),
                              u = s.velocity(flatten_to_3d(c["f"]), quiet(r.viscosity));
    EXPECT_LT(difference(u, expected), 1e-12 * norm(expected));
    ++cases;
    if (!c.contains("M")) continue;
    const Eigen::MatrixXd M = dense_mobility<Backend>(r.grid, r.kernel, r.x, r.viscosity);
    for (long i = 0; i < M.rows(); ++i)
      for (long j = 0; j < M.cols(); ++j)
        EXPECT_NEAR(M(i, j), c["M"][i][j].get<double>(), 1e-12 * M.norm());
  }
  EXPECT_EQ(cases, 11);
}

// M = M^T to round-off.  M is positive definite, however much the blobs overlap: the smallest
// eigenvalue belongs to the closest pair (distance 0.02 h) and is of the order of the distance
// squared, far above round-off.
TEST(TypedFibMobility, IsSymmetricAndPositiveDefinite)
{
  for (IbKernel kernel : all_kernels)
    for (const Grid &g : {make_grid({8, 9, 10}, {0.7, 0.8, 0.6}), make_grid({9, 8}, {0.7}),
                          make_grid({12, 14}, {0.5, 0.8})}) {
      SCOPED_TRACE(std::string(kernel_name(kernel)) + " " + name_of(g));
      std::vector<double> x = random_positions(g, 9, 1, 2.0);
      x.insert(x.end(), {0.1, 0.2, 0.3, 0.4, 0.2, 0.35, 0.41, 0.21, 0.35});
      const Eigen::MatrixXd M = dense_mobility<Backend>(g, kernel, x, 1.7);
      EXPECT_LT((M - M.transpose()).norm(), 1e-15 * M.norm());
      const Eigen::VectorXd e = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(M).eigenvalues();
      EXPECT_GT(e.minCoeff(), 1e-10 * e.maxCoeff());
    }
}

// f.(M g) = g.(M f), scaled by |f||Mg| so that the bound depends neither on n nor on cancellation.
TEST(TypedFibMobility, SymmetryOfRandomForcePairs)
{
  for (IbKernel kernel : all_kernels) {
    const Grid g = make_grid({12, 10, 14}, {0.9});
    const std::vector<double> x = random_positions(g, 100, 2, 3.0), f = random_numbers(300, 3),
                              k = random_numbers(300, 4);
    Scene s(g, kernel, world(), x);
    const std::vector<double> Mf = s.velocity(f, quiet(0.8)), Mk = s.velocity(k, quiet(0.8));
    double fMk = 0.0, kMf = 0.0;
    for (std::size_t i = 0; i < f.size(); ++i) {
      fMk += f[i] * Mk[i];
      kMf += k[i] * Mf[i];
    }
    EXPECT_LT(std::fabs(fMk - kMf), 1e-14 * norm(f) * norm(Mk)) << kernel_name(kernel);
  }
}

// Velocity, noise and drift are the same for any number of ranks, also with fewer planes (3) than
// ranks.
TEST(TypedFibMobility, DoesNotDependOnTheNumberOfRanks)
{
  for (IbKernel kernel : all_kernels) {
    const long w = kernel_width(kernel);
    for (const Grid &g : {make_grid({8, 7, w}, {0.7}), make_grid({7, 8, 11}, {0.7, 0.8, 0.9}),
                          make_grid({9, w}, {0.7}), make_grid({6, 13}, {0.7})}) {
      SCOPED_TRACE(std::string(kernel_name(kernel)) + " " + name_of(g));
      const long n = 17;
      const std::vector<double> x = random_positions(g, n, 5, 3.0),
                                force = random_numbers(3 * n, 6);
      StokesProblem p = quiet(1.1);
      p.kT_over_dt = 0.4;
      p.seed = 99;
      p.step = 3;
      p.stress = {{1.0, 0}, {0.5, 1}};
      Scene together(g, kernel, world(), x), alone(g, kernel, self(), x);
      const std::vector<double> expected = alone.velocity(force, p, 0.6),
                                u = together.velocity(force, p, 0.6);
      EXPECT_LT(difference(u, expected), 1e-13 * norm(expected));
    }
  }
}

// All particles on one rank and none on the others, and no particles at all.
TEST(TypedFibMobility, EmptyRanksAreFine)
{
  const Grid g = make_grid({8, 7, 6}, {0.7});
  const std::vector<double> x = random_positions(g, 5, 7), force = random_numbers(15, 8);
  Scene alone(g, IbKernel::peskin4, self(), x);
  const std::vector<double> expected = alone.velocity(force, quiet(1.0));
  const Comm comm = world();
  Fluid fluid(g, IbKernel::peskin4, FftEffort::estimate, comm);
  const bool mine = comm.rank() == comm.size() - 1;
  fluid.bind(x.data(), mine ? 5 : 0);
  fluid.clear();
  fluid.spread(force.data(), 0.0);
  fluid.solve(quiet(1.0));
  std::vector<double> u(15, 0.0);
  fluid.interpolate(u.data());
  EXPECT_LT(difference(u, mine ? expected : std::vector<double>(15, 0.0)), 1e-13 * norm(expected));
  fluid.bind(x.data(), 0);
  fluid.clear();
  fluid.spread(force.data(), 1.0);
  fluid.solve(quiet(1.0));
  fluid.interpolate(u.data());
  for (int d = 0; d < 3; ++d)
    for (double v : Access<Backend>::get(fluid.component(d))) ASSERT_EQ(v, 0.0);
}

// The mean self-mobility gives the tabulated radius.  For n = 32 in 3D the truncation error of the
// series is 3e-4.  In 2D its (a/L)^2 would shift a by 0.4 %, so the box is larger there.  The last
// digit of the table is rounded.
TEST(TypedFibRadius, MeanOverPositionsIsTheTabulatedRadius)
{
  for (IbKernel kernel : all_kernels)
    for (int dim : {2, 3}) {
      const long n = dim == 2 ? 128 : 32, points = 4;
      SelfMobility mobility(kernel, dim, n);
      // By symmetry, a trapezoidal rule over 0 .. 1/2 in each direction, which is an eighth (2D: a
      // quarter) of the cell, covers all positions.
      double sum = 0.0, weights = 0.0, low = 1e9, high = 0.0;
      for (long i = 0; i <= points; ++i)
        for (long j = 0; j <= points; ++j)
          for (long k = 0; k <= (dim == 3 ? points : 0); ++k) {
            double w = (i % points ? 2.0 : 1.0) * (j % points ? 2.0 : 1.0) *
                       (dim == 3 && k % points ? 2.0 : 1.0);
            const double mu = mobility(0.5 * i / points, 0.5 * j / points, 0.5 * k / points);
            sum += w * mu;
            weights += w;
            const double a = radius_from_mobility(mu, dim, n);
            low = std::min(low, a);
            high = std::max(high, a);
          }
      const double a = radius_from_mobility(sum / weights, dim, n);
      EXPECT_NEAR(a / radius_over_spacing(kernel, dim), 1.0, 2e-3)
          << kernel_name(kernel) << " " << dim << "D";
      // The extremes lie on the faces and centres of the cell.  In 3D the tabulated spread comes
      // from a sample of positions without them and is smaller by a factor of up to 1.27.
      const double spread = 0.5 * (high - low) / a;
      EXPECT_LT(spread, 1.3 * radius_spread(kernel, dim))
          << kernel_name(kernel) << " " << dim << "D";
      EXPECT_GT(spread, 0.95 * radius_spread(kernel, dim))
          << kernel_name(kernel) << " " << dim << "D";
    }
}

// An independent table of the mean, the smallest and the largest M_xx over the offsets (i + 1/2)/8,
// i < 4, with 16 digits.
TEST(TypedFibRadius, SelfMobilityEqualsTheReferenceTable)
{
  std::ifstream in(std::string(BDH_REFERENCE_DIR) + "/fib_radius.csv");
  ASSERT_TRUE(in);
  int rows = 0;
  for (std::string line; std::getline(in, line);) {
    if (line.empty() || line[0] == '#' || line[0] == 'd') continue;
    std::vector<double> v;
    std::istringstream fields(line);
    for (std::string field; std::getline(fields, field, ',');) v.push_back(std::stod(field));
    const int dim = v[0];
    const long n = v[2];
    if (n > (dim == 3 ? 32 : 64)) continue;    // larger boxes take longer and test nothing new
    SelfMobility mobility(v[1] == 3 ? IbKernel::roma3 : IbKernel::peskin4, dim, n);
    double sum = 0.0, count = 0.0, low = 1e9, high = 0.0;
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j)
        for (int k = 0; k < (dim == 3 ? 4 : 1); ++k) {
          const double mu = mobility((i + 0.5) / 8.0, (j + 0.5) / 8.0, (k + 0.5) / 8.0);
          sum += mu;
          count += 1.0;
          low = std::min(low, mu);
          high = std::max(high, mu);
        }
    EXPECT_NEAR(sum / count, v[3], 1e-13 * v[3]) << line;
    EXPECT_NEAR(low, v[4], 1e-13 * v[4]) << line;
    EXPECT_NEAR(high, v[5], 1e-13 * v[5]) << line;
    ++rows;
  }
  EXPECT_EQ(rows, 8);
}

// kT div M of the reference, from the spread drift (exact) and the derivative of J.  The error of
// differences with a step of 1e-5 h is 1e-10 phi''' plus 1e-16/1e-5, together some 1e-9 of M/h,
// which is 1e-7 of div M.
TEST(TypedFibDrift, DivergenceOfMobilityEqualsTheReference)
{
  int cases = 0;
  const Json file = json_reference("fib_divM.json");
  for (const Json &c : file["cases"]) {
    if (!is_periodic(c)) continue;
    const ReferenceCase r = reference_case(c);
    const std::vector<double> expected = flatten_to_3d(c["div_M"]);
    EXPECT_LT(
        difference(divergence_of_mobility<Backend>(r.grid, r.kernel, r.viscosity, r.x), expected),
        1e-6 * norm(expected))
        << c["id"];
    ++cases;
  }
  EXPECT_EQ(cases, 4);
}

// Only the grid breaks translational invariance.  |div M| decreases from roma3 to peskin4 to bkp6,
// as does the spread of the self-mobility (by factors of 3 and 30).
TEST(TypedFibDrift, DivergenceFallsWithTheSmoothnessOfTheKernel)
{
  const Grid g = make_grid({16, 16}, {1.0}, 0.0);
  double previous = 1.0;
  for (IbKernel kernel : all_kernels) {
    double sum = 0.0;
    for (int i = 0; i < 8; ++i) {
      const double d = norm(
          divergence_of_mobility<Backend>(g, kernel, 1.0, {4.0 + 0.11 * i, 5.0 + 0.07 * i, 0.0}));
      sum += d * d;
    }
    const double rms = std::sqrt(sum / 8.0);
    EXPECT_LT(rms, 0.5 * previous) << kernel_name(kernel);
    previous = rms;
  }
}

TEST(TypedFibErrors, BadPositionsAreNamedByIndex)
{
  const Grid g = make_grid({8, 8, 8}, {1.0});
  Fluid fluid(g, IbKernel::peskin4, FftEffort::estimate, self());
  for (double bad : {double(NAN), double(INFINITY), -double(INFINITY), 1e300})
    for (long place : {0L, 7L, 14L}) {
      std::vector<double> x = random_positions(g, 5, 9);
      x[place] = bad;
      try {
        fluid.bind(x.data(), 5);
        ADD_FAILURE() << bad << " was accepted";
      } catch (const BadParticle &e) {
        EXPECT_EQ(e.index, place / 3);
        EXPECT_NE(std::string(e.what()).find("position"), std::string::npos);
      }
    }
}

// In 2D the third coordinate has no effect, whatever its value.
TEST(TypedFibErrors, ThirdCoordinateIsIgnoredIn2D)
{
  const Grid g = make_grid({8, 8}, {1.0});
  Fluid fluid(g, IbKernel::peskin4, FftEffort::estimate, self());
  std::vector<double> x = random_positions(g, 2, 9), u(6, NAN);
  x[2] = NAN;
  x[5] = 1e300;
  EXPECT_NO_THROW(fluid.bind(x.data(), 2));
  fluid.clear();
  fluid.spread(std::vector<double>{1.0, 2.0, NAN, 3.0, 4.0, NAN}.data(), 1.0);
  fluid.solve(quiet(1.0));
  fluid.interpolate(u.data());
  for (double v : u) EXPECT_TRUE(std::isfinite(v));
  EXPECT_EQ(u[2], 0.0);
  EXPECT_EQ(u[5], 0.0);
}

TEST(TypedFibErrors, KernelNames)
{
  for (IbKernel kernel : all_kernels) EXPECT_EQ(kernel_from_name(kernel_name(kernel)), kernel);
  EXPECT_EQ(kernel_width(IbKernel::roma3), 3);
  EXPECT_EQ(kernel_width(IbKernel::peskin4), 4);
  EXPECT_EQ(kernel_width(IbKernel::bkp6), 6);
  for (const char *name : {"", "peskin", "Roma3", "bkp6 "}) {
    try {
      kernel_from_name(name);
      ADD_FAILURE() << name << " was accepted";
    } catch (const InvalidOption &e) {
      EXPECT_NE(std::string(e.what()).find("must be roma3, peskin4 or bkp6"), std::string::npos)
          << e.what();
    }
  }
}
