// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
// Laws of spreading and interpolation, for any backend: #define TEST_BACKEND before including this.

#include "fib/reference_kernel.h"
#include "support/test_support.h"

#include <gtest/gtest.h>

#include <vector>

namespace {

using namespace bdh;
using namespace bdh_test;
using Backend = TEST_BACKEND;

/// Grids that are as wide as the kernel in one direction, with unequal spacings and with sizes
/// other than powers of 2.
std::vector<Grid> spread_grids(IbKernel kernel)
{
  const long w = kernel_width(kernel);
  return {make_grid({7, 8, 9}, {0.7}), make_grid({w, w + 1, 2 * w}, {0.5, 0.8, 1.1}),
          make_grid({9, 7}, {1.3}), make_grid({w + 1, w}, {0.6, 0.9})};
}

/// One slab of the grid with its own spreader and arrays, like those of a rank.
struct Part {
  Grid grid;
  Slab slab;
  typename Backend::Spreader spreader;
  typename Backend::Vector values[3];
  std::size_t size;

  Part(const Grid &g, const Slab &s, IbKernel kernel) : grid(g), slab(s), spreader(g, s, kernel)
  {
    size = 2 * g.half() * (g.dim == 3 ? g.n[1] : 1) * s.count;
    for (int d = 0; d < g.dim; ++d) {
      values[d].resize(size);
      Access<Backend>::put(std::vector<double>(size, 0.0), values[d]);
    }
  }
  FieldView view()
  {
    FieldView v{};
    for (int d = 0; d < grid.dim; ++d) v[d] = values[d].data();
    return v;
  }
  void load(const Field &f)
  {
    for (int d = 0; d < grid.dim; ++d) Access<Backend>::put(slab_part(f, d, slab, size), values[d]);
  }
  void add_to(Field &f) const
  {
    for (int d = 0; d < grid.dim; ++d) add_slab(Access<Backend>::get(values[d]), d, slab, f);
  }
};

Slab whole(const Grid &g) { return {0, g.n[g.slow_axis()]}; }

Field spread(const Grid &g, IbKernel kernel, const std::vector<double> &x,
             const std::vector<double> &force, double kT)
{
  Part part(g, whole(g), kernel);
  part.spreader.bind(x.data(), x.size() / 3);
  part.spreader.spread(force.data(), kT, part.view());
  Field f(g);
  part.add_to(f);
  return f;
}

std::vector<double> interpolate(const Field &f, IbKernel kernel, const std::vector<double> &x)
{
  Part part(f.grid, whole(f.grid), kernel);
  part.load(f);
  part.spreader.bind(x.data(), x.size() / 3);
  std::vector<double> u(x.size(), NAN);
  part.spreader.interpolate(part.view(), u.data());
  return u;
}

/// (S F)_d(face) = 1/dV sum_i F_id prod_axes sum_images phi((q - x_face)/h), which is FIB eq. (13)
/// and sec. III A as written.
Field spread_by_definition(const Grid &g, IbKernel kernel, const std::vector<double> &x,
                           const std::vector<double> &force)
{
  Field f(g);
  // The weight along one axis, with images up to two kernel widths away.
  auto weight = [&](int axis, bool own, double q, long line) {
    double sum = 0.0;
    for (int image = -20; image <= 20; ++image) {
      const double face =
          g.lo[axis] + (double(line + image * g.n[axis]) + (own ? 0.0 : 0.5)) * g.h(axis);
      const double distance = (q - face) / g.h(axis);
      if (std::fabs(distance) < 3.5) sum += phi(kernel, distance);
    }
    return sum;
  };
  for (std::size_t p = 0; p < x.size() / 3; ++p)
    for (int d = 0; d < g.dim; ++d) {
      std::vector<double> w[3];
      for (int axis = 0; axis < 3; ++axis)
        for (long line = 0; line < g.n[axis]; ++line)
          w[axis].push_back(axis < g.dim ? weight(axis, axis == d, x[3 * p + axis], line) : 1.0);
      for (long k = 0; k < g.n[2]; ++k)
        for (long j = 0; j < g.n[1]; ++j)
          for (long i = 0; i < g.n[0]; ++i)
            f.at(d, i, j, k) += force[3 * p + d] * w[0][i] * w[1][j] * w[2][k] / g.cell_volume();
    }
  return f;
}

/// Calls law(grid, kernel) for every kernel on each of its grids.
template <class Law> void for_all_scenes(Law law)
{
  for (IbKernel kernel : all_kernels)
    for (const Grid &g : spread_grids(kernel)) {
      SCOPED_TRACE(std::string(kernel_name(kernel)) + " " + name_of(g));
      law(g, kernel);
    }
}

}    // namespace

// Positions are up to two boxes away.  The definition loses a digit for bkp6, whose weights come
// from linear equations.
TEST(TypedSpread, EqualsTheDefinition)
{
  for_all_scenes([](const Grid &g, IbKernel kernel) {
    const std::vector<double> x = random_positions(g, 11, 1, 4.0), force = random_numbers(33, 2);
    const Field expected = spread_by_definition(g, kernel, x, force);
    EXPECT_LT(distance(spread(g, kernel, x, force, 0.0), expected), 1e-13 * expected.norm());
  });
}

// (J v).F = dV sum_faces v.(S F), scaled by |Jv||F|, so the bound does not depend on cancellation
// in the sum.
TEST(TypedSpread, IsTheAdjointOfInterpolation)
{
  for_all_scenes([](const Grid &g, IbKernel kernel) {
    const std::vector<double> x = random_positions(g, 40, 3, 3.0), force = random_numbers(120, 4);
    const Field v = random_field(g, 5), f = spread(g, kernel, x, force, 0.0);
    const std::vector<double> u = interpolate(v, kernel, x);
    double particles = 0.0, faces = 0.0, scale = 0.0;
    for (std::size_t i = 0; i < u.size(); ++i)
      if (int(i % 3) < g.dim) {
        particles += u[i] * force[i];
        scale += std::fabs(u[i] * force[i]);
      }
    for (int d = 0; d < g.dim; ++d)
      for (std::size_t i = 0; i < v.c[d].size(); ++i)
        faces += g.cell_volume() * v.c[d][i] * f.c[d][i];
    EXPECT_NEAR(particles, faces, 1e-14 * scale);
  });
}

// The same law entry by entry, as matrices: S = J^T/dV with exactly the same weights.
TEST(TypedSpread, MatrixIsTheTransposeOfInterpolation)
{
  for_all_scenes([](const Grid &g, IbKernel kernel) {
    const std::vector<double> x = random_positions(g, 1, 6);
    for (int d = 0; d < g.dim; ++d) {
      std::vector<double> unit(3, 0.0);
      unit[d] = 1.0;
      const Field column = spread(g, kernel, x, unit, 0.0);
      for (std::size_t i = 0; i < column.c[d].size(); i += 7) {
        Field e(g);
        e.c[d][i] = 1.0;
        EXPECT_NEAR(interpolate(e, kernel, x)[d], column.c[d][i] * g.cell_volume(), 1e-16);
      }
    }
  });
}

// The total force is conserved and the thermal drift adds none, since the weights add up to 1 and
// their slopes to 0.
TEST(TypedSpread, ConservesTotalForce)
{
  for_all_scenes([](const Grid &g, IbKernel kernel) {
    const std::vector<double> x = random_positions(g, 20, 7, 2.0), force = random_numbers(60, 8);
    for (double kT : {0.0, 1.7}) {
      const Field f = spread(g, kernel, x, force, kT);
      for (int d = 0; d < g.dim; ++d) {
        double on_grid = 0.0, on_particles = 0.0, scale = 20.0 * (1.0 + kT / g.h(d));
        for (double v : f.c[d]) on_grid += v * g.cell_volume();
        for (std::size_t i = 0; i < 20; ++i) on_particles += force[3 * i + d];
        EXPECT_NEAR(on_grid, on_particles, 1e-14 * scale) << kT;
      }
    }
  });
}

TEST(TypedSpread, AddsToWhatIsThere)
{
  const Grid g = make_grid({7, 8, 9}, {0.7});
  const std::vector<double> x = random_positions(g, 5, 9), force = random_numbers(15, 10);
  Part part(g, whole(g), IbKernel::peskin4);
  part.spreader.bind(x.data(), 5);
  part.spreader.spread(force.data(), 0.0, part.view());
  part.spreader.spread(force.data(), 0.0, part.view());
  Field twice(g), once = spread(g, IbKernel::peskin4, x, force, 0.0);
  part.add_to(twice);
  for (int d = 0; d < 3; ++d)
    for (double &v : once.c[d]) v *= 2.0;
  EXPECT_LT(distance(twice, once), 1e-15 * once.norm());
}

// Every periodic image gives the same field.  With spacings of 1/2 the shift is exact, apart from
// the rounding of the shifted position, 1e-16 of its size.
TEST(TypedSpread, IsPeriodic)
{
  for (IbKernel kernel : all_kernels)
    for (const Grid &g : {make_grid({8, 7, 10}, {0.5}, 0.0), make_grid({9, 8}, {0.5}, 0.0)}) {
      const std::vector<double> x = random_positions(g, 10, 11), force = random_numbers(30, 12);
      const Field home = spread(g, kernel, x, force, 0.3), v = random_field(g, 13);
      const std::vector<double> u = interpolate(v, kernel, x);
      for (double boxes : {-1.0, 1.0, -7.0, 1000.0, -1e6}) {
        std::vector<double> away = x;
        for (std::size_t i = 0; i < away.size(); ++i)
          away[i] += (i % 2 ? boxes : -2.0 * boxes) * g.length[i % 3];
        const double rounding = 1e-14 + 1e-14 * std::fabs(boxes);
        EXPECT_LT(distance(spread(g, kernel, away, force, 0.3), home), rounding * home.norm())
            << boxes;
        EXPECT_LT(difference(interpolate(v, kernel, away), u), rounding * norm(u)) << boxes;
      }
    }
}

// Positions on cell faces and centres, where the set of lines changes, and a rounding error to
// either side of them.
TEST(TypedSpread, IsContinuousAtCellEdges)
{
  for_all_scenes([](const Grid &g, IbKernel kernel) {
    for (double place : {0.0, 0.5, 1.0, -0.5, double(g.n[0]), double(g.n[0]) - 0.5}) {
      std::vector<double> x(3), force{1.0, -2.0, 0.5};
      for (int d = 0; d < 3; ++d) x[d] = g.lo[d] + place * g.h(d);
      const Field f = spread(g, kernel, x, force, 0.0);
      for (double eps : {-1e-13, 1e-13}) {
        std::vector<double> near = x;
        for (double &q : near) q += eps;
        EXPECT_LT(distance(spread(g, kernel, near, force, 0.0), f), 1e-11 * f.norm()) << place;
      }
      const Field expected = spread_by_definition(g, kernel, x, force);
      EXPECT_LT(distance(f, expected), 1e-12 * expected.norm()) << place;
    }
  });
}

// kT div S on the faces of component d equals kT d/dq_d of the field of a unit force along d.  The
// relative error of central differences is d^2 phi'''/(6 h^2) < 1e-8 (for the three-point kernel
// phi''' is up to 150 h^-3), plus 1e-16 h/d.
TEST(TypedSpread, DriftIsTheDivergenceOfS)
{
  for_all_scenes([](const Grid &g, IbKernel kernel) {
    const double kT = 0.37, step = 1e-5;
    const std::vector<double> x = random_positions(g, 6, 14), none(18, 0.0);
    Field expected(g);
    for (std::size_t i = 0; i < x.size(); ++i) {
      const int d = i % 3;
      if (d >= g.dim) continue;
      std::vector<double> up = x, down = x, unit(x.size(), 0.0);
      unit[i] = 1.0;
      up[i] += step;
      down[i] -= step;
      const Field a = spread(g, kernel, up, unit, 0.0), b = spread(g, kernel, down, unit, 0.0);
      for (int c = 0; c < g.dim; ++c)
        for (std::size_t p = 0; p < expected.c[c].size(); ++p)
          expected.c[c][p] += kT * (a.c[c][p] - b.c[c][p]) / (2.0 * step);
    }
    EXPECT_LT(distance(spread(g, kernel, x, none, kT), expected), 1e-7 * expected.norm());
    // Spreading force and drift in one pass gives the sum of spreading each.
    const std::vector<double> force = random_numbers(18, 15);
    const Field both = spread(g, kernel, x, force, kT), f = spread(g, kernel, x, force, 0.0);
    const Field drift = spread(g, kernel, x, none, kT);
    Field sum = f;
    for (int c = 0; c < g.dim; ++c)
      for (std::size_t p = 0; p < sum.c[c].size(); ++p) sum.c[c][p] += drift.c[c][p];
    EXPECT_LT(distance(both, sum), 1e-14 * (f.norm() + drift.norm()));
  });
}

// A uniform field is interpolated exactly.  So is a linear one away from the periodic seam, since
// the first moment is 0.
TEST(TypedInterpolation, IsExactForLinearFields)
{
  for (IbKernel kernel : all_kernels)
    for (const Grid &g : {make_grid({16, 15, 14}, {0.7}), make_grid({15, 16}, {0.7})}) {
      Field uniform(g), linear(g);
      for (long k = 0; k < g.n[2]; ++k)
        for (long j = 0; j < g.n[1]; ++j)
          for (long i = 0; i < g.n[0]; ++i)
            for (int d = 0; d < g.dim; ++d) {
              uniform.at(d, i, j, k) = 1.0 + d;
              const double px = (double(i) + (d == 0 ? 0.0 : 0.5)) * 0.7,
                           py = (double(j) + (d == 1 ? 0.0 : 0.5)) * 0.7;
              linear.at(d, i, j, k) = 2.0 * px - (1.0 + d) * py;
            }
      std::vector<double> x = random_positions(g, 10, 16, 0.3);
      const std::vector<double> u = interpolate(uniform, kernel, x),
                                v = interpolate(linear, kernel, x);
      for (std::size_t i = 0; i < 10; ++i)
        for (int d = 0; d < 3; ++d) {
          const double px = x[3 * i] - g.lo[0], py = x[3 * i + 1] - g.lo[1];
          EXPECT_NEAR(u[3 * i + d], d < g.dim ? 1.0 + d : 0.0, 1e-14);
          EXPECT_NEAR(v[3 * i + d], d < g.dim ? 2.0 * px - (1.0 + d) * py : 0.0, 5e-14);
        }
    }
}

// Slabs, each with every particle that touches it, add up to the whole grid.  first_lines() and
// reach() enclose all planes that a particle touches.
TEST(TypedSpread, SlabsAddUpToTheWhole)
{
  for_all_scenes([](const Grid &g, IbKernel kernel) {
    const long planes = g.n[g.slow_axis()], count = 25;
    const std::vector<double> x = random_positions(g, count, 17, 3.0),
                              force = random_numbers(75, 18);
    const Field v = random_field(g, 19), expected = spread(g, kernel, x, force, 0.3);
    const std::vector<double> expected_u = interpolate(v, kernel, x);
    for (long parts : {2L, 3L, planes}) {
      Field sum(g);
      std::vector<double> u(x.size(), 0.0);
      for (long p = 0; p < parts; ++p) {
        const Slab slab{p * planes / parts, (p + 1) * planes / parts - p * planes / parts};
        Part part(g, slab, kernel);
        std::vector<long> here;
        for (long i = 0; i < count; ++i) {
          bool touches = false;
          const long first = part.spreader.first_lines(x.data()).plane(i);
          for (long k = 0; k < part.spreader.reach(); ++k)
            touches |= slab.contains(wrap(first + k, planes));
          if (touches) here.push_back(i);
        }
        std::vector<double> my_x, my_force, my_u(3 * here.size());
        for (long i : here) {
          my_x.insert(my_x.end(), x.begin() + 3 * i, x.begin() + 3 * i + 3);
          my_force.insert(my_force.end(), force.begin() + 3 * i, force.begin() + 3 * i + 3);
        }
        part.spreader.bind(my_x.data(), bdh::ssize(here));
        part.spreader.spread(my_force.data(), 0.3, part.view());
        part.add_to(sum);
        part.load(v);
        part.spreader.interpolate(part.view(), my_u.data());
        for (std::size_t m = 0; m < here.size(); ++m)
          for (int d = 0; d < 3; ++d) u[3 * here[m] + d] += my_u[3 * m + d];
      }
      EXPECT_LT(distance(sum, expected), 1e-14 * expected.norm()) << parts;
      EXPECT_LT(difference(u, expected_u), 1e-14 * norm(expected_u)) << parts;
    }
  });
}

TEST(TypedSpread, NoParticlesIsFine)
{
  const Grid g = make_grid({8, 8, 8}, {1.0});
  EXPECT_EQ(spread(g, IbKernel::peskin4, {}, {}, 1.0).norm(), 0.0);
}
