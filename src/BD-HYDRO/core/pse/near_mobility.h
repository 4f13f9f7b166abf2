// Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
/// The near part of positively split Ewald, wherever the arrays are: M_r F by pairs, and its noise,
/// M_r^(1/2) z, by the Lanczos process.  See PSE (10), (18).
#ifndef BDH_PSE_NEAR_MOBILITY_H
#define BDH_PSE_NEAR_MOBILITY_H

#include "base/bytes_of.h"
#include "base/lanczos.h"
#include "base/phases.h"
#include "pse/numbers.h"
#include "pse/particles.h"
#include "pse/plan.h"

#include <cmath>
#include <cstddef>
#include <memory>

namespace bdh {

/// Standard deviation of the whole noise of a particle, in units of that of a single particle in an
/// unbounded fluid: errors must be small compared with it.  volume: of the box [length^3].
double whole_noise(const PsePlan &plan, double volume);
/// How far the Lanczos process of this plan may err, and how many iterations it may take: at most
/// `limit`.
LanczosOptions root_options(const PsePlan &plan, double volume, int limit);

/// M_r as Lanczos sees it.
template <class Pairs, class Parts> class RealSpaceOperator {
 public:
  using Vector = typename Pairs::Vector;
  RealSpaceOperator(const Pairs &pairs, const Parts &parts) : pairs_(pairs), parts_(parts) {}
  std::size_t size() const { return Pairs::slots * pairs_.owned(); }
  std::size_t full_size() const { return Pairs::slots * pairs_.all(); }
  void apply(Vector &v, Vector &u) const
  {
    parts_.fill_ghosts(v.data(), Pairs::slots / quad, pairs_.owned(), pairs_.all());
    pairs_.apply(v, u);
  }
  double sum(double mine) const { return parts_.sum(mine); }

 private:
  const Pairs &pairs_;
  const Parts &parts_;
};

/// M_r of bound particles in a fluid of a viscosity [mass/(length time)].  Real: precision of pairs
/// and vectors.  Parts makes the pairs and names the execution; HostPse in pse/mobility.cpp shows
/// what it must have.
template <class Real, class Parts> class NearMobility {
 public:
  using Particles = PseParticles<typename Parts::Neighbors>;

  /// More than lanczos_limit iterations throw NotConverged.
  NearMobility(const PsePlan &plan, int lanczos_limit, const Parts &parts) :
      parts_(parts), plan_(plan), limit_(lanczos_limit), pairs_(parts.template pairs<Real>(plan)),
      root_(parts.execution())
  {}
  /// The radii of this plan from now on.
  void set_radii(const PsePlan &plan)
  {
    plan_ = plan;
    pairs_ = parts_.template pairs<Real>(plan);
    found_ = kept_ = false;
  }
  /// The particles that the following calls move.  Their pairs are found where they are needed.
  void bind(const Particles &particles)
  {
    particles_ = particles;
    found_ = kept_ = false;
  }
  /// Collective.  Keeps the pairs for several calls of apply().
  void keep_pairs()
  {
    const PhaseScope phase(Phase::pairs);
    if (!found_) find_pairs();
    kept_ = true;
  }

  /// Collective.  velocity += M_r forces
  void apply(const PseForces &forces, double viscosity, const PseVelocities &velocity)
  {
    const PhaseScope phase(Phase::pairs);
    load(forces);
    if (kept_) {
      pairs_->apply(force_, product_);
    } else {
      pairs_->bind_and_apply(particles_, force_, product_);
      found_ = false;
    }
    add(mobility(viscosity), velocity);
  }
  /// Collective.  After keep_pairs(): velocity.strain += that of M_r forces, where stresslets alone
  /// act; the rest of `velocity` is arbitrary.
  void apply_stresslets(const PseForces &forces, double viscosity, const PseVelocities &velocity)
  {
    const PhaseScope phase(Phase::pairs);
    load(forces);
    pairs_->apply_strains(force_, product_);
    add(mobility(viscosity), velocity);
  }
  /// Collective.  velocity += M_r forces.  The pairs are kept for apply_root().
  void apply_and_keep(const PseForces &forces, double viscosity, const PseVelocities &velocity)
  {
    const PhaseScope phase(Phase::pairs);
    find_pairs();
    if (forces.act) {
      load(forces);
      pairs_->apply(force_, product_);
      add(mobility(viscosity), velocity);
    }
    parts_.execution().fence();
  }
  /// Collective.  After apply_and_keep(): velocity += sqrt(variance) M_r^(1/2) z.  volume: of
  /// the box.  The error in the report is relative to the whole noise.
  LanczosReport apply_root(const PseNoise &noise, double viscosity, double volume,
                           const PseVelocities &velocity)
  {
    const PhaseScope phase(Phase::lanczos);
    random_.resize(Numbers::slots * particles_.count);
    Numbers::draw(parts_.execution(), particles_, noise, random_.data());
    Operator M(*pairs_, parts_);
    LanczosReport root = root_.apply(M, random_, root_options(plan_, volume, limit_), product_);
    add(std::sqrt(noise.variance * mobility(viscosity)), velocity);
    root.error /= whole_noise(plan_, volume);
    return root;
  }

  /// Pairs that the last evaluation with noise has kept on this rank.
  double pairs() const { return pairs_->pairs(); }
  /// Bytes on this rank.
  std::size_t memory() const
  {
    return pairs_->memory() + root_.memory() + bytes_of(force_, product_, random_);
  }

 private:
  using Pairs = typename Parts::template Pairs<Real>;
  using Numbers = typename Parts::template Numbers<Real>;
  using Operator = RealSpaceOperator<Pairs, Parts>;
  using Vector = typename Pairs::Vector;

  void find_pairs()
  {
    found_ = false;    // if this throws
    pairs_->bind(particles_);
    found_ = true;
  }
  double mobility(double viscosity) const { return Numbers::mobility(plan_, viscosity); }

  /// force_ := forces, with ghosts
  void load(const PseForces &forces)
  {
    force_.resize(Numbers::slots * particles_.with_ghosts);
    Numbers::load(parts_.execution(), particles_, forces, force_.data());
    parts_.fill_ghosts(force_.data(), Numbers::slots / quad, particles_.count,
                       particles_.with_ghosts);
  }
  /// velocity += factor product_
  void add(double factor, const PseVelocities &velocity) const
  {
    Numbers::add(parts_.execution(), particles_, factor, product_.data(), velocity);
    parts_.execution().fence();
  }

  Parts parts_;
  PsePlan plan_;
  int limit_;
  std::unique_ptr<Pairs> pairs_;
  LanczosRoot<Operator, typename Parts::Execution> root_;
  Particles particles_;
  bool found_ = false;    // pairs_ holds those of particles_
  bool kept_ = false;     // and apply() takes them
  Vector force_, product_, random_;
};

}    // namespace bdh
#endif
