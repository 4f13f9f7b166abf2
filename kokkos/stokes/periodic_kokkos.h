// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Random stresses on a device, and the fluctuating Stokes solver for periodic boxes.
/// See FIB sec. III B, eq. (28)-(30).
#ifndef BDH_STOKES_PERIODIC_KOKKOS_H
#define BDH_STOKES_PERIODIC_KOKKOS_H

#include "base/constants.h"
#include "base/device_kokkos.h"
#include "grid/fft_kokkos.h"
#include "stokes/periodic.h"

#include <cmath>
#include <stdexcept>
#include <vector>

namespace bdh {

/// The random stresses of a solve, drawn mode by mode.
struct DeviceDraws {
  static constexpr int most = 4;
  int count;
  double weight[most];
  NoiseCounter counter[most];
  /// Null, or 4 numbers per mode, already summed, in place of those from the generator.
  const double *given;

  /// Sets z[0] .. z[3], with E|z|^2 = 1 per complex number for weights whose squares add up to 1.
  BDH_FN void get(uint64_t number, double *z) const
  {
    for (int m = 0; m < 4; ++m) z[m] = given ? given[4 * number + m] : 0.0;
    if (given) return;
    for (int i = 0; i < count; ++i) {
      double n[4];
      normal4(counter[i], number, n[0], n[1], n[2], n[3]);
      for (int m = 0; m < 4; ++m) z[m] += weight[i] * n[m];
    }
  }
};

/// Stores the numbers that a test supplies in place of those from the generator.
template <class Exec> class DeviceNoise {
 public:
  /// numbers: how many draws a solve needs.  The result is valid until the next call.
  DeviceDraws draws(const StokesProblem &p, std::size_t numbers)
  {
    if (p.stress.size() > DeviceDraws::most)
      throw std::invalid_argument("DeviceNoise: more random stresses than any scheme has");
    DeviceDraws draws{};
    for (const StressDraw &draw : p.stress) {
      // Each part of a complex number has variance 1/2.
      draws.weight[draws.count] = root_half * draw.weight;
      draws.counter[draws.count++] = {p.seed, Stream::fluid, p.step, draw.stage};
    }
    if (!p.normals) return draws;
    std::vector<double> all(4 * numbers, 0.0);
    for (const StressDraw &draw : p.stress)
      for (std::size_t i = 0; i < numbers; ++i) {
        double z[4];
        p.normals->get(draw.stage, i, z);
        for (std::size_t m = 0; m < 4; ++m) all[4 * i + m] += root_half * draw.weight * z[m];
      }
    given_.assign(all.data(), all.size());
    draws.given = given_.data();
    return draws;
  }

 private:
  DeviceArray<double, Exec> given_;
};

/// Solves one mode, from force to velocity.  The index is that of the rank's mode.
template <int D> struct SolveMode {
  RankModes modes;
  long n[3], half;
  double h[3];
  double *field[3];
  double response, amplitude;
  DeviceDraws draws;

  BDH_FN AxisSymbol symbol(int d, long k) const { return axis_symbol(k, n[d], h[d]); }

  BDH_FN void operator()(long index) const
  {
    const long column = modes.column(index), row = modes.row(index);
    const long k[3] = {column % half, D == 3 ? column / half : row, D == 3 ? row : 0};
    AxisSymbol axis[3] = {symbol(0, k[0]), symbol(1, k[1]), symbol(2, k[2])};
    double re[3] = {}, im[3] = {}, z[4] = {};
    for (int d = 0; d < D; ++d) {
      re[d] = field[d][2 * index];
      im[d] = field[d][2 * index + 1];
    }
    const bool noisy = amplitude != 0.0, edge = noisy && is_edge_column(n, k[0]);
    if (noisy && !edge) draws.get(mode_number(n, k[0], k[1], k[2]), z);
    solve_mode<D>(axis, response, edge ? 0.0 : amplitude, z, re, im);
    if (edge) add_edge_noise(k, re, im);
    for (int d = 0; d < D; ++d) {
      field[d][2 * index] = re[d];
      field[d][2 * index + 1] = im[d];
    }
  }

  BDH_FN void add_edge_noise(const long *k, double *re, double *im) const
  {
    const DrawnMode draw = drawn_mode(n, k);
    AxisSymbol axis[3] = {symbol(0, draw.k[0]), symbol(1, draw.k[1]), symbol(2, draw.k[2])};
    double z[4], noise_re[3] = {}, noise_im[3] = {};
    draws.get(draw.number, z);
    prepare_draw(draw.role, axis, z);
    solve_mode<D>(axis, 0.0, amplitude, z, noise_re, noise_im);
    for (int d = 0; d < D; ++d) {
      re[d] += noise_re[d];
      im[d] += draw.role == DrawnMode::conjugate ? -noise_im[d] : noise_im[d];
    }
  }
};

/// PeriodicStokes on a device; all pointers are device pointers.
template <class Exec> class DevicePeriodicStokes : public StokesSolver<double> {
 public:
  /// Collective.
  DevicePeriodicStokes(const Grid &grid, const Comm &comm) : grid_(grid), fft_(grid, comm) {}
  const GridParts &parts() const override { return fft_.parts(); }
  std::size_t allocation() const override { return fft_.allocation(); }
  std::size_t memory() const override { return fft_.memory(); }

  SolveReport solve(const FieldView &field, const StokesProblem &problem) override
  {
    for (int d = 0; d < grid_.dim; ++d) fft_.forward(field[d]);
    grid_.dim == 3 ? solve_modes<3>(field, problem) : solve_modes<2>(field, problem);
    for (int d = 0; d < grid_.dim; ++d) fft_.backward(field[d]);
    Exec().fence();
    return {};
  }

 private:
  template <int D> void solve_modes(const FieldView &field, const StokesProblem &p)
  {
    const double cells = grid_.cells();
    SolveMode<D> s{};
    s.modes = fft_.modes();
    for (int d = 0; d < 3; ++d) {
      s.n[d] = grid_.n[d];
      s.h[d] = grid_.h(d);
      s.field[d] = field[d];
    }
    s.half = grid_.half();
    s.response = 1.0 / (p.viscosity * cells);
    if (p.noisy()) {
      s.amplitude = std::sqrt(2.0 * p.kT_over_dt / (p.viscosity * grid_.cell_volume() * cells));
      s.draws = noise_.draws(p, grid_.half() * grid_.n[1] * grid_.n[2]);
    }
    device_for<Exec>("bdh::modes", s.modes.count(), s);
  }

  Grid grid_;
  DeviceFft<double, Exec> fft_;
  DeviceNoise<Exec> noise_;
};

}    // namespace bdh
#endif
