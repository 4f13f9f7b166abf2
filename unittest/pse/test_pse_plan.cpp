// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// Plans of positively split Ewald for dilute boxes and clusters, and within limits.

#include "base/constants.h"
#include "base/errors.h"
#include "grid/fft.h"
#include "oracle/dense_rpy.h"
#include "pse/pair_counts.h"
#include "pse/plan_cost.h"
#include "pse/pse_support.h"
#include "pse/recent_plans.h"

#include <gtest/gtest.h>

#include <functional>

using namespace bdh_test;
using bdh::Cell;
using bdh::PairCounts;
using bdh::pi;
using bdh::PseConditions;
using bdh::PsePlan;
using bdh::PseScene;
using bdh::Splitting;
using Vector = std::vector<double>;

namespace {

/// n points in a cube of side L, from its corner.
Vector uniform_points(long n, double L, unsigned seed)
{
  std::mt19937_64 engine(seed);
  std::uniform_real_distribution<double> place(0.0, L);
  Vector x(3 * n);
  for (double &c : x) c = place(engine);
  return x;
}

/// n points within R of the middle of a cube of side L.
Vector globule(long n, double R, double L)
{
  std::mt19937_64 engine(21);
  std::uniform_real_distribution<double> place(-R, R);
  Vector x;
  while (bdh::ssize(x) < 3 * n) {
    const double y[3] = {place(engine), place(engine), place(engine)};
    if (y[0] * y[0] + y[1] * y[1] + y[2] * y[2] > R * R) continue;
    for (double c : y) x.push_back(0.5 * L + c);
  }
  return x;
}

PairCounts count(const Cell &cell, const Vector &x, double radius = 1.0)
{
  std::vector<uint64_t> id;
  for (long i = 0; i < bdh::ssize(x) / 3; ++i) id.push_back(i + 1);
  return bdh::count_pairs(cell, radius, x.data(), id.data(), bdh::ssize(id), self());
}

PseConditions conditions_of(const Cell &cell, const Vector &x)
{
  PseConditions c;
  c.counts = count(cell, x);
  return c;
}

Vector equal_forces(long n)
{
  Vector f(3 * n, 0.0);
  for (long i = 0; i < n; ++i) f[3 * i + 2] = 1.0;
  return f;
}

Vector oracle(const Cell &cell, const Vector &x, const Vector &f)
{
  Vector u(f.size());
  bdh::dense_apply(cell, x.data(), x.size() / 3, 1.0, 1.0, f.data(), u.data());
  return u;
}

std::string message_of(const std::function<void()> &body)
{
  try {
    body();
  } catch (const bdh::InvalidOption &e) {
    return e.what();
  }
  return "";
}

void expect_words(const std::string &message, const std::vector<std::string> &words)
{
  for (const std::string &word : words)
    EXPECT_NE(message.find(word), std::string::npos) << word << " in: " << message;
}

Cell tilted_cell()
{
  Cell c;
  c.lo[0] = -3.0, c.lo[1] = 1.0, c.lo[2] = 5.0;
  c.lx = 20.0, c.ly = 24.0, c.lz = 30.0, c.xy = 9.0, c.xz = -8.0, c.yz = 10.0;
  return c;
}

/// Others of each particle within r, image by image.
std::vector<long> others_by_images(const Cell &cell, const Vector &x, double r)
{
  const long n = x.size() / 3;
  std::vector<long> others(n, 0);
  for (long i = 0; i < n; ++i)
    for (long j = 0; j < n; ++j)
      for (int image = 0; image < 125; ++image) {
        const double m[3] = {image % 5 - 2.0, image / 5 % 5 - 2.0, image / 25 - 2.0};
        double shift[3], r2 = 0.0;
        cell.lattice_vector(m, shift);
        for (int d = 0; d < 3; ++d) r2 += std::pow(x[3 * i + d] - x[3 * j + d] - shift[d], 2);
        others[i] += i != j && r2 < r * r;
      }
  return others;
}

}    // namespace

TEST(PairCounts, AreThoseOfAllImages)
{
  const long n = 150;
  const double radius = 1.3;
  const Cell cell = tilted_cell();
  Vector x(3 * n), s = uniform_points(n, 1.0, 3);
  for (long i = 0; i < n; ++i) {
    for (int d = 0; d < 3; ++d) s[3 * i + d] *= i % 2 ? 1.0 : 0.3;    // half of them in a corner
    cell.lattice_vector(&s[3 * i], &x[3 * i]);
    for (int d = 0; d < 3; ++d) x[3 * i + d] += cell.lo[d];
  }
  const PairCounts counts = count(cell, x, radius);
  ASSERT_GT(counts.radii.size(), 20u);
  const double reach = 0.5 * std::min({cell.height(0), cell.height(1), cell.height(2)});
  EXPECT_LE(counts.radii.back(), reach);
  EXPECT_GE(1.13 * counts.radii.back(), reach);
  for (std::size_t k = 0; k < counts.radii.size(); k += 4) {
    double sum = 0.0, squares = 0.0, largest = 0.0;
    for (long others : others_by_images(cell, x, counts.radii[k])) {
      sum += others;
      squares += others * others;
      largest = std::max<double>(largest, others);
    }
    EXPECT_NEAR(counts.mean[k], sum / n, 1e-12 * n) << counts.radii[k];
    EXPECT_NEAR(counts.crowded[k], sum > 0.0 ? squares / sum : 0.0, 1e-12 * n);
    EXPECT_EQ(counts.largest[k], largest);
  }
  // They belong to the configuration and not to how it is written down.
  Vector elsewhere;
  for (long i = n - 1; i >= 0; --i) {
    const double m[3] = {double(i % 3), double(-(i % 2)), 1.0};
    double shift[3];
    cell.lattice_vector(m, shift);
    for (int d = 0; d < 3; ++d) elsewhere.push_back(x[3 * i + d] + shift[d]);
  }
  EXPECT_EQ(count(cell, elsewhere, radius).mean, counts.mean);
}

// A sample stands for many particles: a globule in a gas.
TEST(PairCounts, SampleOfManyParticles)
{
  const double L = 300.0, R = 20.0;
  const long gas = 90000, in_globule = 10000;
  Vector x = uniform_points(gas, L, 5);
  const Vector more = globule(in_globule, R, L);
  x.insert(x.end(), more.begin(), more.end());
  const PairCounts counts = count(cubic_cell(L), x);
  const double density = (gas + in_globule) / (L * L * L);
  const auto within = [&](auto entry, double r) {
    return bdh::others_within(counts, entry, density, r);
  };
  for (double r : {4.0, 6.0, 10.0}) {
    const double volume = 4.0 / 3.0 * pi * r * r * r, gas_only = gas / (L * L * L) * volume;
    // Of two points in a sphere of radius R, the share of pairs within r.
    const double t = r / R, share = t * t * t * (1.0 - 9.0 / 16.0 * t + t * t * t / 32.0);
    const double mean = gas_only + 0.1 * in_globule * share;
    EXPECT_NEAR(within(&PairCounts::mean, r), mean, 0.15 * mean) << r;
    const double inside = in_globule * t * t * t;
    if (r > 9.0) {    // less is chance, in a sample of 3 %
      EXPECT_GE(within(&PairCounts::largest, r), 0.4 * inside) << r;
    }
    EXPECT_LE(within(&PairCounts::largest, r), 1.5 * (inside + gas_only) + 30.0) << r;
    EXPECT_GE(within(&PairCounts::crowded, r), 0.5 * inside) << r;
  }
  EXPECT_NEAR(within(&PairCounts::mean, 400.0), density * 4.0 / 3.0 * pi * 6.4e7,
              0.1 * 2.68e8 * density);
}

TEST(PairCounts, FewOrStrangeParticles)
{
  const Cell cell = cubic_cell(10.0);
  EXPECT_TRUE(count(cell, {}).empty());
  EXPECT_TRUE(count(cell, {1.0, 2.0, 3.0}).empty());
  EXPECT_TRUE(count(cell, {1.0, 2.0, 3.0, NAN, 0.0, 0.0}).empty());
  const PairCounts pair = count(cell, {1.0, 1.0, 1.0, 1.0, 1.0, 9.5});
  EXPECT_NEAR(bdh::others_within(pair, &PairCounts::mean, 1e-9, 1.3), 0.0, 1e-7);
  EXPECT_EQ(bdh::others_within(pair, &PairCounts::mean, 1e-9, 2.0), 1.0);
  EXPECT_EQ(bdh::others_within({}, &PairCounts::mean, 0.25 / pi, 3.0), 9.0);
  // Evenly spread particles are the least.
  EXPECT_GT(bdh::others_within(pair, &PairCounts::mean, 1.0, 1.3), 9.0);
}

// Nearly empty boxes, for which the splitting is as small as 1e-5: forces of all kinds.
TEST(PsePlan, DiluteBoxesKeepTheTolerance)
{
  for (double L : {1e2, 1e3, 1e4, 1e5})
    for (long n : {1, 40}) {
      const Cell cell = cubic_cell(L);
      const Vector x = uniform_points(n, L, 7);
      for (const Vector &f : {equal_forces(n), random_numbers(3 * n, 3)}) {
        const Vector exact = oracle(cell, x, f);
        for (double tolerance : {1e-2, 1e-3, 1e-5, 1e-8}) {
          const PsePlan plan =
              bdh::plan_pse(scene_of(cell, n, 1.0, tolerance), conditions_of(cell, x));
          PseHarness M(cell, x, plan);
          EXPECT_LE(relative_error(M.apply(f, 1.0), exact), tolerance)
              << L << " " << n << " " << tolerance << " xi " << plan.xi;
        }
      }
    }
}

TEST(PsePlan, ClustersInLargeBoxesKeepTheTolerance)
{
  const long n = 150;
  for (double L : {60.0, 3000.0})
    for (double R : {9.0, 2.5}) {
      const Cell cell = cubic_cell(L);
      const Vector x = globule(n, R, L);
      for (const Vector &f : {equal_forces(n), random_numbers(3 * n, 3)}) {
        const Vector exact = oracle(cell, x, f);
        for (double tolerance : {1e-2, 1e-3, 1e-6}) {
          PseScene scene = scene_of(cell, n, 1.0, tolerance);
          scene.noise = true;
          PseHarness M(cell, x, bdh::plan_pse(scene, conditions_of(cell, x)));
          EXPECT_LE(relative_error(M.apply(f, 1.0), exact), tolerance)
              << L << " " << R << " " << tolerance;
        }
      }
    }
}

TEST(PsePlan, GivenSplittingsKeepTheTolerance)
{
  const long n = 30;
  const struct {
    double L, xi;
  } cases[] = {{300.0, 0.01}, {300.0, 0.003}, {3000.0, 0.0004}, {9.0, 15.0}, {9.0, 20.0}};
  for (const auto &c : cases) {
    const Cell cell = cubic_cell(c.L);
    const Vector x = uniform_points(n, c.L, 9);
    for (const Vector &f : {equal_forces(n), random_numbers(3 * n, 3)}) {
      const Vector exact = oracle(cell, x, f);
      for (double tolerance : {1e-3, 1e-6}) {
        if (c.xi > 10.0 && tolerance < 1e-3) continue;    // a grid of 400^3
        PseScene scene = scene_of(cell, n, 1.0, tolerance);
        scene.xi = c.xi;
        PseHarness M(cell, x, bdh::plan_pse(scene));
        EXPECT_LE(relative_error(M.apply(f, 1.0), exact), tolerance) << c.xi << " " << tolerance;
      }
    }
  }
}

// What a plan says of neighbors and iterations is what there is.
TEST(PsePlan, NeighborsAndIterationsOfClusters)
{
  const long n = 400;
  for (double L : {60.0, 1000.0})
    for (double R : {13.0, 3.0}) {
      const Cell cell = cubic_cell(L);
      const Vector x = globule(n, R, L);
      PseScene scene = scene_of(cell, n, 1.0, 1e-3);
      scene.noise = true;
      const PsePlan plan = bdh::plan_pse(scene, conditions_of(cell, x));
      double sum = 0.0, largest = 0.0;
      for (long others : others_by_images(cell, x, plan.r_cut)) {
        sum += others;
        largest = std::max<double>(largest, others);
      }
      EXPECT_NEAR(plan.neighbors, sum / n, 0.03 * sum / n) << L << " " << R;
      EXPECT_NEAR(plan.most_neighbors, largest, 0.06 * largest) << L << " " << R;
      PseHarness M(cell, x, plan);
      // It varies from one noise to the next.
      const int draws = 6;
      double iterations = 0.0;
      for (int draw = 0; draw < draws; ++draw) {
        M.fluctuate({}, {1.0, 5, 6 + static_cast<uint64_t>(draw)}, 1.0);
        iterations += double(M.report.iterations) / draws;
      }
      EXPECT_LE(iterations, 2 * plan.iterations) << L << " " << R;
      EXPECT_GE(iterations, 0.5 * plan.iterations) << L << " " << R;
    }
}

// Of clusters that are smaller than 1/xi, the number of iterations does not depend on xi: the few
// motions of the cluster as a whole, or of large parts of it, that do are found one by one.  The
// number varies from one noise to the next, by up to a factor of 2: their mean has an error of 8 %.
TEST(PsePlan, IterationsOfSmallClusters)
{
  const long n = 400, draws = 12;
  const Cell cell = cubic_cell(600.0);
  for (double R : {3.0, 9.2}) {
    const Vector x = globule(n, R, cell.lx);
    for (double xi : {0.01, 0.05 / R, 0.5 / R}) {
      PseScene scene = scene_of(cell, n, 1.0, 1e-3);
      scene.noise = true;
      scene.xi = xi;
      const PsePlan plan = bdh::plan_pse(scene, conditions_of(cell, x));
      PseHarness M(cell, x, plan);
      double sum = 0.0;
      for (long step = 0; step < draws; ++step) {
        M.fluctuate({}, {1.0, 5, static_cast<uint64_t>(step)}, 1.0);
        sum += M.report.iterations;
      }
      EXPECT_NEAR(plan.iterations, sum / draws, 0.25 * sum / draws) << R << " " << xi;
    }
  }
}

// The size that is chosen is one of those that FFTW is fast at, and near the one that is needed.
TEST(PsePlan, SizesOfGridsAreFast)
{
  for (long n = 17; n < 600; ++n) {
    const long size = bdh::cheapest_fft_size(n), smallest = bdh::next_fast_size(n, 4);
    EXPECT_EQ(size, bdh::next_fast_size(size, 4)) << n;
    EXPECT_GE(size, smallest) << n;
    EXPECT_LT(size, 1.2 * smallest) << n;
  }
  // 64^3 points take less time than 60^3, 128^3 less than 120^3, and 200^3 less than 196^3
  // (bench/README.md).
  EXPECT_EQ(bdh::cheapest_fft_size(57), 64);
  EXPECT_EQ(bdh::cheapest_fft_size(115), 128);
  EXPECT_EQ(bdh::cheapest_fft_size(109), 112);
  EXPECT_EQ(bdh::cheapest_fft_size(193), 200);
}

// No splitting of a finer and wider scan is expected to cost less.
TEST(PsePlan, ChoosesTheCheapest)
{
  const auto expect_cheapest = [](const Cell &cell, const Vector &x, bool noise) {
    PseScene scene = scene_of(cell, bdh::ssize(x) / 3, 1.0, 1e-3);
    scene.noise = noise;
    PseConditions conditions = conditions_of(cell, x);
    const PsePlan chosen = bdh::plan_pse(scene, conditions);
    EXPECT_EQ(chosen.limit, bdh::PseLimit::none);
    conditions.most_neighbors = HUGE_VAL;    // the scan may go where nothing is refused
    double cheapest = 1e300, at = 0.0;
    for (scene.xi = chosen.xi / 20.0; scene.xi < 20.0 * chosen.xi && scene.xi <= 20.0;
         scene.xi *= 1.13) {
      const double seconds = bdh::plan_pse(scene, conditions).seconds();
      if (seconds >= cheapest) continue;
      cheapest = seconds;
      at = scene.xi;
    }
    EXPECT_LE(chosen.seconds(), 1.03 * cheapest) << cell.lx << ": " << chosen.xi << ", not " << at;
  };
  for (double L : {20.0, 1e3, 1e4, 1e5})
    for (bool noise : {false, true})
      expect_cheapest(cubic_cell(L), uniform_points(200, L, 3), noise);
  for (double L : {100.0, 2000.0})
    for (double R : {18.0, 4.5}) expect_cheapest(cubic_cell(L), globule(1500, R, L), true);
}

// The Kaiser-Bessel splitting is chosen where it is expected to cost less, and only there.
TEST(PsePlan, ChoosesTheCheaperSplitting)
{
  for (double L : {13.0, 40.0, 1e3})
    for (double tolerance : {1e-1, 1e-3, 1e-6, 1e-9}) {
      PseScene scene = scene_of(cubic_cell(L), 200, 1.0, tolerance);
      scene.noise = true;
      const PsePlan chosen = bdh::plan_pse(scene);
      double least = 1e300;
      for (Splitting splitting : {Splitting::hasimoto, Splitting::kaiser_bessel}) {
        scene.splitting = splitting;
        const PsePlan plan = bdh::plan_pse(scene);
        EXPECT_EQ(plan.splitting, splitting);
        least = std::min(least, plan.seconds());
        if (chosen.splitting == splitting) {
          EXPECT_EQ(chosen.seconds(), plan.seconds());
        }
      }
      EXPECT_EQ(chosen.seconds(), least) << L << " " << tolerance;
    }
}

// Spheres that rotate, and spheres of several radii, have both splittings, too.
TEST(PsePlan, ChoosesTheCheaperSplittingForSpheresOfAllKinds)
{
  PseScene unequal = scene_of(cubic_cell(30.0), 200, 1.0, 1e-3), rotating = unequal, rigid;
  unequal.least_radius = 0.5;
  unequal.mean_cube = 0.5;
  unequal.classes.add(0.5, 0.5, 1.0);
  unequal.classes.add(1.0, 0.5, 1.0);
  rotating.rotation = true;
  rigid = rotating;
  rigid.stresslets = true;
  for (PseScene scene : {unequal, rotating, rigid}) {
    const PsePlan cheapest = bdh::plan_pse(scene);
    EXPECT_EQ(cheapest.splitting, Splitting::kaiser_bessel);
    scene.splitting = Splitting::hasimoto;
    const PsePlan other = bdh::plan_pse(scene);
    EXPECT_EQ(other.splitting, Splitting::hasimoto);
    EXPECT_LT(cheapest.seconds(), other.seconds());
  }
}

// The mean density knows nothing of a globule.
TEST(PsePlan, CountsChangeTheChoice)
{
  const Cell cell = cubic_cell(100.0);
  PseScene scene = scene_of(cell, 3000, 1.0, 1e-3);
  scene.noise = true;
  const PsePlan even = bdh::plan_pse(scene);
  const PseConditions conditions = conditions_of(cell, globule(3000, 18.0, 100.0));
  const PsePlan counted = bdh::plan_pse(scene, conditions);
  EXPECT_GT(counted.xi, 1.5 * even.xi);
  scene.xi = even.xi;
  EXPECT_GT(bdh::plan_pse(scene, conditions).seconds(), 2.0 * counted.seconds());
}

// A plan that was made before is found again where a search would find it, and nowhere else.
TEST(RecentPlans, AreThoseOfTheSameScene)
{
  const Cell cell = cubic_cell(20.0);
  PseScene scene = scene_of(cell, 100, 1.0, 1e-3);
  PseConditions conditions = conditions_of(cell, globule(100, 8.0, 20.0));
  const PsePlan plan = bdh::plan_pse(scene, conditions);
  bdh::RecentPlans recent;
  EXPECT_EQ(recent.find(scene, conditions), nullptr);
  recent.add(scene, conditions, plan);
  const PsePlan *known = recent.find(scene, conditions);
  ASSERT_NE(known, nullptr);
  EXPECT_EQ(known->xi, plan.xi);
  EXPECT_EQ(known->n, plan.n);

  const auto expect_other = [&](auto change) {
    PseScene s = scene;
    PseConditions c = conditions;
    change(s, c);
    EXPECT_EQ(recent.find(s, c), nullptr);
  };
  expect_other([](PseScene &s, PseConditions &) { s.tolerance = 1.1e-3; });
  expect_other([](PseScene &s, PseConditions &) { s.particles = 101; });
  expect_other([](PseScene &s, PseConditions &) { s.edge[2] *= 1.01; });
  expect_other([](PseScene &s, PseConditions &) { s.substeps = 4; });
  expect_other([](PseScene &s, PseConditions &) { s.noise = !s.noise; });
  expect_other([](PseScene &s, PseConditions &) { s.xi = 0.5; });
  expect_other([](PseScene &s, PseConditions &) { s.largest_cutoff = 9.0; });
  expect_other(
      [](PseScene &s, PseConditions &) { s.precision = bdh::Precision::double_precision; });
  expect_other([](PseScene &s, PseConditions &) { s.classes.count[0] = 5.0; });
  expect_other([](PseScene &, PseConditions &c) { c.skin = 1.0; });
  expect_other([](PseScene &, PseConditions &c) { c.memory = 1e9; });
  expect_other([](PseScene &, PseConditions &c) { c.counts.mean.back() *= 1.1; });
}

TEST(PsePlan, KeepsToALongestCutoff)
{
  PseScene scene = scene_of(cubic_cell(12.0), 5, 1.0, 1e-5);
  scene.splitting = Splitting::hasimoto;
  const PsePlan free = bdh::plan_pse(scene);
  ASSERT_GT(free.r_cut, 10.0);
  PseConditions conditions;
  conditions.cutoff_reason = "for a reason";
  scene.largest_cutoff = 10.0;
  const PsePlan plan = bdh::plan_pse(scene, conditions);
  EXPECT_LE(plan.r_cut, 10.0);
  EXPECT_EQ(plan.limit, bdh::PseLimit::cutoff);
  EXPECT_GE(plan.seconds(), free.seconds());
  scene.xi = free.xi;
  const std::string message = message_of([&] { bdh::plan_pse(scene, conditions); });
  expect_words(message, {"xi = ", "exceeds 10, for a reason", "xi auto", "an xi of at least "});
  // The least one that is named will do, and a smaller one will not.
  const double least = std::stod(message.substr(message.find("at least ") + 9));
  scene.xi = least;
  EXPECT_LE(bdh::plan_pse(scene, conditions).r_cut, 10.0);
  scene.xi = 0.98 * least;
  EXPECT_NE(message_of([&] { bdh::plan_pse(scene, conditions); }), "");
}

TEST(PsePlan, KeepsToANumberOfNeighbors)
{
  const Cell cell = cubic_cell(100.0);
  PseScene scene = scene_of(cell, 2000, 1.0, 1e-3);
  PseConditions conditions = conditions_of(cell, globule(2000, 6.0, 100.0));
  const PsePlan free = bdh::plan_pse(scene, conditions);
  conditions.most_neighbors = 0.5 * free.most_neighbors;
  const PsePlan plan = bdh::plan_pse(scene, conditions);
  EXPECT_LE(plan.most_neighbors, conditions.most_neighbors);
  EXPECT_EQ(plan.limit, bdh::PseLimit::neighbors);
  scene.xi = free.xi;
  expect_words(message_of([&] { bdh::plan_pse(scene, conditions); }),
               {"xi = ", "neighbors per particle in a box of 100 x 100 x 100", "use a larger one"});
}

// What does not fit into memory is refused while nothing has been allocated.
TEST(PsePlan, KeepsToTheMemory)
{
  PseScene scene = scene_of(cubic_cell(1e4), 20, 1.0, 1e-3);
  PseConditions conditions;
  conditions.memory = 8e9;
  EXPECT_LT(bdh::plan_pse(scene, conditions).grid_bytes, 1e7);
  scene.xi = 0.08;
  expect_words(message_of([&] { bdh::plan_pse(scene, conditions); }),
               {"xi = 0.08", "in a box of 1e+04 x 1e+04 x 1e+04 takes ", "GB",
                "use a smaller one, or xi auto"});
  scene.xi = 0.0;
  scene.particles = 100000000;
  expect_words(message_of([&] { bdh::plan_pse(scene, conditions); }),
               {"xi = auto", "the cheapest is ", "in a box of 1e+04", "use a smaller box"});
  // A smaller grid at the price of more pairs.
  scene = scene_of(cubic_cell(1000.0), 300, 1.0, 1e-3);
  conditions.memory = 0.0;
  const PsePlan free = bdh::plan_pse(scene, conditions);
  conditions.memory = 0.9 * (free.grid_bytes + free.pair_bytes);
  const PsePlan plan = bdh::plan_pse(scene, conditions);
  EXPECT_LE(plan.grid_bytes + plan.pair_bytes, conditions.memory);
  EXPECT_LT(plan.xi, free.xi);
  EXPECT_EQ(plan.limit, bdh::PseLimit::memory);
}

// The estimate of memory is no less than what there is, and no more than three times as much.
TEST(PsePlan, KnowsItsMemory)
{
  for (double tolerance : {1e-3, 1e-6}) {
    const Cell cell = cubic_cell(30.0);
    const Vector x = uniform_points(600, 30.0, 3);
    PseScene scene = scene_of(cell, 600, 1.0, tolerance);
    scene.noise = true;
    const PsePlan plan = bdh::plan_pse(scene, conditions_of(cell, x));
    PseHarness M(cell, x, plan);
    M.fluctuate({}, {1.0, 5, 6}, 1.0);
    EXPECT_GE(plan.grid_bytes, M.mobility().grid_memory());
    EXPECT_LE(plan.grid_bytes, 3.0 * M.mobility().grid_memory());
  }
}

TEST(PsePlan, RangeOfSplittings)
{
  PseScene scene = scene_of(cubic_cell(1e5), 20, 1.0, 1e-3);
  for (double xi : {9e-7, 21.0}) {
    scene.xi = xi;
    expect_words(message_of([&] { bdh::plan_pse(scene); }),
                 {"xi = ", "from 1e-6/radius to 20/radius"});
  }
  scene.xi = 1e-4;
  EXPECT_EQ(bdh::plan_pse(scene).xi, 1e-4);
}
