// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// How forces become vectors of the real-space part, and those become velocities.
///
/// Numbers of a kind of particles have
///     slots       per particle of a vector
///     load        vector := forces
///     add         velocities += factor times a vector
///     draw        vector := normals
///     mobility    what the blocks of the real-space part are to be multiplied with
#ifndef BDH_PSE_NUMBERS_H
#define BDH_PSE_NUMBERS_H

#include "pse/particles.h"
#include "pse/plan.h"
#include "pse/step_kernel.h"

namespace bdh {

/// Of spheres of one radius, without rotation: forces as they are, mobilities in units of
/// 1/(6 pi viscosity a).
template <class Real> struct EqualNumbers {
  static constexpr int slots = quad;
  static constexpr bool rotation = false;

  template <class Execution, class Particles> static void
  load(const Execution &execution, const Particles &particles, const PseForces &f, Real *to)
  {
    execution.for_each("bdh::load", particles.count, LoadVector<Real>{f.values, to});
  }
  template <class Execution, class Particles>
  static void add(const Execution &execution, const Particles &particles, double factor,
                  const Real *from, const PseVelocities &v)
  {
    execution.for_each("bdh::add", particles.count, AddVector<Real>{factor, from, v.linear});
  }
  template <class Execution, class Particles> static void
  draw(const Execution &execution, const Particles &particles, const PseNoise &noise, Real *to)
  {
    execution.for_draws("bdh::draw", particles.count, noise.counter(Stream::lanczos), particles.ids,
                        StoreNormals<Real>{to, slots, 0, dim, slots - dim});
  }
  static double mobility(const PsePlan &plan, double viscosity)
  {
    return free_mobility(plan.radius, viscosity);
  }
};

/// Of spheres of any radii: vectors are scaled by the roots of the free mobilities.
template <class Real, bool spins> struct SizedNumbers {
  static constexpr int slots = spins ? 2 * quad : quad;
  static constexpr bool rotation = spins;

  template <class Execution, class Particles> static void
  load(const Execution &execution, const Particles &particles, const PseForces &f, Real *to)
  {
    execution.for_each(
        "bdh::load", particles.count,
        LoadScaled<Real, spins>{FreeRoots{particles.radius}, f.values, f.torques, to});
  }
  template <class Execution, class Particles>
  static void add(const Execution &execution, const Particles &particles, double factor,
                  const Real *from, const PseVelocities &v)
  {
    execution.for_each(
        "bdh::add", particles.count,
        AddScaled<Real, spins>{FreeRoots{particles.radius}, factor, from, v.linear, v.angular});
  }
  template <class Execution, class Particles> static void
  draw(const Execution &execution, const Particles &particles, const PseNoise &noise, Real *to)
  {
    const auto store = [&](Stream stream, int first) {
      execution.for_draws("bdh::draw", particles.count, noise.counter(stream), particles.ids,
                          StoreNormals<Real>{to, slots, first, dim, quad - dim});
    };
    store(Stream::lanczos, 0);    // the same as without rotation
    if (spins) store(Stream::lanczos_rotation, quad);
  }
  static double mobility(const PsePlan &, double viscosity)
  {
    return free_mobility(1.0, viscosity);
  }
};

/// Of spheres of any radii with torques and stresslets.
template <class Real> struct StrainNumbers {
  static constexpr int slots = strain_slots;

  template <class Execution, class Particles> static void
  load(const Execution &execution, const Particles &particles, const PseForces &f, Real *to)
  {
    execution.for_each(
        "bdh::load", particles.count,
        LoadStrained<Real>{FreeRoots{particles.radius}, f.values, f.torques, f.stresslets, to});
  }
  template <class Execution, class Particles>
  static void add(const Execution &execution, const Particles &particles, double factor,
                  const Real *from, const PseVelocities &v)
  {
    execution.for_each("bdh::add", particles.count,
                       AddStrained<Real>{FreeRoots{particles.radius}, factor, from, v.linear,
                                         v.angular, v.strain});
  }
  template <class Execution, class Particles> static void
  draw(const Execution &execution, const Particles &particles, const PseNoise &noise, Real *to)
  {
    const auto store = [&](Stream stream, int first, int count, int zeros) {
      execution.for_draws("bdh::draw", particles.count, noise.counter(stream), particles.ids,
                          StoreNormals<Real>{to, slots, first, count, zeros});
    };
    // Those of translation and rotation are the same as without stresslets.
    store(Stream::lanczos, 0, dim, 0);
    store(Stream::lanczos_rotation, dim, dim, 0);
    store(Stream::lanczos_strain, 2 * dim, quad, 0);
    const int last = 2 * dim + quad;
    store(Stream::lanczos_last_strain, last, 1, slots - last - 1);
  }
  static double mobility(const PsePlan &, double viscosity)
  {
    return free_mobility(1.0, viscosity);
  }
};

}    // namespace bdh
#endif
