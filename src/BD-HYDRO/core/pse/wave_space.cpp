// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
#include "pse/wave_space.h"

#include "base/bytes_of.h"
#include "base/constants.h"
#include "base/ssize.h"
#include "pse/wave_kernel.h"
#include "stokes/mode_strip.h"

#include <algorithm>
#include <cmath>

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
  const PseNoise &noise;
  WaveStrength strength;
  int shapes;    // that are used

  void solve_block(const ModeBlock<Real> &block) const;
  template <int used, int terms> void solve_strip(const ModeBlock<Real> &block, long row,
                                                  long first, long count, const Real *weight) const;
  void solve_term(int term, const std::array<long, dim> &n, long count, const double *root,
                  StripField<double> &v) const;
  void draw(int term, const std::array<long, dim> &n, long count,
            StripNormals<double> &normals) const;
};

template <class Real> void WaveSpace<Real>::Modes::solve_block(const ModeBlock<Real> &block) const
{
  {
    const std::lock_guard<std::mutex> lock(space.table_mutex_[block.y]);
    if (space.table_[block.y].empty()) space.fill_table(block.y);
  }
  const Real *table = space.table_[block.y].data();
  const auto solve = shapes == 1         ? &Modes::solve_strip<1, 1>
                     : space.terms_ == 1 ? &Modes::solve_strip<2, 1>
                                         : &Modes::solve_strip<2, 2>;
  for (long row = 0; row < block.rows; ++row) {
    const long nz = space.signed_index(row, 2);
    for (long first = 0; first < block.columns; first += strip) {
      const long count = std::min(strip, block.columns - first);
      const bool inside = std::labs(nz) <= space.most_[2] &&
                          block.first_x + first + padded(count) <= space.table_columns_;
      const Real *weight =
          inside ? table + (nz + space.most_[2]) * space.table_columns_ + block.first_x + first
                 : nullptr;
      const bool any =
          inside && std::any_of(weight, weight + count, [](Real w) { return w != Real(0); });
      if (any)
        (this->*solve)(block, row, first, count, weight);
      else
        for (int d = 0; d < dim * shapes; ++d)
          std::fill_n(block.f[d] + 2 * (row * block.columns + first), 2 * count, Real(0));
    }
  }
}

/// Normals of a term of the weight for the modes n, n + (1, 0, 0), ...
template <class Real> void WaveSpace<Real>::Modes::draw(int term, const std::array<long, dim> &n,
                                                        long count,
                                                        StripNormals<double> &normals) const
{
  for (auto &part : normals.z) std::fill_n(part, padded(count), 0.0);
  if (!noise.acts()) return;
  uint64_t first = wave_number(n[0], n[1], n[2]), own = drawn_wave(n[0], n[1], n[2]);
  if (term == 1) {
    first = common_draw(first);
    own = common_draw(own);
  }
  add_normals(
      noise.counter(Stream::wave_space), 1.0,
      [first, own](long i) { return i == 0 ? own : first + i; }, count, normals);
}

namespace {

/// The roots of a strip of modes in one term: of either shape.
template <class Real> struct StripRoots {
  const Real *first, *second;
};

/// force := the field of a single shape, or those of two, each with its root.  fields: of each
/// shape and component, complex numbers.
template <int used, class Real> void add_up_shapes(const Real *const *fields,
                                                   const StripRoots<Real> &root, long count,
                                                   StripField<double> &force)
{
  for (int d = 0; d < dim; ++d)
    for (long i = 0; i < count; ++i) {
      force.re[d][i] = fields[d][2 * i];
      force.im[d][i] = fields[d][2 * i + 1];
    }
  if constexpr (used == 2)
    for (int d = 0; d < dim; ++d)
      for (long i = 0; i < count; ++i) {
        force.re[d][i] = root.first[i] * force.re[d][i] + root.second[i] * fields[dim + d][2 * i];
        force.im[d][i] =
            root.first[i] * force.im[d][i] + root.second[i] * fields[dim + d][2 * i + 1];
      }
}

/// The adjoint: fields := the velocities of all terms as a single shape reads them, or each of two.
template <int used, int terms, class Real> void give_to_shapes(const StripField<double> *velocity,
                                                               const StripRoots<Real> *root,
                                                               long count, Real *const *fields)
{
  for (int d = 0; d < dim; ++d)
    for (long i = 0; i < count; ++i) {
      double first[2] = {}, second[2] = {};
      for (int term = 0; term < terms; ++term) {
        const double re = velocity[term].re[d][i], im = velocity[term].im[d][i];
        const double r = used == 1 ? 1.0 : root[term].first[i];
        first[0] += r * re;
        first[1] += r * im;
        second[0] += root[term].second[i] * re;
        second[1] += root[term].second[i] * im;
      }
      fields[d][2 * i] = first[0];
      fields[d][2 * i + 1] = first[1];
      if constexpr (used == 2) {
        fields[dim + d][2 * i] = second[0];
        fields[dim + d][2 * i + 1] = second[1];
      }
    }
}

}    // namespace

/// Several shapes: their fields, each with its root, add up to one force for each term of the
/// weight, whose velocity all of them read with the same roots.
template <class Real> template <int used, int terms>
void WaveSpace<Real>::Modes::solve_strip(const ModeBlock<Real> &block, long row, long first,
                                         long count, const Real *weight) const
{
  const long next = (2 * space.most_[2] + 1) * space.table_columns_;
  const StripRoots<Real> roots[2] = {{weight, weight + (used - 1) * next},
                                     {weight + 2 * next, weight + 2 * next}};
  Real *f[dim * used];
  for (int d = 0; d < dim * used; ++d) f[d] = block.f[d] + 2 * (row * block.columns + first);
  StripField<double> v[terms];
  for (int term = 0; term < terms; ++term) {
    add_up_shapes<used>(f, roots[term], count, v[term]);
    // Of a single shape the root of the whole weight, of two the modes that are kept.
    alignas(64) double root[strip];
    const Real *const own = roots[term].first, *const other = roots[term].second;
    for (long i = 0; i < padded(count); ++i)
      root[i] = used == 1 ? double(own[i]) : own[i] != Real(0) || other[i] != Real(0) ? 1.0 : 0.0;
    if (used == 1 && space.terms_ == 2)
      for (long i = 0; i < padded(count); ++i)
        root[i] = std::sqrt(root[i] * root[i] + double(roots[1].first[i]) * roots[1].first[i]);
    solve_term(term,
               {block.first_x + first, space.signed_index(block.y, 1), space.signed_index(row, 2)},
               count, root, v[term]);
  }
  give_to_shapes<used, terms>(v, roots, count, f);
}

/// Velocities of the modes n, n + (1, 0, 0), ... by their forces.
template <class Real>
void WaveSpace<Real>::Modes::solve_term(int term, const std::array<long, dim> &n, long count,
                                        const double *root, StripField<double> &v) const
{
  StripNormals<double> normals;
  draw(term, n, count, normals);
  const bool conjugate = is_conjugate(n[0], n[1], n[2]);
  double k0[dim], dk[dim];
  space.cell_.wave_vector(n[0], n[1], n[2], k0);
  space.cell_.wave_vector(1.0, 0.0, 0.0, dk);
  BDH_INDEPENDENT
  for (long i = 0; i < count; ++i) {
    const double t = i;
    const Wave wave{
        {k0[0] + t * dk[0], k0[1] + t * dk[1], k0[2] + t * dk[2]}, conjugate && i == 0, root[i]};
    const double z[4] = {normals.z[0][i], normals.z[1][i], normals.z[2][i], normals.z[3][i]};
    double re[dim] = {v.re[0][i], v.re[1][i], v.re[2][i]},
           im[dim] = {v.im[0][i], v.im[1][i], v.im[2][i]};
    solve_wave(wave, strength, z, re, im);
    for (int d = 0; d < dim; ++d) {
      v.re[d][i] = re[d];
      v.im[d][i] = im[d];
    }
  }
}

static std::array<std::array<double, dim>, dim> axes_of(const Cell &cell, const Grid &grid)
{
  std::array<std::array<double, dim>, dim> axes;
  for (int d = 0; d < dim; ++d) gradient_of_spacings(cell, d, grid.n[d], axes[d].data());
  return axes;
}

template <class Real> WaveSpace<Real>::WaveSpace(const PsePlan &plan, const Comm &comm,
                                                 FftEffort effort, const Workers &workers) :
    plan_(plan),
    comm_(comm), workers_(workers),
    grid_(fractional_grid(plan.n)), most_{(plan.n[0] - 1) / 2, (plan.n[1] - 1) / 2,
                                          (plan.n[2] - 1) / 2},
    plain_(plan.is_plain()), shapes_(plan.basis().single() ? 1 : 2),
    terms_(plan.wave_weight().two_terms() ? 2 : 1),
    fft_(grid_, comm, effort, KeptModes{most_[0], most_[1]}, workers, shapes_),
    spreader_(plan.n, fft_.slab(), plan.window, plan.window_error, workers),
    positions_(comm, plan.n[2], dim), exchange_(positions_, plain_ ? dof : SphereLoads::size(plan)),
    table_(plan.n[1]), table_mutex_(new std::mutex[plan.n[1]]),
    table_columns_(padded(grid_.half()) + strip)
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
  for (auto &rows : table_) rows.clear();
  keep_columns();
}

template <class Real> void WaveSpace<Real>::set_radii(const PsePlan &plan)
{
  plan_.radius = plan.radius;
  plan_.least_radius = plan.least_radius;
  for (auto &rows : table_) rows.clear();
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
  const long ny = signed_index(y, 1), rows = 2 * most_[2] + 1;
  AlignedArray<Real> &table = table_[y];
  const long shape = rows * table_columns_;
  table.assign((shapes_ + terms_ - 1) * shape, Real(0));
  if (std::labs(ny) > most_[1]) return;
  const double limit = plan_.k_cut * plan_.k_cut;
  const ShapeBasis basis = plan_.basis();
  const WaveWeight weight = plan_.wave_weight();
  for (long nz = -most_[2]; nz <= most_[2]; ++nz)
    for (long nx = 0; nx <= most_[0]; ++nx) {
      double k[dim];
      cell_.wave_vector(nx, ny, nz, k);
      const double k2 = k[0] * k[0] + k[1] * k[1] + k[2] * k[2];
      if (k2 > limit || (nx == 0 && ny == 0 && nz == 0)) continue;
      const double length = std::sqrt(k2);
      const double window = deconvolution_[0][nx] * deconvolution_[1][std::labs(ny)] *
                            deconvolution_[2][std::labs(nz)];
      Real *at = &table[(nz + most_[2]) * table_columns_ + nx];
      at[0] = weight.root(length, basis.b1) * window;
      if (shapes_ == 2) at[shape] = weight.root(length, basis.b2) * window;
      if (terms_ == 2) at[2 * shape] = weight.common_root(length) * window;
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
  // first_plane() requires them; on one rank bind() does the same.
  if (comm_.size() > 1) check_positions(grid_, fractional_.data(), n);
  positions_.plan(
      n, [this](long i) { return spreader_.first_plane(fractional_[dim * i + 2]); },
      spreader_.plane_reach());
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
      *this, noise, {1.0 / resistance, std::sqrt(noise.variance / resistance)}, shapes};
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
  return fft_.memory() + bytes_of(field_, table_);
}

template <class Real> std::size_t WaveSpace<Real>::particle_memory() const
{
  return spreader_.memory() + positions_.memory() + exchange_.memory() + bytes_of(fractional_) +
         loads_.memory();
}

template class WaveSpace<float>;
template class WaveSpace<double>;

}    // namespace bdh
