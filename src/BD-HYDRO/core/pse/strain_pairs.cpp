// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
#include "pse/strain_pairs.h"

#include "base/registers.h"

#include <cstring>

namespace bdh {

namespace {

constexpr int numbers = motion_numbers;
static_assert(numbers < strain_slots);

/// The factors of all numbers.
template <class Real> struct Roots {
  Real of[numbers];
  Roots()
  {
    for (int c = 0; c < numbers; ++c) of[c] = inverse_root<Real>(c);
  }
};

/// One number of each of some pairs of a group, side by side in a vector register.
template <class Real> struct Lanes {
  typedef Real Register __attribute__((vector_size(register_bytes)));
  static constexpr int count = register_bytes / sizeof(Real);
  Register v{};

  Lanes() = default;
  Lanes(Real one) : v(Register{} + one) {}
  static Lanes at(const Real *p)
  {
    Lanes r;
    std::memcpy(&r.v, p, sizeof r.v);
    return r;
  }
  void store(Real *p) const { std::memcpy(p, &v, sizeof v); }
  Real sum() const
  {
    Real total = 0;
    for (int l = 0; l < count; ++l) total += v[l];
    return total;
  }
  Lanes &operator+=(const Lanes &o)
  {
    v += o.v;
    return *this;
  }
  Lanes operator-() const
  {
    Lanes r;
    r.v = -v;
    return r;
  }
  friend Lanes operator+(Lanes a, const Lanes &b)
  {
    a.v += b.v;
    return a;
  }
  friend Lanes operator-(Lanes a, const Lanes &b)
  {
    a.v -= b.v;
    return a;
  }
  friend Lanes operator*(Lanes a, const Lanes &b)
  {
    a.v *= b.v;
    return a;
  }
};

inline long first_number(int particle) { return first_slot(3L * particle); }
static_assert(strain_slots == 3 * slots, "a particle has three quads");

/// `count` numbers of as many particles, from number `first` on, transposed.
template <class Real, int count = numbers, int first = 0> struct Transposed {
  using Group = Lanes<Real>;
  alignas(64) Real c[count][Group::count];

  void gather(const Real *v, const int *particle)
  {
    for (int l = 0; l < Group::count; ++l) {
      const Real *from = v + first_number(particle[l]) + first;
      for (int k = 0; k < count; ++k) c[k][l] = from[k];
    }
  }
  void scatter_add(Real *u, const int *particle) const
  {
    for (int l = 0; l < Group::count; ++l) {
      Real *to = u + first_number(particle[l]) + first;
      for (int k = 0; k < count; ++k) to[k] += c[k][l];
    }
  }
};

}    // namespace

template <class Real> template <bool mutual>
void StrainPairs<Real>::apply(const PairRange &range, const Real *v, Real *u) const
{
  using Group = Lanes<Real>;
  static_assert(group % Group::count == 0);
  static const Roots<Real> roots;
  const int particle = range.particle;
  Group own[numbers], sum[numbers];
  for (int c = 0; c < numbers; ++c) own[c] = roots.of[c] * v[first_number(particle) + c];
  const StrainLoad<Group> own_load = StrainLoad<Group>::of(own);
  Transposed<Real> others;
  for (long k = range.first; k < range.end; k += Group::count) {
    const int *other = other_.data() + k;
    const auto at = [this, k](int which) { return Group::at(&number_[which][k]); };
    const Group e[dim] = {at(0), at(1), at(2)}, back[dim] = {-e[0], -e[1], -e[2]};
    const StrainPair<Group> m{at(3), at(4), at(5), at(6), at(7), at(8), {at(9), at(10), at(11)}};
    others.gather(v, other);
    Group load[numbers];
    for (int c = 0; c < numbers; ++c) load[c] = Group(roots.of[c]) * Group::at(others.c[c]);
    add_motion(m, e, StrainLoad<Group>::of(load), sum);
    if constexpr (mutual) {
      const StrainPair<Group> reversed{m.f, m.df, m.pr, m.qr, m.p, m.q, {m.b[0], m.b[1], m.b[2]}};
      Group reaction[numbers];
      add_motion(reversed, back, own_load, reaction);
      for (int c = 0; c < numbers; ++c) (Group(roots.of[c]) * reaction[c]).store(others.c[c]);
      others.scatter_add(u, other);
    }
  }
  Real *to = u + first_number(particle);
  for (int c = 0; c < numbers; ++c) to[c] += roots.of[c] * sum[c].sum();
}

template <class Real> template <bool mutual>
void StrainPairs<Real>::apply_strains(const PairRange &range, const Real *v, Real *u) const
{
  using Group = Lanes<Real>;
  constexpr int first = 2 * dim;
  const Real root = inverse_root<Real>(first), factor = root * root;
  const Real *from = v + first_number(range.particle) + first;
  Real *to = u + first_number(range.particle) + first;
  Group own[strain_numbers], sum[strain_numbers];
  for (int c = 0; c < strain_numbers; ++c) own[c] = factor * from[c];
  const Symmetric<Group> own_load = Symmetric<Group>::of(own);
  Transposed<Real, strain_numbers, first> others;
  for (long k = range.first; k < range.end; k += Group::count) {
    const int *other = other_.data() + k;
    const auto at = [this, k](int which) { return Group::at(&number_[which][k]); };
    const Group e[dim] = {at(0), at(1), at(2)}, b[3] = {at(9), at(10), at(11)};
    others.gather(v, other);
    Group load[strain_numbers];
    for (int c = 0; c < strain_numbers; ++c) load[c] = Group(factor) * Group::at(others.c[c]);
    add_strain(b, e, Symmetric<Group>::of(load), sum);
    if constexpr (mutual) {
      Group reaction[strain_numbers];
      add_strain(b, e, own_load, reaction);
      for (int c = 0; c < strain_numbers; ++c) reaction[c].store(others.c[c]);
      others.scatter_add(u, other);
    }
  }
  for (int c = 0; c < strain_numbers; ++c) to[c] += sum[c].sum();
}

template void StrainPairs<float>::apply<true>(const PairRange &, const float *, float *) const;
template void StrainPairs<float>::apply<false>(const PairRange &, const float *, float *) const;
template void StrainPairs<double>::apply<true>(const PairRange &, const double *, double *) const;
template void StrainPairs<double>::apply<false>(const PairRange &, const double *, double *) const;

#define BDH_STRAINS(Real, mutual)                                                                  \
  template void StrainPairs<Real>::apply_strains<mutual>(const PairRange &, const Real *, Real *)  \
      const;
BDH_STRAINS(float, true)
BDH_STRAINS(float, false)
BDH_STRAINS(double, true)
BDH_STRAINS(double, false)
#undef BDH_STRAINS

}    // namespace bdh
