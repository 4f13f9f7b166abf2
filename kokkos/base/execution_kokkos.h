// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Where loops run and arrays are stored: on a device.  base/execution.h is the counterpart for the
/// host.
#ifndef BDH_BASE_EXECUTION_KOKKOS_H
#define BDH_BASE_EXECUTION_KOKKOS_H

#include "base/device_kokkos.h"
#include "base/rng_kernel.h"
#include "base/vector_kernel.h"
#include "base/workers.h"

#include <cstddef>
#include <vector>

namespace bdh {

/// w -= a v + b u
template <class Real> struct SubtractTwo {
  Real a;
  const Real *v;
  Real b;
  const Real *u;
  Real *w;
  BDH_FN void operator()(long i) const { w[i] -= a * v[i] + b * u[i]; }
};
template <class Real> struct Product {
  const Real *x, *y;
  BDH_FN void operator()(long i, double &sum) const
  {
    const double a = x[i], b = y[i];
    sum += a * b;
  }
};
/// y := sum over m of f[m] x[m]
template <class Real> struct CombineAll {
  static constexpr int most = 8;
  int count;
  bool add;    ///< add to the numbers in y
  Real f[most];
  const Real *x[most];
  Real *y;
  BDH_FN void operator()(long i) const
  {
    Real sum = add ? y[i] : Real(0);
    for (int m = 0; m < count; ++m) sum += f[m] * x[m][i];
    y[i] = sum;
  }
};

/// Calls an action with the normals of a draw.
template <class Action> struct WithNormals {
  NoiseCounter counter;
  const uint64_t *index;
  Action action;
  BDH_FN void operator()(long i) const
  {
    double z[4];
    normal4(counter, index[i], z[0], z[1], z[2], z[3]);
    action(i, z);
  }
};

/// Wraps a term in the form that Kokkos requires for a sum.
template <class Term> struct SumOf {
  Term term;
  BDH_FN void operator()(long i, double &sum) const { sum += term(i); }
};

/// A Kokkos execution space.  Its members mean the same as those of HostExecution.  Arrays are in
/// the memory of Exec; only the results of sums and searches are copied to the host.
template <class Exec> class DeviceExecution {
 public:
  using ParticleVector = DeviceArray<double, Exec>;
  using Flags = DeviceArray<char, Exec>;

  DeviceExecution() = default;
  /// The host's workers are not used.
  explicit DeviceExecution(const Workers &) {}

  template <class Action> void for_each(const char *name, long n, const Action &action) const
  {
    device_for<Exec>(name, n, action);
  }
  template <class Action> void for_draws(const char *name, long n, const NoiseCounter &counter,
                                         const uint64_t *index, const Action &action) const
  {
    device_for<Exec>(name, n, WithNormals<Action>{counter, index, action});
  }
  /// The order of summation depends on the space.
  template <class Term> double sum(const char *name, long n, const Term &term) const
  {
    return device_sum<Exec>(name, n, SumOf<Term>{term});
  }
  template <class Term> double greatest(const char *name, long n, const Term &term) const
  {
    return device_greatest<Exec>(name, n, term);
  }
  template <class Condition> long first(const char *name, long n, const Condition &condition) const
  {
    return device_first<Exec>(name, n, condition);
  }
  void fence() const { Exec().fence(); }

  template <class T> void clear(DeviceArray<T, Exec> &array) const { array.clear_values(); }
  static ParticleVector from_host(const std::vector<double> &v) { return ParticleVector(v); }
  static Flags from_host(const std::vector<char> &v) { return Flags(v); }
  static std::vector<double> to_host(const ParticleVector &v) { return v.to_host(); }

  template <class Real> double dot(const Real *x, const Real *y, long size) const
  {
    return device_sum<Exec>("bdh::dot", size, Product<Real>{x, y});
  }
  template <class Real> void scale(Real f, const Real *x, Real *y, long size) const
  {
    device_for<Exec>("bdh::scale", size, Scale<Real>{f, x, y});
  }
  template <class Real>
  void subtract(Real a, const Real *v, Real b, const Real *u, Real *w, long size) const
  {
    device_for<Exec>("bdh::subtract", size, SubtractTwo<Real>{a, v, b, u, w});
  }
  template <class Vector, class Real> void combine(const std::vector<double> &factor,
                                                   const std::vector<Vector> &vector, Real *y,
                                                   long size) const
  {
    for (std::size_t first = 0; first < factor.size(); first += CombineAll<Real>::most) {
      CombineAll<Real> c{0, first > 0, {}, {}, y};
      for (std::size_t m = first; m < factor.size() && c.count < CombineAll<Real>::most; ++m) {
        c.f[c.count] = factor[m];
        c.x[c.count++] = vector[m].data();
      }
      device_for<Exec>("bdh::combine_all", size, c);
    }
  }
};

}    // namespace bdh
#endif
