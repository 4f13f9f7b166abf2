/* -*- c++ -*- ----------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/// Computes the steps of fix bd/pse: on the host with its threads, or on a device.
#ifndef LMP_BDH_PSE_ENGINE_H
#define LMP_BDH_PSE_ENGINE_H

#include "base/pieces.h"
#include "bdh_columns.h"
#include "bdh_given_motions.h"
#include "bdh_group.h"
#include "bdh_pairs.h"
#include "input/options.h"
#include "pse/constrained_step.h"
#include "pse/probe.h"

#include <memory>
#include <string>
#include <vector>

namespace LAMMPS_NS {

/// Columns that scheme split uses; empty with other schemes.
struct PseColumns {
  /// Last noise of the near part, bdh::noise_entries wide, and bdh::dof more where particles turn;
  /// where near steps are chosen, bdh::force_entries of the force follow.
  AtomColumns::Column last_noise;
  /// Displacement since the beginning of the step, and the rotation; bdh::dof each.
  AtomColumns::Column moved;
};

/// Where the force begins in the column of the noise, if there is one.
inline int force_entry(const PseColumns &kept)
{
  return kept.last_noise.width - bdh::force_entries;
}

/// The parts of fix bd/pse that its engines use.  They outlive the engines.
struct PseFixParts {
  const bdh::PseOptions &options;
  AtomGroup &group;
  AtomColumns &columns;
  const PseColumns &kept;
  GivenMotions &given;
};

/// The mobility of fix bd/pse, and the steps of the group's atoms with it.
class PseEngine {
 public:
  virtual ~PseEngine() = default;

  /// Collective.  Makes the mobility for a plan, or changes its radius where that is enough;
  /// returns the bytes of its grid on this rank.
  virtual double make(const bdh::PsePlan &plan) = 0;
  /// Collective.  Sets the present cell.  True if the mobility needed a new grid for it.
  virtual bool set_cell(const bdh::Cell &cell) = 0;
  /// The plan, with the present grid.
  virtual const bdh::PsePlan &plan() const = 0;

  /// Collective.  One step of the scheme that the options name, from the present state of the
  /// atoms. Throws SceneChanged, before anything has moved, if the atoms no longer match the scene.
  virtual bdh::PseReport step(const bdh::PseStepPlan &plan, bdh::PieceChoice &choice) = 0;
  /// Collective.  See bdh::StepInPieces.  Throws SceneChanged, as step() does.
  virtual bdh::StepAgainstHalves compare_with_halves(const bdh::PseStepPlan &plan,
                                                     double limit) = 0;
  /// Velocities of the last step by their causes (keyword parts).
  virtual bdh::PseVelocityParts parts() const = 0;

  /// What the constraint of the last step did; empty without one.
  virtual ConstrainedMotion constrained() const = 0;

  /// Collective.  Looks at the list and the group again, before the first probe().
  virtual void look_again() = 0;
  /// Collective.  An evaluation of the engine's own mobility, or of one made for another plan.
  virtual std::unique_ptr<bdh::PseProbe> probe(const bdh::PsePlan *other, double viscosity) = 0;

  /// Names the particle at an index of the core's arrays, and the step, for messages.
  virtual std::string describe(long index) const = 0;
  /// Bytes on this rank.
  virtual double memory() const = 0;
};

/// Collective.  Takes a step with `step`, in pieces where `choice` says so.
template <class Execution, class Step, class Around, class Mobility>
bdh::PseReport step_in_pieces(const bdh::StepInPieces<Execution> &pieces,
                              typename bdh::StepInPieces<Execution>::Particles &particles,
                              const bdh::PseStepPlan &plan, bdh::PieceChoice &choice, Step &step,
                              Around &around, Mobility &mobility)
{
  if (plan.near_steps) return step.Step::Base::take(particles, around, mobility, plan);
  bdh::PseReport report;
  pieces.step(particles, plan, choice, [&](auto &p, const bdh::PseStepPlan &part) {
    report.add(step.Step::Base::take(p, around, mobility, part));
    return true;
  });
  return report;
}

/// Collective.  Compares a step of scheme euler with its halves.
template <class Execution, class Step, class Around, class Mobility>
bdh::StepAgainstHalves halves_of_step(const bdh::StepInPieces<Execution> &pieces,
                                      typename bdh::StepInPieces<Execution>::Particles &particles,
                                      const bdh::PseStepPlan &plan, double limit, Step &step,
                                      Around &around, Mobility &mobility)
{
  return pieces.compare_with_halves(particles, plan, limit,
                                    [&](auto &p, const bdh::PseStepPlan &part) {
                                      step.Step::Base::take(p, around, mobility, part);
                                      return true;
                                    });
}

/// Limit on the Lanczos iterations of a mobility whose noise has to be more accurate.
inline int more_iterations(const bdh::PseOptions &options) { return 10 * options.iterations; }

/// Works in the memory of the host, with any number of processes and the threads of `workers`.
class HostPseEngine : public PseEngine, protected Pointers {
 public:
  HostPseEngine(LAMMPS *lmp, const PseFixParts &fix, PairSource &pairs,
                const bdh::Workers &workers);
  ~HostPseEngine() noexcept override;    // newer releases let that of Pointers throw

  double make(const bdh::PsePlan &plan) override;
  bool set_cell(const bdh::Cell &cell) override;
  const bdh::PsePlan &plan() const override { return mobility_->plan(); }
  bdh::PseReport step(const bdh::PseStepPlan &plan, bdh::PieceChoice &choice) override;
  bdh::StepAgainstHalves compare_with_halves(const bdh::PseStepPlan &plan, double limit) override;
  bdh::PseVelocityParts parts() const override { return step_.parts(); }
  ConstrainedMotion constrained() const override { return motion_of(step_); }
  void look_again() override;
  std::unique_ptr<bdh::PseProbe> probe(const bdh::PsePlan *other, double viscosity) override;
  std::string describe(long index) const override { return group_.describe(index); }
  double memory() const override;

 private:
  class Around;

  bdh::StepInPieces<bdh::HostExecution> pieces() const
  {
    return {bdh::HostExecution(workers_), bdh::Comm(world)};
  }
  std::unique_ptr<bdh::HostPseMobility> made_for(const bdh::PsePlan &plan,
                                                 const bdh::FftSetup &setup, int iterations) const;

  const bdh::PseOptions &options_;
  AtomGroup &group_;
  PairSource &pairs_;
  AtomColumns &columns_;
  PseColumns kept_;
  const bdh::Workers &workers_;
  bdh::Cell cell_;
  std::unique_ptr<Around> around_;
  std::unique_ptr<bdh::HostPseMobility> mobility_;
  GivenMotions &given_;
  ConstraintOn<bdh::HostExecution> constraint_;
  bdh::ConstrainedStep<bdh::HostExecution, bdh::NeighborView> step_;
};

}    // namespace LAMMPS_NS
#endif
