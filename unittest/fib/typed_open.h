// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// Laws of the method at open faces, for any backend: include this after fib/typed_confined.h.
//
// The reference, fib_open.json, was made with slits so tall that their far walls are not felt, in
// primitive variables: see unittest/reference/README.md.

#include "fib/active_rows.h"

namespace {

/// The grid of a box with open faces.
Grid open_grid(const std::vector<long> &n, const std::vector<double> &h,
               const std::vector<std::string> &walls, IbKernel kernel, double corner = -0.75)
{
  return beyond_open_faces(with_walls(make_grid(n, h, corner), walls), rows_beyond(kernel));
}

ReferenceCase open_case(const Json &c)
{
  const std::vector<double> h = c["h"].is_array() ? c["h"].get<std::vector<double>>()
                                                  : std::vector<double>{c["h"].get<double>()};
  const IbKernel kernel = c["kernel"] == 3 ? IbKernel::roma3 : IbKernel::peskin4;
  return {open_grid(c["n"].get<std::vector<long>>(), h, c["bc"].get<std::vector<std::string>>(),
                    kernel, 0.0),
          kernel, c["eta"], flatten_to_3d(c["x"])};
}

/// The same with axes a and b exchanged.
ReferenceCase exchanged_open(const ReferenceCase &r, int a, int b)
{
  ReferenceCase e = exchanged(r, a, b);
  std::swap(e.grid.lo[a], e.grid.lo[b]);
  std::swap(e.grid.beyond[a], e.grid.beyond[b]);
  return e;
}

const std::vector<std::string> &open_letters()
{
  static const std::vector<std::string> all{"no", "on", "so", "os", "oo"};
  return all;
}

/// Small grids with unequal spacings, open faces on each axis.
std::vector<Grid> small_open_grids()
{
  std::vector<Grid> grids;
  for (const std::string &w : open_letters()) {
    grids.push_back(open_grid({4, 2}, {0.8, 0.5}, {"p", w}, IbKernel::peskin4));
    grids.push_back(open_grid({1, 5}, {0.8, 0.5}, {w, "p"}, IbKernel::roma3));
    grids.push_back(open_grid({4, 3, 1}, {0.7, 0.9, 0.6}, {"p", "p", w}, IbKernel::roma3));
    grids.push_back(open_grid({3, 1, 4}, {0.7, 0.9, 0.6}, {"p", w, "p"}, IbKernel::peskin4));
  }
  return grids;
}

/// Does a kernel never read this component at this place of the grid?  Between two open ends, that
/// is the velocity along the faces in one of the outermost rows.
bool is_never_read(const Grid &g, int d, const long *at)
{
  for (int a = 0; a < g.dim; ++a)
    if (g.has(Boundary::open, a) && a != d && at[a] == g.n[a] - 1) return true;
  return false;
}

/// 1 for the unknowns that kernels read, else 0.
Eigen::VectorXd read_unknowns(const Grid &g, const DenseOperators &dense)
{
  Eigen::VectorXd read = Eigen::VectorXd::Zero(dense.size());
  for (int d = 0; d < g.dim; ++d)
    for (long place = 0; place < g.cells(); ++place) {
      const long at[3] = {place % g.n[0], place / g.n[0] % g.n[1], place / (g.n[0] * g.n[1])};
      const long number = dense.number(d, place);
      if (number >= 0) read[number] = is_never_read(g, d, at) ? 0.0 : 1.0;
    }
  return read;
}

/// The response of a solver to forces as a matrix, for those unknowns.
Eigen::MatrixXd response_matrix(SolverMatrix &solver, const Eigen::VectorXd &read)
{
  Eigen::MatrixXd R(read.size(), read.size());
  for (long c = 0; c < R.cols(); ++c)
    R.col(c) = solver(read[c] * Eigen::VectorXd::Unit(R.cols(), c), quiet(1.3)).cwiseProduct(read);
  return R;
}

/// div M as divergence_of_mobility() of support/suspension.h, but with differences of tenth order.
/// They stay within 0.009 h, since particles of the reference are at least so far from places where
/// a derivative of their kernel jumps.
std::vector<double> precise_divergence(const ReferenceCase &r)
{
  const double step = 1.8e-3 * r.grid.h(0),
               weights[5] = {5.0 / 6.0, -5.0 / 21.0, 5.0 / 84.0, -5.0 / 504.0, 1.0 / 1260.0};
  Scene s(r.grid, r.kernel, world(), r.x);
  const std::vector<double> none(r.x.size(), 0.0);
  std::vector<double> div = s.velocity(none, quiet(r.viscosity), 1.0);
  for (std::size_t je = 0; je < r.x.size(); ++je) {
    if (int(je % 3) >= r.grid.dim) continue;
    std::vector<double> unit = none;
    unit[je] = 1.0;
    s.bind(r.x);
    s.velocity(unit, quiet(r.viscosity));
    for (int point = 0; point < 10; ++point) {
      const double sign = point % 2 ? -1.0 : 1.0;
      std::vector<double> moved = r.x;
      moved[je] += sign * (point / 2 + 1) * step;
      s.bind(moved);
      const std::vector<double> u = s.interpolated();
      for (std::size_t d = 0; d < 3; ++d)
        div[je / 3 * 3 + d] += sign * weights[point / 2] / step * u[je / 3 * 3 + d];
    }
  }
  return div;
}

/// A problem with noise, for velocities that are compared.
StokesProblem noisy_problem()
{
  StokesProblem p = quiet(1.1);
  p.kT_over_dt = 0.4;
  p.seed = 99;
  p.step = 3;
  p.stress.push_back({1.0, 0});
  p.stress.push_back({0.5, 1});
  return p;
}

/// Velocities of particles in boxes of a given height, with forces, drift and, if wanted, noise.
/// The positions are relative to the lower face, or to the upper one if that is a wall.
std::vector<double> velocity_at_height(long cells, const std::string &walls, IbKernel kernel,
                                       const std::vector<double> &x, bool noisy)
{
  const Grid g = open_grid({9, 8, cells}, {0.9, 0.8, 0.7}, {"p", "p", walls}, kernel);
  std::vector<double> placed = x;
  for (std::size_t i = 2; i < x.size(); i += 3)
    placed[i] = walls[0] == 'o' && walls[1] != 'o' ? g.box_hi(2) - x[i] : g.box_lo(2) + x[i];
  Scene s(g, kernel, world(), placed);
  return s.velocity(random_numbers(x.size(), 8), noisy ? noisy_problem() : quiet(1.1), 0.6);
}

/// Velocities minus that of the first particle.
std::vector<double> relative(std::vector<double> u)
{
  for (std::size_t i = u.size(); i-- > 0;) u[i] -= u[i % 3];
  return u;
}

}    // namespace

// The bound is what the reference is good to: its two routes agree to 1.3e-13.
TEST(TypedOpenMobility, EqualsTheReferenceOnAllAxes)
{
  int cases = 0;
  const Json all = json_reference("fib_open.json");
  for (const Json &c : all["cases"]) {
    const ReferenceCase r = open_case(c);
    SCOPED_TRACE(c["id"].get<std::string>());
    const std::vector<double> f = flatten_to_3d(c["f"]), expected = flatten_to_3d(c["u"]);
    for (int a = 0; a < r.grid.dim; ++a) {
      const int last = r.grid.dim - 1;
      const ReferenceCase e = exchanged_open(r, a, last);
      Scene s(e.grid, e.kernel, world(), e.x);
      const std::vector<double> u = s.velocity(exchanged(f, a, last), quiet(r.viscosity));
      EXPECT_LT(difference(exchanged(u, a, last), expected), 1e-12 * norm(expected))
          << "axis " << a;
    }
    ++cases;
  }
  EXPECT_GE(cases, 30);
}

TEST(TypedOpenMobility, MatrixEqualsTheReferenceAndIsSymmetric)
{
  const Json all = json_reference("fib_open.json");
  for (const Json &c : all["cases"]) {
    const ReferenceCase r = open_case(c);
    const Eigen::MatrixXd M = dense_mobility<Backend>(r.grid, r.kernel, r.x, r.viscosity);
    for (long i = 0; i < M.rows(); ++i)
      for (long j = 0; j < M.cols(); ++j)
        EXPECT_NEAR(M(i, j), c["M"][i][j].get<double>(), 1e-12 * M.norm()) << c["id"];
    EXPECT_LT((M - M.transpose()).norm(), 1e-13 * M.norm()) << c["id"];
    EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(M).eigenvalues().minCoeff(), 0.0)
        << c["id"];
  }
}

// Between two open faces div M is less than a hundredth of M/h, so that roundings of the
// differences count: 1e-16 M over a step of 2e-3 h.
TEST(TypedOpenDrift, DivergenceOfMobilityEqualsTheReference)
{
  int cases = 0;
  const Json all = json_reference("fib_open.json");
  for (const Json &c : all["cases"]) {
    if (!c.contains("div_M")) continue;
    const ReferenceCase r = open_case(c);
    const std::vector<double> expected = flatten_to_3d(c["div_M"]);
    const double rounding = 5e-13 * c["M"][0][0].get<double>() / r.grid.h(0);
    EXPECT_LT(difference(precise_divergence(r), expected), 1e-11 * norm(expected) + rounding)
        << c["id"];
    ++cases;
  }
  EXPECT_GE(cases, 15);
}

// Above one no-slip wall the box may end anywhere above the particles, for the random velocities,
// too.  Without such a wall only differences of velocities have a meaning, and without noise.
TEST(TypedOpenMobility, DoesNotDependOnTheHeightOfTheBox)
{
  for (const std::string &walls : open_letters())
    for (IbKernel kernel : all_kernels) {
      const bool friction = walls.find('n') != std::string::npos;
      std::vector<double> x = random_numbers(15, 7);
      for (std::size_t i = 2; i < x.size(); i += 3) x[i] = 0.7 * (0.2 + 1.9 * double(i / 3));
      x[14] = 0.7 * (8.0 - 1e-12);    // at the open face of the low box
      const auto velocity = [&](long cells) {
        const std::vector<double> u = velocity_at_height(cells, walls, kernel, x, friction);
        return friction ? u : relative(u);
      };
      const std::vector<double> low = velocity(8), high = velocity(30);
      EXPECT_LT(difference(low, high), 1e-13 * norm(high)) << walls << " " << kernel_name(kernel);
    }
}

// The rows up to the highest particle are enough, with noise, on any axis and below a wall, too.
TEST(TypedOpenMobility, NeedsOnlyTheRowsUpToTheHighestParticle)
{
  for (const std::string walls : {"no", "on"}) {
    const Grid whole = open_grid({9, 8, 50}, {0.9, 0.8, 0.7}, {"p", "p", walls}, IbKernel::peskin4);
    std::vector<double> x = random_numbers(15, 7);
    for (std::size_t i = 2; i < x.size(); i += 3)
      x[i] = walls == "on" ? whole.box_hi(2) - 0.5 * i : whole.box_lo(2) + 0.5 * i;
    ActiveRows rows(whole, world());
    const typename Backend::Execution execution;
    EXPECT_TRUE(rows.follow(execution, x.data(), 5));
    const Grid low = rows.grid();
    EXPECT_FALSE(rows.follow(execution, x.data(), 5));
    EXPECT_EQ(low.n[2], 16);    // 7 spacings of 0.7, spare 2, beyond 3: at least 15
    EXPECT_NEAR(low.box_lo(2), whole.box_lo(2), 1e-12);
    EXPECT_NEAR(low.box_hi(2), whole.box_hi(2), 1e-12);
    Scene all(whole, IbKernel::peskin4, world(), x), some(low, IbKernel::peskin4, world(), x);
    const std::vector<double> force = random_numbers(15, 9);
    const std::vector<double> expected = all.velocity(force, noisy_problem(), 0.6);
    EXPECT_LT(difference(some.velocity(force, noisy_problem(), 0.6), expected),
              1e-13 * norm(expected))
        << walls;
    rows.grow();
    EXPECT_EQ(rows.grid().n[2], 32);
    // The number does not depend on what was before.
    EXPECT_TRUE(rows.follow(execution, x.data(), 5));
    EXPECT_EQ(rows.grid().n[2], low.n[2]);
  }
}

// With fewer rows, the particle at the face would notice the end of the grid.  Where the
// elimination begins, one row less would do: the face beyond the last row is an unknown there.
TEST(TypedOpenMobility, NeedsTheRowsBeyondTheFace)
{
  for (const char *walls : {"no", "oo"})
    for (IbKernel kernel : all_kernels) {
      const Grid box = with_walls(make_grid({8, 8, 6}, {1.0}, 0.0), {"p", "p", walls});
      const std::vector<double> x{0.3, 0.2, 5.99, 2.0, 1.7, 5.9};
      const auto velocity = [&](long rows) {
        Scene s(beyond_open_faces(box, rows), kernel, world(), x);
        const std::vector<double> u = s.velocity({1.0, 0.5, 1.0, -0.3, 0.4, 1.0}, quiet(1.0));
        return walls[0] == 'o' ? relative(u) : u;
      };
      const long rows = rows_beyond(kernel), too_few = walls[0] == 'o' ? rows - 1 : rows - 2;
      const std::vector<double> enough = velocity(rows), more = velocity(rows + 1);
      EXPECT_LT(difference(enough, more), 1e-13 * norm(more)) << walls << kernel_name(kernel);
      if (kernel == IbKernel::roma3) continue;    // it has half a row to spare
      EXPECT_GT(difference(velocity(too_few), more), 1e-5 * norm(more))
          << walls << kernel_name(kernel);
    }
}

// A free-slip wall far above is felt less the farther it is.  The slowest mode decays over the
// width of the box, so that doubling the height squares the error.
TEST(TypedOpenMobility, IsTheLimitOfARecedingSlipWall)
{
  const std::vector<double> x{0.3, 0.2, 1.5, 2.0, 1.7, 3.4}, f{1.0, 0.5, 1.0, -0.3, 0.4, 1.0};
  const auto velocity = [&](const Grid &g) {
    Scene s(g, IbKernel::peskin4, world(), x);
    return s.velocity(f, quiet(1.0));
  };
  const std::vector<double> open =
      velocity(open_grid({8, 8, 4}, {1.0}, {"p", "p", "no"}, IbKernel::peskin4, 0.0));
  double error[3];
  for (int level = 0; level < 3; ++level) {
    const Grid slit = with_walls(make_grid({8, 8, 8L << level}, {1.0}, 0.0),
                                 std::vector<std::string>{"p", "p", "ns"});
    error[level] = difference(velocity(slit), open) / norm(open);
  }
  EXPECT_GT(error[0], 1e-3);
  EXPECT_LT(error[1], 10.0 * error[0] * error[0]);
  EXPECT_LT(error[2], 10.0 * error[1] * error[1]);
}

// The inverse of a tall slit, restricted to the rows of the grid, has a factor for these rows
// alone: N N^T = 2 kT/(eta dt dV) times the response to forces, as matrices.
TEST(TypedOpenNoise, CovarianceIsTheResponse)
{
  for (const Grid &g : small_open_grids()) {
    SolverMatrix solver(g);
    const Eigen::VectorXd read = read_unknowns(g, solver.dense());
    StokesProblem p = quiet(1.3);
    p.kT_over_dt = 0.7;
    p.stress.push_back({0.6, 0});
    const Eigen::MatrixXd N = read.asDiagonal() * noise_matrix(solver, p);
    const Eigen::MatrixXd expected =
        0.36 * 2.0 * 0.7 / g.cell_volume() * response_matrix(solver, read);
    EXPECT_LT((N * N.transpose() - expected).norm(), 1e-13 * expected.norm()) << wall_names(g);
  }
}

// The response itself against the dense inverse of a tall slit with a free-slip wall far above. The
// slowest mode decays by e^-2.7 per row, so 14 rows more are enough.
TEST(TypedOpenSolver, EqualsTheDenseInverseOfATallSlit)
{
  const Grid g = open_grid({4, 2}, {0.9, 0.8}, {"p", "no"}, IbKernel::peskin4);
  const Grid tall = with_walls(make_grid({4, g.n[1] + 14}, {0.9, 0.8}), {"p", "ns"});
  SolverMatrix solver(g);
  const DenseOperators dense(tall);
  const Eigen::VectorXd read = read_unknowns(g, solver.dense());
  const Eigen::MatrixXd found = response_matrix(solver, read),
                        inverse = dense.stokes_inverse() / 1.3;
  Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(found.rows(), found.cols());
  const auto for_unknowns = [&](auto action) {
    for (int d = 0; d < 2; ++d)
      for (long place = 0; place < g.cells(); ++place)
        if (solver.dense().number(d, place) >= 0)
          action(solver.dense().number(d, place), dense.number(d, place));
  };
  for_unknowns([&](long i, long I) {
    for_unknowns([&](long j, long J) { expected(i, j) = read[i] * read[j] * inverse(I, J); });
  });
  EXPECT_LT((found - expected).norm(), 1e-12 * expected.norm());
}

TEST(TypedOpenMobility, DoesNotDependOnTheNumberOfRanks)
{
  for (const Grid &small : small_open_grids()) {
    Grid g = small;
    for (int d = 0; d < g.dim; ++d) {
      g.n[d] += 5;
      g.length[d] += 5 * small.h(d);
    }
    const long n = 17;
    std::vector<double> x = random_positions(g, n, 5);
    for (std::size_t i = 0; i < x.size(); ++i) {
      const int d = i % 3;
      if (d < g.dim) x[i] = std::min(std::max(x[i], g.box_lo(d)), g.box_hi(d));
    }
    const std::vector<double> force = random_numbers(3 * n, 6);
    Scene together(g, IbKernel::peskin4, world(), x), alone(g, IbKernel::peskin4, self(), x);
    const std::vector<double> expected = alone.velocity(force, noisy_problem(), 0.6);
    EXPECT_LT(difference(together.velocity(force, noisy_problem(), 0.6), expected),
              1e-12 * norm(expected))
        << wall_names(g);
  }
}

// A no-slip wall carries the whole net force, whatever the noise.  A free-slip wall carries only
// the normal one, and nothing acts on an open face.
TEST(TypedOpenFlow, TheWallCarriesTheNetForce)
{
  for (const std::string &walls : open_letters()) {
    const Grid g = open_grid({8, 6, 9}, {1.0, 0.8, 0.5}, {"p", "p", walls}, IbKernel::peskin4);
    Scene s(g, IbKernel::peskin4, world(),
            {0.3, 0.4, g.box_lo(2), 2.0, 1.0, g.box_lo(2) + 2.0, 0.0, 0.0, g.box_hi(2)});
    StokesProblem p = noisy_problem();
    // A particle in a wall exerts no force on the fluid.
    s.velocity({walls[0] == 'o' ? 1.0 : 7.0, 2.0, 3.0, 0.5, -0.4, 0.3, 0.2, 0.3, 0.4}, p);
    const double at_lo[3] = {1.0, 2.0, 3.0}, middle[3] = {0.5, -0.4, 0.3},
                 at_hi[3] = {0.2, 0.3, 0.4};
    const WallVectors f = s.fluid().report().wall_force;
    for (int side = 0; side < 2; ++side)
      for (int d = 0; d < 3; ++d) {
        std::vector<double> sum{f[2][side][d]};
        sum_over_ranks(sum, world());
        double expected = middle[d];
        if (walls[0] == 'o') expected += at_lo[d];
        if (walls[1] == 'o') expected += at_hi[d];
        if (walls[side] == 'o' || (walls[side] == 's' && d < 2)) expected = 0.0;
        // At a free-slip wall the images double the normal force of a particle in it to zero.
        EXPECT_NEAR(sum[0], expected, 1e-12) << walls << " side " << side << " " << d;
      }
  }
}

TEST(TypedOpenErrors, ParticlesBeyondAnOpenFaceAreNamed)
{
  const Grid g = open_grid({8, 8, 8}, {1.0}, {"p", "p", "oo"}, IbKernel::peskin4);
  Fluid fluid(g, IbKernel::peskin4, FftEffort::estimate, self());
  for (double z : {g.box_lo(2) - 1e-6, g.box_hi(2) + 1e-6}) {
    std::vector<double> x(15, 0.0);
    x[3 * 3 + 2] = z;
    try {
      fluid.bind(x.data(), 5);
      ADD_FAILURE() << z << " was accepted";
    } catch (const BadParticle &e) {
      EXPECT_EQ(e.index, 3);
      const std::string text = e.what();
      EXPECT_NE(text.find(z < 0 ? "open face zlo" : "open face zhi"), std::string::npos) << text;
      EXPECT_NE(text.find("make the box larger on that side"), std::string::npos) << text;
    }
    EXPECT_NO_THROW(fluid.bind(x.data(), 5, 1.0));    // what a finite difference may do
    x[3 * 3 + 2] = z < 0 ? g.box_lo(2) : g.box_hi(2);
    EXPECT_NO_THROW(fluid.bind(x.data(), 5));
  }
}

// Shear above one wall, below one, and between two open faces; J leaves a linear flow as it is.
TEST(TypedOpenFlow, ShearGrowsWithTheDistanceFromTheWall)
{
  for (const char *walls : {"no", "on", "oo"}) {
    const Grid g = open_grid({8, 8, 8}, {1.0}, {"p", "p", walls}, IbKernel::peskin4);
    const double lo = g.box_lo(2), hi = g.box_hi(2);
    WallOptions options = moving_along(g, {0.25, 0.5, 0.0});
    std::vector<double> x{1.0, 0.0, lo + 0.1, 0.0, 2.0, lo + 3.3, 0.3, 0.2, hi}, u(9, 0.0);
    const WallMotion motion(options, g, IbKernel::peskin4, 0.7);
    motion.for_adders(x.data(), u.data(),
                      [&](const auto &adder) { Backend::Execution().for_each("walls", 3, adder); });
    for (int p = 0; p < 3; ++p) {
      const double z = x[3 * p + 2], middle = 0.5 * (lo + hi);
      const double distance = walls[0] == 'n' ? z - lo : walls[1] == 'n' ? hi - z : z - middle;
      const bool moves = std::string(walls) != "oo";
      EXPECT_NEAR(u[3 * p], (moves ? 0.25 : 0.0) + 0.7 * distance, 1e-14) << walls;
      EXPECT_NEAR(u[3 * p + 1], moves ? 0.5 : 0.0, 1e-14) << walls;
    }
  }
}

// No solver takes an open face for a free-slip wall.
TEST(TypedOpenErrors, BoxesWithOpenFacesAreRefused)
{
  for (const std::vector<std::string> &walls :
       {std::vector<std::string>{"p", "nn", "no"}, {"oo", "oo", "p"}, {"ss", "p", "os"}}) {
    const Grid g = open_grid({8, 8, 8}, {1.0}, walls, IbKernel::peskin4);
    EXPECT_THROW(Fluid(g, IbKernel::peskin4, FftEffort::estimate, self()), std::logic_error)
        << wall_names(g);
  }
}
