// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
#include "pse/pair_kinds.h"

#include <cstring>

namespace bdh {

namespace {

/// Where the quad of a particle begins.
inline long first(int particle) { return static_cast<long>(quad) * particle; }

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
inline V<float> gather(const float *v, const int *particle)
{
  const auto q = [&](int g) { return Wide<float>::load_quad(v + first(particle[g])); };
  const auto low = __builtin_shufflevector(q(0), q(1), 0, 1, 2, 3, 4, 5, 6, 7);
  const auto high = __builtin_shufflevector(q(2), q(3), 0, 1, 2, 3, 4, 5, 6, 7);
  return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
}
inline V<double> gather(const double *v, const int *particle)
{
  return __builtin_shufflevector(Wide<double>::load_quad(v + first(particle[0])),
                                 Wide<double>::load_quad(v + first(particle[1])), 0, 1, 2, 3, 4, 5,
                                 6, 7);
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
inline void scatter_add(float *u, const int *particle, V<float> v)
{
  const Quad<float> q[4] = {
      __builtin_shufflevector(v, v, 0, 1, 2, 3), __builtin_shufflevector(v, v, 4, 5, 6, 7),
      __builtin_shufflevector(v, v, 8, 9, 10, 11), __builtin_shufflevector(v, v, 12, 13, 14, 15)};
  for (int g = 0; g < 4; ++g)
    Wide<float>::store(u + first(particle[g]),
                       Wide<float>::load_quad(u + first(particle[g])) + q[g]);
}
inline void scatter_add(double *u, const int *particle, V<double> v)
{
  const Quad<double> q[2] = {__builtin_shufflevector(v, v, 0, 1, 2, 3),
                             __builtin_shufflevector(v, v, 4, 5, 6, 7)};
  for (int g = 0; g < 2; ++g)
    Wide<double>::store(u + first(particle[g]),
                        Wide<double>::load_quad(u + first(particle[g])) + q[g]);
}

}    // namespace

template <class Real> template <bool mutual>
void TranslationPairs<Real>::apply(const PairRange &range, const Real *v, Real *u) const
{
  static_assert(slots == quad && slots == dim + 1, "the last slot of a pair follows its direction");
  const Real *e_and_f = e_and_f_.data(), *difference = difference_.data();
  const int *other = other_.data();
  const int particle = range.particle, same[4] = {particle, particle, particle, particle};
  const V<Real> own = gather(v, same);
  V<Real> sum{};
  for (long k = range.first; k < range.end; k += group) {
    // The last lane of e holds f, and that of vectors 0: it drops out of the products with
    // vectors.
    const V<Real> e = Wide<Real>::load(e_and_f + slots * k), f = last_lane(e),
                  w = gather(v, other + k);
    const V<Real> d_e = spread(difference + k) * e;
    sum += f * w + sum_lanes(e * w) * d_e;
    if (mutual) scatter_add(u, other + k, f * own + sum_lanes(e * own) * d_e);
  }
  Real *to = u + first(particle);
  for (int g = 0; g < group; ++g)
    for (int c = 0; c < slots; ++c) to[c] += sum[slots * g + c];
}

namespace {

/// Three numbers of a particle or a pair.
template <class Real> struct Three {
  Real x, y, z;
  static Three at(const Real *p) { return {p[0], p[1], p[2]}; }
  void add_to(Real *p) const
  {
    p[0] += x;
    p[1] += y;
    p[2] += z;
  }
  Real dot(const Three &o) const { return x * o.x + y * o.y + z * o.z; }
  Three cross(const Three &o) const
  {
    return {y * o.z - z * o.y, z * o.x - x * o.z, x * o.y - y * o.x};
  }
};
/// a u + b v + c w
template <class Real> Three<Real> sum(Real a, const Three<Real> &u, Real b, const Three<Real> &v,
                                      Real c, const Three<Real> &w)
{
  return {a * u.x + b * v.x + c * w.x, a * u.y + b * v.y + c * w.y, a * u.z + b * v.z + c * w.z};
}

}    // namespace

template <class Real> template <bool mutual>
void SpinPairs<Real>::apply(const PairRange &range, const Real *v, Real *u) const
{
  using Vector = Three<Real>;
  const auto place = [](int particle) { return static_cast<long>(slots) * particle; };
  const Real *own = v + place(range.particle);
  const Vector force = Vector::at(own), torque = Vector::at(own + 4);
  Vector U{}, W{};
  for (long k = range.first; k < range.end; ++k) {
    const Entry &pair = pairs_[k];
    const NearPair<Real> &m = pair.m;
    const Vector e = Vector::at(pair.e);
    const Real *there = v + place(other_[k]);
    const Vector F = Vector::at(there), T = Vector::at(there + 4);
    const Vector u_i = sum(m.f, F, m.df * e.dot(F), e, m.uj, e.cross(T)),
                 w_i = sum(m.g, T, m.dg * e.dot(T), e, m.wi, e.cross(F));
    U = {U.x + u_i.x, U.y + u_i.y, U.z + u_i.z};
    W = {W.x + w_i.x, W.y + w_i.y, W.z + w_i.z};
    if constexpr (mutual) {
      Real *to = u + place(other_[k]);
      sum(m.f, force, m.df * e.dot(force), e, -m.wi, e.cross(torque)).add_to(to);
      sum(m.g, torque, m.dg * e.dot(torque), e, -m.uj, e.cross(force)).add_to(to + 4);
    }
  }
  Real *to = u + place(range.particle);
  U.add_to(to);
  W.add_to(to + 4);
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
