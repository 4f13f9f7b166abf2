// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// The real-space part for spheres of any radii on a device: with forces alone, with torques
/// (pse/near_kernel.h), and with stresslets (pse/strain_near_kernel.h).
#ifndef BDH_PSE_SPHERE_REAL_SPACE_KOKKOS_H
#define BDH_PSE_SPHERE_REAL_SPACE_KOKKOS_H

#include "pse/near_table.h"
#include "pse/real_space_kokkos.h"
#include "pse/strain_near_kernel.h"

namespace bdh {

/// What the kernels below need to know of spheres that have these moments: the near part of a pair
/// and of a sphere by itself, and their products with the numbers of a particle.
template <class Real, Moments moments> struct NearKind {
  static constexpr bool rotation = moments == Moments::torque;
  static constexpr int slots = rotation ? 2 * quad : quad;
  using Near = NearFunctions<Real, moments>;
  using Own = Sphere<Real>;
  using Pair = NearPair<Real>;
  using Self = NearPair<Real>;

  BDH_FN static Own make(double radius, const ShapeBasis &basis)
  {
    return make_sphere<Real>(radius, basis);
  }
  BDH_FN static Self self(const Near &near, const Own &sphere) { return near.self(sphere); }

  /// sum := what a particle does to itself
  BDH_FN static void start(const Self &self, const Real *v, Real *sum)
  {
    for (int c = 0; c < slots; ++c) sum[c] = Real(0);
    for (int c = 0; c < dim; ++c) {
      sum[c] = self.f * v[c];
      if (rotation) sum[quad + c] = self.g * v[quad + c];
    }
  }
  /// sum += what the other particle does to it
  BDH_FN static void add(const Pair &m, const Real *e, const Real *other, Real *sum)
  {
    const Real *torque = rotation ? other + quad : e;    // e x e = 0
    add_terms(m.f, other, m.df * scalar_product(e, other), e, m.uj, torque, sum);
    if (rotation)
      add_terms(m.g, torque, m.dg * scalar_product(e, torque), e, m.wi, other, sum + quad);
  }
  BDH_FN static void finish(Real *) {}

  /// sum += a w + b e + c e x t
  BDH_FN static void add_terms(Real a, const Real *w, Real b, const Real *e, Real c, const Real *t,
                               Real *sum)
  {
    sum[0] += a * w[0] + b * e[0] + c * (e[1] * t[2] - e[2] * t[1]);
    sum[1] += a * w[1] + b * e[1] + c * (e[2] * t[0] - e[0] * t[2]);
    sum[2] += a * w[2] + b * e[2] + c * (e[0] * t[1] - e[1] * t[0]);
  }
};

/// The same with torques and stresslets.  Sums lack the roots of their free mobilities until they
/// are finished.
template <class Real> struct NearKind<Real, Moments::stresslet> {
  static constexpr int slots = strain_slots;
  using Near = StrainNear<Real>;
  using Own = StrainSphere<Real>;
  using Pair = StrainPair<Real>;
  struct Self {
    Real share[dim];    ///< of forces, torques and stresslets
  };

  BDH_FN static Own make(double radius, const ShapeBasis &basis)
  {
    return make_strain_sphere<Real>(radius, basis);
  }
  BDH_FN static Self self(const Near &near, const Own &sphere)
  {
    Self s;
    near.self(sphere, s.share);
    return s;
  }

  BDH_FN static void start(const Self &self, const Real *v, Real *sum)
  {
    for (int c = 0; c < motion_numbers; ++c) {
      const int moment = c < 2 * dim ? c / dim : dim - 1;
      sum[c] = self.share[moment] * v[c] / inverse_root<Real>(c);
    }
    for (int c = motion_numbers; c < slots; ++c) sum[c] = Real(0);
  }
  BDH_FN static void add(const Pair &m, const Real *e, const Real *other, Real *sum)
  {
    Real load[motion_numbers];
    for (int c = 0; c < motion_numbers; ++c) load[c] = inverse_root<Real>(c) * other[c];
    add_motion(m, e, StrainLoad<Real>::of(load), sum);
  }
  BDH_FN static void finish(Real *sum)
  {
    for (int c = 0; c < motion_numbers; ++c) sum[c] *= inverse_root<Real>(c);
  }
};

/// Spheres by particle, the near parts of their self mobilities, and how far they reach.
template <class Real, Moments moments> struct MakeSpheres {
  using Kind = NearKind<Real, moments>;
  const double *radius;
  ShapeBasis basis;
  NearReach reach;
  typename Kind::Near near;
  typename Kind::Own *sphere;
  typename Kind::Self *self;
  double *reach_of;
  BDH_FN void operator()(long p) const
  {
    sphere[p] = Kind::make(radius[p], basis);
    self[p] = Kind::self(near, sphere[p]);
    reach_of[p] = reach(basis.coefficient(radius[p] * radius[p]));
  }
};

/// What is kept of a pair; e points to the particle whose row it is in.
template <class Kind, class Real> struct SphereEntry {
  Real e[dim];
  typename Kind::Pair m;
  int other;
};

/// Entry k of particle p is at [k * pair_stride + p * particle_stride], as in DevicePairs.
template <class Entry> struct SphereEntries {
  long pair_stride, particle_stride;
  int *count;    ///< by particle
  Entry *entry;
  BDH_FN long place(long p, int k) const { return k * pair_stride + p * particle_stride; }
};

/// Pairs := those of the row within reach.  The index is that of a row.
template <class Real, Moments moments> struct FindSpheres {
  using Kind = NearKind<Real, moments>;
  using Entry = SphereEntry<Kind, Real>;
  DeviceNeighbors list;
  typename Kind::Near near;
  const typename Kind::Own *sphere;
  const double *reach;
  double closest;
  SphereEntries<Entry> pairs;

  BDH_FN void add(long p, int atom, int other, int &count) const
  {
    const int q = list.particle[other];
    if (q < 0) return;
    const double *x = list.x + first_coordinate(atom), *y = list.x + first_coordinate(other);
    const double d[dim] = {x[0] - y[0], x[1] - y[1], x[2] - y[2]},
                 r2 = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
    const double cutoff = reach[p] + reach[q];
    if (!(r2 <= cutoff * cutoff)) return;
    const double r = std::sqrt(r2), inverse = r > 0.0 ? 1.0 / r : 0.0;
    Entry &entry = pairs.entry[pairs.place(p, count++)];
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
template <class Real, Moments moments> struct ApplySpheres {
  using Kind = NearKind<Real, moments>;
  using Entry = SphereEntry<Kind, Real>;
  SphereEntries<Entry> pairs;
  const typename Kind::Self *self;
  const Real *v;
  Real *u;

  BDH_FN void operator()(long p) const
  {
    Real sum[Kind::slots];
    Kind::start(self[p], v + Kind::slots * p, sum);
    for (int k = 0; k < pairs.count[p]; ++k) {
      const Entry &pair = pairs.entry[pairs.place(p, k)];
      Kind::add(pair.m, pair.e, v + static_cast<long>(Kind::slots) * pair.other, sum);
    }
    Kind::finish(sum);
    for (int c = 0; c < Kind::slots; ++c) u[Kind::slots * p + c] = sum[c];
  }
};

/// The counterpart of RealSpace with SizedSpheres or StrainingSpheres.
template <class Real, Moments moments, class Exec> class DeviceSphereRealSpace {
  using Kind = NearKind<Real, moments>;
  using Entry = SphereEntry<Kind, Real>;
  using Near = typename Kind::Near;

 public:
  using Vector = DeviceArray<Real, Exec>;
  using Particles = PseParticles<DeviceNeighbors>;
  static constexpr int slots = Kind::slots;

  explicit DeviceSphereRealSpace(const PsePlan &plan) :
      basis_(plan.basis()), reach_(basis_, plan.wave_weight(), plan.r_cut)
  {
    const NearTable<Real, moments> table(basis_, {plan.wave_weight(), plan.r_cut}, plan.r_cut,
                                         plan.table_error);
    table_ = table.functions();
    coefficients_.assign(table_.coefficients, table.coefficient_count());
    table_.coefficients = coefficients_.data();
  }

  /// Finds the pairs within reach in the particles' list.  Positions must be finite.
  void bind(const Particles &particles)
  {
    const DeviceNeighbors &list = particles.neighbors;
    particles_ = particles.count;
    all_ = particles.with_ghosts;
    const long n = particles_, most = list.most + list.most_extra;
    spheres_.resize(all_);
    self_.resize(all_);
    reach_of_.resize(all_);
    const Near near{table_};
    device_for<Exec>("bdh::make_spheres", all_,
                     MakeSpheres<Real, moments>{particles.radius, basis_, reach_, near,
                                                spheres_.data(), self_.data(), reach_of_.data()});
    count_.resize(n);
    count_.clear_values();
    entries_.resize(n * most);
    const bool by_row = host_memory<Exec>;
    pairs_ = {by_row ? 1L : particles_, by_row ? most : 1L, count_.data(), entries_.data()};
    // Centers at one place leave blocks without direction.
    const double closest = 1e-12 * basis_.b2;
    device_for<Exec>(
        "bdh::find_spheres", list.rows,
        FindSpheres<Real, moments>{list, near, spheres_.data(), reach_of_.data(), closest, pairs_});
  }
  /// u := M_r v
  void apply(const Vector &v, Vector &u) const
  {
    u.resize(slots * particles_);
    device_for<Exec>("bdh::apply_spheres", particles_,
                     ApplySpheres<Real, moments>{pairs_, self_.data(), v.data(), u.data()});
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
    return bytes_of(spheres_, self_, reach_of_, count_, entries_, coefficients_);
  }

 private:
  ShapeBasis basis_;
  NearReach reach_;
  NearFunctions<Real, moments> table_;
  long particles_ = 0, all_ = 0;
  SphereEntries<Entry> pairs_{};
  DeviceArray<Real, Exec> coefficients_;
  DeviceArray<typename Kind::Own, Exec> spheres_;
  DeviceArray<typename Kind::Self, Exec> self_;
  DeviceArray<double, Exec> reach_of_;
  DeviceArray<Entry, Exec> entries_;
  DeviceArray<int, Exec> count_;
};

}    // namespace bdh
#endif
