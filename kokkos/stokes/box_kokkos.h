// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// The fluctuating Stokes solver for ducts and closed boxes on a device.
#ifndef BDH_STOKES_BOX_KOKKOS_H
#define BDH_STOKES_BOX_KOKKOS_H

#include "base/bytes_of.h"
#include "base/execution_kokkos.h"
#include "base/messages_kokkos.h"
#include "grid/slabs_kokkos.h"
#include "grid/transposition_kokkos.h"
#include "stokes/box.h"
#include "stokes/periodic_kokkos.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

namespace bdh {

/// Transforms all components along one axis, out of place, as products with dense matrices.
///
/// There is no library of sine and cosine transforms for devices.  A product costs 2 n operations
/// per number and reads 1 + n/8 numbers of the field into a thread.  Neighbouring threads read
/// neighbouring numbers, and the caches hold all but the first.  On a device with 10 operations per
/// byte of memory traffic, transforms with up to 80 cells per axis are therefore as fast as reading
/// and writing the field.  Fast transforms would pay off above a few hundred cells.
///
/// Neighbouring threads are neighbours along x, and each computes `few` results on a line across x.
/// For a transform along y or z these results belong to the same line of the field: each number of
/// the field is read once for all of them, and each number of the matrix by all threads at the same
/// time.  For a transform along x they belong to different lines, and field and matrix exchange
/// roles.
struct TransformAlongAxis {
  static constexpr int few = 8;
  long columns, lines;        ///< number of neighbouring threads; number of lines that they form
  long results, blocks;       ///< results on a line; number of blocks of `few` that they form
  long terms;                 ///< of each sum
  const double *own[3];       ///< by component; read once per term
  const double *shared[3];    ///< by component; read once per result and term
  double *to[3];
  long own_line, own_term, shared_result, shared_term, to_line, to_result;    ///< strides

  long threads(int components) const { return components * blocks * lines * columns; }

  BDH_FN void operator()(long index) const
  {
    const long c = index % columns, l = index / columns % lines,
               block = index / (columns * lines) % blocks;
    const long d = index / (columns * lines * blocks), first = few * block;
    const double *x = own[d] + c + l * own_line, *y = shared[d] + first * shared_result;
    double *z = to[d] + c + l * to_line + first * to_result;
    if (first + few <= results)
      multiply<true>(x, y, z, few);
    else
      multiply<false>(x, y, z, results - first);
  }

  template <bool Whole>
  BDH_FN void multiply(const double *x, const double *y, double *z, int count) const
  {
    double sum[few] = {};
    for (long j = 0; j < terms; ++j) {
      const double factor = x[j * own_term];
      for (int k = 0; k < few; ++k)
        if (Whole || k < count) sum[k] += factor * y[j * shared_term + k * shared_result];
    }
    for (int k = 0; k < few; ++k)
      if (Whole || k < count) z[k * to_result] = sum[k];
  }
};

/// The box with the cells of this rank's planes alone: `at` holds indices in the whole box, places
/// are those of this rank's arrays.
struct BoxSlab : BoxGrid {
  int slow;
  long start, count;    ///< planes
  bool alone;           ///< this rank has them all
  BoxSlab(const BoxGrid &box, const Slab &slab, bool all) :
      BoxGrid(box), slow(box.dim - 1), start(slab.start), count(slab.count), alone(all)
  {}

  long cells() const { return count * n[0] * (dim == 3 ? n[1] : 1); }
  /// Those at a wall.
  long wall_cells(int axis, int side) const
  {
    if (axis != slow) return cells() / n[axis];
    const long plane = side ? n[slow] - 1 : 0;
    return plane >= start && plane < start + count ? n[0] * (dim == 3 ? n[1] : 1) : 0;
  }
  BDH_FN long place(const long *at) const { return BoxGrid::place(at) - start * stride[slow]; }
  BDH_FN void locate(long cell, long *at) const
  {
    BoxGrid::locate(cell, at);
    at[slow] += start;
  }
  BDH_FN void locate_at_wall(int axis, int side, long cell, long *at) const
  {
    BoxGrid::locate_at_wall(axis, side, cell, at);
    if (axis != slow) at[slow] += start;
  }
  /// The numbers before and after that of a cell along an axis.  halo: the plane of another rank.
  BDH_FN double before(const double *of, const double *halo, int axis, const long *at,
                       long here) const
  {
    const bool beyond = !alone && axis == slow && at[slow] == start;
    return beyond ? halo[here] : of[here + BoxGrid::before(axis, at[axis])];
  }
  BDH_FN double after(const double *of, const double *halo, int axis, const long *at,
                      long here) const
  {
    const bool beyond = !alone && axis == slow && at[slow] == start + count - 1;
    return beyond ? halo[here - (count - 1) * stride[slow]]
                  : of[here + BoxGrid::after(axis, at[axis])];
  }
};

/// For each cell: the force on the faces below it, including the contribution of moving walls.
struct PrepareForce {
  BoxSlab box;
  double *field[3];
  double body_force[3], viscosity;
  bool walls_move;
  double V[3][2][3];    ///< wall velocities [axis][lower, upper][component]

  BDH_FN void operator()(long cell) const
  {
    long at[3];
    box.locate(cell, at);
    const long place = box.place(at);
    for (int d = 0; d < 3; ++d)
      if (d < box.dim) field[d][place] = face_force(box, d, at[d], field[d][place], body_force[d]);
    for (int axis = 0; axis < 3 && walls_move; ++axis)
      for (int side = 0; side < 2; ++side)
        if (box.touches(axis, side, at))
          add_moving_wall(box, axis, V[axis][side], viscosity, at, place, field);
  }
};

/// For each cell: faces := D^T cells.
template <int D> struct BoxGradient {
  BoxSlab box;
  const double *cells, *halo;
  double *faces[3];
  BDH_FN void operator()(long cell) const
  {
    long at[3];
    box.locate(cell, at);
    const long place = box.place(at);
    for (int d = 0; d < D; ++d)
      faces[d][place] =
          gradient(box.face_scale(d, at[d]), box.before(cells, halo, d, at, place), cells[place]);
  }
};

/// For each cell: cells := D faces.
template <int D> struct BoxDivergence {
  BoxSlab box;
  const double *faces[3], *halo;
  double *cells;
  BDH_FN void operator()(long cell) const
  {
    long at[3];
    box.locate(cell, at);
    const long place = box.place(at);
    double sum = 0.0;
    for (int d = 0; d < D; ++d)
      sum += divergence(box.inv_h[d], faces[d][place], box.after(faces[d], halo, d, at, place));
    cells[place] = sum;
  }
};

/// All components of one mode.  The index is that of the rank's mode.  Modes are numbered like
/// cells in their padded rows.
template <int D> struct SolveBoxModes {
  BoxGrid box;
  RankModes modes;
  BoxModeScales scales;
  double *field[3];
  const double *eigenvalue[3][3], *weight[3][3];    ///< [component][axis], by index along the axis
  DeviceDraws draws;

  BDH_FN void operator()(long index) const
  {
    const long pitch = box.stride[1], column = modes.column(index), row = modes.row(index);
    const long at[3] = {column % pitch, D == 3 ? column / pitch : row, row};
    if (at[0] >= box.n[0]) return;
    double z[4] = {};
    const bool noisy = scales.amplitude != 0.0;
    if (noisy) draws.get(row * box.stride[D - 1] + column, z);
    for (int d = 0; d < D; ++d) {
      double lambda = eigenvalue[d][0][at[0]], w = weight[d][0][at[0]];
      for (int axis = 1; axis < D; ++axis) {
        lambda += eigenvalue[d][axis][at[axis]];
        w *= weight[d][axis][at[axis]];
      }
      field[d][index] = solve_box_mode(scales, lambda, w, field[d][index], noisy, z[d]);
    }
  }
};

/// A vector as the value of a reduction.
struct WallForce {
  double f[3];
  BDH_FN WallForce() : f{0.0, 0.0, 0.0} {}
  BDH_FN WallForce &operator+=(const WallForce &other)
  {
    for (int d = 0; d < 3; ++d) f[d] += other.f[d];
    return *this;
  }
  BDH_FN void operator+=(const volatile WallForce &other) volatile
  {
    for (int d = 0; d < 3; ++d) f[d] = f[d] + other.f[d];
  }
};

/// Force on a wall, summed over the cells next to it.
struct SumWallForce {
  BoxSlab box;
  int axis, side;
  double V[3], viscosity;
  double *velocity[3];
  const double *pressure;

  BDH_FN void operator()(long cell, WallForce &sum) const
  {
    long at[3];
    box.locate_at_wall(axis, side, cell, at);
    const long place = box.place(at);
    add_wall_force(box, axis, side, V, viscosity, at, place, pressure[place], velocity, sum.f);
  }
};

/// BoxStokes on a device; all pointers are device pointers.  Sums over the grid are copied to the
/// host: two in each iteration, and the forces on the walls.  On several ranks so are planes and
/// the hand-over for the slow axis, unless MPI reads the device's memory.
template <class Exec> class DeviceBoxStokes : public StokesSolver<double> {
 public:
  /// Collective.
  DeviceBoxStokes(const Grid &grid, const Comm &comm) :
      grid_(grid), parts_(grid, comm, 1), plane_(2 * grid.half() * (grid.dim == 3 ? grid.n[1] : 1)),
      transposition_(comm, grid.n[grid.slow_axis()], plane_, 1), messages_(comm),
      box_(box_grid(grid), slab(), comm.size() == 1),
      pressure_(grid.dim, std::max(1L, slab().count * plane_), allocation()),
      wall_force_("bdh", walls)
  {
    if (!box_.alone) halo_.resize(plane_);
    std::vector<double> tables;
    const auto add = [&tables](const std::vector<double> &v) {
      tables.insert(tables.end(), v.begin(), v.end());
      return tables.size() - v.size();
    };
    for (int d = 0; d < grid.dim; ++d) {
      for (int axis = 0; axis < grid.dim; ++axis) {
        const AxisModes modes = axis_modes(grid, d, axis);
        const AxisMatrices matrices = axis_matrices(grid, d, axis);
        at_[d][axis] = {add(modes.eigenvalue), add(modes.weight), add(matrices.forward),
                        add(matrices.backward)};
      }
      work_[d].resize(allocation());
    }
    tables_.assign(tables.data(), tables.size());
  }

  const GridParts &parts() const override { return parts_; }
  std::size_t allocation() const override
  {
    return std::max(1L, std::max(slab().count * plane_, modes().count()));
  }
  std::size_t memory() const override
  {
    return pressure_.memory() + transposition_.memory() + messages_.memory() +
           bytes_of(tables_, work_, halo_) + 3 * walls * sizeof(double);
  }

  /// Throws NotConverged.
  SolveReport solve(const FieldView &field, const StokesProblem &problem) override
  {
    prepare(field, problem);
    inverse_laplacian(field, 1.0 / problem.viscosity, problem.noisy() ? &problem : nullptr);
    SolveReport report = pressure_.run(*this, field, problem.tolerance);
    add_wall_forces(field, problem, report.wall_force);
    return report;
  }

 private:
  template <class, class> friend class PressureIteration;
  static constexpr int walls = 6;
  /// Offsets in tables_ of the numbers of one axis of a component.
  struct Place {
    std::size_t eigenvalue, weight, forward, backward;
  };

  double sum(double mine) const { return messages_.comm().sum(mine); }
  RankModes modes() const
  {
    const Slab &columns = transposition_.columns();
    return {grid_.n[grid_.slow_axis()], columns.count, columns.start};
  }
  /// halo_ := the plane of another rank next to this one's planes of an array.
  const double *fetch(const double *array, Neighbour which)
  {
    if (!box_.alone)
      fetch_plane(messages_, slab(), grid_.n[grid_.slow_axis()], plane_, array, which,
                  halo_.data());
    return halo_.data();
  }

  const double *table(std::size_t begin) const { return tables_.data() + begin; }

  void prepare(const FieldView &field, const StokesProblem &p) const
  {
    PrepareForce f{box_, {}, {}, p.viscosity, p.wall_velocity != WallVectors{}, {}};
    for (std::size_t d = 0; d < 3; ++d) {
      f.field[d] = field[d];
      f.body_force[d] = p.body_force[d];
      for (std::size_t side = 0; side < 2; ++side)
        for (std::size_t c = 0; c < 3; ++c) f.V[d][side][c] = p.wall_velocity[d][side][c];
    }
    device_for<Exec>("bdh::prepare_force", box_.cells(), f);
  }

  void gradient(const double *cells, const FieldView &faces)
  {
    const double *const halo = fetch(cells, Neighbour::before);
    const auto run = [&](auto g) {
      for (std::size_t d = 0; d < 3; ++d) g.faces[d] = faces[d];
      device_for<Exec>("bdh::gradient", box_.cells(), g);
    };
    grid_.dim == 3 ? run(BoxGradient<3>{box_, cells, halo, {}})
                   : run(BoxGradient<2>{box_, cells, halo, {}});
  }

  void divergence(const FieldView &faces, double *cells)
  {
    const double *const halo = fetch(faces[grid_.slow_axis()], Neighbour::after);
    const auto run = [&](auto g) {
      for (std::size_t d = 0; d < 3; ++d) g.faces[d] = faces[d];
      device_for<Exec>("bdh::divergence", box_.cells(), g);
    };
    grid_.dim == 3 ? run(BoxDivergence<3>{box_, {}, halo, cells})
                   : run(BoxDivergence<2>{box_, {}, halo, cells});
  }

  double steepest(const FieldView &v) const
  {
    const long n = box_.cells();
    const BoxGrid &grid = box_;    // its planes, counted from this rank's first one
    const DeviceExecution<Exec> execution;
    return grid_.dim == 3
               ? execution.sum("bdh::steepest", n, Steepness<3>{grid, {v[0], v[1], v[2]}})
               : execution.sum("bdh::steepest", n, Steepness<2>{grid, {v[0], v[1], nullptr}});
  }

  /// field := factor (-L)^-1 field, plus a random velocity unless `noise` is null.  The transforms
  /// alternate between the field and the work arrays.
  void inverse_laplacian(const FieldView &field, double factor, const StokesProblem *noise)
  {
    FieldView from = field, to = {work_[0].data(), work_[1].data(), work_[2].data()};
    const auto next = [&](int axis, std::size_t Place::*matrix) {
      transform(axis, matrix, from, to);
      std::swap(from, to);
    };
    const int slow = grid_.slow_axis();
    for (int axis = 0; axis < slow; ++axis) next(axis, &Place::forward);
    for (int d = 0; d < grid_.dim; ++d) transposition_.hand_over(from[d]);
    next(slow, &Place::forward);
    grid_.dim == 3 ? solve_modes<3>(from, factor, noise) : solve_modes<2>(from, factor, noise);
    next(slow, &Place::backward);
    for (int d = 0; d < grid_.dim; ++d) transposition_.hand_back(from[d]);
    for (int axis = slow - 1; axis >= 0; --axis) next(axis, &Place::backward);
  }

  void transform(int axis, std::size_t Place::*matrix, const FieldView &from,
                 const FieldView &to) const
  {
    const long n = grid_.n[axis], pitch = box_.stride[1];
    const int other = axis == 1 ? 2 : 1;    // the axis that is neither x nor `axis`
    const bool handed_over = axis == grid_.slow_axis() && !box_.alone;
    TransformAlongAxis t{};
    t.columns = handed_over ? modes().columns : grid_.n[0];
    t.terms = n;
    if (axis == 0) {
      t.lines = 1;
      t.results = box_.cells() / n;
      t.own_term = n;
      t.shared_result = t.to_result = pitch;
      t.shared_term = 1;
    } else {
      t.lines = handed_over ? 1 : other == grid_.slow_axis() ? slab().count : grid_.n[other];
      t.results = n;
      t.own_line = t.to_line = box_.stride[other];
      t.own_term = t.to_result = handed_over ? t.columns : box_.stride[axis];
      t.shared_result = 1;
      t.shared_term = n;
    }
    t.blocks = (t.results + TransformAlongAxis::few - 1) / TransformAlongAxis::few;
    for (int d = 0; d < grid_.dim; ++d) {
      const double *const m = table(at_[d][axis].*matrix);
      t.own[d] = axis == 0 ? m : from[d];
      t.shared[d] = axis == 0 ? from[d] : m;
      t.to[d] = to[d];
    }
    device_for<Exec>("bdh::transform", t.threads(grid_.dim), t);
  }

  template <int D>
  void solve_modes(const FieldView &field, double factor, const StokesProblem *noise)
  {
    SolveBoxModes<D> s{box_, modes(), box_mode_scales(grid_, factor, noise), {}, {}, {}, {}};
    for (int d = 0; d < D; ++d) {
      s.field[d] = field[d];
      for (int axis = 0; axis < D; ++axis) {
        s.eigenvalue[d][axis] = table(at_[d][axis].eigenvalue);
        s.weight[d][axis] = table(at_[d][axis].weight);
      }
    }
    if (noise) s.draws = noise_.draws(*noise, grid_.n[grid_.slow_axis()] * plane_);
    device_for<Exec>("bdh::box_modes", s.modes.count(), s);
  }

  /// Copies 18 numbers to the host, even if they are not used, and therefore waits for the device.
  void add_wall_forces(const FieldView &velocity, const StokesProblem &p, WallVectors &force) const
  {
    for (int axis = 0; axis < grid_.dim; ++axis)
      for (int side = 0; side < 2 && grid_.walled(axis); ++side) {
        SumWallForce s{box_,
                       axis,
                       side,
                       {},
                       p.viscosity,
                       {velocity[0], velocity[1], velocity[2]},
                       pressure_.pressure().data()};
        std::copy_n(p.wall_velocity[axis][side].data(), 3, s.V);
        Kokkos::parallel_reduce(
            "bdh::wall_force",
            Kokkos::RangePolicy<Exec, Kokkos::IndexType<long>>(0, box_.wall_cells(axis, side)), s,
            Kokkos::subview(wall_force_, 2 * axis + side));
      }
    const auto all = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), wall_force_);
    for (int axis = 0; axis < grid_.dim; ++axis)
      for (int side = 0; side < 2 && grid_.walled(axis); ++side)
        std::copy_n(all(2 * axis + side).f, 3, force[axis][side].data());
  }

  Grid grid_;
  GridParts parts_;
  long plane_;    // numbers of a plane
  DeviceTransposition<double, Exec> transposition_;
  DeviceMessages<double, Exec> messages_;
  BoxSlab box_;
  PressureIteration<DeviceArray<double, Exec>, DeviceExecution<Exec>> pressure_;
  DeviceNoise<Exec> noise_;
  DeviceArray<double, Exec> tables_, work_[3], halo_;
  std::array<std::array<Place, 3>, 3> at_{};
  Kokkos::View<WallForce *, typename Exec::memory_space> wall_force_;
};

}    // namespace bdh
#endif
