// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// The pointwise parts of a step with positively split Ewald: what is done for each number,
/// or each particle.
///
/// Arrays of particles have dof numbers for each of them, vectors of the real-space part have slots
/// (pse/layout.h).  What is kept by atom has `stride` numbers for each atom, and `local` holds the
/// atom of each particle.
#ifndef BDH_PSE_STEP_KERNEL_H
#define BDH_PSE_STEP_KERNEL_H

#include "base/rotation_kernel.h"
#include "base/strain_kernel.h"
#include "base/vector_kernel.h"
#include "pse/layout.h"

#include <cmath>

namespace bdh {

/// One particle of a real-space vector := its numbers, and zeros behind them; by particle.
template <class Real> struct LoadVector {
  const double *from;
  Real *to;
  BDH_FN void operator()(long p) const
  {
    for (int c = 0; c < dof; ++c) to[slots * p + c] = from[dof * p + c];
    for (int c = dof; c < slots; ++c) to[slots * p + c] = Real(0);
  }
};
/// to += factor * from, a real-space vector; by particle.
template <class Real> struct AddVector {
  double factor;
  const Real *from;
  double *to;
  BDH_FN void operator()(long p) const
  {
    for (int c = 0; c < dof; ++c) to[dof * p + c] += factor * from[slots * p + c];
  }
};

/// The same of spheres of any radii, whose vectors are scaled by the roots of their free
/// mobilities: a force times the root is a number, a number times the root a velocity.
template <class Real, bool rotation> struct LoadScaled {
  FreeRoots root;
  const double *force, *torque;    // torque: may be null
  Real *to;
  BDH_FN void operator()(long p) const
  {
    constexpr int size = rotation ? 2 * quad : quad;
    for (int c = 0; c < size; ++c) to[size * p + c] = Real(0);
    for (int c = 0; c < dim; ++c) to[size * p + c] = root.force(p) * force[dim * p + c];
    if (rotation && torque)
      for (int c = 0; c < dim; ++c) to[size * p + quad + c] = root.torque(p) * torque[dim * p + c];
  }
};
template <class Real, bool rotation> struct AddScaled {
  FreeRoots root;
  double factor;
  const Real *from;
  double *linear, *angular;
  BDH_FN void operator()(long p) const
  {
    constexpr int size = rotation ? 2 * quad : quad;
    const double t = factor * root.force(p);
    for (int c = 0; c < dim; ++c) linear[dim * p + c] += t * from[size * p + c];
    if (!rotation) return;
    const double r = factor * root.torque(p);
    for (int c = 0; c < dim; ++c) angular[dim * p + c] += r * from[size * p + quad + c];
  }
};
/// The same with stresslets, whose free mobility is 9/(10 a^3).
template <class Real> struct LoadStrained {
  FreeRoots root;
  const double *force, *torque, *stresslet;    // torque and stresslet: may be null
  Real *to;
  BDH_FN void operator()(long p) const
  {
    Real *v = to + strain_slots * p;
    for (int c = 0; c < strain_slots; ++c) v[c] = Real(0);
    for (int c = 0; c < dim; ++c) v[c] = root.force(p) * force[dim * p + c];
    if (torque)
      for (int c = 0; c < dim; ++c) v[dim + c] = root.torque(p) * torque[dim * p + c];
    if (stresslet)
      for (int c = 0; c < strain_numbers; ++c)
        v[2 * dim + c] = root.stresslet(p) * stresslet[strain_numbers * p + c];
  }
};
template <class Real> struct AddStrained {
  FreeRoots root;
  double factor;
  const Real *from;
  double *linear, *angular, *strain;    // strain: may be null
  BDH_FN void operator()(long p) const
  {
    const Real *v = from + strain_slots * p;
    const double t = factor * root.force(p), r = factor * root.torque(p),
                 s = factor * root.stresslet(p);
    for (int c = 0; c < dim; ++c) linear[dim * p + c] += t * v[c];
    for (int c = 0; c < dim; ++c) angular[dim * p + c] += r * v[dim + c];
    if (!strain) return;
    for (int c = 0; c < strain_numbers; ++c) strain[strain_numbers * p + c] += s * v[2 * dim + c];
  }
};

/// True for a particle with a force or a torque; torque may be null.
struct HasForce {
  const double *force, *torque;
  BDH_FN bool operator()(long p) const
  {
    for (int c = 0; c < dof; ++c)
      if (force[dof * p + c] != 0.0 || (torque && torque[dof * p + c] != 0.0)) return true;
    return false;
  }
};
/// `numbers` numbers of its atom := 0, by particle.
struct ClearKept {
  const int *local;
  long stride;
  double *kept;
  int numbers;
  BDH_FN void operator()(long p) const
  {
    for (int c = 0; c < numbers; ++c) kept[stride * local[p] + c] = 0.0;
  }
};
/// rotation := time angular + dt flow, by particle: dof numbers each.
struct RotateWithFlow {
  const double *angular;
  double time, dt, flow[dim];
  double *rotation;
  BDH_FN void operator()(long p) const
  {
    for (int c = 0; c < dim; ++c)
      rotation[dof * p + c] = time * angular[dof * p + c] + dt * flow[c];
  }
};
/// The rotation vector of its atom := that followed by the rotation r, by particle.
struct TurnKept {
  const int *local;
  long stride;
  const double *r;
  double *kept;
  BDH_FN void operator()(long p) const { turn_further(1.0, r + dof * p, kept + stride * local[p]); }
};
/// The numbers of its atom += v, by particle.
struct AddToKept {
  const int *local;
  long stride;
  const double *v;
  double *kept;
  BDH_FN void operator()(long p) const
  {
    for (int c = 0; c < dof; ++c) kept[stride * local[p] + c] += v[dof * p + c];
  }
};
/// v := the numbers of its atom over a divisor, by particle.
struct DivideKept {
  const int *local;
  long stride;
  const double *kept;
  double divisor;
  double *v;
  BDH_FN void operator()(long p) const
  {
    for (int c = 0; c < dof; ++c) v[dof * p + c] = kept[stride * local[p] + c] / divisor;
  }
};
/// displacement := h displacement + the mean of two noises, by particle, and the same for
/// rotations, if there are any.  The last noise is kept by atom: dof numbers of variance 1, the
/// length of its step or 0 if there is none, and dof numbers of the rotation.  This noise takes its
/// place.  Each noise has the amplitude of its own step, so that steps of different lengths add up
/// to the displacement by the noise of their times.
struct NearStep {
  const int *local;
  long stride;
  double h, amplitude;                       // sqrt(2 kT h)
  const double *random, *random_rotation;    // the second one may be null
  double *last, *displacement, *rotation;
  BDH_FN void operator()(long p) const
  {
    double *l = last + stride * local[p];
    const double ratio = std::sqrt(l[dof] / h);    // of the amplitudes
    mean(p, ratio, random, l, displacement);
    if (random_rotation) mean(p, ratio, random_rotation, l + noise_entries, rotation);
    l[dof] = h;
  }
  BDH_FN void mean(long p, double ratio, const double *noise, double *l, double *to) const
  {
    for (int c = 0; c < dof; ++c) {
      const double z = noise[dof * p + c], last_z = ratio > 0.0 ? ratio * l[c] : z;
      to[dof * p + c] = h * to[dof * p + c] + amplitude * 0.5 * (last_z + z);
      l[c] = z;
    }
  }
};
/// Keeps the force on a particle by atom, where a near step begins: dof numbers, and 1.
struct KeepForce {
  const int *local;
  long stride;
  const double *force;
  double *kept;
  BDH_FN void operator()(long p) const
  {
    double *k = kept + stride * local[p];
    for (int c = 0; c < dof; ++c) k[c] = force[dof * p + c];
    k[dof] = 1.0;
  }
};
/// By how much it has changed; 0 for a particle that was not there.
struct ChangeSinceKept {
  const int *local;
  long stride;
  const double *force, *kept;
  BDH_FN double operator()(long p) const
  {
    const double *k = kept + stride * local[p];
    double sum = 0.0;
    for (int c = 0; c < dof; ++c) sum += (force[dof * p + c] - k[c]) * (force[dof * p + c] - k[c]);
    return k[dof] > 0.0 ? std::sqrt(sum) : 0.0;
  }
};

}    // namespace bdh
#endif
