// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// The RPY mobility of equal spheres: the split pair functions, their table, and the dense periodic
// matrix.

#include "base/constants.h"
#include "base/errors.h"
#include "base/ssize.h"
#include "oracle/dense_rpy.h"
#include "pse/rpy.h"
#include "support/reference_json.h"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <random>
#include <sstream>
#include <string>
#include <vector>

namespace {

using namespace bdh;
using bdh_test::cell_of;
using bdh_test::flatten;
using bdh_test::json_reference;
using Json = nlohmann::json;

double free_mobility(double a, double eta) { return 1.0 / (6.0 * pi * eta * a); }

std::ifstream open_reference(const std::string &file)
{
  std::ifstream in(std::string(BDH_REFERENCE_DIR) + "/" + file);
  if (!in) throw std::runtime_error("cannot read " + file);
  return in;
}

/// Rows of a file with comments (#) and one line of names.  The entries are returned as text.
std::vector<std::vector<std::string>> csv_reference(const std::string &file)
{
  auto in = open_reference(file);
  std::vector<std::vector<std::string>> rows;
  std::string line, cell;
  for (bool names = true; std::getline(in, line);) {
    if (line.empty() || line[0] == '#') continue;
    if (!names) {
      rows.emplace_back();
      std::istringstream cells(line);
      while (std::getline(cells, cell, ',')) rows.back().push_back(cell);
    }
    names = false;
  }
  return rows;
}

Cell cube(double L)
{
  Cell c;
  c.lx = c.ly = c.lz = L;
  return c;
}

/// The corner is not at 0, so that a forgotten origin shows.
Cell tilted_cell()
{
  Cell c;
  c.lo[0] = -1.3;
  c.lo[1] = 0.4;
  c.lo[2] = 2.0;
  c.lx = 6.1;
  c.ly = 5.2;
  c.lz = 7.3;
  c.xy = -2.0;
  c.xz = 1.7;
  c.yz = 2.4;
  return c;
}

Cell elongated_cell()
{
  Cell c = cube(4.0);
  c.lx = 21.0;
  return c;
}

using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
Eigen::Map<const Matrix> matrix(const std::vector<double> &m, long n)
{
  return {m.data(), 3 * n, 3 * n};
}
Eigen::Map<const Eigen::VectorXd> column(const std::vector<double> &v)
{
  return {v.data(), bdh::ssize(v)};
}

/// Positions scattered over the cell and its neighbours, or over a cube of side 3 if `clustered`.
std::vector<double> positions(const Cell &cell, long n, unsigned seed, bool clustered)
{
  std::mt19937_64 engine(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 2.0);
  std::vector<double> x;
  for (long i = 0; i < n; ++i) {
    double r[3], s[3];
    for (double &v : s) v = clustered ? 0.3 : uniform(engine);
    cell.lattice_vector(s, r);
    for (int d = 0; d < 3; ++d)
      x.push_back(cell.lo[d] + r[d] + (clustered ? uniform(engine) : 0.0));
  }
  return x;
}

/// Columns of pse_FG.csv.  The error of the reference is up to 1e-14, that of this code 1.1e-15.
TEST(RealSpacePair, ReferenceTable)
{
  const auto rows = csv_reference("pse_FG.csv");
  ASSERT_EQ(rows.size(), 56u);
  for (const auto &row : rows) {
    const double xi = std::stod(row[0]), r = std::stod(row[1]), a = 1.7;
    const RpyPair m = real_space_exact(r * a, a, xi / a);
    EXPECT_NEAR(m.transverse, std::stod(row[2]), 1.1e-14) << "xi " << xi << " r " << r;
    EXPECT_NEAR(m.longitudinal, std::stod(row[3]), 1.1e-14) << "xi " << xi << " r " << r;
  }
}

// All digits of the reference are right.  Tails are summed and integrated, hence the relative
// error.
TEST(RealSpacePair, ReferenceForSmallAndLargeSplittings)
{
  const auto rows = csv_reference("pse_FG_xi.csv");
  ASSERT_EQ(rows.size(), 60u);
  for (const auto &row : rows) {
    const double xi = std::stod(row[0]), r = std::stod(row[1]), f = std::stod(row[2]),
                 g = std::stod(row[3]);
    const RpyPair m = real_space_exact(r, 1.0, xi);
    EXPECT_NEAR(m.transverse, f, 1.1e-15) << "xi " << xi << " r " << r;
    EXPECT_NEAR(m.longitudinal, g, 1.1e-15) << "xi " << xi << " r " << r;
    if (xi * (r - 2.0) < 2.0) continue;
    EXPECT_NEAR(m.transverse, f, 5e-9 * std::fabs(f)) << "xi " << xi << " r " << r;
    EXPECT_NEAR(m.longitudinal, g, 5e-9 * std::fabs(g)) << "xi " << xi << " r " << r;
  }
}

// Two independent ways, the closed form and quadrature, agree where the closed form does not
// cancel. The bound is 1e-15 times its largest terms, 3/(128 (xi a)^4 (r/a)^3).
TEST(RealSpacePair, ClosedFormAgrees)
{
  for (double xi : {0.1, 0.3, 0.7, 1.5, 5.0})
    for (double r = 0.5; r < 2.0 + 4.0 / xi; r += 0.173) {
      const RpyPair exact = real_space_exact(r, 1.0, xi), closed = real_space_closed_form(r, xi);
      const double bound = 4e-15 * (1.0 + r + 1.0 / (std::pow(xi, 4) * r * r * r));
      EXPECT_NEAR(exact.transverse, closed.transverse, bound) << xi << " " << r;
      EXPECT_NEAR(exact.longitudinal, closed.longitudinal, bound) << xi << " " << r;
    }
}

TEST(RealSpacePair, SelfTermIsTheLimit)
{
  for (double xi : {0.005, 0.02, 0.1, 0.5, 1.0, 3.0, 5.0}) {
    const double self = real_space_self(xi);
    // The slopes at 0 are those of free space: -9/32 and -6/32 per radius.
    for (double r : {0.0, 1e-12, 1e-9}) {
      const RpyPair m = real_space_exact(r, 1.0, xi);
      EXPECT_NEAR(m.transverse, self - 9.0 / 32.0 * r, 2e-15) << xi;
      EXPECT_NEAR(m.longitudinal, self - 6.0 / 32.0 * r, 2e-15) << xi;
    }
  }
}

TEST(RealSpacePair, ContinuousAtContact)
{
  const double step = 1e-9;
  for (double xi : {0.02, 0.1, 0.5, 1.0, 3.0, 5.0}) {
    const RpyPair below = real_space_exact(2.0 - step, 1.0, xi),
                  above = real_space_exact(2.0 + step, 1.0, xi);
    const double slope = 2.0 + 4.0 * xi;    // a generous bound for both functions
    EXPECT_NEAR(below.transverse, above.transverse, slope * step);
    EXPECT_NEAR(below.longitudinal, above.longitudinal, slope * step);
  }
  EXPECT_NEAR(free_space_rpy(2.0).transverse, free_space_rpy(2.0 + 1e-15).transverse, 1e-15);
  EXPECT_NEAR(free_space_rpy(2.0).longitudinal, free_space_rpy(2.0 + 1e-15).longitudinal, 1e-15);
}

// xi -> 0 leaves everything in real space; the difference is of order xi a.
TEST(RealSpacePair, FreeSpaceWithoutSplitting)
{
  for (double r : {0.0, 0.3, 1.0, 1.9, 2.1, 5.0}) {
    const RpyPair m = real_space_exact(r, 1.0, 1e-9), whole = free_space_rpy(r);
    EXPECT_NEAR(m.transverse, whole.transverse, 1e-8);
    EXPECT_NEAR(m.longitudinal, whole.longitudinal, 1e-8);
  }
}

// Parameters are chosen from the tails, which therefore must not end in noise.
TEST(RealSpacePair, TailDecays)
{
  for (double xi : {1e-5, 1e-3, 4.9e-3, 5.1e-3, 0.02, 0.1, 0.5, 1.0, 3.0, 5.0}) {
    double last = 1.0;
    for (double y = 3.0; y < 20.0; y += 0.25) {
      const RpyPair m = real_space_exact(2.0 + y / xi, 1.0, xi);
      const double size = std::fabs(m.transverse) + std::fabs(m.longitudinal);
      EXPECT_GT(size, 0.0);
      EXPECT_LT(size, 0.5 * last) << xi << " " << y;
      EXPECT_LT(size, 3.0 * std::exp(-y * y) * (1.0 + y));
      last = size;
    }
  }
}

// The weights agree with those of spheres to order k^2, whatever the cutoffs, and end at k_cut.
TEST(KaiserBesselSplit, StartsLikeSpheres)
{
  const double radius = 1.3;
  for (double reach : {3.0, 8.0, 15.0, 40.0})
    for (double k_cut : {0.001, 0.5, 3.0}) {
      const KaiserBesselSplit split = kaiser_bessel_split(k_cut, reach / k_cut, radius);
      EXPECT_NEAR(split.weight(0.0), 1.0, 1e-14);
      EXPECT_NEAR(split.shape(1.0, split.beta), split.beta / std::sinh(split.beta), 1e-15);
      const double k = 1e-3 * k_cut, own = (1.0 - split.weight(k)) / (k * k),
                   sphere = radius * radius / 3.0;
      EXPECT_NEAR(own, sphere, 1e-5 * (sphere + reach / (k_cut * k_cut))) << reach << " " << k_cut;
      double last = 2.0;
      for (double t = 0.0; t <= 1.0; t += 0.01) {
        const double chi = split.shape(t, split.beta), s = split.beta * std::sqrt(1.0 - t * t);
        const double exact =
            (s > 0.0 ? std::sinh(s) / s : 1.0) / std::sinh(split.beta) * split.beta;
        EXPECT_NEAR(chi, exact, 1e-14);
        EXPECT_LT(chi, last);
        last = chi;
      }
    }
}

// Beyond the cutoff nothing is left of the pair, but for what a window of k_cut r_cut leaves.
TEST(KaiserBesselSplit, NearPartEndsAtTheCutoff)
{
  const double radius = 1.3;
  for (double reach : {10.0, 20.0, 36.0})
    for (double r_cut : {4.0 * radius, 9.0 * radius, 1000.0 * radius}) {
      const KaiserBesselSplit split = kaiser_bessel_split(reach / r_cut, r_cut, radius);
      const RealSpacePart part(radius, split, r_cut);
      const double left = 40.0 * std::exp(-reach);
      for (double r = r_cut; r < 2.0 * r_cut; r += 0.03 * r_cut) {
        const RpyPair m = part(r);
        EXPECT_LE(std::fabs(m.transverse), left * radius / r_cut + 5e-15) << reach << " " << r;
        EXPECT_LE(std::fabs(m.longitudinal), left * radius / r_cut + 5e-15) << reach << " " << r;
      }
      // It is still there within it.
      EXPECT_GT(std::fabs(part(0.5 * r_cut).longitudinal), 10.0 * left * radius / r_cut) << reach;
    }
}

// The self term is 1 - 2/pi int W dk.
TEST(KaiserBesselSplit, SelfTerm)
{
  const double radius = 1.3, r_cut = 5.0 * radius;
  const KaiserBesselSplit split = kaiser_bessel_split(11.0 / r_cut, r_cut, radius);
  const RealSpacePart part(radius, split, r_cut);
  constexpr int steps = 4000;
  double sum = 0.0;
  for (int i = 0; i < steps; ++i) sum += split.weight(split.k_cut * (i + 0.5) / steps);
  EXPECT_NEAR(part.self(), 1.0 - 2.0 / bdh::pi * radius * split.k_cut * sum / steps, 1e-8);
  const RpyPair close = part(1e-9);
  EXPECT_NEAR(close.transverse, part.self(), 1e-9);
  EXPECT_NEAR(close.longitudinal, part.self(), 1e-9);
}

// The table of either splitting is used in the same way.
TEST(KaiserBesselSplit, Table)
{
  const double radius = 1.3, r_cut = 5.0 * radius, error = 1e-9;
  const RealSpacePart part(radius, kaiser_bessel_split(14.0 / r_cut, r_cut, radius), r_cut);
  const RealSpaceTable<double> table(part, r_cut, error);
  for (double r = 0.0; r <= r_cut; r += 0.00137 * r_cut) {
    const RpyPair m = part(r);
    double f, d;
    table.evaluate(r, f, d);
    EXPECT_NEAR(f, m.transverse, error) << r;
    EXPECT_NEAR(d, m.longitudinal - m.transverse, error) << r;
  }
}

template <class Real> void expect_table_keeps(double error)
{
  for (double xi : {0.05, 0.3, 0.5, 1.0, 2.0, 5.0}) {
    const double a = 1.3, r_cut = 2.0 * a + 6.1 * a / xi;
    const RealSpaceTable<Real> table(a, xi / a, r_cut, error);
    std::mt19937_64 engine(11);
    std::uniform_real_distribution<double> uniform(0.0, r_cut);
    std::vector<double> r = {0.0,  1e-7, 2.0 * a * (1.0 - 1e-7), 2.0 * a, 2.0 * a * (1.0 + 1e-7),
                             r_cut};
    for (int m = 0; m < 4000; ++m) r.push_back(uniform(engine));
    for (int m = 0; m < 1000; ++m) r.push_back(uniform(engine) * 2.5 * a / r_cut);
    double worst = 0.0;
    for (double distance : r) {
      const Real rounded = std::nextafter(static_cast<Real>(distance), Real(0));    // <= r_cut
      const RpyPair m = real_space_exact(rounded, a, xi / a);
      Real f, d;
      table.evaluate(rounded, f, d);
      worst = std::max(
          {worst, std::fabs(f - m.transverse), std::fabs(d - (m.longitudinal - m.transverse))});
    }
    EXPECT_LE(worst, error) << "xi " << xi;
    Real f, d;
    table.evaluate(Real(0), f, d);
    EXPECT_NEAR(f, real_space_self(xi), error);
    EXPECT_NEAR(d, 0.0, error);
    // A table that is much too accurate is too large.
    if (error < 1e-5) {
      EXPECT_GE(worst, 0.02 * error) << "xi " << xi;
    }
    EXPECT_EQ(table.cutoff(), r_cut);
    EXPECT_GE(table.memory(), table.intervals() * 2 * (table.degree() + 1) * sizeof(Real));
    EXPECT_LT(table.memory(), 256u * 1024u);
  }
}

TEST(RealSpaceTable, KeepsTheErrorInDouble)
{
  for (double error : {1e-2, 1e-4, 1e-5, 1e-6, 1e-8, 1e-10, 1e-12, 1e-13, 1e-14})
    expect_table_keeps<double>(error);
}

TEST(RealSpaceTable, KeepsTheErrorInFloat)
{
  for (double error : {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 5e-7}) expect_table_keeps<float>(error);
}

// A long table has wider intervals far away.
template <class Real> void expect_long_table_keeps(double xi, double r_cut, double error)
{
  const double a = 1.3;
  const RealSpaceTable<Real> table(a, xi / a, r_cut * a, error);
  std::mt19937_64 engine(12);
  std::uniform_real_distribution<double> exponent(-0.3, std::log10(r_cut));
  std::vector<double> r = {0.0, 2.0, 63.999999, 64.0, 64.000001, r_cut};
  for (int m = 0; m < 3000; ++m) r.push_back(std::pow(10.0, exponent(engine)));
  for (double distance : r) {
    const Real rounded = std::nextafter(static_cast<Real>(distance * a), Real(0));
    const RpyPair m = real_space_exact(rounded, a, xi / a);
    Real f, d;
    table.evaluate(rounded, f, d);
    EXPECT_NEAR(f, m.transverse, error) << distance;
    EXPECT_NEAR(d, m.longitudinal - m.transverse, error) << distance;
  }
  EXPECT_LT(table.memory(), 6u * 1024u * 1024u);
}

TEST(RealSpaceTable, LongCutoffs)
{
  expect_long_table_keeps<float>(0.01, 600.0, 5e-7);
  expect_long_table_keeps<double>(0.01, 700.0, 1e-14);
  expect_long_table_keeps<float>(8e-5, 1.2e4, 1e-6);
  expect_long_table_keeps<double>(8e-5, 5e4, 2e-14);
  expect_long_table_keeps<double>(1e-5, 4e5, 1e-12);
}

TEST(RealSpaceTable, CutoffInsideContact)
{
  const RealSpaceTable<double> table(1.0, 5.0, 1.1, 1e-9);
  for (double r : {0.0, 0.4, 1.1}) {
    double f, d;
    table.evaluate(r, f, d);
    EXPECT_NEAR(f, real_space_exact(r, 1.0, 5.0).transverse, 1e-9);
  }
}

TEST(RealSpaceTable, RefusesNonsense)
{
  EXPECT_THROW(RealSpaceTable<double>(0.0, 1.0, 5.0, 1e-4), InvalidOption);
  EXPECT_THROW(RealSpaceTable<double>(1.0, -1.0, 5.0, 1e-4), InvalidOption);
  EXPECT_THROW(RealSpaceTable<double>(1.0, 1.0, NAN, 1e-4), InvalidOption);
  EXPECT_THROW(RealSpaceTable<double>(1.0, 1.0, HUGE_VAL, 1e-4), InvalidOption);
  EXPECT_THROW(RealSpaceTable<double>(1.0, 1.0, 5.0, 1e-17), InvalidOption);
  EXPECT_THROW(RealSpaceTable<double>(1.0, 1.0, 1e9, 1e-4), InvalidOption);
  EXPECT_THROW(RealSpaceTable<float>(1.0, 1.0, 5.0, 1e-8), InvalidOption);
}

// Cross-checks of the reference numbers differed by up to 9e-14 (`check_err`), mostly where spheres
// overlap their own images.
TEST(DenseRpy, ReferenceVelocities)
{
  const Json cases = json_reference("rpy_periodic.json")["cases"];
  ASSERT_GE(cases.size(), 20u);
  for (const Json &c : cases) {
    const std::vector<double> x = flatten(c["x"]), f = flatten(c["f"]), expected = flatten(c["u"]);
    const long n = c["N"];
    const double a = c["a"], eta = c["eta"];
    const std::vector<double> M = dense_mobility(cell_of(c["box"]), x.data(), n, a, eta);
    const Eigen::VectorXd u = matrix(M, n) * column(f);
    EXPECT_LE((u - column(expected)).norm(), 2e-13 * column(expected).norm()) << c["id"];
    std::vector<double> v(f.size(), NAN);
    dense_apply(cell_of(c["box"]), x.data(), n, a, eta, f.data(), v.data());
    EXPECT_LE((column(v) - column(expected)).norm(), 2e-13 * column(expected).norm()) << c["id"];
    if (!c.contains("M")) continue;
    const std::vector<double> whole = flatten(c["M"]);
    EXPECT_LE((column(M) - column(whole)).cwiseAbs().maxCoeff(), 4e-14 * free_mobility(a, eta))
        << c["id"];
  }
}

TEST(DenseRpy, SelfMobilityInACube)
{
  for (const auto &row : csv_reference("self_mobility_cubic.csv")) {
    const double L = std::stod(row[0]), a = 0.7, eta = 1.3, x[3] = {0.1, 0.2, 0.3};
    const std::vector<double> M = dense_mobility(cube(L * a), x, 1, a, eta);
    for (int d = 0; d < 3; ++d)    // the error of the file is 5e-13
      EXPECT_NEAR(M[4 * d] / free_mobility(a, eta), std::stod(row[1]), 6e-13) << L;
    // The series is exact for RPY if the spheres do not overlap their images.
    const double series = 1.0 - 2.837297479480619 / L + 4.0 * pi / 3.0 / (L * L * L);
    if (L >= 2.0) {
      EXPECT_NEAR(M[0] / free_mobility(a, eta), series, 1e-13) << L;
    }
    EXPECT_NEAR(M[1] / free_mobility(a, eta), 0.0, 1e-15);
  }
}

// All spheres of a lattice under the same force sediment with the same velocity (conventional
// cells).
TEST(DenseRpy, LatticeSedimentation)
{
  for (const auto &row : csv_reference("lattice_sedimentation.csv")) {
    std::vector<double> s = {0.0, 0.0, 0.0};
    if (row[0] == "BCC") s.insert(s.end(), {0.5, 0.5, 0.5});
    if (row[0] == "FCC") s.insert(s.end(), {0.5, 0.5, 0.0, 0.5, 0.0, 0.5, 0.0, 0.5, 0.5});
    const long n = s.size() / 3;
    const double phi = std::stod(row[1]), L = std::cbrt(4.0 * pi / 3.0 * n / phi);
    for (double &v : s) v *= L;
    std::vector<double> f(s.size(), 0.0), u(s.size(), NAN);
    for (long i = 0; i < n; ++i) f[3 * i + 2] = 1.0 / free_mobility(1.0, 1.0);
    dense_apply(cube(L), s.data(), n, 1.0, 1.0, f.data(), u.data());
    for (long i = 0; i < n; ++i) {
      EXPECT_NEAR(u[3 * i + 2], std::stod(row[2]), 1e-12) << row[0] << " " << phi;
      EXPECT_NEAR(u[3 * i], 0.0, 1e-13);
    }
  }
}

TEST(DenseRpy, SumDoesNotDependOnSplitting)
{
  for (const Cell &cell : {cube(5.0), tilted_cell(), elongated_cell()})
    for (bool clustered : {false, true}) {
      const long n = 7;
      const std::vector<double> x = positions(cell, n, 3, clustered),
                                M = dense_mobility(cell, x.data(), n, 1.0, 0.6);
      for (double xi : {0.35, 0.8, 1.5, 3.0}) {
        const DenseSplit split = dense_split(cell, x.data(), n, 1.0, 0.6, xi);
        const double defect =
            (column(split.real) + column(split.wave) - column(M)).cwiseAbs().maxCoeff();
        EXPECT_LE(defect, 1e-14 * free_mobility(1.0, 0.6)) << xi;
      }
    }
}

TEST(DenseRpy, ImagesAreTheSameParticle)
{
  const Cell cell = tilted_cell();
  const long n = 5;
  std::vector<double> x = positions(cell, n, 9, false);
  const std::vector<double> before = dense_mobility(cell, x.data(), n, 1.0, 1.0);
  const double steps[3] = {2.0, -1.0, 3.0};
  double shift[3];
  cell.lattice_vector(steps, shift);
  for (int d = 0; d < 3; ++d) x[3 + d] += shift[d];
  const std::vector<double> after = dense_mobility(cell, x.data(), n, 1.0, 1.0);
  // Positions near 20 radii have rounding errors of 2e-15 radii.
  EXPECT_LE((column(before) - column(after)).cwiseAbs().maxCoeff(),
            1e-14 * free_mobility(1.0, 1.0));
}

// PSE (B7), (B8): each part is positive by itself, for any configuration and any xi, which is the
// point of the paper.  Coinciding particles make M singular, so 0 is the smallest eigenvalue that
// can be required; the bound is the round-off of the largest one.
TEST(DenseRpy, BothPartsArePositive)
{
  for (const Cell &cell : {cube(5.0), tilted_cell(), elongated_cell()})
    for (bool clustered : {false, true})
      for (double xi : {0.3, 0.7, 1.5, 3.0}) {
        const long n = 20;
        std::vector<double> x = positions(cell, n, 5, clustered);
        if (clustered)
          for (int d = 0; d < 3; ++d) x[3 + d] = x[d];
        const DenseSplit split = dense_split(cell, x.data(), n, 1.0, 1.0, xi);
        for (const auto *part : {&split.real, &split.wave}) {
          const Matrix m = matrix(*part, n);
          EXPECT_EQ((m - m.transpose()).cwiseAbs().maxCoeff(), 0.0);
          const Eigen::VectorXd e =
              Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(m, Eigen::EigenvaluesOnly)
                  .eigenvalues();
          EXPECT_GE(e.minCoeff(), -1e-15 * n * e.maxCoeff()) << "xi " << xi;
          EXPECT_GT(e.maxCoeff(), 0.0);
        }
      }
}

// 500 hard spheres: the ends of the spectrum, and the sedimentation velocities, which depend on the
// configuration.
TEST(DenseRpy, HardSpheres)
{
  const Json cases = json_reference("hard_spheres.json")["cases"];
  ASSERT_EQ(cases.size(), 2u);
  for (const Json &c : cases) {
    const long n = c["N"];
    const double a = c["a"], eta = c["eta"], mobility = free_mobility(a, eta);
    const std::vector<double> x = flatten(c["x"]), f = flatten(c["f"]), expected = flatten(c["u"]);
    const std::vector<double> M = dense_mobility(cube(c["L"]), x.data(), n, a, eta);
    const Eigen::MatrixXd m = matrix(M, n);
    EXPECT_LE((m * column(f) - column(expected)).norm(), 1e-13 * column(expected).norm());
    EXPECT_NEAR(m.trace() / (3.0 * n * mobility), c["Ds_over_D0"].get<double>(), 1e-13);
    for (int d = 0; d < 3; ++d) {
      Eigen::VectorXd push = Eigen::VectorXd::Zero(3 * n);
      for (long i = 0; i < n; ++i) push[3 * i + d] = 1.0;
      const double fall = push.dot(m * push) / (n * mobility);
      EXPECT_NEAR(fall, c["sedimentation_xyz"][d].get<double>(), 1e-12);
    }
    const Eigen::VectorXd e =
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(m, Eigen::EigenvaluesOnly).eigenvalues();
    EXPECT_NEAR(e.minCoeff() / mobility, c["eig_min_over_mu0"].get<double>(), 1e-12);
    EXPECT_NEAR(e.maxCoeff() / mobility, c["eig_max_over_mu0"].get<double>(), 1e-11);
  }
}

TEST(DenseRpy, RefusesNonsense)
{
  const double x[3] = {0.0, 0.0, 0.0};
  EXPECT_THROW(dense_mobility(cube(5.0), x, 1, -1.0, 1.0), InvalidOption);
  EXPECT_THROW(dense_mobility(cube(5.0), x, 1, 1.0, NAN), InvalidOption);
  EXPECT_THROW(dense_mobility(cube(0.0), x, 1, 1.0, 1.0), InvalidOption);
  EXPECT_THROW(dense_split(cube(5.0), x, 1, 1.0, 1.0, 0.0), InvalidOption);
  EXPECT_TRUE(dense_mobility(cube(5.0), x, 0, 1.0, 1.0).empty());
}

}    // namespace
