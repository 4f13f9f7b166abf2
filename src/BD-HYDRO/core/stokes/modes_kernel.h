// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// One Fourier mode of the Stokes equations on a staggered grid, and of their fluctuations.
///
/// On the MAC grid the gradient along axis d has the symbol g_d = i e^{-i theta/2} s_d with
/// s_d = 2 sin(theta/2)/h_d and theta = 2 pi k_d/n_d.  The divergence has -conj(g), and the
/// Laplacian of every component -lambda with lambda = s.s.  With Phi = diag(e^{-i theta_d/2}) the
/// projection onto divergence-free fields is Phi (I - s s^T/lambda) Phi^*: real apart from the
/// phases.  See FIB sec. III B, eq. (28)-(29).
#ifndef BDH_STOKES_MODES_KERNEL_H
#define BDH_STOKES_MODES_KERNEL_H

#include "base/constants.h"
#include "base/portable.h"

#include <cmath>
#include <cstdint>

namespace bdh {

/// The symbols of one axis at one index.
template <class Real> struct AxisSymbolOf {
  Real s;           // 2 sin(theta/2)/h >= 0    [1/length]
  Real cos_half;    // cos(theta/2)
  Real sin_half;    // sin(theta/2)
};
using AxisSymbol = AxisSymbolOf<double>;

/// index: 0 .. n - 1; h: spacing [length]
BDH_FN AxisSymbol axis_symbol(long index, long n, double h)
{
  const double half = pi * index / n;
  return {2.0 * std::sin(half) / h, std::cos(half), std::sin(half)};
}

/// f := e^{+i theta/2} f, which takes a component from its faces to the cell corner.
template <class Real> BDH_FN_IN_LOOP void to_corner(const AxisSymbolOf<Real> &a, Real &re, Real &im)
{
  const Real t = a.cos_half * re - a.sin_half * im;
  im = a.cos_half * im + a.sin_half * re;
  re = t;
}

/// f := e^{-i theta/2} f, which takes it back to its faces.
template <class Real> BDH_FN_IN_LOOP void to_face(const AxisSymbolOf<Real> &a, Real &re, Real &im)
{
  const Real t = a.cos_half * re + a.sin_half * im;
  im = a.cos_half * im - a.sin_half * re;
  re = t;
}

/// lambda, but infinity where it is 0, so that dividing by it gives 0.
template <class Real> BDH_FN Real finite_or_endless(Real lambda)
{
  return lambda > Real(0) ? lambda : Real(HUGE_VAL);
}

/// Velocity at the cell corner from the force there,
///     v = response (I - s s^T/lambda) f/lambda + amplitude/sqrt(lambda) (e1 z1 + e2 z2),
/// where e1, e2 are an orthonormal basis of the plane normal to s.  k = 0, where lambda = 0, gives
/// v = 0: a mean pressure gradient balances the net force.
///
/// \param response   1/(viscosity * cells), since the transforms are not normalised
/// \param amplitude  sqrt(2 kT/(viscosity dt dV cells)): M^(1/2) of FIB eq. (30), for E|z|^2 = 1
/// \param z          z1 = z[0] + i z[1], z2 = z[2] + i z[3]
template <class Real> BDH_FN void corner_velocity_3d(Real sx, Real sy, Real sz, Real response,
                                                     Real amplitude, const Real *z, Real *re,
                                                     Real *im)
{
  const Real root = std::sqrt(finite_or_endless(sx * sx + sy * sy + sz * sz));
  const Real inv_root = Real(1) / root, nx = sx * inv_root, ny = sy * inv_root, nz = sz * inv_root;
  const Real p_re = nx * re[0] + ny * re[1] + nz * re[2],
             p_im = nx * im[0] + ny * im[1] + nz * im[2];
  const Real c = response * (inv_root * inv_root);
  // The basis is that of Duff et al., JCGT 6 (2017).  Its sign is always +, since s >= 0.
  const Real g = amplitude * inv_root;
  const Real a = Real(-1) / (Real(1) + nz), b = nx * ny * a, e1x = Real(1) + nx * nx * a,
             e2y = Real(1) + ny * ny * a;
  re[0] = (re[0] - nx * p_re) * c + g * (e1x * z[0] + b * z[2]);
  im[0] = (im[0] - nx * p_im) * c + g * (e1x * z[1] + b * z[3]);
  re[1] = (re[1] - ny * p_re) * c + g * (b * z[0] + e2y * z[2]);
  im[1] = (im[1] - ny * p_im) * c + g * (b * z[1] + e2y * z[3]);
  re[2] = (re[2] - nz * p_re) * c - g * (nx * z[0] + ny * z[2]);
  im[2] = (im[2] - nz * p_im) * c - g * (nx * z[1] + ny * z[3]);
}

/// The same in two dimensions: only one direction is left, with one complex normal (z[0], z[1]).
template <class Real> BDH_FN void corner_velocity_2d(Real sx, Real sy, Real response,
                                                     Real amplitude, const Real *z, Real *re,
                                                     Real *im)
{
  const Real inv_root = Real(1) / std::sqrt(finite_or_endless(sx * sx + sy * sy));
  const Real tx = -sy * inv_root, ty = sx * inv_root, c = response * (inv_root * inv_root),
             g = amplitude * inv_root;
  const Real qr = (tx * re[0] + ty * re[1]) * c + g * z[0];
  const Real qi = (tx * im[0] + ty * im[1]) * c + g * z[1];
  re[0] = tx * qr;
  im[0] = tx * qi;
  re[1] = ty * qr;
  im[1] = ty * qi;
}

/// One mode with D = 2 or 3 components, from force to velocity, both on their faces.  The
/// parameters are those of corner_velocity_3d().
template <int D, class Real> BDH_FN void solve_mode(const AxisSymbolOf<Real> *axis, Real response,
                                                    Real amplitude, const Real *z, Real *re,
                                                    Real *im)
{
  for (int d = 0; d < D; ++d) to_corner(axis[d], re[d], im[d]);
  if (D == 3)
    corner_velocity_3d(axis[0].s, axis[1].s, axis[D - 1].s, response, amplitude, z, re, im);
  else
    corner_velocity_2d(axis[0].s, axis[1].s, response, amplitude, z, re, im);
  for (int d = 0; d < D; ++d) to_face(axis[d], re[d], im[d]);
}

/// Number of a mode: its place in an array without padding.  n: cells per axis
BDH_FN uint64_t mode_number(const long *n, long kx, long ky, long kz)
{
  return (kz * n[1] + ky) * (n[0] / 2 + 1) + kx;
}

/// The columns at the edges of the half space, where the conjugate of a mode is stored as well.
BDH_FN bool is_edge_column(const long *n, long kx) { return kx == 0 || 2 * kx == n[0]; }

/// The mode whose random numbers a mode takes.  At an edge a mode and its conjugate both take the
/// draw of the one with the smaller number.  A mode that is its own conjugate is real: the whole
/// variance is in its real part.
struct DrawnMode {
  enum Role { drawn, conjugate, real };
  Role role;
  uint64_t number;    ///< of the draw
  long k[3];          ///< the mode that the draw belongs to
};

/// k: indices in 0 .. n - 1, with k_x in the half space
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

/// Adapts the axis symbols and the normals of a draw (z[0] .. z[3], E|z|^2 = 1 per complex number)
/// to its role.
template <class Real>
BDH_FN void prepare_draw(DrawnMode::Role role, AxisSymbolOf<Real> *axis, Real *z)
{
  if (role != DrawnMode::real) return;
  const Real root2 = 1.41421356237309504880;
  for (int d = 0; d < 3; ++d) axis[d] = {axis[d].s, Real(1), Real(0)};
  z[0] *= root2;
  z[2] *= root2;
  z[1] = z[3] = 0;
}

}    // namespace bdh
#endif
