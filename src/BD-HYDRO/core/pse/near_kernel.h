// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// The near part of the mobility of two spheres of any radii, with or without rotation: the exact
/// mobility of the pair without its wave-space part.
///
/// Everything is scaled by the free mobilities of both spheres, 1/a for translation and 3/(4 a^3)
/// for rotation in units of 1/(6 pi viscosity), so that blocks have no units and the exact self
/// mobility is 1.
#ifndef BDH_PSE_NEAR_KERNEL_H
#define BDH_PSE_NEAR_KERNEL_H

#include "pse/layout.h"
#include "pse/shapes_kernel.h"
#include "pse/sphere_pair_kernel.h"

namespace bdh {

/// A sphere as the pair functions need it.
template <class Real> struct Sphere {
  Real radius;
  Real force, torque;              ///< c of its force and of its torque (pse/shapes_kernel.h)
  Real root_force, root_torque;    ///< 1/sqrt of its free mobilities: a^(1/2), (4 a^3/3)^(1/2)
};

template <class Real> BDH_FN Sphere<Real> make_sphere(double a, const ShapeBasis &basis)
{
  return {Real(a), Real(basis.coefficient(a * a)), Real(basis.coefficient(basis.moment * a * a)),
          Real(std::sqrt(a)), Real(std::sqrt(4.0 / 3.0 * a * a * a))};
}

/// The functions of a pair, scaled; e points from j to i.
///
///     U_i = f F_j + df e (e.F_j) + uj e x T_j,   W_i = wi e x F_j + g T_j + dg e (e.T_j)
///     U_j = f F_i + df e (e.F_i) - wi e x T_i,   W_j = -uj e x F_i + g T_i + dg e (e.T_i)
template <class Real> struct NearPair {
  Real f, df;     ///< velocity by force: transverse, and longitudinal - transverse
  Real g, dg;     ///< angular velocity by torque
  Real wi, uj;    ///< rotation of i with the force on j, of j with the force on i
};

/// Functions of the distance that are tabulated for one pair of shapes.
template <Moments moments> constexpr int near_functions()
{
  return moments == Moments::none ? 2 : moments == Moments::torque ? 5 : 7;
}
/// Pairs of shapes: 11, 12, 22.
constexpr int shape_pairs = 3;
/// Numbers of one row of a table: those of all pairs of shapes, and padding.
template <Moments moments> constexpr int table_row()
{
  return moments == Moments::none ? 8 : moments == Moments::torque ? 16 : 24;
}

/// What the wave-space part makes of pairs, as polynomials of degree near_degree in intervals of
/// one width; rows of coefficients have the highest power first, and functions [shape pair][which]:
/// transverse and difference of the translation, coefficient of the coupling, transverse and
/// difference of the rotation.  Stresslets have functions of their own (pse/strain_near_kernel.h).
constexpr int near_degree = 7;

template <class Real, Moments moments> struct NearFunctions {
  static constexpr bool rotation = moments == Moments::torque;
  const Real *coefficients;
  Real inv_width;
  int intervals;

  /// values[table_row] := the tabulated functions at r, not beyond the table.
  BDH_FN void evaluate(Real r, Real *values) const
  {
    constexpr int row = table_row<moments>();
    const Real place = r * inv_width;
    int interval = static_cast<int>(place);
    if (interval >= intervals) interval = intervals - 1;
    const Real u = place - interval - Real(0.5);
    const Real *c = coefficients + interval * (near_degree + 1) * row;
    for (int k = 0; k < row; ++k) values[k] = c[k];
    for (int m = 1; m <= near_degree; ++m)
      for (int k = 0; k < row; ++k) values[k] = values[k] * u + c[m * row + k];
  }

  /// The near part of a pair at distance r > 0.
  BDH_FN NearPair<Real> operator()(double r, const Sphere<Real> &i, const Sphere<Real> &j) const
  {
    Real w[table_row<moments>()];
    evaluate(r, w);
    constexpr int n = near_functions<moments>();
    const double ai = i.radius, aj = j.radius;
    NearPair<Real> p{};
    const auto sum = [&w](int which, Real ci, Real cj) {
      return sum_of_shapes(ci, cj, w[which], w[n + which], w[2 * n + which]);
    };
    const PairBlock t = sphere_translation(r, ai, aj);
    const Real tt = i.root_force * j.root_force;
    p.f = tt * (Real(t.transverse) - sum(0, i.force, j.force));
    p.df = tt * (Real(t.difference) - sum(1, i.force, j.force));
    if constexpr (rotation) {
      p.wi = i.root_torque * j.root_force *
             (Real(sphere_coupling(r, ai, aj)) - sum(2, i.torque, j.force));
      p.uj = i.root_force * j.root_torque *
             (Real(sphere_coupling(r, aj, ai)) - sum(2, i.force, j.torque));
      const PairBlock q = sphere_rotation(r, ai, aj);
      const Real rr = i.root_torque * j.root_torque;
      p.g = rr * (Real(q.transverse) - sum(3, i.torque, j.torque));
      p.dg = rr * (Real(q.difference) - sum(4, i.torque, j.torque));
    }
    return p;
  }

  /// The near part of a sphere by itself: f and g only.
  BDH_FN NearPair<Real> self(const Sphere<Real> &i) const
  {
    Real w[table_row<moments>()];
    evaluate(Real(0), w);
    constexpr int n = near_functions<moments>();
    const auto sum = [&w](int which, Real c) {
      return sum_of_shapes(c, c, w[which], w[n + which], w[2 * n + which]);
    };
    NearPair<Real> p{};
    p.f = 1 - i.root_force * i.root_force * sum(0, i.force);
    if constexpr (rotation) p.g = 1 - i.root_torque * i.root_torque * sum(3, i.torque);
    return p;
  }
};

}    // namespace bdh
#endif
