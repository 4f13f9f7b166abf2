// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
#include "pse/real_space.h"

#include "base/bytes_of.h"
#include "base/errors.h"
#include "base/portable.h"
#include "base/ssize.h"

#include <algorithm>
#include <cmath>

namespace bdh {

namespace {

/// Position of an atom among those of a list.
inline const double *position(const double *x, int atom) { return x + first_coordinate(atom); }

}    // namespace

template <class Real, class Kind>
RealSpace<Real, Kind>::RealSpace(const PsePlan &plan, const Workers &workers) :
    workers_(workers), kind_(plan), blocks_(workers.count())
{}

template <class Real, class Kind> void RealSpace<Real, Kind>::Candidates::resize(std::size_t n)
{
  if (other.size() >= n) return;
  other.resize(n);
  separation.resize(quad * n);
  r.resize(n);
  inverse.resize(n);
}

/// block_of_ := layers with equal numbers of particles.  They lie across z, unless the particles
/// extend much further along another axis: LAMMPS stores atoms sorted with z slowest, and layers
/// across x would share each cache line between blocks.
template <class Real, class Kind> void RealSpace<Real, Kind>::divide(const NeighborView &list)
{
  if (blocks_.size() == 1) return;
  constexpr int bins = 4096;
  double lo[dim], hi[dim];
  std::fill_n(lo, dim, HUGE_VAL);
  std::fill_n(hi, dim, -HUGE_VAL);
  for (int i = 0; i < list.local_atoms; ++i)
    for (int d = 0; d < dim; ++d) {
      lo[d] = std::min(lo[d], position(list.x, i)[d]);
      hi[d] = std::max(hi[d], position(list.x, i)[d]);
    }
  int axis = dim - 1;
  for (int d = axis - 1; d >= 0; --d)
    if (hi[d] - lo[d] > 2.0 * (hi[axis] - lo[axis])) axis = d;
  const auto bin = [&](int i) {
    const double place = bins * (position(list.x, i)[axis] - lo[axis]) / (hi[axis] - lo[axis]);
    // Zero also for what is not a number.
    return place >= 1.0 ? static_cast<int>(std::min(place, bins - 1.0)) : 0;
  };
  std::vector<long> before(bins + 1, 0);
  for (int i = 0; i < list.local_atoms; ++i) ++before[bin(i) + 1];
  for (std::size_t b = 0; b < bins; ++b) before[b + 1] += before[b];
  block_of_.assign(owned_, 0);
  const long blocks = ssize(blocks_);
  for (int i = 0; i < list.local_atoms; ++i)
    if (list.particle[i] >= 0)
      block_of_[list.particle[i]] = before[bin(i)] * blocks / list.local_atoms;
}

/// found := neighbours within reach whose pair this atom's row holds.  Returns their number.
template <class Real, class Kind>
long RealSpace<Real, Kind>::collect(const NeighborView &list, int atom, const int *neighbors,
                                    int count, Candidates &found) const
{
  found.resize(count);
  int *const other = found.other.data();
  double *const separation = found.separation.data(), *const r = found.r.data(),
                *const inverse = found.inverse.data();
  using Coordinates = LanesOf<double, quad>;
  const double *const x = position(list.x, atom), *const all = list.x;
  const Coordinates here{x[0], x[1], x[2], 0.0};
  const int mask = list.mask, local = list.local_atoms, owned = owned_, p = list.particle[atom];
  const int *const particle = list.particle;
  long kept = 0;
  double sum = 0.0;
  for (int k = 0; k < count; ++k) {
    const int j = neighbors[k] & mask, q = particle[j];
    const double *const y = position(all, j);
    const Coordinates d = here - Coordinates{y[0], y[1], y[2], 0.0};
    const double r2 = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
    // All are written, and stay if they are pairs.  An image of a particle of this rank occurs in
    // the lists of both; the smaller number has the pair.
    const bool twice = (j >= local) & (q < owned) & (q < p);
    other[kept] = q;
    put_lanes<double, quad>(d, separation + quad * kept);
    r[kept] = r2;
    sum += r2;
    kept += kind_.reaches(q, p, r2) & (q >= 0) & !twice;
  }
  if (!std::isfinite(sum))
    throw BadParticle(p, "its position, or that of a neighbor, is not a finite number");
  BDH_INDEPENDENT
  for (long k = 0; k < kept; ++k) {
    const double length = std::sqrt(r[k]);
    r[k] = length;
    inverse[k] = length > 0.0 ? 1.0 / length : 0.0;
  }
  return kept;
}

/// Adds pairs of the candidates to those of the block that act on both particles, or to those that
/// act on this one only.
template <class Real, class Kind>
void RealSpace<Real, Kind>::tabulate(int particle, long candidates, Block &block) const
{
  const Candidates &found = block.candidates;
  const double *const separation = found.separation.data(), *const r = found.r.data(),
                      *const inverse = found.inverse.data();
  const int *const other = found.other.data();
  block.pairs.reserve(candidates);
  block.one_sided.reserve(candidates);
  long shared = 0;
  for (long k = 0; k < candidates; ++k) {
    const Direction e = __builtin_convertvector(
        inverse[k] * lanes_at<double, quad>(separation + quad * k), Direction);
    const int q = other[k];
    const typename Kind::Entry pair = kind_.entry(e, r[k], particle, q);
    // An image of the particle itself is listed once for either side.
    const bool both = q < owned_ && q != particle, mutual = both && is_in(block, q);
    shared += both;
    if (mutual) {
      block.pairs.add(pair, q);
      continue;
    }
    block.one_sided.add(pair, q);
    if (both) block.shared[block_of_[q]].push_back({q, particle, kind_.reversed(pair)});
  }
  block.count += 0.5 * (candidates + shared);
}

/// Completes the groups of a row whose pairs are the last ones of the block.
template <class Real, class Kind>
typename RealSpace<Real, Kind>::Row RealSpace<Real, Kind>::close_row(int particle, Block &block)
{
  Pairs &pairs = block.pairs, &one_sided = block.one_sided;
  pairs.fill_group(particle);
  const long mutual = pairs.count();
  if (one_sided.count()) {
    pairs.reserve(one_sided.count() + Pairs::group);
    for (long k = 0; k < one_sided.count(); ++k) pairs.add(one_sided.entry(k), one_sided.other(k));
    one_sided.clear();
    pairs.fill_group(particle);
  }
  return {particle, mutual, pairs.count()};
}

/// Calls use(row) for every row of a block, its pairs being the last ones there.
template <class Real, class Kind> template <class Use>
void RealSpace<Real, Kind>::for_rows(const NeighborView &list, Block &block, Use use)
{
  block.rows.clear();
  block.pairs.clear();
  block.one_sided.clear();
  block.shared.resize(blocks_.size());
  for (auto &pairs : block.shared) pairs.clear();
  block.count = 0.0;
  const auto one = [&](int atom, const int *neighbors, int count) {
    const int particle = list.particle[atom];
    if (particle < 0 || !is_in(block, particle)) return;
    tabulate(particle, collect(list, atom, neighbors, count, block.candidates), block);
    use(close_row(particle, block));
  };
  for (long row = 0; row < list.rows; ++row)
    one(list.atom[row], list.neighbors[list.atom[row]], list.count[list.atom[row]]);
  if (list.extra)
    for (const auto &e : *list.extra) one(e.first, &e.second, 1);
}

/// Adds rows for the pairs that other blocks have found with particles of block b.
template <class Real, class Kind> void RealSpace<Real, Kind>::adopt(std::size_t b)
{
  Block &block = blocks_[b];
  int lowest = owned_, highest = -1;
  for (const Block &from : blocks_)
    for (const Shared &pair : from.shared[b]) {
      lowest = std::min(lowest, pair.particle);
      highest = std::max(highest, pair.particle);
    }
  if (highest < 0) return;
  // They are sorted by particle, by counting.  place[k] is where the next pair of particle lowest +
  // k goes, and finally the end of its pairs.
  std::vector<long> &place = block.place;
  place.assign((highest - lowest) + 2, 0);
  for (const Block &from : blocks_)
    for (const Shared &pair : from.shared[b]) ++place[(pair.particle - lowest) + 1];
  for (std::size_t k = 1; k < place.size(); ++k) place[k] += place[k - 1];
  const long found = place.back();
  block.found.resize(found);
  for (const Block &from : blocks_)
    for (const Shared &pair : from.shared[b]) block.found[place[pair.particle - lowest]++] = &pair;

  block.pairs.reserve(Pairs::group * found);
  for (long k = 0; k < found;) {
    const int particle = block.found[k]->particle;
    const long first = block.pairs.count(), end = place[particle - lowest];
    for (; k < end; ++k) {
      const Shared &pair = *block.found[k];
      block.pairs.add(pair.entry, pair.other);
    }
    block.pairs.fill_group(particle);
    block.rows.push_back({particle, first, block.pairs.count()});
  }
}

template <class Real, class Kind> void RealSpace<Real, Kind>::bind(const Particles &particles)
{
  const NeighborView &list = particles.neighbors;
  owned_ = particles.count;
  all_ = particles.with_ghosts;
  kind_.bind(particles);
  divide(list);
  const long blocks = ssize(blocks_);
  workers_.run(blocks, [&](long b, int) {
    Block &block = blocks_[b];
    for_rows(list, block, [&block](const Row &row) { block.rows.push_back(row); });
  });
  if (blocks > 1) workers_.run(blocks, [&](long b, int) { adopt(b); });
}

template <class Real, class Kind> template <bool strains>
void RealSpace<Real, Kind>::apply_row(const Pairs &pairs, const Row &row, long first, const Real *v,
                                      Real *u)
{
  const PairRange both{row.particle, first, row.mutual}, one{row.particle, row.mutual, row.end};
  if constexpr (strains) {
    pairs.template apply_strains<true>(both, v, u);
    if (row.end > row.mutual) pairs.template apply_strains<false>(one, v, u);
  } else {
    pairs.template apply<true>(both, v, u);
    if (row.end > row.mutual) pairs.template apply<false>(one, v, u);
  }
}

template <class Real, class Kind>
void RealSpace<Real, Kind>::start(const Vector &v, Vector &u) const
{
  u.resize(slots * owned_);
  const Real *from = v.data();
  Real *to = u.data();
  workers_.for_ranges(owned_, [=](long begin, long end) { kind_.start(begin, end, from, to); });
}

template <class Real, class Kind> void RealSpace<Real, Kind>::finish(Vector &u) const
{
  if constexpr (!Pairs::in_quads) return;
  Real *to = u.data();
  workers_.for_ranges(owned_, [to](long begin, long end) {
    for (long i = begin; i < end; ++i)
      for (int c = dim; c < slots; c += quad) to[slots * i + c] = Real(0);
  });
}

template <class Real, class Kind> template <bool strains>
void RealSpace<Real, Kind>::apply_rows(const Vector &v, Vector &u) const
{
  start(v, u);
  workers_.run(ssize(blocks_), [&](long b, int) {
    const Block &block = blocks_[b];
    long first = 0;
    for (const Row &row : block.rows) {
      apply_row<strains>(block.pairs, row, first, v.data(), u.data());
      first = row.end;
    }
  });
  finish(u);
}

template <class Real, class Kind>
void RealSpace<Real, Kind>::apply(const Vector &v, Vector &u) const
{
  apply_rows<false>(v, u);
}

template <class Real, class Kind>
void RealSpace<Real, Kind>::apply_strains(const Vector &v, Vector &u) const
{
  apply_rows<Kind::have_strains>(v, u);
}

template <class Real, class Kind>
void RealSpace<Real, Kind>::bind_and_apply(const Particles &particles, const Vector &v, Vector &u)
{
  if (blocks_.size() > 1) {
    bind(particles);
    return apply(v, u);
  }
  owned_ = particles.count;
  all_ = particles.with_ghosts;
  kind_.bind(particles);
  start(v, u);
  Block &block = blocks_[0];
  for_rows(particles.neighbors, block, [&](const Row &row) {
    apply_row<false>(block.pairs, row, 0, v.data(), u.data());
    block.pairs.clear();
  });
  finish(u);
}

template <class Real, class Kind> double RealSpace<Real, Kind>::pairs() const
{
  double sum = 0.0;
  for (const Block &b : blocks_) sum += b.count;
  return sum;
}

template <class Real, class Kind> std::size_t RealSpace<Real, Kind>::memory() const
{
  std::size_t bytes = kind_.memory() + bytes_of(block_of_);
  for (const Block &b : blocks_)
    bytes += bytes_of(b.rows, b.found, b.place, b.shared) + b.pairs.memory();
  return bytes;
}

template class RealSpace<float, EqualSpheres<float>>;
template class RealSpace<double, EqualSpheres<double>>;
template class RealSpace<float, SizedSpheres<float, Moments::none>>;
template class RealSpace<double, SizedSpheres<double, Moments::none>>;
template class RealSpace<float, SizedSpheres<float, Moments::torque>>;
template class RealSpace<double, SizedSpheres<double, Moments::torque>>;
template class RealSpace<float, StrainingSpheres<float>>;
template class RealSpace<double, StrainingSpheres<double>>;

}    // namespace bdh
