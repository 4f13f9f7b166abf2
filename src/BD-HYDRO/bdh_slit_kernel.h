/// One Fourier mode of the Stokes equations between two parallel walls, on the staggered grid: its two factorisations.
///
/// In the periodic directions the mode has the symbols s_x, s_y of bdh_stokes_kernel.h, s^2 = s_x^2 + s_y^2; across the
/// channel (spacing h) it lives on lines.  The velocity splits into a transverse part u_t (along the walls, normal to
/// the wave vector), which no pressure touches, and a part in the plane of wave vector and normal.  Of that part the
/// divergence-free fields are the images Z w of the normal velocity on the inner faces,
///     u_l = i (w_{j+1} - w_j)/(h s),
/// so that the Stokes solution is Z (Z* (-L) Z)^-1 Z* f: no pressure, and symmetric by construction.  With the tridiagonal
/// T of u -> -h^2 u'' on the faces (w = 0 on the walls),
///     Z* (-L) Z = P/(s^2 h^4),   P = (s^2 h^2 + T)^2 + 2 e_1 e_1^T [lower wall no-slip] + 2 e_m e_m^T [upper],
/// which has five diagonals.  P = R^T R gives the noise too: R^-1 z has the covariance P^-1.
#ifndef BDH_SLIT_KERNEL_H
#define BDH_SLIT_KERNEL_H

#include "bdh_portable.h"

#include <cmath>

namespace bdh {

/// Ghost values u_ghost = -u (no-slip) or +u (free-slip) half a spacing behind the wall change the first and the last
/// diagonal of both matrices by +1 or -1.
BDH_FN double wall_term(bool noslip) { return noslip ? 1.0 : -1.0; }

/// P = L D L^T row by row: x_j of L x = g, with L's entries l1 (first subdiagonal) and l2 = 1/D_{j-2}.
struct PentadiagonalRow {
  double l1, inv_d;    // l1 of this row, 1/D of this row
};

/// Next row of P.
/// \param sigma  s^2 h^2 > 0
/// \param ends   sum of the wall_term()s of the walls next to this row (each end of the channel has one)
/// \param one,two  the rows before this one and before that, both {0, 0} where there is none
BDH_FN PentadiagonalRow next_pentadiagonal(double sigma, double ends, PentadiagonalRow one, PentadiagonalRow two)
{
  const double diagonal = sigma * sigma + 4.0 * sigma + 6.0 + ends, off = -(2.0 * sigma + 4.0);
  PentadiagonalRow row;
  row.l1 = (off - one.l1) * one.inv_d;
  row.inv_d = 1.0 / (diagonal - row.l1 * (off - one.l1) - two.inv_d);
  return row;
}

/// Next 1/D of h^2 (-L) of a velocity parallel to the walls, tridiagonal with -1 beside the diagonal: L's subdiagonal is
/// -1/D of the row before (0 where there is none).
BDH_FN double next_tridiagonal(double sigma, double ends, double inv_d_before)
{
  return 1.0 / (2.0 + sigma + ends - inv_d_before);
}

}    // namespace bdh
#endif
