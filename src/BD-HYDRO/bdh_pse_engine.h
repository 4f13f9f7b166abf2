/* -*- c++ -*- ----------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/// What computes the steps of fix bd/pse: the host with its threads, or a device.
#ifndef LMP_BDH_PSE_ENGINE_H
#define LMP_BDH_PSE_ENGINE_H

#include "bdh_columns.h"
#include "bdh_group.h"
#include "bdh_pairs.h"
#include "input/options.h"
#include "pse/probe.h"
#include "pse/step.h"

#include <memory>
#include <string>
#include <vector>

namespace LAMMPS_NS {

/// Columns of scheme split; empty with other schemes.
struct PseColumns {
  AtomColumns::Column last_noise;    ///< the last near noise, bdh::noise_entries wide
  AtomColumns::Column moved;    ///< displacement since the beginning of the step, bdh::dof wide
};

/// The parts of fix bd/pse that its engines work with.  They outlive the engines.
struct PseFixParts {
  const bdh::PseOptions &options;
  AtomGroup &group;
  AtomColumns &columns;
  const PseColumns &kept;
};

/// The mobility of fix bd/pse, and its steps with the atoms of the group.
class PseEngine {
 public:
  virtual ~PseEngine() = default;

  /// Collective.  Makes the mobility of a plan, or changes its radius where that is enough; returns
  /// the bytes of its grid on this rank.
  virtual double make(const bdh::PsePlan &plan) = 0;
  /// Collective.  The cell as it is now; true if the mobility needed a new grid for it.
  virtual bool set_cell(const bdh::Cell &cell) = 0;
  /// The plan, with the grid as it is now.
  virtual const bdh::PsePlan &plan() const = 0;

  /// Collective.  One step of the scheme that the options name, with the atoms as they are.
  /// Throws SceneChanged before it has moved any if they are not those of the scene.
  virtual bdh::PseReport step(const bdh::PseStepPlan &plan) = 0;
  /// Velocities of the last step by forces and by noise (keyword parts), bdh::dof per particle.
  virtual std::vector<double> by_forces() const = 0;
  virtual std::vector<double> by_noise() const = 0;

  /// Collective.  Looks at the list and the group again, before the first probe().
  virtual void look_again() = 0;
  /// Collective.  Evaluates the engine's own mobility, or one that is made for another plan.
  virtual std::unique_ptr<bdh::PseProbe> probe(const bdh::PsePlan *other, double viscosity) = 0;

  /// Names the particle at an index of the core's arrays, and the step.
  virtual std::string describe(long index) const = 0;
  /// Bytes on this rank.
  virtual double memory() const = 0;
};

/// Limit of Lanczos iterations for a mobility whose noise is to be more accurate.
inline int more_iterations(const bdh::PseOptions &options) { return 10 * options.iterations; }

/// Works in the memory of the host, with any number of processes and the threads of `workers`.
class HostPseEngine : public PseEngine, protected Pointers {
 public:
  HostPseEngine(LAMMPS *lmp, const PseFixParts &fix, PairSource &pairs,
                const bdh::Workers &workers);
  ~HostPseEngine() noexcept override;    // that of Pointers may throw in newer releases

  double make(const bdh::PsePlan &plan) override;
  bool set_cell(const bdh::Cell &cell) override;
  const bdh::PsePlan &plan() const override { return mobility_->plan(); }
  bdh::PseReport step(const bdh::PseStepPlan &plan) override;
  std::vector<double> by_forces() const override { return step_.by_forces(); }
  std::vector<double> by_noise() const override { return step_.by_noise(); }
  void look_again() override;
  std::unique_ptr<bdh::PseProbe> probe(const bdh::PsePlan *other, double viscosity) override;
  std::string describe(long index) const override { return group_.describe(index); }
  double memory() const override;

 private:
  class Around;

  std::unique_ptr<bdh::HostPseMobility> made_for(const bdh::PsePlan &plan, bdh::FftEffort effort,
                                                 int iterations) const;

  const bdh::PseOptions &options_;
  AtomGroup &group_;
  PairSource &pairs_;
  AtomColumns &columns_;
  PseColumns kept_;
  const bdh::Workers &workers_;
  bdh::Cell cell_;
  std::unique_ptr<Around> around_;
  std::unique_ptr<bdh::HostPseMobility> mobility_;
  bdh::PseStep<bdh::HostExecution, bdh::NeighborView> step_;
};

}    // namespace LAMMPS_NS
#endif
