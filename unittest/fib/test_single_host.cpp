// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// A grid in single precision: how far its mobility and its noise are from those in double, which
// the other tests compare with references, and the laws that must hold to its round-off.

#include "fib/fluid.h"
#include "support/test_support.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

using namespace bdh;
using namespace bdh_test;

namespace {

constexpr IbKernel kernels[] = {IbKernel::roma3, IbKernel::peskin4, IbKernel::bkp6};

Grid slit(std::vector<long> n, Boundary lower, Boundary upper)
{
  Grid g = make_grid(n, {1.0}, 0.0);
  g.boundary[g.slow_axis()] = {lower, upper};
  return g;
}

/// Without and with walls and open faces, in both dimensions; a tall slit, where the factorisation
/// across the channel is worst conditioned, and a large box.
std::vector<Grid> grids(IbKernel kernel)
{
  const long beyond = rows_beyond(kernel);
  const auto noslip = Boundary::noslip, slip = Boundary::slip, open = Boundary::open;
  return {make_grid({16, 12, 10}, {1.0}, 0.0),
          make_grid({64, 64, 64}, {1.0}, 0.0),
          make_grid({15, 14}, {1.0}, 0.0),
          slit({16, 12, 9}, noslip, noslip),
          slit({8, 8, 512}, noslip, noslip),
          slit({12, 10, 16}, slip, noslip),
          slit({12, 10, 16}, slip, slip),
          slit({16, 15}, noslip, noslip),
          beyond_open_faces(slit({12, 10, 16}, noslip, open), beyond),
          beyond_open_faces(slit({12, 10, 16}, open, open), beyond)};
}

std::string name(const Grid &g)
{
  const auto &b = g.boundary[g.slow_axis()];
  return name_of(g) + " pnso"[1 + int(b[0])] + "pnso"[int(b[1])];
}

/// Ten particles of which two nearly touch.
std::vector<double> positions(const Grid &g, unsigned seed)
{
  Grid box = g;
  for (int d = 0; d < 3; ++d) {
    box.lo[d] = g.box_lo(d);
    box.length[d] = g.box_hi(d) - g.box_lo(d);
  }
  std::vector<double> x = random_positions(box, 10, seed);
  for (int d = 0; d < 3; ++d) x[3 + d] = 0.98 * x[d] + 0.02 * (box.lo[d] + 0.5 * box.length[d]);
  return x;
}

/// Velocities J (L^-1 (S F + kT div S)/eta + noise), or with noise alone.
template <class Real> class Flow {
 public:
  Flow(const Grid &g, IbKernel kernel, const std::vector<double> &x) :
      fluid_(g, kernel, FftEffort::estimate, self()), n_(x.size() / 3)
  {
    fluid_.bind(x.data(), n_);
  }
  std::vector<double> operator()(const std::vector<double> &force, double kT,
                                 const StokesProblem &problem)
  {
    fluid_.clear();
    fluid_.spread(force.data(), kT);
    fluid_.solve(problem);
    std::vector<double> u(3 * n_);
    fluid_.interpolate(u.data());
    return u;
  }
  SolveReport report() const { return fluid_.report(); }
  FibFluid<FibOnHostIn<Real>> &fluid() { return fluid_; }

 private:
  FibFluid<FibOnHostIn<Real>> fluid_;
  long n_;
};

StokesProblem quiet()
{
  StokesProblem p;
  p.viscosity = 1.3;
  return p;
}

StokesProblem noisy()
{
  StokesProblem p = quiet();
  p.kT_over_dt = 0.7;
  p.seed = 4711;
  p.step = 12;
  p.stress = {{1.0, 0}, {0.5, 1}};
  return p;
}

std::vector<double> unit(std::size_t size, std::size_t at)
{
  std::vector<double> v(size, 0.0);
  v[at] = 1.0;
  return v;
}

double largest_difference(const std::vector<double> &a, const std::vector<double> &b)
{
  double most = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::fabs(a[i] - b[i]));
  return most;
}

double dot(const std::vector<double> &a, const std::vector<double> &b)
{
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

/// The largest error of an entry of M, and of M - M^T, relative to the largest diagonal entry.
struct MatrixErrors {
  double entry, asymmetry;
};

MatrixErrors matrix_errors(const Grid &g, IbKernel kernel)
{
  const std::vector<double> x = positions(g, 5);
  Flow<float> single(g, kernel, x);
  Flow<double> precise(g, kernel, x);
  std::vector<std::vector<double>> M;
  double diagonal = 0.0, error = 0.0, asymmetry = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const std::vector<double> e = unit(x.size(), i), expected = precise(e, 0.0, quiet());
    M.push_back(single(e, 0.0, quiet()));
    diagonal = std::max(diagonal, expected[i]);
    error = std::max(error, largest_difference(M[i], expected));
  }
  for (std::size_t i = 0; i < x.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      asymmetry = std::max(asymmetry, std::fabs(M[i][j] - M[j][i]));
  return {error / diagonal, asymmetry / diagonal};
}

}    // namespace

// The bound is what single_round_off states.  An entry of M is a sum over W^6 products, in which
// round-off of 6e-8 averages out.
TEST(SingleMobility, ErrorIsBelowTheRoundOffThatIsStated)
{
  double all = 0.0;
  for (const IbKernel kernel : kernels) {
    double most = 0.0;
    for (const Grid &g : grids(kernel)) {
      const MatrixErrors e = matrix_errors(g, kernel);
      EXPECT_GT(e.entry, 1e-9) << "is this single precision?";
      EXPECT_LT(e.entry, single_round_off) << name(g) << " " << kernel_name(kernel);
      EXPECT_LT(e.asymmetry, single_round_off) << name(g) << " " << kernel_name(kernel);
      most = std::max({most, e.entry, e.asymmetry});
    }
    RecordProperty(kernel_name(kernel), std::to_string(1e9 * most) + "e-9");
    all = std::max(all, most);
  }
  EXPECT_GT(all, 0.1 * single_round_off) << "the constant should be near the largest error";
}

// The same random numbers: fluctuation and dissipation balance as in double.  The bound is that of
// M; velocities are sums over many modes, each of whose normals is rounded by up to 4e-7.
TEST(SingleNoise, IsThatOfDoubleToRoundOff)
{
  for (const IbKernel kernel : kernels)
    for (const Grid &g : grids(kernel)) {
      const std::vector<double> x = positions(g, 6), none(x.size(), 0.0);
      Flow<float> single(g, kernel, x);
      Flow<double> precise(g, kernel, x);
      const std::vector<double> u = single(none, 0.0, noisy()),
                                expected = precise(none, 0.0, noisy());
      EXPECT_GT(norm(expected), 0.0);
      EXPECT_LT(difference(u, expected), 2e-6 * norm(expected)) << name(g) << kernel_name(kernel);
    }
}

// In a step all parts act together.  The thermal drift is of the size of the forces here.
TEST(SingleMobility, ForcesDriftAndNoiseTogether)
{
  for (const Grid &g : grids(IbKernel::peskin4)) {
    const std::vector<double> x = positions(g, 7), force = random_numbers(x.size(), 8);
    Flow<float> single(g, IbKernel::peskin4, x);
    Flow<double> precise(g, IbKernel::peskin4, x);
    const std::vector<double> u = single(force, 0.7, noisy()),
                              expected = precise(force, 0.7, noisy());
    EXPECT_LT(difference(u, expected), 2e-6 * norm(expected)) << name(g);
  }
}

// sum F_i . (J v)_i = dV sum v . (S F): the same rounded weights serve both.
TEST(SingleMobility, IsSymmetricForManyParticles)
{
  for (const Grid &g : grids(IbKernel::bkp6)) {
    const std::vector<double> x = positions(g, 9), a = random_numbers(x.size(), 10),
                              b = random_numbers(x.size(), 11);
    Flow<float> flow(g, IbKernel::bkp6, x);
    const std::vector<double> Ma = flow(a, 0.0, quiet()), Mb = flow(b, 0.0, quiet());
    EXPECT_NEAR(dot(a, Mb), dot(b, Ma), 1e-6 * norm(a) * norm(Mb)) << name(g);
  }
}

// In a periodic box the mean velocity is zero, in each component, with noise too.
TEST(SingleMobility, MeanVelocityIsZeroInPeriodicBoxes)
{
  const Grid g = make_grid({16, 12, 10}, {1.0}, 0.0);
  const std::vector<double> x = positions(g, 12), force(x.size(), 1.0);
  Flow<float> flow(g, IbKernel::peskin4, x);
  flow(force, 0.0, noisy());
  Field v(g);
  for (int d = 0; d < 3; ++d) {
    const auto &c = flow.fluid().component(d);
    add_slab(std::vector<double>(c.begin(), c.end()), d, flow.fluid().slab(), v);
    double sum = 0.0, most = 0.0;
    for (const double u : v.c[d]) {
      sum += u;
      most = std::max(most, std::fabs(u));
    }
    EXPECT_GT(most, 0.0);
    EXPECT_LT(std::fabs(sum / g.cells()), 1e-7 * most);
  }
}

TEST(SingleMobility, ForcesOnWallsAreThoseOfDouble)
{
  const Grid g = slit({16, 12, 9}, Boundary::noslip, Boundary::noslip);
  const std::vector<double> x = positions(g, 13), force = random_numbers(x.size(), 14);
  Flow<float> single(g, IbKernel::peskin4, x);
  Flow<double> precise(g, IbKernel::peskin4, x);
  single(force, 0.0, quiet());
  precise(force, 0.0, quiet());
  for (std::size_t side = 0; side < 2; ++side)
    for (std::size_t d = 0; d < 3; ++d) {
      const double expected = precise.report().wall_force[2][side][d];
      EXPECT_NE(expected, 0.0);
      EXPECT_NEAR(single.report().wall_force[2][side][d], expected, 1e-6 * norm(force));
    }
}
