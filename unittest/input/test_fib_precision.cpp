// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// Which precision the grid of fix bd/fib takes.

#include "input/fib_precision.h"

#include "base/errors.h"
#include "support/test_support.h"

#include <gtest/gtest.h>

using namespace bdh;
using bdh_test::make_grid;

namespace {

Grid box(Boundary y, Boundary z)
{
  Grid g = make_grid({8, 8, 8}, {1.0});
  g.boundary[1].fill(y);
  g.boundary[2].fill(z);
  return g;
}

FibPrecision chosen(FibOptions o, const Grid &g, Precision precision, bool device = false)
{
  o.precision = precision;
  return choose_precision(o, g, device);
}

void expect_double(const FibOptions &o, const Grid &g, bool device = false)
{
  EXPECT_FALSE(chosen(o, g, Precision::automatic, device).single);
  EXPECT_FALSE(chosen(o, g, Precision::double_precision, device).single);
  EXPECT_THROW(chosen(o, g, Precision::single_precision, device), InvalidOption);
}

}    // namespace

// The spread of a kernel is what M varies by with the position in a cell.
TEST(FibPrecision, AutoTakesSingleWhereItCannotBeSeen)
{
  FibOptions o;
  for (const IbKernel kernel : {IbKernel::roma3, IbKernel::peskin4, IbKernel::bkp6}) {
    o.kernel = kernel;
    for (const int dim : {2, 3})
      EXPECT_LT(100.0 * single_round_off, radius_spread(kernel, dim)) << kernel_name(kernel);
    for (const Boundary z : {Boundary::periodic, Boundary::noslip, Boundary::slip, Boundary::open})
      EXPECT_TRUE(chosen(o, box(Boundary::periodic, z), Precision::automatic).single);
  }
}

// Single is refused there.
TEST(FibPrecision, AutoTakesDoubleWhereSingleIsImpossible)
{
  const Grid periodic = box(Boundary::periodic, Boundary::periodic);
  expect_double({}, periodic, true);
  expect_double({}, box(Boundary::noslip, Boundary::noslip));
  expect_double({}, box(Boundary::slip, Boundary::slip));
  FibOptions differences, stresslets, held;
  differences.drift = DriftChoice::finite_difference;
  expect_double(differences, periodic);
  stresslets.stresslets = true;
  expect_double(stresslets, periodic);
  held.holds.emplace_back();
  expect_double(held, periodic);
}

TEST(FibPrecision, ThatIsGivenIsTaken)
{
  const Grid periodic = box(Boundary::periodic, Boundary::periodic);
  EXPECT_TRUE(chosen({}, periodic, Precision::single_precision).single);
  EXPECT_FALSE(chosen({}, periodic, Precision::double_precision).single);
  EXPECT_FALSE(choose_precision({}, periodic, false).single) << "the default";
}
