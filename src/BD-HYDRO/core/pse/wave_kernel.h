// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// One wave vector of positively split Ewald: its number, its weight, its velocity.          [PSE
/// (9), (11), (19)-(21)]
#ifndef BDH_PSE_WAVE_KERNEL_H
#define BDH_PSE_WAVE_KERNEL_H

#include "pse/rpy_kernel.h"
#include "stokes/modes_kernel.h"

#include <cmath>
#include <cstdint>

namespace bdh {

/// Number of a wave vector among all wave vectors, whatever the grid: tighter tolerances keep the
/// noise of each mode. |n| < 2^17, which 131072 grid points would need.
BDH_FN uint64_t wave_number(long nx, long ny, long nz)
{
  const long bias = 131072;
  return (static_cast<uint64_t>(nz + bias) << 36) | (static_cast<uint64_t>(ny + bias) << 18) |
         static_cast<uint64_t>(nx + bias);
}

/// True if the mode takes the draw of its conjugate: both lie in the column n_x = 0, and this is
/// the one with the smaller number.
BDH_FN bool is_conjugate(long nx, long ny, long nz)
{
  return nx == 0 && wave_number(0, ny, nz) < wave_number(0, -ny, -nz);
}

/// Number of the mode whose draw this one takes.
BDH_FN uint64_t drawn_wave(long nx, long ny, long nz)
{
  return is_conjugate(nx, ny, nz) ? wave_number(0, -ny, -nz) : wave_number(nx, ny, nz);
}

/// sqrt(sinc^2(ka) H(k)), k = |k| > 0   [1/length]
BDH_FN double wave_weight(double k, double radius, double xi)
{
  return sinc(k * radius) * std::sqrt(hasimoto_split(k, xi));
}

/// Index in the signed range, of n points.
BDH_FN long signed_index(long i, long n) { return 2 * i < n ? i : i - n; }

/// From the transform of the forces to that of the velocities, both before the window is divided
/// out twice. \param k          wave vector [1/length] \param weight     wave_weight() over the
/// window's transform \param response   1/(viscosity volume) \param amplitude  sqrt(2 kT/(dt
/// viscosity volume)), for E|z|^2 = 1 \param z          z1 = z[0] + i z[1], z2 = z[2] + i z[3], of
/// the drawn mode
BDH_FN void solve_wave(double kx, double ky, double kz, bool conjugate, double weight,
                       double response, double amplitude, const double *z, double *re, double *im)
{
  // The projection is even in k.  The basis of the noise requires k_z >= 0, and the same for a mode
  // and its conjugate.
  const double side = conjugate ? -1.0 : 1.0, up = side * kz < 0.0 ? -side : side;
  const double own[4] = {z[0], side * z[1], z[2], side * z[3]};
  corner_velocity_3d(up * kx, up * ky, up * kz, response * weight * weight, amplitude * weight, own,
                     re, im);
}

}    // namespace bdh
#endif
