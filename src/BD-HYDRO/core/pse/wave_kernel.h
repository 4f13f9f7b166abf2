// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// One wave vector of positively split Ewald: its number, its weight and its velocity.
/// See PSE (9), (11), (19)-(21).
#ifndef BDH_PSE_WAVE_KERNEL_H
#define BDH_PSE_WAVE_KERNEL_H

#include "pse/layout.h"
#include "pse/splitting_kernel.h"
#include "stokes/modes_kernel.h"

#include <cmath>
#include <cstdint>

namespace bdh {

/// Number of a wave vector among all wave vectors.  It does not depend on the grid, so that a
/// tighter tolerance keeps the noise of each mode.  Requires |n| < 2^17 = 131072 along each axis.
BDH_FN uint64_t wave_number(long nx, long ny, long nz)
{
  const long bias = 131072;
  const uint64_t x = nx + bias, y = ny + bias, z = nz + bias;
  return z << 36 | y << 18 | x;
}

/// Whether a mode takes the draw of its conjugate.  In the column n_x = 0, which contains both, the
/// one with the smaller number does.
BDH_FN bool is_conjugate(long nx, long ny, long nz)
{
  return nx == 0 && wave_number(0, ny, nz) < wave_number(0, -ny, -nz);
}

/// Number of the mode whose draw a mode takes.
BDH_FN uint64_t drawn_wave(long nx, long ny, long nz)
{
  return is_conjugate(nx, ny, nz) ? wave_number(0, -ny, -nz) : wave_number(nx, ny, nz);
}

/// Signed index of point i of n.
BDH_FN long signed_index(long i, long n) { return 2 * i < n ? i : i - n; }

/// Number of the draw that the second term of WaveWeight takes, from that of the first.
BDH_FN uint64_t common_draw(uint64_t number) { return number | uint64_t(1) << 54; }

/// A mode, as the transforms know it.
struct Wave {
  double k[dim];    ///< wave vector [1/length]
  double side;      ///< -1 if it takes the draw of its conjugate, 1 if its own
  double weight;    ///< a root of WaveWeight divided by the transform of the window
};

/// What all modes of one evaluation share.
struct WaveStrength {
  double response;     ///< of velocities to forces: 1/(viscosity volume)
  double amplitude;    ///< of the noise, for E|z|^2 = 1: sqrt(variance/(viscosity volume))
};

/// From the transform of the forces to that of the velocities.  Both still contain the window,
/// which the weight divides out.
///
/// \param z        z1 = z[0] + i z[1], z2 = z[2] + i z[3] of the drawn mode
/// \param re, im   dim components
BDH_FN void solve_wave(const Wave &wave, const WaveStrength &strength, const double *z, double *re,
                       double *im)
{
  // The projection is even in k.  The basis of the noise requires k_z >= 0, and must be the same
  // for a mode and its conjugate.  In a sheared box k_z may be the difference of equal numbers,
  // whose sign is accidental.
  const double least = 1e-12 * (std::fabs(wave.k[0]) + std::fabs(wave.k[1]));
  const double side = wave.side, up = side * wave.k[2] < -least ? -side : side;
  const double own[4] = {z[0], side * z[1], z[2], side * z[3]};
  corner_velocity_3d(up * wave.k[0], up * wave.k[1], up * wave.k[2],
                     strength.response * wave.weight * wave.weight,
                     strength.amplitude * wave.weight, own, re, im);
}

}    // namespace bdh
#endif
