// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// The wave-space part of positively split Ewald on a device: M_w F and M_w^(1/2) dW.
/// See PSE (9), (19)-(21).
#ifndef BDH_PSE_WAVE_SPACE_KOKKOS_H
#define BDH_PSE_WAVE_SPACE_KOKKOS_H

#include "base/bytes_of.h"
#include "base/constants.h"
#include "base/device_kokkos.h"
#include "base/phases.h"
#include "grid/cell_kernel.h"
#include "grid/fft_kokkos.h"
#include "pse/particles.h"
#include "pse/plan.h"
#include "pse/real_space_kokkos.h"
#include "pse/wave_kernel.h"
#include "pse/wave_space.h"
#include "pse/window_spread_kokkos.h"

#include <cmath>

namespace bdh {

/// Turns forces into velocities for one mode.  The index is its position in the padded arrays of
/// complex numbers.  Modes beyond k_cut become 0.
template <class Real> struct SolveWave {
  Cell cell;
  long n[dim], half, most[dim];    ///< most: largest |index| that is kept
  Real *field[dim];
  const double *inverse_window[dim];    ///< 1/w^ by |index|
  double k_cut2, radius, xi;
  WaveStrength strength;    ///< amplitude 0: no noise is drawn
  NoiseCounter counter;

  BDH_FN void operator()(long index) const
  {
    const long nx = index % half, ny = signed_index(index / half % n[1], n[1]),
               nz = signed_index(index / (half * n[1]), n[2]);
    const long ay = ny < 0 ? -ny : ny, az = nz < 0 ? -nz : nz;
    double re[dim] = {}, im[dim] = {};
    Wave wave{};
    cell.wave_vector(nx, ny, nz, wave.k);
    const double *k = wave.k;
    const double k2 = k[0] * k[0] + k[1] * k[1] + k[2] * k[2];
    if (nx <= most[0] && ay <= most[1] && az <= most[2] && k2 > 0.0 && k2 <= k_cut2) {
      for (int d = 0; d < dim; ++d) {
        re[d] = field[d][2 * index];
        im[d] = field[d][2 * index + 1];
      }
      // Rounded to the precision of the table on the host.
      wave.weight =
          static_cast<Real>(wave_weight(std::sqrt(k2), radius, xi) * inverse_window[0][nx] *
                            inverse_window[1][ay] * inverse_window[2][az]);
      wave.conjugate = is_conjugate(nx, ny, nz);
      double z[4] = {};
      if (strength.amplitude != 0.0) {
        normal4(counter, drawn_wave(nx, ny, nz), z[0], z[1], z[2], z[3]);
        for (double &part : z) part *= root_half;
      }
      solve_wave(wave, strength, z, re, im);
    }
    for (int d = 0; d < dim; ++d) {
      field[d][2 * index] = re[d];
      field[d][2 * index + 1] = im[d];
    }
  }
};

/// s := fractional coordinates of the positions x.  The index is that of a particle.
struct ToFractional {
  Cell cell;
  const double *x;
  double *s;
  BDH_FN void operator()(long i) const { cell.to_fractional(x + dim * i, s + dim * i); }
};

/// The counterpart of WaveSpace, for one process and device pointers.
template <class Real, class Exec> class DeviceWaveSpace {
 public:
  explicit DeviceWaveSpace(const PsePlan &plan, SpreadBy by = SpreadBy::automatic) :
      plan_(plan), grid_(fractional_grid(plan.n)), fft_(grid_),
      spreader_(plan.n, plan.window, plan.window_error, by)
  {
    for (int d = 0; d < dim; ++d) {
      field_[d].resize(field_size(grid_));
      most_[d] = (plan.n[d] - 1) / 2;
      const std::vector<double> inverse = inverse_window(plan.window, plan.n[d]);
      inverse_window_[d].assign(inverse.data(), inverse.size());
    }
  }

  bool fits(const Cell &cell) const { return grid_fits(plan_, cell); }
  void set_cell(const Cell &cell) { cell_ = cell; }
  void set_radii(const PsePlan &plan) { plan_.radius = plan.radius; }

  /// Takes particles, whose positions must be finite.
  void bind(const PseParticles<DeviceNeighbors> &particles)
  {
    const PhaseScope phase(Phase::spread);
    const double *x = particles.x;
    const long n = particles.count;
    fractional_.resize(dim * n);
    device_for<Exec>("bdh::fractional", n, ToFractional{cell_, x, fractional_.data()});
    spreader_.bind(fractional_.data(), n);
    Exec().fence();
  }

  /// velocity (dof per particle) := M_w forces + its noise.
  void apply(const PseForces &forces, const PseNoise &noise, double viscosity,
             const PseVelocities &velocity)
  {
    spread(forces);
    transform(forces, modes(noise, viscosity));
    const PhaseScope phase(Phase::interpolate);
    spreader_.interpolate(view(), velocity.linear);
    Exec().fence();
  }

  std::size_t grid_memory() const { return fft_.memory() + bytes_of(field_); }
  std::size_t particle_memory() const { return spreader_.memory() + bytes_of(fractional_); }

 private:
  std::array<Real *, dim> view() { return {field_[0].data(), field_[1].data(), field_[2].data()}; }

  void spread(const PseForces &forces)
  {
    const PhaseScope phase(Phase::spread);
    for (auto &f : field_) f.clear_values();
    if (forces.act) spreader_.spread(forces.values, view());
    Exec().fence();
  }

  void transform(const PseForces &forces, const SolveWave<Real> &modes)
  {
    const PhaseScope phase(Phase::transform);
    if (forces.act)
      for (auto &f : field_) fft_.forward(f.data());
    device_for<Exec>("bdh::waves", grid_.half() * grid_.n[1] * grid_.n[2], modes);
    for (auto &f : field_) fft_.backward(f.data());
    Exec().fence();
  }

  SolveWave<Real> modes(const PseNoise &noise, double viscosity)
  {
    SolveWave<Real> s{};
    s.cell = cell_;
    s.half = grid_.half();
    for (int d = 0; d < dim; ++d) {
      s.n[d] = grid_.n[d];
      s.most[d] = most_[d];
      s.field[d] = field_[d].data();
      s.inverse_window[d] = inverse_window_[d].data();
    }
    s.k_cut2 = plan_.k_cut * plan_.k_cut;
    s.radius = plan_.radius;
    s.xi = plan_.xi;
    const double resistance = viscosity * cell_.volume();
    s.strength = {1.0 / resistance, std::sqrt(noise.variance / resistance)};
    s.counter = noise.counter(Stream::wave_space);
    return s;
  }

  PsePlan plan_;
  Grid grid_;    // in fractional coordinates
  Cell cell_;
  long most_[dim];
  DeviceFft<Real, Exec> fft_;
  DeviceWindowSpreader<Real, Exec> spreader_;
  DeviceArray<Real, Exec> field_[dim];
  DeviceArray<double, Exec> inverse_window_[dim], fractional_;
};

}    // namespace bdh
#endif
