// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// The near part of the mobility of two spheres of any radii with forces, torques and stresslets:
/// the exact mobility of the pair without its wave-space part.
///
/// A sphere has the first moments D_dc = S_dc + eps_dce T_e/2 of its forces; another one reads its
/// velocity U and the gradient G_ab of the flow, of which W_c = eps_cab G_ab/2 and E = sym G.  All
/// blocks are derivatives of one function of the distance (pse/strain_pair_kernel.h).
#ifndef BDH_PSE_STRAIN_NEAR_KERNEL_H
#define BDH_PSE_STRAIN_NEAR_KERNEL_H

#include "base/strain_kernel.h"
#include "base/vector_kernel.h"
#include "pse/near_kernel.h"
#include "pse/strain_pair_kernel.h"

namespace bdh {

/// Free mobilities of first moments in units of 1/(6 pi viscosity a^3): of torques, W = T/(8 pi
/// viscosity a^3), and of stresslets, E = 3 S/(20 pi viscosity a^3).
constexpr double torque_mobility = 0.75, stresslet_mobility = 0.9;

/// Numbers of the load of a sphere and of its motion: of forces, torques and stresslets.
constexpr int motion_numbers = 2 * dim + strain_numbers;

/// What one of these numbers is multiplied with in a vector that is scaled by the free mobilities,
/// to give a load of unscaled first moments, and afterwards to give a scaled motion.
template <class Real> BDH_FN Real inverse_root(int c)
{
  return c < dim ? Real(1)
                 : Real(1.0 / std::sqrt(c < 2 * dim ? torque_mobility : stresslet_mobility));
}

/// The functions of a pair.  Those of forces are scaled by (a_i a_j)^(1/2), those of moments by
/// (a_i a_j)^(3/2), those of both by a^(3/2) of the moment and a^(1/2) of the force.
template <class Real> struct StrainPair {
  Real f, df;     ///< velocity by force: transverse, and longitudinal - transverse
  Real p, q;      ///< r b_2 and r^3 b_3 of the force on i and the moment of j
  Real pr, qr;    ///< the same of the moment of i and the force on j
  Real b[3];      ///< b_2, r^2 b_3, r^4 b_4 of both moments
};
constexpr int strain_functions = 9;

/// What one sphere's load does to another one, at a place in direction e from the load.
template <class Real> struct StrainLoad {
  Real F[3], T[3];
  Symmetric<Real> S;
  /// From its numbers.
  BDH_FN static StrainLoad of(const Real *v)
  {
    return {{v[0], v[1], v[2]}, {v[3], v[4], v[5]}, Symmetric<Real>::of(v + 2 * dim)};
  }
};

template <class Real> BDH_FN void times(const Symmetric<Real> &S, const Real *e, Real *Se)
{
  Se[0] = S.xx * e[0] + S.xy * e[1] + S.xz * e[2];
  Se[1] = S.xy * e[0] + S.yy * e[1] + S.yz * e[2];
  Se[2] = S.xz * e[0] + S.yz * e[1] + S.zz * e[2];
}

/// strain += own S + sym e v, without its trace, in five numbers.
template <class Real> BDH_FN void add_symmetric(const Real &own, const Symmetric<Real> &S,
                                                const Real *e, const Real *v, Real *strain)
{
  const Real half = Real(0.5);
  const Symmetric<Real> E{own * S.xx + e[0] * v[0],
                          own * S.yy + e[1] * v[1],
                          own * S.zz + e[2] * v[2],
                          own * S.xy + half * (e[0] * v[1] + e[1] * v[0]),
                          own * S.xz + half * (e[0] * v[2] + e[2] * v[0]),
                          own * S.yz + half * (e[1] * v[2] + e[2] * v[1])};
  Real numbers[strain_numbers];
  E.numbers(numbers);
  for (int c = 0; c < strain_numbers; ++c) strain[c] += numbers[c];
}

/// U += -K' D and so on: with t = e x T/2, Se = S e and the functions p, q of the force on the
/// moved sphere and the moment, p', q' of the moment of the moved one and the force,
///
///     U = f F + df e (e.F) - (3p + q) Se + q e (e.Se) + (5p + q) t
///     W = (5p' + q')/2 e x F - (5b_2 + b_3)/2 T - (7b_3 + b_4)/2 e x (Se - t)
///     E = -(3b_2 + b_3) S + sym e ((3p' + q') F - (3b_3 + b_4) Se + (7b_3 + b_4) t)
///         + e e (b_4 e.Se - q' e.F)  without its trace.
///
/// motion: U, W, E in 3, 3 and 5 numbers.
template <class Real> BDH_FN void add_motion(const StrainPair<Real> &m, const Real *e,
                                             const StrainLoad<Real> &load, Real *motion)
{
  Real Se[3], exT[3], exF[3], turn[3], eTurn[3], v[3];
  times(load.S, e, Se);
  cross_product(e, load.T, exT);
  cross_product(e, load.F, exF);
  const Real eF = scalar_product(e, load.F), eSe = scalar_product(e, Se);
  const Real b2 = m.b[0], b3 = m.b[1], b4 = m.b[2], half = Real(0.5);
  const Real along = m.df * eF + m.q * eSe, strain = 3 * m.p + m.q, spin = half * (5 * m.p + m.q),
             by_force = half * (5 * m.pr + m.qr), by_torque = half * (5 * b2 + b3),
             by_turn = half * (7 * b3 + b4), outer = b4 * eSe - m.qr * eF;
  for (int c = 0; c < 3; ++c) turn[c] = Se[c] - half * exT[c];
  cross_product(e, turn, eTurn);
  for (int c = 0; c < 3; ++c) {
    motion[c] += m.f * load.F[c] + along * e[c] - strain * Se[c] + spin * exT[c];
    motion[3 + c] += by_force * exF[c] - by_torque * load.T[c] - by_turn * eTurn[c];
    v[c] = (3 * m.pr + m.qr) * load.F[c] - (3 * b3 + b4) * Se[c] + by_turn * exT[c] + outer * e[c];
  }
  add_symmetric(-(3 * b2 + b3), load.S, e, v, motion + 6);
}

/// The part of add_motion() that leads from stresslets to strains.
template <class Real>
BDH_FN void add_strain(const Real *b, const Real *e, const Symmetric<Real> &S, Real *strain)
{
  Real Se[3], v[3];
  times(S, e, Se);
  const Real eSe = scalar_product(e, Se);
  for (int c = 0; c < 3; ++c) v[c] = b[2] * eSe * e[c] - (3 * b[1] + b[2]) * Se[c];
  add_symmetric(-(3 * b[0] + b[1]), S, e, v, strain);
}

/// A sphere as these functions need it.
template <class Real> struct StrainSphere {
  Real radius, force, moment;      ///< c of both (pse/shapes_kernel.h)
  Real root_force, root_moment;    ///< a^(1/2), a^(3/2)
};

template <class Real>
BDH_FN StrainSphere<Real> make_strain_sphere(double a, const ShapeBasis &basis)
{
  return {Real(a), Real(basis.coefficient(a * a)), Real(basis.coefficient(moment_shape * a * a)),
          Real(std::sqrt(a)), Real(a * std::sqrt(a))};
}

template <class Real> struct StrainNear {
  NearFunctions<Real, Moments::stresslet> table;

  /// The near part of a pair at distance r > 0.
  BDH_FN StrainPair<Real> operator()(double r, const StrainSphere<Real> &i,
                                     const StrainSphere<Real> &j) const
  {
    Real w[table_row<Moments::stresslet>()];
    table.evaluate(r, w);
    constexpr int n = near_functions<Moments::stresslet>();
    const auto sum = [&w](int which, Real ci, Real cj) {
      return sum_of_shapes(ci, cj, w[which], w[n + which], w[2 * n + which]);
    };
    const double ai = i.radius, aj = j.radius;
    const PairBlock translation = sphere_translation(r, ai, aj);
    const PairDerivatives ij = force_moment(r, ai, aj), ji = force_moment(r, aj, ai),
                          moments = moment_moment(r, ai, aj);
    const Real ff = i.root_force * j.root_force, fm = i.root_force * j.root_moment,
               mf = i.root_moment * j.root_force, mm = i.root_moment * j.root_moment;
    return {ff * (Real(translation.transverse) - sum(0, i.force, j.force)),
            ff * (Real(translation.difference) - sum(1, i.force, j.force)),
            fm * (Real(r * ij.b2) - sum(2, i.force, j.moment)),
            fm * (Real(r * ij.b3) - sum(3, i.force, j.moment)),
            mf * (Real(r * ji.b2) - sum(2, i.moment, j.force)),
            mf * (Real(r * ji.b3) - sum(3, i.moment, j.force)),
            {mm * (Real(moments.b2) - sum(4, i.moment, j.moment)),
             mm * (Real(moments.b3) - sum(5, i.moment, j.moment)),
             mm * (Real(moments.b4) - sum(6, i.moment, j.moment))}};
  }

  /// What a sphere's own load moves it by, over what it moves a free sphere: of forces, torques and
  /// stresslets.
  BDH_FN void self(const StrainSphere<Real> &i, Real *share) const
  {
    Real w[table_row<Moments::stresslet>()];
    table.evaluate(Real(0), w);
    constexpr int n = near_functions<Moments::stresslet>();
    const auto sum = [&w](int which, Real c) {
      return sum_of_shapes(c, c, w[which], w[n + which], w[2 * n + which]);
    };
    const Real b2 = i.root_moment * i.root_moment * sum(4, i.moment);
    share[0] = 1 - i.root_force * i.root_force * sum(0, i.force);
    share[1] = 1 + Real(2.5 / torque_mobility) * b2;
    share[2] = 1 + Real(3.0 / stresslet_mobility) * b2;
  }
};

}    // namespace bdh
#endif
