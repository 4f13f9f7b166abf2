// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// Positively split Ewald on several ranks.

#include "pse/pse_support.h"

#include <gtest/gtest.h>

using namespace bdh_test;
using bdh::Cell;
using bdh::PseNoise;
using bdh::PsePlan;
using Vector = std::vector<double>;

// Any number of ranks, even more than a small grid has planes, gives the same result to round-off.
TEST(PseRanks, SameVelocities)
{
  const struct {
    Cell cell;
    long n;
    double tolerance, bound;
  } cases[] = {{cubic_cell(18.0), 90, 1e-8, 1e-12},
               {cubic_cell(3.0), 2, 1e-1, 1e-5},
               {cubic_cell(18.0), 90, 1e-3, 2e-6}};
  for (const auto &c : cases) {
    Cell cell = c.cell;
    cell.xy = 0.2 * cell.lx;
    const Vector x = random_numbers(3 * c.n, 12), f = random_numbers(3 * c.n, 13);
    Vector wide = x;
    for (double &v : wide) v *= 0.4 * cell.lx;
    const PsePlan plan = bdh::plan_pse(scene_of(cell, c.n, 1.0, c.tolerance));
    PseHarness one(cell, wide, plan), many(cell, wide, plan, world());
    EXPECT_LE(relative_error(many.apply(f, 1.0), one.apply(f, 1.0)), c.bound);
    const PseNoise noise{2.0, 3, 4};
    EXPECT_LE(relative_error(many.fluctuate(f, noise, 1.0), one.fluctuate(f, noise, 1.0)), c.bound);
    EXPECT_LE(relative_error(many.in_parts(f, noise, 1.0), one.fluctuate(f, noise, 1.0)), c.bound);
  }
}

// All ranks plan with the same numbers, which are those of one rank: with all particles, and with a
// sample of them.
TEST(PseRanks, SamePairCounts)
{
  const double L = 40.0;
  for (long n : {200, 5000}) {
    std::mt19937_64 engine(17);
    std::uniform_real_distribution<double> place(0.0, L);
    Vector x(3 * n);
    for (double &c : x) c = place(engine);
    std::vector<uint64_t> id(n), mine;
    for (long i = 0; i < n; ++i) id[i] = i + 1;
    const Deal deal(n, world());
    for (long i : deal.mine) mine.push_back(id[i]);
    const Vector part = deal.take(x);
    Cell cell = cubic_cell(L);
    cell.xy = 0.3 * L;
    const bdh::PairCounts one = bdh::count_pairs(cell, 1.0, x.data(), id.data(), n, self()),
                          many = bdh::count_pairs(cell, 1.0, part.data(), mine.data(),
                                                  bdh::ssize(mine), world());
    ASSERT_FALSE(one.empty());
    EXPECT_EQ(one.radii, many.radii);
    EXPECT_EQ(one.mean, many.mean);
    EXPECT_EQ(one.crowded, many.crowded);
    EXPECT_EQ(one.largest, many.largest);
  }
}
