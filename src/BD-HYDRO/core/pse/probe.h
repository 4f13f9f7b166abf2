// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// Evaluations of a mobility outside of time steps, to compare two of them (keyword check), once
/// for host and device.
#ifndef BDH_PSE_PROBE_H
#define BDH_PSE_PROBE_H

#include "pse/step.h"

#include <memory>
#include <vector>

namespace bdh {

/// A mobility at the positions that the particles had when it was made.  Vectors are those of the
/// host, dof per particle.  Where particles turn, those of the rotation follow: all torques after
/// all forces, all angular velocities after all velocities.
class PseProbe {
 public:
  virtual ~PseProbe() = default;
  /// Collective.  M force.
  virtual std::vector<double> apply(const std::vector<double> &force) = 0;
  /// Collective.  Random velocities.
  virtual std::vector<double> random(const PseNoise &noise) = 0;
};

/// Evaluates its own mobility `made`, or the `shared` one if that is null.  Nobody else may bind a
/// shared mobility meanwhile, nor move the arrays of the particles.
template <class Execution, class Neighbors> class PseProbeOn : public PseProbe {
 public:
  using Step = PseStep<Execution, Neighbors>;
  using Mobility = typename Step::Mobility;

  /// Collective.
  PseProbeOn(const typename Step::Particles &particles, typename Step::Surroundings &around,
             double viscosity, Mobility *shared, std::unique_ptr<Mobility> made) :
      size_(dof * particles.size()),
      rotation_((made ? *made : *shared).plan().rotation), made_(std::move(made)),
      mobility_(made_ ? *made_ : *shared)
  {
    mobility_.set_viscosity(viscosity);
    mobility_.bind(particles_among(particles, around));
  }

  std::vector<double> apply(const std::vector<double> &force) override
  {
    const Vector f = Execution::from_host(force);
    Vector u = velocities();
    mobility_.apply({f.data(), true, rotation_ ? f.data() + size_ : nullptr}, halves(u));
    return Execution::to_host(u);
  }
  std::vector<double> random(const PseNoise &noise) override
  {
    Vector u = velocities();
    mobility_.fluctuate({}, noise, halves(u));
    return Execution::to_host(u);
  }

 private:
  using Vector = typename Step::Vector;
  Vector velocities() const
  {
    Vector u;
    u.resize(rotation_ ? 2 * size_ : size_);
    return u;
  }
  PseVelocities halves(Vector &u) const
  {
    return {u.data(), rotation_ ? u.data() + size_ : nullptr};
  }

  long size_;
  bool rotation_;
  std::unique_ptr<Mobility> made_;
  Mobility &mobility_;
};

}    // namespace bdh
#endif
