// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// What RealSpace keeps of a pair, and its product with vectors: for spheres of one radius, for
/// spheres of any radii, and for those that also rotate.
///
/// A kind has
///     Vector slots          numbers per particle in vectors
///     Entry                 what is kept of a pair; store: an array of them, in groups
///     bind(particles)       the particles' sizes
///     reaches(i, j, r2)     whether the pair at this squared distance has a near part; i may be no
///                           particle, a negative number
///     entry(e, r, i, j)     of particles i and j at distance r, with the direction e from j to i
///     apply<mutual>         u += M_r v of some pairs of one particle
///     start                 u := the self part of M_r v
#ifndef BDH_PSE_PAIR_KINDS_H
#define BDH_PSE_PAIR_KINDS_H

#include "base/aligned.h"
#include "base/bytes_of.h"
#include "base/registers.h"
#include "pse/near_table.h"
#include "pse/particles.h"
#include "pse/plan.h"
#include "pse/rpy.h"

#include <algorithm>
#include <type_traits>
#include <utility>
#include <vector>

namespace bdh {

/// The direction of a pair, a unit vector or 0, and a last number that is 0.
template <class Real> using PairDirection = LanesOf<Real, quad>;

/// Pairs first .. end - 1 of one particle.
struct PairRange {
  int particle;
  long first, end;
};

/// What all stores of pairs share: the particle that a pair's row does not belong to.
class PairOthers {
 public:
  void clear() { count_ = 0; }
  long count() const { return count_; }
  /// The particle of pair k that the row does not belong to.
  int other(long k) const { return other_[k]; }

 protected:
  /// The size that arrays of pairs need for some more of them, and for zeros that complete their
  /// group; 0 if they are large enough.
  std::size_t grow(long more, int group)
  {
    const std::size_t needed = count_ + more + group;
    if (other_.size() >= needed) return 0;
    other_.resize(needed + needed / 4);
    return other_.size();
  }

  std::vector<int> other_;
  long count_ = 0;    // the arrays are longer
};

/// Pairs that act on translations alone: blocks f (I - e e^T) + g e e^T, stored as f I + difference
/// e e^T.
template <class Real> class TranslationPairs : public PairOthers {
 public:
  static constexpr int slots = 4;
  /// The fourth number of each quad is a place for what products leave there.
  static constexpr bool in_quads = true;
  struct Entry {
    LanesOf<Real, slots> e_and_f;    // f last
    Real difference;
  };

  /// Rows are filled up to a multiple of this: as many pairs as the widest vector register holds.
  static constexpr int group = 64 / (slots * sizeof(Real));

  /// Makes room for some more pairs, and for zeros that complete their group.
  void reserve(long more)
  {
    const std::size_t size = grow(more, group);
    if (!size) return;
    e_and_f_.resize(slots * size);
    difference_.resize(size);
  }
  void fill_group(int particle)
  {
    while (count_ % group) add(Entry{}, particle);
  }
  void add(const Entry &entry, int other)
  {
    put_lanes<Real, slots>(entry.e_and_f, &e_and_f_[slots * count_]);
    difference_[count_] = entry.difference;
    other_[count_++] = other;
  }
  Entry entry(long k) const
  {
    return {lanes_at<Real, slots>(&e_and_f_[slots * k]), difference_[k]};
  }
  /// u of the particle += M_r v, and of the others as well if the pairs are mutual.
  template <bool mutual> void apply(const PairRange &range, const Real *v, Real *u) const;
  std::size_t memory() const { return bytes_of(e_and_f_, difference_, other_); }

 private:
  AlignedArray<Real> e_and_f_;    // slots each: e, and f last
  std::vector<Real> difference_;
};

/// Pairs that act on translations and rotations.
template <class Real> class SpinPairs : public PairOthers {
 public:
  static constexpr int slots = 8;
  static constexpr bool in_quads = true;
  struct Entry {
    Real e[dim];
    NearPair<Real> m;
  };

  static constexpr int group = TranslationPairs<Real>::group;

  void reserve(long more)
  {
    const std::size_t size = grow(more, group);
    if (!size) return;
    e_.resize(quad * size);
    for (auto &values : function_) values.resize(size);
  }
  void fill_group(int particle)
  {
    while (count_ % group) add(Entry{}, particle);
  }
  void add(const Entry &pair, int other)
  {
    const NearPair<Real> &m = pair.m;
    for (int c = 0; c < dim; ++c) e_[quad * count_ + c] = pair.e[c];
    e_[quad * count_ + dim] = Real(0);
    const Real values[] = {m.f, m.df, m.g, m.dg, m.wi, m.uj};
    for (int k = 0; k < functions; ++k) function_[k][count_] = values[k];
    other_[count_++] = other;
  }
  Entry entry(long k) const
  {
    const auto at = [this, k](int which) { return function_[which][k]; };
    return {{e_[quad * k], e_[quad * k + 1], e_[quad * k + 2]},
            {at(0), at(1), at(2), at(3), at(4), at(5)}};
  }
  template <bool mutual> void apply(const PairRange &range, const Real *v, Real *u) const;
  std::size_t memory() const { return bytes_of(e_, function_, other_); }

 private:
  static constexpr int functions = 6;    // of NearPair, in its order
  AlignedArray<Real> e_;                 // quads
  AlignedArray<Real> function_[functions];
};

/// Spheres of one radius that translate, by the table of F and G - F.  All is in units of
/// 1/(6 pi viscosity a).
template <class Real> class EqualSpheres {
 public:
  using Store = TranslationPairs<Real>;
  using Entry = typename Store::Entry;
  static constexpr int slots = Store::slots;
  static constexpr bool have_strains = false;

  explicit EqualSpheres(const PsePlan &plan) :
      table_(plan.real_space_part(), plan.r_cut,
             std::max(plan.table_error, RealSpaceTable<Real>::smallest_error())),
      self_(plan.real_space_part().self()), cutoff2_(plan.r_cut * plan.r_cut)
  {}
  template <class Neighbors> void bind(const PseParticles<Neighbors> &) {}
  bool reaches(int, int, double r2) const { return r2 <= cutoff2_; }
  Entry entry(PairDirection<Real> e, Real r, int, int) const
  {
    Real f, difference;
    table_.evaluate(r, f, difference);
    e[dim] = f;
    return {e, difference};
  }
  /// The same pair seen from the other particle.
  static Entry reversed(const Entry &pair) { return pair; }
  /// u := self part of v, for particles begin .. end - 1.
  void start(long begin, long end, const Real *v, Real *u) const
  {
    for (long i = slots * begin; i < slots * end; ++i) u[i] = self_ * v[i];
  }
  std::size_t memory() const { return table_.memory(); }

 private:
  RealSpaceTable<Real> table_;
  Real self_;
  double cutoff2_;
};

/// Up to where pairs of spheres of any radii have a near part (NearReach).
class PairReach {
 public:
  explicit PairReach(const PsePlan &plan) :
      basis_(plan.basis()), reach_(basis_, plan.wave_weight(), plan.r_cut)
  {}
  /// radius: of n particles
  void bind(const double *radius, long n)
  {
    of_.resize(n);
    for (long p = 0; p < n; ++p) of_[p] = reach_(basis_.coefficient(radius[p] * radius[p]));
  }
  bool operator()(int i, int j, double r2) const
  {
    const double cutoff = of_[std::max(i, 0)] + of_[j];
    return r2 <= cutoff * cutoff;
  }
  std::size_t memory() const { return bytes_of(of_); }

 private:
  ShapeBasis basis_;
  NearReach reach_;
  std::vector<double> of_;    // by particle, with ghosts
};

/// What the kinds of spheres of any radii share: how far they reach, the tables of their near part,
/// and what those need of each sphere.
template <class Real, Moments moments, class Sphere> class SpheresByRadius {
 public:
  explicit SpheresByRadius(const PsePlan &plan) :
      basis_(plan.basis()), reach_(plan),
      table_(basis_, {plan.wave_weight(), plan.r_cut}, plan.r_cut, plan.table_error)
  {}
  bool reaches(int i, int j, double r2) const { return reach_(i, j, r2); }

 protected:
  /// The radii of all particles and ghosts.  make(radius, basis) gives a sphere.
  template <class Neighbors, class Make>
  void bind_radii(const PseParticles<Neighbors> &particles, const Make &make)
  {
    const long all = particles.with_ghosts;
    reach_.bind(particles.radius, all);
    spheres_.resize(all);
    for (long p = 0; p < all; ++p) spheres_[p] = make(particles.radius[p], basis_);
  }
  const Sphere &sphere(long p) const { return spheres_[p]; }
  NearFunctions<Real, moments> near() const { return table_.functions(); }
  /// Centers at one place leave blocks without direction; e is 0 there.
  double apart(double r) const { return std::fmax(r, 1e-12 * basis_.b2); }
  std::size_t memory_of_radii() const
  {
    return reach_.memory() + table_.memory() + bytes_of(spheres_);
  }

 private:
  ShapeBasis basis_;
  PairReach reach_;
  NearTable<Real, moments> table_;
  std::vector<Sphere> spheres_;    // by particle, with ghosts
};

/// Spheres of any radii, by two shape functions (pse/near_kernel.h).  Vectors are scaled by the
/// free mobilities.
template <class Real, Moments moments> class SizedSpheres
    : public SpheresByRadius<Real, moments, Sphere<Real>> {
  static constexpr bool rotation = moments == Moments::torque;

 public:
  using Store = std::conditional_t<rotation, SpinPairs<Real>, TranslationPairs<Real>>;
  using Entry = typename Store::Entry;
  static constexpr int slots = Store::slots;
  static constexpr bool have_strains = false;

  using SpheresByRadius<Real, moments, Sphere<Real>>::SpheresByRadius;
  template <class Neighbors> void bind(const PseParticles<Neighbors> &particles)
  {
    this->bind_radii(particles, make_sphere<Real>);
    const NearFunctions<Real, moments> near = this->near();
    self_.resize(particles.count);
    for (long p = 0; p < particles.count; ++p) self_[p] = near.self(this->sphere(p));
  }
  Entry entry(PairDirection<Real> e, double r, int i, int j) const
  {
    const NearFunctions<Real, moments> near = this->near();
    const NearPair<Real> m = near(this->apart(r), this->sphere(i), this->sphere(j));
    if constexpr (rotation) {
      return {{e[0], e[1], e[2]}, m};
    } else {
      e[dim] = m.f;
      return {e, m.df};
    }
  }
  static Entry reversed(const Entry &pair)
  {
    if constexpr (rotation) {
      Entry p = pair;
      for (Real &c : p.e) c = -c;
      std::swap(p.m.wi, p.m.uj);
      return p;
    } else {
      return pair;
    }
  }
  void start(long begin, long end, const Real *v, Real *u) const
  {
    for (long p = begin; p < end; ++p)
      for (int c = 0; c < slots; ++c)
        u[slots * p + c] = (c < 4 ? self_[p].f : self_[p].g) * v[slots * p + c];
  }
  std::size_t memory() const { return this->memory_of_radii() + bytes_of(self_); }

 private:
  std::vector<NearPair<Real>> self_;    // by particle
};

}    // namespace bdh
#endif
