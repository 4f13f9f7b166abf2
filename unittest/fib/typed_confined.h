// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// Laws of the method between walls, for any backend: #define TEST_BACKEND before including this.
//
// TEST_MATRIX_OF_EVERY n: only every n-th grid of walled_grids() is measured as a matrix; default:
// all.
//
// The tests run on any number of ranks.

#include "base/errors.h"
#include "fib/confined.h"
#include "fib/moving_walls.h"
#include "fib/reference_kernel.h"
#include "support/reference_json.h"
#include "support/suspension.h"

#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <sstream>

#ifndef TEST_MATRIX_OF_EVERY
#define TEST_MATRIX_OF_EVERY 1
#endif

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
  const std::vector<double> h{c["h"].get<double>()};
  return {with_walls(make_grid(c["n"].get<std::vector<long>>(), h, 0.0),
                     c["bc"].get<std::vector<std::string>>()),
          c["kernel"] == 3 ? IbKernel::roma3 : IbKernel::peskin4, c["eta"], flatten_to_3d(c["x"])};
}

/// For solvers that iterate, a tolerance tighter than any bound below.
StokesProblem tight(double viscosity)
{
  StokesProblem p = quiet(viscosity);
  p.tolerance = 1e-13;
  return p;
}

/// A scene with axes a and b exchanged, so that the walls belong to other axes than in the file.
ReferenceCase exchanged(ReferenceCase r, int a, int b)
{
  std::swap(r.grid.n[a], r.grid.n[b]);
  std::swap(r.grid.length[a], r.grid.length[b]);
  std::swap(r.grid.boundary[a], r.grid.boundary[b]);
  for (std::size_t i = 0; i < r.x.size(); i += 3) std::swap(r.x[i + a], r.x[i + b]);
  return r;
}

std::vector<double> exchanged(std::vector<double> v, int a, int b)
{
  for (std::size_t i = 0; i < v.size(); i += 3) std::swap(v[i + a], v[i + b]);
  return v;
}

void expect_reference_mobility(const char *file, int expected_cases, double bound)
{
  int cases = 0;
  const Json all = json_reference(file);
  for (const Json &c : all["cases"]) {
    const ReferenceCase r = reference_case(c);
    SCOPED_TRACE(c["id"].get<std::string>());
    Scene s(r.grid, r.kernel, world(), r.x);
    const std::vector<double> f = flatten_to_3d(c["f"]), expected = flatten_to_3d(c["u"]);
    EXPECT_LT(difference(s.velocity(f, tight(r.viscosity)), expected), bound * norm(expected));
    for (int a = 0; a + 1 < r.grid.dim; ++a) {
      const ReferenceCase e = exchanged(r, a, r.grid.dim - 1);
      Scene t(e.grid, e.kernel, world(), e.x);
      const std::vector<double> u = t.velocity(exchanged(f, a, r.grid.dim - 1), tight(r.viscosity));
      EXPECT_LT(difference(exchanged(u, a, r.grid.dim - 1), expected), bound * norm(expected))
          << "axis " << a;
    }
    ++cases;
  }
  EXPECT_EQ(cases, expected_cases);
}

/// Makes all no-slip walls move with velocity V.
WallOptions moving_along(const Grid &g, const std::array<double, 3> &V)
{
  WallOptions walls;
  for (int axis = 0; axis < 3; ++axis)
    for (int side = 0; side < 2; ++side) {
      walls.face[axis][side].kind = g.boundary[axis][side];
      if (g.boundary[axis][side] == Boundary::noslip) walls.face[axis][side].velocity = V;
    }
  return walls;
}

/// Velocity of particles at x that are driven by the walls alone.
std::vector<double> flow_of_walls(Scene &s, const WallOptions &walls, IbKernel kernel,
                                  const std::vector<double> &x)
{
  const WallMotion motion(walls, s.fluid().grid(), kernel);
  StokesProblem p = tight(1.3);
  p.wall_velocity = motion.left_to_solver();
  std::vector<double> u = s.velocity(std::vector<double>(x.size(), 0.0), p);
  motion.for_adders(x.data(), u.data(), [&](const auto &adder) {
    Backend::Execution().for_each("walls", x.size() / 3, adder);
  });
  return u;
}

/// Force of the fluid on the walls in the last solve, summed over all ranks.
std::vector<double> force_on_all_walls(Scene &s)
{
  std::vector<double> sum(3, 0.0);
  for (const auto &axis : s.fluid().report().wall_force)
    for (const auto &side : axis)
      for (int d = 0; d < 3; ++d) sum[d] += side[d];
  sum_over_ranks(sum, world());
  return sum;
}

/// The solver as a matrix on the unknowns, found column by column.  For one rank.
class SolverMatrix {
 public:
  explicit SolverMatrix(const Grid &g) :
      order_(solver_order(g)), grid_(order_(g)), dense_(g),
      stokes_(grid_, self(), FftEffort::estimate)
  {}
  const DenseOperators &dense() const { return dense_; }

  Eigen::VectorXd operator()(const Eigen::VectorXd &f, const StokesProblem &problem)
  {
    FieldView view{};
    std::vector<double> values[3];
    for (std::vector<double> &v : values) v.assign(stokes_.allocation(), 0.0);
    for_unknowns([&](int d, long at, long number) { values[d][at] = f[number]; });
    for (int d = 0; d < grid_.dim; ++d) {
      Access<Backend>::put(values[d], local_[d]);
      view[d] = local_[d].data();
    }
    stokes_.solve(view, problem);
    Eigen::VectorXd v(dense_.size());
    for (int d = 0; d < grid_.dim; ++d) values[d] = Access<Backend>::get(local_[d]);
    for_unknowns([&](int d, long at, long number) { v[number] = values[d][at]; });
    return v;
  }

 private:
  /// Calls action(component of the solver, place in its array, number of the unknown).
  template <class Action> void for_unknowns(Action action)
  {
    const Slab all{0, grid_.n[grid_.slow_axis()]};
    for (int d = 0; d < grid_.dim; ++d)
      for_slab(grid_, all, [&](std::size_t local, std::size_t place) {
        const long p = place;
        const long at[3] = {p % grid_.n[0], p / grid_.n[0] % grid_.n[1],
                            p / (grid_.n[0] * grid_.n[1])};
        long box[3], n[3];
        for (int a = 0; a < 3; ++a) {
          box[order_.axis[a]] = at[a];
          n[order_.axis[a]] = grid_.n[a];
        }
        const long number = dense_.number(order_.axis[d], (box[2] * n[1] + box[1]) * n[0] + box[0]);
        if (number >= 0) action(d, local, number);
      });
  }

  AxisOrder order_;
  Grid grid_;
  DenseOperators dense_;
  typename Backend::Stokes stokes_;
  typename Backend::Vector local_[3];
};

/// 1 for one number of one mode, 0 for all others.  Records which modes are requested.
class UnitNormals : public NormalSource {
 public:
  void get(uint32_t, uint64_t index, double *z) const override
  {
    for (int m = 0; m < 4; ++m) z[m] = index == chosen && m == part ? 1.0 : 0.0;
    seen[index] = 0;
  }
  uint64_t chosen = ~0ull;
  int part = 0;
  mutable std::map<uint64_t, int> seen;
};

/// The random velocity as a matrix with one column for each normal that the solver may use.
Eigen::MatrixXd noise_matrix(SolverMatrix &solver, StokesProblem p)
{
  UnitNormals normals;
  p.normals = &normals;
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(solver.dense().size());
  solver(none, p);
  const std::map<uint64_t, int> all = normals.seen;
  Eigen::MatrixXd N(solver.dense().size(), 4 * bdh::ssize(all));
  long column = 0;
  for (const auto &mode : all)
    for (normals.part = 0; normals.part < 4; ++normals.part) {
      normals.chosen = mode.first;
      N.col(column++) = solver(none, p);
    }
  return N;
}

/// Small grids with unequal spacings and all combinations of walls: 20 slits, and 64 grids with
/// more walls.
std::vector<Grid> walled_grids()
{
  std::vector<Grid> grids;
  const std::vector<std::string> walls{"nn", "ns", "sn", "ss"};
  for (const std::string &w : walls) {
    grids.push_back(with_walls(make_grid({4, 6}, {0.8, 0.5}), {"p", w}));
    grids.push_back(with_walls(make_grid({5, 4}, {0.8, 0.5}), {w, "p"}));
    grids.push_back(with_walls(make_grid({4, 3, 5}, {0.7, 0.9, 0.6}), {"p", "p", w}));
    grids.push_back(with_walls(make_grid({5, 4, 4}, {0.7, 0.9, 0.6}), {"p", w, "p"}));
    grids.push_back(with_walls(make_grid({4, 4, 4}, {0.7, 0.9, 0.6}), {w, "p", "p"}));
    for (const std::string &v : walls) {
      grids.push_back(with_walls(make_grid({4, 6}, {0.8, 0.5}), {v, w}));
      grids.push_back(with_walls(make_grid({3, 4, 5}, {0.7, 0.9, 0.6}), {v, w, "p"}));
      grids.push_back(with_walls(make_grid({4, 4, 3}, {0.7, 0.9, 0.6}), {"p", v, w}));
      grids.push_back(with_walls(make_grid({4, 3, 4}, {0.7, 0.9, 0.6}), {w, v, v}));
    }
  }
  return grids;
}

/// The grids whose solvers are measured as matrices: some of those above, and slits in whose middle
/// the entries of the factors are those of an endless lattice.
std::vector<Grid> matrix_grids()
{
  std::vector<Grid> some;
  some.push_back(with_walls(make_grid({4, 20}, {0.6, 0.9}), {"p", "ns"}));
  some.push_back(with_walls(make_grid({3, 4, 20}, {0.7, 0.6, 0.9}), {"p", "p", "sn"}));
  const std::vector<Grid> all = walled_grids();
  for (std::size_t i = 0; i < all.size(); i += TEST_MATRIX_OF_EVERY) some.push_back(all[i]);
  return some;
}

}    // namespace

// D~ D~* = -L with variances 2, 0 and 1.  The tests below compare the random velocity of the
// solvers with this D~.
TEST(TypedConfinedNoise, StressDivergenceFactorsTheLaplacian)
{
  for (const Grid &g : walled_grids()) {
    const DenseOperators dense(g);
    const Eigen::MatrixXd B = dense.stress_divergence(), L = dense.laplacian();
    EXPECT_LT((B * B.transpose() + L).norm(), 1e-14 * L.norm()) << wall_names(g);
  }
}

// The bound is 1e-12 because the condition numbers of these small problems are below 1e3.
TEST(TypedConfinedSolver, EqualsTheDenseInverse)
{
  for (const Grid &g : matrix_grids()) {
    SolverMatrix solver(g);
    const Eigen::MatrixXd expected = solver.dense().stokes_inverse() / 1.3;
    Eigen::MatrixXd found(expected.rows(), expected.cols());
    for (long c = 0; c < found.cols(); ++c)
      found.col(c) = solver(Eigen::VectorXd::Unit(found.cols(), c), tight(1.3));
    EXPECT_LT((found - expected).norm(), 1e-12 * expected.norm()) << wall_names(g);
    EXPECT_LT((solver.dense().divergence() * found).norm(), 1e-12 * expected.norm())
        << wall_names(g);
  }
}

// M^(1/2) M^(1/2)^T = M before interpolation, as matrices: N N^T = 2 kT/(eta dt dV) L^-1.  By the
// first test this is the covariance L^-1 D~ D~* L^-1 of the stochastic stress, FIB eq. (30).
TEST(TypedConfinedNoise, CovarianceIsTheStokesInverse)
{
  for (const Grid &g : matrix_grids()) {
    SolverMatrix solver(g);
    StokesProblem p = tight(1.3);
    p.kT_over_dt = 0.7;
    p.stress.push_back({0.6, 0});
    const Eigen::MatrixXd N = noise_matrix(solver, p);
    const Eigen::MatrixXd inverse = solver.dense().stokes_inverse(),
                          B = solver.dense().stress_divergence();
    const double scale = 0.36 * 2.0 * 0.7 / (1.3 * g.cell_volume());
    const Eigen::MatrixXd expected = scale * inverse * B * B.transpose() * inverse;
    EXPECT_LT((N * N.transpose() - expected).norm(), 1e-12 * expected.norm()) << wall_names(g);
  }
}

// The required accuracy is 1e-10; the two routes of the reference agree to 1e-13.
TEST(TypedConfinedMobility, EqualsTheReferenceInSlits)
{
  expect_reference_mobility("fib_slit.json", 12, 1e-10);
}

TEST(TypedConfinedMobility, EqualsTheReferenceInBoxes)
{
  expect_reference_mobility("fib_box.json", 8, 1e-10);
}

TEST(TypedConfinedMobility, MatrixEqualsTheReferenceAndIsSymmetric)
{
  Json all = json_reference("fib_slit.json")["cases"];
  for (const Json &c : json_reference("fib_box.json")["cases"].get<std::vector<Json>>())
    all.push_back(c);
  ASSERT_EQ(all.size(), 20u);
  for (const Json &c : all) {
    const ReferenceCase r = reference_case(c);
    const Eigen::MatrixXd M = dense_mobility<Backend>(r.grid, r.kernel, r.x, r.viscosity, 1e-13);
    for (long i = 0; i < M.rows(); ++i)
      for (long j = 0; j < M.cols(); ++j)
        EXPECT_NEAR(M(i, j), c["M"][i][j].get<double>(), 1e-10 * M.norm()) << c["id"];
    EXPECT_LT((M - M.transpose()).norm(), 1e-13 * M.norm()) << c["id"];
    EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(M).eigenvalues().minCoeff(), 0.0)
        << c["id"];
  }
}

// FIB Fig. 1 on the grid of that figure, and the channel of Table I.
TEST(TypedConfinedMobility, ProfileAcrossTheSlitOfFigure1EqualsTheReference)
{
  const Grid g = with_walls(make_grid({128, 128, 32}, {1.0}, 0.0), {"p", "p", "nn"});
  std::ifstream in(std::string(BDH_REFERENCE_DIR) + "/fib_slit_128x128x32.csv");
  Scene scenes[] = {Scene(g, IbKernel::roma3, world(), {0.0, 0.0, 1.0}),
                    Scene(g, IbKernel::peskin4, world(), {0.0, 0.0, 1.0})};
  int rows = 0, number = 0;
  for (std::string line; std::getline(in, line);) {
    if (line[0] == '#' || line[0] == 'k') continue;
    if (number++ % 16) continue;    // each row costs three solves of 0.1 s
    std::vector<double> v;
    std::istringstream fields(line);
    for (std::string field; std::getline(fields, field, ',');) v.push_back(std::stod(field));
    Scene &s = scenes[static_cast<int>(v[0]) - 3];
    s.bind({v[1], v[2], v[3]});
    for (std::size_t d = 0; d < 3; ++d) {
      std::vector<double> unit(3, 0.0);
      unit[d] = 1.0;
      EXPECT_NEAR(s.velocity(unit, quiet(1.0))[d], v[4 + d], 1e-10 * v[4 + d]) << line;
    }
    ++rows;
  }
  EXPECT_GT(rows, 15);
}

TEST(TypedConfinedMobility, ChannelOfTableIEqualsTheReference)
{
  const Grid g = with_walls(make_grid({8, 64}, {1.0}, 0.0), {"p", "nn"});
  std::ifstream in(std::string(BDH_REFERENCE_DIR) + "/fib_channel2d.csv");
  int rows = 0;
  for (std::string line; std::getline(in, line);) {
    if (line[0] == '#' || line[0] == 'k') continue;
    std::vector<double> v;
    std::istringstream fields(line);
    for (std::string field; std::getline(fields, field, ',');) v.push_back(std::stod(field));
    Scene s(g, v[0] == 3 ? IbKernel::roma3 : IbKernel::peskin4, world(), {0.0, 1.0, 0.0});
    double mu[2] = {0.0, 0.0};
    for (double offset : {0.0, 0.25, 0.5}) {
      s.bind({offset, v[1], 0.0});
      mu[0] += s.velocity({1.0, 0.0, 0.0}, quiet(1.0))[0] / 3.0;
      mu[1] += s.velocity({0.0, 1.0, 0.0}, quiet(1.0))[1] / 3.0;
    }
    EXPECT_NEAR(mu[0], v[2], 1e-10 * v[2]) << line;
    EXPECT_NEAR(mu[1], v[3], 1e-10 * v[3]) << line;
    ++rows;
  }
  EXPECT_EQ(rows, 512);
}

// The bound is the one for periodic boxes (typed_fib.h): differences of J with a step of 1e-5 h.
TEST(TypedConfinedDrift, DivergenceOfMobilityEqualsTheReference)
{
  int cases = 0;
  const Json all = json_reference("fib_divM.json");
  for (const Json &c : all["cases"]) {
    const ReferenceCase r = reference_case(c);
    if (r.grid.walled_axes() == 0) continue;
    const std::vector<double> expected = flatten_to_3d(c["div_M"]);
    EXPECT_LT(difference(divergence_of_mobility<Backend>(r.grid, r.kernel, r.viscosity, r.x, 1e-13),
                         expected),
              1e-6 * norm(expected))
        << c["id"];
    ++cases;
  }
  EXPECT_EQ(cases, 20);
}

TEST(TypedConfinedMobility, DoesNotDependOnTheNumberOfRanks)
{
  for (const Grid &small : walled_grids()) {
    Grid g = small;
    for (int d = 0; d < g.dim; ++d) {
      g.n[d] += 3;
      g.length[d] *= 1.3;
    }
    const long n = 17;
    const std::vector<double> x = random_positions(g, n, 5), force = random_numbers(3 * n, 6);
    StokesProblem p = tight(1.1);
    p.kT_over_dt = 0.4;
    p.seed = 99;
    p.step = 3;
    p.stress.push_back({1.0, 0});
    p.stress.push_back({0.5, 1});
    p.body_force = {0.1, 0.2, 0.3};
    Scene together(g, IbKernel::peskin4, world(), x), alone(g, IbKernel::peskin4, self(), x);
    const std::vector<double> expected = alone.velocity(force, p, 0.6),
                              u = together.velocity(force, p, 0.6);
    EXPECT_LT(difference(u, expected), 1e-12 * norm(expected)) << wall_names(g);
  }
}

// sum_i F_i.(J v)_i = dV sum_faces v.(S F), also for kernels that extend over walls and corners.
TEST(TypedConfinedSpread, IsTheAdjointOfInterpolation)
{
  for (IbKernel kernel : all_kernels)
    for (const std::vector<std::string> &walls :
         {std::vector<std::string>{"nn", "ns", "ss"}, {"p", "sn", "nn"}, {"ss", "p", "ns"}}) {
      const Grid g = with_walls(make_grid({7, 8, 9}, {0.7, 0.8, 0.9}), walls);
      const Slab all{0, g.n[2]};
      typename Backend::Spreader spreader(g, all, kernel);
      std::vector<double> x = random_positions(g, 60, 3);
      for (int d = 0; d < 3; ++d) {
        x[d] = g.lo[d];    // in a corner
        x[3 + d] = g.lo[d] + g.length[d];
      }
      const std::vector<double> force = random_numbers(x.size(), 4);
      const Field v = random_field(g, 5);
      typename Backend::Vector spread[3], flow[3];
      FieldView s{}, w{};
      const std::size_t size = 2 * g.half() * g.n[1] * g.n[2];
      for (int d = 0; d < 3; ++d) {
        spread[d].resize(size);
        Access<Backend>::put(std::vector<double>(size, 0.0), spread[d]);
        flow[d].resize(size);
        Access<Backend>::put(slab_part(v, d, all, size), flow[d]);
        s[d] = spread[d].data();
        w[d] = flow[d].data();
      }
      std::vector<double> u(x.size());
      spreader.bind(x.data(), 60);
      spreader.spread(force.data(), 0.0, s);
      spreader.interpolate(w, u.data());
      Field f(g);
      for (int d = 0; d < 3; ++d) add_slab(Access<Backend>::get(spread[d]), d, all, f);
      double particles = 0.0, faces = 0.0, scale = 0.0;
      for (std::size_t i = 0; i < u.size(); ++i) particles += u[i] * force[i];
      for (int d = 0; d < 3; ++d)
        for (std::size_t i = 0; i < f.c[d].size(); ++i)
          faces += f.c[d][i] * v.c[d][i] * g.cell_volume();
      for (std::size_t i = 0; i < u.size(); ++i) scale += std::fabs(u[i] * force[i]);
      EXPECT_LT(std::fabs(particles - faces), 1e-14 * scale)
          << wall_names(g) << " " << kernel_name(kernel);
    }
}

// A particle on a no-slip wall neither moves nor drags the fluid along.
TEST(TypedConfinedMobility, VanishesOnANoSlipWall)
{
  const Grid g = with_walls(make_grid({8, 8, 9}, {0.8}), {"p", "p", "nn"});
  Scene s(g, IbKernel::peskin4, world(),
          {1.0, 1.2, g.lo[2], 1.0, 1.2, g.lo[2] + 1e-3, 2.0, 1.0, g.lo[2] + 3.0});
  const std::vector<double> u =
      s.velocity({1.0, 2.0, 3.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0}, quiet(1.0));
  for (double v : u) EXPECT_LT(std::fabs(v), 1e-15);
  const std::vector<double> w =
      s.velocity({0.0, 0.0, 0.0, 1.0, 2.0, 3.0, 1.0, 1.0, 1.0}, quiet(1.0));
  EXPECT_LT(std::fabs(w[0]) + std::fabs(w[1]) + std::fabs(w[2]), 1e-15);
  EXPECT_GT(w[3], 1e-6);
}

// Discrete Poiseuille flow is the parabola through the ghost values: with the walls h/2 away from
// the nearest lines, u = b/(2 eta) (y (H - y) + h^2/4).  J adds the second moment of the kernel,
// which is a constant, K, for bkp6.
TEST(TypedConfinedFlow, BodyForceGivesAParabola)
{
  const Grid g = with_walls(make_grid({6, 24}, {1.0, 0.5}), {"p", "nn"});
  const double H = g.length[1], eta = 1.7, b = 0.9, h = g.h(1);
  std::vector<double> x;
  for (double y = 2.0; y < H - 2.0; y += 0.37) x.insert(x.end(), {0.3, g.lo[1] + y, 0.0});
  Scene s(g, IbKernel::bkp6, world(), x);
  StokesProblem p = quiet(eta);
  p.body_force = {b, 5.0, 0.0};
  const std::vector<double> u = s.velocity(std::vector<double>(x.size(), 0.0), p);
  for (std::size_t i = 0; i < x.size(); i += 3) {
    const double y = x[i + 1] - g.lo[1];
    EXPECT_NEAR(u[i], b / (2.0 * eta) * (y * (H - y) + h * h / 4.0 - bkp6_second_moment * h * h),
                1e-13 * b * H * H / eta);
    EXPECT_NEAR(u[i + 1], 0.0, 1e-14);
  }
}

// Flow along a square duct under a body force is a series of trigonometric and hyperbolic functions
// (Boussinesq 1868).  The method is of second order: halving h divides the error by four.  Its
// size: J adds half the second moment of the kernel (below 1) times h^2 times the Laplacian, -1, so
// at most h^2/2; ghost values at half a spacing add an error of +h^2/8 for each axis.
TEST(TypedConfinedFlow, DuctApproachesTheSeries)
{
  const double H = 2.0, pi = M_PI;
  const auto exact = [&](double x, double y) {    // eta = b = 1; x, y from the axis
    double u = 0.0;
    for (int n = 1; n < 60; n += 2) {
      const double k = n * pi / H;
      u += (n % 4 == 1 ? 1.0 : -1.0) * 4.0 / (H * k * k * k) *
           (1.0 - std::cosh(k * y) / std::cosh(k * H / 2.0)) * std::cos(k * x);
    }
    return u;
  };
  double error[2];
  for (int level = 0; level < 2; ++level) {
    const long n = level ? 24 : 12;
    const Grid g = with_walls(make_grid({n, 4, n}, {H / double(n)}), {"nn", "p", "nn"});
    Scene s(g, IbKernel::peskin4, world(),
            {g.lo[0] + 1.0, 0.3, g.lo[2] + 1.0, g.lo[0] + 0.7, 0.3, g.lo[2] + 1.4});
    StokesProblem p = tight(1.0);
    p.body_force = {0.0, 1.0, 0.0};
    const std::vector<double> u = s.velocity(std::vector<double>(6, 0.0), p);
    error[level] = std::max(std::fabs(u[1] - exact(0.0, 0.0)), std::fabs(u[4] - exact(-0.3, 0.4)));
    // There is no pressure to find, since the flow along the duct is divergence-free.
    EXPECT_LE(s.fluid().report().iterations, 1);
  }
  EXPECT_LT(error[1], 0.5 * H * H / (24.0 * 24.0));
  EXPECT_GT(error[0] / error[1], 3.5);
  EXPECT_LT(error[0] / error[1], 4.5);
}

// The spectrum of the Schur complement depends on the box, not on the grid.
TEST(TypedConfinedSolver, IterationsDoNotGrowWithTheGrid)
{
  int counts[2];
  for (int level = 0; level < 2; ++level) {
    const long n = level ? 32 : 12;
    const Grid g = with_walls(make_grid({n, n, n}, {1.0 / double(n)}), {"nn", "nn", "nn"});
    Scene s(g, IbKernel::peskin4, world(), random_positions(g, 20, 5));
    s.velocity(random_numbers(60, 6), quiet(1.0));
    counts[level] = s.fluid().report().iterations;
    EXPECT_LE(s.fluid().report().residual, 1e-8);
  }
  EXPECT_GT(counts[0], 3);
  EXPECT_LE(counts[1], counts[0] + 5);
}

// Without no-slip walls the Schur complement is the identity.
TEST(TypedConfinedSolver, BoxesWithoutFrictionNeedOneIteration)
{
  const Grid g = with_walls(make_grid({8, 9, 10}, {0.9}), {"ss", "p", "ss"});
  Scene s(g, IbKernel::peskin4, world(), random_positions(g, 20, 5));
  s.velocity(random_numbers(60, 6), tight(1.0));
  EXPECT_EQ(s.fluid().report().iterations, 1);
}

// The forces of the fluid on both walls add up to the spread forces: tangential ones by friction,
// normal ones by pressure.
TEST(TypedConfinedFlow, WallsCarryTheNetForce)
{
  for (const char *walls : {"nn", "ns", "sn"}) {
    const Grid g = with_walls(make_grid({8, 6, 24}, {1.0, 0.8, 0.5}), {"p", "p", walls});
    Scene s(g, IbKernel::peskin4, world(), {0.3, 0.4, g.lo[2] + 3.3, 2.0, 1.0, g.lo[2] + 8.0});
    StokesProblem p = quiet(1.4);
    p.body_force = {0.01, 0.02, 0.03};
    p.kT_over_dt = 1.0;
    p.stress.push_back({1.0, 0});
    s.velocity({1.0, 2.0, 3.0, 0.5, -0.4, 0.3}, p);
    const WallVectors f = s.fluid().report().wall_force;
    const double volume = g.length[0] * g.length[1] * g.length[2];
    const double total[3] = {1.5 + 0.01 * volume, 1.6 + 0.02 * volume, 3.3 + 0.03 * volume};
    for (int d = 0; d < 3; ++d) {
      std::vector<double> sum{f[2][0][d] + f[2][1][d]};
      sum_over_ranks(sum, world());
      // The face in the lower wall is no unknown, so a uniform normal force acts on n - 1 of n
      // faces.
      const double expected = d < 2 ? total[d] : 3.3 + 0.03 * volume * 23.0 / 24.0;
      EXPECT_NEAR(sum[0], expected, 1e-12 * total[d]) << walls << " " << d;
    }
  }
}

// In a closed box all walls together carry the spread forces.
TEST(TypedConfinedFlow, WallsOfABoxCarryTheNetForce)
{
  const Grid g = with_walls(make_grid({12, 14, 13}, {1.0, 0.8, 0.9}), {"nn", "ns", "nn"});
  Scene s(g, IbKernel::peskin4, world(), {g.lo[0] + 5.3, g.lo[1] + 4.4, g.lo[2] + 3.3});
  s.velocity({1.0, 2.0, 3.0}, tight(1.4));
  const std::vector<double> f = force_on_all_walls(s);
  for (int d = 0; d < 3; ++d) EXPECT_NEAR(f[d], 1.0 + d, 1e-9);
}

// Walls that all move together carry the fluid and the particles along, even in the corners.
TEST(TypedConfinedMovingWalls, MovingTogetherCarryEverything)
{
  const Grid g = with_walls(make_grid({7, 6, 8}, {0.9, 1.0, 0.8}), {"nn", "p", "nn"});
  const WallOptions walls = moving_along(g, {0.0, 1.5, 0.0});
  for (IbKernel kernel : all_kernels) {
    std::vector<double> x = random_positions(g, 40, 3);
    for (int d = 0; d < 3; ++d) {
      x[d] = g.lo[d];
      x[3 + d] = g.lo[d] + g.length[d];
    }
    Scene s(g, kernel, world(), x);
    const std::vector<double> u = flow_of_walls(s, walls, kernel, x);
    for (std::size_t i = 0; i < u.size(); ++i) EXPECT_NEAR(u[i], i % 3 == 1 ? 1.5 : 0.0, 1e-13);
    for (const auto &axis : s.fluid().report().wall_force)
      for (const auto &side : axis)
        for (double f : side) EXPECT_NEAR(f, 0.0, 1e-11);
  }
}

// Cavities with several moving walls, and particles at walls, edges and corners, compared with the
// dense inverse and ghost values.
TEST(TypedConfinedMovingWalls, FlowEqualsTheDenseSolutionWithGhostValues)
{
  for (const std::vector<std::string> &letters : {std::vector<std::string>{"nn", "nn", "nn"},
                                                  {"nn", "p", "ns"},
                                                  {"ss", "nn", "nn"},
                                                  {"nn", "nn"},
                                                  {"sn", "nn"}}) {
    const bool flat = letters.size() == 2;
    const Grid g = with_walls(
        flat ? make_grid({5, 6}, {0.8, 0.5}) : make_grid({5, 4, 6}, {0.7, 0.9, 0.6}), letters);
    WallOptions walls;
    WallVectors V{};
    for (int axis = 0; axis < g.dim; ++axis)
      for (int side = 0; side < 2; ++side) {
        walls.face[axis][side].kind = g.boundary[axis][side];
        if (g.boundary[axis][side] == Boundary::noslip)
          for (int d = 0; d < g.dim; ++d)
            V[axis][side][d] = d == axis ? 0.0 : 0.3 + axis - 0.7 * side + 0.4 * d;
        walls.face[axis][side].velocity = V[axis][side];
      }
    const DenseOperators dense(g);
    const Eigen::VectorXd v = dense.stokes_inverse() * dense.moving_walls(V);
    for (IbKernel kernel : {IbKernel::roma3, IbKernel::peskin4}) {
      std::vector<double> x = random_positions(g, 60, 3);
      for (int d = 0; d < g.dim; ++d) {
        x[d] = g.lo[d];
        x[3 + d] = g.lo[d] + g.length[d];
      }
      Scene s(g, kernel, world(), x);
      const std::vector<double> u = flow_of_walls(s, walls, kernel, x);
      const auto phi = [&](double r) {
        return kernel == IbKernel::roma3 ? phi_roma3(r) : phi_peskin4(r);
      };
      for (std::size_t p = 0; p < x.size() / 3; ++p)
        for (int d = 0; d < g.dim; ++d) {
          double expected = 0.0;
          const long margin = 3;
          for (long k = flat ? 0 : -margin; k < (flat ? 1 : g.n[2] + margin); ++k)
            for (long j = -margin; j < g.n[1] + margin; ++j)
              for (long i = -margin; i < g.n[0] + margin; ++i) {
                double weight = 1.0;
                const long at[3] = {i, j, k};
                for (int a = 0; a < g.dim; ++a)
                  weight *=
                      phi((x[3 * p + a] - g.lo[a]) / g.h(a) - double(at[a]) - (a == d ? 0.0 : 0.5));
                if (weight != 0.0) expected += weight * dense.extended(v, V, d, i, j, k);
              }
          EXPECT_NEAR(u[3 * p + d], expected, 1e-11)
              << wall_names(g) << " particle " << p << " component " << d;
        }
    }
  }
}

// In a square duct with one wall moving along it,
//   w = sum over odd n of 4 V/(n pi) sin(n pi x/H) sinh(n pi z/H)/sinh(n pi).
// The method is of second order away from the corners, where the velocity jumps.
TEST(TypedConfinedMovingWalls, DuctWithOneMovingWallApproachesTheSeries)
{
  const double H = 2.0, places[3][2] = {{1.0, 1.0}, {0.6, 1.3}, {1.2, 0.5}};
  double error[2] = {0.0, 0.0};
  for (int level = 0; level < 2; ++level) {
    const long n = level ? 32 : 16;
    const Grid g = with_walls(make_grid({n, 4, n}, {H / double(n)}), {"nn", "p", "nn"});
    WallOptions walls = moving_along(g, {0.0, 0.0, 0.0});
    walls.face[2][1].velocity = {0.0, 1.0, 0.0};
    std::vector<double> x;
    for (const auto &at : places) x.insert(x.end(), {g.lo[0] + at[0], 0.3, g.lo[2] + at[1]});
    Scene s(g, IbKernel::peskin4, world(), x);
    const std::vector<double> u = flow_of_walls(s, walls, IbKernel::peskin4, x);
    for (int p = 0; p < 3; ++p) {
      double exact = 0.0;
      for (int m = 1; m < 60; m += 2)
        exact += 4.0 / (m * M_PI) * std::sin(m * M_PI * places[p][0] / H) *
                 std::sinh(m * M_PI * places[p][1] / H) / std::sinh(m * M_PI);
      error[level] = std::max(error[level], std::fabs(u[3 * p + 1] - exact));
    }
  }
  // The bound is h^2 times the fourth derivatives of w, which are below 1 there.
  EXPECT_LT(error[1], H * H / (32.0 * 32.0));
  EXPECT_GT(error[0] / error[1], 3.0);
}

// The walls together carry the spread forces, whichever of them move.
TEST(TypedConfinedMovingWalls, NetForceIsCarriedByTheWalls)
{
  const Grid g = with_walls(make_grid({12, 14, 13}, {1.0, 0.8, 0.9}), {"nn", "nn", "nn"});
  WallOptions walls = moving_along(g, {0.0, 0.0, 0.0});
  walls.face[2][1].velocity = {1.0, 0.3, 0.0};
  walls.face[0][0].velocity = {0.0, 0.5, -0.4};
  Scene s(g, IbKernel::peskin4, world(), {g.lo[0] + 5.3, g.lo[1] + 4.4, g.lo[2] + 3.3});
  StokesProblem p = tight(1.4);
  p.wall_velocity = WallMotion(walls, g, IbKernel::peskin4).left_to_solver();
  s.velocity({1.0, 2.0, 3.0}, p);
  const std::vector<double> f = force_on_all_walls(s);
  for (int d = 0; d < 3; ++d) EXPECT_NEAR(f[d], 1.0 + d, 1e-9);
}

TEST(TypedConfinedErrors, ParticlesOutsideAWallAreNamed)
{
  const Grid g = with_walls(make_grid({8, 8, 8}, {1.0}), {"p", "p", "nn"});
  Fluid fluid(g, IbKernel::peskin4, FftEffort::estimate, self());
  for (double z : {g.lo[2] - 1e-9, g.lo[2] + 8.0 + 1e-9}) {
    std::vector<double> x = random_positions(g, 5, 9);
    x[3 * 3 + 2] = z;
    try {
      fluid.bind(x.data(), 5);
      ADD_FAILURE() << z << " was accepted";
    } catch (const BadParticle &e) {
      EXPECT_EQ(e.index, 3);
      EXPECT_NE(std::string(e.what()).find(z < 0 ? "wall zlo" : "wall zhi"), std::string::npos)
          << e.what();
    }
    x[3 * 3] = 1000.0;    // in a periodic direction no position is outside
    x[3 * 3 + 2] = g.lo[2] + 1.0;
    EXPECT_NO_THROW(fluid.bind(x.data(), 5));
  }
}
