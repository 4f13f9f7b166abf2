#include "bdh_real_space.h"

#include "bdh_errors.h"
#include "bdh_portable.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace bdh {

namespace {

/// Particles side by side in one register, x, y, z, w each.
template <class Real> struct Wide {
  typedef Real V __attribute__((vector_size(64)));
  typedef Real Quad __attribute__((vector_size(4 * sizeof(Real))));
  static Quad quad(const Real *p)
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
  const auto q = [&](int g) { return Wide<float>::quad(v + 4L * particle[g]); };
  const auto low = __builtin_shufflevector(q(0), q(1), 0, 1, 2, 3, 4, 5, 6, 7);
  const auto high = __builtin_shufflevector(q(2), q(3), 0, 1, 2, 3, 4, 5, 6, 7);
  return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
}
inline V<double> gather(const double *v, const int *particle)
{
  return __builtin_shufflevector(Wide<double>::quad(v + 4L * particle[0]), Wide<double>::quad(v + 4L * particle[1]), 0, 1,
                                 2, 3, 4, 5, 6, 7);
}

/// One number per particle of a group, in all four of its lanes.
inline V<float> spread(const float *p)
{
  const Quad<float> q = Wide<float>::quad(p);
  return __builtin_shufflevector(q, q, 0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3);
}
inline V<double> spread(const double *p)
{
  typedef double Two __attribute__((vector_size(16)));
  Two t;
  std::memcpy(&t, p, sizeof t);
  return __builtin_shufflevector(t, t, 0, 0, 0, 0, 1, 1, 1, 1);
}

/// x + y + z + w of each particle, in all four of its lanes.
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

/// w of each particle, in all four of its lanes.
inline V<float> last_lane(V<float> v)
{
  return __builtin_shufflevector(v, v, 3, 3, 3, 3, 7, 7, 7, 7, 11, 11, 11, 11, 15, 15, 15, 15);
}
inline V<double> last_lane(V<double> v) { return __builtin_shufflevector(v, v, 3, 3, 3, 3, 7, 7, 7, 7); }

/// u of each particle += its quad of v, one after the other: a particle may occur twice.
inline void scatter_add(float *u, const int *particle, V<float> v)
{
  const Quad<float> q[4] = {__builtin_shufflevector(v, v, 0, 1, 2, 3), __builtin_shufflevector(v, v, 4, 5, 6, 7),
                            __builtin_shufflevector(v, v, 8, 9, 10, 11), __builtin_shufflevector(v, v, 12, 13, 14, 15)};
  for (int g = 0; g < 4; ++g) Wide<float>::store(u + 4L * particle[g], Wide<float>::quad(u + 4L * particle[g]) + q[g]);
}
inline void scatter_add(double *u, const int *particle, V<double> v)
{
  const Quad<double> q[2] = {__builtin_shufflevector(v, v, 0, 1, 2, 3), __builtin_shufflevector(v, v, 4, 5, 6, 7)};
  for (int g = 0; g < 2; ++g) Wide<double>::store(u + 4L * particle[g], Wide<double>::quad(u + 4L * particle[g]) + q[g]);
}

}    // namespace

template <class Real>
RealSpace<Real>::RealSpace(double radius, double xi, double r_cut, double table_error) :
    table_(radius, xi, r_cut, std::max(table_error, RealSpaceTable<Real>::smallest_error())), cutoff2_(r_cut * r_cut),
    self_(static_cast<Real>(real_space_self(radius * xi)))
{
}

/// Makes room for some more pairs, and to complete their group.
template <class Real> void RealSpace<Real>::Pairs::reserve(long more)
{
  const std::size_t needed = static_cast<std::size_t>(count + more + group);
  if (other.size() >= needed) return;
  const std::size_t size = needed + needed / 4;
  e_and_f.resize(4 * size);
  difference.resize(size);
  other.resize(size);
}

template <class Real> void RealSpace<Real>::Pairs::fill_group(int particle)
{
  const Real zero[3] = {0, 0, 0};
  while (count % group) add(zero, Real(0), Real(0), particle);
}

template <class Real> void RealSpace<Real>::Candidates::resize(std::size_t n)
{
  if (other.size() >= n) return;
  other.resize(n);
  r2.resize(n);
  for (auto &component : d) component.resize(n);
}

/// candidates_ := neighbours within the cutoff whose pair this atom's row holds.  Returns their number.
template <class Real>
long RealSpace<Real>::collect(const NeighborView &list, int atom, const int *neighbors, int count)
{
  candidates_.resize(static_cast<std::size_t>(count));
  double *dx = candidates_.d[0].data(), *dy = candidates_.d[1].data(), *dz = candidates_.d[2].data(), *r2 = candidates_.r2.data();
  const double *x = list.x + 3L * atom;
  const double x0 = x[0], x1 = x[1], x2 = x[2];
  const int mask = list.mask;
  const double *all = list.x;
  BDH_INDEPENDENT
  for (int k = 0; k < count; ++k) {
    const double *y = all + 3L * (neighbors[k] & mask);
    dx[k] = x0 - y[0];
    dy[k] = x1 - y[1];
    dz[k] = x2 - y[2];
    r2[k] = dx[k] * dx[k] + dy[k] * dy[k] + dz[k] * dz[k];
  }
  const int p = list.particle[atom], owned = static_cast<int>(owned_);
  long kept = 0;
  double sum = 0.0;
  for (int k = 0; k < count; ++k) {
    const int j = neighbors[k] & mask, q = list.particle[j];
    // An image of a particle of this rank occurs in the lists of both; the smaller number has the pair.
    const bool twice = j >= list.local_atoms && q < owned && q < p;
    candidates_.other[kept] = q;
    dx[kept] = dx[k];
    dy[kept] = dy[k];
    dz[kept] = dz[k];
    sum += r2[k];
    const double square = r2[k];
    r2[kept] = square;
    kept += (square <= cutoff2_) & (q >= 0) & !twice;
  }
  if (!std::isfinite(sum)) throw BadParticle(p, "its position, or that of a neighbor, is not a finite number");
  return kept;
}

/// Adds pairs of the candidates to pairs_, and those that act on one particle only to one_sided_.
template <class Real> void RealSpace<Real>::tabulate(int particle, long candidates)
{
  double *dx = candidates_.d[0].data(), *dy = candidates_.d[1].data(), *dz = candidates_.d[2].data(), *r = candidates_.r2.data();
  BDH_INDEPENDENT
  for (long k = 0; k < candidates; ++k) {
    const double length = std::sqrt(r[k]), inverse = length > 0.0 ? 1.0 / length : 0.0;
    r[k] = length;
    dx[k] *= inverse;
    dy[k] *= inverse;
    dz[k] *= inverse;
  }
  pairs_.reserve(candidates);
  one_sided_.reserve(candidates);
  for (long k = 0; k < candidates; ++k) {
    const Real e[3] = {static_cast<Real>(dx[k]), static_cast<Real>(dy[k]), static_cast<Real>(dz[k])};
    Real f, difference;
    table_.evaluate(static_cast<Real>(r[k]), f, difference);
    const int q = candidates_.other[k];
    // An image of the particle itself is listed once for either side.
    const bool mutual = q < owned_ && q != particle;
    (mutual ? pairs_ : one_sided_).add(e, f, difference, q);
    count_ += mutual ? 1.0 : 0.5;
  }
}

/// Completes the groups of a row whose pairs are in pairs_ and one_sided_.
template <class Real> typename RealSpace<Real>::Row RealSpace<Real>::close_row(int particle)
{
  pairs_.fill_group(particle);
  const long mutual = pairs_.count;
  if (one_sided_.count) {
    pairs_.reserve(one_sided_.count + group);
    for (long k = 0; k < one_sided_.count; ++k)
      pairs_.add(&one_sided_.e_and_f[4 * k], one_sided_.e_and_f[4 * k + 3], one_sided_.difference[k], one_sided_.other[k]);
    one_sided_.clear();
    pairs_.fill_group(particle);
  }
  return {particle, mutual, pairs_.count};
}

/// Calls use(row) for every row, its pairs being the last ones of pairs_.
template <class Real> template <class Use> void RealSpace<Real>::for_rows(const NeighborView &list, Use use)
{
  rows_.clear();
  pairs_.clear();
  one_sided_.clear();
  count_ = 0.0;
  const auto one = [&](int atom, const int *neighbors, int count) {
    const int particle = list.particle[atom];
    if (particle < 0) return;
    tabulate(particle, collect(list, atom, neighbors, count));
    use(close_row(particle));
  };
  for (long row = 0; row < list.rows; ++row) one(list.atom[row], list.neighbors[list.atom[row]], list.count[list.atom[row]]);
  if (list.extra)
    for (const auto &e : *list.extra) one(e.first, &e.second, 1);
}

template <class Real> void RealSpace<Real>::bind(const NeighborView &list, long owned, long all)
{
  owned_ = owned;
  all_ = all;
  for_rows(list, [this](const Row &row) { rows_.push_back(row); });
}

template <class Real>
template <bool mutual>
void RealSpace<Real>::apply_pairs(int particle, long first, long end, const Real *v, Real *u) const
{
  const Real *e_and_f = pairs_.e_and_f.data(), *difference = pairs_.difference.data();
  const int *other = pairs_.other.data();
  const int same[4] = {particle, particle, particle, particle};
  const V<Real> own = gather(v, same);
  V<Real> sum{};
  for (long k = first; k < end; k += group) {
    // The fourth lane of e holds f, and that of vectors 0: it drops out of the products with vectors.
    const V<Real> e = Wide<Real>::load(e_and_f + 4 * k), f = last_lane(e), w = gather(v, other + k);
    const V<Real> d_e = spread(difference + k) * e;
    sum += f * w + sum_lanes(e * w) * d_e;
    if (mutual) scatter_add(u, other + k, f * own + sum_lanes(e * own) * d_e);
  }
  Real *to = u + 4L * particle;
  for (int g = 0; g < group; ++g)
    for (int c = 0; c < 4; ++c) to[c] += sum[4 * g + c];
}

template <class Real> void RealSpace<Real>::apply_row(const Row &row, long first, const Real *v, Real *u) const
{
  apply_pairs<true>(row.particle, first, row.mutual, v, u);
  if (row.end > row.mutual) apply_pairs<false>(row.particle, row.mutual, row.end, v, u);
}

template <class Real> void RealSpace<Real>::start(const Vector &v, Vector &u) const
{
  u.resize(static_cast<std::size_t>(4 * owned_));
  for (long i = 0; i < 4 * owned_; ++i) u[i] = self_ * v[i];
}

template <class Real> void RealSpace<Real>::apply(const Vector &v, Vector &u) const
{
  start(v, u);
  long first = 0;
  for (const Row &row : rows_) {
    apply_row(row, first, v.data(), u.data());
    first = row.end;
  }
  for (long i = 0; i < owned_; ++i) u[4 * i + 3] = Real(0);
}

template <class Real>
void RealSpace<Real>::bind_and_apply(const NeighborView &list, long owned, long all, const Vector &v, Vector &u)
{
  owned_ = owned;
  all_ = all;
  start(v, u);
  for_rows(list, [&](const Row &row) {
    apply_row(row, 0, v.data(), u.data());
    pairs_.clear();
  });
  for (long i = 0; i < owned_; ++i) u[4 * i + 3] = Real(0);
}

template <class Real> std::size_t RealSpace<Real>::memory() const
{
  return table_.memory() + rows_.capacity() * sizeof(Row) +
      (pairs_.e_and_f.capacity() + pairs_.difference.capacity()) * sizeof(Real) + pairs_.other.capacity() * sizeof(int);
}

template class RealSpace<float>;
template class RealSpace<double>;

}    // namespace bdh
