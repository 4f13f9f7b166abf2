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
/// host, 3 per particle.
class PseProbe {
 public:
  virtual ~PseProbe() = default;
  /// Collective.  M force.
  virtual std::vector<double> apply(const std::vector<double> &force) = 0;
  /// Collective.  Random velocities, as PseMobility::fluctuate().
  virtual std::vector<double> random(const PseNoise &noise) = 0;
};

/// Of its own mobility `made`, or if that is null of `shared`, which nobody may bind meanwhile.
/// Collective.
template <class Execution, class Neighbors> class PseProbeOn : public PseProbe {
 public:
  using Step = PseStep<Execution, Neighbors>;
  using Mobility = typename Step::Mobility;

  PseProbeOn(const typename Step::Particles &particles, typename Step::Surroundings &around,
             double viscosity, Mobility *shared, std::unique_ptr<Mobility> made) :
      particles_(particles),
      viscosity_(viscosity), made_(std::move(made)), mobility_(made_ ? *made_ : *shared)
  {
    mobility_.bind(particles.x(), particles.size(), around.neighbors(), around.all());
  }

  std::vector<double> apply(const std::vector<double> &force) override
  {
    const Vector f = Execution::from_host(force);
    Vector u = velocities();
    mobility_.apply(f.data(), viscosity_, u.data());
    return Execution::to_host(u);
  }
  std::vector<double> random(const PseNoise &noise) override
  {
    Vector u = velocities();
    mobility_.fluctuate(false, nullptr, noise, particles_.ids(), viscosity_, u.data());
    return Execution::to_host(u);
  }

 private:
  using Vector = typename Step::Vector;
  Vector velocities() const
  {
    Vector u;
    u.resize(3 * particles_.size());
    return u;
  }

  const typename Step::Particles &particles_;
  double viscosity_;
  std::unique_ptr<Mobility> made_;
  Mobility &mobility_;
};

}    // namespace bdh
#endif
