// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
#include "stokes/slit.h"

#include "base/bytes_of.h"
#include "stokes/noise.h"

#include <algorithm>
#include <cmath>

namespace bdh {

namespace {

/// The columns of a block are solved in strips of so many modes; the last one takes what is left as
/// well.  Their workspace fits the second-level cache, and narrow strips get steady entries early.
constexpr long width = 16, widest = 2 * width;

long strip_width(long left) { return left < widest ? left : width; }

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

/// Workspace for the lines of one strip, row by row.
template <class Real> struct SlitStokes<Real>::Work {
  static constexpr long numbers = 7;    // for each mode and row
  AlignedArray<double> values;

  explicit Work(long rows) : values(numbers * widest * rows) {}
  SlitWork row(long row, long count)
  {
    const auto number = [=](long m) { return values.data() + (numbers * row + m) * count; };
    return {{number(0), number(1)}, {number(2), number(3)}, number(4), number(5), number(6)};
  }
};

/// Modes first .. first + count - 1 of a block, in the form that solve_slit_modes() requires.
template <class Real> template <int D> class SlitStokes<Real>::Strip {
 public:
  Strip(const SlitChannel &channel, const StokesProblem &problem, const ModeBlock<Real> &block,
        Work &work, long first, long count) :
      channel_(channel),
      problem_(problem), block_(block), work_(work), first_(first), count_(count),
      rows_drawn_(strip / count)
  {
    const uint64_t next_row = (channel.draw_row(1) - channel.draw_row(0)) * channel.modes();
    for (long i = 0; i < count; ++i) draw_[i] = slit_draw(channel, kx(i), block.y);
    for (long i = count; i < strip; ++i) draw_[i] = draw_[i - count] + next_row;
  }

  SlitComponents<D, Real> components(long row) const
  {
    SlitComponents<D, Real> c;
    for (int d = 0; d < D; ++d)
      c.f[d] = block_.f[d] + 2 * (channel_.stored_row(d == D - 1, row) * block_.columns + first_);
    return c;
  }
  struct Normals {
    const Real *z[4];
  };
  /// Rows must come in order.
  Normals normals(long row)
  {
    const long of_drawn = row % rows_drawn_;
    if (problem_.noisy() && of_drawn == 0) draw(row);
    Normals n;
    for (int m = 0; m < 4; ++m) n.z[m] = z_.z[m] + of_drawn * count_;
    return n;
  }
  SlitWork work(long row) { return work_.row(row, count_); }

 private:
  long kx(long i) const { return block_.first_x + first_ + i; }

  /// Draws the normals of this row and of the next ones.  Many at once are faster.
  void draw(long row)
  {
    const long rows = std::min(rows_drawn_, channel_.rows - row);
    const uint64_t before = channel_.draw_row(row) * channel_.modes();
    draw_strip(
        problem_, [this, before](long i) { return before + draw_[i]; }, rows * count_, z_);
    for (long first = 0; first < rows * count_; first += count_) {
      make_real(first, kx(0));
      if (count_ > 1) make_real(first + count_ - 1, kx(count_ - 1));
    }
  }
  void make_real(long i, long kx)
  {
    make_edge_real(channel_, kx, block_.y, z_.z[0][i], z_.z[1][i], z_.z[2][i], z_.z[3][i]);
  }

  const SlitChannel &channel_;
  const StokesProblem &problem_;
  const ModeBlock<Real> &block_;
  Work &work_;
  const long first_, count_, rows_drawn_;
  uint64_t draw_[strip];    // numbers of the draws of rows_drawn_ rows, less those before them
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
                                   WallVectors &wall_force) const
{
  const long stride = 2 * block.columns;
  const bool mean = block.first_x == 0 && block.y == 0;
  std::array<std::vector<double>, D> mean_mode;    // saved: the strip overwrites that mode, too
  for (std::size_t d = 0; d < D && mean; ++d)
    for (long row = 0; row < channel.rows; ++row) {
      mean_mode[d].push_back(block.f[d][row * stride]);
      mean_mode[d].push_back(0.0);
    }

  SlitModes<widest> modes(channel, block.y);
  long count = 0;
  for (long first = 0; first < block.columns; first += count) {
    count = strip_width(block.columns - first);
    for (long i = 0; i < count; ++i) modes.set(channel, i, symbols_x_[block.first_x + first + i]);
    Strip<D> strip(channel, problem, block, work, first, count);
    solve_slit_modes<D>(channel, modes, count, strip);
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
  for (long kx = 0; kx < grid.half(); ++kx)
    symbols_x_.push_back(axis_symbol(kx, grid.n[0], grid.h(0)));
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
  std::size_t bytes = fft_.memory() + bytes_of(symbols_x_);
  for (const auto &work : idle_) bytes += bytes_of(work->values);
  return bytes;
}

template class SlitStokes<float>;
template class SlitStokes<double>;

}    // namespace bdh
