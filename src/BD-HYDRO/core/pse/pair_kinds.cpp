// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
#include "pse/pair_kinds.h"

#include "base/shuffles.h"

#include <algorithm>
#include <utility>

namespace bdh {

namespace {

/// Where the numbers of a particle begin; `quads`: of each particle.
template <int quads> long first(int particle) { return static_cast<long>(quads * quad) * particle; }

/// Quads x, y, z, w of some particles side by side in a register.
template <class Real> struct Quads {
  static constexpr int count = std::max(1, lanes_of_register<Real> / quad);
  using One = LanesOf<Real, quad>;
  using All = LanesOf<Real, quad * count>;

  static One load_one(const Real *p) { return lanes_at<Real, quad>(p); }
  static All load(const Real *p) { return lanes_at<Real, quad * count>(p); }
  /// one(g): the quad of particle g
  template <class Action> static All join(const Action &one)
  {
    if constexpr (count == 1)
      return one(0);
    else if constexpr (count == 2)
      return two(one, 0);
    else
      return joined<Real, 2 * quad>(two(one, 0), two(one, 2),
                                    std::make_integer_sequence<int, 4 * quad>());
  }
  template <int g> static One part(All v)
  {
    return __builtin_shufflevector(v, v, quad * g, quad * g + 1, quad * g + 2, quad * g + 3);
  }
  /// The numbers x, y, z, w of each particle := those at these places.
  template <int x, int y, int z, int w> static All shuffle(All v)
  {
    return shuffle<x, y, z, w>(v, std::make_integer_sequence<int, quad * count>{});
  }

 private:
  template <class Action> static LanesOf<Real, 2 * quad> two(const Action &one, int g)
  {
    return joined<Real, quad>(one(g), one(g + 1), std::make_integer_sequence<int, 2 * quad>());
  }
  static_assert(quad == 4 && (count == 1 || count == 2 || count == 4));
  template <int x, int y, int z, int w, int... lane>
  static All shuffle(All v, std::integer_sequence<int, lane...>)
  {
    constexpr int from[quad] = {x, y, z, w};
    return __builtin_shufflevector(v, v, (lane / quad * quad + from[lane % quad])...);
  }
};

template <class Real> using V = typename Quads<Real>::All;

/// The quads of some particles, side by side.
template <int quads, class Real> V<Real> gather(const Real *v, const int *particle)
{
  return Quads<Real>::join(
      [&](int g) { return Quads<Real>::load_one(v + first<quads>(particle[g])); });
}

/// One number per particle, in all four of its lanes.
template <class Real> V<Real> spread(const Real *p)
{
  using One = typename Quads<Real>::One;
  return Quads<Real>::join([p](int g) { return One{p[g], p[g], p[g], p[g]}; });
}

/// The sum x + y + z + w of each particle, in all four of its lanes.
template <class Real> V<Real> sum_lanes(V<Real> v)
{
  v += Quads<Real>::template shuffle<1, 0, 3, 2>(v);
  return v + Quads<Real>::template shuffle<2, 3, 0, 1>(v);
}

/// The number w of each particle, in all four of its lanes.
template <class Real> V<Real> last_lane(V<Real> v)
{
  return Quads<Real>::template shuffle<3, 3, 3, 3>(v);
}

/// The cross product of each particle's vectors; the fourth lanes are 0.
template <class Real> V<Real> cross(V<Real> a, V<Real> b)
{
  const auto next = [](V<Real> v) { return Quads<Real>::template shuffle<1, 2, 0, 3>(v); };
  return next(a * next(b) - next(a) * b);
}

/// u of each particle += its quad of v, one after the other: a particle may occur twice.
template <int quads, class Real, int g = 0>
void scatter_add(Real *u, const int *particle, V<Real> v)
{
  Real *to = u + first<quads>(particle[g]);
  const auto sum = Quads<Real>::load_one(to) + Quads<Real>::template part<g>(v);
  put_lanes<Real, quad>(sum, to);
  if constexpr (g + 1 < Quads<Real>::count) scatter_add<quads, Real, g + 1>(u, particle, v);
}

}    // namespace

template <class Real> template <bool mutual>
void TranslationPairs<Real>::apply(const PairRange &range, const Real *v, Real *u) const
{
  static_assert(slots == quad && slots == dim + 1, "the last slot of a pair follows its direction");
  const Real *e_and_f = e_and_f_.data(), *difference = difference_.data();
  const int *other = other_.data();
  const int particle = range.particle, same[4] = {particle, particle, particle, particle};
  constexpr int together = Quads<Real>::count;
  static_assert(group % together == 0);
  const V<Real> own = gather<1>(v, same);
  V<Real> sum{};
  for (long k = range.first; k < range.end; k += together) {
    // The last lane of e holds f, and that of vectors 0: it drops out of the products with
    // vectors.
    const V<Real> e = Quads<Real>::load(e_and_f + slots * k), f = last_lane<Real>(e),
                  w = gather<1>(v, other + k);
    const V<Real> d_e = spread(difference + k) * e;
    sum += f * w + sum_lanes<Real>(e * w) * d_e;
    if (mutual) scatter_add<1, Real>(u, other + k, f * own + sum_lanes<Real>(e * own) * d_e);
  }
  Real *to = u + first<1>(particle);
  for (int g = 0; g < together; ++g)
    for (int c = 0; c < slots; ++c) to[c] += sum[slots * g + c];
}

template <class Real> template <bool mutual>
void SpinPairs<Real>::apply(const PairRange &range, const Real *v, Real *u) const
{
  static_assert(slots == 2 * quad, "force and torque have a quad each");
  constexpr int together = Quads<Real>::count;
  static_assert(group % together == 0);
  const int *other = other_.data();
  const int particle = range.particle, same[4] = {particle, particle, particle, particle};
  const V<Real> own_F = gather<2>(v, same), own_T = gather<2>(v + quad, same);
  V<Real> U{}, W{};
  for (long k = range.first; k < range.end; k += together) {
    const auto function = [this, k](int which) { return spread(function_[which].data() + k); };
    const V<Real> f = function(0), df = function(1), g = function(2), dg = function(3),
                  wi = function(4), uj = function(5);
    const V<Real> e = Quads<Real>::load(e_.data() + quad * k), F = gather<2>(v, other + k),
                  T = gather<2>(v + quad, other + k);
    U += f * F + df * sum_lanes<Real>(e * F) * e + uj * cross<Real>(e, T);
    W += g * T + dg * sum_lanes<Real>(e * T) * e + wi * cross<Real>(e, F);
    if constexpr (mutual) {
      scatter_add<2, Real>(u, other + k,
                           f * own_F + df * sum_lanes<Real>(e * own_F) * e -
                               wi * cross<Real>(e, own_T));
      scatter_add<2, Real>(u + quad, other + k,
                           g * own_T + dg * sum_lanes<Real>(e * own_T) * e -
                               uj * cross<Real>(e, own_F));
    }
  }
  Real *to = u + first<2>(particle);
  for (int p = 0; p < together; ++p)
    for (int c = 0; c < quad; ++c) {
      to[c] += U[quad * p + c];
      to[quad + c] += W[quad * p + c];
    }
}

template void TranslationPairs<float>::apply<true>(const PairRange &, const float *, float *) const;
template void TranslationPairs<float>::apply<false>(const PairRange &, const float *,
                                                    float *) const;
template void TranslationPairs<double>::apply<true>(const PairRange &, const double *,
                                                    double *) const;
template void TranslationPairs<double>::apply<false>(const PairRange &, const double *,
                                                     double *) const;
template void SpinPairs<float>::apply<true>(const PairRange &, const float *, float *) const;
template void SpinPairs<float>::apply<false>(const PairRange &, const float *, float *) const;
template void SpinPairs<double>::apply<true>(const PairRange &, const double *, double *) const;
template void SpinPairs<double>::apply<false>(const PairRange &, const double *, double *) const;

}    // namespace bdh
