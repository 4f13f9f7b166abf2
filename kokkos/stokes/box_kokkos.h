// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// The fluctuating Stokes solver for ducts and closed boxes on a device.
#ifndef BDH_STOKES_BOX_KOKKOS_H
#define BDH_STOKES_BOX_KOKKOS_H

#include "base/bytes_of.h"
#include "base/execution_kokkos.h"
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

/// For each cell: the force on the faces below it, including the contribution of moving walls.
struct PrepareForce {
  BoxGrid box;
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
  BoxGrid box;
  const double *cells;
  double *faces[3];
  BDH_FN void operator()(long cell) const
  {
    long at[3];
    box.locate(cell, at);
    const long place = box.place(at);
    for (int d = 0; d < D; ++d)
      faces[d][place] =
          gradient(box.face_scale(d, at[d]), cells[place + box.before(d, at[d])], cells[place]);
  }
};

/// For each cell: cells := D faces.
template <int D> struct BoxDivergence {
  BoxGrid box;
  const double *faces[3];
  double *cells;
  BDH_FN void operator()(long cell) const
  {
    long at[3];
    box.locate(cell, at);
    const long place = box.place(at);
    double sum = 0.0;
    for (int d = 0; d < D; ++d)
      sum += divergence(box.inv_h[d], faces[d][place], faces[d][place + box.after(d, at[d])]);
    cells[place] = sum;
  }
};

/// All components of one mode.  Modes are stored and numbered like cells.
template <int D> struct SolveBoxModes {
  BoxGrid box;
  BoxModeScales scales;
  double *field[3];
  const double *eigenvalue[3][3], *weight[3][3];    ///< [component][axis], by index along the axis
  DeviceDraws draws;

  BDH_FN void operator()(long cell) const
  {
    long at[3];
    box.locate(cell, at);
    const long place = box.place(at);
    double z[4] = {};
    const bool noisy = scales.amplitude != 0.0;
    if (noisy) draws.get(place, z);
    for (int d = 0; d < D; ++d) {
      double lambda = eigenvalue[d][0][at[0]], w = weight[d][0][at[0]];
      for (int axis = 1; axis < D; ++axis) {
        lambda += eigenvalue[d][axis][at[axis]];
        w *= weight[d][axis][at[axis]];
      }
      field[d][place] = solve_box_mode(scales, lambda, w, field[d][place], noisy, z[d]);
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
  BoxGrid box;
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

/// BoxStokes on a device, for one process; all pointers are device pointers.  Only sums over the
/// grid are copied to the host: two in each iteration, and the forces on the walls.
template <class Exec> class DeviceBoxStokes : public StokesSolver<double> {
 public:
  explicit DeviceBoxStokes(const Grid &grid) :
      grid_(grid), box_(box_grid(grid)), pressure_(grid.dim, field_size(grid), field_size(grid)),
      wall_force_("bdh", walls)
  {
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
      work_[d].resize(field_size(grid));
    }
    tables_.assign(tables.data(), tables.size());
  }

  Slab slab() const override { return {0, grid_.n[grid_.slow_axis()]}; }
  std::size_t allocation() const override { return field_size(grid_); }
  std::size_t memory() const override
  {
    return pressure_.memory() + bytes_of(tables_, work_) + 3 * walls * sizeof(double);
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

  double sum(double all) const { return all; }

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
    device_for<Exec>("bdh::prepare_force", grid_.cells(), f);
  }

  void gradient(const double *cells, const FieldView &faces) const
  {
    const auto run = [&](auto g) {
      for (std::size_t d = 0; d < 3; ++d) g.faces[d] = faces[d];
      device_for<Exec>("bdh::gradient", grid_.cells(), g);
    };
    grid_.dim == 3 ? run(BoxGradient<3>{box_, cells, {}}) : run(BoxGradient<2>{box_, cells, {}});
  }

  void divergence(const FieldView &faces, double *cells) const
  {
    const auto run = [&](auto g) {
      for (std::size_t d = 0; d < 3; ++d) g.faces[d] = faces[d];
      device_for<Exec>("bdh::divergence", grid_.cells(), g);
    };
    grid_.dim == 3 ? run(BoxDivergence<3>{box_, {}, cells})
                   : run(BoxDivergence<2>{box_, {}, cells});
  }

  double steepest(const FieldView &v) const
  {
    const long n = grid_.cells();
    const DeviceExecution<Exec> execution;
    return grid_.dim == 3
               ? execution.sum("bdh::steepest", n, Steepness<3>{box_, {v[0], v[1], v[2]}})
               : execution.sum("bdh::steepest", n, Steepness<2>{box_, {v[0], v[1], nullptr}});
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
    for (int axis = 0; axis < grid_.dim; ++axis) next(axis, &Place::forward);
    grid_.dim == 3 ? solve_modes<3>(from, factor, noise) : solve_modes<2>(from, factor, noise);
    for (int axis = grid_.dim - 1; axis >= 0; --axis) next(axis, &Place::backward);
  }

  void transform(int axis, std::size_t Place::*matrix, const FieldView &from,
                 const FieldView &to) const
  {
    const long n = grid_.n[axis], pitch = box_.stride[1];
    const int other = axis == 1 ? 2 : 1;    // the axis that is neither x nor `axis`
    TransformAlongAxis t{};
    t.columns = grid_.n[0];
    t.terms = n;
    if (axis == 0) {
      t.lines = 1;
      t.results = grid_.n[1] * grid_.n[2];
      t.own_term = n;
      t.shared_result = t.to_result = pitch;
      t.shared_term = 1;
    } else {
      t.lines = grid_.n[other];
      t.results = n;
      t.own_line = t.to_line = box_.stride[other];
      t.own_term = t.to_result = box_.stride[axis];
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
    SolveBoxModes<D> s{box_, box_mode_scales(grid_, factor, noise), {}, {}, {}, {}};
    for (int d = 0; d < D; ++d) {
      s.field[d] = field[d];
      for (int axis = 0; axis < D; ++axis) {
        s.eigenvalue[d][axis] = table(at_[d][axis].eigenvalue);
        s.weight[d][axis] = table(at_[d][axis].weight);
      }
    }
    if (noise) s.draws = noise_.draws(*noise, field_size(grid_));
    device_for<Exec>("bdh::box_modes", grid_.cells(), s);
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
            Kokkos::RangePolicy<Exec, Kokkos::IndexType<long>>(0, grid_.cells() / grid_.n[axis]), s,
            Kokkos::subview(wall_force_, 2 * axis + side));
      }
    const auto all = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), wall_force_);
    for (int axis = 0; axis < grid_.dim; ++axis)
      for (int side = 0; side < 2 && grid_.walled(axis); ++side)
        std::copy_n(all(2 * axis + side).f, 3, force[axis][side].data());
  }

  Grid grid_;
  BoxGrid box_;
  PressureIteration<DeviceArray<double, Exec>, DeviceExecution<Exec>> pressure_;
  DeviceNoise<Exec> noise_;
  DeviceArray<double, Exec> tables_, work_[3];
  std::array<std::array<Place, 3>, 3> at_{};
  Kokkos::View<WallForce *, typename Exec::memory_space> wall_force_;
};

}    // namespace bdh
#endif
