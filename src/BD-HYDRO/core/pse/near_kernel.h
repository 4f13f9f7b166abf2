// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// The near part of the mobility of two spheres of any radii, with or without rotation: the exact
/// mobility of the pair without its wave-space part.
///
/// Everything is scaled by the free mobilities of both spheres, 1/a for translation and 3/(4 a^3)
/// for rotation in units of 1/(6 pi viscosity), so that blocks have no units and the exact self
/// mobility is 1.
#ifndef BDH_PSE_NEAR_KERNEL_H
#define BDH_PSE_NEAR_KERNEL_H

#include "base/octet_kernel.h"
#include "pse/layout.h"
#include "pse/shapes_kernel.h"
#include "pse/sphere_pair_kernel.h"
#include "pse/splitting_kernel.h"

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

/// Logarithm of the near part of two spheres of shape sinc(k b) whose distance is 2 half, up to
/// factors that do not depend on b, and halved, so that the logarithms of two spheres add up.
///
/// The near part of two points falls off like exp(-xi^2 r^2); here it is averaged over both
/// surfaces.
BDH_FN double log_near(double half, double b, double xi)
{
  const double aligned = -2.0 * xi * xi * (half * half + b * b), y = 4.0 * xi * xi * half * b;
  if (y < 1e-3) return aligned;
  // Of a surface, the part that faces the other sphere counts.
  const double facing = -std::expm1(-2.0 * y) / (2.0 * y);
  return aligned + y + std::log(facing) - 0.5 * std::log(std::fmax(1.0 - b / half, 1e-3));
}

/// How far the near part of spheres reaches: that of a pair up to the sum of both [length].
///
/// With Hasimoto's splitting, pairs end where they leave out as much as two of the greatest spheres
/// do at the plan's cutoff, within a factor of 1.5: sooner the less they have of the wider shape.
/// With the other one all pairs end there.
struct NearReach {
  double greatest, least, inverse_slope, narrow;

  BDH_FN NearReach(const ShapeBasis &basis, const WaveWeight &weight, double r_cut) :
      NearReach(basis, weight.xi, weight.kaiser_bessel ? 0.0 : r_cut)
  {
    if (weight.kaiser_bessel) greatest = least = 0.5 * r_cut;
  }

  BDH_FN NearReach(const ShapeBasis &basis, double xi, double r_cut) :
      greatest(0.5 * r_cut), least(greatest), inverse_slope(0.0), narrow(1.0)
  {
    if (!(r_cut > 2.0 * basis.b2)) return;
    const double level = log_near(greatest, basis.b2, xi);
    narrow = std::exp(log_near(greatest, basis.b1, xi) - level);
    double low = greatest - (basis.b2 - basis.b1);
    for (int i = 0; i < 40; ++i) {
      const double middle = 0.5 * (low + least);
      (log_near(middle, basis.b1, xi) > level ? low : least) = middle;
    }
    const double y = 2.0 * xi * xi * r_cut * basis.b2, along = 1.0 / std::tanh(y) - 1.0 / y;
    inverse_slope = 0.5 / (xi * xi * (r_cut - 2.0 * basis.b2 * along));
  }
  /// c: that of the force on a sphere, from 0 to 1
  BDH_FN double operator()(double c) const
  {
    return std::fmax(least, greatest + inverse_slope * std::log(c * narrow + (1.0 - c)));
  }
};

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
    constexpr int octets = row / 8;
    Octet<Real> sum[octets];
    for (int o = 0; o < octets; ++o) sum[o].load(c + 8 * o);
    for (int m = 1; m <= near_degree; ++m)
      for (int o = 0; o < octets; ++o) sum[o].step(u, c + m * row + 8 * o);
    for (int o = 0; o < octets; ++o) sum[o].store(values + 8 * o);
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
