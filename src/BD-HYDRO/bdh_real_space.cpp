#include "bdh_real_space.h"

#include "bdh_errors.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace bdh {

namespace {

/// x, y, z, 0 in one register.
template <class Real> struct Quad {
  typedef Real Lanes __attribute__((vector_size(4 * sizeof(Real))));
  static Lanes at(const Real *p)
  {
    Lanes v;
    std::memcpy(&v, p, sizeof v);
    return v;
  }
  static void store(Real *p, Lanes v) { std::memcpy(p, &v, sizeof v); }
};

}    // namespace

template <class Real>
RealSpace<Real>::RealSpace(double radius, double xi, double r_cut, double table_error) :
    table_(radius, xi, r_cut, std::max(table_error, RealSpaceTable<Real>::smallest_error())), cutoff2_(r_cut * r_cut),
    self_(static_cast<Real>(real_space_self(radius * xi)))
{
}

/// Adds the pair if it is within the cutoff and this row is the one to hold it.
template <class Real>
void RealSpace<Real>::consider(const NeighborView &list, int atom, int other, std::vector<Pair> &one_sided)
{
  const int p = list.particle[atom], q = list.particle[other];
  if (q < 0) return;
  // An image of a particle of this rank occurs in the lists of both, and so does an image of the particle itself.
  const bool image = other >= list.local_atoms, foreign = q >= owned_;
  if (image && !foreign && q < p) return;
  const double *x = list.x + 3L * atom, *y = list.x + 3L * other;
  const double d[3] = {x[0] - y[0], x[1] - y[1], x[2] - y[2]};
  const double r2 = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
  if (!(r2 <= cutoff2_)) {
    if (std::isfinite(r2)) return;
    throw BadParticle(std::isfinite(x[0] + x[1] + x[2]) && q < owned_ ? q : p, "its position is not a finite number");
  }
  const double r = std::sqrt(r2), inv_r = r2 > 0.0 ? 1.0 / r : 0.0;
  Pair pair;
  for (int c = 0; c < 3; ++c) pair.e[c] = static_cast<Real>(d[c] * inv_r);
  table_.evaluate(static_cast<Real>(r), pair.f, pair.difference);
  pair.other = q;
  if (foreign || p == q)
    one_sided.push_back(pair);
  else
    pairs_.push_back(pair);
}

template <class Real>
void RealSpace<Real>::collect_row(const NeighborView &list, int atom, std::vector<Pair> &one_sided)
{
  one_sided.clear();
  const int *neighbor = list.neighbors[atom];
  const int count = list.count[atom];
  for (int k = 0; k < count; ++k) consider(list, atom, neighbor[k] & list.mask, one_sided);
}

template <class Real> void RealSpace<Real>::bind(const NeighborView &list, long owned, long all)
{
  owned_ = owned;
  all_ = all;
  rows_.clear();
  pairs_.clear();
  std::vector<Pair> one_sided;
  for (long row = 0; row < list.rows; ++row) {
    const int atom = list.atom[row], p = list.particle[atom];
    if (p < 0) continue;
    collect_row(list, atom, one_sided);
    const long mutual = static_cast<long>(pairs_.size());
    pairs_.insert(pairs_.end(), one_sided.begin(), one_sided.end());
    rows_.push_back({p, mutual, static_cast<long>(pairs_.size())});
  }
  collect_extra(list);
}

template <class Real> void RealSpace<Real>::collect_extra(const NeighborView &list)
{
  if (!list.extra) return;
  std::vector<Pair> one_sided;
  for (const auto &e : *list.extra) {
    if (list.particle[e.first] < 0) continue;
    one_sided.clear();
    consider(list, e.first, e.second, one_sided);
    const long mutual = static_cast<long>(pairs_.size());
    pairs_.insert(pairs_.end(), one_sided.begin(), one_sided.end());
    rows_.push_back({list.particle[e.first], mutual, static_cast<long>(pairs_.size())});
  }
}

template <class Real>
void RealSpace<Real>::apply_row(const Row &row, long first, const Real *v, Real *u) const
{
  using Q = Quad<Real>;
  const auto own = Q::at(v + 4L * row.particle);
  auto sum = Q::at(u + 4L * row.particle);
  for (long k = first; k < row.end; ++k) {
    const Pair &pair = pairs_[k];
    const typename Q::Lanes e = {pair.e[0], pair.e[1], pair.e[2], Real(0)};
    const Real *other = v + 4L * pair.other;
    const Real along = pair.difference * (pair.e[0] * other[0] + pair.e[1] * other[1] + pair.e[2] * other[2]);
    sum += pair.f * Q::at(other) + along * e;
    if (k < row.mutual) {
      const Real back = pair.difference * (pair.e[0] * own[0] + pair.e[1] * own[1] + pair.e[2] * own[2]);
      Real *to = u + 4L * pair.other;
      Q::store(to, Q::at(to) + pair.f * own + back * e);
    }
  }
  Q::store(u + 4L * row.particle, sum);
}

template <class Real> void RealSpace<Real>::apply(const Vector &v, Vector &u) const
{
  u.resize(static_cast<std::size_t>(4 * owned_));
  for (long i = 0; i < 4 * owned_; ++i) u[i] = self_ * v[i];
  long first = 0;
  for (const Row &row : rows_) {
    apply_row(row, first, v.data(), u.data());
    first = row.end;
  }
}

template <class Real>
void RealSpace<Real>::bind_and_apply(const NeighborView &list, long owned, long all, const Vector &v, Vector &u)
{
  owned_ = owned;
  all_ = all;
  u.resize(static_cast<std::size_t>(4 * owned_));
  for (long i = 0; i < 4 * owned_; ++i) u[i] = self_ * v[i];
  std::vector<Pair> one_sided;
  const auto use = [&](int particle) {
    const long mutual = static_cast<long>(pairs_.size());
    pairs_.insert(pairs_.end(), one_sided.begin(), one_sided.end());
    apply_row({particle, mutual, static_cast<long>(pairs_.size())}, 0, v.data(), u.data());
    pairs_.clear();
  };
  rows_.clear();
  pairs_.clear();
  for (long row = 0; row < list.rows; ++row) {
    const int atom = list.atom[row];
    if (list.particle[atom] < 0) continue;
    collect_row(list, atom, one_sided);
    use(list.particle[atom]);
  }
  if (!list.extra) return;
  for (const auto &e : *list.extra) {
    if (list.particle[e.first] < 0) continue;
    one_sided.clear();
    consider(list, e.first, e.second, one_sided);
    use(list.particle[e.first]);
  }
}

template <class Real> double RealSpace<Real>::pairs() const
{
  double count = 0.0;
  long first = 0;
  for (const Row &row : rows_) {
    count += static_cast<double>(row.mutual - first) + 0.5 * static_cast<double>(row.end - row.mutual);
    first = row.end;
  }
  return count;
}

template <class Real> std::size_t RealSpace<Real>::memory() const
{
  return table_.memory() + rows_.capacity() * sizeof(Row) + pairs_.capacity() * sizeof(Pair);
}

template class RealSpace<float>;
template class RealSpace<double>;

}    // namespace bdh
