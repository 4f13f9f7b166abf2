// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// The kind of pairs (pse/pair_kinds.h) of spheres of any radii with forces, torques and
/// stresslets.
#ifndef BDH_PSE_STRAIN_PAIRS_H
#define BDH_PSE_STRAIN_PAIRS_H

#include "pse/pair_kinds.h"
#include "pse/strain_near_kernel.h"

namespace bdh {

/// Pairs that act on translations, rotations and strains.
template <class Real> class StrainPairs : public PairOthers {
 public:
  static constexpr int slots = strain_slots;
  static constexpr bool in_quads = false;
  struct Entry {
    Real e[dim];
    StrainPair<Real> m;
  };
  static_assert(sizeof(StrainPair<Real>) == strain_functions * sizeof(Real));

  /// Rows are filled up to a multiple of this: as many pairs as the widest vector register has
  /// lanes.
  static constexpr int group = 64 / sizeof(Real);

  void reserve(long more)
  {
    const std::size_t size = grow(more, group);
    if (!size) return;
    for (auto &values : number_) values.resize(size);
  }
  void fill_group(int particle)
  {
    while (count_ % group) add(Entry{}, particle);
  }
  void add(const Entry &pair, int other)
  {
    const Real *m = &pair.m.f;
    for (int c = 0; c < dim; ++c) number_[c][count_] = pair.e[c];
    for (int k = 0; k < strain_functions; ++k) number_[dim + k][count_] = m[k];
    other_[count_++] = other;
  }
  Entry entry(long k) const
  {
    Entry pair;
    Real *m = &pair.m.f;
    for (int c = 0; c < dim; ++c) pair.e[c] = number_[c][k];
    for (int f = 0; f < strain_functions; ++f) m[f] = number_[dim + f][k];
    return pair;
  }
  template <bool mutual> void apply(const PairRange &range, const Real *v, Real *u) const;
  /// From stresslets to strains alone.
  template <bool mutual> void apply_strains(const PairRange &range, const Real *v, Real *u) const;
  std::size_t memory() const { return bytes_of(number_, other_); }

 private:
  AlignedArray<Real> number_[dim + strain_functions];    // e, then the functions
};

/// Vectors are scaled by the free mobilities; of each sphere they have the numbers of the force,
/// of the torque and of the stresslet, and a last one that is 0.
template <class Real> class StrainingSpheres
    : public SpheresByRadius<Real, Moments::stresslet, StrainSphere<Real>> {
 public:
  using Store = StrainPairs<Real>;
  using Entry = typename Store::Entry;
  static constexpr int slots = Store::slots;
  static constexpr bool have_strains = true;

  using SpheresByRadius<Real, Moments::stresslet, StrainSphere<Real>>::SpheresByRadius;
  template <class Neighbors> void bind(const PseParticles<Neighbors> &particles)
  {
    this->bind_radii(particles, make_strain_sphere<Real>);
    const StrainNear<Real> near{this->near()};
    self_.resize(dim * particles.count);
    for (long p = 0; p < particles.count; ++p) near.self(this->sphere(p), &self_[dim * p]);
  }
  Entry entry(PairDirection<Real> e, double r, int i, int j) const
  {
    const StrainNear<Real> near{this->near()};
    return {{e[0], e[1], e[2]}, near(this->apart(r), this->sphere(i), this->sphere(j))};
  }
  static Entry reversed(const Entry &pair)
  {
    Entry p = pair;
    for (Real &c : p.e) c = -c;
    std::swap(p.m.p, p.m.pr);
    std::swap(p.m.q, p.m.qr);
    return p;
  }
  void start(long begin, long end, const Real *v, Real *u) const
  {
    for (long p = begin; p < end; ++p)
      for (int c = 0; c < slots; ++c)
        u[slots * p + c] = self_[dim * p + std::min(c / dim, dim - 1)] * v[slots * p + c];
  }
  std::size_t memory() const { return this->memory_of_radii() + bytes_of(self_); }

 private:
  std::vector<Real> self_;    // three for each particle
};

}    // namespace bdh
#endif
