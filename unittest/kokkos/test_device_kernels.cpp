// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// Evaluates every pointwise formula in Kokkos' default execution space and on the host.  On a GPU
// this compares two compilers and two mathematical libraries; elsewhere it only shows that the
// formulas work inside a kernel.

#include "base/rng_kernel.h"
#include "fib/ghost_kernel.h"
#include "fib/ib_kernel.h"
#include "pair/asakura_oosawa_kernel.h"
#include "pse/rpy_kernel.h"
#include "stokes/box_kernel.h"
#include "stokes/modes_kernel.h"
#include "stokes/slit_kernel.h"

#include <Kokkos_Core.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <typeinfo>

namespace {

constexpr int POINTS = 4096;

// A few units in the last place of each result (at most 2 for exp and erfc in CUDA's libm),
// amplified by the cancellation in the formula, relative to the largest value over all points.
constexpr double ROUND_OFF = 1e-14;

/// A formula that returns OUTPUTS numbers for x in (0, 1) and the number of the point.
struct AsakuraOosawa {
  static constexpr int OUTPUTS = 2;
  BDH_FN static void evaluate(double x, int, double *out)
  {
    out[0] = bdh::ao_energy(3.2 * x, 1.7, 2.9);
    out[1] = bdh::ao_force_over_r(3.2 * x, 1.7, 2.9);
  }
};

template <class Kernel> struct Weights {
  static constexpr int OUTPUTS = 2 * Kernel::width;
  BDH_FN static void evaluate(double x, int, double *out)
  {
    double r;
    Kernel::first(1.0 + x, r);
    Kernel::weights(r, out);
    Kernel::derivatives(r, out + Kernel::width);
  }
};

struct FreeSpaceRpy {
  static constexpr int OUTPUTS = 5;
  BDH_FN static void evaluate(double x, int, double *out)
  {
    const bdh::RpyPair m = bdh::free_space_rpy(8.0 * x);
    out[0] = m.transverse;
    out[1] = m.longitudinal;
    out[2] = bdh::sinc(20.0 * x);
    out[3] = bdh::bessel1_ratio(20.0 * x);
    out[4] = bdh::hasimoto_split(8.0 * x, 0.7);
  }
};

struct RealSpaceRpy {
  static constexpr int OUTPUTS = 3;
  BDH_FN static void evaluate(double x, int, double *out)
  {
    const bdh::RpyPair m = bdh::real_space_closed_form(0.5 + 5.0 * x, 0.7);
    out[0] = m.transverse;
    out[1] = m.longitudinal;
    out[2] = bdh::real_space_self(0.1 + x);
  }
};

struct Noise {
  static constexpr int OUTPUTS = 4;
  BDH_FN static void evaluate(double, int i, double *out)
  {
    const bdh::NoiseCounter c{12345, bdh::Stream::wave_space, (uint64_t(1) << 40) + 7, 2};
    bdh::normal4(c, (uint64_t(1) << 36) + i, out[0], out[1], out[2], out[3]);
  }
};

template <int D> struct StokesMode {
  static constexpr int OUTPUTS = 2 * D;
  BDH_FN static void evaluate(double x, int i, double *out)
  {
    const bdh::AxisSymbol axis[3] = {bdh::axis_symbol(i % 16, 32, 0.8),
                                     bdh::axis_symbol(i / 16 % 16, 32, 0.9),
                                     bdh::axis_symbol(i / 256, 32, 1.1)};
    const double z[4] = {x, 1.0 - x, -x, 0.3};
    for (int k = 0; k < 2 * D; ++k) out[k] = 1.0 + x * k;
    bdh::solve_mode<D>(axis, 0.37, 0.21, z, out, out + D);
  }
};

BDH_FN bdh::Boundary wall(bool noslip)
{
  return noslip ? bdh::Boundary::noslip : bdh::Boundary::slip;
}

struct SlitRows {
  static constexpr int OUTPUTS = 3;
  BDH_FN static void evaluate(double x, int i, double *out)
  {
    const double term = bdh::wall_term(wall(i % 2 == 0)), last = i % 2 == 0 ? 1.0 : 0.0;
    const bdh::RowEnds walls{term, term, 0.0, 0.0}, open{0.0, 0.0, 1.0, last};
    const bdh::PentadiagonalRow none{0.0, 0.0},
        one = bdh::next_pentadiagonal(4.0 * x, 0.0, walls, none, none);
    const bdh::PentadiagonalRow two =
        bdh::next_pentadiagonal(4.0 * x, bdh::decay_per_row(x), open, one, none);
    out[0] = two.l1;
    out[1] = two.inv_d;
    out[2] = bdh::next_tridiagonal(4.0 * x, term, 0.4);
  }
};

/// A mode of a slit with a few rows, whose lines have their own array.
struct SlitMode {
  static constexpr int ROWS = 5, OUTPUTS = 6 * ROWS;
  struct Normals {
    double z[4][1];
  };
  struct Strip {
    double *field;    // re, im for each component of each row
    double x, factors[3][ROWS];
    BDH_FN bdh::SlitComponents<3, double> components(long row) const
    {
      double *const f = field + 6 * row;
      return {{f, f + 2, f + 4}};
    }
    BDH_FN Normals normals(long row) const { return {{{x}, {1.0 - x}, {0.3 * row}, {-x}}}; }
    BDH_FN bdh::SlitWork work(long row)
    {
      double *const f = field + 6 * row;
      return {{f + 2, f + 3}, {f + 4, f + 5}, &factors[0][row], &factors[1][row], &factors[2][row]};
    }
  };
  BDH_FN static bdh::SlitChannel channel(int i)
  {
    return {{16, 16},        {0.8, 0.9}, ROWS,  0.7,  wall(i % 2 == 0),
            wall(i % 4 < 2), 1.3,        100.0, 0.37, 0.21};
  }
  BDH_FN static void evaluate(double x, int i, double *out)
  {
    const bdh::SlitChannel c = channel(i);
    for (int k = 0; k < OUTPUTS; ++k) out[k] = 1.0 + x * k;
    Strip strip{out, x, {}};
    bdh::SlitModes<1> mode(c, i / 8 % 16);
    mode.set(c, 0, bdh::axis_symbol(1 + i % 8, c.n[0], c.h_along[0]));
    bdh::solve_slit_modes<3>(c, mode, 1, strip);
    out[4] = out[5] = 1.0;    // replaces 0, since the face is in the wall
  }
};

/// The mean mode: the velocity in a few rows, and the forces on the walls.
struct SlitMean {
  static constexpr int OUTPUTS = SlitMode::ROWS + 4;
  struct Normal {
    double x;
    BDH_FN double operator()(long row) const { return x - 0.2 * row; }
  };
  BDH_FN static void evaluate(double x, int i, double *out)
  {
    const bdh::SlitChannel c = SlitMode::channel(i);
    double mode[2 * SlitMode::ROWS], *const forces = out + SlitMode::ROWS;
    for (int k = 0; k < 2 * SlitMode::ROWS; ++k) mode[k] = 1.0 + x * k * k;
    bdh::solve_mean_flow(c, 0.1, Normal{x}, c.along(mode, 2), forces[0], forces[1]);
    for (int row = 0; row < SlitMode::ROWS; ++row) {
      out[row] = mode[2 * row];
      mode[2 * row] = x * row * row;
    }
    bdh::solve_mean_pressure(c, 0.1, c.along(mode, 2), forces[2], forces[3]);
  }
};

/// A cell in the corner of a box.  The bits of i select which of its faces are walls.
struct BoxCell {
  static constexpr int OUTPUTS = 11;
  BDH_FN static bdh::BoxGrid box(int i)
  {
    bdh::BoxGrid b{3,
                   {4, 5, 6},
                   {1, 6, 30},
                   {0.8, 0.9, 1.1},
                   {1.25, 1.0 / 0.9, 1.0 / 1.1},
                   0.792,
                   {true, i % 2 == 0, true},
                   {}};
    for (int axis = 0; axis < 3; ++axis)
      for (int side = 0; side < 2; ++side) b.noslip[axis][side] = (i >> (axis + side)) % 2 == 0;
    return b;
  }
  BDH_FN static void evaluate(double x, int i, double *out)
  {
    const bdh::BoxGrid b = box(i);
    long at[3];
    b.locate(i % 120, at);
    const double V[3] = {0.3, x, -0.2};
    double f[3] = {1.0 + x, 1.0 - x, 1.0}, *field[3] = {f, f + 1, f + 2};
    for (int d = 0; d < 3; ++d) f[d] = bdh::face_force(b, d, at[d], f[d], 0.1 * d);
    bdh::add_moving_wall(b, 2, V, 1.3, at, 0, field);
    for (int d = 0; d < 3; ++d) {
      out[d] = f[d];
      out[3 + d] = 0.01;
    }
    bdh::add_wall_force(b, 1, i % 2, V, 1.3, at, 0, x, field, out + 3);
    out[6] = bdh::gradient(b.face_scale(0, at[0]), x, 0.2);
    out[7] = bdh::divergence(b.inv_h[1], x, 0.7);
    out[8] = b.place(at) + b.before(1, at[1]) + 2 * b.after(2, at[2]);
    const bdh::BoxModeScales scales{0.7, 900.0, 0.4};
    out[9] = bdh::solve_box_mode(scales, 0.1 + x, i % 5 ? 1.0 : 0.5, 3.0, i % 3 == 0, x - 0.5);
    out[10] = bdh::solve_box_mode(scales, i % 7 ? x : 0.0, 1.0, 3.0, true, x - 0.5) * x;
  }
};

/// The contribution of moving walls to the velocity of a particle near their corner.
struct GhostVelocity {
  static constexpr int OUTPUTS = 3;
  BDH_FN static void evaluate(double x, int i, double *out)
  {
    const double at[3] = {3.0 * x, i % 2 ? 0.4 : 5.8, 2.0 + x};
    out[0] = out[1] = out[2] = 0.1;
    bdh::AddGhostVelocity<bdh::Peskin4> g{
        3,
        {{6, 0.0, 1.0, true, -1.0, -1.0},
         {6, 0.0, 1.0, true, -1.0, 1.0},
         {6, 0.0, 1.0, i % 4 < 2, 1.0, -1.0}},
        {{{0.0, 0.7, 0.2}, {0.0, 0.0, 0.0}}, {{0.3, 0.0, -0.2}, {0.1, 0.0, 0.4}}, {}},
        at,
        out};
    g(0);
  }
};

template <class Formula> struct Evaluate {
  using Results = Kokkos::View<double * [Formula::OUTPUTS], Kokkos::LayoutRight>;
  Results results;

  KOKKOS_INLINE_FUNCTION void operator()(int i) const
  {
    Formula::evaluate((i + 0.5) / POINTS, i, &results(i, 0));
  }
};

template <class Formula> class DeviceKernel : public testing::Test {};
using Formulas =
    testing::Types<AsakuraOosawa, Weights<bdh::Roma3>, Weights<bdh::Peskin4>,
                   Weights<bdh::BaoKayePeskin6>, FreeSpaceRpy, RealSpaceRpy, Noise, StokesMode<2>,
                   StokesMode<3>, SlitRows, SlitMode, SlitMean, BoxCell, GhostVelocity>;
TYPED_TEST_SUITE(DeviceKernel, Formulas);

TYPED_TEST(DeviceKernel, EqualsHost)
{
  constexpr int outputs = TypeParam::OUTPUTS;
  const typename Evaluate<TypeParam>::Results results("results", POINTS);
  Kokkos::parallel_for(Kokkos::RangePolicy<>(0, POINTS), Evaluate<TypeParam>{results});
  const auto device = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), results);

  double scale[outputs] = {}, error[outputs] = {};
  for (int i = 0; i < POINTS; ++i) {
    double host[outputs];
    TypeParam::evaluate((i + 0.5) / POINTS, i, host);
    for (int k = 0; k < outputs; ++k) {
      ASSERT_TRUE(std::isfinite(device(i, k)));
      scale[k] = std::max(scale[k], std::fabs(host[k]));
      error[k] = std::max(error[k], std::fabs(device(i, k) - host[k]));
    }
  }
  for (int k = 0; k < outputs; ++k) {
    ASSERT_GT(scale[k], 0.0);
    EXPECT_LE(error[k], ROUND_OFF * scale[k]) << "result " << k;
  }
}

// Random words are integers and must agree in every bit.
struct Words {
  Kokkos::View<uint32_t *[4], Kokkos::LayoutRight> words;

  BDH_FN static r123array4x32 draw(int i)
  {
    return bdh::random_words({54321, bdh::Stream::fluid, 99, 1}, (uint64_t(1) << 50) + i);
  }
  KOKKOS_INLINE_FUNCTION void operator()(int i) const
  {
    const r123array4x32 w = draw(i);
    for (int k = 0; k < 4; ++k) words(i, k) = w.v[k];
  }
};

TEST(DeviceRandomWords, EqualHostInEveryBit)
{
  const Words draw{decltype(Words::words)("words", POINTS)};
  Kokkos::parallel_for(Kokkos::RangePolicy<>(0, POINTS), draw);
  const auto device = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), draw.words);
  for (int i = 0; i < POINTS; ++i)
    for (int k = 0; k < 4; ++k) ASSERT_EQ(device(i, k), Words::draw(i).v[k]) << i << " " << k;
}

}    // namespace

int main(int argc, char **argv)
{
  testing::InitGoogleTest(&argc, argv);
  const Kokkos::ScopeGuard guard(argc, argv);
  std::printf("Kokkos' default execution space: %s\n",
              typeid(Kokkos::DefaultExecutionSpace).name());
  return RUN_ALL_TESTS();
}
