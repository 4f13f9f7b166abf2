// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// What iterations do with vectors, on a device.
#ifndef BDH_BASE_ALGEBRA_KOKKOS_H
#define BDH_BASE_ALGEBRA_KOKKOS_H

#include "base/device_kokkos.h"
#include "base/vector_kernel.h"

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
    sum += static_cast<double>(x[i]) * static_cast<double>(y[i]);
  }
};
/// y := sum over m of f[m] x[m]
template <class Real> struct CombineAll {
  static constexpr int most = 8;
  int count;
  bool add;    ///< to what is there
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

/// As HostAlgebra, on a device; sums come to the host.
template <class RealType, class Exec> struct DeviceAlgebra {
  using Real = RealType;
  double dot(const Real *x, const Real *y, std::size_t size) const
  {
    return device_sum<Exec>("bdh::dot", static_cast<long>(size), Product<Real>{x, y});
  }
  template <class Action>
  void for_each(const char *name, std::size_t size, const Action &action) const
  {
    device_for<Exec>(name, static_cast<long>(size), action);
  }
  void scale(Real f, const Real *x, Real *y, std::size_t size) const
  {
    device_for<Exec>("bdh::scale", static_cast<long>(size), Scale<Real>{f, x, y});
  }
  void subtract(Real a, const Real *v, Real b, const Real *u, Real *w, std::size_t size) const
  {
    device_for<Exec>("bdh::subtract", static_cast<long>(size), SubtractTwo<Real>{a, v, b, u, w});
  }
  template <class Vector> void combine(const std::vector<double> &factor,
                                       const std::vector<Vector> &vector, Real *y,
                                       std::size_t size) const
  {
    for (std::size_t first = 0; first < factor.size(); first += CombineAll<Real>::most) {
      CombineAll<Real> c{0, first > 0, {}, {}, y};
      for (std::size_t m = first; m < factor.size() && c.count < CombineAll<Real>::most; ++m) {
        c.f[c.count] = static_cast<Real>(factor[m]);
        c.x[c.count++] = vector[m].data();
      }
      device_for<Exec>("bdh::combine_all", static_cast<long>(size), c);
    }
  }
};

}    // namespace bdh
#endif
