// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Fourier modes of the Stokes equations between two parallel walls on the staggered grid, from
/// force to velocity.
///
/// In the periodic directions a mode has the symbols s_x, s_y of stokes/modes_kernel.h, with
/// s^2 = s_x^2 + s_y^2.  Across the channel (spacing h) it is a line of values, one for each row of
/// the grid.  The velocity splits into a transverse part u_t (along the walls, normal to the wave
/// vector), which is independent of the pressure, and a part in the plane of the wave vector and
/// the wall normal.  In that plane the divergence-free fields are the images Z w of the normal
/// velocity on the inner faces,
///     u_l = i (w_{j+1} - w_j)/(h s),
/// so that the Stokes solution is Z (Z* (-L) Z)^-1 Z* f.  It needs no pressure and is symmetric by
/// construction.  With the tridiagonal T of u -> -h^2 u'' on the faces (w = 0 on the walls),
///     Z* (-L) Z = P/(s^2 h^4),
///     P = (s^2 h^2 + T)^2 + 2 e_1 e_1^T [lower wall no-slip] + 2 e_m e_m^T [upper wall no-slip],
/// which has five diagonals.  P = R^T R gives the noise, too: R^-1 z has the covariance P^-1.
///
/// Everything is written for W modes handled together: as many as fill vector registers on the
/// host, one on a device.  They take one pass over the rows from the lower wall up and one back
/// down.
#ifndef BDH_STOKES_SLIT_KERNEL_H
#define BDH_STOKES_SLIT_KERNEL_H

#include "base/portable.h"
#include "stokes/modes_kernel.h"

#include <cmath>
#include <cstdint>

namespace bdh {

/// A number for each of W modes.
template <long W> struct Lanes {
  alignas(W < 8 ? 8 : 64) double v[W];
  BDH_FN double &operator[](long i) { return v[i]; }
  BDH_FN double operator[](long i) const { return v[i]; }
};
template <long W> struct ComplexLanes {
  Lanes<W> re, im;
};

/// Change of the first or last diagonal entry of both matrices, +1 or -1, due to the ghost value
/// half a spacing behind the wall: u_ghost = -u (no-slip) or +u (free-slip).
BDH_FN double wall_term(bool noslip) { return noslip ? 1.0 : -1.0; }

/// One row of P = L D L^T.  The entries of L are l1 on the first subdiagonal and 1/D_{j-2} on the
/// second.
struct PentadiagonalRow {
  double l1, inv_d;    // l1 of this row, 1/D of this row
};

/// The next row of P.
/// \param sigma    s^2 h^2 > 0
/// \param ends     sum of wall_term() over the walls next to this row
/// \param one,two  the previous row and the one before it; {0, 0} where there is none
BDH_FN PentadiagonalRow next_pentadiagonal(double sigma, double ends, PentadiagonalRow one,
                                           PentadiagonalRow two)
{
  const double diagonal = sigma * sigma + 4.0 * sigma + 6.0 + ends, off = -(2.0 * sigma + 4.0);
  PentadiagonalRow row;
  row.l1 = (off - one.l1) * one.inv_d;
  row.inv_d = 1.0 / (diagonal - row.l1 * (off - one.l1) - two.inv_d);
  return row;
}

/// The next 1/D of h^2 (-L) for a velocity parallel to the walls.  The matrix is tridiagonal with
/// off-diagonal entries -1, so the subdiagonal of L is -1/D of the previous row (0 if none).
BDH_FN double next_tridiagonal(double sigma, double ends, double inv_d_before)
{
  return 1.0 / (2.0 + sigma + ends - inv_d_before);
}

/// The parameters that all modes of a solve share.
struct SlitChannel {
  long n[2];                 ///< grid points along the walls; in 2D n[1] = 1
  double h_along[2];         ///< their spacings [length]
  long rows;                 ///< lines across the channel
  double h;                  ///< their spacing [length]
  double lower, upper;       ///< wall_term() of the walls
  double viscosity, area;    ///< area of a wall [length^(dim - 1)]
  /// The same as in stokes/modes_kernel.h, but with transforms only along the walls.  Without noise
  /// the amplitude is 0.
  double response, amplitude;

  BDH_FN double points() const { return n[0] * n[1]; }
  BDH_FN long modes() const { return (n[0] / 2 + 1) * n[1]; }
  BDH_FN double ends(long row, long first) const
  {
    return (row == first ? lower : 0.0) + (row == rows - 1 ? upper : 0.0);
  }
};

/// Number of a mode's draw in row 0; each further row adds modes().  At the edges of the half space
/// a mode and its conjugate both take the draw of the one with the smaller number.
BDH_FN uint64_t slit_draw(const SlitChannel &c, long kx, long ky)
{
  const long minus = (c.n[1] - ky) % c.n[1];
  return mode_number(c.n, kx, is_edge_column(c.n, kx) && minus < ky ? minus : ky, 0);
}

/// Turns the normals of a draw into those of a mode in an edge column: the complex conjugates, or
/// real ones of the same variance for a mode that is its own conjugate.  At theta = pi the phase of
/// stokes/modes_kernel.h is e^{-i theta/2} = -i, the negative of its conjugate, which explains the
/// signs of the transverse part.
BDH_FN void make_edge_real(const SlitChannel &c, long kx, long ky, double &z0, double &z1,
                           double &z2, double &z3)
{
  if (!is_edge_column(c.n, kx)) return;
  const long minus = (c.n[1] - ky) % c.n[1];
  const bool real = ky == minus, conjugate = ky > minus, half_x = kx != 0, half_y = real && ky != 0;
  const double root2 = 1.41421356237309504880;
  if (real) {
    const double t = root2 * z2;
    z0 *= root2;
    z1 = 0.0;
    z2 = half_x && half_y ? 0.0 : t;
    z3 = half_x && half_y ? t : 0.0;
  } else if (conjugate) {
    z1 = -z1;
    if (half_x)
      z2 = -z2;
    else
      z3 = -z3;
  }
}

/// W modes with the same k_y.  The mode k = 0 gets arbitrary symbols, since solve_mean_flow()
/// handles it.
template <long W> struct SlitModes {
  Lanes<W> cos_half, sin_half;    // of the axis symbol along x
  AxisSymbol y;
  Lanes<W> nx, ny;              // s_x/s, s_y/s
  Lanes<W> s, sigma, inv_hs;    // s, s^2 h^2, 1/(h s)

  BDH_FN SlitModes(const SlitChannel &c, long ky) : y(axis_symbol(ky, c.n[1], c.h_along[1])) {}
  BDH_FN void set(const SlitChannel &c, long i, long kx)
  {
    const AxisSymbol x = axis_symbol(kx, c.n[0], c.h_along[0]);
    const double s2 = x.s * x.s + y.s * y.s;
    cos_half[i] = x.cos_half;
    sin_half[i] = x.sin_half;
    s[i] = s2 > 0.0 ? std::sqrt(s2) : 1.0 / c.h;
    nx[i] = s2 > 0.0 ? x.s / s[i] : 1.0;
    ny[i] = y.s / s[i];
    sigma[i] = s[i] * s[i] * c.h * c.h;
    inv_hs[i] = 1.0 / (c.h * s[i]);
  }
};

/// Splits the D components of a row, each on its faces, into the longitudinal, the transverse (in
/// 3D) and the normal part.
template <int D, long W> BDH_FN void to_parts(const SlitModes<W> &m, ComplexLanes<W> *u)
{
  BDH_INDEPENDENT
  for (long i = 0; i < W; ++i) {
    double xr = u[0].re[i], xi = u[0].im[i], yr = D == 3 ? u[1].re[i] : 0.0,
           yi = D == 3 ? u[1].im[i] : 0.0;
    to_corner({0.0, m.cos_half[i], m.sin_half[i]}, xr, xi);
    to_corner(m.y, yr, yi);
    u[0].re[i] = m.nx[i] * xr + m.ny[i] * yr;
    u[0].im[i] = m.nx[i] * xi + m.ny[i] * yi;
    if (D == 2) continue;
    u[1].re[i] = m.nx[i] * yr - m.ny[i] * xr;
    u[1].im[i] = m.nx[i] * yi - m.ny[i] * xi;
  }
}

/// The inverse of to_parts().
template <int D, long W> BDH_FN void to_components(const SlitModes<W> &m, ComplexLanes<W> *u)
{
  BDH_INDEPENDENT
  for (long i = 0; i < W; ++i) {
    const double tr = D == 3 ? u[1].re[i] : 0.0, ti = D == 3 ? u[1].im[i] : 0.0;
    double xr = m.nx[i] * u[0].re[i] - m.ny[i] * tr, xi = m.nx[i] * u[0].im[i] - m.ny[i] * ti;
    double yr = m.ny[i] * u[0].re[i] + m.nx[i] * tr, yi = m.ny[i] * u[0].im[i] + m.nx[i] * ti;
    to_face({0.0, m.cos_half[i], m.sin_half[i]}, xr, xi);
    to_face(m.y, yr, yi);
    u[0].re[i] = xr;
    u[0].im[i] = xi;
    if (D == 2) continue;
    u[1].re[i] = yr;
    u[1].im[i] = yi;
  }
}

/// Elimination for h^2 (-L) = R^T R with R = D^1/2 R', row by row upwards:
///     t := response h^2 D^-1 R'^-T f + amplitude h D^-1/2 z.
template <long W> struct TransverseElimination {
  Lanes<W> before;
  ComplexLanes<W> y;

  template <class Normals, class Complex, class Real>
  BDH_FN void operator()(const SlitChannel &c, const SlitModes<W> &m, long row,
                         const ComplexLanes<W> &f, const Normals &z, Complex &&t, Real &&inv_d)
  {
    const double force = c.response * c.h * c.h, noise = c.amplitude * c.h, end = c.ends(row, 0);
    BDH_INDEPENDENT
    for (long i = 0; i < W; ++i) {
      y.re[i] = force * f.re[i] + before[i] * y.re[i];
      y.im[i] = force * f.im[i] + before[i] * y.im[i];
      const double d = next_tridiagonal(m.sigma[i], end, before[i]), root = noise * std::sqrt(d);
      inv_d[i] = before[i] = d;
      t.re[i] = y.re[i] * d + root * z.z[2][i];
      t.im[i] = y.im[i] * d + root * z.z[3][i];
    }
  }
};

/// Substitution u := R'^-1 t, row by row downwards.
template <long W> struct TransverseSubstitution {
  ComplexLanes<W> above;

  template <class Complex, class Real>
  BDH_FN void operator()(const Complex &t, const Real &inv_d, ComplexLanes<W> &u)
  {
    BDH_INDEPENDENT
    for (long i = 0; i < W; ++i) {
      u.re[i] = above.re[i] = t.re[i] + inv_d[i] * above.re[i];
      u.im[i] = above.im[i] = t.im[i] + inv_d[i] * above.im[i];
    }
  }
};

/// Elimination for P = L D L^T, row by row upwards from row 1:
///     w := response s^2 h^4 D^-1 L^-1 Z* f + amplitude s h^2 D^-1/2 z.
/// Row 0 lies in the wall, where w = 0.
template <long W> struct NormalElimination {
  ComplexLanes<W> below;     // longitudinal force in the previous row
  ComplexLanes<W> y1, y2;    // of the previous row and of the one before it
  Lanes<W> l1_before, inv_d1, inv_d2;

  template <class Normals, class Complex, class Real>
  BDH_FN void operator()(const SlitChannel &c, const SlitModes<W> &m, long row,
                         const ComplexLanes<W> &along, const ComplexLanes<W> &f, const Normals &z,
                         Complex &&w, Real &&l1, Real &&inv_d)
  {
    const double h2 = c.h * c.h, noise = c.amplitude * h2, end = c.ends(row, 1);
    BDH_INDEPENDENT
    for (long i = 0; i < W && row == 0; ++i) w.re[i] = w.im[i] = l1[i] = inv_d[i] = 0.0;
    BDH_INDEPENDENT
    for (long i = 0; i < W && row > 0; ++i) {
      const double fr = f.re[i] + m.inv_hs[i] * (below.im[i] - along.im[i]);
      const double fi = f.im[i] - m.inv_hs[i] * (below.re[i] - along.re[i]);
      const PentadiagonalRow p =
          next_pentadiagonal(m.sigma[i], end, {l1_before[i], inv_d1[i]}, {0.0, inv_d2[i]});
      const double s = m.s[i], scale = c.response * s * s * h2 * h2,
                   root = noise * s * std::sqrt(p.inv_d);
      const double re = scale * fr - p.l1 * y1.re[i] - inv_d2[i] * y2.re[i];
      const double im = scale * fi - p.l1 * y1.im[i] - inv_d2[i] * y2.im[i];
      y2.re[i] = y1.re[i];
      y2.im[i] = y1.im[i];
      y1.re[i] = re;
      y1.im[i] = im;
      w.re[i] = re * p.inv_d + root * z.z[0][i];
      w.im[i] = im * p.inv_d + root * z.z[1][i];
      l1[i] = l1_before[i] = p.l1;
      inv_d[i] = p.inv_d;
      inv_d2[i] = inv_d1[i];
      inv_d1[i] = p.inv_d;
    }
    below = along;
  }
};

/// Substitution normal := L^-T w, row by row downwards; along := longitudinal part of Z normal.
template <long W> struct NormalSubstitution {
  ComplexLanes<W> w1, w2;    // of the next row and of the one after it
  Lanes<W> l1_after;

  template <class Complex, class Real>
  BDH_FN void operator()(const SlitModes<W> &m, const Complex &w, const Real &l1, const Real &inv_d,
                         ComplexLanes<W> &along, ComplexLanes<W> &normal)
  {
    BDH_INDEPENDENT
    for (long i = 0; i < W; ++i) {
      const double re = w.re[i] - l1_after[i] * w1.re[i] - inv_d[i] * w2.re[i];
      const double im = w.im[i] - l1_after[i] * w1.im[i] - inv_d[i] * w2.im[i];
      along.re[i] = -m.inv_hs[i] * (w1.im[i] - im);
      along.im[i] = m.inv_hs[i] * (w1.re[i] - re);
      w2.re[i] = w1.re[i];
      w2.im[i] = w1.im[i];
      normal.re[i] = w1.re[i] = re;
      normal.im[i] = w1.im[i] = im;
      l1_after[i] = l1[i];
    }
  }
};

/// Solves W modes, from force to velocity.  A Strip gives access to their numbers by row:
///     load(row, u), store(row, u)   the D components on their faces, ComplexLanes<W> u[D]
///     normals(row)                  .z[m][i], with m = 0, 1 for the normal velocity and m = 2, 3
///                                   for the transverse one
///     normal(row), transverse(row)  complex workspace, .re[i] and .im[i]; it may be the storage
///                                   behind load() of the components D - 1 and 1
///     l1(row), inv_d(row), transverse_inv_d(row)    real workspace, [i]
template <int D, long W, class Strip>
BDH_FN void solve_slit_modes(const SlitChannel &c, const SlitModes<W> &m, Strip &strip)
{
  ComplexLanes<W> u[D];
  {
    TransverseElimination<W> transverse{};
    NormalElimination<W> normal{};
    for (long row = 0; row < c.rows; ++row) {
      strip.load(row, u);
      to_parts<D>(m, u);
      const auto &z = strip.normals(row);
      if (D == 3)
        transverse(c, m, row, u[1], z, strip.transverse(row), strip.transverse_inv_d(row));
      normal(c, m, row, u[0], u[D - 1], z, strip.normal(row), strip.l1(row), strip.inv_d(row));
    }
  }
  TransverseSubstitution<W> transverse{};
  NormalSubstitution<W> normal{};
  for (long row = c.rows - 1; row >= 0; --row) {
    if (D == 3) transverse(strip.transverse(row), strip.transverse_inv_d(row), u[1]);
    normal(m, strip.normal(row), strip.l1(row), strip.inv_d(row), u[0], u[D - 1]);
    to_components<D>(m, u);
    strip.store(row, u);
  }
}

/// Solves for the mean mode k = 0 in one direction along the walls.  It has no normal flow and no
/// pressure gradient.  Between two free-slip walls the matrix has the null vector 1.  It is made
/// regular in the first row, and the mean is subtracted before and after, which gives the
/// pseudo-inverse.
///
/// \param normal       normal(row) returns the normal variate of the row
/// \param mode         complex numbers, `stride` reals apart from row to row.  On entry the force,
///                     summed over each plane; on return the velocity
/// \param lower,upper  viscous stress on the walls of the flow without noise [force], with h/2
///                     between a wall and the nearest row
template <class Normal> BDH_FN void solve_mean_flow(const SlitChannel &c, double body_force,
                                                    const Normal &normal, double *mode, long stride,
                                                    double &lower, double &upper)
{
  const bool singular = c.lower < 0.0 && c.upper < 0.0;
  const double n = c.rows, force = c.response * c.h * c.h, noise = c.amplitude * c.h;
  const double uniform = c.points() * body_force;
  double sum_f = 0.0, inv_d = 0.0, u = 0.0, v = 0.0, sum_u = 0.0, sum_v = 0.0;
  for (long row = 0; row < c.rows && singular; ++row) sum_f += mode[row * stride] + uniform;
  for (long row = 0; row < c.rows; ++row) {
    double *const at = mode + row * stride;
    inv_d = next_tridiagonal(0.0, c.ends(row, 0) + (singular && row == 0 ? 1.0 : 0.0), inv_d);
    u = (u + force * (at[0] + uniform - sum_f / n)) * inv_d;
    at[0] = u;
    at[1] = inv_d;
  }
  u = 0.0;
  for (long row = c.rows - 1; row >= 0; --row) {
    double *const at = mode + row * stride;
    u = at[1] * u + at[0];
    v = at[1] * v + noise * std::sqrt(at[1]) * normal(row);
    at[0] = u;
    at[1] = v;
  }
  for (long row = 0; row < c.rows && singular; ++row) {
    sum_u += mode[row * stride];
    sum_v += mode[row * stride + 1];
  }
  const double stress = 2.0 * c.viscosity / c.h * c.area;
  lower = c.lower > 0.0 ? stress * mode[0] : 0.0;
  upper = c.upper > 0.0 ? stress * mode[(c.rows - 1) * stride] : 0.0;
  for (long row = 0; row < c.rows; ++row) {
    double *const at = mode + row * stride;
    at[0] = (at[0] - sum_u / n) + (at[1] - sum_v / n);
    at[1] = 0.0;
  }
}

/// Solves for the mean mode in the normal direction, where the velocity is 0.
/// \param lower,upper  pressure on the walls [force]; its mean over the channel is taken as 0
BDH_FN void solve_mean_pressure(const SlitChannel &c, double body_force, double *mode, long stride,
                                double &lower, double &upper)
{
  double rise = 0.0, mean = 0.0;
  for (long row = 0; row < c.rows; ++row) {
    double *const at = mode + row * stride;
    if (row > 0) rise += c.h * ((at[0] + c.points() * body_force) / c.points());
    mean += rise / c.rows;
    at[0] = at[1] = 0.0;
  }
  lower = mean * c.area;
  upper = (rise - mean) * c.area;
}

}    // namespace bdh
#endif
