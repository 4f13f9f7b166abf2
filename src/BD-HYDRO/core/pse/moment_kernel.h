// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// First moments of the forces within a sphere, and the gradient of the flow that it reads.
///
/// The moments are D_dc = S_dc + eps_dce T_e/2, with the force density -D_dc d_d w_c of a window w;
/// the gradient is G_ab = <d_a u_b>, with W_c = eps_cab G_ab/2 and E = sym G.  Both are adjoint.
#ifndef BDH_PSE_MOMENT_KERNEL_H
#define BDH_PSE_MOMENT_KERNEL_H

#include "base/strain_kernel.h"
#include "base/vector_kernel.h"

namespace bdh {

/// along := axis_g D_gc for the gradient of one of the grid's coordinates.  T: torque, may be null;
/// S: strain_numbers of the stresslet, may be null.
BDH_FN void moment_along(const double *axis, const double *T, const double *S, double *along)
{
  for (int c = 0; c < 3; ++c) along[c] = 0.0;
  if (T) {
    cross_product(axis, T, along);
    for (int c = 0; c < 3; ++c) along[c] *= -0.5;
  }
  if (!S) return;
  const Symmetric<double> s = Symmetric<double>::of(S);
  along[0] += s.xx * axis[0] + s.xy * axis[1] + s.xz * axis[2];
  along[1] += s.xy * axis[0] + s.yy * axis[1] + s.yz * axis[2];
  along[2] += s.xz * axis[0] + s.yz * axis[1] + s.zz * axis[2];
}

/// W := the angular velocity, and E (may be null) := the rate of strain.  slope[d]: the derivative
/// of the velocity along the grid's coordinate d; axes[d]: the gradient of that coordinate.
template <class Axes>
BDH_FN void motions_of(const double (&slope)[3][3], const Axes &axes, double *W, double *E)
{
  double G[3][3] = {};
  for (int d = 0; d < 3; ++d)
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b) G[a][b] += axes[d][a] * slope[d][b];
  W[0] = 0.5 * (G[1][2] - G[2][1]);
  W[1] = 0.5 * (G[2][0] - G[0][2]);
  W[2] = 0.5 * (G[0][1] - G[1][0]);
  if (E) strain_of(G, E);
}

}    // namespace bdh
#endif
