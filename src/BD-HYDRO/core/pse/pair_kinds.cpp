// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
#include "pse/pair_kinds.h"

#include <cstring>

namespace bdh {

namespace {

/// Where the numbers of a particle begin; `quads`: of each particle.
template <int quads> long first(int particle) { return static_cast<long>(quads * quad) * particle; }

/// Particles side by side in one register, x, y, z, w each.
template <class Real> struct Wide {
  typedef Real V __attribute__((vector_size(64)));
  typedef Real Quad __attribute__((vector_size(quad * sizeof(Real))));
  static Quad load_quad(const Real *p)
  {
    Quad q;
    std::memcpy(&q, p, sizeof q);
    return q;
  }
  static void store(Real *p, Quad q) { std::memcpy(p, &q, sizeof q); }
  static V load(const Real *p)
  {
    V v;
    std::memcpy(&v, p, sizeof v);
    return v;
  }
};

template <class Real> using V = typename Wide<Real>::V;
template <class Real> using Quad = typename Wide<Real>::Quad;

/// The quads of the particles of a group, side by side.
template <int quads> V<float> gather(const float *v, const int *particle)
{
  const auto q = [&](int g) { return Wide<float>::load_quad(v + first<quads>(particle[g])); };
  const auto low = __builtin_shufflevector(q(0), q(1), 0, 1, 2, 3, 4, 5, 6, 7);
  const auto high = __builtin_shufflevector(q(2), q(3), 0, 1, 2, 3, 4, 5, 6, 7);
  return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
}
template <int quads> V<double> gather(const double *v, const int *particle)
{
  return __builtin_shufflevector(Wide<double>::load_quad(v + first<quads>(particle[0])),
                                 Wide<double>::load_quad(v + first<quads>(particle[1])), 0, 1, 2, 3,
                                 4, 5, 6, 7);
}

/// One number per particle of a group, in all four of its lanes.
inline V<float> spread(const float *p)
{
  const Quad<float> q = Wide<float>::load_quad(p);
  return __builtin_shufflevector(q, q, 0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3);
}
inline V<double> spread(const double *p)
{
  typedef double Two __attribute__((vector_size(16)));
  Two t;
  std::memcpy(&t, p, sizeof t);
  return __builtin_shufflevector(t, t, 0, 0, 0, 0, 1, 1, 1, 1);
}

/// The sum x + y + z + w of each particle, in all four of its lanes.
inline V<float> sum_lanes(V<float> v)
{
  v += __builtin_shufflevector(v, v, 1, 0, 3, 2, 5, 4, 7, 6, 9, 8, 11, 10, 13, 12, 15, 14);
  return v + __builtin_shufflevector(v, v, 2, 3, 0, 1, 6, 7, 4, 5, 10, 11, 8, 9, 14, 15, 12, 13);
}
inline V<double> sum_lanes(V<double> v)
{
  v += __builtin_shufflevector(v, v, 1, 0, 3, 2, 5, 4, 7, 6);
  return v + __builtin_shufflevector(v, v, 2, 3, 0, 1, 6, 7, 4, 5);
}

/// The number w of each particle, in all four of its lanes.
inline V<float> last_lane(V<float> v)
{
  return __builtin_shufflevector(v, v, 3, 3, 3, 3, 7, 7, 7, 7, 11, 11, 11, 11, 15, 15, 15, 15);
}
inline V<double> last_lane(V<double> v)
{
  return __builtin_shufflevector(v, v, 3, 3, 3, 3, 7, 7, 7, 7);
}

/// u of each particle += its quad of v, one after the other: a particle may occur twice.
template <int quads> void scatter_add(float *u, const int *particle, V<float> v)
{
  const Quad<float> q[4] = {
      __builtin_shufflevector(v, v, 0, 1, 2, 3), __builtin_shufflevector(v, v, 4, 5, 6, 7),
      __builtin_shufflevector(v, v, 8, 9, 10, 11), __builtin_shufflevector(v, v, 12, 13, 14, 15)};
  for (int g = 0; g < 4; ++g)
    Wide<float>::store(u + first<quads>(particle[g]),
                       Wide<float>::load_quad(u + first<quads>(particle[g])) + q[g]);
}
template <int quads> void scatter_add(double *u, const int *particle, V<double> v)
{
  const Quad<double> q[2] = {__builtin_shufflevector(v, v, 0, 1, 2, 3),
                             __builtin_shufflevector(v, v, 4, 5, 6, 7)};
  for (int g = 0; g < 2; ++g)
    Wide<double>::store(u + first<quads>(particle[g]),
                        Wide<double>::load_quad(u + first<quads>(particle[g])) + q[g]);
}

}    // namespace

template <class Real> template <bool mutual>
void TranslationPairs<Real>::apply(const PairRange &range, const Real *v, Real *u) const
{
  static_assert(slots == quad && slots == dim + 1, "the last slot of a pair follows its direction");
  const Real *e_and_f = e_and_f_.data(), *difference = difference_.data();
  const int *other = other_.data();
  const int particle = range.particle, same[4] = {particle, particle, particle, particle};
  const V<Real> own = gather<1>(v, same);
  V<Real> sum{};
  for (long k = range.first; k < range.end; k += group) {
    // The last lane of e holds f, and that of vectors 0: it drops out of the products with
    // vectors.
    const V<Real> e = Wide<Real>::load(e_and_f + slots * k), f = last_lane(e),
                  w = gather<1>(v, other + k);
    const V<Real> d_e = spread(difference + k) * e;
    sum += f * w + sum_lanes(e * w) * d_e;
    if (mutual) scatter_add<1>(u, other + k, f * own + sum_lanes(e * own) * d_e);
  }
  Real *to = u + first<1>(particle);
  for (int g = 0; g < group; ++g)
    for (int c = 0; c < slots; ++c) to[c] += sum[slots * g + c];
}

namespace {

/// The cross product of each particle's vectors; the fourth lanes are 0.
inline V<float> cross(V<float> a, V<float> b)
{
  const auto next = [](V<float> v) {
    return __builtin_shufflevector(v, v, 1, 2, 0, 3, 5, 6, 4, 7, 9, 10, 8, 11, 13, 14, 12, 15);
  };
  const auto last = [](V<float> v) {
    return __builtin_shufflevector(v, v, 2, 0, 1, 3, 6, 4, 5, 7, 10, 8, 9, 11, 14, 12, 13, 15);
  };
  return next(a) * last(b) - last(a) * next(b);
}
inline V<double> cross(V<double> a, V<double> b)
{
  const auto next = [](V<double> v) {
    return __builtin_shufflevector(v, v, 1, 2, 0, 3, 5, 6, 4, 7);
  };
  const auto last = [](V<double> v) {
    return __builtin_shufflevector(v, v, 2, 0, 1, 3, 6, 4, 5, 7);
  };
  return next(a) * last(b) - last(a) * next(b);
}

}    // namespace

template <class Real> template <bool mutual>
void SpinPairs<Real>::apply(const PairRange &range, const Real *v, Real *u) const
{
  static_assert(slots == 2 * quad, "force and torque have a quad each");
  const int *other = other_.data();
  const int particle = range.particle, same[4] = {particle, particle, particle, particle};
  const V<Real> own_F = gather<2>(v, same), own_T = gather<2>(v + quad, same);
  V<Real> U{}, W{};
  for (long k = range.first; k < range.end; k += group) {
    const auto function = [this, k](int which) { return spread(function_[which].data() + k); };
    const V<Real> f = function(0), df = function(1), g = function(2), dg = function(3),
                  wi = function(4), uj = function(5);
    const V<Real> e = Wide<Real>::load(e_.data() + quad * k), F = gather<2>(v, other + k),
                  T = gather<2>(v + quad, other + k);
    U += f * F + df * sum_lanes(e * F) * e + uj * cross(e, T);
    W += g * T + dg * sum_lanes(e * T) * e + wi * cross(e, F);
    if constexpr (mutual) {
      scatter_add<2>(u, other + k,
                     f * own_F + df * sum_lanes(e * own_F) * e - wi * cross(e, own_T));
      scatter_add<2>(u + quad, other + k,
                     g * own_T + dg * sum_lanes(e * own_T) * e - uj * cross(e, own_F));
    }
  }
  Real *to = u + first<2>(particle);
  for (int p = 0; p < group; ++p)
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
