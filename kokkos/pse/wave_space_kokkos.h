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
#include "pse/sphere_exchange_kokkos.h"
#include "pse/sphere_spread_kokkos.h"
#include "pse/wave_kernel.h"
#include "pse/wave_space.h"

#include <cmath>

namespace bdh {

/// Turns forces into velocities for one mode.  The index is that of the rank's mode.  Modes beyond
/// k_cut become 0.  Two shape functions have a field each: both add up to one force for each term
/// of the weight, whose velocity both read.
template <class Real, int shapes> struct SolveWave {
  Cell cell;
  RankModes modes;
  long n[dim], half, most[dim];    ///< most: largest |index| that is kept
  Real *field[dim * shapes];
  const double *inverse_window[dim];    ///< 1/w^ by |index|
  double k_cut2, radius[shapes];
  WaveWeight split;
  WaveStrength strength;    ///< amplitude 0: no noise is drawn
  NoiseCounter counter;

  BDH_FN void operator()(long index) const
  {
    const long column = modes.column(index), nx = column % half,
               ny = signed_index(column / half, n[1]), nz = signed_index(modes.row(index), n[2]);
    const long ay = ny < 0 ? -ny : ny, az = nz < 0 ? -nz : nz;
    double re[dim * shapes] = {}, im[dim * shapes] = {};
    Wave wave{};
    cell.wave_vector(nx, ny, nz, wave.k);
    const double *k = wave.k;
    const double k2 = k[0] * k[0] + k[1] * k[1] + k[2] * k[2];
    if (nx <= most[0] && ay <= most[1] && az <= most[2] && k2 > 0.0 && k2 <= k_cut2) {
      const double window = inverse_window[0][nx] * inverse_window[1][ay] * inverse_window[2][az];
      wave.side = is_conjugate(nx, ny, nz) ? -1.0 : 1.0;
      const uint64_t number = drawn_wave(nx, ny, nz);
      double root[shapes];
      // Rounded to the precision of the table on the host.
      for (int s = 0; s < shapes; ++s)
        root[s] = static_cast<Real>(split.root(std::sqrt(k2), radius[s]) * window);
      add_term(index, wave, root, number, re, im);
      if (shapes == 2 && split.two_terms()) {
        for (double &r : root) r = static_cast<Real>(split.common_root(std::sqrt(k2)) * window);
        add_term(index, wave, root, common_draw(number), re, im);
      }
    }
    for (int d = 0; d < dim * shapes; ++d) {
      field[d][2 * index] = re[d];
      field[d][2 * index + 1] = im[d];
    }
  }

  /// Adds the velocity of a term to what either shape reads.
  BDH_FN void add_term(long index, Wave wave, const double *root, uint64_t number, double *re,
                       double *im) const
  {
    double v_re[dim] = {}, v_im[dim] = {};
    for (int s = 0; s < shapes; ++s) {
      const double w = shapes == 1 ? 1.0 : root[s];
      for (int d = 0; d < dim; ++d) {
        v_re[d] += w * field[dim * s + d][2 * index];
        v_im[d] += w * field[dim * s + d][2 * index + 1];
      }
    }
    wave.weight = shapes == 1 ? root[0] : 1.0;
    double z[4] = {};
    if (strength.amplitude != 0.0) {
      normal4(counter, number, z[0], z[1], z[2], z[3]);
      for (double &part : z) part *= root_half;
    }
    solve_wave(wave, strength, z, v_re, v_im);
    for (int s = 0; s < shapes; ++s) {
      const double w = shapes == 1 ? 1.0 : root[s];
      for (int d = 0; d < dim; ++d) {
        re[dim * s + d] += w * v_re[d];
        im[dim * s + d] += w * v_im[d];
      }
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

/// The counterpart of WaveSpace, with device pointers.  shapes: shape functions.
template <class Real, int shapes, class Exec> class DeviceWaveSpace {
 public:
  /// Collective.
  DeviceWaveSpace(const PsePlan &plan, const Comm &comm, SpreadBy by = SpreadBy::automatic) :
      plan_(plan), grid_(fractional_grid(plan.n)), fft_(grid_, comm),
      spreader_(plan.n, fft_.slab(), plan.window, plan.window_error, by),
      exchange_(fft_.parts(), plan.moments())
  {
    for (auto &f : field_) f.resize(fft_.allocation());
    for (int d = 0; d < dim; ++d) {
      most_[d] = (plan.n[d] - 1) / 2;
      const std::vector<double> inverse = inverse_window(plan.window, plan.n[d]);
      inverse_window_[d].assign(inverse.data(), inverse.size());
    }
  }

  bool fits(const Cell &cell) const { return grid_fits(plan_, cell); }
  void set_cell(const Cell &cell) { cell_ = cell; }
  void set_radii(const PsePlan &plan)
  {
    plan_.radius = plan.radius;
    plan_.least_radius = plan.least_radius;
  }

  /// Collective.  Takes particles, whose positions must be finite.
  void bind(const PseParticles<DeviceNeighbors> &particles)
  {
    const PhaseScope phase(Phase::spread);
    fractional_.resize(dim * particles.count);
    device_for<Exec>("bdh::fractional", particles.count,
                     ToFractional{cell_, particles.x, fractional_.data()});
    exchange_.plan(particles.count, spreader_.first_lines(fractional_.data()), spreader_.reach());
    radius_ = plan_.is_plain() ? nullptr : exchange_.radii(particles.radius);
    spreader_.bind(exchange_.positions(fractional_.data()), exchange_.count());
    Exec().fence();
  }

  /// Collective.  velocity := M_w forces + its noise.
  void apply(const PseForces &forces, const PseNoise &noise, double viscosity,
             const PseVelocities &velocity)
  {
    spread(forces);
    transform(forces, modes(noise, viscosity));
    const PhaseScope phase(Phase::interpolate);
    const PseVelocities parts = exchange_.parts(velocity);
    if (plan_.is_plain())
      spreader_.interpolate(view(), parts.linear);
    else
      spreader_.template interpolate_spheres<shapes>(spheres(), radius_, plan_.moments(), parts);
    exchange_.take_back(velocity);
    Exec().fence();
  }

  std::size_t grid_memory() const { return fft_.memory() + bytes_of(field_); }
  std::size_t particle_memory() const
  {
    return spreader_.memory() + exchange_.memory() + bytes_of(fractional_);
  }

 private:
  std::array<Real *, dim> view() { return {field_[0].data(), field_[1].data(), field_[2].data()}; }

  SphereWindow<Real> spheres()
  {
    SphereWindow<Real> s{spreader_.window(view()), {}, {}, plan_.basis()};
    for (int d = 0; d < dim; ++d) {
      s.second[d] = field_[dim * (shapes - 1) + d].data();
      gradient_of_spacings(cell_, d, grid_.n[d], s.axes[d]);
    }
    return s;
  }

  void spread(const PseForces &forces)
  {
    const PhaseScope phase(Phase::spread);
    for (auto &f : field_) f.clear_values();
    if (forces.act) {
      const PseForces here = exchange_.bring(forces);
      if (plan_.is_plain())
        spreader_.spread(here.values, view());
      else
        spreader_.template spread_spheres<shapes>(spheres(), radius_, plan_.moments(), here);
    }
    Exec().fence();
  }

  void transform(const PseForces &forces, const SolveWave<Real, shapes> &modes)
  {
    const PhaseScope phase(Phase::transform);
    if (forces.act)
      for (auto &f : field_) fft_.forward(f.data());
    device_for<Exec>("bdh::waves", modes.modes.count(), modes);
    for (auto &f : field_) fft_.backward(f.data());
    Exec().fence();
  }

  SolveWave<Real, shapes> modes(const PseNoise &noise, double viscosity)
  {
    SolveWave<Real, shapes> s{};
    s.cell = cell_;
    s.modes = fft_.modes();
    s.half = grid_.half();
    for (int d = 0; d < dim; ++d) {
      s.n[d] = grid_.n[d];
      s.most[d] = most_[d];
      s.inverse_window[d] = inverse_window_[d].data();
    }
    for (int d = 0; d < dim * shapes; ++d) s.field[d] = field_[d].data();
    s.k_cut2 = plan_.k_cut * plan_.k_cut;
    s.radius[shapes - 1] = plan_.basis().b2;
    s.radius[0] = plan_.basis().b1;
    s.split = plan_.wave_weight();
    const double resistance = viscosity * cell_.volume();
    s.strength = {1.0 / resistance, std::sqrt(noise.variance / resistance)};
    s.counter = noise.counter(Stream::wave_space);
    return s;
  }

  PsePlan plan_;
  Grid grid_;    // in fractional coordinates
  Cell cell_;
  long most_[dim];
  const double *radius_ = nullptr;
  DeviceFft<Real, Exec> fft_;
  DeviceSphereSpreader<Real, Exec> spreader_;
  DeviceSphereExchange<Exec> exchange_;
  DeviceArray<Real, Exec> field_[dim * shapes];
  DeviceArray<double, Exec> inverse_window_[dim], fractional_;
};

}    // namespace bdh
#endif
