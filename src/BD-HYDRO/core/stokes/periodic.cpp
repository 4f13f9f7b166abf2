// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
#include "stokes/periodic.h"

#include "stokes/noise.h"

#include <algorithm>
#include <cmath>

namespace bdh {

namespace {

/// The symbols of one axis over a strip: along the axis, across it, and in any order.
template <class Real> struct Along {
  const Real *s, *cos_half, *sin_half;
  Along(const AxisTable<Real> &t, long first) :
      s(t.s.data() + first), cos_half(t.cos_half.data() + first),
      sin_half(t.sin_half.data() + first)
  {}
  AxisSymbolOf<Real> operator[](long i) const { return {s[i], cos_half[i], sin_half[i]}; }
};
template <class Real> struct Across {
  AxisSymbolOf<Real> symbol;
  AxisSymbolOf<Real> operator[](long) const { return symbol; }
};
template <class Real> struct Listed {
  alignas(64) Real s[strip], cos_half[strip], sin_half[strip];
  AxisSymbolOf<Real> operator[](long i) const { return {s[i], cos_half[i], sin_half[i]}; }
  void set(long i, const AxisSymbolOf<Real> &a)
  {
    s[i] = a.s;
    cos_half[i] = a.cos_half;
    sin_half[i] = a.sin_half;
  }
};

/// Replaces the force f in the modes of a strip by the velocity.
template <int D, class Real, class X, class Y, class Z>
void solve_strip(const X &x, const Y &y, const Z &z, long count, Real response, Real amplitude,
                 const StripNormals<Real> &normals, StripField<Real> &f)
{
  BDH_INDEPENDENT
  for (long i = 0; i < count; ++i) {
    const AxisSymbolOf<Real> axis[3] = {x[i], y[i], z[i]};
    const Real n[4] = {normals.z[0][i], normals.z[1][i], normals.z[2][i], normals.z[3][i]};
    Real re[3] = {f.re[0][i], f.re[1][i], f.re[2][i]}, im[3] = {f.im[0][i], f.im[1][i], f.im[2][i]};
    solve_mode<D>(axis, response, amplitude, n, re, im);
    for (int d = 0; d < D; ++d) {
      f.re[d][i] = re[d];
      f.im[d][i] = im[d];
    }
  }
}

}    // namespace

/// Solves for the modes of one problem, block by block.
template <class Real> struct PeriodicStokes<Real>::Modes {
  const Grid &grid;
  const std::array<AxisTable<Real>, 3> &symbol;
  const StokesProblem &problem;
  Real response, amplitude;

  uint64_t index(long kx, long ky, long kz) const { return mode_number(grid.n.data(), kx, ky, kz); }
  bool is_edge(long kx) const { return is_edge_column(grid.n.data(), kx); }

  template <int D> void solve_block(const ModeBlock<Real> &block) const;
  template <int D>
  void solve_row(const ModeBlock<Real> &block, long row, long begin, long end) const;
  template <int D> void solve_column(const ModeBlock<Real> &block, long column) const;
  template <int D>
  void add_column_noise(long kx, long y, long first, long count, StripField<Real> &v) const;
};

/// Goes along rows where each mode also stands for its conjugate.  It goes along columns at the
/// edges of the half space, and where rows are too short.
template <class Real> template <int D>
void PeriodicStokes<Real>::Modes::solve_block(const ModeBlock<Real> &block) const
{
  long begin = 0, end = block.columns;
  if (is_edge(block.first_x)) ++begin;
  if (end > begin && is_edge(block.first_x + end - 1)) --end;
  if (end - begin < lanes) end = begin;
  for (long row = 0; row < block.rows; ++row)
    for (long first = begin; first < end; first += strip)
      solve_row<D>(block, row, first, std::min(first + strip, end));
  for (long column = 0; column < block.columns; ++column)
    if (column < begin || column >= end) solve_column<D>(block, column);
}

template <class Real> template <int D>
void PeriodicStokes<Real>::Modes::solve_row(const ModeBlock<Real> &block, long row, long begin,
                                            long end) const
{
  const long count = end - begin, kx = block.first_x + begin, ky = D == 3 ? block.y : row,
             kz = D == 3 ? row : 0;
  Real *f[D];
  for (int d = 0; d < D; ++d) f[d] = block.f[d] + 2 * (row * block.columns + begin);

  StripNormals<Real> normals;
  const uint64_t first = index(kx, ky, kz);
  draw_strip(
      problem, [first](long i) { return first + i; }, count, normals);
  StripField<Real> v;
  for (int d = 0; d < D; ++d)
    for (long i = 0; i < count; ++i) {
      v.re[d][i] = f[d][2 * i];
      v.im[d][i] = f[d][2 * i + 1];
    }
  solve_strip<D>(Along<Real>(symbol[0], kx), Across<Real>{symbol[1][ky]},
                 Across<Real>{symbol[2][kz]}, padded(count), response, amplitude, normals, v);
  for (int d = 0; d < D; ++d)
    for (long i = 0; i < count; ++i) {
      f[d][2 * i] = v.re[d][i];
      f[d][2 * i + 1] = v.im[d][i];
    }
}

/// Takes strips along the slow axis: z, or y in 2D.
template <class Real> template <int D>
void PeriodicStokes<Real>::Modes::solve_column(const ModeBlock<Real> &block, long column) const
{
  const long kx = block.first_x + column, step = 2 * block.columns;
  const Across<Real> x{symbol[0][kx]}, y{symbol[1][block.y]};
  StripNormals<Real> no_normals{};
  StripField<Real> v;
  for (long first = 0; first < block.rows; first += strip) {
    const long count = std::min(strip, block.rows - first);
    Real *f[D];
    for (int d = 0; d < D; ++d) {
      f[d] = block.f[d] + first * step + 2 * column;
      for (long i = 0; i < count; ++i) {
        v.re[d][i] = f[d][i * step];
        v.im[d][i] = f[d][i * step + 1];
      }
    }
    const Along<Real> slow(symbol[D - 1], first);
    if (D == 3)
      solve_strip<D>(x, y, slow, padded(count), response, Real(0), no_normals, v);
    else
      solve_strip<D>(x, slow, y, padded(count), response, Real(0), no_normals, v);
    if (problem.noisy()) add_column_noise<D>(kx, block.y, first, count, v);
    for (int d = 0; d < D; ++d)
      for (long i = 0; i < count; ++i) {
        f[d][i * step] = v.re[d][i];
        f[d][i * step + 1] = v.im[d][i];
      }
  }
}

template <class Real> template <int D>
void PeriodicStokes<Real>::Modes::add_column_noise(long kx, long y, long first, long count,
                                                   StripField<Real> &v) const
{
  DrawnMode draw[strip];
  for (long i = 0; i < count; ++i) {
    const long k[3] = {kx, D == 3 ? y : first + i, D == 3 ? first + i : 0};
    draw[i] = drawn_mode(grid.n.data(), k);
  }
  StripNormals<Real> normals;
  draw_strip(
      problem, [&](long i) { return draw[std::min(i, count - 1)].number; }, count, normals);
  Listed<Real> axis[3];
  for (long i = 0; i < count; ++i) {
    AxisSymbolOf<Real> a[3];
    for (int d = 0; d < 3; ++d) a[d] = symbol[d][draw[i].k[d]];
    Real z[4] = {normals.z[0][i], normals.z[1][i], normals.z[2][i], normals.z[3][i]};
    prepare_draw(draw[i].role, a, z);
    for (int d = 0; d < 3; ++d) axis[d].set(i, a[d]);
    for (int m = 0; m < 4; ++m) normals.z[m][i] = z[m];
  }
  StripField<Real> noise{};
  solve_strip<D>(axis[0], axis[1], axis[2], count, Real(0), amplitude, normals, noise);
  for (int d = 0; d < D; ++d)
    for (long i = 0; i < count; ++i) {
      v.re[d][i] += noise.re[d][i];
      v.im[d][i] += draw[i].role == DrawnMode::conjugate ? -noise.im[d][i] : noise.im[d][i];
    }
}

template <class Real>
PeriodicStokes<Real>::PeriodicStokes(const Grid &grid, const Comm &comm, const FftSetup &setup,
                                     const Workers &workers) :
    grid_(grid),
    fft_(grid, comm, setup, workers)
{
  for (int d = 0; d < 3; ++d) {
    AxisTable<Real> &t = symbol_[d];
    // The table is longer than the axis because strips are rounded up.
    const std::size_t size = grid.n[d] + lanes;
    for (std::size_t i = 0; i < size; ++i) {
      const AxisSymbol a = axis_symbol(i, grid.n[d], grid.h(d));
      t.s.push_back(a.s);
      t.cos_half.push_back(a.cos_half);
      t.sin_half.push_back(a.sin_half);
    }
  }
}

template <class Real>
SolveReport PeriodicStokes<Real>::solve(const FieldOf<Real> &field, const StokesProblem &problem)
{
  const double cells = grid_.cells();
  const double response = 1.0 / (problem.viscosity * cells);
  const double amplitude =
      std::sqrt(2.0 * problem.kT_over_dt / (problem.viscosity * grid_.cell_volume() * cells));
  const Modes modes{grid_, symbol_, problem, Real(response), Real(amplitude)};
  fft_.solve(field, [&](const ModeBlock<Real> &block) {
    grid_.dim == 3 ? modes.template solve_block<3>(block) : modes.template solve_block<2>(block);
  });
  return {};
}

template class PeriodicStokes<float>;
template class PeriodicStokes<double>;

}    // namespace bdh
