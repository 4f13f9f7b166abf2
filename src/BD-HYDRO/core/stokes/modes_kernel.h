// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// One Fourier mode of the staggered-grid Stokes equations and of their fluctuations.
///
/// On the MAC grid the gradient along axis d has the symbol g_d = i e^{-i theta/2} s_d with
/// s_d = 2 sin(theta/2)/h_d and theta = 2 pi k_d/n_d; the divergence is -conj(g), the Laplacian of
/// every component -lambda with lambda = s.s.  With Phi = diag(e^{-i theta_d/2}) the projection on
/// divergence-free fields is Phi (I - s s^T/lambda) Phi^*: real but for the phases. [FIB sec. III
/// B, eq. (28)-(29)]
#ifndef BDH_STOKES_MODES_KERNEL_H
#define BDH_STOKES_MODES_KERNEL_H

#include "base/constants.h"
#include "base/portable.h"

#include <cmath>
#include <cstdint>

namespace bdh {

/// Symbols of one axis at one index.
struct AxisSymbol {
  double s;           // 2 sin(theta/2)/h >= 0    [1/length]
  double cos_half;    // cos(theta/2)
  double sin_half;    // sin(theta/2)
};

/// index in 0 .. n-1, spacing h [length].
BDH_FN AxisSymbol axis_symbol(long index, long n, double h)
{
  const double half = pi * static_cast<double>(index) / static_cast<double>(n);
  return {2.0 * std::sin(half) / h, std::cos(half), std::sin(half)};
}

/// f := e^{+i theta/2} f: from the component's own faces to the cell corner.
BDH_FN void to_corner(const AxisSymbol &a, double &re, double &im)
{
  const double t = a.cos_half * re - a.sin_half * im;
  im = a.cos_half * im + a.sin_half * re;
  re = t;
}

/// f := e^{-i theta/2} f: back to the component's faces.
BDH_FN void to_face(const AxisSymbol &a, double &re, double &im)
{
  const double t = a.cos_half * re + a.sin_half * im;
  im = a.cos_half * im - a.sin_half * re;
  re = t;
}

/// lambda, or where it is 0, infinity, so that dividing by it gives 0.
BDH_FN double finite_or_endless(double lambda) { return lambda > 0.0 ? lambda : HUGE_VAL; }

/// Velocity at the corner: v = (I - s s^T/lambda) f / lambda * response + amplitude/sqrt(lambda)
/// (e1 z1 + e2 z2), e1, e2 an orthonormal basis of the plane normal to s.  In: f, out: v (both at
/// the corner). \param response   1/(viscosity * cells): the transforms are not normalised \param
/// amplitude  sqrt(2 kT/(viscosity dt dV cells)): M^(1/2) of FIB eq. (30), for E|z|^2 = 1 \param z
/// z1 = z[0] + i z[1], z2 = z[2] + i z[3] lambda = 0 (k = 0) gives v = 0: a mean pressure gradient
/// balances the net force.
BDH_FN void corner_velocity_3d(double sx, double sy, double sz, double response, double amplitude,
                               const double *z, double *re, double *im)
{
  const double root = std::sqrt(finite_or_endless(sx * sx + sy * sy + sz * sz));
  const double inv_root = 1.0 / root, nx = sx * inv_root, ny = sy * inv_root, nz = sz * inv_root;
  const double p_re = nx * re[0] + ny * re[1] + nz * re[2],
               p_im = nx * im[0] + ny * im[1] + nz * im[2];
  const double c = response * (inv_root * inv_root);
  // Basis of Duff et al., JCGT 6 (2017); s >= 0 by construction, so its sign is always +.
  const double g = amplitude * inv_root;
  const double a = -1.0 / (1.0 + nz), b = nx * ny * a, e1x = 1.0 + nx * nx * a,
               e2y = 1.0 + ny * ny * a;
  re[0] = (re[0] - nx * p_re) * c + g * (e1x * z[0] + b * z[2]);
  im[0] = (im[0] - nx * p_im) * c + g * (e1x * z[1] + b * z[3]);
  re[1] = (re[1] - ny * p_re) * c + g * (b * z[0] + e2y * z[2]);
  im[1] = (im[1] - ny * p_im) * c + g * (b * z[1] + e2y * z[3]);
  re[2] = (re[2] - nz * p_re) * c - g * (nx * z[0] + ny * z[2]);
  im[2] = (im[2] - nz * p_im) * c - g * (nx * z[1] + ny * z[3]);
}

/// The same in two dimensions: one direction is left, one complex normal is used (z[0], z[1]).
BDH_FN void corner_velocity_2d(double sx, double sy, double response, double amplitude,
                               const double *z, double *re, double *im)
{
  const double inv_root = 1.0 / std::sqrt(finite_or_endless(sx * sx + sy * sy));
  const double tx = -sy * inv_root, ty = sx * inv_root, c = response * (inv_root * inv_root),
               g = amplitude * inv_root;
  const double qr = (tx * re[0] + ty * re[1]) * c + g * z[0];
  const double qi = (tx * im[0] + ty * im[1]) * c + g * z[1];
  re[0] = tx * qr;
  im[0] = tx * qi;
  re[1] = ty * qr;
  im[1] = ty * qi;
}

/// One mode, from force to velocity, both on their faces; parameters as above, D = 2 or 3
/// components.
template <int D> BDH_FN void solve_mode(const AxisSymbol *axis, double response, double amplitude,
                                        const double *z, double *re, double *im)
{
  for (int d = 0; d < D; ++d) to_corner(axis[d], re[d], im[d]);
  if (D == 3)
    corner_velocity_3d(axis[0].s, axis[1].s, axis[D - 1].s, response, amplitude, z, re, im);
  else
    corner_velocity_2d(axis[0].s, axis[1].s, response, amplitude, z, re, im);
  for (int d = 0; d < D; ++d) to_face(axis[d], re[d], im[d]);
}

/// Number of a mode: its place in an array without padding.  n: cells per axis.
BDH_FN uint64_t mode_number(const long *n, long kx, long ky, long kz)
{
  return static_cast<uint64_t>((kz * n[1] + ky) * (n[0] / 2 + 1) + kx);
}

/// Where a mode's conjugate is stored too: the columns at the edges of the half space.
BDH_FN bool is_edge_column(const long *n, long kx) { return kx == 0 || 2 * kx == n[0]; }

/// Whose random numbers a mode takes.  At an edge a mode and its conjugate both take the draw of
/// the one with the smaller number; a mode that is its own conjugate is real, and the whole
/// variance is in its real part.
struct DrawnMode {
  enum Role { drawn, conjugate, real };
  Role role;
  uint64_t number;    ///< of the draw
  long k[3];          ///< mode that the draw is for
};

/// k: indices in 0 .. n - 1, k_x in the half space.
BDH_FN DrawnMode drawn_mode(const long *n, const long *k)
{
  DrawnMode m{DrawnMode::drawn, mode_number(n, k[0], k[1], k[2]), {k[0], k[1], k[2]}};
  if (!is_edge_column(n, k[0])) return m;
  const long minus[3] = {k[0], (n[1] - k[1]) % n[1], (n[2] - k[2]) % n[2]};
  const uint64_t other = mode_number(n, minus[0], minus[1], minus[2]);
  if (other == m.number) m.role = DrawnMode::real;
  if (other >= m.number) return m;
  return {DrawnMode::conjugate, other, {minus[0], minus[1], minus[2]}};
}

/// The draw's axis symbols and normals (z[0] .. z[3], E|z|^2 = 1 per complex number) as its role
/// wants them.
BDH_FN void prepare_draw(DrawnMode::Role role, AxisSymbol *axis, double *z)
{
  if (role != DrawnMode::real) return;
  const double root2 = 1.41421356237309504880;
  for (int d = 0; d < 3; ++d) axis[d] = {axis[d].s, 1.0, 0.0};
  z[0] *= root2;
  z[2] *= root2;
  z[1] = z[3] = 0.0;
}

}    // namespace bdh
#endif
