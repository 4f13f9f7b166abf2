// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
#include "pse/wave_space.h"

#include "base/bytes_of.h"
#include "base/constants.h"
#include "base/ssize.h"
#include "pse/wave_strip.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace bdh {

std::vector<double> inverse_window(const Window &window, long n)
{
  std::vector<double> inverse;
  for (long i = 0; i <= (n - 1) / 2; ++i) inverse.push_back(1.0 / window.transform(two_pi * i / n));
  return inverse;
}

bool grid_fits(const PsePlan &plan, const Cell &cell)
{
  const std::array<double, dim> edge{cell.edge(0), cell.edge(1), cell.edge(2)};
  const std::array<long, dim> most = pse_largest_index(plan.k_cut, edge);
  for (int d = 0; d < dim; ++d)
    if (most[d] > (plan.n[d] - 1) / 2 || edge[d] > plan.spacing * plan.n[d] * (1.0 + 1e-9))
      return false;
  return true;
}

static_assert(dof == dim, "one component of the field carries one number of each particle");

/// The work on the modes of one evaluation.
template <class Real> struct WaveSpace<Real>::Modes {
  WaveSpace &space;
  WaveWork work;
  int shapes;    // that are used

  void solve_block(const ModeBlock<Real> &block) const;
  template <int used, int terms>
  void solve_rows(const ModeBlock<Real> &block, const WaveTable<Real> &table) const;
  template <class Strip> void append(const ModeBlock<Real> &block, const WaveTable<Real> &table,
                                     long row, long begin, long end, Strip &modes) const;
};

template <class Real> void WaveSpace<Real>::Modes::solve_block(const ModeBlock<Real> &block) const
{
  WaveTable<Real> &table = space.table_[block.y];
  {
    const std::lock_guard<std::mutex> lock(space.table_mutex_[block.y]);
    if (table.kept.empty()) space.fill_table(block.y);
  }
  if (shapes == 1)
    solve_rows<1, 1>(block, table);
  else if (space.terms_ == 1)
    solve_rows<2, 1>(block, table);
  else
    solve_rows<2, 2>(block, table);
}

template <class Real> template <int used, int terms> void
WaveSpace<Real>::Modes::solve_rows(const ModeBlock<Real> &block, const WaveTable<Real> &table) const
{
  WaveStrip<Real, used, terms> modes(block, work);
  for (long row = 0; row < block.rows; ++row) {
    const long nz = space.signed_index(row, 2);
    std::array<long, 2> kept{};
    if (std::labs(nz) <= space.most_[2]) kept = table.kept[nz + space.most_[2]];
    const auto in_block = [&](long x) { return std::clamp(x - block.first_x, 0L, block.columns); };
    const long begin = in_block(kept[0]), end = std::max(begin, in_block(kept[1]));
    for (int d = 0; d < dim * used; ++d) {
      Real *const first = block.f[d] + 2 * row * block.columns;
      std::fill_n(first, 2 * begin, Real(0));
      std::fill_n(first + 2 * end, 2 * (block.columns - end), Real(0));
    }
    append(block, table, row, begin, end, modes);
  }
  modes.solve();
}

/// Adds modes of a row to those that wait, and solves these whenever there are enough.
template <class Real> template <class Strip>
void WaveSpace<Real>::Modes::append(const ModeBlock<Real> &block, const WaveTable<Real> &table,
                                    long row, long begin, long end, Strip &modes) const
{
  const long ny = space.signed_index(block.y, 1), nz = space.signed_index(row, 2);
  WaveRow<Real> part;
  space.cell_.wave_vector(1.0, 0.0, 0.0, part.dk);
  while (begin < end) {
    const long count = std::min(end - begin, modes.room());
    const std::array<long, dim> n{block.first_x + begin, ny, nz};
    part.place = row * block.columns + begin;
    std::copy_n(n.data(), dim, part.n);
    space.cell_.wave_vector(n[0], n[1], n[2], part.k);
    const long at = (nz + space.most_[2]) * (space.most_[0] + 1) + n[0];
    for (std::size_t r = 0; r < std::size(part.root); ++r)
      part.root[r] = table.root[r].empty() ? nullptr : table.root[r].data() + at;
    modes.append(part, count);
    if (modes.room() == 0) modes.solve();
    begin += count;
  }
}

static std::array<std::array<double, dim>, dim> axes_of(const Cell &cell, const Grid &grid)
{
  std::array<std::array<double, dim>, dim> axes;
  for (int d = 0; d < dim; ++d) gradient_of_spacings(cell, d, grid.n[d], axes[d].data());
  return axes;
}

template <class Real> WaveSpace<Real>::WaveSpace(const PsePlan &plan, const Comm &comm,
                                                 const FftSetup &setup, const Workers &workers) :
    plan_(plan),
    comm_(comm), workers_(workers),
    grid_(fractional_grid(plan.n)), most_{(plan.n[0] - 1) / 2, (plan.n[1] - 1) / 2,
                                          (plan.n[2] - 1) / 2},
    plain_(plan.is_plain()), shapes_(plan.basis().single() ? 1 : 2),
    terms_(plan.wave_weight().two_terms() ? 2 : 1),
    fft_(grid_, comm, setup, KeptModes{most_[0], most_[1]}, workers, shapes_),
    spreader_(plan.n, fft_.slab(), plan.window, plan.window_error, workers),
    positions_(fft_.parts(), dim), exchange_(positions_, plain_ ? dof : SphereLoads::size(plan)),
    table_(plan.n[1]), table_mutex_(new std::mutex[plan.n[1]])
{
  for (int d = 0; d < dim * shapes_; ++d) field_[d].resize(fft_.allocation());
  for (int d = 0; d < dim; ++d) deconvolution_[d] = inverse_window(plan.window, plan.n[d]);
}

template <class Real> void WaveSpace<Real>::set_cell(const Cell &cell)
{
  const bool same_shape = has_cell_ && cell.lx == cell_.lx && cell.ly == cell_.ly &&
                          cell.lz == cell_.lz && cell.xy == cell_.xy && cell.xz == cell_.xz &&
                          cell.yz == cell_.yz;
  cell_ = cell;
  has_cell_ = true;
  if (same_shape) return;
  for (auto &rows : table_) rows.kept.clear();
  keep_columns();
}

template <class Real> void WaveSpace<Real>::set_radii(const PsePlan &plan)
{
  plan_.radius = plan.radius;
  plan_.least_radius = plan.least_radius;
  for (auto &rows : table_) rows.kept.clear();
}

/// Keeps, in each row of y, the columns up to the largest x with a mode inside k_cut.
template <class Real> void WaveSpace<Real>::keep_columns()
{
  std::vector<long> columns;
  double dk[dim], k[dim];
  cell_.wave_vector(1.0, 0.0, 0.0, dk);
  const double a = dk[0] * dk[0] + dk[1] * dk[1] + dk[2] * dk[2];
  for (long y = 0; y < grid_.n[1]; ++y) {
    const long ny = signed_index(y, 1);
    long most = -1;
    for (long nz = -most_[2]; nz <= most_[2] && std::labs(ny) <= most_[1]; ++nz) {
      cell_.wave_vector(0.0, ny, nz, k);
      // |k + x dk| = k_cut
      const double b = k[0] * dk[0] + k[1] * dk[1] + k[2] * dk[2];
      const double c = k[0] * k[0] + k[1] * k[1] + k[2] * k[2] - plan_.k_cut * plan_.k_cut;
      const double discriminant = b * b - a * c;
      if (discriminant >= 0.0)
        most = std::max<long>(most, std::floor((std::sqrt(discriminant) - b) / a));
    }
    columns.push_back(std::min(most, most_[0]) + 1);
  }
  fft_.keep(columns);
}

template <class Real> void WaveSpace<Real>::fill_table(long y)
{
  const long ny = signed_index(y, 1), rows = 2 * most_[2] + 1, columns = most_[0] + 1;
  WaveTable<Real> &table = table_[y];
  table.kept.assign(rows, {0, 0});
  for (int r = 0; r < shapes_ + terms_ - 1; ++r) table.root[r].assign(rows * columns, Real(0));
  if (std::labs(ny) > most_[1]) return;
  const double limit = plan_.k_cut * plan_.k_cut;
  const ShapeBasis basis = plan_.basis();
  const WaveWeight weight = plan_.wave_weight();
  for (long row = 0; row < rows; ++row)
    for (long nx = 0; nx < columns; ++nx) {
      const long nz = row - most_[2];
      double k[dim];
      cell_.wave_vector(nx, ny, nz, k);
      const double k2 = k[0] * k[0] + k[1] * k[1] + k[2] * k[2];
      if (k2 > limit || (nx == 0 && ny == 0 && nz == 0)) continue;
      std::array<long, 2> &kept = table.kept[row];
      if (kept[1] == 0) kept[0] = nx;
      kept[1] = nx + 1;
      const double length = std::sqrt(k2);
      const double window = deconvolution_[0][nx] * deconvolution_[1][std::labs(ny)] *
                            deconvolution_[2][std::labs(nz)];
      const long at = row * columns + nx;
      table.root[0][at] = weight.root(length, basis.b1) * window;
      if (shapes_ == 2) table.root[1][at] = weight.root(length, basis.b2) * window;
      if (terms_ == 2) table.root[2][at] = weight.common_root(length) * window;
    }
}

template <class Real> void WaveSpace<Real>::bind(const double *x, long n)
{
  const PhaseScope phase(Phase::spread);
  fractional_.resize(dim * n);
  workers_.for_ranges(n, [&](long begin, long end) {
    for (long i = begin; i < end; ++i)
      cell_.to_fractional(x + dim * i, fractional_.data() + dim * i);
  });
  // first_line() requires them; on one rank bind() does the same.
  if (comm_.size() > 1) check_positions(grid_, fractional_.data(), n);
  const auto first = [this](int axis) {
    return [this, axis](long i) { return spreader_.first_line(axis, fractional_[dim * i + axis]); };
  };
  positions_.plan(n, FirstLines{first(2), first(1)}, spreader_.reach());
  spreader_.bind(positions_.bring(fractional_.data()), positions_.count());
}

template <class Real> void WaveSpace<Real>::apply(const PseForces &forces, const PseNoise &noise,
                                                  double viscosity, const PseVelocities &velocity)
{
  if (!plain_) loads_.pack(plan_, radius_, forces, ssize(fractional_) / dim, workers_);
  const double *const loads = plain_ ? forces.values : exchange_.bring(loads_.packed());
  if (forces.act) spread(loads, shapes_);
  transform(forces, noise, viscosity, shapes_);
  interpolate(loads, velocity, shapes_);
}

template <class Real> void WaveSpace<Real>::apply_stresslets(const PseForces &forces,
                                                             double viscosity,
                                                             const PseVelocities &velocity)
{
  // The second shape then is that of forces alone.
  if (plan_.least_radius != plan_.radius) return apply(forces, {}, viscosity, velocity);
  loads_.pack(plan_, radius_, forces, ssize(fractional_) / dim, workers_);
  const double *const loads = exchange_.bring(loads_.packed());
  spread(loads, 1);
  transform(forces, {}, viscosity, 1);
  interpolate(loads, velocity, 1);
}

template <class Real> std::array<Real *, 2 * dim> WaveSpace<Real>::fields()
{
  std::array<Real *, 2 * dim> all;
  for (int d = 0; d < 2 * dim; ++d) all[d] = field_[d].data();
  return all;
}

template <class Real> std::array<Real *, dim> WaveSpace<Real>::view()
{
  return {field_[0].data(), field_[1].data(), field_[2].data()};
}

/// loads: of the spheres that touch this slab, or the forces on this rank's particles.
template <class Real> void WaveSpace<Real>::spread(const double *loads, int shapes)
{
  const PhaseScope phase(Phase::spread);
  for (int d = 0; d < dim * shapes; ++d) {
    Real *to = field_[d].data();
    if (fft_.parts().pencils())
      fft_.parts().clear(to);
    else
      workers_.for_ranges(ssize(field_[d]),
                          [to](long begin, long end) { std::fill(to + begin, to + end, Real(0)); });
  }
  const auto axes = axes_of(cell_, grid_);
  if (plain_)
    spreader_.WindowSpreader<Real>::spread(exchange_.bring(loads), view());
  else if (shapes == 1)
    spreader_.spread(loads, plan_.moments(), axes, view());
  else
    spreader_.spread(loads, plan_.moments(), axes, fields());
}

template <class Real> void WaveSpace<Real>::transform(const PseForces &forces,
                                                      const PseNoise &noise, double viscosity,
                                                      int shapes)
{
  const PhaseScope phase(Phase::transform);
  const double resistance = viscosity * cell_.volume();
  const Modes modes{
      *this, {{1.0 / resistance, std::sqrt(noise.variance / resistance)}, noise}, shapes};
  const Input input = forces.act ? Input::field : Input::zero;
  const auto solve = [&](const ModeBlock<Real> &block) { modes.solve_block(block); };
  if (shapes > 1)
    fft_.solve(fields(), solve, input);
  else
    fft_.solve(view(), solve, input);
}

template <class Real>
void WaveSpace<Real>::interpolate(const double *loads, const PseVelocities &velocity, int shapes)
{
  const PhaseScope phase(Phase::interpolate);
  if (plain_) {
    spreader_.WindowSpreader<Real>::interpolate(view(), exchange_.parts(velocity.linear));
    exchange_.take_back(velocity.linear);
    return;
  }
  double *const motions = loads_.motions();
  const auto gather = [&](const auto &all) {
    spreader_.interpolate(all, plan_.moments(), axes_of(cell_, grid_), loads,
                          exchange_.parts(motions));
  };
  shapes == 1 ? gather(view()) : gather(fields());
  exchange_.take_back(motions);
  loads_.unpack(velocity, workers_);
}

template <class Real> std::size_t WaveSpace<Real>::grid_memory() const
{
  std::size_t bytes = fft_.memory() + bytes_of(field_);
  for (const WaveTable<Real> &rows : table_) bytes += bytes_of(rows.kept, rows.root);
  return bytes;
}

template <class Real> std::size_t WaveSpace<Real>::particle_memory() const
{
  return spreader_.memory() + positions_.memory() + exchange_.memory() + bytes_of(fractional_) +
         loads_.memory();
}

template class WaveSpace<float>;
template class WaveSpace<double>;

}    // namespace bdh
