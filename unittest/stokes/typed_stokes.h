// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// Laws of the fluctuating Stokes solver, for any backend: #define TEST_BACKEND before including
// this.
//
// The discrete operators are coded here independently, as stencils, without Fourier transforms.
// In statistical bounds z is a deviation in standard errors.

#include "support/test_support.h"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <complex>
#include <vector>

namespace {

using namespace bdh;
using namespace bdh_test;
using Backend = TEST_BACKEND;

long step_along(int d, int axis) { return d == axis ? 1 : 0; }

/// (D v) in cell (i, j, k).  Its lower faces have the same indices.
double divergence(const Field &v, long i, long j, long k)
{
  double sum = 0.0;
  for (int d = 0; d < v.grid.dim; ++d)
    sum += (v.at(d, i + step_along(d, 0), j + step_along(d, 1), k + step_along(d, 2)) -
            v.at(d, i, j, k)) /
           v.grid.h(d);
  return sum;
}

/// (L v)_d on a face, by the usual stencil of 2 dim + 1 points.
double laplacian(const Field &v, int d, long i, long j, long k)
{
  double sum = 0.0;
  for (int a = 0; a < v.grid.dim; ++a) {
    const long x = step_along(a, 0), y = step_along(a, 1), z = step_along(a, 2);
    const double h = v.grid.h(a);
    sum += (v.at(d, i + x, j + y, k + z) - 2.0 * v.at(d, i, j, k) + v.at(d, i - x, j - y, k - z)) /
           (h * h);
  }
  return sum;
}

/// Circulation around the edge that the faces a and b of (i, j, k) share.  It is 0 for every
/// discrete gradient.
double curl(const Field &r, int a, int b, long i, long j, long k)
{
  const auto &g = r.grid;
  return (r.at(b, i, j, k) -
          r.at(b, i - step_along(a, 0), j - step_along(a, 1), k - step_along(a, 2))) /
             g.h(a) -
         (r.at(a, i, j, k) -
          r.at(a, i - step_along(b, 0), j - step_along(b, 1), k - step_along(b, 2))) /
             g.h(b);
}

template <class Action> void for_cells(const Grid &g, Action action)
{
  for (long k = 0; k < g.n[2]; ++k)
    for (long j = 0; j < g.n[1]; ++j)
      for (long i = 0; i < g.n[0]; ++i) action(i, j, k);
}

double largest_divergence(const Field &v)
{
  double worst = 0.0;
  for_cells(v.grid, [&](long i, long j, long k) {
    worst = std::max(worst, std::fabs(divergence(v, i, j, k)));
  });
  return worst;
}

/// The solver with its arrays; takes and returns whole fields.
class Solver {
 public:
  Solver(const Grid &g, const Comm &comm, FftEffort effort = FftEffort::estimate) :
      grid_(g), comm_(comm), stokes_(g, comm, effort)
  {
    for (int d = 0; d < g.dim; ++d) local_[d].resize(stokes_.allocation());
  }

  Field operator()(const Field &f, const StokesProblem &problem)
  {
    FieldView view{};
    for (int d = 0; d < grid_.dim; ++d) {
      std::vector<double> part = slab_part(f, d, stokes_.slab(), stokes_.allocation());
      for (double &v : part)
        if (std::isnan(v)) v = 0.0;
      Access<Backend>::put(part, local_[d]);
      view[d] = local_[d].data();
    }
    stokes_.solve(view, problem);
    Field v(grid_);
    for (int d = 0; d < grid_.dim; ++d)
      add_slab(Access<Backend>::get(local_[d]), d, stokes_.slab(), v);
    if (comm_.size() > 1) sum_over_ranks(v, comm_);
    return v;
  }

 private:
  Grid grid_;
  Comm comm_;
  typename Backend::Stokes stokes_;
  typename Backend::Vector local_[3];
};

/// Grids with even and odd sizes, unequal spacings, only two planes, and fewer planes than ranks.
std::vector<Grid> stokes_grids()
{
  return {make_grid({8, 6, 4}, {0.7}),
          make_grid({5, 7, 9}, {1.0, 0.8, 1.3}),
          make_grid({4, 5, 6}, {1.0, 1.5, 0.5}),
          make_grid({6, 4, 2}, {1.0}),
          make_grid({3, 8, 3}, {0.9}),
          make_grid({140, 5, 3}, {1.0}),
          make_grid({8, 6}, {0.7}),
          make_grid({7, 9}, {1.0, 0.6}),
          make_grid({6, 5}, {0.5, 1.0}),
          make_grid({150, 3}, {1.0, 2.0}),
          make_grid({4, 2}, {1.0})};
}

StokesProblem noise_problem()
{
  StokesProblem p;
  p.viscosity = 1.3;
  p.kT_over_dt = 0.7;
  p.seed = 4711;
  p.step = 12;
  p.stress = {{1.0, 0}};
  return p;
}

StokesProblem quiet(double viscosity = 1.0)
{
  StokesProblem p;
  p.viscosity = viscosity;
  return p;
}

double largest(const Field &f)
{
  double worst = 0.0;
  for (int d = 0; d < f.grid.dim; ++d)
    for (double v : f.c[d]) worst = std::max(worst, std::fabs(v));
  return worst;
}

Field sum(const Field &a, const Field &b, double factor = 1.0)
{
  Field s = a;
  for (int d = 0; d < a.grid.dim; ++d)
    for (std::size_t i = 0; i < s.c[d].size(); ++i) s.c[d][i] += factor * b.c[d][i];
  return s;
}

/// The covariance 2 kT/(eta dt dV) L^-1 as a matrix over all faces, from the stencils:
/// L^-1 = P (-L)^+ P with P = 1 - G (D G)^+ D.
Eigen::MatrixXd noise_covariance(const Grid &g, const StokesProblem &p)
{
  const long cells = g.cells(), faces = g.dim * cells;
  Eigen::MatrixXd D(cells, faces), L(faces, faces);
  for (int d = 0; d < g.dim; ++d)
    for (long c = 0; c < cells; ++c) {
      Field e(g);
      e.c[d][c] = 1.0;
      long row = 0;
      for_cells(g, [&](long i, long j, long k) {
        D(row, d * cells + c) = divergence(e, i, j, k);
        for (int a = 0; a < g.dim; ++a)
          L(a * cells + row, d * cells + c) = laplacian(e, a, i, j, k);
        ++row;
      });
    }
  // Pseudo-inverse of a symmetric semidefinite matrix.  Eigenvalues below 1e-10 of the largest one
  // count as 0.
  auto pseudo_inverse = [](const Eigen::MatrixXd &a) {
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> s(a);
    Eigen::VectorXd inverse = s.eigenvalues();
    const double cut = 1e-10 * inverse.maxCoeff();
    for (double &e : inverse) e = e > cut ? 1.0 / e : 0.0;
    return Eigen::MatrixXd(s.eigenvectors() * inverse.asDiagonal() * s.eigenvectors().transpose());
  };
  const Eigen::MatrixXd P = Eigen::MatrixXd::Identity(faces, faces) -
                            D.transpose() * pseudo_inverse(D * D.transpose()) * D;
  return 2.0 * p.kT_over_dt / (p.viscosity * g.cell_volume()) * P * pseudo_inverse(-L) * P;
}

/// Orthonormal real Fourier basis on the faces, component by component.  Each column is the cosine
/// or the sine of one wave vector.  A wave vector that is its own conjugate has only the cosine.
Eigen::MatrixXd fourier_basis(const Grid &g)
{
  const long cells = g.cells();
  Eigen::MatrixXd one(cells, cells);
  long column = 0;
  for_cells(g, [&](long kx, long ky, long kz) {
    const long cx = wrap(-kx, g.n[0]), cy = wrap(-ky, g.n[1]), cz = wrap(-kz, g.n[2]);
    const long mine = (kz * g.n[1] + ky) * g.n[0] + kx, other = (cz * g.n[1] + cy) * g.n[0] + cx;
    const double shift =
        mine <= other ? 0.0 : -M_PI / 2.0;    // the second column of a pair is the sine
    long row = 0;
    for_cells(g, [&](long i, long j, long k) {
      one(row++, column) =
          std::cos(2.0 * M_PI *
                       (double(kx * i) / double(g.n[0]) + double(ky * j) / double(g.n[1]) +
                        double(kz * k) / double(g.n[2])) +
                   shift);
    });
    one.col(column++).normalize();
  });
  Eigen::MatrixXd basis = Eigen::MatrixXd::Zero(g.dim * cells, g.dim * cells);
  for (int d = 0; d < g.dim; ++d) basis.block(d * cells, d * cells, cells, cells) = one;
  return basis;
}

/// Sample mean of the random velocity on all faces, and its sample covariance about the exact
/// mean, 0.
struct NoiseSample {
  Eigen::MatrixXd covariance;
  Eigen::VectorXd mean;
};

NoiseSample sample_noise(const Grid &g, StokesProblem p, long samples)
{
  const long cells = g.cells(), faces = g.dim * cells, batch = 250;
  Solver solve(g, self());
  const Field none(g);
  NoiseSample s{Eigen::MatrixXd::Zero(faces, faces), Eigen::VectorXd::Zero(faces)};
  Eigen::MatrixXd v(faces, batch);
  for (long n = 0; n < samples; n += batch) {
    for (long b = 0; b < batch; ++b) {
      p.step = n + b;
      const Field f = solve(none, p);
      for (int d = 0; d < g.dim; ++d)
        v.col(b).segment(d * cells, cells) =
            Eigen::Map<const Eigen::VectorXd>(f.c[d].data(), cells);
    }
    s.covariance.noalias() += v * v.transpose();
    s.mean += v.rowwise().sum();
  }
  s.covariance /= samples;
  s.mean /= samples;
  return s;
}

/// Largest deviation of a sample covariance in standard errors, with Var = (C_ii C_jj + C_ij^2)/n
/// for normals.  Entries that vanish identically must vanish in the sample, too.
double largest_deviation(const Eigen::MatrixXd &sample, const Eigen::MatrixXd &expected, double n)
{
  const double scale = expected.diagonal().maxCoeff();
  double worst = 0.0;
  for (long j = 0; j < expected.cols(); ++j)
    for (long i = 0; i <= j; ++i) {
      const double variance = expected(i, i) * expected(j, j) + expected(i, j) * expected(i, j);
      const double deviation = sample(i, j) - expected(i, j);
      if (variance > 1e-20 * scale * scale)
        worst = std::max(worst, std::fabs(deviation) / std::sqrt(variance / n));
      else
        EXPECT_NEAR(deviation, 0.0, 1e-10 * scale) << i << " " << j;
    }
  return worst;
}

}    // namespace

// D v = 0; eta L v + f is a discrete gradient, up to a constant (the mean pressure gradient that
// balances the net force); and the mean of v is 0.  Round-off is 1e-16 of the terms that cancel,
// the largest of which are 12 v eta/h^2.  v itself is accurate to about 1e-15 of its largest value.
TEST(TypedStokes, SolvesTheDiscreteEquations)
{
  for (const Grid &g : stokes_grids()) {
    SCOPED_TRACE(name_of(g));
    const double eta = 1.7;
    const Field f = random_field(g, 1);
    Solver solve(g, world());
    const Field v = solve(f, quiet(eta));
    double h = g.h(0);
    for (int d = 1; d < g.dim; ++d) h = std::min(h, g.h(d));
    EXPECT_LT(largest_divergence(v), 1e-14 * largest(v) / h);
    Field r = f;
    for (int d = 0; d < g.dim; ++d) {
      double mean = 0.0;
      for_cells(g, [&](long i, long j, long k) {
        r.at(d, i, j, k) += eta * laplacian(v, d, i, j, k);
        mean += v.at(d, i, j, k) / g.cells();
      });
      EXPECT_NEAR(mean, 0.0, 1e-15 * largest(v));
    }
    const double scale = (largest(f) + 12.0 * eta * largest(v) / (h * h)) / h;
    for (int a = 0; a < g.dim; ++a)
      for (int b = 0; b < a; ++b)
        for_cells(g, [&](long i, long j, long k) {
          EXPECT_NEAR(curl(r, a, b, i, j, k), 0.0, 2e-14 * scale);
        });
    EXPECT_GT(v.norm(), 0.0);
  }
}

// Gradients and constants cause no flow, since the pressure balances them.
TEST(TypedStokes, GradientsAndConstantsDriveNothing)
{
  for (const Grid &g : stokes_grids()) {
    const Field p = random_field(g, 2);
    Field f(g);
    for (int d = 0; d < g.dim; ++d)
      for_cells(g, [&](long i, long j, long k) {
        f.at(d, i, j, k) =
            0.3 * (d + 1) + (p.at(0, i, j, k) - p.at(0, i - step_along(d, 0), j - step_along(d, 1),
                                                     k - step_along(d, 2))) /
                                g.h(d);
      });
    double length = 0.0;
    for (int d = 0; d < g.dim; ++d) length = std::max(length, g.length[d]);
    Solver solve(g, world());
    // The round-off of f is amplified by 1/lambda of the longest wave.
    EXPECT_LT(largest(solve(f, quiet())), 1e-14 * largest(f) * length * length) << name_of(g);
  }
}

TEST(TypedStokes, IsLinearAndInverselyProportionalToViscosity)
{
  const Grid g = make_grid({6, 5, 4}, {0.7});
  const Field a = random_field(g, 3), b = random_field(g, 4);
  Solver solve(g, world());
  const Field va = solve(a, quiet()), vb = solve(b, quiet()), vs = solve(sum(a, b, -2.5), quiet());
  EXPECT_LT(distance(vs, sum(va, vb, -2.5)), 1e-14 * va.norm());
  Field quarter = solve(a, quiet(4.0));
  for (int d = 0; d < 3; ++d)
    for (double &v : quarter.c[d]) v *= 4.0;
  EXPECT_LT(distance(quarter, va), 1e-15 * va.norm());
}

// The random velocity is divergence-free, has zero mean, and is added to the response to f.
TEST(TypedStokes, NoiseIsDivergenceFreeAndAddsToTheResponse)
{
  for (const Grid &g : stokes_grids()) {
    SCOPED_TRACE(name_of(g));
    const Field f = random_field(g, 5), none(g);
    const StokesProblem p = noise_problem();
    Solver solve(g, world());
    const Field noise = solve(none, p), response = solve(f, quiet(p.viscosity)), both = solve(f, p);
    EXPECT_GT(noise.norm(), 0.0);
    double h = g.h(0);
    for (int d = 1; d < g.dim; ++d) h = std::min(h, g.h(d));
    EXPECT_LT(largest_divergence(noise), 1e-14 * largest(noise) / h);
    for (int d = 0; d < g.dim; ++d) {
      double mean = 0.0;
      for (double v : noise.c[d]) mean += v / g.cells();
      EXPECT_NEAR(mean, 0.0, 1e-15 * largest(noise));
    }
    EXPECT_LT(distance(both, sum(noise, response)), 1e-14 * (noise.norm() + response.norm()));
  }
}

// Weighted draws add up (the two half steps of the improved midpoint scheme), stages differ, and
// amplitudes scale with sqrt(kT/(dt eta)).
TEST(TypedStokes, DrawsAddUpAndScale)
{
  for (const Grid &g : {make_grid({6, 5, 4}, {0.7}), make_grid({6, 4}, {0.7})}) {
    const Field none(g);
    Solver solve(g, world());
    StokesProblem p = noise_problem();
    const Field first = solve(none, p);
    p.stress = {{1.0, 1}};
    const Field second = solve(none, p);
    EXPECT_GT(distance(first, second), 0.5 * first.norm());
    p.stress = {{0.3, 0}, {-2.0, 1}};
    Field expected(g);
    expected = sum(sum(expected, first, 0.3), second, -2.0);
    EXPECT_LT(distance(solve(none, p), expected), 1e-14 * expected.norm());
    p.stress = {{1.0, 0}};
    p.kT_over_dt *= 4.0;
    p.viscosity *= 16.0;
    EXPECT_LT(distance(solve(none, p), sum(Field(g), first, 0.5)), 1e-14 * first.norm());
    p.kT_over_dt = 0.0;
    EXPECT_EQ(solve(none, p).norm(), 0.0);
    p = noise_problem();
    p.stress.clear();
    EXPECT_EQ(solve(none, p).norm(), 0.0);
  }
}

// The result does not depend on the number of ranks, apart from the order of summation in the
// transforms.
TEST(TypedStokes, DoesNotDependOnTheNumberOfRanks)
{
  for (const Grid &g : stokes_grids())
    for (FftEffort effort : {FftEffort::estimate, FftEffort::measure}) {
      const Field f = random_field(g, 6);
      Solver together(g, world(), effort), alone(g, self());
      const Field expected = alone(f, noise_problem());
      EXPECT_LT(distance(together(f, noise_problem()), expected), 1e-14 * expected.norm())
          << name_of(g);
    }
}

// The covariance of the velocities on all faces is 2 kT/(eta dt dV) L^-1, entry by entry, in real
// space and mode by mode.  The second comparison isolates modes that are their own conjugates or
// belong to a stored conjugate pair.  There are about 60 000 independent normals, with
// P(|z| > 6.5) = 8e-11 each, 1e-5 in all.  The sum of squares of the whitened samples detects an
// error of 0.1 % in the amplitude: z < 5, 6e-7 each.
class StatisticsStokesNoise : public testing::TestWithParam<std::vector<long>> {};

TEST_P(StatisticsStokesNoise, CovarianceIsTheInverseStokesOperator)
{
  const long samples = 100000;
  const Grid g = GetParam().size() == 3 ? make_grid(GetParam(), {1.0, 0.8, 1.3})
                                        : make_grid(GetParam(), {1.0, 0.7});
  const StokesProblem p = noise_problem();
  const Eigen::MatrixXd expected = noise_covariance(g, p), basis = fourier_basis(g);
  const NoiseSample sample = sample_noise(g, p, samples);
  const double n = samples;

  EXPECT_LT(largest_deviation(sample.covariance, expected, n), 6.5) << "real space";
  const Eigen::MatrixXd modes = basis.transpose() * sample.covariance * basis;
  EXPECT_LT(largest_deviation(modes, basis.transpose() * expected * basis, n), 6.5)
      << "Fourier modes";

  for (long i = 0; i < sample.mean.size(); ++i)
    EXPECT_LT(std::fabs(sample.mean[i]) / std::sqrt(expected(i, i) / n), 6.0) << "mean at " << i;

  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(expected);
  double squares = 0.0, rank = 0.0;
  for (long i = 0; i < expected.rows(); ++i) {
    const Eigen::VectorXd e = solver.eigenvectors().col(i);
    const double variance = e.dot(sample.covariance * e), largest = solver.eigenvalues().maxCoeff();
    if (solver.eigenvalues()[i] > 1e-10 * largest) {
      squares += variance / solver.eigenvalues()[i];
      rank += 1.0;
    } else {
      EXPECT_NEAR(variance, 0.0, 1e-13 * largest) << "a direction without fluctuations";
    }
  }
  // There is one solenoidal direction per wave vector in 2D, two in 3D, and none at k = 0.
  EXPECT_EQ(rank, (g.dim - 1) * (g.cells() - 1));
  EXPECT_LT(std::fabs(squares - rank) / std::sqrt(2.0 * rank / n), 5.0)
      << "sum of squares " << squares / rank;
}

INSTANTIATE_TEST_SUITE_P(Grids, StatisticsStokesNoise,
                         testing::Values(std::vector<long>{4, 4, 4}, std::vector<long>{5, 4, 3},
                                         std::vector<long>{4, 3, 2}, std::vector<long>{4, 6},
                                         std::vector<long>{5, 4}, std::vector<long>{3, 5}),
                         [](const testing::TestParamInfo<std::vector<long>> &info) {
                           std::string s;
                           for (long n : info.param)
                             s += (s.empty() ? "" : "x") + std::to_string(n);
                           return s;
                         });

// Each of the eight (in 2D four) wave vectors that are their own conjugates: all variance is in the
// real part, and it is 2 kT/(eta dt dV) / lambda along each direction normal to s.  z < 5, 6e-7 for
// each of 7 * 9 + 3 * 4 entries.
TEST(StatisticsStokesSelfConjugateModes, HaveTheFullVarianceInTheRealPart)
{
  const long samples = 100000;
  for (const Grid &g : {make_grid({4, 2, 6}, {1.0, 0.8, 1.3}), make_grid({6, 4}, {1.0, 0.7})}) {
    const StokesProblem problem = noise_problem();
    Solver solve(g, self());
    const Field none(g);
    const long corners = g.dim == 3 ? 8 : 4;
    std::vector<Eigen::Matrix3d> sum(corners, Eigen::Matrix3d::Zero());
    StokesProblem p = problem;
    for (long s = 0; s < samples; ++s) {
      p.step = s;
      const Field v = solve(none, p);
      for (long c = 1; c < corners; ++c) {
        Eigen::Vector3d mode = Eigen::Vector3d::Zero();
        for (int d = 0; d < g.dim; ++d)
          for_cells(g, [&](long i, long j, long k) {
            const long sign = (c & 1 ? i : 0) + (c & 2 ? j : 0) + (c & 4 ? k : 0);
            mode[d] += sign % 2 ? -v.at(d, i, j, k) : v.at(d, i, j, k);
          });
        sum[c] += mode * mode.transpose();
      }
    }
    for (long c = 1; c < corners; ++c) {
      Eigen::Vector3d s = Eigen::Vector3d::Zero();
      for (int d = 0; d < g.dim; ++d) s[d] = c >> d & 1 ? 2.0 / g.h(d) : 0.0;
      Eigen::Matrix3d identity = Eigen::Matrix3d::Identity();
      if (g.dim == 2) identity(2, 2) = 0.0;
      const double scale =
          2.0 * problem.kT_over_dt / (problem.viscosity * g.cell_volume()) * double(g.cells());
      const Eigen::Matrix3d expected =
          scale / s.squaredNorm() * (identity - s * s.transpose() / s.squaredNorm());
      EXPECT_LT(largest_deviation(sum[c] / double(samples), expected, double(samples)), 5.0)
          << name_of(g) << " " << c;
    }
  }
}

// Draws of different steps, stages and seeds are independent: the whitened inner product of each
// pair is N(0, rank), and z < 5.5.
TEST(StatisticsStokesDraws, StepsStagesAndSeedsAreIndependent)
{
  const Grid g = make_grid({4, 4, 4}, {1.0});
  const Eigen::MatrixXd covariance = noise_covariance(g, noise_problem());
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> s(covariance);
  Eigen::MatrixXd whiten(covariance.rows(), 0);
  for (long i = 0; i < covariance.rows(); ++i)
    if (s.eigenvalues()[i] > 1e-10 * s.eigenvalues().maxCoeff()) {
      whiten.conservativeResize(Eigen::NoChange, whiten.cols() + 1);
      whiten.rightCols(1) = s.eigenvectors().col(i) / std::sqrt(s.eigenvalues()[i]);
    }
  Solver solve(g, self());
  const Field none(g);
  auto draw = [&](uint32_t seed, uint64_t step, uint32_t stage) {
    StokesProblem p = noise_problem();
    p.seed = seed;
    p.step = step;
    p.stress = {{1.0, stage}};
    const Field v = solve(none, p);
    Eigen::VectorXd all(3 * g.cells());
    for (int d = 0; d < 3; ++d)
      all.segment(d * g.cells(), g.cells()) =
          Eigen::Map<const Eigen::VectorXd>(v.c[d].data(), g.cells());
    return Eigen::VectorXd(whiten.transpose() * all);
  };
  const long samples = 5000;
  double product[4] = {};
  for (long i = 0; i < samples; ++i) {
    const uint64_t step = i;
    const Eigen::VectorXd base = draw(7, step, 0);
    product[0] += base.dot(draw(7, step + 1, 0));
    product[1] += base.dot(draw(7, step, 1));
    product[2] += base.dot(draw(8, step, 0));
    product[3] += base.dot(draw(8, step + 1, 0));
  }
  for (double q : product)
    EXPECT_LT(std::fabs(q) / std::sqrt(double(samples * whiten.cols())), 5.5);
}

// Every mode has its own draw, also where a long row of modes passes through the cache in several
// blocks.  The test correlates the modes k_x and k_x + shift over all k_x, k_y, k_z of one
// component, for every shift.  |sum|^2/n of n complex products is exponential with mean 1.  It
// exceeds 25 by chance with probability 1.4e-11, or 1e-8 for all 3 * 193 sums.  A block that
// repeats another one reaches thousands.
TEST(StatisticsStokesDraws, ModesAlongALongRowAreIndependent)
{
  const Grid g = make_grid({390, 2, 120}, {1.0});
  const Field v = Solver(g, self())(Field(g), noise_problem());
  VectorFft<double> fft(g, self(), FftEffort::estimate);
  AlignedVector local[3];
  std::array<double *, 3> view{};
  for (int d = 0; d < 3; ++d) {
    const std::vector<double> part = slab_part(v, d, fft.slab(), fft.allocation());
    local[d].assign(part.begin(), part.end());
    view[d] = local[d].data();
  }
  // Only inner columns count.  Mode m of a row (k_y, k_z) is in units of its standard deviation.
  const long inner = g.n[0] / 2, rows = g.n[1] * g.n[2];
  std::vector<std::complex<double>> modes[3];
  for (auto &m : modes) m.assign(inner * rows, 0.0);
  fft.solve(view, [&](const ModeBlock<double> &b) {
    for (long row = 0; row < b.rows; ++row)
      for (long column = 0; column < b.columns; ++column) {
        const long kx = b.first_x + column;
        if (kx == 0 || kx >= inner) continue;
        const double s[3] = {2.0 * std::sin(M_PI * double(kx) / double(g.n[0])),
                             2.0 * std::sin(M_PI * double(b.y) / double(g.n[1])),
                             2.0 * std::sin(M_PI * double(row) / double(g.n[2]))};
        const double lambda = s[0] * s[0] + s[1] * s[1] + s[2] * s[2];
        for (int d = 0; d < 3; ++d) {
          const double *f = b.f[d] + 2 * (row * b.columns + column);
          const double variance = (1.0 - s[d] * s[d] / lambda) / lambda;
          if (variance > 1e-8)
            modes[d][(row * g.n[1] + b.y) * inner + kx] =
                std::complex<double>(f[0], f[1]) / std::sqrt(variance);
        }
      }
  });
  for (int d = 0; d < 3; ++d) {
    double power = 0.0, count = 0.0;
    for (const auto &m : modes[d]) {
      power += std::norm(m);
      count += m != 0.0;
    }
    for (long shift = 1; shift < inner - 1; ++shift) {
      std::complex<double> sum = 0.0;
      double n = 0.0;
      for (long r = 0; r < rows; ++r)
        for (long kx = 1; kx + shift < inner; ++kx) {
          sum += modes[d][r * inner + kx] * std::conj(modes[d][r * inner + kx + shift]);
          n += 1.0;
        }
      EXPECT_LT(std::norm(sum) / n / std::pow(power / count, 2), 25.0)
          << "component " << d << " shift " << shift;
    }
  }
}
