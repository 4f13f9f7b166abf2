// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// The particles of a step, wherever their arrays are.
#ifndef BDH_BASE_PARTICLES_H
#define BDH_BASE_PARTICLES_H

#include "base/errors.h"
#include "base/vector_kernel.h"

#include <cstdint>
#include <vector>

namespace bdh {

/// The particles as the steps see them.  All arrays have 3 size() entries, x, y, z interleaved, in
/// the memory of the execution whose Vector it is.
template <class Vector> class ParticlesOf {
 public:
  virtual ~ParticlesOf() = default;
  virtual long size() const = 0;
  /// Unwrapped positions: a shear flow needs y, not its periodic image.
  virtual const double *x() const = 0;
  virtual const double *force() const = 0;
  /// The identities of the particles, size() numbers.  A particle has the same one on every rank
  /// and in every run.
  virtual const uint64_t *ids() const = 0;
  /// Collective.  x += displacement, then force := the forces at the new x.  Particles may change
  /// rank and order; displacement goes with them and is resized.
  virtual void move_and_update_forces(Vector &displacement) = 0;
  /// Ends the step: x += displacement.  velocity is (total displacement of the step)/dt.
  virtual void finish(const Vector &displacement, const Vector &velocity) = 0;
};

using Particles = ParticlesOf<std::vector<double>>;

/// Throws BadParticle for a force that is not a finite number.
template <class Execution>
void check_finite_forces(const Execution &execution,
                         const ParticlesOf<typename Execution::ParticleVector> &p)
{
  const long i = execution.first("bdh::check_finite_forces", p.size(), NotFinite{p.force()});
  if (i >= 0)
    throw BadParticle(i, "the force on it is not a finite number: atoms may overlap, or a fix adds "
                         "such a force");
}

}    // namespace bdh
#endif
