// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// Random numbers: known answers, accuracy of the elementary functions, distribution, independence.
//
// In statistical bounds z is a deviation in standard errors.  |z| < 5.5 fails by chance with
// probability 4e-8, or about 1e-5 for the few hundred comparisons of this file.  Seeds are fixed,
// so a test that passes once always passes.

#include "base/random_strip.h"
#include "base/rng_kernel.h"
#include "base/single_normals_kernel.h"
#include "stokes/mode_strip.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

using namespace bdh;

namespace {

constexpr double z_bound = 5.5;
constexpr long samples = 1000000;

using Quadruple = std::array<double, 4>;

Quadruple normals(const NoiseCounter &c, uint64_t index)
{
  Quadruple z;
  normal4(c, index, z[0], z[1], z[2], z[3]);
  return z;
}

constexpr NoiseCounter plain{20240, Stream::fluid, 7, 1};

std::array<uint32_t, 4> words(const NoiseCounter &c, uint64_t index)
{
  const r123array4x32 w = random_words(c, index);
  return {w.v[0], w.v[1], w.v[2], w.v[3]};
}

/// Moments of N(0,1): 1, 0, 1, 0, 3, 0, 15, ...
double normal_moment(int k) { return k % 2 ? 0.0 : k == 0 ? 1.0 : (k - 1) * normal_moment(k - 2); }

/// Largest |z| of the 4 x 4 correlations of two families of draws and of their squares.
template <class A, class B> double largest_correlation(A first, B second, long n)
{
  double sum[4][4] = {}, squares[4][4] = {};
  for (long i = 0; i < n; ++i) {
    const Quadruple a = first(i), b = second(i);
    for (int p = 0; p < 4; ++p)
      for (int q = 0; q < 4; ++q) {
        sum[p][q] += a[p] * b[q];
        squares[p][q] += (a[p] * a[p] - 1.0) * (b[q] * b[q] - 1.0);
      }
  }
  double worst = 0.0;
  for (int p = 0; p < 4; ++p)
    for (int q = 0; q < 4; ++q) {
      worst = std::max(worst, std::fabs(sum[p][q]) / std::sqrt(double(n)));
      worst = std::max(worst,
                       std::fabs(squares[p][q]) / std::sqrt(4.0 * n));    // 4 = Var(a^2 - 1)^2
    }
  return worst;
}

double correlation_with(const NoiseCounter &other)
{
  return largest_correlation([](long i) { return normals(plain, uint64_t(i)); },
                             [&](long i) { return normals(other, uint64_t(i)); }, 200000);
}

}    // namespace

// From kat_vectors of the Random123 distribution, "philox4x32 10": counter, key, result.
TEST(Philox, KnownAnswers)
{
  const std::array<uint32_t, 4> zero{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8};
  EXPECT_EQ(words({0, Stream(0), 0, 0}, 0), zero);

  const std::array<uint32_t, 4> ones{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd};
  EXPECT_EQ(
      words({0xffffffff, Stream(0xffffffff), 0xffffffffffffffffull, 0xff}, 0x00ffffffffffffffull),
      ones);

  // Counter 243f6a88 85a308d3 13198a2e 03707344, key a4093822 299f31d0 (digits of pi).
  const std::array<uint32_t, 4> pi{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1};
  EXPECT_EQ(
      words({0xa4093822, Stream(0x299f31d0), 0x0370734413198a2eull, 0x85}, 0x00a308d3243f6a88ull),
      pi);
}

TEST(Philox, IsAPureFunction)
{
  const auto first = words(plain, 12345);
  for (uint64_t i = 0; i < 100; ++i) words({uint32_t(i), Stream::lanczos, i, 0}, i);
  EXPECT_EQ(words(plain, 12345), first);
}

TEST(Philox, EveryArgumentMatters)
{
  const auto base = words(plain, 5);
  EXPECT_NE(words({plain.seed + 1, plain.stream, plain.step, plain.stage}, 5), base);
  EXPECT_NE(words({plain.seed, Stream::finite_difference, plain.step, plain.stage}, 5), base);
  EXPECT_NE(words({plain.seed, plain.stream, plain.step + 1, plain.stage}, 5), base);
  EXPECT_NE(words({plain.seed, plain.stream, plain.step + (1ull << 32), plain.stage}, 5), base);
  EXPECT_NE(words({plain.seed, plain.stream, plain.step, plain.stage + 1}, 5), base);
  EXPECT_NE(words(plain, 6), base);
  EXPECT_NE(words(plain, 5 + (1ull << 32)), base);
  EXPECT_NE(words(plain, 5 + (1ull << 55)), base);
}

// The function promises 4e-16, and std::log itself is accurate to 1.2e-16.  Near 1 the result is
// small, so relative accuracy matters.  The smallest argument that occurs is 2^-33.
TEST(LogUnit, AgreesWithStandardLibrary)
{
  double worst = 0.0;
  auto check = [&](double x) {
    worst = std::max(worst, std::fabs(log_unit(x) / std::log(x) - 1.0));
  };
  for (long i = 0; i < samples; ++i)
    check((random_words(plain, uint64_t(i)).v[0] + 0.5) / 4294967296.0);
  for (int e = 1; e <= 52; ++e) check(1.0 - std::ldexp(1.0, -e));
  for (int e = 1; e <= 33; ++e)
    for (double m : {1.0, 1.4142135623730949, 1.4142135623730951, 1.9999999999999998})
      check(std::ldexp(m, -e));
  EXPECT_LT(worst, 6e-16);
  EXPECT_EQ(log_unit(1.0), 0.0);
}

// The words are those of draws, and the extremes: next to 0 and 1, where the logarithm changes its
// formula, and at borders of quadrants.  Each number of a pair is off by the rounding of the
// radius.
TEST(SingleNormals, AreThoseOfDoubleToRoundOff)
{
  double worst = 0.0;
  const auto check = [&](uint32_t radius, uint32_t angle) {
    double z[2];
    float single[2];
    normal_pair(radius, angle, z[0], z[1]);
    normal_pair(radius, angle, single[0], single[1]);
    const double r = std::hypot(z[0], z[1]);
    for (int i = 0; i < 2; ++i) worst = std::max(worst, std::fabs(single[i] - z[i]) / r);
  };
  for (long i = 0; i < samples; ++i) {
    const auto w = words(plain, uint64_t(i));
    check(w[0], w[1]);
    check(w[2], w[3]);
  }
  for (uint32_t radius :
       {0u, 1u, 2u, 3u, 0xFFFFu, 0x10000u, 0xFFFFFFu, 0x1000001u, 0x7FFFFFFFu, 0x80000000u,
        0xB504F332u, 0xB504F333u, 0xB504F334u, 0xB504F3FFu, 0xFFFFFF00u, 0xFFFFFFFEu, 0xFFFFFFFFu})
    for (uint32_t angle : {0u, 1u, 0x1FFFFFFFu, 0x20000000u, 0x3FFFFFFFu, 0x40000000u, 0x7FFFFFFFu,
                           0x80000000u, 0xBFFFFFFFu, 0xC0000000u, 0xFFFFFFFFu})
      check(radius, angle);
  EXPECT_LT(worst, 4e-7);
  EXPECT_GT(worst, 1e-8) << "is this single precision?";
}

// The absolute error is below 1e-15, in every quadrant and at their borders.
TEST(SincosTurn, AgreesWithStandardLibrary)
{
  double worst = 0.0, worst_circle = 0.0;
  auto check = [&](uint32_t w) {
    double s, c;
    sincos_turn(w, s, c);
    const long double quarter = 1.57079632679489661923L;
    const long double angle =
        ((w & 0x3fffffffu) - 536870911.5L) / 1073741824.0L * quarter + (w >> 30) * quarter;
    worst =
        std::max({worst, std::fabs(s - double(sinl(angle))), std::fabs(c - double(cosl(angle)))});
    worst_circle = std::max(worst_circle, std::fabs(s * s + c * c - 1.0));
  };
  for (long i = 0; i < samples; ++i) check(random_words(plain, uint64_t(i)).v[1]);
  for (uint32_t quadrant = 0; quadrant < 4; ++quadrant)
    for (uint32_t w : {0u, 1u, 0x1fffffffu, 0x20000000u, 0x3ffffffeu, 0x3fffffffu})
      check((quadrant << 30) + w);
  EXPECT_LT(worst, 1e-15);
  EXPECT_LT(worst_circle, 1e-15);
}

// Moments 1 to 8 of each of the four outputs.  The k-th sample moment has the variance
// (mu_2k - mu_k^2)/n.
TEST(StatisticsNormals, MomentsUpToTheEighth)
{
  double sum[4][9] = {};
  for (long i = 0; i < samples; ++i) {
    const Quadruple z = normals(plain, uint64_t(i));
    for (int p = 0; p < 4; ++p) {
      double power = 1.0;
      for (int k = 1; k <= 8; ++k) sum[p][k] += power *= z[p];
    }
  }
  for (int p = 0; p < 4; ++p)
    for (int k = 1; k <= 8; ++k) {
      const double mu = normal_moment(k),
                   error = std::sqrt((normal_moment(2 * k) - mu * mu) / samples);
      EXPECT_LT(std::fabs(sum[p][k] / samples - mu), z_bound * error)
          << "output " << p << " moment " << k;
    }
}

// P(sqrt(n) D > 2.69) = 2 exp(-2 * 2.69^2) = 1e-6 for each of the four outputs.
TEST(StatisticsNormals, KolmogorovSmirnov)
{
  std::array<std::vector<double>, 4> z;
  for (long i = 0; i < samples; ++i) {
    const Quadruple q = normals(plain, uint64_t(i));
    for (int p = 0; p < 4; ++p) z[p].push_back(q[p]);
  }
  for (int p = 0; p < 4; ++p) {
    std::sort(z[p].begin(), z[p].end());
    double distance = 0.0;
    for (long i = 0; i < samples; ++i) {
      const double cdf = 0.5 * std::erfc(-z[p][i] / std::sqrt(2.0));
      distance = std::max({distance, cdf - double(i) / samples, double(i + 1) / samples - cdf});
    }
    EXPECT_LT(std::sqrt(double(samples)) * distance, 2.69) << "output " << p;
  }
}

// The counts beyond 3, 4 and 4.5 standard deviations are Poisson distributed to good accuracy.
// Expected are 10799, 253 and 27 out of 4e6.
TEST(StatisticsNormals, Tails)
{
  for (double t : {3.0, 4.0, 4.5}) {
    long beyond = 0;
    for (long i = 0; i < samples; ++i)
      for (double z : normals(plain, uint64_t(i))) beyond += std::fabs(z) > t;
    const double expected = 4.0 * samples * std::erfc(t / std::sqrt(2.0));
    EXPECT_LT(std::fabs(beyond - expected), 5.0 * std::sqrt(expected)) << t;
  }
}

TEST(Normals, ExtremeWordsStayFinite)
{
  for (uint32_t radius : {0u, 1u, 0x7fffffffu, 0x80000000u, 0xfffffffeu, 0xffffffffu})
    for (uint32_t angle : {0u, 0x3fffffffu, 0x40000000u, 0x80000000u, 0xc0000000u, 0xffffffffu}) {
      double a, b;
      normal_pair(radius, angle, a, b);
      EXPECT_LT(a * a + b * b, 6.77 * 6.77);
      EXPECT_TRUE(std::isfinite(a) && std::isfinite(b));
    }
}

// The four outputs of one call are independent, and so are calls with neighbouring indices.
TEST(StatisticsIndependence, WithinACallAndAlongTheIndex)
{
  double sum[4][4] = {};
  for (long i = 0; i < samples; ++i) {
    const Quadruple z = normals(plain, uint64_t(i));
    for (int p = 0; p < 4; ++p)
      for (int q = 0; q < p; ++q) sum[p][q] += z[p] * z[q];
  }
  for (int p = 0; p < 4; ++p)
    for (int q = 0; q < p; ++q)
      EXPECT_LT(std::fabs(sum[p][q]) / std::sqrt(double(samples)), z_bound) << p << " " << q;
  for (uint64_t lag : {1ull, 2ull, 33ull, 64ull, 4096ull, 1ull << 32, 1ull << 40})
    EXPECT_LT(largest_correlation([](long i) { return normals(plain, uint64_t(i)); },
                                  [&](long i) { return normals(plain, uint64_t(i) + lag); },
                                  200000),
              z_bound)
        << lag;
}

// Two runs whose seeds differ by 1 are independent, as are the streams, stages and steps of one
// run. An offset in the index would show up in the shifted comparisons.
TEST(StatisticsIndependence, SeedsStreamsStagesSteps)
{
  for (uint32_t seed :
       {plain.seed + 1, plain.seed - 1, plain.seed + 2, plain.seed ^ 0x80000000u, 0u, 1u})
    EXPECT_LT(correlation_with({seed, plain.stream, plain.step, plain.stage}), z_bound)
        << "seed " << seed;
  for (Stream stream : {Stream::finite_difference, Stream::lanczos, Stream::wave_space})
    EXPECT_LT(correlation_with({plain.seed, stream, plain.step, plain.stage}), z_bound)
        << "stream " << int(stream);
  for (uint32_t stage : {0u, 2u, 3u, 255u})
    EXPECT_LT(correlation_with({plain.seed, plain.stream, plain.step, stage}), z_bound)
        << "stage " << stage;
  for (uint64_t step : {uint64_t{6}, uint64_t{8}, uint64_t{9},
                        uint64_t{7} + (uint64_t{1} << 32)})    // plain.step is 7
    EXPECT_LT(correlation_with({plain.seed, plain.stream, step, plain.stage}), z_bound)
        << "step " << step;
  const NoiseCounter next_seed{plain.seed + 1, plain.stream, plain.step, plain.stage};
  const NoiseCounter next_step{plain.seed, plain.stream, plain.step + 1, plain.stage};
  for (const NoiseCounter &other : {next_seed, next_step})
    for (long shift : {-64L, -1L, 1L, 64L})
      EXPECT_LT(largest_correlation(
                    [](long i) { return normals(plain, uint64_t(1000 + i)); },
                    [&](long i) { return normals(other, uint64_t(1000 + i + shift)); }, 200000),
                z_bound)
          << "shift " << shift;
}

// The noise at a fixed index over many steps, seeds and stages: a time series must be white as
// well.
TEST(StatisticsIndependence, AlongStepsAndSeeds)
{
  auto at_step = [](long i) {
    return normals({plain.seed, plain.stream, uint64_t(i), plain.stage}, 99);
  };
  auto next_step = [](long i) {
    return normals({plain.seed, plain.stream, uint64_t(i) + 1, plain.stage}, 99);
  };
  EXPECT_LT(largest_correlation(at_step, next_step, 200000), z_bound);
  auto at_seed = [](long i) {
    return normals({uint32_t(i), plain.stream, plain.step, plain.stage}, 99);
  };
  auto next_seed = [](long i) {
    return normals({uint32_t(i) + 1, plain.stream, plain.step, plain.stage}, 99);
  };
  EXPECT_LT(largest_correlation(at_seed, next_seed, 200000), z_bound);
}

namespace {

NoiseCounter piece(uint64_t node)
{
  return {plain.seed, plain.stream, bdh::piece_of_step(plain.step, node), plain.stage};
}

/// Normals by the recursion that defines the tree; z' of a node from the words that only it has.
Quadruple by_halving(uint64_t node, uint64_t index)
{
  if (node == 1) return normals(plain, index);
  const Quadruple z = by_halving(node / 2, index);
  const std::array<uint32_t, 4> w =
      words({plain.seed, plain.stream, plain.step + ((node / 2) << 40), plain.stage}, index);
  Quadruple other;
  normal_pair(w[0], w[1], other[0], other[1]);
  normal_pair(w[2], w[3], other[2], other[3]);
  Quadruple half;
  for (int k = 0; k < 4; ++k)
    half[k] = (z[k] + (node % 2 ? -1.0 : 1.0) * other[k]) / std::sqrt(2.0);
  return half;
}

}    // namespace

// Words of many indices at once, by vectors of the processor, are those of each.
TEST(Words, OfManyIndices)
{
  std::mt19937_64 random(11);
  for (const NoiseCounter &c :
       {plain, NoiseCounter{0, Stream::wave_space, 0, 0},
        NoiseCounter{0xFFFFFFFFu, Stream::lanczos, (uint64_t(1) << 63) + 12345, 255}})
    for (long count : {8, 64}) {
      std::vector<uint64_t> index(count);
      for (uint64_t &i : index) i = random() >> 8;
      index[0] = 0;
      index[1] = (uint64_t(1) << 56) - 1;
      std::vector<uint32_t> w[4];
      for (auto &word : w) word.resize(count);
      random_words_of(c, index.data(), count, {w[0].data(), w[1].data(), w[2].data(), w[3].data()});
      for (long i = 0; i < count; ++i) {
        const std::array<uint32_t, 4> all = {w[0][i], w[1][i], w[2][i], w[3][i]};
        EXPECT_EQ(all, words(c, index[i])) << index[i];
      }
    }
}

TEST(BrownianTree, PiecesAreHalvesOfPieces)
{
  for (uint64_t node : {2u, 3u, 5u, 6u, 11u, 12u, 1023u, (1u << 22) + 12345u})
    for (uint64_t index : {uint64_t(0), uint64_t(17), uint64_t(1) << 50}) {
      const Quadruple z = normals(piece(node), index), expected = by_halving(node, index);
      for (int k = 0; k < 4; ++k) EXPECT_NEAR(z[k], expected[k], 1e-14) << node;
    }
}

// Displacements are the normals times the root of the time.
TEST(BrownianTree, HalvesAddUpToTheWhole)
{
  for (uint64_t node : {1u, 2u, 3u, 6u, 13u, 77u})
    for (uint64_t index = 0; index < 20; ++index) {
      const Quadruple whole = normals(piece(node), index), first = normals(piece(2 * node), index),
                      second = normals(piece(2 * node + 1), index);
      for (int k = 0; k < 4; ++k) {
        EXPECT_NEAR(std::sqrt(0.5) * (first[k] + second[k]), whole[k], 1e-14) << node;
        EXPECT_NE(first[k], second[k]);
      }
    }
}

TEST(BrownianTree, WholeStepsDoNotDependOnTheTree)
{
  EXPECT_EQ(bdh::piece_of_step(7, 1), 7u);
  EXPECT_EQ(normals(piece(1), 5), normals(plain, 5));
}

TEST(BrownianTree, StripsOfModesHaveTheSamePieces)
{
  for (uint64_t node : {1u, 3u, 12u}) {
    bdh::StripNormals<double> strip{};
    bdh::add_normals(
        piece(node), 2.0, [](long i) { return uint64_t(1000 + i); }, 10, strip);
    for (long i = 0; i < 10; ++i) {
      const Quadruple z = normals(piece(node), 1000 + i);
      for (int k = 0; k < 4; ++k)
        EXPECT_NEAR(strip.z[k][i], 2.0 * std::sqrt(0.5) * z[k], 1e-14) << node;
    }
  }
}

// Ranges that begin and end within a strip, and are longer than one.
TEST(BrownianTree, LoopsOverDrawsHaveTheSameNormals)
{
  std::vector<uint64_t> index;
  for (long i = 0; i < 150; ++i) index.push_back(i * i * 1000003 + (uint64_t(i % 3) << 40));
  for (const NoiseCounter &counter : {plain, piece(1), piece(3), piece(12)})
    for (const auto &range : {std::array<long, 2>{0, 150}, {0, 1}, {37, 129}, {64, 64}}) {
      long next = range[0];
      bdh::for_draws_in(range[0], range[1], counter, index.data(), [&](long i, const double *z) {
        EXPECT_EQ(i, next++);
        const Quadruple expected = normals(counter, index[i]);
        for (int k = 0; k < 4; ++k) EXPECT_NEAR(z[k], expected[k], 1e-14) << i;
      });
      EXPECT_EQ(next, range[1]);
    }
}

TEST(StatisticsBrownianTree, PiecesOfOneResolutionAreIndependentNormals)
{
  auto at = [](uint64_t node) { return [node](long i) { return normals(piece(node), i); }; };
  for (const auto &pair : {std::array<uint64_t, 2>{2, 3}, {4, 5}, {5, 6}, {4, 7}, {2, 6}, {3, 5}})
    EXPECT_LT(largest_correlation(at(pair[0]), at(pair[1]), 200000), z_bound)
        << pair[0] << " " << pair[1];
  for (uint64_t node : {2u, 3u, 5u, 12u}) {
    double second = 0.0, fourth = 0.0;
    const long n = 200000;
    for (long i = 0; i < n; ++i)
      for (double z : normals(piece(node), i)) {
        second += z * z;
        fourth += z * z * z * z;
      }
    EXPECT_NEAR(second / (4 * n), 1.0, z_bound * std::sqrt(2.0 / (4 * n))) << node;
    EXPECT_NEAR(fourth / (4 * n), 3.0, z_bound * std::sqrt(96.0 / (4 * n))) << node;
  }
}
