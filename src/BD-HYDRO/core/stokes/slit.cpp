// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
#include "stokes/slit.h"

#include "base/bytes_of.h"
#include "stokes/noise.h"

#include <algorithm>
#include <cmath>

namespace bdh {

namespace {

/// Number of modes solved together.  Their lines, nine numbers each, fit the second-level cache.
constexpr long width = 16;

}    // namespace

SlitChannel slit_channel(const Grid &grid, const StokesProblem &problem)
{
  const int across = grid.slow_axis();
  const auto &walls = grid.boundary[across];
  SlitChannel c{};
  c.n[0] = grid.n[0];
  c.n[1] = grid.dim == 3 ? grid.n[1] : 1;
  c.h_along[0] = grid.h(0);
  c.h_along[1] = grid.dim == 3 ? grid.h(1) : 1.0;
  c.rows = grid.n[across];
  c.h = grid.h(across);
  c.lower = walls[0];
  c.upper = walls[1];
  c.viscosity = problem.viscosity;
  c.area = c.points() * grid.cell_volume() / c.h;
  c.response = 1.0 / (problem.viscosity * c.points());
  if (problem.noisy())
    c.amplitude =
        std::sqrt(2.0 * problem.kT_over_dt / (problem.viscosity * grid.cell_volume() * c.points()));
  return c;
}

/// Buffers for the lines of one strip, row by row.
template <class Real> struct SlitStokes<Real>::Work {
  AlignedArray<ComplexLanes<width>> transverse, normal;
  AlignedArray<Lanes<width>> transverse_inv_d, inv_d, l1;

  explicit Work(long rows) :
      transverse(rows), normal(transverse.size()), transverse_inv_d(normal.size()),
      inv_d(normal.size()), l1(normal.size())
  {}
  std::size_t memory() const { return bytes_of(transverse, normal, transverse_inv_d, inv_d, l1); }
};

/// Modes first .. first + count - 1 of a block, in the form that solve_slit_modes() requires.
template <class Real> template <int D> class SlitStokes<Real>::Strip {
 public:
  Strip(const SlitChannel &channel, const StokesProblem &problem, const ModeBlock<Real> &block,
        Work &work, long first, long count) :
      channel_(channel),
      problem_(problem), block_(block), work_(work), first_(first), count_(count)
  {
    for (long i = 0; i < width; ++i) draw_[i] = slit_draw(channel, kx(i), block.y);
  }
  SlitModes<width> modes() const
  {
    SlitModes<width> m(channel_, block_.y);
    for (long i = 0; i < width; ++i) m.set(channel_, i, kx(i));
    return m;
  }

  void load(long row, ComplexLanes<width> *u) const
  {
    for (int d = 0; d < D; ++d) {
      const Real *const f = at(d, row);
      for_lanes([&](long i) {
        u[d].re[i] = f[2 * i];
        u[d].im[i] = f[2 * i + 1];
      });
      for (long i = count_; i < width; ++i) u[d].re[i] = u[d].im[i] = 0.0;
    }
  }
  void store(long row, const ComplexLanes<width> *u) const
  {
    for (int d = 0; d < D; ++d) {
      Real *const f = at(d, row);
      for_lanes([&](long i) {
        f[2 * i] = u[d].re[i];
        f[2 * i + 1] = u[d].im[i];
      });
    }
  }
  const StripNormals<Real> &normals(long row)
  {
    if (!problem_.noisy()) return z_;
    const uint64_t before = channel_.draw_row(row) * channel_.modes();
    draw_strip(
        problem_, [this, before](long i) { return before + draw_[i]; }, width, z_);
    make_real(0);
    if (count_ > 1) make_real(count_ - 1);
    return z_;
  }
  ComplexLanes<width> &normal(long row) { return work_.normal[row]; }
  ComplexLanes<width> &transverse(long row) { return work_.transverse[row]; }
  Lanes<width> &l1(long row) { return work_.l1[row]; }
  Lanes<width> &inv_d(long row) { return work_.inv_d[row]; }
  Lanes<width> &transverse_inv_d(long row) { return work_.transverse_inv_d[row]; }

 private:
  /// k_x of lane i.  Lanes without a mode of their own repeat the last one.
  long kx(long i) const { return block_.first_x + first_ + std::min(i, count_ - 1); }
  /// The fixed length of a full strip lets the compiler keep everything in vector registers.
  template <class Action> void for_lanes(const Action &action) const
  {
    if (count_ == width)
      for (long i = 0; i < width; ++i) action(i);
    else
      for (long i = 0; i < count_; ++i) action(i);
  }
  void make_real(long i)
  {
    make_edge_real(channel_, kx(i), block_.y, z_.z[0][i], z_.z[1][i], z_.z[2][i], z_.z[3][i]);
  }
  Real *at(int d, long row) const
  {
    return block_.f[d] + 2 * (channel_.stored_row(d == D - 1, row) * block_.columns + first_);
  }

  const SlitChannel &channel_;
  const StokesProblem &problem_;
  const ModeBlock<Real> &block_;
  Work &work_;
  const long first_, count_;
  uint64_t draw_[width];
  StripNormals<Real> z_{};
};

/// Solves for the mean mode.  `mode` has the complex numbers of each component, row by row, as the
/// grid has them.
template <class Real> template <int D>
void SlitStokes<Real>::solve_mean(const SlitChannel &channel, const StokesProblem &problem,
                                  std::array<std::vector<double>, D> &mode, WallVectors &wall_force)
{
  StripNormals<Real> z;
  for (std::size_t d = 0; d < D; ++d) {
    double &lower = wall_force[D - 1][0][d], &upper = wall_force[D - 1][1][d];
    const double body_force = problem.body_force[d];
    if (d == D - 1) {
      solve_mean_pressure(channel, body_force, {mode[d].data(), 2}, lower, upper);
      break;
    }
    const auto normal = [&](long row) {
      draw_strip(
          problem, [&](long) { return channel.draw_row(row) * channel.modes(); }, 1, z);
      make_edge_real(channel, 0, 0, z.z[0][0], z.z[1][0], z.z[2][0], z.z[3][0]);
      return z.z[2 * d][0];
    };
    solve_mean_flow(channel, body_force, normal, channel.along(mode[d].data(), 2), lower, upper);
  }
}

template <class Real> template <int D>
void SlitStokes<Real>::solve_block(const SlitChannel &channel, const StokesProblem &problem,
                                   const ModeBlock<Real> &block, Work &work,
                                   WallVectors &wall_force)
{
  const long stride = 2 * block.columns;
  const bool mean = block.first_x == 0 && block.y == 0;
  std::array<std::vector<double>, D> mean_mode;    // saved: the strip overwrites that mode, too
  for (std::size_t d = 0; d < D && mean; ++d)
    for (long row = 0; row < channel.rows; ++row) {
      mean_mode[d].push_back(block.f[d][row * stride]);
      mean_mode[d].push_back(0.0);
    }

  for (long first = 0; first < block.columns; first += width) {
    Strip<D> strip(channel, problem, block, work, first, std::min(width, block.columns - first));
    solve_slit_modes<D>(channel, strip.modes(), strip);
  }

  if (!mean) return;
  solve_mean<D>(channel, problem, mean_mode, wall_force);
  for (std::size_t d = 0; d < D; ++d)
    for (long row = 0; row < channel.rows; ++row)
      for (long part : {0, 1}) block.f[d][row * stride + part] = mean_mode[d][2 * row + part];
}

template <class Real> SlitStokes<Real>::SlitStokes(const Grid &grid, const Comm &comm,
                                                   const FftSetup &setup, const Workers &workers) :
    grid_(grid),
    fft_(grid, comm, setup, workers)
{
  for (int w = 0; w < workers.count(); ++w)
    idle_.push_back(std::make_unique<Work>(grid.n[grid.slow_axis()]));
}

template <class Real> SlitStokes<Real>::~SlitStokes() = default;

/// Never finds the list empty, since there are as many buffers as workers.
template <class Real>
std::unique_ptr<typename SlitStokes<Real>::Work> SlitStokes<Real>::take_buffers()
{
  const std::lock_guard<std::mutex> lock(mutex_);
  std::unique_ptr<Work> work = std::move(idle_.back());
  idle_.pop_back();
  return work;
}

template <class Real> void SlitStokes<Real>::give_back(std::unique_ptr<Work> work)
{
  const std::lock_guard<std::mutex> lock(mutex_);
  idle_.push_back(std::move(work));
}

template <class Real>
SolveReport SlitStokes<Real>::solve(const FieldOf<Real> &field, const StokesProblem &problem)
{
  SolveReport report;
  const SlitChannel channel = slit_channel(grid_, problem);
  fft_.solve(field, [&](const ModeBlock<Real> &block) {
    std::unique_ptr<Work> work = take_buffers();
    // Only the block with the mean mode writes the forces.
    grid_.dim == 3 ? solve_block<3>(channel, problem, block, *work, report.wall_force)
                   : solve_block<2>(channel, problem, block, *work, report.wall_force);
    give_back(std::move(work));
  });
  return report;
}

template <class Real> std::size_t SlitStokes<Real>::memory() const
{
  std::size_t bytes = fft_.memory();
  for (const auto &work : idle_) bytes += work->memory();
  return bytes;
}

template class SlitStokes<float>;
template class SlitStokes<double>;

}    // namespace bdh
