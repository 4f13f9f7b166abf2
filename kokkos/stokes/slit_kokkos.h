// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// The fluctuating Stokes solver for slits on a device.
#ifndef BDH_STOKES_SLIT_KOKKOS_H
#define BDH_STOKES_SLIT_KOKKOS_H

#include "base/bytes_of.h"
#include "stokes/periodic_kokkos.h"
#include "stokes/slit.h"

namespace bdh {

/// Solves one mode of a slit, from force to velocity, in one thread.  The index is that of a column
/// of this rank.  On the rank of the mean mode additional threads, after those of the columns, each
/// take one direction of it; in the middle of the other threads they would hold up a warp.  The
/// lines are stored in the field itself.  The workspace of the downward pass has the layout of the
/// field, so that neighbouring threads read neighbouring numbers.
template <int D> struct SolveSlitMode {
  SlitChannel channel;
  RankModes modes;
  double *field[3];
  double *l1, *inv_d, *transverse_inv_d;    // a real number for each mode and row
  double body_force[3];
  double *wall_force;    // [lower, upper][component]
  DeviceDraws draws;

  long threads() const { return modes.columns + (has_mean() ? D : 0); }
  BDH_FN bool has_mean() const { return modes.first == 0 && modes.columns > 0; }

  BDH_FN void operator()(long index) const
  {
    if (index >= modes.columns) return solve_mean(index - modes.columns);
    if (index == 0 && has_mean()) return;
    const long half = channel.n[0] / 2 + 1, column = modes.first + index;
    SlitModes<1> mode(channel, column / half);
    mode.set(channel, 0, axis_symbol(column % half, channel.n[0], channel.h_along[0]));
    Strip strip{*this, index, column % half, column / half};
    solve_slit_modes<D>(channel, mode, 1, strip);
  }

  /// One mode in the form that solve_slit_modes() requires.
  struct Strip {
    const SolveSlitMode &s;
    long index, kx, ky;

    struct Normals {
      double z[4][1];
    };

    BDH_FN long at(long row) const { return row * s.modes.columns + index; }
    BDH_FN SlitComponents<D, double> components(long row) const
    {
      SlitComponents<D, double> c;
      for (int d = 0; d < D; ++d)
        c.f[d] = s.field[d] + 2 * at(s.channel.stored_row(d == D - 1, row));
      return c;
    }
    BDH_FN Normals normals(long row) const { return s.normals(kx, ky, row); }
    BDH_FN SlitWork work(long row) const
    {
      const SlitComponents<D, double> c = components(row);
      double *const transverse = c.f[1], *const normal = c.f[D - 1];
      return {{transverse, transverse + 1},
              {normal, normal + 1},
              s.transverse_inv_d + at(row),
              s.l1 + at(row),
              s.inv_d + at(row)};
    }
  };

  BDH_FN typename Strip::Normals normals(long kx, long ky, long row) const
  {
    double z[4];
    draws.get(slit_draw(channel, kx, ky) + channel.draw_row(row) * channel.modes(), z);
    make_edge_real(channel, kx, ky, z[0], z[1], z[2], z[3]);
    return {{{z[0]}, {z[1]}, {z[2]}, {z[3]}}};
  }

  struct MeanNormals {
    const SolveSlitMode &s;
    int part;
    BDH_FN double operator()(long row) const { return s.normals(0, 0, row).z[part][0]; }
  };

  BDH_FN void solve_mean(int d) const
  {
    const long stride = 2 * modes.columns;
    double &lower = wall_force[d], &upper = wall_force[3 + d];
    if (d == D - 1)
      solve_mean_pressure(channel, body_force[d], {field[d], stride}, lower, upper);
    else
      solve_mean_flow(channel, body_force[d], MeanNormals{*this, 2 * d},
                      channel.along(field[d], stride), lower, upper);
  }
};

/// SlitStokes on a device; all pointers are device pointers.
template <class Exec> class DeviceSlitStokes : public StokesSolver<double> {
 public:
  /// Collective.
  DeviceSlitStokes(const Grid &grid, const Comm &comm) : grid_(grid), fft_(grid, comm)
  {
    lines_.resize(grid.dim * fft_.modes().count());
    wall_force_.resize(6);
    wall_force_.clear_values();
  }
  const GridParts &parts() const override { return fft_.parts(); }
  std::size_t allocation() const override { return fft_.allocation(); }
  std::size_t memory() const override { return fft_.memory() + bytes_of(lines_, wall_force_); }

  SolveReport solve(const FieldView &field, const StokesProblem &problem) override
  {
    for (int d = 0; d < grid_.dim; ++d) fft_.forward(field[d]);
    grid_.dim == 3 ? solve_modes<3>(field, problem) : solve_modes<2>(field, problem);
    for (int d = 0; d < grid_.dim; ++d) fft_.backward(field[d]);
    return report();
  }

 private:
  template <int D> void solve_modes(const FieldView &field, const StokesProblem &p)
  {
    SolveSlitMode<D> s{};
    s.channel = slit_channel(grid_, p);
    s.modes = fft_.modes();
    for (int d = 0; d < 3; ++d) {
      s.field[d] = field[d];
      s.body_force[d] = p.body_force[d];
    }
    s.l1 = lines_.data();
    s.inv_d = s.l1 + s.modes.count();
    s.transverse_inv_d = D == 3 ? s.inv_d + s.modes.count() : nullptr;
    s.wall_force = wall_force_.data();
    if (p.noisy()) s.draws = noise_.draws(p, s.channel.modes() * s.channel.rows);
    device_for<Exec>("bdh::slit", s.threads(), s);
  }

  /// Copies six numbers to the host, even if they are not used, and therefore waits for the device.
  SolveReport report() const
  {
    SolveReport r;
    double force[2][3];
    wall_force_.copy_to(force[0]);
    for (std::size_t side = 0; side < 2; ++side)
      for (std::size_t d = 0; d < 3; ++d) r.wall_force[grid_.slow_axis()][side][d] = force[side][d];
    return r;
  }

  Grid grid_;
  DeviceFft<double, Exec> fft_;
  DeviceNoise<Exec> noise_;
  DeviceArray<double, Exec> lines_, wall_force_;
};

}    // namespace bdh
#endif
