// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// What positively split Ewald is given: particles, forces on them and noise.
///
/// Pointers are those of the execution that the mobility works in.  Every rank gets its own
/// particles, and all ranks call at the same time.
#ifndef BDH_PSE_PARTICLES_H
#define BDH_PSE_PARTICLES_H

#include "base/rng_kernel.h"
#include "base/strain_kernel.h"
#include "pse/layout.h"

#include <cstdint>

namespace bdh {

/// The particles of this rank, and what lies around them.  The arrays must stay where they are
/// while a mobility is bound to them.  Neighbors: a neighbour list.
template <class Neighbors> struct PseParticles {
  long count = 0;
  const double *x = nullptr;        ///< positions, dim per particle [length]
  const uint64_t *ids = nullptr;    ///< identities, the same on any number of ranks
  Neighbors neighbors;              ///< as seen from the same positions
  long with_ghosts = 0;             ///< count, and particles of other ranks that are neighbours
  /// Radii of the particles and of those of other ranks [length].  Read only by a mobility for
  /// unequal radii or rotation.
  const double *radius = nullptr;
};

/// Forces on the particles.
///
/// Whether forces act is a fact about all ranks, and a null pointer is not: a rank without
/// particles has no array, but takes part in what the others do with their forces.
struct PseForces {
  const double *values = nullptr;    ///< dof per particle [force]; not read if no force acts
  bool act = false;                  ///< a force or torque acts on any rank; the same on all
  /// Torques, dof per particle [force length].  Null: none.  Not read by a mobility without
  /// rotation.
  const double *torques = nullptr;
  /// Stresslets, strain_numbers per particle [force length].  Null: none.  Not read by a mobility
  /// without them.
  const double *stresslets = nullptr;
};

/// Where velocities go, dof per particle, and rates of strain, strain_numbers per particle.
struct PseVelocities {
  PseVelocities(double *v = nullptr, double *w = nullptr, double *e = nullptr) :
      linear(v), angular(w), strain(e)
  {}
  double *linear;
  double *angular;    ///< angular velocities; not written by a mobility without rotation
  double *strain;     ///< rates of strain; not written by a mobility without stresslets, or if null
};

/// Gaussian noise with a covariance proportional to the mobility M, or to one of its parts: a
/// function of seed, step, stage, and the identities of particles and waves.  The same on all
/// ranks.
struct PseNoise {
  /// Covariance over M.  2 kT/dt gives the random velocities of a time step dt; 0: no noise.
  double variance = 0.0;
  uint32_t seed = 0;
  uint64_t step = 0;
  uint32_t stage = 0;    ///< numbers the draws of a step, below 256

  bool acts() const { return variance > 0.0; }
  NoiseCounter counter(Stream stream) const { return {seed, stream, step, stage}; }
};

/// Where the velocities of the near part go.
struct NearVelocities {
  PseVelocities by_forces;
  PseVelocities by_noise;    ///< not written without noise
};

}    // namespace bdh
#endif
