// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// The real-space part of positively split Ewald on a device: M_r v over the pairs within r_cut.
/// See PSE (10), App. A.
#ifndef BDH_PSE_REAL_SPACE_KOKKOS_H
#define BDH_PSE_REAL_SPACE_KOKKOS_H

#include "base/bytes_of.h"
#include "base/device_kokkos.h"
#include "pse/particles.h"
#include "pse/plan.h"
#include "pse/rpy.h"

#include <algorithm>
#include <cmath>

namespace bdh {

/// A full neighbor list as the KOKKOS package lays it out: the row of each atom of this process
/// contains all its neighbors, including periodic images.  Pointers are device pointers.
struct DeviceNeighbors {
  long rows = 0;
  const int *atom = nullptr;     ///< of each row
  const int *count = nullptr;    ///< by atom
  /// Neighbor k of atom i is at [i * atom_stride + k * neighbor_stride].
  const int *neighbors = nullptr;
  long atom_stride = 0, neighbor_stride = 0;
  int mask = -1;                ///< bits of an entry that give the neighbor
  int most = 0;                 ///< largest count
  const double *x = nullptr;    ///< by atom, dim each; ghosts at their own positions
  /// The particle that an atom is, or is an image of; those of other ranks follow this rank's; -1
  /// for none.
  const int *particle = nullptr;
  /// Further entries of the rows, which the list omits: those of particle p are extra_begin[p] ..
  /// extra_begin[p + 1] - 1.
  const int *extra_begin = nullptr, *extra = nullptr;
  int most_extra = 0;
};

/// Pairs by particle: entry k of particle p is at [k * pair_stride + p * particle_stride].  On a
/// GPU neighbouring threads, which have neighbouring particles, read adjacent entries; on the host
/// the entries of a particle are contiguous.
template <class Real> struct DevicePairs {
  long pair_stride, particle_stride;
  int *count;    ///< by particle
  int *other;
  Real *e_and_f, *difference;    ///< slots and 1 each: blocks f I + difference e e^T
  BDH_FN long place(long p, int k) const { return k * pair_stride + p * particle_stride; }
};

/// Pairs := those of the row within the cutoff.  The index is that of a row.
template <class Real> struct FindPairs {
  DeviceNeighbors list;
  RealSpacePolynomials<Real> table;
  double cutoff2;
  DevicePairs<Real> pairs;

  BDH_FN void add(long p, int atom, int other, int &count) const
  {
    const int q = list.particle[other];
    if (q < 0) return;
    const double *x = list.x + first_coordinate(atom), *y = list.x + first_coordinate(other);
    const double d[dim] = {x[0] - y[0], x[1] - y[1], x[2] - y[2]},
                 r2 = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
    if (!(r2 <= cutoff2)) return;
    const double r = std::sqrt(r2), inverse = r > 0.0 ? 1.0 / r : 0.0;
    const long at = pairs.place(p, count++);
    Real f, difference;
    table.evaluate(r, f, difference);
    for (int c = 0; c < dim; ++c) pairs.e_and_f[slots * at + c] = d[c] * inverse;
    pairs.e_and_f[slots * at + slots - 1] = f;
    pairs.difference[at] = difference;
    pairs.other[at] = q;
  }

  BDH_FN void operator()(long row) const
  {
    const int atom = list.atom[row], p = list.particle[atom];
    if (p < 0) return;
    int count = 0;
    for (int k = 0; k < list.count[atom]; ++k)
      add(p, atom, list.neighbors[atom * list.atom_stride + k * list.neighbor_stride] & list.mask,
          count);
    if (list.extra_begin)
      for (int k = list.extra_begin[p]; k < list.extra_begin[p + 1]; ++k)
        add(p, atom, list.extra[k], count);
    pairs.count[p] = count;
  }
};

/// u := M_r v, with `slots` entries per particle.  The index is that of a particle.
template <class Real> struct ApplyPairs {
  DevicePairs<Real> pairs;
  Real self;
  const Real *v;
  Real *u;
  BDH_FN void operator()(long p) const
  {
    static_assert(dof == dim, "the blocks of pairs act on translations only");
    Real sum[dof];
    for (int c = 0; c < dof; ++c) sum[c] = self * v[slots * p + c];
    for (int k = 0; k < pairs.count[p]; ++k) {
      const long at = pairs.place(p, k);
      const Real *e = pairs.e_and_f + slots * at, *w = v + first_slot(pairs.other[at]);
      const Real f = e[slots - 1],
                 along = pairs.difference[at] * (e[0] * w[0] + e[1] * w[1] + e[2] * w[2]);
      for (int c = 0; c < dof; ++c) sum[c] += f * w[c] + along * e[c];
    }
    for (int c = 0; c < dof; ++c) u[slots * p + c] = sum[c];
    for (int c = dof; c < slots; ++c) u[slots * p + c] = Real(0);
  }
};

struct SumCounts {
  const int *count;
  BDH_FN void operator()(long p, double &sum) const { sum += count[p]; }
};

/// The counterpart of RealSpace, in units of 1/(6 pi viscosity a).
template <class Real, class Exec> class DeviceRealSpace {
 public:
  using Vector = DeviceArray<Real, Exec>;
  using Particles = PseParticles<DeviceNeighbors>;

  static constexpr int slots = quad;

  explicit DeviceRealSpace(const PsePlan &plan) :
      cutoff2_(plan.r_cut * plan.r_cut), self_(plan.real_space_part().self())
  {
    const RealSpaceTable<Real> table(
        plan.real_space_part(), plan.r_cut,
        std::max(plan.table_error, RealSpaceTable<Real>::smallest_error()));
    table_ = table.polynomials();
    coefficients_.assign(table_.coefficients, table.coefficient_count());
    table_.coefficients = coefficients_.data();
  }

  /// Finds the pairs within r_cut in the particles' list.  Positions must be finite.
  void bind(const Particles &particles)
  {
    const DeviceNeighbors &list = particles.neighbors;
    particles_ = particles.count;
    all_ = particles.with_ghosts;
    const long n = particles_, most = list.most + list.most_extra;
    count_.resize(n);
    count_.clear_values();
    other_.resize(n * most);
    e_and_f_.resize(slots * n * most);
    difference_.resize(n * most);
    const bool by_row = host_memory<Exec>;
    pairs_ = {by_row ? 1L : particles_, by_row ? most : 1L, count_.data(), other_.data(),
              e_and_f_.data(),          difference_.data()};
    device_for<Exec>("bdh::find_pairs", list.rows, FindPairs<Real>{list, table_, cutoff2_, pairs_});
  }
  /// u := M_r v
  void apply(const Vector &v, Vector &u) const
  {
    u.resize(slots * particles_);
    device_for<Exec>("bdh::apply_pairs", particles_,
                     ApplyPairs<Real>{pairs_, self_, v.data(), u.data()});
  }

  void bind_and_apply(const Particles &particles, const Vector &v, Vector &u)
  {
    bind(particles);
    apply(v, u);
  }

  long owned() const { return particles_; }
  long all() const { return all_; }
  /// Number of pairs that the last bind found, each counted once.
  double pairs() const
  {
    return 0.5 * device_sum<Exec>("bdh::count_pairs", particles_, SumCounts{count_.data()});
  }
  std::size_t memory() const
  {
    return bytes_of(count_, other_, e_and_f_, difference_, coefficients_);
  }

 private:
  double cutoff2_;
  Real self_;
  RealSpacePolynomials<Real> table_;
  long particles_ = 0, all_ = 0;
  DevicePairs<Real> pairs_{};
  DeviceArray<Real, Exec> coefficients_, e_and_f_, difference_;
  DeviceArray<int, Exec> count_, other_;
};

}    // namespace bdh
#endif
