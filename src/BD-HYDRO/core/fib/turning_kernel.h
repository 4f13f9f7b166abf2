// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Weights of torques and angular velocities, and of stresslets and rates of strain.
///
/// Vorticity lives on the edges of the cells, where the differences of a staggered velocity are,
/// and the angular velocity of a particle is half its average with a kernel K:
///
///     omega_x = 1/2 sum_edges phi_x(centre) phi_y(face) phi_z(face) (D_y v_z - D_z v_y)
///
/// Summed by parts, the differences act on K: v_z gets phi_x(centre) d_y phi_z(face), with
/// d = (phi(face below) - phi(face above))/h on the lines of the centres.  A torque is spread with
/// the same weights, half the discrete curl of K, so both are adjoint to the last bit.  Images
/// behind walls are those of the velocity: omega is the average of the curl of the mirrored field,
/// and exact in a linear flow along a wall.
///
/// The rate of strain is the average of the symmetric part of the same gradient.  Its shear is on
/// the edges, too; D_x v_x is at the centres, where v_x gets (phi(centre below) -
/// phi(centre above))/h on its own faces.  So the trace is that of the discrete divergence, which
/// is 0.  [FIB App. B]
///
/// The derivative of the smooth kernel in place of differences would make the rotational radius
/// vary by 5 to 15 % within a cell.
#ifndef BDH_FIB_TURNING_KERNEL_H
#define BDH_FIB_TURNING_KERNEL_H

#include "fib/ib_kernel.h"

namespace bdh {

/// The kernel K that belongs to a kernel of forces and velocities: the one whose rotational radius
/// is nearest to the hydrodynamic radius of the latter.  The same kernel for both would make the
/// rotational radius 1.3 times as large.
template <class Kernel> struct TurningKernel {
  using Type = Roma3;
};
template <> struct TurningKernel<BaoKayePeskin6> {
  using Type = Peskin4;
};

/// Weights of K along one axis, on `width` lines each: those of the faces, from line first_face on,
/// and those of the centres, from line first_face - 1 on.
template <class K> struct TurningWeights {
  static constexpr int width = K::width + 1;
  double face[width], centre[width], difference[width];
  long first_face;

  BDH_FN long first_centre() const { return first_face - 1; }

  /// x and the spacing h of the axis; x is in units of h.
  BDH_FN TurningWeights(double x, double h)
  {
    double r, w[K::width];
    first_face = static_cast<long>(K::first(x, r));
    K::weights(r, w);
    for (int i = 0; i < width; ++i) {
      face[i] = i < K::width ? w[i] : 0.0;
      difference[i] = ((i > 0 ? w[i - 1] : 0.0) - face[i]) / h;
      centre[i] = 0.0;
    }
    const long skip = static_cast<long>(K::first(x - 0.5, r)) - first_centre();    // 0 or 1
    K::weights(r, w);
    for (int i = 0; i < K::width; ++i) centre[i + skip] = w[i];
  }
};

/// The same with the weights of D_c v_c along axis c, on the lines of the faces from first_normal
/// on.
template <class K> struct StrainWeights : TurningWeights<K> {
  using TurningWeights<K>::width;
  using TurningWeights<K>::centre;
  double normal[width];
  long first_normal;

  BDH_FN StrainWeights(double x, double h) : TurningWeights<K>(x, h)
  {
    // Where the first weight is 0, all of its neighbors fit in without it.
    const int skip = centre[0] == 0.0 ? 1 : 0;
    first_normal = this->first_centre() + skip;
    for (int i = 0; i < width; ++i) {
      const int above = skip + i;
      normal[i] =
          ((above > 0 ? centre[above - 1] : 0.0) - (above < width ? centre[above] : 0.0)) / h;
    }
  }
};

/// Component c of the velocity under a torque T: 1/2 (T_a phi_a d_b - T_b d_a phi_b) phi_c, with
/// a, b, c in cyclic order.  There are two terms, one for each axis of the differences.
struct TurningTerm {
  int torque, difference;    ///< axes
  double factor;
  BDH_FN TurningTerm(int c, int term) :
      torque((c + 1 + term) % 3), difference((c + 2 - term) % 3), factor(term ? -0.5 : 0.5)
  {}
};

}    // namespace bdh
#endif
