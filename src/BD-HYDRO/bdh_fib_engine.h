/* -*- c++ -*- ----------------------------------------------------------
   LAMMPS - Large-scale Atomic/Molecular Massively Parallel Simulator
   https://www.lammps.org/

   This file is part of the BD-HYDRO package, copyright (c) the BD-HYDRO
   authors, and is distributed under the GNU General Public License,
   version 2, like LAMMPS itself.
------------------------------------------------------------------------- */

/// Computes the steps of fix bd/fib: on the host with its threads, or on a device.
#ifndef LMP_BDH_FIB_ENGINE_H
#define LMP_BDH_FIB_ENGINE_H

#include "base/pieces.h"
#include "bdh_fib_flow.h"
#include "bdh_given_motions.h"
#include "bdh_group.h"
#include "fib/step.h"
#include "input/fib_precision.h"
#include "input/options.h"

#include <array>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>

namespace LAMMPS_NS {

/// The fluid of fix bd/fib, and the steps of the group's atoms in it.
class FibEngine {
 public:
  virtual ~FibEngine() = default;
  /// Collective.  Makes the fluid.  Until then all other functions return 0.  Throws InvalidOption
  /// if the precision that the options ask for is impossible.
  /// turns: particles turn.  given: outlives the engine.
  virtual void make(const bdh::Grid &grid, const bdh::FibOptions &options, bool turns,
                    GivenMotions &given) = 0;
  virtual bool is_made() const = 0;
  /// Collective.  Makes the grid that the present positions of the atoms require, before a step
  /// does.
  virtual void fit_grid() = 0;
  /// Of the grid, with the reason.
  virtual const bdh::FibPrecision &precision() const = 0;
  /// Cells of the present grid; 0 if there is none.
  virtual std::array<long, 3> cells() const = 0;
  /// Collective.  One step from the present state of the atoms.
  virtual void step(const bdh::StepPlan &plan, bdh::PieceChoice &choice) = 0;
  /// Collective.  See bdh::StepInPieces.
  virtual bdh::StepAgainstHalves compare_with_halves(const bdh::StepPlan &plan, double limit) = 0;
  virtual bdh::SolveReport report() const = 0;    ///< of the last solve
  virtual double crossings() const = 0;           ///< see bdh::BrownianStep
  /// Local indices of the atoms of the last step, in the core's order.
  virtual std::vector<int> atoms() const = 0;
  /// What the constraint of the last step did; empty without one.
  virtual ConstrainedMotion constrained() const = 0;
  virtual int constraint_iterations() const = 0;
  /// Names the particle at an index of the core's arrays, and the step, for messages.
  virtual std::string describe(long index) const = 0;
  virtual double grid_memory() const = 0;    ///< bytes on this rank, of the present grid
  virtual double memory() const = 0;         ///< all bytes on this rank
};

/// Place is bdh::FibOnHost or its counterpart on a device.  Group holds the particles there: an
/// object that the engine owns, or a reference to one that it does not.
template <class Place, class Group> class FibEngineOn : public FibEngine, protected Pointers {
 public:
  /// group: arguments for the constructor of Group.
  template <class... Args> FibEngineOn(LAMMPS *lmp, const bdh::Workers &workers, Args &&...group) :
      Pointers(lmp), workers_(workers), group_(std::forward<Args>(group)...),
      flow_(bdh::Comm(lmp->world), workers, group_)
  {}
  ~FibEngineOn() noexcept override {}    // newer releases let that of Pointers throw
  void make(const bdh::Grid &grid, const bdh::FibOptions &options, bool turns,
            GivenMotions &given) override
  {
    FibFlowPlan plan;
    plan.grid = grid;
    plan.options = options;
    plan.moments = options.stresslets ? bdh::Moments::stresslet : bdh::moments_of(turns);
    plan.constrained = given.act();
    given_ = given.act() ? &given : nullptr;
    flow_.make(plan);
    made_ = true;
  }
  bool is_made() const override { return made_; }
  const bdh::FibPrecision &precision() const override { return flow_.precision(); }
  void fit_grid() override
  {
    if (!flow_.follows()) return;
    group_.gather();
    flow_.follow();
  }
  std::array<long, 3> cells() const override { return flow_.cells(); }
  const auto &particles() const { return group_; }
  void step(const bdh::StepPlan &plan, bdh::PieceChoice &choice) override
  {
    group_.gather();
    group_.matches_scene();    // stops the run if another fix integrates one of the atoms
    if (given_) constraint_ = arrays_.of(*given_, group_.atoms_on_host());
    pieces().step(group_, plan, choice, [this](Particles &p, const bdh::StepPlan &part) {
      return flow_.take(p, part, constraint_);
    });
  }
  bdh::StepAgainstHalves compare_with_halves(const bdh::StepPlan &plan, double limit) override
  {
    group_.gather();
    return pieces().compare_with_halves(group_, plan, limit,
                                        [this](Particles &p, const bdh::StepPlan &part) {
                                          return flow_.take(p, part, constraint_);
                                        });
  }
  bdh::SolveReport report() const override { return flow_.report(); }
  double crossings() const override { return flow_.crossings(); }
  std::vector<int> atoms() const override { return group_.atoms_on_host(); }
  ConstrainedMotion constrained() const override { return flow_.constrained(); }
  int constraint_iterations() const override { return flow_.iterations(); }
  std::string describe(long index) const override { return group_.describe(index); }
  double grid_memory() const override { return flow_.grid_memory(); }
  double memory() const override
  {
    const double group = std::is_reference<Group>::value ? 0.0 : group_.memory();
    return grid_memory() + flow_.particle_memory() + arrays_.memory() + group;
  }

 private:
  using Particles = typename FibFlow<Place>::Particles;

  bdh::StepInPieces<typename Place::Execution> pieces() const
  {
    return {typename Place::Execution(workers_), bdh::Comm(world)};
  }

  const bdh::Workers &workers_;
  Group group_;
  FibFlow<Place> flow_;
  bool made_ = false;
  GivenMotions *given_ = nullptr;                     // null: no motions are given
  bdh::Constraint constraint_;                        // of this step
  ConstraintOn<typename Place::Execution> arrays_;    // those of constraint_
};

using HostFibEngine = FibEngineOn<bdh::FibOnHost, AtomGroup &>;

}    // namespace LAMMPS_NS
#endif
