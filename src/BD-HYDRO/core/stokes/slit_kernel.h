// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Fourier modes of the Stokes equations between two parallel walls or open ends on the staggered
/// grid, from force to velocity.
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
/// **Open ends.**  Behind an open end no forces act, and the rows go on without end.  They are
/// eliminated exactly.  With lambda + 1/lambda = 2 + s^2 h^2, lambda < 1, and the shift x from row
/// to row,
///     s^2 h^2 + T = (1/lambda) (1 - lambda x) (1 - lambda/x),
/// so that an endless lattice has the factors L = 1 - lambda x, D = 1/lambda for u_t, and
/// L = (1 - lambda x)^2, D = 1/lambda^2 for P.  An elimination that begins at an open end therefore
/// begins with these entries, as if it had come from infinity.  At an open end where it stops, the
/// last diagonal entry of h^2 (-L) changes by -lambda, and the last block of P by
///     [ -lambda^2   2 lambda        ]
///     [ 2 lambda    -(4 + lambda^2) ].
/// The matrix with these entries is a Schur complement, the inverse of that part of the endless
/// P^-1 which belongs to the rows of the grid.  So it is positive definite, and noise from its
/// factor has the covariance of the half-infinite fluid.
///
/// If one end is open, the elimination begins there, and the random velocities come from the
/// substitution, which begins at the wall.  Entries of the factors, and hence velocities, then do
/// not depend on where behind the particles the grid ends, if draws are counted from the wall.
///
/// Everything is written for W modes handled together: as many as fill vector registers on the
/// host, one on a device.  They take one pass over the rows from the first end, the lower one
/// unless only the upper one is open, and one back.
#ifndef BDH_STOKES_SLIT_KERNEL_H
#define BDH_STOKES_SLIT_KERNEL_H

#include "base/portable.h"
#include "grid/boundary.h"
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
/// half a spacing behind the wall: u_ghost = -u (no-slip) or +u (free-slip).  0 for an open end,
/// whose entries depend on the mode.
BDH_FN double wall_term(Boundary end)
{
  return end == Boundary::noslip ? 1.0 : end == Boundary::slip ? -1.0 : 0.0;
}

/// The same for the mean mode, where an open end has no lambda.  Opposite a no-slip wall the flow
/// beyond the last force is uniform, as behind a free-slip wall.  Opposite a free-slip wall nothing
/// holds the fluid, and only differences of velocities along the faces have a meaning; the mean
/// flow is taken to be at rest at the open end of the grid.
BDH_FN double mean_term(Boundary end, Boundary opposite)
{
  if (end != Boundary::open) return wall_term(end);
  return opposite == Boundary::noslip ? -1.0 : 1.0;
}

/// lambda of an open end, without cancellation.  hs: spacing times s
BDH_FN double decay_per_row(double hs)
{
  const double q = 0.5 * hs, root = q + std::sqrt(1.0 + q * q);
  return 1.0 / (root * root);
}

/// What a wall adds to the entries of its row, or nothing.
struct WallEnd {
  double term;    ///< wall_term(), or 0
  BDH_FN double tridiagonal(double) const { return term; }
  BDH_FN void operator()(double, double &diagonal, double &) const { diagonal += term; }
};

/// What an open end where the elimination stops adds to its last row, or to the one before.
struct OpenRow {
  bool last;
  BDH_FN double tridiagonal(double lambda) const { return -lambda; }
  BDH_FN void operator()(double lambda, double &diagonal, double &off) const
  {
    diagonal -= (last ? 4.0 : 0.0) + lambda * lambda;
    off += last ? 2.0 * lambda : 0.0;
  }
};

/// One row of P = L D L^T.  The entries of L are l1 on the first subdiagonal and 1/D_{j-2} on the
/// second.
struct PentadiagonalRow {
  double l1, inv_d;    // l1 of this row, 1/D of this row
};

/// The next row of P.
/// \param sigma    s^2 h^2 > 0
/// \param lambda   decay_per_row()
/// \param end      what the end of the channel adds to this row
/// \param one,two  the previous row and the one before it; {0, 0} where there is none
template <class End>
BDH_FN PentadiagonalRow next_pentadiagonal(double sigma, double lambda, const End &end,
                                           PentadiagonalRow one, PentadiagonalRow two)
{
  double diagonal = sigma * sigma + 4.0 * sigma + 6.0, off = -(2.0 * sigma + 4.0);
  end(lambda, diagonal, off);
  PentadiagonalRow row;
  row.l1 = (off - one.l1) * one.inv_d;
  row.inv_d = 1.0 / (diagonal - row.l1 * (off - one.l1) - two.inv_d);
  return row;
}

/// The next 1/D of h^2 (-L) for a velocity parallel to the walls.  The matrix is tridiagonal with
/// off-diagonal entries -1, so the subdiagonal of L is -1/D of the previous row (0 if none).
/// \param end  change of the diagonal entry
BDH_FN double next_tridiagonal(double sigma, double end, double inv_d_before)
{
  return 1.0 / (2.0 + sigma + end - inv_d_before);
}

/// Complex numbers of a mode across the channel, `stride` reals apart from row to row.
struct ModeLine {
  double *first;
  long stride;
  BDH_FN double *operator()(long row) const { return first + row * stride; }
};

/// The parameters that all modes of a solve share.
struct SlitChannel {
  long n[2];                 ///< grid points along the walls; in 2D n[1] = 1
  double h_along[2];         ///< their spacings [length]
  long rows;                 ///< lines across the channel
  double h;                  ///< their spacing [length]
  Boundary lower, upper;     ///< walls or open ends
  double viscosity, area;    ///< area of a wall [length^(dim - 1)]
  /// The same as in stokes/modes_kernel.h, but with transforms only along the walls.  Without noise
  /// the amplitude is 0.
  double response, amplitude;

  BDH_FN double points() const { return n[0] * n[1]; }
  BDH_FN long modes() const { return (n[0] / 2 + 1) * n[1]; }

  /// Rows are numbered from the first end, and from above if only the upper end is open.
  BDH_FN bool from_above() const { return upper == Boundary::open && lower != Boundary::open; }
  BDH_FN Boundary first() const { return from_above() ? upper : lower; }
  BDH_FN Boundary last() const { return from_above() ? lower : upper; }
  BDH_FN bool opens() const { return first() == Boundary::open; }
  /// Where the grid has the row of cell centres, or of faces, with this number.  From above, the
  /// first row of faces lies at the upper end of the grid and gets the place of the lower wall.
  BDH_FN long centre_row(long row) const { return from_above() ? rows - 1 - row : row; }
  BDH_FN long face_row(long row) const { return from_above() && row > 0 ? rows - row : row; }
  BDH_FN long stored_row(bool face, long row) const
  {
    return face ? face_row(row) : centre_row(row);
  }
  /// The numbers of the mean mode, whose rows are `stride` reals apart in the grid.
  BDH_FN ModeLine along(double *mode, long stride) const
  {
    return from_above() ? ModeLine{mode + (rows - 1) * stride, -stride} : ModeLine{mode, stride};
  }
  /// The number of a row for draws, which is counted from the wall if the other end is open.
  BDH_FN long draw_row(long row) const { return opens() ? rows - 1 - row : row; }
  /// The first row of faces that do not lie in a wall.
  BDH_FN long first_face() const { return opens() ? 0 : 1; }
  /// Is this one of the two rows whose entries an open last end changes?
  BDH_FN bool before_open_end(long row) const
  {
    return last() == Boundary::open && row >= rows - 2;
  }
  /// What walls next to this row add to its diagonal entry; begin: the first row of its kind.
  BDH_FN WallEnd wall(long row, long begin) const
  {
    return {(row == begin ? wall_term(first()) : 0.0) +
            (row == rows - 1 ? wall_term(last()) : 0.0)};
  }
};

/// Number of a mode's draw in draw_row() 0; each further one adds modes().  At the edges of the
/// half space a mode and its conjugate both take the draw of the one with the smaller number.
BDH_FN uint64_t slit_draw(const SlitChannel &c, long kx, long ky)
{
  const long minus = (c.n[1] - ky) % c.n[1];
  return mode_number(c.n, kx, is_edge_column(c.n, kx) && minus < ky ? minus : ky, 0);
}

/// Turns the normals of a draw into those of a mode in an edge column: the complex conjugates, or
/// real ones of the same variance for a mode that is its own conjugate.  At theta = pi the phase of
/// stokes/modes_kernel.h is e^{-i theta/2} = -i, the negative of its conjugate, which explains the
/// signs of the transverse part.
template <class Real> BDH_FN void make_edge_real(const SlitChannel &c, long kx, long ky, Real &z0,
                                                 Real &z1, Real &z2, Real &z3)
{
  if (!is_edge_column(c.n, kx)) return;
  const long minus = (c.n[1] - ky) % c.n[1];
  const bool real = ky == minus, conjugate = ky > minus, half_x = kx != 0, half_y = real && ky != 0;
  const Real root2 = 1.41421356237309504880;
  if (real) {
    const Real t = root2 * z2;
    z0 *= root2;
    z1 = 0;
    z2 = half_x && half_y ? Real(0) : t;
    z3 = half_x && half_y ? t : Real(0);
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
  Lanes<W> s, sigma, inv_hs;    // s, s^2 h^2, 1/(h s), the last one negative from above
  Lanes<W> lambda;              // decay_per_row(), if an end is open

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
    inv_hs[i] = (c.from_above() ? -1.0 : 1.0) / (c.h * s[i]);
    lambda[i] = c.opens() ? decay_per_row(c.h * s[i]) : 0.0;
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

/// Elimination for h^2 (-L) = R^T R with R = D^1/2 R', row by row from the first one:
///     t := response h^2 D^-1 R'^-T f + amplitude h D^-1/2 z.
template <long W> struct TransverseElimination {
  Lanes<W> before;
  ComplexLanes<W> y;

  /// Begins at an open end.
  BDH_FN void come_from_infinity(const SlitModes<W> &m) { before = m.lambda; }

  template <class Normals, class Complex, class Real>
  BDH_FN void operator()(const SlitChannel &c, const SlitModes<W> &m, long row,
                         const ComplexLanes<W> &f, const Normals &z, Complex &&t, Real &&inv_d)
  {
    if (c.before_open_end(row) && row == c.rows - 1)
      eliminate(OpenRow{true}, c, m, f, z, t, inv_d);
    else
      eliminate(c.wall(row, 0), c, m, f, z, t, inv_d);
  }

 private:
  template <class End, class Normals, class Complex, class Real>
  BDH_FN void eliminate(const End &end, const SlitChannel &c, const SlitModes<W> &m,
                        const ComplexLanes<W> &f, const Normals &z, Complex &&t, Real &&inv_d)
  {
    const double force = c.response * c.h * c.h, noise = c.amplitude * c.h;
    BDH_INDEPENDENT
    for (long i = 0; i < W; ++i) {
      y.re[i] = force * f.re[i] + before[i] * y.re[i];
      y.im[i] = force * f.im[i] + before[i] * y.im[i];
      const double d = next_tridiagonal(m.sigma[i], end.tridiagonal(m.lambda[i]), before[i]),
                   root = noise * std::sqrt(d);
      inv_d[i] = before[i] = d;
      t.re[i] = y.re[i] * d + root * z.z[2][i];
      t.im[i] = y.im[i] * d + root * z.z[3][i];
    }
  }
};

/// Substitution u := R'^-1 t, row by row back from the last one.
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

/// Elimination for P = L D L^T, row by row from the first face on:
///     w := response s^2 h^4 D^-1 L^-1 Z* f + amplitude s h^2 D^-1/2 z.
/// If row 0 lies in a wall, w = 0 there.
template <long W> struct NormalElimination {
  ComplexLanes<W> below;     // longitudinal force in the previous row
  ComplexLanes<W> y1, y2;    // of the previous row and of the one before it
  Lanes<W> l1_before, inv_d1, inv_d2;

  /// Begins at an open end.
  BDH_FN void come_from_infinity(const SlitModes<W> &m)
  {
    for (long i = 0; i < W; ++i) {
      l1_before[i] = -2.0 * m.lambda[i];
      inv_d1[i] = inv_d2[i] = m.lambda[i] * m.lambda[i];
    }
  }

  template <class Normals, class Complex, class Real>
  BDH_FN void operator()(const SlitChannel &c, const SlitModes<W> &m, long row,
                         const ComplexLanes<W> &along, const ComplexLanes<W> &f, const Normals &z,
                         Complex &&w, Real &&l1, Real &&inv_d)
  {
    if (row < c.first_face()) {
      for (long i = 0; i < W; ++i) w.re[i] = w.im[i] = l1[i] = inv_d[i] = 0.0;
    } else if (c.before_open_end(row)) {
      eliminate(OpenRow{row == c.rows - 1}, c, m, along, f, z, w, l1, inv_d);
    } else {
      eliminate(c.wall(row, c.first_face()), c, m, along, f, z, w, l1, inv_d);
    }
    below = along;
  }

 private:
  template <class End, class Normals, class Complex, class Real>
  BDH_FN void eliminate(const End &end, const SlitChannel &c, const SlitModes<W> &m,
                        const ComplexLanes<W> &along, const ComplexLanes<W> &f, const Normals &z,
                        Complex &&w, Real &&l1, Real &&inv_d)
  {
    const double h2 = c.h * c.h, noise = c.amplitude * h2;
    BDH_INDEPENDENT
    for (long i = 0; i < W; ++i) {
      const double fr = f.re[i] + m.inv_hs[i] * (below.im[i] - along.im[i]);
      const double fi = f.im[i] - m.inv_hs[i] * (below.re[i] - along.re[i]);
      const PentadiagonalRow p = next_pentadiagonal(m.sigma[i], m.lambda[i], end,
                                                    {l1_before[i], inv_d1[i]}, {0.0, inv_d2[i]});
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
  }
};

/// Substitution normal := L^-T w, row by row back from the last one; along := longitudinal part of
/// Z normal.  If the last end is open, that of the last row is wrong: no kernel reads it.
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

/// Solves W modes, from force to velocity.  A Strip gives access to their numbers by row, in the
/// order of the channel:
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
    if (c.opens()) {
      transverse.come_from_infinity(m);
      normal.come_from_infinity(m);
    }
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
    if (c.from_above() && row == 0) u[D - 1] = {};    // goes to the place of the wall
    to_components<D>(m, u);
    strip.store(row, u);
  }
}

/// Solves for the mean mode k = 0 in one direction along the faces, between two open ends.  Nothing
/// holds the fluid: only differences of velocities have a meaning, and the mean flow is
/// antiperiodic, u_n = -u_0, which adds half the height of the grid to minus the distance of two
/// rows:
///     u_i = h^2/(2 viscosity) sum_j (n/2 - |i - j|) f_j.
template <class Normal> BDH_FN void
solve_unbounded_mean_flow(const SlitChannel &c, const Normal &normal, const ModeLine &mode)
{
  const double force = c.response * c.h * c.h, noise = c.amplitude * c.h;
  double rise = 0.0, all = 0.0;    // from this row to the next, and over all rows
  for (long row = 0; row < c.rows; ++row) rise += 0.5 * force * mode(row)[0];
  for (long row = 0; row < c.rows; ++row) {
    double *const at = mode(row);
    rise -= force * at[0];
    at[1] = rise + noise * normal(row);
    all += at[1];
  }
  double u = -0.5 * all;
  for (long row = 0; row < c.rows; ++row) {
    double *const at = mode(row);
    at[0] = u;
    u += at[1];
    at[1] = 0.0;
  }
}

/// Solves for the mean mode k = 0 in one direction along the walls.  It has no normal flow and no
/// pressure gradient.  Between two free-slip walls the matrix has the null vector 1.  It is made
/// regular in the first row, and the mean is subtracted before and after, which gives the
/// pseudo-inverse.  With an open end see mean_term().
///
/// \param normal       normal(row) returns the normal variate of the row
/// \param mode         the rows in the order of the channel.  On entry the force, summed over each
///                     plane; on return the velocity
/// \param lower,upper  viscous stress on the walls of the flow without noise [force], with h/2
///                     between a wall and the nearest row
template <class Normal> BDH_FN void solve_mean_flow(const SlitChannel &c, double body_force,
                                                    const Normal &normal, const ModeLine &mode,
                                                    double &lower, double &upper)
{
  lower = upper = 0.0;
  if (c.first() == Boundary::open && c.last() == Boundary::open)
    return solve_unbounded_mean_flow(c, normal, mode);
  const bool singular = c.first() == Boundary::slip && c.last() == Boundary::slip;
  const double first = mean_term(c.first(), c.last()) + (singular ? 1.0 : 0.0),
               last = mean_term(c.last(), c.first());
  const double n = c.rows, force = c.response * c.h * c.h, noise = c.amplitude * c.h;
  const double uniform = c.points() * body_force;
  double sum_f = 0.0, inv_d = 0.0, u = 0.0, v = 0.0, sum_u = 0.0, sum_v = 0.0;
  for (long row = 0; row < c.rows && singular; ++row) sum_f += mode(row)[0] + uniform;
  for (long row = 0; row < c.rows; ++row) {
    double *const at = mode(row);
    inv_d =
        next_tridiagonal(0.0, (row == 0 ? first : 0.0) + (row == c.rows - 1 ? last : 0.0), inv_d);
    u = (u + force * (at[0] + uniform - sum_f / n)) * inv_d;
    at[0] = u;
    at[1] = inv_d;
  }
  u = 0.0;
  for (long row = c.rows - 1; row >= 0; --row) {
    double *const at = mode(row);
    u = at[1] * u + at[0];
    v = at[1] * v + noise * std::sqrt(at[1]) * normal(row);
    at[0] = u;
    at[1] = v;
  }
  for (long row = 0; row < c.rows && singular; ++row) {
    sum_u += mode(row)[0];
    sum_v += mode(row)[1];
  }
  const double stress = 2.0 * c.viscosity / c.h * c.area;
  if (c.lower == Boundary::noslip) lower = stress * mode(c.centre_row(0))[0];
  if (c.upper == Boundary::noslip) upper = stress * mode(c.centre_row(c.rows - 1))[0];
  for (long row = 0; row < c.rows; ++row) {
    double *const at = mode(row);
    at[0] = (at[0] - sum_u / n) + (at[1] - sum_v / n);
    at[1] = 0.0;
  }
}

/// Solves for the mean mode in the normal direction, where the velocity is 0.
/// \param mode         the rows as the grid has them
/// \param lower,upper  pressure on the walls [force]; its mean over the channel is taken as 0, or
///                     that of an open end
BDH_FN void solve_mean_pressure(const SlitChannel &c, double body_force, const ModeLine &mode,
                                double &lower, double &upper)
{
  double rise = 0.0, mean = 0.0;
  for (long row = 0; row < c.rows; ++row) {
    double *const at = mode(row);
    if (row > 0 || c.lower == Boundary::open)
      rise += c.h * ((at[0] + c.points() * body_force) / c.points());
    mean += rise / c.rows;
    at[0] = at[1] = 0.0;
  }
  if (c.upper == Boundary::open) mean = rise;
  if (c.lower == Boundary::open) mean = 0.0;
  lower = mean * c.area;
  upper = c.upper == Boundary::open ? 0.0 : (rise - mean) * c.area;
}

}    // namespace bdh
#endif
