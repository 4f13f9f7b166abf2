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
/// **Steady entries.**  Away from the first end the entries of the factors approach those of the
/// endless lattice, by lambda^2 from row to row.  Once all modes that are handled together have
/// them to round-off, the entries are taken as constant: most rows of most modes need no division
/// and no root.
///
/// Everything is written for up to W modes handled together: as many as fill the first-level cache
/// on the host, one on a device.  They take one pass over the rows from the first end, the lower
/// one unless only the upper one is open, and one back.
#ifndef BDH_STOKES_SLIT_KERNEL_H
#define BDH_STOKES_SLIT_KERNEL_H

#include "base/portable.h"
#include "grid/boundary.h"
#include "stokes/modes_kernel.h"

#include <cmath>
#include <cstdint>
#include <type_traits>

namespace bdh {

/// A number for each of up to W modes.
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

/// What the ends of the channel add to the entries of a row; all zeros but for a few rows.
struct RowEnds {
  double centre_wall, face_wall;    ///< wall_term() of walls next to its centres and its faces
  double before_open, at_open;      ///< 1 in the last two rows before an open end, in the last one

  BDH_FN double tridiagonal(double lambda) const { return centre_wall - at_open * lambda; }
  BDH_FN double diagonal(double lambda) const
  {
    return face_wall - before_open * lambda * lambda - 4.0 * at_open;
  }
  BDH_FN double off_diagonal(double lambda) const { return 2.0 * at_open * lambda; }
};

/// One row of P = L D L^T.  The entries of L are l1 on the first subdiagonal and 1/D_{j-2} on the
/// second.
struct PentadiagonalRow {
  double l1, inv_d;    // l1 of this row, 1/D of this row
};

/// The next row of P.
/// \param sigma    s^2 h^2 > 0
/// \param lambda   decay_per_row()
/// \param ends     what the ends of the channel add to this row
/// \param one,two  the previous row and the one before it; {0, 0} where there is none
BDH_FN_IN_LOOP PentadiagonalRow next_pentadiagonal(double sigma, double lambda, const RowEnds &ends,
                                                   PentadiagonalRow one, PentadiagonalRow two)
{
  const double diagonal = sigma * sigma + 4.0 * sigma + 6.0 + ends.diagonal(lambda),
               off = ends.off_diagonal(lambda) - (2.0 * sigma + 4.0);
  PentadiagonalRow row;
  row.l1 = (off - one.l1) * one.inv_d;
  row.inv_d = 1.0 / (diagonal - row.l1 * (off - one.l1) - two.inv_d);
  return row;
}

/// The next 1/D of h^2 (-L) for a velocity parallel to the walls.  The matrix is tridiagonal with
/// off-diagonal entries -1, so the subdiagonal of L is -1/D of the previous row (0 if none).
/// \param end  change of the diagonal entry
BDH_FN_IN_LOOP double next_tridiagonal(double sigma, double end, double inv_d_before)
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
  /// Do the ends of the channel leave the entries of this row as they are?
  BDH_FN bool is_inner(long row) const
  {
    return row > (opens() ? -1 : 1) && row < rows - (last() == Boundary::open ? 2 : 1);
  }
  BDH_FN RowEnds ends(long row) const
  {
    const double at_first = wall_term(first()), at_last = row == rows - 1 ? wall_term(last()) : 0.0;
    const bool open = last() == Boundary::open;
    return {(row == 0 ? at_first : 0.0) + at_last, (row == first_face() ? at_first : 0.0) + at_last,
            open && row >= rows - 2 ? 1.0 : 0.0, open && row == rows - 1 ? 1.0 : 0.0};
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

/// Up to W modes with the same k_y.  The mode k = 0 gets arbitrary symbols, since solve_mean_flow()
/// handles it.
template <long W> struct SlitModes {
  AxisSymbol y;
  Lanes<W> cos_half, sin_half;     // of the axis symbol along x
  Lanes<W> nx, ny;                 // s_x/s, s_y/s
  Lanes<W> s, sigma, inv_hs;       // s, s^2 h^2, 1/(h s), the last one negative from above
  Lanes<W> lambda, root_lambda;    // decay_per_row()

  BDH_FN SlitModes(const SlitChannel &c, long ky) : y(axis_symbol(ky, c.n[1], c.h_along[1])) {}
  /// x: symbol along x
  BDH_FN void set(const SlitChannel &c, long i, const AxisSymbol &x)
  {
    const double s2 = x.s * x.s + y.s * y.s;
    cos_half[i] = x.cos_half;
    sin_half[i] = x.sin_half;
    s[i] = s2 > 0.0 ? std::sqrt(s2) : 1.0 / c.h;
    nx[i] = s2 > 0.0 ? x.s / s[i] : 1.0;
    ny[i] = y.s / s[i];
    sigma[i] = s[i] * s[i] * c.h * c.h;
    inv_hs[i] = (c.from_above() ? -1.0 : 1.0) / (c.h * s[i]);
    lambda[i] = decay_per_row(c.h * s[i]);
    root_lambda[i] = std::sqrt(lambda[i]);
  }
};

struct SlitNumber {
  double re, im;
};

/// One mode in one row: D components on their faces, or the longitudinal, the transverse (in 3D)
/// and the normal part.
template <int D> struct SlitVector {
  SlitNumber d[D];
};

template <int D, long W>
BDH_FN_IN_LOOP SlitVector<D> to_parts(const SlitModes<W> &m, long i, const SlitVector<D> &u)
{
  SlitNumber x = u.d[0], y = D == 3 ? u.d[1] : SlitNumber{0.0, 0.0};
  to_corner({0.0, m.cos_half[i], m.sin_half[i]}, x.re, x.im);
  to_corner(m.y, y.re, y.im);
  SlitVector<D> parts = u;
  parts.d[0] = {m.nx[i] * x.re + m.ny[i] * y.re, m.nx[i] * x.im + m.ny[i] * y.im};
  if (D == 3) parts.d[1] = {m.nx[i] * y.re - m.ny[i] * x.re, m.nx[i] * y.im - m.ny[i] * x.im};
  return parts;
}

/// The inverse of to_parts().
template <int D, long W> BDH_FN_IN_LOOP SlitVector<D> to_components(const SlitModes<W> &m, long i,
                                                                    const SlitVector<D> &parts)
{
  const SlitNumber l = parts.d[0], t = D == 3 ? parts.d[1] : SlitNumber{0.0, 0.0};
  SlitNumber x{m.nx[i] * l.re - m.ny[i] * t.re, m.nx[i] * l.im - m.ny[i] * t.im};
  SlitNumber y{m.ny[i] * l.re + m.nx[i] * t.re, m.ny[i] * l.im + m.nx[i] * t.im};
  to_face({0.0, m.cos_half[i], m.sin_half[i]}, x.re, x.im);
  to_face(m.y, y.re, y.im);
  SlitVector<D> u = parts;
  u.d[0] = x;
  if (D == 3) u.d[1] = y;
  return u;
}

/// One row of the modes in the field: real and imaginary part of a mode, then those of the next.
template <int D, class Real> struct SlitComponents {
  Real *f[D];
  BDH_FN_IN_LOOP SlitVector<D> get(long i) const
  {
    SlitVector<D> u;
    for (int d = 0; d < D; ++d) u.d[d] = {double(f[d][2 * i]), double(f[d][2 * i + 1])};
    return u;
  }
  BDH_FN_IN_LOOP void set(long i, const SlitVector<D> &u) const
  {
    for (int d = 0; d < D; ++d) {
      f[d][2 * i] = u.d[d].re;
      f[d][2 * i + 1] = u.d[d].im;
    }
  }
};

/// Workspace for one row of the modes.
struct SlitWork {
  struct Complex {
    double *re, *im;
  } transverse, normal;
  double *transverse_inv_d, *l1, *inv_d;
};

/// Both factors in one row: 1/D, l1, and 1/D of the previous row (transverse) or of the one before
/// it (normal).
struct SlitFactors {
  double transverse_inv_d, transverse_inv_d_1, l1, inv_d, inv_d_2;
};

/// Eliminations, row by row from the first one: for h^2 (-L) = R^T R with R = D^1/2 R',
///     t := response h^2 D^-1 R'^-T f + amplitude h D^-1/2 z,
/// and for P = L D L^T
///     w := response s^2 h^4 D^-1 L^-1 Z* f + amplitude s h^2 D^-1/2 z.
/// If the faces of row 0 lie in a wall, w = 0 there.
template <int D, long W> class SlitElimination {
 public:
  /// \param count  modes in use
  BDH_FN SlitElimination(const SlitChannel &c, const SlitModes<W> &m, long count) :
      c_(c), m_(m), count_(count), first_steady_(c.opens() ? 0 : c.rows)
  {
    for (long i = 0; i < count; ++i) {
      // From an open end the elimination comes as if from infinity.
      const double lambda = c.opens() ? m.lambda[i] : 0.0;
      transverse_inv_d_[i] = lambda;
      l1_[i] = -2.0 * lambda;
      inv_d_1_[i] = inv_d_2_[i] = lambda * lambda;
    }
  }

  template <class Strip> BDH_FN void operator()(long row, Strip &strip)
  {
    const bool noisy = c_.amplitude > 0.0;
    if (is_steady(row))
      return noisy ? eliminate<true, true>(row, strip) : eliminate<true, false>(row, strip);
    noisy ? eliminate<false, true>(row, strip) : eliminate<false, false>(row, strip);
    if (first_steady_ == c_.rows && c_.is_inner(row) && has_limits()) first_steady_ = row + 1;
  }

  /// Has this row the entries of the endless lattice?  They are not stored.
  BDH_FN bool is_steady(long row) const { return row >= first_steady_ && c_.is_inner(row); }

 private:
  /// Have the factors reached their limits, but for some units of round-off?
  BDH_FN bool has_limits() const
  {
    const double tolerance = 1e-15;
    long far = 0;
    for (long i = 0; i < count_; ++i) {
      const double lambda = m_.lambda[i], square = lambda * lambda;
      far += std::fabs(inv_d_1_[i] - square) > tolerance * square;
      far += std::fabs(l1_[i] + 2.0 * lambda) > tolerance * lambda;
      if (D == 3) far += std::fabs(transverse_inv_d_[i] - lambda) > tolerance * lambda;
    }
    return far == 0;
  }

  BDH_FN_IN_LOOP SlitFactors steady_factors(long i) const
  {
    const double lambda = m_.lambda[i], square = lambda * lambda;
    return {lambda, lambda, -2.0 * lambda, square, square};
  }
  /// face: 0 if the faces of the row lie in a wall, otherwise 1
  BDH_FN_IN_LOOP SlitFactors next_factors(long i, const RowEnds &ends, double face)
  {
    SlitFactors e{};
    e.inv_d_2 = inv_d_2_[i];
    const PentadiagonalRow p = next_pentadiagonal(m_.sigma[i], m_.lambda[i], ends,
                                                  {l1_[i], inv_d_1_[i]}, {0.0, inv_d_2_[i]});
    e.l1 = l1_[i] = face * p.l1;
    inv_d_2_[i] = inv_d_1_[i];
    e.inv_d = inv_d_1_[i] = face * p.inv_d;
    if (D == 2) return e;
    e.transverse_inv_d_1 = transverse_inv_d_[i];
    e.transverse_inv_d = transverse_inv_d_[i] =
        next_tridiagonal(m_.sigma[i], ends.tridiagonal(m_.lambda[i]), transverse_inv_d_[i]);
    return e;
  }

  template <bool steady, bool noisy, class Strip> BDH_FN void eliminate(long row, Strip &strip)
  {
    const auto u = strip.components(row);
    const SlitWork work = strip.work(row);
    const auto z = strip.normals(row);
    const RowEnds ends = c_.ends(row);
    const double h2 = c_.h * c_.h, face = row < c_.first_face() ? 0.0 : 1.0;
    const double force = c_.response * h2;
    // The noise needs no more digits than its normals have.
    using Noise = std::remove_cv_t<std::remove_reference_t<decltype(z.z[0][0])>>;
    const double normal_noise = c_.amplitude * h2;
    const Noise transverse_noise = c_.amplitude * c_.h;
    BDH_INDEPENDENT
    for (long i = 0; i < count_; ++i) {
      const SlitVector<D> f = to_parts<D>(m_, i, u.get(i));
      const SlitFactors e = steady ? steady_factors(i) : next_factors(i, ends, face);
      if (D == 3) {
        y_.re[i] = force * f.d[1].re + e.transverse_inv_d_1 * y_.re[i];
        y_.im[i] = force * f.d[1].im + e.transverse_inv_d_1 * y_.im[i];
        double re = y_.re[i] * e.transverse_inv_d, im = y_.im[i] * e.transverse_inv_d;
        if (noisy) {
          const Noise root = transverse_noise * (steady ? Noise(m_.root_lambda[i])
                                                        : std::sqrt(Noise(e.transverse_inv_d)));
          re += root * z.z[2][i];
          im += root * z.z[3][i];
        }
        work.transverse.re[i] = re;
        work.transverse.im[i] = im;
      }
      const SlitNumber along = f.d[0];
      const double fr = f.d[D - 1].re + m_.inv_hs[i] * (below_.im[i] - along.im);
      const double fi = f.d[D - 1].im - m_.inv_hs[i] * (below_.re[i] - along.re);
      const double scale = force * m_.sigma[i];
      const double re = face * (scale * fr - e.l1 * y1_.re[i] - e.inv_d_2 * y2_.re[i]);
      const double im = face * (scale * fi - e.l1 * y1_.im[i] - e.inv_d_2 * y2_.im[i]);
      double w_re = re * e.inv_d, w_im = im * e.inv_d;
      if (noisy) {
        const Noise root = Noise(normal_noise * m_.s[i]) *
                           (steady ? Noise(m_.lambda[i]) : std::sqrt(Noise(e.inv_d)));
        w_re += root * z.z[0][i];
        w_im += root * z.z[1][i];
      }
      work.normal.re[i] = w_re;
      work.normal.im[i] = w_im;
      y2_.re[i] = y1_.re[i];
      y2_.im[i] = y1_.im[i];
      y1_.re[i] = re;
      y1_.im[i] = im;
      below_.re[i] = along.re;
      below_.im[i] = along.im;
      if (steady) continue;
      work.l1[i] = e.l1;
      work.inv_d[i] = e.inv_d;
      if (D == 3) work.transverse_inv_d[i] = e.transverse_inv_d;
    }
  }

  const SlitChannel &c_;
  const SlitModes<W> &m_;
  const long count_;
  long first_steady_;
  Lanes<W> transverse_inv_d_, l1_, inv_d_1_, inv_d_2_;    // of the previous rows
  ComplexLanes<W> y_{};                                   // of the previous row, transverse
  ComplexLanes<W> below_{};                               // longitudinal force in the previous row
  ComplexLanes<W> y1_{}, y2_{};    // of the previous row and of the one before it, normal
};

/// Substitutions, row by row back from the last one: u_t := R'^-1 t, normal := L^-T w; along :=
/// longitudinal part of Z normal.  If the last end is open, that of the last row is wrong: no
/// kernel reads it.
template <int D, long W> class SlitSubstitution {
 public:
  BDH_FN SlitSubstitution(const SlitChannel &c, const SlitModes<W> &m, long count) :
      c_(c), m_(m), count_(count)
  {}

  template <bool steady, class Strip> BDH_FN void substitute(long row, Strip &strip)
  {
    const auto u = strip.components(row);
    const SlitWork work = strip.work(row);
    // From above, row 0 of the faces goes to the place of the wall.
    const double face = c_.from_above() && row == 0 ? 0.0 : 1.0;
    BDH_INDEPENDENT
    for (long i = 0; i < count_; ++i) {
      const double lambda = m_.lambda[i];
      SlitVector<D> parts;
      if (D == 3) {
        const double inv_d = steady ? lambda : work.transverse_inv_d[i];
        above_.re[i] = work.transverse.re[i] + inv_d * above_.re[i];
        above_.im[i] = work.transverse.im[i] + inv_d * above_.im[i];
        parts.d[1] = {above_.re[i], above_.im[i]};
      }
      const double inv_d = steady ? lambda * lambda : work.inv_d[i];
      const double re = work.normal.re[i] - l1_after_[i] * w1_.re[i] - inv_d * w2_.re[i];
      const double im = work.normal.im[i] - l1_after_[i] * w1_.im[i] - inv_d * w2_.im[i];
      parts.d[0] = {-m_.inv_hs[i] * (w1_.im[i] - im), m_.inv_hs[i] * (w1_.re[i] - re)};
      parts.d[D - 1] = {face * re, face * im};
      u.set(i, to_components<D>(m_, i, parts));
      w2_.re[i] = w1_.re[i];
      w2_.im[i] = w1_.im[i];
      w1_.re[i] = re;
      w1_.im[i] = im;
      l1_after_[i] = steady ? -2.0 * lambda : work.l1[i];
    }
  }

 private:
  const SlitChannel &c_;
  const SlitModes<W> &m_;
  const long count_;
  Lanes<W> l1_after_{};
  ComplexLanes<W> above_{};        // transverse, of the next row
  ComplexLanes<W> w1_{}, w2_{};    // normal, of the next row and of the one after it
};

/// Solves `count` modes, from force to velocity.  A Strip gives access to their numbers by row, in
/// the order of the channel:
///     components(row)    SlitComponents
///     normals(row)       .z[m][i], with m = 0, 1 for the normal velocity and m = 2, 3 for the
///                        transverse one
///     work(row)          SlitWork; normal and transverse may be the storage behind the components
///                        D - 1 and 1
template <int D, long W, class Strip>
BDH_FN void solve_slit_modes(const SlitChannel &c, const SlitModes<W> &m, long count, Strip &strip)
{
  SlitElimination<D, W> elimination(c, m, count);
  for (long row = 0; row < c.rows; ++row) elimination(row, strip);
  SlitSubstitution<D, W> substitution(c, m, count);
  for (long row = c.rows - 1; row >= 0; --row)
    elimination.is_steady(row) ? substitution.template substitute<true>(row, strip)
                               : substitution.template substitute<false>(row, strip);
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
