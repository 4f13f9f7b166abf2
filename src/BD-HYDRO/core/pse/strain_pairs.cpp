// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
#include "pse/strain_pairs.h"

#include "base/portable.h"

namespace bdh {

namespace {

constexpr int numbers = 2 * dim + strain_numbers;
static_assert(numbers < strain_slots);

/// The root of the free mobility of a number of a vector, without the radius.
template <class Real> Real inverse_root(int c)
{
  return c < dim ? Real(1)
                 : Real(1.0 / std::sqrt(c < 2 * dim ? torque_mobility : stresslet_mobility));
}

/// The factors of all numbers.
template <class Real> struct Roots {
  Real of[numbers];
  Roots()
  {
    for (int c = 0; c < numbers; ++c) of[c] = inverse_root<Real>(c);
  }
};

template <class Real> StrainLoad<Real> load_of(const Real *v)
{
  return {{v[0], v[1], v[2]}, {v[3], v[4], v[5]}, Symmetric<Real>::of(v + 2 * dim)};
}

/// The numbers of some particles, side by side.
template <class Real, int lanes> struct Lanes {
  alignas(64) Real c[numbers][lanes];

  void gather(const Real *v, const int *particle, const Roots<Real> &roots)
  {
    for (int l = 0; l < lanes; ++l) {
      const Real *from = v + strain_slots * long(particle[l]);
      for (int k = 0; k < numbers; ++k) c[k][l] = from[k];
    }
    for (int k = dim; k < numbers; ++k)
      for (int l = 0; l < lanes; ++l) c[k][l] *= roots.of[k];
  }
  void scatter_add(Real *u, const int *particle, const Roots<Real> &roots)
  {
    for (int k = dim; k < numbers; ++k)
      for (int l = 0; l < lanes; ++l) c[k][l] *= roots.of[k];
    for (int l = 0; l < lanes; ++l) {
      Real *to = u + strain_slots * long(particle[l]);
      for (int k = 0; k < numbers; ++k) to[k] += c[k][l];
    }
  }
};

}    // namespace

template <class Real> template <bool mutual>
void StrainPairs<Real>::apply(const PairRange &range, const Real *v, Real *u) const
{
  static const Roots<Real> roots;
  const int particle = range.particle;
  Real own_numbers[numbers];
  for (int c = 0; c < numbers; ++c)
    own_numbers[c] = roots.of[c] * v[strain_slots * long(particle) + c];
  const StrainLoad<Real> own = load_of(own_numbers);
  using Group = Lanes<Real, group>;
  Group others, answer, sum{};
  for (long k = range.first; k < range.end; k += group) {
    const int *other = other_.data() + k;
    others.gather(v, other, roots);
    BDH_INDEPENDENT
    for (int l = 0; l < group; ++l) {
      const auto at = [this, k, l](int which) { return number_[which][k + l]; };
      const Real e[dim] = {at(0), at(1), at(2)}, back[dim] = {-e[0], -e[1], -e[2]};
      const StrainPair<Real> m{at(3), at(4), at(5), at(6), at(7), at(8), {at(9), at(10), at(11)}};
      Real load[numbers], motion[numbers] = {};
      for (int c = 0; c < numbers; ++c) load[c] = others.c[c][l];
      add_motion(m, e, load_of(load), motion);
      for (int c = 0; c < numbers; ++c) sum.c[c][l] += motion[c];
      if constexpr (mutual) {
        const StrainPair<Real> r{m.f, m.df, m.pr, m.qr, m.p, m.q, {m.b[0], m.b[1], m.b[2]}};
        Real reaction[numbers] = {};
        add_motion(r, back, own, reaction);
        for (int c = 0; c < numbers; ++c) answer.c[c][l] = reaction[c];
      }
    }
    if constexpr (mutual) answer.scatter_add(u, other, roots);
  }
  Real *to = u + strain_slots * long(particle);
  for (int c = 0; c < numbers; ++c) {
    Real total = 0;
    for (int l = 0; l < group; ++l) total += sum.c[c][l];
    to[c] += roots.of[c] * total;
  }
}

template void StrainPairs<float>::apply<true>(const PairRange &, const float *, float *) const;
template void StrainPairs<float>::apply<false>(const PairRange &, const float *, float *) const;
template void StrainPairs<double>::apply<true>(const PairRange &, const double *, double *) const;
template void StrainPairs<double>::apply<false>(const PairRange &, const double *, double *) const;

}    // namespace bdh
