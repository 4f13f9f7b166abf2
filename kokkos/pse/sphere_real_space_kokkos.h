// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// The real-space part for spheres of any radii, with or without rotation, on a device
/// (pse/near_kernel.h).
#ifndef BDH_PSE_SPHERE_REAL_SPACE_KOKKOS_H
#define BDH_PSE_SPHERE_REAL_SPACE_KOKKOS_H

#include "pse/near_table.h"
#include "pse/real_space_kokkos.h"

namespace bdh {

/// Spheres by particle, and the near parts of their self mobilities.
template <class Real, bool rotation> struct MakeSpheres {
  const double *radius;
  ShapeBasis basis;
  NearFunctions<Real, moments_of(rotation)> near;
  Sphere<Real> *sphere;
  NearPair<Real> *self;
  BDH_FN void operator()(long p) const
  {
    sphere[p] = make_sphere<Real>(radius[p], basis);
    self[p] = near.self(sphere[p]);
  }
};

/// What is kept of a pair; e points to the particle whose row it is in.
template <class Real> struct SphereEntry {
  Real e[dim];
  NearPair<Real> m;
  int other;
};

/// Entry k of particle p is at [k * pair_stride + p * particle_stride], as in DevicePairs.
template <class Real> struct SphereEntries {
  long pair_stride, particle_stride;
  int *count;    ///< by particle
  SphereEntry<Real> *entry;
  BDH_FN long place(long p, int k) const { return k * pair_stride + p * particle_stride; }
};

/// Pairs := those of the row within the cutoff.  The index is that of a row.
template <class Real, bool rotation> struct FindSpheres {
  DeviceNeighbors list;
  NearFunctions<Real, moments_of(rotation)> near;
  const Sphere<Real> *sphere;
  double cutoff2, closest;
  SphereEntries<Real> pairs;

  BDH_FN void add(long p, int atom, int other, int &count) const
  {
    const int q = list.particle[other];
    if (q < 0) return;
    const double *x = list.x + first_coordinate(atom), *y = list.x + first_coordinate(other);
    const double d[dim] = {x[0] - y[0], x[1] - y[1], x[2] - y[2]},
                 r2 = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
    if (!(r2 <= cutoff2)) return;
    const double r = std::sqrt(r2), inverse = r > 0.0 ? 1.0 / r : 0.0;
    SphereEntry<Real> &entry = pairs.entry[pairs.place(p, count++)];
    for (int c = 0; c < dim; ++c) entry.e[c] = d[c] * inverse;
    entry.m = near(r > closest ? r : closest, sphere[p], sphere[q]);
    entry.other = q;
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

/// u := M_r v.  The index is that of a particle.
template <class Real, bool rotation> struct ApplySpheres {
  static constexpr int size = rotation ? 2 * quad : quad;
  SphereEntries<Real> pairs;
  const NearPair<Real> *self;
  const Real *v;
  Real *u;

  /// sum += a w + b e + c e x t
  BDH_FN static void add(Real a, const Real *w, Real b, const Real *e, Real c, const Real *t,
                         Real *sum)
  {
    sum[0] += a * w[0] + b * e[0] + c * (e[1] * t[2] - e[2] * t[1]);
    sum[1] += a * w[1] + b * e[1] + c * (e[2] * t[0] - e[0] * t[2]);
    sum[2] += a * w[2] + b * e[2] + c * (e[0] * t[1] - e[1] * t[0]);
  }
  BDH_FN static Real dot(const Real *a, const Real *b)
  {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  }

  BDH_FN void operator()(long p) const
  {
    const Real *own = v + size * p;
    Real linear[dim], angular[dim] = {};
    for (int c = 0; c < dim; ++c) {
      linear[c] = self[p].f * own[c];
      if (rotation) angular[c] = self[p].g * own[quad + c];
    }
    for (int k = 0; k < pairs.count[p]; ++k) {
      const SphereEntry<Real> &pair = pairs.entry[pairs.place(p, k)];
      const NearPair<Real> &m = pair.m;
      const Real *force = v + static_cast<long>(size) * pair.other, *e = pair.e;
      const Real *torque = rotation ? force + quad : e;    // e x e = 0
      add(m.f, force, m.df * dot(e, force), e, m.uj, torque, linear);
      if (rotation) add(m.g, torque, m.dg * dot(e, torque), e, m.wi, force, angular);
    }
    Real *to = u + size * p;
    for (int c = 0; c < size; ++c) to[c] = Real(0);
    for (int c = 0; c < dim; ++c) {
      to[c] = linear[c];
      if (rotation) to[quad + c] = angular[c];
    }
  }
};

/// The counterpart of RealSpace with SizedSpheres; one process.
template <class Real, bool rotation, class Exec> class DeviceSphereRealSpace {
 public:
  using Vector = DeviceArray<Real, Exec>;
  using Particles = PseParticles<DeviceNeighbors>;
  static constexpr int slots = rotation ? 2 * quad : quad;

  explicit DeviceSphereRealSpace(const PsePlan &plan) :
      basis_(plan.basis()), cutoff2_(plan.r_cut * plan.r_cut)
  {
    const NearTable<Real, moments_of(rotation)> table(basis_, plan.xi, plan.r_cut,
                                                      plan.table_error);
    near_ = table.functions();
    coefficients_.assign(near_.coefficients, table.coefficient_count());
    near_.coefficients = coefficients_.data();
  }

  /// Finds the pairs within r_cut in the particles' list.  Positions must be finite.
  void bind(const Particles &particles)
  {
    const DeviceNeighbors &list = particles.neighbors;
    particles_ = particles.count;
    const long n = particles_, most = list.most + list.most_extra;
    spheres_.resize(n);
    self_.resize(n);
    device_for<Exec>("bdh::make_spheres", n,
                     MakeSpheres<Real, rotation>{particles.radius, basis_, near_, spheres_.data(),
                                                 self_.data()});
    count_.resize(n);
    count_.clear_values();
    entries_.resize(n * most);
    const bool by_row =
        Kokkos::SpaceAccessibility<Kokkos::HostSpace, typename Exec::memory_space>::accessible;
    pairs_ = {by_row ? 1L : particles_, by_row ? most : 1L, count_.data(), entries_.data()};
    // Centers at one place leave blocks without direction.
    const double closest = 1e-12 * basis_.b2;
    device_for<Exec>(
        "bdh::find_spheres", list.rows,
        FindSpheres<Real, rotation>{list, near_, spheres_.data(), cutoff2_, closest, pairs_});
  }
  /// u := M_r v
  void apply(const Vector &v, Vector &u) const
  {
    u.resize(slots * particles_);
    device_for<Exec>("bdh::apply_spheres", particles_,
                     ApplySpheres<Real, rotation>{pairs_, self_.data(), v.data(), u.data()});
  }
  void bind_and_apply(const Particles &particles, const Vector &v, Vector &u)
  {
    bind(particles);
    apply(v, u);
  }

  long owned() const { return particles_; }
  long all() const { return particles_; }
  /// Number of pairs that the last bind found, each counted once.
  double pairs() const
  {
    return 0.5 * device_sum<Exec>("bdh::count_pairs", particles_, SumCounts{count_.data()});
  }
  std::size_t memory() const { return bytes_of(spheres_, self_, count_, entries_, coefficients_); }

 private:
  ShapeBasis basis_;
  double cutoff2_;
  NearFunctions<Real, moments_of(rotation)> near_;
  long particles_ = 0;
  SphereEntries<Real> pairs_{};
  DeviceArray<Real, Exec> coefficients_;
  DeviceArray<Sphere<Real>, Exec> spheres_;
  DeviceArray<NearPair<Real>, Exec> self_;
  DeviceArray<SphereEntry<Real>, Exec> entries_;
  DeviceArray<int, Exec> count_;
};

}    // namespace bdh
#endif
