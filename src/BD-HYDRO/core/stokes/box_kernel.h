// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Pointwise parts of the Stokes equations in boxes with walls (stokes/box.h).
///
/// Cell i of an axis lies between its faces i and i + 1.  The upper wall, face n, is not stored.
/// Its index wraps around to face 0, the lower wall, which holds the same value, 0.  Rows are
/// padded to 2 (n_x/2 + 1) numbers.
#ifndef BDH_STOKES_BOX_KERNEL_H
#define BDH_STOKES_BOX_KERNEL_H

#include "base/portable.h"

#include <cmath>

namespace bdh {

/// The whole box.  `at` holds the index along each axis of a cell, and of the faces below it.
struct BoxGrid {
  int dim;
  long n[3], stride[3];     ///< cells; distance in an array from one to the next
  double h[3], inv_h[3];    ///< spacing, 1/spacing
  double cell_volume;       ///< [length^dim]
  bool walled[3], noslip[3][2];

  /// Whether a face of component d is the lower wall and so no unknown.  i: its index along d
  BDH_FN bool on_wall(int d, long i) const { return walled[d] && i == 0; }
  /// 1/h; 0 on a wall.
  BDH_FN double face_scale(int d, long i) const { return on_wall(d, i) ? 0.0 : inv_h[d]; }
  BDH_FN bool touches(int axis, int side, const long *at) const
  {
    return walled[axis] && at[axis] == (side ? n[axis] - 1 : 0);
  }
  /// Offset in an array to the previous and to the next entry along an axis, with wrap-around.
  BDH_FN long before(int axis, long i) const
  {
    return i > 0 ? -stride[axis] : (n[axis] - 1) * stride[axis];
  }
  BDH_FN long after(int axis, long i) const
  {
    return i + 1 < n[axis] ? stride[axis] : -(n[axis] - 1) * stride[axis];
  }
  /// Offset of a cell in an array.
  BDH_FN long place(const long *at) const { return at[0] + at[1] * stride[1] + at[2] * stride[2]; }
  /// Indices of a cell from its number, 0 .. n_x n_y n_z - 1 with x fastest.
  BDH_FN void locate(long cell, long *at) const
  {
    at[0] = cell % n[0];
    at[1] = cell / n[0] % n[1];
    at[2] = cell / (n[0] * n[1]);
  }
  /// The same for the cells at a wall, which are numbered from 0 in the plane of the other axes.
  BDH_FN void locate_at_wall(int axis, int side, long cell, long *at) const
  {
    const int a = axis == 0 ? 1 : 0, b = axis == 2 ? 1 : 2;
    at[axis] = side ? n[axis] - 1 : 0;
    at[a] = cell % n[a];
    at[b] = cell / n[a];
  }
};

/// D^T at the face between two cells.  scale: from face_scale()
BDH_FN double gradient(double scale, double before, double here) { return scale * (before - here); }

/// Contribution of an axis to D at a cell, from the two faces on either side of it.
BDH_FN double divergence(double inv_h, double here, double after) { return inv_h * (after - here); }

/// Sum of (v/h)^2 over the faces below a cell, by cell of a rank.
template <int D> struct Steepness {
  BoxGrid box;
  const double *faces[3];
  BDH_FN double operator()(long cell) const
  {
    long at[3];
    box.locate(cell, at);
    double sum = 0.0;
    for (int d = 0; d < D; ++d) {
      const double slope = box.inv_h[d] * faces[d][box.place(at)];
      sum += slope * slope;
    }
    return sum;
  }
};

/// Force on a face [force/volume]; 0 on a wall.  i: index along d
BDH_FN double face_force(const BoxGrid &b, int d, long i, double force, double body_force)
{
  return b.on_wall(d, i) ? 0.0 : force + body_force;
}

/// Adds to `field` the force that a wall with velocity V exerts at a cell next to it.  The ghost
/// value behind the wall is 2 V - v; the Laplacian already contains the -v.
BDH_FN void add_moving_wall(const BoxGrid &b, int axis, const double *V, double viscosity,
                            const long *at, long place, double *const *field)
{
  for (int d = 0; d < 3; ++d)
    if (d < b.dim && d != axis && !b.on_wall(d, at[d]))
      field[d][place] += 2.0 * viscosity / (b.h[axis] * b.h[axis]) * V[d];
}

/// Adds the pressure and the friction on a wall at one cell to `force` [force].
/// \param q  pressure/viscosity of v = u + (-L)^-1 D^T q at the cell, with zero mean over the box
/// \param V  velocity of the wall
BDH_FN void add_wall_force(const BoxGrid &b, int axis, int side, const double *V, double viscosity,
                           const long *at, long place, double q, double *const *velocity,
                           double *force)
{
  const double stiffness = viscosity * b.cell_volume / b.h[axis];
  force[axis] += (side ? 1.0 : -1.0) * stiffness * q;
  if (!b.noslip[axis][side]) return;
  for (int d = 0; d < 3; ++d)
    if (d < b.dim && d != axis && !b.on_wall(d, at[d]))
      force[d] += 2.0 * stiffness / b.h[axis] * (velocity[d][place] - V[d]);
}

/// Scales that all modes of a solve share.
struct BoxModeScales {
  double factor;       ///< of the force
  double norm;         ///< factor by which a forward and a backward transform multiply
  double amplitude;    ///< of the random velocity, for normals of variance 1/2
};

/// factor (-L)^-1 f + amplitude (-L)^-1/2 z for one mode of a component, normalised.
///
/// \param lambda  eigenvalue of -L [1/length^2]
/// \param weight  squared norm of the mode relative to that of a typical one.  It is 0 where there
///                is no unknown, and so is the result.
/// \param noisy   whether z is used
BDH_FN double solve_box_mode(const BoxModeScales &s, double lambda, double weight, double f,
                             bool noisy, double z)
{
  if (!(lambda > 0.0 && weight != 0.0)) return 0.0;
  return f * (s.factor / (lambda * s.norm)) +
         (noisy ? s.amplitude / std::sqrt(lambda * weight) * z : 0.0);
}

/// Start of conjugate gradients, entry by entry: residual := direction := -divergence,
/// pressure := 0.
struct StartDescent {
  double *residual, *direction, *pressure;
  BDH_FN void operator()(long i) const
  {
    pressure[i] = 0.0;
    direction[i] = residual[i] = -residual[i];
  }
};

/// One step of length alpha along the direction, entry by entry.
/// `image` is D (-L)^-1 D^T direction; `step` is the intermediate result (-L)^-1 D^T direction.
template <int D> struct AdvanceDescent {
  double alpha;
  const double *direction, *image, *step[3];
  double *pressure, *residual, *velocity[3];
  BDH_FN void operator()(long i) const
  {
    pressure[i] += alpha * direction[i];
    residual[i] -= alpha * image[i];
    for (int d = 0; d < D; ++d) velocity[d][i] += alpha * step[d][i];
  }
};

}    // namespace bdh
#endif
