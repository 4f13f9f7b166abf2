// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// What spheres of any radii bring to the grids of their shape functions, and take from there.
#ifndef BDH_PSE_SPHERE_LOADS_H
#define BDH_PSE_SPHERE_LOADS_H

#include "base/bytes_of.h"
#include "base/workers.h"
#include "pse/particles.h"
#include "pse/plan.h"
#include "pse/sphere_spread.h"

#include <cstddef>
#include <vector>

namespace bdh {

/// Forces, torques, stresslets and coefficients of the shapes, in the quads that SphereSpreader
/// takes, and the motions that come back in the same places.
class SphereLoads {
 public:
  /// Numbers of a sphere.
  static int size(const PsePlan &plan) { return sphere_numbers(plan.moments()); }

  /// Those of n spheres.
  void pack(const PsePlan &plan, const double *radius, const PseForces &forces, long n,
            const Workers &workers)
  {
    size_ = size(plan);
    count_ = n;
    loads_.resize(size_ * n);
    motions_.resize(size_ * n);
    const ShapeBasis basis = plan.basis();
    workers.for_ranges(n, [&](long begin, long end) {
      for (long p = begin; p < end; ++p) {
        const double a2 = radius[p] * radius[p];
        put(forces.act ? forces.values : nullptr, basis.coefficient(a2), p, 0);
        if (size_ > quad)
          put(forces.act ? forces.torques : nullptr, basis.coefficient(basis.moment * a2), p, quad);
        if (size_ > 2 * quad) put_stresslet(forces.act ? forces.stresslets : nullptr, p);
      }
    });
  }
  const double *packed() const { return loads_.data(); }
  double *motions() { return motions_.data(); }
  void unpack(const PseVelocities &velocity, const Workers &workers) const
  {
    workers.for_ranges(count_, [&](long begin, long end) {
      for (long p = begin; p < end; ++p)
        for (int c = 0; c < dim; ++c) {
          velocity.linear[dim * p + c] = motions_[size_ * p + c];
          if (size_ > quad) velocity.angular[dim * p + c] = motions_[size_ * p + quad + c];
        }
      if (size_ > 2 * quad && velocity.strain)
        for (long p = begin; p < end; ++p)
          for (int c = 0; c < strain_numbers; ++c)
            velocity.strain[strain_numbers * p + c] = motions_[size_ * p + 2 * quad + c];
    });
  }
  std::size_t memory() const { return bytes_of(loads_, motions_); }

 private:
  /// values: dim per sphere; null for zeros.
  void put(const double *values, double coefficient, long p, int first)
  {
    double *load = loads_.data() + size_ * p + first;
    for (int c = 0; c < dim; ++c) load[c] = values ? values[dim * p + c] : 0.0;
    load[dim] = coefficient;
  }

  void put_stresslet(const double *values, long p)
  {
    double *load = loads_.data() + size_ * p + 2 * quad;
    for (int c = 0; c < 2 * quad; ++c)
      load[c] = values && c < strain_numbers ? values[strain_numbers * p + c] : 0.0;
  }

  int size_ = quad;
  long count_ = 0;
  std::vector<double> loads_, motions_;
};

}    // namespace bdh
#endif
