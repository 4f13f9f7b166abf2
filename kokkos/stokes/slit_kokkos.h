// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// The fluctuating Stokes solver for slits on a device.
#ifndef BDH_STOKES_SLIT_KOKKOS_H
#define BDH_STOKES_SLIT_KOKKOS_H

#include "base/bytes_of.h"
#include "stokes/periodic_kokkos.h"
#include "stokes/slit.h"

namespace bdh {

/// Solves one mode of a slit, from force to velocity, in one thread.  The index is that of
/// SolveMode, but within a plane.  Additional threads, after those of the modes, each take one
/// direction of the mean mode; in the middle of the other threads they would hold up a warp.  The
/// lines are stored in the field itself.  The workspace of the downward pass has the layout of the
/// field, so that neighbouring threads read neighbouring numbers.
template <int D> struct SolveSlitMode {
  SlitChannel channel;
  double *field[3];
  double *l1, *inv_d, *transverse_inv_d;    // a real number for each mode and row
  double body_force[3];
  double *wall_force;    // [lower, upper][component]
  DeviceDraws draws;

  static long threads(long modes) { return modes + D; }

  BDH_FN void operator()(long index) const
  {
    const long modes = channel.modes(), half = channel.n[0] / 2 + 1;
    if (index >= modes) return solve_mean(index - modes);
    if (index == 0) return;
    SlitModes<1> mode(channel, index / half);
    mode.set(channel, 0, index % half);
    Strip strip{*this, index, index % half, index / half};
    solve_slit_modes<D>(channel, mode, strip);
  }

  /// One mode in the form that solve_slit_modes() requires.
  struct Strip {
    const SolveSlitMode &s;
    long index, kx, ky;

    struct Complex {
      double *re, *im;
    };
    struct Normals {
      double z[4][1];
    };

    BDH_FN long at(long row) const { return row * s.channel.modes() + index; }
    BDH_FN Complex component(int d, long row) const
    {
      double *const re = s.field[d] + 2 * at(s.channel.stored_row(d == D - 1, row));
      return {re, re + 1};
    }
    BDH_FN void load(long row, ComplexLanes<1> *u) const
    {
      for (int d = 0; d < D; ++d) {
        u[d].re[0] = *component(d, row).re;
        u[d].im[0] = *component(d, row).im;
      }
    }
    BDH_FN void store(long row, const ComplexLanes<1> *u) const
    {
      for (int d = 0; d < D; ++d) {
        *component(d, row).re = u[d].re[0];
        *component(d, row).im = u[d].im[0];
      }
    }
    BDH_FN Normals normals(long row) const { return s.normals(kx, ky, row); }
    BDH_FN Complex normal(long row) const { return component(D - 1, row); }
    BDH_FN Complex transverse(long row) const { return component(1, row); }
    BDH_FN double *l1(long row) const { return s.l1 + at(row); }
    BDH_FN double *inv_d(long row) const { return s.inv_d + at(row); }
    BDH_FN double *transverse_inv_d(long row) const { return s.transverse_inv_d + at(row); }
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
    const long stride = 2 * channel.modes();
    double &lower = wall_force[d], &upper = wall_force[3 + d];
    if (d == D - 1)
      solve_mean_pressure(channel, body_force[d], {field[d], stride}, lower, upper);
    else
      solve_mean_flow(channel, body_force[d], MeanNormals{*this, 2 * d},
                      channel.along(field[d], stride), lower, upper);
  }
};

/// SlitStokes on a device, for one process; all pointers are device pointers.
template <class Exec> class DeviceSlitStokes : public StokesSolver<double> {
 public:
  explicit DeviceSlitStokes(const Grid &grid) : grid_(grid), fft_(grid)
  {
    lines_.resize(grid.dim * modes());
    wall_force_.resize(6);
    wall_force_.clear_values();
  }
  Slab slab() const override { return {0, grid_.n[grid_.slow_axis()]}; }
  std::size_t allocation() const override { return field_size(grid_); }
  std::size_t memory() const override { return fft_.memory() + bytes_of(lines_, wall_force_); }

  SolveReport solve(const FieldView &field, const StokesProblem &problem) override
  {
    for (int d = 0; d < grid_.dim; ++d) fft_.forward(field[d]);
    grid_.dim == 3 ? solve_modes<3>(field, problem) : solve_modes<2>(field, problem);
    for (int d = 0; d < grid_.dim; ++d) fft_.backward(field[d]);
    return report();
  }

 private:
  /// Complex numbers in a component.
  std::size_t modes() const { return field_size(grid_) / 2; }

  template <int D> void solve_modes(const FieldView &field, const StokesProblem &p)
  {
    SolveSlitMode<D> s{};
    s.channel = slit_channel(grid_, p);
    for (int d = 0; d < 3; ++d) {
      s.field[d] = field[d];
      s.body_force[d] = p.body_force[d];
    }
    s.l1 = lines_.data();
    s.inv_d = s.l1 + modes();
    s.transverse_inv_d = D == 3 ? s.inv_d + modes() : nullptr;
    s.wall_force = wall_force_.data();
    if (p.noisy()) s.draws = noise_.draws(p, modes());
    device_for<Exec>("bdh::slit", SolveSlitMode<D>::threads(s.channel.modes()), s);
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
