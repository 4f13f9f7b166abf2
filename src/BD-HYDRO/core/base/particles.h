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
///
/// Where particles turn, an engine reads torque() beside force(), and gives turn() rotation vectors
/// beside the displacements that it gives finish().  All of these are in the axes of space.  In two
/// dimensions only the third number of a torque is read, and the others of a rotation are 0.
template <class Vector> class ParticlesOf {
 public:
  virtual ~ParticlesOf() = default;
  virtual long size() const = 0;
  /// Unwrapped positions: a shear flow needs y, not its periodic image.
  virtual const double *x() const = 0;
  virtual const double *force() const = 0;
  /// Torques; not called where particles do not turn.
  virtual const double *torque() const { return nullptr; }
  /// The identities of the particles, size() numbers.  A particle has the same one on every rank
  /// and in every run.
  virtual const uint64_t *ids() const = 0;
  /// Collective.  x += displacement, orientations turned by the rotation vectors `rotation` (null:
  /// nothing turns), then force and torque := those there.  Particles may change rank and order;
  /// displacement and rotation go with them and are resized.
  virtual void move_and_update_forces(Vector &displacement, Vector *rotation) = 0;
  /// Ends the step: x += displacement.  velocity is (total displacement of the step)/dt.
  virtual void finish(const Vector &displacement, const Vector &velocity) = 0;
  /// Begins a piece of the step, which lasts `part` of it: force_before() are then the forces now,
  /// and the velocities that finish() and turn() are given are those of the piece.  Called where
  /// steps are taken in pieces, and not otherwise.
  virtual void begin_piece(double /*part*/) {}
  /// Collective.  Ends a piece that is not the last one: as move_and_update_forces() does, where
  /// velocity is (total displacement of the piece)/time.
  virtual void end_piece(Vector & /*displacement*/, const Vector & /*velocity*/,
                         Vector * /*rotation*/, const Vector & /*angular_velocity*/)
  {}
  virtual const double *force_before() const { return nullptr; }
  /// Forgets the piece that end_piece() has ended.  The particles are still where it ended.
  virtual void forget_piece() {}
  /// Keeps numbers of the particles, 3 each, which then go with them; kept() returns them in the
  /// present order.  Called where a step is compared with its halves, and not otherwise.
  virtual void keep(const Vector & /*numbers*/) {}
  virtual Vector kept() { return {}; }
  /// Ends the turning of a step, after finish(): orientations turned by the rotation vectors
  /// `rotation`, from where they are now.  angular_velocity is (rotation of the whole step)/dt.
  virtual void turn(const Vector & /*rotation*/, const Vector & /*angular_velocity*/) {}
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

/// The same for torques, where particles turn.
template <class Execution>
void check_finite_torques(const Execution &execution,
                          const ParticlesOf<typename Execution::ParticleVector> &p)
{
  const long i = execution.first("bdh::check_finite_torques", p.size(), NotFinite{p.torque()});
  if (i >= 0)
    throw BadParticle(i, "the torque on it is not a finite number: atoms may overlap, or a fix "
                         "adds such a torque");
}

}    // namespace bdh
#endif
