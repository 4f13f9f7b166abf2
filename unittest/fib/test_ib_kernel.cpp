// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// The immersed-boundary kernels obey their laws and equal their published definitions.

#include "fib/ib_kernel.h"

#include "fib/reference_kernel.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

using namespace bdh;

namespace {

/// Sums of six weights of order 1/2 are accurate to a few units in the last place.
constexpr double round_off = 1e-15;

template <class K> struct Published;
template <> struct Published<Roma3> {
  static constexpr IbKernel kernel = IbKernel::roma3;
  static constexpr double squares = 1.0 / 2.0;
  static constexpr bool even_odd = false;
  static constexpr double edge = 0.5;    // position modulo 1 where the set of lines changes
};
template <> struct Published<Peskin4> {
  static constexpr IbKernel kernel = IbKernel::peskin4;
  static constexpr double squares = 3.0 / 8.0;
  static constexpr bool even_odd = true;
  static constexpr double edge = 0.0;
};
template <> struct Published<BaoKayePeskin6> {
  static constexpr IbKernel kernel = IbKernel::bkp6;
  static constexpr double squares = 0.0;    // no closed form: computed from the definition
  static constexpr bool even_odd = true;
  static constexpr double edge = 0.0;
};

struct Point {
  double first;
  std::vector<double> w, dw;
};

template <class K> Point at(double x)
{
  Point p;
  double r;
  p.first = K::first(x, r);
  p.w.resize(K::width);
  p.dw.resize(K::width);
  K::weights(r, p.w.data());
  K::derivatives(r, p.dw.data());
  return p;
}

/// Weight of one line, 0 beyond the support of the kernel.
template <class K> double value(double x, double line)
{
  const Point p = at<K>(x);
  const double i = line - p.first;
  return i < 0 || i >= K::width ? 0.0 : p.w[i];
}
template <class K> double slope(double x, double line)
{
  const Point p = at<K>(x);
  const double i = line - p.first;
  return i < 0 || i >= K::width ? 0.0 : p.dw[i];
}

/// Positions in three cells, one of them negative.  The offset 0.0137 avoids the cell edges.
std::vector<double> positions()
{
  std::vector<double> x;
  for (int i = -100; i < 200; ++i) x.push_back(0.0137 + 0.01 * i);
  return x;
}

}    // namespace

template <class K> class IbKernelLaws : public testing::Test {};
using Kernels = testing::Types<Roma3, Peskin4, BaoKayePeskin6>;
TYPED_TEST_SUITE(IbKernelLaws, Kernels);

TYPED_TEST(IbKernelLaws, WeightsAddUpToOneAndSlopesToZero)
{
  for (double x : positions()) {
    const Point p = at<TypeParam>(x);
    double sum = 0.0, slopes = 0.0;
    for (int i = 0; i < TypeParam::width; ++i) {
      sum += p.w[i];
      slopes += p.dw[i];
    }
    EXPECT_NEAR(sum, 1.0, round_off) << x;
    EXPECT_NEAR(slopes, 0.0, 4 * round_off) << x;
  }
}

// sum (x - line) phi = 0, so a linear field is interpolated exactly.  The factor in the bound
// allows for distances of up to 3.
TYPED_TEST(IbKernelLaws, FirstMomentVanishes)
{
  for (double x : positions()) {
    const Point p = at<TypeParam>(x);
    double moment = 0.0;
    for (int i = 0; i < TypeParam::width; ++i) moment += (x - p.first - i) * p.w[i];
    EXPECT_NEAR(moment, 0.0, 3 * round_off) << x;
  }
}

TYPED_TEST(IbKernelLaws, EvenAndOddLinesWeighTheSame)
{
  if (!Published<TypeParam>::even_odd) GTEST_SKIP() << "a three-point kernel cannot satisfy it";
  for (double x : positions()) {
    const Point p = at<TypeParam>(x);
    double even = 0.0;
    for (int i = 0; i < TypeParam::width; i += 2) even += p.w[i];
    EXPECT_NEAR(even, 0.5, round_off) << x;
  }
}

// The constant of the six-point kernel follows from its values at r = 0, where the outermost weight
// is 0.
TYPED_TEST(IbKernelLaws, SumOfSquaresIsConstant)
{
  const double expected = TypeParam::width == 6 ? bdh_test::bkp6_weights(0.0).squaredNorm()
                                                : Published<TypeParam>::squares;
  for (double x : positions()) {
    const Point p = at<TypeParam>(x);
    double squares = 0.0;
    for (double w : p.w) squares += w * w;
    EXPECT_NEAR(squares, expected, round_off) << x;
  }
}

// For bkp6 the two evaluations share no formula: moment equations here, a closed form there.
// Solving the equations loses a digit.
TYPED_TEST(IbKernelLaws, EqualsPublishedDefinition)
{
  for (double x : positions())
    for (double line = -6.0; line <= 6.0; line += 1.0)
      EXPECT_NEAR(value<TypeParam>(x, line), bdh_test::phi(Published<TypeParam>::kernel, x - line),
                  2e-14)
          << x << " " << line;
}

TYPED_TEST(IbKernelLaws, IsEven)
{
  for (double x : positions())
    for (double line = -5.0; line <= 5.0; line += 1.0)
      EXPECT_NEAR(value<TypeParam>(x, line), value<TypeParam>(-x, -line), 4 * round_off)
          << x << " " << line;
}

// The error of central differences with d = 1e-5 is d^2 phi'''/6, with phi''' < 150 (the
// three-point kernel at r = 1/2), plus 1e-16/d.
TYPED_TEST(IbKernelLaws, SlopeIsDerivative)
{
  const double d = 1e-5, bound = d * d * 150.0 / 6.0 + 5e-16 / d;
  for (double x : positions())
    for (double line = -4.0; line <= 4.0; line += 1.0)
      EXPECT_NEAR(slope<TypeParam>(x, line),
                  (value<TypeParam>(x + d, line) - value<TypeParam>(x - d, line)) / (2.0 * d),
                  bound)
          << x << " " << line;
}

// Across the edge where the set of lines changes, value and slope differ only by their own change
// over a distance 2 d.  The slopes are at most 1 and the second derivatives at most 8.
TYPED_TEST(IbKernelLaws, ValueAndSlopeAreContinuous)
{
  const double d = 1e-9;
  for (double cell = -2.0; cell <= 2.0; cell += 1.0)
    for (double line = -6.0; line <= 6.0; line += 1.0) {
      const double edge = cell + Published<TypeParam>::edge;
      EXPECT_NEAR(value<TypeParam>(edge - d, line), value<TypeParam>(edge + d, line), 2.1 * d)
          << edge << " " << line;
      EXPECT_NEAR(slope<TypeParam>(edge - d, line), slope<TypeParam>(edge + d, line), 20.0 * d)
          << edge << " " << line;
    }
}

TYPED_TEST(IbKernelLaws, LinesAreThoseWithinTheSupport)
{
  for (double x : positions()) {
    const double first = at<TypeParam>(x).first, half = 0.5 * TypeParam::width;
    EXPECT_GE(first, x - half) << x;
    EXPECT_LE(first + TypeParam::width - 1, x + half) << x;
  }
}

// The bound allows for sums of weights times squared distances of up to 3.
TEST(BaoKayePeskin6Moments, SecondIsConstantAndThirdVanishes)
{
  for (double x : positions()) {
    const Point p = at<BaoKayePeskin6>(x);
    double second = 0.0, third = 0.0;
    for (int i = 0; i < 6; ++i) {
      const double s = x - p.first - i;
      second += s * s * p.w[i];
      third += s * s * s * p.w[i];
    }
    EXPECT_NEAR(second, bdh_test::bkp6_second_moment, 1e-14) << x;
    EXPECT_NEAR(third, 0.0, 3e-14) << x;
  }
}

// Compares second differences of the slope about r = 0 and r = 1, where the formulas are analytic.
// Line i at r = 1 is line i - 1 of the next cell at r = 0, and lines 0 and 5 must vanish where they
// end.  The error of differences with d = 1e-3 is d^2/12 phi^(5) < 1e-5, while an error of the
// second moment K changes phi''' by about 20 times as much.
TEST(BaoKayePeskin6Moments, SecondAndThirdDerivativeAreContinuous)
{
  const double d = 1e-3;
  auto derivatives = [&](double r, double *second, double *third) {
    double a[6], b[6], c[6];
    BaoKayePeskin6::derivatives(r - d, a);
    BaoKayePeskin6::derivatives(r, b);
    BaoKayePeskin6::derivatives(r + d, c);
    for (int i = 0; i < 6; ++i) {
      second[i] = (c[i] - a[i]) / (2.0 * d);
      third[i] = (c[i] - 2.0 * b[i] + a[i]) / (d * d);
    }
  };
  double second0[7] = {}, third0[7] = {}, second1[7] = {}, third1[7] = {};
  derivatives(0.0, second0 + 1, third0 + 1);
  derivatives(1.0, second1, third1);
  for (int i = 0; i < 7; ++i) {
    EXPECT_NEAR(second0[i], second1[i], 3e-5) << i;
    EXPECT_NEAR(third0[i], third1[i], 3e-5) << i;
  }
}
